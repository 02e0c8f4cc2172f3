//! Fitness functions that are written in Modelica: any function of the simulated and the measured
//! points, and of their weights if it wants them.
//!
//! A function is compiled as part of a model whose parameters are the simulated points, so that it
//! may use whatever functions of models may use, and runs on every thread.

use crate::bail;
use crate::diag::{Diagnostic, Fault};
use crate::eval::{Callee, Host};
use crate::ga::FAILED_FITNESS;
use crate::identify::fitness::Fitness;
use crate::identify::problem::Series;
use crate::identify::{CompiledModel, Instance, Model};
use crate::name::Name;
use crate::registry::BAD_OPTION;
use crate::script::Session;
use crate::script::models::simulation;
use crate::sim::{Settings, Simulator, Trajectory};
use crate::source::Span;
use std::sync::{Mutex, PoisonError};

/// The output of the model around the function.
const OUTPUT: &str = "gapi_fitness";

/// A compiled function.
pub(super) struct OwnFitness {
    model: CompiledModel,
    varied: Vec<String>,
    settings: Settings,
    /// Those that nobody uses now.
    idle: Mutex<Vec<Worker>>,
}

struct Worker {
    instance: Box<dyn Instance>,
    simulator: Simulator,
    trajectory: Trajectory,
}

/// Whether a function of this name is loaded.
pub(super) fn is_function(session: &mut Session, name: &str) -> bool {
    matches!(session.callee(&Name::parse(name)), Ok(Some(Callee::Function(_))))
}

/// Compiles the function `name` for the measured points of `series`.
///
/// # Errors
///
/// A function with other inputs, or one that models cannot call.
pub(super) fn compiled(
    session: &mut Session,
    name: &str,
    series: &[Series],
) -> Result<OwnFitness, Vec<Diagnostic>> {
    let one = |fault: Fault| vec![fault.at(Span::NONE)];
    let inputs = match session.callee(&Name::parse(name)) {
        Ok(Some(Callee::Function(function))) => function.inputs.len(),
        Ok(_) => 0,
        Err(diagnostic) => return Err(vec![diagnostic]),
    };
    let list = |values: &mut dyn Iterator<Item = f64>| {
        values.map(|value| format!("{value:e}")).collect::<Vec<_>>().join(", ")
    };
    let measured = list(&mut series.iter().flat_map(|series| series.y.iter().copied()));
    let weights = list(&mut series.iter().flat_map(Series::weights));
    let arguments = match inputs {
        2 => format!("gapi_simulated, {{{measured}}}"),
        3 => format!("gapi_simulated, {{{measured}}}, {{{weights}}}"),
        _ => return Err(one(wrong_inputs(name, inputs))),
    };
    let n: usize = series.iter().map(|series| series.y.len()).sum();
    let class = format!("GAPILibFitness_{}", name.replace('.', "_"));
    let text = format!(
        "model {class}\n  parameter Real gapi_simulated[{n}] = zeros({n});\n  output Real {OUTPUT} = {name}({arguments});\nend {class};\n"
    );
    session.load_text(&format!("fitness function {name}"), &text)?;
    let translated = simulation::translated(session, &class)?;
    let model = CompiledModel::new(name, translated.program.clone());
    let varied = (1..=n).map(|k| format!("gapi_simulated[{k}]")).collect();
    let settings = Settings { start: 0.0, stop: 0.0, ..Settings::default() };
    let own = OwnFitness { model, varied, settings, idle: Mutex::new(Vec::new()) };
    // What is wrong shows before the run.
    let worker = own.worker().map_err(one)?;
    own.give_back(worker);
    Ok(own)
}

fn wrong_inputs(name: &str, inputs: usize) -> Fault {
    let fault =
        Fault::new(BAD_OPTION, format!("the fitness function `{name}` has {inputs} inputs"));
    fault.help("give it `input Real simulated[:]`, `input Real measured[:]` and, if wanted, `input Real weights[:]`")
}

impl OwnFitness {
    fn worker(&self) -> Result<Worker, Fault> {
        let idle = self.idle.lock().unwrap_or_else(PoisonError::into_inner).pop();
        match idle {
            Some(worker) => Ok(worker),
            None => Ok(Worker {
                instance: self.model.instance(&self.varied, &[OUTPUT.to_owned()])?,
                simulator: Simulator::new(),
                trajectory: Trajectory::default(),
            }),
        }
    }

    fn give_back(&self, worker: Worker) {
        self.idle.lock().unwrap_or_else(PoisonError::into_inner).push(worker);
    }

    fn value(&self, worker: &mut Worker, simulated: &[f64]) -> Result<f64, Fault> {
        let Worker { instance, simulator, trajectory } = worker;
        instance.set(simulated)?;
        if let Err(error) = simulator.run(instance.system(), &self.settings, trajectory) {
            bail!(BAD_OPTION, "{}", instance.explain(&error));
        }
        Ok(trajectory.column(0).first().copied().unwrap_or(f64::NAN))
    }
}

impl Fitness for OwnFitness {
    fn fitness(&self, simulated: &[f64], _measured: &[f64], _weights: &[f64]) -> f64 {
        if simulated.iter().any(|value| !value.is_finite()) {
            return FAILED_FITNESS;
        }
        let Ok(mut worker) = self.worker() else { return FAILED_FITNESS };
        let value = self.value(&mut worker, simulated);
        self.give_back(worker);
        // A function that fails has rated nothing; it counts as a failed simulation.
        value.ok().filter(|value| *value < FAILED_FITNESS).unwrap_or(FAILED_FITNESS)
    }

    fn least_squares(&self, _measured: &[f64], _weights: &[f64]) -> Option<Vec<f64>> {
        None
    }
}
