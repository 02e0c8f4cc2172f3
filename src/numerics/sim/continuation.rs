//! Events after which an integrator continues with its past.
//!
//! At many events nothing jumps: the branches of `if x > a then f(x) else g(x)` meet at a, those of
//! upwind differences nearly do, and what a when-clause counts may have no effect on the states. The past of
//! a method, its step and its Jacobian predict what follows as well as before where the derivatives of
//! the states before and after the event, f₋ and f₊ at the same point, differ by less than the error test
//! would notice:
//!
//! ```text
//! h ‖f₊ − f₋‖ ≤ SHARE        in the norm in which the tolerance is 1
//! ```
//!
//! with the step h, or with a shorter one if it is not much shorter. A branch that bends away later is
//! found by the error test, which then lets the method restart. States that were set, algebraic
//! unknowns that have jumped and whatever leaves the comparison without values need a restart, and
//! relations at which something jumped once are not looked at again. Neither does the past tell anything
//! about unknowns of algebraic loops that the other branch leaves open. So do relations from which more
//! follows than branches: a ball that leaves the ground falls as before, but the short steps of a restart
//! are what its next impact is found in.

use super::run::Run;
use super::{Events, Modes, Residual, Sensitive, SimErrorKind};

impl Run<'_> {
    /// Takes note of the derivatives before an event at hand, if the past may be kept across it.
    pub(crate) fn look_before_event(&mut self) {
        let system = &mut *self.problem.system;
        let known = &mut *self.before_event;
        let mut switched = self.crossings.switched.iter();
        known.is_known = self.integrator.keeps_past()
            && system.n_directions() == 0
            && !system.remembers()
            && !system.is_constrained()
            && switched.all(|at| system.can_follow(*at) && !known.jumped[*at]);
        if !known.is_known {
            return;
        }
        known.y.clone_from(self.y);
        known.before.resize(known.y.len(), 0.0);
        self.problem.statistics.rhs_evaluations += 1;
        known.is_known = system.rhs(self.t, &known.y, &mut known.before).is_ok();
    }

    /// Continues from the event with the past of the integrator, if that predicts what follows.
    pub(crate) fn keep_past(&mut self) -> Result<bool, SimErrorKind> {
        if !std::mem::take(&mut self.before_event.is_known) {
            return Ok(false);
        }
        let longest = self.longest_step_with_past();
        let system = &self.problem.system;
        let is_of_loop = self.crossings.switched.iter().any(|at| system.is_of_loop(*at));
        let (t, y) = (self.t, &self.y[..]);
        let (integrator, problem) = (&mut *self.integrator, &mut self.problem);
        let continues = longest.is_some_and(|longest| {
            (!is_of_loop || integrator.determines_unknowns(problem, t, y))
                && integrator.continue_from(t, y, longest)
        });
        if !continues {
            self.before_event.note_jump(&self.crossings.switched);
            return Ok(false);
        }
        self.start_crossings()?;
        self.problem.statistics.continued += 1;
        Ok(true)
    }

    /// The longest step over which the past predicts as well as before the event.
    fn longest_step_with_past(&mut self) -> Option<f64> {
        let (known, problem) = (&mut *self.before_event, &mut self.problem);
        let n = problem.system.n_differential();
        if !known.has_states(self.y, n) {
            return None;
        }
        known.after.resize(known.y.len(), 0.0);
        problem.statistics.rhs_evaluations += 1;
        problem.system.rhs(self.t, &known.y, &mut known.after).ok()?;
        let (tolerance, tested) = (problem.settings.tolerance, problem.n_tested());
        known.longest_step(self.y, (n, tested), problem.nominal, tolerance)
    }
}

#[cfg(test)]
mod tests {
    use crate::sim::problems::TestProblem;
    use crate::sim::{EventOutcome, OutputGrid, Settings, find_integrator, simulate};

    const METHODS: [&str; 3] = ["dassl", "rodas4", "radau"];

    fn settings(method: &str, tolerance: f64) -> Settings {
        Settings {
            stop: 1.0,
            tolerance,
            output: OutputGrid::Intervals(50),
            method: find_integrator(method).unwrap(),
            ..Settings::default()
        }
    }

    /// The branch changes where the function is zero; `event` may do something besides.
    fn branching(
        initial: &[f64],
        rhs: fn(f64, &[f64], &[f64], &mut [f64]),
        crossing: fn(f64, &[f64], &[f64], &mut [f64]),
        event: fn(f64, &mut [f64], &mut [f64]) -> EventOutcome,
    ) -> TestProblem {
        let problem = TestProblem::new(initial, initial.len(), rhs).with_branches();
        problem.with_discrete(&[0.0]).with_crossings(1, crossing, event)
    }

    fn switch(_: f64, _: &mut [f64], discrete: &mut [f64]) -> EventOutcome {
        discrete[0] = 1.0;
        EventOutcome::Continue { y_changed: true }
    }

    /// As [`switch`]; a state is set besides, to the next number.
    fn switch_and_set(t: f64, y: &mut [f64], discrete: &mut [f64]) -> EventOutcome {
        y[0] = y[0].next_up();
        switch(t, y, discrete)
    }

    /// x' = -max(x, 1/2), x(0) = 1: the branches meet, and bend.
    fn kink(event: fn(f64, &mut [f64], &mut [f64]) -> EventOutcome) -> TestProblem {
        let rhs: fn(f64, &[f64], &[f64], &mut [f64]) =
            |_, y, discrete, out| out[0] = if discrete[0] == 0.0 { -y[0] } else { -0.5 };
        branching(&[1.0], rhs, |_, y, _, out| out[0] = y[0] - 0.5, event)
    }

    fn exact_kink(t: f64) -> f64 {
        let ln2 = std::f64::consts::LN_2;
        if t < ln2 { (-t).exp() } else { 0.5 - 0.5 * (t - ln2) }
    }

    #[test]
    fn where_branches_meet_the_past_is_kept_and_saves_steps() {
        for method in METHODS {
            for tolerance in [1e-4, 1e-6, 1e-8] {
                let settings = settings(method, tolerance);
                let (trajectory, with_past) = simulate(&mut kink(switch), &settings).unwrap();
                let (_, restarted) = simulate(&mut kink(switch_and_set), &settings).unwrap();
                assert_eq!((with_past.state_events, with_past.continued), (1, 1), "{method}");
                assert_eq!((restarted.state_events, restarted.continued), (1, 0), "{method}");
                let costs = [with_past, restarted].map(|s| s.attempts());
                assert!(costs[0] <= costs[1], "{method} at {tolerance:e}: {costs:?}");
                assert!(with_past.jacobian_evaluations <= restarted.jacobian_evaluations);
                for (t, x) in trajectory.time().iter().zip(trajectory.column(0)) {
                    let error = (x - exact_kink(*t)).abs();
                    assert!(error < 2.0 * tolerance, "{method}: {error:e} at {t}");
                }
            }
        }
    }

    #[test]
    fn the_multistep_method_does_not_begin_again_where_nothing_changes() {
        let rhs: fn(f64, &[f64], &[f64], &mut [f64]) = |_, y, _, out| out[0] = -y[0];
        let cost = |event| {
            let mut problem = branching(&[1.0], rhs, |_, y, _, out| out[0] = y[0] - 0.5, event);
            simulate(&mut problem, &settings("dassl", 1e-6)).unwrap().1
        };
        let (_, smooth) =
            simulate(&mut crate::sim::problems::decay(), &settings("dassl", 1e-6)).unwrap();
        let (with_past, restarted) = (cost(switch), cost(switch_and_set));
        assert!(with_past.attempts() <= smooth.attempts() + 3, "{with_past:?} {smooth:?}");
        assert!(with_past.attempts() + 5 < restarted.attempts(), "{with_past:?} {restarted:?}");
        assert_eq!((with_past.jacobian_evaluations, restarted.jacobian_evaluations), (1, 2));
    }

    #[test]
    fn where_the_derivative_jumps_there_is_a_restart() {
        // x' = 1 until x = 1/2, then 2.
        let rhs: fn(f64, &[f64], &[f64], &mut [f64]) =
            |_, _, discrete, out| out[0] = 1.0 + discrete[0];
        for method in METHODS {
            let mut problem = branching(&[0.0], rhs, |_, y, _, out| out[0] = y[0] - 0.5, switch);
            let (trajectory, statistics) = simulate(&mut problem, &settings(method, 1e-6)).unwrap();
            assert_eq!((statistics.state_events, statistics.continued), (1, 0), "{method}");
            let x = trajectory.at(0, 1.0).unwrap();
            assert!((x - 1.5).abs() < 1e-6, "{method}: {x}");
        }
    }

    #[test]
    fn where_more_than_branches_follows_there_is_a_restart() {
        let mut problem = kink(switch);
        problem.only_branches = false;
        let (_, statistics) = simulate(&mut problem, &settings("dassl", 1e-6)).unwrap();
        assert_eq!((statistics.state_events, statistics.continued), (1, 0));
    }

    #[test]
    fn a_branch_that_bends_away_at_once_is_followed() {
        // u' = -1, z' = -z and from u = 1/2 on -z + 1e3 (1/2 - u): no jump, but 1e3 more per second.
        let rhs: fn(f64, &[f64], &[f64], &mut [f64]) = |_, y, discrete, out| {
            out[0] = -1.0;
            out[1] = -y[1] + 1e3 * discrete[0] * (0.5 - y[0]);
        };
        let exact = |t: f64| {
            let since = (t - 0.5).max(0.0);
            (-t).exp() + 1e3 * (since - 1.0 + (-since).exp())
        };
        for method in METHODS {
            for tolerance in [1e-4, 1e-6, 1e-8] {
                let mut problem =
                    branching(&[1.0, 1.0], rhs, |_, y, _, out| out[0] = y[0] - 0.5, switch);
                let (trajectory, statistics) =
                    simulate(&mut problem, &settings(method, tolerance)).unwrap();
                assert_eq!(statistics.continued, 1, "{method}");
                for (t, z) in trajectory.time().iter().zip(trajectory.column(1)) {
                    let error = (z - exact(*t)).abs() / exact(*t).max(1.0);
                    assert!(
                        error < 10.0 * tolerance,
                        "{method} at {tolerance:e}: {error:e} at {t}"
                    );
                }
            }
        }
    }

    #[test]
    fn algebraic_unknowns_that_jump_need_a_restart() {
        // x' = -x, 0 = v - x, from x = 1/2 on 0 = v - x - 1.
        let rhs: fn(f64, &[f64], &[f64], &mut [f64]) = |_, y, discrete, out| {
            out[0] = -y[0];
            out[1] = y[1] - y[0] - discrete[0];
        };
        let problem = TestProblem::new(&[1.0, 1.0], 1, rhs).with_branches().with_discrete(&[0.0]);
        let mut problem = problem.with_crossings(
            1,
            |_, y, _, out| out[0] = y[0] - 0.5,
            |t, y, discrete| {
                y[1] = y[0] + 1.0;
                switch(t, y, discrete)
            },
        );
        let (trajectory, statistics) = simulate(&mut problem, &settings("dassl", 1e-6)).unwrap();
        assert_eq!((statistics.state_events, statistics.continued), (1, 0));
        let v = trajectory.at(1, 1.0).unwrap();
        assert!((v - 1.0 - (-1f64).exp()).abs() < 1e-5, "{v}");
    }
}
