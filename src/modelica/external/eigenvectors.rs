//! Eigenvectors of upper quasi-triangular matrices, in LAPACK's form.

use super::matrices::power_of_two;
use super::quasi_triangular::block_size;
use super::schur::modulus;
use nalgebra::{Complex, DMatrix, DVector};

type C = Complex<f64>;

/// The right eigenvectors of all eigenvalues, as columns: one for a real eigenvalue, real and
/// imaginary parts of that with positive imaginary part for a pair.
pub(crate) fn right_eigenvectors(t: &DMatrix<f64>) -> DMatrix<f64> {
    let n = t.nrows();
    // The vectors are those of any multiple; products must not overflow.
    let t = &(t / power_of_two(t.amax()));
    let mut all = DMatrix::zeros(n, n);
    let mut at = 0;
    while at < n {
        let size = block_size(t, at);
        let vector = eigenvector(t, at, size);
        all.set_column(at, &vector.map(|v| v.re));
        if size == 2 {
            all.set_column(at + 1, &vector.map(|v| v.im));
        }
        at += size;
    }
    all
}

/// The left eigenvectors y, yᴴ T = λ yᴴ, as columns like the right ones.
pub(crate) fn left_eigenvectors(t: &DMatrix<f64>) -> DMatrix<f64> {
    // They are right ones of Tᵀ, which is upper triangular with its coordinates in reverse, for
    // the conjugate eigenvalues.
    let n = t.nrows();
    let reverse = DMatrix::from_fn(n, n, |i, j| t[(n - 1 - j, n - 1 - i)]);
    let vectors = right_eigenvectors(&reverse);
    let mut all = DMatrix::zeros(n, n);
    let mut at = 0;
    while at < n {
        let size = block_size(t, at);
        let from = n - at - size;
        for row in 0..n {
            all[(row, at)] = vectors[(n - 1 - row, from)];
            if size == 2 {
                all[(row, at + 1)] = -vectors[(n - 1 - row, from + 1)];
            }
        }
        at += size;
    }
    all
}

/// The vector of the block of `size` rows from `k` on, by back substitution.
fn eigenvector(t: &DMatrix<f64>, k: usize, size: usize) -> DVector<C> {
    let mut x = DVector::from_element(t.nrows(), C::new(0.0, 0.0));
    let value = if size == 1 {
        x[k] = C::new(1.0, 0.0);
        C::new(t[(k, k)], 0.0)
    } else {
        let root = (-t[(k, k + 1)] * t[(k + 1, k)]).max(0.0).sqrt();
        x[k] = C::new(t[(k, k + 1)], 0.0);
        x[k + 1] = C::new(0.0, root);
        C::new(t[(k, k)], root)
    };
    let least = (f64::EPSILON * t.norm()).max(f64::MIN_POSITIVE.sqrt());
    let mut row = k;
    while row > 0 {
        let size = if row > 1 && t[(row - 1, row - 2)] != 0.0 { 2 } else { 1 };
        row -= size;
        let rest =
            |i: usize| -> C { -(row + size..t.nrows()).map(|j| x[j] * t[(i, j)]).sum::<C>() };
        if size == 1 {
            x[row] = rest(row) / apart(value, t[(row, row)], least);
        } else {
            let (p, q) = (C::from(t[(row, row)]) - value, C::from(t[(row + 1, row + 1)]) - value);
            let (b, c) = (t[(row, row + 1)], t[(row + 1, row)]);
            let (r, s) = (rest(row), rest(row + 1));
            let mut determinant = p * q - b * c;
            if modulus(determinant) < least * least {
                determinant = C::from(least * least);
            }
            x[row] = (r * q - s * b) / determinant;
            x[row + 1] = (s * p - r * c) / determinant;
        }
        // Next to a multiple eigenvalue components grow without bound.
        let size = modulus(x[row]);
        if size > 1e50 {
            x.unscale_mut(size);
        }
    }
    x
}

/// `element − value`, but never zero.
fn apart(value: C, element: f64, least: f64) -> C {
    let difference = C::from(element) - value;
    if modulus(difference) < least { C::from(least) } else { difference }
}

/// How columns that hold eigenvectors are scaled.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Scale {
    /// Euclidean norm 1; the largest component of a complex one is real.
    Norm,
    /// The largest component has 1 as sum of the sizes of its parts.
    Largest,
}

/// Scales columns that hold eigenvectors, complex ones where eigenvalues are.
pub(crate) fn scale(vectors: &mut DMatrix<f64>, is_complex: impl Fn(usize) -> bool, scale: Scale) {
    let mut at = 0;
    while at < vectors.ncols() {
        let size = if is_complex(at) && at + 1 < vectors.ncols() { 2 } else { 1 };
        let imaginary = |row: usize| if size == 2 { vectors[(row, at + 1)] } else { 0.0 };
        let vector: Vec<C> =
            (0..vectors.nrows()).map(|row| C::new(vectors[(row, at)], imaginary(row))).collect();
        let factor = match scale {
            Scale::Norm => {
                let norm = vector.iter().map(|v| v.norm_sqr()).sum::<f64>().sqrt();
                let phase = if size == 2 { phase(&vector) } else { C::new(1.0, 0.0) };
                phase / norm
            }
            Scale::Largest => {
                let size = |v: &C| v.re.abs() + v.im.abs();
                C::from(1.0 / vector.iter().map(size).fold(0.0, f64::max))
            }
        };
        if factor.is_finite() {
            for (row, value) in vector.iter().enumerate() {
                let scaled = value * factor;
                vectors[(row, at)] = scaled.re;
                if size == 2 {
                    vectors[(row, at + 1)] = scaled.im;
                }
            }
        }
        at += size;
    }
}

/// The complex number of size 1 that makes the largest component real and positive.
fn phase(vector: &[C]) -> C {
    let mut greatest = C::new(0.0, 0.0);
    for value in vector {
        // Components that differ by rounding are equal: the first counts.
        if modulus(*value) > modulus(greatest) * (1.0 + 1e-12) {
            greatest = *value;
        }
    }
    if modulus(greatest) == 0.0 { C::new(1.0, 0.0) } else { greatest.conj() / modulus(greatest) }
}
