//! Keeps every node once.

use super::function::{self, FunctionId};
use super::node::{Expr, Inverse, Node, Number, VarId};
use indexmap::IndexSet;
use rustc_hash::{FxBuildHasher, FxHashMap};
use std::cell::RefCell;

/// All nodes of all expressions of a model. The constructors ([`Pool::add`] …) simplify locally.
#[derive(Debug, Clone, Default, serde::Serialize)]
pub struct Pool {
    pub(super) nodes: IndexSet<Node, FxBuildHasher>,
    /// By function and input.
    pub(super) inverses: FxHashMap<(u32, u32), Inverse>,
}

impl Pool {
    /// An empty pool.
    pub fn new() -> Pool {
        Pool::default()
    }

    /// Lets equations be solved for an input of a user function.
    pub(crate) fn declare_inverse(&mut self, function: u32, input: u32, inverse: Inverse) {
        self.inverses.insert((function, input), inverse);
    }

    /// How equations are solved for an input of a user function.
    pub(super) fn inverse(&self, function: u32, input: u32) -> Option<&Inverse> {
        self.inverses.get(&(function, input))
    }

    /// Number of nodes.
    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Whether there are no nodes.
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// The node of an expression of this pool.
    pub fn node(&self, expr: Expr) -> &Node {
        &self.nodes[expr.index()]
    }

    /// The number, if the expression is one.
    pub fn as_constant(&self, expr: Expr) -> Option<f64> {
        match self.node(expr) {
            Node::Constant(number) => Some(number.0),
            _ => None,
        }
    }

    /// The variable, if the expression is one.
    pub(crate) fn as_variable(&self, expr: Expr) -> Option<VarId> {
        match self.node(expr) {
            Node::Variable(variable) => Some(*variable),
            _ => None,
        }
    }

    /// The entries of a list.
    ///
    /// # Panics
    /// If the expression is none.
    pub fn entries(&self, list: Expr) -> &[Expr] {
        match self.node(list) {
            Node::List(entries) => entries,
            _ => panic!("only lists have entries"),
        }
    }

    /// A number.
    pub fn constant(&mut self, value: f64) -> Expr {
        self.intern(Node::Constant(Number(value)))
    }

    /// The numbers 1 and 0.
    pub fn boolean(&mut self, value: bool) -> Expr {
        self.constant(f64::from(u8::from(value)))
    }

    /// A variable.
    pub fn variable(&mut self, variable: VarId) -> Expr {
        self.intern(Node::Variable(variable))
    }

    /// A function of the table by its name.
    ///
    /// # Panics
    /// If the table has no such name, or another number of arguments: for names written in this
    /// program; names that users write go through [`function::find`].
    pub fn function(&mut self, name: &str, arguments: &[Expr]) -> Expr {
        let id: FunctionId = function::find(name).expect("the name is in the function table");
        self.apply(id, arguments)
    }

    /// The id of a node that is taken as it is.
    pub(super) fn intern(&mut self, node: Node) -> Expr {
        let (index, _) = self.nodes.insert_full(node);
        Expr(u32::try_from(index).expect("a pool holds fewer than 2^32 nodes"))
    }

    /// The id of a node of a commutative operator: operands swapped if that node exists already.
    pub(super) fn intern_commutative(
        &mut self,
        make: fn(Expr, Expr) -> Node,
        a: Expr,
        b: Expr,
    ) -> Expr {
        match self.nodes.get_index_of(&make(b, a)) {
            Some(index) => Expr(index as u32),
            None => self.intern(make(a, b)),
        }
    }

    /// All nodes that the roots are made of, each once, operands before their nodes.
    pub fn reachable(&self, roots: &[Expr]) -> Vec<Expr> {
        let mut found = Vec::new();
        self.visit(roots, |expr| found.push(expr));
        found.sort_unstable();
        found
    }

    /// Those of [`Pool::reachable`] that are not known, nor reached through what is known alone.
    pub(super) fn reachable_unless(
        &self,
        roots: &[Expr],
        is_known: impl Fn(Expr) -> bool,
    ) -> Vec<Expr> {
        let mut found = Vec::new();
        self.visit_while(roots, |expr| {
            if is_known(expr) {
                return Next::Operands { from: usize::MAX };
            }
            found.push(expr);
            Next::Operands { from: 0 }
        });
        found.sort_unstable();
        found
    }

    /// Those of [`Pool::reachable`] that may contain a variable: all but nodes older than it, as
    /// operands precede their nodes.
    pub(super) fn reachable_with(&self, roots: &[Expr], variable: VarId) -> Vec<Expr> {
        let mut found = Vec::new();
        if let Some(from) = self.nodes.get_index_of(&Node::Variable(variable)) {
            let roots: Vec<Expr> = roots.iter().copied().filter(|e| e.index() >= from).collect();
            self.visit_while(&roots, |expr| {
                found.push(expr);
                Next::Operands { from }
            });
        }
        found.sort_unstable();
        found
    }

    /// The variables that an expression is made of, ascending.
    pub fn variables(&self, expr: Expr) -> Vec<VarId> {
        let mut variables = Vec::new();
        self.visit(&[expr], |expr| variables.extend(self.as_variable(expr)));
        variables.sort_unstable();
        variables
    }

    /// The variables that expressions divide by, each by itself.
    pub(crate) fn divisors(&self, roots: &[Expr]) -> Vec<VarId> {
        let mut divisors = Vec::new();
        self.visit(roots, |expr| {
            if let Node::Div(_, divisor) = self.node(expr) {
                divisors.extend(self.as_variable(*divisor));
            }
        });
        divisors
    }

    /// Visits the variables that some expressions are made of, each once, in no certain order.
    pub(crate) fn visit_variables(&self, exprs: &[Expr], mut found: impl FnMut(VarId)) {
        self.visit(exprs, |expr| {
            if let Some(variable) = self.as_variable(expr) {
                found(variable);
            }
        });
    }

    /// Whether an expression contains one of the variables that `is_sought` tells.
    pub(crate) fn any_variable(&self, expr: Expr, is_sought: impl Fn(VarId) -> bool) -> bool {
        let mut found = false;
        self.visit_while(&[expr], |expr| {
            found = self.as_variable(expr).is_some_and(&is_sought);
            if found { Next::Stop } else { Next::Operands { from: 0 } }
        });
        found
    }

    /// Whether an expression contains a variable.
    pub(crate) fn depends_on(&self, expr: Expr, variable: VarId) -> bool {
        let Some(sought) = self.nodes.get_index_of(&Node::Variable(variable)) else { return false };
        let mut found = false;
        self.visit_while(&[expr], |expr| {
            found |= expr.index() == sought;
            if found { Next::Stop } else { Next::Operands { from: sought } }
        });
        found
    }

    /// Visits all nodes that the roots are made of, each once.
    fn visit(&self, roots: &[Expr], mut visit: impl FnMut(Expr)) {
        self.visit_while(roots, |expr| {
            visit(expr);
            Next::Operands { from: 0 }
        });
    }

    fn visit_while(&self, roots: &[Expr], mut visit: impl FnMut(Expr) -> Next) {
        VISITS.with_borrow_mut(|visits| {
            let this = visits.begin(self.len());
            let Visits { last, stack, .. } = visits;
            stack.clear();
            stack.extend_from_slice(roots);
            while let Some(expr) = stack.pop() {
                if std::mem::replace(&mut last[expr.index()], this) == this {
                    continue;
                }
                match visit(expr) {
                    Next::Stop => break,
                    Next::Operands { from } => self.node(expr).for_each_operand(|operand| {
                        if operand.index() >= from && last[operand.index()] != this {
                            stack.push(operand);
                        }
                    }),
                }
            }
        });
    }
}

/// Where a visit continues.
enum Next {
    /// With the operands whose ids are not less.
    Operands {
        from: usize,
    },
    Stop,
}

/// The variables of one expression after another; what they share is looked through once.
pub(crate) struct VariableCollection<'a> {
    pool: &'a Pool,
    seen: Vec<bool>,
    open: Vec<Expr>,
}

impl<'a> VariableCollection<'a> {
    /// Of no expression yet.
    pub(crate) fn new(pool: &'a Pool) -> VariableCollection<'a> {
        VariableCollection { pool, seen: vec![false; pool.len()], open: Vec::new() }
    }

    /// Tells the variables of an expression that it did not tell before.
    pub(crate) fn add(&mut self, expr: Expr, mut found: impl FnMut(VarId)) {
        self.open.push(expr);
        while let Some(expr) = self.open.pop() {
            if std::mem::replace(&mut self.seen[expr.index()], true) {
                continue;
            }
            if let Some(variable) = self.pool.as_variable(expr) {
                found(variable);
            }
            let (seen, open) = (&self.seen, &mut self.open);
            self.pool.node(expr).for_each_operand(|operand| {
                if !seen[operand.index()] {
                    open.push(operand);
                }
            });
        }
    }
}

/// Whether expressions contain leaves of some sort, each node looked at once.
pub(crate) struct Containing<F> {
    is_sought: F,
    marks: Vec<bool>,
}

impl<F: Fn(&Pool, Expr) -> bool> Containing<F> {
    /// `is_sought` says the same of a node at any time.
    pub(crate) fn new(is_sought: F) -> Containing<F> {
        Containing { is_sought, marks: Vec::new() }
    }

    /// Whether an expression is such a leaf, or made of one.
    pub(crate) fn contains(&mut self, pool: &Pool, expr: Expr) -> bool {
        for index in self.marks.len()..=expr.index() {
            let node = Expr(index as u32);
            let mut found = (self.is_sought)(pool, node);
            pool.node(node).for_each_operand(|operand| found |= self.marks[operand.index()]);
            self.marks.push(found);
        }
        self.marks[expr.index()]
    }
}

thread_local! {
    /// Kept from visit to visit: expressions are visited too often for a set made each time.
    static VISITS: RefCell<Visits> = RefCell::default();
}

/// The number of the last visit to each node, of whatever pool.
#[derive(Default)]
struct Visits {
    count: u32,
    last: Vec<u32>,
    stack: Vec<Expr>,
}

impl Visits {
    /// The number of a new visit to a pool of `len` nodes.
    fn begin(&mut self, len: usize) -> u32 {
        if self.last.len() < len {
            self.last.resize(len, 0);
        }
        self.count = self.count.checked_add(1).unwrap_or_else(|| {
            self.last.fill(0);
            1
        });
        self.count
    }
}
