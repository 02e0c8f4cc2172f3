//! Random algorithms: what they compute is the same with values, in both ways of the interpreter, as
//! expressions, as code of a function, and as an algorithm section of a model.

use super::functions::interpreted;
use gapilib::internals::causalize::causalize;
use gapilib::internals::codegen::Program;
use gapilib::internals::flatten::{Library, flatten};
use gapilib::internals::name::Name;
use gapilib::internals::sim::Residual;
use gapilib::internals::source::SourceId;
use gapilib::internals::syntax::parse_stored_definition;
use proptest::prelude::*;

/// The variables that statements assign.
const ASSIGNED: [&str; 3] = ["y", "a", "b"];
/// Most statements of a body.
const MOST: usize = 4;

/// Where a statement is.
#[derive(Clone, Copy)]
struct Place {
    /// How many statements it may contain inside each other.
    depth: u32,
    /// How many for-loops are around it.
    iterators: usize,
    in_loop: bool,
    in_function: bool,
}

fn expression(place: Place) -> impl Strategy<Value = String> {
    let read = ["u", "y", "a", "b", "n", "0.7", "k"].map(str::to_owned).into_iter();
    let read: Vec<String> = read.chain((1..=place.iterators).map(|i| format!("i{i}"))).collect();
    let operand = prop::sample::select(read);
    (operand.clone(), prop::sample::select(vec!["+", "-", "*"]), operand)
        .prop_map(|(a, operator, b)| format!("sin({a} {operator} {b})"))
}

fn condition(place: Place) -> impl Strategy<Value = String> {
    let known = prop::sample::select(vec!["n > 2", "n < 4", "true", "false"]);
    prop_oneof![
        3 => (expression(place), expression(place)).prop_map(|(a, b)| format!("{a} < {b}")),
        1 => known.prop_map(str::to_owned),
    ]
}

fn body(place: Place) -> BoxedStrategy<String> {
    let inner = Place { depth: place.depth.saturating_sub(1), ..place };
    prop::collection::vec(statement(inner), 1..=MOST).prop_map(|all| all.concat()).boxed()
}

fn statement(place: Place) -> BoxedStrategy<String> {
    let assignment = (prop::sample::select(ASSIGNED.to_vec()), expression(place))
        .prop_map(|(variable, value)| format!("{variable} := {value}; "));
    if place.depth == 0 {
        return assignment.boxed();
    }
    let branches = (condition(place), body(place), condition(place), body(place), body(place))
        .prop_map(|(c, first, d, second, third)| {
            format!("if {c} then {first}elseif {d} then {second}else {third}end if; ")
        });
    let within = Place { iterators: place.iterators + 1, in_loop: true, ..place };
    let iterator = within.iterators;
    let stop = prop::sample::select(vec!["0", "1", "3", "n"]);
    let repeated = (stop, body(within))
        .prop_map(move |(stop, body)| format!("for i{iterator} in 1:{stop} loop {body}end for; "));
    let conditional = (1..4, body(Place { in_loop: true, ..place }))
        .prop_map(|(most, body)| format!("while k < {most} loop k := k + 1; {body}end while; "));
    let left = condition(place).prop_map(|c| format!("if {c} then break; end if; "));
    let returned = condition(place).prop_map(|c| format!("if {c} then return; end if; "));
    prop_oneof![
        4 => assignment,
        2 => branches,
        2 => repeated,
        1 => conditional,
        if place.in_loop { 2 } else { 0 } => left,
        if place.in_function { 1 } else { 0 } => returned,
    ]
    .boxed()
}

const BEGIN: &str = "y := u; a := 0.5*u; b := n; k := 0; ";

fn library(classes: &str) -> Library {
    let text = format!("package P {classes} end P;");
    let file = parse_stored_definition(SourceId::NONE, &text).expect("Modelica");
    let mut library = Library::new();
    library.load(&file).expect("a loadable file");
    library
}

fn function(locals: &str, statements: &str) -> String {
    format!(
        "function f input Real u; input Integer n; output Real y; \
         protected Real a; Real b; Real k; {locals} algorithm {BEGIN} {statements} end f; "
    )
}

/// The derivative of the state of a model, and how many functions have code in it.
fn derivative(classes: &str, u: f64) -> (f64, usize) {
    let library = library(classes);
    let flat = flatten(&library, &Name::parse("P.Main"), &[]).expect("a model");
    let sorted = causalize(&flat.model).unwrap_or_else(|e| panic!("{classes}: {e}"));
    let program = Program::compile(sorted).unwrap_or_else(|e| panic!("{classes}: {e}"));
    let mut value = [0.0];
    let mut system = program.system();
    system.initialize(0.0, &mut [u]).unwrap_or_else(|e| panic!("{classes}: {e:?}"));
    system.rhs(0.0, &[u], &mut value).unwrap_or_else(|e| panic!("{classes}: {e:?}"));
    (value[0], program.sorted().dae.functions.codes.len())
}

fn of_call(functions: &str, u: f64, n: &str) -> (f64, usize) {
    let model = format!(
        "model Main Real x(start = {u:?}, fixed = true); parameter Integer m = {n}; \
         equation der(x) = f(x, {n}); end Main; "
    );
    derivative(&format!("{functions}{model}"), u)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 96, ..ProptestConfig::default() })]

    #[test]
    fn functions_give_the_same_values_in_every_way(
        statements in body(Place { depth: 4, iterators: 0, in_loop: false, in_function: true }),
        u in -2.0f64..2.0, n in 0i64..5
    ) {
        let plain = function("", &statements);
        let expected = interpreted(&library(&plain), u, n);
        // An array: the way of functions of scalars is not taken.
        let general = function("Real w[1] = {0};", &statements);
        prop_assert_eq!(interpreted(&library(&general), u, n).to_bits(), expected.to_bits());
        // A loop of which the end is not known: code, not expressions.
        let code = function("", &format!("while u > 9 loop y := u + 1; break; end while; {statements}"));
        let (value, codes) = of_call(&code, u, &n.to_string());
        prop_assert_eq!(codes, 1);
        prop_assert!((value - expected).abs() <= 1e-12, "{value} {expected}");
        let (value, _) = of_call(&plain, u, &n.to_string());
        prop_assert!((value - expected).abs() <= 1e-12, "{value} {expected}");
    }

    #[test]
    fn algorithm_sections_give_the_values_of_functions(
        statements in body(Place { depth: 4, iterators: 0, in_loop: false, in_function: false }),
        u in -2.0f64..2.0, n in 0i64..5
    ) {
        let expected = interpreted(&library(&function("", &statements)), u, n);
        let model = format!(
            "model Main Real u(start = {u:?}, fixed = true); constant Integer n = {n}; \
             Real y; Real a; Real b; Real k; equation der(u) = y; \
             algorithm {BEGIN} {statements} end Main; "
        );
        let (value, _) = derivative(&model, u);
        prop_assert!((value - expected).abs() <= 1e-12, "{value} {expected}");
    }
}

/// `break` under a condition that is not known leaves the loop where it holds, and no other.
#[test]
fn a_break_that_depends_on_a_variable_leaves_its_loop_only() {
    let statements = "for i in 1:3 loop for j in 1:4 loop if j > u then break; end if; \
                      y := y + 10*i + j; end for; y := y + 100; end for; ";
    for (u, inner) in [(0.5, 0.0), (2.5, 129.0), (9.0, 270.0)] {
        let expected = interpreted(&library(&function("", statements)), u, 1);
        assert_eq!(expected, u + 300.0 + inner);
        let model = format!(
            "model Main Real u(start = {u:?}, fixed = true); constant Integer n = 1; \
             Real y; Real a; Real b; Real k; equation der(u) = y; \
             algorithm {BEGIN} {statements} end Main; "
        );
        assert_eq!(derivative(&model, u).0, expected);
        assert_eq!(of_call(&function("", statements), u, "1").0, expected);
    }
}
