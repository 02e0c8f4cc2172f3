//! Matrices in text: a first line `#1`, then for each matrix a line `double name(rows, columns)`
//! and its numbers row after row, separated by blanks, commas, semicolons or line ends; `#` starts
//! a comment. `float` and `int` are read like `double`; of `char` matrices each line is a row.

use super::errors::BAD_TABLE;
use super::matrix::{self, MatFile, Matrix, MatrixKind, Version};
use crate::diag::Fault;
use crate::{bail, fault};

/// Characters of a matrix, with the blanks that fill its rows: one long row beside many short ones
/// takes far more memory than the file.
const MAX_CHARACTERS: usize = 1 << 26;

/// Whether the first line is `#1`.
pub(crate) fn looks_like(bytes: &[u8]) -> bool {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    matches!(bytes, [b'#', b'1'] | [b'#', b'1', b' ' | b'\t' | b'\r' | b'\n', ..])
}

pub(crate) fn read(bytes: &[u8]) -> Result<MatFile, Fault> {
    let text = super::table::decode(bytes);
    let mut lines = text.lines().enumerate().map(|(i, line)| (i + 1, line));
    let mut file = MatFile::new(Version::Text);
    while let Some((number, line)) = lines.next() {
        let line = without_comment(line).trim();
        if line.is_empty() {
            continue;
        }
        let declaration = declaration(line).ok_or_else(|| {
            fault!(
                BAD_TABLE,
                "line {number}, column 1: `{}` does not declare a matrix",
                shorten(line)
            )
            .help("write `double name(rows, columns)`")
        })?;
        let matrix = match declaration.is_text {
            true => read_lines(&declaration, &mut lines)?,
            false => read_numbers(&declaration, number, &mut lines)?,
        };
        file.insert(declaration.name.to_owned(), matrix);
    }
    Ok(file)
}

struct Declaration<'a> {
    is_text: bool,
    name: &'a str,
    rows: usize,
    columns: usize,
}

fn declaration(line: &str) -> Option<Declaration<'_>> {
    let (kind, rest) = line.split_once(char::is_whitespace)?;
    let is_text = match kind {
        "double" | "float" | "int" => false,
        "char" => true,
        _ => return None,
    };
    let (name, sizes) = rest.trim().strip_suffix(')')?.split_once('(')?;
    let (rows, columns) = sizes.split_once(',')?;
    let (rows, columns) = (rows.trim().parse().ok()?, columns.trim().parse().ok()?);
    Some(Declaration { is_text, name: name.trim(), rows, columns })
}

fn without_comment(line: &str) -> &str {
    line.split_once('#').map_or(line, |(before, _)| before)
}

fn shorten(text: &str) -> String {
    text.chars().take(40).collect()
}

/// Reads `rows * columns` numbers; memory grows with what the file holds, not with what it claims.
fn read_numbers<'a>(
    declaration: &Declaration,
    declared_at: usize,
    lines: &mut impl Iterator<Item = (usize, &'a str)>,
) -> Result<Matrix, Fault> {
    let Declaration { name, rows, columns, .. } = *declaration;
    let size = matrix::size(name, rows, columns)?;
    let mut values = Vec::new();
    while values.len() < size {
        let Some((number, line)) = lines.next() else {
            let found = values.len();
            bail!(
                BAD_TABLE,
                "`{name}` has {found} numbers, but {size} are declared in line {declared_at}"
            );
        };
        for (column, word) in words(without_comment(line)) {
            let Ok(value) = word.parse() else {
                let word = shorten(word);
                bail!(BAD_TABLE, "line {number}, column {column}: `{word}` is not a number");
            };
            if values.len() == size {
                bail!(
                    BAD_TABLE,
                    "line {number}, column {column}: `{name}` has only {size} numbers"
                );
            }
            values.push(value);
        }
    }
    Ok(Matrix { rows: columns, columns: rows, values, kind: MatrixKind::Numeric }.transposed())
}

/// The words of a line with their columns, counted from 1 in characters.
fn words(line: &str) -> impl Iterator<Item = (usize, &str)> {
    let is_separator = |c: char| c.is_whitespace() || c == ',' || c == ';';
    line.split(is_separator).filter(|word| !word.is_empty()).map(move |word| {
        let start = word.as_ptr() as usize - line.as_ptr() as usize;
        (line[..start].chars().count() + 1, word)
    })
}

fn read_lines<'a>(
    declaration: &Declaration,
    lines: &mut impl Iterator<Item = (usize, &'a str)>,
) -> Result<Matrix, Fault> {
    let Declaration { name, rows, columns, .. } = *declaration;
    let mut lines_found: Vec<&str> = Vec::new();
    for _ in 0..rows {
        let Some((number, line)) = lines.next() else {
            let found = lines_found.len();
            bail!(BAD_TABLE, "`{name}` has {found} lines, but {rows} are declared");
        };
        let line = line.trim_end();
        if line.chars().count() > columns {
            bail!(
                BAD_TABLE,
                "line {number}, column {}: `{name}` has only {columns} characters in a row",
                columns + 1
            );
        }
        lines_found.push(line);
    }
    let longest = lines_found.iter().map(|text| text.len()).max().unwrap_or(0);
    if longest.saturating_mul(rows) > MAX_CHARACTERS {
        bail!(
            BAD_TABLE,
            "`{name}` has {rows} rows of up to {longest} characters, which is too large"
        );
    }
    Ok(Matrix::from_text(&lines_found))
}
