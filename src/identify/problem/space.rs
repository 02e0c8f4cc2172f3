//! The search space: free parameters with their ranges, as genes of the unit cube and back.

use crate::diag::Fault;
use crate::ga::Gene;
use crate::ga::errors::BAD_RANGE;
use crate::{bail, elementary};

/// A positive range wider than this ratio is searched on a logarithmic scale by default.
const DECADE: f64 = 10.0;

/// A parameter to identify.
#[derive(Debug, Clone, PartialEq)]
pub struct Free {
    /// Its name; after `@` that of the only experiment in which it holds.
    pub name: String,
    /// Its unit; empty where the model gives none.
    pub unit: String,
    /// Smallest value searched.
    pub min: f64,
    /// Largest value searched, above `min`.
    pub max: f64,
    /// Whether its logarithm is searched.
    pub logarithmic: bool,
    /// A value to begin with, if known.
    pub start: Option<f64>,
}

impl Free {
    /// A parameter with a checked range. `logarithmic`: `None` chooses by the range.
    ///
    /// # Errors
    ///
    /// `bad-range`: an empty or infinite range, a logarithmic one that is not positive, a start
    /// outside.
    pub fn new(
        name: impl Into<String>,
        unit: impl Into<String>,
        [min, max]: [f64; 2],
        logarithmic: Option<bool>,
        start: Option<f64>,
    ) -> Result<Free, Fault> {
        let gene = Gene::new(format!("`{}`", name.into()), min, max)?;
        let name = gene.name.trim_matches('`').to_owned();
        if min == max {
            bail!(BAD_RANGE, "the search range of `{name}` is the single value \
                              {min}"; help: "fix it instead: `fixed = {min}`");
        }
        let wide = (min > 0.0 && max > DECADE * min) || (max < 0.0 && min < DECADE * max);
        let logarithmic = logarithmic.unwrap_or(wide);
        if logarithmic && min <= 0.0 && max >= 0.0 {
            bail!(
                BAD_RANGE,
                "`{name}` is searched on a logarithmic scale, but its range {min} to {max} reaches 0";
                help: "use a range of one sign, or `scale = \"linear\"`"
            );
        }
        if let Some(start) = start.filter(|start| !(min..=max).contains(start)) {
            bail!(BAD_RANGE, "the start {start} of `{name}` lies outside its range {min} to {max}");
        }
        Ok(Free { name, unit: unit.into(), min, max, logarithmic, start })
    }

    /// The value at the fraction `u` of the range, 0 ≤ u ≤ 1.
    pub fn value(&self, u: f64) -> f64 {
        let value = match self.logarithmic {
            true => {
                let [low, high] = [self.min, self.max].map(|end| elementary::ln(end.abs()));
                elementary::exp(low + (high - low) * u).copysign(self.min)
            }
            false => self.min + (self.max - self.min) * u,
        };
        value.clamp(self.min, self.max)
    }

    /// Where in the range a value lies, 0 to 1; values outside it are put on its ends.
    pub fn fraction(&self, value: f64) -> f64 {
        let value = value.clamp(self.min, self.max);
        let fraction = match self.logarithmic {
            true => elementary::ln(value / self.min) / elementary::ln(self.max / self.min),
            false => (value - self.min) / (self.max - self.min),
        };
        fraction.clamp(0.0, 1.0)
    }

    /// What is searched in place of the value, growing with it: the value itself or its natural
    /// logarithm, of a negative value less the logarithm of its size.
    pub(super) fn coordinate(&self, value: f64) -> f64 {
        if self.logarithmic { elementary::ln(value.abs()) * self.min.signum() } else { value }
    }

    /// The value that belongs to a [`coordinate`](Self::coordinate).
    pub(super) fn value_at_coordinate(&self, coordinate: f64) -> f64 {
        let sign = self.min.signum();
        if self.logarithmic { sign * elementary::exp(sign * coordinate) } else { coordinate }
    }

    /// The derivative of the coordinate by the value.
    pub(super) fn coordinate_derivative(&self, value: f64) -> f64 {
        if self.logarithmic { value.abs().recip() } else { 1.0 }
    }

    /// The derivative of the value by the fraction, at a value.
    pub fn derivative(&self, value: f64) -> f64 {
        match self.logarithmic {
            true => value * elementary::ln(self.max / self.min),
            false => self.max - self.min,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fractions_and_values_are_inverse() {
        let free = |log| Free::new("a", "V", [1e-3, 10.0], Some(log), None).unwrap();
        for free in [free(true), free(false)] {
            for u in [0.0, 0.1, 0.5, 1.0] {
                assert!((free.fraction(free.value(u)) - u).abs() < 1e-12);
            }
            let (value, h) = (free.value(0.3), 1e-6);
            let quotient = (free.value(0.3 + h) - free.value(0.3 - h)) / (2.0 * h);
            assert!((free.derivative(value) - quotient).abs() < 1e-6 * quotient);
        }
        assert!((free(true).value(0.5) - 0.1).abs() < 1e-12);
    }

    #[test]
    fn negative_ranges_are_searched_by_their_size() {
        let free = Free::new("a", "V", [-100.0, -0.01], None, None).unwrap();
        assert!(free.logarithmic && (free.value(0.5) + 1.0).abs() < 1e-12);
        assert_eq!((free.value(0.0), free.value(1.0)), (-100.0, -0.01));
        for u in [0.0, 0.2, 0.9] {
            let value = free.value(u);
            assert!((free.fraction(value) - u).abs() < 1e-12);
            assert!(
                (free.value_at_coordinate(free.coordinate(value)) - value).abs() < 1e-12 * -value
            );
            let h = 1e-6;
            let quotient = (free.value(u + h) - free.value(u)) / h;
            assert!((free.derivative(value) - quotient).abs() < 1e-4 * quotient);
            let along =
                (free.coordinate(value * (1.0 - h)) - free.coordinate(value)) / (-value * h);
            assert!((free.coordinate_derivative(value) - along).abs() < 1e-4 * along, "{along}");
        }
    }

    #[test]
    fn ranges_are_checked() {
        let range = |min, max, log, start| Free::new("a", "", [min, max], log, start);
        assert!(range(0.0, 1.0, Some(true), None).unwrap_err().message.contains("logarithmic"));
        assert!(range(1.0, 1.0, None, None).is_err());
        assert!(range(1.0, 2.0, None, Some(3.0)).is_err());
        assert!(range(1.0, 20.0, None, None).unwrap().logarithmic, "more than a decade");
        assert!(!range(0.0, 20.0, None, None).unwrap().logarithmic, "reaches 0");
    }
}
