//! Numbers that instructions compute with, with derivatives and without, and the functions of the
//! table for any of them.

mod elementary;
mod number;

pub use elementary::Elementary;
pub(crate) use elementary::by_number;
pub(crate) use number::Stacks;
pub use number::{Dual, Number};
