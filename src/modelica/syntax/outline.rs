//! Where the classes of a text begin and end, found without reading what is in them.
//!
//! Outside brackets a keyword such as `model` always begins a class (MLS §2.3.3: it is not an
//! identifier), and `end` followed by anything but `if`, `for`, `while` or `when` ends one. So one
//! pass that knows strings, comments, quoted identifiers and brackets is enough.

use memchr::{memchr, memchr2};
use std::ops::Range;

/// The classes of a text in the order of their names, which is outer before inner.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Outline {
    /// The classes.
    pub classes: Vec<OutlinedClass>,
}

/// The places of one class, in bytes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct OutlinedClass {
    /// Its identifier.
    pub name: Range<usize>,
    /// From the keyword (`model`, …) to its end, `;` excluded; only the head of a short class.
    pub whole: Range<usize>,
    /// What stands between the head with its description and `end`; `None` for a short class.
    pub body: Option<Range<usize>>,
    /// The class around it.
    pub parent: Option<usize>,
}

impl Outline {
    /// The outline of a text; `None` if brackets, strings, comments or `end`s do not match, which
    /// the parser explains.
    pub fn of(text: &str) -> Option<Outline> {
        let mut scan = Scan { text: text.as_bytes(), at: 0, classes: Vec::new(), open: Vec::new() };
        scan.run()?;
        Some(Outline { classes: scan.classes })
    }

    /// The class whose name begins at this byte.
    pub fn at(&self, name: usize) -> Option<usize> {
        self.classes.binary_search_by_key(&name, |class| class.name.start).ok()
    }

    /// The long classes directly in a class, or in the text.
    pub(super) fn long_inside(&self, parent: Option<usize>) -> impl Iterator<Item = Range<usize>> {
        let first = parent.map_or(0, |parent| parent + 1);
        let end = parent.map_or(usize::MAX, |parent| self.classes[parent].whole.end);
        self.classes[first..]
            .iter()
            .take_while(move |class| class.name.start < end)
            .filter(move |class| class.parent == parent)
            .filter_map(|class| class.body.clone())
    }
}

/// Classes inside each other that are still outlined: as many as the parser reads.
const MAX_NESTING: usize = 200;

struct Scan<'t> {
    text: &'t [u8],
    at: usize,
    classes: Vec<OutlinedClass>,
    open: Vec<usize>,
}

impl Scan<'_> {
    fn run(&mut self) -> Option<()> {
        while let Some(byte) = self.peek(0) {
            match byte {
                b'a'..=b'z' | b'A'..=b'Z' | b'_' | b'0'..=b'9' => self.word()?,
                _ => self.other(byte)?,
            }
        }
        self.open.is_empty().then_some(())
    }

    fn peek(&self, ahead: usize) -> Option<u8> {
        self.text.get(self.at + ahead).copied()
    }

    /// Passes what is neither word nor number, whole brackets at once.
    fn other(&mut self, byte: u8) -> Option<()> {
        match byte {
            b'"' => self.quoted(b'"'),
            b'\'' => self.quoted(b'\''),
            b'(' | b'[' | b'{' => self.brackets(),
            b'/' => self.slash(),
            _ => {
                self.at += 1;
                Some(())
            }
        }
    }

    /// From an opening bracket to the end of its partner. One that is not closed before a `;`
    /// outside `[…]` ends there: the parser tells of it when it reads the class.
    fn brackets(&mut self) -> Option<()> {
        let mut open = Vec::new();
        while let Some(byte) = self.peek(0) {
            match byte {
                b'(' | b'[' | b'{' => open.push(byte),
                b')' | b']' | b'}' => {
                    open.pop();
                    if open.is_empty() {
                        self.at += 1;
                        return Some(());
                    }
                }
                b';' if open.last() != Some(&b'[') => return Some(()),
                b'"' | b'\'' => {
                    self.quoted(byte)?;
                    continue;
                }
                b'/' => {
                    self.slash()?;
                    continue;
                }
                _ => {}
            }
            self.at += 1;
        }
        None
    }

    /// A division, or a comment.
    fn slash(&mut self) -> Option<()> {
        match self.peek(1) {
            Some(b'/') => {
                let rest = &self.text[self.at..];
                self.at += memchr(b'\n', rest).unwrap_or(rest.len());
            }
            Some(b'*') => {
                self.at += 2;
                loop {
                    self.at += memchr(b'*', &self.text[self.at..])? + 1;
                    if self.peek(0)? == b'/' {
                        self.at += 1;
                        break;
                    }
                }
            }
            _ => self.at += 1,
        }
        Some(())
    }

    fn quoted(&mut self, quote: u8) -> Option<()> {
        let start = self.at;
        self.at += 1;
        loop {
            self.at += memchr2(quote, b'\\', self.text.get(self.at..)?)?;
            if self.text[self.at] == quote {
                break;
            }
            self.at += 2;
        }
        let is_identifier = quote == b'\'';
        let broken = is_identifier && memchr(b'\n', &self.text[start..self.at]).is_some();
        self.at += 1;
        (!broken).then_some(())
    }

    fn word(&mut self) -> Option<()> {
        let word = self.take_word();
        match &self.text[word.clone()] {
            b"class" | b"model" | b"block" | b"record" | b"connector" | b"type" | b"package"
            | b"function" | b"operator" => self.class(word.start),
            b"end" => self.end(),
            _ => Some(()),
        }
    }

    fn take_word(&mut self) -> Range<usize> {
        let start = self.at;
        let rest = &self.text[start..];
        let is_inside = |byte: &u8| byte.is_ascii_alphanumeric() || *byte == b'_';
        self.at += rest.iter().position(|byte| !is_inside(byte)).unwrap_or(rest.len());
        start..self.at
    }

    /// The word or quoted identifier that comes next; empty if something else does.
    fn next_name(&mut self) -> Option<Range<usize>> {
        self.skip_blanks()?;
        if self.peek(0) == Some(b'\'') {
            let start = self.at;
            self.quoted(b'\'')?;
            return Some(start..self.at);
        }
        Some(self.take_word())
    }

    fn skip_blanks(&mut self) -> Option<()> {
        while let Some(byte) = self.peek(0) {
            match byte {
                b' ' | b'\t'..=b'\r' => self.at += 1,
                b'/' if matches!(self.peek(1), Some(b'/' | b'*')) => self.slash()?,
                // A byte-order mark or a hard blank, which the scanner of the parser blanks too.
                0xef if self.text[self.at..].starts_with(b"\xef\xbb\xbf") => self.at += 3,
                0xc2 if self.peek(1) == Some(0xa0) => self.at += 2,
                _ => break,
            }
        }
        Some(())
    }

    /// A class, from the end of its keyword on: a long one is entered, of a short one the head is
    /// passed.
    fn class(&mut self, start: usize) -> Option<()> {
        let mut name = self.next_name()?;
        while matches!(&self.text[name.clone()], b"record" | b"function") {
            name = self.next_name()?;
        }
        let extends = &self.text[name.clone()] == b"extends";
        if extends {
            name = self.next_name()?;
        }
        if name.is_empty() || self.open.len() >= MAX_NESTING {
            return None;
        }
        self.skip_blanks()?;
        let parent = self.open.last().copied();
        let mut class =
            OutlinedClass { whole: start..name.end, name: name.clone(), body: None, parent };
        if self.peek(0) != Some(b'=') {
            let body = self.head(name.end, extends)?;
            class.body = Some(body..body);
            self.open.push(self.classes.len());
        }
        self.classes.push(class);
        Some(())
    }

    /// The modification of a class extends and the description; returns where the body begins.
    fn head(&mut self, name_end: usize, extends: bool) -> Option<usize> {
        let mut body = name_end;
        if extends && self.peek(0) == Some(b'(') {
            self.brackets()?;
            body = self.at;
            self.skip_blanks()?;
        }
        while self.peek(0) == Some(b'"') {
            self.quoted(b'"')?;
            body = self.at;
            self.skip_blanks()?;
            if self.peek(0) == Some(b'+') {
                self.at += 1;
                self.skip_blanks()?;
            }
        }
        Some(body)
    }

    fn end(&mut self) -> Option<()> {
        let end = self.at - b"end".len();
        let name = self.next_name()?;
        if matches!(&self.text[name.clone()], b"if" | b"for" | b"while" | b"when") {
            return Some(());
        }
        let class = &mut self.classes[self.open.pop()?];
        if self.text[class.name.clone()] != self.text[name.clone()] {
            return None;
        }
        class.whole.end = name.end;
        class.body = class.body.take().map(|body| body.start..end);
        Some(())
    }
}
