//! MAT version 7.3, which is HDF5 after a header of 512 bytes, and plain HDF5 files.
//!
//! Datasets of numbers become matrices, groups become structures with dotted names. HDF5 counts
//! dimensions in the opposite order, so that MATLAB's columns lie one after the other as they do here.
//! The size that a dataset claims is compared with a limit before memory is taken.
//!
//! References: *HDF5 File Format Specification Version 3.0*, The HDF Group; for the attributes
//! `MATLAB_class`, `MATLAB_empty`, `MATLAB_sparse` the files that MATLAB R2024a writes.

use super::errors::{BAD_MAT_FILE, UNSUPPORTED_MAT_FILE};
use super::matrix::{self, MatFile, Matrix, MatrixKind, Version};
use super::v5::MAX_INFLATED;
use crate::diag::Fault;
use crate::{bail, fault};
use hdf5_pure::{AttrValue, DType, Dataset, File, Group};
use std::collections::HashMap;

const MAX_DEPTH: usize = 32;
/// Datasets and groups of one file.
const MAX_OBJECTS: usize = 100_000;

pub(crate) fn read(bytes: &[u8]) -> Result<MatFile, Fault> {
    let file = File::from_bytes(bytes.to_vec()).map_err(|error| damaged("the file", &error))?;
    let mut reader = Reader {
        found: MatFile::new(Version::V73),
        is_matlab: bytes.starts_with(b"MATLAB 7.3"),
        bytes: MAX_INFLATED,
        objects: MAX_OBJECTS,
    };
    reader.group(&file.root(), "", 0)?;
    Ok(reader.found)
}

fn damaged(what: &str, error: &dyn std::fmt::Display) -> Fault {
    fault!(BAD_MAT_FILE, "{what} cannot be read as HDF5: {error}")
        .help("save it with `save -v7 file.mat`")
}

type Attributes = HashMap<String, AttrValue>;

struct Reader {
    found: MatFile,
    is_matlab: bool,
    /// Bytes that may still be read.
    bytes: u64,
    /// Objects that may still be visited.
    objects: usize,
}

impl Reader {
    fn count(&mut self) -> Result<(), Fault> {
        self.objects = self.objects.checked_sub(1).ok_or_else(|| {
            fault!(BAD_MAT_FILE, "the file contains more than {MAX_OBJECTS} variables")
        })?;
        Ok(())
    }

    fn group(&mut self, group: &Group, path: &str, depth: usize) -> Result<(), Fault> {
        if depth > MAX_DEPTH {
            bail!(BAD_MAT_FILE, "structures are nested deeper than {MAX_DEPTH} levels");
        }
        let mut datasets = group.datasets().map_err(|error| damaged("a group", &error))?;
        datasets.sort_unstable();
        for name in datasets {
            self.count()?;
            let full = dotted(path, &name);
            match group.dataset(&name) {
                Ok(dataset) => self.dataset(&dataset, full)?,
                Err(error) => self.found.skip(full, &error.to_string()),
            }
        }
        let mut groups = group.groups().map_err(|error| damaged("a group", &error))?;
        groups.sort_unstable();
        // MATLAB keeps the elements of cells and objects in groups whose names begin with `#`.
        for name in groups.into_iter().filter(|name| !name.starts_with('#')) {
            self.count()?;
            let full = dotted(path, &name);
            let inner = match group.group(&name) {
                Ok(inner) => inner,
                Err(error) => {
                    self.found.skip(full, &error.to_string());
                    continue;
                }
            };
            let attributes = inner.attrs().unwrap_or_default();
            if attributes.contains_key("OCTAVE_NEW_FORMAT") {
                return Err(fault!(UNSUPPORTED_MAT_FILE, "the file is in Octave's HDF5 format")
                    .help("save it with `save -v7 file.mat`"));
            }
            if attributes.contains_key("MATLAB_sparse") {
                self.found
                    .skip(full, "it is a sparse matrix; convert it with `full` before saving");
                continue;
            }
            self.group(&inner, &full, depth + 1)?;
        }
        Ok(())
    }

    fn dataset(&mut self, dataset: &Dataset, name: String) -> Result<(), Fault> {
        let attributes = dataset.attrs().unwrap_or_default();
        let class = word(&attributes, "MATLAB_class").unwrap_or_default();
        let (shape, kind, width) = match (dataset.shape(), dataset.dtype(), dataset.element_size())
        {
            (Ok(shape), Ok(kind), Ok(width)) => (shape, kind, width),
            (Err(error), ..) | (_, Err(error), _) | (.., Err(error)) => {
                self.found.skip(name, &error.to_string());
                return Ok(());
            }
        };
        if attributes.contains_key("MATLAB_empty") {
            self.found.insert(name, Matrix::from_columns(0, 0, Vec::new()));
            return Ok(());
        }
        if let Some(reason) = unreadable(class.as_str(), &kind, &shape) {
            self.found.skip(name, reason);
            return Ok(());
        }
        let Some((rows, columns)) = self.sizes(&name, &shape)? else {
            return Ok(());
        };
        self.take_room(&name, (rows, columns), width)?;
        let size = matrix::size(&name, rows, columns)?;
        let values = match dataset.read_f64() {
            Ok(values) if values.len() == size => values,
            Ok(values) => {
                let found = values.len();
                self.found.skip(name, &format!("it has {found} values instead of {size}"));
                return Ok(());
            }
            Err(error) => {
                self.found.skip(name, &error.to_string());
                return Ok(());
            }
        };
        if matches!(kind, DType::I64 | DType::U64)
            && values.iter().any(|v| v.abs() >= (1_u64 << 53) as f64)
        {
            self.found.warnings.push(format!("integers of `{name}` beyond 2^53 are rounded"));
        }
        let kind = match class.as_str() {
            "char" => MatrixKind::Char,
            "logical" => MatrixKind::Logical,
            _ => MatrixKind::Numeric,
        };
        let matrix = Matrix { rows, columns, values, kind };
        // Other programs than MATLAB write rows one after the other.
        let by_rows = !self.is_matlab && class.is_empty() && shape.len() == 2;
        let matrix = if by_rows { matrix.transposed() } else { matrix };
        self.found.insert(name, matrix);
        Ok(())
    }

    /// Counts a matrix of elements of so many bytes against what a file may contain.
    fn take_room(
        &mut self,
        name: &str,
        (rows, columns): (usize, usize),
        width: u64,
    ) -> Result<(), Fault> {
        let size = matrix::size(name, rows, columns)?;
        let needed = (size as u64).saturating_mul(width.max(8));
        if needed > self.bytes {
            bail!(
                BAD_MAT_FILE,
                "`{name}` is {rows} by {columns}: the file contains more than {} \
                 MiB", MAX_INFLATED >> 20;
                help: "save only the matrices that are needed"
            );
        }
        self.bytes -= needed;
        Ok(())
    }

    /// Rows and columns in MATLAB's order.
    fn sizes(&mut self, name: &str, shape: &[u64]) -> Result<Option<(usize, usize)>, Fault> {
        let size = |n: u64| {
            usize::try_from(n)
                .map_err(|_| fault!(BAD_MAT_FILE, "`{name}` claims {n} rows or columns"))
        };
        Ok(match shape {
            [] => Some((1, 1)),
            [rows] => Some((size(*rows)?, 1)),
            [columns, rows] => Some((size(*rows)?, size(*columns)?)),
            _ => {
                let reason = "it has more than two dimensions; save a two-dimensional slice";
                self.found.skip(name.to_owned(), reason);
                None
            }
        })
    }
}

fn dotted(path: &str, name: &str) -> String {
    if path.is_empty() { name.to_owned() } else { format!("{path}.{name}") }
}

fn word(attributes: &Attributes, name: &str) -> Option<String> {
    match attributes.get(name)? {
        AttrValue::AsciiString(text) | AttrValue::String(text) => {
            Some(text.trim_end_matches(['\0', ' ']).to_owned())
        }
        _ => None,
    }
}

/// Why a dataset cannot be read as a real matrix, if so.
fn unreadable(class: &str, kind: &DType, shape: &[u64]) -> Option<&'static str> {
    Some(match (class, kind) {
        ("cell", _) => "it is a cell array; save its elements as matrices",
        ("struct", _) => "it is an array of structures; save a single structure",
        ("function_handle", _) => "it is a function handle",
        (_, DType::Compound(fields)) if fields.iter().any(|(name, _)| name == "imag") => {
            "it is complex; save only its real part"
        }
        (
            _,
            DType::F64
            | DType::F32
            | DType::I8
            | DType::I16
            | DType::I32
            | DType::I64
            | DType::U8
            | DType::U16
            | DType::U32
            | DType::U64,
        ) if shape.len() <= 2 => return None,
        (_, DType::F64 | DType::F32) => {
            "it has more than two dimensions; save a two-dimensional slice"
        }
        _ => "it is not a matrix of numbers",
    })
}
