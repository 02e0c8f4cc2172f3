//! A problem as files of PEtab (version 2) with its model in Modelica: `gapi export --petab`.
//!
//! Names that PEtab does not allow are mapped. A deviation that is estimated is a parameter with wide
//! bounds; one that is given has its value in each row of the measurements.

use super::build::build;
use super::file::{ExperimentEntry, ParameterEntry, PriorEntry, ProblemFile, Role, ValueEntry};
use super::{file, refusal};
use crate::Session;
use crate::diag::{At as _, Diagnostic, Fault};
use crate::fault;
use crate::identify::fitness::Law;
use crate::identify::problem::{Series, Sigma};
use crate::models::imported::refuse_as_text;
use crate::registry::BAD_OPTION;
use crate::source::Span;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;

/// A deviation that is estimated is searched within these multiples of the size of what was measured.
const BOUNDS: [f64; 2] = [1e-6, 1e3];

/// Names and contents of the files for the problem in the file `path`, the YAML file first.
///
/// # Errors
///
/// Everything that is wrong with the problem, and what PEtab cannot say, at its place.
pub fn petab(session: &mut Session, path: &Path) -> Result<Vec<(String, String)>, Vec<Diagnostic>> {
    let one = |fault: Fault| vec![fault.at(Span::NONE)];
    refuse_as_text(path, "a problem file").map_err(one)?;
    let bytes = session.world.read_bytes(path).map_err(one)?;
    let text = String::from_utf8(bytes)
        .map_err(|_| one(fault!(BAD_OPTION, "`{}` is not valid UTF-8 text", path.display())))?;
    let source = session.sources.add(path.display().to_string(), text.as_str());
    let mut file = file::read(source, &text)
        .map_err(|error| vec![refusal::with_unread_columns(session, path, &text, error)])?;
    check(&file).map_err(|error| vec![error])?;
    let built = build(session, &mut file, path)?;
    let model = match &file.files[..] {
        [own] => path.parent().unwrap_or(Path::new("")).join(own),
        _ => return Err(vec![several_files().at(file.context.places.at(&["files"]))]),
    };
    let model = session
        .world
        .read_bytes(&model)
        .map_err(|_| vec![several_files().at(file.context.places.at(&["files"]))])?;
    let series: Vec<&Series> = built.problem.series.iter().filter(|own| own.is_data()).collect();
    let starts: Vec<f64> = built.experiments.iter().map(|own| own.settings.start).collect();
    let tables = Tables::of(&file, &series, &starts).map_err(|error| vec![error])?;
    Ok(tables.files(&file.model, String::from_utf8_lossy(&model).into_owned()))
}

fn several_files() -> Fault {
    fault!(BAD_OPTION, "the model is not one file of Modelica")
        .help("write the classes into one file, and its name in `files`")
}

/// What PEtab cannot say.
fn unsayable(what: &str) -> Fault {
    fault!(BAD_OPTION, "{what} cannot be written in PEtab")
}

/// Refuses entries that have no counterpart, at their places.
fn check(file: &ProblemFile) -> Result<(), Diagnostic> {
    let at = |key: &str| file.context.places.at(&[key]);
    let refuse = |what: &str, place: Span| Err(unsayable(what).at(place));
    if !file.noise.is_empty() {
        return refuse("process noise", at("noise"));
    }
    if file.covariance.is_some() {
        return refuse("correlated errors", at("covariance"));
    }
    if !file.constraints.is_empty() {
        return refuse("constraints between parameters", at("constraints"));
    }
    if file.fitness.is_some() {
        return refuse("a fitness function of the file's own", at("fitness"));
    }
    let is_name = |name: &str| name.chars().all(|c| c.is_alphanumeric() || c == '_');
    if !is_name(&file.model) {
        let fault =
            unsayable(&format!("the model `{}`, which is not the name of a class", file.model));
        let help = "declare a class for it: `model M extends Package.Class(k = 2); end M;`";
        return Err(fault.help(help).at(at("model")));
    }
    for (name, own) in &file.parameters {
        if own.initial {
            return refuse(
                "an initial value that is estimated",
                file.context.places.parameter(name),
            );
        }
    }
    file.experiment.iter().try_for_each(check_experiment)
}

fn check_experiment(entry: &ExperimentEntry) -> Result<(), Diagnostic> {
    let x = entry.x.as_ref().and_then(|own| own.entry().variable);
    for (is_there, key, what) in [
        (x.is_some_and(|x| x != "time"), "x", "what was measured over another variable than time"),
        (entry.spectrum.is_some(), "spectrum", "a spectrum"),
        (!entry.inputs.is_empty(), "inputs", "inputs that follow data"),
        (!entry.start.is_empty(), "start", "initial values of an experiment"),
        (entry.set.file.is_some(), "set", "values of a file of SSP"),
        (entry.covariance.is_some(), "covariance", "correlated errors"),
        (entry.weight.is_some(), "weight", "the weight of an experiment"),
        (entry.validation, "validation", "an experiment for validation"),
        (entry.steady_state, "steady_state", "a steady state as the start"),
        (entry.rest, "rest", "a model that comes to rest before the data"),
        (entry.segments.is_some(), "segments", "an experiment in segments"),
    ] {
        if is_there {
            return Err(unsayable(what).at(entry.places.at(&[key])));
        }
    }
    for (name, output) in entry.all_outputs() {
        let at = |key: &str| entry.places.at(&["outputs", name, key]);
        for (is_there, key, what) in [
            (output.delay.is_some(), "delay", "a delay"),
            (output.weight.is_some(), "weight", "a weight"),
            (output.scale.is_some(), "scale", "a scale that is not a parameter"),
            (output.offset.is_some(), "offset", "an offset that is not a parameter"),
            (output.below.is_some(), "below", "a limit of detection"),
            (output.above.is_some(), "above", "a limit of saturation"),
        ] {
            if is_there {
                return Err(unsayable(what).at(at(key)));
            }
        }
    }
    Ok(())
}

/// Identifiers of PEtab for names of the model.
#[derive(Default)]
struct Identifiers {
    /// The names by their identifiers, where these differ.
    mapped: BTreeMap<String, String>,
}

impl Identifiers {
    fn of(&mut self, name: &str) -> String {
        let plain = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
        let own: String = name.chars().map(plain).collect();
        let own =
            if own.starts_with(|c: char| c.is_ascii_digit()) { format!("_{own}") } else { own };
        if own == name {
            return own;
        }
        let numbered = (2..).map(|k| format!("{own}_{k}"));
        let is_free = |id: &String| self.mapped.get(id).is_none_or(|other| other == name);
        let id = std::iter::once(own.clone()).chain(numbered).find(is_free).unwrap_or(own);
        self.mapped.insert(id.clone(), name.to_owned());
        id
    }
}

/// The tables, row by row.
#[derive(Default)]
struct Tables {
    identifiers: Identifiers,
    parameters: Vec<[String; 7]>,
    /// What identifies an observable: variable, distribution, and deviation.
    known: Vec<[String; 3]>,
    observables: Vec<[String; 6]>,
    conditions: Vec<[String; 3]>,
    experiments: Vec<[String; 3]>,
    measurements: Vec<[String; 5]>,
    has_priors: bool,
    /// Parameters that the model gets, with a value for one experiment each.
    added: Vec<String>,
}

impl Tables {
    fn of(file: &ProblemFile, series: &[&Series], starts: &[f64]) -> Result<Tables, Diagnostic> {
        let mut tables = Tables::default();
        let (mut tied, mut own_in_each) = (Vec::new(), Vec::new());
        for (name, entry) in &file.parameters {
            let place = file.context.places.parameter(name);
            match entry.role(name).at(place)? {
                Role::Free { range, .. } if entry.per_experiment => {
                    own_in_each.push((name, entry, range));
                }
                Role::Free { range, .. } => {
                    let id = tables.identifiers.of(name);
                    tables.free(id, entry, range).at(place)?;
                }
                Role::Fixed(ValueEntry::Number(value)) => tables.fixed(name, value),
                Role::Fixed(_) => {
                    return Err(unsayable("a value that is not a number").at(place));
                }
                Role::Tied(text) => tied.push((name.clone(), text)),
            }
        }
        let mut all = series.iter();
        for (number, entry) in file.experiment.iter().enumerate() {
            let id = id_of(entry, number);
            let mut set = tied.clone();
            for (name, parameter, range) in &own_in_each {
                let own = format!("{}_in_{id}", tables.identifiers.of(name));
                let place = file.context.places.parameter(name);
                tables.free(own.clone(), parameter, *range).at(place)?;
                tables.added.push(own.clone());
                set.push(((*name).clone(), own));
            }
            tables.experiment(entry, &id, (set, starts.get(number).copied()))?;
            for (name, _) in entry.all_outputs() {
                let Some(own) = all.next() else { continue };
                let place = entry.places.at(&["outputs", name]);
                tables.series(own, name, &id).at(place)?;
            }
        }
        tables.deviations(series);
        Ok(tables)
    }

    fn free(
        &mut self,
        id: String,
        entry: &ParameterEntry,
        [low, high]: [f64; 2],
    ) -> Result<(), Fault> {
        let [kind, numbers] = match &entry.prior {
            None => [String::new(), String::new()],
            Some(prior) => prior_of(prior, [low, high])?,
        };
        self.has_priors |= !kind.is_empty();
        let is_wide = low > 0.0 && high / low > 10.0;
        let middle = if is_wide { (low * high).sqrt() } else { 0.5 * (low + high) };
        let [low, high, start] = [low, high, entry.start.unwrap_or(middle)].map(|v| v.to_string());
        self.parameters.push([id, low, high, start, "true".to_owned(), kind, numbers]);
        Ok(())
    }

    fn fixed(&mut self, name: &str, value: f64) {
        let id = self.identifiers.of(name);
        let nominal = value.to_string();
        let (no, none) = ("false".to_owned(), String::new);
        self.parameters.push([id, none(), none(), nominal, no, none(), none()]);
    }

    /// An experiment with what it sets: what parameters are there, and its own.
    fn experiment(
        &mut self,
        entry: &ExperimentEntry,
        id: &str,
        (mut targets, start): (Vec<(String, String)>, Option<f64>),
    ) -> Result<(), Diagnostic> {
        for (name, value) in &entry.set.values {
            let value = match value {
                ValueEntry::Number(value) => value.to_string(),
                ValueEntry::Text(text) => text.clone(),
                ValueEntry::Truth(_) => {
                    let place = entry.places.at(&["set", name]);
                    return Err(unsayable("a truth value").at(place));
                }
            };
            targets.retain(|(own, _)| own != name);
            targets.push((name.clone(), value));
        }
        let condition = if targets.is_empty() { String::new() } else { format!("{id}_set") };
        for (name, value) in targets {
            let target = self.identifiers.of(&name);
            self.conditions.push([condition.clone(), target, value]);
        }
        self.experiments.push([id.to_owned(), start.unwrap_or(0.0).to_string(), condition]);
        Ok(())
    }

    fn series(&mut self, own: &Series, name: &str, experiment: &str) -> Result<(), Fault> {
        let is_logarithm = own.y_name != name;
        let distribution = match (own.law, is_logarithm) {
            (Law::Normal, false) => "normal",
            (Law::Normal, true) => "log-normal",
            (Law::Laplace, false) => "laplace",
            (Law::Laplace, true) => "log-laplace",
            (Law::Student(_) | Law::Poisson | Law::Below | Law::Above, _) => {
                return Err(unsayable("an error of Student or Poisson"));
            }
        };
        let deviation = match &own.sigma {
            Sigma::Given(_) => String::new(),
            Sigma::Formula(_) | Sigma::Variable(_) => {
                return Err(unsayable("a sigma that is a formula or a variable of the model"));
            }
            _ => deviation_id(own),
        };
        let kind = [name.to_owned(), distribution.to_owned(), deviation.clone()];
        let place = self.known.iter().position(|known| *known == kind).unwrap_or_else(|| {
            self.known.push(kind);
            self.known.len() - 1
        });
        if place == self.observables.len() {
            let variable = self.identifiers.of(name);
            let same = self.known[..place].iter().filter(|known| known[0] == name).count();
            let number = if same == 0 { String::new() } else { format!("_{}", same + 1) };
            let id = format!("observed_{variable}{number}");
            let (noise, placeholder) = match deviation.is_empty() {
                true => (format!("sigma_of_{id}"), format!("sigma_of_{id}")),
                false => (deviation, String::new()),
            };
            let distribution = distribution.to_owned();
            let title = name.to_owned();
            self.observables.push([id, title, variable, noise, distribution, placeholder]);
        }
        let id = self.observables[place][0].clone();
        for (k, (x, y)) in own.x.iter().zip(&own.y).enumerate() {
            let y = if is_logarithm { crate::elementary::exp(*y) } else { *y };
            let sigma = match &own.sigma {
                Sigma::Given(values) => values[k].to_string(),
                _ => String::new(),
            };
            let row = [id.clone(), experiment.to_owned(), x.to_string(), y.to_string(), sigma];
            self.measurements.push(row);
        }
        Ok(())
    }

    /// The deviations that are estimated, as parameters.
    fn deviations(&mut self, series: &[&Series]) {
        let mut sizes: BTreeMap<String, f64> = BTreeMap::new();
        let open = series.iter().filter(|own| !matches!(own.sigma, Sigma::Given(_)));
        for own in open {
            let size = own.y.iter().fold(0.0f64, |most, y| most.max(y.abs()));
            let most = sizes.entry(deviation_id(own)).or_default();
            *most = most.max(size);
        }
        for (id, size) in sizes {
            let size = if size > 0.0 { size } else { 1.0 };
            let [low, high] = BOUNDS.map(|bound| (bound * size).to_string());
            let (yes, none) = ("true".to_owned(), String::new);
            self.parameters.push([id, low, high, (0.1 * size).to_string(), yes, none(), none()]);
        }
    }

    /// The class that has the parameters of single experiments as well, and the text with it.
    fn extended(&self, class: &str, mut model: String) -> (String, String) {
        if self.added.is_empty() {
            return (class.to_owned(), model);
        }
        let own = format!("{class}_in_experiments");
        // Writing into a String cannot fail.
        _ = writeln!(model, "\nmodel {own}\n  extends {class};");
        for name in &self.added {
            _ = writeln!(model, "  parameter Real {name} = 1;");
        }
        _ = writeln!(model, "end {own};");
        (own, model)
    }

    /// The files, the YAML file first.
    fn files(self, class: &str, model: String) -> Vec<(String, String)> {
        let (class, model) = self.extended(class, model);
        let heading = ["parameterId", "lowerBound", "upperBound", "nominalValue", "estimate"];
        let priors = ["priorDistribution", "priorParameters"];
        let n = if self.has_priors { 7 } else { 5 };
        let heading: Vec<&str> = heading.into_iter().chain(priors).take(n).collect();
        let parameters = self.parameters.iter().map(|row| row[..n].to_vec());
        let mut yaml = format!(
            "format_version: 2.0.0\nmodel_files:\n  {class}:\n    location: {class}.mo\n    \
             language: modelica\nparameter_files: [parameters.tsv]\nmeasurement_files: \
             [measurements.tsv]\nobservable_files: [observables.tsv]\nexperiment_files: \
             [experiments.tsv]\n"
        );
        let mut files = vec![
            (format!("{class}.mo"), model),
            ("parameters.tsv".to_owned(), table(&heading, parameters)),
        ];
        let mut add = |name: &str, heading: &[&str], rows: Vec<Vec<String>>| {
            files.push((name.to_owned(), table(heading, rows.into_iter())));
        };
        add(
            "observables.tsv",
            &[
                "observableId",
                "observableName",
                "observableFormula",
                "noiseFormula",
                "noiseDistribution",
                "noisePlaceholders",
            ],
            self.observables.into_iter().map(Vec::from).collect(),
        );
        add(
            "experiments.tsv",
            &["experimentId", "time", "conditionId"],
            self.experiments.into_iter().map(Vec::from).collect(),
        );
        add(
            "measurements.tsv",
            &["observableId", "experimentId", "time", "measurement", "noiseParameters"],
            self.measurements.into_iter().map(Vec::from).collect(),
        );
        if !self.conditions.is_empty() {
            yaml += "condition_files: [conditions.tsv]\n";
            add(
                "conditions.tsv",
                &["conditionId", "targetId", "targetValue"],
                self.conditions.into_iter().map(Vec::from).collect(),
            );
        }
        if !self.identifiers.mapped.is_empty() {
            yaml += "mapping_files: [mapping.tsv]\n";
            let rows = self.identifiers.mapped.into_iter().map(|(id, name)| vec![id, name]);
            add("mapping.tsv", &["petabEntityId", "modelEntityId"], rows.collect());
        }
        files.insert(0, ("problem.yaml".to_owned(), yaml));
        files
    }
}

/// The identifier of an experiment.
fn id_of(entry: &ExperimentEntry, number: usize) -> String {
    let plain = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
    format!("e{}_{}", number + 1, entry.label(number).chars().map(plain).collect::<String>())
}

/// The parameter for the deviation of a series that is estimated.
fn deviation_id(own: &Series) -> String {
    let plain = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
    // One variance for all is one deviation.
    let name = own.deviation().unwrap_or("all");
    format!("sigma_{}", name.chars().map(plain).collect::<String>())
}

/// The distribution and its numbers.
fn prior_of(prior: &PriorEntry, range: [f64; 2]) -> Result<[String; 2], Fault> {
    let pair = |a: f64, b: f64| format!("{a};{b}");
    let own = match prior {
        PriorEntry::Name(kind) if kind == "uniform" => ["uniform", &pair(range[0], range[1])],
        PriorEntry::Name(_) => return Err(unsayable("a prior of the logarithm")),
        PriorEntry::Numbers(own) => {
            let kind = own.distribution.as_deref().unwrap_or("normal");
            let limits = [own.min.unwrap_or(range[0]), own.max.unwrap_or(range[1])];
            match (kind, own.mean, own.sd, own.median, own.scale) {
                ("uniform", None, None, None, None) => ["uniform", &pair(limits[0], limits[1])],
                _ if limits != range => {
                    return Err(unsayable("a prior that ends outside of the search range"));
                }
                ("normal", Some(mean), Some(sd), None, None) => ["normal", &pair(mean, sd)],
                ("lognormal", Some(mean), Some(sd), None, None) => ["log-normal", &pair(mean, sd)],
                ("laplace", None, None, Some(median), Some(scale)) => {
                    ["laplace", &pair(median, scale)]
                }
                _ => return Err(unsayable("a prior of the logarithm")),
            }
        }
    };
    Ok(own.map(str::to_owned))
}

/// A table with tabs.
fn table(heading: &[&str], rows: impl Iterator<Item = Vec<String>>) -> String {
    let mut text = heading.join("\t") + "\n";
    for row in rows {
        // Writing into a String cannot fail.
        _ = writeln!(text, "{}", row.join("\t"));
    }
    text
}
