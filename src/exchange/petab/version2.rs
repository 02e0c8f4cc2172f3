//! Version 2 of PEtab as tables of version 1: experiments become conditions, whose changes are listed
//! one by one, and placeholders and priors have the names that they had before.

use super::problem::{File, Language, Tables, all_rows, entry};
use super::table::{Row, refuse_columns};
use crate::Refusal;
use indexmap::IndexMap;
use saphyr::MarkedYaml;
use std::collections::BTreeMap;

/// The condition of measurements that belong to no experiment.
const NONE: &str = "without conditions";

/// The tables of a problem.
pub(super) fn read(
    file: &File<'_>,
    document: &MarkedYaml<'_>,
    read: super::ReadFile<'_>,
) -> Result<Tables, Refusal> {
    required_extensions(file, document)?;
    let (name, language, place) = model(file, document)?;
    let text = file.read((&name, place), read)?;
    let mut rows = |key: &str, required: &[&str], is_needed: bool| {
        let is_there = entry(document, key).is_some();
        match is_there || is_needed {
            true => all_rows((file, document), key, required, read),
            false => Ok(Vec::new()),
        }
    };
    let parameters = rows("parameter_files", &["parameterId", "estimate"], true)?;
    let observables =
        rows("observable_files", &["observableId", "observableFormula", "noiseFormula"], true)?;
    let measurements = rows("measurement_files", &["observableId", "measurement", "time"], true)?;
    let changes = rows("condition_files", &["conditionId", "targetId", "targetValue"], false)?;
    let experiments = rows("experiment_files", &["experimentId", "time", "conditionId"], false)?;
    let mapped = rows("mapping_files", &["petabEntityId", "modelEntityId"], false)?;
    refuse_columns(&parameters, &["objectivePriorType", "objectivePriorParameters"], 2)?;
    refuse_columns(&observables, &["observableTransformation"], 2)?;
    let of_version_1 = ["simulationConditionId", "preequilibrationConditionId"];
    refuse_columns(&measurements, &of_version_1, 2)?;
    let mut mapping = BTreeMap::new();
    for row in &mapped {
        if let Some(own) = row.get("modelEntityId") {
            mapping.insert(row.required("petabEntityId")?.to_owned(), own.to_owned());
        }
    }
    let (conditions, rests) = conditions(&changes, &experiments, &measurements)?;
    let measurements = measurements.iter().map(|row| measurement(row, &rests));
    Ok(Tables {
        model: (name, text),
        language,
        mapping,
        parameters: parameters.iter().map(parameter).collect::<Result<_, _>>()?,
        observables: observables.iter().map(observable).collect::<Result<_, _>>()?,
        measurements: measurements.collect(),
        conditions,
    })
}

/// Refuses what changes the meaning of the problem.
fn required_extensions(file: &File<'_>, document: &MarkedYaml<'_>) -> Result<(), Refusal> {
    let Some(all) = entry(document, "extensions").and_then(|own| own.data.as_mapping()) else {
        return Ok(());
    };
    for (name, own) in all {
        if entry(own, "required").and_then(|own| own.data.as_bool()) == Some(true) {
            let name = name.data.as_str().unwrap_or_default();
            let message = format!("the extension `{name}` of PEtab is not supported");
            return Err(file.wrong(Some(own), message));
        }
    }
    Ok(())
}

/// The file of the model, its language, and where that is said.
fn model<'a, 'i>(
    file: &File<'_>,
    document: &'a MarkedYaml<'i>,
) -> Result<(String, Language, &'a MarkedYaml<'i>), Refusal> {
    let models = entry(document, "model_files");
    let all: Vec<_> = models.and_then(|own| own.data.as_mapping()).into_iter().flatten().collect();
    let [(id, own)] = all[..] else {
        let message = format!("the problem has {} models; one is supported", all.len());
        return Err(file.wrong(models.or(Some(document)), message));
    };
    let text = |key: &str| entry(own, key).and_then(|own| own.data.as_str());
    let Some(location) = text("location") else {
        return Err(file.wrong(Some(own), "the model has no `location`"));
    };
    let language = match text("language") {
        Some("sbml") => Language::Sbml,
        Some("modelica") => Language::Modelica(id.data.as_str().unwrap_or_default().to_owned()),
        other => {
            let other = other.unwrap_or_default();
            let message = format!("the language `{other}` is neither `sbml` nor `modelica`");
            return Err(file.wrong(entry(own, "language").or(Some(own)), message));
        }
    };
    Ok((location.to_owned(), language, own))
}

/// What the experiments set when their measurements begin, and the conditions in whose steady state
/// they begin.
type Conditions = (IndexMap<String, Row>, BTreeMap<String, String>);

fn conditions(
    changes: &[Row],
    experiments: &[Row],
    measurements: &[Row],
) -> Result<Conditions, Refusal> {
    let mut conditions: BTreeMap<&str, Vec<&Row>> = BTreeMap::new();
    for row in changes {
        conditions.entry(row.required("conditionId")?).or_default().push(row);
    }
    let (mut found, mut rests) = (IndexMap::new(), BTreeMap::new());
    let mut times: BTreeMap<&str, (&Row, f64)> = BTreeMap::new();
    for row in experiments {
        let id = row.required("experimentId")?;
        let time = time(row)?;
        let is_rest = time == f64::NEG_INFINITY;
        let name = if is_rest { format!("{id} before") } else { id.to_owned() };
        if is_rest {
            rests.insert(id.to_owned(), name.clone());
        } else if let Some((_, first)) = times.insert(id, (row, time))
            && first != time
        {
            return Err(row.wrong(format!(
                "`{id}` changes its conditions at {first} and {time}; only its begin is supported"
            )));
        }
        let mut pairs = vec![("conditionId".to_owned(), name.clone())];
        if let Some(before) = found.get(&name) {
            pairs = Row::pairs(before);
        } else if !is_rest && time != 0.0 {
            pairs.push(("startTime".to_owned(), time.to_string()));
        }
        add_changes(row, &conditions, &mut pairs)?;
        found.insert(name, row.made(pairs));
    }
    for (id, (row, time)) in &times {
        if rests.contains_key(*id) && *time != 0.0 {
            let message = format!("`{id}` begins at {time} after a steady state, not at 0");
            return Err(row.wrong(message + ", which is not supported"));
        }
    }
    if let Some(id) = rests.keys().find(|id| !times.contains_key(id.as_str())) {
        let own: Vec<&Row> =
            experiments.iter().filter(|row| row.get("experimentId") == Some(id)).collect();
        return Err(own[0].wrong(format!("`{id}` has no condition after its steady state")));
    }
    if let Some(row) = measurements.iter().find(|row| row.get("experimentId").is_none()) {
        let pairs = vec![("conditionId".to_owned(), NONE.to_owned())];
        found.insert(NONE.to_owned(), row.made(pairs));
    }
    Ok((found, rests))
}

/// When a condition begins.
fn time(row: &Row) -> Result<f64, Refusal> {
    let time = match row.required("time")? {
        "-inf" | "-Inf" | "-INF" => f64::NEG_INFINITY,
        _ => row.number("time")?.unwrap_or(f64::NAN),
    };
    match time.is_nan() || time == f64::INFINITY {
        true => Err(row.wrong("the time of the experiment is not a number")),
        false => Ok(time),
    }
}

/// Adds what the condition in a row of experiments sets.
fn add_changes(
    row: &Row,
    conditions: &BTreeMap<&str, Vec<&Row>>,
    pairs: &mut Vec<(String, String)>,
) -> Result<(), Refusal> {
    let Some(condition) = row.get("conditionId") else { return Ok(()) };
    let Some(own) = conditions.get(condition) else {
        return Err(row.wrong(format!("no condition `{condition}` is defined")));
    };
    for change in own {
        let target = change.required("targetId")?.to_owned();
        if pairs.iter().any(|(name, _)| *name == target) {
            return Err(change.wrong(format!("`{target}` is set twice in one experiment")));
        }
        pairs.push((target, change.required("targetValue")?.to_owned()));
    }
    Ok(())
}

fn measurement(row: &Row, rests: &BTreeMap<String, String>) -> Row {
    let id = row.get("experimentId").unwrap_or(NONE).to_owned();
    let mut pairs = Row::pairs(row);
    if let Some(rest) = rests.get(&id) {
        pairs.push(("preequilibrationConditionId".to_owned(), rest.clone()));
    }
    pairs.push(("simulationConditionId".to_owned(), id));
    row.made(pairs)
}

fn parameter(row: &Row) -> Result<Row, Refusal> {
    let mut pairs = Row::pairs(row);
    if let Some(kind) = row.get("priorDistribution") {
        let kind = match kind {
            "normal" | "laplace" | "uniform" => kind,
            "log-normal" => "logNormal",
            _ => return Err(row.wrong(format!("the prior `{kind}` is not supported"))),
        };
        pairs.push(("objectivePriorType".to_owned(), kind.to_owned()));
        let numbers = row.get("priorParameters").unwrap_or_default().to_owned();
        pairs.push(("objectivePriorParameters".to_owned(), numbers));
    }
    Ok(row.made(pairs))
}

fn observable(row: &Row) -> Result<Row, Refusal> {
    let (transformation, distribution) = match row.get("noiseDistribution").unwrap_or("normal") {
        "normal" => ("lin", "normal"),
        "laplace" => ("lin", "laplace"),
        "log-normal" => ("log", "normal"),
        "log-laplace" => ("log", "laplace"),
        other => {
            return Err(row.wrong(format!("the noise distribution `{other}` is not supported")));
        }
    };
    let mut pairs = Row::pairs(row);
    pairs.retain(|(name, _)| name != "noiseDistribution");
    pairs.push(("observableTransformation".to_owned(), transformation.to_owned()));
    pairs.push(("noiseDistribution".to_owned(), distribution.to_owned()));
    Ok(row.made(pairs))
}
