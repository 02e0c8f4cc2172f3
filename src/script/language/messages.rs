//! The buffer that `getErrorString()` and `getLastError()` read.

use crate::diag::{Diagnostic, Severity};
use crate::source::SourceMap;
use std::collections::BTreeSet;
use std::ops::Range;

/// Diagnostics since the script asked last.
#[derive(Debug, Clone, Default)]
pub struct Messages {
    unread: Vec<Diagnostic>,
    /// The number of the first unread message: they are counted from the start of the session.
    first: usize,
    /// The numbers of errors whose status the script has tested.
    tested: BTreeSet<usize>,
    last_error: Option<String>,
}

impl Messages {
    /// Adds a diagnostic.
    pub fn push(&mut self, diagnostic: Diagnostic) {
        if diagnostic.is_error() {
            self.last_error = Some(diagnostic.message.clone());
        }
        self.unread.push(diagnostic);
    }

    /// What the script has not asked for.
    pub fn unread(&self) -> &[Diagnostic] {
        &self.unread
    }

    /// The number that the next message gets.
    pub fn next_number(&self) -> usize {
        self.first + self.unread.len()
    }

    /// The script has tested the status that stands for these messages.
    pub(crate) fn note_tested(&mut self, numbers: Range<usize>) {
        self.tested.extend(numbers.start.max(self.first)..numbers.end);
    }

    /// Errors that the script has neither asked for nor tested, with their numbers.
    fn unhandled(&self) -> impl Iterator<Item = (&Diagnostic, usize)> {
        let numbered = self.unread.iter().zip(self.first..);
        numbered
            .filter(|(diagnostic, number)| diagnostic.is_error() && !self.tested.contains(number))
    }

    /// How many of them there are.
    pub(crate) fn unread_errors(&self) -> usize {
        self.unhandled().count()
    }

    /// The first of them from this number on.
    pub(crate) fn first_unhandled(&self, from: usize) -> Option<&Diagnostic> {
        self.unhandled().find(|(_, number)| *number >= from).map(|(diagnostic, _)| diagnostic)
    }

    /// Numbers of unread notes, warnings and errors.
    pub fn counts(&self) -> [usize; 3] {
        let count = |severity| self.unread.iter().filter(|d| d.severity == severity).count();
        [count(Severity::Note), count(Severity::Warning), count(Severity::Error)]
    }

    /// The unread messages, one a line, as OpenModelica's scripts expect them
    /// (`[file:l:c-l:c:writable] Error: …`); the buffer is empty afterwards.
    pub fn take_text(&mut self, sources: &SourceMap, warnings_as_errors: bool) -> String {
        let unread = self.unread.clone();
        self.clear();
        let severity = |diagnostic: &Diagnostic| match diagnostic.severity {
            Severity::Warning if warnings_as_errors => Severity::Error,
            severity => severity,
        };
        unread.iter().map(|diagnostic| line(diagnostic, severity(diagnostic), sources)).collect()
    }

    /// Notes that a command succeeded: there is no last error, but what was not read stays.
    pub(crate) fn note_success(&mut self) {
        self.last_error = None;
    }

    /// The last error's message since the last call or the last success.
    pub(crate) fn take_last_error(&mut self) -> String {
        let last = self.last_error.take().unwrap_or_default();
        self.clear();
        last
    }

    /// What a user saw at a prompt has been read; what the script can ask for stays.
    pub fn forget_unread(&mut self) {
        self.first = self.next_number();
        self.unread.clear();
        self.tested.clear();
    }

    /// Forgets everything.
    pub fn clear(&mut self) {
        self.forget_unread();
        self.last_error = None;
    }
}

fn line(diagnostic: &Diagnostic, severity: Severity, sources: &SourceMap) -> String {
    let severity = match severity {
        Severity::Note => "Notification",
        Severity::Warning => "Warning",
        Severity::Error => "Error",
    };
    let span = diagnostic.span();
    match sources.get(span.source) {
        Some(source) => {
            let (from, to) =
                (source.line_column(span.start as usize), source.line_column(span.end as usize));
            format!(
                "[{}:{}:{}-{}:{}:writable] {severity}: {}\n",
                source.name, from.line, from.column, to.line, to.column, diagnostic.message
            )
        }
        None => format!("{severity}: {}\n", diagnostic.message),
    }
}
