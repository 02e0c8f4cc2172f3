//! Results in MAT version 4, in the layout of Dymola that OpenModelica writes too.
//!
//! | matrix | content |
//! |---|---|
//! | `Aclass` | four lines: `Atrajectory`, `1.1`, empty, `binTrans` or `binNormal` |
//! | `name`, `description` | text, one variable a column (binTrans) or a row (binNormal) |
//! | `dataInfo` | per variable: matrix (0 for time, 1, 2), column in it, negative if the sign differs; 0 for linear interpolation; -1 for undefined outside |
//! | `data_1` | constants, at the first and the last point in time |
//! | `data_2` | trajectories, time first |
//!
//! In binTrans all but `Aclass` are transposed. Written: binTrans in double precision; read: both
//! layouts in any precision. A unit is in brackets at the end of the description.

use super::errors::BAD_RESULT_FILE;
use super::{Format, ResultTable, Series, Values};
use crate::bail;
use crate::diag::Fault;
use crate::mat::{self, MatFile, Matrix, Storage};
use crate::registry::Entry;
use std::collections::HashMap;

pub(crate) const ENTRY: Entry<dyn Format> = Entry {
    name: "mat",
    aliases: &["dymola"],
    summary: "MAT version 4 in the layout of Dymola and OpenModelica",
    reference: "",
    make: |_| Ok(Box::new(Mat)),
};

struct Mat;

impl Format for Mat {
    fn extension(&self) -> &'static str {
        "mat"
    }

    fn write(&self, table: &ResultTable) -> Result<Vec<u8>, Fault> {
        table.check()?;
        // The matrix of trajectories and the file.
        table.has_room(2 * size_of::<f64>())?;
        let layout = Layout::new(table);
        let class = Matrix::from_text(&["Atrajectory", "1.1", "", "binTrans"]);
        let names: Vec<&str> = table.names().collect();
        let time = "Time in [s]".to_owned();
        let descriptions: Vec<String> =
            std::iter::once(time).chain(table.series.iter().map(describe)).collect();
        let mut out = Vec::new();
        mat::append_v4(&mut out, "Aclass", &class, Storage::U8)?;
        let names = Matrix::from_text(&names).transposed();
        mat::append_v4(&mut out, "name", &names, Storage::U8)?;
        let descriptions = Matrix::from_text(&descriptions).transposed();
        mat::append_v4(&mut out, "description", &descriptions, Storage::U8)?;
        mat::append_v4(&mut out, "dataInfo", &layout.data_info(table), Storage::I32)?;
        mat::append_v4(&mut out, "data_1", &layout.constants(table), Storage::F64)?;
        mat::append_v4(&mut out, "data_2", &layout.trajectories(table), Storage::F64)?;
        Ok(out)
    }

    fn read(&self, bytes: &[u8]) -> Result<ResultTable, Fault> {
        let file = mat::read(bytes)?;
        let is_transposed = is_transposed(&file)?;
        let names = strings(&file, "name", is_transposed)?;
        let descriptions = strings(&file, "description", is_transposed)?;
        let info = oriented(&file, "dataInfo", is_transposed)?;
        let data =
            [oriented(&file, "data_1", is_transposed)?, oriented(&file, "data_2", is_transposed)?];
        if info.columns < 2 || info.rows != names.len() || descriptions.len() != names.len() {
            bail!(BAD_RESULT_FILE, "`name`, `description` and `dataInfo` differ in size");
        }
        if data[1].columns == 0 {
            bail!(BAD_RESULT_FILE, "`data_2` contains no time");
        }
        Reading { info, data, by_source: HashMap::new(), interpolated: 0 }
            .table(&names, &descriptions)
    }
}

/// Whether a file holds the results of a simulation.
pub(crate) fn holds_results(file: &MatFile) -> bool {
    file.arrays.contains_key("Aclass") && is_transposed(file).is_ok()
}

/// Where each series with values goes.
struct Layout {
    /// Places of the constants, in the order of `data_1` after time.
    constants: Vec<usize>,
    /// Places of the trajectories, in the order of `data_2` after time.
    trajectories: Vec<usize>,
    /// Per series: matrix and column; (0, 0) for aliases.
    homes: Vec<(u8, usize)>,
}

impl Layout {
    fn new(table: &ResultTable) -> Layout {
        let (mut constants, mut trajectories) = (Vec::new(), Vec::new());
        let mut homes = Vec::with_capacity(table.series.len());
        for (place, series) in table.series.iter().enumerate() {
            let (matrix, list) = match series.values {
                Values::Constant(_) => (1, &mut constants),
                Values::Trajectory(_) => (2, &mut trajectories),
                Values::Alias { .. } => {
                    homes.push((0, 0));
                    continue;
                }
            };
            list.push(place);
            homes.push((matrix, list.len() + 1));
        }
        Layout { constants, trajectories, homes }
    }

    fn data_info(&self, table: &ResultTable) -> Matrix {
        let mut values = vec![0.0, 1.0, 0.0, -1.0];
        for place in 0..table.series.len() {
            let (target, sign) = table.resolve(place);
            let (matrix, column) = self.homes[target];
            values.extend([f64::from(matrix), sign * column as f64, 0.0, -1.0]);
        }
        Matrix::from_columns(4, values.len() / 4, values)
    }

    fn constants(&self, table: &ResultTable) -> Matrix {
        let rows = self.constants.len() + 1;
        let ends = [table.time.first(), table.time.last()];
        let mut values = Vec::with_capacity(2 * rows);
        for end in ends {
            values.push(end.copied().unwrap_or(0.0));
            values.extend(self.constants.iter().map(|place| match table.series[*place].values {
                Values::Constant(value) => value,
                _ => unreachable!("`constants` lists constants"),
            }));
        }
        Matrix::from_columns(rows, 2, values)
    }

    fn trajectories(&self, table: &ResultTable) -> Matrix {
        let columns: Vec<&[f64]> = std::iter::once(&*table.time)
            .chain(self.trajectories.iter().map(|place| match &table.series[*place].values {
                Values::Trajectory(values) => &**values,
                _ => unreachable!("`trajectories` lists trajectories"),
            }))
            .collect();
        let points = table.time.len();
        let values = (0..points).flat_map(|row| columns.iter().map(move |column| column[row]));
        Matrix::from_columns(columns.len(), points, values.collect())
    }
}

fn describe(series: &Series) -> String {
    match (&*series.description, &*series.unit) {
        (text, "") => text.to_owned(),
        ("", unit) => format!("[{unit}]"),
        (text, unit) => format!("{text} [{unit}]"),
    }
}

/// Description and unit; of `[unit|displayUnit]` the unit, and no unit of `[:#(type=Integer)]`.
fn split_description(text: &str) -> (String, String) {
    let parts = text.strip_suffix(']').and_then(|text| text.rsplit_once('['));
    let Some((description, unit)) = parts else { return (text.to_owned(), String::new()) };
    let unit = unit.split(['|', ':']).next().unwrap_or_default();
    (description.trim_end().to_owned(), unit.to_owned())
}

fn is_transposed(file: &MatFile) -> Result<bool, Fault> {
    let class = match file.arrays.get("Aclass") {
        Some(class) => class.row_strings(),
        None => bail!(
            BAD_RESULT_FILE,
            "the file contains no simulation results: it has no matrix `Aclass`";
            help: "read plain matrices with `readMatrix`"
        ),
    };
    if class.first().map(String::as_str) != Some("Atrajectory") {
        bail!(BAD_RESULT_FILE, "`Aclass` does not contain `Atrajectory`");
    }
    match class.get(3).map(String::as_str) {
        Some("binTrans") => Ok(true),
        Some("binNormal") => Ok(false),
        _ => bail!(BAD_RESULT_FILE, "`Aclass` contains neither `binTrans` nor `binNormal`"),
    }
}

fn strings(file: &MatFile, name: &str, is_transposed: bool) -> Result<Vec<String>, Fault> {
    let matrix = file.matrix(name)?;
    Ok(if is_transposed { matrix.column_strings() } else { matrix.row_strings() })
}

/// The matrix as in binNormal: time points are rows.
fn oriented(file: &MatFile, name: &str, is_transposed: bool) -> Result<Matrix, Fault> {
    let matrix = file.matrix(name)?;
    Ok(if is_transposed { matrix.transposed() } else { matrix.clone() })
}

struct Reading {
    info: Matrix,
    data: [Matrix; 2],
    /// Which series holds the values of a matrix and column, and whether with the other sign.
    by_source: HashMap<(usize, usize), (usize, bool)>,
    /// Values made by interpolation so far.
    interpolated: usize,
}

/// Values that interpolation may make of two in `data_1`: the file pays for neither.
const MAX_INTERPOLATED: usize = 1 << 26;

impl Reading {
    fn table(mut self, names: &[String], descriptions: &[String]) -> Result<ResultTable, Fault> {
        let mut table = ResultTable::new(self.data[1].column(0).to_vec());
        for (row, (name, description)) in names.iter().zip(descriptions).enumerate() {
            let (matrix, column, negated) = self.source(row, name)?;
            if row == 0 && column == 0 {
                table.time_name.clone_from(name);
                continue;
            }
            let values = self.values(&table, matrix, column, negated)?;
            let (description, unit) = split_description(description);
            table.series.push(Series { name: name.clone(), unit, description, values });
        }
        table.check()?;
        Ok(table)
    }

    /// Matrix (1 or 2), column counted from 0, and whether the sign differs.
    fn source(&self, row: usize, name: &str) -> Result<(usize, usize, bool), Fault> {
        let (matrix, column) = (self.info.get(row, 0), self.info.get(row, 1));
        let matrix = match matrix {
            1.0 => 1,
            0.0 | 2.0 => 2,
            _ => bail!(BAD_RESULT_FILE, "`{name}` is in `data_{matrix}`, which is not supported"),
        };
        let columns = self.data[matrix - 1].columns;
        if !(1.0..=columns as f64).contains(&column.abs()) {
            bail!(
                BAD_RESULT_FILE,
                "`{name}` is in column {column} of `data_{matrix}`, which has {columns}"
            );
        }
        Ok((matrix, column.abs() as usize - 1, column < 0.0))
    }

    fn values(
        &mut self,
        table: &ResultTable,
        matrix: usize,
        column: usize,
        negated: bool,
    ) -> Result<Values, Fault> {
        if let Some((of, sign)) = self.by_source.get(&(matrix, column)) {
            return Ok(Values::Alias { of: *of, negated: negated != *sign });
        }
        self.by_source.insert((matrix, column), (table.series.len(), negated));
        let sign = if negated { -1.0 } else { 1.0 };
        let stored = self.data[matrix - 1].column(column);
        Ok(match stored {
            _ if matrix == 2 => Values::Trajectory(stored.iter().map(|v| sign * v).collect()),
            [first, .., last] if first != last && !(first.is_nan() && last.is_nan()) => {
                self.interpolated += table.time.len();
                if self.interpolated > MAX_INTERPOLATED {
                    bail!(BAD_RESULT_FILE, "`data_1` contains too many values that change");
                }
                Values::Trajectory(line(&table.time, sign * first, sign * last))
            }
            [first, ..] => Values::Constant(sign * first),
            [] => bail!(BAD_RESULT_FILE, "`data_1` contains no values"),
        })
    }
}

/// The straight line from `first` to `last`: what `data_1` means where its two values differ.
fn line(time: &[f64], first: f64, last: f64) -> Vec<f64> {
    let start = time.first().copied().unwrap_or(0.0);
    let length = time.last().copied().unwrap_or(0.0) - start;
    let share = |t: f64| if length > 0.0 { (t - start) / length } else { 0.0 };
    time.iter().map(|t| first + share(*t) * (last - first)).collect()
}
