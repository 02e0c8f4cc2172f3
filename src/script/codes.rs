//! The table of all codes of the program, for `gapi explain` and the tests.

use crate::diag::Code;

/// The codes of every stage, in the order of the pipeline.
pub fn all() -> Vec<Code> {
    [
        crate::registry::CODES,
        crate::syntax::errors::CODES,
        crate::value::errors::CODES,
        crate::eval::errors::CODES,
        crate::mat::errors::CODES,
        crate::results::errors::CODES,
        crate::dae::errors::CODES,
        crate::ga::errors::CODES,
        crate::identify::errors::CODES,
        super::errors::CODES,
    ]
    .concat()
}
