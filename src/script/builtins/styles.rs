//! Enumerations that scripts of Dymola use without loading anything.

use crate::name::{Ident, Name};
use crate::value::{EnumerationDefinition, EnumerationValue, Value};
use std::sync::Arc;

/// Names of the enumerations with their literals.
const STYLES: &[(&str, &[&str])] = &[
    (
        "MarkerStyle",
        &[
            "None",
            "Cross",
            "Circle",
            "Square",
            "FilledCircle",
            "FilledSquare",
            "TriangleDown",
            "TriangleUp",
            "Diamond",
            "Dot",
            "SmallSquare",
            "Point",
            "BarChart",
            "AreaFill",
        ],
    ),
    ("LinePattern", &["None", "Solid", "Dash", "Dot", "DashDot", "DashDotDot"]),
    ("TextStyle", &["Bold", "Italic", "UnderLine"]),
    ("TextAlignment", &["Left", "Center", "Right"]),
    (
        "SignalOperator",
        &[
            "Min",
            "Max",
            "ArithmeticMean",
            "RectifiedMean",
            "RMS",
            "ACCoupledRMS",
            "SlewRate",
            "THD",
            "FirstHarmonic",
        ],
    ),
];

/// The literal of this full name: `MarkerStyle.None`.
pub(super) fn literal(name: &Name) -> Option<Value> {
    let owner = name.parent();
    let (style, literals) = STYLES.iter().find(|(style, _)| owner.to_string() == *style)?;
    let literal = name.last()?;
    let at = literals.iter().position(|known| literal == **known)?;
    let literals = literals.iter().map(|literal| Ident::new(literal)).collect();
    let (name, descriptions) = (Name::parse(style), Vec::new());
    let definition = Arc::new(EnumerationDefinition { name, literals, descriptions });
    Some(Value::Enumeration(EnumerationValue { definition, ordinal: at as i64 + 1 }))
}
