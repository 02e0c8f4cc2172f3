//! Columns of data files as values of the model's variables: units are converted, what is missing or
//! strange is noted.

use super::file::{ColumnEntry, SigmaEntry};
use crate::bail;
use crate::diag::Fault;
use crate::mat::{About, Column, MatFile};
use crate::registry::BAD_OPTION;
use crate::units::{in_words, written};

/// A column in the unit of its variable.
pub(super) struct Measured {
    /// NaN where a value is missing.
    pub values: Vec<f64>,
    /// What the numbers of the file were multiplied with.
    pub factor: f64,
}

/// Sentences about the data, each once, in the order in which they came up.
#[derive(Default)]
pub(super) struct Notes(Vec<String>);

impl Notes {
    pub(super) fn add(&mut self, sentence: String) {
        if !self.0.contains(&sentence) {
            self.0.push(sentence);
        }
    }

    /// Notes about a file, with its name.
    pub(super) fn about(&mut self, table: &MatFile, sentences: impl IntoIterator<Item = String>) {
        sentences
            .into_iter()
            .for_each(|sentence| self.add(format!("{}: {sentence}", table.file_name)));
    }

    pub(super) fn into_sentences(self) -> Vec<String> {
        self.0
    }
}

/// The column of an entry as the file has it, `default` being its name unless the entry has one. What
/// is missing is not noted, because points are left out in sight, inputs are not.
///
/// # Errors
///
/// A column that is not there or cannot be read as numbers.
pub(super) fn column(
    table: &MatFile,
    entry: &ColumnEntry,
    default: &str,
    notes: &mut Notes,
) -> Result<Column, Fault> {
    let column = table.column(entry.column.as_deref().unwrap_or(default))?;
    notes.about(table, column.about.notes.iter().cloned());
    Ok(column)
}

/// Values of a column in the unit of the variable `name`: times the entry's factor if it has one, else
/// converted from the unit of the entry or of the file. Where one of the units is not known, nothing is
/// assumed.
///
/// # Errors
///
/// A unit that measures something else than that of the variable.
pub(super) fn in_unit(
    column: &Column,
    name: &str,
    unit: &str,
    entry: &ColumnEntry,
    (table, notes): (&MatFile, &mut Notes),
) -> Result<Measured, Fault> {
    let scaled = |factor: f64, f: &dyn Fn(f64) -> f64| Measured {
        values: column.values.iter().map(|value| f(*value)).collect(),
        factor,
    };
    if let Some(factor) = entry.factor {
        return Ok(scaled(factor, &|value| value * factor));
    }
    let unchanged = || scaled(1.0, &|value| value);
    let explicit = entry.unit.as_deref();
    let Some(given) = explicit.or(column.about.unit.as_deref()) else { return Ok(unchanged()) };
    if given == unit || unit.is_empty() && explicit.is_none() {
        return Ok(unchanged());
    }
    let own = entry.column.as_deref().unwrap_or(name);
    let (Some(from), Some(to)) = (written(given), written(unit)) else {
        if explicit.is_some() {
            return Err(incompatible(name, unit, given));
        }
        notes.about(table, [format!(
            "`{own}` is in {given} and `{name}` is in {unit}; these units are not comparable, so \
             the values are not converted"
        )]);
        return Ok(unchanged());
    };
    let Some(conversion) = from.to(to) else { return Err(incompatible(name, unit, given)) };
    if conversion.is_identity() {
        return Ok(unchanged());
    }
    let added = match conversion.offset {
        0.0 => String::new(),
        offset => format!(", plus {offset}"),
    };
    let times = match conversion.factor {
        1.0 => String::new(),
        factor => format!(", times {factor}"),
    };
    notes.about(table, [format!("`{own}` is converted from {given} to {unit}{times}{added}")]);
    Ok(scaled(conversion.factor, &|value| conversion.apply(value)))
}

/// The unit that a variable is shown with: its own, or that of its values where it has none and they
/// were not multiplied.
pub(super) fn shown_unit(own: &str, entry: &ColumnEntry, about: &About) -> String {
    let of_values = entry.unit.as_ref().or(about.unit.as_ref());
    match of_values.filter(|_| own.is_empty() && entry.factor.is_none()) {
        Some(unit) => unit.clone(),
        None => own.to_owned(),
    }
}

/// The times of inputs that follow the rows of X: X itself, in seconds where it is time.
///
/// # Errors
///
/// As [`in_unit`].
pub(super) fn as_time(
    x_name: &str,
    column: &Column,
    entry: &ColumnEntry,
    about: (&MatFile, &mut Notes),
) -> Result<Vec<f64>, Fault> {
    match x_name {
        "time" => Ok(in_unit(column, x_name, "s", entry, about)?.values),
        _ => Ok(column.values.clone()),
    }
}

fn incompatible(name: &str, unit: &str, given: &str) -> Fault {
    crate::fault!(
        BAD_OPTION,
        "`{name}` is in {}, but its column is in \
                               {given}",
        in_words(unit)
    )
    .help(
        "select the correct column, or give the `factor` that converts its values to the unit of \
         the model",
    )
}

/// What a column of standard deviations is multiplied with: converted from its own unit where the file
/// gives one, else as the values are.
pub(super) fn sigma_factor(
    table: &MatFile,
    sigma: Option<&SigmaEntry>,
    unit: &str,
    values: f64,
) -> f64 {
    let Some(SigmaEntry::Words(name)) = sigma else { return values };
    let own = table.column(name).ok().and_then(|column| written(&column.about.unit?));
    let conversion = own.zip(written(unit)).and_then(|(own, unit)| own.to(unit));
    conversion.map_or(values, |conversion| conversion.factor)
}

/// Refuses rows of X and Y that are not pairs.
///
/// # Errors
///
/// Columns of different lengths.
pub(super) fn same_length(names: [&str; 2], lengths: [usize; 2]) -> Result<(), Fault> {
    if lengths[0] != lengths[1] {
        bail!(
            crate::identify::errors::DATA_SIZES_DIFFER,
            "`{}` has {} values, but `{}` has {}", names[0], lengths[0], names[1], lengths[1];
            help: "use columns of the same experiment"
        );
    }
    Ok(())
}
