//! What users see of a search in progress, and how they change it between two generations:
//! the same for scripts and for problems.

use super::view::{Drawn, Progress, View};
use crate::Session;
use crate::identify::SearchRecord;
use crate::identify::errors::RANKS_IDLE;
use std::ops::ControlFlow;

/// What became of a line: the search continues or ends; or why the line was refused.
pub(super) type Taken = Result<ControlFlow<()>, String>;

impl Session {
    /// Shows how far a search is, and draws it where that is requested; whether it was drawn.
    pub(super) fn show_search(
        &mut self,
        progress: Progress,
        record: &SearchRecord,
        drawn: impl FnOnce() -> Drawn,
    ) -> bool {
        self.world.progress(&progress);
        let is_drawn = self.world.is_view_due();
        if is_drawn {
            self.world.show_view(&View::of(progress, record, drawn()));
        }
        is_drawn
    }

    /// Lets the user change a search until he types an empty line; whether the search is to end.
    pub(super) fn pause_search(
        &mut self,
        [help, prompt]: [&str; 2],
        take: &mut dyn FnMut(&mut Session, &str) -> Taken,
    ) -> bool {
        self.world.begin_pause(help);
        while let Some(line) = self.world.ask(prompt).filter(|line| !line.trim().is_empty()) {
            match take(self, &line) {
                Ok(ControlFlow::Continue(())) => self.world.changed(&line, Ok(())),
                Ok(ControlFlow::Break(())) => return true,
                Err(reason) => self.world.changed(&line, Err(&reason)),
            }
        }
        false
    }

    /// Says why other ranks take no part, if that is so.
    pub(super) fn note_idle_ranks(&mut self, reason: Option<&str>) {
        if let Some(reason) = reason {
            let text = format!("the other ranks take no part in the simulations, because {reason}");
            self.note(RANKS_IDLE, text);
        }
    }
}

/// Why a change was refused, and what to do.
pub(super) fn reason(message: &str, helps: &[String]) -> String {
    let all: Vec<&str> = std::iter::once(message).chain(helps.iter().map(String::as_str)).collect();
    all.join("; ")
}
