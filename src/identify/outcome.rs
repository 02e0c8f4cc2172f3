//! The result of an identification: what was found, how well it fits, and what the data tell.

use super::recorder::{Best, FitnessSource, Recorder};
use super::uncertainty::Uncertainty;
use crate::ga::Generation;
use serde::Serialize;
use std::fmt::Write;

/// A parameter counts as determined when its deviation is below this fraction of its value.
const DETERMINED_BELOW: f64 = 0.5;
/// Correlations above this are worth a word.
const STRONG_CORRELATION: f64 = 0.95;
/// A value closer to the end of its range than this fraction of the range is at the end.
const AT_THE_END: f64 = 1e-3;

/// The result of an identification. Its text depends on nothing but the run's inputs, except for
/// the time at the end.
#[derive(Debug, Clone, Serialize)]
pub struct Outcome {
    /// The model, with its modification.
    pub model: String,
    /// Values of the identified parameters by name.
    pub parameters: indexmap::IndexMap<String, f64>,
    /// More about each of them, in the same order.
    pub details: Vec<Identified>,
    /// Strongly correlated pairs.
    pub correlated: Vec<Correlated>,
    /// Fitness of the best individual.
    pub best_fit: f64,
    /// What the fitness is.
    pub fitness: &'static str,
    /// Root of the mean squared residual, in the unit of the measured variable.
    pub rmse: Option<f64>,
    /// That unit.
    pub rmse_unit: String,
    /// Number of measured points.
    pub points: usize,
    /// Number of generations evaluated.
    pub generations: usize,
    /// Number of simulations of the search.
    pub evaluations: u64,
    /// How many of them failed.
    pub failures: u64,
    /// Why they failed.
    pub failure_causes: indexmap::IndexMap<String, u64>,
    /// What the user changed while the run went on: the first generation that it held for, and the
    /// statement.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub changes: Vec<(usize, String)>,
    /// Simulations behind the search, for the standard deviations.
    pub evaluations_for_deviations: u64,
    /// The first seed.
    pub seed: Option<[f64; 6]>,
    /// The file of the measured data.
    pub data: Option<String>,
    /// Whether the user interrupted the run.
    pub interrupted: bool,
    /// Version of the program.
    pub version: &'static str,
    /// Time of the run.
    pub wall_seconds: f64,
    /// Measured X, measured Y, simulated Y of every point.
    #[serde(skip)]
    pub fit: Vec<FitPoint>,
    /// The generations.
    #[serde(skip)]
    pub history: Vec<Generation>,
    /// Name and unit of X and of Y.
    #[serde(skip)]
    pub axes: [super::Quantity; 2],
}

/// An identified parameter.
#[derive(Debug, Clone, Serialize)]
pub struct Identified {
    /// Its name.
    pub name: String,
    /// Its unit; empty where the model gives none.
    pub unit: String,
    /// Its value in the best individual.
    pub value: f64,
    /// Its search range, where known.
    pub range: Option<[f64; 2]>,
    /// One standard deviation; `None` where it is infinite or could not be computed.
    pub standard_deviation: Option<f64>,
    /// Whether the data determine it; `None` where that could not be computed.
    pub determined: Option<bool>,
    /// Whether the value lies at an end of its range.
    pub at_end_of_range: bool,
}

/// Two parameters that the data can hardly tell apart.
#[derive(Debug, Clone, Serialize)]
pub struct Correlated {
    /// Their names.
    pub pair: [String; 2],
    /// Their correlation.
    pub correlation: f64,
}

/// A measured point and its simulation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FitPoint {
    /// X.
    pub x: f64,
    /// Measured Y; NaN where not known.
    pub measured: f64,
    /// Simulated Y.
    pub simulated: f64,
}

impl Outcome {
    /// Puts together what a run has found; `None` when no individual was simulated successfully.
    pub fn of(
        recorder: &Recorder,
        uncertainty: Option<&Uncertainty>,
        evaluations_for_deviations: u64,
    ) -> Option<Outcome> {
        let best = recorder.best.as_ref()?;
        let study = &best.study;
        let fit = fit_points(best, recorder.measured_y());
        let names = || study.parameters.iter().map(|parameter| parameter.name.clone());
        Some(Outcome {
            model: study.model.clone(),
            parameters: names().zip(best.genome.iter().copied()).collect(),
            details: identified(best, recorder.ranges.as_ref(), uncertainty),
            correlated: correlated(&names().collect::<Vec<_>>(), uncertainty),
            best_fit: best.fitness,
            fitness: match recorder.fitness_source() {
                FitnessSource::SumOfSquares => "sum of squares",
                FitnessSource::Script => "function of the script",
                FitnessSource::Assumed => "sum of squares (the script's own fitness is not known)",
            },
            rmse: root_mean_square(&fit),
            rmse_unit: study.y.unit.clone(),
            points: fit.len(),
            generations: recorder.history.generations.len(),
            evaluations: recorder.evaluations,
            failures: recorder.failures,
            failure_causes: recorder.causes.clone(),
            changes: recorder.changes.clone(),
            evaluations_for_deviations,
            seed: recorder.seed,
            data: recorder.measurement.as_ref().map(|measurement| measurement.file.clone()),
            interrupted: false,
            version: env!("CARGO_PKG_VERSION"),
            wall_seconds: 0.0,
            fit,
            history: recorder.history.generations.clone(),
            axes: [study.x.clone(), study.y.clone()],
        })
    }

    /// `result.json`
    pub fn to_json(&self) -> String {
        let text = serde_json::to_string_pretty(self);
        text.unwrap_or_else(|error| unreachable!("strings, numbers and lists only: {error}")) + "\n"
    }

    /// `history.csv`: one line for each generation.
    pub fn history_csv(&self) -> String {
        let mut text = String::from("generation,best,mean,worst,failures\n");
        for (k, generation) in self.history.iter().enumerate() {
            let Generation { best, mean, worst, failures } = generation;
            // Writing into a String cannot fail.
            _ = writeln!(text, "{},{best:e},{mean:e},{worst:e},{failures}", k + 1);
        }
        text
    }

    /// `fit.csv`: one line for each measured point; residual = measured − simulated.
    pub fn fit_csv(&self) -> String {
        let mut text = String::from("x,measured,simulated,residual\n");
        for FitPoint { x, measured, simulated } in &self.fit {
            _ = writeln!(text, "{x},{measured},{simulated},{}", measured - simulated);
        }
        text
    }
}

fn fit_points(best: &Best, measured: Option<&[f64]>) -> Vec<FitPoint> {
    let measured = |k: usize| measured.map_or(f64::NAN, |values| values[k]);
    let simulated = best.simulated.iter().enumerate();
    simulated
        .map(|(k, &s)| FitPoint { x: best.x[k], measured: measured(k), simulated: s })
        .collect()
}

fn root_mean_square(fit: &[FitPoint]) -> Option<f64> {
    let sum: f64 = fit.iter().map(|point| (point.measured - point.simulated).powi(2)).sum();
    let rmse = (sum / fit.len() as f64).sqrt();
    rmse.is_finite().then_some(rmse)
}

fn identified(
    best: &Best,
    ranges: Option<&(Vec<f64>, Vec<f64>)>,
    uncertainty: Option<&Uncertainty>,
) -> Vec<Identified> {
    let range = |k: usize| {
        let (minima, maxima) = ranges?;
        Some([*minima.get(k)?, *maxima.get(k)?])
    };
    let parameters = best.study.parameters.iter().zip(&best.genome).enumerate();
    parameters
        .map(|(k, (parameter, &value))| {
            let range = range(k);
            let deviation = uncertainty.map(|found| found.standard_deviations[k]);
            Identified {
                name: parameter.name.clone(),
                unit: parameter.unit.clone(),
                value,
                range,
                standard_deviation: deviation.filter(|deviation| deviation.is_finite()),
                determined: deviation.map(|deviation| is_determined(value, deviation, range)),
                at_end_of_range: range.is_some_and(|range| is_at_end(value, range)),
            }
        })
        .collect()
}

fn is_determined(value: f64, deviation: f64, range: Option<[f64; 2]>) -> bool {
    let width = range.map_or(f64::INFINITY, |[min, max]| max - min);
    deviation <= DETERMINED_BELOW * value.abs() && deviation <= width
}

fn is_at_end(value: f64, [min, max]: [f64; 2]) -> bool {
    (value - min).min(max - value) < AT_THE_END * (max - min)
}

fn correlated(names: &[String], uncertainty: Option<&Uncertainty>) -> Vec<Correlated> {
    let Some(found) = uncertainty else { return Vec::new() };
    let n = names.len();
    let pairs = (0..n).flat_map(|k| (k + 1..n).map(move |l| (k, l)));
    pairs
        .map(|(k, l)| (k, l, found.correlations[k * n + l]))
        .filter(|(_, _, correlation)| correlation.abs() > STRONG_CORRELATION)
        .map(|(k, l, correlation)| Correlated {
            pair: [names[k].clone(), names[l].clone()],
            correlation,
        })
        .collect()
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::ga::Genomes;
    use crate::identify::{FailedSimulation, Measurement, Quantity, Simulated, Study};
    use std::sync::Arc;

    fn quantity(name: &str, unit: &str) -> Quantity {
        Quantity { name: name.to_owned(), unit: unit.to_owned() }
    }

    pub(in crate::identify) fn outcome() -> Outcome {
        let study = Arc::new(Study {
            model: "Line".to_owned(),
            parameters: vec![quantity("a", "V"), quantity("b", "V/s")],
            x: quantity("time", "s"),
            y: quantity("y", "V"),
        });
        let mut recorder = Recorder::default();
        let (x, y) = (vec![0.0, 1.0, 2.0], vec![1.0, 2.0, 3.0]);
        recorder.measured(Measurement { file: "line.mat".into(), x: x.clone(), y: y.clone() });
        recorder.seeded([12345.0; 6], [1.0; 6]);
        recorder.searched(&[0.0, 0.0], &[10.0, 1.0]);
        let genomes = Genomes::new(2, vec![1.0, 1.0, 2.0, 0.5]).unwrap();
        let cause = "assertion `b > 1` failed".to_owned();
        let simulated = Simulated {
            rows: vec![1.0, 2.0, 3.003, f64::NAN, f64::NAN, f64::NAN],
            failures: vec![None, Some(FailedSimulation { cause, time: None })],
        };
        recorder.evaluated(&study, &x, &genomes, &simulated);
        recorder.rated(&[9e-6, 1e60], &y);
        recorder.ordered(&genomes, &[9e-6, 1e60]);
        recorder.finish();
        let uncertainty = Uncertainty {
            standard_deviations: vec![0.01, 0.9],
            correlations: vec![1.0, -0.97, -0.97, 1.0],
        };
        Outcome::of(&recorder, Some(&uncertainty), 4).unwrap()
    }

    #[test]
    fn says_what_the_data_do_not_determine() {
        let outcome = outcome();
        assert_eq!(outcome.details[0].determined, Some(true));
        assert_eq!(outcome.details[1].determined, Some(false), "90 % deviation");
        assert!(!outcome.details[0].at_end_of_range && outcome.details[1].at_end_of_range);
        assert_eq!(outcome.correlated[0].pair, ["a", "b"]);
        assert!((outcome.rmse.unwrap() - 0.003 / 3_f64.sqrt()).abs() < 1e-12);
    }

    #[test]
    fn json_has_the_promised_keys() {
        let value: serde_json::Value = serde_json::from_str(&outcome().to_json()).unwrap();
        for key in ["model", "parameters", "best_fit", "rmse", "generations", "evaluations"] {
            assert!(!value[key].is_null(), "{key}");
        }
        for key in ["failures", "seed", "wall_seconds"] {
            assert!(!value[key].is_null(), "{key}");
        }
        assert_eq!(value["parameters"]["a"], 1.0);
        assert_eq!(value["failures"], 1);
    }

    #[test]
    fn csv_files_hold_history_and_fit() {
        let outcome = outcome();
        let history = "generation,best,mean,worst,failures\n1,9e-6,9e-6,9e-6,1\n";
        assert_eq!(outcome.history_csv(), history);
        let fit = outcome.fit_csv();
        assert!(fit.starts_with("x,measured,simulated,residual\n0,1,1,0\n1,2,2,0\n"), "{fit}");
    }

    #[test]
    fn nothing_found_is_no_outcome() {
        assert!(Outcome::of(&Recorder::default(), None, 0).is_none());
    }
}
