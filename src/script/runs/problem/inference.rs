//! What a problem file asks beyond the estimates, checked against its models.

use super::file::{
    BandsEntry, BootstrapEntry, DesignEntry, ExperimentEntry, PosteriorEntry, PriorEntry,
    PriorNumbers, ProblemFile,
};
use super::places::Places;
use crate::diag::{At as _, Diagnostic, Fault, suggest};
use crate::identify::problem::inference::{
    Adjustments, BootstrapSettings, Constraint, DesignSettings, Distribution, Inference,
    IntervalKind, ModelPredictions, PosteriorSettings, Prior, Resampling,
};
use crate::identify::problem::{Experiment, Free};
use crate::registry::BAD_OPTION;
use crate::source::Span;
use crate::{bail, fault};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// Points of a design unless the file says how many.
const POINTS: usize = 5;
/// More points than this are an experiment of its own, which `repeat` speaks of.
const MOST_POINTS: usize = 100;

/// What the file requests of these experiments; `cancel` ends their simulations when it is set.
///
/// # Errors
///
/// Variables that the models do not have, numbers that make no sense.
pub(super) fn inference(
    file: &ProblemFile,
    experiments: &[Experiment],
    cancel: Option<&Arc<AtomicBool>>,
) -> Result<Inference, Diagnostic> {
    let (bands, band_variables) = match &file.bands {
        None | Some(BandsEntry::Requested(true)) => (true, Vec::new()),
        Some(BandsEntry::Requested(false)) => (false, Vec::new()),
        Some(BandsEntry::Variables(names)) => (true, names.clone()),
    };
    for (number, name) in band_variables.iter().enumerate() {
        let place = file.places.at(&["bands", &number.to_string()]);
        known("bands", name, experiments).at(place)?;
    }
    let of = |name: &str| file.places.within(&[name]).cloned().unwrap_or_default();
    let design = file.design.as_ref();
    let design = design.map(|entry| self::design(entry, &of("design"), experiments)).transpose()?;
    let bootstrap = file.bootstrap.as_ref();
    let bootstrap = bootstrap.map(|entry| self::bootstrap(entry, &of("bootstrap"))).transpose()?;
    let posterior = file.posterior.as_ref();
    let posterior = posterior.map(|entry| self::posterior(entry, &of("posterior"))).transpose()?;
    let mut predict = ModelPredictions { experiments: experiments.to_vec() };
    for experiment in &mut predict.experiments {
        experiment.settings.cancel = cancel.cloned();
    }
    Ok(Inference {
        predict: Some(Box::new(predict)),
        bands,
        band_variables,
        design,
        bootstrap,
        posterior,
        ..Inference::default()
    })
}

/// Priors, constraints, and the series with log-normal errors.
///
/// # Errors
///
/// What cannot be read.
pub(super) fn adjustments(
    file: &ProblemFile,
    free: &[Free],
    logarithmic: Vec<usize>,
) -> Result<Adjustments, Diagnostic> {
    let mut priors = Vec::new();
    for (name, entry) in &file.parameters {
        let Some(prior) = &entry.prior else { continue };
        let place = file.places.at(&["parameters", name, "prior"]);
        let distribution = distribution(name, prior).at(place)?;
        let of_experiments = format!("{name}@");
        let own = |free: &Free| free.name == *name || free.name.starts_with(&of_experiments);
        let places: Vec<usize> =
            free.iter().enumerate().filter(|(_, free)| own(free)).map(|(k, _)| k).collect();
        if places.is_empty() {
            let fault = fault!(BAD_OPTION, "`{name}` has a prior but is not estimated");
            return Err(fault.help("add `min` and `max`").at(place));
        }
        priors.extend(places.into_iter().map(|parameter| Prior { parameter, distribution }));
    }
    let names: Vec<String> = free.iter().map(|free| free.name.clone()).collect();
    let constraints = file.constraints.iter().enumerate().map(|(number, text)| {
        let place = file.places.at(&["constraints", &number.to_string()]);
        super::constraint::constraint(text, &names).at(place)
    });
    let constraints = constraints.collect::<Result<Vec<Constraint>, Diagnostic>>()?;
    Ok(Adjustments { priors, constraints, logarithmic })
}

/// The outputs of an experiment with log-normal errors, by their numbers among its series, and where that
/// is written.
///
/// # Errors
///
/// Other kinds of errors.
pub(super) fn logarithmic(entry: &ExperimentEntry) -> Result<Vec<(usize, Span)>, Diagnostic> {
    let mut logarithmic = Vec::new();
    for (number, (name, output)) in entry.all_outputs().enumerate() {
        let place = entry.places.at(&["outputs", name, "error"]);
        match output.error.as_deref() {
            None | Some("normal") => {}
            Some("lognormal") => logarithmic.push((number, place)),
            Some(other) => {
                let fault = fault!(BAD_OPTION, "the `error` of `{name}` is `{other}`");
                return Err(fault.help("write \"normal\" or \"lognormal\"").at(place));
            }
        }
    }
    Ok(logarithmic)
}

fn distribution(name: &str, entry: &PriorEntry) -> Result<Distribution, Fault> {
    match entry {
        PriorEntry::Name(kind) if kind == "uniform" => Ok(Distribution::Uniform),
        PriorEntry::Numbers(PriorNumbers {
            mean: Some(mean),
            sd: Some(sd),
            median: None,
            factor: None,
        }) => Ok(Distribution::Normal { mean: *mean, sd: *sd }),
        PriorEntry::Numbers(PriorNumbers {
            mean: None,
            sd: None,
            median: Some(median),
            factor: Some(factor),
        }) => Ok(Distribution::LogNormal { median: *median, factor: *factor }),
        _ => {
            bail!(BAD_OPTION, "the prior of `{name}` cannot be read"; help: "write `{{ mean = 1, sd = 0.1 }}`, `{{ median = 1, factor = 1.5 }}` for a log-normal one, or \"uniform\"")
        }
    }
}

/// Replicates of a bootstrap unless the file says how many: the ends of 95 % intervals are then
/// those of the 25th replicate from either side.
const REPLICATES: usize = 1000;
/// Draws of each chain at most, unless the file says otherwise.
const DRAWS: usize = 8000;

/// The bootstrap that `--bootstrap` asks for where the file says nothing.
pub(super) fn usual_bootstrap() -> BootstrapSettings {
    BootstrapSettings {
        samples: REPLICATES,
        resampling: Resampling::Residuals,
        interval: IntervalKind::Bca,
    }
}

/// The posterior that `--posterior` asks for where the file says nothing.
pub(super) fn usual_posterior() -> PosteriorSettings {
    PosteriorSettings { samples: DRAWS }
}

fn bootstrap(entry: &BootstrapEntry, places: &Places) -> Result<BootstrapSettings, Diagnostic> {
    let wrong = |entry: &str, fault: Fault| Err(fault.at(places.at(&[entry])));
    let usual = usual_bootstrap();
    let samples = entry.samples.unwrap_or(usual.samples);
    if !(100..=1_000_000).contains(&samples) {
        let fault = fault!(BAD_OPTION, "`samples` of `bootstrap` is {samples}"; help: "write a number from 100 to 1000000; 95 % intervals need about 1000");
        return wrong("samples", fault);
    }
    let resampling = match entry.resampling.as_deref() {
        None | Some("residuals") => Resampling::Residuals,
        Some("parametric") => Resampling::Parametric,
        Some("cases") => Resampling::Cases,
        Some(other) => {
            let fault = fault!(BAD_OPTION, "the `resampling` of `bootstrap` is `{other}`"; help: "write \"residuals\", \"parametric\" or \"cases\"");
            return wrong("resampling", fault);
        }
    };
    let interval = match entry.interval.as_deref() {
        None | Some("bca") => IntervalKind::Bca,
        Some("percentile") => IntervalKind::Percentile,
        Some("basic") => IntervalKind::Basic,
        Some(other) => {
            let fault = fault!(BAD_OPTION, "the `interval` of `bootstrap` is `{other}`"; help: "write \"bca\", \"percentile\" or \"basic\"");
            return wrong("interval", fault);
        }
    };
    Ok(BootstrapSettings { samples, resampling, interval })
}

fn posterior(entry: &PosteriorEntry, places: &Places) -> Result<PosteriorSettings, Diagnostic> {
    let samples = entry.samples.unwrap_or(DRAWS);
    if !(100..=10_000_000).contains(&samples) {
        let fault = fault!(BAD_OPTION, "`samples` of `posterior` is {samples}"; help: "write a number from 100 to 10000000");
        return Err(fault.at(places.at(&["samples"])));
    }
    Ok(PosteriorSettings { samples })
}

/// The design that `--design` asks for where the file says nothing.
pub(super) fn usual_design() -> DesignSettings {
    DesignSettings { points: POINTS, range: None, outputs: Vec::new() }
}

fn design(
    entry: &DesignEntry,
    places: &Places,
    experiments: &[Experiment],
) -> Result<DesignSettings, Diagnostic> {
    let points = entry.points.unwrap_or(POINTS);
    if !(1..=MOST_POINTS).contains(&points) {
        let fault = fault!(BAD_OPTION, "`points` of `design` is {points}"; help: "write a number from 1 to {MOST_POINTS}");
        return Err(fault.at(places.at(&["points"])));
    }
    if let Some([low, high]) =
        entry.range.filter(|[low, high]| !(low.is_finite() && low < high && high.is_finite()))
    {
        let fault = fault!(BAD_OPTION, "the `range` of `design` goes from {low} to {high}");
        return Err(fault.help("write the lower limit first").at(places.at(&["range"])));
    }
    for (name, sigma) in &entry.outputs {
        let place = places.at(&["outputs", name]);
        known("design", name, experiments).at(place)?;
        if !(sigma.is_finite() && *sigma > 0.0) {
            let fault = fault!(BAD_OPTION, "the standard deviation of `{name}` in `design` is {sigma}"; help: "write a positive number");
            return Err(fault.at(place));
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
