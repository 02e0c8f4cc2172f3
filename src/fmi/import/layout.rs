//! The scalars of a unit: variables that are numbers or Strings, and the elements of arrays (FMI 3.0) with
//! subscripts from 1, `A[1,2]`. Sizes follow from start values of structural parameters, or from
//! values that are given in their place.

use crate::Description;
use crate::description::{Causality, Kind, Variable};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// A scalar, by the place of its variable in the description and its number within it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct Place {
    /// The variable.
    pub variable: usize,
    /// The element; 0 for scalars.
    pub element: usize,
}

/// A scalar with its name.
#[derive(Debug, Clone, PartialEq)]
pub struct Scalar {
    /// Its name, for an alias that of the alias.
    pub name: String,
    /// Where it is.
    pub place: Place,
}

/// All scalars of a unit.
#[derive(Debug, Clone, Default)]
pub struct Layout {
    /// Sizes of each variable.
    sizes: Vec<Vec<usize>>,
    scalars: Vec<Scalar>,
    /// Strings.
    strings: Vec<Scalar>,
    by_name: BTreeMap<String, usize>,
}

impl Layout {
    /// The scalars; `given` are values of structural parameters by their places.
    ///
    /// # Errors
    /// A size that is not known, or too large, in one sentence.
    pub fn of(description: &Description, given: &[(Place, f64)]) -> Result<Layout, String> {
        let value = |at: usize| {
            let own = given.iter().find(|(place, _)| place.variable == at);
            own.map(|(_, value)| *value)
        };
        let mut layout = Layout::default();
        for variable in &description.variables {
            layout.sizes.push(description.sizes(variable, value)?);
        }
        for (at, variable) in description.variables.iter().enumerate() {
            let is_text = variable.kind == Kind::String;
            if !is_text && !is_number(variable) {
                continue;
            }
            let aliases = variable.aliases.iter().map(|alias| alias.name.as_str());
            for name in std::iter::once(variable.name.as_str()).chain(aliases) {
                layout.add(name, at, is_text);
            }
        }
        Ok(layout)
    }

    fn add(&mut self, name: &str, variable: usize, is_text: bool) {
        let sizes = self.sizes[variable].clone();
        for element in 0..sizes.iter().product() {
            let name = format!("{name}{}", subscripts(&sizes, element));
            let place = Place { variable, element };
            if is_text {
                self.strings.push(Scalar { name, place });
                continue;
            }
            self.by_name.entry(name.clone()).or_insert(self.scalars.len());
            self.scalars.push(Scalar { name, place });
        }
    }

    /// The scalars in the order of the description.
    pub fn scalars(&self) -> &[Scalar] {
        &self.scalars
    }

    /// The Strings in the order of the description.
    pub fn strings(&self) -> &[Scalar] {
        &self.strings
    }

    /// The scalar of this name.
    pub fn find(&self, name: &str) -> Option<Place> {
        self.by_name.get(name).map(|at| self.scalars[*at].place)
    }

    /// Number of elements of a variable.
    pub fn count(&self, variable: usize) -> usize {
        self.sizes[variable].iter().product()
    }
}

/// Whether the values of a variable are numbers that can be read and set.
fn is_number(variable: &Variable) -> bool {
    match variable.kind {
        Kind::String | Kind::Binary => false,
        Kind::Clock => is_triggered(variable),
        _ => variable.causality != Causality::Independent,
    }
}

/// Whether results have a variable: it has values, and is not internal to the unit.
pub fn is_recorded(variable: &Variable) -> bool {
    !is_triggered(variable) && !variable.is_internal
}

/// Whether a variable is a clock that others trigger: an input that has no value.
fn is_triggered(variable: &Variable) -> bool {
    let by_others = variable.clock.as_ref().is_some_and(|own| own.variability == "triggered");
    variable.causality == Causality::Input && by_others
}

/// The subscripts of an element, the last one varying fastest.
fn subscripts(sizes: &[usize], mut element: usize) -> String {
    let mut all = Vec::new();
    for size in sizes.iter().rev() {
        all.push((element % size + 1).to_string());
        element /= size;
    }
    all.reverse();
    if all.is_empty() { String::new() } else { format!("[{}]", all.join(",")) }
}

/// The start values of a variable as numbers, one for each of `count` elements; 0 where nothing is
/// said.
pub fn starts(variable: &Variable, count: usize) -> Vec<f64> {
    let number = |text: &String| match text.as_str() {
        "true" => 1.0,
        "false" => 0.0,
        other => other.parse().unwrap_or(0.0),
    };
    let values: Vec<f64> = variable.start.iter().map(number).collect();
    match values.as_slice() {
        [one] => vec![*one; count],
        _ => (0..count).map(|at| values.get(at).copied().unwrap_or(0.0)).collect(),
    }
}

/// Why a variable cannot have a value, as the end of a sentence.
pub fn refusal(kind: Kind, value: f64) -> Option<String> {
    let range = match kind {
        Kind::Float32 | Kind::Float64 => {
            return (!value.is_finite()).then(|| format!("cannot be {value}"));
        }
        Kind::Boolean => [0.0, 1.0],
        Kind::Int8 => [f64::from(i8::MIN), f64::from(i8::MAX)],
        Kind::UInt8 => [0.0, f64::from(u8::MAX)],
        Kind::Int16 => [f64::from(i16::MIN), f64::from(i16::MAX)],
        Kind::UInt16 => [0.0, f64::from(u16::MAX)],
        Kind::Int32 => [f64::from(i32::MIN), f64::from(i32::MAX)],
        Kind::UInt32 => [0.0, f64::from(u32::MAX)],
        Kind::UInt64 => [0.0, u64::MAX as f64],
        _ => [i64::MIN as f64, i64::MAX as f64],
    };
    let fits = (range[0]..=range[1]).contains(&value) && value.fract() == 0.0;
    let word = kind.word();
    (!fits).then(|| format!("is {word} and cannot be {value}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::description::Dimension;

    #[test]
    fn elements_are_counted_with_the_last_subscript_first() {
        let names: Vec<String> = (0..6).map(|at| subscripts(&[2, 3], at)).collect();
        assert_eq!(names, ["[1,1]", "[1,2]", "[1,3]", "[2,1]", "[2,2]", "[2,3]"]);
        assert_eq!(subscripts(&[], 0), "");
    }

    #[test]
    fn sizes_follow_structural_parameters() {
        let size = Variable {
            name: "n".to_owned(),
            reference: 1,
            kind: Kind::UInt64,
            start: vec!["3".to_owned()],
            ..Variable::default()
        };
        let array = Variable {
            name: "x".to_owned(),
            reference: 2,
            dimensions: vec![Dimension::Variable(1), Dimension::Fixed(2)],
            ..Variable::default()
        };
        let description = Description { variables: vec![size, array], ..Description::default() };
        assert_eq!(Layout::of(&description, &[]).unwrap().count(1), 6);
        let given = [(Place { variable: 0, element: 0 }, 2.0)];
        let layout = Layout::of(&description, &given).unwrap();
        assert_eq!(layout.find("x[2,2]"), Some(Place { variable: 1, element: 3 }));
        assert_eq!(layout.find("x[3,1]"), None);
    }

    #[test]
    fn values_fit_their_types() {
        assert_eq!(refusal(Kind::Int8, -128.0), None);
        assert_eq!(refusal(Kind::Int8, 128.0).unwrap(), "is Int8 and cannot be 128");
        assert!(refusal(Kind::Boolean, 0.5).is_some());
        assert!(refusal(Kind::Float64, f64::NAN).is_some());
        assert_eq!(refusal(Kind::Float64, 1e300), None);
    }
}
