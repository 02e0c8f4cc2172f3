//! What a script identifies: the model, the quantities, the measured series, and these beside their
//! simulation.

use super::Descriptions;
use crate::plot::Axis;
use std::sync::Arc;

/// What is simulated: the model, what varies, what is compared.
#[derive(Debug, Clone, PartialEq)]
pub struct Study {
    /// The model, with its modification.
    pub model: String,
    /// The identified parameters in the order of the genes.
    pub parameters: Vec<Quantity>,
    /// What the measured points are given over.
    pub x: Quantity,
    /// What was measured.
    pub y: Quantity,
    /// What the model describes X and Y as.
    pub descriptions: Descriptions,
    /// How often a model of this name was found changed before: it is another one each time.
    pub changes: u32,
}

impl Study {
    /// The axis of X or Y.
    pub fn axis(&self, Quantity { name, unit }: &Quantity) -> Axis {
        Axis::of_variable(name, self.descriptions.of(name), unit)
    }
}

/// A name and a unit.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Quantity {
    /// Its name in the model.
    pub name: String,
    /// Its unit; empty where the model gives none.
    pub unit: String,
}

/// Where measured data come from.
#[derive(Debug, Clone, PartialEq)]
pub struct Measurement {
    /// The file as the script names it.
    pub file: String,
    /// Measured X.
    pub x: Vec<f64>,
    /// Measured Y.
    pub y: Vec<f64>,
}

/// A series beside the simulation of an individual.
#[derive(Debug, Clone, PartialEq)]
pub struct Compared {
    /// What was simulated.
    pub study: Arc<Study>,
    /// The measured X.
    pub x: Vec<f64>,
    /// The simulated Y.
    pub simulated: Vec<f64>,
    /// The measured Y; `None` where the script has not shown it.
    pub measured: Option<Vec<f64>>,
    /// The file that it was read from; empty where not known.
    pub file: String,
}
