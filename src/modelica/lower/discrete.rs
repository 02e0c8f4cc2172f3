//! Which Reals are discrete: those that a when-clause assigns (MLS §3.8.4, §4.5).

use super::builder::Builder;
use super::dae::Dae;
use super::dae::VariableKind;
use super::errors::NOT_DISCRETE;
use super::expressions::Lowering;
use crate::diag::Fault;
use crate::fault;
use crate::symbolic::{Expr, VarId};
use crate::syntax::ast::{self, ComponentReference, EquationKind, ExpressionKind, StatementKind};

/// Why a value that has to be discrete is not: one of the variables that it follows from changes
/// between events.
pub(crate) fn not_discrete(
    dae: &Dae,
    subject: &str,
    value: Expr,
    is_varying: impl Fn(VarId) -> bool,
) -> Fault {
    let mut read = dae.pool.variables(value).into_iter().filter(|v| is_varying(*v));
    let named = read.find(|v| !dae.variable(*v).name.starts_with('$'));
    let cause =
        named.map_or_else(String::new, |v| format!(": it follows from `{}`", dae.variable(v).name));
    fault!(NOT_DISCRETE, "{subject} can change between events{cause}")
}

/// What to do where relations cause no events.
pub(crate) const WITHOUT_EVENTS: &str = "`==` and `<>` of Reals are no events: write `<=` or `>=`; do \
    not use relations inside `noEvent` or inside functions";

impl Builder<'_> {
    /// Marks the Reals that when-clauses assign.
    pub(super) fn find_discrete(&mut self) {
        let flat = self.flat;
        let mut targets = Vec::new();
        let unclocked = flat.equations.iter().filter(|e| !self.is_clocked_equation(e));
        unclocked.for_each(|e| equation_targets(e, false, &mut targets));
        for statements in &flat.algorithms {
            statement_targets(statements, &mut targets);
        }
        for target in targets {
            for variable in self.target_scalars(target) {
                let kind = &mut self.dae.variables[variable.0 as usize].kind;
                if *kind == VariableKind::Unknown {
                    *kind = VariableKind::Discrete;
                }
            }
        }
    }

    /// The scalars of a target; the whole array where subscripts depend on a loop.
    fn target_scalars(&mut self, target: &ComponentReference) -> Vec<VarId> {
        let places = self.without_assertions(|own| own.places(target, &Vec::new()));
        if let Ok(places) = places {
            return places.into_iter().map(|place| place.variable).collect();
        }
        let Ok(path) = Lowering::new(self).path(target) else { return Vec::new() };
        let Some((position, _, variable)) = self.flat.variables.get_full(path.as_str()) else {
            return Vec::new();
        };
        let first = self.scalars.first[position].0;
        (first..first + variable.len() as u32).map(VarId).collect()
    }
}

fn equation_targets<'a>(
    equation: &'a ast::Equation,
    in_when: bool,
    targets: &mut Vec<&'a ComponentReference>,
) {
    let each = |body: &'a [ast::Equation], in_when, targets: &mut Vec<&'a ComponentReference>| {
        body.iter().for_each(|e| equation_targets(e, in_when, targets));
    };
    match &equation.kind {
        EquationKind::Equal { left, .. } if in_when => named_targets(left, targets),
        EquationKind::For { body, .. } => each(body, in_when, targets),
        EquationKind::If { branches, otherwise } => {
            branches.iter().for_each(|(_, body)| each(body, in_when, targets));
            each(otherwise, in_when, targets);
        }
        EquationKind::When { branches } => {
            branches.iter().for_each(|(_, body)| each(body, true, targets));
        }
        EquationKind::Equal { .. } | EquationKind::Connect { .. } | EquationKind::Call(_) => {}
    }
}

/// What a left side names: a component of an array of components stands there as an array.
fn named_targets<'a>(left: &'a ast::Expression, targets: &mut Vec<&'a ComponentReference>) {
    match &left.kind {
        ExpressionKind::Reference(reference) => targets.push(reference),
        ExpressionKind::Tuple(elements) => {
            elements.iter().flatten().for_each(|e| named_targets(e, targets));
        }
        ExpressionKind::Array(elements) => {
            elements.iter().for_each(|e| named_targets(e, targets));
        }
        _ => {}
    }
}

fn statement_targets<'a>(
    statements: &'a [ast::Statement],
    targets: &mut Vec<&'a ComponentReference>,
) {
    for statement in statements {
        match &statement.kind {
            StatementKind::When { branches } => {
                targets.extend(branches.iter().flat_map(|(_, body)| ast::targets(body)));
            }
            _ => statement.bodies().for_each(|body| statement_targets(body, targets)),
        }
    }
}
