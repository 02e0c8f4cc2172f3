//! A program as bytes, for files that the same version of this program reads again.

use super::program::Program;
use std::sync::Arc;

impl Program {
    /// The bytes; `None` where it has what no file can hold: functions in C.
    pub fn to_bytes(&self) -> Option<Vec<u8>> {
        postcard::to_allocvec(self).ok()
    }

    /// The program that became these bytes by [`Program::to_bytes`] of this version. Places are
    /// those of [`with_sources`](crate::source::with_sources).
    pub fn from_bytes(bytes: &[u8]) -> Option<Arc<Program>> {
        let mut program: Program = postcard::from_bytes(bytes).ok()?;
        program.registers.use_functions(&program.sorted.dae.functions);
        Some(Arc::new(program))
    }
}
