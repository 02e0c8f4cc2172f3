//! Generational replacement: the offspring replace the whole generation. The best may be lost.
//!
//! Reference: [De Jong 1975](gapilib_base::bibliography#de-jong-1975), generation gap 1.

use super::{Brood, Sizes, Survival, Survivor};
use crate::diag::Fault;
use crate::registry::Entry;

/// The table entry.
pub(crate) const ENTRY: Entry<dyn Survival> = Entry {
    name: "generational",
    aliases: &["replace_all"],
    summary: "the offspring replace the whole population",
    reference: "de-jong-1975",
    make: |_| Ok(Box::new(Generational)),
};

struct Generational;

impl Survival for Generational {
    fn survivors(&self, brood: &Brood<'_>, _: Sizes) -> Result<Vec<Survivor>, Fault> {
        Ok(brood.offspring().collect())
    }
}
