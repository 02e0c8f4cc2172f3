//! What the rows of the tables say.

use super::table::Row;
use crate::Refusal;
use crate::diag::Fault;
use crate::expression::{Expression, formula};
use crate::registry::BAD_OPTION;
use std::collections::BTreeMap;

/// The natural logarithm of 10.
const LN_10: f64 = std::f64::consts::LN_10;

/// A parameter of the problem.
#[derive(Debug, Clone)]
pub(super) struct Parameter {
    pub(super) id: String,
    pub(super) title: String,
    pub(super) logarithmic: bool,
    pub(super) range: [f64; 2],
    pub(super) nominal: Option<f64>,
    pub(super) estimated: bool,
    pub(super) prior: Option<Prior>,
}

/// What is known of a parameter, as a problem file says it.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Prior {
    Normal { mean: f64, sd: f64 },
    LogNormal { median: f64, factor: f64 },
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
    pub(super) row: Row,
}

pub(super) fn parsed(row: &Row, text: &str) -> Result<Expression, Refusal> {
    formula(text).map_err(|why| row.wrong(format!("`{text}` is not a formula: {why}")))
}

pub(super) fn parameter(row: &Row) -> Result<Parameter, Refusal> {
    let id = row.required("parameterId")?.to_owned();
    let scale = row.required("parameterScale")?;
    if !["lin", "log", "log10"].contains(&scale) {
        return Err(row.wrong(format!("the scale `{scale}` is not `lin`, `log` or `log10`")));
    }
    let estimated = row.number("estimate")? == Some(1.0);
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
    if let Some([lower, upper]) = uniform(row, scale)?.filter(|_| estimated) {
        range = [range[0].max(lower), range[1].min(upper)];
        if range[0] >= range[1] {
            return Err(row.wrong(format!("the prior of `{id}` lies outside its bounds")));
        }
    }
    Ok(Parameter {
        title: row.get("parameterName").unwrap_or_default().to_owned(),
        logarithmic: scale != "lin",
        range,
        nominal: row.number("nominalValue")?,
        estimated,
        prior: if estimated { prior(row, scale)? } else { None },
        id,
    })
}

/// The range of a uniform prior, which is constant within it.
fn uniform(row: &Row, scale: &str) -> Result<Option<[f64; 2]>, Refusal> {
    let kind = row.get("objectivePriorType").unwrap_or_default();
    let on_scale = kind == "parameterScaleUniform";
    let text = row.get("objectivePriorParameters").unwrap_or_default();
    if !(on_scale || kind == "uniform" && scale == "lin") || text.is_empty() {
        return Ok(None);
    }
    let numbers: Vec<f64> = text.split(';').filter_map(|part| part.trim().parse().ok()).collect();
    let [lower, upper] = numbers[..] else {
        return Err(row.wrong(format!("the prior `{kind}` needs two numbers, not `{text}`")));
    };
    let unit = match scale {
        "log10" => LN_10,
        "log" => 1.0,
        _ => return Ok(Some([lower, upper])),
    };
    Ok(Some([lower, upper].map(|value| crate::elementary::exp(value * unit))))
}

fn prior(row: &Row, scale: &str) -> Result<Option<Prior>, Refusal> {
    let Some(kind) = row.get("objectivePriorType") else { return Ok(None) };
    let text = row.get("objectivePriorParameters").unwrap_or_default();
    let numbers: Vec<f64> = text.split(';').filter_map(|part| part.trim().parse().ok()).collect();
    // Within the range, uniform priors are constant.
    if kind == "parameterScaleUniform" || kind == "uniform" && scale == "lin" {
        return Ok(None);
    }
    let [mean, sd] = numbers[..] else {
        return Err(row.wrong(format!("the prior `{kind}` needs two numbers, not `{text}`")));
    };
    let log_normal = |unit: f64| {
        let [median, factor] = [mean, sd].map(|value| crate::elementary::exp(value * unit));
        Prior::LogNormal { median, factor }
    };
    match (kind, scale) {
        ("parameterScaleNormal" | "normal", "lin") => Ok(Some(Prior::Normal { mean, sd })),
        ("parameterScaleNormal", "log10") => Ok(Some(log_normal(LN_10))),
        ("parameterScaleNormal", _) => Ok(Some(log_normal(1.0))),
        ("normal", _) => Ok(Some(Prior::Normal { mean, sd })),
        _ => {
            let fault = Fault::new(BAD_OPTION, format!("the prior `{kind}` is not supported"))
                .help("supported are uniform and normal ones on the scale of the parameter");
            Err(row.refusal(fault))
        }
    }
}

pub(super) fn observable(row: &Row) -> Result<Observable, Refusal> {
    let distribution = row.get("noiseDistribution").unwrap_or("normal");
    if distribution != "normal" {
        return Err(row.wrong(format!("the noise distribution `{distribution}` is not supported")));
    }
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
        row: row.clone(),
    })
}

/// The values of placeholders in a row of measurements: `observableParameter1_ID` and so on.
pub(super) fn placeholders(
    row: &Row,
    (kind, column): (&str, &str),
    observable: &str,
) -> Result<BTreeMap<String, Expression>, Refusal> {
    let text = row.get(column).unwrap_or_default();
    let parts = text.split(';').map(str::trim).filter(|part| !part.is_empty());
    parts
        .enumerate()
        .map(|(k, part)| Ok((format!("{kind}{}_{observable}", k + 1), parsed(row, part)?)))
        .collect()
}
