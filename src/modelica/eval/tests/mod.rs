//! Evaluation from text, with a host that knows the functions of the text.

mod builtins;
mod expressions;
mod functions;
mod host;
pub(crate) mod inference;
mod robustness;
mod scalars;
mod shipped;
mod statements;

use super::{Flow, Scope, evaluate, execute};
use crate::diag::Diagnostic;
use crate::source::SourceId;
use crate::syntax::ast::{InteractiveKind, Statement};
use crate::syntax::{parse_expression, parse_script};
use crate::value::Value;
use crate::value::show::{Style, show};
use host::TestHost;

/// What OpenModelica's style shows of the value of an expression.
fn eval(text: &str) -> String {
    match value_of(text) {
        Ok(value) => show(&value, Style::OpenModelica),
        Err(error) => panic!("`{text}` fails: {error}"),
    }
}

/// The message of the error that an expression gives.
fn fails(text: &str) -> String {
    match value_of(text) {
        Ok(value) => panic!("`{text}` has the value {}", show(&value, Style::OpenModelica)),
        Err(error) => format!("{}: {}", error.code.slug, error.message),
    }
}

fn value_of(text: &str) -> Result<Value, Diagnostic> {
    let expression = parse_expression(SourceId::NONE, text).expect(text);
    evaluate(&expression, &mut Scope::script(), &mut TestHost::default())
}

/// Runs a script of statements and function definitions, and shows one expression after it.
fn run(script: &str, shown: &str) -> String {
    match try_run(script, shown) {
        Ok(value) => show(&value, Style::OpenModelica),
        Err(error) => panic!("fails: {error}\n{:?}", error.trace),
    }
}

/// The error of a script.
fn run_fails(script: &str) -> String {
    match try_run(script, "0") {
        Ok(_) => panic!("the script runs"),
        Err(error) => format!("{}: {}", error.code.slug, error.message),
    }
}

fn try_run(script: &str, shown: &str) -> Result<Value, Diagnostic> {
    let mut host = TestHost::default();
    let mut scope = Scope::script();
    run_in(script, &mut scope, &mut host)?;
    let expression = parse_expression(SourceId::NONE, shown).expect(shown);
    evaluate(&expression, &mut scope, &mut host)
}

fn run_in(script: &str, scope: &mut Scope, host: &mut TestHost) -> Result<(), Diagnostic> {
    let script = parse_script(SourceId::NONE, script)?;
    let mut statements: Vec<Statement> = Vec::new();
    for interactive in script.statements {
        match interactive.kind {
            InteractiveKind::Statement(statement) => statements.push(statement),
            InteractiveKind::Expression(expression) => {
                evaluate_after(&mut statements, scope, host)?;
                evaluate(&expression, scope, host)?;
            }
            InteractiveKind::Class(class) => host.define(&class),
            InteractiveKind::Declaration(clause) => {
                evaluate_after(&mut statements, scope, host)?;
                host.declare(&clause, scope)?;
            }
            other => panic!("not in these tests: {other:?}"),
        }
    }
    evaluate_after(&mut statements, scope, host)
}

fn evaluate_after(
    statements: &mut Vec<Statement>,
    scope: &mut Scope,
    host: &mut TestHost,
) -> Result<(), Diagnostic> {
    let flow = execute(statements, scope, host)?;
    assert_eq!(flow, Flow::Next);
    statements.clear();
    Ok(())
}
