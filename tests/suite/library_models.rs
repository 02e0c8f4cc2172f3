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
    let expected = "{2.220446049250313e-16, 1e-60, 1e60, 2147483647, 5, 3}";
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
