//! Linear models of deviations from a point, their poles, zeros and responses.

use crate::codegen::ORDERS;
use crate::codegen::errors::NOT_LINEARIZED;
use crate::diag::Fault;
use crate::fault;
pub use crate::frequency::Number;
use crate::plot::Responding;
use crate::registry::BAD_OPTION;

use crate::elementary;
use crate::frequency::{self, LinearSystem, Response};
use crate::mat::{self, Matrix};
use crate::results::ResultTable;
use nalgebra::DMatrix;
use std::f64::consts::TAU;

/// A model ẋ = A x + Σ B_k u^(k), y = C x + Σ D_k u^(k) of deviations, with derivatives of the inputs.
pub struct Linear {
    /// Names of the states x, the inputs u and the outputs y.
    pub names: [Vec<String>; 3],
    /// States and inputs at the point of linearization.
    pub x0: Vec<f64>,
    /// Inputs there.
    pub u0: Vec<f64>,
    /// ∂ẋ/∂x, states × states.
    pub a: DMatrix<f64>,
    /// ∂ẋ/∂u^(k), states × inputs.
    pub b: [DMatrix<f64>; ORDERS],
    /// ∂y/∂x, outputs × states.
    pub c: DMatrix<f64>,
    /// ∂y/∂u^(k), outputs × inputs.
    pub d: [DMatrix<f64>; ORDERS],
    /// The simulation before.
    pub results: ResultTable,
}

impl Linear {
    /// The matrices A, B, C and D.
    ///
    /// # Errors
    /// Derivatives of inputs, of which these say nothing.
    pub fn matrices(&self) -> Result<[&DMatrix<f64>; 4], Fault> {
        let has_entry =
            |matrix: &DMatrix<f64>, input| matrix.column(input).iter().any(|v| *v != 0.0);
        let is_needed = |input: &usize| {
            let of_derivatives = self.b[1..].iter().chain(&self.d[1..]);
            of_derivatives.into_iter().any(|matrix| has_entry(matrix, *input))
        };
        match (0..self.names[1].len()).find(is_needed) {
            None => Ok([&self.a, &self.b[0], &self.c, &self.d[0]]),
            Some(input) => Err(fault!(
                NOT_LINEARIZED,
                "the model depends on the derivative of its input `{}`, which matrices A, B, C and D do \
                 not have", self.names[1][input];
                help: "filter the input with a first-order block; `bode` and `gapi linearize` show transfer \
                       functions with such derivatives"
            )),
        }
    }

    /// The matrices in Dymola's layout, as a MAT file: `ABCD` = [A, B; C, D], `nx` and the names of x,
    /// u and y.
    ///
    /// # Errors
    /// Derivatives of inputs; names and matrices that are too large for the format.
    pub fn to_mat(&self) -> Result<Vec<u8>, Fault> {
        let [a, b, c, d] = self.matrices()?;
        let [x, u, y] = &self.names;
        let whole = |i: usize, j: usize| match (i.checked_sub(x.len()), j.checked_sub(x.len())) {
            (None, None) => a[(i, j)],
            (None, Some(j)) => b[(i, j)],
            (Some(i), None) => c[(i, j)],
            (Some(i), Some(j)) => d[(i, j)],
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
        let b = self.b.each_ref().map(|own| own.column(input).into_owned());
        let d = self.d.each_ref().map(|own| own[(output, input)]);
        frequency::zeros(&self.a, b.to_vec(), &self.c.row(output).into_owned(), d.to_vec())
    }

    /// y/u at rest; `None` at a pole there.
    pub fn gain(&self, (output, input): (usize, usize)) -> Option<f64> {
        if self.a.is_empty() {
            return Some(self.d[0][(output, input)]);
        }
        let x = self.a.clone().lu().solve(&-self.b[0].column(input))?;
        let value = (self.c.row(output) * x)[0] + self.d[0][(output, input)];
        Some(value).filter(|value| value.is_finite())
    }

    /// y/u at frequencies in Hz; `None` where a pole lies at one of them.
    pub fn response(&self, channel: (usize, usize), frequencies: &[f64]) -> Option<Vec<Number>> {
        let system = self.system(channel);
        let response = Response::new(&system)?;
        frequencies.iter().map(|hertz| response.value(TAU * hertz)).collect()
    }

    /// The responses from all inputs to all outputs, with their names.
    ///
    /// # Errors
    /// A model without inputs or outputs, a pole at one of the frequencies.
    pub fn responses(&self, frequencies: &[f64]) -> Result<Vec<(String, Vec<Number>)>, Fault> {
        let all: Vec<usize> = (0..self.names[1].len()).collect();
        self.responses_to(&all, frequencies)
    }

    /// The same from these inputs, by their places.
    ///
    /// # Errors
    /// As above.
    pub fn responses_to(
        &self,
        inputs: &[usize],
        frequencies: &[f64],
    ) -> Result<Vec<(String, Vec<Number>)>, Fault> {
        let [_, names, outputs] = &self.names;
        if inputs.is_empty() || outputs.is_empty() {
            let what = if inputs.is_empty() { "input" } else { "output" };
            return Err(fault!(
                BAD_OPTION,
                "a response needs an input and an output, and the model has no {what}"
            )
            .help(match inputs.is_empty() {
                true => "declare one at the top level: `input Real u;`",
                false => "name a variable: `--output v`",
            }));
        }
        let mut found = Vec::new();
        for &input in inputs {
            for (place, output) in outputs.iter().enumerate() {
                let name = format!("{output}/{}", names[input]);
                let values = self.response((place, input), frequencies).ok_or_else(|| {
                    fault!(
                        BAD_OPTION,
                        "the response {name} cannot be computed: a pole lies at one of the \
                         frequencies"
                    )
                })?;
                found.push((name, values));
            }
        }
        Ok(found)
    }

    /// The system from an input to an output.
    fn system(&self, (output, input): (usize, usize)) -> LinearSystem {
        let n = self.a.nrows();
        let entry = |i: usize, j: usize| match (i == n, j.checked_sub(n)) {
            (false, None) => self.a[(i, j)],
            (false, Some(order)) => self.b[order][(i, input)],
            (true, None) => self.c[(output, j)],
            (true, Some(order)) => self.d[order][(output, input)],
        };
        LinearSystem { n_states: n, jacobian: DMatrix::from_fn(n + 1, n + ORDERS, entry) }
    }
}

/// Frequencies in Hz evenly by their logarithms, about those of the poles where no ends are given.
///
/// # Errors
/// Ends that are no range.
pub fn frequencies(
    [from, to]: [Option<f64>; 2],
    per_decade: f64,
    poles: &[Number],
) -> Result<Vec<f64>, Fault> {
    let sizes = poles.iter().map(|pole| pole.norm_sqr().sqrt() / TAU).filter(|size| *size > 0.0);
    let ends = (f64::INFINITY, 0.0);
    let (slow, fast) = sizes.fold(ends, |(a, b), size: f64| (a.min(size), f64::max(b, size)));
    let (slow, fast) = if fast > 0.0 { (slow / 10.0, fast * 10.0) } else { (0.01, 100.0) };
    let (from, to) = (from.unwrap_or(slow), to.unwrap_or(fast));
    if !(from > 0.0 && to > from && to.is_finite()) {
        return Err(fault!(
            BAD_OPTION,
            "the frequencies from {from} to {to} Hz are no range";
            help: "--from must be positive and below --to"
        ));
    }
    let decades = elementary::log10(to / from);
    let count = (decades * per_decade).ceil().clamp(1.0, 1e5) as usize;
    let at = |k: usize| from * elementary::powf(to / from, k as f64 / count as f64);
    Ok((0..=count).map(at).collect())
}

/// Magnitudes in dB and phases in degrees, these without jumps.
pub fn responding(name: &str, values: &[Number]) -> Responding {
    let mut phases: Vec<f64> = Vec::with_capacity(values.len());
    for value in values {
        let phase = elementary::atan2(value.im, value.re).to_degrees();
        let rounds = phases.last().map_or(0.0, |last| ((last - phase) / 360.0).round());
        phases.push(phase + 360.0 * rounds);
    }
    Responding {
        name: name.to_owned(),
        magnitudes: values.iter().map(|own| 10.0 * elementary::log10(own.norm_sqr())).collect(),
        phases,
    }
}
