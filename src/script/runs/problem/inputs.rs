//! Inputs of a model that follow recorded columns.
//!
//! Between its samples a recorded input was constant, kept by a switch or a controller, or it went on steadily:
//! the file does not say which, and a step read as a ramp shifts time constants. An entry says
//! `interpolation = "hold"` or `"linear"`; else inputs that move in steps are kept constant (zero-order hold) and others joined by
//! lines, and a note says so.

use super::data::{self, Notes};
use super::enclosing_class::EnclosingClass;
use super::file::{ColumnEntry, ExperimentEntry};
use crate::bail;
use crate::diag::{At as _, Diagnostic, Fault};
use crate::mat::MatFile;
use crate::registry::BAD_OPTION;
use std::fmt::Write;

/// How an input goes on between its samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Between {
    Constant,
    Linear,
}

/// Units of inputs by name; empty where the model gives none.
pub(super) type UnitOf<'u> = &'u dyn Fn(&str) -> String;

/// Whether a column of an input has a unit, so that the model's is needed.
pub(super) fn have_units(entry: &ExperimentEntry, table: &MatFile) -> bool {
    entry.inputs.iter().any(|(name, wanted)| {
        let wanted = wanted.entry();
        let column = table.column(wanted.column.as_deref().unwrap_or(name));
        wanted.unit.is_some() || column.is_ok_and(|column| column.about.unit.is_some())
    })
}

/// Tables for the inputs that follow columns; `x` are the times unless the entry names other ones.
pub(super) fn inputs(
    entry: &ExperimentEntry,
    table: &MatFile,
    x: (&str, &[f64]),
    unit: UnitOf<'_>,
    enclosing: &mut EnclosingClass,
    notes: &mut Notes,
) -> Result<(), Diagnostic> {
    if entry.inputs.is_empty() {
        return Ok(());
    }
    let times = match &entry.input_time {
        Some(name) => own_times(name, table, notes).at(entry.places.data)?,
        None => (x.0, x.1.to_vec()),
    };
    for (number, (name, wanted)) in entry.inputs.iter().enumerate() {
        let input = (name.as_str(), &wanted.entry());
        let (pairs, between) = followed(input, table, (times.0, &times.1), unit, notes)
            .at(entry.places.column(name))?;
        declare(number, name, &pairs, between, enclosing);
    }
    Ok(())
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
    unit: UnitOf<'_>,
    notes: &mut Notes,
) -> Result<(Vec<(f64, f64)>, Between), Fault> {
    let column = data::column(table, wanted, name, notes)?;
    notes.about(table, column.missing.clone());
    data::same_length([time_name, name], [time.len(), column.values.len()])?;
    let values = data::in_unit(&column, name, &unit(name), wanted, (table, notes))?.values;
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
    let between = between(name, wanted, &pairs, notes)?;
    Ok((pairs, between))
}

fn declare(
    number: usize,
    name: &str,
    pairs: &[(f64, f64)],
    between: Between,
    enclosing: &mut EnclosingClass,
) {
    let rows: Vec<String> = pairs.iter().map(|(t, v)| format!("{t:e},{v:e}")).collect();
    let table = format!("gapi_input_{number}");
    let smoothness = match between {
        Between::Constant => "ConstantSegments",
        Between::Linear => "LinearSegments",
    };
    _ = writeln!(
        enclosing.declarations,
        "  Modelica.Blocks.Sources.CombiTimeTable {table}(table = [{}], smoothness = Modelica.Blocks.Types.Smoothness.{smoothness}, extrapolation = Modelica.Blocks.Types.Extrapolation.HoldLastPoint);",
        rows.join(";")
    );
    enclosing.modifications.push(format!("{name} = {table}.y[1]"));
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
