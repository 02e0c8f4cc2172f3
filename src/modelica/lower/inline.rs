//! Inlining of user functions: statements are evaluated symbolically, loops of known
//! length unrolled, branches merged into if-expressions (MLS ch. 11, §12.4).
//!
//! Not possible for external and impure functions, for `while`, `break`, `return` and subscripts
//! that depend on variables, and for recursion that does not end when compiling: such calls are left
//! to the bytecode of `function`, which refuses impure functions.

use super::builder::{Builder, MAX_STATEMENTS};
use super::calls_of_statements::{AssertArguments, CallStatement, assigned_outputs};
use super::component_shape::{Declared, declared};
use super::equation::{Assertion, Level};
use super::errors::{ARRAY_MISMATCH, NOT_SUPPORTED, UNRESOLVED_REFERENCE};
use super::execution::Loops;
use super::expressions::message_parts;
use super::expressions::{
    Array, Binary, Branch, Choice, ConditionalValues, FunctionCalls, Lowered, Lowering, Operations,
    StringOperations, TimeOperators, Unary, VariableReferences, size_fault,
};
use super::function::{component_type, local_value, subscripts_of};
use super::shape::UNKNOWN_TEXT;
use crate::diag::{Diagnostic, Fault};
use crate::eval::{Function, FunctionBody, FunctionComponent, ValueType};
use crate::execute::{
    Branches, Decision, Domain, Done, Executed, Flow, Iteration, Targets, execute, statements,
};
use crate::fault;
use crate::flatten::FlatModel;
use crate::name::Ident;
use crate::source::Span;
use crate::symbolic::function::FunctionId;
use crate::symbolic::{Expr, RelationOperator};
use crate::syntax::ast::{ComponentReference, Expression, ForIndex, Statement, Subscript};
use std::borrow::Cow;
use std::cell::Cell;
use std::sync::Arc;

/// Deepest nesting of calls.
const MAX_CALLS: usize = 40;

/// Most statements that one call may run where it can be compiled instead.
pub(super) const MAX_INLINED: usize = 2_000;

/// The outputs of a call.
pub(super) fn inline(
    builder: &mut Builder<'_>,
    function: &Arc<Function>,
    arguments: Vec<Lowered<Expr>>,
    span: Span,
) -> Result<Vec<Lowered<Expr>>, Diagnostic> {
    let name = &function.name;
    let refuse =
        |reason: &str| Err(fault!(NOT_SUPPORTED, "the function `{name}` {reason}").at(span));
    let FunctionBody::Algorithm(statements) = &function.body else {
        return refuse("is external and cannot be used in equations");
    };
    if function.impure {
        return refuse("is impure and cannot be used in equations");
    }
    if builder.calls.depth >= MAX_CALLS {
        builder.calls.inlined = 0;
        return refuse("calls itself without an end that is known at translation");
    }
    builder.calls.depth += 1;
    let mut call = Call {
        builder,
        function: function.clone(),
        locals: Vec::new(),
        loops: Vec::new(),
        unassigned: false,
        statement: span,
    };
    let result = call.run(function, statements, arguments, span);
    builder.calls.depth -= 1;
    result
}

/// A call being evaluated.
struct Call<'a, 'b> {
    builder: &'a mut Builder<'b>,
    function: Arc<Function>,
    /// Variables with their values; NaN where nothing was assigned.
    locals: Vec<(Ident, Lowered<Expr>)>,
    loops: Loops,
    /// The statement being executed.
    statement: Span,
    /// Whether a decision depended on a variable without value.
    unassigned: bool,
}

impl Call<'_, '_> {
    fn run(
        &mut self,
        function: &Function,
        algorithm: &[Statement],
        arguments: Vec<Lowered<Expr>>,
        span: Span,
    ) -> Result<Vec<Lowered<Expr>>, Diagnostic> {
        for (input, argument) in function.inputs.iter().zip(arguments) {
            check_rank(function, input, &argument, span)?;
            self.locals.push((input.name, argument));
        }
        for component in function.variables_in_order() {
            let mut undeclared = |_: &mut Self, _: &[Ident]| Ok(None);
            let Declared { shape, scalars } =
                declared(&mut Lowering::new(self), component, &mut undeclared)?;
            let nothing = self.constant(f64::NAN);
            let mut scalars = scalars.into_iter().map(|scalar| scalar.unwrap_or(nothing));
            let value = Lowered::from_scalars(&shape, &mut scalars);
            self.locals.push((component.name, value));
        }
        statements(self, algorithm)?;
        let outputs: Vec<Lowered<Expr>> = function
            .outputs
            .iter()
            .filter_map(|o| self.locals.iter().find(|(name, _)| *name == o.name))
            .map(|(_, value)| value.clone())
            .collect();
        let mut scalars = Vec::new();
        outputs.iter().for_each(|output| output.append_scalars(&mut scalars));
        let Builder { dae, calls, .. } = &mut *self.builder;
        if self.unassigned || scalars.iter().any(|e| calls.undefined.contains(&dae.pool, *e)) {
            return Err(fault!(
                NOT_SUPPORTED,
                "the function `{}` uses or returns a variable that is not assigned on every path",
                function.name
            )
            .at(function.span)
            .related(span, "called here"));
        }
        Ok(outputs)
    }

    fn lowering(&mut self) -> Lowering<'_, Self> {
        let loops = self.loops.clone();
        let mut lowering = Lowering::new(self);
        lowering.loops = loops;
        lowering.live = true;
        lowering
    }

    /// One more statement or iteration.
    fn count(&mut self, refusal: impl FnOnce() -> Fault, span: Span) -> Result<(), Diagnostic> {
        let left = &mut self.builder.calls.inlined;
        *left = left.saturating_sub(1);
        match left {
            0 => Err(refusal().at(span)),
            _ => Ok(()),
        }
    }

    fn assertion(
        &mut self,
        AssertArguments { condition, message, level }: AssertArguments<'_>,
        span: Span,
    ) -> Result<(), Diagnostic> {
        let level = match level {
            Some(level) if self.lowering().shaping(level)? == 1.0 => Level::Warning,
            _ => Level::Error,
        };
        let condition = self.lowering().scalar(condition)?;
        self.assert_with(condition, level, message, span);
        Ok(())
    }

    /// An assertion; what its text reads need not hold where the condition does.
    fn assert_with(
        &mut self,
        condition: Expr,
        level: Level,
        text: Option<&Expression>,
        span: Span,
    ) {
        let asserted = self.builder.dae.assertions.len();
        let parts = message_parts(&mut self.lowering(), text);
        self.builder.dae.assertions.truncate(asserted);
        self.builder.dae.assertions.push(Assertion::new(condition, parts, level, span));
    }

    fn assign(
        &mut self,
        target: &ComponentReference,
        value: Lowered<Expr>,
    ) -> Result<(), Diagnostic> {
        let mut names: Vec<Ident> = target.parts.iter().map(|part| part.name).collect();
        let function = self.function.clone();
        let subscripts = subscripts_of(&function, target)?;
        let Some(place) = self.local(&names) else {
            let error = fault!(UNRESOLVED_REFERENCE, "there is no variable `{}`", target.name());
            return Err(error.at(target.span));
        };
        if !subscripts.is_empty() {
            return self.assign_elements(&mut names, &subscripts, value, target.span);
        }
        if !place.fits(&value) {
            return Err(fault!(
                ARRAY_MISMATCH,
                "the value of `{}` has a different size",
                target.name()
            )
            .at(target.span));
        }
        *place = value;
        Ok(())
    }

    /// `names[subscripts] := value`, for each array of a record.
    fn assign_elements(
        &mut self,
        names: &mut Vec<Ident>,
        subscripts: &[Subscript],
        value: Lowered<Expr>,
        span: Span,
    ) -> Result<(), Diagnostic> {
        let value = match value {
            Lowered::Array(value) => value,
            Lowered::Record(fields) => {
                for (name, field) in fields {
                    names.push(name);
                    self.assign_elements(names, subscripts, field, span)?;
                    names.pop();
                }
                return Ok(());
            }
            _ => return Err(fault!(NOT_SUPPORTED, "subscripts of a String").at(span)),
        };
        let Some(Lowered::Array(place)) = self.local(names) else {
            return Err(fault!(NOT_SUPPORTED, "subscripts of a record").at(span));
        };
        let dims = place.dims.clone();
        let (positions, chosen) = self.positions(&dims, subscripts, span)?;
        if chosen != value.dims {
            return Err(size_fault(&chosen, &value.dims).at(span));
        }
        if let Some(Lowered::Array(place)) = self.local(names) {
            for (position, element) in positions.into_iter().zip(value.elements) {
                place.elements[position] = element;
            }
        }
        Ok(())
    }

    /// Row-major positions that subscripts choose, and the sizes of what is chosen.
    fn positions(
        &mut self,
        dims: &[usize],
        subscripts: &[Subscript],
        span: Span,
    ) -> Result<(Vec<usize>, Vec<usize>), Diagnostic> {
        let (mut positions, mut kept) = (vec![0], Vec::new());
        let mut choices = self.lowering().choices(dims, subscripts, span)?.into_iter();
        for size in dims {
            let chosen: Vec<usize> = match choices.next() {
                Some(Choice::Known { positions, keeps }) => {
                    kept.extend(keeps.then_some(positions.len()));
                    positions
                }
                Some(Choice::Computed(_) | Choice::ComputedVector(_)) => {
                    return Err(subscript_unknown(span));
                }
                None => {
                    kept.push(*size);
                    (0..*size).collect()
                }
            };
            let step = |at: &usize| chosen.iter().map(|c| at * size + c).collect::<Vec<_>>();
            positions = positions.iter().flat_map(step).collect();
        }
        Ok((positions, kept))
    }

    fn local(&mut self, names: &[Ident]) -> Option<&mut Lowered<Expr>> {
        let (first, rest) = names.split_first()?;
        let mut place = &mut self.locals.iter_mut().find(|(name, _)| name == first)?.1;
        for name in rest {
            let Lowered::Record(fields) = place else { return None };
            place = &mut fields.iter_mut().find(|(field, _)| field == name)?.1;
        }
        Some(place)
    }
}

fn subscript_unknown(span: Span) -> Diagnostic {
    fault!(NOT_SUPPORTED, "a subscript that depends on variables is not supported yet").at(span)
}

/// `local := if condition then taken else local`
fn merge(
    builder: &mut Builder<'_>,
    condition: Expr,
    taken: &Lowered<Expr>,
    local: &mut Lowered<Expr>,
) {
    match (taken, local) {
        (Lowered::Array(a), Lowered::Array(b)) => {
            for (x, y) in a.elements.iter().zip(&mut b.elements) {
                *y = builder.dae.pool.if_then_else(condition, *x, *y);
            }
        }
        (Lowered::Record(a), Lowered::Record(b)) => {
            for ((_, x), (_, y)) in a.iter().zip(b) {
                merge(builder, condition, x, y);
            }
        }
        (Lowered::Text(a), Lowered::Text(b)) if a != b => *b = UNKNOWN_TEXT.into(),
        (Lowered::Strings(a), Lowered::Strings(b)) => match a.joined(b) {
            Some(joined) => *b = joined,
            None => b.forget(),
        },
        (Lowered::Text(_), Lowered::Strings(b)) => b.forget(),
        (Lowered::Strings(_), b @ Lowered::Text(_)) => *b = Lowered::Text(UNKNOWN_TEXT.into()),
        _ => {}
    }
}

fn check_rank(
    function: &Function,
    input: &FunctionComponent,
    argument: &Lowered<Expr>,
    span: Span,
) -> Result<(), Diagnostic> {
    match argument {
        Lowered::Array(Array { dims, .. }) if dims.len() != input.dims.len() => Err(fault!(
            ARRAY_MISMATCH,
            "the argument `{}` of `{}` has {} dimensions instead of {}",
            input.name,
            function.name,
            dims.len(),
            input.dims.len()
        )
        .at(span)),
        Lowered::Text(_) | Lowered::Strings(_) | Lowered::Numbered(_) => Err(fault!(
            NOT_SUPPORTED,
            "the String argument `{}` of `{}`",
            input.name,
            function.name
        )
        .at(span)),
        _ => Ok(()),
    }
}

/// Conditions that are not known merge what their branches assign.
impl Domain for Call<'_, '_> {
    type Condition = Expr;

    fn statement(&mut self, statement: &Statement) -> Done<Self> {
        let refusal = || {
            fault!(
                NOT_SUPPORTED,
                "functions in equations execute more than {MAX_STATEMENTS} statements"
            )
        };
        self.count(refusal, statement.span)?;
        let around = std::mem::replace(&mut self.statement, statement.span);
        let done = execute(self, statement);
        self.statement = around;
        done
    }

    fn assign_value(&mut self, to: &ComponentReference, value: &Expression, _: Span) -> Executed {
        let value = self.lowering().lower(value)?;
        self.assign(to, value)
    }

    fn assign_outputs(&mut self, targets: &Targets, call: &Expression) -> Executed {
        let outputs = assigned_outputs(&mut self.lowering(), targets, call, |own, user, given| {
            own.user_call(user, given, call.span)
        })?;
        outputs.into_iter().try_for_each(|(target, output)| self.assign(target, output))
    }

    fn call_statement(&mut self, call: &Expression) -> Executed {
        match CallStatement::new(self, call)? {
            CallStatement::Assert(arguments) => self.assertion(arguments, call.span)?,
            CallStatement::Fail(message) => {
                let condition = self.builder.dae.pool.constant(0.0);
                self.assert_with(condition, Level::Error, message, call.span);
            }
            CallStatement::Call(user, arguments) => {
                let outputs = self.lowering().user_call(&user, arguments, call.span)?;
                self.builder.unused(&outputs, call.span);
            }
        }
        Ok(())
    }

    fn decide(&mut self, condition: &Expression) -> Result<Decision<Expr>, Diagnostic> {
        let condition = self.lowering().scalar(condition)?;
        Ok(match self.as_constant(condition) {
            Some(known) => Decision::Known(known != 0.0),
            None => Decision::Open(condition),
        })
    }

    fn either(
        &mut self,
        condition: Expr,
        first: impl FnOnce(&mut Self) -> Done<Self>,
        second: impl FnOnce(&mut Self) -> Done<Self>,
    ) -> Done<Self> {
        let before = self.locals.clone();
        let asserted = self.builder.dae.assertions.len();
        let first = first(self);
        self.builder.dae.guard_assertions(asserted, condition);
        let taken = std::mem::replace(&mut self.locals, before);
        let not = self.unary(Unary::Not, condition);
        let asserted = self.builder.dae.assertions.len();
        let second = second(self);
        self.builder.dae.guard_assertions(asserted, not);
        if (first?, second?) != (Flow::Next, Flow::Next) {
            return Err(fault!(
                NOT_SUPPORTED,
                "`break` or `return` under a condition that depends on variables"
            )
            .at(self.statement));
        }
        for ((_, local), (_, taken)) in self.locals.iter_mut().zip(&taken) {
            merge(self.builder, condition, taken, local);
        }
        Ok(Flow::Next)
    }

    fn for_loop(&mut self, index: &ForIndex, body: Iteration<'_>) -> Done<Self> {
        let mut variables = self.lowering().loop_variables(index)?.into_iter();
        let outside = self.loops.len();
        let done = body.repeat(self, |call| {
            call.loops.truncate(outside);
            call.loops.extend(variables.next());
            Ok(call.loops.len() > outside)
        });
        self.loops.truncate(outside);
        done
    }

    fn while_loop(&mut self, condition: &Expression, body: Iteration<'_>) -> Done<Self> {
        let mut is_first = true;
        body.repeat(self, |call| {
            if !std::mem::replace(&mut is_first, false) {
                call.count(|| fault!(NOT_SUPPORTED, "this loop does not end"), body.span)?;
            }
            Ok(call.lowering().known(condition)? != 0.0)
        })
    }

    fn when_statement(&mut self, _: &Branches, span: Span) -> Done<Self> {
        Err(fault!(NOT_SUPPORTED, "`when` in a function").at(span))
    }
}

impl Operations for Call<'_, '_> {
    type Scalar = Expr;

    fn constant(&mut self, value: f64) -> Expr {
        self.builder.constant(value)
    }

    fn as_constant(&self, scalar: Expr) -> Option<f64> {
        self.builder.as_constant(scalar)
    }

    fn unary(&mut self, operation: Unary, a: Expr) -> Expr {
        self.builder.unary(operation, a)
    }

    fn binary(&mut self, operation: Binary, a: Expr, b: Expr) -> Expr {
        self.builder.binary(operation, a, b)
    }

    fn relation(&mut self, op: RelationOperator, a: Expr, b: Expr, _: bool, span: Span) -> Expr {
        self.unassigned |= [a, b].iter().any(|e| self.as_constant(*e).is_some_and(f64::is_nan));
        // Relations inside functions cause no events (MLS §12.2).
        self.builder.relation(op, a, b, true, span)
    }

    fn apply(
        &mut self,
        function: FunctionId,
        arguments: &[Expr],
        _: bool,
        span: Span,
    ) -> Result<Expr, Diagnostic> {
        self.builder.apply(function, arguments, true, span)
    }

    fn element(&mut self, _: &[Expr], _: Expr, span: Span) -> Result<Expr, Diagnostic> {
        Err(subscript_unknown(span))
    }
}

impl ConditionalValues for Call<'_, '_> {
    fn connective(&mut self, is_and: bool, a: Expr, b: Expr) -> Expr {
        self.builder.connective(is_and, a, b)
    }

    fn enter(&mut self, condition: Expr, holds: bool) {
        self.builder.enter(condition, holds);
    }

    fn leave(&mut self) {
        self.builder.leave();
    }

    fn begin_if(&mut self, condition: Expr) -> Branch<Expr> {
        self.builder.begin_if(condition)
    }

    fn begin_else(&mut self, branch: &mut Branch<Expr>, values: &[Expr]) {
        self.builder.begin_else(branch, values);
    }

    fn end_if(&mut self, branch: Branch<Expr>, values: &[Expr]) -> Vec<Expr> {
        self.builder.end_if(branch, values)
    }
}

impl VariableReferences for Call<'_, '_> {
    fn reference(
        &mut self,
        path: &str,
        reference: &ComponentReference,
    ) -> Result<Lowered<Expr>, Diagnostic> {
        local_value(&self.locals, path, reference)
    }

    fn own_variable(&self, name: Ident) -> Option<&Lowered<Expr>> {
        self.locals.iter().find(|(own, _)| *own == name).map(|(_, value)| value)
    }

    fn own_subscripts<'r>(
        &self,
        reference: &'r ComponentReference,
    ) -> Result<Cow<'r, [Subscript]>, Diagnostic> {
        subscripts_of(&self.function, reference)
    }

    fn value_type(&self, path: &str) -> Option<ValueType> {
        component_type(&self.function, path)
    }
}

impl FunctionCalls for Call<'_, '_> {
    fn flat(&self) -> &FlatModel {
        self.builder.flat
    }

    fn call(
        &mut self,
        function: &Arc<Function>,
        arguments: Vec<Lowered<Expr>>,
        span: Span,
    ) -> Result<Vec<Lowered<Expr>>, Diagnostic> {
        super::function::call(self.builder, function, arguments, span)
    }

    fn interpreted(&self) -> &Cell<u64> {
        self.builder.interpreted()
    }

    fn gives_up(&self) -> bool {
        self.builder.calls.inlined == 0
    }

    fn runs_once(&self) -> bool {
        self.builder.runs_once()
    }

    fn warn(&mut self, warnings: Vec<Diagnostic>) {
        self.builder.warn(warnings);
    }
}

impl StringOperations for Call<'_, '_> {}

impl TimeOperators for Call<'_, '_> {}
