//! Result files compared with each other, and parts of result files.

use super::{Args, Builtin, Failure, Family};
use crate::bail;
use crate::diag::Fault;
use crate::errors::BAD_ARGUMENT;
use crate::results::{self, ResultTable, Series, Values};
use crate::value::Value;
use crate::{Dialect, Session};
use std::fmt::Write as _;
use std::path::Path;

/// The commands of this file.
pub(super) const FAMILY: Family = Family {
    packages: &["OpenModelica.Scripting"],
    dialect: Some(Dialect::OpenModelica),
    builtins: &[
        Builtin { header: COMPARE_SIMULATION_RESULTS, run: compare_simulation_results },
        Builtin { header: DIFF_SIMULATION_RESULTS, run: diff_simulation_results },
        Builtin { header: FILTER_SIMULATION_RESULTS, run: filter_simulation_results },
    ],
};

const COMPARE_SIMULATION_RESULTS: &str = r#"
function compareSimulationResults "Compares two result files at the time points of the second; writes the differences to a log."
  input String filename;
  input String reffilename;
  input String logfilename "overwritten if it exists; empty: no log";
  input Real relTol = 0.01;
  input Real absTol = 0.0001;
  input String vars[:] = fill("", 0) "variables to compare; empty: all variables of the reference";
  output String result[:] "the first line says whether the files agree; then the variables that differ";
end compareSimulationResults;
"#;

fn compare_simulation_results(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let (file, reference): (String, String) = (args.take("filename")?, args.take("reffilename")?);
    let log: String = args.take("logfilename")?;
    let tolerance = Tolerance { relative: args.take("relTol")?, absolute: args.take("absTol")? };
    let requested: Vec<String> = args.take("vars")?;
    let actual = super::results::table(session, &file)?;
    let expected = super::results::table(session, &reference)?;
    let differences = differences(&actual, &expected, &requested, tolerance)?;
    if !log.is_empty() {
        let lines: String = differences.iter().map(|one| format!("{one}\n")).collect();
        session.world.write_file(Path::new(&log), lines.as_bytes())?;
    }
    let mut result = vec![match differences.is_empty() {
        true => "Files Equal!".to_owned(),
        false => "Files not Equal!".to_owned(),
    }];
    result.extend(differences.into_iter().map(|difference| difference.name));
    Ok(result.into())
}

const DIFF_SIMULATION_RESULTS: &str = r#"
function diffSimulationResults "Compares two result files and returns the variables that differ."
  input String actualFile;
  input String expectedFile;
  input String diffPrefix "for each variable that differs a file <prefix>.<variable>.csv is written; empty: no files";
  input Real relTol = 1e-3 "of the largest value of the variable";
  input Real relTolDiffMinMax = 1e-4 "of the range of the variable";
  input Real rangeDelta = 0.002 "tolerance in time, as a fraction of the simulated time";
  input String vars[:] = fill("", 0) "variables to compare; empty: all variables of the expected file";
  input Boolean keepEqualResults = false "whether files are also written for variables that agree";
  output Boolean success;
  output String failVars[:];
end diffSimulationResults;
"#;

fn diff_simulation_results(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let actual = super::results::table(session, &args.take::<String>("actualFile")?)?;
    let expected = super::results::table(session, &args.take::<String>("expectedFile")?)?;
    let prefix: String = args.take("diffPrefix")?;
    let (relative, of_range, delta): (f64, f64, f64) =
        (args.take("relTol")?, args.take("relTolDiffMinMax")?, args.take("rangeDelta")?);
    let requested: Vec<String> = args.take("vars")?;
    let keep: bool = args.take("keepEqualResults")?;
    let mut failed = Vec::new();
    for name in names(&expected, &requested) {
        let tube = Tube::around(&expected, &name, [relative, of_range, delta])?;
        let inside = actual.column(&name).is_ok_and(|values| tube.holds(&actual.time, &values));
        if !prefix.is_empty() && (keep || !inside) {
            write_pair(session, &format!("{prefix}.{name}.csv"), [&actual, &expected], &name)?;
        }
        if !inside {
            failed.push(name);
        }
    }
    Ok(Value::Tuple(vec![failed.is_empty().into(), failed.into()]))
}

const FILTER_SIMULATION_RESULTS: &str = r#"
function filterSimulationResults "Writes some variables of a result file to another."
  input String inFile;
  input String outFile;
  input String vars[:];
  input Integer numberOfIntervals = 0 "0: at the time points of the file";
  input Boolean removeDescription = false;
  input Boolean hintReadAllVars = true "has no effect";
  output Boolean success;
end filterSimulationResults;
"#;

fn filter_simulation_results(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let table = super::results::table(session, &args.take::<String>("inFile")?)?;
    let file: String = args.take("outFile")?;
    let names: Vec<String> = args.take("vars")?;
    let intervals: i64 = args.take("numberOfIntervals")?;
    let plain: bool = args.take("removeDescription")?;
    let mut filtered = ResultTable::new(grid(&table, intervals)?);
    filtered.time_name.clone_from(&table.time_name);
    for name in names.iter().filter(|name| **name != table.time_name && *name != "time") {
        let values = match intervals {
            0 => table.column(name)?,
            _ => table.interpolate(name, &filtered.time)?,
        };
        let known = table.series.iter().find(|series| series.name == *name);
        let mut series = known.map_or_else(
            || Series::new(name.as_str(), Values::Constant(0.0)),
            |known| Series { values: Values::Constant(0.0), ..known.clone() },
        );
        if plain {
            series.description.clear();
        }
        series.values = Values::Trajectory(values);
        filtered.series.push(series);
    }
    let bytes = results::format_of_file(&file)?.write(&filtered)?;
    let written = session.world.write_file(Path::new(&file), &bytes);
    Ok(session.succeeded(written))
}

fn grid(table: &ResultTable, intervals: i64) -> Result<Vec<f64>, Fault> {
    let (Some(start), Some(stop)) = (table.time.first(), table.time.last()) else {
        return Ok(Vec::new());
    };
    match intervals {
        0 => Ok(table.time.clone()),
        1..=10_000_000 => {
            let at = |i: i64| start + (stop - start) * i as f64 / intervals as f64;
            Ok((0..intervals).map(at).chain([*stop]).collect())
        }
        _ => bail!(BAD_ARGUMENT, "`numberOfIntervals` is {intervals}, outside 0 to 10000000"),
    }
}

/// The variables to compare: those requested, else all of the table.
fn names(table: &ResultTable, requested: &[String]) -> Vec<String> {
    match requested {
        [] => table.series.iter().map(|series| series.name.clone()).collect(),
        requested => requested.to_vec(),
    }
}

#[derive(Clone, Copy)]
struct Tolerance {
    relative: f64,
    absolute: f64,
}

/// A variable and where it differs first.
struct Difference {
    name: String,
    at: Option<[f64; 3]>,
}

impl std::fmt::Display for Difference {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self.at {
            Some([time, actual, expected]) => {
                write!(f, "{}: {actual} instead of {expected} at {time}", self.name)
            }
            None => write!(f, "{}: missing", self.name),
        }
    }
}

/// |a - b| ≤ absolute + relative |b| at every time of the expected results inside the actual ones.
fn differences(
    actual: &ResultTable,
    expected: &ResultTable,
    requested: &[String],
    tolerance: Tolerance,
) -> Result<Vec<Difference>, Fault> {
    let (Some(first), Some(last)) = (actual.time.first(), actual.time.last()) else {
        bail!(BAD_ARGUMENT, "the first file contains no results")
    };
    let inside = |time: &f64| (first..=last).contains(&time);
    let times: Vec<f64> = expected.time.iter().copied().filter(inside).collect();
    let mut different = Vec::new();
    for name in names(expected, requested) {
        let reference = expected.interpolate(&name, &times)?;
        let Ok(values) = actual.interpolate(&name, &times) else {
            different.push(Difference { name, at: None });
            continue;
        };
        let differs = |(a, b): (&f64, &f64)| {
            (a - b)
                .abs()
                .partial_cmp(&(tolerance.absolute + tolerance.relative * b.abs()))
                .is_none_or(std::cmp::Ordering::is_gt)
        };
        if let Some(at) = values.iter().zip(&reference).position(differs) {
            different.push(Difference { name, at: Some([times[at], values[at], reference[at]]) });
        }
    }
    Ok(different)
}

/// Bounds around a reference: values may be off by some of the variable's size, and early or late.
struct Tube {
    time: Vec<f64>,
    values: Vec<f64>,
    width: f64,
    delta: f64,
}

impl Tube {
    fn around(table: &ResultTable, name: &str, widths: [f64; 3]) -> Result<Tube, Fault> {
        let [relative, of_range, delta] = widths;
        let values = table.column(name)?;
        let (low, high) = values
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(*v), h.max(*v)));
        let largest = low.abs().max(high.abs());
        let width = (relative * largest).max(of_range * (high - low)).max(f64::MIN_POSITIVE);
        let length = table.time.last().unwrap_or(&0.0) - table.time.first().unwrap_or(&0.0);
        Ok(Tube { time: table.time.clone(), values, width, delta: delta * length })
    }

    fn holds(&self, times: &[f64], values: &[f64]) -> bool {
        times.iter().zip(values).all(|(time, value)| {
            let (low, high) = self.bounds(*time);
            (low - self.width..=high + self.width).contains(value)
        })
    }

    /// The least and largest value of the reference near a time.
    fn bounds(&self, time: f64) -> (f64, f64) {
        let (from, to) = (time - self.delta, time + self.delta);
        let first = self.time.partition_point(|t| *t < from);
        let last = self.time.partition_point(|t| *t <= to);
        let inside = self.values[first..last].iter().copied();
        inside
            .chain([self.at(from), self.at(to)])
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)))
    }

    /// The reference at a time, constant outside.
    fn at(&self, time: f64) -> f64 {
        let after = self.time.partition_point(|t| *t <= time);
        match (after.checked_sub(1), self.time.get(after)) {
            (Some(before), Some(next)) => {
                let share = (time - self.time[before]) / (next - self.time[before]);
                self.values[before] + share * (self.values[after] - self.values[before])
            }
            (Some(last), None) => self.values[last],
            (None, _) => self.values.first().copied().unwrap_or(f64::NAN),
        }
    }
}

fn write_pair(
    session: &mut Session,
    file: &str,
    [actual, expected]: [&ResultTable; 2],
    name: &str,
) -> Result<(), Fault> {
    let mut text = "time,actual,expected\n".to_owned();
    let reference = expected.column(name)?;
    let other = actual.column(name).ok();
    for (time, value) in expected.time.iter().zip(&reference) {
        let found = other.as_ref().and_then(|_| actual.interpolate(name, &[*time]).ok());
        let found = found.map_or(String::new(), |found| found[0].to_string());
        let _ = writeln!(text, "{time},{found},{value}");
    }
    session.world.write_file(Path::new(file), text.as_bytes())
}
