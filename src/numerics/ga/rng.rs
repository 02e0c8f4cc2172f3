//! MRG32k3a, the generator of Arena, with streams and substreams.
//!
//! Two recurrences of order three,
//!
//! ```text
//! xₙ = (1403580 xₙ₋₂ −  810728 xₙ₋₃) mod m₁,   m₁ = 4294967087
//! yₙ = ( 527612 yₙ₋₁ − 1370589 yₙ₋₃) mod m₂,   m₂ = 4294944443
//! ```
//!
//! are combined to u = ((xₙ − yₙ) mod m₁) / (m₁ + 1), where the difference 0 counts as m₁, so that
//! 0 < u < 1. The period is about 2¹⁹¹. Streams start 2¹²⁷ numbers apart, substreams 2⁷⁶.
//!
//! Reference: [L'Ecuyer 1999](gapilib_base::bibliography#lecuyer-1999), streams:
//! [L'Ecuyer, Simard, Chen and Kelton 2002](gapilib_base::bibliography#lecuyer-2002).

use super::errors::BAD_SEED;
use crate::diag::Fault;
use crate::{bail, elementary};
use rand::rand_core::Infallible;
use rand::{SeedableRng, TryRng};

/// Modulus of the first recurrence.
const M1: i64 = 4_294_967_087;
/// Modulus of the second recurrence.
const M2: i64 = 4_294_944_443;
/// 1 / (m₁ + 1)
const NORM: f64 = 2.328306549295728e-10;

/// The remedy for a bad seed.
const USUAL: &str = "use whole numbers such as [12345, 12345, 12345, 12345, 12345, 12345], or \
                     `Seed_Next` of the previous call";

type Matrix = [[u64; 3]; 3];

/// The first recurrence 2⁷⁶ steps on.
const A1_SUBSTREAM: Matrix = [
    [82758667, 1871391091, 4127413238],
    [3672831523, 69195019, 1871391091],
    [3672091415, 3528743235, 69195019],
];
/// The second recurrence 2⁷⁶ steps on.
const A2_SUBSTREAM: Matrix = [
    [1511326704, 3759209742, 1610795712],
    [4292754251, 1511326704, 3889917532],
    [3859662829, 4292754251, 3708466080],
];
/// The first recurrence 2¹²⁷ steps on.
const A1_STREAM: Matrix = [
    [2427906178, 3580155704, 949770784],
    [226153695, 1230515664, 3580155704],
    [1988835001, 986791581, 1230515664],
];
/// The second recurrence 2¹²⁷ steps on.
const A2_STREAM: Matrix = [
    [1464411153, 277697599, 1610723613],
    [32183930, 1464411153, 1022607788],
    [2824425944, 32183930, 2093834863],
];

/// The generator that `Ram_Gen_ARENA` uses.
///
/// It also implements rand's generator traits; those draw their bits from the same sequence, but
/// use more than one number for each word, since one number carries a little less than 32 bits.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Mrg32k3a {
    /// xₙ₋₃, xₙ₋₂, xₙ₋₁
    x: [i64; 3],
    /// yₙ₋₃, yₙ₋₂, yₙ₋₁
    y: [i64; 3],
}

impl Mrg32k3a {
    /// The seed that the generator's authors use.
    pub const DEFAULT_SEED: [f64; 6] = [12345.0; 6];

    /// Starts from a seed {x₋₃, x₋₂, x₋₁, y₋₃, y₋₂, y₋₁} of whole numbers.
    ///
    /// # Errors
    ///
    /// `bad-seed` when an entry is not a whole number in its range, or when the three of one
    /// recurrence are all zero; the message names the entry.
    pub fn new(seed: &[f64]) -> Result<Mrg32k3a, Fault> {
        if seed.len() != 6 {
            bail!(BAD_SEED, "a seed has six entries, but this one has \
                             {}", seed.len(); help: "{USUAL}");
        }
        let mut entries = [0_i64; 6];
        for (k, (&value, entry)) in seed.iter().zip(&mut entries).enumerate() {
            let modulus = if k < 3 { M1 } else { M2 };
            if value.fract() != 0.0 || !(0.0..modulus as f64).contains(&value) {
                bail!(
                    BAD_SEED,
                    "entry {} of the seed is {value}, which is not a whole number from 0 to {}",
                    k + 1,
                    modulus - 1;
                    help: "{USUAL}"
                );
            }
            *entry = value as i64;
        }
        let [x3, x2, x1, y3, y2, y1] = entries;
        for (first, part) in [(1, [x3, x2, x1]), (4, [y3, y2, y1])] {
            if part == [0; 3] {
                bail!(BAD_SEED, "entries {first} to {} of the seed are all 0", first + 2; help: "{USUAL}");
            }
        }
        Ok(Mrg32k3a { x: [x3, x2, x1], y: [y3, y2, y1] })
    }

    /// The state in the order of the seed: [`Mrg32k3a::new`] of it continues from here.
    pub fn state(&self) -> [f64; 6] {
        let [x3, x2, x1] = self.x;
        let [y3, y2, y1] = self.y;
        [x3, x2, x1, y3, y2, y1].map(|entry| entry as f64)
    }

    /// The next number, uniform in 0 < u < 1.
    #[inline]
    pub fn uniform(&mut self) -> f64 {
        self.step() as f64 * NORM
    }

    /// A number of the standard normal distribution; takes two uniform numbers.
    pub fn normal(&mut self) -> f64 {
        let (radius, angle) = (self.uniform(), self.uniform());
        (-2.0 * elementary::ln(radius)).sqrt() * elementary::cos(std::f64::consts::TAU * angle)
    }

    /// The generator `count` streams further on, 2¹²⁷ numbers each.
    #[must_use]
    pub fn stream(&self, count: u64) -> Mrg32k3a {
        self.jump(&A1_STREAM, &A2_STREAM, count)
    }

    /// The generator `count` substreams further on, 2⁷⁶ numbers each.
    #[must_use]
    pub fn substream(&self, count: u64) -> Mrg32k3a {
        self.jump(&A1_SUBSTREAM, &A2_SUBSTREAM, count)
    }

    fn jump(&self, a1: &Matrix, a2: &Matrix, count: u64) -> Mrg32k3a {
        Mrg32k3a {
            x: apply(&power(a1, count, M1 as u64), self.x, M1 as u64),
            y: apply(&power(a2, count, M2 as u64), self.y, M2 as u64),
        }
    }

    /// The next number before scaling, uniform in 1..=m₁.
    #[inline]
    fn step(&mut self) -> i64 {
        // The products stay below 2⁵³, far from overflow.
        let x = (1_403_580 * self.x[1] - 810_728 * self.x[0]).rem_euclid(M1);
        self.x = [self.x[1], self.x[2], x];
        let y = (527_612 * self.y[2] - 1_370_589 * self.y[0]).rem_euclid(M2);
        self.y = [self.y[1], self.y[2], y];
        if x > y { x - y } else { x - y + M1 }
    }

    /// Sixteen uniform bits: 2¹⁶ buckets of 65535 numbers, what lies beyond is drawn again.
    fn sixteen_bits(&mut self) -> u32 {
        loop {
            let bucket = (self.step() - 1) / 65_535;
            if bucket < 65_536 {
                return bucket as u32;
            }
        }
    }
}

/// A^count modulo m.
fn power(a: &Matrix, mut count: u64, m: u64) -> Matrix {
    let mut result = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
    let mut base = *a;
    while count > 0 {
        if count & 1 == 1 {
            result = product(&result, &base, m);
        }
        base = product(&base, &base, m);
        count >>= 1;
    }
    result
}

fn product(a: &Matrix, b: &Matrix, m: u64) -> Matrix {
    let entry = |i: usize, j: usize| {
        let sum: u128 = (0..3).map(|k| u128::from(a[i][k]) * u128::from(b[k][j])).sum();
        (sum % u128::from(m)) as u64
    };
    std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j)))
}

fn apply(a: &Matrix, state: [i64; 3], m: u64) -> [i64; 3] {
    std::array::from_fn(|i| {
        let sum: u128 = (0..3).map(|k| u128::from(a[i][k]) * state[k] as u128).sum();
        (sum % u128::from(m)) as i64
    })
}

impl TryRng for Mrg32k3a {
    type Error = Infallible;

    fn try_next_u32(&mut self) -> Result<u32, Infallible> {
        let high = self.sixteen_bits();
        Ok(high << 16 | self.sixteen_bits())
    }

    fn try_next_u64(&mut self) -> Result<u64, Infallible> {
        let high = u64::from(self.try_next_u32()?);
        Ok(high << 32 | u64::from(self.try_next_u32()?))
    }

    fn try_fill_bytes(&mut self, dst: &mut [u8]) -> Result<(), Infallible> {
        for chunk in dst.chunks_mut(4) {
            let word = self.try_next_u32()?.to_le_bytes();
            chunk.copy_from_slice(&word[..chunk.len()]);
        }
        Ok(())
    }
}

impl SeedableRng for Mrg32k3a {
    type Seed = [u8; 24];

    /// Every seed is accepted: the six words are reduced to their ranges, and a recurrence that
    /// would stay at zero starts from 12345.
    fn from_seed(seed: [u8; 24]) -> Mrg32k3a {
        let word = |k: usize| {
            i64::from(u32::from_le_bytes(std::array::from_fn(|byte| seed[4 * k + byte])))
        };
        let part = |first: usize, m: i64| {
            let words: [i64; 3] = std::array::from_fn(|k| word(first + k) % m);
            if words == [0; 3] { [12345; 3] } else { words }
        };
        Mrg32k3a { x: part(0, M1), y: part(3, M2) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{Rng, RngExt};

    fn default() -> Mrg32k3a {
        Mrg32k3a::new(&Mrg32k3a::DEFAULT_SEED).unwrap()
    }

    #[test]
    fn first_numbers_are_those_of_the_reference() {
        let mut rng = default();
        let expected = [
            0.12701112204657714,
            0.3185275653967945,
            0.3091860155832701,
            0.8258468629271136,
            0.2216299157820229,
            0.5333953879182788,
            0.4807742033156181,
            0.3555598794381262,
            0.13598841039594017,
            0.7558522371615436,
        ];
        assert_eq!(expected.map(|_| rng.uniform()), expected);
    }

    #[test]
    fn sums_and_state_are_those_of_the_reference() {
        let mut rng = default();
        let hundred: f64 = (0..100).map(|_| rng.uniform()).sum();
        assert!((hundred - 51.783564702603).abs() < 1e-12, "{hundred}");
        let mut rng = default();
        let million: f64 = (0..1_000_000).map(|_| rng.uniform()).sum();
        assert!((million - 499651.936956864).abs() < 1e-8, "{million}");
        let state = [3019710287, 980764711, 1825656393, 1914879467, 744009118, 211657771];
        assert_eq!(rng.state(), state.map(|entry: i64| entry as f64));
    }

    #[test]
    fn streams_start_where_the_reference_says() {
        let second = [3692455944_u64, 1366884236, 2968912127, 335948734, 4161675175, 475798818];
        let third = [1015873554_u64, 1310354410, 2249465273, 994084013, 2912484720, 3876682925];
        assert_eq!(default().stream(1).state(), second.map(|entry| entry as f64));
        assert_eq!(default().stream(2).state(), third.map(|entry| entry as f64));
        assert_eq!(default().stream(1).stream(1), default().stream(2));
    }

    #[test]
    fn third_stream_and_its_fifth_substream_begin_as_in_the_reference() {
        let mut third = default().stream(2);
        let mut fifth = third.substream(4);
        let begin = [0.7285097861965, 0.9655872822837, 0.9961841304801, 0.1149884161813];
        for expected in begin.into_iter().chain([0.9731454191297]) {
            assert!((third.uniform() - expected).abs() < 1e-12);
        }
        for expected in [0.1734545396358, 0.03286351608942, 0.2643169129682] {
            assert!((fifth.uniform() - expected).abs() < 1e-12);
        }
    }

    #[test]
    fn two_to_the_51_substreams_are_one_stream() {
        assert_eq!(default().substream(1 << 51), default().stream(1));
    }

    #[test]
    fn state_continues_the_sequence() {
        let mut rng = default();
        (0..7).for_each(|_| _ = rng.uniform());
        let mut again = Mrg32k3a::new(&rng.state()).unwrap();
        assert_eq!(rng.uniform(), again.uniform());
    }

    #[test]
    fn bad_seeds_are_refused_by_entry() {
        let message = |seed: [f64; 6]| Mrg32k3a::new(&seed).unwrap_err().message;
        assert!(message([1.0, -1.0, 1.0, 1.0, 1.0, 1.0]).contains("entry 2"));
        assert!(message([1.0, 1.0, 4294967087.0, 1.0, 1.0, 1.0]).contains("entry 3"));
        assert!(message([1.0, 1.0, 1.0, 4294944443.0, 1.0, 1.0]).contains("4294944442"));
        assert!(message([1.0, 1.0, 1.0, 1.0, 0.5, 1.0]).contains("entry 5 of the seed is 0.5"));
        assert!(message([1.0, 1.0, 1.0, 1.0, f64::NAN, 1.0]).contains("entry 5"));
        assert!(message([0.0, 0.0, 0.0, 1.0, 1.0, 1.0]).contains("entries 1 to 3"));
        assert!(message([1.0, 1.0, 1.0, 0.0, 0.0, 0.0]).contains("entries 4 to 6"));
        assert!(Mrg32k3a::new(&[1.0]).unwrap_err().message.contains("six entries"));
        assert!(Mrg32k3a::new(&[4294967086.0, 0.0, 0.0, 4294944442.0, 0.0, 0.0]).is_ok());
    }

    #[test]
    fn serves_as_a_generator_of_rand() {
        let mut rng = default();
        let mean = (0..20_000).map(|_| rng.random::<f64>()).sum::<f64>() / 20_000.0;
        assert!((mean - 0.5).abs() < 0.01, "{mean}");
        assert_ne!(rng.next_u64(), rng.next_u64());
        assert_eq!(Mrg32k3a::from_seed([0; 24]), default());
        let bits = (0..4_000).map(|_| rng.next_u32().count_ones()).sum::<u32>();
        assert!((63_000..65_000).contains(&bits), "{bits}");
    }
}
