//! What other simulators of the same points reach by least squares: those of a model without its noise, or
//! of inputs that continue otherwise between samples.

use super::checks::residual_findings;
use super::misread::is_pattern;
use super::refit::{Fitted, Refit};
use super::{Best, Evaluation, MakeSimulator, Run, Statistics};
use crate::diag::Fault;
use crate::ranks::Processors;

/// What other simulators of the same points reach.
pub struct Elsewhere {
    /// The best point; `None` where they cannot simulate that of the run, or no descent has an end.
    pub best: Option<Best>,
    /// Whether its residuals have a pattern, where one descent was made from the best point of the run.
    pub has_pattern: bool,
    /// Simulations that it took.
    pub simulations: u64,
}

impl Run {
    /// What other simulators of the same points reach by least squares from the best point. With `others`,
    /// descents from these too are followed to their ends.
    ///
    /// # Errors
    ///
    /// Those of the simulators' maker.
    pub fn best_with(
        &mut self,
        simulator: MakeSimulator,
        others: Option<&[Vec<f64>]>,
        processors: &Processors,
    ) -> Result<Elsewhere, Fault> {
        let own = std::mem::replace(&mut self.problem.simulator, simulator);
        let found = self.best_elsewhere(others, processors);
        self.problem.simulator = own;
        found
    }

    fn best_elsewhere(
        &self,
        others: Option<&[Vec<f64>]>,
        processors: &Processors,
    ) -> Result<Elsewhere, Fault> {
        let nothing = Elsewhere { best: None, has_pattern: false, simulations: 0 };
        let Some(best) = &self.observed.best else { return Ok(nothing) };
        let mut evaluation = Evaluation::on(&self.problem, processors)?;
        evaluation.reweigh(&self.problem, self.evaluation.weights().to_vec());
        evaluation.cancel_by(self.evaluation.cancel());
        let (values, simulations) = match Refit::new(&self.problem, &evaluation) {
            Some(mut refit) => {
                let mut least: Option<Fitted> = None;
                if others.is_none() {
                    least = refit.from(&best.values, None)?;
                }
                let ends = others.map(|others| std::iter::once(&best.values).chain(others));
                for start in ends.into_iter().flatten() {
                    let found = refit.followed(start)?;
                    let is_less = |own: &Fitted| least.as_ref().is_none_or(|known| own.1 < known.1);
                    least = found.filter(is_less).or(least);
                }
                (least.map(|(values, _)| values), refit.simulations)
            }
            None => (Some(best.values.clone()), 1),
        };
        let mut found = Elsewhere { simulations, ..nothing };
        let row = values.and_then(|values| Some((evaluation.simulate(&values).ok()?, values)));
        let Some((row, values)) = row else { return Ok(found) };
        if others.is_none() {
            let statistics = Statistics::at(&self.problem, &evaluation, &values, &row, &[]);
            let resolved = self.conclusion.resolved;
            let findings = residual_findings(&self.problem, &statistics, &row, resolved);
            found.has_pattern = findings.iter().any(is_pattern);
            found.simulations += statistics.simulations;
        }
        let fitness = evaluation.objective(&self.problem, &row);
        found.best = Some(Best { values, fitness });
        Ok(found)
    }
}
