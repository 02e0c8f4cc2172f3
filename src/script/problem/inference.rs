//! What a problem file asks beyond the estimates, checked against its models.

use super::file::{BandsEntry, DesignEntry, ProblemFile};
use crate::bail;
use crate::diag::{Fault, suggest};
use crate::fault;
use crate::identify::problem::Experiment;
use crate::identify::problem::inference::{DesignSettings, Inference, ModelPredictions};
use crate::registry::BAD_OPTION;

/// Points of a design unless the file says how many.
const POINTS: usize = 5;
/// More points than this are an experiment of its own, which `repeat` speaks of.
const MOST_POINTS: usize = 100;

/// What the file wants to know of these experiments.
///
/// # Errors
///
/// Variables that the models do not have, numbers that make no sense.
pub(super) fn inference(
    file: &ProblemFile,
    experiments: &[Experiment],
) -> Result<Inference, Fault> {
    let (bands, band_variables) = match &file.bands {
        None | Some(BandsEntry::Wanted(true)) => (true, Vec::new()),
        Some(BandsEntry::Wanted(false)) => (false, Vec::new()),
        Some(BandsEntry::Variables(names)) => (true, names.clone()),
    };
    band_variables.iter().try_for_each(|name| known("bands", name, experiments))?;
    let design = file.design.as_ref().map(|entry| design(entry, experiments)).transpose()?;
    let predict = ModelPredictions { experiments: experiments.to_vec() };
    Ok(Inference { predict: Some(Box::new(predict)), bands, band_variables, design })
}

/// The design that `--design` asks for where the file says nothing.
pub(super) fn usual_design() -> DesignSettings {
    DesignSettings { points: POINTS, range: None, outputs: Vec::new() }
}

fn design(entry: &DesignEntry, experiments: &[Experiment]) -> Result<DesignSettings, Fault> {
    let points = entry.points.unwrap_or(POINTS);
    if !(1..=MOST_POINTS).contains(&points) {
        bail!(BAD_OPTION, "`points` of `design` is {points}"; help: "write a number from 1 to {MOST_POINTS}");
    }
    if let Some([low, high]) =
        entry.range.filter(|[low, high]| !(low.is_finite() && low < high && high.is_finite()))
    {
        bail!(BAD_OPTION, "the `range` of `design` goes from {low} to {high}"; help: "write the smaller end first");
    }
    for (name, sigma) in &entry.outputs {
        known("design", name, experiments)?;
        if !(sigma.is_finite() && *sigma > 0.0) {
            bail!(BAD_OPTION, "the standard deviation of `{name}` in `design` is {sigma}"; help: "write a positive number");
        }
    }
    let outputs = entry.outputs.iter().map(|(name, sigma)| (name.clone(), *sigma)).collect();
    Ok(DesignSettings { points, range: entry.range, outputs })
}

fn known(key: &str, name: &str, experiments: &[Experiment]) -> Result<(), Fault> {
    let without = experiments.iter().find(|experiment| experiment.model.unit(name).is_none());
    match without {
        None => Ok(()),
        Some(experiment) => {
            let names = experiment.model.names();
            let hint = suggest::did_you_mean(name, names.iter().map(String::as_str));
            Err(fault!(
                BAD_OPTION,
                "`{key}` names `{name}`, which is not a Real variable of `{}`",
                experiment.model.name()
            )
            .help_if(hint))
        }
    }
}
