//! `gapi teach SCRIPT`: a run of the genetic algorithm, step by step.

use super::disk;
use super::interrupts::{self, Answer, Caught};
use super::options::{Global, at_least_one};
use super::output::{RESULTS, latest_of, shown};
use super::teach_run::{Again, Change, Recording, RunArgs, Running, Trouble, output, read};
use super::teach_screen::{self, Source};
use super::terminal::{self, Terminal};
use crate::script::access::faults::cannot;
use crate::script::world::Screen as _;
use clap::{Args, ValueHint};
use gapilib_script::teach::bands::{self, Repeated};
use gapilib_script::teach::branches::Branches;
use gapilib_script::teach::page::WhatIf;
use gapilib_script::teach::quiz::{self, Score};
use gapilib_script::teach::screen::Screen;
use gapilib_script::teach::{Trace, TraceCursor, page, picture, plain};
use std::io::IsTerminal as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// How often many runs say how far they are.
const SHOWN_EVERY: Duration = Duration::from_secs(2);

/// Arguments of `gapi teach`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  gapi teach scripts/GAPILib.mos
  gapi teach scripts/GAPILib.mos --generation 100 --count 2
  gapi teach scripts/twin/GAPILib.mos --html steps.html
  gapi teach lessons/04_selection.mos --quiz
  gapi teach scripts/twin/GAPILib.mos --what-if \"F_Mut := 0.5\" --generation 10
  gapi teach scripts/twin/GAPILib.mos --what-if \"F_Mut := 0\" --what-if \"F_Mut := 1\" --runs 20
  gapi run my.mos --trace my.trace && gapi teach my.trace

Exit code: 0 on success, 1 on an error, 2 for an invalid command line, 130 if interrupted.")]
pub(super) struct TeachArgs {
    /// Print the steps as text, even on a terminal
    #[arg(long)]
    pub plain: bool,
    /// Quiz: ask for the outcome of each step first, and count the correct answers
    #[arg(long, conflicts_with = "html")]
    pub quiz: bool,
    /// Run again with this statement executed at the first generation shown, and compare; repeat the option for several statements
    #[arg(long, value_name = "STATEMENT", conflicts_with = "quiz")]
    pub what_if: Vec<String>,
    /// Compare over this number of runs with different seeds
    #[arg(long, default_value_t = 1, value_name = "N", value_parser = at_least_one, requires = "what_if")]
    pub runs: usize,
    /// The first generation to show
    #[arg(long, default_value_t = 1, value_name = "N", value_parser = at_least_one)]
    pub generation: usize,
    /// Number of generations to print as text [default: 1; for a script that only calls operators: all calls]
    #[arg(long, value_name = "N", value_parser = at_least_one)]
    pub count: Option<usize>,
    /// Write a figure of the first generation shown and the next one (SVG), instead of text
    #[arg(long, value_name = "FILE", conflicts_with_all = ["html", "quiz", "what_if"], value_hint = ValueHint::FilePath)]
    pub svg: Option<PathBuf>,
    /// Write an HTML page with all steps, instead of text
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub html: Option<PathBuf>,
    /// What is run, and where its results go
    #[command(flatten)]
    pub run: RunArgs,
}

/// Runs the script, or reads the trace, and shows its steps.
pub(super) fn teach(arguments: &TeachArgs, global: &Global) -> ExitCode {
    match taught(arguments, global) {
        Ok(()) => ExitCode::SUCCESS,
        Err(Trouble::Reported(code)) => code,
        Err(Trouble::Message(message)) => {
            terminal::eprint(&format!("error: {message}\n"));
            ExitCode::FAILURE
        }
    }
}

fn taught(arguments: &TeachArgs, global: &Global) -> Result<(), Trouble> {
    let is_script = arguments.run.input.extension().is_some_and(|extension| extension == "mos");
    if arguments.runs > 1 || arguments.what_if.len() > 1 {
        if arguments.html.is_some() {
            let message = "a page compares with one change in one run: give --what-if once and no \
                           --runs";
            return Err(Trouble::Message(message.to_owned()));
        }
        return compare_many(arguments, global);
    }
    if is_script && is_on_screen(arguments) {
        return show_run(arguments, global);
    }
    let trace = match is_script {
        true => recorded(arguments, global, Again::default())?,
        false => read(&arguments.run.input, &arguments.run.input)?,
    };
    if let (Some(statement), None) = (arguments.what_if.first(), &arguments.html) {
        return compare(arguments, global, &trace, statement);
    }
    if let Some(file) = &arguments.svg {
        return draw(&trace, file, arguments.generation);
    }
    match &arguments.html {
        Some(page) => {
            let what_if = what_if(arguments, global)?;
            write_page(trace, page, (&results(arguments)?, is_script), what_if.as_ref())
        }
        None => show(trace, arguments, global),
    }
}

/// Where the report of the run may lie: that of a recorded trace is the one that is named, or the
/// one written last.
fn results(arguments: &TeachArgs) -> Result<PathBuf, Trouble> {
    let is_script = arguments.run.input.extension().is_some_and(|extension| extension == "mos");
    match &arguments.run.out {
        Some(folder) => Ok(folder.clone()),
        None if is_script => output(&arguments.run).map(|output| output.folder),
        None => Ok(latest_of(Path::new(RESULTS))),
    }
}

/// Runs the script with a trace beside its results, and reads the trace.
fn recorded(arguments: &TeachArgs, global: &Global, again: Again<'_>) -> Result<Trace, Trouble> {
    Recording::new(&arguments.run, global, again, false)?.run_to_end().map(|(trace, _)| trace)
}

/// Runs the script once more with a change, and shows both runs on one chart.
fn compare(
    arguments: &TeachArgs,
    global: &Global,
    original: &Trace,
    change: &str,
) -> Result<(), Trouble> {
    let generation = arguments.generation;
    let changed = branch(arguments, global, (generation, change))?;
    let branches = Branches { original, changed: &changed, generation, change };
    let figure = branches.figure();
    let file = shown(&output(&arguments.run)?.folder.join("what_if.svg"));
    terminal::print_report(&format!("{}\n\n{}\n", branches.summary(), figure.text(64, 14)));
    write(&file, &figure.svg())?;
    terminal::print(&format!("written to {}\n", file.display()));
    Ok(())
}

/// The run with a change.
fn branch(arguments: &TeachArgs, global: &Global, change: Change<'_>) -> Result<Trace, Trouble> {
    if arguments.run.input.extension().is_none_or(|extension| extension != "mos") {
        let message = "a recorded run cannot be changed; give the script instead";
        return Err(Trouble::Message(message.to_owned()));
    }
    let again = Again { change: Some(change), run: None };
    recorded(arguments, global, again)
}

/// Runs the script as it is and with each change, with many seeds, and shows the bands of all.
fn compare_many(arguments: &TeachArgs, global: &Global) -> Result<(), Trouble> {
    if arguments.run.input.extension().is_none_or(|extension| extension != "mos") {
        let message = "a recorded run cannot be repeated; give the script instead";
        return Err(Trouble::Message(message.to_owned()));
    }
    let all = (arguments.what_if.len() + 1) * arguments.runs;
    let begun = Instant::now();
    let mut said = begun;
    let changes = arguments.what_if.iter().map(|statement| Some(statement.as_str()));
    let repeated = [None].into_iter().chain(changes).enumerate().map(|(place, statement)| {
        let name = statement.unwrap_or("original script").to_owned();
        let curves = (0..arguments.runs).map(|run| {
            let number = place * arguments.runs + run + 1;
            if said.elapsed() >= SHOWN_EVERY {
                said = Instant::now();
                let seconds = begun.elapsed().as_secs();
                terminal::eprint(&format!("run {number} of {all}, {name}: {seconds} s\n"));
            }
            let change = statement.map(|statement| (arguments.generation, statement));
            let again = Again { change, run: Some(run) };
            recorded(arguments, global, again).map(|trace| bands::curve(&trace))
        });
        Ok(Repeated { curves: curves.collect::<Result<_, Trouble>>()?, name: name.clone() })
    });
    let repeated = repeated.collect::<Result<Vec<_>, Trouble>>()?;
    let figure = bands::figure(&repeated);
    let file = shown(&output(&arguments.run)?.folder.join("what_if.svg"));
    terminal::print_report(&format!(
        "{}\n{}\n",
        bands::summary(&repeated),
        bands::medians(&repeated).text(64, 14)
    ));
    write(&file, &figure.svg())?;
    terminal::print(&format!("written to {}\n", file.display()));
    Ok(())
}

fn write(file: &Path, text: &str) -> Result<(), Trouble> {
    disk::write_beside(file, text.as_bytes())
        .map_err(|error| Trouble::Message(cannot("write", file, &error).message))
}

/// What the run would have been with the change that was asked for, if one was.
fn what_if(arguments: &TeachArgs, global: &Global) -> Result<Option<WhatIf>, Trouble> {
    let Some(statement) = arguments.what_if.first() else { return Ok(None) };
    let generation = arguments.generation;
    let trace = branch(arguments, global, (generation, statement))?;
    Ok(Some(WhatIf { trace, generation, statement: statement.clone() }))
}

/// Writes the page of a trace. The report of the run lies in the folder `results`; where the run was
/// recorded earlier, only if it is the report of that run.
fn write_page(
    trace: Trace,
    file: &Path,
    (results, is_new): (&Path, bool),
    what_if: Option<&WhatIf>,
) -> Result<(), Trouble> {
    let report = super::named::read_text(&results.join("result.json")).ok();
    let report = report.filter(|report| is_new || page::belongs(&trace, report));
    write(file, &page::page(trace, report.as_deref(), what_if))?;
    terminal::print(&format!("written to {}\n", file.display()));
    Ok(())
}

/// Writes the picture of a generation, counted from 1.
fn draw(trace: &Trace, file: &Path, generation: usize) -> Result<(), Trouble> {
    let has = trace.generations.len();
    if generation > has {
        return Err(Trouble::Message(format!("the run has {has} generations")));
    }
    if trace.generations[generation - 1].is_empty() {
        let message = "calls of operators have no figure of generations: use --html or --plain";
        return Err(Trouble::Message(message.to_owned()));
    }
    if file.extension().is_none_or(|ending| !ending.eq_ignore_ascii_case("svg")) {
        let message = format!("`{}` does not end in `.svg`: --svg writes SVG only", file.display());
        return Err(Trouble::Message(message));
    }
    write(file, &picture::picture(trace, generation - 1))?;
    terminal::print(&format!("written to {}\n", file.display()));
    Ok(())
}

/// Whether the steps are shown on the screen of a terminal.
fn is_on_screen(arguments: &TeachArgs) -> bool {
    let is_other = arguments.plain || arguments.html.is_some() || arguments.svg.is_some();
    let is_terminal = std::io::stdout().is_terminal() && std::io::stdin().is_terminal();
    !is_other && arguments.what_if.is_empty() && is_terminal
}

/// The walk at the generation that is shown first.
fn walk(trace: Trace, arguments: &TeachArgs) -> Result<TraceCursor, Trouble> {
    let mut walk = TraceCursor::new(trace);
    if !walk.go_to(arguments.generation - 1) {
        let has = walk.trace().generations.len();
        return Err(Trouble::Message(format!("the run has {has} generations")));
    }
    Ok(walk)
}

/// A recorded run: on the screen of a terminal, as text where there is none.
fn show(trace: Trace, arguments: &TeachArgs, global: &Global) -> Result<(), Trouble> {
    let walk = walk(trace, arguments)?;
    if !is_on_screen(arguments) {
        return print(walk, arguments);
    }
    on_screen(walk, arguments, global, &mut Recorded)
}

/// Runs a script and shows it on the screen, from what is recorded so far while it continues.
fn show_run(arguments: &TeachArgs, global: &Global) -> Result<(), Trouble> {
    std::thread::scope(|scope| {
        let mut running = Running::begin(scope, &arguments.run, global)?;
        let walk = walk(running.first(arguments.generation)?, arguments)?;
        let mut source = OfRun { running, arguments, global, trouble: None };
        on_screen(walk, arguments, global, &mut source)?;
        source.trouble.map_or(Ok(()), Err)
    })
}

fn on_screen(
    walk: TraceCursor,
    arguments: &TeachArgs,
    global: &Global,
    source: &mut dyn Source,
) -> Result<(), Trouble> {
    let colour = Terminal::new(global.color, true).colour();
    // An interrupt during the run has ended the run; from here on it ends the screen.
    let interrupt = source.interrupt();
    interrupt.store(false, Ordering::SeqCst);
    let screen = Screen::new(walk, colour);
    let screen = if source.continues() { screen.while_running() } else { screen };
    let screen = if arguments.quiz { screen.with_quiz() } else { screen };
    let score = teach_screen::walk_through(screen, source, &interrupt)
        .map_err(|error| Trouble::Message(format!("cannot draw on the terminal: {error}")))?;
    if let Some(score) = score {
        terminal::print_report(&format!("{score}\n"));
    }
    Ok(())
}

/// A trace that was recorded earlier.
struct Recorded;

impl Source for Recorded {
    fn run_again(&mut self, _generation: usize, _change: &str) -> Result<Trace, String> {
        Err("a recorded run cannot be changed; give the script instead".to_owned())
    }

    fn curve(&mut self, _genes: &[f64]) -> Result<Vec<f64>, String> {
        Err("a trace contains only the curve of the best of each generation; give the script \
             instead to see all curves"
            .to_owned())
    }
}

/// A run of this program.
struct OfRun<'a> {
    running: Running,
    arguments: &'a TeachArgs,
    global: &'a Global,
    /// What the run has failed with.
    trouble: Option<Trouble>,
}

impl Source for OfRun<'_> {
    fn run_again(&mut self, generation: usize, change: &str) -> Result<Trace, String> {
        if self.continues() {
            return Err("the run continues: try a change when it has ended".to_owned());
        }
        branch(self.arguments, self.global, (generation, change)).map_err(|trouble| match trouble {
            Trouble::Reported(_) => {
                "the changed run failed; the reason is printed after this screen closes".to_owned()
            }
            Trouble::Message(message) => message,
        })
    }

    fn curve(&mut self, genes: &[f64]) -> Result<Vec<f64>, String> {
        self.running.curve(genes)
    }

    fn continues(&self) -> bool {
        !self.running.has_ended()
    }

    fn ended(&mut self) -> Option<Result<Trace, String>> {
        let ended = self.running.ended()?;
        Some(ended.map_err(|trouble| {
            self.trouble = Some(trouble);
            "the run has failed; the reason is printed after this screen closes".to_owned()
        }))
    }

    fn interrupt(&self) -> Arc<AtomicBool> {
        self.running.interrupt()
    }
}

/// So many evaluations of a script without a genetic algorithm are printed.
const MOST_EVALUATIONS: usize = 5;

fn print(mut walk: TraceCursor, arguments: &TeachArgs) -> Result<(), Trouble> {
    let count = walk.trace().generations.len();
    let all = match walk.generation() {
        generation if generation.is_call => count,
        generation if generation.is_evaluation => count.min(MOST_EVALUATIONS),
        _ => 1,
    };
    let last = arguments.generation + arguments.count.unwrap_or(all) - 1;
    let mut score = Score::default();
    let interrupt = Arc::default();
    let _caught = arguments.quiz.then(|| Caught::by(&interrupt));
    loop {
        if arguments.quiz && !ask(&walk, &mut score, &interrupt) {
            terminal::print_report(&format!("\n\n{score}\n"));
            return Err(Trouble::Reported(ExitCode::from(130)));
        }
        terminal::print_report(&format!("{}\n", plain::step(&walk)));
        if !walk.forward() || walk.number() >= last {
            break;
        }
    }
    terminal::print_report(&plain::summary(&walk));
    if arguments.quiz {
        terminal::print_report(&format!("\n{score}\n"));
    }
    Ok(())
}

/// Asks what the step will do, if there is something to ask and someone to answer; whether the
/// lesson continues.
fn ask(walk: &TraceCursor, score: &mut Score, interrupt: &AtomicBool) -> bool {
    let Some(question) = quiz::question(walk) else { return true };
    terminal::print_report(&format!("? {}\n> ", question.text));
    loop {
        match interrupts::line_or(interrupt) {
            Answer::Line(answer) => match question.judge(&answer) {
                Ok(verdict) => {
                    score.count(&verdict);
                    terminal::print_report(&format!("{}\n\n", verdict.text));
                    return true;
                }
                Err(again) => terminal::print(&format!("{again}\n> ")),
            },
            Answer::None => {
                terminal::print("(no answer)\n\n");
                return true;
            }
            Answer::Interrupted => return false,
        }
    }
}
