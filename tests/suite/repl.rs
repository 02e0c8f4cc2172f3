//! The prompt, as a user meets it who types line by line.

use crate::cli::{command, folder};
use std::io::{BufRead, BufReader, Write};
use std::process::{Child, Command, Stdio};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;
use tempfile::TempDir;

/// A session whose lines are sent one by one.
fn prompt(here: &TempDir) -> Child {
    let mut command = command(here.path(), &["repl"]);
    command.env("GAPI_HISTORY", here.path().join("history"));
    command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    command.spawn().expect("a session")
}

/// What a session answers to these lines.
fn answers(lines: &str) -> (i32, String, String) {
    let here = folder(&[("part.mos", "loaded = 7\n"), ("Plant.mo", "model Plant end Plant;\n")]);
    let mut session = prompt(&here);
    session.stdin.take().expect("a pipe").write_all(lines.as_bytes()).expect("read");
    let output = session.wait_with_output().expect("it ends");
    let text = |bytes| String::from_utf8(bytes).expect("UTF-8");
    (output.status.code().expect("ended by itself"), text(output.stdout), text(output.stderr))
}

#[test]
fn statements_are_answered_and_go_on_over_lines() {
    let (code, out, _) = answers("x = 2\nx + 1\nfor i in 1:3 loop\n  x = x*2;\nend for\nx\n");
    assert_eq!(code, 0);
    assert!(out.contains(" = 3\n") && out.contains(" = 16\n"), "{out}");
}

#[test]
fn commands_of_the_prompt_tell_what_is_there() {
    let (_, out, errors) = answers(
        "x = {1.5, 2}\n:vars\n:type x\n:load part.mos\nloaded\n:load Plant.mo\n:help Plant\n\
         :help simulateModel\n:time 1 + 1\n:nonsense\n",
    );
    for expected in [
        "Real[2] x = {1.5, 2.0};",
        "Real[2]\n",
        " = 7\n",
        "Plant\n",
        "model Plant",
        "function simulateModel",
        " s\n",
    ] {
        assert!(out.contains(expected), "{expected:?} is not in\n{out}");
    }
    assert!(errors.contains("`:nonsense`"), "{errors}");
}

#[test]
fn an_error_or_an_exit_code_belongs_to_its_line() {
    let (code, out, errors) = answers("y = z\n1 + 1\nexit(3)\n5 + 5\n");
    assert_eq!(code, 3);
    assert!(
        errors.contains("`z`") && out.contains(" = 2\n") && !out.contains("10"),
        "{out}{errors}"
    );
}

#[cfg(unix)]
#[test]
fn an_interrupt_stops_the_simulation_and_not_the_session() {
    let here = folder(&[]);
    let mut session = prompt(&here);
    let mut input = session.stdin.take().expect("a pipe");
    let mut output = BufReader::new(session.stdout.take().expect("a pipe"));
    let mut line = String::new();
    writeln!(input, "model M Real x(start = 1); equation der(x) = sin(1e6*time); end M;").unwrap();
    writeln!(input, "Modelica.Utilities.Streams.print(\"begins\")").unwrap();
    writeln!(input, "simulateModel(\"M\", stopTime = 1e6)").unwrap();
    while !line.contains("begins") {
        line.clear();
        assert!(output.read_line(&mut line).expect("a line") > 0, "the session ended");
    }
    writeln!(input, "20 + 22").unwrap();
    drop(input);
    // One that comes before the simulation begins has no effect: it is sent until it has.
    let ended = Arc::new(AtomicBool::new(false));
    let (id, over) = (session.id().to_string(), ended.clone());
    let interrupts = std::thread::spawn(move || {
        while !over.load(Ordering::SeqCst) {
            std::thread::sleep(Duration::from_millis(500));
            let _ = Command::new("kill").args(["-INT", &id]).status();
        }
    });
    let rest: Vec<String> = output.lines().map_while(Result::ok).collect();
    ended.store(true, Ordering::SeqCst);
    assert!(rest.iter().any(|line| line.contains("= 42")), "{rest:?}");
    assert_eq!(session.wait().expect("it ends").code(), Some(0));
    interrupts.join().expect("no panic");
}
