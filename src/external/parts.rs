//! Strings in parts, some of which are known when a function runs: what `String` and `+` make of them.
//!
//! A part is a text, or a number as `String` writes it (MLS §3.7.1): a row of its value, whether it
//! is a Real (0), an Integer (1) or a Boolean (2), and significant digits, minimum length, left
//! justified; or a row of its value and type, and its format as the next part.

use super::Entry;
use super::call::{Call, Kind, Slot};
use crate::diag::Fault;
use crate::value::Value;
use crate::value::format::{formatted, text};

/// The text of all arguments.
pub static COMPOSE: Entry = Entry { stands_for: OWN, ..Entry::pure("String", "", compose) };

/// As `ModelicaInternal_print`: the file, then the text in parts.
pub static PRINT: Entry =
    Entry { stands_for: OWN, ..Entry::writing("ModelicaInternal_print", "", print) };

/// What tells these from the functions of libraries: no declaration includes it.
const OWN: &str = "strings in parts";

fn compose(call: &mut Call<'_>) -> Result<(), Fault> {
    let words = joined(call, call.arguments)?;
    call.give_text(&words)
}

fn print(call: &mut Call<'_>) -> Result<(), Fault> {
    let words = joined(call, &call.arguments[1..])?;
    match &*call.strings[call.arguments[0].first as usize].clone() {
        "" => call.outside.print(words.trim_end_matches('\n')),
        path => call.outside.append(path, format!("{words}\n").as_bytes()),
    }
}

fn joined(call: &Call<'_>, parts: &[Slot]) -> Result<String, Fault> {
    let mut words = String::new();
    let mut parts = parts.iter();
    while let Some(slot) = parts.next() {
        let first = slot.first as usize;
        match (slot.kind, &*slot.dims) {
            (Kind::Text, _) => words += &call.strings[first],
            (_, [2]) => {
                let format = parts.next().map_or("", |slot| &call.strings[slot.first as usize]);
                words += &formatted(&value(&call.numbers[first..]), format)?;
            }
            _ => {
                let row = &call.numbers[first..first + 5];
                words += &text(&value(row), row[2] as i64, row[3] as i64, row[4] != 0.0)?;
            }
        }
    }
    Ok(words)
}

/// A number and its type.
fn value(row: &[f64]) -> Value {
    match row[1] as i64 {
        1 => Value::Integer(row[0] as i64),
        2 => Value::Boolean(row[0] != 0.0),
        _ => Value::Real(row[0]),
    }
}
