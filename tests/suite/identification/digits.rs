//! The same digits on every machine: identifications run in processes of their own, as another
//! processor would run them, and their results are compared byte for byte.

use crate::support::program::{command, folder};
use crate::support::shipped::project;
use std::fs;
use std::path::Path;

/// A way to run the program: its name, arguments, and environment.
type Way = (&'static str, &'static [&'static str], &'static [(&'static str, &'static str)]);

/// The environment takes features of the processor away from the C library, as an older processor
/// would.
const WAYS: [Way; 3] = [
    ("machine code", &[], &[]),
    ("interpreted", &["--interpret"], &[]),
    (
        "without fused multiply-add",
        &[],
        &[("GLIBC_TUNABLES", "glibc.cpu.hwcaps=-FMA,-FMA4,-AVX2,-AVX2_Usable,-AVX512F")],
    ),
];

/// Files of a run but for its times, by name.
fn results(at: &Path) -> Vec<(String, Vec<u8>)> {
    let name = |entry: &fs::DirEntry| entry.file_name().to_string_lossy().into_owned();
    let entries = fs::read_dir(at).unwrap().map(Result::unwrap);
    let mut found: Vec<_> =
        entries.map(|entry| (name(&entry), fs::read(entry.path()).unwrap())).collect();
    found.retain(|(name, _)| name != "timing.json");
    found.sort();
    found
}

/// The folder of the project below another, with a line of a file replaced for each word that it
/// begins with.
fn copied(from: &Path, to: &Path, lines: &[(&str, &str)]) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap().map(Result::unwrap) {
        let (from, to) = (entry.path(), to.join(entry.file_name()));
        if from.is_dir() {
            copied(&from, &to, lines);
        } else if let Ok(text) = fs::read_to_string(&from) {
            let line = |own: &str| {
                let other = lines.iter().find(|(start, _)| own.starts_with(start));
                other.map_or(format!("{own}\n"), |(start, value)| format!("{start}{value}\n"))
            };
            fs::write(to, text.lines().map(line).collect::<String>()).unwrap();
        } else {
            fs::copy(from, to).unwrap();
        }
    }
}

/// Runs `gapi ARGUMENTS` in every way; every byte of the results must be the same.
fn same_in_every_way(arguments: &[&str], lines: &[(&str, &str)]) {
    let here = folder(&[]);
    for name in ["models", "scripts"] {
        copied(&project(name), &here.path().join(name), lines);
    }
    let of = |(way, more, environment): (&str, &[&str], &[(&str, &str)])| {
        let mut command = command(here.path(), arguments);
        let command = command.args(["--out", way]).args(more).envs(environment.iter().copied());
        let done = command.output().unwrap();
        let text = String::from_utf8_lossy(&done.stderr);
        assert!(done.status.success(), "{way}: {text}");
        results(&here.path().join(way))
    };
    let first = of(WAYS[0]);
    assert!(first.iter().any(|(name, bytes)| name == "history.csv" && bytes.len() > 300));
    for way in &WAYS[1..] {
        for ((name, expected), (other, found)) in first.iter().zip(of(*way)) {
            assert!(*name == other && *expected == found, "{}: {name} differs", way.0);
        }
    }
}

#[test]
fn the_load_steps_have_the_same_digits_on_every_machine() {
    let lines = [("N_Population = ", "12"), ("N_Parents = ", "8"), ("N_Cycle = ", "3")];
    same_in_every_way(&["run", "scripts/load_steps/GAPILib.mos"], &lines);
}

#[test]
fn a_polarization_curve_has_the_same_digits_on_every_machine() {
    let lines = [("evaluations = ", "300")];
    same_in_every_way(&["identify", "scripts/problems/polarization.toml"], &lines);
}
