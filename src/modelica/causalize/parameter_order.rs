//! The order in which parameters are computed.

use crate::diag::Diagnostic;
use crate::fault;
use crate::lower::errors::{PARAMETER_CYCLE, PARAMETER_WITHOUT_VALUE};
use crate::lower::{Dae, Equation, VariableKind};
use crate::symbolic::VarId;

/// Parameters, each after those its binding depends on. One without a binding takes its start
/// value; one without either, but used, is refused.
pub(super) fn order_parameters(dae: &mut Dae) -> Result<Vec<VarId>, Diagnostic> {
    let parameters: Vec<VarId> = (0..dae.variables.len() as u32)
        .map(VarId)
        .filter(|v| matches!(dae.variable(*v).kind, VariableKind::Parameter { .. }))
        .collect();
    for parameter in &parameters {
        let variable = dae.variable(*parameter);
        if variable.binding.is_none() {
            let Some(start) = variable.start else {
                return Err(fault!(PARAMETER_WITHOUT_VALUE, "the parameter `{}` has no value",
                    variable.name; help: "give it a value in its declaration or in a modification")
                .at(variable.span));
            };
            dae.warnings.push(
                fault!(
                    PARAMETER_WITHOUT_VALUE,
                    "the parameter `{}` has no value; its start value is used",
                    variable.name
                )
                .at(variable.span)
                .warning(),
            );
            dae.variables[parameter.0 as usize].binding = Some(start);
        }
    }
    let mut order = Order { dae, state: vec![0; dae.variables.len()], sorted: Vec::new() };
    for parameter in parameters {
        order.visit(parameter)?;
    }
    let sorted = order.sorted;
    Ok(without_solved(dae, sorted))
}

/// Parameters that depend on those of the initial system belong to it as well.
fn without_solved(dae: &mut Dae, sorted: Vec<VarId>) -> Vec<VarId> {
    let mut rest = Vec::with_capacity(sorted.len());
    for parameter in sorted {
        let variable = dae.variable(parameter);
        let (binding, span) = (variable.binding, variable.span);
        let uses = binding.map(|b| dae.pool.variables(b)).unwrap_or_default();
        match binding {
            Some(right) if uses.iter().any(|v| dae.variable(*v).kind == VariableKind::Solved) => {
                let left = dae.pool.variable(parameter);
                dae.initial_equations.push(Equation::new(left, right, span));
                let variable = &mut dae.variables[parameter.0 as usize];
                variable.kind = VariableKind::Solved;
                variable.binding = None;
            }
            _ => rest.push(parameter),
        }
    }
    rest
}

/// Depth first, with its own stack: chains of parameters may be long.
struct Order<'a> {
    dae: &'a Dae,
    state: Vec<u8>,
    sorted: Vec<VarId>,
}

impl Order<'_> {
    fn visit(&mut self, root: VarId) -> Result<(), Diagnostic> {
        let mut stack = vec![(root, false)];
        while let Some((v, finished)) = stack.pop() {
            let position = v.0 as usize;
            if finished {
                self.state[position] = 2;
                self.sorted.push(v);
                continue;
            }
            match self.state[position] {
                2 => continue,
                1 => {
                    let variable = self.dae.variable(v);
                    return Err(fault!(PARAMETER_CYCLE, "`{}` depends on itself", variable.name)
                        .at(variable.span));
                }
                _ => {}
            }
            self.state[position] = 1;
            stack.push((v, true));
            let binding = self.dae.variable(v).binding;
            for other in binding.map(|b| self.dae.pool.variables(b)).unwrap_or_default() {
                let kind = self.dae.variable(other).kind;
                if matches!(kind, VariableKind::Parameter { .. })
                    && self.state[other.0 as usize] != 2
                {
                    stack.push((other, false));
                }
            }
        }
        Ok(())
    }
}
