//! Right-hand sides of the sensitivity equations, f_y s + f_p, with the sparse Jacobian f_y of the
//! integrator: there is code for the entries of f_p alone, of which networks have one to five in a row.
//!
//! Measured beside straight-line code for all columns, a simulation with derivatives:
//! SalazarCavazos_MBoC2020 (75 states, 6 parameters) takes 91 ms instead of 134, and
//! Boehm_JProteomeRes2014 (8 and 6) 1.0 instead of 1.1 ms.

use super::super::code::Outputs;
use crate::arithmetic::Register;
use crate::sim::Pattern;
use crate::symbolic::VarId;

/// A variable that keeps its value between steps, with the registers of its derivatives by column.
#[derive(Debug, Clone)]
pub(crate) struct Kept {
    pub(crate) variable: VarId,
    pub(crate) registers: Vec<Register>,
}

/// The part f_p, and what variables that are kept between events add. The derivatives of an unknown
/// or of a kept variable are in registers one after another, by column.
#[derive(Debug)]
pub(crate) struct RightSides {
    /// Their nonzeros: for parameters, then for kept variables.
    pub(crate) code: Outputs,
    /// Row and column of the former.
    pub(super) direct: Vec<(u32, u32)>,
    /// Of the latter the row and the first register of the derivatives of the variable.
    pub(super) kept: Vec<(u32, Register)>,
    pub(super) n_rows: usize,
    pub(super) n_columns: usize,
}

/// What right-hand sides are computed in.
#[derive(Debug, Clone)]
pub(crate) struct RightSidesSpace {
    /// The nonzeros of the Jacobian.
    pub(crate) jacobian: Vec<f64>,
    /// The results of the code.
    pub(crate) entries: Vec<f64>,
    /// By rows.
    sums: Vec<f64>,
}

impl RightSides {
    /// Number of its results.
    pub(crate) fn len(&self) -> usize {
        self.n_rows * self.n_columns
    }

    /// What its results are computed in.
    pub(crate) fn space(&self, pattern: &Pattern) -> RightSidesSpace {
        RightSidesSpace {
            jacobian: vec![0.0; pattern.rows.len()],
            entries: vec![0.0; self.code.outputs.len()],
            sums: vec![0.0; self.len()],
        }
    }

    /// Writes all columns one after another, each as long as `out` has room for. The Jacobian and the
    /// entries are in `space`.
    pub(crate) fn write(
        &self,
        pattern: &Pattern,
        unknowns: &[Kept],
        registers: &[f64],
        space: &mut RightSidesSpace,
        out: &mut [f64],
    ) {
        let m = self.n_columns;
        if m == 0 {
            return;
        }
        let RightSidesSpace { jacobian, entries, sums } = space;
        sums.fill(0.0);
        let mut add = |row: usize, factor: f64, first: Register| {
            let sums = sums[row * m..][..m].iter_mut();
            for (sum, s) in sums.zip(&registers[first as usize..][..m]) {
                *sum += factor * s;
            }
        };
        for (column, unknown) in unknowns.iter().enumerate() {
            for at in pattern.column(column) {
                add(pattern.rows[at], jacobian[at], unknown.registers[0]);
            }
        }
        let (of_parameters, of_kept) = entries.split_at(self.direct.len());
        for ((row, first), factor) in self.kept.iter().zip(of_kept) {
            add(*row as usize, *factor, *first);
        }
        for ((row, column), value) in self.direct.iter().zip(of_parameters) {
            sums[*row as usize * m + *column as usize] += value;
        }
        for (column, out) in out.chunks_exact_mut(out.len() / m).enumerate() {
            for (row, out) in out.iter_mut().enumerate() {
                *out = sums[row * m + column];
            }
        }
    }
}
