//! The server ends with its client, whatever it is about to do.

use super::client::{Client, uri};
use crate::support::program::folder;
use serde_json::{Value, json};
use std::path::Path;

/// Requests that wait.
const MANY: usize = 3000;

/// A client that has asked for much and read nothing.
fn impatient(here: &Path) -> Client {
    let mut client = Client::start(here);
    let path = here.join("M.mo");
    let members: String = (0..100).map(|n| format!("  Real x{n} = {n};\n")).collect();
    client.open(&path, &format!("model M\n{members}end M;\n"));
    for _ in 0..MANY {
        let document = json!({"textDocument": {"uri": uri(&path)}});
        client.ask("textDocument/documentSymbol", document);
    }
    client
}

#[test]
fn what_was_asked_before_the_exit_is_not_waited_for() {
    let here = folder(&[]);
    let mut client = impatient(here.path());
    let shut_down = client.ask("shutdown", Value::Null);
    client.notify("exit", Value::Null);
    let messages: Vec<Value> = std::iter::from_fn(|| client.read()).collect();
    let answers: Vec<&Value> = messages.iter().filter(|one| one.get("result").is_some()).collect();
    assert!(answers.len() < MANY, "all {MANY} requests were answered");
    assert!(answers.iter().any(|one| one["id"] == json!(shut_down)), "shutdown was not answered");
    assert_eq!(client.ends(), 0);
}

#[test]
fn a_client_that_does_not_read_is_not_waited_for() {
    let here = folder(&[]);
    let mut client = impatient(here.path());
    client.ask("shutdown", Value::Null);
    client.notify("exit", Value::Null);
    assert_eq!(client.ends(), 0);
}

#[test]
fn the_server_ends_when_nobody_reads_what_it_writes() {
    let here = folder(&[]);
    let mut client = Client::start(here.path()).stop_reading();
    client.ask("textDocument/unheardOf", json!({}));
    assert_eq!(client.ends(), 1);
}
