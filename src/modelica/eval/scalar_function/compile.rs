//! From a function's tree to operations; `None` wherever the general way has to be taken.

use super::{Bounds, Component, Instruction, MAX_SLOTS, Operation, ScalarFunction, SlotType};
use crate::eval::scalar::{MAX_DEPTH, Scalar};
use crate::eval::{Function, FunctionBody, FunctionComponent, Host, ValueType};
use crate::functions::{self, Operator};
use crate::name::Ident;
use crate::syntax::ast::{
    Arguments, ComponentReference, Expression, ExpressionKind, ForIndex, Statement, StatementKind,
};

/// Compiles a function; `host` knows which names are not those of the language.
pub(super) fn compile(function: &Function, host: &mut dyn Host) -> Option<ScalarFunction> {
    let FunctionBody::Algorithm(statements) = &function.body else { return None };
    let all = || function.inputs.iter().chain(&function.outputs).chain(&function.locals);
    let mut compiler =
        Compiler { host, visible: Vec::new(), inputs: function.inputs.len(), kinds: Vec::new() };
    let components = all().map(|c| compiler.component(c)).collect::<Option<Vec<_>>>()?;
    let body = compiler.statements(statements, Nesting { depth: MAX_DEPTH, in_loop: false })?;
    Some(ScalarFunction {
        inputs: function.inputs.len(),
        outputs: function.outputs.len(),
        components,
        body,
    })
}

struct Compiler<'h> {
    host: &'h mut dyn Host,
    /// Names that may be read and their slots, innermost last.
    visible: Vec<(Ident, usize)>,
    /// How many of the first slots are inputs, which cannot be assigned.
    inputs: usize,
    /// Types of the slots; `None` for the variable of a loop.
    kinds: Vec<Option<SlotType>>,
}

/// Where a statement stands.
#[derive(Clone, Copy)]
struct Nesting {
    /// How many statements it may contain inside each other.
    depth: usize,
    in_loop: bool,
}

impl Compiler<'_> {
    fn component(&mut self, component: &FunctionComponent) -> Option<Component> {
        if !component.dims.is_empty() {
            return None;
        }
        let kind = match component.value_type {
            ValueType::Real => SlotType::Real,
            ValueType::Integer => SlotType::Integer,
            ValueType::Boolean => SlotType::Boolean,
            _ => return None,
        };
        let binding = match &component.binding {
            Some(binding) => Some(self.expression(binding, MAX_DEPTH)?),
            None => None,
        };
        self.slot(component.name, Some(kind))?;
        Some(Component { kind, binding })
    }

    /// A new slot, visible under this name.
    fn slot(&mut self, name: Ident, kind: Option<SlotType>) -> Option<usize> {
        let slot = self.kinds.len();
        self.kinds.push(kind);
        self.visible.push((name, slot));
        (slot < MAX_SLOTS).then_some(slot)
    }

    fn find(&self, reference: &ComponentReference) -> Option<usize> {
        let name = reference.as_ident()?;
        self.visible.iter().rev().find(|(known, _)| *known == name).map(|(_, slot)| *slot)
    }

    fn statements(&mut self, statements: &[Statement], place: Nesting) -> Option<Vec<Instruction>> {
        let inner = Nesting { depth: place.depth.checked_sub(1)?, ..place };
        statements.iter().map(|statement| self.statement(statement, inner)).collect()
    }

    fn statement(&mut self, statement: &Statement, place: Nesting) -> Option<Instruction> {
        match &statement.kind {
            StatementKind::Assign { target, value } => {
                let slot = self.find(target).filter(|slot| *slot >= self.inputs)?;
                let kind = self.kinds[slot]?;
                Some(Instruction::Assign { slot, kind, value: self.expression(value, MAX_DEPTH)? })
            }
            StatementKind::If { branches, otherwise } => {
                let branches = branches.iter().map(|(condition, statements)| {
                    let condition = self.expression(condition, MAX_DEPTH)?;
                    Some((condition, self.statements(statements, place)?))
                });
                let branches = branches.collect::<Option<Vec<_>>>()?;
                Some(Instruction::If { branches, otherwise: self.statements(otherwise, place)? })
            }
            StatementKind::For { indices, body } => self.for_statement(indices, body, place),
            StatementKind::While { condition, body } => Some(Instruction::While {
                condition: self.expression(condition, MAX_DEPTH)?,
                body: self.statements(body, Nesting { in_loop: true, ..place })?,
            }),
            StatementKind::Call(call) => self.assertion(call),
            StatementKind::Break => place.in_loop.then_some(Instruction::Break),
            StatementKind::Return => Some(Instruction::Return),
            StatementKind::MultiAssign { .. } | StatementKind::When { .. } => None,
        }
    }

    /// A loop over one range. With several, `break` would leave the inner one only.
    fn for_statement(
        &mut self,
        indices: &[ForIndex],
        body: &[Statement],
        place: Nesting,
    ) -> Option<Instruction> {
        let [ForIndex { name, range: Some(range) }] = indices else { return None };
        let ExpressionKind::Range { start, step, stop } = &range.kind else { return None };
        let step = match step {
            Some(step) => Some(self.expression(step, MAX_DEPTH)?),
            None => None,
        };
        let start = self.expression(start, MAX_DEPTH)?;
        let stop = self.expression(stop, MAX_DEPTH)?;
        let slot = self.slot(name.node, None)?;
        let body = self.statements(body, Nesting { in_loop: true, ..place });
        self.visible.pop();
        Some(Instruction::For { slot, bounds: Box::new(Bounds { start, step, stop }), body: body? })
    }

    /// `assert(condition, …)`: what else it says counts only where it fails.
    fn assertion(&mut self, call: &Expression) -> Option<Instruction> {
        let ExpressionKind::Call { function, arguments } = &call.kind else { return None };
        let condition = arguments.positional.first()?;
        let is_assert =
            functions::operator(function.as_ident()?.as_str()) == Some(Operator::Assert);
        let known = is_assert && self.is_of_language(function);
        known.then_some(Instruction::Assert(self.expression(condition, MAX_DEPTH)?))
    }

    fn is_of_language(&mut self, function: &ComponentReference) -> bool {
        matches!(self.host.callee(&function.name()), Ok(None))
    }

    fn expression(&mut self, expression: &Expression, depth: usize) -> Option<Operation> {
        let depth = depth.checked_sub(1)?;
        Some(match &expression.kind {
            ExpressionKind::Real(value) if value.is_finite() => {
                Operation::Constant(Scalar::Real(*value))
            }
            ExpressionKind::Integer(value) => Operation::Constant(Scalar::Integer(*value)),
            ExpressionKind::Boolean(value) => Operation::Constant(Scalar::Boolean(*value)),
            ExpressionKind::Reference(reference) => Operation::Slot(self.find(reference)?),
            ExpressionKind::Binary { operator, left, right } => {
                let operands = [self.expression(left, depth)?, self.expression(right, depth)?];
                Operation::Binary(*operator, Box::new(operands))
            }
            ExpressionKind::Unary { operator, operand } => {
                Operation::Unary(*operator, Box::new(self.expression(operand, depth)?))
            }
            ExpressionKind::If { branches, otherwise } => {
                let mut chosen = self.expression(otherwise, depth)?;
                for (condition, value) in branches.iter().rev() {
                    let condition = self.expression(condition, depth)?;
                    let value = self.expression(value, depth)?;
                    chosen = Operation::If(Box::new([condition, value, chosen]));
                }
                chosen
            }
            ExpressionKind::Call { function, arguments } => {
                self.builtin(function, arguments, depth)?
            }
            _ => return None,
        })
    }

    fn builtin(
        &mut self,
        function: &ComponentReference,
        arguments: &Arguments,
        depth: usize,
    ) -> Option<Operation> {
        let name = function.as_ident()?;
        let is_plain = arguments.named.is_empty() && arguments.iterators.is_empty();
        let entry = functions::find(name.as_str())?;
        let count = arguments.positional.len();
        let is_usable = is_plain && entry.is_of_scalars(count);
        if !is_usable || !self.is_of_language(function) {
            return None;
        }
        let operands = arguments.positional.iter().map(|a| self.expression(a, depth));
        Some(Operation::Builtin(entry, operands.collect::<Option<Vec<_>>>()?))
    }
}
