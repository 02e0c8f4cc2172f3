//! External functions of [`external`](crate::external) in functions being compiled (MLS §12.9).

use super::emitter::Operand;
use super::external_kinds::is_object;
use super::instances::Instances;
use super::statements::Body;
use crate::arithmetic::{Operation, Operator};
use crate::bytecode::{ExternalCall, Instruction};
use crate::diag::{At, Diagnostic};
use crate::eval::{FunctionComponent, c_function};
use crate::external::{self, Entry, Slot, SlotKind};
use crate::fault;
use crate::lower::errors::NOT_SUPPORTED;
use crate::lower::expressions::{Lowered, size_fault};
use crate::lower::shape::UNKNOWN_TEXT;
use crate::source::Span;
use crate::symbolic::RelationOperator;
use crate::syntax::ast;

impl Body<'_, '_> {
    /// The call that is the body of an external function.
    pub(super) fn external(&mut self, clause: &ast::External) -> Result<(), Diagnostic> {
        let function = self.function.clone();
        let entry = match c_function::in_rust(&function, clause) {
            Some(entry) => entry,
            None => {
                let others = self.flat.functions.values();
                let resources = &mut self.flat.resources.clone();
                c_function::in_c(&function, clause, others, resources)?
            }
        };
        let clause = &*c_function::call_of(&function, clause);
        self.emitter.place(clause.span);
        self.emitter.open();
        let mut arguments = Vec::with_capacity(clause.arguments.len());
        for argument in &clause.arguments {
            let value = self.lowering().lower(argument)?;
            let component = match &argument.kind {
                ast::ExpressionKind::Reference(reference) => reference.as_ident(),
                _ => None,
            };
            let component = component.and_then(|name| function.variable(name));
            arguments.push(self.slot(value, component, argument.span)?);
        }
        if entry.c.is_some() {
            for (argument, slot) in clause.arguments.iter().zip(&arguments) {
                self.check_sizes(argument, slot)?;
            }
        }
        let output = clause.output.as_ref().and_then(|output| output.as_ident());
        let result = match function.outputs.iter().find(|c| Some(c.name) == output) {
            Some(output) => {
                let value = self.local(&[output.name]).cloned();
                let value = value.unwrap_or(Lowered::Text("".into()));
                Some(self.slot(value, Some(output), clause.span)?)
            }
            None => None,
        };
        self.refuse_unknown_files(entry, &arguments, clause.span)?;
        entry.check(&arguments, result.as_ref()).at(clause.span)?;
        self.keep_files(entry, &arguments, clause.span)?;
        let external = self.emitter.external(ExternalCall::new(entry, arguments, result));
        self.emitter.emit(Instruction::External { external });
        self.emitter.close();
        Ok(())
    }

    /// C reads as many elements as the declaration promises: an argument has the sizes of its component,
    /// also where these are known only when the function is called.
    fn check_sizes(&mut self, argument: &ast::Expression, slot: &Slot) -> Result<(), Diagnostic> {
        let function = self.function.clone();
        let Some((component, _)) = c_function::passed(&function, argument) else { return Ok(()) };
        for (dim, size) in component.dims.iter().zip(&slot.dims) {
            let ast::Subscript::Index(declared) = dim else { continue };
            let Some(declared) = self.declared_size(declared, argument)? else { continue };
            match declared {
                Operand::Constant(declared) if declared == f64::from(*size) => {}
                Operand::Constant(declared) => {
                    let fault = size_fault(&[declared as usize], &[*size as usize]);
                    return Err(fault.at(argument.span).related(component.span, "this component"));
                }
                declared @ Operand::Register(_) => {
                    let (a, d) = (self.emitter.register(declared), self.emitter.block(1));
                    let b = self.emitter.register(Operand::Constant(f64::from(*size)));
                    let text = format!("`{}` has not the size that is declared", component.name);
                    let message = self.emitter.message(text.into());
                    let operator = RelationOperator::Equal;
                    self.emitter
                        .emit(Operation::binary(Operator::Relation(operator), d, a, b).into());
                    self.emitter.emit(Instruction::Assert { a: d, message });
                }
            }
        }
        Ok(())
    }

    /// A size of a component. One of a record's component may be the name of another one in the record;
    /// what else it may be is not known here.
    fn declared_size(
        &mut self,
        size: &ast::Expression,
        argument: &ast::Expression,
    ) -> Result<Option<Operand>, Diagnostic> {
        let ast::ExpressionKind::Reference(of) = &argument.kind else { return Ok(None) };
        let [record @ .., _] = of.parts.as_slice() else { return Ok(None) };
        let mut within = size.clone();
        if let ast::ExpressionKind::Reference(own) = &mut within.kind {
            own.parts.splice(0..0, record.iter().cloned());
        }
        match self.lowering().scalar(&within) {
            Ok(size) => Ok(Some(size)),
            Err(_) if !record.is_empty() => Ok(None),
            Err(error) => Err(error),
        }
    }

    /// The files that a function reads are kept with the model, so that their names must be known.
    fn refuse_unknown_files(
        &self,
        entry: &Entry,
        arguments: &[Slot],
        span: Span,
    ) -> Result<(), Diagnostic> {
        let is_known =
            |at: usize| arguments.get(at).is_none_or(|slot| slot.kind != SlotKind::Numbered);
        match entry.files().all(is_known) {
            true => Ok(()),
            false => Err(fault!(
                NOT_SUPPORTED,
                "the name of the file that `{}` reads must be known at translation",
                self.function.name
            )
            .at(span)),
        }
    }

    /// Keeps the files that a function reads.
    fn keep_files(
        &mut self,
        entry: &Entry,
        arguments: &[Slot],
        span: Span,
    ) -> Result<(), Diagnostic> {
        let Instances { functions, .. } = &mut *self.instances;
        for argument in entry.files() {
            let name = self.emitter.string_at(arguments[argument].first);
            if external::names_a_file(&name) {
                functions.files.keep(&name, &self.flat.resources).at(span)?;
            }
        }
        let is_known = |argument: &usize| arguments[*argument].kind == SlotKind::Text;
        for argument in entry.possible_files().filter(is_known) {
            let name = self.emitter.string_at(arguments[argument].first);
            // A missing file is reported where it is needed.
            let _ = functions.files.keep(&name, &self.flat.resources);
        }
        Ok(())
    }

    /// Where an argument stands: the registers of a component itself, which the call may write to.
    pub(super) fn slot(
        &mut self,
        value: Lowered<Operand>,
        component: Option<&FunctionComponent>,
        span: Span,
    ) -> Result<Slot, Diagnostic> {
        match value {
            Lowered::Text(text) => {
                let first = self.emitter.text(text);
                Ok(Slot { kind: SlotKind::Text, first, dims: Box::new([]) })
            }
            Lowered::Array(array) => {
                let kind = match component.is_some_and(is_object) {
                    true => SlotKind::Object,
                    false => SlotKind::Number,
                };
                let first = self.emitter.row(&array.elements);
                let dims = array.dims.iter().map(|size| *size as u32).collect();
                Ok(Slot { kind, first, dims })
            }
            Lowered::Record(_) => {
                Err(fault!(NOT_SUPPORTED, "a record as argument of an external function").at(span))
            }
            Lowered::Strings(strings) => {
                if strings.strings.iter().any(|text| text.contains(UNKNOWN_TEXT)) {
                    return Err(fault!(
                        NOT_SUPPORTED,
                        "Strings that are not known at translation, as argument of an external \
                         function"
                    )
                    .at(span));
                }
                // They are contiguous.
                let positions: Vec<u32> =
                    strings.strings.iter().map(|text| self.emitter.text(text.clone())).collect();
                let first = positions.first().copied().unwrap_or(0);
                let dims = strings.dims.iter().map(|size| *size as u32).collect();
                Ok(Slot { kind: SlotKind::Text, first, dims })
            }
            Lowered::Numbered(number) => {
                let first = self.emitter.row(&[number]);
                Ok(Slot { kind: SlotKind::Numbered, first, dims: Box::new([]) })
            }
        }
    }
}
