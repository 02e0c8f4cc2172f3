//! What the integrators see of a system that may slide.

use super::Sliding;
use super::slide::nearest_mode;
use crate::sim::{
    EventOutcome, Events, Failure, Linearity, Modes, Pattern, Residual, Sensitive, Side, Treatment,
};

/// How far a share may be outside 0 … 1: more than rounding.
const OUTSIDE: f64 = 1e-6;

impl Residual for Sliding<'_> {
    fn begin(&mut self) {
        self.within.system.begin();
    }

    fn n_differential(&self) -> usize {
        self.within.system.n_differential()
    }

    fn n_algebraic(&self) -> usize {
        self.within.system.n_algebraic() + self.n_shares()
    }

    fn n_auxiliary(&self) -> usize {
        self.within.system.n_auxiliary()
    }

    fn solve_loops(&mut self, inside: bool) {
        self.within.system.solve_loops(inside);
    }

    fn nominal(&self, out: &mut [f64]) {
        self.within.system.nominal(out);
    }

    fn rhs(&mut self, t: f64, y: &[f64], out: &mut [f64]) -> Result<(), Failure> {
        let Some(slide) = &self.slide else { return self.within.system.rhs(t, y, out) };
        slide.unwrap(y, &mut self.within.y);
        self.within.blended_rhs(slide, t, y, out)
    }

    fn pattern(&self) -> &Pattern {
        self.slide.as_ref().map_or(self.within.system.pattern(), |slide| &slide.pattern)
    }

    fn jacobian(&mut self, t: f64, y: &[f64], values: &mut [f64]) -> Result<(), Failure> {
        let Some(slide) = &self.slide else { return self.within.system.jacobian(t, y, values) };
        slide.unwrap(y, &mut self.within.y);
        self.within.blended_jacobian(slide, t, y, values)
    }

    fn linearity(&self) -> Option<Linearity> {
        self.within.system.linearity()
    }

    fn initialize(&mut self, t: f64, y: &mut [f64]) -> Result<(), Failure> {
        self.within.system.initialize(t, y)
    }

    fn finish(&mut self, t: f64, y: &mut [f64]) -> Result<bool, Failure> {
        self.within.system.finish(t, y)
    }

    fn check(&mut self, t: f64, y: &[f64]) -> Result<(), Failure> {
        let Some(slide) = &self.slide else { return self.within.system.check(t, y) };
        slide.unwrap(y, &mut self.within.y);
        self.within.enter(slide, slide.nearest_mode(y));
        self.within.system.check(t, &self.within.y)
    }

    fn n_observed(&self) -> usize {
        self.within.system.n_observed()
    }

    fn observe(&mut self, t: f64, y: &[f64], out: &mut [f64]) -> Result<(), Failure> {
        let Some(slide) = &self.slide else { return self.within.system.observe(t, y, out) };
        slide.unwrap(y, &mut self.within.y);
        self.within.blended_observation(slide, t, y, out)
    }
}

impl Sensitive for Sliding<'_> {
    /// Derivatives are carried as long as nothing slides: [`Run::slide`](crate::sim::simulator::Run)
    /// refuses them.
    fn n_directions(&self) -> usize {
        self.within.system.n_directions()
    }

    fn directions(&self, out: &mut [f64]) {
        self.within.system.directions(out);
    }

    fn sensitivity_rhs(&mut self, t: f64, y: &[f64], out: &mut [f64]) -> Result<(), Failure> {
        self.within.system.sensitivity_rhs(t, y, out)
    }
}

impl Events for Sliding<'_> {
    fn crossed(&mut self, crossing: Option<usize>, span: f64) {
        self.within.system.crossed(crossing, span);
    }

    fn n_crossings(&self) -> usize {
        self.within.system.n_crossings()
    }

    /// Those of the surfaces are positive as long as their shares are between 0 and 1.
    fn crossings(&mut self, t: f64, y: &[f64], out: &mut [f64]) -> Result<(), Failure> {
        let Some(slide) = &self.slide else { return self.within.system.crossings(t, y, out) };
        slide.unwrap(y, &mut self.within.y);
        let shares = self.within.exact_shares(slide, t, y);
        self.within.enter(slide, nearest_mode(&shares));
        let evaluated = self.within.system.crossings(t, &self.within.y, out);
        for (surface, share) in slide.surfaces.iter().zip(&shares) {
            out[surface.crossing] = share.min(1.0 - share) + OUTSIDE;
            surface.companions.iter().for_each(|companion| out[*companion] = 1.0);
        }
        for (contact, force) in slide.contacts.iter().zip(slide.forces(y)) {
            out[contact.crossing] = force + OUTSIDE;
        }
        evaluated
    }

    fn crossings_among(
        &mut self,
        t: f64,
        y: &[f64],
        which: &[usize],
        out: &mut [f64],
    ) -> Result<(), Failure> {
        match self.slide {
            Some(_) => self.crossings(t, y, out),
            None => self.within.system.crossings_among(t, y, which, out),
        }
    }

    fn crossings_vary_in_time(&self) -> bool {
        self.within.system.crossings_vary_in_time()
    }

    fn oscillation(&mut self, t: f64) -> f64 {
        self.within.system.oscillation(t)
    }

    fn sample_distance(&self, start: f64, stop: f64) -> Option<f64> {
        self.within.system.sample_distance(start, stop)
    }

    fn has_event_at_start(&self) -> bool {
        self.within.system.has_event_at_start()
    }

    fn next_time_event(&self, t: f64) -> Option<f64> {
        self.within.system.next_time_event(t)
    }

    fn handle_event(&mut self, t: f64, y: &mut [f64]) -> Result<EventOutcome, Failure> {
        self.within.system.handle_event(t, y)
    }

    fn keep_relations(&mut self, crossings: &[(usize, f64)]) {
        self.within.system.keep_relations(crossings);
    }

    fn remembers(&self) -> bool {
        self.within.system.remembers()
    }

    fn remember(&mut self, t: f64, y: &[f64]) -> Result<(), Failure> {
        self.within.system.remember(t, y)
    }

    fn has_kinks(&self) -> bool {
        self.within.system.has_kinks()
    }

    fn longest_step(&self) -> f64 {
        self.within.system.longest_step()
    }

    fn set_uncertainty(&mut self, crossings: &[f64]) {
        self.within.system.set_uncertainty(crossings);
    }
}

impl Modes for Sliding<'_> {
    fn prepare_modes(&mut self, t: f64, y: &[f64], sides: &[Side]) -> Result<bool, Failure> {
        self.within.system.prepare_modes(t, y, sides)
    }

    fn enter_mode(&mut self, mode: usize) {
        self.within.system.enter_mode(mode);
    }

    fn can_follow(&self, crossing: usize) -> bool {
        self.within.system.can_follow(crossing)
    }

    fn can_follow_now(&self, crossing: usize) -> bool {
        self.within.system.can_follow_now(crossing)
    }

    fn is_of_loop(&self, crossing: usize) -> bool {
        self.within.system.is_of_loop(crossing)
    }

    fn follow(&mut self, t: f64, y: &[f64], sides: &[(usize, bool)]) -> Result<bool, Failure> {
        self.within.system.follow(t, y, sides)
    }

    /// Asked where nothing slides.
    fn literal_relations(&mut self, t: f64, y: &[f64], out: &mut Vec<f64>) -> Result<(), Failure> {
        self.within.system.literal_relations(t, y, out)
    }

    fn give_events(&mut self, t: f64, y: &[f64]) -> Result<bool, Failure> {
        self.within.system.give_events(t, y)
    }

    fn note_treatment(&mut self, t: f64, crossing: usize, treatment: Treatment) {
        self.within.system.note_treatment(t, crossing, treatment);
    }
}
