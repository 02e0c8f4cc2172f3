//! Descriptions are read as they are written.

use super::*;
use crate::FmuError;

/// Time, a state with its derivative, an enumeration and a String.
fn variables() -> Vec<Variable> {
    let variable = |name: &str, reference: u32| Variable {
        name: name.to_owned(),
        reference,
        initial: Some(Initial::Calculated),
        ..Variable::default()
    };
    let time = Variable { causality: Causality::Independent, initial: None, ..variable("time", 0) };
    let state = Variable {
        description: Some("a < b & \"c\"\n\tsecond line".to_owned()),
        causality: Causality::Output,
        initial: Some(Initial::Exact),
        start: vec!["1e-3".to_owned()],
        declared_type: Some("Length".to_owned()),
        attributes: Attributes { min: Some(-1.5), nominal: Some(1e6), ..Attributes::default() },
        is_reinitialized: true,
        ..variable("x", 7)
    };
    let derivative = Variable { derivative_of: Some(1), ..variable("der(x)", 3) };
    let choice = Variable {
        kind: Kind::Enumeration,
        variability: Variability::Discrete,
        declared_type: Some("Gear".to_owned()),
        causality: Causality::Input,
        initial: None,
        start: vec!["2".to_owned()],
        ..variable("gear", 9)
    };
    let text = Variable {
        kind: Kind::String,
        variability: Variability::Fixed,
        causality: Causality::Parameter,
        initial: Some(Initial::Exact),
        start: vec!["two words".to_owned()],
        ..variable("text", 11)
    };
    vec![time, state, derivative, choice, text]
}

/// A unit of length and an enumeration.
fn types() -> Vec<TypeDefinition> {
    let length = TypeDefinition {
        name: "Length".to_owned(),
        attributes: Attributes {
            quantity: Some("Length".to_owned()),
            unit: Some("m".to_owned()),
            min: Some(0.0),
            ..Attributes::default()
        },
        ..TypeDefinition::default()
    };
    let item = |name: &str, value| Item { name: name.to_owned(), value, description: None };
    let gear = TypeDefinition {
        name: "Gear".to_owned(),
        kind: Kind::Enumeration,
        items: vec![item("low", 1), item("high", 2)],
        ..TypeDefinition::default()
    };
    vec![length, gear]
}

fn structure() -> Structure {
    let on = |places: &[usize]| {
        Some(places.iter().map(|place| (*place, DependencyKind::Dependent)).collect())
    };
    let unknown = |variable, dependencies| Unknown { variable, dependencies };
    Structure {
        outputs: vec![unknown(1, on(&[]))],
        derivatives: vec![unknown(2, on(&[1, 3]))],
        initial_unknowns: vec![unknown(2, None)],
        ..Structure::default()
    }
}

fn with_variables(version: Version) -> Description {
    let interface = Interface {
        model_identifier: "Ball".to_owned(),
        can_get_and_set_state: true,
        provides_directional_derivatives: true,
        ..Interface::default()
    };
    Description {
        version,
        model_name: "A.Ball".to_owned(),
        token: "{1}".to_owned(),
        has_structured_names: true,
        model_exchange: Some(interface.clone()),
        co_simulation: Some(Interface {
            can_handle_variable_steps: true,
            needs_completed_step: true,
            ..interface
        }),
        units: vec![Unit {
            name: "m".to_owned(),
            base: Some(BaseUnit { exponents: [0, 1, 0, 0, 0, 0, 0, 0], factor: 1.0, offset: 0.0 }),
            display_units: vec![DisplayUnit {
                name: "mm".to_owned(),
                factor: 1000.0,
                offset: 0.0,
                is_inverse: false,
            }],
        }],
        types: types(),
        log_categories: vec![LogCategory { name: "logEvents".to_owned(), description: None }],
        experiment: DefaultExperiment { stop: Some(3.0), ..DefaultExperiment::default() },
        variables: variables(),
        structure: structure(),
        event_indicators: if version == Version::V2 { 4 } else { 0 },
        ..Description::default()
    }
}

#[test]
fn both_versions_are_read_as_they_are_written() {
    for version in [Version::V2, Version::V3] {
        let description = with_variables(version);
        let text = write(&description);
        assert_eq!(read(&text).unwrap(), description, "{text}");
    }
}

#[test]
fn places_are_numbers_in_fmi_2_and_references_in_fmi_3() {
    let text = write(&with_variables(Version::V2));
    assert!(text.contains("<Unknown index=\"3\" dependencies=\"2 4\""), "{text}");
    assert!(text.contains("<Real derivative=\"2\"/>"), "{text}");
    let text = write(&with_variables(Version::V3));
    let written = "<ContinuousStateDerivative valueReference=\"3\" dependencies=\"7 9\"";
    assert!(text.contains(written), "{text}");
    assert!(text.contains("derivative=\"7\""), "{text}");
}

#[test]
fn attributes_of_a_variable_go_before_those_of_its_type() {
    let description = with_variables(Version::V3);
    let attributes = description.attributes_of(&description.variables[1]);
    assert_eq!((attributes.min, attributes.unit.as_deref()), (Some(-1.5), Some("m")));
}

#[test]
fn what_is_not_said_has_its_default_and_what_is_unknown_is_passed_over() {
    let text = r#"<!-- made by hand --><fmiModelDescription fmiVersion="3.0.2" modelName="m"
        instantiationToken="t" newAttribute="1">
      <ModelExchange modelIdentifier="m"><Annotations><Annotation type="x"><y z="1">t</y>
      </Annotation></Annotations></ModelExchange>
      <ModelVariables>
        <Float64 name="a" valueReference="1" max="INF" start="1 2"><Dimension start="2"/>
          <Alias name="b"/></Float64>
        <Int64 name="n" valueReference="2" causality="parameter" start="9007199254740993"/>
        <Boolean name="u" valueReference="3" causality="input"/>
        <String name="s" valueReference="4"><Start value="one"/><Start value=" two "/></String>
      </ModelVariables>
      <ModelStructure/></fmiModelDescription>"#;
    let description = read(text).unwrap();
    let [a, n, u, s] = &description.variables[..] else { panic!("{description:?}") };
    assert_eq!((a.variability, a.initial), (Variability::Continuous, Some(Initial::Calculated)));
    assert_eq!(
        (a.attributes.max, &a.dimensions[..]),
        (Some(f64::INFINITY), &[Dimension::Fixed(2)][..])
    );
    assert_eq!(a.aliases[0].name, "b");
    assert_eq!((n.variability, n.initial), (Variability::Fixed, Some(Initial::Exact)));
    assert_eq!(n.start, ["9007199254740993"]);
    assert_eq!((u.variability, u.initial), (Variability::Discrete, None));
    assert_eq!(s.start, ["one", " two "]);
    assert!(description.model_exchange.unwrap().needs_completed_step);
}

#[test]
fn what_is_wrong_is_said_with_its_line() {
    let start = "<fmiModelDescription fmiVersion=\"2.0\" modelName=\"m\" guid=\"g\">\n";
    let cases = [
        ("<a>", "no XML"),
        ("<a/>", "line 1: the root is `a`"),
        ("<fmiModelDescription/>", "line 1: `fmiModelDescription` has no attribute `fmiVersion`"),
        ("<fmiModelDescription fmiVersion=\"1.0\" modelName=\"m\" guid=\"\"/>", "it is of FMI 1.0"),
        (
            "@<ModelVariables>\n<ScalarVariable name=\"x\" valueReference=\"-1\"><Real/>\
             </ScalarVariable></ModelVariables></fmiModelDescription>",
            "line 3: `-1` is not a value of the attribute `valueReference`",
        ),
        (
            "@<ModelVariables>\n<ScalarVariable name=\"x\" valueReference=\"1\"/></ModelVariables>\
             </fmiModelDescription>",
            "line 3: `ScalarVariable` has no type",
        ),
        (
            "@<ModelStructure><Outputs>\n<Unknown index=\"1\"/></Outputs></ModelStructure>\
             </fmiModelDescription>",
            "line 3: there is no variable 1",
        ),
    ];
    for (text, expected) in cases {
        let error = read(&text.replace('@', start)).unwrap_err();
        match &error {
            FmuError::Xml(_) => assert_eq!(expected, "no XML"),
            other => assert!(other.to_string().contains(expected), "{other}"),
        }
    }
}
