//! Exact steps of systems that are linear between events, x' = A x + b + c t: no step has an error
//! but that of rounding, so that a step is as long as the distance of two points or knots.
//!
//! A, b and c are read off the right-hand side, of which the system says that it is affine
//! ([`Linearity`]): the Jacobian is A, the values at x = 0 are b + c t. Sensitivities follow by the
//! derivatives of the same step. Lengths that come again have their matrices ready; others, as long
//! as A h is small, are the Taylor series of one solution.

use super::exponential::{Blocks, Propagator, norm};
use super::{Integrator, Problem};
use crate::sim::{Linearity, Residual, Sensitive, SimErrorKind};
use nalgebra::{Complex, DMatrix};
use std::f64::consts::TAU;

/// Lengths whose matrices are kept.
const MOST_LENGTHS: usize = 8;
/// Lengths are equal where they differ by what rounding makes of times: so many last digits.
const SAME_LENGTH: f64 = 4.0 * f64::EPSILON;
/// The norm of A h up to which the series of a solution is as good as matrices.
const SHORT: f64 = 1.0;
/// What its last term is, relative to the first.
const NEGLIGIBLE: f64 = 1e-18;
/// Where something is looked for between points: the first step after an event relative to 1 / norm
/// of A, and the parts of a period of the fastest oscillation that a step is at most.
const FIRST_STEP: f64 = 0.5;
const PARTS_OF_PERIOD: f64 = 8.0;
/// Time constants after which an oscillation has decayed, to 2e-9.
const DECAYED: f64 = 20.0;

/// The method with its workspace.
#[derive(Debug, Default)]
pub(in crate::sim) struct Exact {
    linearity: Linearity,
    n: usize,
    /// A, then its derivatives along the directions where they are not zero.
    matrices: Vec<DMatrix<f64>>,
    /// For each direction the place of its derivative among these.
    places: Vec<Option<usize>>,
    norm: f64,
    /// Eigenvalues of A, where something is looked for between points.
    spectrum: Vec<Complex<f64>>,
    /// Whether A is that of the system at hand.
    is_known: bool,
    /// b and its derivatives at the start of the step, and their changes per second.
    forcing: Vec<f64>,
    rate: Vec<f64>,
    zero: Vec<f64>,
    t: f64,
    t_old: f64,
    /// When the solution was last smooth no longer.
    restarted: f64,
    /// The longest next step, where something is looked for between points.
    longest: f64,
    y: Vec<f64>,
    y_old: Vec<f64>,
    propagators: Vec<Propagator>,
    /// The last length for which there were no matrices.
    missed: f64,
}

impl Exact {
    /// For a system of which this is known.
    pub(in crate::sim) fn begin(&mut self, linearity: Linearity) {
        self.linearity = linearity;
        self.is_known = false;
    }

    /// Reads A and its derivatives off the system at t.
    fn look(&mut self, problem: &mut Problem, t: f64) -> Result<(), SimErrorKind> {
        let n = self.n;
        let pattern = problem.system.pattern().clone();
        let mut entries = vec![0.0; pattern.rows.len()];
        problem.jacobian(t, &self.zero, &mut entries)?;
        let mut a = DMatrix::zeros(n, n);
        for column in 0..n {
            for at in pattern.column(column) {
                a[(pattern.rows[at], column)] = entries[at];
            }
        }
        self.places.clear();
        let mut matrices = vec![a];
        for change in self.changes(problem, t)? {
            let is_zero = change.iter().all(|entry| *entry == 0.0);
            self.places.push((!is_zero).then_some(matrices.len() - 1));
            matrices.extend((!is_zero).then_some(change));
        }
        if !self.is_known || matrices != self.matrices {
            self.propagators.clear();
            self.missed = f64::NAN;
            self.norm = norm(&matrices[0]);
            self.spectrum.clear();
            if self.linearity.is_watched {
                self.spectrum.extend(matrices[0].complex_eigenvalues().iter());
            }
            self.matrices = matrices;
        }
        self.is_known = true;
        Ok(())
    }

    /// The derivatives of A: those of the right-hand side are affine in x as well.
    fn changes(&self, problem: &mut Problem, t: f64) -> Result<Vec<DMatrix<f64>>, SimErrorKind> {
        let (n, m) = (self.n, problem.system.n_directions());
        let mut changes = vec![DMatrix::zeros(n, n); m];
        if m == 0 {
            return Ok(changes);
        }
        let (mut at_zero, mut moved) = (vec![0.0; n * m], vec![0.0; n * m]);
        let mut y = self.zero.clone();
        problem.sensitivity_rhs(t, &y, &mut at_zero)?;
        for column in 0..n {
            y[column] = problem.nominal[column];
            problem.sensitivity_rhs(t, &y, &mut moved)?;
            y[column] = 0.0;
            for (k, change) in changes.iter_mut().enumerate() {
                for row in 0..n {
                    let difference = moved[k * n + row] - at_zero[k * n + row];
                    change[(row, column)] = difference / problem.nominal[column];
                }
            }
        }
        Ok(changes)
    }

    /// b and its derivatives at t.
    fn forcing(&self, problem: &mut Problem, t: f64, out: &mut [f64]) -> Result<(), SimErrorKind> {
        let (values, derivatives) = out.split_at_mut(self.n);
        problem.rhs(t, &self.zero, values)?;
        match derivatives.is_empty() {
            true => Ok(()),
            false => problem.sensitivity_rhs(t, &self.zero, derivatives),
        }
    }

    /// The end of a step that goes to `limit` at most.
    fn end(&self, limit: f64) -> f64 {
        if !self.linearity.is_watched {
            return limit;
        }
        let since = self.t - self.restarted;
        let is_alive = |value: &&Complex<f64>| value.re * since > -DECAYED;
        let fastest = self.spectrum.iter().filter(is_alive).map(|value| value.im.abs());
        let fastest = fastest.fold(f64::MIN_POSITIVE, f64::max);
        let longest = self.longest.min(TAU / PARTS_OF_PERIOD / fastest);
        let rest = limit - self.t;
        match rest / longest {
            parts if parts <= 1.0 => limit,
            parts if parts < 2.0 => self.t + 0.5 * rest,
            _ => self.t + longest,
        }
    }

    /// The matrices of a step of this length, if there are any.
    fn known(&self, length: f64) -> Option<&Propagator> {
        let slack = SAME_LENGTH * self.t.abs().max(self.t_old.abs());
        self.propagators.iter().find(|known| (known.length - length).abs() <= slack)
    }

    fn propagator(&self, length: f64) -> Propagator {
        Propagator::new(&self.matrices[0], &self.matrices[1..], length)
    }

    /// Makes matrices for a step that is too long for a series, or as long as the one before.
    fn prepare(&mut self, length: f64) {
        if self.known(length).is_some() {
            return;
        }
        let slack = SAME_LENGTH * self.t.abs().max(self.t_old.abs());
        let comes_again = (self.missed - length).abs() <= slack;
        self.missed = length;
        if !comes_again && self.norm * length <= SHORT {
            return;
        }
        if self.propagators.len() == MOST_LENGTHS {
            self.propagators.remove(0);
        }
        self.propagators.push(self.propagator(length));
    }

    /// Writes the solution at a distance from the start of the step.
    fn solve(&self, length: f64, out: &mut [f64]) {
        match self.known(length) {
            Some(known) => self.propagate(known, out),
            None if self.norm * length <= SHORT => self.expand(length, out),
            None => self.propagate(&self.propagator(length), out),
        }
    }

    fn propagate(&self, propagator: &Propagator, out: &mut [f64]) {
        let n = self.n;
        out.copy_from_slice(&self.y_old);
        let parts = out.chunks_exact_mut(n).zip(self.y_old.chunks_exact(n));
        let forcing = self.forcing.chunks_exact(n).zip(self.rate.chunks_exact(n));
        let blocks = &propagator.blocks;
        for ((out, y), (b, c)) in parts.zip(forcing) {
            step_by(blocks, [y, b, c], out);
        }
        let [y, b, c] = [&self.y_old, &self.forcing, &self.rate].map(|all| &all[..n]);
        for (place, out) in self.places.iter().zip(out.chunks_exact_mut(n).skip(1)) {
            if let Some(place) = place {
                step_by(&propagator.derivatives[*place], [y, b, c], out);
            }
        }
    }

    /// The Taylor series of the solution.
    fn expand(&self, length: f64, out: &mut [f64]) {
        out.copy_from_slice(&self.y_old);
        let (mut term, mut next) = (vec![0.0; out.len()], vec![0.0; out.len()]);
        self.differentiate(&self.y_old, &mut term);
        for ((term, forcing), out) in term.iter_mut().zip(&self.forcing).zip(out.iter_mut()) {
            *term = length * (*term + forcing);
            *out += *term;
        }
        let (mut k, mut bound) = (1.0, 1.0);
        while bound > NEGLIGIBLE || k < 2.0 {
            k += 1.0;
            bound *= self.norm * length / k;
            self.differentiate(&term, &mut next);
            if k == 2.0 {
                next.iter_mut().zip(&self.rate).for_each(|(next, rate)| *next += length * rate);
            }
            for ((term, next), out) in term.iter_mut().zip(&next).zip(out.iter_mut()) {
                *term = length / k * next;
                *out += *term;
            }
        }
    }

    /// out = A x, and for each direction A s + A' x.
    fn differentiate(&self, y: &[f64], out: &mut [f64]) {
        let n = self.n;
        out.fill(0.0);
        for (out, y) in out.chunks_exact_mut(n).zip(y.chunks_exact(n)) {
            add_product(&self.matrices[0], y, out);
        }
        for (place, out) in self.places.iter().zip(out.chunks_exact_mut(n).skip(1)) {
            if let Some(place) = place {
                add_product(&self.matrices[1 + *place], &y[..n], out);
            }
        }
    }
}

/// out += E x + G b + H c
fn step_by(blocks: &Blocks, [x, b, c]: [&[f64]; 3], out: &mut [f64]) {
    add_product(&blocks.e, x, out);
    add_product(&blocks.g, b, out);
    add_product(&blocks.h, c, out);
}

/// out += M x
fn add_product(m: &DMatrix<f64>, x: &[f64], out: &mut [f64]) {
    for (column, x) in m.as_slice().chunks_exact(x.len()).zip(x) {
        if *x != 0.0 {
            out.iter_mut().zip(column).for_each(|(out, entry)| *out += entry * x);
        }
    }
}

impl Integrator for Exact {
    /// In slides an implicit method takes its place.
    fn is_explicit(&self) -> bool {
        true
    }

    fn restart(&mut self, problem: &mut Problem, t: f64, y: &[f64]) -> Result<(), SimErrorKind> {
        self.n = problem.system.n_differential();
        for vector in [&mut self.y, &mut self.y_old, &mut self.forcing, &mut self.rate] {
            vector.resize(y.len(), 0.0);
        }
        self.zero.clear();
        self.zero.resize(y.len(), 0.0);
        self.y.copy_from_slice(y);
        (self.t, self.t_old, self.restarted) = (t, t, t);
        if !self.is_known || self.linearity.changes_at_events {
            self.look(problem, t)?;
        }
        self.longest = FIRST_STEP / self.norm;
        let mut forcing = std::mem::take(&mut self.forcing);
        let computed = self.forcing(problem, t, &mut forcing);
        self.forcing = forcing;
        computed
    }

    fn step(&mut self, problem: &mut Problem, limit: f64) -> Result<(), SimErrorKind> {
        problem.may_continue()?;
        if !self.is_known {
            self.look(problem, self.t)?;
        }
        let end = self.end(limit);
        let length = end - self.t;
        self.t_old = self.t;
        self.y_old.copy_from_slice(&self.y);
        if self.linearity.varies_in_time {
            let (mut now, mut rate) =
                (std::mem::take(&mut self.forcing), std::mem::take(&mut self.rate));
            let computed = self
                .forcing(problem, self.t, &mut now)
                .and_then(|()| self.forcing(problem, end, &mut rate));
            rate.iter_mut().zip(&now).for_each(|(rate, now)| *rate = (*rate - now) / length);
            (self.forcing, self.rate) = (now, rate);
            computed?;
        } else {
            self.rate.fill(0.0);
        }
        self.prepare(length);
        let mut y = std::mem::take(&mut self.y);
        self.solve(length, &mut y);
        self.y = y;
        self.t = end;
        self.longest *= 2.0;
        problem.note_step(length);
        problem.statistics.exact_steps += 1;
        match self.y.iter().all(|y| y.is_finite()) {
            true => Ok(()),
            false => Err(SimErrorKind::NotFinite),
        }
    }

    fn branches_changed(&mut self) {
        self.is_known = false;
    }

    fn time(&self) -> f64 {
        self.t
    }

    fn state(&self) -> &[f64] {
        &self.y
    }

    fn interpolate(&self, t: f64, y: &mut [f64]) {
        match t == self.t {
            true => y.copy_from_slice(&self.y),
            false => self.solve(t - self.t_old, y),
        }
    }
}
