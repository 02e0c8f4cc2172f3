//! What an editor asks about open documents.

use super::client::{Client, uri};
use crate::support::program::folder;
use serde_json::{Value, json};
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

const CIRCUIT: &str = include_str!("../../../data/models/features_circuit.mo");

/// A server with one document.
struct Open {
    here: TempDir,
    client: Client,
    path: PathBuf,
    text: String,
    version: i32,
}

impl Open {
    fn new(name: &str, text: &str) -> Open {
        let here = folder(&[(name, text)]);
        let mut client = Client::start(here.path());
        let path = here.path().join(name);
        client.open(&path, text);
        Open { here, client, path, text: text.to_owned(), version: 1 }
    }

    fn change(&mut self, text: &str) {
        self.version += 1;
        self.text = text.to_owned();
        self.client.change(&self.path, self.version, text);
    }

    /// The position of the mark `^` behind which `text` continues.
    fn position(&self, marked: &str) -> Value {
        let (before, after) = marked.split_once('^').unwrap();
        let wanted = format!("{before}{after}");
        let found: Vec<usize> = self.text.match_indices(&wanted).map(|(at, _)| at).collect();
        assert_eq!(found.len(), 1, "`{wanted}` is there {} times", found.len());
        position(&self.text, found[0] + before.len())
    }

    fn at(&mut self, method: &str, marked: &str) -> Value {
        let position = self.position(marked);
        let params = json!({"textDocument": {"uri": uri(&self.path)}, "position": position,
            "context": {"includeDeclaration": true, "triggerKind": 1}});
        self.client.request(method, params)
    }

    fn hover(&mut self, marked: &str) -> String {
        let found = self.at("textDocument/hover", marked);
        found["contents"]["value"].as_str().unwrap_or("").to_owned()
    }

    /// Labels of what is offered, in the order of the editor.
    fn completed(&mut self, marked: &str) -> Vec<String> {
        let mut items = self.at("textDocument/completion", marked).as_array().unwrap().clone();
        items.sort_by_key(|item| item["sortText"].as_str().unwrap().to_owned());
        items.iter().map(|item| item["label"].as_str().unwrap().to_owned()).collect()
    }

    /// The line that a definition begins in, without blanks.
    fn definition(&mut self, marked: &str) -> String {
        let found = self.at("textDocument/definition", marked);
        let file = found["uri"].as_str().map(|uri| uri.trim_start_matches("file://").to_owned());
        let Some(file) = file else { return String::new() };
        let text = match Path::new(&file) == self.path {
            true => self.text.clone(),
            false => fs::read_to_string(file).unwrap(),
        };
        let line = found["range"]["start"]["line"].as_u64().unwrap() as usize;
        text.lines().nth(line).unwrap().trim().to_owned()
    }

    fn rename(&mut self, marked: &str, new: &str) -> Value {
        let position = self.position(marked);
        let params = json!({"textDocument": {"uri": uri(&self.path)}, "position": position,
            "newName": new});
        let id = self.client.ask("textDocument/rename", params);
        self.client.response(id)
    }

    /// The document after the changes of an answer to it.
    fn applied(&self, edit: &Value) -> String {
        let changes = edit["documentChanges"].as_array().unwrap().iter();
        let own = changes.filter(|one| one["textDocument"]["uri"] == json!(uri(&self.path)));
        let edits = own.flat_map(|one| one["edits"].as_array().unwrap().clone()).collect();
        applied(&self.text, edits)
    }

    fn actions(&mut self) -> Vec<Value> {
        let diagnostics = self.client.published(&self.path, self.version);
        let range = diagnostics[0]["range"].clone();
        let params = json!({"textDocument": {"uri": uri(&self.path)}, "range": range,
            "context": {"diagnostics": diagnostics}});
        self.client.request("textDocument/codeAction", params).as_array().unwrap().clone()
    }

    fn end(self) {
        assert_eq!(self.client.shut_down(), 0);
    }
}

/// The position of a byte, by counting.
fn position(text: &str, offset: usize) -> Value {
    let head = &text[..offset];
    let start = head.rfind('\n').map_or(0, |end| end + 1);
    let character = head[start..].encode_utf16().count();
    json!({"line": head.matches('\n').count(), "character": character})
}

fn offset(text: &str, position: &Value) -> usize {
    let line = position["line"].as_u64().unwrap() as usize;
    let start: usize = text.split_inclusive('\n').take(line).map(str::len).sum();
    let units = position["character"].as_u64().unwrap() as usize;
    let mut seen = 0;
    for (at, character) in text[start..].char_indices() {
        if seen >= units {
            return start + at;
        }
        seen += character.len_utf16();
    }
    text.len()
}

/// A text after changes, the last first.
fn applied(text: &str, mut edits: Vec<Value>) -> String {
    let start = |edit: &Value| offset(text, &edit["range"]["start"]);
    edits.sort_by_key(|edit| std::cmp::Reverse(start(edit)));
    let mut changed = text.to_owned();
    for edit in edits {
        let range = start(&edit)..offset(text, &edit["range"]["end"]);
        changed.replace_range(range, edit["newText"].as_str().unwrap());
    }
    changed
}

#[test]
fn the_outline_has_classes_and_components() {
    let mut open = Open::new("Circuit.mo", CIRCUIT);
    let params = json!({"textDocument": {"uri": uri(&open.path)}});
    let symbols = open.client.request("textDocument/documentSymbol", params);
    let names = |symbols: &Value| -> Vec<String> {
        let all = symbols.as_array().unwrap().iter();
        all.map(|one| one["name"].as_str().unwrap().to_owned()).collect()
    };
    assert_eq!(names(&symbols), ["Circuit"]);
    let inside = &symbols[0]["children"];
    assert_eq!(names(inside), ["Voltage", "Kind", "Pin", "scaled", "Resistor", "Row"]);
    assert_eq!(names(&inside[1]["children"]), ["linear", "diode"]);
    assert_eq!(names(&inside[4]["children"]), ["R", "kind", "p", "n", "v"]);
    assert_eq!(inside[4]["selectionRange"]["start"], open.position("model ^Resistor \"Ohm's"));
    open.end();
}

#[test]
fn hovers_describe_declarations_with_units_and_values() {
    let mut open = Open::new("Circuit.mo", CIRCUIT);
    let resistance = open.hover("scaled(u = ^R)");
    assert!(resistance.contains("parameter Real R(unit = \"Ohm\") = 100"), "{resistance}");
    assert!(resistance.contains("Resistance") && resistance.contains("unit `Ohm`"), "{resistance}");
    let voltage = open.hover("    ^v = scaled");
    assert!(voltage.contains("Voltage v = p.v - n.v") && voltage.contains("unit `V`"), "{voltage}");
    let class = open.hover("^Resistor r[3]");
    assert!(class.contains("model Circuit.Resistor") && class.contains("One resistor."), "{class}");
    let function = open.hover("v = ^scaled(");
    assert!(function.contains("input Real factor = 2"), "{function}");
    assert!(open.hover("Kind.^linear;").contains("Ohm's law"));
    assert!(open.hover("(^u = R)").contains("input Real u"));
    assert!(open.hover("last(^R = 20").contains("Resistance"));
    assert!(open.hover("connect(r[^i].n").contains("loop variable"));
    assert_eq!(open.hover("\"Electrical ^parts\""), "");
    open.end();
}

#[test]
fn definitions_are_found() {
    let mut open = Open::new("Circuit.mo", CIRCUIT);
    assert_eq!(open.definition("connect(r[3].^n"), "Pin p, n;");
    assert_eq!(open.definition("connect(^r[3]"), "Resistor r[3](each R = 50);");
    assert_eq!(open.definition("    ^Pin p, n"), "connector Pin");
    assert_eq!(open.definition("last(R = 20, ^v("), "Voltage v = p.v - n.v;");
    assert_eq!(open.definition("Kind.^linear;"), CIRCUIT.lines().nth(2).unwrap().trim());
    assert_eq!(open.definition("r[^i + 1]"), "for i in 1:2 loop");
    assert_eq!(open.definition("end ^Row;"), "model Row");
    open.end();
}

#[test]
fn completion_offers_what_is_visible_while_the_text_is_broken() {
    let mut open = Open::new("Circuit.mo", CIRCUIT);
    open.change(&CIRCUIT.replace("    connect(r[3].n, last.p);\n", "    last.\n"));
    assert_eq!(open.completed("    last.^\n"), ["R", "kind", "n", "p", "v"]);
    open.change(&CIRCUIT.replace("    connect(r[3].n, last.p);\n", "    last.p.\n"));
    assert_eq!(open.completed("    last.p.^\n"), ["i", "v"]);
    open.change(&CIRCUIT.replace("kind = Kind.linear;", "kind = Kind."));
    assert_eq!(open.completed("kind = Kind.^"), ["diode", "linear"]);
    open.change(&CIRCUIT.replace("v = scaled(u = R)*p.i;", "v = scaled("));
    assert_eq!(open.completed("v = scaled(^")[..2], ["factor =", "u ="]);
    open.change(&CIRCUIT.replace("last(R = 20, v(start = 1));", "last(R = 20, "));
    let offered = open.completed("last(R = 20, ^");
    assert_eq!(offered[..4], ["kind =", "n =", "p =", "v ="]);
    open.change(&CIRCUIT.replace("v(start = 1));", "v(st"));
    assert!(open.completed("v(st^").iter().any(|label| label == "start ="));
    open.change(&CIRCUIT.replace("    Pin p, n;\n", "    Pin p, n;\n    \n"));
    let offered = open.completed("    Pin p, n;\n    ^\n");
    for name in ["R", "Voltage", "Resistor", "GAPILib", "Real", "sin", "der", "equation"] {
        assert!(offered.iter().any(|label| label == name), "{name}: {offered:?}");
    }
    assert!(offered.iter().position(|l| l == "R") < offered.iter().position(|l| l == "sin"));
    open.change("model M // last.\nend M;\n");
    assert!(open.completed("last.^").is_empty());
    open.end();
}

#[test]
fn references_and_renaming_follow_the_meaning() {
    let mut open = Open::new("Circuit.mo", CIRCUIT);
    let places = open.at("textDocument/references", "    parameter Real ^R(");
    assert_eq!(places.as_array().unwrap().len(), 4);
    let renamed = open.rename("    parameter Real ^R(", "resistance");
    let expected = CIRCUIT
        .replace("Real R(", "Real resistance(")
        .replace("u = R)", "u = resistance)")
        .replace("each R = 50", "each resistance = 50")
        .replace("last(R = 20", "last(resistance = 20");
    assert_eq!(open.applied(&renamed["result"]), expected);
    // The pin of a connector is not that of a resistor.
    let renamed = open.rename("    ^Voltage v;", "Potential");
    let expected = CIRCUIT.replace("type Voltage", "type Potential");
    let expected = expected.replace("Voltage v", "Potential v");
    assert_eq!(open.applied(&renamed["result"]), expected);
    let renamed = open.rename("for ^i in", "k");
    let expected = CIRCUIT.replace("for i", "for k").replace("r[i", "r[k");
    assert_eq!(open.applied(&renamed["result"]), expected);
    for (new, reason) in [("p", "declared already"), ("3x", "identifier"), ("end", "identifier")] {
        let refused = open.rename("    parameter Real ^R(", new);
        assert!(refused["error"]["message"].as_str().unwrap().contains(reason), "{refused}");
    }
    let refused = open.rename("output ^Real y", "R2");
    assert!(refused["error"]["message"].as_str().unwrap().contains("language"), "{refused}");
    open.end();
}

#[test]
fn a_name_is_renamed_in_all_files_of_a_library() {
    let here = folder(&[]);
    let root = here.path().join("Lib");
    fs::create_dir_all(&root).unwrap();
    fs::write(root.join("package.mo"), "within;\npackage Lib\nend Lib;\n").unwrap();
    let part = "within Lib;\nmodel Part\n  parameter Real gain = 1;\nend Part;\n";
    fs::write(root.join("Part.mo"), part).unwrap();
    let user =
        "within Lib;\nmodel User\n  Part part(gain = 2);\n  Real y = part.gain;\nend User;\n";
    fs::write(root.join("User.mo"), user).unwrap();
    let mut client = Client::start(here.path());
    let path = root.join("Part.mo");
    client.open(&path, part);
    let mut open = Open { here, client, path, text: part.to_owned(), version: 1 };
    let renamed = open.rename("Real ^gain", "factor");
    assert_eq!(open.applied(&renamed["result"]), part.replace("gain", "factor"));
    let changes = renamed["result"]["documentChanges"].as_array().unwrap();
    let other = changes.iter().find(|one| one["textDocument"]["uri"] == uri(&root.join("User.mo")));
    let edits = other.unwrap()["edits"].as_array().unwrap().clone();
    assert_eq!(applied(user, edits), user.replace("gain", "factor"));
    // The class has the name of its file.
    let refused = open.rename("model ^Part", "Piece");
    assert!(refused["error"]["message"].as_str().unwrap().contains("file"), "{refused}");
    assert!(open.here.path().exists());
    open.end();
}

#[test]
fn formatting_is_that_of_gapi_fmt() {
    let text =
        "model M\nReal x ( start=1 ) ;\n  Real y;\nequation\nder (x)=-x;\n y = 2*x;\nend M;\n";
    let mut open = Open::new("M.mo", text);
    let params = json!({"textDocument": {"uri": uri(&open.path)},
        "options": {"tabSize": 2, "insertSpaces": true}});
    let edits = open.client.request("textDocument/formatting", params.clone());
    let edits = edits.as_array().unwrap().clone();
    let formatted = applied(text, edits);
    let expected =
        "model M\n  Real x(start=1);\n  Real y;\nequation\n  der(x) = -x;\n  y = 2*x;\nend M;\n";
    assert_eq!(formatted, expected);
    open.change(expected);
    assert_eq!(open.client.request("textDocument/formatting", params.clone()), json!([]));
    open.change("model M Real x end M;");
    assert_eq!(open.client.request("textDocument/formatting", params), json!([]));
    open.end();
}

#[test]
fn helps_are_actions() {
    let text = "model M\n  parameter Real gain = 2;\n  Real x;\nequation\n  x = gian;\nend M;\n";
    let mut open = Open::new("M.mo", text);
    let actions = open.actions();
    let titles: Vec<&str> = actions.iter().map(|one| one["title"].as_str().unwrap()).collect();
    let expected = [
        "Change to `gain`",
        "Declare `gian` as a Real variable",
        "Declare `gian` as a Real parameter",
    ];
    assert_eq!(titles, expected);
    assert_eq!(open.applied(&actions[0]["edit"]), text.replace("gian", "gain"));
    let declared = text.replace("equation", "  parameter Real gian;\nequation");
    assert_eq!(open.applied(&actions[2]["edit"]), declared);
    let unclosed = text.replace("gian;", "gain").replace("Real x;\n", "Real x;\n  Real y;\n");
    open.change(&unclosed);
    let actions = open.actions();
    assert_eq!(actions[0]["title"], "Write `;`");
    assert_eq!(open.applied(&actions[0]["edit"]), unclosed.replace("= gain", "= gain;"));
    open.change(&text.replace("= gian", ":= gain"));
    let actions = open.actions();
    assert_eq!(open.applied(&actions[0]["edit"]), text.replace("gian", "gain"));
    open.end();
}

#[test]
fn units_are_shown_behind_numbers() {
    let mut open = Open::new("Circuit.mo", CIRCUIT);
    let range = json!({"start": {"line": 0, "character": 0}, "end": {"line": 99, "character": 0}});
    let params = json!({"textDocument": {"uri": uri(&open.path)}, "range": range});
    let hints = open.client.request("textDocument/inlayHint", params);
    let shown: Vec<(Value, &str)> = hints
        .as_array()
        .unwrap()
        .iter()
        .map(|hint| (hint["position"].clone(), hint["label"].as_str().unwrap()))
        .collect();
    let expected = ["= 100^ \"Res", "each R = 50^)", "last(R = 20^,"];
    let expected: Vec<(Value, &str)> =
        expected.iter().map(|marked| (open.position(marked), "Ohm")).collect();
    assert_eq!(shown, expected);
    open.end();
}

#[test]
fn colours_follow_the_meaning() {
    let text = "model M // a\n  parameter Real p = 1;\n  Real x = p;\nend M;\n";
    let mut open = Open::new("M.mo", text);
    let params = json!({"textDocument": {"uri": uri(&open.path)}});
    let found = open.client.request("textDocument/semanticTokens/full", params);
    let data: Vec<u64> =
        found["data"].as_array().unwrap().iter().map(|n| n.as_u64().unwrap()).collect();
    let kinds = [
        "namespace",
        "class",
        "type",
        "literal",
        "function",
        "property",
        "variable",
        "keyword",
        "comment",
        "string",
        "number",
    ];
    let (mut line, mut column) = (0, 0);
    let mut shown = Vec::new();
    for token in data.chunks(5) {
        (line, column) =
            if token[0] == 0 { (line, column + token[1]) } else { (line + token[0], token[1]) };
        let start: usize = text.split_inclusive('\n').take(line as usize).map(str::len).sum();
        let start = start + column as usize;
        let word = &text[start..start + token[2] as usize];
        shown.push(format!(
            "{word}:{}{}",
            kinds[token[3] as usize],
            if token[4] & 2 > 0 { "!" } else { "" }
        ));
    }
    assert_eq!(
        shown.join(" "),
        "model:keyword M:class // a:comment parameter:keyword Real:type \
        p:property! =x"
            .replace("=x", "1:number Real:type x:property p:property! end:keyword M:class")
    );
    open.end();
}

#[test]
fn a_client_that_can_little_gets_what_it_understands() {
    let here = folder(&[]);
    let mut client = Client::uninitialized(here.path());
    client.request("initialize", json!({"capabilities": {}}));
    client.notify("initialized", json!({}));
    let path = here.path().join("Circuit.mo");
    client.open(&path, CIRCUIT);
    let (text, version) = (CIRCUIT.to_owned(), 1);
    let mut open = Open { here, client, path, text, version };
    let hover = open.at("textDocument/hover", "scaled(u = ^R)");
    assert_eq!(hover["contents"]["kind"], "plaintext");
    assert!(!hover["contents"]["value"].as_str().unwrap().contains("```"));
    let params = json!({"textDocument": {"uri": uri(&open.path)}});
    let symbols = open.client.request("textDocument/documentSymbol", params);
    assert_eq!(symbols[1]["name"], "Voltage");
    assert_eq!(symbols[1]["containerName"], "Circuit");
    let renamed = open.rename("for ^i in", "k");
    let edits = renamed["result"]["changes"][uri(&open.path)].as_array().unwrap().clone();
    let expected = CIRCUIT.replace("for i", "for k").replace("r[i", "r[k");
    assert_eq!(applied(CIRCUIT, edits), expected);
    open.end();
}
