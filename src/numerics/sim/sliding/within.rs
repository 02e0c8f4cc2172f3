//! The system that may slide, with what it reads and writes in its modes.

use super::slide::Slide;
use crate::sim::{DaeSystem, Failure};

pub(super) type Evaluated = Result<(), Failure>;

/// The system within a slide.
pub(in crate::sim) struct SystemWithin<'a> {
    pub(super) system: &'a mut dyn DaeSystem,
    /// y of the system, and what it writes.
    pub(super) y: Vec<f64>,
    pub(super) out: Vec<f64>,
    pub(super) values: Vec<f64>,
    pub(super) z: Vec<f64>,
    pub(super) z_moved: Vec<f64>,
}

impl<'a> SystemWithin<'a> {
    pub(super) fn new(system: &'a mut dyn DaeSystem) -> SystemWithin<'a> {
        SystemWithin {
            system,
            y: Vec::new(),
            out: Vec::new(),
            values: Vec::new(),
            z: Vec::new(),
            z_moved: Vec::new(),
        }
    }

    /// Makes room for the n unknowns of the system at hand.
    pub(super) fn resize(&mut self, n: usize) {
        self.y.resize(n, 0.0);
        self.out.resize(n, 0.0);
        self.values.resize(self.system.pattern().rows.len(), 0.0);
        self.z.resize(self.system.n_crossings(), 0.0);
        self.z_moved.resize(self.system.n_crossings(), 0.0);
    }

    /// Without surfaces there is but one mode, the one at hand.
    pub(super) fn enter(&mut self, slide: &Slide, mode: usize) {
        if !slide.surfaces.is_empty() {
            self.system.enter_mode(mode);
        }
    }
}
