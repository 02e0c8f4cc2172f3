//! Machine code that asks for the solution of a large linear system and calls functions: a
//! simulation gives the same bytes as with the interpreter.

use crate::support::program::{command, folder};
use std::fs;

const MODEL: &str = include_str!("../../data/models/upcalls_model.mo");

#[test]
fn systems_and_functions_give_the_same_bytes_as_the_interpreter() {
    let here = folder(&[]);
    fs::write(here.path().join("Upcalls.mo"), MODEL).unwrap();
    let run = |name: &str, more: &[&str]| {
        let arguments = ["simulate", "Upcalls.mo", "-o", name];
        let done = command(here.path(), &arguments).args(more).output().unwrap();
        let text = String::from_utf8_lossy(&done.stderr).into_owned();
        assert!(done.status.success(), "{text}");
        let said = format!("{text}{}", String::from_utf8_lossy(&done.stdout));
        let evaluations =
            said.split(", ").find_map(|part| part.strip_suffix(" right-hand side evaluations"));
        // Machine code is made after a thousand.
        let evaluations: u32 = evaluations.and_then(|n| n.parse().ok()).expect("a count");
        assert!(evaluations > 3000, "{said}");
        fs::read(here.path().join(name)).unwrap()
    };
    let (translated, interpreted) = (run("a.csv", &[]), run("b.csv", &["--interpret"]));
    assert!(translated.len() > 10_000 && translated == interpreted);
}
