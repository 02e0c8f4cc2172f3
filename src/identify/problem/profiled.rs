//! Profiles of a solution: what they say, and the better fits that they come upon.

use super::ending::SolvedDescent;
use super::profile::{Known, profiles};
use super::verdict_notes::{about_parameter, profile_findings};
use super::{
    EndingKind, Finding, FindingKind, Profile, Profiles, Run, Severity, Solution, Verdict,
};
use crate::diag::Fault;
use crate::registry::BAD_OPTION;
use crate::table::significant;
use crate::{bail, fault};

/// Ends of other descents from which the fits of a profile begin as well.
const OTHER_PLACES: usize = 4;
/// So often a better fit that the profiles come upon is gone to.
const BETTER_FITS: usize = 4;

impl Solution {
    /// The solution of a run, which goes to the better fits that the profiles of its verdicts come
    /// upon; `again` makes the statistics.
    ///
    /// # Errors
    ///
    /// Those of `again` and of least squares.
    pub fn settled(
        run: &mut Run,
        again: impl Fn(&Run) -> Result<Solution, Fault>,
    ) -> Result<Solution, Fault> {
        let mut solution = again(run)?;
        let searched = solution.fitness;
        for _ in 0..BETTER_FITS {
            let Some((values, _)) = solution.grounds.better.take() else { break };
            if !run.continue_from(&values)? {
                break;
            }
            let simulations = solution.effort.simulations_for_statistics;
            solution = again(run)?;
            solution.effort.simulations_for_statistics += simulations;
        }
        if solution.fitness < searched {
            solution.findings.insert(0, better_than(searched, &solution));
        }
        Ok(solution)
    }

    /// The solution with its profiles, which a minimum alone has: where the search has ended before
    /// one, least squares go on first. Where the profiles find a better fit the run goes there,
    /// `again` makes its statistics, and the profiles are repeated.
    ///
    /// # Errors
    ///
    /// Those of `again` and of least squares.
    pub fn with_profiles(
        mut self,
        run: &mut Run,
        again: impl Fn(&Run) -> Result<Solution, Fault>,
    ) -> Result<Solution, Fault> {
        if run.evaluation.is_cancelled() {
            let names = self.parameters.iter().map(|own| own.name.as_str()).collect();
            self.findings.push(not_profiled(names));
            return Ok(self);
        }
        let (importance, searched) = (self.importance.take(), self.fitness);
        if self.is_short_of_minimum(run) && run.refit()? {
            self = again(run)?;
        }
        for number in 0..=BETTER_FITS {
            self.add_profiles(run);
            let better = self.profiles.as_ref().and_then(|found| found.better.clone());
            let may_go_on = number < BETTER_FITS && !run.evaluation.is_cancelled();
            let Some((values, _)) = better.filter(|_| may_go_on) else { break };
            if !run.continue_from(&values)? {
                break;
            }
            let simulations = self.profiles.as_ref().map_or(0, |found| found.simulations);
            let simulations = simulations + self.effort.simulations_for_statistics;
            self = again(run)?;
            self.effort.simulations_for_statistics += simulations;
        }
        self.importance = importance;
        if self.fitness < searched {
            self.findings.insert(0, better_than(searched, &self));
        }
        Ok(self)
    }

    /// Whether there is a sum of squares of which the best point is not known to be a minimum.
    fn is_short_of_minimum(&self, run: &Run) -> bool {
        self.outcome.ending.kind != EndingKind::Minimum && run.evaluation.has_residuals()
    }

    /// Adds the profiles of all parameters and what they say; where there are none, a finding says
    /// why, and the solution stays as it is.
    pub(super) fn add_profiles(&mut self, run: &Run) {
        match self.profiles_about_best(run) {
            Ok(Some(found)) => {
                self.findings.extend(profile_findings(self, &found));
                self.judge_anew(&found);
                let is_whole = found.profiles.iter().all(|own| own.complete == [true; 2]);
                self.profiles = Some(found).filter(|_| is_whole);
            }
            Ok(None) => {}
            Err(_) if run.evaluation.is_cancelled() => {
                let names = self.parameters.iter().map(|own| own.name.as_str()).collect();
                self.findings.push(not_profiled(names));
            }
            Err(fault) => self.findings.push(
                Finding::new(FindingKind::Missing, format!("{}.", fault.message))
                    .severity(Severity::Information),
            ),
        }
    }

    /// Profiles that were made although the linear interval seemed to hold decide, too.
    fn judge_anew(&mut self, found: &Profiles) {
        let mut missing: Vec<&str> = Vec::new();
        for profile in &found.profiles {
            let Some(k) = self.parameters.iter().position(|own| own.name == profile.name) else {
                continue;
            };
            if profile.complete != [true; 2] {
                missing.push(&profile.name);
                continue;
            }
            let own = &self.parameters[k];
            let has_verdict = matches!(
                own.verdict,
                None | Some(Verdict::Identifiable | Verdict::PracticallyNonIdentifiable)
            );
            let is_known = self.grounds.profiles.iter().any(|(known, _)| *known == k);
            if is_known || !has_verdict || own.in_steps || self.grounds.linear.len() <= k {
                continue;
            }
            let judged = self.adopt(k, profile, found.simulations);
            let name = self.parameters[k].name.clone();
            // What was said before of it alone.
            self.findings.retain(|finding| {
                !(finding.kind.is_about_profile() && finding.parameters == [name.clone()])
            });
            let findings = about_parameter(self, k, &judged);
            self.findings.extend(findings);
        }
        if !missing.is_empty() {
            self.findings.push(not_profiled(missing));
        }
    }

    /// Where descents have ended beside the best minimum: other minima within the limit first, then
    /// the best of the others whose sum of squares is at most this.
    pub(super) fn other_places(&self, most: f64) -> Vec<Vec<f64>> {
        let mut places: Vec<Vec<f64>> =
            self.outcome.other_minima.iter().map(|other| other.values.clone()).collect();
        let sum = |descent: &SolvedDescent| descent.objective.unwrap_or(f64::INFINITY);
        let is_meant = |descent: &&SolvedDescent| descent.group > 0 && sum(descent) <= most;
        let mut ends: Vec<&SolvedDescent> = self.outcome.descents.iter().filter(is_meant).collect();
        ends.sort_by(|a, b| a.group.cmp(&b.group).then(sum(a).total_cmp(&sum(b))));
        ends.dedup_by_key(|descent| descent.group);
        places.extend(ends.into_iter().map(|descent| descent.end.clone()));
        places.dedup();
        places.truncate(OTHER_PLACES);
        places
    }

    fn profiles_about_best(&self, run: &Run) -> Result<Option<Profiles>, Fault> {
        let Some(best) = &run.observed.best else { return Ok(None) };
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
        let reach = self.linear_reach(run);
        let others = self.other_places(f64::INFINITY);
        let known = Known {
            best: &best.values,
            reach: &reach,
            others: &others,
            is_shared: true,
            freedom: self.grounds.freedom,
            quantile: self.grounds.quantile,
            budget: u64::MAX,
        };
        // Where the profile of a member of a structural group ends, it is the ranges of the others that
        // end it.
        let has_one = |k: &usize| {
            self.parameters[*k].verdict != Some(Verdict::StructurallyNonIdentifiable)
                && self.grounds.profiles.iter().all(|(known, _)| known != k)
        };
        let missing: Vec<usize> = (0..self.parameters.len()).filter(has_one).collect();
        let found = profiles(&run.problem, &run.evaluation, &known, &missing)?;
        let found = found.map(|found| self.with_known(found, &missing));
        let found = found.ok_or_else(|| {
            fault!(
                BAD_OPTION,
                "There are no profile likelihoods of `{}` with {} points: they need a sum of \
                 squares and more points than parameters",
                self.subject.fitness_name,
                run.problem.n_points()
            )
        })?;
        Ok(Some(found))
    }
}

impl Solution {
    /// Profiles of some parameters, and those that verdicts rest on, in the order of the parameters.
    fn with_known(&self, mut found: Profiles, which: &[usize]) -> Profiles {
        let made = which.iter().copied().zip(std::mem::take(&mut found.profiles));
        let mut all: Vec<(usize, Profile)> =
            made.chain(self.grounds.profiles.iter().cloned()).collect();
        all.sort_by_key(|(k, _)| *k);
        found.profiles = all.into_iter().map(|(_, profile)| profile).collect();
        found
    }
}

/// That the run was stopped before these profiles.
fn not_profiled(names: Vec<&str>) -> Finding {
    let sentence = format!(
        "The profile likelihoods of {} were not computed: the run was stopped before.",
        names.join(", ")
    );
    Finding::new(FindingKind::Missing, sentence)
}

/// That the run went to a better fit which its profiles found; `searched`: the objective at the
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
