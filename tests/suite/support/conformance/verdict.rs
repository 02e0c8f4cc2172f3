//! How far a class gets: flattened, sorted, compiled, simulated, in agreement with a reference.

use super::Reference;
use gapilib::Diagnostic;
use gapilib::internals::flatten::Library;
use gapilib::internals::name::Name;
use gapilib::internals::script::models::verification;
use gapilib::results::TUBE_TOLERANCE;
use std::fmt;
use std::sync::Arc;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};

/// The stages of a class, in order.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub(crate) enum Stage {
    /// Reading its file.
    #[default]
    Load,
    /// To a balanced flat model.
    Flatten,
    /// To sorted equations.
    Sort,
    /// To a program.
    Compile,
    /// From its start time to its stop time.
    Simulate,
    /// With reference results.
    Compare,
}

/// How far the work on a class is, and whether it is still wanted.
#[derive(Debug, Default)]
pub(crate) struct Progress {
    stage: Mutex<Stage>,
    cancel: Arc<AtomicBool>,
}

/// Where a class got stuck, and why.
#[derive(Debug, Clone)]
pub(crate) struct Failure {
    pub(crate) stage: Stage,
    /// The errors, at least one unless a signal differs.
    pub(crate) errors: Vec<Diagnostic>,
    /// The first signal that differs from the reference.
    pub(crate) signal: Option<String>,
}

impl Stage {
    const ALL: [Stage; 6] =
        [Stage::Load, Stage::Flatten, Stage::Sort, Stage::Compile, Stage::Simulate, Stage::Compare];

    fn of(stage: verification::Stage) -> Stage {
        match stage {
            verification::Stage::Flatten => Stage::Flatten,
            verification::Stage::Sort => Stage::Sort,
            verification::Stage::Compile => Stage::Compile,
            verification::Stage::Simulate => Stage::Simulate,
            verification::Stage::Compare => Stage::Compare,
        }
    }

    fn name(self) -> &'static str {
        match self {
            Stage::Load => "load",
            Stage::Flatten => "flatten",
            Stage::Sort => "sort",
            Stage::Compile => "compile",
            Stage::Simulate => "simulate",
            Stage::Compare => "differs",
        }
    }

    /// The stage that a ledger names.
    pub(crate) fn named(name: &str) -> Option<Stage> {
        Stage::ALL.into_iter().find(|stage| stage.name() == name)
    }
}

impl fmt::Display for Stage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl Progress {
    /// The stage that the work is in.
    pub(crate) fn stage(&self) -> Stage {
        *self.stage.lock().expect("no panic under the lock")
    }

    /// Makes a simulation end soon.
    pub(crate) fn cancel(&self) {
        self.cancel.store(true, Ordering::Relaxed);
    }

    fn enter(&self, stage: Stage) {
        *self.stage.lock().expect("no panic under the lock") = stage;
    }
}

impl Failure {
    /// Whether a part of the language, or of the numerics, is not built: then nothing was judged.
    pub(crate) fn is_missing_feature(&self) -> bool {
        let missing = ["unsupported-language", "not-supported"];
        self.signal.is_none() && self.errors.iter().all(|error| missing.contains(&error.code.slug))
    }
}

/// What a ledger says of it: `stage: code`, or `differs: signal`.
impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let code = self.errors.first().map_or("", |error| error.code.slug);
        let code = self.signal.as_deref().unwrap_or(code);
        write!(f, "{}: {code}", self.stage.name())
    }
}

/// Translates and simulates a class as its experiment annotation says, and compares it with its
/// reference results if there are some.
pub(crate) fn run(
    library: &Library,
    class: &Name,
    reference: Option<&Reference>,
    progress: &Progress,
) -> Result<(), Failure> {
    let enter = &mut |stage: verification::Stage| progress.enter(Stage::of(stage));
    let reference = reference.map(|reference| verification::Reference {
        table: &reference.table,
        signals: &reference.signals,
        tolerance: TUBE_TOLERANCE,
        is_sampled: false,
    });
    let compared =
        verification::verify(library, class, reference, &progress.cancel, enter).map_err(
            |stuck| Failure { stage: Stage::of(stuck.stage), errors: stuck.errors, signal: None },
        )?;
    match compared.into_iter().find(|one| !one.agrees()) {
        None => Ok(()),
        Some(one) => {
            Err(Failure { stage: Stage::Compare, errors: Vec::new(), signal: Some(one.signal) })
        }
    }
}
