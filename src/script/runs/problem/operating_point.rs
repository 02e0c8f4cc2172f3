//! Operating points at which spectra could be measured, for the design of the next measurement.

use super::data::Notes;
use super::experiment::Source;
use super::file::{ExperimentEntry, OperatingPointEntry, ProblemFile, ValueEntry};
use super::places::Places;
use super::spectrum;
use crate::Session;
use crate::diag::Diagnostic;
use crate::fault;
use crate::identify::problem::Experiment;
use crate::identify::problem::inference::Proposed;
use crate::registry::BAD_OPTION;

/// Refuses operating points where no spectrum was measured.
///
/// # Errors
///
/// That there is none.
pub(super) fn check(file: &ProblemFile) -> Result<(), Diagnostic> {
    let asks = file.design.as_ref().is_some_and(|design| !design.operating_points.is_empty());
    let has_spectra = file.experiment.iter().any(|own| own.spectrum.is_some() && !own.validation);
    if !asks || has_spectra {
        return Ok(());
    }
    let place = file.context.places.at(&["design", "operating_points"]);
    Err(fault!(BAD_OPTION, "operating points are those of spectra, and none was measured")
        .help("remove them, or add an experiment with `spectrum`")
        .at(place))
}

/// The spectrum of this experiment, of which the first series has this number, at all operating points of
/// the design.
///
/// # Errors
///
/// An operating point that is that of the experiment, parameters that the model does not have.
pub(super) fn spectra(
    source: &Source<'_>,
    session: &mut Session,
    first: usize,
) -> Result<Vec<Proposed>, Vec<Diagnostic>> {
    let points = source.file.design.iter().flat_map(|design| &design.operating_points).enumerate();
    let mut one = |(number, point): (usize, &OperatingPointEntry)| {
        let way = ["design", "operating_points", &number.to_string()];
        let places = source.file.context.places.within(&way).cloned().unwrap_or_default();
        let entry = changed(source.entry, point, &places).map_err(|error| vec![error])?;
        let label = format!("{}, {}", source.label, described(point));
        let own = Source { entry: &entry, label: &label, ..*source };
        let Some(spectrum) = &entry.spectrum else { return Ok(None) };
        // What there is to be said of the data was said of the experiment.
        let built = spectrum::build(&own, spectrum, session, &mut Notes::default())?;
        let experiment = Experiment { name: label.clone(), ..built.experiment };
        let is_proportional = spectrum::is_by_modulus(&entry, spectrum)
            .map_err(|fault| vec![fault.at(places.at(&[]))])?;
        Ok(Some(Proposed { experiment, first, is_proportional }))
    };
    points.filter_map(|own| one(own).transpose()).collect()
}

/// The entry of the experiment at another operating point.
fn changed(
    entry: &ExperimentEntry,
    point: &OperatingPointEntry,
    places: &Places,
) -> Result<ExperimentEntry, Diagnostic> {
    if point.at.is_none() && point.set.is_empty() {
        let fault = fault!(BAD_OPTION, "the operating point has neither `at` nor `set`");
        return Err(fault
            .help("write `{ at = 30 }` or `{ set = { I = 0.4 } }`")
            .at(places.at(&[])));
    }
    let mut own = ExperimentEntry { places: places.clone(), ..entry.clone() };
    if let Some(spectrum) = &mut own.spectrum {
        spectrum.at = point.at.or(spectrum.at);
    }
    own.set.values.extend(point.set.iter().map(|(name, value)| (name.clone(), value.clone())));
    Ok(own)
}

/// What is different at the operating point.
fn described(point: &OperatingPointEntry) -> String {
    let at = point.at.map(|at| format!("at {at} s"));
    let set = point.set.iter().map(|(name, value)| match value {
        ValueEntry::Number(value) => format!("{name} = {value}"),
        ValueEntry::Truth(value) => format!("{name} = {value}"),
        ValueEntry::Text(value) => format!("{name} = {value}"),
    });
    at.into_iter().chain(set).collect::<Vec<_>>().join(", ")
}
