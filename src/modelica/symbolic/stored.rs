//! Expressions from files: a file may have been damaged, so that every number of a variable and of a
//! node is checked when it is read.
//!
//! A pool also has nodes of auxiliary variables that only the generator of code knew; no expression
//! outside of the pool leads to them.

use super::node::{Expr, Inverse, Node, VarId};
use super::pool::Pool;
use rustc_hash::FxHashMap;
use serde::de::Error;
use serde::{Deserialize, Deserializer};
use std::cell::RefCell;

thread_local! {
    static KNOWN: RefCell<Known> = const { RefCell::new(Known { variables: u32::MAX, nodes: None }) };
}

/// What can be referred to in the file that is being read.
struct Known {
    variables: u32,
    /// For every node of the pool whether it leads to known variables alone; `None` until the pool has
    /// been read.
    nodes: Option<Vec<bool>>,
}

/// Reads something with so many variables, and one pool before all other expressions.
pub(crate) fn reading_variables<T>(variables: u32, read: impl FnOnce() -> T) -> T {
    let former = KNOWN.replace(Known { variables, nodes: None });
    let result = read();
    KNOWN.set(former);
    result
}

impl<'de> Deserialize<'de> for VarId {
    fn deserialize<D: Deserializer<'de>>(source: D) -> Result<VarId, D::Error> {
        let variable = u32::deserialize(source)?;
        match KNOWN.with_borrow(|known| variable < known.variables) {
            true => Ok(VarId(variable)),
            false => Err(D::Error::custom("there are fewer variables")),
        }
    }
}

/// A variable of a node, which may be an auxiliary one.
pub(super) fn read_any_variable<'de, D: Deserializer<'de>>(source: D) -> Result<VarId, D::Error> {
    u32::deserialize(source).map(VarId)
}

impl<'de> Deserialize<'de> for Expr {
    fn deserialize<D: Deserializer<'de>>(source: D) -> Result<Expr, D::Error> {
        let node = u32::deserialize(source)?;
        let is_known = KNOWN.with_borrow(|known| match &known.nodes {
            Some(nodes) => nodes.get(node as usize).copied().unwrap_or(false),
            None => true,
        });
        match is_known {
            true => Ok(Expr(node)),
            false => Err(D::Error::custom("there is no such expression")),
        }
    }
}

/// Numbers by matrices, in whose entries auxiliary variables may be.
pub(crate) fn read_by_matrix<'de, D: Deserializer<'de>>(
    source: D,
) -> Result<FxHashMap<Expr, u32>, D::Error> {
    let read = FxHashMap::<u32, u32>::deserialize(source)?;
    Ok(read.into_iter().map(|(matrix, number)| (Expr(matrix), number)).collect())
}

impl<'de> Deserialize<'de> for Pool {
    fn deserialize<D: Deserializer<'de>>(source: D) -> Result<Pool, D::Error> {
        #[derive(Deserialize)]
        struct Stored {
            nodes: Vec<Node>,
            inverses: FxHashMap<(u32, u32), Inverse>,
        }
        let Stored { nodes, inverses } = Stored::deserialize(source)?;
        if !(0..nodes.len()).all(|at| has_valid_operands(&nodes, at)) {
            return Err(D::Error::custom("an operand does not fit"));
        }
        let known = leading_to_known_variables(&nodes);
        KNOWN.with_borrow_mut(|places| places.nodes = Some(known));
        let number = nodes.len();
        let pool = Pool { nodes: nodes.into_iter().collect(), inverses };
        match pool.len() == number {
            true => Ok(pool),
            false => Err(D::Error::custom("a node is there twice")),
        }
    }
}

impl Pool {
    /// Whether all calls are those of functions with so many inputs and outputs.
    pub(crate) fn has_valid_calls(&self, sizes: impl Fn(u32) -> Option<(u32, u32)>) -> bool {
        let fits = |function: u32, output: u32, arguments: Expr| {
            sizes(function).is_some_and(|(n_inputs, n_outputs)| {
                output < n_outputs && self.entries(arguments).len() >= n_inputs as usize
            })
        };
        let is_valid = |node: &Node| match node {
            Node::Call { function, output, arguments }
            | Node::CallDerivative { function, output, arguments, .. } => {
                fits(*function, *output, *arguments)
            }
            _ => true,
        };
        self.nodes.iter().all(is_valid)
    }
}

/// Whether the operands of a node precede it, and are lists where lists are needed.
fn has_valid_operands(nodes: &[Node], at: usize) -> bool {
    let entries = |e: Expr| match nodes.get(e.index()) {
        Some(Node::List(entries)) => Some(&entries[..]),
        _ => None,
    };
    let node = &nodes[at];
    let takes_lists = match node {
        Node::Call { .. } | Node::CallDerivative { .. } | Node::Solution { .. } => true,
        Node::Apply(id, arguments) if id.get().arity() != arguments.iter().count() => return false,
        _ => false,
    };
    let mut all_fit = true;
    node.for_each_operand(|e| {
        all_fit &= e.index() < at && entries(e).is_some() == takes_lists;
    });
    all_fit
        && match node {
            Node::Solution { matrix, right, output, .. } => {
                let n = entries(*right).map_or(0, <[Expr]>::len);
                let has_rows = entries(*matrix).map(<[Expr]>::len) == n.checked_mul(n);
                has_rows && (*output as usize) < n
            }
            _ => true,
        }
}

fn leading_to_known_variables(nodes: &[Node]) -> Vec<bool> {
    let variables = KNOWN.with_borrow(|known| known.variables);
    let mut known: Vec<bool> = Vec::with_capacity(nodes.len());
    for node in nodes {
        let mut is_known = !matches!(node, Node::Variable(variable) if variable.0 >= variables);
        node.for_each_operand(|e| is_known &= known[e.index()]);
        known.push(is_known);
    }
    known
}
