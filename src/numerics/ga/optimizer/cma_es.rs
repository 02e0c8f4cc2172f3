//! CMA-ES: normally distributed individuals whose covariance follows the successful steps.
//! Bounds by reflection; when it has converged it starts again with twice the population.
//!
//! References: [Hansen 2016](gapilib_base::bibliography#hansen-2016) (the formulas),
//! [Auger & Hansen 2005](gapilib_base::bibliography#auger-hansen-2005) (restarts).

use super::{Answers, Method, Optimizer, Setup, has_failed};
use crate::diag::Fault;
use crate::elementary;
use crate::ga::{Genomes, Mrg32k3a, order};
use crate::registry::Entry;
use nalgebra::{DMatrix, DVector};

/// The table entry.
pub(crate) const ENTRY: Entry<dyn Method> = Entry {
    name: "cma_es",
    aliases: &["cmaes", "cma-es"],
    summary: "covariance matrix adaptation evolution strategy, restarted with a larger population",
    reference: "hansen-2016",
    make: |options| {
        Ok(Box::new(CmaEs {
            population: options.take_whole("population", 0.0..=1e6, 0.0)?,
            sigma: options.take("sigma", 1e-6..=1.0, 0.2)?,
            restarts: options.take_whole("restarts", 0.0..=100.0, 9.0)?,
        }))
    },
};

/// A step below this, in the unit cube, is convergence.
const SMALLEST_STEP: f64 = 1e-16;
/// Generations over which the best must change, relative to itself.
const FLAT: f64 = 1e-13;
/// Largest ratio of the axes of the distribution, squared.
const LARGEST_CONDITION: f64 = 1e14;

struct CmaEs {
    /// 0 for 4 + 3 ln n.
    population: usize,
    sigma: f64,
    restarts: usize,
}

impl Method for CmaEs {
    fn start(&self, setup: Setup) -> Result<Box<dyn Optimizer>, Fault> {
        let n = setup.genes.len();
        let size = if self.population == 0 {
            4 + (3.0 * elementary::ln(n as f64)) as usize
        } else {
            self.population
        };
        let mean = setup.start.unwrap_or_else(|| vec![0.5; n]);
        let distribution = Distribution::new(&mean, self.sigma, size.max(4));
        let (sigma, left) = (self.sigma, self.restarts);
        Ok(Box::new(CmaEsRun {
            rng: setup.rng,
            distribution,
            sigma,
            left,
            done: false,
            raw: Vec::new(),
        }))
    }
}

struct CmaEsRun {
    rng: Mrg32k3a,
    distribution: Distribution,
    sigma: f64,
    /// Restarts left.
    left: usize,
    done: bool,
    /// The individuals asked, before reflection: the fitness continues beyond the bounds as its
    /// mirror image, so that the steps stay those of the distribution.
    raw: Vec<DVector<f64>>,
}

/// The distribution of one start, with the letters of the reference.
struct Distribution {
    size: usize,
    /// Of the better half, which moves the mean; their sum is 1.
    weights: Vec<f64>,
    /// Of the worse half, not above 0: the distribution shrinks in their directions.
    unlikely: Vec<f64>,
    mu_eff: f64,
    cc: f64,
    cs: f64,
    c1: f64,
    cmu: f64,
    damps: f64,
    chi_n: f64,
    mean: DVector<f64>,
    sigma: f64,
    c: DMatrix<f64>,
    b: DMatrix<f64>,
    d: DVector<f64>,
    pc: DVector<f64>,
    ps: DVector<f64>,
    generation: u64,
    decomposed: u64,
    best: Vec<f64>,
}

impl Distribution {
    fn new(mean: &[f64], sigma: f64, size: usize) -> Distribution {
        let n = mean.len() as f64;
        let raw: Vec<f64> = (0..size)
            .map(|k| elementary::ln((size as f64 + 1.0) / 2.0) - elementary::ln(k as f64 + 1.0))
            .collect();
        let (above, below) = raw.split_at(size / 2);
        let effective = |raw: &[f64]| {
            elementary::powi(raw.iter().sum::<f64>(), 2) / raw.iter().map(|w| w * w).sum::<f64>()
        };
        let (mu_eff, mu_below) = (effective(above), effective(below));
        let cs = (mu_eff + 2.0) / (n + mu_eff + 5.0);
        let c1 = 2.0 / (elementary::powi(n + 1.3, 2) + mu_eff);
        let cmu = (2.0 * (0.25 + mu_eff + 1.0 / mu_eff - 2.0)
            / (elementary::powi(n + 2.0, 2) + mu_eff))
            .min(1.0 - c1);
        let sum = |raw: &[f64]| raw.iter().map(|w| w.abs()).sum::<f64>();
        // The covariance stays positive definite however bad the worst are.
        let negative = (1.0 + c1 / cmu)
            .min(1.0 + 2.0 * mu_below / (mu_eff + 2.0))
            .min((1.0 - c1 - cmu) / (n * cmu));
        let weights = above.iter().map(|w| w / sum(above)).collect();
        let unlikely = below.iter().map(|w| negative * w / sum(below)).collect();
        let m = mean.len();
        Distribution {
            size,
            weights,
            unlikely,
            mu_eff,
            cc: (4.0 + mu_eff / n) / (n + 4.0 + 2.0 * mu_eff / n),
            cs,
            c1,
            cmu,
            damps: 1.0 + 2.0 * (((mu_eff - 1.0) / (n + 1.0)).sqrt() - 1.0).max(0.0) + cs,
            chi_n: n.sqrt() * (1.0 - 1.0 / (4.0 * n) + 1.0 / (21.0 * n * n)),
            mean: DVector::from_column_slice(mean),
            sigma,
            c: DMatrix::identity(m, m),
            b: DMatrix::identity(m, m),
            d: DVector::repeat(m, 1.0),
            pc: DVector::zeros(m),
            ps: DVector::zeros(m),
            generation: 0,
            decomposed: 0,
            best: Vec::new(),
        }
    }

    fn sample(&self, rng: &mut Mrg32k3a) -> DVector<f64> {
        let z = DVector::from_fn(self.mean.len(), |j, _| self.d[j] * rng.normal());
        &self.mean + (&self.b * z) * self.sigma
    }

    fn update(&mut self, ranked: &[&DVector<f64>], best: f64) {
        let old = self.mean.clone();
        self.mean.fill(0.0);
        for (x, &w) in ranked.iter().zip(&self.weights) {
            self.mean.axpy(w, x, 1.0);
        }
        let y = (&self.mean - &old) / self.sigma;
        let mut white = self.b.tr_mul(&y);
        white.component_div_assign(&self.d);
        let factor = (self.cs * (2.0 - self.cs) * self.mu_eff).sqrt();
        self.ps = &self.ps * (1.0 - self.cs) + (&self.b * white) * factor;
        self.generation += 1;
        let n = self.mean.len() as f64;
        let faded = 1.0 - elementary::powi(1.0 - self.cs, 2 * self.generation.min(1 << 20) as i32);
        let stalled = self.ps.norm() / faded.sqrt() / self.chi_n >= 1.4 + 2.0 / (n + 1.0);
        let h = if stalled { 0.0 } else { 1.0 };
        let factor = h * (self.cc * (2.0 - self.cc) * self.mu_eff).sqrt();
        self.pc = &self.pc * (1.0 - self.cc) + &y * factor;
        let lost = (1.0 - h) * self.cc * (2.0 - self.cc);
        let all: f64 = self.weights.iter().chain(&self.unlikely).sum();
        let keep = 1.0 - self.c1 - self.cmu * all + self.c1 * lost;
        self.c.ger(self.c1, &self.pc, &self.pc, keep);
        for (x, &w) in ranked.iter().zip(&self.weights) {
            let step = (*x - &old) / self.sigma;
            self.c.ger(self.cmu * w, &step, &step, 1.0);
        }
        for (x, &w) in ranked[self.weights.len()..].iter().zip(&self.unlikely) {
            let step = (*x - &old) / self.sigma;
            let mut white = self.b.tr_mul(&step);
            white.component_div_assign(&self.d);
            let length = n / white.norm_squared().max(f64::MIN_POSITIVE);
            self.c.ger(self.cmu * w * length, &step, &step, 1.0);
        }
        self.sigma *=
            elementary::exp((self.cs / self.damps) * (self.ps.norm() / self.chi_n - 1.0)).min(10.0);
        self.best.push(best);
        let lazy = (1.0 / (self.c1 + self.cmu) / n / 10.0) as u64;
        if self.generation - self.decomposed > lazy {
            self.decompose();
        }
    }

    fn decompose(&mut self) {
        self.decomposed = self.generation;
        self.c.fill_lower_triangle_with_upper_triangle();
        let eigen = self.c.clone().symmetric_eigen();
        self.b = eigen.eigenvectors;
        self.d = eigen.eigenvalues.map(|value| value.max(1e-300).sqrt());
    }

    fn has_converged(&self) -> bool {
        let n = self.mean.len();
        let spread =
            (0..n).map(|j| self.c[(j, j)].abs().sqrt().max(self.pc[j].abs())).fold(0.0, f64::max);
        let condition = elementary::powi(self.d.max() / self.d.min(), 2);
        let window = 10 + 30 * n / self.size;
        let flat = self.best.len() > window && {
            let recent = &self.best[self.best.len() - window..];
            let low = recent.iter().copied().fold(f64::INFINITY, f64::min);
            let high = recent.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            high - low <= FLAT * high.abs()
        };
        !self.sigma.is_finite()
            || self.sigma * spread < SMALLEST_STEP
            || condition > LARGEST_CONDITION
            || flat
    }
}

impl Optimizer for CmaEsRun {
    fn ask(&mut self, batch: &mut Genomes) {
        if self.done {
            return;
        }
        self.raw.clear();
        for _ in 0..self.distribution.size {
            let x = self.distribution.sample(&mut self.rng);
            batch.push(x.map(reflected).as_slice());
            self.raw.push(x);
        }
    }

    fn tell(&mut self, batch: &Genomes, answers: &Answers<'_>) {
        let fitness: Vec<f64> = (0..batch.len()).map(|k| answers.fitness(k)).collect();
        let ranks = order(&fitness);
        let ranked: Vec<&DVector<f64>> = ranks.iter().map(|&k| &self.raw[k]).collect();
        self.distribution.update(&ranked, fitness[ranks[0]]);
        let hopeless = has_failed(fitness[ranks[0]]) && self.distribution.generation > 20;
        if self.distribution.has_converged() || hopeless {
            self.restart();
        }
    }

    fn phase(&self) -> &'static str {
        "search"
    }

    fn rescale(&mut self, gene: usize, offset: f64, scale: f64) {
        let distribution = &mut self.distribution;
        distribution.mean[gene] = (offset + scale * distribution.mean[gene]).clamp(0.0, 1.0);
    }
}

impl CmaEsRun {
    fn restart(&mut self) {
        if self.left == 0 {
            self.done = true;
            return;
        }
        self.left -= 1;
        let n = self.distribution.mean.len();
        let mean: Vec<f64> = (0..n).map(|_| self.rng.uniform()).collect();
        self.distribution = Distribution::new(&mean, self.sigma, 2 * self.distribution.size);
    }
}

/// Folded back into 0..1 at both ends.
fn reflected(value: f64) -> f64 {
    let folded = value.rem_euclid(2.0);
    if folded > 1.0 { 2.0 - folded } else { folded }
}
