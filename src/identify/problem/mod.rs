//! Identification as a problem of its own: free parameters, measured series, fitness functions, a
//! method and stop conditions. The simulation is anything that computes points from parameters, so
//! that a problem can be put in Rust as well as read from a file.
//!
//! A run keeps no clock and no file. Every question that the method asked and the answers to it are
//! a [`Record`]; a run that is given the records of an earlier one goes the same way again without
//! simulating, and then on: that is how an interrupted run is resumed to the same end.

mod checks;
mod conclude;
mod conclusion;
mod confirmed;
mod curvature;
mod curve;
mod effects;
mod elsewhere;
mod ending;
mod error_model;
mod evaluation;
mod event_limits;
mod experiment;
mod explicit;
mod failure;
mod failure_region;
mod finding;
mod fingerprint;
mod frame;
mod grounds;
mod held;
mod importance;
pub mod inference;
mod innovations;
mod jacobian;
mod joint;
mod journal;
mod limits;
mod linearity;
mod linearization;
mod minimum_test;
mod misread;
mod non_identifiable;
mod notes;
mod parts;
mod plane;
mod portable;
mod profile;
mod profiled;
mod range_notes;
mod refit;
mod relative;
mod run;
mod saddle;
mod saved;
mod script_result;
mod searches;
mod sensitivities;
mod separable;
mod solution;
mod space;
mod states;
mod statistics;
mod summary;
mod text;
mod unpacked;
mod valley;
mod verdict_notes;
mod verdicts;

pub use crate::search_record::Best;
pub use conclude::conclude;
pub(crate) use conclusion::Conclusion;
pub use curve::draw_curves;
pub use elsewhere::Elsewhere;
pub use ending::OtherMinimum;
pub use ending::{Ending, EndingKind, SolvedDescent};
pub use error_model::ErrorModel;
pub use error_model::{LIKELIHOOD, Sigma, SigmaFormula, decide, likelihood};
pub use evaluation::{Evaluation, Status};
pub use experiment::{Experiment, ModelSimulator, Observation, diagnosed};
pub use failure::{Failed, FailureKind};
pub use failure_region::FailureRegion;
pub use failure_region::failure_region;
pub use finding::{Finding, FindingKind, Severity};
pub use fingerprint::{Fingerprint, Origins, listed};
pub use frame::{first_frame, frame};
pub use importance::{Analysis, Importance, ParameterImportance, analysis};
pub use inference::{Band, BandPoint, Inference, Inferred, SpectrumBand};
pub(crate) use innovations::Periodogram;
pub use innovations::{NOISE_OF, NoiseComparison};
pub use joint::{Joint, SolvedCovariance};
pub use journal::{
    Entry, Journal, Record, begin, decode, encode, header, is_of_another_version, without_times,
};
pub use linearization::Linearization;
pub use misread::{Reading, promises, short_fit};
pub use non_identifiable::Form;
pub(crate) use non_identifiable::NonIdentifiable;
use parts::other_shards;
pub use parts::{Parts, Shard, ShardFile, missing_shards};
pub(crate) use plane::{SpectrumFigures, planes};
pub use portable::{Portable, PortableExperiment};
pub use profile::{Profile, Profiles, RangeEnd};
pub use refit::MakeSimulator;
pub use relative::{Scale, Scaling, SolvedCoefficient};
pub use run::Run;
pub use script_result::{ScriptError, ScriptResult};
pub use searches::best_of;
pub use solution::{
    CalibratedModel, ChiSquare, Course, Effort, Likelihood, Outcome, Pareto, PredictedAhead,
    Provenance, Solution, SolvedParameter, SolvedSearch, SolvedSeries, Subject, Verdict,
};
pub use space::Free;
pub use states::SolvedState;
pub use statistics::Statistics;
pub(crate) use statistics::{ResidualTest, distributions, residual_test};
pub(crate) use text::covariance_line;
pub use text::modelica_number;
pub(crate) use unpacked::unpacked;

use super::Descriptions;
use super::fitness::{Fitness, Law};
use crate::ga::optimizer::Method;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// Relative error of simulated values where nothing is integrated.
pub const NOISE_OF_FORMULAS: f64 = 1e-12;

/// Something that computes simulated points from values of the estimated parameters.
pub trait Simulate: Send {
    /// Writes the simulated value of every point of every series, one after the other.
    ///
    /// # Errors
    ///
    /// Why the simulation failed.
    fn simulate(&mut self, parameters: &[f64], out: &mut [f64]) -> Result<(), Failed>;
    /// Like [`simulate`](Simulate::simulate), and writes into `derivatives` the derivative of every
    /// point by every parameter, point by point (points × parameters). `Ok(false)` where there are
    /// no exact ones; then what was written is not used, and the caller takes differences.
    ///
    /// # Errors
    ///
    /// Why the simulation failed.
    fn sensitivities(
        &mut self,
        _parameters: &[f64],
        _out: &mut [f64],
        _derivatives: &mut [f64],
    ) -> Result<bool, Failed> {
        Ok(false)
    }
    /// Why the last call of [`sensitivities`](Simulate::sensitivities) gave none, in words that
    /// follow on "because"; `None` if it gave some.
    fn sensitivity_refusal(&self) -> Option<&str> {
        None
    }
    /// From now on the tolerance of the solver is the one of the settings times `factor`; 1 puts it
    /// back. Without effect where nothing is integrated.
    fn scale_tolerance(&mut self, _factor: f64) {}
    /// From now on simulations end when the flag is set; what they answer then is not used.
    fn cancel_by(&mut self, _flag: Option<Arc<AtomicBool>>) {}
    /// What another process makes an equal simulator from.
    ///
    /// # Errors
    ///
    /// Why it cannot be sent, in words that follow on "because".
    fn portable(&self) -> Result<Portable, String> {
        Err("it is a function of the calling program".to_owned())
    }
}

/// What the points of a series are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Role {
    /// Measured.
    #[default]
    Data,
    /// What is known of a parameter before.
    Prior,
    /// The standard deviations of the points of an earlier series, so many series before: the model
    /// computes them, and nothing is compared with them.
    Deviation(usize),
}

/// A measured series.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    /// What its points are.
    pub role: Role,
    /// The experiment that it belongs to.
    pub experiment: String,
    /// The variable that was measured, and its unit.
    pub y_name: String,
    /// Unit of Y; empty if it has none.
    pub y_unit: String,
    /// What it was measured over.
    pub x_name: String,
    /// Unit of X; empty if it has none.
    pub x_unit: String,
    /// Where the data come from.
    pub file: String,
    /// X of the points; missing points are left out.
    pub x: Vec<f64>,
    /// Y of the points.
    pub y: Vec<f64>,
    /// Every difference counts times this, besides the reciprocal of its sigma.
    pub weight: f64,
    /// What the standard deviations of the points are proportional to; empty where they are equal.
    pub relative: Vec<f64>,
    /// The standard deviation of the errors, or another scale of their density.
    pub sigma: Sigma,
    /// How the errors are distributed.
    pub law: Law,
    /// What is estimated of its units.
    pub scaling: Scaling,
    /// With which other series its errors are correlated.
    pub joint: Option<Joint>,
    /// The points of which only a limit was measured, Y, with [`Law::Below`] or [`Law::Above`].
    pub censored: Vec<(usize, Law)>,
    /// The column of the data that Y was read from.
    pub column: String,
    /// The column that X was read from; empty where there is none.
    pub x_column: String,
    /// Rows of the points in the data, the first below the heading is 1; empty where points have
    /// no rows, and then they are counted.
    pub rows: Vec<usize>,
    /// Rows that were left out because a number is missing.
    pub missing: Vec<usize>,
}

impl Series {
    /// Its name in messages: `experiment / variable`.
    pub fn label(&self) -> String {
        match self.experiment.is_empty() {
            true => self.y_name.clone(),
            false => format!("{} / {}", self.experiment, self.y_name),
        }
    }

    /// Whether its errors are normal, and all its values measured.
    pub fn is_normal(&self) -> bool {
        self.law == Law::Normal && self.censored.is_empty()
    }

    /// How the error of a point is distributed.
    pub(super) fn law_of(&self, point: usize) -> Law {
        let own = self.censored.iter().find(|(own, _)| *own == point);
        own.map_or(self.law, |(_, law)| *law)
    }

    /// Whether its points were measured.
    pub fn is_data(&self) -> bool {
        self.role == Role::Data
    }

    /// The series of the standard deviations of this one, `back` series later, where the variable
    /// of the model `name` has them.
    pub fn deviations(&self, name: &str, back: usize) -> Series {
        Series {
            role: Role::Deviation(back),
            scaling: Scaling::default(),
            joint: None,
            y_name: name.to_owned(),
            y: vec![0.0; self.y.len()],
            sigma: Sigma::Given(vec![1.0; self.y.len()]),
            weight: 1.0,
            relative: Vec::new(),
            missing: Vec::new(),
            ..self.clone()
        }
    }

    /// The same where the output is `values`.
    pub(super) fn weights_at(&self, values: &[f64]) -> Vec<f64> {
        let mut weights = self.sigma.weights(values, self.weight);
        weights.iter_mut().zip(&self.relative).for_each(|(weight, size)| *weight /= size);
        weights
    }

    /// The name of the standard deviation that is estimated for it; series with one name share it.
    pub fn deviation(&self) -> Option<&str> {
        match &self.sigma {
            Sigma::Shared(name) => Some(name),
            sigma => sigma.is_estimated().then_some(self.y_name.as_str()),
        }
    }

    /// What the difference of each point counts, as far as it is known before the fit; a formula
    /// for sigma is taken at the measured values.
    pub fn weights(&self) -> Vec<f64> {
        self.weights_at(&self.y)
    }
}

/// When a run ends; the first that holds ends it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Stop {
    /// Questions asked by the method.
    pub generations: Option<u64>,
    /// Individuals evaluated.
    pub evaluations: Option<u64>,
    /// Seconds of work, those before a resume included.
    pub seconds: Option<f64>,
    /// A fitness that is good enough.
    pub target: Option<f64>,
    /// Generations without an improvement by one millionth.
    pub stagnation: Option<u64>,
}

/// A problem to solve.
pub struct Problem {
    /// What the report is headed with.
    pub title: String,
    /// The model, for the report.
    pub model: String,
    /// The problem as it was written, for the report; empty where it is put in Rust.
    pub text: String,
    /// What the models describe their variables and parameters as, for pictures.
    pub descriptions: Descriptions,
    /// The parameters to identify.
    pub parameters: Vec<Free>,
    /// The measured series.
    pub series: Vec<Series>,
    /// Names and functions to minimize; several for a method that handles several.
    pub objectives: Vec<(String, Box<dyn Fitness>)>,
    /// The name of the method.
    pub method_name: String,
    /// The method.
    pub method: Box<dyn Method>,
    /// Whether the best individuals are refined by least squares.
    pub polish: bool,
    /// The seed of all random numbers.
    pub seed: [f64; 6],
    /// When the run ends.
    pub stop: Stop,
    /// Relative error of the simulated values, for finite differences: 1e-15 for a formula.
    pub noise: f64,
    /// What is requested beyond the estimates.
    pub inference: Inference,
    /// Makes a simulator; one a thread.
    pub simulator: MakeSimulator,
}

impl Problem {
    /// Whether the errors of all series are normal.
    pub(crate) fn is_normal(&self) -> bool {
        self.series.iter().all(Series::is_normal)
    }

    /// Number of points of all series.
    pub(crate) fn n_points(&self) -> usize {
        self.series.iter().map(|series| series.x.len()).sum()
    }

    /// Values of the free parameters of a genome.
    pub fn values(&self, genome: &[f64]) -> Vec<f64> {
        match self.method.in_natural_units() {
            true => genome.to_vec(),
            false => self.parameters.iter().zip(genome).map(|(free, &u)| free.value(u)).collect(),
        }
    }
}

#[cfg(test)]
mod findings_tests;
#[cfg(test)]
mod irregular_tests;
#[cfg(test)]
mod joint_tests;
#[cfg(test)]
mod linearity_tests;
#[cfg(test)]
mod stopping_tests;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod verdict_tests;
