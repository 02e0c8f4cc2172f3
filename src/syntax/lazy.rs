//! Classes whose sections are read when somebody looks at them.
//!
//! The unit is a class: its text without the bodies of the long classes in it, which are cut out
//! and stay unread in turn. Places in such an excerpt are translated back, so that a tree read
//! lazily equals the one read at once.

use super::ast::{ClassDefinition, ClassSpecifier, Element, Section, StoredDefinition};
use super::lower;
use super::outline::Outline;
use super::parser::{self, Rule};
use super::place::{Excerpt, OutlinedText, Place};
use super::scan::Dialect;
use crate::diag::Diagnostic;
use crate::source::{SourceId, Span};
use std::fmt;
use std::ops::{Deref, DerefMut};
use std::sync::{Arc, OnceLock};

/// The sections of a long class. Those of a class of a lazily read file are read at the first
/// access; they are empty if they cannot be read, which [`Sections::error`] tells.
#[derive(Clone, Default)]
pub struct Sections {
    read: OnceLock<Result<Vec<Section>, Arc<Diagnostic>>>,
    unread: Option<(Arc<OutlinedText>, usize)>,
}

/// Reads the heads of the classes of a `.mo` file, in any depth on demand. A text whose classes
/// cannot be told apart is read as a whole.
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

impl Place {
    /// The sections of a class whose body was cut out.
    pub(super) fn unread(&self, name: Span) -> Option<Sections> {
        let (text, own) = self.unread.as_ref()?;
        let class = text.outline.at(name.start as usize)?;
        let is_cut = text.outline.classes[class].body.is_some() && *own != Some(class);
        is_cut.then(|| Sections::unread(text.clone(), class))
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
        let mut place = Place::in_source(self.source);
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

impl Sections {
    /// Sections to be read from the body of an outlined class.
    pub(super) fn unread(text: Arc<OutlinedText>, class: usize) -> Sections {
        Sections { read: OnceLock::new(), unread: Some((text, class)) }
    }

    /// Why the sections could not be read, if they could not.
    pub fn error(&self) -> Option<&Diagnostic> {
        self.read().as_ref().err().map(Arc::as_ref)
    }

    /// Whether they were read already.
    pub fn is_read(&self) -> bool {
        self.read.get().is_some() || self.unread.is_none()
    }

    fn read(&self) -> &Result<Vec<Section>, Arc<Diagnostic>> {
        self.read.get_or_init(|| match &self.unread {
            Some((text, class)) => text.sections(*class).map_err(Arc::new),
            None => Ok(Vec::new()),
        })
    }

    fn into_inner(mut self) -> Vec<Section> {
        std::mem::take(&mut *self)
    }
}

impl From<Vec<Section>> for Sections {
    fn from(sections: Vec<Section>) -> Sections {
        Sections { read: OnceLock::from(Ok(sections)), unread: None }
    }
}

impl Deref for Sections {
    type Target = Vec<Section>;

    fn deref(&self) -> &Vec<Section> {
        const NONE: &Vec<Section> = &Vec::new();
        self.read().as_ref().unwrap_or(NONE)
    }
}

impl DerefMut for Sections {
    fn deref_mut(&mut self) -> &mut Vec<Section> {
        if self.read().is_err() {
            *self = Sections::from(Vec::new());
        }
        match self.read.get_mut() {
            Some(Ok(sections)) => sections,
            _ => unreachable!("they were just read"),
        }
    }
}

impl<'a> IntoIterator for &'a Sections {
    type Item = &'a Section;
    type IntoIter = std::slice::Iter<'a, Section>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

impl PartialEq for Sections {
    fn eq(&self, other: &Sections) -> bool {
        **self == **other
    }
}

impl fmt::Debug for Sections {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_list().entries(self.iter()).finish()
    }
}
