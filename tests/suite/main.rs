//! The integration tests; one module per suite.
#![allow(
    clippy::disallowed_methods,
    reason = "expected values need not have the same last digit on every machine"
)]

mod algorithms;
mod architecture;
mod assertions;
mod bad_input;
mod chattering;
mod checks;
mod cli;
mod compat;
mod compliance;
mod conformance;
mod diagnostics;
mod digits;
mod displacement;
mod every_element;
mod external;
mod faults;
mod flat_class;
mod flattening;
mod flattening_properties;
mod fuel_cells;
mod functions;
mod fuzzing;
mod gapilib;
mod grammar;
mod guide;
mod hybrid;
mod hybrid_limits;
mod identification;
mod identification_sets;
mod identified_models;
mod identify;
mod index_reduction;
mod initialization;
mod laboratory;
mod lapack;
mod lapack_accuracy;
mod lazy_reading;
mod lessons;
mod libraries;
mod limits;
mod linear_algebra;
mod linear_loops;
mod mat;
mod model_files;
mod modelica;
mod modelica_models;
mod models;
mod moving_surfaces;
mod msl;
#[path = "../nist/mod.rs"]
mod nist;
mod nist_problems;
mod notices;
mod operators;
mod page;
mod permissions;
mod plot;
mod record_arrays;
mod reference_problems;
mod repl;
mod report_page;
mod results;
mod resume;
mod script_fuzzing;
mod script_tests;
mod scripts;
mod sensitivities;
mod session;
mod shipped;
mod shipped_functions;
mod simulation;
mod singular_derivatives;
mod structural_parameters;
mod structure;
mod syntax_properties;
mod teach;
#[cfg(unix)]
mod terminal;
mod transcripts;
mod undetermined;
mod watching;
mod words;
