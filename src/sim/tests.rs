use super::problems::{self, TestProblem};
use super::*;

fn settings(stop: f64, tolerance: f64) -> Settings {
    Settings { stop, tolerance, output: OutputGrid::Intervals(50), ..Settings::default() }
}

fn by(method: &str, settings: Settings) -> Settings {
    Settings { method: find_integrator(method).unwrap(), ..settings }
}

/// Largest error of the columns over all rows, relative to max(|exact|, 1).
fn error(problem: &mut TestProblem, settings: &Settings, exact: &dyn Fn(f64) -> Vec<f64>) -> f64 {
    let (trajectory, _) = simulate(problem, settings).unwrap();
    let mut largest: f64 = 0.0;
    for (row, t) in trajectory.time().iter().enumerate() {
        for (column, expected) in exact(*t).into_iter().enumerate() {
            let difference = trajectory.column(column)[row] - expected;
            largest = largest.max(difference.abs() / expected.abs().max(1.0));
        }
    }
    largest
}

fn final_values(problem: &mut TestProblem, settings: &Settings) -> Vec<f64> {
    let (trajectory, _) = simulate(problem, settings).unwrap();
    assert_eq!(trajectory.time().last(), Some(&settings.stop));
    (0..trajectory.n_columns()).map(|i| *trajectory.column(i).last().unwrap()).collect()
}

#[test]
fn error_sweep() {
    for tolerance in [1e-3, 1e-4, 1e-6, 1e-8, 1e-10] {
        let mut line = format!("{tolerance:8.0e}");
        for (p, stop, exact) in [
            (
                problems::decay as fn() -> TestProblem,
                5.0,
                &(|t: f64| vec![(-t).exp()]) as &dyn Fn(f64) -> Vec<f64>,
            ),
            (problems::oscillator, 10.0, &|t| vec![t.cos(), -t.sin()]),
            (problems::stiff_linear, 10.0, &|t| vec![t.cos()]),
            (problems::algebraic, 5.0, &|t| {
                vec![2.0 * t * (-t).exp(), 2.0 * (1.0 - t) * (-t).exp()]
            }),
        ] {
            let s = settings(stop, tolerance);
            let e = error(&mut p(), &s, exact);
            let (_, stat) = simulate(&mut p(), &s).unwrap();
            line += &format!(
                " {:8.2} ({} {} {})",
                e / tolerance,
                stat.steps,
                stat.rhs_evaluations,
                stat.factorizations
            );
        }
        eprintln!("{line}");
    }
}
