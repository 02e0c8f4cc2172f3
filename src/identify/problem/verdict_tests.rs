//! Verdicts against closed forms, and against profiles that are computed here.

use super::irregular_tests::line;
use super::statistics::student_quantile;
use super::tests::{decay, problem};
use super::{
    EndingKind, FindingKind, Free, Problem, Run, Solution, SolvedParameter, Stop, Verdict, conclude,
};

use crate::ga::optimizer::METHODS;
use crate::registry::{self, Options};

type Formula = fn(&[f64], f64) -> f64;

const NOISE: [f64; 16] = [
    0.013, -0.022, 0.01, 0.025, -0.03, 0.005, -0.015, 0.02, -0.01, 0.0, -0.025, 0.015, 0.008,
    -0.012, 0.021, -0.005,
];

/// A problem at x = 0, 0.25, .. with `data` plus noise, and named parameters with their ranges.
fn posed(formula: Formula, ranges: &[(&str, [f64; 2])], data: fn(f64) -> f64) -> Problem {
    let mut own = problem("genetic", formula, &vec![1.0; ranges.len()], &NOISE);
    let free = |(name, range): &(&str, [f64; 2])| Free::new(*name, "", *range, None, None).unwrap();
    own.parameters = ranges.iter().map(free).collect();
    let series = &mut own.series[0];
    series.y = series.x.iter().zip(NOISE).map(|(x, e)| data(*x) + e).collect();
    own.stop = Stop { evaluations: Some(20_000), ..Stop::default() };
    own
}

fn solved(problem: Problem) -> Solution {
    let mut run = Run::new(problem, 1).unwrap();
    while run.stop().is_none() {
        run.step(0.0);
    }
    conclude(&mut run);
    Solution::settled(&mut run, |run| Solution::of(run, "done", Vec::new())).unwrap()
}

fn parameter<'a>(solution: &'a Solution, name: &str) -> &'a SolvedParameter {
    solution.parameters.iter().find(|own| own.name == name).unwrap()
}

fn sentences(solution: &Solution) -> String {
    solution.findings.iter().map(|f| f.sentence.as_str()).collect::<Vec<_>>().join("\n")
}

fn near(found: f64, expected: f64, tolerance: f64) {
    assert!((found - expected).abs() <= tolerance, "{found} instead of {expected}");
}

/// The rise of the sum of squares within a likelihood interval, relative to the least.
fn rise(parameters: usize) -> f64 {
    let freedom = (NOISE.len() - parameters) as f64;
    student_quantile(0.975, freedom).powi(2) / freedom
}

/// [`line`] of a model's data with the noise.
fn line_through(data: fn(f64) -> f64) -> [f64; 3] {
    let at = (0..NOISE.len()).map(|k| k as f64 / 4.0);
    line(&at.zip(NOISE).map(|(x, e)| (x, data(x) + e)).collect::<Vec<_>>())
}

/// A falling line with a slope that must not be negative: the best slope is the end of its range, and
/// the largest that fits follows from the regression, whatever the range and its scale.
#[test]
fn at_an_end_of_its_range_a_parameter_is_bounded_on_one_side() {
    let data = |x: f64| 2.0 - 0.004 * x;
    let [slope, sxx, rest] = line_through(data);
    assert!(slope < 0.0);
    for range in [[1e-5, 1e5], [1e-8, 1e2], [0.0, 5.0], [0.0, 500.0]] {
        let solution =
            solved(posed(|p, x| p[0] + p[1] * x, &[("b", [-10.0, 10.0]), ("c", range)], data));
        let c = parameter(&solution, "c");
        let least = rest + (range[0] - slope).powi(2) * sxx;
        let highest = slope + ((least * (1.0 + rise(2)) - rest) / sxx).sqrt();
        let [low, high] = c.interval.unwrap();
        assert!(low == range[0] && c.at_bound, "{c:?}");
        near(high, highest, 2e-3 * highest);
        assert_eq!(c.open, [true, false]);
        assert_eq!(c.verdict, Some(Verdict::PracticallyNonIdentifiable));
        assert!(sentences(&solution).contains("it is at most"), "{}", sentences(&solution));
        assert_eq!(parameter(&solution, "b").verdict, Some(Verdict::Identifiable));
    }
}

/// The verdict and the interval of a parameter do not depend on a range that holds the interval.
#[test]
fn the_width_of_the_range_does_not_decide() {
    let data = |x: f64| 1.0 + 0.004 * x;
    let found: Vec<SolvedParameter> = [0.2, 2.0, 2e3, 2e6]
        .map(|width| {
            let ranges = [("b", [-10.0, 10.0]), ("c", [-width, width])];
            parameter(&solved(posed(|p, x| p[0] + p[1] * x, &ranges, data)), "c").clone()
        })
        .into();
    let [slope, sxx, rest] = line_through(data);
    let half = (rest * rise(2) / sxx).sqrt();
    assert!(slope - half < 0.0, "the interval holds 0");
    for own in &found {
        let [low, high] = own.interval.unwrap();
        near(low, slope - half, 1e-3 * half);
        near(high, slope + half, 1e-3 * half);
        assert_eq!(own.verdict, Some(Verdict::Identifiable), "{own:?}");
    }
}

/// A value of 1e-7 in a range from 0 to 1 is a hundred standard errors away from 0.
#[test]
fn a_small_value_in_a_wide_range_is_not_at_its_end() {
    let data = |x: f64| 1.0 + x;
    let ranges = [("b", [-10.0, 10.0]), ("c", [0.0, 1.0])];
    let solution = solved(posed(|p, x| p[0] + 1e7 * p[1] * x, &ranges, data));
    let [slope, sxx, rest] = line_through(data);
    let c = parameter(&solution, "c");
    let half = 1e-7 * (rest * rise(2) / sxx).sqrt();
    let [low, high] = c.interval.unwrap();
    near(c.value, 1e-7 * slope, 1e-3 * half);
    near(low, 1e-7 * slope - half, 1e-3 * half);
    near(high, 1e-7 * slope + half, 1e-3 * half);
    assert!(!c.at_bound && c.verdict == Some(Verdict::Identifiable), "{c:?}");
}

/// A range that begins at 0 is searched at small values, too: elsewhere the model is constant.
#[test]
fn a_range_from_zero_is_no_plateau() {
    let data = |x: f64| 1.0 - (-0.7 * x).exp();
    let ranges = [("q", [0.0, 5.0]), ("d", [0.0, 1e-9])];
    let solution = solved(posed(|p, x| p[0] * (1.0 - (-p[1] * x / 4e-14).exp()), &ranges, data));
    let d = parameter(&solution, "d");
    near(d.value, 2.8e-14, 3e-15);
    assert_eq!(d.verdict, Some(Verdict::Identifiable), "{d:?}");
}

/// The sum of squares with one parameter of A (1 − exp(−k x)) given, A being linear.
fn response(k: f64, data: fn(f64) -> f64) -> f64 {
    let x: Vec<f64> = (0..NOISE.len()).map(|j| j as f64 / 4.0).collect();
    let y: Vec<f64> = x.iter().zip(NOISE).map(|(x, e)| data(*x) + e).collect();
    let shape: Vec<f64> = x.iter().map(|x| 1.0 - (-k * x).exp()).collect();
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let a = dot(&shape, &y) / dot(&shape, &shape);
    y.iter().zip(&shape).map(|(y, s)| (y - a * s).powi(2)).sum()
}

/// A response that is over before the second sample bounds its rate from below alone; its amplitude
/// is the mean of the others, with their standard error.
#[test]
fn a_rate_that_is_too_fast_is_bounded_from_below() {
    let data = |x: f64| if x > 0.0 { 2.0 } else { 0.0 };
    let ranges = [("A", [0.1, 10.0]), ("k", [1e-3, 1e5])];
    let solution = solved(posed(|p, x| p[0] * (1.0 - (-p[1] * x).exp()), &ranges, data));
    assert_eq!(solution.outcome.ending.kind, EndingKind::Minimum, "{:?}", solution.outcome.ending);
    let all = (0..2000).map(|j| response(1.007f64.powi(j), data));
    let least = all.fold(response(1e4, data), f64::min);
    let limit = least * (1.0 + rise(2));
    let (mut low, mut high) = (1.0, 1e4);
    for _ in 0..60 {
        let middle = f64::sqrt(low * high);
        *(if response(middle, data) > limit { &mut low } else { &mut high }) = middle;
    }
    let k = parameter(&solution, "k");
    assert_eq!((k.open, k.verdict), ([false, true], Some(Verdict::PracticallyNonIdentifiable)));
    near(k.interval.unwrap()[0], high, 5e-3 * high);
    assert!(sentences(&solution).contains("it is at least"), "{}", sentences(&solution));
    let a = parameter(&solution, "A");
    let error = (least / 14.0 / 15.0).sqrt();
    near(a.deviation.unwrap(), error, 0.1 * error);
    assert_eq!(a.verdict, Some(Verdict::Identifiable));
}

/// The sums of squares of y = A (exp(−k x) − exp(−l x)) with A fitted.
fn two_rates(k: f64, l: f64, data: fn(f64) -> f64) -> f64 {
    let x: Vec<f64> = (0..NOISE.len()).map(|j| j as f64 / 4.0).collect();
    let y: Vec<f64> = x.iter().zip(NOISE).map(|(x, e)| data(*x) + e).collect();
    let shape: Vec<f64> = x.iter().map(|x| (-k * x).exp() - (-l * x).exp()).collect();
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let a = dot(&shape, &y) / dot(&shape, &shape);
    y.iter().zip(&shape).map(|(y, s)| (y - a * s).powi(2)).sum()
}

/// Two minima that exchange two rates have two intervals, and nothing between them fits.
#[test]
fn two_minima_have_separate_intervals() {
    let data = |x: f64| 3.0 * ((-0.3 * x).exp() - (-2.0 * x).exp());
    let ranges = [("A", [-10.0, 10.0]), ("k", [0.05, 5.0]), ("l", [0.05, 5.0])];
    let formula: Formula = |p, x| p[0] * ((-p[1] * x).exp() - (-p[2] * x).exp());
    let solution = solved(posed(formula, &ranges, data));
    let k = parameter(&solution, "k");
    assert_eq!(k.pieces.len(), 2, "{k:?}\n{}", sentences(&solution));
    assert!(k.pieces[0][1] < k.pieces[1][0]);
    assert!(k.pieces.contains(&k.interval.unwrap()), "{k:?}");
    let best = |k: f64| {
        (1..4000)
            .map(|j| two_rates(k, 0.05 * 1.00115f64.powi(j), data))
            .fold(f64::INFINITY, f64::min)
    };
    let least = best(0.3).min(best(k.value));
    let limit = least * (1.0 + rise(3));
    let between = 0.5 * (k.pieces[0][1] + k.pieces[1][0]);
    assert!(best(between) > limit, "{between}");
    for [low, high] in &k.pieces {
        let inside = (low * high).sqrt();
        assert!(best(inside) <= limit, "{inside} of {k:?}: {} {limit}", best(inside));
        near(best(*low), limit, 0.05 * (limit - least));
        near(best(*high), limit, 0.05 * (limit - least));
    }
    let a = parameter(&solution, "A");
    assert!(a.pieces.iter().all(|[low, high]| *low > 0.0 || *high < 0.0), "{a:?}");
    assert_eq!(a.verdict, Some(Verdict::Identifiable));
}

/// A slope that changes at a time, and the best time is a sampled one: the objective has a kink there.
#[test]
fn a_minimum_at_a_kink_is_one() {
    let data = |x: f64| if x < 2.0 { x } else { 2.0 + 3.0 * (x - 2.0) };
    let ranges = [("a", [0.1, 10.0]), ("b", [0.1, 10.0]), ("t", [0.3, 3.6])];
    // The residual at x = 2 alone changes its derivative: with this point above the lines, t = 2.
    let formula: Formula = |p, x| if x < p[2] { p[0] * x } else { p[0] * p[2] + p[1] * (x - p[2]) };
    let mut own = posed(formula, &ranges, data);
    own.series[0].y[8] -= 0.1;
    let solution = solved(own);
    assert_eq!(solution.outcome.ending.kind, EndingKind::Minimum, "{:?}", solution.outcome.ending);
    let t = parameter(&solution, "t");
    let [low, high] = t.interval.unwrap();
    assert!(low < t.value && t.value < high && high - low < 0.5, "{t:?}");
    for name in ["a", "b"] {
        let own = parameter(&solution, name);
        assert!(own.deviation.is_some() && own.verdict == Some(Verdict::Identifiable), "{own:?}");
    }
}

/// Data of the model itself: the fit is a minimum, the verdicts are those of the rank, and there is no
/// noise of which intervals could be made.
#[test]
fn exact_data_have_verdicts_and_no_intervals() {
    for rounding in [0.0, 1e10] {
        let mut own = problem("genetic", decay, &[2.0, 0.7], &[0.0; 12]);
        own.noise = 1e-8;
        if rounding > 0.0 {
            own.series[0].y.iter_mut().for_each(|y| *y = (*y * rounding).round() / rounding);
        }
        let solution = solved(own);
        assert_eq!(
            solution.outcome.ending.kind,
            EndingKind::Minimum,
            "{:?}",
            solution.outcome.ending
        );
        for own in &solution.parameters {
            assert_eq!(own.verdict, Some(Verdict::Identifiable), "{own:?}");
            assert!(own.interval.is_none() && own.deviation.is_none(), "{own:?}");
        }
        let product: Formula = |p, x| p[0] * p[1] * (-x).exp();
        let solution = solved(problem("genetic", product, &[2.0, 0.7], &[0.0; 12]));
        let is_group =
            |own: &SolvedParameter| own.verdict == Some(Verdict::StructurallyNonIdentifiable);
        assert!(solution.parameters.iter().all(is_group), "{}", sentences(&solution));
    }
}

/// Parameters that only act through a function of them are a structural group, and the function is
/// named.
#[test]
fn functions_of_parameters_are_named() {
    let tafel: Formula = |p, x| p[0] - p[1] * ((x + 0.1) / p[2]).ln();
    let arrhenius: Formula = |p, x| p[0] * (-p[1] / 2494.0).exp() * x;
    let power: Formula = |p, x| p[0] * (p[1] * (x + 0.5)).powf(p[2]);
    type Ranges = &'static [(&'static str, [f64; 2])];
    type Case = (Formula, Ranges, fn(f64) -> f64, &'static str, &'static [&'static str]);
    let cases: [Case; 3] = [
        (
            tafel,
            &[("E", [-5.0, 5.0]), ("A", [0.01, 2.0]), ("i0", [1e-9, 1e3])],
            |x| 1.0 - 0.3 * (x + 0.1).ln(),
            "depends only on E + A*log(i0). Fix one of them.",
            &["E", "i0"],
        ),
        (
            arrhenius,
            &[("k0", [1e2, 1e9]), ("Ea", [1e4, 6e4])],
            |x| 3.0 * x,
            "depends only on log(k0) - 4.01e-4*Ea. Fix one of them.",
            &["k0", "Ea"],
        ),
        (
            power,
            &[("a", [0.1, 100.0]), ("k", [0.1, 100.0]), ("b", [0.1, 5.0])],
            |x| 3.0 * (x + 0.5).powf(1.5),
            "depends only on log(a) + b*log(k). Fix one of them.",
            &["a", "k"],
        ),
    ];
    for (formula, ranges, data, words, members) in cases {
        let solution = solved(posed(formula, ranges, data));
        assert!(sentences(&solution).contains(words), "{}", sentences(&solution));
        for own in &solution.parameters {
            let is_member = members.contains(&own.name.as_str());
            let expected = match is_member {
                true => Verdict::StructurallyNonIdentifiable,
                false => Verdict::Identifiable,
            };
            assert_eq!(own.verdict, Some(expected), "{own:?}");
        }
    }
}

/// A search that has only seen the neighborhood of the best point, as least squares after a script does,
/// cannot tell a product from a sum there; the statistics look farther.
#[test]
fn a_product_is_named_after_a_search_nearby() {
    let formula: Formula = |p, x| 10.0 * (-x / (p[0] * p[1])).exp();
    let mut near =
        posed(formula, &[("R", [0.5, 8.0]), ("C", [0.5, 8.0])], |x| 10.0 * (-x / 4.0).exp());
    let method = registry::find("method", METHODS, "levenberg_marquardt").unwrap();
    near.method = (method.make)(&mut Options::default()).unwrap();
    for (free, start) in near.parameters.iter_mut().zip([1.3062, 3.0683]) {
        free.start = Some(start);
    }
    let solution = solved(near);
    assert!(sentences(&solution).contains("depends only on R*C. Fix"), "{}", sentences(&solution));
    for own in &solution.parameters {
        assert_eq!(own.verdict, Some(Verdict::StructurallyNonIdentifiable), "{own:?}");
    }
}

/// Far below saturation, Michaelis-Menten kinetics bound neither parameter from above, but their ratio:
/// it lies between those of the best fits with K at every value that the data admit.
#[test]
fn what_the_data_determine_of_open_parameters_is_named() {
    let ranges = [("Vm", [0.1, 1e4]), ("K", [0.1, 1e4])];
    let formula: Formula = |p, x| p[0] * x / (p[1] + x);
    let data = |x: f64| 200.0 * x / (400.0 + x);
    let solution = solved(posed(formula, &ranges, data));
    let text = sentences(&solution);
    assert!(text.contains("Of Vm and K, these data determine Vm/K"), "{text}");
    let interval = text.split("its 95 % interval is ").nth(1).unwrap().split(".\n").next().unwrap();
    let ends: Vec<f64> =
        interval.trim_end_matches('.').split(" to ").map(|end| end.parse().unwrap()).collect();
    let x: Vec<f64> = (0..NOISE.len()).map(|j| j as f64 / 4.0).collect();
    let y: Vec<f64> = x.iter().zip(NOISE).map(|(x, e)| data(*x) + e).collect();
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    // The sum of squares and the best ratio with K given.
    let fit = |k: f64| {
        let shape: Vec<f64> = x.iter().map(|x| x / (1.0 + x / k)).collect();
        let ratio = dot(&shape, &y) / dot(&shape, &shape);
        let rest: f64 = y.iter().zip(&shape).map(|(y, s)| (y - ratio * s).powi(2)).sum();
        (rest, ratio)
    };
    let all: Vec<(f64, f64)> = (0..3800).map(|j| fit(1.0024f64.powi(j))).collect();
    let least = all.iter().map(|own| own.0).fold(f64::INFINITY, f64::min);
    let within = all.iter().filter(|own| own.0 <= least * (1.0 + rise(2)));
    let ratios: Vec<f64> = within.map(|own| own.1).collect();
    for ratio in &ratios {
        assert!(ends[0] < *ratio && *ratio < ends[1], "{ratio} {ends:?}");
    }
    assert!(ends[1] / ends[0] < 1.2, "{ends:?}");
    let k = parameter(&solution, "K");
    assert_eq!((k.open, k.verdict), ([false, true], Some(Verdict::PracticallyNonIdentifiable)));
}

/// A combination has the standard error that it has as a parameter: E + A ln i0 is the ordinate of a
/// straight line over ln x.
#[test]
fn a_function_has_the_interval_of_a_regression() {
    let formula: Formula = |p, x| p[0] - p[1] * (-(x - 1.0) - p[2].ln());
    let ranges = [("E", [-5.0, 5.0]), ("A", [0.01, 2.0]), ("i0", [1e-9, 1e3])];
    let data = |x: f64| 1.0 + 0.3 * (x - 1.0);
    let solution = solved(posed(formula, &ranges, data));
    let [_, sxx, rest] = line_through(data);
    // At x = 1 the line has this value, with t s √(1/n + (1 − mean)²/Sxx).
    let mean = 15.0 / 8.0;
    let half = student_quantile(0.975, 14.0)
        * (rest / 14.0 * (1.0 / 16.0 + (1.0f64 - mean).powi(2) / sxx)).sqrt();
    let text = sentences(&solution);
    let interval = text.split("(95 % interval ").nth(1).unwrap().split(')').next().unwrap();
    let ends: Vec<f64> = interval.split(" to ").map(|end| end.parse().unwrap()).collect();
    // Four digits are printed; with a degree of freedom less the width is larger by 0.0011.
    near(ends[1] - ends[0], 2.0 * half, 5.5e-4);
}

/// What cannot be computed within the budget is not said.
#[test]
fn without_its_profile_nothing_is_said_of_a_parameter() {
    let data = |x: f64| 2.0 - 0.004 * x;
    let ranges = [("b", [-10.0, 10.0]), ("c", [1e-5, 1e5])];
    let mut run = Run::new(posed(|p, x| p[0] + p[1] * x, &ranges, data), 1).unwrap();
    while run.stop().is_none() {
        run.step(0.0);
    }
    conclude(&mut run);
    let flag = std::sync::Arc::new(std::sync::atomic::AtomicBool::new(true));
    run.evaluation.cancel_by(Some(flag));
    let stopped = Solution::of(&run, "done", Vec::new()).unwrap_err();
    assert!(stopped.message.contains("stopped"), "{}", stopped.message);
    let found = Solution::of_search(&run, "done", Vec::new()).unwrap();
    let text = found.without_statistics("the time limit is reached: 5 s").text();
    assert!(text.contains("the time limit is reached: 5 s"), "{text}");
    assert!(text.contains("no statements on identifiability"), "{text}");
    assert!(!text.contains("any value"), "{text}");
}

/// Every verdict has a sentence that follows it: no parameter is said to be bounded that is open.
#[test]
fn the_table_says_what_the_verdict_says() {
    let data = |x: f64| 2.0 - 0.004 * x;
    let ranges = [("b", [-10.0, 10.0]), ("c", [1e-5, 1e5])];
    let solution = solved(posed(|p, x| p[0] + p[1] * x, &ranges, data));
    let text = solution.text();
    let row = text.lines().find(|line| line.trim_start().starts_with("c ")).unwrap();
    assert!(row.contains("at most 0.0"), "{row}");
    assert!(row.contains("practically non-identifiable"), "{row}");
    let kinds = solution.findings.iter().filter(|f| f.parameters == ["c"]).count();
    assert_eq!(kinds, 1, "{}", sentences(&solution));
    assert_eq!(solution.findings[0].kind, FindingKind::PracticallyNonIdentifiable);
}

/// The model reaches the data only outside the range: whichever end that is, at whichever scale, the
/// report begins with the range, and says nothing that a wider range would change.
#[test]
fn a_range_that_keeps_the_model_from_the_data_is_named_first() {
    let slow: Formula = |p, x| 10.0 * (-p[0] * x).exp();
    let late: Formula = |p, x| 10.0 * (-p[0] * (x + 1e3)).exp();
    let growing: Formula = |p, x| (p[0] * x).exp();
    let lagging: Formula = |p, x| 3.0 * (1.0 - (-x / p[0]).exp());
    type Case = (Formula, [f64; 2], fn(f64) -> f64, &'static str);
    let cases: [Case; 4] = [
        (slow, [2.0, 200.0], |x| 10.0 * (-0.1 * x).exp(), "down to 0.02"),
        (late, [0.1, 10.0], |x| 10.0 * (-1e-3 * (x + 1e3)).exp(), "may lie outside"),
        (growing, [0.01, 0.1], |x| (2.0 * x).exp(), "up to 0.19"),
        (lagging, [1e-3, 0.1], |x| 3.0 * (1.0 - (-x / 8.0).exp()), "up to 10"),
    ];
    for (formula, range, data, remedy) in cases {
        let solution = solved(posed(formula, &[("k", range)], data));
        let said = sentences(&solution);
        assert_eq!(solution.findings[0].kind, FindingKind::AtBound, "{said}");
        assert!(solution.findings[0].sentence.contains("Widen the range"), "{said}");
        assert!(said.contains(remedy) && !said.contains("any value"), "{said}");
        let k = parameter(&solution, "k");
        assert_eq!((k.verdict, k.interval, k.open), (None, None, [false; 2]), "{said}");
        let ending = &solution.outcome.ending;
        assert_eq!(ending.words.contains("within the search ranges"), k.at_bound, "{ending:?}");
    }
}

/// A bound that the data confirm is not blamed: the fit is as good as it can be.
#[test]
fn a_range_that_holds_the_best_value_is_not_blamed() {
    let ranges = [("b", [-10.0, 10.0]), ("c", [0.0, 5.0])];
    let solution = solved(posed(|p, x| p[0] + p[1] * x, &ranges, |x| 2.0 - 0.004 * x));
    let said = sentences(&solution);
    assert!(!said.contains("drawn around") && said.contains("it is at most"), "{said}");
}
