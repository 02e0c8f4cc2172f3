//! Numbers in tables for people, and names in tables for programs.

pub use crate::diag::suggest::counted;
use crate::elementary;

/// A number to this many significant digits, without trailing zeros.
pub fn significant(value: f64, digits: usize) -> String {
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    let scientific = format!("{value:.*e}", digits.saturating_sub(1));
    let rounded: f64 = scientific.parse().unwrap_or(value);
    if (1e-3..1e6).contains(&rounded.abs()) { rounded.to_string() } else { format!("{rounded:e}") }
}

/// Digits that an interval shows of its width.
const OF_WIDTH: f64 = 100.0;

/// The ends of an interval about a value, with at least two digits of their distance.
pub fn ends([low, high]: [f64; 2], value: f64) -> String {
    let digits = digits_of(high - low, value.abs().max(low.abs()).max(high.abs()));
    format!("{} to {}", significant(low, digits), significant(high, digits))
}

/// So many digits of a number of this size show two of an error; four at least, and what a number has
/// at most.
pub(crate) fn digits_of(error: f64, size: f64) -> usize {
    let ratio = OF_WIDTH * size / error;
    if ratio.is_finite() && ratio > 0.0 {
        (elementary::log10(ratio).ceil() as usize).clamp(4, 17)
    } else {
        4
    }
}

/// A cell of a CSV file; names that a spreadsheet would take for formulas are quoted, too.
pub fn quoted(text: &str) -> String {
    match text.contains([',', '"', '\n']) || text.starts_with(['=', '+', '-', '@', '\t', '\r']) {
        true => crate::results::quoted(text),
        false => text.to_owned(),
    }
}

/// A table of numbers below names.
pub(crate) fn table_csv<'a>(names: impl Iterator<Item = &'a str>, rows: &[Vec<f64>]) -> String {
    let names: Vec<String> = names.map(quoted).collect();
    let mut text = names.join(",") + "\n";
    for row in rows {
        let cells: Vec<String> = row.iter().map(f64::to_string).collect();
        text += &(cells.join(",") + "\n");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_of_intervals_show_their_width() {
        let cases = [
            ([2.99955, 3.00014], 2.9998, "2.99955 to 3.00014"),
            ([0.69979, 0.70025], 0.7, "0.69979 to 0.70025"),
            ([0.0123456, 0.0456789], 0.03, "0.01235 to 0.04568"),
            ([-0.00301, 0.00302], 0.0, "-0.00301 to 0.00302"),
        ];
        for (interval, value, expected) in cases {
            assert_eq!(ends(interval, value), expected);
        }
        assert_eq!([counted(1, "run"), counted(2, "run")], ["1 run", "2 runs"]);
    }

    #[test]
    fn numbers_keep_their_significant_digits() {
        let cases = [
            (0.0285634, "0.028563"),
            (2.3379e-7, "2.3379e-7"),
            (123456.7, "123460"),
            (0.01, "0.01"),
            (1e60, "1e60"),
            (-0.5, "-0.5"),
            (0.0, "0"),
        ];
        for (value, expected) in cases {
            assert_eq!(significant(value, 5), expected);
        }
    }
}
