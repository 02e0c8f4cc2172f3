//! A program as bytes, for files that the same version of this program reads again.

use super::program::Program;
use crate::budget::has_memory;
use crate::symbolic::reading_variables;
use memchr::memmem;
use postcard::ser_flavors::Size;
use serde::Serialize;
use std::sync::Arc;

/// Larger models are translated every time: a network of 56 by 56 lines has 74 MB, and one of 112 by 112
/// would take a gigabyte, twice, beside what its simulation needs.
const MOST_BYTES: usize = 256 << 20;

/// What programs as bytes begin with: the sources that say what the bytes mean.
const FORMAT: &str = concat!("gapilib program ", env!("GAPILIB_SOURCES"));

/// Whether a library that simulates programs reads those of this one: it has the same format in it.
pub fn is_reader(library: &[u8]) -> bool {
    memmem::find(library, FORMAT.as_bytes()).is_some()
}

impl Program {
    /// The bytes; `None` where it has what no file can hold, functions in C, or is too large.
    pub fn to_bytes(&self) -> Option<Vec<u8>> {
        bytes_of(&(FORMAT, self.n_variables(), self))
    }

    fn n_variables(&self) -> u32 {
        self.sorted.dae.variables.len() as u32
    }

    /// The program that became these bytes by [`Program::to_bytes`] of this version. Places are
    /// those of [`with_sources`](crate::source::with_sources). `None` where something in them refers to
    /// what is not there, and of another version.
    pub fn from_bytes(bytes: &[u8]) -> Option<Arc<Program>> {
        let (format, bytes): (&str, &[u8]) = postcard::take_from_bytes(bytes).ok()?;
        // As it stands in a library: that is how others find it there.
        if format != std::hint::black_box(FORMAT) {
            return None;
        }
        let (n_variables, bytes): (u32, &[u8]) = postcard::take_from_bytes(bytes).ok()?;
        let read = || postcard::from_bytes(bytes).ok();
        let mut program: Program = reading_variables(n_variables, read)?;
        if program.n_variables() != n_variables || !program.is_valid() {
            return None;
        }
        program.registers.use_functions(&program.sorted.dae.functions);
        Some(Arc::new(program))
    }
}

/// A value as bytes, allocated once; `None` where it cannot be written, or is too large.
pub fn bytes_of<T: Serialize + ?Sized>(value: &T) -> Option<Vec<u8>> {
    bytes_up_to(value, MOST_BYTES)
}

fn bytes_up_to<T: Serialize + ?Sized>(value: &T, most: usize) -> Option<Vec<u8>> {
    let size: usize = postcard::serialize_with_flavor(value, Size::default()).ok()?;
    let mut bytes = Vec::new();
    if size > most || !has_memory(size) || bytes.try_reserve_exact(size).is_err() {
        return None;
    }
    postcard::to_extend(value, bytes).ok()
}

#[cfg(test)]
mod tests {
    use super::bytes_up_to;

    #[test]
    fn what_is_too_large_is_not_written() {
        let values = vec![1u8; 1000];
        let bytes = bytes_up_to(&values, 1002).expect("it is small enough");
        assert_eq!((bytes.len(), bytes.capacity()), (1002, 1002));
        assert_eq!(bytes_up_to(&values, 1001), None);
    }
}
