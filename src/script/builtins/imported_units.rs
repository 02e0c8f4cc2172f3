//! Functional mock-up units that a script has imported: simulated under their names as models are.

use crate::diag::{At, Diagnostic, Fault};
use crate::errors::BAD_ARGUMENT;
use crate::fmi::import::{Imported, Samples};
use crate::models::imported::{self, Given};
use crate::models::simulation::{Simulated, SimulationOptions, Unfinished};
use crate::runs::problem::inputs_of;
use crate::source::SourceId;
use crate::syntax::ast::{Argument, Binding};
use crate::syntax::{parse_class_with_modification, print};
use crate::{Session, bail};
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

/// Units that a script has imported, by the names under which it simulates them.
#[derive(Default)]
struct Units(BTreeMap<String, Arc<Imported>>);

/// Notes a unit that was imported under a name.
pub(super) fn keep(session: &mut Session, name: String, unit: Arc<Imported>) {
    session.extension::<Units>().0.insert(name, unit);
}

/// An imported unit with values for its variables.
pub(super) struct ImportedUnit {
    unit: Arc<Imported>,
    given: Given,
    inputs: Vec<Samples>,
}

impl ImportedUnit {
    /// What its description says of the experiment.
    pub(super) fn experiment(&self) -> crate::flatten::Experiment {
        self.unit.description.experiment.annotation()
    }

    /// Gives a variable a value, which is written as text.
    pub(super) fn set_text(&mut self, name: &str, text: &str) -> Result<(), Fault> {
        self.given.add(&self.unit, name, text)
    }

    /// Gives a variable a value.
    pub(super) fn set(&mut self, name: &str, value: f64) -> Result<(), Fault> {
        self.given.set(&self.unit, name, value)
    }

    /// Lets its inputs follow the columns of a file.
    pub(super) fn follow(&mut self, session: &mut Session, file: &str) -> Result<(), Diagnostic> {
        self.inputs = inputs_of(session, &self.unit, (Path::new(file), Some("linear")))?.samples;
        Ok(())
    }

    /// Simulates it.
    pub(super) fn simulate(
        &self,
        session: &mut Session,
        options: &SimulationOptions,
    ) -> Result<Simulated, Unfinished> {
        let at = session.call_site();
        let model = imported::model(&self.unit, self.given.clone(), self.inputs.clone()).at(at)?;
        imported::simulate(session, &model, options)
    }
}

/// The unit that a problem, `Name` or `Name(modification)`, means; `None` where no unit was imported
/// under this name.
///
/// # Errors
/// Values that the unit does not take.
pub(super) fn unit_of(
    session: &mut Session,
    problem: &str,
) -> Result<Option<ImportedUnit>, Vec<Diagnostic>> {
    let name = problem.split('(').next().unwrap_or(problem).trim();
    let Some(unit) = session.extension::<Units>().0.get(name).cloned() else { return Ok(None) };
    let at = session.call_site();
    let parsed = parse_class_with_modification(SourceId::NONE, problem);
    let (_, arguments) = parsed.map_err(|error| vec![error.or_at(at)])?;
    let mut own = ImportedUnit { unit, given: Given::default(), inputs: Vec::new() };
    give(&mut own, "", &arguments).at(at).map_err(|error| vec![error])?;
    Ok(Some(own))
}

/// Gives the values of a modification.
fn give(unit: &mut ImportedUnit, prefix: &str, arguments: &[Argument]) -> Result<(), Fault> {
    for argument in arguments {
        let Argument::Element(element) = argument else {
            bail!(BAD_ARGUMENT, "nothing of `{}` can be redeclared: it is an FMU", unit.unit.file);
        };
        let name = format!("{prefix}{}", element.name.node);
        let Some(modification) = &element.modification else { continue };
        give(unit, &format!("{name}."), &modification.arguments)?;
        if let Some(Binding::Expression(value)) = &modification.binding {
            unit.set_text(&name, &print::expression(value))?;
        }
    }
    Ok(())
}
