//! `a = b` and `a = -b`: one variable of every alias set stays, the others become names for it.
//!
//! Where two variables with derivatives are one, so are their derivatives: this reduces the index of
//! rigid connections without differentiating anything.

use super::causalized::Alias;
use crate::lower::{Dae, Equation, Variable, VariableKind};
use crate::source::Span;
use crate::symbolic::{Expr, Node, Pool, Substitution, VarId};
use rustc_hash::{FxHashMap, FxHashSet};

/// Removes alias equations; returns every variable's representative.
pub(super) fn eliminate_aliases(dae: &mut Dae) -> Vec<Option<Alias>> {
    let mut sets = Sets::new(dae);
    let equations = std::mem::take(&mut dae.equations);
    let mut kept = Vec::with_capacity(equations.len());
    for equation in equations {
        match alias(&dae.pool, equation) {
            Some((a, b, negated))
                if dae.is_solved_for(a)
                    && dae.is_solved_for(b)
                    && (dae.variable(a).base == dae.variable(b).base)
                    && sets.join(a.0, b.0, negated, equation.span) => {}
            _ => kept.push(equation),
        }
    }
    for (zero, span) in std::mem::take(&mut sets.zeros) {
        let (left, right) = (dae.pool.variable(VarId(zero)), dae.pool.constant(0.0));
        kept.push(Equation::new(left, right, span));
    }
    dae.equations = kept;
    let aliases: Vec<Option<Alias>> = (0..dae.variables.len() as u32)
        .map(|v| match sets.root(v) {
            (root, _) if root == v => None,
            (root, negated) => Some(Alias { of: VarId(root), negated }),
        })
        .collect();
    merge_attributes(dae, &aliases);
    rewrite(dae, &aliases);
    aliases
}

/// `a = b` or `a = -b` in any form.
pub(super) fn alias(pool: &Pool, equation: Equation) -> Option<(VarId, VarId, bool)> {
    let side = |e: Expr| match pool.node(e) {
        Node::Variable(v) => Some((*v, false)),
        Node::Neg(inner) => pool.as_variable(*inner).map(|v| (v, true)),
        _ => None,
    };
    let zero = |e: Expr| pool.as_constant(e) == Some(0.0);
    let sum = |e: Expr| match pool.node(e) {
        Node::Add(a, b) => Some((side(*a)?, side(*b)?, true)),
        Node::Sub(a, b) => Some((side(*a)?, side(*b)?, false)),
        _ => None,
    };
    let ((a, minus_a), (b, minus_b), opposite) = if zero(equation.left) {
        sum(equation.right)?
    } else if zero(equation.right) {
        sum(equation.left)?
    } else {
        (side(equation.left)?, side(equation.right)?, false)
    };
    (a != b).then_some((a, b, minus_a ^ minus_b ^ opposite))
}

/// What `pre` of a discrete variable is at the start.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Memory {
    start: Option<Expr>,
    fixed: bool,
    /// Whether an initial equation has `pre` of this variable, such as `pre(u) = false`.
    given: bool,
}

/// Start values of `pre` of discrete variables.
fn memories(dae: &Dae) -> Vec<Option<Memory>> {
    let sides = dae.initial_equations.iter().flat_map(|e| [e.left, e.right]);
    let initial: FxHashSet<VarId> = sides.flat_map(|e| dae.pool.variables(e)).collect();
    let mut memory = vec![None; dae.variables.len()];
    for (position, variable) in (0..).zip(&dae.variables) {
        if let VariableKind::Previous(of) = variable.kind {
            let &Variable { start, fixed, kind, .. } = dae.variable(of);
            let given = initial.contains(&VarId(position));
            let remembers = kind == VariableKind::Discrete;
            memory[of.0 as usize] = remembers.then_some(Memory { start, fixed, given });
        }
    }
    memory
}

/// Disjoint sets with signs.
struct Sets {
    parent: Vec<(u32, bool)>,
    /// A variable that is the derivative of every root.
    derivative: Vec<Option<u32>>,
    /// Whether the variable is discrete.
    discrete: Vec<bool>,
    /// Whether an equation of the events determines it.
    assigned: Vec<bool>,
    /// Start value of `pre` of a discrete variable, and whether it is fixed; `None` without `pre`.
    memory: Vec<Option<Memory>>,
    /// Variables found to be equal to their opposites, and the equation that says so.
    zeros: Vec<(u32, Span)>,
}

impl Sets {
    fn new(dae: &Dae) -> Sets {
        let mut derivative = vec![None; dae.variables.len()];
        for (position, variable) in dae.variables.iter().enumerate() {
            if let VariableKind::Derivative(of) = variable.kind {
                derivative[of.0 as usize] = Some(position as u32);
            }
        }
        let parent = (0..dae.variables.len() as u32).map(|v| (v, false)).collect();
        let discrete = dae.variables.iter().map(|v| v.kind == VariableKind::Discrete).collect();
        let mut assigned = vec![false; dae.variables.len()];
        for variable in dae.events.equations.iter().filter_map(|e| dae.pool.as_variable(e.left)) {
            assigned[variable.0 as usize] = true;
        }
        let memory = memories(dae);
        Sets { parent, derivative, discrete, assigned, memory, zeros: Vec::new() }
    }

    fn root(&mut self, v: u32) -> (u32, bool) {
        let mut path = Vec::new();
        let mut current = v;
        while self.parent[current as usize].0 != current {
            path.push(current);
            current = self.parent[current as usize].0;
        }
        let mut sign = false;
        for node in path.into_iter().rev() {
            sign ^= self.parent[node as usize].1;
            self.parent[node as usize] = (current, sign);
        }
        (current, sign)
    }

    /// A discrete variable is not a state, and two equations at events determine two variables. The
    /// fixed start of one, and what initial equations say of `pre` of it, hold for its own `pre`
    /// (MLS §8.6), not for that of another.
    fn must_stay_apart(&self, a: usize, b: usize, negated: bool) -> bool {
        if let (Some(one), Some(other)) = (self.memory[a], self.memory[b])
            && (one.given
                || other.given
                || ((one.fixed || other.fixed) && (one != other || negated)))
        {
            return true;
        }
        (self.discrete[a] && self.derivative[b].is_some())
            || (self.discrete[b] && self.derivative[a].is_some())
            || (self.assigned[a] && self.assigned[b])
    }

    /// Joins the sets of two variables, and with them those of their derivatives; `false` if they
    /// were one already or must stay apart. The better representative stays: a discrete variable,
    /// then one with a derivative, then the one declared first.
    fn join(&mut self, a: u32, b: u32, negated: bool, span: Span) -> bool {
        let (root_a, root_b) = (self.root(a).0, self.root(b).0);
        if root_a == root_b || self.must_stay_apart(root_a as usize, root_b as usize, negated) {
            return false;
        }
        let mut pending = vec![(a, b, negated)];
        while let Some((a, b, negated)) = pending.pop() {
            let ((a, sign_a), (b, sign_b)) = (self.root(a), self.root(b));
            let negated = negated ^ sign_a ^ sign_b;
            if a == b {
                if negated {
                    self.zeros.push((a, span));
                }
                continue;
            }
            let rank = |v: u32| {
                let at = v as usize;
                (!self.assigned[at], !self.discrete[at], self.derivative[at].is_none(), v)
            };
            let (keep, drop) = if rank(a) <= rank(b) { (a, b) } else { (b, a) };
            self.parent[drop as usize] = (keep, negated);
            self.memory[keep as usize] = self.memory[keep as usize].or(self.memory[drop as usize]);
            if let (Some(x), Some(y)) =
                (self.derivative[keep as usize], self.derivative[drop as usize])
            {
                pending.push((x, y, negated));
            }
        }
        true
    }
}

/// Attributes of a dropped name hold for the variable that stays where it has none; a start value
/// that is fixed goes before one that is not, and a second fixed one becomes an initial equation.
fn merge_attributes(dae: &mut Dae, aliases: &[Option<Alias>]) {
    let memory = memories(dae);
    for (position, alias) in aliases.iter().enumerate() {
        let Some(alias) = alias else { continue };
        let &Variable { start, mut fixed, nominal, state_select, span, .. } =
            &dae.variables[position];
        // Without a `pre` of its own, nothing has this value.
        fixed &= memory[alias.of.0 as usize].is_none() || memory[position].is_some();
        let start = start.map(|e| if alias.negated { dae.pool.neg(e) } else { e });
        let kept = &mut dae.variables[alias.of.0 as usize];
        kept.nominal = kept.nominal.or(nominal);
        kept.state_select = kept.state_select.merged_with(state_select);
        if fixed && kept.fixed && start != kept.start {
            let (left, zero) = (dae.pool.variable(alias.of), dae.pool.constant(0.0));
            dae.initial_equations.push(Equation::new(left, start.unwrap_or(zero), span));
            continue;
        }
        if (start.is_some() && kept.start.is_none()) || (fixed && !kept.fixed) {
            kept.start = start;
        }
        kept.fixed |= fixed;
    }
}

fn rewrite(dae: &mut Dae, aliases: &[Option<Alias>]) {
    let mut replacements: Vec<Option<Expr>> = aliases
        .iter()
        .map(|alias| {
            let alias = (*alias)?;
            let kept = dae.pool.variable(alias.of);
            Some(if alias.negated { dae.pool.neg(kept) } else { kept })
        })
        .collect();
    rename_previous(dae, aliases, &mut replacements);
    let pool = &mut dae.pool;
    let replacement = |v: VarId| replacements[v.0 as usize];
    let mut substitution = Substitution::new(&replacement);
    let mut replace = |e: &mut Expr| *e = substitution.apply(pool, *e);
    for equation in dae.equations.iter_mut().chain(&mut dae.initial_equations) {
        replace(&mut equation.left);
        replace(&mut equation.right);
    }
    dae.assertions.iter_mut().for_each(|assertion| assertion.for_each_expression(&mut replace));
    for relation in &mut dae.relations {
        replace(&mut relation.left);
        replace(&mut relation.right);
    }
    dae.events.for_each_expression(replace);
}

/// `pre` of a name that was dropped is `pre` of the variable that stays.
fn rename_previous(dae: &mut Dae, aliases: &[Option<Alias>], replacements: &mut [Option<Expr>]) {
    let mut previous: FxHashMap<VarId, VarId> = FxHashMap::default();
    for position in 0..dae.variables.len() {
        if let VariableKind::Previous(of) = dae.variables[position].kind
            && aliases[of.0 as usize].is_none()
        {
            previous.insert(of, VarId(position as u32));
        }
    }
    for (position, replacement) in replacements.iter_mut().enumerate() {
        let VariableKind::Previous(of) = dae.variables[position].kind else { continue };
        let Some(alias) = aliases[of.0 as usize] else { continue };
        let own = VarId(position as u32);
        let kept = *previous.entry(alias.of).or_insert(own);
        let variable = &mut dae.variables[position];
        variable.kind =
            if kept == own { VariableKind::Previous(alias.of) } else { VariableKind::Signal };
        let value = dae.pool.variable(kept);
        *replacement = Some(if alias.negated { dae.pool.neg(value) } else { value });
    }
}
