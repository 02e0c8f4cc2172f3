//! A functional mock-up unit by its description, without running it.

use crate::diag::{Fault, suggest};
use crate::fmi::description::{Causality, Description, Version};
use crate::fmi::import::{Layout, Scalar};
use crate::script::Session;
use crate::script::access::policy::Grant;
use crate::script::errors::BAD_FMU;
use crate::script::models::imported;
use crate::source::Span;
use std::path::Path;

/// Shows what a unit is; whether it can be simulated here.
pub(super) fn check(session: &mut Session, path: &Path) -> bool {
    session.world.grant(Grant::Read(path));
    match described(session, path) {
        Ok(text) => {
            session.print(&text);
            true
        }
        Err(fault) => {
            session.report(fault.at(Span::NONE));
            false
        }
    }
}

fn described(session: &Session, path: &Path) -> Result<String, Fault> {
    let file = imported::read(session, path)?;
    imported::kind(&file, None)?;
    let description = &file.description;
    let layout = Layout::of(description, &[]);
    let layout = layout.map_err(|why| Fault::new(BAD_FMU, format!("`{}`: {why}", file.name)))?;
    let version = match description.version {
        Version::V2 => "2.0",
        Version::V3 => "3.0",
    };
    let kinds = [
        (description.model_exchange.is_some(), "model exchange"),
        (description.co_simulation.is_some(), "co-simulation"),
        (description.scheduled_execution.is_some(), "scheduled execution"),
    ];
    let kinds: Vec<&str> = kinds.iter().filter(|(has, _)| *has).map(|(_, name)| *name).collect();
    let states = match description.structure.derivatives.len() {
        1 => "1 state".to_owned(),
        count => format!("{count} states"),
    };
    let mut text = format!("{}: FMI {version}, {}, {states}\n", file.name, kinds.join(", "));
    for (name, causality) in [
        ("structural parameters", Causality::StructuralParameter),
        ("parameters", Causality::Parameter),
        ("inputs", Causality::Input),
        ("outputs", Causality::Output),
    ] {
        let of_kind =
            |scalar: &&Scalar| description.variables[scalar.place.variable].causality == causality;
        let names: Vec<String> = layout
            .scalars()
            .iter()
            .chain(layout.strings())
            .filter(of_kind)
            .map(|scalar| with_unit(description, scalar))
            .collect();
        if !names.is_empty() {
            let names: Vec<&str> = names.iter().map(String::as_str).collect();
            text.push_str(&format!("  {name}: {}\n", suggest::listed(&names).replace('`', "")));
        }
    }
    Ok(text)
}

/// The name of a scalar with its unit.
fn with_unit(description: &Description, scalar: &Scalar) -> String {
    let variable = &description.variables[scalar.place.variable];
    match description.attributes_of(variable).unit {
        Some(unit) => format!("{} [{unit}]", scalar.name),
        None => scalar.name.clone(),
    }
}
