//! What was asked of the disk, and what it answered.

use crate::source::SourceId;
use crate::world::FileReader;
use serde::{Deserialize, Serialize};
use sha2::{Digest as _, Sha256};
use std::collections::{BTreeMap, HashMap};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

/// SHA-256.
pub(crate) type Digest = [u8; 32];

/// The digest of bytes.
pub(in crate::models) fn digest(bytes: &[u8]) -> Digest {
    Sha256::digest(bytes).into()
}

/// A question to the disk.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub(crate) enum Question {
    /// What is in a file.
    Read(PathBuf),
    /// What lies in a folder.
    List(PathBuf),
    /// Whether there is a file.
    IsFile(PathBuf),
    /// What is in an environment variable.
    Variable(String),
}

/// The digest of what was found, if there was anything.
pub(crate) type Answer = Option<Digest>;

/// Questions with their answers.
pub(crate) type Answers = BTreeMap<Question, Answer>;

/// All questions of a session with their answers; clones note together.
#[derive(Debug, Clone, Default)]
pub struct Reads(Arc<Mutex<Notes>>);

#[derive(Debug, Default)]
struct Notes {
    answers: Answers,
    /// Whether a question had two answers: classes may come from what is there no longer.
    has_changed: bool,
    /// The files of sources.
    files: HashMap<SourceId, PathBuf>,
}

impl Reads {
    fn notes(&self) -> std::sync::MutexGuard<'_, Notes> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// A text was read from a file.
    pub(crate) fn note_text(&self, source: SourceId, path: &Path) {
        self.notes().files.insert(source, path.to_owned());
    }

    pub(in crate::models) fn file_of(&self, source: SourceId) -> Option<PathBuf> {
        self.notes().files.get(&source).cloned()
    }

    /// The answers, if none has changed meanwhile.
    pub(super) fn answers(&self) -> Option<Answers> {
        let notes = self.notes();
        (!notes.has_changed).then(|| notes.answers.clone())
    }

    /// What was asked, with the last answers.
    pub(in crate::models) fn last_answers(&self) -> Answers {
        self.notes().answers.clone()
    }

    /// An environment variable was read.
    pub(crate) fn note_variable(&self, name: &str, content: Option<&str>) {
        self.note(Question::Variable(name.to_owned()), of_content(content));
    }

    fn note(&self, question: Question, answer: Answer) {
        let mut notes = self.notes();
        let former = notes.answers.insert(question, answer);
        notes.has_changed |= former.is_some_and(|former| former != answer);
    }
}

/// A reader of files whose questions are noted.
#[derive(Debug)]
pub struct Watched {
    files: Arc<dyn FileReader>,
    reads: Reads,
}

impl Watched {
    /// A reader whose questions are noted.
    pub fn new(files: Arc<dyn FileReader>, reads: Reads) -> Watched {
        Watched { files, reads }
    }
}

fn of_names(names: &io::Result<Vec<String>>) -> Answer {
    names.as_ref().ok().map(|names| digest(names.join("\n").as_bytes()))
}

fn of_content(content: Option<&str>) -> Answer {
    content.map(|content| digest(content.as_bytes()))
}

fn of_whether(is_there: bool) -> Answer {
    is_there.then_some(Digest::default())
}

impl FileReader for Watched {
    fn read(&self, path: &Path) -> io::Result<Vec<u8>> {
        let bytes = self.files.read(path);
        let answer = bytes.as_ref().ok().map(|bytes| digest(bytes));
        self.reads.note(Question::Read(path.to_owned()), answer);
        bytes
    }

    fn list_dir(&self, path: &Path) -> io::Result<Vec<String>> {
        let names = self.files.list_dir(path);
        self.reads.note(Question::List(path.to_owned()), of_names(&names));
        names
    }

    fn is_file(&self, path: &Path) -> bool {
        let is_file = self.files.is_file(path);
        self.reads.note(Question::IsFile(path.to_owned()), of_whether(is_file));
        is_file
    }
}

/// Asks a question again; with the bytes of a file that was read.
pub(super) fn ask(
    files: &dyn FileReader,
    variable: &dyn Fn(&str) -> Option<String>,
    question: &Question,
) -> (Answer, Option<Vec<u8>>) {
    match question {
        Question::Read(path) => {
            let bytes = files.read(path).ok();
            (bytes.as_deref().map(digest), bytes)
        }
        Question::List(path) => (of_names(&files.list_dir(path)), None),
        Question::IsFile(path) => (of_whether(files.is_file(path)), None),
        Question::Variable(name) => (of_content(variable(name).as_deref()), None),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_is_known_once_an_answer_has_changed() {
        let reads = Reads::default();
        let question = || Question::Read(PathBuf::from("/a.mo"));
        reads.note(question(), Some(digest(b"one")));
        reads.note(question(), Some(digest(b"one")));
        assert_eq!(reads.answers().map(|answers| answers.len()), Some(1));
        reads.note(question(), Some(digest(b"two")));
        assert_eq!(reads.answers(), None);
        reads.note(question(), Some(digest(b"two")));
        assert_eq!(reads.answers(), None, "a class may still be that of the first text");
    }
}
