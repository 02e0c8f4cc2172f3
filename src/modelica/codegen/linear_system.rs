//! Systems of linear equations solved within a tape.
//!
//! ```text
//! regular     P A = L U, rows scaled by their largest entry
//! up to 2     x = b / a; by determinants where the determinant is not a small difference
//! up to 6     the same factors without a workspace where no pivot is small
//! singular    A S V = W with orthogonal columns wⱼ; x = S Σ vⱼ (wⱼ·b)/(wⱼ·wⱼ) over those that are not
//!             zero, less its part in the null space, which the other S vⱼ span: of all solutions
//!             the one nearest to given values (zero unless there are any), from which x and b are
//!             counted; S makes the largest entry of every column of A one
//! ```
//!
//! A singular system without a solution fails, unless its pivots are more than rounding errors:
//! then it is regular, but badly conditioned. Rotations that make columns orthogonal are those of
//! Jacobi's one-sided method ([Golub & Van Loan 2013](gapilib_base::bibliography#golub-van-loan-2013),
//! §8.6.3).

use super::instruction::LinearSolve;
use crate::arithmetic::Register;
use crate::elementary;
use crate::sim::DenseLu;

/// Pivots below this part of the largest entry of their column are rounding errors.
const SMALLEST_PIVOT: f64 = 1e-13;
/// Columns of W shorter than this part of the longest are zero.
const SMALLEST_COLUMN: f64 = 1e-11;
/// How far a singular system may be from having a solution, relative to its terms, and to 1.
const CONSISTENT: f64 = 1e-6;
const CONSISTENT_TO_ONE: f64 = 1e-9;
/// Smaller entries of the unit vectors of a null space are rounding errors.
const SMALLEST_PART: f64 = 1e-6;
const MAX_SWEEPS: usize = 60;
/// Two equations are solved by determinants where theirs is more than this part of its terms.
pub(super) const SMALLEST_DETERMINANT: f64 = 1e-4;
/// More equations are solved in a workspace.
pub(super) const MOST_SMALL: usize = 6;
/// Up to so many equations are clearly regular where the pivots are more than this part of the
/// largest entry of their column.
const CLEAR_PIVOT: f64 = 1e-8;

/// No solution, or one that is not finite.
#[derive(Debug)]
pub(super) struct NoSolution;

/// The workspace of one matrix.
#[derive(Debug, Clone)]
pub(crate) struct LinearSystem {
    n: usize,
    /// By rows, as the instructions give it; what they leave out is zero.
    given: Vec<f64>,
    is_factorized: bool,
    /// By columns, rows scaled.
    matrix: Vec<f64>,
    lu: DenseLu,
    row_scale: Vec<f64>,
    column_scale: Vec<f64>,
    right: Vec<f64>,
    /// The right side less what the values below make of it.
    rest: Vec<f64>,
    x: Vec<f64>,
    is_singular: bool,
    /// Whether the last solution was one of many.
    is_one_of_many: bool,
    /// Whether the factors of a singular matrix are more than rounding errors.
    has_factors: bool,
    /// V and W by columns.
    v: Vec<f64>,
    w: Vec<f64>,
    /// An orthonormal basis of the null space of A, one vector after the other.
    null: Vec<f64>,
    /// The values to which one of many solutions is nearest.
    near: Vec<f64>,
}

impl LinearSystem {
    pub(super) fn new(n: usize) -> LinearSystem {
        let square = vec![0.0; n * n];
        LinearSystem {
            n,
            given: square.clone(),
            is_factorized: false,
            matrix: square.clone(),
            lu: DenseLu::new(n),
            row_scale: vec![1.0; n],
            column_scale: vec![1.0; n],
            right: vec![0.0; n],
            rest: vec![0.0; n],
            x: vec![0.0; n],
            is_singular: false,
            is_one_of_many: false,
            has_factors: true,
            v: square.clone(),
            w: square,
            null: Vec::new(),
            near: vec![0.0; n],
        }
    }

    /// From here on, one of many solutions is that nearest to these values.
    pub(crate) fn prefer(&mut self, values: impl Iterator<Item = f64>) {
        for (near, value) in self.near.iter_mut().zip(values) {
            *near = if value.is_finite() { value } else { 0.0 };
        }
    }

    /// Carries out an instruction.
    pub(super) fn run(&mut self, solve: &LinearSolve, r: &mut [f64]) -> Result<(), NoSolution> {
        if let Some(entries) = &solve.entries
            && self.is_new(entries, r)
        {
            self.is_factorized = false;
        }
        self.is_one_of_many = false;
        if self.run_small(solve, r) {
            return Ok(());
        }
        if !self.is_factorized {
            self.scale();
            self.factorize()?;
            self.is_factorized = true;
        }
        for ((x, register), scale) in self.x.iter_mut().zip(&solve.right).zip(&self.row_scale) {
            *x = r[*register as usize] * scale;
        }
        match self.is_singular {
            false => self.lu.solve(&mut self.x),
            true => self.solve_singular(solve.is_derivative)?,
        }
        if self.x.iter().any(|x| !x.is_finite()) {
            return Err(NoSolution);
        }
        r[solve.d as usize..][..self.n].copy_from_slice(&self.x);
        Ok(())
    }

    /// Solves few equations that are clearly regular; whether they are.
    fn run_small(&mut self, solve: &LinearSolve, r: &mut [f64]) -> bool {
        let solution = match (&self.given[..], &solve.right[..]) {
            (&[a], &[right]) => [r[right as usize] / a, 0.0],
            (&[a, b, c, d], &[first, second]) => {
                let (right, s) = (r[first as usize], r[second as usize]);
                let (ad, bc) = (a * d, b * c);
                let determinant = ad - bc;
                let smallest = SMALLEST_DETERMINANT * (ad.abs() + bc.abs());
                if determinant.abs() <= smallest {
                    return false;
                }
                let inverse = 1.0 / determinant;
                [(right * d - b * s) * inverse, (a * s - right * c) * inverse]
            }
            (given, right) if right.len() <= MOST_SMALL => {
                let mut a = [0.0; MOST_SMALL * MOST_SMALL];
                let mut b = [0.0; MOST_SMALL];
                a[..given.len()].copy_from_slice(given);
                b.iter_mut().zip(right).for_each(|(b, register)| *b = r[*register as usize]);
                let is_regular = eliminate(&mut a[..given.len()], &mut b[..self.n]);
                if is_regular {
                    r[solve.d as usize..][..self.n].copy_from_slice(&b[..self.n]);
                }
                return is_regular;
            }
            _ => return false,
        };
        let is_finite = solution.iter().all(|x| x.is_finite());
        if is_finite {
            r[solve.d as usize..][..self.n].copy_from_slice(&solution[..self.n]);
        }
        is_finite
    }

    /// Reads the matrix; whether it is another than that factorised last.
    fn is_new(&mut self, entries: &[(u32, Register)], r: &[f64]) -> bool {
        let mut is_new = false;
        for (place, register) in entries {
            let (given, value) = (&mut self.given[*place as usize], r[*register as usize]);
            is_new |= *given != value;
            *given = value;
        }
        is_new
    }

    /// Writes the matrix with scaled rows.
    fn scale(&mut self) {
        let n = self.n;
        for (place, entry) in self.given.iter().enumerate() {
            let (row, column) = (place / n, place % n);
            self.matrix[column * n + row] = *entry;
        }
        self.row_scale.fill(0.0);
        for column in self.matrix.chunks_exact(n) {
            for (scale, entry) in self.row_scale.iter_mut().zip(column) {
                *scale = scale.max(entry.abs());
            }
        }
        for scale in &mut self.row_scale {
            *scale = if *scale > 0.0 { scale.recip() } else { 1.0 };
        }
        for (column, largest) in self.matrix.chunks_exact_mut(n).zip(&mut self.column_scale) {
            column.iter_mut().zip(&self.row_scale).for_each(|(entry, scale)| *entry *= scale);
            *largest = column.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
        }
    }

    fn factorize(&mut self) -> Result<(), NoSolution> {
        if self.matrix.iter().any(|entry| !entry.is_finite()) {
            return Err(NoSolution);
        }
        let n = self.n;
        self.lu.matrix().copy_from_slice(&self.matrix);
        let is_regular = self.lu.factorize().is_ok();
        let pivots = self.lu.matrix().iter().step_by(n + 1).zip(&self.column_scale);
        let smallest = pivots.map(|(u, scale)| u.abs() / scale).fold(f64::INFINITY, f64::min);
        self.is_singular = !is_regular || smallest <= SMALLEST_PIVOT;
        self.has_factors = is_regular && smallest > 4.0 * n as f64 * f64::EPSILON;
        if self.is_singular {
            self.orthogonalize();
        }
        Ok(())
    }

    /// Finds V and W, columns scaled by their largest entry.
    fn orthogonalize(&mut self) {
        let n = self.n;
        self.v.fill(0.0);
        self.v.iter_mut().step_by(n + 1).for_each(|one| *one = 1.0);
        self.w.copy_from_slice(&self.matrix);
        for (column, scale) in self.w.chunks_exact_mut(n).zip(&mut self.column_scale) {
            *scale = if *scale > 0.0 { scale.recip() } else { 1.0 };
            column.iter_mut().for_each(|entry| *entry *= *scale);
        }
        for _ in 0..MAX_SWEEPS {
            let mut rotated = false;
            for i in 0..n {
                for j in i + 1..n {
                    rotated |= self.rotate(i, j);
                }
            }
            if !rotated {
                break;
            }
        }
        self.find_null_space();
    }

    /// Makes the vectors of the null space orthogonal in the unknowns as they are.
    fn find_null_space(&mut self) {
        let n = self.n;
        let shortest = shortest_column(&self.w, n);
        self.null.clear();
        let columns = self.w.chunks_exact(n).zip(self.v.chunks_exact(n));
        for (_, v) in columns.filter(|(w, _)| dot(w, w) <= shortest) {
            let begin = self.null.len();
            self.null.extend(v.iter().zip(&self.column_scale).map(|(v, scale)| v * scale));
            let (known, new) = self.null.split_at_mut(begin);
            // Twice is enough: Parlett's rule.
            for _ in 0..2 {
                let length = dot(new, new).sqrt();
                new.iter_mut().for_each(|entry| *entry /= length);
                known.chunks_exact(n).for_each(|other| remove_part(new, other));
            }
            let length = dot(new, new).sqrt();
            new.iter_mut().for_each(|entry| *entry /= length);
        }
    }

    /// Makes columns i < j of W orthogonal; whether they were not.
    fn rotate(&mut self, i: usize, j: usize) -> bool {
        let n = self.n;
        let (a, b) = (&self.w[i * n..(i + 1) * n], &self.w[j * n..(j + 1) * n]);
        let (aa, bb, ab) = (dot(a, a), dot(b, b), dot(a, b));
        if ab == 0.0 || ab.abs() <= 1e-15 * (aa * bb).sqrt() {
            return false;
        }
        let zeta = (bb - aa) / (2.0 * ab);
        let t = zeta.signum() / (zeta.abs() + elementary::hypot(zeta, 1.0));
        let c = elementary::hypot(t, 1.0).recip();
        for columns in [&mut self.w, &mut self.v] {
            let (left, right) = columns.split_at_mut(j * n);
            for (a, b) in left[i * n..(i + 1) * n].iter_mut().zip(&mut right[..n]) {
                (*a, *b) = (c * (*a - t * *b), c * (t * *a + *b));
            }
        }
        true
    }

    /// From here on [`LinearSystem::open_unknowns`] tells of solutions to come.
    pub(super) fn forget_solution(&mut self) {
        self.is_one_of_many = false;
    }

    /// The unknowns that the system leaves open, if its last solution was one of many: those that
    /// the null space of A reaches.
    pub(crate) fn open_unknowns(&self) -> Vec<usize> {
        let n = self.n;
        if !self.is_one_of_many {
            return Vec::new();
        }
        let shortest = shortest_column(&self.w, n);
        let columns = self.w.chunks_exact(n).zip(self.v.chunks_exact(n));
        let null: Vec<&[f64]> =
            columns.filter(|(w, _)| dot(w, w) <= shortest).map(|(_, v)| v).collect();
        (0..n).filter(|i| null.iter().any(|v| v[*i].abs() > SMALLEST_PART)).collect()
    }

    /// Replaces the scaled b in x by the solution nearest to the values preferred; a derivative by the
    /// smallest one.
    fn solve_singular(&mut self, is_derivative: bool) -> Result<(), NoSolution> {
        let n = self.n;
        self.right.copy_from_slice(&self.x);
        let b = &mut self.rest;
        b.copy_from_slice(&self.right);
        if !is_derivative {
            for (column, near) in self.matrix.chunks_exact(n).zip(&self.near) {
                b.iter_mut().zip(column).for_each(|(b, entry)| *b -= entry * near);
            }
        }
        self.x.fill(0.0);
        let shortest = shortest_column(&self.w, n);
        let mut rank = 0;
        for (w, v) in self.w.chunks_exact(n).zip(self.v.chunks_exact(n)) {
            let square = dot(w, w);
            if square > shortest {
                rank += 1;
                let part = dot(w, b) / square;
                self.x.iter_mut().zip(v).for_each(|(x, v)| *x += part * v);
            }
        }
        self.x.iter_mut().zip(&self.column_scale).for_each(|(x, scale)| *x *= scale);
        self.null.chunks_exact(n).for_each(|null| remove_part(&mut self.x, null));
        if is_derivative {
            return Ok(());
        }
        self.x.iter_mut().zip(&self.near).for_each(|(x, near)| *x += near);
        if is_solved(&self.matrix, &self.x, &self.right) {
            self.is_one_of_many = rank < n;
            return Ok(());
        }
        if !self.has_factors {
            return Err(NoSolution);
        }
        self.x.copy_from_slice(&self.right);
        self.lu.solve(&mut self.x);
        Ok(())
    }
}

/// The square of the length up to which columns of W are zero.
fn shortest_column(w: &[f64], n: usize) -> f64 {
    let longest = w.chunks_exact(n).map(|w| dot(w, w)).fold(0.0, f64::max);
    SMALLEST_COLUMN * SMALLEST_COLUMN * longest
}

/// Whether A x = b but for rounding.
fn is_solved(matrix: &[f64], x: &[f64], b: &[f64]) -> bool {
    let n = b.len();
    (0..n).all(|row| {
        let terms = || x.iter().enumerate().map(|(column, x)| matrix[column * n + row] * x);
        let size = terms().fold(b[row].abs(), |size, term| size.max(term.abs()));
        let rest = terms().fold(-b[row], |sum, term| sum + term);
        rest.abs() <= CONSISTENT * size + CONSISTENT_TO_ONE
    })
}

/// Replaces b by the solution of A x = b, A by rows, if that is clearly regular; whether it is.
pub(super) fn eliminate(a: &mut [f64], b: &mut [f64]) -> bool {
    let n = b.len();
    let mut largest = [0.0; MOST_SMALL];
    for (row, b) in a.chunks_exact_mut(n).zip(b.iter_mut()) {
        let scale = row.iter().fold(0.0, |a: f64, b| a.max(b.abs())).recip();
        *b *= scale;
        for (entry, largest) in row.iter_mut().zip(&mut largest) {
            *entry *= scale;
            *largest = entry.abs().max(*largest);
        }
    }
    for k in 0..n {
        let size = |i: usize| a[i * n + k].abs();
        let best = (k + 1..n).fold(k, |best, i| if size(i) > size(best) { i } else { best });
        if size(best) <= CLEAR_PIVOT * largest[k] {
            return false;
        }
        b.swap(k, best);
        (k..n).for_each(|j| a.swap(k * n + j, best * n + j));
        for i in k + 1..n {
            let factor = a[i * n + k] / a[k * n + k];
            (k + 1..n).for_each(|j| a[i * n + j] -= factor * a[k * n + j]);
            b[i] -= factor * b[k];
        }
    }
    for k in (0..n).rev() {
        let known: f64 = (k + 1..n).map(|j| a[k * n + j] * b[j]).sum();
        b[k] = (b[k] - known) / a[k * n + k];
    }
    b.iter().all(|x| x.is_finite())
}

/// Removes the part of x along a unit vector.
fn remove_part(x: &mut [f64], unit: &[f64]) {
    let part = dot(x, unit);
    x.iter_mut().zip(unit).for_each(|(x, unit)| *x -= part * unit);
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Solves with A by rows in the first registers and b after it.
    fn solve(a: &[f64], b: &[f64], is_derivative: bool) -> Option<Vec<f64>> {
        let n = b.len();
        let mut r: Vec<f64> = a.iter().chain(b).copied().chain(vec![0.0; n]).collect();
        let entries = (0..(n * n) as u32).map(|place| (place, place)).collect();
        let right = ((n * n) as u32..(n * n + n) as u32).collect();
        let d = (n * n + n) as u32;
        let solve = LinearSolve { system: 0, entries: Some(entries), right, d, is_derivative };
        LinearSystem::new(n).run(&solve, &mut r).ok()?;
        Some(r[d as usize..].to_vec())
    }

    #[test]
    fn the_smallest_of_many_solutions_is_taken() {
        let x = solve(&[1.0, 1.0, 2.0, 2.0], &[4.0, 8.0], false).unwrap();
        x.iter().for_each(|x| assert!((x - 2.0).abs() < 1e-12, "{x}"));
        // A column and a row of zeros.
        let x = solve(&[2.0, 0.0, 0.0, 0.0], &[3.0, 0.0], false).unwrap();
        assert!((x[0] - 1.5).abs() < 1e-12 && x[1] == 0.0);
        assert_eq!(solve(&[0.0], &[0.0], false), Some(vec![0.0]));
        // Whatever the coefficients: a + 2 b = 5 is nearest to the origin at (1, 2).
        let x = solve(&[1.0, 2.0, 2.0, 4.0], &[5.0, 10.0], false).unwrap();
        assert!((x[0] - 1.0).abs() < 1e-12 && (x[1] - 2.0).abs() < 1e-12, "{x:?}");
        // A plane: x + 2 y + 3 z = 14.
        let plane = [1.0, 2.0, 3.0, 2.0, 4.0, 6.0, 3.0, 6.0, 9.0];
        let x = solve(&plane, &[14.0, 28.0, 42.0], false).unwrap();
        x.iter().zip(1..).for_each(|(x, k)| assert!((x - f64::from(k)).abs() < 1e-12, "{x}"));
    }

    #[test]
    fn of_many_solutions_the_one_nearest_to_given_values_is_taken() {
        // No flow: 0 (T - 300) = 0 leaves T where it was, and x + y = 4 the difference of x and y.
        for (a, b, near, nearest) in [
            ([0.0, 0.0, 0.0, 1.0], [0.0, 2.0], [350.0, 0.0], [350.0, 2.0]),
            ([1.0, 1.0, 2.0, 2.0], [4.0, 8.0], [5.0, 3.0], [3.0, 1.0]),
        ] {
            let mut r: Vec<f64> = a.iter().chain(&b).copied().chain([0.0; 2]).collect();
            let entries = (0..4).map(|place| (place, place)).collect();
            let solve = LinearSolve {
                system: 0,
                entries: Some(entries),
                right: vec![4, 5].into(),
                d: 6,
                is_derivative: false,
            };
            let mut system = LinearSystem::new(2);
            system.prefer(near.into_iter());
            system.run(&solve, &mut r).unwrap();
            for (x, nearest) in r[6..].iter().zip(nearest) {
                assert!((x - nearest).abs() < 1e-12, "{r:?}");
            }
        }
    }

    #[test]
    fn the_null_space_tells_which_unknowns_are_open() {
        let open = |a: &[f64], b: &[f64]| {
            let n = b.len();
            let mut r: Vec<f64> = a.iter().chain(b).copied().chain(vec![0.0; n]).collect();
            let entries = (0..(n * n) as u32).map(|place| (place, place)).collect();
            let right = ((n * n) as u32..(n * n + n) as u32).collect();
            let d = (n * n + n) as u32;
            let solve =
                LinearSolve { system: 0, entries: Some(entries), right, d, is_derivative: false };
            let mut system = LinearSystem::new(n);
            system.run(&solve, &mut r).unwrap();
            system.open_unknowns()
        };
        // The second unknown is determined, the others are not.
        let a = [1.0, 0.0, 1.0, 0.0, 3.0, 0.0, 2.0, 1.0, 2.0];
        assert_eq!(open(&a, &[1.0, 6.0, 4.0]), [0, 2]);
        assert_eq!(open(&[0.0], &[0.0]), [0]);
        assert!(open(&[2.0, 1.0, 1.0, 1.0], &[1.0, 1.0]).is_empty());
    }

    #[test]
    fn contradictions_have_no_solution() {
        assert_eq!(solve(&[1.0, 1.0, 2.0, 2.0], &[4.0, 8.1], false), None);
        assert_eq!(solve(&[0.0], &[1.0], false), None);
        // The derivative of a solution that exists is that nearest to a solution.
        let x = solve(&[1.0, 0.0, 0.0, 0.0], &[4.0, 1.0], true).unwrap();
        assert!((x[0] - 4.0).abs() < 1e-12 && x[1] == 0.0);
        assert_eq!(solve(&[f64::NAN], &[1.0], false), None);
    }

    #[test]
    fn badly_scaled_rows_are_not_singular() {
        let x = solve(&[1e-12, 2e-12, 1e9, -1e9], &[5e-12, -1e9], false).unwrap();
        assert!((x[0] - 1.0).abs() < 1e-12 && (x[1] - 2.0).abs() < 1e-12);
    }

    #[test]
    fn unknowns_may_be_in_very_different_units() {
        let x = [1e5, 2e-3, 3.0];
        let a = [0.0, 500.0, 1.0, 2e3, -5e13, 1e8, 1e-15, 5e-8, -1e-10];
        let b: Vec<f64> = a.chunks(3).map(|row| dot(row, &x)).collect();
        let found = solve(&a, &b, false).unwrap();
        x.iter().zip(found).for_each(|(x, found)| assert!((x / found - 1.0).abs() < 1e-12));
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]

        #[test]
        fn what_is_solved_is_a_solution(
            a in prop::collection::vec(-3i8..=3, 16),
            x in prop::collection::vec(-5i8..=5, 4),
        ) {
            // Whole numbers: many of these matrices are singular.
            let a: Vec<f64> = a.into_iter().map(f64::from).collect();
            let product = |x: &[f64]| -> Vec<f64> {
                a.chunks(4).map(|row| dot(row, x)).collect()
            };
            let given: Vec<f64> = x.into_iter().map(f64::from).collect();
            let b = product(&given);
            let found = solve(&a, &b, false).expect("a solution exists");
            for (left, right) in product(&found).iter().zip(&b) {
                prop_assert!((left - right).abs() < 1e-8);
            }
        }
    }
}
