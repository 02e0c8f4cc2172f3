//! Genes: what is searched for, and where.

use super::errors::BAD_RANGE;
use crate::bail;
use crate::diag::Fault;

/// One identified parameter: its name and its search range.
#[derive(Debug, Clone, PartialEq)]
pub struct Gene {
    /// The parameter's name in the model.
    pub name: String,
    /// Smallest value searched.
    pub min: f64,
    /// Largest value searched, not below `min`.
    pub max: f64,
}

impl Gene {
    /// A gene with a checked range.
    ///
    /// # Errors
    ///
    /// `bad-range` when `min` is above `max` or one of them is not finite.
    pub fn new(name: impl Into<String>, min: f64, max: f64) -> Result<Gene, Fault> {
        let name = name.into();
        if !min.is_finite() || !max.is_finite() {
            bail!(
                BAD_RANGE,
                "the search range of {name} is {min} to {max}, which is not finite";
                help: "give two finite numbers"
            );
        }
        if min > max {
            bail!(
                BAD_RANGE,
                "the search range of {name} is empty: its minimum {min} is above its maximum {max}";
                help: "swap them"
            );
        }
        Ok(Gene { name, min, max })
    }

    /// The value at the fraction `u` of the range, 0 ≤ u ≤ 1: min + (max − min) u, never above
    /// max by rounding.
    pub fn at(&self, u: f64) -> f64 {
        (self.min + (self.max - self.min) * u).min(self.max)
    }

    /// Where a value lies in the range: 0 at min, 1 at max; 0 in an empty range.
    pub fn fraction(&self, value: f64) -> f64 {
        let width = self.max - self.min;
        if width > 0.0 { (value - self.min) / width } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn empty_and_infinite_ranges_are_refused() {
        let fault = Gene::new("`A`", 2.0, 1.0).unwrap_err();
        assert_eq!(fault.code, BAD_RANGE);
        assert!(fault.message.contains("`A`"));
        assert!(Gene::new("`A`", 0.0, f64::INFINITY).is_err());
        assert!(Gene::new("`A`", f64::NAN, 1.0).is_err());
        assert_eq!(Gene::new("`A`", 1.0, 3.0).unwrap().at(0.25), 1.5);
        assert_eq!(Gene::new("`A`", 1.0, 1.0).unwrap().at(0.7), 1.0);
    }
}
