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
        "Fit adds up the squared differences",
        "Ranks 1 and 2 have two children",
        "below F_Mut = 0.5",
        "Individual 9 of the next generation is drawn at random",
    ] {
        assert!(out.contains(part), "`{part}` is missing:\n{out}");
    }
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
    let report = std::fs::read_to_string(here.path().join("results/result.json")).unwrap();
    assert!(page.contains("Discharge") && report.contains("standard_deviation"));
    assert!(page.contains("\"standard_deviation\""), "the page has no report");
}

#[test]
fn what_is_no_trace_is_refused() {
    let here = folder(&[("notes.txt", "hello"), ("nothing.mos", "// t\nx := 1;\n")]);
    let (code, _, errors) = gapi(&here, &["teach", "notes.txt"]);
    assert!(code == 1 && errors.contains("this is no trace of gapilib"), "{errors}");
    let (code, _, errors) = gapi(&here, &["teach", "nothing.mos"]);
    assert!(code == 1 && errors.contains("the trace holds no generation"), "{errors}");
}
