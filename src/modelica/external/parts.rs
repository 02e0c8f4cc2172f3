//! Strings in parts, some of which are known when a function runs: what `String` and `+` make of them.
//!
//! A part is a text, or a number as `String` writes it (MLS §3.7.1) in a row: see
//! [`written`]; a format is the next part.

use super::Entry;
use super::call::{Call, Slot, SlotKind};
use super::errors::EXTERNAL_FAILED;
use crate::diag::Fault;
use crate::fault;
use crate::value::format::written;

/// The text of all arguments.
pub(crate) static COMPOSE: Entry =
    Entry { stands_for: OWN, ..Entry::pure("String", "*->t", compose) };

/// Fails with a text: the first argument is the text as far as it is known at translation, the others
/// are the parts.
pub(crate) static FAIL: Entry = Entry { stands_for: OWN, ..Entry::pure("assert", "t*", fail) };

/// As `ModelicaInternal_print`: the file, then the text in parts.
pub(crate) static PRINT: Entry =
    Entry { stands_for: OWN, ..Entry::writing("ModelicaInternal_print", "t*", print) };

/// The end of a signature: parts follow.
pub(super) const PARTS: char = '*';
/// Elements of a row for a number with a format, and without.
const WITH_FORMAT: u32 = 2;
const WITHOUT_FORMAT: u32 = 5;

/// What tells these from the functions of libraries: no declaration includes it.
const OWN: &str = "strings in parts";

fn compose(call: &mut Call<'_>) -> Result<(), Fault> {
    let words = joined(call, call.arguments)?;
    call.give_text(&words)
}

fn fail(call: &mut Call<'_>) -> Result<(), Fault> {
    let words = joined(call, &call.arguments[1..])?;
    Err(fault!(EXTERNAL_FAILED, "{}", words.trim_end()))
}

fn print(call: &mut Call<'_>) -> Result<(), Fault> {
    let words = joined(call, &call.arguments[1..])?;
    match &*call.strings[call.arguments[0].first as usize].clone() {
        "" => call.outside.print(words.trim_end_matches('\n')),
        path => call.outside.append(path, format!("{words}\n").as_bytes()),
    }
}

/// Whether arguments are parts.
pub(super) fn are_parts(slots: &[Slot]) -> bool {
    let mut slots = slots.iter();
    while let Some(slot) = slots.next() {
        let fits = match (slot.kind, &*slot.dims) {
            (SlotKind::Number, [WITH_FORMAT]) => {
                slots.next().is_some_and(|format| format.fits('f'))
            }
            (SlotKind::Number, [size]) => *size == WITHOUT_FORMAT,
            _ => slot.fits('t'),
        };
        if !fits {
            return false;
        }
    }
    true
}

fn joined(call: &Call<'_>, parts: &[Slot]) -> Result<String, Fault> {
    let mut words = String::new();
    let mut parts = parts.iter();
    while let Some(slot) = parts.next() {
        let first = slot.first as usize;
        match (slot.kind, &*slot.dims) {
            (SlotKind::Text, _) => words += &call.strings[first],
            (_, [WITH_FORMAT]) => {
                let format = parts.next().map_or("", |slot| &call.strings[slot.first as usize]);
                words += &written(&call.numbers[first..first + 2], Some(format))?;
            }
            _ => words += &written(&call.numbers[first..first + 5], None)?,
        }
    }
    Ok(words)
}
