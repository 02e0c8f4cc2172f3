//! The matrix of a table: given as an argument, or read from a file.

use crate::diag::Fault;
use crate::external::call::Call;

/// A matrix, row-major.
#[derive(Debug, Clone)]
pub(crate) struct Matrix {
    pub(super) rows: usize,
    pub(super) columns: usize,
    pub(super) values: Vec<f64>,
}

impl Matrix {
    pub(crate) fn column(&self, column: usize) -> Vec<f64> {
        (0..self.rows).map(|row| self.values[row * self.columns + column]).collect()
    }
}

/// Positions of the arguments that say where a table comes from.
pub(crate) struct Source {
    pub(super) file: usize,
    pub(super) name: usize,
    pub(super) matrix: usize,
    /// Delimiter and number of header lines of a CSV file.
    pub(super) csv: Option<(usize, usize)>,
}

/// What stands where no file or no name is given.
const NOTHING: &str = "NoName";

/// Whether a text given as the name of a file is one.
pub(crate) fn names_a_file(text: &str) -> bool {
    !matches!(text.trim(), "" | NOTHING)
}

impl Source {
    /// The matrix, at least one row and two columns, every number finite.
    pub(crate) fn read(&self, call: &mut Call<'_>) -> Result<Matrix, Fault> {
        let file = call.text(self.file).to_owned();
        let matrix = match names_a_file(&file) {
            true => self.in_file(call, &file)?,
            false => self.given(call)?,
        };
        if matrix.rows == 0 || matrix.columns < 2 {
            return Err(call.fault(format!(
                "a table needs at least one row and two columns, but this one has {} and {}",
                matrix.rows, matrix.columns
            )));
        }
        match matrix.values.iter().find(|value| !value.is_finite()) {
            Some(value) => Err(call.fault(format!("the table contains {value}"))),
            None => Ok(matrix),
        }
    }

    fn given(&self, call: &Call<'_>) -> Result<Matrix, Fault> {
        match *call.dims(self.matrix) {
            [0, _] if call.text(self.name).trim() != NOTHING => Err(call.fault(format!(
                "the table `{}` would be defined by a function `usertab` in C, which is not \
                 supported",
                call.text(self.name)
            ))),
            [rows, columns] => Ok(Matrix {
                rows: rows as usize,
                columns: columns as usize,
                values: call.array(self.matrix).to_vec(),
            }),
            _ => Err(call.fault("the table is not a matrix")),
        }
    }

    fn in_file(&self, call: &mut Call<'_>, file: &str) -> Result<Matrix, Fault> {
        let bytes = call.outside.read(file)?;
        let ending = file.rsplit('.').next().unwrap_or_default().to_ascii_lowercase();
        if let ("csv", Some((delimiter, skipped))) = (ending.as_str(), self.csv) {
            let delimiter = call.text(delimiter).chars().next().unwrap_or(',');
            let skipped = usize::try_from(call.whole(skipped)).unwrap_or(0);
            return csv(&String::from_utf8_lossy(&bytes), delimiter, skipped)
                .map_err(|reason| call.fault(format!("the file `{file}` {reason}")));
        }
        let found = crate::mat::read(&bytes)?;
        let found = found.matrix(call.text(self.name))?;
        let places = (0..found.rows).flat_map(|i| (0..found.columns).map(move |j| (i, j)));
        let values = places.map(|(i, j)| found.get(i, j)).collect();
        Ok(Matrix { rows: found.rows, columns: found.columns, values })
    }
}

fn csv(text: &str, delimiter: char, skipped: usize) -> Result<Matrix, String> {
    let mut values = Vec::new();
    let (mut rows, mut columns) = (0, 0);
    for (number, line) in text.lines().enumerate().skip(skipped) {
        if line.trim().is_empty() {
            continue;
        }
        let before = values.len();
        for field in line.split(delimiter) {
            let value = field.trim().parse::<f64>();
            values.push(value.map_err(|_| {
                format!("has no number in line {}: `{}`", number + 1, field.trim())
            })?);
        }
        let width = values.len() - before;
        if rows > 0 && width != columns {
            return Err(format!(
                "has {width} numbers in line {}, but {columns} in the lines above",
                number + 1
            ));
        }
        (rows, columns) = (rows + 1, width);
    }
    Ok(Matrix { rows, columns, values })
}
