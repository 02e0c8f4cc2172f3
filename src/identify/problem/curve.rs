//! The simulated curve between the measured points, for drawing.

use super::solution::CurveKind;
use super::{Experiment, ModelSimulator, Observation, Series, Simulate, Solution, SolvedSeries};
use crate::elementary;
use crate::sim::TimeBudget;

/// Points of a curve beside the measured ones: one for every third pixel of a figure.
const POINTS: usize = 160;

/// Simulates each experiment at the solution on a dense grid of X, and gives each of its series its
/// curve; `kept`: the experiments of the validation. A curve that cannot be simulated stays empty;
/// the measured points were. `hurry`: what all may take where the run was stopped.
pub fn draw_curves(
    fitted: &[Experiment],
    solution: &mut Solution,
    kept: &[(Experiment, Vec<Series>)],
    hurry: Option<TimeBudget>,
) {
    let values: Vec<f64> = solution.parameters.iter().map(|parameter| parameter.value).collect();
    draw(fitted.iter(), (&values, hurry), &mut solution.series);
    let kept = kept.iter().map(|(experiment, _)| experiment);
    draw(kept, (&values, hurry), &mut solution.validation);
}

/// `series`: those of all experiments, one after the other.
fn draw<'a>(
    experiments: impl Iterator<Item = &'a Experiment>,
    (values, hurry): (&[f64], Option<TimeBudget>),
    series: &mut [SolvedSeries],
) {
    let mut rest = series;
    for experiment in experiments {
        let count = (experiment.observations.len() - experiment.deviations).min(rest.len());
        let (own, others) = rest.split_at_mut(count);
        if let Some(curves) = curves(experiment, values, hurry) {
            let pairs = own
                .iter_mut()
                .zip(curves)
                .filter(|(series, _)| series.curve_kind != CurveKind::Missing);
            pairs.for_each(|(series, curve)| series.curve = scaled(series, curve));
        }
        rest = others;
    }
}

/// A curve in the units of the data, of logarithms where these are compared.
fn scaled(series: &SolvedSeries, mut curve: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    let scale = series.scale.as_ref().map_or(1.0, |own| own.value);
    let offset = series.offset.as_ref().map_or(0.0, |own| own.value);
    curve.iter_mut().for_each(|point| point[1] = scale * point[1] + offset);
    if series.curve_kind == CurveKind::Logarithms {
        curve.retain(|point| point[1] > 0.0);
        curve.iter_mut().for_each(|point| point[1] = elementary::ln(point[1]));
    }
    curve
}

fn curves(
    experiment: &Experiment,
    values: &[f64],
    hurry: Option<TimeBudget>,
) -> Option<Vec<Vec<[f64; 2]>>> {
    let is_over_frequency = experiment.model.abscissa() == Some(experiment.x_name.as_str());
    let places = |x: &[f64]| if is_over_frequency { grid_of_ratios(x) } else { grid(x) };
    let dense = |observation: &Observation| Observation {
        x: places(&observation.x),
        ..observation.clone()
    };
    let observations: Vec<Observation> = experiment.observations.iter().map(dense).collect();
    let grids: Vec<Vec<f64>> = observations.iter().map(|dense| dense.x.clone()).collect();
    let mut dense = Experiment { observations, ..experiment.clone() };
    if hurry.is_some() {
        dense.settings.time_budget = hurry;
    }
    let mut simulator = ModelSimulator::new(std::slice::from_ref(&dense)).ok()?;
    let mut row = vec![f64::NAN; grids.iter().map(Vec::len).sum()];
    simulator.simulate(values, &mut row).ok()?;
    let mut simulated = row.into_iter();
    let curve = |x: Vec<f64>| x.into_iter().zip(&mut simulated).map(|(x, y)| [x, y]).collect();
    Some(grids.into_iter().map(curve).collect())
}

/// The measured places and, evenly between their ends, many more; ascending.
fn grid(measured: &[f64]) -> Vec<f64> {
    let low = measured.iter().copied().fold(f64::INFINITY, f64::min);
    let high = measured.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let step = (high - low) / POINTS as f64;
    let between = (1..POINTS).map(|k| step.mul_add(k as f64, low));
    let mut grid: Vec<f64> = measured.iter().copied().chain(between).collect();
    grid.sort_by(f64::total_cmp);
    grid.dedup();
    grid
}

/// The same evenly by the logarithm, for frequencies.
fn grid_of_ratios(measured: &[f64]) -> Vec<f64> {
    let logarithms: Vec<f64> = measured.iter().map(|x| elementary::ln(*x)).collect();
    let between = grid(&logarithms).into_iter().map(elementary::exp);
    let low = measured.iter().copied().fold(f64::INFINITY, f64::min);
    let high = measured.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    // The measured places themselves, not what their logarithms round to.
    let is_measured = |x: &f64| measured.iter().any(|own| (own / x - 1.0).abs() < 1e-12);
    let between = between.filter(|x| *x > low && *x < high && !is_measured(x));
    let mut grid: Vec<f64> = measured.iter().copied().chain(between).collect();
    grid.sort_by(f64::total_cmp);
    grid.dedup();
    grid
}

#[cfg(test)]
mod tests {
    use super::grid;

    #[test]
    fn the_grid_has_every_measured_place_and_does_not_reach_beyond() {
        let found = grid(&[3.0, 1.0, 1.7]);
        assert!([1.0, 1.7, 3.0].iter().all(|x| found.contains(x)));
        assert!(found.is_sorted() && found[0] == 1.0 && found[found.len() - 1] == 3.0);
        assert!(found.windows(2).all(|pair| pair[1] - pair[0] < 2.01 / 160.0 && pair[1] > pair[0]));
        assert_eq!(grid(&[2.0]), [2.0]);
    }
}
