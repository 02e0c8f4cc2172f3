//! The problems of the Statistical Reference Datasets (NIST StRD) as problems of identification: the
//! formulas, the files, and how far a solution is from the certified values.

// What includes this file, a test or a benchmark, uses parts of it.
#![allow(dead_code)]

use gapilib::ga::optimizer::METHODS;
use gapilib::identify::fitness::FITNESSES;
use gapilib::identify::problem::{
    Failed, FailureKind, Free, Inference, Problem, Run, Series, Sigma, Simulate, Solution, Stop,
};
use gapilib::registry::{self, Options};
use std::f64::consts::{PI, TAU};

/// y = f(b, x₁, x₂).
type Formula = fn(&[f64], f64, f64) -> f64;

/// A problem as NIST gives it.
pub(crate) struct Dataset {
    pub(crate) name: &'static str,
    formula: Formula,
    /// Two starts, the certified value and its standard deviation, for each parameter.
    pub(crate) rows: Vec<[f64; 4]>,
    pub(crate) sum: f64,
    points: Vec<[f64; 2]>,
    y: Vec<f64>,
}

pub(crate) const MODELS: &[(&str, Formula)] = &[
    ("Misra1a", |b, x, _| b[0] * (1.0 - (-b[1] * x).exp())),
    ("Chwirut2", |b, x, _| (-b[0] * x).exp() / (b[1] + b[2] * x)),
    ("Chwirut1", |b, x, _| (-b[0] * x).exp() / (b[1] + b[2] * x)),
    ("Lanczos3", lanczos),
    ("Gauss1", gauss),
    ("Gauss2", gauss),
    ("DanWood", |b, x, _| b[0] * x.powf(b[1])),
    ("Misra1b", |b, x, _| b[0] * (1.0 - (1.0 + b[1] * x / 2.0).powi(-2))),
    ("Kirby2", |b, x, _| (b[0] + x * (b[1] + x * b[2])) / (1.0 + x * (b[3] + x * b[4]))),
    ("Hahn1", cubic),
    ("Nelson", |b, x, z| b[0] - b[1] * x * (-b[2] * z).exp()),
    ("MGH17", |b, x, _| b[0] + b[1] * (-x * b[3]).exp() + b[2] * (-x * b[4]).exp()),
    ("Lanczos1", lanczos),
    ("Lanczos2", lanczos),
    ("Gauss3", gauss),
    ("Misra1c", |b, x, _| b[0] * (1.0 - (1.0 + 2.0 * b[1] * x).powf(-0.5))),
    ("Misra1d", |b, x, _| b[0] * b[1] * x / (1.0 + b[1] * x)),
    ("Roszman1", |b, x, _| b[0] - b[1] * x - (b[2] / (x - b[3])).atan() / PI),
    ("ENSO", |b, x, _| {
        let wave = |period: f64, c: f64, s: f64| {
            c * (TAU * x / period).cos() + s * (TAU * x / period).sin()
        };
        b[0] + wave(12.0, b[1], b[2]) + wave(b[3], b[4], b[5]) + wave(b[6], b[7], b[8])
    }),
    ("MGH09", |b, x, _| b[0] * (x * x + x * b[1]) / (x * x + x * b[2] + b[3])),
    ("Thurber", cubic),
    ("BoxBOD", |b, x, _| b[0] * (1.0 - (-b[1] * x).exp())),
    ("Rat42", |b, x, _| b[0] / (1.0 + (b[1] - b[2] * x).exp())),
    ("MGH10", |b, x, _| b[0] * (b[1] / (x + b[2])).exp()),
    ("Eckerle4", |b, x, _| b[0] / b[1] * (-0.5 * ((x - b[2]) / b[1]).powi(2)).exp()),
    ("Rat43", |b, x, _| b[0] / (1.0 + (b[1] - b[2] * x).exp()).powf(1.0 / b[3])),
    ("Bennett5", |b, x, _| b[0] * (b[1] + x).powf(-1.0 / b[2])),
];

fn lanczos(b: &[f64], x: f64, _: f64) -> f64 {
    b[0] * (-b[1] * x).exp() + b[2] * (-b[3] * x).exp() + b[4] * (-b[5] * x).exp()
}

fn gauss(b: &[f64], x: f64, _: f64) -> f64 {
    let bell = |height: f64, at: f64, width: f64| height * (-((x - at) / width).powi(2)).exp();
    b[0] * (-b[1] * x).exp() + bell(b[2], b[3], b[4]) + bell(b[5], b[6], b[7])
}

fn cubic(b: &[f64], x: f64, _: f64) -> f64 {
    (b[0] + x * (b[1] + x * (b[2] + x * b[3]))) / (1.0 + x * (b[4] + x * (b[5] + x * b[6])))
}

impl Dataset {
    /// Reads a file: numbers behind `b1 =`, the residual sum of squares, and the rows behind the
    /// last line that begins with `Data:`.
    pub(crate) fn read(name: &str) -> Dataset {
        let path = format!("{}/tests/data/nist/{name}.dat", env!("CARGO_MANIFEST_DIR"));
        let text = std::fs::read_to_string(path).expect("a file of NIST");
        let (name, formula) = *MODELS.iter().find(|(known, _)| *known == name).expect("a model");
        let numbers = |line: &str| -> Vec<f64> {
            line.split_whitespace().filter_map(|word| word.parse().ok()).collect()
        };
        let (mut rows, mut sum, mut data) = (Vec::new(), f64::NAN, Vec::new());
        for line in text.lines() {
            let is_row = line.trim_start().starts_with('b') && line.contains(" =");
            if let Some((_, values)) = line.split_once(" =").filter(|_| is_row) {
                rows.extend(<[f64; 4]>::try_from(numbers(values)));
            } else if let Some((_, value)) = line.split_once("Residual Sum of Squares:") {
                sum = value.trim().parse().expect("a sum");
            } else if line.starts_with("Data:") {
                data.clear();
            } else {
                data.push(numbers(line));
            }
        }
        data.retain(|row| row.len() >= 2);
        let is_logarithm = name == "Nelson";
        Dataset {
            name,
            formula,
            rows,
            sum,
            points: data.iter().map(|row| [row[1], row.get(2).copied().unwrap_or(0.0)]).collect(),
            y: data.iter().map(|row| if is_logarithm { row[0].ln() } else { row[0] }).collect(),
        }
    }

    /// The range of a parameter: a decade beyond both starts, to both sides where the starts or the
    /// certified value differ in sign.
    fn range(&self, k: usize) -> [f64; 2] {
        let [a, b, certified, _] = self.rows[k];
        let (low, high) = (a.min(b), a.max(b));
        match (low > 0.0 && certified > 0.0, high < 0.0 && certified < 0.0) {
            (true, _) => [low / 10.0, high * 10.0],
            (_, true) => [low * 10.0, high / 10.0],
            _ => [-10.0 * high.abs().max(low.abs()), 10.0 * high.abs().max(low.abs())],
        }
    }

    /// The problem; with `start` the descent begins at that start of NIST.
    pub(crate) fn problem(
        &self,
        method: &str,
        start: Option<usize>,
        seed: u32,
        budget: u64,
    ) -> Problem {
        let free = |k: usize| {
            let start = start.map(|start| self.rows[k][start]);
            Free::new(format!("b{}", k + 1), "", self.range(k), None, start).expect("a range")
        };
        let sse = registry::find("fitness", FITNESSES, "sse").expect("a fitness");
        let entry = registry::find("method", METHODS, method).expect("a method");
        let series = Series {
            experiment: String::new(),
            y_name: "y".into(),
            y_unit: String::new(),
            x_name: "x".into(),
            x_unit: String::new(),
            file: format!("{}.dat", self.name),
            x: self.points.iter().map(|point| point[0]).collect(),
            y: self.y.clone(),
            weight: 1.0,
            sigma: Sigma::Unknown,
            column: "y".into(),
            rows: Vec::new(),
            missing: Vec::new(),
        };
        let (points, formula) = (self.points.clone(), self.formula);
        Problem {
            title: self.name.into(),
            model: self.name.into(),
            text: String::new(),
            parameters: (0..self.rows.len()).map(free).collect(),
            series: vec![series],
            objectives: vec![(
                "sse".into(),
                (sse.make)(&mut Options::default()).expect("a fitness"),
            )],
            method_name: method.into(),
            method: (entry.make)(&mut Options::default()).expect("a method"),
            polish: true,
            seed: [f64::from(seed) + 12345.0; 6],
            stop: Stop { evaluations: Some(budget), ..Stop::default() },
            noise: 1e-15,
            inference: Inference::default(),
            simulator: Box::new(move || Ok(Box::new(Static { points: points.clone(), formula }))),
        }
    }

    /// Solves it.
    pub(crate) fn solve(
        &self,
        method: &str,
        start: Option<usize>,
        seed: u32,
        budget: u64,
    ) -> Solution {
        let problem = self.problem(method, start, seed, budget);
        let mut run = Run::new(problem, 1).expect("a run");
        let stop = loop {
            if let Some(stop) = run.stop() {
                break stop;
            }
            run.step(0.0);
        };
        Solution::of(&run, &stop, Vec::new()).expect("a solution")
    }

    /// Common digits of the values and of the standard errors, the fewest of all parameters; terms
    /// of the same kind may have changed places.
    pub(crate) fn digits(&self, solution: &Solution) -> [f64; 2] {
        let mut best = [f64::NEG_INFINITY; 2];
        for order in self.orders() {
            let digits = |k: usize, j: usize| {
                let (own, row) = (&solution.parameters[order[k]], self.rows[k]);
                let found = if j == 0 { own.value } else { own.deviation.unwrap_or(f64::NAN) };
                let error = ((found - row[2 + j]) / row[2 + j]).abs();
                if error.is_nan() { 0.0 } else { -error.max(1e-11).log10() }
            };
            let least = |j| (0..order.len()).map(|k| digits(k, j)).fold(f64::INFINITY, f64::min);
            if least(0) > best[0] {
                best = [least(0), least(1)];
            }
        }
        best
    }

    /// Orders of the parameters that are the same model.
    fn orders(&self) -> Vec<Vec<usize>> {
        match self.name {
            "Lanczos1" | "Lanczos2" | "Lanczos3" => [
                [0, 1, 2, 3, 4, 5],
                [0, 1, 4, 5, 2, 3],
                [2, 3, 0, 1, 4, 5],
                [2, 3, 4, 5, 0, 1],
                [4, 5, 0, 1, 2, 3],
                [4, 5, 2, 3, 0, 1],
            ]
            .map(Vec::from)
            .to_vec(),
            "Gauss1" | "Gauss2" | "Gauss3" => {
                vec![(0..8).collect(), vec![0, 1, 5, 6, 7, 2, 3, 4]]
            }
            "MGH17" => vec![(0..5).collect(), vec![0, 2, 1, 4, 3]],
            "ENSO" => vec![(0..9).collect(), vec![0, 1, 2, 6, 7, 8, 3, 4, 5]],
            _ => vec![(0..self.rows.len()).collect()],
        }
    }
}

/// A formula over points.
struct Static {
    points: Vec<[f64; 2]>,
    formula: Formula,
}

impl Simulate for Static {
    fn simulate(&mut self, parameters: &[f64], out: &mut [f64]) -> Result<(), Failed> {
        for (value, [x, z]) in out.iter_mut().zip(&self.points) {
            *value = (self.formula)(parameters, *x, *z);
        }
        match out.iter().all(|value| value.is_finite()) {
            true => Ok(()),
            false => {
                Err(Failed { kind: FailureKind::Model, cause: "not finite".into(), progress: 0.0 })
            }
        }
    }
}
