//! States chosen at run time: how good the choice is, and a better one.
//!
//! With J = (D S) the Jacobian of the constraints, D its columns of candidates that are determined
//! by the constraints and S those of states, the determined candidates change by W = D⁻¹ S for every
//! unit of the states, all relative to nominal values. The choice is good while no entry of W is
//! large. Exchanging the candidates of an entry beyond 1 multiplies det D by that entry; after as
//! many exchanges as are possible all entries are at most 1.
//!
//! The constraints of a large mechanism hold few candidates each: its D is factorised as a sparse
//! matrix while the choice stays. EngineV6, of 80 constraints, spent two thirds of its simulation on
//! dense factors.
//!
//! Reference: [Mattsson & Söderlind 1993](gapilib_base::bibliography#mattsson-soderlind-1993), section 4.

use super::execution::read;
use crate::codegen::code::CompiledSelection;
use crate::codegen::memory::Memory;
use crate::sim::{DenseLu, Factorization, Failure, Pattern};

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
    /// Those that are not always zero, as its code computes them.
    entries: Vec<f64>,
    /// By states.
    changes: Vec<f64>,
    lu: DenseLu,
    /// D of the choice as it stays between events.
    current: Option<SparseDetermined>,
}

/// The matrix D with the entries that are not always zero.
#[derive(Debug, Clone)]
struct SparseDetermined {
    /// Positions in the Jacobian, in the order of the pattern.
    positions: Vec<usize>,
    values: Vec<f64>,
    factors: Factorization,
}

impl SparseDetermined {
    /// Of these columns of a Jacobian with `k` columns.
    fn new(selection: &CompiledSelection, k: usize, determined: &[usize]) -> SparseDetermined {
        let n = determined.len();
        let (mut column_starts, mut rows, mut positions) = (vec![0], Vec::new(), Vec::new());
        for candidate in determined {
            let of_column = selection.places.iter().filter(|(_, column)| column == candidate);
            for (row, column) in of_column {
                rows.push(*row);
                positions.push(row * k + column);
            }
            column_starts.push(rows.len());
        }
        // Nothing is known of the diagonal: constraints have no order.
        let coupled: Vec<usize> = (0..n).collect();
        let factors = Factorization::new(&Pattern { n, column_starts, rows }, &coupled);
        SparseDetermined { values: vec![0.0; positions.len()], positions, factors }
    }

    /// Whether there are factors for these entries of the Jacobian.
    fn factorize(&mut self, jacobian: &[f64]) -> bool {
        for (value, position) in self.values.iter_mut().zip(&self.positions) {
            *value = jacobian[*position];
        }
        self.factors.factorize(&self.values).is_ok()
    }
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
            entries: Vec::new(),
            changes: vec![0.0; s * (k - s)],
            lu: DenseLu::new(k - s),
            current: None,
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
        Ok(match self.largest_change_now(selection) {
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
        let largest = self.largest_change_now(selection);
        if largest.is_some_and(|(largest, ..)| largest <= NEAR * LARGEST) {
            return Ok(false);
        }
        if largest.is_none() {
            self.choose_states();
        }
        // Every exchange enlarges the determinant: none recurs.
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
        self.entries.resize(selection.places.len(), 0.0);
        read(&selection.jacobian, r, &mut self.entries)?;
        let k = self.nominal.len();
        for ((row, column), entry) in selection.places.iter().zip(&self.entries) {
            self.jacobian[row * k + column] = entry * self.nominal[*column];
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
        let Choice { states, jacobian, changes, lu, .. } = self;
        largest_entry((states, jacobian, k), changes, m, |column| lu.solve(column))
    }

    /// The same for the choice as it stays until it is changed, from sparse factors where there are
    /// any.
    fn largest_change_now(&mut self, selection: &CompiledSelection) -> Option<(f64, usize, usize)> {
        let (k, m) = (self.nominal.len(), self.determined.len());
        let Choice { states, jacobian, changes, current, determined, .. } = self;
        let current =
            current.get_or_insert_with(|| SparseDetermined::new(selection, k, determined));
        if !current.factorize(jacobian) {
            return self.largest_change();
        }
        let factors = &mut current.factors;
        largest_entry((states, jacobian, k), changes, m, |column| factors.solve(column))
    }

    /// Takes as determined the columns of the largest pivots.
    fn choose_states(&mut self) {
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
    fn write(&mut self, selection: &CompiledSelection, r: &mut Memory) {
        self.current = None;
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

/// The largest entry of W, by columns, with its state and its row; `None` if one is not finite.
fn largest_entry(
    (states, jacobian, k): (&[usize], &[f64], usize),
    changes: &mut [f64],
    m: usize,
    mut solve: impl FnMut(&mut [f64]),
) -> Option<(f64, usize, usize)> {
    let mut largest = (0.0, 0, 0);
    for (state, candidate) in states.iter().enumerate() {
        let column = &mut changes[state * m..(state + 1) * m];
        for (row, change) in column.iter_mut().enumerate() {
            *change = jacobian[row * k + candidate];
        }
        solve(column);
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
