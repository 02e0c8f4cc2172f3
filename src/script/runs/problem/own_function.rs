//! Functions written in Modelica that a run calls: numbers in, numbers out.
//!
//! A function is compiled as part of a model whose parameters are its inputs, so that it may use
//! whatever functions of models may use, and runs on every thread.

use crate::Session;
use crate::bail;
use crate::diag::{Diagnostic, Fault};
use crate::eval::{Callee, Function};
use crate::identify::{CompiledModel, Instance, Model};
use crate::models::simulation;
use crate::name::Name;
use crate::registry::{BAD_OPTION, UserFunction};
use crate::sim::{Settings, Simulator, Trajectory};
use crate::source::Span;
use std::sync::{Arc, Mutex, PoisonError};

/// The model around a function.
pub(super) struct Around<'a> {
    /// What the function is for, in messages.
    pub purpose: &'a str,
    /// The function.
    pub name: &'a str,
    /// Declarations and equations of the model.
    pub body: String,
    /// The parameters that its inputs are, scalar by scalar.
    pub inputs: Vec<String>,
    /// The variables that its outputs are, scalar by scalar.
    pub outputs: Vec<String>,
}

/// A compiled function.
pub(super) struct OwnFunction {
    model: CompiledModel,
    inputs: Vec<String>,
    outputs: Vec<String>,
    settings: Settings,
    /// Those that are unused now.
    idle: Mutex<Vec<Worker>>,
}

struct Worker {
    instance: Box<dyn Instance>,
    simulator: Simulator,
    trajectory: Trajectory,
}

/// The function of this name, if one is loaded.
pub(crate) fn function(
    session: &mut Session,
    name: &str,
) -> Result<Option<Arc<Function>>, Diagnostic> {
    Ok(match crate::eval::Host::callee(session, &Name::parse(name))? {
        Some(Callee::Function(function)) => Some(function),
        _ => None,
    })
}

impl OwnFunction {
    /// Compiles a function.
    ///
    /// # Errors
    ///
    /// What is wrong with the model around it, such as a function that models cannot call.
    pub(super) fn compiled(
        session: &mut Session,
        around: Around<'_>,
    ) -> Result<OwnFunction, Vec<Diagnostic>> {
        let Around { purpose, name, body, inputs, outputs } = around;
        let capital = purpose.split(' ').map(|word| word[..1].to_uppercase() + &word[1..]);
        let class = format!("GAPILib{}_{}", capital.collect::<String>(), name.replace('.', "_"));
        let text = format!("model {class}\n{body}end {class};\n");
        session.load_text(&format!("{purpose} {name}"), &text)?;
        let translated = simulation::translated(session, &class)?;
        let model = CompiledModel::new(name, translated.program.clone());
        let settings = Settings { start: 0.0, stop: 0.0, ..Settings::default() };
        let own = OwnFunction { model, inputs, outputs, settings, idle: Mutex::default() };
        // What is wrong shows before the run.
        let worker = own.worker().map_err(|fault| vec![fault.at(Span::NONE)])?;
        own.give_back(worker);
        Ok(own)
    }

    fn worker(&self) -> Result<Worker, Fault> {
        let idle = self.idle.lock().unwrap_or_else(PoisonError::into_inner).pop();
        match idle {
            Some(worker) => Ok(worker),
            None => Ok(Worker {
                instance: self.model.instance(&self.inputs, &self.outputs)?,
                simulator: Simulator::new(),
                trajectory: Trajectory::default(),
            }),
        }
    }

    fn give_back(&self, worker: Worker) {
        self.idle.lock().unwrap_or_else(PoisonError::into_inner).push(worker);
    }

    fn outputs(&self, worker: &mut Worker, inputs: &[f64]) -> Result<Vec<f64>, Fault> {
        let Worker { instance, simulator, trajectory } = worker;
        instance.set(inputs)?;
        if let Err(error) = instance.simulate(simulator, &self.settings, trajectory) {
            bail!(BAD_OPTION, "{}", instance.explain(&error));
        }
        let first = |k: usize| trajectory.column(k).first().copied().unwrap_or(f64::NAN);
        Ok((0..self.outputs.len()).map(first).collect())
    }
}

impl UserFunction for OwnFunction {
    fn call(&self, inputs: &[f64]) -> Result<Vec<f64>, Fault> {
        let mut worker = self.worker()?;
        let outputs = self.outputs(&mut worker, inputs);
        self.give_back(worker);
        outputs
    }
}
