//! The loop of a simulation.

use super::before_event::BeforeEvent;
use super::event::CrossingSearch;
use super::instants::same_time;
use super::integrators::nonstiff::{self, Distance, Nonstiff, Patience};
use super::integrators::{Exact, Integrator, Problem, WithoutUnknowns, bdf};
use super::norm::nominal_share;
use super::progress::Progress;
use super::sliding::{MOST_SURFACES, Sliding};
use super::switches::Watch;
use super::{
    DaeSystem, Effort, EventOutcome, Events, Failure, Offending, Residual, Sensitive, Settings,
    SimError, SimErrorKind, Statistics, Trajectory,
};
use crate::registry::Options;
use std::cell::OnceCell;
use std::sync::atomic::Ordering;

/// So many events in a row within the time below are chattering.
const MOST_EVENTS_AT_ONCE: u32 = 200;
/// Distance of events that count as one place in time, relative to the simulated interval.
const AT_ONCE: f64 = 1e-10;
/// Parts of a step that are searched for events of their own, at least.
const PARTS_SEARCHED: f64 = 8.0;
/// Parts of the simulation that are searched so, at least: as many as there are output intervals
/// unless settings say otherwise, so that no events are missed where points are few.
const PARTS_OF_SPAN: f64 = 500.0;
/// Parts of a period of functions that oscillate in time: parabolas through three values find a pulse
/// of a thousandth of the period, as sin(ωt) > 0.99999.
const PARTS_OF_PERIOD: f64 = 32.0;
/// Steps longer than one of so many parts of a period are long for it: what varies with that period may
/// lie in the error of unknowns that functions amplify. `i < 2` in v = e - i/2, v i = 840 (1 + sin(t)/10)
/// with e near 420 lost 46 of 63 events with `radau5` at the tolerance 1e-4.
const STEPS_OF_PERIOD: f64 = 8.0;
/// How far past the end of a solution of the algebraic equations another one is searched for,
/// relative to the simulated interval.
const LEAPS: [f64; 3] = [1e-10, 1e-9, 1e-8];
/// The next branch switch must be this many times farther away.
const FARTHER: f64 = 1e3;
/// Smaller changes, relative to the magnitude, are not a branch switch.
const SMALLEST_JUMP: f64 = 1e-3;
/// Points of every step that a system with a memory is shown.
const POINTS_REMEMBERED: u32 = 4;
/// Halvings of a step within which an assertion has failed: to a millionth of a millionth of it.
const ASSERTION_TRIALS: u32 = 40;

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

/// Why a simulation ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ended {
    /// It reached its stop time.
    AtStop,
    /// An event is to be handled, at which it was to end.
    AtEvent,
    /// The model ended it (`terminate`).
    Terminated,
}

/// Nominal values of y, without and with shares of surfaces.
#[derive(Default)]
pub(crate) struct Nominals {
    plain: Vec<f64>,
    /// Those of the states alone, once loops are solved inside.
    states: OnceCell<Vec<f64>>,
    /// For both.
    with_shares: [[OnceCell<Vec<f64>>; MOST_SURFACES]; 2],
    /// That of a share.
    share: f64,
}

impl Nominals {
    pub fn plain(&self) -> &[f64] {
        self.states.get().unwrap_or(&self.plain)
    }

    /// Leaves out those of algebraic unknowns from now on.
    pub(crate) fn show_states(&self, n: usize) {
        self.states.get_or_init(|| self.plain[..n].to_vec());
    }

    /// With so many shares at a place.
    pub(crate) fn with_shares(&self, place: usize, k: usize) -> &[f64] {
        let slots = &self.with_shares[usize::from(self.states.get().is_some())];
        slots[k - 1].get_or_init(|| {
            let (before, after) = self.plain().split_at(place);
            [before, &vec![self.share; k], after].concat()
        })
    }
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
            observed: &mut self.observed,
            effort: &mut self.effort,
            out,
            t: settings.start,
            outputs: OutputPoints::new(settings, n == 0 || linearity.is_some()),
            jumps: Jumps::NONE,
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
        self.set_nominals(system, settings.tolerance);
        out.reset(system.n_observed());
        self.effort = Effort::default();
        if settings.counts_effort {
            self.effort.reset(n, system.n_crossings());
        }
        (n, is_explicit, solves_loops)
    }

    fn resize(&mut self, system: &dyn DaeSystem, n: usize) {
        self.nominals.plain.resize(n, 1.0);
        self.y.resize(n, 0.0);
        self.observed.resize(system.n_observed(), 0.0);
        self.crossings.resize(system.n_crossings());
        self.watch.resize(system.n_crossings());
        self.before_event.resize(system.n_crossings());
    }

    fn set_nominals(&mut self, system: &dyn DaeSystem, tolerance: f64) {
        let nominals = &mut self.nominals;
        system.nominal(&mut nominals.plain);
        for nominal in nominals.plain.iter_mut().filter(|n| !n.is_finite() || **n <= 0.0) {
            *nominal = 1.0;
        }
        nominals.share = nominal_share(tolerance);
        nominals.states.take();
        nominals.with_shares.iter_mut().flatten().for_each(|with| drop(with.take()));
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

/// Whether the simulation continues after an event.
#[derive(PartialEq)]
pub enum After {
    /// The step still holds.
    Resume,
    /// The next step begins here: the integrator was restarted, or continues with its past.
    Restarted,
    /// The model ended the simulation.
    Terminated,
    /// An event is to be handled, before which the simulation ends.
    Stopped,
}

/// A simulation in progress; `t` and `y` are how far it has come.
pub struct Run<'a> {
    pub(super) problem: Problem<'a>,
    pub(super) integrator: &'a mut dyn Integrator,
    /// Takes the place of an explicit one in slides, and the other way round.
    pub(super) implicit: &'a mut dyn Integrator,
    /// The explicit method for steps of this length, until it is known whether it suits.
    pub(super) nonstiff: Option<(&'a mut Nonstiff, Distance)>,
    /// How long it may continue, while it does.
    pub(super) patience: Option<Patience>,
    /// Whether the method is explicit, or exact.
    pub(super) is_explicit: bool,
    /// Whether the system solves its loops itself.
    pub(super) solves_loops: bool,
    pub(super) crossings: &'a mut CrossingSearch,
    pub(super) before_event: &'a mut BeforeEvent,
    pub(super) watch: &'a mut Watch,
    pub(super) nominals: &'a Nominals,
    pub(super) y: &'a mut Vec<f64>,
    observed: &'a mut [f64],
    effort: &'a mut Effort,
    out: &'a mut Trajectory,
    pub(super) t: f64,
    outputs: OutputPoints,
    jumps: Jumps,
    pub(super) progress: Progress,
    /// Whether it continues another one.
    is_resumed: bool,
}

/// The output points of a run.
struct OutputPoints {
    /// The next output point and its number.
    next_output: Option<f64>,
    output_number: usize,
    /// Whether a step ends at every output point: nothing is interpolated.
    ends_at_points: bool,
}

impl OutputPoints {
    fn new(settings: &Settings, ends_at_points: bool) -> OutputPoints {
        let next_output = settings.output.point(settings.start, settings.stop, 0);
        OutputPoints { next_output, output_number: 0, ends_at_points }
    }
}

/// When events and jumps were the last time.
struct Jumps {
    last_event: f64,
    last_jump: f64,
    /// When algebraic unknowns were solved for because no step could be made.
    last_solved: f64,
    events_at_once: u32,
}

impl Jumps {
    const NONE: Jumps = Jumps {
        last_event: f64::NEG_INFINITY,
        last_jump: f64::NEG_INFINITY,
        last_solved: f64::NEG_INFINITY,
        events_at_once: 0,
    };
}

impl Run<'_> {
    fn run(&mut self) -> Result<Ended, SimErrorKind> {
        let ends = |after: &After| matches!(after, After::Terminated | After::Stopped);
        let mut after = self.initialize()?;
        if after == After::Restarted && self.is_curve() {
            after = self.follow_curve()?;
        }
        while !ends(&after) && self.t < self.problem.settings.stop {
            after = match self.step() {
                Ok(time_event) => {
                    self.count_step();
                    self.advance_to_end_of_step(time_event)?
                }
                Err(_) if self.patience.is_some() => self.end_explicit_steps()?,
                Err(kind) => self.jump(kind).or_else(|kind| self.take_loops_inside(kind))?,
            };
            if ends(&after) {
                break;
            }
            self.watch_explicit_steps()?;
            self.watch_progress()?;
            let Problem { settings, budget, statistics, .. } = &mut self.problem;
            budget.extend(self.t, settings.stop, statistics.attempts());
        }
        self.end_slide();
        // The end of a part is not the end of the simulation.
        if !self.is_resumed {
            let finished = self.problem.system.finish(self.t, self.y);
            if finished.map_err(SimErrorKind::Evaluation)? {
                self.record()?;
            }
        }
        Ok(match after {
            After::Terminated => Ended::Terminated,
            After::Stopped => Ended::AtEvent,
            After::Resume | After::Restarted => Ended::AtStop,
        })
    }

    fn initialize(&mut self) -> Result<After, SimErrorKind> {
        let system = &mut *self.problem.system;
        if !self.is_resumed {
            system.initialize(self.t, self.y).map_err(SimErrorKind::Initialization)?;
        }
        if !self.y.iter().all(|y| y.is_finite()) {
            return Err(SimErrorKind::NotFinite);
        }
        // Steps no longer than a delay that is all but zero would come to no end.
        let (longest, way) = (system.longest_step(), self.problem.settings.stop - self.t);
        if way > 0.0
            && (longest <= 0.0 || way / longest > self.problem.settings.max_total_steps as f64)
        {
            return Err(SimErrorKind::StepBudget);
        }
        system.check(self.t, self.y).map_err(SimErrorKind::Evaluation)?;
        if self.outputs.next_output == Some(self.t) {
            self.record()?;
            self.advance_output();
        }
        if way > 0.0 && self.problem.system.has_event_at_start() {
            self.problem.statistics.time_events += 1;
            self.problem.system.crossed(None, way);
            if self.whole_event(self.t)? == EventOutcome::Terminate {
                return Ok(After::Terminated);
            }
        }
        self.begin_explicit_steps();
        self.restart()?;
        Ok(After::Restarted)
    }

    pub fn restart(&mut self) -> Result<(), SimErrorKind> {
        self.start_crossings()?;
        self.restart_integrator()
    }

    fn restart_integrator(&mut self) -> Result<(), SimErrorKind> {
        self.problem.elapsed = 0.0;
        self.integrator.restart(&mut self.problem, self.t, self.y)
    }

    pub(crate) fn start_crossings(&mut self) -> Result<bool, SimErrorKind> {
        self.crossings.start(&mut self.problem, self.t, self.y).map_err(SimErrorKind::Evaluation)
    }

    fn count_step(&mut self) {
        self.problem.statistics.explicit_steps += u64::from(self.patience.is_some());
        if self.problem.settings.counts_effort {
            Effort::count(&mut self.effort.unknowns, self.integrator.dominant());
        }
    }

    /// Makes a step; whether it ended at a time event.
    fn step(&mut self) -> Result<bool, SimErrorKind> {
        let stop = self.problem.settings.stop;
        let event = self.problem.system.next_time_event(self.t);
        // The hundredth tick of a clock may miss the end by a rounding.
        let event = event.map(|event| if same_time(event, stop) { stop } else { event });
        let event = event.filter(|event| *event > self.t && *event <= stop);
        let mut limit = event.unwrap_or(stop);
        limit = limit.min(self.t + self.problem.system.longest_step());
        if self.outputs.ends_at_points {
            limit = self.outputs.next_output.map_or(limit, |point| limit.min(point));
        }
        self.integrator.step(&mut self.problem, limit)?;
        let Some(event) = event else { return Ok(false) };
        // A step to an output point may end next to an event: the same time to the system.
        let next = self.problem.system.next_time_event(self.integrator.time());
        Ok(next.is_none_or(|next| next > event))
    }

    /// Where no step can be made: the solution of the algebraic equations may continue elsewhere,
    /// or on another branch. Fails with `kind` if it does not.
    fn jump(&mut self, kind: SimErrorKind) -> Result<After, SimErrorKind> {
        let system = &*self.problem.system;
        // Derivatives do not follow a solution that jumps for no reason of its own.
        if system.n_directions() > 0 || system.is_constrained() {
            return Err(kind);
        }
        let ends = kind == SimErrorKind::StepSize && system.n_algebraic() > 0;
        let is_domain = matches!(kind, SimErrorKind::Evaluation(Failure::Domain { .. }));
        if !ends && !is_domain {
            return Err(kind);
        }
        if let Some(after) = self.solve_again() {
            return Ok(after);
        }
        if ends { self.switch_branch(kind) } else { self.leave_branch(kind) }
    }

    /// The integrator leaves errors in algebraic unknowns that may be too large for any further step,
    /// as near the zero of a root: an event here solves for them. `None` if that was not the reason.
    fn solve_again(&mut self) -> Option<After> {
        let span = self.problem.settings.stop - self.problem.settings.start;
        if self.problem.system.n_algebraic() == 0
            || self.t - self.jumps.last_solved <= LEAPS[0] * span
        {
            return None;
        }
        self.jumps.last_solved = self.t;
        let before = self.y.to_vec();
        self.problem.system.crossed(None, span);
        let outcome = self.whole_event(self.t);
        let after = match outcome {
            Ok(EventOutcome::Terminate) => Some(After::Terminated),
            Ok(_) if *self.y != before && self.restart().is_ok() => Some(After::Restarted),
            _ => None,
        };
        if after.is_none() {
            self.y.copy_from_slice(&before);
        }
        after
    }

    /// A turning point: the solution of the algebraic equations ends, and they may have another
    /// branch just past it, to which an event leads.
    fn switch_branch(&mut self, kind: SimErrorKind) -> Result<After, SimErrorKind> {
        let span = self.problem.settings.stop - self.problem.settings.start;
        if self.t - self.jumps.last_jump <= FARTHER * LEAPS[0] * span {
            return Err(kind);
        }
        let (begin, before) = (self.t, self.y.to_vec());
        let derivatives = self.derivatives().map_err(SimErrorKind::Evaluation)?;
        for ahead in LEAPS.map(|leap| begin + leap * span) {
            if ahead > self.problem.settings.stop {
                break;
            }
            self.move_along(&before, &derivatives, ahead - begin);
            self.jumps.last_jump = ahead;
            self.problem.statistics.state_events += 1;
            let after = self.handle_event(ahead, false).map_err(|_| kind)?;
            if self.has_jumped(&before) {
                if after == After::Resume {
                    self.restart_integrator()?;
                }
                return Ok(after);
            }
        }
        self.t = begin;
        Err(kind)
    }

    /// A function has no value beyond, as sqrt(x) past x = 0, within less than the margin of the
    /// relation x >= 0 that chooses another branch there: an event here, or just past it, changes
    /// the relation. Or there is no value for the algebraic unknowns between here and just past it,
    /// where stages of a step would be, as in s + s² = abs(x) with s = sqrt(y) at x = 0.
    fn leave_branch(&mut self, kind: SimErrorKind) -> Result<After, SimErrorKind> {
        let settings = self.problem.settings;
        let span = settings.stop - settings.start;
        let distance = self.t - self.jumps.last_jump;
        if distance <= 0.0 {
            return Err(kind);
        }
        let may_leap =
            self.problem.system.n_algebraic() > 0 && distance > FARTHER * LEAPS[0] * span;
        let (begin, before) = (self.t, self.y.to_vec());
        let signs = self.crossings.signs.clone();
        let derivatives = self.derivatives().unwrap_or_else(|_| vec![0.0; before.len()]);
        for ahead in [0.0].into_iter().chain(LEAPS.map(|leap| leap * span)) {
            self.t = begin + ahead;
            if self.t > settings.stop {
                break;
            }
            self.jumps.last_jump = self.t;
            self.move_along(&before, &derivatives, ahead);
            self.problem.system.crossed(None, span);
            let Ok(outcome) = self.whole_event(self.t) else { continue };
            if outcome == EventOutcome::Terminate {
                return Ok(After::Terminated);
            }
            let has_switched = self.start_crossings().is_ok() && signs != self.crossings.signs;
            let leaps = may_leap && ahead > 0.0;
            if (has_switched || leaps) && self.restart().is_ok() {
                self.problem.statistics.state_events += 1;
                return Ok(After::Restarted);
            }
        }
        self.t = begin;
        self.y.copy_from_slice(&before);
        Err(kind)
    }

    /// The derivatives of the states here; zero for algebraic unknowns.
    fn derivatives(&mut self) -> Result<Vec<f64>, Failure> {
        let mut derivatives = vec![0.0; self.y.len()];
        self.problem.system.rhs(self.t, self.y, &mut derivatives)?;
        derivatives[self.problem.system.n_differential()..].fill(0.0);
        Ok(derivatives)
    }

    fn move_along(&mut self, before: &[f64], derivatives: &[f64], duration: f64) {
        for ((y, before), derivative) in self.y.iter_mut().zip(before).zip(derivatives) {
            *y = before + duration * derivative;
        }
    }

    /// Whether algebraic unknowns are elsewhere than before.
    fn has_jumped(&self, before: &[f64]) -> bool {
        let n = self.problem.system.n_differential();
        let pairs = self.y[n..].iter().zip(&before[n..]).zip(&self.problem.nominal[n..]);
        let mut moved = pairs.map(|((y, old), nominal)| (y - old).abs() / old.abs().max(*nominal));
        moved.any(|part| part > SMALLEST_JUMP)
    }

    /// Goes to the end of the step, or to the event that made the rest of it void.
    fn advance_to_end_of_step(&mut self, time_event: bool) -> Result<After, SimErrorKind> {
        let end = self.integrator.time();
        loop {
            self.y.copy_from_slice(self.integrator.state());
            let begin = self.t;
            match self.first_event(end)? {
                Some(event) => {
                    self.remember(begin, event)?;
                    self.record_before(event)?;
                    if self.problem.settings.stops_at_events {
                        self.t = event;
                        return Ok(After::Stopped);
                    }
                    self.problem.statistics.state_events += 1;
                    Effort::count(&mut self.effort.crossings, self.crossings.last());
                    self.count_switches(begin, event)?;
                    let after = self.handle_event(event, true)?;
                    if after != After::Terminated && self.treat_chattering()? {
                        return Ok(After::Restarted);
                    }
                    if after != After::Resume || event >= end {
                        return Ok(after);
                    }
                }
                None if time_event => {
                    self.remember(begin, end)?;
                    self.record_before(end)?;
                    if self.problem.settings.stops_at_events {
                        self.t = end;
                        return Ok(After::Stopped);
                    }
                    self.problem.statistics.time_events += 1;
                    return self.handle_event(end, false);
                }
                None => {
                    self.remember(begin, end)?;
                    self.record_before(end)?;
                    self.t = end;
                    self.y.copy_from_slice(self.integrator.state());
                    self.look_between_steps()?;
                    self.check_step(begin)?;
                    if self.outputs.next_output == Some(end) {
                        self.record()?;
                        self.advance_output();
                    }
                    return Ok(After::Resume);
                }
            }
        }
    }

    /// The first state event up to `end`, with y there. In steps that are long for the period of crossing
    /// functions the integrator knows the unknowns of loops too roughly: loops are solved then.
    fn first_event(&mut self, end: f64) -> Result<Option<f64>, SimErrorKind> {
        let begin = self.t;
        let is_long = end - begin > self.period(begin) / STEPS_OF_PERIOD;
        let has_parts = is_long || self.problem.system.crossings_vary_in_time();
        let mut part = begin;
        loop {
            let next = if has_parts { self.end_of_part(begin, part, end) } else { end };
            if next < end {
                self.integrator.interpolate(next, self.y);
            } else if part > begin {
                self.y.copy_from_slice(self.integrator.state());
            }
            self.crossings.solves_loops = is_long;
            let found = self
                .crossings
                .first_event(&mut self.problem, self.integrator, (part, next), self.y)
                .map_err(SimErrorKind::Evaluation)?;
            if found.is_some() || next >= end {
                return Ok(found);
            }
            part = next;
        }
    }

    /// The shortest period at `t` with which crossing functions oscillate by themselves; infinite where
    /// none is known.
    fn period(&mut self, t: f64) -> f64 {
        std::f64::consts::TAU / self.problem.system.oscillation(t)
    }

    /// The end of the part of a step that is searched at once: one of several, a small part of the
    /// simulation and of a period, and not beyond an output point.
    fn end_of_part(&mut self, begin: f64, part: f64, end: f64) -> f64 {
        let period = self.period(part);
        let settings = self.problem.settings;
        let span = settings.stop - settings.start;
        let longest = f64::min((end - begin) / PARTS_SEARCHED, span / PARTS_OF_SPAN);
        let shortest = span / settings.max_total_steps as f64;
        let share = part + longest.min((period / PARTS_OF_PERIOD).max(shortest));
        if share <= part {
            return end;
        }
        let numbers = self.outputs.output_number..;
        let mut points =
            numbers.map_while(|n| settings.output.point(settings.start, settings.stop, n));
        let point = points.find(|point| *point > part).unwrap_or(end);
        share.min(point).min(end)
    }

    /// Records the output points before `end`; y is y(`end`) afterwards as before.
    fn record_before(&mut self, end: f64) -> Result<(), SimErrorKind> {
        let mut moved = false;
        while let Some(point) = self.outputs.next_output.filter(|point| *point < end) {
            self.integrator.interpolate(point, self.y);
            self.t = point;
            self.record()?;
            self.advance_output();
            moved = true;
        }
        if moved {
            self.integrator.interpolate(end, self.y);
        }
        Ok(())
    }

    /// Shows the part of the step from `begin` to `end` to a system that remembers; y is y(`end`)
    /// before and afterwards.
    fn remember(&mut self, begin: f64, end: f64) -> Result<(), SimErrorKind> {
        if !self.problem.system.remembers() {
            return Ok(());
        }
        for point in 1..=POINTS_REMEMBERED {
            let share = f64::from(point) / f64::from(POINTS_REMEMBERED);
            let t = if point == POINTS_REMEMBERED { end } else { begin + share * (end - begin) };
            self.integrator.interpolate(t, self.y);
            self.remember_now(t)?;
        }
        Ok(())
    }

    fn remember_now(&mut self, t: f64) -> Result<(), SimErrorKind> {
        self.problem.system.remember(t, self.y).map_err(SimErrorKind::Evaluation)
    }

    /// Handles the event at `t`, where y is; records both sides of it. An event that a change of
    /// sign announced, but that the variables do not confirm, comes from the error of the
    /// interpolation: the integrator restarts from the variables then.
    fn handle_event(&mut self, t: f64, by_sign_change: bool) -> Result<After, SimErrorKind> {
        self.t = t;
        self.watch_for_chattering()?;
        match self.record() {
            // Located past the zero of a root, where the branch before the event has no value.
            Err(SimErrorKind::Evaluation(Failure::Domain { .. })) if by_sign_change => {}
            recorded => recorded?,
        }
        if by_sign_change {
            self.look_before_event();
        }
        let was_constrained = self.problem.system.is_constrained();
        let (surfaces, contacts) = self.end_slide();
        let crossing = if by_sign_change { self.crossings.last() } else { None };
        let span = self.problem.settings.stop - self.problem.settings.start;
        self.problem.system.crossed(crossing, span);
        let mut outcome = self.event_with_contacts(&contacts)?;
        if by_sign_change {
            self.watch.note_jump(self.y);
        }
        if was_constrained && outcome != EventOutcome::Terminate {
            outcome = self.continue_after_event(surfaces, contacts)?;
        }
        while self.outputs.next_output.is_some_and(|point| point <= t) {
            self.advance_output();
        }
        match outcome {
            EventOutcome::Terminate => return Ok(After::Terminated),
            _ if was_constrained => {}
            EventOutcome::Continue { y_changed: true } | EventOutcome::Again => {
                if !self.keep_past()? {
                    self.restart()?;
                }
            }
            EventOutcome::Continue { y_changed: false } => {
                let confirmed = self.start_crossings()?;
                if confirmed || !by_sign_change {
                    self.problem.statistics.continued += 1;
                    return Ok(After::Resume);
                }
                self.restart_integrator()?;
            }
        }
        Ok(After::Restarted)
    }

    /// Lets the system handle an event and those that follow it at the same time.
    pub(crate) fn whole_event(&mut self, t: f64) -> Result<EventOutcome, SimErrorKind> {
        let mut outcome = self.event(t)?;
        while outcome == EventOutcome::Again {
            outcome = match self.event(t)? {
                EventOutcome::Continue { .. } => EventOutcome::Continue { y_changed: true },
                other => other,
            };
        }
        Ok(outcome)
    }

    /// Lets the system handle an event and records the values after it.
    fn event(&mut self, t: f64) -> Result<EventOutcome, SimErrorKind> {
        let outcome = self.problem.system.handle_event(t, self.y);
        let outcome = outcome.map_err(SimErrorKind::Evaluation)?;
        if !self.y.iter().all(|y| y.is_finite()) {
            return Err(SimErrorKind::NotFinite);
        }
        if self.problem.system.remembers() {
            self.remember_now(t)?;
        }
        self.check()?;
        self.record()?;
        Ok(outcome)
    }

    /// What is in the way where `kind` does not say it.
    fn offending(&mut self, kind: SimErrorKind) -> Option<Offending> {
        match kind {
            SimErrorKind::StepSize | SimErrorKind::Singular | SimErrorKind::NotFinite => {
                self.fastest_unknown().map(|at| Offending::Unknown(at as u32))
            }
            SimErrorKind::Chattering | SimErrorKind::Accumulation => {
                self.crossings.last().map(|at| Offending::Crossing(at as u32))
            }
            _ => None,
        }
    }

    /// The unknown that is not finite, or else changes fastest.
    fn fastest_unknown(&mut self) -> Option<usize> {
        let n = self.problem.nominal.len();
        if let Some(at) = self.y.iter().position(|y| !y.is_finite()) {
            return Some(at).filter(|at| *at < n);
        }
        let mut derivatives = vec![0.0; n];
        self.problem.system.rhs(self.t, self.y, &mut derivatives).ok()?;
        if let Some(at) = derivatives.iter().position(|derivative| !derivative.is_finite()) {
            return Some(at);
        }
        let speed =
            |at: usize| derivatives[at].abs() / self.y[at].abs().max(self.problem.nominal[at]);
        (0..self.problem.system.n_differential()).max_by(|a, b| speed(*a).total_cmp(&speed(*b)))
    }

    /// Whether events follow each other without time to pass: near the end of what is allowed.
    pub(crate) fn has_rush_of_events(&self) -> bool {
        self.jumps.events_at_once > MOST_EVENTS_AT_ONCE / 2
    }

    fn watch_for_chattering(&mut self) -> Result<(), SimErrorKind> {
        let settings = self.problem.settings;
        let near = self.t - self.jumps.last_event <= AT_ONCE * (settings.stop - settings.start);
        self.jumps.events_at_once = if near { self.jumps.events_at_once + 1 } else { 0 };
        self.jumps.last_event = self.t;
        if self.jumps.events_at_once > MOST_EVENTS_AT_ONCE {
            return Err(SimErrorKind::Chattering);
        }
        Ok(())
    }

    fn check(&mut self) -> Result<(), SimErrorKind> {
        self.problem.system.check(self.t, self.y).map_err(SimErrorKind::Evaluation)
    }

    /// Checks the end of a step that began at `begin`. An assertion that has failed within the step
    /// fails at the time when it began to, and there are no rows after that.
    pub(crate) fn check_step(&mut self, begin: f64) -> Result<(), SimErrorKind> {
        let Err(mut failed) = self.check() else { return Ok(()) };
        let is_assertion = |kind: &SimErrorKind| {
            matches!(kind, SimErrorKind::Evaluation(Failure::Assertion { .. }))
        };
        let mut holds = begin;
        for _ in 0..ASSERTION_TRIALS {
            let middle = 0.5 * (holds + self.t);
            if !is_assertion(&failed) || middle <= holds || middle >= self.t {
                break;
            }
            self.integrator.interpolate(middle, self.y);
            match self.problem.system.check(middle, self.y).map_err(SimErrorKind::Evaluation) {
                Err(kind) if is_assertion(&kind) => (self.t, failed) = (middle, kind),
                _ => holds = middle,
            }
        }
        self.out.end_at(self.t);
        Err(failed)
    }

    /// The next output point.
    pub(crate) fn next_output(&self) -> Option<f64> {
        self.outputs.next_output
    }

    pub(crate) fn advance_output(&mut self) {
        let settings = self.problem.settings;
        self.outputs.output_number += 1;
        self.outputs.next_output =
            settings.output.point(settings.start, settings.stop, self.outputs.output_number);
    }

    pub fn record(&mut self) -> Result<(), SimErrorKind> {
        let observed = self.problem.system.observe(self.t, self.y, self.observed);
        observed.map_err(|failure: Failure| SimErrorKind::Evaluation(failure))?;
        self.out.push(self.t, self.observed);
        if let Some(reached) = &self.problem.settings.reached {
            reached.store(self.t.to_bits(), Ordering::Relaxed);
        }
        Ok(())
    }
}
