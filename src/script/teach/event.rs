//! What a trace records: the calls of the paper's functions and of operators by name, each with the
//! line that made it.
//!
//! What follows from the events before is left out, so that a trace stays small: the numbers of a
//! draw follow from its seed, the children from the parents and the crossing points, the mutated
//! genes from the numbers and the factor.

use super::operation::Operation;
pub use super::place::ScriptLine;
use serde::{Deserialize, Serialize};

/// Genomes that an event was given: what the run has produced already is not stored again.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Genes {
    /// Those that the function in question usually gets: the result of the one before it.
    Expected,
    /// The expected ones but for some rows at these indices, from 0; rows may be added at the end.
    Changed {
        /// Number of individuals.
        len: u32,
        /// The rows that differ.
        rows: Vec<u32>,
        /// Their genes, row by row.
        values: Vec<f64>,
    },
    /// All of them, row by row.
    All(Vec<f64>),
}

/// Numbers that an event was given: the fitness for a sort, the random numbers of a mutation.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Numbers {
    /// Those of the event that usually makes them.
    Expected,
    /// These.
    All(Vec<f64>),
}

/// What is identified: names and units of the parameters, X and Y.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Subject {
    /// The model, with its modification.
    pub model: String,
    /// Names of the identified parameters, in the order of the genes.
    pub parameters: Vec<String>,
    /// Their units; empty where the model gives none.
    pub units: Vec<String>,
    /// Name of what the measured points are given over, with its unit in brackets.
    pub x_name: String,
    /// Name of what was measured, with its unit in brackets.
    pub y_name: String,
}

/// One thing that happened.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Event {
    /// A script is named for the first time; places count the scripts in this order.
    Script {
        /// Its path as it was asked for.
        name: String,
        /// Its text.
        text: String,
    },
    /// What is identified, recorded when it changes.
    Subject(Subject),
    /// What simulations are compared with, recorded when it changes.
    Measured {
        /// X.
        x: Vec<f64>,
        /// Y.
        y: Vec<f64>,
    },
    /// `Ram_Gen_ARENA` has drawn numbers.
    Draw {
        /// Where it was called.
        place: ScriptLine,
        /// The state it began with.
        seed: [f64; 6],
        /// How many numbers.
        count: u32,
    },
    /// `Eval` has simulated individuals. Expected: what `Mutation` gave.
    Simulate {
        /// Where it was called.
        place: ScriptLine,
        /// Number of genes of each individual.
        n_genes: u32,
        /// The individuals.
        genes: Genes,
        /// Which failed, from 0, and why.
        failures: Vec<(u32, String)>,
    },
    /// `Fit` has compared them with the measured data.
    Rate {
        /// Where it was called.
        place: ScriptLine,
        /// The fitness of each individual.
        fitness: Vec<f64>,
        /// Simulated Y of the best of them at every measured point; empty where all failed.
        best: Vec<f64>,
    },
    /// `Fit_Order` has sorted them. Expected: what `Eval` got and `Fit` gave.
    Sort {
        /// Where it was called.
        place: ScriptLine,
        /// The individuals.
        genes: Genes,
        /// Their fitness.
        fitness: Numbers,
        /// Number of parents.
        parents: u32,
        /// Number of elites.
        elites: u32,
    },
    /// `Cross` has made children. Expected: what `Fit_Order` gave.
    Cross {
        /// Where it was called.
        place: ScriptLine,
        /// The individuals, best first.
        genes: Genes,
        /// Number of parents.
        parents: u32,
        /// Number of elites.
        elites: u32,
        /// The crossing points, 0 to the number of genes.
        points: Vec<u32>,
    },
    /// `Mutation` has changed genes. Expected: what `Cross` gave, and the numbers of the last draw.
    Mutate {
        /// Where it was called.
        place: ScriptLine,
        /// The individuals.
        genes: Genes,
        /// One number for each gene.
        numbers: Numbers,
        /// Number of elites, which stay.
        elites: u32,
        /// The probability that a gene mutates.
        factor: f64,
        /// Lower ends of the search ranges.
        minima: Vec<f64>,
        /// Upper ends of the search ranges.
        maxima: Vec<f64>,
    },
    /// The trace has reached the size it may have; what follows is not recorded.
    Full,
    /// Operators are called before any simulation, on individuals that a script has made.
    Alone {
        /// Number of genes of each of them.
        n_genes: u32,
    },
    /// An operator is called by name, in a script that has called none of the paper's functions
    /// `Eval`, `Fit_Order`, `Cross` and `Mutation` before.
    Operate(Operation),
}
