//! Every method finds minima that are known.

use super::problems::{ackley, minimum, polarization, rastrigin, rosenbrock};
use super::*;
use crate::registry;

fn method(name: &str) -> Box<dyn Method> {
    let entry = registry::find("method", METHODS, name).unwrap();
    (entry.make)(&mut Options::default()).unwrap()
}

fn median(name: &str, polish: bool, n: usize, budget: u64, problem: &problems::Residuals) -> f64 {
    let method = method(name);
    let mut found: Vec<f64> =
        (0..5).map(|seed| minimum(method.as_ref(), n, budget, seed, polish, problem)).collect();
    found.sort_by(f64::total_cmp);
    found[2]
}

/// The worst of three seeds is this good, with room for another order of rounding.
#[test]
fn methods_reach_the_minimum_of_the_polarization_curve() {
    for (name, polish, budget, limit) in [
        ("genetic", true, 1000, 1e-28),
        ("multistart", false, 1000, 1e-28),
        ("lshade", false, 3000, 1e-3),
        ("cma_es", false, 3000, 1e-3),
        ("gapilib2006", false, 3000, 5e-2),
        ("genetic", false, 3000, 1e-2),
    ] {
        let found = median(name, polish, 6, budget, &polarization);
        assert!(found < limit, "{name}: {found}");
    }
}

#[test]
fn a_descent_and_a_simplex_find_the_end_of_the_valley() {
    for (name, budget, limit) in [("levenberg_marquardt", 500, 1e-20), ("nelder_mead", 1500, 1e-12)]
    {
        let found = minimum(method(name).as_ref(), 4, budget, 0, false, &rosenbrock);
        assert!(found < limit, "{name}: {found}");
    }
}

#[test]
fn a_minimum_on_the_bounds_is_found() {
    let outside = |genome: &[f64]| Some(vec![genome[0] + 0.5, genome[1] - 2.0, genome[2] - 0.25]);
    for name in ["levenberg_marquardt", "cma_es", "nelder_mead", "lshade"] {
        let found = minimum(method(name).as_ref(), 3, 3000, 1, false, &outside);
        assert!((found - 1.25).abs() < 1e-6, "{name}: {found}");
    }
}

#[test]
fn nothing_that_succeeds_ends_no_search() {
    for entry in METHODS {
        let method = (entry.make)(&mut Options::default()).unwrap();
        let found = minimum(method.as_ref(), 2, 500, 0, false, &|_| None);
        assert_eq!(found, crate::ga::FAILED_FITNESS, "{}", entry.name);
    }
}

/// The front of ZDT1 is f2 = 1 - sqrt(f1): the area up to the reference (1.1, 1.1).
#[test]
fn nsga2_finds_the_front_of_zdt1() {
    let front = front_after(40, 100);
    let area = crate::ga::hypervolume(&front, 2, &[1.1, 1.1]);
    assert!(area > 0.8, "{area}");
}

/// NSGA-II on ZDT1 with 10 genes.
fn front_after(population: usize, generations: usize) -> Vec<f64> {
    let n = 10;
    let mut options = Options::default();
    options.set("population", population as f64);
    let entry = registry::find("method", METHODS, "nsga2").unwrap();
    let genes = (0..n).map(|j| Gene::new(format!("g{j}"), 0.0, 1.0).unwrap()).collect();
    let rng = Mrg32k3a::new(&Mrg32k3a::DEFAULT_SEED).unwrap();
    let setup = Setup { genes, n_objectives: 2, budget: None, start: None, difference: 1e-8, rng };
    let mut search = (entry.make)(&mut options).unwrap().start(setup).unwrap();
    let mut objectives = Vec::new();
    for _ in 0..generations {
        let mut batch = Genomes::with_capacity(n, population);
        search.ask(&mut batch);
        objectives = batch.rows().flat_map(zdt1).collect();
        search.tell(&batch, &Answers { objectives: &objectives, n_objectives: 2, residuals: &[] });
    }
    non_dominated(&objectives, 2)
        .iter()
        .flat_map(|&k| objectives[2 * k..2 * k + 2].to_vec())
        .collect()
}

fn zdt1(genome: &[f64]) -> [f64; 2] {
    let rest = &genome[1..];
    let g = 1.0 + 9.0 * rest.iter().sum::<f64>() / rest.len() as f64;
    [genome[0], g * (1.0 - (genome[0] / g).sqrt())]
}

/// Our numbers, to be put beside the marks of other optimizers: medians of five seeds of the sum of
/// squares. `cargo test --release marks -- --ignored --nocapture` prints them.
#[test]
#[ignore = "a measurement: a quarter of a minute in a release build"]
fn marks() {
    let mut text = String::from("polarization after 1000, 3000, 10000; 10 genes after 20000\n");
    for (name, polish) in [
        ("genetic", true),
        ("multistart", false),
        ("genetic", false),
        ("gapilib2006", false),
        ("lshade", false),
        ("cma_es", false),
    ] {
        text += &format!("{:<16}", format!("{name}{}", if polish { " + LM" } else { "" }));
        for budget in [1000, 3000, 10_000] {
            text += &format!(" {:.1e}", median(name, polish, 6, budget, &polarization));
        }
        let rosenbrock = median(name, polish, 10, 20_000, &rosenbrock);
        let rastrigin = median(name, polish, 10, 20_000, &rastrigin);
        let ackley = median(name, polish, 10, 20_000, &ackley);
        text += &format!(
            "  Rosenbrock {rosenbrock:.1e} Rastrigin {rastrigin:.1e} Ackley {ackley:.1e}\n"
        );
    }
    std::io::Write::write_all(&mut std::io::stderr(), text.as_bytes()).unwrap();
}
