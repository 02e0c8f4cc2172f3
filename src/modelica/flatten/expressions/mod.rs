//! Expressions with their names resolved (MLS §5.6.2): references to components become flat paths,
//! constants of packages their values, calls of functions their full names.

pub mod calls;
pub mod comprehensions;
pub mod constants;
pub mod enumerations;
pub mod implicit_ranges;
pub mod local;
pub mod overloaded_arrays;
pub mod overloading;
pub mod paths;
pub mod resolve;
pub mod state_machines;
pub mod values;
pub mod vectorization;
