//! `gapi export-fmu`: a model as a functional mock-up unit.

use super::options::{Global, Limits};
use super::{limits, session};
use crate::diag::{Diagnostic, Fault};
use crate::script::Session;
use crate::script::access::policy::Grant;
use crate::script::models::exported::{Form, exported, translate};
use crate::script::models::parameter_sets;
use crate::source::Span;
use clap::{Args, ValueEnum, ValueHint};
use gapilib_fmi::description::Version;
use gapilib_fmi::export::Kinds;
use gapilib_fmi::parameter_set;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Arguments of `gapi export-fmu`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  gapi export-fmu Tank.mo --model Tank
  gapi export-fmu models --model CaseStudies.PolarizationCurve --fmi 2 --kind cs -o curve.fmu
  gapi export-fmu Decay.mo --model Decay --set k=2.31
  gapi export-fmu Decay.mo --model Decay --set-file results/parameters.ssv     with the values of a fit

The unit runs on the platform of this program and needs neither it nor a C compiler.

Exit code: 0 on success, 1 on an error, 2 for an invalid command line.")]
pub(super) struct ExportFmuArgs {
    /// Modelica files or package folders, and the class; files that can be found by
    /// class name can be omitted
    #[arg(required_unless_present = "model", value_name = "FILE|CLASS", value_hint = ValueHint::AnyPath)]
    pub files: Vec<PathBuf>,
    /// The class to export, optionally with a modification: 'M(p = 2)'
    #[arg(long, value_name = "CLASS")]
    pub model: Option<String>,
    /// Version of the standard: 3 (FMI 3.0) or 2 (FMI 2.0)
    #[arg(long, value_name = "VERSION", default_value_t = 3, value_parser = clap::value_parser!(u8).range(2..=3))]
    pub fmi: u8,
    /// Who integrates: the importer, the unit, or either
    #[arg(long, value_name = "KIND", value_enum, default_value_t = Kind::Both)]
    pub kind: Kind,
    /// Set a parameter (repeatable): a number, true, false, a literal of an enumeration, or a String
    #[arg(long = "set", value_name = "NAME=VALUE", value_parser = super::simulate::name_and_value)]
    pub set: Vec<(String, String)>,
    /// Set the parameters of a file of SSP, as `gapi identify` writes it, and write a copy of it beside
    /// the unit, with the values of --set, which comes after it
    #[arg(long, value_name = "FILE.ssv", value_hint = ValueHint::FilePath)]
    pub set_file: Option<PathBuf>,
    /// Output file; the last part of the class's name with the extension .fmu if none is given
    #[arg(long, short, value_name = "FILE.fmu", value_hint = ValueHint::FilePath)]
    pub output: Option<PathBuf>,
    /// Limits
    #[command(flatten)]
    pub limits: Limits,
}

/// What a unit offers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum Kind {
    /// Model exchange: the importer integrates
    Me,
    /// Co-simulation: the unit integrates
    Cs,
    /// Either
    Both,
}

/// Writes the unit.
pub(super) fn export_fmu(arguments: &ExportFmuArgs, global: &Global) -> ExitCode {
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
    let output = arguments.output.clone().unwrap_or_else(|| {
        let name = class.split('(').next().unwrap_or(&class).trim();
        PathBuf::from(format!("{}.fmu", name.rsplit('.').next().unwrap_or(name)))
    });
    session.world.grant(Grant::Named(&output));
    if let Some(file) = &arguments.set_file {
        session.world.grant(Grant::Read(file));
        session.world.grant(Grant::Named(&beside(&output)));
    }
    if session::lists_permissions(&mut session, global) {
        return ExitCode::SUCCESS;
    }
    match run(&mut session, &class, arguments, &output) {
        Ok(()) => ExitCode::SUCCESS,
        Err(errors) => session::failed(&mut session, errors),
    }
}

fn run(
    session: &mut Session,
    class: &str,
    arguments: &ExportFmuArgs,
    output: &Path,
) -> Result<(), Vec<Diagnostic>> {
    let one = |fault: Fault| vec![fault.at(Span::NONE)];
    translate(session, class)?;
    let mut set = None;
    if let Some(path) = &arguments.set_file {
        parameter_sets::set(session, path).map_err(one)?;
        set = Some(parameter_sets::read(session, path).map_err(one)?);
    }
    for (name, value) in &arguments.set {
        session.set_parameter_text(name, value).map_err(one)?;
        if let Some(set) = &mut set {
            parameter_sets::replace(session, set, name, value);
        }
    }
    let version = if arguments.fmi == 2 { Version::V2 } else { Version::V3 };
    let kinds = Kinds {
        model_exchange: arguments.kind != Kind::Cs,
        co_simulation: arguments.kind != Kind::Me,
    };
    let bytes = exported(session, class, Form { version, kinds, name: None })?;
    session.world.permit_file(output);
    session.world.write_file(output, &bytes).map_err(one)?;
    let size = bytes.len() as f64 / 1e6;
    session.print(&format!("wrote {} ({size:.1} MB)\n", output.display()));
    if let Some(path) = &arguments.set_file {
        let copy = beside(output);
        let own = session.world.read_bytes(path).map_err(one)?;
        let changed = set.filter(|_| !arguments.set.is_empty()).map(|set| set.to_xml());
        let text = changed.map_or(own, String::into_bytes);
        let is_there = session.world.exists(&copy);
        session.world.permit_file(&copy);
        session.world.write_file(&copy, &text).map_err(one)?;
        let place = if is_there { ", in the place of the former file" } else { "" };
        session.print(&format!("wrote {}{place}\n", copy.display()));
    }
    Ok(())
}

/// The file with the parameters of a unit, beside it.
fn beside(unit: &Path) -> PathBuf {
    unit.with_extension(parameter_set::ENDING)
}
