//! Documents of XML: elements with messages that say where they are, and what is being written.

use crate::FmuError;
use roxmltree::Node;
use std::borrow::Cow;
use std::fmt::{Display, Write};
use std::str::FromStr;

/// A number, very small and large ones with an exponent.
pub(crate) fn number(value: f64) -> String {
    match value {
        f64::INFINITY => "INF".to_owned(),
        f64::NEG_INFINITY => "-INF".to_owned(),
        _ if value == 0.0 || (1e-4..1e15).contains(&value.abs()) => value.to_string(),
        _ => format!("{value:e}"),
    }
}

/// The number in a text that XML takes for one: infinite ones are `INF`.
pub(crate) fn real(text: &str) -> Option<f64> {
    let digits = text.trim_start_matches(['+', '-']);
    let is_written = digits.starts_with(|c: char| c.is_ascii_digit() || c == '.');
    let is_word = ["INF", "NaN"].contains(&digits);
    text.parse().ok().filter(|_| is_written || is_word)
}

/// The text of a document. FMI requires UTF-8; Latin-1 is read where the document says so.
///
/// # Errors
/// Bytes that are neither, with their line.
pub(crate) fn decoded(bytes: &[u8]) -> Result<Cow<'_, str>, FmuError> {
    let valid = match std::str::from_utf8(bytes) {
        Ok(text) => return Ok(Cow::Borrowed(text)),
        Err(error) => error.valid_up_to(),
    };
    let head = bytes.split(|byte| *byte == b'>').next().unwrap_or_default();
    let head = String::from_utf8_lossy(head).to_lowercase();
    if head.starts_with("<?xml") && head.contains("iso-8859-1") {
        return Ok(Cow::Owned(bytes.iter().map(|byte| char::from(*byte)).collect()));
    }
    let line = 1 + bytes[..valid].iter().filter(|byte| **byte == b'\n').count();
    let message =
        format!("byte 0x{:02X} in line {line} is not UTF-8: save it as UTF-8", bytes[valid]);
    Err(FmuError::Xml(message))
}

/// A text in XML while it is written.
pub(crate) struct Xml {
    pub(crate) text: String,
    depth: usize,
    /// Whether attributes of the last element may still come.
    is_open: bool,
}

impl Xml {
    pub(crate) fn new() -> Xml {
        let text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n".to_owned();
        Xml { text, depth: 0, is_open: false }
    }

    pub(crate) fn element(&mut self, name: &str, content: impl FnOnce(&mut Xml)) {
        self.close();
        let _ = write!(self.text, "{:1$}<{name}", "", 2 * self.depth);
        self.is_open = true;
        self.depth += 1;
        content(self);
        self.depth -= 1;
        if std::mem::take(&mut self.is_open) {
            self.text.push_str("/>\n");
        } else {
            let _ = writeln!(self.text, "{:1$}</{name}>", "", 2 * self.depth);
        }
    }

    /// An element with others inside, if there are any.
    pub(crate) fn group<T>(&mut self, name: &str, all: &[T], mut each: impl FnMut(&mut Xml, &T)) {
        if !all.is_empty() {
            self.element(name, |xml| all.iter().for_each(|one| each(xml, one)));
        }
    }

    fn close(&mut self) {
        if std::mem::take(&mut self.is_open) {
            self.text.push_str(">\n");
        }
    }

    pub(crate) fn attribute(&mut self, name: &str, value: impl Display) {
        let _ = write!(self.text, " {name}=\"");
        for letter in value.to_string().chars() {
            match letter {
                '&' => self.text.push_str("&amp;"),
                '<' => self.text.push_str("&lt;"),
                '>' => self.text.push_str("&gt;"),
                '"' => self.text.push_str("&quot;"),
                // They would become blanks.
                '\t' | '\n' | '\r' => {
                    let _ = write!(self.text, "&#{};", u32::from(letter));
                }
                // No text of XML 1.0 has them.
                _ if letter.is_control() && u32::from(letter) < 32 => self.text.push('\u{fffd}'),
                '\u{fffe}' | '\u{ffff}' => self.text.push('\u{fffd}'),
                _ => self.text.push(letter),
            }
        }
        self.text.push('"');
    }

    pub(crate) fn optional(&mut self, name: &str, value: Option<&(impl Display + ?Sized)>) {
        if let Some(value) = value {
            self.attribute(name, value);
        }
    }

    pub(crate) fn unless<T: Display + PartialEq>(&mut self, name: &str, value: T, default: T) {
        if value != default {
            self.attribute(name, value);
        }
    }
}

/// An element, with messages that say where it is.
#[derive(Clone, Copy)]
pub(crate) struct Element<'a, 'i>(pub(crate) Node<'a, 'i>);

impl<'a, 'i> Element<'a, 'i> {
    pub(crate) fn name(&self) -> &'a str {
        self.0.tag_name().name()
    }

    /// The line in which it begins, from 1.
    pub(crate) fn line(&self) -> u32 {
        self.0.document().text_pos_at(self.0.range().start).row
    }

    pub(crate) fn error(&self, message: String) -> FmuError {
        FmuError::Description { line: self.line(), message }
    }

    pub(crate) fn children(&self) -> Vec<Element<'a, 'i>> {
        self.0.children().filter(Node::is_element).map(Element).collect()
    }

    pub(crate) fn child(&self, name: &str) -> Option<Element<'a, 'i>> {
        self.children().into_iter().find(|child| child.name() == name)
    }

    /// The elements of a name in a group.
    pub(crate) fn elements(&self, group: &str, name: &str) -> Vec<Element<'a, 'i>> {
        let inside = self.child(group).map_or(Vec::new(), |group| group.children());
        inside.into_iter().filter(|child| child.name() == name).collect()
    }

    pub(crate) fn get(&self, name: &str) -> Option<&'a str> {
        self.0.attribute(name)
    }

    pub(crate) fn text(&self, name: &str) -> Option<String> {
        self.get(name).map(str::to_owned)
    }

    pub(crate) fn required(&self, name: &str) -> Result<&'a str, FmuError> {
        self.get(name)
            .ok_or_else(|| self.error(format!("`{}` has no attribute `{name}`", self.name())))
    }

    pub(crate) fn wrong(&self, name: &str, value: &str) -> FmuError {
        self.error(format!("`{value}` is not a value of the attribute `{name}`"))
    }

    pub(crate) fn word<T>(
        &self,
        name: &str,
        of: fn(&str) -> Option<T>,
    ) -> Result<Option<T>, FmuError> {
        let Some(value) = self.get(name) else { return Ok(None) };
        of(value).map(Some).ok_or_else(|| self.wrong(name, value))
    }

    pub(crate) fn parsed<T: FromStr>(&self, name: &str) -> Result<Option<T>, FmuError> {
        let Some(value) = self.get(name) else { return Ok(None) };
        value.trim().parse().map(Some).map_err(|_| self.wrong(name, value))
    }

    pub(crate) fn needed<T: FromStr>(&self, name: &str) -> Result<T, FmuError> {
        let value = self.required(name)?;
        value.trim().parse().map_err(|_| self.wrong(name, value))
    }

    pub(crate) fn list<T: FromStr>(&self, name: &str) -> Result<Option<Vec<T>>, FmuError> {
        let Some(value) = self.get(name) else { return Ok(None) };
        let all = value.split_whitespace().map(str::parse).collect::<Result<_, _>>();
        all.map(Some).map_err(|_| self.wrong(name, value))
    }

    pub(crate) fn truth(&self, name: &str) -> Result<Option<bool>, FmuError> {
        self.word(name, |value| match value.trim() {
            "true" | "1" => Some(true),
            "false" | "0" => Some(false),
            _ => None,
        })
    }

    pub(crate) fn is_true(&self, name: &str) -> Result<bool, FmuError> {
        Ok(self.truth(name)?.unwrap_or(false))
    }
}
