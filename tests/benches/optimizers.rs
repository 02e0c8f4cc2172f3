//! Optimizers beside the figures of others: medians and worst of ten seeds on problems with known
//! minima, hypervolumes of fronts, and CPU seconds per 100,000 evaluations that cost nothing.
//! `cargo bench --bench optimizers`; a name behind `--` keeps the methods that contain it.

#![allow(clippy::print_stdout, reason = "it prints a table")]

use gapilib::internals::elementary;
use gapilib::internals::ga::optimizer::{
    Answers, METHODS, Method, Polished, Required, Setup, survivors,
};
use gapilib::internals::ga::{FAILED_FITNESS, Gene, Genomes, Mrg32k3a, hypervolume};
use gapilib::internals::registry::{self, Options};
use problems::{Objectives, Residuals};
use std::sync::LazyLock;
use std::time::Instant;

#[allow(dead_code, reason = "a module of the tests of the library, too")]
#[path = "../../src/numerics/ga/optimizer/problems.rs"]
mod problems;

const SEEDS: u64 = 10;

/// What others reach: after 1,000, 3,000 and 10,000 evaluations of the polarization curve, then
/// after 20,000 of Rosenbrock's, Rastrigin's and Ackley's functions of ten genes. Medians, of the
/// best known implementation each; NaN where there is none.
const MARKS: &[(&str, bool, [f64; 6])] = &[
    ("genetic", true, [1.6e-30, 6e-31, 5e-31, f64::NAN, f64::NAN, f64::NAN]),
    ("multistart", false, [7e-31, 6e-31, 5e-31, f64::NAN, f64::NAN, f64::NAN]),
    ("genetic", false, [2.4e-3, 2e-4, 7.5e-5, f64::NAN, f64::NAN, f64::NAN]),
    ("gapilib2006", false, [9.5e-3, 3.8e-3, 1.4e-3, f64::NAN, f64::NAN, f64::NAN]),
    ("lshade", false, [9e-3, 6e-4, 2e-14, 6e-6, 5e-7, 7e-10]),
    ("cma_es", false, [2e-5, 1e-10, 1e-13, 6e-29, f64::NAN, 4e-15]),
    ("nelder_mead", false, [f64::NAN; 6]),
];

/// Hypervolumes that NSGA-II reaches with 100 individuals and 25,000 evaluations.
const FRONTS: [(&str, usize, Objectives, f64); 4] = [
    ("ZDT1", 30, problems::zdt1, 0.8698),
    ("ZDT2", 30, problems::zdt2, 0.5365),
    ("ZDT3", 30, problems::zdt3, 1.3277),
    ("DTLZ2", 12, problems::dtlz2, 0.702),
];

/// Seconds per 100,000 evaluations of the fastest of the others.
const SECONDS: f64 = 1.0;

fn main() {
    let wanted = std::env::args().skip(1).find(|argument| !argument.starts_with('-'));
    let is_wanted =
        |name: &str| wanted.as_ref().is_none_or(|wanted| name.contains(wanted.as_str()));
    let cases: [(&str, usize, u64, &Residuals); 6] = [
        ("polarization 1000", 6, 1000, &problems::polarization),
        ("polarization 3000", 6, 3000, &problems::polarization),
        ("polarization 10000", 6, 10_000, &problems::polarization),
        ("Rosenbrock 20000", 10, 20_000, &problems::rosenbrock),
        ("Rastrigin 20000", 10, 20_000, &problems::rastrigin),
        ("Ackley 20000", 10, 20_000, &problems::ackley),
    ];
    println!("{:<18} {:<20} {:>9} {:>9} {:>9}", "method", "problem", "median", "worst", "mark");
    for (name, polish, marks) in MARKS.iter().filter(|row| is_wanted(row.0)) {
        for ((problem, n, budget, residuals), mark) in cases.iter().zip(marks) {
            let method = method(name);
            let one = |seed| problems::minimum(&*method, *n, *budget, seed, *polish, residuals);
            let (median, worst) = median((0..SEEDS).map(one).collect(), false);
            let label = format!("{name}{}", if *polish { " + LM" } else { "" });
            let reached = verdict(*mark, median <= *mark);
            println!(
                "{label:<18} {problem:<20} {median:>9.1e} {worst:>9.1e} {mark:>9.1e} {reached}"
            );
        }
    }
    for (name, n, objectives, mark) in FRONTS.iter().filter(|_| is_wanted("nsga2")) {
        let method = method("nsga2");
        let one = |seed| problems::dominated(&*method, 100, *n, 25_000, seed, *objectives);
        let (median, worst) = median((0..SEEDS).map(one).collect(), true);
        let reached = verdict(*mark, median >= 0.998 * mark);
        println!("{:<18} {name:<20} {median:>9.4} {worst:>9.4} {mark:>9.4} {reached}", "nsga2");
    }
    for entry in METHODS.iter().filter(|entry| is_wanted(entry.name)) {
        let seconds = overhead(entry.name);
        let reached = verdict(SECONDS, seconds < SECONDS);
        let what = "s per 1e5 evaluations";
        println!("{:<18} {what:<20} {seconds:>9.2} {:>9} {SECONDS:>9.2} {reached}", entry.name, "");
    }
}

fn method(name: &str) -> Box<dyn Method> {
    let entry = registry::find("method", METHODS, name).expect("a method");
    (entry.make)(&mut Options::default()).expect("usual settings")
}

fn verdict(mark: f64, reached: bool) -> &'static str {
    match (mark.is_nan(), reached) {
        (true, _) => "",
        (false, true) => "reached",
        (false, false) => "missed",
    }
}

/// Median and worst.
fn median(mut found: Vec<f64>, large_is_good: bool) -> (f64, f64) {
    found.sort_by(f64::total_cmp);
    let n = found.len();
    let median = 0.5 * (found[(n - 1) / 2] + found[n / 2]);
    (median, if large_is_good { found[0] } else { found[n - 1] })
}

/// Seconds of the method itself for 100,000 evaluations with ten genes.
fn overhead(name: &str) -> f64 {
    let n_objectives = if name == "nsga2" { 2 } else { 1 };
    let genes = (0..10).map(|j| Gene::new(format!("g{j}"), 0.0, 1.0).expect("a range")).collect();
    let rng = Mrg32k3a::new(&Mrg32k3a::DEFAULT_SEED).expect("a seed");
    let setup = Setup {
        genes,
        scales: Vec::new(),
        n_objectives,
        budget: Some(100_000),
        start: None,
        noise: 1e-15,
        size: 1.0,
        rng,
    };
    let mut search = method(name).start(setup).expect("a search");
    let mut used = 0;
    let mut seconds = 0.0;
    while used < 100_000 {
        let mut batch = Genomes::with_capacity(10, 0);
        let started = cpu_seconds();
        search.ask(&mut batch);
        seconds += cpu_seconds() - started;
        if batch.is_empty() {
            break;
        }
        let rows: Vec<Vec<f64>> =
            batch.rows().map(|genome| problems::rastrigin(genome).expect("values")).collect();
        let objectives: Vec<f64> = match n_objectives {
            1 => rows.iter().map(|row| row.iter().map(|r| r * r).sum()).collect(),
            _ => batch.rows().flat_map(problems::zdt1).collect(),
        };
        let residuals: Vec<f64> = rows.concat();
        let started = cpu_seconds();
        let answers = Answers {
            objectives: &objectives,
            n_objectives,
            residuals: &residuals,
            jacobians: &[],
        };
        search.tell(&batch, &answers);
        seconds += cpu_seconds() - started;
        used += batch.len();
    }
    // A search that has converged before is measured by what it did.
    seconds * 100_000.0 / f64::from(u32::try_from(used.max(1)).unwrap_or(u32::MAX))
}

/// Seconds that this thread has computed; those of the clock where the system does not tell.
fn cpu_seconds() -> f64 {
    static STARTED: LazyLock<Instant> = LazyLock::new(Instant::now);
    let told = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let nanoseconds = told.and_then(|text| text.split(' ').next()?.parse::<f64>().ok());
    nanoseconds.map_or_else(|| STARTED.elapsed().as_secs_f64(), |ns| 1e-9 * ns)
}
