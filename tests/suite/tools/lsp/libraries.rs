//! Classes of libraries: what they leave to those who use them is not reported, mistakes are.

use super::client::{Client, uri};
use crate::support::program::folder;
use serde_json::json;
use std::fs;
use std::path::Path;

/// Connectors: of electricity, with an overdetermined angle, and of a mechanism.
const CONNECTORS: &str = include_str!("../../../data/models/libraries_connectors.mo");

/// The diagnostics of a package with the connectors and these classes, without the helps.
fn found(classes: &str) -> Vec<String> {
    let here = folder(&[]);
    let mut client = Client::start(here.path());
    let path = here.path().join("P.mo");
    client.open(&path, &format!("package P\n{CONNECTORS}{classes}end P;\n"));
    let mut found = client.diagnostics(&path, 1);
    let id = client.ask("workspace/symbol", json!({}));
    client.response(id);
    assert_eq!(client.shut_down(), 0);
    for one in &mut found {
        *one = one.split(' ').skip(1).collect::<Vec<_>>().join(" ");
        *one = one.split(" | ").next().unwrap().to_owned();
    }
    found
}

const NOTHING: [&str; 0] = [];

#[test]
fn the_outside_decides_about_overdetermined_connectors() {
    let conductor = include_str!("../../../data/models/libraries_overdetermined_conductor.mo");
    assert_eq!(found(conductor), NOTHING);
    // With plain connectors an equation that is missing is a mistake.
    let wrong = "\
  model Conductor
    Pin p, n;
    parameter Real G = 1;
  equation
    p.i = G*(p.v - n.v);
  end Conductor;
";
    let found = found(wrong);
    assert!(found.len() == 1 && found[0].starts_with("unbalanced-model"), "{found:?}");
}

#[test]
fn a_class_that_whoever_uses_it_replaces_may_be_partial() {
    let medium = include_str!("../../../data/models/libraries_partial_medium.mo");
    let generic = include_str!("../../../data/models/libraries_partial_generic.mo");
    assert_eq!(found(&format!("{medium}{generic}")), NOTHING);
    let wrong = "\
  model Direct
    PartialLaw law;
  end Direct;
";
    assert_eq!(
        found(&format!("{medium}{wrong}")),
        ["partial-class: `P.PartialLaw` is partial and cannot be instantiated"]
    );
}

#[test]
fn values_that_decide_the_structure_are_given_where_a_class_is_used() {
    let open = "\
  block Sum
    parameter Integer n;
    parameter Boolean hasBias;
    parameter Real table[:];
    RealInput u[n];
    RealInput bias if hasBias;
    RealOutput y = sum(u) + table[1];
  end Sum;
";
    assert_eq!(found(open), NOTHING);
    let wrong = format!(
        "{open}  model Complete\n    Sum s(u = {{1, 2}}, table = {{1}}, hasBias = false);\n  end Complete;\n"
    );
    let found = found(&wrong);
    assert!(
        found.iter().any(|one| one.starts_with("value-needed: `s.n` has no value")),
        "{found:?}"
    );
}

#[test]
fn a_part_has_no_world_of_its_own() {
    let part = "\
  model Mass
    Pin frame;
    outer World world;
  equation
    frame.i = world.g;
  end Mass;
";
    assert_eq!(found(part), NOTHING);
    let complete = "\
  model Falling
    outer World world;
    Real v(start = 0, fixed = true);
  equation
    der(v) = -world.g;
  end Falling;
";
    let found = found(complete);
    assert!(found.len() == 1 && found[0].starts_with("missing-inner"), "{found:?}");
}

#[test]
fn counts_of_records_and_of_bound_inputs_are_not_guessed() {
    let classes = include_str!("../../../data/models/libraries_counts_classes.mo");
    assert_eq!(found(classes), NOTHING);
}

#[test]
fn a_package_opened_in_the_middle_keeps_its_files() {
    let here = folder(&[]);
    let write = |name: &str, text: &str| {
        let path = here.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(&path, text).unwrap();
        path
    };
    // The library is converted: it uses an older version of another one.
    write(
        "Base/package.mo",
        "package Base\n  constant Real new = 1;\n  annotation(version = \"2\", conversion(from(version \
         = \"1\", script = \"modelica://Base/convert.mos\")));\nend Base;\n",
    );
    write("Base/convert.mos", "convertElement(\"Base\", \"old\", \"new\");\n");
    let root = "package Lib\n  annotation(uses(Base(version = \"1\")));\nend Lib;\n";
    let root_path = write("Lib/package.mo", root);
    write("Lib/Parts/package.mo", "within Lib;\npackage Parts\nend Parts;\n");
    write("Lib/Others/package.mo", "within Lib;\npackage Others\nend Others;\n");
    let part = "within Lib.Parts;\nmodel Part\n  Real x = Base.new;\nend Part;\n";
    let part_path = write("Lib/Parts/Part.mo", part);
    let other = "within Lib.Others;\nmodel Other\n  Lib.Parts.Part part;\nend Other;\n";
    let other_path = write("Lib/Others/Other.mo", other);
    let mut client = Client::start(here.path());
    let library = json!({"capabilities": {}, "rootUri": uri(here.path())});
    assert_eq!(client.refused("initialize", library.clone())["code"], -32600);
    let mut client = Client::uninitialized(Path::new("/"));
    client.request("initialize", library);
    client.notify("initialized", json!({}));
    for (path, text) in [(&part_path, part), (&root_path, root), (&other_path, other)] {
        client.open(path, text);
        assert_eq!(client.diagnostics(path, 1), NOTHING, "{}", path.display());
        client.close(path);
    }
    assert_eq!(client.shut_down(), 0);
}

#[test]
fn a_folder_of_the_workspace_uses_the_libraries_of_another() {
    let here = folder(&[]);
    for (name, text) in [
        ("one/Lib/package.mo", "package Lib\n  constant Real a = 1;\nend Lib;\n"),
        ("two/Other/package.mo", "package Other\n  constant Real b = 1;\nend Other;\n"),
        ("three/User.mo", ""),
    ] {
        let path = here.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }
    let mut client = Client::uninitialized(Path::new("/"));
    let folder = |name: &str| json!({"uri": uri(&here.path().join(name)), "name": name});
    // One holds libraries, one is a library.
    let folders = [folder("one"), folder("two/Other"), folder("three")];
    client.request("initialize", json!({"capabilities": {}, "workspaceFolders": folders}));
    client.notify("initialized", json!({}));
    let path = here.path().join("three/User.mo");
    client.open(&path, "model User\n  Real x = Lib.a + Other.b + None.c;\nend User;\n");
    let found = client.diagnostics(&path, 1);
    assert!(found.len() == 1 && found[0].contains("None"), "{found:?}");
    assert_eq!(client.shut_down(), 0);
}

#[test]
fn what_is_not_supported_is_a_warning() {
    let here = folder(&[]);
    let mut client = Client::start(here.path());
    let path = here.path().join("M.mo");
    let text = "\
model M
  Boolean early = String(integer(time)) < \"2\";
end M;
";
    client.open(&path, text);
    let found = client.published(&path, 1);
    assert_eq!(found.len(), 1, "{found:?}");
    assert_eq!((&found[0]["code"], &found[0]["severity"]), (&json!("not-supported"), &json!(2)));
    assert_eq!(client.shut_down(), 0);
}
