//! Expressions with their names resolved (MLS §5.6.2): references to components become flat paths,
//! constants of packages their values, calls of functions their full names.

pub(crate) mod array_iterations;
pub mod calls;
pub mod constants;
pub mod enumerations;
pub mod local;
pub(crate) mod loops;
pub(crate) mod overloaded_arrays;
pub(crate) mod overloading;
pub mod paths;
pub mod resolve;
pub mod state_machines;
pub mod values;
pub(crate) mod vectorization;
