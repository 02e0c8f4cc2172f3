//! `gapi estimate`: the states of a model from measurements, its parameters given.

use super::options::Global;
use super::session;
use crate::diag::{Diagnostic, Fault};
use crate::fault;
use crate::plot::{self, Axis, Figure, Mark, Panel};
use crate::registry::BAD_OPTION;
use crate::results::{self, ResultTable};
use crate::script::Session;
use crate::script::access::policy::Grant;
use crate::script::runs::problem::{EstimateOptions, Estimated, Shown, estimate};
use crate::source::Span;
use clap::{Args, ValueHint};
use gapilib_identify::significant;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Quantile 0.975 of the normal distribution.
const QUANTILE: f64 = 1.959_963_984_540_054;

/// Arguments of `gapi estimate`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  gapi estimate house.toml --values results/house/result.json --output states.csv
  gapi estimate house.toml --figure states.svg
  gapi estimate house.toml --steps 4 --every 900 --until 432000 --output forecast.csv

The problem has process noise, `[noise]`. Its states are estimated by an extended Kalman filter, each
from the measurements up to its time, and smoothed: from all measurements. Parameters that the problem
leaves free have the values of --values, or those where they start (`start`).

There is a row for each row of the data, also where outputs were not measured.

Exit code: 0 if the states were estimated, 1 on an error, 2 for an invalid command line.")]
pub(super) struct EstimateArgs {
    /// The problem file (.toml)
    #[arg(value_hint = ValueHint::FilePath)]
    pub problem: PathBuf,
    /// The result of a fit, `result.json` in the folder of `gapi identify`, with values of parameters
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub values: Option<PathBuf>,
    /// The experiment, where the problem has several
    #[arg(long, value_name = "NAME")]
    pub experiment: Option<String>,
    /// Predict outputs over N samples as well, each from the state at the sample N before
    #[arg(long, value_name = "N")]
    pub steps: Option<usize>,
    /// Add rows at equal distances, in seconds
    #[arg(long, value_name = "SECONDS")]
    pub every: Option<f64>,
    /// The last of them, also after the data, in seconds
    #[arg(long, value_name = "SECONDS")]
    pub until: Option<f64>,
    /// Write states, predictions and their standard deviations (.csv, .mat)
    #[arg(long, short, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub output: Option<PathBuf>,
    /// Draw states and predictions with their 95 % bands (.svg, .png, .pdf)
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub figure: Option<PathBuf>,
}

/// Estimates the states.
pub(super) fn states(arguments: &EstimateArgs, global: &Global) -> ExitCode {
    let mut session = match session::with_files(global, &[]) {
        Ok((session, _)) => session,
        Err(code) => return code,
    };
    session.world.grant_input(&arguments.problem);
    if let Some(values) = &arguments.values {
        session.world.grant(Grant::Read(values));
    }
    for file in [&arguments.output, &arguments.figure].into_iter().flatten() {
        session.world.grant(Grant::Named(file));
    }
    match run(&mut session, arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(errors) => session::failed(&mut session, errors),
    }
}

fn run(session: &mut Session, arguments: &EstimateArgs) -> Result<(), Vec<Diagnostic>> {
    let one = |fault: Fault| vec![fault.at(Span::NONE)];
    let EstimateArgs { steps, every, until, .. } = *arguments;
    let (values, experiment) = (arguments.values.as_deref(), arguments.experiment.as_deref());
    let options = EstimateOptions { values, experiment, steps, every, until };
    // What cannot be written is refused before the run.
    if let Some(path) = &arguments.output {
        results::format_of_file(&path.to_string_lossy()).map_err(one)?;
    }
    if let Some(path) = &arguments.figure {
        plot::Picture::of(path).map_err(one)?;
    }
    let found = estimate(session, &arguments.problem, &options)?;
    let own = |file: &PathBuf| session.world.absolute(file);
    let read: Vec<PathBuf> = found.read.iter().map(own).collect();
    let written = [&arguments.output, &arguments.figure].into_iter().flatten();
    if let Some(path) = written.into_iter().find(|path| read.contains(&own(path))) {
        let fault = fault!(BAD_OPTION, "`{}` is read by this command", path.display());
        return Err(one(fault.help("write the states to another file")));
    }
    session.print(&last_values(&found));
    if let Some(path) = &arguments.output {
        write(session, path, &found.table).map_err(one)?;
    }
    if let Some(path) = &arguments.figure {
        draw(session, path, &found).map_err(one)?;
    }
    Ok(())
}

/// The states at the last row, and how likely the measurements are.
fn last_values(found: &Estimated) -> String {
    let last = |name: &str| {
        let values = found.table.column(name).unwrap_or_default();
        values.last().copied().unwrap_or(f64::NAN)
    };
    let (count, last_sample) = found.samples;
    let mut text = format!(
        "{}: {count} samples, -log L = {}\n",
        found.experiment,
        significant(found.negative_log_likelihood, 7)
    );
    if let Some(time) = found.table.time.last() {
        text += &format!("states at {time} s, with their standard deviations:\n");
        if *time > last_sample {
            text += &format!("  (the last measurement is that at {last_sample} s)\n");
        }
    }
    for own in found.shown.iter().filter(|own| own.measured.is_none()) {
        let [name, sd] = &own.value;
        let unit = unit_of(&found.table, name);
        let (value, sd) = (significant(last(name), 6), significant(last(sd), 3));
        text += format!("  {name} = {value} ± {sd} {unit}").trim_end();
        text.push('\n');
    }
    text
}

fn unit_of<'t>(table: &'t ResultTable, name: &str) -> &'t str {
    table.series.iter().find(|own| own.name == name).map_or("", |own| own.unit.as_str())
}

fn write(session: &mut Session, path: &Path, table: &ResultTable) -> Result<(), Fault> {
    let format = results::format_of_file(&path.to_string_lossy())?;
    session.world.permit_file(path);
    session.world.write_results(path, format.as_ref(), table)?;
    session.print(&format!("written to {}\n", path.display()));
    Ok(())
}

/// A panel for each state and each output.
fn draw(session: &mut Session, path: &Path, found: &Estimated) -> Result<(), Fault> {
    let picture = plot::Picture::of(path)?;
    let panels = found.shown.iter().map(|own| panel(&found.table, own));
    let figure =
        Figure { title: found.experiment.clone(), panels: panels.collect::<Result<_, _>>()? };
    session.world.permit_file(path);
    session.world.write_file(path, &figure.picture(picture)?)?;
    session.print(&format!("figure: {}\n", path.display()));
    Ok(())
}

fn panel(table: &ResultTable, own: &Shown) -> Result<Panel, Fault> {
    let mut all = band(table, &own.value, ("95 % band", "filtered", 1))?;
    if let Some(smoothed) = &own.smoothed {
        all.extend(band(table, smoothed, ("95 % band, smoothed", "smoothed", 3))?);
    }
    if own.measured.is_some() {
        "predicted".clone_into(&mut all[1].name);
    }
    for (number, name) in own.predicted.iter().enumerate() {
        let (x, y) = known(table, name)?;
        let title = name.split('(').next().unwrap_or_default();
        all.push(series(title, x, y, Mark::Dashed, 2 + 2 * number));
    }
    if let Some(measured) = &own.measured {
        let (x, y) = known(table, measured)?;
        all.push(series("measured", x, y, Mark::Dots, 0));
    }
    let [name, _] = &own.value;
    let title = name.strip_prefix("predicted(").and_then(|name| name.strip_suffix(')'));
    Ok(Panel {
        x: Axis::linear("time", "s"),
        y: Axis::linear(title.unwrap_or(name), unit_of(table, name)),
        height: 150.0,
        zero_line: false,
        series: all,
    })
}

/// A line with its 95 % band.
fn band(
    table: &ResultTable,
    [value, sd]: &[String; 2],
    (title, line, colour): (&str, &str, usize),
) -> Result<Vec<plot::Series>, Fault> {
    let ((x, y), (_, sd)) = (known(table, value)?, known(table, sd)?);
    let edge = |side: f64| (0..x.len()).map(move |at| (at, side));
    let edges = || edge(QUANTILE).chain(edge(-QUANTILE).rev());
    let around = edges().map(|(at, side)| side.mul_add(sd[at], y[at])).collect();
    let places = edges().map(|(at, _)| x[at]).collect();
    Ok(vec![
        series(title, places, around, Mark::Area, colour),
        series(line, x.clone(), y, Mark::Line, colour),
    ])
}

/// The values of a column and their times, where it has some.
fn known(table: &ResultTable, name: &str) -> Result<(Vec<f64>, Vec<f64>), Fault> {
    let values = table.column(name)?;
    let pairs = table.time.iter().copied().zip(values);
    Ok(pairs.filter(|(_, value)| value.is_finite()).unzip())
}

fn series(name: &str, x: Vec<f64>, y: Vec<f64>, mark: Mark, colour: usize) -> plot::Series {
    plot::Series { name: name.to_owned(), x, y, mark, colour }
}
