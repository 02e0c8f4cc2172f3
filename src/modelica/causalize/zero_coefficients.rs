//! Parameters of zero that an unknown is multiplied with: a resistance of zero makes `R * i = u - v`
//! an equation between voltages, and its current follows from others.
//!
//! Where a linear loop has nothing but such coefficients in a row or a column of its matrix, the
//! system was sorted for resistances that are not zero and has no unique solution. It is sorted
//! again with these parameters as numbers, which then cannot be set without translating the model
//! again.

use super::causalized::{Block, CausalizedDae};
use crate::lower::{Dae, VariableKind};
use crate::symbolic::{Expr, Node, VarId};
use rustc_hash::{FxHashMap, FxHashSet};

/// Variables through which the value of a coefficient is followed.
const DEEPEST: usize = 20;

/// Parameters that the structure of a system takes as numbers.
pub(super) type ZeroCoefficients = FxHashSet<VarId>;

/// Makes parameters and those that they depend on numbers.
pub(super) fn evaluate(dae: &mut Dae, evaluated: &ZeroCoefficients) {
    let mut left: Vec<VarId> = evaluated.iter().copied().collect();
    left.sort_unstable();
    let mut seen = ZeroCoefficients::default();
    while let Some(parameter) = left.pop() {
        if !matches!(dae.variable(parameter).kind, VariableKind::Parameter { .. })
            || !seen.insert(parameter)
        {
            continue;
        }
        let variable = &mut dae.variables[parameter.0 as usize];
        variable.kind = VariableKind::Parameter { tunable: false };
        left.extend(variable.binding.iter().flat_map(|binding| dae.pool.variables(*binding)));
    }
}

/// The parameters of zero that leave nothing in a row or a column of the matrix of a linear loop.
pub(super) fn zero_coefficients(sorted: &mut CausalizedDae) -> ZeroCoefficients {
    let CausalizedDae { dae, blocks, event_blocks, initial_blocks, .. } = sorted;
    let mut found = ZeroCoefficients::default();
    for blocks in [blocks, event_blocks, initial_blocks] {
        let values = blocks.iter().filter_map(|block| match block {
            Block::Assignment(assignment) => Some((assignment.variable, assignment.value)),
            _ => None,
        });
        let values = values.collect();
        let mut zeros = Zeros { dae: &mut *dae, values, known: FxHashMap::default() };
        for block in blocks.iter() {
            if let Some(matrix) = matrix(zeros.dae, block) {
                found.extend(zeros.of_lines(&matrix));
            }
        }
    }
    found
}

/// The entries of the matrix of a linear loop, by rows.
fn matrix(dae: &Dae, block: &Block) -> Option<Vec<Expr>> {
    let Block::Linear(solved) = block else { return None };
    let unknown = solved.unknowns.first()?;
    let assignment = solved.assignments.iter().find(|a| a.variable == *unknown)?;
    match *dae.pool.node(assignment.value) {
        Node::Solution { matrix, .. } => Some(dae.pool.entries(matrix).to_vec()),
        _ => None,
    }
}

/// Finds out which expressions parameters of zero make zero.
struct Zeros<'a> {
    dae: &'a mut Dae,
    /// What variables are assigned.
    values: FxHashMap<VarId, Expr>,
    known: FxHashMap<VarId, Option<ZeroCoefficients>>,
}

impl Zeros<'_> {
    /// The parameters that make all of a row or of a column zero.
    fn of_lines(&mut self, matrix: &[Expr]) -> ZeroCoefficients {
        let causes: Vec<Option<ZeroCoefficients>> =
            matrix.iter().map(|e| self.cause(*e, 0)).collect();
        let n = matrix.len().isqrt();
        let mut found = ZeroCoefficients::default();
        for line in 0..n {
            let row: Option<Vec<&ZeroCoefficients>> =
                (0..n).map(|i| causes[line * n + i].as_ref()).collect();
            let column = (0..n).map(|i| causes[i * n + line].as_ref()).collect();
            for causes in [row, column].into_iter().flatten() {
                found.extend(causes.into_iter().flatten());
            }
        }
        found
    }

    /// The parameters that make an expression zero; `None` if it is not zero.
    fn cause(&mut self, e: Expr, depth: usize) -> Option<ZeroCoefficients> {
        let mut causes = ZeroCoefficients::default();
        let mut replaced: FxHashMap<Expr, Expr> = FxHashMap::default();
        let mut fixed: FxHashSet<Expr> = FxHashSet::default();
        let zero = self.dae.pool.constant(0.0);
        for node in self.dae.pool.reachable(&[e]) {
            let known = self.dae.pool.node(node).clone();
            let mut is_fixed = !matches!(known, Node::Variable(_) | Node::List(_));
            known.for_each_operand(|operand| is_fixed &= fixed.contains(&operand));
            let cause = match known {
                Node::Variable(v) if self.is_parameter(v) => {
                    is_fixed = true;
                    self.zero_parameters(node)
                }
                Node::Variable(v) => self.cause_of(v, depth),
                // What parameters alone give, such as `1 - k`.
                _ if is_fixed => self.zero_parameters(node),
                _ => None,
            };
            if is_fixed {
                fixed.insert(node);
            }
            let value = match cause {
                Some(own) => {
                    causes.extend(own);
                    zero
                }
                None => self.dae.pool.rebuild(&known, |operand| replaced[&operand]),
            };
            replaced.insert(node, value);
        }
        (self.dae.pool.as_constant(replaced[&e]) == Some(0.0)).then_some(causes)
    }

    fn is_parameter(&self, variable: VarId) -> bool {
        matches!(self.dae.variable(variable).kind, VariableKind::Parameter { .. })
    }

    /// The parameters of an expression of nothing else that is zero; `None` if it is not.
    fn zero_parameters(&self, e: Expr) -> Option<ZeroCoefficients> {
        let parameters = self.dae.pool.variables(e);
        let is_zero = !parameters.is_empty() && self.dae.defaults.of(self.dae, e) == 0.0;
        is_zero.then(|| parameters.into_iter().collect())
    }

    /// The same for a variable that is not a parameter.
    fn cause_of(&mut self, variable: VarId, depth: usize) -> Option<ZeroCoefficients> {
        if let Some(known) = self.known.get(&variable) {
            return known.clone();
        }
        let value = self.values.get(&variable).copied().filter(|_| depth < DEEPEST)?;
        self.known.insert(variable, None);
        let cause = self.cause(value, depth + 1);
        self.known.insert(variable, cause.clone());
        cause
    }
}
