//! Least squares of some parameters from a known point, the others held.

use super::statistics::outliers::basis;
use super::{Best, Evaluation, Free, Problem, Run, Simulate};
use crate::diag::Fault;
use crate::ga::optimizer::{Answers, METHODS, Required, Setup};
use crate::ga::{FAILED_FITNESS, Gene, Genomes, Mrg32k3a};
use crate::registry::{self, Options};
use nalgebra::DVector;

/// Evaluations of one fit.
const BUDGET: u64 = 400;
/// So many of them a descent to its end may take; chosen, not measured.
const BUDGETS: usize = 8;
/// A budget that lowers the sum by less than this part of that of a point is that of a descent at its
/// end: -log L has fallen by less than half of it.
const ENDED: f64 = 0.01;
/// Relative offset at which a rough fit ends. What it then lacks of the sum of squares is 1e-6 of the
/// residual variance for each parameter that is varied.
const ROUGH: f64 = 1e-3;

/// Fits again and again about the same problem.
pub(crate) struct Refit<'a> {
    problem: &'a Problem,
    evaluation: &'a Evaluation,
    n_points: usize,
    /// Simulations so far.
    pub simulations: u64,
}

/// Makes the simulators of a problem.
pub type MakeSimulator = Box<dyn Fn() -> Result<Box<dyn Simulate>, Fault> + Send + Sync>;

/// Values of all parameters and their sum of squares.
pub type Fitted = (Vec<f64>, f64);

impl<'a> Refit<'a> {
    /// `None` where the first objective is no sum of squares.
    pub fn new(problem: &'a Problem, evaluation: &'a Evaluation) -> Option<Refit<'a>> {
        evaluation.scales()?;
        Some(Refit { problem, evaluation, n_points: problem.n_points(), simulations: 0 })
    }

    /// Whether simulations were cancelled: what came of them says nothing.
    pub fn is_cancelled(&self) -> bool {
        self.evaluation.is_cancelled()
    }

    /// A parameter of the problem.
    pub fn parameter(&self, k: usize) -> &'a Free {
        &self.problem.parameters[k]
    }

    /// The best values from `start`, parameter `held` standing still; `None` where `start` cannot
    /// be simulated.
    ///
    /// # Errors
    ///
    /// Those of the method's maker.
    pub fn from(&mut self, start: &[f64], held: Option<usize>) -> Result<Option<Fitted>, Fault> {
        self.descend(start, held.as_slice(), &mut Options::default())
    }

    /// The same where parameters stand still and the sum alone counts: the values of the others lie within a
    /// thousandth of their standard errors.
    ///
    /// # Errors
    ///
    /// Those of the method's maker.
    pub fn roughly(&mut self, start: &[f64], held: &[usize]) -> Result<Option<Fitted>, Fault> {
        let mut how = Options::default();
        how.set("offset", ROUGH);
        self.descend(start, held, &mut how)
    }

    /// By how much a step of Gauss and Newton from `values`, which were simulated, lowers the sum of squares
    /// as the linear model there has it, some parameters standing still; `None` without derivatives.
    pub(super) fn fall(&mut self, values: &[f64], row: &[f64], held: &[usize]) -> Option<f64> {
        let varied: Vec<usize> = (0..values.len()).filter(|k| !held.contains(k)).collect();
        let jacobian = self.jacobians(&[values.to_vec()], &varied);
        let residuals = DVector::from_vec(self.evaluation.residuals(self.problem, row));
        let column = |k: usize| jacobian.iter().skip(k).step_by(varied.len()).copied().collect();
        let columns: Vec<Vec<f64>> = (0..varied.len()).map(column).collect();
        let points: Vec<usize> = (0..residuals.len()).collect();
        let fall = basis(&columns, &points).tr_mul(&residuals).norm_squared();
        let are_known = columns.iter().flatten().all(|value| value.is_finite());
        Some(fall).filter(|_| are_known)
    }

    fn descend(
        &mut self,
        start: &[f64],
        held: &[usize],
        how: &mut Options,
    ) -> Result<Option<Fitted>, Fault> {
        let Some(first) = self.residuals(&[start.to_vec()]).pop().flatten() else {
            return Ok(None);
        };
        let mut best = (start.to_vec(), square(&first));
        let varied: Vec<usize> = (0..start.len()).filter(|k| !held.contains(k)).collect();
        if varied.is_empty() {
            return Ok(Some(best));
        }
        let mut search = self.search(start, &varied, how)?;
        let limit = self.simulations + BUDGET;
        while self.simulations < limit {
            let mut batch = Genomes::with_capacity(varied.len(), 0);
            search.ask(&mut batch);
            if batch.is_empty() {
                break;
            }
            let values: Vec<Vec<f64>> =
                batch.rows().map(|genome| self.values(start, &varied, genome)).collect();
            let rows = self.residuals(&values);
            let points = values.clone();
            let sums = rows.iter().map(|row| row.as_deref().map_or(FAILED_FITNESS, square));
            let fitness: Vec<f64> = sums.collect();
            for (values, fitness) in values.into_iter().zip(&fitness) {
                if *fitness < best.1 {
                    best = (values, *fitness);
                }
            }
            let failed = vec![f64::NAN; self.n_points];
            let flat: Vec<f64> =
                rows.into_iter().flat_map(|row| row.unwrap_or_else(|| failed.clone())).collect();
            let jacobians = match search.required() {
                Required::Jacobians => self.jacobians(&points, &varied),
                _ => Vec::new(),
            };
            let answers = Answers {
                objectives: &fitness,
                n_objectives: 1,
                residuals: &flat,
                jacobians: &jacobians,
            };
            search.tell(&batch, &answers);
        }
        Ok(Some(best))
    }

    /// The end of a descent, which may take several budgets, with its objective; `None` where it does
    /// not end.
    pub(super) fn followed(&mut self, start: &[f64]) -> Result<Option<Fitted>, Fault> {
        let mut before: Option<Fitted> = None;
        for _ in 0..BUDGETS {
            let from = before.as_ref().map_or(start, |(values, _)| values);
            let Some(found) = self.from(from, None)? else { return Ok(None) };
            let limit = ENDED / self.n_points as f64;
            if before.as_ref().is_some_and(|own| own.1 - found.1 <= limit * own.1) {
                let Ok(row) = self.evaluation.simulate(&found.0) else { return Ok(None) };
                let objective = self.evaluation.objective(self.problem, &row);
                return Ok(Some((found.0, objective)));
            }
            before = Some(found);
        }
        Ok(None)
    }

    /// Weighted residuals, measured less simulated, without the factors of a robust fitness.
    pub(crate) fn plain_residuals(&self, values: &[f64]) -> Option<Vec<f64>> {
        let simulated = self.evaluation.simulate(values).ok()?;
        Some(self.evaluation.standard_residuals(self.problem, &simulated))
    }

    /// The residuals that are minimized.
    pub(crate) fn searched_residuals(&mut self, values: &[f64]) -> Option<Vec<f64>> {
        self.residuals(&[values.to_vec()]).pop().flatten()
    }

    fn search(
        &self,
        start: &[f64],
        varied: &[usize],
        how: &mut Options,
    ) -> Result<Box<dyn crate::ga::optimizer::Optimizer>, Fault> {
        let free = |k: usize| &self.problem.parameters[k];
        let entry = registry::find("method", METHODS, "levenberg_marquardt")?;
        let genes = varied.iter().map(|&k| Gene::new(&free(k).name, 0.0, 1.0));
        (entry.make)(how)?.start(Setup {
            genes: genes.collect::<Result<_, Fault>>()?,
            scales: Vec::new(),
            n_objectives: 1,
            budget: None,
            start: Some(varied.iter().map(|&k| free(k).fraction(start[k])).collect()),
            noise: self.problem.noise,
            size: self.evaluation.size(),
            rng: Mrg32k3a::new(&self.problem.seed)?,
        })
    }

    fn values(&self, start: &[f64], varied: &[usize], genome: &[f64]) -> Vec<f64> {
        let mut values = start.to_vec();
        for (&k, &u) in varied.iter().zip(genome) {
            values[k] = self.problem.parameters[k].value(u);
        }
        values
    }

    /// Derivatives of the residuals by the fractions of those that are varied.
    fn jacobians(&mut self, places: &[Vec<f64>], varied: &[usize]) -> Vec<f64> {
        let n = self.problem.parameters.len();
        let mut jacobians = Vec::new();
        for (place, found) in places.iter().zip(self.evaluation.linearize(self.problem, places)) {
            let Ok(found) = found else {
                jacobians.extend(vec![f64::NAN; self.n_points * varied.len()]);
                continue;
            };
            self.simulations += found.simulations;
            let (mut residuals, mut factors) = (vec![0.0; self.n_points], vec![0.0; self.n_points]);
            self.evaluation.scaled(self.problem, &found.simulated, &mut residuals, &mut factors);
            let mut own = Vec::new();
            for (row, scale) in found.derivatives.chunks_exact(n).zip(&factors) {
                let derivative = |k: usize| self.problem.parameters[k].derivative(place[k]);
                own.extend(varied.iter().map(|&k| row[k] * scale * derivative(k)));
            }
            if let Some(whitening) = self.evaluation.whitening(self.problem, &found.simulated) {
                whitening.apply_to_rows(&mut own, varied.len());
            }
            jacobians.append(&mut own);
        }
        jacobians
    }

    fn residuals(&mut self, values: &[Vec<f64>]) -> Vec<Option<Vec<f64>>> {
        self.simulations += values.len() as u64;
        let n = self.n_points;
        let weighted = |row: Vec<f64>| {
            let (mut residuals, mut factors) = (vec![0.0; n], vec![0.0; n]);
            self.evaluation.scaled(self.problem, &row, &mut residuals, &mut factors);
            residuals
        };
        let rows = self.evaluation.simulate_all(values).into_iter();
        rows.map(|row| row.ok().map(weighted)).collect()
    }
}

fn square(row: &[f64]) -> f64 {
    row.iter().map(|r| r * r).sum()
}

impl Run {
    /// Goes to a better point that was found beside the search, as by a profile, and on from there by
    /// least squares; returns whether it was better.
    ///
    /// # Errors
    ///
    /// Those of the method's maker.
    pub(super) fn continue_from(&mut self, values: &[f64]) -> Result<bool, Fault> {
        let is_better = self.go_to(values);
        if is_better {
            self.refit()?;
        }
        Ok(is_better)
    }

    /// Least squares from the best point, which it replaces; without least squares only the
    /// objective is recomputed. Returns whether that is smaller.
    ///
    /// # Errors
    ///
    /// Those of the method's maker.
    pub(super) fn refit(&mut self) -> Result<bool, Fault> {
        let Some(best) = &self.observed.best else { return Ok(false) };
        let before = best.fitness;
        let found = match Refit::new(&self.problem, &self.evaluation) {
            Some(mut refit) => {
                let found = refit.from(&best.values, None)?;
                self.conclusion.simulations += refit.simulations;
                found.map_or_else(|| best.values.clone(), |(values, _)| values)
            }
            None => best.values.clone(),
        };
        let Ok(simulated) = self.evaluation.simulate(&found) else { return Ok(false) };
        let fitness = self.evaluation.objective(&self.problem, &simulated);
        self.observed.best = Some(Best { values: found, fitness });
        Ok(fitness < before)
    }
}
