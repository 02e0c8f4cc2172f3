//! Runge-Kutta methods with fixed step: Heun's of order 2, Kutta's of order 3 and the classical one
//! of order 4, which is
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

pub const ENTRY: Entry<dyn Integrator> = Entry {
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

pub(crate) const ORDER_2: Entry<dyn Integrator> = Entry {
    name: "rkfix2",
    aliases: &["heun"],
    summary: "Heun's explicit Runge-Kutta method, order 2, fixed step",
    reference: "hairer-norsett-wanner-1993",
    make: |_| Ok(Box::new(ExplicitRungeKutta::new(&HEUN))),
};

static HEUN: Tableau =
    Tableau { nodes: &[0.0, 1.0], stages: &[&[], &[1.0]], weights: &[0.5, 0.5], embedded: None };

pub(crate) const ORDER_3: Entry<dyn Integrator> = Entry {
    name: "rkfix3",
    aliases: &[],
    summary: "Kutta's explicit Runge-Kutta method, order 3, fixed step",
    reference: "hairer-norsett-wanner-1993",
    make: |_| Ok(Box::new(ExplicitRungeKutta::new(&KUTTA))),
};

static KUTTA: Tableau = Tableau {
    nodes: &[0.0, 0.5, 1.0],
    stages: &[&[], &[0.5], &[-1.0, 2.0]],
    weights: &[1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0],
    embedded: None,
};
