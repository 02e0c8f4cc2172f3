//! Exercises about the genetic algorithm: scripts with a gap, hints, solutions, and checks.
//!
//! A [`Lesson`] is a script of about one page that a learner completes. [`check`] runs the learner's
//! copy in memory, once as it is and again with other seeds, inputs or files (`variant`), and asks
//! after each run what must hold. A [`Progress`] remembers what is passed. Nothing here touches files:
//! the command line and a page provide the contents.

mod advice;
mod check;
mod progress;
mod shipped;
mod variant;

pub use advice::advice;
pub use check::{Verdict, check, check_until};
pub use progress::Progress;
pub use shipped::{Check, Claim, Lesson, all};
