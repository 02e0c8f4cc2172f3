//! The constructors and the rules they apply.
//!
//! A rule keeps the value wherever the expression has one; `0 * a` is 0 and `a - a` is 0 whatever
//! `a` is (MLS §8.3 lets a tool rearrange expressions). Constants are folded unless the result is
//! infinite or not a number: such an operation stays and fails where it is evaluated.

use super::function::{self, FunctionId};
use super::node::{Arguments, Expr, Node, RelationOperator};
use super::pool::Pool;
use crate::elementary;

impl Pool {
    /// `-a`
    pub fn neg(&mut self, a: Expr) -> Expr {
        match *self.node(a) {
            Node::Constant(value) => self.constant(-value.0),
            Node::Neg(inner) => inner,
            Node::Sub(x, y) => self.sub(y, x),
            _ => self.intern(Node::Neg(a)),
        }
    }

    /// `a + b`
    pub fn add(&mut self, a: Expr, b: Expr) -> Expr {
        if let Some(folded) = self.fold(a, b, |x, y| x + y) {
            return folded;
        }
        match (self.node(a), self.node(b)) {
            (Node::Constant(zero), _) if zero.0 == 0.0 => b,
            (_, Node::Constant(zero)) if zero.0 == 0.0 => a,
            (_, &Node::Neg(y)) => self.sub(a, y),
            (&Node::Neg(x), _) => self.sub(b, x),
            _ => self.intern_commutative(Node::Add, a, b),
        }
    }

    /// `a - b`
    pub fn sub(&mut self, a: Expr, b: Expr) -> Expr {
        if let Some(folded) = self.fold(a, b, |x, y| x - y) {
            return folded;
        }
        if a == b {
            return self.constant(0.0);
        }
        match (self.node(a), self.node(b)) {
            (Node::Constant(zero), _) if zero.0 == 0.0 => self.neg(b),
            (_, Node::Constant(zero)) if zero.0 == 0.0 => a,
            (_, &Node::Neg(y)) => self.add(a, y),
            _ => self.intern(Node::Sub(a, b)),
        }
    }

    /// `a * b`
    pub fn mul(&mut self, a: Expr, b: Expr) -> Expr {
        if let Some(folded) = self.fold(a, b, |x, y| x * y) {
            return folded;
        }
        if let Some(value) = self.as_constant(b)
            && let Some(product) = self.scaled(value, a)
        {
            return product;
        }
        if let Some(value) = self.as_constant(a)
            && let Some(product) = self.scaled(value, b)
        {
            return product;
        }
        match (self.node(a), self.node(b)) {
            (&Node::Neg(x), &Node::Neg(y)) => self.mul(x, y),
            (&Node::Neg(x), _) => {
                let product = self.mul(x, b);
                self.neg(product)
            }
            (_, &Node::Neg(y)) => {
                let product = self.mul(a, y);
                self.neg(product)
            }
            _ => self.intern_commutative(Node::Mul, a, b),
        }
    }

    /// `factor * a` where that is simpler than a product.
    fn scaled(&mut self, factor: f64, a: Expr) -> Option<Expr> {
        if factor == 0.0 {
            Some(self.constant(0.0))
        } else if factor == 1.0 {
            Some(a)
        } else if factor == -1.0 {
            Some(self.neg(a))
        } else {
            None
        }
    }

    /// `a / b`
    pub fn div(&mut self, a: Expr, b: Expr) -> Expr {
        if let Some(folded) = self.fold(a, b, |x, y| x / y) {
            return folded;
        }
        let divisor = self.as_constant(b);
        match (self.node(a), self.node(b)) {
            (Node::Constant(zero), _) if zero.0 == 0.0 && divisor != Some(0.0) => a,
            (_, Node::Constant(one)) if one.0 == 1.0 => a,
            (_, Node::Constant(one)) if one.0 == -1.0 => self.neg(a),
            (&Node::Neg(x), &Node::Neg(y)) => self.div(x, y),
            (&Node::Neg(x), _) => {
                let quotient = self.div(x, b);
                self.neg(quotient)
            }
            (_, &Node::Neg(y)) => {
                let quotient = self.div(a, y);
                self.neg(quotient)
            }
            _ => self.intern(Node::Div(a, b)),
        }
    }

    /// `a ^ b`
    pub fn pow(&mut self, a: Expr, b: Expr) -> Expr {
        if let Some(folded) = self.fold(a, b, elementary::powf) {
            return folded;
        }
        match (self.node(a), self.node(b)) {
            (_, Node::Constant(zero)) if zero.0 == 0.0 => self.constant(1.0),
            (_, Node::Constant(one)) if one.0 == 1.0 => a,
            (Node::Constant(one), _) if one.0 == 1.0 => a,
            _ => self.intern(Node::Pow(a, b)),
        }
    }

    /// A function of the table.
    ///
    /// # Panics
    /// If the number of arguments is not the function's arity.
    pub fn apply(&mut self, id: FunctionId, arguments: &[Expr]) -> Expr {
        let definition = id.get();
        let inline = match *arguments {
            [a] if definition.arity() == 1 => Arguments::one(a),
            [a, b] if definition.arity() == 2 => Arguments::two(a, b),
            _ => panic!("`{}` takes {} arguments", definition.name, definition.arity()),
        };
        self.folded_application(definition, inline)
            .unwrap_or_else(|| self.intern(Node::Apply(id, inline)))
    }

    fn folded_application(
        &mut self,
        definition: &function::Function,
        arguments: Arguments,
    ) -> Option<Expr> {
        let first = self.as_constant(arguments.first())?;
        let value = match arguments.second() {
            None => definition.value.of(&[first]),
            Some(second) => definition.value.of(&[first, self.as_constant(second)?]),
        };
        value.is_finite().then(|| self.constant(value))
    }

    /// `if condition then a else b`
    pub(crate) fn if_then_else(&mut self, condition: Expr, a: Expr, b: Expr) -> Expr {
        match (self.as_constant(condition), self.node(condition)) {
            (Some(value), _) => {
                if value != 0.0 {
                    a
                } else {
                    b
                }
            }
            _ if a == b => a,
            (_, &Node::Not(inner)) => self.if_then_else(inner, b, a),
            _ => self.intern(Node::If(condition, a, b)),
        }
    }

    /// 1 if the relation holds, otherwise 0.
    pub fn relation(&mut self, operator: RelationOperator, a: Expr, b: Expr) -> Expr {
        match (self.as_constant(a), self.as_constant(b)) {
            (Some(x), Some(y)) => self.boolean(operator.holds(x, y)),
            _ => self.intern(Node::Relation(operator, a, b)),
        }
    }

    /// `a and b`
    pub fn and(&mut self, a: Expr, b: Expr) -> Expr {
        match (self.as_constant(a), self.as_constant(b)) {
            (Some(0.0), _) => a,
            (_, Some(0.0)) => b,
            (Some(_), _) => b,
            (_, Some(_)) => a,
            _ if a == b => a,
            _ if self.is_not(a, b) || self.is_not(b, a) => self.constant(0.0),
            _ => self.intern_commutative(Node::And, a, b),
        }
    }

    /// Whether `a` is `not b`.
    fn is_not(&self, a: Expr, b: Expr) -> bool {
        matches!(*self.node(a), Node::Not(of) if of == b)
    }

    /// `a or b`
    pub fn or(&mut self, a: Expr, b: Expr) -> Expr {
        match (self.as_constant(a), self.as_constant(b)) {
            (Some(0.0), _) => b,
            (_, Some(0.0)) => a,
            (Some(_), _) => a,
            (_, Some(_)) => b,
            _ if a == b => a,
            _ => self.intern_commutative(Node::Or, a, b),
        }
    }

    /// `not a`
    pub fn not(&mut self, a: Expr) -> Expr {
        match *self.node(a) {
            Node::Constant(value) => self.boolean(value.0 == 0.0),
            Node::Not(inner) => inner,
            _ => self.intern(Node::Not(a)),
        }
    }

    /// A scalar output of a user function.
    pub fn call(&mut self, function: u32, output: u32, arguments: &[Expr]) -> Expr {
        let arguments = self.list(arguments);
        self.intern(Node::Call { function, output, arguments })
    }

    /// A partial derivative of a scalar output of a user function; `inputs` in any order, `arguments`
    /// is their list.
    pub(super) fn derivative_of_call(
        &mut self,
        function: u32,
        output: u32,
        inputs: &[u32],
        arguments: Expr,
    ) -> Expr {
        let mut inputs: Box<[u32]> = inputs.into();
        inputs.sort_unstable();
        self.intern(Node::CallDerivative { function, output, inputs, arguments })
    }

    /// Several values, for calls and [`Pool::solution`].
    pub fn list(&mut self, entries: &[Expr]) -> Expr {
        self.intern(Node::List(entries.into()))
    }

    /// An unknown of A x = b; the list `matrix` holds n × n entries by rows, the list `right` n.
    pub fn solution(&mut self, matrix: Expr, right: Expr, output: u32) -> Expr {
        self.any_solution(matrix, right, output, false)
    }

    /// Another unknown of the system that an expression is an unknown of.
    pub(crate) fn other_unknown(&mut self, solution: Expr, output: u32) -> Expr {
        match *self.node(solution) {
            Node::Solution { matrix, right, is_derivative, .. } => {
                self.any_solution(matrix, right, output, is_derivative)
            }
            _ => solution,
        }
    }

    pub(super) fn any_solution(
        &mut self,
        matrix: Expr,
        right: Expr,
        output: u32,
        is_derivative: bool,
    ) -> Expr {
        let zero = |e: &Expr| self.as_constant(*e) == Some(0.0);
        // Zero solves any homogeneous system, but of a singular one it is not the only solution,
        // and the solver must detect that.
        match is_derivative && self.entries(right).iter().all(zero) {
            true => self.constant(0.0),
            false => self.intern(Node::Solution { matrix, right, output, is_derivative }),
        }
    }

    /// The result of an operation on two constants, if it is finite.
    fn fold(&mut self, a: Expr, b: Expr, operation: fn(f64, f64) -> f64) -> Option<Expr> {
        let value = operation(self.as_constant(a)?, self.as_constant(b)?);
        value.is_finite().then(|| self.constant(value))
    }

    /// The node with its operands replaced: `map` gives each operand's successor.
    pub(crate) fn rebuild(&mut self, node: &Node, map: impl Fn(Expr) -> Expr) -> Expr {
        match node {
            Node::Constant(value) => self.constant(value.0),
            Node::Variable(variable) => self.variable(*variable),
            Node::Neg(a) => self.neg(map(*a)),
            Node::Add(a, b) => self.add(map(*a), map(*b)),
            Node::Sub(a, b) => self.sub(map(*a), map(*b)),
            Node::Mul(a, b) => self.mul(map(*a), map(*b)),
            Node::Div(a, b) => self.div(map(*a), map(*b)),
            Node::Pow(a, b) => self.pow(map(*a), map(*b)),
            Node::Apply(id, arguments) => {
                let first = map(arguments.first());
                match arguments.second() {
                    None => self.apply(*id, &[first]),
                    Some(second) => self.apply(*id, &[first, map(second)]),
                }
            }
            Node::If(c, a, b) => self.if_then_else(map(*c), map(*a), map(*b)),
            Node::Relation(operator, a, b) => self.relation(*operator, map(*a), map(*b)),
            Node::And(a, b) => self.and(map(*a), map(*b)),
            Node::Or(a, b) => self.or(map(*a), map(*b)),
            Node::Not(a) => self.not(map(*a)),
            Node::Call { function, output, arguments } => {
                let arguments = map(*arguments);
                self.intern(Node::Call { function: *function, output: *output, arguments })
            }
            Node::CallDerivative { function, output, inputs, arguments } => {
                self.derivative_of_call(*function, *output, inputs, map(*arguments))
            }
            Node::List(entries) => {
                let entries: Vec<Expr> = entries.iter().map(|e| map(*e)).collect();
                self.list(&entries)
            }
            Node::Solution { matrix, right, output, is_derivative } => {
                self.any_solution(map(*matrix), map(*right), *output, *is_derivative)
            }
        }
    }
}
