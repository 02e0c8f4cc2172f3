//! Profile likelihoods: one parameter held at values about its best, the others fitted again by
//! least squares. The values whose sum of squares stays below a limit are its 95 % interval, also
//! where the model is far from linear:
//!
//! ```text
//! S(p) < S_min (1 + t² / (points − parameters)),  t the 97.5 % quantile of Student's distribution
//! ```
//!
//! Reference: [Walter & Pronzato 1997](gapilib_base::bibliography#walter-pronzato-1997), §5.

use super::refit::Refit;
use super::statistics::distributions::{chi_square_quantile, student_quantile};
use super::{ErrorModel, Evaluation, Free, Problem};
use crate::diag::Fault;
use crate::fitness::raised;
use crate::registry::BAD_OPTION;
use crate::table::significant;
use crate::{bail, elementary};
use serde::{Deserialize, Serialize};

/// Values on each side of the best: from the smallest first step they come to the end of the range.
const SIDE: usize = 64;
/// The first step, as a part of the half-width of the linear interval; each next one is larger by the
/// first factor, and by the second once a linear interval would have ended long ago.
const FIRST: f64 = 0.3;
const GROWTH: [f64; 2] = [1.4, 2.5];
/// Steps of the first growth: together they are 15 times the half-width.
const NEARBY: usize = 9;
/// Limits of the first step, as a fraction of the range.
const STEPS: [f64; 2] = [1e-14, 0.02];
/// Fits that locate a crossing, and those where the sum of squares jumps across the limit, as it
/// does where something acts in steps.
const CROSSING: usize = 10;
const JUMPING: usize = 30;
/// A rise of this part of that to the limit between neighbours is a jump.
const JUMP: f64 = 0.2;
/// Places nearer than this in the range, or than this part of the bracket, are the same.
const SAME: f64 = 1e-7;
const SAME_OF_BRACKET: f64 = 1e-4;
/// The sum of squares is this near to the limit at the crossing, relative to its rise.
const NEAR: f64 = 1e-3;
/// The range of another parameter ends an interval where the sum at the end of the interval would rise by
/// more than this part of the rise to the limit if that range were narrower by this part: the interval
/// would then be shorter by a fortieth of its half-width or more. Ranges of rates and exchange currents
/// over decades are met by parameters that act no more there, and change nothing (six parameters of a
/// polarization curve).
const NARROWER: f64 = 0.1;
const WORSE: f64 = 0.05;
/// A fit that is better by more than this, relative, is another optimum.
const BETTER: f64 = 1e-6;

/// The profile of one parameter.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Profile {
    /// Its name.
    pub name: String,
    /// Values of the parameter, ascending, and the smallest sum of squares found there.
    pub points: Vec<[f64; 2]>,
    /// The sum of squares that the 95 % interval stays below.
    pub limit: f64,
    /// The ends of that interval about the best value; `None` where it reaches the end of the range,
    /// is cut, or was not found.
    pub interval: [Option<f64>; 2],
    /// Further parts of the 95 % set, about other minima.
    #[serde(default)]
    pub pieces: Vec<[Option<f64>; 2]>,
    /// Whether each end was looked for as far as the range goes: the budget of simulations may end
    /// before, or the user.
    #[serde(default = "both")]
    pub complete: [bool; 2],
    /// Values of all parameters at the points within the limit.
    #[serde(skip)]
    pub valley: Vec<Vec<f64>>,
    /// Where each end lies, which other parameters stand at ends of their ranges: these end the interval.
    #[serde(default)]
    pub(crate) held: [Vec<RangeEnd>; 2],
    /// The last values that could be simulated, where a constraint does not hold beyond or
    /// simulations fail: nothing is known from there on.
    #[serde(default)]
    pub cut: [Option<f64>; 2],
}

/// A parameter at an end of its range.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RangeEnd {
    /// Its name.
    pub parameter: String,
    /// That end.
    pub end: f64,
}

impl RangeEnd {
    /// Where that is, as in "c is at the end -10 of its search range".
    pub(super) fn words(all: &[RangeEnd]) -> String {
        let at =
            |own: &RangeEnd| format!("{} is at the end {}", own.parameter, significant(own.end, 4));
        let all: Vec<String> = all.iter().map(at).collect();
        let whose = if all.len() == 1 { "its search range" } else { "their search ranges" };
        format!("{} of {whose}", all.join(" and "))
    }
}

fn both() -> [bool; 2] {
    [true; 2]
}

/// All profiles.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Profiles {
    /// In the order of the parameters.
    pub profiles: Vec<Profile>,
    /// Simulations that they took.
    pub simulations: u64,
    /// Values with a smaller sum of squares, if the fits found such: the search had ended
    /// beside the best.
    pub better: Option<(Vec<f64>, f64)>,
}

/// What the profiles start from.
pub struct Known<'a> {
    /// The minimum.
    pub best: &'a [f64],
    /// Half-widths of the linear intervals where they are known, as fractions of the ranges.
    pub reach: &'a [Option<f64>],
    /// Other minima: fits begin there too before a value is said not to fit, and those that fit as
    /// well have pieces of their own.
    pub others: &'a [Vec<f64>],
    /// Degrees of freedom of the residual variance.
    pub freedom: f64,
    /// The root of the rise of the sum of squares within the 95 % limit, in units of that variance.
    pub quantile: f64,
    /// Simulations that all profiles together may take.
    pub budget: u64,
    /// Whether shards share the parameters among them.
    pub(crate) is_shared: bool,
}

/// The profile of one parameter with what it took.
#[derive(Serialize, Deserialize)]
struct One {
    profile: Profile,
    simulations: u64,
    better: Option<(Vec<f64>, f64)>,
}

/// Profiles of some parameters about the best values. `None` when the fitness is no sum of squares or
/// there are not more points than parameters.
///
/// # Errors
///
/// Those of the method's maker; `bad-option` where other shards have a part of them.
pub fn profiles(
    problem: &Problem,
    evaluation: &Evaluation,
    known: &Known<'_>,
    which: &[usize],
) -> Result<Option<Profiles>, Fault> {
    let Some(refit) = Refit::new(problem, evaluation).filter(|_| known.freedom >= 1.0) else {
        return Ok(None);
    };
    let mut walk = ProfileWalk::new(refit, known.budget);
    let Some((best, smallest)) = walk.refit.from(known.best, None)? else { return Ok(None) };
    let residuals = walk.refit.plain_residuals(&best);
    walk.limit = limit(problem, smallest, [known.freedom, known.quantile], residuals.as_deref());
    walk.rise = walk.limit - smallest;
    walk.starts.push(best.clone());
    walk.starts.extend(known.others.iter().cloned());
    let begun = walk.refit.simulations;
    let mut fault = None;
    let mut some = |places: &[usize]| -> Vec<One> {
        let one = |place: &usize| {
            let name = &problem.parameters[which[*place]].name;
            evaluation.show(&format!(
                "intervals: profile of {name}, {} of {}",
                place + 1,
                which.len()
            ));
            walk.one(which[*place], known, (&best, smallest))
        };
        let all: Result<Vec<One>, Fault> = places.iter().map(one).collect();
        all.unwrap_or_else(|failed| {
            fault = Some(failed);
            Vec::new()
        })
    };
    let every: Vec<usize> = (0..which.len()).collect();
    let all = match known.is_shared {
        true => evaluation.parts.all(("profiles", known.best), which.len(), some),
        false => Some(some(&every)),
    };
    if let Some(fault) = fault {
        return Err(fault);
    }
    let Some(all) = all else {
        bail!(
            BAD_OPTION,
            "Other shards compute the rest of the profile likelihoods: merge them with \
             `gapi report --merge`"
        );
    };
    Ok(Some(joined(all, begun, smallest)))
}

/// All profiles; `begun`: simulations before them.
fn joined(all: Vec<One>, begun: u64, smallest: f64) -> Profiles {
    let simulations = begun + all.iter().map(|one| one.simulations).sum::<u64>();
    let mut better: Option<(Vec<f64>, f64)> = None;
    let mut profiles = Vec::new();
    for one in all {
        profiles.push(one.profile);
        let is_better = |found: &(Vec<f64>, f64)| better.as_ref().is_none_or(|b| found.1 < b.1);
        if let Some(found) = one.better.filter(is_better) {
            better = Some(found);
        }
    }
    let better = better.filter(|(_, sum)| *sum < smallest * (1.0 - BETTER));
    Profiles { profiles, simulations, better }
}

/// The sum that the 95 % interval of one parameter stays below. Where sigma is known, S rises by
/// χ²; else the ratio of S to the smallest is compared, with Student's quantile, which for estimated
/// sigmas is the likelihood ratio as well, for S is n G with n ln G = -2 log L.
/// Robust sums rise by a factor of their own. `quantile`: that of the standard errors, which for
/// estimated sigmas has fewer degrees of freedom than the residuals.
pub fn limit(
    problem: &Problem,
    smallest: f64,
    [freedom, quantile]: [f64; 2],
    residuals: Option<&[f64]>,
) -> f64 {
    let fitness = problem.objectives.first().map(|(_, fitness)| fitness);
    let robust = fitness.zip(residuals).and_then(|(own, r)| own.robustness(r, freedom));
    if let Some(robust) = robust {
        return smallest
            + elementary::powi(robust.scale, 2)
                * robust.rise
                * elementary::powi(student_quantile(0.975, robust.freedom), 2);
    }
    match ErrorModel::of(problem) {
        ErrorModel::Known => smallest + chi_square_quantile(0.95, 1.0),
        // S is N G with N ln G = -2 log L.
        ErrorModel::Computed => {
            raised(smallest, problem.n_points() as f64, chi_square_quantile(0.95, 1.0))
        }
        ErrorModel::OneVariance => smallest * (1.0 + elementary::powi(quantile, 2) / freedom),
        ErrorModel::Estimated => {
            let points = problem.n_points() as f64;
            let rise = points * elementary::ln(1.0 + elementary::powi(quantile, 2) / freedom);
            raised(smallest, points, rise)
        }
    }
}

struct ProfileWalk<'a> {
    refit: Refit<'a>,
    limit: f64,
    /// The rise of the sum of squares to the limit.
    rise: f64,
    /// The last simulation of the budget.
    last: u64,
    better: Option<(Vec<f64>, f64)>,
    /// Where fits begin before a value is said not to fit.
    starts: Vec<Vec<f64>>,
    /// The last value before one that could not be simulated.
    cut: Option<f64>,
    /// Whether the budget was used up, or the simulations were cancelled.
    is_over: bool,
    /// Fits within the limit.
    valley: Vec<Vec<f64>>,
}

/// From where a fit begins.
#[derive(Clone, Copy, PartialEq)]
enum Care {
    /// From the neighbour's.
    OneStart,
    /// From all known minima as well, before a sum beyond the limit is believed: a descent may end
    /// beside the least.
    AllStarts,
}

/// What fits best where one parameter is held.
struct Fit {
    /// Where it is held, as a fraction of its range.
    place: f64,
    values: Vec<f64>,
    /// The sum of squares.
    sum: f64,
}

/// Where the sum of squares crosses the limit.
struct Crossing {
    /// As a fraction of the range.
    place: f64,
    /// Values of all parameters in the fit there, or in the last within the limit.
    values: Vec<f64>,
}

/// Connected values within the limit, as fractions of the range; `None` where it continues to the
/// end.
struct Piece {
    ends: [Option<f64>; 2],
    /// Other parameters that stand at ends of their ranges there.
    held: [Vec<RangeEnd>; 2],
    cut: [Option<f64>; 2],
    complete: [bool; 2],
}

impl Piece {
    fn contains(&self, place: f64) -> bool {
        self.ends[0].is_none_or(|low| place >= low - SAME)
            && self.ends[1].is_none_or(|high| place <= high + SAME)
    }
}

impl<'a> ProfileWalk<'a> {
    fn new(refit: Refit<'a>, budget: u64) -> ProfileWalk<'a> {
        ProfileWalk {
            refit,
            limit: 0.0,
            rise: 0.0,
            last: budget,
            better: None,
            starts: Vec::new(),
            cut: None,
            is_over: false,
            valley: Vec::new(),
        }
    }

    /// The profile of parameter `k` about the best values and their sum of squares.
    fn one(&mut self, k: usize, known: &Known<'_>, best: (&[f64], f64)) -> Result<One, Fault> {
        let free = self.refit.parameter(k).clone();
        let before = self.refit.simulations;
        self.better = None;
        self.valley = vec![best.0.to_vec()];
        let mut points = vec![[best.0[k], best.1]];
        let first = known.reach.get(k).copied().flatten();
        let first = first.map_or(STEPS[1], |reach| (FIRST * reach).clamp(STEPS[0], STEPS[1]));
        let own = self.piece(&free, k, best, first, &mut points)?;
        let others = self.pieces(&free, k, &own, first, &mut points)?;
        points.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let values = |piece: &Piece| piece.ends.map(|end| end.map(|place| free.value(place)));
        Ok(One {
            profile: Profile {
                name: free.name.clone(),
                points,
                limit: self.limit,
                interval: values(&own),
                pieces: others.iter().map(values).collect(),
                complete: own.complete,
                cut: own.cut,
                valley: std::mem::take(&mut self.valley),
                held: own.held,
            },
            simulations: self.refit.simulations - before,
            better: self.better.take(),
        })
    }

    /// Goes to both sides from a fit within the limit until it is crossed.
    fn piece(
        &mut self,
        free: &Free,
        k: usize,
        from: (&[f64], f64),
        first: f64,
        points: &mut Vec<[f64; 2]>,
    ) -> Result<Piece, Fault> {
        let mut piece = Piece {
            ends: [None; 2],
            held: [Vec::new(), Vec::new()],
            cut: [None; 2],
            complete: [true; 2],
        };
        for (side, step) in [-first, first].into_iter().enumerate() {
            let (place, values) = (free.fraction(from.0[k]), from.0.to_vec());
            let inside = Fit { place, values, sum: from.1 };
            if let Some(end) = self.until_crossing(free, k, inside, step, points)? {
                piece.ends[side] = Some(end.place);
                piece.held[side] = self.held(k, &end.values)?;
            }
            piece.cut[side] = self.cut.take();
            piece.complete[side] = !self.is_over;
        }
        Ok(piece)
    }

    /// The parameters other than `k` whose ranges end the interval here: they stand at an end of it, and with
    /// a narrower one the fit would be worse. Where others make up for a parameter, it can have any value,
    /// that end as well.
    fn held(&mut self, k: usize, values: &[f64]) -> Result<Vec<RangeEnd>, Fault> {
        let mut held = Vec::new();
        for (j, value) in values.iter().enumerate().filter(|(j, _)| *j != k) {
            let free = self.refit.parameter(j);
            let place = free.fraction(*value);
            let (end, narrower) = match (place <= SAME, 1.0 - place <= SAME) {
                (true, _) => (free.min, NARROWER),
                (_, true) => (free.max, 1.0 - NARROWER),
                _ => continue,
            };
            let mut start = values.to_vec();
            start[j] = free.value(narrower);
            let found = self.refit.roughly(&start, &[k, j])?;
            let is_worse = |(_, sum): &(Vec<f64>, f64)| sum - self.limit > WORSE * self.rise;
            if found.as_ref().is_none_or(is_worse) {
                held.push(RangeEnd { parameter: free.name.clone(), end });
            }
        }
        Ok(held)
    }

    /// The pieces about other minima that lie beside the own one.
    fn pieces(
        &mut self,
        free: &Free,
        k: usize,
        own: &Piece,
        first: f64,
        points: &mut Vec<[f64; 2]>,
    ) -> Result<Vec<Piece>, Fault> {
        let mut pieces: Vec<Piece> = Vec::new();
        for start in self.starts.clone().iter().skip(1) {
            let place = free.fraction(start[k]);
            if own.contains(place) || pieces.iter().any(|piece| piece.contains(place)) {
                continue;
            }
            let from = [start.clone()];
            let found = self.fit((free, k, place), &from, points, Care::OneStart)?;
            if let Some(found) = found.filter(|found| found.sum <= self.limit) {
                pieces.push(self.piece(free, k, (&found.values, found.sum), first, points)?);
            }
        }
        Ok(pieces)
    }

    /// Continues from `inside` until the limit is crossed; `None` where the range or the budget
    /// ends before.
    fn until_crossing(
        &mut self,
        free: &Free,
        k: usize,
        mut inside: Fit,
        mut step: f64,
        points: &mut Vec<[f64; 2]>,
    ) -> Result<Option<Crossing>, Fault> {
        let mut before: Option<Fit> = None;
        for number in 0..SIDE {
            let place = (inside.place + step).clamp(0.0, 1.0);
            if place == inside.place {
                break;
            }
            let ahead = before.map(|before| self.on_line([&before, &inside], place));
            let starts: Vec<Vec<f64>> = ahead.into_iter().chain([inside.values.clone()]).collect();
            let found = self.fit((free, k, place), &starts, points, Care::AllStarts)?;
            let Some(found) = found else {
                self.cut = Some(free.value(inside.place)).filter(|_| !self.is_over);
                break;
            };
            if found.sum > self.limit {
                return self.crossing(free, k, [inside, found], points).map(Some);
            }
            before = Some(std::mem::replace(&mut inside, found));
            step *= GROWTH[usize::from(number >= NEARBY)];
        }
        Ok(None)
    }

    /// The values at `place` on the line through two fits, in fractions of the ranges: near a minimum the
    /// fits lie on a line.
    fn on_line(&self, [first, second]: [&Fit; 2], place: f64) -> Vec<f64> {
        let share = (place - first.place) / (second.place - first.place);
        let pairs = first.values.iter().zip(&second.values).enumerate();
        let value = |(k, (first, second)): (usize, (&f64, &f64))| {
            let free = self.refit.parameter(k);
            let [first, second] = [first, second].map(|value| free.fraction(*value));
            free.value((first + share * (second - first)).clamp(0.0, 1.0))
        };
        pairs.map(value).collect()
    }

    /// The place between a fit inside and one outside at which the sum of squares reaches the limit; the
    /// rise is nearly a parabola, so its root is taken along a straight line. Where it jumps, the
    /// place of the jump.
    fn crossing(
        &mut self,
        free: &Free,
        k: usize,
        [mut inside, mut outside]: [Fit; 2],
        points: &mut Vec<[f64; 2]>,
    ) -> Result<Crossing, Fault> {
        let (mut same_end, mut was_outside) = (0, None);
        let smallest = points[0][1];
        let same = SAME.min(SAME_OF_BRACKET * (outside.place - inside.place).abs());
        let root = |sum: f64| (sum - smallest).max(0.0).sqrt();
        for attempt in 0..JUMPING {
            let part =
                (root(self.limit) - root(inside.sum)) / (root(outside.sum) - root(inside.sum));
            let width = outside.place - inside.place;
            let at = |part: f64| inside.place + part.clamp(0.05, 0.95) * width;
            let jumps = outside.sum - inside.sum > JUMP * (self.limit - smallest);
            if attempt >= CROSSING && (!jumps || width.abs() <= same) {
                return Ok(Crossing { place: at(part), values: inside.values });
            }
            // Where the same end is met again, the rise is not a parabola.
            let is_root = attempt < CROSSING && same_end < 2;
            let place = at(if is_root { part } else { 0.5 });
            let starts = [self.on_line([&inside, &outside], place), inside.values.clone()];
            let found = self.fit((free, k, place), &starts, points, Care::OneStart)?;
            let Some(found) = found else {
                return Ok(Crossing { place, values: inside.values });
            };
            if (found.sum - self.limit).abs() <= NEAR * (self.limit - smallest) {
                return Ok(Crossing { place, values: found.values });
            }
            let is_outside = found.sum > self.limit;
            same_end = if was_outside == Some(is_outside) { same_end + 1 } else { 1 };
            was_outside = Some(is_outside);
            *(if is_outside { &mut outside } else { &mut inside }) = found;
        }
        Ok(Crossing { place: inside.place, values: inside.values })
    }

    /// The smallest sum of squares with parameter `k` at `place`, from the first of `starts` that can be
    /// simulated there.
    fn fit(
        &mut self,
        (free, k, place): (&Free, usize, f64),
        starts: &[Vec<f64>],
        points: &mut Vec<[f64; 2]>,
        care: Care,
    ) -> Result<Option<Fit>, Fault> {
        if self.refit.simulations >= self.last {
            self.is_over = true;
            return Ok(None);
        }
        let more = if care == Care::AllStarts { self.starts.clone() } else { Vec::new() };
        let own = starts.iter().cloned().map(|start| (start, true));
        let mut least: Option<(Vec<f64>, f64)> = None;
        for (mut start, is_own) in own.chain(more.into_iter().map(|start| (start, false))) {
            if is_own && least.is_some() {
                continue;
            }
            start[k] = free.value(place);
            let found = self.refit.roughly(&start, &[k])?;
            least = match (least, found) {
                (Some(least), Some(found)) if found.1 < least.1 => Some(found),
                (least, found) => least.or(found),
            };
            if least.as_ref().is_some_and(|(_, sum)| *sum <= self.limit) {
                break;
            }
        }
        self.is_over |= self.refit.is_cancelled();
        let Some((values, sum)) = least.filter(|_| !self.is_over) else { return Ok(None) };
        points.push([values[k], sum]);
        if sum <= self.limit {
            self.valley.push(values.clone());
        }
        if self.better.as_ref().is_none_or(|known| sum < known.1) {
            self.better = Some((values.clone(), sum));
        }
        Ok(Some(Fit { place, values, sum }))
    }
}
