//! Filters of linear models against an exact Kalman filter in numpy, whose matrix exponentials are those
//! of SciPy and which takes all outputs of a sample at once.

use super::*;
use crate::identify::problem::{Experiment, ModelSimulator, Observation, Simulate as _};
use crate::identify::{CompiledModel, Model as _};
use crate::world::MemoryWorld;
use std::sync::Arc;

const HOUSE: &str = "model House
  parameter Real Ci = 2, Ce = 10, Ri = 0.5, Ro = 1.5, q = 0.3, r = 0.2;
  Real Ti(start = 20, fixed = true), Te(start = 17, fixed = true), Tm;
equation
  Ci*der(Ti) = (Te - Ti)/Ri + 3;
  Ce*der(Te) = (Ti - Te)/Ri - Te/Ro;
  Tm = 0.3*Ti + 0.7*Te;
end House;";

fn samples() -> (Vec<Measured>, Vec<f64>) {
    let times = [0.0, 0.5, 1.0, 1.7, 2.5, 3.0, 5.0];
    let of = |missing: usize, value: &dyn Fn(f64) -> f64| {
        let all = times.iter().enumerate().filter(|(k, _)| *k != missing);
        let all: Vec<(f64, f64)> = all.map(|(k, time)| (*time, value(k as f64))).collect();
        all.into_iter().unzip::<f64, f64, Vec<f64>, Vec<f64>>()
    };
    let (first, values) = of(4, &|k| 20.0 + (2.0 * k).sin() + 0.5 * k);
    let (second, others) = of(2, &|k| 18.0 + (3.0 * k).cos());
    let y = [values.clone(), others.clone()].concat();
    let one = Measured {
        name: "Ti".to_owned(),
        times: first,
        values,
        sigma: MeasuredSigma::Expression("r".to_owned()),
        is_used: true,
    };
    let sigma = MeasuredSigma::Samples(vec![0.4; second.len()]);
    let name = "Tm".to_owned();
    let other = Measured { name, times: second, values: others, sigma, is_used: true };
    (vec![one, other], y)
}

/// Predictions and their standard deviations, and derivatives by `names` of both.
fn run(
    model: &str,
    noise: &[Noise],
    measured: &[Measured],
    (names, values): (&[&str], &[f64]),
) -> [Vec<f64>; 2] {
    let mut session = Session::new(Box::new(MemoryWorld::new()));
    session.load_text("Model.mo", model).unwrap();
    let class = model.split_whitespace().nth(1).unwrap();
    let what = (noise, measured, Purpose::Likelihood);
    let found = filtered(&mut session, class, what, (0.0, &[]), Span::NONE).unwrap();
    let model = CompiledModel::new(class, found.translated.program.clone());
    let mut settings = model.settings();
    settings.tolerance = 1e-10;
    settings.takes_exact_steps = true;
    let of = |part: usize| {
        let pairs = found.outputs.iter().zip(measured);
        pairs.map(move |(names, own)| Observation {
            y_name: names[part].clone(),
            x: own.times.clone(),
        })
    };
    let experiment = Experiment {
        name: String::new(),
        settings,
        model: Arc::new(model),
        deviations: 0,
        second_attempt: false,
        x_name: "time".to_owned(),
        observations: of(0).chain(of(1)).collect(),
        parameters: names.iter().enumerate().map(|(k, name)| (k, (*name).to_owned())).collect(),
    };
    let count: usize = 2 * measured.iter().map(|own| own.times.len()).sum::<usize>();
    let mut simulator = ModelSimulator::new(&[experiment]).unwrap();
    let mut out = vec![0.0; count];
    let mut derivatives = vec![0.0; count * names.len()];
    let mut plain = vec![0.0; count];
    simulator.simulate(values, &mut plain).unwrap();
    let exact = simulator.sensitivities(values, &mut out, &mut derivatives).unwrap();
    assert!(exact, "{:?}", simulator.sensitivity_refusal());
    for (a, b) in plain.iter().zip(&out) {
        assert!((a - b).abs() < 1e-9 * a.abs().max(1.0), "{a} {b}");
    }
    [out, derivatives]
}

/// -log L
fn likelihood(out: &[f64], y: &[f64]) -> f64 {
    let (predicted, sigma) = out.split_at(y.len());
    let points = predicted.iter().zip(sigma).zip(y);
    let point = |((p, s), y): ((&f64, &f64), &f64)| {
        0.5 * ((y - p) / s).powi(2) + s.ln() + 0.5 * std::f64::consts::TAU.ln()
    };
    points.map(point).sum()
}

fn noise(state: &str, density: &str, initial: f64) -> Noise {
    Noise { state: state.to_owned(), density: density.to_owned(), scale: 0.1, initial }
}

#[test]
fn likelihoods_of_linear_models_are_those_of_an_exact_filter() {
    let (measured, y) = samples();
    let cases = [([0.0, 0.0], 255.7580539791819), ([0.5, 1.0], 161.86085415537818)];
    for (initial, expected) in cases {
        let noise = [noise("Ti", "q", initial[0]), noise("Te", "0.1", initial[1])];
        let names = ["q", "r", "Ci", "Ro"];
        let values = [0.3, 0.2, 2.0, 1.5];
        let [out, derivatives] = run(HOUSE, &noise, &measured, (&names, &values));
        let found = likelihood(&out, &y);
        assert!((found - expected).abs() < 1e-10, "{found} {expected}");
        for k in 0..names.len() {
            let step = 1e-5 * values[k];
            let at = |sign: f64| {
                let mut moved = values;
                moved[k] += sign * step;
                run(HOUSE, &noise, &measured, (&names, &moved))[0].clone()
            };
            let (up, down) = (at(1.0), at(-1.0));
            for (row, (up, down)) in up.iter().zip(&down).enumerate() {
                let quotient = (up - down) / (2.0 * step);
                let exact = derivatives[row * names.len() + k];
                assert!((exact - quotient).abs() < 1e-6 * (1.0 + quotient.abs()), "{row} {k}");
            }
        }
    }
}
