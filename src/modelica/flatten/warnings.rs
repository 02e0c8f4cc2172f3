//! Warnings that flattening gives.

use crate::diag::Diagnostic;

/// Warnings in order.
#[derive(Default)]
pub(crate) struct Warnings(Vec<Diagnostic>);

impl Warnings {
    /// A warning.
    pub(crate) fn push(&mut self, warning: Diagnostic) {
        self.0.push(warning);
    }

    /// Several.
    pub(crate) fn extend(&mut self, warnings: Vec<Diagnostic>) {
        self.0.extend(warnings);
    }

    /// A warning, unless the same was given at the same place.
    pub(crate) fn add_once(&mut self, error: Diagnostic) {
        let is_known = |one: &Diagnostic| one.code == error.code && one.span() == error.span();
        if !self.0.iter().any(is_known) {
            self.0.push(error.warning());
        }
    }

    /// Whether one with this message was given.
    pub(crate) fn has_message(&self, message: &str) -> bool {
        self.0.iter().any(|known| known.message == message)
    }

    /// All of them.
    pub(crate) fn into_all(self) -> Vec<Diagnostic> {
        self.0
    }
}
