//! Strings that are made while a model is simulated: by `String` and `+`, in equations, algorithms and
//! functions, and by external functions.

use gapilib::Diagnostic;
use gapilib::internals::causalize::causalize;
use gapilib::internals::codegen::{Access, Program};
use gapilib::internals::flatten::{Library, flatten};
use gapilib::internals::name::Name;
use gapilib::internals::runtime::System;
use gapilib::internals::sim::{OutputGrid, Settings, Simulator, Trajectory};
use gapilib::internals::source::SourceId;
use gapilib::internals::syntax::parse_stored_definition;
use std::sync::Arc;

fn translated(text: &str, class: &str) -> Result<Arc<Program>, Diagnostic> {
    let file = parse_stored_definition(SourceId::NONE, text).expect("Modelica");
    let mut library = Library::new();
    library.load(&file).expect("a loadable file");
    let flat = flatten(&library, &Name::parse(class), &[]).expect("a model").model;
    Program::compile(causalize(&flat)?)
}

fn everything() -> Arc<Program> {
    let text = include_str!("../../simulation/Texts.mo");
    translated(text, "Texts.Everything").expect("a model")
}

fn rows(system: &mut System, runs: usize) -> Trajectory {
    let output = OutputGrid::Intervals(8);
    let settings = Settings { stop: 4.0, output, ..Settings::default() };
    let mut rows = Trajectory::default();
    for _ in 0..runs {
        rows = Trajectory::default();
        Simulator::new().run(system, &settings, &mut rows).expect("a simulation");
    }
    rows
}

/// The values of a variable between the events at 1, 2, 3 and 4, and at the end.
fn values(program: &Program, system: &System, rows: &Trajectory, name: &str) -> Vec<f64> {
    let at = program.find_variable(name).expect(name);
    let Access::Observed { column, negated } = program.variables()[at].access else {
        return vec![system.value(at).expect("a constant"); 5];
    };
    let sign = if negated { -1.0 } else { 1.0 };
    let wanted = [0.5, 1.5, 2.5, 3.5].map(|time| {
        let row = rows.time().iter().position(|t| *t == time).expect("a row at the time");
        sign * rows.column(column)[row]
    });
    let last = sign * rows.column(column)[rows.len() - 1];
    wanted.into_iter().chain([last]).collect()
}

#[test]
fn strings_are_made_in_equations_algorithms_and_functions() {
    let program = everything();
    // The second run begins without the Strings of the first.
    let mut system = program.system();
    let rows = rows(&mut system, 2);
    let expected: [(&str, [f64; 5]); 10] = [
        ("k", [0.0, 1.0, 2.0, 3.0, 4.0]),
        // "n1f1", "n2f12", "n3t123", "n4t1234"
        ("n", [0.0, 4.0, 5.0, 6.0, 7.0]),
        ("is_third", [0.0, 0.0, 0.0, 1.0, 0.0]),
        ("was_none", [0.0, 1.0, 0.0, 0.0, 0.0]),
        // "k is 0 and large: false" has 23 letters.
        ("letters", [23.0, 23.0, 23.0, 22.0, 22.0]),
        ("is_two", [0.0, 0.0, 1.0, 0.0, 0.0]),
        ("begins", [1.0; 5]),
        ("y", [20.0, 20.0, 10.0, 20.0, 20.0]),
        ("behind", [2.0; 5]),
        ("is_k", [1.0; 5]),
    ];
    for (name, expected) in expected {
        let values = values(&program, &system, &rows, name);
        assert_eq!(values, expected, "{name}");
    }
}

#[test]
fn a_file_whose_name_is_made_during_the_simulation_is_refused() {
    let text = include_str!("../../data/models/run_time_strings_file_name.mo");
    let error = translated(text, "M").expect_err("the file is not known");
    assert!(error.message.contains("must be known at translation"), "{}", error.message);
}

#[test]
fn an_order_of_strings_that_are_made_during_the_simulation_is_refused() {
    let text = "model M
  Boolean b = String(integer(time)) < \"2\";
end M;";
    let error = translated(text, "M").expect_err("only equality has a meaning for numbers");
    assert!(error.message.contains("text that is unknown"), "{}", error.message);
}

/// What a function passes on to another one is not known there either.
#[test]
fn a_string_that_is_made_may_be_a_local_of_a_function_of_a_function() {
    let text = include_str!("../../data/models/run_time_strings_local.mo");
    let program = translated(text, "M").expect("a model");
    let mut system = program.system();
    let rows = rows(&mut system, 1);
    assert_eq!(values(&program, &system, &rows, "k"), [0.0, 1.0, 1.0, 2.0, 2.0]);
}
