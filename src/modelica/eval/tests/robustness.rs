//! Hostile input: an error, never a crash and never all the memory.

use super::host::TestHost;
use super::{fails, value_of};
use crate::eval::{Scope, evaluate};
use crate::source::SourceId;
use crate::syntax::parse_expression;
use proptest::prelude::*;

const ATOMS: &[&str] = &[
    "0",
    "1",
    "-1",
    "2.5",
    "1e308",
    "9223372036854775807",
    "true",
    "\"a\"",
    "{}",
    "{1, 2}",
    "{1.5, 2}",
    "[1, 2; 3, 4]",
    "{true, false}",
    "{\"a\", \"b\"}",
    "1:3",
    "0:0.5:1",
    "zeros(0, 2)",
    "fill(1, 2, 2, 2)",
    "identity(3)",
];

const FORMS: &[&str] = &[
    "(A + B)",
    "(A - B)",
    "(A * B)",
    "(A / B)",
    "(A ^ B)",
    "(A .+ B)",
    "(A .* B)",
    "(A ./ B)",
    "(A .^ B)",
    "(A < B)",
    "(A == B)",
    "(A and B)",
    "(-A)",
    "(not A)",
    "{A, B}",
    "[A, B]",
    "[A; B]",
    "(A)[B]",
    "(A)[end]",
    "(A)[B, :]",
    "(if A then B else A)",
    "{i for i in A}",
    "sum(A)",
    "max(A, B)",
    "min(A)",
    "product(A)",
    "transpose(A)",
    "cat(1, A, B)",
    "cat(A, B, B)",
    "mod(A, B)",
    "div(A, B)",
    "rem(A, B)",
    "integer(A)",
    "abs(A)",
    "sqrt(A)",
    "log(A)",
    "size(A)",
    "size(A, B)",
    "vector(A)",
    "matrix(A)",
    "scalar(A)",
    "diagonal(A)",
    "cross(A, B)",
    "skew(A)",
    "outerProduct(A, B)",
    "symmetric(A)",
    "promote(A, B)",
    "fill(A, B)",
    "zeros(A)",
    "linspace(A, B, B)",
    "String(A)",
    "String(A, format = B)",
    "atan2(A, B)",
    "ndims(A)",
    "semiLinear(A, B, B)",
    "sum(A * i for i in B)",
    "(A : B)",
];

fn expressions() -> impl Strategy<Value = String> {
    let atom = proptest::sample::select(ATOMS).prop_map(str::to_owned);
    atom.prop_recursive(4, 32, 2, |inner| {
        (proptest::sample::select(FORMS), inner.clone(), inner).prop_map(|(form, a, b)| {
            form.replace('A', "\u{1}").replace('B', &b).replace('\u{1}', &a)
        })
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn evaluation_never_panics(strings in proptest::collection::vec(expressions(), 8)) {
        for text in strings {
            if let Ok(expression) = parse_expression(SourceId::NONE, &text) {
                let _ = evaluate(&expression, &mut Scope::script(), &mut TestHost::default());
            }
        }
    }
}

#[test]
fn huge_arrays_are_refused_before_they_are_built() {
    for text in [
        "{i for i in 1:1000000000000}",
        "{i*j for i in 1:10000, j in 1:10000}",
        "fill(1.0, 9223372036854775807, 9223372036854775807)",
        "identity(1000000)",
        "linspace(0, 1, 1000000000000)",
        "0:1e-300:1",
    ] {
        assert!(fails(text).starts_with("array-too-large"), "{text}: {}", fails(text));
    }
}

#[test]
fn deeply_nested_expressions_are_refused_or_evaluated() {
    let mut expression = parse_expression(SourceId::NONE, "1").expect("a number");
    for _ in 0..20_000 {
        let kind = crate::syntax::ast::ExpressionKind::Unary {
            operator: crate::syntax::ast::UnaryOperator::Minus,
            operand: Box::new(expression),
        };
        expression = crate::syntax::ast::Expression::new(kind, crate::source::Span::NONE);
    }
    let result = evaluate(&expression, &mut Scope::script(), &mut TestHost::default());
    assert_eq!(result.expect_err("too deep").code.slug, "recursion-limit");
    // Dropping a tree of this depth must not overflow either: take it apart.
    while let crate::syntax::ast::ExpressionKind::Unary { operand, .. } = expression.kind {
        expression = *operand;
    }
    assert!(value_of("-(-1)").is_ok());
}
