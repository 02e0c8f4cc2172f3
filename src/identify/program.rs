//! Compiled programs as models to identify.

use super::model::settings_of;
use super::{Instance, Model, Parameter, PortableModel};
use crate::codegen::{Program, SensitivityCode, VariableInfo};
use crate::diag::{Diagnostic, Fault};
use crate::fmi::description::DefaultExperiment;
use crate::runtime::System;
use crate::sim::{
    DaeSystem, Failure, Residual as _, Settings, SimError, Simulator, Statistics, Trajectory,
};
use crate::source::with_source_table;
use rustc_hash::FxHashSet;
use std::cell::OnceCell;
use std::sync::{Arc, Mutex, PoisonError};

/// A compiled model under the name that the script gave it.
pub struct CompiledModel {
    name: String,
    program: Arc<Program>,
    driven: Option<(String, String)>,
    /// Positions of parameters, and values that they have in place of those of the model.
    values: Vec<(usize, f64)>,
    sensitivities: Arc<Sensitivities>,
}

/// Code for derivatives that was made, or why it was not, by parameters and observed variables: all
/// instances share it.
#[derive(Default)]
struct Sensitivities(Mutex<Vec<Known>>);

/// Positions of parameters and variables with what was made for them.
type Known = (Vec<usize>, Vec<usize>, Result<Arc<SensitivityCode>, String>);

impl Sensitivities {
    fn code(
        &self,
        program: &Arc<Program>,
        parameters: &[usize],
        observed: &[usize],
    ) -> Result<Arc<SensitivityCode>, String> {
        let mut list = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((.., known)) = list.iter().find(|(p, o, _)| p == parameters && o == observed) {
            return known.clone();
        }
        let made = SensitivityCode::compile(program, parameters, observed);
        list.push((parameters.to_vec(), observed.to_vec(), made.clone()));
        made
    }
}

impl CompiledModel {
    /// Names a program; the name carries the modification.
    pub fn new(name: impl Into<String>, program: Arc<Program>) -> CompiledModel {
        let (driven, values, sensitivities) = (None, Vec::new(), Arc::default());
        CompiledModel { name: name.into(), program, driven, values, sensitivities }
    }

    /// The input `x_name` has the value of `parameter`: a static curve, see [`Model::driven`].
    pub fn driven_by(self, x_name: &str, parameter: &str) -> CompiledModel {
        CompiledModel { driven: Some((x_name.to_owned(), parameter.to_owned())), ..self }
    }

    /// Parameters, by their positions in [`Program::parameters`], have these values unless they vary.
    pub fn with_values(self, values: Vec<(usize, f64)>) -> CompiledModel {
        CompiledModel { values, ..self }
    }

    fn variable(&self, name: &str) -> Option<&VariableInfo> {
        self.program.variables().iter().find(|variable| &*variable.name == name)
    }
}

impl Model for CompiledModel {
    fn name(&self) -> &str {
        &self.name
    }

    fn parameters(&self) -> Vec<Parameter> {
        let tunable = self.program.parameters();
        let settable = tunable.iter().map(|parameter| Parameter {
            name: parameter.name.to_string(),
            unit: parameter.unit.to_string(),
            min: parameter.min,
            max: parameter.max,
            tunable: true,
            top_level: parameter.top_level,
        });
        // A table in a model has a parameter for each of its entries.
        let known: FxHashSet<&str> = tunable.iter().map(|parameter| &*parameter.name).collect();
        let variables = self.program.variables().iter();
        let fixed = variables
            .filter(|variable| variable.is_known() && !known.contains(&*variable.name))
            .map(|variable| Parameter {
                name: variable.name.to_string(),
                unit: variable.unit.to_string(),
                min: f64::NEG_INFINITY,
                max: f64::INFINITY,
                tunable: false,
                top_level: variable.top_level,
            });
        let driver = self.driven.as_ref().map(|(_, parameter)| parameter.as_str());
        settable.chain(fixed).filter(|parameter| Some(parameter.name.as_str()) != driver).collect()
    }

    fn outputs(&self) -> Vec<String> {
        let outputs = self.program.variables().iter().filter(|variable| variable.is_output());
        outputs.map(|variable| variable.name.to_string()).collect()
    }

    fn names(&self) -> Vec<String> {
        let driver = self.driven.as_ref().map(|(_, parameter)| parameter.as_str());
        // Not those that the compiler has added, whose names are quoted.
        let is_own =
            |variable: &&VariableInfo| !(variable.protected && variable.name.starts_with('\''));
        let own = self.program.variables().iter().filter(is_own);
        let names = own.map(|variable| &*variable.name);
        names.filter(|name| Some(*name) != driver).map(str::to_owned).collect()
    }

    fn unit(&self, variable: &str) -> Option<String> {
        self.variable(variable).map(|variable| variable.unit.to_string())
    }

    fn description(&self, variable: &str) -> Option<String> {
        self.variable(variable).map(|variable| variable.description.to_string())
    }

    fn is_relative(&self, variable: &str) -> bool {
        self.variable(variable).is_some_and(|variable| variable.is_relative)
    }

    fn depends_on_time_alone(&self, variable: &str, varied: &[String]) -> bool {
        let Ok(variable) = self.program.find_variable(variable) else { return false };
        let varied: Result<Vec<usize>, Fault> =
            varied.iter().map(|name| self.program.find_parameter(name)).collect();
        !self.program.needs_states(&[variable])
            && varied.is_ok_and(|varied| !self.program.depends_on_parameters(variable, &varied))
    }

    fn driven(&self) -> Option<(&str, &str)> {
        self.driven.as_ref().map(|(x_name, parameter)| (x_name.as_str(), parameter.as_str()))
    }

    fn settings(&self) -> Settings {
        let own = self.program.experiment();
        settings_of(DefaultExperiment {
            start: own.start_time,
            stop: own.stop_time,
            tolerance: own.tolerance,
            step: own.interval,
        })
    }

    fn has_stop_time(&self) -> bool {
        self.program.experiment().stop_time.is_some()
    }

    fn portable(&self) -> Result<PortableModel, String> {
        // Messages of simulations name no places, so that the source table may stay here.
        let (bytes, _) = with_source_table(|| self.program.to_bytes());
        let Some(program) = bytes else {
            return Err("calls functions in C, or is too large".to_owned());
        };
        let (name, driven, values) = (self.name.clone(), self.driven.clone(), self.values.clone());
        Ok(PortableModel { name, driven, values, program, spectrum: None })
    }

    fn instance(&self, varied: &[String], observed: &[String]) -> Result<Box<dyn Instance>, Fault> {
        let positions: Vec<usize> = observed
            .iter()
            .map(|name| self.program.find_variable(name))
            .collect::<Result<_, _>>()?;
        let slots = varied
            .iter()
            .map(|name| self.program.find_parameter(name))
            .collect::<Result<_, _>>()?;
        let mut system = self.program.system();
        system.observe_only(&positions);
        for (parameter, value) in &self.values {
            system.set_parameter(*parameter, *value)?;
        }
        let sensitivities = self.sensitivities.clone();
        let solves = OnceCell::new();
        Ok(Box::new(CompiledInstance { system, slots, positions, solves, sensitivities }))
    }
}

struct CompiledInstance {
    system: System,
    /// Positions of the varied parameters.
    slots: Vec<usize>,
    /// Positions of the observed variables.
    positions: Vec<usize>,
    /// Whether relations that the observed variables need compare solved variables.
    solves: OnceCell<bool>,
    sensitivities: Arc<Sensitivities>,
}

impl Instance for CompiledInstance {
    fn set(&mut self, genome: &[f64]) -> Result<(), Fault> {
        let mut pairs = self.slots.iter().zip(genome);
        pairs.try_for_each(|(&slot, &value)| self.system.set_parameter(slot, value))
    }

    fn simulate(
        &mut self,
        simulator: &mut Simulator,
        settings: &Settings,
        out: &mut Trajectory,
    ) -> Result<Statistics, SimError> {
        simulator.run(&mut self.system, settings, out)
    }

    fn allow_missing_values(&mut self) {
        self.system.allow_missing_values();
    }

    fn is_static(&mut self) -> bool {
        self.system.n_differential() == 0
    }

    fn system(&mut self) -> Option<&mut dyn DaeSystem> {
        Some(&mut self.system)
    }

    fn observe_in_time(
        &mut self,
        time: f64,
        unknowns: &[f64],
        out: &mut [f64],
    ) -> Result<(), Failure> {
        let program = self.system.program();
        let solves = *self.solves.get_or_init(|| !program.switches_at_known_times(&self.positions));
        self.system.observe_in_time((time, unknowns), solves, out)
    }

    fn differentiate(&mut self, with_derivatives: bool) -> Result<(), String> {
        self.system.differentiate(None);
        if with_derivatives {
            let program = self.system.program();
            let code = self.sensitivities.code(program, &self.slots, &self.positions)?;
            self.system.differentiate(Some(&code));
        }
        Ok(())
    }

    fn sensitivity_refusal(&self) -> Option<String> {
        self.system.sensitivity_refusal().map(str::to_owned)
    }

    fn diagnostic(&self, error: &SimError) -> Option<Diagnostic> {
        Some(self.system.program().explain(error))
    }

    fn explain(&self, error: &SimError) -> String {
        let message = self.system.explain_cause(error).message.clone();
        // The time is kept apart, so that equal causes can be counted.
        let when = format!("at t = {}", error.time);
        let shortened = message.replace(&format!(" ({when})"), "").replace(&format!(" {when}"), "");
        shortened.trim_end().to_owned()
    }
}
