//! The prompt, as a user meets it who types line by line.

use crate::support::program::{command, folder};
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
    let (code, out, errors) = answers(
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
    assert_eq!(code, 1, "nobody at a terminal has read the error");
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

#[test]
fn input_from_a_file_with_errors_ends_with_an_error() {
    assert_eq!(answers("1 + 1\n").0, 0);
    for wrong in ["y = z\n1 + 1\n", "(1\n\n\n", ":load nowhere.mos\n", "?nowhere\n"] {
        assert_eq!(answers(wrong).0, 1, "{wrong}");
    }
    assert_eq!(answers("y = z\nexit(3)\n").0, 3);
}

/// Words of other prompts; a variable of that name is what it says.
#[test]
fn words_of_other_prompts_are_known() {
    let (code, out, errors) =
        answers("ls\n3*7\nans + 1\n?Plant\n:load Plant.mo\n?Plant\nls = 5\nls\n");
    assert_eq!(code, 0, "{errors}");
    for expected in ["Plant.mo\npart.mos\n", " = 21\n", " = 22\n", "model Plant", " = 5\n"] {
        assert!(out.contains(expected), "{expected:?} is not in\n{out}");
    }
    let (_, out, _) = answers("pwd\n");
    assert!(out.trim().starts_with(std::path::MAIN_SEPARATOR), "{out}");
}

/// After a simulation the name of a variable shows its value at the end, and plots are drawn.
#[test]
fn the_last_simulation_is_at_hand() {
    let (code, out, errors) = answers(
        "model M parameter Real k = 0; Real x(start = 7, unit = \"V\"); Real y[2]; equation \
         der(x) = k; y = {x, 2*x}; end M;\nsimulateModel(\"M\", stopTime = 3)\nx\nk\ny[2]\nder(x)\n\
         time\nx = 8\nx\nplot({\"x\"})\n",
    );
    assert_eq!(code, 0, "{errors}");
    for expected in [
        " = 7.0 V at time = 3.0\n",
        " = 0.0\n",
        " = 14.0 at time = 3.0\n",
        " = 0.0 V/s at time = 3.0\n",
        " = 3.0 at time = 3.0\n",
        " = 8\n",
        "\nx (V)\n   1.0500e1 │",
    ] {
        assert!(out.contains(expected), "{expected:?} is not in\n{out}");
    }
}

#[test]
fn a_session_is_saved_as_a_script_that_does_the_same() {
    let here = folder(&[("Plant.mo", "model Plant parameter Real p = 4; end Plant;\n")]);
    let saved = |lines: &str| {
        let mut session = prompt(&here);
        session.stdin.take().expect("a pipe").write_all(lines.as_bytes()).expect("read");
        let output = session.wait_with_output().expect("it ends");
        String::from_utf8_lossy(&output.stdout).into_owned()
            + &String::from_utf8_lossy(&output.stderr)
    };
    let said = saved(
        ":load Plant.mo\nx = 2\ny = nowhere\n3*x\nz = ans + 1\n:vars\n:save s.mos\nz\n:save s.mos\n",
    );
    assert!(said.contains("saved to s.mos"), "{said}");
    let script = std::fs::read_to_string(here.path().join("s.mos")).expect("saved");
    let expected = "openModel(\"Plant.mo\");\nx = 2;\n// failed:\n// y = nowhere\nans := 3*x;\n\
                    z = ans + 1;\nz;\n";
    assert_eq!(script, expected);
    let (code, out, errors) = crate::support::program::gapi(&here, &["run", "s.mos"]);
    assert_eq!((code, out.as_str()), (0, " = 7\n"), "{errors}");
    let said = saved("1\n:save s.mos\n");
    assert!(said.contains("`s.mos` exists already"), "{said}");
}
