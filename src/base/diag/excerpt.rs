//! Sources for the rendering of a diagnostic: very long lines are shown around the place.

use super::Diagnostic;
use crate::source::{Source, SourceId, SourceMap, Span};
use codespan_reporting::files::{Error, Files};
use std::collections::BTreeMap;
use std::ops::Range;

/// Bytes of a line that is shown whole; tables in scripts have lines of a few thousand.
const MAX_LINE: usize = 4000;

/// Bytes kept of a longer line before the place and from there on.
const KEPT: (usize, usize) = (40, 120);

/// The sources of a diagnostic, with the lines that are too long cut.
pub(super) struct Excerpts<'s> {
    sources: &'s SourceMap,
    cut: BTreeMap<usize, Cut>,
}

/// A source in which one line is cut.
struct Cut {
    source: Source,
    line: usize,
    /// What is kept of the line, in bytes of the original.
    kept: Range<usize>,
    /// The whole line in the original.
    whole: Range<usize>,
}

impl<'s> Excerpts<'s> {
    pub(super) fn of(diagnostic: &Diagnostic, sources: &'s SourceMap) -> Excerpts<'s> {
        let mut cut = BTreeMap::new();
        for label in &diagnostic.labels {
            let id = label.span.source.0 as usize;
            if let Some(source) = sources.get(label.span.source)
                && !cut.contains_key(&id)
                && let Some(found) = Cut::of(source, label.span)
            {
                cut.insert(id, found);
            }
        }
        Excerpts { sources, cut }
    }

    /// The bytes of a place in what is shown of its source.
    pub(super) fn range(&self, span: Span) -> Range<usize> {
        let range = span.start as usize..span.end as usize;
        match self.cut.get(&(span.source.0 as usize)) {
            Some(cut) => cut.place(range.start)..cut.place(range.end),
            None => range,
        }
    }

    fn get(&self, id: usize) -> Result<&Source, Error> {
        let original = || self.sources.get(SourceId(id as u32));
        self.cut.get(&id).map(|cut| &cut.source).or_else(original).ok_or(Error::FileMissing)
    }
}

impl Cut {
    /// `None` where the line of the place is short enough.
    fn of(source: &Source, span: Span) -> Option<Cut> {
        let start = span.start as usize;
        let line = source.line_column(start).line - 1;
        let whole = source.line_range(line)?;
        let text = &source.text;
        let whole =
            whole.start..whole.start + text[whole.clone()].trim_end_matches(['\r', '\n']).len();
        if whole.len() <= MAX_LINE {
            return None;
        }
        let boundary = |mut at: usize| {
            while !text.is_char_boundary(at) {
                at -= 1;
            }
            at
        };
        let kept = boundary(start.saturating_sub(KEPT.0).max(whole.start))
            ..boundary((start + KEPT.1).min(whole.end));
        let shown =
            format!("{}{}{}", &text[..whole.start], &text[kept.clone()], &text[whole.end..]);
        let source = Source::new(source.name.clone(), shown);
        Some(Cut { source, line, kept, whole })
    }

    /// Where a byte of the original is, or the nearest that is shown.
    fn place(&self, at: usize) -> usize {
        let left_out = self.whole.len() - self.kept.len();
        match at {
            at if at < self.whole.start => at,
            at if at > self.whole.end => at - left_out,
            at => at.clamp(self.kept.start, self.kept.end) - self.kept.start + self.whole.start,
        }
    }
}

impl<'a> Files<'a> for Excerpts<'_> {
    type FileId = usize;
    type Name = &'a str;
    type Source = &'a str;

    fn name(&'a self, id: usize) -> Result<&'a str, Error> {
        self.get(id).map(|source| &*source.name)
    }

    fn source(&'a self, id: usize) -> Result<&'a str, Error> {
        self.get(id).map(|source| &*source.text)
    }

    fn line_index(&'a self, id: usize, byte_index: usize) -> Result<usize, Error> {
        self.get(id).map(|source| source.line_column(byte_index).line - 1)
    }

    fn line_range(&'a self, id: usize, line_index: usize) -> Result<Range<usize>, Error> {
        let source = self.get(id)?;
        source.line_range(line_index).ok_or(Error::LineTooLarge {
            given: line_index,
            max: source.line_count().saturating_sub(1),
        })
    }

    /// The column in the original.
    fn column_number(&'a self, id: usize, line: usize, byte_index: usize) -> Result<usize, Error> {
        let source = self.get(id)?;
        let column = source.line_column(byte_index).column;
        let Some(cut) = self.cut.get(&id).filter(|cut| cut.line == line) else { return Ok(column) };
        let original = self.sources.get(SourceId(id as u32)).ok_or(Error::FileMissing)?;
        let before = &original.text[cut.whole.start..cut.kept.start];
        Ok(column + before.chars().count())
    }
}
