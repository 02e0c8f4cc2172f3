//! Parts of an experiment: its rows cut at gaps, where time starts again, or at given times. Each part
//! is simulated from its first row on, and its initial values are parameters of their own.

use super::data::Notes;
use super::file::{ExperimentEntry, ParameterEntry, ProblemFile, Role, SegmentsEntry};
use super::time_axis::{self, Origin};
use crate::diag::{At as _, Diagnostic, Fault, suggest};
use crate::mat::{Column, MatFile};
use crate::models::translated::Translated;
use crate::registry::BAD_OPTION;
use crate::{bail, fault};
use std::ops::Range;

/// Rows of an experiment that are simulated at a stretch.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Segment {
    /// The name of the experiment, with the number of the part after the first.
    pub name: String,
    /// Counted from 0.
    pub number: usize,
    /// Its rows, where the experiment is cut.
    pub rows: Option<Range<usize>>,
    /// What the times of the whole file count from.
    pub origin: Option<Origin>,
}

/// The times of the rows of a file.
pub(super) struct Rows<'a> {
    pub column: &'a Column,
    pub seconds: &'a [f64],
    pub origin: Option<Origin>,
}

impl Segment {
    /// An experiment that is not cut.
    pub(super) fn whole(entry: &ExperimentEntry, number: usize, origin: Option<Origin>) -> Segment {
        Segment { name: entry.label(number), number: 0, rows: None, origin }
    }

    /// The free parameter that `name` is in this part of `experiment`.
    pub(super) fn free_name(
        &self,
        name: &str,
        parameter: &ParameterEntry,
        experiment: &str,
    ) -> String {
        match (parameter.initial && self.number > 0, parameter.per_experiment) {
            (true, _) => format!("{name}@{}", self.name),
            (false, true) => format!("{name}@{experiment}"),
            (false, false) => name.to_owned(),
        }
    }

    /// Refuses a part whose initial values are not estimated.
    ///
    /// # Errors
    ///
    /// `bad-option` where the values at its beginning are given or unknown.
    pub(super) fn check_initial_values(
        &self,
        file: &ProblemFile,
        entry: &ExperimentEntry,
        model: &Translated,
    ) -> Result<(), Diagnostic> {
        if self.number == 0 {
            return Ok(());
        }
        let name = &self.name;
        let mut estimated = Vec::new();
        for (own, parameter) in file.parameters.iter().filter(|(_, entry)| entry.initial) {
            let place = file.context.places.parameter(own);
            if let Role::Free { .. } = parameter.role(own).at(place)? {
                estimated.push(own.as_str());
                continue;
            }
            let fault = fault!(
                BAD_OPTION,
                "{name} begins in the middle of the experiment, where the initial value of `{own}` \
                 is not the given one";
                help: "estimate it: `{own} = {{ min = …, max = …, initial = true }}`"
            );
            return Err(fault.at(place));
        }
        if let Some(own) = entry.start.keys().next() {
            let fault = fault!(
                BAD_OPTION,
                "{name} begins in the middle of the experiment, where `{own}` does not have its \
                 value in `start`";
                help: "remove it there, and add `{own} = {{ min = …, max = …, initial = true }}` to \
                       `[parameters]`"
            );
            return Err(fault.at(entry.places.at(&["start", own])));
        }
        let states: Vec<&str> = model.state_names().map(|state| &**state).collect();
        let unknown: Vec<&str> =
            states.iter().copied().filter(|state| !estimated.contains(state)).collect();
        if unknown.is_empty() || estimated.len() >= states.len() {
            return Ok(());
        }
        let fault = fault!(
            BAD_OPTION,
            "{name} begins in the middle of the experiment, where the values of {} are unknown",
            suggest::listed(&unknown);
            help: "estimate them: add a line such as `{} = {{ min = …, max = …, initial = true }}` \
                   for each to `[parameters]`; every part has its own value", unknown[0]
        );
        Err(fault.at(entry.places.at(&["segments"])))
    }
}

/// The parts of an experiment.
///
/// # Errors
///
/// `bad-option` where it cannot be cut.
pub(super) fn segments(
    (entry, number): (&ExperimentEntry, usize),
    table: &MatFile,
    rows: &Rows<'_>,
    notes: &mut Notes,
) -> Result<Vec<Segment>, Fault> {
    let Some(requested) = &entry.segments else {
        return Ok(vec![Segment::whole(entry, number, rows.origin)]);
    };
    let name = entry.label(number);
    if entry.validation || entry.steady_state {
        let option = if entry.validation { "validation" } else { "steady_state" };
        bail!(
            BAD_OPTION,
            "{name} has `segments` and `{option}`: the initial values of its parts would be unknown";
            help: "remove one of the two"
        );
    }
    let ranges = match requested {
        SegmentsEntry::Auto => found(entry, table, rows)?,
        SegmentsEntry::Times(times) => cut_at(&name, times, rows)?,
    };
    let part = |(number, range): (usize, Range<usize>)| Segment {
        name: match number {
            0 => name.clone(),
            _ => format!("{name} part {}", number + 1),
        },
        number,
        rows: Some(range),
        origin: rows.origin,
    };
    note_cuts(&name, &ranges, (table, rows), notes);
    Ok(ranges.into_iter().enumerate().map(part).collect())
}

fn note_cuts(
    name: &str,
    ranges: &[Range<usize>],
    (table, rows): (&MatFile, &Rows<'_>),
    notes: &mut Notes,
) {
    let place = |row: usize| rows.column.place(row);
    let words = match ranges {
        [_] => "there is nothing to cut".to_owned(),
        several => {
            let part = |range: &Range<usize>| {
                format!("{} to {}", place(range.start), place(range.end - 1))
            };
            let parts: Vec<String> = several.iter().map(part).collect();
            format!(
                "it is cut into {} parts with separate initial values: {}",
                parts.len(),
                parts.join(", ")
            )
        }
    };
    notes.about(table, [format!("`segments` of {name}: {words}")]);
}

/// Parts between gaps in the rows that have a time and all inputs, and where time starts again. Rows
/// within a gap belong to none.
fn found(
    entry: &ExperimentEntry,
    table: &MatFile,
    rows: &Rows<'_>,
) -> Result<Vec<Range<usize>>, Fault> {
    let mut is_known: Vec<bool> = rows.seconds.iter().map(|time| time.is_finite()).collect();
    for (name, input) in &entry.inputs {
        let column = table.column(input.entry().column.as_deref().unwrap_or(name))?;
        for (known, value) in is_known.iter_mut().zip(&column.values) {
            *known &= value.is_finite();
        }
    }
    let known: Vec<usize> = (0..is_known.len()).filter(|&row| is_known[row]).collect();
    let mut ranges = Vec::new();
    for run in known.chunk_by(|a, b| rows.seconds[*a] <= rows.seconds[*b]) {
        let times: Vec<f64> = run.iter().map(|row| rows.seconds[*row]).collect();
        let mut first = 0;
        for gap in time_axis::gaps(&times) {
            ranges.push(run[first]..run[gap.place] + 1);
            first = gap.place + 1;
        }
        ranges.push(run[first]..run[run.len() - 1] + 1);
    }
    Ok(ranges)
}

/// Parts between given times.
fn cut_at(name: &str, times: &[f64], rows: &Rows<'_>) -> Result<Vec<Range<usize>>, Fault> {
    let count = rows.seconds.len();
    let falls = rows.column.fall("time").is_some();
    let mut ranges = Vec::new();
    let mut first = 0;
    for time in times {
        let next = (0..count).find(|&row| rows.seconds[row] >= *time).unwrap_or(count);
        if falls || next <= first || next >= count {
            bail!(
                BAD_OPTION,
                "`segments` of {name} cuts at {time} s, where a part without rows would begin or end";
                help: "give ascending times within the measured time, in seconds; \"auto\" cuts at \
                       gaps and where time starts again"
            );
        }
        ranges.push(first..next);
        first = next;
    }
    ranges.push(first..count);
    Ok(ranges)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mat::About;

    fn cut(seconds: &[f64], times: &[f64]) -> Result<Vec<Range<usize>>, String> {
        let column = Column { values: seconds.to_vec(), about: About::default(), missing: None };
        let rows = Rows { column: &column, seconds, origin: None };
        cut_at("e", times, &rows).map_err(|fault| fault.message)
    }

    #[test]
    fn cuts_are_before_the_first_row_at_or_after_a_time() {
        let seconds = [0.0, 1.0, 2.0, 3.0];
        assert_eq!(cut(&seconds, &[1.5, 3.0]), Ok(vec![0..2, 2..3, 3..4]));
        for times in [&[0.0][..], &[4.0], &[2.0, 1.0], &[1.2, 1.5]] {
            assert!(cut(&seconds, times).unwrap_err().contains("cuts at"), "{times:?}");
        }
        assert!(cut(&[0.0, 1.0, 0.0, 1.0], &[0.5]).is_err());
    }
}
