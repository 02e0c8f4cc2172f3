//! Values that constants and parameters have by default.
//!
//! Where they are known before causalization, a parameter that cannot be set becomes a number, and
//! a divisor made of parameters is distinguished from zero.

use super::dae::{Dae, DefaultValues, Variable, VariableKind};
use crate::bytecode::{Functions, Machine};
use crate::flatten::BaseType;
use crate::symbolic::{Environment, Expr, Substitution, VarId, evaluate};
use std::cell::RefCell;

/// Attributes of a variable for given values of the parameters; `None` where the model says nothing, or
/// where there is no number.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Attributes {
    /// `start`.
    pub start: Option<f64>,
    /// `min`.
    pub min: Option<f64>,
    /// `max`.
    pub max: Option<f64>,
    /// `nominal`.
    pub nominal: Option<f64>,
}

impl DefaultValues {
    /// Of constants and parameters, these in order of dependence.
    pub(crate) fn of_parameters(dae: &Dae, parameters: &[VarId]) -> DefaultValues {
        let mut values = vec![f64::NAN; dae.variables.len()];
        for (value, variable) in values.iter_mut().zip(&dae.variables) {
            if let VariableKind::Constant(number) = variable.kind {
                *value = number;
            }
        }
        let mut defaults = DefaultValues { values };
        for parameter in parameters {
            if let Some(binding) = dae.variable(*parameter).binding {
                defaults.set(*parameter, defaults.of(dae, binding));
            }
        }
        defaults
    }

    /// With start values for the other variables, zero where they have none.
    pub(crate) fn with_starts(&self, dae: &Dae) -> DefaultValues {
        let start = |variable: VarId| {
            let start = dae.variable(variable).start.map_or(0.0, |start| self.of(dae, start));
            if start.is_finite() { start } else { 0.0 }
        };
        let known = (0..dae.variables.len() as u32).map(VarId).map(|v| (v, self.get(v)));
        let values = known.map(|(v, value)| if value.is_nan() { start(v) } else { value });
        DefaultValues { values: values.collect() }
    }

    /// With the values that a system has for the parameters.
    pub(crate) fn with_parameters(&self, dae: &Dae, value: impl Fn(usize) -> f64) -> DefaultValues {
        let mut values = self.values.clone();
        for (at, variable) in dae.variables.iter().enumerate() {
            if matches!(variable.kind, VariableKind::Parameter { .. }) {
                values[at] = value(at);
            }
        }
        DefaultValues { values }
    }

    /// The attributes of a variable.
    pub(crate) fn attributes(&self, dae: &Dae, variable: &Variable) -> Attributes {
        let value = |e: Option<Expr>| e.map(|e| self.of(dae, e)).filter(|value| value.is_finite());
        Attributes {
            start: value(variable.start),
            min: value(variable.min),
            max: value(variable.max),
            nominal: value(variable.nominal),
        }
    }

    /// The value of an expression, NaN where it has none, or contains a variable without one.
    pub(crate) fn of(&self, dae: &Dae, e: Expr) -> f64 {
        // A condition on what is not known would choose a branch.
        if dae.pool.any_variable(e, |v| self.get(v).is_nan()) {
            return f64::NAN;
        }
        let machine = RefCell::new(Machine::default());
        evaluate(
            &dae.pool,
            e,
            &Calling { values: &self.values, functions: &dae.functions, machine },
        )
    }
}

/// Values of variables, and a machine for calls. What only the simulation knows is not called, nor what
/// the interpreter takes long for.
struct Calling<'a> {
    values: &'a [f64],
    functions: &'a Functions,
    machine: RefCell<Machine>,
}

impl Environment for Calling<'_> {
    fn variable(&self, variable: VarId) -> f64 {
        self.values.get(variable.0 as usize).copied().unwrap_or(f64::NAN)
    }

    fn call(&self, function: u32, output: u32, inputs: &[u32], arguments: &[f64]) -> f64 {
        let code = &self.functions.codes[function as usize];
        if arguments.iter().any(|a| a.is_nan()) || code.impure || code.is_interpreted() {
            return f64::NAN;
        }
        let mut machine = self.machine.borrow_mut();
        machine.restart();
        let given = arguments.iter().copied();
        let results = match inputs.is_empty() {
            true => machine.call(self.functions, function, given),
            false => machine.partial(self.functions, function, inputs, given),
        };
        let result = results.map_or(f64::NAN, |results| results[output as usize]);
        // The simulation warns of zero where nothing was assigned.
        if machine.notices().is_empty() { result } else { f64::NAN }
    }
}

/// Replaces parameters that cannot be set by their values, where constants alone determine these;
/// returns the other parameters.
pub(crate) fn fold_parameters(dae: &mut Dae, parameters: Vec<VarId>) -> Vec<VarId> {
    let mut defaults = DefaultValues::of_parameters(dae, &[]);
    let mut rest = Vec::with_capacity(parameters.len());
    let mut replacements: Vec<Option<Expr>> = vec![None; dae.variables.len()];
    for parameter in parameters {
        let variable = dae.variable(parameter);
        let is_number = !matches!(variable.base, BaseType::ExternalObject(_) | BaseType::String);
        let value = match (variable.kind, variable.binding) {
            (VariableKind::Parameter { tunable: false }, Some(binding)) if is_number => {
                defaults.of(dae, binding)
            }
            _ => f64::NAN,
        };
        if value.is_finite() {
            defaults.set(parameter, value);
            let position = parameter.0 as usize;
            dae.variables[position].kind = VariableKind::Constant(value);
            replacements[position] = Some(dae.pool.constant(value));
        } else {
            rest.push(parameter);
        }
    }
    if replacements.iter().any(Option::is_some) {
        replace_everywhere(dae, &replacements);
    }
    rest
}

fn replace_everywhere(dae: &mut Dae, replacements: &[Option<Expr>]) {
    let Dae {
        pool, variables, equations, initial_equations, assertions, relations, events, ..
    } = dae;
    let replacement = |v: VarId| replacements[v.0 as usize];
    let mut substitution = Substitution::new(&replacement);
    let mut replace = |e: &mut Expr| *e = substitution.apply(pool, *e);
    for v in variables {
        let attributes = [&mut v.binding, &mut v.start, &mut v.min, &mut v.max, &mut v.nominal];
        attributes.into_iter().flatten().for_each(&mut replace);
    }
    for equation in equations.iter_mut().chain(initial_equations) {
        replace(&mut equation.left);
        replace(&mut equation.right);
    }
    assertions.iter_mut().for_each(|assertion| assertion.for_each_expression(&mut replace));
    for relation in relations {
        replace(&mut relation.left);
        replace(&mut relation.right);
    }
    events.delays.iter_mut().for_each(|delay| replace(&mut delay.time));
    events.for_each_expression(replace);
}
