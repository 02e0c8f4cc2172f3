//! Files whose classes are read at the first access.
//!
//! The unit is a class: its text without the bodies of the long classes in it, which are cut out
//! and stay unread in turn. Places in such an excerpt are translated back, so that a tree read
//! lazily equals the one read at once.

use super::ast::{ClassDefinition, ClassSpecifier, Element, Section, Sections, StoredDefinition};
use super::lazy::Unread;
use super::lower;
use super::outline::Outline;
use super::parser::{self, Rule};
use super::place::{Excerpt, OutlinedText, TextOrigin};
use super::scan::Dialect;
use crate::diag::Diagnostic;
use crate::source::{SourceId, Span};
use std::sync::Arc;

/// A class of an outlined text, whose sections are not read yet.
struct UnreadClass {
    text: Arc<OutlinedText>,
    class: usize,
}

impl Unread<Vec<Section>> for UnreadClass {
    fn read(&self) -> Result<Vec<Section>, Diagnostic> {
        self.text.sections(self.class)
    }
}

/// Reads the heads of the classes of a `.mo` file, in any depth on demand. A file whose classes
/// cannot be separated is read as a whole.
///
/// # Errors
/// A syntax error outside the bodies of the classes, or one that hides where they end.
pub(super) fn stored_definition(
    source: SourceId,
    text: &Arc<str>,
) -> Result<StoredDefinition, Diagnostic> {
    let Some(outline) = Outline::of(text) else {
        return super::parse_stored_definition(source, text);
    };
    let text = Arc::new(OutlinedText { source, text: text.clone(), outline });
    let Excerpt { text, place } = text.excerpt(None);
    let rule = Rule::stored_definition;
    parser::parse(&place, &text, rule, Dialect::Modelica, lower::stored_definition)
}

/// The syntax errors of a class and of those in it, in the order of the text.
pub(super) fn errors(class: &ClassDefinition) -> Vec<Diagnostic> {
    let ClassSpecifier::Long(long) = &class.specifier else { return Vec::new() };
    let mut errors: Vec<Diagnostic> = long.sections.error().cloned().into_iter().collect();
    for section in &long.sections {
        let Section::Elements { elements, .. } = section else { continue };
        for element in elements {
            if let Element::Class(nested) = element {
                errors.extend(self::errors(&nested.class));
            }
        }
    }
    errors
}

impl TextOrigin {
    /// The sections of a class whose body was cut out.
    pub(super) fn unread(&self, name: Span) -> Option<Sections> {
        let (text, own) = self.unread.as_ref()?;
        let class = text.outline.at(name.start as usize)?;
        let is_cut = text.outline.classes[class].body.is_some() && *own != Some(class);
        is_cut.then(|| Sections::unread(Arc::new(UnreadClass { text: text.clone(), class })))
    }
}

impl OutlinedText {
    /// A class, or the whole text, without the bodies of the classes in it.
    fn excerpt(self: &Arc<Self>, class: Option<usize>) -> Excerpt {
        let whole = match class {
            Some(class) => self.outline.classes[class].whole.clone(),
            None => 0..self.text.len(),
        };
        let cuts = self.outline.long_inside(class);
        let mut place = TextOrigin::in_source(self.source);
        place.unread = Some((self.clone(), class));
        Excerpt::new(place, &self.text, whole, cuts)
    }

    fn sections(self: &Arc<Self>, class: usize) -> Result<Vec<Section>, Diagnostic> {
        let Excerpt { text, place } = self.excerpt(Some(class));
        let rule = Rule::lone_class;
        let definition = parser::parse(&place, &text, rule, Dialect::Modelica, lower::lone_class)?;
        match Arc::unwrap_or_clone(definition).specifier {
            ClassSpecifier::Long(long) => Ok(long.sections.into_inner()),
            _ => Ok(Vec::new()),
        }
    }
}
