//! Modelica source and places in it.
//!
//! A [`Span`] is a pair of byte offsets into one text of a [`SourceMap`]; line and column are
//! computed only on demand.

use std::cell::RefCell;
use std::sync::Arc;

/// Number of a text in its [`SourceMap`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct SourceId(pub u32);

impl SourceId {
    /// The source of what was never written down: built-in headers, generated code.
    pub const NONE: SourceId = SourceId(u32::MAX);
}

thread_local! {
    /// The sources that the numbers in a file stand for, while it is read or written.
    static SOURCES: RefCell<Vec<SourceId>> = const { RefCell::new(Vec::new()) };
}

/// Writes something with places to a file: the result with the sources that the numbers of sources in
/// the file stand for, by their positions.
pub fn with_source_table<T>(write: impl FnOnce() -> T) -> (T, Vec<SourceId>) {
    let former = SOURCES.take();
    let result = write();
    (result, SOURCES.replace(former))
}

/// Reads something with places from a file: the numbers of sources in it are positions in `sources`.
pub fn with_sources<T>(sources: Vec<SourceId>, read: impl FnOnce() -> T) -> T {
    let former = SOURCES.replace(sources);
    let result = read();
    SOURCES.set(former);
    result
}

/// As a position: see [`with_source_table`].
impl serde::Serialize for SourceId {
    fn serialize<S: serde::Serializer>(&self, target: S) -> Result<S::Ok, S::Error> {
        if *self == SourceId::NONE {
            return u32::MAX.serialize(target);
        }
        let position = SOURCES.with_borrow_mut(|sources| {
            let known = sources.iter().rposition(|source| source == self);
            known.unwrap_or_else(|| {
                sources.push(*self);
                sources.len() - 1
            })
        });
        (position as u32).serialize(target)
    }
}

/// As the number of the text in this process: see [`with_sources`]. A text that is not among them has
/// no places.
impl<'de> serde::Deserialize<'de> for SourceId {
    fn deserialize<D: serde::Deserializer<'de>>(source: D) -> Result<SourceId, D::Error> {
        let number = u32::deserialize(source)?;
        let known = SOURCES.with_borrow(|sources| sources.get(number as usize).copied());
        Ok(known.unwrap_or(SourceId::NONE))
    }
}

/// A half-open range of bytes `start..end` in one source text.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
pub struct Span {
    /// The text.
    pub source: SourceId,
    /// First byte.
    pub start: u32,
    /// One past the last byte.
    pub end: u32,
}

impl Span {
    /// The place of what was never written down.
    pub const NONE: Span = Span { source: SourceId::NONE, start: 0, end: 0 };

    /// Makes a span of the bytes `start..end` of `source`.
    #[inline]
    pub fn new(source: SourceId, start: usize, end: usize) -> Span {
        Span { source, start: start as u32, end: end as u32 }
    }

    /// The smallest span that holds both; `self` if the other lies in another text.
    #[inline]
    pub fn to(self, other: Span) -> Span {
        if self.source != other.source {
            return self;
        }
        Span {
            source: self.source,
            start: self.start.min(other.start),
            end: self.end.max(other.end),
        }
    }

    /// Whether another span lies within this one.
    pub fn contains(self, other: Span) -> bool {
        self.source == other.source && self.start <= other.start && other.end <= self.end
    }

    /// Whether the span names a place in a text.
    #[inline]
    pub fn is_known(self) -> bool {
        self.source != SourceId::NONE
    }
}

/// Something with its place.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Spanned<T> {
    /// The thing.
    pub node: T,
    /// Where it is written.
    pub span: Span,
}

/// One text: its name for people and its lines.
#[derive(Debug, Clone)]
pub struct Source {
    /// The name shown in diagnostics, usually the path as the user wrote it.
    pub name: Arc<str>,
    /// The whole text.
    pub text: Arc<str>,
    line_starts: Arc<[u32]>,
}

/// All sources read so far. Clones share them, so that one clone can add a text while others read.
#[derive(Debug, Clone, Default)]
pub struct SourceMap {
    sources: Arc<boxcar::Vec<Source>>,
}

/// A place for people: both counted from 1, columns in characters.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LineColumn {
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
}

impl SourceMap {
    /// Adds a text and returns its number.
    pub fn add(&self, name: impl Into<Arc<str>>, text: impl Into<Arc<str>>) -> SourceId {
        SourceId(self.sources.push(Source::new(name, text)) as u32)
    }

    /// The source of this number; `None` for [`SourceId::NONE`].
    pub fn get(&self, id: SourceId) -> Option<&Source> {
        self.sources.get(id.0 as usize)
    }

    /// The number of a text added before under the same name with the same content.
    pub fn find(&self, name: &str, text: &str) -> Option<SourceId> {
        let mut sources = self.sources.iter();
        let (at, _) = sources.find(|(_, source)| &*source.name == name && &*source.text == text)?;
        Some(SourceId(at as u32))
    }

    /// Line and column of the first byte of a span.
    pub fn line_column(&self, span: Span) -> Option<LineColumn> {
        self.get(span.source).map(|source| source.line_column(span.start as usize))
    }

    /// The text of a span, empty where it is not known.
    pub fn text(&self, span: Span) -> &str {
        self.get(span.source)
            .and_then(|source| source.text.get(span.start as usize..span.end as usize))
            .unwrap_or("")
    }

    /// Whether the first character after a span, white space aside, is this one.
    pub fn is_followed_by(&self, span: Span, expected: char) -> bool {
        let rest = self.get(span.source).and_then(|source| source.text.get(span.end as usize..));
        rest.is_some_and(|rest| rest.trim_start().starts_with(expected))
    }

    /// `file:line`, for traces; `<built-in>` where the place is not known.
    pub fn location(&self, span: Span) -> String {
        match (self.get(span.source), self.line_column(span)) {
            (Some(source), Some(place)) => format!("{}:{}", source.name, place.line),
            _ => "<built-in>".to_owned(),
        }
    }
}

impl Source {
    /// A text under a name.
    pub(crate) fn new(name: impl Into<Arc<str>>, text: impl Into<Arc<str>>) -> Source {
        let text: Arc<str> = text.into();
        let line_starts = std::iter::once(0)
            .chain(text.bytes().enumerate().filter(|(_, b)| *b == b'\n').map(|(i, _)| i as u32 + 1))
            .collect();
        Source { name: name.into(), text, line_starts }
    }

    /// Line and column of a byte offset.
    pub fn line_column(&self, offset: usize) -> LineColumn {
        let line = self.line_starts.partition_point(|start| *start as usize <= offset).max(1);
        let start = self.line_starts[line - 1] as usize;
        let column = self.text.get(start..offset).map_or(0, |text| text.chars().count()) + 1;
        LineColumn { line, column }
    }

    /// The first and the last line of a span, counted from 0.
    pub(crate) fn lines_of(&self, span: Span) -> [usize; 2] {
        [span.start, span.end].map(|offset| self.line_column(offset as usize).line - 1)
    }

    /// Number of lines.
    pub(crate) fn line_count(&self) -> usize {
        self.line_starts.len()
    }

    /// The bytes of a line counted from 0, its line end included.
    pub(crate) fn line_range(&self, line: usize) -> Option<std::ops::Range<usize>> {
        let start = *self.line_starts.get(line)? as usize;
        let end = self.line_starts.get(line + 1).map_or(self.text.len(), |next| *next as usize);
        Some(start..end)
    }
}
