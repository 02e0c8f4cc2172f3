//! Spectra of models against formulas and against independent fits of the same numbers.

use crate::support::identified::{assert_near, parameter, refused, solved};
use gapilib::internals::frequency::Number;
use serde_json::Value;
use std::f64::consts::TAU;
use std::fmt::Write as _;

fn tanh(root: Number) -> Number {
    let small = (-2.0 * root).exp();
    (1.0 - small) / (1.0 + small)
}

fn frequencies(from: f64, to: f64, count: usize) -> Vec<f64> {
    let ratio = (to / from).ln() / (count - 1) as f64;
    (0..count).map(|k| from * (ratio * k as f64).exp()).collect()
}

/// The table of a spectrum.
fn table(frequencies: &[f64], spectrum: impl Fn(Number) -> Number) -> String {
    let mut text = "f,re,im\n".to_owned();
    for f in frequencies {
        let z = spectrum(Number::new(0.0, TAU * f));
        writeln!(text, "{f:.17e},{:.17e},{:.17e}", z.re, z.im).unwrap();
    }
    text
}

/// A problem with one spectrum: the range of each parameter is a decade around the value after `start`.
fn problem(model: &str, parameters: &[(&str, f64)], experiment: &str) -> String {
    let mut text = format!("model = \"{model}\"\nfiles = [\"M.mo\"]\n[parameters]\n");
    for (name, start) in parameters {
        let (min, max) = (start / 3.0, start * 3.0);
        writeln!(text, "{name} = {{ min = {min:e}, max = {max:e}, start = {start:e} }}").unwrap();
    }
    text + "[[experiment]]\ndata = \"d.csv\"\noutputs = { real = \"re\", imaginary = \"im\" }\n"
        + experiment
        + "\n[method]\nname = \"levenberg_marquardt\"\n"
}

/// The largest distance between measured and simulated points, relative to the magnitude.
fn distance(result: &Value) -> f64 {
    let series = result["series"].as_array().unwrap();
    let points = |at: usize| series[at]["points"].as_array().unwrap();
    let number = |value: &Value| value.as_f64().unwrap();
    let pairs = points(0).iter().zip(points(1));
    pairs.fold(0.0, |most: f64, (re, im)| {
        let size = number(&re[1]).hypot(number(&im[1]));
        let off = (number(&re[1]) - number(&re[2])).hypot(number(&im[1]) - number(&im[2]));
        most.max(off / size)
    })
}

const ELECTRODE: &str = include_str!("../../data/models/spectra_electrode.mo");

/// The same 31 points with the same weights in scipy.optimize.curve_fit 1.17 (xtol, ftol, gtol 1e-15).
#[test]
fn values_and_standard_errors_are_those_of_scipy() {
    let data = include_str!("../../data/spectra/electrode.csv");
    let problem = "model = \"Electrode\"\nfiles = [\"M.mo\"]\n[parameters]\n\
        Rm = { min = 1e-3, max = 1 }\nRct = { min = 1e-3, max = 10 }\nQ = { min = 1e-3, max = 1 }\n\
        alpha = { min = 0.5, max = 1 }\n[[experiment]]\ndata = \"d.csv\"\n\
        spectrum = { input = \"i\", output = \"v\" }\n\
        outputs = { real = \"Re(Z)/Ohm\", imaginary = \"-Im(Z)/Ohm\" }\n";
    let files = [("M.mo", ELECTRODE), ("d.csv", data), ("p.toml", problem)];
    let (result, said) = solved(&files);
    assert!(said.contains("exact, by sensitivity equations"), "{said}");
    assert!(said.contains("can be that of a linear, stationary system"), "{said}");
    for (name, value, error) in [
        ("Rm", 0.06195301, 6.99569751e-05),
        ("Rct", 0.30914443, 2.73207274e-04),
        ("Q", 0.01993375, 1.25522437e-04),
        ("alpha", 0.85036258, 9.11706376e-04),
    ] {
        let [found, found_error] = parameter(&result, name);
        assert_near(found, value, 1e-6);
        assert_near(found_error, error, 1e-5);
    }
}

#[test]
fn magnitude_in_decibels_and_phase_in_degrees_are_real_and_imaginary_part() {
    let z = |s: Number| 0.05 + 0.3 / (1.0 + 0.006 * s) + 3e-7 * s;
    let mut data = "frequency [rad/s],|Z| [dB],phase [deg]\n".to_owned();
    for f in frequencies(0.01, 1e5, 30) {
        let value = z(Number::new(0.0, TAU * f));
        let (size, angle) = (20.0 * value.norm().log10(), value.arg().to_degrees());
        writeln!(data, "{:.17e},{size:.17e},{angle:.17e}", TAU * f).unwrap();
    }
    let model = "model M input Real i(unit = \"A\"); output Real v(unit = \"V\"); \
        parameter Real R = 0.04; parameter Real L = 2e-7; Real u(start = 0, fixed = true); \
        equation 0.02*der(u) = i - u/0.3; v = R*i + u + L*der(i); end M;";
    let problem =
        problem("M", &[("R", 0.04), ("L", 2e-7)], "spectrum = { input = \"i\", output = \"v\" }")
            .replace(
                "{ real = \"re\", imaginary = \"im\" }",
                "{ magnitude = \"|Z|\", phase = \"phase\" }",
            );
    let (result, said) = solved(&[("M.mo", model), ("d.csv", &data), ("p.toml", &problem)]);
    assert_near(parameter(&result, "R")[0], 0.05, 1e-9);
    assert_near(parameter(&result, "L")[0], 3e-7, 1e-9);
    assert!(distance(&result) < 1e-12, "{}: {said}", distance(&result));
    assert_eq!(result["series"][0]["y"][1], "Ohm");
}

/// The operating point of v = b log(1 + i/i₀) and of what it charges moves with b and i₀, and with it the
/// spectrum: Z = r/(1 + r C s) with r = b/(i + i₀).
#[test]
fn the_operating_point_moves_with_the_parameters() {
    let model = "model M input Real i; output Real v; parameter Real b = 0.05; parameter Real i0 = 0.02; \
        parameter Real C = 2; Real f(start = 0.1); \
        equation C*der(v) = i - f; v = b*log(1 + f/i0); end M;";
    let z = |s: Number| {
        let r: f64 = 0.06 / (0.5 + 0.03);
        r / (1.0 + r * 2.0 * s)
    };
    let experiment =
        "spectrum = { input = \"i\", output = \"v\" }\nset = { i = 0.5 }\nsteady_state = true";
    let points = frequencies(1e-2, 1e3, 20);
    let one = table(&points, z);
    let other = experiment.replace("0.5", "0.05");
    let low = table(&points, |s| {
        let r: f64 = 0.06 / (0.05 + 0.03);
        r / (1.0 + r * 2.0 * s)
    });
    let second = format!(
        "{experiment}\n[[experiment]]\ndata = \"e.csv\"\noutputs = {{ real = \"re\", imaginary = \"im\" }}\n{other}"
    );
    let problem = problem("M", &[("b", 0.05), ("i0", 0.02)], &second);
    let files =
        [("M.mo", model), ("d.csv", one.as_str()), ("e.csv", low.as_str()), ("p.toml", &problem)];
    let (result, said) = solved(&files);
    assert_near(parameter(&result, "b")[0], 0.06, 1e-7);
    assert_near(parameter(&result, "i0")[0], 0.03, 1e-7);
    assert!(said.contains("exact, by sensitivity equations"), "{said}");
}

/// A point whose magnitude is not known has no weight: it is left out, and said to be.
#[test]
fn rows_without_one_part_are_left_out() {
    let model = "model M input Real i; output Real v; parameter Real k = 0.9; \
        Real x(start = 0, fixed = true); equation der(x) = i - k*x; v = x; end M;";
    let exact = table(&frequencies(1e-2, 1e2, 12), |s| 1.0 / (1.0 + s));
    let lines: Vec<&str> = exact.lines().collect();
    let cut = |line: &str| {
        let cells: Vec<&str> = line.split(',').collect();
        format!("{},,{}", cells[0], cells[2])
    };
    let lines = lines.iter().enumerate();
    let data: Vec<String> = lines
        .map(|(k, line)| if k == 1 || k == 2 { cut(line) } else { (*line).to_owned() })
        .collect();
    let problem = problem("M", &[("k", 0.9)], "spectrum = { input = \"i\", output = \"v\" }");
    let (result, said) =
        solved(&[("M.mo", model), ("d.csv", &data.join("\n")), ("p.toml", &problem)]);
    for series in result["series"].as_array().unwrap() {
        assert_eq!(series["points"].as_array().unwrap().len(), 10, "{said}");
    }
    assert!(said.contains("2 rows are left out of `imaginary`"), "{said}");
    assert!(said.contains("can be that of a linear, stationary system"), "{said}");
}

/// Models with a formula for their spectrum; the parameter `k` is 1 in the data.
#[test]
fn spectra_are_those_of_the_formulas() {
    type Formula = fn(Number) -> Number;
    let cases: [(&str, Formula); 8] = [
        ("der(x) = i - x; v = k*x;", |s| 1.0 / (s + 1.0)),
        ("der(x) = i - x; der(y) = x - k*y; v = y + i;", |s| 1.0 + 1.0 / ((s + 1.0) * (s + 1.0))),
        ("x = 0; v = k*(2*i + 3*der(i));", |s| 2.0 + 3.0 * s),
        ("x = 0; y = der(i); v = k*(i + 0.5*der(y));", |s| 1.0 + 0.5 * s * s),
        ("der(x) = y; der(y) = i - k*x - 0.1*y; v = x;", |s| 1.0 / (s * s + 0.1 * s + 1.0)),
        ("der(x) = i; v = k*x + 1;", |s| 1.0 / s),
        // An algebraic loop: z + z³ = i + x at z = 0.
        ("der(x) = i - z; z + z^3 = i + k*x; v = z;", |s| {
            // (s + k) x = (1 − 1) i, z = i + k x
            1.0 + 0.0 * s
        }),
        ("der(x) = i - z; z + z^3 = 2*i + k*x; v = z;", |s| 2.0 - 1.0 / (s + 1.0)),
    ];
    for (equations, formula) in cases {
        let unused = if equations.contains("y") { "" } else { "y = 0;" };
        let z = if equations.contains("z") { "Real z;" } else { "" };
        let model = format!(
            "model M input Real i; output Real v; parameter Real k = 0.9; Real x; Real y; {z} \
             initial equation x = 0; equation {equations} {unused} end M;"
        );
        let model = match equations.contains("der(x)") {
            true => model,
            false => model.replace("initial equation x = 0; ", ""),
        };
        let model = match equations.contains("der(y) =") {
            true => model.replace("initial equation x = 0;", "initial equation x = 0; y = 0;"),
            false => model,
        };
        let data = table(&frequencies(1e-3, 1e2, 15), formula);
        let spectrum = "spectrum = { input = \"i\", output = \"v\" }";
        let problem = problem("M", &[("k", 0.9)], spectrum);
        let (result, said) = solved(&[("M.mo", &model), ("d.csv", &data), ("p.toml", &problem)]);
        let off = distance(&result);
        assert!(off < 1e-9, "{equations}: {off:e}: {said}");
    }
}

/// The elements of `GAPILib.Impedance` are as near to their formulas as their documentation says.
#[test]
fn elements_have_the_impedance_of_their_formulas() {
    type Formula = fn(Number) -> Number;
    let cases: [(&str, Formula, f64); 4] = [
        ("ConstantPhaseElement g(Q = k, alpha = 1, fMin = 1e-4, fMax = 1e6)", |s| 1.0 / s, 2e-9),
        (
            "ConstantPhaseElement g(Q = k, alpha = 0.7, fMin = 1e-4, fMax = 1e6)",
            |s| s.powf(-0.7),
            2e-9,
        ),
        (
            "FiniteLengthDiffusion g(R = k, tau = 5)",
            |s| {
                let root = (5.0 * s).sqrt();
                tanh(root) / root
            },
            1e-6,
        ),
        (
            "FiniteSpaceDiffusion g(R = k, tau = 5)",
            |s| {
                let root = (5.0 * s).sqrt();
                1.0 / (tanh(root) * root)
            },
            1e-6,
        ),
    ];
    for (element, formula, tolerance) in cases {
        let k = if element.starts_with('C') { "1/k" } else { "k" };
        let element = element.replace("= k", &format!("= {k}"));
        let model = format!(
            "model M input Real i; output Real v; parameter Real k = 0.9; \
             GAPILib.Impedance.{element}; equation g.i = i; v = g.v; end M;"
        );
        let data = table(&frequencies(1e-3, 1e5, 17), formula);
        let problem = problem("M", &[("k", 0.9)], "spectrum = { input = \"i\", output = \"v\" }");
        let (result, said) = solved(&[("M.mo", &model), ("d.csv", &data), ("p.toml", &problem)]);
        let off = distance(&result);
        assert_eq!(result["series"][0]["points"].as_array().unwrap().len(), 17);
        assert!(off < tolerance, "{element}: {off:e}: {said}");
    }
}

#[test]
fn what_has_no_spectrum_is_refused_with_the_reason() {
    let data = table(&frequencies(1.0, 10.0, 8), |s| 1.0 / (1.0 + s));
    let model = "model M input Real i; output Real v; parameter Real k = 1; Real x(start = 0, fixed = true); \
        Real a; Real b; equation der(x) = i - k*x; v = x; a = der(i); b = der(a); end M;";
    let of = |spectrum: &str| {
        let problem = problem("M", &[("k", 1.0)], spectrum);
        refused(&[("M.mo", model), ("d.csv", &data), ("p.toml", &problem)])
    };
    let said = of("spectrum = { input = \"j\", output = \"v\" }");
    assert!(
        said.contains("`j` is not a Real input") && said.contains("its inputs are `i`"),
        "{said}"
    );
    let said = of("spectrum = { input = \"i\", output = \"w\" }");
    assert!(said.contains("no variable `w`"), "{said}");
    let said = of("spectrum = { input = \"i\", output = \"v\", weighting = \"half\" }");
    assert!(
        said.contains("weighting `half` is not known") && said.contains("\"modulus\""),
        "{said}"
    );
    let said = of("spectrum = { input = \"i\", output = \"v\", at = -1 }");
    assert!(said.contains("operating point is at -1 s"), "{said}");
    let said = of("spectrum = { input = \"i\", output = \"v\", factor = 0 }");
    assert!(said.contains("`factor` of a spectrum is 0"), "{said}");
    let zero = "f,re,im\n1,0.5,-0.5\n2,0.2,0\n4,0.1,-0.2\n8,0.05,-0.1\n";
    let by_part = problem(
        "M",
        &[("k", 1.0)],
        "spectrum = { input = \"i\", output = \"v\", weighting = \"proportional\" }",
    );
    let said = refused(&[("M.mo", model), ("d.csv", zero), ("p.toml", &by_part)]);
    assert!(said.contains("row 2") && said.contains("weights `imaginary` is 0"), "{said}");
    let late = model.replace("v = x;", "v = x + delay(i, 0.1);");
    let delayed = problem("M", &[("k", 1.0)], "spectrum = { input = \"i\", output = \"v\" }");
    let said = refused(&[("M.mo", &late), ("d.csv", &data), ("p.toml", &delayed)]);
    assert!(said.contains("`delay` and `spatialDistribution` are not supported"), "{said}");
    let unclear = data.replace("f,re", "f [1/s],re");
    let said = refused(&[("M.mo", model), ("d.csv", &unclear), ("p.toml", &delayed)]);
    assert!(said.contains("may be Hz or rad/s") && said.contains("unit = \"Hz\""), "{said}");
    let one = delayed
        .replace("real = \"re\", ", "")
        .replace("\"v\" }", "\"v\", weighting = \"modulus\" }");
    let said = refused(&[("M.mo", model), ("d.csv", &data), ("p.toml", &one)]);
    assert!(said.contains("magnitude of one part alone"), "{said}");
    let third = model.replace("v = x;", "v = x + der(b);");
    let problem = problem("M", &[("k", 1.0)], "spectrum = { input = \"i\", output = \"v\" }");
    let said = refused(&[("M.mo", &third), ("d.csv", &data), ("p.toml", &problem)]);
    assert!(said.contains("derivative of its input of order 3"), "{said}");
    let phase = problem.replace("real = \"re\", imaginary = \"im\"", "phase = \"im\"");
    let said = refused(&[("M.mo", model), ("d.csv", &data), ("p.toml", &phase)]);
    assert!(said.contains("a phase alone") && said.contains("`magnitude`"), "{said}");
}

/// A spectrum and a load step of the same circuit, with errors of their own.
#[test]
fn a_spectrum_and_a_load_step_determine_more_than_either() {
    let model = "model M input Real i(unit = \"A\"); output Real v(unit = \"V\"); \
        parameter Real R0(unit = \"Ohm\") = 0.04; parameter Real R1(unit = \"Ohm\") = 0.2; \
        parameter Real C(unit = \"F\") = 30; parameter Real E(unit = \"V\") = 0.9; \
        Real u(start = 0, fixed = true); \
        equation C*der(u) = i - u/R1; v = E - R0*i - u; end M;";
    let [r0, r1, c, e] = [0.05, 0.3, 40.0, 1.0];
    let spectrum = table(&frequencies(1.0, 1e3, 12), |s| r0 + r1 / (1.0 + r1 * c * s));
    let mut step = "t,i,v\n".to_owned();
    for k in 0..40 {
        let t = 2.0 * f64::from(k);
        let v = e - r0 * 0.5 - 0.5 * r1 * (1.0 - (-t / (r1 * c)).exp());
        writeln!(step, "{t},0.5,{v:.12}").unwrap();
    }
    let parameters = [("R0", 0.04), ("R1", 0.2), ("C", 30.0), ("E", 0.9)];
    let second = "spectrum = { input = \"i\", output = \"v\", factor = -1 }\n[[experiment]]\n\
        data = \"s.csv\"\nx = { variable = \"time\", column = \"t\" }\noutputs = { v = \"v\" }\n\
        inputs = { i = { column = \"i\", interpolation = \"hold\" } }";
    let problem = problem("M", &parameters, second);
    let files = [
        ("M.mo", model),
        ("d.csv", spectrum.as_str()),
        ("s.csv", step.as_str()),
        ("p.toml", &problem),
    ];
    let (result, _) = solved(&files);
    for (name, value) in [("R0", r0), ("R1", r1), ("C", c), ("E", e)] {
        assert_near(parameter(&result, name)[0], value, 1e-5);
    }
}

/// Two parts of a line, y = a + b x: near 0, which knows a, and far from it. By the inverses of the 2 × 2
/// matrices of information, by hand.
#[test]
fn what_each_experiment_contributes_follows_from_its_information() {
    let line = "model Line\n  parameter Real a = 1, b = 1;\n  input Real x;\n  Real y = a + b*x;\nend Line;\n";
    let experiment = |name: &str| {
        format!(
            "[[experiment]]\nname = \"{name}\"\ndata = \"{name}.csv\"\nx = \"x\"\n\
             outputs.y = {{ column = \"y\", sigma = 0.1 }}\n"
        )
    };
    let problem = "model = \"Line\"\nfiles = [\"M.mo\"]\nbands = false\n[parameters]\n\
        a = { min = 0.1, max = 5 }\nb = { min = 0.1, max = 5 }\n"
        .to_owned()
        + &experiment("low")
        + &experiment("high");
    let files = [
        ("M.mo", line),
        ("p.toml", problem.as_str()),
        ("low.csv", "x,y\n0,1.05\n1,2.95\n"),
        ("high.csv", "x,y\n10,20.95\n11,23.05\n"),
    ];
    let (result, _) = solved(&files);
    let all = result["inferred"]["contributions"].as_array().unwrap();
    let numbers = |place: usize, key: &str| -> Vec<f64> {
        all[place][key].as_array().unwrap().iter().map(|own| own.as_f64().unwrap()).collect()
    };
    let [a, b] = [222.0_f64 / 404.0, 4.0_f64 / 404.0];
    for (place, shares, without) in [
        (0, [89_284.0 / 89_688.0, 0.5], [221.0 / a, 2.0 / b].map(f64::sqrt)),
        (1, [404.0 / 89_688.0, 0.5], [1.0 / a, 2.0 / b].map(f64::sqrt)),
    ] {
        for k in 0..2 {
            assert_near(numbers(place, "shares")[k], shares[k], 1e-6);
            assert_near(numbers(place, "without")[k], without[k], 1e-6);
        }
    }
    let here = crate::support::program::folder(&files);
    let (code, out, error) =
        crate::support::program::gapi(&here, &["identify", "p.toml", "--plain", "--design"]);
    assert_eq!(code, 0, "{error}");
    for words in [
        "a is known from low alone.",
        "b: 50 % of what the data say from low, 50 % from high; without low its interval would be 14 \
         times as wide.",
    ] {
        assert!(out.contains(words), "{out}");
    }
}

/// A spectrum is measured with both parts at a frequency: more of it narrows the interval of what one part
/// alone shows.
#[test]
fn the_next_frequency_counts_both_parts() {
    let cell = "model Cell\n  parameter Real R = 0.1, C = 1;\n  input Real i(start = 0);\n  \
        Real v(start = 0, fixed = true);\nequation\n  C*der(v) = i - v/R;\nend Cell;\n";
    let data =
        table(&frequencies(0.01, 0.1, 8), |s| 0.1 / (1.0 + 0.1 * s) + Number::new(1e-4, 0.0));
    let problem = "model = \"Cell\"\nfiles = [\"M.mo\"]\nbands = false\n[parameters]\n\
        R = { min = 0.01, max = 1 }\nC = { min = 0.1, max = 10 }\n[design]\nrange = [0.01, 100]\n\
        [[experiment]]\ndata = \"d.csv\"\nspectrum = { input = \"i\", output = \"v\" }\n\
        outputs = { real = { column = \"re\", sigma = 1e-3 }, imaginary = { column = \"im\", sigma = 1e-3 } }\n";
    let problem = problem.replace("spectrum =", "steady_state = true\nspectrum =");
    let (_, text) = solved(&[("M.mo", cell), ("d.csv", &data), ("p.toml", &problem)]);
    assert!(!text.contains("has no data"), "{text}");
    // |dZ/dC| = ωR²/(1 + (ωRC)²) is largest at 1/(2πRC) = 1.6 Hz.
    assert!(text.contains("points of the spectrum between frequency = 1"), "{text}");
    assert!(text.contains("would narrow the 95 % interval of C"), "{text}");
}

/// Z = R + s L with errors of its own for each part: R is known from the real part alone and L from the
/// imaginary one, so that the half-widths of ln |Z| and of the phase are those of independent errors.
#[test]
fn magnitude_and_phase_have_the_bands_of_both_parts() {
    let model = "model M input Real i; output Real v; parameter Real R = 0.1; parameter Real L = 0.1; \
        equation v = R*i + L*der(i); end M;";
    let (at, mut data) = (frequencies(0.01, 1.0, 12), "f,re,im\n".to_owned());
    for (k, f) in at.iter().enumerate() {
        let error = if k % 2 == 0 { 0.004 } else { -0.004 };
        writeln!(data, "{f:.17e},{:.17e},{:.17e}", 0.1 + error, TAU * f * 0.05 - error).unwrap();
    }
    let problem =
        problem("M", &[("R", 0.1), ("L", 0.1)], "spectrum = { input = \"i\", output = \"v\" }")
            .replace("\"re\"", "{ column = \"re\", sigma = 0.004 }")
            .replace("\"im\"", "{ column = \"im\", sigma = 0.004 }");
    let files = [("M.mo", model), ("d.csv", &data), ("p.toml", &problem)];
    let (result, _) = solved(&files);
    let [[r, of_r], [l, of_l]] = ["R", "L"].map(|name| parameter(&result, name));
    let points = result["inferred"]["spectra"][0]["points"].as_array().unwrap();
    assert!(points.len() > 50, "{points:?}");
    let numbers = |own: &Value| -> Vec<f64> {
        own.as_array().unwrap().iter().map(|own| own.as_f64().unwrap()).collect()
    };
    // The quantile, by the first point.
    let mut quantile = None;
    for own in points.iter().map(numbers) {
        let x = TAU * own[0];
        let size = r * r + (x * l) * (x * l);
        let magnitude = (r * of_r).hypot(x * x * l * of_l) / size;
        let phase = (r * x * of_l).hypot(x * l * of_r) / size;
        let quantile = *quantile.get_or_insert(own[3] / magnitude);
        assert!((1.9..2.2).contains(&quantile), "{quantile}");
        assert_near(own[3], quantile * magnitude, 1e-5);
        assert_near(own[4], (quantile * phase).to_degrees(), 1e-5);
    }
    let here = crate::support::program::folder(&files);
    let (code, out, error) =
        crate::support::program::gapi(&here, &["identify", "p.toml", "--plain", "--out", "o"]);
    assert_eq!(code, 0, "{out}{error}");
    for name in ["bode.svg", "report.html"] {
        let text = std::fs::read_to_string(here.path().join("o").join(name)).unwrap();
        assert!(text.contains("95 % confidence band"), "{name}");
    }
}

/// The standard deviation of a measurement is in proportion to |Z|, which is not measured beyond the data.
#[test]
fn what_varies_over_frequency_is_predicted_within_the_data_alone() {
    let model = "model M input Real i; output Real v; parameter Real R = 0.1; parameter Real L = 0.1; \
        equation v = R*i + L*der(i); end M;";
    let (at, mut data) = (frequencies(0.01, 1.0, 12), "f,re,im\n".to_owned());
    for (k, f) in at.iter().enumerate() {
        let error = if k % 2 == 0 { 1.01 } else { 0.99 };
        writeln!(data, "{f:.17e},{:.17e},{:.17e}", 0.1 * error, TAU * f * 0.05 / error).unwrap();
    }
    let entry = "spectrum = { input = \"i\", output = \"v\", weighting = \"modulus\" }";
    let problem = problem("M", &[("R", 0.1), ("L", 0.1)], entry);
    let (result, _) = solved(&[("M.mo", model), ("d.csv", &data), ("p.toml", &problem)]);
    let points = result["inferred"]["bands"][0]["points"].as_array().unwrap();
    let (mut within, mut beyond) = (0, 0);
    for own in points {
        let is_within = (0.01..=1.0).contains(&own["x"].as_f64().unwrap());
        assert_eq!(own["prediction"].is_number(), is_within, "{own}");
        assert!(own["confidence"].is_number(), "{own}");
        *(if is_within { &mut within } else { &mut beyond }) += 1;
    }
    assert!(within > 50 && beyond > 5, "{within} {beyond}");
}

/// Z = R + s g L, measured at g = 1: where g = 10, an imaginary part says ten times as much of L.
#[test]
fn the_next_spectrum_may_be_at_another_operating_point() {
    let model = "model M input Real i; output Real v; parameter Real R = 0.1; parameter Real L = 0.1; \
        parameter Real g = 1; equation v = R*i + g*L*der(i); end M;";
    let (at, mut data) = (frequencies(0.01, 1.0, 12), "f,re,im\n".to_owned());
    for (k, f) in at.iter().enumerate() {
        let error = if k % 2 == 0 { 0.004 } else { -0.004 };
        writeln!(data, "{f:.17e},{:.17e},{:.17e}", 0.1 + error, TAU * f * 0.05 - error).unwrap();
    }
    let plain =
        problem("M", &[("R", 0.1), ("L", 0.1)], "spectrum = { input = \"i\", output = \"v\" }")
            .replace("\"re\"", "{ column = \"re\", sigma = 0.004 }")
            .replace("\"im\"", "{ column = \"im\", sigma = 0.004 }");
    let with = |points: &str| {
        let problem = format!("{plain}\n[design]\npoints = 3\noperating_points = [{points}]\n");
        [("M.mo", model.to_owned()), ("d.csv", data.clone()), ("p.toml", problem)]
    };
    let files = with("{ set = { g = 10 } }");
    let (result, _) = solved(&files.each_ref().map(|(name, text)| (*name, text.as_str())));
    let next = &result["inferred"]["next_measurement"];
    let proposals = next["proposals"].as_array().unwrap();
    let own = proposals.iter().find(|own| own["parameter"] == 1).unwrap();
    let plan = &own["plans"][0];
    assert_eq!(plan["experiment"], "experiment 1, g = 10", "{own}");
    let here = crate::support::program::folder(
        &files.each_ref().map(|(name, text)| (*name, text.as_str())),
    );
    let (_, out, _) = crate::support::program::gapi(&here, &["identify", "p.toml", "--plain"]);
    assert!(out.contains("Hz (experiment 1, g = 10) would narrow"), "{out}");
    let range = [0, 1].map(|end| plan["range"][end].as_f64().unwrap());
    let informative = |f: f64, g: f64| (TAU * f * g / 0.004).powi(2);
    let present: f64 = at.iter().map(|f| informative(*f, 1.0)).sum();
    let more: f64 = frequencies(range[0], range[1], 3).iter().map(|f| informative(*f, 10.0)).sum();
    let [l, _] = parameter(&result, "L");
    let half = |information: f64| 1.959963984540054 / information.sqrt() / l;
    assert_near(next["now"][1].as_f64().unwrap(), half(present), 1e-6);
    assert_near(own["after"][1].as_f64().unwrap(), half(present + more), 1e-6);

    for (points, expected) in [
        ("{ set = { G = 10 } }", "did you mean `g`?"),
        ("{ set = { L = 10 } }", "set both in experiment 1, L = 10"),
        ("{}", "neither `at` nor `set`"),
        ("{ at = -1 }", "operating point"),
        ("{ time = 1 }", "the entries here are `at`, `set`"),
    ] {
        let files = with(points);
        let error = refused(&files.each_ref().map(|(name, text)| (*name, text.as_str())));
        assert!(error.contains(expected) && error.contains("p.toml:"), "{points}: {error}");
    }
}
