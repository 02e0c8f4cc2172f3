//! `gapi journal`: what a checkpoint, a part of a study or a trace holds.

use super::named;
use super::terminal;
use crate::diag::visible;
use clap::{Args, ValueHint};
use gapilib_identify::problem::{Entry, Origins, Record, ShardFile, decode};
use gapilib_script::teach::Trace;
use std::fmt::Write as _;
use std::path::PathBuf;
use std::process::ExitCode;

/// Arguments of `gapi journal`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  gapi journal results/fit/run.journal          the checkpoint of `gapi identify`
  gapi journal results/GAPILib/script.journal   the checkpoint of `gapi run`
  gapi journal s3/shard.part                    a part of a study (`gapi identify --shard`)
  gapi journal my.trace                         the steps of a genetic algorithm (`gapi run --trace`)

Exit code: 0 if the file is whole, 1 if it cannot be read or its end is damaged.")]
pub(super) struct JournalArgs {
    /// The file
    #[arg(value_hint = ValueHint::FilePath)]
    pub file: PathBuf,
}

/// What a file holds, line by line, and the bytes at its end that are damaged or were not finished.
struct Described {
    text: String,
    lost: usize,
}

/// Prints what the file holds.
pub(super) fn journal(arguments: &JournalArgs) -> ExitCode {
    let name = arguments.file.display();
    let refused = |message: String| {
        terminal::eprint(&format!("error: {message}\n"));
        ExitCode::FAILURE
    };
    let bytes = match named::read(&arguments.file) {
        Ok(bytes) => bytes,
        Err(error) => {
            return refused(format!(
                "cannot read `{name}`: {error}\n = help: a run that comes to its end removes its \
                 checkpoint"
            ));
        }
    };
    let readers = [of_search, of_shard, of_trace];
    let Some(described) = readers.into_iter().find_map(|read| read(&bytes)) else {
        return refused(format!(
            "`{name}` is not a journal that this version of gapi has written\n = help: give a file \
             `run.journal`, `script.journal`, `shard.part` or a trace"
        ));
    };
    terminal::print(&visible(&described.text));
    match described.lost {
        0 => ExitCode::SUCCESS,
        lost => refused(format!(
            "{lost} bytes at the end are damaged or were not finished; a run that resumes computes \
             them again"
        )),
    }
}

/// The checkpoint of a search.
fn of_search(bytes: &[u8]) -> Option<Described> {
    let journal = decode(bytes)?;
    let lost = journal.lost;
    let is_of_script =
        |entry: &Entry<'_>| matches!(entry, Entry::Simulated { .. } | Entry::Typed(_));
    if journal.entries.iter().any(is_of_script) {
        return Some(Described { text: of_script(&journal.entries), lost });
    }
    let mut text = "a checkpoint of gapi identify\n".to_owned();
    text += &journal.origins().map_or_else(String::new, origins);
    text += &records(&journal.records());
    Some(Described { text, lost })
}

fn records(records: &[Record]) -> String {
    let answers = |count: fn(&Record) -> u64| records.iter().map(count).sum::<u64>();
    let mut text = format!(
        "{} generations: {} simulations, {} failed, {:.1} s\n",
        records.len(),
        answers(|record| record.answered.simulations),
        answers(|record| record.answered.failures.len() as u64),
        records.last().map_or(0.0, |record| record.seconds)
    );
    let objectives = records.iter().flat_map(|record| &record.answered.objectives);
    let best = objectives.copied().filter(|value| value.is_finite()).reduce(f64::min);
    if let Some(best) = best {
        _ = writeln!(text, "least objective: {best:e}");
    }
    for (at, record) in records.iter().enumerate() {
        for (setting, value) in &record.changes {
            _ = writeln!(text, "changed: {setting} = {value} before generation {}", at + 1);
        }
    }
    text
}

/// The checkpoint of a script.
fn of_script(entries: &[Entry<'_>]) -> String {
    let mut text = "a checkpoint of gapi run\n".to_owned();
    let (mut calls, mut points, mut failed) = (0, 0, 0);
    for entry in entries {
        match entry {
            Entry::Simulated { rows, failures, .. } => {
                calls += 1;
                points += rows.len();
                failed += failures.len();
            }
            Entry::Typed(line) => {
                _ = writeln!(text, "typed after call {calls} of Eval: {line}");
            }
            Entry::From(from) => text += &origins(from),
            Entry::Answered(_) => {}
        }
    }
    _ = writeln!(
        text,
        "{calls} calls of Eval: {points} simulated values, {failed} failed individuals"
    );
    text
}

/// A part of a study.
fn of_shard(bytes: &[u8]) -> Option<Described> {
    let file = ShardFile::from_bytes(bytes)?;
    let mut text =
        format!("shard {} of {} of `{}`\n", file.shard.number, file.shard.count, file.problem);
    text += &origins(&file.origins);
    for (kind, parts) in file.parts() {
        _ = writeln!(text, "{kind}: {parts} parts");
    }
    if let Some(search) = decode(&file.journal) {
        text += &records(&search.records());
    }
    Some(Described { text, lost: 0 })
}

/// A trace of a genetic algorithm.
fn of_trace(bytes: &[u8]) -> Option<Described> {
    let trace = Trace::read(bytes).ok()?;
    let mut text = "a trace of a genetic algorithm\n".to_owned();
    for script in &trace.scripts {
        _ = writeln!(text, "script: {}", script.name);
    }
    _ = writeln!(
        text,
        "{} generations; parameters: {}",
        trace.generations.len(),
        trace.subject.parameters.join(", ")
    );
    if trace.full {
        text.push_str("the run continued after the trace had reached its largest size\n");
    }
    Some(Described { text, lost: usize::from(trace.cut) })
}

fn origins(origins: &Origins) -> String {
    origins.names().map(|name| format!("depends on {name}\n")).collect()
}
