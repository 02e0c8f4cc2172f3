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
    render_within(diagnostic, sources, colour, usize::MAX)
}

/// The same for a terminal of so many columns: of longer lines, what is around the place is quoted.
pub fn render_within(
    diagnostic: &Diagnostic,
    sources: &SourceMap,
    colour: bool,
    width: usize,
) -> String {
    let diagnostic = &diagnostic.clone().shortened();
    let excerpts = Excerpts::of(diagnostic, sources, width);
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diag::{Code, Fault};
    use crate::source::Span;

    const WRONG: Code = Code { slug: "wrong", explanation: "" };

    #[test]
    fn long_lines_are_cut_around_every_place() {
        let sources = SourceMap::default();
        let long = format!("{}\u{e9} here {}\nshort\n", "a ".repeat(60), "b ".repeat(60));
        let source = sources.add("f", format!("{long}{long}").as_str());
        let place = |line: usize| {
            let start = line * long.len() + long.find("here").unwrap_or(0);
            Span::new(source, start, start + "here".len())
        };
        let wrong = Fault::new(WRONG, "no").at(place(1)).related(place(0), "first");
        let wide = render(&wrong, &sources, false);
        assert!(wide.contains(&"b ".repeat(60).trim_end().to_owned()), "{wide}");
        let narrow = render_within(&wrong, &sources, false, 60);
        assert!(narrow.lines().all(|line| line.chars().count() <= 60), "{narrow}");
        let marked = |signs: &str| {
            let lines: Vec<&str> = narrow.lines().collect();
            let at = lines.iter().position(|line| line.contains(signs)).unwrap_or(0);
            let columns =
                |text: &str, part: &str| text.find(part).map(|at| text[..at].chars().count());
            assert_eq!(columns(lines[at], signs), columns(lines[at - 1], "here"), "{narrow}");
        };
        marked("^^^^");
        marked("----");
        assert!(narrow.contains("f:3:123"), "{narrow}");
    }
}
