//! The figures of an identification.

use super::figure::{Axis, Figure, Mark, Panel, Series};

/// Fitness values from here on stand for failed simulations (one alone counts 1e60); they are not
/// drawn.
const FAILED: f64 = 1e50;
/// More measured points than this are small dots below the curve, and their residuals have no stems.
pub const MANY: usize = 300;
/// Means of a generation above so many times the first best fitness are not drawn: those of a random
/// population would leave a few pixels to the best one.
const DROWNING: f64 = 10.0;

/// How so many measured points are drawn.
pub fn of_points(count: usize) -> Mark {
    if count > MANY { Mark::Dots } else { Mark::Points }
}

/// How residuals are drawn.
pub fn of_residuals(is_long: bool) -> Mark {
    if is_long { Mark::Dots } else { Mark::Stems }
}

/// A measured and a simulated quantity at the same places.
#[derive(Debug, Clone)]
pub struct Comparison<'a> {
    /// Title of the figure; may be empty.
    pub title: &'a str,
    /// The axis of `x`.
    pub x_axis: Axis,
    /// The axis of `measured` and `simulated`.
    pub y_axis: Axis,
    /// Where it was measured, in any order.
    pub x: &'a [f64],
    /// Measured values.
    pub measured: &'a [f64],
    /// Simulated values.
    pub simulated: &'a [f64],
    /// The simulated curve between them, by ascending x: places and values. If empty, the curve
    /// goes straight from one of the simulated values to the next.
    pub curve: (&'a [f64], &'a [f64]),
}

/// Measured points and the simulated curve, and below them the residuals, measured less simulated.
pub fn fit(data: Comparison) -> Figure {
    let mut order: Vec<usize> = (0..data.x.len()).collect();
    order.sort_by(|a, b| data.x[*a].total_cmp(&data.x[*b]));
    let sorted = |values: &[f64]| order.iter().map(|i| values[*i]).collect::<Vec<f64>>();
    let (x, measured, simulated) = (sorted(data.x), sorted(data.measured), sorted(data.simulated));
    let residuals = measured.iter().zip(&simulated).map(|(m, s)| m - s).collect();
    let curve = match data.curve {
        ([], _) => (x.clone(), simulated),
        (x, y) => (x.to_vec(), y.to_vec()),
    };
    let series =
        |name: &str, (x, y), mark, colour| Series { name: name.to_owned(), x, y, mark, colour };
    let is_long = x.len() > MANY;
    let residual = Axis::linear("residual", &data.y_axis.unit);
    let mut fit = vec![
        series("simulated", curve, Mark::Line, 1),
        series("measured", (x.clone(), measured), of_points(x.len()), 0),
    ];
    if is_long {
        fit.rotate_left(1);
    }
    Figure {
        title: data.title.to_owned(),
        panels: vec![
            Panel {
                x: data.x_axis.clone(),
                y: data.y_axis,
                height: 270.0,
                zero_line: false,
                series: fit,
            },
            Panel {
                x: data.x_axis,
                y: residual,
                height: 110.0,
                zero_line: true,
                series: vec![series("", (x, residuals), of_residuals(is_long), 0)],
            },
        ],
    }
}

/// The values of generations without those that would leave a few pixels to the best one, where the
/// search began with this best value; none where these are most of them.
pub fn undrowned(values: &[f64], first: f64) -> Vec<f64> {
    let most = if first > 0.0 { (DROWNING * first).min(FAILED) } else { FAILED };
    let is_kept = |value: &&f64| **value < most;
    let some = 2 * values.iter().filter(is_kept).count() >= values.len();
    values.iter().map(|value| if some && *value < most { *value } else { f64::NAN }).collect()
}

/// Best and mean fitness over the generations, counted from 1, on a logarithmic axis. Means that
/// contain a failed simulation, or are far above the first best fitness, are left out.
pub fn convergence(title: &str, best: &[f64], mean: &[f64]) -> Figure {
    let first = best.iter().copied().find(|best| *best < FAILED).unwrap_or(FAILED);
    let series = |name: &str, values: &[f64], mark, colour| Series {
        name: name.to_owned(),
        x: (1..=values.len()).map(|generation| generation as f64).collect(),
        y: values.iter().map(|v| if *v < FAILED { *v } else { f64::NAN }).collect(),
        mark,
        colour,
    };
    let mean = undrowned(mean, first);
    let mut all = vec![series("best individual", best, Mark::Line, 1)];
    if mean.iter().any(|mean| mean.is_finite()) {
        all.insert(0, series("mean of the generation", &mean, Mark::Thin, 2));
    }
    Figure {
        title: title.to_owned(),
        panels: vec![Panel {
            x: Axis::linear("generation", ""),
            y: Axis::logarithmic("fitness (smaller is better)", ""),
            height: 330.0,
            zero_line: false,
            series: all,
        }],
    }
}
