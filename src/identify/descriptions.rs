//! What variables are called in pictures: what their model describes them as.

use super::model::Model;
use crate::plot::{Axis, Scale};
use crate::spectrum::FREQUENCY;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The description strings of variables, by their names.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Descriptions(BTreeMap<String, String>);

impl Descriptions {
    /// Adds what a model describes these variables as; the first model that does so counts.
    pub fn add<'n>(&mut self, model: &dyn Model, names: impl IntoIterator<Item = &'n str>) {
        for name in names {
            let description = model.description(name).filter(|own| !own.is_empty());
            if let (Some(description), false) = (description, self.0.contains_key(name)) {
                self.0.insert(name.to_owned(), description);
            }
        }
    }

    /// Whether no variable has one.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// That of a variable, or of the one that an initial value such as `h@full` belongs to; empty where
    /// there is none.
    pub fn of(&self, name: &str) -> &str {
        let variable = name.split_once('@').map_or(name, |(variable, _)| variable);
        self.0.get(name).or_else(|| self.0.get(variable)).map_or("", String::as_str)
    }

    /// The axis of a variable with its unit.
    pub fn axis(&self, [name, unit]: &[String; 2]) -> Axis {
        let axis = Axis::of_variable(name, self.of(name), unit);
        match name == FREQUENCY {
            true => Axis { scale: Scale::Logarithmic, ..axis },
            false => axis,
        }
    }
}
