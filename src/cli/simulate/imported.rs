//! The simulation of a functional mock-up unit.

use super::{SimulateArgs, check_filter, filter, options, outcome, with_progress};
use crate::diag::{Diagnostic, Fault};
use crate::fault;
use crate::options::Global;
use crate::registry::BAD_OPTION;
use crate::script::Session;
use crate::script::models::imported::{self, Given};
use crate::script::models::parameter_sets;
use crate::script::models::simulation::{self, SimulationOptions};
use crate::script::runs::problem;
use crate::source::Span;
use crate::{plot, results};
use gapilib_fmi::archive::is_unit;
use std::path::{Path, PathBuf};

/// The unit among the files, if it is the only one.
pub(super) fn unit_of(files: &[PathBuf]) -> Option<&Path> {
    match files {
        [only] if is_unit(only) => Some(only),
        _ => None,
    }
}

/// Simulates and writes the trajectories, or shows the last values.
pub(super) fn run(
    session: &mut Session,
    path: &Path,
    arguments: &SimulateArgs,
    global: &Global,
) -> Result<(), Vec<Diagnostic>> {
    let one = |fault: Fault| vec![fault.at(Span::NONE)];
    refuse(arguments).map_err(one)?;
    let format = match &arguments.output {
        Some(path) => Some(results::format_of_file(&path.to_string_lossy()).map_err(one)?),
        None => None,
    };
    let picture = arguments.figure.as_deref().map(plot::Picture::of).transpose().map_err(one)?;
    let only = arguments.variable_filter.as_deref().map(filter).transpose().map_err(one)?;
    let mut options = SimulationOptions { only, ..options(arguments) };
    let unit = imported::import(session, path, options.method.as_deref()).map_err(one)?;
    let mut given = Given::default();
    if let Some(path) = &arguments.set_file {
        parameter_sets::give(session, path, (&unit, &mut given)).map_err(one)?;
    }
    for (name, value) in &arguments.set {
        given.add(&unit, name, value).map_err(one)?;
    }
    let inputs = arguments.input.as_deref();
    let interpolation = arguments.interpolation.as_deref();
    let inputs = inputs.map(|path| problem::inputs_of(session, &unit, (path, interpolation)));
    let inputs = inputs.transpose();
    let inputs = inputs.map_err(|error| vec![error])?;
    if let Some(inputs) = &inputs
        && unit.description.experiment.stop.is_none()
    {
        options.stop.get_or_insert(inputs.span.1);
    }
    let annotated = unit.description.experiment.annotation();
    let plain = SimulationOptions { method: None, ..options.clone() };
    let settings = simulation::settings(&annotated, &plain).map_err(one)?;
    let span = (settings.start, settings.stop);
    if let Some(inputs) = &inputs {
        problem::note_outside(session, inputs.span, span);
    }
    let samples = inputs.map(|inputs| inputs.samples).unwrap_or_default();
    let model = imported::model(&unit, given, samples).map_err(one)?;
    let names = model.layout().scalars().iter().map(|scalar| scalar.name.as_str());
    check_filter(arguments, &options, names).map_err(one)?;
    let simulated = with_progress(span, options, global, |options| {
        imported::simulate(session, &model, &options)
    });
    outcome(session, &unit.file, (arguments, picture, format), simulated)
}

/// Refuses what needs the equations of a model.
fn refuse(arguments: &SimulateArgs) -> Result<(), Fault> {
    let SimulateArgs { model, from, dump, no_sliding, .. } = arguments;
    let given = [
        ("--model", model.is_some()),
        ("--from", from.is_some()),
        ("--dump", dump.is_some()),
        ("--no-sliding", *no_sliding),
    ];
    match given.iter().find(|(_, is_given)| *is_given) {
        None => Ok(()),
        Some((option, _)) => Err(fault!(BAD_OPTION, "`{option}` has no meaning for an FMU")
            .help(format!("leave out `{option}`"))),
    }
}
