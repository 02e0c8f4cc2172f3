//! Expressions as Modelica has them.

use super::{Expression, Function};
use crate::names::identifier;

/// What an expression is used as.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Context {
    Real,
    Boolean,
}

/// How tightly operators bind (MLS §3.2), from the loosest.
mod level {
    pub(super) const IF: u8 = 0;
    pub(super) const OR: u8 = 1;
    pub(super) const AND: u8 = 2;
    pub(super) const NOT: u8 = 3;
    pub(super) const RELATION: u8 = 4;
    pub(super) const SUM: u8 = 5;
    pub(super) const PRODUCT: u8 = 6;
    pub(super) const POWER: u8 = 7;
    pub(super) const PRIMARY: u8 = 8;
}

/// A number of Modelica: decimal, with an exponent where it is very small or large.
pub(crate) fn number(value: f64) -> String {
    let size = value.abs();
    match value {
        // What Modelica has no numbers for: the expressions give them.
        _ if value.is_nan() => "(0.0/0.0)".to_owned(),
        f64::INFINITY => "1e308*10".to_owned(),
        f64::NEG_INFINITY => "-1e308*10".to_owned(),
        _ if value == 0.0 || (1e-4..1e9).contains(&size) => value.to_string(),
        _ => format!("{value:e}"),
    }
}

/// An expression in Modelica.
pub(crate) fn printed(expression: &Expression, context: Context) -> String {
    text(expression, context, level::IF)
}

/// The text, in parentheses where it binds less tightly than `least`.
fn text(expression: &Expression, context: Context, least: u8) -> String {
    let (text, own) = match (context, expression.is_boolean()) {
        (Context::Real, true) => match expression {
            Expression::Piecewise(..) => bare(expression, Context::Real),
            Expression::Truth(value) => (u8::from(*value).to_string(), level::PRIMARY),
            _ => (format!("if {} then 1 else 0", bare(expression, Context::Boolean).0), level::IF),
        },
        (Context::Boolean, false) if !matches!(expression, Expression::Piecewise(..)) => {
            match expression {
                Expression::Number(value) => ((*value != 0.0).to_string(), level::PRIMARY),
                // Numbers that are not 0 are true.
                _ => (format!("abs({}) > 0", printed(expression, Context::Real)), level::RELATION),
            }
        }
        _ => bare(expression, context),
    };
    if own < least { format!("({text})") } else { text }
}

/// The text of an expression of the type of the context, and how tightly it binds.
fn bare(expression: &Expression, context: Context) -> (String, u8) {
    let real = |part: &Expression| printed(part, Context::Real);
    match expression {
        Expression::Number(value) => {
            let is_primary = *value >= 0.0 && value.is_finite() || value.is_nan();
            (number(*value), if is_primary { level::PRIMARY } else { level::SUM })
        }
        Expression::Truth(value) => (value.to_string(), level::PRIMARY),
        // A component of a model in Modelica.
        Expression::Name(name) if name.contains(['.', '[']) => (name.clone(), level::PRIMARY),
        Expression::Name(name) => (identifier(name), level::PRIMARY),
        Expression::Time => ("time".to_owned(), level::PRIMARY),
        Expression::Pre(name) => (format!("pre({})", identifier(name)), level::PRIMARY),
        Expression::Condition(text) => (text.clone(), level::PRIMARY),
        Expression::Derivative(own) => (format!("der({})", real(own)), level::PRIMARY),
        Expression::Delay(own) => {
            (format!("delay({}, {})", real(&own[0]), real(&own[1])), level::PRIMARY)
        }
        Expression::Piecewise(pairs, other) => piecewise(pairs, other.as_deref(), context),
        Expression::Call(function, arguments) => call(*function, arguments),
    }
}

fn piecewise(
    pairs: &[(Expression, Expression)],
    other: Option<&Expression>,
    context: Context,
) -> (String, u8) {
    let mut result = String::new();
    for (value, condition) in pairs {
        let condition = printed(condition, Context::Boolean);
        result += &format!("if {condition} then {} else", text(value, context, level::OR));
        result.push(' ');
    }
    // Without a last piece the value is undefined where no condition holds.
    let undefined = Expression::Number(f64::NAN);
    let other = other.unwrap_or(&undefined);
    result += &text(other, context, level::OR);
    let result = result.replace("else if ", "elseif ");
    (result, if pairs.is_empty() { level::OR } else { level::IF })
}

fn joined(arguments: &[Expression], context: Context, operator: &str, own: u8) -> (String, u8) {
    let parts: Vec<String> = arguments.iter().map(|part| text(part, context, own)).collect();
    (parts.join(operator), if parts.len() == 1 { level::IF } else { own })
}

fn call(function: Function, arguments: &[Expression]) -> (String, u8) {
    use Function as F;
    let real = |k: usize, least: u8| {
        arguments.get(k).map_or(String::new(), |part| text(part, Context::Real, least))
    };
    let boolean = |k: usize, least: u8| {
        arguments.get(k).map_or(String::new(), |part| text(part, Context::Boolean, least))
    };
    match function {
        F::Plus if arguments.is_empty() => ("0".to_owned(), level::PRIMARY),
        F::Times if arguments.is_empty() => ("1".to_owned(), level::PRIMARY),
        F::And if arguments.is_empty() => ("true".to_owned(), level::PRIMARY),
        F::Or | F::Xor if arguments.is_empty() => ("false".to_owned(), level::PRIMARY),
        // `a + (-b)` needs its parentheses, `-a + b` does not.
        F::Plus => sum(arguments),
        F::Minus if arguments.len() == 1 => (format!("-{}", real(0, level::PRODUCT)), level::SUM),
        F::Minus => (format!("{} - {}", real(0, level::SUM), real(1, level::PRODUCT)), level::SUM),
        F::Times => joined(arguments, Context::Real, "*", level::PRODUCT),
        F::Divide => {
            (format!("{}/{}", real(0, level::PRODUCT), real(1, level::POWER)), level::PRODUCT)
        }
        F::Power => {
            (format!("{}^{}", real(0, level::PRIMARY), real(1, level::PRIMARY)), level::POWER)
        }
        F::And => joined(arguments, Context::Boolean, " and ", level::AND),
        F::Or => joined(arguments, Context::Boolean, " or ", level::OR),
        F::Not => (format!("not {}", boolean(0, level::RELATION)), level::NOT),
        F::Implies => {
            let no = format!("not {}", boolean(0, level::RELATION));
            (format!("{no} or {}", boolean(1, level::AND)), level::OR)
        }
        F::Xor => xor(arguments),
        _ if function.is_relation() => relation(function, arguments),
        F::Quotient => (format!("div({}, {})", real(0, 0), real(1, 0)), level::PRIMARY),
        F::Remainder => (format!("rem({}, {})", real(0, 0), real(1, 0)), level::PRIMARY),
        F::Factorial => (format!("factorial({})", real(0, 0)), level::PRIMARY),
        F::Named("min" | "max") => (extreme(function, arguments), level::PRIMARY),
        F::Named(name) => (format!("{name}({})", real(0, 0)), level::PRIMARY),
        F::OfReciprocal(name) => (format!("{name}(1/{})", real(0, level::POWER)), level::PRIMARY),
        F::Reciprocal(name) => (format!("1/{name}({})", real(0, 0)), level::PRODUCT),
        F::ArcCot => (format!("atan(1/{})", real(0, level::POWER)), level::PRIMARY),
        _ => area(function, &real(0, level::POWER)),
    }
}

fn sum(arguments: &[Expression]) -> (String, u8) {
    let mut result = String::new();
    for (k, part) in arguments.iter().enumerate() {
        let least = if k == 0 { level::SUM } else { level::PRODUCT };
        let separator = if k == 0 { "" } else { " + " };
        result += &format!("{separator}{}", text(part, Context::Real, least));
    }
    (result, if arguments.len() == 1 { level::IF } else { level::SUM })
}

/// Inverse hyperbolic functions by logarithms.
fn area(function: Function, x: &str) -> (String, u8) {
    let text = match function {
        Function::ArSinh => format!("log({x} + sqrt({x}^2 + 1))"),
        Function::ArCosh => format!("log({x} + sqrt({x}^2 - 1))"),
        Function::ArTanh => return (format!("log((1 + {x})/(1 - {x}))/2"), level::PRODUCT),
        Function::ArCoth => return (format!("log(({x} + 1)/({x} - 1))/2"), level::PRODUCT),
        Function::ArSech => format!("log(1/{x} + sqrt(1/{x}^2 - 1))"),
        _ => format!("log(1/{x} + sqrt(1/{x}^2 + 1))"),
    };
    (text, level::PRIMARY)
}

/// `min` and `max` of Modelica have two arguments.
fn extreme(function: Function, arguments: &[Expression]) -> String {
    let Function::Named(name) = function else { return String::new() };
    let parts = arguments.iter().map(|part| printed(part, Context::Real));
    parts.reduce(|all, part| format!("{name}({all}, {part})")).unwrap_or_default()
}

/// An odd number of its arguments is true.
fn xor(arguments: &[Expression]) -> (String, u8) {
    let parts = arguments.iter().map(|part| text(part, Context::Boolean, level::SUM));
    let all = parts.reduce(|all, part| format!("({all} <> {part})")).unwrap_or_default();
    (all, level::PRIMARY)
}

/// Comparisons; each number with the next one.
fn relation(function: Function, arguments: &[Expression]) -> (String, u8) {
    let logical = arguments.iter().all(Expression::is_boolean);
    let pairs: Vec<(String, u8)> =
        arguments.windows(2).map(|pair| comparison(function, pair, logical)).collect();
    match pairs.as_slice() {
        [one] => one.clone(),
        pairs => {
            let parts: Vec<String> = pairs.iter().map(|(text, _)| format!("({text})")).collect();
            (parts.join(" and "), level::AND)
        }
    }
}

fn comparison(function: Function, pair: &[Expression], logical: bool) -> (String, u8) {
    let context = if logical { Context::Boolean } else { Context::Real };
    let part = |k: usize| text(&pair[k], context, level::SUM);
    let (a, b) = (part(0), part(1));
    let sign = match function {
        Function::Less => "<",
        Function::LessOrEqual => "<=",
        Function::Greater => ">",
        Function::GreaterOrEqual => ">=",
        Function::Equal if logical => "==",
        Function::NotEqual if logical => "<>",
        // Modelica compares Real numbers for equality in functions only (MLS §3.5).
        Function::Equal => return (format!("{a} >= {b} and {a} <= {b}"), level::AND),
        _ => return (format!("{a} > {b} or {a} < {b}"), level::OR),
    };
    (format!("{a} {sign} {b}"), level::RELATION)
}
