//! `gapi linearize`: poles, zeros and responses of a model about a point of its simulation.

use super::numbers::number;
use super::options::{Global, Limits};
use super::{limits, session};
use crate::diag::suggest::counted;
use crate::diag::{Diagnostic, Fault};
use crate::fault;
use crate::plot::{self, Picture, Responding};
use crate::registry::BAD_OPTION;
use crate::script::Session;
use crate::script::access::policy::Grant;
use crate::script::models::exported::translate;
use crate::script::models::linear::{Linear, Number, frequencies, responding};
use crate::script::models::linearization::linearized;
use crate::script::models::simulation::SimulationOptions;
use crate::source::Span;
use clap::{Args, ValueHint};
use gapilib_identify::significant;
use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Arguments of `gapi linearize`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  gapi linearize Motor.mo --model Motor
  gapi linearize Motor.mo --stop-time 5 --set J=0.02 --input u --output w
  gapi linearize Cell.mo --output cell.v --bode cell.svg --from 1e-3 --to 1e4
  gapi linearize Cell.mo --response cell.csv
  gapi linearize Motor.mo --matrices motor.mat        A, B, C and D as `linearizeModel` writes them

The model is simulated to --stop-time, by default only initialized, and linearized there: small
deviations of the inputs at the top level to those of the outputs.

Exit code: 0 on success, 1 on an error, 2 for an invalid command line.")]
pub(super) struct LinearizeArgs {
    /// Modelica files or package folders, and the class; files that can be found by
    /// class name can be omitted
    #[arg(required_unless_present = "model", value_name = "FILE|CLASS", value_hint = ValueHint::AnyPath)]
    pub files: Vec<PathBuf>,
    /// The class to linearize, optionally with a modification: 'M(p = 2)'
    #[arg(long, value_name = "CLASS")]
    pub model: Option<String>,
    /// An input (repeatable); all inputs at the top level if none is given
    #[arg(long, value_name = "NAME")]
    pub input: Vec<String>,
    /// An output (repeatable), any variable; all outputs at the top level if none is given
    #[arg(long, value_name = "NAME")]
    pub output: Vec<String>,
    /// Start of the simulation in seconds
    #[arg(long, value_name = "T", allow_negative_numbers = true, value_parser = number)]
    pub start_time: Option<f64>,
    /// Where it is linearized, in seconds; the start if it is not given
    #[arg(long, value_name = "T", allow_negative_numbers = true, value_parser = number)]
    pub stop_time: Option<f64>,
    /// Relative tolerance of the simulation
    #[arg(long, value_name = "TOL", value_parser = number)]
    pub tolerance: Option<f64>,
    /// Set a parameter (repeatable): a number, true, false, a literal of an enumeration, or a String
    #[arg(long = "set", value_name = "NAME=VALUE", value_parser = super::simulate::name_and_value)]
    pub set: Vec<(String, String)>,
    /// Picture of magnitude and phase over the frequency, with extension .svg, .png or .pdf
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub bode: Option<PathBuf>,
    /// Table of the responses over the frequency
    #[arg(long, value_name = "FILE.csv", value_hint = ValueHint::FilePath)]
    pub response: Option<PathBuf>,
    /// Lowest frequency in Hz; by default a tenth of that of the slowest pole
    #[arg(long, value_name = "HZ", value_parser = number)]
    pub from: Option<f64>,
    /// Highest frequency in Hz; by default ten times that of the fastest pole
    #[arg(long, value_name = "HZ", value_parser = number)]
    pub to: Option<f64>,
    /// Frequencies per decade
    #[arg(long, value_name = "N", default_value_t = 20, value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub per_decade: u32,
    /// File of the matrices, in the layout of `linearizeModel`
    #[arg(long, value_name = "FILE.mat", value_hint = ValueHint::FilePath)]
    pub matrices: Option<PathBuf>,
    /// Limits
    #[command(flatten)]
    pub limits: Limits,
}

/// Linearizes and shows what is asked for.
pub(super) fn linearize(arguments: &LinearizeArgs, global: &Global) -> ExitCode {
    let _watch = match limits::enforce(&arguments.limits) {
        Ok(watch) => watch,
        Err(code) => return code,
    };
    let opened = session::world(global).and_then(|world| {
        session::with_class(world, global, arguments.model.as_ref(), &arguments.files)
    });
    let (mut session, class) = match opened {
        Ok(opened) => opened,
        Err(code) => return code,
    };
    for file in [&arguments.bode, &arguments.response, &arguments.matrices].into_iter().flatten() {
        session.world.grant(Grant::Named(file));
    }
    if session::lists_permissions(&mut session, global) {
        return ExitCode::SUCCESS;
    }
    match run(&mut session, &class, arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(errors) => session::failed(&mut session, errors),
    }
}

fn run(
    session: &mut Session,
    class: &str,
    arguments: &LinearizeArgs,
) -> Result<(), Vec<Diagnostic>> {
    let one = |fault: Fault| vec![fault.at(Span::NONE)];
    let picture = arguments.bode.as_deref().map(Picture::of).transpose().map_err(one)?;
    translate(session, class)?;
    for (name, value) in &arguments.set {
        session.set_parameter_text(name, value).map_err(one)?;
    }
    let start = arguments.start_time;
    let stop = arguments.stop_time.or(start).or(Some(0.0));
    let tolerance = arguments.tolerance;
    let options = SimulationOptions { start, stop, tolerance, ..SimulationOptions::default() };
    let linear = linearized(session, &options, &arguments.output)?;
    let chosen = chosen(&linear, &arguments.input).map_err(one)?;
    let poles = linear.poles().ok_or_else(|| {
        one(fault!(
            BAD_OPTION,
            "the poles of `{class}` cannot be computed: its matrix A is not finite"
        ))
    })?;
    session.print(&text(class, &linear, &chosen, &poles));
    if let Some(path) = &arguments.matrices {
        let bytes = linear.to_mat().map_err(one)?;
        write(session, path, &bytes).map_err(one)?;
    }
    if picture.is_some() || arguments.response.is_some() {
        let ends = [arguments.from, arguments.to];
        let per_decade = f64::from(arguments.per_decade);
        let frequencies = frequencies(ends, per_decade, &poles).map_err(one)?;
        let responses = linear.responses_to(&chosen, &frequencies).map_err(one)?;
        if let (Some(path), Some(picture)) = (&arguments.bode, picture) {
            let figure = plot::bode(&frequencies, &shown(&responses));
            write(session, path, &figure.picture(picture).map_err(one)?).map_err(one)?;
        }
        if let Some(path) = &arguments.response {
            write(session, path, table(&frequencies, &responses).as_bytes()).map_err(one)?;
        }
    }
    Ok(())
}

fn write(session: &mut Session, path: &Path, bytes: &[u8]) -> Result<(), Fault> {
    session.world.permit_file(path);
    session.world.write_file(path, bytes)?;
    session.print(&format!("wrote {}\n", path.display()));
    Ok(())
}

/// The places of the inputs that are asked for.
fn chosen(linear: &Linear, inputs: &[String]) -> Result<Vec<usize>, Fault> {
    let [_, known, _] = &linear.names;
    if inputs.is_empty() {
        return Ok((0..known.len()).collect());
    }
    let place = |name: &String| {
        known.iter().position(|own| own == name).ok_or_else(|| {
            let all: Vec<&str> = known.iter().map(String::as_str).collect();
            let help = match all.as_slice() {
                [] => "declare one at the top level: `input Real u;`".to_owned(),
                all => format!("its inputs are {}", crate::diag::suggest::listed(all)),
            };
            fault!(BAD_OPTION, "`{name}` is not a continuous input of the model").help(help)
        })
    };
    let mut places: Vec<usize> = inputs.iter().map(place).collect::<Result<_, _>>()?;
    let mut seen = std::collections::BTreeSet::new();
    places.retain(|place| seen.insert(*place));
    Ok(places)
}

/// Poles, and zeros and static gains from each input to each output.
fn text(class: &str, linear: &Linear, inputs: &[usize], poles: &[Number]) -> String {
    let [states, names, outputs] = &linear.names;
    let mut text = format!(
        "{class}: {}, {}, {}\n",
        counted(states.len() as u64, "state"),
        counted(inputs.len() as u64, "input"),
        counted(outputs.len() as u64, "output")
    );
    roots(&mut text, "poles", poles);
    for &input in inputs {
        for (place, output) in outputs.iter().enumerate() {
            let name = format!("{output}/{}", names[input]);
            match linear.zeros((place, input)) {
                Some(zeros) => roots(&mut text, &format!("zeros of {name}"), &zeros),
                None => _ = writeln!(text, "\n{output} does not depend on {}", names[input]),
            }
            if let Some(gain) = linear.gain((place, input)) {
                _ = writeln!(text, "static gain of {name}: {}", significant(gain, 6));
            }
        }
    }
    text
}

/// A table of poles or zeros, of which conjugate pairs share a line.
fn roots(text: &mut String, title: &str, roots: &[Number]) {
    if roots.is_empty() {
        _ = writeln!(text, "\n{title}: none");
        return;
    }
    _ = writeln!(
        text,
        "\n{title:<30} {:>12} {:>10} {:>14}",
        "frequency Hz", "damping", "time const. s"
    );
    for root in roots.iter().filter(|root| root.im >= 0.0) {
        let size = root.norm_sqr().sqrt();
        let value = match root.im {
            0.0 => significant(root.re, 6),
            im => format!("{} ± {}i", significant(root.re, 6), significant(im, 6)),
        };
        let [frequency, damping] = match root.im {
            0.0 => [String::new(), String::new()],
            _ => [significant(size / TAU, 5), significant(0.0 - root.re / size, 4)],
        };
        let constant = match root.im == 0.0 && root.re != 0.0 {
            true => significant(-1.0 / root.re, 5),
            false => String::new(),
        };
        let line = format!("  {value:<28} {frequency:>12} {damping:>10} {constant:>14}");
        _ = writeln!(text, "{}", line.trim_end());
    }
}

/// Magnitudes and phases.
fn shown(responses: &[(String, Vec<Number>)]) -> Vec<Responding> {
    responses.iter().map(|(name, values)| responding(name, values)).collect()
}

/// A table: the frequency, and of each response real and imaginary part, magnitude and phase.
fn table(frequencies: &[f64], responses: &[(String, Vec<Number>)]) -> String {
    let mut text = "frequency [Hz]".to_owned();
    for (name, _) in responses {
        _ = write!(text, ",{name} real,{name} imaginary,{name} magnitude [dB],{name} phase [deg]");
    }
    text.push('\n');
    let shown = shown(responses);
    for (k, frequency) in frequencies.iter().enumerate() {
        text += &frequency.to_string();
        for ((_, values), shown) in responses.iter().zip(&shown) {
            let value = values[k];
            let [magnitude, phase] = [shown.magnitudes[k], shown.phases[k]];
            _ = write!(text, ",{},{},{magnitude},{phase}", value.re, value.im);
        }
        text.push('\n');
    }
    text
}
