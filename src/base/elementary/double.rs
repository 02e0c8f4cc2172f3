//! Sums and products of two numbers with their rounding errors, without fused multiply-add: the
//! building blocks of double-double arithmetic (Dekker, Numerische Mathematik 18 (1971); Knuth,
//! The Art of Computer Programming 2, §4.2.2).

/// A number of about 106 bits: `high` is the sum rounded to 53 bits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Double {
    pub(super) high: f64,
    pub(super) low: f64,
}

/// Upper bits of a factor that fit in 26 bits, by Veltkamp; exact below 2⁹⁹⁵.
const fn upper(x: f64) -> f64 {
    let shifted = 134_217_729.0 * x;
    shifted - (shifted - x)
}

impl Double {
    pub(super) const fn new(high: f64, low: f64) -> Double {
        Double { high, low }
    }

    /// `a + b`, exactly.
    pub(super) const fn sum(a: f64, b: f64) -> Double {
        let high = a + b;
        let part = high - a;
        Double { high, low: (a - (high - part)) + (b - part) }
    }

    /// `a + b`, exactly, for `|a| ≥ |b|` or `a = 0`.
    pub(super) const fn ordered_sum(a: f64, b: f64) -> Double {
        let high = a + b;
        Double { high, low: b - (high - a) }
    }

    /// `a b`, exactly, unless it leaves the range of normal numbers.
    pub(super) const fn product(a: f64, b: f64) -> Double {
        let high = a * b;
        let (a1, b1) = (upper(a), upper(b));
        let (a2, b2) = (a - a1, b - b1);
        Double { high, low: a2 * b2 - (((high - a1 * b1) - a2 * b1) - a1 * b2) }
    }

    pub(super) const fn add(self, other: Double) -> Double {
        let (high, low) = (Double::sum(self.high, other.high), Double::sum(self.low, other.low));
        let all = Double::ordered_sum(high.high, high.low + low.high);
        Double::ordered_sum(all.high, all.low + low.low)
    }

    pub(super) const fn mul(self, other: Double) -> Double {
        let product = Double::product(self.high, other.high);
        let mixed = self.high * other.low + self.low * other.high;
        Double::ordered_sum(product.high, product.low + mixed)
    }

    /// The quotient by a number.
    pub(super) const fn over(self, divisor: f64) -> Double {
        let quotient = self.high / divisor;
        let product = Double::product(quotient, divisor);
        let rest = ((self.high - product.high) - product.low) + self.low;
        Double::ordered_sum(quotient, rest / divisor)
    }
}
