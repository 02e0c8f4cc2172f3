//! Shares of the variance: how much of the variance of the compared points comes from a parameter
//! alone (first order), and how much goes with it when all others are known (total). Of several
//! points the variances are added.
//!
//! For two independent samples A and B and the sample Aᵢ that is A with parameter i from B:
//!
//! ```text
//! first order = (V − ½ E (f(B) − f(Aᵢ))²) / V        total = ½ E (f(A) − f(Aᵢ))² / V
//! ```
//!
//! References: [Sobol 1967](gapilib_base::bibliography#sobol-1967),
//! [Jansen 1999](gapilib_base::bibliography#jansen-1999) (estimators),
//! [Lamboni et al. 2011](gapilib_base::bibliography#lamboni-2011) (several points).

use super::{Analysis, Importance, ParameterImportance, mean, values};
use crate::diag::Fault;
use crate::elementary;
use crate::ga::sampling::sobol;
use crate::ga::{Genomes, Mrg32k3a};
use crate::problem::{Evaluation, Failed, Problem};
use crate::registry::Entry;

/// The table entry.
pub const ENTRY: Entry<dyn Analysis> = Entry {
    name: "sobol",
    aliases: &["variance"],
    summary: "Sobol indices: shares of the variance",
    reference: "sobol-1967",
    make: |_| Ok(Box::new(Sobol)),
};

/// Base samples by default.
const SAMPLES: usize = 512;
/// Base samples simulated at once.
const AT_ONCE: usize = 32;

struct Sobol;

type Row = Result<Vec<f64>, Failed>;

/// What is added up, sample by sample.
struct Sums {
    /// For each parameter the squared distances to B and to A.
    distances: Vec<[Vec<f64>; 2]>,
    /// Point by point: count, mean and squared deviations of the successful simulations in A and B.
    count: f64,
    mean: Vec<f64>,
    square: Vec<f64>,
    failed: u64,
}

impl Analysis for Sobol {
    fn importance(
        &self,
        problem: &Problem,
        evaluation: &Evaluation,
        samples: usize,
    ) -> Result<Option<Importance>, Fault> {
        let n = problem.parameters.len();
        let samples = if samples == 0 { SAMPLES } else { samples };
        let places = sobol(2 * n, samples, &mut Mrg32k3a::new(&problem.seed)?.stream(2));
        let points = problem.n_points();
        let mut sums = Sums {
            distances: vec![[Vec::new(), Vec::new()]; n],
            count: 0.0,
            mean: vec![0.0; points],
            square: vec![0.0; points],
            failed: 0,
        };
        let mut is_whole = true;
        for first in (0..samples).step_by(AT_ONCE) {
            let block = block(problem, &places, first..(first + AT_ONCE).min(samples));
            let groups: Vec<Vec<Vec<f64>>> = block.chunks_exact(n + 2).map(<[_]>::to_vec).collect();
            match evaluation.simulate_groups(ENTRY.name, &groups) {
                Some(all) => all.iter().for_each(|rows| sums.add(evaluation, rows)),
                None => is_whole = false,
            }
        }
        if !is_whole {
            return Ok(None);
        }
        // The distance of two points is that of the mean over all of them.
        let weights = evaluation.weights();
        let weighted = sums.square.iter().zip(weights).map(|(s, w)| s * w * w);
        let variance = weighted.sum::<f64>() / (sums.count - 1.0).max(1.0) / points as f64;
        let parameters = problem.parameters.iter().zip(&sums.distances);
        Ok(Some(Importance {
            method: ENTRY.name.to_owned(),
            headings: ["first order", "total"].map(str::to_owned),
            parameters: parameters.map(|(free, all)| shares(&free.name, all, variance)).collect(),
            simulations: (samples * (n + 2)) as u64,
            failed: sums.failed,
        }))
    }
}

/// For each sample A, B and one more for each parameter.
fn block(problem: &Problem, places: &Genomes, samples: std::ops::Range<usize>) -> Vec<Vec<f64>> {
    let mut block = Vec::new();
    for sample in samples {
        let (a, b) = places.row(sample).split_at(problem.parameters.len());
        block.extend([values(problem, a), values(problem, b)]);
        for k in 0..a.len() {
            let mut mixed = a.to_vec();
            mixed[k] = b[k];
            block.push(values(problem, &mixed));
        }
    }
    block
}

impl Sums {
    fn add(&mut self, evaluation: &Evaluation, rows: &[Row]) {
        self.failed += rows.iter().filter(|row| row.is_err()).count() as u64;
        let (ends, mixed) = rows.split_at(2);
        for row in ends.iter().flatten() {
            self.count += 1.0;
            for ((mean, square), value) in self.mean.iter_mut().zip(&mut self.square).zip(row) {
                let difference = value - *mean;
                *mean += difference / self.count;
                *square += difference * (value - *mean);
            }
        }
        for (row, distances) in mixed.iter().zip(&mut self.distances) {
            for (end, distances) in [1, 0].into_iter().zip(distances) {
                if let (Ok(row), Ok(end)) = (row, &ends[end]) {
                    distances.push(elementary::powi(evaluation.distance(row, end), 2));
                }
            }
        }
    }
}

fn shares(name: &str, [from_b, from_a]: &[Vec<f64>; 2], variance: f64) -> ParameterImportance {
    let share = |distances: &[f64]| {
        let found = mean(distances).filter(|_| variance > 0.0)?;
        Some((0.5 * found.0 / variance, 0.5 * found.1 / variance))
    };
    let (first, total) = (share(from_b), share(from_a));
    ParameterImportance {
        name: name.to_owned(),
        figures: [first.map(|s| 1.0 - s.0), total.map(|s| s.0)],
        errors: [first.map(|s| s.1), total.map(|s| s.1)],
    }
}
