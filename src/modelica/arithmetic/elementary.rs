//! The functions of the table of [`symbolic`](crate::symbolic::function) for any number: their
//! derivatives are those of the table, evaluated.

use super::number::Number;
use crate::symbolic::function::{self, FunctionId, Value};
use crate::symbolic::{Expr, Node, Pool, VarId};
use rustc_hash::FxHashMap;
use std::sync::LazyLock;

/// Largest number of nodes of a derivative.
const MAX_NODES: usize = 24;

/// A function of one or two arguments with its derivatives.
pub struct Elementary {
    /// Which function it is.
    pub id: FunctionId,
    /// How its value is computed.
    pub value: Value,
    partials: Vec<Partial>,
}

impl PartialEq for Elementary {
    fn eq(&self, other: &Elementary) -> bool {
        self.id == other.id
    }
}

impl Eq for Elementary {}

impl std::hash::Hash for Elementary {
    fn hash<H: std::hash::Hasher>(&self, state: &mut H) {
        self.id.hash(state);
    }
}

impl std::fmt::Debug for Elementary {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Elementary").field("name", &self.id.get().name).finish_non_exhaustive()
    }
}

/// A partial derivative: nodes in order, the last is the result.
struct Partial {
    nodes: Vec<Node>,
    /// Where the operand of a node, an [`Expr`] of the pool it came from, is in `nodes`.
    positions: Vec<u8>,
}

/// A function in a file: its number in the table.
pub(super) mod by_number {
    use super::{Elementary, FunctionId};
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    pub fn serialize<S: Serializer>(
        function: &&'static Elementary,
        target: S,
    ) -> Result<S::Ok, S::Error> {
        function.id.serialize(target)
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(
        source: D,
    ) -> Result<&'static Elementary, D::Error> {
        FunctionId::deserialize(source).map(Elementary::of)
    }
}

static TABLE: LazyLock<FxHashMap<FunctionId, Elementary>> = LazyLock::new(|| {
    function::functions()
        .map(|(id, function)| {
            let partials =
                (0..function.arity()).map(|which| Partial::new(function, which)).collect();
            (id, Elementary { id, value: function.value, partials })
        })
        .collect()
});

static LOGARITHM: LazyLock<&'static Elementary> = LazyLock::new(|| {
    Elementary::of(function::find("log").expect("the function table has a logarithm"))
});

impl Elementary {
    /// The function of this number.
    pub fn of(id: FunctionId) -> &'static Elementary {
        &TABLE[&id]
    }

    /// The natural logarithm.
    pub(super) fn logarithm() -> &'static Elementary {
        *LOGARITHM
    }

    /// The partial derivative for an argument (from 0).
    pub(super) fn partial<T: Number>(&self, which: usize, arguments: &[T]) -> T {
        self.partials[which].of(arguments)
    }
}

impl Partial {
    fn new(function: &function::Function, which: usize) -> Partial {
        let mut pool = Pool::new();
        let arguments: Vec<Expr> =
            (0..function.arity() as u32).map(|at| pool.variable(VarId(at))).collect();
        let root = (function.derivative)(&mut pool, &arguments, which);
        let order = pool.reachable(&[root]);
        assert!(order.len() <= MAX_NODES, "derivatives of the table are small");
        let mut positions = vec![0; pool.len()];
        for (position, expr) in (0u8..).zip(&order) {
            positions[expr.index()] = position;
        }
        let nodes = order.iter().map(|expr| pool.node(*expr).clone()).collect();
        Partial { nodes, positions }
    }

    fn of<T: Number>(&self, arguments: &[T]) -> T {
        let truth = |holds: bool| T::constant(f64::from(u8::from(holds)));
        let mut values = [T::constant(0.0); MAX_NODES];
        for (position, node) in self.nodes.iter().enumerate() {
            let get = |operand: &Expr| values[self.positions[operand.index()] as usize];
            values[position] = match node {
                Node::Constant(number) => T::constant(number.0),
                Node::Variable(variable) => arguments[variable.0 as usize],
                Node::Neg(a) => get(a).neg(),
                Node::Add(a, b) => get(a).add(get(b)),
                Node::Sub(a, b) => get(a).sub(get(b)),
                Node::Mul(a, b) => get(a).mul(get(b)),
                Node::Div(a, b) => get(a).div(get(b)),
                Node::Pow(a, b) => get(a).pow(get(b)),
                Node::Apply(id, list) => match list.second() {
                    None => get(&list.first()).unary(Elementary::of(*id)),
                    Some(b) => get(&list.first()).binary(get(&b), Elementary::of(*id)),
                },
                Node::If(condition, a, b) => {
                    if get(condition).value() != 0.0 {
                        get(a)
                    } else {
                        get(b)
                    }
                }
                Node::Relation(operator, a, b) => {
                    truth(operator.holds(get(a).value(), get(b).value()))
                }
                Node::And(a, b) => truth(get(a).value() != 0.0 && get(b).value() != 0.0),
                Node::Or(a, b) => truth(get(a).value() != 0.0 || get(b).value() != 0.0),
                Node::Not(a) => truth(get(a).value() == 0.0),
                Node::Call { .. }
                | Node::CallDerivative { .. }
                | Node::List(_)
                | Node::Solution { .. } => {
                    unreachable!("functions of the table call nothing and solve nothing")
                }
            };
        }
        values[self.nodes.len() - 1]
    }
}
