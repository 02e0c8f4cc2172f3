//! Numbers in tables for people, and names in tables for programs.

/// A number to this many significant digits, without trailing zeros.
pub fn significant(value: f64, digits: usize) -> String {
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    let scientific = format!("{value:.*e}", digits.saturating_sub(1));
    let rounded: f64 = scientific.parse().unwrap_or(value);
    if (1e-3..1e6).contains(&rounded.abs()) { rounded.to_string() } else { format!("{rounded:e}") }
}

/// A cell of a CSV file; names that a spreadsheet would take for formulas are quoted, too.
pub fn quoted(text: &str) -> String {
    match text.contains([',', '"', '\n']) || text.starts_with(['=', '+', '-', '@', '\t', '\r']) {
        true => crate::results::quoted(text),
        false => text.to_owned(),
    }
}

/// A table of numbers below names.
pub fn table_csv<'a>(names: impl Iterator<Item = &'a str>, rows: &[Vec<f64>]) -> String {
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
