//! Models against reference results: translated, simulated, compared. The time points are those of
//! the reference; if it is sampled, those of the experiment annotation and others between them.

use super::simulation::{self, SimulationOptions};
use crate::Session;
use crate::causalize;
use crate::codegen::Program;
use crate::diag::{Diagnostic, Fault};
use crate::flatten::{self, Library};
use crate::name::Name;
use crate::results::{self, Compared, ResultTable, Series, Values};
use crate::sim::{OutputGrid, Settings, Simulator, Trajectory, same_time};
use crate::source::Span;
use std::fmt;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// Relative tolerance of models whose experiment annotation gives none: that of the Modelica
/// Association's reference results.
const TOLERANCE: f64 = 1e-6;

/// The stages of verifying a model, in order.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Stage {
    /// To a balanced flat model.
    Flatten,
    /// To sorted equations.
    Sort,
    /// To a program.
    Compile,
    /// From its start time to its stop time.
    Simulate,
    /// With the reference.
    Compare,
}

/// The reference that a model is compared with.
#[derive(Debug, Clone, Copy)]
pub struct Reference<'a> {
    /// The reference results.
    pub table: &'a ResultTable,
    /// The signals to compare.
    pub signals: &'a [String],
    /// Half sides of the tubes, relative to the reference's extent.
    pub tolerance: f64,
    /// Whether the table has samples of trajectories, not all their points.
    pub is_sampled: bool,
}

/// Where a model got stuck.
#[derive(Debug, Clone)]
pub struct Stuck {
    /// The stage that it did not pass.
    pub stage: Stage,
    /// Why: at least one.
    pub errors: Vec<Diagnostic>,
}

impl Stage {
    /// All stages, in order.
    pub const ALL: [Stage; 5] =
        [Stage::Flatten, Stage::Sort, Stage::Compile, Stage::Simulate, Stage::Compare];

    /// Its name, such as `sort`.
    pub fn name(self) -> &'static str {
        match self {
            Stage::Flatten => "flatten",
            Stage::Sort => "sort",
            Stage::Compile => "compile",
            Stage::Simulate => "simulate",
            Stage::Compare => "compare",
        }
    }
}

impl fmt::Display for Stage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// All classes that a session has loaded, with the files that models may read; the session is left
/// without them.
pub fn library(session: &mut Session) -> Arc<Library> {
    let mut library = std::mem::take(session.library());
    library.set_resources(session.resources());
    Arc::new(library)
}

/// Translates and simulates a class as its experiment annotation says, and compares it with the
/// reference if there is one: then the reference's time span counts, and its time points unless it
/// is sampled. `enter` is called with each stage as it begins; the flag ends a simulation.
///
/// # Errors
/// The stage that it did not pass, with everything that is wrong there.
pub fn verify(
    library: &Library,
    class: &Name,
    reference: Option<Reference>,
    cancel: &Arc<AtomicBool>,
    enter: &mut dyn FnMut(Stage),
) -> Result<Vec<Compared>, Stuck> {
    let nowhere = |fault: Fault| fault.at(Span::NONE);
    let stuck = |stage| move |error: Diagnostic| Stuck { stage, errors: vec![error] };
    enter(Stage::Flatten);
    let flat = flatten::flatten(library, class, &[])
        .map_err(|errors| Stuck { stage: Stage::Flatten, errors })?;
    enter(Stage::Sort);
    let sorted = causalize::causalize(&flat.model).map_err(stuck(Stage::Sort))?;
    enter(Stage::Compile);
    let program = Program::compile(sorted).map_err(stuck(Stage::Compile))?;
    enter(Stage::Simulate);
    let (result, between) =
        simulate(&program, reference.as_ref(), cancel).map_err(stuck(Stage::Simulate))?;
    let Some(reference) = reference else { return Ok(Vec::new()) };
    enter(Stage::Compare);
    let Reference { table, signals, tolerance, is_sampled } = reference;
    let compared = match is_sampled {
        true => {
            let is_written = |t: &f64| between.binary_search_by(|b| b.total_cmp(t)).is_err();
            let is_written: Vec<bool> = result.time.iter().map(is_written).collect();
            results::compare_samples(&result, &is_written, table, signals, tolerance)
        }
        false => results::compare(&result, table, signals, tolerance),
    };
    compared.map_err(nowhere).map_err(stuck(Stage::Compare))
}

/// The signals of a reference, as simulated, and the times that are not those of the experiment
/// annotation.
fn simulate(
    program: &Arc<Program>,
    reference: Option<&Reference>,
    cancel: &Arc<AtomicBool>,
) -> Result<(ResultTable, Vec<f64>), Diagnostic> {
    let mut settings = simulation::settings(&program.experiment(), &options(program, reference))
        .map_err(|fault| fault.at(Span::NONE))?;
    settings.cancel = Some(cancel.clone());
    settings.max_total_steps = simulation::MOST_STEPS;
    let mut between = Vec::new();
    if let Some(reference) = reference {
        let mut times = reference.table.time.clone();
        times.dedup();
        if reference.is_sampled {
            let own = instants(&settings);
            let is_own = |t: &f64| {
                let at = own.partition_point(|own| own < t);
                own[at.saturating_sub(1)..own.len().min(at + 1)].iter().any(|o| same_time(*o, *t))
            };
            between = results::between_samples(&times);
            between.retain(|t| !is_own(t));
            times = own.iter().chain(&between).copied().collect();
            times.sort_by(f64::total_cmp);
        }
        settings.output = OutputGrid::At(times);
    }
    let (observed, names) = observed(program, reference);
    let mut system = program.system();
    system.observe_only(&observed);
    let mut trajectory = Trajectory::default();
    let run = Simulator::new().run(&mut system, &settings, &mut trajectory);
    run.map_err(|error| system.explain(&error))?;
    let mut table = ResultTable::new(trajectory.time().to_vec());
    let column = |(at, name)| Series::new(name, Values::Trajectory(trajectory.column(at).to_vec()));
    table.series = names.into_iter().enumerate().map(column).collect();
    Ok((table, between))
}

/// The instants at which a simulation writes its results, beside its events.
fn instants(settings: &Settings) -> Vec<f64> {
    let Settings { start, stop, .. } = *settings;
    match &settings.output {
        OutputGrid::At(times) => times.clone(),
        OutputGrid::Intervals(n) => {
            let at = |step: usize| start + (stop - start) * (step as f64 / *n as f64);
            (0..=*n).map(|step| if step == *n { stop } else { at(step) }).collect()
        }
    }
}

fn options(program: &Program, reference: Option<&Reference>) -> SimulationOptions {
    let time = reference.map_or(&[][..], |reference| &reference.table.time);
    SimulationOptions {
        start: time.first().copied(),
        stop: time.last().copied(),
        tolerance: Some(program.experiment().tolerance.unwrap_or(TOLERANCE)),
        ..SimulationOptions::default()
    }
}

/// The variables that a reference asks for, and its names for them.
fn observed(program: &Program, reference: Option<&Reference>) -> (Vec<usize>, Vec<String>) {
    let signals = reference.map_or(&[][..], |reference| reference.signals);
    let without_blanks = |name: &str| name.replace(char::is_whitespace, "");
    let find = |signal: &String| {
        let requested = without_blanks(signal);
        let is_requested = |name: &str| name == requested || without_blanks(name) == requested;
        let at = program.variables().iter().position(|variable| is_requested(&variable.name))?;
        Some((at, signal.clone()))
    };
    signals.iter().filter_map(find).unzip()
}
