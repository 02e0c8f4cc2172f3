//! Targets whose moments are known: normal, twisted normal, and the posteriors of a straight line.

use super::super::infer;
use super::super::tests::{finished, noise, problem, student_quantile};
use super::*;
use crate::problem::{Evaluation, Sigma};

fn chains(
    target: fn(&[f64]) -> f64,
    covariance: &DMatrix<f64>,
    draws: usize,
) -> Vec<Vec<Vec<f64>>> {
    let source = Mrg32k3a::new(&[12345.0; 6]).unwrap();
    let n = covariance.nrows();
    let one = |k: u64| {
        let mut target = |u: &[f64]| target(u);
        let rng = source.substream(k);
        let mut chain = Chain::new(&vec![0.0; n], covariance, rng, &mut target).unwrap();
        chain.warm_up(WARM_UP, &mut target);
        chain.draw(draws, &mut target);
        assert!((0.1..0.9).contains(&chain.drawn.acceptance()), "{}", chain.drawn.acceptance());
        chain.drawn.draws
    };
    (0..CHAINS as u64).map(one).collect()
}

fn column(chains: &[Vec<Vec<f64>>], f: impl Fn(&[f64]) -> f64) -> Vec<Vec<f64>> {
    chains.iter().map(|chain| chain.iter().map(|draw| f(draw)).collect()).collect()
}

/// Mean, and its distance from `expected` in Monte Carlo standard errors.
fn distance(chains: &[Vec<f64>], expected: f64) -> f64 {
    let all: Vec<f64> = chains.concat();
    let mean = all.iter().sum::<f64>() / all.len() as f64;
    let variance = all.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / all.len() as f64;
    (mean - expected) / (variance / diagnostics::bulk_ess(chains)).sqrt()
}

#[test]
fn a_normal_target_has_its_moments() {
    // Standard deviations 1 and 3, correlation 0.9.
    let target = |u: &[f64]| {
        let (a, b) = (u[0], u[1] / 3.0);
        -0.5 * (a * a - 1.8 * a * b + b * b) / (1.0 - 0.81)
    };
    let found = chains(target, &DMatrix::identity(2, 2), 4000);
    for k in 0..2 {
        let own = column(&found, |u| u[k]);
        assert!(diagnostics::r_hat(&own) < 1.01);
        assert!(distance(&own, 0.0).abs() < 4.0);
    }
    for (f, expected) in [
        ((|u| u[0] * u[0]) as fn(&[f64]) -> f64, 1.0),
        (|u| u[1] * u[1], 9.0),
        (|u| u[0] * u[1], 2.7),
    ] {
        assert!(distance(&column(&found, f), expected).abs() < 4.0, "{expected}");
    }
}

/// x normal with standard deviation 2, y = z + 0.5 (x² − 4) with z standard normal: the mean of y
/// is 0, its variance 1 + 0.25·2·16 = 9, the covariance 0.
#[test]
fn a_banana_has_its_moments() {
    let target = |u: &[f64]| {
        let z = u[1] - 0.5 * (u[0] * u[0] - 4.0);
        -0.125 * u[0] * u[0] - 0.5 * z * z
    };
    let found = chains(target, &DMatrix::identity(2, 2), 16_000);
    for (f, expected) in [
        ((|u| u[0]) as fn(&[f64]) -> f64, 0.0),
        (|u| u[1], 0.0),
        (|u| u[0] * u[0], 4.0),
        (|u| u[1] * u[1], 9.0),
        (|u| u[0] * u[1], 0.0),
    ] {
        let own = column(&found, f);
        assert!(distance(&own, expected).abs() < 4.0, "{expected}");
        assert!(diagnostics::r_hat(&own) < 1.02, "{}", diagnostics::r_hat(&own));
    }
}

fn line(p: &[f64], x: f64) -> f64 {
    p[0] + p[1] * x
}

/// A straight line through 8 points; the run and the slope with its standard error for variance 1.
fn fitted(known: bool, threads: usize, samples: usize) -> (Run, f64) {
    let x: Vec<f64> = (0..8).map(f64::from).collect();
    let y: Vec<f64> = x.iter().zip(noise(8)).map(|(x, e)| 1.0 + 0.5 * x + 0.1 * e).collect();
    let mut problem = problem(line, &x, &y, &[[-10.0, 10.0], [-10.0, 10.0]]);
    if known {
        problem.series[0].sigma = Sigma::Given(vec![0.1; 8]);
    }
    problem.inference.posterior = Some(PosteriorSettings { samples });
    let mut run = finished(problem);
    run.evaluation = Evaluation::new(&run.problem, threads).unwrap();
    (run, (1.0_f64 / 42.0).sqrt())
}

/// With sigma known the posterior of the slope is normal; unknown it is Student's, as wide as the
/// confidence interval.
#[test]
fn posteriors_of_a_straight_line_are_exact() {
    for known in [true, false] {
        let (run, unit) = fitted(known, 2, 8000);
        let best = run.observed.best.as_ref().unwrap().values.clone();
        let local = Local::at(&run.problem, &run.evaluation, &best).unwrap();
        let half = match known {
            true => 1.959_964 * 0.1 * unit,
            false => student_quantile(6) * local.variance.sqrt() * unit,
        };
        let posterior = infer(&run).unwrap().posterior.unwrap();
        assert!(posterior.converged, "{:?}", posterior.parameters);
        let slope = &posterior.parameters[1];
        let [low, _, median, _, high] = slope.quantiles;
        // The error of a 2.5 % quantile of 2000 independent draws is about 4 % of its distance.
        assert!((median - best[1]).abs() < 0.06 * half, "{known}");
        assert!(((high - best[1]) / half - 1.0).abs() < 0.12, "{known} {} {half}", high - best[1]);
        assert!(((best[1] - low) / half - 1.0).abs() < 0.12, "{known} {} {half}", best[1] - low);
        assert!(
            posterior.sentences()[0].contains("R-hat at most 1.00"),
            "{:?}",
            posterior.sentences()
        );
    }
}

/// A range that ends within the posterior acts as a prior: the report names the end. One that ends ten
/// standard errors away is not mentioned.
#[test]
fn a_posterior_that_its_range_cuts_says_so() {
    let x: Vec<f64> = (0..8).map(f64::from).collect();
    let y: Vec<f64> = x.iter().zip(noise(8)).map(|(x, e)| 1.0 + 0.5 * x + 0.1 * e).collect();
    for (end, is_cut) in [(0.5, true), (0.3, false)] {
        let mut problem = problem(line, &x, &y, &[[-10.0, 10.0], [end, 10.0]]);
        problem.series[0].sigma = Sigma::Given(vec![0.1; 8]);
        problem.inference.posterior = Some(PosteriorSettings { samples: 4000 });
        let posterior = infer(&finished(problem)).unwrap().posterior.unwrap();
        let text = posterior.sentences().join("\n");
        assert!(posterior.converged, "{text}");
        let words = format!("The posterior of p1 is cut by the end {end} of its search range");
        assert_eq!(text.contains(&words), is_cut, "{text}");
        assert!(!text.contains("posterior of p0"), "{text}");
    }
}

#[test]
fn threads_do_not_matter() {
    let bytes = |threads| {
        let (run, _) = fitted(true, threads, 1000);
        let found = infer(&run).unwrap();
        (serde_json::to_string(&found).unwrap(), found.posterior.unwrap().csv())
    };
    assert_eq!(bytes(1), bytes(3));
}

#[test]
fn chains_on_a_ridge_have_not_converged() {
    let product: fn(&[f64], f64) -> f64 = |p, x| p[0] * p[1] * x;
    let x: Vec<f64> = (1..9).map(f64::from).collect();
    let y: Vec<f64> = x.iter().zip(noise(8)).map(|(x, e)| 6.0 * x + 0.01 * e).collect();
    let mut problem = problem(product, &x, &y, &[[0.1, 100.0], [0.1, 100.0]]);
    problem.inference.posterior = Some(PosteriorSettings { samples: 500 });
    let posterior = infer(&finished(problem)).unwrap().posterior.unwrap();
    assert!(!posterior.converged);
    let sentence = &posterior.sentences()[0];
    assert!(sentence.starts_with("The chains did not converge after 500 draws each"), "{sentence}");
}
