//! The checkpoint of a run of scripts: what every `Eval` has answered, and what the user typed
//! between two of them. A run that resumes executes the script from its beginning; as long as it
//! asks the same, it is answered from the journal instead of by simulations, and so it comes to
//! where the earlier run was, with the same bits.
//!
//! ```text
//! file = "GAPISCR2", frame, frame, …   each with its length and its checksum
//! ```

use super::checkpoint::{Checkpoint, keep_old};
use super::identification::Request;
use crate::bail;
use crate::builtins::Failure;
use crate::diag::Diagnostic;
use crate::ga::Genomes;
use crate::identify::problem::{Fingerprint, Origins, first_frame, frame, listed};
use crate::identify::{FailedSimulation, Simulated};
use crate::language::execution::Stop;
use crate::registry::BAD_OPTION;
use crate::source::SourceId;
use crate::{Journaling, Session};
use serde::{Deserialize, Serialize};
use std::collections::VecDeque;

const FILE: &str = "script.journal";
const MAGIC: &[u8; 8] = b"GAPISCR2";

/// The journal of this session, and what it still has to answer.
#[derive(Default)]
pub(super) struct Journal {
    checkpoint: Option<Checkpoint>,
    replay: VecDeque<Entry>,
    /// What the entries depend on, as it was noted last.
    noted: Origins,
    /// What the next entry depends on, and how many sources were looked at for it.
    origins: Option<(Origins, u32)>,
    /// Answers taken from the earlier run.
    answered: usize,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
enum Entry {
    /// `Eval` was asked this and answered that.
    Simulated { asked: u64, rows: Vec<f64>, failures: Vec<(u32, String, Option<f64>)> },
    /// The user typed this.
    Typed(String),
    /// What the next answers depend on: the Modelica sources read so far, and the program.
    From(Origins),
}

/// An entry of a journal, as it is described to the user.
#[derive(Debug, Clone, PartialEq)]
pub enum ScriptEntry {
    /// A call of `Eval`: the number of simulated values, and of individuals that failed.
    Simulated {
        /// Values that were simulated.
        values: usize,
        /// Individuals that could not be simulated.
        failures: usize,
    },
    /// What the user typed.
    Typed(String),
    /// What the next entries depend on.
    From(Origins),
}

/// The entries of a journal, and how many bytes at its end are damaged or were not finished; `None` for
/// another kind of file.
pub fn read_script_journal(bytes: &[u8]) -> Option<(Vec<ScriptEntry>, usize)> {
    let (entries, whole) = decode(bytes)?;
    let described = |entry| match entry {
        Entry::Simulated { rows, failures, .. } => {
            ScriptEntry::Simulated { values: rows.len(), failures: failures.len() }
        }
        Entry::Typed(line) => ScriptEntry::Typed(line),
        Entry::From(origins) => ScriptEntry::From(origins),
    };
    Some((entries.into_iter().map(described).collect(), bytes.len() - whole))
}

impl Session {
    /// What an earlier run was answered to the same question; `None` when it did not come so far.
    ///
    /// # Errors
    ///
    /// The earlier run was asked something else.
    pub(super) fn journaled(
        &mut self,
        request: &Request,
        settings: &str,
        genomes: &Genomes,
    ) -> Result<Option<Simulated>, Failure> {
        let (seconds, resumes) = match self.options.journaling {
            Journaling::Off => return Ok(None),
            Journaling::Fresh(seconds) => (seconds, false),
            Journaling::Resume(seconds) => (seconds, true),
        };
        if self.extension::<Journal>().checkpoint.is_none() {
            self.open_journal(seconds, resumes)?;
        }
        self.compare_origins()?;
        let Some(entry) = self.extension::<Journal>().replay.pop_front() else { return Ok(None) };
        match entry {
            Entry::Simulated { asked, rows, failures }
                if asked == fingerprint(request, settings, genomes)
                    && rows.len() == genomes.len() * request.question.x.len() =>
            {
                let mut all = vec![None; genomes.len()];
                for (k, cause, time) in failures {
                    if let Some(place) = all.get_mut(k as usize) {
                        *place = Some(FailedSimulation { cause, time });
                    }
                }
                Ok(Some(Simulated { rows, failures: all }))
            }
            _ => {
                self.refuse_to_resume();
                bail!(
                    BAD_OPTION,
                    "the script requests other simulations here than the run to be resumed";
                    help: "run the same script with the same data and settings, or start again \
                           without `--resume`"
                )
            }
        }
    }

    /// Notes what was simulated.
    pub(super) fn journal(
        &mut self,
        request: &Request,
        settings: &str,
        genomes: &Genomes,
        simulated: &Simulated,
    ) {
        if self.options.journaling == Journaling::Off {
            return;
        }
        let origins = self.origins();
        if self.extension::<Journal>().noted != origins {
            self.note_entry(&Entry::From(origins.clone()), false);
            self.extension::<Journal>().noted = origins;
        }
        let failed = simulated.failures.iter().enumerate();
        let failures = failed.filter_map(|(k, failed)| {
            failed.as_ref().map(|failed| (k as u32, failed.cause.clone(), failed.time))
        });
        let entry = Entry::Simulated {
            asked: fingerprint(request, settings, genomes),
            rows: simulated.rows.clone(),
            failures: failures.collect(),
        };
        self.note_entry(&entry, false);
    }

    /// Notes what the user typed during a pause.
    pub(crate) fn journal_typed(&mut self, line: &str) {
        self.note_entry(&Entry::Typed(line.to_owned()), true);
    }

    /// What the user typed here in the run that is resumed.
    pub(crate) fn typed_before(&mut self) -> Option<String> {
        match self.extension::<Journal>().replay.pop_front()? {
            Entry::Typed(line) => Some(line),
            other => {
                self.extension::<Journal>().replay.push_front(other);
                None
            }
        }
    }

    /// What the next entry depends on.
    fn origins(&mut self) -> Origins {
        let known = self.extension::<Journal>().origins.take();
        let (mut origins, mut seen) = known.unwrap_or_else(|| (Origins::new(), 0));
        self.add_models_read(&mut origins, &mut seen);
        self.extension::<Journal>().origins = Some((origins.clone(), seen));
        origins
    }

    /// The Modelica sources that were read from the source number `seen` on, as files to name when they
    /// change.
    pub(crate) fn add_models_read(&self, origins: &mut Origins, seen: &mut u32) {
        while let Some(source) = self.sources.get(SourceId(*seen)) {
            *seen += 1;
            if source.name.ends_with(".mo") {
                origins.add_modelica(format!("`{}`", source.name), &source.text);
            }
        }
    }

    /// The next answers of the earlier run depend on what this run depends on.
    fn compare_origins(&mut self) -> Result<(), Failure> {
        while let Some(Entry::From(before)) = self.extension::<Journal>().replay.front() {
            let before = before.clone();
            self.extension::<Journal>().replay.pop_front();
            let changed = self.origins().changed_since(&before);
            if !changed.is_empty() {
                self.refuse_to_resume();
                bail!(
                    BAD_OPTION,
                    "the run cannot be resumed: these have changed since: {}", listed(&changed);
                    help: "undo the changes, or start again without `--resume`"
                );
            }
            self.extension::<Journal>().noted = before;
        }
        Ok(())
    }

    /// The earlier run is another one: nothing more is done, and its checkpoint stays as it is.
    pub(crate) fn refuse_to_resume(&mut self) {
        self.extension::<Journal>().checkpoint = None;
        self.execution.stop_for(Stop::Error);
    }

    /// Whether the answer taken last from the earlier run is to be computed again: the first and
    /// the last are.
    pub(crate) fn is_to_be_checked(&mut self) -> bool {
        let journal = self.extension::<Journal>();
        journal.answered += 1;
        let is_answer = |entry: &Entry| matches!(entry, Entry::Simulated { .. });
        journal.answered == 1 || !journal.replay.iter().any(is_answer)
    }

    fn note_entry(&mut self, entry: &Entry, at_once: bool) {
        let Some(mut checkpoint) = self.extension::<Journal>().checkpoint.take() else { return };
        let now = self.world.monotonic_seconds();
        // Numbers and strings only.
        let payload = postcard::to_allocvec(entry).unwrap_or_default();
        checkpoint.note(self, &frame(&payload), now);
        if at_once {
            checkpoint.flush(self, now);
        }
        self.extension::<Journal>().checkpoint = Some(checkpoint);
    }

    fn open_journal(&mut self, seconds: f64, resumes: bool) -> Result<(), Failure> {
        let path = self.world.output_dir().join(FILE);
        let now = self.world.monotonic_seconds();
        let mut checkpoint = Checkpoint::new(path.clone(), (None, seconds), now);
        let exists = self.world.exists(&path);
        if exists && resumes {
            let old = self.read_bytes(&path)?;
            let Some((entries, whole)) = decode(&old) else {
                bail!(BAD_OPTION, "`{}` is not a checkpoint of a \
                                   script", path.display(); help: "start again without `--resume`")
            };
            let generations =
                entries.iter().filter(|entry| matches!(entry, Entry::Simulated { .. })).count();
            self.extension::<Journal>().replay = entries.into();
            self.write_safely(&path, &old[..whole])?;
            checkpoint = checkpoint.after(old[..whole].to_vec());
            self.world.eprint(&format!(
                "resumed: {generations} calls of Eval are replayed from `{}`\n",
                path.display()
            ));
        } else {
            if exists {
                let old = keep_old(self, &path)?;
                let text = format!(
                    "an earlier run did not finish; `--resume` would have continued it. Its \
                     checkpoint is kept in `{}`\n",
                    old.display()
                );
                self.world.eprint(&text);
            }
            checkpoint.begin(MAGIC);
        }
        self.extension::<Journal>().checkpoint = Some(checkpoint);
        self.at_end(close);
        Ok(())
    }
}

/// The run has ended: the journal goes, unless something is left to go on with.
fn close(session: &mut Session) -> Result<(), Diagnostic> {
    let Some(mut checkpoint) = session.extension::<Journal>().checkpoint.take() else {
        return Ok(());
    };
    let is_written = session.world.exists(checkpoint.path());
    let has_errors = session.output.messages.unread_errors() > 0;
    if session.is_interrupted() || (has_errors && is_written) {
        let now = session.world.monotonic_seconds();
        checkpoint.secure(session, now);
        session.world.eprint("resume the run from here with --resume\n");
    } else if is_written {
        // What cannot be removed does no harm.
        let _ = session.world.remove(checkpoint.path());
    }
    Ok(())
}

/// The entries that are whole, and the bytes that they take; `None` for another kind of file.
fn decode(bytes: &[u8]) -> Option<(Vec<Entry>, usize)> {
    let mut rest = bytes.strip_prefix(MAGIC)?;
    let mut entries = Vec::new();
    while let Some((payload, others)) = first_frame(rest) {
        let Ok(entry) = postcard::from_bytes(payload) else { break };
        entries.push(entry);
        rest = others;
    }
    Some((entries, bytes.len() - rest.len()))
}

fn fingerprint(request: &Request, settings: &str, genomes: &Genomes) -> u64 {
    let mut fingerprint = Fingerprint::default();
    let question = &request.question;
    let asked = [&request.path, &request.model, &question.x_name, &question.y_name];
    for text in asked.map(String::as_str).into_iter().chain([settings]) {
        fingerprint.add(text.as_bytes());
        fingerprint.add(&[0]);
    }
    question.parameters.iter().for_each(|name| fingerprint.add(name.as_bytes()));
    fingerprint.add_numbers(&question.x);
    fingerprint.add_numbers(genomes.values());
    fingerprint.number()
}
