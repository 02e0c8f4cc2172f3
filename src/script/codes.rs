//! The table of all codes of the program, for `gapi explain` and the tests.

use crate::diag::Code;
use std::collections::BTreeSet;

/// The codes of every stage, in the order of the pipeline; a code that two stages share once.
pub fn all() -> Vec<Code> {
    let mut codes = [
        crate::registry::CODES,
        crate::syntax::errors::CODES,
        crate::value::errors::CODES,
        crate::functions::errors::CODES,
        crate::eval::errors::CODES,
        crate::external::errors::CODES,
        crate::mat::errors::CODES,
        crate::results::errors::CODES,
        crate::plot::errors::CODES,
        crate::flatten::errors::CODES,
        crate::lower::errors::CODES,
        crate::codegen::errors::CODES,
        crate::ga::errors::CODES,
        crate::identify::errors::CODES,
        crate::teach::errors::CODES,
        super::errors::CODES,
    ]
    .concat();
    let mut seen = BTreeSet::new();
    codes.retain(|code| seen.insert(code.slug));
    codes
}
