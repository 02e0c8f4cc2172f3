//! The Modelica compiler of gapilib, from the text of classes to systems that are simulated:
//!
//! ```text
//! text ─syntax▶ tree ─flatten▶ FlatModel ─lower▶ Dae ─causalize▶ CausalizedDae ─codegen▶ Program
//!                                                                      System ◀─runtime─────┘
//! ```
//!
//! - [`syntax`], [`mod@format`]: the grammar of classes and scripts, trees, printing, layout;
//! - [`value`], [`functions`], [`external`], [`eval`]: values, the functions and operators of the
//!   language, `external` functions of libraries, the interpreter; `execute`: the walk of statements
//!   that the interpreter, equations and the code of functions share;
//! - `inference`: types and sizes of values, as far as expressions show them;
//! - `names`: the lookup of names; [`flatten`], [`lower`]: from a class to a flat model, to a system of differential-algebraic
//!   equations;
//! - [`symbolic`], [`causalize`]: scalar expressions; index reduction, block lower triangular form,
//!   tearing;
//! - [`arithmetic`], [`bytecode`], [`codegen`], [`runtime`]: what instructions compute, functions as
//!   instructions, a program of instruction tapes, and the systems that execute it.

#![cfg_attr(
    not(feature = "jit"),
    allow(dead_code, unused_imports, reason = "what only the parts that are left out use")
)]
#![cfg_attr(test, allow(clippy::disallowed_methods, reason = "expectations of tests"))]

// Modules and macros of lower crates, under the names that they have there.
pub(crate) use gapilib_base::{
    bail, budget, codes, diag, elementary, fault, graph, name, singular_values, source, units,
};
pub(crate) use gapilib_numerics::{mat, sim};

pub mod arithmetic;
pub mod bytecode;
pub mod causalize;
pub mod codegen;
pub mod eval;
mod execute;
pub mod external;
pub mod flatten;
pub mod format;
pub mod functions;
mod inference;
mod jit;
pub mod lower;
mod names;
pub mod runtime;
pub mod symbolic;
pub mod syntax;
pub mod value;
