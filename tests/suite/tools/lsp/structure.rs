//! What an editor shows of the structure of documents and of the workspace, and problem files.

use super::client::{Client, uri};
use crate::support::program::folder;
use serde_json::{Value, json};
use std::path::Path;

const TANK: &str = "within Lib;
model Tank \"a tank\"
  parameter Real A(unit = \"m2\") = 2;
  // one
  // two
  Real h(start = f(1, b = 3), fixed = true) annotation(Dialog(
    group = \"x\"));
  function f
    input Real a \"first\";
    input Real b = 2 \"second\";
    output Real y = a*b;
  end f;
equation
  der(h) =
    -A*h;
  annotation(
    Icon(graphics = {Bitmap(fileName = \"modelica://Lib/Resources/a.png\")}),
    Documentation(info = \"modelica://Lib.Tank, modelica://Lib/Resources/none.png\"));
end Tank;
";
const PACKAGE: &str = "package Lib\nend Lib;\n";

fn of(path: &Path) -> Value {
    json!({"textDocument": {"uri": uri(path)}})
}

#[test]
fn classes_annotations_and_comments_fold() {
    let here = folder(&[("Lib/package.mo", PACKAGE), ("Lib/Tank.mo", TANK)]);
    let mut client = Client::start(here.path());
    let path = here.path().join("Lib/Tank.mo");
    client.open(&path, TANK);
    let found = client.request("textDocument/foldingRange", of(&path));
    let ranges: Vec<(u64, u64, &str)> = found
        .as_array()
        .unwrap()
        .iter()
        .map(|one| {
            let line = |name: &str| one[name].as_u64().unwrap();
            (line("startLine"), line("endLine"), one["kind"].as_str().unwrap_or(""))
        })
        .collect();
    let expected = [
        (1, 17, ""),
        (3, 4, "comment"),
        (5, 6, "region"),
        (7, 10, ""),
        (12, 14, ""),
        (15, 17, "region"),
    ];
    assert_eq!(ranges, expected);
    assert_eq!(client.shut_down(), 0);
}

#[test]
fn models_have_a_command_and_addresses_are_links() {
    let files =
        [("Lib/package.mo", PACKAGE), ("Lib/Tank.mo", TANK), ("Lib/Resources/a.png", "picture")];
    let here = folder(&files);
    let mut client = Client::start(here.path());
    let path = here.path().join("Lib/Tank.mo");
    client.open(&path, TANK);
    let lenses = client.request("textDocument/codeLens", of(&path));
    let lenses = lenses.as_array().unwrap();
    assert_eq!(lenses.len(), 1);
    assert_eq!(lenses[0]["command"]["command"], "gapilib.simulate");
    assert_eq!(lenses[0]["command"]["arguments"][1], "Lib.Tank");
    let links = client.request("textDocument/documentLink", of(&path));
    let targets: Vec<&str> =
        links.as_array().unwrap().iter().map(|one| one["target"].as_str().unwrap()).collect();
    let picture = uri(&here.path().join("Lib/Resources/a.png"));
    assert_eq!(targets, [picture, uri(&path)]);
    assert_eq!(client.shut_down(), 0);
}

#[test]
fn classes_of_the_workspace_are_found_by_parts_of_their_names() {
    let here = folder(&[
        ("Lib/package.mo", PACKAGE),
        ("Lib/Tank.mo", TANK),
        ("Other.mo", "model Stank end Stank;"),
    ]);
    let mut client = Client::uninitialized(here.path());
    let root = json!([{"uri": uri(here.path()), "name": "here"}]);
    let params = json!({"capabilities": {}, "workspaceFolders": root});
    let server = client.request("initialize", params);
    assert_eq!(server["capabilities"]["positionEncoding"], "utf-16");
    client.notify("initialized", json!({}));
    // One that is not saved counts as it is shown.
    client.open(&here.path().join("Other.mo"), "model Tanker Real tank; end Tanker;");
    let mut found = |query: &str| -> Vec<String> {
        let symbols = client.request("workspace/symbol", json!({"query": query}));
        let name = |one: &Value| {
            let within =
                one["containerName"].as_str().map_or(String::new(), |name| format!("{name}."));
            format!("{within}{}", one["name"].as_str().unwrap())
        };
        symbols.as_array().unwrap().iter().map(name).collect()
    };
    assert_eq!(found("TANK"), ["Tanker", "Lib.Tank"]);
    assert_eq!(found("lib"), ["Lib"]);
    assert_eq!(found("nothing"), Vec::<String>::new());
    assert_eq!(client.shut_down(), 0);
}

#[test]
fn the_inputs_of_a_call_are_shown_while_it_is_written() {
    let here = folder(&[]);
    let mut client = Client::start(here.path());
    let path = here.path().join("M.mo");
    let text = "model M
  function f
    input Real a \"first\";
    input Real b = 2;
    output Real y = a*b;
  end f;
  Real x = f(1, b = 3);
  Real y = homotopy(1, 2);
end M;
";
    client.open(&path, text);
    let mut at = |line: u64, character: u64| {
        let position = json!({"line": line, "character": character});
        client.request(
            "textDocument/signatureHelp",
            json!({"textDocument": {"uri": uri(&path)}, "position": position}),
        )
    };
    let first = at(6, 13);
    assert_eq!(first["signatures"][0]["label"], "f(input Real a, input Real b = 2)");
    assert_eq!(first["signatures"][0]["parameters"][0]["documentation"], "first");
    assert_eq!(first["activeParameter"], 0);
    assert_eq!(at(6, 20)["activeParameter"], 1);
    assert_eq!(at(7, 23)["activeParameter"], 1);
    assert_eq!(at(1, 4), Value::Null);
    assert_eq!(client.shut_down(), 0);
}

const PROBLEM: &str = "\
model = \"Line\"
files = [\"Line.mo\"]

[parameters]
a = { min = 0, max = 10 }

[[experiment]]
data = \"data.csv\"
x = \"x\"
outputs = { y = \"y\" }
";

#[test]
fn problem_files_are_checked_and_completed() {
    let line = crate::support::program::LINE;
    let here = folder(&[("Line.mo", line), ("data.csv", "x,y\n0,1\n1,2\n2,3.1\n")]);
    let mut client = Client::start(here.path());
    let path = here.path().join("fit.toml");
    client.open(&path, PROBLEM);
    assert_eq!(client.diagnostics(&path, 1), Vec::<String>::new());
    let lenses = client.request("textDocument/codeLens", of(&path));
    assert_eq!(lenses[0]["command"]["command"], "gapilib.identify");
    client.change(&path, 2, &PROBLEM.replace("a = {", "aa = {"));
    let found = client.diagnostics(&path, 2);
    assert!(found.len() == 1 && found[0].starts_with("4:5-26 bad-option"), "{found:?}");
    client.change(&path, 3, &PROBLEM.replace("min = 0", "minn = 0"));
    let found = client.diagnostics(&path, 3);
    assert!(found.len() == 1 && found[0].contains("did you mean `min`?"), "{found:?}");
    client.change(&path, 4, &PROBLEM.replace("data.csv", "nothing.csv"));
    let found = client.diagnostics(&path, 4);
    assert!(found.len() == 1 && found[0].starts_with("7:7"), "{found:?}");
    // Entries of the table in braces, and of that of an experiment.
    let mut version = 4;
    let mut labels = |text: &str, line: u64, character: u64| -> Vec<String> {
        version += 1;
        client.change(&path, version, text);
        let position = json!({"line": line, "character": character});
        let params = json!({"textDocument": {"uri": uri(&path)}, "position": position});
        let items = client.request("textDocument/completion", params);
        let label = |one: &Value| one["label"].as_str().unwrap().to_owned();
        items.as_array().unwrap().iter().map(label).collect()
    };
    let inside = labels(&PROBLEM.replace("max = 10", "m"), 4, 15);
    assert!(["max", "scale", "prior"].iter().all(|name| inside.iter().any(|own| own == name)));
    let entries = labels(&format!("{PROBLEM}st\n"), 10, 2);
    assert!(
        ["start", "stop_time", "weight"].iter().all(|name| entries.iter().any(|own| own == name))
    );
    assert_eq!(labels(PROBLEM, 0, 12), Vec::<String>::new());
    // Other files of TOML are not problems.
    let other = here.path().join("Cargo.toml");
    client.open(&other, "[package]\nname = \"x\"\n");
    assert_eq!(client.diagnostics(&other, 1), Vec::<String>::new());
    assert_eq!(client.shut_down(), 0);
}

/// The labels that are offered after a text that occurs once.
#[test]
fn problem_files_follow_the_classes_in_the_editor_and_the_files_on_the_disk() {
    let line = crate::support::program::LINE;
    let here = folder(&[("Line.mo", line), ("data.csv", "x,y\n0,1\n1,2\n2,3.1\n")]);
    std::fs::create_dir(here.path().join("Lib")).unwrap();
    let (package, inner) = (here.path().join("Lib/package.mo"), here.path().join("Lib/Line.mo"));
    std::fs::write(&package, "within;\npackage Lib\nend Lib;\n").unwrap();
    let inside = format!("within Lib;\n{line}");
    std::fs::write(&inner, &inside).unwrap();
    let (model, data) = (here.path().join("Line.mo"), here.path().join("data.csv"));
    let mut client = Client::start(here.path());
    let [path, second] = ["fit.toml", "second.toml"].map(|name| here.path().join(name));
    client.open(&path, PROBLEM);
    assert_eq!(client.diagnostics(&path, 1), Vec::<String>::new());
    // Each change is followed without a change of the problem.
    let renamed =
        |text: &str| text.replace("Real a", "Real slope").replace("y = a +", "y = slope +");
    client.open(&model, &renamed(line));
    let found = client.diagnostics(&path, 1);
    assert!(found.len() == 1 && found[0].contains("no parameter `a`"), "{found:?}");
    client.change(&model, 2, line);
    assert_eq!(client.diagnostics(&path, 1), Vec::<String>::new());
    std::fs::write(&data, "x,z\n0,1\n1,2\n2,3.1\n").unwrap();
    let changes = json!({"changes": [{"uri": uri(&data), "type": 2}]});
    client.notify("workspace/didChangeWatchedFiles", changes);
    let found = client.diagnostics(&path, 1);
    assert!(found.len() == 1 && found[0].contains("no column `y`"), "{found:?}");
    std::fs::write(&data, "x,y\n0,1\n1,2\n2,3.1\n").unwrap();
    // A file of a package, of which the problem names the folder.
    let of_package = PROBLEM.replace("\"Line\"", "\"Lib.Line\"").replace("Line.mo", "Lib");
    client.open(&inner, &renamed(&inside));
    client.open(&second, &of_package);
    let found = client.diagnostics(&second, 1);
    assert!(found.len() == 1 && found[0].contains("no parameter `a`"), "{found:?}");
    assert_eq!(client.shut_down(), 0);
}

fn offered(client: &mut Client, path: &Path, text: &str, after: &str) -> Vec<String> {
    let (head, _) = text.split_once(after).unwrap();
    let head = format!("{head}{after}");
    let line = head.matches('\n').count();
    let character = head.len() - head.rfind('\n').map_or(0, |end| end + 1);
    let position = json!({"line": line, "character": character});
    let params = json!({"textDocument": {"uri": uri(path)}, "position": position});
    let items = client.request("textDocument/completion", params);
    let label = |one: &Value| one["label"].as_str().unwrap().to_owned();
    items.as_array().unwrap().iter().map(label).collect()
}

#[test]
fn states_of_media_and_literals_in_annotations_are_completed() {
    let here = folder(&[]);
    let mut client = Client::start(here.path());
    let path = here.path().join("P.mo");
    let text = include_str!("../../../data/models/structure_media.mo");
    client.open(&path, text);
    assert_eq!(offered(&mut client, &path, text, "= medium.state."), ["p", "T"]);
    assert_eq!(offered(&mut client, &path, text, "smooth = Smooth."), ["None", "Bezier"]);
    assert_eq!(client.shut_down(), 0);
}

#[test]
fn the_first_examination_of_a_document_is_announced() {
    let here = folder(&[]);
    let mut client = Client::uninitialized(here.path());
    let capabilities = json!({"window": {"workDoneProgress": true}});
    client.request("initialize", json!({"capabilities": capabilities}));
    client.notify("initialized", json!({}));
    let path = here.path().join("M.mo");
    client.open(&path, "model M Real x = 1; end M;");
    let created = client.read().unwrap();
    assert_eq!(created["method"], "window/workDoneProgress/create");
    let begun = client.read().unwrap();
    assert_eq!(begun["params"]["value"]["title"], "Checking M.mo");
    assert!(client.diagnostics(&path, 1).is_empty());
    let ended = client.read().unwrap();
    assert_eq!(ended["params"]["value"]["kind"], "end");
    assert_eq!(ended["params"]["token"], created["params"]["token"]);
    // Not at every change.
    client.change(&path, 2, "model M Real x = 2; end M;");
    assert!(client.diagnostics(&path, 2).is_empty());
    assert_eq!(client.shut_down(), 0);
}
