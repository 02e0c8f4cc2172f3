//! Experiments of problems with process noise: the model is filtered, so that each measurement is
//! compared with its prediction from all earlier ones.

use super::data::Notes;
use super::enclosing_class::own_name;
use super::file::{ColumnEntry, ExperimentEntry, Filtering, MoreTimes, ProblemFile};
use super::noise::{deviation, of_states};
use crate::Session;
use crate::codegen::Program;
use crate::diag::{At as _, Diagnostic, Fault, suggest};
use crate::fault;
use crate::identify::CompiledModel;
use crate::identify::problem::{Experiment, Observation, Series, Sigma};
use crate::models::filter::{self, Measured, MeasuredSigma, Noise, Purpose, UncertainStates};
use crate::registry::BAD_OPTION;
use crate::source::Span;
use std::sync::Arc;

/// The largest number of times at which states are estimated besides those of the rows.
const MOST_TIMES: f64 = 1e6;

/// An experiment with its series, its program, and its uncertain states.
pub(super) type FilteredModel = (Experiment, Vec<Series>, Arc<Program>, UncertainStates);

/// The experiment with the filtered model of this class in place of its model: its points are
/// predictions. `rows`: the times of all rows of the data.
///
/// # Errors
///
/// What a filter cannot do with the model, the data or the settings.
pub(super) fn filtered(
    session: &mut Session,
    (file, entry): (&ProblemFile, &ExperimentEntry),
    (class, rows): (&str, &[f64]),
    (mut experiment, mut series): (Experiment, Vec<Series>),
    notes: &mut Notes,
) -> Result<FilteredModel, Vec<Diagnostic>> {
    let one = |error: Diagnostic| vec![error];
    // Deviations that the model computes belong to its outputs.
    series.retain(Series::is_data);
    experiment.observations.truncate(series.len());
    for (own, (name, column)) in series.iter().zip(entry.all_outputs()) {
        check(own, name, &column).at(entry.places.at(&["outputs", name])).map_err(one)?;
    }
    refuse_unknown(file, &experiment)?;
    let noise = of_states(file, (&experiment, &series)).map_err(one)?;
    let outputs = entry.all_outputs().zip(&series).zip(&experiment.observations);
    let measured: Vec<Measured> = outputs
        .map(|((output, own), observation)| Measured {
            name: observation.y_name.clone(),
            times: own.x.clone(),
            values: own.y.clone(),
            sigma: sigma(output, own),
            is_used: !matches!(
                file.context.filtering,
                Filtering::Simulated(_) | Filtering::Ahead(..)
            ),
        })
        .collect();
    let start = experiment.settings.start;
    note_certain_start(file, (&noise, &measured, start), &experiment.name, notes);
    let place = file.context.places.at(&["noise"]);
    let more = match &file.context.filtering {
        Filtering::Smoothed(more) | Filtering::Simulated(more) | Filtering::Ahead(_, more) => {
            times(entry, rows, start, *more).at(Span::NONE).map_err(one)?
        }
        Filtering::Filtered | Filtering::WithoutNoise => Vec::new(),
    };
    experiment.settings.stop = more.iter().copied().fold(experiment.settings.stop, f64::max);
    let what = (&noise[..], &measured[..], purpose(&file.context.filtering, &experiment.name));
    let found = filter::filtered(session, class, what, (start, &more), place)?;
    let program = found.translated.program.clone();
    experiment.model = Arc::new(CompiledModel::new(&file.model, program.clone()));
    experiment.deviations = found.outputs.len();
    for (k, [prediction, deviation]) in found.outputs.into_iter().enumerate() {
        experiment.observations[k].y_name = prediction;
        series[k].sigma = Sigma::Variable(deviation.clone());
        let x = series[k].x.clone();
        experiment.observations.push(Observation { y_name: deviation.clone(), x });
        series.push(series[k].deviations(&deviation, series.len() - k));
    }
    for (name, column) in entry.all_outputs().filter(|(_, column)| column.sigma.is_none()) {
        let name = column.column.as_ref().unwrap_or(name);
        let experiment = &experiment.name;
        notes.add(format!("{experiment}: `{name}` has no `sigma`; it is estimated"));
    }
    Ok((experiment, series, program, found.states))
}

/// What an experiment is filtered for.
fn purpose<'f>(filtering: &'f Filtering, experiment: &str) -> Purpose<'f> {
    match filtering {
        Filtering::Smoothed(_) => Purpose::Smoothing,
        Filtering::Ahead(all, _) => all.get(experiment).map_or(Purpose::Likelihood, Purpose::Ahead),
        _ => Purpose::Likelihood,
    }
}

/// The times of rows at which nothing was measured, and those that are asked for besides.
fn times(
    entry: &ExperimentEntry,
    rows: &[f64],
    start: f64,
    more: MoreTimes,
) -> Result<Vec<f64>, Fault> {
    let own: Vec<f64> = rows.iter().copied().filter(|time| *time >= start).collect();
    let last = own.iter().copied().fold(start, f64::max);
    let end = more.until.unwrap_or(last);
    if end > last && !entry.inputs.is_empty() {
        let name = entry.data.display();
        return Err(fault!(
            BAD_OPTION,
            "`{name}` has the inputs up to {last} s, not up to {end} s"
        )
        .help("add rows with the inputs to it; cells of outputs may be empty"));
    }
    let Some(every) = more.every else {
        return Ok(own.into_iter().chain(more.until).collect());
    };
    let count = ((end - start) / every).floor();
    if !(every > 0.0 && (0.0..=MOST_TIMES).contains(&count)) {
        return Err(fault!(BAD_OPTION, "{every} s between times is not possible")
            .help("write a positive number of seconds that divides the data into rows"));
    }
    let grid = (0..=count as usize).map(|k| every.mul_add(k as f64, start));
    Ok(own.into_iter().chain(grid).chain(more.until).collect())
}

/// Says where the first measurements are compared with states that are certain.
fn note_certain_start(
    file: &ProblemFile,
    (noise, measured, start): (&[Noise], &[Measured], f64),
    experiment: &str,
    notes: &mut Notes,
) {
    let is_uncertain = noise.iter().any(|own| own.initial > 0.0)
        || file.parameters.values().any(|own| own.initial);
    let is_measured = measured.iter().any(|own| own.times.first() == Some(&start));
    if is_measured && !is_uncertain {
        notes.add(format!(
            "{experiment}: the states at the start are certain, so the first measurements tell of the \
             errors of measurement alone; say how uncertain the states are, `{{ value = \"estimate\", \
             initial = 0.5 }}` in `[noise]`, or estimate them (`initial = true` in `[parameters]`)"
        ));
    }
}

/// Refuses noise on what the model does not have, at the name.
fn refuse_unknown(file: &ProblemFile, experiment: &Experiment) -> Result<(), Vec<Diagnostic>> {
    let model = &experiment.model;
    let Some(name) = file.noise.keys().find(|name| model.unit(name).is_none()) else {
        return Ok(());
    };
    let names = model.names();
    let near = suggest::did_you_mean(name, names.iter().map(String::as_str));
    let fault = fault!(BAD_OPTION, "`{}` has no variable `{name}`", file.model);
    Err(vec![fault.help_if(near).at(file.context.places.at(&["noise", name]))])
}

/// The standard deviation of the measurements of an output.
fn sigma((name, column): (&String, ColumnEntry), own: &Series) -> MeasuredSigma {
    match (&own.sigma, deviation(name, &column)) {
        (Sigma::Given(values), _) => match values.split_first() {
            Some((first, rest)) if rest.iter().all(|value| value == first) => {
                MeasuredSigma::Expression(format!("{first:e}"))
            }
            _ => MeasuredSigma::Samples(values.clone()),
        },
        (Sigma::Variable(name), _) => MeasuredSigma::Expression(name.clone()),
        (_, Some(name)) => MeasuredSigma::Expression(own_name("the", &name)),
        (_, None) => MeasuredSigma::Expression("1.0".to_owned()),
    }
}

/// Refuses what a filter cannot take.
fn check(own: &Series, name: &str, column: &ColumnEntry) -> Result<(), Fault> {
    if own.x_name != "time" {
        return Err(fault!(BAD_OPTION, "process noise acts over time, but X is `{}`", own.x_name)
            .help("remove `[noise]`, or use `time` as X"));
    }
    if let Some(pair) = own.x.windows(2).find(|pair| pair[1] <= pair[0]) {
        return Err(fault!(
            BAD_OPTION,
            "`{name}` has two values at {} s, of which a filter takes one",
            pair[1]
        )
        .help("keep one row of each time"));
    }
    if own.weight != 1.0 || column.error.is_some() {
        let what = if own.weight == 1.0 { "another `error`" } else { "a `weight`" };
        return Err(fault!(
            BAD_OPTION,
            "`{name}` has {what}, which has no meaning with process noise"
        )
        .help("remove it; `sigma` says how large the errors are"));
    }
    if column.below.is_some() || column.above.is_some() {
        let limit = if column.below.is_some() { "below" } else { "above" };
        return Err(fault!(
            BAD_OPTION,
            "`{name}` has the limit `{limit}`, and a filter takes each value as a measurement"
        )
        .help("leave the cells beyond the limit empty, and remove it"));
    }
    if column.delay.is_some() {
        return Err(fault!(
            BAD_OPTION,
            "`{name}` is measured with a `delay`, and a filter keeps no past"
        )
        .help("subtract a known delay from the times of its column, in a separate file"));
    }
    if matches!(own.sigma, Sigma::Formula(_)) {
        return Err(fault!(
            BAD_OPTION,
            "the `sigma` of `{name}` is a formula of the output, which a filter does not have"
        )
        .help("write a number, the name of a column, or \"estimate\""));
    }
    Ok(())
}
