//! How the measured points are found on a simulation: at times, in X, or one by one.

use super::model::Model;
use super::points::{Path, is_jump, time_of};
use crate::diag::Fault;
use crate::sim::{OutputGrid, Settings};

/// X when nothing else is named.
pub const TIME: &str = "time";
/// Slices in which the measured points are looked for on a function of time.
const SLICES: u32 = 500;

/// How the measured points are found on a trajectory.
pub enum Plan {
    /// X depends on time alone: at these times, in the order of the points. Only Y is observed.
    AtTimes(Vec<f64>),
    /// X is simulated along with Y: by interpolation in X.
    InX,
    /// X is an input of a model without states: one by one.
    OneByOne,
}

/// The varied parameters, and after them the one that stands for X where it is an input.
pub(crate) fn with_driver(model: &dyn Model, varied: &[String]) -> Vec<String> {
    let driver = model.driven().map(|(_, parameter)| parameter.to_owned());
    varied.iter().cloned().chain(driver).collect()
}

/// How the points are found; changes `settings` to what that needs.
pub fn plan(
    model: &dyn Model,
    varied: &[String],
    x_name: &str,
    points: &[f64],
    settings: &mut Settings,
) -> Result<Plan, Fault> {
    if model.driven().is_some_and(|(driven, _)| driven == x_name) {
        return Ok(Plan::OneByOne);
    }
    let times = if x_name == TIME || model.abscissa() == Some(x_name) {
        if !model.has_stop_time() {
            settings.stop = points.iter().copied().fold(settings.start, f64::max);
        }
        let path = [settings.start, settings.stop];
        reachable(&Path { times: &path, x: &path }, x_name, points)?;
        points.to_vec()
    } else if model.depends_on_time_alone(x_name, varied)
        && let Some(times) = times_of_points(model, varied, x_name, points, settings)?
    {
        times
    } else {
        return Ok(Plan::InX);
    };
    let mut ascending = times.clone();
    ascending.sort_by(f64::total_cmp);
    ascending.dedup();
    settings.stop = ascending.last().copied().unwrap_or(settings.stop).max(settings.start);
    settings.output = OutputGrid::At(ascending);
    Ok(Plan::AtTimes(times))
}

fn reachable(path: &Path<'_>, name: &str, points: &[f64]) -> Result<(), Fault> {
    let outside = path.targets_outside(points);
    if outside.is_empty() { Ok(()) } else { Err(path.outside(name, &outside)) }
}

/// The times at which X, a function of time alone, takes the measured values; `None` when X cannot
/// be evaluated with the model's own parameter values, which need not make sense for this
/// experiment.
fn times_of_points(
    model: &dyn Model,
    varied: &[String],
    x_name: &str,
    points: &[f64],
    settings: &Settings,
) -> Result<Option<Vec<f64>>, Fault> {
    let mut instance = model.instance(varied, &[x_name.to_owned()])?;
    let Some(system) = instance.system() else { return Ok(None) };
    let mut y = vec![0.0; system.n_differential() + system.n_algebraic()];
    if system.initialize(settings.start, &mut y).is_err() {
        return Ok(None);
    }
    // Not initialized at every time: what must hold for the other variables does not matter here.
    let mut x_at = |time: f64| {
        let mut value = [f64::NAN];
        instance.observe_in_time(time, &y, &mut value).map(|()| value[0])
    };
    let length = settings.stop - settings.start;
    let grid: Vec<f64> =
        (0..=SLICES).map(|k| settings.start + length * f64::from(k) / f64::from(SLICES)).collect();
    let Ok(x) = grid.iter().map(|&time| x_at(time)).collect::<Result<Vec<f64>, _>>() else {
        return Ok(None);
    };
    let path = Path { times: &grid, x: &x };
    reachable(&path, x_name, points)?;
    let slices: Vec<usize> =
        points.iter().map(|&point| path.slice_of(x_name, point)).collect::<Result<_, Fault>>()?;
    let mut times = Vec::with_capacity(points.len());
    for (&point, k) in points.iter().zip(slices) {
        let Ok(time) = time_of(grid[k], grid[k + 1], point, &mut x_at) else { return Ok(None) };
        let Ok(reached) = x_at(time) else { return Ok(None) };
        if is_jump(reached - point, x[k + 1] - x[k]) {
            return Err(path.jumps_over(x_name, point, time));
        }
        times.push(time);
    }
    Ok(Some(times))
}
