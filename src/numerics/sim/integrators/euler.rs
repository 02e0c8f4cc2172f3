//! Euler's method with fixed step: x₁ = x₀ + h f(t₀, x₀).

use super::Integrator;
use super::explicit::{ExplicitRungeKutta, Tableau};
use crate::registry::Entry;

pub const ENTRY: Entry<dyn Integrator> = Entry {
    name: "euler",
    aliases: &[],
    summary: "explicit Euler method, order 1, fixed step",
    reference: "hairer-norsett-wanner-1993",
    make: |_| Ok(Box::new(ExplicitRungeKutta::new(&TABLEAU))),
};

static TABLEAU: Tableau =
    Tableau { nodes: &[0.0], stages: &[&[]], weights: &[1.0], embedded: None };
