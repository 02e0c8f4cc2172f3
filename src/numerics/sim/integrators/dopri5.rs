//! The method of Dormand and Prince: order 5 with an embedded method of order 4 for the error and
//! an interpolation of order 4.
//!
//! Coefficients: Hairer, Nørsett & Wanner, Solving Ordinary Differential Equations I, table II.5.2
//! and section II.6.

use super::Integrator;
use super::explicit::{Embedded, ExplicitRungeKutta, Tableau};
use crate::registry::Entry;

pub const ENTRY: Entry<dyn Integrator> = Entry {
    name: "dopri5",
    aliases: &["dopri45", "rkf45"],
    summary: "explicit Runge-Kutta method of Dormand and Prince, order 5, variable step",
    reference: "hairer-norsett-wanner-1993",
    make: |_| Ok(Box::new(new())),
};

/// The method without workspace yet.
pub(super) fn new() -> ExplicitRungeKutta {
    ExplicitRungeKutta::new(&TABLEAU)
}

static TABLEAU: Tableau = Tableau {
    nodes: &[0.0, 0.2, 0.3, 0.8, 8.0 / 9.0, 1.0],
    stages: &[
        &[],
        &[0.2],
        &[3.0 / 40.0, 9.0 / 40.0],
        &[44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0],
        &[19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0],
        &[9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0],
    ],
    weights: &[35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0],
    embedded: Some(Embedded {
        order: 4,
        error: &[
            71.0 / 57600.0,
            0.0,
            -71.0 / 16695.0,
            71.0 / 1920.0,
            -17253.0 / 339200.0,
            22.0 / 525.0,
            -1.0 / 40.0,
        ],
        coarse_error: None,
        inner_stages: &[],
        dense: &[&[
            -12715105075.0 / 11282082432.0,
            0.0,
            87487479700.0 / 32700410799.0,
            -10690763975.0 / 1880347072.0,
            701980252875.0 / 199316789632.0,
            -1453857185.0 / 822651844.0,
            69997945.0 / 29380423.0,
        ]],
    }),
};
