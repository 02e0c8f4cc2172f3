//! Markov chains by delayed-rejection adaptive Metropolis (DRAM).
//!
//! A proposal is normal about the present point with the covariance of the chain so far, scaled by
//! 2.4²/d; where it is rejected, a second one with a fifth of the width is tried before the chain
//! stays. The covariance adapts during warm-up alone, so that the draws kept are those of a Markov
//! chain with the right limit.
//!
//! References: [Haario et al. 2006](gapilib_base::bibliography#haario-2006);
//! [Gelman, Roberts & Gilks 1996](gapilib_base::bibliography#gelman-1996) (the scale).

use crate::elementary;
use crate::ga::Mrg32k3a;
use nalgebra::{Cholesky, DMatrix, DVector, Dyn};
use serde::{Deserialize, Serialize};

/// Width of the second proposal by that of the first.
const SECOND: f64 = 0.2;
/// Draws between two adaptations in warm-up.
const EVERY: usize = 100;
/// Added to the diagonal of the adapted covariance, as a share of it.
const RIDGE: f64 = 1e-6;
/// Attempts at a start spread as the covariance says before the centre is taken.
const STARTS: usize = 100;
/// A start is spread this many times wider than the covariance, so that chains which agree have
/// found the target and not one another.
const OVERDISPERSED: f64 = 2.0;

/// A chain under way.
pub(in super::super) struct Chain {
    rng: Mrg32k3a,
    root: Cholesky<f64, Dyn>,
    point: DVector<f64>,
    density: f64,
    /// The points of warm-up, from which the covariance adapts.
    past: Vec<DVector<f64>>,
    /// What was drawn.
    pub(in super::super) drawn: Drawn,
    accepted: u64,
    tried: u64,
}

/// What a chain has drawn after its warm-up.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(in super::super) struct Drawn {
    /// Draws, one row each.
    pub draws: Vec<Vec<f64>>,
    /// Logarithms of the density there.
    pub(crate) densities: Vec<f64>,
    /// After each round: draws, and steps that moved.
    pub rounds: Vec<(usize, u64)>,
}

impl Drawn {
    /// What was drawn up to the end of this round.
    pub fn up_to(&self, round: usize) -> Drawn {
        let rounds = self.rounds[..=round.min(self.rounds.len().saturating_sub(1))].to_vec();
        let count = rounds.last().map_or(0, |(count, _)| *count);
        Drawn {
            draws: self.draws[..count].to_vec(),
            densities: self.densities[..count].to_vec(),
            rounds,
        }
    }

    /// Share of the steps that moved.
    pub(crate) fn acceptance(&self) -> f64 {
        let (tried, accepted) = self.rounds.last().copied().unwrap_or_default();
        accepted as f64 / tried.max(1) as f64
    }
}

impl Chain {
    /// A chain that starts about `centre` as `covariance` says. `target`: logarithm of the density.
    pub(in super::super) fn new(
        centre: &[f64],
        covariance: &DMatrix<f64>,
        mut rng: Mrg32k3a,
        target: &mut dyn FnMut(&[f64]) -> f64,
    ) -> Option<Chain> {
        let root = Cholesky::new(covariance.clone())?;
        let centre = DVector::from_row_slice(centre);
        let (mut point, mut density) = (centre.clone(), f64::NEG_INFINITY);
        for _ in 0..STARTS {
            point = &centre + root.l() * normals(&mut rng, centre.len()) * OVERDISPERSED;
            density = target(point.as_slice());
            if density > f64::NEG_INFINITY {
                break;
            }
        }
        if density == f64::NEG_INFINITY {
            density = target(centre.as_slice());
            point = centre;
        }
        let scaled = Chain::scaled(covariance)?;
        let (past, drawn) = (Vec::new(), Drawn::default());
        Some(Chain { rng, root: scaled, point, density, past, drawn, accepted: 0, tried: 0 })
    }

    fn scaled(covariance: &DMatrix<f64>) -> Option<Cholesky<f64, Dyn>> {
        let scale = elementary::powi(2.4_f64, 2) / covariance.nrows() as f64;
        Cholesky::new(covariance * scale)
    }

    /// So many steps, which adapt the proposal and are forgotten.
    pub(in super::super) fn warm_up(
        &mut self,
        steps: usize,
        target: &mut dyn FnMut(&[f64]) -> f64,
    ) {
        for step in 1..=steps {
            self.step(target);
            self.past.push(self.point.clone());
            if step % EVERY == 0 {
                self.adapt();
            }
        }
        self.past.clear();
        (self.accepted, self.tried) = (0, 0);
    }

    /// So many draws more.
    pub(in super::super) fn draw(&mut self, count: usize, target: &mut dyn FnMut(&[f64]) -> f64) {
        for _ in 0..count {
            self.step(target);
            self.drawn.draws.push(self.point.as_slice().to_vec());
            self.drawn.densities.push(self.density);
        }
        self.drawn.rounds.push((self.tried as usize, self.accepted));
    }

    fn step(&mut self, target: &mut dyn FnMut(&[f64]) -> f64) {
        self.tried += 1;
        let first = &self.point + self.root.l() * normals(&mut self.rng, self.point.len());
        let of_first = target(first.as_slice());
        if elementary::ln(self.rng.uniform()) < of_first - self.density {
            (self.point, self.density) = (first, of_first);
            self.accepted += 1;
            return;
        }
        let second =
            &self.point + self.root.l() * normals(&mut self.rng, self.point.len()) * SECOND;
        let of_second = target(second.as_slice());
        if elementary::ln(self.rng.uniform())
            < self.second_ratio(&first, of_first, &second, of_second)
        {
            (self.point, self.density) = (second, of_second);
            self.accepted += 1;
        }
    }

    /// Logarithm of the acceptance of the second stage (Haario et al. 2006, equation 3).
    fn second_ratio(
        &self,
        first: &DVector<f64>,
        of_first: f64,
        second: &DVector<f64>,
        of_second: f64,
    ) -> f64 {
        if of_second == f64::NEG_INFINITY {
            return f64::NEG_INFINITY;
        }
        let rejected = |from: f64| 1.0 - elementary::exp((of_first - from).min(0.0));
        let (back, forth) = (rejected(of_second), rejected(self.density));
        if back <= 0.0 {
            return f64::NEG_INFINITY;
        }
        let distance = |from: &DVector<f64>| {
            let step = first - from;
            step.dot(&self.root.solve(&step))
        };
        let proposals = -0.5 * (distance(second) - distance(&self.point));
        of_second - self.density + proposals + elementary::ln(back) - elementary::ln(forth)
    }

    /// The covariance of the later half of the past.
    fn adapt(&mut self) {
        let recent = &self.past[self.past.len() / 2..];
        let (n, d) = (recent.len() as f64, self.point.len());
        let mean = recent.iter().sum::<DVector<f64>>() / n;
        let mut covariance = DMatrix::zeros(d, d);
        for point in recent {
            let centred = point - &mean;
            covariance += &centred * centred.transpose() / (n - 1.0);
        }
        for k in 0..d {
            covariance[(k, k)] *= 1.0 + RIDGE;
        }
        // A chain that has not moved keeps its proposal.
        if let Some(root) = Chain::scaled(&covariance) {
            self.root = root;
        }
    }
}

fn normals(rng: &mut Mrg32k3a, count: usize) -> DVector<f64> {
    DVector::from_iterator(count, (0..count).map(|_| rng.normal()))
}
