//! What the default search reaches, and what it costs, on least squares with several minima: the fits of
//! the literature and curves whose data are drawn here.

use super::*;
use crate::ga::FAILED_FITNESS;
use crate::registry::{self, Options};
use std::f64::consts::{FRAC_PI_2, PI};

type Model = Box<dyn Fn(&[f64]) -> Option<Vec<f64>>>;

/// Outputs of a model at values of its parameters, data, and ranges: low, high, logarithmic.
struct Case {
    name: &'static str,
    ranges: Vec<(f64, f64, bool)>,
    model: Model,
    data: Vec<f64>,
    /// The least sum of squares.
    least: f64,
}

struct Found {
    least: f64,
    /// A simulation with sensitivities counts as one.
    simulations: u64,
    descents: Vec<DescentReport>,
}

impl Case {
    /// Data are those of the model at the truth with normal noise; the least sum is that of a descent
    /// from there.
    fn drawn(
        name: &'static str,
        ranges: &[(f64, f64, bool)],
        truth: &[f64],
        noise: f64,
        model: impl Fn(&[f64]) -> Option<Vec<f64>> + 'static,
    ) -> Case {
        let mut rng = Mrg32k3a::new(&Mrg32k3a::DEFAULT_SEED).unwrap();
        let exact = model(truth).unwrap();
        let data = exact.iter().map(|y| y + noise * rng.normal()).collect();
        let mut case =
            Case { name, ranges: ranges.to_vec(), model: Box::new(model), data, least: 0.0 };
        let start =
            case.ranges.iter().zip(truth).map(
                |((low, high, logarithmic), value)| match logarithmic {
                    true => (value / low).ln() / (high / low).ln(),
                    false => (value - low) / (high - low),
                },
            );
        let start = Some(start.collect());
        case.least = case.search("levenberg_marquardt", start, 0).least;
        case
    }

    fn residuals(&self, genome: &[f64]) -> Option<Vec<f64>> {
        let value = |((low, high, logarithmic), u): (&(f64, f64, bool), &f64)| match logarithmic {
            true => low * (high / low).powf(*u),
            false => low + u * (high - low),
        };
        let values: Vec<f64> = self.ranges.iter().zip(genome).map(value).collect();
        let outputs = (self.model)(&values)?;
        let residuals: Vec<f64> = outputs.iter().zip(&self.data).map(|(y, m)| y - m).collect();
        residuals.iter().all(|r| r.is_finite()).then_some(residuals)
    }

    /// Central differences, residuals × genes.
    fn jacobian(&self, genome: &[f64]) -> Vec<f64> {
        const STEP: f64 = 1e-6;
        let n = genome.len();
        let mut jacobian = vec![f64::NAN; self.data.len() * n];
        for j in 0..n {
            let [low, high] = [-STEP, STEP].map(|by| {
                let mut moved = genome.to_vec();
                moved[j] += by;
                self.residuals(&moved)
            });
            for (row, (low, high)) in low.iter().flatten().zip(high.iter().flatten()).enumerate() {
                jacobian[row * n + j] = (high - low) / (2.0 * STEP);
            }
        }
        jacobian
    }

    fn search(&self, method: &str, start: Option<Vec<f64>>, seed: u64) -> Found {
        const BUDGET: u64 = 20_000;
        let n = self.ranges.len();
        let rng = Mrg32k3a::new(&Mrg32k3a::DEFAULT_SEED).unwrap().stream(seed);
        let scale = |(min, max, logarithmic): &(f64, f64, bool)| Scale {
            min: *min,
            max: *max,
            logarithmic: *logarithmic,
            unit: String::new(),
        };
        let setup = Setup {
            genes: (0..n).map(|j| Gene::new(format!("g{j}"), 0.0, 1.0).unwrap()).collect(),
            scales: self.ranges.iter().map(scale).collect(),
            n_objectives: 1,
            budget: Some(BUDGET),
            start,
            noise: 1e-9,
            size: self.data.iter().map(|y| y * y).sum::<f64>().sqrt(),
            rng: rng.clone(),
        };
        let entry = registry::find("method", METHODS, method).unwrap();
        let method = (entry.make)(&mut Options::default()).unwrap();
        let mut search = method.start(setup.clone()).unwrap();
        if method.can_be_polished() {
            search = Box::new(Polished::new(search, &setup, rng.substream(1)));
        }
        let mut found = Found { least: f64::INFINITY, simulations: 0, descents: Vec::new() };
        while found.simulations < BUDGET {
            let mut batch = Genomes::with_capacity(n, 0);
            search.ask(&mut batch);
            if batch.is_empty() {
                break;
            }
            found.simulations += batch.len() as u64;
            self.answer(search.as_mut(), &batch, &mut found.least);
        }
        found.descents = search.descents();
        found
    }

    fn answer(&self, search: &mut dyn Optimizer, batch: &Genomes, least: &mut f64) {
        let rows: Vec<Option<Vec<f64>>> = batch.rows().map(|row| self.residuals(row)).collect();
        let square = |row: &Vec<f64>| row.iter().map(|r| r * r).sum::<f64>();
        let objectives: Vec<f64> =
            rows.iter().map(|row| row.as_ref().map_or(FAILED_FITNESS, square)).collect();
        *least = objectives.iter().copied().fold(*least, f64::min);
        let failed = || vec![f64::NAN; self.data.len()];
        let residuals: Vec<f64> =
            rows.into_iter().flat_map(|row| row.unwrap_or_else(failed)).collect();
        let jacobians: Vec<f64> = match search.required() {
            Required::Jacobians => batch.rows().flat_map(|row| self.jacobian(row)).collect(),
            _ => Vec::new(),
        };
        let answers = Answers {
            objectives: &objectives,
            n_objectives: 1,
            residuals: &residuals,
            jacobians: &jacobians,
        };
        search.tell(batch, &answers);
    }
}

/// Runge and Kutta's method in so many steps.
fn integrate(y: &mut [f64], time: f64, steps: usize, rate: &dyn Fn(&[f64]) -> Vec<f64>) {
    let h = time / steps as f64;
    let moved = |y: &[f64], by: f64, k: &[f64]| -> Vec<f64> {
        y.iter().zip(k).map(|(y, k)| y + by * k).collect()
    };
    for _ in 0..steps {
        let a = rate(y);
        let b = rate(&moved(y, 0.5 * h, &a));
        let c = rate(&moved(y, 0.5 * h, &b));
        let d = rate(&moved(y, h, &c));
        for (k, y) in y.iter_mut().enumerate() {
            *y += h / 6.0 * (a[k] + 2.0 * b[k] + 2.0 * c[k] + d[k]);
        }
    }
}

/// Pelts of the Hudson Bay Company, 1900 to 1920, in thousands (Hewitt 1921).
const HARE: [f64; 21] = [
    30.0, 47.2, 70.2, 77.4, 36.3, 20.6, 18.1, 21.4, 22.0, 25.4, 27.1, 40.3, 57.0, 76.6, 52.3, 19.5,
    11.2, 7.6, 14.6, 16.2, 24.7,
];
const LYNX: [f64; 21] = [
    4.0, 6.1, 9.8, 35.2, 59.4, 41.7, 19.0, 13.0, 8.3, 9.1, 7.4, 8.0, 12.3, 19.5, 45.7, 51.1, 29.7,
    15.8, 9.7, 10.1, 8.6,
];

fn lynx_and_hare() -> Case {
    let model = |p: &[f64]| {
        let mut y = [p[4], p[5]];
        let rate =
            |y: &[f64]| vec![p[0] * y[0] - p[1] * y[0] * y[1], p[3] * y[0] * y[1] - p[2] * y[1]];
        let mut outputs = y.to_vec();
        for _ in 1..HARE.len() {
            integrate(&mut y, 1.0, 40, &rate);
            outputs.extend(y);
        }
        Some(outputs)
    };
    Case {
        name: "lynx and hare",
        ranges: vec![
            (0.05, 2.0, true),
            (0.002, 0.2, true),
            (0.05, 3.0, true),
            (0.002, 0.2, true),
            (5.0, 100.0, true),
            (0.5, 50.0, true),
        ],
        model: Box::new(model),
        data: HARE.iter().zip(LYNX).flat_map(|(hare, lynx)| [*hare, lynx]).collect(),
        least: 594.744_56,
    }
}

/// A cell with two RC elements and steps of its current: the range of one time constant leaves a second
/// minimum at its end.
fn cell() -> Case {
    let ranges = [
        (2e-4, 0.02, true),
        (1e-4, 0.01, true),
        (1e3, 1e5, true),
        (1e-4, 0.01, true),
        (1e4, 1e6, true),
        (0.5, 1.0, false),
    ];
    let truth = [0.0021, 0.0012, 8900.0, 0.0019, 9e4, 0.85];
    Case::drawn("cell", &ranges, &truth, 8e-4, |p| {
        let (mut fast, mut slow, mut charge) = (0.0, 0.0, p[5]);
        let [a, b] = [p[1] * p[2], p[3] * p[4]].map(|constant| f64::exp(-10.0 / constant));
        let one = |k: usize| {
            let current = [0.0, -20.0, 0.0, 10.0][k / 30 % 4];
            let voltage = 3.4 + 0.75 * charge + p[0] * current + fast + slow;
            fast = a * fast + (1.0 - a) * p[1] * current;
            slow = b * slow + (1.0 - b) * p[3] * current;
            charge += current * 10.0 / 72_000.0;
            voltage
        };
        Some((0..390).map(one).collect())
    })
}

fn curve(
    name: &'static str,
    ranges: &[(f64, f64, bool)],
    truth: &[f64],
    (end, points, noise): (f64, usize, f64),
    formula: fn(&[f64], f64) -> f64,
) -> Case {
    let step = end / (points - 1) as f64;
    Case::drawn(name, ranges, truth, noise, move |p| {
        Some((0..points).map(|k| formula(p, k as f64 * step)).collect())
    })
}

/// Two exponentials, a frequency, two peaks, a damped oscillation, the curve of Bateman, the equations
/// of FitzHugh and Nagumo.
fn with_several_minima() -> Vec<Case> {
    let (positive, phase) = ((0.1, 10.0, true), (-PI, PI, false));
    vec![
        curve(
            "two exponentials",
            &[positive, (0.01, 10.0, true), positive, (0.01, 10.0, true)],
            &[1.0, 0.3, 2.0, 1.5],
            (10.0, 40, 0.01),
            |p, x| p[0] * (-p[1] * x).exp() + p[2] * (-p[3] * x).exp(),
        ),
        curve(
            "frequency",
            &[(0.1, 30.0, true), positive, phase],
            &[7.3, 2.0, 0.5],
            (6.0, 60, 0.1),
            |p, x| p[1] * (p[0] * x + p[2]).sin(),
        ),
        curve(
            "two peaks",
            &[positive, (0.0, 10.0, false), (0.1, 3.0, true)].repeat(2),
            &[2.0, 3.0, 0.5, 1.0, 7.0, 0.8],
            (10.0, 80, 0.03),
            |p, x| {
                let peak = |p: &[f64]| p[0] * (-((x - p[1]) / p[2]).powi(2)).exp();
                peak(&p[..3]) + peak(&p[3..])
            },
        ),
        curve(
            "damped",
            &[positive, (0.01, 2.0, true), (0.2, 20.0, true), phase],
            &[3.0, 0.2, 4.0, 1.0],
            (12.0, 80, 0.1),
            |p, x| p[0] * (-p[1] * x).exp() * (p[2] * x + p[3] + FRAC_PI_2).sin(),
        ),
        curve(
            "Bateman",
            &[positive, (0.1, 5.0, true), (-10.0, 10.0, false)],
            &[0.5, 0.9, 2.0],
            (12.0, 25, 0.03),
            |p, x| p[2] * ((-p[0] * x).exp() - (-p[1] * x).exp()),
        ),
        fitzhugh_nagumo(),
    ]
}

fn fitzhugh_nagumo() -> Case {
    let (wide, start) = ((-1.0, 2.0, false), (-3.0, 3.0, false));
    let ranges = [wide, wide, (0.5, 8.0, true), start, start];
    Case::drawn("FitzHugh-Nagumo", &ranges, &[0.2, 0.2, 3.0, -1.0, 1.0], 0.1, |p| {
        let mut y = [p[3], p[4]];
        let rate = |y: &[f64]| {
            let third = y[0].powi(3) / 3.0;
            vec![p[2] * (y[0] - third + y[1]), -(y[0] - p[0] + p[1] * y[1]) / p[2]]
        };
        let mut outputs = Vec::new();
        for _ in 0..100 {
            integrate(&mut y, 0.2, 8, &rate);
            outputs.extend(y);
        }
        Some(outputs)
    })
}

/// Fails with a table where one of the seeds does not reach the least sum.
fn reach_the_least(cases: &[Case], seeds: u64) {
    let mut missed = String::new();
    for case in cases {
        let all: Vec<Found> = (0..seeds).map(|seed| case.search("genetic", None, seed)).collect();
        let reached = all.iter().filter(|found| found.least <= case.least * (1.0 + 1e-5)).count();
        if (reached as u64) < seeds {
            missed.push_str(&format!("{}: {reached} of {seeds}\n", case.name));
        }
    }
    assert!(missed.is_empty(), "{missed}");
}

#[test]
fn the_default_search_reaches_the_best_of_several_minima() {
    reach_the_least(&[lynx_and_hare(), cell()], 2);
    reach_the_least(&with_several_minima(), 1);
}

/// cargo test --release -p gapilib-numerics --lib every_seed -- --ignored
#[test]
#[ignore = "hundreds of searches"]
fn every_seed_reaches_the_best_of_several_minima() {
    reach_the_least(&[lynx_and_hare(), cell()], 20);
    reach_the_least(&with_several_minima(), 10);
    reach_the_least(&with_much_noise(), 20);
}

/// The search ends when the known minima were reached often enough, and descents that lead to them are
/// not made to their ends: six parameters and two minima cost twelve descents at most, where 15 whole
/// ones with 60 points of a hypercube and a genetic search took 1,117.
#[test]
fn a_search_does_not_go_on_after_its_minima_are_known() {
    let case = cell();
    let alone = case.search("levenberg_marquardt", None, 0);
    let mut simulations = 0;
    for seed in 0..5 {
        let found = case.search("genetic", None, seed);
        assert!(found.least <= alone.least * (1.0 + 1e-9), "{seed}");
        simulations += found.simulations;
        let joined = |report: &DescentReport| report.ending == DescentEnd::Joined;
        assert!(found.descents.iter().any(joined), "{seed}: {:?}", found.descents);
        // Where they are reported, there is a minimum that another one has reached.
        for report in found.descents.iter().filter(|report| joined(report)) {
            let is_its = |other: &&DescentReport| {
                other.ending == DescentEnd::Minimum && other.group == report.group
            };
            let other = found.descents.iter().find(is_its).unwrap();
            assert!((report.objective / other.objective - 1.0).abs() < 1e-3, "{seed}");
        }
    }
    assert!(simulations <= 5 * 12 * alone.simulations, "{simulations}");
}

/// Noise-free data of a product: descents end all over a valley of exact fits, which is one minimum.
#[test]
fn a_valley_of_exact_fits_is_one_minimum() {
    let case =
        curve("product", &[(0.01, 10.0, true); 3], &[0.8, 1.0, 2.0], (4.0, 21, 0.0), |p, x| {
            p[1] * p[2] * (-p[0] * x).exp()
        });
    for seed in 0..5 {
        let found = case.search("genetic", None, seed);
        assert!(found.simulations < 300, "{seed}: {}", found.simulations);
        assert_eq!(super::descents::reached(&found.descents), found.descents.len(), "{seed}");
    }
}

/// Errors in the data make every fit bad; where all descents lead to it, it is theirs, and nothing for a
/// genetic search.
#[test]
fn a_bad_fit_to_which_all_descents_lead_ends_the_search() {
    let positive = (0.1, 10.0, true);
    let mut case =
        curve("decay", &[positive, (0.01, 2.0, true)], &[3.0, 0.4], (5.0, 40, 0.01), |p, x| {
            p[0] * (-p[1] * x).exp()
        });
    case.data[5] += 30.0;
    for seed in 0..5 {
        let found = case.search("genetic", None, seed);
        let least: f64 =
            found.descents.iter().map(|own| own.objective).fold(f64::INFINITY, f64::min);
        assert!(least > 0.5 * case.data.iter().map(|y| y * y).sum::<f64>(), "it fits badly");
        assert!(found.descents.iter().all(|own| own.group == 0), "{:?}", found.descents);
        assert!(found.simulations < 200, "{seed}: {}", found.simulations);
    }
}

/// Noise of the size of the signal: every fit is bad, and most descents end beside the best.
fn with_much_noise() -> Vec<Case> {
    let (positive, phase) = ((0.1, 10.0, true), (-PI, PI, false));
    vec![
        curve(
            "frequency in noise",
            &[(0.1, 30.0, true), positive, phase],
            &[2.3, 2.0, 0.5],
            (6.0, 60, 1.0),
            |p, x| p[1] * (p[0] * x + p[2]).sin(),
        ),
        curve(
            "peak in noise",
            &[positive, (0.0, 100.0, false), (0.3, 30.0, true)],
            &[3.0, 71.0, 1.0],
            (100.0, 201, 0.5),
            |p, x| p[0] * (-((x - p[1]) / p[2]).powi(2)).exp(),
        ),
    ]
}
