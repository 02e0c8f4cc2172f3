//! Derivatives of simulations by parameters, against exact solutions and against differences.

use crate::support::flat_class::flat;
use crate::support::shipped::world;
use gapilib::Session;
use gapilib::internals::causalize::causalize;
use gapilib::internals::codegen::{Program, SensitivityCode};
use gapilib::internals::flatten::FlatModel;
use gapilib::internals::identify::CompiledModel;
use gapilib::internals::identify::problem::{Experiment, ModelSimulator, Observation, Simulate};
use gapilib::internals::runtime::System;
use gapilib::internals::script::models::simulation::flat_model;
use gapilib::internals::sim::{Settings, Simulator, Trajectory, find_integrator};
use proptest::prelude::*;
use std::fmt::Write as _;
use std::sync::Arc;

/// An experiment on a model written out: outputs over time.
fn simulator(
    text: &str,
    parameters: &[&str],
    outputs: &[&str],
    times: &[f64],
    tolerance: f64,
) -> ModelSimulator {
    experiment(&flat(text), parameters, outputs, ("time", times), tolerance)
}

/// An experiment on a model: outputs over X.
fn experiment(
    model: &FlatModel,
    parameters: &[&str],
    outputs: &[&str],
    (x_name, x): (&str, &[f64]),
    tolerance: f64,
) -> ModelSimulator {
    let program =
        Program::compile(causalize(model).expect("it can be sorted")).expect("it compiles");
    let observation = |name: &&str| Observation { y_name: (*name).to_owned(), x: x.to_vec() };
    let stop = if x_name == "time" { x.last().copied().unwrap_or(1.0) } else { 1.0 };
    let experiment = Experiment {
        deviations: 0,
        second_attempt: true,
        name: "test".to_owned(),
        model: Arc::new(CompiledModel::new("test", program)),
        settings: Settings { stop, tolerance, ..Settings::default() },
        x_name: x_name.to_owned(),
        observations: outputs.iter().map(observation).collect(),
        parameters: parameters.iter().map(|p| (*p).to_owned()).enumerate().collect(),
    };
    ModelSimulator::new(&[experiment]).expect("the experiment fits the model")
}

/// Values and derivatives, point by point.
#[track_caller]
fn sensitivities(simulator: &mut ModelSimulator, p: &[f64], points: usize) -> (Vec<f64>, Vec<f64>) {
    let (mut values, mut derivatives) = (vec![0.0; points], vec![0.0; points * p.len()]);
    let exact = simulator.sensitivities(p, &mut values, &mut derivatives);
    let exact = exact.unwrap_or_else(|failed| panic!("{}", failed.cause));
    assert!(exact, "{:?}", simulator.sensitivity_refusal());
    (values, derivatives)
}

/// Compares with central differences of simulations.
#[track_caller]
fn check(
    text: &str,
    parameters: &[&str],
    outputs: &[&str],
    times: &[f64],
    p: &[f64],
    tolerance: f64,
) {
    let mut simulator = simulator(text, parameters, outputs, times, 1e-10);
    compare(&mut simulator, parameters, p, outputs.len() * times.len(), tolerance);
}

/// The same for an experiment, the error relative to the largest value over the parameter.
#[track_caller]
fn compare(
    simulator: &mut ModelSimulator,
    parameters: &[&str],
    p: &[f64],
    points: usize,
    tolerance: f64,
) {
    let (values, derivatives) = sensitivities(simulator, p, points);
    let mut plain = vec![0.0; points];
    simulator.simulate(p, &mut plain).expect("it simulates");
    for (value, plain) in values.iter().zip(&plain) {
        assert!((value - plain).abs() <= 1e-6 * plain.abs().max(1e-3), "{value} {plain}");
    }
    for (k, name) in parameters.iter().enumerate() {
        let size = if p[k] == 0.0 { 1.0 } else { p[k].abs() };
        let step = 1e-4 * size;
        let mut at = |factor: f64| {
            let mut moved = p.to_vec();
            moved[k] += factor * step;
            let mut out = vec![0.0; points];
            simulator.simulate(&moved, &mut out).expect("it simulates");
            out
        };
        // Of fourth order.
        let [a, b, c, d] = [-2.0, -1.0, 1.0, 2.0].map(&mut at);
        let scale = plain.iter().fold(0.0f64, |m, v| m.max(v.abs())) / size;
        for point in 0..points {
            let difference =
                (a[point] - 8.0 * b[point] + 8.0 * c[point] - d[point]) / (12.0 * step);
            let found = derivatives[point * p.len() + k];
            let error = (found - difference).abs() / difference.abs().max(scale);
            assert!(error <= tolerance, "{name}, point {point}: {found} instead of {difference}");
        }
    }
}

#[track_caller]
fn near(value: f64, expected: f64, tolerance: f64) {
    let error = (value - expected).abs() / expected.abs().max(1e-3);
    assert!(error <= tolerance, "{value} instead of {expected}");
}

#[test]
fn decay_has_the_derivatives_of_the_exponential() {
    let text = "model M parameter Real k = 2; parameter Real x0 = 3; Real x(start = x0, fixed = true); \
                equation der(x) = -k*x; end M;";
    let times = [0.0, 0.3, 1.0, 2.0];
    let mut simulator = simulator(text, &["k", "x0"], &["x"], &times, 1e-8);
    let (values, derivatives) = sensitivities(&mut simulator, &[1.5, 4.0], 4);
    for (at, t) in times.iter().enumerate() {
        let decay = (-1.5 * t).exp();
        near(values[at], 4.0 * decay, 1e-6);
        near(derivatives[2 * at], -4.0 * t * decay, 1e-6);
        near(derivatives[2 * at + 1], decay, 1e-6);
    }
}

/// Impure functions too: what they compute once, at the start, follows the parameters.
#[test]
fn what_functions_compute_at_the_start_follows_parameters() {
    let text = include_str!("../../data/models/sensitivities_start.mo");
    check(text, &["a"], &["x"], &[0.0, 0.5, 1.0], &[0.7], 1e-6);
    let text = "model M \
        impure function compiled input Real a; output Real y; protected Integer i = 0; algorithm \
        while i < 2 loop i := i + 1; y := exp(a)*i; end while; end compiled; \
        parameter Real a = 2; discrete Real k(start = 0, fixed = true); Real x(start = 1, fixed = true); \
        equation when time > 0.4 then k = compiled(a); end when; \
        der(x) = -0.1*k*x; end M;";
    check(text, &["a"], &["x"], &[0.0, 0.5, 1.0], &[0.7], 1e-6);
}

#[test]
fn a_static_curve_has_the_derivatives_of_its_formula() {
    let text = "model M parameter Real a = 2; parameter Real b = 3; Real y; Real z; \
                equation y = a*exp(b*time); z^3 + a*z = time; end M;";
    check(text, &["a", "b"], &["y", "z"], &[0.1, 0.5, 1.0], &[2.0, 0.7], 1e-8);
}

#[test]
fn algebraic_loops_are_differentiated_implicitly() {
    let text = "model M parameter Real r = 1; parameter Real c = 2; parameter Real u0 = 0.5; \
                Real u(start = u0, fixed = true); Real i; Real d; \
                equation c*der(u) = i; i = 2 - r*i^3 - d; d + 0.1*exp(d) = u; end M;";
    check(text, &["r", "c", "u0"], &["u", "i", "d"], &[0.5, 1.0, 3.0], &[0.8, 1.7, 0.4], 1e-6);
}

#[test]
fn initial_equations_are_differentiated() {
    let text = "model M parameter Real k = 1; parameter Real u = 2; Real x; Real w; \
                initial equation der(x) = 0.3*u; equation der(x) = u - k*x^2 - 0.1*x; w = k*x; end M;";
    check(text, &["k", "u"], &["x", "w"], &[0.0, 0.5, 2.0], &[0.8, 1.7], 1e-6);
}

#[test]
fn a_reduced_index_does_not_matter() {
    let text = "model M parameter Real L = 1.2; parameter Real g = 9.81; parameter Real s0 = 0.4; \
                Real x(start = 1); Real y; Real vx; Real vy; Real T; Real phi(start = s0, fixed = true); \
                Real w(start = 0, fixed = true); \
                equation x = L*sin(phi); y = -L*cos(phi); der(x) = vx; der(y) = vy; der(phi) = w; \
                der(vx) = -T*x/L; der(vy) = -T*y/L - g; end M;";
    check(text, &["L", "g", "s0"], &["x", "y", "T"], &[0.2, 0.7, 1.5], &[1.2, 9.81, 0.4], 1e-5);
}

#[test]
fn a_bouncing_ball_jumps_in_its_derivatives() {
    let text = "model M parameter Real e = 0.8; parameter Real h0 = 1; parameter Real g = 9.81; \
                Real h(start = h0, fixed = true); Real v(start = 0, fixed = true); \
                equation der(h) = v; der(v) = -g; \
                when h <= 0 then reinit(v, -e*pre(v)); end when; end M;";
    let (e, h0, g) = (0.7, 1.3, 9.5);
    let times = [0.3, 0.7, 0.9];
    let mut simulator = simulator(text, &["e", "h0", "g"], &["h", "v"], &times, 1e-9);
    let (values, derivatives) = sensitivities(&mut simulator, &[e, h0, g], 6);
    let bounce: f64 = (2.0 * h0 / g).sqrt();
    let speed = (2.0 * g * h0).sqrt();
    for (at, t) in times.iter().enumerate() {
        let (h, of_h, of_v) = if *t < bounce {
            (h0 - 0.5 * g * t * t, [0.0, 1.0, -0.5 * t * t], [0.0, 0.0, -t])
        } else {
            // h = e w s - g s²/2 with w = √(2 g h0), s = t - √(2 h0/g).
            let s = t - bounce;
            let (w_h0, w_g) = (g / speed, h0 / speed);
            let (s_h0, s_g) = (-1.0 / (g * bounce), h0 / (g * g * bounce));
            let v = e * speed - g * s;
            (
                e * speed * s - 0.5 * g * s * s,
                [speed * s, e * w_h0 * s + v * s_h0, e * w_g * s - 0.5 * s * s + v * s_g],
                [speed, e * w_h0 - g * s_h0, e * w_g - s - g * s_g],
            )
        };
        near(values[at], h, 1e-6);
        for k in 0..3 {
            near(derivatives[3 * at + k], of_h[k], 1e-5);
            near(derivatives[3 * (3 + at) + k], of_v[k], 1e-5);
        }
    }
}

#[test]
fn switches_at_times_that_are_parameters() {
    let text = "model M parameter Real t0 = 0.5; parameter Real a = 2; Real x(start = 0, fixed = true); \
                Real u; equation u = if time >= t0 then a else 1; der(x) = u - x; end M;";
    check(text, &["t0", "a"], &["x"], &[0.2, 0.8, 2.0], &[0.55, 1.6], 1e-5);
}

/// x grows by n after k periods: x = sum of (t - k p), so that dx/dp is the negative sum of k.
#[test]
fn switches_at_times_that_events_schedule() {
    let text = "model M parameter Real p = 0.3; discrete Real next(start = p, fixed = true); \
                Integer n(start = 0, fixed = true); Real x(start = 0, fixed = true); \
                equation der(x) = n; when time >= pre(next) then n = pre(n) + 1; \
                next = pre(next) + p; end when; end M;";
    let mut simulator = simulator(text, &["p"], &["x"], &[0.4, 1.0, 2.0], 1e-10);
    let (values, derivatives) = sensitivities(&mut simulator, &[0.3], 3);
    for (at, (t, n)) in [(0.4f64, 1u32), (1.0, 3), (2.0, 6)].into_iter().enumerate() {
        let exact: f64 = (1..=n).map(|k| t - f64::from(k) * 0.3).sum();
        near(values[at], exact, 1e-9);
        near(derivatives[at], -f64::from((1..=n).sum::<u32>()), 1e-9);
    }
}

#[test]
fn switches_at_states_and_discrete_variables() {
    let text = "model M parameter Real k = 1; parameter Real limit = 0.5; parameter Real a = 2; \
                Real x(start = 0, fixed = true); discrete Real d(start = 0, fixed = true); Real y; \
                discrete Real t1(start = 0, fixed = true); \
                equation der(x) = k*(1 - x) + (if x > limit then -0.2*a else 0); \
                when x > limit then d = pre(d) + a*x + y; t1 = time; end when; \
                y = x^2 + 0.1*d + t1*time; end M;";
    let parameters = ["k", "limit", "a"];
    check(text, &parameters, &["x", "d", "y", "t1"], &[0.2, 0.8, 2.0], &[1.1, 0.45, 0.7], 1e-5);
}

/// Where many states have many parameters, right-hand sides are products with the Jacobian, and each
/// step factorizes anew: a chain with feedback, an algebraic loop, parameters that depend on others,
/// a discrete variable whose event moves, and an initial value.
#[test]
fn a_network_with_many_parameters() {
    let states = 1..=30;
    let names: Vec<String> = (1..=10).map(|k| format!("k{k}")).collect();
    let mut text = "model M ".to_owned();
    names.iter().for_each(|name| write!(text, "parameter Real {name} = 1; ").unwrap());
    text += "parameter Real both = k1 + k2*k3; parameter Real first = 0.3*both + k4; Real z; \
             discrete Real d(start = 0.1, fixed = true); ";
    for i in states.clone() {
        let start = if i == 1 { "first" } else { "0.2" };
        write!(text, "Real x{i}(start = {start}, fixed = true); ").unwrap();
    }
    text += "equation z + 0.2*z^3 = k5*x7 + d; \
             when x5 > 0.4*k6 then d = pre(d) + 0.5*k7*x2; end when; \
             der(x1) = d + z*k8 - x1*both + 0.3*k9*x30; ";
    for i in states.skip(1) {
        let (before, k) = (i - 1, i % 10 + 1);
        write!(text, "der(x{i}) = k{k}*x{before} - (1 + 0.1*k10*x{before})*x{i}*x{i}; ").unwrap();
    }
    text += "end M;";
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let p = [0.9, 0.8, 1.1, 0.7, 0.6, 1.2, 1.3, 0.4, 0.5, 1.4];
    check(&text, &names, &["x1", "x5", "x30", "z", "d"], &[0.05, 1.0, 4.0], &p, 1e-5);
}

/// Along the parameters of what is observed alone nothing is integrated: `b` reaches the solution by
/// `c`, `limit` by an event, `start` by an initial value.
#[test]
fn parameters_that_the_solution_does_not_depend_on_are_not_carried() {
    let text = "model M parameter Real scale = 2; parameter Real b = 0.5; parameter Real offset = 0.3; \
                parameter Real c = 2*b; parameter Real limit = 0.6; parameter Real start = 1; \
                parameter Real shift = offset + 1; parameter Real unused = 1; \
                Real x(start = start, fixed = true); Real y; Real z; discrete Real d(start = 0, fixed = true); \
                equation der(x) = -c*x; when x < limit then d = 0.1; end when; \
                y = scale*x + offset; z = shift*scale*x^2 + d; end M;";
    let names = ["scale", "b", "offset", "limit", "start", "unused"];
    let p = [1.5, 0.4, 0.2, 0.7, 1.1, 3.0];
    check(text, &names, &["y", "z", "x"], &[0.1, 0.5, 2.0], &p, 1e-6);
    let program = Program::compile(causalize(&flat(text)).unwrap()).unwrap();
    let parameters = names.map(|name| program.find_parameter(name).unwrap());
    let y = program.find_variable("y").unwrap();
    let code = SensitivityCode::compile(&program, &parameters, &[y]).unwrap();
    assert_eq!((code.n_parameters(), code.n_directions()), (6, 3));
}

#[test]
fn sampled_controllers_are_differentiated() {
    let text = "model M parameter Real k = 1; parameter Real w = 2; Real x(start = 0, fixed = true); \
                discrete Real u(start = 0, fixed = true); equation der(x) = u - x; \
                when sample(0, 0.25) then u = pre(u) + k*(w - x); end when; end M;";
    check(text, &["k", "w"], &["x", "u"], &[0.1, 0.6, 1.9], &[0.5, 1.5], 1e-6);
}

#[test]
fn dependent_parameters_and_those_found_at_the_start() {
    let text = "model M parameter Real a = 2; parameter Real b = a^2; parameter Real c(fixed = false); \
                Real x(start = 1, fixed = true); Real y; \
                initial equation y = 0.4*b; equation der(x) = -b*x + a; y = c*x + a; end M;";
    check(text, &["a"], &["x", "y"], &[0.0, 0.3, 1.0], &[1.3], 1e-6);
}

#[test]
fn functions_are_differentiated() {
    let text = "model M function f input Real x; input Real p; output Real y; algorithm y := 0; \
                for i in 1:3 loop y := y + p^i*sin(i*x); end for; end f; \
                parameter Real p = 0.5; Real x(start = 1, fixed = true); equation der(x) = -f(x, p); end M;";
    check(text, &["p"], &["x"], &[0.5, 2.0], &[0.6], 1e-6);
}

/// The variational equations by the classical method of Runge and Kutta, 40,000 and 80,000 steps,
/// which agree to 12 digits.
#[test]
fn van_der_pol_has_the_derivatives_of_its_variational_equations() {
    let times = [2.0, 5.0, 12.0];
    let mut simulator = simulator(VAN_DER_POL, &["mu"], &["x", "v"], &times, 1e-9);
    let (values, derivatives) = sensitivities(&mut simulator, &[5.0], 6);
    let expected = [
        (1.709233872125, 0.0636401631952),
        (0.404181594634, 1.901952362398),
        (1.956682520023, 0.203333763908),
        (-0.174386540476, 0.045953066254),
        (-2.437112684093, 8.031288872324),
        (-0.137188167741, 0.051260250215),
    ];
    for ((value, derivative), (x, of_x)) in values.iter().zip(&derivatives).zip(expected) {
        near(*value, x, 1e-5);
        near(*derivative, of_x, 1e-4);
    }
}

const VAN_DER_POL: &str = "model M parameter Real mu = 5; Real x(start = 2, fixed = true); \
     Real v(start = 0, fixed = true); equation der(x) = v; der(v) = mu*(1 - x^2)*v - x; end M;";

/// What a simulation with sensitivities costs in steps and evaluations.
#[test]
fn sensitivities_take_few_more_steps() {
    let program = Program::compile(causalize(&flat(VAN_DER_POL)).unwrap()).unwrap();
    let mu = program.find_parameter("mu").unwrap();
    let x = program.find_variable("x").unwrap();
    let mut system = program.system();
    system.observe_only(&[x]);
    let settings = Settings { stop: 12.0, tolerance: 1e-6, ..Settings::default() };
    let mut simulator = Simulator::new();
    let mut run = |system: &mut System| {
        let mut trajectory = Trajectory::default();
        let statistics = simulator.run(system, &settings, &mut trajectory).unwrap();
        (statistics, trajectory)
    };
    let (plain, before) = run(&mut system);
    assert_eq!((plain.sensitivity_evaluations, before.n_columns()), (0, 1));
    system.differentiate(Some(&SensitivityCode::compile(&program, &[mu], &[x]).unwrap()));
    let (with, trajectory) = run(&mut system);
    assert_eq!(trajectory.n_columns(), 2);
    assert!(2 * with.steps < 3 * plain.steps, "{} and {} steps", plain.steps, with.steps);
    assert!(with.sensitivity_evaluations < 3 * with.steps, "{with:?}");
    // The same bits again, and without them those of a system that never had any.
    assert_eq!(run(&mut system).1, trajectory);
    system.differentiate(None);
    assert_eq!(run(&mut system).1, before);
}

#[test]
fn stiff_kinetics_of_robertson() {
    let text = "model M parameter Real k1 = 0.04; parameter Real k2 = 3e7; parameter Real k3 = 1e4; \
                Real a(start = 1, fixed = true, nominal = 1); Real b(start = 0, fixed = true, nominal = 1e-5); \
                Real c(start = 0, fixed = true, nominal = 1); equation der(a) = -k1*a + k3*b*c; \
                der(b) = k1*a - k3*b*c - k2*b^2; a + b + c = 1; end M;";
    check(text, &["k1", "k2", "k3"], &["a", "b"], &[0.4, 40.0, 400.0], &[0.04, 3e7, 1e4], 1e-5);
}

#[test]
fn what_cannot_be_differentiated_says_why() {
    let refusal = |text: &str, parameters: &[&str]| {
        let mut simulator = simulator(text, parameters, &["x"], &[0.5, 1.0], 1e-8);
        let p = vec![0.3; parameters.len()];
        let mut derivatives = vec![0.0; 2 * p.len()];
        let exact = simulator.sensitivities(&p, &mut [0.0; 2], &mut derivatives);
        assert!(!exact.expect("it simulates"));
        simulator.sensitivity_refusal().expect("there is a reason").to_owned()
    };
    let delayed = "model M parameter Real p = 1; Real x; equation x = p*delay(time, 0.1); end M;";
    assert_eq!(refusal(delayed, &["p"]), "the model uses `delay`");
    let sampled = "model M parameter Real p = 0.3; discrete Real x(start = 0, fixed = true); \
                   equation when sample(0, p) then x = pre(x) + 1; end when; end M;";
    assert_eq!(refusal(sampled, &["p"]), "the times of a `sample` depend on the parameters");
    // z = (time - 0.5)³ + p - 0.3 passes zero without any speed.
    let touching = "model M parameter Real p = 0.3; Real x(start = 0, fixed = true); Real z; \
                    equation z = (time - 0.5)^3 + p - 0.3; der(x) = if z > 0 then 1 else 0; end M;";
    let reason = "the time of an event does not depend smoothly on the parameters";
    assert_eq!(refusal(touching, &["p"]), reason);
}

#[test]
fn other_methods_integrate_no_sensitivities_but_static_curves_need_none() {
    let of = |text: &str| {
        let program = Program::compile(causalize(&flat(text)).unwrap()).unwrap();
        let experiment = Experiment {
            deviations: 0,
            second_attempt: true,
            name: "test".to_owned(),
            model: Arc::new(CompiledModel::new("test", program)),
            settings: Settings { method: find_integrator("radau").unwrap(), ..Settings::default() },
            x_name: "time".to_owned(),
            observations: vec![Observation { y_name: "x".to_owned(), x: vec![1.0] }],
            parameters: vec![(0, "p".to_owned())],
        };
        let mut simulator = ModelSimulator::new(&[experiment]).unwrap();
        let mut derivatives = [0.0];
        let exact = simulator.sensitivities(&[2.0], &mut [0.0], &mut derivatives).unwrap();
        (exact, derivatives[0], simulator.sensitivity_refusal().map(str::to_owned))
    };
    let (exact, _, reason) = of("model M parameter Real p = 1; Real x(start = 1, fixed = true); \
                                 equation der(x) = -p*x; end M;");
    assert!(!exact);
    assert_eq!(
        reason.as_deref(),
        Some("the method `radau` does not integrate sensitivity equations")
    );
    let found = of("model M parameter Real p = 1; Real x; equation x = p^2*time; end M;");
    assert_eq!(found, (true, 4.0, None));
}

#[test]
fn static_curves_are_differentiated_point_by_point() {
    // y = p x / (q + x), and z from the loop z^3 + p z = x.
    let text = "model M parameter Real p = 1; parameter Real q = 1; parameter Real at = 1; \
                Real x = at; Real y = p*x/(q + x); Real z(start = 1); \
                equation z^3 + p*z = x; end M;";
    let program = Program::compile(causalize(&flat(text)).unwrap()).unwrap();
    let x = vec![0.5, 2.0];
    let observed = |name: &str| Observation { y_name: name.to_owned(), x: x.clone() };
    let experiment = Experiment {
        deviations: 0,
        second_attempt: true,
        name: "test".to_owned(),
        model: Arc::new(CompiledModel::new("test", program).driven_by("x", "at")),
        settings: Settings::default(),
        x_name: "x".to_owned(),
        observations: vec![observed("y"), observed("z")],
        // Parameter 1 of the problem has no effect on this experiment.
        parameters: vec![(0, "p".to_owned()), (2, "q".to_owned())],
    };
    let mut simulator = ModelSimulator::new(&[experiment]).unwrap();
    let p = [3.0, 99.0, 0.7];
    let (values, derivatives) = sensitivities(&mut simulator, &p, 4);
    for (k, x) in x.iter().enumerate() {
        near(values[k], 3.0 * x / (0.7 + x), 1e-14);
        let exact = [x / (0.7 + x), 0.0, -3.0 * x / (0.7 + x).powi(2)];
        exact.iter().enumerate().for_each(|(j, d)| near(derivatives[3 * k + j], *d, 1e-13));
        let z = values[2 + k];
        near(z * z * z + 3.0 * z, *x, 1e-12);
        near(derivatives[3 * (2 + k)], -z / (3.0 * z * z + 3.0), 1e-10);
    }
}

#[test]
fn an_x_that_depends_on_the_parameters_moves_the_points() {
    // x = 2 p t + t, y = p x²: at a given x only the factor changes.
    let text = "model M parameter Real p = 1; Real x; Real y; equation x = 2*p*time + time; \
                y = p*x^2; end M;";
    let x = [0.5, 1.7];
    let mut simulator = experiment(&flat(text), &["p"], &["y"], ("x", &x), 1e-8);
    let (values, derivatives) = sensitivities(&mut simulator, &[1.2], 2);
    for (at, x) in x.iter().enumerate() {
        // The curve is a chain of lines between 500 rows.
        near(values[at], 1.2 * x * x, 1e-4);
        near(derivatives[at], x * x, 1e-3);
    }
}

#[test]
fn the_polarization_curve_has_the_derivatives_of_its_formula() {
    let mut session = Session::new(Box::new(world()));
    let model = flat_model(&mut session, "CaseStudies.PolarizationCurve(i_max = 1.46)").unwrap();
    let names = ["A", "In", "Io", "B", "R", "Ilim"];
    let p @ [a, i_n, io, b, r, ilim] = [0.02856, 0.01077, 2.338e-7, 0.1064, 0.2559, 2.028];
    let x = [0.0, 0.0325, 0.7, 1.46];
    let mut simulator = experiment(&model, &names, &["V"], ("i", &x), 1e-6);
    let (_, derivatives) = sensitivities(&mut simulator, &p, 4);
    for (row, i) in derivatives.chunks_exact(6).zip(x) {
        let total: f64 = i + i_n;
        let rest = ilim - total;
        let expected = [
            -(total / io).ln(),
            -r - a / total - b / rest,
            a / io,
            (1.0 - total / ilim).ln(),
            -total,
            b * total / (ilim * rest),
        ];
        for (found, expected) in row.iter().zip(expected) {
            near(*found, expected, 1e-12);
        }
    }
}

#[test]
fn shipped_models_with_states_and_events() {
    let mut session = Session::new(Box::new(world()));
    let mut check = |class: &str, parameters: &[&str], p: &[f64], times: &[f64], tolerance: f64| {
        let model = flat_model(&mut session, class).expect("a model");
        let mut simulator = experiment(&model, parameters, &["V"], ("time", times), 1e-10);
        compare(&mut simulator, parameters, p, times.len(), tolerance);
    };
    let times = [3.0, 5.3, 8.0, 13.0, 24.0];
    let p = [0.034, 5.0, 10.0, 0.012];
    check("CaseStudies.LoadSteps(n = 4)", &["R_inf", "R_sup", "Cdl", "ks"], &p, &times, 1e-5);
    let p = [0.05, 5.1e-9, 1.7e-5, 1.4e-3];
    let names = ["Xs", "D12", "da_mem", "Rmem"];
    check("CaseStudies.WaterEffect(n = 3)", &names, &p, &[100.0, 2000.0, 9000.0], 1e-5);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 6, ..ProptestConfig::default() })]

    /// Two coupled states, an algebraic loop and an event whose time depends on everything.
    #[test]
    fn random_models_agree_with_differences(c in prop::array::uniform8(0.2f64..1.5)) {
        let text = "model M parameter Real a = 1; parameter Real b = 1; parameter Real c = 1; \
            parameter Real x0 = 1; parameter Real limit = 0.5; parameter Real q = 0.1; \
            parameter Real u = 1; parameter Real w = 1; \
            Real x(start = x0, fixed = true); Real y(start = 0, fixed = true); Real z; \
            discrete Real d(start = 0, fixed = true); \
            equation der(x) = -a*x + b*z/(1 + x^2) + d; der(y) = u - 0.3*c*y; z^3 + z = w*x + y; \
            when y > 0.2*limit then d = pre(d) + q*z; reinit(x, x + 0.3*w*y); end when; end M;";
        let names = ["a", "b", "c", "x0", "limit", "q", "u", "w"];
        let mut p = c;
        // The event comes before 2 s, and not at the first point.
        (p[4], p[6]) = (0.5 + 0.2 * p[4], 0.5 + p[6]);
        check(text, &names, &["x", "y", "z"], &[0.02, 2.0, 3.0], &p, 1e-4);
    }
}
