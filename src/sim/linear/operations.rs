//! Elimination and substitution of a small sparse matrix as lists of operations.
//!
//! Rows of small matrices have two or three entries: loops over them cost more for their ends, which a
//! processor does not foresee, than for their arithmetic. Lists of operations on one array have none.
//! They are ordered so that what stands side by side does not wait for each other,
//!
//! ```text
//! elimination     for each k ascending:  l_ik = a_ik / u_kk;  a_ij -= l_ik u_kj
//! substitution    of L by columns; of U by levels, whose rows need those of earlier levels alone
//! ```
//!
//! and each entry still sees its operations in the order of the loops by rows, so that the bits are the
//! same. Where pivots are too small is seen at the end.

use super::SingularMatrix;
use std::ops::Range;

/// More operations than this are left to the loops.
const MOST: usize = 50_000;

/// Patterns of the factors, by rows of the permuted matrix.
pub(super) struct Rows<'a> {
    /// Rows with sparse pivots.
    pub(super) n: usize,
    /// Where each row starts, permuted column and position in the values of the pattern.
    pub(super) entries: (&'a [u32], &'a [(u32, u32)]),
    /// L without its diagonal.
    pub(super) lower: (&'a [u32], &'a [u32]),
    /// U without its diagonal, of the first n rows.
    pub(super) upper: (&'a [u32], &'a [u32]),
}

impl Rows<'_> {
    fn all(&self) -> usize {
        self.lower.0.len() - 1
    }

    fn lower_of(&self, row: usize) -> Range<usize> {
        self.lower.0[row] as usize..self.lower.0[row + 1] as usize
    }

    fn upper_of(&self, row: usize) -> Range<usize> {
        self.upper.0[row] as usize..self.upper.0[row + 1] as usize
    }

    /// Updates that the elimination makes.
    fn updates(&self) -> usize {
        self.lower.1.iter().map(|k| self.upper_of(*k as usize).len()).sum()
    }
}

/// The lists of operations of a pattern and the array they work on: L and U without their diagonals,
/// by rows, the diagonal of U, its inverses, and behind them what is left to a dense LU, by columns.
#[derive(Debug, Clone)]
pub(super) struct Operations {
    n: usize,
    n_last: usize,
    /// The place of each value of the matrix.
    places: Vec<u32>,
    /// Entries of L in column k, after [`Operations::scale_starts`].
    scale_starts: Vec<u32>,
    scaled: Vec<u32>,
    /// a -= l u, for each k.
    update_starts: Vec<u32>,
    updates: Vec<[u32; 3]>,
    /// Entries of U with the places of their pivots.
    compared: Vec<[u32; 2]>,
    /// b_i -= l b_k: i, k, and the place of l.
    forward: Vec<[u32; 3]>,
    /// b_i -= u b_j, level by level, and the rows of the levels.
    level_starts: Vec<[u32; 2]>,
    backward: Vec<[u32; 3]>,
    level_rows: Vec<u32>,
    slots: Vec<f64>,
}

impl Operations {
    /// `None` if there would be too many.
    pub(super) fn new(rows: &Rows) -> Option<Operations> {
        let count = rows.updates();
        if count > MOST || rows.lower.1.len() + rows.upper.1.len() > MOST {
            return None;
        }
        let (n, n_last) = (rows.n, rows.all() - rows.n);
        let offdiagonal = rows.lower.1.len() + rows.upper.1.len();
        let mut operations = Operations {
            n,
            n_last,
            places: vec![0; rows.entries.1.len()],
            scale_starts: vec![0],
            scaled: Vec::new(),
            update_starts: vec![0],
            updates: Vec::with_capacity(count),
            compared: Vec::new(),
            forward: Vec::new(),
            level_starts: vec![[0; 2]],
            backward: Vec::new(),
            level_rows: Vec::new(),
            slots: vec![0.0; offdiagonal + 2 * n + n_last * n_last],
        };
        operations.list_elimination(rows);
        operations.list_substitution(rows);
        Some(operations)
    }

    fn diagonal(&self) -> usize {
        self.slots.len() - self.n_last * self.n_last - 2 * self.n
    }

    /// The place of an entry of L or U.
    fn place(&self, rows: &Rows, (i, j): (usize, usize)) -> u32 {
        let within = |columns: &[u32], range: Range<usize>| {
            let at = columns[range.clone()].binary_search(&(j as u32));
            range.start + at.expect("the pattern of the factors has every entry")
        };
        let place = if i >= self.n && j >= self.n {
            self.slots.len() - self.n_last * self.n_last + (i - self.n) + (j - self.n) * self.n_last
        } else if j < i {
            within(rows.lower.1, rows.lower_of(i))
        } else if i == j {
            self.diagonal() + i
        } else {
            rows.lower.1.len() + within(rows.upper.1, rows.upper_of(i))
        };
        place as u32
    }

    fn list_elimination(&mut self, rows: &Rows) {
        for i in 0..rows.all() {
            for (j, position) in
                &rows.entries.1[rows.entries.0[i] as usize..rows.entries.0[i + 1] as usize]
            {
                self.places[*position as usize] = self.place(rows, (i, *j as usize));
            }
        }
        let in_column = columns(rows);
        for (k, below) in in_column.iter().enumerate() {
            for (i, l) in below {
                self.scaled.push(*l);
                self.forward.push([*i, k as u32, *l]);
                for at in rows.upper_of(k) {
                    let target = self.place(rows, (*i as usize, rows.upper.1[at] as usize));
                    self.updates.push([target, *l, (rows.lower.1.len() + at) as u32]);
                }
            }
            self.scale_starts.push(self.scaled.len() as u32);
            self.update_starts.push(self.updates.len() as u32);
            for at in rows.upper_of(k) {
                let pivot = self.diagonal() + k;
                self.compared.push([(rows.lower.1.len() + at) as u32, pivot as u32]);
            }
        }
    }

    fn list_substitution(&mut self, rows: &Rows) {
        let mut levels = vec![0; rows.all()];
        for i in (0..self.n).rev() {
            let needed = rows.upper.1[rows.upper_of(i)].iter().map(|j| levels[*j as usize]);
            levels[i] = needed.max().unwrap_or(0) + 1;
        }
        let last = levels.iter().copied().max().unwrap_or(0);
        for level in 1..=last {
            let of_level: Vec<usize> = (0..self.n).filter(|i| levels[*i] == level).collect();
            let longest = of_level.iter().map(|i| rows.upper_of(*i).len()).max().unwrap_or(0);
            for turn in 0..longest {
                for i in &of_level {
                    if let Some(at) = rows.upper_of(*i).nth(turn) {
                        let place = rows.lower.1.len() + at;
                        self.backward.push([*i as u32, rows.upper.1[at], place as u32]);
                    }
                }
            }
            self.level_rows.extend(of_level.into_iter().map(|i| i as u32));
            self.level_starts.push([self.backward.len() as u32, self.level_rows.len() as u32]);
        }
    }

    /// Factorises the matrix with these values, but for what is left, which is written to `last` by
    /// columns. Fails at a pivot below `threshold` of its row.
    pub(super) fn factorize(
        &mut self,
        values: &[f64],
        last: &mut [f64],
        threshold: f64,
    ) -> Result<(), SingularMatrix> {
        let (n, diagonal) = (self.n, self.diagonal());
        let slots = &mut self.slots;
        slots.fill(0.0);
        for (place, value) in self.places.iter().zip(values) {
            slots[*place as usize] = *value;
        }
        for k in 0..n {
            let inverse = 1.0 / slots[diagonal + k];
            slots[diagonal + n + k] = inverse;
            for l in &self.scaled[range(&self.scale_starts, k)] {
                slots[*l as usize] *= inverse;
            }
            for [target, l, u] in &self.updates[range(&self.update_starts, k)] {
                slots[*target as usize] -= slots[*l as usize] * slots[*u as usize];
            }
        }
        let pivots = &slots[diagonal..diagonal + n];
        let usable = pivots.iter().all(|pivot| *pivot != 0.0 && pivot.is_finite());
        let is_small = |[u, pivot]: &[u32; 2]| {
            slots[*pivot as usize].abs() < threshold * slots[*u as usize].abs()
        };
        if !usable || self.compared.iter().any(is_small) {
            return Err(SingularMatrix);
        }
        last.copy_from_slice(&slots[diagonal + 2 * n..]);
        Ok(())
    }

    /// Substitutes in L.
    pub(super) fn forward(&self, b: &mut [f64]) {
        for [i, k, l] in &self.forward {
            b[*i as usize] -= self.slots[*l as usize] * b[*k as usize];
        }
    }

    /// Substitutes in U, where what is behind the sparse pivots is known.
    pub(super) fn backward(&self, b: &mut [f64]) {
        let inverses = &self.slots[self.diagonal() + self.n..];
        for ends in self.level_starts.windows(2) {
            let ([first, first_row], [end, end_row]) = (ends[0], ends[1]);
            for [i, j, u] in &self.backward[first as usize..end as usize] {
                b[*i as usize] -= self.slots[*u as usize] * b[*j as usize];
            }
            for i in &self.level_rows[first_row as usize..end_row as usize] {
                b[*i as usize] *= inverses[*i as usize];
            }
        }
    }
}

/// The entries of L below each of the sparse pivots: row and place.
fn columns(rows: &Rows) -> Vec<Vec<(u32, u32)>> {
    let mut columns = vec![Vec::new(); rows.n];
    for i in 0..rows.all() {
        for at in rows.lower_of(i) {
            columns[rows.lower.1[at] as usize].push((i as u32, at as u32));
        }
    }
    columns
}

fn range(starts: &[u32], k: usize) -> Range<usize> {
    starts[k] as usize..starts[k + 1] as usize
}
