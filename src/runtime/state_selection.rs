//! States chosen at run time: how good the choice is, and a better one.
//!
//! With J = (D S) the Jacobian of the constraints, D its columns of candidates that are determined
//! by the constraints and S those of states, the determined candidates change by W = D⁻¹ S for every
//! unit of the states, all relative to nominal values. The choice is good while no entry of W is
//! large. Exchanging the candidates of an entry beyond 1 multiplies det D by that entry; after as
//! many exchanges as are possible all entries are at most 1.
//!
//! Reference: [Mattsson & Söderlind 1993](crate::bibliography#mattsson-soderlind-1993), section 4.

use super::execution::run;
use crate::codegen::code::CompiledSelection;
use crate::codegen::memory::Memory;
use crate::sim::{DenseLu, Failure};

/// The largest entry of W that is good enough.
const LARGEST: f64 = 4.0;
/// At an event the choice changes from this part of it on.
const NEAR: f64 = 0.9;

/// The choice at hand.
#[derive(Debug, Clone)]
pub(super) struct Choice {
    /// Candidates that are states, by state.
    states: Vec<usize>,
    /// Candidates that are determined by the constraints.
    determined: Vec<usize>,
    nominal: Vec<f64>,
    /// By rows, relative to nominal values.
    jacobian: Vec<f64>,
    /// By states.
    changes: Vec<f64>,
    lu: DenseLu,
}

impl Choice {
    /// The first choice; `nominal` holds the magnitudes of the candidates.
    pub(super) fn new(selection: &CompiledSelection, nominal: Vec<f64>) -> Choice {
        let (k, s) = (selection.candidates.len(), selection.states.len());
        Choice {
            states: Vec::new(),
            determined: Vec::new(),
            nominal,
            jacobian: vec![0.0; k * (k - s)],
            changes: vec![0.0; s * (k - s)],
            lu: DenseLu::new(k - s),
        }
    }

    /// Returns to the first choice.
    pub(super) fn reset(&mut self, selection: &CompiledSelection, r: &mut Memory) {
        self.states.clone_from(&selection.chosen);
        let others = (0..selection.candidates.len()).filter(|c| !selection.chosen.contains(c));
        self.determined.clear();
        self.determined.extend(others);
        self.write(selection, r);
    }

    /// Positive while the choice is good, negative where it is not; continuous.
    pub(super) fn quality(
        &mut self,
        selection: &CompiledSelection,
        r: &mut Memory,
    ) -> Result<f64, Failure> {
        self.evaluate(selection, r)?;
        Ok(match self.largest_change() {
            Some((largest, ..)) => (LARGEST - largest) / (LARGEST + largest),
            None => -1.0,
        })
    }

    /// Makes a better choice if this one is near its end; whether it did.
    pub(super) fn improve(
        &mut self,
        selection: &CompiledSelection,
        r: &mut Memory,
    ) -> Result<bool, Failure> {
        self.evaluate(selection, r)?;
        let largest = self.largest_change();
        if largest.is_some_and(|(largest, ..)| largest <= NEAR * LARGEST) {
            return Ok(false);
        }
        if largest.is_none() {
            self.choose_anew();
        }
        // Every exchange enlarges the determinant: none comes back.
        let most = 10 * selection.candidates.len();
        for _ in 0..most {
            match self.largest_change() {
                Some((largest, state, row)) if largest > 1.0 + 1e-9 => {
                    std::mem::swap(&mut self.states[state], &mut self.determined[row]);
                }
                _ => break,
            }
        }
        self.write(selection, r);
        Ok(true)
    }

    fn evaluate(&mut self, selection: &CompiledSelection, r: &mut Memory) -> Result<(), Failure> {
        run(&selection.jacobian.tape, r)?;
        let k = self.nominal.len();
        let entries = self.jacobian.iter_mut().zip(&selection.jacobian.outputs).enumerate();
        for (at, (entry, register)) in entries {
            *entry = r[*register as usize] * self.nominal[at % k];
        }
        Ok(())
    }

    /// The largest entry of W with its state and its row; `None` if D is singular.
    fn largest_change(&mut self) -> Option<(f64, usize, usize)> {
        let (k, m) = (self.nominal.len(), self.determined.len());
        for (column, candidate) in self.determined.iter().enumerate() {
            for row in 0..m {
                self.lu.matrix()[column * m + row] = self.jacobian[row * k + candidate];
            }
        }
        self.lu.factorize().ok()?;
        let mut largest = (0.0, 0, 0);
        for (state, candidate) in self.states.iter().enumerate() {
            let column = &mut self.changes[state * m..(state + 1) * m];
            for (row, change) in column.iter_mut().enumerate() {
                *change = self.jacobian[row * k + candidate];
            }
            self.lu.solve(column);
            for (row, change) in column.iter().enumerate() {
                if !change.is_finite() {
                    return None;
                }
                if change.abs() > largest.0 {
                    largest = (change.abs(), state, row);
                }
            }
        }
        Some(largest)
    }

    /// Takes as determined the columns of the largest pivots.
    fn choose_anew(&mut self) {
        let k = self.nominal.len();
        let m = self.determined.len();
        let mut rest = self.jacobian.clone();
        let mut determined: Vec<usize> = Vec::with_capacity(m);
        for done in 0..m {
            let places = (done..m).flat_map(|row| (0..k).map(move |column| (row, column)));
            let open = places.filter(|(_, column)| !determined.contains(column));
            let size = |(row, column): &(usize, usize)| rest[row * k + column].abs();
            let Some((row, column)) = open.max_by(|a, b| size(a).total_cmp(&size(b))) else {
                return;
            };
            if rest[row * k + column] == 0.0 {
                return;
            }
            for c in 0..k {
                rest.swap(done * k + c, row * k + c);
            }
            for below in done + 1..m {
                let factor = rest[below * k + column] / rest[done * k + column];
                for c in 0..k {
                    rest[below * k + c] -= factor * rest[done * k + c];
                }
            }
            determined.push(column);
        }
        self.states = (0..k).filter(|c| !determined.contains(c)).collect();
        self.determined = determined;
    }

    /// Writes weights and states.
    fn write(&self, selection: &CompiledSelection, r: &mut Memory) {
        for ((chosen, weights), state) in
            self.states.iter().zip(&selection.weights).zip(&selection.states)
        {
            for (column, weight) in weights.iter().enumerate() {
                r[*weight as usize] = f64::from(u8::from(column == *chosen));
            }
            r[*state as usize] = r[selection.candidates[*chosen] as usize];
        }
    }
}
