//! Complete identifications in the habits of different people: each `run.mos` of
//! `tests/identifications/*/` is run in a world in memory; what it prints lies in the intervals of
//! `expected.txt`, which `make.py` beside them has computed without the program.

use crate::support::transcript::world_of;
use gapilib::{Options, Session, Transcript};
use std::fs;
use std::path::{Path, PathBuf};

fn folders() -> Vec<PathBuf> {
    let all = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/identifications");
    let entries = fs::read_dir(all).expect("a readable folder");
    let paths = entries.map(|entry| entry.expect("a readable entry").path());
    let mut folders: Vec<PathBuf> = paths.filter(|path| path.is_dir()).collect();
    folders.sort();
    folders
}

/// The values that a script prints as `key = value`; the last one of a key counts.
fn printed(transcript: &str, key: &str) -> Option<f64> {
    let lines = transcript.lines().rev().map(|line| line.trim_matches('"'));
    let mut values = lines.filter_map(|line| line.strip_prefix(key)?.strip_prefix(" = "));
    values.next()?.parse().ok()
}

/// What is wrong with the run of a set; nothing if all is as expected.
fn problems(folder: &Path) -> Vec<String> {
    let options = Options { probe: gapilib::internals::identify::Probe::Off, ..Options::default() };
    let mut session = Session::new(Box::new(world_of(folder))).with_options(options);
    session.output.transcript = Some(Transcript::default());
    let status = session.run_file(Path::new("run.mos"));
    let transcript = session.output.transcript.take().unwrap_or_default().to_string();
    let mut wrong = Vec::new();
    if status.code != 0 {
        wrong.push(format!("exit code {}\n{transcript}", status.code));
    }
    let expected = fs::read_to_string(folder.join("expected.txt")).expect("expected values");
    for line in expected.lines() {
        let (key, range) = line.split_once(" = ").expect("key = low .. high");
        let (low, high) = range.split_once(" .. ").expect("low .. high");
        let (low, high): (f64, f64) = (low.parse().expect("low"), high.parse().expect("high"));
        match printed(&transcript, key) {
            Some(value) if (low..=high).contains(&value) => {}
            found => wrong.push(format!("{key}: {found:?}, expected {range}")),
        }
    }
    wrong
}

#[test]
fn sets_of_other_people_find_what_is_expected() {
    let folders = folders();
    assert_eq!(folders.len(), 20);
    let mut wrong = String::new();
    for folder in folders {
        for problem in problems(&folder) {
            wrong.push_str(&format!("{}: {problem}\n", folder.display()));
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}
