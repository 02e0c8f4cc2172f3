//! What stopped models of published libraries: every case is a small model with the same cause.

use crate::language::library_forms::{at_end, attempted};
use gapilib::internals::flatten::{Library, flatten};
use gapilib::internals::name::Name;
use gapilib::internals::source::SourceId;
use gapilib::internals::syntax::parse_stored_definition;

/// HelmholtzMedia divides by `small`, which the neutral edition of `ModelicaServices` sets to the least
/// normal number.
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
    assert_eq!(at_end(&contents.replace("final parameter", "parameter")), 6.0);
}

/// Modelica_LinearSystems2: the sizes of a transfer function follow from its complex poles.
#[test]
fn functions_of_arrays_of_records_give_records_at_translation() {
    let contents = include_str!("../../data/models/library_models_factors.mo");
    assert_eq!(at_end(contents), 10.0 + 500.0 + 2000.0);
}

/// Modelica_DeviceDrivers assigns a component of an array of connectors.
#[test]
fn components_of_arrays_of_components_are_assigned_in_when_clauses() {
    let contents = "record A Real y; end A; \
        model M A a[2]; Real x = a[1].y + 10*a[2].y; \
        equation when time > 0.5 then a.y = {1, 2}; end when; end M;";
    assert_eq!(at_end(contents), 21.0);
    let called = "record A Real y; Real z; end A; \
        function f input Real u; output Real y; output Real z; \
        algorithm y := u; z := 2*u; end f; \
        model M A a[2]; Real x = a[1].y + 10*a[2].z; \
        equation when time > 0.5 then for i in 1:2 loop (a[i].y, a[i].z) = f(i); end for; \
        end when; end M;";
    assert_eq!(at_end(called), 1.0 + 40.0);
}

/// HelmholtzMedia: the density of butane at a pressure, from that of the critical point, around which
/// the pressure does not depend on the density.
#[test]
fn a_start_value_may_lie_where_the_residual_is_flat() {
    let contents = "function pressure input Real d; output Real p; algorithm \
        p := if d < 5 then 0.4*d else if d < 600 then 2 else 2 + 10*(d - 600); end pressure; \
        model M Real x(start = 227); Real y(start = 1, fixed = true); \
        equation 1 + 0*y = pressure(x); der(y) = x; end M;";
    assert!((at_end(contents) - 2.5).abs() < 1e-9);
}
