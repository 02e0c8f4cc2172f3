//! What a simulation cost.

/// What a simulation cost.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
pub struct Statistics {
    /// Accepted steps.
    pub steps: u64,
    /// Of these, steps with the exact solution of a linear system.
    pub exact_steps: u64,
    /// Of these, explicit steps of a system that was found not to be stiff.
    pub explicit_steps: u64,
    /// Steps rejected by the error test.
    pub error_failures: u64,
    /// Steps rejected because the corrector did not converge or an evaluation failed.
    pub newton_failures: u64,
    /// Evaluations of the right-hand side.
    pub rhs_evaluations: u64,
    /// Evaluations of the sensitivity equations.
    pub sensitivity_evaluations: u64,
    /// Evaluations of the Jacobian.
    pub jacobian_evaluations: u64,
    /// Numeric factorizations.
    pub factorizations: u64,
    /// State events.
    pub state_events: u64,
    /// Time events.
    pub time_events: u64,
    /// Events, of both kinds, after which the integrator continued without a restart.
    pub continued: u64,
    /// Relations that chattered and were evaluated between steps from then on.
    pub followed: u64,
    /// Intervals in which the solution slid along discontinuities.
    pub slides: u64,
    /// Accumulations of impacts after which the solution rests.
    pub accumulations: u64,
}

impl Statistics {
    /// Steps, rejected ones included.
    pub fn attempts(&self) -> u64 {
        self.steps + self.error_failures + self.newton_failures
    }
}
