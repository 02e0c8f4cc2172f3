//! Partial derivatives of the functions of the table for any number: those of the table, evaluated.

use super::elementary::Elementary;
use super::number::Number;
use super::operation::Operator;
use crate::symbolic::function;
use crate::symbolic::{Expr, Node, Pool, VarId};
use rustc_hash::FxHashMap;
use std::sync::LazyLock;

/// Largest number of steps of a derivative.
const MOST_STEPS: usize = 24;

/// A partial derivative: each step computes a number from those before, the last is the result.
struct Partial(Vec<Step>);

/// A step of a partial derivative; operands are positions of steps.
enum Step {
    Constant(f64),
    Argument(usize),
    Operation(Operator, usize, usize),
    If(usize, usize, usize),
}

/// The partial derivatives of every function.
static PARTIALS: LazyLock<Vec<Vec<Partial>>> = LazyLock::new(|| {
    let all = |function: &'static function::Function| {
        (0..function.arity()).map(|which| Partial::new(function, which)).collect()
    };
    function::functions().map(|(_, function)| all(function)).collect()
});

/// The partial derivative of a function for an argument (from 0).
pub(super) fn partial<T: Number>(function: &Elementary, which: usize, arguments: &[T]) -> T {
    PARTIALS[function.id.index()][which].of(arguments)
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
