//! Numbers of the command line, with a remedy for other ways to write them.

/// A whole number, with a remedy for other ways to write one.
pub(super) fn whole_number(text: &str) -> Result<u64, String> {
    let is_whole = |value: &f64| value.fract() == 0.0 && (0.0..1e15).contains(value);
    text.parse().map_err(|_| match text.parse::<f64>().ok().filter(is_whole) {
        Some(value) => format!("write all digits of a whole number: {value}"),
        None => "expected a whole number, such as 10000".to_owned(),
    })
}

/// A number, with a remedy for units and decimal commas.
pub(super) fn number(text: &str) -> Result<f64, String> {
    text.parse().map_err(|_| {
        let end = text.find(|c: char| !(c.is_ascii_digit() || "+-.,".contains(c)));
        let digits = text[..end.unwrap_or(text.len())].replacen(',', ".", 1);
        match digits.parse::<f64>() {
            Ok(_) if end.is_some() => format!("write the number without a unit: {digits}"),
            Ok(_) => format!("numbers have a decimal point: write {digits}"),
            Err(_) => "expected a number, such as 2.5".to_owned(),
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_say_how_they_are_written() {
        assert_eq!(number("1e-3"), Ok(1e-3));
        assert_eq!(number("5s"), Err("write the number without a unit: 5".to_owned()));
        assert_eq!(number("-1,5"), Err("numbers have a decimal point: write -1.5".to_owned()));
        assert_eq!(number("five"), Err("expected a number, such as 2.5".to_owned()));
        assert_eq!(whole_number("600"), Ok(600));
        assert_eq!(
            whole_number("1e4"),
            Err("write all digits of a whole number: 10000".to_owned())
        );
        assert!(whole_number("1.5").is_err() && whole_number("-3").is_err());
    }
}
