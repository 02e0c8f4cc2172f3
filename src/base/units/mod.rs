//! Units of measurement (MLS §3.7, ch. 19; SI brochure): what they measure, how they convert, and
//! how laboratories write them.

mod definitions;
mod dimension;
mod parse;
mod written;

use crate::elementary;
pub use definitions::Definitions;
pub use dimension::Dimension;
pub use parse::{dimension, unit};
pub use written::{in_words, normalized, written};

/// A unit: `value * factor + offset` is the value in coherent SI units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unit {
    /// What it measures.
    pub dimension: Dimension,
    /// How many of the coherent SI unit it is.
    pub factor: f64,
    /// Zero of its scale in coherent SI units; 0 but for temperatures.
    pub offset: f64,
}

/// A change from one unit to another: `value * factor + offset`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Conversion {
    /// The factor.
    pub factor: f64,
    /// What is added afterwards.
    pub offset: f64,
}

impl Unit {
    /// That of a pure number.
    pub(crate) const ONE: Unit = Unit { dimension: Dimension::ONE, factor: 1.0, offset: 0.0 };

    /// The second.
    pub const SECOND: Unit =
        Unit { dimension: Dimension::new([0, 0, 1, 0, 0, 0, 0, 0]), factor: 1.0, offset: 0.0 };

    /// The unit of a product.
    fn times(self, other: Unit) -> Option<Unit> {
        let dimension = self.dimension.times(other.dimension)?;
        Some(Unit { dimension, factor: self.factor * other.factor, offset: 0.0 })
    }

    /// The unit of a quotient.
    fn over(self, other: Unit) -> Option<Unit> {
        let dimension = self.dimension.over(other.dimension)?;
        Some(Unit { dimension, factor: self.factor / other.factor, offset: 0.0 })
    }

    /// The unit of a power.
    fn power(self, exponent: f64) -> Option<Unit> {
        let dimension = self.dimension.power(exponent)?;
        // Powers of whole numbers by `powi` keep 1e-2^2 at 1e-4.
        let factor = elementary::powi(self.factor, exponent as i32);
        Some(Unit { dimension, factor, offset: 0.0 })
    }

    /// Whether two units are the same but for this part of their factors and zeros.
    fn is_near(self, other: Unit, part: f64) -> bool {
        let near = |a: f64, b: f64| (a - b).abs() <= part * a.abs().max(b.abs());
        let is_same = near(self.factor, other.factor) && near(self.offset, other.offset);
        self.dimension == other.dimension && is_same
    }

    /// For a message: `100000 kg/(m.s2)`, `1 K from 273.15 K on`.
    fn in_words(self) -> String {
        let Unit { dimension, factor, offset } = self;
        let zero = match offset == 0.0 {
            true => String::new(),
            false => format!(" from {offset} {dimension} on"),
        };
        format!("{factor} {dimension}{zero}")
    }

    /// How values in this unit become values in `other`; `None` where they measure something else.
    pub fn to(self, other: Unit) -> Option<Conversion> {
        if self.dimension != other.dimension {
            return None;
        }
        // Computed from the larger to the smaller, so that decimal factors stay exact: 1/1000 is the
        // nearest number to 1e-3, 1e-3/1 too, but 1e-6/1e-3 is not.
        let factor = rounded(self.factor / other.factor);
        Some(Conversion { factor, offset: (self.offset - other.offset) / other.factor })
    }
}

impl Conversion {
    /// That of differences of values, in which the zeros of the scales cancel.
    pub fn of_differences(self) -> Conversion {
        Conversion { offset: 0.0, ..self }
    }

    /// What is done with a value, as the end of a sentence: `, times 0.001, plus 273.15`.
    pub fn in_words(self) -> String {
        let part = |word: &str, value: f64, neutral: f64| match value == neutral {
            true => String::new(),
            false => format!(", {word} {value}"),
        };
        part("times", self.factor, 1.0) + &part("plus", self.offset, 0.0)
    }

    /// Whether nothing changes.
    pub fn is_identity(self) -> bool {
        self.factor == 1.0 && self.offset == 0.0
    }

    /// The value in the other unit.
    pub fn apply(self, value: f64) -> f64 {
        // A product with 1e-3 is one unit in the last place off what is written, a division is not.
        let inverse = 1.0 / self.factor;
        let scaled = if self.factor < 1.0 && inverse.fract() == 0.0 && inverse <= 1e15 {
            value / inverse
        } else {
            value * self.factor
        };
        scaled + self.offset
    }
}

/// The nearest number with 15 decimal digits: quotients of decimal factors such as `1e-4/1e-1` are
/// off in the last bit only.
fn rounded(factor: f64) -> f64 {
    let decimal = format!("{factor:.14e}").parse().unwrap_or(factor);
    if (decimal - factor).abs() <= 4.0 * f64::EPSILON * factor.abs() { decimal } else { factor }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn convert(value: f64, from: &str, to: &str) -> Option<f64> {
        let (from, to) = (written(from)?, written(to)?);
        from.to(to).map(|conversion| conversion.apply(value))
    }

    #[test]
    fn values_are_converted() {
        for (value, from, to, expected) in [
            (75.25, "mA", "A", 0.07525),
            (12.5, "mA/cm²", "A/cm2", 0.0125),
            (12.5, "mA cm^-2", "A/m2", 125.0),
            (25.0, "°C", "K", 298.15),
            (298.15, "K", "degC", 25.0),
            (212.0, "°F", "K", 373.15),
            (1.5, "min", "s", 90.0),
            (2.0, "h", "min", 120.0),
            (1013.25, "mbar", "Pa", 101_325.0),
            (50.0, "%", "1", 0.5),
            (3.0, "l/min", "m3/s", 5e-5),
            (4.0, "W/m²/K", "W/(m2.K)", 4.0),
            (7.0, "kΩ", "Ohm", 7000.0),
            (8.0, "µs", "s", 8e-6),
            (1.0, "kWh", "J", 3.6e6),
            (60.0, "rpm", "rad/s", 2.0 * std::f64::consts::PI),
        ] {
            let found = convert(value, from, to).unwrap_or(f64::NAN);
            let tolerance = 1e-15 * expected.abs();
            assert!((found - expected).abs() <= tolerance, "{value} {from} = {found} {to}");
        }
        assert_eq!(convert(1.0, "V", "A"), None);
        assert_eq!(convert(1.0, "bits", "1"), None);
        assert_eq!(convert(0.1 + 0.2, "V", "V"), Some(0.1 + 0.2));
    }
}
