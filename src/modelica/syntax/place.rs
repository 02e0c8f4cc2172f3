//! Places in a text of which parts were cut out, and their places in the original.

use super::outline::Outline;
use crate::diag::Diagnostic;
use crate::source::{SourceId, Span};
use std::ops::Range;
use std::sync::Arc;

/// Where a text that is parsed comes from.
#[derive(Debug, Clone)]
pub(super) struct TextOrigin {
    source: SourceId,
    /// Where pieces of the original begin, in the text and in the original; empty if all of it is
    /// there.
    pieces: Vec<(usize, usize)>,
    /// The outline of the original, and which of its classes this text is (`None`: all of it), if
    /// the bodies of the classes in it were cut out.
    pub(super) unread: Option<(Arc<OutlinedText>, Option<usize>)>,
}

/// A text with its outline.
#[derive(Debug)]
pub(super) struct OutlinedText {
    pub(super) source: SourceId,
    pub(super) text: Arc<str>,
    pub(super) outline: Outline,
}

/// A part of a text, to be parsed.
#[derive(Debug)]
pub(super) struct Excerpt {
    pub(super) text: String,
    pub(super) place: TextOrigin,
}

impl TextOrigin {
    /// A text that is a source as a whole.
    pub(super) fn in_source(source: SourceId) -> TextOrigin {
        TextOrigin { source, pieces: Vec::new(), unread: None }
    }

    /// A part of a source that begins at `start`.
    pub(super) fn part(source: SourceId, start: usize) -> TextOrigin {
        TextOrigin { source, pieces: vec![(0, start)], unread: None }
    }

    /// The bytes `start..end` of the text as a place in the original.
    pub(super) fn span(&self, start: usize, end: usize) -> Span {
        if self.pieces.is_empty() {
            return Span::new(self.source, start, end);
        }
        let first = self.original(start);
        let after = if end > start { self.original(end - 1) + 1 } else { first };
        Span::new(self.source, first, after)
    }

    fn original(&self, at: usize) -> usize {
        let later = self.pieces.partition_point(|(here, _)| *here <= at);
        let (here, there) = self.pieces[later.saturating_sub(1)];
        there + at.saturating_sub(here)
    }

    /// A diagnostic about the text as one about the original.
    pub(super) fn relocated(&self, diagnostic: Diagnostic) -> Diagnostic {
        if self.pieces.is_empty() {
            return diagnostic;
        }
        diagnostic.with_spans(|span| match span.source == self.source {
            true => self.span(span.start as usize, span.end as usize),
            false => span,
        })
    }

    pub(super) fn source(&self) -> SourceId {
        self.source
    }
}

impl Excerpt {
    /// A part of a text without the ranges `cuts`, each of which becomes a line end.
    pub(super) fn new(
        mut place: TextOrigin,
        text: &str,
        part: Range<usize>,
        cuts: impl Iterator<Item = Range<usize>>,
    ) -> Excerpt {
        let mut kept = String::new();
        let mut at = part.start;
        place.pieces.push((0, at));
        for cut in cuts {
            kept.push_str(&text[at..cut.start]);
            kept.push('\n');
            at = cut.end;
            place.pieces.push((kept.len(), at));
        }
        kept.push_str(&text[at..part.end]);
        Excerpt { text: kept, place }
    }
}
