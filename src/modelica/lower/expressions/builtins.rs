//! Calls of the functions and operators of the language, each by its entry in
//! [`functions`](crate::functions).

use super::records::{arrays, field, string_arrays, string_value};
use super::{Array, Binary, ClockedCall, Lowered, Lowering, Target, Unary, placed, size_fault};
use crate::diag::{Diagnostic, Fault, suggest};
use crate::eval::ValueType;
use crate::fault;
use crate::functions::{
    self, Argument, Builtin, Clocked, Element, Known, Meaning, Operator, Plan, PlanOf, Reduction,
    Temporal,
};
use crate::lower::errors::{ARRAY_MISMATCH, NOT_SUPPORTED, UNRESOLVED_REFERENCE};
use crate::lower::shape::UNKNOWN_TEXT;
use crate::lower::string_array::StringArray;
use crate::name::Name;
use crate::source::Span;
use crate::symbolic::RelationOperator;
use crate::symbolic::function::{self, FunctionId};
use crate::syntax::ast::{Arguments, ComponentReference, Expression, ExpressionKind};
use crate::value::Value;

impl<T: Target> Lowering<'_, T> {
    /// A call of the function of the language that has this name.
    pub(super) fn builtin_call(
        &mut self,
        name: &str,
        callee: &ComponentReference,
        arguments: &Arguments,
        span: Span,
    ) -> Result<Lowered<T::Scalar>, Diagnostic> {
        let Some(entry) = functions::find(name) else {
            return Err(fault!(UNRESOLVED_REFERENCE, "there is no function `{name}`")
                .help_if(suggest::did_you_mean(name, functions::names()))
                .at(span));
        };
        if let Meaning::Operator(Operator::Text) = entry.meaning {
            let text = self.string_operator(callee, arguments, span);
            return match self.composes && text.contains(UNKNOWN_TEXT) {
                true => self.composed_string(arguments, span),
                false => Ok(Lowered::Text(text)),
            };
        }
        if let Meaning::Reduction(reduction) = entry.meaning
            && (!arguments.iterators.is_empty() || arguments.positional.len() == 1)
        {
            return self.reduction(reduction, arguments, span).map(Lowered::Array);
        }
        if let Meaning::Operator(Operator::InTime(operator)) = entry.meaning
            && let Some(clocked) = on_clocks(operator)
        {
            let count = arguments.positional.len() + arguments.named.len();
            entry.check_count(count).map_err(|fault| mismatch(fault, span))?;
            self.target.begin_temporal(entry, operator, span)?;
            let positional = arguments.positional.iter().map(|argument| self.lower(argument));
            let positional = positional.collect::<Result<Vec<_>, _>>()?;
            let named = arguments.named.iter();
            let named = named.map(|named| Ok((named.name.node, self.lower(&named.value)?)));
            let named = named.collect::<Result<Vec<_>, Diagnostic>>()?;
            return self.target.clocked(entry, clocked, ClockedCall { positional, named }, span);
        }
        self.builtin(entry, &placed::of_operator(entry, arguments), span)
    }

    /// All outputs of an operator of the language that has several: `spatialDistribution`.
    pub(in crate::lower) fn builtin_outputs(
        &mut self,
        name: &str,
        callee: &ComponentReference,
        arguments: &Arguments,
        span: Span,
    ) -> Result<Vec<Lowered<T::Scalar>>, Diagnostic> {
        match functions::find(name) {
            Some(entry) if entry.is_spatial_distribution() => {
                let placed = placed::of_operator(entry, arguments);
                entry.check_count(placed.len()).map_err(|fault| mismatch(fault, span))?;
                let values = placed.iter().map(|a| self.array(a)).collect::<Result<Vec<_>, _>>()?;
                let outputs = self.target.spatial_distribution(&values, span)?;
                Ok(outputs.into_iter().map(Lowered::scalar).collect())
            }
            Some(_) => self.builtin_call(name, callee, arguments, span).map(|one| vec![one]),
            None => {
                Err(fault!(UNRESOLVED_REFERENCE, "there is no function `{name}`").at(callee.span))
            }
        }
    }

    /// A call with the arguments in their places.
    pub(super) fn builtin(
        &mut self,
        entry: &'static Builtin,
        arguments: &[Expression],
        span: Span,
    ) -> Result<Lowered<T::Scalar>, Diagnostic> {
        entry.check_count(arguments.len()).map_err(|fault| mismatch(fault, span))?;
        match entry.meaning {
            Meaning::Mathematical(id) => self.of_scalars(id, arguments, span),
            Meaning::Plan(plan, known) => {
                let exact = known == Known::Nothing && self.are_integers(arguments);
                self.planned(plan, known, arguments, exact, span)
            }
            Meaning::Reduction(reduction) => match function::find(reduction.name()) {
                Some(id) => self.of_scalars(id, arguments, span),
                None => Err(fault!(ARRAY_MISMATCH, "`{}` takes one array", entry.name).at(span)),
            },
            Meaning::Operator(operator) => self.operator(entry, operator, arguments, span),
        }
    }

    /// An operator with as many arguments as it takes.
    fn operator(
        &mut self,
        entry: &'static Builtin,
        operator: Operator,
        arguments: &[Expression],
        span: Span,
    ) -> Result<Lowered<T::Scalar>, Diagnostic> {
        match (operator, arguments) {
            (Operator::Size, _) => self.size(arguments, span).map(Lowered::Array),
            (Operator::NumberOfDimensions, [array]) => {
                let rank = match self.lower(array)? {
                    Lowered::Strings(strings) => strings.dims.len(),
                    Lowered::Text(_) => 0,
                    _ => self.array(array)?.dims.len(),
                };
                Ok(Lowered::scalar(self.target.constant(rank as f64)))
            }
            (Operator::Ordinal, [value]) => self.array(value).map(Lowered::Array),
            (Operator::Pure, [value]) => self.lower(value),
            (Operator::NoEvent, [value]) => self.without_events(value),
            // What is continuous alone still has kinks, which no step and no iteration may pass.
            (Operator::Smooth, [order, value]) if order.kind == ExpressionKind::Integer(0) => {
                self.lower(value)
            }
            (Operator::Smooth, [_, value]) => self.without_events(value),
            (Operator::Homotopy, [actual, simplified]) => {
                let (actual, simplified) = (self.array(actual)?, self.array(simplified)?);
                self.homotopy(actual, simplified, span)
            }
            (Operator::SemiLinear, _) => self.semi_linear(arguments, span),
            (Operator::InTime(operator), _) => self.in_time(entry, operator, arguments, span),
            _ => Err(fault!(NOT_SUPPORTED, "`{}` in an expression", entry.name).at(span)),
        }
    }

    /// A value whose relations are evaluated as they are.
    fn without_events(&mut self, value: &Expression) -> Result<Lowered<T::Scalar>, Diagnostic> {
        let before = std::mem::replace(&mut self.live, true);
        let value = self.lower(value);
        self.live = before;
        value
    }

    fn in_time(
        &mut self,
        entry: &'static Builtin,
        operator: Temporal,
        arguments: &[Expression],
        span: Span,
    ) -> Result<Lowered<T::Scalar>, Diagnostic> {
        self.target.begin_temporal(entry, operator, span)?;
        if let (Temporal::Pre | Temporal::Change, [text]) = (operator, arguments)
            && let Lowered::Numbered(text) = self.lower(text)?
        {
            let text = vec![Array::scalar(text)];
            let value = self.target.temporal(entry, operator, text, self.live, span)?.elements[0];
            return Ok(match operator {
                Temporal::Pre => Lowered::Numbered(value),
                _ => Lowered::scalar(value),
            });
        }
        let values = arguments.iter().map(|a| self.array(a)).collect::<Result<_, _>>()?;
        self.target.temporal(entry, operator, values, self.live, span).map(Lowered::Array)
    }

    /// An array made by a plan; of records, which are records of arrays, field by field.
    fn planned(
        &mut self,
        plan: PlanOf,
        known: Known,
        arguments: &[Expression],
        exact: bool,
        span: Span,
    ) -> Result<Lowered<T::Scalar>, Diagnostic> {
        let mut numbers = Vec::with_capacity(arguments.len());
        let mut values = Vec::new();
        for (at, argument) in arguments.iter().enumerate() {
            numbers.push(match known.contains(at) {
                true => Some(self.known_size(argument)? as i64),
                false => {
                    values.push(self.lower(argument)?);
                    None
                }
            });
        }
        if values.is_empty() {
            return self.made(plan, &numbers, &[], false, span).map(Lowered::Array);
        }
        self.by_fields(&values, span, &mut |lowering, arrays| {
            lowering.made(plan, &numbers, &arrays, exact, span)
        })
    }

    fn by_fields(
        &mut self,
        values: &[Lowered<T::Scalar>],
        span: Span,
        make: &mut Make<'_, Self, T::Scalar>,
    ) -> Result<Lowered<T::Scalar>, Diagnostic> {
        if let Some(Lowered::Record(first)) = values.first() {
            let mut fields = Vec::with_capacity(first.len());
            for (name, _) in first {
                let of_all = values.iter().map(|value| field(value.clone(), *name, span));
                let of_all = of_all.collect::<Result<Vec<_>, _>>()?;
                fields.push((*name, self.by_fields(&of_all, span, make)?));
            }
            return Ok(Lowered::Record(fields));
        }
        if let Some(strings) = string_arrays(values) {
            return self.arranged_strings(&strings, make);
        }
        let arrays = arrays(values.to_vec(), span)?;
        make(self, arrays).map(Lowered::Array)
    }

    /// Strings at the positions that a plan gives to the numbers that stand for them.
    fn arranged_strings(
        &mut self,
        values: &[StringArray],
        make: &mut Make<'_, Self, T::Scalar>,
    ) -> Result<Lowered<T::Scalar>, Diagnostic> {
        let mut table = Vec::new();
        let mut arrays = Vec::with_capacity(values.len());
        for value in values {
            let first = table.len();
            table.extend(value.strings.iter().cloned());
            let elements = (first..table.len()).map(|at| self.target.constant(at as f64)).collect();
            arrays.push(Array { dims: value.dims.clone(), elements });
        }
        let Array { dims, elements } = make(self, arrays)?;
        let text = |number| self.target.as_constant(number).and_then(|at| table.get(at as usize));
        let strings = elements
            .into_iter()
            .map(|number| text(number).cloned().unwrap_or_else(|| UNKNOWN_TEXT.into()));
        Ok(string_value(StringArray { dims, strings: strings.collect() }))
    }

    /// The array of a plan; `numbers` are the arguments that it depends on, `arrays` the others.
    fn made(
        &mut self,
        plan: PlanOf,
        numbers: &[Option<i64>],
        arrays: &[Array<T::Scalar>],
        exact: bool,
        span: Span,
    ) -> Result<Array<T::Scalar>, Diagnostic> {
        let mut rest = arrays.iter();
        let values: Vec<Option<&Array<T::Scalar>>> =
            numbers.iter().map(|number| number.map_or_else(|| rest.next(), |_| None)).collect();
        let described = values.iter().zip(numbers).map(|(value, number)| Argument {
            dims: value.map_or(&[], |value| value.dims.as_slice()),
            number: number.unwrap_or(0),
        });
        let plan = plan(&described.collect::<Vec<_>>()).map_err(|fault| mismatch(fault, span))?;
        self.elements_of_plan(plan, &values, exact, span)
    }

    /// The array of a plan of these arguments; `exact` if these are Integers.
    pub(super) fn elements_of_plan(
        &mut self,
        plan: Plan,
        values: &[Option<&Array<T::Scalar>>],
        exact: bool,
        span: Span,
    ) -> Result<Array<T::Scalar>, Diagnostic> {
        let count = match plan.count() {
            Some(count) if count <= super::MAX_SCALARS => count,
            _ => return Err(fault!(ARRAY_MISMATCH, "an array of too many elements").at(span)),
        };
        let mut elements = Vec::with_capacity(count);
        for at in 0..count {
            elements.push(match plan.element(at) {
                Element::Product(a, b) if exact => self.exact_product(a, b, values, span)?,
                Element::Determinant([a, b], [c, d]) if exact => {
                    let plus = self.exact_product(a, b, values, span)?;
                    let minus = self.exact_product(c, d, values, span)?;
                    let difference = self.target.binary(Binary::Sub, plus, minus);
                    self.exact(Array::scalar(difference), span)?.elements[0]
                }
                element => self.element_of_plan(element, values),
            });
        }
        Ok(Array { dims: plan.dims, elements })
    }

    /// A product of Integers.
    fn exact_product(
        &mut self,
        a: functions::Pick,
        b: functions::Pick,
        values: &[Option<&Array<T::Scalar>>],
        span: Span,
    ) -> Result<T::Scalar, Diagnostic> {
        let product = self.element_of_plan(Element::Product(a, b), values);
        Ok(self.exact(Array::scalar(product), span)?.elements[0])
    }

    fn element_of_plan(
        &mut self,
        element: Element,
        values: &[Option<&Array<T::Scalar>>],
    ) -> T::Scalar {
        let zero = self.target.constant(0.0);
        let of = |pick: functions::Pick| {
            values[pick.argument].map_or(zero, |array| array.elements[pick.at])
        };
        let target = &mut *self.target;
        match element {
            Element::Integer(0) => zero,
            Element::Integer(value) => target.constant(value as f64),
            Element::Of(pick) => of(pick),
            Element::Negative(pick) => target.unary(Unary::Neg, of(pick)),
            Element::Product(a, b) => target.binary(Binary::Mul, of(a), of(b)),
            Element::Determinant([a, b], [c, d]) => {
                let plus = target.binary(Binary::Mul, of(a), of(b));
                let minus = target.binary(Binary::Mul, of(c), of(d));
                target.binary(Binary::Sub, plus, minus)
            }
            Element::Between(a, b, numerator, denominator) => {
                let width = target.binary(Binary::Sub, of(b), of(a));
                let (numerator, denominator) =
                    (target.constant(numerator), target.constant(denominator));
                let part = target.binary(Binary::Mul, width, numerator);
                let part = target.binary(Binary::Div, part, denominator);
                target.binary(Binary::Add, of(a), part)
            }
        }
    }

    fn reduction(
        &mut self,
        reduction: Reduction,
        arguments: &Arguments,
        span: Span,
    ) -> Result<Array<T::Scalar>, Diagnostic> {
        let name = reduction.name();
        let [element] = arguments.positional.as_slice() else {
            return Err(fault!(ARRAY_MISMATCH, "`{name}` takes one array").at(span));
        };
        let iterators = arguments.iterators.as_slice();
        if iterators.is_empty() {
            let elements = self.array(element)?.elements;
            let is_integer = elements.len() != 1 && self.is_integer(name, arguments, span);
            return self.reduced(reduction, arguments, &elements, is_integer, span);
        }
        let is_integer = self.is_integer(name, arguments, span);
        let counted = self.counted_reduction(reduction, element, arguments, is_integer, span)?;
        if let Some(value) = counted {
            return Ok(Array::scalar(value));
        }
        let all = self.reduction_elements(element, iterators)?;
        let dims = all.first().map_or_else(|| element.written_sizes(), |one| one.dims.clone());
        if let Some(other) = all.iter().find(|one| one.dims != dims) {
            return Err(size_fault(&dims, &other.dims).at(span));
        }
        let elements: Vec<T::Scalar> = all.into_iter().flat_map(|one| one.elements).collect();
        match (dims.is_empty(), reduction) {
            (true, _) => self.reduced(reduction, arguments, &elements, is_integer, span),
            (false, Reduction::Sum) => self.sum_of_arrays(dims, &elements, is_integer, span),
            (false, _) => {
                let fault = fault!(
                    ARRAY_MISMATCH,
                    "`{name}` of arrays, one for each iteration, is not defined"
                );
                Err(fault.at(span))
            }
        }
    }

    /// The reduction of these scalars.
    fn reduced(
        &mut self,
        reduction: Reduction,
        arguments: &Arguments,
        elements: &[T::Scalar],
        is_integer: bool,
        span: Span,
    ) -> Result<Array<T::Scalar>, Diagnostic> {
        let operation = match reduction {
            Reduction::Sum => Some((Binary::Add, 0.0)),
            Reduction::Product => Some((Binary::Mul, 1.0)),
            Reduction::Min | Reduction::Max => None,
        };
        if let Some((operation, empty)) = operation {
            return self.fold(operation, empty, elements, is_integer, span).map(Array::scalar);
        }
        let (Some((first, rest)), Some(id)) =
            (elements.split_first(), function::find(reduction.name()))
        else {
            let none = self.of_none(reduction, arguments, span);
            return Ok(Array::scalar(self.target.constant(none)));
        };
        let mut result = *first;
        for element in rest {
            result = self.target.apply(id, &[result, *element], self.live, span)?;
        }
        Ok(Array::scalar(result))
    }

    /// What a reduction makes of no elements, as the interpreter has it.
    pub(super) fn of_none(
        &mut self,
        reduction: Reduction,
        arguments: &Arguments,
        span: Span,
    ) -> f64 {
        match self.type_of_call(reduction.name(), arguments, span).of_no_elements(reduction) {
            Value::Real(number) => number,
            Value::Integer(number) => number as f64,
            Value::Boolean(truth) => f64::from(truth),
            Value::Enumeration(literal) => literal.ordinal as f64,
            _ => f64::NAN,
        }
    }

    fn are_integers(&mut self, values: &[Expression]) -> bool {
        values.iter().all(|value| self.type_of(value) == ValueType::Integer)
    }

    /// Whether the value of a built-in function is an Integer.
    fn is_integer(&mut self, name: &str, arguments: &Arguments, span: Span) -> bool {
        self.type_of_call(name, arguments, span) == ValueType::Integer
    }

    fn type_of_call(&mut self, name: &str, arguments: &Arguments, span: Span) -> ValueType {
        let function = ComponentReference::from_name(&Name::parse(name), span);
        let arguments = Box::new(arguments.clone());
        self.type_of(&Expression::new(ExpressionKind::Call { function, arguments }, span))
    }

    /// The sum of arrays of these sizes, which follow one another (MLS §10.3.4.1).
    fn sum_of_arrays(
        &mut self,
        dims: Vec<usize>,
        elements: &[T::Scalar],
        exact: bool,
        span: Span,
    ) -> Result<Array<T::Scalar>, Diagnostic> {
        let length: usize = dims.iter().product();
        let mut sums = Vec::with_capacity(length);
        for at in 0..length {
            let column = elements.iter().skip(at).step_by(length).copied();
            let column: Vec<T::Scalar> = column.collect();
            sums.push(self.fold(Binary::Add, 0.0, &column, exact, span)?);
        }
        Ok(Array { dims, elements: sums })
    }

    fn size(
        &mut self,
        arguments: &[Expression],
        span: Span,
    ) -> Result<Array<T::Scalar>, Diagnostic> {
        match arguments {
            [a] => {
                let dims = match self.lower(a)? {
                    Lowered::Strings(strings) => strings.dims,
                    _ => self.array(a)?.dims,
                };
                let sizes = dims.iter().map(|n| self.target.constant(*n as f64)).collect();
                Ok(Array::vector(sizes))
            }
            [a, dimension] => {
                let dims = self.leading_sizes(a)?;
                let dimension = self.known_size(dimension)?;
                match dims.get(dimension.wrapping_sub(1)) {
                    Some(size) => Ok(Array::scalar(self.target.constant(*size as f64))),
                    None => {
                        Err(fault!(ARRAY_MISMATCH, "there is no dimension {dimension}").at(span))
                    }
                }
            }
            _ => Err(fault!(ARRAY_MISMATCH, "`size` takes an array and a dimension").at(span)),
        }
    }

    /// The sizes of an array; those of an array of records and then some of a component.
    fn leading_sizes(&mut self, e: &Expression) -> Result<Vec<usize>, Diagnostic> {
        let mut value = &self.lower(e)?;
        while let Lowered::Record(fields) = value {
            let Some((_, first)) = fields.first() else { break };
            value = first;
        }
        match value {
            Lowered::Array(array) => Ok(array.dims.clone()),
            Lowered::Strings(strings) => Ok(strings.dims.clone()),
            _ => self.array(e).map(|array| array.dims),
        }
    }

    /// A mathematical function, element by element (MLS §12.4.6).
    fn of_scalars(
        &mut self,
        id: FunctionId,
        arguments: &[Expression],
        span: Span,
    ) -> Result<Lowered<T::Scalar>, Diagnostic> {
        self.each_element(arguments, span, |lowering, scalars| {
            lowering.target.apply(id, scalars, lowering.live, span)
        })
    }

    /// `if x >= 0 then positive*x else negative*x` (MLS §3.7.2.5)
    fn semi_linear(
        &mut self,
        arguments: &[Expression],
        span: Span,
    ) -> Result<Lowered<T::Scalar>, Diagnostic> {
        self.each_element(arguments, span, |lowering, scalars| {
            let (live, target) = (lowering.live, &mut *lowering.target);
            let &[x, positive, negative] = scalars else {
                return Err(fault!(ARRAY_MISMATCH, "`semiLinear` takes 3 arguments").at(span));
            };
            let zero = target.constant(0.0);
            let condition = target.relation(RelationOperator::GreaterEqual, x, zero, live, span);
            let mut branch = target.begin_if(condition);
            let first = target.binary(Binary::Mul, positive, x);
            target.begin_else(&mut branch, &[first]);
            let second = target.binary(Binary::Mul, negative, x);
            Ok(target.end_if(branch, &[second])[0])
        })
    }

    /// A function of scalars for the elements of arrays of one size, and for the scalars among the
    /// arguments.
    fn each_element(
        &mut self,
        arguments: &[Expression],
        span: Span,
        mut apply: impl FnMut(&mut Self, &[T::Scalar]) -> Result<T::Scalar, Diagnostic>,
    ) -> Result<Lowered<T::Scalar>, Diagnostic> {
        let values = arguments.iter().map(|a| self.array(a)).collect::<Result<Vec<_>, _>>()?;
        let dims = values.iter().map(|v| &v.dims).max_by_key(|d| d.len()).cloned();
        let dims = dims.unwrap_or_default();
        if let Some(other) = values.iter().find(|v| !v.dims.is_empty() && v.dims != dims) {
            return Err(size_fault(&dims, &other.dims).at(span));
        }
        let mut elements = Vec::new();
        for position in 0..dims.iter().product() {
            let scalars: Vec<T::Scalar> = values
                .iter()
                .map(|v| v.elements[if v.dims.is_empty() { 0 } else { position }])
                .collect();
            elements.push(apply(self, &scalars)?);
        }
        if elements.len() > super::MAX_SCALARS {
            return Err(fault!(NOT_SUPPORTED, "an array of too many elements").at(span));
        }
        Ok(Lowered::Array(Array { dims, elements }))
    }
}

/// The operator of clocks that this may be: `sample` has two meanings (MLS §16.5.1).
fn on_clocks(operator: Temporal) -> Option<Clocked> {
    match operator {
        Temporal::Clocked(operator) => Some(operator),
        Temporal::Sample => Some(Clocked::Sample),
        _ => None,
    }
}

/// What [`Lowering::by_fields`] does with arrays of numbers.
type Make<'a, L, S> = dyn FnMut(&mut L, Vec<Array<S>>) -> Result<Array<S>, Diagnostic> + 'a;

/// A fault of the arguments, of the code that lowering gives to all arrays that do not fit.
pub(super) fn mismatch(fault: Fault, span: Span) -> Diagnostic {
    Fault { code: ARRAY_MISMATCH, ..fault }.at(span)
}
