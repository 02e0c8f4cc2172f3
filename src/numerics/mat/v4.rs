//! MAT version 4: one record after another, each a header of five 32-bit integers, a name that
//! ends with a zero byte, and the values.
//!
//! The first integer is 1000 M + 100 O + 10 P + T: M number format (0 little-endian, 1 big-endian;
//! 2 to 4 VAX and Cray, refused), O storage (0 by columns, 1 by rows), P type of the numbers
//! (0 double, 1 single, 2 int32, 3 int16, 4 uint16, 5 uint8), T kind (0 full, 1 text, 2 sparse,
//! skipped).

use super::errors::{BAD_MAT_FILE, UNSUPPORTED_MAT_FILE};
use super::matrix::{self, MatFile, Matrix, MatrixKind, Version};
use super::number::{ByteOrder, Storage};
use super::reader::Reader;
use crate::diag::Fault;
use crate::{bail, fault};

/// The number P of a storage.
pub(crate) const STORAGES: [Storage; 6] =
    [Storage::F64, Storage::F32, Storage::I32, Storage::I16, Storage::U16, Storage::U8];

struct Header {
    order: ByteOrder,
    by_rows: bool,
    storage: Storage,
    kind: u32,
    rows: usize,
    columns: usize,
    is_complex: bool,
    name_length: usize,
}

pub(crate) fn read(bytes: &[u8]) -> Result<MatFile, Fault> {
    if bytes.is_empty() {
        bail!(BAD_MAT_FILE, "the file is empty");
    }
    let mut file = MatFile::new(Version::V4);
    let mut reader = Reader::new(bytes, ByteOrder::Little);
    while !reader.is_empty() {
        read_record(&mut reader, &mut file)?;
    }
    Ok(file)
}

fn read_record(reader: &mut Reader, file: &mut MatFile) -> Result<(), Fault> {
    let header = read_header(reader)?;
    let name = read_name(reader, header.name_length)?;
    let parts = if header.is_complex { 2 } else { 1 };
    let size = matrix::size(&name, header.rows, header.columns)?;
    let Some(bytes) = size.checked_mul(parts * header.storage.size()) else {
        bail!(BAD_MAT_FILE, "matrix `{name}` claims {size} values");
    };
    let data = reader.take(bytes, &format!("matrix `{name}`"))?;
    match header.kind {
        2 => file.skip(name, "it is a sparse matrix; convert it with `full` before saving"),
        _ if header.is_complex => file.skip(name, "it is complex; save only its real part"),
        _ => {
            let values = header.storage.decode(&data[..size * header.storage.size()], header.order);
            file.insert(name, header.matrix(values));
        }
    }
    Ok(())
}

impl Header {
    fn matrix(&self, values: Vec<f64>) -> Matrix {
        let kind = if self.kind == 1 { MatrixKind::Char } else { MatrixKind::Numeric };
        if self.by_rows {
            let (rows, columns) = (self.columns, self.rows);
            return Matrix { rows, columns, values, kind }.transposed();
        }
        Matrix { rows: self.rows, columns: self.columns, values, kind }
    }
}

fn read_header(reader: &mut Reader) -> Result<Header, Fault> {
    let start = reader.take(4, "a matrix header")?;
    let start = [start[0], start[1], start[2], start[3]];
    let (order, code) = match ByteOrder::Little.u32(start) {
        code if code < 5000 => (ByteOrder::Little, code),
        _ => (ByteOrder::Big, ByteOrder::Big.u32(start)),
    };
    if code >= 5000 {
        return Err(fault!(BAD_MAT_FILE, "the file is not a MAT file")
            .help("use a file saved with `save -v4`, `-v6` or `-v7`, or a CSV file"));
    }
    check_number_format(code / 1000, order)?;
    let (by_rows, storage, kind) = (code / 100 % 10, (code / 10 % 10) as usize, code % 10);
    let Some(storage) = STORAGES.get(storage).copied().filter(|_| by_rows < 2 && kind < 3) else {
        bail!(BAD_MAT_FILE, "a matrix header has the unknown type code {code}");
    };
    reader.order = order;
    let (rows, columns) = (reader.u32("a matrix header")?, reader.u32("a matrix header")?);
    let is_complex = match reader.u32("a matrix header")? {
        0 => false,
        1 => true,
        flag => bail!(BAD_MAT_FILE, "a matrix header has the complex flag {flag}"),
    };
    let name_length = reader.u32("a matrix header")? as usize;
    if rows.max(columns) > i32::MAX as u32 {
        bail!(BAD_MAT_FILE, "a matrix claims a negative size");
    }
    Ok(Header {
        order,
        by_rows: by_rows == 1,
        storage,
        kind,
        rows: rows as usize,
        columns: columns as usize,
        is_complex,
        name_length,
    })
}

fn check_number_format(format: u32, order: ByteOrder) -> Result<(), Fault> {
    match (format, order) {
        (0, ByteOrder::Little) | (1, ByteOrder::Big) => Ok(()),
        (0 | 1, _) => bail!(BAD_MAT_FILE, "a matrix header contradicts its own byte order"),
        _ => bail!(UNSUPPORTED_MAT_FILE, "the numbers are in VAX or Cray format"),
    }
}

fn read_name(reader: &mut Reader, length: usize) -> Result<String, Fault> {
    let bytes = reader.take(length, "a matrix name")?;
    let end = bytes.iter().position(|byte| *byte == 0).unwrap_or(length);
    if end == 0 {
        bail!(BAD_MAT_FILE, "a matrix has no name");
    }
    Ok(String::from_utf8_lossy(&bytes[..end]).into_owned())
}
