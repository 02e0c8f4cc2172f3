//! What the verdicts of a solution rest on, kept for what is computed later.

use super::Profile;

/// What the verdicts of a solution rest on.
#[derive(Debug, Clone, Default)]
pub struct Grounds {
    /// Linear intervals, not cut at the ranges.
    pub(super) linear: Vec<Option<[f64; 2]>>,
    /// How many standard errors the linear optimum lies beyond the end of the range that a parameter is
    /// at, and the reach of the linear interval to both sides.
    pub(super) pulls: Vec<Option<(f64, [f64; 2])>>,
    /// Which parameters have a derivative that vanishes at the best values.
    pub(super) flat: Vec<bool>,
    /// Groups of parameters whose changes cancel near the best values.
    pub(super) groups: Vec<Vec<usize>>,
    /// Degrees of freedom of the residual variance.
    pub(super) freedom: f64,
    /// The root of the rise of the sum of squares within the 95 % limit, in units of that variance.
    pub(super) quantile: f64,
    /// Complete profiles, and their parameters.
    pub(super) profiles: Vec<(usize, Profile)>,
    /// A better fit that they found.
    pub(super) better: Option<(Vec<f64>, f64)>,
}
