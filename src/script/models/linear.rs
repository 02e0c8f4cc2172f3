//! Linear models of deviations from a point, their poles, zeros and responses.

use crate::diag::Fault;
pub use crate::frequency::Number;

use crate::frequency::{self, LinearSystem, Response};
use crate::mat::{self, Matrix};
use crate::results::ResultTable;
use nalgebra::DMatrix;
use std::f64::consts::TAU;

/// A model ẋ = A x + B u, y = C x + D u of deviations.
pub struct Linear {
    /// Names of the states x, the inputs u and the outputs y.
    pub names: [Vec<String>; 3],
    /// States and inputs at the point of linearization.
    pub x0: Vec<f64>,
    /// Inputs there.
    pub u0: Vec<f64>,
    /// ∂ẋ/∂x, states × states.
    pub a: DMatrix<f64>,
    /// ∂ẋ/∂u, states × inputs.
    pub b: DMatrix<f64>,
    /// ∂y/∂x, outputs × states.
    pub c: DMatrix<f64>,
    /// ∂y/∂u, outputs × inputs.
    pub d: DMatrix<f64>,
    /// The simulation before.
    pub results: ResultTable,
}

impl Linear {
    /// The matrices in Dymola's layout, as a MAT file: `ABCD` = [A, B; C, D], `nx` and the names of x,
    /// u and y.
    ///
    /// # Errors
    /// Names and matrices that are too large for the format.
    pub fn to_mat(&self) -> Result<Vec<u8>, Fault> {
        let [x, u, y] = &self.names;
        let whole = |i: usize, j: usize| match (i.checked_sub(x.len()), j.checked_sub(x.len())) {
            (None, None) => self.a[(i, j)],
            (None, Some(j)) => self.b[(i, j)],
            (Some(i), None) => self.c[(i, j)],
            (Some(i), Some(j)) => self.d[(i, j)],
        };
        let (rows, columns) = (x.len() + y.len(), x.len() + u.len());
        let elements = (0..columns).flat_map(|j| (0..rows).map(move |i| whole(i, j))).collect();
        let names: Vec<&String> = self.names.iter().flatten().collect();
        let class = ["AlinearSystem", "1.0", "Linear time invariant system", ""];
        let matrices = [
            ("Aclass", Matrix::from_text(&class)),
            ("ABCD", Matrix::from_columns(rows, columns, elements)),
            ("nx", Matrix::from_rows(&[vec![x.len() as f64]])),
            ("xuyName", Matrix::from_text(&names)),
        ];
        mat::write_v4(matrices.iter().map(|(name, matrix)| (*name, matrix)))
    }

    /// The poles, slowest first; `None` where they cannot be computed.
    pub fn poles(&self) -> Option<Vec<Number>> {
        frequency::poles(&self.a)
    }

    /// The zeros from an input to an output, by their places, slowest first; `None` where the output does not
    /// answer.
    pub fn zeros(&self, (output, input): (usize, usize)) -> Option<Vec<Number>> {
        let (b, c) = (self.b.column(input).into_owned(), self.c.row(output).into_owned());
        frequency::zeros(&self.a, &b, &c, self.d[(output, input)])
    }

    /// y/u at rest; `None` at a pole there.
    pub fn gain(&self, (output, input): (usize, usize)) -> Option<f64> {
        if self.a.is_empty() {
            return Some(self.d[(output, input)]);
        }
        let x = self.a.clone().lu().solve(&-self.b.column(input))?;
        let value = (self.c.row(output) * x)[0] + self.d[(output, input)];
        Some(value).filter(|value| value.is_finite())
    }

    /// y/u at frequencies in Hz; `None` where a pole lies at one of them.
    pub fn response(&self, channel: (usize, usize), frequencies: &[f64]) -> Option<Vec<Number>> {
        let system = self.system(channel);
        let response = Response::new(&system)?;
        frequencies.iter().map(|hertz| Some(response.at(TAU * hertz)?.value)).collect()
    }

    /// The system from an input to an output.
    fn system(&self, (output, input): (usize, usize)) -> LinearSystem {
        let n = self.a.nrows();
        let entry = |i: usize, j: usize| match (i == n, j == n) {
            (false, false) => self.a[(i, j)],
            (false, true) => self.b[(i, input)],
            (true, false) => self.c[(output, j)],
            (true, true) => self.d[(output, input)],
        };
        LinearSystem { n_states: n, jacobian: DMatrix::from_fn(n + 1, n + 1, entry) }
    }
}
