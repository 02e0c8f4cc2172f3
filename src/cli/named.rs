//! Reading files that the command line names, pipes and devices too.

use super::{device, disk};
use std::fs;
use std::io;
use std::path::Path;

/// The bytes of a file, a pipe or a device.
///
/// # Errors
/// It cannot be read; nothing comes from it; it does not end.
pub(super) fn read(path: &Path) -> io::Result<Vec<u8>> {
    let is_device = fs::metadata(path).is_ok_and(|found| !found.is_file() && !found.is_dir());
    if is_device { device::read(path) } else { disk::read_named(path) }
}

/// The text of a file, a pipe or a device.
///
/// # Errors
/// As [`read`]; what is not UTF-8.
pub(super) fn read_text(path: &Path) -> io::Result<String> {
    let text = String::from_utf8(read(path)?);
    text.map_err(|_| io::Error::new(io::ErrorKind::InvalidData, "it is not UTF-8"))
}
