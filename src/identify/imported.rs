//! Functional mock-up units as models to identify.

use super::model::settings_of;
use super::{Instance, Model, Parameter};
use crate::diag::Fault;
use crate::errors::UNKNOWN_OUTPUT;
use crate::fault;
use crate::fmi::description::{Causality, Variable};
use crate::fmi::import::{
    Directions, FailureClass, Imported, InterfaceKind, Layout, NumberedPlan, Place, Plan, Samples,
    is_parameter, is_recorded, starts, why_not_set,
};
use crate::sim::{
    DaeSystem, Failure, Settings, SimError, SimErrorKind, Simulator, Statistics, Trajectory,
};
use crate::units::Definitions;
use std::sync::Arc;

/// A unit with what an experiment sets.
#[derive(Clone)]
pub struct ImportedModel {
    unit: Arc<Imported>,
    layout: Arc<Layout>,
    numbers: Vec<(Place, f64)>,
    strings: Vec<(usize, Vec<String>)>,
    inputs: Vec<Samples>,
}

impl ImportedModel {
    /// A unit whose scalars have these values instead of their start values.
    ///
    /// # Errors
    ///
    /// Sizes of arrays that are not known, in one sentence.
    pub fn new(
        unit: Arc<Imported>,
        numbers: Vec<(Place, f64)>,
        strings: Vec<(usize, Vec<String>)>,
        inputs: Vec<Samples>,
    ) -> Result<ImportedModel, String> {
        let layout = Arc::new(unit.layout(&numbers)?);
        Ok(ImportedModel { unit, layout, numbers, strings, inputs })
    }

    /// The unit.
    pub fn unit_of(&self) -> &Arc<Imported> {
        &self.unit
    }

    /// Its scalars.
    pub fn layout(&self) -> &Layout {
        &self.layout
    }

    /// The value that a scalar starts with.
    pub fn start(&self, place: Place) -> f64 {
        let given = self.numbers.iter().find(|(known, _)| *known == place);
        given.map_or_else(
            || {
                let count = self.layout.count(place.variable);
                let starts = starts(self.unit.variable(place), count);
                starts.get(place.element).copied().unwrap_or(0.0)
            },
            |(_, value)| *value,
        )
    }

    /// A plan of simulations in which these scalars vary and those are recorded.
    ///
    /// # Errors
    ///
    /// Names that the unit does not have, and what cannot vary.
    pub fn planned(&self, varied: &[String], observed: &[String]) -> Result<NumberedPlan, Fault> {
        for name in varied {
            if let Some(why) = self.variable(name).and_then(why_not_set) {
                return Err(fault!(UNKNOWN_OUTPUT, "`{name}` {why}"));
            }
        }
        Ok(self.unit.pool.plan(self.plan(varied, observed)?))
    }

    fn plan(&self, varied: &[String], observed: &[String]) -> Result<Plan, Fault> {
        Ok(Plan {
            kind: self.unit.kind,
            numbers: self.numbers.clone(),
            strings: self.strings.clone(),
            varied: self.places(varied)?,
            inputs: self.inputs.clone(),
            observed: self.places(observed)?,
            differentiates: false,
        })
    }

    fn variable(&self, name: &str) -> Option<&Variable> {
        self.layout.find(name).map(|place| self.unit.variable(place))
    }

    /// The places of what is recorded and varied.
    ///
    /// # Errors
    ///
    /// Names that the unit does not have, and values that it does not take.
    fn places(&self, names: &[String]) -> Result<Vec<Place>, Fault> {
        let known = self.layout.scalars().iter().map(|scalar| scalar.name.as_str());
        let place = |name: &String| {
            self.layout.find(name).ok_or_else(|| {
                let fault = fault!(UNKNOWN_OUTPUT, "`{}` has no variable `{name}`", self.name());
                fault.help_if(crate::diag::suggest::did_you_mean(name, known.clone()))
            })
        };
        names.iter().map(place).collect()
    }
}

impl Model for ImportedModel {
    fn name(&self) -> &str {
        &self.unit.file
    }

    fn parameters(&self) -> Vec<Parameter> {
        let scalars = self.layout.scalars().iter();
        let own = scalars.map(|scalar| (scalar, self.unit.variable(scalar.place)));
        own.filter(|(_, variable)| is_parameter(variable))
            .map(|(scalar, variable)| {
                let attributes = self.unit.description.attributes_of(variable);
                Parameter {
                    name: scalar.name.clone(),
                    unit: attributes.unit.unwrap_or_default(),
                    min: attributes.min.unwrap_or(f64::NEG_INFINITY),
                    max: attributes.max.unwrap_or(f64::INFINITY),
                    tunable: variable.kind.is_float(),
                    top_level: !scalar.name.contains('.'),
                }
            })
            .collect()
    }

    fn outputs(&self) -> Vec<String> {
        let is_output = |place| self.unit.variable(place).causality == Causality::Output;
        let scalars = self.layout.scalars().iter().filter(|scalar| is_output(scalar.place));
        scalars.map(|scalar| scalar.name.clone()).collect()
    }

    fn names(&self) -> Vec<String> {
        let has = |place| is_recorded(self.unit.variable(place));
        let scalars = self.layout.scalars().iter().filter(|scalar| has(scalar.place));
        scalars.map(|scalar| scalar.name.clone()).collect()
    }

    fn unit(&self, variable: &str) -> Option<String> {
        let variable = self.variable(variable)?;
        Some(self.unit.description.attributes_of(variable).unit.unwrap_or_default())
    }

    fn unit_definitions(&self) -> Definitions {
        self.unit.description.unit_definitions()
    }

    fn description(&self, variable: &str) -> Option<String> {
        self.variable(variable)?.description.clone()
    }

    fn is_relative(&self, variable: &str) -> bool {
        let relative = |own| self.unit.description.attributes_of(own).is_relative;
        self.variable(variable).and_then(relative).unwrap_or(false)
    }

    fn depends_on_time_alone(&self, _variable: &str, _varied: &[String]) -> bool {
        false
    }

    fn settings(&self) -> Settings {
        settings_of(self.unit.description.experiment)
    }

    fn has_stop_time(&self) -> bool {
        self.unit.description.experiment.stop.is_some()
    }

    fn instance(&self, varied: &[String], observed: &[String]) -> Result<Box<dyn Instance>, Fault> {
        let (plain, unit) = (self.plan(varied, observed)?, self.unit.clone());
        let with_derivatives = Plan { differentiates: true, ..plain.clone() };
        Ok(Box::new(ImportedInstance {
            refusal: Directions::of(&unit.description, &plain).err(),
            plans: [plain, with_derivatives].map(|plan| unit.pool.plan(plan)),
            unit,
            differentiates: false,
            values: Vec::new(),
            cause: String::new(),
            is_hopeless: false,
        }))
    }

    fn portable(&self) -> Result<super::PortableModel, String> {
        Err("is an FMU, which runs on this rank alone".to_owned())
    }
}

/// Simulations of a unit in another process.
struct ImportedInstance {
    unit: Arc<Imported>,
    /// Without and with derivatives.
    plans: [NumberedPlan; 2],
    differentiates: bool,
    /// Why there are no derivatives, once that is known.
    refusal: Option<String>,
    values: Vec<f64>,
    /// Why the last simulation failed.
    cause: String,
    /// Whether it was one of many whose calls did not return.
    is_hopeless: bool,
}

impl Instance for ImportedInstance {
    fn set(&mut self, genome: &[f64]) -> Result<(), Fault> {
        self.values = genome.to_vec();
        Ok(())
    }

    fn simulate(
        &mut self,
        _: &mut Simulator,
        settings: &Settings,
        out: &mut Trajectory,
    ) -> Result<Statistics, SimError> {
        let plan = &self.plans[usize::from(self.differentiates)];
        let asked = (plan, self.values.as_slice());
        self.unit.pool.simulate(asked, settings, out).map_err(|failure| {
            if failure.class == FailureClass::Derivatives {
                self.refusal = Some(failure.message.clone());
            }
            self.is_hopeless = failure.class == FailureClass::Hopeless;
            self.cause = failure.message;
            SimError { time: failure.time, kind: kind(failure.class), offending: None }
        })
    }

    fn is_static(&mut self) -> bool {
        let states = &self.unit.description.structure.derivatives;
        self.unit.kind == InterfaceKind::ModelExchange && states.is_empty()
    }

    fn system(&mut self) -> Option<&mut dyn DaeSystem> {
        None
    }

    fn differentiate(&mut self, with_derivatives: bool) -> Result<(), String> {
        let refusal = self.refusal.clone().filter(|_| with_derivatives);
        self.differentiates = with_derivatives && refusal.is_none();
        refusal.map_or(Ok(()), Err)
    }

    fn sensitivity_refusal(&self) -> Option<String> {
        self.refusal.clone().filter(|_| self.differentiates)
    }

    fn is_hopeless(&self) -> bool {
        self.is_hopeless
    }

    fn explain(&self, _: &SimError) -> String {
        self.cause.clone()
    }
}

fn kind(class: FailureClass) -> SimErrorKind {
    match class {
        FailureClass::Instance
        | FailureClass::Unit
        | FailureClass::Derivatives
        | FailureClass::Process
        | FailureClass::Hopeless => {
            SimErrorKind::Evaluation(Failure::Function { function: 0, at: 0, reason: 0 })
        }
        FailureClass::Solver => SimErrorKind::StepSize,
        FailureClass::Steps => SimErrorKind::StepBudget,
        FailureClass::Time => SimErrorKind::TimeBudget,
        FailureClass::Cancelled => SimErrorKind::Cancelled,
    }
}
