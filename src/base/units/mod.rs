//! Units of measurement (MLS §3.7, ch. 19; SI brochure): what they measure, how they convert, and
//! how laboratories write them.

mod definitions;
mod dimension;
mod parse;
mod written;

use crate::elementary;
use std::f64::consts::PI;

pub use definitions::Definitions;
pub use dimension::Dimension;
pub use parse::{dimension, unit};
pub use written::{in_words, normalized, suggested, written};

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

    /// How values in this unit become values in `other`; `None` where they measure something else, and
    /// where one counts revolutions and the other may count radians ([`Unit::angles_differ`]).
    pub fn to(self, other: Unit) -> Option<Conversion> {
        if self.dimension != other.dimension {
            return None;
        }
        let factor = match self.angles(other) {
            Angles::Same => self.factor / other.factor,
            Angles::Counted => self.of_counts() / other.of_counts(),
            Angles::Unclear => return None,
        };
        // Computed from the larger to the smaller, so that decimal factors stay exact: 1/1000 is the
        // nearest number to 1e-3, 1e-3/1 too, but 1e-6/1e-3 is not.
        let factor = rounded(factor);
        Some(Conversion { factor, offset: (self.offset - other.offset) / other.factor })
    }

    /// Where units of one dimension cannot be converted, because one counts revolutions or cycles and the
    /// other radians, as Hz and rad/s do: the factors if the values count radians, and if they count
    /// revolutions.
    pub fn angles_differ(self, other: Unit) -> Option<[f64; 2]> {
        if self.dimension != other.dimension || self.angles(other) != Angles::Unclear {
            return None;
        }
        let radians = self.factor / other.factor;
        let excess = self.dimension.of_angles()?[0] - other.dimension.of_angles()?[0];
        let revolutions = radians * elementary::powi(2.0 * PI, -excess);
        Some([radians, revolutions].map(rounded))
    }

    /// How the angles in two units of one dimension compare.
    fn angles(self, other: Unit) -> Angles {
        let (Some(own), Some(others)) = (self.dimension.of_angles(), other.dimension.of_angles())
        else {
            return Angles::Same;
        };
        let [[radians, revolutions], [other_radians, other_revolutions]] = [own, others];
        let has_revolutions = revolutions != 0 || other_revolutions != 0;
        if radians == other_radians {
            return Angles::Same;
        }
        let is_first = radians != 0;
        let [with, without] = if is_first { [own, others] } else { [others, own] };
        // The speed of a shaft in 1/min counts revolutions, a decay rate does not; 1/s is also what the
        // SI has for rad/s.
        let is_coherent = if is_first { other.factor } else { self.factor } == 1.0;
        let is_rate = self.dimension == Unit::per_second() && !is_coherent;
        let is_count = self.dimension == Dimension::ONE || self.dimension == Unit::per_second();
        match () {
            () if is_count && without[0] == 0 && with == [1, 1] => Angles::Counted,
            () if has_revolutions || is_rate => Angles::Unclear,
            () => Angles::Same,
        }
    }

    /// The dimension of rates.
    const fn per_second() -> Dimension {
        Dimension::new([0, 0, -1, 0, 0, 0, 0, 0])
    }

    /// The factor of a unit of angle, or of its rate, where a revolution is the number 1.
    fn of_counts(self) -> f64 {
        match self.dimension.of_angles() {
            Some([1, 1]) => self.factor / (2.0 * PI),
            _ => self.factor,
        }
    }
}

/// How angles in two units compare.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Angles {
    /// A radian is 1 in both.
    Same,
    /// One is of revolutions, the other a number of them: a revolution is 1.
    Counted,
    /// A revolution may be 1 or 2 pi.
    Unclear,
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
            (60.0, "rpm", "rad/s", 2.0 * PI),
            (3000.0, "ppm", "%", 0.3),
            (3000.0, "ppmv", "1", 0.003),
            (7.0, "ppb", "ppm", 0.007),
            (20.0, "‰", "1", 0.02),
            (3000.0, "rpm", "Hz", 50.0),
            (3000.0, "rpm", "1/min", 3000.0),
            (3000.0, "rev/min", "1/s", 50.0),
            (50.0, "Hz", "rpm", 3000.0),
            (50.0, "1/s", "rev/min", 3000.0),
            (50.0, "kHz", "1/s", 50_000.0),
            (2.0, "rev", "rad", 4.0 * PI),
            (2.0, "rev", "1", 2.0),
            (2.0, "rad/s", "1/s", 2.0),
            (180.0, "deg/s", "1/s", PI),
            (180.0, "deg", "1", PI),
            (3.0, "N.m/rad", "N.m", 3.0),
        ] {
            let found = convert(value, from, to).unwrap_or(f64::NAN);
            let tolerance = 1e-15 * expected.abs();
            assert!((found - expected).abs() <= tolerance, "{value} {from} = {found} {to}");
        }
        for (from, to) in [("Hz", "rad/s"), ("rad/s", "Hz"), ("1/min", "rad/s"), ("V/rpm", "V.s")] {
            assert_eq!(convert(1.0, from, to), None, "{from} {to}");
        }
        assert_eq!(convert(1.0, "ppm", "kg/m3"), None);
        assert_eq!(convert(1.0, "V", "A"), None);
        assert_eq!(convert(1.0, "bits", "1"), None);
        assert_eq!(convert(0.1 + 0.2, "V", "V"), Some(0.1 + 0.2));
    }

    #[test]
    fn where_revolutions_or_radians_may_be_counted_both_factors_are_known() {
        let factors = |from: &str, to: &str| written(from)?.angles_differ(written(to)?);
        let near = |found: Option<[f64; 2]>, expected: [f64; 2]| {
            found.is_some_and(|found| {
                found.iter().zip(expected).all(|(a, b)| (a - b).abs() <= 1e-14 * b)
            })
        };
        assert!(near(factors("Hz", "rad/s"), [1.0, 2.0 * PI]));
        assert!(near(factors("rad/s", "Hz"), [1.0, 0.5 / PI]));
        assert!(near(factors("1/min", "rad/s"), [1.0 / 60.0, PI / 30.0]));
        assert!(near(factors("V/rpm", "V.s"), [30.0 / PI, 60.0]));
        for (from, to) in [("rpm", "Hz"), ("rad/s", "1/s"), ("Hz", "1/s"), ("Hz", "V")] {
            assert_eq!(factors(from, to), None, "{from} {to}");
        }
    }

    #[test]
    fn names_may_end_in_a_unit() {
        for (name, unit) in [
            ("U_mV", Some("mV")),
            ("time_min", Some("min")),
            ("Elapsed minutes", Some("minutes")),
            ("U", None),
            ("U_old", None),
            ("_mV", None),
        ] {
            assert_eq!(suggested(name), unit, "{name}");
        }
    }
}
