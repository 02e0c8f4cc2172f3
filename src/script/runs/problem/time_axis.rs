//! The column of time of an experiment: numbers that count from a date, rows on either side of an
//! event, and gaps.

use super::data::{self, Notes, suggested_unit};
use super::file::ColumnEntry;
use crate::bail;
use crate::diag::Fault;
use crate::identify::significant;
use crate::mat::{Calendar, Column, MatFile, Version, calendar};
use crate::models::variable_unit::VariableUnit;
use crate::registry::BAD_OPTION;
use crate::units::{Unit, written};

/// A gap is a step so many times as long as the median one. In the year of a weather file in
/// quarters of an hour, that is two and a half hours without a row.
const GAP: f64 = 10.0;
/// It is also so many times as long as the median of the steps around it: the rests of a battery
/// cycler, sampled once a minute between pulses sampled once a second, are not gaps, nor are times
/// that grow by a constant factor.
const AROUND: f64 = 5.0;
/// Steps on either side that are around a step.
const NEIGHBORS: usize = 5;
/// Fewer steps have no usual length.
const FEWEST_STEPS: usize = 8;
/// Gaps that are named.
const NAMED: usize = 3;

/// The point that times count from which are numbers of a calendar.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Origin {
    calendar: Calendar,
    number: f64,
}

/// A long step between rows.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Gap {
    /// The place before it.
    pub place: usize,
    pub seconds: f64,
    pub median: f64,
}

/// The first row, if the numbers of a column of time count from a date. An experiment whose
/// simulation begins near such numbers means them as they are.
///
/// # Errors
///
/// `bad-option` for numbers that may be days or seconds.
pub(super) fn origin(
    name: &str,
    column: &Column,
    (entry, start_time): (&ColumnEntry, Option<f64>),
    (table, notes): (&MatFile, &mut Notes),
) -> Result<Option<Origin>, Fault> {
    let Some(calendar) = calendar(&column.values).filter(|_| entry.factor.is_none()) else {
        return Ok(None);
    };
    let Some((_, first)) = column.known().next() else { return Ok(None) };
    if start_time.is_some_and(|start| start > first / 2.0) {
        return Ok(None);
    }
    match entry.unit.as_deref().or(column.about.unit.as_deref()) {
        Some(unit) => {
            let seconds = written(unit).and_then(|unit| unit.to(Unit::SECOND));
            if seconds.is_none_or(|conversion| conversion.factor != calendar.seconds) {
                return Ok(None);
            }
        }
        None if calendar.is_certain => {}
        None => bail!(
            BAD_OPTION,
            "`{name}` begins at {first}: these may be {} or seconds", calendar.name;
            help: "for days, write `x = {{ variable = \"time\", column = \"{name}\", unit = \
                   \"d\" }}`: then they count from the first row; for seconds, write `unit = \"s\"`"
        ),
    }
    notes.about(
        table,
        [format!(
            "`{name}` holds {}, read as seconds since the first row ({first})",
            calendar.name
        )],
    );
    Ok(Some(Origin { calendar, number: first }))
}

/// Says that a column of times without a unit is read as seconds; results of simulations are in seconds.
pub(super) fn note_unit(
    name: &str,
    column: &Column,
    entry: &ColumnEntry,
    (table, notes): (&MatFile, &mut Notes),
) {
    // What is written and not known is said where the column is converted.
    let is_written = column.about.unit.is_some() || column.about.unknown_unit.is_some();
    let has_unit = entry.unit.is_some() || entry.factor.is_some() || is_written;
    /// Beginnings of names, and the units that they mean.
    const NAMES: [(&str, [&str; 2]); 5] = [
        ("hour", ["hours", "h"]),
        ("stund", ["hours", "h"]),
        ("day", ["days", "d"]),
        ("tag", ["days", "d"]),
        ("ms", ["milliseconds", "ms"]),
    ];
    if !has_unit && table.is_table() && table.version != Version::Results {
        if let Some(unit) = suggested_unit(name, "s") {
            notes.about(table, [format!(
                "`{name}` has no unit, and is read in seconds; the name suggests {unit}: write `x = {{ \
                 variable = \"time\", column = \"{name}\", unit = \"{unit}\" }}`"
            )]);
            return;
        }
        let lower = name.to_lowercase();
        let known = NAMES.iter().find(|(own, _)| lower.starts_with(own));
        let [words, unit] = known.map_or(["minutes", "min"], |(_, unit)| *unit);
        notes.about(table, [format!(
            "`{name}` has no unit, and is read in seconds; for {words}, write `x = {{ variable = \
             \"time\", column = \"{name}\", unit = \"{unit}\" }}`"
        )]);
    }
}

/// A column of time in seconds, from `origin` where it counts from a date as well.
///
/// # Errors
///
/// As [`data::in_unit`].
pub(super) fn seconds(
    column: &Column,
    entry: &ColumnEntry,
    origin: Option<Origin>,
    about: (&MatFile, &mut Notes),
) -> Result<Vec<f64>, Fault> {
    let same = |origin: &Origin| calendar(&column.values) == Some(origin.calendar);
    match origin.filter(|_| entry.factor.is_none()).filter(same) {
        Some(Origin { calendar, number }) => {
            Ok(column.values.iter().map(|value| calendar.seconds_since(number, *value)).collect())
        }
        None => Ok(data::in_unit(column, "time", &VariableUnit::second(), entry, about)?.values),
    }
}

/// A sentence about time stamps of several consecutive rows: limits at an event, or replicates where
/// every stamp repeats.
pub(super) fn repeated(name: &str, column: &Column) -> Option<String> {
    let known: Vec<(usize, f64)> = column.known().collect();
    let groups: Vec<&[(usize, f64)]> = known.chunk_by(|a, b| a.1 == b.1).collect();
    let pairs = || groups.iter().filter(|group| group.len() > 1);
    let count = pairs().count();
    let first = pairs().next().filter(|_| count < groups.len());
    let Some([(row, stamp), (next, _), ..]) = first else { return column.repetition(name) };
    let stamps = match count {
        1 => "1 time stamp is".to_owned(),
        _ => format!("{count} time stamps are"),
    };
    Some(format!(
        "{stamps} in several consecutive rows of `{name}`, such as {stamp} in {} and {}: all rows are \
         kept; the first counts as the value just before a jump at that time, the others as values just \
         after it; if a row was recorded twice, remove one",
        column.place(*row),
        column.place(*next)
    ))
}

/// A sentence about inputs that change between rows of one time stamp, where most stamps have more rows
/// than the two of an event, or all repeat: replicates have the same inputs.
pub(super) fn truncated(
    name: &str,
    times: &[f64],
    (input, values): (&str, &[f64]),
) -> Option<String> {
    let stamps = || times.chunk_by(|a, b| a == b);
    let many = stamps().filter(|stamp| stamp.len() > 2).count();
    if 2 * many <= stamps().count() && !are_replicates(times) {
        return None;
    }
    let mut pairs = times.windows(2).zip(values.windows(2));
    let changes = pairs.any(|(t, u)| t[0] == t[1] && (u[1] - u[0]).abs() > 0.0);
    changes.then(|| {
        format!(
            "time stamps of `{name}` have several rows each, between which the input `{input}` changes: \
             these are not replicates, but times of a clock without seconds; write them with seconds"
        )
    })
}

/// A sentence about time stamps in whole minutes of which most have several rows, where no input shows
/// whether these are replicates.
pub(super) fn without_seconds(name: &str, times: &[f64]) -> Option<String> {
    const MINUTE: f64 = 60.0;
    let known: Vec<f64> = times.iter().copied().filter(|time| time.is_finite()).collect();
    let stamps: Vec<&[f64]> = known.chunk_by(|a, b| a == b).collect();
    let several = stamps.iter().filter(|stamp| stamp.len() > 1).count();
    let is_minute = |time: &f64| time.rem_euclid(MINUTE) == 0.0;
    let is_clock = stamps.len() > 1 && 2 * several > stamps.len() && known.iter().all(is_minute);
    let rows = stamps.iter().map(|stamp| stamp.len()).max()?;
    is_clock.then(|| {
        format!(
            "time stamps of `{name}` are whole minutes with up to {rows} rows each, which count as \
             measurements at one time; if the clock has no seconds, write the times with seconds"
        )
    })
}

/// Whether every time stamp repeats: then rows are replicates, not values before and after an event.
pub(super) fn are_replicates(times: &[f64]) -> bool {
    let known: Vec<f64> = times.iter().copied().filter(|time| time.is_finite()).collect();
    known.chunk_by(|a, b| a == b).all(|stamp| stamp.len() > 1)
}

/// The long steps between times that do not decrease.
pub(super) fn gaps(times: &[f64]) -> Vec<Gap> {
    let steps: Vec<(usize, f64)> = times
        .windows(2)
        .enumerate()
        .map(|(place, pair)| (place, pair[1] - pair[0]))
        .filter(|(_, step)| *step > 0.0)
        .collect();
    if steps.len() < FEWEST_STEPS {
        return Vec::new();
    }
    let lengths: Vec<f64> = steps.iter().map(|(_, step)| *step).collect();
    let usual = median(lengths.clone());
    let is_gap = |at: usize| {
        let around = at.saturating_sub(NEIGHBORS)..(at + NEIGHBORS + 1).min(lengths.len());
        let others: Vec<f64> = around.filter(|own| *own != at).map(|own| lengths[own]).collect();
        let beside = [at.checked_sub(1), Some(at + 1)].into_iter().flatten();
        let beside =
            beside.filter_map(|own| lengths.get(own)).copied().fold(f64::INFINITY, f64::min);
        lengths[at] > GAP * usual && lengths[at] > AROUND * median(others).max(beside)
    };
    let gap = |at: usize| Gap { place: steps[at].0, seconds: lengths[at], median: usual };
    (0..lengths.len()).filter(|at| is_gap(*at)).map(gap).collect()
}

/// The median of the steps between times that follow each other.
pub(super) fn usual_step(times: impl Iterator<Item = f64>) -> Option<f64> {
    let times: Vec<f64> = times.collect();
    let steps = times.windows(2).map(|pair| pair[1] - pair[0]).filter(|step| *step > 0.0);
    let steps: Vec<f64> = steps.collect();
    (!steps.is_empty()).then(|| median(steps))
}

/// The middle of numbers, the larger one of two.
fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::INFINITY)
}

/// Gaps in words; `place` names the row before one.
pub(super) fn listed(gaps: &[Gap], place: impl Fn(usize) -> String) -> String {
    let mut longest: Vec<&Gap> = gaps.iter().collect();
    longest.sort_by(|a, b| b.seconds.total_cmp(&a.seconds).then(a.place.cmp(&b.place)));
    let one = |gap: &&Gap| format!("{} after {}", length(gap.seconds), place(gap.place));
    let named: Vec<String> = longest.iter().take(NAMED).map(one).collect();
    let usual = gaps.first().map_or_else(String::new, |gap| length(gap.median));
    let more = match gaps.len().saturating_sub(NAMED) {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    let what = if gaps.len() == 1 { "a gap of" } else { &format!("{} gaps:", gaps.len()) };
    format!("{what} {}{more} (median step {usual})", named.join(", "))
}

/// A duration in seconds, and in the unit that suits it.
fn length(seconds: f64) -> String {
    let in_unit = [(86_400.0, "d"), (3600.0, "h"), (60.0, "min")]
        .into_iter()
        .find(|(unit, _)| seconds >= 2.0 * unit)
        .map(|(unit, name)| format!(" ({} {name})", rounded(seconds / unit)));
    format!("{} s{}", rounded(seconds), in_unit.unwrap_or_default())
}

fn rounded(value: f64) -> String {
    significant(value, 5)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_without_a_unit_are_said_to_be_read_in_seconds() {
        let noted = |text: &str, name: &str| {
            let table = crate::mat::read_csv(text.as_bytes()).unwrap();
            let (entry, mut notes) = (ColumnEntry::named(None), Notes::default());
            let column = table.column(name).unwrap();
            note_unit(name, &column, &entry, (&table, &mut notes));
            notes.into_notes().pop().map(|note| note.sentence)
        };
        let found = noted("Time,V\n0,1\n1,2\n", "Time").unwrap();
        assert!(found.contains("`Time` has no unit, and is read in seconds"), "{found}");
        assert_eq!(noted("Time [min],V\n0,1\n1,2\n", "Time"), None);
        assert!(noted("time,V\n0,1\n1,2\n", "time").is_some());
        let hours = noted("Hour,V\n0,1\n1,2\n", "Hour").unwrap();
        assert!(hours.contains("for hours, write") && hours.contains("unit = \"h\""), "{hours}");
        for (name, unit) in [("time_min", "min"), ("Elapsed minutes", "minutes"), ("t_ms", "ms")] {
            let found = noted(&format!("{name},V\n0,1\n1,2\n"), name).unwrap();
            let expected = format!(
                "the name suggests {unit}: write `x = {{ variable = \"time\", column = \
                                    \"{name}\", unit = \"{unit}\" }}`"
            );
            assert!(found.contains(&expected), "{found}");
        }
        assert_eq!(
            noted("Time [jiffies],V\n0,1\n1,2\n", "Time"),
            None,
            "the unit is named elsewhere"
        );
    }

    #[test]
    fn inputs_that_change_within_time_stamps_show_a_clock_without_seconds() {
        let minutes = [0.0, 0.0, 0.0, 60.0, 60.0, 60.0, 120.0];
        let current = ("I", &[0.0, 0.0, 1.0, 1.0, 1.0, 2.0, 2.0][..]);
        let found = truncated("Datum", &minutes, current).unwrap();
        assert!(found.contains("the input `I` changes"), "{found}");
        let same = ("I", &[0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 2.0][..]);
        assert_eq!(truncated("Datum", &minutes, same), None, "replicates");
        let found = without_seconds("Datum", &minutes).unwrap();
        assert!(found.contains("up to 3 rows each"), "{found}");
        assert_eq!(without_seconds("t", &[0.0, 60.0, 60.0, 120.0, 180.0]), None, "an event");
        assert_eq!(without_seconds("t", &[0.0, 0.0, 15.0, 15.0]), None, "seconds");
        let event = ("I", &[0.0, 0.0, 1.0, 1.0][..]);
        assert_eq!(truncated("t", &[0.0, 1.0, 1.0, 2.0], event), None, "an event");
    }

    #[test]
    fn a_year_in_quarters_of_an_hour_has_the_gap_that_was_made() {
        let year: Vec<f64> = (0..35_040).map(|k| f64::from(k) * 900.0).collect();
        assert!(gaps(&year).is_empty());
        let mut torn = year.clone();
        torn.drain(10_000..10_060);
        let found = gaps(&torn);
        assert_eq!(found, [Gap { place: 9999, seconds: 54_900.0, median: 900.0 }]);
        let words = listed(&found, |row| format!("row {}", row + 1));
        assert_eq!(
            words,
            "a gap of 54900 s (15.25 h) after row 10000 (median step 900 s (15 min))"
        );
    }

    #[test]
    fn other_rates_and_growing_steps_are_no_gaps() {
        let pulses: Vec<f64> = (0..200).map(f64::from).collect();
        let rests = (1..=60).map(|k| 199.0 + 60.0 * f64::from(k));
        let slower: Vec<f64> = pulses.iter().copied().chain(rests).collect();
        assert!(gaps(&slower).is_empty(), "{:?}", gaps(&slower));
        let growing: Vec<f64> = (0..40).map(|k| 2.0_f64.powi(k)).collect();
        assert!(gaps(&growing).is_empty());
        let events: Vec<f64> = (0..40).flat_map(|k| [f64::from(k); 2]).collect();
        assert!(gaps(&events).is_empty(), "steps of no length do not count");
    }
}
