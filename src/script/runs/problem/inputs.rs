//! Inputs of a model that follow recorded columns.
//!
//! Between its samples a recorded input was constant, kept by a switch or a controller, or it changed
//! steadily: most files do not say which, and a step read as a ramp shifts time constants. An entry
//! says `interpolation = "hold"` or `"linear"`; else inputs that move in steps are kept constant
//! (zero-order hold) and others are interpolated linearly, a note says so, and after the fit the other
//! way is tried as well. Two rows with one time stamp are the values before and after a jump.

use super::data::{self, Notes};
use super::enclosing_class::{self, EnclosingClass};
use super::fault_codes;
use super::file::{ColumnEntry, ExperimentEntry};
use super::flat::{variable_of, variable_unit};
use super::series::note_temperature;
use super::time_axis::{self, Origin};
use crate::bail;
use crate::diag::{At as _, Diagnostic, Fault, suggest};
use crate::fault;
use crate::flatten::{BaseType, FlatModel, RecordedInput, Variability};
use crate::mat::{Column, MatFile};
use crate::models::ranges::Range;
use crate::models::variable_unit::VariableUnit;
use crate::registry::BAD_OPTION;
use crate::source::Span;
use crate::syntax::ast::CausalityPrefix;
use std::fmt::Write;

/// How an input continues between its samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Between {
    Constant,
    Linear,
}

impl Between {
    /// What a problem file calls it.
    pub(super) fn name(self) -> &'static str {
        match self {
            Between::Constant => "hold",
            Between::Linear => "linear",
        }
    }

    pub(super) fn other(self) -> Between {
        match self {
            Between::Constant => Between::Linear,
            Between::Linear => Between::Constant,
        }
    }

    /// What happens to an input where samples are missing.
    fn in_gaps(self) -> &'static str {
        match self {
            Between::Constant => "holds its last value",
            Between::Linear => "is interpolated linearly",
        }
    }
}

/// Where the times of inputs are from: those of X, by the name of its column, and the number that
/// these count from.
pub(super) struct Times<'a> {
    pub name: &'a str,
    pub values: &'a [f64],
    pub origin: Option<Origin>,
}

/// An input of which neither the file nor the problem says how it continues between samples.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Undecided {
    pub name: String,
    pub assumed: Between,
}

/// An input that follows a column.
struct Followed {
    /// Times and values.
    samples: Vec<(f64, f64)>,
    column: Column,
    /// The rows of the samples in it.
    rows: Vec<usize>,
    between: Between,
    is_decided: bool,
}

/// An input of the model as its declaration has it.
pub(super) struct Declared {
    pub base: BaseType,
    pub unit: VariableUnit,
    /// The literals of an enumeration with their numbers; none for other types.
    pub literals: Vec<(f64, String)>,
}

/// An input with the samples that it follows.
pub(super) struct Recorded {
    pub name: String,
    base: BaseType,
    place: Span,
    followed: Followed,
}

impl Recorded {
    /// Times and values.
    pub(super) fn samples(&self) -> &[(f64, f64)] {
        &self.followed.samples
    }

    /// Whether each value is held until the next sample.
    pub(super) fn is_held(&self) -> bool {
        self.followed.between == Between::Constant
    }
}

/// Samples for the inputs that follow columns, and those of which it is not known how they continue
/// between samples.
pub(super) fn inputs(
    entry: &ExperimentEntry,
    table: &MatFile,
    x: &Times<'_>,
    flat: &FlatModel,
    enclosing: &mut EnclosingClass,
    notes: &mut Notes,
) -> Result<Vec<Undecided>, Diagnostic> {
    let declared = |name: &str| {
        let base = type_of_input(name, flat)?;
        let literals = literals(&base);
        Ok(Declared { base, unit: variable_unit(flat, name), literals })
    };
    let (all, undecided) = recorded(entry, table, x, &declared, notes)?;
    for one in &all {
        let kind = enclosing_class::type_in(&flat.name, &one.base);
        declare((&one.name, &kind, one.place), &one.followed, enclosing);
    }
    Ok(undecided)
}

/// The same without a class around the model, for inputs that `declared` knows.
pub(super) fn recorded(
    entry: &ExperimentEntry,
    table: &MatFile,
    x: &Times<'_>,
    declared: &dyn Fn(&str) -> Result<Declared, Fault>,
    notes: &mut Notes,
) -> Result<(Vec<Recorded>, Vec<Undecided>), Diagnostic> {
    let own = match &entry.input_time {
        Some(name) => {
            Some(own_times(name, x.origin, table, notes).at(entry.places.at(&["input_time"]))?)
        }
        None => None,
    };
    let times = match (&entry.input_time, &own) {
        (Some(name), Some(values)) => (name.as_str(), values.as_slice()),
        _ => (x.name, x.values),
    };
    let (mut all, mut undecided, mut torn) = (Vec::new(), Vec::new(), Vec::new());
    for (name, requested) in &entry.inputs {
        let place = entry.places.at(&["inputs", name]);
        let input = (name.as_str(), &requested.entry());
        let declared = declared(name).at(place)?;
        let is_of_command = entry.data.as_os_str().is_empty();
        let followed = followed((input, is_of_command), table, times, &declared, notes);
        let followed = followed.at(place)?;
        notes.warn_about(table, outside(name, &followed, x.values));
        if !followed.is_decided {
            undecided.push(Undecided { name: name.clone(), assumed: followed.between });
        }
        torn.extend(in_gaps(name, &followed));
        all.push(Recorded { name: name.clone(), base: declared.base, place, followed });
    }
    note_gaps(torn, table, notes);
    Ok((all, undecided))
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
        base @ (BaseType::Real
        | BaseType::Integer
        | BaseType::Boolean
        | BaseType::Enumeration(_)) => Ok(base.clone()),
        _ => bail!(BAD_OPTION, "`{name}` is not a number; it cannot follow a column of the data"),
    }
}

/// The literals of an enumeration with their numbers.
fn literals(base: &BaseType) -> Vec<(f64, String)> {
    let BaseType::Enumeration(definition) = base else { return Vec::new() };
    let literals = definition.literals.iter().enumerate();
    literals.map(|(at, literal)| ((at + 1) as f64, literal.to_string())).collect()
}

/// What an input does before its first sample and after its last one, where there are data.
fn outside(name: &str, followed: &Followed, times: &[f64]) -> Vec<String> {
    let (Some(&first), Some(&last)) = (followed.samples.first(), followed.samples.last()) else {
        return Vec::new();
    };
    let place = |row: Option<&usize>| row.map_or(String::new(), |row| followed.column.place(*row));
    let known = || times.iter().copied().filter(|time| time.is_finite());
    let mut sentences = Vec::new();
    if known().any(|time| time < first.0) {
        let place = place(followed.rows.first());
        sentences.push(format!(
            "the input `{name}` has its first value in {place}, at {} s; before that it is {}",
            first.0, first.1
        ));
    }
    if known().any(|time| time > last.0) {
        let place = place(followed.rows.last());
        sentences.push(format!(
            "the input `{name}` has its last value in {place}, at {} s; after that it is {}",
            last.0, last.1
        ));
    }
    sentences
}

/// The gaps of an input in words, and what it does there.
fn in_gaps(name: &str, followed: &Followed) -> Option<(String, Between, String)> {
    let times: Vec<f64> = followed.samples.iter().map(|(time, _)| *time).collect();
    let gaps = time_axis::gaps(&times);
    let words = time_axis::listed(&gaps, |place| followed.column.place(followed.rows[place]));
    (!gaps.is_empty()).then(|| (words, followed.between, name.to_owned()))
}

/// Warns of gaps, once for all inputs that have the same.
fn note_gaps(mut torn: Vec<(String, Between, String)>, table: &MatFile, notes: &mut Notes) {
    while let Some((words, between, _)) = torn.first().cloned() {
        let (same, others): (Vec<_>, Vec<_>) =
            torn.into_iter().partition(|own| own.0 == words && own.1 == between);
        torn = others;
        let names: Vec<String> = same.iter().map(|(.., name)| format!("`{name}`")).collect();
        let inputs = match names.as_slice() {
            [one] => format!("the input {one} has"),
            several => format!("the inputs {} have", several.join(", ")),
        };
        let each = if names.len() == 1 { "it" } else { "each" };
        notes.warn_about(
            table,
            [format!(
                "{inputs} {words}, in which {each} {}; to fit the parts between gaps separately, write \
                 `segments = \"auto\"` in the experiment, and estimate the initial values of each part \
                 (`initial = true`)",
                between.in_gaps()
            )],
        );
    }
}

/// The column of time of the inputs, in seconds.
fn own_times(
    name: &str,
    origin: Option<Origin>,
    table: &MatFile,
    notes: &mut Notes,
) -> Result<Vec<f64>, Fault> {
    let named = ColumnEntry::named(Some(name.to_owned()));
    let column = data::column(table, &named, name, notes)?;
    time_axis::seconds(&column, &named, origin, (table, notes))
}

/// The samples of an input, and how it continues between them; whether a command asks for it, not a problem.
fn followed(
    ((name, requested), is_of_command): ((&str, &ColumnEntry), bool),
    table: &MatFile,
    (time_name, time): (&str, &[f64]),
    Declared { base, unit, literals }: &Declared,
    notes: &mut Notes,
) -> Result<Followed, Fault> {
    let column = match literals.is_empty() {
        true => data::column(table, requested, name, notes)?,
        false => table.named_values(requested.column.as_deref().unwrap_or(name), literals)?,
    };
    let own = requested.column.as_deref().unwrap_or(name);
    notes.warn_about(table, fault_codes::codes(own, &column));
    notes.warn_about(table, fault_codes::frozen(own, &column));
    data::same_length([time_name, name], [time.len(), column.values.len()])?;
    check_type(name, base, &column)?;
    check_literals(name, literals, &column)?;
    let values = data::in_unit(&column, name, unit, requested, (table, notes))?.values;
    let known = values.iter().copied().filter(|value| value.is_finite());
    note_temperature((name, "inputs"), unit, (requested, &column), known, notes);
    notes.warn_about(table, time_axis::truncated(time_name, time, (name, &values)));
    let rows: Vec<usize> =
        (0..time.len()).filter(|&row| time[row].is_finite() && values[row].is_finite()).collect();
    if rows.is_empty() {
        bail!(BAD_OPTION, "the input `{name}` has no points");
    }
    if let Some(pair) = rows.windows(2).find(|pair| time[pair[1]] < time[pair[0]]) {
        bail!(
            BAD_OPTION,
            "the time values of the input `{name}` decrease from {} to {} at {}",
            time[pair[0]], time[pair[1]], column.place(pair[1]);
            help: "sort the rows; where several measurements follow each other, write `segments = \
                   \"auto\"` in the experiment, which cuts them there, and estimate the initial values \
                   of each part (`initial = true`)"
        );
    }
    let samples: Vec<(f64, f64)> = rows.iter().map(|&row| (time[row], values[row])).collect();
    let (between, is_decided) = match base {
        BaseType::Real => between((name, requested), is_of_command, &samples, notes)?,
        _ if requested.interpolation.as_deref() == Some("linear") => bail!(
            BAD_OPTION,
            "the input `{name}` is not Real and cannot be interpolated linearly";
            help: "remove `interpolation`: each value is held until the next sample"
        ),
        _ => (Between::Constant, true),
    };
    // Before the first value and after the last one it does something else, which is said apart.
    let inside = column.values.get(rows[0]..=rows[rows.len() - 1]).unwrap_or_default();
    let is_torn = inside.iter().any(|value| !value.is_finite());
    let there = match is_torn {
        true => format!("; there the input {}", between.in_gaps()),
        false => String::new(),
    };
    let missing = column.missing.iter();
    notes.warn_about(table, missing.map(|sentence| format!("{sentence}{there}")));
    Ok(Followed { samples, column, rows, between, is_decided })
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

/// Refuses numbers of no literal.
fn check_literals(name: &str, literals: &[(f64, String)], column: &Column) -> Result<(), Fault> {
    let limits = [f64::NEG_INFINITY, f64::INFINITY];
    let literals = literals.iter().map(|(number, literal)| (*number, literal.as_str())).collect();
    let range = Range { limits, literals };
    if range.literals.is_empty() {
        return Ok(());
    }
    let values = column.values.iter().enumerate().filter(|(_, value)| !value.is_nan());
    for (row, value) in values {
        range.check(&format!("{}: the input `{name}`", column.place(row)), *value)?;
    }
    Ok(())
}

/// Lets an input of the model follow its samples, through an input of the class around the model.
fn declare(
    (name, kind, place): (&str, &str, Span),
    followed: &Followed,
    enclosing: &mut EnclosingClass,
) {
    let own = enclosing_class::own_name("data of", name);
    _ = writeln!(enclosing.declarations, "  input {kind} {own};");
    enclosing.elements.push((own.clone(), format!("the data of {name}")));
    enclosing.bind(name, enclosing_class::reference(&own, place), place);
    enclosing.recorded.push(RecordedInput {
        name: own.as_str().into(),
        times: followed.samples.iter().map(|(time, _)| *time).collect(),
        values: followed.samples.iter().map(|(_, value)| *value).collect(),
        is_held: followed.between == Between::Constant,
    });
}

/// What an entry says of the values between samples, or what the values look like; and whether
/// nothing else can be meant.
fn between(
    (name, entry): (&str, &ColumnEntry),
    is_of_command: bool,
    samples: &[(f64, f64)],
    notes: &mut Notes,
) -> Result<(Between, bool), Fault> {
    match entry.interpolation.as_deref() {
        Some("hold") => return Ok((Between::Constant, true)),
        Some("linear") => return Ok((Between::Linear, true)),
        Some(other) => bail!(
            BAD_OPTION,
            "the interpolation of the input `{name}` is `{other}`";
            help: "write \"hold\" (zero-order hold) or \"linear\" (linear interpolation)"
        ),
        None => {}
    }
    let choice = |other: &str| match is_of_command {
        true => format!("`--interpolation {other}`"),
        false => format!("`interpolation = \"{other}\"` in its entry of `inputs`"),
    };
    let jumps = |pair: &[(f64, f64)]| pair[0].0 == pair[1].0 && pair[0].1 != pair[1].1;
    if samples.windows(2).all(|pair| pair[0].1 == pair[1].1 || jumps(pair)) {
        return Ok((Between::Constant, true));
    }
    if samples.windows(2).any(jumps) {
        notes.add(format!(
            "the input `{name}` jumps where two rows have one time stamp, and is interpolated \
             linearly between other rows; if each value holds until the next, write {}",
            choice("hold")
        ));
        return Ok((Between::Linear, false));
    }
    let assumed = if moves_in_steps(samples) { Between::Constant } else { Between::Linear };
    notes.add(match assumed {
        Between::Constant => format!(
            "the input `{name}` is piecewise constant: each value is held until the next sample; \
             for linear interpolation write {}",
            choice("linear")
        ),
        Between::Linear => format!(
            "the input `{name}` is interpolated linearly between samples; if each value holds \
             until the next, write {}",
            choice("hold")
        ),
    });
    Ok((assumed, false))
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
