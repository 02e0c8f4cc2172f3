//! Completion: elements after a dot, named arguments and modifiers in parentheses, else every name
//! that is visible.

mod context;
mod problem;

use super::client::Client;
use super::description;
use super::document::Document;
use super::occurrences::Entity;
use super::parsed::Parsed;
use super::workspace::{Documents, Workspace};
use crate::flatten::{ATTRIBUTES, ClassId, Declared, Library, Member};
use crate::functions;
use crate::name::{Ident, Name};
use crate::script::builtins;
use crate::syntax::ast::{CausalityPrefix, Restriction, VariabilityPrefix};
use crate::syntax::graphics;
use context::Open;
pub(super) use context::{Context, at as context_at};
use lsp_types::{CompletionItem, CompletionItemKind, CompletionTextEdit, Position, TextEdit};
use std::collections::BTreeSet;
use std::sync::Arc;

/// What can be written at a position of a document.
pub(crate) fn items(
    workspace: &mut Workspace,
    document: &Arc<Document>,
    all: &Documents,
    position: Position,
) -> Vec<CompletionItem> {
    let offset = document.offset(position);
    if document.is_toml() {
        return match document.is_problem() {
            true => problem::items(document, offset),
            false => Vec::new(),
        };
    }
    let context = context::at(&document.text, offset);
    if context.in_comment {
        return Vec::new();
    }
    let line = position.line as usize;
    let parsed = workspace.open_without_line(document, all, line);
    let class = parsed.class_at(offset).map(|(name, _)| name);
    let client = workspace.client.clone();
    let loadable = workspace.session.loadable_classes();
    let found = workspace.session.ask(|library| {
        let scope = class.as_ref().and_then(|name| library.find(name));
        let names = (&loadable, &client);
        Completion { library, parsed: &parsed, context: &context, scope, names }.items()
    });
    let range = document.range(context.start..offset);
    let replace = |mut item: CompletionItem| {
        let new_text = item.insert_text.take().unwrap_or_else(|| item.label.clone());
        item.text_edit = Some(CompletionTextEdit::Edit(TextEdit { range, new_text }));
        item
    };
    found.into_iter().map(replace).collect()
}

struct Completion<'a> {
    library: &'a Library,
    parsed: &'a Parsed,
    context: &'a Context,
    /// The class around the cursor.
    scope: Option<ClassId>,
    /// Classes at the top that are not loaded, and who reads the answer.
    names: (&'a BTreeSet<Ident>, &'a Client),
}

impl Completion<'_> {
    fn is_script(&self) -> bool {
        self.parsed.document.is_script() && self.scope.is_none()
    }

    fn items(&self) -> Vec<CompletionItem> {
        if let Some(start) = self.context.string {
            return self.in_string(start);
        }
        if !self.context.path.is_empty() {
            return self.after_dot(&self.context.path);
        }
        let mut found = Vec::new();
        if let Some(open) = self.context.open.last().filter(|open| !open.in_value) {
            found.extend(self.in_parentheses(open));
        }
        found.extend(self.visible());
        found
    }

    /// Scripts name models in the first argument of a call.
    fn in_string(&self, start: usize) -> Vec<CompletionItem> {
        let is_first = self.context.open.last().is_some_and(|open| open.commas == 0);
        if !self.is_script() || !is_first {
            return Vec::new();
        }
        let written = &self.parsed.document.text[start + 1..];
        let end = written.find(|c: char| !(c.is_alphanumeric() || matches!(c, '_' | '.')));
        let written = &written[..end.unwrap_or(written.len())];
        match written.rsplit_once('.') {
            Some((package, _)) => {
                let path: Vec<String> = package.split('.').map(str::to_owned).collect();
                self.after_dot(&path)
            }
            None => self.roots(),
        }
    }

    fn after_dot(&self, path: &[String]) -> Vec<CompletionItem> {
        let name = Name::new(path.iter().map(|part| Ident::new(part)));
        let last = |parts: Vec<Option<Declared>>| parts.last().copied().flatten();
        let meaning = last(self.library.parts_of_reference(self.scope, &name))
            .or_else(|| last(self.library.parts_of_type(self.scope, &name)));
        let Some(class) = meaning.and_then(|meaning| self.library.class_of_declared(meaning))
        else {
            return self.in_annotation(path);
        };
        let mut members = self.library.members(class);
        if members.is_empty() {
            members = self.redeclared(path, class).map_or(members, |own| self.library.members(own));
        }
        members.iter().filter(|one| !one.protected).map(|one| self.member(one, '1')).collect()
    }

    /// Literals of the enumerations that graphical annotations have.
    fn in_annotation(&self, path: &[String]) -> Vec<CompletionItem> {
        let is_inside = self.context.open.iter().any(|open| open.name == "annotation");
        let literals = match path {
            [name] if is_inside => graphics::literals(name),
            _ => &[],
        };
        let item = |name: &&str| plain(name, CompletionItemKind::ENUM_MEMBER, '1');
        literals.iter().map(item).collect()
    }

    /// The class that takes the place of an empty one in the package that the first component of a path is
    /// from: of the `state` in `Medium.BaseProperties`, `Medium.ThermodynamicState`.
    fn redeclared(&self, path: &[String], class: ClassId) -> Option<ClassId> {
        let first = Name::from(Ident::new(path.first()?));
        let component = self.library.parts_of_reference(self.scope, &first).last().copied()??;
        let Declared::Component(owner, name) = component else { return None };
        let (clause, _) = self.library.component(owner, name)?;
        let package = Name::parse(&clause.type_specifier.name.to_string()).parent();
        let own = self.library.name_of(class).last()?;
        let parts = self.library.parts_of_type(self.scope, &package.child(own));
        self.library.class_of_declared(parts.last().copied()??)
    }

    /// Inputs of a called function, or what can be modified in a declaration.
    fn in_parentheses(&self, open: &Open) -> Vec<CompletionItem> {
        if let Some(class) = self.modified() {
            let Some(class) = class else { return attributes(open) };
            let members = self.library.members(class);
            let offered = members.iter().filter(|one| {
                !one.protected && !open.given.iter().any(|given| one.name == given.as_str())
            });
            let mut found: Vec<CompletionItem> =
                offered.map(|member| assigned(self.member(member, '0'))).collect();
            if found.is_empty() {
                found = attributes(open);
            }
            return found;
        }
        let name = Name::parse(&open.name);
        let parts = self.library.parts_of_reference(self.scope, &name);
        if let Some(Some(Declared::Class(function))) = parts.last() {
            let members = self.library.members(*function);
            let inputs = members.iter().filter(|one| self.is_input(*function, one));
            let not_given =
                inputs.filter(|one| !open.given.iter().any(|given| one.name == given.as_str()));
            return not_given.map(|input| assigned(self.member(input, '0'))).collect();
        }
        if !self.is_script() {
            return Vec::new();
        }
        let inputs = builtins::inputs(&open.name).into_iter();
        let inputs = inputs.filter(|input| !open.given.iter().any(|given| given == input));
        inputs.map(|input| assigned(plain(input, CompletionItemKind::FIELD, '0'))).collect()
    }

    fn is_input(&self, function: ClassId, member: &Member) -> bool {
        let Declared::Component(owner, name) = member.declared else { return false };
        let clause = self.library.component(owner, name).map(|(clause, _)| clause.type_prefixes);
        let is_function = matches!(
            self.library.definition_of(function).restriction,
            Restriction::Function { .. }
        );
        !is_function
            || clause.is_some_and(|prefixes| prefixes.causality == Some(CausalityPrefix::Input))
    }

    /// The class that the parentheses at the cursor modify: `Some(None)` for a predefined type, `None`
    /// if they are those of a call.
    fn modified(&self) -> Option<Option<ClassId>> {
        let (first, inner) = self.context.open.split_first()?;
        let head = &self.context.head;
        let type_name = match head.as_slice() {
            [.., before, base] if before == "extends" => base,
            [.., type_name, component]
                if *component == first.name && !crate::syntax::is_keyword(type_name) =>
            {
                type_name
            }
            _ => return None,
        };
        let parts = self.library.parts_of_type(self.scope, &Name::parse(type_name));
        let mut at = parts.last().copied().flatten()?;
        for open in inner {
            let class = self.library.class_of_declared(at)?;
            at = self.library.element(class, Ident::new(&open.name))?;
        }
        match at {
            Declared::Predefined(_) => Some(None),
            other => Some(self.library.class_of_declared(other)),
        }
    }

    /// Every name that is visible.
    fn visible(&self) -> Vec<CompletionItem> {
        let mut seen = BTreeSet::new();
        let mut found = Vec::new();
        let mut scope = self.scope;
        while let Some(class) = scope {
            let members = self.library.members(class);
            found.extend(
                members.iter().filter(|one| seen.insert(one.name)).map(|one| self.member(one, '1')),
            );
            for (name, declared) in self.library.imports_of(class) {
                if seen.insert(name) {
                    found.push(self.member(&Member { name, declared, protected: false }, '2'));
                }
            }
            let is_closed = self.library.definition_of(class).encapsulated;
            scope = if is_closed { None } else { self.library.enclosing(class) };
        }
        found.extend(self.roots().into_iter().filter(|item| seen.insert(Ident::new(&item.label))));
        found.extend(self.variables());
        let types = ["Real", "Integer", "Boolean", "String"];
        found.extend(types.map(|name| plain(name, CompletionItemKind::STRUCT, '4')));
        found.extend(self.functions());
        found.extend(
            crate::syntax::keywords().map(|word| plain(word, CompletionItemKind::KEYWORD, '6')),
        );
        found
    }

    /// The classes at the top, loaded or not.
    fn roots(&self) -> Vec<CompletionItem> {
        let loaded: BTreeSet<Ident> = self.library.roots().collect();
        let known = loaded.iter().chain(self.names.0.difference(&loaded));
        let item = |name: &Ident| match self.library.find(&Name::from(*name)) {
            Some(class) => {
                let declared = Declared::Class(class);
                self.member(&Member { name: *name, declared, protected: false }, '3')
            }
            None => plain(name.as_str(), CompletionItemKind::MODULE, '3'),
        };
        known.map(item).collect()
    }

    /// The variables of a script.
    fn variables(&self) -> Vec<CompletionItem> {
        if !self.is_script() {
            return Vec::new();
        }
        let symbols = super::outline::symbols(self.parsed);
        let variables =
            symbols.into_iter().filter(|symbol| symbol.kind == lsp_types::SymbolKind::VARIABLE);
        variables.map(|symbol| plain(&symbol.name, CompletionItemKind::VARIABLE, '1')).collect()
    }

    /// Functions of the language, and commands in scripts.
    fn functions(&self) -> Vec<CompletionItem> {
        let mut names: BTreeSet<&'static str> = functions::names().collect();
        match self.is_script() {
            true => names.extend(builtins::names()),
            false => names
                .extend(["der", "pre", "edge", "change", "initial", "terminal", "sample", "time"]),
        }
        let item = |name: &'static str| CompletionItem {
            documentation: description::markdown(self.library, Entity::Function(Ident::new(name)))
                .map(|text| self.names.1.documentation(text)),
            ..plain(name, CompletionItemKind::FUNCTION, '5')
        };
        names.into_iter().map(item).collect()
    }

    fn member(&self, member: &Member, rank: char) -> CompletionItem {
        let (kind, detail, comment) = match member.declared {
            Declared::Class(class) => {
                let definition = self.library.definition_of(class);
                let detail = definition.restriction.keyword().to_owned();
                (class_kind(definition.restriction), Some(detail), description::comment(definition))
            }
            Declared::Component(owner, name) => {
                let found = self.library.component(owner, name);
                let detail =
                    found.map(|(clause, declaration)| description::declared(clause, declaration));
                let fixed = found.and_then(|(clause, _)| clause.type_prefixes.variability);
                let kind = match fixed {
                    Some(VariabilityPrefix::Constant | VariabilityPrefix::Parameter) => {
                        CompletionItemKind::CONSTANT
                    }
                    _ => CompletionItemKind::FIELD,
                };
                (kind, detail, found.and_then(|(_, one)| one.comment.text.as_deref()))
            }
            Declared::Literal(..) => (CompletionItemKind::ENUM_MEMBER, None, None),
            Declared::Predefined(_) => (CompletionItemKind::STRUCT, None, None),
        };
        CompletionItem {
            detail,
            documentation: comment.map(|text| self.names.1.documentation(text.to_owned())),
            ..plain(member.name.as_str(), kind, rank)
        }
    }
}

fn class_kind(restriction: Restriction) -> CompletionItemKind {
    match restriction {
        Restriction::Package => CompletionItemKind::MODULE,
        Restriction::Function { .. } => CompletionItemKind::FUNCTION,
        Restriction::Connector | Restriction::ExpandableConnector => CompletionItemKind::INTERFACE,
        Restriction::Record | Restriction::OperatorRecord | Restriction::Type => {
            CompletionItemKind::STRUCT
        }
        _ => CompletionItemKind::CLASS,
    }
}

fn plain(name: &str, kind: CompletionItemKind, rank: char) -> CompletionItem {
    CompletionItem {
        label: name.to_owned(),
        kind: Some(kind),
        sort_text: Some(format!("{rank}{name}")),
        ..CompletionItem::default()
    }
}

/// `name = `, for an argument.
fn assigned(item: CompletionItem) -> CompletionItem {
    let insert_text = Some(format!("{} = ", item.label));
    let label = format!("{} =", item.label);
    CompletionItem { insert_text, filter_text: Some(item.label), label, ..item }
}

fn attributes(open: &Open) -> Vec<CompletionItem> {
    let offered = ATTRIBUTES.iter().filter(|one| !open.given.iter().any(|given| given == *one));
    offered.map(|one| assigned(plain(one, CompletionItemKind::PROPERTY, '0'))).collect()
}
