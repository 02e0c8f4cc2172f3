//! Inputs of a model that follow the columns of a file in a simulation, as in an experiment of a
//! problem.

use super::data;
use super::data::Notes;
use super::enclosing_class::{Base, EnclosingClass};
use super::file::{Column, ColumnEntry, ExperimentEntry};
use super::inputs::{self, Times};
use super::time_axis::{self, Origin};
use crate::Session;
use crate::diag::{Diagnostic, Fault, suggest};
use crate::fault;
use crate::flatten::BaseType;
use crate::mat::MatFile;
use crate::models::simulation;
use crate::registry::BAD_OPTION;
use crate::results::{self, ResultTable};
use crate::source::Span;
use crate::syntax::ast::CausalityPrefix;
use std::path::Path;

/// Columns of time by their names.
const TIMES: [&str; 3] = ["time", "Time", "t"];

/// A model whose inputs follow data.
pub struct Driven {
    /// The class around the model.
    pub class: String,
    /// The first time of the data.
    pub first: f64,
    /// The last time of the data.
    pub last: f64,
}

impl Driven {
    /// Notes what the inputs do where a simulation from `start` to `stop` has no data.
    pub fn note_outside(&self, session: &mut Session, span: (f64, f64)) {
        note_outside(session, (self.first, self.last), span);
    }

    /// Takes the inputs of the class around the model, which are no part of it, out of its results.
    pub fn without_own_inputs(results: &mut ResultTable) {
        results.retain(|name| !name.starts_with("'data of "));
    }
}

/// Notes what inputs do where a simulation from `start` to `stop` has no data, which are known from
/// `first` to `last`.
pub fn note_outside(session: &mut Session, (first, last): (f64, f64), (start, stop): (f64, f64)) {
    let mut note = |text: String| session.note(crate::mat::errors::DATA_NOTE, text);
    if start < first {
        note(format!("the inputs have data from {first} s on: before that, their first values"));
    }
    if stop > last {
        note(format!("the inputs have data until {last} s: after that, their last values"));
    }
}

/// Lets the inputs of the model `class` follow the columns of a file that have their names. Between
/// the samples they continue as `interpolation` says, `hold` or `linear`, or as they look; those that are
/// not Real are held.
///
/// # Errors
///
/// Files that cannot be read, without a column of time or of an input.
pub fn driven(
    session: &mut Session,
    class: &str,
    path: &Path,
    interpolation: Option<&str>,
) -> Result<Driven, Vec<Diagnostic>> {
    let one = |fault: Fault| vec![fault.at(Span::NONE)];
    let mut columns = InputColumns::read(session, path).map_err(one)?;
    let flat = simulation::flattened(session, class)?.model;
    let names = flat.variables.values().filter(|variable| {
        variable.causality == Some(CausalityPrefix::Input) && variable.binding.is_none()
    });
    let names: Vec<String> = names
        .flat_map(|variable| match variable.dims.as_slice() {
            [size] => (1..=*size).map(|at| format!("{}[{at}]", variable.name)).collect(),
            _ => vec![variable.name.to_string()],
        })
        .collect();
    let is_real = |name: &str| {
        let variable = flat.variables.values().find(|v| is_part_of(name, &v.name));
        variable.is_none_or(|variable| variable.base == BaseType::Real)
    };
    let entry = columns.entry(&names, interpolation, &is_real);
    let entry = entry.ok_or_else(|| one(no_column(class, &names, &columns.table)))?;
    let mut enclosing = EnclosingClass::default();
    let times = Times { name: "time", values: &columns.time, origin: columns.origin };
    inputs::inputs(&entry, &columns.table, &times, &flat, &mut enclosing, &mut columns.notes)
        .map_err(|error| vec![error])?;
    let base = Base::of(class, None).map_err(|error| vec![error])?;
    let class = enclosing.load(session, &base, (0, Span::NONE))?;
    let (first, last) = columns.span();
    columns.tell(session);
    Ok(Driven { class, first, last })
}

/// A file with columns for inputs.
pub(super) struct InputColumns {
    pub table: MatFile,
    /// The column of time, seconds.
    pub time: Vec<f64>,
    /// The date that it counts from.
    pub origin: Option<Origin>,
    pub notes: Notes,
}

impl InputColumns {
    /// Reads the file.
    ///
    /// # Errors
    ///
    /// Files that cannot be read or have no column of time.
    pub(super) fn read(session: &Session, path: &Path) -> Result<InputColumns, Fault> {
        let bytes = session.world.read_bytes(path)?;
        let table = results::read_data(&path.to_string_lossy(), &bytes)?;
        let mut notes = Notes::default();
        let (time, origin) = times(&table, &mut notes)?;
        Ok(InputColumns { table, time, origin, notes })
    }

    /// An experiment in which the inputs that have a column follow it; `None` where none has one.
    /// Nothing lies between two values of those that are not real.
    pub(super) fn entry(
        &mut self,
        names: &[String],
        interpolation: Option<&str>,
        is_real: &dyn Fn(&str) -> bool,
    ) -> Option<ExperimentEntry> {
        let (found, missing): (Vec<&String>, Vec<&String>) =
            names.iter().partition(|name| self.table.has_column(name));
        if found.is_empty() {
            return None;
        }
        for name in missing {
            self.notes.add(format!("{}: no column for the input `{name}`", self.table.file_name));
        }
        let columns = found.into_iter().map(|name| {
            let named = ColumnEntry::named(Some(name.clone()));
            let interpolation =
                interpolation.map(|own| if is_real(name) { own } else { "hold" }.to_owned());
            (name.clone(), Column::More(Box::new(ColumnEntry { interpolation, ..named })))
        });
        Some(ExperimentEntry { inputs: columns.collect(), ..ExperimentEntry::default() })
    }

    /// The first and the last time.
    pub(super) fn span(&self) -> (f64, f64) {
        let known = || self.time.iter().copied().filter(|t| t.is_finite());
        (known().fold(f64::INFINITY, f64::min), known().fold(f64::NEG_INFINITY, f64::max))
    }

    /// Notes what should be known of the data.
    pub(super) fn tell(self, session: &mut Session) {
        self.notes.into_notes().iter().for_each(|note| note.say(session));
    }
}

/// Whether a name is that of a variable or of one of its elements.
fn is_part_of(name: &str, variable: &str) -> bool {
    name.strip_prefix(variable).is_some_and(|rest| rest.is_empty() || rest.starts_with('['))
}

/// The column of time in seconds, and the date that it counts from.
fn times(table: &MatFile, notes: &mut Notes) -> Result<(Vec<f64>, Option<Origin>), Fault> {
    let name = TIMES.into_iter().find(|name| table.column(name).is_ok()).unwrap_or(TIMES[0]);
    let entry = ColumnEntry::named(Some(name.to_owned()));
    let column = data::column(table, &entry, name, notes);
    let column = column.map_err(|fault| match table.has_column(name) {
        true => fault,
        false => fault.help("give the column of the times the name `time`"),
    })?;
    let origin = time_axis::origin(name, &column, (&entry, None), (table, notes))?;
    notes.about(table, time_axis::repeated(name, &column));
    Ok((time_axis::seconds(&column, &entry, origin, (table, notes))?, origin))
}

pub(super) fn no_column(class: &str, names: &[String], table: &MatFile) -> Fault {
    let columns: Vec<&str> = table.arrays.keys().map(String::as_str).collect();
    let shown = suggest::listed(&columns);
    let file = &table.file_name;
    if names.is_empty() {
        return fault!(BAD_OPTION, "`{class}` has no inputs that could follow `{file}`");
    }
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let inputs = suggest::listed(&names);
    fault!(BAD_OPTION, "`{file}` has no column with the name of an input of `{class}`")
        .help(format!("the inputs are {inputs}; the columns are {shown}"))
}
