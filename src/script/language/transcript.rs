//! Transcripts: each statement and what it answered, interleaved, so that one reads alone.

use crate::diag::Code;
use std::fmt;

/// What precedes a statement.
pub(crate) const PROMPT: &str = ">>> ";

/// One statement and its answer.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Exchange {
    /// The statement as written; empty for what was printed before the first one.
    pub input: String,
    /// What it printed, its value and its diagnostics, in the order they came.
    pub answer: String,
    /// What went to standard output of it.
    pub printed: String,
    /// The codes of its diagnostics.
    pub codes: Vec<Code>,
}

/// What a script said and what was answered, at its top level.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Transcript {
    /// The exchanges, in order.
    pub exchanges: Vec<Exchange>,
    /// Whether of a report only the numbers are recorded: its sentences and the version change with
    /// every release.
    pub is_brief: bool,
}

impl Transcript {
    /// Begins the exchange of a statement.
    pub fn begin(&mut self, input: &str) {
        self.exchanges.push(Exchange { input: input.to_owned(), ..Exchange::default() });
    }

    /// Adds to the answer of the current statement.
    pub fn answer(&mut self, text: &str) {
        self.current().answer.push_str(text);
    }

    /// Adds what goes to standard output to the answer of the current statement.
    pub fn print(&mut self, text: &str) {
        self.answer(text);
        self.current().printed.push_str(text);
    }

    /// Adds a report of the program to the answer of the current statement: all of it, or what is left of
    /// it in a brief transcript.
    pub(crate) fn print_report(&mut self, whole: &str, brief: &str) {
        self.print(if self.is_brief { brief } else { whole });
    }

    /// Adds a diagnostic to the answer of the current statement.
    pub fn report(&mut self, text: &str, code: Code) {
        self.answer(text);
        self.current().codes.push(code);
    }

    fn current(&mut self) -> &mut Exchange {
        if self.exchanges.is_empty() {
            self.exchanges.push(Exchange::default());
        }
        match self.exchanges.last_mut() {
            Some(exchange) => exchange,
            None => unreachable!("one was pushed"),
        }
    }
}

impl fmt::Display for Transcript {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut each = self.exchanges.iter();
        each.try_for_each(|exchange| interleaved(f, &exchange.input, &exchange.answer))
    }
}

/// A statement after prompts, and its answer.
pub(super) fn interleaved(f: &mut impl fmt::Write, input: &str, answer: &str) -> fmt::Result {
    for (at, line) in input.lines().enumerate() {
        let prompt = if at == 0 { PROMPT } else { "... " };
        writeln!(f, "{}", format!("{prompt}{line}").trim_end())?;
    }
    f.write_str(answer)?;
    if !answer.is_empty() && !answer.ends_with('\n') {
        writeln!(f)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_transcript_shows_statements_and_answers_in_turn() {
        let mut transcript = Transcript::default();
        transcript.begin("1 + 2");
        transcript.answer("3\n");
        transcript.begin("for i in 1:2 loop\n  print(\"x\");\nend for");
        transcript.answer("x");
        let expected = ">>> 1 + 2\n3\n>>> for i in 1:2 loop\n...   print(\"x\");\n... end for\nx\n";
        assert_eq!(transcript.to_string(), expected);
    }
}
