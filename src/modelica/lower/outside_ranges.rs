//! Warnings of values outside the interval of `min` and `max` (MLS §4.9): once for all elements of an
//! array, for each instance and either side; the first with their declarations, others by their
//! names.

use super::errors::OUTSIDE_RANGE;
use crate::diag::{Diagnostic, Fault};
use crate::fault;
use crate::source::Span;

/// So many are shown with their declarations; others are only named. A screen holds as many.
const MOST_SHOWN: usize = 5;
/// So many of these are named.
const MOST_NAMED: usize = 10;

/// The limit that a value is beyond.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Beyond {
    /// `min` or `max`.
    pub attribute: &'static str,
    /// Its value.
    pub limit: f64,
}

impl Beyond {
    /// What distinguishes a warning from that of another instance or side, and all elements of an
    /// array share.
    pub fn subject(&self, name: &str) -> String {
        format!("{} of {}", self.attribute, without_subscripts(name))
    }

    /// `below its min of 0`.
    pub fn words(&self) -> String {
        let side = if self.attribute == "min" { "below" } else { "above" };
        format!("{side} its `{}` of {}", self.attribute, self.limit)
    }
}

/// The warnings of one translation or simulation.
#[derive(Debug, Default)]
pub struct OutsideRanges {
    shown: Vec<Diagnostic>,
    others: Vec<(String, Span)>,
}

impl OutsideRanges {
    /// Adds a warning of a variable at its declaration.
    pub fn add(&mut self, name: &str, span: Span, sentence: String, help: String) {
        if self.shown.len() < MOST_SHOWN {
            let fault = Fault::new(OUTSIDE_RANGE, sentence).help(help);
            self.shown.push(fault.at(span).warning());
        } else {
            self.others.push((format!("`{name}`"), span));
        }
    }

    /// All of them; those only named at a place, without one at the declaration of the first.
    pub fn warnings(self, place: Option<Span>) -> impl Iterator<Item = Diagnostic> {
        let named = self.others.first().map(|(_, first)| {
            let more = self.others.len().saturating_sub(MOST_NAMED);
            let more = if more > 0 { format!(" and {more} more") } else { String::new() };
            let names: Vec<&str> =
                self.others.iter().take(MOST_NAMED).map(|(name, _)| &**name).collect();
            fault!(OUTSIDE_RANGE, "also outside of `min` and `max`: {}{more}", names.join(", "))
                .at(place.unwrap_or(*first))
                .warning()
        });
        self.shown.into_iter().chain(named)
    }
}

/// The name that all elements of an array share.
fn without_subscripts(name: &str) -> String {
    let mut depth = 0;
    let outside = |letter: &char| {
        depth += i32::from(*letter == '[');
        let is_outside = depth == 0;
        depth -= i32::from(*letter == ']');
        is_outside
    };
    name.chars().filter(outside).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn elements_share_the_name_of_their_array() {
        assert_eq!(without_subscripts("a[1].b[2, 3].c"), "a.b.c");
        assert_eq!(without_subscripts("a[n[1]].b"), "a.b");
    }
}
