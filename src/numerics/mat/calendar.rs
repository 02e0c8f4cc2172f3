//! Numbers that count time from a date: Unix times, day numbers of Excel and MATLAB. Recognized by
//! their size: from the year 2000 to the year 2100.

/// What numbers count that stand for dates and times.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Calendar {
    /// What they are, in the plural.
    pub name: &'static str,
    /// Seconds of one count.
    pub seconds: f64,
    /// Whether nothing else has such numbers. An experiment may begin after 45,000 s, but not after
    /// thirty years.
    pub is_certain: bool,
    range: [f64; 2],
    /// Differences are rounded to whole fractions of a second of which there are so many: the
    /// numbers have no more digits.
    fractions: f64,
}

const CALENDARS: [Calendar; 6] = [
    unix("Unix times", 1.0, [9.466848e8, 4.1025e9], 1e6),
    unix("Unix times in milliseconds", 1e-3, [9.466848e11, 4.1025e12], 1e6),
    unix("Unix times in microseconds", 1e-6, [9.466848e14, 4.1025e15], 1e6),
    unix("Unix times in nanoseconds", 1e-9, [9.466848e17, 4.1025e18], 1e6),
    days("day numbers of Excel", [36_526.0, 73_415.0]),
    days("day numbers of MATLAB", [730_486.0, 767_376.0]),
];

const fn unix(name: &'static str, seconds: f64, range: [f64; 2], fractions: f64) -> Calendar {
    Calendar { name, seconds, is_certain: true, range, fractions }
}

const fn days(name: &'static str, range: [f64; 2]) -> Calendar {
    Calendar { name, seconds: 86_400.0, is_certain: false, range, fractions: 1e4 }
}

/// The calendar in whose range all values are, and do not span more than they are away from its
/// beginning; `None` for fewer than two values.
pub fn calendar(values: &[f64]) -> Option<Calendar> {
    let finite = || values.iter().copied().filter(|value| value.is_finite());
    let (low, high) =
        (finite().fold(f64::INFINITY, f64::min), finite().fold(f64::NEG_INFINITY, f64::max));
    let holds = |own: &&Calendar| own.range[0] <= low && low < high && high <= own.range[1];
    CALENDARS.iter().find(holds).copied()
}

impl Calendar {
    /// Seconds from one number to another.
    pub fn seconds_since(&self, origin: f64, value: f64) -> f64 {
        ((value - origin) * self.seconds * self.fractions).round() / self.fractions
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn seconds(values: &[f64]) -> Vec<f64> {
        let calendar = calendar(values).unwrap();
        values.iter().map(|value| calendar.seconds_since(values[0], *value)).collect()
    }

    #[test]
    fn seconds_since_the_first_point_are_those_of_the_dates() {
        assert_eq!(
            seconds(&[1_700_000_000.0, 1_700_000_000.1, 1_700_003_600.0]),
            [0.0, 0.1, 3600.0]
        );
        assert_eq!(seconds(&[1_700_000_000_000.0, 1_700_000_000_100.0]), [0.0, 0.1]);
        // 2024-03-05 12:00:00, 12:15:00 and 12:00:01.5 as ten digits show them.
        assert_eq!(seconds(&[45356.5, 45356.5104166667, 45356.50001736111]), [0.0, 900.0, 1.5]);
        assert_eq!(seconds(&[739_316.5, 739_316.510_416_666_6]), [0.0, 900.0]);
    }

    #[test]
    fn other_numbers_count_from_no_date() {
        for values in [&[0.0, 1e9][..], &[1.7e9], &[5000.0, 5001.0], &[f64::NAN], &[1e20, 2e20]] {
            assert_eq!(calendar(values), None, "{values:?}");
        }
        assert!(!calendar(&[45_000.0, 45_001.0]).unwrap().is_certain);
    }
}
