//! A unit that is loaded into this process, and simulations of it.

use super::LogMessage;
use super::binary::{Binary, Component, Identity};
use super::calls::{CallError, CallWatch};
use super::cosimulation::CoSimulation;
use super::directions::Directions;
use super::exchange::ExchangeSystem;
use super::failure::{FailureClass, SimulationFailure};
use super::inputs::Inputs;
use super::layout::Layout;
use super::plan::{InterfaceKind, Plan};
use super::platform::{interface, library_path};
use super::scheduled::Scheduled;
use super::stepped::{Stepped, Stopped};
use super::values::{Assignment, Readings};
use crate::Description;
use crate::description::Causality;
use crate::sim::{Settings, SimErrorKind, Simulator, Statistics, Trajectory};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A loaded unit with the workspace of its simulations.
pub struct Unit {
    description: Description,
    folder: PathBuf,
    binaries: Vec<(InterfaceKind, Arc<Binary>)>,
    /// The instance of the simulation before, unless a process may have one alone: what instances share, such
    /// as a file that was read, then outlives each.
    before: Option<Component>,
    simulator: Simulator,
    watch: Arc<CallWatch>,
}

impl Unit {
    /// A unit whose archive is unpacked in a folder; nothing is loaded yet.
    pub fn new(folder: &Path, description: Description, watch: Arc<CallWatch>) -> Unit {
        Unit {
            description,
            folder: folder.to_owned(),
            binaries: Vec::new(),
            before: None,
            simulator: Simulator::new(),
            watch,
        }
    }

    /// Simulates with these values of what varies. What the unit says is appended to `messages`.
    ///
    /// # Errors
    /// When and why the simulation failed; `out` has what was computed until then.
    pub fn simulate(
        &mut self,
        (plan, values): (&Plan, &[f64]),
        settings: &Settings,
        out: &mut Trajectory,
        messages: &mut Vec<LogMessage>,
    ) -> Result<Statistics, SimulationFailure> {
        let at_start =
            |message: String| SimulationFailure::new(settings.start, FailureClass::Unit, message);
        self.load(plan.kind).map_err(at_start)?;
        let Unit { description, binaries, before, simulator, .. } = self;
        let loaded = binaries.iter().find(|(kind, _)| *kind == plan.kind);
        let Some((_, binary)) = loaded else { return Err(at_start("it is not loaded".to_owned())) };
        let layout = Layout::of(description, &structural_values(description, plan));
        let layout = layout.map_err(at_start)?;
        let identity = identity(description, &self.folder, plan.kind);
        // Some say that they have an event mode and refuse it.
        let plain = Identity { has_event_mode: false, ..identity.clone() };
        let made = Component::new(binary, plan.kind, &identity).map(|own| (own, &identity));
        let made = match made {
            Err(_) if identity.has_event_mode => {
                Component::new(binary, plan.kind, &plain).map(|own| (own, &plain))
            }
            made => made,
        };
        let (component, identity) = made.map_err(|(error, said)| {
            let said = named(said, description);
            let message = with_last_problem(error.to_string(), &said);
            messages.extend(said);
            SimulationFailure::new(settings.start, FailureClass::Instance, message)
        })?;
        let has_event_mode = identity.has_event_mode;
        *before = None;
        let component =
            match interface(description, plan.kind).is_ok_and(|own| own.is_single_instance) {
                true => &component,
                false => before.insert(component),
            };
        let run = Run { component, description, layout: &layout, plan, settings, has_event_mode };
        let ended = run.simulate(values, simulator, out);
        let said = named(component.messages(), description);
        let ended = ended.map_err(|failure| match failure.class {
            FailureClass::Unit => {
                let message = with_last_problem(failure.message, &said);
                SimulationFailure { message, ..failure }
            }
            _ => failure,
        });
        messages.extend(said);
        ended
    }

    fn load(&mut self, kind: InterfaceKind) -> Result<(), String> {
        if self.binaries.iter().any(|(loaded, _)| *loaded == kind) {
            return Ok(());
        }
        let path = library_path(&self.description, kind)?;
        let binary =
            Binary::load(&self.folder.join(&path), self.description.version, self.watch.clone())
                .map_err(|why| format!("`{path}` cannot be loaded: {why}"))?;
        self.binaries.push((kind, Arc::new(binary)));
        Ok(())
    }
}

/// Messages with the names of variables.
fn named(said: Vec<LogMessage>, description: &Description) -> Vec<LogMessage> {
    said.into_iter().map(|message| message.named(description)).collect()
}

/// A sentence, followed by the last warning or error that the unit has logged.
fn with_last_problem(sentence: String, said: &[LogMessage]) -> String {
    match said.iter().rfind(|message| message.is_problem) {
        Some(last) => format!("{sentence}: {}", last.text),
        None => sentence,
    }
}

/// The values of structural parameters in a plan.
fn structural_values(description: &Description, plan: &Plan) -> Vec<(super::Place, f64)> {
    let is_structural = |place: super::Place| {
        description.variables[place.variable].causality == Causality::StructuralParameter
    };
    plan.numbers.iter().copied().filter(|(place, _)| is_structural(*place)).collect()
}

fn identity(description: &Description, folder: &Path, kind: InterfaceKind) -> Identity {
    let resources = folder.join("resources");
    let path = resources.display().to_string().replace('\\', "/");
    let rooted = if path.starts_with('/') { path.clone() } else { format!("/{path}") };
    let separator = if cfg!(windows) { '\\' } else { '/' };
    let interface = description.co_simulation.as_ref();
    let interface = interface.filter(|_| kind == InterfaceKind::CoSimulation);
    Identity {
        token: description.token.clone(),
        resource_path: format!("{}{separator}", resources.display()),
        resource_uri: format!("file://{}", escaped(&rooted)),
        has_event_mode: interface.is_some_and(|own| own.has_event_mode),
        may_return_early: interface.is_some_and(|own| own.might_return_early),
    }
}

/// A path within a URI (RFC 3986).
fn escaped(path: &str) -> String {
    let is_plain = |byte: u8| byte.is_ascii_alphanumeric() || b"-._~/:".contains(&byte);
    let one = |byte: u8| match is_plain(byte) {
        true => char::from(byte).to_string(),
        false => format!("%{byte:02X}"),
    };
    path.bytes().map(one).collect()
}

/// One simulation with an instance of its own.
struct Run<'a> {
    component: &'a Component,
    description: &'a Description,
    layout: &'a Layout,
    plan: &'a Plan,
    settings: &'a Settings,
    has_event_mode: bool,
}

impl Run<'_> {
    fn simulate(
        &self,
        values: &[f64],
        simulator: &mut Simulator,
        out: &mut Trajectory,
    ) -> Result<Statistics, SimulationFailure> {
        let Run { component, description, layout, plan, settings, has_event_mode } = self;
        out.reset(plan.observed.len());
        let at_start = |error: CallError| of_call(settings.start, error);
        Assignment::new(description, layout, plan, values).apply(component).map_err(at_start)?;
        let inputs = Inputs::new(description, layout, &plan.inputs, &plan.numbers);
        let parts = (inputs, Readings::new(description, layout, &plan.observed));
        let statistics = match plan.kind {
            InterfaceKind::CoSimulation => {
                let run = Stepped::new(component, parts, settings);
                let mut simulation = CoSimulation::new(run, description, *has_event_mode);
                let ended = simulation.simulate(out);
                ended_as(ended, &simulation.run)?
            }
            InterfaceKind::ScheduledExecution => {
                let run = Stepped::new(component, parts, settings);
                let mut simulation = Scheduled::new(run, description, &plan.inputs);
                let ended = simulation.simulate(out);
                ended_as(ended, &simulation.run)?
            }
            InterfaceKind::ModelExchange => {
                let directions = plan.differentiates.then(|| Directions::of(description, plan));
                let directions = directions.transpose().map_err(|why| refused(settings, &why))?;
                let how = (*settings, directions.map(|own| (own, values)));
                let system = ExchangeSystem::new(component, description, parts, how);
                let mut system = system.map_err(at_start)?;
                let run = simulator.run(&mut system, settings, out);
                run.map_err(|error| {
                    let failure = match system.failure() {
                        _ if system.refusal().is_some() => {
                            refused(settings, system.refusal().unwrap_or_default())
                        }
                        Some(call) if is_of_call(error.kind) => of_call(error.time, call),
                        _ => of_kind(error.time, error.kind),
                    };
                    SimulationFailure { statistics: Box::new(*simulator.statistics()), ..failure }
                })?
            }
        };
        // What it says at its end changes nothing.
        let _ = component.terminate();
        Ok(statistics)
    }
}

fn is_of_call(kind: SimErrorKind) -> bool {
    matches!(kind, SimErrorKind::Initialization(_) | SimErrorKind::Evaluation(_))
}

fn refused(settings: &Settings, why: &str) -> SimulationFailure {
    SimulationFailure::new(settings.start, FailureClass::Derivatives, why.to_owned())
}

/// How a simulation from point to point has ended.
fn ended_as(
    ended: Result<(), Stopped>,
    run: &Stepped<'_>,
) -> Result<Statistics, SimulationFailure> {
    let (time, statistics) = (run.time, run.statistics);
    ended.map(|()| statistics).map_err(|stopped| {
        let failure = match stopped {
            Stopped::Call(error) => of_call(time, error),
            Stopped::Kind(kind) => of_kind(time, kind),
        };
        SimulationFailure { statistics: Box::new(statistics), ..failure }
    })
}

fn of_call(time: f64, error: CallError) -> SimulationFailure {
    SimulationFailure::new(time, FailureClass::Unit, error.to_string())
}

fn of_kind(time: f64, kind: SimErrorKind) -> SimulationFailure {
    let (class, message) = match kind {
        SimErrorKind::StepBudget => (FailureClass::Steps, "too many steps are needed"),
        SimErrorKind::TimeBudget => (FailureClass::Time, "it takes more time than allowed"),
        SimErrorKind::Cancelled => (FailureClass::Cancelled, "it was cancelled"),
        SimErrorKind::StepSize => (FailureClass::Solver, "the solver makes no progress"),
        SimErrorKind::Singular => (FailureClass::Solver, "the iteration matrix is singular"),
        SimErrorKind::Chattering => (FailureClass::Solver, "events follow each other without end"),
        SimErrorKind::Accumulation => {
            (FailureClass::Solver, "infinitely many events come before this time")
        }
        SimErrorKind::NotFinite => (FailureClass::Solver, "a state is not finite"),
        SimErrorKind::Settings => (FailureClass::Solver, "the interval or tolerance is not valid"),
        SimErrorKind::ExplicitMethod
        | SimErrorKind::Initialization(_)
        | SimErrorKind::Evaluation(_) => (FailureClass::Solver, "an evaluation failed"),
    };
    SimulationFailure::new(time, class, message.to_owned())
}
