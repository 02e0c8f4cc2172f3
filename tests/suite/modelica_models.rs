//! Models of the small package `Modelica`, one area each, against exact or independently computed
//! values: those of `tests/models`.

use crate::shipped;
use std::f64::consts::PI;

/// The values of variables at the end of a simulation as the model's `experiment` says.
fn at_end(model: &str, variables: &[&str]) -> Vec<f64> {
    let file = format!("{model}.mo");
    let text = std::fs::read(shipped::project("tests/models").join(&file)).unwrap();
    let names: Vec<String> = variables.iter().map(|name| format!("\"{name}\"")).collect();
    let script = format!(
        "openModel(\"{file}\");\n\
         ok := simulateModel(\"{model}\", resultFile=\"result\");\n\
         points := readTrajectorySize(\"result.mat\");\n\
         all := readTrajectory(\"result.mat\", {{{}}}, points);\n\
         last := all[:, points];\n",
        names.join(", ")
    );
    let world = shipped::world().with_file(&file, text).with_file("test.mos", script);
    let run = shipped::run_in(world, "test.mos");
    assert_eq!(run.errors, "", "{model}");
    let values = run.session.variable("last").expect("assigned");
    values.as_reals().expect("numbers").into_owned()
}

#[track_caller]
fn ends(model: &str, tolerance: f64, expected: &[(&str, f64)]) {
    let names: Vec<&str> = expected.iter().map(|(name, _)| *name).collect();
    for ((name, expected), given) in expected.iter().zip(at_end(model, &names)) {
        let error = (given - expected).abs() / expected.abs().max(1e-3);
        assert!(error <= tolerance, "{model}.{name}: {given} instead of {expected}");
    }
}

#[test]
fn a_capacitor_is_charged_through_a_resistor() {
    let left = (-4.0_f64).exp();
    ends(
        "RC",
        1e-5,
        &[("voltage.v", 10.0 * (1.0 - left)), ("current.i", 0.1 * left), ("potential.phi", 10.0)],
    );
}

/// The values are those of the matrix exponential; the heat is what the circuit has lost.
#[test]
fn a_circuit_rings_and_warms_its_resistor() {
    let (v, i) = (-1.843_020_761_990_69, -0.004_179_452_005_251_1);
    let lost = 0.5 * 1e-4 * (25.0 - v * v) - 0.5 * 0.1 * i * i;
    ends("RLC", 1e-5, &[("capacitor.v", v), ("inductor.i", i), ("body.T", 300.0 + lost / 0.01)]);
}

/// Matrix exponential of the five heat balances.
#[test]
fn a_wall_conducts_heat() {
    ends(
        "Wall",
        1e-7,
        &[
            ("layer[1].T", 345.183_966_798_096),
            ("layer[5].T", 298.027_526_684_955),
            ("flow_.Q_flow", 79.660_332_019_037),
        ],
    );
}

/// `T^-3` grows linearly.
#[test]
fn a_body_radiates_into_empty_space() {
    let sigma = 5.670_374_419_184e-8;
    let t = (1000.0_f64.powi(-3) + 3.0 * 0.01 * sigma * 60.0 / 10.0).powf(-1.0 / 3.0);
    ends("Radiation", 1e-7, &[("body.T", t)]);
}

#[test]
fn amplifiers_transformers_and_gyrators_pass_a_signal_on() {
    let out = -2.0 * 0.5;
    let secondary = 3.0 * out / 2.0;
    let load = 0.1 * secondary / 0.05;
    ends(
        "Amplifiers",
        1e-9,
        &[
            ("amplifier.out.v", out),
            ("load.v", load),
            ("transformer.i2", -0.1 * load),
            ("transformer.i1", 0.1 * load / 2.0),
        ],
    );
}

/// Radau IIA with a tolerance of 1e-11 of the four equations written by hand.
#[test]
fn a_controller_reaches_its_limit_without_windup() {
    ends(
        "LimitedControl",
        1e-4,
        &[
            ("controller.I.y", 0.000_417_141_539),
            ("lag.y", -0.000_828_611_625),
            ("integrator.y", 1.000_973_437_118),
        ],
    );
}

/// Step responses from tables of the Laplace transform.
#[test]
fn linear_systems_answer_a_step() {
    let w = 3.0 * (1.0_f64 - 0.16).sqrt();
    let damped = (-1.2_f64).exp() * (w.cos() + 1.2 / w * w.sin());
    let lag = PI;
    let matrix_exponential = 0.461_416_064_678_882;
    ends(
        "LinearSystems",
        1e-7,
        &[
            ("firstOrder.y", 2.0 * (1.0 - (-2.0_f64).exp())),
            ("secondOrder.y", 2.0 * (1.0 - damped)),
            ("pi.y", 6.0),
            ("pid.y", 6.0),
            ("derivative.y", 4.0 * (-2.0_f64).exp()),
            ("transferFunction.y", matrix_exponential),
            ("stateSpace.y[1]", matrix_exponential),
            ("criticalDamping.y", 1.0 - (-lag).exp() * (1.0 + lag + lag * lag / 2.0)),
        ],
    );
}
