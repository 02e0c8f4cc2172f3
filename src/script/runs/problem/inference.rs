//! What a problem file asks beyond the estimates, checked against its models.

use super::file::{
    BandsEntry, BootstrapEntry, ColumnEntry, DesignEntry, ExperimentEntry, PosteriorEntry,
    PriorEntry, PriorNumbers, ProblemFile,
};
use super::places::Places;
use crate::diag::{At as _, Diagnostic, Fault, suggest};
use crate::identify::fitness::Law;
use crate::identify::problem::inference::{
    Adjustments, BootstrapSettings, Constraint, DesignSettings, Distribution, Inference,
    IntervalKind, ModelPredictions, PosteriorSettings, Prior, Resampling,
};
use crate::identify::problem::{Experiment, Free, Series, Sigma};
use crate::registry::BAD_OPTION;
use crate::source::Span;
use crate::{bail, elementary, fault};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// Points of a design unless the file says how many.
const POINTS: usize = 5;
/// More points than this are an experiment of its own, which `repeat` speaks of.
const MOST_POINTS: usize = 100;

/// What the file requests of the experiments of these models; `cancel` ends their simulations when it is set.
///
/// # Errors
///
/// Variables that the models do not have, numbers that make no sense.
pub(super) fn inference(
    file: &ProblemFile,
    mut models: ModelPredictions,
    cancel: Option<&Arc<AtomicBool>>,
) -> Result<Inference, Diagnostic> {
    let experiments = &models.experiments;
    let (bands, band_variables) = match &file.bands {
        None | Some(BandsEntry::Requested(true)) => (true, Vec::new()),
        Some(BandsEntry::Requested(false)) => (false, Vec::new()),
        Some(BandsEntry::Variables(names)) => (true, names.clone()),
    };
    for (number, name) in band_variables.iter().enumerate() {
        let place = file.context.places.at(&["bands", &number.to_string()]);
        known("bands", name, experiments).at(place)?;
    }
    let of = |name: &str| file.context.places.within(&[name]).cloned().unwrap_or_default();
    let design = file.design.as_ref();
    let design = design.map(|entry| self::design(entry, &of("design"), experiments)).transpose()?;
    let bootstrap = file.bootstrap.as_ref();
    let bootstrap = bootstrap.map(|entry| self::bootstrap(entry, &of("bootstrap"))).transpose()?;
    let posterior = file.posterior.as_ref();
    let posterior = posterior.map(|entry| self::posterior(entry, &of("posterior"))).transpose()?;
    let proposed = models.proposed.iter_mut().map(|own| &mut own.experiment);
    for experiment in models.experiments.iter_mut().chain(proposed) {
        experiment.settings.cancel = cancel.cloned();
    }
    Ok(Inference {
        predict: Some(Box::new(models)),
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
        let place = file.context.places.at(&["parameters", name, "prior"]);
        let of_experiments = format!("{name}@");
        let own = |free: &Free| free.name == *name || free.name.starts_with(&of_experiments);
        let places: Vec<usize> =
            free.iter().enumerate().filter(|(_, free)| own(free)).map(|(k, _)| k).collect();
        if places.is_empty() {
            let fault = fault!(BAD_OPTION, "`{name}` has a prior but is not estimated");
            return Err(fault.help("add `min` and `max`").at(place));
        }
        for parameter in places {
            let range = [free[parameter].min, free[parameter].max];
            let (distribution, constant) = distribution(name, prior, range).at(place)?;
            priors.push(Prior { parameter, distribution, constant });
        }
    }
    let names: Vec<String> = free.iter().map(|free| free.name.clone()).collect();
    let constraints = file.constraints.iter().enumerate().map(|(number, text)| {
        let place = file.context.places.at(&["constraints", &number.to_string()]);
        super::constraint::constraint(text, &names).at(place)
    });
    let constraints = constraints.collect::<Result<Vec<Constraint>, Diagnostic>>()?;
    Ok(Adjustments { priors, constraints, logarithmic })
}

/// How the errors of an output are distributed.
pub(super) struct ErrorLaw {
    pub law: Law,
    /// Whether it is the logarithm whose errors these are.
    pub is_logarithmic: bool,
    /// Where that is written.
    pub place: Span,
}

/// Degrees of freedom of the distribution of Student unless the file says otherwise.
const FREEDOM: f64 = 4.0;

/// How the errors of the outputs of an experiment are distributed.
///
/// # Errors
///
/// Other distributions, and what they do not have.
pub(super) fn error_laws(entry: &ExperimentEntry) -> Result<Vec<ErrorLaw>, Diagnostic> {
    let one = |(name, output): (&String, ColumnEntry)| {
        let at = |key: &str| entry.places.at(&["outputs", name, key]);
        let place = at("error");
        let (law, is_logarithmic) = match output.error.as_deref() {
            None | Some("normal") => (Law::Normal, false),
            Some("lognormal") => (Law::Normal, true),
            Some("laplace") => (Law::Laplace, false),
            Some("loglaplace") => (Law::Laplace, true),
            Some("student") => (Law::Student(output.degrees_of_freedom.unwrap_or(FREEDOM)), false),
            Some("poisson") => (Law::Poisson, false),
            Some(other) => {
                let fault = fault!(BAD_OPTION, "the `error` of `{name}` is `{other}`");
                return Err(fault
                    .help(
                        "write \"normal\", \"lognormal\", \"laplace\", \"loglaplace\", \
                         \"student\" or \"poisson\"",
                    )
                    .at(place));
            }
        };
        if let Some(freedom) = output.degrees_of_freedom {
            let place = at("degrees_of_freedom");
            if !matches!(law, Law::Student(_)) {
                let fault = fault!(BAD_OPTION, "the errors of `{name}` have no degrees of freedom");
                return Err(fault.help("write `error = \"student\"`, or remove them").at(place));
            }
            if !(freedom.is_finite() && freedom >= 1.0) {
                let fault = fault!(
                    BAD_OPTION,
                    "the degrees of freedom of the errors of `{name}` are {freedom}"
                );
                return Err(fault.help("write a number of at least 1, usually 3 to 8").at(place));
            }
        }
        if law == Law::Poisson {
            let not_of_counts = if output.sigma.is_some() {
                Some("sigma")
            } else {
                output.weight.map(|_| "weight")
            };
            if let Some(key) = not_of_counts {
                let fault = fault!(
                    BAD_OPTION,
                    "`{name}` is a count, whose variance is its expectation: it has no `{key}`"
                );
                return Err(fault.help(format!("remove `{key}`")).at(at(key)));
            }
        }
        Ok(ErrorLaw { law, is_logarithmic, place })
    };
    entry.all_outputs().map(|(name, output)| one((name, output))).collect()
}

/// Gives a series the distribution of its errors.
///
/// # Errors
///
/// Measured values that are no counts.
pub(super) fn distribute(series: &mut Series, own: &ErrorLaw) -> Result<(), Diagnostic> {
    series.law = own.law;
    if own.law != Law::Normal && !series.censored.is_empty() {
        let fault = fault!(
            BAD_OPTION,
            "`{}` has values beyond a limit, which are supported with normal errors only",
            series.y_name;
            help: "use the error \"normal\" or \"lognormal\", or remove `below` and `above`"
        );
        return Err(fault.at(own.place));
    }
    if series.sigma == Sigma::Unknown && !series.censored.is_empty() {
        series.sigma = Sigma::Estimated;
    }
    match own.law {
        Law::Poisson => {
            let is_count = |y: &f64| *y >= 0.0 && y.fract() == 0.0;
            if let Some(k) = series.y.iter().position(|y| !is_count(y)) {
                let fault = fault!(
                    BAD_OPTION,
                    "`{}` is a count, but {} was measured at {} = {}",
                    series.y_name, series.y[k], series.x_name, series.x[k];
                    help: "correct the value, or use another `error`"
                );
                return Err(fault.at(own.place));
            }
            series.sigma = Sigma::Given(vec![1.0; series.y.len()]);
        }
        Law::Normal | Law::Below | Law::Above => {}
        Law::Laplace | Law::Student(_) if series.sigma == Sigma::Unknown => {
            series.sigma = Sigma::Estimated;
        }
        Law::Laplace | Law::Student(_) => {}
    }
    Ok(())
}

/// The distribution of a prior, and what it adds to -log L.
fn distribution(
    name: &str,
    entry: &PriorEntry,
    range: [f64; 2],
) -> Result<(Distribution, f64), Fault> {
    let numbers = match entry {
        PriorEntry::Name(kind) => {
            &PriorNumbers { distribution: Some(kind.clone()), ..PriorNumbers::default() }
        }
        PriorEntry::Numbers(numbers) => numbers,
    };
    let base = numbers.base.unwrap_or(std::f64::consts::E);
    if !(base.is_finite() && base > 1.0) {
        bail!(BAD_OPTION, "the base of the prior of `{name}` is {base}"; help: "write 10 for the logarithm to base 10");
    }
    let PriorNumbers { mean, sd, median, factor, scale, min, max, .. } = *numbers;
    let [low, high] = limits(name, [min, max], range)?;
    let kind = numbers.distribution.as_deref().unwrap_or("normal");
    let (found, constant) = match (kind, [mean, sd, median, factor, scale]) {
        ("uniform", [None, None, None, None, None]) => {
            (Distribution::Uniform, elementary::ln(high - low))
        }
        ("loguniform", [None, None, None, None, None]) if low > 0.0 => {
            (Distribution::LogUniform, elementary::ln(elementary::ln(high / low)))
        }
        ("normal", [Some(mean), Some(sd), None, None, None]) => {
            (Distribution::Normal { mean, sd }, 0.0)
        }
        ("normal", [None, None, Some(median), Some(factor), None]) => {
            (Distribution::LogNormal { median, factor }, 0.0)
        }
        ("lognormal", [Some(mean), Some(sd), None, None, None]) if numbers.base.is_none() => {
            let [median, factor] = [mean, sd].map(elementary::exp);
            (Distribution::LogNormal { median, factor }, 0.0)
        }
        ("laplace", [None, None, Some(median), None, Some(scale)]) => {
            (Distribution::Laplace { median, scale }, 0.0)
        }
        ("laplace", [None, None, Some(median), Some(factor), None]) => {
            (Distribution::LogLaplace { median, factor }, 0.0)
        }
        _ => return Err(unreadable(name)),
    };
    let mut prior = Prior { parameter: 0, distribution: found, constant };
    if prior.point().is_some() {
        truncate(&mut prior, name, [min, max], range)?;
    }
    if let (Distribution::LogNormal { median, factor }, "lognormal") = (found, kind) {
        return Ok(of_value([median, factor].map(elementary::ln), prior.constant));
    }
    let constant = prior.constant;
    match numbers.base {
        Some(_) if !prior.is_logarithmic() => {
            bail!(BAD_OPTION, "the prior of `{name}` is not one of its logarithm, and has no base"; help: "remove `base`");
        }
        // The density of log10 p is ln 10 times that of ln p.
        Some(base) => Ok((found, constant - elementary::ln(elementary::ln(base)))),
        None => Ok((found, constant)),
    }
}

/// Between which values a prior is uniform: the range unless its limits are given.
fn limits(name: &str, given: [Option<f64>; 2], range: [f64; 2]) -> Result<[f64; 2], Fault> {
    let [low, high] = [given[0].unwrap_or(range[0]), given[1].unwrap_or(range[1])];
    let is_reversed = low.is_nan() || high.is_nan() || low >= high;
    if given != [None, None] && is_reversed {
        bail!(BAD_OPTION, "the prior of `{name}` reaches from {low} to {high}"; help: "write the lower limit first");
    }
    Ok([low, high])
}

/// The density of a parameter whose logarithm is normal: it is 1/p times that of the logarithm, which
/// moves the centre of that, (ln p - m)²/(2 s²) + ln p = (ln p - m + s²)²/(2 s²) + m - s²/2.
fn of_value([mean, sd]: [f64; 2], constant: f64) -> (Distribution, f64) {
    let [median, factor] = [mean - sd * sd, sd].map(elementary::exp);
    (Distribution::LogNormal { median, factor }, constant + mean - 0.5 * sd * sd)
}

/// Normalizes a density that is 0 beyond limits.
fn truncate(
    prior: &mut Prior,
    name: &str,
    limits: [Option<f64>; 2],
    range: [f64; 2],
) -> Result<(), Fault> {
    let [low, high] = [limits[0].unwrap_or(f64::NEG_INFINITY), limits[1].unwrap_or(f64::INFINITY)];
    if range[0] < low || range[1] > high {
        bail!(BAD_OPTION, "the prior of `{name}` reaches from {low} to {high}, its search range from {} to {}", range[0], range[1]; help: "narrow `min` and `max` of the parameter");
    }
    if limits != [None, None] {
        let probability = prior.probability([low, high]);
        if probability.is_nan() || probability <= 0.0 {
            bail!(BAD_OPTION, "the prior of `{name}` has no probability between {low} and {high}"; help: "widen its limits");
        }
        prior.constant += elementary::ln(probability);
    }
    Ok(())
}

fn unreadable(name: &str) -> Fault {
    fault!(BAD_OPTION, "the prior of `{name}` cannot be read"; help: "write `{{ mean = 1, sd = 0.1 }}`, `{{ median = 1, factor = 1.5 }}` for a log-normal one (or `{{ distribution = \"lognormal\", mean = 0, sd = 0.4 }}`, of which the value has the density), `{{ distribution = \"laplace\", median = 1, scale = 0.1 }}`, \"uniform\" or \"loguniform\"")
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
