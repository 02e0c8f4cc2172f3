//! Every method finds minima that are known.

use super::problems::{ackley, minimum, polarization, rastrigin, rosenbrock};
use super::*;
use crate::registry;

fn method(name: &str) -> Box<dyn Method> {
    let entry = registry::find("method", METHODS, name).unwrap();
    (entry.make)(&mut Options::default()).unwrap()
}

/// The median of five seeds.
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
        ("genetic", true, 1000, 1e-26),
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

#[test]
fn many_local_minima_do_not_hold_differential_evolution() {
    for problem in [rastrigin, ackley] {
        let found = median("lshade", false, 5, 10_000, &problem);
        assert!(found < 1e-6, "{found}");
    }
}

/// The whole fronts have the volumes 0.877, 0.543, 1.332 and about 0.75.
#[test]
fn nsga2_covers_the_fronts() {
    let fronts: [(problems::Objectives, usize, f64); 4] = [
        (problems::zdt1, 10, 0.85),
        (problems::zdt2, 10, 0.5),
        (problems::zdt3, 10, 1.25),
        (problems::dtlz2, 12, 0.65),
    ];
    for (number, (objectives, n, least)) in fronts.into_iter().enumerate() {
        let volume = problems::dominated(method("nsga2").as_ref(), 100, n, 10_000, 0, objectives);
        assert!(volume > least, "{number}: {volume}");
    }
}

/// Data that the model reproduces to within the errors of the simulation: there the gradient is one of
/// those errors, and no minimum is nearer. With larger residuals it tells.
#[test]
fn residuals_within_the_errors_of_the_simulation_are_those_of_a_minimum() {
    let jacobian = [1.0, 1.0, 1.0, 1.0];
    let along = |size: f64| [size, size, size, -0.9 * size];
    let accuracy = [1e-8, 3.0];
    assert!(test_minimum(&[0.5], &along(1e-9), &jacobian, accuracy).1);
    assert!(!test_minimum(&[0.5], &along(1e-6), &jacobian, accuracy).1);
}

/// Islands have random numbers of their own; one island is the method as it was.
#[test]
fn islands_search_apart_and_find_the_minimum() {
    let found = |islands: f64, seed: u64| {
        let mut options = Options::default();
        options.set("population", 20.0);
        if islands > 0.0 {
            options.set("islands", islands);
        }
        let method = (super::genetic::ENTRY.make)(&mut options).unwrap();
        minimum(method.as_ref(), 4, 12_000, seed, false, &rosenbrock)
    };
    assert_eq!(found(0.0, 1).to_bits(), found(1.0, 1).to_bits());
    assert_ne!(found(1.0, 1).to_bits(), found(4.0, 1).to_bits());
    assert_eq!(found(4.0, 1).to_bits(), found(4.0, 1).to_bits());
    assert!((0..3).all(|seed| found(4.0, seed) < 2.0), "{}", found(4.0, 0));
}
