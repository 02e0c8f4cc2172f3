//! `gapi check` and `gapi flatten`: models without running them.

use super::args::{CheckArgs, FlattenArgs, Global};
use super::session;
use crate::script::{Session, checking, simulation};
use std::process::ExitCode;

/// Checks all models of the files, or one down to its sorted equations.
pub(super) fn check(arguments: &CheckArgs, global: &Global) -> ExitCode {
    let mut session = match session::with_files(global, &arguments.files) {
        Ok(session) => session,
        Err(code) => return code,
    };
    match &arguments.model {
        Some(model) => check_one(&mut session, model),
        None => check_all(&mut session),
    }
}

fn check_one(session: &mut Session, model: &str) -> ExitCode {
    match simulation::translate(session, model) {
        Ok(translated) => {
            session.print(&checking::report(&translated));
            ExitCode::SUCCESS
        }
        Err(errors) => session::failed(session, errors),
    }
}

fn check_all(session: &mut Session) -> ExitCode {
    let (models, classes) = checking::models(session);
    let mut wrong = 0;
    for model in &models {
        match simulation::translate(session, &model.to_string()) {
            Ok(translated) => {
                let report = checking::report(&translated);
                let counts: Vec<&str> =
                    report.lines().skip(1).take_while(|line| line.starts_with("  ")).collect();
                let counts: Vec<&str> = counts.into_iter().map(str::trim).collect();
                session.print(&format!("{model}: {}\n", counts.join(", ")));
            }
            Err(errors) => {
                wrong += 1;
                session::failed(session, errors);
            }
        }
    }
    let count = models.len();
    session.print(&format!("{classes} classes, {count} models, {wrong} with errors\n"));
    if wrong > 0 { ExitCode::FAILURE } else { ExitCode::SUCCESS }
}

/// Prints a model as flat Modelica.
pub(super) fn flatten(arguments: &FlattenArgs, global: &Global) -> ExitCode {
    let mut session = match session::with_files(global, &arguments.files) {
        Ok(session) => session,
        Err(code) => return code,
    };
    match checking::flat_model(&mut session, &arguments.model) {
        Ok(flat) => {
            session.print(&flat.to_string());
            ExitCode::SUCCESS
        }
        Err(errors) => session::failed(&mut session, errors),
    }
}
