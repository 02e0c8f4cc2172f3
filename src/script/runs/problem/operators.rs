//! The method of a problem with the operators that were chosen for it: entries of the tables, or
//! functions written in Modelica.

use super::file::{OperatorEntry, ProblemFile};
use super::own_function::{Around, OwnFunction, function};
use crate::Session;
use crate::diag::{Diagnostic, Fault};
use crate::eval::Function;
use crate::fault;
use crate::ga::errors::BAD_OPERATOR;
use crate::ga::operators::{self, OperatorKind, Size};
use crate::ga::optimizer::{METHODS, Method};
use crate::registry::{self, BAD_OPTION, Choice, Entry, Options};
use crate::source::Span;
use std::sync::Arc;

/// The method, and its name in the table.
pub(super) type Named = (&'static str, Box<dyn Method>);

/// The method of a problem with so many genes; `usual` unless the problem names another one.
///
/// # Errors
///
/// Names that are in no table, settings that do not fit, functions that cannot be such an operator.
pub(super) fn method(
    session: &mut Session,
    file: &ProblemFile,
    usual: &str,
    n_genes: usize,
) -> Result<Named, Vec<Diagnostic>> {
    let requested = file.method.name.as_deref().unwrap_or(usual);
    let entry = registry::find("method", METHODS, requested);
    let entry = *entry
        .as_ref()
        .map_err(|fault| vec![fault.clone().at(file.context.places.at(&["method", "name"]))])?;
    let mut options = Options::default();
    file.method.settings.iter().for_each(|(name, value)| options.set(name, *value));
    let mut chosen = Vec::new();
    for (kind, entry) in file.method.operators() {
        let place = file.context.places.at(&["method", kind]);
        match entry {
            OperatorEntry::Frequency(value)
                if operators::kind(kind).is_some_and(|kind| kind.frequency.is_some()) =>
            {
                options.set(kind, *value);
            }
            other => chosen.push((kind, place, other)),
        }
    }
    let one = |fault: Fault, span: Span| vec![fault.at(span)];
    let mut method =
        made(entry, &options).map_err(|fault| one(fault, file.context.places.at(&["method"])))?;
    // One after the other, so that what is wrong has a place.
    for (kind, place, choice) in chosen {
        if !registry::choices(entry).contains(&kind) {
            return Err(one(without(entry, kind), place));
        }
        let mut choice = choice_of(choice).map_err(|fault| one(fault, place))?;
        if let Some(kind) = operators::kind(kind).filter(|kind| !kind.has(&choice.name))
            && let Some(function) = function(session, &choice.name).map_err(|error| vec![error])?
        {
            check(kind, &choice.name, &function).map_err(|fault| one(fault, place))?;
            choice.function = Some(Arc::new(compiled(session, kind, &choice.name, n_genes)?));
        }
        options.choose(kind, choice);
        method = made(entry, &options).map_err(|fault| one(fault, place))?;
    }
    Ok((entry.name, method))
}

fn made(entry: &Entry<dyn Method>, options: &Options) -> Result<Box<dyn Method>, Fault> {
    let mut options = options.clone();
    let method = (entry.make)(&mut options)?;
    options.finish()?;
    Ok(method)
}

fn choice_of(entry: &OperatorEntry) -> Result<Choice, Fault> {
    match entry {
        OperatorEntry::Name(text) => Choice::parse(text),
        OperatorEntry::Set(entry) => {
            let mut choice = Choice::named(&entry.name);
            entry.settings.iter().for_each(|(name, value)| choice.options.set(name, *value));
            Ok(choice)
        }
        OperatorEntry::Frequency(value) => Err(fault!(BAD_OPTION, "`{value}` is not an operator")
            .help("write its name, such as \"tournament\"")),
    }
}

/// A method that has no operators of this kind.
fn without(entry: &Entry<dyn Method>, kind: &str) -> Fault {
    let with = METHODS.iter().filter(|entry| registry::choices(entry).contains(&kind));
    let with: Vec<&str> = with.map(|entry| entry.name).collect();
    fault!(BAD_OPTION, "`{}` has no selectable {kind}", entry.name)
        .help(format!("methods with a selectable one: {}", with.join(", ")))
}

/// Whether a function has as many inputs and outputs as an operator of this kind.
///
/// # Errors
///
/// `bad-operator`, with the declaration that is expected.
pub(crate) fn check(kind: &OperatorKind, name: &str, function: &Function) -> Result<(), Fault> {
    let found = [function.inputs.len(), function.outputs.len()];
    let expected = [kind.signature.inputs.len(), kind.signature.outputs.len()];
    if found == expected {
        return Ok(());
    }
    let count = |[inputs, outputs]: [usize; 2]| {
        let plural = |count: usize| if count == 1 { "" } else { "s" };
        format!("{inputs} input{} and {outputs} output{}", plural(inputs), plural(outputs))
    };
    Err(fault!(
        BAD_OPERATOR,
        "`{name}` has {}, but a {} has {}",
        count(found),
        kind.name,
        count(expected)
    )
    .help(format!("declare it as\n{}", kind.declaration().trim_end())))
}

/// A function as an operator on so many genes.
fn compiled(
    session: &mut Session,
    kind: &OperatorKind,
    name: &str,
    n_genes: usize,
) -> Result<OwnFunction, Vec<Diagnostic>> {
    let variable = |name: &str| format!("gapi_{name}");
    let dims = |size: Size| match size {
        Size::One => Vec::new(),
        Size::Genes => vec![n_genes],
        Size::Random => vec![n_genes, operators::NUMBERS],
    };
    let numbers = |dims: &[usize]| dims.iter().map(usize::to_string).collect::<Vec<_>>().join(",");
    let mut body = String::new();
    for (name, size) in kind.signature.inputs {
        let (name, dims) = (variable(name), dims(*size));
        body += &match dims.as_slice() {
            [] => format!("  parameter Real {name} = 0;\n"),
            dims => format!("  parameter Real {name}[{0}] = zeros({0});\n", numbers(dims)),
        };
    }
    for (name, size) in kind.signature.outputs {
        let (name, dims) = (variable(name), dims(*size));
        body += &match dims.as_slice() {
            [] => format!("  Real {name};\n"),
            dims => format!("  Real {name}[{}];\n", numbers(dims)),
        };
    }
    let names = |list: &[(&str, Size)]| {
        list.iter().map(|(name, _)| variable(name)).collect::<Vec<_>>().join(", ")
    };
    let (inputs, outputs) = (names(kind.signature.inputs), names(kind.signature.outputs));
    let outputs = if kind.signature.outputs.len() > 1 { format!("({outputs})") } else { outputs };
    body += &format!("equation\n  {outputs} = {name}({inputs});\n");
    let scalars = |list: &[(&str, Size)]| -> Vec<String> {
        list.iter().flat_map(|(name, size)| scalars(&variable(name), &dims(*size))).collect()
    };
    OwnFunction::compiled(
        session,
        Around {
            purpose: kind.name,
            name,
            body,
            inputs: scalars(kind.signature.inputs),
            outputs: scalars(kind.signature.outputs),
        },
    )
}

/// The names of the elements of an array, the last subscript first.
fn scalars(name: &str, dims: &[usize]) -> Vec<String> {
    match dims {
        [rows, columns] => (1..=*rows)
            .flat_map(|row| (1..=*columns).map(move |column| format!("{name}[{row},{column}]")))
            .collect(),
        [count] => (1..=*count).map(|k| format!("{name}[{k}]")).collect(),
        _ => vec![name.to_owned()],
    }
}
