//! A model as it is kept.

use super::reads::{Answers, Digest, Question, Watched, ask};
use crate::Session;
use crate::codegen::{Program, bytes_of};
use crate::diag::Diagnostic;
use crate::models::translated::{Declarations, Translated};
use crate::name::Ident;
use crate::source::{SourceId, with_source_table, with_sources};
use crate::syntax;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeSet, HashMap};
use std::path::PathBuf;

/// A model, and what must be as it was.
#[derive(Serialize, Deserialize)]
pub(super) struct Entry {
    answers: Answers,
    searches: Vec<(Ident, bool)>,
    /// The history of the classes after the translation.
    after: Digest,
    sources: Vec<Text>,
    roots: BTreeSet<Ident>,
    /// The files that the model itself reads, some of the answers.
    files: Answers,
    /// Declarations, program and warnings.
    content: Vec<u8>,
}

/// A text in which something of the model is written.
#[derive(Serialize, Deserialize)]
enum Text {
    /// Of a file among the answers, as it is shown.
    File(String, PathBuf),
    /// Another one: name and content.
    Other(String, String),
}

impl Entry {
    /// The bytes of an entry; `None` where the model cannot be kept.
    pub(super) fn of(
        session: &Session,
        model: &Translated,
        warnings: &[Diagnostic],
    ) -> Option<Vec<u8>> {
        let (content, noted) = with_source_table(|| {
            let program = model.program.to_bytes()?;
            bytes_of(&(&model.declarations, program, warnings))
        });
        let sources = noted.into_iter().map(|source| text_of(session, source));
        let entry = Entry {
            answers: session.classes.reads.answers()?,
            searches: session.classes.history.searches().to_vec(),
            after: session.classes.history.digest(),
            sources: sources.collect::<Option<_>>()?,
            roots: model.roots.clone(),
            files: model.files.clone(),
            content: content?,
        };
        bytes_of(&entry)
    }

    pub(super) fn read(bytes: &[u8]) -> Option<Entry> {
        postcard::from_bytes(bytes).ok()
    }

    /// The sources of the entry, if the disk answers as it did.
    pub(super) fn sources_if_unchanged(&self, session: &Session) -> Option<Vec<SourceId>> {
        let files = Watched::new(session.world.reader(), session.classes.reads.clone());
        let variable = |name: &str| session.variable_of_models(name);
        let mut contents = HashMap::new();
        for (question, answer) in &self.answers {
            let (now, bytes) = ask(&files, &variable, question);
            if now != *answer {
                return None;
            }
            if let (Question::Read(path), Some(bytes)) = (question, bytes) {
                contents.insert(path, bytes);
            }
        }
        // What this session has read before must be the same, too.
        session.classes.reads.answers()?;
        let sources = self.sources.iter().map(|text| match text {
            Text::File(shown, path) => {
                let (text, _) = syntax::decode(contents.get(path)?);
                let source = session.sources.add(shown.as_str(), text);
                session.classes.reads.note_text(source, path);
                Some(source)
            }
            Text::Other(name, text) => {
                let known = session.sources.find(name, text);
                Some(known.unwrap_or_else(|| session.sources.add(name.as_str(), text.as_str())))
            }
        });
        sources.collect()
    }

    /// Searches for the classes that the translation searched for; whether the same were found.
    pub(super) fn repeats_searches(&self, session: &mut Session) -> bool {
        let same = self.searches.iter().all(|(name, is_loaded)| {
            session.autoload_class(*name).is_ok_and(|found| found == *is_loaded)
        });
        same && session.classes.history.digest() == self.after
    }

    /// The model with the warnings about it.
    pub(super) fn model(
        &self,
        problem: &str,
        sources: Vec<SourceId>,
    ) -> Option<(Translated, Vec<Diagnostic>)> {
        with_sources(sources, || {
            let (declarations, program, warnings): (Declarations, &[u8], Vec<Diagnostic>) =
                postcard::from_bytes(&self.content).ok()?;
            let program = Program::from_bytes(program)?;
            let model = Translated::without_flat_model(problem, declarations, program);
            let (roots, files) = (self.roots.clone(), self.files.clone());
            Some((Translated { roots, files, ..model }, warnings))
        })
    }
}

fn text_of(session: &Session, source: SourceId) -> Option<Text> {
    let known = session.sources.get(source)?;
    let name = known.name.to_string();
    Some(match session.classes.reads.file_of(source) {
        Some(path) => Text::File(name, path),
        None => Text::Other(name, known.text.to_string()),
    })
}
