//! The mathematical functions of the language (MLS §3.7.1 to §3.7.3, scalar Real arguments), one
//! table for scripts, constant folding, residuals and Jacobians alike.
//!
//! `ln` stands for `log`, as libraries before 2.0 of the language write it, and `RandomUniform` is theirs too. Functions of arrays and
//! operators with a meaning in time (`der`, `pre`, `noEvent` …) are not here.

use super::node::Expr;
use super::pool::Pool;
use rustc_hash::FxHashMap;
use std::sync::LazyLock;

mod elementary;
mod enumeration;
mod extremum;
mod hyperbolic;
mod random;
mod rounding;
mod trigonometric;

pub(crate) use enumeration::LITERAL_BY_NUMBER;
pub(crate) use rounding::{INTEGER_ARITHMETIC, LARGEST_INTEGER};

const FAMILIES: &[&[Function]] = &[
    elementary::FUNCTIONS,
    extremum::FUNCTIONS,
    hyperbolic::FUNCTIONS,
    rounding::FUNCTIONS,
    trigonometric::FUNCTIONS,
    random::FUNCTIONS,
    enumeration::FUNCTIONS,
];

/// One function of the table.
pub struct Function {
    /// Its name in Modelica.
    pub name: &'static str,
    /// Other names for the same function.
    pub aliases: &'static [&'static str],
    /// How its value is computed.
    pub value: Value,
    /// Builds the partial derivative for argument `which` (from 0), given all arguments.
    pub derivative: fn(pool: &mut Pool, arguments: &[Expr], which: usize) -> Expr,
    /// Where it has a value; `None` everywhere.
    pub domain: Option<Domain>,
    /// Whether finite arguments may have a value beyond the largest number, which is infinite then.
    pub overflows: bool,
    /// The type of its value.
    pub result: ResultType,
    /// Whether a jump of its value is a state event outside `noEvent` (MLS §3.7.2).
    pub(crate) event_generating: bool,
    /// Whether its derivative jumps, without an event.
    pub(crate) is_kinked: bool,
    /// The unit of its value.
    pub unit: UnitRule,
    /// The section of the MLS that defines it.
    pub section: &'static str,
}

impl Function {
    /// Whether its value or its derivative jumps inside a function, where there are no events.
    pub(crate) fn has_kinks(&self) -> bool {
        self.is_kinked || self.event_generating
    }
}

/// How a value is computed.
#[derive(Clone, Copy)]
pub enum Value {
    /// Of one argument.
    Unary(fn(f64) -> f64),
    /// Of two arguments.
    Binary(fn(f64, f64) -> f64),
}

/// Where a function has a value.
#[derive(Clone, Copy)]
pub struct Domain {
    /// Whether the arguments lie in it.
    pub contains: fn(&[f64]) -> bool,
    /// The condition in words, such as `the argument must be positive`.
    pub words: &'static str,
}

/// The type of a function's value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ResultType {
    /// Always Real.
    Real,
    /// Always Integer.
    Integer,
    /// Integer if all arguments are Integer, otherwise Real.
    AsArguments,
}

/// The unit of a value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum UnitRule {
    /// That of the argument at this position.
    As(usize),
    /// That of all arguments, which have the same.
    Common,
    /// A power of that of the first argument.
    Power(f64),
    /// That of the first argument over time.
    Rate,
    /// Nothing tells it.
    Unknown,
}

/// A function of the table.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, serde::Serialize)]
pub struct FunctionId(u16);

impl<'de> serde::Deserialize<'de> for FunctionId {
    fn deserialize<D: serde::Deserializer<'de>>(source: D) -> Result<FunctionId, D::Error> {
        let number = u16::deserialize(source)?;
        match usize::from(number) < TABLE.len() {
            true => Ok(FunctionId(number)),
            false => Err(serde::de::Error::custom("the table of functions is shorter")),
        }
    }
}

static TABLE: LazyLock<Vec<&'static Function>> =
    LazyLock::new(|| FAMILIES.iter().flat_map(|family| family.iter()).collect());

static BY_NAME: LazyLock<FxHashMap<&'static str, FunctionId>> = LazyLock::new(|| {
    let names = |(id, function): (u16, &&'static Function)| {
        let names = std::iter::once(function.name).chain(function.aliases.iter().copied());
        names.map(move |name| (name, FunctionId(id))).collect::<Vec<_>>()
    };
    (0..).zip(TABLE.iter()).flat_map(names).collect()
});

/// The table, in a fixed order.
pub fn functions() -> impl Iterator<Item = (FunctionId, &'static Function)> {
    (0..).map(FunctionId).zip(TABLE.iter().copied())
}

/// The function of this name or alias.
pub fn find(name: &str) -> Option<FunctionId> {
    BY_NAME.get(name).copied()
}

impl FunctionId {
    /// Its position in the table.
    pub(crate) fn index(self) -> usize {
        self.0 as usize
    }

    /// Its entry.
    pub fn get(self) -> &'static Function {
        TABLE[self.index()]
    }
}

impl Value {
    /// The value for as many arguments as the function takes; NaN for another number of them.
    pub fn of(self, arguments: &[f64]) -> f64 {
        match (self, arguments) {
            (Value::Unary(value), &[x]) => value(x),
            (Value::Binary(value), &[x, y]) => value(x, y),
            _ => f64::NAN,
        }
    }
}

impl Function {
    /// Number of arguments.
    pub(crate) fn arity(&self) -> usize {
        match self.value {
            Value::Unary(_) => 1,
            Value::Binary(_) => 2,
        }
    }

    /// Whether the arguments lie in the domain.
    pub fn accepts(&self, arguments: &[f64]) -> bool {
        self.domain.is_none_or(|domain| (domain.contains)(arguments))
    }
}

impl std::fmt::Debug for Function {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Function").field("name", &self.name).finish_non_exhaustive()
    }
}

/// A function of Reals without events and with a value everywhere, to be changed by its entry.
const fn real(
    name: &'static str,
    value: Value,
    derivative: fn(&mut Pool, &[Expr], usize) -> Expr,
) -> Function {
    Function {
        name,
        aliases: &[],
        value,
        derivative,
        domain: None,
        overflows: false,
        result: ResultType::Real,
        event_generating: false,
        is_kinked: false,
        unit: UnitRule::Unknown,
        section: "MLS §3.7.3",
    }
}

/// The derivative of a function that is constant between its jumps.
fn zero(pool: &mut Pool, _: &[Expr], _: usize) -> Expr {
    pool.constant(0.0)
}
