//! Declarations of external functions in C, as `external` clauses write them (MLS §12.9).

use super::{Function, FunctionBody, FunctionComponent, ValueType};
use crate::diag::{Diagnostic, Fault};
use crate::external::c::{Argument, Declaration, Request, Scalar};
use crate::external::errors::EXTERNAL_DECLARATION;
use crate::external::{self, Effect, Entry, Outside};
use crate::fault;
use crate::name::{Ident, Name};
use crate::source::Span;
use crate::syntax::ast::{
    self, Arguments, Binding, ComponentReference, Expression, ExpressionKind, External,
};
use std::borrow::Cow;
use std::sync::Arc;

/// The external name of a function.
pub(crate) fn external_name(function: &Function, clause: &External) -> Ident {
    let own = || function.name.last().unwrap_or_else(|| Ident::new(""));
    clause.function.as_ref().map_or_else(own, |name| name.node)
}

/// The function in Rust that a clause means, if there is one.
pub(crate) fn in_rust(function: &Function, clause: &External) -> Option<&'static Entry> {
    let include = string(clause, "Include").unwrap_or_default();
    let entry = external::find_declared(external_name(function, clause).as_str(), &include)?;
    // A function of another library may have the same name.
    let is_other = brings_code(clause)
        && clause.function.is_some()
        && !entry.takes(clause.arguments.len(), clause.output.is_some());
    (!is_other).then_some(entry)
}

/// Whether a function is in C that a library brings along.
pub fn is_in_c(function: &Function) -> bool {
    match &function.body {
        FunctionBody::External(clause) => {
            brings_code(clause) && in_rust(function, clause).is_none()
        }
        _ => false,
    }
}

/// Whether a clause says where its C code is, so that it does not mean a function of the language.
pub fn brings_code(clause: &External) -> bool {
    string(clause, "Include").is_some() || !strings(clause, "Library").is_empty()
}

/// The function in C that a clause means, compiled together with `others`.
///
/// # Errors
/// The declaration has no equivalent in C, or the host refuses.
pub(crate) fn in_c<'a>(
    function: &Function,
    clause: &External,
    others: impl Iterator<Item = &'a Arc<Function>>,
    outside: &mut dyn Outside,
) -> Result<&'static Entry, Diagnostic> {
    let own = declaration(function, clause)?;
    let mut near = Vec::new();
    for other in others {
        let FunctionBody::External(clause) = &other.body else { continue };
        let is_c = clause.language.as_deref().is_none_or(|language| language == "C");
        let is_near = other.name.first() == function.name.first();
        if is_c && is_near && in_rust(other, clause).is_none() && brings_code(clause) {
            // One that cannot be called at all is refused where it is called.
            near.extend(declaration(other, clause));
        }
    }
    outside.c_function(&Request::new(own, near)).map_err(|fault| fault.at(clause.span))
}

/// The call of a clause: as it is written, or that of the declaration (MLS §12.9.1).
pub(crate) fn call_of<'c>(function: &Function, clause: &'c External) -> Cow<'c, External> {
    if clause.function.is_some() {
        return Cow::Borrowed(clause);
    }
    let span = clause.span;
    let reference = |name: Ident| ComponentReference::from_name(&Name::from(name), span);
    let mut call = clause.clone();
    let result = match function.outputs.as_slice() {
        [output] if output.dims.is_empty() => Some(output.name),
        _ => None,
    };
    call.output = result.map(reference);
    for component in function.inputs.iter().chain(&function.outputs) {
        if Some(component.name) == result {
            continue;
        }
        let name = Expression::new(ExpressionKind::Reference(reference(component.name)), span);
        call.arguments.push(name.clone());
        for dimension in 1..=component.dims.len() as i64 {
            let number = Expression::new(ExpressionKind::Integer(dimension), span);
            let positional = vec![name.clone(), number];
            let arguments = Box::new(Arguments { positional, ..Arguments::default() });
            let function = reference(Ident::new("size"));
            call.arguments
                .push(Expression::new(ExpressionKind::Call { function, arguments }, span));
        }
    }
    Cow::Owned(call)
}

fn declaration(function: &Function, clause: &External) -> Result<Declaration, Diagnostic> {
    if let Some(language) = clause.language.as_deref()
        && language != "C"
    {
        return Err(refused(function, &format!("is in {language}"), clause.span));
    }
    let clause = call_of(function, clause);
    let mut arguments = Vec::with_capacity(clause.arguments.len());
    let mut objects = Vec::with_capacity(clause.arguments.len() + 1);
    for argument in &clause.arguments {
        arguments.push(self::argument(function, argument)?);
        objects.push(passed(function, argument).and_then(|(component, _)| object_class(component)));
    }
    let made = clause.output.as_ref().and_then(|output| function.variable(output.as_ident()?));
    objects.push(made.and_then(object_class));
    let result = match &clause.output {
        None => None,
        Some(output) => {
            let component = output.as_ident().and_then(|name| function.variable(name));
            let component = component.filter(|component| component.dims.is_empty());
            let scalar = component.and_then(|component| scalar(&component.value_type));
            let what = "returns what is not a number, a String or an external object";
            Some(scalar.ok_or_else(|| refused(function, what, output.span))?)
        }
    };
    let package = function.name.first().map_or(String::new(), |name| name.to_string());
    let folder = |name: &str| format!("modelica://{package}/Resources/{name}");
    let is_constructor = result == Some(Scalar::Object);
    Ok(Declaration {
        class: function.name.to_string(),
        function: external_name(function, &clause).to_string(),
        destructor: is_constructor.then(|| destructor(function).to_string()),
        objects,
        effect: effect(function, is_constructor),
        arguments,
        result,
        include: string(&clause, "Include"),
        include_directory: string(&clause, "IncludeDirectory").unwrap_or_else(|| folder("Include")),
        libraries: strings(&clause, "Library"),
        library_directory: string(&clause, "LibraryDirectory").unwrap_or_else(|| folder("Library")),
    })
}

fn object_class(component: &FunctionComponent) -> Option<String> {
    match &component.value_type {
        ValueType::ExternalObject(class) => Some(class.to_string()),
        _ => None,
    }
}

/// A constructor makes a new object with every call, and a function without outputs is called for
/// what it does.
fn effect(function: &Function, is_constructor: bool) -> Effect {
    match function.outputs.is_empty() {
        true => Effect::Writes,
        false if is_constructor || function.impure => Effect::State,
        false => Effect::None,
    }
}

/// The destructor that belongs to a constructor (MLS §12.9.7).
pub fn destructor(constructor: &Function) -> Name {
    let mut name = constructor.name.clone();
    name.parts.pop();
    name.parts.push(Ident::new("destructor"));
    name
}

/// The component that an argument is, or a component of a record that is an input, and whether it is
/// an input.
pub(crate) fn passed<'f>(
    function: &'f Function,
    argument: &Expression,
) -> Option<(&'f FunctionComponent, bool)> {
    let ExpressionKind::Reference(reference) = &argument.kind else { return None };
    if reference.parts.iter().any(|part| !part.subscripts.is_empty()) {
        return None;
    }
    let (first, rest) = reference.parts.split_first()?;
    let whole = function.variable(first.name)?;
    let is_input = function.inputs.iter().any(|input| input.name == first.name);
    let member = |of: &'f FunctionComponent, name: Ident| match &of.value_type {
        ValueType::Record(_, fields) if is_input && of.dims.is_empty() => fields.get(&name),
        _ => None,
    };
    Some((rest.iter().try_fold(whole, |of, part| member(of, part.name))?, is_input))
}

/// What is said of arguments whose sizes may differ from one record to the next.
const RECORDS: &str = "is passed a component of an array of records";

/// Whether an argument begins with an array of records, or with an element of one.
fn is_of_records(function: &Function, argument: &Expression) -> bool {
    let ExpressionKind::Reference(reference) = &argument.kind else { return false };
    let whole = reference.parts.first().and_then(|first| function.variable(first.name));
    let is_array = |whole: &FunctionComponent| {
        !whole.dims.is_empty() && matches!(whole.value_type, ValueType::Record(..))
    };
    reference.parts.len() > 1 && whole.is_some_and(is_array)
}

fn scalar(value_type: &ValueType) -> Option<Scalar> {
    Some(match value_type {
        ValueType::Real => Scalar::Real,
        ValueType::Integer | ValueType::Boolean | ValueType::Enumeration(_) => Scalar::Whole,
        ValueType::String => Scalar::Text,
        ValueType::ExternalObject(_) => Scalar::Object,
        _ => return None,
    })
}

fn argument(function: &Function, e: &Expression) -> Result<Argument, Diagnostic> {
    let what = "is passed an argument that is not a component, a constant or a size";
    Ok(match &e.kind {
        ExpressionKind::Real(_) => Argument::Value(Scalar::Real),
        ExpressionKind::Integer(_) | ExpressionKind::Boolean(_) => Argument::Value(Scalar::Whole),
        ExpressionKind::String(_) => Argument::Value(Scalar::Text),
        ExpressionKind::Unary { operand, .. }
            if matches!(operand.kind, ExpressionKind::Real(_) | ExpressionKind::Integer(_)) =>
        {
            return argument(function, operand);
        }
        ExpressionKind::Call { function: called, arguments }
            if called.as_ident().is_some_and(|name| name == "size")
                && arguments.positional.len() == 2 =>
        {
            Argument::Size
        }
        ExpressionKind::Reference(_) => {
            let passed = passed(function, e);
            let what = if is_of_records(function, e) { RECORDS } else { what };
            let (component, is_input) = passed.ok_or_else(|| refused(function, what, e.span))?;
            let record = "is passed a record or a function";
            let scalar =
                scalar(&component.value_type).ok_or_else(|| refused(function, record, e.span))?;
            match (component.dims.is_empty(), scalar) {
                (true, _) if is_input => Argument::Value(scalar),
                (true, Scalar::Object) => Argument::Value(scalar),
                (true, _) => Argument::Output(scalar),
                (false, Scalar::Object) => {
                    let what = "is passed an array of external objects";
                    return Err(refused(function, what, e.span));
                }
                (false, Scalar::Text) if !is_input => {
                    let what = "returns an array of Strings";
                    return Err(refused(function, what, e.span));
                }
                (false, _) if !is_input && !has_sizes(component) => {
                    let what = "writes to an array whose sizes are not declared";
                    return Err(refused(function, what, e.span));
                }
                (false, _) => Argument::Array(scalar),
            }
        }
        _ => return Err(refused(function, what, e.span)),
    })
}

/// Whether there is memory for all that C may write: with `[:]` and no value there is none.
fn has_sizes(component: &FunctionComponent) -> bool {
    let is_size = |dim: &ast::Subscript| matches!(dim, ast::Subscript::Index(_));
    component.binding.is_some() || component.dims.iter().all(is_size)
}

fn refused(function: &Function, what: &str, span: Span) -> Diagnostic {
    let fault: Fault = fault!(
        EXTERNAL_DECLARATION,
        "the external function `{}` {what}, which is not supported",
        function.name;
        help: "write a function in C that calls it, with numbers, Strings, arrays and external \
               objects as arguments"
    );
    fault.at(span)
}

/// What an argument of the annotation is bound to.
fn annotated<'c>(clause: &'c External, name: &str) -> Option<&'c Expression> {
    clause.annotation.as_ref()?.arguments.iter().find_map(|argument| match argument {
        ast::Argument::Element(element) if element.name.node.last()? == name => {
            match &element.modification.as_ref()?.binding {
                Some(Binding::Expression(e)) => Some(e),
                _ => None,
            }
        }
        _ => None,
    })
}

fn string(clause: &External, name: &str) -> Option<String> {
    match &annotated(clause, name)?.kind {
        ExpressionKind::String(text) => Some(text.to_string()),
        _ => None,
    }
}

/// One String or an array of Strings.
fn strings(clause: &External, name: &str) -> Vec<String> {
    let one = |e: &Expression| match &e.kind {
        ExpressionKind::String(text) => Some(text.to_string()),
        _ => None,
    };
    let Some(e) = annotated(clause, name) else { return Vec::new() };
    match &e.kind {
        ExpressionKind::Array(elements) => elements.iter().filter_map(one).collect(),
        _ => one(e).into_iter().collect(),
    }
}
