//! Where the tape that is written at the moment has computed expressions.
//!
//! Expressions are looked up several times for each instruction: by their numbers, in a list that is
//! kept from tape to tape. Of heat conduction with 100,000 states, a map made for each tape took a
//! tenth of the translation.

use crate::arithmetic::Register;
use crate::symbolic::Expr;

/// The registers of the expressions that a tape has computed outside of its branches.
#[derive(Debug, Default)]
pub(super) struct Places {
    /// The number of the tape.
    tape: u32,
    /// By expression the last tape that computed it, and where.
    places: Vec<(u32, Register)>,
}

impl Places {
    /// Another tape begins: nothing is known.
    pub(super) fn begin(&mut self) {
        self.tape = self.tape.checked_add(1).unwrap_or_else(|| {
            self.places.clear();
            1
        });
    }

    pub(super) fn get(&self, e: Expr) -> Option<Register> {
        let (tape, register) = self.places.get(e.index())?;
        (*tape == self.tape).then_some(*register)
    }

    pub(super) fn insert(&mut self, e: Expr, register: Register) {
        let at = e.index();
        if at >= self.places.len() {
            self.places.resize(at + 1, (0, 0));
        }
        self.places[at] = (self.tape, register);
    }
}

/// A copy knows nothing: it is made between tapes.
impl Clone for Places {
    fn clone(&self) -> Places {
        Places::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::symbolic::{Pool, VarId};

    #[test]
    fn what_one_tape_has_computed_the_next_does_not_know() {
        let mut pool = Pool::new();
        let (a, b) = (pool.variable(VarId(0)), pool.variable(VarId(1)));
        let mut places = Places::default();
        places.begin();
        assert_eq!(places.get(b), None);
        places.insert(b, 7);
        assert_eq!((places.get(a), places.get(b)), (None, Some(7)));
        places.begin();
        assert_eq!(places.get(b), None);
        let mut last = Places { tape: u32::MAX, ..places };
        last.insert(a, 3);
        last.begin();
        assert_eq!((last.get(a), last.get(b)), (None, None));
    }
}
