//! Functions that the interpreter carries out while a model is simulated: sizes inside them are known only
//! when they are called (MLS §12.4.4).

use crate::support::program::{folder, gapi};
use crate::support::shipped;
use crate::support::simulated::{attempt, simulated};
use gapilib::Session;
use gapilib::internals::mat;
use gapilib::world::MemoryWorld;
use std::collections::BTreeMap;
use std::path::Path;

/// `d` has as many columns as the square of the largest of `s`.
const TABLE: &str = "function table input Integer s[:]; input Real x; output Real y[2]; \
    protected Integer n = max(s .* s); Real d[size(s, 1), n]; algorithm \
    d := zeros(size(s, 1), n); \
    for i in 1:size(s, 1) loop for j in 1:n loop d[i, j] := x*i*j; end for; end for; \
    y := {sum(d), n}; end table;";

#[test]
fn sizes_follow_from_the_values_of_arrays() {
    let model = format!(
        "model M {TABLE} Integer s[2] = {{integer(2*time) + 1, 2}}; \
         Real y[2] = table(s, 1 + time); end M;"
    );
    let run = simulated(&model, 2.0);
    for (time, n) in [(0.2, 4.0), (0.8, 4.0), (1.2, 9.0), (1.6, 16.0)] {
        let expected = (1.0 + time) * 3.0 * n * (n + 1.0) / 2.0;
        let value = run.at("y[1]", time);
        assert!((value - expected).abs() < 1e-9 * expected, "{value} instead of {expected}");
        assert_eq!(run.at("y[2]", time), n, "at {time}");
    }
}

/// The solution of `x = table({2, 1}, x)/60 + time/2` follows `x`, whose derivative comes from
/// differences.
#[test]
fn loops_contain_interpreted_calls() {
    let model = format!(
        "model M {TABLE} Integer s[2](each start = 2, each fixed = true); Real y[2]; Real x; equation \
         when time > 1e9 then s = {{3, 1}}; end when; \
         y = table(s, x); x = 1 + time - y[1]/60; end M;"
    );
    let run = simulated(&model, 1.0);
    // The sum is 3*10 x.
    for time in [0.0, 0.5, 1.0] {
        let (value, expected) = (run.at("x", time), (1.0 + time) / 1.5);
        assert!((value - expected).abs() < 1e-8, "{value} instead of {expected}");
    }
}

#[test]
fn initial_loops_contain_impure_calls() {
    let model = "model M \
        impure function compiled input Real a; output Real y; protected Integer i = 0; algorithm \
        while i < 2 loop i := i + 1; y := exp(a)*i; end while; end compiled; \
        impure function interpreted input Integer s[:]; input Real a; output Real y; \
        protected Integer n = max(s .* s); Real d[n] = fill(a^3, n); algorithm y := sum(d); \
        end interpreted; \
        parameter Integer s[2](each fixed = false); \
        parameter Real a(fixed = false, start = 1); parameter Real b(fixed = false, start = 1); \
        initial equation s = {integer(time) + 2, 1}; compiled(a) = 5; interpreted(s, b) = 32; \
        end M;";
    let run = simulated(model, 1.0);
    for (name, expected) in [("a", 2.5f64.ln()), ("b", 2.0)] {
        let value = run.at(name, 1.0);
        assert!((value - expected).abs() < 1e-9, "{name}: {value} instead of {expected}");
    }
}

#[test]
fn parameters_decide_the_sizes_of_results() {
    let model = "model M \
        function f input Integer m; input Integer s[:]; input Real x; output Real y[m]; \
        protected Integer n = max(s .* s); Real d[n] = fill(x, n); \
        algorithm y := fill(sum(d), m); end f; \
        parameter Integer m = 2; Integer s[2] = {integer(time) + 2, 1}; \
        Real y[2] = f(m, s, time); end M;";
    assert_eq!(simulated(model, 1.0).at("y[2]", 0.5), 2.0);
}

/// Interpreted, the inner loop would exceed the limit of statements.
#[test]
fn what_is_called_again_and_again_is_compiled() {
    let model = "model M \
        function short input Real v[:]; input Integer n; output Real y; algorithm y := 0; \
        for j in 1:800 loop y := y + v[1 + mod(j, size(v, 1))]/n; end for; end short; \
        function long input Integer s[:]; input Real x; output Real y; \
        protected Integer n = max(s .* s); Real v[n] = fill(x, n); algorithm y := 0; \
        for i in 1:8000 loop y := y + short(v, n); end for; end long; \
        parameter Integer s[2](each fixed = false); parameter Real y(fixed = false); \
        initial equation s = {integer(time) + 2, 1}; y = long(s, 0.5); end M;";
    let run = simulated(model, 0.1);
    let value = run.at("y", 0.1);
    assert!((value - 8e5).abs() < 1e-3, "{value}");
}

#[test]
fn results_beyond_the_largest_number_are_infinite() {
    let model = format!(
        "model M {TABLE} \
         function small input Integer s[:]; input Real x; output Real y; \
         protected Integer n = max(s .* s); Real d[n] = fill(exp(x), n); \
         algorithm y := n/(d[1]*1e300*1e300); end small; \
         function quotient input Real x; output Real y; protected Integer i = 0; algorithm \
         while i < 1 loop i := i + 1; y := 2/exp(x); end while; end quotient; \
         Integer s[2] = {{integer(time) + 2, 1}}; Real y = small(s, 800 + time); \
         Real z = quotient(800 + time); end M;"
    );
    let run = simulated(&model, 1.0);
    assert_eq!((run.at("y", 0.5), run.at("z", 0.5)), (0.0, 0.0));
}

/// What a simulation says that fails.
fn failure(model: &str) -> String {
    let (program, _, _, ended) = attempt(model, 1.0);
    program.explain(&ended.expect_err("a failure")).message.clone()
}

#[test]
fn failures_say_what_the_function_says() {
    let check = "function check input Integer s[:]; input Real x; output Real y; \
         protected Integer n = max(s .* s); Real d[n] = fill(x, n); \
         algorithm assert(x < 0.5, \"d is too large\"); y := d[n]; end check;";
    let model = format!(
        "model M {check} Integer s[2] = {{integer(time) + 2, 1}}; Real y = check(s, time); end M;"
    );
    let message = failure(&model);
    assert!(message.starts_with("d is too large"), "{message}");
}

#[test]
fn endless_functions_end() {
    let model = "model M \
         function endless input Integer s[:]; input Real x; output Real y; \
         protected Integer n = max(s .* s); Real d[n] = fill(x, n); \
         algorithm while x > -1 loop y := d[n]; end while; end endless; \
         Integer s[2] = {integer(time) + 2, 1}; Real y = endless(s, time); end M;";
    let message = failure(model);
    assert!(message.contains("4 million statements (`--instruction-limit`"), "{message}");
}

#[test]
fn warnings_of_assertions_let_the_simulation_go_on() {
    let model = "model M \
         function check input Integer s[:]; input Real x; output Real y; \
         protected Integer n = max(s .* s); Real d[n] = fill(x, n); \
         algorithm assert(x < 0.5, \"d is large\", AssertionLevel.warning); y := d[n]; end check; \
         Integer s[2] = {integer(time) + 2, 1}; Real y = check(s, time); end M;";
    assert_eq!(simulated(model, 1.0).at("y", 1.0), 1.0);
}

/// Looks for a file under a computed name, makes the folder and the file if they are missing, and reads
/// it: as IBPSA keeps the responses of bore fields.
const KEEPS: &str = include_str!("../../data/models/interpreted_calls_keeps.mo");

fn run(world: MemoryWorld, script: &str) -> (Session, String) {
    let streams = world.streams();
    let mut session = Session::new(Box::new(world));
    session.run_text("test.mos", script);
    (session, streams.errors())
}

const SIMULATE: &str = "openModel(\"Keeps.mo\"); \
    simulateModel(\"Keeps\", stopTime = 1, resultFile = \"r\"); \
    z := readTrajectory(\"r.mat\", {\"z\"}, readTrajectorySize(\"r.mat\")); last := z[1, end];";

fn last(session: &Session) -> f64 {
    session.variable("last").and_then(|value| value.as_real()).expect("a number")
}

#[test]
fn files_with_computed_names_are_made_and_read() {
    let world = shipped::world().with_file("Keeps.mo", KEEPS);
    let (session, errors) = run(world, SIMULATE);
    assert_eq!(errors, "");
    assert!((last(&session) - 10.0).abs() < 1e-9, "{}", last(&session));
    let bytes = session.world.read(Path::new("tmp/kept/a2.mat")).expect("the file was made");
    let content = mat::read(&bytes).expect("a MAT file");
    assert_eq!(content.matrix("y").expect("the matrix").get(0, 0), 6.0);
}

#[test]
fn files_that_are_there_already_are_read() {
    let matrix = mat::Matrix::from_rows(&[vec![20.0], vec![3.0]]);
    let file = mat::write_v4([("y", &matrix)]).expect("a file");
    let world =
        shipped::world().with_file("Keeps.mo", KEEPS).with_file("tmp/kept/a2.mat", file.as_slice());
    let (session, errors) = run(world, SIMULATE);
    assert_eq!(errors, "");
    assert!((last(&session) - 23.0).abs() < 1e-9, "{}", last(&session));
}

#[test]
fn parameters_are_bound_to_calls_that_make_files() {
    let text = KEEPS
        .replace("parameter Integer s[2](each fixed = false);", "parameter Integer s[2] = {2, 1};")
        .replace("parameter Real y[2, 1](each fixed = false);", "parameter Integer m = 2;")
        .replace("  s = {integer(time) + 2, 1};\n", "")
        .replace("  y = kept(s, x, \"a\" + String(s[1]), force);\n", "  z = 0;\n")
        .replace(
            "Real z(start = 0, fixed = true);",
            "Real z; final parameter Real y[:, :] = kept(s, x, \"a2\", force, m);",
        )
        .replace(
            "Boolean force = false;\n    output Real y[2, 1];",
            "Boolean force = false;\n    input Integer m; output Real y[m, 1];",
        );
    let world = shipped::world().with_file("Keeps.mo", text);
    let (session, errors) = run(world, SIMULATE);
    assert_eq!(errors, "");
    assert!((last(&session) - 10.0).abs() < 1e-9, "{}", last(&session));
}

/// What a function returns is a residual itself, or an entry of the Jacobian: also once the loop is
/// machine code, after a thousand evaluations, it is that of the point at hand.
#[test]
fn loops_follow_their_functions_after_many_evaluations() {
    let function = "function f input Real x; input Real t; output Real r; \
        protected Real s = 0; algorithm while s < abs(x) and s < 1 loop s := s + 1; end while; \
        r := x^3 + x - t; end f;";
    let residual = format!(
        "model M {function} Real x, z(start = 0, fixed = true); equation f(x, z) = 0; \
         der(z) = cos(time); end M;"
    );
    let slope = format!(
        "model M {function} Real x, y, u, z(start = 0, fixed = true); equation x + y = z; \
         u^3 + u = f(x, z); u^3 + u = f(y, 0); der(z) = 1 + cos(time); end M;"
    );
    for model in [residual, slope] {
        let here = folder(&[("M.mo", &model)]);
        let options = ["--method", "rungekutta", "--intervals", "1000", "--stop-time", "2"];
        let solved = [None, Some("--interpret")].map(|interpreted| {
            let all = ["simulate", "M.mo", "--model", "M", "-o", "m.csv"].into_iter();
            let all: Vec<&str> = all.chain(options).chain(interpreted).collect();
            let (code, out, errors) = gapi(&here, &all);
            assert_eq!(code, 0, "{out}{errors}");
            std::fs::read_to_string(here.path().join("m.csv")).unwrap()
        });
        assert_eq!(solved[0], solved[1]);
        let mut lines = solved[0].lines();
        let names = lines.next().unwrap().split(',').map(|name| name.trim_matches('"'));
        let values = lines.last().unwrap().split(',').map(|cell| cell.parse::<f64>().unwrap());
        let last: BTreeMap<&str, f64> = names.zip(values).collect();
        let cube = |name: &str| last.get(name).map_or(0.0, |v| v * v * v + v);
        let residual = cube("x") - last["z"] - cube("y");
        assert!(residual.abs() < 1e-8, "{last:?}: {residual}");
    }
}
