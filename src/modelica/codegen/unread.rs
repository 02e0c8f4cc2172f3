//! Variables that only results show: nothing else of the model reads them, and a division in their
//! values may have no result, as v = q/area in an empty pipe. They are computed where they are
//! observed, so that the simulation continues without them. A function outside its domain is an
//! error.

use crate::causalize::{Block, CausalizedDae};
use crate::lower::{Dae, VariableKind};
use crate::symbolic::{Expr, Node, Pool, VarId, VariableCollection};
use rustc_hash::FxHashSet;

/// These variables, ascending.
pub(super) fn unread(pool: &Pool, causalized: &CausalizedDae) -> Vec<VarId> {
    let mut read =
        Read { collection: VariableCollection::new(pool), variables: FxHashSet::default() };
    read.roots(&causalized.dae);
    read.sorted(causalized);
    let CausalizedDae { blocks, event_blocks, initial_blocks, .. } = causalized;
    let all: Vec<&Block> = [blocks, event_blocks, initial_blocks].into_iter().flatten().collect();
    all.iter().for_each(|block| read.loops(block));
    let assignments = || {
        let assignments = all.iter().filter(|block| matches!(block, Block::Assignment(_)));
        assignments.flat_map(|block| block.assignments())
    };
    let mut known = 0;
    while known < read.variables.len() {
        known = read.variables.len();
        for assignment in assignments().collect::<Vec<_>>().into_iter().rev() {
            if read.variables.contains(&assignment.variable) {
                read.add(assignment.value);
            }
        }
    }
    let mut found = FxHashSet::default();
    for assignment in assignments().filter(|a| !read.variables.contains(&a.variable)) {
        if pool.any_variable(assignment.value, |v| found.contains(&v))
            || may_fail(pool, assignment.value)
        {
            found.insert(assignment.variable);
        }
    }
    let mut found: Vec<VarId> = found.into_iter().collect();
    found.sort_unstable();
    found
}

/// Whether a division in an expression may have no result. Calls stay where they are: what functions
/// assert must hold.
fn may_fail(pool: &Pool, e: Expr) -> bool {
    let nodes = pool.reachable(&[e]);
    let has_call = |e: &Expr| matches!(pool.node(*e), Node::Call { .. });
    let fails = |e: &Expr| match pool.node(*e) {
        Node::Div(_, divisor) => pool.as_constant(*divisor).is_none(),
        _ => false,
    };
    !nodes.iter().any(has_call) && nodes.iter().any(fails)
}

/// The variables that something reads.
struct Read<'p> {
    collection: VariableCollection<'p>,
    variables: FxHashSet<VarId>,
}

impl Read<'_> {
    fn add(&mut self, e: Expr) {
        let variables = &mut self.variables;
        self.collection.add(e, |variable| {
            variables.insert(variable);
        });
    }

    /// What is read besides equations.
    fn roots(&mut self, dae: &Dae) {
        for (at, variable) in (0..).map(VarId).zip(&dae.variables) {
            match variable.kind {
                VariableKind::Previous(of) => self.variables.extend([at, of]),
                VariableKind::Unknown => {}
                _ => self.variables.extend([at]),
            }
        }
        for relation in &dae.relations {
            self.add(relation.left);
            self.add(relation.right);
        }
        for mut assertion in dae.assertions.clone() {
            assertion.for_each_expression(|e| self.add(*e));
        }
        dae.events.clone().for_each_expression(|e| self.add(*e));
    }

    fn sorted(&mut self, causalized: &CausalizedDae) {
        self.variables.extend(&causalized.states);
        self.variables.extend(&causalized.iterated);
        for check in &causalized.initial_checks {
            self.add(check.left);
            self.add(check.right);
        }
        for selection in &causalized.selections {
            self.variables.extend(selection.candidates.iter().chain(&selection.states));
            selection.jacobian.iter().flatten().for_each(|entry| self.add(*entry));
        }
    }

    /// What loops consist of.
    fn loops(&mut self, block: &Block) {
        match block {
            Block::Assignment(_) => {}
            Block::Linear(solved) => {
                self.variables.extend(&solved.unknowns);
                solved.residuals.iter().for_each(|(residual, _)| self.add(*residual));
            }
            Block::Loop(torn) => {
                self.variables.extend(&torn.iteration);
                torn.residuals.iter().for_each(|(residual, _)| self.add(*residual));
            }
        }
        if !matches!(block, Block::Assignment(_)) {
            for assignment in block.assignments() {
                self.variables.insert(assignment.variable);
                self.add(assignment.value);
            }
        }
    }
}
