//! Array expressions of a flat model taken apart into their scalars.

use super::operations::{
    MAX_SCALARS, Parts, binary, counted, filled, integer, operation, transposed,
};
use crate::flatten::FlatModel;
use crate::name::Ident;
use crate::syntax::ast::{
    Arguments, BinaryOperator, ComponentReference, Expression, ExpressionKind, ForIndex, Subscript,
};
use crate::syntax::visit::{Rewrite, rewrite_expression};

/// Functions whose value has the sizes of their last argument, of which they are one by one.
const ONE_BY_ONE: &[&str] = &["der", "pre", "noEvent", "smooth", "previous"];

/// What a subscript takes of a dimension.
enum Pick {
    One(i64),
    Several(Vec<i64>),
    /// One that is known only while the model runs.
    Changing,
}

/// Takes expressions of a model apart.
pub(super) struct Apart<'m>(pub(super) &'m FlatModel);

impl Apart<'_> {
    /// `None` where the scalars are not known, as in a call that returns an array.
    pub(super) fn parts(&self, e: &Expression) -> Option<Parts> {
        match &e.kind {
            ExpressionKind::Reference(reference) => self.reference(reference, e),
            ExpressionKind::Array(elements) => {
                let rows = elements.iter().map(|element| self.parts(element));
                Parts::stacked(rows.collect::<Option<_>>()?)
            }
            ExpressionKind::Matrix(rows) => {
                let row = |row: &Vec<Expression>| {
                    let elements = row.iter().map(|e| self.parts(e)).collect::<Option<Vec<_>>>()?;
                    let all_scalar = elements.iter().all(|part| part.dims.is_empty());
                    all_scalar.then(|| Parts::stacked(elements)).flatten()
                };
                Parts::stacked(rows.iter().map(row).collect::<Option<_>>()?)
            }
            ExpressionKind::Range { start, step, stop } => {
                let step = step.as_deref().map_or(Some(1), integer)?;
                let all = counted(integer(start)?, step, integer(stop)?)?;
                let literal = |value| Expression::new(ExpressionKind::Integer(value), e.span);
                let dims = vec![all.len()];
                Some(Parts { dims, scalars: all.into_iter().map(literal).collect() })
            }
            ExpressionKind::Unary { operator, operand } => {
                let rebuilt = |operand: Expression| {
                    let kind =
                        ExpressionKind::Unary { operator: *operator, operand: Box::new(operand) };
                    Expression::new(kind, e.span)
                };
                Some(self.parts(operand)?.map(rebuilt))
            }
            ExpressionKind::Binary { .. } => {
                let (first, operations) = e.chain();
                operations.into_iter().try_fold(self.parts(first)?, |left, one| {
                    binary(one.operator, left, self.parts(one.right)?)
                })
            }
            ExpressionKind::If { branches, otherwise } => self.chosen(branches, otherwise, e),
            ExpressionKind::Call { function, arguments } => self.call(function, arguments, e),
            ExpressionKind::ArrayIteration { element, indices } => {
                self.array_iteration(element, indices)
            }
            ExpressionKind::Real(_)
            | ExpressionKind::Integer(_)
            | ExpressionKind::Boolean(_)
            | ExpressionKind::String(_) => Some(Parts::scalar(e.clone())),
            _ => None,
        }
    }

    /// The name under which the model has the variable of a reference.
    pub(super) fn key(reference: &ComponentReference) -> String {
        let mut whole = reference.clone();
        if let Some(last) = whole.parts.last_mut() {
            last.subscripts.clear();
        }
        crate::syntax::print::reference(&whole).replace(", ", ",")
    }

    fn reference(&self, reference: &ComponentReference, e: &Expression) -> Option<Parts> {
        let known = self.0.variables.get(Self::key(reference).as_str());
        let Some(variable) = known.filter(|variable| !variable.dims.is_empty()) else {
            return Some(Parts::scalar(e.clone()));
        };
        let subscripts = &reference.parts.last()?.subscripts;
        let picks =
            (0..variable.dims.len()).map(|at| self.pick(subscripts.get(at), variable.dims[at]));
        let picks = picks.collect::<Option<Vec<_>>>()?;
        if picks.iter().any(|pick| matches!(pick, Pick::Changing)) {
            // A subscript that changes names one scalar, whichever it is.
            let is_one = picks.iter().all(|pick| !matches!(pick, Pick::Several(_)));
            return is_one.then(|| Parts::scalar(e.clone()));
        }
        let mut parts = Parts { dims: Vec::new(), scalars: Vec::new() };
        let mut positions: Vec<Vec<i64>> = vec![Vec::new()];
        for pick in picks {
            let indices = match pick {
                Pick::One(index) => vec![index],
                Pick::Several(indices) => {
                    parts.dims.push(indices.len());
                    indices
                }
                Pick::Changing => return None,
            };
            if positions.len().saturating_mul(indices.len()) > MAX_SCALARS {
                return None;
            }
            let extended = |before: &Vec<i64>| {
                indices.iter().map(|at| [before.as_slice(), &[*at]].concat()).collect::<Vec<_>>()
            };
            positions = positions.iter().flat_map(extended).collect();
        }
        parts.scalars = positions.iter().map(|at| element_of(reference, at, e)).collect();
        Some(parts)
    }

    /// What a subscript takes of a dimension.
    fn pick(&self, subscript: Option<&Subscript>, size: usize) -> Option<Pick> {
        let Some(Subscript::Index(index)) = subscript else {
            return Some(Pick::Several((1..=size as i64).collect()));
        };
        let parts = self.parts(index)?;
        let known = parts.scalars.iter().map(integer).collect::<Option<Vec<_>>>();
        match (known, parts.dims.is_empty()) {
            (Some(known), true) => known.first().copied().map(Pick::One),
            (Some(known), false) => Some(Pick::Several(known)),
            (None, true) => Some(Pick::Changing),
            (None, false) => None,
        }
    }

    fn chosen(
        &self,
        branches: &[(Expression, Expression)],
        otherwise: &Expression,
        e: &Expression,
    ) -> Option<Parts> {
        let conditions = branches.iter().map(|(condition, _)| self.only(condition));
        let conditions = conditions.collect::<Option<Vec<_>>>()?;
        let values =
            branches.iter().map(|(_, value)| self.parts(value)).collect::<Option<Vec<_>>>()?;
        let otherwise = self.parts(otherwise)?;
        if values.iter().any(|value| value.dims != otherwise.dims) {
            return None;
        }
        let scalar = |(at, last): (usize, Expression)| {
            let of_branch = conditions.iter().zip(&values);
            let branches = of_branch.map(|(c, value)| (c.clone(), value.scalars[at].clone()));
            let kind =
                ExpressionKind::If { branches: branches.collect(), otherwise: Box::new(last) };
            Expression::new(kind, e.span)
        };
        let scalars = otherwise.scalars.into_iter().enumerate().map(scalar).collect();
        Some(Parts { dims: otherwise.dims, scalars })
    }

    /// The scalar that an expression is; `None` of an array.
    fn only(&self, e: &Expression) -> Option<Expression> {
        let mut parts = self.parts(e)?;
        parts.dims.is_empty().then(|| parts.scalars.pop()).flatten()
    }

    fn array_iteration(&self, element: &Expression, indices: &[ForIndex]) -> Option<Parts> {
        let Some((outer, inner)) = indices.split_last() else { return self.parts(element) };
        let values = self.parts(outer.range.as_ref()?)?;
        let rows = values.scalars.iter().map(|value| {
            let element = with_value(element.clone(), outer.name.node, value);
            self.array_iteration(&element, inner)
        });
        Parts::stacked(rows.collect::<Option<_>>()?)
    }

    fn call(
        &self,
        function: &ComponentReference,
        arguments: &Arguments,
        e: &Expression,
    ) -> Option<Parts> {
        if !arguments.iterators.is_empty() {
            return None;
        }
        let name = function.name().to_string();
        let all = arguments.positional.iter().map(|a| self.parts(a)).collect::<Option<Vec<_>>>();
        let rebuilt = |positional: Vec<Expression>| {
            let arguments = Arguments { positional, ..arguments.clone() };
            let kind =
                ExpressionKind::Call { function: function.clone(), arguments: Box::new(arguments) };
            Expression::new(kind, e.span)
        };
        let sizes = || arguments.positional.iter().map(size).collect::<Option<Vec<_>>>();
        let literal = |value| Expression::new(ExpressionKind::Real(value), e.span);
        match name.as_str() {
            "zeros" => filled(sizes()?, literal(0.0)),
            "ones" => filled(sizes()?, literal(1.0)),
            "fill" => filled(sizes_after_first(arguments)?, self.only(&arguments.positional[0])?),
            "transpose" => transposed(all?.pop()?),
            "sum" => {
                let terms = all?.pop()?.scalars.into_iter();
                let total = terms.reduce(|a, b| operation(BinaryOperator::Add, a, b));
                Some(Parts::scalar(total.unwrap_or_else(|| literal(0.0))))
            }
            known if ONE_BY_ONE.contains(&known) => {
                let mut all = all?;
                let last = all.pop()?;
                let before: Vec<Expression> = all.into_iter().flat_map(|p| p.scalars).collect();
                Some(last.map(|scalar| rebuilt([before.clone(), vec![scalar]].concat())))
            }
            _ => {
                let returns = self.0.functions.get(&function.name());
                let is_array = returns.is_some_and(|function| {
                    function.outputs.first().is_none_or(|output| !output.dims.is_empty())
                });
                let is_known = returns.is_some();
                let scalar_arguments =
                    all.as_ref().is_some_and(|all| all.iter().all(|part| part.dims.is_empty()));
                if is_array || !(is_known || scalar_arguments) {
                    return None;
                }
                match (scalar_arguments, all) {
                    (true, Some(all)) => {
                        let positional = all.into_iter().flat_map(|part| part.scalars).collect();
                        Some(Parts::scalar(rebuilt(positional)))
                    }
                    _ => Some(Parts::scalar(e.clone())),
                }
            }
        }
    }
}

fn sizes_after_first(arguments: &Arguments) -> Option<Vec<usize>> {
    arguments.positional.get(1..)?.iter().map(size).collect()
}

fn element_of(reference: &ComponentReference, at: &[i64], e: &Expression) -> Expression {
    let mut element = reference.clone();
    if let Some(last) = element.parts.last_mut() {
        let index = |value: &i64| {
            Subscript::Index(Expression::new(ExpressionKind::Integer(*value), e.span))
        };
        last.subscripts = at.iter().map(index).collect();
    }
    Expression::new(ExpressionKind::Reference(element), e.span)
}

fn size(e: &Expression) -> Option<usize> {
    usize::try_from(integer(e)?).ok()
}

/// The expression with a value in place of a loop variable.
fn with_value(mut e: Expression, name: Ident, value: &Expression) -> Expression {
    Value { name, value }.expression(&mut e);
    e
}

/// Writes a value in place of a loop variable.
pub(super) struct Value<'v> {
    pub name: Ident,
    pub value: &'v Expression,
}

impl Rewrite for Value<'_> {
    fn expression(&mut self, e: &mut Expression) {
        match &e.kind {
            ExpressionKind::Reference(reference) if reference.as_ident() == Some(self.name) => {
                *e = self.value.clone();
            }
            _ => rewrite_expression(self, e),
        }
    }
}

/// The element of an array that only a call returns: `f(x)[2]`.
pub(super) fn selected(e: &Expression, at: &[usize]) -> Expression {
    let index = |value: &usize| {
        Subscript::Index(Expression::new(ExpressionKind::Integer(*value as i64), e.span))
    };
    let kind = ExpressionKind::Subscripted {
        base: Box::new(e.clone()),
        subscripts: at.iter().map(index).collect(),
    };
    Expression::new(kind, e.span)
}
