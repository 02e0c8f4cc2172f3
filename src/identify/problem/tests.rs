//! Problems put in Rust: a straight line and a product.

use super::*;
use crate::fitness::FITNESSES;
use crate::ga::optimizer::METHODS;
use crate::registry::{self, Options};

/// y = f(parameters, x) at the points.
pub(super) struct Formula(pub Vec<f64>, pub fn(&[f64], f64) -> f64);

impl Simulate for Formula {
    fn simulate(&mut self, parameters: &[f64], out: &mut [f64]) -> Result<(), Failed> {
        for (value, x) in out.iter_mut().zip(&self.0) {
            *value = self.1(parameters, *x);
        }
        match out.iter().all(|value| value.is_finite()) {
            true => Ok(()),
            false => Err(Failed::new(FailureKind::Model, "log", 0.5)),
        }
    }
}

pub(super) fn problem(
    method: &str,
    formula: fn(&[f64], f64) -> f64,
    truth: &[f64],
    noise: &[f64],
) -> Problem {
    let x: Vec<f64> = (0..noise.len()).map(|k| k as f64 / 4.0).collect();
    let y = x.iter().zip(noise).map(|(x, e)| formula(truth, *x) + e).collect();
    let free = |k: usize| Free::new(format!("p{k}"), "V", [0.1, 10.0], None, None).unwrap();
    let series = Series {
        experiment: String::new(),
        y_name: "y".into(),
        y_unit: "V".into(),
        x_name: "time".into(),
        x_unit: "s".into(),
        file: "twin".into(),
        x: x.clone(),
        y,
        weight: 1.0,
        role: Default::default(),
        relative: Vec::new(),
        sigma: Sigma::Unknown,
        law: crate::fitness::Law::Normal,
        censored: Vec::new(),
        column: String::new(),
        x_column: String::new(),
        rows: Vec::new(),
        missing: Vec::new(),
        scaling: Default::default(),
        joint: None,
    };
    let sse = registry::find("fitness", FITNESSES, "sse").unwrap();
    let entry = registry::find("method", METHODS, method).unwrap();
    Problem {
        title: "a test".into(),
        model: "M(q = 1)".into(),
        text: String::new(),
        descriptions: crate::Descriptions::default(),
        parameters: (0..truth.len()).map(free).collect(),
        series: vec![series],
        objectives: vec![("sse".into(), (sse.make)(&mut Options::default()).unwrap())],
        method_name: method.into(),
        method: (entry.make)(&mut Options::default()).unwrap(),
        polish: true,
        seed: [12345.0; 6],
        stop: Stop { evaluations: Some(2000), ..Stop::default() },
        noise: 1e-15,
        inference: Inference::default(),
        simulator: Box::new(move || Ok(Box::new(Formula(x.clone(), formula)))),
    }
}

pub(super) fn decay(p: &[f64], x: f64) -> f64 {
    // Fails for small sums, as models do.
    if p[0] + p[1] < 1.0 { f64::NAN } else { p[0] * (-p[1] * x).exp() }
}

const NOISE: [f64; 12] =
    [0.01, -0.02, 0.015, 0.0, -0.01, 0.02, -0.015, 0.01, 0.0, -0.01, 0.005, -0.005];

fn sentences(solution: &Solution) -> String {
    solution.findings.iter().map(|f| f.sentence.as_str()).collect::<Vec<_>>().join(" ")
}

fn finish(mut run: Run) -> (Solution, Vec<Record>) {
    let mut records = Vec::new();
    let stop = loop {
        if let Some(stop) = run.stop() {
            break stop;
        }
        records.extend(run.step(records.len() as f64));
    };
    (Solution::of(&run, &stop, Vec::new()).unwrap(), records)
}

#[test]
fn the_truth_is_found_from_its_own_simulation() {
    let run = Run::new(problem("genetic", decay, &[2.0, 0.7], &[0.0; 12]), 2).unwrap();
    let (solution, _) = finish(run);
    assert!(solution.fitness < 1e-20, "{}", solution.fitness);
    for (found, truth) in solution.parameters.iter().zip([2.0, 0.7]) {
        assert!((found.value - truth).abs() < 1e-8, "{found:?}");
    }
    assert!(solution.effort.failures["model"] > 0, "some individuals fail");
    assert_eq!(solution.outcome.stop, "the search has converged");
}

#[test]
fn a_resumed_run_ends_with_the_same_bytes_on_any_number_of_threads() {
    let begin =
        |threads| Run::new(problem("genetic", decay, &[2.0, 0.7], &NOISE), threads).unwrap();
    let (whole, records) = finish(begin(1));
    for (kept, threads) in [(0, 3), (1, 2), (records.len() / 2, 3), (records.len(), 1)] {
        let mut run = begin(threads);
        records[..kept].iter().for_each(|record| run.replay(record).unwrap());
        let (resumed, _) = finish(run);
        assert_eq!(resumed.to_json(), whole.to_json(), "after {kept} records");
        assert_eq!(resumed.history_csv(), whole.history_csv());
        assert_eq!(resumed.individuals_csv(), whole.individuals_csv());
    }
    let mut other = Run::new(problem("genetic", decay, &[2.0, 0.7], &NOISE), 1).unwrap();
    assert!(other.replay(&records[1]).unwrap_err().message.contains("checkpoint"));
}

#[test]
fn changes_are_recorded_and_replayed() {
    let begin = || Run::new(problem("genetic", decay, &[2.0, 0.7], &NOISE), 1).unwrap();
    let mut run = begin();
    let mut records = vec![run.step(0.0).unwrap(), run.step(1.0).unwrap()];
    run.change("mutation", 0.9).unwrap();
    run.change("min p1", 0.5).unwrap();
    run.change("evaluations", 400.0).unwrap();
    assert!(run.change("colour", 1.0).is_err());
    records.push(run.step(2.0).unwrap());
    let (whole, rest) = finish(run);
    let mut again = begin();
    records.iter().for_each(|record| again.replay(record).unwrap());
    let (resumed, _) = finish(again);
    assert_eq!(resumed.to_json(), whole.to_json());
    assert_eq!(whole.parameters[1].range[0], 0.5);
    assert_eq!(whole.effort.changes.len(), 3);
    assert!(rest.len() < 40, "the new limit holds");
}

#[test]
fn a_product_is_named_as_inseparable() {
    let product = |p: &[f64], x: f64| p[0] * p[1] * x + 1.0;
    let run = Run::new(problem("genetic", product, &[2.0, 3.0], &NOISE), 1).unwrap();
    let (solution, _) = finish(run);
    let note = &solution.findings[0].sentence;
    assert!(note.starts_with("p0, p1 are structurally non-identifiable from data"), "{note}");
    assert!(note.contains("depends only on p0*p1. Fix one of them."), "{note}");
    assert!(solution.parameters.iter().all(|p| p.determined == Some(false)));
}

#[test]
fn a_parameter_without_effect_is_named() {
    let line = |p: &[f64], x: f64| p[0] * x;
    let run = Run::new(problem("cma_es", line, &[2.0, 3.0], &NOISE), 1).unwrap();
    let (solution, _) = finish(run);
    assert_eq!(solution.findings[0].sentence, "p1 has no effect on the measured points.");
    assert!((solution.parameters[0].value - 2.0).abs() < 0.02);
    let model = solution.modelica();
    assert!(model.contains("extends M(\n    q = 1,\n    p0 = "), "{model}");
}

/// Over many realisations of normal noise the 95 % intervals contain the truth about as often as
/// they promise.
#[test]
fn intervals_cover_the_truth() {
    let mut rng = crate::ga::Mrg32k3a::new(&[12345.0; 6]).unwrap();
    let mut covered = [0; 2];
    for _ in 0..200 {
        let noise: Vec<f64> = (0..20).map(|_| 0.02 * rng.normal()).collect();
        let mut problem = problem("levenberg_marquardt", decay, &[2.0, 0.7], &noise);
        problem.polish = false;
        let (solution, _) = finish(Run::new(problem, 1).unwrap());
        for ((found, truth), count) in solution.parameters.iter().zip([2.0, 0.7]).zip(&mut covered)
        {
            let [low, high] = found.interval.unwrap();
            *count += usize::from(low < truth && truth < high);
        }
    }
    assert!(covered.iter().all(|count| (184..=196).contains(count)), "{covered:?} of 200");
}

/// The same of the polarization curve with 2 mV of noise, for what these data determine.
#[test]
fn intervals_cover_the_truth_of_a_polarization_curve() {
    const RUNS: usize = 100;
    const TRUTH: [f64; 6] = [0.039, 1.4e-3, 1.5856e-6, 0.0918, 0.7286, 0.2265];
    fn voltage(p: &[f64], x: f64) -> f64 {
        let i = 0.002 + 0.218 * x / 7.25 + p[1];
        1.2 - p[4] * i - p[0] * (i / p[2]).ln() + p[3] * (1.0 - i / p[5]).ln()
    }
    let mut rng = crate::ga::Mrg32k3a::new(&[12345.0; 6]).unwrap();
    let (mut covered, mut determined) = ([0; 6], [0; 6]);
    for _ in 0..RUNS {
        let noise: Vec<f64> = (0..30).map(|_| 0.002 * rng.normal()).collect();
        let mut problem = problem("levenberg_marquardt", voltage, &TRUTH, &noise);
        problem.polish = false;
        let free = |truth: f64| {
            // The end of the curve lies just below Ilim.
            let range = if truth == 0.2265 { [0.222, 1.0] } else { [truth / 1e3, truth * 1e3] };
            Free::new("p", "", range, Some(true), Some(truth)).unwrap()
        };
        problem.parameters = TRUTH.map(free).to_vec();
        let (solution, _) = finish(Run::new(problem, 1).unwrap());
        for (k, found) in solution.parameters.iter().enumerate() {
            let Some([low, high]) = found.interval.filter(|_| found.determined == Some(true))
            else {
                continue;
            };
            determined[k] += 1;
            covered[k] += usize::from(low < TRUTH[k] && TRUTH[k] < high);
        }
    }
    let share = |(covered, all): (&usize, &usize)| *covered as f64 / *all as f64;
    let always = covered.iter().zip(&determined).filter(|(_, all)| **all == RUNS);
    let shares: Vec<f64> = always.map(share).collect();
    assert!(shares.len() >= 3, "{determined:?}");
    let all = share((&covered.iter().sum(), &determined.iter().sum()));
    assert!((0.92..=0.98).contains(&all), "{covered:?} of {determined:?}");
    assert!(
        shares.iter().all(|share| (0.89..=1.0).contains(share)),
        "{covered:?} of {determined:?}"
    );
}

fn profiled(formula: fn(&[f64], f64) -> f64, truth: &[f64], noise: &[f64]) -> Solution {
    let mut run = Run::new(problem("genetic", formula, truth, noise), 2).unwrap();
    while run.stop().is_none() {
        run.step(0.0);
    }
    let mut solution = Solution::of(&run, "done", Vec::new()).unwrap();
    solution.add_profiles(&run);
    solution
}

/// The profile of a straight line is a parabola: its interval is that of the textbook, which is
/// what the sensitivities give.
#[test]
fn profiles_of_a_line_have_the_linear_interval() {
    let mut solution = profiled(|p, x| p[0] + p[1] * x, &[2.0, 0.7], &NOISE);
    let found = solution.profiles.take().unwrap();
    assert!(found.better.is_none());
    for (profile, parameter) in found.profiles.iter().zip(&solution.parameters) {
        // The parameters are searched on a logarithmic scale, on which their interval is reported.
        let half = distributions::student_quantile(0.975, 10.0) * parameter.deviation.unwrap();
        let linear = [parameter.value - half, parameter.value + half];
        for (end, linear) in profile.interval.iter().zip(linear) {
            assert!((end.unwrap() - linear).abs() < 0.01 * half, "{profile:?} {linear}");
        }
        assert!(profile.points.is_sorted_by(|a, b| a[0] < b[0]), "{profile:?}");
    }
}

#[test]
fn profiles_that_only_ranges_would_end_are_not_made() {
    let solution = profiled(|p, x| p[0] * p[1] * x + p[2], &[2.0, 3.0, 1.0], &NOISE);
    let found = solution.profiles.as_ref().unwrap();
    let names: Vec<&str> = found.profiles.iter().map(|own| own.name.as_str()).collect();
    assert_eq!(names, ["p2"]);
    assert!(sentences(&solution).contains("the model depends only on p0*p1"));
    let text = solution.text();
    assert!(text.contains("95 % by profiles: p0 -; p1 -; p2 in 0.9"), "{text}");
    let page = solution.html();
    assert!(page.contains(">Profiles</h2>") && page.contains("Without profile: p0, p1."), "{page}");
    assert!(solution.profiles_csv().lines().count() > 10);
}

#[test]
fn residuals_of_the_solver_are_no_missing_physics() {
    // Deterministic residuals far below the noise that the simulation is said to have.
    let wave: Vec<f64> = (0..12).map(|k| 1e-9 * f64::from(k).sin()).collect();
    let mut precise = problem("genetic", decay, &[2.0, 0.7], &wave);
    let note = |problem: Problem| sentences(&finish(Run::new(problem, 1).unwrap()).0);
    precise.noise = 1e-8;
    let text = note(precise);
    assert!(text.contains("as small as the errors of the simulation"), "{text}");
    assert!(!text.contains("does not describe part"), "{text}");
}

#[test]
fn equal_genes_are_simulated_once() {
    let mut run = Run::new(problem("gapilib2006", decay, &[2.0, 0.7], &NOISE), 2).unwrap();
    for generation in 0..5 {
        run.step(f64::from(generation)).unwrap();
    }
    assert_eq!(run.evaluations(), 500);
    // The elite of each later generation at least; parents that are alike have children like them.
    assert!((450..=496).contains(&run.simulations), "{}", run.simulations);
}

/// What is written is enough to draw the same page again.
#[test]
fn a_report_is_drawn_again_from_its_files() {
    let run = Run::new(problem("genetic", decay, &[2.0, 0.7], &NOISE), 1).unwrap();
    let (mut solution, _) = finish(run);
    // As of a validation whose simulation failed.
    let mut series = solution.series[0].clone();
    series.rmse = f64::NAN;
    series.points[0][2] = f64::NAN;
    solution.validation.push(series);
    let (history, individuals) = (solution.history_csv(), solution.individuals_csv());
    let again = Solution::read(&solution.to_json(), &history, &individuals).unwrap();
    assert_eq!(again.html(), solution.html());
    assert_eq!(again.to_json(), solution.to_json());
    let wrong = Solution::read("{}", &history, &individuals).unwrap_err();
    assert!(wrong.message.contains("result.json"), "{}", wrong.message);
    let cut = individuals[..individuals.len() / 2].rfind(',').unwrap();
    let wrong = Solution::read(&solution.to_json(), &history, &individuals[..cut]);
    assert!(wrong.unwrap_err().message.contains("`individuals.csv` is damaged"));
}
