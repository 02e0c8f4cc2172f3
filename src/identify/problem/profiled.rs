//! Profiles of a solution: what they say, and the better fits that they come upon.

use super::ending::SolvedDescent;
use super::notes::profile_findings;
use super::profile::{Known, profiles};
use super::{EndingKind, Finding, FindingKind, Profiles, Run, Severity, Solution, SolvedParameter};
use crate::diag::Fault;
use crate::identify::table::significant;
use crate::registry::BAD_OPTION;
use crate::{bail, fault};

/// Ends of other descents from which the fits of a profile begin as well.
const OTHER_PLACES: usize = 4;
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
        if self.is_short_of_minimum(run) && run.refit()? {
            self = again(run)?;
        }
        for _ in 0..BETTER_FITS {
            self.add_profiles(run);
            let better = self.profiles.as_ref().and_then(|found| found.better.clone());
            let Some((values, _)) = better else { break };
            if !run.continue_from(&values)? {
                break;
            }
            let simulations = self.profiles.as_ref().map_or(0, |found| found.simulations);
            let simulations = simulations + self.simulations_for_statistics;
            self = again(run)?;
            self.simulations_for_statistics += simulations;
        }
        if self.profiles.is_none() && run.evaluation.parts.shard().is_none() {
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

    /// Where descents have ended beside the best minimum: other minima within the limit first, then
    /// the best of the others.
    pub(super) fn other_places(&self) -> Vec<Vec<f64>> {
        let mut places: Vec<Vec<f64>> =
            self.other_minima.iter().map(|other| other.values.clone()).collect();
        let sum = |descent: &SolvedDescent| descent.objective.unwrap_or(f64::INFINITY);
        let mut ends: Vec<&SolvedDescent> = self.descents.iter().filter(|d| d.group > 0).collect();
        ends.sort_by(|a, b| a.group.cmp(&b.group).then(sum(a).total_cmp(&sum(b))));
        ends.dedup_by_key(|descent| descent.group);
        places.extend(ends.into_iter().map(|descent| descent.end.clone()));
        places.dedup();
        places.truncate(OTHER_PLACES);
        places
    }

    fn profiles_about_best(&self, run: &Run) -> Result<Option<Profiles>, Fault> {
        let Some(best) = &run.best else { return Ok(None) };
        if self.is_short_of_minimum(run) {
            bail!(
                BAD_OPTION,
                "There are no profile likelihoods: it is unknown whether this is a minimum"
            );
        }
        if self.findings.iter().any(|finding| finding.kind == FindingKind::NoNoise) {
            bail!(
                BAD_OPTION,
                "There are no profile likelihoods: the residuals are errors of the simulation, \
                 not noise"
            );
        }
        if super::limits::along(&run.problem, &best.values).is_some() {
            bail!(BAD_OPTION, "There are no profile likelihoods at the limit of a constraint");
        }
        let half = |p: &SolvedParameter| p.interval.map(|[low, high]| 0.5 * (high - low));
        let reach: Vec<Option<f64>> = self.parameters.iter().map(half).collect();
        let others = self.other_places();
        let known = Known { best: &best.values, reach: &reach, others: &others, is_shared: true };
        let all: Vec<usize> = (0..reach.len()).collect();
        let found = profiles(&run.problem, &run.evaluation, &known, &all)?;
        let found = found.ok_or_else(|| {
            fault!(
                BAD_OPTION,
                "There are no profile likelihoods of `{}` with {} points: they need a sum of \
                 squares and more points than parameters",
                self.fitness_name,
                run.problem.n_points()
            )
        })?;
        Ok(Some(found))
    }
}

/// That the run went to a better fit which its profiles came upon; `searched`: the objective at the
/// end of the search.
fn better_than(searched: f64, solution: &Solution) -> Finding {
    let sentence = format!(
        "Least squares and profile likelihoods after the search found a better fit ({} instead \
         of {}): all results refer to that fit.",
        significant(solution.fitness, 7),
        significant(searched, 7)
    );
    Finding::new(FindingKind::Search, sentence)
}
