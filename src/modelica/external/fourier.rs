//! `ModelicaFFT_*`: the discrete Fourier transform of real signals.
//!
//! Xₖ = Σ uₘ exp(−2πi k m / n) by splitting n into its prime factors ([Cooley & Tukey
//! 1965](gapilib_base::bibliography#cooley-tukey-1965)).

use super::Entry;
use super::call::Call;
use super::schur::modulus;
use crate::diag::Fault;
use crate::elementary;
use nalgebra::Complex;
use std::f64::consts::TAU;

pub(crate) const ENTRIES: &[Entry] =
    &[Entry::pure("ModelicaFFT_kiss_fftr", "anAnAA->n", real_transform)];

/// `(u, n, work, nWork, amplitudes, phases)`; the amplitudes are |Xₖ|/(n/2 + 1), as in the standard
/// library. Results: 0 done, 1 the number of values is odd, 2 the workspace has another size.
fn real_transform(call: &mut Call<'_>) -> Result<(), Fault> {
    let signal: Vec<Complex<f64>> = call.array(0).iter().map(|u| Complex::new(*u, 0.0)).collect();
    let n = signal.len();
    if n == 0 || !n.is_multiple_of(2) {
        return call.give(1.0);
    }
    let frequencies = n / 2 + 1;
    if call.array(2).len() < 3 * n + 2 * frequencies {
        return call.give(2.0);
    }
    if call.array(4).len() != frequencies || call.array(5).len() != frequencies {
        return Err(call.fault(format!("amplitudes and phases need {frequencies} elements")));
    }
    let mut transformed = vec![Complex::new(0.0, 0.0); n];
    transform(&signal, 1, &mut transformed);
    // Both are real for a real signal; what rounding leaves would decide the sign of their phases.
    transformed[0].im = 0.0;
    transformed[n / 2].im = 0.0;
    for (k, x) in transformed[..frequencies].iter().enumerate() {
        call.array_mut(4)[k] = modulus(*x) / frequencies as f64;
        call.array_mut(5)[k] = elementary::atan2(x.im, x.re);
    }
    call.give(0.0)
}

/// The transform of every `stride`-th value of `signal`, as many as `out` has room for.
fn transform(signal: &[Complex<f64>], stride: usize, out: &mut [Complex<f64>]) {
    let n = out.len();
    let Some(p) = (2..=n).find(|p| n.is_multiple_of(*p)) else {
        out[0] = signal[0];
        return;
    };
    let m = n / p;
    for (part, out) in out.chunks_mut(m).enumerate() {
        transform(&signal[part * stride..], stride * p, out);
    }
    let turn = |k: usize| {
        let angle = -TAU * (k % n) as f64 / n as f64;
        Complex::new(elementary::cos(angle), elementary::sin(angle))
    };
    let mut parts = vec![Complex::new(0.0, 0.0); p];
    for k in 0..m {
        for (part, value) in parts.iter_mut().enumerate() {
            *value = out[part * m + k] * turn(part * k);
        }
        for q in 0..p {
            // A factor of one turn in `p` is `m` of `n`.
            let terms = parts.iter().enumerate().map(|(part, value)| value * turn(part * q * m));
            out[q * m + k] = terms.sum();
        }
    }
}
