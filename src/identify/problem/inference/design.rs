//! The next measurement: which added points shrink which interval most (optimal design of
//! experiments).
//!
//! A point of gradient g (with respect to the parameters) measured with standard deviation σ adds
//! g gᵀ/σ² to the Fisher information. For each parameter the window of X is found in which a given
//! number of evenly spread points leaves the smallest variance (c-optimal); for all parameters
//! together the points are found that leave the smallest volume of the confidence region
//! (D-optimal) and the smallest sum of relative variances (A-optimal), by greedy choice and
//! Fedorov's exchange. What is announced holds for the curvature at the best values and the noise
//! of the present data.
//!
//! References: [Fedorov 1972](gapilib_base::bibliography#fedorov-1972);
//! [Walter & Pronzato 1997](gapilib_base::bibliography#walter-pronzato-1997), chapter 6.

use super::super::statistics::quantile;
use super::local::Information;
use super::predictions::{Linear, linear};
use super::{Curve, CurveRequest, Local, Reach};
use crate::diag::Fault;
use crate::problem::Problem;
use crate::registry::BAD_OPTION;
use crate::table::significant;
use crate::{elementary, fault};
use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

/// Points of X among which is chosen.
const GRID: usize = 41;
/// Least width of a window, in steps of the grid: a twentieth of the range, since instruments do
/// not measure five times at one place.
const NARROWEST: usize = 2;
/// A wider window is preferred while the interval stays within this factor of the smallest.
const NEARLY: f64 = 1.02;
/// Intervals that shrink to more than this factor are not worth a measurement.
const WORTH: f64 = 0.9;
/// Sweeps of the exchange; it ended after at most 5 on the problems tried.
const SWEEPS: usize = 50;

/// What is asked.
#[derive(Debug, Clone, PartialEq)]
pub struct DesignSettings {
    /// How many points are to be added.
    pub points: usize,
    /// Where X may be chosen; all that is simulated unless given.
    pub range: Option<[f64; 2]>,
    /// Variables beside the measured ones that could be measured, with the standard deviation of
    /// such a measurement.
    pub outputs: Vec<(String, f64)>,
}

/// The answer.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct NextMeasurement {
    /// How many points are added.
    pub points: usize,
    /// The names of the parameters.
    pub parameters: Vec<String>,
    /// Half-widths of the 95 % intervals now, as fractions of the values; `None` where unbounded.
    pub now: Vec<Option<f64>>,
    /// What could be measured.
    pub proposals: Vec<Proposal>,
}

/// Measurements, and what they would bring.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Proposal {
    /// `interval` of one parameter, `D`, `A`, or `repeat` of an experiment.
    pub criterion: String,
    /// The parameter whose interval shrinks most.
    pub parameter: Option<usize>,
    /// What is measured.
    pub plans: Vec<Plan>,
    /// Half-widths afterwards, as fractions of the values; `None` where unbounded.
    pub after: Vec<Option<f64>>,
    /// Volume of the confidence region by the present one; `None` where that is unbounded.
    pub volume: Option<f64>,
}

/// Points of one variable in one window.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Plan {
    /// The experiment.
    pub experiment: String,
    /// The variable; empty for all of the experiment.
    pub variable: String,
    /// What it is measured over, and the unit.
    pub x: [String; 2],
    /// From where to where, evenly; equal for points at one place.
    pub range: [f64; 2],
    /// How many.
    pub points: usize,
}

/// A curve on which points may be added.
struct Candidate {
    curve: Curve,
    /// Gradients by the relative change of the parameters, by the standard deviation of a
    /// measurement, point by point: those of all that is measured there.
    gradients: Vec<Vec<Vec<f64>>>,
}

/// The present information, and what is compared with it.
struct DesignSearch<'a> {
    local: &'a Local,
    /// Parameter by relative parameter: |value|, or 1 where it is 0.
    units: Vec<f64>,
    present: DMatrix<f64>,
    tolerance: f64,
    points: usize,
}

/// The next measurement; `None` where nothing can be predicted.
pub fn next_measurement(
    problem: &Problem,
    settings: &DesignSettings,
    local: &Local,
    refusals: &mut Vec<String>,
) -> Result<Option<NextMeasurement>, Fault> {
    let Some(predict) = &problem.inference.predict else { return Ok(None) };
    let variables: Vec<String> = settings.outputs.iter().map(|(name, _)| name.clone()).collect();
    let reach = settings.range.map_or(Reach::Simulated, Reach::Range);
    let request = CurveRequest { variables: &variables, reach, points: GRID, proposes: true };
    let (curves, linear) = linear(problem, predict.as_ref(), &local.values, &request)?;
    let linear = match linear {
        Ok(linear) if !curves.curves.is_empty() => linear,
        Ok(_) => {
            refusals.extend(curves.refusals);
            return Ok(None);
        }
        Err(failed) => {
            refusals.push(format!("There is no experiment design: {}.", failed.cause));
            return Ok(None);
        }
    };
    let search = DesignSearch::new(problem, local, settings.points);
    let candidates = candidates(problem, settings, &search, curves.curves, &linear)?;
    let mut proposals = search.windows(&candidates);
    let optimal = ["D", "A"].map(|criterion| search.exchange(&candidates, criterion));
    refusals.extend(unbounded(problem, &optimal[0]));
    // Determinant and sum of variances compare plans only where all variances are finite.
    proposals.extend(optimal.into_iter().filter(|plan| plan.after.iter().all(Option::is_some)));
    proposals.extend(search.repeats(problem));
    Ok(Some(NextMeasurement {
        points: settings.points,
        parameters: problem.parameters.iter().map(|free| free.name.clone()).collect(),
        now: search.half_widths(&search.information(&search.present), 0),
        proposals,
    }))
}

/// That there is no optimal plan, because some parameters stay unbounded with every point tried.
fn unbounded(problem: &Problem, plan: &Proposal) -> Option<String> {
    let open = problem.parameters.iter().zip(&plan.after).filter(|(_, after)| after.is_none());
    let names: Vec<&str> = open.map(|(free, _)| free.name.as_str()).collect();
    (!names.is_empty()).then(|| {
        format!(
            "There is no D- or A-optimal design: further measurements of these variables leave \
             {} unbounded.",
            names.join(", ")
        )
    })
}

fn candidates(
    problem: &Problem,
    settings: &DesignSettings,
    search: &DesignSearch<'_>,
    curves: Vec<Curve>,
    linear: &Linear,
) -> Result<Vec<Candidate>, Fault> {
    let mut place = 0;
    let mut candidates = Vec::new();
    let magnitudes = magnitudes(&curves, linear);
    for curve in curves {
        let rows = place..place + curve.points.len();
        let (own, magnitudes) = (&linear.gradients[rows.clone()], &magnitudes[rows]);
        place += curve.points.len();
        let known = settings.outputs.iter().find(|(name, _)| *name == curve.y[0]);
        let noise = |x: f64| match (curve.series, known) {
            (Some(series), _) => Some(search.local.noise_at(problem, series, x)),
            (None, Some((_, sigma))) => Some(*sigma),
            (None, None) => None,
        };
        let mut gradients = Vec::with_capacity(own.len());
        for ((x, gradient), magnitude) in curve.points.iter().zip(own).zip(magnitudes) {
            let noise = noise(*x).ok_or_else(|| {
                fault!(BAD_OPTION, "the measurement errors of `{}` are unknown", curve.y[0])
            })?;
            let measured = measured_magnitude(problem, &curve, *x);
            let noise = noise * measured.map_or(1.0, |measured| magnitude / measured);
            let parts = gradient.iter().zip(&search.units).map(|(g, unit)| g * unit / noise);
            gradients.push(vec![parts.collect::<Vec<f64>>()]);
        }
        candidates.push(Candidate { curve, gradients });
    }
    Ok(with_whole_spectra(candidates))
}

/// The magnitude of each point of the spectra, whose parts are curves with the same points.
fn magnitudes(curves: &[Curve], linear: &Linear) -> Vec<f64> {
    let ends = curves.iter().scan(0, |end, curve| {
        let begin = *end;
        *end += curve.points.len();
        Some((begin, curve))
    });
    let all: Vec<(usize, &Curve)> = ends.collect();
    let of = |curve: &Curve, k: usize| {
        let parts = all.iter().filter(|(_, own)| own.experiment == curve.experiment);
        let parts = parts.filter(|(_, own)| own.points.len() == curve.points.len());
        let squares = parts.map(|(begin, _)| elementary::powi(linear.values[begin + k], 2));
        squares.sum::<f64>().sqrt()
    };
    curves
        .iter()
        .flat_map(|curve| (0..curve.points.len()).map(move |k| (curve, k)))
        .map(|(curve, k)| of(curve, k))
        .collect()
}

/// The measured magnitude to which errors are in proportion, at the frequency nearest to `x`.
fn measured_magnitude(problem: &Problem, curve: &Curve, x: f64) -> Option<f64> {
    let parts = problem.series.get(curve.in_proportion_to.clone())?;
    let known = parts.first()?.x.iter().enumerate();
    let (k, _) = known.min_by(|a, b| (a.1 - x).abs().total_cmp(&(b.1 - x).abs()))?;
    let squares = parts.iter().filter_map(|own| own.y.get(k)).map(|y| elementary::powi(*y, 2));
    Some(squares.sum::<f64>().sqrt()).filter(|magnitude| *magnitude > 0.0)
}

/// An instrument measures both parts of a spectrum at a frequency: they are one candidate.
fn with_whole_spectra(candidates: Vec<Candidate>) -> Vec<Candidate> {
    let mut all: Vec<Candidate> = Vec::new();
    for own in candidates {
        let is_part = |last: &&mut Candidate| {
            own.curve.is_over_frequency && last.curve.experiment == own.curve.experiment
        };
        match all.last_mut().filter(is_part) {
            Some(last) => {
                "the spectrum".clone_into(&mut last.curve.y[0]);
                last.gradients.iter_mut().zip(own.gradients).for_each(|(a, b)| a.extend(b));
            }
            None => all.push(own),
        }
    }
    all
}

impl Candidate {
    /// Adds the information of a point at a place on the grid, whose gradients are linear between points.
    fn add(&self, matrix: &mut DMatrix<f64>, place: f64) {
        let low = (place.floor() as usize).min(self.gradients.len() - 1);
        let high = (low + 1).min(self.gradients.len() - 1);
        let part = place - low as f64;
        for (low, high) in self.gradients[low].iter().zip(&self.gradients[high]) {
            let pairs = low.iter().zip(high);
            add_point(matrix, &pairs.map(|(a, b)| a + part * (b - a)).collect::<Vec<f64>>());
        }
    }

    fn plan(&self, [low, high]: [usize; 2], points: usize) -> Plan {
        Plan {
            experiment: self.curve.experiment.clone(),
            variable: self.curve.y[0].clone(),
            x: self.curve.x.clone(),
            range: [self.curve.points[low], self.curve.points[high]],
            points,
        }
    }
}

impl<'a> DesignSearch<'a> {
    fn new(problem: &Problem, local: &'a Local, points: usize) -> DesignSearch<'a> {
        let unit = |value: &f64| if *value == 0.0 { 1.0 } else { value.abs() };
        let units: Vec<f64> = local.values.iter().map(unit).collect();
        let n = units.len();
        let gram = local.jacobian.tr_mul(&local.jacobian) / local.variance;
        DesignSearch {
            present: DMatrix::from_fn(n, n, |k, l| gram[(k, l)] * units[k] * units[l]),
            tolerance: Local::tolerance(problem.noise),
            local,
            units,
            points,
        }
    }

    fn information(&self, matrix: &DMatrix<f64>) -> Information {
        Information::new(matrix, self.tolerance)
    }

    /// Relative half-widths with so many points more.
    fn half_widths(&self, information: &Information, added: usize) -> Vec<Option<f64>> {
        let quantile = quantile(self.local.freedom_of_quantile + added as f64);
        let half = |variance: Option<f64>| variance.map(|variance| quantile * variance.sqrt());
        information.variances().into_iter().map(half).collect()
    }

    fn proposal(
        &self,
        criterion: &str,
        parameter: Option<usize>,
        plans: Vec<Plan>,
        matrix: &DMatrix<f64>,
    ) -> Proposal {
        let (now, then) = (self.information(&self.present), self.information(matrix));
        let added = plans.iter().map(|plan| plan.points).sum();
        let ratio = elementary::exp(0.5 * (now.log_determinant() - then.log_determinant()));
        Proposal {
            criterion: criterion.to_owned(),
            parameter,
            plans,
            after: self.half_widths(&then, added),
            volume: Some(ratio)
                .filter(|ratio| now.log_determinant().is_finite() && ratio.is_finite()),
        }
    }

    /// With evenly spread points in a window of the grid.
    fn with_window(&self, candidate: &Candidate, [low, high]: [usize; 2]) -> DMatrix<f64> {
        let mut matrix = self.present.clone();
        for k in 0..self.points {
            let part = if self.points == 1 { 0.5 } else { k as f64 / (self.points - 1) as f64 };
            candidate.add(&mut matrix, low as f64 + part * (high - low) as f64);
        }
        matrix
    }

    /// For every parameter the window that shrinks its interval most.
    fn windows(&self, candidates: &[Candidate]) -> Vec<Proposal> {
        let n = self.units.len();
        let mut tried: Vec<(usize, [usize; 2], Vec<Option<f64>>)> = Vec::new();
        for (c, candidate) in candidates.iter().enumerate() {
            let last = candidate.gradients.len();
            for low in 0..last {
                let widths = if self.points == 1 { 0..1 } else { NARROWEST..last - low };
                for width in widths {
                    let window = [low, low + width];
                    let matrix = self.with_window(candidate, window);
                    tried.push((c, window, self.information(&matrix).variances()));
                }
            }
        }
        let best = |k: usize| {
            let variance = |place: &(usize, [usize; 2], Vec<Option<f64>>)| place.2[k];
            let smallest = tried.iter().filter_map(variance).min_by(f64::total_cmp)?;
            let good = tried.iter().filter(|place| {
                variance(place).is_some_and(|variance| variance <= smallest * NEARLY * NEARLY)
            });
            let (c, window, _) =
                good.max_by_key(|(c, [low, high], _)| (high - low, usize::MAX - c))?;
            let plan = candidates[*c].plan(*window, self.points);
            let matrix = self.with_window(&candidates[*c], *window);
            Some(self.proposal("interval", Some(k), vec![plan], &matrix))
        };
        (0..n).filter_map(best).collect()
    }

    /// Greedy choice of the points and exchange of single points until none helps.
    fn exchange(&self, candidates: &[Candidate], criterion: &str) -> Proposal {
        let all: Vec<(usize, usize)> = candidates
            .iter()
            .enumerate()
            .flat_map(|(c, candidate)| (0..candidate.gradients.len()).map(move |k| (c, k)))
            .collect();
        let matrix = |chosen: &[(usize, usize)]| {
            let mut matrix = self.present.clone();
            let rows = chosen.iter().flat_map(|(c, k)| &candidates[*c].gradients[*k]);
            rows.for_each(|row| add_point(&mut matrix, row));
            matrix
        };
        let loss = |chosen: &[(usize, usize)]| {
            let information = self.information(&matrix(chosen));
            match criterion {
                "D" => -information.floored_log_determinant(),
                _ => information.floored_trace_of_inverse(),
            }
        };
        let mut chosen: Vec<(usize, usize)> = Vec::new();
        let mut best = f64::INFINITY;
        let improve = |chosen: &mut Vec<(usize, usize)>, place: usize, best: &mut f64| {
            let old = chosen[place];
            let mut kept = old;
            for &point in &all {
                chosen[place] = point;
                let loss = loss(chosen);
                // Gains of rounding would send the exchange in circles.
                if loss < *best - 1e-9 * best.abs().max(1e-300) || !best.is_finite() {
                    (kept, *best) = (point, loss);
                }
            }
            chosen[place] = kept;
            kept != old
        };
        for place in 0..self.points {
            chosen.push(all[0]);
            best = f64::INFINITY;
            improve(&mut chosen, place, &mut best);
        }
        for _ in 0..SWEEPS {
            let changed = (0..self.points).filter(|&place| improve(&mut chosen, place, &mut best));
            if changed.count() == 0 {
                break;
            }
        }
        chosen.sort_unstable();
        let mut plans: Vec<Plan> = Vec::new();
        for group in chosen.chunk_by(|a, b| a == b) {
            let (c, k) = group[0];
            plans.push(candidates[c].plan([k, k], group.len()));
        }
        self.proposal(criterion, None, plans, &matrix(&chosen))
    }

    /// Every experiment measured once more, all its points.
    fn repeats(&self, problem: &Problem) -> Vec<Proposal> {
        let mut proposals = Vec::new();
        let mut first = 0;
        for own in problem.series.chunk_by(|a, b| a.experiment == b.experiment) {
            let points: usize = own.iter().map(|series| series.x.len()).sum();
            let mut matrix = self.present.clone();
            for row in self.local.jacobian.rows(first, points).row_iter() {
                let parts = row.iter().zip(&self.units);
                let spread = self.local.variance.sqrt();
                add_point(
                    &mut matrix,
                    &parts.map(|(g, unit)| g * unit / spread).collect::<Vec<_>>(),
                );
            }
            first += points;
            if own.iter().all(|series| !series.is_data()) {
                continue;
            }
            let x = own.iter().flat_map(|series| &series.x);
            let (low, high) =
                x.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(*x), b.max(*x)));
            let plan = Plan {
                experiment: own[0].experiment.clone(),
                variable: String::new(),
                x: [own[0].x_name.clone(), own[0].x_unit.clone()],
                range: [low, high],
                points,
            };
            proposals.push(self.proposal("repeat", None, vec![plan], &matrix));
        }
        proposals
    }
}

fn add_point(matrix: &mut DMatrix<f64>, gradient: &[f64]) {
    for (k, a) in gradient.iter().enumerate() {
        for (l, b) in gradient.iter().enumerate() {
            matrix[(k, l)] += a * b;
        }
    }
}

impl NextMeasurement {
    /// In words, the largest gains first.
    pub fn sentences(&self) -> Vec<String> {
        let mut gains: Vec<(f64, &Proposal, usize)> = Vec::new();
        for proposal in &self.proposals {
            let Some(k) = proposal.parameter else { continue };
            let gain = match (self.now[k], proposal.after[k]) {
                (Some(now), Some(after)) => after / now,
                (None, Some(_)) => 0.0,
                _ => continue,
            };
            gains.push((gain, proposal, k));
        }
        gains.sort_by(|a, b| a.0.total_cmp(&b.0));
        let worth = gains.iter().filter(|(gain, ..)| *gain < WORTH);
        let sentence = |(_, proposal, k): &(f64, &Proposal, usize)| {
            let what = capitalized(&places(&proposal.plans, self.several()));
            format!("{what} would narrow the 95 % interval of {}.", self.change(proposal, *k))
        };
        let mut sentences: Vec<String> = worth.map(sentence).collect();
        let left = gains.iter().filter(|(gain, ..)| *gain >= WORTH).map(|(.., k)| *k);
        let unreached =
            (0..self.parameters.len()).filter(|k| !gains.iter().any(|gain| gain.2 == *k));
        let mut hopeless: Vec<usize> = left.chain(unreached).collect();
        hopeless.sort_unstable();
        if !hopeless.is_empty() {
            let names: Vec<&str> = hopeless.iter().map(|&k| self.parameters[k].as_str()).collect();
            sentences.push(format!(
                "{} more {}, wherever measured, would not shrink the interval of {} by a tenth.",
                capitalized(&number(self.points)),
                if self.points == 1 { "point" } else { "points" },
                names.join(", ")
            ));
        }
        sentences.extend(self.proposals.iter().filter_map(|proposal| self.together(proposal)));
        sentences
    }

    /// About proposals for all parameters.
    fn together(&self, proposal: &Proposal) -> Option<String> {
        let what = places(&proposal.plans, self.several());
        let narrowed = || {
            let worst = (0..self.parameters.len())
                .filter(|&k| {
                    self.now[k].is_none_or(|now| {
                        proposal.after[k].is_some_and(|after| after < WORTH * now)
                    })
                })
                .map(|k| self.change(proposal, k));
            let all: Vec<String> = worst.collect();
            (!all.is_empty()).then(|| all.join(", "))
        };
        let none = "no interval to less than nine tenths";
        let changes = || narrowed().unwrap_or_else(|| none.to_owned());
        match (proposal.criterion.as_str(), proposal.volume) {
            ("D", Some(volume)) => Some(format!(
                "For all parameters together (D-optimal): {what}: the volume of their confidence region shrinks to {} %.",
                significant(100.0 * volume, 2)
            )),
            ("D", None) => {
                Some(format!("For all parameters together (D-optimal): {what}: {}.", changes()))
            }
            ("A", _) => Some(format!(
                "For the sum of relative variances (A-optimal) {what}: {}.",
                changes()
            )),
            ("repeat", _) => {
                let plan = proposal.plans.first()?;
                let own = &plan.experiment;
                let own = if own.is_empty() { "the experiment" } else { own };
                let what = match narrowed() {
                    Some(changes) => format!("the 95 % interval of {changes}"),
                    None => none.to_owned(),
                };
                Some(format!(
                    "Measuring all {} points of {own} once more would narrow {what}.",
                    plan.points
                ))
            }
            _ => None,
        }
    }

    /// Whether the proposals speak of several experiments, made or not.
    fn several(&self) -> bool {
        let plans = self.proposals.iter().flat_map(|proposal| &proposal.plans);
        let mut names = plans.map(|plan| &plan.experiment);
        let first = names.next();
        names.any(|name| Some(name) != first)
    }

    fn change(&self, proposal: &Proposal, k: usize) -> String {
        let percent = |half: Option<f64>| match half {
            Some(half) => format!("±{} %", significant(100.0 * half, 2)),
            None => "unbounded".to_owned(),
        };
        format!(
            "{} from {} to {}",
            self.parameters[k],
            percent(self.now[k]),
            percent(proposal.after[k])
        )
    }
}

/// "five points of V between i = 1.3 and 1.45 A/cm2"; at single places "two points of V at i = 0,
/// one at 1.46 A/cm2". The experiment is named where there are `several`.
fn places(plans: &[Plan], several: bool) -> String {
    let same = |a: &Plan, b: &Plan| a.experiment == b.experiment && a.variable == b.variable;
    plans.chunk_by(same).map(|group| place(group, several)).collect::<Vec<_>>().join("; ")
}

fn place(group: &[Plan], several: bool) -> String {
    let Plan { experiment, variable, x: [x, unit], .. } = &group[0];
    let mut text = String::new();
    for (k, plan) in group.iter().enumerate() {
        let [low, high] = plan.range.map(|x| significant(x, 3));
        let count = number(plan.points);
        text += &match (k, plan.points) {
            (0, 1) => format!("{count} point of {variable} "),
            (0, _) => format!("{count} points of {variable} "),
            _ => format!(", {count} "),
        };
        text += &match (low == high, k) {
            (true, 0) => format!("at {x} = {low}"),
            (true, _) => format!("at {low}"),
            (false, _) => format!("between {x} = {low} and {high}"),
        };
    }
    let of =
        if several && !experiment.is_empty() { format!(" ({experiment})") } else { String::new() };
    let unit = if unit.is_empty() { String::new() } else { format!(" {unit}") };
    format!("{text}{unit}{of}")
}

fn number(count: usize) -> String {
    let words = [
        "no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten",
        "eleven", "twelve",
    ];
    words.get(count).map_or_else(|| count.to_string(), |word| (*word).to_owned())
}

fn capitalized(text: &str) -> String {
    let mut rest = text.chars();
    rest.next().map_or_else(String::new, |first| first.to_uppercase().chain(rest).collect())
}
