//! Identifies the parameters of Modelica models from measured data with a genetic algorithm, by
//! running the scripts of GAPILib ([Rubio et al. 2006](internals::bibliography#rubio-2006)) unchanged.
//!
//! ```
//! use gapilib::world::MemoryWorld;
//! use gapilib::Session;
//! use gapilib::Value;
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
//! # What stands here
//!
//! - [`Session`] runs scripts and expressions; [`Options`] and [`Permissions`] say how, and what they
//!   may do; [`RunStatus`] says how a run ended, a [`Transcript`] what was answered;
//! - [`world`] is what a session has around it: files, time, threads, a screen.
//!   [`MemoryWorld`](world::MemoryWorld) holds all of it in memory;
#![cfg_attr(feature = "cli", doc = "- [`embedding`]: sessions on the real disk, under its rules;")]
//! - [`Value`]: what variables of scripts hold;
//! - [`Diagnostic`], [`Fault`]: what went wrong, where, and what to do;
//! - [`results`]: results of simulations and measured data as tables, and their files.
//!
//! Everything else is done by scripts, as a user would: `simulateModel`, `identify`, `Eval`.

pub use gapilib_base::diag::{Diagnostic, Fault, Severity};
#[cfg(feature = "cli")]
pub use gapilib_cli::embedding;
pub use gapilib_modelica::value::Value;
pub use gapilib_numerics::results;
pub use gapilib_script::{
    Dialect, Echo, Exchange, Journaling, Options, Permissions, Reporting, RunStatus, Session,
    Strictness, Transcript, with_stack, world,
};

#[doc(hidden)]
pub mod internals {
    //! What tests, benches and the bindings of this project use besides, under the names that the
    //! parts have among themselves. It may change with every version.
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
    //! # The crates
    //!
    //! A module owns one stage and one noun, imports only modules before it (`tests/suite/architecture` has
    //! the table), and never changes what the stage before it made. The modules lie in nine crates, each of
    //! which knows only those before it; this one is what programs embed, and the program `gapi`.
    //!
    //! `src/base`, what all parts share:
    //! - [`elementary`]: elementary functions with the same bits on every machine;
    //! - [`source`], [`name`], [`diag`], [`registry`], [`budget`]: places, names, diagnostics, named
    //!   choices, limits;
    //! - [`graph`], [`units`]: matching, sorting, tearing; units of measurement and their conversion;
    //! - [`plot`], [`page`], [`bibliography`]: figures, HTML pages, the works that are cited.
    //!
    //! `src/numerics`, without Modelica:
    //! - [`sim`]: integrators, events, trajectories;
    //! - [`ga`]: the genetic algorithm and other optimizers;
    //! - [`mat`], [`results`]: files of tables and of results.
    //!
    //! `src/modelica`, the compiler:
    //! - [`syntax`]: the grammar of classes and scripts, trees, printing;
    //! - [`mod@format`]: the layout of classes and scripts: indentation, blanks, line breaks;
    //! - [`value`], [`symbolic`]: values and their operations; scalar expressions;
    //! - [`functions`], [`eval`]: the functions and operators of the language; the interpreter;
    //! - [`external`]: functions that libraries declare `external`, in Rust;
    //! - [`arithmetic`]: what instructions compute, with derivatives and without;
    //! - [`bytecode`]: functions that loop and branch, as instructions;
    //! - [`flatten`], [`lower`]: from a class to a flat model, to a system of differential-algebraic
    //!   equations;
    //! - [`causalize`]: structural analysis: index reduction, block lower triangular form, tearing;
    //! - [`codegen`], [`runtime`]: a program of instruction tapes, and the systems that execute it.
    //!
    //! `src/fmi`:
    //! - [`fmi`]: functional mock-up units: descriptions, archives, the export of programs, and simulations of
    //!   those of others; `src/fmu` is the shared library in exported ones.
    //!
    //! `src/identify`:
    //! - [`identify`]: populations of simulations, and what they say of the parameters.
    //!
    //! `src/script`:
    //! - [`script`]: sessions and their commands;
    //! - [`packages`]: the Modelica packages that are part of the program;
    //! - [`teach`], [`lessons`]: recorded runs of the genetic algorithm; exercises with checks.
    //!
    //! `src/exchange`, which the command line uses: models and problems of other programs, SBML and PEtab.
    //!
    //! `src/cli`, with the feature `cli`:
    //! - `cli`: the command line, the only door outside;
    //! - `lsp`: what editors ask about open documents.

    pub use gapilib_base::{
        bibliography, budget, diag, elementary, graph, name, page, plot, registry, source, units,
    };
    pub use gapilib_fmi as fmi;
    pub use gapilib_identify as identify;
    pub use gapilib_modelica::{
        arithmetic, bytecode, causalize, codegen, eval, external, flatten, format, functions,
        lower, runtime, symbolic, syntax, value,
    };
    pub use gapilib_numerics::{frequency, ga, mat, results, sim};
    pub use gapilib_script as script;
    pub use gapilib_script::{lessons, packages, teach};

    #[cfg(feature = "cli")]
    pub use gapilib_cli as cli;
    #[cfg(feature = "lsp")]
    pub use gapilib_cli::lsp;
}
