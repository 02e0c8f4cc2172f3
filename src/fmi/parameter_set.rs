//! Parameter sets: values of parameters by their names, in files `.ssv` (System Structure Parameter
//! Values of SSP 1.0). What a fit knows beside a value, its interval and standard error, is an
//! annotation, and in words the description.

use crate::FmuError;
use crate::description::{BaseUnit, base_unit, read_unit};
use crate::export::base;
use crate::units::Definitions;
use crate::xml::{Element, Xml, number};
use roxmltree::Document;
use std::collections::BTreeMap;

/// The ending of the files.
pub const ENDING: &str = "ssv";
/// The type of the annotation with what a fit knows.
const ESTIMATE: &str = "gapilib.estimate";

/// Values of parameters.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ParameterSet {
    /// Whose they are.
    pub name: String,
    /// The parameters.
    pub parameters: Vec<Parameter>,
    /// The units that the file defines.
    pub units: Definitions,
}

/// A parameter with its value.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameter {
    /// Its name.
    pub name: String,
    /// Its value.
    pub value: ParameterValue,
    /// The unit of the value, if this is said.
    pub unit: Option<String>,
    /// What a fit knows of it.
    pub estimate: Option<Estimate>,
}

/// The value of a parameter.
#[derive(Debug, Clone, PartialEq)]
pub enum ParameterValue {
    /// A real or whole number.
    Number(f64),
    /// True or false.
    Truth(bool),
    /// A text, or the name of a literal of an enumeration.
    Text(String),
}

/// What a fit knows of a parameter, in the unit of its value.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Estimate {
    /// The 95 % interval.
    pub interval: Option<[f64; 2]>,
    /// One standard deviation.
    pub deviation: Option<f64>,
}

impl ParameterSet {
    /// The text of a file.
    pub fn to_xml(&self) -> String {
        let mut xml = Xml::new();
        let standard = "http://ssp-standard.org/SSP1/SystemStructure";
        let base = |name: &str| base(name).or_else(|| BaseUnit::of(self.units.defined(name)?));
        let known = |unit: &String| Some((unit.clone(), base(unit)?));
        let units = self.parameters.iter().filter_map(|own| known(own.unit.as_ref()?));
        // A unit must be one that is known, and be declared.
        let units: BTreeMap<_, _> = units.collect();
        xml.element("ssv:ParameterSet", |xml| {
            xml.attribute("xmlns:ssv", format!("{standard}ParameterValues"));
            xml.attribute("xmlns:ssc", format!("{standard}Common"));
            xml.attribute("version", "1.0");
            xml.attribute("name", &self.name);
            xml.attribute("generationTool", concat!("gapilib ", env!("CARGO_PKG_VERSION")));
            xml.element("ssv:Parameters", |xml| {
                for own in &self.parameters {
                    let unit = own.unit.as_ref().filter(|unit| units.contains_key(*unit));
                    xml.element("ssv:Parameter", |xml| parameter(xml, own, unit));
                }
            });
            let units: Vec<_> = units.iter().collect();
            xml.group("ssv:Units", &units, |xml, (name, base)| {
                xml.element("ssc:Unit", |xml| {
                    xml.attribute("name", name);
                    base_unit(xml, "ssc:BaseUnit", base);
                });
            });
        });
        xml.text
    }

    /// The set in a text.
    ///
    /// # Errors
    /// It is not well-formed or not a parameter set; it gives a parameter two values, a value that is
    /// none, or one of type Binary.
    pub fn read(text: &str) -> Result<ParameterSet, String> {
        let document =
            Document::parse(text).map_err(|error| format!("not well-formed: {error}"))?;
        let placed = |error: FmuError| match error {
            FmuError::Description { line, message } => format!("line {line}: {message}"),
            other => other.to_string(),
        };
        let root = Element(document.root_element());
        if root.name() != "ParameterSet" {
            return Err(format!("the root is `{}`, not `ParameterSet`", root.name()));
        }
        let name = root.text("name").unwrap_or_default();
        let mut set = ParameterSet { name, ..ParameterSet::default() };
        for element in root.elements("Units", "Unit") {
            let own = read_unit(&element).map_err(placed)?;
            let base = own.base.as_ref().and_then(BaseUnit::unit);
            base.into_iter().for_each(|unit| set.units.add(&own.name, unit));
        }
        for element in root.elements("Parameters", "Parameter") {
            let own = read_parameter(&element).map_err(placed)?;
            if set.parameters.iter().any(|known| known.name == own.name) {
                return Err(placed(element.error(format!("`{}` has a value already", own.name))));
            }
            set.parameters.push(own);
        }
        Ok(set)
    }
}

fn parameter(xml: &mut Xml, own: &Parameter, unit: Option<&String>) {
    xml.attribute("name", &own.name);
    xml.optional(
        "description",
        own.estimate.map(in_words).filter(|text| !text.is_empty()).as_ref(),
    );
    match &own.value {
        ParameterValue::Number(value) => xml.element("ssv:Real", |xml| {
            xml.attribute("value", number(*value));
            xml.optional("unit", unit);
        }),
        ParameterValue::Truth(value) => {
            xml.element("ssv:Boolean", |xml| xml.attribute("value", value));
        }
        ParameterValue::Text(value) => {
            xml.element("ssv:String", |xml| xml.attribute("value", value));
        }
    }
    let Some(Estimate { interval, deviation }) = own.estimate else { return };
    xml.element("ssv:Annotations", |xml| {
        xml.element("ssc:Annotation", |xml| {
            xml.attribute("type", ESTIMATE);
            xml.element("Estimate", |xml| {
                xml.optional("lower95", interval.map(|[lower, _]| number(lower)).as_ref());
                xml.optional("upper95", interval.map(|[_, upper]| number(upper)).as_ref());
                xml.optional("standardError", deviation.map(number).as_ref());
            });
        });
    });
}

fn in_words(estimate: Estimate) -> String {
    let Estimate { interval, deviation } = estimate;
    let interval = interval.map(|[lower, upper]| format!("95 % interval {lower} to {upper}"));
    let deviation = deviation.map(|deviation| format!("standard error {deviation}"));
    interval.into_iter().chain(deviation).collect::<Vec<_>>().join(", ")
}

fn read_parameter(element: &Element) -> Result<Parameter, FmuError> {
    let name = element.required("name")?.to_owned();
    let children = element.children();
    let is_value = |child: &&Element| child.name() != "Annotations";
    let Some(value) = children.iter().find(is_value) else {
        return Err(element.error(format!("`{name}` has no value")));
    };
    let number = |value: &Element| value.needed::<f64>("value").map(ParameterValue::Number);
    let own = match value.name() {
        "Real" | "Float64" | "Float32" => number(value)?,
        "Boolean" => ParameterValue::Truth(value.is_true("value")?),
        "String" | "Enumeration" => ParameterValue::Text(value.required("value")?.to_owned()),
        whole if ["Integer", "Int", "UInt"].iter().any(|kind| whole.starts_with(kind)) => {
            let number = value.needed::<f64>("value")?;
            if number.fract() != 0.0 {
                return Err(value.error(format!("`{name}` is {whole} and cannot be {number}")));
            }
            ParameterValue::Number(number)
        }
        other => return Err(value.error(format!("`{name}` is {other}, which is not read"))),
    };
    let annotations = children.iter().find(|child| child.name() == "Annotations");
    let annotations = annotations.map(Element::children).unwrap_or_default();
    let of_fit = annotations.iter().find(|own| own.get("type") == Some(ESTIMATE));
    let estimate = of_fit.and_then(|own| own.child("Estimate")).map(|own| {
        let (lower, upper) = (own.parsed("lower95")?, own.parsed("upper95")?);
        let interval = lower.zip(upper).map(|(lower, upper)| [lower, upper]);
        Ok(Estimate { interval, deviation: own.parsed("standardError")? })
    });
    let estimate = estimate.transpose()?;
    Ok(Parameter { name, value: own, unit: value.text("unit"), estimate })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::units;

    #[test]
    fn a_set_is_read_as_it_was_written() {
        let parameter = |name: &str, value| Parameter {
            name: name.to_owned(),
            value,
            unit: None,
            estimate: None,
        };
        let estimate = Estimate { interval: Some([1.5e-7, f64::INFINITY]), deviation: Some(0.25) };
        let mut set = ParameterSet {
            name: "Room & board".to_owned(),
            units: Definitions::default(),
            parameters: vec![
                Parameter {
                    unit: Some("W/K".to_owned()),
                    estimate: Some(estimate),
                    ..parameter("wall.G", ParameterValue::Number(0.1 + 0.2))
                },
                Parameter {
                    unit: Some("hp".to_owned()),
                    ..parameter("power", ParameterValue::Number(2.0))
                },
                parameter("on", ParameterValue::Truth(true)),
                parameter("label", ParameterValue::Text("a < \"b\"".to_owned())),
            ],
        };
        set.units.add("hp", units::Unit { factor: 745.7, ..units::written("W").unwrap() });
        let xml = set.to_xml();
        set.units.add("W/K", units::written("W/K").unwrap());
        assert_eq!(ParameterSet::read(&xml).unwrap(), set);
        assert!(
            xml.contains("description=\"95 % interval 0.00000015 to inf, standard error 0.25\"")
        );
        assert!(xml.contains("<ssc:BaseUnit kg=\"1\" m=\"2\" s=\"-3\" K=\"-1\"/>"), "{xml}");
    }

    #[test]
    fn what_is_no_set_is_refused() {
        let read = |inside: &str| {
            let text = format!("<ParameterSet><Parameters>\n{inside}</Parameters></ParameterSet>");
            ParameterSet::read(&text)
        };
        for (inside, said) in [
            ("<Parameter name=\"k\"/>", "line 2: `k` has no value"),
            ("<Parameter name=\"k\"><Real value=\"two\"/></Parameter>", "`two` is not a value"),
            ("<Parameter name=\"k\"><Binary value=\"00\"/></Parameter>", "`k` is Binary"),
            ("<Parameter><Real value=\"2\"/></Parameter>", "no attribute `name`"),
            ("<Parameter", "not well-formed"),
        ] {
            let error = read(inside).unwrap_err();
            assert!(error.contains(said), "{inside}: {error}");
        }
        let twice = "<Parameter name=\"k\"><Int32 value=\"2\"/></Parameter>".repeat(2);
        assert!(read(&twice).unwrap_err().contains("`k` has a value already"));
        let one = read("<Parameter name=\"k\"><Int32 value=\"2\"/></Parameter>").unwrap();
        assert_eq!(one.parameters[0].value, ParameterValue::Number(2.0));
        assert!(ParameterSet::read("<other/>").unwrap_err().contains("not `ParameterSet`"));
    }
}
