//! Instantiation and flattening: a class of the library becomes a flat model (MLS §5.6).
//!
//! The steps in order: find the class and check the source text of the classes that take part,
//! build the instance tree (§5.6.1), form the connection sets (ch. 9), resolve equations, bindings
//! and attributes (§5.6.2), add the equations of connections, and compare the number of equations
//! with that of unknowns (§4.8).
//!
//! Names are looked up in *scopes*: classes with the modifiers and redeclarations that reach them
//! and the scope in which their text stands (`scope`). A base class is a scope of its own that
//! shares the instance of the derived class.
//!
//! Not translated, each refused with `unsupported-language` at its place: impure functions
//! outside parameters, initial sections and when-clauses (§12.3). Clocked expressions (ch. 16), state machines (ch. 17) and the partial application of a
//! function that is itself an input (§12.4.2) end as names that nothing declares.
//!
//! The modules are private: what they declare `pub` is seen in this folder alone.

mod balance;
mod checks;
mod connections;
mod declared;
mod equations;
pub mod errors;
mod expressions;
mod flat_expression;
mod flat_model;
mod functions;
mod ids;
mod instantiate;
mod library;
mod lookup;
mod object_equations;
mod print;
mod record_values;
mod recorded;
mod shapes;
mod types;
mod units;
mod unknown;
mod variables;
mod warnings;

pub use balance::LocalBalance;
pub use declared::{Declared, Member};
pub use flat_expression::flat_reference;
pub use flat_model::*;
pub use library::{ClassId, Library, LibraryFiles};
pub use lookup::types::ATTRIBUTES;
pub use recorded::RecordedInput;

use crate::diag::{Diagnostic, Severity};
use crate::fault;
use crate::flatten::connections::own_signals;
use crate::flatten::ids::ScopeId;
use crate::flatten::instantiate::instantiation::Instantiation;
use crate::name::Name;
use crate::source::Span;
use crate::syntax::ast::{
    self, Annotation, Argument, Binding, ClassDefinition, ClassSpecifier, ExpressionKind,
    Restriction, Section, TypeSpecifier, UnaryOperator,
};
use errors::{INVALID_CONNECTION, NOT_A_MODEL, TOO_LARGE, UNKNOWN_CLASS, UNKNOWN_NAME};
use lookup::modification::Modifier;
use std::collections::BTreeSet;

/// Bytes of stack for instantiation, which nests with the expressions and bindings of the model.
const STACK: usize = 256 << 20;

/// A flat model and what is worth knowing about how it came about.
#[derive(Debug, Clone)]
pub struct Flattened {
    /// The model.
    pub model: FlatModel,
    /// The unknowns and equations of the class by itself (MLS §4.8), where they are known.
    pub balance: Option<LocalBalance>,
    /// Warnings.
    pub warnings: Vec<Diagnostic>,
}

/// Flattens a class under a modification, such as that of `M(p = 2)`. The errors are independent
/// of each other as far as possible.
pub fn flatten(
    library: &Library,
    class: &Name,
    modification: &[Argument],
) -> Result<Flattened, Vec<Diagnostic>> {
    match flatten_unbalanced(library, class, modification)? {
        (flattened, None) => Ok(flattened),
        (_, Some(imbalance)) => Err(vec![imbalance]),
    }
}

/// The same, also of a model that is not balanced, with the error that says so: the structural
/// analysis names the equations concerned.
pub fn flatten_unbalanced(
    library: &Library,
    class: &Name,
    modification: &[Argument],
) -> Result<(Flattened, Option<Diagnostic>), Vec<Diagnostic>> {
    on_deep_stack(|| {
        flattened(library, class, modification)
            .map_err(|errors| after_missing_imports(library, class, errors))
    })
    .unwrap_or_else(|error| Err(vec![error]))
}

/// Errors by names that mean nothing, after the imports of what does not exist, which may be why.
fn after_missing_imports(
    library: &Library,
    class: &Name,
    errors: Vec<Diagnostic>,
) -> Vec<Diagnostic> {
    if !errors.iter().any(|error| [UNKNOWN_CLASS, UNKNOWN_NAME].contains(&error.code)) {
        return errors;
    }
    let mut all = library.find(class).map_or(Vec::new(), |id| checks::missing_imports(library, id));
    all.extend(errors);
    distinct(all)
}

/// Where there are no threads (browsers), the stack is the one that the program was linked with.
#[cfg(target_family = "wasm")]
fn on_deep_stack<T>(work: impl FnOnce() -> T) -> Result<T, Diagnostic> {
    Ok(work())
}

/// Runs work on a thread whose stack holds the deepest nesting of expressions that is accepted.
#[cfg(not(target_family = "wasm"))]
fn on_deep_stack<T: Send>(work: impl FnOnce() -> T + Send) -> Result<T, Diagnostic> {
    std::thread::scope(|scope| {
        let thread = std::thread::Builder::new().stack_size(STACK).spawn_scoped(scope, work);
        match thread.map(std::thread::ScopedJoinHandle::join) {
            Ok(Ok(result)) => Ok(result),
            Ok(Err(panic)) => std::panic::resume_unwind(panic),
            Err(error) => Err(fault!(TOO_LARGE, "cannot start a thread: {error}").at(Span::NONE)),
        }
    })
}

/// What is wrong with a class by its text and the names in it, whatever is made of it: a package, a
/// function or a model that is never instantiated can be checked too. Nothing if no such class is
/// loaded.
pub fn check(library: &Library, class: &Name) -> Vec<Diagnostic> {
    library.find(class).map_or(Vec::new(), |id| checks::check_class(library, id))
}

/// What checks found, if these are only warnings; else the errors, and then the warnings.
fn tolerated(found: Vec<Diagnostic>) -> Result<Vec<Diagnostic>, Vec<Diagnostic>> {
    let (mut wrong, tolerated): (Vec<_>, Vec<_>) =
        found.into_iter().partition(|one| one.severity != Severity::Warning);
    if wrong.is_empty() {
        return Ok(tolerated);
    }
    wrong.extend(tolerated);
    Err(distinct(wrong))
}

fn flattened(
    library: &Library,
    class: &Name,
    modification: &[Argument],
) -> Result<(Flattened, Option<Diagnostic>), Vec<Diagnostic>> {
    let one = |error: Diagnostic| vec![error];
    let mut instantiation = Instantiation::new(library);
    let specifier = TypeSpecifier { name: class.clone(), span: Span::NONE };
    let found = instantiation.classes.lookup_type(ScopeId::TOP, &specifier).map_err(one)?;
    let lookup::types::Type::Class(id) = found else {
        return Err(vec![fault!(NOT_A_MODEL, "`{class}` is a predefined type").at(Span::NONE)]);
    };
    let text = instantiation.classes.text(id).clone();
    check_restriction(class, &text.definition).map_err(one)?;
    let found = text.id.map_or(Vec::new(), |class| checks::check(library, class));
    instantiation.warnings.extend(tolerated(found)?);
    instantiation.classes.check_complete(id, text.span()).map_err(one)?;
    let modifier = Modifier::of_arguments(modification, ScopeId::TOP).map_err(one)?;
    instantiation.classes.tree.model_name =
        text.name.last().unwrap_or(instantiation.classes.tree.model_name);
    let root = instantiation.classes.model(id, modifier).map_err(one)?;
    instantiation.complete(root).map_err(distinct)?;
    let mut model = FlatModel {
        name: text.name.to_string(),
        description: described(&text.definition),
        experiment: experiment(&text.definition),
        resources: library.resources().clone(),
        strict: library.is_strict(),
        span: Some(text.span()),
        ..FlatModel::default()
    };
    let mut errors = Vec::new();
    let connections = std::rc::Rc::new(instantiation.connections(root, &mut errors));
    instantiation.connections = Some(connections.clone());
    instantiation.add_equations(root, &mut model, &mut errors);
    if errors.is_empty() {
        instantiation.add_connection_equations(&connections, &mut model).map_err(one)?;
    }
    instantiation.add_variables(root, &mut model, &mut errors);
    if !errors.is_empty() {
        return Err(distinct(errors));
    }
    object_equations::resolve(&mut model)?;
    let signals = instantiation.classes.own_signals(root).map_err(one)?;
    let classes = instantiation.local_balances(&connections, &model).map_err(distinct)?;
    let unit_warnings = instantiation.classes.unit_warnings(&model);
    let mut warnings = instantiation.warnings.into_all();
    let notes = instantiation.values.outside.notes().into_iter();
    warnings.extend(notes.map(|note| note.at(Span::NONE).note()));
    for (name, function) in instantiation.functions.table {
        model.functions.extend(function.map(|function| (name, function)));
    }
    let imbalance = imbalance(&mut model, &classes, &signals);
    let imbalance = imbalance.map(|error| of_two_sources(&warnings).unwrap_or(error));
    warnings.extend(balance::warnings(&classes));
    warnings.extend(unit_warnings);
    let balance = classes.into_iter().find(|class| class.path.is_empty());
    Ok((Flattened { model, balance, warnings: distinct(warnings) }, imbalance))
}

/// Whether there are too few or too many equations. What nothing determines in connectors of the model
/// comes from outside, if it is balanced so.
fn imbalance(
    model: &mut FlatModel,
    classes: &[balance::LocalBalance],
    signals: &own_signals::Signals,
) -> Option<Diagnostic> {
    if !signals.is_empty() && balance::is_balanced(model) == Some(false) {
        own_signals::name(model, signals, true);
        if balance::is_balanced(model) == Some(true) {
            return None;
        }
        own_signals::name(model, signals, false);
    }
    balance::check(model, classes).err()
}

/// Two sources of one signal, of which a warning says so: they are too many equations.
fn of_two_sources(warnings: &[Diagnostic]) -> Option<Diagnostic> {
    let found = warnings.iter().find(|warning| warning.code == INVALID_CONNECTION);
    found.cloned().map(Diagnostic::error)
}

/// The errors without those that say the same of the same place, as those of the elements of an
/// array do.
fn distinct(errors: Vec<Diagnostic>) -> Vec<Diagnostic> {
    let mut seen = BTreeSet::new();
    let place = |error: &Diagnostic| {
        let label = error.labels.first().map(|label| (label.span.source, label.span.start));
        (error.message.clone(), label)
    };
    errors.into_iter().filter(|error| seen.insert(place(error))).collect()
}

/// Only models, blocks and classes can be simulated (MLS §4.7).
fn check_restriction(name: &Name, definition: &ClassDefinition) -> Result<(), Diagnostic> {
    let what = match definition.restriction {
        Restriction::Model | Restriction::Block | Restriction::Class => return Ok(()),
        Restriction::Package => "a package",
        Restriction::Function { .. } => "a function",
        Restriction::Record | Restriction::OperatorRecord => "a record",
        Restriction::Connector | Restriction::ExpandableConnector => "a connector",
        Restriction::Type => "a type",
        Restriction::Operator => "an operator",
    };
    Err(fault!(NOT_A_MODEL, "`{name}` is {what}, not a model").at(definition.name.span))
}

fn described(definition: &ClassDefinition) -> Option<std::sync::Arc<str>> {
    match &definition.specifier {
        ClassSpecifier::Long(long) => long.description.clone(),
        ClassSpecifier::Short(short) => short.comment.text.clone(),
        _ => None,
    }
}

/// The `experiment` annotation of a class (MLS §18.4), as it is written.
pub fn experiment_annotation(definition: &ClassDefinition) -> Option<&Argument> {
    let annotations: Vec<&Annotation> = match &definition.specifier {
        ClassSpecifier::Long(long) => long
            .sections
            .iter()
            .filter_map(|section| match section {
                Section::Annotation(annotation) => Some(annotation),
                _ => None,
            })
            .collect(),
        ClassSpecifier::Short(short) => short.comment.annotation.iter().collect(),
        _ => Vec::new(),
    };
    let mut arguments = annotations.into_iter().flat_map(|annotation| &annotation.arguments);
    arguments.find(|argument| named(argument).is_some_and(|(name, _)| name == "experiment"))
}

/// What the `experiment` annotation of a class says.
pub fn experiment(definition: &ClassDefinition) -> Experiment {
    let mut found = Experiment::default();
    let written = experiment_annotation(definition).and_then(named);
    for setting in written.iter().flat_map(|(_, modification)| &modification.arguments) {
        let Some((name, setting)) = named(setting) else { continue };
        let value = number(setting);
        match name.as_str() {
            "StartTime" => found.start_time = value,
            "StopTime" => found.stop_time = value,
            "Interval" => found.interval = value,
            "Tolerance" => found.tolerance = value,
            _ => {}
        }
    }
    found
}

fn named(argument: &Argument) -> Option<(String, &ast::Modification)> {
    match argument {
        Argument::Element(element) => {
            Some((element.name.node.to_string(), element.modification.as_ref()?))
        }
        Argument::Redeclaration(_) => None,
    }
}

fn number(modification: &ast::Modification) -> Option<f64> {
    let Some(Binding::Expression(value)) = &modification.binding else { return None };
    literal_number(value)
}

fn literal_number(e: &ast::Expression) -> Option<f64> {
    match &e.kind {
        ExpressionKind::Real(value) => Some(*value),
        ExpressionKind::Integer(value) => Some(*value as f64),
        ExpressionKind::Unary { operator: UnaryOperator::Minus, operand } => {
            literal_number(operand).map(|value| -value)
        }
        _ => None,
    }
}
