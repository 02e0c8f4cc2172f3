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
        co_simulation: Some(Interface { can_handle_variable_steps: true, ..interface }),
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
    let mut description = with_variables(Version::V3);
    description.variables[2].is_internal = true;
    assert_eq!(read(write(&description)).unwrap(), description);
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
fn what_is_not_said_has_its_default_and_annotations_are_passed_over() {
    let text = r#"<!-- made by hand --><fmiModelDescription fmiVersion="3.0.2" modelName="m"
        instantiationToken="t">
      <ModelExchange modelIdentifier="m"><Annotations><Annotation type="x"><y z="1">t</y>
      </Annotation></Annotations></ModelExchange>
      <ModelVariables>
        <Float64 name="time" valueReference="0" causality="independent"/>
        <Float64 name="a" valueReference="1" max="INF" initial="exact" start="1 2"><Dimension start="2"/>
          <Alias name="b"/></Float64>
        <Int64 name="n" valueReference="2" causality="parameter" start="9007199254740993"/>
        <Boolean name="u" valueReference="3" causality="input" start="1"/>
        <String name="s" valueReference="4" initial="exact"><Dimension start="2"/><Start value="one"/><Start value=" two "/></String>
      </ModelVariables>
      <ModelStructure/></fmiModelDescription>"#;
    let description = read(text).unwrap();
    let [_, a, n, u, s] = &description.variables[..] else { panic!("{description:?}") };
    assert_eq!(a.variability, Variability::Continuous);
    assert_eq!(
        (a.attributes.max, &a.dimensions[..]),
        (Some(f64::INFINITY), &[Dimension::Fixed(2)][..])
    );
    assert_eq!(a.aliases[0].name, "b");
    assert_eq!((n.variability, n.initial), (Variability::Fixed, Some(Initial::Exact)));
    assert_eq!(n.start, ["9007199254740993"]);
    assert_eq!((u.variability, u.initial), (Variability::Discrete, None));
    assert_eq!(s.start, ["one", " two "]);
    assert!(!description.model_exchange.unwrap().needs_completed_step);
}

#[test]
fn later_versions_may_have_more() {
    let text =
        write(&with_variables(Version::V3)).replace("modelName=", "newAttribute=\"1\" modelName=");
    let error = read(&text).unwrap_err().to_string();
    assert!(
        error.contains("line 2: `fmiModelDescription` has no attribute `newAttribute`"),
        "{error}"
    );
    read(text.replace("fmiVersion=\"3.0\"", "fmiVersion=\"3.1\"")).unwrap();
}

/// Attributes that hold free text.
const FREE: &[&str] = &[
    "author",
    "copyright",
    "description",
    "generationTool",
    "generationDateAndTime",
    "guid",
    "instantiationToken",
    "license",
    "modelIdentifier",
    "modelName",
    "quantity",
    "version",
];

/// A text with a range in it replaced.
fn replaced(text: &str, range: std::ops::Range<usize>, by: &str) -> String {
    format!("{}{by}{}", &text[..range.start], &text[range.end..])
}

/// Values that an attribute cannot have.
fn wrong_values(element: roxmltree::Node, attribute: &str) -> &'static [&'static str] {
    let tag = element.tag_name().name();
    let is_text = ["String", "Start"].contains(&tag) && ["start", "value"].contains(&attribute);
    let is_named = ["Unit", "SimpleType", "Float64Type", "EnumerationType"].contains(&tag);
    let is_structure = element.ancestors().any(|one| one.has_tag_name("ModelStructure"));
    match attribute {
        _ if FREE.contains(&attribute) || is_text => &[],
        // What refers to it finds it no more.
        "name" if is_named => &["other"],
        "name" => &[],
        "unit" | "displayUnit" | "declaredType" => &["other"],
        "index" | "derivative" | "dependencies" => &["one", "4294967295"],
        "valueReference" if is_structure => &["one", "4294967295"],
        "start" if tag == "Enumeration" => &["one", "3"],
        _ => &["one"],
    }
}

/// Whatever attribute is misspelt, has a value of another type, or refers to nothing: the line is named.
#[test]
fn one_damaged_attribute_is_found() {
    for version in [Version::V2, Version::V3] {
        let text = write(&with_variables(version));
        let document = roxmltree::Document::parse(&text).unwrap();
        let mut damages = 0;
        for element in document.descendants().filter(roxmltree::Node::is_element) {
            let line = document.text_pos_at(element.range().start).row;
            let mut refuses = |damaged: &str, attribute: &str| {
                let error = read(damaged).expect_err(damaged).to_string();
                // In FMI 2.0 types are elements in those of variables.
                let is_there =
                    [line, line - 1].iter().any(|at| error.contains(&format!("line {at}:")));
                assert!(is_there || attribute == "name", "{attribute} in line {line}: {error}");
                damages += 1;
            };
            for attribute in element.attributes() {
                let name = attribute.name();
                refuses(&replaced(&text, attribute.range_qname(), &format!("{name}_")), name);
                for value in wrong_values(element, name) {
                    refuses(&replaced(&text, attribute.range_value(), value), name);
                }
            }
        }
        assert!(damages > 100, "{damages}");
    }
}

/// Rules of the text of the standard, one broken each time.
#[test]
fn broken_rules_are_said() {
    let of_3 = |from: &str, to: &str| {
        let text = write(&with_variables(Version::V3));
        assert!(text.contains(from), "{from}: {text}");
        read(text.replacen(from, to, 1)).expect_err(to).to_string()
    };
    for (from, to, said) in [
        ("name=\"der(x)\"", "name=\"x\"", "the variable name `x` is in line"),
        ("valueReference=\"11\"", "valueReference=\"9\"", "the value reference `9` is in line"),
        (
            "declaredType=\"Length\"",
            "declaredType=\"Gear\"",
            "is Float64, but its type `Gear` is Enumeration",
        ),
        ("start=\"2\"", "start=\"3\"", "starts with 3, but its values are 1 (low), 2 (high)"),
        ("start=\"2\"", "", "`gear` has no start value"),
        ("start=\"1e-3\"", "start=\"0.001 2\"", "has 2 start values, but 1 elements"),
        ("unit=\"m\"", "unit=\"ft\"", "the type has the unit `ft`"),
        ("variability=\"fixed\"", "variability=\"continuous\"", "String and cannot be continuous"),
        ("variability=\"fixed\"", "variability=\"discrete\"", "cannot be parameter and discrete"),
        ("initial=\"calculated\"", "initial=\"calculated\" start=\"1\"", "has a start value"),
        ("value=\"2\"", "value=\"1\"", "the value of an item `1` is in line"),
        ("<Output valueReference=\"7\"", "<Output valueReference=\"3\"", "is not an output"),
        ("start=\"1e-3\"", "start=\"-2\"", "`x` starts with -2, outside its range -1.5 to inf"),
        ("stopTime=\"3\"", "stopTime=\"-3\"", "the `stopTime` -3 is before the `startTime` 0"),
        ("fmiVersion=\"3.0\"", "fmiVersion=\"3.x\"", "it is of FMI 3.x"),
        ("<Output valueReference=\"7\"", "<EventIndicator valueReference=\"7\"", "an output that"),
        (
            "<ContinuousStateDerivative valueReference=\"3\"",
            "<EventIndicator valueReference=\"3\"",
            "`der(x)` is a derivative that `ModelStructure` does not list",
        ),
        ("nominal=\"1000000\"", "nominal=\"0\"", "has the nominal value 0"),
        ("causality=\"independent\"", "causality=\"local\"", "no independent variable"),
        ("derivative=\"7\"", "derivative=\"3\"", "cannot be the derivative of `der(x)`"),
        (" dependencies=\"7 9\"", "", "`dependenciesKind` needs `dependencies`"),
        ("<ModelStructure>", "<ModelStructure/><ModelStructure>", "has 2 times `ModelStructure`"),
        (
            "<Float64 name=\"time\"",
            "<Float46 name=\"x\"/><Float64 name=\"time\"",
            "`ModelVariables` has no element `Float46` in FMI 3.0; did you mean `Float64`?",
        ),
    ] {
        let text = of_3(from, to);
        assert!(text.contains(said), "{to}: {text}");
    }
    let alias = |start: &str, unit: &str| {
        let own = "<ScalarVariable name=\"y\" valueReference=\"7\" causality=\"local\"";
        let text = write(&with_variables(Version::V2)).replace(
            "</ModelVariables>",
            &format!(
                "{own} initial=\"exact\"><Real{start}{unit}/></ScalarVariable></ModelVariables>"
            ),
        );
        read(&text).map_err(|error| error.to_string())
    };
    alias(" start=\"1e-3\"", " unit=\"m\"").unwrap();
    let error = alias(" start=\"2\"", " unit=\"m\"").unwrap_err();
    assert!(error.contains("reference 7 of `x`, but they have different start values"), "{error}");
    let error = alias(" start=\"1e-3\"", "").unwrap_err();
    assert!(error.contains("but they have different units"), "{error}");
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
             </ScalarVariable></ModelVariables><ModelStructure/></fmiModelDescription>",
            "line 3: `-1` is not a value of the attribute `valueReference`",
        ),
        (
            "@<ModelVariables>\n<ScalarVariable name=\"x\" valueReference=\"1\"/></ModelVariables>\
             </fmiModelDescription>",
            "line 3: `ScalarVariable` has no `Real`, `Integer`, `Boolean`, `String`, `Enumeration` in it",
        ),
        (
            "@<ModelVariables><ScalarVariable name=\"x\" valueReference=\"1\"><Real/></ScalarVariable>\
             </ModelVariables><ModelStructure><Outputs>\n<Unknown index=\"2\"/></Outputs>\
             </ModelStructure></fmiModelDescription>",
            "line 3: there is no variable 2",
        ),
    ];
    for (text, expected) in cases {
        let error = read(text.replace('@', start)).unwrap_err();
        match &error {
            FmuError::Xml(_) => assert_eq!(expected, "no XML"),
            other => assert!(other.to_string().contains(expected), "{other}"),
        }
    }
}

#[test]
fn descriptions_are_utf_8_or_latin_1_by_their_own_word() {
    let text = include_str!("../../../tests/fmus/latin.xml");
    let utf = text.replace("ISO-8859-1", "UTF-8");
    let expected = read(&utf).unwrap();
    assert!(expected.variables[0].description.as_deref() == Some("Temp\u{e9}rature"));
    let bytes = |text: &str| text.chars().map(|own| own as u8).collect::<Vec<u8>>();
    assert_eq!(read(bytes(text)).unwrap(), expected);
    let error = read(bytes(&utf)).unwrap_err().to_string();
    assert!(error.contains("byte 0xE9 in line 4 is not UTF-8: save it as UTF-8"), "{error}");
}
