//! Units of SBML as they are written in Modelica (MLS §19).

use super::element::Element;
use crate::Refusal;
use crate::expression::number;
use std::collections::BTreeMap;

/// Symbols of base units of SBML; others keep their names.
const SYMBOLS: &[(&str, &str)] = &[
    ("litre", "l"),
    ("liter", "l"),
    ("mole", "mol"),
    ("second", "s"),
    ("metre", "m"),
    ("meter", "m"),
    ("kilogram", "kg"),
    ("gram", "g"),
    ("kelvin", "K"),
    ("ampere", "A"),
    ("volt", "V"),
    ("joule", "J"),
    ("newton", "N"),
    ("pascal", "Pa"),
    ("watt", "W"),
    ("dimensionless", "1"),
    ("item", "1"),
    ("hertz", "Hz"),
    ("coulomb", "C"),
    ("farad", "F"),
    ("ohm", "Ohm"),
    ("siemens", "S"),
    ("candela", "cd"),
    ("radian", "rad"),
    ("katal", "kat"),
];

const PREFIXES: &[(f64, &str)] = &[
    (-15.0, "f"),
    (-12.0, "p"),
    (-9.0, "n"),
    (-6.0, "u"),
    (-3.0, "m"),
    (0.0, ""),
    (3.0, "k"),
    (6.0, "M"),
];

/// The units that a model defines, as text.
pub(super) fn definitions(model: &Element<'_, '_>) -> Result<BTreeMap<String, String>, Refusal> {
    let mut all: BTreeMap<String, String> =
        SYMBOLS.iter().map(|(name, symbol)| ((*name).to_owned(), (*symbol).to_owned())).collect();
    for definition in model.list("listOfUnitDefinitions") {
        let (mut above, mut below) = (Vec::new(), Vec::new());
        for unit in definition.list("listOfUnits") {
            let (text, exponent) = factor(&unit)?;
            let side = if exponent < 0.0 { &mut below } else { &mut above };
            let power = exponent.abs();
            match power {
                0.0 => {}
                1.0 => side.push(text),
                _ => side.push(format!("{text}{power}")),
            }
        }
        let above = if above.is_empty() { "1".to_owned() } else { above.join(".") };
        let text = match below.as_slice() {
            [] => above,
            [one] => format!("{above}/{one}"),
            more => format!("{above}/({})", more.join(".")),
        };
        all.insert(definition.required("id")?, text);
    }
    Ok(all)
}

/// A unit with prefix and multiplier, and its exponent.
fn factor(unit: &Element<'_, '_>) -> Result<(String, f64), Refusal> {
    let kind = unit.required("kind")?;
    let exponent = unit.number("exponent")?.unwrap_or(1.0);
    let scale = unit.number("scale")?.unwrap_or(0.0);
    let multiplier = unit.number("multiplier")?.unwrap_or(1.0);
    let symbol = SYMBOLS.iter().find(|(name, _)| *name == kind).map_or(kind.as_str(), |(_, s)| s);
    let prefix = PREFIXES.iter().find(|(own, _)| *own == scale).map(|(_, prefix)| *prefix);
    let text = match (symbol, multiplier, prefix) {
        ("s", 60.0, Some("")) => "min".to_owned(),
        ("s", 3600.0, Some("")) => "h".to_owned(),
        ("s", 86400.0, Some("")) => "d".to_owned(),
        (symbol, 1.0, Some(prefix)) => format!("{prefix}{symbol}"),
        (symbol, multiplier, Some(prefix)) => format!("{}*{prefix}{symbol}", number(multiplier)),
        (symbol, multiplier, None) => format!("{}*1e{scale}*{symbol}", number(multiplier)),
    };
    Ok((text, exponent))
}
