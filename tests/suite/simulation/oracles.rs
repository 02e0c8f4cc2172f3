//! Factorizations against an independent implementation: the dense LU of the crate faer. Integrators
//! are held against published solutions in `reference_problems`: the crate diffsol would switch on
//! the feature `std` of nalgebra, with which its sums depend on the processor.

use faer::linalg::solvers::{DenseSolveCore, PartialPivLu, Solve};
use gapilib::internals::sim::{DenseLu, Factorization, Pattern};
use proptest::prelude::*;

/// Entries by columns, most of them zero, with rows and columns scaled by powers of ten.
fn matrices(n: usize, magnitudes: i32) -> impl Strategy<Value = Vec<f64>> {
    let entry = prop_oneof![3 => Just(0.0), 1 => -1.0f64..1.0];
    let scales = move || prop::collection::vec(-magnitudes..=magnitudes, n);
    let diagonal = prop::collection::vec(0.1f64..2.0, n);
    (prop::collection::vec(entry, n * n), diagonal, 0..n, scales(), scales()).prop_map(
        move |(mut entries, diagonal, shift, rows, columns)| {
            for (j, value) in diagonal.into_iter().enumerate() {
                entries[j * n + (j + shift) % n] = value;
            }
            for (place, entry) in entries.iter_mut().enumerate() {
                *entry *= 10f64.powi(rows[place % n] + columns[place / n]);
            }
            entries
        },
    )
}

fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, |largest, value| largest.max(value.abs()))
}

/// The norm of a matrix that belongs to the largest entry of vectors.
fn norm(n: usize, entry: impl Fn(usize, usize) -> f64) -> f64 {
    largest((0..n).map(|i| (0..n).map(|j| entry(i, j).abs()).sum()))
}

/// Solves with ours and with faer's factors and compares: residuals are those of a backward stable
/// method (normwise, Higham 2002, §9.3; growth of the entries allowed for), and solutions differ by no
/// more than that with the condition of the matrix.
fn compare(n: usize, entries: &[f64], solve: impl FnOnce(&mut [f64]) -> bool) {
    let matrix = faer::Mat::from_fn(n, n, |i, j| entries[j * n + i]);
    let right = faer::Mat::from_fn(n, 1, |i, _| {
        // As large as the row, so that rows of all scales count.
        let size = largest((0..n).map(|j| entries[j * n + i]));
        size * ((i as f64).sin() + 1.5)
    });
    let lu: PartialPivLu<f64> = matrix.partial_piv_lu();
    let oracle = lu.solve(&right);
    let inverse = lu.inverse();
    let size = norm(n, |i, j| matrix[(i, j)]);
    let condition = size * norm(n, |i, j| inverse[(i, j)]);
    if !condition.is_finite() {
        return;
    }
    let mut x: Vec<f64> = (0..n).map(|i| right[(i, 0)]).collect();
    let solved = solve(&mut x);
    if condition * f64::EPSILON > 1e-3 {
        // Singular within rounding errors: neither has digits.
        return;
    }
    assert!(solved, "a regular matrix (condition {condition:e}) has no factors");
    let allowed = 1e3 * n as f64 * f64::EPSILON;
    let residual =
        largest((0..n).map(|i| (0..n).map(|j| matrix[(i, j)] * x[j]).sum::<f64>() - right[(i, 0)]));
    let reach = largest(x.iter().copied());
    assert!(residual <= allowed * size * reach, "residual {residual:e} of {size:e} {reach:e}");
    let apart = largest((0..n).map(|i| x[i] - oracle[(i, 0)]));
    let scale = largest((0..n).map(|i| oracle[(i, 0)]));
    assert!(apart <= allowed * condition * scale, "{apart:e} of {scale:e}, {condition:e}");
}

fn dense(n: usize, entries: &[f64]) {
    compare(n, entries, |b| {
        let mut lu = DenseLu::new(n);
        lu.matrix().copy_from_slice(entries);
        let is_regular = lu.factorize().is_ok();
        lu.solve(b);
        is_regular
    });
}

fn sparse(n: usize, entries: &[f64]) {
    let mut pattern = Pattern { n, column_starts: vec![0], rows: Vec::new() };
    let mut values = Vec::new();
    for column in entries.chunks_exact(n) {
        for (row, value) in column.iter().enumerate().filter(|(_, value)| **value != 0.0) {
            pattern.rows.push(row);
            values.push(*value);
        }
        pattern.column_starts.push(values.len());
    }
    let mut factors = Factorization::new(&pattern, &[]);
    // Nothing else is compared where so many entries are not zero.
    if matches!(factors, Factorization::Dense(_)) {
        return;
    }
    compare(n, entries, |b| {
        let is_regular = factors.factorize(&values).is_ok();
        factors.solve(b);
        is_regular
    });
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn dense_factors_solve_as_those_of_faer(entries in (1usize..20).prop_flat_map(|n| matrices(n, 0))) {
        dense(entries.len().isqrt(), &entries);
    }

    #[test]
    fn dense_factors_of_badly_scaled_matrices(entries in (2usize..12).prop_flat_map(|n| matrices(n, 3))) {
        dense(entries.len().isqrt(), &entries);
    }

    #[test]
    fn sparse_factors_solve_as_those_of_faer(entries in (13usize..40).prop_flat_map(|n| matrices(n, 0))) {
        sparse(entries.len().isqrt(), &entries);
    }

    #[test]
    fn sparse_factors_of_badly_scaled_matrices(entries in (13usize..25).prop_flat_map(|n| matrices(n, 2))) {
        sparse(entries.len().isqrt(), &entries);
    }
}
