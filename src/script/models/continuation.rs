//! Simulations that begin where another one ended.

use crate::runtime::System;
use crate::sim::{
    EventOutcome, Events, Failure, Linearity, Modes, Pattern, Residual, Sensitive, Side, Treatment,
};

/// A system whose states and discrete variables have given values at the start, whatever its initial
/// equations say; all other variables follow from them.
pub(super) struct Continued {
    /// The system, whose parameters can be read afterwards.
    pub system: System,
    /// Positions among the states, and values.
    pub states: Vec<(usize, f64)>,
    /// Positions of discrete variables among the variables, and values.
    pub discrete: Vec<(usize, f64)>,
}

impl Continued {
    fn set(&mut self, y: &mut [f64]) {
        for (state, value) in &self.states {
            y[*state] = *value;
        }
        self.system.set_discrete(&self.discrete);
    }
}

impl Residual for Continued {
    fn initialize(&mut self, t: f64, y: &mut [f64]) -> Result<(), Failure> {
        self.system.initialize(t, y)?;
        if self.states.is_empty() && self.discrete.is_empty() {
            return Ok(());
        }
        // Conditions that become true here were true before: what they do is taken back.
        self.set(y);
        self.system.handle_event(t, y)?;
        self.set(y);
        self.system.handle_event(t, y).map(|_| ())
    }

    fn n_differential(&self) -> usize {
        self.system.n_differential()
    }

    fn n_algebraic(&self) -> usize {
        self.system.n_algebraic()
    }

    fn n_auxiliary(&self) -> usize {
        self.system.n_auxiliary()
    }

    fn solve_loops(&mut self, inside: bool) {
        self.system.solve_loops(inside);
    }

    fn nominal(&self, out: &mut [f64]) {
        self.system.nominal(out);
    }

    fn rhs(&mut self, t: f64, y: &[f64], out: &mut [f64]) -> Result<(), Failure> {
        self.system.rhs(t, y, out)
    }

    fn pattern(&self) -> &Pattern {
        self.system.pattern()
    }

    fn jacobian(&mut self, t: f64, y: &[f64], values: &mut [f64]) -> Result<(), Failure> {
        self.system.jacobian(t, y, values)
    }

    fn linearity(&self) -> Option<Linearity> {
        self.system.linearity()
    }

    fn finish(&mut self, t: f64, y: &mut [f64]) -> Result<bool, Failure> {
        self.system.finish(t, y)
    }

    fn check(&mut self, t: f64, y: &[f64]) -> Result<(), Failure> {
        self.system.check(t, y)
    }

    fn begin(&mut self) {
        self.system.begin();
    }

    fn n_observed(&self) -> usize {
        self.system.n_observed()
    }

    fn observe(&mut self, t: f64, y: &[f64], out: &mut [f64]) -> Result<(), Failure> {
        self.system.observe(t, y, out)
    }
}

impl Sensitive for Continued {}

impl Events for Continued {
    fn n_crossings(&self) -> usize {
        self.system.n_crossings()
    }

    fn crossings_vary_in_time(&self) -> bool {
        self.system.crossings_vary_in_time()
    }

    fn crossings(&mut self, t: f64, y: &[f64], out: &mut [f64]) -> Result<(), Failure> {
        self.system.crossings(t, y, out)
    }

    fn oscillation(&mut self, t: f64) -> f64 {
        self.system.oscillation(t)
    }

    fn has_event_at_start(&self) -> bool {
        self.system.has_event_at_start()
    }

    fn next_time_event(&self, t: f64) -> Option<f64> {
        self.system.next_time_event(t)
    }

    fn handle_event(&mut self, t: f64, y: &mut [f64]) -> Result<EventOutcome, Failure> {
        self.system.handle_event(t, y)
    }

    fn remembers(&self) -> bool {
        self.system.remembers()
    }

    fn remember(&mut self, t: f64, y: &[f64]) -> Result<(), Failure> {
        self.system.remember(t, y)
    }

    fn longest_step(&self) -> f64 {
        self.system.longest_step()
    }

    fn set_uncertainty(&mut self, crossings: &[f64]) {
        self.system.set_uncertainty(crossings);
    }
}

impl Modes for Continued {
    fn prepare_modes(&mut self, t: f64, y: &[f64], sides: &[Side]) -> Result<bool, Failure> {
        self.system.prepare_modes(t, y, sides)
    }

    fn enter_mode(&mut self, mode: usize) {
        self.system.enter_mode(mode);
    }

    fn can_follow(&self, crossing: usize) -> bool {
        self.system.can_follow(crossing)
    }

    fn can_follow_now(&self, crossing: usize) -> bool {
        self.system.can_follow_now(crossing)
    }

    fn follow(&mut self, t: f64, y: &[f64], sides: &[(usize, bool)]) -> Result<bool, Failure> {
        self.system.follow(t, y, sides)
    }

    fn has_means(&self, observed: usize) -> bool {
        self.system.has_means(observed)
    }

    fn literal_relations(&mut self, t: f64, y: &[f64], out: &mut Vec<f64>) -> Result<(), Failure> {
        self.system.literal_relations(t, y, out)
    }

    fn give_events(&mut self, t: f64, y: &[f64]) -> Result<bool, Failure> {
        self.system.give_events(t, y)
    }

    fn note_treatment(&mut self, t: f64, crossing: usize, treatment: Treatment) {
        self.system.note_treatment(t, crossing, treatment);
    }
}
