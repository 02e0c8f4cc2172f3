//! Models and problems of other programs, as Modelica text, problem files and tables of data:
//!
//! - [`sbml`]: models in the Systems Biology Markup Language, levels 2 and 3;
//! - [`petab`]: parameter estimation problems with such models.
//!
//! ```text
//! SBML ──document──▶ Document ──translation──▶ Modelica text
//! PEtab ──tables──▶ rows ──experiments──▶ problem file (TOML), data (CSV), Modelica text
//! ```
//!
//! Nothing here accesses files: text comes in, text goes out.

#![cfg_attr(test, allow(clippy::disallowed_methods, reason = "expectations of tests"))]

// Modules and macros of lower crates, under the names that they have there.
pub(crate) use gapilib_base::{diag, elementary, registry};

mod expression;
mod names;
pub mod petab;
mod refusal;
pub mod sbml;

pub use refusal::Refusal;
