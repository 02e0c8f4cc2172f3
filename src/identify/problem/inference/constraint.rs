//! Constraints between parameters, such as `a < b`: inequalities that every simulated point obeys.

use super::Term;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Values nearer to a constraint than this fraction of its sides are at it.
const AT_LIMIT: f64 = 1e-3;

/// The smaller and the larger side at values of the parameters.
pub(crate) type Sides = Arc<dyn Fn(&[f64]) -> [f64; 2] + Send + Sync>;

/// What is compared.
#[derive(Clone)]
enum Compared {
    Terms([Term; 2]),
    Function(Sides),
}

/// A constraint as another process can read it.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(crate) struct PortableConstraint {
    text: String,
    terms: [Term; 2],
}

/// An inequality that must hold.
#[derive(Clone)]
pub struct Constraint {
    /// As it is written.
    pub text: String,
    compared: Compared,
}

impl std::fmt::Debug for Constraint {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Constraint({})", self.text)
    }
}

impl Constraint {
    /// The first of `sides` must not exceed the second.
    pub fn new(text: impl Into<String>, sides: Sides) -> Constraint {
        Constraint { text: text.into(), compared: Compared::Function(sides) }
    }

    /// The first of two terms must not exceed the second.
    pub fn of_terms(text: impl Into<String>, terms: [Term; 2]) -> Constraint {
        Constraint { text: text.into(), compared: Compared::Terms(terms) }
    }

    /// The constraint as another process can read it; `None` where it is a function in Rust.
    pub(super) fn portable(&self) -> Option<PortableConstraint> {
        match &self.compared {
            Compared::Terms(terms) => {
                Some(PortableConstraint { text: self.text.clone(), terms: terms.clone() })
            }
            Compared::Function(_) => None,
        }
    }

    /// By how much it is violated, as a fraction of its sides; 0 where it holds.
    pub fn violation(&self, parameters: &[f64]) -> f64 {
        let margin = self.margin(parameters);
        if margin >= 0.0 {
            0.0
        } else if margin.is_nan() {
            f64::INFINITY
        } else {
            -margin
        }
    }

    /// Whether these values lie at its limit.
    pub fn is_active(&self, parameters: &[f64]) -> bool {
        self.margin(parameters).abs() < AT_LIMIT
    }

    /// What is left up to the limit, as a fraction of its sides; negative where it is violated.
    pub(in crate::problem) fn margin(&self, parameters: &[f64]) -> f64 {
        let [smaller, larger] = match &self.compared {
            Compared::Terms(terms) => terms.each_ref().map(|term| term.value(parameters)),
            Compared::Function(sides) => sides(parameters),
        };
        let size = smaller.abs() + larger.abs();
        if size == 0.0 { 0.0 } else { (larger - smaller) / size }
    }
}

impl From<PortableConstraint> for Constraint {
    fn from(portable: PortableConstraint) -> Constraint {
        Constraint::of_terms(portable.text, portable.terms)
    }
}
