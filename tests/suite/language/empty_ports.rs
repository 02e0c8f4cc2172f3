//! Parts of an array of components without elements, in equations: no size beyond the first is
//! known of them, and no scalar equation comes of them.

use crate::support::program::{command, folder};
use std::fs;

const MODEL: &str = include_str!("../../data/models/empty_ports_model.mo");

#[test]
fn parts_of_ports_without_elements_have_no_equations() {
    let here = folder(&[]);
    fs::write(here.path().join("EmptyPorts.mo"), MODEL).unwrap();
    let run = |model: &str| {
        fs::write(here.path().join("EmptyPorts.mo"), model).unwrap();
        command(here.path(), &["check", "EmptyPorts.mo"]).output().unwrap()
    };
    let done = run(MODEL);
    assert!(done.status.success(), "{done:?}");
    // With elements these are equations, of other sizes and too many.
    let wrong = MODEL.replace("n = 0", "n = 1").replace("fill(v, n)", "fill(1, n)");
    assert!(!run(&wrong).status.success());
}
