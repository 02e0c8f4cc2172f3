//! `gapi identify a.toml b.toml`: solves several problems of the same data and compares the models.

use super::disk::write_beside;
use super::identify::IdentifyArgs;
use super::identify::{Ended, solve_one};
use super::options::Global;
use super::output::RESULTS;
use super::terminal;
use crate::script::access::faults::cannot;
use gapilib_identify::problem::Solution;
use gapilib_identify::problem::inference::{Comparison, compare};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

/// Solves every problem into a folder of its name, and compares.
pub(super) fn identify_all(arguments: &IdentifyArgs, global: &Global) -> ExitCode {
    let problems: Vec<&Path> = std::iter::once(arguments.problem.as_path())
        .chain(arguments.others.iter().map(PathBuf::as_path))
        .collect();
    let name =
        |problem: &Path| problem.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let names: Vec<String> = problems.iter().map(|problem| name(problem)).collect();
    if let Some(twice) = (1..names.len()).find(|&k| names[..k].contains(&names[k])) {
        terminal::eprint(&format!(
            "error: two problems are called `{}`, so their output folders would coincide\n",
            names[twice]
        ));
        return ExitCode::from(2);
    }
    let started = Instant::now();
    let mut solutions: Vec<Solution> = Vec::new();
    for (problem, name) in problems.iter().zip(&names) {
        match solve_one(arguments, global, (problem, Path::new(name)), started) {
            Ended::Solved(solution) => solutions.push(*solution),
            Ended::Not(code) => return code,
        }
    }
    let named: Vec<(String, &Solution)> = names.into_iter().zip(&solutions).collect();
    match compare(&named) {
        Ok(comparison) => {
            terminal::print_report(&comparison.text());
            write(&comparison, arguments.out.as_deref().unwrap_or(Path::new(RESULTS)))
        }
        Err(fault) => {
            let help = fault.helps.first().map_or(String::new(), |help| format!("help: {help}\n"));
            terminal::eprint(&format!("error: {}\n{help}", fault.message));
            ExitCode::FAILURE
        }
    }
}

/// Writes the comparison beside the folders of its models, under their names.
fn write(comparison: &Comparison, folder: &Path) -> ExitCode {
    let names: Vec<&str> = comparison.models.iter().map(|model| model.name.as_str()).collect();
    let path = folder.join(format!("comparison-{}.json", names.join("-")));
    match write_beside(&path, comparison.to_json().as_bytes()) {
        Ok(()) => {
            terminal::print(&format!("\n  written to {}\n", path.display()));
            ExitCode::SUCCESS
        }
        Err(error) => {
            let message = cannot("write", &path, &error).message;
            terminal::eprint(&format!("error: {message}\n"));
            ExitCode::FAILURE
        }
    }
}
