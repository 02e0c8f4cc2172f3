//! A client of `gapi lsp`: what an editor sends, over standard input and output.

use crate::support::program::command;
use serde_json::{Value, json};
use std::collections::VecDeque;
use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Stdio};
use std::time::{Duration, Instant};

/// Longer than a process takes that ends at once, however busy the machine is.
const FOR_EVER: Duration = Duration::from_secs(120);

/// A running server.
pub struct Client {
    process: Child,
    input: ChildStdin,
    output: BufReader<ChildStdout>,
    last: i64,
    /// Notifications that came while something else was waited for.
    pending: VecDeque<Value>,
}

/// What current editors can do.
fn capabilities() -> Value {
    json!({
        "textDocument": {
            "hover": {"contentFormat": ["markdown"]},
            "completion": {"completionItem": {"documentationFormat": ["markdown"]}},
            "documentSymbol": {"hierarchicalDocumentSymbolSupport": true},
        },
        "workspace": {"workspaceEdit": {"documentChanges": true}},
    })
}

/// The name of a file in the protocol.
pub fn uri(path: &Path) -> String {
    format!("file://{}", path.display())
}

impl Client {
    /// Starts a server in a folder and initializes it.
    pub fn start(folder: &Path) -> Client {
        let mut client = Client::uninitialized(folder);
        client.request("initialize", json!({"capabilities": capabilities(), "processId": null}));
        client.notify("initialized", json!({}));
        client
    }

    pub fn uninitialized(folder: &Path) -> Client {
        let mut command = command(folder, &["lsp"]);
        let command = command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::null());
        let mut process = command.spawn().unwrap();
        let input = process.stdin.take().unwrap();
        let output = BufReader::new(process.stdout.take().unwrap());
        Client { process, input, output, last: 0, pending: VecDeque::new() }
    }

    /// Sends bytes as they are.
    pub fn raw(&mut self, bytes: &[u8]) {
        self.input.write_all(bytes).unwrap();
        self.input.flush().unwrap();
    }

    pub fn send(&mut self, message: &Value) {
        let text = message.to_string();
        self.raw(format!("Content-Length: {}\r\n\r\n{text}", text.len()).as_bytes());
    }

    pub fn notify(&mut self, method: &str, params: Value) {
        self.send(&json!({"jsonrpc": "2.0", "method": method, "params": params}));
    }

    /// Sends a request; its number.
    pub fn ask(&mut self, method: &str, params: Value) -> i64 {
        self.last += 1;
        let id = self.last;
        self.send(&json!({"jsonrpc": "2.0", "id": id, "method": method, "params": params}));
        id
    }

    /// The next message; `None` if the server has ended.
    pub fn read(&mut self) -> Option<Value> {
        let mut length = 0;
        loop {
            let mut line = String::new();
            if self.output.read_line(&mut line).unwrap() == 0 {
                return None;
            }
            match line.trim() {
                "" => break,
                line => {
                    if let Some(number) = line.strip_prefix("Content-Length: ") {
                        length = number.parse().unwrap();
                    }
                }
            }
        }
        let mut bytes = vec![0; length];
        self.output.read_exact(&mut bytes).unwrap();
        Some(serde_json::from_slice(&bytes).unwrap())
    }

    /// The response to a request.
    pub fn response(&mut self, id: i64) -> Value {
        loop {
            let message = self.read().expect("the server has ended");
            if message["id"] == json!(id) && message.get("method").is_none() {
                return message;
            }
            self.pending.push_back(message);
        }
    }

    /// The result of a request that succeeds.
    pub fn request(&mut self, method: &str, params: Value) -> Value {
        let id = self.ask(method, params);
        let response = self.response(id);
        assert!(response.get("error").is_none(), "{method}: {response}");
        response["result"].clone()
    }

    /// The error of a request that does not.
    pub fn refused(&mut self, method: &str, params: Value) -> Value {
        let id = self.ask(method, params);
        let response = self.response(id);
        assert!(response.get("result").is_none(), "{method}: {response}");
        response["error"].clone()
    }

    pub fn open(&mut self, path: &Path, text: &str) {
        let language = match path.extension().and_then(|extension| extension.to_str()) {
            Some("mos") => "mos",
            Some("toml") => "toml",
            _ => "modelica",
        };
        let document =
            json!({"uri": uri(path), "languageId": language, "version": 1, "text": text});
        self.notify("textDocument/didOpen", json!({"textDocument": document}));
    }

    pub fn change(&mut self, path: &Path, version: i32, text: &str) {
        let document = json!({"uri": uri(path), "version": version});
        let changes = json!([{"text": text}]);
        let params = json!({"textDocument": document, "contentChanges": changes});
        self.notify("textDocument/didChange", params);
    }

    pub fn close(&mut self, path: &Path) {
        let params = json!({"textDocument": {"uri": uri(path)}});
        self.notify("textDocument/didClose", params);
    }

    /// The diagnostics of a version of a document, as `line:from-to code message`.
    pub fn diagnostics(&mut self, path: &Path, version: i32) -> Vec<String> {
        self.published(path, version).iter().map(summary).collect()
    }

    /// The diagnostics of a version of a document.
    pub fn published(&mut self, path: &Path, version: i32) -> Vec<Value> {
        let is_wanted = |message: &Value| {
            message["method"] == "textDocument/publishDiagnostics"
                && message["params"]["uri"] == json!(uri(path))
                && message["params"]["version"] == json!(version)
        };
        let message = match self.pending.iter().position(is_wanted) {
            Some(at) => self.pending.remove(at).unwrap(),
            None => loop {
                let message = self.read().expect("the server has ended");
                if is_wanted(&message) {
                    break message;
                }
                self.pending.push_back(message);
            },
        };
        message["params"]["diagnostics"].as_array().unwrap().clone()
    }

    /// What is published next for a document, for whatever version.
    pub fn next_published(&mut self, path: &Path) -> Value {
        let is_wanted = |message: &Value| {
            message["method"] == "textDocument/publishDiagnostics"
                && message["params"]["uri"] == json!(uri(path))
        };
        loop {
            let next = match self.pending.iter().position(is_wanted) {
                Some(at) => self.pending.remove(at),
                None => self.read(),
            };
            let message = next.expect("the server has ended");
            if is_wanted(&message) {
                return message["params"].clone();
            }
            self.pending.push_back(message);
        }
    }

    /// Ends the connection as the protocol says; the exit code.
    pub fn shut_down(mut self) -> i32 {
        self.request("shutdown", Value::Null);
        self.notify("exit", Value::Null);
        self.process.wait().unwrap().code().unwrap()
    }

    /// The exit code of the process, which has to end by itself while the client does not read.
    pub fn ends(&mut self) -> i32 {
        let begun = Instant::now();
        loop {
            if let Some(status) = self.process.try_wait().unwrap() {
                return status.code().unwrap();
            }
            if begun.elapsed() > FOR_EVER {
                self.process.kill().unwrap();
                panic!("the server goes on");
            }
            std::thread::sleep(Duration::from_millis(10));
        }
    }

    /// Reads no more, and says so to the system, but keeps the connection for what it sends.
    pub fn stop_reading(self) -> Client {
        let (output, _) = std::io::pipe().unwrap();
        let output: std::process::ChildStdout = std::os::fd::OwnedFd::from(output).into();
        Client { output: BufReader::new(output), ..self }
    }

    /// Ends the connection without a word; the exit code.
    pub fn hang_up(self) -> i32 {
        let Client { mut process, input, output, .. } = self;
        drop((input, output));
        process.wait().unwrap().code().unwrap()
    }
}

fn summary(diagnostic: &Value) -> String {
    let (start, end) = (&diagnostic["range"]["start"], &diagnostic["range"]["end"]);
    let line = &start["line"];
    let code = diagnostic["code"].as_str().unwrap();
    let message = diagnostic["message"].as_str().unwrap().replace('\n', " | ");
    let until = match start["line"] == end["line"] {
        true => end["character"].to_string(),
        false => format!("{}:{}", end["line"], end["character"]),
    };
    format!("{line}:{}-{until} {code}: {message}", start["character"])
}
