//! Elements of an SBML document, with faults at their places.

use crate::Refusal;
use crate::diag::Fault;
use crate::registry::BAD_OPTION;
use roxmltree::Node;

/// An element.
#[derive(Clone, Copy)]
pub(super) struct Element<'a, 'i>(pub(super) Node<'a, 'i>);

impl<'a, 'i> Element<'a, 'i> {
    pub(super) fn name(&self) -> &'a str {
        self.0.tag_name().name()
    }

    /// A fault at its start tag.
    pub(super) fn refusal(&self, fault: Fault) -> Refusal {
        let range = self.0.range();
        let text = self.0.document().input_text().get(range.clone()).unwrap_or_default();
        let tag = text.find('>').map_or(text.len(), |end| end + 1);
        let line = text.find('\n').unwrap_or(text.len());
        Refusal::new(range.start..range.start + tag.min(line), fault)
    }

    pub(super) fn wrong(&self, message: impl Into<String>) -> Refusal {
        self.refusal(Fault::new(BAD_OPTION, message))
    }

    /// Something of SBML that is not imported.
    pub(super) fn unsupported(&self, what: &str) -> Refusal {
        self.wrong(format!("{what} is not supported"))
    }

    /// Its child elements, without notes and annotations, and without those of packages.
    pub(super) fn children(&self) -> impl Iterator<Item = Element<'a, 'i>> + use<'a, 'i> {
        let own = self.0.tag_name().namespace();
        let is_math = |name: &str| name == "math";
        self.0
            .children()
            .filter(move |child| {
                let name = child.tag_name();
                child.is_element()
                    && (name.namespace() == own || is_math(name.name()))
                    && !["notes", "annotation"].contains(&name.name())
            })
            .map(Element)
    }

    pub(super) fn child(&self, name: &str) -> Option<Element<'a, 'i>> {
        self.children().find(|child| child.name() == name)
    }

    /// The elements of a list, such as `listOfSpecies`.
    pub(super) fn list(&self, name: &str) -> Vec<Element<'a, 'i>> {
        self.child(name).map_or(Vec::new(), |list| list.children().collect())
    }

    pub(super) fn get(&self, name: &str) -> Option<&'a str> {
        self.0.attribute(name)
    }

    pub(super) fn text(&self, name: &str) -> Option<String> {
        self.get(name).map(|text| text.trim().to_owned())
    }

    pub(super) fn required(&self, name: &str) -> Result<String, Refusal> {
        let missing = || self.wrong(format!("`{}` has no attribute `{name}`", self.name()));
        self.text(name).ok_or_else(missing)
    }

    pub(super) fn number(&self, name: &str) -> Result<Option<f64>, Refusal> {
        let Some(text) = self.get(name) else { return Ok(None) };
        let value = number(text).ok_or_else(|| self.wrong(format!("`{text}` is not a number")))?;
        Ok(Some(value))
    }

    pub(super) fn truth(&self, name: &str, default: bool) -> Result<bool, Refusal> {
        match self.get(name).map(str::trim) {
            None => Ok(default),
            Some("true" | "1") => Ok(true),
            Some("false" | "0") => Ok(false),
            Some(other) => Err(self.wrong(format!("`{name}` is `{other}`, not true or false"))),
        }
    }

    /// The text of its notes.
    pub(super) fn notes(&self) -> String {
        let notes = self.0.children().find(|node| node.tag_name().name() == "notes");
        notes.map_or(String::new(), |notes| Element(notes).words())
    }

    /// All text in it, white space reduced.
    pub(super) fn words(&self) -> String {
        let text: Vec<&str> = self
            .0
            .descendants()
            .filter(|node| node.is_text())
            .filter_map(|node| node.text())
            .collect();
        text.iter().flat_map(|part| part.split_whitespace()).collect::<Vec<_>>().join(" ")
    }
}

/// A number of XML.
pub(super) fn number(text: &str) -> Option<f64> {
    match text.trim() {
        "INF" => Some(f64::INFINITY),
        "-INF" => Some(f64::NEG_INFINITY),
        "NaN" => Some(f64::NAN),
        other if other.ends_with(|c: char| c.is_ascii_digit() || c == '.') => other.parse().ok(),
        _ => None,
    }
}
