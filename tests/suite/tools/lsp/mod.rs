//! The language server as an editor meets it: the program itself, over standard input and output.

mod client;
#[cfg(unix)]
mod ending;
mod features;
mod libraries;
mod structure;

use crate::support::program::folder;
use client::{Client, uri};
use serde_json::{Value, json};
use std::fs;

const RESISTOR: &str = "\
model Resistor \"Ohm's law\"
  parameter Real R(unit = \"Ohm\") = 100 \"Resistance\";
  Real v(unit = \"V\");
  Real i(unit = \"A\");
equation
  v = R*i;
  v = 10*time;
end Resistor;
";

#[test]
fn the_protocol_is_followed_from_initialize_to_exit() {
    let here = folder(&[]);
    let mut client = Client::uninitialized(here.path());
    assert_eq!(client.refused("textDocument/hover", json!({}))["code"], -32002);
    let result = client.request("initialize", json!({"capabilities": {}}));
    assert_eq!(result["serverInfo"]["name"], "gapi");
    client.notify("initialized", json!({}));
    assert_eq!(client.refused("initialize", json!({"capabilities": {}}))["code"], -32600);
    assert_eq!(client.refused("textDocument/unheardOf", json!({}))["code"], -32601);
    client.request("shutdown", Value::Null);
    assert_eq!(client.refused("textDocument/hover", json!({}))["code"], -32600);
    client.notify("exit", Value::Null);
    assert!(client.read().is_none());
    assert_eq!(client.hang_up(), 0);
    assert_eq!(Client::start(here.path()).hang_up(), 1);
    assert_eq!(Client::start(here.path()).shut_down(), 0);
}

#[test]
fn malformed_messages_do_not_end_the_server() {
    let here = folder(&[]);
    let mut client = Client::start(here.path());
    client.raw(b"Content-Length: 7\r\n\r\nnothing");
    client.raw(b"nonsense: 1\r\n\r\n");
    client.raw(b"Content-Length: 99999999999999999999\r\n\r\n");
    client.send(&json!({"jsonrpc": "2.0"}));
    client.notify("textDocument/didOpen", json!({"textDocument": 1}));
    client.notify("textDocument/didChange", json!([]));
    client.notify("textDocument/unheardOf", json!({}));
    client.change(&here.path().join("never_opened.mo"), 2, "model M end M;");
    let path = here.path().join("M.mo");
    client.open(&path, "model M Real x = y; end M;");
    assert_eq!(client.diagnostics(&path, 1).len(), 1);
    assert_eq!(client.shut_down(), 0);
}

#[test]
fn names_in_functions_and_partial_models_are_looked_up() {
    let here = folder(&[]);
    let mut client = Client::start(here.path());
    let path = here.path().join("Parts.mo");
    let text = "package Parts
  function f input Real u; output Real y = k*u; end f;
  partial model A Real x; Missing m; equation x = f(v = 1); end A;
end Parts;
";
    client.open(&path, text);
    let found = client.diagnostics(&path, 1);
    let codes =
        ["unknown-name: `k`", "unknown-class: there is no class `Missing`", "wrong-arguments"];
    for code in codes {
        assert_eq!(found.iter().filter(|one| one.contains(code)).count(), 1, "{code}: {found:?}");
    }
    assert_eq!(found.len(), codes.len(), "{found:?}");
    assert_eq!(client.shut_down(), 0);
}

#[test]
fn diagnostics_follow_what_is_typed() {
    let here = folder(&[]);
    let mut client = Client::start(here.path());
    let path = here.path().join("Resistor.mo");
    client.open(&path, RESISTOR);
    assert_eq!(client.diagnostics(&path, 1), Vec::<String>::new());
    client.change(&path, 2, &RESISTOR.replace("R*i", "r*i"));
    assert_eq!(
        client.diagnostics(&path, 2),
        ["5:6-7 unknown-name: `r` is not declared | help: did you mean `R`?"]
    );
    client.change(&path, 3, &RESISTOR.replace("  v = 10*time;\n", ""));
    let found = client.diagnostics(&path, 3);
    assert!(found.len() == 1 && found[0].contains("unbalanced-model"), "{found:?}");
    client.change(&path, 4, &RESISTOR.replace("R*i;", "R*i"));
    let found = client.diagnostics(&path, 4);
    assert_eq!(found.len(), 1);
    assert!(found[0].starts_with("5:8-9 missing-semicolon"), "{found:?}");
    client.change(&path, 5, RESISTOR);
    assert!(client.diagnostics(&path, 5).is_empty());
    client.close(&path);
    assert_eq!(client.shut_down(), 0);
}

/// Models are examined one after the other, which may take long; what is wrong with the text is shown at
/// once.
#[test]
fn what_is_wrong_with_a_text_is_shown_before_models_are_examined() {
    let here = folder(&[]);
    let mut client = Client::start(here.path());
    let path = here.path().join("M.mo");
    // One equation is missing in B.
    let text = "model A input constant Real x; end A;\nmodel B Real x; Real z = 2*x; end B;\n";
    client.open(&path, text);
    let first = client.next_published(&path);
    // Not all that is known of this version.
    assert_eq!(first["version"], Value::Null);
    let codes = |shown: &Value| -> Vec<String> {
        let found = shown["diagnostics"].as_array().unwrap();
        found.iter().map(|one| one["code"].as_str().unwrap().to_owned()).collect()
    };
    assert_eq!(codes(&first), ["illegal-prefix"]);
    let second = client.next_published(&path);
    assert_eq!(second["version"], json!(1));
    assert_eq!(codes(&second), ["illegal-prefix", "unbalanced-model"]);
    // What is known already does not give way for a moment to less.
    client.change(&path, 2, &text.replace("B Real", "B  Real"));
    assert_eq!(client.next_published(&path)["version"], json!(2));
    // What is mended is shown at once.
    client.change(&path, 3, &text.replace("constant ", ""));
    let third = client.next_published(&path);
    assert_eq!((&third["version"], codes(&third)), (&Value::Null, Vec::new()));
    assert_eq!(codes(&client.next_published(&path)), ["unbalanced-model"]);
    // Of a new text without errors there is nothing to be shown before.
    let other = here.path().join("C.mo");
    client.open(&other, "model C Real x; Real z = 2*x; end C;\n");
    assert_eq!(client.next_published(&other)["version"], json!(1));
    client.shut_down();
}

#[test]
fn places_count_utf16_units() {
    let here = folder(&[]);
    let mut client = Client::start(here.path());
    let path = here.path().join("M.mo");
    let text = "model M \"\u{1f600} e\u{301}\"\r\n  Real x \"\u{1f468}\u{200d}\u{1f4bb}\" = y;\r\nend M;\r\n";
    let text = text.replace(" = y;", ";").replace("Real x", "Real 'x\u{1f600}' = y");
    client.open(&path, &text);
    let found = client.diagnostics(&path, 1);
    assert_eq!(found, ["1:15-16 unknown-name: `y` is not declared"], "{text}");
    // A change inside the line, behind the characters of two units.
    let range = json!({"start": {"line": 1, "character": 15}, "end": {"line": 1, "character": 16}});
    let params = json!({"textDocument": {"uri": uri(&path), "version": 2},
        "contentChanges": [{"range": range, "text": "1"}]});
    client.notify("textDocument/didChange", params);
    assert!(client.diagnostics(&path, 2).is_empty());
    assert_eq!(client.shut_down(), 0);
}

#[test]
fn unsaved_text_counts_in_other_documents_too() {
    let here = folder(&[]);
    let root = here.path().join("Lib");
    fs::create_dir_all(root.join("Parts")).unwrap();
    fs::write(root.join("package.mo"), "within;\npackage Lib\nend Lib;\n").unwrap();
    fs::write(root.join("Parts/package.mo"), "within Lib;\npackage Parts\nend Parts;\n").unwrap();
    let part = "within Lib.Parts;\nmodel Part\n  parameter Real a = 1;\n  Real x = a;\nend Part;\n";
    fs::write(root.join("Parts/Part.mo"), part).unwrap();
    let user = "within Lib;\nmodel User\n  Parts.Part part(b = 2);\nend User;\n";
    fs::write(root.join("User.mo"), user).unwrap();
    let mut client = Client::start(here.path());
    let (part_path, user_path) = (root.join("Parts/Part.mo"), root.join("User.mo"));
    client.open(&user_path, user);
    let found = client.diagnostics(&user_path, 1);
    assert!(found.len() == 1 && found[0].contains("unknown-element"), "{found:?}");
    // The other document gets what is missing, unsaved; the first one is examined again.
    client.open(&part_path, &part.replace("Real a = 1;", "Real a = 1;\n  parameter Real b = 3;"));
    assert!(client.diagnostics(&part_path, 1).is_empty());
    assert!(client.diagnostics(&user_path, 1).is_empty());
    // Closed without saving, the file counts again.
    client.close(&part_path);
    client.change(&user_path, 2, user);
    assert_eq!(client.diagnostics(&user_path, 2).len(), 1);
    // A package without its classes in other files.
    let package = root.join("package.mo");
    client.open(&package, "within;\npackage Lib \"with a description\"\nend Lib;\n");
    assert!(client.diagnostics(&package, 1).is_empty());
    client.change(&user_path, 3, &user.replace("b = 2", "a = 2"));
    assert!(client.diagnostics(&user_path, 3).is_empty());
    // What the package declares, unsaved, is seen by classes that are not open.
    fs::write(root.join("Other.mo"), "within Lib;\nmodel Other\n  Real z = c;\nend Other;\n")
        .unwrap();
    let changes = json!({"changes": [{"uri": uri(&root.join("Other.mo")), "type": 1}]});
    client.notify("workspace/didChangeWatchedFiles", changes);
    let with_other = user.replace("Parts.Part part(b = 2)", "Other other");
    client.change(&user_path, 4, &with_other);
    let found = client.diagnostics(&user_path, 4);
    assert!(found.len() == 1 && found[0].contains("`c` is not declared"), "{found:?}");
    client.change(&package, 2, "within;\npackage Lib\n  constant Real c = 3;\nend Lib;\n");
    client.change(&user_path, 5, &with_other);
    assert!(client.diagnostics(&user_path, 5).is_empty());
    // Packages inside each other, both open.
    let parts = root.join("Parts/package.mo");
    client.open(&parts, "within Lib;\npackage Parts\n  constant Real d = c;\nend Parts;\n");
    assert!(client.diagnostics(&parts, 1).is_empty());
    client.change(&package, 3, "within;\npackage Lib\n  constant Real c = 4;\nend Lib;\n");
    client.change(&user_path, 6, &user.replace("b = 2", "a = Parts.d"));
    assert!(client.diagnostics(&user_path, 6).is_empty());
    assert_eq!(client.shut_down(), 0);
}

#[test]
fn scripts_find_models_as_a_run_does() {
    let here = folder(&[]);
    fs::create_dir_all(here.path().join("scripts")).unwrap();
    fs::create_dir_all(here.path().join("models")).unwrap();
    let twice = "function Twice\n  input Real u;\n  output Real y = 2*u;\nend Twice;\n";
    fs::write(here.path().join("models/Twice.mo"), twice).unwrap();
    let elsewhere = folder(&[]);
    let mut client = Client::start(elsewhere.path());
    let path = here.path().join("scripts/run.mos");
    client.open(&path, "x = Twice(1)\ny = Thrice(1)\n");
    let found = client.diagnostics(&path, 1);
    assert!(found.len() == 1 && found[0].contains("Thrice"), "{found:?}");
    let position = json!({"line": 0, "character": 6});
    let params = json!({"textDocument": {"uri": uri(&path)}, "position": position});
    let place = client.request("textDocument/definition", params);
    assert_eq!(place["uri"], uri(&here.path().join("models/Twice.mo")));
    assert_eq!(client.shut_down(), 0);
}

#[test]
fn scripts_are_checked_before_they_run() {
    let here = folder(&[
        ("parts.mo", "model Part\n  Real x = 1;\nend Part;\n"),
        ("init.mos", "function twice\n  input Real u;\n  output Real y = 2*u;\nend twice;\n"),
    ]);
    let mut client = Client::start(here.path());
    let path = here.path().join("run.mos");
    let text = "RunScript(\"init.mos\")\nopenModel(\"parts.mo\")\nx = twice(sin(1))\n\
                simulateModel(\"Part\", stopTme = x)\nsimulateModl(\"Part\")\n";
    client.open(&path, text);
    let found = client.diagnostics(&path, 1);
    assert_eq!(found.len(), 2, "{found:?}");
    assert!(
        found[0].starts_with("3:22-29 wrong-arguments: `simulateModel` has no input `stopTme`")
    );
    assert!(found[0].contains("did you mean `stopTime`?"), "{}", found[0]);
    assert_eq!(
        found[1],
        "4:0-12 unknown-function: there is no function `simulateModl` | help: did you mean \
         `simulateModel`?"
    );
    // What another script defines is known only when it runs.
    client.change(&path, 2, &text.replace("\"init.mos\"", "name"));
    assert_eq!(client.diagnostics(&path, 2).len(), 1);
    client.change(&path, 3, "x = (1;\ny = 2\n");
    assert_eq!(client.diagnostics(&path, 3).len(), 1);
    client.change(&path, 4, "#1\ndouble table(2, 2)\n1 2\n3 4\n");
    assert!(client.diagnostics(&path, 4).is_empty());
    assert_eq!(client.shut_down(), 0);
}

#[test]
fn what_an_editor_can_do_does_not_end_the_server() {
    let here = folder(&[]);
    let mut client = Client::start(here.path());
    let path = here.path().join("gone/M.mo");
    // A document whose file was deleted, and one without a file.
    client.open(&path, "model M\n  Real x = 1;\nend M;\n");
    assert!(client.diagnostics(&path, 1).is_empty());
    let untitled = json!({"uri": "untitled:Untitled-1", "languageId": "modelica", "version": 1,
        "text": "model U\n  Real x = y;\nend U;\n"});
    client.notify("textDocument/didOpen", json!({"textDocument": untitled}));
    let params = json!({"textDocument": {"uri": "untitled:Untitled-1"}});
    let symbols = client.request("textDocument/documentSymbol", params);
    assert_eq!(symbols[0]["name"], "U");
    // Every prefix of a text, as it is typed.
    for version in 2..(RESISTOR.len() as i32) {
        client.change(&path, version, &RESISTOR[..version as usize]);
        let position = json!({"line": 99, "character": 0});
        let params = json!({"textDocument": {"uri": uri(&path)}, "position": position});
        client.ask("textDocument/completion", params);
    }
    let last = RESISTOR.len() as i32;
    client.change(&path, last, RESISTOR);
    assert!(client.diagnostics(&path, last).is_empty());
    // Cancelled, and for what is not open.
    let id = client.ask(
        "textDocument/hover",
        json!({"textDocument": {"uri": uri(&path)},
        "position": {"line": 0, "character": 0}}),
    );
    client.notify("$/cancelRequest", json!({"id": id}));
    let answer = client.response(id);
    assert!(answer.get("result").is_some() || answer["error"]["code"] == -32800, "{answer}");
    let nowhere = json!({"textDocument": {"uri": "file:///nowhere.mo"}});
    assert_eq!(client.refused("textDocument/documentSymbol", nowhere)["code"], -32803);
    // A text that is deeper and longer than any.
    client.change(&path, last + 1, &"(".repeat(100_000));
    assert_eq!(client.diagnostics(&path, last + 1).len(), 1);
    client.change(&path, last + 2, &format!("model M\n{}end M;\n", "  Real x\n".repeat(30_000)));
    assert!(!client.diagnostics(&path, last + 2).is_empty());
    let changes = json!({"changes": [{"uri": uri(&here.path().join("Other.mo")), "type": 3}]});
    client.notify("workspace/didChangeWatchedFiles", changes);
    client.change(&path, last + 3, RESISTOR);
    assert!(client.diagnostics(&path, last + 3).is_empty());
    assert_eq!(client.shut_down(), 0);
}

/// An opened script names files that its user has not named: what lies outside of its folder is not
/// read, wherever links lead.
#[cfg(unix)]
#[test]
fn scripts_show_nothing_from_outside_of_their_folder() {
    let home = folder(&[("outside.mo", "model HiddenPlace \"a secret\" end HiddenPlace;")]);
    let here = home.path().join("work");
    fs::create_dir(&here).unwrap();
    fs::write(here.join("inside.mo"), "model HiddenNothing end HiddenNothing;").unwrap();
    std::os::unix::fs::symlink("../outside.mo", here.join("link.mo")).unwrap();
    let absolute = home.path().join("outside.mo").display().to_string();
    let mut client = Client::start(&here);
    for (number, file) in ["../outside.mo", &absolute, "link.mo", "inside.mo"].iter().enumerate() {
        let path = here.join(format!("job{number}.mos"));
        client.open(&path, &format!("loadFile(\"{file}\")\nHidden"));
        // Files are read when the document is examined.
        client.published(&path, 1);
        let position = json!({"line": 1, "character": 6});
        let params = json!({"textDocument": {"uri": uri(&path)}, "position": position});
        let offered = client.request("textDocument/completion", params).to_string();
        assert!(!offered.contains("HiddenPlace"), "{file}");
        assert_eq!(offered.contains("HiddenNothing"), *file == "inside.mo", "{file}");
    }
    assert_eq!(client.shut_down(), 0);
}
