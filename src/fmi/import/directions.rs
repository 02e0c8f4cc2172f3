//! Derivatives of a simulation by parameters of a unit for model exchange: with directional derivatives
//! by parameters (FMI 3.0.2 §2.2.11) the sensitivity equations can be integrated with the states,
//!
//! ```text
//! s' = ∂f/∂x s + ∂f/∂p,     s(0) = 0, or 1 for the initial value of a state
//! ```
//!
//! Initial values that the unit calculates have their derivatives from the initialization mode.
//!
//! Nothing tells how the time of an event depends on a parameter: a unit has them as long as there are
//! none.

use super::layout::Place;
use super::plan::{InterfaceKind, Plan};
use crate::Description;
use crate::description::{Causality, Initial, Version};

/// What derivatives are taken of, and by what: value references.
#[derive(Debug, Clone, PartialEq)]
pub struct Directions {
    /// The states.
    pub states: Vec<u32>,
    /// Their derivatives.
    pub derivatives: Vec<u32>,
    /// The numbers of the states whose initial values the unit calculates.
    pub calculated: Vec<usize>,
    /// What is recorded.
    pub observed: Vec<u32>,
    /// What varies.
    pub varied: Vec<Direction>,
}

/// What derivatives are taken by.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Direction {
    /// A parameter.
    Parameter(u32),
    /// The initial value of the state of this number.
    Start(usize),
}

impl Directions {
    /// The directions of a plan.
    ///
    /// # Errors
    /// Why there are none, in words that follow on "because".
    pub fn of(description: &Description, plan: &Plan) -> Result<Directions, String> {
        let interface = description.model_exchange.as_ref();
        if plan.kind != InterfaceKind::ModelExchange {
            return Err("the FMU integrates itself".to_owned());
        }
        if description.version == Version::V2 {
            return Err("FMUs of FMI 2.0 have no derivatives by parameters".to_owned());
        }
        if !interface.is_some_and(|own| own.provides_directional_derivatives) {
            return Err("the FMU has no directional derivatives".to_owned());
        }
        let structure = &description.structure;
        if !structure.event_indicators.is_empty() {
            return Err("the FMU has events".to_owned());
        }
        let variables = &description.variables;
        let derivatives: Vec<usize> =
            structure.derivatives.iter().map(|own| own.variable).collect();
        let states = derivatives.iter().map(|at| variables[*at].derivative_of);
        let states: Option<Vec<usize>> = states.collect();
        let states = states.ok_or("its states are not known")?;
        if !derivatives.iter().chain(&states).all(|at| variables[*at].dimensions.is_empty()) {
            return Err("its states are arrays".to_owned());
        }
        let is_calculated = |at: &usize| variables[states[*at]].initial != Some(Initial::Exact);
        let float = |place: &Place| {
            let own = &variables[place.variable];
            match own.kind.is_float() && own.dimensions.is_empty() {
                true => Ok(own.reference),
                false => Err(format!("`{}` is no real number", own.name)),
            }
        };
        let direction = |place: &Place| {
            let (own, reference) = (&variables[place.variable], float(place)?);
            let state = states.iter().position(|state| *state == place.variable);
            match (state, own.causality) {
                (Some(state), _) => Ok(Direction::Start(state)),
                (None, Causality::Parameter) => Ok(Direction::Parameter(reference)),
                _ => Err(format!("`{}` is neither a parameter nor a state", own.name)),
            }
        };
        let references =
            |all: &[usize]| -> Vec<u32> { all.iter().map(|at| variables[*at].reference).collect() };
        Ok(Directions {
            states: references(&states),
            derivatives: references(&derivatives),
            calculated: (0..states.len()).filter(is_calculated).collect(),
            observed: plan.observed.iter().map(float).collect::<Result<_, _>>()?,
            varied: plan.varied.iter().map(direction).collect::<Result<_, String>>()?,
        })
    }

    /// The states whose initial values the unit calculates, and what a direction varies.
    #[cfg(feature = "host")]
    pub(super) fn at_start(&self, direction: usize) -> (Vec<u32>, u32) {
        let calculated = self.calculated.iter().map(|state| self.states[*state]).collect();
        match self.varied[direction] {
            Direction::Parameter(reference) => (calculated, reference),
            Direction::Start(state) => (calculated, self.states[state]),
        }
    }

    /// What is known along a direction, with the derivatives of the states along it.
    #[cfg(feature = "host")]
    pub(super) fn seed(&self, direction: usize, s: &[f64]) -> (Vec<u32>, Vec<f64>) {
        let (mut knowns, mut seed) = (self.states.clone(), s.to_vec());
        if let Direction::Parameter(reference) = self.varied[direction] {
            knowns.push(reference);
            seed.push(1.0);
        }
        (knowns, seed)
    }
}
