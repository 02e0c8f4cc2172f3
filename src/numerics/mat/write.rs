//! Writing versions 4 and 5, little-endian, without compression and without a date; text in the `#1`
//! format, and columns with separators.

use super::errors::UNWRITABLE_MATRIX;
use super::matrix::{Matrix, MatrixKind};
use super::number::Storage;
use super::v4::STORAGES;
use super::{TABLES, ending};
use crate::bail;
use crate::diag::Fault;
use indexmap::IndexMap;

/// Matrices in the format that the ending of the file's name stands for, in which [`read_named`]
/// reads them back: columns with separators (`.csv`, `.tsv`), the `#1` format for other endings of
/// text, else version 4.
///
/// # Errors
/// Several matrices in columns; those of [`write_v4`].
///
/// [`read_named`]: super::read_named
pub fn write_named(file_name: &str, arrays: &IndexMap<String, Matrix>) -> Result<Vec<u8>, Fault> {
    match ending(file_name).as_str() {
        "csv" => columns(file_name, arrays, ","),
        "tsv" => columns(file_name, arrays, "\t"),
        text if TABLES.contains(&text) => Ok(table_text(arrays)),
        _ => write_v4(arrays.iter().map(|(name, matrix)| (name.as_str(), matrix))),
    }
}

/// One matrix below a header that names its columns: `name[1]`, `name[2]`, …
fn columns(
    file_name: &str,
    arrays: &IndexMap<String, Matrix>,
    separator: &str,
) -> Result<Vec<u8>, Fault> {
    if arrays.len() > 1 {
        let last = arrays.keys().last().map_or("", String::as_str);
        bail!(
            UNWRITABLE_MATRIX,
            "`{file_name}` would contain several matrices, which a table cannot";
            help: "write `{last}` to another file, or use a `.mat` file for all"
        );
    }
    let mut text = String::new();
    for (name, matrix) in arrays {
        let heads: Vec<String> = (1..=matrix.columns).map(|j| format!("{name}[{j}]")).collect();
        let rows = (0..matrix.rows).map(|i| row(matrix, i, separator));
        for line in std::iter::once(heads.join(separator)).chain(rows) {
            text.push_str(&line);
            text.push('\n');
        }
    }
    Ok(text.into_bytes())
}

fn table_text(arrays: &IndexMap<String, Matrix>) -> Vec<u8> {
    let mut text = "#1\n".to_owned();
    for (name, matrix) in arrays {
        let is_text = matrix.kind == MatrixKind::Char;
        let kind = if is_text { "char" } else { "double" };
        text.push_str(&format!("{kind} {name}({},{})\n", matrix.rows, matrix.columns));
        let rows: Vec<String> = match is_text {
            true => matrix.row_strings(),
            false => (0..matrix.rows).map(|i| row(matrix, i, " ")).collect(),
        };
        rows.iter().for_each(|row| text.push_str(&format!("{row}\n")));
    }
    text.into_bytes()
}

/// The numbers of a row, each the shortest text that reads back as the same.
fn row(matrix: &Matrix, i: usize, separator: &str) -> String {
    let numbers = (0..matrix.columns).map(|j| format!("{:?}", matrix.values[i + j * matrix.rows]));
    numbers.collect::<Vec<_>>().join(separator)
}

/// A version 4 file: numbers (and logical values, which version 4 does not know) as doubles, text
/// as bytes.
pub fn write_v4<'a>(
    arrays: impl IntoIterator<Item = (&'a str, &'a Matrix)>,
) -> Result<Vec<u8>, Fault> {
    let mut out = Vec::new();
    for (name, matrix) in arrays {
        let storage = if matrix.kind == MatrixKind::Char { Storage::U8 } else { Storage::F64 };
        append_v4(&mut out, name, matrix, storage)?;
    }
    Ok(out)
}

/// Appends a matrix to a version 4 file, its numbers in the given storage. Version 4 has no 8-bit
/// signed, 32-bit unsigned and 64-bit integers. A value that the storage cannot hold is a fault,
/// except that [`Storage::F32`] rounds.
pub fn append_v4(
    out: &mut Vec<u8>,
    name: &str,
    matrix: &Matrix,
    storage: Storage,
) -> Result<(), Fault> {
    check_name(name)?;
    let Some(code) = STORAGES.iter().position(|known| *known == storage) else {
        bail!(UNWRITABLE_MATRIX, "version 4 cannot store `{name}` as {storage:?}");
    };
    check_values(name, matrix, storage)?;
    let text = u32::from(matrix.kind == MatrixKind::Char);
    let header = [
        10 * code as u32 + text,
        size(name, matrix.rows)?,
        size(name, matrix.columns)?,
        0,
        name.len() as u32 + 1,
    ];
    header.iter().for_each(|number| out.extend(number.to_le_bytes()));
    out.extend(name.as_bytes());
    out.push(0);
    matrix.values.iter().for_each(|value| storage.encode(*value, out));
    Ok(())
}

/// A version 5 file.
pub fn write_v5<'a>(
    arrays: impl IntoIterator<Item = (&'a str, &'a Matrix)>,
) -> Result<Vec<u8>, Fault> {
    let mut out = Vec::from(*b"MATLAB 5.0 MAT-file, written by gapilib");
    out.resize(116, b' ');
    out.extend([0; 8]);
    out.extend(0x0100_u16.to_le_bytes());
    out.extend(b"IM");
    for (name, matrix) in arrays {
        check_name(name)?;
        let body = matrix_v5(name, matrix)?;
        append_element(&mut out, name, 14, &body)?;
    }
    Ok(out)
}

fn matrix_v5(name: &str, matrix: &Matrix) -> Result<Vec<u8>, Fault> {
    let (class, data_type, storage) = match matrix.kind {
        MatrixKind::Numeric => (6, 9, Storage::F64),
        MatrixKind::Char => (4, 4, Storage::U16),
        MatrixKind::Logical => (9 | 0x0200, 2, Storage::U8),
    };
    check_values(name, matrix, storage)?;
    let mut flags = Vec::from(u32::to_le_bytes(class));
    flags.extend([0; 4]);
    let mut sizes = Vec::from(size(name, matrix.rows)?.to_le_bytes());
    sizes.extend(size(name, matrix.columns)?.to_le_bytes());
    let mut values = Vec::with_capacity(matrix.values.len() * storage.size());
    matrix.values.iter().for_each(|value| storage.encode(*value, &mut values));
    let mut body = Vec::with_capacity(values.len() + 64);
    append_element(&mut body, name, 6, &flags)?;
    append_element(&mut body, name, 5, &sizes)?;
    append_element(&mut body, name, 1, name.as_bytes())?;
    append_element(&mut body, name, data_type, &values)?;
    Ok(body)
}

fn append_element(out: &mut Vec<u8>, name: &str, kind: u32, data: &[u8]) -> Result<(), Fault> {
    out.extend(kind.to_le_bytes());
    out.extend(size(name, data.len())?.to_le_bytes());
    out.extend(data);
    out.resize(out.len().next_multiple_of(8), 0);
    Ok(())
}

fn size(name: &str, count: usize) -> Result<u32, Fault> {
    match i32::try_from(count) {
        Ok(count) => Ok(count as u32),
        Err(_) => bail!(UNWRITABLE_MATRIX, "`{name}` is too large for a MAT file"),
    }
}

fn check_name(name: &str) -> Result<(), Fault> {
    let letters = name.bytes().all(|byte| byte.is_ascii_alphanumeric() || byte == b'_');
    if letters && name.len() <= 63 && name.starts_with(|c: char| c.is_ascii_alphabetic()) {
        return Ok(());
    }
    bail!(
        UNWRITABLE_MATRIX,
        "`{name}` is not a valid matrix name in a MAT file";
        help: "use a letter followed by at most 62 letters, digits and underscores"
    )
}

fn check_values(name: &str, matrix: &Matrix, storage: Storage) -> Result<(), Fault> {
    let (low, high) = match storage {
        Storage::F64 | Storage::F32 => return Ok(()),
        Storage::I32 => (f64::from(i32::MIN), f64::from(i32::MAX)),
        Storage::I16 => (f64::from(i16::MIN), f64::from(i16::MAX)),
        Storage::U16 => (0.0, f64::from(u16::MAX)),
        _ => (0.0, f64::from(u8::MAX)),
    };
    let fits = |value: &f64| value.fract() == 0.0 && (low..=high).contains(value);
    match matrix.values.iter().find(|value| !fits(value)) {
        Some(value) => bail!(UNWRITABLE_MATRIX, "`{name}` cannot store the value {value}"),
        None => Ok(()),
    }
}
