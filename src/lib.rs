//! Identifies the parameters of Modelica models from measured data with a genetic algorithm, by
//! running the scripts of GAPILib ([Rubio et al. 2006](bibliography#rubio-2006)) unchanged.
//!
//! ```
//! use gapilib::script::world::MemoryWorld;
//! use gapilib::script::Session;
//! use gapilib::value::Value;
//!
//! let world = MemoryWorld::new();
//! let mut session = Session::new(Box::new(world));
//! let status = session.run_text(
//!     "decay.mos",
//!     "model Decay
//!        parameter Real k = 1;
//!        Real x(start = 1, fixed = true);
//!      equation
//!        der(x) = -k*x;
//!      end Decay;
//!      translateModel(\"Decay\")
//!      k = 2
//!      simulateModel(\"Decay\", stopTime = 1, tolerance = 1e-8, resultFile = \"decay\")
//!      x = readTrajectory(\"decay.mat\", {\"x\"}, 501)
//!      last = x[1,end]",
//! );
//! assert_eq!(status.code, 0);
//! let Some(Value::Real(last)) = session.variable("last") else { panic!("no value") };
//! assert!((last - (-2.0f64).exp()).abs() < 1e-6);
//! ```
//!
//! # The way of a script
//!
//! ```text
//!  text ──syntax──▶ tree ──script, eval──▶ values, files, transcript
//!                                │
//!                                │ Eval, simulateModel, …
//!                                ▼
//!  model text ──syntax──▶ tree ──flatten──▶ FlatModel ──lower──▶ Dae
//!                                                                                 │ causalize
//!                                                                           CausalizedDae
//!                                                                                 │ codegen
//!                                                                              Program
//!                                                                                 │ runtime
//!               Outcome ◀──identify── fitness ◀── Trajectory ◀──sim── System (one a thread)
//!                                │
//!                                └── ga: selection, crossover, mutation, random numbers
//! ```
//!
//! A module owns one stage and one noun, imports only modules below it (a test checks the table in
//! `tests/suite/architecture.rs`), and never changes what the stage before it made:
//!
//! - [`elementary`]: elementary functions with the same bits on every machine;
//! - [`source`], [`name`], [`diag`], [`registry`]: places, names, diagnostics, named choices;
//! - [`syntax`]: the grammar of classes and scripts, trees, printing;
//! - [`mod@format`]: the layout of classes and scripts: indentation, blanks, line breaks;
//! - [`value`], [`symbolic`], [`graph`]: values and their operations; scalar expressions; matching,
//!   sorting, tearing;
//! - [`functions`], [`eval`]: the functions and operators of the language; the interpreter;
//! - [`external`]: functions that libraries declare `external`, in Rust;
//! - [`bytecode`]: functions that loop and branch, as instructions;
//! - [`flatten`], [`lower`]: from a class to a flat model, to a system of differential-algebraic
//!   equations;
//! - [`causalize`]: structural analysis: index reduction, block lower triangular form, tearing;
//! - [`codegen`], [`runtime`]: a program of instruction tapes, and the systems that execute it;
//! - [`sim`]: integrators, events, trajectories; knows nothing of Modelica;
//! - [`ga`], [`identify`]: the genetic algorithm; populations of simulations, and what they tell;
//! - [`units`]: units of measurement and their conversion;
//! - [`mat`], [`results`], [`plot`], [`page`]: files, figures, HTML pages;
//! - [`models`]: the Modelica packages that are part of the program;
//! - [`script`]: sessions and their commands; [`lessons`]: exercises with checks;
//! - [`lsp`]: what editors ask about open documents; [`cli`]: the command line, the only door outside.

#![cfg_attr(
    not(all(feature = "jit", feature = "xlsx", feature = "hdf5", feature = "pictures")),
    allow(dead_code, unused_imports, reason = "what only the parts that are left out use")
)]
#![cfg_attr(test, allow(clippy::disallowed_methods, reason = "expectations of tests"))]

pub mod bibliography;
pub mod diag;
pub mod elementary;
pub mod models;
pub mod name;
pub mod registry;
pub mod source;

pub mod budget;
pub mod bytecode;
pub mod causalize;
pub mod codegen;
pub mod eval;
pub mod external;
pub mod flatten;
pub mod format;
pub mod functions;
pub mod ga;
pub mod graph;
pub mod identify;
pub mod lessons;
pub mod lower;
pub mod mat;
pub mod page;
pub mod plot;
pub mod results;
pub mod runtime;
pub mod script;
pub mod sim;
mod singular_values;
pub mod symbolic;
pub mod syntax;
pub mod teach;
pub mod units;
pub mod value;

#[cfg(feature = "cli")]
pub mod cli;
#[cfg(feature = "lsp")]
pub mod lsp;
