//! Sizes of arrays (FMI 3.0.2 §2.4.7.1): numbers, or the values of structural parameters.

use super::{Description, Dimension, Variable};

/// More elements than this are a mistake of the description.
const MOST_ELEMENTS: u64 = 10_000_000;

impl Description {
    /// The sizes of a variable, none for a scalar; `given` has the values that are given to structural
    /// parameters in place of their start values, by the places of these.
    ///
    /// # Errors
    /// A size that is not known, or an array that is too large, in one sentence.
    pub fn sizes(
        &self,
        variable: &Variable,
        given: impl Fn(usize) -> Option<f64>,
    ) -> Result<Vec<usize>, String> {
        let mut sizes = Vec::new();
        let mut elements: u64 = 1;
        for dimension in &variable.dimensions {
            let size = match dimension {
                Dimension::Fixed(size) => *size,
                Dimension::Variable(reference) => {
                    self.size(*reference, &given).ok_or_else(|| {
                        format!("a size of the array `{}` is not known", variable.name)
                    })?
                }
            };
            elements = elements.saturating_mul(size);
            sizes.push(usize::try_from(size).unwrap_or(usize::MAX));
        }
        match elements <= MOST_ELEMENTS {
            true => Ok(sizes),
            false => Err(format!("the array `{}` has {elements} elements", variable.name)),
        }
    }

    /// The value of the structural parameter of this value reference.
    fn size(&self, reference: u32, given: &impl Fn(usize) -> Option<f64>) -> Option<u64> {
        let at = self.variables.iter().position(|one| one.reference == reference)?;
        match given(at) {
            Some(value) => {
                Some(value).filter(|v| *v >= 0.0 && v.fract() == 0.0).map(|value| value as u64)
            }
            None => self.variables[at].start.first()?.parse().ok(),
        }
    }
}
