//! The units of measurement of a unit's variables.

use crate::description::{BaseUnit, DisplayUnit, Unit, Variable};
use crate::units;
use std::collections::BTreeMap;

/// The units that variables name, each once, in alphabetical order.
pub(super) fn units<'v>(variables: impl Iterator<Item = &'v Variable>) -> Vec<Unit> {
    let mut known: BTreeMap<String, Unit> = BTreeMap::new();
    for variable in variables {
        let Some(name) = &variable.attributes.unit else { continue };
        let unit = known.entry(name.clone()).or_insert_with(|| Unit {
            name: name.clone(),
            base: base(name),
            display_units: Vec::new(),
        });
        let Some(shown) = &variable.attributes.display_unit else { continue };
        let is_new = unit.display_units.iter().all(|one| one.name != *shown);
        if let (true, Some(display)) = (is_new, display(name, shown)) {
            unit.display_units.push(display);
        }
    }
    known.into_values().collect()
}

/// What a unit is in base units of SI.
pub(crate) fn base(name: &str) -> Option<BaseUnit> {
    BaseUnit::of(units::unit(name)?)
}

/// A unit for people; `None` where it measures something else.
pub(super) fn display(name: &str, shown: &str) -> Option<DisplayUnit> {
    let conversion = units::unit(name)?.to(units::written(shown)?)?;
    let (factor, offset) = (conversion.factor, conversion.offset);
    Some(DisplayUnit { name: shown.to_owned(), factor, offset, is_inverse: false })
}

#[cfg(test)]
mod tests {
    use super::display;

    #[test]
    fn units_for_people_are_as_people_write_them() {
        let celsius = display("K", "°C").expect("a temperature");
        assert_eq!((celsius.name.as_str(), celsius.factor, celsius.offset), ("°C", 1.0, -273.15));
        assert_eq!(display("K", "bar"), None);
    }
}
