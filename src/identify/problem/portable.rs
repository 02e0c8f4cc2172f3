//! Simulators as data: what one process writes and another one of the same version reads.
//!
//! Models go as compiled programs, so that the other process needs none of their files.

use crate::PortableModel;
use crate::sim::PortableSettings;
use serde::{Deserialize, Serialize};

/// A simulator.
#[derive(Debug, Serialize, Deserialize)]
pub enum Portable {
    /// Experiments, one after the other.
    Experiments(Vec<PortableExperiment>),
    /// Another one with priors, constraints and logarithms.
    Adjusted {
        /// The simulator below.
        inner: Box<Portable>,
        /// What [`adjusted_from`](super::inference::adjusted_from) reads.
        adjustments: Vec<u8>,
    },
}

/// An [`Experiment`](super::Experiment).
#[derive(Debug, Serialize, Deserialize)]
pub struct PortableExperiment {
    pub(super) name: String,
    pub(super) model: PortableModel,
    pub(super) settings: PortableSettings,
    pub(super) second_attempt: bool,
    pub(super) x_name: String,
    /// Variables with X of their points.
    pub(super) observations: Vec<(String, Vec<f64>)>,
    pub(super) deviations: usize,
    pub(super) parameters: Vec<(usize, String)>,
}
