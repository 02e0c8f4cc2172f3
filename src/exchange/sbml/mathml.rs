//! Expressions in MathML 2.0, as far as SBML has it.

use super::element::{Element, number};
use crate::Refusal;
use crate::diag::Fault;
use crate::expression::{Expression, Function};
use crate::registry::BAD_OPTION;
use std::cell::Cell;
use std::collections::BTreeMap;
use std::rc::Rc;

/// The Avogadro constant that SBML prescribes, that of 2006.
const AVOGADRO: f64 = 6.022_141_79e23;

/// The definition of a function.
#[derive(Debug, Clone)]
pub(super) struct Lambda {
    pub(super) arguments: Vec<String>,
    /// `None` where the definition has no mathematics.
    pub(super) body: Option<Expression>,
}

/// Most parts that all calls of defined functions in a document may become, and rules in place of names. In the
/// benchmark collection of PEtab and in the semantic suite of SBML functions become 300 at most.
pub(super) const MOST_PARTS: usize = 1_000_000;

/// What names in mathematics mean.
#[derive(Debug, Clone, Default)]
pub(super) struct Scope {
    /// How many parts the calls of functions have become.
    parts: Rc<Cell<usize>>,
    /// The functions that are defined.
    pub(super) functions: BTreeMap<String, Lambda>,
    /// Local names, with the names that they have in the model.
    pub(super) local: BTreeMap<String, String>,
}

/// The expression in the `math` element of `owner`, if it has one.
pub(super) fn math(owner: &Element<'_, '_>, scope: &Scope) -> Result<Option<Expression>, Refusal> {
    let Some(math) = owner.child("math") else { return Ok(None) };
    let first = math.children().next();
    first.map(|first| expression(&first, scope)).transpose()
}

/// The function in the `math` element of a definition.
pub(super) fn lambda(owner: &Element<'_, '_>, scope: &Scope) -> Result<Lambda, Refusal> {
    let mut own = owner.child("math").and_then(|math| math.children().next());
    while let Some(semantics) = own.filter(|own| own.name() == "semantics") {
        own = semantics.children().next();
    }
    let empty = Lambda { arguments: Vec::new(), body: None };
    let Some(own) = own else { return Ok(empty) };
    if own.name() != "lambda" {
        return Err(own.wrong("the mathematics of a function definition is not a `lambda`"));
    }
    let (mut arguments, mut body) = (Vec::new(), None);
    for child in own.children() {
        match child.name() {
            "bvar" => arguments.push(child.words()),
            _ => body = Some(expression(&child, scope)?),
        }
    }
    Ok(Lambda { arguments, body })
}

fn expression(own: &Element<'_, '_>, scope: &Scope) -> Result<Expression, Refusal> {
    Ok(match own.name() {
        "cn" => Expression::Number(literal(own)?),
        "ci" => {
            let name = own.words();
            Expression::Name(scope.local.get(&name).cloned().unwrap_or(name))
        }
        "csymbol" => symbol(own)?,
        "true" => Expression::Truth(true),
        "false" => Expression::Truth(false),
        "pi" => Expression::Number(std::f64::consts::PI),
        "exponentiale" => Expression::Number(std::f64::consts::E),
        "infinity" => Expression::Number(f64::INFINITY),
        "notanumber" => Expression::Number(f64::NAN),
        "piecewise" => piecewise(own, scope)?,
        "apply" => apply(own, scope)?,
        "semantics" => match own.children().next() {
            Some(first) => expression(&first, scope)?,
            None => return Err(own.wrong("`semantics` is empty")),
        },
        other => return Err(own.unsupported(&format!("the element `{other}` of MathML"))),
    })
}

fn literal(own: &Element<'_, '_>) -> Result<f64, Refusal> {
    let parts: Vec<&str> = own
        .0
        .children()
        .filter_map(|node| node.text())
        .map(str::trim)
        .filter(|t| !t.is_empty())
        .collect();
    let kind = own.get("type").unwrap_or("real");
    let value = match (kind, parts.as_slice()) {
        ("e-notation", [mantissa, exponent]) => number(&format!("{mantissa}e{exponent}")),
        ("rational", [above, below]) => number(above).zip(number(below)).map(|(a, b)| a / b),
        ("real" | "integer", [one]) => number(one),
        _ => None,
    };
    value.ok_or_else(|| own.wrong(format!("`{}` is not a number of type `{kind}`", own.words())))
}

/// A symbol of SBML that is not applied.
fn symbol(own: &Element<'_, '_>) -> Result<Expression, Refusal> {
    match meaning(own) {
        "time" => Ok(Expression::Time),
        "avogadro" => Ok(Expression::Number(AVOGADRO)),
        _ => Err(own.unsupported(&format!("the symbol `{}`", own.words()))),
    }
}

/// The end of its URL.
fn meaning<'a>(own: &Element<'a, '_>) -> &'a str {
    own.get("definitionURL").unwrap_or_default().rsplit('/').next().unwrap_or_default()
}

fn piecewise(own: &Element<'_, '_>, scope: &Scope) -> Result<Expression, Refusal> {
    let (mut pairs, mut other) = (Vec::new(), None);
    for child in own.children() {
        let parts: Vec<Expression> =
            child.children().map(|part| expression(&part, scope)).collect::<Result<_, _>>()?;
        match (child.name(), parts.as_slice()) {
            ("piece", [value, condition]) => pairs.push((value.clone(), condition.clone())),
            ("otherwise", [value]) => other = Some(Box::new(value.clone())),
            _ => {
                return Err(
                    child.wrong("a piece has a value and a condition, the last one a value")
                );
            }
        }
    }
    Ok(match (pairs.is_empty(), other) {
        (true, Some(other)) => *other,
        (_, other) => Expression::Piecewise(pairs, other),
    })
}

fn apply(own: &Element<'_, '_>, scope: &Scope) -> Result<Expression, Refusal> {
    let mut children = own.children();
    let Some(head) = children.next() else { return Err(own.wrong("`apply` is empty")) };
    let is_setting = |part: &Element<'_, '_>| ["degree", "logbase"].contains(&part.name());
    let (settings, operands): (Vec<_>, Vec<_>) = children.partition(is_setting);
    let arguments: Vec<Expression> =
        operands.iter().map(|part| expression(part, scope)).collect::<Result<_, _>>()?;
    let setting = settings.first().and_then(|setting| setting.children().next());
    let setting = setting.map(|setting| expression(&setting, scope)).transpose()?;
    match (head.name(), arguments.as_slice()) {
        // Parentheses, which MathML does not have, but models do.
        ("apply", []) => expression(&head, scope),
        ("ci", _) => called(&head, arguments, scope),
        ("csymbol", [own]) if meaning(&head) == "rateOf" => {
            Ok(Expression::Derivative(Box::new(own.clone())))
        }
        ("csymbol", [own, delay]) if meaning(&head) == "delay" => {
            Ok(Expression::Delay(Box::new([own.clone(), delay.clone()])))
        }
        ("csymbol", _) => Err(head.unsupported(&format!("the symbol `{}`", head.words()))),
        ("root", [own]) => Ok(root(own.clone(), setting)),
        ("log", [own]) => Ok(logarithm(own.clone(), setting)),
        (name, _) => {
            let function = Function::of_mathml(name);
            let unknown = || head.unsupported(&format!("the function `{name}` of MathML"));
            let function = function.ok_or_else(unknown)?;
            let (least, most) = function.arity();
            if !(least..=most).contains(&arguments.len()) {
                return Err(own.wrong(format!("`{name}` has {} arguments", arguments.len())));
            }
            Ok(Expression::Call(function, arguments))
        }
    }
}

fn root(own: Expression, degree: Option<Expression>) -> Expression {
    match degree {
        None | Some(Expression::Number(2.0)) => {
            Expression::call(Function::Named("sqrt"), vec![own])
        }
        Some(degree) => {
            let exponent = Expression::Number(1.0).over(degree);
            Expression::call(Function::Power, vec![own, exponent])
        }
    }
}

fn logarithm(own: Expression, base: Option<Expression>) -> Expression {
    let natural = |own: Expression| Expression::call(Function::Named("log"), vec![own]);
    match base {
        None | Some(Expression::Number(10.0)) => {
            Expression::call(Function::Named("log10"), vec![own])
        }
        Some(base) => natural(own).over(natural(base)),
    }
}

/// A call of a defined function: its body with the arguments.
fn called(
    head: &Element<'_, '_>,
    arguments: Vec<Expression>,
    scope: &Scope,
) -> Result<Expression, Refusal> {
    let name = head.words();
    let Some(own) = scope.functions.get(&name) else {
        return Err(head.wrong(format!("no function `{name}` is defined before")));
    };
    if own.arguments.len() != arguments.len() {
        let count = own.arguments.len();
        return Err(head.wrong(format!("`{name}` has {count} arguments, not {}", arguments.len())));
    }
    let Some(body) = &own.body else {
        return Err(head.wrong(format!("the function `{name}` has no mathematics")));
    };
    let values = own.arguments.iter().cloned().zip(arguments).collect();
    let size = scope.parts.get().saturating_add(body.size_with(&values));
    scope.parts.set(size);
    if size > MOST_PARTS {
        let message = format!("calls of `{name}` and other functions become too many terms");
        let fault = Fault::new(BAD_OPTION, message)
            .help("function definitions that call each other multiply: write fewer of them");
        return Err(head.refusal(fault));
    }
    Ok(body.substituted(&values))
}
