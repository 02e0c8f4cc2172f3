//! Columns of data files as values of the model's variables: units are converted, what is missing or
//! strange is noted.

use super::file::{ColumnEntry, SigmaEntry};
use crate::Session;
use crate::bail;
use crate::diag::{Diagnostic, Fault};
use crate::identify::problem::{Finding, FindingKind, Severity};
use crate::mat::errors::DATA_NOTE;
use crate::mat::{About, Column, MatFile, Version};
use crate::models::variable_unit::VariableUnit;
use crate::registry::BAD_OPTION;
use crate::source::Span;
use crate::units::{Conversion, Unit, in_words, suggested, written};

/// A column in the unit of its variable.
pub(super) struct Measured {
    /// NaN where a value is missing.
    pub values: Vec<f64>,
    /// What the numbers of the file were multiplied with.
    pub factor: f64,
}

/// A sentence about the data.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Note {
    pub sentence: String,
    pub severity: Severity,
}

impl Note {
    /// Says it before a run.
    pub(super) fn say(&self, session: &mut Session) {
        match self.severity {
            Severity::Information => session.note(DATA_NOTE, self.sentence.clone()),
            _ => session.warn(DATA_NOTE, self.sentence.clone()),
        }
    }

    /// What may change a result, as a diagnostic at this place.
    pub(super) fn warning(self, place: Span) -> Option<Diagnostic> {
        let is_warning = self.severity != Severity::Information;
        is_warning.then(|| Fault::new(DATA_NOTE, self.sentence).at(place).warning())
    }

    pub(super) fn finding(self) -> Finding {
        Finding::new(FindingKind::Data, self.sentence).severity(self.severity)
    }
}

/// Sentences about the data, each once, in the order in which they came up.
#[derive(Default)]
pub(super) struct Notes(Vec<Note>);

impl Notes {
    pub(super) fn add(&mut self, sentence: String) {
        self.push(sentence, Severity::Information);
    }

    /// Adds what may change the result.
    pub(super) fn warn(&mut self, sentence: String) {
        self.push(sentence, Severity::Warning);
    }

    fn push(&mut self, sentence: String, severity: Severity) {
        if !self.0.iter().any(|known| known.sentence == sentence) {
            self.0.push(Note { sentence, severity });
        }
    }

    /// Notes about a file, with its name.
    pub(super) fn about(&mut self, table: &MatFile, sentences: impl IntoIterator<Item = String>) {
        sentences
            .into_iter()
            .for_each(|sentence| self.add(format!("{}: {sentence}", table.file_name)));
    }

    /// Warnings about a file, with its name.
    pub(super) fn warn_about(
        &mut self,
        table: &MatFile,
        sentences: impl IntoIterator<Item = String>,
    ) {
        sentences
            .into_iter()
            .for_each(|sentence| self.warn(format!("{}: {sentence}", table.file_name)));
    }

    pub(super) fn into_notes(self) -> Vec<Note> {
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
    variable: &VariableUnit,
    entry: &ColumnEntry,
    about: (&MatFile, &mut Notes),
) -> Result<Measured, Fault> {
    let mut measured = converted(column, name, variable, entry, about)?;
    if let Some(tried) = entry.tried {
        measured.values.iter_mut().for_each(|value| *value *= tried);
    }
    Ok(measured)
}

fn converted(
    column: &Column,
    name: &str,
    variable: &VariableUnit,
    entry: &ColumnEntry,
    (table, notes): (&MatFile, &mut Notes),
) -> Result<Measured, Fault> {
    let unit = variable.symbol.as_str();
    let scaled = |factor: f64, f: &dyn Fn(f64) -> f64| Measured {
        values: column.values.iter().map(|value| f(*value)).collect(),
        factor,
    };
    if let Some(factor) = entry.factor {
        return Ok(scaled(factor, &|value| value * factor));
    }
    let unchanged = || scaled(1.0, &|value| value);
    let explicit = entry.unit.as_deref();
    let own = entry.column.as_deref().unwrap_or(name);
    let Some(given) = explicit.or_else(|| unit_of(&column.about, variable)) else {
        note_no_unit(column, [own, name, unit], (table, notes));
        return Ok(unchanged());
    };
    if given == unit {
        return Ok(unchanged());
    }
    if unit.is_empty() && explicit.is_none() {
        let found = variable.definitions.find(given);
        notes.about(table, found.and_then(|found| unit_alone([own, given, name], found)));
        return Ok(unchanged());
    }
    let contradictions = variable.contradictions([given, unit]);
    let refused = || incompatible(name, unit, given).help_if(contradictions.first().cloned());
    let find = |name: &str| variable.definitions.find(name);
    let (Some(from), Some(to)) = (find(given), find(unit)) else {
        if explicit.is_some() {
            return Err(refused());
        }
        notes.warn_about(table, [format!(
            "`{own}` is in {given} and `{name}` is in {unit}; these units are not comparable, so \
             the values are not converted"
        )]);
        return Ok(unchanged());
    };
    if let Some(factors) = from.angles_differ(to) {
        return Err(unclear_angles([own, given, name, unit], factors));
    }
    let Some(absolute) = from.to(to) else { return Err(refused()) };
    notes.warn_about(table, contradictions);
    let conversion = if variable.is_relative { absolute.of_differences() } else { absolute };
    if absolute.is_identity() {
        return Ok(unchanged());
    }
    let words = conversion.in_words() + zero_of_scale(conversion, absolute);
    notes.about(table, [format!("`{own}` is converted from {given} to {unit}{words}")]);
    Ok(scaled(conversion.factor, &|value| conversion.apply(value)))
}

/// Says what a column without a known unit is read in.
fn note_no_unit(
    column: &Column,
    [own, name, unit]: [&str; 3],
    (table, notes): (&MatFile, &mut Notes),
) {
    if let Some(given) = &column.about.unknown_unit {
        notes.warn_about(table, [unknown_unit([own, given, name, unit])]);
        return;
    }
    let is_measured = table.is_table() && table.version != Version::Results && name != "time";
    let suggested = suggested_unit(own, unit).filter(|_| is_measured);
    let sentence = |suggested| {
        format!(
            "`{own}` is read in {unit}; the name suggests {suggested}: write `unit = \"{suggested}\"` in \
             its entry"
        )
    };
    notes.about(table, suggested.map(sentence));
}

/// A sentence about a column whose variable has no unit, where its own is not a coherent one.
fn unit_alone([own, given, name]: [&str; 3], unit: Unit) -> Option<String> {
    let is_coherent = unit.factor == 1.0 && unit.offset == 0.0;
    (!is_coherent).then(|| {
        format!(
            "`{own}` is in {given}, but `{name}` has no unit: its values are used as they are; give the \
             variable a `unit`, or the column a `factor`"
        )
    })
}

/// The unit of a column as its file says, if it is known to us, to the model, or the same as that of the
/// variable.
fn unit_of<'c>(about: &'c About, variable: &VariableUnit) -> Option<&'c str> {
    let is_known =
        |name: &&str| *name == variable.symbol || variable.definitions.find(name).is_some();
    about.unit.as_deref().or(about.unknown_unit.as_deref().filter(is_known))
}

/// A sentence about a column with a unit that is not known.
fn unknown_unit([column, given, name, unit]: [&str; 4]) -> String {
    format!(
        "`{column}` is in `{given}`, which is not a known unit: its values are used for `{name}` as they \
         are, in {}; convert them, or give the column a `unit` or a `factor`",
        in_words(unit)
    )
}

/// The unit that a column without one has by its name, if its values would change in the unit of the variable.
pub(super) fn suggested_unit<'n>(column: &'n str, unit: &str) -> Option<&'n str> {
    let suggested = suggested(column)?;
    let conversion = written(suggested)?.to(written(unit)?)?;
    (!conversion.is_identity()).then_some(suggested)
}

/// Why values of which it is not clear whether they count revolutions or radians are not converted.
fn unclear_angles(
    [column, given, name, unit]: [&str; 4],
    [radians, revolutions]: [f64; 2],
) -> Fault {
    crate::fault!(
        BAD_OPTION,
        "`{column}` is in {given} and `{name}` is in {unit}: one may count revolutions and the other \
         radians, and a revolution is 2 pi rad"
    )
    .help(format!(
        "write `factor = {revolutions}` for the column if so, or `factor = {radians}` if both count the same"
    ))
}

/// What must be known of the zeros of scales that differ, as the end of a sentence; `absolute` is the
/// conversion of values that are not differences.
fn zero_of_scale(conversion: Conversion, absolute: Conversion) -> &'static str {
    match (conversion.offset == 0.0, absolute.offset == 0.0) {
        (_, true) => "",
        (true, false) => ", without an offset, as a temperature difference",
        (false, false) => {
            "; for a temperature difference, give the variable the type \
             `Modelica.Units.SI.TemperatureDifference` or the column a `factor`"
        }
    }
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
    variable: &VariableUnit,
    values: f64,
) -> f64 {
    let Some(SigmaEntry::Words(name)) = sigma else { return values };
    let find = |name: &str| variable.definitions.find(name);
    let own = table.column(name).ok().and_then(|one| find(unit_of(&one.about, variable)?));
    let conversion = own.zip(find(&variable.symbol)).and_then(|(own, unit)| own.to(unit));
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
