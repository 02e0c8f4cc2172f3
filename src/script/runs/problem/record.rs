//! From the record `GAPILib.Problem` of a script to the entries of a problem's file, so that both
//! forms mean the same.

use super::noise_test::PREDICTION_STEPS;
use crate::bail;
use crate::diag::Fault;
use crate::ga::operators::KINDS;
use crate::registry::{BAD_OPTION, Choice};
use crate::value::{ArrayValue, Elements, FromValue, RealMatrix, RecordValue, Value};
use toml::{Table, Value as Entry};

/// The entries of the file that states what the record states.
///
/// # Errors
///
/// Components that are missing or of another type, vectors that belong together and differ in size.
pub(super) fn table(record: &RecordValue) -> Result<Table, Fault> {
    let fields = Fields(record);
    let mut file = Table::new();
    put_text(&mut file, "title", fields.text("title")?);
    put_text(&mut file, "model", fields.text("modelName")?);
    put(&mut file, "fitness", strings(fields.get("fitness")?));
    put(&mut file, "files", strings(fields.get("files")?));
    let seed: Vec<f64> = fields.get("seed")?;
    if !seed.is_empty() {
        put(&mut file, "seed", seed);
    }
    let mut parameters = Table::new();
    for entry in fields.records("parameters")? {
        let name = Fields(&entry).text("name")?;
        if parameters.insert(name.clone(), Entry::Table(parameter(&Fields(&entry))?)).is_some() {
            bail!(BAD_OPTION, "the parameter `{name}` is given twice");
        }
    }
    put(&mut file, "parameters", parameters);
    put(&mut file, "noise", noise(&fields)?);
    let steps: i64 = fields.get("predictionSteps")?;
    if steps != 0 {
        put(&mut file, PREDICTION_STEPS, steps);
    }
    let experiments = fields.records("experiments")?;
    let experiments: Result<Vec<Entry>, Fault> =
        experiments.iter().map(|entry| Ok(Entry::Table(experiment(&Fields(entry))?))).collect();
    put(&mut file, "experiment", experiments?);
    let mut method = fields.pairs("settings", "settingValues")?;
    put_text(&mut method, "name", fields.text("method")?);
    put(&mut method, "polish", fields.get::<bool>("polish")?);
    for kind in KINDS {
        put_text(&mut method, kind.name, fields.text(kind.name)?);
    }
    put(&mut file, "method", method);
    put(&mut file, "stop", stop(&fields)?);
    Ok(file)
}

/// Process noise; what is 0 is estimated.
fn noise(fields: &Fields<'_>) -> Result<Table, Fault> {
    let states: Vec<String> = fields.get("noiseStates")?;
    let of_states = |name: &str| -> Result<Vec<f64>, Fault> {
        let values: Vec<f64> = fields.get(name)?;
        match values.is_empty() {
            true => Ok(vec![0.0; states.len()]),
            false => same_size("noiseStates", states.len(), name, values.len()).map(|()| values),
        }
    };
    let (values, initial) = (of_states("noiseValues")?, of_states("noiseInitial")?);
    let one = |(state, (value, initial)): (String, (f64, f64))| {
        let mut entry = Table::new();
        match value == 0.0 {
            true => put(&mut entry, "value", "estimate"),
            false => put(&mut entry, "value", value),
        }
        put(&mut entry, "initial", initial);
        (state, Entry::Table(entry))
    };
    Ok(states.clone().into_iter().zip(values.into_iter().zip(initial)).map(one).collect())
}

fn stop(fields: &Fields<'_>) -> Result<Table, Fault> {
    let mut stop = Table::new();
    for name in ["generations", "evaluations", "stagnation"] {
        let limit: i64 = fields.get(name)?;
        if limit != 0 {
            put(&mut stop, name, limit);
        }
    }
    put_number(&mut stop, "seconds", fields.get("seconds")?);
    fields.optional("target", "target", &mut stop)?;
    Ok(stop)
}

fn parameter(fields: &Fields<'_>) -> Result<Table, Fault> {
    let mut entry = Table::new();
    fields.optional("fixed", "fixed", &mut entry)?;
    fields.optional("start", "start", &mut entry)?;
    put_text(&mut entry, "tied", fields.text("tied")?);
    let [min, max]: [f64; 2] = [fields.get("min")?, fields.get("max")?];
    if [min, max] != [0.0, 0.0] || (!entry.contains_key("fixed") && !entry.contains_key("tied")) {
        put(&mut entry, "min", min);
        put(&mut entry, "max", max);
    }
    put_text(&mut entry, "scale", fields.text("scale")?);
    put_text(&mut entry, "unit", fields.text("unit")?);
    if let Some(prior) = prior(&fields.text("prior")?)? {
        put(&mut entry, "prior", prior);
    }
    put(&mut entry, "initial", fields.get::<bool>("initialValue")?);
    put(&mut entry, "per_experiment", fields.get::<bool>("perExperiment")?);
    Ok(entry)
}

/// A distribution with its numbers, or a name alone; nothing for an empty string.
fn prior(text: &str) -> Result<Option<Entry>, Fault> {
    let Choice { name, options, .. } = Choice::parse(text)?;
    if name.is_empty() {
        return Ok(None);
    }
    let mut prior: Table =
        options.numbers().map(|(name, value)| (name.to_owned(), Entry::from(value))).collect();
    if prior.is_empty() {
        return Ok(Some(Entry::from(name)));
    }
    put(&mut prior, "distribution", name);
    Ok(Some(Entry::Table(prior)))
}

fn experiment(fields: &Fields<'_>) -> Result<Table, Fault> {
    let mut entry = Table::new();
    put_text(&mut entry, "name", fields.text("name")?);
    put_text(&mut entry, "data", fields.text("data")?);
    put_text(&mut entry, "integrator", fields.text("integrator")?);
    let spectrum = spectrum(fields)?;
    let mut x = Table::new();
    let (variable, column) = (fields.text("x")?, fields.text("xColumn")?);
    // The time is what records have where nothing is said; spectra have none.
    if spectrum.is_empty() || column != "time" {
        put_text(&mut x, "column", column);
    }
    if spectrum.is_empty() {
        put_text(&mut x, "variable", variable);
    } else {
        put(&mut entry, "spectrum", spectrum);
    }
    if !x.is_empty() {
        put(&mut entry, "x", x);
    }
    put(&mut entry, "outputs", outputs(fields)?);
    if let Some(covariance) = covariance(fields)? {
        put(&mut entry, "covariance", covariance);
    }
    let inputs: Vec<String> = fields.get("inputs")?;
    let columns: Vec<String> = fields.get("inputColumns")?;
    same_size("inputs", inputs.len(), "inputColumns", columns.len())?;
    let inputs = inputs.into_iter().zip(columns.into_iter().map(Entry::from));
    put(&mut entry, "inputs", inputs.collect::<Table>());
    put(&mut entry, "set", fields.pairs("settings", "settingValues")?);
    put(&mut entry, "start", fields.pairs("states", "stateValues")?);
    put(&mut entry, "validation", fields.get::<bool>("validation")?);
    put(&mut entry, "weight", fields.get::<f64>("weight")?);
    fields.optional("startTime", "start_time", &mut entry)?;
    put_number(&mut entry, "stop_time", fields.get("stopTime")?);
    let cuts: Vec<f64> = fields.get("cutTimes")?;
    match (fields.get::<bool>("cutAtGaps")?, cuts.is_empty()) {
        (true, false) => {
            bail!(BAD_OPTION, "`cutAtGaps` and `cutTimes` are both given"; help: "give one of them")
        }
        (true, true) => put(&mut entry, "segments", "auto"),
        (false, false) => put(&mut entry, "segments", cuts),
        (false, true) => {}
    }
    put_number(&mut entry, "tolerance", fields.get("tolerance")?);
    Ok(entry)
}

/// The covariance of the errors of the outputs of an experiment.
fn covariance(fields: &Fields<'_>) -> Result<Option<Entry>, Fault> {
    let rows = |name: &str| -> Result<Option<Entry>, Fault> {
        let matrix: RealMatrix = fields.get(name)?;
        let row = |k: usize| Entry::from(matrix.row(k).to_vec());
        let rows: Vec<Entry> = (0..matrix.rows).map(row).collect();
        Ok((!rows.is_empty()).then(|| Entry::from(rows)))
    };
    let table = |key: &str, value: Entry| Table::from_iter([(key.to_owned(), value)]);
    let group = fields.text("estimatedCovariance")?;
    match (rows("covariance")?, rows("correlation")?, group.as_str()) {
        (None, None, "") => Ok(None),
        (Some(matrix), None, "") => Ok(Some(matrix)),
        (None, Some(matrix), "") => Ok(Some(Entry::Table(table("correlation", matrix)))),
        (None, None, "estimate") => Ok(Some(Entry::from("estimate"))),
        (None, None, group) => {
            let mut entry = table("matrix", Entry::from("estimate"));
            put(&mut entry, "group", group);
            Ok(Some(Entry::Table(entry)))
        }
        _ => {
            bail!(BAD_OPTION, "`covariance`, `correlation` and `estimatedCovariance` exclude each other"; help: "give one of them")
        }
    }
}

/// What follows a scale that may be negative.
const ANY_SIGN: &str = " of any sign";

/// The outputs of an experiment; a sigma of 0 is not known.
fn outputs(fields: &Fields<'_>) -> Result<Table, Fault> {
    let names: Vec<String> = fields.get("outputs")?;
    let columns: Vec<String> = fields.of_outputs("columns", &names)?;
    let weights: Vec<f64> = fields.of_outputs("weights", &names)?;
    let sigmas: Vec<f64> = fields.of_outputs("sigmas", &names)?;
    let deviations: Vec<String> = fields.of_outputs("deviations", &names)?;
    let errors: Vec<String> = fields.of_outputs("errors", &names)?;
    let scales: Vec<String> = fields.of_outputs("scales", &names)?;
    let offsets: Vec<String> = fields.of_outputs("offsets", &names)?;
    let degrees: Vec<f64> = fields.of_outputs("degreesOfFreedom", &names)?;
    let mut outputs = Table::new();
    for (k, name) in names.iter().enumerate() {
        let mut output = Table::new();
        if sigmas[k] != 0.0 && !deviations[k].is_empty() {
            bail!(BAD_OPTION, "`{name}` has a number in `sigmas` and a string in `deviations`"; help: "give one of them");
        }
        put(&mut output, "column", columns[k].as_str());
        put(&mut output, "weight", weights[k]);
        put_number(&mut output, "sigma", sigmas[k]);
        put_text(&mut output, "sigma", deviations[k].clone());
        put_text(&mut output, "error", errors[k].clone());
        put_text(&mut output, "offset", offsets[k].clone());
        match scales[k].strip_suffix(ANY_SIGN) {
            None => put_text(&mut output, "scale", scales[k].clone()),
            Some(name) => {
                let sign = [("name", name.trim_end()), ("sign", "any")];
                let sign = sign.into_iter().map(|(key, word)| (key.to_owned(), Entry::from(word)));
                put(&mut output, "scale", sign.collect::<Table>());
            }
        }
        put_number(&mut output, "degrees_of_freedom", degrees[k]);
        put(&mut outputs, name, output);
    }
    Ok(outputs)
}

/// The spectrum that was measured; empty where it is a course of time.
fn spectrum(fields: &Fields<'_>) -> Result<Table, Fault> {
    let mut spectrum = Table::new();
    put_text(&mut spectrum, "input", fields.text("spectrumInput")?);
    put_text(&mut spectrum, "output", fields.text("spectrumOutput")?);
    if spectrum.is_empty() {
        return Ok(spectrum);
    }
    put(&mut spectrum, "factor", fields.get::<f64>("spectrumFactor")?);
    fields.optional("spectrumTime", "at", &mut spectrum)?;
    put_text(&mut spectrum, "weighting", fields.text("spectrumWeighting")?);
    Ok(spectrum)
}

/// The components of a record.
struct Fields<'a>(&'a RecordValue);

impl Fields<'_> {
    fn get<T: FromValue>(&self, name: &str) -> Result<T, Fault> {
        let Some((_, value)) = self.0.fields.iter().find(|(own, _)| own.as_str() == name) else {
            bail!(BAD_OPTION, "`{}` has no component `{name}`", self.0.type_name; help: "use the record `GAPILib.Problem`");
        };
        T::from_value(value.clone()).map_err(|mut fault| {
            fault.message = format!("`{name}` of `{}`: {}", self.0.type_name, fault.message);
            fault
        })
    }

    fn text(&self, name: &str) -> Result<String, Fault> {
        self.get(name)
    }

    fn records(&self, name: &str) -> Result<Vec<RecordValue>, Fault> {
        match self.get(name)? {
            Value::Array(ArrayValue { elements: Elements::Record(records), .. }) => Ok(records),
            Value::Record(record) => Ok(vec![record]),
            _ => bail!(BAD_OPTION, "`{name}` of `{}` must contain records", self.0.type_name),
        }
    }

    /// A vector of one number or none, as the entry `key`.
    fn optional(&self, name: &str, key: &str, entry: &mut Table) -> Result<(), Fault> {
        match self.get::<Vec<f64>>(name)?.as_slice() {
            [] => {}
            [value] => put(entry, key, *value),
            more => {
                bail!(BAD_OPTION, "`{name}` contains {} values; at most one is allowed", more.len())
            }
        }
        Ok(())
    }

    /// A vector with an element for each of the outputs; without any, those that say nothing.
    fn of_outputs<T: FromValue + Clone + Default>(
        &self,
        name: &str,
        outputs: &[String],
    ) -> Result<Vec<T>, Fault>
    where
        Vec<T>: FromValue,
    {
        let values: Vec<T> = self.get(name)?;
        match values.is_empty() {
            true => Ok(vec![T::default(); outputs.len()]),
            false => same_size("outputs", outputs.len(), name, values.len()).map(|()| values),
        }
    }

    fn pairs(&self, names: &str, values: &str) -> Result<Table, Fault> {
        let keys: Vec<String> = self.get(names)?;
        let numbers: Vec<f64> = self.get(values)?;
        same_size(names, keys.len(), values, numbers.len())?;
        Ok(keys.into_iter().zip(numbers.into_iter().map(Entry::from)).collect())
    }
}

fn same_size(first: &str, count: usize, second: &str, other: usize) -> Result<(), Fault> {
    if count != other {
        bail!(BAD_OPTION, "`{first}` has {count} elements, but `{second}` has \
                           {other}"; help: "use matching sizes");
    }
    Ok(())
}

fn strings(values: Vec<String>) -> Vec<Entry> {
    values.into_iter().map(Entry::from).collect()
}

fn put(table: &mut Table, name: &str, value: impl Into<Entry>) {
    table.insert(name.to_owned(), value.into());
}

/// An empty text and 0 say that nothing is said.
fn put_text(table: &mut Table, name: &str, text: String) {
    if !text.is_empty() {
        put(table, name, text);
    }
}

fn put_number(table: &mut Table, name: &str, value: f64) {
    if value != 0.0 {
        put(table, name, value);
    }
}
