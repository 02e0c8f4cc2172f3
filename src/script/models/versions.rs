//! Versions of libraries: those that were asked for, that loaded ones name, and that are loaded (MLS §18.8).

use super::classes::Classes;
use crate::diag::Fault;
use crate::errors::OTHER_VERSION;
use crate::fault;
use crate::name::{Ident, Name};
use crate::packages;
use crate::syntax::ast::{
    Annotation, Argument, Binding, ClassDefinition, ClassSpecifier, ExpressionKind, Modification,
    Section,
};

impl Classes {
    /// Notes the versions that loaded packages ask for.
    pub(super) fn note_versions_used(&mut self, names: &[Name]) {
        for name in names {
            let Some(definition) = self.library.definition(name) else { continue };
            for (library, version) in uses(&definition) {
                self.versions.entry(library).or_insert(version);
            }
        }
    }

    /// The `version` annotation of a loaded package; empty without.
    pub(crate) fn version_of(&self, name: &Name) -> Result<String, Fault> {
        let definition = self.library.definition(name);
        let definition = definition.ok_or_else(|| self.class_to_load(name))?;
        Ok(version(&definition).unwrap_or_default())
    }

    /// The warning about a library that is older than what was asked for, or of another main
    /// version. The library in the program serves models of all versions.
    pub(super) fn other_version(&self, name: &Name) -> Option<Fault> {
        let required = self.versions.get(&name.first()?)?;
        let definition = self.library.definition(name)?;
        let loaded = version(&definition)?;
        let is_shipped = self.file_of(name)?.starts_with(packages::FOLDER);
        let (asked, given) = (numbers(required), numbers(&loaded));
        let fits = asked.first() == given.first() && asked <= given;
        let converts = match self.library.converts_from(name, required) {
            true => "its conversion script is applied; ",
            false => "",
        };
        (!fits && !is_shipped).then(|| {
            fault!(OTHER_VERSION, "version {loaded} of library `{name}` is loaded, but version \
                                   {required} is required";
                help: "{converts}if results differ, give the folder of the required version with \
                       `--library`")
        })
    }
}

/// The numbers of a version, for comparison.
pub(super) fn numbers(text: &str) -> Vec<u64> {
    text.split(|c: char| !c.is_ascii_digit()).filter_map(|part| part.parse().ok()).collect()
}

/// The `version` annotation of a package (MLS §18.8.2).
fn version(definition: &ClassDefinition) -> Option<String> {
    string(annotated(definition, "version")?)
}

/// The libraries that a package uses, with their versions (MLS §18.8.3).
fn uses(definition: &ClassDefinition) -> Vec<(Ident, String)> {
    let Some(uses) = annotated(definition, "uses") else { return Vec::new() };
    let library = |argument: &Argument| {
        let (name, modification) = named(argument)?;
        let version = modification.arguments.iter().filter_map(named);
        let version = version.filter(|(name, _)| *name == "version").find_map(|(_, v)| string(v));
        Some((name, version?))
    };
    uses.arguments.iter().filter_map(library).collect()
}

/// What an annotation of a class says about a name.
fn annotated<'a>(definition: &'a ClassDefinition, name: &str) -> Option<&'a Modification> {
    let ClassSpecifier::Long(long) = &definition.specifier else { return None };
    let annotation = |section: &'a Section| match section {
        Section::Annotation(Annotation { arguments, .. }) => Some(arguments),
        _ => None,
    };
    let mut arguments = long.sections.iter().filter_map(annotation).flatten().filter_map(named);
    arguments.find(|(known, _)| *known == name).map(|(_, modification)| modification)
}

fn named(argument: &Argument) -> Option<(Ident, &Modification)> {
    match argument {
        Argument::Element(element) => {
            Some((element.name.node.last()?, element.modification.as_ref()?))
        }
        Argument::Redeclaration(_) => None,
    }
}

fn string(modification: &Modification) -> Option<String> {
    let Some(Binding::Expression(value)) = &modification.binding else { return None };
    match &value.kind {
        ExpressionKind::String(text) => Some(text.to_string()),
        _ => None,
    }
}
