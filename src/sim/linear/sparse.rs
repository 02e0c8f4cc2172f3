//! Sparse LU whose pivots and fill are found once and reused.
//!
//! The first matrix is eliminated symbolically and numerically together: the next pivot row is the
//! one with fewest entries left, its pivot the entry in the shortest column among those not much
//! smaller than the row's largest (Markowitz's rule with a threshold). Later matrices of the same
//! pattern are factorised row by row with the same pivots,
//!
//! ```text
//! for each row i of the permuted matrix
//!     for each k < i in the pattern of row i, ascending
//!         l_ik = w_k / u_kk;  w_j -= l_ik u_kj  for j > k
//! ```
//!
//! and analysed anew when a pivot became too small for its row.

use super::SingularMatrix;
use crate::sim::Pattern;
use std::collections::BTreeSet;

/// A pivot is at least so much of the largest entry of its row.
const THRESHOLD: f64 = 0.1;
/// Reused pivots may become so small before new ones are sought.
const REUSE_THRESHOLD: f64 = 1e-4;

/// Factors of a sparse matrix.
#[derive(Debug, Clone)]
pub struct SparseLu {
    pattern: Pattern,
    factors: Option<Factors>,
    work: Vec<f64>,
}

/// Pivots, the pattern of the factors, and their values.
#[derive(Debug, Clone)]
struct Factors {
    /// The row of the matrix that is row i of the permuted matrix.
    rows: Vec<usize>,
    /// The column of the matrix that is column j of the permuted matrix.
    columns: Vec<usize>,
    /// The nonzeros of the matrix by rows of the permuted matrix: where each row starts, permuted
    /// column and position in the values of the pattern.
    entry_starts: Vec<usize>,
    entries: Vec<(usize, usize)>,
    /// L without its diagonal of ones, by rows.
    lower_starts: Vec<usize>,
    lower_columns: Vec<usize>,
    lower: Vec<f64>,
    /// U without its diagonal, by rows.
    upper_starts: Vec<usize>,
    upper_columns: Vec<usize>,
    upper: Vec<f64>,
    /// 1 / u_ii
    inverse_diagonal: Vec<f64>,
}

impl SparseLu {
    pub(super) fn new(pattern: &Pattern) -> SparseLu {
        SparseLu { pattern: pattern.clone(), factors: None, work: vec![0.0; pattern.n] }
    }

    pub(super) fn factorize(&mut self, values: &[f64]) -> Result<(), SingularMatrix> {
        if let Some(factors) = &mut self.factors
            && factors.factorize(values, &mut self.work, REUSE_THRESHOLD).is_ok()
        {
            return Ok(());
        }
        self.factors = None;
        let mut factors = Elimination::new(&self.pattern, values).run()?.factors(&self.pattern);
        factors.factorize(values, &mut self.work, 0.0)?;
        self.factors = Some(factors);
        Ok(())
    }

    /// Nonzeros of the factors, the diagonal counted once.
    #[cfg(test)]
    pub(super) fn nonzeros(&self) -> usize {
        self.factors.as_ref().map_or(0, |f| f.rows.len() + f.lower.len() + f.upper.len())
    }

    /// Leaves NaN if nothing has been factorised.
    pub(super) fn solve(&mut self, b: &mut [f64]) {
        match &self.factors {
            Some(factors) => factors.solve(b, &mut self.work),
            None => b.fill(f64::NAN),
        }
    }
}

impl Factors {
    /// Fails at a pivot below `threshold` of its row.
    fn factorize(
        &mut self,
        values: &[f64],
        work: &mut [f64],
        threshold: f64,
    ) -> Result<(), SingularMatrix> {
        for i in 0..self.rows.len() {
            let lower = self.lower_starts[i]..self.lower_starts[i + 1];
            let upper = self.upper_starts[i]..self.upper_starts[i + 1];
            work[i] = 0.0;
            self.lower_columns[lower.clone()].iter().for_each(|j| work[*j] = 0.0);
            self.upper_columns[upper.clone()].iter().for_each(|j| work[*j] = 0.0);
            for (column, position) in &self.entries[self.entry_starts[i]..self.entry_starts[i + 1]]
            {
                work[*column] = values[*position];
            }
            for l in lower {
                let k = self.lower_columns[l];
                let factor = work[k] * self.inverse_diagonal[k];
                self.lower[l] = factor;
                if factor != 0.0 {
                    let row = self.upper_starts[k]..self.upper_starts[k + 1];
                    for (j, u) in self.upper_columns[row.clone()].iter().zip(&self.upper[row]) {
                        work[*j] -= factor * u;
                    }
                }
            }
            let mut largest = work[i].abs();
            for u in upper {
                let value = work[self.upper_columns[u]];
                self.upper[u] = value;
                largest = largest.max(value.abs());
            }
            let pivot = work[i];
            if pivot == 0.0 || !pivot.is_finite() || pivot.abs() < threshold * largest {
                return Err(SingularMatrix);
            }
            self.inverse_diagonal[i] = 1.0 / pivot;
        }
        Ok(())
    }

    fn solve(&self, b: &mut [f64], work: &mut [f64]) {
        let n = self.rows.len();
        for i in 0..n {
            let mut sum = b[self.rows[i]];
            let row = self.lower_starts[i]..self.lower_starts[i + 1];
            for (k, l) in self.lower_columns[row.clone()].iter().zip(&self.lower[row]) {
                sum -= l * work[*k];
            }
            work[i] = sum;
        }
        for i in (0..n).rev() {
            let mut sum = work[i];
            let row = self.upper_starts[i]..self.upper_starts[i + 1];
            for (j, u) in self.upper_columns[row.clone()].iter().zip(&self.upper[row]) {
                sum -= u * work[*j];
            }
            work[i] = sum * self.inverse_diagonal[i];
            b[self.columns[i]] = work[i];
        }
    }
}

/// Elimination with free choice of pivots.
struct Elimination {
    /// The entries left of every row: column and value, by columns.
    rows: Vec<Vec<(usize, f64)>>,
    /// The rows with an entry left in every column, unordered.
    columns: Vec<Vec<usize>>,
    /// Rows left by number of entries.
    shortest: BTreeSet<(usize, usize)>,
    /// Pivot steps in which each row was changed, ascending.
    lower: Vec<Vec<usize>>,
    /// Pivot row and column of every step.
    pivots: Vec<(usize, usize)>,
}

impl Elimination {
    fn new(pattern: &Pattern, values: &[f64]) -> Elimination {
        let n = pattern.n;
        let (mut rows, mut columns) = (vec![Vec::new(); n], vec![Vec::new(); n]);
        for (j, column) in columns.iter_mut().enumerate() {
            for position in pattern.column(j) {
                rows[pattern.rows[position]].push((j, values[position]));
                column.push(pattern.rows[position]);
            }
        }
        let shortest = rows.iter().enumerate().map(|(i, row)| (row.len(), i)).collect();
        Elimination { rows, columns, shortest, lower: vec![Vec::new(); n], pivots: Vec::new() }
    }

    fn run(mut self) -> Result<Elimination, SingularMatrix> {
        while let Some((row, column, value)) = self.next_pivot()? {
            let step = self.pivots.len();
            self.pivots.push((row, column));
            let pivot_row = std::mem::take(&mut self.rows[row]);
            for (j, _) in &pivot_row {
                self.columns[*j].retain(|i| *i != row);
            }
            for i in std::mem::take(&mut self.columns[column]) {
                self.subtract(i, &pivot_row, column, value);
                self.lower[i].push(step);
            }
            self.rows[row] = pivot_row;
        }
        Ok(self)
    }

    /// Among the rows with fewest entries left the first that has an acceptable pivot.
    fn next_pivot(&mut self) -> Result<Option<(usize, usize, f64)>, SingularMatrix> {
        if self.shortest.is_empty() {
            return Ok(None);
        }
        let acceptable =
            self.shortest.iter().find_map(|(_, i)| self.pivot_of(*i).map(|(j, v)| (*i, j, v)));
        let (row, column, value) = acceptable.ok_or(SingularMatrix)?;
        self.shortest.remove(&(self.rows[row].len(), row));
        Ok(Some((row, column, value)))
    }

    fn pivot_of(&self, row: usize) -> Option<(usize, f64)> {
        let entries = &self.rows[row];
        let largest = entries.iter().map(|(_, value)| value.abs()).fold(0.0, f64::max);
        let acceptable =
            entries.iter().filter(|(_, v)| *v != 0.0 && v.abs() >= THRESHOLD * largest);
        acceptable.min_by_key(|(j, _)| (self.columns[*j].len(), *j)).copied()
    }

    /// Subtracts a multiple of the pivot row from row i so that its entry in `column` vanishes.
    fn subtract(&mut self, i: usize, pivot_row: &[(usize, f64)], column: usize, pivot: f64) {
        let old = std::mem::take(&mut self.rows[i]);
        self.shortest.remove(&(old.len(), i));
        let entry = old.iter().find(|(j, _)| *j == column).map_or(0.0, |(_, value)| *value);
        let factor = entry / pivot;
        let mut new = Vec::with_capacity(old.len() + pivot_row.len());
        let (mut left, mut right) = (old.iter().peekable(), pivot_row.iter().peekable());
        loop {
            let (j, value) = match (left.peek(), right.peek()) {
                (Some((a, _)), Some((b, u))) if b < a => {
                    right.next();
                    self.columns[*b].push(i);
                    (*b, -factor * u)
                }
                (Some((a, value)), Some((b, u))) if a == b => {
                    left.next();
                    right.next();
                    (*a, value - factor * u)
                }
                (Some((a, value)), _) => {
                    left.next();
                    (*a, *value)
                }
                (None, Some((b, u))) => {
                    right.next();
                    self.columns[*b].push(i);
                    (*b, -factor * u)
                }
                (None, None) => break,
            };
            if j != column {
                new.push((j, value));
            }
        }
        self.shortest.insert((new.len(), i));
        self.rows[i] = new;
    }

    fn factors(self, pattern: &Pattern) -> Factors {
        let n = pattern.n;
        let rows: Vec<usize> = self.pivots.iter().map(|(row, _)| *row).collect();
        let columns: Vec<usize> = self.pivots.iter().map(|(_, column)| *column).collect();
        let new_column = inverse(&columns);
        let new_row = inverse(&rows);
        let mut entries = vec![Vec::new(); n];
        for (j, new_column) in new_column.iter().enumerate() {
            for position in pattern.column(j) {
                entries[new_row[pattern.rows[position]]].push((*new_column, position));
            }
        }
        let lower: Vec<Vec<usize>> = rows.iter().map(|row| self.lower[*row].clone()).collect();
        let upper = rows.iter().enumerate().map(|(i, row)| {
            let columns = self.rows[*row].iter().map(|(j, _)| new_column[*j]);
            let mut columns: Vec<usize> = columns.filter(|j| *j != i).collect();
            columns.sort_unstable();
            columns
        });
        let (entry_starts, entries) = compressed(entries);
        let (lower_starts, lower_columns) = compressed(lower);
        let (upper_starts, upper_columns) = compressed(upper.collect());
        Factors {
            rows,
            columns,
            entry_starts,
            entries,
            lower: vec![0.0; lower_columns.len()],
            lower_starts,
            lower_columns,
            upper: vec![0.0; upper_columns.len()],
            upper_starts,
            upper_columns,
            inverse_diagonal: vec![0.0; n],
        }
    }
}

fn inverse(permutation: &[usize]) -> Vec<usize> {
    let mut inverse = vec![0; permutation.len()];
    for (new, old) in permutation.iter().enumerate() {
        inverse[*old] = new;
    }
    inverse
}

/// Where each list starts, and all lists one after the other.
fn compressed<T>(lists: Vec<Vec<T>>) -> (Vec<usize>, Vec<T>) {
    let mut starts = vec![0];
    let mut all = Vec::new();
    for list in lists {
        all.extend(list);
        starts.push(all.len());
    }
    (starts, all)
}
