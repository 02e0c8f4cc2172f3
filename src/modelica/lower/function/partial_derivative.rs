//! Calls of `function f_x = der(f, x)` (MLS §12.7.2): the function is inlined, and the resulting
//! expressions are differentiated.

use crate::diag::Diagnostic;
use crate::eval::Function;
use crate::fault;
use crate::lower::build::scalar_of_nothing;
use crate::lower::builder::Builder;
use crate::lower::dae::{Dae, VariableKind};
use crate::lower::errors::{ARRAY_MISMATCH, UNRESOLVED_REFERENCE};
use crate::lower::expressions::{Array, FunctionCalls, Lowered};
use crate::name::{Ident, Name};
use crate::source::Span;
use crate::symbolic::{Expr, VarId, derivative, substitute};
use std::sync::Arc;

/// The partial derivatives of the outputs of `of` by inputs, one after the other.
pub(super) fn call(
    builder: &mut Builder<'_>,
    function: &Arc<Function>,
    (of, by): (&Name, &[Ident]),
    mut arguments: Vec<Lowered<Expr>>,
    span: Span,
) -> Result<Vec<Lowered<Expr>>, Diagnostic> {
    let Some(target) = FunctionCalls::function(builder, of) else {
        return Err(fault!(UNRESOLVED_REFERENCE, "there is no function `{of}`").at(span));
    };
    // What the inputs are, and the variables that stand for them while they vary.
    let mut given: Vec<(Ident, VarId, Expr)> = Vec::new();
    for (input, argument) in function.inputs.iter().zip(&mut arguments) {
        if !by.contains(&input.name) {
            continue;
        }
        let Lowered::Array(Array { dims, elements }) = argument else { continue };
        let (true, [value]) = (dims.is_empty(), elements.as_mut_slice()) else {
            return Err(fault!(ARRAY_MISMATCH, "`{}` must be a scalar", input.name).at(span));
        };
        let name = format!("$partial[{}]", builder.dae.variables.len());
        let variable =
            builder.dae.declare_variable(scalar_of_nothing(&name, VariableKind::Signal, span));
        given.push((input.name, variable, *value));
        *value = builder.dae.pool.variable(variable);
    }
    let asserted = builder.dae.assertions.len();
    let results = FunctionCalls::call(builder, &target, arguments, span)?;
    let actual = |v: VarId| given.iter().find(|(_, own, _)| *own == v).map(|(.., value)| *value);
    let Dae { assertions, pool, .. } = &mut builder.dae;
    for assertion in &mut assertions[asserted..] {
        assertion.for_each_expression(|e| *e = substitute(pool, *e, &actual));
    }
    let differentiated = |e: Expr, builder: &mut Builder<'_>| {
        let pool = &mut builder.dae.pool;
        let variables = by.iter().filter_map(|by| given.iter().find(|(name, ..)| name == by));
        let result = variables.fold(e, |e, (_, variable, _)| derivative(pool, e, *variable));
        substitute(pool, result, &actual)
    };
    let array = |result| match result {
        Lowered::Array(Array { dims, elements }) => {
            let elements = elements.into_iter().map(|e| differentiated(e, builder)).collect();
            Ok(Lowered::Array(Array { dims, elements }))
        }
        _ => Err(fault!(ARRAY_MISMATCH, "`{}` must have Real outputs", function.name).at(span)),
    };
    results.into_iter().map(array).collect()
}
