//! Relative data: outputs that are measured in arbitrary units, whose scale or offset is estimated.

use super::file::{ColumnEntry, ExperimentEntry, ProblemFile, ScaleEntry, ScaleTable};
use crate::diag::{Diagnostic, Fault};
use crate::identify::fitness::Law;
use crate::identify::problem::{Scale, Scaling, Series, Sigma};
use crate::registry::BAD_OPTION;
use crate::source::Span;
use crate::{bail, fault};

/// What is written for a scale or an offset of its own.
const ESTIMATE: &str = "estimate";
/// The sign of scales that may be negative.
const ANY: &str = "any";
/// The fitness functions of which scales and offsets are the least squares.
const SQUARES: [&str; 4] = ["sum_of_squares", "rmse", "nrmse", "log_likelihood"];
const AS_PARAMETER: &str = "make it a parameter of the model, and the scaled output a variable";

/// What an output says of its scale and offset; those of its own have the name of the series.
///
/// # Errors
///
/// Words that are no names.
pub(super) fn scaling(
    entry: &ColumnEntry,
    (experiment, y_name): (&str, &str),
) -> Result<Scaling, Fault> {
    let own = || format!("{experiment} / {y_name}");
    let named = |what: &str, words: &str| match words {
        ESTIMATE => Ok(own()),
        words if is_name(words) => Ok(words.to_owned()),
        words => Err(fault!(
            BAD_OPTION,
            "the {what} of `{y_name}` is `{words}`";
            help: "write \"estimate\", or one name for the outputs that share it, such as \"s1\""
        )),
    };
    let scale = match &entry.scale {
        None => None,
        Some(ScaleEntry::Words(words)) => {
            Some(Scale { name: named("scale", words)?, any_sign: false })
        }
        Some(ScaleEntry::More(ScaleTable { name, sign })) => {
            let any_sign = match sign.as_deref() {
                None | Some("positive") => false,
                Some(ANY) => true,
                Some(other) => {
                    bail!(BAD_OPTION, "the sign of the scale of `{y_name}` is `{other}`"; help: "write \"positive\" or \"any\"")
                }
            };
            Some(Scale { name: named("scale", name.as_deref().unwrap_or(ESTIMATE))?, any_sign })
        }
    };
    let offset = entry.offset.as_ref().map(|own| named("offset", &own.0)).transpose()?;
    Ok(Scaling { scale, offset })
}

fn is_name(words: &str) -> bool {
    !words.is_empty() && words.chars().all(|c| c.is_alphanumeric() || c == '_')
}

/// Refuses scales and offsets of a series that least squares cannot find.
///
/// # Errors
///
/// Process noise, errors that are not normal, limits, deviations that the model computes, offsets of
/// logarithms.
pub(super) fn check(
    file: &ProblemFile,
    entry: &ExperimentEntry,
    series: &Series,
    is_logarithmic: bool,
) -> Result<(), Diagnostic> {
    let scaling = &series.scaling;
    if scaling.is_empty() {
        return Ok(());
    }
    if !file.noise.is_empty() {
        let fault = fault!(
            BAD_OPTION,
            "scales and offsets cannot be estimated together with process noise"
        );
        return Err(fault.help(AS_PARAMETER).at(file.context.places.at(&["noise"])));
    }
    let key = if scaling.scale.is_some() { "scale" } else { "offset" };
    let name = &series.y_name;
    let why = if series.law != Law::Normal {
        Some("errors that are neither normal nor log-normal")
    } else if !series.censored.is_empty() {
        Some("values beyond a limit (`below`, `above`)")
    } else if matches!(series.sigma, Sigma::Variable(_)) {
        Some("a sigma that the model computes")
    } else {
        None
    };
    if let Some(why) = why {
        let fault = fault!(BAD_OPTION, "`{name}` has {why}: its {key} cannot be estimated");
        return Err(fault.help(AS_PARAMETER).at(entry.places.at(&["outputs", name, key])));
    }
    if !is_logarithmic {
        return Ok(());
    }
    if scaling.offset.is_some() {
        let fault = fault!(
            BAD_OPTION,
            "`{name}` has log-normal errors: an offset cannot be estimated, only a scale"
        );
        return Err(fault.help(AS_PARAMETER).at(entry.places.at(&["outputs", name, "offset"])));
    }
    if scaling.scale.as_ref().is_some_and(|own| own.any_sign) {
        let fault = fault!(BAD_OPTION, "`{name}` has log-normal errors: its scale is positive");
        let fault = fault.help("remove `sign`, or use the error \"normal\"");
        return Err(fault.at(entry.places.at(&["outputs", name, "scale"])));
    }
    Ok(())
}

/// Gives all series that share a scale the sign that any of their outputs states.
///
/// # Errors
///
/// Outputs that state different signs, with the places of both.
fn agree(file: &ProblemFile, series: &mut [Series]) -> Result<(), Diagnostic> {
    let mut known: Vec<(String, bool, Span)> = Vec::new();
    for own in &file.experiment {
        for (output, column) in &own.outputs {
            let entry = column.entry();
            let Some(ScaleEntry::More(ScaleTable { name: Some(name), sign: Some(sign) })) =
                &entry.scale
            else {
                continue;
            };
            let (is_any, at) = (sign == ANY, own.places.at(&["outputs", output, "scale", "sign"]));
            match known.iter().find(|one| one.0 == *name && name != ESTIMATE) {
                Some((_, other, first)) if *other != is_any => {
                    let fault = fault!(BAD_OPTION, "the scale `{name}` has two signs");
                    let words = if is_any { "positive here" } else { "of any sign here" };
                    let fault = fault.help("outputs that share a scale have one: write one sign");
                    return Err(fault.at(at).related(*first, words));
                }
                _ => known.push((name.clone(), is_any, at)),
            }
        }
    }
    let scales = series.iter_mut().filter_map(|own| own.scaling.scale.as_mut());
    for scale in scales {
        scale.any_sign |= known.iter().any(|(name, is_any, _)| *is_any && *name == scale.name);
    }
    Ok(())
}

/// Gives scales their signs, and refuses what scales and offsets cannot be combined with, taken all series
/// together, with the place of the first one.
///
/// # Errors
///
/// Fitness functions that are no least squares, scales of logarithms and of values at once, and of
/// experiments for validation those that no fitted experiment has.
pub(super) fn check_all(
    file: &ProblemFile,
    (fitted, logarithmic): (&mut [Series], &[usize]),
    kept: &[&Series],
) -> Result<(), Diagnostic> {
    agree(file, fitted)?;
    let fitted = &*fitted;
    let of_kind = |is_logarithmic: bool| {
        let all = fitted.iter().enumerate();
        let own = all.filter(move |(k, _)| logarithmic.contains(k) == is_logarithmic);
        own.filter_map(|(_, series)| series.scaling.scale.as_ref())
    };
    if let Some(own) = of_kind(true).find(|own| of_kind(false).any(|one| one.name == own.name)) {
        let fault = fault!(
            BAD_OPTION,
            "the scale `{}` is that of outputs with normal and with log-normal errors", own.name;
            help: "give these outputs scales of two names, or one kind of `error`"
        );
        return Err(fault.at(place(file, "scale", |_, _, column| named(column, &own.name))));
    }
    let is_relative = |series: &&Series| !series.scaling.is_empty();
    if fitted.iter().any(|own| is_relative(&own)) {
        let names = file.fitness.iter().flat_map(|own| own.names());
        let mut others = names.filter(|name| !SQUARES.contains(name));
        if let Some(name) = others.next() {
            let fault = fault!(
                BAD_OPTION,
                "scales and offsets are estimated by least squares, not with `{name}`";
                help: "minimize `sum_of_squares`, or remove `scale` and `offset` of the outputs"
            );
            return Err(fault.at(file.context.places.at(&["fitness"])));
        }
    }
    kept.iter().try_for_each(|series| check_kept(file, series, fitted))
}

/// Refuses an experiment for validation with a scale or an offset that no fitted one has.
fn check_kept(file: &ProblemFile, series: &Series, fitted: &[Series]) -> Result<(), Diagnostic> {
    let mut scales = fitted.iter().filter_map(|own| own.scaling.scale.as_ref());
    let mut offsets = fitted.iter().filter_map(|own| own.scaling.offset.as_ref());
    let scale = series.scaling.scale.as_ref().map(|own| &own.name);
    let offset = series.scaling.offset.as_ref();
    let lacks_scale = scale.is_some_and(|own| scales.all(|one| one.name != *own));
    let lacks_offset = offset.is_some_and(|own| offsets.all(|one| one != own));
    if lacks_scale || lacks_offset {
        let what = if lacks_scale { "scale" } else { "offset" };
        let fault = fault!(
            BAD_OPTION,
            "{} is for validation: no {what} of `{}` can be estimated from it",
            series.experiment,
            series.y_name;
            help: "name the {what} of an output of another experiment in both, or remove it here"
        );
        let is_own = |own: &ExperimentEntry, name: &str, column: &ColumnEntry| {
            let has = if lacks_scale { column.scale.is_some() } else { column.offset.is_some() };
            own.validation && name == series.y_name && has
        };
        return Err(fault.at(place(file, what, is_own)));
    }
    Ok(())
}

/// Whether an output has the scale of this name.
fn named(entry: &ColumnEntry, name: &str) -> bool {
    match &entry.scale {
        Some(ScaleEntry::Words(own)) => own == name,
        Some(ScaleEntry::More(own)) => own.name.as_deref() == Some(name),
        None => false,
    }
}

/// The place of this entry of the first output that is meant.
fn place(
    file: &ProblemFile,
    key: &str,
    is_meant: impl Fn(&ExperimentEntry, &str, &ColumnEntry) -> bool,
) -> Span {
    for own in &file.experiment {
        for (name, column) in &own.outputs {
            if is_meant(own, name, &column.entry()) {
                return own.places.at(&["outputs", name, key]);
            }
        }
    }
    Span::NONE
}
