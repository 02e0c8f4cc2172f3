//! What old libraries do otherwise, reported once for each library.

use crate::diag::{Diagnostic, Fault};
use crate::flatten::errors::OLD_LIBRARY;
use crate::name::Ident;
use crate::source::Span;
use crate::syntax::ast::{Annotation, Argument, Section};
use std::collections::BTreeSet;
use std::sync::{Arc, Mutex, PoisonError};

/// A way of writing that today's Modelica does not have and that changes nothing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(in crate::flatten) enum LegacyConstruct {
    /// A file in a package's folder says nothing about where it belongs.
    NoWithin,
    /// It names another package than that of its folder.
    OtherWithin,
    /// A folder with another name than its package's.
    FolderName,
    /// A file with another name than its class's.
    FileName,
    /// An annotation before other sections, or more than one.
    AnnotationPlace,
    /// The annotations that drew classes in Modelica 1 and 2.
    OldGraphics,
    /// An `outer` component with a value or other modifiers, which the inner one does not take.
    OuterValue,
    /// A variable of a function that is neither input nor output, and not protected.
    PublicVariable,
    /// A `connect` equation of variables that are not connectors.
    ConnectedVariable,
    /// `if initial() then …` without `else` in an equation section.
    InitialBranch,
}

/// The legacy constructs found in each library.
#[derive(Debug, Clone, Default)]
pub(super) struct LegacyConstructs {
    met: Arc<Mutex<Met>>,
}

#[derive(Debug, Default)]
struct Met {
    known: BTreeSet<(Ident, LegacyConstruct)>,
    unreported: Vec<Diagnostic>,
}

impl LegacyConstruct {
    fn fault(self, library: Ident) -> Fault {
        let (what, remedy) = match self {
            LegacyConstruct::NoWithin => {
                ("files without a `within` clause", "write `within` and the package's full name")
            }
            LegacyConstruct::OtherWithin => (
                "files whose `within` clause does not match their folder",
                "move the file, or write the name of the package of its folder",
            ),
            LegacyConstruct::FolderName => {
                ("folders whose names differ from their packages", "rename the folder")
            }
            LegacyConstruct::FileName => {
                ("files whose names differ from their classes", "rename the file")
            }
            LegacyConstruct::AnnotationPlace => (
                "annotations before other elements, or several annotations in one class",
                "write one annotation at the end of the class",
            ),
            LegacyConstruct::OldGraphics => (
                "graphical annotations of Modelica 1 or 2, which are ignored",
                "to display diagrams, convert the library to Modelica 3",
            ),
            LegacyConstruct::OuterValue => (
                "`outer` components with modifiers, which are ignored",
                "set the values in the inner components",
            ),
            LegacyConstruct::ConnectedVariable => (
                "`connect` equations of variables that are not connectors, which are taken as equal",
                "write an equation, or give the variables the type of a connector",
            ),
            LegacyConstruct::InitialBranch => (
                "equations in `if initial() then`, which are taken as initial equations",
                "write them in an `initial equation` section",
            ),
            LegacyConstruct::PublicVariable => (
                "public variables of functions that are neither input nor output",
                "move them after `protected`",
            ),
        };
        Fault::new(OLD_LIBRARY, format!("library `{library}` has {what}")).help(remedy)
    }
}

impl LegacyConstructs {
    /// Notes that a library has a construct, at the first place met.
    pub(super) fn meet(&self, library: Option<Ident>, construct: LegacyConstruct, span: Span) {
        let Some(library) = library else { return };
        let mut met = self.met.lock().unwrap_or_else(PoisonError::into_inner);
        if met.known.insert((library, construct)) {
            met.unreported.push(construct.fault(library).at(span).warning());
        }
    }

    /// The warnings since the last call.
    pub(super) fn take(&self) -> Vec<Diagnostic> {
        let mut met = self.met.lock().unwrap_or_else(PoisonError::into_inner);
        std::mem::take(&mut met.unreported)
    }

    /// Whether a library was written for an old Modelica.
    pub(super) fn is_old(&self, library: Ident) -> bool {
        let met = self.met.lock().unwrap_or_else(PoisonError::into_inner);
        met.known.iter().any(|(known, _)| *known == library)
    }
}

/// The legacy constructs that the sections of a class show.
pub(super) fn of_sections(sections: &[Section]) -> Vec<(LegacyConstruct, Span)> {
    let annotation = |section: &Section| match section {
        Section::Annotation(annotation) => Some(annotation.span),
        _ => None,
    };
    let mut found = Vec::new();
    let before_last = sections.split_last().map_or(&[][..], |(_, before)| before);
    if let Some(span) = before_last.iter().find_map(annotation) {
        found.push((LegacyConstruct::AnnotationPlace, span));
    }
    let old = sections.iter().find_map(|section| match section {
        Section::Annotation(annotation) => old_graphics(annotation),
        _ => None,
    });
    found.extend(old.map(|span| (LegacyConstruct::OldGraphics, span)));
    found
}

fn old_graphics(annotation: &Annotation) -> Option<Span> {
    let is_old = |argument: &Argument| match argument {
        Argument::Element(element) => {
            let name = element.name.node.last()?;
            matches!(name.as_str(), "Coordsys" | "Window").then_some(element.name.span)
        }
        Argument::Redeclaration(_) => None,
    };
    annotation.arguments.iter().find_map(is_old)
}
