//! Sensitivities of the weighted points by the parameters.

/// Sensitivities at a point: one column for each parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct Sensitivities {
    /// Where.
    pub values: Vec<f64>,
    /// Derivatives of the weighted points.
    pub columns: Vec<Vec<f64>>,
}
