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
use crate::script::runs::problem::{Estimated, estimate};
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

The problem has process noise, `[noise]`. Its states are estimated by an extended Kalman filter, each
from the measurements up to its time. Parameters that the problem leaves free have the values of
--values, or those where they start (`start`).

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
    session.grant_input(&arguments.problem);
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
    let given = (arguments.values.as_deref(), arguments.experiment.as_deref());
    let found = estimate(session, &arguments.problem, given)?;
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

/// The states at the last sample, and how likely the measurements are.
fn last_values(found: &Estimated) -> String {
    let last = |name: &str| {
        let values = found.table.column(name).unwrap_or_default();
        values.into_iter().rev().find(|value| value.is_finite()).unwrap_or(f64::NAN)
    };
    let mut text = format!(
        "{}: {} samples, -log L = {}\n",
        found.experiment,
        found.table.time.len(),
        significant(found.negative_log_likelihood, 7)
    );
    if let Some(time) = found.table.time.last() {
        text += &format!("states at {time} s, with their standard deviations:\n");
    }
    for own in found.shown.iter().filter(|own| own[2].is_none()) {
        let [Some(name), Some(sd), _] = own else { continue };
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
    session.permit_file(path);
    session.write_results(path, format.as_ref(), table)?;
    session.print(&format!("written to {}\n", path.display()));
    Ok(())
}

/// A panel for each state and each output.
fn draw(session: &mut Session, path: &Path, found: &Estimated) -> Result<(), Fault> {
    let picture = plot::Picture::of(path)?;
    let panels = found.shown.iter().map(|own| panel(&found.table, own));
    let figure =
        Figure { title: found.experiment.clone(), panels: panels.collect::<Result<_, _>>()? };
    session.permit_file(path);
    session.write_file(path, &figure.picture(picture)?)?;
    session.print(&format!("figure: {}\n", path.display()));
    Ok(())
}

fn panel(table: &ResultTable, names: &[Option<String>; 3]) -> Result<Panel, Fault> {
    let [value, sd, measured] = names.each_ref().map(|name| name.as_deref().unwrap_or_default());
    let (y, sd) = (table.column(value)?, table.column(sd)?);
    let known: Vec<usize> = (0..y.len()).filter(|at| y[*at].is_finite()).collect();
    let of = |values: &[f64]| -> Vec<f64> { known.iter().map(|at| values[*at]).collect() };
    let edge = |side: f64| known.iter().map(move |at| (*at, side));
    let edges: Vec<(usize, f64)> = edge(QUANTILE).chain(edge(-QUANTILE).rev()).collect();
    let series = |name: &str, x: Vec<f64>, y: Vec<f64>, mark, colour| plot::Series {
        name: name.to_owned(),
        x,
        y,
        mark,
        colour,
    };
    let time = of(&table.time);
    let mut all = vec![
        series(
            "95 % band",
            edges.iter().map(|(at, _)| table.time[*at]).collect(),
            edges.iter().map(|(at, side)| side.mul_add(sd[*at], y[*at])).collect(),
            Mark::Area,
            1,
        ),
        series(value, time.clone(), of(&y), Mark::Line, 1),
    ];
    if names[2].is_some() {
        all.push(series("measured", time, of(&table.column(measured)?), Mark::Dots, 0));
    }
    let axis = Axis::linear(value, unit_of(table, value));
    Ok(Panel {
        x: Axis::linear("time", "s"),
        y: axis,
        height: 150.0,
        zero_line: false,
        series: all,
    })
}
