//! The variables that the left sides of statements stand for (MLS §11.2.1).
//!
//! A subscript that is computed stands for one element of several: each of these is assigned under
//! the condition that the subscript is its own.

use super::builder::Builder;
use super::errors::{NO_CONSTANT_VALUE, NOT_SUPPORTED};
use super::execution::Loops;
use super::expressions::{Choice, Lowered, Lowering, field_of};
use super::symbolic_target::RecordArray;
use crate::diag::Diagnostic;
use crate::fault;
use crate::source::Span;
use crate::symbolic::{Expr, RelationOperator, VarId};
use crate::syntax::ast::{
    ComponentReference, Expression, ExpressionKind, ForIndex, ReferencePart, Statement,
    StatementKind, Subscript,
};
use crate::syntax::visit::Rewrite;

/// Where one scalar of a value goes.
#[derive(Debug, Clone, Copy)]
pub(super) struct AssignedScalar {
    pub(super) variable: VarId,
    /// The scalar of the value, by its position.
    pub(super) element: usize,
    /// The condition under which it goes there.
    pub(super) guard: Option<Expr>,
}

impl Builder<'_> {
    /// The scalars that statements assign, loops unrolled where their ranges are known.
    pub(super) fn targets(
        &mut self,
        statements: &[Statement],
        loops: &mut Loops,
        found: &mut Vec<VarId>,
    ) {
        for statement in statements {
            match &statement.kind {
                StatementKind::For { indices, body } => {
                    self.targets_of_loop(indices, body, loops, found);
                }
                _ => {
                    statement.targets().for_each(|t| self.add_target(t, loops, found));
                    statement.bodies().for_each(|body| self.targets(body, loops, found));
                }
            }
        }
    }

    fn add_target(&mut self, target: &ComponentReference, loops: &Loops, found: &mut Vec<VarId>) {
        let places = self.without_assertions(|own| own.places(target, loops));
        found.extend(places.iter().flatten().map(|place| place.variable));
    }

    fn targets_of_loop(
        &mut self,
        indices: &[ForIndex],
        body: &[Statement],
        loops: &mut Loops,
        found: &mut Vec<VarId>,
    ) {
        let Some((index, inner)) = indices.split_first() else {
            return self.targets(body, loops, found);
        };
        let mut lowering = Lowering::new(self);
        lowering.loops = loops.clone();
        let Ok(variables) = lowering.loop_variables(index) else {
            // Whatever the loop variable is: all elements.
            self.targets(&without_subscripts(body), loops, found);
            return;
        };
        for variable in variables {
            loops.push(variable);
            self.targets_of_loop(inner, body, loops, found);
            loops.pop();
        }
    }

    /// The places that a left side stands for.
    pub(super) fn places(
        &mut self,
        target: &ComponentReference,
        loops: &Loops,
    ) -> Result<Vec<AssignedScalar>, Diagnostic> {
        let flat = self.flat;
        let mut lowering = self.statement_lowering(loops);
        let path = lowering.path(target).unwrap_or_default();
        let subscripts = &target.parts[target.parts.len() - 1].subscripts;
        let Some((position, _, variable)) = flat.variables.get_full(path.as_str()) else {
            return self.places_of_record(target, loops);
        };
        let choices = lowering.choices(&variable.dims, subscripts, target.span)?;
        // Variables by their offsets from the first of the array.
        let mut places = vec![AssignedScalar { variable: VarId(0), element: 0, guard: None }];
        for (dimension, size) in variable.dims.iter().enumerate() {
            places = match choices.get(dimension) {
                None => each(&places, *size, &(0..*size).collect::<Vec<_>>()),
                Some(Choice::Known { positions, .. }) => each(&places, *size, positions),
                Some(Choice::Computed(subscript)) => {
                    self.one_of(&places, *size, *subscript, target.span)?
                }
                Some(Choice::ComputedVector(_)) => {
                    return Err(fault!(
                        NO_CONSTANT_VALUE,
                        "the subscripts of an assignment must be known at translation";
                        help: "write a loop")
                    .at(target.span));
                }
            };
        }
        let first = self.scalars.first[position].0;
        places.iter_mut().for_each(|place| place.variable.0 += first);
        Ok(places)
    }

    /// The element of a dimension whose subscript is computed.
    fn one_of(
        &mut self,
        places: &[AssignedScalar],
        size: usize,
        subscript: Expr,
        span: Span,
    ) -> Result<Vec<AssignedScalar>, Diagnostic> {
        if self.dae.varies(subscript) {
            return Err(fault!(
                NO_CONSTANT_VALUE,
                "the subscript of an assignment must be discrete or known at translation"
            )
            .at(span));
        }
        let one = self.dae.pool.constant(1.0);
        let position = self.dae.pool.sub(subscript, one);
        self.subscript_assertion(size, position, span);
        let mut found = Vec::with_capacity(places.len() * size);
        for place in places {
            for at in 0..size {
                let pool = &mut self.dae.pool;
                let number = pool.constant((at + 1) as f64);
                let mut guard = pool.relation(RelationOperator::Equal, subscript, number);
                if let Some(outer) = place.guard {
                    guard = pool.and(outer, guard);
                }
                let variable = VarId(place.variable.0 * size as u32 + at as u32);
                found.push(AssignedScalar { variable, element: place.element, guard: Some(guard) });
            }
        }
        Ok(found)
    }

    fn places_of_record(
        &mut self,
        target: &ComponentReference,
        loops: &Loops,
    ) -> Result<Vec<AssignedScalar>, Diagnostic> {
        self.execution.raw += 1;
        let value = self.record_variables(target, loops);
        self.execution.raw -= 1;
        let mut scalars = Vec::new();
        value?.append_scalars(&mut scalars);
        let place = |(element, e): (usize, Expr)| match self.dae.pool.as_variable(e) {
            Some(variable) => Ok(AssignedScalar { variable, element, guard: None }),
            None => {
                Err(fault!(NOT_SUPPORTED, "`{}` cannot be assigned", target.name()).at(target.span))
            }
        };
        scalars.into_iter().enumerate().map(place).collect()
    }

    /// The variables of a record, or of an array of records or a part of it.
    fn record_variables(
        &mut self,
        target: &ComponentReference,
        loops: &Loops,
    ) -> Result<Lowered<Expr>, Diagnostic> {
        let mut lowering = self.statement_lowering(loops);
        for count in 1..=target.parts.len() {
            let parts = target.parts[..count].to_vec();
            let path = lowering.path(&ComponentReference { parts, ..target.clone() })?;
            if let Some(array) = lowering.target.array_of_records(&path) {
                return part_of_array(
                    &mut lowering,
                    array,
                    &target.parts[count - 1..],
                    target.span,
                );
            }
        }
        let e = Expression::new(ExpressionKind::Reference(target.clone()), target.span);
        lowering.lower(&e)
    }
}

/// What the parts of a reference choose of an array of records, the first of them the array itself.
fn part_of_array(
    lowering: &mut Lowering<'_, Builder<'_>>,
    array: RecordArray,
    parts: &[ReferencePart],
    span: Span,
) -> Result<Lowered<Expr>, Diagnostic> {
    let (mut value, mut rank) = (array.value, array.rank);
    for (at, part) in parts.iter().enumerate() {
        if at > 0 {
            value = field_of(&value, part.name, span)?.clone();
        }
        if part.subscripts.is_empty() {
            continue;
        }
        let before = if at > 0 { rank } else { 0 };
        let all = std::iter::repeat_n(Subscript::All(span), before);
        let subscripts: Vec<Subscript> = all.chain(part.subscripts.iter().cloned()).collect();
        let (first, n) = (rank_of_first(&value), subscripts.len());
        value = lowering.elements_of(value, &subscripts, span)?;
        if at == 0 {
            rank = (rank + rank_of_first(&value)).saturating_sub(first);
        } else if at + 1 < parts.len() && n > 0 && rank > 0 {
            return Err(fault!(
                NOT_SUPPORTED,
                "a slice of an array of records in an array of records cannot be assigned";
                help: "write a loop")
            .at(span));
        }
    }
    Ok(value)
}

/// How many dimensions the first array in a value has.
fn rank_of_first(value: &Lowered<Expr>) -> usize {
    match value {
        Lowered::Array(array) => array.dims.len(),
        Lowered::Record(fields) => fields.first().map_or(0, |(_, field)| rank_of_first(field)),
        _ => 0,
    }
}

/// The elements of a dimension at known positions.
fn each(places: &[AssignedScalar], size: usize, positions: &[usize]) -> Vec<AssignedScalar> {
    let of = |place: &AssignedScalar| {
        let (offset, element, guard) = (place.variable.0 as usize, place.element, place.guard);
        let place = move |(at, position): (usize, &usize)| AssignedScalar {
            variable: VarId((offset * size + position) as u32),
            element: element * positions.len() + at,
            guard,
        };
        positions.iter().enumerate().map(place).collect::<Vec<_>>()
    };
    places.iter().flat_map(of).collect()
}

/// Statements that assign to whole arrays what these assign to elements.
fn without_subscripts(statements: &[Statement]) -> Vec<Statement> {
    let mut whole = statements.to_vec();
    whole.iter_mut().for_each(|statement| Whole.statement(statement));
    whole
}

struct Whole;

impl Rewrite for Whole {
    fn reference(&mut self, reference: &mut ComponentReference) {
        if let Some(last) = reference.parts.last_mut() {
            last.subscripts.clear();
        }
    }
}
