//! The log of a session, for `savelog`: where each statement is written and what it answered. It
//! keeps no copies of the statements, because a script may have a million of them.

use super::transcript::interleaved;
use crate::source::{SourceMap, Span};

/// Bytes of answers that are kept.
const MAX_ANSWERS: usize = 4 << 20;

/// What was said and answered at the top level so far.
#[derive(Debug, Default)]
pub struct Log {
    /// Where each statement is written, and where in `answers` its answer begins.
    statements: Vec<(Span, usize)>,
    answers: String,
    is_full: bool,
}

impl Log {
    /// Begins the exchange of a statement.
    pub fn begin(&mut self, statement: Span) {
        self.statements.push((statement, self.answers.len()));
    }

    /// Adds to the answer of the current statement, until the answers are too long.
    pub fn answer(&mut self, text: &str) {
        if self.is_full {
            return;
        }
        self.answers.push_str(text);
        if self.answers.len() > MAX_ANSWERS {
            self.answers.push_str("...\n");
            self.is_full = true;
        }
    }

    /// The statements alone, each ended by a semicolon.
    pub fn statements(&self, sources: &SourceMap) -> String {
        let each = self.statements.iter().map(|(span, _)| sources.text(*span));
        each.filter(|text| !text.is_empty()).map(|text| format!("{text};\n")).collect()
    }

    /// Statements and answers alternately, as a transcript has them.
    pub fn text(&self, sources: &SourceMap) -> String {
        let starts = self.statements.iter().map(|(_, start)| *start);
        let ends = starts.clone().skip(1).chain([self.answers.len()]);
        // What was answered before the first statement.
        let first = starts.clone().next().unwrap_or(self.answers.len());
        let mut text = String::new();
        let mut add = |input: &str, answer: &str| {
            let written = interleaved(&mut text, input, answer);
            debug_assert!(written.is_ok(), "strings take everything");
        };
        add("", &self.answers[..first]);
        for ((span, start), end) in self.statements.iter().zip(ends) {
            add(sources.text(*span), &self.answers[*start..end]);
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn statements_and_answers_in_turn() {
        let sources = SourceMap::default();
        let source = sources.add("a.mos", "1 + 2; f(x)");
        let mut log = Log::default();
        log.answer("before");
        log.begin(Span::new(source, 0, 5));
        log.answer("3\n");
        log.begin(Span::new(source, 7, 11));
        log.answer(&"x".repeat(MAX_ANSWERS));
        log.answer("not kept");
        let text = log.text(&sources);
        assert!(text.starts_with("before\n>>> 1 + 2\n3\n>>> f(x)\nxxx"), "{}", &text[..40]);
        assert!(text.ends_with("xx...\n"));
        assert_eq!(log.statements(&sources), "1 + 2;\nf(x);\n");
    }
}
