//! Numbers as literals of enumerations (MLS §4.9.5.2).

use super::{Domain, Function, ResultType, Value, real};
use crate::symbolic::node::Expr;
use crate::symbolic::pool::Pool;

/// What `E(i)` becomes, whose literals are their numbers in the flat model: i, which is positive and at
/// most the second argument.
pub(crate) const LITERAL_BY_NUMBER: &str = "'E(i)'";

pub(super) const FUNCTIONS: &[Function] = &[Function {
    domain: Some(Domain {
        contains: |x| x[0] > 0.0 && x[0] <= x[1],
        words: "the enumeration has no literal with this number",
    }),
    result: ResultType::AsArguments,
    section: "MLS §4.9.5.2",
    ..real(LITERAL_BY_NUMBER, Value::Binary(literal), by_argument)
}];

fn literal(number: f64, count: f64) -> f64 {
    if number > 0.0 && number <= count { number } else { f64::NAN }
}

fn by_argument(pool: &mut Pool, _: &[Expr], which: usize) -> Expr {
    pool.constant(if which == 0 { 1.0 } else { 0.0 })
}
