//! Everything that grants access to files, with links, hard links, pipes and devices in the places
//! that it is about: a folder of a stranger reads and changes nothing of the user's.
//!
//! The first test holds the list of all grants of the sources, so that a new one comes with a place
//! here.
#![cfg(unix)]

use crate::support::program::{command, folder};
use crate::support::shipped::project;
use std::collections::BTreeMap;
use std::fs;
use std::os::unix::fs::symlink;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// Where the sources grant what, and how often. `Read` and `Named` follow links, so that they are for
/// what the user names, on the command line or to a library function.
const GRANTS: &[(&str, &str, usize)] = &[
    ("cli/compare.rs", "Read", 1),
    ("cli/check.rs", "CheckOnly", 1),
    ("cli/estimate.rs", "Named", 1),
    ("cli/estimate.rs", "Read", 1),
    // The unit that is written, the file with values of parameters, and its copy beside the unit.
    ("cli/export_fmu.rs", "Named", 2),
    ("cli/export_fmu.rs", "Read", 1),
    ("cli/check/imported.rs", "Read", 1),
    ("cli/identify.rs", "Read", 1),
    ("cli/import.rs", "Read", 1),
    ("cli/linearize.rs", "Named", 1),
    ("cli/new.rs", "Named", 1),
    ("cli/repl/commands.rs", "Named", 1),
    ("cli/report.rs", "Own", 1),
    ("cli/run.rs", "Named", 1),
    ("cli/scratch.rs", "Create", 1),
    ("cli/scratch.rs", "Own", 1),
    ("cli/session.rs", "Deny", 2),
    ("cli/session.rs", "ExternalCode", 2),
    ("cli/session.rs", "ExternalFile", 1),
    ("cli/session.rs", "Found", 1),
    ("cli/session.rs", "Read", 2),
    ("cli/session.rs", "ReadAll", 1),
    ("cli/session.rs", "WriteAll", 1),
    ("cli/simulate.rs", "Named", 1),
    ("cli/simulate.rs", "Read", 1),
    ("cli/verify/mod.rs", "Named", 1),
    ("cli/world.rs", "Create", 1),
    ("cli/world.rs", "Own", 1),
    ("script/access/files.rs", "Replace", 1),
    ("script/access/grants.rs", "Create", 1),
    ("script/access/grants.rs", "Found", 1),
    ("script/access/grants.rs", "Named", 1),
    ("script/access/grants.rs", "Read", 2),
    ("script/access/grants.rs", "ReadAll", 1),
    ("script/access/grants.rs", "Results", 1),
    ("script/access/grants.rs", "WriteAll", 1),
    ("script/builtins/final_states.rs", "Replace", 1),
    ("script/runs/problem/shards.rs", "Found", 1),
    ("script/world/memory.rs", "Create", 1),
    ("script/world/memory.rs", "Own", 1),
];

#[test]
fn all_grants_are_known() {
    let mut found: BTreeMap<(String, String), usize> = BTreeMap::new();
    let root = project("src");
    for path in crate::support::shipped::files("src", "rs") {
        let text = fs::read_to_string(&path).unwrap();
        let own = text.split("#[cfg(test)]\nmod tests {").next().unwrap();
        let file = path.strip_prefix(&root).unwrap().display().to_string();
        if file.ends_with("failure_points.rs") || file.ends_with("tests.rs") {
            continue;
        }
        for part in own.split(".grant(Grant::").skip(1) {
            let kind: String = part.chars().take_while(char::is_ascii_alphabetic).collect();
            *found.entry((file.clone(), kind)).or_default() += 1;
        }
    }
    let mut expected = BTreeMap::new();
    for (file, kind, count) in GRANTS {
        expected.insert(((*file).to_owned(), (*kind).to_owned()), *count);
    }
    assert_eq!(found, expected, "a grant is new or gone: give it a place in this file");
}

/// What may stand in the place of a file or folder.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Trap {
    LinkToFolder,
    LinkToFile,
    LinkToNothing,
    LinkToLink,
    LinkThroughDots,
    HardLink,
    Pipe,
    Device,
}

const TRAPS: [Trap; 8] = [
    Trap::LinkToFolder,
    Trap::LinkToFile,
    Trap::LinkToNothing,
    Trap::LinkToLink,
    Trap::LinkThroughDots,
    Trap::HardLink,
    Trap::Pipe,
    Trap::Device,
];

impl Trap {
    /// Puts it into a place; `victim` is the user's folder.
    fn set(self, place: &Path, victim: &Path) {
        fs::create_dir_all(place.parent().unwrap()).unwrap();
        match self {
            Trap::LinkToFolder => symlink(victim, place).unwrap(),
            Trap::LinkToFile => symlink(victim.join("kept.txt"), place).unwrap(),
            Trap::LinkToNothing => symlink(victim.join(".new"), place).unwrap(),
            Trap::LinkToLink => {
                let between = place.with_file_name("between");
                symlink(victim, &between).unwrap();
                symlink("between", place).unwrap();
            }
            Trap::LinkThroughDots => {
                let between = place.with_file_name("between");
                symlink(victim.join("deep"), &between).unwrap();
                symlink("between/..", place).unwrap();
            }
            Trap::HardLink => fs::hard_link(victim.join("kept.txt"), place).unwrap(),
            Trap::Pipe => {
                assert!(Command::new("mkfifo").arg(place).status().unwrap().success());
            }
            Trap::Device => symlink("/dev/zero", place).unwrap(),
        }
    }
}

/// The user's folder: a secret, and files that count as libraries, data and results.
fn victim() -> tempfile::TempDir {
    let model = "model Secret \"KEY123\" Real x = 1; end Secret;";
    let folder = folder(&[
        ("kept.txt", "KEY123 is mine"),
        ("Secret.mo", model),
        ("d.csv", "time,x\n0,1\n1,KEY123\n"),
        ("r.mat", "KEY123"),
        ("result.json", "{\"KEY123\": 1}"),
    ]);
    fs::create_dir(folder.path().join("deep")).unwrap();
    folder
}

fn contents(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        match path.is_dir() {
            true => {
                found.extend(contents(&path).into_iter().map(|(k, v)| (format!("{name}/{k}"), v)))
            }
            false => drop(found.insert(name.clone(), fs::read(&path).unwrap())),
        }
        found.entry(format!("{name} is there")).or_default();
    }
    found
}

const MODEL: &str = "model M Real x(start = 1, fixed = true); equation der(x) = -x; end M;";

/// A model that tries to read a file at translation.
const READING: &str = "model R parameter String s = Modelica.Utilities.Streams.readLine(\"PLACE\", 1); \
                       Real x; equation x = 1; when initial() then assert(false, s); end when; end R;";

const PROBLEM: &str = "model = \"M(x(start = a))\"\nfiles = [\"FILES\"]\n[parameters]\n\
                       a = { min = 0, max = 9 }\n[[experiment]]\ndata = \"DATA\"\nx = \"time\"\n\
                       outputs = { x = \"x\" }\n[stop]\ngenerations = 1\n";

/// A place that something is granted for, what the folder contains, and the command.
struct Place {
    path: &'static str,
    files: Vec<(&'static str, String)>,
    command: &'static [&'static str],
}

/// A script that tries everything with a path: to read it and what is below it, and to write both.
fn script(path: &str) -> String {
    let mut text = "openModel(\"M.mo\");\n".to_owned();
    for name in [path.to_owned(), format!("{path}/kept.txt"), format!("{path}/../kept.txt")] {
        text += &format!("print(Modelica.Utilities.Streams.readFile(\"{name}\"));\n");
        text += &format!("Modelica.Utilities.Streams.print(\"evil\", \"{name}\");\n");
        text += &format!("Modelica.Utilities.Files.removeFile(\"{name}\");\n");
    }
    for name in [path.to_owned(), format!("{path}/new.txt"), format!("{path}/.new")] {
        text += &format!("Modelica.Utilities.Streams.print(\"evil\", \"{name}\");\n");
        text += &format!("simulateModel(\"M\", resultFile = \"{name}\");\n");
    }
    text + &format!("Secret();\nRunScript(\"{path}/x.mos\");\nopenModel(\"{path}/Secret.mo\");\n")
}

/// A session that writes into its output folder, and beside itself, which is recorded there.
fn statements() -> Vec<(&'static str, String)> {
    let text = "Modelica.Utilities.Streams.print(\"evil\", \"results/repl/a.txt\");\n\
                Modelica.Utilities.Streams.print(\"evil\", \"b.txt\");\nplotArray({1, 2}, {1, 2});\n";
    vec![("job.mos", text.to_owned())]
}

/// The files of a folder that hold the secret, apart from one; no link is followed.
fn copies(folder: &Path, but: &Path, found: &mut Vec<String>) {
    for entry in fs::read_dir(folder).unwrap().flatten() {
        let (path, kind) = (entry.path(), entry.file_type().unwrap());
        if kind.is_dir() {
            copies(&path, but, found);
        } else if kind.is_file() && path != but {
            let text = fs::read(&path).unwrap();
            if String::from_utf8_lossy(&text).contains("KEY123") {
                found.push(path.display().to_string());
            }
        }
    }
}

fn places() -> Vec<Place> {
    let model = || ("M.mo", MODEL.to_owned());
    let run: &[&str] = &["run", "job.mos", "--plain"];
    let tried = |path: &'static str| Place {
        path,
        files: vec![model(), ("job.mos", script(path))],
        command: run,
    };
    let problem = |path: &'static str, files: &str, data: &str| Place {
        path,
        files: vec![
            model(),
            ("p.toml", PROBLEM.replace("FILES", files).replace("DATA", data)),
            ("good.csv", "time,x\n0,1\n1,0.4\n".to_owned()),
        ],
        command: &["identify", "p.toml", "--plain"],
    };
    let linearizing = "linearize(M);\nsimulate(M);\n".to_owned();
    let results = |path: &'static str| Place {
        path,
        files: vec![
            model(),
            (
                "job.mos",
                "openModel(\"M.mo\");\nprint(\"evil\", \"results/job/a.txt\");\n\
                                          simulateModel(\"M\", resultFile = \"r\");\n"
                    .to_owned(),
            ),
        ],
        command: run,
    };
    vec![
        tried("models"),
        tried("d"),
        tried("results"),
        tried("numerics/results/job"),
        tried("numerics/results/job/sub"),
        results("numerics/results/job/run.lock"),
        results("numerics/results/job/origin.json"),
        results("numerics/results/job/files_made.txt"),
        results("numerics/results/latest"),
        results("r.mat"),
        Place {
            path: "results/job/origin.json",
            files: vec![
                model(),
                ("job.mos", "print(\"evil\", \"results/job/a.txt\");\n".to_owned()),
            ],
            command: &["run", "job.mos", "--out", "results/job"],
        },
        Place {
            path: "linearized_model.mo",
            files: vec![model(), ("job.mos", format!("loadFile(\"M.mo\");\n{linearizing}"))],
            command: &["run", "job.mos", "--dialect", "openmodelica"],
        },
        Place {
            path: "M_res.mat",
            files: vec![model(), ("job.mos", format!("loadFile(\"M.mo\");\n{linearizing}"))],
            command: &["run", "job.mos", "--dialect", "openmodelica"],
        },
        problem("lib", "lib", "good.csv"),
        problem("x.mo", "x.mo", "good.csv"),
        problem("d.csv", "M.mo", "d.csv"),
        problem("numerics/results/p", "M.mo", "good.csv"),
        Place {
            path: "x.mo",
            files: vec![("Lib.txt", String::new()), ("R.mo", READING.replace("PLACE", "x.mo"))],
            command: &["simulate", "R.mo"],
        },
        Place {
            path: "models/Secret.mo",
            files: vec![("N.mo", "model N extends Secret; end N;".to_owned())],
            command: &["check", "N.mo", "--model", "N"],
        },
        Place {
            path: "d.toml",
            files: vec![model(), ("d.csv", "time,x\n0,1\n1,0.4\n".to_owned())],
            command: &["new", "d.csv", "M.mo"],
        },
        Place {
            path: "job.mos.snap",
            files: vec![("job.mos", "1 + 1;\n".to_owned())],
            command: &["test", "job.mos", "--accept"],
        },
        Place {
            path: "job.mos.snap",
            files: vec![("job.mos", "1 + 1;\n".to_owned())],
            command: &["test", "job.mos"],
        },
        Place {
            path: "results/job/run.trace",
            files: vec![
                ("job.mos", "1 + 1;\n".to_owned()),
                (
                    "results/job/origin.json",
                    "{\n  \"command\": \"gapi teach\",\n  \"input\": \"../../job.mos\"\n}\n"
                        .to_owned(),
                ),
            ],
            command: &["teach", "--plain", "job.mos"],
        },
        Place {
            path: "results/fit/report.html",
            files: vec![],
            command: &["report", "results/fit"],
        },
        Place { path: "results/latest", files: vec![], command: &["report", "results"] },
        Place { path: "s1/shard.part", files: vec![], command: &["report", "--merge", "s1", "s2"] },
        Place { path: "x.mo", files: vec![], command: &["fmt", "."] },
        Place { path: "scripts", files: vec![], command: &["run", "--parse-only", "."] },
        Place { path: "x.mos", files: vec![], command: &["run", "--parse-only", "."] },
        Place { path: "x.mos", files: vec![], command: &["test", ".", "--accept"] },
        Place { path: "results", files: statements(), command: &["repl", "job.mos"] },
        Place { path: "results/repl", files: statements(), command: &["repl", "job.mos"] },
        Place { path: "lessons", files: vec![], command: &["lesson", "1"] },
    ]
}

/// Runs a command, which may not wait for anything; what it printed.
fn ended(here: &Path, arguments: &[&str]) -> String {
    let mut command = command(here, arguments);
    command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().unwrap();
    let begun = Instant::now();
    while child.try_wait().unwrap().is_none() {
        if begun.elapsed() > Duration::from_secs(120) {
            child.kill().unwrap();
            panic!("{arguments:?} waits for ever");
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    let output = child.wait_with_output().unwrap();
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    text(&output.stdout) + &text(&output.stderr)
}

/// Files of the user that a stranger's folder has a name for by a hard link are in that folder: they
/// can be read. Nothing else of the user's is read, and nothing is changed.
#[test]
fn what_stands_in_the_place_of_a_grant_opens_nothing() {
    for place in places() {
        for trap in TRAPS {
            let files: Vec<(&str, &str)> =
                place.files.iter().map(|(name, text)| (*name, text.as_str())).collect();
            let here = folder(&files);
            let victim = victim();
            trap.set(&here.path().join(place.path), victim.path());
            let before = contents(victim.path());
            let printed = ended(here.path(), place.command);
            let case = format!("{trap:?} at {} for {:?}\n{printed}", place.path, place.command);
            assert!(!printed.contains("panicked"), "{case}");
            assert!(trap == Trap::HardLink || !printed.contains("KEY123"), "{case}");
            assert_eq!(contents(victim.path()), before, "{case}");
            let mut copied = Vec::new();
            copies(here.path(), &here.path().join(place.path), &mut copied);
            assert!(trap == Trap::HardLink || copied.is_empty(), "{copied:?} {case}");
        }
    }
}

/// Folders `models` that other users have put above the working folder are passed over. Needs the
/// rights to give files away.
#[test]
#[allow(clippy::print_stderr, reason = "a test that is skipped has to say so")]
fn libraries_of_other_users_are_passed_over() {
    let here = folder(&[]);
    let (models, work) = (here.path().join("models"), here.path().join("work"));
    fs::create_dir_all(&models).unwrap();
    fs::create_dir_all(&work).unwrap();
    fs::write(models.join("Planted.mo"), "package Planted constant Real R = 9; end Planted;")
        .unwrap();
    fs::write(work.join("N.mo"), "model N Real x = Planted.R; end N;").unwrap();
    let (arguments, planted) = (["check", "N.mo", "--model", "N"], models.join("Planted.mo"));
    let own = ended(&work, &arguments);
    assert!(!own.contains("error"), "{own}");
    const SOMEBODY: u32 = 12_345;
    if std::os::unix::fs::chown(&models, Some(SOMEBODY), None).is_err() {
        eprintln!("skipped: only the superuser can give files away");
        return;
    }
    let others = ended(&work, &arguments);
    assert!(
        others.contains("`Planted` is not taken from") && others.contains("another user"),
        "{others}"
    );
    assert!(others.contains("unknown-class") || others.contains("unknown-name"), "{others}");
    // In a folder of somebody else that the user has named, libraries of the same owner are used.
    for path in [&planted, &work, &work.join("N.mo")] {
        std::os::unix::fs::chown(path, Some(SOMEBODY), None).unwrap();
    }
    let same = ended(&work, &arguments);
    assert!(!same.contains("not taken") && !same.contains("error"), "{same}");
}
