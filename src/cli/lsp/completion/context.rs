//! What is typed at a place: which name, after which dots, in which parentheses. Found in the text
//! alone, because half a statement cannot be read.

use std::ops::Range;

/// What surrounds the cursor.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(crate) struct Context {
    /// Where the name begins that is being typed; its last part.
    pub start: usize,
    /// The parts of the name before the last dot.
    pub path: Vec<String>,
    /// The parentheses that are open in the statement, outermost first.
    pub open: Vec<Open>,
    /// The names before the first parenthesis: `parameter`, `SI.Voltage`, `v`.
    pub head: Vec<String>,
    /// The cursor is in a string that begins here.
    pub string: Option<usize>,
    /// The cursor is in a comment.
    pub(crate) in_comment: bool,
}

/// Parentheses that are open.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Open {
    /// The name before them; empty if there is none.
    pub name: String,
    /// The names to which values are given in them already.
    pub given: Vec<String>,
    /// Commas in them so far.
    pub commas: usize,
    /// Whether the cursor is after a `=`.
    pub(crate) in_value: bool,
}

/// A piece of a text.
struct Piece<'t> {
    text: &'t str,
    range: Range<usize>,
}

/// What surrounds the byte `offset` of a text.
pub(crate) fn at(text: &str, offset: usize) -> Context {
    let head = text.get(..offset).unwrap_or(text);
    let mut context = Context { start: head.len(), ..Context::default() };
    let mut pieces: Vec<Piece<'_>> = Vec::new();
    let mut at = 0;
    while at < head.len() {
        let (length, kind) = piece(&head[at..]);
        let range = at..at + length;
        at += length;
        let is_open = at == head.len();
        match kind {
            PieceKind::Blank => {}
            PieceKind::Comment { closed } => context.in_comment = is_open && !closed,
            PieceKind::String { closed } if is_open && !closed => {
                context.string = Some(range.start)
            }
            _ if matches!(&head[range.clone()], ";") => pieces.clear(),
            _ => pieces.push(Piece { text: &head[range.clone()], range }),
        }
    }
    let name = name_before(&pieces, head.len());
    context.start = name.start;
    context.path = name.path;
    let statement = &pieces[..name.first];
    (context.head, context.open) = parentheses(statement);
    context
}

enum PieceKind {
    Blank,
    Comment { closed: bool },
    String { closed: bool },
    Other,
}

/// The piece that a text begins with: its length and kind.
fn piece(text: &str) -> (usize, PieceKind) {
    let is_word = |c: char| c.is_alphanumeric() || c == '_';
    let length_of =
        |belongs: &dyn Fn(char) -> bool| text.find(|c| !belongs(c)).unwrap_or(text.len());
    match text.chars().next() {
        Some(c) if c.is_whitespace() => (length_of(&char::is_whitespace), PieceKind::Blank),
        Some('/') if text.starts_with("//") => match text.find('\n') {
            Some(end) => (end, PieceKind::Comment { closed: true }),
            None => (text.len(), PieceKind::Comment { closed: false }),
        },
        Some('/') if text.starts_with("/*") => match text.find("*/") {
            Some(end) => (end + 2, PieceKind::Comment { closed: true }),
            None => (text.len(), PieceKind::Comment { closed: false }),
        },
        Some('"') => {
            let (length, closed) = string(text);
            (length, PieceKind::String { closed })
        }
        Some(c) if is_word(c) => (length_of(&is_word), PieceKind::Other),
        Some(c) => (c.len_utf8(), PieceKind::Other),
        None => (0, PieceKind::Other),
    }
}

fn string(text: &str) -> (usize, bool) {
    let mut escaped = false;
    for (at, character) in text.char_indices().skip(1) {
        match character {
            '"' if !escaped => return (at + 1, true),
            _ => escaped = character == '\\' && !escaped,
        }
    }
    (text.len(), false)
}

/// A name that ends at the cursor.
struct Name {
    start: usize,
    path: Vec<String>,
    /// The number of its first piece.
    first: usize,
}

fn is_word(text: &str) -> bool {
    text.starts_with(|c: char| c.is_alphabetic() || c == '_')
}

fn name_before(pieces: &[Piece<'_>], end: usize) -> Name {
    let mut first = pieces.len();
    let mut start = end;
    if let Some(last) = pieces.last().filter(|last| last.range.end == end && is_word(last.text)) {
        start = last.range.start;
        first -= 1;
    }
    let mut path = Vec::new();
    while let [.., part, dot] = &pieces[..first]
        && dot.text == "."
    {
        // Subscripts of a part are passed.
        let mut at = first - 2;
        if part.text == "]" {
            at = pieces[..at].iter().rposition(|piece| piece.text == "[").unwrap_or(0);
            at = at.saturating_sub(1);
        }
        if !is_word(pieces[at].text) {
            break;
        }
        path.insert(0, pieces[at].text.to_owned());
        first = at;
    }
    Name { start, path, first }
}

/// Words that begin a section or another statement: what precedes them is another one.
const SECTIONS: &[&str] =
    &["equation", "algorithm", "public", "protected", "then", "else", "loop", "initial"];

/// The names before the first open parenthesis of a statement, and what is open.
fn parentheses(pieces: &[Piece<'_>]) -> (Vec<String>, Vec<Open>) {
    let (mut head, mut open): (Vec<String>, Vec<Open>) = (Vec::new(), Vec::new());
    // Names, dots joined, since the last piece that is none; with what separates them.
    let mut names: Vec<String> = Vec::new();
    let mut joined = false;
    for piece in pieces {
        match piece.text {
            "(" => {
                if open.is_empty() {
                    head = names.clone();
                }
                let name = names.last().cloned().unwrap_or_default();
                open.push(Open { name, given: Vec::new(), commas: 0, in_value: false });
                names.clear();
            }
            ")" => {
                open.pop();
                names.clear();
            }
            "," => {
                names.clear();
                if let Some(inner) = open.last_mut() {
                    inner.commas += 1;
                    inner.in_value = false;
                }
            }
            "=" => {
                if let Some(inner) = open.last_mut() {
                    inner.given.extend(names.pop());
                    inner.in_value = true;
                }
                names.clear();
            }
            "." => joined = true,
            word if is_word(word) && joined && !names.is_empty() => {
                joined = false;
                if let Some(last) = names.last_mut() {
                    *last += &format!(".{word}");
                }
            }
            word if SECTIONS.contains(&word) => {
                names.clear();
                open.clear();
            }
            word if is_word(word) => names.push(word.to_owned()),
            _ => names.clear(),
        }
    }
    if open.is_empty() {
        head = names;
    }
    (head, open)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn context(text: &str) -> Context {
        at(text, text.len())
    }

    #[test]
    fn dotted_names_are_followed_back() {
        let found = context("x = 1;\n  y = a.b[1, c].  de");
        assert_eq!((found.path.as_slice(), found.start), (&["a".into(), "b".into()][..], 25));
        assert_eq!(context("a.b;c").path, Vec::<String>::new());
        assert_eq!(context("model M Modelica.").path, ["Modelica"]);
    }

    #[test]
    fn open_parentheses_are_known() {
        let found = context("x = 1; parameter SI.Voltage v(start = 1, m");
        assert_eq!(found.head, ["parameter", "SI.Voltage", "v"]);
        let [open] = found.open.as_slice() else { panic!("{found:?}") };
        assert_eq!((open.name.as_str(), open.commas, open.in_value), ("v", 1, false));
        assert_eq!(open.given, ["start"]);
        let found = context("equation x = f(g(1), h(a = b.c");
        let names: Vec<&str> = found.open.iter().map(|open| open.name.as_str()).collect();
        assert_eq!(names, ["f", "h"]);
        assert!(found.open[1].in_value);
    }

    #[test]
    fn strings_and_comments_are_no_code() {
        assert_eq!(context("f(\"a\\\" b").string, Some(2));
        assert_eq!(context("f(\"a\", b").string, None);
        assert!(context("x; // a").in_comment && context("/* a").in_comment);
        assert!(!context("// a\nb").in_comment && !context("/* a */").in_comment);
    }
}
