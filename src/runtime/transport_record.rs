//! What has been recorded of a variable `delay` or of the content of a pipe.

use super::profile::Profile;

/// The record of one variable `delay` or `spatialDistribution`.
#[derive(Debug, Clone, Default)]
pub(super) struct Record {
    pub(super) profile: Profile,
    /// The longest delay, or the length of the pipe.
    pub(super) longest: f64,
    /// Whether the velocity was positive when it was recorded last.
    pub(super) positive: bool,
    /// Time and position then, and the velocity between the last two.
    pub(super) last: (f64, f64),
    pub(super) velocity: f64,
    /// The delay time then.
    pub(super) delay: f64,
    /// What went in at the start.
    pub(super) first: Vec<f64>,
}
