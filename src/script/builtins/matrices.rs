//! Matrices in files: MAT of every version, text in the `#1` format, and CSV.

use super::{Args, Builtin, Failure, Family};
use crate::Session;
use crate::access::policy::Access;
use crate::bail;
use crate::diag::Fault;
use crate::errors::BAD_ARGUMENT;
use crate::mat::{self, MatFile, Matrix};
use crate::value::{RealMatrix, Value};
use std::borrow::Cow;
use std::path::Path;

/// The commands of this file.
pub(super) const FAMILY: Family = Family {
    packages: &["DymolaCommands.MatrixIO", "Modelica.Utilities.Streams"],
    dialect: None,
    builtins: &[
        Builtin { header: READ_MATRIX_SIZE, run: read_matrix_size },
        Builtin { header: READ_MATRIX, run: read_matrix },
        Builtin { header: WRITE_MATRIX, run: write_matrix },
        Builtin { header: READ_REAL_MATRIX, run: read_real_matrix },
        Builtin { header: WRITE_REAL_MATRIX, run: write_real_matrix },
    ],
};

/// Reads a data file.
pub(super) fn read_file(session: &mut Session, name: &str) -> Result<MatFile, Fault> {
    let bytes = session.world.read_bytes(Path::new(name))?;
    mat::read_named(name, &bytes)
}

/// A matrix of a file; in a table also the columns `name[1]`, `name[2]`, … as one.
fn matrix_of<'f>(file: &'f MatFile, name: &str) -> Result<Cow<'f, Matrix>, Fault> {
    let column = |j: usize| file.arrays.get(&format!("{name}[{j}]"));
    let columns: Vec<&Matrix> = (1..).map_while(column).collect();
    let Some(first) = columns.first().filter(|_| file.is_table()) else {
        return file.matrix(name).map(Cow::Borrowed);
    };
    let values = columns.iter().flat_map(|column| column.values.iter().copied()).collect();
    Ok(Cow::Owned(Matrix::from_columns(first.values.len(), columns.len(), values)))
}

const READ_MATRIX_SIZE: &str = r#"
function readMatrixSize "Numbers of rows and columns of a matrix in a file."
  input String fileName;
  input String matrixName;
  output Integer sizes[2];
end readMatrixSize;
"#;

fn read_matrix_size(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let (file, name): (String, String) = (args.take("fileName")?, args.take("matrixName")?);
    let contents = read_file(session, &file)?;
    let matrix = matrix_of(&contents, &name)?;
    Ok(vec![matrix.rows as i64, matrix.columns as i64].into())
}

const READ_MATRIX: &str = r#"
function readMatrix "Reads a matrix from a file."
  input String fileName;
  input String matrixName;
  input Integer rows "as returned by readMatrixSize";
  input Integer columns;
  output Real matrix[rows, columns];
end readMatrix;
"#;

const READ_REAL_MATRIX: &str = r#"
function readRealMatrix "Reads a matrix from a file."
  input String fileName;
  input String matrixName;
  input Integer nrow "as returned by readMatrixSize";
  input Integer ncol;
  input Boolean verboseRead = true;
  output Real matrix[nrow, ncol];
end readRealMatrix;
"#;

fn read_matrix(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let sizes = [args.take("rows")?, args.take("columns")?];
    checked_matrix(session, &mut args, sizes)
}

fn read_real_matrix(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let sizes = [args.take("nrow")?, args.take("ncol")?];
    checked_matrix(session, &mut args, sizes)
}

fn checked_matrix(
    session: &mut Session,
    args: &mut Args,
    [rows, columns]: [i64; 2],
) -> Result<Value, Failure> {
    let (file, name): (String, String) = (args.take("fileName")?, args.take("matrixName")?);
    let contents = read_file(session, &file)?;
    let matrix = matrix_of(&contents, &name)?;
    if (matrix.rows as i64, matrix.columns as i64) != (rows, columns) {
        bail!(
            BAD_ARGUMENT,
            "`{name}` in `{file}` has {} rows and {} columns instead of {rows} and {columns}",
            matrix.rows, matrix.columns;
            help: "get the sizes with `readMatrixSize(\"{file}\", \"{name}\")`"
        );
    }
    let elements = matrix.row_major();
    let (rows, columns) = (matrix.rows, matrix.columns);
    let notes = contents.about(&name).map(|_| contents.column(&name)).transpose()?;
    session.note_data(&contents, notes.iter().flat_map(crate::mat::Column::notes));
    Ok(RealMatrix { rows, columns, elements }.into())
}

const WRITE_MATRIX: &str = r#"
function writeMatrix "Writes a matrix to a file; the extension selects the format: .csv and .tsv a table, .txt text in the #1 format, .mat a MAT file of version 4."
  input String fileName;
  input String matrixName;
  input Real matrix[:, :] "a vector v is written as [v]";
  input Boolean append = false "false: the file is overwritten";
  output Boolean ok;
end writeMatrix;
"#;

const WRITE_REAL_MATRIX: &str = r#"
function writeRealMatrix "Writes a matrix to a file, as writeMatrix does."
  input String fileName;
  input String matrixName;
  input Real matrix[:, :];
  input Boolean append = false "false: the file is overwritten";
  input String format = "4" "of MAT files; only version 4 is supported";
  output Boolean success;
end writeRealMatrix;
"#;

fn write_real_matrix(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let format: String = args.take("format")?;
    if format != "4" {
        bail!(
            BAD_ARGUMENT,
            "`format` of `writeRealMatrix` is \"{format}\"; only \"4\" is supported"
        );
    }
    write_matrix(session, args)
}

pub(super) fn write_matrix(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let (file, name): (String, String) = (args.take("fileName")?, args.take("matrixName")?);
    let matrix: RealMatrix = args.take("matrix")?;
    let rows: Vec<Vec<f64>> = (0..matrix.rows).map(|row| matrix.row(row).to_vec()).collect();
    let new = match matrix.rows {
        0 => Matrix::from_columns(0, matrix.columns, Vec::new()),
        _ => Matrix::from_rows(&rows),
    };
    let append: bool = args.take("append")?;
    let written = write(session, &file, &name, new, append);
    Ok(session.succeeded(written))
}

/// Writes the matrix beside those that the file holds, if it is to be kept.
fn write(
    session: &mut Session,
    file: &str,
    name: &str,
    new: Matrix,
    append: bool,
) -> Result<(), Fault> {
    let path = Path::new(file);
    // Where it may not be written, whether it exists stays unknown.
    let is_kept =
        append && session.world.exists(path) && session.world.may(Access::Write, path).is_ok();
    let mut arrays = match is_kept {
        true => read_file(session, file)?.arrays,
        false => Default::default(),
    };
    arrays.insert(name.to_owned(), new);
    let bytes = mat::write_named(file, &arrays)?;
    session.world.write_file(path, &bytes)
}
