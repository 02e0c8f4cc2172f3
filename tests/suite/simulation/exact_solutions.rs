//! Compiled models against exact solutions.

use crate::support::flat_class::flat;
use gapilib::internals::causalize::causalize;
use gapilib::internals::codegen::{Access, Program};
use gapilib::internals::runtime::System;
use gapilib::internals::sim::{Residual, Settings, Trajectory, simulate};
use std::sync::Arc;

fn compiled(text: &str) -> Arc<Program> {
    Program::compile(causalize(&flat(text)).expect("the model can be sorted")).expect("it compiles")
}

/// The code of the diagnostic that sorting or compiling gives.
fn refused(text: &str) -> &'static str {
    match causalize(&flat(text)).and_then(Program::compile) {
        Ok(_) => panic!("the model is accepted"),
        Err(diagnostic) => diagnostic.code.slug,
    }
}

fn run(system: &mut System, stop: f64) -> Trajectory {
    let settings = Settings { stop, tolerance: 1e-8, ..Settings::default() };
    simulate(system, &settings).expect("the simulation succeeds").0
}

/// The last value of a variable.
fn last(program: &Program, system: &System, trajectory: &Trajectory, name: &str) -> f64 {
    let at = program.find_variable(name).expect("the variable exists");
    match program.variables()[at].access {
        Access::Observed { column, negated } => {
            let value = trajectory.column(column)[trajectory.len() - 1];
            if negated { -value } else { value }
        }
        Access::Time => trajectory.time()[trajectory.len() - 1],
        _ => system.value(at).expect("a parameter has a value"),
    }
}

/// The value of a variable at the end of a simulation of `stop` seconds.
fn simulated(text: &str, stop: f64, name: &str) -> f64 {
    let program = compiled(text);
    let mut system = program.system();
    let trajectory = run(&mut system, stop);
    last(&program, &system, &trajectory, name)
}

#[track_caller]
fn near(value: f64, expected: f64, tolerance: f64) {
    let error = (value - expected).abs() / expected.abs().max(1.0);
    assert!(error <= tolerance, "{value} instead of {expected}");
}

const DECAY: &str =
    "model Decay parameter Real k = 2; Real x(start = 3); equation der(x) = -k*x; end Decay;";

#[test]
fn decay_is_an_exponential() {
    near(simulated(DECAY, 1.0, "x"), 3.0 * (-2.0f64).exp(), 1e-6);
}

#[test]
fn a_first_step_does_not_leap_over_what_is_periodic() {
    let text = "model P Real x(start = 0, fixed = true);
        equation der(x) = 1 - cos(200*3.14159265358979*time); end P;";
    near(simulated(text, 1.0, "x"), 1.0, 1e-4);
}

#[test]
fn a_slope_that_is_multiplied_by_zero_need_not_exist() {
    let text = "model R Real x(start = -0.1, fixed = true);
        equation der(x) = -noEvent(sqrt(max(0, x))); end R;";
    near(simulated(text, 1.0, "x"), -0.1, 0.0);
}

#[test]
fn a_derivative_with_a_coefficient_of_zero_makes_no_state() {
    let text = "model C Real v; Real i; Real c; Real d;
        equation d = 0; c = 2*d; i = c*der(v); v + 3*i = sin(time); end C;";
    let program = compiled(text);
    assert_eq!(program.system().n_differential(), 0);
    near(simulated(text, 1.0, "v"), 1.0f64.sin(), 1e-9);
}

#[test]
fn a_parameter_is_set_without_compiling_again() {
    let program = compiled(DECAY);
    let k = program.find_parameter("k").unwrap();
    let mut system = program.system();
    for value in [0.5, 1.0, 2.0] {
        system.set_parameter(k, value).unwrap();
        let trajectory = run(&mut system, 1.0);
        near(last(&program, &system, &trajectory, "x"), 3.0 * (-value).exp(), 1e-6);
    }
    assert_eq!(program.find_parameter("K").unwrap_err().code.slug, "unknown-parameter");
    assert_eq!(program.find_variable("y").unwrap_err().code.slug, "unknown-variable");
}

#[test]
fn what_parameters_determine_follows_them_from_run_to_run() {
    let program = compiled(
        "model P parameter Real k = 2; parameter Real n = 0; Real x(start = 3); Real y;
         equation der(x) = -k/(1 + k)*sqrt(k)*x; y = x*(if n > 0 then k/n else 1 + k); end P;",
    );
    let [k, n] = ["k", "n"].map(|name| program.find_parameter(name).unwrap());
    let mut system = program.system();
    for (value, divisor) in [(0.5, 0.0), (2.0, 4.0), (1.0, 0.0)] {
        system.set_parameter(k, value).unwrap();
        system.set_parameter(n, divisor).unwrap();
        let trajectory = run(&mut system, 1.0);
        let x = 3.0 * (-value / (1.0 + value) * value.sqrt()).exp();
        let factor = if divisor > 0.0 { value / divisor } else { 1.0 + value };
        near(last(&program, &system, &trajectory, "x"), x, 1e-6);
        near(last(&program, &system, &trajectory, "y"), x * factor, 1e-6);
    }
}

#[test]
fn what_parameters_make_impossible_fails_with_its_equation() {
    let program = compiled(
        "model P parameter Real n = 0; Real x(start = 3); equation der(x) = x + 1/n; end P;",
    );
    let error = simulate(&mut program.system(), &Settings::default()).unwrap_err();
    let diagnostic = program.explain(&error);
    assert_eq!(diagnostic.code.slug, "domain-error", "{diagnostic:?}");
    assert_eq!(error.time, 0.0);
}

#[test]
fn runs_do_not_depend_on_those_before() {
    let program = compiled(DECAY);
    let mut system = program.system();
    let first = run(&mut system, 1.0);
    system.set_parameter(0, 7.0).unwrap();
    run(&mut system, 1.0);
    system.reset_parameters();
    assert_eq!(run(&mut system, 1.0), first);
}

#[test]
fn dependent_parameters_follow() {
    let text = "model M parameter Real b = 2*a; parameter Real a = 3; final parameter Real c = a + b; Real x = c*time; end M;";
    let program = compiled(text);
    let mut system = program.system();
    let trajectory = run(&mut system, 1.0);
    near(last(&program, &system, &trajectory, "x"), 9.0, 1e-14);
    system.set_parameter(program.find_parameter("a").unwrap(), 5.0).unwrap();
    let trajectory = run(&mut system, 1.0);
    near(last(&program, &system, &trajectory, "x"), 15.0, 1e-14);
    system.set_parameter(program.find_parameter("b").unwrap(), 1.0).unwrap();
    let trajectory = run(&mut system, 1.0);
    near(last(&program, &system, &trajectory, "x"), 6.0, 1e-14);
}

#[test]
fn rc_circuit_charges() {
    let text = "model RC parameter Real R = 10; parameter Real C = 0.01; Real vR; Real vC(start = 0); Real i; Real iC; Real v0;
        equation v0 = 5; v0 = vR + vC; vR = R*i; iC = C*der(vC); iC = -(-i); end RC;";
    near(simulated(text, 0.2, "vC"), 5.0 * (1.0 - (-2.0f64).exp()), 1e-6);
    near(simulated(text, 0.2, "iC"), 0.5 * (-2.0f64).exp(), 1e-5);
}

#[test]
fn linear_and_nonlinear_loops_are_solved() {
    let linear = "model L Real x; Real y; equation x + time*y = 3; x - y = 1; end L;";
    near(simulated(linear, 1.0, "x"), 2.0, 1e-6);
    let nonlinear = "model N Real x(start = 1); Real y(start = 1); equation x^2 + y^2 = 1 + time; x = exp(y) - 1; end N;";
    let program = compiled(nonlinear);
    let mut system = program.system();
    let trajectory = run(&mut system, 1.0);
    let (x, y) =
        (last(&program, &system, &trajectory, "x"), last(&program, &system, &trajectory, "y"));
    near(x * x + y * y, 2.0, 1e-6);
    near(x, y.exp() - 1.0, 1e-9);
}

#[test]
fn arrays_and_loops_are_scalars() {
    let text =
        "model A Real x[3](start = {1, 2, 3}); Real s; parameter Real M[3,3] = diagonal({1, 2, 3});
        equation der(x) = -M*x; s = sum(x[i]*i for i in 1:3) + max(x[2:end]); end A;";
    let e = |k: f64| k * (-k).exp();
    let (a, b, c) = (e(1.0), e(2.0), e(3.0));
    near(simulated(text, 1.0, "s"), a + 2.0 * b + 3.0 * c + b.max(c), 1e-6);
    let chain = "model C Real x[4]; equation x[1] = time; for i in 2:4 loop x[i] = x[i-1]*2; end for; end C;";
    near(simulated(chain, 1.0, "x[4]"), 8.0, 1e-14);
}

#[test]
fn relations_switch_at_events() {
    let text = "model R Real x(start = 0); equation der(x) = if time < 0.3 then 1 else -2; end R;";
    near(simulated(text, 1.0, "x"), 0.3 - 1.4, 1e-7);
    let state = "model S Real x(start = 1); equation der(x) = if x > 0.5 then -1 else -0.1; end S;";
    near(simulated(state, 1.0, "x"), 0.45, 1e-6);
    let branches = "model B Real x(start = 0); Real y; equation if time > 0.5 then y = 1; der(x) = y; else y = 3; der(x) = 2*y; end if; end B;";
    near(simulated(branches, 1.0, "x"), 3.5, 1e-6);
}

#[test]
fn a_branch_that_is_not_taken_is_not_evaluated() {
    let text = "model G Real y = noEvent(if time > 2 then log(-1 - time) else time); end G;";
    near(simulated(text, 1.0, "y"), 1.0, 1e-14);
}

#[test]
fn initial_equations_determine_states() {
    let steady = "model I Real x; equation der(x) = 4 - 2*x; initial equation der(x) = 0; end I;";
    near(simulated(steady, 1.0, "x"), 2.0, 1e-9);
}

#[test]
fn failures_are_told_in_the_models_words() {
    let text = "model F parameter Real lim = 0.5; Real y; equation y = log(lim - time); assert(time < lim, \"beyond the limit\"); end F;";
    let program = compiled(text);
    let mut system = program.system();
    let error = simulate(&mut system, &Settings::default()).unwrap_err();
    let diagnostic = program.explain(&error);
    assert_eq!(diagnostic.code.slug, "assertion-failed");
    assert!(diagnostic.message.contains("beyond the limit"), "{diagnostic}");
    let bare = compiled("model F Real y; equation y = log(0.5 - time); end F;");
    let error = simulate(&mut bare.system(), &Settings::default()).unwrap_err();
    let diagnostic = bare.explain(&error);
    assert_eq!(diagnostic.code.slug, "domain-error");
    assert!(diagnostic.message.contains("`log`"), "{diagnostic}");
}

#[test]
fn what_is_not_handled_is_refused() {
    assert_eq!(refused("model M Real x; Real y; equation x = 1; end M;"), "unbalanced-model");
    assert_eq!(refused("model M Real x; Real y; equation x = 1; x = 2; end M;"), "singular-system");
    assert_eq!(
        refused("model M Real x = time; Boolean b = noEvent(x > 1); end M;"),
        "not-discrete"
    );
    assert_eq!(
        refused("model M parameter Real a = b; parameter Real b = a; Real x = a; end M;"),
        "parameter-cycle"
    );
    assert_eq!(refused("model M parameter Real a; Real x = a; end M;"), "parameter-without-value");
    assert_eq!(refused("model M Real x[2] = {1, 2, 3}; end M;"), "array-mismatch");
}

const POLARIZATION: &str = "model P parameter Real Eoc = 1.2; parameter Real R = 0.73; parameter Real In = 1.4e-3;
    parameter Real A = 0.039; parameter Real Io = 1.5856e-6; parameter Real B = 0.0918; parameter Real Ilim = 0.2265;
    parameter Real i_max = 0.22; Real i; Real V; equation i = i_max*time;
    V = Eoc - R*(i + In) - A*log((i + In)/Io) + B*log(1 - (i + In)/Ilim); end P;";

#[test]
fn the_jacobian_agrees_with_differences() {
    let text = "model J Real x(start = 0.3); Real y(start = 0.7); Real z(start = 0.2); Real w; equation w = x*exp(y) + sin(z);
        der(x) = -w*x + z; der(y) = w^2 - y*z; der(z) = if x > 0.1 then w/(1 + x^2) else x; end J;";
    jacobian_agrees(text);
}

/// Compares the Jacobian of a system of three states with differences.
fn jacobian_agrees(text: &str) {
    let program = compiled(text);
    let mut system = program.system();
    let mut y = vec![0.0; 3];
    system.initialize(0.0, &mut y).unwrap();
    let pattern = system.pattern().clone();
    let mut values = vec![0.0; pattern.rows.len()];
    system.jacobian(0.0, &y, &mut values).unwrap();
    for column in 0..3 {
        let (mut up, mut down) = (vec![0.0; 3], vec![0.0; 3]);
        let (mut a, mut b) = (y.clone(), y.clone());
        a[column] += 1e-6;
        b[column] -= 1e-6;
        system.rhs(0.0, &a, &mut up).unwrap();
        system.rhs(0.0, &b, &mut down).unwrap();
        for row in 0..3 {
            let entries = pattern.column_starts[column]..pattern.column_starts[column + 1];
            let entry =
                entries.clone().find(|e| pattern.rows[*e] == row).map_or(0.0, |e| values[e]);
            near(entry, (up[row] - down[row]) / 2e-6, 1e-7);
        }
    }
}

#[test]
fn the_polarization_curve_needs_no_states() {
    let program = compiled(POLARIZATION);
    let v = program.find_variable("V").unwrap();
    let i = program.find_variable("i").unwrap();
    assert!(!program.needs_states(&[v, i]));
    let r = program.find_parameter("R").unwrap();
    assert!(program.depends_on_parameters(v, &[r]));
    assert!(!program.depends_on_parameters(i, &[r]));
    let mut system = program.system();
    system.observe_only(&[i, v]);
    system.initialize(0.0, &mut []).unwrap();
    let mut out = [0.0; 2];
    system.observe(0.5, &[], &mut out).unwrap();
    let j: f64 = 0.11 + 1.4e-3;
    let expected = 1.2 - 0.73 * j - 0.039 * (j / 1.5856e-6).ln() + 0.0918 * (1.0 - j / 0.2265).ln();
    near(out[0], 0.11, 1e-15);
    near(out[1], expected, 1e-14);
}

const FUNCTIONS: &str = "
    function horner input Real c[:]; input Real x; output Real y; algorithm
        y := 0; for i in size(c, 1):-1:1 loop y := y*x + c[i]; end for; end horner;
    function both input Real a; input Real b[2]; output Real s; output Real v[2]; Real t; algorithm
        t := a*b[1]; if t > 0 then s := t^2; else s := -t; end if;
        for k in 1:2 loop v[k] := b[k]*s; end for; end both;
    function unassigned input Real a; output Real y; algorithm if a > 0 then y := 1; end if; end unassigned;
    function outside input Real a; output Real y; external \"C\"; end outside;
    function endless input Real a; output Real y; algorithm y := endless(a + 1); end endless;";

#[test]
fn functions_in_equations_are_carried_out() {
    let model = |rest: &str| format!("model F {FUNCTIONS} {rest} end F;");
    let text = model("Real y; equation y = horner({1, 2, 3}, time);");
    near(simulated(&text, 2.0, "y"), 1.0 + 4.0 + 12.0, 1e-14);
    let text = model("Real s; Real v[2]; equation (s, v) = both(time, {-3, 2});");
    near(simulated(&text, 1.0, "v[2]"), 6.0, 1e-14);
    assert_eq!(refused(&model("Real y = outside(time);")), "not-supported");
    // What depends on the argument is known when the function runs.
    for (call, words) in [
        ("unassigned(time - 1)", "a variable has no value in the function `unassigned`"),
        ("endless(time)", "calls are nested too deeply in the function `endless`"),
    ] {
        let mut flat = flat(&model(&format!("Real y = {call};")));
        flat.strict = true;
        let program = Program::compile(causalize(&flat).expect("a model")).expect("a model");
        let error = simulate(&mut program.system(), &Settings::default()).expect_err(call);
        let diagnostic = program.explain(&error);
        assert!(diagnostic.message.contains(words), "{}", diagnostic.message);
    }
}

#[test]
fn functions_are_differentiated() {
    let text = format!("model F {FUNCTIONS} Real x(start = 0.4); Real y(start = 0.5); Real z(start = 0.6);
        equation der(x) = horner({{x, y, z}}, y); (der(y), {{der(z), w}}) = both(x, {{y, z}}); Real w; end F;");
    let text =
        text.replace(" Real w; end F;", " end F;").replace("Real z(start", "Real w; Real z(start");
    jacobian_agrees(&text);
}

#[test]
fn the_name_of_an_enumeration_variable_is_compared_by_number() {
    let run = crate::support::simulated::simulated(
        "model M type E = enumeration(low, high); E e = if time > 0.5 then E.high else E.low;
         Boolean b = String(e) == \"high\"; end M;",
        1.0,
    );
    assert_eq!((run.at("b", 0.2), run.at("b", 0.8)), (0.0, 1.0));
}
