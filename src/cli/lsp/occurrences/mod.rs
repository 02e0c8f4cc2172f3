//! What every name that is written in a document means: what hover, definitions, references, renaming
//! and colours are made of.

mod classes;
mod expressions;
mod identifiers;

use super::parsed::Parsed;
use super::recovery::Tree;
use crate::flatten::{ClassId, Declared, Library};
use crate::name::{Ident, Name};
use crate::syntax::ast::{ClassDefinition, InteractiveKind, StatementKind};
pub(crate) use identifiers::{identifiers, is_identifier};
use std::collections::BTreeSet;
use std::ops::Range;

/// What a name means.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Entity {
    /// Something that a class declares, or a class.
    Declared(Declared),
    /// A loop variable, by the place where it is declared.
    Loop(usize),
    /// A variable of a script.
    Variable(Ident),
    /// A function or operator of the language, or a command of scripts.
    Function(Ident),
}

/// A name in a text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Occurrence {
    /// Its bytes.
    pub range: Range<usize>,
    /// What it means.
    pub(crate) entity: Entity,
    /// Whether it is declared here.
    pub(crate) is_declaration: bool,
}

/// The names of a document that mean something, in the order of the text.
pub(crate) fn of(
    library: &Library,
    parsed: &Parsed,
    commands: &BTreeSet<&'static str>,
) -> Vec<Occurrence> {
    let Some(tree) = &parsed.tree else { return Vec::new() };
    let mut walk = OccurrenceSearch {
        library,
        text: &parsed.document.text,
        found: Vec::new(),
        scope: None,
        loops: Vec::new(),
        variables: None,
        commands,
    };
    match tree {
        Tree::Classes(file) => {
            if let Some(within) = &file.within {
                let parts = library.parts_of_type(None, &within.node);
                walk.name(within.span, &parts);
            }
            walk.document_classes(parsed);
        }
        Tree::Script(script) => {
            walk.document_classes(parsed);
            walk.variables = Some(assigned(script));
            script.statements.iter().for_each(|statement| walk.interactive(&statement.kind));
        }
    }
    let mut found = walk.found;
    found.sort_by_key(|one| (one.range.start, one.range.end));
    found.dedup_by(|one, other| one.range == other.range);
    found
}

/// The occurrence at a byte: that around it, or else that which ends there.
pub(crate) fn at(all: &[Occurrence], offset: usize) -> Option<&Occurrence> {
    all.iter()
        .find(|one| one.range.contains(&offset))
        .or_else(|| all.iter().find(|one| one.range.end == offset))
}

/// The variables that a script assigns or declares.
fn assigned(script: &crate::syntax::ast::Script) -> BTreeSet<Ident> {
    struct Targets(BTreeSet<Ident>);
    impl crate::syntax::visit::Visit for Targets {
        fn statement(&mut self, statement: &crate::syntax::ast::Statement) {
            match &statement.kind {
                StatementKind::Assign { target, .. } => _ = self.0.insert(target.parts[0].name),
                StatementKind::MultiAssign { targets, .. } => {
                    let names = targets.iter().flatten().map(|target| target.parts[0].name);
                    self.0.extend(names);
                }
                _ => {}
            }
            crate::syntax::visit::walk_statement(self, statement);
        }
        fn expression(&mut self, _: &crate::syntax::ast::Expression) {}
    }
    let mut targets = Targets(BTreeSet::new());
    for statement in &script.statements {
        match &statement.kind {
            InteractiveKind::Statement(statement) => {
                crate::syntax::visit::Visit::statement(&mut targets, statement);
            }
            InteractiveKind::Declaration(clause) => {
                targets.0.extend(clause.components.iter().map(|one| one.name.node));
            }
            _ => {}
        }
    }
    targets.0
}

/// A walk over a document.
struct OccurrenceSearch<'a> {
    library: &'a Library,
    text: &'a str,
    found: Vec<Occurrence>,
    /// The class whose text is walked; `None` at the top.
    scope: Option<ClassId>,
    /// Loop variables that are in force, with the places of their declarations.
    loops: Vec<(Ident, usize)>,
    /// The variables of the script, where its statements are walked.
    variables: Option<BTreeSet<Ident>>,
    /// The commands of scripts.
    commands: &'a BTreeSet<&'static str>,
}

impl OccurrenceSearch<'_> {
    fn document_classes(&mut self, parsed: &Parsed) {
        for (name, class) in parsed.names.iter().zip(parsed.classes()) {
            self.named_class(name, class);
        }
    }

    /// A class of this full name, if the library has it from this text.
    fn named_class(&mut self, name: &Name, class: &ClassDefinition) {
        if let Some(id) = self.library.find(name) {
            self.class(id, class);
        }
    }

    fn add(&mut self, range: Range<usize>, entity: Entity, is_declaration: bool) {
        if !range.is_empty() && range.end <= self.text.len() {
            self.found.push(Occurrence { range, entity, is_declaration });
        }
    }
}
