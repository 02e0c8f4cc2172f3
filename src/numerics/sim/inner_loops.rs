//! Algebraic loops solved inside of the right-hand side: where the integrator, which else holds the
//! iteration variables as unknowns of its own, cannot continue with them.
//!
//! A fan at rest whose flow rate is given has the speed r with r |r| = 0: the Jacobian is singular
//! there, and r' is infinite where the flow begins. Solving the loop at each evaluation needs
//! neither. From there to the end the integrator sees the states alone, with a full Jacobian by
//! difference quotients.

use super::run::{After, Run};
use super::{Residual, Sensitive, SimErrorKind};

/// A full Jacobian of more states takes too long.
const MOST_STATES: usize = 400;

impl Run<'_> {
    /// Continues with loops solved inside. Fails with `kind`, unless this is a failure of the
    /// integrator and there are loops that it holds.
    pub(super) fn take_loops_inside(&mut self, kind: SimErrorKind) -> Result<After, SimErrorKind> {
        let system = &mut *self.problem.system;
        let n = system.n_differential();
        let is_numerical = matches!(kind, SimErrorKind::Singular | SimErrorKind::StepSize);
        let has_loops = system.n_algebraic() > 0 && (1..=MOST_STATES).contains(&n);
        if !is_numerical || !has_loops || system.n_directions() > 0 || system.is_constrained() {
            return Err(kind);
        }
        system.solve_loops(true);
        if system.n_algebraic() > 0 {
            return Err(kind);
        }
        self.solves_loops = true;
        self.y.truncate(n);
        self.nominals.show_states(n);
        self.problem.nominal = self.nominals.plain();
        // A loop that has no solution here says more than a step that is too small.
        self.restart().map_err(|inside| match inside {
            SimErrorKind::Evaluation(_) => inside,
            _ => kind,
        })?;
        Ok(After::Restarted)
    }
}
