//! Model exchange: a unit as a system that the integrators solve (FMI 2.0.5 §3, FMI 3.0.2 §3).
//!
//! Events of the unit are changes of sign of its indicators, times that it has announced, and what
//! it asks for at the end of a step; the pieces of inputs begin at events as well.

use super::binary::Component;
use super::calls::CallError;
use super::directions::{Direction, Directions};
use super::inputs::Inputs;
use super::values::Readings;
use crate::Description;
use crate::sim::{
    EventOutcome, Events, Failure, Modes, Pattern, Residual, Sensitive, Settings, same_time,
};

/// Increments of states for derivatives by differences, relative to their magnitude: the root of
/// the precision of numbers.
const INCREMENT: f64 = 1.5e-8;

/// How a failed call looks to the integrators; [`ExchangeSystem::failure`] says what it was.
const FAILED: Failure = Failure::Function { function: 0, at: 0, reason: 0 };

/// What the description says of the states.
pub(super) struct States {
    pattern: Pattern,
    nominal: Vec<f64>,
    /// Value references of the states and of their derivatives, where the unit has directional
    /// derivatives and all states are scalars.
    directional: Option<[Vec<u32>; 2]>,
}

/// A unit with its inputs and readings.
pub(super) struct ExchangeSystem<'a> {
    component: &'a Component,
    inputs: Inputs<'a>,
    readings: Readings,
    states: States,
    indicators: usize,
    /// Whether the unit must be notified of completed steps.
    needs_completed_step: bool,
    settings: &'a Settings,
    /// What derivatives are carried along, and the values of what varies.
    directions: Option<(Directions, &'a [f64])>,
    /// Why derivatives cannot be carried on.
    refusal: Option<&'static str>,
    next_event: Option<f64>,
    /// The end of the step after which the unit has asked for an event.
    asked_at: Option<f64>,
    terminates: bool,
    /// The last time at which a step or an event was completed.
    completed: f64,
    failure: Option<CallError>,
    point: Point,
    /// Derivatives beside the point for which a Jacobian is computed.
    moved: Vec<f64>,
}

/// The point at which the unit is, and what it has computed there: integrators come back to a point, for the
/// functions at its end, for a Jacobian, for an event.
#[derive(Default)]
struct Point {
    /// NaN where the unit is not known to be anywhere, as after an event.
    t: f64,
    y: Vec<f64>,
    derivatives: Known,
    indicators: Known,
}

/// Values that are known or not.
#[derive(Default)]
struct Known {
    values: Vec<f64>,
    is_known: bool,
}

impl Point {
    fn new(n: usize, indicators: usize) -> Point {
        let unknown = |n: usize| Known { values: vec![0.0; n], is_known: false };
        Point {
            t: f64::NAN,
            y: vec![f64::NAN; n],
            derivatives: unknown(n),
            indicators: unknown(indicators),
        }
    }

    /// The unit is at another one.
    fn moves(&mut self) {
        (self.derivatives.is_known, self.indicators.is_known) = (false, false);
    }

    /// It is not known where the unit is.
    fn forget(&mut self) {
        self.moves();
        self.t = f64::NAN;
        self.y.fill(f64::NAN);
    }
}

impl Known {
    /// The values, computed unless they are known.
    fn get(
        &mut self,
        compute: impl FnOnce(&mut [f64]) -> Result<(), CallError>,
    ) -> Result<&[f64], CallError> {
        if !self.is_known {
            compute(&mut self.values)?;
            self.is_known = true;
        }
        Ok(&self.values)
    }
}

impl States {
    /// What is known of `n` states.
    pub(crate) fn of(description: &Description, n: usize) -> States {
        let structure = &description.structure.derivatives;
        let variables = &description.variables;
        let state = |at: usize| variables[structure[at].variable].derivative_of;
        let states: Option<Vec<usize>> = (0..structure.len()).map(state).collect();
        let scalars = states.filter(|states| states.len() == n);
        let nominal = |state: &usize| {
            description.attributes_of(&variables[*state]).nominal.map_or(1.0, f64::abs)
        };
        let Some(states) = scalars else {
            return States { pattern: Pattern::full(n), nominal: vec![1.0; n], directional: None };
        };
        let provides = description
            .model_exchange
            .as_ref()
            .is_some_and(|interface| interface.provides_directional_derivatives);
        let reference = |at: usize| variables[at].reference;
        let directional = provides.then(|| {
            let derivatives = structure.iter().map(|own| reference(own.variable)).collect();
            [states.iter().map(|state| reference(*state)).collect(), derivatives]
        });
        States {
            pattern: pattern(description, &states),
            nominal: states.iter().map(nominal).collect(),
            directional,
        }
    }
}

/// Which derivatives depend on which states, each on its own one as the integrators expect; all on all
/// where a derivative does not say.
fn pattern(description: &Description, states: &[usize]) -> Pattern {
    let n = states.len();
    let mut depends = vec![vec![false; n]; n];
    for (row, unknown) in description.structure.derivatives.iter().enumerate() {
        let Some(dependencies) = &unknown.dependencies else { return Pattern::full(n) };
        depends[row][row] = true;
        for (place, _) in dependencies {
            if let Some(column) = states.iter().position(|state| state == place) {
                depends[column][row] = true;
            }
        }
    }
    let mut pattern = Pattern { n, column_starts: vec![0], rows: Vec::new() };
    for column in depends {
        pattern.rows.extend((0..n).filter(|row| column[*row]));
        pattern.column_starts.push(pattern.rows.len());
    }
    pattern
}

impl<'a> ExchangeSystem<'a> {
    /// A system of an instance that has got its values.
    pub(crate) fn new(
        component: &'a Component,
        description: &Description,
        (inputs, readings): (Inputs<'a>, Readings),
        (settings, directions): (&'a Settings, Option<(Directions, &'a [f64])>),
    ) -> Result<ExchangeSystem<'a>, CallError> {
        let of_description =
            [description.structure.derivatives.len(), description.event_indicators];
        let [n, indicators] = component.sizes()?.unwrap_or(of_description);
        let interface = description.model_exchange.as_ref();
        Ok(ExchangeSystem {
            component,
            inputs,
            readings,
            states: States::of(description, n),
            indicators,
            needs_completed_step: interface.is_some_and(|own| own.needs_completed_step),
            settings,
            directions,
            refusal: None,
            next_event: None,
            asked_at: None,
            terminates: false,
            completed: f64::NEG_INFINITY,
            failure: None,
            point: Point::new(n, indicators),
            moved: vec![0.0; n],
        })
    }

    /// The call that failed last.
    pub(crate) fn failure(&self) -> Option<CallError> {
        self.failure
    }

    /// Why derivatives could not be carried on, if it was for these.
    pub(crate) fn refusal(&self) -> Option<&'static str> {
        self.refusal
    }

    /// The derivatives of the states, in the point.
    fn derivatives(&mut self, t: f64, y: &[f64]) -> Result<(), Failure> {
        self.set(t, y)?;
        let component = self.component;
        let computed = self.point.derivatives.get(|out| component.derivatives(out)).map(|_| ());
        self.done(computed)
    }

    /// Notes a failed call. After an error the instance must not be used any more.
    fn done<T>(&mut self, result: Result<T, CallError>) -> Result<T, Failure> {
        result.map_err(|error| {
            self.failure = Some(error);
            FAILED
        })
    }

    fn is_broken(&self) -> bool {
        self.failure.is_some_and(|error| error.is_final())
    }

    fn set(&mut self, t: f64, y: &[f64]) -> Result<(), Failure> {
        if self.is_broken() {
            return Err(FAILED);
        }
        let y = &y[..self.n_differential()];
        let set = self.set_changed(t, y);
        if set.is_err() {
            self.point.forget();
        }
        self.done(set)
    }

    /// Sets what is not what it was.
    fn set_changed(&mut self, t: f64, y: &[f64]) -> Result<(), CallError> {
        let Point { t: before, y: states, .. } = &self.point;
        let (is_other_time, is_other_state) = (*before != t, states != y);
        if !is_other_time && !is_other_state {
            return Ok(());
        }
        self.point.moves();
        if is_other_time {
            self.component.set_time(t)?;
            self.point.t = t;
        }
        if is_other_state {
            self.component.set_states(y)?;
            self.point.y.copy_from_slice(y);
        }
        if is_other_time {
            self.inputs.set(self.component, t, false)?;
        }
        Ok(())
    }

    /// The event iteration at an event or after the initialization.
    fn update(&mut self, y: &mut [f64]) -> Result<(), CallError> {
        self.point.forget();
        let update = self.component.update_discrete_states()?;
        self.next_event = update.next_event;
        self.terminates |= update.terminates;
        self.component.enter_continuous_mode()?;
        let n = self.states.nominal.len();
        self.component.states(&mut y[..n])
    }

    fn begin_simulation(&mut self, t: f64, y: &mut [f64]) -> Result<(), CallError> {
        let span = (self.settings.start, self.settings.stop);
        self.component.enter_initialization(Some(self.settings.tolerance), span)?;
        self.inputs.seek(t);
        self.inputs.set(self.component, t, true)?;
        let n = self.n_differential();
        let (y, sensitivities) = y.split_at_mut(n);
        self.begin_sensitivities(sensitivities)?;
        self.component.exit_initialization()?;
        self.update(y)?;
        self.completed = t;
        Ok(())
    }

    /// Derivatives of the initial values by what varies, one column after the other.
    fn begin_sensitivities(&mut self, out: &mut [f64]) -> Result<(), CallError> {
        out.fill(0.0);
        let Some((own, _)) = &self.directions else { return Ok(()) };
        let n = own.states.len();
        let mut found = vec![0.0; own.calculated.len()];
        for (at, direction) in own.varied.iter().enumerate() {
            if let Direction::Start(state) = direction {
                out[n * at + state] = 1.0;
            }
            if found.is_empty() {
                continue;
            }
            let (unknowns, known) = own.at_start(at);
            let computed =
                self.component.directional_derivative([&unknowns, &[known]], &[1.0], &mut found);
            if computed.is_err() {
                self.refusal = Some("the FMU calculates initial values, without derivatives");
            }
            computed?;
            for (state, value) in own.calculated.iter().zip(&found) {
                out[n * at + state] = *value;
            }
        }
        Ok(())
    }

    fn event(&mut self, t: f64, y: &mut [f64]) -> Result<(), CallError> {
        self.component.enter_event_mode()?;
        self.inputs.seek(t);
        self.inputs.set(self.component, t, true)?;
        self.update(y)?;
        self.completed = t;
        Ok(())
    }

    /// A column of the Jacobian by a difference from the derivatives at y.
    fn difference(
        &mut self,
        column: usize,
        (t, y): (f64, &mut [f64]),
        base: &[f64],
    ) -> Result<(), Failure> {
        let before = y[column];
        let magnitude = before.abs().max(self.states.nominal[column]);
        let moved = before + INCREMENT * magnitude;
        y[column] = moved;
        self.derivatives(t, y)?;
        self.moved.copy_from_slice(&self.point.derivatives.values);
        let step = moved - before;
        self.moved.iter_mut().zip(base).for_each(|(own, base)| *own = (*own - base) / step);
        y[column] = before;
        Ok(())
    }
}

impl Residual for ExchangeSystem<'_> {
    fn n_differential(&self) -> usize {
        self.states.nominal.len()
    }

    fn n_algebraic(&self) -> usize {
        0
    }

    fn nominal(&self, out: &mut [f64]) {
        out.copy_from_slice(&self.states.nominal);
    }

    fn rhs(&mut self, t: f64, y: &[f64], out: &mut [f64]) -> Result<(), Failure> {
        self.derivatives(t, y)?;
        let known = &self.point.derivatives.values;
        out[..known.len()].copy_from_slice(known);
        Ok(())
    }

    fn pattern(&self) -> &Pattern {
        &self.states.pattern
    }

    fn jacobian(&mut self, t: f64, y: &[f64], values: &mut [f64]) -> Result<(), Failure> {
        self.set(t, y)?;
        let n = self.n_differential();
        if let Some([states, derivatives]) = &self.states.directional {
            let pattern = &self.states.pattern;
            for column in 0..n {
                let entries = pattern.column(column);
                let rows = &pattern.rows[entries.clone()];
                if rows.is_empty() {
                    continue;
                }
                let unknowns: Vec<u32> = rows.iter().map(|row| derivatives[*row]).collect();
                let along = [unknowns.as_slice(), &states[column..=column]];
                let out = &mut values[entries];
                let computed = self.component.directional_derivative(along, &[1.0], out);
                if let Err(error) = computed {
                    self.failure = Some(error);
                    return Err(FAILED);
                }
            }
            return Ok(());
        }
        self.derivatives(t, y)?;
        let base = self.point.derivatives.values.clone();
        let mut moved = y.to_vec();
        for column in 0..n {
            self.difference(column, (t, &mut moved), &base)?;
            let pattern = &self.states.pattern;
            for entry in pattern.column(column) {
                values[entry] = self.moved[pattern.rows[entry]];
            }
        }
        Ok(())
    }

    fn initialize(&mut self, t: f64, y: &mut [f64]) -> Result<(), Failure> {
        let begun = self.begin_simulation(t, y);
        self.done(begun)
    }

    fn check(&mut self, t: f64, y: &[f64]) -> Result<(), Failure> {
        if !self.needs_completed_step || t <= self.completed {
            return Ok(());
        }
        self.set(t, y)?;
        self.completed = t;
        let completed = self.component.completed_step();
        // A unit may keep what it needs of the past.
        self.point.moves();
        let [asks, terminates] = self.done(completed)?;
        self.terminates |= terminates;
        if asks || terminates {
            self.asked_at = Some(t);
        }
        Ok(())
    }

    fn n_observed(&self) -> usize {
        self.readings.count() * (1 + self.n_directions())
    }

    fn observe(&mut self, t: f64, y: &[f64], out: &mut [f64]) -> Result<(), Failure> {
        self.set(t, y)?;
        let (values, derivatives) = out.split_at_mut(self.readings.count());
        let read = self.readings.read(self.component, values);
        self.done(read)?;
        self.along_directions(y, derivatives, |own| &own.observed)
    }
}

impl Sensitive for ExchangeSystem<'_> {
    fn n_directions(&self) -> usize {
        self.varied().len()
    }

    fn directions(&self, out: &mut [f64]) {
        let Some((_, values)) = &self.directions else { return };
        for (out, value) in out.iter_mut().zip(*values) {
            *out = if value.abs() > 0.0 { value.abs() } else { 1.0 };
        }
    }

    fn sensitivity_rhs(&mut self, t: f64, y: &[f64], out: &mut [f64]) -> Result<(), Failure> {
        self.set(t, y)?;
        self.along_directions(y, out, |own| &own.derivatives)
    }
}

impl ExchangeSystem<'_> {
    fn varied(&self) -> &[Direction] {
        self.directions.as_ref().map_or(&[][..], |(own, _)| &own.varied)
    }

    /// Writes the derivatives of unknowns along all directions, those of the states following y.
    fn along_directions(
        &mut self,
        y: &[f64],
        out: &mut [f64],
        unknowns: fn(&Directions) -> &[u32],
    ) -> Result<(), Failure> {
        let n = self.n_differential();
        let Some((own, _)) = &self.directions else { return Ok(()) };
        let unknowns = unknowns(own);
        let mut done = Ok(());
        for (at, out) in out.chunks_exact_mut(unknowns.len().max(1)).enumerate() {
            let (knowns, seed) = own.seed(at, &y[n * (1 + at)..n * (2 + at)]);
            done = done.and_then(|()| {
                self.component.directional_derivative([unknowns, &knowns], &seed, out)
            });
        }
        self.done(done)
    }
}

impl Events for ExchangeSystem<'_> {
    /// The indicators of the unit, and a number that becomes negative where it has asked for an event.
    fn n_crossings(&self) -> usize {
        self.indicators + usize::from(self.needs_completed_step)
    }

    fn crossings(&mut self, t: f64, y: &[f64], out: &mut [f64]) -> Result<(), Failure> {
        if self.indicators > 0 {
            self.set(t, y)?;
            let component = self.component;
            let indicators = &mut self.point.indicators;
            let computed = indicators.get(|own| component.indicators(own));
            let computed = computed.map(|own| out[..own.len()].copy_from_slice(own));
            self.done(computed)?;
        }
        if let Some(asked) = out.get_mut(self.indicators) {
            let is_due = self.asked_at.is_some_and(|asked_at| t > asked_at);
            *asked = if is_due { -1.0 } else { 1.0 };
        }
        Ok(())
    }

    fn next_time_event(&self, t: f64) -> Option<f64> {
        let own = self.next_event.filter(|event| *event > t);
        own.into_iter().chain(self.inputs.next_event(t)).reduce(f64::min)
    }

    fn has_event_at_start(&self) -> bool {
        self.terminates
    }

    fn handle_event(&mut self, t: f64, y: &mut [f64]) -> Result<EventOutcome, Failure> {
        self.set(t, y)?;
        self.asked_at = None;
        let is_own = self.next_event.is_some_and(|event| event <= t || same_time(event, t));
        let before = y.to_vec();
        let handled = self.event(t, y);
        self.done(handled)?;
        if self.directions.is_some() && (is_own || before != y) {
            self.refusal = Some("the FMU has an event");
            return Err(FAILED);
        }
        Ok(match self.terminates {
            true => EventOutcome::Terminate,
            false => EventOutcome::Continue { y_changed: true },
        })
    }
}

impl Modes for ExchangeSystem<'_> {}
