//! Tests of the factorizations.

use super::*;
use proptest::prelude::*;

/// A matrix by columns with its pattern; structurally nonsingular, entries of mixed size.
fn sparse_matrix(n: usize) -> impl Strategy<Value = (Pattern, Vec<f64>)> {
    let entry = (0..n, 0..n, -1.0f64..1.0);
    (prop::collection::vec(entry, 0..3 * n), 0..n, prop::collection::vec(0.5f64..2.0, n)).prop_map(
        move |(entries, shift, diagonal)| {
            let mut table = vec![vec![None; n]; n];
            for (i, j, value) in entries {
                table[j][i] = Some(value * 0.3);
            }
            for (j, value) in diagonal.into_iter().enumerate() {
                table[j][(j + shift) % n] = Some(value);
            }
            let (mut pattern, mut values) = (Pattern { n, ..Pattern::default() }, Vec::new());
            pattern.column_starts.push(0);
            for column in table {
                for (i, value) in column.into_iter().enumerate() {
                    if let Some(value) = value {
                        pattern.rows.push(i);
                        values.push(value);
                    }
                }
                pattern.column_starts.push(values.len());
            }
            (pattern, values)
        },
    )
}

fn product(pattern: &Pattern, values: &[f64], x: &[f64]) -> Vec<f64> {
    let mut b = vec![0.0; pattern.n];
    for (j, x) in x.iter().enumerate() {
        for position in pattern.column(j) {
            b[pattern.rows[position]] += values[position] * x;
        }
    }
    b
}

/// Residual of the computed solution of A x = b.
fn residual(factors: &mut Factorization, pattern: &Pattern, values: &[f64]) -> Option<f64> {
    let b: Vec<f64> = (0..pattern.n).map(|i| (i as f64).sin() + 1.0).collect();
    factors.factorize(values).ok()?;
    let mut x = b.clone();
    factors.solve(&mut x);
    let scale = x.iter().fold(1.0, |m: f64, x| m.max(x.abs()));
    let ax = product(pattern, values, &x);
    Some(ax.iter().zip(&b).map(|(l, r)| (l - r).abs()).fold(0.0, f64::max) / scale)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn sparse_factors_solve((pattern, values) in sparse_matrix(30), factor in 0.5f64..2.0) {
        let mut sparse = Factorization::Sparse(Box::new(SparseLu::new(&pattern, &[])));
        let mut dense = Factorization::Dense(DenseMatrix::new(&pattern));
        let by_dense = residual(&mut dense, &pattern, &values);
        if let Some(residual) = residual(&mut sparse, &pattern, &values) {
            prop_assert!(residual < 1e-9, "{residual}");
        } else {
            prop_assert!(by_dense.is_none_or(|residual| residual > 1e-9));
        }
        // Other values, same pivots unless they became bad.
        let changed: Vec<f64> =
            values.iter().enumerate().map(|(i, v)| v * (1.0 + factor * (i as f64).cos())).collect();
        if let Some(residual) = residual(&mut sparse, &pattern, &changed) {
            prop_assert!(residual < 1e-8, "{residual}");
        }
    }

    /// Machine code and loops are one algorithm, to the bit, also where pivots fail.
    #[test]
    #[cfg(feature = "jit")]
    fn code_without_loops_gives_the_same_bits(
        (pattern, values) in sparse_matrix(40),
        coupled in prop::collection::btree_set(0usize..40, 0..5),
        factor in 0.5f64..2.0,
    ) {
        let coupled: Vec<usize> = coupled.into_iter().collect();
        let mut loops = SparseLu::new(&pattern, &coupled);
        // Finds the pivots.
        let _ = loops.factorize(&values);
        let mut code = loops.clone();
        code.translate();
        for number in 0..3 {
            let scaled = |(i, v): (usize, &f64)| v * (1.0 + factor * ((number * i) as f64).cos());
            let values: Vec<f64> = values.iter().enumerate().map(scaled).collect();
            loops.forget();
            code.forget();
            prop_assert_eq!(loops.factorize(&values), code.factorize(&values));
            let (mut a, mut b) = (vec![0.7; 40], vec![0.7; 40]);
            loops.solve(&mut a);
            code.solve(&mut b);
            let bits = |x: &[f64]| x.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
            prop_assert_eq!(bits(&a), bits(&b));
            // So do several right-hand sides at once.
            let right: Vec<f64> = (0..40 * 11).map(|i| (i as f64).sin()).collect();
            let mut one_by_one = right.clone();
            one_by_one.chunks_exact_mut(40).for_each(|b| loops.solve(b));
            for factors in [&mut loops, &mut code] {
                let mut all = right.clone();
                factors.solve_all(&mut all);
                prop_assert_eq!(bits(&all), bits(&one_by_one));
            }
        }
    }

    #[test]
    fn dense_factors_solve((pattern, values) in sparse_matrix(8)) {
        let mut dense = Factorization::new(&pattern, &[]);
        prop_assert!(matches!(dense, Factorization::Dense(_)));
        if let Some(residual) = residual(&mut dense, &pattern, &values) {
            prop_assert!(residual < 1e-10, "{residual}");
        }
    }
}

#[test]
fn a_tridiagonal_matrix_has_no_fill() {
    let n = 1000;
    let mut pattern = Pattern { n, column_starts: vec![0], rows: Vec::new() };
    let mut values = Vec::new();
    for j in 0..n {
        for i in j.saturating_sub(1)..(j + 2).min(n) {
            pattern.rows.push(i);
            values.push(if i == j { 2.0 } else { -1.0 });
        }
        pattern.column_starts.push(values.len());
    }
    let mut factors = Factorization::new(&pattern, &[]);
    let Factorization::Sparse(lu) = &mut factors else { panic!("a large sparse matrix is sparse") };
    lu.factorize(&values).unwrap();
    assert_eq!(lu.nonzeros(), n + 2 * (n - 1));
    assert!(residual(&mut factors, &pattern, &values).unwrap() < 1e-9);
}

#[test]
fn singular_matrices_are_refused() {
    for n in [2, 40] {
        // The last column is zero.
        let mut pattern =
            Pattern { n, column_starts: (0..n).collect(), rows: (0..n - 1).collect() };
        pattern.column_starts.push(n - 1);
        let mut factors = Factorization::new(&pattern, &[]);
        assert_eq!(factors.factorize(&vec![1.0; n - 1]), Err(SingularMatrix));
    }
    let pattern = Pattern { n: 1, column_starts: vec![0, 1], rows: vec![0] };
    let mut factors = Factorization::new(&pattern, &[]);
    assert_eq!(factors.factorize(&[f64::NAN]), Err(SingularMatrix));
    assert_eq!(factors.factorize(&[2.0]), Ok(()));
}
