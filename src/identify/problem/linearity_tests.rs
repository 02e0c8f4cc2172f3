//! Reported intervals against exact profiles: of A exp(−k t) + c one parameter is held and the best of the
//! others is found by brute force.

use super::statistics::student_quantile;
use super::tests::problem;
use super::{Free, Problem, Run, Solution, SolvedParameter, Verdict};
use crate::ga::Mrg32k3a;

const N: usize = 12;

/// Points of a decay with an offset at t = 0, 1, .., with noise of this size.
fn posed(noise: f64, rng: &mut Mrg32k3a) -> Problem {
    let errors: Vec<f64> = (0..N).map(|_| noise * rng.normal()).collect();
    // The points of `problem` lie a quarter apart.
    let formula = |p: &[f64], x: f64| p[0] * (-4.0 * p[1] * x).exp() + p[2];
    let truth = [1.0, 0.2, 0.3];
    let mut own = problem("levenberg_marquardt", formula, &truth, &errors);
    own.polish = false;
    let ranges = [("A", [0.1, 10.0]), ("k", [5e-4, 20.0]), ("c", [-20.0, 20.0])];
    let free = |((name, range), truth): (&(&str, [f64; 2]), &f64)| {
        Free::new(*name, "", *range, None, Some(*truth)).unwrap()
    };
    own.parameters = ranges.iter().zip(&truth).map(free).collect();
    own
}

fn solved(problem: Problem) -> Solution {
    let mut run = Run::new(problem, 1).unwrap();
    while run.stop().is_none() {
        run.step(0.0);
    }
    Solution::of(&run, "done", Vec::new()).unwrap()
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// The sum of squares of y − A e − c, with A or c given, or none of them.
fn rest(y: &[f64], e: &[f64], given: [Option<f64>; 2]) -> f64 {
    let mean = |v: &[f64]| v.iter().sum::<f64>() / v.len() as f64;
    let less = |v: &[f64], by: f64| v.iter().map(|v| v - by).collect::<Vec<f64>>();
    match given {
        [Some(a), _] => {
            let left: Vec<f64> = y.iter().zip(e).map(|(y, e)| y - a * e).collect();
            let left = less(&left, mean(&left));
            dot(&left, &left)
        }
        [None, Some(c)] => {
            let left = less(y, c);
            dot(&left, &left) - dot(&left, e).powi(2) / dot(e, e)
        }
        [None, None] => {
            let (y, e) = (less(y, mean(y)), less(e, mean(e)));
            dot(&y, &y) - dot(&y, &e).powi(2) / dot(&e, &e)
        }
    }
}

/// The least sum of squares with the parameter at this place held, over 4000 rates.
fn profile(y: &[f64], held: Option<(usize, f64)>) -> f64 {
    let decay = |k: f64| (0..N).map(|t| (-k * t as f64).exp()).collect::<Vec<f64>>();
    let given = |place: usize| held.filter(|own| own.0 == place).map(|own| own.1);
    let rates = match given(1) {
        Some(k) => vec![k],
        None => (0..4000).map(|j| 5e-4 * 4e4_f64.powf(f64::from(j) / 3999.0)).collect(),
    };
    let sums = rates.into_iter().map(|k| rest(y, &decay(k), [given(0), given(2)]));
    sums.fold(f64::INFINITY, f64::min)
}

/// How many of the parameters' intervals are linear, and at all ends that no range makes the part of the
/// rise to the limit that the exact profile has there.
fn ends(solution: &Solution, y: &[f64]) -> (usize, Vec<f64>) {
    let least = profile(y, None);
    let freedom = (N - 3) as f64;
    let rise = least * student_quantile(0.975, freedom).powi(2) / freedom;
    let of = |(k, own): (usize, &SolvedParameter)| -> Vec<f64> {
        let sides = own.interval.into_iter().flatten().zip(own.open.iter().zip(&own.held));
        let known = sides.filter(|(_, (is_open, held))| !**is_open && held.is_empty());
        known.map(|(end, _)| (profile(y, Some((k, end))) - least) / rise).collect()
    };
    let all = solution.parameters.iter().enumerate().flat_map(of).collect();
    (solution.parameters.iter().filter(|own| !own.by_profile).count(), all)
}

/// At every end the exact profile has risen to the limit, as far as the test of a linear interval
/// promises: to within a tenth of its half-width.
#[test]
fn intervals_end_where_the_profile_ends() {
    let mut rng = Mrg32k3a::new(&[2006.0; 6]).unwrap();
    for noise in [0.005, 0.02, 0.05, 0.1] {
        let mut linear = 0;
        for number in 0..40 {
            let own = posed(noise, &mut rng);
            let y = own.series[0].y.clone();
            let solution = solved(own);
            // The others hold for the value at that end.
            if solution.parameters.iter().any(|own| own.at_bound) {
                continue;
            }
            let (count, ends) = ends(&solution, &y);
            linear += count;
            for end in ends {
                let text = solution.text();
                assert!((0.8..=1.22).contains(&end), "{noise} {number}: {end}\n{text}");
            }
        }
        // With little noise the model is linear, and profiles are not made.
        assert!(noise > 0.01 || linear > 100, "{noise}: {linear}");
    }
}

/// With more noise than the data determine, the offset goes to the end of its range, and amplitude and rate
/// end there: the range decides, and is named.
#[test]
fn an_end_made_by_the_range_of_another_parameter_is_not_one_of_the_data() {
    let mut rng = Mrg32k3a::new(&[2006.0; 6]).unwrap();
    let with = |range: [f64; 2], rng: &mut Mrg32k3a| {
        let mut own = posed(0.0, rng);
        own.series[0].y.iter_mut().zip(0..).for_each(|(y, k)| *y += [0.2, -0.2, 0.1][k % 3]);
        own.parameters[2] = Free::new("c", "", range, None, Some(0.3)).unwrap();
        own.parameters[0] = Free::new("A", "", [0.1, 1e3], None, Some(1.0)).unwrap();
        own.parameters[1] = Free::new("k", "", [1e-6, 20.0], None, Some(0.2)).unwrap();
        solved(own)
    };
    let mut last = 0.0;
    for low in [-3.0, -10.0, -50.0] {
        let solution = with([low, 1.0], &mut rng);
        let own = &solution.parameters[0];
        let [_, high] = own.interval.unwrap();
        assert!(high > last, "{high} {last}");
        last = high;
        let names: Vec<&str> = own.held[1].iter().map(|own| own.parameter.as_str()).collect();
        assert_eq!((names, own.held[0].len()), (vec!["c"], 0), "{own:?}");
        assert!(low == -3.0 || own.verdict == Some(Verdict::PracticallyNonIdentifiable));
        let text = solution.text();
        let said = format!("where c is at the end {low} of its search range");
        assert!(text.contains(&said), "{said}\n{text}");
        assert!(!text.contains("A can have any value"), "{text}");
    }
}
