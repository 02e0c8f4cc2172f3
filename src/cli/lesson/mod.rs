//! `gapi lesson N`: exercises about the genetic algorithm, each a script to complete.

mod copies;
mod watch;

use super::options::Global;
use super::output::{Output, RESULTS};
use super::session;
use super::terminal::{self, Terminal};
use super::world::SystemWorld;
use crate::diag::suggest;
use crate::lessons::{self, Lesson, Verdict};
use crate::script::world::Environment as _;
use crate::script::{Echo, Options, Reporting, Strictness};
use clap::{Args, ValueHint};
use copies::Copies;
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// Arguments of `gapi lesson`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  gapi lesson                   list the lessons, with what you have passed
  gapi lesson 4                 copy lesson 4 to the folder `lessons`, and check your copy
  gapi lesson 4 --watch         check it again whenever you save it
  gapi lesson 4 --hint          one more hint each time
  gapi lesson 4 --solution      the solution
  gapi lesson 4 --reset         start again; your version is kept beside the new one

Each lesson is a script of about one page with a gap; its comments say what to do. Open the copy in \
                        an editor, change it, save it, and repeat the command. The check runs your \
                        script also with other seeds and data.

Exit code: 0 if the lesson is passed, 1 if not, 2 for an invalid command line, 130 if interrupted.")]
pub(super) struct LessonArgs {
    /// The number of the lesson, or its name; if omitted, all lessons are listed
    #[arg(value_name = "N")]
    pub number: Option<String>,
    /// Show one more hint
    #[arg(long, requires = "number", group = "instead")]
    pub hint: bool,
    /// Show the solution
    #[arg(long, requires = "number", group = "instead")]
    pub solution: bool,
    /// Replace your copy with the unsolved lesson; your version is kept as a file ending in `.old`
    #[arg(long, requires = "number", group = "instead")]
    pub reset: bool,
    /// Check again at each save, until Ctrl-C
    #[arg(long, requires = "number", group = "instead")]
    pub watch: bool,
    /// Folder for the copies and their output
    #[arg(long, default_value = copies::FOLDER, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub folder: PathBuf,
}

/// Lists the lessons, or does with one of them what was asked.
pub(super) fn lesson(arguments: &LessonArgs, global: &Global) -> ExitCode {
    let copies = Copies { folder: &arguments.folder };
    let done = match &arguments.number {
        None => list(&copies),
        Some(name) => match chosen(name) {
            Ok(lesson) => work_on(lesson, arguments, &copies, global),
            Err(message) => {
                terminal::eprint(&format!("error: {message}\n"));
                return ExitCode::from(2);
            }
        },
    };
    done.unwrap_or_else(|message| {
        terminal::eprint(&format!("error: {message}\n"));
        ExitCode::FAILURE
    })
}

/// The lesson of this number, title or file.
fn chosen(name: &str) -> Result<&'static Lesson, String> {
    let all = lessons::all();
    if let Ok(number) = name.parse::<usize>() {
        let found = number.checked_sub(1).and_then(|k| all.get(k));
        return found
            .ok_or_else(|| format!("there is no lesson {number}, only 1 to {}", all.len()));
    }
    let names = all.iter().flat_map(|lesson| names(lesson).map(|name| (name, lesson)));
    let names: Vec<(&str, &Lesson)> = names.collect();
    let named = |name: &str| names.iter().find(|(own, _)| own.eq_ignore_ascii_case(name));
    if let Some((_, lesson)) = named(name) {
        return Ok(lesson);
    }
    let near = suggest::nearest(name, names.iter().map(|(name, _)| *name)).and_then(named);
    let near = near.map_or_else(String::new, |(_, lesson)| {
        format!(" = help: did you mean {}, \"{}\"?\n", lesson.number, lesson.title())
    });
    let numbers = all.iter().map(|lesson| format!("{:>5}  {}\n", lesson.number, lesson.title()));
    let numbers = numbers.collect::<String>();
    Err(format!(
        "`{name}` is not a lesson\n{near} = help: give the number of one of these:\n{}",
        numbers.trim_end()
    ))
}

/// What a lesson can be called beside its number: its title, and its file with and without number and
/// ending.
fn names(lesson: &Lesson) -> [&str; 4] {
    let stem = lesson.file.trim_end_matches(".mos");
    let bare = stem.split_once('_').map_or(stem, |(_, name)| name);
    [lesson.title(), &lesson.file, stem, bare]
}

fn work_on(
    lesson: &Lesson,
    arguments: &LessonArgs,
    copies: &Copies<'_>,
    global: &Global,
) -> Result<ExitCode, String> {
    if arguments.hint {
        return hint(lesson, copies);
    }
    if arguments.solution {
        terminal::print(&solution(lesson));
        return Ok(ExitCode::SUCCESS);
    }
    if arguments.reset {
        return reset(lesson, copies);
    }
    let file = copies.file(&lesson.file).display().to_string();
    if copies.make(lesson)? {
        terminal::print(&format!(
            "{}\ncopied to {file}\nOpen it in an editor, change it, save it, and repeat the command.\n\n",
            filled(&lesson.introduction())
        ));
    } else {
        terminal::print(&format!("Lesson {}: {}\n{file}\n\n", lesson.number, lesson.title()));
    }
    match arguments.watch {
        true => watch::for_ever(lesson, copies, || {
            run_and_check(lesson, copies, global, Interrupt::Ends).map(|_| ())
        })
        .map(|()| ExitCode::SUCCESS),
        false => run_and_check(lesson, copies, global, Interrupt::Caught),
    }
}

/// The lessons with what is passed, and which one is next.
fn list(copies: &Copies<'_>) -> Result<ExitCode, String> {
    let progress = copies.progress()?;
    let all = lessons::all();
    for lesson in all {
        let mark = if progress.passed.contains(&lesson.number) { 'x' } else { ' ' };
        terminal::print(&format!("[{mark}] Lesson {}: {}\n", lesson.number, lesson.title()));
    }
    let passed = all.iter().filter(|lesson| progress.passed.contains(&lesson.number)).count();
    let next = all.iter().find(|lesson| !progress.passed.contains(&lesson.number));
    terminal::print(&match next {
        Some(next) => {
            format!("\n{passed} of {} passed. Next: gapi lesson {}\n", all.len(), next.number)
        }
        None => format!("\nAll {} lessons are passed.\n", all.len()),
    });
    Ok(ExitCode::SUCCESS)
}

/// Shows the hints shown before and the next one.
fn hint(lesson: &Lesson, copies: &Copies<'_>) -> Result<ExitCode, String> {
    let (mut progress, number, of) = (copies.progress()?, lesson.number, lesson.hints.len());
    let shown = (progress.hints(number) + 1).min(of);
    for (k, hint) in lesson.hints.iter().take(shown).enumerate() {
        terminal::print(&format!("Hint {} of {of}: {hint}\n", k + 1));
    }
    terminal::print(&match shown == of {
        true => format!("\nThe solution: gapi lesson {number} --solution\n"),
        false => format!("\nOne more: gapi lesson {number} --hint\n"),
    });
    progress.set_hints(number, shown);
    copies.keep(&progress)?;
    Ok(ExitCode::SUCCESS)
}

/// What to replace in the unsolved lesson, and with what.
fn solution(lesson: &Lesson) -> String {
    let mut text = format!("A solution of lesson {}: {}\n", lesson.number, lesson.title());
    for [gap, filled] in &lesson.solution {
        text.push_str(&format!(
            "\nReplace\n\n{}\n\nwith\n\n{}\n",
            indented(gap.trim_end()),
            indented(filled.trim_end())
        ));
    }
    text
}

fn indented(text: &str) -> String {
    text.lines().map(|line| format!("    {line}")).collect::<Vec<_>>().join("\n")
}

fn reset(lesson: &Lesson, copies: &Copies<'_>) -> Result<ExitCode, String> {
    for (old, kept) in copies.reset(lesson)? {
        terminal::print(&format!("{} is kept as {}\n", old.display(), kept.display()));
    }
    let mut progress = copies.progress()?;
    progress.forget(lesson.number);
    copies.keep(&progress)?;
    let file = copies.file(&lesson.file);
    terminal::print(&format!("{} is unsolved again\n", file.display()));
    Ok(ExitCode::SUCCESS)
}

/// What Ctrl-C does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Interrupt {
    /// It stops the script.
    Caught,
    /// It ends the process: it waits for saves most of the time.
    Ends,
}

/// Runs the learner's copy, checks it, and keeps what came of it.
fn run_and_check(
    lesson: &Lesson,
    copies: &Copies<'_>,
    global: &Global,
    interrupt: Interrupt,
) -> Result<ExitCode, String> {
    let (code, stop) = run(lesson, copies, global, interrupt)?;
    if code == 130 {
        return Ok(ExitCode::from(code));
    }
    let number = lesson.number;
    let (text, companions) = copies.read(lesson)?;
    let verdict = match code {
        0 => lessons::check_until(&stop, lesson, &text, &companions),
        _ => {
            let advice = lessons::advice(lesson, &text).join(" ");
            Verdict::NotYet(format!(
                "The script ended with the error above. Correct it first. {advice}"
            ))
        }
    };
    match verdict {
        Verdict::Passed => {
            let mut progress = copies.progress()?;
            progress.passed.insert(number);
            copies.keep(&progress)?;
            terminal::print(&format!("\nLesson {number} passed.\n\n{}", filled(&lesson.passed)));
            if let Some(what) = &lesson.watch {
                let file = copies.file(&lesson.file);
                terminal::print(&format!("\nWatch {what}: gapi teach {}\n", file.display()));
            }
            if number < lessons::all().len() {
                terminal::print(&format!("\nThe next lesson: gapi lesson {}\n", number + 1));
            }
            Ok(ExitCode::SUCCESS)
        }
        Verdict::Stopped => {
            terminal::print("\nThe check was stopped.\n");
            Ok(ExitCode::from(130))
        }
        Verdict::NotYet(message) => {
            terminal::print(&format!("\nLesson {number} is not passed yet.\n\n"));
            terminal::print(&filled(&message));
            terminal::print(&format!(
                "\nA hint: gapi lesson {number} --hint\nStart again: gapi lesson {number} --reset\n"
            ));
            Ok(ExitCode::FAILURE)
        }
    }
}

/// Paragraphs in lines that fit a terminal; lines that begin with a blank or a sign stay.
fn filled(text: &str) -> String {
    let begins = |c: char| c.is_alphabetic() || c == '(';
    let is_prose = |part: &&str| part.lines().all(|line| line.starts_with(begins));
    let paragraphs = text.trim_end().split("\n\n").map(|part| match is_prose(&part) {
        true => gapilib_script::teach::plain::wrapped(part),
        false => format!("{part}\n"),
    });
    paragraphs.collect::<Vec<_>>().join("\n")
}

/// Runs the learner's copy where he sees it; the exit code of the script, and what is set when the
/// user asks to stop.
fn run(
    lesson: &Lesson,
    copies: &Copies<'_>,
    global: &Global,
    interrupt: Interrupt,
) -> Result<(u8, Arc<AtomicBool>), String> {
    let file = copies.file(&lesson.file);
    let terminal = Terminal::new(global.color, false);
    let output = Output::below(&copies.folder.join(RESULTS), "gapi lesson", &file)?;
    let world =
        SystemWorld::for_results(terminal, output, None).map_err(|error| error.to_string())?;
    let stop = world.interrupt_flag().unwrap_or_default();
    if interrupt == Interrupt::Caught {
        world.catch_interrupts();
    }
    let reporting = if lesson.report.is_some() { Reporting::Usual } else { Reporting::Off };
    let strictness = Strictness::Strict;
    let options = Options { echo: Echo::Usual, strictness, reporting, ..Options::default() };
    let mut session = session::open(global, world).with_options(options);
    let code = session.run_file(&file).code;
    if let Some(report) = lesson.report.as_deref().filter(|_| code == 0) {
        terminal::print(&format!("\n{}", filled(report)));
    }
    Ok((code, stop))
}
