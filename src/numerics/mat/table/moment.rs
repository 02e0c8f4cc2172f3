//! Dates and times of day, which become seconds.
//!
//! Read are ISO 8601 (`2024-03-05T23:59:59.5Z`), days first with points (`05.03.2024`), months by
//! name (`05-Mar-2024`), slashes where the column shows whether the day or the month is first, and
//! `hh:mm:ss` with any number of hours. Counted in whole nanoseconds, so that differences are exact.

use crate::diag::Fault;
use crate::fault;
use crate::mat::errors::BAD_TABLE;

const SECOND: i64 = 1_000_000_000;
const DAY: i64 = 86_400 * SECOND;

/// A date, a time of day, or both.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Moment {
    date: Option<Date>,
    /// Nanoseconds, and whether the seconds are written.
    clock: Option<(i64, bool)>,
}

/// Year, month and day; or two numbers of which one is the day and the other the month.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Date {
    Known([i64; 3]),
    Either { year: i64, first: i64, second: i64 },
}

/// What the first cell of a column of moments holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum MomentKind {
    Date,
    Clock,
    Both,
}

impl Moment {
    pub(crate) fn kind(self) -> MomentKind {
        match (self.date, self.clock) {
            (Some(_), Some(_)) => MomentKind::Both,
            (Some(_), None) => MomentKind::Date,
            _ => MomentKind::Clock,
        }
    }

    /// Whether it is a duration of more than a day. `24:00:00` is also the end of a day.
    fn is_elapsed(self) -> bool {
        self.date.is_none() && self.clock.is_some_and(|(nanoseconds, _)| nanoseconds > DAY)
    }
}

/// The moment that a cell holds.
pub(crate) fn moment(cell: &str) -> Option<Moment> {
    // Most cells are numbers; the longest moment has 35 characters.
    if cell.len() < 4 || cell.len() > 40 || !cell.is_ascii() {
        return None;
    }
    if !cell.starts_with(|c: char| c.is_ascii_digit()) {
        return None;
    }
    if let Some(clock) = clock(cell) {
        return Some(Moment { date: None, clock: Some(clock) });
    }
    if let Some(date) = date(cell) {
        return Some(Moment { date: Some(date), clock: None });
    }
    let (day, time) = cell.split_once(['T', ' '])?;
    let clock = clock(time.trim_start())?;
    Some(Moment { date: Some(date(day)?), clock: Some(clock) })
}

fn number(text: &str, most_digits: usize) -> Option<i64> {
    let digits =
        (1..=most_digits).contains(&text.len()) && text.bytes().all(|b| b.is_ascii_digit());
    if digits { text.parse().ok() } else { None }
}

fn date(text: &str) -> Option<Date> {
    let mark = text.chars().find(|c| matches!(c, '-' | '.' | '/'))?;
    let mut parts = text.split(mark);
    let (a, b, c) = (parts.next()?, parts.next()?, parts.next()?);
    if parts.next().is_some() {
        return None;
    }
    if a.len() == 4 {
        return known([number(a, 4)?, number(b, 2)?, number(c, 2)?]);
    }
    let year = match c.len() {
        4 => number(c, 4)?,
        2 => 2000 + number(c, 2)?,
        _ => return None,
    };
    let first = number(a, 2)?;
    if let Some(month) = month(b) {
        return known([year, month, first]);
    }
    let second = number(b, 2)?;
    if mark == '.' {
        return known([year, second, first]);
    }
    let possible = |n: i64| (1..=31).contains(&n);
    let either = possible(first) && possible(second) && first.min(second) <= 12;
    either.then_some(Date::Either { year, first, second })
}

fn known([year, month, day]: [i64; 3]) -> Option<Date> {
    let valid = (1..=12).contains(&month) && (1..=31).contains(&day);
    valid.then_some(Date::Known([year, month, day]))
}

fn month(text: &str) -> Option<i64> {
    const MONTHS: [&str; 12] =
        ["jan", "feb", "mar", "apr", "may", "jun", "jul", "aug", "sep", "oct", "nov", "dec"];
    let lower = text.to_ascii_lowercase();
    MONTHS.iter().position(|month| *month == lower).map(|place| place as i64 + 1)
}

/// Nanoseconds, and whether seconds are written.
fn clock(text: &str) -> Option<(i64, bool)> {
    let (text, zone) = without_zone(text)?;
    let (text, half) = half_of_day(text);
    let mut parts = text.split(':');
    let (first, second, third) = (parts.next()?, parts.next()?, parts.next());
    if parts.next().is_some() {
        return None;
    }
    let mut hours = number(first, 6)?;
    if let Some(afternoon) = half {
        if !(1..=12).contains(&hours) {
            return None;
        }
        hours = hours % 12 + if afternoon { 12 } else { 0 };
    }
    let Some(seconds) = third else {
        // `10:05.3` can only be minutes and seconds.
        if second.contains(['.', ',']) {
            return Some((hours * 60 * SECOND + fraction(second)?, true));
        }
        let minutes = number(second, 2).filter(|n| *n < 60)?;
        return Some(((hours * 60 + minutes) * 60 * SECOND - zone, half.is_some()));
    };
    let minutes = number(second, 2).filter(|n| *n < 60)?;
    Some(((hours * 60 + minutes) * 60 * SECOND + fraction(seconds)? - zone, true))
}

/// Seconds with a decimal point or comma, below 61.
fn fraction(text: &str) -> Option<i64> {
    let (whole, decimals) = text.split_once(['.', ',']).unwrap_or((text, ""));
    let whole = number(whole, 2).filter(|n| *n <= 60)?;
    if decimals.is_empty() {
        return (!text.ends_with(['.', ','])).then_some(whole * SECOND);
    }
    let nine: String = decimals.chars().chain("000000000".chars()).take(9).collect();
    number(decimals, 20)?;
    Some(whole * SECOND + number(&nine, 9)?)
}

/// The text before `Z` or `+01:00`, and the zone's nanoseconds.
fn without_zone(text: &str) -> Option<(&str, i64)> {
    if let Some(rest) = text.strip_suffix(['Z', 'z']) {
        return Some((rest, 0));
    }
    let Some(at) = text.rfind(['+', '-']) else { return Some((text, 0)) };
    let sign = if text[at..].starts_with('+') { 1 } else { -1 };
    let digits = text[at + 1..].replace(':', "");
    let hours = number(digits.get(..2)?, 2)?;
    let minutes =
        digits.get(2..).filter(|rest| !rest.is_empty()).map_or(Some(0), |m| number(m, 2))?;
    Some((&text[..at], sign * (hours * 60 + minutes) * 60 * SECOND))
}

/// The text before `AM` or `PM`, and which it is.
fn half_of_day(text: &str) -> (&str, Option<bool>) {
    let lower = text.to_ascii_lowercase();
    let half =
        if lower.ends_with("pm") { Some(true) } else { lower.ends_with("am").then_some(false) };
    match half {
        Some(_) => (text[..text.len() - 2].trim_end(), half),
        None => (text, None),
    }
}

/// Days since 1970-01-01 (the algorithm of H. Hinnant, "chrono-compatible low-level date
/// algorithms", 2021).
fn days([year, month, day]: [i64; 3]) -> i64 {
    let year = if month <= 2 { year - 1 } else { year };
    let era = year.div_euclid(400);
    let of_era = year.rem_euclid(400);
    let of_year = (153 * ((month + 9) % 12) + 2) / 5 + day - 1;
    era * 146_097 + of_era * 365 + of_era / 4 - of_era / 100 + of_year - 719_468
}

/// A date and time of day from days since 1970-01-01, to hundredths of a millisecond.
pub(in crate::mat) fn iso(days: f64) -> String {
    let parts = (days * 86_400.0 * 1e5).round() as i64;
    let (day, rest) = (parts.div_euclid(8_640_000_000), parts.rem_euclid(8_640_000_000));
    let [year, month, date] = civil(day);
    format!("{year:04}-{month:02}-{date:02}T{}", clock_of(rest))
}

/// Hours, minutes and seconds from days, to hundredths of a millisecond.
pub(in crate::mat) fn duration(days: f64) -> String {
    clock_of((days * 86_400.0 * 1e5).round() as i64)
}

fn clock_of(parts: i64) -> String {
    let (seconds, rest) = (parts / 100_000, parts % 100_000);
    format!("{}:{:02}:{:02}.{rest:05}", seconds / 3600, seconds / 60 % 60, seconds % 60)
}

/// The inverse of [`days`], by the same source.
fn civil(days: i64) -> [i64; 3] {
    let days = days + 719_468;
    let (era, of_era) = (days.div_euclid(146_097), days.rem_euclid(146_097));
    let year = (of_era - of_era / 1460 + of_era / 36_524 - of_era / 146_096) / 365;
    let of_year = of_era - (365 * year + year / 4 - year / 100);
    let month = (5 * of_year + 2) / 153;
    let date = of_year - (153 * month + 2) / 5 + 1;
    let month = if month < 10 { month + 3 } else { month - 9 };
    [year + era * 400 + i64::from(month <= 2), month, date]
}

/// What moments of a column mean as seconds.
pub(crate) struct Seconds {
    /// NaN where there is none.
    pub values: Vec<f64>,
    /// From what they were made, as the end of a sentence about the column.
    pub meaning: String,
}

/// Moments of a column as seconds. Dates count from the first point; clocks without a date as they
/// are, unless they show the time of a day. `dates` are of another column, `hint` is the name of
/// the column with its unit, `cell` names a cell of the dates by its row.
pub(crate) fn seconds(
    moments: &[Option<Moment>],
    dates: Option<&[Option<Moment>]>,
    hint: &str,
    cell: &dyn Fn(usize) -> String,
) -> Result<Seconds, Fault> {
    let day_first = order(dates.unwrap_or(moments), cell)?;
    // Nanoseconds since the year 0: dates after the year 2262 exceed 64 bits.
    let mut found: Vec<Option<i128>> = Vec::with_capacity(moments.len());
    let mut passes_midnight = false;
    let mut is_dated = false;
    let is_elapsed = dates.is_none() && moments.iter().flatten().any(|own| own.is_elapsed());
    let (mut added, mut before) = (0_i128, None);
    for (row, moment) in moments.iter().enumerate() {
        let Some(moment) = moment else {
            found.push(None);
            continue;
        };
        let clock = match moment.clock {
            Some((nanoseconds, true)) => nanoseconds,
            Some((nanoseconds, false)) => {
                minutes(nanoseconds, moment.date.is_some() || dates.is_some(), hint)?
            }
            None => 0,
        };
        let date = match dates {
            Some(dates) => dates.get(row).copied().flatten().and_then(|moment| moment.date),
            None => moment.date,
        };
        if let Some(date) = date {
            is_dated = true;
            let days = i128::from(days(resolved(date, day_first)));
            found.push(Some(days * i128::from(DAY) + i128::from(clock)));
            continue;
        }
        // From late in the evening to early in the morning: the next day.
        let is_back = before.is_some_and(|before: i64| before - clock > DAY / 2);
        if is_back && clock < DAY && !is_elapsed {
            added += i128::from(DAY);
            passes_midnight = true;
        }
        before = Some(clock);
        found.push(Some(i128::from(clock) + added));
    }
    let changes = if is_dated { daylight_saving(&mut found) } else { String::new() };
    let first = found.iter().flatten().next().copied().unwrap_or(0);
    let last = found.iter().flatten().next_back().copied().unwrap_or(0);
    // A log that begins later than it lasts shows the time of day.
    let since_first =
        is_dated || passes_midnight || (first >= i128::from(3600 * SECOND) && last - first < first);
    let origin = if since_first { first } else { 0 };
    let values = found.iter().map(|n| n.map_or(f64::NAN, |n| (n - origin) as f64 / 1e9)).collect();
    let origin = is_elapsed.then_some(origin);
    let midnight = if passes_midnight { ", across midnight" } else { "" };
    let what = meaning(is_dated, since_first, origin);
    Ok(Seconds { values, meaning: format!("{what}{midnight}{changes}") })
}

/// What moments are read as; `elapsed`, in nanoseconds, is where durations of more than a day begin.
fn meaning(is_dated: bool, since_first: bool, elapsed: Option<i128>) -> String {
    let what = match (is_dated, since_first, elapsed) {
        (true, ..) => "dates and times, read as seconds since the first point",
        (false, true, Some(first)) => {
            let first = first as f64 / 1e9;
            return format!(
                "durations, read as seconds since the first point, which is {first} s after their zero"
            );
        }
        (false, true, None) => "times of day, read as seconds since the first point",
        (false, false, _) => "hours, minutes and seconds, read as seconds",
    };
    what.to_owned()
}

/// Counts on where a local clock is set forward or back by an hour: at night on a Sunday, where the
/// step is an hour longer or shorter than the median one. Returns where, as the end of a sentence.
fn daylight_saving(found: &mut [Option<i128>]) -> String {
    let (hour, day) = (i128::from(3600 * SECOND), i128::from(DAY));
    let known: Vec<(usize, i128)> =
        found.iter().enumerate().filter_map(|(row, time)| Some((row, (*time)?))).collect();
    let mut steps: Vec<i128> = known.windows(2).map(|pair| pair[1].1 - pair[0].1).collect();
    steps.sort_unstable();
    let Some(&usual) = steps.get(steps.len() / 2).filter(|usual| **usual > 0) else {
        return String::new();
    };
    // 1970-01-01 was a Thursday.
    let is_sunday_night =
        |time: i128| (time.div_euclid(day) + 4) % 7 == 0 && time.rem_euclid(day) <= 4 * hour;
    let (mut added, mut words) = (0, String::new());
    for pair in known.windows(2) {
        let [(row, before), (next, after)] = pair else { continue };
        let excess = after - before - usual;
        let is_change = (excess.abs() - hour).abs() <= usual / 10;
        if is_change && is_sunday_night(*before) && is_sunday_night(*after) {
            added -= excess.signum() * hour;
            let way = if excess > 0 { "forward" } else { "back" };
            words += &format!("; the clock is set {way} by an hour after row {}", row + 1);
        }
        found[*next] = Some(after + added);
    }
    match words.is_empty() {
        true => words,
        false => words + " (daylight saving time), and the seconds count on",
    }
}

/// A clock of two parts: hours and minutes where it belongs to a date or the head says so.
fn minutes(nanoseconds: i64, is_dated: bool, name: &str) -> Result<i64, Fault> {
    let hint = name.to_lowercase();
    if is_dated || hint.contains("h:mm") || hint.contains("hh:mm") {
        return Ok(nanoseconds);
    }
    if hint.contains("m:ss") {
        return Ok(nanoseconds / 60);
    }
    Err(fault!(
        BAD_TABLE,
        "column `{name}`: the times are ambiguous: hours and minutes, or minutes and seconds"
    )
    .help("write hh:mm:ss, or give the unit in the header: `time [hh:mm]` or `time [mm:ss]`"))
}

/// Whether the day is first where two numbers could be it; what the dates do not show is refused
/// unless it does not matter. `cell` names a cell by its row.
fn order(moments: &[Option<Moment>], cell: &dyn Fn(usize) -> String) -> Result<bool, Fault> {
    let either = |(row, moment): (usize, &Option<Moment>)| match moment.as_ref()?.date? {
        Date::Either { year, first, second } => Some((row, [year, first, second])),
        Date::Known(_) => None,
    };
    let dates = || moments.iter().enumerate().filter_map(either);
    let Some((row, one)) = dates().next() else { return Ok(true) };
    let day_first = dates().find(|(_, date)| date[1] > 12);
    let month_first = dates().find(|(_, date)| date[2] > 12);
    let fault = match (day_first, month_first) {
        (Some(_), None) => return Ok(true),
        (None, Some(_)) => return Ok(false),
        (None, None) if dates().all(|(_, date)| date == one) => return Ok(true),
        (None, None) => {
            let [year, first, second] = one;
            fault!(
                BAD_TABLE,
                "{} is ambiguous: {year}-{second:02}-{first:02} with the day first, \
                 {year}-{first:02}-{second:02} with the month first",
                cell(row)
            )
        }
        (Some((day, _)), Some((month, _))) => fault!(
            BAD_TABLE,
            "the dates are ambiguous: {} has the day first, {} the month",
            cell(day),
            cell(month)
        ),
    };
    Err(fault.help("write all dates of the column as 2024-03-05, or with points as 05.03.2024"))
}

fn resolved(date: Date, day_first: bool) -> [i64; 3] {
    match date {
        Date::Known(date) => date,
        Date::Either { year, first, second } if day_first => [year, second, first],
        Date::Either { year, first, second } => [year, first, second],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(cells: &[&str]) -> Result<(Vec<f64>, String), String> {
        let moments: Vec<_> = cells.iter().map(|cell| moment(cell)).collect();
        assert!(moments.iter().all(Option::is_some), "{cells:?}");
        seconds(&moments, None, "t", &|row| format!("row {row}"))
            .map(|s| (s.values, s.meaning))
            .map_err(|fault| fault.message)
    }

    #[test]
    fn dates_count_from_the_first_point() {
        for cells in [
            ["2024-02-28T23:59:59.250", "2024-02-29 00:00:00.5", "2024-03-01T00:00:00Z"],
            ["28.02.2024 23:59:59,25", "29.02.2024 00:00:00,5", "01.03.2024 00:00:00"],
            ["28-Feb-2024 23:59:59.25", "29-Feb-2024 00:00:00.5", "01-Mar-2024 00:00:00"],
            ["2/28/2024 11:59:59.25 PM", "2/29/2024 12:00:00.5 AM", "3/1/2024 12:00:00 am"],
            ["2024-02-29T00:59:59.25+01:00", "2024-02-29T00:00:00.5Z", "2024-02-29T19:00:00-05:00"],
        ] {
            let (values, meaning) = of(&cells).unwrap();
            assert_eq!(values, [0.0, 1.25, 86_400.75], "{cells:?}");
            assert!(meaning.contains("since the first point"));
        }
    }

    #[test]
    fn clocks() {
        assert_eq!(of(&["0:00:00", "0:30:00", "25:00:00"]).unwrap().0, [0.0, 1800.0, 90_000.0]);
        assert_eq!(of(&["0:00:10", "0:00:20"]).unwrap().0, [10.0, 20.0]);
        let (values, meaning) = of(&["25:00:00", "25:00:05", "25:00:10.5"]).unwrap();
        assert_eq!(values, [0.0, 5.0, 10.5]);
        let durations =
            "durations, read as seconds since the first point, which is 90000 s after their zero";
        assert_eq!(meaning, durations);
        assert!(of(&["23:00:00", "24:00:00"]).unwrap().1.starts_with("times of day"));
        assert_eq!(of(&["23:59:59.5", "00:00:00.25"]).unwrap().0, [0.0, 0.75]);
        assert_eq!(of(&["10:12:01", "10:12:02.1"]).unwrap().0, [0.0, 1.1]);
        assert!(of(&["10:05", "10:06"]).unwrap_err().contains("hours and minutes"));
        assert_eq!(of(&["1:05.5", "2:00.0"]).unwrap().0, [65.5, 120.0]);
    }

    #[test]
    fn seconds_count_on_where_the_clock_is_changed() {
        // Berlin in quarters of an hour, New York in hours.
        let back = ["2024-10-27 02:30", "2024-10-27 02:45", "2024-10-27 02:00", "2024-10-27 02:15"];
        let (values, meaning) = of(&back).unwrap();
        assert_eq!(values, [0.0, 900.0, 1800.0, 2700.0]);
        assert!(meaning.contains("the clock is set back by an hour after row 2"), "{meaning}");
        let forward =
            ["2024-03-10 00:00", "2024-03-10 01:00", "2024-03-10 03:00", "2024-03-10 04:00"];
        assert_eq!(of(&forward).unwrap().0, [0.0, 3600.0, 7200.0, 10_800.0]);
        let twice =
            ["2024-11-03 00:00", "2024-11-03 01:00", "2024-11-03 01:00", "2024-11-03 02:00"];
        assert_eq!(of(&twice).unwrap().0, [0.0, 3600.0, 7200.0, 10_800.0]);
        // On a Monday an hour is missing.
        let gap = ["2024-04-01 01:30", "2024-04-01 01:45", "2024-04-01 03:00", "2024-04-01 03:15"];
        assert_eq!(of(&gap).unwrap().0, [0.0, 900.0, 5400.0, 6300.0]);
    }

    #[test]
    fn what_the_column_does_not_show_is_refused() {
        assert!(of(&["3/4/2024 1:00:00", "3/5/2024 1:00:00"]).unwrap_err().contains(
            "row 0 is ambiguous: 2024-04-03 with the day first, 2024-03-04 with the month first"
        ));
        let both = of(&["13/1/2024", "1/13/2024"]).unwrap_err();
        assert!(both.contains("row 0 has the day first, row 1 the month"), "{both}");
        assert_eq!(of(&["3/4/2024 1:00:00", "3/4/2024 1:00:01"]).unwrap().0, [0.0, 1.0]);
        assert_eq!(of(&["31/1/2024", "1/2/2024"]).unwrap().0, [0.0, 86_400.0]);
    }

    #[test]
    fn other_cells_are_not_moments() {
        for cell in ["1.5", "12", "1-2", "rest", "1:2:3:4", "2024-13-01", "10:61:00", "1e-5", "a:b"]
        {
            assert_eq!(moment(cell), None, "{cell}");
        }
    }
}
