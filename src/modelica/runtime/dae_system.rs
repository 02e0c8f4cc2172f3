//! A system as the integrators see it.

use super::difference_quotients::quotient;
use super::execution::read;
use super::instants::{Change, Stage, same_time};
use super::recordings::distance_of_knots;
use super::system::System;
use crate::sim::{
    EventOutcome, Events, Failure, Linearity, Modes, Pattern, Residual, Sensitive, Side, Treatment,
};

impl Residual for System {
    fn begin(&mut self) {
        self.restore_program();
    }

    fn n_differential(&self) -> usize {
        self.program.sorted.states.len()
    }

    fn n_algebraic(&self) -> usize {
        self.n_held_iteration()
    }

    fn n_auxiliary(&self) -> usize {
        if self.loops.solves_loops { 0 } else { self.program.continuous.n_auxiliary }
    }

    fn solve_loops(&mut self, inside: bool) {
        self.loops.solves_loops = inside;
    }

    fn nominal(&self, out: &mut [f64]) {
        out.copy_from_slice(&self.nominal[..out.len()]);
    }

    fn rhs(&mut self, t: f64, y: &[f64], out: &mut [f64]) -> Result<(), Failure> {
        self.load_solved(t, y)?;
        read(&self.program.continuous.rhs, &mut self.registers, out).map_err(|f| self.refine(f))
    }

    fn pattern(&self) -> &Pattern {
        if !self.has_inner_loops() {
            return &self.program.continuous.pattern;
        }
        self.loops.full_pattern.get_or_init(|| Pattern::full(self.n_differential()))
    }

    fn jacobian(&mut self, t: f64, y: &[f64], values: &mut [f64]) -> Result<(), Failure> {
        if self.has_inner_loops() {
            return self.difference_jacobian(t, y, values);
        }
        self.load(t, y);
        match read(&self.program.continuous.jacobian, &mut self.registers, values) {
            // A derivative may have no value where the right-hand side has one.
            Err(Failure::Domain { .. }) if self.sensitivity.is_none() => {
                self.difference_jacobian(t, y, values)
            }
            other => other,
        }
    }

    fn linearity(&self) -> Option<Linearity> {
        let program = &self.program;
        if !program.selections.is_empty() || self.program.has_past() {
            return None;
        }
        let has_assertions =
            !program.assertions.each.is_empty() || !program.log_assertions.is_empty();
        let is_watched = has_assertions || self.n_crossings() > 0;
        program.continuous.linearity.map(|linearity| Linearity { is_watched, ..linearity })
    }

    fn initialize(&mut self, t: f64, y: &mut [f64]) -> Result<(), Failure> {
        self.relations.postponed.fill(false);
        self.relations.is_at_start = true;
        let done = self.solve_for_start(t, y);
        self.loops.is_solved = false;
        done?;
        self.take_given_start(t, y)
    }

    fn finish(&mut self, t: f64, y: &mut [f64]) -> Result<bool, Failure> {
        let Some(terminal) = self.program.events.terminal else { return Ok(false) };
        self.load(t, y);
        self.final_event(t, terminal)?;
        self.unload(y);
        // Continuous variables may depend on `terminal()`, too.
        Ok(true)
    }

    fn check(&mut self, t: f64, y: &[f64]) -> Result<(), Failure> {
        let tells = self.messages.log.is_some() && !self.program.log_assertions.is_empty();
        if self.program.assertions.each.is_empty() && !tells {
            return Ok(());
        }
        self.load_solved(t, y)?;
        self.assert_all()?;
        self.log_assertions(t)
    }

    fn n_observed(&self) -> usize {
        if let Some(sensitivity) = &self.sensitivity {
            return sensitivity.code.observe.outputs.len();
        }
        self.outputs.observed.as_ref().unwrap_or(&self.program.observe).outputs.len()
    }

    fn observe(&mut self, t: f64, y: &[f64], out: &mut [f64]) -> Result<(), Failure> {
        self.load_solved(t, y)?;
        if self.loops.solves_loops {
            self.differentiate_algebraic()?;
        }
        if let Some(sensitivity) = &self.sensitivity {
            let code = &sensitivity.code.observe;
            return read(code, &mut self.registers, out).map_err(|f| self.refine(f));
        }
        if self.messages.log.is_some() {
            self.registers.forget_solutions();
        }
        let observed = self.outputs.observed.as_ref().unwrap_or(&self.program.observe);
        if let Err(failure) = read(observed, &mut self.registers, out) {
            let failure = self.refine(failure);
            self.observe_others(t, failure, out)?;
        }
        out.iter().try_for_each(|value| self.is_a_number(*value))?;
        self.note_open(t);
        Ok(())
    }
}

impl Sensitive for System {
    fn n_directions(&self) -> usize {
        self.sensitivity.as_ref().map_or(0, |sensitivity| sensitivity.code.n_directions())
    }

    fn directions(&self, out: &mut [f64]) {
        self.magnitudes_of_parameters(out);
    }

    fn sensitivity_rhs(&mut self, t: f64, y: &[f64], out: &mut [f64]) -> Result<(), Failure> {
        self.load(t, y);
        self.right_sides_along(out).map_err(|f| self.refine(f))
    }
}

impl Events for System {
    fn sample_distance(&self, start: f64, stop: f64) -> Option<f64> {
        distance_of_knots(&self.program, start, stop)
    }

    fn has_event_at_start(&self) -> bool {
        self.relations.is_at_start && self.changes_after(self.registers[0])
    }

    fn n_crossings(&self) -> usize {
        self.program.n_crossings()
            + self.loops.choices.len()
            + 2 * self.program.events.transports.len()
    }

    fn crossings_vary_in_time(&self) -> bool {
        self.program.switching.crossings_vary_in_time
    }

    fn oscillation(&mut self, t: f64) -> f64 {
        let program = self.program.clone();
        let rates = &program.switching.oscillations;
        self.registers[0] = t;
        if rates.outputs.is_empty() || rates.tape.run(&mut self.registers).is_err() {
            return 0.0;
        }
        let rates = rates.outputs.iter().map(|rate| self.registers[*rate as usize].abs());
        rates.filter(|rate| rate.is_finite()).fold(0.0, f64::max)
    }

    fn crossings(&mut self, t: f64, y: &[f64], out: &mut [f64]) -> Result<(), Failure> {
        self.load_solved(t, y)?;
        let (first, others) = out.split_at_mut(self.program.n_crossings());
        let (last, transported) = others.split_at_mut(self.loops.choices.len());
        self.relation_crossings(first)?;
        self.delays.transported_crossings(&self.program, &mut self.registers, t, transported)?;
        for ((choice, selection), out) in
            self.loops.choices.iter_mut().zip(&self.program.selections).zip(last)
        {
            *out = choice.quality(selection, &mut self.registers)?;
        }
        Ok(())
    }

    fn crossings_among(
        &mut self,
        t: f64,
        y: &[f64],
        which: &[usize],
        out: &mut [f64],
    ) -> Result<(), Failure> {
        if self.program.switching.crossing_parts.is_empty() {
            return self.crossings(t, y, out);
        }
        self.load_solved(t, y)?;
        match self.relation_crossings_among(which, out) {
            Some(computed) => computed,
            None => self.crossings(t, y, out),
        }
    }

    fn next_time_event(&self, t: f64) -> Option<f64> {
        let later = |time: &f64| *time > t && !same_time(*time, t);
        let all = self
            .relations
            .switches
            .iter()
            .flatten()
            .copied()
            .chain(self.scheduled())
            .chain(self.inputs.next_knots(&self.program))
            .chain(self.delays.arriving_jumps());
        all.filter(later).min_by(f64::total_cmp)
    }

    fn handle_event(&mut self, t: f64, y: &mut [f64]) -> Result<EventOutcome, Failure> {
        self.pass_event(t, y)
    }

    fn keep_relations(&mut self, crossings: &[(usize, f64)]) {
        self.keep_relations_of(crossings);
    }

    fn remembers(&self) -> bool {
        self.program.has_past()
    }

    fn remember(&mut self, t: f64, y: &[f64]) -> Result<(), Failure> {
        self.load_solved(t, y)?;
        self.delays
            .remember_values(&self.program, &mut self.registers, t)
            .map_err(|f| self.refine(f))?;
        self.delays
            .record_transported(&self.program, &mut self.registers, t)
            .map_err(|f| self.refine(f))
    }

    fn has_kinks(&self) -> bool {
        self.program.differences().is_some() || self.program.has_kinks()
    }

    fn longest_step(&self) -> f64 {
        self.delays.longest_step(&self.program)
    }

    fn set_uncertainty(&mut self, crossings: &[f64]) {
        self.keep_uncertainty(crossings);
    }

    fn crossed(&mut self, crossing: Option<usize>, span: f64) {
        self.note_cause(crossing, span);
    }
}

impl Modes for System {
    fn prepare_modes(&mut self, t: f64, y: &[f64], sides: &[Side]) -> Result<bool, Failure> {
        self.load(t, y);
        self.compute_modes(sides)
    }

    fn enter_mode(&mut self, mode: usize) {
        self.load_mode(mode);
    }

    fn can_follow(&self, crossing: usize) -> bool {
        self.is_memoryless(crossing)
    }

    fn can_follow_now(&self, crossing: usize) -> bool {
        self.is_memoryless(crossing) || self.is_idle_now(crossing)
    }

    fn is_of_loop(&self, crossing: usize) -> bool {
        self.is_in_loop(crossing)
    }

    fn follow(&mut self, t: f64, y: &[f64], sides: &[(usize, bool)]) -> Result<bool, Failure> {
        self.load(t, y);
        self.change_sides(sides)
    }

    fn literal_relations(&mut self, t: f64, y: &[f64], out: &mut Vec<f64>) -> Result<(), Failure> {
        self.load_solved(t, y)?;
        self.literal_differences(out)
    }

    fn give_events(&mut self, t: f64, y: &[f64]) -> Result<bool, Failure> {
        self.load_solved(t, y)?;
        self.solve(Stage::Continuous)?;
        self.replace_program(t)
    }

    fn has_means(&self, observed: usize) -> bool {
        self.outputs.has_means.get(observed).is_none_or(|has| *has)
    }

    fn note_treatment(&mut self, t: f64, crossing: usize, treatment: Treatment) {
        self.note_treated(t, crossing, treatment);
    }
}

impl System {
    /// What is observed at a time, where no states are needed for it: relations and roundings have the
    /// values that their sides have then. `solves`: whether they compare solved variables.
    ///
    /// # Errors
    ///
    /// An expression has no value there, or a loop no solution.
    pub fn observe_in_time(
        &mut self,
        (t, y): (f64, &[f64]),
        solves: bool,
        out: &mut [f64],
    ) -> Result<(), Failure> {
        self.load_solved(t, y)?;
        // One may decide what another compares.
        for _ in 0..=self.program.switching.relations.len() {
            if solves {
                self.solve(Stage::Continuous)?;
            }
            if !self.update_relations(t, Change::All) {
                break;
            }
        }
        self.observe(t, y, out)
    }

    /// The Jacobian of the right-hand side by difference quotients.
    fn difference_jacobian(
        &mut self,
        t: f64,
        y: &[f64],
        values: &mut [f64],
    ) -> Result<(), Failure> {
        let n = y.len();
        let (mut before, mut column) = (vec![0.0; n], vec![0.0; n]);
        let (mut moved, mut nominal) = (y.to_vec(), vec![1.0; n]);
        self.nominal(&mut nominal);
        self.rhs(t, y, &mut before)?;
        let pattern = self.pattern().clone();
        for j in 0..n {
            quotient(y[j], nominal[j], &before, &mut column, |x, out| {
                moved[j] = x;
                self.rhs(t, &moved, out)
            })?;
            moved[j] = y[j];
            for at in pattern.column(j) {
                values[at] = column[pattern.rows[at]];
            }
        }
        self.load(t, y);
        Ok(())
    }
}
