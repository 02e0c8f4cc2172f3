//! Lists of 100,000 operands (MLS §A.2.7), which generated models and scripts have: they are no
//! deeper than one operand, and threads of tests have 2 MiB of stack.

use crate::support::simulated::simulated;
use gapilib::Session;
use gapilib::internals::source::SourceId;
use gapilib::internals::syntax::ast::Expression;
use gapilib::internals::syntax::{parse_expression, print};
use gapilib::world::MemoryWorld;

const TERMS: usize = 100_000;

/// Enough to leave no stack to recursion: debug builds take more than 100 bytes for a call.
const FEWER: usize = 25_000;

fn list(first: &str, rest: &str) -> String {
    format!("{first}{}", rest.repeat(TERMS))
}

fn shorter(first: &str, rest: &str) -> String {
    format!("{first}{}", rest.repeat(FEWER))
}

fn read(text: &str) -> Expression {
    parse_expression(SourceId::NONE, text).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn long_lists_are_read_copied_compared_and_printed() {
    for text in [
        shorter("a", " + b"),
        shorter("a", " * b - c"),
        shorter("a", " and not b"),
        shorter("1", " ^ 2 - (3)"),
    ] {
        let tree = read(&text);
        let again = read(&print::expression(&tree));
        assert_eq!(print::expression(&tree.clone()), print::expression(&again));
        assert!(tree == tree.clone());
    }
}

/// Sums of literals, parameters and variables, in a binding, equations and algorithms: their values
/// are exact.
#[test]
fn sums_have_their_values() {
    let mut text = include_str!("../../data/models/long_expressions_sums.mo").to_owned();
    for (name, terms) in [
        ("terms_of_f", list("u", " + u - 0.5")),
        ("terms_of_q", list("1", " + p")),
        (
            " + terms_of_all",
            (0..TERMS).map(|at| format!(" + x[{}]", at % 100 + 1)).collect::<String>(),
        ),
        ("terms_of_algorithm", list("p", " - x[2] + 1")),
    ] {
        text = text.replace(name, &terms);
    }
    let run = simulated(&text, 1.0);
    let terms = TERMS as f64;
    for (name, first, last) in [
        ("q", 1.0 + 0.5 * terms, 1.0 + 0.5 * terms),
        ("all", 1.0 + terms, 1.0 + 2.0 * terms),
        ("of_function", 1.0 + 0.5 * terms, 2.0 + 1.5 * terms),
        ("of_algorithm", 0.5, 0.5 - terms),
    ] {
        assert_eq!(run.first(name), first, "{name}");
        assert!((run.last(name) - last).abs() < 1e-4, "{name} = {}", run.last(name));
    }
}

/// The root is differentiated, and no equation is linear in `y`.
#[test]
fn products_conditions_and_equations_that_are_solved() {
    let mut text = include_str!("../../data/models/long_expressions_products.mo").to_owned();
    for (name, terms) in [
        ("terms_of_product", shorter("x", " * p / 1")),
        ("terms_of_root", shorter("x^2", " + p*x^2")),
        ("terms_of_cube", shorter("p", " + x - x")),
        ("terms_of_both", shorter("x > 0", " and p > 0")),
        ("terms_of_one", shorter("x > 10", " or x > 3")),
    ] {
        text = text.replace(name, &terms);
    }
    let run = simulated(&text, 1.0);
    let root = ((FEWER + 1) as f64).sqrt();
    for (name, last) in [
        ("product", 2.0),
        ("root", 2.0 * root),
        ("slope", root),
        ("y", 9f64.cbrt()),
        ("both", 1.0),
        ("one", 0.0),
    ] {
        let found = run.last(name);
        assert!((found - last).abs() < 1e-6 * last.max(1.0), "{name} = {found}");
    }
}

#[test]
fn expressions_of_scripts() {
    let script = format!(
        "text := {};\nsum := {};\nreals := {};\nall := {};\nnone := {};\n
        print(String(text == \"{}\") + \" \" + String(sum) + \" \" + String(reals)
          + \" \" + String(all and not none));",
        list("\"\"", " + \"ab\""),
        list("1", " + 1"),
        list("1.0", " + 0.5 - 0.25"),
        list("true", " and true"),
        list("false", " or false"),
        "ab".repeat(TERMS),
    );
    let world = MemoryWorld::new();
    let streams = world.streams();
    let status = Session::new(Box::new(world)).run_text("test.mos", &script);
    assert_eq!(streams.output(), "true 100001 25001 true\n", "{}", streams.errors());
    assert_eq!(status.code, 0);
}
