//! Measured outputs of one experiment beside the simulation: values in the unit of the model, their
//! standard deviations, and the rows that are complete.

use super::data::{self, Measured, Notes};
use super::fault_codes;
use super::file::{ColumnEntry, ExperimentEntry, LimitEntry, SigmaEntry};
use super::{relative, sigma, time_axis};
use crate::diag::{At as _, Diagnostic, Fault};
use crate::identify::Model;
use crate::identify::fitness::Law;
use crate::identify::problem::{Observation, Role, Series, Sigma};
use crate::mat::{Column, MatFile};
use crate::models::variable_unit::VariableUnit;
use crate::registry::BAD_OPTION;
use crate::units::in_words;
use crate::{bail, fault};

/// Measured values, and those of them that are limits.
type WithLimits = (Vec<f64>, Vec<(usize, Law)>);

/// What the outputs of an experiment are compared over.
pub(super) struct Comparison<'a> {
    /// The name of the experiment, or of the part of it.
    pub experiment: &'a str,
    /// The name of the experiment; its parts share their scales.
    pub label: &'a str,
    pub entry: &'a ExperimentEntry,
    pub table: &'a MatFile,
    pub model: &'a dyn Model,
    pub x_name: &'a str,
    /// The column of X.
    pub x_column: &'a str,
    /// X in the unit of the model; NaN where it is missing.
    pub x: Vec<f64>,
    /// When the simulation begins.
    pub start: f64,
}

impl Comparison<'_> {
    /// The unit of a variable.
    pub(super) fn unit(&self, name: &str) -> VariableUnit {
        match name {
            "time" => VariableUnit::second(),
            name => VariableUnit {
                symbol: self.model.unit(name).unwrap_or_default(),
                is_relative: self.model.is_relative(name),
                definitions: self.model.unit_definitions(),
            },
        }
    }

    /// The outputs of the experiment, with their names in its class.
    ///
    /// # Errors
    ///
    /// Columns that are missing or do not fit, deviations and weights that are not positive.
    pub(super) fn outputs(
        &self,
        observed: &[String],
        notes: &mut Notes,
    ) -> Result<(Vec<Observation>, Vec<Series>), Diagnostic> {
        if let Some(weight) = self.entry.weight.filter(|weight| !is_weight(*weight)) {
            let fault = fault!(BAD_OPTION, "the weight of {} is {weight}", self.experiment);
            let fault = fault.help("write a positive number");
            return Err(fault.at(self.entry.places.at(&["weight"])));
        }
        let (mut observations, mut series) = (Vec::new(), Vec::new());
        for ((y_name, requested), observed) in self.entry.all_outputs().zip(observed) {
            let one = self.output(y_name, &requested, notes);
            let one = one.at(self.entry.places.at(&["outputs", y_name]))?;
            observations.push(Observation { y_name: observed.clone(), x: one.x.clone() });
            series.push(one);
        }
        let n_outputs = series.len();
        for k in 0..n_outputs {
            let Sigma::Variable(name) = series[k].sigma.clone() else { continue };
            self.same_unit(&name, &series[k].y_name).at(self.entry.places.at(&[
                "outputs",
                &series[k].y_name,
                "sigma",
            ]))?;
            observations.push(Observation { y_name: name.clone(), x: series[k].x.clone() });
            series.push(series[k].deviations(&name, series.len() - k));
        }
        Ok((observations, series))
    }

    /// Refuses deviations in another unit than their output.
    fn same_unit(&self, deviation: &str, y_name: &str) -> Result<(), Fault> {
        let mut outputs = self.entry.all_outputs();
        let is_logarithm = outputs.any(|(name, own)| name == y_name && own.error.is_some());
        let [own, of] = [deviation, y_name].map(|name| self.unit(name).symbol);
        if is_logarithm || own.is_empty() || of.is_empty() || own == of {
            return Ok(());
        }
        bail!(
            BAD_OPTION,
            "the sigma of `{y_name}` is in {own}, but `{y_name}` is in {of}";
            help: "write a formula that converts it, with the factor, in place of the variable alone"
        )
    }

    /// The measured values of these rows, and the points at or beyond limits, whose values are the limits.
    fn censored(
        &self,
        y_name: &str,
        requested: &ColumnEntry,
        (rows, measured): (&[usize], &Measured),
    ) -> Result<WithLimits, Fault> {
        let mut y: Vec<f64> = rows.iter().map(|row| measured.values[*row]).collect();
        let mut found = Vec::new();
        for (entry, law) in [(&requested.below, Law::Below), (&requested.above, Law::Above)] {
            let limits: Vec<f64> = match entry {
                None => continue,
                Some(LimitEntry::Number(limit)) => vec![*limit; y.len()],
                Some(LimitEntry::Column(name)) => {
                    let column = self.table.column(name)?;
                    let limit =
                        |row: &usize| column.values.get(*row).map(|own| own * measured.factor);
                    rows.iter().map(|row| limit(row).unwrap_or(f64::NAN)).collect()
                }
            };
            for (k, (y, limit)) in y.iter_mut().zip(limits).enumerate() {
                let is_beyond = if law == Law::Below { *y <= limit } else { *y >= limit };
                // A row without a limit has a value.
                if is_beyond && found.iter().any(|(own, _)| *own == k) {
                    bail!(BAD_OPTION, "`{y_name}` is below one limit and above the other"; help: "give the lower limit as `below`");
                }
                if is_beyond {
                    *y = limit;
                    found.push((k, law));
                }
            }
        }
        Ok((y, found))
    }

    fn output(
        &self,
        y_name: &str,
        requested: &ColumnEntry,
        notes: &mut Notes,
    ) -> Result<Series, Fault> {
        let table = self.table;
        let column = data::column(table, requested, y_name, notes)?;
        note_suspicious(requested.column.as_deref().unwrap_or(y_name), &column, (table, notes));
        let scaling = relative::scaling(requested, (self.label, y_name))?;
        let own_unit = self.unit_of_output(y_name, requested, &column);
        let measured = data::in_unit(&column, y_name, &own_unit, requested, (table, notes))?;
        note_unit_of_sigma(y_name, requested, (&measured, &own_unit.symbol), notes);
        let count = measured.values.len();
        data::same_length([self.x_name, y_name], [self.x.len(), count])?;
        let sigma = self.sigma(y_name, requested, (&own_unit, &measured))?;
        let measured_in = |row: &usize| {
            self.x.get(*row).is_some_and(|x| x.is_finite()) && measured.values[*row].is_finite()
        };
        let has_sigma = |row: &usize| match &sigma {
            Sigma::Given(values) => values.get(*row).is_none_or(|sigma| sigma.is_finite()),
            _ => true,
        };
        let complete = |row: &usize| measured_in(row) && has_sigma(row);
        let (rows, missing): (Vec<usize>, Vec<usize>) = (0..count).partition(complete);
        let without_sigma = missing.iter().copied().filter(measured_in);
        note_missing_sigma(y_name, without_sigma.collect(), &column, notes);
        let rows = self.comparable(rows, (y_name, &column), notes);
        let first_row = column.about.rows_before + 1;
        let sigma = self.of_rows(sigma, y_name, &rows, count)?;
        if rows.is_empty() {
            bail!(BAD_OPTION, "`{y_name}` of {} has no points", self.experiment);
        }
        let values = || rows.iter().map(|row| measured.values[*row]);
        note_temperature((y_name, "outputs"), &own_unit, (requested, &column), values(), notes);
        note_constant(y_name, values(), notes);
        let (y, censored) = self.censored(y_name, requested, (&rows, &measured))?;
        Ok(Series {
            role: Role::Data,
            experiment: self.experiment.to_owned(),
            y_name: y_name.to_owned(),
            y_unit: data::shown_unit(&own_unit.symbol, requested, &column.about),
            x_name: self.x_name.to_owned(),
            x_unit: self.unit(self.x_name).symbol,
            file: self.entry.data.display().to_string(),
            x: rows.iter().map(|row| self.x[*row]).collect(),
            y,
            weight: self.weight(y_name, requested)?,
            relative: Vec::new(),
            sigma,
            law: Law::Normal,
            scaling,
            joint: None,
            censored,
            column: requested.column.clone().unwrap_or_else(|| y_name.to_owned()),
            x_column: self.x_column.to_owned(),
            rows: rows.iter().map(|row| first_row + row).collect(),
            missing: missing.iter().map(|row| first_row + row).collect(),
        })
    }

    /// The standard deviations of all rows, in the unit of the output.
    fn sigma(
        &self,
        y_name: &str,
        requested: &ColumnEntry,
        (unit, measured): (&VariableUnit, &Measured),
    ) -> Result<Sigma, Fault> {
        let (entry, count) = (requested.sigma.as_ref(), measured.values.len());
        let factor = data::sigma_factor(self.table, entry, unit, measured.factor);
        sigma::sigma(entry, (y_name, self.model), self.table, factor, count)
    }

    /// The unit in which an output is compared; arbitrary units are those of the data, as they are.
    fn unit_of_output(
        &self,
        y_name: &str,
        requested: &ColumnEntry,
        column: &Column,
    ) -> VariableUnit {
        let own = self.unit(y_name);
        if requested.scale.is_none() {
            return own;
        }
        let given = requested.unit.clone().or_else(|| column.about.unit.clone());
        VariableUnit { symbol: given.unwrap_or_default(), ..own }
    }

    /// Over time, the rows that can be compared with the simulation: those since it begins, and of
    /// values before an event those that are followed by the ones after it.
    fn comparable(
        &self,
        rows: Vec<usize>,
        (y_name, column): (&str, &Column),
        notes: &mut Notes,
    ) -> Vec<usize> {
        if self.x_name != "time" {
            return rows;
        }
        let (early, rows): (Vec<usize>, Vec<usize>) =
            rows.into_iter().partition(|row| Some(self.x[*row]) < self.entry.start_time);
        if let (Some(first), Some(last)) = (early.first(), early.last()) {
            notes.add(format!(
                "{}: `{y_name}` is not compared before the simulation begins at {} s ({} to {})",
                self.experiment,
                self.start,
                column.place(*first),
                column.place(*last)
            ));
        }
        if time_axis::are_replicates(&self.x) {
            return rows;
        }
        let mut skipped = Vec::new();
        let mut kept = Vec::with_capacity(rows.len());
        for (place, &row) in rows.iter().enumerate() {
            let stamp = self.x[row];
            let is_twice =
                self.x.get(row + 1) == Some(&stamp) && (row == 0 || self.x[row - 1] != stamp);
            let lacks_partner = is_twice && rows.get(place + 1) != Some(&(row + 1));
            // Nothing is simulated before the inputs jump at the start.
            let is_at_start = is_twice && stamp == self.start && !self.entry.inputs.is_empty();
            let list = if lacks_partner || is_at_start { &mut skipped } else { &mut kept };
            list.push(row);
        }
        for row in skipped {
            notes.add(format!(
                "{}: `{y_name}` in {} is not compared: it precedes an event at {} s, {}",
                self.experiment,
                column.place(row),
                self.x[row],
                match self.x[row] == self.start {
                    true => "where the simulation begins",
                    false => "after which there is no value",
                }
            ));
        }
        kept
    }

    /// Given deviations of the rows that are complete, of so many in all.
    fn of_rows(
        &self,
        mut sigma: Sigma,
        y_name: &str,
        rows: &[usize],
        count: usize,
    ) -> Result<Sigma, Fault> {
        if let Sigma::Given(values) = &mut sigma {
            if values.len() != count {
                bail!(
                    BAD_OPTION,
                    "the sigma of `{y_name}` in {} has {} rows, but `{y_name}` has {count}",
                    self.experiment,
                    values.len()
                );
            }
            *values = rows.iter().map(|row| values[*row]).collect();
            values.iter().try_for_each(|value| sigma::positive(y_name, *value))?;
        }
        Ok(sigma)
    }

    fn weight(&self, y_name: &str, requested: &ColumnEntry) -> Result<f64, Fault> {
        let weight =
            requested.weight.map_or(1.0, |weight| weight.0) * self.entry.weight.unwrap_or(1.0);
        if !is_weight(weight) {
            bail!(BAD_OPTION, "the weight of `{y_name}` in {} is {weight}", self.experiment);
        }
        Ok(weight)
    }
}

fn is_weight(weight: f64) -> bool {
    weight.is_finite() && weight > 0.0
}

/// Temperatures whose file gives no unit and whose values are usual in the other one, of a variable in
/// this table of the problem.
pub(super) fn note_temperature(
    (name, place): (&str, &str),
    VariableUnit { symbol: unit, is_relative, .. }: &VariableUnit,
    (entry, column): (&ColumnEntry, &Column),
    values: impl Iterator<Item = f64>,
    notes: &mut Notes,
) {
    // From -23 to 77 °C: in K what laboratories and buildings have, in °C what few ovens keep within.
    const ROOM_IN_KELVIN: [f64; 2] = [250.0, 350.0];
    // Below 100 K there is little but cryogenics.
    const ROOM_IN_CELSIUS: [f64; 2] = [-50.0, 100.0];
    let has_unit = entry.unit.is_some() || entry.factor.is_some() || column.about.unit.is_some();
    let ([from, to], other) = match unit.as_str() {
        "degC" => (ROOM_IN_KELVIN, "K"),
        "K" => (ROOM_IN_CELSIUS, "degC"),
        _ => return,
    };
    let (low, high) =
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), y| (low.min(y), high.max(y)));
    if !has_unit && !is_relative && low >= from && high <= to {
        notes.warn(format!(
            "the file gives no unit for `{name}`, which the model has in {unit}; its values lie \
             between {low} and {high}: if they are in {other}, write `unit = \"{other}\"` in its \
             entry of `{place}`"
        ));
    }
}

/// Values that are all equal, as those of a sensor that is not connected.
fn note_constant(y_name: &str, mut values: impl ExactSizeIterator<Item = f64>, notes: &mut Notes) {
    let count = values.len();
    let Some(first) = values.next().filter(|_| count > 3) else { return };
    if values.all(|value| value == first) {
        notes.warn(format!(
            "all {count} values of `{y_name}` are {first}: they determine no dynamics; check the \
             sensor and the column"
        ));
    }
}

/// Points that are omitted because only their sigma is missing.
fn note_missing_sigma(y_name: &str, rows: Vec<usize>, column: &Column, notes: &mut Notes) {
    const SHOWN: usize = 10;
    if rows.is_empty() {
        return;
    }
    let places: Vec<String> = rows.iter().take(SHOWN).map(|row| column.place(*row)).collect();
    let more = if rows.len() > SHOWN { ", …" } else { "" };
    let points = if rows.len() == 1 { "point" } else { "points" };
    notes.add(format!(
        "{} {points} of `{y_name}` without a sigma omitted: {}{more}",
        rows.len(),
        places.join(", ")
    ));
}

/// Warns of values that may not be measurements.
fn note_suspicious(name: &str, column: &Column, (table, notes): (&MatFile, &mut Notes)) {
    notes.warn_about(table, fault_codes::codes(name, column));
    notes.warn_about(table, fault_codes::cut_off(name, column));
    notes.warn_about(table, fault_codes::frozen(name, column));
}

/// Where values were converted, a number for sigma is taken in the unit of the model.
fn note_unit_of_sigma(
    y_name: &str,
    requested: &ColumnEntry,
    (measured, unit): (&Measured, &str),
    notes: &mut Notes,
) {
    if let (true, Some(SigmaEntry::Number(sigma))) = (measured.factor != 1.0, &requested.sigma) {
        notes.add(format!(
            "`sigma = {sigma}` of `{y_name}` is in {}, the unit of the model",
            in_words(unit)
        ));
    }
}
