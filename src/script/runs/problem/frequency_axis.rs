//! The frequencies of a spectrum: their column, in Hz or radians per second.

use super::file::{ColumnEntry, ExperimentEntry};
use crate::diag::Fault;
use crate::identify::FREQUENCY;
use crate::mat::MatFile;
use crate::registry::BAD_OPTION;
use crate::{bail, fault};
use std::f64::consts::TAU;

/// Columns of frequencies by their names, without case and unit.
const FREQUENCIES: [&str; 4] = ["freq", "frequency", "f", "omega"];

/// X: its entry, the variable that it is, and its column.
///
/// # Errors
///
/// As [`column`].
pub(super) fn x_of(
    entry: &ExperimentEntry,
    table: &MatFile,
) -> Result<(ColumnEntry, String, String), Fault> {
    let x = column(entry, table)?;
    let column = x.column.clone().unwrap_or_else(|| FREQUENCY.to_owned());
    Ok((x, FREQUENCY.to_owned(), column))
}

/// The column of frequencies, with the factor that makes them Hz.
///
/// # Errors
///
/// Another variable as X, a file without such a column.
pub(super) fn column(entry: &ExperimentEntry, table: &MatFile) -> Result<ColumnEntry, Fault> {
    let x = named(entry, table)?;
    let own = x.column.as_deref().unwrap_or(FREQUENCY);
    let unit = x.unit.clone().or_else(|| table.column(own).ok().and_then(|own| own.about.unit));
    let is_angular = match unit.as_deref() {
        Some("rad/s" | "rad.s-1") => true,
        Some(unit @ ("1/s" | "s-1")) if x.factor.is_none() => {
            bail!(BAD_OPTION, "frequencies in {unit} may be Hz or rad/s"; help: "write `x = {{ column = \"{own}\", unit = \"Hz\" }}`, or `unit = \"rad/s\"`")
        }
        None => own.to_lowercase().starts_with("omega"),
        Some(_) => false,
    };
    let factor = x.factor.or(is_angular.then_some(1.0 / TAU));
    Ok(ColumnEntry { factor, ..x })
}

fn named(entry: &ExperimentEntry, table: &MatFile) -> Result<ColumnEntry, Fault> {
    let variable = Some(FREQUENCY.to_owned());
    if let Some(x) = &entry.x {
        let own = x.entry();
        if own.variable.as_deref().is_some_and(|variable| variable != FREQUENCY) {
            bail!(BAD_OPTION, "a spectrum is measured over the frequency"; help: "write `x = {{ column = \"…\" }}` with the column of the frequencies")
        }
        return Ok(ColumnEntry { variable, ..own });
    }
    let is_frequency = |name: &&str| {
        let plain = name.split(['/', '[', '(', ' ']).next().unwrap_or_default();
        FREQUENCIES.contains(&plain.to_lowercase().as_str())
    };
    let names: Vec<&String> = table.arrays.keys().collect();
    let found = names.iter().map(|name| name.as_str()).find(is_frequency);
    let column = found.ok_or_else(|| {
        fault!(BAD_OPTION, "{} has no column of frequencies", table.file_name)
            .help("name it: `x = { column = \"…\" }`")
    })?;
    Ok(ColumnEntry { variable, ..ColumnEntry::named(Some(column.to_owned())) })
}
