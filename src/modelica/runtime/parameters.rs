//! Parameters of a running system: values set from outside, and all others computed from these.

use super::execution::{FailedOperation, run, run_parameter, run_strictly};
use super::newton::LoopSolver;
use super::system::System;
use crate::codegen::program::{Access, number_of_equations};
use crate::diag::Fault;
use crate::fault;
use crate::flatten::BaseType;
use crate::sim::Failure;
use crate::symbolic::VarId;

impl System {
    /// Sets a parameter by its position among those of the program; it takes effect at the next
    /// initialization. Bounds are the caller's to check.
    pub fn set_parameter(&mut self, index: usize, value: f64) -> Result<(), Fault> {
        let name = &self.program.parameters().get(index).map(|p| p.name.clone());
        let is_fraction = value.fract() != 0.0 && !self.is_real(index);
        match (self.set.get_mut(index), name) {
            (Some(_), Some(name)) if !value.is_finite() => Err(fault!(
                crate::codegen::errors::UNKNOWN_PARAMETER,
                "the value of `{name}` is {value}"; help: "use a finite number"
            )),
            (Some(_), Some(name)) if is_fraction => Err(fault!(
                crate::codegen::errors::UNKNOWN_PARAMETER,
                "`{name}` takes whole numbers only";
                help: "in an identification, run once for each of several fixed values and \
                       compare the results"
            )),
            (Some(slot), _) => {
                *slot = Some(value);
                Ok(())
            }
            (None, _) => Err(fault!(
                crate::codegen::errors::UNKNOWN_PARAMETER,
                "there is no parameter number {index}"
            )),
        }
    }

    fn is_real(&self, parameter: usize) -> bool {
        self.program.parameters().get(parameter).is_none_or(|own| own.base == BaseType::Real)
    }

    /// Takes back all values set.
    pub fn reset_parameters(&mut self) {
        self.set.fill(None);
    }

    /// The value of a parameter or constant (position among the variables of the program) after
    /// initialization; `None` for other variables.
    pub fn value(&self, variable: usize) -> Option<f64> {
        let info = self.program.variables().get(variable)?;
        match info.access {
            Access::Constant(value) => Some(value),
            Access::Parameter => Some(self.registers[info.variable.0 as usize]),
            _ => None,
        }
    }

    /// Computes all parameters from those that are set.
    ///
    /// # Errors
    /// One of them cannot be computed.
    pub fn evaluate_parameters(&mut self) -> Result<(), Failure> {
        let program = self.program.clone();
        self.messages.lacking = None;
        self.loops.at_event.time = f64::NAN;
        self.registers.calls.restart();
        let solvers = self.loops.initial_solvers.iter_mut().chain(&mut self.loops.solvers);
        solvers.chain(&mut self.loops.event_solvers).for_each(LoopSolver::forget);
        let mut tunable = 0;
        // Slots of set values first: tapes run in order of dependence, not of declaration.
        let mut given: Vec<(VarId, f64)> = Vec::new();
        for (info, set) in program.parameters().iter().zip(&self.set) {
            if let Some(value) = set {
                given.push((info.variable, *value));
                tunable += 1;
            }
        }
        for (parameter, tape) in &program.values.parameter_tapes {
            let set = match tunable {
                0 => None,
                _ => given.iter().find(|(v, _)| v == parameter),
            };
            match set {
                Some((_, value)) => self.registers[parameter.0 as usize] = *value,
                None => match run_parameter(*parameter, tape, &mut self.registers)? {
                    Some(failure) => self.messages.lacking = Some(failure),
                    None => self.is_finite(*parameter)?,
                },
            }
        }
        run_strictly(&program.registers.hoisted.tape, &mut self.registers)?;
        run(&program.switching.time_rests, &mut self.registers)?;
        for (at, relation) in program.switching.relations.iter().enumerate() {
            let time = relation
                .time
                .filter(|_| !relation.is_rescheduled)
                .map(|(factor, rest)| -self.registers[rest as usize] / factor);
            self.set_switch(at, time);
        }
        Ok(())
    }

    /// Whether a value is a number; it need not be where a parameter has no value.
    pub(super) fn is_a_number(&self, value: f64) -> Result<(), Failure> {
        match &self.messages.lacking {
            Some(failure) if value.is_nan() => Err(*failure),
            _ => Ok(()),
        }
    }

    /// Whether a parameter is finite; it need not be a number where another one has no value.
    fn is_finite(&self, parameter: VarId) -> Result<(), Failure> {
        let value = self.registers[parameter.0 as usize];
        self.is_a_number(value)?;
        if value.is_finite() || (value.is_nan() && self.messages.lacking.is_some()) {
            return Ok(());
        }
        let origin = number_of_equations(&self.program.sorted) as u32 + parameter.0;
        Err(Failure::Domain { origin, operation: FailedOperation::OTHER })
    }
}
