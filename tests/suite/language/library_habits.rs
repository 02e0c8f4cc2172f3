//! What libraries write and other tools take: the values of models of `tests/flattening` at the end of
//! a simulation of 1 s, and the warnings.

use crate::support::shipped;

/// The values of variables at the end, and what was said.
fn at_end(file: &str, model: &str, variables: &[&str]) -> (Vec<f64>, String) {
    let path = shipped::project("tests/flattening").join(file);
    let text = std::fs::read(path).expect("a readable file");
    let names: Vec<String> = variables.iter().map(|name| format!("\"{name}\"")).collect();
    let script = format!(
        "openModel(\"{file}\");\n\
         ok := simulateModel(\"{model}\", stopTime=1, tolerance=1e-8, resultFile=\"result\");\n\
         points := readTrajectorySize(\"result.mat\");\n\
         all := readTrajectory(\"result.mat\", {{{}}}, points);\n\
         last := all[:, points];\n",
        names.join(", ")
    );
    let world = shipped::world().with_file(file, text).with_file("test.mos", script);
    let run = shipped::run_in(world, "test.mos");
    let values = run.session.variable("last").unwrap_or_else(|| panic!("{}", run.errors));
    (values.as_reals().expect("numbers").into_owned(), run.errors)
}

#[track_caller]
fn ends(file: &str, model: &str, expected: &[(&str, f64)]) -> String {
    let names: Vec<&str> = expected.iter().map(|(name, _)| *name).collect();
    let (values, errors) = at_end(file, model, &names);
    for ((name, expected), given) in expected.iter().zip(values) {
        let error = (given - expected).abs() / expected.abs().max(1e-3);
        assert!(error <= 1e-6, "{model}.{name}: {given} instead of {expected}");
    }
    errors
}

#[test]
fn what_other_tools_take_is_a_warning() {
    let values = [
        ("decay.x", (-1f64).exp()),
        ("conditional.first", 300.0),
        ("conditional.second", 300.0),
        ("heater.h", 1000.0),
        ("valued", 3.0),
    ];
    let said = ends("tolerated_constructs.mo", "tolerated_constructs.Main", &values);
    for words in ["extends the model", "conditional component", "constraining type", "`value`"] {
        assert!(said.contains(words), "{words}: {said}");
    }
    assert!(!said.contains("error"), "{said}");
}

#[test]
fn each_is_about_one_array() {
    let values = [
        ("different[1].q", 3.0),
        ("different[2].q", 3.0),
        ("different[2].layers.material[2].k", 2.0),
        ("same[1].q", 10.0),
        ("same[2].layers.material[1].v[2]", 4.0),
    ];
    let said = ends("each_in_arrays_of_records.mo", "each_in_arrays_of_records.Main", &values);
    assert_eq!(said, "");
}

#[test]
fn a_record_of_defaults_needs_no_argument() {
    let said = ends("record_of_defaults.mo", "record_of_defaults.Main", &[("x", 0.6)]);
    assert_eq!(said, "");
}

#[test]
fn iterators_hide_variables_of_their_names() {
    let values = [("squares[3]", 9.0), ("total", 2.0), ("e", 2.0)];
    let said = ends("iterators_and_variables.mo", "iterators_and_variables", &values);
    assert_eq!(said, "");
}

#[test]
fn defaults_of_functional_arguments_use_other_inputs() {
    let values = [("p", 5.0), ("q", 11.0), ("r", 13.0)];
    let said = ends("functional_defaults.mo", "functional_defaults.Main", &values);
    assert_eq!(said, "");
}

#[test]
fn a_discrete_variable_is_one_in_later_conditions() {
    let said = ends(
        "mode_in_algorithm.mo",
        "mode_in_algorithm",
        &[("switches", 2.0), ("last", 0.61086524)],
    );
    assert_eq!(said, "");
}

#[test]
fn a_missing_file_is_named_where_its_path_is_needed() {
    let text = "model M\n\
        parameter String file = Modelica.Utilities.Files.loadResource(\"modelica://Nowhere/data.txt\");\n\
        parameter Integer n = Modelica.Utilities.Strings.length(file);\n\
        Real x = n;\n\
        end M;\n";
    let script = "openModel(\"M.mo\");\nok := simulateModel(\"M\");\n";
    let world = shipped::world().with_file("M.mo", text).with_file("test.mos", script);
    let run = shipped::run_in(world, "test.mos");
    let reason = "`file` has no value: there is no file `modelica://Nowhere/data.txt`";
    assert!(run.errors.contains(reason), "{}", run.errors);
}
