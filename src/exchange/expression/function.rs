//! Functions and operators, with their names in MathML and in Modelica.

use crate::elementary;

/// A function or an operator.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Function {
    Plus,
    Minus,
    Times,
    Divide,
    Power,
    And,
    Or,
    Xor,
    Not,
    Implies,
    Equal,
    NotEqual,
    Less,
    LessOrEqual,
    Greater,
    GreaterOrEqual,
    Quotient,
    Remainder,
    Factorial,
    /// A function that Modelica has under this name.
    Named(&'static str),
    /// The function of the reciprocal argument: `arcsec(x)` is `acos(1/x)`.
    OfReciprocal(&'static str),
    /// The reciprocal of the function: `sec(x)` is `1/cos(x)`.
    Reciprocal(&'static str),
    ArcCot,
    ArSinh,
    ArCosh,
    ArTanh,
    ArCoth,
    ArSech,
    ArCsch,
}

use Function::{Named, OfReciprocal, Reciprocal};

/// Names of MathML.
const MATHML: &[(&str, Function)] = &[
    ("plus", Function::Plus),
    ("minus", Function::Minus),
    ("times", Function::Times),
    ("divide", Function::Divide),
    ("power", Function::Power),
    ("and", Function::And),
    ("or", Function::Or),
    ("xor", Function::Xor),
    ("not", Function::Not),
    ("implies", Function::Implies),
    ("eq", Function::Equal),
    ("neq", Function::NotEqual),
    ("lt", Function::Less),
    ("leq", Function::LessOrEqual),
    ("gt", Function::Greater),
    ("geq", Function::GreaterOrEqual),
    ("quotient", Function::Quotient),
    ("rem", Function::Remainder),
    ("factorial", Function::Factorial),
    ("abs", Named("abs")),
    ("exp", Named("exp")),
    ("ln", Named("log")),
    ("floor", Named("floor")),
    ("ceiling", Named("ceil")),
    ("min", Named("min")),
    ("max", Named("max")),
    ("sin", Named("sin")),
    ("cos", Named("cos")),
    ("tan", Named("tan")),
    ("sinh", Named("sinh")),
    ("cosh", Named("cosh")),
    ("tanh", Named("tanh")),
    ("arcsin", Named("asin")),
    ("arccos", Named("acos")),
    ("arctan", Named("atan")),
    ("sec", Reciprocal("cos")),
    ("csc", Reciprocal("sin")),
    ("cot", Reciprocal("tan")),
    ("sech", Reciprocal("cosh")),
    ("csch", Reciprocal("sinh")),
    ("coth", Reciprocal("tanh")),
    ("arcsec", OfReciprocal("acos")),
    ("arccsc", OfReciprocal("asin")),
    ("arccot", Function::ArcCot),
    ("arcsinh", Function::ArSinh),
    ("arccosh", Function::ArCosh),
    ("arctanh", Function::ArTanh),
    ("arccoth", Function::ArCoth),
    ("arcsech", Function::ArSech),
    ("arccsch", Function::ArCsch),
];

impl Function {
    /// The function of an element of MathML.
    pub(crate) fn of_mathml(name: &str) -> Option<Function> {
        MATHML.iter().find(|(own, _)| *own == name).map(|(_, function)| *function)
    }

    /// Whether its value is true or false.
    pub(crate) fn is_boolean(self) -> bool {
        self.is_logical() || self.is_relation()
    }

    /// Whether its arguments are true or false.
    pub(crate) fn is_logical(self) -> bool {
        use Function::{And, Implies, Not, Or, Xor};
        matches!(self, And | Or | Xor | Not | Implies)
    }

    /// Whether it compares numbers.
    pub(crate) fn is_relation(self) -> bool {
        use Function::{Equal, Greater, GreaterOrEqual, Less, LessOrEqual, NotEqual};
        matches!(self, Equal | NotEqual | Less | LessOrEqual | Greater | GreaterOrEqual)
    }

    /// How many arguments it takes, at least and at most.
    pub(crate) fn arity(self) -> (usize, usize) {
        use Function::{
            And, Divide, Implies, Minus, NotEqual, Or, Plus, Power, Quotient, Remainder,
        };
        match self {
            Plus | Function::Times | And | Or | Function::Xor => (0, usize::MAX),
            Minus => (1, 2),
            Divide | Power | Quotient | Remainder | Implies | NotEqual => (2, 2),
            Named("min" | "max") => (1, usize::MAX),
            own if own.is_relation() => (2, usize::MAX),
            _ => (1, 1),
        }
    }

    /// Its value, of the functions that numbers in tables and in models are written with.
    pub(crate) fn value(self, arguments: &[f64]) -> Option<f64> {
        Some(match (self, arguments) {
            (Function::Plus, all) => all.iter().sum(),
            (Function::Times, all) => all.iter().product(),
            (Function::Minus, [a]) => -a,
            (Function::Minus, [a, b]) => a - b,
            (Function::Divide, [a, b]) => a / b,
            (Function::Power, [a, b]) => elementary::powf(*a, *b),
            (Named("exp"), [a]) => elementary::exp(*a),
            (Named("log"), [a]) => elementary::ln(*a),
            (Named("log10"), [a]) => elementary::log10(*a),
            (Named("sqrt"), [a]) => a.sqrt(),
            (Named("abs"), [a]) => a.abs(),
            _ => return None,
        })
    }
}
