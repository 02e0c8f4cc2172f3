//! Jacobians of the simulated points by the parameters: exact where the simulator integrates
//! sensitivity equations, else central differences at a tightened tolerance of the solver.
//!
//! The differences are taken in the coordinate that is searched (the value or its logarithm). With
//! a relative error ε of the simulation the step is ε^(1/3) of the size of the value, which
//! balances the errors of simulation and truncation (both about ε^(2/3)). Beside a bound, and beside
//! points that cannot be simulated, the derivative is that of the parabola through three points on
//! one side.
//!
//! Reference: [Nocedal & Wright 2006](gapilib_base::bibliography#nocedal-wright-2006), §8.1.

use super::{Evaluation, Failed, Free, Linearization, NOISE_OF_FORMULAS, Problem};
use crate::elementary;

/// The tolerance of the solver counts times this while differences are taken. Chosen, not
/// measured.
const TIGHTER: f64 = 0.01;
/// Steps are relative to the value, but not to less than this part of the range.
const SMALLEST: f64 = 1e-4;
/// Limits of the relative step.
const STEPS: [f64; 2] = [1e-6, 1e-2];

/// Which points beside a value are compared.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Side {
    Both,
    Above,
    Below,
}

/// Coordinates of the points of a difference, and what each simulation is multiplied with.
struct Stencil {
    place: usize,
    parameter: usize,
    side: Side,
    coordinates: [f64; 3],
    weights: [f64; 3],
}

impl Evaluation {
    /// The simulated points and their derivatives at several places, given by values of the
    /// parameters; an error where the simulation fails.
    pub fn linearize(
        &self,
        problem: &Problem,
        places: &[Vec<f64>],
    ) -> Vec<Result<Linearization, Failed>> {
        self.linearize_scaled(problem, places, 1.0)
    }

    /// The same with the tolerance of the solver times `factor`.
    pub(super) fn linearize_scaled(
        &self,
        problem: &Problem,
        places: &[Vec<f64>],
        factor: f64,
    ) -> Vec<Result<Linearization, Failed>> {
        let mut found = self.linearize_unscaled(problem, places, factor);
        if let Some(relative) = self.relative() {
            for own in found.iter_mut().flatten() {
                let scaled = self.scaled_best(relative, &own.simulated);
                relative.scale_derivatives(&scaled, &mut own.derivatives);
                own.shares = relative.project(&scaled, &own.simulated, &mut own.derivatives);
                relative.apply(&scaled, &mut own.simulated);
            }
        }
        found
    }

    /// The same as the model has them, without scales and offsets of relative data.
    pub(super) fn linearize_unscaled(
        &self,
        problem: &Problem,
        places: &[Vec<f64>],
        factor: f64,
    ) -> Vec<Result<Linearization, Failed>> {
        let mut found = self.exact_all(places, factor);
        let without_derivatives: Vec<usize> = (0..places.len())
            .filter(|&k| matches!(&found[k], Ok(own) if own.derivatives.is_empty()))
            .collect();
        if without_derivatives.is_empty() {
            return found;
        }
        let n = problem.parameters.len();
        for &k in &without_derivatives {
            if let Ok(own) = &mut found[k] {
                own.derivatives = vec![f64::NAN; own.simulated.len() * n];
            }
        }
        let mut open: Vec<Stencil> = without_derivatives
            .iter()
            .flat_map(|&k| (0..n).map(move |j| (k, j)))
            .map(|(k, j)| Stencil::first(problem, k, j, &places[k]))
            .collect();
        while !open.is_empty() {
            open = self.differences((problem, factor), places, &open, &mut found);
        }
        found
    }

    /// Carries out differences; those that must be taken on another side.
    fn differences(
        &self,
        (problem, factor): (&Problem, f64),
        places: &[Vec<f64>],
        stencils: &[Stencil],
        found: &mut [Result<Linearization, Failed>],
    ) -> Vec<Stencil> {
        let n = problem.parameters.len();
        let mut points = Vec::new();
        for stencil in stencils {
            let free = &problem.parameters[stencil.parameter];
            for (coordinate, _) in stencil.points() {
                let mut point = places[stencil.place].clone();
                point[stencil.parameter] = free.value_at_coordinate(coordinate);
                points.push(point);
            }
        }
        let mut rows = self.simulate_unscaled(&points, factor * tightening(problem)).into_iter();
        let mut again = Vec::new();
        for stencil in stencils {
            let own: Vec<_> = rows.by_ref().take(stencil.points().count()).collect();
            let Ok(into) = &mut found[stencil.place] else { continue };
            into.simulations += own.len() as u64;
            if own.iter().any(Result::is_err) {
                again.extend(stencil.next(problem, &places[stencil.place]));
                continue;
            }
            let derivative = problem.parameters[stencil.parameter]
                .coordinate_derivative(places[stencil.place][stencil.parameter]);
            for point in 0..into.simulated.len() {
                let parts = own.iter().flatten().zip(stencil.points());
                let sum: f64 = parts.map(|(row, (_, weight))| weight * row[point]).sum();
                into.derivatives[point * n + stencil.parameter] = sum * derivative;
            }
        }
        again
    }
}

impl Stencil {
    fn first(problem: &Problem, place: usize, parameter: usize, values: &[f64]) -> Stencil {
        let made = |side| Stencil::on(side, problem, place, parameter, values);
        made(Side::Both)
            .or_else(|| made(Side::Above))
            .or_else(|| made(Side::Below))
            .unwrap_or_else(|| unreachable!("a range is wider than two steps"))
    }

    /// What is tried after this failed.
    fn next(&self, problem: &Problem, values: &[f64]) -> Option<Stencil> {
        let made = |side| Stencil::on(side, problem, self.place, self.parameter, values);
        match self.side {
            Side::Both => made(Side::Above).or_else(|| made(Side::Below)),
            Side::Above => made(Side::Below),
            Side::Below => None,
        }
    }

    /// `None` where points would lie outside the range.
    fn on(
        side: Side,
        problem: &Problem,
        place: usize,
        parameter: usize,
        values: &[f64],
    ) -> Option<Stencil> {
        let free = &problem.parameters[parameter];
        let [low, high] = [free.min, free.max].map(|value| free.coordinate(value));
        let at = free.coordinate(values[parameter]);
        let step = step(problem, free, at).min(0.25 * (high - low));
        let [far, near] = match side {
            Side::Both => [at - step, at + step],
            Side::Above => [at + 2.0 * step, at + step],
            Side::Below => [at - 2.0 * step, at - step],
        };
        if far.min(near) < low || far.max(near) > high {
            return None;
        }
        // The steps as they are after rounding.
        let [a, b] = [far - at, near - at];
        let (coordinates, weights) = match side {
            Side::Both => ([far, near, at], [-1.0 / (near - far), 1.0 / (near - far), 0.0]),
            _ => {
                let [far_weight, near_weight] = [-b / (a * (a - b)), a / (b * (a - b))];
                ([far, near, at], [far_weight, near_weight, -far_weight - near_weight])
            }
        };
        Some(Stencil { place, parameter, side, coordinates, weights })
    }

    /// The points to simulate; the middle one has no weight where both sides are compared.
    fn points(&self) -> impl Iterator<Item = (f64, f64)> {
        let count = if self.side == Side::Both { 2 } else { 3 };
        self.coordinates.into_iter().zip(self.weights).take(count)
    }
}

/// What the tolerance of the solver is multiplied with.
fn tightening(problem: &Problem) -> f64 {
    if problem.noise > NOISE_OF_FORMULAS { TIGHTER } else { 1.0 }
}

/// The step in the coordinate that is searched.
fn step(problem: &Problem, free: &Free, at: f64) -> f64 {
    let relative = elementary::cbrt(problem.noise * tightening(problem)).clamp(STEPS[0], STEPS[1]);
    match free.logarithmic {
        true => relative,
        false => relative * at.abs().max(SMALLEST * (free.max - free.min)),
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{decay, problem};
    use super::*;

    fn exact(p: &[f64], x: f64) -> [f64; 2] {
        let e = (-p[1] * x).exp();
        [e, -p[0] * x * e]
    }

    #[test]
    fn differences_are_the_derivatives_also_at_bounds_and_beside_failures() {
        // `decay` fails where the sum is below 1, so that below (0.3, 0.7) there is nothing.
        for (values, digits) in
            [([2.0, 0.7], 1e-9), ([0.1, 10.0], 1e-7), ([10.0, 0.1], 1e-7), ([0.3, 0.7], 1e-7)]
        {
            let mut problem = problem("genetic", decay, &[2.0, 0.7], &[0.0; 12]);
            for logarithmic in [true, false] {
                problem.parameters.iter_mut().for_each(|free| free.logarithmic = logarithmic);
                let evaluation = Evaluation::new(&problem, 2).unwrap();
                let found = evaluation.linearize(&problem, &[values.to_vec()]).remove(0).unwrap();
                assert!(!found.exact && found.simulations >= 5, "{found:?}");
                for (k, x) in problem.series[0].x.iter().enumerate() {
                    for (j, exact) in exact(&values, *x).iter().enumerate() {
                        let error = (found.derivatives[2 * k + j] - exact).abs();
                        assert!(
                            error <= digits * (1.0 + exact.abs()),
                            "{values:?} {x} {j} {error}"
                        );
                    }
                }
            }
        }
    }
}
