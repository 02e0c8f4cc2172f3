//! Checks a lesson again whenever its file is saved.
//!
//! The files are polled: one to three small files, and editors save in different ways (in place, by
//! renaming a new file, on network drives that send no notifications), which a poll sees in the same
//! way on every system, without another dependency.

use super::copies::Copies;
use crate::lessons::Lesson;
use crate::{hangup, terminal};
use std::io::IsTerminal as _;
use std::time::{Duration, SystemTime};

/// Time between two looks: shorter than a learner needs to change windows.
const INTERVAL: Duration = Duration::from_millis(200);

/// When a file was written and how long it is; `None` while an editor replaces it.
type Stamp = Option<(SystemTime, u64)>;

/// Does `work` now and after each save, until Ctrl-C ends the process.
///
/// # Errors
///
/// Those of `work`.
pub(super) fn for_ever(
    lesson: &Lesson,
    copies: &Copies<'_>,
    work: impl Fn() -> Result<(), String>,
) -> Result<(), String> {
    let has_terminal = std::io::stdin().is_terminal();
    loop {
        // Before the work: what is saved meanwhile is seen after it.
        let seen = stamps(lesson, copies);
        work()?;
        terminal::print("\nWaiting for the next save; Ctrl-C ends.\n");
        while !is_saved(&seen, &stamps(lesson, copies)) {
            if has_terminal && hangup::is_closed() {
                return Ok(());
            }
            std::thread::sleep(INTERVAL);
        }
        terminal::print(&format!("\n{}\n\n", "-".repeat(40)));
    }
}

fn stamps(lesson: &Lesson, copies: &Copies<'_>) -> Vec<Stamp> {
    let names = lesson.companions.iter().map(|(name, _)| name).chain([&lesson.file]);
    let stamp = |name: &String| {
        let found = std::fs::metadata(copies.file(name)).ok()?;
        Some((found.modified().ok()?, found.len()))
    };
    names.map(stamp).collect()
}

/// Whether a file has changed, and all of them are there.
fn is_saved(before: &[Stamp], now: &[Stamp]) -> bool {
    before != now && now.iter().all(Option::is_some)
}
