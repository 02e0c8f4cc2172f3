//! A run as it is now: data for drawing it during the run.

/// How far a long piece of work is: data for drawing it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Progress {
    /// What is being done, such as `generation`.
    pub label: String,
    /// Units done.
    pub done: u64,
    /// Units in all; 0 where not known.
    pub total: u64,
    /// The best value so far, smaller is better.
    pub best: Option<f64>,
    /// What failed so far.
    pub failures: u64,
    /// Why most of them failed, and how many for this reason; where it is known.
    pub main_cause: Option<(String, u64)>,
}

/// What there is to see of a run.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct View {
    /// The heading.
    pub title: String,
    /// How far it is.
    pub progress: Progress,
    /// The best fitness after each generation.
    pub best: Vec<f64>,
    /// Where the individuals of the last generation lie, parameter by parameter.
    pub spreads: Vec<Spread>,
    /// Measured series beside the simulation of the best individual.
    pub fitted: Vec<Fitted>,
}

/// Where a generation lies in the search range of one parameter.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Spread {
    /// The parameter.
    pub name: String,
    /// Its unit; empty where there is none.
    pub unit: String,
    /// Its best value so far.
    pub value: f64,
    /// Where that lies, as a fraction of the range.
    pub best: f64,
    /// The smallest, the middle and the largest of the generation, as fractions of the range.
    pub generation: [f64; 3],
}

/// A measured series and its simulation.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Fitted {
    /// What was measured, with its unit.
    pub y_name: String,
    /// What it is given over, with its unit.
    pub x_name: String,
    /// X of the points.
    pub x: Vec<f64>,
    /// Measured Y.
    pub measured: Vec<f64>,
    /// Simulated Y; empty while nothing was simulated successfully.
    pub simulated: Vec<f64>,
}

impl Spread {
    /// The spread of fractions in any order; `None` where there are none.
    pub fn of(mut fractions: Vec<f64>) -> Option<[f64; 3]> {
        fractions.sort_by(f64::total_cmp);
        let (first, last) = (*fractions.first()?, *fractions.last()?);
        Some([first, fractions[fractions.len() / 2], last])
    }
}

/// A name with its unit, if it has one.
pub(super) fn labelled(name: &str, unit: &str) -> String {
    if unit.is_empty() || unit == "1" { name.to_owned() } else { format!("{name} / {unit}") }
}
