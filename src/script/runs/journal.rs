//! The checkpoint of a run of scripts: what every `Eval` has answered, and what the user typed
//! between two of them. A run that resumes executes the script from its beginning; as long as it
//! asks the same, it is answered from the journal instead of by simulations, and so it comes to
//! where the earlier run was, with the same bits.

use super::checkpoint::{Checkpoint, keep_old, refused};
use super::identification::Request;
use crate::bail;
use crate::builtins::Failure;
use crate::diag::Diagnostic;
use crate::ga::Genomes;
use crate::identify::Simulated;
use crate::identify::problem::{Entry, Fingerprint, Origins, begin, decode, listed};
use crate::language::execution::Stop;
use crate::registry::BAD_OPTION;
use crate::source::SourceId;
use crate::{Journaling, Session};
use std::borrow::Cow;
use std::collections::VecDeque;

const FILE: &str = "script.journal";

/// The journal of this session, and what it still has to answer.
#[derive(Default)]
pub(super) struct Journal {
    checkpoint: Option<Checkpoint>,
    replay: VecDeque<Entry<'static>>,
    /// What the entries depend on, as it was noted last.
    noted: Origins,
    /// What the next entry depends on, and how many sources were looked at for it.
    origins: Option<(Origins, u32)>,
    /// Answers taken from the earlier run.
    answered: usize,
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
                for (k, failed) in failures {
                    if let Some(place) = all.get_mut(k as usize) {
                        *place = Some(failed);
                    }
                }
                Ok(Some(Simulated { rows: rows.into_owned(), failures: all }))
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
            self.note_entry(&Entry::From(Cow::Borrowed(&origins)), false);
            self.extension::<Journal>().noted = origins;
        }
        let failed = simulated.failures.iter().enumerate();
        let failures = failed.filter_map(|(k, failed)| Some((k as u32, failed.clone()?)));
        let entry = Entry::Simulated {
            asked: fingerprint(request, settings, genomes),
            rows: Cow::Borrowed(&simulated.rows),
            failures: failures.collect(),
        };
        self.note_entry(&entry, false);
    }

    /// Notes what the user typed during a pause.
    pub(crate) fn journal_typed(&mut self, line: &str) {
        self.note_entry(&Entry::Typed(Cow::Borrowed(line)), true);
    }

    /// What the user typed here in the run that is resumed.
    pub(crate) fn typed_before(&mut self) -> Option<String> {
        match self.extension::<Journal>().replay.pop_front()? {
            Entry::Typed(line) => Some(line.into_owned()),
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
            let before = before.as_ref().clone();
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
        let is_answer = |entry: &Entry<'_>| matches!(entry, Entry::Simulated { .. });
        journal.answered == 1 || !journal.replay.iter().any(is_answer)
    }

    fn note_entry(&mut self, entry: &Entry<'_>, at_once: bool) {
        let Some(mut checkpoint) = self.extension::<Journal>().checkpoint.take() else { return };
        let now = self.world.monotonic_seconds();
        checkpoint.note(self, &entry.to_bytes(), now);
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
            let old = self.world.read_bytes(&path)?;
            let Some(journal) = decode(&old) else {
                let refused = refused(&path, &old);
                return Err(refused.help("start again without `--resume`").into());
            };
            let is_answer = |entry: &&Entry<'_>| matches!(entry, Entry::Simulated { .. });
            let generations = journal.entries.iter().filter(is_answer).count();
            self.extension::<Journal>().replay = journal.entries.into();
            self.world.write_safely(&path, &old[..journal.whole])?;
            checkpoint = checkpoint.after(old[..journal.whole].to_vec());
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
            checkpoint.begin(&begin());
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
