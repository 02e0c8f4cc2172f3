//! What a unit holds of its model beside the description: the compiled program, and which value each
//! value reference stands for. The runtime of units reads it.

use super::Model;
use crate::codegen::{Program, bytes_of};
use crate::source::{SourceId, with_source_table, with_sources};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// The name of the file in the folder `resources`.
pub const FILE: &str = "model.gapi";

/// The content of the file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Content {
    /// `guid`, `instantiationToken`.
    pub token: String,
    /// Relative tolerance where the importer does not say any.
    pub tolerance: f64,
    /// What value references stand for: they are the places here.
    pub variables: Vec<Exported>,
    /// The numbers that the program gives to the continuous states, in their order.
    pub states: Vec<usize>,
    /// Values of Strings, which are constants of a unit.
    pub strings: Vec<String>,
    /// Parameters whose values are not those of the model, by their positions.
    pub set: Vec<(usize, f64)>,
    program: Vec<u8>,
    /// How many sources the places in the program lie in: their text is not in it.
    n_sources: usize,
}

/// A variable as functions of the interface see it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Exported {
    /// Its name, for messages.
    pub name: Arc<str>,
    /// Its type.
    pub kind: ValueKind,
    /// Where its value is found.
    pub place: Place,
    /// How it is set.
    pub setter: Setter,
}

/// The type of a value.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum ValueKind {
    /// A real number.
    Real,
    /// A whole number.
    Integer,
    /// True or false.
    Boolean,
    /// A literal by its number.
    Enumeration,
    /// A text.
    String,
}

/// Where the value of a variable is found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Place {
    /// The time.
    Time,
    /// The variable of this position in [`Program::variables`].
    Variable(usize),
    /// The state of this number.
    State(usize),
    /// The derivative of the state of this number.
    Derivative(usize),
    /// The event indicator of this number.
    Indicator(usize),
    /// The text of this number in [`Content::strings`].
    Text(usize),
}

/// How a variable is set.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Setter {
    /// Not at all.
    None,
    /// Before the initialization: the parameter of this position in [`Program::parameters`].
    Parameter(usize),
    /// As a state that the equations do not change, and before the initialization by the parameter that
    /// holds its start value.
    Input {
        /// The state by its number.
        state: usize,
        /// Whether the state has the opposite sign.
        is_negated: bool,
        /// The parameter by its position.
        start: usize,
    },
    /// As a recorded input, by the number that the program gives to it, with its first value.
    Recorded {
        /// See [`Program::recorded_input`].
        input: u32,
        /// First value.
        start: f64,
    },
}

impl Content {
    /// The content without its token; `None` where the program has functions in C.
    pub(super) fn new(
        model: &Model,
        variables: Vec<Exported>,
        states: Vec<usize>,
    ) -> Option<Content> {
        let program = model.program;
        let (program_bytes, sources) = with_source_table(|| program.to_bytes());
        Some(Content {
            token: String::new(),
            tolerance: program.experiment().tolerance.unwrap_or(1e-6),
            variables,
            states,
            strings: model.strings.values().map(|own| own.value.clone()).collect(),
            set: model.values.iter().map(|(parameter, value)| (*parameter, *value)).collect(),
            program: program_bytes?,
            n_sources: sources.len(),
        })
    }

    /// The bytes of the file; `None` where there are too many.
    pub fn to_bytes(&self) -> Option<Vec<u8>> {
        bytes_of(self)
    }

    /// The content of the file, and the program in it; `None` where the bytes are no such content.
    pub fn read(bytes: &[u8]) -> Option<(Content, Arc<Program>)> {
        let mut content: Content = postcard::from_bytes(bytes).ok()?;
        let bytes = std::mem::take(&mut content.program);
        let sources = vec![SourceId::NONE; content.n_sources];
        let program = with_sources(sources, || Program::from_bytes(&bytes))?;
        content.fits(&program).then_some((content, program))
    }

    /// Whether what it refers to is there.
    fn fits(&self, program: &Program) -> bool {
        let (n, variables) = (program.n_states(), program.variables().len());
        let parameters = program.parameters().len();
        let is_there = |own: &Exported| {
            let is_found = match own.place {
                Place::Variable(at) => at < variables,
                Place::State(at) | Place::Derivative(at) => at < n,
                Place::Text(at) => at < self.strings.len(),
                Place::Time | Place::Indicator(_) => true,
            };
            let is_set = match own.setter {
                Setter::None => true,
                Setter::Parameter(at) => at < parameters,
                Setter::Input { state, start, .. } => state < n && start < parameters,
                Setter::Recorded { input, .. } => program.is_recorded_input(input),
            };
            is_found && is_set
        };
        let are_set = self.set.iter().all(|(parameter, _)| *parameter < parameters);
        are_set && self.states.iter().all(|state| *state < n) && self.variables.iter().all(is_there)
    }
}
