//! `gapi linearize`: poles, zeros and responses against their formulas.

use crate::support::program::{folder, gapi};
use gapilib::internals::frequency::Number;
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
        ("I.mo", "model I input Real i; output Real v; equation v = 2*der(i) + 3*i; end I;\n"),
        ("S.mo", "model S Real x(start = 1, fixed = true); equation der(x) = -x; end S;\n"),
    ]);
    for (arguments, said) in [
        (&["linearize", "O.mo", "--input", "f"][..], "`f` is not a continuous input"),
        (&["linearize", "O.mo", "--output", "y"], "`y`"),
        (&["linearize", "O.mo", "--response", "r.csv", "--from", "3", "--to", "1"], "no range"),
        (&["linearize", "S.mo", "--bode", "b.svg"], "the model has no input"),
        (&["linearize", "O.mo", "--bode", "b.txt"], "b.txt"),
        (&["linearize", "I.mo", "--matrices", "i.mat"], "the derivative of its input `i`"),
    ] {
        let (code, out, errors) = gapi(&here, arguments);
        assert_eq!(code, 1, "{out}{errors}");
        assert!(errors.contains(said), "{said}\n{errors}");
        // Names of variables that the program has added are not proposed.
        assert!(!errors.contains("'derivative"), "{errors}");
        assert!(!here.path().join("r.csv").exists(), "nothing is written");
    }
    // What the matrices do not have, poles, zeros and responses have.
    let arguments = ["linearize", "I.mo", "--bode", "i.svg", "--from", "1", "--to", "10"];
    let (code, out, errors) = gapi(&here, &arguments);
    assert!(code == 0 && out.contains("  -1.5 "), "{out}{errors}");
    assert!(out.contains("static gain of v/i: 3"), "{out}");
    // Poles are shown without inputs.
    let (code, out, _) = gapi(&here, &["linearize", "S.mo"]);
    assert!(code == 0 && out.contains("  -1 "), "{out}");
}

/// The largest distance between the response of a model with input `u` and output `y`, and a formula,
/// relative to its magnitude.
fn distance(model: &str, formula: impl Fn(Number) -> Number) -> f64 {
    let here = folder(&[("M.mo", model)]);
    let arguments = ["linearize", "M.mo", "--response", "r.csv", "--from", "1e-4", "--to", "1e3"];
    let (code, out, errors) = gapi(&here, &arguments);
    assert_eq!(code, 0, "{out}{errors}");
    let text = fs::read_to_string(here.path().join("r.csv")).unwrap();
    let rows = text.lines().skip(1).map(|line| {
        let row: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
        let exact = formula(Number::new(0.0, std::f64::consts::TAU * row[0]));
        (Number::new(row[1], row[2]) - exact).norm_sqr().sqrt() / exact.norm_sqr().sqrt()
    });
    rows.fold(0.0, f64::max)
}

/// A ladder of rungs with a series element z and a parallel element p, fed at its begin and short at its
/// end: the impedance by continued fractions.
fn ladder(rungs: usize, z: Number, p: Number) -> Number {
    (0..rungs).fold(Number::default(), |rest, _| {
        let both = z + rest;
        p * both / (p + both)
    })
}

#[test]
fn responses_are_those_of_the_formulas() {
    let one = Number::new(1.0, 0.0);
    // 100 volumes of diffusion: capacities of 0.01, conductances of 100 between them, 1 to the outside.
    let diffusion = "model M\n  parameter Integer n = 100;\n  input Real u(start = 0);\n  \
        output Real y;\n  Real c[n](each start = 0, each fixed = true);\nequation\n  \
        0.01*der(c[1]) = u - 100*(c[1] - c[2]);\n  for i in 2:n - 1 loop\n    \
        0.01*der(c[i]) = 100*(c[i - 1] - 2*c[i] + c[i + 1]);\n  end for;\n  \
        0.01*der(c[n]) = 100*(c[n - 1] - c[n]) - c[n];\n  y = c[1];\nend M;\n";
    let of_diffusion = |s: Number| {
        let last = one / (s * 0.01 + 1.0);
        (1..100).fold(last, |rest, _| one / (s * 0.01 + one / (rest + 0.01)))
    };
    assert!(distance(diffusion, of_diffusion) < 1e-9);
    // 40 rungs of inductance with resistance, and capacitance, short at the end.
    let line = "model M\n  parameter Integer n = 40;\n  input Real u(start = 0);\n  output Real y;\n  \
        Real v[n](each start = 0, each fixed = true);\n  \
        Real i[n](each start = 0, each fixed = true);\nequation\n  \
        0.1*der(v[1]) = u - i[1];\n  for k in 2:n loop\n    0.1*der(v[k]) = i[k - 1] - i[k];\n  \
        end for;\n  for k in 1:n - 1 loop\n    0.2*der(i[k]) = v[k] - v[k + 1] - 0.3*i[k];\n  \
        end for;\n  0.2*der(i[n]) = v[n] - 0.3*i[n];\n  y = v[1];\nend M;\n";
    let of_line = |s: Number| ladder(40, s * 0.2 + 0.3, one / (s * 0.1));
    assert!(distance(line, of_line) < 1e-9);
    for (declarations, equations, formula) in SMALL {
        let model = format!(
            "model M\n  input Real u(start = 0);\n  output Real y;\n  {declarations}\nequation\n  \
             {equations}\nend M;\n"
        );
        let off = distance(&model, formula);
        assert!(off < 1e-9, "{equations}: {off:e}");
    }
}

type Formula = fn(Number) -> Number;

/// Filters, drives and loops: declarations, equations, and y/u.
const SMALL: [(&str, &str, Formula); 10] = [
    // Butterworth, third order.
    (
        "Real x[3](each start = 0, each fixed = true);",
        "der(x[1]) = x[2]; der(x[2]) = x[3]; der(x[3]) = u - x[1] - 2*x[2] - 2*x[3]; y = x[1];",
        |s| 1.0 / ((s + 1.0) * (s * s + s + 1.0)),
    ),
    // An all-pass: a zero in the right half plane.
    ("Real x(start = 0, fixed = true);", "der(x) = u - x; y = 2*x - u;", |s| (1.0 - s) / (1.0 + s)),
    // A notch.
    (
        "Real x(start = 0, fixed = true); Real v(start = 0, fixed = true);",
        "der(x) = v; der(v) = u - 4*x - 0.8*v; y = u - 0.72*v;",
        |s| (s * s + s * 0.08 + 4.0) / (s * s + s * 0.8 + 4.0),
    ),
    // A lead: the input's derivative is filtered.
    ("Real x(start = 0, fixed = true);", "0.01*der(x) = u - x; y = 3*u + 2*(u - x)/0.01;", |s| {
        3.0 + s * 2.0 / (s * 0.01 + 1.0)
    }),
    // A motor: voltage to speed.
    (
        "Real i(start = 0, fixed = true); Real w(start = 0, fixed = true);",
        "0.5*der(i) = u - 2*i - 0.1*w; 0.02*der(w) = 0.1*i - 0.005*w; y = w;",
        |s| 0.1 / ((s * 0.5 + 2.0) * (s * 0.02 + 0.005) + 0.01),
    ),
    // Two masses on a shaft, index 2 where the masses are rigidly coupled to the gear: w = 5 v.
    (
        "Real w(start = 0, fixed = true, stateSelect = StateSelect.prefer); Real v; Real t;",
        "w = 5*v; 2*der(w) = u - t/5; 3*der(v) = t - 0.7*v; y = v;",
        |s| (1.0 / 5.0) / (s * (2.0 + 3.0 / 25.0) + 0.7 / 25.0),
    ),
    // A control loop: PI on a plant of second order, from the reference.
    (
        "Real e; Real q(start = 0, fixed = true); Real a(start = 0, fixed = true); \
         Real b(start = 0, fixed = true);",
        "e = u - b; der(q) = e; der(a) = 3*e + q - a; 2*der(b) = a - b; y = b;",
        |s| {
            let open = (3.0 + 1.0 / s) / ((s + 1.0) * (s * 2.0 + 1.0));
            open / (open + 1.0)
        },
    ),
    // An inductance with a resistance: the derivative of the input is in the output.
    ("", "y = 3*u + 2*der(u);", |s| s * 2.0 + 3.0),
    // Derivatives of the input up to the second one, in the states as well.
    (
        "Real x(start = 0, fixed = true); Real v;",
        "2*der(x) = u - x + 3*der(u); v = der(u); y = x + v + 0.1*der(v);",
        |s| (s * 3.0 + 1.0) / (s * 2.0 + 1.0) + s + s * s * 0.1,
    ),
    // A nonlinear loop about its solution z = 1: 3 z² + 1 = 4.
    (
        "Real x(start = 1, fixed = true); Real z(start = 1);",
        "z^3 + z = u + 2*x; der(x) = 1 - z; y = z;",
        |s| s / (s * 4.0 + 2.0),
    ),
];

/// Events before the point have changed the discrete variables; delays are refused.
#[test]
fn a_model_is_linearized_with_the_discrete_values_of_its_point() {
    let model = "model K\n  input Real u(start = 0);\n  output Real y = x;\n  \
        Real x(start = 1, fixed = true);\n  discrete Real k(start = 1, fixed = true);\nequation\n  \
        when time >= 1 then\n    k = 3;\n  end when;\n  der(x) = -k*x + u;\nend K;\n";
    let delayed = "model D\n  input Real u(start = 0);\n  output Real y = delay(x, 1);\n  \
        Real x(start = 1, fixed = true);\nequation\n  der(x) = u - x;\nend D;\n";
    let direct = "model G\n  input Real u(start = 0);\n  output Real y = 7*u;\nend G;\n";
    let here = folder(&[("K.mo", model), ("D.mo", delayed), ("G.mo", direct)]);
    for (time, pole) in [("0.5", "  -1 "), ("2", "  -3 ")] {
        let (code, out, errors) = gapi(&here, &["linearize", "K.mo", "--stop-time", time]);
        assert!(code == 0 && out.contains(pole), "{time}: {out}{errors}");
    }
    let (code, _, errors) = gapi(&here, &["linearize", "D.mo"]);
    assert!(code == 1 && errors.contains("`delay` and `spatialDistribution`"), "{errors}");
    let (code, out, errors) = gapi(&here, &["linearize", "G.mo"]);
    assert!(code == 0 && out.contains("static gain of y/u: 7"), "{out}{errors}");
}
