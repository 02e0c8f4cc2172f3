//! Libraries that were written for an older version of another one (MLS §18.8): their classes are
//! what the conversion script of the newer version makes of them.

use gapilib::diag::{Diagnostic, Fault};
use gapilib::flatten::errors::UNKNOWN_NAME;
use gapilib::flatten::{Library, LibraryFiles, flatten};
use gapilib::name::Name;
use gapilib::source::{SourceId, SourceMap};
use gapilib::syntax::parse_stored_definition;
use std::path::Path;
use std::sync::Arc;

/// Version 2 of a library.
const PUMPS: &str = "package Pumps
  package Units type Flow = Real(unit = \"m3/s\"); package Icons type Length = Real; end Icons; end Units;
  package Machines
    model Pump parameter Real nominal = 1; parameter Real gain = 1; Real rate = gain*nominal; end Pump;
    model FastPump extends Pump; parameter Boolean quick = true; end FastPump;
    model Base parameter Real size = 1; Real level = size; end Base;
    function scaled input Real x; input Real factor = 1; output Real y; algorithm y := x*factor; end scaled;
    type Kind = enumeration(slow, swift);
  end Machines;
  annotation(version = \"2.0\", conversion(noneFromVersion = \"1.9\", from(version = {\"1.0\", \"1.1\"},
    script = \"modelica://Pumps/Scripts/to2.mos\")));
end Pumps;";

const SCRIPT: &str = r#"// Rules in any order
convertClear();
convertClass({"Pumps.Flows", "Pumps.Flows.Icons"}, {"Pumps.Units", "Pumps.Units.Icons"});
convertClass("Pumps.Pump", "Pumps.Machines.Pump");
convertClassIf("Pumps.Pump", "quick", "true", "Pumps.Machines.FastPump");
convertClass("Pumps.Base", "Pumps.Machines.Base");
convertClass("Pumps.times", "Pumps.Machines.scaled");
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
        let flat = flatten(&library, &Name::parse("User.M"), &[]);
        // Errors in the texts of classes come first, as in the program.
        match library.take_problems() {
            problems if problems.is_empty() => flat.map(|flat| flat.model.to_string()),
            problems => Err(problems),
        }
    });
    let [one, other] = texts;
    assert_eq!(one.as_ref().ok(), other.as_ref().ok(), "the order of loading decides");
    one
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

/// Without `uses`, of the loaded version, of one that needs no conversion or has no rules.
#[test]
fn nothing_else_is_converted() {
    for version in ["2.0", "1.9", "0.1"] {
        assert!(flat("model M Pumps.Pump p; end M;", version).is_err());
        let new = flat("model M Pumps.Machines.Pump p; end M;", version);
        assert!(new.as_ref().is_ok_and(|text| text.contains("'p.nominal' = 1")), "{new:?}");
    }
}
