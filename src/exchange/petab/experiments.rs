//! Measurements as the experiments of a problem file: one for each condition, with a table of data.

use super::rows::{Observable, Parameter, placeholders};
use super::table::Row;
use crate::Refusal;
use crate::expression::{Context, Expression, number, printed};
use indexmap::IndexMap;
use std::collections::BTreeMap;

/// So many times as long as it was measured, a model is simulated until it counts as at rest: before
/// the measurement, or where it was measured at rest. A direct solution of the steady state of
/// Brannmark_JBC2010 has negative concentrations.
const REST: f64 = 1e6;

/// A measured variable of the model: an observable with the parameters of some of its measurements.
#[derive(Debug, Clone)]
pub(super) struct Output {
    /// Its name in the model.
    pub(super) name: String,
    pub(super) observable: usize,
    pub(super) formula: Expression,
    pub(super) noise: Noise,
}

/// The standard deviation of the measurements of an output.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Noise {
    /// A number for each measurement.
    Numbers,
    /// A parameter that is estimated and stands nowhere else.
    Estimated(String),
    /// A formula of variables and parameters of the model, one of which has its value.
    Formula(Expression),
}

/// A measurement.
#[derive(Debug, Clone)]
pub(super) struct Point {
    pub(super) output: usize,
    pub(super) time: f64,
    pub(super) value: f64,
    /// NaN where it is estimated.
    pub(super) sigma: f64,
}

/// The measurements under one condition.
#[derive(Debug, Clone)]
pub(super) struct Experiment {
    pub(super) condition: String,
    /// The condition in whose steady state it begins.
    pub(super) rest: Option<String>,
    pub(super) points: Vec<Point>,
}

/// All measurements.
pub(super) struct Measured {
    pub(super) outputs: Vec<Output>,
    pub(super) experiments: Vec<Experiment>,
    /// The lines of measurements without a value.
    pub(super) empty: Vec<String>,
}

/// What the rows are read with.
pub(super) struct Reader<'a> {
    pub(super) observables: &'a [Observable],
    pub(super) parameters: &'a IndexMap<String, Parameter>,
    pub(super) conditions: &'a IndexMap<String, Row>,
}

impl Reader<'_> {
    /// Groups the measurements by their conditions.
    pub(super) fn read(&self, rows: &[Row]) -> Result<Measured, Refusal> {
        let mut outputs: IndexMap<(usize, String, String), Output> = IndexMap::new();
        let mut experiments: IndexMap<(Option<&str>, &str), Experiment> = IndexMap::new();
        let mut empty: Vec<String> = Vec::new();
        for row in rows {
            let condition = self.condition(row, row.required("simulationConditionId")?)?;
            let rest = row.get("preequilibrationConditionId");
            let rest = rest.map(|name| self.condition(row, name)).transpose()?;
            let (observable, formula, noise, sigma) = self.output(row)?;
            let of_noise = match &noise {
                Noise::Numbers => String::new(),
                Noise::Estimated(name) => name.clone(),
                Noise::Formula(formula) => printed(formula, Context::Real),
            };
            let key = (observable, printed(&formula, Context::Real), of_noise);
            let place = outputs.len();
            let entry = outputs.entry(key);
            let output = indexmap::map::Entry::index(&entry);
            entry.or_insert_with(|| Output { name: place.to_string(), observable, formula, noise });
            let time = row.number("time")?.unwrap_or(f64::NAN);
            if time.is_nan() || time < 0.0 {
                return Err(row.wrong("the time of a measurement is missing or negative"));
            }
            let Some(value) = row.number("measurement")? else {
                empty.push(row.number_of_line());
                continue;
            };
            if value.is_infinite() {
                return Err(row.wrong("the measurement is infinite"));
            }
            let new = || Experiment {
                condition: condition.to_owned(),
                rest: rest.map(str::to_owned),
                points: Vec::new(),
            };
            let experiment = experiments.entry((rest, condition)).or_insert_with(new);
            experiment.points.push(Point { output, time, value, sigma });
        }
        let mut outputs: Vec<Output> = outputs.into_values().collect();
        self.name(&mut outputs);
        for own in experiments.values_mut() {
            let rest = own.until_rest();
            own.points.iter_mut().for_each(|point| point.time = point.time.min(rest));
        }
        let experiments = experiments.into_values().flat_map(|own| own.split(&outputs));
        Ok(Measured { experiments: experiments.collect(), outputs, empty })
    }

    fn condition<'r>(&self, row: &'r Row, name: &'r str) -> Result<&'r str, Refusal> {
        match self.conditions.contains_key(name) {
            true => Ok(name),
            false => Err(row.wrong(format!("no condition `{name}` is defined"))),
        }
    }

    /// The observable of a measurement, its formula, and its noise.
    fn output(&self, row: &Row) -> Result<(usize, Expression, Noise, f64), Refusal> {
        let id = row.required("observableId")?;
        let place = self.observables.iter().position(|own| own.id == id);
        let place = place.ok_or_else(|| row.wrong(format!("no observable `{id}` is defined")))?;
        let observable = &self.observables[place];
        let mut values =
            placeholders(row, ("observableParameter", "observableParameters"), observable)?;
        values.extend(placeholders(row, ("noiseParameter", "noiseParameters"), observable)?);
        let mut known = observable.formula.names();
        known.extend(observable.noise.names());
        if let Some(surplus) = values.keys().find(|name| !known.contains(*name)) {
            let message = format!("the row gives a value for `{surplus}`, which no formula has");
            return Err(row.wrong(message));
        }
        let formula = observable.formula.substituted(&values);
        // Noise may be relative to the observable.
        let mut of_noise = values.clone();
        of_noise.insert(id.to_owned(), formula.clone());
        let noise = observable.noise.substituted(&of_noise);
        for expression in [&formula, &noise] {
            let names = expression.names();
            let is_open = |name: &&String| {
                observable.is_placeholder(name) && !self.parameters.contains_key(*name)
            };
            if let Some(name) = names.iter().find(is_open) {
                return Err(row.wrong(format!("the row gives no value for `{name}`")));
            }
        }
        let (noise, sigma) = self.noise(observable, &noise);
        Ok((place, formula, noise, sigma))
    }

    fn noise(&self, observable: &Observable, noise: &Expression) -> (Noise, f64) {
        let fixed: BTreeMap<String, Expression> = self
            .parameters
            .iter()
            .filter(|(_, own)| !own.estimated)
            .filter_map(|(name, own)| Some((name.clone(), Expression::Number(own.nominal?))))
            .collect();
        let noise = noise.substituted(&fixed).simplified();
        if let Some(sigma) = noise.value() {
            let unit = observable.of_logarithm.unwrap_or(1.0);
            return (Noise::Numbers, sigma * unit);
        }
        match noise {
            Expression::Name(name) if self.parameters.contains_key(&name) => {
                (Noise::Estimated(name), f64::NAN)
            }
            formula => (Noise::Formula(formula), f64::NAN),
        }
    }

    /// An observable with one formula keeps its name; others are numbered.
    fn name(&self, outputs: &mut [Output]) {
        let mut count: BTreeMap<usize, usize> = BTreeMap::new();
        outputs.iter().for_each(|own| *count.entry(own.observable).or_default() += 1);
        let mut next: BTreeMap<usize, usize> = BTreeMap::new();
        for own in outputs {
            let id = &self.observables[own.observable].id;
            let number = next.entry(own.observable).or_default();
            *number += 1;
            own.name =
                if count[&own.observable] == 1 { id.clone() } else { format!("{id}_{number}") };
        }
    }
}

impl Experiment {
    /// How long the model is simulated until it counts as at rest.
    pub(super) fn until_rest(&self) -> f64 {
        let times = self.points.iter().map(|point| point.time);
        REST * times.filter(|time| time.is_finite()).fold(1.0, f64::max)
    }

    /// A table has one standard deviation for all replicates: where they differ, each replicate is an
    /// experiment of its own.
    fn split(self, outputs: &[Output]) -> Vec<Experiment> {
        let differs = |(place, _): (usize, &Output)| {
            let columns = self.columns(place);
            let mut all = columns.iter().flat_map(BTreeMap::values).map(|value| value[1]);
            let first = all.next();
            columns.len() > 1 && all.any(|sigma| Some(sigma) != first && sigma.is_finite())
        };
        if !outputs.iter().enumerate().any(differs) {
            return vec![self];
        }
        let mut parts: Vec<Experiment> = Vec::new();
        for point in self.points {
            let is_there = |own: &Experiment| {
                own.points
                    .iter()
                    .any(|other| other.output == point.output && other.time == point.time)
            };
            match parts.iter_mut().find(|part| !is_there(part)) {
                Some(part) => part.points.push(point),
                None => {
                    let (condition, rest) = (self.condition.clone(), self.rest.clone());
                    parts.push(Experiment { condition, rest, points: vec![point] });
                }
            }
        }
        parts
    }

    /// The columns of the data of each of its outputs: for each replicate the value and, where given,
    /// the standard deviation at every time.
    fn columns(&self, output: usize) -> Vec<BTreeMap<u64, [f64; 2]>> {
        let mut columns: Vec<BTreeMap<u64, [f64; 2]>> = Vec::new();
        for point in self.points.iter().filter(|point| point.output == output) {
            let key = point.time.to_bits();
            let free = columns.iter().position(|column| !column.contains_key(&key));
            let free = free.unwrap_or_else(|| {
                columns.push(BTreeMap::new());
                columns.len() - 1
            });
            columns[free].insert(key, [point.value, point.sigma]);
        }
        columns
    }

    /// The table of the experiment and the entries of its outputs.
    pub(super) fn data(&self, outputs: &[Output]) -> (String, Vec<(usize, Vec<String>, Sigma)>) {
        let mut times: Vec<f64> = self.points.iter().map(|point| point.time).collect();
        times.sort_by(f64::total_cmp);
        times.dedup();
        // Time has the unit of the model, which Modelica takes as seconds.
        let mut heading = vec!["time [s]".to_owned()];
        let mut cells: Vec<Vec<String>> = times.iter().map(|time| vec![number(*time)]).collect();
        let mut entries = Vec::new();
        let mut add = |name: &str, column: &BTreeMap<u64, [f64; 2]>, k: usize| {
            heading.push(name.to_owned());
            for (row, time) in cells.iter_mut().zip(&times) {
                let value = column.get(&time.to_bits()).map(|value| value[k]);
                row.push(value.map_or(String::new(), number));
            }
        };
        for (place, output) in outputs.iter().enumerate() {
            let columns = self.columns(place);
            if columns.is_empty() {
                continue;
            }
            let all: Vec<f64> =
                columns.iter().flat_map(BTreeMap::values).map(|value| value[1]).collect();
            let is_one = all.iter().all(|sigma| *sigma == all[0]);
            let names: Vec<String> = (1..=columns.len())
                .map(|k| {
                    if k == 1 {
                        output.name.clone()
                    } else {
                        format!("{}_replicate{k}", output.name)
                    }
                })
                .collect();
            for (name, column) in names.iter().zip(&columns) {
                add(name, column, 0);
            }
            let sigma = match &output.noise {
                Noise::Estimated(_) => Sigma::Estimated,
                Noise::Formula(_) => Sigma::Variable,
                Noise::Numbers if is_one => Sigma::Number(all[0]),
                Noise::Numbers => {
                    add(&format!("{}_sigma", output.name), &columns[0], 1);
                    Sigma::Column
                }
            };
            entries.push((place, names, sigma));
        }
        let mut text = heading.join(",") + "\n";
        cells.iter().for_each(|row| text += &(row.join(",") + "\n"));
        (text, entries)
    }
}

/// The standard deviation of an output in a problem file.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Sigma {
    Number(f64),
    /// In the column with the name of the output and `_sigma`.
    Column,
    Estimated,
    /// A variable of the model.
    Variable,
}
