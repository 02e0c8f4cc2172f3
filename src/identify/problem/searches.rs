//! Several searches with different seeds: the best one counts, and how many came as far says how far
//! its result can be trusted.

use super::{Best, Finding, FindingKind, Run, Solution, SolvedSearch};
use crate::ga::has_failed;
use crate::table::{quoted, significant};
use std::fmt::Write;

/// Objectives above the smallest by less than this part of it count as equal.
const EQUAL: f64 = 0.01;
/// Negative log-likelihoods above the smallest by less than this count as equal: half of the 95 % quantile of
/// chi-square with one degree of freedom. Their size depends on the units of the data.
const EQUALLY_LIKELY: f64 = 1.92;
/// Sums of squares below this part of that of the measured values are errors of rounding.
const OF_ROUNDING: f64 = 1e-16;

impl SolvedSearch {
    /// What a run has found.
    pub fn of(run: &Run) -> SolvedSearch {
        let none = || Best { values: Vec::new(), fitness: f64::INFINITY };
        let Best { values, fitness: objective } = run.observed.best.clone().unwrap_or_else(none);
        SolvedSearch {
            seed: run.problem.seed,
            objective,
            values,
            generations: run.generations(),
            evaluations: run.evaluations(),
            as_good: false,
        }
    }
}

/// The best of these searches, the first of equal ones; marks those that count as equal to it. `run` is
/// that of any of them.
pub fn best_of(run: &Run, searches: &mut [SolvedSearch]) -> Option<usize> {
    let found = searches.iter().enumerate().filter(|(_, own)| !has_failed(own.objective));
    let (best, objective) = found
        .map(|(number, own)| (number, own.objective))
        .min_by(|a, b| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0)))?;
    let squares = match run.evaluation.has_residuals() {
        true => run.evaluation.size() * run.evaluation.size(),
        false => 0.0,
    };
    let allowed = match is_likelihood(&run.problem.objectives[0].0) {
        true => EQUALLY_LIKELY,
        false => (EQUAL * objective.abs()).max(OF_ROUNDING * squares),
    };
    searches.iter_mut().for_each(|own| own.as_good = own.objective - objective <= allowed);
    Some(best)
}

/// Whether an objective is a negative logarithm of a likelihood.
fn is_likelihood(objective: &str) -> bool {
    objective.replace(['-', '_'], " ").ends_with("log likelihood")
}

impl Solution {
    /// How the searches ended, in a line; `None` where there was one alone.
    pub(super) fn searches_line(&self) -> Option<String> {
        let count = self.outcome.searches.len();
        if count < 2 {
            return None;
        }
        let mut all: Vec<f64> = self.outcome.searches.iter().map(|own| own.objective).collect();
        all.sort_by(f64::total_cmp);
        let [best, median, worst] = [0, (count - 1) / 2, count - 1].map(|k| significant(all[k], 5));
        let within = match is_likelihood(&self.subject.fitness_name) {
            true => EQUALLY_LIKELY.to_string(),
            false => "1 %".to_owned(),
        };
        let failed = all.iter().filter(|objective| has_failed(**objective)).count();
        let failures = match failed {
            0 => String::new(),
            failed => format!("; {failed} without any simulation that succeeded"),
        };
        Some(format!(
            "{} of {count} with different seeds found the best objective within {within}: best {best}, \
             median {median}, worst {worst}{failures}",
            self.as_good()
        ))
    }

    fn as_good(&self) -> usize {
        self.outcome.searches.iter().filter(|own| own.as_good).count()
    }

    /// Adds the searches that were made, and what they say. `searched`: the objective before profiles, which
    /// may have come upon a better fit than any search.
    pub fn add_searches(&mut self, searches: Vec<SolvedSearch>, searched: f64) {
        self.outcome.searches = searches;
        let equal = match is_likelihood(&self.subject.fitness_name) {
            true => EQUALLY_LIKELY,
            false => EQUAL * searched.abs(),
        };
        if searched - self.fitness > equal {
            self.outcome.searches.iter_mut().for_each(|own| own.as_good = false);
        }
        let (count, as_good) = (self.outcome.searches.len(), self.as_good());
        let Some(first) = self.outcome.searches.first().filter(|_| count > 1) else { return };
        if self.outcome.searches.iter().all(|own| own.values == first.values) {
            let sentence = format!(
                "All searches have found the same values to the last digit, as `{}` hardly depends on \
                 the seed: they do not show that no other result exists.",
                self.subject.method
            );
            self.findings.push(Finding::new(FindingKind::Search, sentence));
        } else if 2 * as_good < count {
            let sentence = format!(
                "Only {as_good} of {count} searches with different seeds found the best objective: \
                 further ones may find a better one. Use more individuals or generations."
            );
            self.findings.push(Finding::new(FindingKind::Search, sentence));
        }
    }

    /// `searches.csv`: one line for each search.
    pub fn searches_csv(&self) -> String {
        let mut text = String::from("search,seed,objective,as_good,generations,evaluations");
        let names = self.parameters.iter().map(|parameter| quoted(&parameter.name));
        names.for_each(|name| text += &format!(",{name}"));
        text.push('\n');
        for (k, own) in self.outcome.searches.iter().enumerate() {
            let seed = own.seed.map(|entry| entry.to_string()).join(" ");
            // Writing into a String cannot fail.
            _ = write!(text, "{},{seed},{:e},{}", k + 1, own.objective, own.as_good);
            _ = write!(text, ",{},{}", own.generations, own.evaluations);
            let missing = self.parameters.len() - own.values.len().min(self.parameters.len());
            own.values.iter().for_each(|value| text += &format!(",{value}"));
            text += &",".repeat(missing);
            text.push('\n');
        }
        text
    }
}
