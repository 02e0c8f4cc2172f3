//! Factorizations and integrators against independent implementations: dense LU of the crate faer,
//! BDF of the crate diffsol.

use diffsol::{DenseMatrix, NalgebraLU, NalgebraMat, OdeBuilder, OdeSolverMethod};
use faer::linalg::solvers::{DenseSolveCore, PartialPivLu, Solve};
use gapilib::sim::{
    DaeSystem, DenseLu, Factorization, Failure, OutputGrid, Pattern, Settings, find_integrator,
    simulate,
};
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

/// x' = f(x), with the product of ∂f/∂x and a vector.
struct Standard {
    initial: &'static [f64],
    times: &'static [f64],
    f: fn(&[f64], &mut [f64]),
    product: fn(&[f64], &[f64], &mut [f64]),
    /// Typical sizes: errors of smaller values count as errors of these.
    nominal: &'static [f64],
}

/// Robertson's chemical kinetics (1966).
const ROBERTSON: Standard = Standard {
    initial: &[1.0, 0.0, 0.0],
    times: &[0.4, 4.0, 40.0, 400.0, 4000.0],
    f: |x, out| {
        out[0] = -0.04 * x[0] + 1e4 * x[1] * x[2];
        out[2] = 3e7 * x[1] * x[1];
        out[1] = -out[0] - out[2];
    },
    product: |x, v, out| {
        out[0] = -0.04 * v[0] + 1e4 * (v[1] * x[2] + x[1] * v[2]);
        out[2] = 6e7 * x[1] * v[1];
        out[1] = -out[0] - out[2];
    },
    nominal: &[1.0, 1e-5, 1.0],
};

/// Van der Pol's oscillator, μ = 100, over a relaxation.
const VAN_DER_POL: Standard = Standard {
    initial: &[2.0, 0.0],
    times: &[20.0, 60.0, 90.0, 120.0],
    f: |x, out| {
        out[0] = x[1];
        out[1] = 100.0 * (1.0 - x[0] * x[0]) * x[1] - x[0];
    },
    product: |x, v, out| {
        out[0] = v[1];
        out[1] = 100.0 * ((1.0 - x[0] * x[0]) * v[1] - 2.0 * x[0] * x[1] * v[0]) - v[0];
    },
    nominal: &[1.0, 1e-2],
};

/// HIRES, high irradiance responses of photomorphogenesis (Schäfer 1975).
const HIRES: Standard = Standard {
    initial: &[1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0057],
    times: &[1.0, 10.0, 100.0, 300.0],
    f: |x, out| {
        out[0] = -1.71 * x[0] + 0.43 * x[1] + 8.32 * x[2] + 0.0007;
        out[1] = 1.71 * x[0] - 8.75 * x[1];
        out[2] = -10.03 * x[2] + 0.43 * x[3] + 0.035 * x[4];
        out[3] = 8.32 * x[1] + 1.71 * x[2] - 1.12 * x[3];
        out[4] = -1.745 * x[4] + 0.43 * x[5] + 0.43 * x[6];
        out[5] = -280.0 * x[5] * x[7] + 0.69 * x[3] + 1.71 * x[4] - 0.43 * x[5] + 0.69 * x[6];
        out[6] = 280.0 * x[5] * x[7] - 1.81 * x[6];
        out[7] = -280.0 * x[5] * x[7] + 1.81 * x[6];
    },
    product: |x, v, out| {
        let reaction = 280.0 * (v[5] * x[7] + x[5] * v[7]);
        out[0] = -1.71 * v[0] + 0.43 * v[1] + 8.32 * v[2];
        out[1] = 1.71 * v[0] - 8.75 * v[1];
        out[2] = -10.03 * v[2] + 0.43 * v[3] + 0.035 * v[4];
        out[3] = 8.32 * v[1] + 1.71 * v[2] - 1.12 * v[3];
        out[4] = -1.745 * v[4] + 0.43 * v[5] + 0.43 * v[6];
        out[5] = -reaction + 0.69 * v[3] + 1.71 * v[4] - 0.43 * v[5] + 0.69 * v[6];
        out[6] = reaction - 1.81 * v[6];
        out[7] = -reaction + 1.81 * v[6];
    },
    nominal: &[1e-2, 1e-2, 1e-3, 1e-2, 1e-2, 1e-2, 1e-3, 1e-3],
};

impl Standard {
    /// The states at all times by diffsol's BDF at a fine tolerance.
    fn oracle(&self) -> Vec<Vec<f64>> {
        let (f, product, initial) = (self.f, self.product, self.initial);
        let problem = OdeBuilder::<NalgebraMat<f64>>::new()
            .rtol(1e-10)
            .atol(self.nominal.iter().map(|nominal| 1e-10 * nominal).collect::<Vec<f64>>())
            .rhs_implicit(
                move |x: &[f64], _: &[f64], _: f64, out: &mut [f64]| f(x, out),
                move |x: &[f64], _: &[f64], _: f64, v: &[f64], out: &mut [f64]| product(x, v, out),
            )
            .init(move |_: &[f64], _: f64, x: &mut [f64]| x.copy_from_slice(initial), initial.len())
            .build()
            .unwrap();
        let mut solver = problem.bdf::<NalgebraLU<f64>>().unwrap();
        let (solution, _) = solver.solve_dense(self.times).unwrap();
        let state = |k: usize| (0..initial.len()).map(|i| solution.get_index(i, k)).collect();
        (0..self.times.len()).map(state).collect()
    }
}

/// The same for our integrators, all entries of the Jacobian.
struct System(&'static Standard, Pattern);

impl DaeSystem for System {
    fn n_differential(&self) -> usize {
        self.0.initial.len()
    }

    fn n_algebraic(&self) -> usize {
        0
    }

    fn nominal(&self, out: &mut [f64]) {
        out.copy_from_slice(self.0.nominal);
    }

    fn rhs(&mut self, _: f64, y: &[f64], out: &mut [f64]) -> Result<(), Failure> {
        (self.0.f)(y, out);
        Ok(())
    }

    fn pattern(&self) -> &Pattern {
        &self.1
    }

    fn jacobian(&mut self, _: f64, y: &[f64], out: &mut [f64]) -> Result<(), Failure> {
        for (j, column) in out.chunks_exact_mut(y.len()).enumerate() {
            let mut unit = vec![0.0; y.len()];
            unit[j] = 1.0;
            (self.0.product)(y, &unit, column);
        }
        Ok(())
    }

    fn initialize(&mut self, _: f64, y: &mut [f64]) -> Result<(), Failure> {
        y.copy_from_slice(self.0.initial);
        Ok(())
    }

    fn n_observed(&self) -> usize {
        self.0.initial.len()
    }

    fn observe(&mut self, _: f64, y: &[f64], out: &mut [f64]) -> Result<(), Failure> {
        out.copy_from_slice(y);
        Ok(())
    }
}

/// The largest difference of a method from the oracle, relative to the values or their typical sizes.
fn difference(standard: &'static Standard, oracle: &[Vec<f64>], method: &str) -> f64 {
    let n = standard.initial.len();
    let pattern = Pattern {
        n,
        column_starts: (0..=n).map(|j| j * n).collect(),
        rows: (0..n).flat_map(|_| 0..n).collect(),
    };
    let settings = Settings {
        stop: *standard.times.last().unwrap(),
        output: OutputGrid::At(standard.times.to_vec()),
        tolerance: 1e-8,
        method: find_integrator(method).unwrap(),
        ..Settings::default()
    };
    let (trajectory, _) = simulate(&mut System(standard, pattern), &settings).unwrap();
    let states = standard.times.iter().zip(oracle);
    largest(states.flat_map(|(t, expected)| {
        let found = (0..n).map(|i| trajectory.at(i, *t).unwrap()).collect::<Vec<f64>>();
        let one = |i: usize| (found[i] - expected[i]) / expected[i].abs().max(standard.nominal[i]);
        (0..n).map(one).collect::<Vec<f64>>()
    }))
}

fn agrees(standard: &'static Standard, methods: &[&str], allowed: f64) {
    let oracle = standard.oracle();
    for method in methods {
        let found = difference(standard, &oracle, method);
        assert!(found <= allowed, "{method} differs by {found:e} from diffsol");
    }
}

/// The errors allowed are about three times those found: the tolerance is one of each step.
#[test]
fn robertsons_kinetics_are_those_of_diffsol() {
    agrees(&ROBERTSON, &["dassl", "rodas4", "radau"], 1e-6);
}

#[test]
fn van_der_pols_oscillator_is_that_of_diffsol() {
    agrees(&VAN_DER_POL, &["dassl", "rodas4", "radau", "dopri5"], 1e-5);
}

#[test]
fn hires_is_that_of_diffsol() {
    agrees(&HIRES, &["dassl", "rodas4", "radau", "dopri5"], 1e-6);
}
