//! Dymola's package `DataFiles`: matrices in MAT and CSV files.

use super::matrices::{read_file, write_matrix};
use super::strings::string_array;
use super::{Args, Builtin, Failure, Family};
use crate::bail;
use crate::errors::BAD_ARGUMENT;
use crate::value::{RealMatrix, Value};
use crate::{Dialect, Session};
use std::path::Path;

/// The commands of this file.
pub(super) const FAMILY: Family = Family {
    packages: &["DataFiles"],
    dialect: Some(Dialect::Dymola),
    builtins: &[
        Builtin { header: READ_MAT_MATRIX, run: read_mat_matrix },
        Builtin { header: READ_MAT_MATRIX_SIZE, run: read_mat_matrix_size },
        Builtin { header: WRITE_MAT_MATRIX, run: write_matrix },
        Builtin { header: READ_CSV_MATRIX, run: read_csv_matrix },
        Builtin { header: READ_CSV_SIZE, run: read_csv_size },
        Builtin { header: READ_CSV_HEADERS, run: read_csv_headers },
        Builtin { header: WRITE_CSV_MATRIX, run: write_csv_matrix },
        Builtin { header: WRITE_CSV_FILE_INTERNAL, run: write_csv_file_internal },
    ],
};

const READ_MAT_MATRIX: &str = r#"
function readMATmatrix "Reads a matrix from a MAT file."
  input String fileName;
  input String matrixName;
  output Real matrix[:, :];
end readMATmatrix;
"#;

fn read_mat_matrix(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let (file, name): (String, String) = (args.take("fileName")?, args.take("matrixName")?);
    let contents = read_file(session, &file)?;
    let matrix = contents.matrix(&name)?;
    let (rows, columns) = (matrix.rows, matrix.columns);
    Ok(RealMatrix { rows, columns, elements: matrix.row_major() }.into())
}

const READ_MAT_MATRIX_SIZE: &str = r#"
function readMATmatrixSize "Numbers of rows and columns of a matrix in a MAT file."
  input String fileName;
  input String matrixName;
  output Integer rows;
  output Integer columns;
end readMATmatrixSize;
"#;

fn read_mat_matrix_size(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let (file, name): (String, String) = (args.take("fileName")?, args.take("matrixName")?);
    let contents = read_file(session, &file)?;
    let matrix = contents.matrix(&name)?;
    Ok(Value::Tuple(vec![(matrix.rows as i64).into(), (matrix.columns as i64).into()]))
}

const WRITE_MAT_MATRIX: &str = r#"
function writeMATmatrix "Writes a matrix to a MAT file of version 4."
  input String fileName;
  input String matrixName;
  input Real matrix[:, :];
  input Boolean append = false "false: the file is overwritten";
  output Boolean ok;
end writeMATmatrix;
"#;

/// The columns of a CSV file with their names.
fn columns(session: &mut Session, args: &mut Args) -> Result<Vec<(String, Vec<f64>)>, Failure> {
    let file: String = args.take("fileName")?;
    let bytes = session.world.read_bytes(Path::new(&file))?;
    let contents = crate::mat::read_csv(&bytes)?;
    Ok(contents.arrays.into_iter().map(|(name, matrix)| (name, matrix.values)).collect())
}

const READ_CSV_MATRIX: &str = r#"
function readCSVmatrix "Reads the numbers of a CSV file with one header line."
  input String fileName;
  output Real matrix[:, :];
end readCSVmatrix;
"#;

fn read_csv_matrix(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let columns = columns(session, &mut args)?;
    let rows = columns.first().map_or(0, |(_, values)| values.len());
    let elements = (0..rows).flat_map(|row| columns.iter().map(move |(_, values)| values[row]));
    Ok(RealMatrix { rows, columns: columns.len(), elements: elements.collect() }.into())
}

const READ_CSV_SIZE: &str = r#"
function readCSVsize "Numbers of rows and columns of a CSV file with one header line."
  input String fileName;
  output Integer rows;
  output Integer columns;
end readCSVsize;
"#;

fn read_csv_size(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let columns = columns(session, &mut args)?;
    let rows = columns.first().map_or(0, |(_, values)| values.len() as i64);
    Ok(Value::Tuple(vec![rows.into(), (columns.len() as i64).into()]))
}

const READ_CSV_HEADERS: &str = r#"
function readCSVheaders "The names of the columns of a CSV file."
  input String fileName;
  output String headers[:];
end readCSVheaders;
"#;

fn read_csv_headers(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    Ok(string_array(columns(session, &mut args)?.into_iter().map(|(name, _)| name)))
}

const WRITE_CSV_MATRIX: &str = r#"
function writeCSVmatrix "Writes a matrix to a CSV file, below a header line."
  input String fileName;
  input String headers[:] "one name per column; empty: no header line";
  input Real data[:, :];
  input String separator = ";";
  input Boolean quoteAllHeaders = true "false: quote only headers that need it";
  output Boolean ok;
end writeCSVmatrix;
"#;

const WRITE_CSV_FILE_INTERNAL: &str = r#"
function writeCSVFileInternal "Writes a matrix to a text file, below a header line."
  input String fileName;
  input String headers[:] "one name per column; empty: no header line";
  input Real data[:, :];
  input String separator = ";" "empty: a space";
  input Boolean quoteAllHeaders = false;
  output Boolean ok;
end writeCSVFileInternal;
"#;

fn write_csv_file_internal(session: &mut Session, args: Args) -> Result<Value, Failure> {
    write_csv_matrix(session, args)
}

fn write_csv_matrix(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let file: String = args.take("fileName")?;
    let headers: Vec<String> = args.take("headers")?;
    let data: RealMatrix = args.take("data")?;
    let separator: String = args.take("separator")?;
    let separator = if separator.is_empty() { " " } else { &separator };
    let quotes: bool = args.take("quoteAllHeaders")?;
    if !headers.is_empty() && headers.len() != data.columns {
        let (names, columns) = (headers.len(), data.columns);
        bail!(BAD_ARGUMENT, "there are {names} headers for {columns} columns");
    }
    let quoted = |name: &String| {
        let cell = crate::results::quoted(name);
        // A cell that is marked as text, too.
        let needs_quotes = cell[1..cell.len() - 1] != **name || name.contains(separator);
        if quotes || needs_quotes { cell } else { name.clone() }
    };
    let mut lines: Vec<String> = Vec::with_capacity(data.rows + 1);
    if !headers.is_empty() {
        lines.push(headers.iter().map(quoted).collect::<Vec<_>>().join(separator));
    }
    lines.extend(
        (0..data.rows).map(|row| {
            data.row(row).iter().map(f64::to_string).collect::<Vec<_>>().join(separator)
        }),
    );
    let contents = lines.join("\n") + "\n";
    let written = session.world.write_file(Path::new(&file), contents.as_bytes());
    Ok(session.succeeded(written))
}
