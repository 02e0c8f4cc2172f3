//! What values a variable takes: models and functional mock-up units refuse others in the same words.

use crate::bail;
use crate::diag::Fault;
use crate::errors::BAD_PARAMETER_VALUE;

/// What a variable takes.
pub(crate) struct Range<'l> {
    /// Smallest and largest value; infinite without.
    pub limits: [f64; 2],
    /// The literals of an enumeration with their numbers; none for other types.
    pub literals: Vec<(f64, &'l str)>,
}

impl Range<'_> {
    /// Refuses a value for a variable, which `subject` names.
    ///
    /// # Errors
    /// Values that are not finite, outside the limits, or the number of no literal.
    pub(crate) fn check(&self, subject: &str, value: f64) -> Result<(), Fault> {
        let [min, max] = self.limits;
        if !value.is_finite() {
            bail!(BAD_PARAMETER_VALUE, "{subject} cannot be {value}"; help: "use a finite number");
        }
        if !self.literals.is_empty() && self.literals.iter().all(|(number, _)| *number != value) {
            let all: Vec<String> =
                self.literals.iter().map(|(number, name)| format!("{name} ({number})")).collect();
            bail!(BAD_PARAMETER_VALUE, "{subject} cannot be {value}";
                help: "its values are {}", all.join(", "));
        }
        if (min..=max).contains(&value) {
            return Ok(());
        }
        let domain = match (min.is_finite(), max.is_finite()) {
            (true, true) => format!("outside {min} to {max}"),
            (true, false) => format!("less than {min}"),
            _ => format!("more than {max}"),
        };
        bail!(
            BAD_PARAMETER_VALUE,
            "{subject} is {value}, {domain}, outside the range declared in the model";
            help: "choose another value, or change `min` and `max` in the model"
        )
    }
}
