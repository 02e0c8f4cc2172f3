//! What a library says of the conversion of classes that use an older version of it (MLS §18.8.2,
//! §18.8.3): the rules of its conversion scripts.

use crate::diag::Diagnostic;
use crate::fault;
use crate::flatten::errors::CONVERSION;
use crate::name::{Ident, Name};
use crate::source::Span;
use crate::syntax::ast::{
    Arguments, Expression, ExpressionKind, InteractiveKind, Script, StatementKind,
};
use crate::syntax::print;
use rustc_hash::FxHashMap;
use std::sync::Arc;

/// The libraries whose classes have other names than a library was written for.
pub(super) type Conversions = Arc<[(Ident, Arc<Conversion>)]>;

/// The rules that lead from an older version of a library to the loaded one, version by version.
#[derive(Debug)]
pub(super) struct Conversion {
    steps: Vec<Rules>,
}

/// Why a class, or an element of it, cannot be converted.
type Message = (Option<Name>, Arc<str>);

/// The rules of one script, by the old names of the classes.
#[derive(Debug, Default)]
pub(super) struct Rules {
    classes: FxHashMap<Name, Name>,
    conditional: FxHashMap<Name, Vec<Conditional>>,
    elements: FxHashMap<Name, Vec<(Name, Name)>>,
    modifiers: FxHashMap<Name, Vec<ModifierRule>>,
    messages: FxHashMap<Name, Vec<Message>>,
}

/// `convertClassIf(class, element, value, new)`
#[derive(Debug)]
pub(super) struct Conditional {
    pub(super) element: Name,
    /// The literal as it is printed; of an enumeration its last name.
    pub(super) value: String,
    pub(super) new: Name,
}

/// `convertModifiers(class, old, new)`
#[derive(Debug, Clone, Default)]
pub(super) struct ModifierRule {
    /// Names with their defaults.
    pub(super) old: Vec<(Name, Option<Arc<str>>)>,
    /// Modifiers as they are written, in which `%name%` stands for an old value.
    pub(super) new: Vec<Arc<str>>,
}

impl Rules {
    /// The rules of a conversion script.
    ///
    /// # Errors
    /// A statement is not a rule.
    pub(super) fn of_script(script: &Script) -> Result<Rules, Diagnostic> {
        let mut rules = Rules::default();
        for statement in &script.statements {
            let call = match &statement.kind {
                InteractiveKind::Expression(call) => call,
                InteractiveKind::Statement(statement) => match &statement.kind {
                    StatementKind::Call(call) => call,
                    _ => return Err(no_rule(statement.span)),
                },
                _ => return Err(no_rule(statement.span)),
            };
            rules.add(call)?;
        }
        Ok(rules)
    }

    /// The rules of `change = {convertClass("A", "B"), ...}`, which are in an annotation.
    ///
    /// # Errors
    /// A value is not a rule.
    pub(super) fn of_change(change: &Expression) -> Result<Rules, Diagnostic> {
        let mut rules = Rules::default();
        let written = match &change.kind {
            ExpressionKind::Array(written) => written.as_slice(),
            _ => std::slice::from_ref(change),
        };
        for rule in written {
            rules.add(rule)?;
        }
        Ok(rules)
    }

    fn add(&mut self, call: &Expression) -> Result<(), Diagnostic> {
        let ExpressionKind::Call { function, arguments } = &call.kind else {
            return Err(no_rule(call.span));
        };
        let given = string_arguments(arguments, call.span)?;
        let strings: Vec<&[Arc<str>]> = given.iter().map(Vec::as_slice).collect();
        let name = function.name().to_string();
        match (name.as_str(), strings.as_slice()) {
            ("convertClear", []) => *self = Rules::default(),
            ("convertClass", [old, new]) => {
                for [old, new] in rows([*old, *new], call.span)? {
                    self.classes.insert(Name::parse(old), Name::parse(new));
                }
            }
            ("convertClassIf", [class, element, value, new]) => {
                for [class, element, value, new] in
                    rows([*class, *element, *value, *new], call.span)?
                {
                    let (element, new) = (Name::parse(element), Name::parse(new));
                    let rule = Conditional { element, value: last_name(value), new };
                    self.conditional.entry(Name::parse(class)).or_default().push(rule);
                }
            }
            ("convertElement", [class, old, new]) => {
                for [class, old, new] in rows([*class, *old, *new], call.span)? {
                    self.element_rule(class, old, new);
                }
            }
            ("convertMessage", [class, message]) => {
                for [class, message] in rows([*class, *message], call.span)? {
                    let messages = self.messages.entry(Name::parse(class)).or_default();
                    messages.push((None, message.clone()));
                }
            }
            ("convertMessage", [class, message, element]) => {
                for [class, message, element] in rows([*class, *message, *element], call.span)? {
                    let messages = self.messages.entry(Name::parse(class)).or_default();
                    messages.push((Some(Name::parse(element)), message.clone()));
                }
            }
            ("convertModifiers", [classes, old, new]) => {
                for class in *classes {
                    self.modifier_rule(class, old, new);
                }
            }
            _ => return Err(no_rule(call.span)),
        }
        Ok(())
    }

    fn element_rule(&mut self, class: &str, old: &str, new: &str) {
        let class = Name::parse(class);
        if new.is_empty() {
            // A form of old scripts: the modifier is removed.
            let rule = ModifierRule { old: vec![(Name::parse(old), None)], new: Vec::new() };
            self.modifiers.entry(class).or_default().push(rule);
            return;
        }
        self.elements.entry(class).or_default().push((Name::parse(old), Name::parse(new)));
    }

    fn modifier_rule(&mut self, class: &str, old: &[Arc<str>], new: &[Arc<str>]) {
        let class = Name::parse(class);
        if old.iter().any(|old| old.trim_start().starts_with("cardinality")) {
            let message = "modifiers that depend on `cardinality` are not converted";
            self.messages.entry(class).or_default().push((None, message.into()));
            return;
        }
        let mut rule = ModifierRule::default();
        for text in old {
            let (name, default) = text
                .split_once('=')
                .map_or((&**text, None), |(name, default)| (name, Some(Arc::from(default.trim()))));
            rule.old.push((Name::parse(name.trim()), default));
        }
        rule.new = new.to_vec();
        self.modifiers.entry(class).or_default().push(rule);
    }

    /// The new name of a class, or of what lies in one: the longest rule counts.
    pub(super) fn class(&self, old: &Name) -> Option<Name> {
        (1..=old.parts.len()).rev().find_map(|length| {
            let head = Name::new(old.parts[..length].iter().copied());
            let inner = &old.parts[length..];
            // What is renamed within a class lies in the class as it is called now.
            if let Some((new, count)) = self.element(&head, inner) {
                let head = self.class(&head).unwrap_or(head);
                let parts = head.parts.iter().chain(&new.parts).chain(&inner[count..]);
                return Some(Name::new(parts.copied()));
            }
            let new = self.classes.get(&head)?;
            Some(Name::new(new.parts.iter().chain(inner).copied()))
        })
    }

    /// The rules about the class by the values of its modifiers.
    pub(super) fn conditional(&self, class: &Name) -> &[Conditional] {
        self.conditional.get(class).map_or(&[], Vec::as_slice)
    }

    /// The new name of an element of a class, and how many names of the path it stands for.
    pub(super) fn element(&self, class: &Name, path: &[Ident]) -> Option<(Name, usize)> {
        let rules = self.elements.get(class)?;
        let fits = |(old, _): &&(Name, Name)| path.starts_with(&old.parts);
        let (old, new) = rules.iter().filter(fits).max_by_key(|(old, _)| old.parts.len())?;
        Some((new.clone(), old.parts.len()))
    }

    /// The rules about the modifiers of a class.
    pub(super) fn modifiers(&self, class: &Name) -> &[ModifierRule] {
        self.modifiers.get(class).map_or(&[], Vec::as_slice)
    }

    /// Why a class, or what lies in it, cannot be converted.
    fn message(&self, old: &Name) -> Option<&Arc<str>> {
        (1..=old.parts.len()).rev().find_map(|length| {
            let head = Name::new(old.parts[..length].iter().copied());
            let of_class = |(element, _): &&Message| element.is_none();
            self.messages.get(&head)?.iter().find(of_class).map(|(_, message)| message)
        })
    }

    /// Why an element of a class cannot be converted.
    pub(super) fn message_of_element(&self, class: &Name, element: Ident) -> Option<&Arc<str>> {
        let name = Name::from(element);
        let messages = self.messages.get(class)?;
        messages.iter().find(|(one, _)| one.as_ref() == Some(&name)).map(|(_, message)| message)
    }
}

impl Conversion {
    /// A conversion in these steps, the oldest first.
    pub(super) fn new(steps: Vec<Rules>) -> Conversion {
        Conversion { steps }
    }

    /// The rules of each step, the oldest first.
    pub(super) fn steps(&self) -> &[Rules] {
        &self.steps
    }

    /// The new name of a class; `None` if it stays.
    pub(super) fn class(&self, old: &Name) -> Option<Name> {
        self.steps
            .iter()
            .fold(None, |new: Option<Name>, rules| rules.class(new.as_ref().unwrap_or(old)).or(new))
    }

    /// Whether a rule is about the elements or modifiers of a class.
    pub(super) fn mentions(&self, old: &Name) -> bool {
        self.along(old).any(|(rules, class)| {
            rules.elements.contains_key(&class) || rules.modifiers.contains_key(&class)
        })
    }

    /// Whether the value of a modifier may decide what stands for a class.
    pub(super) fn has_choices(&self, old: &Name) -> bool {
        self.along(old).any(|(rules, class)| !rules.conditional(&class).is_empty())
    }

    /// Why a class cannot be converted: the message of a step that gives it no new name.
    pub(super) fn message(&self, old: &Name) -> Option<&Arc<str>> {
        self.along(old).find_map(|(rules, class)| match rules.class(&class) {
            Some(_) => None,
            None => rules.message(&class),
        })
    }

    /// The new name of an element of a class, and how many names of the path it stands for.
    pub(super) fn element(&self, class: &Name, path: &[Ident]) -> Option<(Name, usize)> {
        let mut found: Option<(Name, usize)> = None;
        for (rules, class) in self.along(class) {
            let (head, count) = match &found {
                Some((name, count)) => (name.parts.as_slice(), *count),
                None => (&[] as &[Ident], 0),
            };
            let now: Vec<Ident> = head.iter().chain(&path[count..]).copied().collect();
            if let Some((new, replaced)) = rules.element(&class, &now) {
                let kept = head.get(replaced..).unwrap_or_default();
                let taken = count + replaced.saturating_sub(head.len());
                found = Some((Name::new(new.parts.iter().chain(kept).copied()), taken));
            }
        }
        found
    }

    /// Why an element of the class at the end of a path cannot be converted.
    pub(super) fn message_of_element(&self, class: &Name, path: &[Ident]) -> Option<&Arc<str>> {
        let mut first = *path.first()?;
        self.along(class).find_map(|(rules, class)| {
            let message = rules.message_of_element(&class, first);
            if let Some((new, 1)) = rules.element(&class, &[first])
                && let Some(renamed) = new.first()
            {
                first = renamed;
            }
            message
        })
    }

    /// The rules of each step with the name that a class has before it.
    fn along(&self, old: &Name) -> impl Iterator<Item = (&Rules, Name)> {
        self.steps.iter().scan(old.clone(), |class, rules| {
            let new = rules.class(class).unwrap_or_else(|| class.clone());
            Some((rules, std::mem::replace(class, new)))
        })
    }
}

/// A literal as rules compare it: printed, and of an enumeration its last name.
pub(super) fn literal_text(e: &Expression) -> String {
    match &e.kind {
        ExpressionKind::Reference(reference) => {
            reference.parts.last().map_or(String::new(), |part| part.name.to_string())
        }
        _ => print::expression(e),
    }
}

fn last_name(text: &str) -> String {
    match text.starts_with('"') || text.parse::<f64>().is_ok() {
        true => text.to_owned(),
        false => text.rsplit('.').next().unwrap_or(text).to_owned(),
    }
}

/// The arguments of a rule as lists of strings; `simplify` changes nothing that a simulation sees.
fn string_arguments(arguments: &Arguments, span: Span) -> Result<Vec<Vec<Arc<str>>>, Diagnostic> {
    let is_text = |e: &&Expression| !matches!(e.kind, ExpressionKind::Boolean(_));
    let given = arguments.positional.iter().filter(is_text);
    given.map(|e| strings(e).ok_or_else(|| no_rule(span))).collect()
}

fn strings(e: &Expression) -> Option<Vec<Arc<str>>> {
    match &e.kind {
        ExpressionKind::String(text) => Some(vec![text.clone()]),
        ExpressionKind::Array(elements) => elements.iter().map(|one| strings(one)?.pop()).collect(),
        ExpressionKind::Call { function, .. } => {
            function.as_ident().is_some_and(|name| name == "fill").then(Vec::new)
        }
        _ => None,
    }
}

/// The calls that a call with arrays stands for; a single text goes with each.
fn rows<const N: usize>(
    columns: [&[Arc<str>]; N],
    span: Span,
) -> Result<Vec<[&Arc<str>; N]>, Diagnostic> {
    let count = columns.iter().map(|column| column.len()).max().unwrap_or(0);
    if columns.iter().any(|column| column.len() != count && column.len() != 1) {
        return Err(no_rule(span));
    }
    let row = |at: usize| columns.map(|column| &column[at.min(column.len() - 1)]);
    Ok((0..count).map(row).collect())
}

fn no_rule(span: Span) -> Diagnostic {
    fault!(CONVERSION, "this is not a rule of a conversion script";
        help: "there are convertClass, convertClassIf, convertElement, convertModifiers, \
               convertMessage and convertClear, with Strings or arrays of Strings")
    .at(span)
}
