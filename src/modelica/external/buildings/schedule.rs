//! A weekly schedule, as `IBPSA.Utilities.IO.Files.WeeklySchedule` documents it: values that change
//! at given times of the week and stay until the next change, with a period of one week.
//!
//! ```text
//! # a comment
//! mon,tue:7:00:00  1  -
//! sat,sun          0  3
//! ```
//!
//! `-` leaves the value of a column as it is; a column without any value is 0.

const DAY: f64 = 86_400.0;
const WEEK: f64 = 7.0 * DAY;
const DAYS: [&str; 7] = ["mon", "tue", "wed", "thu", "fri", "sat", "sun"];

/// A schedule that was read.
pub(crate) struct Schedule {
    /// When Monday begins, in seconds.
    offset: f64,
    /// The changes of each column: seconds since Monday, value; ascending.
    columns: Vec<Vec<(f64, f64)>>,
}

impl Schedule {
    /// Reads a schedule; Monday begins at `offset`.
    pub(crate) fn read(text: &str, offset: f64) -> Result<Schedule, String> {
        let mut columns: Vec<Vec<(f64, f64)>> = Vec::new();
        for (number, line) in text.lines().enumerate() {
            let mut words = line.split_whitespace();
            let Some(first) = words.next() else { continue };
            if first.starts_with('#') || first == "double" {
                continue;
            }
            let wrong = |why: String| format!("line {} of the schedule {why}", number + 1);
            let times = times(first).map_err(wrong)?;
            let values: Vec<&str> = words.collect();
            if columns.is_empty() {
                columns = vec![Vec::new(); values.len()];
            }
            if values.is_empty() || values.len() != columns.len() {
                return Err(wrong(format!(
                    "has {} values, but {} are expected",
                    values.len(),
                    columns.len().max(1)
                )));
            }
            for (column, word) in columns.iter_mut().zip(values).filter(|(_, word)| *word != "-") {
                let value: f64 =
                    word.parse().map_err(|_| wrong(format!("has `{word}` for a number")))?;
                column.extend(times.iter().map(|time| (*time, value)));
            }
        }
        for column in &mut columns {
            // Of two changes at the same time the one written last holds.
            column.sort_by(|a, b| a.0.total_cmp(&b.0));
            if column.is_empty() {
                // As in the library's reference results.
                column.push((0.0, 0.0));
            }
        }
        match columns.is_empty() {
            true => Err("the schedule is empty".to_owned()),
            false => Ok(Schedule { offset, columns }),
        }
    }

    /// The value of a column (from 1) at a time.
    pub(crate) fn value(&self, column: i64, time: f64) -> Option<f64> {
        let column = self.columns.get(usize::try_from(column - 1).ok()?)?;
        let time = (time - self.offset).rem_euclid(WEEK);
        let after = column.partition_point(|(change, _)| *change <= time);
        // Before the first change the last one of the week before holds.
        let change = after.checked_sub(1).unwrap_or(column.len() - 1);
        Some(column[change].1)
    }
}

/// `mon,tue:7:30:00`: seconds since the beginning of Monday.
fn times(word: &str) -> Result<Vec<f64>, String> {
    let mut parts = word.split(':');
    let days = parts.next().unwrap_or_default();
    let mut seconds = 0.0;
    for (part, (unit, limit)) in parts.zip([(3600.0, 24.0), (60.0, 60.0), (1.0, 60.0), (0.0, 0.0)])
    {
        let number: f64 = part.parse().map_err(|_| format!("has the time `{word}`"))?;
        if !(0.0..limit).contains(&number) {
            return Err(format!("has the time `{word}`"));
        }
        seconds += number * unit;
    }
    let of_day = |day: &str| match DAYS.iter().position(|known| *known == day) {
        Some(at) => Ok(at as f64 * DAY + seconds),
        None => Err(format!("has the day `{day}`; days are {}", DAYS.join(", "))),
    };
    days.split(',').map(of_day).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str =
        "double tab1(3,3)\n# comment\nmon:0:0:10 - 3\ntue,thu:20:30:59 123 -\nwed 12 1";

    #[test]
    fn values_hold_until_the_next_change_and_around_the_week() {
        let schedule = Schedule::read(TEXT, 100.0).expect("it is well formed");
        let at = |column, seconds: f64| schedule.value(column, 100.0 + seconds);
        assert_eq!(at(1, 0.0), Some(123.0));
        assert_eq!(at(2, 0.0), Some(1.0));
        assert_eq!(at(2, 10.0), Some(3.0));
        assert_eq!(at(1, 2.0 * DAY), Some(12.0));
        assert_eq!(at(1, 3.0 * DAY + 20.0 * 3600.0 + 30.0 * 60.0 + 58.9), Some(12.0));
        assert_eq!(at(1, 3.0 * DAY + 20.0 * 3600.0 + 30.0 * 60.0 + 59.0), Some(123.0));
        assert_eq!(at(1, 2.5 * DAY - 5.0 * WEEK), Some(12.0));
        assert_eq!(at(3, 0.0), None);
        let empty = Schedule::read("mon - 1", 0.0).expect("it is well formed");
        assert_eq!(empty.value(1, 5.0), Some(0.0));
    }

    #[test]
    fn what_is_not_understood_is_refused_with_its_line() {
        let refused = |text| Schedule::read(text, 0.0).err().expect("it is wrong");
        assert!(refused("mon 1\nmoon 2").starts_with("line 2"));
        assert!(refused("mon:25 1").contains("`mon:25`"));
        assert!(refused("mon 1 2\ntue 1").contains("has 1 values"));
        assert!(refused("# nothing").contains("empty"));
    }
}
