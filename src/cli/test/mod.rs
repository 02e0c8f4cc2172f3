//! `gapi test`: scripts compared with what is recorded of them.

mod collection;
mod comparison;
mod judgement;
mod junit;
mod settings;
mod verdict;
mod wording;

use super::disk;
use super::options::{Freedom, Global};
use super::pool::{self, Ended, Watch};
use super::terminal::{self, Terminal};
use crate::diag::visible;
use crate::script::access::faults::cannot;
use crate::script::language::expectation::shown;
use crate::script::world::Screen as _;
use clap::{Args, ValueHint};
use collection::{Found, collected, transcript_of};
use judgement::{Counts, summary};
use settings::Settings;
use std::io;
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::Mutex;
use std::time::{Duration, Instant};
use verdict::{Tested, Verdict};

/// Arguments of `gapi test`.
#[derive(Debug, Args)]
#[command(after_help = "\
A script is compared with the transcript NAME.mos.snap next to it, or with the lines between `// \
                        Result:` and `// endResult` in it. Files that it writes are kept in memory. \
                        Of the report of an identification the transcript has the objective and the \
                        estimates, unless --report is given.

Words and integers must be equal. Other numbers agree if they differ by at most A + T |expected|. A \
                        script can set this for itself, in a line such as `// gapi test: tolerance = \
                        1e-3, absolute = 1e-6`; `report` in that line means --report, `skip` that the \
                        script is not a test. Options of the command line come first.

Examples:
  gapi test scripts
  gapi test scripts --list
  gapi test tests/my.mos --accept
  gapi test \"tests/*.mos\" --tolerance 1e-4
  gapi test --review
  gapi test --junit report.xml --threads 2

Exit code: 0 if all agree; 1 if one does not or has no reference, if a transcript has no script, or if \
                        there is no script to test; 2 for an invalid command line.")]
pub(crate) struct TestArgs {
    /// Scripts, patterns such as `tests/*.mos`, or folders with scripts
    #[arg(default_value = ".", value_hint = ValueHint::AnyPath)]
    pub paths: Vec<PathBuf>,
    /// List the scripts and what they are compared with, and run none
    #[arg(long, conflicts_with_all = ["accept", "review", "junit"])]
    pub list: bool,
    /// Overwrite the transcripts
    #[arg(long, conflicts_with = "review")]
    pub accept: bool,
    /// Ask for each difference whether to accept the new transcript
    #[arg(long)]
    pub review: bool,
    /// Write a JUnit report for build servers
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub junit: Option<PathBuf>,
    /// Number of scripts that run at the same time [default: all cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub threads: Option<u16>,
    /// How scripts are compared
    #[command(flatten)]
    pub settings: Settings,
    /// Permissions of scripts
    #[command(flatten)]
    pub freedom: Freedom,
}

/// Runs the scripts; exit code 1 unless all agree with what is recorded.
pub(super) fn test(arguments: &TestArgs, global: &Global) -> ExitCode {
    let colour = Terminal::new(global.color, false).colour();
    let found = collected(&arguments.paths);
    if arguments.list {
        return list(&found);
    }
    let mut results = tested(found, arguments, global, colour);
    if arguments.review {
        for result in &mut results {
            terminal::print_coloured(&line(result, arguments.accept, colour));
            review(result);
        }
    }
    conclude(&results, arguments)
}

/// Lists the scripts and what they are compared with.
fn list(found: &[Found]) -> ExitCode {
    for Found { path, problem } in found {
        let reference = match problem {
            Some(problem) => format!("({problem})"),
            None => comparison::reference(path),
        };
        terminal::print(&format!(
            "{}  {}\n",
            visible(&path.to_string_lossy()),
            visible(&reference)
        ));
    }
    let is_good = found.iter().all(|found| found.problem.is_none());
    if is_good { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// Tests the scripts, several at a time; their outcomes are printed in their order, where no
/// question about them follows.
fn tested(found: Vec<Found>, arguments: &TestArgs, global: &Global, colour: bool) -> Vec<Tested> {
    let available = std::thread::available_parallelism().map_or(1, usize::from);
    let threads = arguments.threads.map_or(available, usize::from).min(found.len()).max(1);
    let job = |found: &Found| {
        let found = found.clone();
        let (freedom, global) = (arguments.freedom.clone(), global.clone());
        let (asked, accept) = (arguments.settings, arguments.accept);
        Box::new(move |_: &Watch| {
            let begin = Instant::now();
            let verdict = match found.problem {
                Some(problem) => Verdict::Failed(problem),
                None => {
                    comparison::Comparison { freedom: &freedom, global: &global, asked, accept }
                        .verdict(&found.path)
                        .unwrap_or_else(|error| Verdict::Failed(error.to_string()))
                }
            };
            (verdict, begin.elapsed().as_secs_f64())
        }) as Box<dyn FnOnce(&Watch) -> (Verdict, f64) + Send>
    };
    let done: Mutex<(Vec<Option<Tested>>, usize)> =
        Mutex::new((found.iter().map(|_| None).collect(), 0));
    pool::work(&found, threads, Duration::MAX, job, |index, _, ended| {
        let (verdict, seconds) = match ended {
            Ended::Done(done) => done,
            Ended::Panicked | Ended::TimedOut => {
                let message = "gapi panicked, which is a fault of gapi: report it with this script";
                (Verdict::Failed(message.to_owned()), 0.0)
            }
        };
        let mut done = done.lock().expect("no panic under the lock");
        let (results, printed) = &mut *done;
        results[index] = Some(Tested { path: found[index].path.clone(), verdict, seconds });
        while let Some(Some(next)) = results.get(*printed).filter(|_| !arguments.review) {
            terminal::print_coloured(&line(next, arguments.accept, colour));
            *printed += 1;
        }
    });
    let (results, _) = done.into_inner().expect("no panic under the lock");
    results.into_iter().flatten().collect()
}

/// Counts, writes the report for build servers, and says how the test ended.
fn conclude(results: &[Tested], arguments: &TestArgs) -> ExitCode {
    let count = |is: fn(&Verdict) -> bool| results.iter().filter(|one| is(&one.verdict)).count();
    let (good, skipped) = (count(Verdict::is_good), count(|verdict| *verdict == Verdict::Skipped));
    let tested = results.len() - skipped;
    let left_out = if skipped > 0 { format!(", {skipped} skipped") } else { String::new() };
    terminal::print(&format!(
        "{tested} {}, {good} agree, {} do not{left_out}\n",
        if tested == 1 { "script" } else { "scripts" },
        tested - good
    ));
    let counts = Counts::of_all(results);
    if counts.total() > 0 {
        terminal::print(&format!("{counts}\n"));
    }
    if tested == 0 {
        terminal::eprint("error: there is no script to test\n");
    }
    if let Some(file) = &arguments.junit
        && let Err(error) = disk::write_named(file, junit::report(results).as_bytes())
    {
        terminal::eprint(&format!("error: {}\n", cannot("write", file, &error).message));
        return ExitCode::FAILURE;
    }
    if good == tested && tested > 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// What came of a script, as it is printed: what files hold is made visible before it is coloured.
fn line(tested: &Tested, accept: bool, colour: bool) -> String {
    let (word, code, rest) = match &tested.verdict {
        Verdict::Agrees(_) => ("ok", "32", String::new()),
        Verdict::Accepted { is_failing: false } => ("accepted", "33", String::new()),
        Verdict::Accepted { is_failing: true } => {
            let words = "  the script ends with an error, which is now expected of it\n";
            ("accepted", "33", words.to_owned())
        }
        Verdict::Skipped => ("skipped", "33", String::new()),
        Verdict::Unrecorded(_) => ("new", "33", "  nothing is recorded: --accept\n".to_owned()),
        Verdict::Differs(lines, _) => ("differs", "31", shown(lines, colour)),
        Verdict::DiffersFromEmbedded(lines, judged) => {
            let hint = "  its result is embedded: correct it in the script\n";
            let hint = if accept { hint } else { "" };
            ("differs", "31", shown(lines, colour) + &summary(judged) + hint)
        }
        Verdict::Failed(message) => ("failed", "31", format!("  {}\n", visible(message))),
    };
    let word = match colour {
        true => format!("\x1b[{code}m{word:8}\x1b[0m"),
        false => format!("{word:8}"),
    };
    format!("{word} {}\n{rest}", visible(&tested.path.to_string_lossy()))
}

/// Asks whether the new transcript is right.
fn review(tested: &mut Tested) {
    let transcript = match &tested.verdict {
        Verdict::Unrecorded(transcript) => {
            terminal::print(transcript);
            transcript
        }
        Verdict::Differs(_, transcript) => transcript,
        _ => return,
    };
    terminal::print("accept this transcript? [y/N] ");
    let mut answer = String::new();
    let read = io::stdin().read_line(&mut answer);
    if read.is_err() || !answer.trim().eq_ignore_ascii_case("y") {
        return;
    }
    tested.verdict = match disk::write_beside(&transcript_of(&tested.path), transcript.as_bytes()) {
        Ok(()) => Verdict::accepted(transcript),
        Err(error) => Verdict::Failed(error.to_string()),
    };
}
