//! The prompt, as a user meets it at a terminal: what is pasted and typed ahead, Ctrl-C and Ctrl-D.

use crate::support::guide::blocks;
use crate::support::program::{command, folder};
use crate::support::shipped::project;
use rexpect::session::{PtySession, spawn_command};
use tempfile::TempDir;

/// Milliseconds to wait for an answer: the machine may be busy.
const PATIENCE: u64 = 120_000;

/// A model whose simulation takes longer than anybody waits.
/// It has so many states that the limit on the number of steps is far away.
const ENDLESS: &str = "model M Real x[50](each start = 1);\
    equation der(x) = {sin(1e6*time*i) for i in 1:50}; end M;\n";

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
fn a_call_of_the_other_dialect_is_recognized() {
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

/// The files of the guide's first fit, whose lines are longer than a terminal's.
fn first_fit() -> TempDir {
    let chapter = std::fs::read_to_string(project("docs/src/first_fit.md")).unwrap();
    let toml = std::fs::read_to_string(project("docs/src/every_number.md")).unwrap();
    let all = blocks(&chapter).into_iter().chain(blocks(&toml));
    let here = folder(&[]);
    for (kind, text) in all {
        if let Some((_, name)) = kind.split_once(",file=") {
            std::fs::write(here.path().join(name), text).unwrap();
        }
    }
    here
}

/// The lines as they stand at last, without colours and movements of the cursor.
fn lines(shown: &str) -> Vec<String> {
    let erased = regex::Regex::new("\u{1b}\\[[0-9]*K").unwrap().replace_all(shown, "\r");
    let sequence = regex::Regex::new("\u{1b}\\[[0-9;?]*[A-Za-z]").unwrap();
    let plain = sequence.replace_all(&erased, "").replace("\r\n", "\n");
    plain.lines().map(|line| line.rsplit('\r').next().unwrap_or_default().to_owned()).collect()
}

/// A terminal breaks longer lines where they end, in the middle of a number.
#[test]
fn what_the_program_says_fits_into_eighty_columns() {
    let here = first_fit();
    let reference = "time,v\n0,10\n8,2\n";
    std::fs::create_dir_all(here.path().join("references/Discharge")).unwrap();
    std::fs::write(here.path().join("references/Discharge/Discharge.csv"), reference).unwrap();
    for (arguments, code) in [
        (&["identify", "discharge.toml", "--plain", "--profile"][..], 0),
        (&["run", "fit.mos", "--plain"], 0),
        (&["check", "Discharge.mo", "--model", "Discharge"], 0),
        (&["simulate", "Discharge.mo", "--stats", "--set", "tau=4"], 0),
        (&["teach", "fit.mos", "--plain", "--generation", "2"], 0),
        (&["verify", "Discharge.mo", "--references", "references"], 1),
        (&["identify", "a_file_that_is_missing_and_has_a_long_name.toml"], 1),
    ] {
        let long = lines(&shown(&here, arguments));
        let long: Vec<&String> = long.iter().filter(|line| line.chars().count() > 80).collect();
        assert_eq!(long, Vec::<&String>::new(), "{arguments:?}");
        let output = command(here.path(), arguments).output().expect("it runs");
        assert_eq!(output.status.code(), Some(code), "{arguments:?}");
    }
}

/// Scripts that end the session, or need a world that can.
const ENDING: [&str; 2] = ["interrupted.mos", "scripts-too-deep.mos"];

/// Every diagnostic that a script can raise, whatever it quotes: one long word excepted, which no line break
/// would make shorter.
#[test]
fn diagnostics_fit_into_eighty_columns() {
    let here = tempfile::tempdir().expect("a folder");
    let scripts = project("tests/diagnostics");
    for folder in ["", "files"] {
        for entry in std::fs::read_dir(scripts.join(folder)).expect("a folder") {
            let path = entry.expect("an entry").path();
            let target = here.path().join(path.strip_prefix(&scripts).expect("below"));
            match path.is_dir() {
                true => std::fs::create_dir_all(target).expect("made"),
                false => drop(std::fs::copy(&path, target)),
            }
        }
    }
    let mut names: Vec<String> = std::fs::read_dir(here.path())
        .expect("a folder")
        .map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned())
        .filter(|name| name.ends_with(".mos") && !ENDING.contains(&name.as_str()))
        .collect();
    names.sort();
    assert!(names.len() > 100, "{names:?}");
    // One after the other in one session, each with its errors.
    let calls: String = names.iter().map(|name| format!("RunScript(\"{name}\");\n")).collect();
    std::fs::write(here.path().join("all.mos"), calls).expect("written");
    let shown = lines(&shown(&here, &["run", "all.mos", "--plain"]));
    let codes: std::collections::BTreeSet<&str> = shown
        .iter()
        .filter_map(|line| line.split_once('[')?.1.split_once("]:"))
        .map(|(code, _)| code)
        .collect();
    assert!(codes.len() > 110, "{codes:?}");
    let is_long = |line: &&String| {
        line.chars().count() > 80 && line.split_whitespace().any(|word| word.len() < 70)
    };
    let long: Vec<&String> = shown.iter().filter(is_long).collect();
    assert_eq!(long, Vec::<&String>::new());
}

/// On a terminal the words are those of a file, in other lines.
#[test]
fn a_report_has_all_its_words_on_a_terminal() {
    let here = first_fit();
    let arguments = &["identify", "discharge.toml", "--plain", "--profile"];
    let words = |lines: &[String]| {
        let mut words: Vec<String> =
            lines.iter().flat_map(|line| line.split_whitespace()).map(str::to_owned).collect();
        words.sort_unstable();
        words
    };
    let mut on_terminal = lines(&shown(&here, arguments));
    // A note is on standard error, which is the same screen, and not once more in the report.
    on_terminal.iter_mut().for_each(|line| *line = line.replace("note[data-note]:", ""));
    assert!(
        on_terminal.iter().any(
            |line| line == "  parameter  value   unit  standard error  95 % interval     range"
        )
    );
    let output = command(here.path(), arguments).output().expect("it runs").stdout;
    let kept = String::from_utf8(output).expect("UTF-8");
    assert!(
        kept.lines().any(|line| line.chars().count() > 80),
        "nothing was to be laid out: {kept}"
    );
    let kept: Vec<String> = kept.lines().map(str::to_owned).collect();
    assert_eq!(words(&on_terminal), words(&kept));
}

/// What was said of the data is in the report, but not twice on the same screen.
#[test]
fn notes_on_data_stand_once_on_a_screen() {
    const PROBLEM: &str = "model = \"Decay\"\nfiles = [\"Decay.mo\"]\n[parameters]\n\
        k = { min = 0.1, max = 10 }\n[[experiment]]\ndata = \"d.csv\"\noutputs = { x = \"x\" }\n";
    let here = folder(&[
        (
            "Decay.mo",
            "model Decay parameter Real k = 1; Real x(start = 1, fixed = true); equation \
             der(x) = -k*x; end Decay;\n",
        ),
        ("d.csv", "time [ms],x\n0,1.01\n500,0.59\n1000,0.37\n2000,0.14\n"),
        ("p.toml", PROBLEM),
    ]);
    let arguments = &["identify", "p.toml", "--plain"];
    let count = |text: &str| text.matches("converted from ms").count();
    let screen = lines(&shown(&here, arguments)).join(" ");
    assert_eq!(count(&screen), 1, "{screen}");
    let output = command(here.path(), arguments).output().expect("it runs");
    let [out, errors] = [output.stdout, output.stderr].map(|own| String::from_utf8(own).unwrap());
    assert_eq!([count(&out), count(&errors)], [1, 1], "{out}{errors}");
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

/// Every command that waits for an answer ends at the first Ctrl-C: what was done is kept, nothing is
/// written that was not asked for.
#[test]
fn one_interrupt_ends_a_question() {
    let files = [
        ("search.mos", super::teach::SEARCH),
        ("two.mo", "model Two output Real a = time; output Real b = 2*time; end Two;\n"),
        ("d.csv", "t,q\n0,1\n1,3.1\n2,4.9\n"),
    ];
    for (arguments, asked, says) in [
        (
            &["teach", "search.mos", "--quiz", "--plain"][..],
            ["become parents", "> "],
            "No question was answered",
        ),
        (&["new", "d.csv", "--model", "two.mo"], ["Which variable does the column", "[1]: "], ""),
    ] {
        let here = folder(&files);
        let mut command = command(here.path(), arguments);
        command.env("TERM", "xterm").env("NO_COLOR", "1");
        let mut session = spawn_command(command, Some(PATIENCE)).expect("a terminal");
        // The question, and the prompt after it.
        for text in asked {
            session.exp_string(text).expect("it asks");
        }
        session.send_control('c').expect("it reads");
        let rest = session.exp_eof().expect("it ends");
        let status = session.process().wait().expect("it ends");
        assert!(format!("{status:?}").contains(", 130)"), "{arguments:?}: {status:?}\n{rest}");
        assert!(rest.contains(says), "{rest}");
        assert!(!here.path().join("d.toml").exists(), "{rest}");
    }
}
