//! Constraints between parameters, such as `a < b` or `a + 2*b <= 10`: inequalities of arithmetic
//! expressions as in Modelica.

use super::enclosing_class;
use crate::diag::{Fault, suggest};
use crate::identify::problem::inference::{Constraint, Function, Operator, Term};
use crate::registry::BAD_OPTION;
use crate::source::SourceId;
use crate::syntax::ast::{
    BinaryOperator, ComponentReference, Expression, ExpressionKind, UnaryOperator,
};
use crate::syntax::{parse_expression, print};
use crate::{bail, fault};

/// The longest constraint: its terms are evaluated by recursion.
const MAX_LENGTH: usize = 10_000;

/// Reads an inequality of these parameters.
///
/// # Errors
///
/// Anything else.
pub(super) fn constraint(text: &str, parameters: &[String]) -> Result<Constraint, Fault> {
    if text.len() > MAX_LENGTH {
        bail!(
            BAD_OPTION,
            "a constraint has {} characters, {MAX_LENGTH} are the most", text.len();
            help: "make it several constraints"
        );
    }
    let read = parse_expression(SourceId::NONE, text);
    let read = read.map_err(|error| {
        fault!(BAD_OPTION, "the constraint `{text}` cannot be read: {}", error.message)
    })?;
    let ExpressionKind::Binary { operator, left, right } = &read.kind else {
        return Err(not_an_inequality(text));
    };
    let (left, right) = (term(text, left, parameters)?, term(text, right, parameters)?);
    let (smaller, larger) = match operator {
        BinaryOperator::Less | BinaryOperator::LessEqual => (left, right),
        BinaryOperator::Greater | BinaryOperator::GreaterEqual => (right, left),
        BinaryOperator::Equal => bail!(
            BAD_OPTION,
            "the constraint `{text}` is an equation";
            help: "make one parameter depend on the others: `b = {{ tied = \"2*a\" }}`"
        ),
        _ => return Err(not_an_inequality(text)),
    };
    Ok(Constraint::of_terms(text, [smaller, larger]))
}

fn not_an_inequality(text: &str) -> Fault {
    fault!(BAD_OPTION, "the constraint `{text}` is not an inequality"; help: "write for example \"a < b\" or \"a + b <= 10\"")
}

fn term(text: &str, expression: &Expression, parameters: &[String]) -> Result<Term, Fault> {
    let inner =
        |expression: &Expression| Ok::<_, Fault>(Box::new(term(text, expression, parameters)?));
    match &expression.kind {
        ExpressionKind::Real(value) => Ok(Term::Number(*value)),
        ExpressionKind::Integer(value) => Ok(Term::Number(*value as f64)),
        ExpressionKind::Reference(reference) => parameter(text, reference, parameters),
        ExpressionKind::String(name) => match enclosing_class::quoted_name(name) {
            Some(reference) => parameter(text, &reference, parameters),
            None => Err(more_than_arithmetic(text)),
        },
        ExpressionKind::Unary { operator: UnaryOperator::Plus, operand } => {
            term(text, operand, parameters)
        }
        ExpressionKind::Unary { operator: UnaryOperator::Minus, operand } => {
            Ok(Term::Negative(inner(operand)?))
        }
        ExpressionKind::Binary { operator, left, right } => match arithmetic(*operator) {
            Some(operator) => Ok(Term::Binary(operator, inner(left)?, inner(right)?)),
            None => Err(more_than_arithmetic(text)),
        },
        ExpressionKind::Call { function, arguments } => {
            let name = written(function);
            match (
                Function::named(&name),
                arguments.positional.as_slice(),
                arguments.named.as_slice(),
            ) {
                (Some(function), [argument], []) => Ok(Term::Function(function, inner(argument)?)),
                _ => {
                    bail!(BAD_OPTION, "the constraint `{text}` calls `{name}`"; help: "use + - * / ^ abs exp log log10 sqrt")
                }
            }
        }
        // Parentheses are read as a list of one element where they hold more than arithmetic.
        ExpressionKind::Tuple(list) => match list.as_slice() {
            [Some(only)] => term(text, only, parameters),
            _ => Err(not_an_inequality(text)),
        },
        _ => Err(more_than_arithmetic(text)),
    }
}

fn more_than_arithmetic(text: &str) -> Fault {
    fault!(BAD_OPTION, "the constraint `{text}` contains more than arithmetic"; help: "write a separate inequality for each condition")
}

fn arithmetic(operator: BinaryOperator) -> Option<Operator> {
    Some(match operator {
        BinaryOperator::Add => Operator::Add,
        BinaryOperator::Subtract => Operator::Subtract,
        BinaryOperator::Multiply => Operator::Multiply,
        BinaryOperator::Divide => Operator::Divide,
        BinaryOperator::Power => Operator::Power,
        _ => return None,
    })
}

fn written(reference: &ComponentReference) -> String {
    let parts: Vec<&str> = reference.parts.iter().map(|part| part.name.as_str()).collect();
    parts.join(".")
}

fn parameter(
    text: &str,
    reference: &ComponentReference,
    parameters: &[String],
) -> Result<Term, Fault> {
    let name = print::reference(reference);
    let without_blanks = |name: &str| name.replace(' ', "");
    let is_it = |own: &String| without_blanks(own) == without_blanks(&name);
    match parameters.iter().position(is_it) {
        Some(place) => Ok(Term::Parameter(place)),
        None => Err(fault!(
            BAD_OPTION,
            "the constraint `{text}` names `{name}`, which is not an estimated parameter"
        )
        .help_if(suggest::did_you_mean(&name, parameters.iter().map(String::as_str)))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names() -> Vec<String> {
        ["a", "b.c", "r[1].k", "p[2,1]"].map(str::to_owned).to_vec()
    }

    #[test]
    fn inequalities_hold_or_are_violated_by_a_share() {
        let read = |text| constraint(text, &names()).unwrap();
        assert_eq!(read("a < b.c").violation(&[1.0, 2.0]), 0.0);
        assert!((read("a < b.c").violation(&[3.0, 1.0]) - 0.5).abs() < 1e-15);
        let of_elements = read("r[1].k < p[2, 1]");
        assert_eq!(of_elements.violation(&[9.0, 9.0, 1.0, 2.0]), 0.0);
        assert!((of_elements.violation(&[0.0, 0.0, 3.0, 1.0]) - 0.5).abs() < 1e-15);
        assert_eq!(read("2*(a + sqrt(b.c)) >= -1").violation(&[1.0, 4.0]), 0.0);
        assert!(read("log(a) <= b.c^2").violation(&[1e9, 1.0]) > 0.8);
        assert!(read("log(a) <= 1").violation(&[-1.0, 0.0]).is_infinite(), "no logarithm");
        assert!(
            read("a < b.c").is_active(&[1.0, 1.0001]) && !read("a < b.c").is_active(&[1.0, 2.0])
        );
    }

    #[test]
    fn anything_else_is_refused() {
        let message = |text| constraint(text, &names()).unwrap_err().message;
        assert!(message("a == b.c").contains("is an equation"));
        assert!(message("a + b.c").contains("is not an inequality"));
        assert!(message("a < d").contains("`d`, which is not an estimated parameter"));
        assert!(message("a < sin(b.c)").contains("calls `sin`"));
        assert!(message("a < ").contains("cannot be read"));
        assert!(
            message("a < b.c < 3").contains("cannot be read")
                || message("a < b.c < 3").contains("more than")
        );
    }
}
