//! Overloaded operators of operator records (MLS ch. 14): an operation on records becomes a call of
//! the one function of its operator that fits the operands, or, on arrays, one call for each element.

use crate::diag::Diagnostic;
use crate::eval::{Function, FunctionComponent, ValueType};
use crate::fault;
use crate::flatten::BaseType;
use crate::flatten::errors::{SIZE_MISMATCH, TYPE_MISMATCH};
use crate::flatten::expressions::local::Local;
use crate::flatten::ids::ScopeId;
use crate::flatten::instantiate::instantiation::Instantiation;
use crate::flatten::lookup::types::Type;
use crate::flatten::types::Types;
use crate::inference::{self, TypesOfNames};
use crate::name::{Ident, Name};
use crate::source::Span;
use crate::syntax::ast::{
    Arguments, BinaryOperator, ComponentReference, Expression, ExpressionKind, Restriction,
};
use std::sync::Arc;

impl Instantiation<'_> {
    /// `left operator right` as a call, if one of the operands is a record.
    pub(crate) fn overloaded_binary(
        &mut self,
        operator: BinaryOperator,
        left: &Expression,
        right: &Expression,
        local: &Local,
        span: Span,
    ) -> Result<Option<Expression>, Diagnostic> {
        let types = [left, right].map(|operand| self.types().record_of(operand, local));
        let records: Vec<Name> = types.iter().flatten().cloned().collect();
        if records.is_empty() {
            return Ok(None);
        }
        let sign = sign(operator);
        let both = [left.clone(), right.clone()];
        // Operators with a dot mean those of the elements, whatever functions take arrays.
        let direct = if is_dotted(operator) && is_array(left, right) { &[] } else { &records[..] };
        for record in direct {
            if let Some(call) = self.operator_call(record, sign, &both, local, span)? {
                return Ok(Some(call));
            }
        }
        if let Some(pairs) = elementwise(operator, left, right, span)? {
            let operation = |(left, right): (Expression, Expression)| {
                let call = self.overloaded_binary(operator, &left, &right, local, span)?;
                call.ok_or_else(|| no_operator(&records[0], sign, span))
            };
            let elements: Result<Vec<Expression>, Diagnostic> =
                pairs.into_iter().map(operation).collect();
            return Ok(Some(Expression::new(ExpressionKind::Array(elements?), span)));
        }
        if operator == BinaryOperator::Multiply
            && let Some(product) = self.overloaded_product(left, right, local, span)?
        {
            return Ok(Some(product));
        }
        // One operand may be converted by a constructor of the other's record (MLS §14.3).
        for record in &records {
            for at in 0..2 {
                if types[at].as_ref() == Some(record) {
                    continue;
                }
                let one = std::slice::from_ref(&both[at]);
                let Some(converted) =
                    self.operator_call(record, "'constructor'", one, local, span)?
                else {
                    continue;
                };
                let mut operands = both.clone();
                operands[at] = converted;
                if let Some(call) = self.operator_call(record, sign, &operands, local, span)? {
                    return Ok(Some(call));
                }
            }
        }
        Err(no_operator(&records[0], sign, span))
    }

    /// `-operand` as a call, if the operand is a record.
    pub(crate) fn overloaded_unary(
        &mut self,
        sign: &str,
        operand: &Expression,
        local: &Local,
        span: Span,
    ) -> Result<Option<Expression>, Diagnostic> {
        let Some(record) = self.types().record_of(operand, local) else { return Ok(None) };
        let call = self.operator_call(&record, sign, std::slice::from_ref(operand), local, span)?;
        match (call, &operand.kind) {
            (Some(call), _) => Ok(Some(call)),
            (None, ExpressionKind::Array(elements)) => {
                let mut calls = Vec::with_capacity(elements.len());
                for element in elements {
                    calls.extend(self.overloaded_unary(sign, element, local, span)?);
                }
                Ok(Some(Expression::new(ExpressionKind::Array(calls), span)))
            }
            (None, _) => {
                Err(fault!(TYPE_MISMATCH, "`{record}` has no unary operator {sign}").at(span))
            }
        }
    }

    /// The constructor of an operator record that fits resolved arguments; `None` if it has none,
    /// or none that fits, and the record's own constructor is meant.
    pub(crate) fn overloaded_constructor(
        &mut self,
        class: ScopeId,
        arguments: &Arguments,
        local: &Local,
    ) -> Result<Option<Name>, Diagnostic> {
        if self.classes.text(class).restriction() != Restriction::OperatorRecord {
            return Ok(None);
        }
        self.fitting_function(class, "'constructor'", arguments, local)
    }

    /// The function of an operator that fits resolved arguments: rather one whose inputs have their
    /// numbers of dimensions than one that is called for each element.
    fn fitting_function(
        &mut self,
        class: ScopeId,
        sign: &str,
        arguments: &Arguments,
        local: &Local,
    ) -> Result<Option<Name>, Diagnostic> {
        let functions = self.operator_functions(class, sign)?;
        let types = self.types();
        let mut fitting =
            functions.iter().filter(|(_, function)| types.fits_call(function, arguments, local));
        let first = fitting.clone().next();
        let found = fitting.find(|(_, function)| types.fits_ranks(function, arguments)).or(first);
        Ok(found.map(|(name, _)| name.clone()))
    }

    /// `String(a, …)` of an operator record as a call of its operator `'String'` (MLS §14.4); `None` for
    /// other values.
    pub(crate) fn overloaded_string(
        &mut self,
        arguments: &Arguments,
        local: &Local,
        span: Span,
    ) -> Result<Option<Expression>, Diagnostic> {
        let Some(operand) = arguments.positional.first() else { return Ok(None) };
        let record = self.types().record_of(operand, local);
        let known = |record: Name| {
            let class = *self.functions.record_scopes.get(&record)?;
            Some((record, class))
        };
        let Some((record, class)) = record.and_then(known) else { return Ok(None) };
        if let Some(name) = self.fitting_function(class, "'String'", arguments, local)? {
            let function = ComponentReference::from_name(&name, span);
            let kind = ExpressionKind::Call { function, arguments: Box::new(arguments.clone()) };
            return Ok(Some(Expression::new(kind, span)));
        }
        Err(fault!(TYPE_MISMATCH, "`{record}` has no operator 'String' for these arguments")
            .at(span))
    }

    pub(crate) fn operator_call(
        &mut self,
        record: &Name,
        sign: &str,
        operands: &[Expression],
        local: &Local,
        span: Span,
    ) -> Result<Option<Expression>, Diagnostic> {
        let Some(class) = self.functions.record_scopes.get(record).copied() else {
            return Ok(None);
        };
        let arguments = Arguments { positional: operands.to_vec(), ..Arguments::default() };
        let found = self.fitting_function(class, sign, &arguments, local)?;
        Ok(found.map(|name| {
            let function = ComponentReference::from_name(&name, span);
            let kind = ExpressionKind::Call { function, arguments: Box::new(arguments) };
            Expression::new(kind, span)
        }))
    }

    /// The functions of an operator, made ready: itself, or those inside it.
    fn operator_functions(
        &mut self,
        class: ScopeId,
        sign: &str,
    ) -> Result<Vec<(Name, Arc<Function>)>, Diagnostic> {
        let Some(nested) = self.classes.find_class(class, Ident::new(sign))? else {
            return Ok(Vec::new());
        };
        let Type::Class(operator) = self.classes.instance(&nested)? else { return Ok(Vec::new()) };
        let mut scopes = vec![operator];
        if self.classes.text(operator).restriction() == Restriction::Operator {
            scopes.clear();
            let id = self.classes.text(operator).id;
            let names: Vec<Ident> = id.map_or(Vec::new(), |id| {
                self.classes.library.class(id).children().map(|(name, _)| name).collect()
            });
            for name in names {
                if let Some(inner) = self.classes.find_class(operator, name)?
                    && let Type::Class(scope) = self.classes.instance(&inner)?
                {
                    scopes.push(scope);
                }
            }
        }
        let mut functions = Vec::with_capacity(scopes.len());
        for scope in scopes {
            if let Some(name) = self.function(scope)?
                && let Some(Some(function)) = self.functions.table.get(&name)
            {
                functions.push((name, function.clone()));
            }
        }
        Ok(functions)
    }
}

impl Types<'_> {
    /// The record that an expression, or the elements of an array constructor, are of.
    pub(crate) fn record_of(&self, e: &Expression, local: &Local) -> Option<Name> {
        if !self.may_be_record(e, local) {
            return None;
        }
        record_name(self.value_type_of(e, local).as_ref())
    }

    /// Whether a value, or the elements of an array constructor, may be records, judged by its outermost
    /// operation: what is below operations is looked at where these are.
    pub(crate) fn may_be_record(&self, e: &Expression, local: &Local) -> bool {
        match &e.kind {
            ExpressionKind::Array(elements) => {
                elements.first().is_some_and(|element| self.may_be_record(element, local))
            }
            ExpressionKind::If { otherwise, .. } => self.may_be_record(otherwise, local),
            ExpressionKind::Unary { operand, .. } => self.may_be_record(operand, local),
            ExpressionKind::Reference(reference) => {
                let first = reference.parts.first().map(|part| part.name);
                local.types.iter().any(|(name, _)| Some(*name) == first)
            }
            ExpressionKind::Call { .. } | ExpressionKind::Field { .. } => true,
            _ => false,
        }
    }

    /// Whether a call with these arguments can be one of the function, without conversions but
    /// that from Integer to Real.
    fn fits_call(&self, function: &Function, arguments: &Arguments, local: &Local) -> bool {
        if arguments.positional.len() > function.inputs.len() {
            return false;
        }
        let mut given = vec![false; function.inputs.len()];
        for (at, argument) in arguments.positional.iter().enumerate() {
            given[at] = true;
            if !self.fits_input(&function.inputs[at], argument, local) {
                return false;
            }
        }
        for argument in &arguments.named {
            let at = function.inputs.iter().position(|input| input.name == argument.name.node);
            let Some(at) = at.filter(|at| !given[*at]) else { return false };
            given[at] = true;
            if !self.fits_input(&function.inputs[at], &argument.value, local) {
                return false;
            }
        }
        function.inputs.iter().zip(given).all(|(input, given)| given || input.binding.is_some())
    }

    /// Whether no argument shows another number of dimensions than its input has.
    fn fits_ranks(&self, function: &Function, arguments: &Arguments) -> bool {
        let positional = function.inputs.iter().zip(&arguments.positional);
        let named = arguments.named.iter().filter_map(|argument| {
            let input = function.inputs.iter().find(|input| input.name == argument.name.node);
            Some((input?, &argument.value))
        });
        let fits = |(input, argument): (&FunctionComponent, &Expression)| {
            self.rank_of(argument).is_none_or(|rank| rank == input.dims.len())
        };
        positional.chain(named).all(fits)
    }

    fn fits_input(&self, input: &FunctionComponent, argument: &Expression, local: &Local) -> bool {
        let found = self.value_type_of(argument, local);
        let is_record = |t: Option<&ValueType>| matches!(t, Some(ValueType::Record(..)));
        let rank = constructor_rank(argument);
        if is_record(found.as_ref()) && rank.is_some_and(|rank| rank != input.dims.len()) {
            return false;
        }
        match (&input.value_type, found) {
            (ValueType::Record(expected, _), Some(ValueType::Record(found, _))) => {
                *expected == found
            }
            (ValueType::Record(..), _) | (_, Some(ValueType::Record(..))) => false,
            (ValueType::Real, Some(ValueType::Real | ValueType::Integer)) => true,
            // A literal of an enumeration is its ordinal here.
            (ValueType::Enumeration(_), Some(ValueType::Integer)) => {
                matches!(argument.kind, ExpressionKind::Integer(_))
            }
            (expected, Some(found)) => *expected == found,
            // What the text does not tell is a number in practice.
            (expected, None) => matches!(expected, ValueType::Real | ValueType::Integer),
        }
    }

    /// The type of the elements of a resolved expression, records included; `None` where it does not
    /// follow from its text.
    pub(crate) fn value_type_of(&self, e: &Expression, local: &Local) -> Option<ValueType> {
        inference::type_of(&mut LocalTypes { types: self, local }, e)
    }
}

/// The types of variables and of the local ones of a function.
struct LocalTypes<'t> {
    types: &'t Types<'t>,
    local: &'t Local,
}

impl TypesOfNames for LocalTypes<'_> {
    type Type = ValueType;

    fn of_reference(&mut self, reference: &ComponentReference) -> Option<ValueType> {
        let (first, parts) = reference.parts.split_first()?;
        match self.local.types.iter().find(|(name, _)| *name == first.name) {
            Some((_, found)) => {
                parts.iter().try_fold(found.clone(), |record, part| record.component(part.name))
            }
            None => TypesOfNames::of_reference(&mut &*self.types, reference).map(plain),
        }
    }

    fn of_function(
        &mut self,
        function: &ComponentReference,
        _: &Arguments,
    ) -> Option<Option<ValueType>> {
        let function = self.types.functions.table.get(&function.name())?.as_ref()?;
        let output = function.outputs.first().filter(|output| output.dims.is_empty());
        Some(output.map(|output| output.value_type.clone()))
    }

    fn of_component(&mut self, record: &ValueType, name: Ident) -> Option<ValueType> {
        record.component(name)
    }
}

/// The dimensions of a value of records: how many array constructors stand around the elements.
/// Those of a function's own variables cannot be found by their names.
fn constructor_rank(e: &Expression) -> Option<usize> {
    match &e.kind {
        ExpressionKind::Array(elements) => Some(1 + constructor_rank(elements.first()?)?),
        ExpressionKind::Reference(_) => None,
        _ => Some(0),
    }
}

/// The operands of each element of an operation on arrays (MLS §14.4, §10.6); `None` where both are
/// scalars, or where the operator has another meaning for arrays.
fn elementwise(
    operator: BinaryOperator,
    left: &Expression,
    right: &Expression,
    span: Span,
) -> Result<Option<Vec<(Expression, Expression)>>, Diagnostic> {
    use BinaryOperator as Op;
    let is_dotted = is_dotted(operator);
    match (&left.kind, &right.kind) {
        (ExpressionKind::Array(left), ExpressionKind::Array(right))
            if is_dotted || matches!(operator, Op::Add | Op::Subtract) =>
        {
            if left.len() != right.len() {
                let (one, other) = (left.len(), right.len());
                return Err(fault!(
                    SIZE_MISMATCH,
                    "an operation on arrays of {one} and {other} elements"
                )
                .at(span));
            }
            Ok(Some(left.iter().cloned().zip(right.iter().cloned()).collect()))
        }
        (ExpressionKind::Array(_), ExpressionKind::Array(_)) => Ok(None),
        (ExpressionKind::Array(left), _)
            if is_dotted || matches!(operator, Op::Multiply | Op::Divide) =>
        {
            Ok(Some(left.iter().map(|one| (one.clone(), right.clone())).collect()))
        }
        (_, ExpressionKind::Array(right)) if is_dotted || operator == Op::Multiply => {
            Ok(Some(right.iter().map(|one| (left.clone(), one.clone())).collect()))
        }
        _ => Ok(None),
    }
}

fn is_dotted(operator: BinaryOperator) -> bool {
    use BinaryOperator as Op;
    matches!(
        operator,
        Op::ElementwiseAdd
            | Op::ElementwiseSubtract
            | Op::ElementwiseMultiply
            | Op::ElementwiseDivide
            | Op::ElementwisePower
    )
}

fn is_array(left: &Expression, right: &Expression) -> bool {
    [left, right].iter().any(|operand| matches!(operand.kind, ExpressionKind::Array(_)))
}

fn no_operator(record: &Name, sign: &str, span: Span) -> Diagnostic {
    fault!(TYPE_MISMATCH, "`{record}` has no operator {sign} for these operands").at(span)
}

fn plain(base: BaseType) -> ValueType {
    match base {
        BaseType::Real => ValueType::Real,
        BaseType::Integer => ValueType::Integer,
        BaseType::Boolean => ValueType::Boolean,
        BaseType::String => ValueType::String,
        BaseType::Enumeration(definition) => ValueType::Enumeration(definition),
        BaseType::ExternalObject(_) | BaseType::Clock => ValueType::Any,
    }
}

fn record_name(found: Option<&ValueType>) -> Option<Name> {
    match found {
        Some(ValueType::Record(name, _)) => Some(name.clone()),
        _ => None,
    }
}

/// The name of an operator's class.
fn sign(operator: BinaryOperator) -> &'static str {
    use BinaryOperator as Op;
    match operator {
        Op::Add | Op::ElementwiseAdd => "'+'",
        Op::Subtract | Op::ElementwiseSubtract => "'-'",
        Op::Multiply | Op::ElementwiseMultiply => "'*'",
        Op::Divide | Op::ElementwiseDivide => "'/'",
        Op::Power | Op::ElementwisePower => "'^'",
        Op::Equal => "'=='",
        Op::NotEqual => "'<>'",
        Op::Less => "'<'",
        Op::LessEqual => "'<='",
        Op::Greater => "'>'",
        Op::GreaterEqual => "'>='",
        Op::And => "'and'",
        Op::Or => "'or'",
    }
}
