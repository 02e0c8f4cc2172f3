//! What functions that are evaluated at translation may do outside: read files, print, and draw random
//! numbers from a state that they set themselves.

use super::c::Request;
use super::errors::PRINTED;
use super::{Entry, Outside, Random, Resources};
use crate::diag::Fault;
use crate::fault;

/// Most lines that are kept; a function may print in a loop.
const MAX_LINES: usize = 20;

/// Files that may be read, and what was printed so far.
#[derive(Debug, Default)]
pub(crate) struct AtTranslation {
    resources: Resources,
    lines: Vec<String>,
    dropped: usize,
    random: Random,
    /// How often random numbers were asked for.
    draws: u64,
}

impl AtTranslation {
    /// Nothing printed yet.
    pub(crate) fn new(resources: Resources) -> AtTranslation {
        AtTranslation { resources, ..AtTranslation::default() }
    }

    /// How often the state of the random numbers was used: a value that took some is not found again by
    /// the same expression.
    pub(crate) fn draws(&self) -> u64 {
        self.draws
    }

    /// The lines as notes. The value is a constant of the model, whose simulation does not call the
    /// function again.
    pub(crate) fn notes(&self) -> Vec<Fault> {
        let line = |text: &String| fault!(PRINTED, "a function called at translation: {text}");
        let mut faults: Vec<Fault> = self.lines.iter().map(line).collect();
        if self.dropped > 0 {
            faults.push(fault!(
                PRINTED,
                "functions called at translation printed {} more lines",
                self.dropped
            ));
        }
        faults
    }
}

impl Outside for AtTranslation {
    fn read(&mut self, path: &str) -> Result<Vec<u8>, Fault> {
        self.resources.read(path)
    }

    fn print(&mut self, text: &str) -> Result<(), Fault> {
        match self.lines.len() < MAX_LINES {
            true => self.lines.push(text.trim_end().to_owned()),
            false => self.dropped += 1,
        }
        Ok(())
    }

    fn random(&mut self) -> Result<&mut Random, Fault> {
        self.draws += 1;
        Ok(&mut self.random)
    }

    fn is_folder(&mut self, path: &str) -> Result<Option<bool>, Fault> {
        self.resources.is_folder(path)
    }

    fn full_path(&mut self, path: &str) -> Result<String, Fault> {
        self.resources.full_path(path)
    }

    fn environment_variable(&mut self, name: &str) -> Result<Option<String>, Fault> {
        self.resources.environment_variable(name)
    }

    fn c_function(&mut self, request: &Request) -> Result<&'static Entry, Fault> {
        self.resources.c_function(request)
    }
}
