//! Results as Python's `pickle` and `copy` keep them: the way to other processes.

use crate::model::SimulationResult;
use gapilib::internals::sim::Statistics;
use gapilib::results::{ResultTable, Series, Values};
use numpy::{PyArray1, PyArrayMethods, PyReadonlyArray1};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use std::sync::Arc;

/// The function that restores a result, and its arguments.
pub(crate) type Reduced<'py> = (Bound<'py, PyAny>, Stored<'py>);

/// The model, the time points, the variables, the statistics.
type Stored<'py> = (String, Bound<'py, PyArray1<f64>>, Vec<StoredSeries<'py>>, [u64; COUNTS]);

/// Name, unit, description and values: a number for a constant, an array for a trajectory, the place of
/// another variable and whether the sign differs for an alias.
type StoredSeries<'py> = (String, String, String, Bound<'py, PyAny>);

/// How many numbers the statistics have.
const COUNTS: usize = 8;

fn counts(statistics: &mut Statistics) -> [&mut u64; COUNTS] {
    [
        &mut statistics.steps,
        &mut statistics.error_failures,
        &mut statistics.newton_failures,
        &mut statistics.rhs_evaluations,
        &mut statistics.jacobian_evaluations,
        &mut statistics.factorizations,
        &mut statistics.state_events,
        &mut statistics.time_events,
    ]
}

pub(crate) fn reduced<'py>(py: Python<'py>, result: &SimulationResult) -> PyResult<Reduced<'py>> {
    let series = result.table.series.iter().map(|series| {
        let values = match &series.values {
            Values::Constant(value) => value.into_pyobject(py)?.into_any(),
            Values::Trajectory(values) => PyArray1::from_slice(py, values).into_any(),
            Values::Alias { of, negated } => (*of, *negated).into_pyobject(py)?.into_any(),
        };
        Ok((series.name.clone(), series.unit.clone(), series.description.clone(), values))
    });
    let series = series.collect::<PyResult<Vec<_>>>()?;
    let mut statistics = result.statistics;
    let counts = counts(&mut statistics).map(|count| *count);
    let time = PyArray1::from_slice(py, &result.table.time);
    let restore = py.import("gapilib._gapilib")?.getattr("_restored")?;
    Ok((restore, (result.model.clone(), time, series, counts)))
}

/// Whether trajectories have a value at each point in time, and aliases another series.
fn is_whole(table: &ResultTable) -> bool {
    table.series.iter().all(|series| match &series.values {
        Values::Constant(_) => true,
        Values::Trajectory(values) => values.len() == table.time.len(),
        Values::Alias { of, .. } => (table.series.get(*of))
            .is_some_and(|series| !matches!(series.values, Values::Alias { .. })),
    })
}

/// The result that `pickle` has kept.
#[pyfunction]
#[pyo3(name = "_restored")]
pub(crate) fn restored(
    model: String,
    time: PyReadonlyArray1<'_, f64>,
    series: Vec<StoredSeries<'_>>,
    numbers: [u64; COUNTS],
) -> PyResult<SimulationResult> {
    let mut table = ResultTable::new(time.to_vec()?);
    for (name, unit, description, values) in series {
        let values = if let Ok(values) = values.cast::<PyArray1<f64>>() {
            Values::Trajectory(values.readonly().to_vec()?)
        } else if let Ok(value) = values.extract::<f64>() {
            Values::Constant(value)
        } else {
            let (of, negated) = values.extract()?;
            Values::Alias { of, negated }
        };
        table.series.push(Series { name, unit, description, values });
    }
    if !is_whole(&table) {
        return Err(PyValueError::new_err("these are not the values of a simulation's result"));
    }
    let mut statistics = Statistics::default();
    for (count, number) in counts(&mut statistics).into_iter().zip(numbers) {
        *count = number;
    }
    Ok(SimulationResult { model, table: Arc::new(table), statistics })
}
