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
    /// The last values that could be simulated, where a constraint does not hold beyond or
    /// simulations fail: nothing is known from there on.
    #[serde(default)]
    pub cut: [Option<f64>; 2],
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
    let mut walk = ProfileWalk {
        refit,
        limit: 0.0,
        last: known.budget,
        better: None,
        starts: Vec::new(),
        cut: None,
        is_over: false,
        valley: Vec::new(),
    };
    let Some((best, smallest)) = walk.refit.from(known.best, None)? else { return Ok(None) };
    let residuals = walk.refit.plain_residuals(&best);
    walk.limit = limit(problem, smallest, [known.freedom, known.quantile], residuals.as_deref());
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
        ErrorModel::OneVariance | ErrorModel::Estimated => {
            smallest * (1.0 + elementary::powi(quantile, 2) / freedom)
        }
    }
}

struct ProfileWalk<'a> {
    refit: Refit<'a>,
    limit: f64,
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

/// Connected values within the limit, as fractions of the range; `None` where it continues to the
/// end.
#[derive(Clone, Copy)]
struct Piece {
    ends: [Option<f64>; 2],
    cut: [Option<f64>; 2],
    complete: [bool; 2],
}

impl Piece {
    fn contains(&self, place: f64) -> bool {
        self.ends[0].is_none_or(|low| place >= low - SAME)
            && self.ends[1].is_none_or(|high| place <= high + SAME)
    }
}

impl ProfileWalk<'_> {
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
        let others = self.pieces(&free, k, own, first, &mut points)?;
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
        let mut piece = Piece { ends: [None; 2], cut: [None; 2], complete: [true; 2] };
        for (side, step) in [-first, first].into_iter().enumerate() {
            let mut values = from.0.to_vec();
            let inside = (free.fraction(from.0[k]), from.1);
            let crossing = self.until_crossing(free, k, inside, step, &mut values, points)?;
            piece.ends[side] = crossing;
            piece.cut[side] = self.cut.take();
            piece.complete[side] = !self.is_over;
        }
        Ok(piece)
    }

    /// The pieces about other minima that lie beside the own one.
    fn pieces(
        &mut self,
        free: &Free,
        k: usize,
        own: Piece,
        first: f64,
        points: &mut Vec<[f64; 2]>,
    ) -> Result<Vec<Piece>, Fault> {
        let mut pieces: Vec<Piece> = Vec::new();
        for start in self.starts.clone().iter().skip(1) {
            let place = free.fraction(start[k]);
            if own.contains(place) || pieces.iter().any(|piece| piece.contains(place)) {
                continue;
            }
            let mut values = start.clone();
            let sum = self.fit(free, k, place, &mut values, points, Care::OneStart)?;
            if let Some(sum) = sum.filter(|sum| *sum <= self.limit) {
                pieces.push(self.piece(free, k, (&values, sum), first, points)?);
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
        mut inside: (f64, f64),
        mut step: f64,
        values: &mut [f64],
        points: &mut Vec<[f64; 2]>,
    ) -> Result<Option<f64>, Fault> {
        for number in 0..SIDE {
            let place = (inside.0 + step).clamp(0.0, 1.0);
            if place == inside.0 {
                break;
            }
            let before = values.to_vec();
            let sum = self.fit(free, k, place, values, points, Care::AllStarts)?;
            let Some(sum) = sum else {
                self.cut = Some(free.value(inside.0)).filter(|_| !self.is_over);
                break;
            };
            if sum > self.limit {
                values.copy_from_slice(&before);
                let ends = (inside, (place, sum));
                return self.crossing(free, k, ends, values, points).map(Some);
            }
            inside = (place, sum);
            step *= GROWTH[usize::from(number >= NEARBY)];
        }
        Ok(None)
    }

    /// The place between `inside` and `outside` at which the sum of squares reaches the limit; the
    /// rise is nearly a parabola, so its root is taken along a straight line. Where it jumps, the
    /// place of the jump. `values` are a fit at `inside`.
    fn crossing(
        &mut self,
        free: &Free,
        k: usize,
        ends: ((f64, f64), (f64, f64)),
        values: &mut [f64],
        points: &mut Vec<[f64; 2]>,
    ) -> Result<f64, Fault> {
        let (mut inside, mut outside) = ends;
        let (mut same_end, mut was_outside) = (0, None);
        let smallest = points[0][1];
        let same = SAME.min(SAME_OF_BRACKET * (outside.0 - inside.0).abs());
        let root = |sum: f64| (sum - smallest).max(0.0).sqrt();
        for attempt in 0..JUMPING {
            let part = (root(self.limit) - root(inside.1)) / (root(outside.1) - root(inside.1));
            let at = |part: f64| inside.0 + part.clamp(0.05, 0.95) * (outside.0 - inside.0);
            let jumps = outside.1 - inside.1 > JUMP * (self.limit - smallest);
            let is_located = (outside.0 - inside.0).abs() <= same;
            if attempt >= CROSSING && (!jumps || is_located) {
                return Ok(at(part));
            }
            // Where the same end is met again, the rise is not a parabola.
            let is_root = attempt < CROSSING && same_end < 2;
            let place = at(if is_root { part } else { 0.5 });
            let mut there = values.to_vec();
            let sum = self.fit(free, k, place, &mut there, points, Care::OneStart)?;
            let Some(sum) = sum else { return Ok(place) };
            if (sum - self.limit).abs() <= NEAR * (self.limit - smallest) {
                return Ok(place);
            }
            let is_outside = sum > self.limit;
            same_end = if was_outside == Some(is_outside) { same_end + 1 } else { 1 };
            was_outside = Some(is_outside);
            if is_outside {
                outside = (place, sum);
            } else {
                inside = (place, sum);
                values.copy_from_slice(&there);
            }
        }
        Ok(inside.0)
    }

    /// The smallest sum of squares with parameter `k` at `place`; `values` are where the fit begins
    /// and where it ends.
    fn fit(
        &mut self,
        free: &Free,
        k: usize,
        place: f64,
        values: &mut [f64],
        points: &mut Vec<[f64; 2]>,
        care: Care,
    ) -> Result<Option<f64>, Fault> {
        if self.refit.simulations >= self.last {
            self.is_over = true;
            return Ok(None);
        }
        let more = if care == Care::AllStarts { self.starts.clone() } else { Vec::new() };
        let starts = std::iter::once(values.to_vec()).chain(more);
        let mut least: Option<(Vec<f64>, f64)> = None;
        for mut start in starts {
            start[k] = free.value(place);
            let found = self.refit.from(&start, Some(k))?;
            least = match (least, found) {
                (Some(least), Some(found)) if found.1 < least.1 => Some(found),
                (least, found) => least.or(found),
            };
            if least.as_ref().is_some_and(|(_, sum)| *sum <= self.limit) {
                break;
            }
        }
        self.is_over |= self.refit.is_cancelled();
        let Some((found, sum)) = least.filter(|_| !self.is_over) else { return Ok(None) };
        values.copy_from_slice(&found);
        points.push([found[k], sum]);
        if sum <= self.limit {
            self.valley.push(found.clone());
        }
        if self.better.as_ref().is_none_or(|known| sum < known.1) {
            self.better = Some((found, sum));
        }
        Ok(Some(sum))
    }
}
