//! The resolution of measured values: the distance between numbers that can be written with their
//! digits, be these a number of decimals or of significant digits.

use crate::elementary;

/// Fewer significant digits than these are those of round numbers: 100, 20 and 3 are whole numbers.
const ROUNDED: i32 = 3;

/// For each value the distance to the next number of the same format. The format is that of the value
/// with the most digits, as zeros at the end are not seen.
pub(in super::super) fn resolution(values: &[f64]) -> Vec<f64> {
    let written: Vec<(i32, i32)> = values.iter().map(|value| digits(*value)).collect();
    let most = written.iter().map(|(digits, _)| *digits).max().unwrap_or(0);
    let decimals = written.iter().map(|(digits, exponent)| digits - 1 - exponent).max();
    let by_decimals = -decimals.unwrap_or(0);
    let step = |(_, exponent): &(i32, i32)| match most < ROUNDED {
        true => elementary::powi(10.0, by_decimals),
        false => elementary::powi(10.0, (exponent + 1 - most).max(by_decimals)),
    };
    written.iter().map(step).collect()
}

/// The significant digits of a number and the power of ten of the first of them.
fn digits(value: f64) -> (i32, i32) {
    let text = format!("{:e}", value.abs());
    let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let count = mantissa.bytes().filter(u8::is_ascii_digit).count();
    (i32::try_from(count).unwrap_or(0), exponent.parse().unwrap_or(0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decimals_and_significant_digits_are_distinguished() {
        for (values, expected) in [
            (&[12.53, 3.2, 0.01, 7.0][..], [0.01, 0.01, 0.01, 0.01]),
            (&[5.0, 2.86, 0.0992, 0.00567], [0.01, 0.01, 1e-4, 1e-5]),
            (&[100.0, 20.0, -3.0, 0.0], [1.0, 1.0, 1.0, 1.0]),
        ] {
            let found = resolution(values);
            let good = found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-9 * b);
            assert!(good, "{values:?}: {found:?}");
        }
    }
}
