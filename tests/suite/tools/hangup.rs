//! Terminals that are closed while a command uses them: it saves what it has, and ends. Each command that
//! opens a screen or waits for a key is started on a pseudo-terminal whose other side is closed then.
#![cfg(target_os = "linux")]

use crate::support::program::{command, folder};
use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
use std::fs::File;
use std::io::{Read as _, Write as _};
use std::os::unix::ffi::OsStrExt as _;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// How long something is waited for: the machine may be busy.
const PATIENCE: Duration = Duration::from_secs(120);

const FILES: &[(&str, &str)] = &[
    ("Line.mo", crate::support::program::LINE),
    ("d.csv", "t,y\n0,1\n1,3.1\n2,4.9\n3,7\n"),
    ("short.mos", SHORT),
    ("long.mos", LONG),
    ("new.mos", "x = 1\n"),
];
const SHORT: &str = "(S, M, Xexp, Yexp) := Exp_Adq_SISO(\"d.csv\", \"t\", \"y\");\n\
                     P := {{0.5, 1}, {2, 3}};\n\
                     F := Fit(Eval(\"Line.mo\", \"Line\", Xexp, P, {\"a\", \"b\"}, \"x\", \"y\"), Yexp);\n";
const LONG: &str = "(S, M, Xexp, Yexp) := Exp_Adq_SISO(\"d.csv\", \"t\", \"y\");\n\
                    P := fill(1.0, 40, 2);\n\
                    for k in 1:100000000 loop\n  P[1, 1] := k;\n\
                    F := Fit(Eval(\"Line.mo\", \"Line\", Xexp, P, {\"a\", \"b\"}, \"x\", \"y\"), Yexp);\n\
                    end for\n";
/// What shows the screen of a run.
const SCREEN: &str = "\u{1b}[?1049h";

/// Starts a command on a terminal and waits until this is shown. The terminal is closed when the file is
/// dropped.
fn started(mut command: Command, shown: &str) -> (Child, File) {
    // Another process that has it keeps the terminal open.
    let flags = OpenptFlags::RDWR | OpenptFlags::NOCTTY | OpenptFlags::CLOEXEC;
    let master = openpt(flags).expect("a terminal");
    grantpt(&master).and_then(|()| unlockpt(&master)).expect("a terminal");
    let name = ptsname(&master, Vec::new()).expect("a name");
    let path = Path::new(std::ffi::OsStr::from_bytes(name.to_bytes()));
    let slave = File::options().read(true).write(true).open(path).expect("its other side");
    let size = rustix::termios::Winsize { ws_row: 30, ws_col: 100, ws_xpixel: 0, ws_ypixel: 0 };
    rustix::termios::tcsetwinsize(&slave, size).expect("a size");
    let end = || Stdio::from(slave.try_clone().expect("a copy"));
    command.env("TERM", "xterm").env("GAPI_HISTORY", "");
    let child = command.stdin(end()).stdout(end()).stderr(end()).spawn().expect("it starts");
    drop((command, slave));
    let mut master = File::from(master);
    let (mut seen, mut piece) = (Vec::new(), [0; 4096]);
    while !String::from_utf8_lossy(&seen).contains(shown) {
        let count = master.read(&mut piece).unwrap_or(0);
        assert!(count > 0, "it ended before {shown:?}: {}", String::from_utf8_lossy(&seen));
        seen.extend_from_slice(&piece[..count]);
    }
    (child, master)
}

/// Whether the process ends by itself.
fn ends(child: &mut Child) -> bool {
    let begin = Instant::now();
    while begin.elapsed() < PATIENCE {
        if child.try_wait().expect("a child").is_some() {
            return true;
        }
        std::thread::sleep(Duration::from_millis(20));
    }
    let _ = child.kill();
    let _ = child.wait();
    false
}

#[test]
fn commands_end_with_their_terminal() {
    for (arguments, shown) in [
        (&["run", "long.mos"][..], SCREEN),
        (&["teach", "short.mos"], SCREEN),
        (&["repl"], "> "),
        (&["lesson", "1", "--watch"], "Waiting for the next save"),
        (&["test", "new.mos", "--review"], "accept this transcript?"),
    ] {
        let here = folder(FILES);
        let (mut child, terminal) = started(command(here.path(), arguments), shown);
        drop(terminal);
        assert!(ends(&mut child), "gapi {} goes on without its terminal", arguments.join(" "));
    }
}

fn results(here: &TempDir, name: &str) -> Vec<String> {
    let entries = std::fs::read_dir(here.path().join("results").join(name)).expect("results");
    entries.map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned()).collect()
}

#[test]
fn a_run_saves_what_it_has_when_its_terminal_is_closed() {
    let here = folder(FILES);
    let (mut child, terminal) = started(command(here.path(), &["run", "long.mos"]), SCREEN);
    drop(terminal);
    assert!(ends(&mut child), "it continues without its terminal");
    let written = results(&here, "long");
    for name in ["result.json", "script.journal"] {
        assert!(written.iter().any(|file| file == name), "{name}: {written:?}");
    }
}

/// The first generations of a run are shown while it continues, and leaving the screen ends it.
#[test]
fn an_endless_run_is_shown_and_left() {
    let here = folder(FILES);
    let shown = "the run continues; ";
    let (mut child, mut terminal) = started(command(here.path(), &["teach", "long.mos"]), shown);
    terminal.write_all(b"q").expect("it reads");
    let mut rest = Vec::new();
    // A terminal whose other side is gone gives an error instead of an end.
    let _ = terminal.read_to_end(&mut rest);
    assert!(ends(&mut child), "it continues without its screen");
    assert!(child.wait().expect("a status").success(), "{}", String::from_utf8_lossy(&rest));
}

/// A run that was started with `nohup` goes on, and does nothing but its work.
#[test]
fn a_run_that_outlives_its_terminal_goes_on_quietly() {
    let here = folder(FILES);
    let gapi = command(here.path(), &[]);
    let mut shell = Command::new("sh");
    let program = gapi.get_program().to_string_lossy().into_owned();
    shell.args(["-c", &format!("trap '' HUP; exec '{program}' run long.mos")]);
    shell.current_dir(here.path());
    let (mut child, terminal) = started(shell, SCREEN);
    drop(terminal);
    let journal = here.path().join("results/long/script.journal");
    let length = || std::fs::metadata(&journal).map_or(0, |found| found.len());
    let (before, begin) = (length(), Instant::now());
    while length() <= before && begin.elapsed() < PATIENCE {
        assert!(child.try_wait().expect("a child").is_none(), "it has ended");
        std::thread::sleep(Duration::from_millis(50));
    }
    assert!(length() > before, "it does not go on");
    // No thread reads the keys of a terminal that is gone.
    let tasks = std::fs::read_dir(format!("/proc/{}/task", child.id())).expect("threads");
    let names: Vec<String> = tasks
        .map(|task| std::fs::read_to_string(task.unwrap().path().join("comm")).unwrap_or_default())
        .collect();
    let _ = child.kill();
    let _ = child.wait();
    assert!(!names.iter().any(|name| name.trim() == "keys"), "{names:?}");
}
