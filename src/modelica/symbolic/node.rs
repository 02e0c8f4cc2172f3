//! What an expression is made of. Data only.

use super::function::FunctionId;

/// An expression: the id of a node of one [`Pool`](super::Pool).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, serde::Serialize)]
pub struct Expr(pub(super) u32);

impl Expr {
    /// Position of the node in its pool; operands have smaller positions.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// A variable, numbered by the owner of the pool.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, serde::Serialize)]
pub struct VarId(pub u32);

/// A constant that is equal to another when all bits are.
#[derive(Debug, Clone, Copy, serde::Serialize, serde::Deserialize)]
pub struct Number(pub f64);

impl PartialEq for Number {
    fn eq(&self, other: &Number) -> bool {
        self.0.to_bits() == other.0.to_bits()
    }
}

impl Eq for Number {}

impl std::hash::Hash for Number {
    fn hash<H: std::hash::Hasher>(&self, state: &mut H) {
        self.0.to_bits().hash(state);
    }
}

/// The arguments of a function of one or two arguments; read it as a slice.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
pub struct Arguments {
    first: Expr,
    second: Option<Expr>,
}

impl Arguments {
    /// One argument.
    pub fn one(first: Expr) -> Arguments {
        Arguments { first, second: None }
    }

    /// Two arguments.
    pub fn two(first: Expr, second: Expr) -> Arguments {
        Arguments { first, second: Some(second) }
    }

    /// The first argument.
    pub fn first(&self) -> Expr {
        self.first
    }

    /// The second argument, if there is one.
    pub fn second(&self) -> Option<Expr> {
        self.second
    }

    /// In order.
    pub fn iter(&self) -> impl Iterator<Item = Expr> {
        std::iter::once(self.first).chain(self.second)
    }
}

/// A relation between two numbers (MLS §3.5).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
pub enum RelationOperator {
    /// `<`
    Less,
    /// `<=`
    LessEqual,
    /// `>`
    Greater,
    /// `>=`
    GreaterEqual,
    /// `==`
    Equal,
    /// `<>`
    NotEqual,
}

impl RelationOperator {
    /// Whether it holds.
    pub fn holds(self, a: f64, b: f64) -> bool {
        match self {
            RelationOperator::Less => a < b,
            RelationOperator::LessEqual => a <= b,
            RelationOperator::Greater => a > b,
            RelationOperator::GreaterEqual => a >= b,
            RelationOperator::Equal => a == b,
            RelationOperator::NotEqual => a != b,
        }
    }

    /// The operator with the sides exchanged.
    pub fn mirrored(self) -> RelationOperator {
        match self {
            RelationOperator::Less => RelationOperator::Greater,
            RelationOperator::LessEqual => RelationOperator::GreaterEqual,
            RelationOperator::Greater => RelationOperator::Less,
            RelationOperator::GreaterEqual => RelationOperator::LessEqual,
            symmetric => symmetric,
        }
    }

    /// As written in Modelica.
    pub fn symbol(self) -> &'static str {
        match self {
            RelationOperator::Less => "<",
            RelationOperator::LessEqual => "<=",
            RelationOperator::Greater => ">",
            RelationOperator::GreaterEqual => ">=",
            RelationOperator::Equal => "==",
            RelationOperator::NotEqual => "<>",
        }
    }
}

/// How an equation `y = f(…)` is solved for one input of a user function with one output.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Inverse {
    /// The function that gives the input.
    pub function: u32,
    /// For each of its inputs the input of `f` that it is given; `None` stands for y.
    pub arguments: Box<[Option<u32>]>,
    /// Whether it gives the input back in the whole range of `f`, not in a part of it.
    pub is_exact: bool,
}

/// A node of an expression.
#[derive(Debug, Clone, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
pub enum Node {
    /// A number.
    Constant(Number),
    /// A variable.
    Variable(#[serde(deserialize_with = "super::stored::read_any_variable")] VarId),
    /// `-a`
    Neg(Expr),
    /// `a + b`
    Add(Expr, Expr),
    /// `a - b`
    Sub(Expr, Expr),
    /// `a * b`
    Mul(Expr, Expr),
    /// `a / b`
    Div(Expr, Expr),
    /// `a ^ b`
    Pow(Expr, Expr),
    /// A function of the [table](super::function::functions).
    Apply(FunctionId, Arguments),
    /// `if condition then a else b`
    If(Expr, Expr, Expr),
    /// 1 if the relation holds, otherwise 0.
    Relation(RelationOperator, Expr, Expr),
    /// `a and b`
    And(Expr, Expr),
    /// `a or b`
    Or(Expr, Expr),
    /// `not a`
    Not(Expr),
    /// A scalar output of a user function, arguments scalarised.
    Call {
        /// Which function.
        function: u32,
        /// Which scalar of its outputs.
        output: u32,
        /// The list of the scalars of its inputs, which all outputs share.
        arguments: Expr,
    },
    /// A partial derivative of a scalar output of a user function.
    CallDerivative {
        /// Which function.
        function: u32,
        /// Which scalar of its outputs.
        output: u32,
        /// Which scalar inputs it is differentiated for, ascending; two of them mean a second
        /// derivative.
        inputs: Box<[u32]>,
        /// The list of the scalars of its inputs.
        arguments: Expr,
    },
    /// Several values, as an operand of calls and of [`Node::Solution`] alone.
    List(Box<[Expr]>),
    /// An unknown of a system of linear equations A x = b.
    Solution {
        /// The list of the entries of A, by rows.
        matrix: Expr,
        /// The list of the entries of b.
        right: Expr,
        /// Which unknown.
        output: u32,
        /// Whether x is the derivative of the solution of another system with the same matrix:
        /// where this is singular it need not have a solution.
        is_derivative: bool,
    },
}

impl Node {
    /// Visits the operands in order.
    pub(crate) fn for_each_operand(&self, mut visit: impl FnMut(Expr)) {
        match self {
            Node::Constant(_) | Node::Variable(_) => {}
            Node::Neg(a)
            | Node::Not(a)
            | Node::Call { arguments: a, .. }
            | Node::CallDerivative { arguments: a, .. } => visit(*a),
            Node::Add(a, b)
            | Node::Sub(a, b)
            | Node::Mul(a, b)
            | Node::Div(a, b)
            | Node::Pow(a, b)
            | Node::Relation(_, a, b)
            | Node::And(a, b)
            | Node::Or(a, b) => {
                visit(*a);
                visit(*b);
            }
            Node::Apply(_, arguments) => arguments.iter().for_each(visit),
            Node::If(condition, a, b) => {
                visit(*condition);
                visit(*a);
                visit(*b);
            }
            Node::List(entries) => entries.iter().copied().for_each(visit),
            Node::Solution { matrix, right, .. } => {
                visit(*matrix);
                visit(*right);
            }
        }
    }
}
