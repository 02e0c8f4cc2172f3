//! Functional mock-up units (FMI 2.0.5 and 3.0.2): what their `modelDescription.xml` says, the
//! archive in which they come, and their simulation.
//!
//! ```text
//! x.fmu ──archive──▶ files        modelDescription.xml ──description::read──▶ Description
//!                                                      ◀──description::write──
//! Program ──export──▶ Unit: description, program, runtime ──▶ archive
//! ```
//!
//! [`parameter_set`] has values of parameters in files of their own (SSP 1.0), with the intervals of a fit.
//! [`import`] simulates the units of others, in processes of their own.
//!
//! Both versions of the standard have one [`Description`]: what refers to variables by their place in
//! FMI 2.0 and by their value reference in FMI 3.0 refers to them by their place here.

#![cfg_attr(test, allow(clippy::disallowed_methods, reason = "expectations of tests"))]

// Modules and macros of lower crates, under the names that they have there.
pub(crate) use gapilib_base::{diag, fault, source, units};
pub(crate) use gapilib_modelica::{codegen, flatten, lower};
pub(crate) use gapilib_numerics::sim;

pub mod archive;
pub mod description;
mod errors;
pub mod export;
pub mod import;
pub mod parameter_set;
mod xml;

pub use archive::Archive;
pub use description::Description;
pub use errors::FmuError;
pub use parameter_set::ParameterSet;
