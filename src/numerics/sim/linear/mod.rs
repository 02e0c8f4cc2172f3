//! Linear systems of a pattern that stays: analysed once, factorised and solved often.

mod dense;
mod factor_pattern;
mod sparse;
#[cfg(feature = "jit")]
mod straight_line;
#[cfg(not(feature = "jit"))]
#[path = "without_straight_line.rs"]
mod straight_line;
#[cfg(test)]
mod tests;

use super::Pattern;
pub use dense::DenseLu;
use sparse::SparseLu;
pub use straight_line::interpret;

/// A matrix that has no usable factors.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SingularMatrix;

/// A factorised matrix; dense where the pattern is small or full.
#[derive(Debug, Clone)]
pub enum Factorization {
    /// All entries.
    Dense(DenseMatrix),
    /// The nonzeros.
    Sparse(Box<SparseLu>),
}

/// Up to this size a dense factorization is faster.
const SMALL: usize = 12;

impl Factorization {
    /// Prepares for matrices of a pattern. `coupled`: rows and columns of unknowns of algebraic loops,
    /// whose diagonal may be zero.
    pub fn new(pattern: &Pattern, coupled: &[usize]) -> Factorization {
        let n = pattern.n;
        if n <= SMALL || 3 * pattern.rows.len() > n * n {
            Factorization::Dense(DenseMatrix::new(pattern))
        } else {
            Factorization::Sparse(Box::new(SparseLu::new(pattern, coupled)))
        }
    }

    /// Factorises the matrix with these nonzeros, in the order of the pattern.
    pub fn factorize(&mut self, values: &[f64]) -> Result<(), SingularMatrix> {
        match self {
            Factorization::Dense(matrix) => matrix.factorize(values),
            Factorization::Sparse(lu) => lu.factorize(values),
        }
    }

    /// A new simulation begins: it is to give the same bits whatever was factorised before.
    pub fn forget(&mut self) {
        if let Factorization::Sparse(lu) = self {
            lu.forget();
        }
    }

    /// Replaces the right-hand side by the solution.
    pub fn solve(&mut self, b: &mut [f64]) {
        match self {
            Factorization::Dense(matrix) => matrix.lu.solve(b),
            Factorization::Sparse(lu) => lu.solve(b),
        }
    }

    /// Replaces right-hand sides, one after another, by the solutions.
    pub fn solve_all(&mut self, b: &mut [f64]) {
        match self {
            Factorization::Dense(matrix) => {
                b.chunks_exact_mut(matrix.lu.size().max(1)).for_each(|b| matrix.lu.solve(b));
            }
            Factorization::Sparse(lu) => lu.solve_all(b),
        }
    }
}

/// A sparse matrix factorised as a dense one.
#[derive(Debug, Clone)]
pub struct DenseMatrix {
    /// Position in the dense matrix of every nonzero.
    positions: Vec<usize>,
    lu: DenseLu,
}

impl DenseMatrix {
    fn new(pattern: &Pattern) -> DenseMatrix {
        let n = pattern.n;
        let of_column = |j: usize| pattern.rows[pattern.column(j)].iter().map(move |i| i + j * n);
        DenseMatrix { positions: (0..n).flat_map(of_column).collect(), lu: DenseLu::new(n) }
    }

    fn factorize(&mut self, values: &[f64]) -> Result<(), SingularMatrix> {
        let matrix = self.lu.matrix();
        matrix.fill(0.0);
        for (position, value) in self.positions.iter().zip(values) {
            matrix[*position] = *value;
        }
        self.lu.factorize()
    }
}
