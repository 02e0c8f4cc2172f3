//! Nelder-Mead with coefficients that suit the number of genes; trial points outside the cube are
//! put on its surface. A simplex that has become small starts once more, larger, at the best.
//!
//! Reference: [Gao & Han 2012](gapilib_base::bibliography#gao-han-2012).

use super::{Answers, Method, Optimizer, Setup, key};
use crate::diag::Fault;
use crate::ga::Genomes;
use crate::registry::Entry;

/// The table entry.
pub(crate) const ENTRY: Entry<dyn Method> = Entry {
    name: "nelder_mead",
    aliases: &["simplex", "nelder-mead"],
    summary: "downhill simplex from one point: does not need a smooth fitness",
    reference: "gao-han-2012",
    make: |options| Ok(Box::new(NelderMead { size: options.take("size", 1e-6..=1.0, 0.15)? })),
};

/// A simplex smaller than this has converged.
const SMALLEST: f64 = 1e-10;
/// How often it starts again.
const RESTARTS: usize = 2;

struct NelderMead {
    size: f64,
}

impl Method for NelderMead {
    fn start(&self, setup: Setup) -> Result<Box<dyn Optimizer>, Fault> {
        let start = setup.start.unwrap_or_else(|| vec![0.5; setup.genes.len()]);
        let corners = simplex(&start, self.size);
        Ok(Box::new(NelderMeadRun {
            size: self.size,
            corners,
            trial: Vec::new(),
            reflected: None,
            asked: Request::All,
            restarts: RESTARTS,
        }))
    }
}

#[derive(Clone, Copy, PartialEq)]
enum Request {
    All,
    Reflection,
    Expansion,
    /// Towards the reflected point, or towards the worst corner.
    Contraction,
    Shrinking,
    Nothing,
}

struct NelderMeadRun {
    size: f64,
    /// Corners with their fitness; sorted before a reflection.
    corners: Vec<(Vec<f64>, f64)>,
    trial: Vec<f64>,
    reflected: Option<(Vec<f64>, f64)>,
    asked: Request,
    restarts: usize,
}

fn simplex(start: &[f64], size: f64) -> Vec<(Vec<f64>, f64)> {
    let mut corners = vec![(start.to_vec(), f64::INFINITY)];
    for j in 0..start.len() {
        let mut corner = start.to_vec();
        corner[j] =
            if corner[j] + size <= 1.0 { corner[j] + size } else { (corner[j] - size).max(0.0) };
        corners.push((corner, f64::INFINITY));
    }
    corners
}

impl Optimizer for NelderMeadRun {
    fn ask(&mut self, batch: &mut Genomes) {
        match self.asked {
            Request::Nothing => {}
            Request::All => self.corners.iter().for_each(|corner| batch.push(&corner.0)),
            Request::Shrinking => self.corners[1..].iter().for_each(|corner| batch.push(&corner.0)),
            _ => batch.push(&self.trial),
        }
    }

    fn tell(&mut self, batch: &Genomes, answers: &Answers<'_>) {
        let first = usize::from(self.asked == Request::Shrinking);
        match self.asked {
            Request::All | Request::Shrinking => {
                for k in 0..batch.len() {
                    self.corners[first + k].1 = key(answers.fitness(k));
                }
                self.reflect();
            }
            _ => self.judge(key(answers.fitness(0))),
        }
    }

    fn phase(&self) -> &'static str {
        "simplex"
    }
}

impl NelderMeadRun {
    /// The point on the line from the worst corner through the middle of the others; 1 is the
    /// reflection.
    fn along(&self, factor: f64) -> Vec<f64> {
        let n = self.corners.len() - 1;
        let worst = &self.corners[n].0;
        let middle = |j: usize| self.corners[..n].iter().map(|c| c.0[j]).sum::<f64>() / n as f64;
        (0..n).map(|j| (middle(j) + factor * (middle(j) - worst[j])).clamp(0.0, 1.0)).collect()
    }

    fn reflect(&mut self) {
        self.corners.sort_by(|a, b| a.1.total_cmp(&b.1));
        let best = &self.corners[0].0;
        let distance = |corner: &(Vec<f64>, f64)| {
            corner.0.iter().zip(best).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
        };
        if self.corners.iter().map(distance).fold(0.0, f64::max) < SMALLEST {
            return self.restart();
        }
        self.trial = self.along(1.0);
        self.asked = Request::Reflection;
    }

    fn restart(&mut self) {
        if self.restarts == 0 {
            self.asked = Request::Nothing;
            return;
        }
        self.restarts -= 1;
        self.corners = simplex(&self.corners[0].0, self.size);
        self.asked = Request::All;
    }

    fn judge(&mut self, fitness: f64) {
        let n = self.corners.len() - 1;
        let (best, second, worst) = (self.corners[0].1, self.corners[n - 1].1, self.corners[n].1);
        let found = (self.trial.clone(), fitness);
        match self.asked {
            Request::Reflection if fitness < best => {
                self.trial = self.along(1.0 + 2.0 / n as f64);
                self.reflected = Some(found);
                self.asked = Request::Expansion;
            }
            Request::Reflection if fitness < second => self.accept(found),
            Request::Reflection => {
                let factor = 0.75 - 0.5 / n as f64;
                self.trial = self.along(if fitness < worst { factor } else { -factor });
                self.reflected = (fitness < worst).then_some(found);
                self.asked = Request::Contraction;
            }
            Request::Expansion => {
                let better = match self.reflected.take() {
                    Some(reflected) if reflected.1 <= fitness => reflected,
                    _ => found,
                };
                self.accept(better);
            }
            _ => {
                let limit = self.reflected.take().map_or(worst, |reflected| reflected.1);
                if fitness < limit { self.accept(found) } else { self.shrink() }
            }
        }
    }

    fn accept(&mut self, corner: (Vec<f64>, f64)) {
        let n = self.corners.len() - 1;
        self.corners[n] = corner;
        self.reflect();
    }

    fn shrink(&mut self) {
        let factor = (1.0 - 1.0 / (self.corners.len() - 1) as f64).max(0.5);
        let best = self.corners[0].0.clone();
        for corner in &mut self.corners[1..] {
            for (value, best) in corner.0.iter_mut().zip(&best) {
                *value = best + factor * (*value - best);
            }
        }
        self.asked = Request::Shrinking;
    }
}
