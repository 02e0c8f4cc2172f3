//! Exact steps of models that are linear between events, against exact solutions, against dassl at a
//! tight tolerance, and their derivatives against difference quotients.

use super::recorded_inputs::{Recorded, program};
use gapilib::internals::codegen::{Program, SensitivityCode};
use gapilib::internals::runtime::System;
use gapilib::internals::sim::{OutputGrid, Residual, Settings, Simulator, Statistics, Trajectory};
use proptest::prelude::*;
use std::sync::Arc;

fn observing(program: &Arc<Program>, names: &[&str]) -> System {
    let mut system = program.system();
    let found = names.iter().map(|name| program.find_variable(name).expect("a variable"));
    system.observe_only(&found.collect::<Vec<_>>());
    system
}

fn run(system: &mut System, is_exact: bool, at: &[f64]) -> (Trajectory, Statistics) {
    let settings = Settings {
        stop: at[at.len() - 1],
        output: OutputGrid::At(at.to_vec()),
        takes_exact_steps: is_exact,
        tolerance: 1e-11,
        ..Settings::default()
    };
    let mut trajectory = Trajectory::default();
    let statistics = Simulator::new().run(system, &settings, &mut trajectory);
    let statistics = statistics.expect("a simulation");
    assert_eq!(statistics.exact_steps > 0, is_exact, "{statistics:?}");
    (trajectory, statistics)
}

/// The last values of variables, with exact steps to these times.
fn last(text: &str, inputs: &[Recorded<'_>], names: &[&str], at: &[f64]) -> Vec<f64> {
    let program = program(text, inputs);
    let (found, _) = run(&mut observing(&program, names), true, at);
    (0..names.len()).map(|column| *found.column(column).last().expect("a row")).collect()
}

#[track_caller]
fn near(found: f64, exact: f64, tolerance: f64) {
    assert!((found - exact).abs() <= tolerance * exact.abs().max(1.0), "{found} {exact}");
}

#[test]
fn a_circuit_relaxes_exactly() {
    let text = "model M parameter Real R = 2, C = 0.5; Real v(start = 3, fixed = true); \
        equation C*der(v) = (1 - v)/R; end M;";
    for at in [&[0.7][..], &[0.1, 0.25, 0.7], &[1e-9, 0.7]] {
        near(last(text, &[], &["v"], at)[0], 1.0 + 2.0 * (-0.7f64).exp(), 1e-15);
    }
}

#[test]
fn a_cell_follows_its_held_current() {
    // A charge without relaxation (singular A) and two RC elements; the voltage is not linear.
    let text = "model M parameter Real R = 1.5, C = 4; input Real I; Real q(start = 0.5, fixed = \
        true), a(start = 0, fixed = true), b(start = 0, fixed = true); Real V; equation \
        der(q) = -I/100; C*der(a) = I - a/R; 30*der(b) = I - b/2; V = 3 + q^2 - a - b; end M;";
    let times: Vec<f64> = (0..200).map(|k| 0.1 * f64::from(k)).collect();
    let values: Vec<f64> = (0..200).map(|k| f64::from(k * k % 17) - 8.0).collect();
    let found = last(text, &[("I", true, &times, &values)], &["V"], &times)[0];
    let (mut q, mut a, mut b): (f64, f64, f64) = (0.5, 0.0, 0.0);
    for k in 0..199 {
        let (h, i) = (times[k + 1] - times[k], values[k]);
        q -= i * h / 100.0;
        a = a * (-h / 6.0).exp() - 1.5 * i * (-h / 6.0).exp_m1();
        b = b * (-h / 60.0).exp() - 2.0 * i * (-h / 60.0).exp_m1();
    }
    near(found, 3.0 + q * q - a - b, 1e-13);
}

#[test]
fn linear_inputs_are_followed_exactly() {
    // x' = -x + u with u = 2 t up to 1, then 4 - 2 t: the response to ramps.
    let text = "model M input Real u; Real x(start = 0, fixed = true); equation der(x) = u - x; \
        end M;";
    let input = ("u", false, &[0.0, 1.0, 2.0][..], &[0.0, 2.0, 0.0][..]);
    let ramp = |t: f64| 2.0 * (t - 1.0 + (-t).exp());
    let exact = ramp(2.0) - 2.0 * ramp(1.0);
    near(last(text, &[input], &["x"], &[2.0])[0], exact, 1e-14);
}

#[test]
fn masses_oscillate_and_stiff_modes_decay() {
    // Two equal masses between walls: modes sqrt(k) and sqrt(3 k).
    let text = "model M Real x1(start = 1, fixed = true), x2(start = 0, fixed = true), \
        v1(start = 0, fixed = true), v2(start = 0, fixed = true); equation der(x1) = v1; \
        der(x2) = v2; der(v1) = -9*x1 + 9*(x2 - x1); der(v2) = -9*x2 - 9*(x2 - x1); end M;";
    let t: f64 = 100.0;
    let exact = 0.5 * ((3.0 * t).cos() + (27f64.sqrt() * t).cos());
    near(last(text, &[], &["x1"], &[t])[0], exact, 1e-10);
    let stiff = "model M Real x(start = 1, fixed = true), y(start = 0, fixed = true); equation \
        der(x) = -x; der(y) = 1e6*(x - y); end M;";
    let exact = 1e6 / (1e6 - 1.0) * (-2f64).exp();
    near(last(stiff, &[], &["y"], &[2.0])[0], exact, 1e-10);
    let chain = "model M Real x(start = 0, fixed = true), v(start = 0, fixed = true), a(start = 0, \
        fixed = true); equation der(x) = v; der(v) = a; der(a) = 6; end M;";
    near(last(chain, &[], &["x"], &[10.0])[0], 1000.0, 1e-14);
}

#[test]
fn what_is_not_linear_is_not_solved_so() {
    for right in [
        "-x^2",
        "if noEvent(x > 0.5) then -1 else -2",
        "sin(x)",
        "x*time",
        "time*time - x",
        "exp(-time)",
        "noEvent(floor(x))",
        "x/(1 + x)",
        "sqrt(1 + time)",
    ] {
        let text =
            format!("model M Real x(start = 1, fixed = true); equation der(x) = {right}; end M;");
        let mut system = observing(&program(&text, &[]), &["x"]);
        assert!(system.linearity().is_none(), "{right}");
        let settings = Settings { takes_exact_steps: true, ..Settings::default() };
        let run = Simulator::new().run(&mut system, &settings, &mut Trajectory::default());
        assert_eq!(run.expect("a simulation").exact_steps, 0, "{right}");
    }
}

#[test]
fn events_are_where_the_exact_solution_has_them() {
    // A thermostat: from 10 to 30 degrees in one time constant of 1 s, or back.
    let heater = "model M Real T(start = 15, fixed = true); discrete Real n(start = 0, fixed = \
        true); Boolean on(start = true, fixed = true); equation der(T) = (if on then 20 else 0) \
        - (T - 10); on = if pre(on) then T < 22 else T < 20; when change(on) then n = pre(n) + 1; \
        end when; end M;";
    let (mut time, mut switches) = ((15.0f64 / 8.0).ln(), Vec::new());
    for _ in 0..3 {
        switches.push(time);
        time += (12.0f64 / 10.0).ln();
        switches.push(time);
        time += (10.0f64 / 8.0).ln();
    }
    let program = program(heater, &[]);
    let (found, statistics) = run(&mut observing(&program, &["T", "n"]), true, &[1.8]);
    switches.retain(|time| *time < 1.8);
    assert_eq!(found.column(1).last(), Some(&(switches.len() as f64)), "{statistics:?}");
    for (number, exact) in switches.iter().enumerate() {
        let after = found.column(1).iter().position(|n| *n > number as f64).expect("a switch");
        let time = found.time()[after];
        assert!((time - exact).abs() < 1e-9, "{time} {exact}");
    }
}

#[test]
fn a_crossing_between_two_points_is_found() {
    // Above its threshold for a tenth of a period, seven periods between two points.
    let text = "model M Real x(start = 0, fixed = true), v(start = 1, fixed = true); discrete Real \
        n(start = 0, fixed = true); equation der(x) = v; der(v) = -x; when x > 0.95 then \
        n = pre(n) + 1; end when; end M;";
    assert_eq!(last(text, &[], &["n"], &[44.0])[0], 7.0);
}

const HOUSE: &str = "model M parameter Real C1 = 2, C2 = 30, R1 = 0.7, R2 = 0.2, A = 1.5, T0 = 18; \
    input Real Ta, P; Real T(start = T0, fixed = true), W(start = 17, fixed = true); Real y; \
    equation C1*der(T) = (Ta - T)/R1 + (W - T)/R2 + A*P; C2*der(W) = (T - W)/R2 + 0.3*A*P*R1; \
    y = T^2/20 + R1*P; end M;";
const PARAMETERS: [&str; 6] = ["C1", "C2", "R1", "R2", "A", "T0"];

fn house(is_held: bool) -> Arc<Program> {
    let times: Vec<f64> = (0..40).map(|k| 0.25 * f64::from(k)).collect();
    let ambient: Vec<f64> = (0..40).map(|k| f64::from(k * 7 % 11)).collect();
    let power: Vec<f64> = (0..40).map(|k| f64::from(k * 5 % 13) - 3.0).collect();
    program(HOUSE, &[("Ta", is_held, &times, &ambient), ("P", is_held, &times, &power)])
}

/// y at times, and its derivatives if they are wanted.
fn house_at(program: &Arc<Program>, p: &[f64], at: &[f64], is_wanted: bool) -> Vec<Vec<f64>> {
    let mut system = observing(program, &["y"]);
    let slots = PARAMETERS.map(|name| program.find_parameter(name).expect("a parameter"));
    for (slot, value) in slots.iter().zip(p) {
        system.set_parameter(*slot, *value).expect("a number");
    }
    if is_wanted {
        let observed = [program.find_variable("y").expect("a variable")];
        let code = SensitivityCode::compile(program, &slots, &observed).expect("derivatives");
        system.differentiate(Some(&code));
    }
    let (found, _) = run(&mut system, true, at);
    (0..found.n_columns())
        .map(|c| at.iter().map(|t| found.at(c, *t).expect("a row")).collect())
        .collect()
}

#[test]
fn sensitivities_are_those_of_difference_quotients() {
    let p = [2.0, 30.0, 0.7, 0.2, 1.5, 18.0];
    // Points at knots, between them, and irregular.
    let at = [0.25, 0.3, 1.0, 1.77, 4.0, 9.0, 11.0];
    for is_held in [true, false] {
        let program = house(is_held);
        let exact = house_at(&program, &p, &at, true);
        for k in 0..PARAMETERS.len() {
            let d = 1e-5 * p[k];
            let moved = |sign: f64| {
                let mut p = p;
                p[k] += sign * d;
                house_at(&program, &p, &at, false).remove(0)
            };
            let (up, down) = (moved(1.0), moved(-1.0));
            for (place, t) in at.iter().enumerate() {
                let quotient = (up[place] - down[place]) / (2.0 * d);
                let derivative = exact[k + 1][place];
                let scale = quotient.abs().max(1e-3);
                assert!(
                    (derivative - quotient).abs() < 1e-6 * scale,
                    "{} at {t}: {derivative} {quotient}",
                    PARAMETERS[k]
                );
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// Whatever the coefficients, inputs and points are, dassl at a tight tolerance agrees.
    #[test]
    fn exact_steps_agree_with_dassl(
        a in prop::array::uniform9(-3i8..3),
        values in prop::collection::vec(-4i8..5, 6),
        steps in prop::collection::vec(1u8..30, 5),
        is_held: bool,
    ) {
        let a = a.map(|entry| f64::from(entry) / 2.0);
        let row = |k: usize| format!("{}*x + {}*y + {}*z", a[k], a[k + 1], a[k + 2]);
        let text = format!(
            "model M input Real u; Real x(start = 1, fixed = true), y(start = -1, fixed = true), \
             z(start = 0, fixed = true); equation der(x) = {} - x + u; der(y) = {} - y; \
             der(z) = {} - 2*z - 3*u; end M;",
            row(0), row(3), row(6)
        );
        let mut times = vec![0.0];
        for step in &steps {
            times.push(times[times.len() - 1] + f64::from(*step) / 16.0);
        }
        let values: Vec<f64> = values.into_iter().map(f64::from).collect();
        let program = program(&text, &[("u", is_held, &times, &values)]);
        let at: Vec<f64> = times[1..].iter().flat_map(|t| [t - 0.03, *t]).collect();
        let [exact, other] =
            [true, false].map(|is_exact| run(&mut observing(&program, &["x", "y", "z"]), is_exact, &at).0);
        for t in &at {
            let all = |of: &Trajectory| [0, 1, 2].map(|column| of.at(column, *t).expect("a row"));
            let (exact, other) = (all(&exact), all(&other));
            let size = other.iter().fold(1.0, |size: f64, value| size.max(value.abs()));
            for (x, y) in exact.iter().zip(other) {
                prop_assert!((x - y).abs() < 1e-7 * size, "{t}: {x} {y}\n{text}");
            }
        }
    }
}
