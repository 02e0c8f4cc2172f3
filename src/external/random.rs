//! `ModelicaRandom_*`: random numbers of [Vigna 2016](crate::bibliography#vigna-2016) and
//! [Vigna 2017](crate::bibliography#vigna-2017).
//!
//! A state is an array of Integers of 32 bits: words of 64 bits, the lower half first. Generators
//! with a hidden state are refused.

use super::Entry;
use super::call::Call;
use crate::diag::Fault;

pub(super) const ENTRIES: &[Entry] = &[
    Entry::pure("ModelicaRandom_xorshift64star", "aAN", xorshift64_star),
    Entry::pure("ModelicaRandom_xorshift128plus", "aAN", xorshift128_plus),
    Entry::pure("ModelicaRandom_xorshift1024star", "aAN", xorshift1024_star),
    Entry::impure("ModelicaRandom_automaticGlobalSeed", "n->n", automatic_global_seed),
];

/// The words of the state, which has `n` Integers.
fn words(call: &Call<'_>, n: usize) -> Result<Vec<u64>, Fault> {
    let state = call.array(0);
    if state.len() != n || call.arguments[1].len() != n {
        return Err(call.fault(format!("the state has {} Integers, not {n}", state.len())));
    }
    let half = |value: f64| u64::from(value as i64 as u32);
    Ok(state.chunks_exact(2).map(|pair| half(pair[0]) | half(pair[1]) << 32).collect())
}

/// Writes the state and the number that these bits stand for.
fn done(call: &mut Call<'_>, words: &[u64], bits: u64) -> Result<(), Fault> {
    let half = |bits: u64| f64::from(bits as u32 as i32);
    for (pair, word) in call.array_mut(1).chunks_exact_mut(2).zip(words) {
        pair.copy_from_slice(&[half(*word), half(word >> 32)]);
    }
    call.set(2, unit(bits));
    Ok(())
}

/// Bits as a number between 0 and 1.
fn unit(bits: u64) -> f64 {
    bits as i64 as f64 * 2f64.powi(-64) + 0.5
}

fn xorshift64_star(call: &mut Call<'_>) -> Result<(), Fault> {
    let mut words = words(call, 2)?;
    let bits = next64(&mut words[0]);
    done(call, &words, bits)
}

fn next64(x: &mut u64) -> u64 {
    *x ^= *x >> 12;
    *x ^= *x << 25;
    *x ^= *x >> 27;
    x.wrapping_mul(2_685_821_657_736_338_717)
}

fn xorshift128_plus(call: &mut Call<'_>) -> Result<(), Fault> {
    let mut words = words(call, 4)?;
    let (mut a, b) = (words[0], words[1]);
    a ^= a << 23;
    words[0] = b;
    words[1] = a ^ b ^ (a >> 17) ^ (b >> 26);
    let bits = words[1].wrapping_add(b);
    done(call, &words, bits)
}

/// Sixteen words and the position of the current one.
fn xorshift1024_star(call: &mut Call<'_>) -> Result<(), Fault> {
    let mut words = words(call, 33)?;
    let position = call.array(0)[32];
    if !(0.0..=15.0).contains(&position) {
        return Err(call.fault(format!("the state has no position {position}")));
    }
    let mut at = position as usize;
    let mut a = words[at];
    at = (at + 1) % 16;
    let mut b = words[at];
    b ^= b << 31;
    b ^= b >> 11;
    a ^= a >> 30;
    words[at] = a ^ b;
    let bits = words[at].wrapping_mul(1_181_783_497_276_652_981);
    call.array_mut(1)[32] = at as f64;
    done(call, &words, bits)
}

fn automatic_global_seed(call: &mut Call<'_>) -> Result<(), Fault> {
    let milliseconds = call.outside.clock()? * 1e3;
    call.give((milliseconds % f64::from(i32::MAX)).floor())
}
