//! The values of calls.

use super::plan::{Argument, Element, Elements as Made, Pick, Plan};
use super::{Builtin, Meaning, Operator, PlanOf, scalars};
use crate::bail;
use crate::diag::Fault;
use crate::value::errors::TYPE_MISMATCH;
use crate::value::{ArrayValue, Elements, FromValue, Value, element_count, ops};

impl Builtin {
    /// The value of a call with these arguments.
    ///
    /// # Errors
    ///
    /// A wrong number of arguments, a wrong type, or values outside its domain; or it is an operator,
    /// which needs more than values.
    pub fn value(&self, arguments: &[Value]) -> Result<Value, Fault> {
        self.check_count(arguments.len())?;
        match self.meaning {
            Meaning::Mathematical(function) => scalars::call(function, arguments),
            Meaning::Reduction(reduction) => reduction.value(arguments),
            Meaning::Plan(plan, _) => self.planned_value(plan, arguments),
            Meaning::Operator(Operator::SemiLinear) => {
                scalars::each(self.name, arguments, &scalars::semi_linear)
            }
            Meaning::Operator(Operator::Ordinal) => {
                scalars::each(self.name, arguments, &scalars::ordinal)
            }
            Meaning::Operator(_) => bail!(TYPE_MISMATCH, "`{}` is an operator", self.name),
        }
    }

    fn planned_value(&self, plan: PlanOf, arguments: &[Value]) -> Result<Value, Fault> {
        let Meaning::Plan(_, known) = self.meaning else {
            bail!(TYPE_MISMATCH, "`{}` is not made of elements", self.name)
        };
        let mut described = Vec::with_capacity(arguments.len());
        for (at, argument) in arguments.iter().enumerate() {
            described.push(match known.contains(at) {
                true => Argument { dims: &[], number: i64::from_value(argument.clone())? },
                false => Argument { dims: argument.dims(), number: 0 },
            });
        }
        let plan = plan(&described)?;
        let count = element_count(&plan.dims)?;
        match &plan.elements {
            Made::Rearranged(argument, at) => rearranged(&plan, &arguments[*argument], count, at),
            Made::Same(value) => {
                ArrayValue::filled(plan.dims.clone(), &Value::Integer(*value)).map(Value::Array)
            }
            Made::Each(_) => self.computed(&plan, arguments, count),
        }
    }

    fn computed(&self, plan: &Plan, arguments: &[Value], count: usize) -> Result<Value, Fault> {
        let Meaning::Plan(_, known) = self.meaning else { return Ok(Value::Integer(0)) };
        let parts = arguments.iter().enumerate().filter(|(at, _)| !known.contains(*at));
        let mut elements = of_no_element(parts.map(|(_, part)| part));
        for at in 0..count {
            elements.push(&self.element(plan.element(at), arguments)?)?;
        }
        Ok(Value::Array(ArrayValue::new(plan.dims.clone(), elements)))
    }

    fn element(&self, element: Element, arguments: &[Value]) -> Result<Value, Fault> {
        let number = |pick: Pick| self.number(&arguments[pick.argument], pick.at);
        match element {
            Element::Integer(value) => Ok(Value::Integer(value)),
            Element::Of(pick) => Ok(picked(&arguments[pick.argument], pick.at)),
            Element::Negative(pick) => ops::negate(&number(pick)?),
            Element::Product(a, b) => ops::multiply(&number(a)?, &number(b)?),
            Element::Determinant([a, b], [c, d]) => {
                let first = ops::multiply(&number(a)?, &number(b)?)?;
                ops::subtract(&first, &ops::multiply(&number(c)?, &number(d)?)?)
            }
            Element::Between(a, b, numerator, denominator) => {
                let (a, b) = (f64::from_value(number(a)?)?, f64::from_value(number(b)?)?);
                Ok(Value::Real(a + (b - a) * numerator / denominator))
            }
        }
    }

    fn number(&self, argument: &Value, at: usize) -> Result<Value, Fault> {
        match picked(argument, at) {
            number @ (Value::Real(_) | Value::Integer(_)) => Ok(number),
            _ => {
                bail!(TYPE_MISMATCH, "`{}` needs numbers, got {}", self.name, argument.type_name())
            }
        }
    }
}

fn picked(argument: &Value, at: usize) -> Value {
    match argument {
        Value::Array(array) => array.elements.get(at),
        scalar => scalar.clone(),
    }
}

/// The elements of one argument at other places: of any type, copied at once.
fn rearranged(
    plan: &Plan,
    argument: &Value,
    count: usize,
    at: &dyn Fn(usize) -> usize,
) -> Result<Value, Fault> {
    let dims = plan.dims.clone();
    match argument {
        Value::Array(array) if dims.is_empty() => Ok(array.elements.get(at(0))),
        Value::Array(array) => {
            let elements = array.elements.gathered((0..count).map(at));
            Ok(Value::Array(ArrayValue::new(dims, elements)))
        }
        scalar if dims.is_empty() => Ok(scalar.clone()),
        scalar => ArrayValue::filled(dims, scalar).map(Value::Array),
    }
}

/// No element of the type that all parts have: Integer where there are none.
fn of_no_element<'v>(parts: impl Iterator<Item = &'v Value>) -> Elements {
    let mut all = parts.map(|part| match part {
        Value::Array(array) => array.elements.none_of_type(),
        scalar => Elements::repeated(scalar, 0).unwrap_or(Elements::Real(Vec::new())),
    });
    let Some(first) = all.next() else { return Elements::Integer(Vec::new()) };
    match all.any(|other| matches!(other, Elements::Real(_))) {
        true => first.promoted(),
        false => first,
    }
}
