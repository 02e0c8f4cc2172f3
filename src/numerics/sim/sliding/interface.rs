//! What the integrators see of a system that may slide.

use super::Sliding;
use super::slide::nearest_mode;
use crate::sim::{
    EventOutcome, Events, Failure, Linearity, Modes, Pattern, Residual, Sensitive, Side, Treatment,
};

/// How far a share may be outside 0 … 1: more than rounding.
const OUTSIDE: f64 = 1e-6;

/// The state of a slide taken out of its system for an evaluation.
macro_rules! sliding {
    ($self:ident, $y:ident, $slide:ident, $plain:expr) => {
        let Some($slide) = $self.slide.take() else { return $plain };
        $slide.unwrap($y, &mut $self.y);
    };
}

impl Residual for Sliding<'_> {
    fn begin(&mut self) {
        self.inner.begin();
    }

    fn n_differential(&self) -> usize {
        self.inner.n_differential()
    }

    fn n_algebraic(&self) -> usize {
        self.inner.n_algebraic() + self.n_shares()
    }

    fn n_auxiliary(&self) -> usize {
        self.inner.n_auxiliary()
    }

    fn solve_loops(&mut self, inside: bool) {
        self.inner.solve_loops(inside);
    }

    fn nominal(&self, out: &mut [f64]) {
        self.inner.nominal(out);
    }

    fn rhs(&mut self, t: f64, y: &[f64], out: &mut [f64]) -> Result<(), Failure> {
        sliding!(self, y, slide, self.inner.rhs(t, y, out));
        let evaluated = self.blended_rhs(&slide, t, y, out);
        self.slide = Some(slide);
        evaluated
    }

    fn pattern(&self) -> &Pattern {
        self.slide.as_ref().map_or(self.inner.pattern(), |slide| &slide.pattern)
    }

    fn jacobian(&mut self, t: f64, y: &[f64], values: &mut [f64]) -> Result<(), Failure> {
        sliding!(self, y, slide, self.inner.jacobian(t, y, values));
        let evaluated = self.blended_jacobian(&slide, t, y, values);
        self.slide = Some(slide);
        evaluated
    }

    fn linearity(&self) -> Option<Linearity> {
        self.inner.linearity()
    }

    fn initialize(&mut self, t: f64, y: &mut [f64]) -> Result<(), Failure> {
        self.inner.initialize(t, y)
    }

    fn finish(&mut self, t: f64, y: &mut [f64]) -> Result<bool, Failure> {
        self.inner.finish(t, y)
    }

    fn check(&mut self, t: f64, y: &[f64]) -> Result<(), Failure> {
        sliding!(self, y, slide, self.inner.check(t, y));
        self.enter(&slide, slide.nearest_mode(y));
        let checked = self.inner.check(t, &self.y);
        self.slide = Some(slide);
        checked
    }

    fn n_observed(&self) -> usize {
        self.inner.n_observed()
    }

    fn observe(&mut self, t: f64, y: &[f64], out: &mut [f64]) -> Result<(), Failure> {
        sliding!(self, y, slide, self.inner.observe(t, y, out));
        let observed = self.blended_observation(&slide, t, y, out);
        self.slide = Some(slide);
        observed
    }
}

impl Sensitive for Sliding<'_> {
    /// Derivatives are carried as long as nothing slides: [`Run::slide`](crate::sim::simulator::Run)
    /// refuses them.
    fn n_directions(&self) -> usize {
        self.inner.n_directions()
    }

    fn directions(&self, out: &mut [f64]) {
        self.inner.directions(out);
    }

    fn sensitivity_rhs(&mut self, t: f64, y: &[f64], out: &mut [f64]) -> Result<(), Failure> {
        self.inner.sensitivity_rhs(t, y, out)
    }
}

impl Events for Sliding<'_> {
    fn crossed(&mut self, crossing: Option<usize>, span: f64) {
        self.inner.crossed(crossing, span);
    }

    fn n_crossings(&self) -> usize {
        self.inner.n_crossings()
    }

    /// Those of the surfaces are positive as long as their shares are between 0 and 1.
    fn crossings(&mut self, t: f64, y: &[f64], out: &mut [f64]) -> Result<(), Failure> {
        sliding!(self, y, slide, self.inner.crossings(t, y, out));
        let shares = self.exact_shares(&slide, t, y);
        self.enter(&slide, nearest_mode(&shares));
        let evaluated = self.inner.crossings(t, &self.y, out);
        for (surface, share) in slide.surfaces.iter().zip(&shares) {
            out[surface.crossing] = share.min(1.0 - share) + OUTSIDE;
            surface.companions.iter().for_each(|companion| out[*companion] = 1.0);
        }
        for (contact, force) in slide.contacts.iter().zip(slide.forces(y)) {
            out[contact.crossing] = force + OUTSIDE;
        }
        self.slide = Some(slide);
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
            None => self.inner.crossings_among(t, y, which, out),
        }
    }

    fn crossings_vary_in_time(&self) -> bool {
        self.inner.crossings_vary_in_time()
    }

    fn oscillation(&mut self, t: f64) -> f64 {
        self.inner.oscillation(t)
    }

    fn sample_distance(&self, start: f64, stop: f64) -> Option<f64> {
        self.inner.sample_distance(start, stop)
    }

    fn has_event_at_start(&self) -> bool {
        self.inner.has_event_at_start()
    }

    fn next_time_event(&self, t: f64) -> Option<f64> {
        self.inner.next_time_event(t)
    }

    fn handle_event(&mut self, t: f64, y: &mut [f64]) -> Result<EventOutcome, Failure> {
        self.inner.handle_event(t, y)
    }

    fn keep_relations(&mut self, crossings: &[(usize, f64)]) {
        self.inner.keep_relations(crossings);
    }

    fn remembers(&self) -> bool {
        self.inner.remembers()
    }

    fn remember(&mut self, t: f64, y: &[f64]) -> Result<(), Failure> {
        self.inner.remember(t, y)
    }

    fn has_kinks(&self) -> bool {
        self.inner.has_kinks()
    }

    fn longest_step(&self) -> f64 {
        self.inner.longest_step()
    }

    fn set_uncertainty(&mut self, crossings: &[f64]) {
        self.inner.set_uncertainty(crossings);
    }
}

impl Modes for Sliding<'_> {
    fn prepare_modes(&mut self, t: f64, y: &[f64], sides: &[Side]) -> Result<bool, Failure> {
        self.inner.prepare_modes(t, y, sides)
    }

    fn enter_mode(&mut self, mode: usize) {
        self.inner.enter_mode(mode);
    }

    fn can_follow(&self, crossing: usize) -> bool {
        self.inner.can_follow(crossing)
    }

    fn can_follow_now(&self, crossing: usize) -> bool {
        self.inner.can_follow_now(crossing)
    }

    fn is_of_loop(&self, crossing: usize) -> bool {
        self.inner.is_of_loop(crossing)
    }

    fn follow(&mut self, t: f64, y: &[f64], sides: &[(usize, bool)]) -> Result<bool, Failure> {
        self.inner.follow(t, y, sides)
    }

    /// Asked where nothing slides.
    fn literal_relations(&mut self, t: f64, y: &[f64], out: &mut Vec<f64>) -> Result<(), Failure> {
        self.inner.literal_relations(t, y, out)
    }

    fn give_events(&mut self, t: f64, y: &[f64]) -> Result<bool, Failure> {
        self.inner.give_events(t, y)
    }

    fn note_treatment(&mut self, t: f64, crossing: usize, treatment: Treatment) {
        self.inner.note_treatment(t, crossing, treatment);
    }
}
