//! Expressions of models and problems, as MathML and formulas of tables have them.

mod formula;
mod function;
mod print;

pub(crate) use formula::formula;
pub(crate) use function::Function;
pub(crate) use print::{Context, number, printed};

use std::collections::{BTreeMap, BTreeSet};

/// An expression.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Expression {
    /// A number.
    Number(f64),
    /// `true` or `false`.
    Truth(bool),
    /// The value of something with a name.
    Name(String),
    /// The time of the simulation.
    Time,
    /// The value before the event, of something that changes at events only.
    Pre(String),
    /// A condition as Modelica has it: a Boolean variable, its value before the event, `initial()`.
    Condition(String),
    /// The derivative by time.
    Derivative(Box<Expression>),
    /// An expression at an earlier time.
    Delay(Box<[Expression; 2]>),
    /// A function or operator of arguments.
    Call(Function, Vec<Expression>),
    /// The value of the first pair whose condition holds, else the last one.
    Piecewise(Vec<(Expression, Expression)>, Option<Box<Expression>>),
}

impl Expression {
    pub(crate) fn name(name: impl Into<String>) -> Expression {
        Expression::Name(name.into())
    }

    pub(crate) fn call(function: Function, arguments: Vec<Expression>) -> Expression {
        Expression::Call(function, arguments)
    }

    pub(crate) fn times(self, other: Expression) -> Expression {
        match (self, other) {
            (Expression::Number(1.0), own) | (own, Expression::Number(1.0)) => own,
            (a, b) => Expression::call(Function::Times, vec![a, b]),
        }
    }

    pub(crate) fn over(self, other: Expression) -> Expression {
        match other {
            Expression::Number(1.0) => self,
            other => Expression::call(Function::Divide, vec![self, other]),
        }
    }

    /// Whether the time is negative.
    pub(crate) fn before_zero() -> Expression {
        Expression::call(Function::Less, vec![Expression::Time, Expression::Number(0.0)])
    }

    /// The sum of terms with a sign; 0 without any.
    pub(crate) fn sum(terms: Vec<Expression>) -> Expression {
        let negative = |term: &Expression| match term {
            Expression::Call(Function::Minus, one) if one.len() == 1 => Some(one[0].clone()),
            _ => None,
        };
        let all = terms.into_iter().fold(None, |sum: Option<Expression>, term| {
            Some(match (sum, negative(&term)) {
                (None, _) => term,
                (Some(sum), Some(term)) => Expression::call(Function::Minus, vec![sum, term]),
                (Some(sum), None) => Expression::call(Function::Plus, vec![sum, term]),
            })
        });
        all.unwrap_or(Expression::Number(0.0))
    }

    pub(crate) fn negative(self) -> Expression {
        match self {
            Expression::Number(value) => Expression::Number(-value),
            other => Expression::call(Function::Minus, vec![other]),
        }
    }

    /// Whether its value is true or false, as far as the expression says.
    pub(crate) fn is_boolean(&self) -> bool {
        match self {
            Expression::Truth(_) | Expression::Condition(_) => true,
            Expression::Call(function, _) => function.is_boolean(),
            Expression::Piecewise(pairs, _) => {
                pairs.first().is_some_and(|(own, _)| own.is_boolean())
            }
            _ => false,
        }
    }

    /// Its parts.
    fn parts(&self) -> Vec<&Expression> {
        match self {
            Expression::Call(_, arguments) => arguments.iter().collect(),
            Expression::Derivative(own) => vec![own],
            Expression::Delay(own) => own.iter().collect(),
            Expression::Piecewise(pairs, other) => {
                let pairs = pairs.iter().flat_map(|(value, condition)| [value, condition]);
                pairs.chain(other.as_deref()).collect()
            }
            _ => Vec::new(),
        }
    }

    /// Whether it or a part of it is such.
    pub(crate) fn any(&self, is: &dyn Fn(&Expression) -> bool) -> bool {
        is(self) || self.parts().into_iter().any(|part| part.any(is))
    }

    /// The names in it.
    pub(crate) fn names(&self) -> BTreeSet<String> {
        let mut names = BTreeSet::new();
        self.collect(&mut names);
        names
    }

    fn collect(&self, names: &mut BTreeSet<String>) {
        if let Expression::Name(name) | Expression::Pre(name) = self {
            names.insert(name.clone());
        }
        self.parts().into_iter().for_each(|part| part.collect(names));
    }

    /// With every part that `change` gives something else for replaced by that.
    pub(crate) fn replaced(
        &self,
        change: &dyn Fn(&Expression) -> Option<Expression>,
    ) -> Expression {
        if let Some(other) = change(self) {
            return other;
        }
        let own = |part: &Expression| part.replaced(change);
        match self {
            Expression::Call(function, arguments) => {
                Expression::Call(*function, arguments.iter().map(own).collect())
            }
            Expression::Derivative(part) => Expression::Derivative(Box::new(own(part))),
            Expression::Delay(parts) => {
                Expression::Delay(Box::new([own(&parts[0]), own(&parts[1])]))
            }
            Expression::Piecewise(pairs, other) => Expression::Piecewise(
                pairs.iter().map(|(value, condition)| (own(value), own(condition))).collect(),
                other.as_ref().map(|other| Box::new(own(other))),
            ),
            _ => self.clone(),
        }
    }

    /// How many parts it has with expressions in place of names.
    pub(crate) fn size_with(&self, values: &BTreeMap<String, Expression>) -> usize {
        let sizes = values.iter().map(|(name, value)| (name.as_str(), value.size()));
        let sizes: BTreeMap<&str, usize> = sizes.collect();
        self.size_of(&|name| sizes.get(name).copied())
    }

    /// How many parts it has.
    pub(crate) fn size(&self) -> usize {
        self.size_of(&|_| None)
    }

    fn size_of(&self, of_name: &dyn Fn(&str) -> Option<usize>) -> usize {
        if let Expression::Name(name) = self {
            return of_name(name).unwrap_or(1);
        }
        let parts = self.parts().into_iter().map(|part| part.size_of(of_name));
        parts.fold(1, usize::saturating_add)
    }

    /// With expressions in place of names.
    pub(crate) fn substituted(&self, values: &BTreeMap<String, Expression>) -> Expression {
        self.replaced(&|part| match part {
            Expression::Name(name) => values.get(name).cloned(),
            _ => None,
        })
    }

    /// Without what does not change its value: sums with 0, products with 0 and 1, double negation.
    pub(crate) fn simplified(&self) -> Expression {
        if let Some(value) = self.value().filter(|_| !self.is_boolean()) {
            return Expression::Number(value);
        }
        let Expression::Call(function, arguments) = self else {
            return match self {
                Expression::Piecewise(pairs, other) => Expression::Piecewise(
                    pairs
                        .iter()
                        .map(|(value, own)| (value.simplified(), own.simplified()))
                        .collect(),
                    other.as_ref().map(|other| Box::new(other.simplified())),
                ),
                other => other.clone(),
            };
        };
        let mut own: Vec<Expression> = arguments.iter().map(Expression::simplified).collect();
        let (zero, one) = (Expression::Number(0.0), Expression::Number(1.0));
        match (function, own.as_slice()) {
            (Function::Plus, _) => {
                own.retain(|part| *part != zero);
                if own.len() == 1 { own.remove(0) } else { Expression::Call(*function, own) }
            }
            (Function::Minus, [a, b]) if *b == zero => a.clone(),
            (Function::Minus, [a, b]) if *a == zero => b.clone().negative(),
            (Function::Times, all) if all.contains(&zero) => zero,
            (Function::Times, _) => {
                own.retain(|part| *part != one);
                match own.as_slice() {
                    [single] => single.clone(),
                    [Expression::Number(-1.0), other] => other.clone().negative(),
                    _ => Expression::Call(*function, own),
                }
            }
            (Function::Divide | Function::Power, [a, b]) if *b == one => a.clone(),
            _ => Expression::Call(*function, own),
        }
    }

    /// The number that it is, if it has no names in it.
    pub(crate) fn value(&self) -> Option<f64> {
        match self {
            Expression::Number(value) => Some(*value),
            Expression::Truth(value) => Some(f64::from(u8::from(*value))),
            Expression::Call(function, arguments) => {
                let values: Option<Vec<f64>> = arguments.iter().map(Expression::value).collect();
                function.value(&values?)
            }
            _ => None,
        }
    }
}
