//! Initial systems that are not solved with the parameters that were set: from the solution with those
//! that the model gives itself, which its author has tried, on the straight line to those.
//!
//! ```text
//! p(λ) = (1 − λ) p₀ + λ p        λ = 1 at once; shorter steps where a solution is missed
//! ```
//!
//! The unknowns of loops begin each step with the solution before it. What is not a Real has the value
//! that was set from the first step on. The start with the parameters of the model is solved once for
//! all simulations: no result depends on which parameters came before.

use super::initial_system::places;
use super::state::SolvedStart;
use super::system::System;
use crate::flatten::BaseType;
use crate::sim::Failure;

/// The shortest step, of the whole way. Modelica.Fluid.Examples.HeatingSystem with a radiator of 5 m or
/// 20 m, walls of 60 W/K or 100 W/K and a burner of 60 W to 3 kW, where its author has 10 m, 80 W/K and
/// 1.6 kW, needs no more than the first step, of the whole way.
const SMALLEST_STEP: f64 = 1e-3;

impl System {
    /// Whether parameters have other values than the model gives them.
    pub(super) fn has_other_parameters(&self) -> bool {
        let mut pairs = self.set.iter().zip(self.program.parameters());
        pairs.any(|(set, parameter)| set.is_some_and(|value| value != parameter.default))
    }

    /// Solves the initial system from the solution with the parameters of the model.
    pub(super) fn lead_from_own_parameters(&mut self, t: f64) -> Result<(), Failure> {
        let mut reached = self.start_with_own_parameters(t)?;
        let goal = self.set.clone();
        let outcome = self.follow_parameters(t, &goal, &mut reached);
        self.set = goal;
        outcome
    }

    /// The start with the parameters of the model.
    fn start_with_own_parameters(&mut self, t: f64) -> Result<Vec<f64>, Failure> {
        let unsolved = Failure::Initialization { block: 0 };
        let known = self.loops.own_start.take();
        let is_known = |start: &SolvedStart| start.time == t && start.given == self.inputs.given;
        let start = match known.filter(|start| is_known(start)) {
            Some(start) => start,
            None => {
                let set = vec![None; self.set.len()];
                let set = std::mem::replace(&mut self.set, set);
                let is_brief = std::mem::replace(&mut self.loops.is_brief, false);
                let solved = self.solve_from_start_values(t).is_ok();
                self.loops.is_brief = is_brief;
                self.set = set;
                let program = &self.program;
                let values = solved.then(|| places(program).map(|at| self.registers[at]).collect());
                Box::new(SolvedStart { time: t, given: self.inputs.given.clone(), values })
            }
        };
        self.loops.own_start.insert(start).values.clone().ok_or(unsolved)
    }

    fn follow_parameters(
        &mut self,
        t: f64,
        goal: &[Option<f64>],
        reached: &mut [f64],
    ) -> Result<(), Failure> {
        let (mut done, mut step) = (0.0, 1.0);
        while done < 1.0 {
            let next = f64::min(done + step, 1.0);
            self.set_between(goal, next);
            match self.solve_start_from(t, reached) {
                Ok(()) => {
                    let program = self.program.clone();
                    reached.iter_mut().zip(places(&program)).for_each(|(value, at)| {
                        *value = self.registers[at];
                    });
                    done = next;
                    step *= 2.0;
                }
                Err(failure) => {
                    step *= 0.25;
                    if step < SMALLEST_STEP {
                        return Err(failure);
                    }
                }
            }
        }
        Ok(())
    }

    /// Sets parameters at a part of the way from those of the model to others.
    fn set_between(&mut self, goal: &[Option<f64>], part: f64) {
        let parameters = self.program.parameters().iter();
        for ((set, goal), parameter) in self.set.iter_mut().zip(goal).zip(parameters) {
            *set = goal.map(|value| match parameter.base {
                BaseType::Real if part < 1.0 => {
                    parameter.default + part * (value - parameter.default)
                }
                _ => value,
            });
        }
    }
}
