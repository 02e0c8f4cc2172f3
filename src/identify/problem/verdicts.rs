//! The verdict on each parameter. It is made here alone, and everything that is said of a parameter
//! follows it: the sentences, the table, the page, the files.
//!
//! A parameter is identifiable where these data end its 95 % interval on both sides, within the
//! search range, and on a logarithmic scale within a factor of ten. The linear interval decides where
//! it holds: it lies within the range, the sum of squares at its ends, the others fitted again, has
//! risen by what the linear model says, and no other minimum fits as well.
//! Everywhere else its profile likelihood decides: at an end of the range, where a linear interval
//! would leave the range, where there is no standard error, where the model is curved. What a
//! budget of simulations does not allow is not said.
//!
//! References: [Bates & Watts 1988](gapilib_base::bibliography#bates-watts-1988), chapter 6;
//! [Raue et al. 2009](gapilib_base::bibliography#raue-2009).

use super::effects::{Effect, Finite};
use super::grounds::Grounds;
use super::non_identifiable::Form;
use super::profile::{Known, Profile, RangeEnd, profiles};
use super::{Free, Run, Solution, SolvedParameter, Statistics, Verdict};
use crate::diag::Fault;
use crate::elementary;
use crate::ga::optimizer::FROM_THE_SOLVER;

/// The interval of a parameter at an end of its range is as long as that of the linear model, within this
/// factor.
const FACTOR: f64 = 2.0;
/// Intervals whose ends differ by less than this part of their width are the same.
const SAME: f64 = 0.1;
/// Fits along a profile begin at other ends of descents, too, whose sums of squares have risen by this
/// many times the rise within the limit: those farther up hardly become the least.
const NEARBY: f64 = 10.0;
/// Where the logarithm of a parameter is searched, an interval wider than this factor says no more than
/// its order of magnitude.
const DECADE: f64 = 10.0;
/// Simulations that the profiles of a verdict may take: so many times those of the search, and at least
/// so many. A profile takes about 12 fits, each of 3 Jacobians or so. Formulas cost next to nothing.
const OF_SEARCH: u64 = 2;
const BUDGET: u64 = 1500;
const BUDGET_OF_FORMULAS: u64 = 100_000;

/// How a parameter was judged.
#[derive(Debug, Clone, PartialEq)]
pub enum Judged {
    /// By its standard error.
    Linear,
    /// By finite changes, for there is no derivative to go by; or not at all, as it has no effect.
    Effect,
    /// As a member of a group that no data of this kind tell apart.
    Group,
    /// By its profile.
    Profile(ByProfile),
    /// As a fit without residuals: by the rank of the sensitivities.
    Exact,
    /// Not at all: this many simulations were missing.
    Budget(u64),
    /// Not at all: the user or a limit has ended the statistics.
    Stopped,
    /// Not at all: the profile ends at this value, beyond which nothing can be simulated.
    Cut(f64),
    /// Not at all, as there is nothing to judge by.
    Nothing,
}

/// What a profile has shown.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ByProfile {
    /// The linear interval that does not hold; `None` where there is none, or it does.
    pub linear: Option<[f64; 2]>,
    /// How far the optimum lies beyond the end at which the parameter stands, in standard errors, and
    /// how far it may within the 95 % limit, where the linear model is true of that.
    pub pull: Option<[f64; 2]>,
    /// Whether the objective still falls at the end at which the parameter stands.
    pub falls: bool,
}

impl Solution {
    /// Judges all parameters at a minimum.
    ///
    /// # Errors
    ///
    /// Those of least squares.
    pub(super) fn judge(
        &mut self,
        run: &Run,
        statistics: &Statistics,
        effects: &[(usize, Effect)],
    ) -> Result<Vec<Judged>, Fault> {
        let n = self.parameters.len();
        (self.grounds.freedom, self.grounds.quantile) =
            (statistics.spread.freedom, statistics.quantile_of_squares());
        if statistics.uncertainty.is_none() {
            return Ok(vec![Judged::Nothing; n]);
        }
        let linear: Vec<Option<[f64; 2]>> = (0..n)
            .map(|k| linear_with(effects, &run.problem.parameters[k], k, self, statistics))
            .collect();
        let mut judged: Vec<Judged> =
            (0..n).map(|k| self.judge_first(k, linear[k], statistics, effects)).collect();
        let pull = |k: usize| statistics.pull(k).zip(statistics.reach(k));
        let Grounds { freedom, quantile, .. } = self.grounds;
        let pulls = (0..n).map(pull).collect();
        let flat = self.flat(statistics);
        let groups = statistics.rank.non_identifiable.iter();
        let groups = groups.map(|group| group.parameters.clone()).collect();
        let known = Grounds::default();
        self.grounds = Grounds { pulls, linear, flat, groups, freedom, quantile, ..known };
        if is_without_noise(run, statistics) {
            self.judge_by_rank(&mut judged);
            return Ok(judged);
        }
        let open = self.doubtful(run, statistics, &judged)?;
        self.judge_by_profiles(run, statistics, (&open, &mut judged))?;
        Ok(judged)
    }

    /// Which parameters have a derivative that vanishes, so that its standard error exceeds the range.
    fn flat(&self, statistics: &Statistics) -> Vec<bool> {
        let deviations = statistics.uncertainty.iter().flat_map(|own| &own.standard_deviations);
        let pairs = self.parameters.iter().zip(deviations);
        let exceeds = |(own, deviation): (&SolvedParameter, &f64)| {
            deviation.is_nan() || *deviation >= own.range[1] - own.range[0]
        };
        pairs.map(exceeds).collect()
    }

    /// What needs no profile, and the linear interval of all others.
    fn judge_first(
        &mut self,
        k: usize,
        linear: Option<[f64; 2]>,
        statistics: &Statistics,
        effects: &[(usize, Effect)],
    ) -> Judged {
        let own = &mut self.parameters[k];
        if let Some((_, effect)) = effects.iter().find(|(place, _)| *place == k) {
            match effect {
                Effect::None if statistics.is_made_up_for(k) => {
                    own.verdict = Some(Verdict::StructurallyNonIdentifiable);
                }
                Effect::None => own.verdict = Some(Verdict::WithoutEffect),
                Effect::Finite(Finite { ends, .. }) => own.take(*ends),
            }
            own.determined = own.verdict.map(|verdict| verdict == Verdict::Identifiable);
            return Judged::Effect;
        }
        let in_group = |form: &Form| matches!(form, Form::Sum | Form::Product | Form::Function);
        let mut groups = statistics.rank.non_identifiable.iter();
        if groups.any(|group| in_group(&group.form) && group.parameters.contains(&k)) {
            own.verdict = Some(Verdict::StructurallyNonIdentifiable);
            own.determined = Some(false);
            // What rounding leaves of a singular matrix is not a standard error.
            own.deviation = None;
            return Judged::Group;
        }
        let within = |(end, range): (&f64, &f64)| (end - range).abs() > 0.0;
        let inside = linear.filter(|ends| {
            own.range[0] <= ends[0]
                && ends[1] <= own.range[1]
                && ends.iter().zip(&own.range).all(within)
        });
        own.take(inside.map_or([None; 2], |ends| ends.map(Some)));
        if inside.is_none() {
            own.interval = linear.map(|ends| ends.map(|end| end.clamp(own.range[0], own.range[1])));
        }
        Judged::Linear
    }

    /// A fit without residuals has neither intervals nor standard errors: what the rank says is true.
    fn judge_by_rank(&mut self, judged: &mut [Judged]) {
        for (own, judged) in self.parameters.iter_mut().zip(judged) {
            if *judged == Judged::Linear {
                own.verdict = own.deviation.map(|_| Verdict::Identifiable);
                own.determined = own.verdict.map(|_| true);
            }
            *judged = Judged::Exact;
            (own.interval, own.deviation, own.open) = (None, None, [false; 2]);
        }
        self.correlations = None;
    }

    /// Parameters whose linear interval does not decide.
    fn doubtful(
        &mut self,
        run: &Run,
        statistics: &Statistics,
        judged: &[Judged],
    ) -> Result<Vec<usize>, Fault> {
        let in_steps =
            judged.contains(&Judged::Effect) && self.parameters.iter().any(|own| own.in_steps);
        if in_steps {
            // Fits along a profile do not leave the step on which they begin.
            return Ok(Vec::new());
        }
        let is_open = |k: usize| judged[k] == Judged::Linear;
        let (sure, mut doubtful): (Vec<usize>, Vec<usize>) =
            (0..judged.len()).filter(|k| is_open(*k)).partition(|&k| {
                self.parameters[k].verdict == Some(Verdict::Identifiable)
                    && statistics.inward[k].is_none()
                    && !run.conclusion.held.contains(&k)
                    && !self.is_elsewhere(k)
            });
        doubtful.extend(self.curved(run, statistics, &sure)?);
        doubtful.sort_unstable();
        Ok(doubtful)
    }

    /// Whether another minimum that fits as well lies outside a linear interval.
    fn is_elsewhere(&self, k: usize) -> bool {
        let Some([low, high]) = self.grounds.linear[k] else { return true };
        self.outcome.other_minima.iter().any(|other| !(low..=high).contains(&other.values[k]))
    }

    /// Simulations that the profiles of a verdict may take, and the fits at the ends of linear intervals.
    pub(super) fn budget(run: &Run) -> u64 {
        match run.problem.noise <= super::NOISE_OF_FORMULAS {
            true => BUDGET_OF_FORMULAS,
            false => BUDGET.max(OF_SEARCH * run.simulations),
        }
    }

    /// Takes the profiles of these parameters.
    fn judge_by_profiles(
        &mut self,
        run: &Run,
        statistics: &Statistics,
        (open, judged): (&[usize], &mut [Judged]),
    ) -> Result<(), Fault> {
        if open.is_empty() {
            return Ok(());
        }
        let values: Vec<f64> = self.parameters.iter().map(|own| own.value).collect();
        let reach = self.linear_reach(run);
        let square = statistics.searched;
        let rise = statistics.limit_of_squares() - square;
        let others = self.other_places(square + NEARBY * rise);
        let budget = Solution::budget(run);
        let known = Known {
            best: &values,
            reach: &reach,
            others: &others,
            is_shared: false,
            freedom: self.grounds.freedom,
            quantile: self.grounds.quantile,
            budget,
        };
        let can_be_made = statistics.spread.freedom >= 1.0 && statistics.repeated.is_empty();
        let found = match can_be_made {
            true => profiles(&run.problem, &run.evaluation, &known, open)?,
            false => None,
        };
        let Some(found) = found else {
            for &k in open {
                self.parameters[k].forget();
                judged[k] = Judged::Nothing;
            }
            return Ok(());
        };
        self.effort.simulations_for_statistics += found.simulations;
        self.grounds.better = found.better;
        for (&k, profile) in open.iter().zip(found.profiles) {
            judged[k] = match run.evaluation.is_cancelled() && profile.complete != [true; 2] {
                true => Judged::Stopped,
                false => self.adopt(k, &profile, budget),
            };
            if judged[k] == Judged::Stopped {
                self.parameters[k].forget();
            }
            if profile.complete == [true; 2] {
                self.grounds.profiles.push((k, profile));
            }
        }
        Ok(())
    }

    /// Takes what the profile of a parameter shows, which was made with this budget.
    pub(super) fn adopt(&mut self, k: usize, profile: &Profile, budget: u64) -> Judged {
        self.parameters[k].held = [0, 1].map(|side| self.ending_ranges(k, &profile.held[side]));
        let Grounds { linear, pulls, quantile, .. } = &self.grounds;
        let pull = pulls[k].map(|(pull, reach)| ([pull, *quantile], reach));
        let judged = self.parameters[k].adopt(profile, linear[k], pull, budget);
        let own = &self.parameters[k];
        // Among parameters whose changes cancel, it is the ranges that bound each.
        let is_of_group = own.held.iter().flatten().any(|end| self.are_members(k, &end.parameter));
        if is_of_group && own.verdict == Some(Verdict::Identifiable) {
            self.parameters[k].verdict = Some(Verdict::PracticallyNonIdentifiable);
            self.parameters[k].determined = Some(false);
        }
        judged
    }

    /// The ranges of others that end the interval of parameter `k` where they stand at these ends. Where
    /// another stands at an end at the best values, too, what is said of that one says that the others
    /// hold there; not in a group whose changes cancel, in which every interval is made by the ranges.
    fn ending_ranges(&self, k: usize, held: &[RangeEnd]) -> Vec<RangeEnd> {
        let ends = |own: &&RangeEnd| {
            let found = self.parameters.iter().find(|other| other.name == own.parameter);
            found.is_some_and(|other| !other.at_bound) || self.are_members(k, &own.parameter)
        };
        held.iter().filter(ends).cloned().collect()
    }

    /// Whether the changes of parameter `k` and another one cancel in a group.
    fn are_members(&self, k: usize, other: &str) -> bool {
        let place = self.parameters.iter().position(|own| own.name == other);
        let mut groups = self.grounds.groups.iter();
        place.is_some_and(|j| groups.any(|group| group.contains(&j) && group.contains(&k)))
    }
}

impl SolvedParameter {
    /// Whether the interval says more than an order of magnitude.
    pub(super) fn is_precise(&self) -> bool {
        let [low, high] = self.interval.unwrap_or(self.range);
        !self.logarithmic || (high / low).max(low / high) <= DECADE
    }

    /// Takes the ends of the values that these data admit; `None` where the range ends before.
    fn take(&mut self, ends: [Option<f64>; 2]) {
        let [low, high] = ends;
        self.interval = Some([low.unwrap_or(self.range[0]), high.unwrap_or(self.range[1])]);
        self.open = [low.is_none(), high.is_none()];
        let is_bounded = self.open == [false; 2] && self.is_precise();
        self.determined = Some(is_bounded);
        self.verdict = Some(match is_bounded {
            true => Verdict::Identifiable,
            false => Verdict::PracticallyNonIdentifiable,
        });
    }

    /// Says nothing of what the data tell.
    pub fn forget(&mut self) {
        (self.interval, self.open, self.pieces) = (None, [false; 2], Vec::new());
        self.held = [Vec::new(), Vec::new()];
        (self.verdict, self.determined) = (None, None);
    }

    /// Takes what its profile shows. `pull` and the linear reach to both sides, where it stands at an
    /// end of its range.
    fn adopt(
        &mut self,
        profile: &Profile,
        linear: Option<[f64; 2]>,
        pull: Option<([f64; 2], [f64; 2])>,
        budget: u64,
    ) -> Judged {
        let [min, max] = self.range;
        if let [Some(cut), _] | [_, Some(cut)] = profile.cut {
            let holds = linear.is_some_and(|[low, high]| min < low && high < max);
            if holds {
                self.held = [Vec::new(), Vec::new()];
                return Judged::Linear;
            }
            self.forget();
            return Judged::Cut(cut);
        }
        if profile.complete != [true; 2] {
            self.forget();
            return Judged::Budget(budget);
        }
        let inner = |reach: [f64; 2]| match profile.interval {
            [None, Some(high)] => (high - self.value) / reach[1],
            [Some(low), None] => (self.value - low) / reach[0],
            _ => f64::INFINITY,
        };
        let falls = pull.is_some_and(|([pull, limit], _)| pull > limit);
        let is_linear = |reach| (FACTOR.recip()..=FACTOR).contains(&inner(reach));
        let beyond = pull.filter(|(_, reach)| falls && is_linear(*reach)).map(|(pull, _)| pull);
        if let Some(pull) = beyond {
            self.forget();
            return Judged::Profile(ByProfile { linear: None, pull: Some(pull), falls });
        }
        self.take(profile.interval);
        let [low, high] = self.interval.unwrap_or(self.range);
        let whole = |ends: &[Option<f64>; 2]| [ends[0].unwrap_or(min), ends[1].unwrap_or(max)];
        self.pieces = profile.pieces.iter().map(whole).collect();
        if !self.pieces.is_empty() {
            self.pieces.push([low, high]);
            self.pieces.sort_by(|a, b| a[0].total_cmp(&b[0]));
        }
        // Where a derivative vanishes, the standard error is one of rounding.
        self.deviation = self.deviation.filter(|own| *own < max - min);
        let is_same = |a: f64, b: f64| (a - b).abs() <= SAME * (high - low);
        let linear = linear.filter(|ends| !(is_same(ends[0], low) && is_same(ends[1], high)));
        self.by_profile = true;
        Judged::Profile(ByProfile { linear, pull: None, falls })
    }
}

impl Solution {
    /// How far linear intervals reach, as fractions of the ranges.
    pub(super) fn linear_reach(&self, run: &Run) -> Vec<Option<f64>> {
        let reach = |(k, free): (usize, &Free)| {
            let [low, high] = (*self.grounds.linear.get(k)?)?;
            let is_logarithmic = free.logarithmic && low * high > 0.0;
            let length = |a: f64, b: f64| match is_logarithmic {
                true => elementary::ln(b / a).abs(),
                false => b - a,
            };
            Some(0.5 * length(low, high) / length(free.min, free.max))
        };
        let all = run.problem.parameters.iter().enumerate().map(reach);
        all.map(|reach| reach.filter(|own| own.is_finite() && *own > 0.0)).collect()
    }
}

/// The linear interval, over all values of other parameters that act without a derivative: what is
/// true of one step need not be of the next, which fits these data as well.
fn linear_with(
    effects: &[(usize, Effect)],
    free: &Free,
    k: usize,
    solution: &Solution,
    statistics: &Statistics,
) -> Option<[f64; 2]> {
    let mut hull = linear_interval(free, solution.parameters[k].value, statistics.reach(k))?;
    for (_, effect) in effects {
        let Effect::Finite(finite) = effect else { continue };
        for fit in &finite.within {
            let half = statistics.spread.quantile * fit.left * fit.deviations[k];
            let [low, high] = linear_interval(free, fit.values[k], Some([half; 2]))?;
            hull = [hull[0].min(low), hull[1].max(high)];
        }
    }
    Some(hull)
}

/// The interval that reaches so far; where the logarithm is searched, it is one of ratios. Not cut
/// at the range.
fn linear_interval(free: &Free, value: f64, reach: Option<[f64; 2]>) -> Option<[f64; 2]> {
    let [below, above] = reach?;
    let ends = match free.logarithmic {
        true => {
            let [a, b] = [-below, above].map(|reach| value * elementary::exp(reach / value));
            [a.min(b), a.max(b)]
        }
        false => [value - below, value + above],
    };
    Some(ends).filter(|ends| ends.iter().all(|end| end.is_finite()))
}

/// Whether the residuals may be those of the solver, which tell nothing of intervals.
fn is_without_noise(run: &Run, statistics: &Statistics) -> bool {
    let measured = run.problem.series.iter().flat_map(|series| &series.y);
    let size: f64 =
        measured.zip(&statistics.weights).map(|(y, w)| elementary::powi(w * y, 2)).sum();
    let square: f64 = statistics.residuals.iter().map(|r| r * r).sum();
    let is_from_solver = square.sqrt() <= FROM_THE_SOLVER * run.problem.noise * size.sqrt();
    is_from_solver && !statistics.spread.believed && !run.conclusion.resolved
}
