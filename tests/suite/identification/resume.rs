//! A run that ended before its time goes on as the run that it was, or says why it cannot.
#![cfg(unix)]

use crate::support::program::{command, folder, gapi};
use std::fs;
use std::io::Read;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};
use tempfile::TempDir;

const MODEL: &str = "model Growth
  parameter Real a = 1;
  parameter Real b = 1;
  Real y = a*time + b*time^2;
end Growth;
";

const PROBLEM: &str = "model = \"Growth\"
files = [\"Growth.mo\"]
[parameters]
a = { min = 0, max = 9 }
b = { min = 0, max = 9 }
[method]
name = \"genetic\"
polish = false
[stop]
generations = 100000
stagnation = 100000
[checkpoint]
seconds = 0.01
[[experiment]]
data = \"d.csv\"
x = \"time\"
outputs = { y = \"y\" }
";

const SCRIPT: &str = "openModel(\"Growth.mo\")
Parameters = {\"a\", \"b\"};
x = {0.5, 1, 2};
for k in 1:100000 loop
  y = Eval(\"\", \"Growth\", x, [1, 2; 3, 4], Parameters, \"time\", \"y\");
end for;
";

fn here() -> TempDir {
    let data = "time,y\n0.5,1.1\n1,3.2\n2,9.9\n3,21\n";
    folder(&[("Growth.mo", MODEL), ("p.toml", PROBLEM), ("d.csv", data), ("job.mos", SCRIPT)])
}

/// The two kinds of runs with their journals.
const RUNS: [(&[&str], &str); 2] = [
    (&["identify", "p.toml", "--out", "out"], "run.journal"),
    (&["run", "job.mos", "--out", "out", "--checkpoint", "0.01"], "script.journal"),
];

/// Starts a run and waits until it has a checkpoint.
fn started(here: &Path, (arguments, journal): (&[&str], &str)) -> Child {
    let mut child =
        command(here, arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    wait_for(&here.join("out").join(journal), &mut child);
    child
}

fn wait_for(journal: &Path, child: &mut Child) {
    let begun = Instant::now();
    while fs::metadata(journal).map_or(0, |found| found.len()) < 1000 {
        if child.try_wait().unwrap().is_some() {
            let read = |from: Option<&mut dyn Read>| {
                let mut text = String::new();
                from.map(|pipe| pipe.read_to_string(&mut text));
                text
            };
            let out = read(child.stdout.as_mut().map(|pipe| pipe as &mut dyn Read));
            let errors = read(child.stderr.as_mut().map(|pipe| pipe as &mut dyn Read));
            panic!("it ended by itself: {out}{errors}");
        }
        assert!(begun.elapsed() < Duration::from_secs(60), "not a checkpoint");
        std::thread::sleep(Duration::from_millis(5));
    }
}

fn send(signal: &str, child: &Child) {
    let id = child.id().to_string();
    assert!(Command::new("kill").args([signal, &id]).status().unwrap().success());
}

fn ended(child: Child) -> (Option<i32>, String) {
    let output = child.wait_with_output().unwrap();
    let text = [output.stdout, output.stderr].map(|b| String::from_utf8(b).unwrap()).concat();
    (output.status.code(), text)
}

/// A resumed run that would mix the answers of two models is refused, by the name of what changed.
#[test]
fn a_run_does_not_go_on_with_another_model() {
    for run in RUNS {
        let here = here();
        let mut child = started(here.path(), run);
        child.kill().unwrap();
        child.wait().unwrap();
        let journal = here.path().join("out").join(run.1);
        let kept = fs::read(&journal).unwrap();
        fs::write(here.path().join("Growth.mo"), MODEL.replace("a*time +", "3*a*time +")).unwrap();
        let (code, _, errors) = gapi(&here, &[run.0, &["--resume"]].concat());
        assert_eq!(code, 1, "{errors}");
        assert!(errors.contains("Growth.mo") && errors.contains("changed"), "{errors}");
        assert!(
            !errors.contains("`--resume` to") && !errors.contains("resume the run from here"),
            "{errors}"
        );
        assert_eq!(fs::read(&journal).unwrap(), kept, "the checkpoint stays as it was");
    }
}

/// What no text shows, such as a table that the model reads, shows in what is simulated.
#[test]
fn answers_are_compared_to_the_bit() {
    let model = "model Growth
  parameter Real a = 1;
  parameter Real b = 1;
  parameter Real t[1, 1] = Modelica.Utilities.Streams.readRealMatrix(\"t.mat\", \"t\", 1, 1);
  Real y = a*time + b*time^2*t[1, 1];
end Growth;
";
    let make = |value: &str| {
        format!("Modelica.Utilities.Streams.writeRealMatrix(\"t.mat\", \"t\", [{value}]);\n")
    };
    for run in RUNS {
        let here = here();
        fs::write(here.path().join("Growth.mo"), model).unwrap();
        fs::write(here.path().join("make.mos"), make("1")).unwrap();
        assert_eq!(gapi(&here, &["run", "make.mos"]).0, 0);
        let mut child = started(here.path(), run);
        child.kill().unwrap();
        child.wait().unwrap();
        fs::write(here.path().join("make.mos"), make("2")).unwrap();
        assert_eq!(gapi(&here, &["run", "make.mos"]).0, 0);
        let (code, _, errors) = gapi(&here, &[run.0, &["--resume"]].concat());
        assert_eq!(code, 1, "{errors}");
        assert!(errors.contains("individual"), "{errors}");
    }
}

#[test]
fn the_data_and_the_problem_are_compared() {
    for (file, from, to) in [("d.csv", "9.9", "8.8"), ("p.toml", "max = 9 }\nb", "max = 8 }\nb")] {
        let here = here();
        let mut child = started(here.path(), RUNS[0]);
        child.kill().unwrap();
        child.wait().unwrap();
        let text = fs::read_to_string(here.path().join(file)).unwrap();
        fs::write(here.path().join(file), text.replace(from, to)).unwrap();
        let (code, _, errors) = gapi(&here, &[RUNS[0].0, &["--resume"]].concat());
        let named = if file == "d.csv" { "d.csv" } else { "the problem" };
        assert!(code == 1 && errors.contains(named), "{errors}");
    }
}

#[test]
fn two_runs_do_not_share_a_folder() {
    for run in RUNS {
        let here = here();
        let child = started(here.path(), run);
        let (code, _, errors) = gapi(&here, &[run.0, &["--resume"]].concat());
        assert_eq!(code, 1, "{errors}");
        assert!(errors.contains(&format!("process {}", child.id())), "{errors}");
        send("-TERM", &child);
        assert_eq!(ended(child).0, Some(130));
    }
}

/// Schedulers and closed terminals end a run like Ctrl-C: what it has found is written.
#[test]
fn the_systems_signals_end_a_run_with_its_checkpoint() {
    for run in RUNS {
        for signal in ["-TERM", "-HUP"] {
            let here = here();
            let child = started(here.path(), run);
            send(signal, &child);
            let (code, text) = ended(child);
            assert_eq!(code, Some(130), "{signal}: {text}");
            assert!(text.contains("--resume"), "{text}");
            assert!(here.path().join("out").join(run.1).exists());
        }
    }
}

/// The folder may be removed while the run goes on: its journal is written again from the beginning.
#[test]
fn a_removed_folder_is_made_again() {
    for run in RUNS {
        let here = here();
        let mut child = started(here.path(), run);
        // It may write while it is removed.
        while here.path().join("out").join(run.1).exists() {
            let _ = fs::remove_dir_all(here.path().join("out"));
            if !here.path().join("out").exists() {
                break;
            }
        }
        wait_for(&here.path().join("out").join(run.1), &mut child);
        send("-TERM", &child);
        assert_eq!(ended(child).0, Some(130));
        let mut child = command(here.path(), &[run.0, &["--resume"]].concat())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        std::thread::sleep(Duration::from_millis(1500));
        if child.try_wait().unwrap().is_none() {
            send("-TERM", &child);
        }
        let (code, text) = ended(child);
        assert!(code == Some(130) && text.contains("resumed"), "{code:?} {text}");
    }
}

#[test]
fn journals_of_earlier_runs_are_kept_by_number() {
    let here = here();
    let fresh = (RUNS[1].0, "script.journal");
    for number in 0..3 {
        let mut child = started(here.path(), fresh);
        // A journal of this run, not of the one before.
        let wanted = here.path().join(format!("out/script.journal.{number}"));
        let begun = Instant::now();
        while number > 0 && !wanted.exists() {
            assert!(begun.elapsed() < Duration::from_secs(60), "{}", wanted.display());
            std::thread::sleep(Duration::from_millis(5));
        }
        wait_for(&here.path().join("out/script.journal"), &mut child);
        child.kill().unwrap();
        child.wait().unwrap();
    }
    for name in ["script.journal", "script.journal.1", "script.journal.2"] {
        assert!(here.path().join("out").join(name).exists(), "{name}");
    }
}

/// What cannot be printed is an error; a reader that went away is not.
#[cfg(target_os = "linux")]
/// Three calls of Eval, in each of which one of two individuals cannot be simulated, and an error.
const FAILING: &str = "openModel(\"Growth.mo\")
for k in 1:3 loop
  y = Eval(\"\", \"Growth\", {0.5, 1, 2}, [1, k; 5, 4], {\"a\", \"b\"}, \"time\", \"y\");
  print(String(sum(y[1, :])));
end for;
error(\"an end before the end\");
";

/// A script that ends with an error, its checkpoint, and that of another script or of nothing.
#[test]
fn a_checkpoint_of_a_script_is_taken_for_what_it_is() {
    let here = here();
    let strict =
        MODEL.replace("end Growth", "equation\n  assert(a < 5, \"too large\");\nend Growth");
    fs::write(here.path().join("Growth.mo"), strict).unwrap();
    fs::write(here.path().join("job.mos"), FAILING).unwrap();
    let run: &[&str] = &["run", "job.mos", "--out", "out", "--checkpoint", "1e-9", "--strict"];
    let resume = &[run, &["--resume"][..]].concat();
    let (code, first, errors) = gapi(&here, run);
    assert!(code == 1 && errors.contains("an end before the end"), "{errors}");
    let journal = here.path().join("out/script.journal");
    let (code, out, _) = gapi(&here, &["journal", "out/script.journal"]);
    assert_eq!(code, 0, "{out}");
    assert!(out.ends_with("3 calls of Eval: 18 simulated values, 3 failed individuals\n"), "{out}");
    // What was simulated comes from the journal, failures too.
    let (_, again, errors) = gapi(&here, resume);
    assert!(errors.contains("resumed: 3 calls of Eval are replayed"), "{errors}");
    assert_eq!(again, first);
    let whole = fs::read(&journal).unwrap();
    fs::write(&journal, &whole[..whole.len() - 3]).unwrap();
    let (code, out, errors) = gapi(&here, &["journal", "out/script.journal"]);
    assert!(code == 1 && out.contains("2 calls of Eval") && errors.contains("damaged"), "{errors}");
    // Other individuals are asked for than those of the checkpoint.
    fs::write(here.path().join("job.mos"), FAILING.replace("[1, k;", "[2, k;")).unwrap();
    fs::write(&journal, &whole).unwrap();
    let (code, _, errors) = gapi(&here, resume);
    let is_refused =
        errors.contains("requests other simulations") || errors.contains("have changed");
    assert!(code == 1 && is_refused, "{errors}");
    fs::write(&journal, "nothing").unwrap();
    let (code, _, errors) = gapi(&here, resume);
    assert!(code == 1 && errors.contains("script.journal` is not a checkpoint\n"), "{errors}");
    // A run from the beginning keeps what it finds.
    let (_, _, errors) = gapi(&here, run);
    assert!(errors.contains("an earlier run did not finish"), "{errors}");
    assert_eq!(fs::read(here.path().join("out/script.journal.1")).unwrap(), b"nothing");
    let (code, _, errors) = gapi(&here, &["journal", "out/gone.journal"]);
    assert!(code == 1 && errors.contains("removes its checkpoint"), "{errors}");
}

#[test]
fn a_full_standard_output_is_an_error() {
    let here = folder(&[("print.mos", "print(\"text\")\n")]);
    for arguments in [&["run", "print.mos"][..], &["explain"], &["help"]] {
        let full = fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
        let output = command(here.path(), arguments).stdout(full).output().unwrap();
        let errors = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(1), "{arguments:?}: {errors}");
        assert!(errors.contains("standard output"), "{errors}");
    }
}

/// A limit on the size of files ends no process without a word.
#[test]
fn a_limit_of_file_sizes_is_an_error_with_a_message() {
    let here = here();
    let gapi = env!("CARGO_BIN_EXE_gapi");
    let script =
        format!("ulimit -f 1; exec {gapi} simulate Growth.mo --intervals 5000 --output big.csv");
    let output =
        Command::new("sh").args(["-c", &script]).current_dir(here.path()).output().unwrap();
    let errors = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{errors}");
    assert!(errors.contains("big.csv") && errors.contains("large"), "{errors}");
    assert!(!here.path().join("big.csv").exists());
}
