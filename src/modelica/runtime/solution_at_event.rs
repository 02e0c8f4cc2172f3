//! The solution that the search for an event has computed: the event iteration begins with it.

use super::state::SolutionAtEvent;
use super::system::System;
use crate::codegen::program::Program;

impl System {
    /// Whether the registers hold these bits.
    pub(super) fn is_loaded(&self, t: f64, y: &[f64]) -> bool {
        let is_held =
            |register: usize, value: f64| self.registers[register].to_bits() == value.to_bits();
        let mut unknowns = self.program.continuous.unknowns.iter().zip(y);
        is_held(0, t) && unknowns.all(|(variable, value)| is_held(variable.0 as usize, *value))
    }

    /// Keeps a solution for iteration variables that y holds: it is asked for where an event is located.
    /// Not where more than the unknowns and the relations decides it.
    pub(super) fn note_solution(&mut self, t: f64, y: &[f64]) {
        let Program { events, sorted, continuous, switching, .. } = &*self.program;
        let is_determined = events.is_empty()
            && events.roundings.is_empty()
            && sorted.dae.events.recordings.is_empty()
            && self.sensitivity.is_none();
        if !is_determined || y.len() != continuous.unknowns.len() {
            return;
        }
        let registers = &self.registers;
        let value = |register: u32| registers[register as usize];
        let noted = &mut self.loops.at_event;
        noted.time = t;
        noted.y.clear();
        noted.y.extend_from_slice(y);
        noted.relations.clear();
        noted.relations.extend(switching.relations.iter().map(|own| value(own.register)));
        noted.solved.clear();
        noted.solved.extend(self.program.solved_variables().map(|variable| value(variable.0)));
    }

    /// Takes the solution that was noted for the unknowns and relations at hand; whether there is one.
    pub(super) fn take_noted_solution(&mut self) -> bool {
        let noted = std::mem::take(&mut self.loops.at_event);
        let program = self.program.clone();
        let mut relations = program.switching.relations.iter().zip(&noted.relations);
        let is_of_this_point = !noted.solved.is_empty()
            && noted.relations.len() == program.switching.relations.len()
            && self.is_loaded(noted.time, &noted.y)
            && relations.all(|(own, value)| self.registers[own.register as usize] == *value);
        if is_of_this_point {
            for (variable, value) in program.solved_variables().zip(&noted.solved) {
                self.registers[variable.0 as usize] = *value;
            }
        }
        self.loops.at_event = SolutionAtEvent { time: f64::NAN, ..noted };
        is_of_this_point
    }
}

#[cfg(test)]
mod tests {
    use crate::causalize::causalize;
    use crate::codegen::Program;
    use crate::flatten::{Library, flatten};
    use crate::runtime::System;
    use crate::sim::{Events, Residual};
    use crate::source::SourceId;
    use crate::syntax::parse_stored_definition;

    const MODEL: &str = "model M parameter Real p = 1; Real x(start = 1, fixed = true); \
        Real v(start = 1); equation der(x) = if v > 2 then -p else p; v^3 + v = x; end M;";

    /// Solutions of the loop between events so far.
    fn solutions(system: &System) -> u64 {
        system.loop_efforts().iter().map(|effort| effort.solutions).sum()
    }

    /// Evaluates the crossing function at t = 1, where it has another sign, with the loop solved.
    fn search(system: &mut System, y: &[f64]) {
        system.solve_loops(true);
        let mut z = vec![0.0; system.n_crossings()];
        system.crossings(1.0, y, &mut z).expect("a value");
        system.solve_loops(false);
        assert!(z[0] > 0.0, "{z:?}");
    }

    #[test]
    fn an_event_begins_with_the_solution_of_its_search() {
        let file = parse_stored_definition(SourceId::NONE, MODEL).expect("Modelica");
        let mut library = Library::new();
        let names = library.load(&file).expect("a loadable file");
        let flat = flatten(&library, &names[0], &[]).expect("a model").model;
        let program = Program::compile(causalize(&flat).expect("it can be sorted"));
        let mut system = program.expect("it compiles").system();
        let mut start = vec![0.0; 2];
        system.initialize(0.0, &mut start).expect("start values");
        // v³ + v = 10.1, v = 2.008: the relation has changed, and holds after it.
        let point = [10.1, 2.0];
        search(&mut system, &point);
        let before = solutions(&system);
        system.handle_event(1.0, &mut point.clone()).expect("an event");
        assert_eq!(solutions(&system) - before, 1, "with the new value of the relation alone");
        // In another simulation the same point is solved again.
        system.initialize(0.0, &mut start).expect("start values");
        search(&mut system, &point);
        system.set_parameter(0, 2.0).expect("a parameter");
        system.initialize(0.0, &mut start).expect("start values");
        let before = solutions(&system);
        system.handle_event(1.0, &mut point.clone()).expect("an event");
        assert_eq!(solutions(&system) - before, 2, "before the relation changes and after");
    }
}
