//! What stopped models of published libraries: every case is a small model with the same cause.

use crate::library_forms::{at_end, attempted};
use gapilib::flatten::{Library, flatten};
use gapilib::name::Name;
use gapilib::source::SourceId;
use gapilib::syntax::parse_stored_definition;

/// HelmholtzMedia and BranchingDynamicPipes divide by `small`, which the neutral edition of
/// `ModelicaServices` sets to the least normal number.
#[test]
fn the_machine_constants_of_a_library_are_those_of_the_program() {
    let text = "package ModelicaServices package Machine extends Icon; \
        package Icon end Icon; \
        final constant Real eps = 1e-3, small = 2.2250738585072014e-308 \"least\"; \
        final constant Real inf(unit = \"1\") = 1.7976931348623157e308; \
        final constant Integer Integer_inf = 7; constant Real other = 5; end Machine; \
        package Elsewhere constant Real small = 3; end Elsewhere; end ModelicaServices; \
        model M import ModelicaServices.Machine.*; parameter Real a[6] = {eps, small, inf, \
        Integer_inf, other, ModelicaServices.Elsewhere.small}; end M;";
    let file = parse_stored_definition(SourceId::NONE, text).expect("Modelica");
    let mut library = Library::new();
    library.load(&file).expect("a loadable file");
    let flat = flatten(&library, &Name::parse("M"), &[]).expect("a model").model;
    let values = format!("{flat}");
    let expected = "{2.220446049250313e-16, 1e-60, 1e60, 2147483647, 5.0, 3.0}";
    assert!(values.contains(expected), "{values}");
}

/// `Modelica.Math.Matrices.LAPACK.dhseqr` in a function that finds the peak of a curve of a pump.
#[test]
fn a_string_in_a_function_follows_from_a_known_condition() {
    let functions = "function length input String s; output Integer n; \
        algorithm n := if s == \"ab\" then 2 else 1; end length; \
        function f input Real a; input Boolean short = true; output Real y; \
        protected String job = if short then \"a\" else \"ab\"; \
        algorithm y := a*length(job); end f; \
        function g input Real a; output Real y; \
        algorithm y := 0; for i in 1:3 loop y := y + f(a) + 10*f(a, false); end for; end g;";
    assert_eq!(at_end(&format!("{functions} model M Real x = g(time); end M;")), 63.0);
    let varying = format!("{functions} model M Real x = f(time, time > 0.5); end M;");
    let _ = attempted(&varying).expect("a flat model");
}

/// ModelicaTest: functions that print and return whether they succeeded, called in `when initial()`.
#[test]
fn what_a_function_prints_at_the_start_becomes_a_note() {
    let contents = "function say input String s; external \"C\" ModelicaMessage(s); end say; \
        impure function check input Real a; output Boolean ok; \
        protected Real row[integer(a)]; \
        algorithm row := 1:integer(a); ok := sum(row) == 6; \
        say(\"the sum is \" + String(sum(row))); end check; \
        model M Boolean result; Real x = if result then 5 else 0; \
        algorithm when initial() then result := check(3); end when; end M;";
    assert_eq!(at_end(contents), 5.0);
    let repeated = "function say input String s; external \"C\" ModelicaMessage(s); end say; \
        impure function check output Boolean ok; \
        algorithm ok := true; say(\"again\"); end check; \
        model M Boolean result; Real x = if result then 5 else 0; \
        algorithm when sample(0.1, 0.2) then result := check(); end when; end M;";
    let flat = attempted(repeated).expect("a flat model").model;
    assert!(gapilib::causalize::causalize(&flat).is_err(), "the output of later events is lost");
}

/// FCSys gives a constant of a component the value of a parameter around it.
#[test]
fn a_constant_takes_the_known_value_of_a_parameter() {
    let contents = "model A constant Integer n = 1; Real y[n] = fill(time, n); end A; \
        model M parameter Integer n = 3; A a(final n = n); Real x = sum(a.y); end M;";
    assert_eq!(at_end(contents), 3.0);
    let open = "model A constant Integer n = 1; Real y = n*time; end A; \
        model M parameter Integer n(fixed = false); A a(final n = n); \
        initial equation n = 2; end M;";
    assert!(attempted(open).is_err());
}

/// Modelica_LinearSystems2 reads a plant from a file and says so.
#[test]
fn a_function_that_prints_gives_parameters_their_values() {
    let contents = "function say input String s; external \"C\" ModelicaMessage(s); end say; \
        impure function read input Integer n; output Real y[n]; \
        algorithm y := 1:n; say(\"read\"); end read; \
        model M parameter Integer n = 3; final parameter Real y[n] = read(n); \
        Real x = sum(y)*time; end M;";
    assert_eq!(at_end(contents), 6.0);
}
