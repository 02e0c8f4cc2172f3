//! What a report must say and must not say, for data of known faults.

use super::*;
use crate::fitness::{FITNESSES, Fitness};
use crate::ga::Mrg32k3a;
use crate::ga::optimizer::METHODS;
use crate::registry::{self, Options};

type Formula = fn(&[f64], f64) -> f64;

/// Several outputs over the same x.
struct Outputs(Vec<f64>, Vec<Formula>);

impl Simulate for Outputs {
    fn simulate(&mut self, parameters: &[f64], out: &mut [f64]) -> Result<(), Failed> {
        let points = self.1.iter().flat_map(|output| self.0.iter().map(move |x| (output, x)));
        out.iter_mut().zip(points).for_each(|(y, (output, x))| *y = output(parameters, *x));
        Ok(())
    }
}

fn decay(p: &[f64], x: f64) -> f64 {
    p[0] * (-p[1] * x).exp()
}

fn rise(p: &[f64], x: f64) -> f64 {
    2.0 * p[0] * (1.0 - (-p[1] * x).exp())
}

const TRUTH: [f64; 2] = [5.0, 0.4];

struct Noise(Mrg32k3a);

impl Noise {
    fn new(seed: u32) -> Noise {
        let seed = f64::from(seed);
        Noise(Mrg32k3a::new(&[100.0 + seed, 2.0, 3.0, 4.0 + seed, 5.0, 6.0]).unwrap())
    }

    fn white(&mut self, n: usize, size: f64) -> Vec<f64> {
        (0..n).map(|_| size * self.0.normal()).collect()
    }
}

fn grid(n: usize) -> Vec<f64> {
    (0..n).map(|k| 5.0 * k as f64 / n as f64).collect()
}

fn made(name: &str) -> Box<dyn Fitness> {
    let entry = registry::find("fitness", FITNESSES, name).unwrap();
    (entry.make)(&mut Options::default()).unwrap()
}

/// A problem of outputs with noise, each with its sigma, searched by least squares near the truth.
fn problem(
    outputs: &[(Formula, Vec<f64>, Sigma)],
    truth: &[f64],
    range: [f64; 2],
    fitness: Option<&str>,
) -> Problem {
    let x = grid(outputs[0].1.len());
    let series = outputs.iter().enumerate().map(|(k, (output, noise, sigma))| Series {
        experiment: String::new(),
        y_name: format!("y{k}"),
        y_unit: String::new(),
        x_name: "time".into(),
        x_unit: "s".into(),
        file: "twin".into(),
        y: x.iter().zip(noise).map(|(x, e)| output(truth, *x) + e).collect(),
        x: x.clone(),
        weight: 1.0,
        role: Default::default(),
        relative: Vec::new(),
        sigma: sigma.clone(),
        law: crate::fitness::Law::Normal,
        censored: Vec::new(),
        column: String::new(),
        x_column: String::new(),
        rows: Vec::new(),
        missing: Vec::new(),
        scaling: Default::default(),
        joint: None,
    });
    let series: Vec<Series> = series.collect();
    let objective = match fitness {
        Some(name) => made(name),
        None if series.iter().any(|own| own.sigma.is_estimated()) => {
            likelihood(&series, 1e-12).unwrap()
        }
        None => made(FITNESSES[0].name),
    };
    let free = |(k, value): (usize, &f64)| {
        Free::new(format!("p{k}"), "", range, Some(false), Some(1.1 * value)).unwrap()
    };
    let method = registry::find("method", METHODS, "levenberg_marquardt").unwrap();
    let formulas: Vec<Formula> = outputs.iter().map(|output| output.0).collect();
    Problem {
        title: "a test".into(),
        model: "M".into(),
        text: String::new(),
        descriptions: crate::Descriptions::default(),
        parameters: truth.iter().enumerate().map(free).collect(),
        series,
        objectives: vec![(fitness.unwrap_or("objective").into(), objective)],
        method_name: "levenberg_marquardt".into(),
        method: (method.make)(&mut Options::default()).unwrap(),
        polish: false,
        seed: [12345.0; 6],
        stop: Stop { evaluations: Some(3000), ..Stop::default() },
        noise: 1e-12,
        inference: crate::problem::Inference::default(),
        simulator: Box::new(move || Ok(Box::new(Outputs(x.clone(), formulas.clone())))),
    }
}

fn solved(problem: Problem) -> (Run, Solution) {
    let mut run = Run::new(problem, 1).unwrap();
    let mut step = 0.0;
    let stop = loop {
        if let Some(stop) = run.stop() {
            break stop;
        }
        step += 1.0;
        run.step(step);
    };
    conclude(&mut run);
    let solution = Solution::of(&run, &stop, Vec::new()).unwrap();
    (run, solution)
}

fn one(formula: Formula, noise: Vec<f64>, sigma: Sigma) -> Solution {
    solved(problem(&[(formula, noise, sigma)], &TRUTH, [0.01, 20.0], None)).1
}

fn has(solution: &Solution, kind: FindingKind) -> bool {
    solution.findings.iter().any(|finding| finding.kind == kind)
}

fn given(size: f64, n: usize) -> Sigma {
    Sigma::Given(vec![size; n])
}

/// At a family-wise level of 1 % three or more of 100 false alarms have a probability of 8 %, five
/// of 0.3 %.
#[test]
fn sound_data_raise_no_alarm_at_the_level() {
    let mut alarms = 0;
    for seed in 0..100 {
        let noise = Noise::new(seed).white(40, 0.1);
        let sigma = if seed % 2 == 0 { Sigma::Unknown } else { given(0.1, 40) };
        alarms += usize::from(!one(decay, noise, sigma).findings.is_empty());
    }
    assert!(alarms <= 5, "{alarms} of 100");
}

#[test]
fn outliers_are_named_by_their_rows() {
    let mut noise = Noise::new(1).white(40, 0.05);
    noise[6] += 0.6;
    noise[18] -= 0.5;
    let solution = one(decay, noise, Sigma::Unknown);
    let [finding] = &solution.findings[..] else { panic!("{:?}", solution.findings) };
    assert_eq!((finding.kind, &finding.rows[..]), (FindingKind::Outlier, &[7, 19][..]));
}

/// Gross errors pull the fit away from the other points, whose residuals are a pattern then; the
/// noise is white.
#[test]
fn gross_outliers_are_not_taken_for_a_pattern() {
    let mut noise = Noise::new(1).white(40, 0.05);
    noise[8] -= 8.0;
    noise[25] += 12.0;
    let solution = one(decay, noise, Sigma::Unknown);
    let found = solution.findings.iter().find(|f| f.kind == FindingKind::Outlier);
    assert_eq!(found.unwrap().rows, [9, 26], "{:?}", solution.findings);
    assert!(!has(&solution, FindingKind::Autocorrelation), "{:?}", solution.findings);
}

#[test]
fn serial_correlation_of_either_sign_is_found() {
    for (rho, sign) in [(0.8, "pattern"), (-0.7, "alternate")] {
        let white = Noise::new(3).white(80, 0.1);
        let mut noise = vec![white[0]];
        (1..80).for_each(|k| noise.push(rho * noise[k - 1] + white[k]));
        let solution = one(decay, noise, Sigma::Unknown);
        let found = solution.findings.iter().find(|f| f.kind == FindingKind::Autocorrelation);
        assert!(found.unwrap().sentence.contains(sign), "{found:?}");
        assert!(!has(&solution, FindingKind::Outlier));
    }
}

#[test]
fn a_model_beside_the_data_everywhere_does_not_pass() {
    // The model is too low by 60 sigma and cannot rise: its parameters are at their bounds.
    let noise: Vec<f64> = Noise::new(4).white(30, 0.01).iter().map(|e| e + 0.6).collect();
    let fixed = problem(&[(rise, noise, given(0.01, 30))], &[1.0, 1.0], [0.99, 1.1], None);
    let (_, solution) = solved(fixed);
    assert!(has(&solution, FindingKind::Bias), "{:?}", solution.findings);
    assert!(has(&solution, FindingKind::Sigma));
}

/// An offset that no parameter follows: a standard deviation of zero is no measure of it.
#[test]
fn residuals_that_are_all_alike_are_said_as_they_are() {
    let constant = |p: &[f64], _: f64| p[0] + 0.0 * p[1];
    let fixed =
        problem(&[(constant, vec![0.6; 30], Sigma::Unknown)], &[1.0, 1.0], [0.99, 1.1], None);
    let (_, solution) = solved(fixed);
    let found = solution.findings.iter().find(|own| own.kind == FindingKind::Bias);
    let sentence = &found.expect("a bias").sentence;
    assert!(sentence.contains("biased: all are 0.5 (30 of 30 are positive)"), "{sentence}");
}

/// All residuals of one sign, in a slow wave whose points count little each.
#[test]
fn a_wave_on_one_side_of_the_data_is_a_bias() {
    let wave = (0..30).map(|k| 0.9 + 0.3 * (f64::from(k) / 4.0).sin()).collect();
    let fixed = problem(&[(rise, wave, Sigma::Unknown)], &[1.0, 1.0], [0.99, 1.1], None);
    let (_, solution) = solved(fixed);
    assert!(has(&solution, FindingKind::Autocorrelation), "{:?}", solution.findings);
    assert!(has(&solution, FindingKind::Bias), "{:?}", solution.findings);
}

#[test]
fn spread_that_grows_with_the_output_is_not_taken_for_outliers() {
    let white = Noise::new(5).white(60, 0.1);
    let noise = grid(60).iter().zip(&white).map(|(x, e)| e * decay(&TRUTH, *x)).collect();
    let solution = one(decay, noise, Sigma::Unknown);
    assert!(has(&solution, FindingKind::UnequalVariance), "{:?}", solution.findings);
    assert!(!has(&solution, FindingKind::Outlier));
    // The right formula makes it silent.
    let noise = grid(60).iter().zip(&white).map(|(x, e)| e * decay(&TRUTH, *x)).collect();
    let value = std::sync::Arc::new(|y: f64| 0.1 * y.abs());
    let formula = Sigma::Formula(SigmaFormula { text: "0.1*abs(y)".into(), value });
    let solution = one(decay, noise, formula);
    assert!(solution.findings.is_empty(), "{:?}", solution.findings);
    assert!(solution.likelihood.chi_square.unwrap().probability > 0.01);
}

#[test]
fn a_wrong_sigma_is_contradicted_on_both_sides() {
    for (factor, word) in [(0.2, "too small"), (5.0, "too large")] {
        let solution = one(decay, Noise::new(6).white(40, 0.1), given(0.1 * factor, 40));
        let [finding] = &solution.findings[..] else { panic!("{:?}", solution.findings) };
        assert_eq!(finding.kind, FindingKind::Sigma);
        assert!(finding.sentence.contains(word), "{}", finding.sentence);
    }
}

/// Standard errors of given sigmas do not depend on the residuals, those of one variance do.
#[test]
fn given_sigmas_are_believed() {
    let error = |noise: f64, sigma: Sigma| {
        one(decay, Noise::new(7).white(40, noise), sigma).parameters[0].deviation.unwrap()
    };
    let (a, b) = (error(0.1, given(0.1, 40)), error(0.2, given(0.1, 40)));
    assert!((a / b - 1.0).abs() < 0.1, "{a} {b}");
    let (c, d) = (error(0.1, Sigma::Unknown), error(0.2, Sigma::Unknown));
    assert!((d / c - 2.0).abs() < 0.2, "{c} {d}");
}

#[test]
fn one_column_twice_counts_once() {
    let noise = Noise::new(8).white(40, 0.1);
    let twice =
        [(decay as Formula, noise.clone(), Sigma::Unknown), (decay, noise.clone(), Sigma::Unknown)];
    let (_, twice) = solved(problem(&twice, &TRUTH, [0.01, 20.0], None));
    assert!(has(&twice, FindingKind::ColumnsEqual));
    let once = one(decay, noise, Sigma::Unknown);
    for (a, b) in twice.parameters.iter().zip(&once.parameters) {
        let (a, b) = (a.deviation.unwrap(), b.deviation.unwrap());
        assert!((a / b - 1.0).abs() < 1e-4, "{a} {b}");
    }
}

#[test]
fn estimated_deviations_are_those_of_the_noise_and_give_the_small_output_its_say() {
    let mut noise = Noise::new(9);
    let outputs = [
        (rise as Formula, noise.white(60, 1.0), Sigma::Estimated),
        (decay, noise.white(60, 0.01), Sigma::Estimated),
    ];
    let (_, solution) = solved(problem(&outputs, &TRUTH, [0.01, 20.0], None));
    for (series, expected) in solution.series.iter().zip([1.0, 0.01]) {
        let found = series.sigma.unwrap();
        assert!((found / expected - 1.0).abs() < 0.3, "{found} {expected}");
    }
    assert!(solution.parameters[1].deviation.unwrap() < 2e-3);
    let likelihood = solution.likelihood.negative_log_likelihood.unwrap();
    assert!((likelihood - solution.fitness).abs() < 1e-9, "{likelihood} {}", solution.fitness);
    let unknown = outputs.map(|(output, noise, _)| (output, noise, Sigma::Unknown));
    let (_, drowned) = solved(problem(&unknown, &TRUTH, [0.01, 20.0], None));
    assert!(has(&drowned, FindingKind::ScaleOfOutputs), "{:?}", drowned.findings);
}

#[test]
fn a_step_is_an_interval_and_not_without_effect() {
    let step: Formula = |p, x| if x < p[0] { 0.0 } else { p[1] };
    let outputs = [(step, Noise::new(10).white(50, 0.05), Sigma::Unknown)];
    let mut near = problem(&outputs, &[2.04, 3.0], [0.5, 4.5], None);
    // Least squares does not move a switching time.
    near.parameters[0].start = Some(2.06);
    let (_, solution) = solved(near);
    assert!(has(&solution, FindingKind::Interval) && !has(&solution, FindingKind::NoEffect));
    let [low, high] = solution.parameters[0].interval.unwrap();
    // The samples are 0.1 apart.
    let width = high - low;
    assert!((width - 0.1).abs() < 1e-6, "{low} {high}");
    let idle: Formula = |p, x| p[1] + 0.0 * p[0] * x;
    let outputs = [(idle, Noise::new(11).white(50, 0.05), Sigma::Unknown)];
    let (_, solution) = solved(problem(&outputs, &[2.0, 3.0], [0.5, 4.5], None));
    assert!(has(&solution, FindingKind::NoEffect), "{:?}", solution.findings);
    assert_eq!(solution.parameters[0].verdict, Some(Verdict::WithoutEffect));
}

/// An exact fit leaves the standard errors of given deviations.
#[test]
fn an_exact_output_does_not_deny_errors_of_given_deviations() {
    let outputs = [(decay as Formula, vec![0.0; 50], Sigma::Given(vec![0.1; 50]))];
    let mut problem = problem(&outputs, &TRUTH, [0.01, 20.0], None);
    problem.noise = 1e-6;
    let (_, solution) = solved(problem);
    assert!(solution.parameters.iter().all(|p| p.deviation.is_some()));
    assert!(!has(&solution, FindingKind::NoNoise), "{:?}", solution.findings);
    let said = solution.findings.iter().find(|own| own.sentence.contains("the fit is exact"));
    assert!(said.is_some_and(|own| own.sentence.ends_with("have no noise.")), "{said:?}");
}

#[test]
fn as_many_points_as_parameters_determine_nothing() {
    let solution = one(decay, Noise::new(12).white(2, 0.1), Sigma::Unknown);
    assert!(has(&solution, FindingKind::TooFewPoints) && !has(&solution, FindingKind::NoNoise));
    assert!(solution.parameters.iter().all(|p| p.verdict.is_none() && p.deviation.is_none()));
}

/// Where the minimum lies at k beyond its range, the report says so; at a bound of nature it does
/// not.
#[test]
fn a_bound_is_contradicted_only_where_the_data_do() {
    let outputs = [(decay as Formula, Noise::new(13).white(40, 0.05), Sigma::Unknown)];
    let mut narrow = problem(&outputs, &TRUTH, [0.01, 20.0], None);
    narrow.parameters[1] = Free::new("k", "", [0.01, 0.3], Some(false), Some(0.2)).unwrap();
    let (_, solution) = solved(narrow);
    let found = solution.findings.iter().find(|f| f.kind == FindingKind::AtBound).unwrap();
    assert!(found.sentence.contains("the optimum lies beyond it"), "{}", found.sentence);
}

/// A simulator with an error that is its tolerance times a value far above the noise.
struct Coarse(Outputs, f64);

impl Simulate for Coarse {
    fn simulate(&mut self, parameters: &[f64], out: &mut [f64]) -> Result<(), Failed> {
        self.0.simulate(parameters, out)?;
        out.iter_mut().zip(&self.0.0).for_each(|(y, x)| *y += 1e3 * self.1 * x);
        Ok(())
    }

    fn scale_tolerance(&mut self, factor: f64) {
        self.1 = 1e-4 * factor;
    }
}

#[test]
fn a_coarse_solver_is_found_and_the_fit_repeated() {
    let outputs = [(decay as Formula, Noise::new(14).white(40, 1e-3), Sigma::Unknown)];
    let mut coarse = problem(&outputs, &TRUTH, [0.01, 20.0], None);
    coarse.noise = 1e-4;
    let x = grid(40);
    coarse.simulator =
        Box::new(move || Ok(Box::new(Coarse(Outputs(x.clone(), vec![decay]), 1e-4))));
    let (_, solution) = solved(coarse);
    let [finding] = &solution.findings[..] else { panic!("{:?}", solution.findings) };
    assert_eq!(finding.kind, FindingKind::SolverTolerance, "{finding:?}");
    assert!((solution.parameters[1].value - 0.4).abs() < 2e-3, "{:?}", solution.parameters);
}

/// A sensor that stays at 4 where the output is higher: its rows are named, and none of them is an
/// outlier. Rounded data have equal values, too, and nothing is said of them.
#[test]
fn equal_values_at_the_end_of_the_data_are_a_saturated_sensor() {
    let white = Noise::new(16).white(40, 0.02);
    let clipped: Vec<f64> =
        grid(40).iter().zip(&white).map(|(x, e)| (decay(&TRUTH, *x) + e).min(4.0)).collect();
    let truth: Vec<f64> = grid(40).iter().map(|x| decay(&TRUTH, *x)).collect();
    let noise = clipped.iter().zip(&truth).map(|(y, f)| y - f).collect();
    let solution = one(decay, noise, Sigma::Unknown);
    let found = solution.findings.iter().find(|f| f.sentence.contains("saturated")).unwrap();
    let rows: Vec<usize> = (1..=40).filter(|row| clipped[row - 1] == 4.0).collect();
    assert_eq!(found.rows, rows, "{}", found.sentence);
    let outliers = solution.findings.iter().filter(|f| f.kind == FindingKind::Outlier);
    assert!(outliers.flat_map(|f| &f.rows).all(|row| !rows.contains(row)));
    let rounded =
        truth.iter().zip(&white).map(|(f, e)| ((f + e) * 4.0).round() / 4.0 - f).collect();
    let solution = one(decay, rounded, Sigma::Unknown);
    assert!(!solution.findings.iter().any(|f| f.sentence.contains("saturated")));
}

/// No residual that is smaller than two standard deviations of the others is called far from the fit.
#[test]
fn outliers_are_far_from_the_fit() {
    for seed in 0..40 {
        let mut noise = Noise::new(200 + seed).white(20, 0.05);
        noise[0] -= 1.5;
        noise[1] -= 0.8;
        noise[2] -= 0.3;
        let solution = one(decay, noise, Sigma::Unknown);
        for finding in solution.findings.iter().filter(|f| f.kind == FindingKind::Outlier) {
            let said = finding.sentence.split(" standard deviations").filter_map(|part| {
                part.rsplit('(').next().and_then(|number| number.parse::<f64>().ok())
            });
            assert!(
                said.clone().count() > 0 && said.clone().all(|r| r.abs() >= 2.0),
                "{finding:?}"
            );
        }
    }
}

/// Values with three significant digits: those of the largest are the least exact, and none is an
/// outlier. One that is off by more than its last digit is.
#[test]
fn rounding_is_not_an_outlier() {
    let digits = |value: f64| format!("{value:.2e}").parse::<f64>().unwrap();
    for n in [7, 10, 14] {
        let exact: Vec<f64> = grid(n).iter().map(|x| decay(&[5.0, 1.2], *x)).collect();
        let posed = |mistake: f64| {
            let rounded =
                |(k, y): (usize, &f64)| digits(y + if k == 3 { mistake } else { 0.0 }) - y;
            let noise = exact.iter().enumerate().map(rounded).collect();
            problem(&[(decay, noise, Sigma::Unknown)], &[5.0, 1.2], [0.01, 20.0], None)
        };
        let (_, solution) = solved(posed(0.0));
        assert!(!has(&solution, FindingKind::Outlier), "{n}: {:?}", solution.findings);
        let (_, solution) = solved(posed(1.0));
        let found = solution.findings.iter().find(|f| f.kind == FindingKind::Outlier);
        assert_eq!(found.map(|f| &f.rows[..]), Some(&[4][..]), "{n}: {:?}", solution.findings);
    }
}

/// Errors that two outputs share are found, and independent ones are not taken for them.
#[test]
fn errors_in_common_are_named() {
    let common = Noise::new(17).white(40, 0.1);
    let own = Noise::new(18).white(40, 0.03);
    let both = [
        (decay as Formula, common.clone(), Sigma::Unknown),
        (rise, common.iter().zip(&own).map(|(a, b)| a + b).collect(), Sigma::Unknown),
    ];
    let (_, solution) = solved(problem(&both, &TRUTH, [0.01, 20.0], None));
    let is_said = |solution: &Solution| {
        solution.findings.iter().any(|f| f.sentence.contains("errors in common"))
    };
    assert!(is_said(&solution), "{:?}", solution.findings);
    let alarms = (0..100).filter(|seed| {
        let mut noise = Noise::new(300 + seed);
        let both = [
            (decay as Formula, noise.white(40, 0.1), Sigma::Unknown),
            (rise, noise.white(40, 0.1), Sigma::Unknown),
        ];
        is_said(&solved(problem(&both, &TRUTH, [0.01, 20.0], None)).1)
    });
    assert!(alarms.count() <= 3);
}

/// Outputs with their measured values and errors.
type Measured = Vec<(Formula, Vec<f64>, Sigma)>;

/// Part of the 95 % intervals that hold the truth, of both parameters.
fn coverage(runs: u32, fitness: Option<&str>, outputs: fn(&mut Noise) -> Measured) -> f64 {
    let mut inside = 0;
    for seed in 0..runs {
        let outputs = outputs(&mut Noise::new(1000 + seed));
        let (_, solution) = solved(problem(&outputs, &TRUTH, [0.01, 20.0], fitness));
        for (parameter, truth) in solution.parameters.iter().zip(TRUTH) {
            let [low, high] = parameter.interval.unwrap();
            inside += u32::from((low..=high).contains(&truth));
        }
    }
    f64::from(inside) / f64::from(2 * runs)
}

fn white(noise: &mut Noise) -> Vec<(Formula, Vec<f64>, Sigma)> {
    vec![(decay, noise.white(25, 0.1), Sigma::Unknown)]
}

fn known(noise: &mut Noise) -> Vec<(Formula, Vec<f64>, Sigma)> {
    vec![(decay, noise.white(25, 0.1), given(0.1, 25))]
}

fn spoilt(noise: &mut Noise) -> Vec<(Formula, Vec<f64>, Sigma)> {
    spoilt_of(40, noise)
}

fn few_spoilt(noise: &mut Noise) -> Vec<(Formula, Vec<f64>, Sigma)> {
    spoilt_of(16, noise)
}

/// Every tenth point is an outlier.
fn spoilt_of(n: usize, noise: &mut Noise) -> Vec<(Formula, Vec<f64>, Sigma)> {
    let mut errors = noise.white(n, 0.1);
    (0..n).filter(|k| k % 10 == 3).for_each(|k| errors[k] *= 10.0);
    vec![(decay, errors, Sigma::Unknown)]
}

fn unlike(noise: &mut Noise) -> Vec<(Formula, Vec<f64>, Sigma)> {
    vec![
        (decay, noise.white(25, 0.02), Sigma::Estimated),
        (rise, noise.white(25, 0.5), Sigma::Estimated),
    ]
}

/// Six points for each of two estimated sigmas: with Student's distribution for all points intervals
/// cover 87 to 89 %.
fn few_unlike(noise: &mut Noise) -> Vec<(Formula, Vec<f64>, Sigma)> {
    vec![
        (decay, noise.white(6, 0.02), Sigma::Estimated),
        (rise, noise.white(6, 0.1), Sigma::Estimated),
    ]
}

/// Both outputs have the same sigma, so that their weights are least known.
fn few_alike(noise: &mut Noise) -> Measured {
    vec![
        (decay, noise.white(6, 0.1), Sigma::Estimated),
        (rise, noise.white(6, 0.1), Sigma::Estimated),
    ]
}

#[test]
fn intervals_with_few_points_for_each_sigma_cover_the_truth() {
    for outputs in [few_unlike as fn(&mut Noise) -> _, few_alike] {
        let found = coverage(1600, None, outputs);
        assert!((0.925..=0.975).contains(&found), "{found}");
    }
}

/// The bounds are 95 % and four standard deviations of the count of 2 × 60 intervals, two of each
/// run being correlated.
#[test]
fn intervals_cover_the_truth_in_a_few_runs() {
    for (fitness, outputs) in [(None, white as fn(&mut Noise) -> _), (Some("huber"), spoilt)] {
        let found = coverage(60, fitness, outputs);
        assert!((0.84..=1.0).contains(&found), "{fitness:?}: {found}");
    }
}

/// cargo test --release --lib intervals_cover -- --ignored --nocapture
#[test]
#[ignore = "thousands of fits"]
fn intervals_cover_the_truth() {
    let mut outside = Vec::new();
    for (name, fitness, outputs) in [
        ("white noise", None, white as fn(&mut Noise) -> _),
        ("given sigma", None, known),
        ("estimated sigmas", None, unlike),
        ("huber, 10 % outliers", Some("huber"), spoilt),
        ("tukey, 10 % outliers", Some("tukey"), spoilt),
        ("mean absolute, 10 % outliers", Some("mae"), spoilt),
        ("huber, 16 points", Some("huber"), few_spoilt),
        ("tukey, 16 points", Some("tukey"), few_spoilt),
        ("mean absolute, 16 points", Some("mae"), few_spoilt),
    ] {
        let found = coverage(1000, fitness, outputs);
        outside.extend((!(0.92..=0.98).contains(&found)).then(|| format!("{name}: {found}")));
    }
    assert!(outside.is_empty(), "{outside:?}");
}

/// Outliers of ten standard deviations hardly move a robust fit.
#[test]
fn robust_fits_have_profiles_and_are_not_pulled() {
    for name in ["huber", "tukey", "mae"] {
        let outputs = spoilt(&mut Noise::new(77));
        let (run, mut solution) = solved(problem(&outputs, &TRUTH, [0.01, 20.0], Some(name)));
        for (parameter, truth) in solution.parameters.iter().zip(TRUTH) {
            let error = parameter.deviation.unwrap();
            assert!((parameter.value - truth).abs() < 4.0 * error, "{name} {parameter:?}");
            assert!(error < 0.03 * truth, "{name} {parameter:?}");
        }
        solution.add_profiles(&run);
        let found = solution.profiles.as_ref().unwrap();
        for (profile, parameter) in found.profiles.iter().zip(&solution.parameters) {
            let [low, high] = parameter.interval.unwrap();
            let [Some(from), Some(to)] = profile.interval else { panic!("{name} {profile:?}") };
            let ratio = (to - from) / (high - low);
            assert!((0.6..1.7).contains(&ratio), "{name}: {ratio}");
        }
    }
}

#[test]
fn what_has_no_profile_keeps_the_fit() {
    let outputs = [(decay as Formula, Noise::new(15).white(2, 0.1), Sigma::Unknown)];
    let (run, mut solution) = solved(problem(&outputs, &TRUTH, [0.01, 20.0], None));
    solution.add_profiles(&run);
    assert!(solution.profiles.is_none() && has(&solution, FindingKind::Missing));
}
