//! How far a class gets: flattened, sorted, compiled, simulated.

use gapilib::compile::Program;
use gapilib::dae;
use gapilib::diag::{Diagnostic, Fault};
use gapilib::flatten::{self, Library};
use gapilib::name::Name;
use gapilib::script::simulation::{self, Wishes};
use gapilib::sim::{Simulator, Trajectory};
use gapilib::source::Span;
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
    /// The errors, at least one.
    pub(crate) errors: Vec<Diagnostic>,
}

impl Stage {
    const ALL: [Stage; 5] =
        [Stage::Load, Stage::Flatten, Stage::Sort, Stage::Compile, Stage::Simulate];

    fn name(self) -> &'static str {
        match self {
            Stage::Load => "load",
            Stage::Flatten => "flatten",
            Stage::Sort => "sort",
            Stage::Compile => "compile",
            Stage::Simulate => "simulate",
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
        self.errors.iter().all(|error| missing.contains(&error.code.slug))
    }
}

/// What a ledger says of it: `stage: code`.
impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let code = self.errors.first().map_or("", |error| error.code.slug);
        write!(f, "{}: {code}", self.stage.name())
    }
}

/// Translates and simulates a class as its experiment annotation says.
pub(crate) fn run(library: &Library, class: &Name, progress: &Progress) -> Result<(), Failure> {
    let failed = |error| Failure { stage: progress.stage(), errors: vec![error] };
    let nowhere = |fault: Fault| fault.at(Span::NONE);
    progress.enter(Stage::Flatten);
    let flat = flatten::flatten(library, class, &[])
        .map_err(|errors| Failure { stage: Stage::Flatten, errors })?;
    progress.enter(Stage::Sort);
    let sorted = dae::sort(&flat.model).map_err(failed)?;
    progress.enter(Stage::Compile);
    let program = Program::compile(sorted).map_err(failed)?;
    progress.enter(Stage::Simulate);
    let settings = simulation::settings(&program.experiment(), &Wishes::default());
    let mut settings = settings.map_err(nowhere).map_err(failed)?;
    settings.cancel = Some(progress.cancel.clone());
    Simulator::new()
        .run(&mut program.system(), &settings, &mut Trajectory::default())
        .map_err(|error| failed(program.explain(&error)))?;
    Ok(())
}
