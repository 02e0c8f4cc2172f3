//! Steps of an instance by its own integrator, a method of one step that may begin anywhere: inputs
//! jump at communication points. Events within a step are handled in it, unless the importer handles
//! them and lets a step end at one.

use crate::instance::{Instance, Phase, Wrong};
use crate::sim::{
    AT_ONCE, Ended, EventOutcome, OutputGrid, Residual, Settings, SimError, SimErrorKind,
    Trajectory, find_integrator,
};

/// A method of Rosenbrock for stiff and other models.
const METHOD: &str = "rodas4";

impl Instance {
    /// Goes from a communication point to the next, or to an event that the importer handles.
    pub(crate) fn do_step(&mut self, from: f64, length: f64) -> Result<Ended, Wrong> {
        self.expect(&[Phase::Step], "steps follow the initialization and events")?;
        let (time, to) = (self.state.time, from + length);
        let margin = AT_ONCE.max(1e-9 * time.abs());
        if !to.is_finite() || length < 0.0 {
            return Err(Wrong::Error(format!("a step cannot have the length {length}")));
        }
        if (from - time).abs() > margin {
            return Err(Wrong::Error(format!(
                "the step begins at {from}, but the last one has ended at {time}"
            )));
        }
        if self.state.experiment.stop.is_some_and(|stop| to > stop + margin) {
            return Err(Wrong::Error(format!("the step leads past the stop time to {to}")));
        }
        let state = &mut self.state;
        let due = state.system.is_event_due(state.time, &state.x);
        let is_due = due.map_err(|failure| self.explained(SimErrorKind::Evaluation(failure)))?;
        if is_due && self.kind.ends_steps_at_events() {
            return Ok(Ended::AtEvent);
        }
        if self.state.inputs_changed || is_due {
            self.state.next_step = None;
            let mut outcome = EventOutcome::Again;
            while outcome == EventOutcome::Again {
                outcome = self.handle_event()?;
            }
            if outcome == EventOutcome::Terminate {
                return Ok(Ended::Terminated);
            }
        }
        if to <= time {
            return Ok(Ended::AtStop);
        }
        self.integrate(to)
    }

    fn integrate(&mut self, to: f64) -> Result<Ended, Wrong> {
        let method = find_integrator(METHOD).map_err(|fault| Wrong::Error(fault.message))?;
        let settings = Settings {
            start: self.state.time,
            stop: to,
            output: OutputGrid::At(Vec::new()),
            tolerance: self.state.experiment.tolerance,
            method,
            // What followed the last step follows it still; after an event, the whole way is tried.
            initial_step: Some(self.state.next_step.take().unwrap_or(to - self.state.time)),
            stops_at_events: self.kind.ends_steps_at_events(),
            ..Settings::default()
        };
        // The integrator sees the unknowns of loops, from where the last evaluation has left them; without
        // states it sees none.
        let system = &mut self.state.system;
        let n = self.state.x.len();
        system.solve_loops(n == 0);
        let mut y = vec![0.0; n + system.n_algebraic()];
        system.unknowns(&mut y);
        y[..n].copy_from_slice(&self.state.x);
        let mut events = Trajectory::default();
        let done = self.simulator.resume(system, &settings, &mut y, &mut events);
        let system = &mut self.state.system;
        system.solve_loops(true);
        self.state.x.copy_from_slice(&y[..n]);
        self.forget_values();
        match done {
            Ok(end) => {
                self.state.time = end.time;
                self.state.next_step = end.next_step.filter(|_| end.why == Ended::AtStop);
                Ok(end.why)
            }
            Err(error) => {
                let SimError { time, .. } = error;
                let message = self.state.system.explain(&error).message.clone();
                self.state.time = time;
                Err(Wrong::Error(message))
            }
        }
    }
}
