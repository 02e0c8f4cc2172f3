//! Writes descriptions, as the schemas of the standard order their elements.

use super::{
    Attributes, BASE_UNITS, BaseUnit, ClockInterval, Description, Dimension, INTERNAL, Interface,
    Kind, Structure, TypeDefinition, Unit, Unknown, Variable, Version,
};
use crate::xml::{Xml, number};
use std::fmt::{Display, Write};

/// The text of `modelDescription.xml`.
pub fn write(description: &Description) -> String {
    let mut xml = Xml::new();
    xml.element("fmiModelDescription", |xml| {
        head(xml, description);
        let version = description.version;
        xml.group("UnitDefinitions", &description.units, unit);
        xml.group("TypeDefinitions", &description.types, |xml, one| {
            type_definition(xml, one, version);
        });
        xml.group("LogCategories", &description.log_categories, |xml, one| {
            xml.element("Category", |xml| {
                xml.attribute("name", &one.name);
                xml.optional("description", one.description.as_ref());
            });
        });
        experiment(xml, description);
        xml.element("ModelVariables", |xml| {
            for one in &description.variables {
                variable(xml, one, description);
            }
        });
        xml.element("ModelStructure", |xml| structure(xml, &description.structure, description));
    });
    xml.text
}

fn head(xml: &mut Xml, description: &Description) {
    let version = description.version;
    let (number, token) = match version {
        Version::V2 => ("2.0", "guid"),
        Version::V3 => ("3.0", "instantiationToken"),
    };
    xml.attribute("fmiVersion", number);
    xml.attribute("modelName", &description.model_name);
    xml.attribute(token, &description.token);
    let strings = [
        ("description", &description.about.description),
        ("author", &description.about.author),
        ("version", &description.about.model_version),
        ("copyright", &description.about.copyright),
        ("license", &description.about.license),
        ("generationTool", &description.about.generation_tool),
        ("generationDateAndTime", &description.about.generation_time),
    ];
    for (name, text) in strings {
        xml.optional(name, text.as_ref());
    }
    if description.has_structured_names {
        xml.attribute("variableNamingConvention", "structured");
    }
    if version == Version::V2 {
        xml.attribute("numberOfEventIndicators", description.event_indicators);
    }
    let kinds = [
        ("ModelExchange", &description.model_exchange),
        ("CoSimulation", &description.co_simulation),
        ("ScheduledExecution", &description.scheduled_execution),
    ];
    for (name, interface) in kinds {
        if let Some(own) = interface {
            xml.element(name, |xml| abilities(xml, name, own, version));
        }
    }
}

fn experiment(xml: &mut Xml, description: &Description) {
    let experiment = description.experiment;
    let values = [
        ("startTime", experiment.start),
        ("stopTime", experiment.stop),
        ("tolerance", experiment.tolerance),
        ("stepSize", experiment.step),
    ];
    if values.iter().any(|(_, value)| value.is_some()) {
        xml.element("DefaultExperiment", |xml| {
            for (name, value) in values {
                xml.optional(name, value.as_ref());
            }
        });
    }
}

fn abilities(xml: &mut Xml, kind: &str, own: &Interface, version: Version) {
    xml.attribute("modelIdentifier", &own.model_identifier);
    let is_2 = version == Version::V2;
    let (state, serial) = match is_2 {
        true => ("canGetAndSetFMUstate", "canSerializeFMUstate"),
        false => ("canGetAndSetFMUState", "canSerializeFMUState"),
    };
    let directional =
        if is_2 { "providesDirectionalDerivative" } else { "providesDirectionalDerivatives" };
    let is_exchange = kind == "ModelExchange";
    let is_co_simulation = kind == "CoSimulation";
    let of_co_simulation_3 = is_co_simulation && !is_2;
    let flags = [
        ("needsExecutionTool", own.needs_execution_tool, true),
        ("canBeInstantiatedOnlyOncePerProcess", own.is_single_instance, true),
        (state, own.can_get_and_set_state, true),
        (serial, own.can_serialize_state, true),
        (directional, own.provides_directional_derivatives, true),
        ("providesAdjointDerivatives", own.provides_adjoint_derivatives, !is_2),
        ("completedIntegratorStepNotNeeded", !own.needs_completed_step, is_exchange && is_2),
        ("needsCompletedIntegratorStep", own.needs_completed_step, is_exchange && !is_2),
        (
            "providesEvaluateDiscreteStates",
            own.provides_evaluate_discrete_states,
            (is_exchange || is_co_simulation) && !is_2,
        ),
        ("canHandleVariableCommunicationStepSize", own.can_handle_variable_steps, is_co_simulation),
        ("canInterpolateInputs", own.can_interpolate_inputs, is_co_simulation && is_2),
        ("providesIntermediateUpdate", own.provides_intermediate_update, of_co_simulation_3),
        ("mightReturnEarlyFromDoStep", own.might_return_early, of_co_simulation_3),
        ("canReturnEarlyAfterIntermediateUpdate", own.can_return_early, of_co_simulation_3),
        ("hasEventMode", own.has_event_mode, of_co_simulation_3),
    ];
    for (name, value, applies) in flags {
        // What is needed in FMI 3.0 unless it is said not to be is said.
        if applies && (value || name == "needsCompletedIntegratorStep") {
            xml.attribute(name, value);
        }
    }
    if is_co_simulation {
        if own.max_output_derivative_order > 0 {
            xml.attribute("maxOutputDerivativeOrder", own.max_output_derivative_order);
        }
        xml.optional("fixedInternalStepSize", own.fixed_internal_step.filter(|_| !is_2).as_ref());
    }
    xml.group("SourceFiles", &own.source_files, |xml, file| {
        xml.element("File", |xml| xml.attribute("name", file));
    });
}

fn unit(xml: &mut Xml, unit: &Unit) {
    xml.element("Unit", |xml| {
        xml.attribute("name", &unit.name);
        if let Some(base) = &unit.base {
            base_unit(xml, "BaseUnit", base);
        }
        for shown in &unit.display_units {
            xml.element("DisplayUnit", |xml| {
                xml.attribute("name", &shown.name);
                xml.unless("factor", shown.factor, 1.0);
                xml.unless("offset", shown.offset, 0.0);
                xml.unless("inverse", shown.is_inverse, false);
            });
        }
    });
}

/// What a unit is in base units of SI.
pub(crate) fn base_unit(xml: &mut Xml, element: &str, base: &BaseUnit) {
    xml.element(element, |xml| {
        for (name, exponent) in BASE_UNITS.iter().zip(base.exponents) {
            xml.unless(name, exponent, 0);
        }
        xml.unless("factor", base.factor, 1.0);
        xml.unless("offset", base.offset, 0.0);
    });
}

/// The name of a type in a version; FMI 2.0 has the nearest one for those that it has not.
fn word(kind: Kind, version: Version) -> &'static str {
    match version {
        Version::V3 => kind.word(),
        Version::V2 => kind.word_2().unwrap_or(match kind {
            Kind::Float32 => "Real",
            Kind::Binary => "String",
            Kind::Clock => "Boolean",
            _ => "Integer",
        }),
    }
}

fn type_definition(xml: &mut Xml, one: &TypeDefinition, version: Version) {
    let naming = |xml: &mut Xml| {
        xml.attribute("name", &one.name);
        xml.optional("description", one.description.as_ref());
    };
    let content = |xml: &mut Xml| {
        attributes(xml, &one.attributes);
        for item in &one.items {
            xml.element("Item", |xml| {
                xml.attribute("name", &item.name);
                xml.attribute("value", item.value);
                xml.optional("description", item.description.as_ref());
            });
        }
    };
    match version {
        Version::V2 => xml.element("SimpleType", |xml| {
            naming(xml);
            xml.element(word(one.kind, version), content);
        }),
        Version::V3 => xml.element(&format!("{}Type", one.kind.word()), |xml| {
            naming(xml);
            content(xml);
        }),
    }
}

fn attributes(xml: &mut Xml, own: &Attributes) {
    xml.optional("quantity", own.quantity.as_ref());
    xml.optional("unit", own.unit.as_ref());
    xml.optional("displayUnit", own.display_unit.as_ref());
    xml.optional("relativeQuantity", own.is_relative.as_ref());
    xml.optional("unbounded", own.is_unbounded.as_ref());
    xml.optional("min", own.min.map(number).as_ref());
    xml.optional("max", own.max.map(number).as_ref());
    xml.optional("nominal", own.nominal.map(number).as_ref());
}

fn variable(xml: &mut Xml, own: &Variable, description: &Description) {
    let version = description.version;
    let naming = |xml: &mut Xml| {
        xml.attribute("name", &own.name);
        xml.attribute("valueReference", own.reference);
        xml.optional("description", own.description.as_ref());
        xml.attribute("causality", own.causality.word());
        xml.attribute("variability", own.variability.word());
        xml.optional("initial", own.initial.map(|initial| initial.word()).as_ref());
        xml.optional("canHandleMultipleSetPerTimeInstant", own.can_be_set_repeatedly.as_ref());
    };
    match version {
        Version::V2 => xml.element("ScalarVariable", |xml| {
            naming(xml);
            xml.element(word(own.kind, version), |xml| {
                content(xml, own);
                let derivative = own.derivative_of.map(|place| place + 1);
                xml.optional("derivative", derivative.as_ref());
                xml.optional("start", own.start.first());
            });
        }),
        Version::V3 => xml.element(own.kind.word(), |xml| {
            naming(xml);
            xml.unless("intermediateUpdate", own.has_intermediate_update, false);
            xml.optional("previous", own.previous.as_ref());
            if !own.clocks.is_empty() {
                xml.attribute("clocks", list(&own.clocks));
            }
            content(xml, own);
            let derivative = own.derivative_of.and_then(|place| description.variables.get(place));
            xml.optional("derivative", derivative.map(|of| of.reference).as_ref());
            if let Some(interval) = &own.clock {
                clock(xml, interval);
            }
            inside(xml, own);
        }),
    }
}

fn content(xml: &mut Xml, own: &Variable) {
    xml.optional("declaredType", own.declared_type.as_ref());
    attributes(xml, &own.attributes);
    xml.unless("reinit", own.is_reinitialized, false);
}

/// Start values, sizes and aliases of a variable of FMI 3.0.
fn inside(xml: &mut Xml, own: &Variable) {
    let is_text = matches!(own.kind, Kind::String | Kind::Binary);
    if !is_text && !own.start.is_empty() {
        xml.attribute("start", list(&own.start));
    }
    if own.is_internal {
        xml.element("Annotations", |xml| {
            xml.element("Annotation", |xml| xml.attribute("type", INTERNAL));
        });
    }
    for dimension in &own.dimensions {
        xml.element("Dimension", |xml| match dimension {
            Dimension::Fixed(size) => xml.attribute("start", size),
            Dimension::Variable(reference) => xml.attribute("valueReference", reference),
        });
    }
    for text in own.start.iter().filter(|_| is_text) {
        xml.element("Start", |xml| xml.attribute("value", text));
    }
    for alias in &own.aliases {
        xml.element("Alias", |xml| {
            xml.attribute("name", &alias.name);
            xml.optional("description", alias.description.as_ref());
            xml.optional("displayUnit", alias.display_unit.as_ref());
        });
    }
}

fn clock(xml: &mut Xml, own: &ClockInterval) {
    xml.attribute("intervalVariability", &own.variability);
    xml.unless("canBeDeactivated", own.can_be_deactivated, false);
    xml.optional("priority", own.priority.as_ref());
    xml.optional("intervalDecimal", own.decimal.as_ref());
    xml.optional("shiftDecimal", own.shift.as_ref());
    xml.unless("supportsFraction", own.supports_fraction, false);
    xml.optional("resolution", own.resolution.as_ref());
    xml.optional("intervalCounter", own.counter.as_ref());
    xml.optional("shiftCounter", own.shift_counter.as_ref());
}

fn structure(xml: &mut Xml, own: &Structure, description: &Description) {
    let groups = [
        ("Outputs", "Output", &own.outputs),
        ("Derivatives", "ContinuousStateDerivative", &own.derivatives),
        ("", "ClockedState", &own.clocked_states),
        ("InitialUnknowns", "InitialUnknown", &own.initial_unknowns),
        ("", "EventIndicator", &own.event_indicators),
    ];
    for (group, name, unknowns) in groups {
        match description.version {
            Version::V3 => unknowns.iter().for_each(|one| unknown(xml, name, one, description)),
            Version::V2 if !group.is_empty() => {
                xml.group(group, unknowns, |xml, one| unknown(xml, "Unknown", one, description));
            }
            Version::V2 => {}
        }
    }
}

fn unknown(xml: &mut Xml, name: &str, own: &Unknown, description: &Description) {
    let number = |place: usize| match description.version {
        Version::V2 => place as u32 + 1,
        Version::V3 => description.variables[place].reference,
    };
    xml.element(name, |xml| {
        let reference = if description.version == Version::V2 { "index" } else { "valueReference" };
        xml.attribute(reference, number(own.variable));
        let Some(on) = &own.dependencies else { return };
        xml.attribute("dependencies", list(on.iter().map(|(place, _)| number(*place))));
        if !on.is_empty() {
            xml.attribute("dependenciesKind", list(on.iter().map(|(_, kind)| kind.word())));
        }
    });
}

fn list(values: impl IntoIterator<Item: Display>) -> String {
    let mut text = String::new();
    for value in values {
        let separator = if text.is_empty() { "" } else { " " };
        let _ = write!(text, "{separator}{value}");
    }
    text
}
