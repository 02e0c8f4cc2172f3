//! `ModelicaStrings_*`: positions count bytes, from 1.

use super::Entry;
use super::call::Call;
use crate::diag::Fault;
use std::cmp::Ordering;

pub(crate) const ENTRIES: &[Entry] = &[
    Entry::pure("ModelicaStrings_length", "t->n", length),
    Entry::pure("ModelicaStrings_substring", "tnn->t", substring),
    Entry::pure("ModelicaStrings_compare", "ttn->n", compare),
    Entry::pure("ModelicaStrings_skipWhiteSpace", "tn->n", skip_white_space),
    Entry::pure("ModelicaStrings_scanIdentifier", "tnNT", scan_identifier),
    Entry::pure("ModelicaStrings_scanInteger", "tnnNN", scan_integer),
    Entry::pure("ModelicaStrings_scanReal", "tnnNN", scan_real),
    Entry::pure("ModelicaStrings_scanString", "tnNT", scan_string),
    Entry::pure("ModelicaStrings_hashString", "t->n", hash),
];

fn length(call: &mut Call<'_>) -> Result<(), Fault> {
    call.give(call.text(0).len() as f64)
}

fn substring(call: &mut Call<'_>) -> Result<(), Fault> {
    let text = call.text(0);
    let start = call.whole(1).max(1);
    let end = if call.whole(2) < 0 { start } else { call.whole(2) };
    let end = usize::try_from(end).unwrap_or(0).min(text.len());
    let start = usize::try_from(start - 1).unwrap_or(0);
    let bytes = text.as_bytes().get(start..end).unwrap_or_default();
    let part = String::from_utf8_lossy(bytes).into_owned();
    call.give_text(&part)
}

/// `Modelica.Utilities.Types.Compare`: less, equal, greater.
fn compare(call: &mut Call<'_>) -> Result<(), Fault> {
    let (a, b) = (call.text(0), call.text(1));
    let order = match call.truth(2) {
        true => a.cmp(b),
        false => a.to_ascii_lowercase().cmp(&b.to_ascii_lowercase()),
    };
    call.give(match order {
        Ordering::Less => 1.0,
        Ordering::Equal => 2.0,
        Ordering::Greater => 3.0,
    })
}

fn skip_white_space(call: &mut Call<'_>) -> Result<(), Fault> {
    let next = after_white_space(call) + 1;
    call.give(next as f64)
}

/// The position (from 0) of the first byte from the start index on that is not white space.
fn after_white_space(call: &Call<'_>) -> usize {
    let bytes = call.text(0).as_bytes();
    let start = usize::try_from(call.whole(1) - 1).unwrap_or(0).min(bytes.len());
    let blank = bytes[start..].iter().take_while(|byte| byte.is_ascii_whitespace()).count();
    start + blank
}

/// How many bytes from a position on fulfil a condition.
fn run(bytes: &[u8], at: usize, is: impl Fn(&u8) -> bool) -> usize {
    bytes[at.min(bytes.len())..].iter().take_while(|byte| is(byte)).count()
}

/// The end of an optional sign.
fn after_sign(bytes: &[u8], at: usize) -> usize {
    at + usize::from(matches!(bytes.get(at), Some(b'+' | b'-')))
}

fn scan_identifier(call: &mut Call<'_>) -> Result<(), Fault> {
    let start = after_white_space(call);
    let bytes = call.text(0).as_bytes();
    let n = match bytes.get(start) {
        Some(first) if first.is_ascii_alphabetic() => {
            run(bytes, start, |byte| byte.is_ascii_alphanumeric() || *byte == b'_')
        }
        _ => 0,
    };
    let found = String::from_utf8_lossy(&bytes[start..start + n]).into_owned();
    let next = if n == 0 { call.number(1) } else { (start + n + 1) as f64 };
    call.set(2, next);
    call.set_text(3, &found);
    Ok(())
}

/// Writes a number found up to `end`, or that there is none.
fn scanned(call: &mut Call<'_>, number: Option<(f64, usize)>) -> Result<(), Fault> {
    let (value, next) = match number {
        Some((value, end)) => (value, (end + 1) as f64),
        None => (0.0, call.number(1)),
    };
    call.set(3, next);
    call.set(4, value);
    Ok(())
}

fn scan_integer(call: &mut Call<'_>) -> Result<(), Fault> {
    let start = after_white_space(call);
    let bytes = call.text(0).as_bytes();
    let digits = if call.truth(2) { start } else { after_sign(bytes, start) };
    let end = digits + run(bytes, digits, u8::is_ascii_digit);
    let is_real = matches!(bytes.get(end), Some(b'.' | b'e' | b'E'));
    // A start within a letter of several bytes is the end, too.
    let text = call.text(0).get(start..end).unwrap_or_default();
    // Integers of the language have 32 bits where these functions come from.
    let number = match text.parse::<i32>() {
        Ok(value) if end > digits && !is_real => Some((f64::from(value), end)),
        _ => None,
    };
    scanned(call, number)
}

fn scan_real(call: &mut Call<'_>) -> Result<(), Fault> {
    let start = after_white_space(call);
    let bytes = call.text(0).as_bytes();
    let digits = if call.truth(2) { start } else { after_sign(bytes, start) };
    let mut end = digits + run(bytes, digits, u8::is_ascii_digit);
    if end == digits {
        return scanned(call, None);
    }
    if bytes.get(end) == Some(&b'.') {
        end += 1 + run(bytes, end + 1, u8::is_ascii_digit);
    }
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let exponent = after_sign(bytes, end + 1);
        match run(bytes, exponent, u8::is_ascii_digit) {
            0 => return scanned(call, None),
            n => end = exponent + n,
        }
    }
    let value = call.text(0)[start..end].parse::<f64>().ok();
    scanned(call, value.filter(|value| value.is_finite()).map(|value| (value, end)))
}

fn scan_string(call: &mut Call<'_>) -> Result<(), Fault> {
    let start = after_white_space(call);
    let bytes = call.text(0).as_bytes();
    let mut end = None;
    if bytes.get(start) == Some(&b'"') {
        let mut at = start + 1;
        while let Some(byte) = bytes.get(at) {
            match byte {
                b'\\' => at += 2,
                b'"' => {
                    end = Some(at);
                    break;
                }
                _ => at += 1,
            }
        }
    }
    let found = end.map_or(String::new(), |end| call.text(0)[start + 1..end].to_owned());
    let next = end.map_or(call.number(1), |end| (end + 2) as f64);
    call.set(2, next);
    call.set_text(3, &found);
    Ok(())
}

/// The hash function of A. Partow, read as an Integer of 32 bits; it gives the values in the
/// documentation of `Modelica.Utilities.Strings.hashString`.
fn hash(call: &mut Call<'_>) -> Result<(), Fault> {
    let mut hash: u32 = 0xAAAA_AAAA;
    for (position, byte) in call.text(0).bytes().enumerate() {
        let byte = u32::from(byte);
        hash ^= match position % 2 {
            0 => (hash << 7) ^ byte.wrapping_mul(hash >> 3),
            _ => !((hash << 11).wrapping_add(byte ^ (hash >> 5))),
        };
    }
    call.give(f64::from(hash as i32))
}
