//! Expressions (MLS §A.2.7, ch. 3).

use super::LeftOperand;
use crate::name::{Ident, Name};
use crate::source::{Span, Spanned};
use std::sync::Arc;

/// An expression with its place.
#[derive(Debug, Clone, PartialEq)]
pub struct Expression {
    /// What it is.
    pub kind: ExpressionKind,
    /// Where it is written.
    pub span: Span,
}

/// The forms of expressions.
#[derive(Debug, Clone, PartialEq)]
pub enum ExpressionKind {
    /// `1.5`, `1e-3`
    Real(f64),
    /// `42`. A literal too large for 64 bits is read as Real.
    Integer(i64),
    /// `true`
    Boolean(bool),
    /// `"text"`, escapes resolved
    String(Arc<str>),
    /// `a.b[1].c`; `time` is one too
    Reference(ComponentReference),
    /// `f(x, y = 2)`; also `der(x)`, `initial()`, `pure(f(x))`
    Call {
        /// The function's name; never with subscripts.
        function: ComponentReference,
        /// Its arguments.
        arguments: Box<Arguments>,
    },
    /// `function f(x = 1)` as an argument: partial application (MLS §12.4.2.1)
    PartialApplication {
        /// The function.
        function: Name,
        /// Arguments given now.
        named: Vec<NamedArgument>,
    },
    /// `-a`, `not a`
    Unary {
        /// The operator.
        operator: UnaryOperator,
        /// Its operand.
        operand: Box<Expression>,
    },
    /// `a + b`
    Binary {
        /// The operator.
        operator: BinaryOperator,
        /// Left operand; [`Expression::chain`] lists those of a sum or a product.
        left: LeftOperand,
        /// Right operand.
        right: Box<Expression>,
    },
    /// `if c then a elseif d then b else e`
    If {
        /// Conditions with their values.
        branches: Vec<(Expression, Expression)>,
        /// The value after `else`.
        otherwise: Box<Expression>,
    },
    /// `a:b` or `a:step:b`
    Range {
        /// First value.
        start: Box<Expression>,
        /// Step; one where not written.
        step: Option<Box<Expression>>,
        /// Bound.
        stop: Box<Expression>,
    },
    /// What an iterator runs over, without the values for which a condition does not hold:
    /// `i guard condition in values` (OpenModelica); only as the range of a [`ForIndex`]
    Guarded {
        /// The iterator.
        name: Ident,
        /// The condition, in which the iterator has its value.
        condition: Box<Expression>,
        /// All values.
        values: Box<Expression>,
    },
    /// `{a, b}`
    Array(Vec<Expression>),
    /// `{e for i in r, j in s}`
    ArrayIteration {
        /// The element.
        element: Box<Expression>,
        /// Its iterators.
        indices: Vec<ForIndex>,
    },
    /// `[a, b; c, d]`: rows of columns
    Matrix(Vec<Vec<Expression>>),
    /// `(a, , b)`: an output list, never of one element; also `()`
    Tuple(Vec<Option<Expression>>),
    /// `end` in a subscript
    End,
    /// `$TypeName(A.B)`: the name itself (scripts of OpenModelica)
    TypeName(Name),
    /// `$Code(= 2)`, `$Code((start = 1))`, `$Code(x)`: an expression or a modification as written
    /// (scripts of OpenModelica)
    Code(Arc<str>),
    /// `e[i]` for an `e` in parentheses, and `e.name` (scripts and MLS 3.6's
    /// `output-expression-list array-subscripts`)
    Subscripted {
        /// What is subscripted.
        base: Box<Expression>,
        /// The subscripts.
        subscripts: Vec<Subscript>,
    },
    /// `(e).name`
    Field {
        /// The record, which the values of all its components share.
        base: Arc<Expression>,
        /// The component.
        name: Ident,
    },
}

/// `a[1].b.c[2, :]`
#[derive(Debug, Clone, PartialEq)]
pub struct ComponentReference {
    /// Whether it begins with a dot.
    pub global: bool,
    /// The identifiers with their subscripts; never empty.
    pub parts: Vec<ReferencePart>,
    /// Where it is written.
    pub span: Span,
}

/// One identifier of a reference with its subscripts.
#[derive(Debug, Clone, PartialEq)]
pub struct ReferencePart {
    /// The identifier.
    pub name: Ident,
    /// Its subscripts; empty without brackets.
    pub subscripts: Vec<Subscript>,
}

/// One subscript.
#[derive(Debug, Clone, PartialEq)]
pub enum Subscript {
    /// `:`
    All(Span),
    /// Anything else: a scalar, a vector of indices, a range.
    Index(Expression),
}

/// The contents of the parentheses of a call.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Arguments {
    /// Positional arguments.
    pub positional: Vec<Expression>,
    /// Named arguments.
    pub named: Vec<NamedArgument>,
    /// `for …` after the only argument: a reduction `sum(e for i in r)` (MLS §10.3.4.1).
    pub iterators: Vec<ForIndex>,
}

/// `name = value`
#[derive(Debug, Clone, PartialEq)]
pub struct NamedArgument {
    /// The parameter's name.
    pub name: Spanned<Ident>,
    /// The value.
    pub value: Expression,
}

/// `i in 1:n`; `None` where the range is deduced from the body.
#[derive(Debug, Clone, PartialEq)]
pub struct ForIndex {
    /// The loop variable.
    pub name: Spanned<Ident>,
    /// Its range.
    pub range: Option<Expression>,
}

/// Operators with one operand.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum UnaryOperator {
    /// `+`
    Plus,
    /// `-`
    Minus,
    /// `.+`
    ElementwisePlus,
    /// `.-`
    ElementwiseMinus,
    /// `not`
    Not,
}

/// Operators with two operands.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum BinaryOperator {
    /// `+`
    Add,
    /// `-`
    Subtract,
    /// `*`
    Multiply,
    /// `/`
    Divide,
    /// `^`
    Power,
    /// `.+`
    ElementwiseAdd,
    /// `.-`
    ElementwiseSubtract,
    /// `.*`
    ElementwiseMultiply,
    /// `./`
    ElementwiseDivide,
    /// `.^`
    ElementwisePower,
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
    /// `and`
    And,
    /// `or`
    Or,
}

impl BinaryOperator {
    /// The operator as it is written.
    pub fn symbol(self) -> &'static str {
        match self {
            BinaryOperator::Add => "+",
            BinaryOperator::Subtract => "-",
            BinaryOperator::Multiply => "*",
            BinaryOperator::Divide => "/",
            BinaryOperator::Power => "^",
            BinaryOperator::ElementwiseAdd => ".+",
            BinaryOperator::ElementwiseSubtract => ".-",
            BinaryOperator::ElementwiseMultiply => ".*",
            BinaryOperator::ElementwiseDivide => "./",
            BinaryOperator::ElementwisePower => ".^",
            BinaryOperator::Less => "<",
            BinaryOperator::LessEqual => "<=",
            BinaryOperator::Greater => ">",
            BinaryOperator::GreaterEqual => ">=",
            BinaryOperator::Equal => "==",
            BinaryOperator::NotEqual => "<>",
            BinaryOperator::And => "and",
            BinaryOperator::Or => "or",
        }
    }
}

impl UnaryOperator {
    /// The operator as it is written.
    pub fn symbol(self) -> &'static str {
        match self {
            UnaryOperator::Plus => "+",
            UnaryOperator::Minus => "-",
            UnaryOperator::ElementwisePlus => ".+",
            UnaryOperator::ElementwiseMinus => ".-",
            UnaryOperator::Not => "not",
        }
    }
}

impl ComponentReference {
    /// The reference to a name without subscripts.
    pub fn from_name(name: &Name, span: Span) -> ComponentReference {
        let part = |ident: &Ident| ReferencePart { name: *ident, subscripts: Vec::new() };
        ComponentReference {
            global: name.global,
            parts: name.parts.iter().map(part).collect(),
            span,
        }
    }

    /// The name, if no part has subscripts.
    pub(crate) fn as_name(&self) -> Option<Name> {
        self.parts.iter().all(|part| part.subscripts.is_empty()).then(|| self.name())
    }

    /// The name, subscripts left away.
    pub fn name(&self) -> Name {
        Name { global: self.global, parts: self.parts.iter().map(|part| part.name).collect() }
    }

    /// The identifier, if it is a single one without subscripts.
    pub fn as_ident(&self) -> Option<Ident> {
        match self.parts.as_slice() {
            [part] if part.subscripts.is_empty() && !self.global => Some(part.name),
            _ => None,
        }
    }
}

impl Expression {
    /// An expression with its place.
    pub fn new(kind: ExpressionKind, span: Span) -> Expression {
        Expression { kind, span }
    }

    /// The sizes that its text shows: those of array constructors; none for anything else. An
    /// array of such elements has them even if it is empty.
    pub(crate) fn written_sizes(&self) -> Vec<usize> {
        match &self.kind {
            ExpressionKind::Array(elements) => {
                let inner = elements.first().map_or(Vec::new(), Expression::written_sizes);
                std::iter::once(elements.len()).chain(inner).collect()
            }
            _ => Vec::new(),
        }
    }
}

impl Subscript {
    /// Where it is written.
    pub fn span(&self) -> Span {
        match self {
            Subscript::All(span) => *span,
            Subscript::Index(expression) => expression.span,
        }
    }
}
