//! What the package for Python costs, the side without Python: polarization curves one after the other on
//! one thread. Prints the seconds, and the sum of all voltages.
//!
//! `curves.py` beside it starts this program in turn with the same from Python.

#![allow(clippy::print_stdout, reason = "it prints a measurement")]

use gapilib::embedding::Embedding;
use gapilib::internals::identify::problem::{Experiment, ModelSimulator, Observation, Simulate};
use gapilib::internals::identify::{CompiledModel, Model};
use gapilib::internals::name::Name;
use gapilib::internals::script::models::simulation;
use gapilib::internals::script::runs::view::Progress;
use gapilib::world::Screen;
use std::error::Error;
use std::sync::Arc;
use std::time::Instant;

const MODEL: &str = "CaseStudies.PolarizationCurve";
const PARAMETERS: [&str; 6] = ["A", "In", "Io", "B", "R", "Ilim"];
const VALUES: [f64; 6] = [0.039, 1.4e-3, 1.5856e-6, 0.0918, 7.286e-4, 0.2265];

/// Nothing is printed meanwhile.
struct Silent;

impl Screen for Silent {
    fn print(&mut self, _text: &str) {}
    fn eprint(&mut self, _text: &str) {}
    fn progress(&mut self, _progress: &Progress) {}
}

/// How many curves, and of how many points.
fn arguments() -> Result<(u32, u32), Box<dyn Error>> {
    let mut given = std::env::args().skip(1);
    let mut next = |default: u32| given.next().map_or(Ok(default), |text| text.parse());
    Ok((next(100_000)?, next(14)?))
}

fn simulator(points: u32) -> Result<ModelSimulator, Box<dyn Error>> {
    let embedding = Embedding { cache: false, ..Embedding::default() };
    let mut session = embedding.session(Box::new(Silent), Arc::default())?;
    session.autoload(&Name::parse(MODEL)).map_err(|wrong| format!("{wrong:?}"))?;
    let translated = simulation::translate(&mut session, MODEL);
    let translated = translated.map_err(|wrong| format!("{wrong:?}"))?;
    let model = Arc::new(CompiledModel::new(MODEL, translated.program.clone()));
    let x = (1..=points).map(|k| 0.22 * f64::from(k) / f64::from(points)).collect();
    let experiment = Experiment {
        name: String::new(),
        settings: model.settings(),
        model,
        second_attempt: true,
        x_name: "i".to_owned(),
        observations: vec![Observation { y_name: "V".to_owned(), x }],
        parameters: PARAMETERS.iter().map(|name| (*name).to_owned()).enumerate().collect(),
    };
    Ok(ModelSimulator::new(&[experiment]).map_err(|fault| fault.message)?)
}

fn main() -> Result<(), Box<dyn Error>> {
    let (count, points) = arguments()?;
    let mut simulator = simulator(points)?;
    let (mut values, mut curve) = (VALUES, vec![0.0; points as usize]);
    let mut sum = 0.0;
    let begin = Instant::now();
    for k in 0..count {
        values[0] = VALUES[0] * (1.0 + 0.1 * f64::from(k) / f64::from(count));
        simulator.simulate(&values, &mut curve).map_err(|failed| failed.cause)?;
        sum += curve[curve.len() - 1];
    }
    println!("{:.4} {sum:.9}", begin.elapsed().as_secs_f64());
    Ok(())
}
