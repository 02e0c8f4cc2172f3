//! What made a simulation work, in the words of its model.

use crate::Session;
use crate::runtime::{LoopEffort, System};
use crate::sim::Effort;
use indexmap::IndexMap;
use std::cmp::Reverse;
use std::sync::Arc;

/// What made a simulation work, the most first; nothing that made none.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Hardest {
    /// Steps in whose error test an unknown had the largest part, by its name.
    pub unknowns: Vec<(Arc<str>, u64)>,
    /// Events by the relations that caused them: where they are written, and their source text.
    pub relations: Vec<(String, u64)>,
    /// Algebraic loops by evaluations of their residuals.
    pub loops: Vec<LoopEffort>,
}

/// What made a simulation work, in words.
pub(super) fn hardest(session: &Session, system: &System, effort: &Effort) -> Hardest {
    let program = system.program();
    let unknowns = effort.unknowns.iter().enumerate();
    let mut unknowns: Vec<(Arc<str>, u64)> = unknowns
        .filter_map(|(at, count)| Some((program.unknown_name(at)?.clone(), *count)))
        .filter(|(_, count)| *count > 0)
        .collect();
    let mut relations: IndexMap<String, u64> = IndexMap::new();
    for (at, count) in effort.crossings.iter().enumerate().filter(|(_, count)| **count > 0) {
        let Some(place) = program.crossing_place(at) else { continue };
        let text = session.sources.text(place).split_whitespace().collect::<Vec<_>>().join(" ");
        *relations.entry(format!("`{text}` ({})", session.sources.location(place))).or_default() +=
            count;
    }
    let mut relations: Vec<(String, u64)> = relations.into_iter().collect();
    let mut loops = system.loop_efforts();
    loops.retain(|effort| effort.solutions > 0);
    unknowns.sort_by_key(|(_, count)| Reverse(*count));
    relations.sort_by_key(|(_, count)| Reverse(*count));
    loops.sort_by_key(|effort| Reverse(effort.evaluations));
    Hardest { unknowns, relations, loops }
}
