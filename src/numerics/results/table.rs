//! Results in memory.

use super::errors::{BAD_RESULT_TABLE, OUTSIDE_RESULTS, UNKNOWN_RESULT_VARIABLE};
use crate::budget::has_memory;
use crate::diag::{Fault, suggest};
use crate::{bail, fault};
use std::collections::HashSet;

/// The results of one simulation. Time does not decrease; an event is two points with equal time,
/// the values before and after it.
///
/// ```
/// use gapilib_numerics::results::{ResultTable, Series, Values};
///
/// let mut table = ResultTable::new(vec![0.0, 1.0]);
/// table.series.push(Series {
///     name: "x".to_owned(),
///     unit: "V".to_owned(),
///     description: String::new(),
///     values: Values::Trajectory(vec![2.0, 4.0]),
/// });
/// assert_eq!(table.column("x").unwrap(), [2.0, 4.0]);
/// assert_eq!(table.interpolate("x", &[0.5]).unwrap(), [3.0]);
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct ResultTable {
    /// The name of time: `time`, or `Time` as some programs write it.
    pub time_name: String,
    /// Time points, seconds.
    pub time: Vec<f64>,
    /// The variables; their names differ from each other and from `time_name`.
    pub series: Vec<Series>,
}

/// One variable.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    /// Its name, such as `cell.v`.
    pub name: String,
    /// Its unit, empty if none.
    pub unit: String,
    /// Its description, empty if none.
    pub description: String,
    /// Its values.
    pub values: Values,
}

/// The values of a variable.
#[derive(Debug, Clone, PartialEq)]
pub enum Values {
    /// The same at every point in time: parameters and constants.
    Constant(f64),
    /// One value per point in time.
    Trajectory(Vec<f64>),
    /// The values of another series, which is not an alias itself.
    Alias {
        /// Its place in [`ResultTable::series`].
        of: usize,
        /// Whether the sign differs.
        negated: bool,
    },
}

impl ResultTable {
    /// A fault where there is no memory for a file with so many bytes for each value.
    pub(super) fn has_room(&self, bytes: usize) -> Result<(), Fault> {
        let count = self.time.len().saturating_mul(self.series.len() + 1);
        if has_memory(count.saturating_mul(bytes)) {
            return Ok(());
        }
        Err(fault!(BAD_RESULT_TABLE, "there is no memory for a result file with {count} values";
            help: "select variables or use fewer intervals, or write `.csv`, which needs less"))
    }
}

impl Values {
    /// The same with the other sign if `negated`; aliases of other series stay as they are.
    pub fn with_sign(mut self, negated: bool) -> Values {
        match &mut self {
            _ if !negated => {}
            Values::Constant(value) => *value = -*value,
            Values::Trajectory(values) => values.iter_mut().for_each(|value| *value = -*value),
            Values::Alias { .. } => {}
        }
        self
    }
}

impl Series {
    /// A variable without unit and description.
    pub fn new(name: impl Into<String>, values: Values) -> Series {
        Series { name: name.into(), unit: String::new(), description: String::new(), values }
    }
}

impl ResultTable {
    /// Results without variables; the name of time is `time`.
    pub fn new(time: Vec<f64>) -> ResultTable {
        ResultTable { time_name: "time".to_owned(), time, series: Vec::new() }
    }

    /// All names, time first.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        std::iter::once(&*self.time_name).chain(self.series.iter().map(|series| &*series.name))
    }

    /// The values of a variable, one per point in time. `time` and `Time` both name time; blanks
    /// in names do not count.
    pub fn column(&self, name: &str) -> Result<Vec<f64>, Fault> {
        if let Some(values) = self.column_like(name) {
            return Ok(values);
        }
        if name == self.time_name || name == "time" || name == "Time" {
            return Ok(self.time.clone());
        }
        Err(fault!(UNKNOWN_RESULT_VARIABLE, "the results contain no variable `{name}`")
            .help_if(suggest::did_you_mean(name, self.names())))
    }

    /// The values of the variable of this name, blanks in names aside, one per point in time.
    pub(super) fn column_like(&self, name: &str) -> Option<Vec<f64>> {
        let is_same = |other: &str| {
            let letters = |text: &'_ str| text.replace(char::is_whitespace, "");
            other == name || letters(other) == letters(name)
        };
        let exact = self.series.iter().position(|series| series.name == name);
        let index = exact.or_else(|| self.series.iter().position(|s| is_same(&s.name)))?;
        Some(self.expand(index))
    }

    /// The values of the variable at this place, one per point in time.
    pub(super) fn expand(&self, index: usize) -> Vec<f64> {
        let (target, sign) = self.resolve(index);
        match &self.series[target].values {
            Values::Constant(value) => vec![sign * value; self.time.len()],
            Values::Trajectory(values) => values.iter().map(|value| sign * value).collect(),
            Values::Alias { .. } => unreachable!("`resolve` ends at a series that is not an alias"),
        }
    }

    /// Removes the variables whose names are not to be kept; others that are aliases of them hold the
    /// values themselves.
    pub fn retain(&mut self, keep: impl Fn(&str) -> bool) {
        if self.series.iter().all(|series| keep(&series.name)) {
            return;
        }
        let all = std::mem::take(&mut self.series);
        // Where the values of each series stand among those that are kept, and with which sign.
        let mut homes: Vec<Option<(usize, bool)>> = vec![None; all.len()];
        for (at, series) in all.iter().enumerate().filter(|(_, series)| keep(&series.name)) {
            let (of, negated) = match series.values {
                Values::Alias { of, negated } => (of, negated),
                _ => (at, false),
            };
            let values = match homes[of] {
                Some((home, sign)) => Values::Alias { of: home, negated: sign != negated },
                None => {
                    homes[of] = Some((self.series.len(), negated));
                    all[of].values.clone().with_sign(negated)
                }
            };
            self.series.push(Series { values, ..series.clone() });
        }
    }

    /// The series that holds the values, and the sign they take; the index itself unless an alias.
    /// Panics if an alias leads to an alias, which [`ResultTable::check`] refuses.
    pub(super) fn resolve(&self, index: usize) -> (usize, f64) {
        match self.series[index].values {
            Values::Alias { of, negated } => {
                let is_alias = matches!(self.series[of].values, Values::Alias { .. });
                assert!(!is_alias, "an alias refers to a series with values");
                (of, if negated { -1.0 } else { 1.0 })
            }
            _ => (index, 1.0),
        }
    }

    /// Keeps the rows at these times, ascending; of several rows of one time the last, which has the
    /// values after its events.
    pub fn keep_times(&mut self, times: &[f64]) {
        let is_last = |row: usize| self.time.get(row + 1).is_none_or(|next| *next > self.time[row]);
        let is_selected = |row: usize| {
            times.binary_search_by(|time| time.total_cmp(&self.time[row])).is_ok() && is_last(row)
        };
        let rows: Vec<usize> = (0..self.time.len()).filter(|&row| is_selected(row)).collect();
        for series in &mut self.series {
            if let Values::Trajectory(values) = &mut series.values {
                *values = rows.iter().map(|&row| values[row]).collect();
            }
        }
        self.time = rows.iter().map(|&row| self.time[row]).collect();
    }

    /// The values of a variable at these times, interpolated linearly; at an event the value after
    /// it. A time outside the results is a fault.
    pub fn interpolate(&self, name: &str, times: &[f64]) -> Result<Vec<f64>, Fault> {
        let values = self.column(name)?;
        times.iter().map(|time| self.interpolate_at(name, &values, *time)).collect()
    }

    fn interpolate_at(&self, name: &str, values: &[f64], time: f64) -> Result<f64, Fault> {
        let after = self.time.partition_point(|t| *t <= time);
        match (after.checked_sub(1), self.time.get(after)) {
            (Some(before), _) if self.time[before] == time => Ok(values[before]),
            (Some(before), Some(next)) => {
                let share = (time - self.time[before]) / (next - self.time[before]);
                Ok(values[before] + share * (values[after] - values[before]))
            }
            _ => {
                let (first, last) = (self.time.first(), self.time.last());
                let range = first.zip(last).map_or("are empty".to_owned(), |(first, last)| {
                    format!("go from {first} to {last}")
                });
                bail!(OUTSIDE_RESULTS, "`{name}` at time {time}: the results {range}")
            }
        }
    }

    /// The variables whose names satisfy `is_selected`; aliases of others keep copies of their
    /// values.
    #[must_use]
    pub fn only(&self, is_selected: impl Fn(&str) -> bool) -> ResultTable {
        let kept = self.series.iter().enumerate().filter(|(_, series)| is_selected(&series.name));
        let series = kept.map(|(index, series)| {
            let values = match &series.values {
                Values::Alias { of, .. } => match self.series[*of].values {
                    Values::Constant(_) => {
                        Values::Constant(self.expand(index).first().copied().unwrap_or(0.0))
                    }
                    _ => Values::Trajectory(self.expand(index)),
                },
                values => values.clone(),
            };
            Series { values, ..series.clone() }
        });
        let time = self.time.clone();
        ResultTable { time_name: self.time_name.clone(), time, series: series.collect() }
    }

    /// A fault unless the table is what its documentation promises.
    pub fn check(&self) -> Result<(), Fault> {
        let points = self.time.len();
        if !self.time.is_sorted() || self.time.iter().any(|time| time.is_nan()) {
            bail!(BAD_RESULT_TABLE, "time decreases or is not a number");
        }
        let mut names = HashSet::from([&*self.time_name]);
        for series in &self.series {
            let name = &*series.name;
            if !names.insert(name) {
                bail!(BAD_RESULT_TABLE, "two variables are named `{name}`");
            }
            match &series.values {
                Values::Trajectory(values) if values.len() != points => {
                    let found = values.len();
                    bail!(BAD_RESULT_TABLE, "`{name}` has {found} values at {points} time points");
                }
                Values::Alias { of, .. } => match self.series.get(*of) {
                    Some(Series { values: Values::Alias { .. }, .. }) | None => {
                        bail!(BAD_RESULT_TABLE, "`{name}` is an alias of a variable without values")
                    }
                    Some(_) => {}
                },
                _ => {}
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn aliases_of_removed_variables_hold_their_values() {
        let mut table = ResultTable::new(vec![0.0, 1.0]);
        let alias = |negated| Values::Alias { of: 0, negated };
        for (name, values) in [
            ("own", Values::Trajectory(vec![2.0, 4.0])),
            ("minus", alias(true)),
            ("plus", alias(false)),
            ("constant", Values::Constant(7.0)),
        ] {
            table.series.push(Series::new(name, values));
        }
        table.retain(|name| name != "own");
        assert_eq!(table.names().collect::<Vec<_>>(), ["time", "minus", "plus", "constant"]);
        assert_eq!(table.column("minus").unwrap(), [-2.0, -4.0]);
        assert_eq!(table.column("plus").unwrap(), [2.0, 4.0]);
        assert_eq!(table.column("constant").unwrap(), [7.0, 7.0]);
        table.check().unwrap();
    }
}
