//! `ModelicaRandom_*`: random numbers of [Vigna 2016](gapilib_base::bibliography#vigna-2016) and
//! [Vigna 2017](gapilib_base::bibliography#vigna-2017).
//!
//! A state is an array of Integers of 32 bits: words of 64 bits, the lower half first. As the
//! standard library defines them, xorshift64* and xorshift128+ continue from the number that they
//! returned, where their author continues from the word before it is scrambled. The hidden state is
//! that of one generator xorshift1024*, [`Random`](super::Random).

use super::Entry;
use super::call::Call;
use super::xorshift::Xorshift1024;
use crate::diag::Fault;
use crate::elementary;

pub(crate) const ENTRIES: &[Entry] = &[
    Entry::pure("ModelicaRandom_xorshift64star", "aAN", xorshift64_star),
    Entry::pure("ModelicaRandom_xorshift128plus", "aAN", xorshift128_plus),
    Entry::pure("ModelicaRandom_xorshift1024star", "aAN", xorshift1024_star),
    Entry::pure("ModelicaRandom_convertRealToIntegers", "nA", real_to_integers),
    Entry::pure("ModelicaRandom_automaticGlobalSeed", "n->n", automatic_global_seed),
    Entry::stateful("ModelicaRandom_setInternalState_xorshift1024star", "ann", set_state),
    Entry::stateful("ModelicaRandom_impureRandom_xorshift1024star", "n->n", impure_random),
];

/// The seed that is chosen where the user leaves the choice: always the same, so that a run can be
/// repeated.
const AUTOMATIC_SEED: f64 = 1_873_659_421.0;

/// The words of the state, which has `n` Integers.
fn words(call: &Call<'_>, n: usize) -> Result<Vec<u64>, Fault> {
    let state = call.array(0);
    if state.len() != n {
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
    bits as i64 as f64 * elementary::powi(2f64, -64) + 0.5
}

fn xorshift64_star(call: &mut Call<'_>) -> Result<(), Fault> {
    let mut words = words(call, 2)?;
    let mut x = words[0];
    x ^= x >> 12;
    x ^= x << 25;
    x ^= x >> 27;
    words[0] = x.wrapping_mul(2_685_821_657_736_338_717);
    let bits = words[0];
    done(call, &words, bits)
}

fn xorshift128_plus(call: &mut Call<'_>) -> Result<(), Fault> {
    let mut words = words(call, 4)?;
    let (mut a, b) = (words[0], words[1]);
    a ^= a << 23;
    words[0] = b;
    words[1] = (a ^ b ^ (a >> 17) ^ (b >> 26)).wrapping_add(b);
    let bits = words[1];
    done(call, &words, bits)
}

/// The generator from the 33 Integers of an argument.
fn generator(call: &Call<'_>) -> Result<Xorshift1024, Fault> {
    let words = words(call, 33)?;
    let position = call.array(0)[32];
    match <[u64; 16]>::try_from(words) {
        // An initial state has any Integer there, of which the last four bits count.
        Ok(words) if position.is_finite() => {
            Ok(Xorshift1024 { words, at: (position as i64 & 15) as usize })
        }
        _ => Err(call.fault(format!("the state has no position {position}"))),
    }
}

fn xorshift1024_star(call: &mut Call<'_>) -> Result<(), Fault> {
    if call.arguments[1].len() != 33 {
        return Err(call.fault("the new state has not 33 Integers"));
    }
    let mut state = generator(call)?;
    let bits = state.next();
    call.array_mut(1)[32] = state.at as f64;
    done(call, &state.words, bits)
}

/// `(x, y)`: the halves of the 64 bits of a Real, the lower one first.
fn real_to_integers(call: &mut Call<'_>) -> Result<(), Fault> {
    let bits = call.number(0).to_bits();
    let half = |bits: u64| f64::from(bits as u32 as i32);
    match call.array_mut(1) {
        [low, high] => {
            (*low, *high) = (half(bits), half(bits >> 32));
            Ok(())
        }
        other => {
            let n = other.len();
            Err(call.fault(format!("two Integers are written, not {n}")))
        }
    }
}

fn automatic_global_seed(call: &mut Call<'_>) -> Result<(), Fault> {
    call.give(AUTOMATIC_SEED)
}

/// `(state, size, id)`
fn set_state(call: &mut Call<'_>) -> Result<(), Fault> {
    let (state, id) = (generator(call)?, call.number(2));
    call.outside.random()?.0 = Some((state, id));
    Ok(())
}

/// `(id)`
fn impure_random(call: &mut Call<'_>) -> Result<(), Fault> {
    let requested = call.number(0);
    let bits = match &mut call.outside.random()?.0 {
        Some((state, id)) if *id == requested => Some(state.next()),
        _ => None,
    };
    match bits {
        Some(bits) => call.give(unit(bits)),
        None => {
            Err(call.fault("`initializeImpureRandom` was not called before, or with another id"))
        }
    }
}
