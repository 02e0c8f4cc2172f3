//! Libraries that were written for an older version of another one (MLS §18.8): their classes are
//! what the conversion script of the newer version makes of them.

use gapilib::internals::flatten::errors::UNKNOWN_NAME;
use gapilib::internals::flatten::{Library, LibraryFiles, flatten};
use gapilib::internals::name::Name;
use gapilib::internals::source::{SourceId, SourceMap};
use gapilib::internals::syntax::parse_stored_definition;
use gapilib::{Diagnostic, Fault};
use std::path::Path;
use std::sync::Arc;

/// Version 2 of a library.
const PUMPS: &str = include_str!("../../data/models/conversions_pumps.mo");

const SCRIPT: &str = r#"// Rules in any order
convertClear();
convertClass({"Pumps.Flows", "Pumps.Flows.Icons"}, {"Pumps.Units", "Pumps.Units.Icons"});
convertClass("Pumps.Pump", "Pumps.Machines.Pump");
convertClassIf("Pumps.Pump", "quick", "true", "Pumps.Machines.FastPump");
convertClass("Pumps.Base", "Pumps.Machines.Base");
convertClass("Pumps.times", "Pumps.Machines.scaled");
convertClass("Pumps.Medium", "Pumps.Machines.Medium");
convertClass("Pumps.Fluid", "Pumps.Machines.Fluid");
convertElement("Pumps.Medium.State", {"extent", "height"}, {"size", "level"});
convertElement("Pumps.Fluid.State", {"extent", "height"}, {"size", "level"});
convertClass("Pumps.Speed", "Pumps.Machines.Kind")
convertElement("Pumps.Speed", "fast", "swift");
convertElement({"Pumps.Pump", "Pumps.times"}, {"nom", "by"}, {"nominal", "factor"});
convertElement("Pumps.Base", "extent", "size");
convertModifiers("Pumps.Pump", {"low=1", "high=3"}, {"gain=%low%*(%high% - 1)"}, true);
convertModifiers({"Pumps.Base"}, fill("", 0), {"size=7"});
convertModifiers("Pumps.Pump", {"colour"}, fill("", 0));
convertModifiers("Pumps.Pump", {"first"}, {"rate(start=2*%first%)"});
convertMessage("Pumps.Valve", "there are no valves any more");
convertMessage("Pumps.Pump", "set the flow", "speed");
"#;

#[derive(Debug)]
struct Files;

impl LibraryFiles for Files {
    fn read(&self, path: &Path) -> Result<(SourceId, Arc<str>), Fault> {
        match path.to_str() {
            Some("Pumps/package.mo") => Ok((SourceId(1), PUMPS.into())),
            Some("Pumps/Scripts/to2.mos") => Ok((SourceId(2), SCRIPT.into())),
            _ => Err(Fault::new(UNKNOWN_NAME, "no such file")),
        }
    }

    fn list(&self, _: &Path) -> Vec<String> {
        Vec::new()
    }

    fn is_file(&self, path: &Path) -> bool {
        path.to_str() == Some("Pumps/package.mo")
    }
}

/// A library of a user, loaded before or after the one that it uses.
fn loaded(text: &str, first: bool) -> Library {
    let mut library = Library::new();
    let source = SourceMap::default().add("User.mo", text);
    let user = parse_stored_definition(source, text).expect("Modelica");
    let files: Arc<dyn LibraryFiles> = Arc::new(Files);
    let pumps = |library: &mut Library| {
        library
            .load_lazily(&files, Path::new("Pumps"), &Name::default())
            .expect("the library loads");
    };
    if first {
        pumps(&mut library);
    }
    library.load(&user).expect("the user's library loads");
    if !first {
        pumps(&mut library);
    }
    library
}

fn flat(body: &str, version: &str) -> Result<String, Vec<Diagnostic>> {
    let text =
        format!("package User {body} annotation(uses(Pumps(version = \"{version}\"))); end User;");
    let texts = [true, false].map(|first| {
        let library = loaded(&text, first);
        flattened(&library)
    });
    let [one, other] = texts;
    assert_eq!(one.as_ref().ok(), other.as_ref().ok(), "the order of loading decides");
    one
}

fn flattened(library: &Library) -> Result<String, Vec<Diagnostic>> {
    let flat = flatten(library, &Name::parse("User.M"), &[]);
    // Errors in the texts of classes come first, as in the program.
    match library.take_problems() {
        problems if problems.is_empty() => flat.map(|flat| flat.model.to_string()),
        problems => Err(problems),
    }
}

/// The lines of the flat model of `User.M`, without the first and the last.
#[track_caller]
fn converted(body: &str, expected: &[&str]) {
    let text = flat(body, "1.1").unwrap_or_else(|errors| panic!("{errors:?}"));
    let lines: Vec<&str> = text.lines().map(str::trim).collect();
    for line in expected {
        assert!(lines.contains(line), "`{line}` is not in\n{text}");
    }
}

#[track_caller]
fn refused(body: &str, reason: &str) {
    let errors = flat(body, "1.1").expect_err("the model is accepted");
    let found = errors.iter().find(|one| one.code.slug == "conversion");
    let found = found.unwrap_or_else(|| panic!("{errors:?}"));
    assert!(found.message.contains(reason), "{}", found.message);
    assert!(!found.labels.is_empty(), "the message has no place");
}

#[test]
fn names_of_classes_are_converted_however_they_are_imported() {
    for declared in [
        "model M Pumps.Pump p(nom = 3); end M;",
        "model M import Pumps.Pump; Pump p(nom = 3); end M;",
        "model M import P = Pumps.Pump; P p(nom = 3); end M;",
        "model M import Pumps.*; Pump p(nom = 3); end M;",
        "model M import Pumps.{Pump, times}; Pump p(nom = 3); end M;",
        "model Own = Pumps.Pump(nom = 3); model M Own p; end M;",
        "package P = Pumps; model M P.Pump p(nom = 3); end M;",
        "model Outer Pumps.Pump q; end Outer; model M extends Outer(q(nom = 2)); .Pumps.Pump p(nom = 3); end M;",
    ] {
        converted(declared, &["parameter Real 'p.nominal' = 3;"]);
    }
    converted(
        "import F = Pumps.Flows; model M F.Flow f = 1; F.Icons.Length l = 2; end M;",
        &["Real f(unit = \"m3/s\") = 1;", "Real l = 2;"],
    );
}

/// BrineProp: a medium that replaces and extends `BaseProperties`, whose `R` is `R_s` today.
#[test]
fn elements_of_a_class_that_is_replaced_and_extended_are_converted() {
    converted(
        "package Water extends Pumps.Medium; \
           redeclare model extends State(height(start = 2)) Real twice = 2*extent; \
           equation height = time; extent = 3; end State; end Water; \
         package Oil extends Pumps.Fluid; redeclare model extends State \
           Real thrice = 3*extent; equation height = time; extent = 4; end State; end Oil; \
         package Salt extends Water; redeclare model extends State Real more = extent; \
           end State; end Salt; \
         model M Water.State p; Salt.State s; Oil.State o; Real r = p.extent + s.height; end M;",
        &[
            "Real 'p.level'(start = 2);",
            "Real 'p.twice' = 2 * 'p.size';",
            "Real 's.more' = 's.size';",
            "'p.size' = 3;",
            "Real 'o.thrice' = 3 * 'o.size';",
            "Real r = 'p.size' + 's.level';",
        ],
    );
}

#[test]
fn the_longest_rule_counts_for_functions_and_literals() {
    converted(
        "model M parameter Real x = Pumps.times(2, by = 4); parameter Pumps.Speed s = Pumps.Speed.fast;
         end M;",
        &["parameter Real x = Pumps.Machines.scaled(2, factor = 4);", "parameter Pumps.Machines.Kind s = 2;"],
    );
}

#[test]
fn elements_are_converted_where_they_are_named() {
    converted(
        "model Inner Pumps.Pump pump; end Inner;
         model M Inner inside(pump(nom = 5)); Pumps.Pump p; Real x = p.nom + inside.pump.nom; end M;",
        &["parameter Real 'inside.pump.nominal' = 5;", "Real x = 'p.nominal' + 'inside.pump.nominal';"],
    );
    converted(
        "model A extends Pumps.Base(extent = 4); end A; model M extends A; Real y = 2*extent; end M;",
        &["parameter Real size = 4;", "Real y = 2 * size;"],
    );
}

#[test]
fn modifiers_are_converted_with_the_values_and_defaults_of_the_script() {
    converted(
        "model M Pumps.Pump p(low = 2 + 1, colour = 3); Pumps.Pump q(high = 9); Pumps.Pump r; Pumps.Pump s(first = 1 + 4); end M;",
        &[
            "parameter Real 'p.gain' = (2 + 1) * (3 - 1);",
            "parameter Real 'q.gain' = 1 * (9 - 1);",
            "parameter Real 'r.gain' = 1;",
            "Real 's.rate'(start = 2 * (1 + 4)) = 's.gain' * 's.nominal';",
        ],
    );
    // What is written takes precedence over what is added to all uses.
    converted(
        "model M Pumps.Base a; Pumps.Base b(extent = 2); Pumps.Base c(size = 3); end M;",
        &["parameter Real 'a.size' = 7;", "parameter Real 'c.size' = 3;"],
    );
}

#[test]
fn the_value_of_a_modifier_chooses_the_class() {
    converted(
        "model M Pumps.Pump p(quick = true, nom = 2), q; end M;",
        &["parameter Boolean 'p.quick' = true;", "parameter Real 'q.nominal' = 1;"],
    );
}

#[test]
fn what_cannot_be_converted_says_why() {
    refused("model M Pumps.Valve v; end M;", "there are no valves any more");
    refused("model M Pumps.Pump p(speed = 2); end M;", "set the flow");
    refused("model M Pumps.Pump p; Real x = p.speed; end M;", "set the flow");
}

/// A version that the library has forgotten is older than those that it names.
#[test]
fn a_version_without_rules_is_converted_by_those_of_the_next_one() {
    for version in ["0.1", "0.9.3", "1.0.7", "1"] {
        let old = flat("model M Pumps.Pump p(nom = 4); end M;", version);
        assert!(old.as_ref().is_ok_and(|text| text.contains("'p.nominal' = 4")), "{old:?}");
    }
}

/// Without `uses`, of the loaded version, of one that needs no conversion or is newer than those that do.
#[test]
fn nothing_else_is_converted() {
    for version in ["2.0", "1.9", "1.9.5", "3.0", "next"] {
        assert!(flat("model M Pumps.Pump p; end M;", version).is_err());
        let new = flat("model M Pumps.Machines.Pump p; end M;", version);
        assert!(new.as_ref().is_ok_and(|text| text.contains("'p.nominal' = 1")), "{new:?}");
    }
}

/// A library that was renamed twice: 1.0 to 1.5 by rules in its annotation, 1.5 to 2.0 by others;
/// 1.6 needs none to become 2.0.
const TANKS: &str = include_str!("../../data/models/conversions_tanks.mo");

fn tanks_and(body: &str, version: &str) -> Library {
    let mut library = Library::new();
    let user =
        format!("package User {body} annotation(uses(Tanks(version = \"{version}\"))); end User;");
    for text in [TANKS, user.as_str()] {
        let source = SourceMap::default().add("Tanks.mo", text);
        library.load(&parse_stored_definition(source, text).expect("Modelica")).expect("loads");
    }
    library
}

fn with_tanks(body: &str, version: &str) -> Result<String, Vec<Diagnostic>> {
    flattened(&tanks_and(body, version))
}

#[test]
fn rules_in_the_annotation_lead_over_several_versions() {
    for (version, body) in [
        ("1.0", "model M Tanks.Box t(high = 3, s = 4); Real x = t.high; Real a = t.s; end M;"),
        ("0.9", "model M Tanks.Box t(s = 4, high = 3); Real x = t.high; Real a = t.s; end M;"),
        (
            "1.5",
            "model M Tanks.Vessel t(level = 3, size.area = 4); Real x = t.level; Real a = t.size.area; end M;",
        ),
        (
            "1.6",
            "model M Tanks.Tank t(height = 3, area = 4); Real x = t.height; Real a = t.area; end M;",
        ),
    ] {
        let flat =
            with_tanks(body, version).unwrap_or_else(|errors| panic!("{version} {errors:?}"));
        for line in [
            "parameter Real 't.height' = 3;",
            "parameter Real 't.area' = 4;",
            "Real x = 't.height';",
            "Real a = 't.area';",
        ] {
            assert!(flat.contains(line), "{version}: no `{line}` in\n{flat}");
        }
    }
    // The modifiers and the choice of a later step see what an earlier one has made.
    let flat = with_tanks("model M Tanks.Box t(double = 5, lid = false); end M;", "1.0");
    assert!(flat.as_ref().is_ok_and(|text| text.contains("'t.height' = 2 * 5;")), "{flat:?}");
}

#[test]
fn steps_that_lead_nowhere_and_messages_of_any_step_are_errors() {
    for (version, body, reason) in [
        ("0.1", "model M Tanks.Box t; end M;", "from version 0.1 to 0.2 only"),
        ("0.3", "model M Tanks.Box t; end M;", "from version 0.3 to 0.3 only"),
        ("0.4", "model M Tanks.Box t; end M;", "this is not a rule"),
        ("1.0", "model M Tanks.Box t(colour = 2); end M;", "tanks have no colour"),
    ] {
        let errors = with_tanks(body, version).expect_err(version);
        let found = errors.iter().find(|one| one.code.slug == "conversion");
        let found = found.unwrap_or_else(|| panic!("{errors:?}"));
        assert!(found.message.contains(reason), "{}", found.message);
    }
}

#[test]
fn functions_named_in_annotations_and_addresses_are_converted() {
    let body = "function own input Real x; output Real y; algorithm y := Tanks.third(x);
           annotation(derivative = Tanks.thirdSlope); end own;
         model M Real x = own(time); constant String s = \"modelica://Tanks.Vessel/a.txt\"; end M;";
    let library = tanks_and(body, "1.5");
    let flat = flatten(&library, &Name::parse("User.M"), &[]).expect("flattens").model;
    // A function that an annotation names in vain is left out.
    assert!(
        flat.functions.contains_key(&Name::parse("Tanks.cubeSlope")),
        "{:?}",
        flat.functions.keys()
    );
    let text = flat.to_string();
    assert!(text.contains("\"modelica://Tanks.Tank/a.txt\""), "{text}");
}

/// What a class inherits from other classes of the user, over any number of them.
#[test]
fn inherited_components_are_converted() {
    converted(
        "model A Pumps.Pump p; end A; model B extends A; end B; model C extends B; end C;
         model M extends C(p(nom = 4)); Real y = 2*p.nom; end M;",
        &["parameter Real 'p.nominal' = 4;", "Real y = 2 * 'p.nominal';"],
    );
}
