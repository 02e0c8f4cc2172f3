//! Individuals: a genome with its fitness.

/// The fitness of an individual whose simulation failed; smaller is better.
pub const FAILED_FITNESS: f64 = 1e60;

/// Whether a fitness is that of a failed simulation (or not a number at all).
pub fn has_failed(fitness: f64) -> bool {
    fitness.is_nan() || fitness >= FAILED_FITNESS
}

/// A candidate solution and how good it is.
#[derive(Debug, Clone, PartialEq)]
pub struct Individual {
    /// Values of its genes.
    pub genome: Vec<f64>,
    /// Smaller is better; [`FAILED_FITNESS`] when its simulation failed.
    pub fitness: f64,
}
