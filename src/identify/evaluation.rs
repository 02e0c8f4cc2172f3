//! Simulates whole populations, spread over all cores; what comes out does not depend on how many.

use super::errors::{
    AMBIGUOUS_OUTPUT, BAD_DATA, FIXED_PARAMETER, NO_PARAMETERS, PARAMETER_NOT_FOUND, UNKNOWN_OUTPUT,
};
use super::model::{Model, Parameter};
use super::plan::TIME;
use super::problem::{
    Experiment, Failed, ModelSimulator, NOISE_OF_FORMULAS, Observation, Simulate,
};
use super::ranks::{Asked, Batch, Processors};
use super::simulators::Simulators;
use super::{Descriptions, Quantity, Study};
use crate::diag::{Fault, suggest};
use crate::ga::Genomes;
use crate::ga::errors::{BAD_RANGE, SIZE_MISMATCH};
use crate::registry::BAD_OPTION;
use crate::sim::Settings;
use crate::{bail, fault};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// What is varied and what is compared.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Question {
    /// The identified parameters, one for each gene; empty for all tunable ones at the top level.
    pub parameters: Vec<String>,
    /// The variable that `x` holds values of.
    pub x_name: String,
    /// The variable that was measured; empty for the only top-level output.
    pub y_name: String,
    /// The measured points.
    pub x: Vec<f64>,
}

/// Simulates populations of one model; made once and used for all generations.
pub struct Evaluator {
    study: Arc<Study>,
    model: Arc<dyn Model>,
    parameters: Vec<Parameter>,
    x: Vec<f64>,
    simulators: Simulators,
    settings: Settings,
    noise: f64,
}

/// The simulated values of a population.
#[derive(Debug, Clone, PartialEq)]
pub struct Simulated {
    /// Y at the measured points, one row for each individual; NaN where the simulation failed.
    pub rows: Vec<f64>,
    /// Why it failed; `None` where it did not.
    pub failures: Vec<Option<Failed>>,
}

impl Simulated {
    /// Why each simulation failed, as text; empty where it did not.
    pub fn messages(&self) -> Vec<String> {
        let text = |failed: &Failed| failed.to_string();
        self.failures.iter().map(|failure| failure.as_ref().map_or(String::new(), text)).collect()
    }
}

impl Evaluator {
    /// Prepares to answer `question` with `threads` threads.
    ///
    /// # Errors
    ///
    /// Parameters and variables that the model does not have, parameters that cannot vary, no
    /// measured points or points that are not finite, points that the simulation cannot reach.
    pub fn new(
        shared: Arc<dyn Model>,
        question: Question,
        threads: usize,
    ) -> Result<Evaluator, Fault> {
        Evaluator::on(shared, question, &Processors::threads(threads))
    }

    /// Prepares to answer `question` with the threads of this process and with other ranks.
    ///
    /// # Errors
    ///
    /// Those of [`Evaluator::new`]; `ranks-differ` where a rank cannot make the simulator.
    pub fn on(
        shared: Arc<dyn Model>,
        question: Question,
        processors: &Processors,
    ) -> Result<Evaluator, Fault> {
        let model = shared.as_ref();
        check_points(&question.x)?;
        let parameters = identified_parameters(model, &question.parameters)?;
        let x = x_quantity(model, &question.x_name)?;
        let y = y_quantity(model, &question.y_name)?;
        let experiment = Experiment {
            name: String::new(),
            settings: model.settings(),
            model: Arc::clone(&shared),
            deviations: 0,
            second_attempt: false,
            x_name: x.name.clone(),
            observations: vec![Observation { y_name: y.name.clone(), x: question.x.clone() }],
            parameters: parameters.iter().map(|p| p.name.clone()).enumerate().collect(),
        };
        let mut one = ModelSimulator::new(std::slice::from_ref(&experiment))?;
        let settings = one.settings().clone();
        // Relative error of the simulated values: the solver's, where anything is integrated.
        let noise = if one.is_static() { NOISE_OF_FORMULAS } else { settings.tolerance };
        let simulator = || {
            let one = ModelSimulator::new(std::slice::from_ref(&experiment))?;
            Ok(Box::new(one) as Box<dyn Simulate>)
        };
        let quantity = |p: &Parameter| Quantity { name: p.name.clone(), unit: p.unit.clone() };
        let mut descriptions = Descriptions::default();
        descriptions.add(shared.as_ref(), [x.name.as_str(), y.name.as_str()]);
        let study = Study {
            model: shared.name().to_owned(),
            parameters: parameters.iter().map(quantity).collect(),
            descriptions,
            x,
            y,
            changes: 0,
        };
        Ok(Evaluator {
            study: Arc::new(study),
            simulators: Simulators::on(processors, simulator)?,
            model: shared,
            parameters,
            x: question.x,
            settings,
            noise,
        })
    }

    /// What the simulation is asked for, as a text that is the same where the settings are.
    pub fn settings_text(&self) -> String {
        let s = &self.settings;
        format!(
            "{:?}",
            (
                s.start,
                s.stop,
                s.tolerance,
                s.method.name,
                s.step,
                s.initial_step,
                s.max_step,
                s.treats_chattering,
                s.max_steps
            )
        )
    }

    /// The same for a model that was found changed so often.
    pub fn of_changed_model(mut self, changes: u32) -> Evaluator {
        Arc::make_mut(&mut self.study).changes = changes;
        self
    }

    /// What is simulated.
    pub fn study(&self) -> &Arc<Study> {
        &self.study
    }

    /// The model.
    pub fn model(&self) -> &Arc<dyn Model> {
        &self.model
    }

    /// Relative error of the simulated values: the solver's, where anything is integrated.
    pub fn noise(&self) -> f64 {
        self.noise
    }

    /// From now on simulations end when the flag is set.
    pub fn cancel_by(&mut self, flag: Option<Arc<AtomicBool>>) {
        self.simulators.cancel_by(flag);
    }

    /// Whether simulations were cancelled; what was answered then is not used.
    pub fn is_cancelled(&self) -> bool {
        self.simulators.is_cancelled()
    }

    /// Why other ranks take no part, in words that follow on "because".
    pub fn alone(&self) -> Option<&str> {
        self.simulators.alone()
    }

    /// The measured points.
    pub fn x(&self) -> &[f64] {
        &self.x
    }

    /// Simulates every individual. One that fails does not end the others.
    ///
    /// # Errors
    ///
    /// `population-size-mismatch` when there is not one gene for each parameter, `bad-range` when
    /// a gene lies outside what the model allows for its parameter.
    pub fn evaluate(&self, genomes: &Genomes) -> Result<Simulated, Fault> {
        self.check_genomes(genomes)?;
        let batch = Batch {
            values: genomes.values(),
            parameters: genomes.n_genes(),
            points: self.x.len(),
            asked: Asked::Points,
            tolerance: self.simulators.tolerance(),
        };
        let found = self.simulators.simulate(&batch, |found| (found.row, found.failed));
        let (rows, failures): (Vec<Vec<f64>>, Vec<_>) = found.into_iter().unzip();
        Ok(Simulated { rows: rows.concat(), failures })
    }

    fn check_genomes(&self, genomes: &Genomes) -> Result<(), Fault> {
        let (genes, parameters) = (genomes.n_genes(), self.parameters.len());
        if genes != parameters {
            let names: Vec<&str> = self.parameters.iter().map(|p| p.name.as_str()).collect();
            bail!(
                SIZE_MISMATCH,
                "the population has {genes} columns, but {parameters} parameters are estimated: {}",
                names.join(", ");
                help: "use one search range and one column per parameter"
            );
        }
        for (individual, genome) in genomes.rows().enumerate() {
            for (value, parameter) in genome.iter().zip(&self.parameters) {
                let Parameter { name, min, max, .. } = parameter;
                if !(*min..=*max).contains(value) {
                    bail!(
                        BAD_RANGE,
                        "individual {} has `{name}` = {value}, but `{}` allows {min} to {max}",
                        individual + 1,
                        self.study.model;
                        help: "correct the search range of `{name}`, or its `min` and `max` in the \
                               model"
                    );
                }
            }
        }
        Ok(())
    }
}

fn check_points(x: &[f64]) -> Result<(), Fault> {
    if x.is_empty() {
        bail!(BAD_DATA, "there are no measured points"; help: "read them with `Exp_Adq_SISO`");
    }
    match x.iter().position(|value| !value.is_finite()) {
        Some(k) => {
            bail!(BAD_DATA, "measured X value {} is {}", k + 1, x[k]; help: "remove this point")
        }
        None => Ok(()),
    }
}

fn identified_parameters(model: &dyn Model, names: &[String]) -> Result<Vec<Parameter>, Fault> {
    let all = model.parameters();
    if names.is_empty() {
        let found: Vec<Parameter> = all.into_iter().filter(|p| p.tunable && p.top_level).collect();
        if found.is_empty() {
            bail!(
                NO_PARAMETERS,
                "`{}` has no tunable top-level parameters", model.name();
                help: "give the parameters to be estimated with `Parameter_Names`"
            );
        }
        return Ok(found);
    }
    let known = || all.iter().filter(|p| p.tunable).map(|parameter| parameter.name.as_str());
    let find = |name: &String| match all.iter().find(|parameter| parameter.name == *name) {
        Some(parameter) if parameter.tunable => Ok(parameter.clone()),
        Some(_) => Err(fault!(
            FIXED_PARAMETER,
            "`{name}` is fixed when `{}` is translated and cannot be estimated", model.name();
            help: "set it by a modification of the model's name, such as `M({name} = 1)`"
        )),
        None => Err(fault!(PARAMETER_NOT_FOUND, "`{}` has no parameter `{name}`", model.name())
            .help_if(suggest::did_you_mean(name, known()))
            .help(format!("its parameters: {}", known().collect::<Vec<_>>().join(", ")))),
    };
    if let Some(k) = (1..names.len()).find(|&k| names[..k].contains(&names[k])) {
        bail!(
            BAD_OPTION,
            "parameter `{}` is named twice: a parameter has one gene", names[k];
            help: "give each parameter once in `Parameter_Names`, and one column of the population for it"
        );
    }
    names.iter().map(find).collect()
}

fn x_quantity(model: &dyn Model, name: &str) -> Result<Quantity, Fault> {
    if name.is_empty() || name == TIME {
        return Ok(Quantity { name: TIME.to_owned(), unit: "s".to_owned() });
    }
    quantity(model, name)
}

fn y_quantity(model: &dyn Model, name: &str) -> Result<Quantity, Fault> {
    if !name.is_empty() {
        return quantity(model, name);
    }
    match model.outputs().as_slice() {
        [output] => quantity(model, output),
        [] => bail!(
            AMBIGUOUS_OUTPUT,
            "`{}` has no top-level output", model.name();
            help: "give the measured variable with `Y_Name`"
        ),
        several => bail!(
            AMBIGUOUS_OUTPUT,
            "`{}` has several outputs: {}", model.name(), several.join(", ");
            help: "give the measured one with `Y_Name`"
        ),
    }
}

fn quantity(model: &dyn Model, name: &str) -> Result<Quantity, Fault> {
    match model.unit(name) {
        Some(unit) => Ok(Quantity { name: name.to_owned(), unit }),
        None => {
            let names = model.names();
            let hint = suggest::did_you_mean(name, names.iter().map(String::as_str));
            let few = || format!("its variables: {}", names.join(", "));
            let hint = hint.or_else(|| (1..=12).contains(&names.len()).then(few));
            Err(fault!(UNKNOWN_OUTPUT, "`{}` has no Real variable `{name}`", model.name())
                .help_if(hint))
        }
    }
}
