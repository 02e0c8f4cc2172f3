//! The checkpoint of a run of scripts: what every `Eval` has answered, and what the user typed
//! between two of them. A run that resumes executes the script from its beginning; as long as it
//! asks the same, it is answered from the journal instead of by simulations, and so it comes to
//! where the earlier run was, with the same bits.
//!
//! ```text
//! file = "GAPISCR1", frame, frame, …   each with its length and its checksum
//! ```

use super::builtins::Failure;
use super::checkpoint::Checkpoint;
use super::identification::Request;
use super::{Journaling, Session};
use crate::bail;
use crate::diag::Diagnostic;
use crate::ga::Genomes;
use crate::identify::problem::{Fingerprint, first_frame, frame};
use crate::identify::{FailedSimulation, Simulated};
use crate::registry::BAD_OPTION;
use serde::{Deserialize, Serialize};
use std::collections::VecDeque;
use std::path::Path;

const FILE: &str = "script.journal";
/// Where the journal of an earlier run is kept when a new one takes its place.
const OLD: &str = "script.journal.old";
const MAGIC: &[u8; 8] = b"GAPISCR1";

/// The journal of this session, and what it still has to answer.
#[derive(Default)]
pub(super) struct Journal {
    checkpoint: Option<Checkpoint>,
    replay: VecDeque<Entry>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
enum Entry {
    /// `Eval` was asked this and answered that.
    Simulated { asked: u64, rows: Vec<f64>, failures: Vec<(u32, String, Option<f64>)> },
    /// The user typed this.
    Typed(String),
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
        let Some(entry) = self.extension::<Journal>().replay.pop_front() else { return Ok(None) };
        match entry {
            Entry::Simulated { asked, rows, failures }
                if asked == fingerprint(request, genomes)
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
            _ => bail!(
                BAD_OPTION,
                "the script asks something else here than the run that is to be resumed";
                help: "run the same script with the same data and settings, or begin anew without `--resume`"
            ),
        }
    }

    /// Notes what was simulated.
    pub(super) fn journal(&mut self, request: &Request, genomes: &Genomes, simulated: &Simulated) {
        if self.options.journaling == Journaling::Off {
            return;
        }
        let failed = simulated.failures.iter().enumerate();
        let failures = failed.filter_map(|(k, failed)| {
            failed.as_ref().map(|failed| (k as u32, failed.cause.clone(), failed.time))
        });
        let entry = Entry::Simulated {
            asked: fingerprint(request, genomes),
            rows: simulated.rows.clone(),
            failures: failures.collect(),
        };
        self.note_entry(&entry, false);
    }

    /// Notes what the user typed during a pause.
    pub(super) fn journal_typed(&mut self, line: &str) {
        self.note_entry(&Entry::Typed(line.to_owned()), true);
    }

    /// What the user typed here in the run that is resumed.
    pub(super) fn typed_before(&mut self) -> Option<String> {
        match self.extension::<Journal>().replay.pop_front()? {
            Entry::Typed(line) => Some(line),
            other => {
                self.extension::<Journal>().replay.push_front(other);
                None
            }
        }
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
                bail!(BAD_OPTION, "`{}` is no checkpoint of a script", path.display(); help: "begin anew without `--resume`")
            };
            let generations =
                entries.iter().filter(|entry| matches!(entry, Entry::Simulated { .. })).count();
            self.extension::<Journal>().replay = entries.into();
            self.write_file(&path, &old[..whole])?;
            self.world.eprint(&format!(
                "resumed: {generations} calls of Eval are answered by `{}`\n",
                path.display()
            ));
        } else {
            if exists {
                self.keep_old(&path)?;
            }
            checkpoint.begin(MAGIC);
        }
        self.extension::<Journal>().checkpoint = Some(checkpoint);
        self.at_end(close);
        Ok(())
    }

    fn keep_old(&mut self, path: &Path) -> Result<(), Failure> {
        let old = path.with_file_name(OLD);
        let bytes = self.read_bytes(path)?;
        self.write_file(&old, &bytes)?;
        // What cannot be removed is written over.
        let _ = self.world.remove(path);
        let text = format!(
            "an earlier run did not end, and `--resume` would have gone on with it; its checkpoint is kept in `{}`\n",
            old.display()
        );
        self.world.eprint(&text);
        Ok(())
    }
}

/// The run has ended: the journal goes, unless something is left to go on with.
fn close(session: &mut Session) -> Result<(), Diagnostic> {
    let Some(mut checkpoint) = session.extension::<Journal>().checkpoint.take() else {
        return Ok(());
    };
    let is_written = session.world.exists(checkpoint.path());
    let has_errors = session.messages.unread_errors() > 0;
    if session.is_interrupted() || (has_errors && is_written) {
        let now = session.world.monotonic_seconds();
        checkpoint.flush(session, now);
        session.world.eprint("the run can go on from here with --resume\n");
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

fn fingerprint(request: &Request, genomes: &Genomes) -> u64 {
    let mut fingerprint = Fingerprint::default();
    let question = &request.question;
    for text in [&request.path, &request.model, &question.x_name, &question.y_name] {
        fingerprint.add(text.as_bytes());
        fingerprint.add(&[0]);
    }
    question.parameters.iter().for_each(|name| fingerprint.add(name.as_bytes()));
    fingerprint.add_numbers(&question.x);
    fingerprint.add_numbers(genomes.values());
    fingerprint.number()
}
