//! Multistart: Levenberg-Marquardt from the best points of Latin hypercubes, until the best minimum
//! was reached from several starts.

use super::polish::Polished;
use super::{Method, Optimizer, Setup};
use crate::diag::Fault;
use crate::registry::Entry;

/// The table entry.
pub(crate) const ENTRY: Entry<dyn Method> = Entry {
    name: "multistart",
    aliases: &["multi-start"],
    summary: "Levenberg-Marquardt from the best points of Latin hypercubes",
    reference: "boender-rinnooy-kan-1987",
    make: |options| {
        Ok(Box::new(Multistart {
            points: options.take_whole("points", 1.0..=1e6, 40.0)?,
            starts: options.take_whole("starts", 1.0..=1e4, 4.0)?,
        }))
    },
};

struct Multistart {
    /// Points of a Latin hypercube.
    points: usize,
    /// Descents that begin from each.
    starts: usize,
}

impl Method for Multistart {
    fn start(&self, setup: Setup) -> Result<Box<dyn Optimizer>, Fault> {
        Ok(Box::new(Polished::alone(&setup, self.points, self.starts.min(self.points))))
    }

    fn needs_residuals(&self) -> bool {
        true
    }

    fn can_be_polished(&self) -> bool {
        false
    }
}
