//! Inputs of a model that follow recorded columns.
//!
//! Between its samples a recorded input was constant, kept by a switch or a controller, or it went on steadily:
//! the file does not say which, and a step read as a ramp shifts time constants. An entry says
//! `interpolation = "hold"` or `"linear"`; else inputs that move in steps are kept constant (zero-order hold) and others joined by
//! lines, and a note says so.

use super::data::{self, Notes};
use super::enclosing_class::{self, EnclosingClass};
use super::file::{ColumnEntry, ExperimentEntry};
use super::flat::{unit_in, variable_of};
use crate::bail;
use crate::diag::{At as _, Diagnostic, Fault, suggest};
use crate::fault;
use crate::flatten::{BaseType, FlatModel, Variability};
use crate::mat::{Column, MatFile};
use crate::registry::BAD_OPTION;
use crate::source::Span;
use crate::syntax::ast::CausalityPrefix;
use std::fmt::Write;

/// How an input goes on between its samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Between {
    Constant,
    Linear,
}

/// Tables for the inputs that follow columns; `x` are the times unless the entry names other ones.
pub(super) fn inputs(
    entry: &ExperimentEntry,
    table: &MatFile,
    x: (&str, &[f64]),
    flat: &FlatModel,
    enclosing: &mut EnclosingClass,
    notes: &mut Notes,
) -> Result<(), Diagnostic> {
    let times = match &entry.input_time {
        Some(name) => own_times(name, table, notes).at(entry.places.data)?,
        None => (x.0, x.1.to_vec()),
    };
    for (name, wanted) in &entry.inputs {
        let place = entry.places.column(name);
        let input = (name.as_str(), &wanted.entry());
        let base = type_of_input(name, flat).at(place)?;
        let (pairs, between) =
            followed(input, table, (times.0, &times.1), (flat, &base), notes).at(place)?;
        declare((name, &base, place), &pairs, between, enclosing).at(place)?;
    }
    Ok(())
}

/// The type of an input of the model.
fn type_of_input(name: &str, flat: &FlatModel) -> Result<BaseType, Fault> {
    let inputs = || {
        let is_input = |v: &&crate::flatten::Variable| {
            v.causality == Some(CausalityPrefix::Input) && v.binding.is_none()
        };
        let names: Vec<String> = flat
            .variables
            .values()
            .filter(is_input)
            .map(|variable| format!("`{}`", variable.name))
            .collect();
        match names.is_empty() {
            true => format!("`{}` has no inputs", flat.name),
            false => format!("the inputs of `{}` are {}", flat.name, names.join(", ")),
        }
    };
    let Some(variable) = variable_of(flat, name) else {
        let names = flat.variables.keys().map(|name| &**name);
        return Err(fault!(BAD_OPTION, "`{}` has no input `{name}`", flat.name)
            .help_if(suggest::did_you_mean(name, names))
            .help(inputs()));
    };
    if variable.variability <= Variability::Parameter {
        bail!(BAD_OPTION, "`{name}` is a parameter, not an input"; help: "{}", inputs());
    }
    match &variable.base {
        base @ (BaseType::Real | BaseType::Integer | BaseType::Boolean) => Ok(base.clone()),
        _ => bail!(BAD_OPTION, "`{name}` is not a number; it cannot follow a column of the data"),
    }
}

/// The column of time of the inputs, in seconds.
fn own_times<'a>(
    name: &'a str,
    table: &MatFile,
    notes: &mut Notes,
) -> Result<(&'a str, Vec<f64>), Fault> {
    let named = ColumnEntry::named(Some(name.to_owned()));
    let column = data::column(table, &named, name, notes)?;
    let time = data::in_unit(&column, "time", "s", &named, (table, notes))?;
    Ok((name, time.values))
}

/// The samples of an input, times and values, and how it goes on between them.
fn followed(
    (name, wanted): (&str, &ColumnEntry),
    table: &MatFile,
    (time_name, time): (&str, &[f64]),
    (flat, base): (&FlatModel, &BaseType),
    notes: &mut Notes,
) -> Result<(Vec<(f64, f64)>, Between), Fault> {
    let column = data::column(table, wanted, name, notes)?;
    notes.about(table, column.missing.clone());
    data::same_length([time_name, name], [time.len(), column.values.len()])?;
    check_type(name, base, &column)?;
    let unit = unit_in(flat, name);
    let values = data::in_unit(&column, name, &unit, wanted, (table, notes))?.values;
    let pairs: Vec<(f64, f64)> = time
        .iter()
        .copied()
        .zip(values)
        .filter(|(time, value)| time.is_finite() && value.is_finite())
        .collect();
    if pairs.is_empty() {
        bail!(BAD_OPTION, "the input `{name}` has no points");
    }
    if let Some(row) = pairs.windows(2).position(|pair| pair[1].0 < pair[0].0) {
        bail!(
            BAD_OPTION,
            "the time values of the input `{name}` decrease from {} to {} at {}",
            pairs[row].0, pairs[row + 1].0, column.place(row + 1);
            help: "sort the rows, or write consecutive runs to separate files"
        );
    }
    let between = match base {
        BaseType::Real => between(name, wanted, &pairs, notes)?,
        _ if wanted.interpolation.as_deref() == Some("linear") => bail!(
            BAD_OPTION,
            "the input `{name}` is not Real and cannot be interpolated linearly";
            help: "remove `interpolation`: each value is held until the next sample"
        ),
        _ => Between::Constant,
    };
    Ok((pairs, between))
}

/// Refuses values that an input of this type cannot have.
fn check_type(name: &str, base: &BaseType, column: &Column) -> Result<(), Fault> {
    let (kind, fits): (&str, fn(f64) -> bool) = match base {
        BaseType::Boolean => ("Boolean", |value| value == 0.0 || value == 1.0),
        BaseType::Integer => ("Integer", |value| value.fract() == 0.0),
        _ => return Ok(()),
    };
    let wrong = column.values.iter().position(|value| value.is_finite() && !fits(*value));
    let Some(row) = wrong else { return Ok(()) };
    let allowed = if kind == "Boolean" { "0 or 1" } else { "whole numbers" };
    bail!(
        BAD_OPTION,
        "the input `{name}` is {kind}, but its column has the value {} in {}",
        column.values[row],
        column.place(row);
        help: "use a column of {allowed}"
    )
}

fn declare(
    (name, base, place): (&str, &BaseType, Span),
    pairs: &[(f64, f64)],
    between: Between,
    enclosing: &mut EnclosingClass,
) -> Result<(), Fault> {
    let rows: Vec<String> = pairs.iter().map(|(t, v)| format!("{t:e},{v:e}")).collect();
    let table = enclosing_class::own_name("data of", name);
    let smoothness = match between {
        Between::Constant => "ConstantSegments",
        Between::Linear => "LinearSegments",
    };
    _ = writeln!(
        enclosing.declarations,
        "  Modelica.Blocks.Sources.CombiTimeTable {table}(table = [{}], smoothness = Modelica.Blocks.Types.Smoothness.{smoothness}, extrapolation = Modelica.Blocks.Types.Extrapolation.HoldLastPoint);",
        rows.join(";")
    );
    enclosing.elements.push((table.clone(), format!("the data of {name}")));
    let value = match base {
        BaseType::Boolean => format!("{table}.y[1] > 0.5"),
        BaseType::Integer => format!("integer({table}.y[1] + 0.5)"),
        _ => format!("{table}.y[1]"),
    };
    let value = enclosing_class::expression(&value, None);
    let value = value.map_err(|error| fault!(BAD_OPTION, "{}", error.message))?;
    enclosing.bind(name, value, place);
    Ok(())
}

/// What an entry says of the values between samples, or what the values look like.
fn between(
    name: &str,
    entry: &ColumnEntry,
    pairs: &[(f64, f64)],
    notes: &mut Notes,
) -> Result<Between, Fault> {
    match entry.interpolation.as_deref() {
        Some("hold") => return Ok(Between::Constant),
        Some("linear") => return Ok(Between::Linear),
        Some(other) => bail!(
            BAD_OPTION,
            "the interpolation of the input `{name}` is `{other}`";
            help: "write \"hold\" (zero-order hold) or \"linear\" (linear interpolation)"
        ),
        None => {}
    }
    if pairs.windows(2).all(|pair| pair[0].1 == pair[1].1) {
        return Ok(Between::Constant);
    }
    if moves_in_steps(pairs) {
        notes.add(format!(
            "the input `{name}` is piecewise constant: each value is held until the next sample; \
             for linear interpolation write `interpolation = \"linear\"`"
        ));
        return Ok(Between::Constant);
    }
    notes.add(format!(
        "the input `{name}` is interpolated linearly between samples; if each value holds until \
         the next, write `interpolation = \"hold\"`"
    ));
    Ok(Between::Linear)
}

/// Whether values change like those of a switch: at most half of the intervals change anything, and
/// either there are at most three levels, or no two intervals side by side change, as they do in a ramp.
fn moves_in_steps(pairs: &[(f64, f64)]) -> bool {
    let changes: Vec<bool> = pairs.windows(2).map(|pair| pair[0].1 != pair[1].1).collect();
    let changed = changes.iter().filter(|changed| **changed).count();
    if changed == 0 || 2 * changed > changes.len() {
        return false;
    }
    let mut levels: Vec<f64> = pairs.iter().map(|(_, value)| *value).collect();
    levels.sort_by(f64::total_cmp);
    levels.dedup();
    levels.len() <= 3 || !changes.windows(2).any(|pair| pair[0] && pair[1])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_and_ramps_are_told_apart_by_their_changes() {
        let pairs = |values: &[f64]| -> Vec<(f64, f64)> {
            values.iter().enumerate().map(|(k, value)| (k as f64, *value)).collect()
        };
        for steps in [
            &[0.0, 0.0, 0.0, 1.0, 1.0, 1.0][..],
            &[0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0],
            &[1.0, 1.0, 2.0, 2.0, 3.0, 3.0, 7.0, 7.0],
        ] {
            assert!(moves_in_steps(&pairs(steps)), "{steps:?}");
        }
        for others in [
            &[0.0, 1.0, 2.0, 3.0][..],
            &[0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 2.0, 3.0, 4.0, 4.0, 4.0, 4.0, 4.0],
            &[0.0, 1.0, 0.0, 1.0],
            &[2.0, 2.0, 2.0],
        ] {
            assert!(!moves_in_steps(&pairs(others)), "{others:?}");
        }
    }
}
