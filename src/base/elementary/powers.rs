//! Powers and the length of a vector in the plane.
//!
//! The correctly rounded power of `pxfm` costs seven times the system's, and the step sizes of
//! the integrators need one for every step. Almost always an approximation with an error bound
//! decides the rounding already (the test of Ziv, ACM Transactions on Mathematical Software 17
//! (1991)): logarithm and exponential by tables (Tang, ACM Transactions on Mathematical Software
//! 16 (1990)) in double-double arithmetic, relative error below 2⁻⁵⁹ + 2⁻⁶⁶ |y ln x|. Where the
//! bound leaves the last bit open, `pxfm` answers; both give the same bits.

use super::double::Double;

/// Intervals of a factor 2 in the table of powers of 2.
const STEPS: usize = 128;
/// Bits of a table's upper parts after the point; times a binary exponent they remain exact.
const UPPER: f64 = 4_398_046_511_104.0;
/// First interval of the table of logarithms, [181/256, 182/256); the last begins at 362/256.
const FIRST: usize = 181;
const INTERVALS: usize = 182;
/// Largest |y ln x| of the approximation: the result is a normal number.
const LARGEST: f64 = 700.0;

/// Relative error of the table and polynomial of the exponential, with margin.
const EXP_ERROR: f64 = 1.0 / (1_u64 << 60) as f64;
/// Relative error of the logarithm, with margin.
const LN_ERROR: f64 = EXP_ERROR / 64.0;

/// An interval of the logarithm's argument.
#[derive(Clone, Copy)]
struct Interval {
    /// Nearly the reciprocal of the middle, in 9 bits.
    reciprocal: f64,
    /// `-ln reciprocal`
    logarithm: Double,
}

static INTERVAL: [Interval; INTERVALS] = intervals();
static POWER: [Double; STEPS] = powers();

const LN_2: Double = split(ln(Double::new(2.0, 0.0)), UPPER);
/// ln 2 / 128 in 35 bits and the rest: the upper part times 18 bits is exact.
const STEP: Double = split(ln(Double::new(2.0, 0.0)).over(STEPS as f64), UPPER);

/// `x` to the power `y`, correctly rounded; NaN for a negative `x` and a `y` that is not an
/// integer.
#[must_use]
#[inline]
pub fn powf(x: f64, y: f64) -> f64 {
    if y == 2.0 {
        return x * x;
    }
    if y == 0.0 || x == 1.0 {
        return 1.0;
    }
    if y == 0.5 && x > 0.0 {
        return x.sqrt();
    }
    let sign = match x {
        x if x > 0.0 => 1.0,
        x if x < 0.0 && y.trunc() == y && y.abs() < 1e9 => [1.0, -1.0][(y as i64 & 1) as usize],
        _ => return pxfm::f_pow(x, y),
    };
    match approximate(x.abs(), y) {
        Some(power) => sign * power,
        // There the products of `pxfm` overflow.
        None if y == -0.5 && x > LARGE => pxfm::f_pow(x * SMALL, y) * SMALL.sqrt(),
        None => pxfm::f_pow(x, y),
    }
}

/// The power of a positive number if the approximation decides its rounding.
fn approximate(x: f64, y: f64) -> Option<f64> {
    if !x.is_normal() || !(1e-100..1e100).contains(&y.abs()) {
        return None;
    }
    let logarithm = logarithm(x);
    let product = Double::product(y, logarithm.high);
    let low = y * logarithm.low + product.low;
    let size = product.high.abs();
    if size > LARGEST {
        return None;
    }
    // Adding 1.5 · 2⁵² rounds to the next integer and leaves it in the lowest bits.
    const ROUNDING: f64 = 6_755_399_441_055_744.0;
    let shifted = product.high * (STEPS as f64 / std::f64::consts::LN_2) + ROUNDING;
    let count = shifted - ROUNDING;
    let at = count as i64;
    let t = Double::sum(product.high - count * STEP.high, low - count * STEP.low);
    let (u, v) = (t.high, t.high * t.high);
    let rest =
        v * ((0.5 + u * (1.0 / 6.0)) + v * ((1.0 / 24.0 + u * (1.0 / 120.0)) + v * (1.0 / 720.0)));
    let power = POWER[at.rem_euclid(STEPS as i64) as usize];
    let low = power.high * u + (power.high * (rest + t.low) + power.low);
    let error = power.high * (EXP_ERROR + LN_ERROR * size);
    let result = power.high + (low + error);
    let exponent = at.div_euclid(STEPS as i64);
    let scale = f64::from_bits(((1023 + exponent) as u64) << 52);
    (result == power.high + (low - error)).then_some(result * scale)
}

/// ln x of a positive normal number.
fn logarithm(x: f64) -> Double {
    const MANTISSA: u64 = (1 << 52) - 1;
    // 2 √½ in the mantissa: above it the argument is halved, so that it lies around 1.
    const ROOT: u64 = 0x6_a09e_667f_3bcd;
    let bits = x.to_bits();
    let halved = u64::from(bits & MANTISSA >= ROOT);
    let exponent = ((bits >> 52) + halved) as i64 - 1023;
    let mantissa = bits & MANTISSA | (1023 - halved) << 52;
    let t = f64::from_bits(mantissa);
    let interval = &INTERVAL[(t * 256.0) as usize - FIRST];
    // z = reciprocal · t - 1 with its rounding error, for 27 bits of t times 9 bits are exact.
    let upper = f64::from_bits(mantissa & !((1 << 27) - 1));
    let z =
        Double::ordered_sum(interval.reciprocal * upper - 1.0, interval.reciprocal * (t - upper));
    let (u, square) = (z.high, Double::product(z.high, z.high));
    let (v, k) = (square.high, exponent as f64);
    let rest = u
        * v
        * (((1.0 / 3.0 - u * 0.25) + v * (0.2 - u * (1.0 / 6.0)))
            + v * v * ((1.0 / 7.0 - u * 0.125) + v * (1.0 / 9.0)));
    let table = k * LN_2.high + interval.logarithm.high;
    let first = Double::sum(table, u);
    let second = Double::sum(first.high, -0.5 * v);
    // ln(1 + z + ζ) = ln(1 + z) + ζ (1 - z), to first order.
    let correction = z.low * (1.0 - u);
    let small = (k * LN_2.low + interval.logarithm.low) + correction;
    let low = (first.low + second.low) + (small - 0.5 * square.low) + rest;
    Double::ordered_sum(second.high, low)
}

/// The upper part as a multiple of `1 / bits`, and the rest.
const fn split(x: Double, bits: f64) -> Double {
    let high = (x.high * bits) as i64 as f64 / bits;
    Double::new(high, (x.high - high) + x.low)
}

const fn intervals() -> [Interval; INTERVALS] {
    let mut table = [Interval { reciprocal: 1.0, logarithm: Double::new(0.0, 0.0) }; INTERVALS];
    let mut k = 0;
    while k < INTERVALS {
        let at = FIRST + k;
        // Around 1 the logarithm is that of the argument, without an error of the table.
        if at != 255 && at != 256 {
            let digits = if at < 256 { 256.0 } else { 512.0 };
            let middle = (at as f64 + 0.5) / 256.0;
            let reciprocal = (digits / middle + 0.5) as i64 as f64 / digits;
            let logarithm = ln(Double::new(reciprocal, 0.0));
            let negative = Double::new(-logarithm.high, -logarithm.low);
            table[k] = Interval { reciprocal, logarithm: split(negative, UPPER) };
        }
        k += 1;
    }
    table
}

/// ln x = 2 artanh((x - 1) / (x + 1)), by its series; for the tables.
const fn ln(x: Double) -> Double {
    // The arguments of the tables have few bits: sum and difference are exact.
    let w = Double::new(x.high - 1.0, 0.0).over(x.high + 1.0);
    let square = w.mul(w);
    let (mut power, mut sum, mut n) = (w, w, 3.0);
    while n < 80.0 {
        power = power.mul(square);
        sum = sum.add(power.over(n));
        n += 2.0;
    }
    Double::new(2.0 * sum.high, 2.0 * sum.low)
}

/// 2 to the power k / 128 as e to the power k ln 2 / 128, by its series.
const fn powers() -> [Double; STEPS] {
    let step = ln(Double::new(2.0, 0.0)).over(STEPS as f64);
    let mut table = [Double::new(1.0, 0.0); STEPS];
    let mut k = 1;
    while k < STEPS {
        let x = step.mul(Double::new(k as f64, 0.0));
        let (mut term, mut sum, mut n) = (x, x, 2.0);
        while n < 32.0 {
            term = term.mul(x).over(n);
            sum = sum.add(term);
            n += 1.0;
        }
        table[k] = sum.add(Double::new(1.0, 0.0));
        k += 1;
    }
    table
}

/// `x` to an integer power by repeated squaring; the reciprocal of it for a negative `n`.
///
/// `f64::powi` leaves the order of the multiplications to the compiler, which folds constants
/// with the library of the machine that it runs on.
#[must_use]
#[inline]
pub fn powi(x: f64, n: i32) -> f64 {
    let (mut base, mut left, mut product) = (x, n.unsigned_abs(), 1.0);
    loop {
        if left % 2 == 1 {
            product *= base;
        }
        left /= 2;
        if left == 0 {
            break;
        }
        base *= base;
    }
    if n < 0 { 1.0 / product } else { product }
}

/// √(x² + y²) without overflow or underflow of the squares.
///
/// The root of the sum of squares in double-double arithmetic with one step of Newton's method:
/// the exact value but for about one argument in 2⁴⁰, where the rounding may go either way.
#[must_use]
#[inline]
pub fn hypot(x: f64, y: f64) -> f64 {
    let (large, small) = (x.abs().max(y.abs()), x.abs().min(y.abs()));
    if large.is_infinite() {
        return f64::INFINITY;
    }
    if small <= large * (f64::EPSILON / 8.0) || x.is_nan() || y.is_nan() {
        return x.abs() + y.abs();
    }
    let scale = match large {
        large if large > LARGE => SMALL,
        large if large < 1e-130 => 1.0 / SMALL,
        _ => 1.0,
    };
    let (a, b) = (large * scale, small * scale);
    let sum = Double::product(a, a).add(Double::product(b, b));
    let root = sum.high.sqrt();
    let square = Double::product(root, root);
    let rest = ((sum.high - square.high) - square.low) + sum.low;
    (root + rest / (2.0 * root)) / scale
}

/// Squares of larger numbers may overflow in a part of their computation.
const LARGE: f64 = 1e150;
/// 2⁻⁶⁰⁰
const SMALL: f64 = f64::from_bits((1023 - 600) << 52);
