//! Lowering into the symbolic expressions of a [`Dae`](super::dae::Dae).

use super::build::derivative_of;
use super::build::scalar_of_nothing;
use super::builder::Builder;
use super::dae::{Homotopy, Relation, VariableKind};
use super::equation::{Assertion, Level};
use super::errors::{NO_CONSTANT_VALUE, NOT_SUPPORTED};
use super::expressions::{
    Array, Binary, Branch, ClockedCall, ConditionalValues, FunctionCalls, Lowered, Operations,
    StringOperations, StringPart, TimeOperators, Unary, VariableReferences, stacked,
};
use crate::diag::Diagnostic;

use crate::eval::{Function, ValueType};
use crate::fault;
use crate::flatten::flat_reference;
use crate::flatten::{BaseType, FlatModel, Variability};
use crate::functions::{Builtin, Clocked, Temporal};
use crate::name::{Ident, Name};
use crate::source::Span;
use crate::symbolic::function::FunctionId;
use crate::symbolic::{Expr, Node, RelationOperator, VarId};
use crate::syntax::ast::{ComponentReference, Expression};
use indexmap::IndexSet;
use std::cell::Cell;
use std::collections::BTreeSet;
use std::sync::Arc;

impl Operations for Builder<'_> {
    type Scalar = Expr;

    fn constant(&mut self, value: f64) -> Expr {
        self.dae.pool.constant(value)
    }

    fn as_constant(&self, scalar: Expr) -> Option<f64> {
        self.dae.pool.as_constant(scalar)
    }

    fn unary(&mut self, operation: Unary, a: Expr) -> Expr {
        match operation {
            Unary::Neg => self.dae.pool.neg(a),
            Unary::Not => self.dae.pool.not(a),
        }
    }

    fn binary(&mut self, operation: Binary, a: Expr, b: Expr) -> Expr {
        let pool = &mut self.dae.pool;
        match operation {
            Binary::Add => pool.add(a, b),
            Binary::Sub => pool.sub(a, b),
            Binary::Mul => pool.mul(a, b),
            Binary::Div => pool.div(a, b),
            Binary::Pow => pool.pow(a, b),
            Binary::And => pool.and(a, b),
            Binary::Or => pool.or(a, b),
        }
    }

    fn relation(
        &mut self,
        operator: RelationOperator,
        a: Expr,
        b: Expr,
        live: bool,
        span: Span,
    ) -> Expr {
        let relation = self.dae.pool.relation(operator, a, b);
        let equality = matches!(operator, RelationOperator::Equal | RelationOperator::NotEqual);
        // `a == b` of Integers and Booleans has no zero crossing of its own: it changes when they do.
        if live || equality || self.as_constant(relation).is_some() {
            return relation;
        }
        if !self.dae.varies(a) && !self.dae.varies(b) {
            return relation;
        }
        if let Some(split) = self.split_extremum(operator, (a, b), span) {
            return split;
        }
        let [a, b] = self.guarded_sides(a, b);
        let key = (operator, a, b);
        let variable = match self.scalars.relations.get(&key) {
            Some(variable) => *variable,
            None => {
                let variable = VarId(self.dae.variables.len() as u32);
                let name = format!("$relation[{}]", self.dae.relations.len() + 1);
                let mut frozen = scalar_of_nothing(&name, VariableKind::Frozen, span);
                frozen.base = BaseType::Boolean;
                frozen.variability = Variability::Discrete;
                self.dae.variables.push(frozen);
                self.dae.relations.push(Relation { variable, operator, left: a, right: b, span });
                self.scalars.relations.insert(key, variable);
                variable
            }
        };
        self.dae.pool.variable(variable)
    }

    fn apply(
        &mut self,
        function: FunctionId,
        arguments: &[Expr],
        live: bool,
        span: Span,
    ) -> Result<Expr, Diagnostic> {
        let may_jump = function.get().event_generating && !live;
        match may_jump && arguments.iter().any(|a| self.dae.varies(*a)) {
            true => self.rounding_function(function, arguments, span),
            false => Ok(self.dae.pool.apply(function, arguments)),
        }
    }

    fn element(
        &mut self,
        elements: &[Expr],
        position: Expr,
        span: Span,
    ) -> Result<Expr, Diagnostic> {
        if self.dae.varies(position) || elements.is_empty() {
            return Err(fault!(NO_CONSTANT_VALUE,
                "this subscript must be known at translation, or be discrete";
                help: "use a constant, or a parameter that is `final` or has `annotation(Evaluate = true)`")
            .at(span));
        }
        self.subscript_assertion(elements.len(), position, span);
        Ok(self.chosen(elements, 0, position))
    }

    fn homotopy(&mut self, actual: Expr, simplified: Expr) -> Expr {
        if actual == simplified {
            return actual;
        }
        let Homotopy { active, lambda } = self.homotopy_variables();
        let pool = &mut self.dae.pool;
        let (active, lambda) = (pool.variable(active), pool.variable(lambda));
        let difference = pool.sub(actual, simplified);
        let part = pool.mul(lambda, difference);
        let between = pool.add(simplified, part);
        pool.if_then_else(active, between, actual)
    }
}

impl ConditionalValues for Builder<'_> {
    fn connective(&mut self, is_and: bool, a: Expr, b: Expr) -> Expr {
        Builder::connective(self, is_and, a, b)
    }

    fn enter(&mut self, condition: Expr, holds: bool) {
        self.enter_branch(condition, holds);
    }

    fn leave(&mut self) {
        self.leave_branch();
    }

    fn begin_if(&mut self, condition: Expr) -> Branch<Expr> {
        Branch { condition, values: Vec::new(), asserted: self.dae.assertions.len() }
    }

    fn begin_else(&mut self, branch: &mut Branch<Expr>, values: &[Expr]) {
        branch.values = values.to_vec();
        self.dae.guard_assertions(branch.asserted, branch.condition);
        branch.asserted = self.dae.assertions.len();
    }

    fn end_if(&mut self, branch: Branch<Expr>, values: &[Expr]) -> Vec<Expr> {
        let not = self.dae.pool.not(branch.condition);
        self.dae.guard_assertions(branch.asserted, not);
        let pairs = branch.values.iter().zip(values);
        pairs.map(|(a, b)| self.dae.pool.if_then_else(branch.condition, *a, *b)).collect()
    }
}

impl VariableReferences for Builder<'_> {
    fn reference(
        &mut self,
        path: &str,
        reference: &ComponentReference,
    ) -> Result<Lowered<Expr>, Diagnostic> {
        if path == "time" {
            return Ok(Lowered::scalar(self.dae.pool.variable(VarId(0))));
        }
        let flat = self.flat;
        let Some((position, _, variable)) = flat.variables.get_full(path) else {
            return self.record(path).ok_or_else(|| self.unresolved(path, reference.span));
        };
        if variable.base == BaseType::String && !variable.dims.is_empty() {
            return Ok(Lowered::Strings(self.string_array(position)));
        }
        if variable.base == BaseType::String {
            let first = self.scalars.first[position];
            return Ok(match self.dae.variable(first).kind {
                VariableKind::Discrete if self.execution.raw > 0 => {
                    Lowered::Numbered(self.dae.pool.variable(first))
                }
                VariableKind::Discrete => {
                    Lowered::Numbered(self.execution.value_now(&mut self.dae.pool, first))
                }
                _ => Lowered::Text(self.text(position)),
            });
        }
        if variable.variability <= Variability::Parameter {
            self.fold(position)?;
        }
        let first = self.scalars.first[position].0;
        let elements =
            (first..first + variable.len() as u32).map(|id| self.scalar_now(id)).collect();
        Ok(Lowered::Array(Array { dims: variable.dims.clone(), elements }))
    }

    fn sizes(&self, path: &str) -> Option<Vec<usize>> {
        let (position, _, variable) = self.flat.variables.get_full(path)?;
        let is_number = variable.base != BaseType::String || self.is_varying_text(position);
        is_number.then(|| variable.dims.clone())
    }

    fn element_of(&mut self, path: &str, position: usize) -> Result<Option<Expr>, Diagnostic> {
        let Some((number, _, variable)) = self.flat.variables.get_full(path) else {
            return Ok(None);
        };
        if variable.variability <= Variability::Parameter {
            self.fold(number)?;
        }
        Ok(Some(self.scalar_now(self.scalars.first[number].0 + position as u32)))
    }

    fn value_type(&self, path: &str) -> Option<ValueType> {
        Some(match &self.flat.variables.get(path)?.base {
            BaseType::Real => ValueType::Real,
            BaseType::Integer => ValueType::Integer,
            BaseType::Boolean => ValueType::Boolean,
            BaseType::String => ValueType::String,
            BaseType::Enumeration(definition) => ValueType::Enumeration(definition.clone()),
            BaseType::ExternalObject(class) => ValueType::ExternalObject(class.clone()),
            BaseType::Clock => ValueType::Any,
        })
    }

    fn constructor_of(&self, object: Expr) -> Option<Expression> {
        let variable = self.dae.pool.as_variable(object)?;
        let at = self.flat_position(variable)?;
        self.flat.variables.get_index(at)?.1.binding.clone()
    }

    fn structural_value(&mut self, condition: Expr) -> Option<f64> {
        self.evaluate_structural(condition).ok().flatten()
    }
}

impl FunctionCalls for Builder<'_> {
    fn flat(&self) -> &FlatModel {
        self.flat
    }

    fn call(
        &mut self,
        function: &Arc<Function>,
        arguments: Vec<Lowered<Expr>>,
        span: Span,
    ) -> Result<Vec<Lowered<Expr>>, Diagnostic> {
        super::function::call(self, function, arguments, span)
    }

    fn interpreted_call(
        &mut self,
        function: &Arc<Function>,
        arguments: &[Lowered<Expr>],
        span: Span,
    ) -> Option<Vec<Lowered<Expr>>> {
        super::function::interpreted_call(self, function, arguments, span)
    }

    fn interpreted(&self) -> &Cell<u64> {
        &self.calls.functions.interpreted
    }

    fn runs_once(&self) -> bool {
        self.place.initial || self.place.at_start
    }

    fn warn(&mut self, warnings: Vec<Diagnostic>) {
        self.dae.warnings.extend(warnings);
    }
}

impl StringOperations for Builder<'_> {
    fn string_number(&mut self, text: &Arc<str>) -> Option<Expr> {
        Some(self.number_of(text))
    }

    fn composes(&self) -> bool {
        true
    }

    fn compose(&mut self, parts: &[StringPart<Expr>], _: Span) -> Result<Expr, Diagnostic> {
        let (code, arguments) = self.calls.functions.composer(parts);
        Ok(self.dae.pool.call(code, 0, &arguments))
    }

    fn needs_string_outputs(&mut self, needed: bool) {
        self.calls.functions.needs_string_outputs = needed;
    }

    fn string_binding(&self, path: &str) -> Option<Expression> {
        let variable = self.flat.variables.get(path)?;
        let is_scalar = variable.base == BaseType::String && variable.dims.is_empty();
        variable.binding.clone().filter(|_| is_scalar)
    }

    fn evaluates_string_parameters(&mut self) -> Option<&mut bool> {
        Some(&mut self.calls.evaluates_string_parameters)
    }
}

impl TimeOperators for Builder<'_> {
    fn begin_temporal(
        &mut self,
        entry: &Builtin,
        operator: Temporal,
        span: Span,
    ) -> Result<(), Diagnostic> {
        match operator {
            Temporal::Derivative
            | Temporal::Initial
            | Temporal::Terminal
            | Temporal::Sample
            | Temporal::Delay
            | Temporal::SpatialDistribution => Ok(()),
            Temporal::Pre
            | Temporal::Edge
            | Temporal::Change
            | Temporal::Clocked(Clocked::Previous) => {
                // Until `temporal`, which follows when the argument is lowered.
                self.execution.raw += 1;
                Ok(())
            }
            Temporal::Clocked(_) => Ok(()),
            _ => Err(fault!(NOT_SUPPORTED, "`{}` is not supported yet", entry.name).at(span)),
        }
    }

    fn temporal(
        &mut self,
        entry: &Builtin,
        operator: Temporal,
        arguments: Vec<Array<Expr>>,
        _: bool,
        span: Span,
    ) -> Result<Array<Expr>, Diagnostic> {
        self.temporal_operator(entry, operator, arguments, span)
    }

    fn clocked(
        &mut self,
        entry: &Builtin,
        operator: Clocked,
        call: ClockedCall<Expr>,
        span: Span,
    ) -> Result<Lowered<Expr>, Diagnostic> {
        self.clocked_operator(entry, operator, call, span)
    }

    fn spatial_distribution(
        &mut self,
        arguments: &[Array<Expr>],
        span: Span,
    ) -> Result<[Expr; 2], Diagnostic> {
        Builder::spatial_distribution(self, arguments, span)
    }

    fn is_clock(&self, e: &Expression) -> bool {
        super::clocks::is_clock(self.flat, e)
    }
}

impl Builder<'_> {
    /// `der(a)`
    pub(super) fn derivative(&mut self, a: Expr, span: Span) -> Result<Expr, Diagnostic> {
        if self.dae.is_parametric(a) {
            return Ok(self.dae.pool.constant(0.0));
        }
        let Some(variable) = self.dae.pool.as_variable(a) else {
            return self.chain_rule(a, span);
        };
        let derivative = self.derivative_variable(variable, span)?;
        Ok(self.dae.pool.variable(derivative))
    }

    /// One of the elements, the first of which has the position `first`: by halves.
    fn chosen(&mut self, elements: &[Expr], first: usize, position: Expr) -> Expr {
        if elements.iter().all(|element| *element == elements[0]) {
            return elements[0];
        }
        let half = elements.len() / 2;
        let middle = self.dae.pool.constant((first + half) as f64);
        let below = self.dae.pool.relation(RelationOperator::Less, position, middle);
        let low = self.chosen(&elements[..half], first, position);
        let high = self.chosen(&elements[half..], first + half, position);
        self.dae.pool.if_then_else(below, low, high)
    }

    /// A position from 0 lies inside its array.
    pub(super) fn subscript_assertion(&mut self, size: usize, position: Expr, span: Span) {
        let pool = &mut self.dae.pool;
        let (zero, size) = (pool.constant(0.0), pool.constant(size as f64));
        let below = pool.relation(RelationOperator::Less, position, size);
        let above = pool.relation(RelationOperator::GreaterEqual, position, zero);
        let condition = pool.and(above, below);
        if self.dae.assertions.last().is_none_or(|last| last.condition != condition) {
            let message = "a subscript lies outside its array".into();
            let parts = vec![StringPart::Text(message)];
            self.dae.assertions.push(Assertion::new(condition, parts, Level::Error, span));
        }
    }

    /// `abs(e) < w`, `max(e, f) > w`, … of time and parameters as relations of `e`, `-e` and `f`: these
    /// change their signs where a short pulse begins and ends, often at instants that are known.
    fn split_extremum(
        &mut self,
        operator: RelationOperator,
        (a, b): (Expr, Expr),
        span: Span,
    ) -> Option<Expr> {
        for (operator, extremum, other) in [(operator, a, b), (operator.mirrored(), b, a)] {
            let Node::Apply(function, arguments) = *self.dae.pool.node(extremum) else { continue };
            if !self.is_of_time(extremum) || !self.is_of_time(other) {
                continue;
            }
            let first = arguments.first();
            let last = arguments.second().unwrap_or(first);
            let (parts, is_largest) = match function.get().name {
                "abs" => ([first, self.dae.pool.neg(first)], true),
                "max" => ([first, last], true),
                "min" => ([first, last], false),
                _ => continue,
            };
            let is_below = matches!(operator, RelationOperator::Less | RelationOperator::LessEqual);
            let [one, two] = parts.map(|part| self.relation(operator, part, other, false, span));
            return Some(match is_below == is_largest {
                true => self.dae.pool.and(one, two),
                false => self.dae.pool.or(one, two),
            });
        }
        None
    }

    /// Whether an expression consists of time and parameters.
    fn is_of_time(&self, e: Expr) -> bool {
        let is_other = |v: VarId| {
            let kind = &self.dae.variable(v).kind;
            !matches!(
                kind,
                VariableKind::Time | VariableKind::Parameter { .. } | VariableKind::Constant(_)
            )
        };
        !self.dae.pool.any_variable(e, is_other)
    }

    /// `der` of an expression: the sum of partial derivatives times derivatives.
    fn chain_rule(&mut self, a: Expr, span: Span) -> Result<Expr, Diagnostic> {
        let mut derivatives = rustc_hash::FxHashMap::default();
        for variable in self.dae.pool.variables(a) {
            let derivative = match self.dae.variable(variable).kind {
                VariableKind::Time => self.dae.pool.constant(1.0),
                VariableKind::Unknown => {
                    let derivative = self.derivative_variable(variable, span)?;
                    self.dae.pool.variable(derivative)
                }
                VariableKind::Delayed => {
                    return Err(fault!(NOT_SUPPORTED, "the derivative of a delayed value").at(span));
                }
                VariableKind::Derivative(_) => {
                    return Err(
                        fault!(NOT_SUPPORTED, "second derivatives need a variable for the \
                        first derivative";
                        help: "name the first derivative: `v = der(x)`, then `der(v)`")
                        .at(span),
                    );
                }
                _ => continue,
            };
            derivatives.insert(variable, derivative);
        }
        let pool = &mut self.dae.pool;
        Ok(crate::symbolic::differentiate_forward(pool, a, &|v| derivatives.get(&v).copied()))
    }

    fn derivative_variable(&mut self, of: VarId, span: Span) -> Result<VarId, Diagnostic> {
        if let Some(known) = self.scalars.derivatives.get(&of) {
            return Ok(*known);
        }
        let source = self.dae.variable(of);
        if source.kind != VariableKind::Unknown || source.base != BaseType::Real {
            return Err(fault!(NOT_SUPPORTED, "`{}` has no derivative", source.name).at(span));
        }
        let variable = derivative_of(source, of);
        let id = VarId(self.dae.variables.len() as u32);
        self.dae.variables.push(variable);
        self.scalars.derivatives.insert(of, id);
        Ok(id)
    }

    fn homotopy_variables(&mut self) -> Homotopy {
        if let Some(known) = self.dae.homotopy {
            return known;
        }
        let first = self.dae.variables.len() as u32;
        for name in ["$homotopy.active", "$homotopy.lambda"] {
            self.dae.variables.push(scalar_of_nothing(name, VariableKind::Frozen, Span::NONE));
        }
        let variables = Homotopy { active: VarId(first), lambda: VarId(first + 1) };
        self.dae.homotopy = Some(variables);
        variables
    }

    /// What a scalar variable stands for in the expression that is made.
    fn scalar_now(&mut self, id: u32) -> Expr {
        match self.dae.variables[id as usize].kind {
            VariableKind::Constant(value) => self.dae.pool.constant(value),
            _ if self.execution.raw > 0 => self.dae.pool.variable(VarId(id)),
            _ => self.execution.value_now(&mut self.dae.pool, VarId(id)),
        }
    }

    /// All variables below a path, as a record.
    fn record(&mut self, path: &str) -> Option<Lowered<Expr>> {
        let prefix = format!("{path}.");
        let mut names: IndexSet<Ident> = IndexSet::new();
        for name in self.flat.variables.keys() {
            if let Some(rest) = name.strip_prefix(&prefix) {
                names.insert(flat_reference(rest, Span::NONE).parts.first()?.name);
            }
        }
        if names.is_empty() {
            return None;
        }
        let mut fields = Vec::new();
        for name in names {
            let full = format!("{prefix}{name}");
            let reference = ComponentReference::from_name(&Name::parse(&full), Span::NONE);
            let value = self.reference(&full, &reference).ok();
            fields.push((name, value.or_else(|| Some(self.array_of_records(&full)?.value))?));
        }
        Some(Lowered::Record(fields))
    }

    /// All variables below the elements of an array of components, as a record of arrays.
    pub(super) fn array_of_records(&mut self, path: &str) -> Option<RecordArray> {
        let prefix = format!("{path}[");
        let mut elements: BTreeSet<Vec<usize>> = BTreeSet::new();
        for name in self.flat.variables.keys() {
            if let Some((indices, rest)) =
                name.strip_prefix(&prefix).and_then(|rest| rest.split_once(']'))
                && rest.starts_with('.')
            {
                let indices = indices.split(',').map(|index| index.parse().ok());
                elements.insert(indices.collect::<Option<_>>()?);
            }
        }
        let elements: Vec<Vec<usize>> = elements.into_iter().collect();
        let rank = elements.first()?.len();
        let value = self.stacked_below(&prefix, &elements, 0)?;
        Some(RecordArray { value, rank })
    }

    /// The elements with these indices, in order, from a dimension on.
    fn stacked_below(
        &mut self,
        prefix: &str,
        elements: &[Vec<usize>],
        dimension: usize,
    ) -> Option<Lowered<Expr>> {
        let first = elements.first()?;
        if dimension == first.len() {
            let indices: Vec<String> = first.iter().map(usize::to_string).collect();
            return self.record(&format!("{prefix}{}]", indices.join(",")));
        }
        let parts = elements.chunk_by(|a, b| a[dimension] == b[dimension]);
        let parts = parts.map(|part| self.stacked_below(prefix, part, dimension + 1));
        stacked(parts.collect::<Option<_>>()?, Span::NONE).ok()
    }
}

/// An array of records, as a record of arrays.
pub(super) struct RecordArray {
    pub(super) value: Lowered<Expr>,
    /// How many dimensions the array has, which precede those of its components.
    pub(super) rank: usize,
}
