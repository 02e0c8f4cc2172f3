//! The functions of an instance, under one name each for both versions of the standard. Numbers of all
//! types are handed over as `f64`.

#![allow(unsafe_code, reason = "functions of another language can only be called so")]

use super::binary::{Component, Functions, text};
use super::calls::{CallError, Severity};
use super::functions::{EventInfo2, Status};
use crate::description::Kind;
use crate::sim::same_time;
use std::ffi::{CString, c_char, c_int};

/// The order of the derivatives of inputs.
static FIRST_ORDER: c_int = 1;
/// Most rounds of discrete states at one event.
const MOST_ROUNDS: u32 = 1000;

/// What an event has led to.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Update {
    needs_another: bool,
    /// The unit ends the simulation.
    pub terminates: bool,
    /// When the next event is.
    pub next_event: Option<f64>,
}

/// How a step of co-simulation ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct StepEnd {
    /// The time reached.
    pub time: f64,
    /// An event has to be handled before the next step.
    pub needs_event: bool,
    /// The unit ends the simulation.
    pub terminates: bool,
}

/// Calls a function of the standard and judges its status.
macro_rules! call {
    ($self:ident, $function:expr $(, $argument:expr)*) => {{
        let function = $function;
        match function.pointer {
            None => Err(CallError { function: function.name, severity: Severity::Missing }),
            Some(pointer) => {
                $self.watch().enter(function.number);
                // SAFETY: the function has this type by the standard, the handle is that of a living
                // instance, and pointers lead to as many values as are said beside them.
                let status = unsafe { pointer($self.handle() $(, $argument)*) };
                $self.watch().leave();
                judge(function.name, status)
            }
        }
    }};
}

/// Gets values by way of their own type.
macro_rules! get {
    ($self:ident, $function:expr, $type:ty, $references:ident, $values:ident) => {{
        let mut own = vec![<$type>::default(); $values.len()];
        let (count, length) = ($references.len(), own.len());
        call!($self, $function, $references.as_ptr(), count, own.as_mut_ptr(), length)?;
        $values.iter_mut().zip(own).for_each(|(value, own)| *value = own as f64);
        Ok(())
    }};
}

/// Sets values by way of their own type.
macro_rules! set {
    ($self:ident, $function:expr, $type:ty, $references:ident, $values:ident) => {{
        let own: Vec<$type> = $values.iter().map(|value| *value as $type).collect();
        call!($self, $function, $references.as_ptr(), $references.len(), own.as_ptr(), own.len())
    }};
}

fn judge(function: &'static str, status: Status) -> Result<(), CallError> {
    let severity = match status {
        0 | 1 => return Ok(()),
        2 => Severity::Discard,
        3 => Severity::Error,
        _ => Severity::Fatal,
    };
    Err(CallError { function, severity })
}

/// The time at which a step has ended, if it lies within the step.
fn within(function: &'static str, reached: f64, step: (f64, f64)) -> Result<f64, CallError> {
    let (from, to) = step;
    match (from..=to).contains(&reached) || same_time(reached, from) || same_time(reached, to) {
        true => Ok(reached.clamp(from, to)),
        false => Err(CallError { function, severity: Severity::Outside { reached, step } }),
    }
}

/// Initialization and modes.
impl Component {
    /// Begins the initialization of a simulation.
    pub(crate) fn enter_initialization(
        &self,
        tolerance: Option<f64>,
        (start, stop): (f64, f64),
    ) -> Result<(), CallError> {
        let (given, tolerance) = (tolerance.is_some(), tolerance.unwrap_or(0.0));
        match self.functions() {
            Functions::V2(f) => {
                call!(self, f.setup_experiment, c_int::from(given), tolerance, start, 1, stop)?;
                call!(self, f.enter_initialization)
            }
            Functions::V3(f) => {
                call!(self, f.enter_initialization, given, tolerance, start, true, stop)
            }
        }
    }

    /// Ends it.
    pub(crate) fn exit_initialization(&self) -> Result<(), CallError> {
        match self.functions() {
            Functions::V2(f) => call!(self, f.exit_initialization),
            Functions::V3(f) => call!(self, f.exit_initialization),
        }
    }

    /// Begins the setting of structural parameters (FMI 3.0).
    pub(crate) fn enter_configuration(&self) -> Result<(), CallError> {
        match self.functions() {
            Functions::V2(_) => Ok(()),
            Functions::V3(f) => call!(self, f.enter_configuration),
        }
    }

    /// Ends it.
    pub(crate) fn exit_configuration(&self) -> Result<(), CallError> {
        match self.functions() {
            Functions::V2(_) => Ok(()),
            Functions::V3(f) => call!(self, f.exit_configuration),
        }
    }

    /// Begins an event.
    pub(crate) fn enter_event_mode(&self) -> Result<(), CallError> {
        match self.functions() {
            Functions::V2(f) => call!(self, f.enter_event_mode),
            Functions::V3(f) => call!(self, f.enter_event_mode),
        }
    }

    /// Iterates the discrete states at an event until they do not change.
    pub(crate) fn update_discrete_states(&self) -> Result<Update, CallError> {
        for _ in 0..MOST_ROUNDS {
            let update = self.update_once()?;
            if !update.needs_another || update.terminates {
                return Ok(update);
            }
        }
        let function = match self.functions() {
            Functions::V2(f) => f.new_discrete_states.name,
            Functions::V3(f) => f.update_discrete_states.name,
        };
        Err(CallError { function, severity: Severity::Endless })
    }

    fn update_once(&self) -> Result<Update, CallError> {
        match self.functions() {
            Functions::V2(f) => {
                let mut info = EventInfo2::default();
                call!(self, f.new_discrete_states, &raw mut info)?;
                Ok(Update {
                    needs_another: info.needs_update != 0,
                    terminates: info.terminates != 0,
                    next_event: (info.has_next_event != 0).then_some(info.next_event),
                })
            }
            Functions::V3(f) => {
                let mut flags = [false; 5];
                let mut next = 0.0;
                let [again, ends, nominals, states, has_next] = &mut flags;
                call!(
                    self,
                    f.update_discrete_states,
                    again,
                    ends,
                    nominals,
                    states,
                    has_next,
                    &mut next
                )?;
                let [needs_another, terminates, .., has_next] = flags;
                Ok(Update { needs_another, terminates, next_event: has_next.then_some(next) })
            }
        }
    }

    /// Ends an event of model exchange.
    pub(crate) fn enter_continuous_mode(&self) -> Result<(), CallError> {
        match self.functions() {
            Functions::V2(f) => call!(self, f.enter_continuous_mode),
            Functions::V3(f) => call!(self, f.enter_continuous_mode),
        }
    }

    /// Ends an event of co-simulation (FMI 3.0).
    pub(crate) fn enter_step_mode(&self) -> Result<(), CallError> {
        match self.functions() {
            Functions::V2(_) => Ok(()),
            Functions::V3(f) => call!(self, f.enter_step_mode),
        }
    }

    /// Ends the simulation.
    pub(crate) fn terminate(&self) -> Result<(), CallError> {
        match self.functions() {
            Functions::V2(f) => call!(self, f.terminate),
            Functions::V3(f) => call!(self, f.terminate),
        }
    }
}

/// Model exchange.
impl Component {
    /// Sets the time.
    pub(crate) fn set_time(&self, time: f64) -> Result<(), CallError> {
        match self.functions() {
            Functions::V2(f) => call!(self, f.set_time, time),
            Functions::V3(f) => call!(self, f.set_time, time),
        }
    }

    /// Sets the continuous states.
    pub(crate) fn set_states(&self, states: &[f64]) -> Result<(), CallError> {
        match self.functions() {
            _ if states.is_empty() => Ok(()),
            Functions::V2(f) => call!(self, f.set_states, states.as_ptr(), states.len()),
            Functions::V3(f) => call!(self, f.set_states, states.as_ptr(), states.len()),
        }
    }

    /// Writes the continuous states.
    pub(crate) fn states(&self, out: &mut [f64]) -> Result<(), CallError> {
        match self.functions() {
            _ if out.is_empty() => Ok(()),
            Functions::V2(f) => call!(self, f.get_states, out.as_mut_ptr(), out.len()),
            Functions::V3(f) => call!(self, f.get_states, out.as_mut_ptr(), out.len()),
        }
    }

    /// Writes the derivatives of the continuous states.
    pub(crate) fn derivatives(&self, out: &mut [f64]) -> Result<(), CallError> {
        match self.functions() {
            _ if out.is_empty() => Ok(()),
            Functions::V2(f) => call!(self, f.get_derivatives, out.as_mut_ptr(), out.len()),
            Functions::V3(f) => call!(self, f.get_derivatives, out.as_mut_ptr(), out.len()),
        }
    }

    /// Writes the event indicators.
    pub(crate) fn indicators(&self, out: &mut [f64]) -> Result<(), CallError> {
        match self.functions() {
            _ if out.is_empty() => Ok(()),
            Functions::V2(f) => call!(self, f.get_indicators, out.as_mut_ptr(), out.len()),
            Functions::V3(f) => call!(self, f.get_indicators, out.as_mut_ptr(), out.len()),
        }
    }

    /// The numbers of continuous states and of event indicators (FMI 3.0).
    pub(crate) fn sizes(&self) -> Result<Option<[usize; 2]>, CallError> {
        let Functions::V3(f) = self.functions() else { return Ok(None) };
        let mut sizes = [0; 2];
        let [states, indicators] = &mut sizes;
        call!(self, f.count_states, states)?;
        call!(self, f.count_indicators, indicators)?;
        Ok(Some(sizes))
    }

    /// Says that a step is completed; whether it leads to an event, and to the end of the simulation.
    pub(crate) fn completed_step(&self) -> Result<[bool; 2], CallError> {
        match self.functions() {
            Functions::V2(f) => {
                let mut flags = [0; 2];
                let [event, ends] = &mut flags;
                call!(self, f.completed_step, 1, event, ends)?;
                Ok(flags.map(|flag| flag != 0))
            }
            Functions::V3(f) => {
                let mut flags = [false; 2];
                let [event, ends] = &mut flags;
                call!(self, f.completed_step, true, event, ends)?;
                Ok(flags)
            }
        }
    }

    /// Writes the derivatives of unknowns along a direction of knowns.
    pub(crate) fn directional_derivative(
        &self,
        [unknowns, knowns]: [&[u32]; 2],
        seed: &[f64],
        out: &mut [f64],
    ) -> Result<(), CallError> {
        let (u, k) = ((unknowns.as_ptr(), unknowns.len()), (knowns.as_ptr(), knowns.len()));
        let (seeds, values) = (seed.as_ptr(), out.as_mut_ptr());
        match self.functions() {
            Functions::V2(f) => call!(self, f.directional, u.0, u.1, k.0, k.1, seeds, values),
            Functions::V3(f) => {
                call!(self, f.directional, u.0, u.1, k.0, k.1, seeds, seed.len(), values, out.len())
            }
        }
    }
}

/// Scheduled execution (FMI 3.0).
impl Component {
    /// Activates the part of a clock.
    pub(crate) fn activate(&self, clock: u32, time: f64) -> Result<(), CallError> {
        match self.functions() {
            Functions::V2(_) => Ok(()),
            Functions::V3(f) => call!(self, f.activate_partition, clock, time),
        }
    }

    /// The new interval of a clock, if it has changed.
    pub(crate) fn interval(&self, clock: u32) -> Result<Option<f64>, CallError> {
        /// `fmi3IntervalChanged`
        const CHANGED: c_int = 2;
        let Functions::V3(f) = self.functions() else { return Ok(None) };
        let (mut interval, mut qualifier) = (0.0, 0);
        let places = (&raw mut interval, &raw mut qualifier);
        call!(self, f.get_interval, &raw const clock, 1, places.0, places.1)?;
        Ok(Some(interval).filter(|_| qualifier == CHANGED))
    }
}

/// Co-simulation.
impl Component {
    /// Sets how fast an input changes during the next step (FMI 2.0, where it is Real).
    pub(crate) fn set_input_derivative(
        &self,
        reference: u32,
        derivative: f64,
    ) -> Result<(), CallError> {
        let Functions::V2(f) = self.functions() else { return Ok(()) };
        let (reference, order) = (&raw const reference, &raw const FIRST_ORDER);
        call!(self, f.set_input_derivatives, reference, 1, order, &raw const derivative)
    }

    /// That steps end where they begin.
    pub(crate) fn makes_no_progress(&self) -> CallError {
        let function = match self.functions() {
            Functions::V2(f) => f.do_step.name,
            Functions::V3(f) => f.do_step.name,
        };
        CallError { function, severity: Severity::NoProgress }
    }

    /// Makes a step.
    pub fn step(&self, time: f64, length: f64) -> Result<StepEnd, CallError> {
        match self.functions() {
            Functions::V2(f) => {
                let whole = StepEnd { time: time + length, needs_event: false, terminates: false };
                match call!(self, f.do_step, time, length, 1) {
                    Ok(()) => Ok(whole),
                    Err(error) => match self.terminated() {
                        Some(reached) if error.severity == Severity::Discard => {
                            let time = within(f.real_status.name, reached, (time, whole.time))?;
                            Ok(StepEnd { time, terminates: true, ..whole })
                        }
                        _ => Err(error),
                    },
                }
            }
            Functions::V3(f) => {
                let (mut flags, mut reached) = ([false; 3], time + length);
                let [needs_event, terminates, early] = &mut flags;
                call!(
                    self,
                    f.do_step,
                    time,
                    length,
                    true,
                    needs_event,
                    terminates,
                    early,
                    &mut reached
                )?;
                let [needs_event, terminates, is_early] = flags;
                let time = match is_early || terminates {
                    true => within(f.do_step.name, reached, (time, time + length))?,
                    false => time + length,
                };
                Ok(StepEnd { time, needs_event, terminates })
            }
        }
    }
}

impl Component {
    /// The time at which the unit has ended the simulation within a step, if it has (FMI 2.0.5
    /// §4.2.4: `fmi2Terminated`, `fmi2LastSuccessfulTime`).
    fn terminated(&self) -> Option<f64> {
        const TERMINATED: c_int = 3;
        const LAST_SUCCESSFUL_TIME: c_int = 2;
        let Functions::V2(f) = self.functions() else { return None };
        let (mut is_terminated, mut time) = (0, 0.0);
        call!(self, f.boolean_status, TERMINATED, &raw mut is_terminated).ok()?;
        call!(self, f.real_status, LAST_SUCCESSFUL_TIME, &raw mut time).ok()?;
        (is_terminated != 0).then_some(time)
    }
}

/// Values.
impl Component {
    /// Writes the values of variables of one kind, one after the other.
    pub fn get(&self, kind: Kind, references: &[u32], values: &mut [f64]) -> Result<(), CallError> {
        let count = references.len();
        match (self.functions(), kind) {
            (Functions::V2(f), Kind::Float64) => {
                call!(self, f.get_real, references.as_ptr(), count, values.as_mut_ptr())
            }
            (Functions::V2(f), _) => {
                let function = if kind == Kind::Boolean { f.get_boolean } else { f.get_integer };
                let mut own: Vec<c_int> = vec![0; values.len()];
                call!(self, function, references.as_ptr(), count, own.as_mut_ptr())?;
                values.iter_mut().zip(own).for_each(|(value, own)| *value = f64::from(own));
                Ok(())
            }
            (Functions::V3(f), Kind::Float64) => {
                let (pointer, length) = (values.as_mut_ptr(), values.len());
                call!(self, f.get_float64, references.as_ptr(), count, pointer, length)
            }
            (Functions::V3(f), Kind::Float32) => get!(self, f.get_float32, f32, references, values),
            (Functions::V3(f), Kind::Int8) => get!(self, f.get_int8, i8, references, values),
            (Functions::V3(f), Kind::UInt8) => get!(self, f.get_uint8, u8, references, values),
            (Functions::V3(f), Kind::Int16) => get!(self, f.get_int16, i16, references, values),
            (Functions::V3(f), Kind::UInt16) => get!(self, f.get_uint16, u16, references, values),
            (Functions::V3(f), Kind::Int32) => get!(self, f.get_int32, i32, references, values),
            (Functions::V3(f), Kind::UInt32) => get!(self, f.get_uint32, u32, references, values),
            (Functions::V3(f), Kind::UInt64) => get!(self, f.get_uint64, u64, references, values),
            (Functions::V3(f), Kind::Boolean) => get!(self, f.get_boolean, u8, references, values),
            (Functions::V3(f), _) => get!(self, f.get_int64, i64, references, values),
        }
    }

    /// Sets the values of variables of one kind, one after the other.
    pub fn set(&self, kind: Kind, references: &[u32], values: &[f64]) -> Result<(), CallError> {
        let count = references.len();
        match (self.functions(), kind) {
            (Functions::V2(f), Kind::Float64) => {
                call!(self, f.set_real, references.as_ptr(), count, values.as_ptr())
            }
            (Functions::V2(f), _) => {
                let function = if kind == Kind::Boolean { f.set_boolean } else { f.set_integer };
                let own: Vec<c_int> = values.iter().map(|value| *value as c_int).collect();
                call!(self, function, references.as_ptr(), count, own.as_ptr())
            }
            (Functions::V3(f), Kind::Float64) => {
                call!(
                    self,
                    f.set_float64,
                    references.as_ptr(),
                    count,
                    values.as_ptr(),
                    values.len()
                )
            }
            (Functions::V3(f), Kind::Float32) => set!(self, f.set_float32, f32, references, values),
            (Functions::V3(f), Kind::Int8) => set!(self, f.set_int8, i8, references, values),
            (Functions::V3(f), Kind::UInt8) => set!(self, f.set_uint8, u8, references, values),
            (Functions::V3(f), Kind::Int16) => set!(self, f.set_int16, i16, references, values),
            (Functions::V3(f), Kind::UInt16) => set!(self, f.set_uint16, u16, references, values),
            (Functions::V3(f), Kind::Int32) => set!(self, f.set_int32, i32, references, values),
            (Functions::V3(f), Kind::UInt32) => set!(self, f.set_uint32, u32, references, values),
            (Functions::V3(f), Kind::UInt64) => set!(self, f.set_uint64, u64, references, values),
            (Functions::V3(f), Kind::Boolean) => set!(self, f.set_boolean, u8, references, values),
            (Functions::V3(f), _) => set!(self, f.set_int64, i64, references, values),
        }
    }

    /// Sets the strings of a String variable.
    pub fn set_strings(&self, reference: u32, values: &[String]) -> Result<(), CallError> {
        let own: Vec<CString> = values.iter().map(|value| text(value)).collect();
        let pointers: Vec<*const c_char> = own.iter().map(|value| value.as_ptr()).collect();
        let (reference, strings) = (&raw const reference, pointers.as_ptr());
        match self.functions() {
            Functions::V2(f) => call!(self, f.set_string, reference, 1, strings),
            Functions::V3(f) => call!(self, f.set_string, reference, 1, strings, pointers.len()),
        }
    }
}
