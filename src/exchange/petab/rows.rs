//! What the rows of the tables say.

use super::table::Row;
use crate::Refusal;
use crate::diag::Fault;
use crate::expression::{Expression, formula, number};
use crate::registry::BAD_OPTION;
use std::collections::BTreeMap;

/// The natural logarithm of 10.
const LN_10: f64 = std::f64::consts::LN_10;

/// A parameter of the problem.
#[derive(Debug, Clone)]
pub(super) struct Parameter {
    pub(super) id: String,
    pub(super) title: String,
    /// Whether the scale of the search is one of logarithms, where that is said.
    pub(super) logarithmic: Option<bool>,
    pub(super) range: [f64; 2],
    pub(super) nominal: Option<f64>,
    pub(super) estimated: bool,
    /// What is known of it, as a problem file has it.
    pub(super) prior: Option<String>,
    /// Its line, as `file:line`.
    pub(super) place: String,
}

/// How an observable is compared with its measurements.
#[derive(Debug, Clone)]
pub(super) struct Observable {
    pub(super) id: String,
    pub(super) title: String,
    pub(super) formula: Expression,
    pub(super) noise: Expression,
    /// What the noise is multiplied with to be that of the natural logarithm; `None` where values are
    /// compared as they are.
    pub(super) of_logarithm: Option<f64>,
    /// Whether the errors are distributed as Laplace has it, else normally.
    pub(super) is_laplace: bool,
    pub(super) row: Row,
}

impl Observable {
    /// Whether measurements give a value for the name.
    pub(super) fn is_placeholder(&self, name: &str) -> bool {
        let declared = |column: &str| {
            self.row.get(column).is_some_and(|names| names.split(';').any(|own| own.trim() == name))
        };
        ["observableParameter", "noiseParameter"].iter().any(|usual| name.starts_with(usual))
            || declared("observablePlaceholders")
            || declared("noisePlaceholders")
    }
}

pub(super) fn parsed(row: &Row, text: &str) -> Result<Expression, Refusal> {
    formula(text).map_err(|why| row.wrong(format!("`{text}` is not a formula: {why}")))
}

pub(super) fn parameter(row: &Row) -> Result<Parameter, Refusal> {
    let id = row.required("parameterId")?.to_owned();
    // Version 2 has none.
    let scale = row.get("parameterScale").unwrap_or("lin");
    if !["lin", "log", "log10"].contains(&scale) {
        return Err(row.wrong(format!("the scale `{scale}` is not `lin`, `log` or `log10`")));
    }
    let estimated = match row.get("estimate") {
        Some("1" | "1.0" | "true" | "True") => true,
        Some("0" | "0.0" | "false" | "False") => false,
        other => {
            let other = other.unwrap_or_default();
            return Err(row.wrong(format!("`estimate` is `{other}`, neither 0 nor 1")));
        }
    };
    let limit = |column: &str| -> Result<f64, Refusal> {
        let value = row.number(column)?.filter(|value| value.is_finite());
        match value {
            Some(value) => Ok(value),
            None if estimated => {
                Err(row.wrong(format!("`{id}` is estimated, but has no finite `{column}`")))
            }
            None => Ok(f64::NAN),
        }
    };
    let mut range = [limit("lowerBound")?, limit("upperBound")?];
    let (prior, within) = if estimated { prior(row, scale)? } else { (None, None) };
    if estimated && range[0] >= range[1] {
        let [low, high] = range;
        return Err(row.wrong(format!("the bounds of `{id}` are {low} and {high}")));
    }
    let is_log = scale != "lin" || prior.as_ref().is_some_and(|own| is_of_logarithm(own));
    if estimated && is_log && range[0] <= 0.0 {
        let what = if scale == "lin" { "a prior of its logarithm" } else { "a logarithmic scale" };
        let [low, _] = range;
        return Err(row.wrong(format!("`{id}` has {what}, but its lowerBound is {low}")));
    }
    if !estimated && row.number("nominalValue")?.is_none() {
        return Err(row.wrong(format!("`{id}` is not estimated, and has no `nominalValue`")));
    }
    if let Some([lower, upper]) = within {
        range = [range[0].max(lower), range[1].min(upper)];
        if range[0] >= range[1] {
            return Err(row.wrong(format!("the prior of `{id}` lies outside its bounds")));
        }
    }
    Ok(Parameter {
        title: row.get("parameterName").unwrap_or_default().to_owned(),
        logarithmic: row.get("parameterScale").map(|scale| scale != "lin"),
        range,
        nominal: row.number("nominalValue")?,
        estimated,
        prior,
        place: row.number_of_line(),
        id,
    })
}

/// Whether a prior, as a problem file has it, is one of the logarithm.
fn is_of_logarithm(prior: &str) -> bool {
    prior.contains("factor =")
        || prior.contains("\"lognormal\"")
        || prior.contains("\"loguniform\"")
}

/// The numbers of a column, separated by semicolons.
fn two_numbers(row: &Row, column: &str, kind: &str) -> Result<[f64; 2], Refusal> {
    let text = row.get(column).unwrap_or_default();
    let parts: Vec<Option<f64>> = text.split(';').map(|part| part.trim().parse().ok()).collect();
    match parts[..] {
        [Some(first), Some(second)] => Ok([first, second]),
        _ => Err(row.wrong(format!("the prior `{kind}` needs two numbers, not `{text}`"))),
    }
}

/// The prior of a parameter, and the range outside of which it is 0.
fn prior(row: &Row, scale: &str) -> Result<(Option<String>, Option<[f64; 2]>), Refusal> {
    let Some(kind) = row.get("objectivePriorType") else { return Ok((None, None)) };
    let is_uniform = kind == "uniform" || kind == "parameterScaleUniform";
    if is_uniform && row.get("objectivePriorParameters").is_none() {
        return Ok((None, None));
    }
    let [first, second] = two_numbers(row, "objectivePriorParameters", kind)?;
    if is_uniform && first >= second {
        return Err(row.wrong(format!("the uniform prior reaches from {first} to {second}")));
    }
    if !is_uniform && (second.is_nan() || second <= 0.0) {
        return Err(row.wrong(format!("the width of the prior is {second}, not positive")));
    }
    let (unit, base) = match scale {
        "log10" => (10.0, ", base = 10"),
        _ => (std::f64::consts::E, ""),
    };
    let is_on_scale = kind.starts_with("parameterScale") && scale != "lin";
    let [a, b] = match is_on_scale {
        true => [first, second].map(|value| crate::elementary::powf(unit, value)),
        false => [first, second],
    };
    // In version 2, bounds truncate the density.
    let bounds = [row.number("lowerBound")?, row.number("upperBound")?];
    let bounds = bounds.map(|own| own.filter(|_| row.get("priorDistribution").is_some()));
    let within = match bounds {
        [Some(min), Some(max)] => format!(", min = {}, max = {}", number(min), number(max)),
        _ => String::new(),
    };
    let [a, b] = match (bounds, is_uniform) {
        ([Some(min), Some(max)], true) => [a.max(min), b.min(max)],
        _ => [a, b],
    };
    let written = written((kind, is_on_scale), [a, b], (&within, base));
    let text = written.ok_or_else(|| {
        let fault = Fault::new(BAD_OPTION, format!("the prior `{kind}` is not supported"));
        row.refusal(fault.help(
            "supported are uniform, normal, log-normal and Laplace ones, also parameterScale…",
        ))
    })?;
    Ok((Some(text), is_uniform.then_some([a, b])))
}

/// A prior as a problem file has it; `None` of kinds that are not supported.
fn written(
    (kind, is_on_scale): (&str, bool),
    numbers: [f64; 2],
    (within, base): (&str, &str),
) -> Option<String> {
    let [low, high] = numbers.map(number);
    Some(match (kind, is_on_scale) {
        ("uniform" | "parameterScaleUniform", false) => {
            format!("{{ distribution = \"uniform\", min = {low}, max = {high} }}")
        }
        ("parameterScaleUniform", true) => {
            format!("{{ distribution = \"loguniform\", min = {low}, max = {high}{base} }}")
        }
        ("normal" | "parameterScaleNormal", false) => {
            format!("{{ mean = {low}, sd = {high}{within} }}")
        }
        ("parameterScaleNormal", true) => {
            format!("{{ median = {low}, factor = {high}{base} }}")
        }
        ("logNormal", _) => {
            format!("{{ distribution = \"lognormal\", mean = {low}, sd = {high}{within} }}")
        }
        ("laplace" | "parameterScaleLaplace", false) => {
            format!("{{ distribution = \"laplace\", median = {low}, scale = {high}{within} }}")
        }
        ("parameterScaleLaplace", true) => {
            format!("{{ distribution = \"laplace\", median = {low}, factor = {high}{base} }}")
        }
        _ => return None,
    })
}

pub(super) fn observable(row: &Row) -> Result<Observable, Refusal> {
    let is_laplace = match row.get("noiseDistribution").unwrap_or("normal") {
        "normal" => false,
        "laplace" => true,
        other => {
            return Err(row.wrong(format!("the noise distribution `{other}` is not supported")));
        }
    };
    let of_logarithm = match row.get("observableTransformation").unwrap_or("lin") {
        "lin" => None,
        "log" => Some(1.0),
        "log10" => Some(LN_10),
        other => return Err(row.wrong(format!("the transformation `{other}` is not supported"))),
    };
    Ok(Observable {
        id: row.required("observableId")?.to_owned(),
        title: row.get("observableName").unwrap_or_default().to_owned(),
        formula: parsed(row, row.required("observableFormula")?)?,
        noise: parsed(row, row.required("noiseFormula")?)?,
        of_logarithm,
        is_laplace,
        row: row.clone(),
    })
}

/// The values of placeholders in a row of measurements: `observableParameter1_ID` and so on, in version 2
/// with the names that the observable declares.
pub(super) fn placeholders(
    row: &Row,
    (kind, column): (&str, &str),
    observable: &Observable,
) -> Result<BTreeMap<String, Expression>, Refusal> {
    let text = row.get(column).unwrap_or_default();
    let parts = text.split(';').map(str::trim).filter(|part| !part.is_empty());
    parts
        .enumerate()
        .map(|(k, part)| {
            let usual = || format!("{kind}{}_{}", k + 1, observable.id);
            let declared = observable.row.get(&kind.replace("Parameter", "Placeholders"));
            let name = match declared {
                Some(names) => names.split(';').nth(k).map_or_else(usual, |own| own.trim().into()),
                None => usual(),
            };
            Ok((name, parsed(row, part)?))
        })
        .collect()
}
