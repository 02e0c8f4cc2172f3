//! A loop of one unknown that Newton's method does not solve from the guess, as its residual is flat
//! there: the density at a pressure, from a guess between those of the liquid and of the vapour.
//!
//! The residual is evaluated farther and farther from the guess on both sides, and towards zero, until
//! it has the opposite sign; the interval is halved, and Newton's method makes the last steps. A sign
//! that changes at a pole or a jump does not count.

use crate::elementary::powi;
use crate::sim::{Equations, Newton};

/// The nearest points lie so many halvings of max(|x₀|, nominal) from the guess, the farthest so many
/// doublings.
const NEAREST: i32 = 6;
const FARTHEST: i32 = 10;
/// Of another branch beside a turning point, which may be near: the first point lies so many halvings
/// away. Those of a cooling coil whose valve follows its own outlet lie 1e-3 of the flow apart.
const NEXT_BRANCH: i32 = 20;
/// Towards zero: x₀/2, x₀/4, …
const MAX_HALVINGS: i32 = 40;
/// After these many halvings of the interval Newton's method makes the last steps.
const HALVINGS_BEFORE_NEWTON: usize = 20;
/// As many bits as a number has.
const MOST_HALVINGS: usize = 60;
/// At a continuous zero the residual is smaller than this part of that at the guess.
const LARGEST_RESIDUAL: f64 = 1e-9;

/// The sign does not change, or not at a solution.
#[derive(Debug, PartialEq)]
pub(super) struct NoBracket;

/// Replaces x by a solution; on failure x is anything.
pub(super) fn solve_bracketed(
    newton: &mut Newton,
    equations: &mut dyn Equations,
    x: &mut [f64],
    nominal: &[f64],
) -> Result<(), NoBracket> {
    let ([guess], [nominal_of_x]) = (&*x, nominal) else { return Err(NoBracket) };
    let guess = *guess;
    let at_guess = residual(equations, guess).ok_or(NoBracket)?;
    let scale = guess.abs().max(*nominal_of_x);
    let beside = |side: f64| move |k: i32| guess + side * scale * powi(2.0, k);
    let towards_zero = |k: i32| guess * powi(2.0, -k);
    let ways: [&mut dyn Iterator<Item = f64>; 3] = [
        &mut (1..=MAX_HALVINGS).map(towards_zero),
        &mut (-NEAREST..=FARTHEST).map(beside(1.0)),
        &mut (-NEAREST..=FARTHEST).map(beside(-1.0)),
    ];
    for points in ways {
        let mut inner = guess;
        for outer in points {
            let Some(value) = residual(equations, outer) else { break };
            if value * at_guess > 0.0 {
                inner = outer;
                continue;
            }
            if halved(newton, equations, x, nominal, [inner, outer], at_guess).is_ok() {
                return Ok(());
            }
            break;
        }
    }
    Err(NoBracket)
}

/// Replaces x by the solution nearest to it, where Newton's method stays in the valley that a turning
/// point has left; on failure x is anything.
pub(super) fn solve_next_branch(
    newton: &mut Newton,
    equations: &mut dyn Equations,
    x: &mut [f64],
    nominal: &[f64],
) -> Result<(), NoBracket> {
    let ([guess], [nominal_of_x]) = (&*x, nominal) else { return Err(NoBracket) };
    let guess = *guess;
    let at_guess = residual(equations, guess).ok_or(NoBracket)?;
    let scale = guess.abs().max(*nominal_of_x);
    // The last point on each side at which the residual has the sign that it has at the guess.
    let mut sides = [(1.0, Some(guess)), (-1.0, Some(guess))];
    for k in -NEXT_BRANCH..=FARTHEST {
        for (side, last) in &mut sides {
            let Some(inner) = *last else { continue };
            let outer = guess + *side * scale * powi(2.0, k);
            *last =
                residual(equations, outer).filter(|value| value * at_guess > 0.0).map(|_| outer);
            if last.is_none()
                && halved(newton, equations, x, nominal, [inner, outer], at_guess).is_ok()
            {
                return Ok(());
            }
        }
    }
    Err(NoBracket)
}

/// Looks for the solution in an interval; at its first end the residual has the sign of `at_guess`.
fn halved(
    newton: &mut Newton,
    equations: &mut dyn Equations,
    x: &mut [f64],
    nominal: &[f64],
    [mut inner, mut outer]: [f64; 2],
    at_guess: f64,
) -> Result<(), NoBracket> {
    for halving in 0..MOST_HALVINGS {
        let middle = inner + (outer - inner) / 2.0;
        if halving >= HALVINGS_BEFORE_NEWTON {
            x.fill(middle);
            let is_solved = newton.solve(equations, x, nominal).is_ok();
            let [low, high] = if inner < outer { [inner, outer] } else { [outer, inner] };
            if is_solved && x.iter().all(|x| (low..=high).contains(x)) {
                return Ok(());
            }
        }
        match residual(equations, middle) {
            Some(value) if value * at_guess > 0.0 => inner = middle,
            Some(_) => outer = middle,
            None => return Err(NoBracket),
        }
    }
    x.fill(outer);
    match residual(equations, outer) {
        Some(value) if value.abs() <= LARGEST_RESIDUAL * at_guess.abs() => Ok(()),
        _ => Err(NoBracket),
    }
}

fn residual(equations: &mut dyn Equations, x: f64) -> Option<f64> {
    let mut value = [f64::NAN];
    equations.residual(&[x], &mut value).ok()?;
    value[0].is_finite().then_some(value[0])
}

#[cfg(test)]
mod tests {
    use super::{NoBracket, solve_bracketed, solve_next_branch};
    use crate::sim::{Equations, Failure, Newton};

    struct Function<F>(F);

    impl<F: Fn(f64) -> [f64; 2]> Equations for Function<F> {
        fn residual(&mut self, x: &[f64], out: &mut [f64]) -> Result<(), Failure> {
            out[0] = self.0(x[0])[0];
            Ok(())
        }
        fn jacobian(&mut self, x: &[f64], out: &mut [f64]) -> Result<(), Failure> {
            out[0] = self.0(x[0])[1];
            Ok(())
        }
    }

    fn solved(function: impl Fn(f64) -> [f64; 2], guess: f64) -> Result<f64, NoBracket> {
        let mut x = [guess];
        solve_bracketed(&mut Newton::new(1), &mut Function(function), &mut x, &[1.0])?;
        Ok(x[0])
    }

    #[test]
    fn a_solution_beyond_a_flat_part_is_found() {
        let pressure = |d: f64| match d {
            d if d < 5.0 => [0.4 * d - 1.0, 0.4],
            d if d < 600.0 => [1.0, 0.0],
            d => [10.0 * (d - 600.0) + 1.0, 10.0],
        };
        assert!((solved(pressure, 227.0).expect("a solution") - 2.5).abs() < 1e-9);
        assert!((solved(|x| [x + 3.0, 1.0], 0.0).expect("a solution") + 3.0).abs() < 1e-9);
    }

    /// The residual of a cooling coil as it was sampled: two solutions have met at 1, where its
    /// derivative jumps, the next one is at 1.00024, a valley without one at 1.0155, and it jumps at 1.0225.
    #[test]
    fn the_branch_beside_a_turning_point_is_found() {
        let coil = |y: f64| match y - 1.0 {
            s if s < 0.0 => [2e-4 - 540.0 * s, -540.0],
            s if s < 3e-4 => [2e-4 + 80.0 * s * (1.0 - s / 2.3e-4), 80.0 * (1.0 - s / 1.15e-4)],
            s if s < 0.01 => [-7.1e-3 - 2.8 * (s - 3e-4), -2.8],
            s if s < 0.0225 => [-0.0213 - 440.0 * (s - 0.0155).powi(2), -880.0 * (s - 0.0155)],
            _ => [2e-4 - y, -1.0],
        };
        let next = |function: &dyn Fn(f64) -> [f64; 2], guess| {
            let mut x = [guess];
            let newton = &mut Newton::new(1);
            solve_next_branch(newton, &mut Function(function), &mut x, &[1.0]).map(|()| x[0])
        };
        let found = next(&coil, 1.0).expect("a solution");
        assert!((found - 1.000_232_48).abs() < 1e-8, "{found}");
        // The nearest one is taken, on whichever side it is.
        let three = |x: f64| [(x - 1.0) * (x - 2.0) * (x - 4.0), 0.0];
        assert_eq!(next(&three, 1.9).map(|x| (x - 2.0).abs() < 1e-9), Ok(true));
        assert_eq!(next(&three, 3.7).map(|x| (x - 4.0).abs() < 1e-9), Ok(true));
        assert_eq!(next(&three, 1.2).map(|x| (x - 1.0).abs() < 1e-9), Ok(true));
        assert_eq!(next(&|x| [x * x + 1.0, 2.0 * x], 1.0), Err(NoBracket));
    }

    #[test]
    fn a_pole_or_a_jump_is_no_solution() {
        assert_eq!(
            solved(|x| [1.0 / (x - 3.0), -1.0 / ((x - 3.0) * (x - 3.0))], 1.0),
            Err(NoBracket)
        );
        assert_eq!(solved(|x| [if x < 3.0 { -1.0 } else { 1.0 }, 0.0], 1.0), Err(NoBracket));
        assert_eq!(solved(|x| [x * x + 1.0, 2.0 * x], 1.0), Err(NoBracket));
    }
}
