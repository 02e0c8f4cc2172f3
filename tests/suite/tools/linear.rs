//! `gapi linearize`: poles, zeros and responses against their formulas.

use crate::support::program::{folder, gapi};
use std::fs;

/// A mass on a spring and a damper, of which the force is the input: x/F = 1/(m s² + d s + k) with
/// m = 2, d = 4, k = 20, and a = s² x.
const OSCILLATOR: &str = "model Oscillator\n  parameter Real m = 2;\n  input Real F(start = 0);\n  \
    output Real x(start = 0, fixed = true);\n  Real v(start = 0, fixed = true);\n  Real a;\n\
equation\n  der(x) = v;\n  a = der(v);\n  m*a = F - 4*v - 20*x;\nend Oscillator;\n";

#[test]
fn poles_zeros_and_responses_are_those_of_the_formula() {
    let here = folder(&[("O.mo", OSCILLATOR)]);
    let (code, out, errors) = gapi(&here, &["linearize", "O.mo", "--response", "r.csv"]);
    assert_eq!(code, 0, "{out}{errors}");
    insta::assert_snapshot!(out);
    let text = fs::read_to_string(here.path().join("r.csv")).unwrap();
    let rows = text
        .lines()
        .skip(1)
        .map(|line| line.split(',').map(|cell| cell.parse::<f64>().unwrap()).collect::<Vec<f64>>());
    let mut count = 0;
    for row in rows {
        let omega = std::f64::consts::TAU * row[0];
        let (re, im) = (20.0 - 2.0 * omega * omega, 4.0 * omega);
        let square = re * re + im * im;
        let magnitude = -10.0 * square.log10();
        assert!((row[1] - re / square).abs() < 1e-12 && (row[2] + im / square).abs() < 1e-12);
        assert!((row[3] - magnitude).abs() < 1e-9, "{row:?}");
        assert!((row[4] + im.atan2(re).to_degrees()).abs() < 1e-9, "{row:?}");
        count += 1;
    }
    // Two decades about the one pair of poles.
    assert_eq!(count, 41);
}

/// The acceleration answers directly and has two zeros at the origin; parameters are set.
#[test]
fn any_variable_may_be_the_output() {
    let here = folder(&[("O.mo", OSCILLATOR)]);
    let arguments = [
        "linearize",
        "O.mo",
        "--output",
        "a",
        "--set",
        "m=5",
        "--bode",
        "b.svg",
        "--matrices",
        "l.mat",
    ];
    let (code, out, errors) = gapi(&here, &arguments);
    assert_eq!(code, 0, "{out}{errors}");
    insta::assert_snapshot!(out);
    let picture = fs::read_to_string(here.path().join("b.svg")).unwrap();
    assert!(picture.contains("magnitude (dB)") && picture.contains("phase (deg)"), "{picture}");
    assert!(here.path().join("l.mat").exists());
}

#[test]
fn what_cannot_be_shown_is_refused() {
    let here = folder(&[
        ("O.mo", OSCILLATOR),
        ("S.mo", "model S Real x(start = 1, fixed = true); equation der(x) = -x; end S;\n"),
    ]);
    for (arguments, said) in [
        (&["linearize", "O.mo", "--input", "f"][..], "`f` is not a continuous input"),
        (&["linearize", "O.mo", "--output", "y"], "`y`"),
        (&["linearize", "O.mo", "--response", "r.csv", "--from", "3", "--to", "1"], "no range"),
        (&["linearize", "S.mo", "--bode", "b.svg"], "the model has no input"),
        (&["linearize", "O.mo", "--bode", "b.txt"], "b.txt"),
    ] {
        let (code, out, errors) = gapi(&here, arguments);
        assert_eq!(code, 1, "{out}{errors}");
        assert!(errors.contains(said), "{said}\n{errors}");
        assert!(!here.path().join("r.csv").exists(), "nothing is written");
    }
    // Poles are shown without inputs.
    let (code, out, _) = gapi(&here, &["linearize", "S.mo"]);
    assert!(code == 0 && out.contains("  -1 "), "{out}");
}
