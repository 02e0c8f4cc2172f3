//! Screening: each trajectory changes one parameter after the other by two thirds of its range;
//! the mean size of what that changes says how much a parameter matters, its deviation how much
//! that depends on the others.
//!
//! Reference: [Morris 1991](gapilib_base::bibliography#morris-1991).

use super::{Analysis, Importance, ParameterImportance, mean, values};
use crate::diag::Fault;
use crate::ga::Mrg32k3a;
use crate::problem::{Evaluation, Problem};
use crate::registry::Entry;

/// The table entry.
pub const ENTRY: Entry<dyn Analysis> = Entry {
    name: "morris",
    aliases: &["screening"],
    summary: "Morris method: screening by elementary effects; cheap",
    reference: "morris-1991",
    make: |_| Ok(Box::new(Morris)),
};

/// Levels of a parameter.
const LEVELS: usize = 4;
/// Trajectories by default.
const TRAJECTORIES: usize = 20;

struct Morris;

impl Analysis for Morris {
    fn importance(
        &self,
        problem: &Problem,
        evaluation: &Evaluation,
        samples: usize,
    ) -> Result<Option<Importance>, Fault> {
        let n = problem.parameters.len();
        let mut rng = Mrg32k3a::new(&problem.seed)?.stream(2);
        let trajectories = if samples == 0 { TRAJECTORIES } else { samples };
        let delta = LEVELS as f64 / (2.0 * (LEVELS as f64 - 1.0));
        let mut effects: Vec<Vec<f64>> = vec![Vec::new(); n];
        let mut failed = 0;
        let walks: Vec<_> = (0..trajectories).map(|_| trajectory(n, delta, &mut rng)).collect();
        let points = |places: &Vec<Vec<f64>>| places.iter().map(|p| values(problem, p)).collect();
        let groups: Vec<Vec<Vec<f64>>> = walks.iter().map(|(places, _)| points(places)).collect();
        let Some(simulated) = evaluation.simulate_groups(ENTRY.name, &groups) else {
            return Ok(None);
        };
        for (rows, (_, order)) in simulated.iter().zip(&walks) {
            failed += rows.iter().filter(|row| row.is_err()).count() as u64;
            for (pair, &k) in rows.windows(2).zip(order) {
                if let [Ok(a), Ok(b)] = pair {
                    effects[k].push(evaluation.distance(a, b) / delta);
                }
            }
        }
        let parameter = |(free, effects): (&super::super::Free, &Vec<f64>)| {
            let found = mean(effects);
            let error = found.map(|found| found.1);
            let deviation = error.map(|error| error * (effects.len() as f64).sqrt());
            ParameterImportance {
                name: free.name.clone(),
                figures: [found.map(|found| found.0), deviation],
                errors: [error, None],
            }
        };
        Ok(Some(Importance {
            method: ENTRY.name.to_owned(),
            headings: ["mean effect", "spread of the effect"].map(str::to_owned),
            parameters: problem.parameters.iter().zip(&effects).map(parameter).collect(),
            simulations: (trajectories * (n + 1)) as u64,
            failed,
        }))
    }
}

/// The places of a trajectory and which parameter changes between them.
fn trajectory(n: usize, delta: f64, rng: &mut Mrg32k3a) -> (Vec<Vec<f64>>, Vec<usize>) {
    let mut draw = |count: usize| ((rng.uniform() * count as f64) as usize).min(count - 1);
    let step = 1.0 / (LEVELS as f64 - 1.0);
    let mut place: Vec<f64> = (0..n).map(|_| draw(LEVELS) as f64 * step).collect();
    let mut order: Vec<usize> = (0..n).collect();
    (1..n).rev().for_each(|last| order.swap(last, draw(last + 1)));
    let mut places = vec![place.clone()];
    for &k in &order {
        // Up from the lower half of the levels, down from the upper one.
        place[k] += if place[k] < 0.5 { delta } else { -delta };
        places.push(place.clone());
    }
    (places, order)
}
