//! `gapi simulate`: one simulation of one model.

use super::args::{Global, SimulateArgs};
use super::session;
use crate::diag::{Diagnostic, Fault};
use crate::results::{self, ResultTable};
use crate::script::Session;
use crate::script::simulation::{self, Simulated, Wishes};
use crate::source::Span;
use std::path::Path;
use std::process::ExitCode;

/// Most variables whose last values are shown when no file is asked for.
const SHOWN: usize = 30;

/// Simulates and writes the trajectories, or shows the last values.
pub(super) fn simulate(arguments: &SimulateArgs, global: &Global) -> ExitCode {
    let mut session = match session::with_files(global, &arguments.files) {
        Ok((session, _)) => session,
        Err(code) => return code,
    };
    match run(&mut session, arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(errors) => session::failed(&mut session, errors),
    }
}

fn run(session: &mut Session, arguments: &SimulateArgs) -> Result<(), Vec<Diagnostic>> {
    let one = |fault: Fault| vec![fault.at(Span::NONE)];
    let format = match &arguments.output {
        Some(path) => Some(results::format_of_file(&path.to_string_lossy()).map_err(one)?),
        None => None,
    };
    let model = simulation::translate(session, &arguments.model)?;
    for (name, value) in &arguments.set {
        session.set_parameter(name, *value).map_err(one)?;
    }
    let simulated =
        simulation::simulate(session, &model, &wishes(arguments)).map_err(|error| vec![error])?;
    session.print(&summary(&arguments.model, &simulated));
    match (&arguments.output, format) {
        (Some(path), Some(format)) => {
            let bytes = format.write(&simulated.table).map_err(one)?;
            session.write_file(path, &bytes).map_err(one)?;
            session.print(&written(path));
        }
        _ => session.print(&last_values(&simulated.table).map_err(one)?),
    }
    Ok(())
}

fn wishes(arguments: &SimulateArgs) -> Wishes {
    Wishes {
        start: arguments.start_time,
        stop: arguments.stop_time,
        intervals: arguments.intervals.map(|n| n as usize),
        tolerance: arguments.tolerance,
        method: arguments.method.clone(),
        ..Wishes::default()
    }
}

fn summary(model: &str, simulated: &Simulated) -> String {
    let time = &simulated.table.time;
    let (first, last) = (time.first().unwrap_or(&0.0), time.last().unwrap_or(&0.0));
    let s = &simulated.statistics;
    format!(
        "{model}: {first} s to {last} s, {} points, {} steps ({} rejected), {} right-hand sides, \
         {} Jacobians, {} events\n",
        time.len(),
        s.steps,
        s.error_failures + s.newton_failures,
        s.rhs_evaluations,
        s.jacobian_evaluations,
        s.state_events + s.time_events
    )
}

fn written(path: &Path) -> String {
    format!("trajectories: {}\n", path.display())
}

fn last_values(table: &ResultTable) -> Result<String, Fault> {
    let mut text = String::new();
    for series in table.series.iter().take(SHOWN) {
        let value = table.column(&series.name)?.last().copied().unwrap_or(f64::NAN);
        let unit = if series.unit.is_empty() { "" } else { &series.unit };
        text.push_str(&format!("  {} = {value} {unit}", series.name));
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
