//! The modes on both sides of relations that chatter, and what was done about these.

use crate::arithmetic::Register;
use crate::sim::Treatment;
use crate::source::Span;

/// The modes prepared last.
#[derive(Debug, Clone, Default)]
pub(super) struct Modes {
    /// Relations and values of events.
    pub(super) registers: Vec<Register>,
    /// Their values, one mode after the other.
    pub(super) values: Vec<f64>,
}

/// What was done about a relation, once for each.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Treated {
    /// When it was done first, seconds.
    pub time: f64,
    /// What.
    pub treatment: Treatment,
    /// Where the relation is written.
    pub span: Span,
}
