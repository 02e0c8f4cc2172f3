//! The problems of the Statistical Reference Datasets (NIST StRD) as problems of identification: the
//! formulas, the files, and how far a solution is from the certified values.

// What includes this file, a test or a benchmark, uses parts of it.
#![allow(dead_code)]

use gapilib::internals::causalize::causalize;
use gapilib::internals::codegen::Program;
use gapilib::internals::flatten::{Library, flatten};
use gapilib::internals::ga::optimizer::METHODS;
use gapilib::internals::identify::fitness::FITNESSES;
use gapilib::internals::identify::problem::{
    Experiment, Free, Inference, ModelSimulator, Observation, Problem, Run, Series, Sigma,
    Solution, Stop, conclude,
};
use gapilib::internals::identify::{CompiledModel, Descriptions};
use gapilib::internals::name::Name;
use gapilib::internals::registry::{self, Options};
use gapilib::internals::sim::Settings;
use gapilib::internals::source::SourceId;
use gapilib::internals::syntax::parse_stored_definition;
use std::f64::consts::PI;
use std::sync::Arc;

/// A problem as NIST gives it.
pub(crate) struct Dataset {
    pub(crate) name: &'static str,
    formula: &'static str,
    /// Two starts, the certified value and its standard deviation, for each parameter.
    pub(crate) rows: Vec<[f64; 4]>,
    pub(crate) sum: f64,
    points: Vec<[f64; 2]>,
    y: Vec<f64>,
}

/// Names and right-hand sides, in Modelica.
pub(crate) const MODELS: &[(&str, &str)] = &[
    ("Misra1a", "b1*(1 - exp(-b2*x))"),
    ("Chwirut2", "exp(-b1*x)/(b2 + b3*x)"),
    ("Chwirut1", "exp(-b1*x)/(b2 + b3*x)"),
    ("Lanczos3", LANCZOS),
    ("Gauss1", GAUSS),
    ("Gauss2", GAUSS),
    ("DanWood", "b1*x^b2"),
    ("Misra1b", "b1*(1 - (1 + b2*x/2)^(-2))"),
    ("Kirby2", "(b1 + x*(b2 + x*b3))/(1 + x*(b4 + x*b5))"),
    ("Hahn1", CUBIC),
    ("Nelson", "b1 - b2*x*exp(-b3*z)"),
    ("MGH17", "b1 + b2*exp(-x*b4) + b3*exp(-x*b5)"),
    ("Lanczos1", LANCZOS),
    ("Lanczos2", LANCZOS),
    ("Gauss3", GAUSS),
    ("Misra1c", "b1*(1 - (1 + 2*b2*x)^(-0.5))"),
    ("Misra1d", "b1*b2*x/(1 + b2*x)"),
    ("Roszman1", "b1 - b2*x - atan(b3/(x - b4))/pi"),
    (
        "ENSO",
        "b1 + b2*cos(2*pi*x/12) + b3*sin(2*pi*x/12) + b5*cos(2*pi*x/b4) + b6*sin(2*pi*x/b4) + b8*cos(2*pi*x/b7) + b9*sin(2*pi*x/b7)",
    ),
    ("MGH09", "b1*(x^2 + x*b2)/(x^2 + x*b3 + b4)"),
    ("Thurber", CUBIC),
    ("BoxBOD", "b1*(1 - exp(-b2*x))"),
    ("Rat42", "b1/(1 + exp(b2 - b3*x))"),
    ("MGH10", "b1*exp(b2/(x + b3))"),
    ("Eckerle4", "b1/b2*exp(-0.5*((x - b3)/b2)^2)"),
    ("Rat43", "b1/(1 + exp(b2 - b3*x))^(1/b4)"),
    ("Bennett5", "b1*(b2 + x)^(-1/b3)"),
];

const LANCZOS: &str = "b1*exp(-b2*x) + b3*exp(-b4*x) + b5*exp(-b6*x)";
const GAUSS: &str = "b1*exp(-b2*x) + b3*exp(-((x - b4)/b5)^2) + b6*exp(-((x - b7)/b8)^2)";
const CUBIC: &str = "(b1 + x*(b2 + x*(b3 + x*b4)))/(1 + x*(b5 + x*(b6 + x*b7)))";

impl Dataset {
    /// Reads a file: numbers behind `b1 =`, the residual sum of squares, and the rows behind the
    /// last line that begins with `Data:`.
    pub(crate) fn read(name: &str) -> Dataset {
        let path = format!("{}/tests/data/nist/{name}.dat", env!("CARGO_MANIFEST_DIR"));
        let text = std::fs::read_to_string(path).expect("a file of NIST");
        let (known, formula) = *MODELS.iter().find(|(known, _)| *known == name).expect("a model");
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
            name: known,
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
        let experiments: Vec<Experiment> =
            self.groups().into_iter().map(|(z, rows)| self.experiment(z, &rows)).collect();
        Problem {
            title: self.name.into(),
            model: self.name.into(),
            text: String::new(),
            descriptions: Descriptions::default(),
            parameters: (0..self.rows.len()).map(free).collect(),
            series: self.groups().into_iter().map(|(z, rows)| self.series(z, &rows)).collect(),
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
            simulator: Box::new(move || Ok(Box::new(ModelSimulator::new(&experiments)?))),
        }
    }

    /// Rows of equal second predictor: what is measured at one z is one experiment.
    fn groups(&self) -> Vec<(f64, Vec<usize>)> {
        let mut groups: Vec<(f64, Vec<usize>)> = Vec::new();
        for (row, [_, z]) in self.points.iter().enumerate() {
            match groups.iter_mut().find(|(known, _)| known == z) {
                Some((_, rows)) => rows.push(row),
                None => groups.push((*z, vec![row])),
            }
        }
        groups
    }

    fn series(&self, z: f64, rows: &[usize]) -> Series {
        Series {
            role: Default::default(),
            experiment: format!("z = {z}"),
            y_name: "y".into(),
            y_unit: String::new(),
            x_name: "x".into(),
            x_unit: String::new(),
            file: format!("{}.dat", self.name),
            x: rows.iter().map(|&row| self.points[row][0]).collect(),
            y: rows.iter().map(|&row| self.y[row]).collect(),
            weight: 1.0,
            relative: Vec::new(),
            sigma: Sigma::Unknown,
            law: Default::default(),
            censored: Vec::new(),
            column: "y".into(),
            x_column: String::new(),
            rows: Vec::new(),
            missing: Vec::new(),
            scaling: Default::default(),
            joint: None,
        }
    }

    fn experiment(&self, z: f64, rows: &[usize]) -> Experiment {
        let names: Vec<String> = (1..=self.rows.len()).map(|k| format!("b{k}")).collect();
        let x: Vec<f64> = rows.iter().map(|&row| self.points[row][0]).collect();
        let text = format!(
            "model {} parameter Real {} = 1; parameter Real at = {:e}; constant Real z = {z:e}; \
             constant Real pi = {PI}; Real x = at; Real y = {}; end {};",
            self.name,
            names.join(" = 1, "),
            x[0],
            self.formula,
            self.name
        );
        let mut library = Library::new();
        let stored = parse_stored_definition(SourceId(0), &text).expect("a class");
        library.load(&stored).expect("a library");
        let flat = flatten(&library, &Name::parse(self.name), &[]).expect("a model").model;
        let program =
            Program::compile(causalize(&flat).expect("it is sorted")).expect("it compiles");
        Experiment {
            deviations: 0,
            second_attempt: true,
            name: format!("z = {z}"),
            model: Arc::new(CompiledModel::new(self.name, program).driven_by("x", "at")),
            settings: Settings::default(),
            x_name: "x".into(),
            observations: vec![Observation { y_name: "y".into(), x }],
            parameters: names.into_iter().enumerate().collect(),
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
        conclude(&mut run);
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
