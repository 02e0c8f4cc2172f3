//! Exact derivatives through a sequence of assignments: forward accumulation, column by column,
//! on symbolic expressions.

use crate::causalize::Assignment;
use crate::symbolic::{Expr, Node, Pool, VarId, derivative, differentiate};
use rustc_hash::FxHashMap;
use std::collections::{BTreeMap, BTreeSet};

/// Assignments of derivatives and where each entry is found.
pub(crate) struct Differentiated {
    /// Every assignment of the sequence, followed by those of its derivatives.
    pub(crate) sequence: Vec<Assignment>,
    /// ∂output/∂column by output, columns ascending; zeros left out.
    pub(crate) rows: Vec<BTreeMap<usize, Expr>>,
}

/// Differentiates `outputs` for `columns` through a sequence; `next` numbers new variables.
pub(crate) fn differentiate_sequence(
    pool: &mut Pool,
    sequence: &[Assignment],
    outputs: &[Expr],
    columns: &[VarId],
    next: &mut u32,
) -> Differentiated {
    let one = pool.constant(1.0);
    let mut forward = Forward::new(pool, next);
    for (column, variable) in columns.iter().enumerate() {
        forward.seed(*variable, BTreeMap::from([(column, one)]));
    }
    let mut extended = Vec::new();
    for assignment in sequence {
        extended.push(*assignment);
        forward.assign(assignment, &mut extended);
    }
    let rows = outputs.iter().map(|output| forward.row(*output)).collect();
    Differentiated { sequence: extended, rows }
}

/// Derivatives of variables by columns, carried through assignments one after the other.
pub(super) struct Forward<'a> {
    pub(super) pool: &'a mut Pool,
    rows: FxHashMap<VarId, BTreeMap<usize, Expr>>,
    solved: Solved,
    next: &'a mut u32,
}

impl<'a> Forward<'a> {
    /// Where every variable has derivatives of zero; `next` numbers new variables.
    pub(super) fn new(pool: &'a mut Pool, next: &'a mut u32) -> Forward<'a> {
        Forward { pool, rows: FxHashMap::default(), solved: Solved::default(), next }
    }

    /// Gives the derivatives of a variable by column; those left out are zero.
    pub(super) fn seed(&mut self, variable: VarId, row: BTreeMap<usize, Expr>) {
        self.rows.insert(variable, row);
        // What was found of linear systems may depend on it.
        self.solved.clear();
    }

    /// The derivatives of the variable that is assigned; assignments of new variables, which hold
    /// them, are added to `extended`.
    pub(super) fn assign(&mut self, assignment: &Assignment, extended: &mut Vec<Assignment>) {
        let value = assignment.value;
        let mut row = match *self.pool.node(value) {
            Node::Solution { matrix, right, output, .. } => {
                let (pool, rows) = (&mut *self.pool, &self.rows);
                let columns = self
                    .solved
                    .entry((matrix, right))
                    .or_insert_with(|| chain_by_column(pool, value, [matrix, right], rows));
                of_unknown(self.pool, columns, output)
            }
            _ => chain(self.pool, value, &self.rows),
        };
        self.name(&mut row, assignment.equation, extended);
        self.rows.insert(assignment.variable, row);
    }

    /// Gives names to derivatives that are more than a number or a variable.
    pub(super) fn name(
        &mut self,
        row: &mut BTreeMap<usize, Expr>,
        equation: usize,
        extended: &mut Vec<Assignment>,
    ) {
        for value in row.values_mut() {
            let simple =
                self.pool.as_constant(*value).is_some() || self.pool.as_variable(*value).is_some();
            if !simple {
                let variable = VarId(*self.next);
                *self.next += 1;
                extended.push(Assignment { variable, value: *value, equation });
                *value = self.pool.variable(variable);
            }
        }
    }

    /// The derivatives of an expression by column; zeros left out.
    pub(super) fn row(&mut self, e: Expr) -> BTreeMap<usize, Expr> {
        chain(self.pool, e, &self.rows)
    }

    /// The derivatives of a variable by column.
    pub(super) fn row_of(&self, variable: VarId) -> BTreeMap<usize, Expr> {
        self.rows.get(&variable).cloned().unwrap_or_default()
    }

    /// The derivative of a variable.
    pub(super) fn of(&self, variable: VarId, column: usize) -> Option<Expr> {
        self.rows.get(&variable)?.get(&column).copied()
    }

    /// The expressions and the number of the next new variable.
    pub(super) fn parts(&mut self) -> (&mut Pool, &mut u32) {
        (self.pool, self.next)
    }
}

/// Jacobian entries of an unknown of linear systems by columns, by matrix and right side.
type Solved = FxHashMap<(Expr, Expr), BTreeMap<usize, Expr>>;

/// The Jacobian entries of another unknown of the same system.
fn of_unknown(
    pool: &mut Pool,
    columns: &BTreeMap<usize, Expr>,
    output: u32,
) -> BTreeMap<usize, Expr> {
    let entries = columns.iter();
    entries.map(|(column, entry)| (*column, pool.other_unknown(*entry, output))).collect()
}

/// Σ ∂e/∂w · ∂w/∂column over the variables w of e.
fn chain(
    pool: &mut Pool,
    e: Expr,
    derivatives: &FxHashMap<VarId, BTreeMap<usize, Expr>>,
) -> BTreeMap<usize, Expr> {
    let mut row: BTreeMap<usize, Expr> = BTreeMap::new();
    for variable in pool.variables(e) {
        let Some(inner) = derivatives.get(&variable).filter(|inner| !inner.is_empty()) else {
            continue;
        };
        let partial = derivative(pool, e, variable);
        for (column, entry) in inner {
            let product = pool.mul(partial, *entry);
            let sum = match row.get(column) {
                Some(before) => pool.add(*before, product),
                None => product,
            };
            row.insert(*column, sum);
        }
    }
    row.retain(|_, entry| pool.as_constant(*entry) != Some(0.0));
    row
}

/// The same for an unknown of a linear system, which depends on many variables: along every column
/// the system is differentiated once.
fn chain_by_column(
    pool: &mut Pool,
    e: Expr,
    system: [Expr; 2],
    derivatives: &FxHashMap<VarId, BTreeMap<usize, Expr>>,
) -> BTreeMap<usize, Expr> {
    let of = |v: VarId| derivatives.get(&v).into_iter().flat_map(|row| row.keys().copied());
    let variables = system.map(|list| pool.variables(list));
    let columns: BTreeSet<usize> = variables.iter().flatten().flat_map(|v| of(*v)).collect();
    let mut row = BTreeMap::new();
    for column in columns {
        let seed = |v: VarId| derivatives.get(&v).and_then(|row| row.get(&column)).copied();
        row.insert(column, differentiate(pool, e, &seed));
    }
    row.retain(|_, entry| pool.as_constant(*entry) != Some(0.0));
    row
}
