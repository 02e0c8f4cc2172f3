//! Derivatives by the rules of the operators and of the function table.
//!
//! Relations and logic have derivative zero, if-expressions are differentiated branch by branch:
//! the result holds wherever the expression is differentiable. [`differentiate_forward`] also holds
//! where the Euclidean norm of a vector is zero.

use super::function::FunctionId;
use super::node::{Arguments, Expr, Node, RelationOperator, VarId};
use super::pool::Pool;
use rustc_hash::FxHashMap;

/// ∂/∂`variable`.
pub fn derivative(pool: &mut Pool, expr: Expr, variable: VarId) -> Expr {
    let one = pool.constant(1.0);
    let nodes = pool.reachable_with(&[expr], variable);
    differentiate_nodes(pool, &nodes, &[expr], &|v| (v == variable).then_some(one))[0]
}

/// The total derivative Σ ∂/∂v · v′ where `seed` gives v′, `None` for zero. With v′ = dv/dt it is
/// d/dt.
pub fn differentiate(pool: &mut Pool, expr: Expr, seed: &dyn Fn(VarId) -> Option<Expr>) -> Expr {
    differentiate_all(pool, &[expr], seed)[0]
}

/// [`differentiate`] with one-sided derivatives of norms: where all `u` in `sqrt(u1^2 + u2^2)` are
/// zero, it grows by `sqrt(u1'^2 + u2'^2)` from there on, although its partial derivatives are 0/0.
/// That is not linear in the derivatives, as the other rules are.
pub(crate) fn differentiate_forward(
    pool: &mut Pool,
    expr: Expr,
    seed: &dyn Fn(VarId) -> Option<Expr>,
) -> Expr {
    let nodes = pool.reachable(&[expr]);
    let mut derivatives = Derivatives { is_forward: true, ..Derivatives::new(pool) };
    derivatives.fill(&nodes, seed);
    derivatives.get(expr).unwrap_or_else(|| derivatives.pool.constant(0.0))
}

/// [`differentiate`] for several expressions at once: what they share is differentiated once.
pub(crate) fn differentiate_all(
    pool: &mut Pool,
    exprs: &[Expr],
    seed: &dyn Fn(VarId) -> Option<Expr>,
) -> Vec<Expr> {
    let nodes = pool.reachable(exprs);
    differentiate_nodes(pool, &nodes, exprs, seed)
}

/// Derivatives of some expressions, of whose nodes only these, in ascending order, have others than
/// zero.
fn differentiate_nodes(
    pool: &mut Pool,
    nodes: &[Expr],
    exprs: &[Expr],
    seed: &dyn Fn(VarId) -> Option<Expr>,
) -> Vec<Expr> {
    let mut derivatives = Derivatives::new(pool);
    derivatives.fill(nodes, seed);
    let found: Vec<Option<Expr>> = exprs.iter().map(|expr| derivatives.get(*expr)).collect();
    let zero = pool.constant(0.0);
    found.into_iter().map(|derivative| derivative.unwrap_or(zero)).collect()
}

/// Derivatives of the nodes done so far; those that are zero are not kept.
struct Derivatives<'a> {
    pool: &'a mut Pool,
    /// Node and derivative, ascending.
    of: Vec<(Expr, Expr)>,
    /// The right sides of the derivatives of linear systems, `None` where these are zero.
    rights: FxHashMap<System, Option<Expr>>,
    /// Whether norms have one-sided derivatives where they are zero.
    is_forward: bool,
}

/// A linear system: matrix, right side, whether it is a derivative itself.
type System = (Expr, Expr, bool);

impl Derivatives<'_> {
    fn new(pool: &mut Pool) -> Derivatives<'_> {
        let (of, rights) = (Vec::new(), FxHashMap::default());
        Derivatives { pool, of, rights, is_forward: false }
    }

    /// The derivatives of nodes in ascending order.
    fn fill(&mut self, nodes: &[Expr], seed: &dyn Fn(VarId) -> Option<Expr>) {
        for &node in nodes {
            if let Some(derivative) = self.derivative_of(node, seed) {
                self.of.push((node, derivative));
            }
        }
    }

    fn derivative_of(&mut self, expr: Expr, seed: &dyn Fn(VarId) -> Option<Expr>) -> Option<Expr> {
        let derivative = match self.pool.node(expr).clone() {
            Node::Constant(_)
            | Node::Relation(..)
            | Node::And(..)
            | Node::Or(..)
            | Node::Not(_) => None,
            // Its entries are looked at where it is used.
            Node::List(_) => None,
            Node::Variable(variable) => seed(variable),
            Node::Neg(a) => self.get(a).map(|da| self.pool.neg(da)),
            Node::Add(a, b) => self.sum(a, b),
            Node::Sub(a, b) => self.difference(a, b),
            Node::Mul(a, b) => self.product(a, b),
            Node::Div(a, b) => self.quotient(expr, a, b),
            Node::Pow(a, b) => self.power(expr, a, b),
            Node::Apply(id, arguments) => self.application(id, arguments),
            Node::If(condition, a, b) => self.branches(condition, a, b),
            Node::Call { function, output, arguments } => {
                self.call(function, output, &[], arguments)
            }
            Node::CallDerivative { function, output, inputs, arguments } => {
                self.call(function, output, &inputs, arguments)
            }
            Node::Solution { matrix, right, output, is_derivative } => {
                self.solution((matrix, right, is_derivative), output)
            }
        };
        derivative.filter(|derivative| self.pool.as_constant(*derivative) != Some(0.0))
    }

    fn get(&self, expr: Expr) -> Option<Expr> {
        let at = self.of.binary_search_by_key(&expr, |(node, _)| *node).ok()?;
        Some(self.of[at].1)
    }

    fn sum(&mut self, a: Expr, b: Expr) -> Option<Expr> {
        match (self.get(a), self.get(b)) {
            (Some(da), Some(db)) => Some(self.pool.add(da, db)),
            (da, db) => da.or(db),
        }
    }

    fn difference(&mut self, a: Expr, b: Expr) -> Option<Expr> {
        match (self.get(a), self.get(b)) {
            (Some(da), Some(db)) => Some(self.pool.sub(da, db)),
            (da, None) => da,
            (None, Some(db)) => Some(self.pool.neg(db)),
        }
    }

    fn product(&mut self, a: Expr, b: Expr) -> Option<Expr> {
        let left = self.get(a).map(|da| self.pool.mul(da, b));
        let right = self.get(b).map(|db| self.pool.mul(a, db));
        self.total(left, right)
    }

    fn total(&mut self, left: Option<Expr>, right: Option<Expr>) -> Option<Expr> {
        match (left, right) {
            (Some(left), Some(right)) => Some(self.pool.add(left, right)),
            (left, right) => left.or(right),
        }
    }

    /// (a/b)′ = (a′ − (a/b) b′) / b
    fn quotient(&mut self, quotient: Expr, a: Expr, b: Expr) -> Option<Expr> {
        let from_divisor = self.get(b).map(|db| self.pool.mul(quotient, db));
        let numerator = match (self.get(a), from_divisor) {
            (Some(da), Some(other)) => self.pool.sub(da, other),
            (Some(da), None) => da,
            (None, Some(other)) => self.pool.neg(other),
            (None, None) => return None,
        };
        Some(self.pool.div(numerator, b))
    }

    /// (a^b)′ = b a^(b−1) a′ + a^b log(a) b′, the second term 0 where a is 0.
    fn power(&mut self, power: Expr, a: Expr, b: Expr) -> Option<Expr> {
        let from_base = self.get(a).map(|da| {
            let one = self.pool.constant(1.0);
            let exponent = self.pool.sub(b, one);
            let lower = self.pool.pow(a, exponent);
            let derivative = self.pool.mul(b, lower);
            self.pool.mul(derivative, da)
        });
        let from_exponent = self.get(b).map(|db| {
            let logarithm = self.pool.function("log", &[a]);
            let derivative = self.pool.mul(power, logarithm);
            let zero = self.pool.constant(0.0);
            let at_zero = self.pool.relation(RelationOperator::Equal, a, zero);
            let derivative = self.pool.if_then_else(at_zero, zero, derivative);
            self.pool.mul(derivative, db)
        });
        self.total(from_base, from_exponent)
    }

    fn application(&mut self, id: FunctionId, arguments: Arguments) -> Option<Expr> {
        let list: Vec<Expr> = arguments.iter().collect();
        if self.is_forward
            && id.get().name == "sqrt"
            && let Some(derivative) = self.norm(list[0])
        {
            return Some(derivative);
        }
        let mut sum = None;
        for (which, argument) in list.iter().enumerate() {
            let Some(inner) = self.get(*argument) else { continue };
            let outer = (id.get().derivative)(self.pool, &list, which);
            let term = self.chained(outer, inner);
            sum = self.total(sum, Some(term));
        }
        sum
    }

    /// √q of a sum q = Σ c u² with c > 0: q′ / (2 √q), and √(Σ c u′²) where q is zero. `None` if q
    /// is anything else, or constant.
    fn norm(&mut self, q: Expr) -> Option<Expr> {
        let inner = self.get(q)?;
        let mut squares = Vec::new();
        if !self.squares(q, 1.0, &mut squares) {
            return None;
        }
        let zero = self.pool.constant(0.0);
        let at_zero = squares.into_iter().fold(zero, |sum, (factor, u)| {
            let du = self.get(u).unwrap_or(zero);
            let (factor, square) = (self.pool.constant(factor), self.pool.mul(du, du));
            let term = self.pool.mul(factor, square);
            self.pool.add(sum, term)
        });
        let at_zero = self.pool.function("sqrt", &[at_zero]);
        let (root, two) = (self.pool.function("sqrt", &[q]), self.pool.constant(2.0));
        let divisor = self.pool.mul(two, root);
        let elsewhere = self.pool.div(inner, divisor);
        let is_zero = self.pool.relation(RelationOperator::Equal, q, zero);
        Some(self.pool.if_then_else(is_zero, at_zero, elsewhere))
    }

    /// Appends the terms c u² of a sum of such, times a factor, as (c, u); whether it is one.
    fn squares(&self, e: Expr, factor: f64, found: &mut Vec<(f64, Expr)>) -> bool {
        let mut open = vec![(e, factor)];
        while let Some((e, factor)) = open.pop() {
            match *self.pool.node(e) {
                Node::Add(a, b) => open.extend([(b, factor), (a, factor)]),
                Node::Mul(a, b) if a == b => found.push((factor, a)),
                Node::Mul(a, b) => match (self.pool.as_constant(a), self.pool.as_constant(b)) {
                    (Some(c), _) if c > 0.0 => open.push((b, factor * c)),
                    (_, Some(c)) if c > 0.0 => open.push((a, factor * c)),
                    _ => return false,
                },
                Node::Pow(u, exponent) if self.pool.as_constant(exponent) == Some(2.0) => {
                    found.push((factor, u));
                }
                _ => return false,
            }
        }
        true
    }

    /// The product of the derivatives of a function and of what it is applied to: where one of them
    /// is zero in a branch, the other is not evaluated there. √max(0, x) has a derivative for x < 0.
    fn chained(&mut self, outer: Expr, inner: Expr) -> Expr {
        let zero = self.pool.constant(0.0);
        if outer == zero || inner == zero {
            return zero;
        }
        match (self.pool.node(outer), self.pool.node(inner)) {
            (&Node::If(condition, a, b), _) if a == zero || b == zero => {
                let (a, b) = (self.chained(a, inner), self.chained(b, inner));
                self.pool.if_then_else(condition, a, b)
            }
            (_, &Node::If(condition, a, b)) if a == zero || b == zero => {
                let (a, b) = (self.chained(outer, a), self.chained(outer, b));
                self.pool.if_then_else(condition, a, b)
            }
            _ => self.pool.mul(outer, inner),
        }
    }

    fn branches(&mut self, condition: Expr, a: Expr, b: Expr) -> Option<Expr> {
        let (da, db) = (self.get(a), self.get(b));
        if da.is_none() && db.is_none() {
            return None;
        }
        let zero = self.pool.constant(0.0);
        Some(self.pool.if_then_else(condition, da.unwrap_or(zero), db.unwrap_or(zero)))
    }

    fn call(
        &mut self,
        function: u32,
        output: u32,
        inputs: &[u32],
        arguments: Expr,
    ) -> Option<Expr> {
        let mut sum = None;
        for (input, inner) in self.entries(arguments) {
            let inputs: Vec<u32> = inputs.iter().copied().chain([input as u32]).collect();
            let outer = self.pool.derivative_of_call(function, output, &inputs, arguments);
            let term = self.pool.mul(outer, inner);
            sum = self.total(sum, Some(term));
        }
        sum
    }

    /// The entries of a list that have derivatives, by place.
    fn entries(&self, list: Expr) -> Vec<(usize, Expr)> {
        let entries = self.pool.entries(list).iter().enumerate();
        entries.filter_map(|(at, entry)| Some((at, self.get(*entry)?))).collect()
    }

    /// A x = b gives A x′ = b′ − A′ x.
    fn solution(&mut self, system: System, output: u32) -> Option<Expr> {
        let of_derivatives = match self.rights.get(&system) {
            Some(known) => *known,
            None => {
                let right = self.right_of_derivatives(system);
                self.rights.insert(system, right);
                right
            }
        };
        Some(self.pool.any_solution(system.0, of_derivatives?, output, true))
    }

    /// `None` if neither matrix nor right side has derivatives.
    fn right_of_derivatives(&mut self, (matrix, right, is_derivative): System) -> Option<Expr> {
        let (of_matrix, of_right) = (self.entries(matrix), self.entries(right));
        if of_matrix.is_empty() && of_right.is_empty() {
            return None;
        }
        let n = self.pool.entries(right).len();
        let mut rights = vec![self.pool.constant(0.0); n];
        for (at, derivative) in of_right {
            rights[at] = derivative;
        }
        for (at, derivative) in of_matrix {
            let unknown = (at % n) as u32;
            let x = self.pool.any_solution(matrix, right, unknown, is_derivative);
            let term = self.pool.mul(derivative, x);
            rights[at / n] = self.pool.sub(rights[at / n], term);
        }
        Some(self.pool.list(&rights))
    }
}
