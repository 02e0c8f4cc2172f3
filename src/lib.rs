//! Runs GAPILib scripts: identifies the parameters of Modelica models from measured data with a
//! genetic algorithm.

pub mod bibliography;
pub mod diag;
pub mod name;
pub mod registry;
pub mod source;

pub mod compile;
pub mod dae;
pub mod eval;
pub mod flatten;
pub mod ga;
pub mod graph;
pub mod identify;
pub mod mat;
pub mod plot;
pub mod results;
pub mod script;
pub mod sim;
pub mod symbolic;
pub mod syntax;
pub mod value;

pub mod cli;
