//! What functions warn of while they run: variables that are used or returned before they are assigned,
//! zero with a warning, as other tools have it, and an error in strict mode; assertions of level warning.

use gapilib::Diagnostic;
use gapilib::internals::causalize::causalize;
use gapilib::internals::codegen::Program;
use gapilib::internals::flatten::{Library, flatten};
use gapilib::internals::name::Name;
use gapilib::internals::sim::{Residual, Settings, simulate};
use gapilib::internals::source::SourceId;
use gapilib::internals::syntax::parse_stored_definition;
use std::sync::Arc;

const FUNCTIONS: &str = include_str!("../../data/models/unassigned_variables_functions.mo");

/// A program of a class, and the warnings of its translation.
fn translated(rest: &str, strict: bool) -> Result<(Arc<Program>, Vec<String>), Vec<Diagnostic>> {
    let text = format!("model M {FUNCTIONS}\n{rest}\nend M;");
    let file = parse_stored_definition(SourceId::NONE, &text).expect("Modelica");
    let mut library = Library::new();
    library.set_strict(strict);
    library.load(&file).expect("a loadable file");
    let flattened = flatten(&library, &Name::parse("M"), &[])?;
    let mut warnings: Vec<String> = flattened.warnings.iter().map(|w| w.message.clone()).collect();
    let sorted = causalize(&flattened.model).map_err(|error| vec![error])?;
    warnings.extend(sorted.dae.warnings.iter().map(|warning| warning.message.clone()));
    Ok((Program::compile(sorted).map_err(|error| vec![error])?, warnings))
}

/// The last value of `y`, and the warnings of the simulation.
fn simulated(program: &Arc<Program>) -> Result<(f64, Vec<String>), String> {
    let mut system = program.system();
    let settings = Settings { stop: 0.25, ..Settings::default() };
    simulate(&mut system, &settings).map_err(|error| program.explain(&error).message.clone())?;
    let at = program.find_variable("y").expect("there is y");
    let mut out = [0.0];
    system.observe_only(&[at]);
    system.observe(0.25, &[], &mut out).expect("a value");
    Ok((out[0], system.notices().iter().map(|warning| warning.message.clone()).collect()))
}

const BEFORE: &str = "uses or returns a variable before it is assigned";

#[test]
fn zero_is_taken_in_simulations_with_one_warning_for_each_function() {
    for (call, value, function) in [
        ("sum_up(time)", 1.5, "M.sum_up"),
        ("branch(time)", 0.0, "M.branch"),
        ("nested(time)", 0.25, "M.nested"),
        ("root(time)", 0.5, "M.root"),
    ] {
        let (program, _) = translated(&format!("Real y = {call};"), false).expect("a model");
        let (found, warnings) = simulated(&program).expect("a simulation");
        assert_eq!(found, value, "{call}");
        let [warning] = warnings.as_slice() else { panic!("{call}: {warnings:?}") };
        assert!(warning.starts_with(&format!("`{function}` {BEFORE}")), "{warning}");
        let inner = warning.contains(", noticed in `M.branch`: zero is taken");
        assert_eq!(inner, call == "nested(time)", "{warning}");
        let (program, _) = translated(&format!("Real y = {call};"), true).expect("a model");
        let error = simulated(&program).expect_err("strict");
        assert!(error.contains("a variable has no value in the function"), "{call}: {error}");
    }
}

#[test]
fn assertions_of_level_warning_warn_once() {
    let rest = concat!(
        include_str!("../../data/models/unassigned_variables_careful.mo"),
        "Real y = careful(time);"
    );
    for strict in [false, true] {
        let (program, _) = translated(rest, strict).expect("a model");
        let (found, warnings) = simulated(&program).expect("a simulation");
        assert_eq!(found, 1.5);
        let [warning] = warnings.as_slice() else { panic!("{warnings:?}") };
        assert_eq!(
            warning,
            "x is 3 times too large (in a call of `M.careful`, maybe on the way to a solution)"
        );
    }
}

#[test]
fn functions_that_draw_random_numbers_draw_them_again() {
    let rest = "discrete Real y(start = 0, fixed = true); equation when time > 0.125 then \
                y = draw(7); end when;";
    let (program, _) = translated(rest, false).expect("a model");
    let (found, warnings) = simulated(&program).expect("a simulation");
    assert_eq!((found, warnings.len()), (7.0, 1));
}

/// What an initial section does to the hidden state it does when the simulation starts, though all
/// that it needs for it is known when the model is translated.
#[test]
fn the_hidden_state_is_set_when_a_simulation_starts() {
    let rest = "function start input Integer n; output Integer id; algorithm
          id := 4321; seed({n * i for i in 1:33}, 33, id); end start;
        parameter Integer id(fixed = false); discrete Real y(start = 0, fixed = true);
        initial algorithm id := start(7); equation
        when time > 0.125 then y = next(id); end when;";
    let (program, _) = translated(rest, false).expect("a model");
    let (first, _) = simulated(&program).expect("a simulation");
    assert!(first > 0.0 && first < 1.0, "{first}");
    // A simulation knows nothing of the one before.
    assert_eq!(simulated(&program), Ok((first, Vec::new())));
}

#[test]
fn functions_that_assign_all_they_use_have_no_warning() {
    let (program, warnings) =
        translated("Real y = all_assigned(time) + branch(1 + time);", false).expect("a model");
    assert_eq!(warnings, Vec::<String>::new());
    assert_eq!(simulated(&program), Ok((2.0, Vec::new())));
}

/// The components of a record that a function leaves out are zero where they become variables.
#[test]
fn components_without_value_are_zero_where_they_are_used() {
    let record = "record State Real a; Real b; Real c[2]; end State;
        function state input Real x; output State s; algorithm
          for i in 1:2 loop s.a := i*x; end for; s.c[1] := x; end state;
        State s = state(time);";
    let (program, _) =
        translated(&format!("{record} Real y = s.a + s.b + s.c[2];"), false).expect("a model");
    let (found, warnings) = simulated(&program).expect("a simulation");
    assert_eq!((found, warnings.len()), (0.5, 1), "{warnings:?}");
    assert!(warnings[0].starts_with(&format!("`M.state` {BEFORE}")), "{warnings:?}");
    let (program, _) = translated(&format!("{record} Real y = s.a + s.b;"), true).expect("a model");
    assert!(simulated(&program).is_err(), "strict");
}

#[test]
fn zero_is_taken_at_translation_with_a_warning() {
    let rest = "parameter Integer n = integer(sum_up(1)); Real v[n] = fill(time, n); \
                Real y = v[6];";
    let (program, warnings) = translated(rest, false).expect("a model");
    let about =
        |w: &&String| w.contains("`sum` is used before it has a value in the function `M.sum_up`");
    assert_eq!(warnings.iter().filter(about).count(), 1, "{warnings:?}");
    assert_eq!(simulated(&program).expect("a simulation").0, 0.25);
    let errors = translated(rest, true).expect_err("strict");
    assert_eq!(errors[0].code.slug, "no-value-yet");
}
