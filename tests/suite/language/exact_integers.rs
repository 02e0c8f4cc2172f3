//! Integers of models, which compute with Reals: exact up to 2^53, and refused beyond (MLS §4.9.2).

use crate::support::program::{command, folder};
use crate::support::simulated::{Run, program, simulated};
use std::fs;

const MODELS: &str = include_str!("../../data/models/exact_integers.mo");

fn of(model: &str) -> String {
    format!("{MODELS}\nmodel Own = ExactIntegers.{model};")
}

#[test]
fn integers_up_to_the_largest_are_exact() {
    let run: Run = simulated(&of("Exact"), 0.15);
    // 0 and 1 are the seeds.
    assert_eq!((run.first("small"), run.last("small")), (12345.0, 1_103_527_590.0));
    // The 70th and the 71st number.
    let fibonacci = (run.first("sum"), run.last("sum"));
    assert_eq!(fibonacci, (190_392_490_709_135.0, 308_061_521_170_129.0));
    let product = 2_147_483_648_i64 * 4_194_303;
    assert_eq!(run.first("number"), product as f64);
    assert_eq!(run.last("number"), (product + 4_194_303) as f64);
}

/// What a simulation of a model says.
fn said(model: &str) -> String {
    let here = folder(&[]);
    fs::write(here.path().join("Own.mo"), of(model)).expect("a file");
    let arguments = ["simulate", "Own.mo", "--model", "Own", "--stop-time", "1"];
    let done = command(here.path(), &arguments).output().expect("the program runs");
    assert!(!done.status.success(), "{model} is simulated");
    String::from_utf8_lossy(&done.stderr).into_owned()
}

#[test]
fn integers_that_models_cannot_hold_are_refused() {
    // Without the check `mod` takes products that are rounded, and gives other numbers than in a script.
    for model in [
        "Inlined",
        "Compiled",
        "Sum",
        "Matrix",
        "Equation",
        "OuterProduct",
        "Cross",
        "PartialSum",
        "SumOfArrays",
    ] {
        let said = said(model);
        assert!(said.contains("beyond 9007199254740991"), "{model}: {said}");
    }
}

#[test]
fn constants_and_reductions_are_refused_at_translation() {
    for value in ["mod(p*987654321, 97)", "ExactIntegers.ofAll(25)", "mod(9007199254740993, 2)"] {
        let text = format!(
            "{MODELS}\nmodel Own constant Integer p = 123456789; Integer f; \
             algorithm f := {value}; end Own;"
        );
        let refused = crate::support::simulated::refused(&text);
        assert!(refused.starts_with("integer-overflow"), "{value}: {refused}");
    }
    program(&of("Exact"));
}
