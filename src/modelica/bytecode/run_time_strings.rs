//! Strings that are made while functions run, and the numbers that stand for them in registers.
//!
//! The Strings of the program come first, then those of the simulation, which last until it starts
//! again. Two Strings are the same if their numbers are; the numbers mean nothing else.

use crate::diag::Fault;
use crate::external::errors::EXTERNAL_FAILED;
use crate::fault;
use indexmap::IndexSet;
use std::sync::Arc;

/// Bytes that the Strings of a simulation take at most.
const MOST_BYTES: usize = 1 << 28;
/// Bytes that a text takes besides its own.
const OVERHEAD: usize = 64;

/// The Strings of a program, by number.
pub type StringTable = IndexSet<Arc<str>>;

/// The Strings of a simulation.
#[derive(Clone, Default)]
pub(crate) struct RunTimeStrings {
    made: StringTable,
    bytes: usize,
}

impl RunTimeStrings {
    /// Forgets all of them.
    pub fn clear(&mut self) {
        *self = RunTimeStrings::default();
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.made.len()
    }

    /// Forgets those that were made after the first `len`: nothing holds their numbers any more.
    pub fn truncate(&mut self, len: usize) {
        while self.made.len() > len {
            self.bytes -= self.made.pop().map_or(0, |text| text.len() + OVERHEAD);
        }
    }

    /// The text that has a number.
    pub fn text(&self, of_program: &StringTable, number: f64) -> Option<Arc<str>> {
        if !(number >= 0.0 && number.fract() == 0.0) {
            return None;
        }
        let at = number as usize;
        let own = || self.made.get_index(at - of_program.len());
        of_program.get_index(at).or_else(own).cloned()
    }

    /// The number of a text.
    ///
    /// # Errors
    /// The Strings of the simulation take too much memory.
    pub fn number(&mut self, of_program: &StringTable, text: Arc<str>) -> Result<f64, Fault> {
        if let Some(at) = of_program.get_index_of(&text) {
            return Ok(at as f64);
        }
        let bytes = self.bytes.saturating_add(text.len() + OVERHEAD);
        let (at, is_new) = self.made.insert_full(text);
        if is_new {
            self.bytes = bytes;
        }
        match self.bytes > MOST_BYTES {
            true => Err(fault!(
                EXTERNAL_FAILED,
                "the simulation makes Strings of more than {} MB",
                MOST_BYTES >> 20
            )),
            false => Ok((of_program.len() + at) as f64),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strings_have_one_number_each_and_are_forgotten_from_the_end() {
        let program = StringTable::from_iter([Arc::from("known")]);
        let mut strings = RunTimeStrings::default();
        assert_eq!(strings.number(&program, "known".into()).unwrap(), 0.0);
        assert_eq!(strings.number(&program, "a".into()).unwrap(), 1.0);
        assert_eq!(strings.number(&program, "b".into()).unwrap(), 2.0);
        assert_eq!(strings.number(&program, "a".into()).unwrap(), 1.0);
        assert_eq!(strings.text(&program, 0.0).as_deref(), Some("known"));
        assert_eq!(strings.text(&program, 2.0).as_deref(), Some("b"));
        strings.truncate(1);
        assert_eq!(strings.text(&program, 2.0), None);
        assert_eq!(strings.number(&program, "c".into()).unwrap(), 2.0);
        for wrong in [-1.0, 0.5, f64::NAN, f64::INFINITY] {
            assert_eq!(strings.text(&program, wrong), None, "{wrong}");
        }
    }

    #[test]
    fn the_memory_of_strings_is_limited() {
        let mut strings = RunTimeStrings::default();
        let long = |c: &str| Arc::from(c.repeat(MOST_BYTES / 2));
        assert!(strings.number(&StringTable::new(), long("a")).is_ok());
        let error = strings.number(&StringTable::new(), long("b")).expect_err("too long");
        assert!(error.message.contains("256 MB"), "{}", error.message);
    }
}
