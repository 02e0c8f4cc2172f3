//! Arithmetic expressions of the parameters, as constraints have them on both sides.

use crate::elementary;
use serde::{Deserialize, Serialize};

/// An arithmetic expression of the parameters.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Term {
    /// A number.
    Number(f64),
    /// The parameter at this place.
    Parameter(usize),
    /// The negative of a term.
    Negative(Box<Term>),
    /// Two terms with an operator between them.
    Binary(Operator, Box<Term>, Box<Term>),
    /// A function of a term.
    Function(Function, Box<Term>),
}

/// An arithmetic operator.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Operator {
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
}

/// A function of one argument.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Function {
    /// Absolute value.
    Abs,
    /// Exponential.
    Exp,
    /// Natural logarithm.
    Log,
    /// Decimal logarithm.
    Log10,
    /// Square root.
    Sqrt,
}

impl Function {
    /// The function of this name.
    pub fn named(name: &str) -> Option<Function> {
        Some(match name {
            "abs" => Function::Abs,
            "exp" => Function::Exp,
            "log" => Function::Log,
            "log10" => Function::Log10,
            "sqrt" => Function::Sqrt,
            _ => return None,
        })
    }

    fn value(self, x: f64) -> f64 {
        match self {
            Function::Abs => x.abs(),
            Function::Exp => elementary::exp(x),
            Function::Log => elementary::ln(x),
            Function::Log10 => elementary::log10(x),
            Function::Sqrt => x.sqrt(),
        }
    }
}

impl Term {
    /// Its value at these values of the parameters.
    pub fn value(&self, parameters: &[f64]) -> f64 {
        match self {
            Term::Number(value) => *value,
            Term::Parameter(place) => parameters[*place],
            Term::Negative(term) => -term.value(parameters),
            Term::Function(function, term) => function.value(term.value(parameters)),
            Term::Binary(operator, left, right) => {
                let (a, b) = (left.value(parameters), right.value(parameters));
                match operator {
                    Operator::Add => a + b,
                    Operator::Subtract => a - b,
                    Operator::Multiply => a * b,
                    Operator::Divide => a / b,
                    Operator::Power => elementary::powf(a, b),
                }
            }
        }
    }
}
