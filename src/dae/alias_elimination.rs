//! `a = b` and `a = -b`: one variable of every alias set stays, the others become names for it.

use super::model::{Dae, Equation, Kind};
use super::sorted::Alias;
use crate::symbolic::{Expr, Node, Pool, VarId, substitute};
use rustc_hash::FxHashMap;

/// Removes alias equations; returns every variable's representative.
pub(super) fn eliminate_aliases(dae: &mut Dae) -> Vec<Option<Alias>> {
    let mut sets = Sets { parent: (0..dae.variables.len() as u32).map(|v| (v, false)).collect() };
    let equations = std::mem::take(&mut dae.equations);
    let mut kept = Vec::with_capacity(equations.len());
    for equation in equations {
        match alias(&dae.pool, equation) {
            Some((a, b, negated))
                if dae.is_solved_for(a)
                    && dae.is_solved_for(b)
                    && (dae.variable(a).base == dae.variable(b).base)
                    && sets.join(dae, a, b, negated) => {}
            _ => kept.push(equation),
        }
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
fn alias(pool: &Pool, equation: Equation) -> Option<(VarId, VarId, bool)> {
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

/// Disjoint sets with signs.
struct Sets {
    parent: Vec<(u32, bool)>,
}

impl Sets {
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

    /// Joins two sets; `false` if they were one already. The better representative stays: a
    /// variable that is discrete, then one with a derivative, then the one declared first.
    fn join(&mut self, dae: &Dae, a: VarId, b: VarId, negated: bool) -> bool {
        let ((a, sign_a), (b, sign_b)) = (self.root(a.0), self.root(b.0));
        if a == b {
            return false;
        }
        let is_discrete = |v: u32| dae.variable(VarId(v)).kind == Kind::Discrete;
        let rank = |v: u32| (!is_discrete(v), !has_derivative(dae, VarId(v)), v);
        let (keep, drop) = if rank(a) <= rank(b) { (a, b) } else { (b, a) };
        // Two states in one set would need index reduction: the equation stays and is reported.
        // Two equations at events for one variable are reported as such.
        if has_derivative(dae, VarId(drop)) || is_discrete(drop) && assigned_at_events(dae, drop) {
            return false;
        }
        self.parent[drop as usize] = (keep, negated ^ sign_a ^ sign_b);
        true
    }
}

/// Whether an equation of the events determines a variable.
fn assigned_at_events(dae: &Dae, v: u32) -> bool {
    dae.events.equations.iter().any(|e| dae.pool.as_variable(e.left) == Some(VarId(v)))
}

fn has_derivative(dae: &Dae, v: VarId) -> bool {
    dae.variables.iter().rev().any(|d| d.kind == Kind::Derivative(v))
}

/// Start, fixed, nominal of a dropped name hold for the variable that stays where it has none.
fn merge_attributes(dae: &mut Dae, aliases: &[Option<Alias>]) {
    for (position, alias) in aliases.iter().enumerate() {
        let Some(alias) = alias else { continue };
        let (start, fixed, nominal) = {
            let dropped = &dae.variables[position];
            (dropped.start, dropped.fixed, dropped.nominal)
        };
        let start = start.map(|e| if alias.negated { dae.pool.neg(e) } else { e });
        let kept = &mut dae.variables[alias.of.0 as usize];
        if (start.is_some() && kept.start.is_none()) || (fixed && !kept.fixed) {
            kept.start = start;
        }
        kept.fixed |= fixed;
        kept.nominal = kept.nominal.or(nominal);
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
    let mut replace = |e: &mut Expr| {
        *e = substitute(pool, *e, &|v| replacements[v.0 as usize]);
    };
    for equation in dae.equations.iter_mut().chain(&mut dae.initial_equations) {
        replace(&mut equation.left);
        replace(&mut equation.right);
    }
    dae.assertions.iter_mut().for_each(|assertion| replace(&mut assertion.condition));
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
        if let Kind::Previous(of) = dae.variables[position].kind
            && aliases[of.0 as usize].is_none()
        {
            previous.insert(of, VarId(position as u32));
        }
    }
    for (position, replacement) in replacements.iter_mut().enumerate() {
        let Kind::Previous(of) = dae.variables[position].kind else { continue };
        let Some(alias) = aliases[of.0 as usize] else { continue };
        let own = VarId(position as u32);
        let kept = *previous.entry(alias.of).or_insert(own);
        let variable = &mut dae.variables[position];
        variable.kind = if kept == own { Kind::Previous(alias.of) } else { Kind::Signal };
        let value = dae.pool.variable(kept);
        *replacement = Some(if alias.negated { dae.pool.neg(value) } else { value });
    }
}
