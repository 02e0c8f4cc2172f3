//! Numbers as literals of enumerations (MLS §4.9.5.2).

use super::{Domain, Function, ResultType, Value, real, zero};

/// What `E(i)` becomes, whose literals are their numbers in the flat model: i, which is one of the
/// numbers up to the second argument.
pub(crate) const LITERAL_BY_NUMBER: &str = "'E(i)'";

pub(super) const FUNCTIONS: &[Function] = &[Function {
    domain: Some(Domain {
        contains: |x| x[0] >= 1.0 && x[0] <= x[1],
        words: "the enumeration has no literal with this number",
    }),
    result: ResultType::Integer,
    section: "MLS §4.9.5.2",
    ..real(LITERAL_BY_NUMBER, Value::Binary(literal), zero)
}];

fn literal(number: f64, count: f64) -> f64 {
    if (1.0..=count).contains(&number) { number } else { f64::NAN }
}
