//! What a population is simulated on.

use super::coordinator::{Prepared, Ranks};
use crate::diag::Fault;
use crate::problem::Portable;
use std::sync::Arc;

/// What simulates: threads of this process, and other ranks where there are any.
#[derive(Clone)]
pub struct Processors {
    /// Threads of this process.
    pub threads: usize,
    /// The other ranks.
    pub ranks: Option<Arc<Ranks>>,
}

impl Processors {
    /// Threads of this process alone.
    pub fn threads(threads: usize) -> Processors {
        Processors { threads, ranks: None }
    }

    /// Makes simulators on the other ranks, if there are any; otherwise why not, where there are
    /// ranks.
    ///
    /// # Errors
    ///
    /// Those of [`Ranks::prepare`].
    pub(crate) fn prepare(
        &self,
        simulator: impl FnOnce() -> Result<Portable, String>,
    ) -> Result<(Option<Prepared>, Option<String>), Fault> {
        let Some(ranks) = self.ranks.as_ref().filter(|ranks| ranks.size() > 1) else {
            return Ok((None, None));
        };
        match simulator() {
            Ok(portable) => Ok((Some(ranks.prepare(portable)?), None)),
            Err(reason) => Ok((None, Some(reason))),
        }
    }
}
