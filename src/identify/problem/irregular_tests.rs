//! Minima that are not regular, against closed forms: straight lines whose slope is a square, a cube or
//! the amplitude of a step.

use super::statistics::student_quantile;
use super::tests::problem;
use super::{EndingKind, Free, Run, Solution, Stop, conclude};

const NOISE: [f64; 16] = [
    0.13, -0.22, 0.1, 0.25, -0.3, 0.05, -0.15, 0.2, -0.1, 0.0, -0.25, 0.15, 0.08, -0.12, 0.21,
    -0.05,
];

fn solved(formula: fn(&[f64], f64) -> f64, ranges: &[[f64; 2]], data: fn(f64) -> f64) -> Solution {
    let mut own = problem("genetic", formula, &vec![1.0; ranges.len()], &NOISE);
    let free = |(k, range): (usize, &[f64; 2])| {
        Free::new(format!("p{k}"), "", *range, Some(false), None).unwrap()
    };
    own.parameters = ranges.iter().enumerate().map(free).collect();
    let series = &mut own.series[0];
    series.y = series.x.iter().zip(NOISE).map(|(x, e)| data(*x) + e).collect();
    own.stop = Stop { evaluations: Some(20_000), ..Stop::default() };
    let mut run = Run::new(own, 1).unwrap();
    while run.stop().is_none() {
        run.step(0.0);
    }
    conclude(&mut run);
    let solution = Solution::of(&run, "done", Vec::new()).unwrap();
    assert_eq!(solution.outcome.ending.kind, EndingKind::Minimum, "{:?}", solution.outcome.ending);
    solution
}

fn points(data: fn(f64) -> f64) -> Vec<(f64, f64)> {
    (0..NOISE.len()).map(|k| k as f64 / 4.0).zip(NOISE).map(|(x, e)| (x, data(x) + e)).collect()
}

/// Slope, Σ(x − mean)² and the least sum of squares of a straight line.
pub(super) fn line(points: &[(f64, f64)]) -> [f64; 3] {
    let n = points.len() as f64;
    let (mx, my) = points.iter().fold((0.0, 0.0), |(a, b), (x, y)| (a + x / n, b + y / n));
    let sxx: f64 = points.iter().map(|(x, _)| (x - mx) * (x - mx)).sum();
    let slope = points.iter().map(|(x, y)| (x - mx) * (y - my)).sum::<f64>() / sxx;
    let rest = points.iter().map(|(x, y)| (y - my - slope * (x - mx)).powi(2)).sum();
    [slope, sxx, rest]
}

/// The rise of the sum of squares within a likelihood interval, relative to the least.
fn rise() -> f64 {
    let freedom = (NOISE.len() - 2) as f64;
    student_quantile(0.975, freedom).powi(2) / freedom
}

fn near(found: f64, expected: f64, width: f64) {
    assert!((found - expected).abs() < 2e-3 * width, "{found} {expected}");
}

/// y = a + p² x of falling data: the best p is 0, where ∂y/∂p vanishes. Its interval is where the sum
/// of squares over slopes q = p² stays below the limit.
#[test]
fn a_square_at_zero_is_a_minimum_with_the_interval_of_its_profile() {
    let data = |x: f64| 1.0 - 0.02 * x;
    let ranges = [[-10.0, 10.0], [-3.0, 3.0]];
    let solution = solved(|p, x| p[0] + p[1] * p[1] * x, &ranges, data);
    assert!(
        solution.outcome.ending.words.contains("second derivatives"),
        "{}",
        solution.outcome.ending.words
    );
    let [slope, sxx, rest] = line(&points(data));
    assert!(slope < 0.0);
    let at_zero = rest + slope * slope * sxx;
    let q = slope + ((at_zero * (1.0 + rise()) - rest) / sxx).sqrt();
    let [low, high] = solution.parameters[1].interval.unwrap();
    near(low, -q.sqrt(), q.sqrt());
    near(high, q.sqrt(), q.sqrt());
    assert!(solution.parameters[1].deviation.is_none());
}

/// y = a + p³ x: the likelihood interval of the slope, and its cube roots.
#[test]
fn a_cube_has_the_interval_of_its_profile() {
    let data = |x: f64| 1.0 + 0.05 * x;
    let ranges = [[-10.0, 10.0], [-3.0, 3.0]];
    let solution = solved(|p, x| p[0] + p[1] * p[1] * p[1] * x, &ranges, data);
    let [slope, sxx, rest] = line(&points(data));
    let reach = (rest * rise() / sxx).sqrt();
    let [low, high] = solution.parameters[1].interval.unwrap();
    let expected = [(slope - reach).cbrt(), (slope + reach).cbrt()];
    near(low, expected[0], expected[1] - expected[0]);
    near(high, expected[1], expected[1] - expected[0]);
    assert!(solution.parameters[1].by_profile && !solution.parameters[0].by_profile);
}

/// y = a for x up to p, and a + b beyond: intervals go over all steps whose best fit is within the
/// limit, found here by brute force.
#[test]
fn a_step_has_the_interval_of_all_steps_that_fit() {
    let data = |x: f64| if x > 1.9 { 1.3 } else { 1.0 };
    let ranges = [[-10.0, 10.0], [-10.0, 10.0], [0.1, 3.6]];
    let formula = |p: &[f64], x: f64| if x > p[2] { p[0] + p[1] } else { p[0] };
    let solution = solved(formula, &ranges, data);
    let points = points(data);
    let fit = |after: usize| -> (f64, f64) {
        let mean =
            |part: &[(f64, f64)]| part.iter().map(|point| point.1).sum::<f64>() / part.len() as f64;
        let square = |part: &[(f64, f64)]| {
            part.iter().map(|point| (point.1 - mean(part)).powi(2)).sum::<f64>()
        };
        let (early, late) = points.split_at(after);
        (square(early) + square(late), mean(late) - mean(early))
    };
    let freedom = (NOISE.len() - 3) as f64;
    let all: Vec<(usize, f64, f64)> =
        (1..NOISE.len() - 1).map(|after| (after, fit(after).0, fit(after).1)).collect();
    let least = all.iter().map(|own| own.1).fold(f64::INFINITY, f64::min);
    let limit = least * (1.0 + student_quantile(0.975, freedom).powi(2) / freedom);
    let within: Vec<&(usize, f64, f64)> = all.iter().filter(|own| own.1 <= limit).collect();
    assert!(within.len() > 1, "one step alone would show nothing: {all:?}");
    // The step lies between the last point before it and the first after it.
    let ends = [
        points[within[0].0 - 1].0.max(ranges[2][0]),
        points[within[within.len() - 1].0].0.min(ranges[2][1]),
    ];
    let [low, high] = solution.parameters[2].interval.unwrap();
    near(low, ends[0], 3.0);
    near(high, ends[1], 3.0);
    let [low, high] = solution.parameters[1].interval.unwrap();
    for (_, _, amplitude) in within {
        assert!(low < *amplitude && *amplitude < high, "{low} {amplitude} {high}");
    }
}

/// y = a e^(−kx) + c with c at least 0 where the unconstrained minimum is less: c and its gradient
/// are reported, and the intervals of the others are those with c = 0.
#[test]
fn at_an_end_that_the_data_contradict_the_others_hold_with_it() {
    let data = |x: f64| 5.0 * (-x).exp() - 0.6;
    let with = |p: &[f64], x: f64| p[0] * (-p[1] * x).exp() + p[2];
    let ranges = [[0.1, 20.0], [0.1, 10.0], [0.0, 3.0]];
    let solution = solved(with, &ranges, data);
    let without = solved(|p, x| p[0] * (-p[1] * x).exp(), &ranges[..2], data);
    assert_eq!(solution.parameters[2].interval, None);
    assert_eq!(solution.parameters[2].verdict, None);
    let freedom = [13.0, 14.0].map(|freedom: f64| student_quantile(0.975, freedom));
    for (own, alone) in solution.parameters.iter().zip(&without.parameters) {
        // The residual variance shows the one degree of freedom less.
        let expected = alone.deviation.unwrap() * (14.0_f64 / 13.0).sqrt();
        assert!((own.deviation.unwrap() - expected).abs() < 1e-4 * expected);
        let half = |p: &super::SolvedParameter| p.interval.map(|[a, b]| 0.5 * (b - a)).unwrap();
        let expected = half(alone) * (14.0_f64 / 13.0).sqrt() * freedom[0] / freedom[1];
        near(half(own), expected, expected);
    }
}
