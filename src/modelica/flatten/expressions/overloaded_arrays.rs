//! Operations on arrays of operator records that follow from those of their elements: sums
//! (MLS §10.3.4) and products with matrices (MLS §14.4).

use crate::diag::Diagnostic;
use crate::fault;
use crate::flatten::errors::{SIZE_MISMATCH, TYPE_MISMATCH};
use crate::flatten::expressions::local::Local;
use crate::flatten::instantiate::instantiation::Instantiation;
use crate::name::Name;
use crate::source::Span;
use crate::syntax::ast::{BinaryOperator, Expression, ExpressionKind};

impl Instantiation<'_> {
    /// `sum(argument)` by the operators '+' and '0' of the record; `None` where the argument has
    /// no records.
    pub(crate) fn overloaded_sum(
        &mut self,
        argument: &Expression,
        local: &Local,
        span: Span,
    ) -> Result<Option<Expression>, Diagnostic> {
        let Some(record) = self.types().record_of(argument, local) else { return Ok(None) };
        if !matches!(argument.kind, ExpressionKind::Array(_)) {
            return Err(fault!(
                TYPE_MISMATCH,
                "the sum of an array of `{record}` whose elements are unknown at translation"
            )
            .at(span));
        }
        let mut terms = Vec::new();
        leaves(argument, &mut terms);
        let mut sum = None;
        for term in terms {
            sum = Some(match sum {
                None => term.clone(),
                Some(sum) => self.added(&sum, term, local, span)?,
            });
        }
        match sum {
            Some(sum) => Ok(Some(sum)),
            None => self.zero(&record, local, span).map(Some),
        }
    }

    /// The product of a matrix with a vector or a matrix of records; `None` for other operands.
    pub(crate) fn overloaded_product(
        &mut self,
        left: &Expression,
        right: &Expression,
        local: &Local,
        span: Span,
    ) -> Result<Option<Expression>, Diagnostic> {
        let (Some(rows), Some(elements)) = (matrix(left), list(right)) else { return Ok(None) };
        let columns = match matrix(right) {
            None => vec![elements.iter().collect::<Vec<_>>()],
            Some(right) => {
                let width = right.first().map_or(0, |row| row.len());
                (0..width).map(|k| right.iter().filter_map(|row| row.get(k)).collect()).collect()
            }
        };
        let is_vector = matrix(right).is_none();
        let mut product = Vec::with_capacity(rows.len());
        for row in rows {
            let mut values = Vec::with_capacity(columns.len());
            for column in &columns {
                values.push(self.inner_product(row, column, local, span)?);
            }
            product.push(match (is_vector, values.pop()) {
                (true, Some(value)) => value,
                (_, last) => {
                    values.extend(last);
                    Expression::new(ExpressionKind::Array(values), span)
                }
            });
        }
        Ok(Some(Expression::new(ExpressionKind::Array(product), span)))
    }

    fn inner_product(
        &mut self,
        row: &[Expression],
        column: &[&Expression],
        local: &Local,
        span: Span,
    ) -> Result<Expression, Diagnostic> {
        if row.len() != column.len() {
            let (columns, rows) = (row.len(), column.len());
            return Err(fault!(
                SIZE_MISMATCH,
                "a matrix of {columns} columns times an array of {rows} rows"
            )
            .at(span));
        }
        let mut sum = None;
        for (left, right) in row.iter().zip(column) {
            let operator = BinaryOperator::Multiply;
            let term = self.overloaded_binary(operator, left, right, local, span)?;
            let term = term.ok_or_else(|| {
                fault!(TYPE_MISMATCH, "a product of records that has no operator '*'").at(span)
            })?;
            sum = Some(match sum {
                None => term,
                Some(sum) => self.added(&sum, &term, local, span)?,
            });
        }
        sum.ok_or_else(|| fault!(SIZE_MISMATCH, "a product of empty arrays of records").at(span))
    }

    fn added(
        &mut self,
        sum: &Expression,
        term: &Expression,
        local: &Local,
        span: Span,
    ) -> Result<Expression, Diagnostic> {
        let added = self.overloaded_binary(BinaryOperator::Add, sum, term, local, span)?;
        added.ok_or_else(|| fault!(TYPE_MISMATCH, "records without an operator '+'").at(span))
    }

    fn zero(&mut self, record: &Name, local: &Local, span: Span) -> Result<Expression, Diagnostic> {
        let zero = self.operator_call(record, "'0'", &[], local, span)?;
        zero.ok_or_else(|| fault!(TYPE_MISMATCH, "`{record}` has no operator '0'").at(span))
    }
}

fn leaves<'a>(e: &'a Expression, terms: &mut Vec<&'a Expression>) {
    match &e.kind {
        ExpressionKind::Array(elements) => elements.iter().for_each(|one| leaves(one, terms)),
        _ => terms.push(e),
    }
}

fn list(e: &Expression) -> Option<&[Expression]> {
    match &e.kind {
        ExpressionKind::Array(elements) => Some(elements),
        _ => None,
    }
}

/// The rows of a matrix that is written out.
fn matrix(e: &Expression) -> Option<Vec<&[Expression]>> {
    let rows: Option<Vec<&[Expression]>> = list(e)?.iter().map(list).collect();
    let is_deeper = |rows: &Vec<&[Expression]>| {
        rows.iter().copied().flatten().any(|element| list(element).is_some())
    };
    rows.filter(|rows| !rows.is_empty() && !is_deeper(rows))
}
