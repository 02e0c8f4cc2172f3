//! What all parts of gapilib share, and what knows nothing of Modelica, of simulation or of files:
//!
//! - [`source`], [`name`], [`diag`], [`registry`], [`budget`]: places, names, diagnostics, named
//!   choices, limits;
//! - [`elementary`], [`singular_values`]: functions with the same bits on every machine;
//! - [`graph`], [`units`]: matching, sorting and tearing; units of measurement and their conversion;
//! - [`plot`], [`page`]: figures and HTML pages;
//! - [`bibliography`]: the works that are cited.

#![cfg_attr(
    not(feature = "pictures"),
    allow(dead_code, unused_imports, reason = "what only the parts that are left out use")
)]
#![cfg_attr(test, allow(clippy::disallowed_methods, reason = "expectations of tests"))]

pub mod bibliography;
pub mod budget;
pub mod diag;
pub mod elementary;
pub mod graph;
pub mod name;
pub mod page;
pub mod plot;
pub mod registry;
pub mod singular_values;
pub mod source;
pub mod units;
