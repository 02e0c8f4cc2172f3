//! `gapi mcp`: tools for assistants by the Model Context Protocol
//! ([2025-06-18](https://modelcontextprotocol.io/specification/2025-06-18)), JSON-RPC 2.0 with one message
//! on each line of standard input and output.
//!
//! Each call of a tool is a command of this program in a process of its own, with the permissions that
//! `gapi mcp` was started with: an assistant can do no more than the command line in this folder, names
//! files of this folder and of libraries alone, and what it has started can be stopped.

mod arguments;
mod calls;
mod process;
mod search;
mod tools;

use super::options::{Global, seconds};
use super::terminal;
use calls::Calls;
use clap::Args;
use serde_json::{Value, json};
use std::io::{self, BufRead};
use std::process::ExitCode;

/// Arguments of `gapi mcp`.
#[derive(Debug, Args)]
#[command(after_help = "\
Example:
  gapi mcp --library ~/libraries

An assistant starts it in the folder of a project, such as by these settings:
  { \"mcpServers\": { \"gapi\": { \"command\": \"gapi\", \"args\": [\"mcp\"] } } }

Its tools check and simulate models, identify parameters, explain diagnostics and search the
documentation of libraries. Files are those of this folder and of libraries.

Exit code: 0 if the assistant has ended it, 1 if its messages cannot be read.")]
pub(super) struct McpArgs {
    /// Stop a call after this number of seconds
    #[arg(long, value_name = "SECONDS", default_value = "600", value_parser = seconds)]
    time_limit: f64,
}

/// Versions of the protocol whose messages are these; the first is the newest.
const VERSIONS: [&str; 3] = ["2025-06-18", "2025-03-26", "2024-11-05"];

/// How an assistant uses the tools together.
const INSTRUCTIONS: &str = "\
Tools for Modelica models in the working folder. Write models (.mo) and problem files (.toml) as files, \
`check` them, `simulate` them with values of parameters, and `identify` parameters from measured data. \
`explain` says what a code such as unknown-name in a message means. `search` finds classes of libraries \
by words of their names and documentation. Permissions (`--allow-read` and its like) are given by the \
user alone, when the server is started. Do not report identified values without the verdicts and \
remarks that come with them.";

/// Codes of errors in JSON-RPC.
const PARSE_ERROR: i64 = -32700;
const INVALID_REQUEST: i64 = -32600;
const METHOD_NOT_FOUND: i64 = -32601;
const INVALID_PARAMS: i64 = -32602;

/// Serves one assistant until it closes standard input.
pub(super) fn mcp(arguments: &McpArgs, global: &Global) -> ExitCode {
    let tools = match tools::Tools::new(arguments.time_limit, global.clone()) {
        Ok(tools) => tools,
        Err(error) => {
            terminal::eprint(&format!("error: the working folder cannot be read: {error}\n"));
            return ExitCode::FAILURE;
        }
    };
    let calls = Calls::new(tools);
    let mut input = io::stdin().lock();
    let mut line = Vec::new();
    let ended = loop {
        line.clear();
        match input.read_until(b'\n', &mut line) {
            Ok(0) => break ExitCode::SUCCESS,
            Ok(_) if line.trim_ascii().is_empty() => {}
            Ok(_) => received(&calls, &line),
            Err(error) => {
                terminal::eprint(&format!("error: messages cannot be read: {error}\n"));
                break ExitCode::FAILURE;
            }
        }
    };
    calls.stop_all();
    ended
}

/// Answers a message, now or when its work is done.
fn received(calls: &Calls, line: &[u8]) {
    let message: Value = match serde_json::from_slice(line) {
        Ok(message) => message,
        Err(error) => return calls.refuse(&Value::Null, PARSE_ERROR, &error.to_string()),
    };
    if message.is_array() {
        let why = "batches are not supported: write each message on a line of its own";
        return calls.refuse(&Value::Null, INVALID_REQUEST, why);
    }
    let id = message.get("id").cloned();
    let Some(method) = message.get("method").and_then(Value::as_str) else {
        // Nothing was asked of the assistant that it could answer.
        if message.get("result").or(message.get("error")).is_none() {
            let id = id.unwrap_or(Value::Null);
            calls.refuse(&id, INVALID_REQUEST, "a message is an object with a `method`");
        }
        return;
    };
    let params = message.get("params").cloned().unwrap_or(Value::Null);
    match id {
        Some(Value::Null) => {
            calls.refuse(
                &Value::Null,
                INVALID_REQUEST,
                "the id of a request is a string or a number",
            );
        }
        Some(id) => requested(calls, &id, method, &params),
        None if method == "notifications/cancelled" => calls.cancel(&params["requestId"]),
        None => {}
    }
}

fn requested(calls: &Calls, id: &Value, method: &str, params: &Value) {
    match method {
        "initialize" => calls.answer(id, &initialized(params)),
        "ping" => calls.answer(id, &json!({})),
        "tools/list" => calls.answer(id, &json!({ "tools": tools::descriptions() })),
        "tools/call" => match params["name"].as_str().filter(|name| tools::is_known(name)) {
            Some(name) => calls.begin(id, name, params),
            None => {
                let message =
                    format!("unknown tool {}: `tools/list` has those that exist", params["name"]);
                calls.refuse(id, INVALID_PARAMS, &message);
            }
        },
        _ => calls.refuse(id, METHOD_NOT_FOUND, &format!("there is no method `{method}`")),
    }
}

/// The version of the protocol that both know, and what this server is.
fn initialized(params: &Value) -> Value {
    let asked = params["protocolVersion"].as_str().unwrap_or_default();
    let version = VERSIONS.iter().find(|version| **version == asked).unwrap_or(&VERSIONS[0]);
    json!({
        "protocolVersion": version,
        "capabilities": { "tools": {} },
        "serverInfo": { "name": "gapi", "version": env!("CARGO_PKG_VERSION") },
        "instructions": INSTRUCTIONS,
    })
}
