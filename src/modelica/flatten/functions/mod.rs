//! Functions of the flat model (MLS ch. 12): with their inherited elements and resolved names, with
//! the default values of their inputs, and copied for the functions that they are passed.

pub(crate) mod declared;
pub(crate) mod defaults;
mod outer_names;
mod partial_derivative;
pub(crate) mod printing;
pub(crate) mod specialization;
pub(crate) mod table;
mod unrolled;
