//! The numbers of gapilib, without Modelica:
//!
//! - [`sim`]: integrators, events, trajectories;
//! - [`frequency`]: the response of linear systems to oscillations, their poles and zeros;
//! - [`ga`]: the genetic algorithm and other optimizers;
//! - [`kramers_kronig`]: whether a spectrum can be that of a linear system;
//! - [`mat`], [`results`]: tables of numbers and results of simulations, in files.

#![cfg_attr(
    not(all(feature = "jit", feature = "xlsx", feature = "hdf5")),
    allow(dead_code, unused_imports, reason = "what only the parts that are left out use")
)]
#![cfg_attr(test, allow(clippy::disallowed_methods, reason = "expectations of tests"))]

// Modules and macros of lower crates, under the names that they have there.
pub(crate) use gapilib_base::{
    bail, budget, codes, diag, elementary, fault, registry, singular_values, units,
};

pub mod frequency;
pub mod ga;
pub mod kramers_kronig;
pub mod mat;
pub mod results;
pub mod sim;
