//! Parameters whose derivative is zero at the best point: without any effect, or acting in steps.
//!
//! An output that changes in steps (a switching time between two samples, a rounded number) has a
//! derivative of zero nearly everywhere. Only finite changes over the whole range tell.

use super::conclusion::limit;
use super::{Evaluation, Problem, Statistics};
use crate::elementary;

/// Fractions of the range that are tried on each side: from this on, each larger by the factor.
const FIRST: f64 = 1e-3;
const GROWTH: f64 = 1.5;
/// Halvings that locate where the limit is crossed.
const HALVINGS: usize = 30;
/// A change of a point below this many times the error of the simulation is that error.
const ERRORS: f64 = 10.0;

/// What a parameter without derivative does.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Effect {
    /// Nothing, in its whole range.
    None,
    /// It acts in steps. The ends of the values whose sum of squares is within the 95 % limit, the
    /// others held; `None` where the range ends before.
    Steps([Option<f64>; 2]),
}

/// What parameter `k` does at finite distances from the best `values`, and the simulations that
/// it took.
pub(super) fn effect(
    problem: &Problem,
    evaluation: &Evaluation,
    statistics: &Statistics,
    (values, simulated): (&[f64], &[f64]),
    k: usize,
) -> (Effect, u64) {
    let free = &problem.parameters[k];
    let here = free.fraction(values[k]);
    let at = |place: f64| {
        let mut point = values.to_vec();
        point[k] = free.value(place);
        point
    };
    let mut walk = Walk { problem, evaluation, statistics, simulations: 0 };
    let (mut acts, mut ends) = (false, [None; 2]);
    for (end, side) in ends.iter_mut().zip([-1.0, 1.0]) {
        let places = outward(here, side);
        let rows = evaluation.simulate_all(&places.iter().map(|u| at(*u)).collect::<Vec<_>>());
        walk.simulations += rows.len() as u64;
        let mut inside = here;
        for (&place, row) in places.iter().zip(&rows) {
            acts |= row.as_ref().map_or(true, |row| walk.differs(simulated, row));
            if !walk.fits(row.as_ref().ok().map(Vec::as_slice)) {
                *end = Some(free.value(walk.crossing(&at, inside, place)));
                break;
            }
            inside = place;
        }
    }
    (if acts { Effect::Steps(ends) } else { Effect::None }, walk.simulations)
}

/// Fractions of the range from `here` to its end.
fn outward(here: f64, side: f64) -> Vec<f64> {
    let end = if side < 0.0 { 0.0 } else { 1.0 };
    let mut places = Vec::new();
    let mut step = FIRST;
    while (end - here) * side > step {
        places.push(here + side * step);
        step *= GROWTH;
    }
    if here != end {
        places.push(end);
    }
    places
}

struct Walk<'a> {
    problem: &'a Problem,
    evaluation: &'a Evaluation,
    statistics: &'a Statistics,
    simulations: u64,
}

impl Walk<'_> {
    fn differs(&self, a: &[f64], b: &[f64]) -> bool {
        let size = a.iter().fold(0.0, |most: f64, v| most.max(v.abs()));
        let change = a.iter().zip(b).fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()));
        change > ERRORS * self.problem.noise * size
    }

    /// Whether a simulation fits the data within the 95 % limit; one that failed does not.
    fn fits(&self, simulated: Option<&[f64]>) -> bool {
        let measured = self.problem.series.iter().flat_map(|series| &series.y);
        simulated.is_some_and(|simulated| {
            let points = measured.zip(simulated).zip(&self.statistics.weights);
            let square: f64 = points.map(|((m, s), w)| elementary::powi(w * (m - s), 2)).sum();
            square <= limit(self.statistics)
        })
    }

    fn crossing(
        &mut self,
        at: &impl Fn(f64) -> Vec<f64>,
        mut inside: f64,
        mut outside: f64,
    ) -> f64 {
        for _ in 0..HALVINGS {
            let middle = 0.5 * (inside + outside);
            let row = self.evaluation.simulate(&at(middle));
            self.simulations += 1;
            let fits = self.fits(row.as_ref().ok().map(Vec::as_slice));
            *(if fits { &mut inside } else { &mut outside }) = middle;
        }
        inside
    }
}
