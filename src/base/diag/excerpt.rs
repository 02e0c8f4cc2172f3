//! Sources for the rendering of a diagnostic: lines that are too long are shown around the place.

use super::Diagnostic;
use crate::source::{Source, SourceId, SourceMap, Span};
use codespan_reporting::files::{Error, Files};
use std::collections::BTreeMap;
use std::ops::Range;

/// Bytes of a line that is shown whole; tables in scripts have lines of a few thousand.
const MAX_LINE: usize = 4000;

/// Bytes kept of a longer line before the place and from there on, where there is room for them.
const KEPT: [usize; 2] = [40, 120];

/// Columns before a quoted line: its number and the bar.
const GUTTER: usize = 8;

/// Columns of the bar beside the lines of a place that has several.
const SIDE: usize = 2;

/// Lines that are quoted of a longer place, at its beginning and at its end.
const QUOTED: usize = 4;

/// Columns of a tab.
const TAB: usize = 4;

/// Stands for what is left out of a line.
const MARK: &str = "…";

/// The sources of a diagnostic, with the lines that are too long cut.
pub(super) struct Excerpts<'s> {
    sources: &'s SourceMap,
    cut: BTreeMap<usize, Cut>,
}

/// A source in which lines are cut.
struct Cut {
    source: Source,
    /// In their order.
    lines: Vec<CutLine>,
}

struct CutLine {
    line: usize,
    /// What is kept of the line, in bytes of the original.
    kept: Range<usize>,
    /// The whole line in the original.
    whole: Range<usize>,
}

impl<'s> Excerpts<'s> {
    /// `width`: columns of the terminal.
    pub(super) fn of(
        diagnostic: &Diagnostic,
        sources: &'s SourceMap,
        width: usize,
    ) -> Excerpts<'s> {
        let mut lines: BTreeMap<usize, BTreeMap<usize, CutLine>> = BTreeMap::new();
        let known = |span: Span| Some((sources.get(span.source)?, span));
        let places = || diagnostic.labels.iter().filter_map(|label| known(label.span));
        let sides = places().filter(|(source, span)| {
            let [first, last] = source.lines_of(*span);
            first < last
        });
        let width = width.saturating_sub(SIDE * sides.count());
        for (source, span) in places() {
            let [first, last] = source.lines_of(span);
            let begin = first..=(first + QUOTED).min(last);
            let quoted = begin.chain(last.saturating_sub(QUOTED).max(first)..=last);
            let own = lines.entry(span.source.0 as usize).or_default();
            for line in quoted {
                // Of a line in the middle the beginning is shown.
                let at = match line {
                    line if line == first => span.start as usize,
                    line if line == last => span.end as usize,
                    line => source.line_range(line).map_or(0, |range| range.start),
                };
                if let Some(found) = CutLine::of(source, (line, at), width) {
                    own.entry(line).or_insert(found);
                }
            }
        }
        let cut = |(id, lines): (usize, BTreeMap<usize, CutLine>)| {
            let source = sources.get(SourceId(id as u32)).filter(|_| !lines.is_empty())?;
            Some((id, Cut::of(source, lines.into_values().collect())))
        };
        Excerpts { sources, cut: lines.into_iter().filter_map(cut).collect() }
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

impl CutLine {
    /// `None` where the line is short enough; else what is around a byte of it.
    fn of(source: &Source, (line, start): (usize, usize), width: usize) -> Option<CutLine> {
        let whole = source.line_range(line)?;
        let text = source.text[whole.clone()].trim_end_matches(['\r', '\n']);
        let whole = whole.start..whole.start + text.len();
        let most = MAX_LINE.min(width.saturating_sub(GUTTER));
        if text.chars().map(columns).sum::<usize>() <= most {
            return None;
        }
        let room = most.saturating_sub(2);
        let is_narrow = room < KEPT[0] + KEPT[1];
        let [before, all] = if is_narrow { [room / 3, room] } else { [KEPT[0], KEPT[0] + KEPT[1]] };
        let start = start.clamp(whole.start, whole.end);
        let from = start - fitting(source.text[whole.start..start].chars().rev(), before);
        let kept = from..from + fitting(source.text[from..whole.end].chars(), all);
        Some(CutLine { line, kept, whole })
    }

    fn shown(&self, text: &str) -> String {
        let [lead, trail] = self.marks();
        format!("{lead}{}{trail}", &text[self.kept.clone()])
    }

    fn marks(&self) -> [&'static str; 2] {
        let mark = |is_whole: bool| if is_whole { "" } else { MARK };
        [mark(self.kept.start == self.whole.start), mark(self.kept.end == self.whole.end)]
    }

    /// Bytes that are shown of it.
    fn length(&self) -> usize {
        self.kept.len() + self.marks().map(str::len).iter().sum::<usize>()
    }
}

/// Columns of a character.
fn columns(c: char) -> usize {
    if c == '\t' { TAB } else { 1 }
}

/// Bytes of the characters at the beginning that fit into so many columns.
fn fitting(characters: impl Iterator<Item = char>, room: usize) -> usize {
    let ends = characters.scan([0, 0], |[used, bytes], c| {
        (*used, *bytes) = (*used + columns(c), *bytes + c.len_utf8());
        (*used <= room).then_some(*bytes)
    });
    ends.last().unwrap_or(0)
}

impl Cut {
    fn of(source: &Source, lines: Vec<CutLine>) -> Cut {
        let (mut shown, mut end) = (String::new(), 0);
        for own in &lines {
            shown += &source.text[end..own.whole.start];
            shown += &own.shown(&source.text);
            end = own.whole.end;
        }
        shown += &source.text[end..];
        Cut { source: Source::new(source.name.clone(), shown), lines }
    }

    /// Where a byte of the original is, or the nearest that is shown.
    fn place(&self, at: usize) -> usize {
        let [mut shown, mut end] = [0, 0];
        for own in self.lines.iter().take_while(|own| own.whole.start <= at) {
            shown += own.whole.start - end;
            if at <= own.whole.end {
                let within = at.clamp(own.kept.start, own.kept.end) - own.kept.start;
                return shown + own.marks()[0].len() + within;
            }
            shown += own.length();
            end = own.whole.end;
        }
        shown + at - end
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
        let own = self.cut.get(&id).and_then(|cut| cut.lines.iter().find(|own| own.line == line));
        let Some(own) = own else { return Ok(column) };
        let original = self.sources.get(SourceId(id as u32)).ok_or(Error::FileMissing)?;
        let before = &original.text[own.whole.start..own.kept.start];
        Ok(column + before.chars().count() - own.marks()[0].chars().count())
    }
}
