//! Numbers that equations say that variables are, whatever parameters are set to: `h = 0`, `a = 2*h`.

use crate::lower::{Dae, Equation};
use crate::symbolic::{Expr, VarId, substitute};
use rustc_hash::FxHashMap;

/// Variables through which a value is followed.
const DEEPEST: usize = 20;

/// What is known of the variables of a system.
pub(super) struct Numbers {
    /// The other side of the equation that a variable makes a side of.
    given: FxHashMap<VarId, Expr>,
    /// Where the relation stands that a variable is the value of.
    relations: FxHashMap<VarId, usize>,
    known: FxHashMap<VarId, Option<f64>>,
}

impl Numbers {
    /// Those of a system as it is now.
    pub(super) fn of(dae: &Dae) -> Numbers {
        let mut given = FxHashMap::default();
        for Equation { left, right, .. } in &dae.equations {
            for (side, other) in [(*left, *right), (*right, *left)] {
                if let Some(v) = dae.pool.as_variable(side)
                    && dae.is_solved_for(v)
                    && !dae.pool.depends_on(other, v)
                {
                    given.entry(v).or_insert(other);
                }
            }
        }
        let relations = dae.relations.iter().enumerate().map(|(at, r)| (r.variable, at)).collect();
        Numbers { given, relations, known: FxHashMap::default() }
    }

    /// The number that an expression is.
    pub(super) fn value(&mut self, dae: &mut Dae, e: Expr) -> Option<f64> {
        self.value_below(dae, e, 0)
    }

    /// The number that a variable is.
    pub(super) fn value_of(&mut self, dae: &mut Dae, v: VarId) -> Option<f64> {
        self.value_of_below(dae, v, 0)
    }

    fn value_below(&mut self, dae: &mut Dae, e: Expr, depth: usize) -> Option<f64> {
        if let Some(value) = dae.pool.as_constant(e) {
            return Some(value);
        }
        let mut numbers: FxHashMap<VarId, Expr> = FxHashMap::default();
        for v in dae.pool.variables(e) {
            if let Some(value) = self.value_of_below(dae, v, depth) {
                numbers.insert(v, dae.pool.constant(value));
            }
        }
        let replaced = substitute(&mut dae.pool, e, &|v| numbers.get(&v).copied());
        dae.pool.as_constant(replaced)
    }

    fn value_of_below(&mut self, dae: &mut Dae, v: VarId, depth: usize) -> Option<f64> {
        if let Some(known) = self.known.get(&v) {
            return *known;
        }
        if depth >= DEEPEST {
            return None;
        }
        // What depends on itself has no known value.
        self.known.insert(v, None);
        let value = match (self.given.get(&v), self.relations.get(&v)) {
            (Some(other), _) => self.value_below(dae, *other, depth + 1),
            (None, Some(at)) => self.truth(dae, *at, depth + 1),
            (None, None) => None,
        };
        self.known.insert(v, value);
        value
    }

    fn truth(&mut self, dae: &mut Dae, relation: usize, depth: usize) -> Option<f64> {
        let relation = dae.relations[relation];
        let left = self.value_below(dae, relation.left, depth)?;
        let right = self.value_below(dae, relation.right, depth)?;
        Some(f64::from(u8::from(relation.operator.holds(left, right))))
    }
}
