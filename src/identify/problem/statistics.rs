//! What the data tell about the parameters found, and whether the residuals look like noise.
//!
//! With the sensitivities J of the weighted residuals at the best point and their variance
//! s² = Σ r² / (points − parameters), the covariance is s² (JᵀJ)⁻¹ and an interval reaches t s as
//! far as Student's distribution says. Both hold where the model is nearly linear about the best
//! point; a profile says more.
//!
//! References: [Walter & Pronzato 1997](crate::bibliography#walter-pronzato-1997), chapter 5;
//! [Wald & Wolfowitz 1940](crate::bibliography#wald-wolfowitz-1940) (runs).

use super::inseparable::{self, Form, Inseparable, Sensitivities};
use super::{Evaluation, Problem};
use crate::identify::{Uncertainty, uncertainty};

/// A singular value this far below the largest is none, however exact the simulation is, and
/// however inexact.
const RANK: [f64; 2] = [1e-7, 1e-4];
/// Errors of a simulation beyond which a lack of rank must show at several points to be believed.
const EXACT: f64 = 1e-9;

/// What the data tell.
#[derive(Debug, Clone, PartialEq)]
pub struct Statistics {
    /// Deviations and correlations; `None` where they cannot be computed.
    pub uncertainty: Option<Uncertainty>,
    /// Half-widths of the 95 % intervals, as multiples of a deviation.
    pub factor: f64,
    /// Condition number of the sensitivities, columns of unit length.
    pub condition: Option<f64>,
    /// Groups of parameters that only together have an effect.
    pub inseparable: Vec<Inseparable>,
    /// Parameters without any effect on the compared points.
    pub without_effect: Vec<usize>,
    /// Sensitivities of the simulated points by the parameters, column by column.
    pub jacobian: Vec<Vec<f64>>,
    /// Simulations that it took.
    pub simulations: u64,
}

/// Whether residuals in the order of X look like noise.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ResidualTest {
    /// Runs of equal sign.
    pub runs: usize,
    /// How many would be expected.
    pub expected_runs: f64,
    /// Probability of as few or as many runs by chance.
    pub runs_probability: f64,
    /// Correlation of neighbours.
    pub autocorrelation: f64,
}

impl Statistics {
    /// Computes them at `values`, where the simulated points are `simulated`. `others`: points
    /// elsewhere in the search space, which tell how far a lack of rank goes.
    pub fn at(
        problem: &Problem,
        evaluation: &Evaluation,
        values: &[f64],
        simulated: &[f64],
        others: &[Vec<f64>],
    ) -> Statistics {
        let measured: Vec<f64> =
            problem.series.iter().flat_map(|series| series.y.clone()).collect();
        let ones = vec![1.0; measured.len()];
        let scales = evaluation.scales().unwrap_or(&ones);
        let (jacobian, mut simulations) = sensitivities(problem, evaluation, values);
        let weighted = weighted(&jacobian, scales);
        let residuals: Vec<f64> = measured
            .iter()
            .zip(simulated)
            .zip(scales)
            .map(|((m, s), scale)| scale * (m - s))
            .collect();
        let freedom = residuals.len().saturating_sub(values.len());
        let uncertainty = uncertainty(&weighted, &residuals);
        let best = Sensitivities { values: values.to_vec(), columns: weighted };
        let tolerance = problem.noise.powf(2.0 / 3.0).clamp(RANK[0], RANK[1]);
        let mut rank = inseparable::rank(&best, &[], tolerance);
        if !rank.inseparable.is_empty() {
            let elsewhere = elsewhere(problem, evaluation, others, scales, &mut simulations);
            rank = inseparable::rank(&best, &elsewhere, tolerance);
            rank.inseparable.retain(|group| problem.noise < EXACT || group.form != Form::Local);
        }
        Statistics {
            uncertainty,
            factor: student_quantile(freedom),
            condition: rank.condition,
            inseparable: rank.inseparable,
            without_effect: rank.without_effect,
            jacobian,
            simulations,
        }
    }
}

fn weighted(jacobian: &[Vec<f64>], scales: &[f64]) -> Vec<Vec<f64>> {
    let column =
        |column: &Vec<f64>| column.iter().zip(scales).map(|(j, s)| j * s).collect::<Vec<f64>>();
    jacobian.iter().map(column).collect()
}

/// The sensitivities at other points, as far as these can be simulated.
fn elsewhere(
    problem: &Problem,
    evaluation: &Evaluation,
    others: &[Vec<f64>],
    scales: &[f64],
    simulations: &mut u64,
) -> Vec<Sensitivities> {
    let mut found = Vec::new();
    for (values, simulated) in others.iter().zip(evaluation.simulate_all(others)) {
        *simulations += 1;
        if simulated.is_err() {
            continue;
        }
        let (jacobian, took) = sensitivities(problem, evaluation, values);
        *simulations += took;
        let columns = weighted(&jacobian, scales);
        if columns.iter().flatten().all(|value| value.is_finite()) {
            found.push(Sensitivities { values: values.clone(), columns });
        }
    }
    found
}

/// Derivatives of the simulated points, column by column, and the simulations that they took.
fn sensitivities(
    problem: &Problem,
    evaluation: &Evaluation,
    values: &[f64],
) -> (Vec<Vec<f64>>, u64) {
    let n = values.len();
    match evaluation.linearize(problem, &[values.to_vec()]).pop() {
        Some(Ok(found)) => {
            let column = |k: usize| found.derivatives.iter().skip(k).step_by(n).copied().collect();
            ((0..n).map(column).collect(), found.simulations)
        }
        _ => (vec![vec![f64::NAN; problem.n_points()]; n], 1),
    }
}

/// The tests of residuals in their order; `None` for fewer than three.
pub fn residual_test(residuals: &[f64]) -> Option<ResidualTest> {
    let n = residuals.len();
    if n < 3 {
        return None;
    }
    let signs: Vec<bool> = residuals.iter().map(|r| *r >= 0.0).collect();
    let runs = 1 + signs.windows(2).filter(|pair| pair[0] != pair[1]).count();
    let above = signs.iter().filter(|sign| **sign).count() as f64;
    let below = n as f64 - above;
    let count = n as f64;
    let expected = 1.0 + 2.0 * above * below / count;
    let variance = (expected - 1.0) * (expected - 2.0) / (count - 1.0);
    let z = if variance > 0.0 { (runs as f64 - expected) / variance.sqrt() } else { 0.0 };
    let mean = residuals.iter().sum::<f64>() / count;
    let square: f64 = residuals.iter().map(|r| (r - mean).powi(2)).sum();
    let neighbours: f64 =
        residuals.windows(2).map(|pair| (pair[0] - mean) * (pair[1] - mean)).sum();
    Some(ResidualTest {
        runs,
        expected_runs: expected,
        runs_probability: 2.0 * (1.0 - normal_distribution(z.abs())),
        autocorrelation: if square > 0.0 { neighbours / square } else { 0.0 },
    })
}

/// The standard normal distribution function for z ≥ 0, to 1e-7 (a rational approximation of the
/// complementary error function).
fn normal_distribution(z: f64) -> f64 {
    let t = 1.0 / (1.0 + 0.231_641_9 * z);
    let series = [0.319_381_530, -0.356_563_782, 1.781_477_937, -1.821_255_978, 1.330_274_429];
    let sum = series.iter().rev().fold(0.0, |sum, c| (sum + c) * t);
    1.0 - (-0.5 * z * z).exp() / std::f64::consts::TAU.sqrt() * sum
}

/// The 97.5 % quantile of Student's distribution; NaN without any freedom.
pub fn student_quantile(freedom: usize) -> f64 {
    let z = 1.959_963_984_540_054_f64;
    match freedom {
        0 => f64::NAN,
        1 => 12.706_204_736_432_1,
        2 => 4.302_652_729_696_14,
        _ => {
            // Expansion in 1/ν about the normal quantile.
            let v = freedom as f64;
            let (z3, z5, z7, z9) = (z.powi(3), z.powi(5), z.powi(7), z.powi(9));
            z + (z3 + z) / (4.0 * v)
                + (5.0 * z5 + 16.0 * z3 + 3.0 * z) / (96.0 * v * v)
                + (3.0 * z7 + 19.0 * z5 + 17.0 * z3 - 15.0 * z) / (384.0 * v.powi(3))
                + (79.0 * z9 + 776.0 * z7 + 1482.0 * z5 - 1920.0 * z3 - 945.0 * z)
                    / (92_160.0 * v.powi(4))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_of_the_tables() {
        for (freedom, expected) in [(3, 3.182), (5, 2.571), (10, 2.228), (24, 2.064), (1000, 1.962)]
        {
            assert!((student_quantile(freedom) - expected).abs() < 4e-3, "{freedom}");
        }
        assert!((normal_distribution(1.96) - 0.975_002).abs() < 1e-6);
    }

    #[test]
    fn waves_are_no_noise() {
        let wave: Vec<f64> = (0..60).map(|k| (f64::from(k) / 10.0).sin()).collect();
        let test = residual_test(&wave).unwrap();
        assert_eq!(test.runs, 2);
        assert!(test.runs_probability < 1e-6 && test.autocorrelation > 0.9);
        let mut rng = crate::ga::Mrg32k3a::new(&[12345.0; 6]).unwrap();
        let noise: Vec<f64> = (0..60).map(|_| rng.normal()).collect();
        assert!(residual_test(&noise).unwrap().runs_probability > 0.01);
    }
}
