//! A simulator whose simulations another rank does.

use super::simulation::{Asked, Simulation, cancelled};
use crate::problem::{Failed, Simulate};
use std::sync::mpsc::{Receiver, Sender};

/// What a job requests to be simulated.
pub(super) struct Request {
    /// The lane that simulates it.
    pub lane: usize,
    pub values: Vec<f64>,
    pub points: usize,
    pub asked: Asked,
    pub tolerance: f64,
}

/// Simulates on one lane.
pub(super) struct Remote {
    lane: usize,
    requests: Sender<Request>,
    answers: Receiver<Simulation>,
    /// What the solver's tolerance is multiplied with.
    tolerance: f64,
    refusal: Option<String>,
}

impl Remote {
    pub fn new(
        lane: usize,
        requests: Sender<Request>,
        answers: Receiver<Simulation>,
        tolerance: f64,
    ) -> Remote {
        Remote { lane, requests, answers, tolerance, refusal: None }
    }

    /// The answer; `None` where the work was cancelled.
    fn ask(&mut self, values: &[f64], points: usize, asked: Asked) -> Option<Simulation> {
        let (lane, tolerance, values) = (self.lane, self.tolerance, values.to_vec());
        self.requests.send(Request { lane, values, points, asked, tolerance }).ok()?;
        self.answers.recv().ok()
    }
}

impl Simulate for Remote {
    fn simulate(&mut self, parameters: &[f64], out: &mut [f64]) -> Result<(), Failed> {
        let answer = self.ask(parameters, out.len(), Asked::Points).ok_or_else(cancelled)?;
        match answer.failed {
            Some(failed) => Err(failed),
            None if answer.row.len() == out.len() => {
                out.copy_from_slice(&answer.row);
                Ok(())
            }
            None => Err(cancelled()),
        }
    }

    fn sensitivities(
        &mut self,
        parameters: &[f64],
        out: &mut [f64],
        derivatives: &mut [f64],
    ) -> Result<bool, Failed> {
        let answer = self.ask(parameters, out.len(), Asked::Derivatives);
        let answer = answer.ok_or_else(cancelled)?;
        self.refusal = answer.refusal;
        if let Some(failed) = answer.failed {
            return Err(failed);
        }
        if !answer.exact || answer.derivatives.len() != derivatives.len() {
            return Ok(false);
        }
        out.copy_from_slice(&answer.row);
        derivatives.copy_from_slice(&answer.derivatives);
        Ok(true)
    }

    fn sensitivity_refusal(&self) -> Option<&str> {
        self.refusal.as_deref()
    }

    fn scale_tolerance(&mut self, factor: f64) {
        self.tolerance = factor;
    }
}
