//! Instantiation and flattening: a class of the library becomes a flat model (MLS §5.6).

mod flat_model;

pub use flat_model::*;
