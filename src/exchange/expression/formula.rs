//! Formulas in tables of PEtab.

use super::{Expression, Function};

/// Functions of one argument, with their names in formulas and in Modelica.
const FUNCTIONS: &[(&str, Function)] = &[
    ("exp", Function::Named("exp")),
    ("ln", Function::Named("log")),
    ("log10", Function::Named("log10")),
    ("sqrt", Function::Named("sqrt")),
    ("abs", Function::Named("abs")),
    ("sign", Function::Named("sign")),
    ("floor", Function::Named("floor")),
    ("ceiling", Function::Named("ceil")),
    ("sin", Function::Named("sin")),
    ("cos", Function::Named("cos")),
    ("tan", Function::Named("tan")),
    ("sinh", Function::Named("sinh")),
    ("cosh", Function::Named("cosh")),
    ("tanh", Function::Named("tanh")),
    ("arcsin", Function::Named("asin")),
    ("arccos", Function::Named("acos")),
    ("arctan", Function::Named("atan")),
    ("asin", Function::Named("asin")),
    ("acos", Function::Named("acos")),
    ("atan", Function::Named("atan")),
];

/// A part of a formula.
#[derive(Debug, Clone, PartialEq)]
enum Token {
    Number(f64),
    Name(String),
    Sign(&'static str),
}

const SIGNS: &[&str] = &[
    "**", "&&", "||", "<=", ">=", "==", "!=", "+", "-", "*", "/", "^", "(", ")", ",", "<", ">", "!",
];

/// The expression of a formula.
///
/// # Errors
///
/// What is wrong with it, in words.
pub(crate) fn formula(text: &str) -> Result<Expression, String> {
    let tokens = tokens(text)?;
    let mut reader = Reader { tokens: &tokens, at: 0 };
    let own = reader.or()?;
    match reader.tokens.get(reader.at) {
        None => Ok(own),
        Some(token) => Err(format!("{} is not expected", words(token))),
    }
}

fn words(token: &Token) -> String {
    match token {
        Token::Number(value) => format!("`{value}`"),
        Token::Name(name) => format!("`{name}`"),
        Token::Sign(sign) => format!("`{sign}`"),
    }
}

fn tokens(text: &str) -> Result<Vec<Token>, String> {
    let mut rest = text.trim_start();
    let mut tokens = Vec::new();
    while let Some(first) = rest.chars().next() {
        let length = if first.is_ascii_digit() || first == '.' {
            let length = number_length(rest);
            let value = rest[..length]
                .parse()
                .map_err(|_| format!("`{}` is not a number", &rest[..length]))?;
            tokens.push(Token::Number(value));
            length
        } else if first.is_alphabetic() || first == '_' {
            let end = rest.find(|c: char| !(c.is_alphanumeric() || c == '_'));
            let name = &rest[..end.unwrap_or(rest.len())];
            tokens.push(Token::Name(name.to_owned()));
            name.len()
        } else {
            let sign = SIGNS.iter().find(|sign| rest.starts_with(**sign));
            let sign = sign.ok_or_else(|| format!("`{first}` is not expected"))?;
            tokens.push(Token::Sign(sign));
            sign.len()
        };
        rest = rest[length..].trim_start();
    }
    Ok(tokens)
}

/// The length of the number that a text begins with.
fn number_length(text: &str) -> usize {
    let bytes = text.as_bytes();
    let digits = |from: usize| bytes[from..].iter().take_while(|b| b.is_ascii_digit()).count();
    let mut end = digits(0);
    if bytes.get(end) == Some(&b'.') {
        end += 1 + digits(end + 1);
    }
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
        let exponent = digits((end + 1 + sign).min(bytes.len()));
        if exponent > 0 {
            end += 1 + sign + exponent;
        }
    }
    end
}

/// Reads tokens by recursive descent.
struct Reader<'a> {
    tokens: &'a [Token],
    at: usize,
}

impl Reader<'_> {
    fn takes(&mut self, signs: &[&str]) -> Option<String> {
        let found = match self.tokens.get(self.at)? {
            Token::Sign(sign) if signs.contains(sign) => (*sign).to_owned(),
            Token::Name(name) if signs.contains(&name.as_str()) => name.clone(),
            _ => return None,
        };
        self.at += 1;
        Some(found)
    }

    fn expects(&mut self, sign: &str) -> Result<(), String> {
        self.takes(&[sign]).map(|_| ()).ok_or_else(|| format!("`{sign}` is missing"))
    }

    fn or(&mut self) -> Result<Expression, String> {
        let mut own = self.and()?;
        while self.takes(&["||", "or"]).is_some() {
            own = Expression::call(Function::Or, vec![own, self.and()?]);
        }
        Ok(own)
    }

    fn and(&mut self) -> Result<Expression, String> {
        let mut own = self.relation()?;
        while self.takes(&["&&", "and"]).is_some() {
            own = Expression::call(Function::And, vec![own, self.relation()?]);
        }
        Ok(own)
    }

    fn relation(&mut self) -> Result<Expression, String> {
        let own = self.sum()?;
        let Some(sign) = self.takes(&["<", "<=", ">", ">=", "==", "!="]) else { return Ok(own) };
        let function = match sign.as_str() {
            "<" => Function::Less,
            "<=" => Function::LessOrEqual,
            ">" => Function::Greater,
            ">=" => Function::GreaterOrEqual,
            "==" => Function::Equal,
            _ => Function::NotEqual,
        };
        Ok(Expression::call(function, vec![own, self.sum()?]))
    }

    fn sum(&mut self) -> Result<Expression, String> {
        let mut own = self.product()?;
        while let Some(sign) = self.takes(&["+", "-"]) {
            let function = if sign == "+" { Function::Plus } else { Function::Minus };
            own = Expression::call(function, vec![own, self.product()?]);
        }
        Ok(own)
    }

    fn product(&mut self) -> Result<Expression, String> {
        let mut own = self.signed()?;
        while let Some(sign) = self.takes(&["*", "/"]) {
            let function = if sign == "*" { Function::Times } else { Function::Divide };
            own = Expression::call(function, vec![own, self.signed()?]);
        }
        Ok(own)
    }

    fn signed(&mut self) -> Result<Expression, String> {
        match self.takes(&["-", "+", "!", "not"]).as_deref() {
            Some("-") => Ok(self.signed()?.negative()),
            Some("+") => self.signed(),
            Some(_) => Ok(Expression::call(Function::Not, vec![self.signed()?])),
            None => self.power(),
        }
    }

    /// Powers bind more tightly than signs before them, and from the right.
    fn power(&mut self) -> Result<Expression, String> {
        let own = self.primary()?;
        match self.takes(&["^", "**"]) {
            None => Ok(own),
            Some(_) => Ok(Expression::call(Function::Power, vec![own, self.signed()?])),
        }
    }

    fn primary(&mut self) -> Result<Expression, String> {
        let Some(token) = self.tokens.get(self.at) else {
            return Err("the formula is incomplete".to_owned());
        };
        self.at += 1;
        match token {
            Token::Number(value) => Ok(Expression::Number(*value)),
            Token::Sign("(") => {
                let own = self.or()?;
                self.expects(")").map(|()| own)
            }
            Token::Sign(sign) => Err(format!("`{sign}` is not expected")),
            Token::Name(name) if self.takes(&["("]).is_some() => {
                let arguments = self.arguments()?;
                call(name, arguments)
            }
            Token::Name(name) => Ok(match name.as_str() {
                "time" => Expression::Time,
                "true" | "True" => Expression::Truth(true),
                "false" | "False" => Expression::Truth(false),
                "pi" => Expression::Number(std::f64::consts::PI),
                "inf" => Expression::Number(f64::INFINITY),
                name => Expression::name(name),
            }),
        }
    }

    fn arguments(&mut self) -> Result<Vec<Expression>, String> {
        let mut all = vec![self.or()?];
        while self.takes(&[","]).is_some() {
            all.push(self.or()?);
        }
        self.expects(")").map(|()| all)
    }
}

fn call(name: &str, mut arguments: Vec<Expression>) -> Result<Expression, String> {
    let natural = |own: Expression| Expression::call(Function::Named("log"), vec![own]);
    let own =
        |function: Function, arguments: Vec<Expression>| Expression::call(function, arguments);
    Ok(match (name, arguments.len()) {
        ("pow", 2) => own(Function::Power, arguments),
        ("min", 1..) => own(Function::Named("min"), arguments),
        ("max", 1..) => own(Function::Named("max"), arguments),
        ("log", 1) => natural(arguments.remove(0)),
        ("log", 2) => {
            let value = natural(arguments.remove(0));
            value.over(natural(arguments.remove(0)))
        }
        ("log2", 1) => natural(arguments.remove(0)).over(natural(Expression::Number(2.0))),
        ("piecewise", 2..) => {
            let other = (arguments.len() % 2 == 1).then(|| arguments.pop().map(Box::new)).flatten();
            let pairs = arguments.chunks(2).map(|pair| (pair[0].clone(), pair[1].clone()));
            Expression::Piecewise(pairs.collect(), other)
        }
        (name, 1) => {
            let known = FUNCTIONS.iter().find(|(known, _)| *known == name);
            let (_, function) =
                known.ok_or_else(|| format!("the function `{name}` is not supported"))?;
            own(*function, arguments)
        }
        (name, count) => return Err(format!("`{name}` with {count} arguments is not supported")),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expression::{Context, printed};

    #[test]
    fn formulas_are_printed_with_the_same_meaning() {
        for (text, expected) in [
            ("a - (b - c)", "a - (b - c)"),
            ("-a^2", "-a^2"),
            ("(-a)^2", "(-a)^2"),
            ("a/(b*c)", "a/(b*c)"),
            ("a/b/c", "a/b/c"),
            ("2^-b", "2^(-b)"),
            ("a**b**c", "a^(b^c)"),
            ("log10(a) + ln(b)", "log10(a) + log(b)"),
            ("log(a, 2)", "log(a)/log(2)"),
            ("piecewise(1, a < 2, 3)", "if a < 2 then 1 else 3"),
            ("2*piecewise(1, a < 2 && b > 1, 3)", "2*(if a < 2 and b > 1 then 1 else 3)"),
            ("1.5e-3*time", "0.0015*time"),
            ("end + der", "'end' + 'der'"),
        ] {
            let own = formula(text).unwrap();
            assert_eq!(printed(&own, Context::Real), expected, "{text}");
        }
    }

    #[test]
    fn what_is_not_a_formula_is_refused() {
        for text in ["", "a +", "a b", "(a", "f(a)", "1.2.3", "a $ b", "min()"] {
            assert!(formula(text).is_err(), "{text}");
        }
    }

    #[test]
    fn simplified_formulas_have_no_zeros_and_ones() {
        for (text, expected) in [
            ("a + 0", "a"),
            ("1*a*1", "a"),
            ("0*a + b", "b"),
            ("a/1 - 0", "a"),
            ("2*3 + a", "6 + a"),
        ] {
            let own = formula(text).unwrap().simplified();
            assert_eq!(printed(&own, Context::Real), expected, "{text}");
        }
    }
}
