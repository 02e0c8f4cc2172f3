//! Declarations and statements of a function being compiled (MLS ch. 11, §12.4).

use super::emitter::{Emitter, Operand};
use super::external_kinds::prints;
use super::instances::{Argument, Instances};
use super::mark::Mark;
use super::single_assignment::assigned_once;
use super::unrolling::is_short;
use crate::arithmetic::{Operation, Operator, Register};
use crate::bytecode::{Code, Instruction};
use crate::diag::Diagnostic;
use crate::eval::{Function, FunctionBody, FunctionComponent, ValueType};
use crate::execute::{self, Branches, Decision, Domain, Done, Executed, Flow, Iteration, Targets};
use crate::fault;
use crate::flatten::FlatModel;
use crate::lower::calls_of_statements::{AssertArguments, CallStatement, assigned_outputs};
use crate::lower::errors::{NO_CONSTANT_VALUE, NOT_SUPPORTED};
use crate::lower::expressions::{Array, Lowered, Lowering};
use crate::lower::loops::{LoopVariable, Loops};
use crate::name::Ident;
use crate::source::Span;
use crate::syntax::ast::{ComponentReference, Expression, ExpressionKind, ForIndex, Statement};
use std::sync::Arc;

/// A function being compiled.
pub(super) struct Body<'a, 'f> {
    pub(super) flat: &'f FlatModel,
    pub(super) instances: &'a mut Instances,
    pub(super) function: &'a Arc<Function>,
    pub(super) emitter: Emitter,
    /// Inputs, outputs and locals with their registers or numbers.
    pub(super) locals: Vec<(Ident, Lowered<Operand>)>,
    /// Jumps of if-expressions being written, innermost last.
    pub(super) branches: Vec<usize>,
    /// The variables of the loops being written, innermost last.
    pub(super) loops: Loops<Operand>,
    /// `break` of every loop being written, innermost last.
    pub(super) breaks: Vec<Vec<usize>>,
    pub(super) returns: Vec<usize>,
    pub(super) n_inputs: u32,
    /// Variables that are assigned once, whatever happens.
    pub(super) known_once: Vec<Ident>,
    /// Integers that have a number in the branch being written.
    pub(super) bound_integers: usize,
    /// Whether loop variables may decide sizes in loops that cannot be unrolled.
    pub(super) loop_sizes: bool,
    /// Whether Strings that are not known are made when it runs.
    pub(super) composes: bool,
}

impl<'a, 'f> Body<'a, 'f> {
    pub(super) fn new(
        flat: &'f FlatModel,
        instances: &'a mut Instances,
        function: &'a Arc<Function>,
    ) -> Body<'a, 'f> {
        Body {
            flat,
            instances,
            function,
            emitter: Emitter::default(),
            locals: Vec::new(),
            branches: Vec::new(),
            loops: Vec::new(),
            breaks: Vec::new(),
            returns: Vec::new(),
            n_inputs: 0,
            known_once: Vec::new(),
            bound_integers: 0,
            loop_sizes: false,
            composes: false,
        }
    }

    /// The statements, all components being declared.
    pub(super) fn compile(mut self, statements: &[Statement]) -> Result<Code, Diagnostic> {
        if let FunctionBody::External(clause) = &self.function.clone().body {
            self.external(clause)?;
        }
        self.known_once = assigned_once(statements);
        execute::statements(&mut self, statements)?;
        for jump in std::mem::take(&mut self.returns) {
            self.emitter.land(jump);
        }
        Ok(self.finish())
    }

    /// The code, whose outputs have what they return.
    pub(super) fn finish(mut self) -> Code {
        self.emitter.place(self.function.span);
        let mut outputs = Vec::new();
        let mut plain = Vec::new();
        for output in &self.function.outputs {
            if let Some(value) = self.local(&[output.name]) {
                let before = outputs.len() as Register;
                value.append_scalars(&mut outputs);
                if !matches!(value, Lowered::Record(_)) {
                    plain.push((before, outputs.len() as Register - before));
                }
            }
        }
        let first = self.emitter.row(&outputs);
        // Outputs without value are a fault of the whole; a component of a record may have none as
        // long as it is not read.
        for &(at, n) in &plain {
            self.emitter.emit(Instruction::Check { a: first + at, n });
        }
        let name = self.function.name.to_string().into();
        let n: Register = plain.iter().map(|(_, n)| n).sum();
        let mut code = self.emitter.finish(name, self.n_inputs, first, outputs.len() as u32);
        code.may_lack = n < code.n_outputs;
        code
    }

    /// An input: a number, or registers that the caller fills.
    pub(super) fn input(&mut self, name: Ident, argument: &Argument) {
        let value = self.of_argument(argument);
        self.locals.push((name, value));
    }

    fn of_argument(&mut self, argument: &Argument) -> Lowered<Operand> {
        match argument {
            Argument::Known(bits) => Lowered::scalar(Operand::Constant(f64::from_bits(*bits))),
            Argument::Text(text) => Lowered::Text(text.clone()),
            Argument::Strings(strings) => Lowered::Strings(strings.clone()),
            Argument::Shape(shape) => {
                let first = self.emitter.permanent(shape.len() as u32);
                self.n_inputs += shape.len() as u32;
                Lowered::from_scalars(shape, &mut (first..).map(Operand::Register))
            }
            Argument::Record(fields) => {
                let field = |(name, field): &(Ident, Argument)| (*name, self.of_argument(field));
                Lowered::Record(fields.iter().map(field).collect())
            }
        }
    }

    pub(super) fn lowering(&mut self) -> Lowering<'_, Self> {
        let loops = self.loops.clone();
        let mut lowering = Lowering::new(self);
        lowering.loops = loops;
        lowering.composes = lowering.target.composes;
        lowering.live = true;
        lowering
    }

    /// As [`Body::lowering`], for messages: what is not known of them is not computed.
    pub(super) fn with_known_strings(&mut self) -> Lowering<'_, Self> {
        let mut lowering = self.lowering();
        lowering.composes = false;
        lowering
    }

    /// Whether a local variable is a number from here on, which needs no register.
    fn becomes_known(&mut self, target: &ComponentReference, value: &Lowered<Operand>) -> bool {
        let Lowered::Array(array) = value else { return false };
        let ([Operand::Constant(_)], Some(name)) = (array.elements.as_slice(), target.as_ident())
        else {
            return false;
        };
        let is_local = |c: &FunctionComponent| {
            c.name == name && c.dims.is_empty() && !matches!(c.value_type, ValueType::String)
        };
        if !array.dims.is_empty()
            || !self.known_once.contains(&name)
            || !self.function.locals.iter().any(is_local)
        {
            return false;
        }
        match self.locals.iter_mut().find(|(local, _)| *local == name) {
            Some((_, local)) => {
                *local = value.clone();
                true
            }
            None => false,
        }
    }

    fn end_loop(&mut self) -> Flow<Operand> {
        for jump in self.breaks.pop().unwrap_or_default() {
            self.emitter.land(jump);
        }
        Flow::Next
    }

    fn unrolled(&mut self, index: &ForIndex, body: Iteration<'_>) -> Done<Self> {
        let mut variables = self.lowering().loop_variables(index)?;
        for LoopVariable { value, .. } in &mut variables {
            if let Operand::Register(_) = value {
                *value = Operand::Register(self.emitter.copies(&[*value]));
            }
        }
        self.breaks.push(Vec::new());
        for variable in variables {
            self.loops.push(variable);
            let iteration = body.execute(self);
            self.loops.pop();
            iteration?;
        }
        Ok(self.end_loop())
    }

    fn counted(&mut self, index: &ForIndex, body: Iteration<'_>) -> Done<Self> {
        let range = self.iterated(index)?;
        let counting = self.begin_counting(range);
        self.breaks.push(Vec::new());
        let value_type = self.lowering().type_of_index(index);
        let value = Operand::Register(counting.variable);
        self.loops.push(LoopVariable { name: index.name.node, value, value_type });
        let iteration = body.execute(self);
        self.loops.pop();
        iteration?;
        self.emitter.jump_to(counting.start);
        self.emitter.land(counting.exit);
        Ok(self.end_loop())
    }

    /// Replaces a loop, written since a mark, by its iterations if they are few and short.
    fn unroll_if_short(
        &mut self,
        index: &ForIndex,
        body: Iteration<'_>,
        mark: &Mark,
    ) -> Done<Self> {
        let length = self.emitter.len() - mark.length();
        let written = self.mark();
        let is_short = is_short(index, length, |e| self.lowering().known(e).ok());
        self.restore(&written);
        if !is_short {
            return Ok(Flow::Next);
        }
        self.restore(mark);
        self.unrolled(index, body).or_else(|_| {
            // What is wrong in an iteration may be in a branch that is never taken.
            self.restore(mark);
            self.counted(index, body)
        })
    }

    /// The head of a loop, with its variable.
    pub(super) fn begin_counting(&mut self, range: Iterated) -> Counting {
        let (counter, variable) = (self.emitter.block(1), self.emitter.block(1));
        let one = self.emitter.register(Operand::Constant(1.0));
        let goes_on = self.emitter.block(1);
        self.emitter.emit(Instruction::Constant { d: counter, value: 0.0 });
        let start = self.emitter.len();
        let operator = crate::symbolic::RelationOperator::Less;
        let (a, b) = (counter, self.emitter.register(range.iterations()));
        self.emitter.emit(Operation::binary(Operator::Relation(operator), goes_on, a, b).into());
        let exit = self.emitter.jump_unless(Operand::Register(goes_on));
        match range {
            Iterated::Range { first, .. } => {
                self.emitter
                    .emit(Operation::binary(Operator::Mul, variable, counter, first + 1).into());
                self.emitter
                    .emit(Operation::binary(Operator::Add, variable, first, variable).into());
            }
            Iterated::Elements { first, .. } => {
                self.emitter.emit(Instruction::Load { d: variable, base: first, offset: counter });
            }
        }
        self.emitter.emit(Operation::binary(Operator::Add, counter, counter, one).into());
        Counting { variable, start, exit }
    }

    /// What a loop runs over, computed once.
    fn iterated(&mut self, index: &ForIndex) -> Result<Iterated, Diagnostic> {
        if let Some(ExpressionKind::Range { start, step, stop }) =
            index.range.as_ref().map(|range| &range.kind)
        {
            let start = self.lowering().scalar(start)?;
            let step = match step {
                Some(step) => self.lowering().scalar(step)?,
                None => Operand::Constant(1.0),
            };
            let stop = self.lowering().scalar(stop)?;
            return Ok(self.range([start, step, stop]));
        }
        let variables = self.lowering().loop_variables(index)?;
        let elements: Vec<_> = variables.iter().map(|variable| variable.value).collect();
        let first = self.emitter.copies(&elements);
        Ok(Iterated::Elements { first, n: elements.len() })
    }

    /// The range from a start by steps to a stop, computed once.
    pub(super) fn range(&mut self, range: [Operand; 3]) -> Iterated {
        let first = self.emitter.copies(&range);
        let iterations = self.emitter.block(1);
        self.emitter.emit(Instruction::Iterations { d: iterations, range: first });
        Iterated::Range { first, iterations }
    }

    fn assertion(
        &mut self,
        AssertArguments { condition, message, level }: AssertArguments<'_>,
        span: Span,
    ) -> Result<(), Diagnostic> {
        let is_warning = match level {
            Some(level) => self.lowering().known(level)? == 1.0,
            None => false,
        };
        let condition = self.lowering().scalar(condition)?;
        if let Operand::Constant(value) = condition
            && value != 0.0
        {
            return Ok(());
        }
        match is_warning {
            true => self.warn_unless(condition, message),
            false => self.fail_unless(condition, message, span)?,
        }
        Ok(())
    }
}

/// A condition that is not known is a jump, and so are `break` and `return`: the walk continues with the
/// statement after them, which has its place in the code.
impl Domain for Body<'_, '_> {
    type Condition = Operand;

    fn statement(&mut self, statement: &Statement) -> Done<Self> {
        let limit = self.instances.max_instructions();
        if self.emitter.len() > limit {
            return Err(fault!(
                NOT_SUPPORTED,
                "this function needs more than {limit} instructions"
            )
            .at(statement.span));
        }
        self.emitter.place(statement.span);
        self.emitter.open();
        self.statement_of_any_size(statement)?;
        self.emitter.close();
        Ok(Flow::Next)
    }

    fn assign_value(&mut self, to: &ComponentReference, value: &Expression, _: Span) -> Executed {
        let value = self.lowering().lower(value)?;
        match self.becomes_known(to, &value) {
            true => Ok(()),
            false => self.assign(to, value),
        }
    }

    fn assign_outputs(&mut self, targets: &Targets, call: &Expression) -> Executed {
        let outputs = assigned_outputs(&mut self.lowering(), targets, call, |own, user, given| {
            own.user_call(user, given, call.span)
        })?;
        outputs.into_iter().try_for_each(|(target, output)| self.assign(target, output))
    }

    fn call_statement(&mut self, call: &Expression) -> Executed {
        match CallStatement::new(self, call)? {
            CallStatement::Assert(arguments) => self.assertion(arguments, call.span),
            CallStatement::Fail(message) => {
                self.fail_unless(Operand::Constant(0.0), message, call.span)
            }
            CallStatement::Call(user, arguments) if prints(&user) => {
                self.printing(arguments, call.span)
            }
            CallStatement::Call(user, arguments) => {
                self.lowering().user_call(&user, arguments, call.span).map(|_| ())
            }
        }
    }

    fn decide(&mut self, condition: &Expression) -> Result<Decision<Operand>, Diagnostic> {
        Ok(match self.lowering().scalar(condition)? {
            Operand::Constant(value) => Decision::Known(value != 0.0),
            register => Decision::Open(register),
        })
    }

    fn either(
        &mut self,
        condition: Operand,
        first: impl FnOnce(&mut Self) -> Done<Self>,
        second: impl FnOnce(&mut Self) -> Done<Self>,
    ) -> Done<Self> {
        let skip = self.emitter.jump_unless(condition);
        first(self)?;
        let end = self.emitter.jump();
        self.emitter.land(skip);
        second(self)?;
        self.emitter.land(end);
        Ok(Flow::Next)
    }

    /// As a loop; unrolled if it is short or if the body needs sizes that change from iteration to
    /// iteration; where that is not possible either, the statements with such sizes are written size
    /// by size.
    fn for_loop(&mut self, index: &ForIndex, body: Iteration<'_>) -> Done<Self> {
        let mark = self.mark();
        let error = match self.counted(index, body) {
            Ok(_) => return self.unroll_if_short(index, body, &mark),
            Err(e) if e.code == NO_CONSTANT_VALUE => e,
            other => return other,
        };
        self.restore(&mark);
        match self.unrolled(index, body) {
            Err(e) if e.code == NO_CONSTANT_VALUE => {}
            result => return result,
        }
        if !self.instances.sizes_at_run_time || self.loop_sizes {
            return Err(error);
        }
        self.restore(&mark);
        self.loop_sizes = true;
        let result = self.counted(index, body);
        self.loop_sizes = false;
        result
    }

    fn while_loop(&mut self, condition: &Expression, body: Iteration<'_>) -> Done<Self> {
        let start = self.emitter.len();
        self.emitter.place(condition.span);
        let exit = match self.decide(condition)? {
            Decision::Known(false) => return Ok(Flow::Next),
            Decision::Known(true) => None,
            Decision::Open(register) => Some(self.emitter.jump_unless(register)),
        };
        self.breaks.push(Vec::new());
        body.execute(self)?;
        self.emitter.jump_to(start);
        exit.into_iter().for_each(|exit| self.emitter.land(exit));
        Ok(self.end_loop())
    }

    fn when_statement(&mut self, _: &Branches, span: Span) -> Done<Self> {
        Err(fault!(NOT_SUPPORTED, "`when` in a function").at(span))
    }

    fn leave_loop(&mut self, span: Span) -> Done<Self> {
        match self.breaks.last_mut() {
            Some(breaks) => {
                breaks.push(self.emitter.jump());
                Ok(Flow::Next)
            }
            None => Err(fault!(NOT_SUPPORTED, "`break` outside a loop").at(span)),
        }
    }

    fn leave_function(&mut self, _: Span) -> Done<Self> {
        self.returns.push(self.emitter.jump());
        Ok(Flow::Next)
    }
}

/// The head of a loop.
#[derive(Debug, Clone, Copy)]
pub(super) struct Counting {
    /// The loop variable.
    pub(super) variable: Register,
    /// Where an iteration begins.
    pub(super) start: usize,
    /// The jump out of the loop, after the last iteration.
    pub(super) exit: usize,
}

/// What a loop runs over.
#[derive(Debug, Clone, Copy)]
pub(super) enum Iterated {
    /// Three registers from `first` on, and one for the number of iterations.
    Range { first: Register, iterations: Register },
    /// Elements in a row.
    Elements { first: Register, n: usize },
}

impl Iterated {
    fn iterations(self) -> Operand {
        match self {
            Iterated::Range { iterations, .. } => Operand::Register(iterations),
            Iterated::Elements { n, .. } => Operand::Constant(n as f64),
        }
    }
}

/// The scalars of an array, `None` for other values.
pub(super) fn elements(value: &Lowered<Operand>) -> Option<&Array<Operand>> {
    match value {
        Lowered::Array(array) => Some(array),
        _ => None,
    }
}
