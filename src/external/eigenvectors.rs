//! Right eigenvectors of real matrices, in LAPACK's form.

use nalgebra::{Complex, DMatrix, DVector, Schur};

/// The vectors of all eigenvalues, which come in conjugate pairs, that with positive imaginary part
/// first: a column for a real one, real and imaginary parts in two columns for a pair. Their norms
/// are 1, and the largest component of a complex one is real. `None` if the Schur form was not
/// found.
pub(super) fn eigenvectors(a: &DMatrix<f64>, values: &[Complex<f64>]) -> Option<DMatrix<f64>> {
    let n = a.nrows();
    let complex = a.map(|value| Complex::new(value, 0.0));
    let (q, t) = Schur::try_new(complex, f64::EPSILON, 10_000)?.unpack();
    let mut free: Vec<usize> = (0..n).collect();
    let mut all = DMatrix::zeros(n, n);
    for (at, value) in values.iter().enumerate() {
        let distance = |k: usize| (t[(k, k)] - value).norm();
        let nearest =
            (0..free.len()).min_by(|a, b| distance(free[*a]).total_cmp(&distance(free[*b])))?;
        let vector = normalized(&q * triangular_eigenvector(&t, free.remove(nearest)));
        if value.im == 0.0 {
            all.set_column(at, &real_form(vector));
        } else if value.im > 0.0 && at + 1 < n {
            all.set_column(at, &vector.map(|v| v.re));
            all.set_column(at + 1, &vector.map(|v| v.im));
        }
    }
    Some(all)
}

/// The eigenvector of an upper triangular matrix for its diagonal element `k`.
fn triangular_eigenvector(t: &DMatrix<Complex<f64>>, k: usize) -> DVector<Complex<f64>> {
    let n = t.nrows();
    let least = f64::EPSILON * t.norm().max(f64::MIN_POSITIVE);
    let mut x = DVector::from_element(n, Complex::new(0.0, 0.0));
    x[k] = Complex::new(1.0, 0.0);
    for i in (0..k).rev() {
        let sum: Complex<f64> = (i + 1..=k).map(|j| t[(i, j)] * x[j]).sum();
        let difference = t[(i, i)] - t[(k, k)];
        let pivot = if difference.norm() < least { Complex::new(least, 0.0) } else { difference };
        x[i] = -sum / pivot;
    }
    x
}

/// Of norm 1, turned so that its largest component is real and positive.
fn normalized(x: DVector<Complex<f64>>) -> DVector<Complex<f64>> {
    let norm = x.norm();
    let mut greatest = x[0];
    for value in x.iter() {
        // Components that differ by rounding are equal: the first counts.
        if value.norm() > greatest.norm() * (1.0 + 1e-12) {
            greatest = *value;
        }
    }
    let turn = greatest.conj() / greatest.norm();
    x.map(|value| value * turn / norm)
}

fn real_form(x: DVector<Complex<f64>>) -> DVector<f64> {
    let real = x.map(|value| value.re);
    let norm = real.norm();
    real / norm
}
