//! The standard deviation of a measurement as the problem file gives it: a number, a column of the
//! data, a formula of the output, `estimate`, or `estimate NAME` where outputs share it; a variable
//! of the model, or a formula of such (`deviation.rs`).

use super::enclosing_class::deviation_of;
use super::file::SigmaEntry;
use crate::diag::Fault;
use crate::identify::Model;
use crate::identify::problem::{Sigma, SigmaFormula};
use crate::mat::MatFile;
use crate::registry::BAD_OPTION;
use crate::source::SourceId;
use crate::syntax::ast::{BinaryOperator, Expression, ExpressionKind, UnaryOperator};
use crate::{bail, elementary, fault};
use std::sync::Arc;

/// What is written for deviations that are estimated.
const ESTIMATE: &str = "estimate";

/// Sigma of the output `name`: all rows of a column, NaN where it has no value, or what needs none.
/// `factor` converts values of columns to the output's unit.
///
/// # Errors
///
/// Numbers that are not positive, strings that are neither a column nor a formula of the output.
pub(super) fn sigma(
    entry: Option<&SigmaEntry>,
    (name, model): (&str, &dyn Model),
    table: &MatFile,
    factor: f64,
    rows: usize,
) -> Result<Sigma, Fault> {
    match entry {
        None => Ok(Sigma::Unknown),
        Some(SigmaEntry::Number(value)) => {
            positive(name, *value)?;
            Ok(Sigma::Given(vec![*value; rows]))
        }
        Some(SigmaEntry::Words(words)) if words == ESTIMATE => Ok(Sigma::Estimated),
        Some(SigmaEntry::Words(words)) if shared(words).is_some() => {
            Ok(shared(words).map_or(Sigma::Estimated, Sigma::Shared))
        }
        Some(SigmaEntry::Words(words)) => match table.column(words) {
            Ok(column) => {
                let wrong = column.values.iter().position(|value| *value <= 0.0);
                if let Some(row) = wrong {
                    let (value, place) = (column.values[row], column.place(row));
                    bail!(BAD_OPTION, "the sigma of `{name}` is {value} in {place} of `{words}`"; help: "a standard deviation must be positive; leave the cell empty to omit the point");
                }
                Ok(Sigma::Given(column.values.iter().map(|v| v * factor.abs()).collect()))
            }
            Err(_) if is_of_output(words, name) => formula(name, words).map(Sigma::Formula),
            Err(_) => match of_model(name, words, model) {
                Some(variable) => Ok(Sigma::Variable(variable)),
                None => formula(name, words).map(Sigma::Formula),
            },
        },
    }
}

/// Whether these words need nothing but the output: `estimate`, or a formula of it.
pub(super) fn is_of_output(words: &str, name: &str) -> bool {
    words == ESTIMATE || shared(words).is_some() || formula(name, words).is_ok()
}

/// The name in `estimate NAME`.
fn shared(words: &str) -> Option<String> {
    let name = words.strip_prefix(ESTIMATE)?.strip_prefix(' ')?.trim();
    let is_name = !name.is_empty() && name.chars().all(|c| c.is_alphanumeric() || c == '_');
    is_name.then(|| name.to_owned())
}

/// The variable that has the deviation: that of the class around the model, or one of the model.
fn of_model(name: &str, words: &str, model: &dyn Model) -> Option<String> {
    let own = deviation_of(name);
    let mut both = [own, words.trim().to_owned()].into_iter();
    both.find(|variable| model.unit(variable).is_some())
}

/// Refuses what cannot be a standard deviation.
///
/// # Errors
///
/// Numbers that are not positive.
pub(super) fn positive(name: &str, value: f64) -> Result<(), Fault> {
    if !(value.is_finite() && value > 0.0) {
        bail!(BAD_OPTION, "the sigma of `{name}` is \
                           {value}"; help: "a standard deviation must be positive");
    }
    Ok(())
}

/// What is neither a column nor a formula.
pub(super) fn neither(name: &str, text: &str) -> Fault {
    fault!(
        BAD_OPTION,
        "the sigma of `{name}` is `{text}`, which is neither a column of the data nor a \
         formula in terms of the output, of variables of the model and of parameters";
        help: "write a number, the name of a column, \"estimate\", or a formula such as \"0.01 + 0.05*abs({name})\""
    )
}

fn formula(name: &str, text: &str) -> Result<SigmaFormula, Fault> {
    let tree = crate::syntax::parse_expression(SourceId::NONE, text);
    let tree = tree.map_err(|_| neither(name, text))?;
    if value(&tree, name, 1.0).is_none() {
        return Err(neither(name, text));
    }
    let own = name.to_owned();
    let value = Arc::new(move |y: f64| value(&tree, &own, y).unwrap_or(f64::NAN));
    Ok(SigmaFormula { text: text.to_owned(), value })
}

/// The value of a formula where the output is `y`; `None` where it is not one.
fn value(tree: &Expression, name: &str, y: f64) -> Option<f64> {
    let of = |tree: &Expression| value(tree, name, y);
    match &tree.kind {
        ExpressionKind::Real(number) => Some(*number),
        ExpressionKind::Integer(number) => Some(*number as f64),
        ExpressionKind::Reference(_) => {
            let written = crate::syntax::print::expression(tree);
            (written == name || written == "y").then_some(y)
        }
        ExpressionKind::Unary { operator: UnaryOperator::Minus, operand } => Some(-of(operand)?),
        ExpressionKind::Unary { operator: UnaryOperator::Plus, operand } => of(operand),
        ExpressionKind::Binary { .. } => {
            let (first, operations) = tree.chain();
            operations.into_iter().try_fold(of(first)?, |a, one| {
                let b = of(one.right)?;
                match one.operator {
                    BinaryOperator::Add => Some(a + b),
                    BinaryOperator::Subtract => Some(a - b),
                    BinaryOperator::Multiply => Some(a * b),
                    BinaryOperator::Divide => Some(a / b),
                    BinaryOperator::Power => Some(elementary::powf(a, b)),
                    _ => None,
                }
            })
        }
        ExpressionKind::Tuple(parts) => match &parts[..] {
            [Some(inner)] => of(inner),
            _ => None,
        },
        ExpressionKind::Call { function, arguments } if arguments.named.is_empty() => {
            let [part] = &function.parts[..] else { return None };
            let values: Option<Vec<f64>> = arguments.positional.iter().map(of).collect();
            call(part.name.as_str(), &values?)
        }
        _ => None,
    }
}

fn call(function: &str, arguments: &[f64]) -> Option<f64> {
    match (function, arguments) {
        ("abs", [a]) => Some(a.abs()),
        ("sqrt", [a]) => Some(a.sqrt()),
        ("exp", [a]) => Some(elementary::exp(*a)),
        ("log", [a]) => Some(elementary::ln(*a)),
        ("min", [a, b]) => Some(a.min(*b)),
        ("max", [a, b]) => Some(a.max(*b)),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formulas_have_the_value_of_their_expression() {
        let at = |text: &str, y: f64| (formula("cell.v", text).unwrap().value)(y);
        assert_eq!(at("0.01 + 0.05*abs(y)", -2.0), 0.01 + 0.05 * 2.0);
        assert_eq!(at("sqrt(0.5^2 + (cell.v/10)^2)", 5.0), (0.25f64 + 0.25).sqrt());
        assert_eq!(at("max(1e-3, -y)", 1.0), 1e-3);
    }

    #[test]
    fn what_is_not_a_formula_of_the_output_is_refused() {
        for text in ["sigam", "0.1*x", "0.1 +", "sin(y)", "{1, 2}", ""] {
            let fault = formula("y", text).unwrap_err();
            assert!(fault.message.contains("neither a column"), "{text}: {}", fault.message);
        }
        assert!(positive("y", 0.0).is_err() && positive("y", f64::NAN).is_err());
    }
}
