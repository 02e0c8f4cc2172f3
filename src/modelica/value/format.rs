//! The operator `String` (MLS §3.7.1) and the formats of C's `printf` that it is defined by.

use super::Value;
use super::errors::{DOMAIN_ERROR, TYPE_MISMATCH};
use crate::bail;
use crate::diag::Fault;
use std::sync::Arc;

/// The widest field and the highest precision that a format may ask for.
const MAX_WIDTH: usize = 4096;

/// Significant digits of a Real unless given.
const DIGITS: i64 = 6;

/// `String(x, significantDigits, minimumLength, leftJustified)`; the digits count for Reals only.
pub fn text(
    value: &Value,
    significant_digits: i64,
    minimum_length: i64,
    left_justified: bool,
) -> Result<Arc<str>, Fault> {
    let plain = match value {
        Value::Real(value) => {
            let Ok(digits @ 1..) = bounded(significant_digits) else {
                bail!(
                    DOMAIN_ERROR,
                    "{significant_digits} is not a valid number of significant digits"
                )
            };
            general(*value, digits, false, false)
        }
        Value::Integer(value) => value.to_string(),
        Value::Boolean(value) => value.to_string(),
        Value::String(text) => text.to_string(),
        Value::Enumeration(value) => value.literal().to_owned(),
        other => bail!(TYPE_MISMATCH, "`String` is not defined for {}", other.type_name()),
    };
    let Ok(width) = bounded(minimum_length) else {
        bail!(DOMAIN_ERROR, "{minimum_length} is not a valid string length")
    };
    Ok(padded(plain, width, left_justified).into())
}

/// A number as `String` writes it, in a row: its value, whether it is a Real (0), an Integer (1) or a
/// Boolean (2); and, where there is no format, significant digits, minimum length, left justified.
pub fn written(row: &[f64], format: Option<&str>) -> Result<Arc<str>, Fault> {
    let value = match row[1] as i64 {
        1 => Value::Integer(row[0] as i64),
        2 => Value::Boolean(row[0] != 0.0),
        _ => Value::Real(row[0]),
    };
    match (format, &row[2..]) {
        (Some(format), _) => formatted(&value, format),
        (None, [digits, length, left]) => {
            text(&value, *digits as i64, *length as i64, *left != 0.0)
        }
        (None, _) => text(&value, DIGITS, 0, true),
    }
}

fn bounded(length: i64) -> Result<usize, ()> {
    usize::try_from(length).ok().filter(|length| *length <= MAX_WIDTH).ok_or(())
}

/// `String(x, format = "8.3g")`: a format of C without the leading `%` and without `*`.
pub fn formatted(value: &Value, format: &str) -> Result<Arc<str>, Fault> {
    let Some(parsed) = Format::parse(format) else {
        bail!(
            DOMAIN_ERROR,
            "`{format}` is not a number format";
            help: "write width, precision and one of `d e f g`, such as `\"8.3f\"`"
        )
    };
    match (parsed.conversion, value) {
        ('d' | 'i', Value::Integer(value)) => Ok(parsed.integer(*value).into()),
        ('e' | 'E' | 'f' | 'F' | 'g' | 'G', Value::Real(_) | Value::Integer(_)) => {
            let number = value.as_real().unwrap_or(f64::NAN);
            Ok(parsed.real(number).into())
        }
        (conversion, other) => bail!(
            TYPE_MISMATCH,
            "the format `{conversion}` does not suit a value of type {}",
            other.type_name()
        ),
    }
}

struct Format {
    left: bool,
    sign: bool,
    space: bool,
    zeros: bool,
    alternate: bool,
    width: usize,
    precision: Option<usize>,
    conversion: char,
}

impl Format {
    fn parse(text: &str) -> Option<Format> {
        let rest = text.strip_prefix('%').unwrap_or(text);
        let digits_at = rest.find(|c: char| !"-+ 0#".contains(c))?;
        let (flags, rest) = rest.split_at(digits_at);
        let (number, conversion) = rest.split_at_checked(rest.len().checked_sub(1)?)?;
        let (width, precision) = match number.split_once('.') {
            Some((width, precision)) => (width, Some(precision)),
            None => (number, None),
        };
        let read = |digits: &str| match digits {
            "" => Some(0),
            digits if digits.bytes().all(|b| b.is_ascii_digit()) => {
                digits.parse().ok().filter(|n| *n <= MAX_WIDTH)
            }
            _ => None,
        };
        Some(Format {
            left: flags.contains('-'),
            sign: flags.contains('+'),
            space: flags.contains(' '),
            zeros: flags.contains('0'),
            alternate: flags.contains('#'),
            width: read(width)?,
            precision: match precision {
                Some(digits) => Some(read(digits)?),
                None => None,
            },
            conversion: conversion.chars().next()?,
        })
    }

    fn integer(&self, value: i64) -> String {
        let digits = format!("{:0>1$}", value.unsigned_abs(), self.precision.unwrap_or(1));
        self.laid_out(value < 0, digits, self.precision.is_none())
    }

    fn real(&self, value: f64) -> String {
        let magnitude = value.abs();
        let precision = self.precision.unwrap_or(6);
        let upper = self.conversion.is_ascii_uppercase();
        let digits = match self.conversion.to_ascii_lowercase() {
            _ if !value.is_finite() => non_finite(magnitude, upper),
            'e' => exponential(magnitude, precision, upper),
            'f' => format!("{magnitude:.precision$}"),
            _ => general(magnitude, precision.max(1), upper, self.alternate),
        };
        self.laid_out(value.is_sign_negative() && !value.is_nan(), digits, value.is_finite())
    }

    fn laid_out(&self, negative: bool, digits: String, may_fill: bool) -> String {
        let sign = match (negative, self.sign, self.space) {
            (true, _, _) => "-",
            (_, true, _) => "+",
            (_, _, true) => " ",
            _ => "",
        };
        if self.zeros && may_fill && !self.left {
            let fill = self.width.saturating_sub(sign.len() + digits.len());
            return format!("{sign}{}{digits}", "0".repeat(fill));
        }
        padded(format!("{sign}{digits}"), self.width, self.left)
    }
}

fn padded(text: String, width: usize, left: bool) -> String {
    if left { format!("{text:<width$}") } else { format!("{text:>width$}") }
}

fn non_finite(magnitude: f64, upper: bool) -> String {
    let text = if magnitude.is_nan() { "nan" } else { "inf" };
    if upper { text.to_uppercase() } else { text.to_owned() }
}

/// C's `%.{precision}e`: at least two digits in the exponent.
fn exponential(value: f64, precision: usize, upper: bool) -> String {
    let text = format!("{value:.precision$e}");
    let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    let letter = if upper { 'E' } else { 'e' };
    let sign = if exponent < 0 { '-' } else { '+' };
    format!("{mantissa}{letter}{sign}{:02}", exponent.abs())
}

/// C's `%.{digits}g`: `digits` significant digits, trailing zeros removed unless `alternate`.
pub(super) fn general(value: f64, digits: usize, upper: bool, alternate: bool) -> String {
    if !value.is_finite() {
        let sign = if value < 0.0 { "-" } else { "" };
        return format!("{sign}{}", non_finite(value.abs(), upper));
    }
    let rounded = format!("{value:.*e}", digits - 1);
    let exponent: i32 = rounded.split_once('e').and_then(|(_, e)| e.parse().ok()).unwrap_or(0);
    let trimmed = |text: &str| match text.contains('.') && !alternate {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text.to_owned(),
    };
    if exponent < -4 || exponent >= digits as i32 {
        let text = exponential(value, digits - 1, upper);
        let at = text.find(['e', 'E']).unwrap_or(text.len());
        let (mantissa, exponent) = text.split_at(at);
        return format!("{}{exponent}", trimmed(mantissa));
    }
    let decimals = (digits as i32 - 1 - exponent).max(0) as usize;
    trimmed(&format!("{value:.decimals$}"))
}
