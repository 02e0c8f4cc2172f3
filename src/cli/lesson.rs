//! `gapi lesson N`: short scripts that teach one thing each.

use super::disk;
use super::options::Global;
use super::output::{Output, RESULTS};
use super::session;
use super::terminal::{self, Terminal};
use super::world::SystemWorld;
use crate::script::{Echo, Options};
use clap::{Args, ValueHint};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Arguments of `gapi lesson`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  gapi lesson
  gapi lesson 1

Each lesson is a script of about one page; its comments explain it. The command copies it to the \
                        folder `lessons`, shows it and runs it. Edit the copy and repeat the \
                        command: it then runs your copy.")]
pub(super) struct LessonArgs {
    /// The number of the lesson; if omitted, all lessons are listed
    #[arg(value_name = "N")]
    pub number: Option<usize>,
    /// Folder for the copies and their output
    #[arg(long, default_value = "lessons", value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub folder: PathBuf,
}

/// Name and text of each lesson.
const LESSONS: &[(&str, &str)] = &[
    (
        "01_one_parameter_by_hand.mos",
        include_str!("../../scripts/lessons/01_one_parameter_by_hand.mos"),
    ),
    ("02_fitness_is_a_sum.mos", include_str!("../../scripts/lessons/02_fitness_is_a_sum.mos")),
    ("03_random_search.mos", include_str!("../../scripts/lessons/03_random_search.mos")),
    ("04_selection.mos", include_str!("../../scripts/lessons/04_selection.mos")),
    (
        "05_one_point_crossover.mos",
        include_str!("../../scripts/lessons/05_one_point_crossover.mos"),
    ),
    ("06_mutation.mos", include_str!("../../scripts/lessons/06_mutation.mos")),
    ("07_elites.mos", include_str!("../../scripts/lessons/07_elites.mos")),
    ("08_failed_simulations.mos", include_str!("../../scripts/lessons/08_failed_simulations.mos")),
    ("09_log_scale.mos", include_str!("../../scripts/lessons/09_log_scale.mos")),
    ("10_local_refinement.mos", include_str!("../../scripts/lessons/10_local_refinement.mos")),
    ("11_two_objectives.mos", include_str!("../../scripts/lessons/11_two_objectives.mos")),
    (
        "12_good_fit_wrong_parameters.mos",
        include_str!("../../scripts/lessons/12_good_fit_wrong_parameters.mos"),
    ),
];

/// Lists the lessons, or copies one, shows it, and runs the copy.
pub(super) fn lesson(arguments: &LessonArgs, global: &Global) -> ExitCode {
    let Some(number) = arguments.number else {
        list();
        return ExitCode::SUCCESS;
    };
    let Some(&(name, text)) = number.checked_sub(1).and_then(|k| LESSONS.get(k)) else {
        let last = LESSONS.len();
        terminal::eprint(&format!("error: there is no lesson {number}, only 1 to {last}\n"));
        return ExitCode::from(2);
    };
    match copied(&arguments.folder.join(name), text) {
        Ok((file, text)) => {
            terminal::print(&format!("{}:\n\n{text}\n", file.display()));
            let code = run(&file, arguments, global);
            terminal::print(&ending(&file, &text, number));
            code
        }
        Err(message) => {
            terminal::eprint(&message);
            ExitCode::FAILURE
        }
    }
}

/// How to go on.
fn ending(file: &Path, text: &str, number: usize) -> String {
    let file = file.display();
    let mut hints = format!("\nTo experiment, edit {file} and repeat the command.\n");
    if text.contains("Cross(") && text.contains("Eval(") {
        hints.push_str(&format!("Step by step: gapi teach {file}\n"));
    }
    if number < LESSONS.len() {
        hints.push_str(&format!("The next lesson: gapi lesson {}\n", number + 1));
    }
    hints
}

fn list() {
    for (_, text) in LESSONS {
        let title = text.lines().next().unwrap_or_default();
        terminal::print(&format!("{}\n", title.trim_start_matches("// ")));
    }
    terminal::print("\n`gapi lesson 1` shows and runs the first lesson.\n");
}

/// The learner's copy and its text; made where there is none.
fn copied(file: &Path, text: &str) -> Result<(PathBuf, String), String> {
    let failed = |error: std::io::Error| format!("error: `{}`: {error}\n", file.display());
    if !file.exists() {
        file.parent().map_or(Ok(()), disk::create_named_folders).map_err(failed)?;
        disk::write_named(file, text.as_bytes()).map_err(failed)?;
    }
    Ok((file.to_owned(), super::named::read_text(file).map_err(failed)?))
}

fn run(file: &Path, arguments: &LessonArgs, global: &Global) -> ExitCode {
    let terminal = Terminal::new(global.color, false);
    let world =
        Output::below(&arguments.folder.join(RESULTS), "gapi lesson", file).and_then(|output| {
            SystemWorld::for_results(terminal, output, None).map_err(|error| error.to_string())
        });
    let world = match world {
        Ok(world) => world,
        Err(message) => {
            terminal::eprint(&format!("error: {message}\n"));
            return ExitCode::FAILURE;
        }
    };
    world.catch_interrupts();
    let options = Options { echo: Echo::Usual, ..Options::default() };
    let mut session = session::open(global, world).with_options(options);
    ExitCode::from(session.run_file(file).code)
}
