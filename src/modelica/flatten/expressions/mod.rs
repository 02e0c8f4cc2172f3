//! Expressions with their names resolved (MLS §5.6.2): references to components become flat paths,
//! constants of packages their values, calls of functions their full names.

pub(crate) mod array_iterations;
pub(crate) mod calls;
pub(crate) mod constants;
pub(crate) mod enumerations;
pub(crate) mod local;
pub(crate) mod loops;
pub(crate) mod overloaded_arrays;
pub(crate) mod overloading;
pub(crate) mod paths;
pub(crate) mod resolve;
pub(crate) mod state_machines;
pub(crate) mod values;
pub(crate) mod vectorization;
