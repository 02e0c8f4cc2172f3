//! Intervals of fits to two outputs with correlated errors, whose covariance is estimated.

use super::tests::problem;
use super::{Joint, LIKELIHOOD, Run, Sigma, Solution, likelihood};

/// Two outputs, one after the other: the second one at times that are larger by this.
const SECOND: f64 = 100.0;
const TRUTH: [f64; 3] = [0.6, 1.5, 2.0];

fn outputs(p: &[f64], x: f64) -> f64 {
    match x < SECOND {
        true => p[1] * (-p[0] * x).exp(),
        false => p[2] * (1.0 - (-p[0] * (x - SECOND)).exp()),
    }
}

/// A fit to outputs with these errors.
fn fitted(errors: &[[f64; 2]]) -> Solution {
    let n = errors.len();
    let mut problem = problem("levenberg_marquardt", outputs, &TRUTH, &vec![0.0; 2 * n]);
    problem.polish = false;
    let x: Vec<f64> = (1..=n).map(|k| 6.0 * k as f64 / n as f64).collect();
    let first = problem.series.remove(0);
    for member in 0..2 {
        let mut own = first.clone();
        let moved = |x: &f64| x + SECOND * member as f64;
        own.y_name = ["a", "b"][member].into();
        own.y = x.iter().zip(errors).map(|(x, e)| outputs(&TRUTH, moved(x)) + e[member]).collect();
        own.x.clone_from(&x);
        own.sigma = Sigma::Shared(format!("all {member}"));
        own.joint = Some(Joint { group: "all".into(), member, correlations: None });
        problem.series.push(own);
    }
    problem.objectives =
        vec![(LIKELIHOOD.into(), likelihood(&problem.series, problem.noise).ok().unwrap())];
    let places: Vec<f64> = x.iter().copied().chain(x.iter().map(|x| x + SECOND)).collect();
    problem.simulator =
        Box::new(move || Ok(Box::new(super::tests::Formula(places.clone(), outputs))));
    let mut run = Run::new(problem, 1).unwrap();
    while run.stop().is_none() {
        run.step(0.0);
    }
    Solution::of(&run, "done", Vec::new()).unwrap()
}

/// With the factor of one output, N/(N - p), these intervals contain the truth in 89 to 92 % of the sets.
#[test]
fn intervals_cover_the_truth_with_an_estimated_covariance() {
    const SETS: usize = 300;
    let mut rng = crate::ga::Mrg32k3a::new(&[12345.0; 6]).unwrap();
    let mut covered = [0; 3];
    for _ in 0..SETS {
        let errors: Vec<[f64; 2]> = (0..14)
            .map(|_| {
                let [one, other] = [rng.normal(), rng.normal()];
                [0.05 * one, 0.1 * (0.8 * one + 0.6 * other)]
            })
            .collect();
        let solution = fitted(&errors);
        for ((own, truth), count) in solution.parameters.iter().zip(TRUTH).zip(&mut covered) {
            let [low, high] = own.interval.unwrap();
            *count += usize::from(low < truth && truth < high);
        }
    }
    // Within three standard errors of 95 %.
    let is_right = |count: &usize| (274..=296).contains(count);
    assert!(covered.iter().all(is_right), "{covered:?} of {SETS}");
}
