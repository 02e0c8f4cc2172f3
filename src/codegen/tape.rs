//! Instructions on registers. A jump skips what is not needed, so that a branch that is not taken
//! is never evaluated.

use super::linear_system::LinearSolve;
use super::memory::Memory;
use crate::elementary;
use crate::symbolic::RelationOperator;
use crate::symbolic::function::FunctionId;

/// A register.
pub(crate) type Register = u32;

/// One instruction; `d` is the register written.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Instruction {
    Move {
        d: Register,
        a: Register,
    },
    Neg {
        d: Register,
        a: Register,
    },
    Not {
        d: Register,
        a: Register,
    },
    Add {
        d: Register,
        a: Register,
        b: Register,
    },
    Sub {
        d: Register,
        a: Register,
        b: Register,
    },
    Mul {
        d: Register,
        a: Register,
        b: Register,
    },
    Div {
        d: Register,
        a: Register,
        b: Register,
    },
    Pow {
        d: Register,
        a: Register,
        b: Register,
    },
    And {
        d: Register,
        a: Register,
        b: Register,
    },
    Or {
        d: Register,
        a: Register,
        b: Register,
    },
    Relation {
        operator: RelationOperator,
        d: Register,
        a: Register,
        b: Register,
    },
    Unary {
        id: FunctionId,
        d: Register,
        a: Register,
        function: fn(f64) -> f64,
    },
    Binary {
        id: FunctionId,
        d: Register,
        a: Register,
        b: Register,
        function: fn(f64, f64) -> f64,
    },
    /// The call of this number in the tape.
    Call {
        call: u32,
    },
    /// Fails if a component of a record that a function gave has no value.
    Given {
        a: Register,
        function: u32,
    },
    /// The linear system of this number in the tape.
    Solve {
        solve: u32,
    },
    JumpUnless {
        a: Register,
        target: u32,
    },
    Jump {
        target: u32,
    },
    /// Runs the routine at the target unless it has run; the link keeps the way back.
    Perform {
        target: u32,
        link: Register,
    },
    /// Ends a routine.
    Return {
        link: Register,
    },
}

impl Instruction {
    /// Visits the registers read, but for those of calls and linear systems.
    pub(super) fn for_each_operand(&self, mut visit: impl FnMut(Register)) {
        match *self {
            Instruction::Move { a, .. }
            | Instruction::Neg { a, .. }
            | Instruction::Not { a, .. }
            | Instruction::Unary { a, .. }
            | Instruction::Given { a, .. }
            | Instruction::JumpUnless { a, .. } => visit(a),
            Instruction::Add { a, b, .. }
            | Instruction::Sub { a, b, .. }
            | Instruction::Mul { a, b, .. }
            | Instruction::Div { a, b, .. }
            | Instruction::Pow { a, b, .. }
            | Instruction::And { a, b, .. }
            | Instruction::Or { a, b, .. }
            | Instruction::Relation { a, b, .. }
            | Instruction::Binary { a, b, .. } => {
                visit(a);
                visit(b);
            }
            Instruction::Call { .. }
            | Instruction::Solve { .. }
            | Instruction::Jump { .. }
            | Instruction::Perform { .. }
            | Instruction::Return { .. } => {}
        }
    }

    /// The register written, but for those of calls and linear systems.
    pub(super) fn result(&self) -> Option<Register> {
        match *self {
            Instruction::Move { d, .. }
            | Instruction::Neg { d, .. }
            | Instruction::Not { d, .. }
            | Instruction::Unary { d, .. }
            | Instruction::Add { d, .. }
            | Instruction::Sub { d, .. }
            | Instruction::Mul { d, .. }
            | Instruction::Div { d, .. }
            | Instruction::Pow { d, .. }
            | Instruction::And { d, .. }
            | Instruction::Or { d, .. }
            | Instruction::Relation { d, .. }
            | Instruction::Binary { d, .. } => Some(d),
            Instruction::Call { .. }
            | Instruction::Given { .. }
            | Instruction::Solve { .. }
            | Instruction::Jump { .. }
            | Instruction::JumpUnless { .. }
            | Instruction::Perform { .. }
            | Instruction::Return { .. } => None,
        }
    }

    /// The instruction in code that begins further behind.
    pub(super) fn shift(&mut self, by: u32) {
        if let Instruction::Jump { target } | Instruction::JumpUnless { target, .. } = self {
            *target += by;
        }
    }
}

/// A call of a function: its scalar outputs, or their derivatives for some inputs, are written to
/// registers in a row.
#[derive(Debug, Clone)]
pub(super) struct Call {
    pub(super) function: u32,
    pub(super) inputs: Box<[u32]>,
    pub(super) arguments: Box<[Register]>,
    pub(super) d: Register,
}

/// A sequence of instructions.
#[derive(Debug, Clone, Default)]
pub(crate) struct Tape {
    pub(crate) code: Vec<Instruction>,
    pub(super) calls: Vec<Call>,
    pub(super) solves: Vec<LinearSolve>,
    /// First instructions of the routines, ascending, and their links.
    pub(super) routines: Vec<(u32, Register)>,
    /// First instruction of every origin, ascending.
    pub(super) origins: Vec<(u32, u32)>,
}

impl Tape {
    /// Runs it; on failure the number of the instruction without a finite value.
    pub(crate) fn run(&self, memory: &mut Memory) -> Result<(), u32> {
        let Memory { registers: r, calls, systems } = memory;
        self.routines.iter().for_each(|(_, link)| r[*link as usize] = 0.0);
        let mut at = 0usize;
        while let Some(instruction) = self.code.get(at) {
            at += 1;
            match *instruction {
                Instruction::Move { d, a } => r[d as usize] = r[a as usize],
                Instruction::Neg { d, a } => r[d as usize] = -r[a as usize],
                Instruction::Not { d, a } => {
                    r[d as usize] = f64::from(u8::from(r[a as usize] == 0.0));
                }
                Instruction::Add { d, a, b } => r[d as usize] = r[a as usize] + r[b as usize],
                Instruction::Sub { d, a, b } => r[d as usize] = r[a as usize] - r[b as usize],
                Instruction::Mul { d, a, b } => r[d as usize] = r[a as usize] * r[b as usize],
                Instruction::Div { d, a, b } => {
                    finite(r, d, r_of(a, b, |x, y| x / y), at)?;
                }
                Instruction::Pow { d, a, b } => finite(r, d, r_of(a, b, elementary::powf), at)?,
                Instruction::And { d, a, b } => {
                    let both = r[a as usize] != 0.0 && r[b as usize] != 0.0;
                    r[d as usize] = f64::from(u8::from(both));
                }
                Instruction::Or { d, a, b } => {
                    let any = r[a as usize] != 0.0 || r[b as usize] != 0.0;
                    r[d as usize] = f64::from(u8::from(any));
                }
                Instruction::Relation { operator, d, a, b } => {
                    let holds = operator.holds(r[a as usize], r[b as usize]);
                    r[d as usize] = f64::from(u8::from(holds));
                }
                Instruction::Unary { d, a, function, .. } => {
                    let value = function(r[a as usize]);
                    if !value.is_finite() {
                        return Err(at as u32 - 1);
                    }
                    r[d as usize] = value;
                }
                Instruction::Binary { d, a, b, function, .. } => {
                    finite(r, d, r_of(a, b, function), at)?;
                }
                Instruction::Call { call } => {
                    let call = &self.calls[call as usize];
                    calls.run(call, r).map_err(|_| at as u32 - 1)?;
                }
                Instruction::Given { a, .. } => {
                    if r[a as usize].is_nan() {
                        return Err(at as u32 - 1);
                    }
                }
                Instruction::Solve { solve } => {
                    let solve = &self.solves[solve as usize];
                    let system = &mut systems[solve.system as usize];
                    system.run(solve, r).map_err(|_| at as u32 - 1)?;
                }
                Instruction::JumpUnless { a, target } => {
                    if r[a as usize] == 0.0 {
                        at = target as usize;
                    }
                }
                Instruction::Jump { target } => at = target as usize,
                Instruction::Perform { target, link } => {
                    if r[link as usize] == 0.0 {
                        r[link as usize] = at as f64;
                        at = target as usize;
                    }
                }
                Instruction::Return { link } => at = r[link as usize] as usize,
            }
        }
        Ok(())
    }

    /// The origin of an instruction.
    pub(crate) fn origin(&self, at: u32) -> u32 {
        let position = self.origins.partition_point(|(first, _)| *first <= at);
        position.checked_sub(1).map_or(u32::MAX, |position| self.origins[position].1)
    }
}

/// An operation on two registers.
fn r_of(a: Register, b: Register, operation: impl Fn(f64, f64) -> f64) -> impl Fn(&[f64]) -> f64 {
    move |r| operation(r[a as usize], r[b as usize])
}

/// Writes a value that must be finite.
#[inline(always)]
fn finite(r: &mut [f64], d: Register, value: impl Fn(&[f64]) -> f64, at: usize) -> Result<(), u32> {
    let value = value(r);
    if !value.is_finite() {
        return Err(at as u32 - 1);
    }
    r[d as usize] = value;
    Ok(())
}
