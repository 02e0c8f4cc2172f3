//! Experiments that measure a spectrum: the response of an output to small oscillations of an input at
//! an operating point.

use super::data::Notes;
use super::experiment::{Built, Class, Source, Subject};
use super::file::{Column, ExperimentEntry, SpectrumEntry};
use super::{frequency_axis, parameters};
use crate::Session;
use crate::diag::{Diagnostic, Fault};
use crate::elementary;
use crate::frequency::Number;
use crate::identify::problem::{Observation, Series, Sigma};
use crate::identify::{CompiledModel, PARTS, Spectrum, SpectrumModel, significant};
use crate::kramers_kronig;
use crate::mat::MatFile;
use crate::models::simulation::Translated;
use crate::models::spectrum;
use crate::registry::BAD_OPTION;
use crate::{bail, fault, units};
use std::f64::consts::TAU;
use std::sync::Arc;

const MAGNITUDE: &str = "magnitude";
const PHASE: &str = "phase";

/// What each point counts.
#[derive(Clone, Copy, PartialEq)]
enum Weighting {
    /// The same.
    Unit,
    /// By the measured magnitude: errors are proportional to it.
    Modulus,
    /// By the measured value of each part itself.
    Proportional,
}

/// Reads the experiment.
///
/// # Errors
///
/// What is wrong with its data, its class or its settings.
pub(super) fn build(
    source: &Source<'_>,
    entry: &SpectrumEntry,
    session: &mut Session,
    notes: &mut Notes,
) -> Result<Built, Vec<Diagnostic>> {
    let places = &source.entry.places;
    let place = places.at(&["spectrum"]);
    let there = |fault: Fault, way: &[&str]| vec![fault.at(places.at(way))];
    let weighting =
        weighting(source.entry, entry).map_err(|fault| there(fault, &["spectrum", "weighting"]))?;
    if !source.entry.inputs.is_empty() {
        return Err(there(no_inputs(), &["inputs"]));
    }
    let (prepared, read) =
        prepared(source.entry, source.table).map_err(|fault| there(fault, &["outputs"]))?;
    let source = Source { entry: &prepared, ..*source };
    let abscissa = source.abscissa(notes).map_err(|fault| there(fault, &["x"]))?;
    let class = source.class(session, &abscissa, notes)?;
    let names = [entry.input.as_str(), entry.output.as_str()];
    let (translated, linear) = spectrum::linearized(session, &class.name, names, place)?;
    check(session, (&source, &class), &translated, notes)?;
    let program = translated.program.clone();
    let annotated = program.experiment();
    let start = source.entry.start_time.or(annotated.start_time).unwrap_or(0.0);
    let at = entry.at.unwrap_or(start);
    if !(at.is_finite() && at >= start) {
        return Err(there(too_early(at, start), &["spectrum", "at"]));
    }
    let model = CompiledModel::new(&source.file.model, program.clone());
    let unit = unit_of_ratio(&model, names);
    let factor = entry.factor.unwrap_or(1.0);
    if !(factor.is_finite() && factor != 0.0) {
        return Err(there(no_factor(factor), &["spectrum", "factor"]));
    }
    let spectrum = Spectrum { linear, times: [start, at], factor, unit };
    let subject = Subject {
        model: Arc::new(SpectrumModel::new(model, spectrum)),
        annotated: crate::flatten::Experiment { start_time: None, stop_time: None, ..annotated },
        stop: None,
        parameters: class.parameters,
    };
    let (mut experiment, mut series) =
        source.compare(session, subject, (&abscissa, &class.observed), notes)?;
    experiment.settings.start = 0.0;
    omit_constant(&mut experiment.observations, &mut series, notes)
        .map_err(|fault| there(fault, &["x"]))?;
    read.finish(&mut series, notes).map_err(|fault| there(fault, &["outputs"]))?;
    for (observation, series) in experiment.observations.iter_mut().zip(&series) {
        observation.y_name.clone_from(&series.y_name);
    }
    if weighting == Weighting::Modulus {
        keep_complete(&mut experiment.observations, &mut series, notes)
            .map_err(|fault| there(fault, &["outputs"]))?;
    }
    test_kramers_kronig(&series, notes);
    weigh(&mut series, weighting).map_err(|fault| there(fault, &["outputs"]))?;
    let error = if at > start { experiment.settings.tolerance } else { 0.0 };
    Ok(Built::plain((experiment, series), error, Some(program)))
}

/// Refuses parameters and initial values that the model does not have.
fn check(
    session: &mut Session,
    (source, class): (&Source<'_>, &Class),
    translated: &Translated,
    notes: &mut Notes,
) -> Result<(), Vec<Diagnostic>> {
    parameters::note_computed(&class.parameters, translated, notes);
    let (file, entry) = (source.file, source.entry);
    parameters::check_free(session, file, &class.parameters, translated)?;
    parameters::check_taken(file, entry, translated).map_err(|error| vec![error])?;
    parameters::check_initial(session, file, entry, translated)
}

fn too_early(at: f64, start: f64) -> Fault {
    fault!(BAD_OPTION, "the operating point is at {at} s, but the simulation begins at {start} s")
        .help("write a later `at`")
}

fn no_factor(factor: f64) -> Fault {
    fault!(BAD_OPTION, "the `factor` of a spectrum is {factor}").help("write a number other than 0")
}

fn no_inputs() -> Fault {
    fault!(
        BAD_OPTION,
        "the inputs of a spectrum have constant values at the operating point, none from columns"
    )
    .help("write them in `set`")
}

/// The unit of y/u.
fn unit_of_ratio(model: &CompiledModel, [input, output]: [&str; 2]) -> String {
    use crate::identify::Model as _;
    let [u, y] = [input, output].map(|name| model.unit(name).unwrap_or_default());
    let ratio = match (y.as_str(), u.as_str()) {
        (y, "") => y.to_owned(),
        (y, u) if y == u => "1".to_owned(),
        ("V", "A") => "Ohm".to_owned(),
        ("V", u) if u.starts_with("A/") && !u[2..].contains(['.', '/', '(']) => {
            format!("Ohm.{}", &u[2..])
        }
        ("", u) => format!("1/({u})"),
        (y, u) if u.contains(['.', '/']) => format!("{y}/({u})"),
        (y, u) => format!("{y}/{u}"),
    };
    match units::unit(&ratio) {
        Some(_) => ratio,
        None => String::new(),
    }
}

fn weighting(entry: &ExperimentEntry, own: &SpectrumEntry) -> Result<Weighting, Fault> {
    let has_sigma = entry.outputs.values().any(|column| column.entry().sigma.is_some());
    let has = |name: &str| entry.outputs.contains_key(name);
    let has_magnitude = has(MAGNITUDE) || has(PARTS[0]) && has(PARTS[1]);
    match own.weighting.as_deref() {
        Some(_) if has_sigma => {
            bail!(BAD_OPTION, "a spectrum has either `weighting` or `sigma`"; help: "remove one of them")
        }
        None if has_sigma || !has_magnitude => Ok(Weighting::Unit),
        Some("modulus") if !has_magnitude => {
            bail!(BAD_OPTION, "the magnitude of one part alone is not known"; help: "add the other part, or write `weighting = \"unit\"`")
        }
        None | Some("modulus") => Ok(Weighting::Modulus),
        Some("unit") => Ok(Weighting::Unit),
        Some("proportional") => Ok(Weighting::Proportional),
        Some(other) => {
            bail!(BAD_OPTION, "the weighting `{other}` is not known"; help: "write \"modulus\", \"unit\" or \"proportional\"")
        }
    }
}

/// Whether errors at another operating point are in proportion to the magnitude there; else they are the
/// same.
///
/// # Errors
/// Errors in proportion to each part, which may vanish there.
pub(super) fn is_by_modulus(entry: &ExperimentEntry, own: &SpectrumEntry) -> Result<bool, Fault> {
    match weighting(entry, own)? {
        Weighting::Unit => Ok(false),
        Weighting::Modulus => Ok(true),
        Weighting::Proportional => bail!(
            BAD_OPTION,
            "`operating_points` with proportional errors are not supported: a part may vanish there";
            help: "write `weighting = \"modulus\"`"
        ),
    }
}

/// How the columns become parts of the spectrum.
struct Read {
    /// Whether they are magnitude and phase.
    is_polar: bool,
    is_in_decibels: bool,
    /// The column of the imaginary part or the phase is that of its negative.
    is_negative: bool,
}

/// The experiment as any other: its columns with the factors that they need.
fn prepared(entry: &ExperimentEntry, table: &MatFile) -> Result<(ExperimentEntry, Read), Fault> {
    let is_polar = is_polar(entry)?;
    let mut prepared = entry.clone();
    prepared.x = Some(Column::More(Box::new(frequency_axis::column(entry, table)?)));
    let is_in = |name: &str, unit: &str| {
        unit_of(entry, table, name).is_some_and(|own| own.eq_ignore_ascii_case(unit))
    };
    let is_in_decibels = is_in(MAGNITUDE, "dB");
    for (name, column) in &mut prepared.outputs {
        let factor = match name.as_str() {
            MAGNITUDE if is_in_decibels => 1.0,
            PHASE if is_in(PHASE, "rad") => 1.0,
            PHASE => TAU / 360.0,
            _ => continue,
        };
        column.change(|own| (own.factor, own.unit) = (Some(own.factor.unwrap_or(factor)), None));
    }
    let is_negative = |name: &str| {
        entry.outputs.get(name).map(Column::entry).is_some_and(|own| {
            let column = own.column.as_deref().unwrap_or_default();
            // A factor with a sign says itself what the numbers are.
            own.factor.is_none_or(|factor| factor > 0.0)
                && column.trim_start().starts_with(['-', '\u{2212}'])
        })
    };
    let is_negative = is_negative(PARTS[1]) || is_negative(PHASE);
    Ok((prepared, Read { is_polar, is_in_decibels, is_negative }))
}

/// Whether the outputs are magnitude and phase.
fn is_polar(entry: &ExperimentEntry) -> Result<bool, Fault> {
    let names: Vec<&str> = entry.outputs.keys().map(String::as_str).collect();
    match names.as_slice() {
        [MAGNITUDE, PHASE] | [PHASE, MAGNITUDE] => {
            if entry.outputs.values().any(|column| column.entry().sigma.is_some()) {
                bail!(BAD_OPTION, "magnitude and phase are compared as real and imaginary part, which have no `sigma` then"; help: "use `weighting`")
            }
            Ok(true)
        }
        [PHASE] => {
            bail!(BAD_OPTION, "a phase alone cannot be compared: it is the same after a whole turn"; help: "add the `magnitude`")
        }
        names if !names.is_empty() && names.iter().all(|name| PARTS.contains(name)) => Ok(false),
        _ => {
            bail!(BAD_OPTION, "the outputs of a spectrum are {}", quoted(&names); help: "write `outputs = {{ real = \"…\", imaginary = \"…\" }}`, or `magnitude` and `phase`")
        }
    }
}

/// The unit of an output: what the entry says, else what the file writes.
fn unit_of(entry: &ExperimentEntry, table: &MatFile, name: &str) -> Option<String> {
    let own = entry.outputs.get(name)?.entry();
    let of_column = || {
        let about = table.column(own.column.as_deref().unwrap_or(name)).ok()?.about;
        about.unit.or(about.unknown_unit)
    };
    own.unit.clone().or_else(of_column)
}

fn quoted(names: &[&str]) -> String {
    names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ")
}

/// Leaves out points without a frequency, which instruments write before a measurement.
fn omit_constant(
    observations: &mut [Observation],
    series: &mut [Series],
    notes: &mut Notes,
) -> Result<(), Fault> {
    for (observation, own) in observations.iter_mut().zip(series) {
        let keeps: Vec<bool> = own.x.iter().map(|x| *x > 0.0).collect();
        if let Some(rows) = retain(&keeps, observation, own)? {
            let why = "without a positive frequency";
            notes.add(format!("{}: {rows} left out, {why}", own.experiment));
        }
    }
    Ok(())
}

/// Leaves out points of which only one part was measured: their magnitude is not known.
fn keep_complete(
    observations: &mut [Observation],
    series: &mut [Series],
    notes: &mut Notes,
) -> Result<(), Fault> {
    let rows: Vec<Vec<usize>> = series.iter().map(|own| own.rows.clone()).collect();
    for (observation, own) in observations.iter_mut().zip(series) {
        let is_complete = |row: &usize| rows.iter().all(|other| other.contains(row));
        let keeps: Vec<bool> = own.rows.iter().map(is_complete).collect();
        if let Some(rows) = retain(&keeps, observation, own)? {
            notes.warn(format!(
                "{}: {rows} left out of `{}`, in which the other part is missing: the magnitude that \
                 weights them is not known (`weighting = \"unit\"` uses them)",
                own.experiment, own.y_name
            ));
        }
    }
    Ok(())
}

/// Keeps some points; how many rows are gone, in words, `None` where all are kept.
fn retain(
    keeps: &[bool],
    observation: &mut Observation,
    own: &mut Series,
) -> Result<Option<String>, Fault> {
    let omitted = keeps.iter().filter(|keeps| !**keeps).count();
    if omitted == 0 {
        return Ok(None);
    }
    if omitted == keeps.len() {
        bail!(BAD_OPTION, "no row of {} is left to compare", own.file; help: "check the columns of frequencies and of both parts")
    }
    let kept = |values: &[f64]| -> Vec<f64> {
        values.iter().zip(keeps).filter(|(_, keeps)| **keeps).map(|(value, _)| *value).collect()
    };
    (own.x, own.y) = (kept(&own.x), kept(&own.y));
    let rows = own.rows.iter().zip(keeps).filter(|(_, keeps)| **keeps);
    own.rows = rows.map(|(row, _)| *row).collect();
    if let Sigma::Given(sigma) = &mut own.sigma {
        *sigma = kept(sigma);
    }
    observation.x.clone_from(&own.x);
    Ok(Some(if omitted == 1 { "1 row is".to_owned() } else { format!("{omitted} rows are") }))
}

impl Read {
    /// Makes real and imaginary parts of what was read.
    fn finish(&self, series: &mut [Series], notes: &mut Notes) -> Result<(), Fault> {
        for own in series.iter_mut() {
            if self.is_negative && [PARTS[1], PHASE].contains(&own.y_name.as_str()) {
                own.y.iter_mut().for_each(|y| *y = -*y);
                let part = if own.y_name == PHASE { "phase" } else { "imaginary part" };
                notes.add(format!(
                    "{}: `{}` holds the negative of the {part}, by its name",
                    own.experiment, own.column
                ));
            }
            if self.is_in_decibels && own.y_name == MAGNITUDE {
                own.y.iter_mut().for_each(|y| *y = elementary::powf(10.0, *y / 20.0));
            }
        }
        if !self.is_polar {
            return Ok(());
        }
        let [one, other] = series else {
            bail!(BAD_OPTION, "magnitude and phase have one column each");
        };
        let (magnitude, phase) = if one.y_name == MAGNITUDE { (one, other) } else { (other, one) };
        if magnitude.rows != phase.rows {
            bail!(BAD_OPTION, "magnitude and phase are missing in different rows"; help: "leave both cells of a row empty, or none")
        }
        for (magnitude, phase) in magnitude.y.iter_mut().zip(&mut phase.y) {
            let (size, angle) = (*magnitude, *phase);
            *magnitude = size * elementary::cos(angle);
            *phase = size * elementary::sin(angle);
        }
        magnitude.y_name = PARTS[0].to_owned();
        phase.y_name = PARTS[1].to_owned();
        phase.y_unit.clone_from(&magnitude.y_unit);
        Ok(())
    }
}

/// Says whether the data can be those of a linear, stationary system.
fn test_kramers_kronig(series: &[Series], notes: &mut Notes) {
    let part = |name: &str| series.iter().find(|own| own.y_name == name);
    let (Some(real), Some(imaginary)) = (part(PARTS[0]), part(PARTS[1])) else { return };
    if real.rows != imaginary.rows {
        return;
    }
    let pairs = real.y.iter().zip(&imaginary.y);
    let values: Vec<Number> = pairs.map(|(re, im)| Number::new(*re, *im)).collect();
    let Some(found) = kramers_kronig::test(&real.x, &values) else { return };
    let percent = |share: f64| significant(100.0 * share, 2);
    let (experiment, residual) = (&real.experiment, percent(found.residual));
    match found.is_violated {
        true => notes.warn(format!(
            "{experiment}: the spectrum is not that of a linear, stationary system (Kramers-Kronig \
             test): such systems come within {residual} % of it and leave a pattern, at most {} % at \
             {} Hz; something drifted, or the amplitude was too large, or a column has the wrong sign",
            percent(found.largest.1),
            significant(found.largest.0, 3)
        )),
        false => notes.add(format!(
            "{experiment}: the spectrum can be that of a linear, stationary system (Kramers-Kronig \
             test): what is left is {residual} % of the magnitude, without a pattern"
        )),
    }
}

/// Gives the points their weights.
///
/// # Errors
///
/// Values of 0, whose weights would be infinite.
fn weigh(series: &mut [Series], weighting: Weighting) -> Result<(), Fault> {
    if weighting == Weighting::Unit {
        return Ok(());
    }
    let all: Vec<(Vec<usize>, Vec<f64>)> =
        series.iter().map(|own| (own.rows.clone(), own.y.clone())).collect();
    for own in series.iter_mut() {
        let size = |(row, y): (&usize, &f64)| match weighting {
            Weighting::Proportional => y.abs(),
            _ => {
                let of = |(rows, y): &(Vec<usize>, Vec<f64>)| {
                    rows.iter().position(|other| other == row).map_or(0.0, |at| y[at] * y[at])
                };
                all.iter().map(of).sum::<f64>().sqrt()
            }
        };
        own.relative = own.rows.iter().zip(&own.y).map(size).collect();
        if let Some(at) = own.relative.iter().position(|size| *size == 0.0) {
            bail!(BAD_OPTION, "in row {} of {}, the value that weights `{}` is 0", own.rows[at], own.file, own.y_name; help: "leave the cell empty to omit the point, or write `weighting = \"unit\"`")
        }
    }
    Ok(())
}
