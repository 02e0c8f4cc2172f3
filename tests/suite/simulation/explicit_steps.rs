//! Explicit steps from sample to sample, against exact solutions, against dassl, and their derivatives
//! against difference quotients.

use super::recorded_inputs::{Recorded, program};
use gapilib::internals::codegen::{Program, SensitivityCode};
use gapilib::internals::runtime::System;
use gapilib::internals::sim::{OutputGrid, Settings, Simulator, Statistics, Trajectory};
use std::sync::Arc;

const SAMPLES: usize = 200;

/// A tank with an outflow that grows with the square of its level, k = 1.
const TANK: &str = "model M parameter Real k = 1; input Real u; Real x(start = 0.3, fixed = true); \
    equation der(x) = u - k*x^2; end M;";

fn times() -> Vec<f64> {
    (0..=SAMPLES).map(|k| 0.05 * k as f64).collect()
}

fn values() -> Vec<f64> {
    (0..=SAMPLES).map(|k| 0.5 + (k * k % 17) as f64 / 8.0).collect()
}

fn run(system: &mut System, is_free: bool, tolerance: f64) -> (Trajectory, Statistics) {
    let at = times();
    let settings = Settings {
        stop: at[SAMPLES],
        output: OutputGrid::At(at),
        takes_exact_steps: is_free,
        tolerance,
        ..Settings::default()
    };
    let mut trajectory = Trajectory::default();
    let statistics = Simulator::new().run(system, &settings, &mut trajectory);
    (trajectory, statistics.expect("a simulation"))
}

fn observing(program: &Arc<Program>, name: &str) -> System {
    let mut system = program.system();
    system.observe_only(&[program.find_variable(name).expect("a variable")]);
    system
}

fn driven(text: &str, is_held: bool) -> Arc<Program> {
    let (times, values) = (times(), values());
    let input: Recorded<'_> = ("u", is_held, &times, &values);
    program(text, &[input])
}

/// The last value of x.
fn end(trajectory: &Trajectory) -> f64 {
    *trajectory.column(0).last().expect("a row")
}

#[test]
fn a_tank_follows_its_held_inflow_in_one_step_for_each_sample() {
    let mut exact: f64 = 0.3;
    for u in &values()[..SAMPLES] {
        let (root, part) = (u.sqrt(), (0.05 * u.sqrt()).tanh());
        exact = root * (exact + root * part) / (root + exact * part);
    }
    let program = driven(TANK, true);
    for tolerance in [1e-4, 1e-6] {
        let (trajectory, statistics) = run(&mut observing(&program, "x"), true, tolerance);
        assert_eq!(statistics.explicit_steps, statistics.steps);
        assert!(statistics.steps <= SAMPLES as u64 * 6 / 5, "{statistics:?}");
        assert!(statistics.rhs_evaluations <= 8 * statistics.steps, "{statistics:?}");
        let error = (end(&trajectory) - exact).abs();
        assert!(error < tolerance, "{error:e} at {tolerance:e}");
    }
    let (_, named) = run(&mut observing(&program, "x"), false, 1e-6);
    assert_eq!(named.explicit_steps, 0);
    assert!(named.attempts() > 2 * SAMPLES as u64, "{named:?}");
}

#[test]
fn a_tank_faster_than_its_samples_takes_some_explicit_steps_for_each() {
    let mut exact: f64 = 0.3;
    for u in &values()[..SAMPLES] {
        let (root, part) = (u.sqrt(), (40.0 * 0.05 * u.sqrt()).tanh());
        exact = root * (exact + root * part) / (root + exact * part);
    }
    // λ Δ is about -5.
    let program = driven(&TANK.replace("u - k*x^2", "40*(u - k*x^2)"), true);
    let (trajectory, free) = run(&mut observing(&program, "x"), true, 1e-6);
    assert_eq!(free.explicit_steps, free.steps);
    let error = (end(&trajectory) - exact).abs();
    assert!(error < 1e-6, "{error:e}");
    let (_, named) = run(&mut observing(&program, "x"), false, 1e-6);
    assert!(2 * free.attempts() < named.attempts(), "{free:?} {named:?}");
}

#[test]
fn derivatives_are_those_of_difference_quotients() {
    for is_held in [true, false] {
        let program = driven(TANK, is_held);
        let k = program.find_parameter("k").expect("a parameter");
        let at = |value: f64| {
            let mut system = observing(&program, "x");
            system.set_parameter(k, value).expect("a number");
            end(&run(&mut system, true, 1e-11).0)
        };
        let quotient = (at(1.001) - at(0.999)) / 0.002;
        let mut system = observing(&program, "x");
        let x = program.find_variable("x").expect("a variable");
        let code = SensitivityCode::compile(&program, &[k], &[x]).expect("derivatives");
        system.set_parameter(k, 1.0).expect("a number");
        system.differentiate(Some(&code));
        let (trajectory, statistics) = run(&mut system, true, 1e-9);
        assert_eq!(statistics.explicit_steps, statistics.steps, "{statistics:?}");
        let derivative = *trajectory.column(1).last().expect("a row");
        assert!((derivative / quotient - 1.0).abs() < 1e-6, "{derivative} {quotient}");
    }
}

#[test]
fn a_stiff_model_is_left_to_the_implicit_method() {
    let text = TANK.replace("u - k*x^2", "1e4*(u - k*x^2)");
    let program = driven(&text, false);
    let (free, statistics) = run(&mut observing(&program, "x"), true, 1e-6);
    assert_eq!(statistics.explicit_steps, 0);
    let (named, _) = run(&mut observing(&program, "x"), false, 1e-6);
    assert_eq!(end(&free), end(&named));
}

#[test]
fn a_model_that_becomes_stiff_is_handed_over() {
    // Not stiff until about the fifth second: then its rate grows by a factor of e^10.
    let text = TANK.replace("u - k*x^2", "exp(5 + 5*tanh(2*(time - 5.5)))*(u - k*x^2)");
    let program = driven(&text, false);
    let (free, statistics) = run(&mut observing(&program, "x"), true, 1e-6);
    assert!(statistics.explicit_steps >= 95, "{statistics:?}");
    assert!(statistics.explicit_steps < statistics.steps, "{statistics:?}");
    let (named, dassl) = run(&mut observing(&program, "x"), false, 1e-6);
    assert!(statistics.attempts() < 2 * dassl.attempts() + 1000, "{statistics:?} {dassl:?}");
    assert!((end(&free) - end(&named)).abs() < 1e-5, "{} {}", end(&free), end(&named));
}

/// The error of a step across a kink is not seen by comparing methods of high order: an integral of the
/// positive part of x was wrong by hundreds of tolerances.
#[test]
fn a_kink_without_events_is_left_to_the_implicit_method() {
    let text = "model M function positive input Real x; output Real y; algorithm y := 0; \
        while y < x loop y := x; end while; end positive; \
        function mean input Real x; output Real y; algorithm y := 0; \
        for i in 1:5000 loop y := y + x/5000; end for; end mean; \
        input Real u; Real y(start = 0, fixed = true); Real x(start = 0, fixed = true); \
        equation der(x) = u - x; der(y) = KINK; end M;";
    let (at, values) = (times(), values());
    let values: Vec<f64> = values.iter().map(|value| value - 1.5).collect();
    let input: Recorded<'_> = ("u", true, &at, &values);
    let kinks = ["noEvent(if x > 0 then x else 0)", "max(x, 0)", "(x + abs(x))/2", "positive(x)"];
    let ends = kinks.map(|kink| {
        let program = program(&text.replace("KINK", kink), &[input]);
        let (free, statistics) = run(&mut observing(&program, "y"), true, 1e-6);
        assert_eq!(statistics.explicit_steps, 0, "{kink}");
        end(&free)
    });
    // x between the samples, and the integral of its positive part, by midpoints.
    let (mut x, mut exact) = (0.0_f64, 0.0);
    for u in &values[..SAMPLES] {
        for _ in 0..1000 {
            exact += (u + (x - u) * (-2.5e-5_f64).exp()).max(0.0) * 5e-5;
            x = u + (x - u) * (-5e-5_f64).exp();
        }
    }
    assert!(ends.iter().all(|own| (own - exact).abs() < 1e-5), "{ends:?} {exact}");
    // The end of a counted loop is not a kink.
    let smooth = program(&text.replace("KINK", "mean(x)"), &[input]);
    let (_, statistics) = run(&mut observing(&smooth, "y"), true, 1e-6);
    assert_eq!(statistics.explicit_steps, statistics.steps, "{statistics:?}");
}
