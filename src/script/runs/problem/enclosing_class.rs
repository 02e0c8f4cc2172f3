//! The class around the model of an experiment: what the experiment sets beyond values of
//! parameters. Modifications are built as trees at their places in the problem's file, so that names
//! with subscripts, Integers and Booleans are as good as others, and what is wrong with them shows
//! there.

use super::file::ValueEntry;
use crate::Session;
use crate::diag::{Diagnostic, Fault};
use crate::flatten::{self, BaseType, RecordedInput};
use crate::models::classes::Enclosing;
use crate::models::typed::number_in;
use crate::name::{Ident, Name};
use crate::source::{SourceId, Span, Spanned};
use crate::syntax::ast::{
    Annotation, Argument, Binding, ClassDefinition, ClassSpecifier, ComponentReference, Element,
    ElementModification, Expression, ExpressionKind, Extends, Modification, Section, TypeSpecifier,
};
use crate::syntax::visit::{Rewrite, rewrite_expression};
use crate::syntax::{parse_all_of_stored_definition, parse_class_with_modification};
use std::sync::Arc;

/// Integers that are written as such; larger numbers are Reals.
const MOST: f64 = 2_147_483_647.0;

/// The model of a problem: its class and what modifies it.
#[derive(Debug, Clone)]
pub(super) struct Base {
    /// As it is written: `Class` or `Class(modification)`.
    text: String,
    pub class: Name,
    modification: Vec<Argument>,
    span: Span,
}

impl Base {
    /// Reads a model at its place in a problem's file.
    ///
    /// # Errors
    ///
    /// Text that is not a class, with or without a modification.
    pub(super) fn of(model: &str, place: Option<Span>) -> Result<Base, Diagnostic> {
        let (source, text, span) = at_place(model, place);
        let (class, modification) = parse_class_with_modification(source, &text)?;
        Ok(Base { text: model.to_owned(), class, modification, span })
    }
}

/// A text of a problem's file such that what is read from it has its places in the file.
fn at_place(text: &str, place: Option<Span>) -> (SourceId, String, Span) {
    match place {
        Some(place) => (place.source, format!("{}{text}", " ".repeat(place.start as usize)), place),
        None => (SourceId::NONE, text.to_owned(), Span::NONE),
    }
}

/// An expression of a problem's file.
///
/// # Errors
///
/// Text that is not an expression.
pub(super) fn expression(text: &str, place: Option<Span>) -> Result<Expression, Diagnostic> {
    let (source, text, _) = at_place(text, place);
    crate::syntax::parse_expression(source, &text)
}

/// The name in a String, which TOML would have in quotation marks: `"c[1].k"`.
pub(super) fn quoted_name(text: &str) -> Option<ComponentReference> {
    match crate::syntax::parse_expression(SourceId::NONE, text).ok()?.kind {
        ExpressionKind::Reference(reference) => Some(reference),
        _ => None,
    }
}

/// Takes names out of quotation marks, in an expression that has no use for Strings.
pub(super) struct QuotedNames;

impl Rewrite for QuotedNames {
    fn expression(&mut self, e: &mut Expression) {
        if let ExpressionKind::String(text) = &e.kind
            && let Some(reference) = quoted_name(text)
        {
            e.kind = ExpressionKind::Reference(reference);
        }
        rewrite_expression(self, e);
    }
}

/// The names in an expression.
pub(super) struct References(pub Vec<String>);

impl Rewrite for References {
    fn expression(&mut self, e: &mut Expression) {
        if let ExpressionKind::Reference(_) = &e.kind {
            self.0.push(crate::syntax::print::expression(e));
        }
        rewrite_expression(self, e);
    }
}

/// A value of a problem's file. Whole numbers fit Integers and Reals.
///
/// # Errors
///
/// Infinite numbers and NaN.
pub(super) fn literal(value: &ValueEntry, name: &str, place: Span) -> Result<Expression, Fault> {
    let kind = match value {
        ValueEntry::Truth(value) => ExpressionKind::Boolean(*value),
        ValueEntry::Text(text) => ExpressionKind::String(text.as_str().into()),
        ValueEntry::Number(_) => match value.number(name)? {
            whole if whole.fract() == 0.0 && whole.abs() <= MOST => {
                ExpressionKind::Integer(whole as i64)
            }
            number => ExpressionKind::Real(number),
        },
    };
    Ok(Expression::new(kind, place))
}

/// The same for a variable of a type of `model`: a String is a literal of an enumeration, as in `--set`.
///
/// # Errors
///
/// Also literals that the enumeration does not have.
pub(super) fn value(
    value: &ValueEntry,
    (name, place): (&str, Span),
    (model, base): (&str, Option<&BaseType>),
) -> Result<Expression, Fault> {
    let (ValueEntry::Text(text), Some(BaseType::Enumeration(definition))) = (value, base) else {
        return literal(value, name, place);
    };
    let number = number_in(name, text.trim(), base)?;
    let found = (1_u32..).map(f64::from).zip(&definition.literals).find(|(own, _)| *own == number);
    let Some((_, found)) = found else { return literal(value, name, place) };
    let type_name = type_in(model, &BaseType::Enumeration(definition.clone()));
    let read = expression(&format!("{type_name}.{found}"), None);
    read.map(|read| Expression { span: place, ..read })
        .map_err(|error| Fault::new(error.code, error.message.clone()))
}

/// What a class that extends `model` calls a type: that of an enumeration within the model is inherited.
pub(super) fn type_in(model: &str, base: &BaseType) -> String {
    match base {
        BaseType::Boolean => "Boolean".to_owned(),
        BaseType::Integer => "Integer".to_owned(),
        BaseType::Enumeration(definition) => {
            let name = definition.name.to_string();
            let inherited = name.strip_prefix(model).and_then(|rest| rest.strip_prefix('.'));
            inherited.map_or_else(|| format!(".{name}"), str::to_owned)
        }
        _ => "Real".to_owned(),
    }
}

/// A name of the class as an expression.
pub(super) fn reference(name: &str, place: Span) -> Expression {
    let reference = ComponentReference::from_name(&Name::parse(name), place);
    Expression::new(ExpressionKind::Reference(reference), place)
}

/// The name of an element that the class has besides those of the model, such as
/// `'initial value of x'`.
pub(super) fn own_name(purpose: &str, name: &str) -> String {
    let plain: String =
        name.chars().map(|c| if c.is_alphanumeric() || c == '_' { c } else { ' ' }).collect();
    format!("'{purpose} {}'", plain.trim())
}

/// The variable of the class that has the standard deviation of an output.
pub(super) fn deviation_of(y_name: &str) -> String {
    own_name("standard deviation of", y_name)
}

/// Modifications, declarations and equations that a class around the model has.
#[derive(Default, Clone)]
pub(super) struct EnclosingClass {
    modifications: Vec<Argument>,
    /// Declarations of its own elements.
    pub declarations: String,
    /// A section of initial equations, or nothing.
    pub equations: String,
    /// Its own elements, with what they are called in messages.
    pub elements: Vec<(String, String)>,
    /// Its own inputs, with their samples.
    pub recorded: Vec<RecordedInput>,
}

impl EnclosingClass {
    /// Gives an element of the model a value.
    pub(super) fn bind(&mut self, name: &str, value: Expression, place: Span) {
        self.modify(name, Vec::new(), Some(value), place);
    }

    /// Gives a state of the model an initial value.
    pub(super) fn start(&mut self, name: &str, value: Expression, place: Span) {
        let fixed = Expression::new(ExpressionKind::Boolean(true), place);
        self.modify(name, vec![("start", value), ("fixed", fixed)], None, place);
    }

    /// Lets a state of the model begin at the value that the equations give it.
    pub(super) fn release(&mut self, name: &str, place: Span) {
        let fixed = Expression::new(ExpressionKind::Boolean(false), place);
        self.modify(name, vec![("fixed", fixed)], None, place);
    }

    fn modify(
        &mut self,
        name: &str,
        attributes: Vec<(&str, Expression)>,
        binding: Option<Expression>,
        place: Span,
    ) {
        let arguments = attributes.into_iter().map(|(attribute, value)| {
            argument(Name::from(Ident::new(attribute)), Vec::new(), Some(value), place)
        });
        let arguments = arguments.collect();
        self.modifications.push(argument(Name::parse(name), arguments, binding, place));
    }

    /// Loads the class around the model of the experiment with this number, built for a place of the
    /// problem's file, and returns its name; the model itself where nothing is around it.
    pub(super) fn load(
        &self,
        session: &mut Session,
        base: &Base,
        (number, place): (usize, Span),
    ) -> Result<String, Vec<Diagnostic>> {
        if self.modifications.is_empty() && self.declarations.is_empty() {
            return Ok(base.text.clone());
        }
        let name = format!("GAPILibExperiment{}", number + 1);
        let text = format!("model {name}\n{}{}end {name};\n", self.declarations, self.equations);
        let source =
            session.sources.add(format!("experiment {} of the problem", number + 1), text.as_str());
        let mut parsed = parse_all_of_stored_definition(source, &text)?;
        let Some(class) = parsed.classes.pop() else { return Ok(base.text.clone()) };
        let of_model = session.classes.library.definition(&base.class);
        let experiment = of_model.as_deref().and_then(flatten::experiment_annotation).cloned();
        let class = self.around(Arc::unwrap_or_clone(class), (base, experiment), place);
        let enclosing = Enclosing {
            name: Ident::new(&name),
            model: base.class.to_string(),
            elements: self.elements.clone(),
            recorded: self.recorded.clone(),
            source,
            place,
        };
        session.classes.define_enclosing(class, enclosing).map_err(|error| vec![error])?;
        Ok(name)
    }

    /// The class of these declarations and equations, which extends the model and has its experiment.
    fn around(
        &self,
        mut class: ClassDefinition,
        (base, experiment): (&Base, Option<Argument>),
        place: Span,
    ) -> ClassDefinition {
        let modification = base.modification.iter().chain(&self.modifications).cloned().collect();
        let extends = Element::Extends(Extends {
            base: TypeSpecifier { name: base.class.clone(), span: base.span },
            modification,
            excluded: Vec::new(),
            annotation: None,
            span: place,
        });
        if let ClassSpecifier::Long(long) = &mut class.specifier {
            let first = Section::Elements { visibility: None, elements: vec![extends] };
            long.sections.insert(0, first);
            let annotation = |argument| Annotation { arguments: vec![argument], span: place };
            long.sections.extend(experiment.map(annotation).map(Section::Annotation));
        }
        class
    }
}

fn argument(
    name: Name,
    arguments: Vec<Argument>,
    binding: Option<Expression>,
    place: Span,
) -> Argument {
    let binding = binding.map(Binding::Expression);
    Argument::Element(ElementModification {
        each: false,
        is_final: false,
        name: Spanned { node: name, span: place },
        modification: Some(Modification { arguments, binding, span: place }),
        description: None,
        span: place,
    })
}
