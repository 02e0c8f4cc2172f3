//! Functions and models of the shipped libraries, called from scripts that stand alone.

use crate::support::program::{folder, gapi};
use std::fs;

#[test]
fn zeros_and_integrals_are_exact_and_bad_input_is_told() {
    let text = include_str!("../../data/nonlinear.mos");
    let here = folder(&[("nonlinear.mos", text)]);
    let (code, out, errors) = gapi(&here, &["run", "nonlinear.mos"]);
    assert_eq!(code, 1);
    let comparison = |line: &&str| line.contains(") < 1e") || line.contains(") < 3e");
    let limits = |line: &&str| line.contains("Constants.inf") && line.contains(['<', '>']);
    let expected = text.lines().filter(|line| comparison(line) || limits(line)).count();
    // The simulation of the model answers as well.
    let answers = out.lines().filter(|line| *line == " = true").count();
    assert!(expected > 15 && answers >= expected, "{answers} of {expected}\n{out}{errors}");
    assert_eq!(out.matches(" = false").count(), 1, "the last simulation\n{out}");
    assert!(out.contains(" = 2.0\n") && out.contains(" = 0.0\n"), "{out}");
    for (message, count) in [
        ("has the same sign at both ends", 2),
        ("`sqrt(-1.0)`: the argument must not be negative", 2),
    ] {
        let found =
            errors.lines().filter(|line| line.starts_with("error[") && line.contains(message));
        assert_eq!(found.count(), count, "{message}\n{errors}");
    }
}

/// The file that `saveTotalModel` writes of a shipped model, alone in a folder, gives the same bytes.
#[test]
fn total_models_simulate_to_the_same_bytes() {
    for (library, model) in [
        ("FuelCellLib", "FuelCellLib.casestudies.FC2Layer"),
        ("CaseStudies", "CaseStudies.LoadSteps"),
        ("CaseStudies", "CaseStudies.PolarizationCurve"),
    ] {
        let simulate = format!(
            "simulate({model}, stopTime = 0.1, numberOfIntervals = 20, fileNamePrefix = \"a\", outputFormat = \"csv\");\ngetErrorString();\n"
        );
        let save =
            format!("loadModel({library});\n{simulate}saveTotalModel(\"total.mo\", {model});\n");
        let here = folder(&[("save.mos", &save)]);
        let (code, out, errors) = gapi(&here, &["run", "save.mos", "--allow-write"]);
        assert_eq!((code, out.lines().last()), (0, Some("true")), "{model}\n{out}{errors}");
        let total = fs::read_to_string(here.path().join("total.mo")).expect("it was written");
        let load = format!("loadFile(\"total.mo\");\n{simulate}");
        let there = folder(&[("load.mos", &load), ("total.mo", &total)]);
        let (code, out, errors) = gapi(&there, &["run", "load.mos"]);
        assert_eq!(code, 0, "{model}\n{out}{errors}");
        let results = |folder: &tempfile::TempDir| {
            fs::read(folder.path().join("a_res.csv")).expect("results")
        };
        assert!(results(&here) == results(&there), "{model}");
    }
}
