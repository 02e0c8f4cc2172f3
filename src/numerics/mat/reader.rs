//! A cursor over bytes that never reads past the end.

use super::errors::BAD_MAT_FILE;
use super::number::ByteOrder;
use crate::diag::Fault;
use crate::fault;

/// The bytes that remain of a file or of a part of it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Reader<'a> {
    rest: &'a [u8],
    pub(super) order: ByteOrder,
}

impl<'a> Reader<'a> {
    pub(crate) fn new(bytes: &'a [u8], order: ByteOrder) -> Reader<'a> {
        Reader { rest: bytes, order }
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.rest.is_empty()
    }

    /// The next `count` bytes; `what` names them in the message.
    pub(crate) fn take(&mut self, count: usize, what: &str) -> Result<&'a [u8], Fault> {
        let Some((taken, rest)) = self.rest.split_at_checked(count) else {
            let rest = self.rest.len();
            return Err(fault!(
                BAD_MAT_FILE,
                "the file ends too early: {what} needs {count} bytes, {rest} remain"
            ));
        };
        self.rest = rest;
        Ok(taken)
    }

    /// Passes over up to `count` bytes, as padding at the end of a file may be missing.
    pub(crate) fn pad(&mut self, count: usize) {
        self.rest = &self.rest[count.min(self.rest.len())..];
    }

    pub(crate) fn u32(&mut self, what: &str) -> Result<u32, Fault> {
        let bytes = self.take(4, what)?;
        Ok(self.order.u32([bytes[0], bytes[1], bytes[2], bytes[3]]))
    }
}
