//! The classical Runge-Kutta method of order 4 with fixed step.
//!
//! ```text
//!  0  |
//! 1/2 | 1/2
//! 1/2 |  0   1/2
//!  1  |  0    0    1
//! ----+--------------------
//!     | 1/6  1/3  1/3  1/6
//! ```

use super::Integrator;
use super::explicit::{ExplicitRungeKutta, Tableau};
use crate::registry::Entry;

pub(super) const ENTRY: Entry<dyn Integrator> = Entry {
    name: "rungekutta",
    aliases: &["rk4", "rkfix4"],
    summary: "classical explicit Runge-Kutta method, order 4, fixed step",
    reference: "hairer-norsett-wanner-1993",
    make: |_| Ok(Box::new(ExplicitRungeKutta::new(&TABLEAU))),
};

static TABLEAU: Tableau = Tableau {
    nodes: &[0.0, 0.5, 0.5, 1.0],
    stages: &[&[], &[0.5], &[0.0, 0.5], &[0.0, 0.0, 1.0]],
    weights: &[1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0],
    embedded: None,
};
