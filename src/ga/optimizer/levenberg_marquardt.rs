//! Levenberg-Marquardt with bounds: Gauss-Newton steps, damped until they reduce the sum of
//! squares; genes at a bound whose gradient points outwards stand still. A step costs one
//! simulation and, where it is accepted, one Jacobian.
//!
//! References: [Nocedal & Wright 2006](crate::bibliography#nocedal-wright-2006), §10.3;
//! [Nielsen 1999](crate::bibliography#nielsen-1999) (the damping).

use super::{Answers, Method, Optimizer, Setup, Wants, whole};
use crate::diag::Fault;
use crate::ga::Genomes;
use crate::registry::Entry;
use nalgebra::{DMatrix, DVector};

/// The table entry.
pub(super) const ENTRY: Entry<dyn Method> = Entry {
    name: "levenberg_marquardt",
    aliases: &["lm", "levenberg-marquardt"],
    summary: "least squares from one point: the middle of the ranges unless a start is given",
    reference: "nocedal-wright-2006",
    make: |options| {
        Ok(Box::new(LevenbergMarquardt { steps: whole(options, "steps", 1.0..=1e6, 200.0)? }))
    },
};

/// Relative reduction of the sum of squares below which it has converged.
const REDUCTION: f64 = 1e-12;
/// Damping beyond which no step helps.
const LARGEST_DAMPING: f64 = 1e16;

struct LevenbergMarquardt {
    steps: usize,
}

impl Method for LevenbergMarquardt {
    fn start(&self, setup: Setup) -> Result<Box<dyn Optimizer>, Fault> {
        let start = setup.start.unwrap_or_else(|| vec![0.5; setup.genes.len()]);
        Ok(Box::new(Descent::new(start, self.steps)))
    }

    fn needs_residuals(&self) -> bool {
        true
    }

    fn can_be_polished(&self) -> bool {
        false
    }
}

/// What was asked last.
enum Asked {
    Start,
    Jacobian,
    Step,
}

/// One descent.
pub(super) struct Descent {
    x: Vec<f64>,
    fitness: f64,
    residuals: Vec<f64>,
    jacobian: DMatrix<f64>,
    /// Largest column norms so far: the scales of the genes.
    scales: Vec<f64>,
    trial: Vec<f64>,
    damping: f64,
    growth: f64,
    /// Steps left.
    left: usize,
    /// Reductions in a row that hardly mattered.
    small: usize,
    asked: Asked,
    predicted: f64,
    done: bool,
}

impl Descent {
    pub(super) fn new(start: Vec<f64>, steps: usize) -> Descent {
        let n = start.len();
        Descent {
            trial: start.clone(),
            x: start,
            fitness: f64::INFINITY,
            residuals: Vec::new(),
            jacobian: DMatrix::zeros(0, n),
            scales: vec![0.0; n],
            damping: 1e-3,
            growth: 2.0,
            left: steps,
            small: 0,
            asked: Asked::Start,
            predicted: 0.0,
            done: false,
        }
    }

    /// Where it stands.
    pub(super) fn best(&self) -> (&[f64], f64) {
        (&self.x, self.fitness)
    }

    fn take_jacobian(&mut self, answers: &Answers<'_>) {
        let (m, n) = (self.residuals.len(), self.x.len());
        self.jacobian = DMatrix::from_row_slice(m, n, answers.jacobians);
        for (j, mut column) in self.jacobian.column_iter_mut().enumerate() {
            if column.iter().any(|value| !value.is_finite()) {
                column.fill(0.0);
            }
            self.scales[j] = self.scales[j].max(column.norm());
        }
        self.propose();
    }

    /// The next trial; ends when there is none.
    fn propose(&mut self) {
        let n = self.x.len();
        let r = DVector::from_column_slice(&self.residuals);
        let gradient = self.jacobian.tr_mul(&r);
        let free: Vec<usize> = (0..n)
            .filter(|&j| self.scales[j] > 0.0)
            .filter(|&j| {
                !(self.x[j] <= 0.0 && gradient[j] > 0.0 || self.x[j] >= 1.0 && gradient[j] < 0.0)
            })
            .collect();
        loop {
            if free.is_empty() || self.damping > LARGEST_DAMPING || self.left == 0 {
                self.done = true;
                return;
            }
            if self.try_step(&free, &gradient) {
                return;
            }
            self.reject();
        }
    }

    fn try_step(&mut self, free: &[usize], gradient: &DVector<f64>) -> bool {
        let k = free.len();
        let m = self.residuals.len();
        let mut rows = DMatrix::zeros(m + k, k);
        let mut right = DVector::zeros(m + k);
        for (column, &j) in free.iter().enumerate() {
            for row in 0..m {
                rows[(row, column)] = self.jacobian[(row, j)] / self.scales[j];
            }
            rows[(m + column, column)] = self.damping.sqrt();
        }
        for row in 0..m {
            right[row] = -self.residuals[row];
        }
        let qr = rows.qr();
        let Some(step) = qr.r().solve_upper_triangular(&(qr.q().tr_mul(&right))) else {
            return false;
        };
        self.trial.copy_from_slice(&self.x);
        for (column, &j) in free.iter().enumerate() {
            self.trial[j] = (self.x[j] + step[column] / self.scales[j]).clamp(0.0, 1.0);
        }
        let moved = DVector::from_fn(self.x.len(), |j, _| self.trial[j] - self.x[j]);
        let linear = &self.jacobian * &moved;
        self.predicted = -(2.0 * gradient.dot(&moved) + linear.norm_squared());
        let noticeable = moved.amax() > 1e-16;
        if !noticeable {
            self.damping = f64::INFINITY;
        }
        noticeable && self.predicted > 0.0
    }

    fn reject(&mut self) {
        self.damping *= self.growth;
        self.growth *= 2.0;
    }

    fn tell_step(&mut self, answers: &Answers<'_>) {
        self.left = self.left.saturating_sub(1);
        let fitness: f64 = answers.residuals.iter().map(|r| r * r).sum();
        let ratio = (self.fitness - fitness) / self.predicted;
        if !fitness.is_finite() || ratio <= 0.0 {
            let hardly = self.predicted <= REDUCTION * self.fitness;
            self.reject();
            if hardly {
                self.done = true
            } else {
                self.propose()
            }
            self.asked = Asked::Step;
            return;
        }
        let reduction = self.fitness - fitness;
        self.small = if reduction <= REDUCTION.sqrt() * self.fitness { self.small + 1 } else { 0 };
        self.done = reduction <= REDUCTION * self.fitness || self.small >= 8 || fitness == 0.0;
        self.x.copy_from_slice(&self.trial);
        self.residuals = answers.residuals.to_vec();
        self.fitness = fitness;
        self.damping *= (1.0 - (2.0 * ratio - 1.0).powi(3)).max(1.0 / 10.0);
        self.growth = 2.0;
        self.asked = Asked::Jacobian;
    }
}

impl Optimizer for Descent {
    fn ask(&mut self, batch: &mut Genomes) {
        if self.done {
            return;
        }
        match self.asked {
            Asked::Start | Asked::Step => batch.push(&self.trial),
            Asked::Jacobian => batch.push(&self.x),
        }
    }

    fn tell(&mut self, _: &Genomes, answers: &Answers<'_>) {
        match self.asked {
            Asked::Start => {
                self.fitness = answers.residuals.iter().map(|r| r * r).sum();
                self.residuals = answers.residuals.to_vec();
                self.done = !self.fitness.is_finite();
                self.asked = Asked::Step;
                if !self.done {
                    self.take_jacobian(answers);
                }
            }
            Asked::Jacobian => {
                self.asked = Asked::Step;
                self.take_jacobian(answers);
            }
            Asked::Step => self.tell_step(answers),
        }
    }

    fn wants(&self) -> Wants {
        match self.asked {
            Asked::Start | Asked::Jacobian => Wants::Jacobians,
            Asked::Step => Wants::Residuals,
        }
    }

    fn phase(&self) -> &'static str {
        "least squares"
    }
}
