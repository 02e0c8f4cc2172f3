//! Ranges that an editor can fold: classes, sections, annotations and comments of several lines.

use super::parsed::{Parsed, elements, sections};
use crate::source::Span;
use crate::syntax::ast::{ClassDefinition, ClassSpecifier, Element, Section};
use lsp_types::{FoldingRange, FoldingRangeKind};
use std::collections::BTreeMap;

/// What an annotation is shown as while it is folded.
const ANNOTATION: &str = "annotation(…)";

/// The ranges of a document; of those that begin on one line the longest.
pub(crate) fn ranges(parsed: &Parsed) -> Vec<FoldingRange> {
    let mut all = Collector { parsed, by_line: BTreeMap::new() };
    for (_, class) in parsed.all_classes() {
        all.class(&class);
    }
    all.comments();
    all.by_line.into_values().collect()
}

struct Collector<'a> {
    parsed: &'a Parsed,
    by_line: BTreeMap<u32, FoldingRange>,
}

impl Collector<'_> {
    fn class(&mut self, class: &ClassDefinition) {
        let ClassSpecifier::Long(_) = &class.specifier else { return };
        // The line with `end` stays.
        self.add(class.span, 1, None, None);
        for section in sections(class) {
            match section {
                Section::Equations { equations, span, .. } => {
                    let last = equations.last().map_or(*span, |last| last.span);
                    self.add(Span { end: last.end, ..*span }, 0, None, None);
                }
                Section::Algorithm { statements, span, .. } => {
                    let last = statements.last().map_or(*span, |last| last.span);
                    self.add(Span { end: last.end, ..*span }, 0, None, None);
                }
                Section::Annotation(annotation) => self.annotation(annotation.span),
                _ => {}
            }
        }
        for element in elements(class) {
            let Element::Component(clause) = element else { continue };
            let own = clause.components.iter().filter_map(|one| one.comment.annotation.as_ref());
            own.for_each(|annotation| self.annotation(annotation.span));
        }
    }

    fn annotation(&mut self, span: Span) {
        // The extension for VS Code folds ranges of this kind when a file is opened.
        self.add(span, 0, Some(FoldingRangeKind::Region), Some(ANNOTATION.to_owned()));
    }

    /// Adds a range without its last lines, so many.
    fn add(
        &mut self,
        span: Span,
        last: u32,
        kind: Option<FoldingRangeKind>,
        collapsed_text: Option<String>,
    ) {
        let document = &self.parsed.document;
        let whole = document.range(span.start as usize..span.end as usize);
        let end = whole.end.line.saturating_sub(last);
        self.add_lines(whole.start.line, end, kind, collapsed_text);
    }

    fn add_lines(
        &mut self,
        start_line: u32,
        end_line: u32,
        kind: Option<FoldingRangeKind>,
        collapsed_text: Option<String>,
    ) {
        let known = self.by_line.get(&start_line).map_or(start_line, |known| known.end_line);
        if end_line > known {
            let range = FoldingRange {
                start_line,
                end_line,
                kind,
                collapsed_text,
                ..FoldingRange::default()
            };
            self.by_line.insert(start_line, range);
        }
    }

    /// Comments of several lines, which begin them.
    fn comments(&mut self) {
        let text = self.parsed.document.text.clone();
        let mut begun: Option<(u32, bool)> = None;
        let mut number = 0;
        for line in text.lines() {
            let line = line.trim();
            begun = match begun {
                Some((start, true)) if line.contains("*/") => {
                    self.add_lines(start, number, Some(FoldingRangeKind::Comment), None);
                    None
                }
                Some((start, true)) => Some((start, true)),
                Some((start, false)) if line.starts_with("//") => Some((start, false)),
                other => {
                    if let Some((start, _)) = other {
                        self.add_lines(start, number - 1, Some(FoldingRangeKind::Comment), None);
                    }
                    match () {
                        () if line.starts_with("//") => Some((number, false)),
                        () if line.starts_with("/*") && !line.contains("*/") => {
                            Some((number, true))
                        }
                        () => None,
                    }
                }
            };
            number += 1;
        }
        if let Some((start, false)) = begun {
            self.add_lines(start, number.saturating_sub(1), Some(FoldingRangeKind::Comment), None);
        }
    }
}
