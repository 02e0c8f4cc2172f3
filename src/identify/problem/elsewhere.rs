//! What other simulators of the same points reach by least squares: those of a model without its noise, or
//! of inputs that continue otherwise between samples.

use super::refit::{Fitted, Refit};
use super::{Best, Evaluation, MakeSimulator, Run};
use crate::diag::Fault;
use crate::ranks::Processors;

impl Run {
    /// What other simulators of the same points reach by least squares from the best point, and the
    /// simulations that it took; `None` where they cannot simulate that point. With `others`, descents from
    /// these too are followed to their ends, and `None` also says that none has one.
    ///
    /// # Errors
    ///
    /// Those of the simulators' maker.
    pub fn best_with(
        &mut self,
        simulator: MakeSimulator,
        others: Option<&[Vec<f64>]>,
        processors: &Processors,
    ) -> Result<(Option<Best>, u64), Fault> {
        let own = std::mem::replace(&mut self.problem.simulator, simulator);
        let found = self.best_elsewhere(others, processors);
        self.problem.simulator = own;
        found
    }

    fn best_elsewhere(
        &self,
        others: Option<&[Vec<f64>]>,
        processors: &Processors,
    ) -> Result<(Option<Best>, u64), Fault> {
        let Some(best) = &self.observed.best else { return Ok((None, 0)) };
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
        let found = values.and_then(|values| {
            let row = evaluation.simulate(&values).ok()?;
            let fitness = evaluation.objective(&self.problem, &row);
            Some(Best { values, fitness })
        });
        Ok((found, simulations))
    }
}
