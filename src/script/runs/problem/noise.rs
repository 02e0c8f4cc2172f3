//! Process noise: what a problem says of it. The densities of noise and the deviations of measurements that are estimated are parameters of the
//! problem, on a logarithmic scale; ranges that are not given follow from how much the data change from
//! one row to the next.

use super::enclosing_class::{EnclosingClass, own_name};
use super::file::{ColumnEntry, ExperimentEntry, Filtering, NoiseEntry, ProblemFile, SigmaEntry};
use crate::diag::{At as _, Diagnostic, Fault};
use crate::elementary;
use crate::identify::problem::{Experiment, Free, NOISE_OF, Series};
use crate::models::filter::Noise;
use crate::registry::BAD_OPTION;
use crate::source::Span;
use crate::{bail, fault};
use std::fmt::Write as _;

/// What is written for a density that is estimated.
const ESTIMATE: &str = "estimate";
/// Ranges of estimates relative to the root mean square of the changes between rows: white noise of
/// measurement makes them 1.4 times as large as its deviation, noise of the state alone as large as what it
/// adds in this time.
const RANGE: [f64; 2] = [1e-4, 10.0];
/// A range until the data are known.
const UNKNOWN_RANGE: [f64; 2] = [1e-6, 1.0];

/// The density of the noise of a state.
enum Density {
    Fixed(f64),
    /// Within a range, if that is given.
    Estimated {
        range: Option<[f64; 2]>,
        start: Option<f64>,
    },
}

/// A parameter of the problem that is none of the model.
struct Own {
    /// Its name in the problem.
    name: String,
    /// Its name in the class around the model.
    in_class: String,
    range: Option<[f64; 2]>,
    start: Option<f64>,
    /// The state or the output that it belongs to.
    of: Subject,
}

enum Subject {
    State(String),
    Output(String),
}

impl NoiseEntry {
    fn density(&self, state: &str) -> Result<Density, Fault> {
        let number = |value: f64| match value.is_finite() && value >= 0.0 {
            true => Ok(Density::Fixed(value)),
            false => {
                bail!(BAD_OPTION, "the noise of `{state}` is {value}"; help: "write a positive number or 0: the standard deviation that it adds in 1 s")
            }
        };
        let words = |words: &str, range, start| match words == ESTIMATE {
            true => Ok(Density::Estimated { range, start }),
            false => {
                bail!(BAD_OPTION, "the noise of `{state}` is \"{words}\""; help: "write a number, \"estimate\", or a range: `{{ min = 1e-4, max = 1e-1 }}`")
            }
        };
        let entry = match self {
            NoiseEntry::Number(value) => return number(*value),
            NoiseEntry::Words(own) => return words(own, None, None),
            NoiseEntry::More(entry) => entry,
        };
        if let Some(initial) = entry.initial.filter(|own| !(own.is_finite() && *own >= 0.0)) {
            bail!(BAD_OPTION, "the standard deviation of the initial value of `{state}` is {initial}"; help: "write a positive number or 0");
        }
        let range = entry.min.zip(entry.max).map(|(min, max)| [min, max]);
        match (&entry.value, range) {
            (Some(SigmaEntry::Number(value)), None) => number(*value),
            (Some(SigmaEntry::Words(own)), range) => words(own, range, entry.start),
            (None, Some(_)) => Ok(Density::Estimated { range, start: entry.start }),
            _ => bail!(
                BAD_OPTION,
                "the noise of `{state}` must have either `min` and `max`, or `value`";
                help: "write for example `{{ value = \"estimate\", initial = 0.5 }}`"
            ),
        }
    }

    fn initial(&self) -> f64 {
        match self {
            NoiseEntry::More(entry) => entry.initial.unwrap_or(0.0),
            _ => 0.0,
        }
    }
}

/// The parameters that noise adds to a problem.
fn own_parameters(file: &ProblemFile) -> Result<Vec<Own>, Diagnostic> {
    let mut all: Vec<Own> = Vec::new();
    for (state, entry) in &file.noise {
        if let Density::Estimated { range, start } =
            entry.density(state).at(file.context.places.at(&["noise", state]))?
        {
            let (name, in_class) = (format!("{NOISE_OF}{state}"), own_name("noise of", state));
            all.push(Own { name, in_class, range, start, of: Subject::State(state.clone()) });
        }
    }
    let outputs = file.experiment.iter().filter(|_| !file.noise.is_empty());
    for (output, column) in outputs.flat_map(ExperimentEntry::all_outputs) {
        let Some(name) = deviation(output, &column) else { continue };
        if all.iter().all(|own| own.name != name) {
            let in_class = own_name("the", &name);
            let of = Subject::Output(output.clone());
            all.push(Own { name, in_class, range: None, start: None, of });
        }
    }
    Ok(all)
}

/// The name of the deviation of an output that is estimated: its own, or one that outputs share.
pub(super) fn deviation(output: &str, column: &ColumnEntry) -> Option<String> {
    match &column.sigma {
        None => Some(format!("sigma of {output}")),
        Some(SigmaEntry::Words(words)) if words == ESTIMATE => Some(format!("sigma of {output}")),
        Some(SigmaEntry::Words(words)) => {
            let name = words.strip_prefix(ESTIMATE)?.strip_prefix(' ')?;
            Some(format!("sigma {}", name.trim()))
        }
        Some(SigmaEntry::Number(_)) => None,
    }
}

/// The free parameters that noise adds, their ranges still open where the data give them.
///
/// # Errors
///
/// Entries that are no noise.
pub(super) fn free(file: &ProblemFile) -> Result<Vec<Free>, Diagnostic> {
    let one = |own: Own| {
        let range = own.range.unwrap_or(UNKNOWN_RANGE);
        let start = own.start.filter(|_| own.range.is_some());
        Free::new(own.name, String::new(), range, Some(true), start).at(place(file, &own.of))
    };
    own_parameters(file)?.into_iter().map(one).collect()
}

fn place(file: &ProblemFile, of: &Subject) -> Span {
    match of {
        Subject::State(state) => file.context.places.at(&["noise", state]),
        Subject::Output(output) => {
            let has_it = |entry: &&ExperimentEntry| entry.outputs.contains_key(output);
            let entry = file.experiment.iter().find(has_it);
            entry.map_or(Span::NONE, |own| own.places.at(&["outputs", output]))
        }
    }
}

/// The names of the parameters that noise adds and that the problem gives no start.
pub(super) fn invented(file: &ProblemFile) -> Vec<String> {
    let own = own_parameters(file).unwrap_or_default().into_iter();
    own.filter(|own| own.start.is_none()).map(|own| own.name).collect()
}

/// The names of the densities that are estimated.
pub(super) fn estimated(file: &ProblemFile) -> Vec<String> {
    let own = own_parameters(file).unwrap_or_default().into_iter();
    own.filter(|own| matches!(own.of, Subject::State(_))).map(|own| own.name).collect()
}

/// Gives the parameters that noise adds their units, and ranges where the problem gives none.
///
/// # Errors
///
/// Noise of a state that no data give a range for.
pub(super) fn set_ranges(
    file: &ProblemFile,
    (experiments, series): (&[Experiment], &[Series]),
    free: &mut [Free],
) -> Result<(), Diagnostic> {
    let Some(model) = experiments.first().map(|own| own.model.clone()) else { return Ok(()) };
    for own in own_parameters(file)? {
        let Some(at) = free.iter().position(|free| free.name == own.name) else { continue };
        let name = match &own.of {
            Subject::State(name) | Subject::Output(name) => name,
        };
        let unit = model.unit(name).unwrap_or_default();
        let unit_of = match (&own.of, unit.as_str()) {
            (Subject::Output(_), unit) => unit.to_owned(),
            (Subject::State(_), "") => "1/sqrt(s)".to_owned(),
            // A difference.
            (Subject::State(_), "degC") => "K/sqrt(s)".to_owned(),
            (Subject::State(_), unit) => format!("{unit}/sqrt(s)"),
        };
        let (range, start) = match own.range {
            Some(range) => (range, own.start),
            None => {
                let Some((size, interval)) = change(series, name, &unit) else {
                    let measured = like(series, name, &unit);
                    return Err(no_range(name, measured).at(place(file, &own.of)));
                };
                let root = if matches!(own.of, Subject::State(_)) { interval.sqrt() } else { 1.0 };
                // With less noise than the data move, predictions do not follow them, and a descent
                // begins where the likelihood is all but flat.
                (RANGE.map(|part| part * size / root), own.start.or(Some(size / root)))
            }
        };
        let made = Free::new(own.name, unit_of, range, Some(true), start);
        free[at] = made.at(place(file, &own.of))?;
    }
    Ok(())
}

fn no_range(state: &str, measured: Option<&Series>) -> Fault {
    let why = match measured {
        None => "no output has its unit".to_owned(),
        Some(own) => format!("`{}` has the same value in all rows", own.y_name),
    };
    fault!(BAD_OPTION, "the data give no range for the noise of `{state}`: {why}")
        .help("write one: `{ min = 1e-4, max = 1e-1 }`, the standard deviation that it adds in 1 s")
}

/// The measurements of a variable, or else of an output with its unit.
fn like<'s>(series: &'s [Series], name: &str, unit: &str) -> Option<&'s Series> {
    let own = series.iter().find(|own| own.y_name == name);
    own.or_else(|| series.iter().find(|own| own.y_unit == unit))
}

/// The root mean square of the changes of a variable from row to row, and the mean time between them;
/// where the variable is not measured, those of an output with its unit.
fn change(series: &[Series], name: &str, unit: &str) -> Option<(f64, f64)> {
    let own = like(series, name, unit)?;
    let squares = own.y.windows(2).map(|pair| elementary::powi(pair[1] - pair[0], 2));
    let count = squares.len().max(1) as f64;
    let size = (squares.sum::<f64>() / count).sqrt();
    let (first, last) = (own.x.first()?, own.x.last()?);
    let interval = (last - first) / count;
    (size > 0.0 && interval > 0.0).then_some((size, interval))
}

/// Declares what noise adds as parameters of the class around the model; their places among the free
/// parameters, and their names in the class.
///
/// # Errors
///
/// Entries that are no noise.
pub(super) fn declare(
    (file, entry): (&ProblemFile, &ExperimentEntry),
    free: &[Free],
    enclosing: &mut EnclosingClass,
) -> Result<Vec<(usize, String)>, Diagnostic> {
    let mut names = Vec::new();
    for own in own_parameters(file)? {
        let found = free.iter().position(|free| free.name == own.name);
        let is_here = match &own.of {
            Subject::State(_) => true,
            Subject::Output(_) => {
                let mut outputs = entry.all_outputs();
                outputs.any(|(name, column)| deviation(name, &column).as_ref() == Some(&own.name))
            }
        };
        let Some(place) = found.filter(|_| is_here) else { continue };
        let middle = free[place].value(0.5);
        // Writing into a String cannot fail.
        _ = writeln!(enclosing.declarations, "  parameter Real {} = {middle:e};", own.in_class);
        enclosing.elements.push((own.in_class.clone(), format!("the {}", own.name)));
        names.push((place, own.in_class));
    }
    Ok(names)
}

/// The noise of the states of an experiment.
///
/// # Errors
///
/// Entries that are no noise.
pub(super) fn of_states(
    file: &ProblemFile,
    (experiment, series): (&Experiment, &[Series]),
) -> Result<Vec<Noise>, Diagnostic> {
    let one = |(state, own): (&String, &NoiseEntry)| {
        let unit = experiment.model.unit(state).unwrap_or_default();
        let usual = change(series, state, &unit).map_or(1.0, |(size, time)| size / time.sqrt());
        let (density, scale) =
            match own.density(state).at(file.context.places.at(&["noise", state]))? {
                Density::Estimated { .. } if file.context.filtering == Filtering::WithoutNoise => {
                    ("0.0".to_owned(), 0.0)
                }
                Density::Fixed(value) => (format!("{value:e}"), value),
                Density::Estimated { range, .. } => {
                    let scale = range.map_or(usual, |[min, max]| (min * max).abs().sqrt());
                    (own_name("noise of", state), scale)
                }
            };
        Ok(Noise { state: state.clone(), density, scale, initial: own.initial() })
    };
    file.noise.iter().map(one).collect()
}
