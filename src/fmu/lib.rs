//! The shared library in the units that `gapi export-fmu` writes: it simulates compiled models by
//! the functions of FMI 2.0.5 and 3.0.2. The same library serves all units; what differs is the file
//! `resources/model.gapi`.
//!
//! ```text
//! version_2, version_3   the functions of the standard: pointers, names, callbacks
//! signatures             those of both that differ in their names alone
//! boundary               instances as pointers; errors, panics and messages at the boundary
//! instance               an instance of either version: modes, values
//! co_simulation          steps of an instance by its own integrator
//! derivatives            directional and adjoint derivatives
//! loading                the file of the model, read once in a process
//! ```
//!
//! A function that fails returns the status `Error`, or `Discard` where a shorter step may help, and
//! says why in a message. Nothing panics across the boundary.

#![cfg_attr(test, allow(clippy::disallowed_methods, reason = "expectations of tests"))]

// Modules of lower crates, under the names that they have there.
pub(crate) use gapilib_fmi as fmi;
pub(crate) use gapilib_modelica::{codegen, runtime};
pub(crate) use gapilib_numerics::sim;

mod boundary;
mod co_simulation;
mod derivatives;
mod instance;
mod known_derivatives;
mod loading;
mod signatures;
mod version_2;
mod version_3;
