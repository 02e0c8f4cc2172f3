//! Units of equations (MLS §3.7, ch. 19): both sides of additions, relations, bindings and equations
//! measure the same. Only dimensions are compared, and only where all units are written: literals,
//! and variables without `unit`, fit everything. What does not fit is a warning, as models
//! simulate all the same.

mod expression;

use super::balance::path;
use super::errors::INCONSISTENT_UNITS;
use super::{FlatModel, Variable};
use crate::diag::Diagnostic;
use crate::fault;
use crate::flatten::lookup::classes::Classes;
use crate::name::Ident;
use crate::source::{SourceId, Span};
use crate::syntax::ast::{
    Equation, EquationKind, Expression, ExpressionKind, Statement, StatementKind,
};
use crate::syntax::visit::{Visit, walk_equation, walk_expression, walk_statement};
use crate::units::{self, Dimension};
use rustc_hash::{FxHashMap, FxHashSet};
use std::sync::Arc;

/// The most warnings that one model gives.
const MAX_WARNINGS: usize = 100;

/// What does not fit, each place once.
fn check(model: &FlatModel) -> Vec<Diagnostic> {
    let mut walk =
        UnitCheck { units: Units::of(model), reported: FxHashSet::default(), found: Vec::new() };
    if walk.units.known.is_empty() {
        return Vec::new();
    }
    for variable in model.variables.values() {
        if let Some(binding) = &variable.binding {
            walk.expression(binding);
            let declared = walk.units.known.get(&variable.name).copied();
            walk.compare(declared, walk.units.of_expression(binding), binding.span, &variable.name);
        }
    }
    for equation in model.equations.iter().chain(&model.initial_equations) {
        walk.equation(equation);
    }
    for statement in model.algorithms.iter().chain(&model.initial_algorithms).flatten() {
        walk.statement(statement);
    }
    walk.found
}

impl Classes<'_> {
    /// What does not fit; of an old library, only the first finding.
    pub(crate) fn unit_warnings(&self, model: &FlatModel) -> Vec<Diagnostic> {
        let found = check(model);
        if found.is_empty() {
            return found;
        }
        let classes = self.scopes.iter().filter_map(|scope| scope.text.as_ref());
        let library_of: FxHashMap<SourceId, Ident> =
            classes.filter_map(|text| Some((text.span().source, text.name.first()?))).collect();
        let mut reported = FxHashSet::default();
        let mut is_reported = |warning: &Diagnostic| {
            let source = warning.labels.first().map(|label| label.span.source);
            let library = source.and_then(|source| library_of.get(&source).copied());
            library.is_none_or(|one| !self.library.is_old(one) || reported.insert(one))
        };
        found.into_iter().filter(|one| is_reported(one)).collect()
    }
}

/// The dimensions of the variables whose units are known.
struct Units {
    known: FxHashMap<Arc<str>, Dimension>,
}

impl Units {
    fn of(model: &FlatModel) -> Units {
        let mut parsed: FxHashMap<Arc<str>, Option<Dimension>> = FxHashMap::default();
        let mut unit = |variable: &Variable| match &variable.attributes.get("unit")?.value.kind {
            ExpressionKind::String(text) => {
                *parsed.entry(text.clone()).or_insert_with(|| units::dimension(text))
            }
            _ => None,
        };
        let variables = model.variables.values();
        Units { known: variables.filter_map(|one| Some((one.name.clone(), unit(one)?))).collect() }
    }
}

struct UnitCheck {
    units: Units,
    reported: FxHashSet<Span>,
    found: Vec<Diagnostic>,
}

impl UnitCheck {
    /// Tells, once a place, that a variable and its value differ.
    fn compare(
        &mut self,
        one: Option<Dimension>,
        other: Option<Dimension>,
        span: Span,
        name: &str,
    ) {
        if let (Some(one), Some(other)) = (one, other)
            && one != other
        {
            self.warn(
                format!("`{name}` has the dimension of `{one}`, but its value that of `{other}`"),
                span,
            );
        }
    }

    /// As [`UnitCheck::compare`], of two expressions.
    fn compare_sides(&mut self, both: [Option<Dimension>; 2], span: Span, sides: &str) {
        if let [Some(one), Some(other)] = both
            && one != other
        {
            self.warn(
                format!("the {sides} have different dimensions, those of `{one}` and `{other}`"),
                span,
            );
        }
    }

    fn warn(&mut self, message: String, span: Span) {
        if self.found.len() < MAX_WARNINGS && self.reported.insert(span) {
            self.found.push(fault!(INCONSISTENT_UNITS, "{message}").at(span).warning());
        }
    }
}

impl Visit for UnitCheck {
    fn expression(&mut self, e: &Expression) {
        walk_expression(self, e);
        if let ExpressionKind::Binary { .. } = &e.kind {
            let (first, operations) = e.chain();
            operations.iter().fold(self.units.of_expression(first), |left, one| {
                if let Some(sides) = expression::compared(one.operator) {
                    let both = [left, self.units.of_expression(one.right)];
                    self.compare_sides(both, one.whole.span, sides);
                }
                self.units.of_operation(left, one)
            });
        }
    }

    fn equation(&mut self, equation: &Equation) {
        walk_equation(self, equation);
        if let EquationKind::Equal { left, right } = &equation.kind {
            let both = [left, right].map(|side| self.units.of_expression(side));
            self.compare_sides(both, equation.span, "sides of the equation");
        }
    }

    fn statement(&mut self, statement: &Statement) {
        walk_statement(self, statement);
        if let StatementKind::Assign { target, value } = &statement.kind {
            let declared = self.units.of_reference(target);
            let value = self.units.of_expression(value);
            self.compare(declared, value, statement.span, &path(target));
        }
    }
}
