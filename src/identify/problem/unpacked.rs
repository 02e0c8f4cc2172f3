//! Simulators made from what another process has written.

use super::inference::adjusted_from;
use super::portable::{Portable, PortableExperiment};
use super::{Experiment, ModelSimulator, Observation, Simulate};
use crate::codegen::Program;
use crate::diag::Fault;
use crate::fault;
use crate::registry::BAD_OPTION;
use crate::{CompiledModel, Model, PortableModel, SpectrumModel};
use std::sync::Arc;

/// The simulator; `clock` measures the budgets of time.
///
/// # Errors
///
/// `bad-option` where the bytes are not those of a program of this version; what
/// [`ModelSimulator::new`] refuses.
pub(crate) fn unpacked(portable: Portable, clock: fn() -> f64) -> Result<Box<dyn Simulate>, Fault> {
    match portable {
        Portable::Adjusted { inner, adjustments } => {
            adjusted_from(unpacked(*inner, clock)?, &adjustments)
        }
        Portable::Experiments(experiments) => {
            let made: Result<Vec<Experiment>, Fault> =
                experiments.into_iter().map(|own| experiment(own, clock)).collect();
            Ok(Box::new(ModelSimulator::new(&made?)?))
        }
    }
}

fn experiment(portable: PortableExperiment, clock: fn() -> f64) -> Result<Experiment, Fault> {
    Ok(Experiment {
        name: portable.name,
        model: model(portable.model)?,
        settings: portable.settings.settings(clock)?,
        second_attempt: portable.second_attempt,
        x_name: portable.x_name,
        observations: portable
            .observations
            .into_iter()
            .map(|(y_name, x)| Observation { y_name, x })
            .collect(),
        deviations: portable.deviations,
        parameters: portable.parameters,
    })
}

fn model(portable: PortableModel) -> Result<Arc<dyn Model>, Fault> {
    let PortableModel { name, driven, values, program, spectrum } = portable;
    let Some(program) = Program::from_bytes(&program) else {
        return Err(fault!(BAD_OPTION, "the compiled model `{name}` cannot be read"));
    };
    let model = CompiledModel::new(name, program).with_values(values);
    Ok(match (driven, spectrum) {
        (_, Some(spectrum)) => Arc::new(SpectrumModel::new(model, spectrum)),
        (Some((x_name, parameter)), None) => Arc::new(model.driven_by(&x_name, &parameter)),
        (None, None) => Arc::new(model),
    })
}
