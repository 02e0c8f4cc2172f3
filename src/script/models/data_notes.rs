//! What is said about the data that scripts compare their models with: now, and in the report of the
//! run.

use crate::Session;
use crate::diag::Code;
use crate::mat::{self, MatFile};

/// What was said of the data of a run.
#[derive(Default)]
pub(crate) struct DataNotes {
    sentences: Vec<String>,
    /// How many of these are older than the measurement read last.
    older: usize,
}

impl DataNotes {
    fn add(&mut self, sentence: &str) {
        if !self.sentences.iter().any(|known| known == sentence) {
            self.sentences.push(sentence.to_owned());
        }
    }

    /// Another measurement is read.
    pub(crate) fn begin_measurement(&mut self) {
        self.older = self.sentences.len();
    }

    /// What was said of the measurement read last, which belongs to another run.
    pub(crate) fn split_off_measurement(&mut self) -> Vec<String> {
        self.sentences.split_off(self.older)
    }

    /// Another run begins, of whose data this was said.
    pub(crate) fn begin_run(&mut self, sentences: Vec<String>) {
        self.sentences = sentences;
    }

    /// What was said, for the report.
    pub(crate) fn all(&self) -> &[String] {
        &self.sentences
    }
}

impl Session {
    /// Says what should be known of data that were read: notes about the columns, and in a table the
    /// lines that were left out.
    pub(crate) fn note_data(&mut self, file: &MatFile, notes: impl IntoIterator<Item = String>) {
        let general = file.warnings.iter().filter(|_| file.is_table()).cloned();
        let all: Vec<String> = general.chain(notes).collect();
        for sentence in all {
            let sentence = match file.file_name.as_str() {
                "" => sentence,
                name => format!("{name}: {sentence}"),
            };
            self.note_about_data(mat::errors::DATA_NOTE, sentence);
        }
    }

    /// Says something about the data that a script compares its models with: now and in the report.
    pub(crate) fn note_about_data(&mut self, code: Code, sentence: String) {
        self.extension::<DataNotes>().add(&sentence);
        self.note(code, sentence);
    }
}
