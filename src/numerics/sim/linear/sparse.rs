//! Sparse LU whose pivots and fill are found once and reused.
//!
//! A matrix is eliminated symbolically and numerically together: among the rows with fewest entries
//! left and their entries not much smaller than the row's largest, the pivot is the one that fills
//! least (Markowitz's rule with a threshold). Later matrices of the same pattern are factorised row
//! by row with the same pivots ([as machine code](super::straight_line) where that happens often),
//!
//! ```text
//! for each row i of the permuted matrix
//!     for each k < i in the pattern of row i, ascending
//!         l_ik = w_k / u_kk;  w_j -= l_ik u_kj  for j > k
//! ```
//!
//! The first pivots are those of a matrix with the pattern and a large diagonal, as an integrator
//! with a short step has it. They do not depend on any values, so that a simulation gives the same
//! bits whichever came before it. Of unknowns of algebraic loops the diagonal says nothing: a few of
//! them are eliminated last, by a dense LU that exchanges their rows as the values ask for. Where a
//! pivot is too small for its row, others are chosen for the values at hand, until
//! [`SparseLu::forget`].
//!
//! Not the one of a crate: those choose pivots from the values of the first matrix, so that a simulation
//! would depend on what was simulated before with the same workspace.

use super::factor_pattern::{Rows, Shape, row};
use super::straight_line::StraightLine;
use super::{DenseLu, SingularMatrix};
use crate::elementary;
use crate::sim::Pattern;
use std::collections::BTreeSet;

/// A pivot is at least so much of the largest entry of its row.
const THRESHOLD: f64 = 0.1;
/// Reused pivots may become so small before new ones are sought, those chosen for values and those
/// chosen without.
const REUSE_THRESHOLD: f64 = 1e-4;
const FIRST_THRESHOLD: f64 = 1e-2;

/// Rows among which a pivot is sought.
const CANDIDATES: usize = 4;
/// Unknowns of loops that a dense LU eliminates last.
const MOST_COUPLED: usize = 32;
/// Size of what is not on the diagonal when pivots are chosen without values.
const OFF_DIAGONAL: f64 = 1e-3;

/// Factors of a sparse matrix.
#[derive(Debug, Clone)]
pub struct SparseLu {
    pattern: Pattern,
    /// What is eliminated last.
    coupled: Vec<usize>,
    /// With the pivots of the pattern; `None` before the first use and if it has none.
    first: Option<Factors>,
    is_analysed: bool,
    /// With pivots for values; taken instead of the first.
    others: Option<Factors>,
    work: Vec<f64>,
    /// The same for several right-hand sides at once, one beside the other.
    wide: Vec<f64>,
}

/// Pivots, the pattern of the factors, and their values.
#[derive(Debug, Clone)]
struct Factors {
    /// The row of the matrix that is row i of the permuted matrix.
    rows: Vec<u32>,
    /// The column of the matrix that is column j of the permuted matrix.
    columns: Vec<u32>,
    /// The nonzeros of the matrix by rows of the permuted matrix: where each row starts, permuted
    /// column and position in the values of the pattern.
    entry_starts: Vec<u32>,
    entries: Vec<(u32, u32)>,
    /// L without its diagonal of ones.
    lower: Rows,
    /// U without its diagonal.
    upper: Rows,
    /// 1 / u_ii, as many as there are rows with sparse pivots.
    inverse_diagonal: Vec<f64>,
    /// The rows after these, and the columns after these.
    last: DenseLu,
    /// The same without loops; only for pivots that do not depend on values.
    code: StraightLine,
}

impl SparseLu {
    pub(super) fn new(pattern: &Pattern, coupled: &[usize]) -> SparseLu {
        let coupled = if coupled.len() <= MOST_COUPLED { coupled.to_vec() } else { Vec::new() };
        let (pattern, work) = (pattern.clone(), vec![0.0; pattern.n]);
        let wide = Vec::new();
        SparseLu { pattern, coupled, first: None, is_analysed: false, others: None, work, wide }
    }

    /// Goes back to the pivots that do not depend on values.
    pub(super) fn forget(&mut self) {
        self.others = None;
    }

    pub(super) fn factorize(&mut self, values: &[f64]) -> Result<(), SingularMatrix> {
        if !self.is_analysed {
            let values = large_diagonal(&self.pattern);
            let pivots = Elimination::new(&self.pattern, &values).keep(&self.coupled).run();
            self.first = pivots.ok().map(|pivots| pivots.factors(&self.pattern));
            self.is_analysed = true;
        }
        let (factors, threshold) = match &mut self.others {
            Some(others) => (Some(others), REUSE_THRESHOLD),
            None => (self.first.as_mut(), FIRST_THRESHOLD),
        };
        if let Some(factors) = factors
            && factors.factorize(values, &mut self.work, threshold).is_ok()
        {
            return Ok(());
        }
        let mut factors = Elimination::new(&self.pattern, values).run()?.factors(&self.pattern);
        factors.factorize(values, &mut self.work, 0.0)?;
        self.others = Some(factors);
        Ok(())
    }

    /// Makes machine code for the pivots of the pattern.
    #[cfg(all(test, feature = "jit"))]
    pub(super) fn translate(&mut self) {
        if let Some(factors) = &mut self.first {
            let mut code = std::mem::take(&mut factors.code);
            code.translate(&factors.shape());
            factors.code = code;
        }
    }

    /// Nonzeros of the factors, the diagonal counted once.
    #[cfg(test)]
    pub(super) fn nonzeros(&self) -> usize {
        let factors = self.others.as_ref().or(self.first.as_ref());
        factors.map_or(0, |f| f.rows.len() + f.lower.len() + f.upper.len())
    }

    /// Leaves NaN if nothing has been factorised.
    pub(super) fn solve(&mut self, b: &mut [f64]) {
        match self.others.as_ref().or(self.first.as_ref()) {
            Some(factors) => factors.solve(b, &mut self.work),
            None => b.fill(f64::NAN),
        }
    }

    /// The same for right-hand sides one after another: with the same bits, but places are looked up
    /// once for several.
    pub(super) fn solve_all(&mut self, b: &mut [f64]) {
        let n = self.pattern.n;
        let Some(factors) = self.others.as_ref().or(self.first.as_ref()) else {
            return b.fill(f64::NAN);
        };
        self.wide.resize(n * (WIDTH + 1), 0.0);
        let mut blocks = b.chunks_exact_mut(n * WIDTH);
        for b in &mut blocks {
            factors.solve_block(b, &mut self.wide);
        }
        for b in blocks.into_remainder().chunks_exact_mut(n) {
            factors.solve(b, &mut self.work);
        }
    }
}

/// Values with which entries of the diagonal are preferred as pivots.
fn large_diagonal(pattern: &Pattern) -> Vec<f64> {
    let of_column = |j: usize| pattern.rows[pattern.column(j)].iter().map(move |i| (*i, j));
    let entries = (0..pattern.n).flat_map(of_column);
    // Slightly different numbers, so that nothing cancels by chance.
    let off_diagonal = |at: usize| OFF_DIAGONAL * (1.0 + elementary::sin(at as f64) * 0.25);
    entries.enumerate().map(|(at, (i, j))| if i == j { 1.0 } else { off_diagonal(at) }).collect()
}

impl Factors {
    /// Fails at a pivot below `threshold` of its row.
    fn factorize(
        &mut self,
        values: &[f64],
        work: &mut [f64],
        threshold: f64,
    ) -> Result<(), SingularMatrix> {
        let mut code = std::mem::take(&mut self.code);
        let mut last = std::mem::replace(&mut self.last, DenseLu::new(0));
        let done = code.factorize(&self.shape(), values, last.matrix(), threshold);
        (self.code, self.last) = (code, last);
        match done {
            Some(done) => done?,
            None => self.factorize_in_loops(values, work, threshold)?,
        }
        self.last.factorize()
    }

    fn shape(&self) -> Shape<'_> {
        Shape {
            rows: &self.rows,
            columns: &self.columns,
            entry_starts: &self.entry_starts,
            entries: &self.entries,
            lower: &self.lower,
            upper: &self.upper,
            n_sparse: self.inverse_diagonal.len(),
        }
    }

    fn factorize_in_loops(
        &mut self,
        values: &[f64],
        work: &mut [f64],
        threshold: f64,
    ) -> Result<(), SingularMatrix> {
        let n = self.inverse_diagonal.len();
        for i in 0..n {
            work[i] = 0.0;
            self.upper.row(i).iter().for_each(|(j, _)| work[*j as usize] = 0.0);
            self.eliminate(i, values, work);
            let pivot = work[i];
            let mut largest = pivot.abs();
            for (j, u) in self.upper.row_mut(i) {
                *u = work[*j as usize];
                if u.abs() > largest {
                    largest = u.abs();
                }
            }
            if pivot == 0.0 || !pivot.is_finite() || pivot.abs() < threshold * largest {
                return Err(SingularMatrix);
            }
            self.inverse_diagonal[i] = 1.0 / pivot;
        }
        let n_last = self.rows.len() - n;
        for i in 0..n_last {
            work[n..].fill(0.0);
            self.eliminate(n + i, values, work);
            for (j, value) in work[n..].iter().enumerate() {
                self.last.matrix()[i + j * n_last] = *value;
            }
        }
        Ok(())
    }

    /// Computes row i of L, and in `work`, where zeros stand for its other entries, of U.
    fn eliminate(&mut self, i: usize, values: &[f64], work: &mut [f64]) {
        let (lower, upper) = (self.lower.row_mut(i), &self.upper);
        lower.iter().for_each(|(j, _)| work[*j as usize] = 0.0);
        for (column, position) in &self.entries[row(&self.entry_starts, i)] {
            work[*column as usize] = values[*position as usize];
        }
        for (k, l) in lower {
            let k = *k as usize;
            let factor = work[k] * self.inverse_diagonal[k];
            *l = factor;
            for (j, u) in upper.row(k) {
                work[*j as usize] -= factor * u;
            }
        }
    }

    fn solve(&self, b: &mut [f64], work: &mut [f64]) {
        let is_solved = self.code.solve(b, work, |b, work| self.solve_last(b, work));
        if !is_solved {
            self.solve_in_loops(b, work);
        }
    }

    /// What is eliminated last.
    fn solve_last(&self, b: &mut [f64], work: &mut [f64]) {
        let n = self.inverse_diagonal.len();
        self.last.solve(&mut work[n..]);
        for (value, column) in work[n..].iter().zip(&self.columns[n..]) {
            b[*column as usize] = *value;
        }
    }

    fn solve_in_loops(&self, b: &mut [f64], work: &mut [f64]) {
        let n = self.inverse_diagonal.len();
        for i in 0..self.rows.len() {
            let mut sum = b[self.rows[i] as usize];
            for (k, l) in self.lower.row(i) {
                sum -= l * work[*k as usize];
            }
            work[i] = sum;
        }
        self.solve_last(b, work);
        for i in (0..n).rev() {
            let mut sum = work[i];
            for (j, u) in self.upper.row(i) {
                sum -= u * work[*j as usize];
            }
            work[i] = sum * self.inverse_diagonal[i];
            b[self.columns[i] as usize] = work[i];
        }
    }
}

/// Right-hand sides that are solved for at once.
const WIDTH: usize = 8;

impl Factors {
    /// Solves for [`WIDTH`] right-hand sides one after another; `work` has room for all and one more.
    fn solve_block(&self, b: &mut [f64], work: &mut [f64]) {
        let (all, n) = (self.rows.len(), self.inverse_diagonal.len());
        let (work, single) = work.split_at_mut(all * WIDTH);
        // Where they were computed by code, it has them.
        let (lower, upper, inverse_diagonal) = match self.code.numbers() {
            None => (&[][..], &[][..], &self.inverse_diagonal[..]),
            Some(numbers) => {
                let (lower, others) = numbers.split_at(self.lower.len());
                let (upper, inverse_diagonal) = others.split_at(self.upper.len());
                (lower, upper, inverse_diagonal)
            }
        };
        let reduce =
            |mut sums: [f64; WIDTH], rows: &Rows, i: usize, numbers: &[f64], work: &[f64]| {
                for (at, (k, own)) in rows.range(i).zip(rows.row(i)) {
                    let factor = numbers.get(at).unwrap_or(own);
                    for (sum, x) in sums.iter_mut().zip(&work[*k as usize * WIDTH..][..WIDTH]) {
                        *sum -= factor * x;
                    }
                }
                sums
            };
        for i in 0..all {
            let row = self.rows[i] as usize;
            let sums = std::array::from_fn(|column| b[column * all + row]);
            let sums = reduce(sums, &self.lower, i, lower, work);
            work[i * WIDTH..][..WIDTH].copy_from_slice(&sums);
        }
        for column in 0..if n < all { WIDTH } else { 0 } {
            for (i, value) in single.iter_mut().enumerate().skip(n) {
                *value = work[i * WIDTH + column];
            }
            self.solve_last(&mut b[column * all..][..all], single);
            for (i, value) in single.iter().enumerate().skip(n) {
                work[i * WIDTH + column] = *value;
            }
        }
        for i in (0..n).rev() {
            let sums = std::array::from_fn(|column| work[i * WIDTH + column]);
            let sums = reduce(sums, &self.upper, i, upper, work);
            for (column, sum) in sums.into_iter().enumerate() {
                let value = sum * inverse_diagonal[i];
                work[i * WIDTH + column] = value;
                b[column * all + self.columns[i] as usize] = value;
            }
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
    lower: Vec<Vec<u32>>,
    /// Pivot row and column of every step.
    pivots: Vec<(usize, usize)>,
    /// Rows and columns that are not pivots.
    kept: Vec<bool>,
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
        let (lower, pivots, kept) = (vec![Vec::new(); n], Vec::new(), vec![false; n]);
        Elimination { rows, columns, shortest, lower, pivots, kept }
    }

    /// Leaves these rows and columns.
    fn keep(mut self, rows: &[usize]) -> Elimination {
        for row in rows {
            self.kept[*row] = true;
            self.shortest.remove(&(self.rows[*row].len(), *row));
        }
        self
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
                self.lower[i].push(step as u32);
            }
            self.rows[row] = pivot_row;
        }
        Ok(self)
    }

    /// Among the rows with fewest entries left and their acceptable pivots the one that fills least.
    fn next_pivot(&mut self) -> Result<Option<(usize, usize, f64)>, SingularMatrix> {
        if self.shortest.is_empty() {
            return Ok(None);
        }
        let acceptable =
            self.shortest.iter().filter_map(|(_, i)| self.pivot_of(*i).map(|(j, v)| (*i, j, v)));
        let fill = |(i, j, _): &(usize, usize, f64)| {
            (self.rows[*i].len() - 1) * (self.columns[*j].len() - 1)
        };
        let best = acceptable.take(CANDIDATES).min_by_key(fill);
        let (row, column, value) = best.ok_or(SingularMatrix)?;
        self.shortest.remove(&(self.rows[row].len(), row));
        Ok(Some((row, column, value)))
    }

    fn pivot_of(&self, row: usize) -> Option<(usize, f64)> {
        let entries = &self.rows[row];
        let largest = entries.iter().map(|(_, value)| value.abs()).fold(0.0, f64::max);
        let acceptable = entries
            .iter()
            .filter(|(j, v)| !self.kept[*j] && *v != 0.0 && v.abs() >= THRESHOLD * largest);
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
        if !self.kept[i] {
            self.shortest.insert((new.len(), i));
        }
        self.rows[i] = new;
    }

    fn factors(self, pattern: &Pattern) -> Factors {
        let n = pattern.n;
        let kept: Vec<u32> = (0..n as u32).filter(|i| self.kept[*i as usize]).collect();
        let pivots = self.pivots.iter().map(|(row, column)| (*row as u32, *column as u32));
        let (mut rows, mut columns): (Vec<u32>, Vec<u32>) = pivots.unzip();
        rows.extend(&kept);
        columns.extend(&kept);
        let new_column = inverse(&columns);
        let new_row = inverse(&rows);
        let mut entries = vec![Vec::new(); n];
        for (j, new_column) in new_column.iter().enumerate() {
            for position in pattern.column(j) {
                let new_row = new_row[pattern.rows[position]];
                entries[new_row as usize].push((*new_column, position as u32));
            }
        }
        let lower = rows.iter().map(|row| self.lower[*row as usize].clone());
        let upper = (0u32..).zip(&rows[..n - kept.len()]).map(|(i, row)| {
            let columns = self.rows[*row as usize].iter().map(|(j, _)| new_column[*j]);
            let mut columns: Vec<u32> = columns.filter(|j| *j != i).collect();
            columns.sort_unstable();
            columns
        });
        let (lower, upper) = (Rows::of(lower), Rows::of(upper));
        let (entry_starts, entries) = compressed(entries);
        Factors {
            lower,
            upper,
            rows,
            columns,
            entry_starts,
            entries,
            inverse_diagonal: vec![0.0; n - kept.len()],
            last: DenseLu::new(kept.len()),
            code: StraightLine::default(),
        }
    }
}

fn inverse(permutation: &[u32]) -> Vec<u32> {
    let mut inverse = vec![0; permutation.len()];
    for (new, old) in (0u32..).zip(permutation) {
        inverse[*old as usize] = new;
    }
    inverse
}

/// Where each list starts, and all lists one after the other.
fn compressed<T>(lists: Vec<Vec<T>>) -> (Vec<u32>, Vec<T>) {
    let mut starts = vec![0];
    let mut all = Vec::new();
    for list in lists {
        all.extend(list);
        starts.push(all.len() as u32);
    }
    (starts, all)
}
