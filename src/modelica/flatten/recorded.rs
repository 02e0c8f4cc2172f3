//! Inputs whose values are recorded samples. Data only.

use std::sync::Arc;

/// An input at the top level that follows samples.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordedInput {
    /// Its name.
    pub name: Arc<str>,
    /// Times of the samples, seconds, ascending. Two samples at one time are the values before and
    /// after a jump. Before the first sample the input has its value, after the last one that of
    /// the last.
    pub times: Arc<[f64]>,
    /// The samples.
    pub values: Arc<[f64]>,
    /// Whether each value is held until the next sample (zero-order hold); otherwise the input is
    /// linear between them.
    pub is_held: bool,
}
