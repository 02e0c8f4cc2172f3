//! Derivatives of simulations by parameters, against exact solutions and against differences.

use super::flat_class::flat;
use gapilib::compile::Program;
use gapilib::dae::sort;
use gapilib::identify::CompiledModel;
use gapilib::identify::problem::{Experiment, ModelSimulator, Observation, Simulate};
use gapilib::sim::Settings;
use std::sync::Arc;

/// An experiment on a model: outputs over time.
fn simulator(
    text: &str,
    parameters: &[&str],
    outputs: &[&str],
    times: &[f64],
    tolerance: f64,
) -> ModelSimulator {
    let program =
        Program::compile(sort(&flat(text)).expect("it can be sorted")).expect("it compiles");
    let observation = |name: &&str| Observation { y_name: (*name).to_owned(), x: times.to_vec() };
    let stop = times.last().copied().unwrap_or(1.0);
    let experiment = Experiment {
        name: "test".to_owned(),
        model: Arc::new(CompiledModel::new("test", program)),
        settings: Settings { stop, tolerance, ..Settings::default() },
        x_name: "time".to_owned(),
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
    let points = outputs.len() * times.len();
    let (values, derivatives) = sensitivities(&mut simulator, p, points);
    let mut plain = vec![0.0; points];
    simulator.simulate(p, &mut plain).expect("it simulates");
    for (value, plain) in values.iter().zip(&plain) {
        assert!((value - plain).abs() <= 1e-6 * plain.abs().max(1e-3), "{value} {plain}");
    }
    for (k, name) in parameters.iter().enumerate() {
        let step = 1e-4 * p[k].abs().max(1e-3);
        let mut at = |factor: f64| {
            let mut moved = p.to_vec();
            moved[k] += factor * step;
            let mut out = vec![0.0; points];
            simulator.simulate(&moved, &mut out).expect("it simulates");
            out
        };
        // Of fourth order.
        let [a, b, c, d] = [-2.0, -1.0, 1.0, 2.0].map(&mut at);
        let scale = plain.iter().fold(0.0f64, |m, v| m.max(v.abs())) / p[k].abs().max(1e-3);
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
    let bounce: f64 = (2.0 * h0 / g as f64).sqrt();
    let speed = (2.0 * g * h0 as f64).sqrt();
    for (at, t) in times.iter().enumerate() {
        let (h, of_h, of_v) = if *t < bounce {
            (h0 - 0.5 * g * t * t, [0.0, 1.0, -0.5 * t * t], [0.0, 0.0, -t])
        } else {
            // h = e w s - g s²/2 with w = √(2 g h0), s = t - √(2 h0/g).
            let s = t - bounce;
            let (w_h0, w_g) = (g / speed, h0 / speed);
            let (s_h0, s_g) = (-1.0 / (g * bounce), h0 / (g * g * bounce));
            let slope = e * speed - g * s;
            (
                e * speed * s - 0.5 * g * s * s,
                [speed * s, e * w_h0 * s + slope * s_h0, e * w_g * s - 0.5 * s * s + slope * s_g],
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
    // The parabola touches zero at t = 0.3 and has no crossing that moves with p.
    let touching = "model M parameter Real p = 0.3; parameter Real q = 0.3; Real x(start = 0, fixed = true); Real z(start = p - 0.3, fixed = true); \
                    Real u; equation der(z) = 0; u = z; der(x) = if u >= 0 and time > q then 1 else 0; \
                    end M;";
    let _ = touching;
}
