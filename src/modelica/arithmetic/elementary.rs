//! The functions of the table of [`symbolic`](crate::symbolic::function) for any number: their
//! derivatives are those of the table, evaluated.

use super::number::Number;
use super::operation::Operator;
use crate::symbolic::function::{self, FunctionId, Value};
use crate::symbolic::{Expr, Node, Pool, VarId};
use rustc_hash::FxHashMap;
use std::sync::LazyLock;

/// Largest number of steps of a derivative.
const MOST_STEPS: usize = 24;

/// A function of one or two arguments.
pub struct Elementary {
    /// Which function it is.
    pub id: FunctionId,
    /// How its value is computed.
    pub value: Value,
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

/// A partial derivative: each step computes a number from those before, the last is the result.
struct Partial(Vec<Step>);

/// A step of a partial derivative; operands are positions of steps.
enum Step {
    Constant(f64),
    Argument(usize),
    Operation(Operator, usize, usize),
    If(usize, usize, usize),
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

static TABLE: LazyLock<Vec<Elementary>> = LazyLock::new(|| {
    function::functions().map(|(id, function)| Elementary { id, value: function.value }).collect()
});

/// The partial derivatives of every function.
static PARTIALS: LazyLock<Vec<Vec<Partial>>> = LazyLock::new(|| {
    let all = |function: &'static function::Function| {
        (0..function.arity()).map(|which| Partial::new(function, which)).collect()
    };
    function::functions().map(|(_, function)| all(function)).collect()
});

static LOGARITHM: LazyLock<&'static Elementary> = LazyLock::new(|| {
    Elementary::of(function::find("log").expect("the function table has a logarithm"))
});

impl Elementary {
    /// The function of this number.
    pub fn of(id: FunctionId) -> &'static Elementary {
        &TABLE[id.index()]
    }

    /// The natural logarithm.
    pub(super) fn logarithm() -> &'static Elementary {
        *LOGARITHM
    }

    /// The partial derivative for an argument (from 0).
    pub(super) fn partial<T: Number>(&self, which: usize, arguments: &[T]) -> T {
        PARTIALS[self.id.index()][which].of(arguments)
    }
}

impl Partial {
    fn new(function: &function::Function, which: usize) -> Partial {
        let mut pool = Pool::new();
        let arguments: Vec<Expr> =
            (0..function.arity() as u32).map(|at| pool.variable(VarId(at))).collect();
        let root = (function.derivative)(&mut pool, &arguments, which);
        let order = pool.reachable(&[root]);
        assert!(order.len() <= MOST_STEPS, "derivatives of the table are small");
        let positions: FxHashMap<Expr, usize> = order.iter().copied().zip(0..).collect();
        let step = |e: &Expr| match pool.node(*e) {
            Node::Constant(number) => Step::Constant(number.0),
            Node::Variable(variable) => Step::Argument(variable.0 as usize),
            Node::If(condition, a, b) => Step::If(positions[condition], positions[a], positions[b]),
            node => match Operator::of_node(node) {
                Some((operator, a, b)) => Step::Operation(operator, positions[&a], positions[&b]),
                None => unreachable!("functions of the table call nothing and solve nothing"),
            },
        };
        Partial(order.iter().map(step).collect())
    }

    fn of<T: Number>(&self, arguments: &[T]) -> T {
        let mut values = [T::constant(0.0); MOST_STEPS];
        for (at, step) in self.0.iter().enumerate() {
            values[at] = match *step {
                Step::Constant(value) => T::constant(value),
                Step::Argument(which) => arguments[which],
                Step::Operation(operator, a, b) => operator.of(values[a], values[b]),
                Step::If(condition, a, b) => match values[condition].value() != 0.0 {
                    true => values[a],
                    false => values[b],
                },
            };
        }
        values[self.0.len() - 1]
    }
}
