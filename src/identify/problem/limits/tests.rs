//! Minima at limits against the solution on paper.

use super::super::inference::{Adjustments, adjust};
use super::super::tests::problem;
use super::super::{EndingKind, Run, Solution, Stop, conclude};
use super::*;
use std::sync::Arc;

const NOISE: [f64; 12] = [0.3, -0.2, 0.1, 0.25, -0.3, 0.05, -0.15, 0.2, -0.1, 0.0, -0.25, 0.15];

fn line(p: &[f64], x: f64) -> f64 {
    p[0] + p[1] * x
}

/// A straight line a + b x with a + b at most 2.5, where the unconstrained minimum has 2.7: the
/// minimum along the limit is that of the one slope b of y - 2.5 over x - 1.
#[test]
fn a_line_at_the_limit_of_its_parameters_is_the_textbook_slope() {
    let mut own = problem("genetic", line, &[2.0, 0.7], &NOISE);
    let sides = |p: &[f64]| [p[0] + p[1], 2.5];
    let constraints = vec![Constraint::new("a + b <= 2.5", Arc::new(sides))];
    adjust(&mut own, Adjustments { constraints, ..Adjustments::default() }).unwrap();
    own.stop = Stop { evaluations: Some(20_000), ..Stop::default() };
    let points: Vec<(f64, f64)> =
        own.series[0].x.iter().zip(&own.series[0].y).map(|(x, y)| (*x, *y)).collect();
    let mut run = Run::new(own, 1).unwrap();
    while run.stop().is_none() {
        run.step(0.0);
    }
    conclude(&mut run);
    let solution = Solution::of(&run, "done", Vec::new()).unwrap();
    assert_eq!(solution.outcome.ending.kind, EndingKind::Minimum, "{:?}", solution.outcome.ending);
    let square: f64 = points.iter().map(|(x, _)| (x - 1.0) * (x - 1.0)).sum();
    let slope: f64 = points.iter().map(|(x, y)| (x - 1.0) * (y - 2.5)).sum::<f64>() / square;
    let found = solution.parameters[1].value;
    assert!((found - slope).abs() < 1e-4 * slope, "{found} {slope}");
    for parameter in &solution.parameters {
        assert!(parameter.deviation.is_none() && parameter.interval.is_none());
        assert!(parameter.verdict.is_none());
    }
}
