//! Components: their declaration (MLS §12.4.4) and assignment to them.

use super::emitter::Operand;
use super::instances::Argument;
use super::statements::{Body, elements};
use crate::arithmetic::Register;
use crate::bytecode::Instruction;
use crate::diag::Diagnostic;
use crate::eval::{FunctionBody, FunctionComponent};
use crate::fault;
use crate::lower::component_shape::{Declared, declared};
use crate::lower::errors::{ARRAY_MISMATCH, NOT_SUPPORTED, UNRESOLVED_REFERENCE};
use crate::lower::expressions::{Array, Choice, Lowered, Lowering, size_fault};
use crate::lower::shape::Shape;
use crate::name::Ident;
use crate::source::Span;
use crate::syntax::ast::{ComponentReference, Statement, Subscript, targets};
use rustc_hash::FxHashSet;

impl Body<'_, '_> {
    /// Inputs, outputs and locals; returns the shapes of the outputs.
    pub(super) fn declare(
        &mut self,
        arguments: &[Argument],
        statements: &[Statement],
        span: Span,
    ) -> Result<Vec<Shape>, Diagnostic> {
        let function = self.function.clone();
        for (input, argument) in function.inputs.iter().zip(arguments) {
            self.input(input.name, argument);
        }
        for input in &function.inputs {
            self.check_input(input, span)?;
        }
        let assigned = targets(statements).iter().map(|target| target.parts[0].name).collect();
        let mut shapes = vec![None; function.outputs.len()];
        let outputs = function.outputs.iter().enumerate().map(|(at, output)| (Some(at), output));
        let locals = function.locals.iter().map(|local| (None, local));
        // A size or binding may need a component that is declared further down.
        let mut waiting: Vec<(Option<usize>, &FunctionComponent)> = outputs.chain(locals).collect();
        while !waiting.is_empty() {
            let before = waiting.len();
            let mut first_error = None;
            let mut later = Vec::new();
            for (output, component) in waiting {
                let checkpoint = self.emitter.checkpoint();
                match self.component(component, statements, &assigned) {
                    Ok((shape, value)) => {
                        if let Some(at) = output {
                            shapes[at] = Some(shape);
                        }
                        self.locals.push((component.name, value));
                    }
                    Err(e) if e.code == UNRESOLVED_REFERENCE => {
                        self.emitter.rollback(checkpoint);
                        first_error = first_error.or(Some(e));
                        later.push((output, component));
                    }
                    Err(e) => return Err(e),
                }
            }
            waiting = later;
            if let Some(e) = first_error
                && waiting.len() == before
            {
                return Err(open_size(&waiting).unwrap_or(e));
            }
        }
        Ok(shapes.into_iter().flatten().collect())
    }

    /// An output or local variable: its shape, and its registers or numbers.
    fn component(
        &mut self,
        component: &FunctionComponent,
        statements: &[Statement],
        assigned: &FxHashSet<Ident>,
    ) -> Result<(Shape, Lowered<Operand>), Diagnostic> {
        self.emitter.place(component.span);
        self.emitter.open();
        let mut assigned_shape = |body: &mut Self, path: &[Ident]| body.assigned(path, statements);
        let is_assigned = assigned.contains(&component.name);
        let is_external = matches!(self.function.body, FunctionBody::External(_));
        let lowering = &mut self.lowering();
        // Strings that change have numbers.
        lowering.composes &= is_assigned || is_external;
        let Declared { mut shape, mut scalars } =
            declared(lowering, component, &mut assigned_shape)?;
        if is_external {
            // Memory that it need not write to: LAPACK leaves workspaces and what was not asked for.
            let zero = Operand::Constant(0.0);
            scalars.iter_mut().for_each(|scalar| *scalar = scalar.or(Some(zero)));
        }
        let is_known = |scalar: &Option<Operand>| matches!(scalar, Some(Operand::Constant(_)));
        if component.binding.is_some() && !is_assigned && scalars.iter().all(is_known) {
            self.emitter.close();
            let value = Lowered::from_scalars(&shape, &mut scalars.into_iter().flatten());
            return Ok((shape, value));
        }
        if is_assigned {
            shape.forget_strings();
        }
        let n = shape.len() as u32;
        let first = self.emitter.permanent(n);
        if scalars.contains(&None) {
            self.emitter.emit(Instruction::Unassign { d: first, n });
        }
        for (run, at) in runs(&scalars) {
            self.emitter.copy(first + at, &run);
        }
        self.emitter.close();
        let value = Lowered::from_scalars(&shape, &mut (first..).map(Operand::Register));
        Ok((shape, value))
    }

    /// Its number of dimensions, and its sizes as far as they are known.
    fn check_input(&mut self, input: &FunctionComponent, span: Span) -> Result<(), Diagnostic> {
        let dims = match self.local(&[input.name]) {
            Some(Lowered::Array(Array { dims, .. })) => dims.clone(),
            Some(Lowered::Strings(strings)) => strings.dims.clone(),
            _ => return Ok(()),
        };
        let name = &self.function.name;
        if dims.len() != input.dims.len() {
            return Err(fault!(
                ARRAY_MISMATCH,
                "the argument `{}` of `{name}` has {} dimensions instead of {}",
                input.name,
                dims.len(),
                input.dims.len()
            )
            .at(span));
        }
        for (subscript, size) in input.dims.iter().zip(dims) {
            let Subscript::Index(declared) = subscript else { continue };
            let Ok(declared) = Lowering::new(self).known_size(declared) else { continue };
            if declared != size {
                let fault = size_fault(&[declared], &[size]);
                return Err(fault.at(span).related(input.span, "this input"));
            }
        }
        Ok(())
    }

    /// `target := value`
    pub(super) fn assign(
        &mut self,
        target: &ComponentReference,
        value: Lowered<Operand>,
    ) -> Result<(), Diagnostic> {
        let names: Vec<Ident> = target.parts.iter().map(|part| part.name).collect();
        let place = self.local(&names).cloned().ok_or_else(|| {
            fault!(UNRESOLVED_REFERENCE, "there is no variable `{}`", target.name()).at(target.span)
        })?;
        let value = self.with_numbers_like(value, &place, target.span)?;
        let subscripts = super::subscripts_of(self.function, target)?;
        if !subscripts.is_empty() {
            return self.assign_elements(&place, &subscripts, &value, target);
        }
        let mut scalars = Vec::new();
        value.append_scalars(&mut scalars);
        if !place.fits(&value) {
            // A String that is made at run time needs variables for such.
            self.instances.misses_text |=
                value.shape().is_some_and(|shape| shape.holds_number_of_text());
            return Err(fault!(
                ARRAY_MISMATCH,
                "the value of `{}` has a different size",
                target.name()
            )
            .at(target.span));
        }
        let mut places = Vec::new();
        place.append_scalars(&mut places);
        if let Some(Operand::Register(first)) = places.first().copied() {
            let scalars = self.unaliased(first, places.len(), scalars);
            self.emitter.copy(first, &scalars);
        }
        Ok(())
    }

    /// A value with the numbers of its Strings where a place has numbers.
    fn with_numbers_like(
        &mut self,
        value: Lowered<Operand>,
        place: &Lowered<Operand>,
        span: Span,
    ) -> Result<Lowered<Operand>, Diagnostic> {
        match (value, place) {
            (text @ Lowered::Text(_), Lowered::Numbered(_)) => {
                Lowering::new(self).number_of_text(text, span).map(Lowered::Numbered)
            }
            (Lowered::Record(fields), Lowered::Record(places)) => {
                let mut numbered = Vec::with_capacity(fields.len());
                for (name, field) in fields {
                    let place = places.iter().find(|(own, _)| *own == name);
                    let field = match place {
                        Some((_, place)) => self.with_numbers_like(field, place, span)?,
                        None => field,
                    };
                    numbered.push((name, field));
                }
                Ok(Lowered::Record(numbered))
            }
            (value, _) => Ok(value),
        }
    }

    /// `target[subscripts] := value`, for each array of a record.
    fn assign_elements(
        &mut self,
        place: &Lowered<Operand>,
        subscripts: &[Subscript],
        value: &Lowered<Operand>,
        target: &ComponentReference,
    ) -> Result<(), Diagnostic> {
        if let (Lowered::Record(places), Lowered::Record(values)) = (place, value) {
            for (name, place) in places {
                let Some((_, value)) = values.iter().find(|(field, _)| field == name) else {
                    continue;
                };
                self.assign_elements(place, subscripts, value, target)?;
            }
            return Ok(());
        }
        let (Some(array), Some(value)) = (elements(place), elements(value)) else {
            return Err(fault!(NOT_SUPPORTED, "subscripts of a record").at(target.span));
        };
        let choices = self.lowering().choices(&array.dims, subscripts, target.span)?;
        let chosen = self.chosen(&array.dims, choices, target.span)?;
        if chosen.dims != value.dims {
            return Err(size_fault(&chosen.dims, &value.dims).at(target.span));
        }
        let Some(Operand::Register(first)) = array.elements.first().copied() else {
            return Ok(());
        };
        let scalars = self.unaliased(first, array.elements.len(), value.elements.clone());
        for (position, element) in chosen.positions.iter().zip(scalars) {
            let base = first + *position as Register;
            match chosen.offset {
                None => self.emitter.copy(base, &[element]),
                Some(offset) => {
                    let a = self.emitter.register(element);
                    self.emitter.emit(Instruction::Store { base, offset, a });
                }
            }
        }
        Ok(())
    }

    /// Values to be written to `n` registers from `first` on: copies, if several of them are read
    /// from there at other places.
    fn unaliased(&mut self, first: Register, n: usize, values: Vec<Operand>) -> Vec<Operand> {
        let inside = |operand: &Operand| match operand {
            Operand::Register(at) => (first..first + n as Register).contains(at),
            Operand::Constant(_) => false,
        };
        if values.len() < 2 || !values.iter().any(inside) {
            return values;
        }
        let copy = self.emitter.copies(&values);
        (copy..).take(values.len()).map(Operand::Register).collect()
    }

    /// What subscripts choose: row-major positions, all moved by a computed offset.
    pub(super) fn chosen(
        &mut self,
        dims: &[usize],
        choices: Vec<Choice<Operand>>,
        span: Span,
    ) -> Result<Chosen, Diagnostic> {
        let mut positions = vec![0];
        let mut kept = Vec::new();
        let mut offset = None;
        let mut choices = choices.into_iter();
        for (dimension, size) in dims.iter().enumerate() {
            let stride: usize = dims[dimension + 1..].iter().product();
            let chosen: Vec<usize> = match choices.next() {
                Some(Choice::Known { positions, keeps }) => {
                    kept.extend(keeps.then_some(positions.len()));
                    positions
                }
                Some(Choice::Computed(subscript)) => {
                    self.emitter.place(span);
                    let subscript = self.emitter.register(subscript);
                    let d = match offset {
                        Some(d) => d,
                        None => {
                            let d = self.emitter.block(1);
                            self.emitter.emit(Instruction::Constant { d, value: 0.0 });
                            d
                        }
                    };
                    let (size, stride) = (*size as u32, stride as u32);
                    self.emitter.emit(Instruction::Offset { d, subscript, size, stride });
                    offset = Some(d);
                    vec![0]
                }
                Some(Choice::ComputedVector(_)) => {
                    return Err(fault!(
                        NOT_SUPPORTED,
                        "an assignment to elements that a computed vector of subscripts chooses";
                        help: "write a loop")
                    .at(span));
                }
                None => {
                    kept.push(*size);
                    (0..*size).collect()
                }
            };
            let step = |at: &usize| chosen.iter().map(|c| at + c * stride).collect::<Vec<_>>();
            positions = positions.iter().flat_map(step).collect();
        }
        Ok(Chosen { positions, offset, dims: kept })
    }

    pub(super) fn local(&self, names: &[Ident]) -> Option<&Lowered<Operand>> {
        let (first, rest) = names.split_first()?;
        let mut place = &self.locals.iter().find(|(name, _)| name == first)?.1;
        for name in rest {
            let Lowered::Record(fields) = place else { return None };
            place = &fields.iter().find(|(field, _)| field == name)?.1;
        }
        Some(place)
    }
}

/// Elements of an array that subscripts choose.
pub(super) struct Chosen {
    /// Row-major positions, before the offset.
    pub(super) positions: Vec<usize>,
    /// The register of the offset that computed subscripts make.
    pub(super) offset: Option<Register>,
    /// Sizes of what is chosen.
    pub(super) dims: Vec<usize>,
}

/// Scalars that have a value, in unbroken runs with their positions.
fn runs(scalars: &[Option<Operand>]) -> Vec<(Vec<Operand>, Register)> {
    let mut runs: Vec<(Vec<Operand>, Register)> = Vec::new();
    let mut follows = false;
    for (at, scalar) in (0..).zip(scalars) {
        match (scalar, runs.last_mut()) {
            (Some(scalar), Some((run, _))) if follows => run.push(*scalar),
            (Some(scalar), _) => runs.push((vec![*scalar], at)),
            (None, _) => {}
        }
        follows = scalar.is_some();
    }
    runs
}

/// A variable whose size changes with what is assigned to it, among those that wait for others.
fn open_size(waiting: &[(Option<usize>, &FunctionComponent)]) -> Option<Diagnostic> {
    let is_open = |dim: &Subscript| matches!(dim, Subscript::All(_));
    let (_, found) = waiting.iter().find(|(_, component)| component.dims.iter().any(is_open))?;
    let error = fault!(NOT_SUPPORTED, "the size of `{}` is not declared", found.name);
    Some(error.at(found.span))
}
