//! `gapi simulate`: one simulation of one model.

mod imported;

use super::effort;
use super::numbers::number;
use super::options::{Global, Limits};
use super::terminal::Terminal;
use super::{limits, session};
use crate::diag::suggest::counted;
use crate::diag::{Diagnostic, Fault};
use crate::fault;
use crate::plot::{self, Axis, Figure, Mark, Panel};
use crate::registry::BAD_OPTION;
use crate::results::{self, ResultTable};
use crate::script::Session;
use crate::script::access::policy::Grant;
use crate::script::models::final_state::FinalState;
use crate::script::models::simulation::{Simulated, SimulationOptions, Translated, Unfinished};
use crate::script::models::{parameter_sets, simulation};
use crate::script::runs::problem;
use crate::script::runs::view::Progress;
use crate::script::world::Screen as _;
use crate::sim::Statistics;
use crate::source::Span;
use clap::{Args, ValueHint};
use regex::{Regex, RegexBuilder};
use std::path::Path;
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, mpsc};
use std::time::{Duration, Instant};

/// Arguments of `gapi simulate`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  gapi simulate models --model CaseStudies.PolarizationCurve --output curve.csv
  gapi simulate Decay.mo --model Decay --stop-time 5 --intervals 50 --set k=2
  gapi simulate Decay.mo --model Decay --stats --plot x --figure x.svg
  gapi simulate Tank.mo --input measured.csv --output tank.csv
  gapi simulate Decay.mo --model Decay --from first.mat --stop-time 10 --output second.mat
  gapi simulate Decay.mo --model Decay --dump eliminate_aliases
  gapi simulate Pump.fmu --allow-external=Pump.fmu --set k=2 --output pump.csv

Defaults come from the model's experiment annotation.

Exit code: 0 on success, 1 on an error, 2 for an invalid command line, 130 if interrupted.")]
pub(super) struct SimulateArgs {
    /// Modelica files or package folders, and the class; files that can be found by
    /// class name can be omitted. Or a functional mock-up unit (FMU)
    #[arg(required_unless_present = "model", value_name = "FILE|CLASS", value_hint = ValueHint::AnyPath)]
    pub files: Vec<PathBuf>,
    /// The class to simulate, optionally with a modification: 'M(p = 2)'
    #[arg(long, value_name = "CLASS")]
    pub model: Option<String>,
    /// Start of the simulation in seconds
    #[arg(long, value_name = "T", allow_negative_numbers = true, value_parser = number)]
    pub start_time: Option<f64>,
    /// End of the simulation in seconds
    #[arg(long, value_name = "T", allow_negative_numbers = true, value_parser = number)]
    pub stop_time: Option<f64>,
    /// Number of output intervals
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub intervals: Option<u32>,
    /// Relative tolerance
    #[arg(long, value_name = "E", value_parser = number)]
    pub tolerance: Option<f64>,
    /// Integration method; `co-simulation` for that of an FMU itself
    #[arg(long, value_name = "M")]
    pub method: Option<String>,
    /// Set a parameter (repeatable): a number, true, false, a literal of an enumeration, or a String
    #[arg(long = "set", value_name = "NAME=VALUE", value_parser = name_and_value)]
    pub set: Vec<(String, String)>,
    /// Set the parameters of a file of SSP, as `gapi identify` writes it; --set comes after it
    #[arg(long, value_name = "FILE.ssv", value_hint = ValueHint::FilePath)]
    pub set_file: Option<PathBuf>,
    /// Let the inputs of the model follow the columns of this file that have their names; it has a
    /// column `time` or `t`
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub input: Option<PathBuf>,
    /// Between the rows of --input, hold each value or interpolate linearly [default: as they look]
    #[arg(long, value_name = "KIND", value_parser = ["hold", "linear"], requires = "input")]
    pub interpolation: Option<String>,
    /// Start from the states and parameters at the end of these results, or at --start-time
    #[arg(long, value_name = "FILE.mat|.csv", value_hint = ValueHint::FilePath)]
    pub from: Option<PathBuf>,
    /// Output file of the trajectories; the extension selects the format
    #[arg(long, short, value_name = "FILE.mat|.csv", value_hint = ValueHint::FilePath)]
    pub output: Option<PathBuf>,
    /// Store only the variables whose complete names match this regular expression
    #[arg(long, value_name = "REGEX")]
    pub(crate) variable_filter: Option<String>,
    /// Print the system after a compiler pass instead of simulating it
    #[arg(long, value_name = "PASS", value_parser = pass_names())]
    pub dump: Option<String>,
    /// Print statistics of the simulation and what it spent its effort on: the variables that limit its
    /// steps, the relations that cause its events, its algebraic loops
    #[arg(long)]
    pub stats: bool,
    /// Stop at chattering and Zeno behaviour, instead of continuing in sliding mode or at rest
    #[arg(long)]
    pub(crate) no_sliding: bool,
    /// Plot a variable over time, in the terminal or to --figure (repeatable)
    #[arg(long, value_name = "VARIABLE")]
    pub plot: Vec<String>,
    /// Output file of --plot, with extension .svg, .png or .pdf
    #[arg(long, value_name = "FILE", requires = "plot", value_hint = ValueHint::FilePath)]
    pub figure: Option<PathBuf>,
    /// Limits
    #[command(flatten)]
    pub limits: Limits,
}

/// The passes whose system can be shown, the flat model as the first.
fn pass_names() -> clap::builder::PossibleValuesParser {
    let value = |name, what| clap::builder::PossibleValue::new(name).help(what);
    let passes =
        crate::script::models::simulation::PASSES.iter().map(|pass| value(pass.name, pass.what));
    std::iter::once(value("flatten", "the flat model")).chain(passes).collect::<Vec<_>>().into()
}

pub(super) fn name_and_value(text: &str) -> Result<(String, String), String> {
    let (name, value) = text.split_once('=').ok_or("expected NAME=VALUE")?;
    Ok((name.trim().to_owned(), value.trim().to_owned()))
}

/// Gives parameters the values that the options say.
fn set(session: &mut Session, arguments: &SimulateArgs) -> Result<(), Fault> {
    if let Some(path) = &arguments.set_file {
        parameter_sets::set(session, path)?;
    }
    let mut values = arguments.set.iter();
    values.try_for_each(|(name, value)| session.set_parameter_text(name, value))
}

/// Most variables whose last values are shown when no file is asked for.
const SHOWN: usize = 30;

/// Size of a drawing in the terminal, characters and lines.
const CHART: (usize, usize) = (64, 12);

/// Time between two drawings of the progress bar.
const REDRAWN: Duration = Duration::from_millis(100);

/// Simulates and writes the trajectories, or shows the last values.
pub(super) fn simulate(arguments: &SimulateArgs, global: &Global) -> ExitCode {
    simulate_until_stopped(arguments, global).unwrap_or_else(|code| code)
}

/// One that is stopped, by the user or by a limit, shows and writes what it has.
fn simulate_until_stopped(arguments: &SimulateArgs, global: &Global) -> Result<ExitCode, ExitCode> {
    let started = Instant::now();
    let world = session::world(global)?;
    world.catch_interrupts();
    let _watch = limits::watch(&arguments.limits, started, world.stopping())?;
    let _unheard = limits::end_unheard(world.stopping());
    let unit = imported::unit_of(&arguments.files);
    let (mut session, class) = match unit {
        Some(_) => (session::with_files_in(world, global, &[])?.0, String::new()),
        None => session::with_class(world, global, arguments.model.as_ref(), &arguments.files)?,
    };
    for file in [&arguments.output, &arguments.figure].into_iter().flatten() {
        session.world.grant(Grant::Named(file));
    }
    let read = [&arguments.from, &arguments.input, &arguments.set_file];
    for file in read.into_iter().flatten().map(PathBuf::as_path).chain(unit) {
        session.world.grant(Grant::Read(file));
    }
    if session::lists_permissions(&mut session, global) {
        return Ok(ExitCode::SUCCESS);
    }
    let done = match unit {
        Some(path) => imported::run(&mut session, path, arguments, global),
        None => run(&mut session, &class, arguments, global),
    };
    Ok(match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(_) if session.is_interrupted() => session::stopped(&mut session),
        Err(errors) => session::failed(&mut session, errors),
    })
}

fn run(
    session: &mut Session,
    class: &str,
    arguments: &SimulateArgs,
    global: &Global,
) -> Result<(), Vec<Diagnostic>> {
    let one = |fault: Fault| vec![fault.at(Span::NONE)];
    let format = match &arguments.output {
        Some(path) => Some(results::format_of_file(&path.to_string_lossy()).map_err(one)?),
        None => None,
    };
    let picture = arguments.figure.as_deref().map(plot::Picture::of).transpose().map_err(one)?;
    if let Some(pass) = &arguments.dump {
        let text = simulation::dump(session, class, pass)?;
        session.print(&text);
        return Ok(());
    }
    let filter = arguments.variable_filter.as_deref().map(filter).transpose().map_err(one)?;
    let mut options = SimulationOptions { only: filter, ..options(arguments) };
    let input = arguments.input.as_deref();
    let interpolation = arguments.interpolation.as_deref();
    let driven = input.map(|path| problem::driven(session, class, path, interpolation));
    let driven = driven.transpose()?;
    let translated = driven.as_ref().map_or(class, |driven| driven.class.as_str());
    let model = simulation::translate(session, translated)?;
    options.takes_exact_steps = driven.is_some();
    let names = model.program.variables().iter().map(|variable| &*variable.name);
    check_filter(arguments, &options, names).map_err(one)?;
    if let Some(driven) = &driven
        && model.program.experiment().stop_time.is_none()
    {
        options.stop.get_or_insert(driven.last);
    }
    if let Some(path) = &arguments.from {
        let begin = begin_with(session, &model, path, options.start).map_err(one)?;
        options.start = Some(begin);
    }
    set(session, arguments).map_err(one)?;
    let settings = simulation::settings(&model.program.experiment(), &options).map_err(one)?;
    let span = (settings.start, settings.stop);
    if let Some(driven) = &driven {
        driven.note_outside(session, span);
    }
    let simulated = with_progress(span, options, global, |options| {
        simulation::simulate(session, &model, &options)
    });
    if arguments.from.is_none() && simulated.as_ref().err().is_none_or(|own| own.until.is_some()) {
        session.note_default_starts(&model);
    }
    outcome(session, class, (arguments, picture, format), simulated)
}

/// How a simulation is to be shown.
type Show<'a> = (&'a SimulateArgs, Option<plot::Picture>, Option<Box<dyn results::Format>>);

/// Shows a simulation. What was computed until a failure is shown as a whole simulation is: it says the most
/// about it.
fn outcome(
    session: &mut Session,
    name: &str,
    how: Show<'_>,
    simulated: Result<Simulated, Unfinished>,
) -> Result<(), Vec<Diagnostic>> {
    let (simulated, why) = match simulated {
        Ok(simulated) => (simulated, None),
        Err(Unfinished { why, until: Some(until) }) => (*until, Some(why)),
        Err(Unfinished { why, until: None }) => return Err(vec![why]),
    };
    let shown = show(session, name, how, simulated);
    let errors = why.into_iter().chain(shown.err().map(|fault| fault.at(Span::NONE)));
    let errors: Vec<Diagnostic> = errors.collect();
    if errors.is_empty() { Ok(()) } else { Err(errors) }
}

/// Shows and writes what the options ask for.
fn show(
    session: &mut Session,
    name: &str,
    (arguments, picture, format): Show<'_>,
    mut simulated: Simulated,
) -> Result<(), Fault> {
    problem::Driven::without_own_inputs(&mut simulated.table);
    session.print(&summary(name, &simulated));
    if arguments.stats {
        session.print(&statistics(&simulated.statistics));
        session.print(&simulated.hardest.as_ref().map(effort::table).unwrap_or_default());
    }
    if !arguments.plot.is_empty() {
        draw(session, name, (arguments, picture), &simulated.table)?;
    }
    write_or_show(session, arguments, format, &simulated.table)
}

/// Writes the results to the file that is asked for, or shows the last values.
fn write_or_show(
    session: &mut Session,
    arguments: &SimulateArgs,
    format: Option<Box<dyn results::Format>>,
    table: &ResultTable,
) -> Result<(), Fault> {
    match (&arguments.output, format) {
        (Some(path), Some(format)) => {
            session.world.permit_file(path);
            session.world.write_results(path, format.as_ref(), table)?;
            session.print(&written(path));
        }
        _ if !arguments.plot.is_empty() => {}
        _ => session.print(&last_values(table)?),
    }
    Ok(())
}

/// Matches whole names.
fn filter(expression: &str) -> Result<Regex, Fault> {
    let whole = format!("^(?:{expression})$");
    RegexBuilder::new(&whole).size_limit(1 << 20).build().map_err(|_| {
        fault!(BAD_OPTION, "`--variable-filter` is not a valid regular expression: `{expression}`")
    })
}

/// Refuses a filter that leaves nothing but the time.
fn check_filter<'n>(
    arguments: &SimulateArgs,
    options: &SimulationOptions,
    mut names: impl Iterator<Item = &'n str>,
) -> Result<(), Fault> {
    let (Some(expression), Some(filter)) = (&arguments.variable_filter, &options.only) else {
        return Ok(());
    };
    if names.any(|name| filter.is_match(name)) {
        return Ok(());
    }
    let glob = expression.contains('*') && !expression.contains(".*");
    let help = glob.then(|| {
        format!(
            "it is a regular expression for whole names: write `{}`",
            expression.replace('*', ".*")
        )
    });
    Err(fault!(BAD_OPTION, "no variable matches `{expression}`").help_if(help))
}

/// Takes states and parameters from results; the time that they are of.
fn begin_with(
    session: &mut Session,
    model: &Translated,
    path: &Path,
    time: Option<f64>,
) -> Result<f64, Fault> {
    let bytes = session.world.read_bytes(path)?;
    let table = results::format_of_file(&path.to_string_lossy())?.read(&bytes)?;
    let last = || table.time.last().copied().unwrap_or(0.0);
    let time = time.unwrap_or_else(last);
    let state = FinalState::in_result(model, &table, time)?;
    session.continue_from(&state, &path.to_string_lossy())?;
    Ok(time)
}

/// Simulates beside a thread that shows how far it is, by simulated time.
fn with_progress<T>(
    (start, stop): (f64, f64),
    options: SimulationOptions,
    global: &Global,
    simulate: impl FnOnce(SimulationOptions) -> T,
) -> T {
    let reached = Arc::new(AtomicU64::new(start.to_bits()));
    let options = SimulationOptions { reached: Some(reached.clone()), ..options };
    let (stopped, is_stopped) = mpsc::channel::<()>();
    std::thread::scope(|scope| {
        scope.spawn(move || {
            let mut terminal = Terminal::new(global.color, false);
            while is_stopped.recv_timeout(REDRAWN) == Err(mpsc::RecvTimeoutError::Timeout) {
                let share =
                    (f64::from_bits(reached.load(Ordering::Relaxed)) - start) / (stop - start);
                terminal.progress(&Progress {
                    label: "simulating".to_owned(),
                    // Never all of it: what is written after the last point takes time as well.
                    done: (share * 1000.0).clamp(0.0, 999.0) as u64,
                    total: 1000,
                    ..Progress::default()
                });
            }
            terminal.finish_progress();
        });
        let simulated = simulate(options);
        drop(stopped);
        simulated
    })
}

fn options(arguments: &SimulateArgs) -> SimulationOptions {
    SimulationOptions {
        start: arguments.start_time,
        stop: arguments.stop_time,
        intervals: arguments.intervals.map(i64::from),
        tolerance: arguments.tolerance,
        method: arguments.method.clone(),
        stops_at_chattering: arguments.no_sliding,
        counts_effort: arguments.stats,
        ..SimulationOptions::default()
    }
}

fn summary(model: &str, simulated: &Simulated) -> String {
    let time = &simulated.table.time;
    let (first, last) = (time.first().unwrap_or(&0.0), time.last().unwrap_or(&0.0));
    let s = &simulated.statistics;
    format!(
        "{model}: {first} s to {last} s, {}, {} ({} rejected), {}, {}, {}\n",
        counted(time.len() as u64, "point"),
        counted(s.steps, "step"),
        s.error_failures + s.newton_failures,
        counted(s.rhs_evaluations, "right-hand side evaluation"),
        counted(s.jacobian_evaluations, "Jacobian"),
        counted(s.state_events + s.time_events, "event")
    )
}

fn statistics(s: &Statistics) -> String {
    let rows = [
        ("accepted steps", s.steps),
        ("steps rejected by the error test", s.error_failures),
        ("steps rejected by the corrector", s.newton_failures),
        ("right-hand side evaluations", s.rhs_evaluations),
        ("Jacobians", s.jacobian_evaluations),
        ("factorizations", s.factorizations),
        ("state events", s.state_events),
        ("time events", s.time_events),
        ("events without a restart", s.continued),
        ("chattering relations", s.followed),
        ("sliding modes", s.slides),
        ("accumulations of impacts (Zeno)", s.accumulations),
    ];
    let explicit = ("of these explicit, as not stiff", s.explicit_steps);
    let exact = ("of these with the exact solution", s.exact_steps);
    let special = [exact, explicit].into_iter().filter(|(_, count)| *count > 0);
    let special: Vec<_> = special.collect();
    let (first, others) = rows.split_at(1);
    let rows = first.iter().chain(&special).chain(others);
    rows.map(|(name, count)| format!("  {name:34}{count:>10}\n")).collect()
}

/// Draws variables over time, one panel each.
fn draw(
    session: &mut Session,
    class: &str,
    (arguments, picture): (&SimulateArgs, Option<plot::Picture>),
    table: &ResultTable,
) -> Result<(), Fault> {
    let panels = arguments.plot.iter().map(|name| panel(table, name));
    let name = class.split('(').next().unwrap_or_default().rsplit('.').next().unwrap_or(class);
    let figure = Figure { title: name.to_owned(), panels: panels.collect::<Result<_, _>>()? };
    match arguments.figure.as_ref().zip(picture) {
        Some((path, format)) => {
            session.world.permit_file(path);
            session.world.write_file(path, &figure.picture(format)?)?;
            session.print(&format!("figure: {}\n", path.display()));
        }
        None => session.print(&figure.text(CHART.0, CHART.1)),
    }
    Ok(())
}

fn panel(table: &ResultTable, name: &str) -> Result<Panel, Fault> {
    let y = table.column(name)?;
    let known = table.series.iter().find(|series| series.name == name);
    let (description, unit) = known.map_or(("", ""), |own| (&own.description, &own.unit));
    let axis = Axis::of_variable(name, description, unit);
    let line = plot::Series {
        // An axis with the name needs no legend.
        name: if axis.label == name { String::new() } else { name.to_owned() },
        x: table.time.clone(),
        y,
        mark: Mark::Line,
        colour: 0,
    };
    Ok(Panel {
        x: Axis::linear("time", "s"),
        y: axis,
        height: 200.0,
        zero_line: false,
        series: vec![line],
    })
}

fn written(path: &Path) -> String {
    format!("trajectories: {}\n", path.display())
}

fn last_values(table: &ResultTable) -> Result<String, Fault> {
    let mut text = String::new();
    for series in table.series.iter().take(SHOWN) {
        let value = table.column(&series.name)?.last().copied().unwrap_or(f64::NAN);
        let unit = if series.unit.is_empty() { "" } else { &series.unit };
        text.push_str(&format!("  {} = {} {unit}", series.name, in_figures(value)));
        text.truncate(text.trim_end().len());
        text.push('\n');
    }
    if table.series.len() > SHOWN {
        text.push_str(&format!(
            "  … {} more; `--output FILE` writes all\n",
            table.series.len() - SHOWN
        ));
    }
    Ok(text)
}

/// A number without hundreds of zeros: limits of bounds are as large as 1e300.
fn in_figures(value: f64) -> String {
    let is_long = value.is_finite() && value.abs() >= 1e15;
    if is_long { format!("{value:e}") } else { value.to_string() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn large_values_have_exponents() {
        assert_eq!(in_figures(-1e300), "-1e300");
        assert_eq!(in_figures(123456.5), "123456.5");
        assert_eq!(in_figures(f64::INFINITY), "inf");
    }

    #[test]
    fn settings_are_names_with_values() {
        assert_eq!(name_and_value("a.b = -1e3"), Ok(("a.b".to_owned(), "-1e3".to_owned())));
        assert_eq!(name_and_value("on=true"), Ok(("on".to_owned(), "true".to_owned())));
        assert!(name_and_value("a").is_err());
    }
}
