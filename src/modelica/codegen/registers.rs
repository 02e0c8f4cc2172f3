//! The registers of a program, and what is computed in them once a simulation.

use super::places::Places;
use super::tape::Tape;
use crate::arithmetic::{Operator, Register};
use crate::bytecode::Functions;
use crate::symbolic::Expr;
use rustc_hash::FxHashMap;
use std::sync::Arc;

/// The registers of a program: one for every variable, then constants and temporaries.
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize)]
pub(crate) struct Registers {
    next: Register,
    n_variables: usize,
    constants: FxHashMap<u64, Register>,
    /// Those of the system: see [`Registers::use_functions`].
    #[serde(skip)]
    functions: Arc<Functions>,
    /// Workspaces of linear systems by matrix, and their sizes.
    #[serde(deserialize_with = "crate::symbolic::read_by_matrix")]
    workspaces: FxHashMap<Expr, u32>,
    systems: Vec<usize>,
    /// What the tape that is written at the moment has computed.
    #[serde(skip)]
    pub(super) places: Places,
    /// Registers with their values.
    pub(super) values: Vec<(Register, f64)>,
    /// What is computed once a simulation.
    pub(crate) hoisted: Hoisted,
}

impl Registers {
    pub(super) fn new(n_variables: usize, functions: Arc<Functions>) -> Registers {
        let next = n_variables as Register;
        Registers {
            next,
            n_variables,
            constants: FxHashMap::default(),
            functions,
            workspaces: FxHashMap::default(),
            systems: Vec::new(),
            places: Places::default(),
            values: Vec::new(),
            hoisted: Hoisted::default(),
        }
    }

    /// Registers that were read from a file get their functions.
    pub(super) fn use_functions(&mut self, functions: &Arc<Functions>) {
        self.functions = functions.clone();
    }

    /// Sizes of the linear systems that tapes on these registers solve.
    pub(super) fn systems(&self) -> &[usize] {
        &self.systems
    }

    /// The workspace for a matrix of n rows. Tapes that share it factorise the matrix again.
    pub(super) fn workspace(&mut self, matrix: Expr, n: usize) -> u32 {
        *self.workspaces.entry(matrix).or_insert_with(|| {
            self.systems.push(n);
            self.systems.len() as u32 - 1
        })
    }

    /// The workspace for a matrix, if any tape solves a system with it.
    pub(crate) fn workspace_of(&self, matrix: Expr) -> Option<u32> {
        self.workspaces.get(&matrix).copied()
    }

    /// The registers of constants.
    pub(super) fn constants(&self) -> impl Iterator<Item = &Register> {
        self.constants.values()
    }

    /// The workspaces of matrices.
    pub(super) fn workspaces(&self) -> impl Iterator<Item = &u32> {
        self.workspaces.values()
    }

    /// The functions that tapes on these registers call.
    pub(super) fn functions(&self) -> &Arc<Functions> {
        &self.functions
    }

    pub(super) fn n_variables(&self) -> usize {
        self.n_variables
    }

    pub(crate) fn len(&self) -> usize {
        self.next as usize
    }

    pub(super) fn fresh(&mut self) -> Register {
        self.row(1)
    }

    /// New registers that follow each other.
    pub(super) fn row(&mut self, n: usize) -> Register {
        self.next += n as Register;
        self.next - n as Register
    }

    pub(super) fn constant(&mut self, value: f64) -> Register {
        if let Some(known) = self.constants.get(&value.to_bits()) {
            return *known;
        }
        let register = self.fresh();
        self.constants.insert(value.to_bits(), register);
        self.values.push((register, value));
        self.hoisted.fix(register);
        register
    }
}

/// The instructions moved.
#[derive(Debug, Clone, Default, serde::Serialize, serde::Deserialize)]
pub(crate) struct Hoisted {
    pub(crate) tape: Tape,
    /// Only saves work in programs that are compiled for the same registers later.
    #[serde(skip)]
    pub(super) results: FxHashMap<(Operator, Register, Register), Register>,
    pub(super) fixed: Vec<bool>,
}

impl Hoisted {
    /// Declares a register fixed.
    pub(super) fn fix(&mut self, register: Register) {
        let register = register as usize;
        if self.fixed.len() <= register {
            self.fixed.resize(register + 1, false);
        }
        self.fixed[register] = true;
    }

    pub(super) fn is_fixed(&self, register: Register) -> bool {
        self.fixed.get(register as usize).copied().unwrap_or(false)
    }
}
