//! Descents of least squares from several starts: how each ended, which of them reached the same
//! minimum, and whether further starts are worth their cost.
//!
//! Reference: [Boender & Rinnooy Kan 1987](gapilib_base::bibliography#boender-rinnooy-kan-1987): where n
//! descents have ended in w different minima, the part of the search space whose descents end in minima
//! not yet seen is expected to be w (w + 1) / (n (n − 1)).

use super::levenberg_marquardt::{Accuracy, COARSE, Descent, FINE};
use super::{Answers, DescentEnd, DescentReport, Required};
use crate::elementary;
use crate::ga::Genomes;

/// Descents from different starts that must agree before a search ends early.
const AGREEING: usize = 3;
/// So many where the best minimum stands at a bound.
const AGREEING_AT_BOUND: usize = 8;
/// So many where it fits badly. All descents may end beside a good minimum with a small basin:
/// oscillations that none has found are fitted best by a slow drift. With 8 one of 20 seeds ends there
/// on the populations of lynx and hare (`every_seed_reaches_the_best_of_several_minima`).
const AGREEING_IF_BAD: usize = 12;
/// So many where none of them ended at a minimum by its gradient: at a kink, on a flat part, within the
/// errors of the simulation.
const UNTESTED: usize = 8;
/// A minimum that leaves more than this part of the squares of the measured values fits badly.
const BAD: f64 = 0.1;
/// Descents of which the best minimum must be the end at least, and the expected part of the search
/// space that leads to minima not yet seen, above which a search continues: one minimum needs 5
/// descents, two need 5, three 7, four 9, ten 20.
pub(crate) const FEWEST: usize = 5;
const UNSEEN: f64 = 0.3;
/// Where the best of so many descents has ended at no minimum, and the last ones, half of all but so many
/// at least, have not improved on it by this part, further ones will not come to one either: derivatives
/// vanish or jump there, or a constraint is in the way.
const STUCK: usize = 30;
const LAST: usize = 15;
const IMPROVED: f64 = 1e-3;
/// The genetic search continues where one in this many descents or fewer have reached the best
/// minimum.
const SELDOM: usize = 5;
/// Steps of a descent in one round; most of the problems of NIST need fewer.
const STEPS: usize = 40;
/// So many descents whose steps were used up are continued in each round, those first that promise most: in
/// long valleys the best one at the time may lead to a worse minimum than others. Continuing the best three,
/// Brannmark_JBC2010 ended 3.4 above its published minimum, which is found so.
const CONTINUED: usize = 3;
/// Steps to make the best minimum finer.
const FINE_STEPS: usize = 100;
/// Individuals nearer than this in every gene are the same start.
const DISTINCT: f64 = 0.05;

/// All descents of a search; those of a round are asked together, trials first, then Jacobians. A
/// descent ends as soon as it is on the way to a minimum that another one has reached.
pub(crate) struct Pool {
    descents: Vec<Descent>,
    /// The descent that had reached the minimum to which each leads.
    joined: Vec<Option<usize>>,
    /// Whether each began at a point that owes nothing to other descents.
    independent: Vec<bool>,
    active: Vec<usize>,
    /// Individuals that each of the active ones asked in the last question.
    shares: Vec<usize>,
    required: Required,
    accuracy: Accuracy,
    /// How far a short step may move each gene.
    reach: Vec<f64>,
    /// Descents and the smallest sum of squares at the begin of each round.
    rounds: Vec<(usize, f64)>,
    /// The sum of squares of each descent where it was continued last.
    continued: Vec<f64>,
}

impl Pool {
    pub(crate) fn new(accuracy: Accuracy, reach: Vec<f64>) -> Pool {
        Pool {
            descents: Vec::new(),
            joined: Vec::new(),
            independent: Vec::new(),
            active: Vec::new(),
            shares: Vec::new(),
            required: Required::Jacobians,
            accuracy,
            reach,
            rounds: Vec::new(),
            continued: Vec::new(),
        }
    }

    /// Begins a round: descends from these starts, continues with the best of the descents whose
    /// steps were used up, and refines the best minimum. The first `independent` starts owe
    /// nothing to earlier descents; descents from the last `short` ones have short steps.
    pub(crate) fn begin(&mut self, starts: Vec<Vec<f64>>, [independent, short]: [usize; 2]) {
        self.active.clear();
        self.rounds.push((self.descents.len(), self.smallest()));
        for open in self.open() {
            self.continued[open] = self.descents[open].sum();
            self.descents[open].grant(STEPS, COARSE);
            self.active.push(open);
        }
        self.refine();
        let first_short = starts.len() - short;
        for (number, start) in starts.into_iter().enumerate() {
            let is_short = number >= first_short;
            let place = self.descents.len();
            self.active.push(place);
            let own = Descent::new(start, self.accuracy, STEPS, COARSE);
            self.descents.push(if is_short { own.within(&self.reach) } else { own });
            self.joined.push(None);
            self.continued.push(f64::INFINITY);
            self.independent.push(number < independent);
        }
        self.shares = vec![0; self.active.len()];
    }

    /// Of the descents whose steps were used up, those that lead farthest if they go on as they did.
    fn open(&self) -> Vec<usize> {
        let sum = |k: &usize| self.descents[*k].sum();
        let is_open = |k: &usize| !self.descents[*k].has_ended() && sum(k).is_finite();
        let mut open: Vec<usize> = (0..self.descents.len()).filter(is_open).collect();
        let next = |k: &usize| sum(k) * (sum(k) / self.continued[*k]);
        open.sort_by(|a, b| next(a).total_cmp(&next(b)).then(sum(a).total_cmp(&sum(b))));
        open.truncate(CONTINUED);
        open
    }

    /// Whether short steps are shorter than a range.
    pub(crate) fn has_short_steps(&self) -> bool {
        self.reach.iter().any(|reach| *reach < 1.0)
    }

    /// Continues with the best descent where it can come nearer to its minimum.
    fn refine(&mut self) {
        if let Some(best) = self.best().filter(|best| self.descents[*best].can_be_refined()) {
            self.descents[best].grant(FINE_STEPS, FINE);
            self.active.push(best);
        }
    }

    /// Continues with the best minimum alone; whether there is anything to do.
    pub(crate) fn finish(&mut self) -> bool {
        self.active.clear();
        self.refine();
        self.shares = vec![0; self.active.len()];
        !self.active.is_empty()
    }

    /// Asks for the next individuals; without any the round is over.
    pub(crate) fn ask(&mut self, batch: &mut Genomes) {
        for required in [Required::Residuals, Required::Jacobians] {
            self.required = required;
            for (&k, share) in self.active.iter().zip(&mut self.shares) {
                let before = batch.len();
                if self.descents[k].required_now() == required {
                    self.descents[k].ask_next(batch);
                }
                *share = batch.len() - before;
            }
            if !batch.is_empty() {
                return;
            }
        }
        self.active.clear();
    }

    pub(crate) fn required(&self) -> Required {
        self.required
    }

    pub(crate) fn tell(&mut self, count: usize, answers: &Answers<'_>) {
        let mut first = 0;
        for (&k, &share) in self.active.iter().zip(&self.shares) {
            if share > 0 {
                self.descents[k].take(&answers.part(first, first + share, count));
                first += share;
            }
        }
        self.join();
    }

    /// Ends the descents that lead to known minima.
    fn join(&mut self) {
        for k in self.active.clone() {
            if !self.descents[k].has_moved() {
                continue;
            }
            let leads = |other: &Descent| self.descents[k].leads_to(other);
            let known = self.descents.iter().position(leads);
            if known.is_some() {
                self.descents[k].join();
                self.joined[k] = known;
            }
        }
    }

    /// Forgets everything, as the ranges have changed.
    pub(crate) fn clear(&mut self) {
        *self = Pool::new(self.accuracy, std::mem::take(&mut self.reach));
    }

    /// The descent with the smallest sum of squares.
    fn best(&self) -> Option<usize> {
        let sum = |k: &usize| self.descents[*k].sum();
        let all = (0..self.descents.len()).filter(|k| sum(k).is_finite());
        all.min_by(|a, b| sum(a).total_cmp(&sum(b)))
    }

    /// Where the best descent stands.
    pub(crate) fn best_place(&self) -> Option<&[f64]> {
        self.best().map(|best| self.descents[best].places()[1])
    }

    /// The smallest sum of squares.
    pub(crate) fn smallest(&self) -> f64 {
        self.best().map_or(f64::INFINITY, |best| self.descents[best].sum())
    }

    /// The number of descents.
    pub(crate) fn count(&self) -> usize {
        self.descents.len()
    }

    /// Whether a place is far from where descents have started and where they stand.
    pub(crate) fn is_new(&self, genome: &[f64]) -> bool {
        self.descents.iter().flat_map(Descent::places).all(|known| is_far(known, genome))
    }

    /// Moves up to `count` of the candidates, best first, to the starts: those that are new, and those
    /// that are better than all descents. Candidates that are neither are left out.
    pub(crate) fn choose(
        &self,
        candidates: &mut Vec<(Vec<f64>, f64)>,
        count: usize,
        starts: &mut Vec<Vec<f64>>,
    ) {
        let full = starts.len() + count;
        let smallest = self.smallest();
        candidates.retain(|(genome, fitness)| {
            if starts.len() >= full {
                return true;
            }
            let is_fresh = self.is_new(genome) && starts.iter().all(|known| is_far(known, genome));
            if is_fresh || *fitness < smallest {
                starts.push(genome.clone());
            }
            false
        });
    }

    /// The number of the end of each descent, in the order of the sums of squares.
    fn groups(&self) -> Vec<usize> {
        let mut order: Vec<usize> = (0..self.descents.len()).collect();
        order.sort_by(|a, b| self.descents[*a].sum().total_cmp(&self.descents[*b].sum()));
        let mut groups = vec![0; order.len()];
        let mut first: Vec<usize> = Vec::new();
        for k in order {
            if self.joined[k].is_some() {
                continue;
            }
            let known = first.iter().position(|&one| self.descents[one].agrees(&self.descents[k]));
            groups[k] = known.unwrap_or(first.len());
            if known.is_none() {
                first.push(k);
            }
        }
        for (k, joined) in self.joined.iter().enumerate() {
            if let Some(other) = *joined {
                groups[k] = groups[other];
            }
        }
        groups
    }

    /// Whether further descents are not worth their cost: the best minimum was reached often enough,
    /// and few others can be expected; or none comes to a minimum.
    pub(crate) fn is_enough(&self) -> bool {
        self.is_reached_often() || self.is_stuck()
    }

    fn is_stuck(&self) -> bool {
        let Some(best) = self.best().map(|best| &self.descents[best]) else { return false };
        let count = self.descents.len();
        let last = LAST.max(count / 2);
        let before = self.rounds.iter().rfind(|(begun, _)| begun + last <= count);
        let is_better = |sum: f64| best.sum() < (1.0 - IMPROVED) * sum;
        let has_ended = best.has_ended() && best.report().ending != DescentEnd::Minimum;
        has_ended && count >= STUCK && before.is_some_and(|(_, sum)| !is_better(*sum))
    }

    fn is_reached_often(&self) -> bool {
        // Descents that start beside others are not evidence.
        let all = self.reports().into_iter().zip(&self.independent);
        let reports: Vec<DescentReport> =
            all.filter(|(_, independent)| **independent).map(|(report, _)| report).collect();
        let reached = reached(&reports);
        // Where the gradient does not show the minimum, the steps of a descent end there, too.
        let is_there = |report: &&DescentReport| reached == 0 && report.group == 0;
        let ended = reports.iter().filter(|report| match report.ending {
            DescentEnd::Failed => false,
            DescentEnd::StepLimit => is_there(report),
            _ => true,
        });
        let n = ended.clone().count();
        let mut different: Vec<usize> = ended.map(|report| report.group).collect();
        different.sort_unstable();
        different.dedup();
        let agreeing = self.agreeing();
        let agree = match reached {
            0 => {
                let has_ended = self.best().is_some_and(|best| self.descents[best].has_ended());
                has_ended && reports.iter().filter(is_there).count() >= agreeing.max(UNTESTED)
            }
            count => count >= agreeing,
        };
        let (of, w) = (n as f64, different.len() as f64);
        agree && n >= FEWEST && w * (w + 1.0) <= UNSEEN * of * (of - 1.0)
    }

    /// Whether descents alone do not get on: most of them have not ended at minima, the best minimum was
    /// reached by one in five of them or fewer, or it fits badly while others were reached. A bad fit to
    /// which all descents lead is a matter of the model or of the data.
    pub(crate) fn is_doubtful(&self) -> bool {
        let reports = self.reports();
        let at_minima = reports.iter().filter(|report| report.ending.is_at_minimum()).count();
        let is_other =
            |report: &DescentReport| report.group > 0 && report.ending != DescentEnd::Failed;
        self.fits_badly() && reports.iter().any(is_other)
            || 2 * at_minima < reports.len()
            || SELDOM * reached(&reports) <= reports.len()
    }

    /// Whether the best of the descents leaves much of the measured values.
    pub(crate) fn fits_badly(&self) -> bool {
        self.smallest() > BAD * elementary::powi(self.accuracy.size, 2)
    }

    /// How many descents must agree on the best minimum.
    fn agreeing(&self) -> usize {
        match self.best().map(|best| self.descents[best].is_held()) {
            Some(_) if self.fits_badly() => AGREEING_IF_BAD,
            Some(true) => AGREEING_AT_BOUND,
            _ => AGREEING,
        }
    }

    pub(crate) fn reports(&self) -> Vec<DescentReport> {
        let groups = self.groups();
        let report = |(k, group): (usize, usize)| {
            let own = self.descents[k].report();
            let Some(other) = self.joined[k] else { return DescentReport { group, ..own } };
            let DescentReport { end, objective, offset, .. } = self.descents[other].report();
            DescentReport { end, objective, offset, group, ..own }
        };
        groups.into_iter().enumerate().map(report).collect()
    }
}

/// Whether two places differ by more than the same start does.
pub(crate) fn is_far(a: &[f64], b: &[f64]) -> bool {
    a.iter().zip(b).any(|(a, b)| (a - b).abs() > DISTINCT)
}

/// Descents that ended at the best minimum; 0 where the best is none.
pub fn reached(reports: &[DescentReport]) -> usize {
    reports.iter().filter(|report| report.group == 0 && report.ending.is_at_minimum()).count()
}
