//! Expressions in models have the values that they have in scripts.

use super::builder::Builder;
use super::expressions::{Lowered, Lowering};
use crate::eval::tests::inference::{expressions, value_of};
use crate::flatten::FlatModel;
use crate::source::SourceId;
use crate::symbolic::Expr;
use crate::syntax::parse_expression;
use crate::value::Value;

/// The sizes and numbers of a value; `None` of Strings and records.
fn numbers(value: &Value) -> Option<(Vec<usize>, Vec<f64>)> {
    let number = |value: &Value| match value {
        Value::Boolean(truth) => Some(f64::from(u8::from(*truth))),
        other => other.as_real(),
    };
    match value {
        Value::Array(array) => {
            let elements = (0..array.elements.len()).map(|at| number(&array.elements.get(at)));
            Some((array.dims.clone(), elements.collect::<Option<_>>()?))
        }
        scalar => Some((Vec::new(), vec![number(scalar)?])),
    }
}

/// The same of what a model makes of an expression, where all of it is known.
fn constants(builder: &Builder<'_>, lowered: &Lowered<Expr>) -> Option<(Vec<usize>, Vec<f64>)> {
    let Lowered::Array(array) = lowered else { return None };
    let known = array.elements.iter().map(|element| builder.dae.pool.as_constant(*element));
    Some((array.dims.clone(), known.collect::<Option<_>>()?))
}

#[test]
fn models_compute_what_scripts_compute() {
    let flat = FlatModel::default();
    let (mut compared, mut wrong) = (0, Vec::new());
    for text in expressions() {
        let Ok(e) = parse_expression(SourceId::NONE, &text) else { continue };
        let Ok(value) = value_of(&e) else { continue };
        let mut builder = Builder::new(&flat);
        let Ok(lowered) = Lowering::new(&mut builder).lower(&e) else { continue };
        if let (Some(found), Some(expected)) = (constants(&builder, &lowered), numbers(&value)) {
            compared += 1;
            if found != expected {
                wrong.push(format!("{text}: {found:?} in a model, {expected:?} in a script"));
            }
        }
    }
    assert!(compared > 1000, "{compared}");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
