//! Equations of a flat model taken apart into equations of scalars: loops written out, arrays
//! element by element.

use super::operations::{MAX_SCALARS, integer};
use super::parts::{Apart, Value};
use crate::syntax::ast::{Equation, EquationKind, Expression, ExpressionKind, ForIndex};
use crate::syntax::visit::Rewrite;

impl Apart<'_> {
    /// The equations of scalars that these stand for; one that cannot be taken apart stays whole.
    pub(super) fn equations(&self, equations: &[Equation]) -> Vec<Equation> {
        equations.iter().flat_map(|equation| self.equation(equation)).collect()
    }

    fn equation(&self, equation: &Equation) -> Vec<Equation> {
        let with = |kind| Equation { kind, ..equation.clone() };
        match &equation.kind {
            EquationKind::Equal { left, right } => match self.sides(left, right) {
                Some(pairs) => {
                    let equal = |(left, right)| with(EquationKind::Equal { left, right });
                    pairs.into_iter().map(equal).collect()
                }
                None => vec![equation.clone()],
            },
            EquationKind::If { branches, otherwise } => vec![with(EquationKind::If {
                branches: self.branches(branches),
                otherwise: self.equations(otherwise),
            })],
            EquationKind::When { branches } => {
                vec![with(EquationKind::When { branches: self.branches(branches) })]
            }
            EquationKind::For { indices, body } => match self.written_out(indices, body) {
                Some(all) => all,
                None => vec![equation.clone()],
            },
            EquationKind::Connect { .. } | EquationKind::Call(_) => vec![equation.clone()],
        }
    }

    fn branches(
        &self,
        branches: &[(Expression, Vec<Equation>)],
    ) -> Vec<(Expression, Vec<Equation>)> {
        let branch = |(condition, equations): &(Expression, Vec<Equation>)| {
            (condition.clone(), self.equations(equations))
        };
        branches.iter().map(branch).collect()
    }

    /// The equal scalars of two equal expressions.
    fn sides(
        &self,
        left: &Expression,
        right: &Expression,
    ) -> Option<Vec<(Expression, Expression)>> {
        let (left, right) = (self.parts(left)?, self.parts(right)?);
        let is_same = left.dims == right.dims;
        is_same.then(|| left.scalars.into_iter().zip(right.scalars).collect())
    }

    fn written_out(&self, indices: &[ForIndex], body: &[Equation]) -> Option<Vec<Equation>> {
        let Some((index, inner)) = indices.split_first() else { return Some(self.equations(body)) };
        let values = self.parts(index.range.as_ref()?)?;
        let mut all = Vec::new();
        for value in &values.scalars {
            let literal = integer(value)
                .map(|value| Expression::new(ExpressionKind::Integer(value), index.name.span));
            let mut writer = Value { name: index.name.node, value: &literal? };
            let mut inner = inner.to_vec();
            for range in inner.iter_mut().filter_map(|index| index.range.as_mut()) {
                writer.expression(range);
            }
            let mut body = body.to_vec();
            body.iter_mut().for_each(|equation| writer.equation(equation));
            all.extend(self.written_out(&inner, &body)?);
            if all.len() > MAX_SCALARS {
                return None;
            }
        }
        Some(all)
    }
}
