//! Sizes and components of values, known when a model is compiled.

use super::string_array::StringArray;
pub(super) use super::string_array::UNKNOWN_TEXT;
use std::sync::Arc;

/// Sizes of an argument.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub enum Shape {
    /// A scalar (no sizes) or an array.
    Array(Vec<usize>),
    /// A record: name and shape of its components.
    Record(Vec<(crate::name::Ident, Shape)>),
    /// A text, no scalar; `…` stands for what is not known when compiling.
    Text(Arc<str>),
    /// An array of Strings, no scalars.
    Strings(StringArray),
    /// A text that is known at run time: the scalar is its number.
    Numbered,
}

impl Shape {
    /// Number of scalars.
    pub fn len(&self) -> usize {
        match self {
            Shape::Array(dims) => dims.iter().product(),
            Shape::Record(fields) => fields.iter().map(|(_, shape)| shape.len()).sum(),
            Shape::Text(_) | Shape::Strings(_) => 0,
            Shape::Numbered => 1,
        }
    }

    /// Whether there are no scalars.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The shape of an array of these; that of an array of records is a record of arrays.
    pub fn repeated(self, dims: &[usize]) -> Shape {
        match self {
            Shape::Array(own) => Shape::Array(dims.iter().copied().chain(own).collect()),
            Shape::Record(fields) => {
                let field = |(name, shape): (_, Shape)| (name, shape.repeated(dims));
                Shape::Record(fields.into_iter().map(field).collect())
            }
            Shape::Text(_) | Shape::Strings(_) | Shape::Numbered => self,
        }
    }

    /// Whether it is a text without a number, or a record with one.
    pub(crate) fn holds_text(&self) -> bool {
        match self {
            Shape::Array(_) | Shape::Numbered => false,
            Shape::Record(fields) => fields.iter().any(|(_, shape)| shape.holds_text()),
            Shape::Text(_) | Shape::Strings(_) => true,
        }
    }

    /// Whether a String in it is not known.
    pub(crate) fn holds_unknown_text(&self) -> bool {
        match self {
            Shape::Array(_) | Shape::Numbered => false,
            Shape::Record(fields) => fields.iter().any(|(_, shape)| shape.holds_unknown_text()),
            Shape::Text(text) => text.contains(UNKNOWN_TEXT),
            Shape::Strings(strings) => {
                strings.strings.iter().any(|text| text.contains(UNKNOWN_TEXT))
            }
        }
    }

    /// Whether it is the number of a text, or a record with one.
    pub(crate) fn holds_number_of_text(&self) -> bool {
        match self {
            Shape::Numbered => true,
            Shape::Record(fields) => fields.iter().any(|(_, shape)| shape.holds_number_of_text()),
            Shape::Array(_) | Shape::Text(_) | Shape::Strings(_) => false,
        }
    }

    /// Makes all Strings unknown.
    pub(crate) fn forget_strings(&mut self) {
        match self {
            Shape::Array(_) | Shape::Numbered => {}
            Shape::Record(fields) => fields.iter_mut().for_each(|(_, s)| s.forget_strings()),
            Shape::Text(text) => *text = UNKNOWN_TEXT.into(),
            Shape::Strings(strings) => strings.forget(),
        }
    }

    /// The shape of a value that may have either shape: Strings that differ are not known. `None`
    /// if sizes or components differ.
    pub fn joined(&self, other: &Shape) -> Option<Shape> {
        match (self, other) {
            (Shape::Array(a), Shape::Array(b)) => (a == b).then(|| self.clone()),
            (Shape::Text(a), Shape::Text(b)) if a == b => Some(self.clone()),
            (Shape::Text(_), Shape::Text(_)) => Some(Shape::Text(UNKNOWN_TEXT.into())),
            (Shape::Numbered, Shape::Numbered) => Some(Shape::Numbered),
            (Shape::Strings(a), Shape::Strings(b)) => a.joined(b).map(Shape::Strings),
            // Arrays whose sizes are not looked at are one text, which is not known.
            (Shape::Strings(a), Shape::Text(_)) | (Shape::Text(_), Shape::Strings(a)) => {
                Some(Shape::Strings(StringArray::unknown(a.dims.clone())))
            }
            (Shape::Record(a), Shape::Record(b)) if a.len() == b.len() => {
                let fields = a.iter().zip(b);
                let joined = |((name, a), (other, b)): (&(_, Shape), &(_, Shape))| {
                    let shape = a.joined(b)?;
                    (name == other).then_some((*name, shape))
                };
                fields.map(joined).collect::<Option<_>>().map(Shape::Record)
            }
            _ => None,
        }
    }
}
