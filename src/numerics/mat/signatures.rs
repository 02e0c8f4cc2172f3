//! How the bytes of binary files begin.

const HDF5: &[u8] = b"\x89HDF\r\n\x1a\n";

/// Whether the bytes are HDF5, by themselves or after the header of a MAT file of version 7.3.
pub(crate) fn is_hdf5(bytes: &[u8]) -> bool {
    let signed = |at: usize| bytes.get(at..).is_some_and(|rest| rest.starts_with(HDF5));
    signed(0) || signed(512) || bytes.starts_with(b"MATLAB 7.3 MAT-file")
}

/// Whether the bytes are those of a zip archive, as XLSX files are.
pub(crate) fn is_zip(bytes: &[u8]) -> bool {
    bytes.starts_with(b"PK\x03\x04")
}
