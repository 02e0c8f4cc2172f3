//! The states of a model from measurements, its parameters given: the filter of a problem with process noise
//! alone.

use super::build::{FilteredExperiment, filtered_experiments};
use super::{file, refusal};
use crate::Session;
use crate::diag::{Diagnostic, Fault, suggest};
use crate::fault;
use crate::identify::problem::{Experiment, Free, ModelSimulator, Observation, Simulate};
use crate::models::imported::refuse_as_text;
use crate::registry::BAD_OPTION;
use crate::results::{ResultTable, Series, Values};
use crate::source::Span;
use std::path::{Path, PathBuf};

/// States from data.
pub struct Estimated {
    /// The name of the experiment.
    pub experiment: String,
    /// At each sample: the states after it, their standard deviations, the measured outputs, their
    /// predictions from all earlier samples, and the standard deviations of these.
    pub table: ResultTable,
    /// What was estimated and measured: value, standard deviation, and for outputs the measured values, by
    /// their names in the table.
    pub shown: Vec<[Option<String>; 3]>,
    /// -log L of the measurements.
    pub negative_log_likelihood: f64,
    /// The files that were read: the problem, its data and the values.
    pub read: Vec<PathBuf>,
}

/// Estimates the states of an experiment of the problem in the file `path`, that of this name or the only
/// one. Parameters that the problem leaves free have the values of `values`, a result of `gapi identify`, or
/// where they start.
///
/// # Errors
///
/// Everything that is wrong with the problem; parameters without values, filters that fail.
pub fn estimate(
    session: &mut Session,
    path: &Path,
    (values, name): (Option<&Path>, Option<&str>),
) -> Result<Estimated, Vec<Diagnostic>> {
    let one = |fault: Fault| vec![fault.at(Span::NONE)];
    refuse_as_text(path, "a problem file").map_err(one)?;
    let bytes = session.read_bytes(path).map_err(one)?;
    let text = String::from_utf8(bytes)
        .map_err(|_| one(fault!(BAD_OPTION, "`{}` is not valid UTF-8 text", path.display())))?;
    let source = session.sources.add(path.display().to_string(), text.as_str());
    let mut file = file::read(source, &text)
        .map_err(|error| vec![refusal::with_unread_columns(session, path, &text, error)])?;
    if file.noise.is_empty() {
        return Err(one(fault!(BAD_OPTION, "`{}` has no process noise", path.display()).help(
            "say on which states noise acts: `[noise]` with `T = 1e-3`; without it, simulate",
        )));
    }
    let (experiments, free, notes) = filtered_experiments(session, &mut file, path)?;
    notes.iter().for_each(|note| note.say(session));
    let folder = path.parent().unwrap_or(Path::new(""));
    let mut read: Vec<PathBuf> = file.experiment.iter().map(|own| folder.join(&own.data)).collect();
    read.extend(std::iter::once(path).chain(values).map(Path::to_owned));
    let known = match values {
        Some(values) => found(session, values).map_err(one)?,
        None => Vec::new(),
    };
    let values = given(&free, &known).map_err(one)?;
    let chosen = chosen(experiments, name).map_err(one)?;
    let found = states(&chosen, &values).map_err(one)?;
    Ok(Estimated { read, ..found })
}

/// The values in a result of `gapi identify`.
fn found(session: &Session, path: &Path) -> Result<Vec<(String, f64)>, Fault> {
    let bytes = session.read_bytes(path)?;
    let result: Result<serde_json::Value, _> = serde_json::from_slice(&bytes);
    let parameters = result.ok().and_then(|own| own["parameters"].as_array().cloned());
    let parameters = parameters.ok_or_else(|| {
        fault!(BAD_OPTION, "`{}` is not a result of `gapi identify`", path.display())
            .help("give the file `result.json` of its folder")
    })?;
    let one =
        |own: &serde_json::Value| Some((own["name"].as_str()?.to_owned(), own["value"].as_f64()?));
    Ok(parameters.iter().filter_map(one).collect())
}

/// The values of the free parameters.
fn given(free: &[Free], known: &[(String, f64)]) -> Result<Vec<f64>, Fault> {
    let value = |own: &Free| {
        let known = known.iter().find(|(name, _)| *name == own.name).map(|(_, value)| *value);
        known.or(own.start)
    };
    let missing: Vec<&str> =
        free.iter().filter(|own| value(own).is_none()).map(|own| own.name.as_str()).collect();
    if !missing.is_empty() {
        let names = suggest::listed(&missing);
        return Err(fault!(BAD_OPTION, "no value is given for {names}").help(
            "write `fixed` or `start` in the problem, or give the `result.json` of a fit: `--values FILE`",
        ));
    }
    Ok(free.iter().filter_map(value).collect())
}

fn chosen(
    mut all: Vec<FilteredExperiment>,
    name: Option<&str>,
) -> Result<FilteredExperiment, Fault> {
    let names: Vec<String> = all.iter().map(|own| own.experiment.name.clone()).collect();
    let names = suggest::listed(&names.iter().map(String::as_str).collect::<Vec<_>>());
    let place = match name {
        Some(name) => all.iter().position(|own| own.experiment.name == name),
        None => (all.len() == 1).then_some(0),
    };
    match (place, name) {
        (Some(place), _) => Ok(all.swap_remove(place)),
        (None, Some(name)) => Err(fault!(BAD_OPTION, "there is no experiment `{name}`")
            .help(format!("the experiments are {names}"))),
        (None, None) => Err(fault!(BAD_OPTION, "the problem has several experiments")
            .help(format!("select one of {names}: `--experiment NAME`"))),
    }
}

/// Runs the filter.
fn states(chosen: &FilteredExperiment, values: &[f64]) -> Result<Estimated, Fault> {
    let FilteredExperiment { experiment, series, states } = chosen;
    let mut times: Vec<f64> = series.iter().flat_map(|own| own.x.iter().copied()).collect();
    times.sort_by(f64::total_cmp);
    times.dedup();
    let at_samples = |name: &String| Observation { y_name: name.clone(), x: times.clone() };
    let of_states = states.iter().flatten().map(at_samples);
    let observations: Vec<Observation> =
        experiment.observations.iter().cloned().chain(of_states).collect();
    let count = observations.iter().map(|own| own.x.len()).sum();
    let watched = Experiment { observations, deviations: 0, ..experiment.clone() };
    let mut row = vec![0.0; count];
    let mut simulator = ModelSimulator::new(std::slice::from_ref(&watched))?;
    simulator.simulate(values, &mut row).map_err(|failed| {
        fault!(BAD_OPTION, "the filter fails: {}", failed.cause)
            .help("check the values of the parameters")
    })?;
    let mut columns = watched.observations.iter().map(|own| {
        let rest = row.split_off(own.x.len());
        std::mem::replace(&mut row, rest)
    });
    let data = series.iter().filter(|own| own.is_data()).count();
    let predictions: Vec<Vec<f64>> = columns.by_ref().take(data).collect();
    let deviations: Vec<Vec<f64>> = columns.by_ref().take(data).collect();
    let of_states: Vec<Vec<f64>> = columns.collect();
    let mut made =
        Table { times: &times, table: ResultTable::new(times.clone()), shown: Vec::new() };
    for ([state, _], pair) in states.iter().zip(of_states.chunks_exact(2)) {
        let unit = experiment.model.unit(state).unwrap_or_default();
        let sd: Vec<f64> = pair[1].iter().map(|variance| variance.max(0.0).sqrt()).collect();
        let names = [state.clone(), format!("sd({state})")];
        made.add(&names, &unit, (&times, &[pair[0].clone(), sd]));
    }
    let mut log = 0.0;
    for ((own, predicted), sd) in series.iter().zip(&predictions).zip(&deviations) {
        let name = &own.y_name;
        let names = [
            format!("predicted({name})"),
            format!("sd(predicted({name}))"),
            format!("measured({name})"),
        ];
        made.add(&names, &own.y_unit, (&own.x, &[predicted.clone(), sd.clone(), own.y.clone()]));
        log += own.y.iter().zip(predicted).zip(sd).map(density).sum::<f64>();
    }
    Ok(Estimated {
        experiment: experiment.name.clone(),
        table: made.table,
        shown: made.shown,
        negative_log_likelihood: log,
        read: Vec::new(),
    })
}

/// -log of the density of a normal measurement.
fn density(((y, predicted), sd): ((&f64, &f64), &f64)) -> f64 {
    let own = (y - predicted) / sd;
    0.5 * own * own
        + crate::elementary::ln(*sd)
        + 0.5 * crate::elementary::ln(std::f64::consts::TAU)
}

/// A table that is being made.
struct Table<'a> {
    times: &'a [f64],
    table: ResultTable,
    shown: Vec<[Option<String>; 3]>,
}

impl Table<'_> {
    /// Adds columns over some of the times; where there is no value, it is not a number.
    fn add(&mut self, names: &[String], unit: &str, (x, columns): (&[f64], &[Vec<f64>])) {
        let mut shown = [const { None }; 3];
        for ((name, values), shown) in names.iter().zip(columns).zip(&mut shown) {
            let at = |time: &f64| {
                x.binary_search_by(|own| own.total_cmp(time)).ok().map_or(f64::NAN, |at| values[at])
            };
            let values = self.times.iter().map(at).collect();
            let name = self.free_name(name);
            self.table.series.push(Series {
                unit: unit.to_owned(),
                ..Series::new(name.clone(), Values::Trajectory(values))
            });
            *shown = Some(name);
        }
        self.shown.push(shown);
    }

    /// Replicate measurements have one variable.
    fn free_name(&self, name: &str) -> String {
        let is_free = |name: &String| self.table.series.iter().all(|own| own.name != *name);
        let more = (2..).map(|number| format!("{name} {number}"));
        std::iter::once(name.to_owned()).chain(more).find(is_free).unwrap_or_default()
    }
}
