//! Further searches of one problem with other seeds, each with a journal of its own; the best of all
//! becomes the run that statistics are made of.

use super::RunOptions;
use super::build::Built;
use super::file::ProblemFile;
use super::run_journal::{Journalled, open};
use super::search::{Ending, Search};
use crate::Session;
use crate::diag::Fault;
use crate::ga::Mrg32k3a;
use crate::identify::problem::{Run, SolvedSearch, best_of, decode};
use crate::registry::BAD_OPTION;
use crate::{bail, fault};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// Streams of the random numbers between two searches; one search uses some dozens.
const STREAMS: u64 = 1 << 32;
/// The largest number of searches.
pub(super) const MOST: usize = 100_000;
/// What the parts of shards are called.
const KIND: &str = "searches";

/// Makes the problem again, with a change.
pub(super) type Again<'a> = dyn FnMut(&mut Session, Change<'_>) -> Result<Built, Fault> + 'a;

/// What is changed where a problem is made again.
pub(super) enum Change<'a> {
    /// The seed, for all that is made from then on.
    Seed([f64; 6]),
    /// Entries of the file, this once.
    Entries(&'a dyn Fn(&mut ProblemFile)),
}

/// A finished search with its journal, from which it can be made again.
#[derive(Serialize, Deserialize)]
struct Finished {
    search: SolvedSearch,
    journal: Vec<u8>,
}

/// What all searches came to.
pub(super) struct Searched {
    /// The best of them.
    pub run: Run,
    /// How it ended, or that the user has ended one.
    pub ending: Ending,
    /// All; empty where only one was requested, or others belong to other shards.
    pub all: Vec<SolvedSearch>,
    /// What the searches of this process took.
    pub seconds: f64,
}

/// The seed of search `number`, the first of which has the problem's own.
fn seed(own: &[f64; 6], number: usize) -> Result<[f64; 6], Fault> {
    Ok(Mrg32k3a::new(own)?.stream(STREAMS * number as u64).state())
}

/// The journal of a search after the first.
pub(super) fn journal(folder: &Path, number: usize) -> PathBuf {
    folder.join(format!("run-{number}.journal"))
}

/// Refuses journals of an earlier run before anything is simulated.
///
/// # Errors
///
/// `bad-option` where there is one that is neither to be resumed nor to be discarded.
pub(super) fn refuse_leftovers(
    session: &Session,
    folder: &Path,
    options: &RunOptions,
) -> Result<(), Fault> {
    let all = (2..=options.searches.unwrap_or(1)).map(|number| journal(folder, number));
    let mut left = all.filter(|path| session.world.exists(path));
    match left.next() {
        Some(path) if !options.resume && !options.fresh => bail!(
            BAD_OPTION,
            "`{}` contains an earlier run that did not finish", path.display();
            help: "continue it with `--resume`, or discard it with `--fresh`"
        ),
        _ => Ok(()),
    }
}

/// Searches as often as requested, `first` included.
///
/// # Errors
///
/// Several objectives; faults that every further evaluation would have as well.
pub(super) fn search_on(
    session: &mut Session,
    (first, ending): (Run, Ending),
    files: &Journalled<'_>,
    options: &RunOptions,
    again: &mut Again<'_>,
) -> Result<Searched, Fault> {
    let count = options.searches.unwrap_or(1);
    let seconds = first.seconds;
    let mut searched = Searched { run: first, ending, all: Vec::new(), seconds };
    if count < 2 || searched.ending.is_interrupted {
        return Ok(searched);
    }
    if searched.run.problem.objectives.len() > 1 {
        bail!(BAD_OPTION, "`searches` compares one objective, and this problem has several"; help: "leave one `fitness`, or search once");
    }
    let own = searched.run.problem.seed;
    let missing = searched.run.evaluation.parts.missing::<Finished>((KIND, &own), count - 1);
    let mut finished = Vec::new();
    for part in missing {
        let number = part + 1;
        let built = again(session, Change::Seed(seed(&own, number)?))?;
        let path = journal(files.folder, number + 1);
        session.print(&format!("search {} of {count}\n", number + 1));
        let run = Run::on(built.problem, &session.world.processors())?;
        let run = searched_to_end(session, run, &path, files, options)?;
        let Some(run) = run else {
            let reason = "interrupted: these are the best values of the first search".to_owned();
            searched.ending = Ending { reason, is_interrupted: true };
            return Ok(searched);
        };
        searched.seconds += run.seconds;
        let journal = session.world.read_bytes(&path)?;
        finished.push((part, Finished { search: SolvedSearch::of(&run), journal }));
    }
    let parts = &searched.run.evaluation.parts;
    match parts.complete((KIND, &own), count - 1, finished) {
        Some(others) => go_to_best(session, searched, others, again),
        None => {
            session.print("Some searches belong to other shards.\n");
            Ok(searched)
        }
    }
}

/// Searches once, or continues where the journal ends; `None` where the user has ended it.
fn searched_to_end(
    session: &mut Session,
    mut run: Run,
    path: &Path,
    files: &Journalled<'_>,
    options: &RunOptions,
) -> Result<Option<Run>, Fault> {
    let checkpoint = open(session, &mut run, (path, None), files, options)?;
    let mut search = Search::new(session, run, checkpoint, options.watch.clone());
    let ending = search.run_to_end(session)?;
    if let Some(why) = search.checkpoint.broken() {
        bail!(BAD_OPTION, "`{}` could not be written: {why}", path.display());
    }
    Ok(Some(search.run).filter(|_| !ending.is_interrupted))
}

/// Makes the best search the one that counts.
fn go_to_best(
    session: &mut Session,
    mut searched: Searched,
    others: Vec<Finished>,
    again: &mut Again<'_>,
) -> Result<Searched, Fault> {
    let mut all = vec![SolvedSearch::of(&searched.run)];
    all.extend(others.iter().map(|own| own.search.clone()));
    let best = best_of(&searched.run, &mut all);
    searched.all = all;
    let Some(Finished { search, journal }) = best.and_then(|best| others.get(best.wrapping_sub(1)))
    else {
        return Ok(searched);
    };
    let built = again(session, Change::Seed(search.seed))?;
    let mut run = Run::on(built.problem, &session.world.processors())?;
    run.evaluation.parts = std::mem::take(&mut searched.run.evaluation.parts);
    let journal = decode(journal);
    let journal = journal.ok_or_else(|| fault!(BAD_OPTION, "the journal of a search is lost"))?;
    run.resume(&journal.records())?;
    let reason = run.stop().unwrap_or_else(|| "the search ended".to_owned());
    searched.run = run;
    searched.ending = Ending { reason, is_interrupted: false };
    Ok(searched)
}
