//! Sizes of arrays in functions that run as bytecode (MLS §12.4.4, §12.4.5).

use super::functions::{compiled, failure, library, of_model};
use crate::support::simulated::{compiled as model_of, simulated};
use gapilib::Session;
use gapilib::world::MemoryWorld;

#[test]
fn sizes_in_records_are_whole_numbers_of_the_record() {
    // Σ i u, i = 1 … 3, and twice 2 u.
    let functions = "record S parameter Integer m = 2; Real x[m]; end S; \
        function made input Real u; input Integer m; output S s(m = m); algorithm \
        for i in 1:m loop s.x[i] := i*u; end for; end made; \
        function f {h} protected S s(m = 3) = made(u, 3); S r; Integer k = 0; algorithm \
        while k < 1 loop k := k + 1; r.x := {u, u}; end while; \
        y := sum(s.x) + sum(r.x)*r.m; end f;";
    let program = compiled(&library(functions)).expect("it compiles");
    let (value, slope) = of_model(&mut program.system(), 0.5, 0).expect("a value");
    assert_eq!((value, slope), (5.0, 10.0));
}

#[test]
fn functions_take_arrays_of_strings() {
    let functions = "function f {h} algorithm y := u; check({\"one\", \"two\"}, u); end f; \
        function check input String names[:]; input Real u; protected Integer k = 0; algorithm \
        while k < 2 loop k := k + 1; assert(u < 0, \"bad \" + names[k]); end while; end check;";
    assert_eq!(failure(functions), "assertion-failed: bad … (at t = 0)");
}

/// An array that grows while its function runs is known only where its arguments are.
#[test]
fn arrays_that_grow_are_run_for_known_arguments() {
    let model = include_str!("../../data/models/function_sizes_growing.mo");
    let world = MemoryWorld::new().with_file("M.mo", model);
    let streams = world.streams();
    let script = "openModel(\"M.mo\"); simulateModel(\"Grows\");";
    let status = Session::new(Box::new(world)).run_text("s.mos", script);
    assert_eq!((status.code, streams.errors().as_str()), (0, ""));
}

#[test]
fn sizes_that_vary_at_run_time_are_those_of_the_instant() {
    let functions = "function squares input Integer n; output Real y[n]; algorithm \
        for i in 1:n loop y[i] := i^2; end for; end squares; \
        function total input Integer n; input Real w; output Real s; protected Real c[n]; \
        algorithm c := squares(n); s := w*sum(c); end total;";
    let model = |n: &str| {
        format!("model M {functions} Integer n = {n}; Real y = total(n, 1 + time); end M;")
    };
    let run = simulated(&model("if time < 0.5 then 2 elseif time < 0.75 then 0 else 4"), 1.0);
    for (time, sum) in [(0.2, 5.0), (0.6, 0.0), (0.8, 30.0)] {
        let (value, expected) = (run.at("y", time), (1.0 + time) * sum);
        assert!((value - expected).abs() < 1e-12, "{value} instead of {expected} at {time}");
    }
    // For more than 32 it is not compiled but interpreted.
    let run = simulated(&model("if time < 0.5 then 2 else 40"), 1.0);
    assert!((run.at("y", 0.8) - 1.8 * 22_140.0).abs() < 1e-8);
}

#[test]
fn sizes_of_results_must_not_vary_at_run_time() {
    let text = "model M function f input Integer n; output Real y[n]; algorithm \
        for i in 1:n loop y[i] := i; end for; end f; \
        Integer n = if time < 0.5 then 2 else 3; Real y[2] = f(n); end M;";
    let error = model_of(text).map(|_| ()).expect_err("sizes that vary");
    assert!(
        error.message.contains("depend") || error.message.contains("known"),
        "{}",
        error.message
    );
}

/// Values at 1 s, computed by hand.
#[test]
fn sizes_that_a_function_computes_are_not_bounded_by_its_arrays() {
    let models = include_str!("../../data/models/function_sizes_computed.mo");
    for (model, variable, expected) in [
        ("Early", "y", 3.0),
        ("InLoop", "y", 7.0),
        ("Made", "y", 4.0 + 10.0 + 4.0),
        ("OfArray", "y", 6.0 + 6.0 + 25.0),
        ("Beyond", "y", 20.0 + 2.0),
        ("Statement", "y", 56.0),
        ("Statement", "z", 7.0),
        ("Dependent", "y", 25.0),
    ] {
        let text = format!("{models}\nmodel Own = Computed.{model};");
        let value = simulated(&text, 1.0).last(variable);
        assert!((value - expected).abs() < 1e-9, "{model}: {value}");
    }
}

/// Slices whose ends a computed Integer gives: without elements where it is negative, and with all of
/// them where it exceeds the array by what is subtracted from it.
#[test]
fn slices_end_where_a_computed_integer_says() {
    // Each is Σ i u over the first m - 3 of 6 elements, m between -4 and 9.
    for body in [
        "y := sum(x[1:m - 3]);",
        "y := x[1:m - 3]*x[1:m - 3]/u;",
        "y := sum(x[i] for i in 1:m - 3);",
        "m := m - 3; y := sum(x[1:m]);",
        "m := m - 3; z[1:m] := x[1:m]; y := sum(z);",
        "z[4:m] := x[1:m - 3]; y := sum(z);",
        "m := m - 3; y := total(x[1:m]);",
        "m := m - 3; y := sum(cat(1, x[1:m], {0.0}));",
    ] {
        let square = body.contains('*');
        let text = format!(
            "model M function total input Real v[:]; output Real s = sum(v); algorithm end total;
             function f input Real u; input Real from; output Real y; protected Integer m, k = 0;
             Real x[6] = {{i*u for i in 1:6}}; Real z[9] = zeros(9); algorithm
             while k < 1 loop k := k + 1; m := integer(from); {body} end while; end f;
             Real y = f(2, if time < 0.25 then -3.5 elseif time < 0.5 then 2.5 elseif
             time < 0.75 then 5.5 else 9.5); end M;"
        );
        let run = simulated(&text, 1.0);
        for (time, n) in [(0.1, 0), (0.3, 0), (0.6, 2), (0.9, 6)] {
            let element = |i: i32| if square { 2.0 * f64::from(i * i) } else { 2.0 * f64::from(i) };
            let expected: f64 = (1..=n).map(element).sum();
            let value = run.at("y", time);
            assert!((value - expected).abs() < 1e-9, "{body}: {value}, not {expected}, at {time}");
        }
    }
}
