//! What a name means, in words: Markdown for hovers and completions.

use super::attributes;
use super::occurrences::Entity;
use super::parsed::{elements, sections};
use crate::flatten::{ClassId, Declared, Library};
use crate::name::Ident;
use crate::script::builtins;
use crate::syntax::ast::{
    Argument, CausalityPrefix, ClassDefinition, ClassSpecifier, ComponentClause,
    ComponentDeclaration, ConnectionPrefix, Element, ExpressionKind, Restriction, Section,
    VariabilityPrefix,
};
use crate::syntax::print;

/// Characters of a documentation that are shown at most.
const MOST_DOCUMENTATION: usize = 2000;

/// Columns of a modification that is shown in a declaration.
const WIDEST: usize = 200;

/// Attributes that are shown beside a declaration.
const ATTRIBUTES: &[&str] = &["unit", "displayUnit", "quantity", "min", "max", "start", "nominal"];

/// A name in words; `None` where there is nothing to say.
pub(crate) fn markdown(library: &Library, entity: Entity) -> Option<String> {
    match entity {
        Entity::Declared(Declared::Class(class)) => Some(of_class(library, class)),
        Entity::Declared(Declared::Component(owner, name)) => component(library, owner, name),
        Entity::Declared(Declared::Literal(owner, name)) => Some(literal(library, owner, name)),
        Entity::Declared(Declared::Predefined(name)) => {
            Some(format!("```modelica\n{name}\n```\n\npredefined type (MLS §4.9)"))
        }
        Entity::Function(name) => function(name.as_str()),
        Entity::Loop(_) => Some("loop variable".to_owned()),
        Entity::Variable(_) => None,
    }
}

/// What a class says of itself, and the classes in it.
pub(crate) struct Described<'a> {
    /// Its keyword.
    pub keyword: &'static str,
    /// Its description.
    pub comment: String,
    /// Its documentation as text.
    pub documentation: String,
    /// Its own classes.
    pub nested: Vec<&'a ClassDefinition>,
}

/// What a class says of itself.
pub(crate) fn described(definition: &ClassDefinition) -> Described<'_> {
    let nested = elements(definition).filter_map(|element| match element {
        Element::Class(nested) => Some(&*nested.class),
        _ => None,
    });
    Described {
        keyword: definition.restriction.keyword(),
        comment: comment(definition).unwrap_or_default().to_owned(),
        documentation: documentation(definition).unwrap_or_default(),
        nested: nested.collect(),
    }
}

/// A function of the language or a command of scripts.
fn function(name: &str) -> Option<String> {
    let declarations = builtins::declarations(name);
    if let Some(language) = crate::functions::find(name) {
        let inputs = language.inputs.join(", ");
        return Some(format!("```modelica\n{name}({inputs})\n```\n\nMLS {}", language.section));
    }
    let blocks = declarations.iter().map(|text| format!("```modelica\n{text}\n```"));
    let text = blocks.collect::<Vec<_>>().join("\n\n");
    match (text.is_empty(), name) {
        (true, "time") => {
            Some("```modelica\nReal time(unit = \"s\")\n```\n\nMLS §3.6.7".to_owned())
        }
        (true, _) => None,
        (false, _) => Some(text),
    }
}

fn literal(library: &Library, owner: ClassId, name: Ident) -> String {
    let mut text = format!("```modelica\n{}.{name}\n```", library.name_of(owner));
    if let ClassSpecifier::Enumeration(enumeration) = &library.definition_of(owner).specifier {
        let literals = enumeration.literals.iter().flatten();
        let comment =
            literals.filter(|one| one.name.node == name).find_map(|one| one.comment.text.clone());
        text.extend(comment.map(|comment| format!("\n\n{comment}")));
    }
    text
}

fn component(library: &Library, owner: ClassId, name: Ident) -> Option<String> {
    let (clause, declaration) = library.component(owner, name)?;
    let mut text = format!("```modelica\n{}\n```", declared(clause, declaration));
    if let Some(comment) = &declaration.comment.text {
        text += &format!("\n\n{comment}");
    }
    let attribute = |attribute: &&str| {
        let value = attributes::attribute(library, owner, name, attribute)?;
        Some(format!("{attribute} `{value}`"))
    };
    let found: Vec<String> = ATTRIBUTES.iter().filter_map(attribute).collect();
    if !found.is_empty() {
        text += &format!("\n\n{}", found.join(", "));
    }
    Some(text + &format!("\n\nin `{}`", library.name_of(owner)))
}

/// The declaration of one component, without comment and annotation.
pub(crate) fn declared(clause: &ComponentClause, declaration: &ComponentDeclaration) -> String {
    let mut text = prefixes(clause);
    text += &clause.type_specifier.name.to_string();
    let subscripts = |subscripts: &[_]| match subscripts {
        [] => String::new(),
        all => format!("[{}]", all.iter().map(subscript).collect::<Vec<_>>().join(", ")),
    };
    text += &format!("{} {}", subscripts(&clause.subscripts), declaration.name.node);
    text += &subscripts(&declaration.subscripts);
    if let Some(modification) = &declaration.modification {
        let shown = print::modification(modification);
        let is_short = shown.len() <= WIDEST && !shown.contains('\n');
        text += if is_short { &shown } else { "(…)" };
    }
    text
}

fn subscript(subscript: &crate::syntax::ast::Subscript) -> String {
    match subscript {
        crate::syntax::ast::Subscript::All(_) => ":".to_owned(),
        crate::syntax::ast::Subscript::Index(index) => print::expression(index),
    }
}

fn prefixes(clause: &ComponentClause) -> String {
    let written = clause.prefixes;
    let own = [
        (written.is_final, "final"),
        (written.inner, "inner"),
        (written.outer, "outer"),
        (written.replaceable, "replaceable"),
    ];
    let of_type = clause.type_prefixes;
    let more = [
        of_type.connection.map(|prefix| match prefix {
            ConnectionPrefix::Flow => "flow",
            ConnectionPrefix::Stream => "stream",
        }),
        of_type.variability.map(|prefix| match prefix {
            VariabilityPrefix::Constant => "constant",
            VariabilityPrefix::Parameter => "parameter",
            VariabilityPrefix::Discrete => "discrete",
        }),
        of_type.causality.map(|prefix| match prefix {
            CausalityPrefix::Input => "input",
            CausalityPrefix::Output => "output",
        }),
    ];
    let own = own.into_iter().filter_map(|(is_written, word)| is_written.then_some(word));
    own.chain(more.into_iter().flatten()).map(|word| format!("{word} ")).collect()
}

/// The description string of a class.
pub(crate) fn comment(definition: &ClassDefinition) -> Option<&str> {
    match &definition.specifier {
        ClassSpecifier::Long(long) => long.description.as_deref(),
        ClassSpecifier::Short(short) => short.comment.text.as_deref(),
        ClassSpecifier::Enumeration(enumeration) => enumeration.comment.text.as_deref(),
        ClassSpecifier::Derivative(derivative) => derivative.comment.text.as_deref(),
    }
}

fn of_class(library: &Library, class: ClassId) -> String {
    let definition = library.definition_of(class);
    let mut head = format!("{} {}", definition.restriction.keyword(), library.name_of(class));
    if let ClassSpecifier::Short(short) = &definition.specifier {
        head += &format!(" = {}", short.target.name);
        if let Some(Ok(arguments)) = (!short.modification.is_empty()).then(|| arguments(short)) {
            head += &arguments;
        }
    }
    if matches!(definition.restriction, Restriction::Function { .. }) {
        head += &signature(definition);
    }
    let mut text = format!("```modelica\n{head}\n```");
    if let Some(comment) = comment(definition) {
        text += &format!("\n\n{comment}");
    }
    if let Some(documentation) = documentation(definition) {
        text += &format!("\n\n{documentation}");
    }
    text
}

fn arguments(short: &crate::syntax::ast::ShortClass) -> Result<String, ()> {
    let modification = crate::syntax::ast::Modification {
        arguments: short.modification.clone(),
        binding: None,
        span: short.target.span,
    };
    let shown = print::modification(&modification);
    if shown.len() <= WIDEST && !shown.contains('\n') { Ok(shown) } else { Err(()) }
}

/// The inputs and outputs of a function, one a line.
fn signature(definition: &ClassDefinition) -> String {
    let mut text = String::new();
    for element in elements(definition) {
        let Element::Component(clause) = element else { continue };
        if clause.type_prefixes.causality.is_some() {
            for declaration in &clause.components {
                text += &format!("\n  {}", declared(clause, declaration));
            }
        }
    }
    text
}

/// The text of `Documentation(info = …)` without its HTML.
fn documentation(definition: &ClassDefinition) -> Option<String> {
    let annotations = sections(definition).iter().filter_map(|section| match section {
        Section::Annotation(annotation) => Some(&annotation.arguments),
        _ => None,
    });
    let inside = |arguments: &[Argument], name: &str| {
        arguments.iter().find_map(|argument| match argument {
            Argument::Element(element) if element.name.node.first().is_some_and(|n| n == name) => {
                element.modification.clone()
            }
            _ => None,
        })
    };
    let found = annotations.into_iter().find_map(|arguments| inside(arguments, "Documentation"))?;
    let info = inside(&found.arguments, "info")?;
    let ExpressionKind::String(html) = &attributes::value(&info)?.kind else { return None };
    let text = plain(html);
    match text.char_indices().nth(MOST_DOCUMENTATION) {
        Some((end, _)) => Some(format!("{}…", &text[..end])),
        None => Some(text).filter(|text| !text.is_empty()),
    }
}

/// HTML as text: tags are left out, paragraphs and items are lines.
fn plain(html: &str) -> String {
    let mut text = String::new();
    let mut rest = html;
    while let Some(start) = rest.find('<') {
        text += &rest[..start];
        let end = rest[start..].find('>').map_or(rest.len(), |end| start + end + 1);
        let tag = rest[start + 1..end].trim_start_matches('/').to_ascii_lowercase();
        match tag.split(|c: char| !c.is_ascii_alphanumeric()).next() {
            Some("p" | "br" | "div" | "h1" | "h2" | "h3" | "h4" | "table" | "tr" | "pre") => {
                text += "\n\n";
            }
            Some("li") if !rest[start..].starts_with("</") => text += "\n- ",
            Some("ul" | "ol") => text += "\n",
            Some("code") => text.push('`'),
            _ => {}
        }
        rest = &rest[end..];
    }
    text += rest;
    let text = [("&lt;", "<"), ("&gt;", ">"), ("&nbsp;", " "), ("&quot;", "\""), ("&amp;", "&")]
        .iter()
        .fold(text, |text, (entity, character)| text.replace(entity, character));
    let mut lines: Vec<&str> = Vec::new();
    for line in text.lines().map(str::trim) {
        if !line.is_empty() || lines.last().is_some_and(|last| !last.is_empty()) {
            lines.push(line);
        }
    }
    lines.join("\n").trim().to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn html_becomes_text() {
        let html = "<html><p>Ohm's law, <code>v = R*i</code>:</p>\n<ul><li>a &lt; b</li></ul> < x";
        assert_eq!(plain(html), "Ohm's law, `v = R*i`:\n\n- a < b");
    }
}
