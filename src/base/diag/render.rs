//! Diagnostics as text for terminals.

use super::excerpt::Excerpts;
use super::{Diagnostic, Severity};
use crate::source::SourceMap;
use codespan_reporting::diagnostic as cr;
use codespan_reporting::term;
use codespan_reporting::term::termcolor::{Buffer, ColorSpec, WriteColor};
use std::io;

/// The diagnostic as the user sees it, with or without colours (ANSI escapes).
pub fn render(diagnostic: &Diagnostic, sources: &SourceMap, colour: bool) -> String {
    let diagnostic = &diagnostic.clone().shortened();
    let excerpts = Excerpts::of(diagnostic, sources);
    let shown = convert(diagnostic, sources, &excerpts);
    let config = term::Config::default();
    let mut text = if colour {
        let mut buffer = Shown(Buffer::ansi());
        match term::emit_to_write_style(&mut buffer, &config, &excerpts, &shown) {
            Ok(()) => String::from_utf8_lossy(buffer.0.as_slice()).into_owned(),
            Err(_) => plain_line(diagnostic),
        }
    } else {
        let mut buffer = String::new();
        match term::emit_to_string(&mut buffer, &config, &excerpts, &shown) {
            Ok(()) => super::visible(&buffer).into_owned(),
            Err(_) => plain_line(diagnostic),
        }
    };
    while text.ends_with("\n\n") {
        text.pop();
    }
    text
}

/// Colours are the only commands that reach a terminal: control characters in the text between them
/// are made visible.
struct Shown(Buffer);

impl io::Write for Shown {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let text = String::from_utf8_lossy(bytes);
        self.0.write_all(super::visible(&text).as_bytes())?;
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.0.flush()
    }
}

impl WriteColor for Shown {
    fn supports_color(&self) -> bool {
        self.0.supports_color()
    }

    fn set_color(&mut self, spec: &ColorSpec) -> io::Result<()> {
        self.0.set_color(spec)
    }

    fn reset(&mut self) -> io::Result<()> {
        self.0.reset()
    }
}

fn plain_line(diagnostic: &Diagnostic) -> String {
    format!("error[{}]: {}\n", diagnostic.code.slug, super::visible(&diagnostic.message))
}

fn convert(
    diagnostic: &Diagnostic,
    sources: &SourceMap,
    excerpts: &Excerpts<'_>,
) -> cr::Diagnostic<usize> {
    let severity = match diagnostic.severity {
        Severity::Note => cr::Severity::Note,
        Severity::Warning => cr::Severity::Warning,
        Severity::Error => cr::Severity::Error,
    };
    let labels = diagnostic
        .labels
        .iter()
        .filter(|label| sources.get(label.span.source).is_some())
        .map(|label| {
            let style =
                if label.primary { cr::LabelStyle::Primary } else { cr::LabelStyle::Secondary };
            cr::Label::new(style, label.span.source.0 as usize, excerpts.range(label.span))
                .with_message(&label.text)
        })
        .collect();
    let trace = diagnostic
        .trace
        .iter()
        .map(|frame| format!("in {}, called at {}", frame.what, sources.location(frame.span)));
    let helps = diagnostic.helps.iter().map(|help| format!("help: {help}"));
    cr::Diagnostic::new(severity)
        .with_code(diagnostic.code.slug)
        .with_message(&diagnostic.message)
        .with_labels(labels)
        .with_notes(helps.chain(trace).collect())
}
