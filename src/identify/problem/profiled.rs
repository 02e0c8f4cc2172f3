//! Profiles of a solution: what they say, and the better fits that they come upon.

use super::conclusion::{continue_from, refit};
use super::notes::profile_findings;
use super::{
    EndingKind, Finding, FindingKind, Profiles, Run, Severity, Solution, SolvedParameter, profiles,
};
use crate::diag::Fault;
use crate::identify::table::significant;
use crate::registry::BAD_OPTION;
use crate::{bail, fault};

/// So often a better fit that the profiles come upon is gone to.
const BETTER_FITS: usize = 4;

impl Solution {
    /// The solution with its profiles, which a minimum alone has: where the search has ended before
    /// one, least squares go on first. Where the profiles come upon a better fit the run goes there,
    /// `again` makes its statistics, and the profiles are made anew.
    ///
    /// # Errors
    ///
    /// Those of `again` and of least squares.
    pub fn with_profiles(
        mut self,
        run: &mut Run,
        again: impl Fn(&Run) -> Result<Solution, Fault>,
    ) -> Result<Solution, Fault> {
        let (importance, searched) = (self.importance.take(), self.fitness);
        if self.is_short_of_minimum(run) && refit(run)? {
            self = again(run)?;
        }
        for _ in 0..BETTER_FITS {
            self.add_profiles(run);
            let better = self.profiles.as_ref().and_then(|found| found.better.clone());
            let Some((values, _)) = better else { break };
            if !continue_from(run, &values)? {
                break;
            }
            let simulations = self.profiles.as_ref().map_or(0, |found| found.simulations);
            let simulations = simulations + self.simulations_for_statistics;
            self = again(run)?;
            self.simulations_for_statistics += simulations;
        }
        if self.profiles.is_none() {
            self.add_profiles(run);
        }
        self.importance = importance;
        if self.fitness < searched {
            self.findings.insert(0, better_than(searched, &self));
        }
        Ok(self)
    }

    /// Whether there is a sum of squares of which the best point is not known to be a minimum.
    fn is_short_of_minimum(&self, run: &Run) -> bool {
        self.ending.kind != EndingKind::Minimum && run.evaluation.has_residuals()
    }

    /// Adds the profiles of all parameters and what they say; where there are none, a finding says
    /// why, and the solution stays as it is.
    pub(super) fn add_profiles(&mut self, run: &Run) {
        match self.profiles_about_best(run) {
            Ok(Some(found)) => {
                self.findings.extend(profile_findings(self, &found));
                self.profiles = Some(found);
            }
            Ok(None) => {}
            Err(fault) => self.findings.push(
                Finding::new(FindingKind::Missing, format!("{}.", fault.message))
                    .severity(Severity::Information),
            ),
        }
    }

    fn profiles_about_best(&self, run: &Run) -> Result<Option<Profiles>, Fault> {
        let Some(best) = &run.best else { return Ok(None) };
        if self.is_short_of_minimum(run) {
            bail!(BAD_OPTION, "There are no profiles, because this is not known to be a minimum");
        }
        let half = |p: &SolvedParameter| p.interval.map(|[low, high]| 0.5 * (high - low));
        let reach: Vec<Option<f64>> = self.parameters.iter().map(half).collect();
        let found = profiles(&run.problem, &run.evaluation, &best.values, &reach)?;
        let found = found.ok_or_else(|| {
            fault!(
                BAD_OPTION,
                "There are no profiles of `{}` with {} points: they need a sum of squares of more points than parameters", self.fitness_name, run.problem.n_points()
            )
        })?;
        Ok(Some(found))
    }
}

/// That the run went to a better fit which its profiles came upon; `searched`: the objective at the
/// end of the search.
fn better_than(searched: f64, solution: &Solution) -> Finding {
    let sentence = format!(
        "Least squares and profiles behind the search came upon a better fit ({} instead of {}): \
         everything here belongs to that one.",
        significant(solution.fitness, 7),
        significant(searched, 7)
    );
    Finding::new(FindingKind::Search, sentence)
}
