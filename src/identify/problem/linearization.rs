//! A linear model of the simulation at one place.

/// The simulated points and their derivatives at one place.
#[derive(Debug, Clone, PartialEq)]
pub struct Linearization {
    /// The simulated points.
    pub simulated: Vec<f64>,
    /// Derivatives by the values of the parameters, points × parameters; NaN in the column of a
    /// parameter beside which nothing can be simulated.
    pub derivatives: Vec<f64>,
    /// Whether they are exact, not differences.
    pub exact: bool,
    /// Why they are not, in words that follow on "because"; `None` where no reason is known.
    pub refusal: Option<String>,
    /// Simulations that they took; one with sensitivities counts once.
    pub simulations: u64,
    /// For each parameter the part of its column that scales and offsets of relative data do not make
    /// up for; empty where there are none.
    pub(crate) shares: Vec<f64>,
}
