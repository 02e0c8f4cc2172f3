//! Conversion scripts: loaded classes brought to another version of a library (MLS §18.8.2.1).
//!
//! Rules are applied to the loaded classes at once, those of the library itself left out. Names are
//! converted as they are written: in full, or as the beginning of a longer name.

use super::{Args, Builtin, Failure, Family};
use crate::Session;
use crate::bail;
use crate::diag::Fault;
use crate::errors::BAD_ARGUMENT;
use crate::name::{Ident, Name};
use crate::source::{SourceId, Span};
use crate::syntax::ast::{
    Argument, Binding, ClassDefinition, ClassSpecifier, ComponentClause, ComponentReference,
    Element, ElementModification, Expression, ExpressionKind, Modification, Section,
};
use crate::syntax::visit::{Rewrite, rewrite_class, rewrite_expression, rewrite_reference};
use crate::syntax::{self};
use crate::value::Value;
use std::collections::HashMap;
use std::sync::Arc;

/// The commands of this file.
pub(super) const FAMILY: Family = Family {
    packages: &["DymolaCommands.Conversion"],
    dialect: None,
    builtins: &[
        Builtin { header: CONVERT_CLASS, run: convert_class },
        Builtin { header: CONVERT_CLASS_IF, run: convert_class_if },
        Builtin { header: CONVERT_ELEMENT, run: convert_element },
        Builtin { header: CONVERT_MODIFIERS, run: convert_modifiers },
        Builtin { header: CONVERT_MESSAGE, run: convert_message },
        Builtin { header: CONVERT_CLEAR, run: convert_clear },
        Builtin { header: RUN_CONVERSION_SCRIPT, run: run_conversion_script },
    ],
};

const CONVERT_CLASS: &str = r#"
function convertClass "Renames a class in all loaded classes."
  input Any oldName "a String or an array of Strings";
  input String newName;
  output Boolean ok;
end convertClass;
"#;

fn convert_class(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let old = names(&mut args, "oldName")?;
    let new = Name::parse(&args.take::<String>("newName")?);
    for old in old {
        apply(session, &old.clone(), |class| class_renamed(class, &old, &new))?;
    }
    Ok(true.into())
}

const CONVERT_CLASS_IF: &str = r#"
function convertClassIf "Renames a class where a parameter has the given value."
  input String oldName;
  input String para "the parameter";
  input String val "its value as written";
  input String newName;
  output Boolean ok;
end convertClassIf;
"#;

fn convert_class_if(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let old = Name::parse(&args.take::<String>("oldName")?);
    let new = Name::parse(&args.take::<String>("newName")?);
    let parameter = Ident::new(&args.take::<String>("para")?);
    let value: String = args.take("val")?;
    apply(session, &old, |class| {
        split_clauses(class, &old);
        each_component(class, &mut |name, modification| {
            let has = modification.as_ref().is_some_and(|m| {
                binding_of(&m.arguments, parameter)
                    .is_some_and(|e| syntax::print::expression(e) == value)
            });
            if *name == old && has {
                *name = new.clone();
            }
        });
    })?;
    Ok(true.into())
}

const CONVERT_ELEMENT: &str = r#"
function convertElement "Renames an element of a class in all loaded classes."
  input Any className "a String or an array of Strings";
  input String oldName;
  input String newName;
  output Boolean ok;
end convertElement;
"#;

fn convert_element(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let classes = names(&mut args, "className")?;
    let old = Ident::new(&args.take::<String>("oldName")?);
    let new: String = args.take("newName")?;
    for class in classes {
        let new = Ident::new(&new);
        apply(session, &class.clone(), |user| element_renamed(user, &class, old, new))?;
    }
    Ok(true.into())
}

const CONVERT_MODIFIERS: &str = r#"
function convertModifiers "Replaces modifiers of a class in all loaded classes."
  input Any className "a String or an array of Strings";
  input String oldModifiers[:] "`p=default`: the default is used where the modifier is missing";
  input String newModifiers[:] "`q=%p%`: %p% is the old value of p";
  input Boolean simplify = false "has no effect";
  output Boolean ok;
end convertModifiers;
"#;

fn convert_modifiers(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let classes = names(&mut args, "className")?;
    let old: Vec<String> = args.take("oldModifiers")?;
    let new: Vec<String> = args.take("newModifiers")?;
    let old: Vec<(Ident, Option<String>)> = old.iter().map(|text| rule(text)).collect();
    let new: Vec<(Ident, Option<String>)> = new.iter().map(|text| rule(text)).collect();
    if let Some((name, _)) = new.iter().find(|(_, value)| value.is_none()) {
        bail!(BAD_ARGUMENT, "the new modifier `{name}` has no value: write `{name}=%old%`");
    }
    for class in classes {
        let mut failure = None;
        apply(session, &class.clone(), |user| {
            each_component(user, &mut |name, modification| {
                if *name == class {
                    let done = replaced(modification, &old, &new);
                    failure = failure.take().or(done.err());
                }
            });
        })?;
        if let Some(fault) = failure {
            return Err(fault.into());
        }
    }
    Ok(true.into())
}

const CONVERT_MESSAGE: &str = r#"
function convertMessage "Reports that a class has no replacement, if a loaded class uses it."
  input Any className "a String or an array of Strings";
  input String failedMessage;
  output Boolean ok;
end convertMessage;
"#;

fn convert_message(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let message: String = args.take("failedMessage")?;
    for class in names(&mut args, "className")? {
        let mut used = false;
        apply(session, &class.clone(), |user| {
            each_component(user, &mut |name, _| used |= *name == class);
        })?;
        if used {
            session.report_fault(Fault::new(BAD_ARGUMENT, format!("`{class}`: {message}")));
        }
    }
    Ok(true.into())
}

const CONVERT_CLEAR: &str = r#"
function convertClear "Clears the conversion rules; they are applied immediately, so there are none."
  output Boolean ok;
end convertClear;
"#;

fn convert_clear(_: &mut Session, _: Args) -> Result<Value, Failure> {
    Ok(true.into())
}

fn names(args: &mut Args, input: &str) -> Result<Vec<Name>, Fault> {
    let value: Value = args.take(input)?;
    let names: Vec<String> = match value {
        Value::String(text) => vec![text.to_string()],
        other => crate::value::FromValue::from_value(other)?,
    };
    Ok(names.iter().map(|name| Name::parse(name)).collect())
}

/// `p=value`, or `p` alone.
fn rule(text: &str) -> (Ident, Option<String>) {
    match text.split_once('=') {
        Some((name, value)) => (Ident::new(name.trim()), Some(value.trim().to_owned())),
        None => (Ident::new(text.trim()), None),
    }
}

const RUN_CONVERSION_SCRIPT: &str = r#"
function runConversionScript "Converts a package to another version of a library with a conversion script."
  input TypeName packageToConvert;
  input String scriptFile;
  output Boolean success;
end runConversionScript;
"#;

/// The only top-level class that rules are applied to, while one is chosen.
#[derive(Default)]
struct Chosen(Option<Ident>);

fn run_conversion_script(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let package: Name = args.take("packageToConvert")?;
    let script: String = args.take("scriptFile")?;
    if session.library().definition(&package).is_none() {
        return Err(session.classes.class_to_load(&package).into());
    }
    let outer = std::mem::replace(&mut session.extension::<Chosen>().0, package.first());
    session.execution.descend();
    let done = session.run_nested(&script);
    session.execution.ascend();
    session.extension::<Chosen>().0 = outer;
    done.map(|()| true.into())
}

/// Changes the loaded classes at the top level, or the chosen one, but for the library of a class.
/// The models are translated again when they are needed.
fn apply(
    session: &mut Session,
    of: &Name,
    mut change: impl FnMut(&mut ClassDefinition),
) -> Result<(), Failure> {
    let chosen = session.extension::<Chosen>().0;
    let is_meant =
        |root: &Ident| Some(*root) != of.first() && chosen.is_none_or(|chosen| chosen == *root);
    let roots: Vec<Ident> = session.library().roots().filter(is_meant).collect();
    for root in roots {
        let name = Name::from(root);
        if session.is_lazy(&name) {
            continue;
        }
        let Some(mut class) = session.library().definition(&name) else { continue };
        let before = class.clone();
        change(Arc::make_mut(&mut class));
        if *before != *class {
            session.classes.define(&class)?;
        }
    }
    Ok(())
}

fn class_renamed(class: &mut ClassDefinition, old: &Name, new: &Name) {
    each_type(class, &mut |name| rename(name, old, new));
    rewrite_class(&mut Renaming { old, new }, class);
}

/// Replaces the beginning of a name.
fn rename(name: &mut Name, old: &Name, new: &Name) {
    if name.parts.starts_with(&old.parts) {
        let rest = &name.parts[old.parts.len()..];
        *name = Name::new(new.parts.iter().chain(rest).copied());
    }
}

/// Names in expressions: functions and constants.
struct Renaming<'n> {
    old: &'n Name,
    new: &'n Name,
}

impl Rewrite for Renaming<'_> {
    fn reference(&mut self, reference: &mut ComponentReference) {
        rewrite_reference(self, reference);
        let names = reference.parts.iter().map(|part| part.name);
        let begins = names.clone().take(self.old.parts.len()).eq(self.old.parts.iter().copied());
        let plain = reference.parts.iter().take(self.old.parts.len());
        if begins && plain.clone().all(|part| part.subscripts.is_empty()) {
            let rest = reference.parts.split_off(self.old.parts.len());
            reference.parts = ComponentReference::from_name(self.new, reference.span).parts;
            reference.parts.extend(rest);
        }
    }
}

/// Every type's name in a class and in those in it.
fn each_type(class: &mut ClassDefinition, change: &mut dyn FnMut(&mut Name)) {
    match &mut class.specifier {
        ClassSpecifier::Short(short) => change(&mut short.target.name),
        ClassSpecifier::Long(long) => {
            for element in elements(&mut long.sections) {
                match element {
                    Element::Extends(extends) => change(&mut extends.base.name),
                    Element::Component(clause) => {
                        change(&mut clause.type_specifier.name);
                        if let Some(constraint) = &mut clause.constraint {
                            change(&mut constraint.target.name);
                        }
                    }
                    Element::Class(inner) => each_type(Arc::make_mut(&mut inner.class), change),
                    Element::Import(_) => {}
                }
            }
        }
        ClassSpecifier::Enumeration(_) | ClassSpecifier::Derivative(_) => {}
    }
}

fn elements(sections: &mut [Section]) -> impl Iterator<Item = &mut Element> {
    sections.iter_mut().flat_map(|section| match section {
        Section::Elements { elements, .. } => elements.as_mut_slice(),
        _ => &mut [],
    })
}

/// Gives every component of a type a clause of its own.
fn split_clauses(class: &mut ClassDefinition, of: &Name) {
    let ClassSpecifier::Long(long) = &mut class.specifier else { return };
    for section in long.sections.iter_mut() {
        let Section::Elements { elements, .. } = section else { continue };
        let whole = std::mem::take(elements);
        for element in whole {
            match element {
                Element::Component(clause) if clause.type_specifier.name == *of => {
                    elements.extend(clause.components.iter().map(|one| {
                        let components = vec![one.clone()];
                        Element::Component(ComponentClause { components, ..clause.clone() })
                    }));
                }
                Element::Class(mut inner) => {
                    split_clauses(Arc::make_mut(&mut inner.class), of);
                    elements.push(Element::Class(inner));
                }
                other => elements.push(other),
            }
        }
    }
}

/// Every component's type and modification, and those of `extends` clauses.
fn each_component(
    class: &mut ClassDefinition,
    change: &mut dyn FnMut(&mut Name, &mut Option<Modification>),
) {
    let ClassSpecifier::Long(long) = &mut class.specifier else { return };
    for element in elements(&mut long.sections) {
        match element {
            Element::Component(clause) => {
                for component in &mut clause.components {
                    change(&mut clause.type_specifier.name, &mut component.modification);
                }
            }
            Element::Extends(extends) => {
                let arguments = std::mem::take(&mut extends.modification);
                let mut modification =
                    Some(Modification { arguments, binding: None, span: Span::NONE });
                change(&mut extends.base.name, &mut modification);
                extends.modification = modification.map_or(Vec::new(), |m| m.arguments);
            }
            Element::Class(inner) => each_component(Arc::make_mut(&mut inner.class), change),
            Element::Import(_) => {}
        }
    }
}

fn element_renamed(user: &mut ClassDefinition, class: &Name, old: Ident, new: Ident) {
    let mut owners = Vec::new();
    if let ClassSpecifier::Long(long) = &user.specifier {
        for section in &long.sections {
            let Section::Elements { elements, .. } = section else { continue };
            for element in elements {
                if let Element::Component(clause) = element
                    && clause.type_specifier.name == *class
                {
                    owners.extend(clause.components.iter().map(|one| one.name.node));
                }
            }
        }
    }
    each_component(user, &mut |name, modification| {
        if name != class {
            return;
        }
        for argument in modification.iter_mut().flat_map(|m| &mut m.arguments) {
            if let Argument::Element(element) = argument
                && element.name.node.first() == Some(old)
            {
                element.name.node = Name::new(
                    std::iter::once(new).chain(element.name.node.parts[1..].iter().copied()),
                );
            }
        }
    });
    rewrite_class(&mut ElementRenaming { owners, old, new }, user);
}

/// `c.old` for the components of the class.
struct ElementRenaming {
    owners: Vec<Ident>,
    old: Ident,
    new: Ident,
}

impl Rewrite for ElementRenaming {
    fn reference(&mut self, reference: &mut ComponentReference) {
        rewrite_reference(self, reference);
        if let [owner, element, ..] = reference.parts.as_mut_slice()
            && self.owners.contains(&owner.name)
            && element.name == self.old
        {
            element.name = self.new;
        }
    }
}

fn binding_of(arguments: &[Argument], name: Ident) -> Option<&Expression> {
    arguments.iter().find_map(|argument| match argument {
        Argument::Element(element) if element.name.node == Name::from(name) => {
            match &element.modification.as_ref()?.binding {
                Some(Binding::Expression(value)) => Some(value),
                _ => None,
            }
        }
        _ => None,
    })
}

/// Takes the old modifiers out and puts the new ones in, where any old one stands or has a default.
fn replaced(
    modification: &mut Option<Modification>,
    old: &[(Ident, Option<String>)],
    new: &[(Ident, Option<String>)],
) -> Result<(), Fault> {
    let arguments = modification.as_ref().map_or(&[][..], |m| m.arguments.as_slice());
    let mut values: HashMap<Ident, Expression> = HashMap::new();
    let mut given = old.is_empty();
    for (name, default) in old {
        if let Some(value) = binding_of(arguments, *name) {
            values.insert(*name, value.clone());
            given = true;
        } else if let Some(default) = default {
            values.insert(*name, parsed(default)?);
        }
    }
    if !given {
        return Ok(());
    }
    let mut added = Vec::new();
    for (name, value) in new {
        let Some(value) = value.as_ref().and_then(|text| filled(text, &values).transpose()) else {
            continue;
        };
        added.push(argument(*name, value?));
    }
    let target = modification.get_or_insert_with(|| Modification {
        arguments: Vec::new(),
        binding: None,
        span: Span::NONE,
    });
    target.arguments.retain(|argument| match argument {
        Argument::Element(element) => {
            !old.iter().any(|(name, _)| element.name.node == Name::from(*name))
        }
        Argument::Redeclaration(_) => true,
    });
    target.arguments.extend(added);
    Ok(())
}

fn parsed(text: &str) -> Result<Expression, Fault> {
    syntax::parse_expression(SourceId::NONE, text)
        .map_err(|error| Fault::new(BAD_ARGUMENT, format!("`{text}`: {}", error.message)))
}

/// An expression in which `%p%` is replaced; `None` if a value is missing.
fn filled(text: &str, values: &HashMap<Ident, Expression>) -> Result<Option<Expression>, Fault> {
    let mut parts = text.split('%');
    let mut template = parts.next().unwrap_or_default().to_owned();
    while let (Some(name), Some(rest)) = (parts.next(), parts.next()) {
        if !values.contains_key(&Ident::new(name)) {
            return Ok(None);
        }
        template.push_str(&format!("'%{name}%'{rest}"));
    }
    let mut expression = parsed(&template)?;
    Filling { values }.expression(&mut expression);
    Ok(Some(expression))
}

/// Puts values in place of `'%p%'`.
struct Filling<'v> {
    values: &'v HashMap<Ident, Expression>,
}

impl Rewrite for Filling<'_> {
    fn expression(&mut self, expression: &mut Expression) {
        if let ExpressionKind::Reference(reference) = &expression.kind
            && let Some(name) = reference.as_ident()
            && let Some(value) = name
                .as_str()
                .strip_prefix("'%")
                .and_then(|rest| rest.strip_suffix("%'"))
                .and_then(|name| self.values.get(&Ident::new(name)))
        {
            *expression = value.clone();
            return;
        }
        rewrite_expression(self, expression);
    }
}

fn argument(name: Ident, value: Expression) -> Argument {
    let binding = Some(Binding::Expression(value));
    Argument::Element(ElementModification {
        each: false,
        is_final: false,
        name: crate::source::Spanned { node: Name::from(name), span: Span::NONE },
        modification: Some(Modification { arguments: Vec::new(), binding, span: Span::NONE }),
        description: None,
        span: Span::NONE,
    })
}
