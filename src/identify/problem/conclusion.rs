//! What was done after the search.

use super::Finding;

/// What was done after the search.
#[derive(Debug, Clone, Default)]
pub(crate) struct Conclusion {
    /// In words.
    pub findings: Vec<Finding>,
    /// Simulations that it took.
    pub simulations: u64,
    /// Whether a finer tolerance moves the best point by little against the errors of the data, so
    /// that the residuals are not those of the solver.
    pub resolved: bool,
    /// Where the best point was found a minimum by second derivatives: the reach of the differences
    /// that they come from, as a fraction of the ranges.
    pub(crate) by_curvature: Option<f64>,
    /// Parameters that are held at the best point by a kink of the objective, or that can change to
    /// the end of their range without any effect on it.
    pub held: Vec<usize>,
}
