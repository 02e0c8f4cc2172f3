//! `gapi mcp` as an assistant meets it: the program itself, over standard input and output.

use crate::support::program::{command, folder};
use serde_json::{Value, json};
use std::fs;
use std::io::{BufRead as _, BufReader, Write as _};
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Stdio};

const DECAY: &str = "model Decay \"A quantity that decays\"
  parameter Real k = 1;
  Real x(start = 1, fixed = true);
equation
  der(x) = -k*x;
  annotation(experiment(StopTime = 2), Documentation(info = \"<p>After a fourth of a week half is gone.</p>\"));
end Decay;
";
const PROBLEM: &str = "\
model = \"Decay\"
files = [\"Decay.mo\"]
[parameters]
k = { min = 0.1, max = 10 }
[[experiment]]
data = \"data.csv\"
x = \"time\"
outputs = { x = \"x\" }
";
const DATA: &str = "time,x\n0.5,0.37\n1,0.13\n1.5,0.052\n2,0.017\n";
/// It takes longer than any test.
const SLOW: &str =
    "model Slow Real x(start = 0, fixed = true); equation der(x) = sin(1e6*time); end Slow;";

/// A running server.
struct Server {
    process: Child,
    input: ChildStdin,
    output: BufReader<ChildStdout>,
    last: u64,
}

impl Server {
    fn start(folder: &Path) -> Server {
        let mut server = Server::uninitialized(folder);
        let params = json!({"protocolVersion": "2025-06-18", "capabilities": {},
            "clientInfo": {"name": "test", "version": "1"}});
        let result = server.request("initialize", params);
        assert_eq!(result["protocolVersion"], "2025-06-18");
        assert_eq!(result["serverInfo"]["name"], "gapi");
        server.send(&json!({"jsonrpc": "2.0", "method": "notifications/initialized"}).to_string());
        server
    }

    fn uninitialized(folder: &Path) -> Server {
        let mut command = command(folder, &["mcp"]);
        let mut process = command.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
        let input = process.stdin.take().unwrap();
        let output = BufReader::new(process.stdout.take().unwrap());
        Server { process, input, output, last: 0 }
    }

    fn send(&mut self, line: &str) {
        writeln!(self.input, "{line}").unwrap();
    }

    fn read(&mut self) -> Value {
        let mut line = String::new();
        self.output.read_line(&mut line).unwrap();
        serde_json::from_str(&line).unwrap()
    }

    fn ask(&mut self, method: &str, params: Value) -> u64 {
        self.last += 1;
        let id = self.last;
        self.send(
            &json!({"jsonrpc": "2.0", "id": id, "method": method, "params": params}).to_string(),
        );
        id
    }

    fn request(&mut self, method: &str, params: Value) -> Value {
        let id = self.ask(method, params);
        let answer = self.read();
        assert_eq!(answer["id"], json!(id), "{answer}");
        answer["result"].clone()
    }

    /// What a tool answers, and whether that is an error.
    fn call(&mut self, name: &str, arguments: Value) -> (String, bool) {
        let result = self.request("tools/call", json!({"name": name, "arguments": arguments}));
        let text = result["content"][0]["text"].as_str().unwrap().to_owned();
        (text, result["isError"].as_bool().unwrap())
    }

    /// Closes the connection; the exit code.
    fn end(self) -> i32 {
        let Server { mut process, input, .. } = self;
        drop(input);
        process.wait().unwrap().code().unwrap()
    }
}

#[test]
fn an_assistant_checks_simulates_identifies_and_looks_up() {
    let here = folder(&[("Decay.mo", DECAY), ("fit.toml", PROBLEM), ("data.csv", DATA)]);
    let mut server = Server::start(here.path());
    let tools = server.request("tools/list", json!({}));
    let names: Vec<&str> = tools["tools"]
        .as_array()
        .unwrap()
        .iter()
        .map(|one| one["name"].as_str().unwrap())
        .collect();
    assert_eq!(names, ["check", "simulate", "identify", "explain", "search"]);
    let (text, is_error) = server.call("check", json!({"files": ["Decay.mo"]}));
    assert!(!is_error && text.contains("1 model, 0 with errors"), "{text}");
    let arguments = json!({"model": "Decay", "files": ["Decay.mo"], "parameters": {"k": 2},
        "variables": ["x"], "intervals": 4, "stop_time": 1});
    let (text, is_error) = server.call("simulate", arguments);
    let last = text.lines().rfind(|line| line.starts_with("1,")).unwrap();
    let value: f64 = last[2..].parse().unwrap();
    assert!(!is_error && (value - 0.135_335_283).abs() < 1e-4, "{text}");
    assert!(here.path().join("results/mcp/Decay-1.csv").is_file());
    let (text, is_error) = server.call("identify", json!({"problem": "fit.toml"}));
    assert!(!is_error && text.contains("95 % interval"), "{text}");
    let (text, is_error) = server.call("explain", json!({"code": "unknown-name"}));
    assert!(!is_error && text.contains("What to do"), "{text}");
    let (text, _) = server.call("search", json!({"query": "half fourth"}));
    assert!(text.contains("model Decay: A quantity that decays"), "{text}");
    let (text, _) =
        server.call("search", json!({"query": "GAPILib.Impedance.ConstantPhaseElement"}));
    assert!(text.starts_with("block GAPILib.Impedance.ConstantPhaseElement"), "{text}");
    assert_eq!(server.end(), 0);
}

#[test]
fn what_is_wrong_is_answered() {
    let here = folder(&[("M.mo", "model M Real x = y; end M;")]);
    let mut server = Server::start(here.path());
    let (text, is_error) = server.call("check", json!({"files": ["M.mo"]}));
    assert!(is_error && text.contains("error[unknown-name]"), "{text}");
    let (text, is_error) = server.call("check", json!({"fils": ["M.mo"]}));
    assert!(is_error && text.contains("these are files, model"), "{text}");
    let (text, is_error) = server.call("simulate", json!({"files": ["M.mo"]}));
    assert!(is_error && text.contains("`model` is missing"), "{text}");
    let id = server.ask("tools/call", json!({"name": "delete", "arguments": {}}));
    let answer = server.read();
    assert_eq!((&answer["id"], &answer["error"]["code"]), (&json!(id), &json!(-32602)));
    server.ask("resources/list", json!({}));
    assert_eq!(server.read()["error"]["code"], -32601);
    for (line, code) in [
        ("nonsense", -32700),
        ("[1]", -32600),
        ("{\"id\": 1}", -32600),
        ("{\"id\": null, \"method\": \"ping\"}", -32600),
    ] {
        server.send(line);
        assert_eq!(server.read()["error"]["code"], code, "{line}");
    }
    assert_eq!(server.request("ping", json!({})), json!({}));
    assert_eq!(server.end(), 0);
}

/// An assistant names files that its user has not named.
#[test]
fn files_outside_of_the_working_folder_are_refused() {
    let home = folder(&[("outside.mo", DECAY), ("outside.csv", DATA)]);
    let here = home.path().join("work");
    fs::create_dir(&here).unwrap();
    fs::write(here.join("fit.toml"), PROBLEM.replace("data.csv", "../outside.csv")).unwrap();
    fs::write(here.join("Decay.mo"), DECAY).unwrap();
    let mut server = Server::start(&here);
    let absolute = home.path().join("outside.mo").display().to_string();
    for file in ["../outside.mo", &absolute, "/etc/hostname", "--help"] {
        let (text, is_error) = server.call("check", json!({"files": [file]}));
        assert!(is_error && !text.contains("Decay:"), "{file}: {text}");
    }
    // Nor is it said whether there is such a file.
    let (there, _) = server.call("check", json!({"files": ["../outside.mo"]}));
    let (missing, _) = server.call("check", json!({"files": ["../missing.mo"]}));
    assert_eq!(there.replace("outside.mo", "missing.mo"), missing);
    // Nor by a problem file, or by a link.
    let (text, is_error) = server.call("identify", json!({"problem": "fit.toml"}));
    assert!(is_error && text.contains("outside.csv"), "{text}");
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink("../outside.mo", here.join("link.mo")).unwrap();
        let (text, is_error) = server.call("check", json!({"files": ["link.mo"]}));
        assert!(is_error && text.contains("lies outside"), "{text}");
        // Results do not leave the folder by one, either.
        fs::create_dir_all(here.join("results")).unwrap();
        std::os::unix::fs::symlink(home.path(), here.join("results/mcp")).unwrap();
        let arguments = json!({"model": "Decay", "files": ["Decay.mo"]});
        let (text, is_error) = server.call("simulate", arguments);
        assert!(is_error && text.contains("link"), "{text}");
        assert!(!home.path().join("Decay-1.csv").exists());
    }
    assert_eq!(server.end(), 0);
}

/// Calls at the same time answer each with its own rows.
#[test]
fn each_simulation_has_a_file_of_its_own() {
    let here = folder(&[("Decay.mo", DECAY)]);
    let mut server = Server::start(here.path());
    let ask = |server: &mut Server, k: u32| {
        let arguments = json!({"model": "Decay", "files": ["Decay.mo"], "parameters": {"k": k},
            "variables": ["k"], "intervals": 2});
        server.ask("tools/call", json!({"name": "simulate", "arguments": arguments}))
    };
    let ids: Vec<(u64, u32)> = (1..=6).map(|k| (ask(&mut server, k), k)).collect();
    for _ in &ids {
        let answer = server.read();
        let (_, k) = ids.iter().find(|(id, _)| answer["id"] == json!(id)).unwrap();
        let text = answer["result"]["content"][0]["text"].as_str().unwrap();
        assert!(text.contains(&format!("\n1,{k}\n")), "{k}: {text}");
    }
    assert_eq!(fs::read_dir(here.path().join("results/mcp")).unwrap().count(), 6);
    // A call that fails leaves no empty file.
    let arguments = json!({"model": "None", "files": ["Decay.mo"]});
    assert!(server.call("simulate", arguments).1);
    assert_eq!(fs::read_dir(here.path().join("results/mcp")).unwrap().count(), 6);
    assert_eq!(server.end(), 0);
}

#[test]
fn a_call_can_be_stopped() {
    let here = folder(&[("Slow.mo", SLOW)]);
    let mut server = Server::start(here.path());
    let arguments = json!({"model": "Slow", "files": ["Slow.mo"], "stop_time": 1000});
    let id = server.ask("tools/call", json!({"name": "simulate", "arguments": arguments}));
    // Others are answered meanwhile.
    assert_eq!(server.request("ping", json!({})), json!({}));
    let cancelled = json!({"jsonrpc": "2.0", "method": "notifications/cancelled",
        "params": {"requestId": id}});
    server.send(&cancelled.to_string());
    // A call that was cancelled has no answer: the next one is that of another.
    let (text, _) = server.call("explain", json!({"code": "unknown-name"}));
    assert!(text.starts_with("unknown-name"), "{text}");
    // The end of the connection stops what runs.
    let arguments = json!({"model": "Slow", "files": ["Slow.mo"], "stop_time": 1000});
    server.ask("tools/call", json!({"name": "simulate", "arguments": arguments}));
    assert_eq!(server.end(), 0);
}

#[test]
fn answers_speak_of_the_arguments_of_the_tools() {
    let here = folder(&[("in/Decay.mo", DECAY), ("in/fit.toml", PROBLEM), ("in/data.csv", DATA)]);
    fs::write(here.path().join("Else.mo"), "model Else\nend Else;\n").unwrap();
    let inside = here.path().join("in");
    std::os::unix::fs::symlink("../Else.mo", inside.join("Link.mo")).unwrap();
    let mut server = Server::start(&inside);
    // A link out of the folder is passed over.
    let (text, is_error) = server.call("check", json!({"files": ["."]}));
    assert!(!is_error && text.contains("Decay: "), "{text}");
    assert!(text.contains("Link.mo` is passed over"), "{text}");
    let (text, is_error) = server.call("check", json!({}));
    assert!(is_error && text.contains("give `files`") && !text.contains("Usage"), "{text}");
    // Options are arguments.
    let (text, is_error) =
        server.call("simulate", json!({"model": "Decay", "files": ["Decay.mo"], "tolerance": -1}));
    assert!(is_error && !text.contains("--"), "{text}");
    let both = json!({"problem": "fit.toml", "resume": true, "fresh": true});
    let (text, is_error) = server.call("identify", both);
    assert!(is_error && text.contains("'resume'") && !text.contains("--"), "{text}");
    assert_eq!(server.end(), 0);
}

#[test]
fn progress_is_reported_on_request_and_batches_are_refused() {
    let here = folder(&[("Slow.mo", SLOW)]);
    let mut server = Server::start(here.path());
    server.send("[{\"jsonrpc\": \"2.0\", \"id\": 1, \"method\": \"ping\"}]");
    let refused = server.read();
    assert!(refused["error"]["message"].as_str().unwrap().contains("batches"), "{refused}");
    let arguments = json!({"model": "Slow", "files": ["Slow.mo"], "stop_time": 1000});
    let params =
        json!({"name": "simulate", "arguments": arguments, "_meta": {"progressToken": "t"}});
    let id = server.ask("tools/call", params);
    let [first, second] = [server.read(), server.read()];
    for report in [&first, &second] {
        assert_eq!(report["method"], "notifications/progress", "{report}");
        assert_eq!(report["params"]["progressToken"], "t");
    }
    let seconds = |report: &Value| report["params"]["progress"].as_f64().unwrap();
    assert!(seconds(&first) < seconds(&second));
    let cancelled = json!({"requestId": id});
    let params =
        json!({"jsonrpc": "2.0", "method": "notifications/cancelled", "params": cancelled});
    server.send(&params.to_string());
    assert_eq!(server.end(), 0);
}
