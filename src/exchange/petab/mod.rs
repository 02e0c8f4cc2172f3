//! Parameter estimation problems in PEtab (versions 1 and 2) as a Modelica model, a problem file and
//! tables of data.
//!
//! Observables become variables of the model, the parameters of their formulas its parameters. Every
//! condition is an experiment. Noise is a number for each measurement, a standard deviation that is
//! estimated with the parameters (`sigma = "estimate"`), or a variable of the model.

mod experiments;
mod problem;
mod rows;
mod table;
mod version2;

pub use problem::ReadFile;

use crate::Refusal;
use crate::diag::Fault;
use crate::expression::{Context, Expression, number, printed};
use crate::names::{Names, identifier, quoted as comment};
use crate::registry::BAD_OPTION;
use crate::sbml::{self, Additions, Extended, Model};
use experiments::{Experiment, Measured, Noise, Output, Reader, Sigma};
use indexmap::IndexMap;
use problem::{File, Language, Tables};
use rows::{Observable, Parameter};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

/// Fewer points than these have no standard deviation of their own.
const FEW: usize = 3;

/// A problem as files of this program.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Imported {
    /// The name of the problem file.
    pub problem: String,
    /// Names and contents of all files.
    pub files: Vec<(String, String)>,
    /// What should be known of them.
    pub notes: Vec<String>,
}

/// What the tables of a problem say.
struct Problem {
    name: String,
    parameters: IndexMap<String, Parameter>,
    observables: Vec<Observable>,
    measured: Measured,
    conditions: IndexMap<String, table::Row>,
    /// Names in the model of those that tables use.
    mapping: BTreeMap<String, String>,
    /// The words of a model in Modelica.
    in_modelica: Option<BTreeSet<String>>,
    /// The name and the text of a class that extends such a model, where variables are added to it.
    extension: Option<(String, String)>,
}

/// The files of the problem `name` that a YAML file describes; `read` gives the files beside it.
///
/// # Errors
///
/// What is wrong in a file, or not supported, at its place.
pub fn import(name: &str, yaml: &str, read: ReadFile<'_>) -> Result<Imported, Refusal> {
    let tables = tables(yaml, read)?;
    let (model, text) = tables.model.clone();
    let language = tables.language.clone();
    let mut problem = Problem::of(name, tables)?;
    let Language::Modelica(class) = language else {
        let mentioned = sbml::mentioned(&text).map_err(|refusal| refusal.in_file(&model))?;
        problem.decide_noise(&mentioned)?;
        let extended = problem.model(&text).map_err(|refusal| refusal.in_file(&model))?;
        return problem.files(&extended, &format!("{}.mo", file_name(&extended.model.name)));
    };
    problem.in_modelica = Some(words(&text));
    problem.decide_noise(&words(&text))?;
    problem.check_modelica()?;
    problem.extension = problem.extension_of(&class);
    let set = problem.conditions.values().flat_map(targets);
    let set = set.map(|(name, _)| (name.to_owned(), name.to_owned())).collect();
    let extended = Extended {
        model: Model { name: class, text },
        set,
        flags: BTreeMap::new(),
        at_rest: BTreeMap::new(),
    };
    problem.files(&extended, &model)
}

/// The tables of a problem in either version.
fn tables(yaml: &str, read: ReadFile<'_>) -> Result<Tables, Refusal> {
    let file = File { text: yaml };
    let documents = problem::documents(&file)?;
    let document = documents.first().ok_or_else(|| file.wrong(None, "the file is empty"))?;
    match problem::version(&file, document)? {
        2 => version2::read(&file, document, read),
        _ => problem::read(&file, document, read),
    }
}

impl Problem {
    fn of(name: &str, tables: Tables) -> Result<Problem, Refusal> {
        let mut parameters = IndexMap::new();
        for row in &tables.parameters {
            let own = rows::parameter(row)?;
            if parameters.insert(own.id.clone(), own).is_some() {
                return Err(row.wrong("a row above has the same parameter"));
            }
        }
        let mut observables: Vec<Observable> =
            tables.observables.iter().map(rows::observable).collect::<Result<_, _>>()?;
        let (mut conditions, mut mapping) = (tables.conditions, tables.mapping);
        if tables.language == Language::Sbml {
            let names = std::mem::take(&mut mapping);
            for row in conditions.values_mut() {
                let pairs = table::Row::pairs(row).into_iter();
                let renamed = |(name, cell): (String, String)| {
                    (names.get(&name).cloned().unwrap_or(name), cell)
                };
                *row = row.made(pairs.map(renamed).collect());
            }
            let names = names.into_iter().map(|(id, own)| (id, Expression::name(own))).collect();
            for own in &mut observables {
                own.formula = own.formula.substituted(&names);
                own.noise = own.noise.substituted(&names);
            }
        }
        for (place, own) in observables.iter().enumerate() {
            if observables[..place].iter().any(|other| other.id == own.id) {
                return Err(own.row.wrong("a row above has the same observable"));
            }
        }
        let reader =
            Reader { observables: &observables, parameters: &parameters, conditions: &conditions };
        let measured = reader.read(&tables.measurements)?;
        Ok(Problem {
            name: name.to_owned(),
            parameters,
            observables,
            measured,
            conditions,
            mapping,
            in_modelica: None,
            extension: None,
        })
    }

    /// Names of parameters that formulas and conditions use.
    fn used(&self) -> Result<BTreeSet<String>, Refusal> {
        let outputs = self.measured.outputs.iter();
        let mut used: BTreeSet<String> = outputs.flat_map(|own| own.formula.names()).collect();
        for output in &self.measured.outputs {
            if let Noise::Formula(formula) = &output.noise {
                used.extend(formula.names());
            }
        }
        for row in self.conditions.values() {
            for (column, text) in targets(row) {
                used.insert(column.to_owned());
                used.extend(rows::parsed(row, text)?.names());
            }
        }
        Ok(used)
    }

    /// Standard deviations that are estimated beside the parameters are those that nothing else depends
    /// on and that mean the same for all their outputs; others become variables of the model, whose
    /// formula is this parameter. `mentioned`: the names in the model.
    fn decide_noise(&mut self, mentioned: &BTreeSet<String>) -> Result<(), Refusal> {
        let used = self.used()?;
        let scale = |output: &Output| self.observables[output.observable].of_logarithm;
        let mut scales: BTreeMap<String, BTreeSet<u64>> = BTreeMap::new();
        for output in &self.measured.outputs {
            if let Noise::Estimated(name) = &output.noise {
                let own = scales.entry(name.clone()).or_default();
                own.insert(scale(output).map_or(0, f64::to_bits));
            }
        }
        let measured = self.measured.experiments.iter().flat_map(|own| &own.points);
        let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
        for point in measured {
            if let Noise::Estimated(name) = &self.measured.outputs[point.output].noise {
                *counts.entry(name).or_default() += 1;
            }
        }
        let is_alone = |name: &String| {
            // Of fewer points the bounds of the parameter are the estimate.
            let is_measured = counts.get(name.as_str()).is_some_and(|count| *count >= FEW);
            let is_one = scales.get(name).is_some_and(|scales| scales.len() == 1);
            let has_prior = self.parameters[name.as_str()].prior.is_some();
            is_measured && is_one && !has_prior && !used.contains(name) && !mentioned.contains(name)
        };
        let shared: BTreeSet<String> =
            scales.keys().filter(|name| !is_alone(name)).cloned().collect();
        for output in &mut self.measured.outputs {
            if let Noise::Estimated(name) = &output.noise
                && shared.contains(name)
            {
                output.noise = Noise::Formula(Expression::name(name.clone()));
            }
        }
        Ok(())
    }

    /// The variables of the model that have standard deviations, with their formulas; those of the natural
    /// logarithm where values are compared by their logarithms.
    fn variables_of_noise(&self) -> impl Iterator<Item = (String, Expression)> + '_ {
        self.measured.outputs.iter().filter_map(|output| {
            let Noise::Formula(formula) = &output.noise else { return None };
            let formula = match self.observables[output.observable].of_logarithm {
                Some(unit) if unit != 1.0 => formula.clone().times(Expression::Number(unit)),
                _ => formula.clone(),
            };
            Some((deviation(&output.name), formula))
        })
    }

    /// Standard deviations that are estimated beside the parameters.
    fn deviations(&self) -> BTreeSet<&str> {
        let outputs = self.measured.outputs.iter();
        outputs
            .filter_map(|own| match &own.noise {
                Noise::Estimated(name) => Some(name.as_str()),
                Noise::Numbers | Noise::Formula(_) => None,
            })
            .collect()
    }

    /// Refuses names that neither the model nor the table of parameters has.
    fn check_names(&self, symbols: &BTreeMap<String, bool>) -> Result<(), Refusal> {
        for output in &self.measured.outputs {
            let observable = &self.observables[output.observable];
            let own = [output.name.clone(), deviation(&output.name)];
            let taken = own.iter().find(|name| symbols.contains_key(*name) || *name == "time");
            if let Some(name) = taken {
                let message = format!("`{name}` is the name of an element of the model");
                return Err(observable.row.wrong(message));
            }
            let is_known =
                |name: &String| symbols.contains_key(name) || self.parameters.contains_key(name);
            let mut names = output.formula.names();
            if let Noise::Formula(formula) = &output.noise {
                names.extend(formula.names());
            }
            if let Some(name) = names.iter().find(|name| !is_known(name)) {
                let message = format!("`{name}` is neither in the model nor a parameter");
                return Err(observable.row.wrong(message));
            }
        }
        for row in self.conditions.values() {
            let mut columns = targets(row).map(|(column, _)| column);
            if let Some(column) = columns.find(|column| !symbols.contains_key(*column)) {
                return Err(row.wrong(format!("the model has no `{column}`")));
            }
        }
        Ok(())
    }

    /// Refuses conditions that set what rules of the model compute.
    fn check_targets(&self, computed: &BTreeSet<String>) -> Result<(), Refusal> {
        for row in self.conditions.values() {
            if let Some((column, _)) = targets(row).find(|(column, _)| computed.contains(*column)) {
                let message = format!("a rule of the model determines `{column}` at all times");
                let fault = Fault::new(BAD_OPTION, message)
                    .help("set what the rule depends on, or remove the rule from the model");
                return Err(row.refusal(fault));
            }
        }
        Ok(())
    }

    /// Refuses what a model in Modelica would have to be extended by.
    fn check_modelica(&self) -> Result<(), Refusal> {
        let before = self.measured.experiments.iter().find_map(|own| own.rest.as_ref());
        match before {
            Some(rest) => Err(self.conditions[rest.as_str()]
                .wrong("a steady state before, with a model in Modelica, is not supported")),
            None => Ok(()),
        }
    }

    /// A class that has the observables and deviations that are formulas, besides the variables of a model
    /// in Modelica.
    fn extension_of(&self, class: &str) -> Option<(String, String)> {
        let is_formula = |own: &&Output| !matches!(own.formula, Expression::Name(_));
        let outputs = self.measured.outputs.iter().filter(is_formula);
        let outputs = outputs.map(|own| {
            let title = self.observables[own.observable].title.clone();
            (own.name.clone(), title, own.formula.clone())
        });
        let deviations = self.variables_of_noise().map(|(name, formula)| {
            (name, "standard deviation of the measurements".to_owned(), formula)
        });
        let added: Vec<_> = outputs.chain(deviations).collect();
        if added.is_empty() {
            return None;
        }
        let name = format!("{}_observed", class.rsplit('.').next().unwrap_or(class));
        let mut text =
            format!("model {name} \"{class} with what is observed\"\n  extends {class};\n");
        let known = self.in_modelica.clone().unwrap_or_default();
        let used: BTreeSet<String> = added.iter().flat_map(|(_, _, own)| own.names()).collect();
        for own in self.parameters.values().filter(|own| used.contains(&own.id)) {
            if !known.contains(&own.id) && !self.mapping.contains_key(&own.id) {
                let value = number(own.nominal.unwrap_or(1.0));
                _ = writeln!(text, "  parameter Real {} = {value};", identifier(&own.id));
            }
        }
        let mapped = self.mapping.iter().map(|(id, own)| (id.clone(), Expression::name(own)));
        let mapped = mapped.collect();
        for (name, title, formula) in added {
            let formula = printed(&formula.substituted(&mapped), Context::Real);
            let title = if title.is_empty() { title } else { format!(" {}", comment(&title)) };
            _ = writeln!(text, "  Real {} = {formula}{title};", identifier(&name));
        }
        _ = writeln!(text, "end {name};");
        Some((name, text))
    }

    /// A name in the model, as a key of the problem file.
    fn in_model(&self, name: &str) -> String {
        match self.mapping.get(name) {
            Some(own) => key(own),
            None => key(&identifier(name)),
        }
    }

    /// What an output is in the model.
    fn variable(&self, output: &Output) -> String {
        match &output.formula {
            Expression::Name(name) if self.in_modelica.is_some() => self.in_model(name),
            _ => key(&identifier(&output.name)),
        }
    }

    /// What has another value in a steady state than in the simulation that follows.
    ///
    /// # Errors
    ///
    /// Initial values, which would have to be set between the two.
    fn switched(&self, symbols: &BTreeMap<String, bool>) -> Result<Vec<String>, Refusal> {
        let mut switched: Vec<String> = Vec::new();
        let is_state = |column: &str| symbols.get(column) == Some(&true);
        for experiment in &self.measured.experiments {
            let Some(rest) = &experiment.rest else { continue };
            let (row, rest) =
                (&self.conditions[experiment.condition.as_str()], &self.conditions[rest.as_str()]);
            let cells = targets(row).chain(targets(rest)).map(|(column, _)| column);
            for column in cells {
                if is_state(column) && row.get(column).is_some() {
                    let message = format!(
                        "`{column}` gets a value after the pre-equilibration, which is not supported"
                    );
                    return Err(row.wrong(message));
                }
                let differs = row.get(column) != rest.get(column) && !is_state(column);
                if differs && !switched.iter().any(|own| own == column) {
                    switched.push(column.to_owned());
                }
            }
        }
        Ok(switched)
    }

    /// The model with observables and parameters.
    fn model(&self, text: &str) -> Result<Extended, Refusal> {
        let symbols = sbml::symbols(text)?;
        self.check_names(&symbols)?;
        self.check_targets(&sbml::computed(text)?)?;
        let deviations = self.deviations();
        let parameters =
            self.parameters.values().filter(|own| !deviations.contains(own.id.as_str()));
        let mut set: Vec<String> = Vec::new();
        for row in self.conditions.values() {
            for (column, _) in targets(row) {
                if !set.iter().any(|own| own == column) {
                    set.push(column.to_owned());
                }
            }
        }
        let variables = self.measured.outputs.iter().map(|own| {
            let title = self.observables[own.observable].title.clone();
            (own.name.clone(), title, own.formula.clone())
        });
        let of_noise = self.variables_of_noise().map(|(name, formula)| {
            let title = "standard deviation of the measurements".to_owned();
            (name, title, formula)
        });
        sbml::extended(
            text,
            Additions {
                parameters: parameters
                    .map(|own| (own.id.clone(), own.title.clone(), own.nominal))
                    .collect(),
                variables: variables.chain(of_noise).collect(),
                set,
                rests: self.measured.experiments.iter().any(|own| own.rest.is_some()),
                switched: self.switched(&symbols)?,
            },
        )
    }

    fn files(&self, extended: &Extended, model_file: &str) -> Result<Imported, Refusal> {
        let extension = self.extension.as_ref();
        let class = extension.map_or(&extended.model.name, |(name, _)| name);
        let model_file = file_name(model_file);
        let own_file = extension.map(|(name, _)| format!("{}.mo", file_name(name)));
        let mut text = String::new();
        _ = writeln!(
            text,
            "# Imported from PEtab. The model has the nominal values of the parameters."
        );
        _ = writeln!(text, "title = {}", quoted(&self.name));
        _ = writeln!(text, "model = {}", quoted(&identifier(class)));
        let names: Vec<String> =
            [&model_file].into_iter().chain(&own_file).map(|own| quoted(own)).collect();
        _ = writeln!(text, "files = [{}]\n\n[parameters]", names.join(", "));
        self.write_parameters(&mut text);
        let mut files = vec![(model_file, extended.model.text.clone())];
        files.extend(own_file.zip(extension.map(|(_, text)| text.clone())));
        let mut names = Names::default();
        let mut data_names = Names::default();
        for experiment in &self.measured.experiments {
            let name = match &experiment.rest {
                None => experiment.condition.clone(),
                Some(rest) => format!("{} from {rest}", experiment.condition),
            };
            let name = names.fresh(&name);
            let data = format!("{}.csv", data_names.fresh(&file_name(&name)));
            let table = self.write_experiment(&mut text, (&name, &data), experiment, extended)?;
            files.push((data, table));
        }
        let problem = format!("{}.toml", file_name(&self.name));
        files.insert(0, (problem.clone(), text));
        Ok(Imported { problem, files, notes: self.notes() })
    }

    /// Measurements without a value, which are left out, and bounds that do not count.
    fn notes(&self) -> Vec<String> {
        let empty = &self.measured.empty;
        let left_out = empty.first().map(|first| match empty.len() {
            1 => format!("the measurement at {first} has no value and is left out"),
            n => format!("{n} measurements have no value and are left out (first at {first})"),
        });
        let deviations: Vec<&str> = self.deviations().into_iter().collect();
        let unbounded = (!deviations.is_empty()).then(|| {
            let names = deviations.join(", ");
            format!("the bounds of standard deviations do not count: {names}")
        });
        left_out.into_iter().chain(unbounded).collect()
    }

    fn write_parameters(&self, text: &mut String) {
        let deviations = self.deviations();
        for own in self.parameters.values() {
            let name = self.in_model(&own.id);
            if !own.estimated {
                let is_of_model =
                    self.in_modelica.as_ref().is_some_and(|words| words.contains(&own.id));
                if let Some(value) = own.nominal.filter(|_| is_of_model) {
                    _ = writeln!(text, "{name} = {{ fixed = {} }}", number(value));
                }
                continue;
            }
            if deviations.contains(own.id.as_str()) {
                let [min, max] = own.range.map(number);
                _ = writeln!(
                    text,
                    "# {} is the sigma of an output, and estimated as such.\n\
                     # Its bounds {min} to {max} do not count.",
                    own.id
                );
                continue;
            }
            let [min, max] = own.range.map(number);
            let scale = match own.logarithmic {
                Some(true) => ", scale = \"log\"",
                Some(false) => ", scale = \"linear\"",
                None => "",
            };
            let prior = own.prior.as_ref().map_or(String::new(), |own| format!(", prior = {own}"));
            let place = &own.place;
            _ = writeln!(text, "{name} = {{ min = {min}, max = {max}{scale}{prior} }} # {place}");
        }
    }

    /// Writes an experiment; its table.
    fn write_experiment(
        &self,
        text: &mut String,
        (name, data): (&str, &str),
        experiment: &Experiment,
        extended: &Extended,
    ) -> Result<String, Refusal> {
        let row = &self.conditions[experiment.condition.as_str()];
        _ = writeln!(text, "\n[[experiment]]\nname = {}\ndata = {}", quoted(name), quoted(data));
        if let Some(title) = row.get("conditionName") {
            _ = writeln!(text, "# {title}");
        }
        let rest = experiment.rest.as_ref().map(|name| &self.conditions[name.as_str()]);
        if rest.is_some() {
            _ = writeln!(
                text,
                "# It comes to rest before 0, which is tested.\nrest = true\nstart_time = {}",
                number(-experiment.until_rest())
            );
        }
        if let Some(start) = row.get("startTime") {
            _ = writeln!(text, "start_time = {start}");
        }
        let set = self.set(row, rest.unwrap_or(row), extended)?;
        if !set.is_empty() {
            let place = row.number_of_line();
            _ = writeln!(text, "set = {{ {} }} # {place}", set.join(", "));
        }
        let (table, entries) = experiment.data(&self.measured.outputs);
        _ = writeln!(text, "[experiment.outputs]");
        for (place, columns, sigma) in entries {
            let output = &self.measured.outputs[place];
            let columns = match columns.as_slice() {
                [one] => format!("column = {}", quoted(one)),
                several => {
                    let all: Vec<String> = several.iter().map(|name| quoted(name)).collect();
                    format!("columns = [{}]", all.join(", "))
                }
            };
            let sigma = self.sigma(output, sigma);
            let observable = &self.observables[output.observable];
            let error = match (observable.of_logarithm.is_some(), observable.is_laplace) {
                (false, false) => "",
                (true, false) => ", error = \"lognormal\"",
                (false, true) => ", error = \"laplace\"",
                (true, true) => ", error = \"loglaplace\"",
            };
            let name = self.variable(output);
            let place = observable.row.number_of_line();
            _ = writeln!(text, "{name} = {{ {columns}, sigma = {sigma}{error} }} # {place}");
        }
        Ok(table)
    }

    /// The sigma of an output as the problem file has it.
    fn sigma(&self, output: &Output, sigma: Sigma) -> String {
        match sigma {
            Sigma::Number(value) => number(value),
            Sigma::Column => quoted(&format!("{}_sigma", output.name)),
            Sigma::Estimated => quoted(&self.estimated(output)),
            Sigma::Variable => quoted(&identifier(&deviation(&output.name))),
        }
    }

    /// What an experiment sets, after it was at rest in another condition.
    fn set(
        &self,
        row: &table::Row,
        rest: &table::Row,
        extended: &Extended,
    ) -> Result<Vec<String>, Refusal> {
        let mut set = Vec::new();
        for column in self.conditions.values().flat_map(targets).map(|(column, _)| column) {
            let parameter = extended.set.get(column).map_or(column, String::as_str);
            // Initial values are those of the steady state.
            let is_of_rest = !extended.at_rest.contains_key(column) && row.get(column).is_none();
            let own = if is_of_rest { rest } else { row };
            let of_rest = extended.at_rest.get(column).map(|name| (rest, name.as_str()));
            for (row, parameter) in [Some((own, parameter)), of_rest].into_iter().flatten() {
                let Some(value) = row.get(column) else { continue };
                let entry = format!("{} = {}", self.in_model(parameter), self.value(row, value)?);
                let flag = extended.flags.get(column);
                let flag = flag.map(|flag| format!("{} = 1", self.in_model(flag)));
                for entry in [entry].into_iter().chain(flag) {
                    if !set.contains(&entry) {
                        set.push(entry);
                    }
                }
            }
        }
        Ok(set)
    }

    /// The sigma of an output that is estimated: with its name where others share it.
    fn estimated(&self, output: &experiments::Output) -> String {
        let same = self.measured.outputs.iter().filter(|other| other.noise == output.noise);
        match &output.noise {
            Noise::Estimated(name) if same.count() > 1 => format!("estimate {name}"),
            _ => "estimate".to_owned(),
        }
    }

    /// The value of a cell of a condition, as a problem file has it.
    fn value(&self, row: &table::Row, text: &str) -> Result<String, Refusal> {
        let own = rows::parsed(row, text)?;
        let fixed = |name: &String| match self.parameters.get(name.as_str()) {
            Some(own) if !own.estimated => own.nominal,
            _ => None,
        };
        let values = own
            .names()
            .into_iter()
            .filter_map(|name| Some((name.clone(), Expression::Number(fixed(&name)?))));
        let own = own.substituted(&values.collect());
        if let Some(value) = own.value() {
            return match value.is_finite() {
                true => Ok(number(value)),
                false => Err(row.wrong(format!("the value `{text}` is not finite"))),
            };
        }
        match own.names().iter().find(|name| !self.parameters.contains_key(name.as_str())) {
            Some(name) => Err(row.wrong(format!("`{name}` is not a parameter of the problem"))),
            None => Ok(quoted(&printed(&own, Context::Real))),
        }
    }
}

/// The identifiers in a text, and what else looks like one.
fn words(text: &str) -> BTreeSet<String> {
    let words = text.split(|c: char| !c.is_alphanumeric() && c != '_');
    words.filter(|word| !word.is_empty()).map(str::to_owned).collect()
}

/// The name of the variable that has the standard deviation of an output.
fn deviation(output: &str) -> String {
    format!("sigma_of_{output}")
}

/// Columns of conditions that set nothing.
const ABOUT: [&str; 3] = ["conditionId", "conditionName", "startTime"];

/// What a condition sets.
fn targets(row: &table::Row) -> impl Iterator<Item = (&str, &str)> {
    let is_target = |(column, _): &(&str, &str)| !ABOUT.contains(column);
    row.filled().into_iter().filter(is_target)
}

/// A string of TOML.
fn quoted(text: &str) -> String {
    format!("\"{}\"", text.replace('\\', "\\\\").replace('"', "\\\""))
}

/// A key of TOML.
fn key(name: &str) -> String {
    let is_bare = name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
    if is_bare { name.to_owned() } else { quoted(name) }
}

/// A name for a file.
fn file_name(text: &str) -> String {
    text.chars()
        .map(|c| if c.is_ascii_alphanumeric() || "-_.".contains(c) { c } else { '_' })
        .collect()
}
