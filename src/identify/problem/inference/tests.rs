//! Against linear regression in closed form, and against fits to data that hold what was planned.

use super::*;
use crate::fitness::FITNESSES;
use crate::ga::optimizer::METHODS;
use crate::problem::{
    Failed, Free, Problem, Series, Sigma, Simulate, Statistics, Stop, distributions,
};
use crate::registry::{self, Options};

/// y = f(parameters, x).
pub(super) type Function = fn(&[f64], f64) -> f64;

/// Simulates functions at points.
pub(super) struct Formula(pub Vec<(Function, Vec<f64>)>);

impl Simulate for Formula {
    fn simulate(&mut self, parameters: &[f64], out: &mut [f64]) -> Result<(), Failed> {
        let all = self.0.iter().flat_map(|(function, x)| x.iter().map(move |x| (function, x)));
        for (value, (function, x)) in out.iter_mut().zip(all) {
            *value = function(parameters, *x);
        }
        Ok(())
    }
}

/// Predicts the measured function and others over 0 to `end`.
struct Formulas {
    measured: Function,
    others: Vec<(&'static str, Function)>,
    end: f64,
}

impl Predict for Formulas {
    fn curves(&self, _: &[Vec<f64>], request: &CurveRequest<'_>) -> Result<Curves, Fault> {
        let range = if let Reach::Range(range) = request.reach { range } else { [0.0, self.end] };
        let last = (request.points - 1) as f64;
        let place = |k: usize| range[0] + (range[1] - range[0]) * k as f64 / last;
        let points: Vec<f64> = (0..request.points).map(place).collect();
        let curve = |name: &str, series| Curve {
            experiment: "a".into(),
            y: [name.to_owned(), "V".into()],
            x: ["x".into(), "A".into()],
            points: points.clone(),
            series,
            is_over_frequency: false,
            in_proportion_to: 0..0,
        };
        let mut curves = vec![curve("y", Some(0))];
        let mut functions = vec![(self.measured, points.clone())];
        for (name, function) in &self.others {
            if request.variables.iter().any(|requested| requested == name) {
                curves.push(curve(name, None));
                functions.push((*function, points.clone()));
            }
        }
        Ok(Curves { curves, simulator: Box::new(Formula(functions)), refusals: Vec::new() })
    }
}

/// The 97.5 % quantile of Student's distribution.
pub(super) fn student_quantile(freedom: usize) -> f64 {
    distributions::student_quantile(0.975, freedom as f64)
}

/// Noise of mean square near 1, always the same.
pub(super) fn noise(n: usize) -> Vec<f64> {
    let mut rng = crate::ga::Mrg32k3a::new(&[12345.0; 6]).unwrap();
    (0..n).map(|_| rng.normal()).collect()
}

pub(super) fn problem(function: Function, x: &[f64], y: &[f64], ranges: &[[f64; 2]]) -> Problem {
    let free = |(k, range): (usize, &[f64; 2])| {
        Free::new(format!("p{k}"), "V", *range, Some(false), None).unwrap()
    };
    let series = Series {
        experiment: "a".into(),
        y_name: "y".into(),
        y_unit: "V".into(),
        x_name: "x".into(),
        x_unit: "A".into(),
        file: "twin".into(),
        x: x.to_vec(),
        y: y.to_vec(),
        weight: 1.0,
        role: Default::default(),
        relative: Vec::new(),
        sigma: Sigma::Unknown,
        law: crate::fitness::Law::Normal,
        censored: Vec::new(),
        column: "y".into(),
        x_column: String::new(),
        rows: Vec::new(),
        missing: Vec::new(),
        scaling: Default::default(),
        joint: None,
    };
    let sse = registry::find("fitness", FITNESSES, "sse").unwrap();
    let entry = registry::find("method", METHODS, "levenberg_marquardt").unwrap();
    let x = x.to_vec();
    Problem {
        title: "a test".into(),
        model: "M".into(),
        text: String::new(),
        descriptions: crate::Descriptions::default(),
        parameters: ranges.iter().enumerate().map(free).collect(),
        series: vec![series],
        objectives: vec![("sse".into(), (sse.make)(&mut Options::default()).unwrap())],
        method_name: "levenberg_marquardt".into(),
        method: (entry.make)(&mut Options::default()).unwrap(),
        polish: false,
        seed: [12345.0; 6],
        stop: Stop { evaluations: Some(2000), ..Stop::default() },
        noise: 1e-15,
        inference: Inference::default(),
        simulator: Box::new(move || Ok(Box::new(Formula(vec![(function, x.clone())])))),
    }
}

pub(super) fn finished(problem: Problem) -> Run {
    let mut run = Run::new(problem, 2).unwrap();
    while run.stop().is_none() {
        run.step(0.0);
    }
    run
}

fn line(p: &[f64], x: f64) -> f64 {
    p[0] + p[1] * x
}

#[test]
fn bands_of_a_straight_line_are_those_of_the_textbook() {
    let x: Vec<f64> = (0..12).map(f64::from).collect();
    let y: Vec<f64> = x.iter().zip(noise(12)).map(|(x, e)| 1.0 + 0.5 * x + 0.1 * e).collect();
    let mut problem = problem(line, &x, &y, &[[-10.0, 10.0], [-10.0, 10.0]]);
    let twice: Function = |p, x| 2.0 * line(p, x);
    let predict = Formulas { measured: line, others: vec![("twice", twice)], end: 15.0 };
    problem.inference.predict = Some(Box::new(predict));
    problem.inference.bands = true;
    problem.inference.band_variables = vec!["twice".into()];
    let found = infer(&finished(problem)).unwrap();
    // Least squares in closed form.
    let (n, mean) = (12.0, 5.5);
    let sxx: f64 = x.iter().map(|x| (x - mean).powi(2)).sum();
    let sxy: f64 = x.iter().zip(&y).map(|(x, y)| (x - mean) * y).sum();
    let b = sxy / sxx;
    let a = y.iter().sum::<f64>() / n - b * mean;
    let ssr: f64 = x.iter().zip(&y).map(|(x, y)| (y - a - b * x).powi(2)).sum();
    let s2 = ssr / (n - 2.0);
    let t = student_quantile(10);
    assert_eq!(found.bands.len(), 2);
    for point in &found.bands[0].points {
        let leverage = 1.0 / n + (point.x - mean).powi(2) / sxx;
        let expected = [t * (s2 * leverage).sqrt(), t * (s2 * (1.0 + leverage)).sqrt()];
        let computed = [point.confidence.unwrap(), point.prediction.unwrap()];
        assert!((point.y - a - b * point.x).abs() < 1e-8);
        for (computed, expected) in computed.iter().zip(expected) {
            assert!((computed - expected).abs() < 1e-6 * expected, "{computed} {expected}");
        }
    }
    for (one, two) in found.bands[0].points.iter().zip(&found.bands[1].points) {
        let ratio = two.confidence.unwrap() / one.confidence.unwrap();
        assert!((ratio - 2.0).abs() < 1e-6 && two.prediction.is_none());
    }
    let sentence = found.bands[1].sentence().unwrap();
    assert!(
        sentence.starts_with("twice of a, which was not measured, is known to ±0."),
        "{sentence}"
    );
}

#[test]
fn what_the_data_leave_open_has_no_band() {
    let product: Function = |p, x| p[0] * p[1] * x;
    let x: Vec<f64> = (1..9).map(f64::from).collect();
    let y: Vec<f64> = x.iter().zip(noise(8)).map(|(x, e)| 6.0 * x + 0.1 * e).collect();
    let mut problem = problem(product, &x, &y, &[[0.1, 10.0], [0.1, 10.0]]);
    let first: Function = |p, x| p[0] + x;
    let predict = Formulas { measured: product, others: vec![("first", first)], end: 8.0 };
    problem.inference.predict = Some(Box::new(predict));
    problem.inference.bands = true;
    problem.inference.band_variables = vec!["first".into()];
    let found = infer(&finished(problem)).unwrap();
    assert!(found.bands[0].points.iter().all(|point| point.confidence.is_some()), "the product");
    assert!(found.bands[1].points.iter().all(|point| point.confidence.is_none()), "a factor");
    let sentence = found.bands[1].sentence().unwrap();
    assert_eq!(sentence, "The data do not determine first of a between 0 and 8 (x in A).");
}

fn saturation(p: &[f64], x: f64) -> f64 {
    p[0] * x / (p[1] + x)
}

/// A saturation that was measured at its beginning only.
fn beginning() -> (Vec<f64>, Vec<f64>) {
    let x: Vec<f64> = (1..13).map(|k| f64::from(k) / 12.0).collect();
    let y = x.iter().zip(noise(12)).map(|(x, e)| saturation(&[2.0, 1.5], *x) + 0.01 * e).collect();
    (x, y)
}

const RANGES: [[f64; 2]; 2] = [[0.1, 20.0], [0.1, 20.0]];

fn planned(points: usize) -> (Run, NextMeasurement) {
    let (x, y) = beginning();
    let mut problem = problem(saturation, &x, &y, &RANGES);
    let predict = Formulas { measured: saturation, others: Vec::new(), end: 10.0 };
    problem.inference.predict = Some(Box::new(predict));
    problem.inference.design = Some(DesignSettings { points, range: None, outputs: Vec::new() });
    let run = finished(problem);
    let found = infer(&run).unwrap();
    let next = found.next_measurement.unwrap();
    (run, next)
}

/// Fits again with points of the best model added at `more`, and gives the relative standard
/// errors per standard deviation of the noise.
fn refitted(best: &[f64], more: &[f64]) -> Vec<f64> {
    let (mut x, mut y) = beginning();
    y.extend(more.iter().map(|x| saturation(best, *x)));
    x.extend(more);
    let run = finished(problem(saturation, &x, &y, &RANGES));
    let values = &run.observed.best.as_ref().unwrap().values;
    let simulated = run.evaluation.simulate(values).unwrap();
    let statistics = Statistics::at(&run.problem, &run.evaluation, values, &simulated, &[]);
    let square: f64 = y.iter().zip(&simulated).map(|(y, s)| (y - s).powi(2)).sum();
    let spread = (square / (y.len() - 2) as f64).sqrt();
    let errors = statistics.uncertainty.unwrap().standard_deviations;
    errors.iter().zip(best).map(|(error, value)| error / value / spread).collect()
}

fn window([low, high]: [f64; 2], points: usize) -> Vec<f64> {
    (0..points).map(|k| low + (high - low) * k as f64 / (points - 1) as f64).collect()
}

/// Adding the points that were announced and fitting again shrinks the intervals to what was
/// announced, and no other window does better.
#[test]
fn announced_gains_come_true_and_are_the_largest() {
    let (run, next) = planned(5);
    let best = run.observed.best.as_ref().unwrap().values.clone();
    let local = Local::at(&run.problem, &run.evaluation, &best).unwrap();
    let spread = local.variance.sqrt();
    let quantile = student_quantile(12 + 5 - 2);
    for k in 0..2 {
        let proposal = next.proposals.iter().find(|p| p.parameter == Some(k)).unwrap();
        let range = proposal.plans[0].range;
        let found = refitted(&best, &window(range, 5))[k] * spread * quantile;
        let announced = proposal.after[k].unwrap();
        assert!((found / announced - 1.0).abs() < 0.01, "p{k}: {found} {announced}");
        assert!(announced < 0.5 * next.now[k].unwrap(), "p{k} gains");
        for low in [0.0, 0.5, 1.0, 2.0, 4.0, 6.0, 9.0] {
            for width in [0.5, 1.0, 4.0] {
                let high: f64 = low + width;
                if high <= 10.0 {
                    let other = refitted(&best, &window([low, high], 5))[k] * spread * quantile;
                    assert!(other > 0.97 * announced, "{low} {high}: {other} {announced}");
                }
            }
        }
    }
}

/// D-optimal points of the saturation are known: half at the largest x, half at K/(1 + 2K/x)
/// (Bates & Watts 1988, section 3.14), for a design without earlier points; with few and bad
/// earlier points many new ones go there.
#[test]
fn many_points_go_where_the_closed_form_says() {
    let (run, next) = planned(40);
    let best = &run.observed.best.as_ref().unwrap().values;
    let optimal = best[1] / (1.0 + 2.0 * best[1] / 10.0);
    let plans = &next.proposals.iter().find(|p| p.criterion == "D").unwrap().plans;
    assert!(plans.len() <= 3, "{plans:?}");
    for plan in plans {
        let place = plan.range[0];
        let at_end = (place - 10.0).abs() < 1e-9;
        assert!(at_end || (place - optimal).abs() < 0.3, "{place} {optimal}");
    }
    let at_end: usize = plans.iter().filter(|p| p.range[0] > 9.9).map(|p| p.points).sum();
    assert!((17..=28).contains(&at_end), "{plans:?}");
}

#[test]
fn a_further_output_may_be_worth_more_than_points() {
    let product: Function = |p, x| p[0] * p[1] * x;
    let x: Vec<f64> = (1..9).map(f64::from).collect();
    let y: Vec<f64> = x.iter().zip(noise(8)).map(|(x, e)| 6.0 * x + 0.1 * e).collect();
    let mut problem = problem(product, &x, &y, &[[0.1, 10.0], [0.1, 10.0]]);
    let first: Function = |p, _| p[0];
    let predict = Formulas { measured: product, others: vec![("first", first)], end: 8.0 };
    problem.inference.predict = Some(Box::new(predict));
    let outputs = vec![("first".to_owned(), 0.05)];
    problem.inference.design = Some(DesignSettings { points: 4, range: None, outputs });
    let found = infer(&finished(problem)).unwrap();
    let next = found.next_measurement.unwrap();
    assert_eq!(next.now, [None, None]);
    let proposal = next.proposals.iter().find(|p| p.parameter == Some(0)).unwrap();
    assert_eq!(proposal.plans[0].variable, "first");
    let sentences = next.sentences();
    assert!(sentences[0].starts_with("Four points of first between x = "), "{sentences:?}");
    assert!(
        sentences[0].contains("would narrow the 95 % interval of p0 from unbounded to ±"),
        "{sentences:?}"
    );
}

#[test]
fn without_noise_nothing_is_planned() {
    let x: Vec<f64> = (0..12).map(f64::from).collect();
    let y: Vec<f64> = x.iter().map(|x| 1.0 + 0.5 * x).collect();
    let mut problem = problem(line, &x, &y, &[[-10.0, 10.0], [-10.0, 10.0]]);
    let predict = Formulas { measured: line, others: Vec::new(), end: 12.0 };
    problem.inference.predict = Some(Box::new(predict));
    problem.inference.design = Some(DesignSettings { points: 4, range: None, outputs: Vec::new() });
    let found = infer(&finished(problem)).unwrap();
    assert!(found.next_measurement.is_none());
    assert!(found.refusals[0].contains("as small as the errors of the simulation"));
}

/// With known standard deviations and normal priors the estimate and its covariance are those of
/// (XᵀX/σ² + Λ)⁻¹.
#[test]
fn normal_priors_of_a_straight_line_are_conjugate() {
    let x: Vec<f64> = (0..6).map(f64::from).collect();
    let y: Vec<f64> = x.iter().zip(noise(6)).map(|(x, e)| 1.0 + 0.5 * x + 0.2 * e).collect();
    let mut problem = problem(line, &x, &y, &[[-10.0, 10.0], [-10.0, 10.0]]);
    problem.series[0].sigma = Sigma::Given(vec![0.2; 6]);
    problem.objectives[0].0 = "sum_of_squares".into();
    let prior = |parameter, mean, sd| {
        let distribution = Distribution::Normal { mean, sd };
        Prior { parameter, distribution, constant: 0.0 }
    };
    let priors = vec![prior(0, 2.0, 0.1), prior(1, 0.3, 1e-3)];
    adjust(&mut problem, Adjustments { priors, ..Adjustments::default() }).unwrap();
    let run = finished(problem);
    let (n, sx, sxx): (f64, f64, f64) = (6.0, 15.0, 55.0);
    let (sy, sxy): (f64, f64) = (y.iter().sum(), x.iter().zip(&y).map(|(x, y)| x * y).sum());
    let [a, b, d] = [25.0 * n + 100.0, 25.0 * sx, 25.0 * sxx + 1e6];
    let [u, v] = [25.0 * sy + 100.0 * 2.0, 25.0 * sxy + 1e6 * 0.3];
    let determinant = a * d - b * b;
    let expected = [(d * u - b * v) / determinant, (a * v - b * u) / determinant];
    let best = &run.observed.best.as_ref().unwrap().values;
    for (found, expected) in best.iter().zip(expected) {
        assert!((found - expected).abs() < 1e-7, "{found} {expected}");
    }
    let local = Local::at(&run.problem, &run.evaluation, best).unwrap();
    let variances = local.information.variances();
    assert!((variances[0].unwrap() / (d / determinant) - 1.0).abs() < 1e-6);
    assert!((variances[1].unwrap() / (a / determinant) - 1.0).abs() < 1e-6);
    let found = infer(&run).unwrap();
    let remarks = &found.findings;
    let begins = |k: usize, text: &str| remarks[k].sentence.starts_with(text);
    assert!(begins(0, "The data contradict the prior of p0: the estimate lies 3."), "{remarks:?}");
    assert!(begins(1, "The estimate of p1 comes only from its prior"), "{remarks:?}");
    assert_eq!(remarks.len(), 2);
    let solution = crate::problem::Solution::of(&run, "", Vec::new()).unwrap();
    assert_eq!(solution.series.len(), 1, "a prior is not data");
}

#[test]
fn priors_need_known_deviations_and_a_width() {
    let build = |distribution, known| {
        let mut problem = problem(line, &[0.0, 1.0], &[0.0, 1.0], &[[-1.0, 1.0], [0.1, 1.0]]);
        problem.objectives[0].0 = "sum_of_squares".into();
        if known {
            problem.series[0].sigma = Sigma::Given(vec![1.0; 2]);
        }
        let priors = vec![Prior { parameter: 0, distribution, constant: 0.0 }];
        let added = Adjustments { priors, ..Adjustments::default() };
        adjust(&mut problem, added).map_err(|(_, fault)| fault.message)
    };
    let normal = |sd| Distribution::Normal { mean: 0.0, sd };
    assert!(build(normal(1.0), true).is_ok());
    assert!(build(normal(1.0), false).unwrap_err().contains("are unknown"));
    assert!(build(normal(0.0), true).unwrap_err().contains("no width"));
    assert!(build(Distribution::LogNormal { median: 1.0, factor: 1.0 }, true).is_err());
    let message = build(Distribution::LogNormal { median: 1.0, factor: 2.0 }, true).unwrap_err();
    assert!(message.contains("range starts at -1"), "{message}");
}

#[test]
fn log_normal_data_are_fitted_by_their_logarithms() {
    let growth: Function = |p, x| p[0] * (p[1] * x).exp();
    let x: Vec<f64> = (0..10).map(f64::from).collect();
    let y: Vec<f64> =
        x.iter().zip(noise(10)).map(|(x, e)| 2.0 * (0.5 * x + 0.2 * e).exp()).collect();
    let mut problem = problem(growth, &x, &y, &[[0.1, 10.0], [-2.0, 2.0]]);
    let added = Adjustments { logarithmic: vec![0], ..Adjustments::default() };
    adjust(&mut problem, added).unwrap();
    let run = finished(problem);
    let (mean_x, mean_y) = (4.5, y.iter().map(|y| y.ln()).sum::<f64>() / 10.0);
    let sxy: f64 = x.iter().zip(&y).map(|(x, y)| (x - mean_x) * y.ln()).sum();
    let slope = sxy / 82.5;
    let best = &run.observed.best.as_ref().unwrap().values;
    assert!((best[1] - slope).abs() < 1e-6, "{} {slope}", best[1]);
    assert!((best[0].ln() - (mean_y - slope * mean_x)).abs() < 1e-6);
    // The density of a value is that of its logarithm by the value.
    let residual = |(x, y): (&f64, &f64)| y.ln() - mean_y - slope * (x - mean_x);
    let square: f64 = x.iter().zip(&y).map(|point| residual(point).powi(2)).sum();
    let of_logarithms = -5.0 * ((square / 10.0).ln() + 1.0 + std::f64::consts::TAU.ln());
    let expected = of_logarithms - y.iter().map(|y| y.ln()).sum::<f64>();
    let found = infer(&run).unwrap().likelihood.unwrap().log;
    assert!((found - expected).abs() < 1e-6, "{found} {expected}");
}

#[test]
fn constraints_hold_and_are_named_where_they_are_active() {
    let x: Vec<f64> = (0..10).map(f64::from).collect();
    let y: Vec<f64> = x.iter().zip(noise(10)).map(|(x, e)| 3.0 + 0.5 * x + 0.1 * e).collect();
    let solved = |text: &str| {
        let mut problem = problem(line, &x, &y, &[[0.0, 10.0], [0.0, 10.0]]);
        let entry = registry::find("method", METHODS, "genetic").unwrap();
        problem.method = (entry.make)(&mut Options::default()).unwrap();
        problem.polish = true;
        let sides: fn(&[f64]) -> [f64; 2] = match text {
            "p1 < p0" => |p| [p[1], p[0]],
            _ => |p| [p[0], p[1]],
        };
        let constraints = vec![Constraint::new(text, std::sync::Arc::new(sides))];
        adjust(&mut problem, Adjustments { constraints, ..Adjustments::default() }).unwrap();
        let run = finished(problem);
        (run.observed.best.as_ref().unwrap().values.clone(), infer(&run).unwrap())
    };
    let (free, found) = solved("p1 < p0");
    assert!((free[0] - 3.0).abs() < 0.2 && found.findings.is_empty(), "{free:?}");
    let (bound, found) = solved("p0 <= p1");
    assert!(bound[0] <= bound[1]);
    // On the limit the best is p (1 + x): p = Σ (1 + x) y / Σ (1 + x)².
    let up: f64 = x.iter().zip(&y).map(|(x, y)| (1.0 + x) * y).sum();
    let expected = up / x.iter().map(|x| (1.0 + x) * (1.0 + x)).sum::<f64>();
    assert!(
        (bound[0] - expected).abs() < 0.05 && (bound[1] - expected).abs() < 0.05,
        "{bound:?} {expected}"
    );
    assert!(found.findings[0].sentence.contains("`p0 <= p1`"), "{:?}", found.findings);
}

#[test]
fn nothing_is_inferred_beside_a_minimum() {
    let (x, y) = beginning();
    let mut problem = problem(saturation, &x, &y, &RANGES);
    let predict = Formulas { measured: saturation, others: Vec::new(), end: 10.0 };
    problem.inference.predict = Some(Box::new(predict));
    problem.inference.design = Some(DesignSettings { points: 4, range: None, outputs: Vec::new() });
    let mut run = finished(problem);
    let best = run.observed.best.as_ref().unwrap().values.clone();
    let local = Local::at(&run.problem, &run.evaluation, &best).unwrap();
    let error = local.information.variances()[0].unwrap().sqrt();
    // By a thousandth of a standard error, and by a half, the other parameter held.
    for (part, holds) in [(0.001, true), (0.5, false)] {
        let mut values = best.clone();
        values[0] += part * error;
        run.observed.best.as_mut().unwrap().values = values;
        let found = infer(&run).unwrap();
        assert_eq!(found.next_measurement.is_some(), holds, "{part}");
        assert_eq!(found.refusals.iter().any(|why| why.contains("are not a minimum")), !holds);
    }
}
