//! Differentiates the equations that constrain states, until the highest derivatives can be solved
//! for.
//!
//! [`graph::differentiate_equations`](crate::graph::differentiate_equations) says which equations
//! and how often; here the symbolic derivatives are made and the states chosen. A system whose
//! states are free stays as it is.
//!
//! Discrete variables are constant between events: their derivatives are zero, and equations that
//! define them are never differentiated.
//!
//! Reference: [Pantelides 1988](gapilib_base::bibliography#pantelides-1988).

use super::causalized::Alias;
use super::dummy_derivatives::{Chains, ChosenStates, choose_states, highest_blocks};
use super::preferred_states::joined;
use super::{blt, singularity};
use crate::diag::Diagnostic;
use crate::fault;
use crate::flatten::{BaseType, Variability};
use crate::graph::{Bipartite, differentiate_equations, match_equations};
use crate::lower::{Dae, Equation, Variable, VariableKind, derivative_of};
use crate::symbolic::{Expr, Node, Pool, VarId, differentiate, differentiate_forward};
use rustc_hash::FxHashMap;

/// Appends differentiated equations and the derivatives they need; returns the states, chosen with
/// regard to those that are preferred and were not differentiated.
pub(super) fn reduce_index(
    dae: &mut Dae,
    aliases: &mut Vec<Option<Alias>>,
    preferred: &[VarId],
) -> Result<ChosenStates, Diagnostic> {
    let states = differentiated_variables(dae, aliases);
    if is_regular(dae, aliases, &states) {
        return Ok(ChosenStates { states, selections: Vec::new() });
    }
    let rows = continuous_equations(dae);
    let mut system = Continuous::new(dae, aliases, rows);
    let graph = system.graph(dae);
    let differentiated = match differentiate_equations(&graph, &system.var_to_derivative) {
        Ok(differentiated) => differentiated,
        Err(_) => return Err(system.singular(dae)),
    };
    if !preferred.is_empty() {
        let numbered = system.equations.iter().zip(&differentiated.eq_to_derivative);
        let constraints = numbered.filter(|(_, derivative)| derivative.is_some());
        constraints.map(|(e, _)| dae.equations[*e]).try_for_each(|e| refuse_jumps(dae, e))?;
    }
    let given = system.var_to_derivative.len();
    system.var_to_derivative = differentiated.var_to_derivative;
    system.declare_derivatives(dae, given);
    system.differentiate(dae, &differentiated.eq_to_derivative)?;
    let chains = Chains {
        equations: system.equations,
        variables: system.variables,
        eq_to_derivative: differentiated.eq_to_derivative,
        var_to_derivative: system.var_to_derivative,
        negated: system.negated,
        var_to_equation: differentiated.var_to_equation,
    };
    let blocks = joined(dae, &chains, highest_blocks(dae, &chains), preferred);
    let chosen = choose_states(dae, &chains, blocks)?;
    aliases.resize(dae.variables.len(), None);
    Ok(chosen)
}

/// A constraint with what changes at events may jump there: a state that is chosen by it would stay
/// continuous, and the one that its author differentiates would jump. Functions of whole numbers
/// are taken for continuous, as the density of a medium by the number of its phases.
fn refuse_jumps(dae: &Dae, equation: Equation) -> Result<(), Diagnostic> {
    let changes = |e: Expr, is_argument: bool| {
        let Some(variable) = dae.pool.as_variable(e).map(|v| dae.variable(v)) else { return false };
        match variable.kind {
            VariableKind::Discrete | VariableKind::Previous(_) => {
                !is_argument || variable.base == BaseType::Real
            }
            kind => matches!(kind, VariableKind::Frozen | VariableKind::Signal),
        }
    };
    let sides = [equation.left, equation.right];
    let mut jumps = sides.iter().any(|side| changes(*side, false));
    for node in dae.pool.reachable(&sides) {
        let node = dae.pool.node(node);
        let is_call = matches!(node, Node::Call { .. } | Node::CallDerivative { .. });
        node.for_each_operand(|operand| jumps |= changes(operand, is_call));
    }
    match jumps {
        false => Ok(()),
        true => {
            let words = "a preferred state is constrained by an equation that may jump at events";
            Err(fault!(crate::lower::errors::STATE_SELECT, "{words}").at(equation.span))
        }
    }
}

/// Whether `variable` is one, and `value` does not depend on it.
fn defines(pool: &Pool, variable: Expr, value: Expr) -> bool {
    match *pool.node(variable) {
        Node::Variable(variable) => !pool.any_variable(value, |v| v == variable),
        _ => false,
    }
}

/// Variables whose derivatives occur in the equations.
fn differentiated_variables(dae: &Dae, aliases: &[Option<Alias>]) -> Vec<VarId> {
    let mut states: Vec<VarId> = dae
        .variables
        .iter()
        .filter_map(|v| match v.kind {
            VariableKind::Derivative(of) if aliases[of.0 as usize].is_none() => Some(of),
            _ => None,
        })
        .collect();
    states.sort_unstable();
    states.dedup();
    states
}

/// All variables to be solved for where these are the states.
pub(super) fn unknowns(dae: &Dae, aliases: &[Option<Alias>], states: &[VarId]) -> Vec<VarId> {
    (0..dae.variables.len() as u32)
        .map(VarId)
        .filter(|v| dae.is_unknown(*v) && aliases[v.0 as usize].is_none())
        .filter(|v| states.binary_search(v).is_err())
        .collect()
}

/// Whether every equation determines a variable with all states given.
fn is_regular(dae: &Dae, aliases: &[Option<Alias>], states: &[VarId]) -> bool {
    let unknowns = unknowns(dae, aliases, states);
    let graph = blt::incidence(dae, &dae.equations, &unknowns);
    match_equations(&graph).equation_to_unknown.iter().all(Option::is_some)
}

fn is_continuous(variable: &Variable) -> bool {
    variable.base == BaseType::Real && variable.variability == Variability::Continuous
}

/// Equations that do not define discrete variables.
fn continuous_equations(dae: &Dae) -> Vec<usize> {
    let defines_discrete = |equation: &Equation| {
        [equation.left, equation.right].iter().any(|side| {
            let variable = dae.pool.as_variable(*side);
            variable.is_some_and(|v| dae.is_unknown(v) && !is_continuous(dae.variable(v)))
        })
    };
    let numbered = dae.equations.iter().enumerate();
    numbered.filter(|(_, e)| !defines_discrete(e)).map(|(number, _)| number).collect()
}

/// The continuous part of a system; equations and variables are numbered by their place here.
struct Continuous {
    /// Numbers of the equations in the system.
    equations: Vec<usize>,
    variables: Vec<VarId>,
    var_to_derivative: Vec<Option<usize>>,
    /// Whether the derivative is the variable's opposite.
    negated: Vec<bool>,
}

impl Continuous {
    fn new(dae: &mut Dae, aliases: &mut [Option<Alias>], equations: Vec<usize>) -> Continuous {
        let variables: Vec<VarId> = (0..dae.variables.len() as u32)
            .map(VarId)
            .filter(|v| dae.is_unknown(*v) && is_continuous(dae.variable(*v)))
            .collect();
        let mut system =
            Continuous { equations, variables, var_to_derivative: Vec::new(), negated: Vec::new() };
        system.link(dae, aliases);
        system
    }

    /// Finds the derivative of every variable. Where it is an alias of a variable that is the
    /// derivative of another one already, or that the variable is derived from, the alias becomes
    /// an equation again: every variable has one chain of derivatives.
    fn link(&mut self, dae: &mut Dae, aliases: &mut [Option<Alias>]) {
        let mut next: FxHashMap<VarId, (VarId, bool)> = FxHashMap::default();
        let mut taken: FxHashMap<VarId, VarId> = FxHashMap::default();
        for derivative in self.variables.clone() {
            let VariableKind::Derivative(of) = dae.variable(derivative).kind else { continue };
            if aliases[of.0 as usize].is_some() {
                continue;
            }
            let mut target = (derivative, false);
            if let Some(alias) = aliases[derivative.0 as usize] {
                let mut last = alias.of;
                while let Some((further, _)) = next.get(&last) {
                    last = *further;
                }
                if taken.contains_key(&alias.of) || last == of {
                    aliases[derivative.0 as usize] = None;
                    let (left, mut right) =
                        (dae.pool.variable(derivative), dae.pool.variable(alias.of));
                    if alias.negated {
                        right = dae.pool.neg(right);
                    }
                    self.equations.push(dae.equations.len());
                    let span = dae.variable(of).span;
                    dae.equations.push(Equation::new(left, right, span));
                } else {
                    target = (alias.of, alias.negated);
                }
            }
            next.insert(of, target);
            taken.insert(target.0, of);
        }
        self.variables.retain(|v| aliases[v.0 as usize].is_none());
        let column = self.columns();
        for variable in &self.variables {
            let link = next.get(variable);
            self.var_to_derivative.push(link.map(|(derivative, _)| column[derivative]));
            self.negated.push(link.is_some_and(|(_, negated)| *negated));
        }
    }

    fn columns(&self) -> FxHashMap<VarId, usize> {
        self.variables.iter().enumerate().map(|(column, v)| (*v, column)).collect()
    }

    fn graph(&self, dae: &Dae) -> Bipartite {
        let equations: Vec<Equation> = self.equations.iter().map(|e| dae.equations[*e]).collect();
        blt::incidence(dae, &equations, &self.variables)
    }

    /// The derivatives that came on top of those given, as variables of the system.
    fn declare_derivatives(&mut self, dae: &mut Dae, given: usize) {
        let mut origins = vec![0; self.var_to_derivative.len()];
        for (variable, derivative) in self.var_to_derivative.iter().enumerate() {
            if let Some(derivative) = derivative {
                origins[*derivative] = variable;
            }
        }
        for origin in &origins[given..] {
            let of = self.variables[*origin];
            self.variables.push(VarId(dae.variables.len() as u32));
            self.negated.push(false);
            let derivative = derivative_of(dae.variable(of), of);
            dae.variables.push(derivative);
        }
    }

    /// Appends the derivatives of equations.
    fn differentiate(
        &mut self,
        dae: &mut Dae,
        eq_to_derivative: &[Option<usize>],
    ) -> Result<(), Diagnostic> {
        let one = dae.pool.constant(1.0);
        let mut derivatives: FxHashMap<VarId, Expr> = FxHashMap::from_iter([(VarId(0), one)]);
        for (column, derivative) in self.var_to_derivative.iter().enumerate() {
            let Some(derivative) = derivative else { continue };
            let mut value = dae.pool.variable(self.variables[*derivative]);
            if self.negated[column] {
                value = dae.pool.neg(value);
            }
            derivatives.insert(self.variables[column], value);
        }
        let mut origins = vec![0; eq_to_derivative.len()];
        for (equation, derivative) in eq_to_derivative.iter().enumerate() {
            if let Some(derivative) = derivative {
                origins[*derivative] = equation;
            }
        }
        for origin in &origins[self.equations.len()..] {
            let equation = dae.equations[self.equations[*origin]];
            let Equation { left, right, span, .. } = equation;
            let delayed = |v: VarId| dae.variable(v).kind == VariableKind::Delayed;
            if [left, right].iter().any(|side| dae.pool.any_variable(*side, delayed)) {
                return Err(fault!(
                    crate::lower::errors::NOT_SUPPORTED,
                    "this equation constrains states (index reduction), but its delayed \
                     expression cannot be differentiated"
                )
                .at(span));
            }
            let seed = |v: VarId| derivatives.get(&v).copied();
            // What defines a variable keeps its value at zeros of norms; where the derivatives in a
            // norm are what is solved for, the equation stays linear in them.
            let of_side =
                |pool: &mut Pool, side: Expr, other: Expr| match defines(pool, other, side) {
                    true => differentiate_forward(pool, side, &seed),
                    false => differentiate(pool, side, &seed),
                };
            let sides = [(left, right), (right, left)];
            let [left, right] = sides.map(|(side, other)| of_side(&mut dae.pool, side, other));
            self.equations.push(dae.equations.len());
            dae.equations.push(Equation { left, right, ..equation });
        }
        Ok(())
    }

    /// The report of a system that no differentiation makes regular: every derivative stands for
    /// the variable it comes from.
    fn singular(&self, dae: &Dae) -> Diagnostic {
        let mut origin: Vec<usize> = (0..self.variables.len()).collect();
        let mut is_derivative = vec![false; self.variables.len()];
        self.var_to_derivative.iter().flatten().for_each(|d| is_derivative[*d] = true);
        let mut unknowns = Vec::new();
        for first in (0..self.variables.len()).filter(|v| !is_derivative[*v]) {
            let mut variable = Some(first);
            while let Some(column) = variable {
                origin[column] = unknowns.len();
                variable = self.var_to_derivative[column];
            }
            unknowns.push(self.variables[first]);
        }
        let full = self.graph(dae);
        let row = |e: usize| full.unknowns(e).iter().map(|v| origin[*v]).collect::<Vec<_>>();
        let graph = Bipartite::new(unknowns.len(), (0..full.n_equations()).map(row));
        let equations: Vec<Equation> = self.equations.iter().map(|e| dae.equations[*e]).collect();
        singularity::report(
            dae,
            &format!("`{}`", dae.name),
            &equations,
            &unknowns,
            &graph,
            &match_equations(&graph),
        )
    }
}
