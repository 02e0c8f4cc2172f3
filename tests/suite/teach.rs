//! `gapi teach` and `gapi run --trace` as a user starts them.

use crate::cli::{folder, gapi};
use crate::shipped::project;

/// A folder with lesson 7: two searches of thirty generations with twelve individuals.
fn with_search() -> tempfile::TempDir {
    let script = project("scripts/lessons/07_elites.mos");
    folder(&[("search.mos", &std::fs::read_to_string(script).unwrap())])
}

#[test]
fn a_recorded_run_is_walked_through() {
    let here = with_search();
    let (code, _, errors) = gapi(&here, &["run", "search.mos", "--trace", "search.trace"]);
    assert_eq!(code, 0, "{errors}");
    let bytes = std::fs::read(here.path().join("search.trace")).unwrap();
    let genes = 2 * 30 * 12 * 2;
    assert!(bytes.len() < 50 * genes, "{} bytes for {genes} genes", bytes.len());
    let (code, out, _) = gapi(&here, &["teach", "search.trace"]);
    assert_eq!(code, 0);
    for part in [
        "Generation 1, step 1 of",
        "search.mos:38  ",
        "Fit is the sum of squared residuals",
        "Ranks 1 and 2 have two children",
        "below F_Mut = 0.5",
        "Individual 9 of the next generation is sampled at random",
    ] {
        assert!(out.contains(part), "`{part}` is missing:\n{out}");
    }
    // The file may lie anywhere: it is the user who names it.
    let elsewhere = folder(&[]);
    let there = elsewhere.path().join("there.trace");
    let (code, _, errors) = gapi(&here, &["run", "search.mos", "--trace", there.to_str().unwrap()]);
    assert!(code == 0 && std::fs::read(there).unwrap() == bytes, "{errors}");
    // What an interrupted run leaves is read up to there.
    std::fs::write(here.path().join("cut.trace"), &bytes[..bytes.len() / 2]).unwrap();
    let (code, out, _) = gapi(&here, &["teach", "cut.trace"]);
    assert!(code == 0 && out.contains("Generation 1, step 1 of"), "{out}");
}

#[test]
fn a_script_becomes_a_page() {
    let here = with_search();
    let (code, _, errors) = gapi(&here, &["teach", "search.mos", "--html", "steps.html"]);
    assert_eq!(code, 0, "{errors}");
    let page = std::fs::read_to_string(here.path().join("steps.html")).unwrap();
    let report = std::fs::read_to_string(here.path().join("results/search/result.json")).unwrap();
    assert!(page.contains("Discharge") && report.contains("least squares from there"));
    assert!(page.contains("least squares from there"), "the page has no report");
}

#[test]
fn what_is_no_trace_is_refused() {
    let here = folder(&[("notes.txt", "hello"), ("nothing.mos", "// t\nx := 1;\n")]);
    let (code, _, errors) = gapi(&here, &["teach", "notes.txt"]);
    assert!(code == 1 && errors.contains("this is not a trace of gapilib"), "{errors}");
    let (code, _, errors) = gapi(&here, &["teach", "nothing.mos"]);
    assert!(code == 1 && errors.contains("the trace contains no generation"), "{errors}");
}

#[test]
fn a_run_is_compared_with_what_it_would_have_been() {
    let here = with_search();
    let what_if = |statement: &str, generation: &str| {
        let options = ["--what-if", statement, "--generation", generation];
        gapi(&here, &[&["teach", "search.mos"], options.as_slice()].concat())
    };
    let (code, out, errors) = what_if("F_Mut := 1.0", "3");
    assert_eq!(code, 0, "{errors}");
    assert!(out.contains("What if F_Mut := 1.0 from generation 3?"), "{out}");
    assert!(here.path().join("results/search/what_if.svg").exists());
    let of = |number: &str| -> Vec<String> {
        let line = out.lines().find(|line| line.trim_start().starts_with(number)).expect("a row");
        line.split_whitespace().skip(1).map(str::to_owned).collect()
    };
    // The change comes after the simulation of its generation.
    assert_eq!(of("3 ")[0], of("3 ")[1], "{out}");
    assert_ne!(of("60")[0], of("60")[1], "{out}");
    let (code, _, errors) = what_if("F_Mut := 1.0", "61");
    assert!(code == 1 && errors.contains("the run has no generation 61"), "{errors}");
    let (code, _, errors) = what_if("F_Mut := := 1", "3");
    assert!(code == 1 && errors.contains("what if:1:"), "{errors}");
}

#[test]
fn answers_are_read_and_counted() {
    let here = with_search();
    let (code, out, errors) = gapi(&here, &["teach", "search.mos", "--quiz"]);
    assert_eq!(code, 0, "{errors}");
    assert!(out.contains("? Which ") || out.contains("become parents"), "{out}");
    assert!(out.ends_with("No question was answered.\n"), "{out}");
}

#[test]
fn a_function_that_calls_eval_cannot_be_changed() {
    let script = "model Line\n  parameter Real a = 0;\n  output Real y = a*time;\n\
        annotation(experiment(StopTime = 2));\nend Line;\nfunction Try\n  output Real y;\n\
        protected\n  Real r[1,2];\nalgorithm\n  \
        r := Eval(\"\", \"Line\", {0, 1}, [1], {\"a\"}, \"time\", \"y\");\n  y := r[1,2];\n\
        end Try;\nx := Try();\n";
    let here = folder(&[("in_function.mos", script)]);
    let (code, _, errors) =
        gapi(&here, &["teach", "in_function.mos", "--what-if", "x := 1", "--generation", "1"]);
    assert!(code == 1 && errors.contains("[cannot-branch]"), "{errors}");
}
