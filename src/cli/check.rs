//! `gapi check` and `gapi flatten`: models without running them.

mod imported;

use super::options::{Global, Limits};
use super::{limits, session, terminal};
use crate::diag::{Diagnostic, Fault, Severity};
use crate::name::{Ident, Name};
use crate::packages;
use crate::script::Session;
use crate::script::access::policy::Grant;
use crate::script::language::parsing::{self, Reading};
use crate::script::language::script_checks;
use crate::script::models::{checking, simulation};
use crate::source::Span;
use crate::syntax::errors::NOT_A_SCRIPT;
use clap::{Args, ValueHint};
use gapilib_fmi::archive::is_unit;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Arguments of `gapi check`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  gapi check models/CaseStudies
  gapi check models --model CaseStudies.PolarizationCurve
  gapi check scripts/GAPILib.mos
  gapi check Pump.fmu
  gapi check --library ~/libraries Modelica.Blocks.Examples.PID_Controller

Exit code: 0 if nothing is wrong, 1 on an error, 2 for an invalid command line.")]
pub(super) struct CheckArgs {
    /// Modelica files, package folders, scripts or functional mock-up units (FMUs), or the class
    #[arg(required_unless_present = "model", value_name = "FILE|CLASS", value_hint = ValueHint::AnyPath)]
    pub files: Vec<PathBuf>,
    /// The class to check as a model
    #[arg(long, value_name = "CLASS")]
    pub model: Option<String>,
    /// Reject everything that the specification forbids, even if libraries rely on it
    #[arg(long)]
    pub strict: bool,
    /// Show from where each library was loaded
    #[arg(long, short)]
    pub(crate) verbose: bool,
    /// Limits
    #[command(flatten)]
    pub limits: Limits,
}

/// Arguments of `gapi flatten`.
#[derive(Debug, Args)]
#[command(after_help = "\
Example:
  gapi flatten models --model CaseStudies.PolarizationCurve

Exit code: 0 on success, 1 on an error, 2 for an invalid command line.")]
pub(super) struct FlattenArgs {
    /// Modelica files or package folders, and the class; files that can be found by class name can
    /// be omitted
    #[arg(required_unless_present = "model", value_name = "FILE|CLASS", value_hint = ValueHint::AnyPath)]
    pub files: Vec<PathBuf>,
    /// The class to flatten
    #[arg(long, value_name = "CLASS")]
    pub model: Option<String>,
    /// Limits
    #[command(flatten)]
    pub limits: Limits,
}

/// Checks all classes of the files, or one; models down to their sorted equations.
pub(super) fn check(arguments: &CheckArgs, global: &Global) -> ExitCode {
    let _watch = match limits::enforce(&arguments.limits) {
        Ok(watch) => watch,
        Err(code) => return code,
    };
    let (class, files) = session::class_and_files(arguments.model.as_ref(), &arguments.files);
    let is_script = |file: &PathBuf| file.extension().is_some_and(|e| e == "mos");
    let (scripts, files): (Vec<PathBuf>, Vec<PathBuf>) = files.into_iter().partition(is_script);
    let (units, files): (Vec<PathBuf>, Vec<PathBuf>) =
        files.into_iter().partition(|file| is_unit(file));
    let (mut session, loaded) = match session::with_files(global, &files) {
        Ok(session) => session,
        Err(code) => return code,
    };
    session.world.grant(Grant::CheckOnly);
    if session::lists_permissions(&mut session, global) {
        return ExitCode::SUCCESS;
    }
    checking::set_strict(&mut session, arguments.strict);
    let wrong = scripts.iter().filter(|script| !check_script(&mut session, script)).count();
    let wrong = wrong + units.iter().filter(|unit| !imported::check(&mut session, unit)).count();
    let models = match &class {
        Some(model) => check_one(&mut session, model),
        None if files.is_empty() => ExitCode::SUCCESS,
        None => check_all(&mut session, &loaded),
    };
    if arguments.verbose {
        let text = loaded_from(&mut session);
        session.print(&text);
    }
    if wrong > 0 { ExitCode::FAILURE } else { models }
}

/// Where each top-level class comes from.
fn loaded_from(session: &mut Session) -> String {
    let roots: Vec<Ident> = session.library().roots().collect();
    let line = |top: Ident| {
        let file = session.source_file(&Name::from(top))?;
        Some(match file.starts_with(packages::FOLDER) {
            true => format!("`{top}` is part of gapi\n"),
            false => format!("`{top}` is loaded from `{}`\n", file.display()),
        })
    };
    roots.into_iter().filter_map(line).collect()
}

/// Checks a script without running it; whether nothing is wrong.
fn check_script(session: &mut Session, path: &Path) -> bool {
    session.world.grant_input(path);
    let name = path.display().to_string();
    let bytes = match super::named::read(path) {
        Ok(bytes) => bytes,
        Err(error) => {
            terminal::eprint(&format!("error: {name}: {error}\n"));
            return false;
        }
    };
    let (script, found) = match parsing::read(&mut session.sources, &name, &bytes) {
        Reading::Script(script) => {
            let found = script_checks::check_script(session, &script, path.parent());
            (Some(script), found)
        }
        Reading::Rejected(error) => (None, vec![error]),
        Reading::Data => (
            None,
            vec![
                Fault::new(NOT_A_SCRIPT, format!("`{name}` is a table of numbers, no script"))
                    .at(Span::NONE),
            ],
        ),
    };
    let wrong = found.iter().filter(|found| found.severity == Severity::Error).count();
    found.into_iter().for_each(|found| session.report(found));
    let statements = match script.map_or(0, |script| script.statements.len()) {
        1 => "1 statement".to_owned(),
        n => format!("{n} statements"),
    };
    if wrong == 0 {
        session.print(&format!("{name}: {statements}, no errors\n"));
    }
    wrong == 0
}

fn check_one(session: &mut Session, model: &str) -> ExitCode {
    session.output.report_once();
    let translated = simulation::translate(session, model);
    let is_right = match translated {
        Ok(translated) => {
            let report = checking::report(session, &translated);
            session.print(&report);
            true
        }
        Err(errors) => match component(session, model, &errors) {
            Some(balance) => {
                session.print(&format!("{balance}\n"));
                true
            }
            None => {
                session::failed(session, errors);
                false
            }
        },
    };
    let class = model.split('(').next().unwrap_or(model).trim();
    let is_class_right = check_class(session, &Name::parse(class));
    if is_right && is_class_right { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// Checks the text of a class and the names in it, whatever is made of it; whether nothing is wrong.
fn check_class(session: &mut Session, class: &Name) -> bool {
    let found = session.examine_class(class);
    let is_right = !found.iter().any(Diagnostic::is_error);
    found.into_iter().for_each(|found| session.report(found));
    is_right
}

/// The balance of a component that is not a system by itself, such as a resistor with open pins.
fn component(session: &mut Session, model: &str, errors: &[Diagnostic]) -> Option<String> {
    let is_singular = errors.iter().all(|error| error.code.slug == "singular-system");
    is_singular.then(|| checking::component_balance(session, model))?
}

fn check_all(session: &mut Session, loaded: &[Name]) -> ExitCode {
    session.output.report_once();
    let classes = checking::classes(session, loaded);
    let (mut models, mut wrong) = (0, 0);
    for class in &classes {
        let mut is_right = check_class(session, class);
        if checking::is_model(session, class) {
            models += 1;
            is_right &= check_model(session, class);
        }
        wrong += usize::from(!is_right);
    }
    let classes = match classes.len() {
        1 => "1 class".to_owned(),
        n => format!("{n} classes"),
    };
    let models = match models {
        1 => "1 model".to_owned(),
        n => format!("{n} models"),
    };
    session.print(&format!("{classes}, {models}, {wrong} with errors\n"));
    if wrong > 0 { ExitCode::FAILURE } else { ExitCode::SUCCESS }
}

/// Checks a model down to its sorted equations; whether nothing is wrong.
fn check_model(session: &mut Session, model: &Name) -> bool {
    let errors = match simulation::translate(session, &model.to_string()) {
        Ok(translated) => {
            let summary = checking::summary(session, &translated);
            session.print(&format!("{model}: {summary}\n"));
            return true;
        }
        Err(errors) => errors,
    };
    if let Some(balance) = component(session, &model.to_string(), &errors) {
        session.print(&format!("{balance}\n"));
        return true;
    }
    if let Some(missing) = values_left_open(&errors) {
        session.print(&format!("{model}: {missing} where it is used\n"));
        return true;
    }
    // As in an editor: what is wrong only with the model by itself is not wrong with the class.
    if !session.model_check(model).run().found.iter().any(Diagnostic::is_error) {
        session.print(&format!("{model}: is complete where it is used\n"));
        return true;
    }
    if errors.iter().all(|error| session.output.has_reported(error)) {
        session.print(&format!("{model}: has the errors reported above\n"));
    }
    session::failed(session, errors);
    false
}

/// What is missing if only values of parameters are, which users of the class give.
fn values_left_open(errors: &[Diagnostic]) -> Option<String> {
    let is_open =
        |error: &Diagnostic| ["parameter-without-value", "value-needed"].contains(&error.code.slug);
    let first = errors.first().filter(|_| errors.iter().all(is_open))?;
    let missing = first.message.replace(", but its value is needed here", "");
    Some(
        missing.replace("has no value", "must have a value").replace("is unknown", "must be known"),
    )
}

/// Prints a model as flat Modelica.
pub(super) fn flatten(arguments: &FlattenArgs, global: &Global) -> ExitCode {
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
    if session::lists_permissions(&mut session, global) {
        return ExitCode::SUCCESS;
    }
    match checking::flat_model(&mut session, &class) {
        Ok(flat) => {
            session.print(&flat.to_string());
            ExitCode::SUCCESS
        }
        Err(errors) => session::failed(&mut session, errors),
    }
}
