//! The workspace of simulations, one after the other.

use super::before_event::BeforeEvent;
use super::event::CrossingSearch;
use super::event_rush::EventRush;
use super::integrators::nonstiff::{self, Nonstiff};
use super::integrators::{Exact, Integrator, Problem, WithoutUnknowns, bdf};
use super::nominals::Nominals;
use super::progress::Progress;
use super::recorder::{OutputPoints, Recorder};
use super::run::{BranchSwitches, Ended, Run};
use super::sliding::Sliding;
use super::switches::Watch;
use super::{DaeSystem, Effort, Settings, SimError, SimErrorKind, Statistics, Trajectory};
use crate::registry::Options;

/// Simulates systems one after the other with one workspace: nothing is allocated when a system has
/// the sizes of the one before.
#[derive(Default)]
pub struct Simulator {
    /// The integrator of the last run, by the name of its method.
    integrator: Option<(&'static str, Box<dyn Integrator>)>,
    without_unknowns: WithoutUnknowns,
    exact: Exact,
    nonstiff: Nonstiff,
    /// Slides where the method is explicit.
    implicit: Option<Box<dyn Integrator>>,
    crossings: CrossingSearch,
    before_event: BeforeEvent,
    watch: Watch,
    nominals: Nominals,
    y: Vec<f64>,
    observed: Vec<f64>,
    effort: Effort,
    statistics: Statistics,
}

/// How a simulation ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct End {
    /// The time that was reached, seconds.
    pub time: f64,
    /// Why it ended there.
    pub why: Ended,
    /// How long the next step is meant to be, seconds, where the method keeps nothing else of its past.
    pub next_step: Option<f64>,
}

/// Simulates a system with a workspace of its own.
///
/// # Errors
/// When and why the simulation failed.
pub fn simulate(
    system: &mut dyn DaeSystem,
    settings: &Settings,
) -> Result<(Trajectory, Statistics), SimError> {
    let mut trajectory = Trajectory::default();
    let statistics = Simulator::new().run(system, settings, &mut trajectory)?;
    Ok((trajectory, statistics))
}

impl Simulator {
    /// A simulator without workspace yet.
    pub fn new() -> Simulator {
        Simulator::default()
    }

    /// The effort of the last run, if its settings asked for it.
    pub fn effort(&self) -> &Effort {
        &self.effort
    }

    /// What the last run cost, also where it failed.
    pub fn statistics(&self) -> &Statistics {
        &self.statistics
    }

    /// Simulates a system. The observed variables at the output points and at both sides of every
    /// event become the rows of `out`, which keeps what was computed until a failure.
    ///
    /// # Errors
    /// When and why the simulation failed.
    pub fn run(
        &mut self,
        system: &mut dyn DaeSystem,
        settings: &Settings,
        out: &mut Trajectory,
    ) -> Result<Statistics, SimError> {
        self.run_from(system, settings, None, out).map(|_| self.statistics)
    }

    /// Continues a simulation of a system that is initialized, from y at the start of the settings, with
    /// algebraic unknowns as far as the method has them; y is that at the end afterwards.
    ///
    /// # Errors
    /// When and why the simulation failed; y is where it was reached.
    pub fn resume(
        &mut self,
        system: &mut dyn DaeSystem,
        settings: &Settings,
        y: &mut [f64],
        out: &mut Trajectory,
    ) -> Result<End, SimError> {
        let done = self.run_from(system, settings, Some(y), out);
        if self.y.len() == y.len() {
            y.copy_from_slice(&self.y);
        }
        done
    }

    fn run_from(
        &mut self,
        system: &mut dyn DaeSystem,
        settings: &Settings,
        from: Option<&[f64]>,
        out: &mut Trajectory,
    ) -> Result<End, SimError> {
        let (n, is_explicit, solves_loops) = self.prepare(system, settings, from, out);
        let linearity = system.linearity().filter(|_| settings.takes_exact_steps && n > 0);
        let distance = nonstiff::distance(system, settings).filter(|_| linearity.is_none());
        let integrator: &mut dyn Integrator = match linearity {
            _ if n == 0 => &mut self.without_unknowns,
            Some(linearity) => {
                self.exact.begin(linearity);
                &mut self.exact
            }
            None => integrator(&mut self.integrator, settings),
        };
        self.statistics = Statistics::default();
        if let Some(kind) = refused(settings, integrator, system) {
            return Err(SimError { time: settings.start, kind, offending: None });
        }
        let mut system = Sliding::new(system);
        let mut run = Run {
            problem: Problem::new(
                &mut system,
                self.nominals.plain(),
                settings,
                &mut self.statistics,
            ),
            integrator,
            implicit: self.implicit.get_or_insert_with(bdf::new).as_mut(),
            nonstiff: distance.map(|distance| (&mut self.nonstiff, distance)),
            patience: None,
            is_explicit: is_explicit || linearity.is_some(),
            solves_loops,
            crossings: &mut self.crossings,
            before_event: &mut self.before_event,
            watch: &mut self.watch,
            nominals: &self.nominals,
            y: &mut self.y,
            effort: &mut self.effort,
            t: settings.start,
            recorder: Recorder {
                observed: &mut self.observed,
                rows: out,
                points: OutputPoints::new(settings, n == 0 || linearity.is_some()),
            },
            rush: EventRush::NONE,
            branch_switches: BranchSwitches::NONE,
            progress: Progress::default(),
            is_resumed: from.is_some(),
        };
        let ended = run.run();
        let why =
            ended.map_err(|kind| SimError { time: run.t, kind, offending: run.offending(kind) })?;
        Ok(End { time: run.t, why, next_step: run.integrator.next_step() })
    }

    /// Sets up the workspace; the number of unknowns, whether the method is explicit, and whether the
    /// system solves its loops itself.
    fn prepare(
        &mut self,
        system: &mut dyn DaeSystem,
        settings: &Settings,
        from: Option<&[f64]>,
        out: &mut Trajectory,
    ) -> (usize, bool, bool) {
        if from.is_none() {
            system.begin();
        }
        // Explicit methods see no algebraic variables if the system can do without; and without
        // states there is nothing to integrate, only equations to solve at every point.
        let is_explicit = integrator(&mut self.integrator, settings).is_explicit();
        let solves_loops = is_explicit || system.n_differential() == 0;
        system.solve_loops(solves_loops);
        let n = system.n_differential() + system.n_algebraic();
        self.resize(system, n);
        self.y.resize(n * (1 + system.n_directions()), 0.0);
        if let Some(y) = from {
            self.y.copy_from_slice(y);
        }
        self.nominals.begin(system, n, settings.tolerance);
        out.reset(system.n_observed());
        self.effort = Effort::default();
        if settings.counts_effort {
            self.effort.reset(n, system.n_crossings());
        }
        (n, is_explicit, solves_loops)
    }

    fn resize(&mut self, system: &dyn DaeSystem, n: usize) {
        self.y.resize(n, 0.0);
        self.observed.resize(system.n_observed(), 0.0);
        self.crossings.resize(system.n_crossings());
        self.watch.resize(system.n_crossings());
        self.before_event.resize(system.n_crossings());
    }
}

/// Why there is nothing to begin with.
fn refused(
    settings: &Settings,
    integrator: &dyn Integrator,
    system: &dyn DaeSystem,
) -> Option<SimErrorKind> {
    let finite = settings.start.is_finite() && settings.stop.is_finite();
    if !finite || !(1e-14..=1.0).contains(&settings.tolerance) {
        return Some(SimErrorKind::Settings);
    }
    (integrator.is_explicit() && system.n_algebraic() > 0).then_some(SimErrorKind::ExplicitMethod)
}

/// The requested integrator, created if it is not the current one.
fn integrator<'a>(
    slot: &'a mut Option<(&'static str, Box<dyn Integrator>)>,
    settings: &Settings,
) -> &'a mut dyn Integrator {
    let name = settings.method.name;
    if slot.as_ref().is_none_or(|(made, _)| *made != name) {
        let made = (settings.method.make)(&mut Options::default());
        *slot = Some((name, made.expect("every integrator can be made without options")));
    }
    let (_, integrator) = slot.as_mut().expect("just filled");
    integrator.as_mut()
}
