//! An instance: a system with what the modes of FMI ask of it.

use crate::codegen::bytes_of;
use crate::fmi::export::{Exported, Place, Setter, ValueKind};
use crate::known_derivatives::Derivatives;
use crate::loading::Loaded;
use crate::runtime::{Snapshot, System};
use crate::sim::{EventOutcome, Events, Failure, Residual, SimError, SimErrorKind, Simulator};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::ffi::{CStr, CString};
use std::sync::Arc;

/// Why a function failed.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Wrong {
    /// The status `Error`.
    Error(String),
    /// The status `Discard`: the values at hand have no result, others may.
    Discard(String),
}

impl From<String> for Wrong {
    fn from(message: String) -> Wrong {
        Wrong::Error(message)
    }
}

impl From<&str> for Wrong {
    fn from(message: &str) -> Wrong {
        Wrong::Error(message.to_owned())
    }
}

/// Where an instance is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) enum Phase {
    /// Before the initialization.
    Instantiated,
    /// During it: values follow from what is set so far.
    Initialization,
    /// At an event.
    Event,
    /// Between events, integrated by the importer.
    Continuous,
    /// Between steps of co-simulation.
    Step,
    /// After the end.
    Terminated,
}

/// Who integrates an instance, and who handles its events.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum InterfaceKind {
    /// The importer does both.
    ModelExchange,
    /// The instance does both, unless the importer asks for events.
    CoSimulation {
        /// Whether the importer handles those between steps.
        has_event_mode: bool,
        /// Whether steps may end early.
        returns_early: bool,
    },
}

impl InterfaceKind {
    /// Whether a step ends at an event, which the importer handles.
    pub(crate) fn ends_steps_at_events(self) -> bool {
        self == InterfaceKind::CoSimulation { has_event_mode: true, returns_early: true }
    }

    /// Where an instance is after its initialization.
    fn first_phase(self) -> Phase {
        match self {
            InterfaceKind::CoSimulation { has_event_mode: false, .. } => Phase::Step,
            _ => Phase::Event,
        }
    }
}

/// What an event update did.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Updated {
    pub(crate) needs_update: bool,
    pub(crate) terminates: bool,
    pub(crate) states_changed: bool,
    pub(crate) next_event: Option<f64>,
}

/// When a simulation begins and ends, and how accurate it is to be.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) struct Experiment {
    start: f64,
    pub(crate) stop: Option<f64>,
    pub(crate) tolerance: f64,
}

/// What belongs to the state of an instance, to be kept and restored.
#[derive(Clone)]
pub(crate) struct State {
    pub(crate) system: System,
    pub(crate) phase: Phase,
    pub(crate) experiment: Experiment,
    pub(crate) time: f64,
    /// The states, inputs that are states included.
    pub(crate) x: Vec<f64>,
    /// Values that were set before the initialization, by value reference.
    given: BTreeMap<u32, f64>,
    /// Whether the initial system has been solved with what is set.
    is_initialized: bool,
    /// Whether no event has been handled since.
    is_at_start: bool,
    /// Whether inputs were set since the last event.
    pub(crate) inputs_changed: bool,
    /// How long the next step of its own integrator is meant to be, s.
    pub(crate) next_step: Option<f64>,
    /// The time event that the last event update has announced.
    announced: Option<f64>,
    /// Observed variables.
    observed: Evaluated,
    /// Derivatives of all states.
    derivatives: Evaluated,
    indicators: Evaluated,
}

/// Values at the time and the states at hand: importers ask for one after the other.
#[derive(Clone)]
struct Evaluated {
    values: Vec<f64>,
    is_known: bool,
}

impl Evaluated {
    fn new(count: usize) -> Evaluated {
        Evaluated { values: vec![0.0; count], is_known: false }
    }

    /// The values, computed unless they are known.
    fn get<E>(&mut self, compute: impl FnOnce(&mut [f64]) -> Result<(), E>) -> Result<&[f64], E> {
        if !self.is_known {
            compute(&mut self.values)?;
            self.is_known = true;
        }
        Ok(&self.values)
    }
}

/// An instance.
pub(crate) struct Instance {
    pub(crate) model: Arc<Loaded>,
    pub(crate) kind: InterfaceKind,
    pub(crate) state: State,
    pub(crate) simulator: Simulator,
    pub(crate) derivatives: Derivatives,
    /// How many messages of the model have been passed on.
    passed_on: usize,
}

impl State {
    fn new(model: &Loaded) -> State {
        let mut system = model.program.system();
        system.solve_loops(true);
        system.listen();
        for (parameter, value) in &model.content.set {
            // It was checked when it was set.
            let _ = system.set_parameter(*parameter, *value);
        }
        for variable in &model.content.variables {
            if let Setter::Recorded { input, start } = variable.setter {
                system.set_recorded(input, start);
            }
        }
        State {
            x: vec![0.0; model.program.n_states()],
            observed: Evaluated::new(system.n_observed()),
            derivatives: Evaluated::new(model.program.n_states()),
            indicators: Evaluated::new(model.program.n_indicators()),
            system,
            phase: Phase::Instantiated,
            experiment: Experiment {
                start: model.program.experiment().start_time.unwrap_or(0.0),
                stop: None,
                tolerance: model.content.tolerance,
            },
            time: 0.0,
            given: BTreeMap::new(),
            is_initialized: false,
            is_at_start: false,
            inputs_changed: false,
            next_step: None,
            announced: None,
        }
    }

    /// Up to when what delays and pipes read is known; infinite without any.
    fn known_until(&self) -> f64 {
        self.time + self.system.longest_step()
    }
}

/// A state as bytes: what was set, and what the system has come to since.
#[derive(Serialize, Deserialize)]
struct Kept {
    token: String,
    phase: Phase,
    experiment: Experiment,
    time: f64,
    x: Vec<f64>,
    given: BTreeMap<u32, f64>,
    is_at_start: bool,
    inputs_changed: bool,
    next_step: Option<f64>,
    announced: Option<f64>,
    /// After the initialization.
    come_to: Option<Snapshot>,
}

impl Instance {
    /// A state as bytes.
    pub(crate) fn bytes_of(&self, state: &State) -> Result<Vec<u8>, Wrong> {
        if !self.model.program.has_snapshots() {
            return Err(
                "states of this model cannot become bytes: its continuous states change".into()
            );
        }
        let kept = Kept {
            token: self.model.content.token.clone(),
            phase: state.phase,
            experiment: state.experiment,
            time: state.time,
            x: state.x.clone(),
            given: state.given.clone(),
            is_at_start: state.is_at_start,
            inputs_changed: state.inputs_changed,
            next_step: state.next_step,
            announced: state.announced,
            come_to: state.is_initialized.then(|| state.system.snapshot()),
        };
        bytes_of(&kept).ok_or_else(|| "the state is too large".into())
    }

    /// The state in these bytes.
    pub(crate) fn state_in(&self, bytes: &[u8]) -> Result<State, Wrong> {
        let foreign = || Wrong::from("these bytes are no state of this unit");
        let kept: Kept = postcard::from_bytes(bytes).map_err(|_| foreign())?;
        let mut state = State::new(&self.model);
        if kept.token != self.model.content.token || kept.x.len() != state.x.len() {
            return Err(foreign());
        }
        for (reference, value) in &kept.given {
            let variable = self.model.content.variables.get(*reference as usize);
            match variable.ok_or_else(foreign)?.setter {
                Setter::Parameter(at) | Setter::Input { start: at, .. } => {
                    let set = state.system.set_parameter(at, *value);
                    set.map_err(|fault| Wrong::Error(fault.message))?;
                }
                Setter::Recorded { input, .. } => state.system.set_recorded(input, *value),
                Setter::None => return Err(foreign()),
            }
        }
        if let Some(snapshot) = kept.come_to {
            // Objects and workspaces are those of an initialization; then the numbers follow.
            let done = state.system.initialize(kept.experiment.start, &mut state.x);
            done.map_err(|failure| self.explained(SimErrorKind::Initialization(failure)))?;
            if !state.system.continue_from(snapshot) {
                return Err(foreign());
            }
            state.is_initialized = true;
        }
        let Kept { phase, experiment, time, x, given, .. } = kept;
        let Kept { is_at_start, inputs_changed, next_step, announced, .. } = kept;
        let state = State { phase, experiment, time, x, given, ..state };
        Ok(State { is_at_start, inputs_changed, next_step, announced, ..state })
    }

    pub(crate) fn new(model: Arc<Loaded>, kind: InterfaceKind) -> Instance {
        let state = State::new(&model);
        let simulator = Simulator::new();
        let derivatives = Derivatives::default();
        Instance { model, kind, state, simulator, derivatives, passed_on: 0 }
    }

    pub(crate) fn reset(&mut self) {
        self.state = State::new(&self.model);
        self.derivatives.forget();
        self.passed_on = 0;
    }

    /// When it begins and ends, and how accurate it is to be.
    pub(crate) fn set_experiment(
        &mut self,
        tolerance: Option<f64>,
        start: f64,
        stop: Option<f64>,
    ) -> Result<(), Wrong> {
        self.expect(&[Phase::Instantiated], "the experiment can be set before the initialization")?;
        if !start.is_finite() || stop.is_some_and(|stop| !stop.is_finite() || stop < start) {
            return Err("the start and stop time are no interval".into());
        }
        let experiment = &mut self.state.experiment;
        (experiment.start, experiment.stop) = (start, stop);
        if let Some(tolerance) = tolerance.filter(|tolerance| *tolerance > 0.0) {
            experiment.tolerance = tolerance.clamp(1e-14, 1.0);
        }
        Ok(())
    }

    pub(crate) fn expect(&self, phases: &[Phase], rule: &str) -> Result<(), Wrong> {
        match phases.contains(&self.state.phase) {
            true => Ok(()),
            false => Err(Wrong::Error(format!("called in the wrong state: {rule}"))),
        }
    }

    pub(crate) fn enter_initialization(&mut self) -> Result<(), Wrong> {
        self.expect(&[Phase::Instantiated], "the initialization begins after the instantiation")?;
        self.state.phase = Phase::Initialization;
        self.state.time = self.state.experiment.start;
        Ok(())
    }

    pub(crate) fn exit_initialization(&mut self) -> Result<(), Wrong> {
        self.expect(&[Phase::Initialization], "the initialization has not begun")?;
        self.initialize()?;
        self.state.phase = self.kind.first_phase();
        self.state.inputs_changed = false;
        Ok(())
    }

    /// Solves the initial system with what is set, unless that was done.
    fn initialize(&mut self) -> Result<(), Wrong> {
        if self.state.is_initialized {
            return Ok(());
        }
        let state = &mut self.state;
        let done = state.system.initialize(state.experiment.start, &mut state.x);
        done.map_err(|failure| self.explained(SimErrorKind::Initialization(failure)))?;
        if self.state.known_until() <= self.state.time {
            return Err("a `delay` by 0 s has no past: the unit cannot be simulated".into());
        }
        self.state.is_initialized = true;
        self.state.is_at_start = true;
        self.passed_on = 0;
        self.forget_values();
        Ok(())
    }

    pub(crate) fn forget_values(&mut self) {
        let State { observed, derivatives, indicators, .. } = &mut self.state;
        for evaluated in [observed, derivatives, indicators] {
            evaluated.is_known = false;
        }
        self.derivatives.forget();
    }

    /// Parameters that were set, by their positions.
    pub(crate) fn parameters_given(&self) -> impl Iterator<Item = usize> {
        let variables = &self.model.content.variables;
        let given = self.state.given.keys().filter_map(|own| variables.get(*own as usize));
        given.filter_map(|variable| match variable.setter {
            Setter::Parameter(at) => Some(at),
            _ => None,
        })
    }

    /// A failure in the model's words.
    pub(crate) fn explained(&self, kind: SimErrorKind) -> Wrong {
        let error = SimError { time: self.state.time, kind, offending: None };
        Wrong::Error(self.state.system.explain(&error).message.clone())
    }

    fn discarded(&self, failure: Failure) -> Wrong {
        match self.explained(SimErrorKind::Evaluation(failure)) {
            Wrong::Error(message) if self.state.phase == Phase::Continuous => {
                Wrong::Discard(message)
            }
            other => other,
        }
    }

    /// Messages of the model that were not passed on yet: whether each is a warning, and its text.
    pub(crate) fn new_messages(&mut self) -> Vec<(bool, String)> {
        let (messages, _) = self.state.system.log_messages();
        if messages.len() == self.passed_on {
            return Vec::new();
        }
        let fresh = messages.iter().skip(self.passed_on);
        let fresh = fresh.map(|message| {
            (message.warning.is_some(), format!("t = {}: {}", message.time, message.text))
        });
        let fresh: Vec<_> = fresh.collect();
        self.passed_on = messages.len();
        fresh
    }

    fn variable(&self, reference: u32, kinds: &[ValueKind]) -> Result<&Exported, Wrong> {
        let found = self.model.content.variables.get(reference as usize);
        let found = found.filter(|variable| kinds.contains(&variable.kind));
        found.ok_or_else(|| {
            Wrong::Error(format!(
                "there is no variable of this type with value reference {reference}"
            ))
        })
    }

    /// The value of a String.
    pub(crate) fn string(&self, reference: u32) -> Result<&CStr, Wrong> {
        let text = match self.variable(reference, &[ValueKind::String])?.place {
            Place::Text(at) => self.model.strings.get(at),
            _ => None,
        };
        text.map(CString::as_c_str).ok_or_else(|| "the String has no value".into())
    }

    /// The value of a variable.
    pub(crate) fn value(&mut self, reference: u32, kinds: &[ValueKind]) -> Result<f64, Wrong> {
        let variable = self.variable(reference, kinds)?;
        let place = variable.place;
        match self.state.phase {
            Phase::Instantiated => return self.start_value(reference, variable),
            Phase::Initialization => self.initialize()?,
            _ => {}
        }
        let at_place = match place {
            Place::Time => return Ok(self.state.time),
            Place::State(state) => return Ok(self.state.x[state]),
            Place::Derivative(state) => return Ok(self.all_derivatives()?[state]),
            Place::Indicator(at) => {
                let all = self.all_indicators()?;
                return all.get(at).copied().ok_or_else(|| "there is no such indicator".into());
            }
            Place::Text(_) => return Err("a String is not a number".into()),
            Place::Variable(at) => at,
        };
        use crate::codegen::Access;
        let variable = &self.model.program.variables()[at_place];
        match variable.access {
            Access::Time => Ok(self.state.time),
            Access::Constant(value) => Ok(value),
            Access::Parameter => self.state.system.value(at_place).ok_or_else(|| {
                Wrong::Error(format!("the parameter `{}` has no value", variable.name))
            }),
            Access::Observed { column, negated } => {
                let value = self.observed()?[column];
                Ok(if negated { -value } else { value })
            }
        }
    }

    /// Before the initialization start values are known alone.
    fn start_value(&self, reference: u32, variable: &Exported) -> Result<f64, Wrong> {
        if let Some(value) = self.state.given.get(&reference) {
            return Ok(*value);
        }
        let parameters = self.model.program.parameters();
        let set = |at: usize| {
            let mut set = self.model.content.set.iter();
            let found = set.find(|(parameter, _)| *parameter == at);
            found.map_or(parameters[at].default, |(_, value)| *value)
        };
        match variable.setter {
            Setter::Parameter(at) | Setter::Input { start: at, .. } => Ok(set(at)),
            Setter::Recorded { start, .. } => Ok(start),
            Setter::None => match variable.place {
                Place::Time => Ok(self.state.experiment.start),
                Place::Variable(at) if self.state.system.value(at).is_some() => {
                    Ok(self.state.system.value(at).unwrap_or(f64::NAN))
                }
                _ => Err(Wrong::Error(format!(
                    "`{}` has no value before the initialization",
                    variable.name
                ))),
            },
        }
    }

    /// The observed variables. Those of inputs that were set after a step of co-simulation are those after the
    /// event at which the next step begins.
    fn observed(&mut self) -> Result<&[f64], Wrong> {
        let has_own_events =
            matches!(self.kind, InterfaceKind::CoSimulation { has_event_mode: false, .. });
        let State { phase, inputs_changed, observed, .. } = &self.state;
        if *phase != Phase::Step || !has_own_events || !inputs_changed || observed.is_known {
            return self.observe();
        }
        let kept = self.state.clone();
        let mut handled = Ok(EventOutcome::Again);
        while handled == Ok(EventOutcome::Again) {
            handled = self.handle_event();
        }
        let done = handled.and_then(|_| self.observe().map(|_| ()));
        let observed = std::mem::replace(&mut self.state, kept).observed;
        done?;
        self.state.observed = observed;
        Ok(&self.state.observed.values)
    }

    /// The observed variables in the mode at hand.
    fn observe(&mut self) -> Result<&[f64], Wrong> {
        self.expect_past()?;
        let State { system, time, x, observed, .. } = &mut self.state;
        let done = observed.get(|out| system.observe(*time, x, out)).err();
        match done {
            Some(failure) => Err(self.discarded(failure)),
            None => Ok(&self.state.observed.values),
        }
    }

    /// Sets a variable.
    pub(crate) fn set(
        &mut self,
        reference: u32,
        value: f64,
        kinds: &[ValueKind],
    ) -> Result<(), Wrong> {
        let variable = self.variable(reference, kinds)?;
        let refused = |why: &str| Err(Wrong::Error(format!("`{}` {why}", variable.name)));
        if !value.is_finite() {
            return refused(&format!("cannot become {value}"));
        }
        let is_before = matches!(self.state.phase, Phase::Instantiated | Phase::Initialization);
        let setter = variable.setter;
        match setter {
            Setter::None => return refused("cannot be set"),
            Setter::Parameter(_) if !is_before => {
                return refused("can be set before the end of the initialization only");
            }
            _ => {}
        }
        let state = &mut self.state;
        match setter {
            Setter::Input { state: at, is_negated, .. } if !is_before => {
                let value = if is_negated { -value } else { value };
                if state.x[at] == value {
                    return Ok(());
                }
                state.x[at] = value;
                state.inputs_changed = true;
            }
            Setter::Parameter(at) | Setter::Input { start: at, .. } => {
                let set = state.system.set_parameter(at, value);
                set.map_err(|fault| Wrong::Error(fault.message))?;
                state.given.insert(reference, value);
                state.is_initialized = false;
            }
            Setter::Recorded { input, .. } => {
                state.system.set_recorded(input, value);
                state.given.insert(reference, value);
                state.is_initialized &= !is_before;
                state.inputs_changed = true;
            }
            Setter::None => {}
        }
        self.forget_values();
        Ok(())
    }

    pub(crate) fn set_time(&mut self, time: f64) -> Result<(), Wrong> {
        if !time.is_finite() {
            return Err("the time is not finite".into());
        }
        if self.state.time != time {
            self.state.time = time;
            self.forget_values();
        }
        Ok(())
    }

    /// The continuous states.
    pub(crate) fn states(&mut self, out: &mut [f64]) -> Result<(), Wrong> {
        if self.state.phase == Phase::Initialization {
            self.initialize()?;
        }
        self.check_number(out.len())?;
        for (out, state) in out.iter_mut().zip(&self.model.content.states) {
            *out = self.state.x[*state];
        }
        Ok(())
    }

    pub(crate) fn set_states(&mut self, x: &[f64]) -> Result<(), Wrong> {
        self.check_number(x.len())?;
        let State { x: before, .. } = &mut self.state;
        let mut has_changed = false;
        for (value, state) in x.iter().zip(&self.model.content.states) {
            has_changed |= before[*state] != *value;
            before[*state] = *value;
        }
        if has_changed {
            self.forget_values();
        }
        Ok(())
    }

    fn check_number(&self, n: usize) -> Result<(), Wrong> {
        let expected = self.model.content.states.len();
        match n == expected {
            true => Ok(()),
            false => Err(Wrong::Error(format!("there are {expected} continuous states, not {n}"))),
        }
    }

    fn all_derivatives(&mut self) -> Result<&[f64], Wrong> {
        if self.state.phase == Phase::Initialization {
            self.initialize()?;
        }
        self.expect_past()?;
        let State { system, time, x, derivatives, .. } = &mut self.state;
        if let Some(failure) = derivatives.get(|out| system.rhs(*time, x, out)).err() {
            return Err(self.discarded(failure));
        }
        match self.state.derivatives.values.iter().all(|value| value.is_finite()) {
            true => Ok(&self.state.derivatives.values),
            false => Err(self.not_finite()),
        }
    }

    /// Refuses the end of a step over which a delayed value is not known yet.
    fn expect_past(&self) -> Result<(), Wrong> {
        let State { system, time, phase, .. } = &self.state;
        if *phase != Phase::Continuous || system.knows_past(*time) {
            return Ok(());
        }
        Err(Wrong::Discard(format!(
            "the step to {time} s is longer than a `delay` of the model: it leads past an announced event"
        )))
    }

    /// Shows the values at hand, which belong to the solution, to a model that needs its past.
    fn remember(&mut self) -> Result<(), Wrong> {
        let State { system, time, x, .. } = &mut self.state;
        if !system.remembers() {
            return Ok(());
        }
        let done = system.remember(*time, x);
        done.map_err(|failure| self.explained(SimErrorKind::Evaluation(failure)))
    }

    fn not_finite(&self) -> Wrong {
        match self.explained(SimErrorKind::NotFinite) {
            Wrong::Error(message) => Wrong::Discard(message),
            other => other,
        }
    }

    /// The derivatives of the continuous states.
    pub(crate) fn derivatives(&mut self, out: &mut [f64]) -> Result<(), Wrong> {
        self.check_number(out.len())?;
        self.all_derivatives()?;
        let all = &self.state.derivatives.values;
        for (out, state) in out.iter_mut().zip(&self.model.content.states) {
            *out = all[*state];
        }
        Ok(())
    }

    pub(crate) fn nominals(&self, out: &mut [f64]) -> Result<(), Wrong> {
        self.check_number(out.len())?;
        let mut all = vec![1.0; self.state.x.len()];
        self.state.system.nominal(&mut all);
        for (out, state) in out.iter_mut().zip(&self.model.content.states) {
            *out = if all[*state] > 0.0 { all[*state] } else { 1.0 };
        }
        Ok(())
    }

    pub(crate) fn event_indicators(&mut self, out: &mut [f64]) -> Result<(), Wrong> {
        let all = self.all_indicators()?;
        let (expected, n) = (all.len(), out.len());
        if n != expected {
            return Err(Wrong::Error(format!("there are {expected} event indicators, not {n}")));
        }
        out.copy_from_slice(all);
        Ok(())
    }

    fn all_indicators(&mut self) -> Result<&[f64], Wrong> {
        if self.state.phase == Phase::Initialization {
            self.initialize()?;
        }
        self.expect_past()?;
        let State { system, time, x, indicators, .. } = &mut self.state;
        match indicators.get(|out| system.event_indicators(*time, x, out)).err() {
            Some(failure) => Err(self.discarded(failure)),
            None => Ok(&self.state.indicators.values),
        }
    }

    pub(crate) fn enter_event_mode(&mut self) -> Result<(), Wrong> {
        self.expect_events()?;
        let phases = [Phase::Continuous, Phase::Step, Phase::Event];
        self.expect(&phases, "events follow the initialization")?;
        if self.state.phase == Phase::Continuous {
            self.remember()?;
        }
        self.state.phase = Phase::Event;
        Ok(())
    }

    /// Ends an event of co-simulation.
    pub(crate) fn enter_step_mode(&mut self) -> Result<(), Wrong> {
        self.expect_events()?;
        self.expect(&[Phase::Event, Phase::Step], "an event comes first")?;
        self.state.phase = Phase::Step;
        self.state.next_step = None;
        Ok(())
    }

    fn expect_events(&self) -> Result<(), Wrong> {
        match self.kind {
            InterfaceKind::CoSimulation { has_event_mode: false, .. } => {
                Err("events are handled within steps: the instance was made without event mode"
                    .into())
            }
            _ => Ok(()),
        }
    }

    pub(crate) fn enter_continuous_mode(&mut self) -> Result<(), Wrong> {
        if self.kind != InterfaceKind::ModelExchange {
            return Err("it integrates itself: it was made for co-simulation".into());
        }
        self.expect(&[Phase::Event, Phase::Continuous], "an event comes first")?;
        self.state.phase = Phase::Continuous;
        Ok(())
    }

    /// Handles the event at the time and the states as they are.
    pub(crate) fn update(&mut self) -> Result<Updated, Wrong> {
        self.expect(&[Phase::Event], "discrete states are updated at events")?;
        let was_at_start = std::mem::take(&mut self.state.is_at_start);
        let before = self.state.x.clone();
        let nothing_to_do =
            was_at_start && !self.state.inputs_changed && !self.state.system.has_event_at_start();
        let outcome = match nothing_to_do {
            true => EventOutcome::Continue { y_changed: false },
            false => self.handle_event()?,
        };
        // A step must not lead past what delays have recorded at its begin.
        let known = Some(self.state.known_until()).filter(|time| time.is_finite());
        let next = self.state.system.next_time_event(self.state.time);
        self.state.announced = next.into_iter().chain(known).min_by(f64::total_cmp);
        Ok(Updated {
            needs_update: outcome == EventOutcome::Again,
            terminates: outcome == EventOutcome::Terminate,
            states_changed: before != self.state.x,
            next_event: self.state.announced,
        })
    }

    pub(crate) fn handle_event(&mut self) -> Result<EventOutcome, Wrong> {
        // Loops are solved at the values before the event first, from where those after it are found;
        // a branch that is left may have no value.
        let _ = self.observe();
        let state = &mut self.state;
        state.system.crossed(None, f64::INFINITY);
        let outcome = state.system.handle_event(state.time, &mut state.x);
        let outcome = outcome.map_err(|f| self.explained(SimErrorKind::Evaluation(f)))?;
        self.state.inputs_changed = false;
        self.forget_values();
        self.remember()?;
        Ok(outcome)
    }

    /// Checks at the end of a step what must hold there; whether an event is to announce another time
    /// event, because the content of a pipe has become faster.
    pub(crate) fn complete_step(&mut self) -> Result<bool, Wrong> {
        self.expect(&[Phase::Continuous], "steps are made between events")?;
        let state = &mut self.state;
        let done = state.system.check(state.time, &state.x);
        done.map_err(|failure| self.explained(SimErrorKind::Evaluation(failure)))?;
        self.remember()?;
        let State { system, time, announced, .. } = &self.state;
        Ok(time + 2.0 * system.longest_step() < announced.unwrap_or(f64::INFINITY))
    }

    pub(crate) fn terminate(&mut self) -> Result<(), Wrong> {
        if matches!(self.state.phase, Phase::Event | Phase::Continuous | Phase::Step) {
            let state = &mut self.state;
            let done = state.system.finish(state.time, &mut state.x);
            done.map_err(|failure| self.explained(SimErrorKind::Evaluation(failure)))?;
            self.forget_values();
        }
        self.state.phase = Phase::Terminated;
        Ok(())
    }
}
