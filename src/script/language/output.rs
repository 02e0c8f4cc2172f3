//! What a session answers: standard output and standard error, the transcript, the log, and the
//! messages that a script can ask for.

use super::log::Log;
use super::messages::Messages;
use super::transcript::Transcript;
use crate::diag::{Diagnostic, render};
use crate::source::{SourceMap, Span};
use crate::world::Screen;
use std::collections::{BTreeSet, HashSet};

/// The answers of a session.
#[derive(Default)]
pub struct Output {
    /// What `getErrorString()` and `getLastError()` return.
    pub messages: Messages,
    /// Statements and answers, if they are recorded.
    pub transcript: Option<Transcript>,
    /// Statements and answers so far, for `savelog`.
    log: Log,
    /// Diagnostics reported, where each is reported once.
    reported: Option<HashSet<(Span, String)>>,
    /// Commands whose lack of effect without a window was reported.
    windowless: BTreeSet<&'static str>,
    /// `echo(false)` was called.
    muted: bool,
    /// Answers of scripts that return them, innermost last.
    collected: Vec<String>,
    /// Warnings and notes from here on, for callers that keep what they are about.
    pub(crate) overheard: Option<Vec<Diagnostic>>,
}

impl Output {
    /// A statement of the outermost script begins.
    pub fn begin(&mut self, sources: &SourceMap, statement: Span) {
        if let Some(transcript) = &mut self.transcript {
            transcript.begin(sources.text(statement));
        }
        self.log.begin(statement);
    }

    /// Notes what is printed in the transcript and in the log.
    pub fn record(&mut self, text: &str) {
        if let Some(transcript) = &mut self.transcript {
            transcript.print(text);
        }
        self.log.answer(text);
    }

    /// Notes a report that the program prints by itself; `brief` is what a brief transcript has of it.
    pub(crate) fn record_report(&mut self, whole: &str, brief: &str) {
        if let Some(transcript) = &mut self.transcript {
            transcript.print_report(whole, brief);
        }
        self.log.answer(whole);
    }

    /// Shows a diagnostic on the screen, unless it is `quiet` about warnings and notes, and keeps it
    /// for the script. Returns whether it is an error.
    pub fn report(
        &mut self,
        screen: &mut dyn Screen,
        sources: &SourceMap,
        quiet: bool,
        diagnostic: Diagnostic,
    ) -> bool {
        let diagnostic = diagnostic.shortened();
        if let Some(overheard) = &mut self.overheard {
            overheard.push(diagnostic.clone());
        }
        let is_error = diagnostic.is_error();
        let place = || (diagnostic.span(), subject(&diagnostic).to_owned());
        if self.reported.as_mut().is_some_and(|reported| !reported.insert(place())) {
            return is_error;
        }
        let plain = render::render(&diagnostic, sources, false);
        if is_error || !quiet {
            let width = screen.columns().unwrap_or(usize::MAX);
            screen.eprint(&render::render_within(&diagnostic, sources, screen.colour(), width));
        }
        if let Some(transcript) = &mut self.transcript {
            transcript.report(&plain, diagnostic.code);
        }
        self.log.answer(&plain);
        self.messages.push(diagnostic);
        is_error
    }

    /// From here on an error or a warning at the same place is reported once, however many classes it
    /// concerns.
    pub fn report_once(&mut self) {
        self.reported.get_or_insert_default();
    }

    /// Whether an error or a warning was reported where each is reported once.
    pub fn has_reported(&self, diagnostic: &Diagnostic) -> bool {
        let diagnostic = diagnostic.clone().shortened();
        let place = (diagnostic.span(), subject(&diagnostic).to_owned());
        self.reported.as_ref().is_some_and(|reported| reported.contains(&place))
    }

    /// Whether it is the first time that this command has no effect.
    pub(crate) fn is_first_without_window(&mut self, command: &'static str) -> bool {
        self.windowless.insert(command)
    }

    /// Answers are collected from here on, not shown.
    pub(crate) fn begin_collecting(&mut self) {
        self.collected.push(String::new());
    }

    /// Adds a line to the answers that are collected; `false` if none are.
    pub fn collect(&mut self, line: &str) -> bool {
        let innermost = self.collected.last_mut();
        let collects = innermost.is_some();
        innermost.into_iter().for_each(|answers| answers.push_str(line));
        collects
    }

    /// The answers since [`Output::begin_collecting`].
    pub(super) fn collected(&mut self) -> String {
        self.collected.pop().unwrap_or_default()
    }

    /// Whether `echo(false)` was called.
    pub(crate) fn is_muted(&self) -> bool {
        self.muted
    }

    /// `echo` was called.
    pub(crate) fn set_muted(&mut self, muted: bool) {
        self.muted = muted;
    }

    /// Statements and answers so far.
    pub fn log(&self) -> &Log {
        &self.log
    }
}

/// What a diagnostic is about at its place: two of one subject there are one. An expression has one type, in
/// whatever words checks of the class and of its instances call it wrong.
pub fn subject(diagnostic: &Diagnostic) -> &str {
    match diagnostic.code.slug {
        slug @ "type-mismatch" if diagnostic.span() != Span::NONE => slug,
        _ => &diagnostic.message,
    }
}
