//! The global Newton method: from where F has no zero nearby to one farther away.
//!
//! ```text
//! F(x) = μ F(x₀), followed from μ = 1 on until μ = 0
//! x' = ∓ sign(det J) J⁻¹ F(x₀) / ‖J⁻¹ F(x₀)‖
//! ```
//!
//! Where the curve turns back (a fold, or a kink between a rising and a falling piece), det J
//! changes its sign and the curve is followed on: a comparator with positive feedback that has left
//! its upper limit goes through its steep piece to its lower limit. Lengths are relative to
//! max(|x₀|, nominal).
//!
//! Reference: [Branin 1972](gapilib_base::bibliography#branin-1972).

use crate::sim::{DenseLu, Equations, Newton};

/// The first step along the curve.
const FIRST_STEP: f64 = 1e-4;
const SMALLEST_STEP: f64 = 1e-10;
/// Beyond this the curve leads nowhere.
const FARTHEST: f64 = 1e9;
const MAX_STEPS: usize = 400;
const MAX_CORRECTIONS: usize = 6;
/// A correction below this part of the step is the last.
const LAST_CORRECTION: f64 = 1e-3;

/// The curve leads to no solution.
#[derive(Debug)]
pub(crate) struct NoSolution;

/// The workspace for systems of one size.
#[derive(Debug, Clone)]
pub(crate) struct Continuation {
    lu: DenseLu,
    /// F(x₀).
    start: Vec<f64>,
    scale: Vec<f64>,
    x: Vec<f64>,
    trial: Vec<f64>,
    /// J⁻¹ F(x) and J⁻¹ F(x₀), scaled.
    delta: Vec<f64>,
    tangent: Vec<f64>,
}

impl Continuation {
    pub fn new(n: usize) -> Continuation {
        let zeros = vec![0.0; n];
        Continuation {
            lu: DenseLu::new(n),
            start: zeros.clone(),
            scale: zeros.clone(),
            x: zeros.clone(),
            trial: zeros.clone(),
            delta: zeros.clone(),
            tangent: zeros,
        }
    }

    /// Replaces x by a solution; `newton` makes the last steps. On failure x is anything.
    pub fn solve(
        &mut self,
        newton: &mut Newton,
        equations: &mut dyn Equations,
        x: &mut [f64],
        nominal: &[f64],
    ) -> Result<(), NoSolution> {
        equations.residual(x, &mut self.start).map_err(|_| NoSolution)?;
        for ((scale, x), nominal) in self.scale.iter_mut().zip(&*x).zip(nominal) {
            *scale = x.abs().max(*nominal);
        }
        for direction in [-1.0, 1.0] {
            self.x.copy_from_slice(x);
            if self.follow(newton, equations, direction, nominal).is_ok() {
                x.copy_from_slice(&self.trial);
                return Ok(());
            }
        }
        Err(NoSolution)
    }

    /// Follows the curve from `x` in one direction; the solution is in `trial`.
    fn follow(
        &mut self,
        newton: &mut Newton,
        equations: &mut dyn Equations,
        direction: f64,
        nominal: &[f64],
    ) -> Result<(), NoSolution> {
        self.trial.copy_from_slice(&self.x);
        let first_sign = self.linearize(equations)?;
        let (mut sign, mut mu, mut step) = (first_sign, 1.0, FIRST_STEP);
        for _ in 0..MAX_STEPS {
            self.trial.copy_from_slice(&self.x);
            let length = norm(&self.tangent) * direction * sign * first_sign;
            for ((x, tangent), scale) in self.trial.iter_mut().zip(&self.tangent).zip(&self.scale) {
                *x += step / length * tangent * scale;
            }
            let reached = self.correct(equations, step);
            let Ok((next_sign, next_mu)) = reached else {
                step *= 0.25;
                if step < SMALLEST_STEP {
                    return Err(NoSolution);
                }
                self.trial.copy_from_slice(&self.x);
                self.linearize(equations)?;
                continue;
            };
            self.x.copy_from_slice(&self.trial);
            if next_mu * mu <= 0.0 {
                let solved = newton.solve(equations, &mut self.trial, nominal).is_ok();
                if solved || newton.solve_undamped(equations, &mut self.trial, nominal).is_ok() {
                    return Ok(());
                }
            }
            if self.x.iter().zip(&self.scale).any(|(x, scale)| x.abs() > FARTHEST * scale) {
                return Err(NoSolution);
            }
            (sign, mu) = (next_sign, next_mu);
            step *= 2.0;
        }
        Err(NoSolution)
    }

    /// Brings `trial` back to the curve; the sign of det J and μ there.
    fn correct(
        &mut self,
        equations: &mut dyn Equations,
        step: f64,
    ) -> Result<(f64, f64), NoSolution> {
        for _ in 0..MAX_CORRECTIONS {
            let sign = self.linearize(equations)?;
            let square: f64 = self.tangent.iter().map(|t| t * t).sum();
            let product: f64 = self.tangent.iter().zip(&self.delta).map(|(t, d)| t * d).sum();
            let mu = product / square;
            self.delta.iter_mut().zip(&self.tangent).for_each(|(d, t)| *d -= mu * t);
            let length = norm(&self.delta);
            if length <= LAST_CORRECTION * step {
                return Ok((sign, mu));
            }
            if length > step || length.is_nan() {
                return Err(NoSolution);
            }
            for ((x, delta), scale) in self.trial.iter_mut().zip(&self.delta).zip(&self.scale) {
                *x -= delta * scale;
            }
        }
        Err(NoSolution)
    }

    /// Computes `delta` and `tangent` at `trial`; the sign of det J.
    fn linearize(&mut self, equations: &mut dyn Equations) -> Result<f64, NoSolution> {
        equations.residual(&self.trial, &mut self.delta).map_err(|_| NoSolution)?;
        equations.jacobian(&self.trial, self.lu.matrix()).map_err(|_| NoSolution)?;
        self.lu.factorize().map_err(|_| NoSolution)?;
        self.tangent.copy_from_slice(&self.start);
        for vector in [&mut self.delta, &mut self.tangent] {
            self.lu.solve(vector);
            vector.iter_mut().zip(&self.scale).for_each(|(value, scale)| *value /= scale);
        }
        let length = norm(&self.tangent);
        if length > 0.0 && length.is_finite() { Ok(self.lu.sign()) } else { Err(NoSolution) }
    }
}

fn norm(vector: &[f64]) -> f64 {
    vector.iter().map(|value| value * value).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::Failure;

    /// A comparator with positive feedback, its output u and its input v:
    /// 3 v = 2 s + u, u = 15 000 v within ±15.
    struct Trigger {
        s: f64,
    }

    impl Equations for Trigger {
        fn residual(&mut self, x: &[f64], out: &mut [f64]) -> Result<(), Failure> {
            out[0] = 3.0 * x[0] - 2.0 * self.s - x[1];
            out[1] = x[1] - (15e3 * x[0]).clamp(-15.0, 15.0);
            Ok(())
        }

        fn jacobian(&mut self, x: &[f64], out: &mut [f64]) -> Result<(), Failure> {
            let gain = if (15e3 * x[0]).abs() < 15.0 { 15e3 } else { 0.0 };
            out.copy_from_slice(&[3.0, -gain, -1.0, 1.0]);
            Ok(())
        }
    }

    fn solved(equations: &mut dyn Equations, start: &[f64]) -> Result<Vec<f64>, NoSolution> {
        let n = start.len();
        let mut x = start.to_vec();
        let nominal = vec![1.0; n];
        let mut newton = Newton::new(n);
        Continuation::new(n).solve(&mut newton, equations, &mut x, &nominal).map(|()| x)
    }

    #[test]
    fn a_comparator_jumps_to_its_other_limit() {
        let mut trigger = Trigger { s: -7.499 };
        let x = solved(&mut trigger, &[0.001, 15.0]).unwrap();
        assert!((x[1] + 15.0).abs() < 1e-9 && (x[0] + 29.998 / 3.0).abs() < 1e-9, "{x:?}");
        trigger.s = 7.6;
        let x = solved(&mut trigger, &[-0.1, -15.0]).unwrap();
        assert!((x[1] - 15.0).abs() < 1e-9, "{x:?}");
    }

    /// The zeros of x³ - 3 x + c lie apart for |c| < 2; else there is one.
    struct Cubic(f64);

    impl Equations for Cubic {
        fn residual(&mut self, x: &[f64], out: &mut [f64]) -> Result<(), Failure> {
            out[0] = x[0] * (x[0] * x[0] - 3.0) + self.0;
            Ok(())
        }

        fn jacobian(&mut self, x: &[f64], out: &mut [f64]) -> Result<(), Failure> {
            out[0] = 3.0 * (x[0] * x[0] - 1.0);
            Ok(())
        }
    }

    #[test]
    fn a_curve_is_followed_around_its_folds() {
        let x = solved(&mut Cubic(2.01), &[1.001]).unwrap();
        assert!(x[0] < -2.0 && (x[0] * (x[0] * x[0] - 3.0) + 2.01).abs() < 1e-9, "{x:?}");
    }

    #[test]
    fn what_has_no_solution_says_so() {
        struct Parabola;
        impl Equations for Parabola {
            fn residual(&mut self, x: &[f64], out: &mut [f64]) -> Result<(), Failure> {
                out[0] = x[0] * x[0] + 1.0;
                Ok(())
            }
            fn jacobian(&mut self, x: &[f64], out: &mut [f64]) -> Result<(), Failure> {
                out[0] = 2.0 * x[0];
                Ok(())
            }
        }
        assert!(solved(&mut Parabola, &[0.7]).is_err());
    }
}
