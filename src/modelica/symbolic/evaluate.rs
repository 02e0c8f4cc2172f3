//! Values of expressions, node by node: the oracle for compiled code.

use super::node::{Expr, Node, VarId};
use super::pool::Pool;
use crate::elementary;
use rustc_hash::FxHashMap;

/// Gives values to variables and calls.
pub trait Environment {
    /// The value of a variable.
    fn variable(&self, variable: VarId) -> f64;

    /// A scalar output of a user function, or its partial derivative for `inputs`.
    fn call(&self, function: u32, output: u32, inputs: &[u32], arguments: &[f64]) -> f64;
}

/// The value of variable i stands at position i. There are no user functions: a call has no value
/// (NaN).
impl Environment for [f64] {
    fn variable(&self, variable: VarId) -> f64 {
        self[variable.0 as usize]
    }

    fn call(&self, _: u32, _: u32, _: &[u32], _: &[f64]) -> f64 {
        f64::NAN
    }
}

/// The value of an expression; NaN or infinite where it has none. Both branches of an
/// if-expression are computed.
pub fn evaluate<E: Environment + ?Sized>(pool: &Pool, expr: Expr, environment: &E) -> f64 {
    let mut values: FxHashMap<Expr, f64> = FxHashMap::default();
    for node in pool.reachable(&[expr]) {
        let get = |operand: Expr| values[&operand];
        let values_of =
            |list: Expr| -> Vec<f64> { pool.entries(list).iter().map(|e| get(*e)).collect() };
        let value = match pool.node(node) {
            Node::List(_) => f64::NAN,
            Node::Solution { matrix, right, output, .. } => {
                solve_linear(values_of(*matrix), values_of(*right))[*output as usize]
            }
            Node::Call { function, output, arguments } => {
                environment.call(*function, *output, &[], &values_of(*arguments))
            }
            Node::CallDerivative { function, output, inputs, arguments } => {
                environment.call(*function, *output, inputs, &values_of(*arguments))
            }
            other => node_value(other, environment, get),
        };
        values.insert(node, value);
    }
    values[&expr]
}

fn node_value<E: Environment + ?Sized>(
    node: &Node,
    environment: &E,
    get: impl Fn(Expr) -> f64,
) -> f64 {
    let number = |truth: bool| f64::from(u8::from(truth));
    match node {
        Node::Constant(value) => value.0,
        Node::Variable(variable) => environment.variable(*variable),
        Node::Neg(a) => -get(*a),
        Node::Add(a, b) => get(*a) + get(*b),
        Node::Sub(a, b) => get(*a) - get(*b),
        Node::Mul(a, b) => get(*a) * get(*b),
        Node::Div(a, b) => get(*a) / get(*b),
        Node::Pow(a, b) => elementary::powf(get(*a), get(*b)),
        Node::Apply(id, arguments) => match arguments.second() {
            None => id.get().value.of(&[get(arguments.first())]),
            Some(second) => id.get().value.of(&[get(arguments.first()), get(second)]),
        },
        Node::If(condition, a, b) => get(if get(*condition) != 0.0 { *a } else { *b }),
        Node::Relation(operator, a, b) => number(operator.holds(get(*a), get(*b))),
        Node::And(a, b) => number(get(*a) != 0.0 && get(*b) != 0.0),
        Node::Or(a, b) => number(get(*a) != 0.0 || get(*b) != 0.0),
        Node::Not(a) => number(get(*a) == 0.0),
        Node::Call { .. } | Node::CallDerivative { .. } | Node::List(_) | Node::Solution { .. } => {
            unreachable!("what has lists is evaluated with the pool")
        }
    }
}

/// The solution of A x = b by elimination with row exchanges, A by rows; without a finite value
/// where A is singular.
fn solve_linear(mut a: Vec<f64>, mut b: Vec<f64>) -> Vec<f64> {
    let n = b.len();
    for k in 0..n {
        let largest = (k..n).max_by(|i, j| a[i * n + k].abs().total_cmp(&a[j * n + k].abs()));
        let pivot = largest.unwrap_or(k);
        (0..n).for_each(|column| a.swap(k * n + column, pivot * n + column));
        b.swap(k, pivot);
        for row in (0..n).filter(|row| *row != k) {
            let factor = a[row * n + k] / a[k * n + k];
            (k..n).for_each(|column| a[row * n + column] -= factor * a[k * n + column]);
            b[row] -= factor * b[k];
        }
    }
    (0..n).map(|k| b[k] / a[k * n + k]).collect()
}
