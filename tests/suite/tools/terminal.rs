//! The prompt, as a user meets it at a terminal: what is pasted and typed ahead, Ctrl-C and Ctrl-D.

use crate::support::program::{command, folder};
use rexpect::session::{PtySession, spawn_command};
use tempfile::TempDir;

/// Milliseconds to wait for an answer: the machine may be busy.
const PATIENCE: u64 = 120_000;

/// A model whose simulation takes longer than anybody waits.
const ENDLESS: &str = "model M Real x(start = 1); equation der(x) = sin(1e6*time); end M;\n";

struct Prompt {
    session: PtySession,
    here: TempDir,
}

impl Prompt {
    fn new() -> Prompt {
        let here = folder(&[
            ("Endless.mo", ENDLESS),
            ("Decay.mo", "model Decay Real x(start = 1); equation der(x) = -x; end Decay;\n"),
        ]);
        let mut command = command(here.path(), &["repl"]);
        command.env("GAPI_HISTORY", "").env("TERM", "xterm").env("NO_COLOR", "1");
        let session = spawn_command(command, Some(PATIENCE)).expect("a terminal");
        let mut prompt = Prompt { session, here };
        prompt.expect(":help lists the commands");
        prompt.expect("> ");
        prompt
    }

    fn send(&mut self, text: &str) {
        self.session.send(text).expect("it reads");
        self.session.flush().expect("it reads");
    }

    /// Types a line.
    fn line(&mut self, text: &str) {
        self.send(&format!("{text}\r"));
    }

    /// What is shown up to and without this text.
    fn expect(&mut self, text: &str) -> String {
        match self.session.exp_string(text) {
            Ok(before) => before,
            Err(error) => panic!("{text:?} does not come: {error}"),
        }
    }

    /// Ctrl-D at an empty line ends it with exit code 0. What stands before it must have been
    /// answered: while a call runs, the terminal takes Ctrl-D for itself, as it does in a shell.
    fn leave(mut self) {
        self.line("\"last\" + \" answer\"");
        self.expect("last answer");
        self.expect("> ");
        self.session.send_control('d').expect("it reads");
        self.session.exp_eof().expect("it ends");
        let status = self.session.process().wait().expect("it ends");
        assert!(format!("{status:?}").contains(", 0)"), "{status:?}");
    }
}

#[test]
fn the_banner_names_help_and_the_dialect() {
    let mut prompt = Prompt::new();
    prompt.line(":help");
    prompt.expect(":dialect [D]");
    prompt.line(":dialect");
    prompt.expect("Dymola");
    prompt.line(":dialect openmodelica");
    prompt.expect("OpenModelica");
    prompt.line("x := 3*7");
    prompt.expect("21");
    prompt.line(":dialect fortran");
    prompt.expect("there are two dialects");
    prompt.line("help(Fit)");
    prompt.expect("function Fit");
    prompt.leave();
}

#[test]
fn a_call_of_the_other_dialect_is_recognised() {
    let mut prompt = Prompt::new();
    prompt.line("loadString(\"model A end A;\")");
    prompt.expect("this looks like OpenModelica; `:dialect openmodelica`");
    prompt.leave();
}

#[test]
fn lines_typed_ahead_are_kept() {
    let mut prompt = Prompt::new();
    prompt.send("a = sum(i for i in 1:200000)\rb = 2\rb + 40\r");
    prompt.expect(" = 42");
    prompt.line("a");
    prompt.expect(" = 20000100000");
    prompt.leave();
}

#[test]
fn pasted_lines_are_one_input() {
    let mut prompt = Prompt::new();
    let pasted = "a = 1\rfor i in 1:3 loop\r  a = a + i;\rend for;\ra + 35\r";
    prompt.send(&format!("\x1b[200~{pasted}\x1b[201~\r"));
    prompt.expect(" = 42");
    prompt.leave();
}

#[test]
fn an_open_block_goes_on_in_the_next_line() {
    let mut prompt = Prompt::new();
    prompt.line("x = 1");
    prompt.line("for i in 1:4 loop");
    prompt.line("  x = x*2;");
    prompt.line("end for");
    prompt.line("x + 26");
    prompt.expect(" = 42");
    prompt.leave();
}

#[test]
fn errors_keep_the_session_and_its_variables() {
    let mut prompt = Prompt::new();
    prompt.line("a = 41");
    prompt.line("b = nowhere + 1");
    prompt.expect("there is no variable `nowhere`");
    prompt.line("c = (1");
    prompt.line("");
    prompt.line("");
    prompt.expect("error[");
    prompt.line("a + 1");
    prompt.expect(" = 42");
    prompt.leave();
}

#[test]
fn an_interrupt_stops_the_call_and_keeps_the_session() {
    let mut prompt = Prompt::new();
    prompt.line("a = 41");
    prompt.line(":load Endless.mo");
    prompt.line("print(\"begins\"); simulateModel(\"M\", stopTime = 1e6)");
    // Once echoed, once printed.
    prompt.expect("begins");
    prompt.expect("begins");
    std::thread::sleep(std::time::Duration::from_millis(1500));
    prompt.session.send_control('c').expect("it reads");
    prompt.expect("interrupted");
    prompt.line("a + 1");
    prompt.expect(" = 42");
    prompt.leave();
}

#[test]
fn an_interrupt_at_the_prompt_forgets_the_line() {
    let mut prompt = Prompt::new();
    prompt.line("a = 42");
    // An interrupt before it is read would take this line.
    prompt.line("3*a");
    prompt.expect(" = 126");
    prompt.send("a = 1");
    prompt.session.send_control('c').expect("it reads");
    // The end of bracketed paste is that of the line.
    prompt.expect("[?2004l");
    prompt.expect("> ");
    prompt.line("2*a");
    prompt.expect(" = 84");
    prompt.leave();
}

#[test]
fn a_plot_says_which_file_it_wrote() {
    let mut prompt = Prompt::new();
    prompt.line("openModel(\"Decay.mo\")");
    prompt.line("simulateModel(\"Decay\", stopTime = 1)");
    prompt.expect("Finished");
    prompt.line("plot({\"x\"})");
    let shown = prompt.expect(".svg");
    let name = shown.rsplit([' ', '`', '\n']).next().unwrap_or_default();
    let file = prompt.here.path().join(format!("{name}.svg"));
    prompt.expect("> ");
    assert!(file.exists(), "{shown}");
    prompt.leave();
}

/// What a command shows on a terminal.
fn shown(here: &TempDir, arguments: &[&str]) -> String {
    let mut command = command(here.path(), arguments);
    command.env("TERM", "xterm").env("NO_COLOR", "1");
    let mut session = spawn_command(command, Some(PATIENCE)).expect("a terminal");
    let shown = session.exp_eof().expect("it ends");
    // It gives every byte as a character.
    let shown = shown.chars().map(|c| u8::try_from(u32::from(c)).expect("a byte")).collect();
    String::from_utf8(shown).expect("UTF-8")
}

/// What a script prints is text for a terminal, not commands; elsewhere it is kept as it is.
#[test]
fn printed_text_carries_no_commands_to_the_terminal() {
    let text = "a\u{1b}]52;c;ZXZpbA==\u{7}b\u{9b}2Jc\u{1b}[31md";
    let here = folder(&[("print.mos", &format!("print(\"{text}\")\n"))]);
    let shown = shown(&here, &["run", "print.mos"]);
    assert!(shown.contains("a␛]52;c;ZXZpbA==␇b"), "{shown:?}");
    assert!(shown.contains("c␛[31md"), "{shown:?}");
    assert!(!shown.contains(['\u{1b}', '\u{7}', '\u{9b}']), "{shown:?}");
    let kept = command(here.path(), &["run", "print.mos"]).output().expect("it runs").stdout;
    assert!(String::from_utf8(kept).expect("UTF-8").contains(text));
}

/// Neither do the names and the contents of files, whichever command shows them.
#[test]
fn files_carry_no_commands_to_the_terminal() {
    const EVIL: &str = "\u{1b}]52;c;ZXZpbA==\u{7}";
    let model = format!("model A \"{EVIL}\"\n Real x;equation x=1;end A;\n");
    let snap = format!(">>> x = 1\n{EVIL}\n[exit code 0]\n");
    let data = format!("t,{EVIL}y,{EVIL}z\n0,1,{EVIL}\n1,3.1,1\n2,4.9,2\n");
    let here = folder(&[
        ("A.mo", &model),
        (&format!("{EVIL}.mo"), "model B Real x;equation x=1;end B;\n"),
        ("s.mos", "x = 1\n"),
        ("s.mos.snap", &snap),
        (&format!("{EVIL}.mos"), "x = 1\n"),
        ("Line.mo", crate::support::program::LINE),
        ("d.csv", &data),
        (
            "read.mos",
            "(S, M, X, Y) := Exp_Adq_SISO(\"d.csv\", \"t\", \"z\")\nreadCSVheaders(\"d.csv\")\n",
        ),
    ]);
    let color = ["--color", "always"];
    for arguments in [
        &["fmt", "--diff", "."][..],
        &["fmt", "--check", "."],
        &["test", "."],
        &["test", "--list", "."],
        &["run", "read.mos"],
        &["run", "--parse-only", "."],
        &["check", "."],
        &["new", "d.csv", "--model", "Line.mo", "--output", "p.toml"],
        &["compare", "d.csv", "d.csv"],
        &["journal", "d.csv"],
    ] {
        let shown = shown(&here, arguments);
        assert!(!shown.contains(['\u{1b}', '\u{7}', '\u{9b}']), "{arguments:?}: {shown:?}");
        let coloured = self::shown(&here, &[arguments, &color].concat());
        assert!(!coloured.contains(['\u{7}', '\u{9b}']), "{arguments:?}: {coloured:?}");
        assert!(!coloured.contains("\u{1b}]"), "{arguments:?}: {coloured:?}");
    }
}

/// What the statistics of a fit are doing is shown where they take long: the profile that is computed, and
/// the fits of a bootstrap.
#[test]
fn the_statistics_show_their_progress() {
    let model = "model Decay\n  parameter Real k = 1, x0 = 1;\n  Real x(start = x0, fixed = true);\n\
                 equation\n  der(x) = -k*x;\nend Decay;\n";
    let noise = [0.01, -0.02, 0.015, 0.0, -0.01, 0.02, -0.015, 0.005];
    let row = |(k, e): (usize, &f64)| {
        let t = 0.5 * k as f64;
        format!("{t},{:.4}\n", 2.0 * (-0.8 * t).exp() + e)
    };
    let data = noise.iter().enumerate().map(row).fold("t,x\n".to_owned(), |all, row| all + &row);
    let problem = "model = \"Decay\"\nfiles = [\"Decay.mo\"]\n[parameters]\n\
                   k = { min = 0.1, max = 10 }\nx0 = { min = 0.1, max = 10 }\n\
                   [[experiment]]\ndata = \"d.csv\"\nx = { variable = \"time\", column = \"t\" }\n\
                   outputs = { x = \"x\" }\n[bootstrap]\nsamples = 100\n";
    let here = folder(&[("Decay.mo", model), ("d.csv", &data), ("p.toml", problem)]);
    let mut command = command(here.path(), &["identify", "p.toml", "--profile"]);
    command.env("TERM", "xterm").env("NO_COLOR", "1");
    let mut session = spawn_command(command, Some(PATIENCE)).expect("a terminal");
    let mut shown = String::new();
    for text in [
        "standard errors",
        "intervals: profile of k, 1 of 2",
        "intervals: profile of x0, 2 of 2",
        "bootstrap: fit ",
    ] {
        match session.exp_string(text) {
            Ok(before) => shown.push_str(&before),
            Err(error) => panic!("{text:?} does not come: {error}; {shown}"),
        }
    }
    session.exp_eof().expect("it ends");
}
