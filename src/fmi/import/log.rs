//! What units say while they run.

use super::message::LogMessage;
use std::sync::{Mutex, PoisonError};

/// Messages that are kept; a unit that says more is cut short.
const MOST_MESSAGES: usize = 50;
/// Characters of a message that are kept.
const LONGEST: usize = 1000;

/// Messages in their order, each once. Units may write from threads of their own.
#[derive(Debug, Default)]
pub(super) struct Log(Mutex<Vec<LogMessage>>);

impl Log {
    /// Keeps a message.
    pub(crate) fn add(&self, is_problem: bool, category: &str, text: &str) {
        let text: String = text.trim().chars().take(LONGEST).collect();
        let category = category.to_owned();
        let message = LogMessage { is_problem, category, text, is_last_of_many: false };
        let mut all = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if all.len() < MOST_MESSAGES && !message.text.is_empty() {
            message.add_to(&mut all);
        }
    }

    /// Takes the messages out.
    pub(crate) fn take(&self) -> Vec<LogMessage> {
        std::mem::take(&mut self.0.lock().unwrap_or_else(PoisonError::into_inner))
    }
}
