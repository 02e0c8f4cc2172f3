//! The functions of the paper: those built in against those in Modelica, and their errors.

use crate::support::shipped;
use gapilib::Session;
use gapilib::Value;
use gapilib::internals::value::{ArrayValue, Elements};

const LOAD: &str = "openModel(\"models/GAPILib/package.mo\");\n";

/// A population of 9 with two equal fitness values and a failed one, and all that its operators
/// need.
const DATA: &str = r#"
Seed = [12345, 12345, 12345, 12345, 12345, 12345];
(Ram, Seed) := Ram_Gen_ARENA(Seed, 36);
Pop := {{Ram[1,4*(k - 1) + j]*10^j for j in 1:4} for k in 1:9};
Fitness := {3.0, 1.0, 2.0, 1.0, 1e60, 0.5, 2.0, 7.0, 0.25};
Minimum := {0.0, 1.0, 2.0, 3.0};
Maximum := {10.0, 100.0, 1000.0, 10000.0};
(RamMut, Seed) := Ram_Gen_ARENA(Seed, 28);
"#;

/// Runs `DATA` and the statements; nothing may be wrong.
fn session(statements: &str) -> Session {
    let run = shipped::run("test.mos", &format!("{DATA}{statements}"));
    // Notes say which functions are those of the loaded package.
    assert!(!run.errors.contains("error[") && !run.errors.contains("warning["), "{}", run.errors);
    run.session
}

fn reals(session: &Session, name: &str) -> Vec<f64> {
    match session.variable(name) {
        Some(Value::Array(ArrayValue { elements: Elements::Real(values), .. })) => values.clone(),
        other => panic!("`{name}` is {other:?}"),
    }
}

/// Runs `call` with the built-in function and with the one in Modelica: equal bits and shapes.
fn same(results: &str, call: &str) {
    let names: Vec<&str> = results.split(", ").collect();
    let left = |prefix: &str| {
        let variables: Vec<String> = names.iter().map(|name| format!("{prefix}{name}")).collect();
        format!("({})", variables.join(", "))
    };
    // Once the package is loaded, its functions are what the bare names call.
    let statements =
        format!("{} := {call};\n{LOAD}{} := GAPILib.Basics.{call};\n", left("b_"), left("m_"));
    let session = session(&statements);
    for name in names {
        let built_in = session.variable(&format!("b_{name}"));
        let modelica = session.variable(&format!("m_{name}"));
        assert!(built_in.is_some(), "{name} of {call}");
        assert_eq!(built_in, modelica, "{name} of {call}");
    }
}

#[test]
fn random_numbers_are_the_same_bits() {
    same("r, s", "Ram_Gen_ARENA([12345, 12345, 12345, 12345, 12345, 12345], 2000)");
    same("r, s", "Ram_Gen_ARENA([1, 0, 4294967086, 4294944442, 0, 7], 500)");
    same("r, s", "Ram_Gen_ARENA([3, 3, 3, 3, 3, 3], 0)");
}

#[test]
fn ordering_is_the_same() {
    same("p, f", "Fit_Order(Pop, Fitness, 9, 6, 1)");
}

#[test]
fn crossover_is_the_same() {
    same("c", "Cross(6, 1, Pop)");
    same("c", "Cross(7, 2, Pop, {1})");
    same("c", "Cross(5, 0, Pop, {1, 3})");
    same("c", "Cross(5, 3, Pop, {4, 0, 2})");
}

#[test]
fn mutation_is_the_same() {
    for factor in ["0.0", "0.25", "1.0"] {
        same("m", &format!("Mutation(Pop[1:7,:], {factor}, RamMut, Minimum, Maximum, 2)"));
    }
    same("m", "Mutation(Pop[1:7,:], 0.5, RamMut)");
}

#[test]
fn fitness_is_the_same_to_rounding() {
    let session = session(&format!(
        "{LOAD}Y := {{1.0, 20.0, 300.0, 4000.0}};\n\
         b := Fit(Pop, Y);\nm := GAPILib.Basics.Fit(Pop, Y);\n"
    ));
    let (built_in, modelica) = (reals(&session, "b"), reals(&session, "m"));
    assert_eq!(built_in.len(), 9);
    for (built_in, modelica) in built_in.iter().zip(&modelica) {
        assert!((built_in - modelica).abs() <= 1e-12 * modelica.abs(), "{built_in} {modelica}");
    }
}

#[test]
fn rows_and_vectors_are_both_accepted_and_shapes_are_those_of_table_2() {
    let session = session(
        "(a, b) := Ram_Gen_ARENA({12345, 12345, 12345, 12345, 12345, 12345}, 3);\n\
         f := Fit([1.0, 2.0; 3.0, 4.0], [1.0, 2.0]);\n\
         g := Fit([1.0, 2.0; 3.0, 4.0], [1.0; 2.0]);\n",
    );
    let dims = |name: &str| match session.variable(name) {
        Some(Value::Array(array)) => array.dims.clone(),
        other => panic!("{name} is {other:?}"),
    };
    assert_eq!((dims("a"), dims("b"), dims("f")), (vec![1, 3], vec![1, 6], vec![2]));
    assert_eq!(reals(&session, "a")[0], 0.12701112204657714);
    assert_eq!(reals(&session, "f"), [0.0, 8.0]);
    assert_eq!(reals(&session, "f"), reals(&session, "g"));
}

#[test]
fn elites_pass_crossover_and_mutation_unaltered() {
    let session = session(
        "(o, f) := Fit_Order(Pop, Fitness, 9, 5, 2);\n\
         n := Mutation(Cross(5, 2, o, {1}), 1.0, RamMut, Minimum, Maximum, 2);\n",
    );
    assert_eq!(reals(&session, "n")[..8], reals(&session, "o")[..8]);
}

/// Values of section 4.1 computed with the model, found again from far away; where the sum of
/// squares ends at a bound, the bound.
#[test]
fn refinement_finds_the_optimum_and_counts_as_a_generation() {
    let session = session(
        "x := 0.002:0.01:0.22;\n\
         m := \"CaseStudies.PolarizationCurve(i_max=0.22)\"; p := \"models/CaseStudies\";\n\
         y := Eval(p, m, x, [0.039, 0.0918, 0.2265], {\"A\", \"B\", \"Ilim\"}, \"i\");\n\
         (b, f, n) := Refine(p, m, x, y[1,:], [0.06, 0.03, 0.4; 0.02, 0.1, 0.23], {0.01, 0.01, 0.221}, \
         {0.1, 0.2, 0.5}, {\"A\", \"B\", \"Ilim\"}, \"i\");\n\
         (c, g) := Refine(p, m, x, y[1,:], [0.06, 0.03, 0.4], {0.04, 0.01, 0.221}, \
         {0.1, 0.2, 0.5}, {\"A\", \"B\", \"Ilim\"}, \"i\");\n",
    );
    for (found, truth) in reals(&session, "b").iter().zip([0.039, 0.0918, 0.2265]) {
        assert!((found - truth).abs() < 1e-6 * truth, "{found} {truth}");
    }
    let number = |name: &str| match session.variable(name) {
        Some(Value::Real(value)) => *value,
        Some(Value::Integer(value)) => *value as f64,
        other => panic!("`{name}` is {other:?}"),
    };
    assert!(number("f") < 1e-15 && (10.0..200.0).contains(&number("n")), "{}", number("f"));
    assert!((reals(&session, "c")[0] - 0.04).abs() < 1e-12 && number("g") > 1e-8);
}

#[test]
fn functions_that_need_the_machine_are_built_in_also_in_the_package() {
    let session = session(&format!(
        "{LOAD}(ok, sizes, x, y) := GAPILib.Basics.Exp_Adq_SISO(\
         \"scripts/data/ecsim_nafion112/c12_n20_rh50_p15psig.mat\", \"i\", \"V\");\n\
         d := GAPILib.Basics.Eval(\"models/CaseStudies\", \
         \"CaseStudies.PolarizationCurve(i_max=1.46)\", x[1:2], \
         [0.0285, 0.011, 2e-7, 0.1, 0.25, 2.0], X_Name=\"i\");\n"
    ));
    assert_eq!(reals(&session, "x").len(), 14);
    let expected =
        1.2 - 0.25 * 0.011 - 0.0285 * (0.011_f64 / 2e-7).ln() + 0.1 * (1.0 - 0.011_f64 / 2.0).ln();
    assert!((reals(&session, "d")[0] - expected).abs() < 1e-14);
}

#[test]
fn a_users_own_function_of_the_same_name_wins() {
    let session = session(
        "function Fit\n  input Real D[:,:];\n  input Real Y[:];\n  output Real e[size(D, 1)];\n\
         algorithm\n  e := fill(42.0, size(D, 1));\nend Fit;\n\
         f := Fit(Pop, {1.0, 2.0, 3.0, 4.0});\n",
    );
    assert_eq!(reals(&session, "f"), [42.0; 9]);
}

#[test]
fn wrong_arguments_are_refused_at_the_call() {
    let line = DATA.lines().count() + 1;
    for (call, code) in [
        ("Ram_Gen_ARENA([1, 1, 1, 1, 1, -1], 3)", "bad-seed"),
        ("Ram_Gen_ARENA([0, 0, 0, 1, 1, 1], 3)", "bad-seed"),
        ("Ram_Gen_ARENA({1, 1, 1}, 3)", "bad-seed"),
        ("Fit_Order(Pop, Fitness, 9, 9, 1)", "bad-population"),
        ("Fit_Order(Pop, Fitness, 8, 5, 1)", "population-size-mismatch"),
        ("Fit_Order(Pop, {1.0}, 9, 5, 1)", "population-size-mismatch"),
        ("Cross(10, 1, Pop)", "bad-population"),
        ("Cross(5, 1, Pop, {5})", "bad-cross-point"),
        ("Mutation(Pop[1:7,:], 1.5, RamMut)", "bad-mutation-factor"),
        ("Mutation(Pop[1:7,:], -0.1, RamMut)", "bad-mutation-factor"),
        ("Mutation(Pop[1:7,:], 0.5, RamMut, Maximum, Minimum)", "bad-range"),
        ("Mutation(Pop, 0.5, RamMut)", "population-size-mismatch"),
        ("Mutation(Pop[1:7,:], 0.5, RamMut, {1.0}, Maximum)", "population-size-mismatch"),
        ("Fit(Pop, {1.0})", "population-size-mismatch"),
    ] {
        let run = shipped::run("test.mos", &format!("{DATA}x := {call};\n"));
        assert_eq!((run.status.code, run.codes()), (1, vec![code]), "{call}: {}", run.errors);
        assert!(run.errors.contains(&format!("test.mos:{line}:")), "{}", run.errors);
    }
}
