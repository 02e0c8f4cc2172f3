//! Symbolic expressions become instructions, common subexpressions computed once.

use super::branches::{Branches, Computed, ComputedExpressions};
use super::hoist::Hoisting;
use super::instruction::{Call, Instruction, LinearSolve};
use super::routines::{Routine, Routines};
use super::tape::Tape;
use crate::arithmetic::{Operation, Operator, Register};
use crate::codegen::registers::Registers;
use crate::symbolic::{Expr, Node, Pool, VarId};
use rustc_hash::{FxHashMap, FxHashSet};

/// What has several results.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
enum Several {
    /// A call: function, inputs that it is differentiated for, the list of its arguments.
    Call(u32, Box<[u32]>, Expr),
    /// The factors of a matrix, which are in its workspace.
    Factors(Expr),
    /// The solution of a linear system: matrix, right side, whether it is a derivative.
    Solution(Expr, Expr, bool),
}

/// Writes one tape.
pub(super) struct TapeBuilder<'a> {
    pool: &'a Pool,
    registers: &'a mut Registers,
    tape: Tape,
    known: ComputedExpressions,
    /// First registers of what has several results.
    several: Computed<Several>,
    /// Registers of variables that are not in their own.
    moved: FxHashMap<VarId, Register>,
    /// Variables that have been read.
    read: FxHashSet<VarId>,
    hoisting: Hoisting,
    branches: Branches,
    routines: Routines,
    origin: u32,
}

impl<'a> TapeBuilder<'a> {
    pub(super) fn new(pool: &'a Pool, registers: &'a mut Registers) -> TapeBuilder<'a> {
        registers.places.begin();
        TapeBuilder {
            pool,
            registers,
            tape: Tape::default(),
            known: ComputedExpressions::default(),
            several: Computed::new(),
            moved: FxHashMap::default(),
            read: FxHashSet::default(),
            hoisting: Hoisting::Never,
            branches: Branches::new(),
            routines: Routines::default(),
            origin: u32::MAX,
        }
    }

    /// Computes what parameters determine once a simulation.
    pub(super) fn hoisting(mut self, hoisting: Hoisting) -> TapeBuilder<'a> {
        self.hoisting = hoisting;
        self
    }

    pub(super) fn finish(mut self) -> Tape {
        self.routines.append(&mut self.tape);
        self.tape
    }

    /// What follows comes from this equation.
    pub(super) fn origin(&mut self, origin: u32) {
        self.tape.origins.push((self.tape.code.len() as u32, origin));
        self.origin = origin;
    }

    /// `variable := value`, kept in whatever register holds the value.
    pub(super) fn define(&mut self, variable: VarId, value: Expr) {
        let register = self.emit(value);
        self.moved.insert(variable, register);
    }

    /// `variable := value`, written to the variable's own register.
    pub(super) fn store(&mut self, variable: VarId, value: Expr) {
        let a = self.emit(value);
        self.tape.code.push(Instruction::Move { d: variable.0, a });
        // What branches computed from the value before, or on condition of it, is not known again.
        if self.read.contains(&variable) {
            self.branches.forget();
            self.routines.forget();
        }
    }

    /// Writes a value that has been computed to a register; nothing is computed afterwards.
    pub(super) fn copy(&mut self, d: Register, a: Register) {
        self.tape.code.push(Instruction::Move { d, a });
    }

    /// Writes a constant to a register that no expression reads.
    pub(super) fn mark(&mut self, d: Register, constant: Expr) {
        let a = self.emit(constant);
        self.tape.code.push(Instruction::Move { d, a });
    }

    /// Computes an expression; returns where its value is.
    pub(super) fn emit(&mut self, root: Expr) -> Register {
        let mut stack = vec![(root, false)];
        while let Some((expr, ready)) = stack.pop() {
            if self.known(expr).is_some() {
                continue;
            }
            if !ready {
                if let Some(routine) = self.routine(expr) {
                    self.tape.code.push(routine.perform());
                    self.note(expr, routine.result);
                    continue;
                }
                stack.push((expr, true));
                match self.pool.node(expr) {
                    // Its branches are computed only where they are needed.
                    Node::If(condition, ..) => stack.push((*condition, false)),
                    node => node.for_each_operand(|operand| stack.push((operand, false))),
                }
                continue;
            }
            let register = self.instruction(expr);
            self.note(expr, register);
        }
        self.register(root)
    }

    /// Where an expression is that has been computed.
    fn register(&self, expr: Expr) -> Register {
        self.known(expr).expect("operands are computed first")
    }

    fn known(&self, expr: Expr) -> Option<Register> {
        self.known.get(expr, &self.registers.places, &self.branches)
    }

    fn note(&mut self, expr: Expr, register: Register) {
        self.known.insert(expr, register, &mut self.registers.places, &self.branches);
    }

    fn instruction(&mut self, expr: Expr) -> Register {
        let of = |a: &Expr| self.register(*a);
        let node = self.pool.node(expr);
        match node {
            Node::Constant(number) => return self.registers.constant(number.0),
            Node::Variable(v) => {
                self.read.insert(*v);
                return self.moved.get(v).copied().unwrap_or(v.0);
            }
            Node::If(condition, a, b) => {
                let condition = of(condition);
                let before = self.tape.code.len();
                let register = self.branches(condition, *a, *b);
                self.routines.note(expr, self.tape.code.len() - before);
                return register;
            }
            Node::Call { function, output, arguments } => {
                let a = output + self.call(*function, Box::new([]), *arguments);
                let functions = self.registers.functions();
                if !functions.codes[*function as usize].may_lack {
                    return a;
                }
                let (is_zero, function) = (functions.takes_defaults, *function);
                let d = self.registers.fresh();
                self.tape.code.push(Instruction::Given { d, a, is_zero, function });
                return d;
            }
            Node::CallDerivative { function, output, inputs, arguments } => {
                return output + self.call(*function, inputs.clone(), *arguments);
            }
            // Its entries are read where it is used.
            Node::List(_) => return 0,
            Node::Solution { matrix, right, output, is_derivative } => {
                return output + self.solution(*matrix, *right, *is_derivative);
            }
            _ => {}
        }
        let operation = self.operation(node);
        let in_branch = self.branches.is_inside();
        match self.registers.hoist(operation, self.hoisting, in_branch, self.origin) {
            Some(hoisted) => hoisted,
            None => {
                self.tape.code.push(operation.into());
                self.registers.fresh()
            }
        }
    }

    /// The operation that a node is, on operands that have been computed, to the next new register.
    fn operation(&self, node: &Node) -> Operation {
        let Some((operator, a, b)) = Operator::of_node(node) else {
            unreachable!("what else there is has been computed")
        };
        let d = self.registers.len() as Register;
        match operator {
            Operator::Pow if self.pool.as_constant(b) == Some(2.0) => {
                Operation { operator: Operator::Mul, d, a: self.register(a), b: self.register(a) }
            }
            _ => Operation { operator, d, a: self.register(a), b: self.register(b) },
        }
    }

    /// A call, once for all its outputs; returns the first register of its results.
    fn call(&mut self, function: u32, inputs: Box<[u32]>, arguments: Expr) -> Register {
        let key = Several::Call(function, inputs.clone(), arguments);
        if let Some(known) = self.several.get(&key, &self.branches) {
            return known;
        }
        self.compute_entries(arguments);
        // What is called to write has a place for an output that it does not have.
        let d = self.registers.row(self.registers.functions().n_outputs(function).max(1));
        self.tape.code.push(Instruction::Call { call: self.tape.calls.len() as u32 });
        let arguments = self.pool.entries(arguments).iter().map(|a| self.register(*a)).collect();
        self.tape.calls.push(Call { function, inputs, arguments, d });
        self.several.insert(key, d, &self.branches);
        d
    }

    /// Computes the entries of a list that are not known: a branch that is entered again knows the
    /// list from before, but of its entries only those that no other branch has computed since.
    fn compute_entries(&mut self, list: Expr) {
        let pool = self.pool;
        for entry in pool.entries(list) {
            if self.known(*entry).is_none() {
                self.emit(*entry);
            }
        }
    }

    /// The solution of a linear system, once for all unknowns; returns the register of the first.
    fn solution(&mut self, matrix: Expr, right: Expr, is_derivative: bool) -> Register {
        let key = Several::Solution(matrix, right, is_derivative);
        if let Some(known) = self.several.get(&key, &self.branches) {
            return known;
        }
        self.compute_entries(right);
        self.compute_entries(matrix);
        let right: Box<[Register]> =
            self.pool.entries(right).iter().map(|entry| self.register(*entry)).collect();
        let d = self.registers.row(right.len());
        let system = self.registers.workspace(matrix, right.len());
        let factors = Several::Factors(matrix);
        let entries = match self.several.get(&factors, &self.branches) {
            Some(_) => None,
            None => {
                self.several.insert(factors, 0, &self.branches);
                Some(self.entries(matrix))
            }
        };
        self.tape.code.push(Instruction::Solve { solve: self.tape.solves.len() as u32 });
        self.tape.solves.push(LinearSolve { system, entries, right, d, is_derivative });
        self.several.insert(key, d, &self.branches);
        d
    }

    /// The entries of a matrix that are not always zero.
    fn entries(&self, matrix: Expr) -> Box<[(u32, Register)]> {
        let entries = self.pool.entries(matrix).iter().enumerate();
        let nonzero = entries.filter(|(_, e)| self.pool.as_constant(**e) != Some(0.0));
        nonzero.map(|(place, entry)| (place as u32, self.register(*entry))).collect()
    }

    fn branches(&mut self, condition: Register, a: Expr, b: Expr) -> Register {
        let d = self.registers.fresh();
        let skip = self.tape.code.len();
        self.tape.code.push(Instruction::JumpUnless { a: condition, target: 0 });
        self.branch(condition, true, d, a);
        let end = self.tape.code.len();
        self.tape.code.push(Instruction::Jump { target: 0 });
        self.tape.code[skip] =
            Instruction::JumpUnless { a: condition, target: self.tape.code.len() as u32 };
        self.branch(condition, false, d, b);
        self.tape.code[end] = Instruction::Jump { target: self.tape.code.len() as u32 };
        d
    }

    /// The routine of what other branches compute as well, if it is long.
    fn routine(&mut self, e: Expr) -> Option<Routine> {
        if !self.branches.is_inside() {
            return None;
        }
        if let Some(known) = self.routines.get(e) {
            return Some(known);
        }
        if !self.routines.take_large(e) {
            return None;
        }
        let link = self.registers.fresh();
        let code = std::mem::take(&mut self.tape.code);
        let known = (self.known.suspend(), self.several.suspend());
        let suspended = self.branches.begin_routine();
        let result = self.emit(e);
        self.branches.end_routine(suspended);
        self.known.resume(known.0);
        self.several.resume(known.1);
        self.tape.code.push(Instruction::Return { link });
        let code = std::mem::replace(&mut self.tape.code, code);
        Some(self.routines.add(e, (self.origin, code), [link, result]))
    }

    fn branch(&mut self, condition: Register, holds: bool, d: Register, value: Expr) {
        self.branches.enter(condition, holds);
        let a = self.emit(value);
        self.branches.leave();
        self.tape.code.push(Instruction::Move { d, a });
    }
}
