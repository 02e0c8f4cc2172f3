//! Operators of operator records (MLS ch. 14).

use super::scope::{Component, Scope};
use crate::diag::Diagnostic;
use crate::fault;
use crate::flatten::declared::classes::Type;
use crate::flatten::errors::ILLEGAL_OPERATOR;
use crate::flatten::lookup::types::Predefined;
use crate::name::Ident;
use crate::syntax::ast::{CausalityPrefix, Restriction};

/// Operators with two operands only.
const BINARY: &[&str] =
    &["'+'", "'*'", "'/'", "'^'", "'=='", "'<>'", "'>'", "'<'", "'>='", "'<='", "'and'", "'or'"];

/// Checks the operators of an operator record.
pub(crate) fn check(class: Scope<'_>, errors: &mut Vec<Diagnostic>) {
    if class.restriction() != Restriction::OperatorRecord {
        return;
    }
    for (_, nested) in class.class_elements() {
        let name = nested.class.name.node;
        let Some(operator) = class.class_named(&name.into()) else { continue };
        let functions = match operator.restriction() {
            Restriction::Function { operator: true, .. } => vec![operator],
            Restriction::Operator => functions(operator),
            _ => continue,
        };
        for function in &functions {
            errors.extend(wrong(class, name, *function));
        }
        if name.as_str() == "'constructor'" {
            errors.extend(ambiguous(&functions));
        }
    }
}

/// The functions of an operator that are written out.
fn functions(operator: Scope<'_>) -> Vec<Scope<'_>> {
    let named = |(_, nested): (_, &crate::syntax::ast::ClassElement)| {
        operator.class_named(&nested.class.name.node.into())
    };
    operator.class_elements().filter_map(named).collect()
}

/// What is wrong with one function of an operator.
fn wrong(record: Scope<'_>, operator: Ident, function: Scope<'_>) -> Option<Diagnostic> {
    let outputs = formal(function, CausalityPrefix::Output);
    let inputs = formal(function, CausalityPrefix::Input);
    let [output] = outputs.as_slice() else {
        return Some(complaint(function, &format!("has {} outputs instead of one", outputs.len())));
    };
    let gives_record = class_of(output).is_none_or(|class| is_same(class, record));
    match operator.as_str() {
        "'constructor'" | "'0'" if !gives_record || is_predefined(output) => {
            Some(complaint(function, &format!("does not return a `{}`", record.name())))
        }
        "'0'" if !inputs.is_empty() => Some(complaint(function, "has inputs")),
        "'String'" if is_other_than_string(output) => {
            Some(complaint(function, "does not return a String"))
        }
        name if BINARY.contains(&name) && inputs.len() < 2 => {
            Some(complaint(function, "has fewer than two inputs"))
        }
        "'-'" | "'not'" | "'String'" if inputs.is_empty() => {
            Some(complaint(function, "has no input"))
        }
        _ => None,
    }
}

/// Two constructors that the same calls fit: an input with a default tells them apart where a call
/// gives it, and what a call gives decides then (MLS §14.3).
fn ambiguous(functions: &[Scope<'_>]) -> Option<Diagnostic> {
    for (at, function) in functions.iter().enumerate() {
        let signature = signature(*function)?;
        let same = functions[..at].iter().find(|other| {
            let same_required = self::signature(**other).as_ref() == Some(&signature);
            same_required && optional(**other) == optional(*function)
        });
        if let Some(other) = same {
            let message = format!("has the same inputs as `{}`", other.definition().name.node);
            return Some(complaint(*function, &message));
        }
    }
    None
}

/// The type and the number of dimensions of an input; no type where it is not known.
type InputType = (Option<Type>, usize);

/// The types of the inputs that a call must give; `None` where a type is not known.
fn signature(function: Scope<'_>) -> Option<Vec<(Type, usize)>> {
    let required = |input: &Component<'_>| !has_default(input);
    let types = formal(function, CausalityPrefix::Input).into_iter().filter(required);
    types.map(|input| input_type(&input)).map(|(type_, rank)| Some((type_?, rank))).collect()
}

/// The names and types of the inputs that a call may leave out.
fn optional(function: Scope<'_>) -> Vec<(Ident, InputType)> {
    let inputs = formal(function, CausalityPrefix::Input).into_iter();
    inputs.filter(has_default).map(|input| (input.name(), input_type(&input))).collect()
}

fn has_default(input: &Component<'_>) -> bool {
    let modification = input.declaration.modification.as_ref();
    modification.is_some_and(|modification| modification.binding.is_some())
}

fn input_type(input: &Component<'_>) -> InputType {
    let dimensions = input.clause.subscripts.len() + input.declaration.subscripts.len();
    (input.meaning(), dimensions)
}

fn complaint(function: Scope<'_>, what: &str) -> Diagnostic {
    fault!(ILLEGAL_OPERATOR, "the operator function `{}` {what}", function.name();
        help: "correct its declaration, or declare an ordinary function")
    .at(function.definition().name.span)
}

fn formal(function: Scope<'_>, causality: CausalityPrefix) -> Vec<Component<'_>> {
    let lineage = function.lineage();
    let components = lineage.into_iter().flat_map(Scope::components);
    components.filter(|one| one.clause.type_prefixes.causality == Some(causality)).collect()
}

fn class_of<'a>(component: &Component<'a>) -> Option<Scope<'a>> {
    component.class().map(|class| class.unaliased().0.unwrap_or(class))
}

fn is_predefined(component: &Component<'_>) -> bool {
    matches!(component.meaning(), Some(Type::Predefined(_)))
}

fn is_other_than_string(component: &Component<'_>) -> bool {
    match component.meaning() {
        Some(Type::Predefined(predefined)) => predefined != Predefined::String,
        Some(Type::Class(_)) => {
            component.class().and_then(Scope::predefined) != Some(Predefined::String)
        }
        None => false,
    }
}

/// Whether a class is another one, or short for it, or it short for the class.
fn is_same(a: Scope<'_>, b: Scope<'_>) -> bool {
    let target = |class: Scope<'_>| class.unaliased().0.map(|class| class.class);
    a.class == b.class || target(a) == target(b)
}
