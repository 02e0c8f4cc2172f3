//! Against the closed form of linear regression, and of the intervals themselves.

use super::super::tests::{finished, noise, problem};
use super::super::{Inferred, infer};
use super::*;

fn line(p: &[f64], x: f64) -> f64 {
    p[0] + p[1] * x
}

fn bootstrapped(resampling: Resampling, interval: IntervalKind, threads: usize) -> (Inferred, f64) {
    let x: Vec<f64> = (0..20).map(f64::from).collect();
    let y: Vec<f64> = x.iter().zip(noise(20)).map(|(x, e)| 1.0 + 0.5 * x + 0.1 * e).collect();
    let mut problem = problem(line, &x, &y, &[[-10.0, 10.0], [-10.0, 10.0]]);
    problem.inference.bootstrap = Some(BootstrapSettings { samples: 1000, resampling, interval });
    let mut run = finished(problem);
    if threads > 1 {
        run.evaluation = crate::problem::Evaluation::new(&run.problem, threads).unwrap();
    }
    let best = run.observed.best.as_ref().unwrap().values.clone();
    let square: f64 = x.iter().zip(&y).map(|(x, y)| (y - line(&best, *x)).powi(2)).sum();
    let sxx: f64 = x.iter().map(|x| (x - 9.5).powi(2)).sum();
    (infer(&run).unwrap(), (square / 18.0 / sxx).sqrt())
}

/// The standard deviation of 1000 replicates is that of the estimate within 1/√2000 = 2 % (one
/// standard error); cases differ by the leverage of the points.
#[test]
fn spread_of_the_replicates_is_the_standard_error() {
    for (resampling, within) in
        [(Resampling::Residuals, 0.09), (Resampling::Parametric, 0.09), (Resampling::Cases, 0.25)]
    {
        let (found, error) = bootstrapped(resampling, IntervalKind::Percentile, 1);
        let found = found.bootstrap.unwrap();
        let slope = &found.parameters[1];
        assert!((slope.sd / error - 1.0).abs() < within, "{resampling:?}: {} {error}", slope.sd);
        let width = slope.interval[1] - slope.interval[0];
        assert!((width / (3.92 * error) - 1.0).abs() < 2.0 * within, "{resampling:?}");
        assert!(slope.bias.abs() < 0.15 * error && found.failed == 0);
    }
}

/// A parameter that half of the replicates put at the end of its range has no quantiles that mean
/// anything (Andrews 2000), and the other one has an interval.
#[test]
fn at_an_end_of_its_range_a_parameter_has_no_bootstrap_interval() {
    let x: Vec<f64> = (0..20).map(f64::from).collect();
    let y: Vec<f64> = x.iter().zip(noise(20)).map(|(x, e)| 1.0 - 0.006 * x + 0.1 * e).collect();
    for (low, is_cut) in [(0.0, true), (-10.0, false)] {
        let mut problem = problem(line, &x, &y, &[[-10.0, 10.0], [low, 10.0]]);
        problem.inference.bootstrap = Some(BootstrapSettings {
            samples: 200,
            resampling: Resampling::Residuals,
            interval: IntervalKind::Percentile,
        });
        let found = infer(&finished(problem)).unwrap().bootstrap.unwrap();
        let sentences = found.sentences();
        assert!(sentences[1].starts_with("p0 in "), "{sentences:?}");
        let words = if is_cut { "p1 has no interval: " } else { "p1 in " };
        assert!(sentences[2].starts_with(words), "{sentences:?}");
    }
}

#[test]
fn threads_do_not_matter() {
    let bytes = |threads| {
        let (found, _) = bootstrapped(Resampling::Residuals, IntervalKind::Bca, threads);
        (serde_json::to_string(&found).unwrap(), found.bootstrap.unwrap().csv())
    };
    assert_eq!(bytes(1), bytes(3));
}

/// Percentiles of 0, 1, … 1000, of which 400 lie below the estimate: the levels of BCa were
/// computed with scipy.stats.norm.
#[test]
fn intervals_follow_their_definitions() {
    let ordered: Vec<f64> = (0..=1000).map(f64::from).collect();
    let close = |found: [f64; 2], expected: [f64; 2]| {
        let good = found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-6);
        assert!(good, "{found:?} {expected:?}");
    };
    close(interval(IntervalKind::Percentile, &ordered, 400.0, 0.1), [25.0, 975.0]);
    close(interval(IntervalKind::Basic, &ordered, 400.0, 0.1), [-175.0, 775.0]);
    close(
        interval(IntervalKind::Bca, &ordered, 400.0, 0.1),
        [19.353552057560897, 964.2210086138631],
    );
}
