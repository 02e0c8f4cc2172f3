//! Sensitivities of a running system: at its start and between events, and what events do to them.

use super::execution::{read, run};
use super::sensitivity_state::Sensitivity;
use super::system::System;
use crate::codegen::sensitivity::SensitivityCode;
use crate::sim::Failure;
use std::sync::Arc;

impl System {
    /// Carries sensitivities from the next initialization on, or none any more. The code must be
    /// made for the program and for the variables that the system observes.
    pub fn differentiate(&mut self, code: Option<&Arc<SensitivityCode>>) {
        self.restore_program();
        self.sensitivity = code.map(|code| {
            if self.registers.len() < code.registers.len() {
                self.registers.extend(&code.registers);
            }
            let n = self.program.sorted.states.len();
            Box::new(Sensitivity {
                code: code.clone(),
                cause: None,
                span: f64::INFINITY,
                is_smooth: true,
                before: vec![0.0; n],
                after: vec![0.0; n],
                space: code.rhs.space(&self.program.continuous.pattern),
                refusal: None,
            })
        });
    }

    /// Why the last simulation had no sensitivities, in words that follow on "because".
    pub fn sensitivity_refusal(&self) -> Option<&'static str> {
        self.sensitivity.as_ref()?.refusal
    }

    /// Copies the derivatives after y, if it holds any, to their registers.
    pub(super) fn load_derivatives(&mut self, y: &[f64]) {
        let Some(sensitivity) = &self.sensitivity else { return };
        let n = y.len() / (sensitivity.code.n_directions() + 1);
        if n != self.n_held() {
            return;
        }
        for (column, s) in y[n..].chunks_exact(n.max(1)).enumerate() {
            for (kept, s) in sensitivity.code.unknowns.iter().zip(s) {
                self.registers.registers[kept.registers[column] as usize] = *s;
            }
        }
    }

    /// Copies the derivatives after y from their registers.
    pub(super) fn unload_derivatives(&self, y: &mut [f64]) {
        let Some(sensitivity) = &self.sensitivity else { return };
        let n = self.n_held();
        for (column, s) in y[n..].chunks_exact_mut(n.max(1)).enumerate() {
            for (kept, s) in sensitivity.code.unknowns.iter().zip(s) {
                *s = self.registers[kept.registers[column] as usize];
            }
        }
    }

    /// Writes the derivatives of the right-hand side along all columns, everything loaded.
    pub(super) fn right_sides_along(&mut self, out: &mut [f64]) -> Result<(), Failure> {
        let Some(sensitivity) = &mut self.sensitivity else { return Ok(()) };
        let Sensitivity { code, space, .. } = &mut **sensitivity;
        let continuous = &self.program.continuous;
        read(&continuous.jacobian, &mut self.registers, &mut space.jacobian)?;
        read(&code.rhs.code, &mut self.registers, &mut space.entries)?;
        let registers = &self.registers.registers;
        code.rhs.write(&continuous.pattern, &code.unknowns, registers, space, out);
        Ok(())
    }

    /// Derivatives of the solution of the initial system.
    pub(super) fn start_sensitivities(&mut self) -> Result<(), Failure> {
        let Some(sensitivity) = &mut self.sensitivity else { return Ok(()) };
        (sensitivity.cause, sensitivity.refusal) = (None, None);
        let code = sensitivity.code.clone();
        for register in &code.cleared {
            self.registers[*register as usize] = 0.0;
        }
        run(&code.constants, &mut self.registers)?;
        run(&code.initial, &mut self.registers)
    }

    /// Derivatives of what the equations of the event at hand have set.
    pub(super) fn carry_through_event(&mut self) -> Result<(), Failure> {
        let Some(sensitivity) = &self.sensitivity else { return Ok(()) };
        let code = sensitivity.code.clone();
        run(&code.event, &mut self.registers)
    }

    /// Derivatives of a state that a `reinit` has set.
    pub(super) fn carry_through_reinit(&mut self, reinit: usize, negated: bool) {
        let Some(sensitivity) = &self.sensitivity else { return };
        let code = sensitivity.code.clone();
        let state = self.program.events.reinitialized[reinit].0;
        let Some(kept) = code.unknowns.iter().find(|kept| kept.variable == state) else { return };
        for (register, value) in kept.registers.iter().zip(&code.reinits[reinit]) {
            let value = self.registers[*value as usize];
            self.registers[*register as usize] = if negated { -value } else { value };
        }
    }

    /// The derivatives of previous values become those of the values.
    pub(super) fn carry_to_previous(&mut self) {
        let Some(sensitivity) = &self.sensitivity else { return };
        let code = sensitivity.code.clone();
        for (from, to) in code.previous.iter().flatten() {
            for (from, to) in from.iter().zip(to) {
                self.registers[*to as usize] = self.registers[*from as usize];
            }
        }
    }

    /// Derivatives of the algebraic unknowns, those of the states given.
    pub(super) fn differentiate_algebraic(&mut self) -> Result<(), Failure> {
        let Some(sensitivity) = &self.sensitivity else { return Ok(()) };
        if self.program.continuous.iteration.is_empty() {
            return Ok(());
        }
        let code = sensitivity.code.clone();
        run(&code.algebraic, &mut self.registers)
    }

    /// Whether there are derivatives to carry.
    pub(super) fn has_directions(&self) -> bool {
        self.sensitivity.as_ref().is_some_and(|own| own.code.n_directions() > 0)
    }

    /// Number of unknowns that the integrator holds.
    fn n_held(&self) -> usize {
        self.program.sorted.states.len() + self.n_held_iteration()
    }

    /// Magnitudes of the parameters, positive.
    pub(super) fn magnitudes_of_parameters(&self, out: &mut [f64]) {
        let Some(sensitivity) = &self.sensitivity else { return };
        for (out, at) in out.iter_mut().zip(&sensitivity.code.parameters) {
            *out = self.magnitude_of_parameter(*at);
        }
    }

    pub(super) fn magnitude_of_parameter(&self, at: usize) -> f64 {
        let variable = self.program.parameters()[at].variable;
        let value = self.registers[variable.0 as usize].abs();
        if value.is_finite() && value > 0.0 { value } else { 1.0 }
    }
}
