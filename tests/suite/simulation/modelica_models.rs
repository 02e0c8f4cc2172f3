//! Models of the small package `Modelica`, one area each, against exact or independently computed
//! values: those of `tests/models`.

use crate::support::shipped;
use gapilib::Session;
use gapilib::internals::script::models::checking;
use std::f64::consts::PI;
use std::path::Path;

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

/// The four diodes as piecewise linear resistors, their node found by bisection at every time.
#[test]
fn a_bridge_rectifies() {
    ends("Rectifier", 1e-6, &[("capacitor.v", 7.777_337_295)]);
}

/// Exponentials from switch to switch.
#[test]
fn a_heater_is_switched() {
    let (mut t, mut room, mut on) = (0.0, 288.15, true);
    loop {
        let (limit, goal): (f64, f64) = if on { (293.65, 323.15) } else { (292.65, 273.15) };
        let next = t - 100.0 * ((limit - goal) / (room - goal)).ln();
        if next > 60.0 {
            room = goal + (room - goal) * (-(60.0 - t) / 100.0_f64).exp();
            break;
        }
        (t, room, on) = (next, limit, !on);
    }
    let power = if on { 500.0 } else { 0.0 };
    ends("Thermostat", 1e-6, &[("room.T", room), ("power.y", power)]);
}

/// Exponentials from switch to switch, with all four resistances.
#[test]
fn a_current_goes_over_to_a_diode() {
    let (on, off): (f64, f64) = (1e-3, 1e-6);
    let conductance = 1.0 / on + off;
    let after = |i: f64, time: f64, source: f64| {
        let resistance = 2.0 + 1.0 / conductance;
        let last = 12.0 * source / conductance / resistance;
        last + (i - last) * (-resistance / 0.01 * time).exp()
    };
    let i = after(after(after(after(0.0, 5e-3, 1.0 / on), 5e-3, off), 5e-3, 1.0 / on), 3e-3, off);
    ends("Switches", 1e-6, &[("inductor.i", i)]);
}

#[test]
fn sources_give_their_signals() {
    let t: f64 = 2.15;
    ends(
        "Signals",
        1e-6,
        &[
            ("constant_.y", 3.0),
            ("step.y", 3.0),
            ("ramp.y", 3.3),
            ("sine.y", 1.0 + 2.0 * (2.0 * PI * 0.3 * 1.95 + 0.4).sin()),
            ("cosine.y", (2.0 * PI * 0.3 * t).cos()),
            ("expSine.y", (-0.5 * t).exp() * (2.0 * PI * 0.7 * t).sin()),
            ("exponentials.y", (1.0 - (-2.5_f64).exp()) * (-(t - 0.6) / 0.4).exp()),
            ("pulse.y", 1.0),
            ("sawTooth.y", 2.0 * 0.65 / 0.7),
            ("trapezoid.y", 0.0),
            ("clock.y", 2.25),
            ("pulses.y", -t + 2.0 * (4.0 * 0.15 + 0.05)),
            ("teeth.y", 2.0 * 0.7 + 0.65 * 0.65 / 0.7),
            ("trapezoids.y", 2.0 * 2.0 * (0.05 + 0.2 + 0.15)),
        ],
    );
}

#[test]
fn sampled_systems_step_from_sample_to_sample() {
    ends(
        "Sampled",
        1e-9,
        &[
            ("sampler.y", 0.7),
            ("hold.y", 0.7),
            ("delay_.y", 0.7),
            ("transferFunction.y", 1.003_125),
            ("triggered.y", 0.42),
            ("timer.y", 0.33),
            ("above.y", 1.0),
        ],
    );
}

/// Matrix exponential of current, speed and integral of the control error; the gear makes one
/// inertia of two.
#[test]
fn a_drive_is_controlled() {
    ends(
        "Drive",
        1e-6,
        &[
            ("emf.i", -3.349_315_045_106),
            ("motor.w", 11.202_929_604_168),
            ("load.w", 11.202_929_604_168 / 2.0),
            ("controller.I.y", 4.558_037_702_541),
        ],
    );
}

/// Matrix exponential, the sine being two more states.
#[test]
fn a_mass_swings_on_a_spring() {
    ends(
        "Oscillator",
        1e-6,
        &[
            ("mass.s", 0.030_417_707_575),
            ("mass.v", -0.285_420_800_092),
            ("position.s", 0.030_417_707_575),
        ],
    );
}

/// Matrix exponential from the step on.
#[test]
fn two_shafts_swing_against_each_other() {
    ends(
        "TwoInertias",
        1e-6,
        &[
            ("first.phi", 0.801_314_202_897),
            ("first.w", 1.130_950_968_512),
            ("second.phi", 0.724_342_898_552),
            ("second.w", 0.934_524_515_744),
            ("power.power", 2.261_901_937_025),
        ],
    );
}

/// The answer to a voltage of straight lines, line by line.
#[test]
fn a_capacitor_follows_a_table() {
    let lag = 10.0 * 0.02;
    let lines = [(0.25, 0.5, 0.0), (0.5, 0.5, 4.0), (0.5, 1.5, 0.0), (1.75, 1.5, -2.0)];
    let v = lines.iter().fold(0.0, |v, (time, begin, slope): &(f64, f64, f64)| {
        let behind = begin - slope * lag;
        behind + slope * time + (v - behind) * (-time / lag).exp()
    });
    ends("TableSource", 1e-6, &[("capacitor.v", v), ("source.v", -2.0)]);
}

/// What sorting may say of a class that stands alone: a resistor has no potential of its own, a
/// source needs its parameters, a table its points.
const ALONE: [&str; 5] = [
    "singular-system",
    "parameter-without-value",
    "no-constant-value",
    "not-supported",
    "array-mismatch",
];

#[test]
fn every_model_is_balanced() {
    let mut session = Session::new(Box::new(shipped::world()));
    let packages = session.load_path(Path::new("models/Modelica")).expect("the package is read");
    let classes = checking::classes(&mut session, &packages);
    let (total, mut models) = (classes.len(), classes);
    models.retain(|class| checking::is_model(&mut session, class));
    assert!(models.len() > 250 && total > 900, "{} of {total}", models.len());
    for model in models {
        let name = model.to_string();
        let Ok(flat) = checking::flat_model(&mut session, &name) else {
            assert!(name.contains("Table"), "{name} is not flattened");
            continue;
        };
        if let Err(error) = gapilib::internals::causalize::causalize(&flat) {
            assert!(ALONE.contains(&error.code.slug), "{name}: {error}");
        }
    }
}

#[test]
fn models_of_2005_find_their_names() {
    ends(
        "Version2",
        1e-7,
        &[
            ("T0_degC", 26.85),
            ("body.T", 350.0 - 50.0 * (-0.1_f64).exp()),
            ("resistor.i", 0.5),
            ("clock.y", 1.0),
        ],
    );
}

#[test]
fn tables_are_read_between_and_behind_their_points() {
    ends(
        "TimeTables",
        1e-6,
        &[
            ("lines.y[1]", 1.0),
            ("lines.y[2]", 4.0),
            ("steps.y[1]", 9.0),
            ("square.y[1]", 1.0),
            ("product.y", 4.0),
            ("integral[1].y", 3.75),
            ("integral[2].y", 9.75),
        ],
    );
}
