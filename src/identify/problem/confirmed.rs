//! Whether parameters that cancel each other by their derivatives do so at finite distances: where one
//! of them also acts in steps, or derivatives vanish at the best point alone, they do not.

use super::non_identifiable::{Form, NonIdentifiable};
use super::{Evaluation, Problem};
use crate::elementary;

/// Changes that are tried: parts of the values, or of this part of the ranges where these are larger.
const CHANGES: [f64; 6] = [0.01, -0.01, 0.1, -0.1, 0.3, -0.3];
const OF_RANGE: f64 = 0.05;
/// A change of a point below this many times the error of the simulation is that error, and one below
/// this part of the largest point that of the direction.
const ERRORS: f64 = 1e3;
const OF_DIRECTION: f64 = 1e-5;

/// Whether finite changes of the group have no effect, and the simulations that it took. `simulated`:
/// the points at the best `values`; `limit`: whether a simulation is within the 95 % limit.
pub fn is_confirmed(
    problem: &Problem,
    evaluation: &Evaluation,
    (values, simulated): (&[f64], &[f64]),
    group: &NonIdentifiable,
    is_within: &dyn Fn(&[f64]) -> bool,
) -> (bool, u64) {
    let is_local = group.form == Form::Local;
    let places: Vec<Vec<f64>> = group
        .directions
        .iter()
        .flat_map(|direction| CHANGES.iter().map(move |change| (direction, *change)))
        .filter_map(|(direction, change)| moved(problem, values, group, direction, change))
        .collect();
    let size = simulated.iter().fold(0.0, |most: f64, v| most.max(v.abs()));
    let is_same = |row: &[f64]| {
        let pairs = row.iter().zip(simulated);
        let most = pairs.fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()));
        most <= (ERRORS * problem.noise).max(OF_DIRECTION) * size
    };
    let rows = evaluation.simulate_all(&places);
    let holds = rows.iter().flatten().all(|row| is_same(row) || is_local && is_within(row));
    (holds, places.len() as u64)
}

/// The values with the group changed; `None` beyond the ranges.
fn moved(
    problem: &Problem,
    values: &[f64],
    group: &NonIdentifiable,
    direction: &[f64],
    change: f64,
) -> Option<Vec<f64>> {
    let is_relative = group.form == Form::Product;
    let room = |k: usize| {
        let free = &problem.parameters[k];
        match is_relative {
            true => 1.0,
            false => values[k].abs().max(OF_RANGE * (free.max - free.min)),
        }
    };
    let pairs = group.parameters.iter().zip(direction);
    let largest = pairs.clone().fold(0.0, |most: f64, (&k, by)| most.max((by / room(k)).abs()));
    let mut moved = values.to_vec();
    for (&k, by) in pairs {
        let by = change * by / largest;
        moved[k] = match is_relative {
            true => values[k] * elementary::exp(by),
            false => values[k] + by,
        };
        let free = &problem.parameters[k];
        if !(free.min..=free.max).contains(&moved[k]) {
            return None;
        }
    }
    Some(moved)
}
