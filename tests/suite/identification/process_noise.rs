//! Process noise: fits whose predictions come from a Kalman filter, against the same likelihoods
//! maximized by SciPy.

#![allow(clippy::print_stderr, reason = "a test that is skipped has to be said")]

use crate::support::identified::{assert_near, parameter, refused, solved};
use crate::support::program::{folder, gapi};
use serde_json::{Value, json};
use std::fmt::Write as _;

/// A room whose losses vary: C dT/dt = u − T/R + w, dw/dt = −w/4 with noise.
const ROOM: &str = "model Room
  parameter Real C = 4, R = 2;
  input Real u;
  Real T(start = 1, fixed = true);
  Real w(start = 0, fixed = true);
equation
  C*der(T) = u - T/R + w;
  der(w) = -w/4;
end Room;
";

/// Drawn with C = 5, R = 2, noise of w 0.8, sigma 0.1, and u = 1 and 0 for 10 s each.
const TEMPERATURES: &str = "1.035 1.032 1.365 1.751 1.915 2.26 2.232 2.316 2.185 2.443 2.643 2.33 \
    1.801 1.564 1.153 0.702 0.369 -0.007 0.108 -0.112 -0.277 -0.363 -0.196 -0.086 -0.05 0.349 0.463 \
    0.532 0.561 0.394 0.48 0.276 0.308 0.259 -0.003 -0.019 0.105 -0.203 -0.378 -0.392 -0.448 -0.568 \
    -0.729 -0.504 -0.396 -0.278 -0.059 0.059 -0.127 -0.194 -0.155 -0.584 -0.904 -0.872 -1.036 -0.92 \
    -0.821 -0.499 -0.501 -0.243 0.118 0.804 0.804 1.145 1.282 0.924 1.082 1.173 0.878 1.118 0.834 \
    0.35 0.039 -0.239 -0.556 -0.735 -1.044 -1.119 -1.292 -1.475";

fn room_data() -> String {
    let mut text = "time [s],T,u\n".to_owned();
    for (k, temperature) in TEMPERATURES.split_whitespace().enumerate() {
        let u = 1 - (k / 10) % 2;
        writeln!(text, "{k},{temperature},{u}").unwrap();
    }
    text
}

fn room_problem(noise: &str, sigma: &str) -> String {
    format!(
        "model = \"Room\"\nfiles = [\"M.mo\"]\n[parameters]\nC = {{ min = 1, max = 20 }}\n\
         R = {{ min = 0.2, max = 20 }}\n[noise]\nw = {noise}\n[[experiment]]\ndata = \"d.csv\"\n\
         outputs = {{ T = {{ column = \"T\"{sigma} }} }}\n\
         inputs = {{ u = {{ column = \"u\", interpolation = \"hold\" }} }}\n\
         [method]\nname = \"levenberg_marquardt\"\n"
    )
}

fn room(noise: &str, sigma: &str) -> (Value, String) {
    let (data, problem) = (room_data(), room_problem(noise, sigma));
    solved(&[("M.mo", ROOM), ("d.csv", &data), ("p.toml", &problem)])
}

/// By SciPy: a discrete Kalman filter with matrix exponentials, its likelihood maximized by
/// Nelder-Mead to 1e-12; standard errors from the information Σ ŷ'ŷ'ᵀ/s² + 2 s's'ᵀ/s² of all innovations.
#[test]
fn noise_and_errors_of_measurement_are_estimated_together() {
    let (result, text) = room("{ min = 0.05, max = 5 }", ", sigma = \"estimate\"");
    let expected = [
        ("C", 4.159339014, 1.12220912),
        ("R", 1.525816715, 0.51296792),
        ("noise of w", 0.638691362, 0.17395926),
        ("sigma of T", 0.0928684705, 0.0115921),
    ];
    for (name, value, error) in expected {
        let [found, deviation] = parameter(&result, name);
        assert_near(found, value, 1e-5);
        assert_near(deviation, error, 1e-4);
    }
    let log = result["negative_log_likelihood"].as_f64().unwrap();
    assert!((log + 20.528069195977533).abs() < 1e-8, "{log}\n{text}");
    assert!(text.contains("1/sqrt(s)"), "{text}");
    // SciPy's least -log L within these ranges and without noise of w is 118.654 larger.
    for words in [
        "The data need the process noise: without `noise of w`, -log L is larger by 119",
        "The innovations of experiment 1 / T are white noise",
        "experiment 1 / T: 0.936 (predictions: 0.19)",
    ] {
        assert!(text.contains(words), "{words}: {text}");
    }
}

/// What the data say where nothing else does.
#[test]
fn sigmas_and_ranges_that_are_not_given_are_found() {
    let problem = room_problem("1", "").replace("w = 1", "T = \"estimate\"\nw = \"estimate\"");
    let (result, text) = solved(&[("M.mo", ROOM), ("d.csv", &room_data()), ("p.toml", &problem)]);
    assert!(text.contains("`T` has no `sigma`; it is estimated"), "{text}");
    assert_near(parameter(&result, "sigma of T")[0], 0.0928684705, 0.05);
    assert_near(parameter(&result, "noise of w")[0], 0.638691362, 0.05);
}

/// Two tanks whose outflows are roots of their levels, noise on both; the second level is measured.
/// By SciPy: mean and covariance of an extended Kalman filter integrated by DOP853 with 1e-10, Nelder-Mead.
#[test]
fn nonlinear_models_have_an_extended_filter() {
    let tanks = "model Tanks
  parameter Real k1 = 0.5, k2 = 0.5;
  input Real u;
  Real x(start = 1, fixed = true), y(start = 1.5, fixed = true);
equation
  der(x) = u - k1*sqrt(x);
  der(y) = k1*sqrt(x) - k2*sqrt(y);
end Tanks;
";
    let levels = "1.5 1.5408 1.5622 1.6763 1.766 1.8881 1.986 2.1702 2.2989 2.3456 2.4297 2.4727 \
        2.5133 2.5345 2.4963 2.5128 2.4172 2.3595 2.3916 2.3819 2.4666 2.4931 2.5563 2.6243 2.7521 \
        2.8185 2.8953 2.9561 2.9676 2.9148 2.8858 2.8207 2.7725 2.737 2.7267 2.7687 2.7687 2.8279 \
        2.9259 3.0391";
    let mut data = "time [s],y,u\n".to_owned();
    for (k, level) in levels.split_whitespace().enumerate() {
        let u = if (k / 8) % 2 == 0 { 0.5 } else { 0.2 };
        writeln!(data, "{k},{level},{u}").unwrap();
    }
    let problem = "model = \"Tanks\"
files = [\"M.mo\"]
[parameters]
k1 = { min = 0.05, max = 2 }
k2 = { min = 0.05, max = 2 }
[noise]
x = { min = 1e-3, max = 1 }
y = 0.02
[[experiment]]
data = \"d.csv\"
tolerance = 1e-9
outputs = { y = { column = \"y\", sigma = 0.02 } }
inputs = { u = { column = \"u\", interpolation = \"hold\" } }
[method]
name = \"levenberg_marquardt\"
";
    let (result, text) = solved(&[("M.mo", tanks), ("d.csv", &data), ("p.toml", problem)]);
    for (name, value) in [("k1", 0.29526082), ("k2", 0.20001619), ("noise of x", 0.04130659)] {
        assert_near(parameter(&result, name)[0], value, 1e-4);
    }
    let log = result["negative_log_likelihood"].as_f64().unwrap();
    assert!((log + 81.19369380328847).abs() < 1e-6, "{log}\n{text}");
}

#[test]
fn what_a_filter_cannot_do_is_refused_with_its_place() {
    let data = room_data();
    let with = |change: &dyn Fn(String) -> String| {
        let problem = change(room_problem("0.1", ", sigma = 0.1"));
        refused(&[("M.mo", ROOM), ("d.csv", &data), ("p.toml", &problem)])
    };
    let cases: [(&str, &str, &str); 9] = [
        ("w = 0.1", "W = 0.1", "did you mean `w`?"),
        ("w = 0.1", "u = 0.1", "`u` is not a state"),
        ("w = 0.1", "w = -1", "the noise of `w` is -1"),
        ("w = 0.1", "w = { min = 1 }", "must have either `min` and `max`, or `value`"),
        ("sigma = 0.1", "sigma = \"0.1 + abs(T)\", weight = 2", "a `weight`"),
        ("sigma = 0.1", "sigma = 0.1, error = \"lognormal\"", "another `error`"),
        ("sigma = 0.1", "sigma = 0.1, delay = 1", "a `delay`, and a filter keeps no past"),
        ("sigma = 0.1", "sigma = 0.1, below = 0.5", "the limit `below`"),
        ("sigma = 0.1", "sigma = 0.1, above = \"u\"", "the limit `above`"),
    ];
    // The column of the times has another name, and the problem does not say which.
    let files = [
        ("M.mo", ROOM),
        ("d.csv", &data.replace("time [s]", "t")),
        ("p.toml", &room_problem("0.1", "")),
    ];
    let error = refused(&files);
    assert!(error.contains("no column `time`"), "{error}");
    assert!(error.contains("x = { variable = \"time\", column = "), "{error}");
    for (from, to, expected) in cases {
        let error = with(&|problem| problem.replace(from, to));
        assert!(error.contains(expected), "{to}: {error}");
        assert!(error.contains("p.toml:"), "{to}: {error}");
    }
}

#[test]
fn states_that_events_set_and_samples_that_are_kept_are_refused() {
    let ball = include_str!("../../data/models/process_noise_events_ball.mo");
    let sampled = include_str!("../../data/models/process_noise_events_sampled.mo");
    let problem = "model = \"Ball\"\nfiles = [\"M.mo\"]\n[parameters]\ne = { min = 0.1, max = 1 }\n\
                   [noise]\nv = 0.1\n[[experiment]]\ndata = \"d.csv\"\n\
                   outputs = { h = { column = \"h\", sigma = 0.1 } }\n";
    let data = "time [s],h\n0,1\n0.1,0.95\n0.2,0.8\n";
    for (model, expected) in
        [(ball, "`reinit` sets `v`"), (sampled, "`u` keeps a value of uncertain states")]
    {
        let error = refused(&[("M.mo", model), ("d.csv", data), ("p.toml", problem)]);
        assert!(error.contains("error[no-filter]"), "{error}");
        assert!(error.contains(expected), "{error}");
        assert!(error.contains("p.toml:"), "{error}");
    }
}

/// The last states of the fit above, and a fit that did not happen: its values are given in the problem.
#[test]
fn states_are_estimated_with_given_parameters() {
    let problem = room_problem("0.638691362", ", sigma = 0.0928684705")
        .replace("{ min = 1, max = 20 }", "{ fixed = 4.159339014 }")
        .replace("{ min = 0.2, max = 20 }", "{ fixed = 1.525816715 }");
    let folder = folder(&[("M.mo", ROOM), ("d.csv", &room_data()), ("p.toml", &problem)]);
    let arguments = ["estimate", "p.toml", "--output", "s.csv", "--figure", "s.svg"];
    let (code, out, error) = gapi(&folder, &arguments);
    assert_eq!(code, 0, "{out}{error}");
    assert!(out.contains("80 samples, -log L = -20.52807"), "{out}");
    assert!(out.contains("w = "), "{out}");
    let table = std::fs::read_to_string(folder.path().join("s.csv")).unwrap();
    // By the same filter in numpy: states after the last sample, prediction before it.
    let expected = [
        ("time", 79.0),
        ("T", -1.433991103),
        ("sd(T)", 0.081033163),
        ("w", -1.318963534),
        ("sd(w)", 0.503688025),
        ("smoothed(w)", -1.318963534),
        ("sd(smoothed(w))", 0.503688025),
        ("predicted(T)", -1.303157150),
        ("sd(predicted(T))", 0.190105633),
        ("measured(T)", -1.475000000),
    ];
    for (name, expected) in expected {
        let found = *column(&table, name).last().unwrap();
        assert!((found - expected).abs() < 1e-6, "{name}: {found}");
    }
    assert!(std::fs::read_to_string(folder.path().join("s.svg")).unwrap().contains("95 % band"));
    let free = room_problem("0.6", ", sigma = 0.1");
    let folder = crate::support::program::folder(&[
        ("M.mo", ROOM),
        ("d.csv", &room_data()),
        ("p.toml", &free),
    ]);
    let (code, _, error) = gapi(&folder, &["estimate", "p.toml"]);
    assert_eq!(code, 1, "{error}");
    assert!(error.contains("no value is given for `C`, `R`"), "{error}");
    let (code, out, error) = gapi(&folder, &["identify", "p.toml", "--out", "o", "--plain"]);
    assert_eq!(code, 0, "{out}{error}");
    let (code, out, error) = gapi(&folder, &["estimate", "p.toml", "--values", "o/result.json"]);
    assert_eq!(code, 0, "{out}{error}");
}

/// What a fit reports are the predictions of `gapi estimate` with its parameters, which are compared with
/// numpy below.
#[test]
fn a_report_predicts_over_several_samples() {
    let problem = room_problem("{ min = 0.05, max = 5 }", ", sigma = \"estimate\"");
    let ahead = format!("prediction_steps = 3\n{problem}");
    let folder = folder(&[("M.mo", ROOM), ("d.csv", &room_data()), ("p.toml", &ahead)]);
    let (code, out, error) = gapi(&folder, &["identify", "p.toml", "--out", "o", "--plain"]);
    assert_eq!(code, 0, "{out}{error}");
    let arguments =
        ["estimate", "p.toml", "--values", "o/result.json", "--steps", "3", "--output", "s.csv"];
    let (code, _, error) = gapi(&folder, &arguments);
    assert_eq!(code, 0, "{error}");
    let read = |name: &str| std::fs::read_to_string(folder.path().join(name)).unwrap();
    let table = read("s.csv");
    let columns = ["predicted over 3(T)", "sd(predicted over 3(T))", "measured(T)"];
    let [mean, sd, measured] = columns.map(|name| column(&table, name));
    let result: Value = serde_json::from_str(&read("o/result.json")).unwrap();
    let ahead = &result["series"][0]["ahead"];
    assert_eq!(ahead["samples"], 3);
    let points = ahead["points"].as_array().unwrap();
    // There are three samples before each of all but the first three.
    assert_eq!(points.len(), 77);
    let mut squares = 0.0;
    for (own, row) in points.iter().zip(3..) {
        assert_eq!(own[0], f64::from(row));
        let row = row as usize;
        assert_near(own[1].as_f64().unwrap(), mean[row], 1e-9);
        assert_near(own[2].as_f64().unwrap(), sd[row], 1e-9);
        squares += (measured[row] - mean[row]).powi(2);
    }
    let rmse = format!("over 3 samples: {:.3}", (squares / 77.0).sqrt());
    assert!(out.contains(&rmse), "{rmse}: {out}");
    assert!(read("o/report.html").contains("predicted over 3 samples"));
    let cases = [
        (format!("prediction_steps = 1\n{problem}"), "write a number from 2"),
        (format!("prediction_steps = -3\n{problem}"), "expected a whole number from 0, found -3"),
        (
            format!(
                "prediction_steps = 3\n{}",
                problem.replace("[noise]\nw = { min = 0.05, max = 5 }\n", "")
            ),
            "process noise",
        ),
    ];
    for (problem, expected) in cases {
        let error = refused(&[("M.mo", ROOM), ("d.csv", &room_data()), ("p.toml", &problem)]);
        assert!(error.contains(expected) && error.contains("p.toml:1"), "{error}");
    }
    // So many samples there are not.
    let (_, text) = solved(&[
        ("M.mo", ROOM),
        ("d.csv", &room_data()),
        ("p.toml", &format!("prediction_steps = 80\n{problem}")),
    ]);
    assert!(text.contains("predictions over 80 samples are not possible"), "{text}");
}

/// A column of a table in a CSV file; cells that are empty are not numbers.
fn column(table: &str, name: &str) -> Vec<f64> {
    let mut lines = table.lines();
    let names: Vec<&str> = lines.next().unwrap().split("\",\"").collect();
    let at = names.iter().position(|own| own.trim_matches('"') == name).expect(name);
    lines.map(|line| line.split(',').nth(at).unwrap().parse().unwrap_or(f64::NAN)).collect()
}

/// Two capacities with noise on both, two outputs of which the second one is a mixture, and initial values
/// that are uncertain.
const HOUSE: &str = "model House
  parameter Real Ci = 2, Ce = 10, Ri = 0.5, Ro = 1.5;
  Real Ti(start = 20, fixed = true), Te(start = 17, fixed = true), Tm;
equation
  Ci*der(Ti) = (Te - Ti)/Ri + 3;
  Ce*der(Te) = (Ti - Te)/Ri - Te/Ro;
  Tm = 0.3*Ti + 0.7*Te;
end House;
";

fn house_data() -> String {
    let times = [0.0, 0.5, 1.0, 1.7, 2.5, 3.0, 5.0];
    let mut data = "time [s],Ti,Tm\n".to_owned();
    for (k, time) in times.iter().enumerate() {
        let k = k as f64;
        let cell = |missing: f64, value: f64| match k == missing {
            true => String::new(),
            false => format!("{value:.17}"),
        };
        let [first, second] =
            [cell(4.0, 20.0 + (2.0 * k).sin() + 0.5 * k), cell(2.0, 18.0 + (3.0 * k).cos())];
        writeln!(data, "{time},{first},{second}").unwrap();
    }
    // Nothing is measured in this row.
    data.replace("\n2.5,", "\n2.0,,\n2.5,")
}

/// No parameters are estimated, and none need be written.
const HOUSE_PROBLEM: &str = "model = \"House\"
files = [\"M.mo\"]
[noise]
Ti = { value = 0.3, initial = 0.5 }
Te = { value = 0.1, initial = 1.0 }
[[experiment]]
data = \"d.csv\"
tolerance = 1e-10
outputs.Ti = { column = \"Ti\", sigma = 0.2 }
outputs.Tm = { column = \"Tm\", sigma = 0.4 }
";

/// By numpy: a Kalman filter with matrix exponentials, and the smoother of Rauch, Tung and Striebel with
/// inverse covariances.
#[test]
fn smoothed_states_are_those_of_an_exact_smoother() {
    let folder = folder(&[("M.mo", HOUSE), ("d.csv", &house_data()), ("p.toml", HOUSE_PROBLEM)]);
    let arguments =
        ["estimate", "p.toml", "--output", "s.csv", "--steps", "2", "--every", "2", "--until", "6"];
    let (code, out, error) = gapi(&folder, &arguments);
    assert_eq!(code, 0, "{out}{error}");
    assert!(out.contains("7 samples, -log L = 161.8609"), "{out}");
    assert!(out.contains("states at 6 s") && out.contains("(the last measurement is that at 5 s)"));
    let table = std::fs::read_to_string(folder.path().join("s.csv")).unwrap();
    let names = ["time", "smoothed(Ti)", "smoothed(Te)", "sd(smoothed(Ti))", "sd(smoothed(Te))"];
    let columns = names.map(|name| column(&table, name));
    // Time, both states, and their variances.
    let expected = [
        [0.0, 20.128786158448918, 20.041752248137, 0.03004123353891376, 0.05404753176542568],
        [0.5, 20.816385247119, 19.491638801448623, 0.0176729271738779, 0.03885125382871738],
        [1.0, 20.71711128054754, 19.095559169124012, 0.018208029150701296, 0.030438012878249515],
        [1.7, 20.974150542116146, 18.63725095395098, 0.019840564583178705, 0.023237788125929214],
        [2.0, 20.99010909149344, 18.493992657103657, 0.030797013940137362, 0.021575638311735833],
        [2.5, 21.035137180893567, 18.272121957927403, 0.0338511411057388, 0.019577202499374016],
        [3.0, 21.20619211595924, 18.069173262975244, 0.02181215768664592, 0.018720724847401404],
        [4.0, 20.70987551140038, 17.715302560397035, 0.04442828352430009, 0.01958987777982795],
        [5.0, 21.04971094868217, 17.329469925963803, 0.024171474039174558, 0.020819078680050736],
        [6.0, 19.46313634602361, 16.807910449781975, 0.05715583315757669, 0.024927356870253665],
    ];
    assert_eq!(columns[0].len(), expected.len());
    for (row, expected) in expected.iter().enumerate() {
        let sd = [columns[3][row], columns[4][row]].map(|sd| sd * sd);
        let found = [columns[0][row], columns[1][row], columns[2][row], sd[0], sd[1]];
        for (found, expected) in found.iter().zip(expected) {
            assert!((found - expected).abs() < 1e-9, "{row}: {found} {expected}");
        }
    }
    // Predictions from all samples up to the last but one: numpy.
    let ahead = ["predicted over 2(Ti)", "sd(predicted over 2(Ti))", "simulated(Tm)"];
    let [mean, sd, simulated] =
        ahead.map(|name| *column(&table, name).iter().rev().nth(1).unwrap());
    for (found, expected) in
        [(mean, 17.760111551776127), (sd, 0.3502639619478587), (simulated, 14.712861620209903)]
    {
        assert!((found - expected).abs() < 1e-9, "{found} {expected}");
    }
    // The second output of a row is predicted from earlier rows, not from the first one.
    for (name, expected) in [
        ("predicted(Tm)", 16.917146249611086),
        ("sd(predicted(Tm))", 0.44051111100366513),
        ("predicted over 2(Tm)", 16.249123901871638),
        ("sd(predicted over 2(Tm))", 0.4522045419564811),
    ] {
        let found = *column(&table, name).iter().rev().nth(1).unwrap();
        assert!((found - expected).abs() < 1e-9, "{name}: {found} {expected}");
    }
    // Where there were not two samples before, there is none; rows without measurements have both.
    let ahead = column(&table, "predicted over 2(Ti)");
    assert!(ahead[1].is_nan());
    for column in [&ahead[4..], &column(&table, "simulated(Tm)")] {
        assert!(column.iter().all(|value| value.is_finite()), "{table}");
    }
}

/// A state that jumps from row to row, measured twice: by numpy, each output of a row is predicted from the
/// row before with an RMSE of 0.30, in any order, and 60 measurements of 0.01 around 0 have -log L = 62967.
#[test]
fn outputs_of_a_row_do_not_predict_each_other() {
    let model = "model T
  parameter Real k = 0.01;
  Real x(start = 0, fixed = true);
  output Real a = x, b = x;
equation
  der(x) = -k*x;
end T;
";
    let mut data = "time [s],a,b\n".to_owned();
    let (mut x, mut seed) = (0.0, 8_u64);
    let mut uniform = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    };
    for row in 0..60 {
        let errors = [uniform(), uniform()].map(|own| 0.03 * own);
        writeln!(data, "{},{},{}", 10 * row, x + errors[0], x + errors[1]).unwrap();
        x = x * f64::exp(-0.1) + uniform();
    }
    let problem = |order: [&str; 2]| {
        let outputs =
            order.map(|own| format!("outputs.{own} = {{ column = \"{own}\", sigma = 0.01 }}"));
        format!(
            "model = \"T\"\nfiles = [\"M.mo\"]\n[parameters]\nk = {{ min = 1e-3, max = 0.1 }}\n[noise]\n\
             x = \"estimate\"\n[[experiment]]\nname = \"e\"\ndata = \"d.csv\"\n{}\n",
            outputs.join("\n")
        )
    };
    let found = [["a", "b"], ["b", "a"]].map(|order| {
        let files = [("M.mo", model), ("d.csv", &data), ("p.toml", &problem(order))];
        let (result, text) = solved(&files);
        // Without the noise the likelihood overflows everywhere; the descent has an end all the same.
        assert!(text.contains("The data need the process noise"), "{text}");
        let rmse = |name: &str| {
            let series = result["series"].as_array().unwrap();
            let own = series.iter().find(|own| own["y"][0] == name).unwrap();
            own["rmse"].as_f64().unwrap()
        };
        [rmse("a"), rmse("b")]
    });
    for (first, second) in found[0].iter().zip(found[1]) {
        assert!((0.2..0.4).contains(first) && (first - second).abs() < 1e-6, "{found:?}");
    }
}

/// A state that follows its input with noise, measured with a thousandth of what the noise moves it: without
/// the noise the model misses the measurements by hundreds of their deviations, and the exponential function
/// of twice -log L overflows. The least -log L of the exact solution x += (1 - exp(-10 k)) (u - x) is found by
/// intervals of k.
#[test]
fn a_fit_without_the_noise_comes_to_its_end_however_far_away() {
    let model = "model One
  parameter Real k = 0.05;
  input Real u;
  Real x(start = 1, fixed = true);
  output Real y = x;
equation
  der(x) = k*(u - x);
end One;
";
    let mut data = "time [s],y,u\n".to_owned();
    let (mut x, mut state, mut rows) = (1.0, 11_u64, Vec::new());
    for row in 0..60 {
        let u = 1.0 - f64::from((row / 10) % 2);
        let y = x + 0.02 * normal(&mut state);
        writeln!(data, "{},{y},{u}", 10 * row).unwrap();
        rows.push([y, u]);
        x += (1.0 - f64::exp(-0.1)) * (u - x) + 0.3 * normal(&mut state);
    }
    let negative_log = |k: f64| {
        let mut x = 1.0;
        let mut sum = 60.0 * (0.001_f64.ln() + 0.5 * std::f64::consts::TAU.ln());
        for [y, u] in &rows {
            sum += 0.5 * ((y - x) / 0.001).powi(2);
            x += (1.0 - (-10.0 * k).exp()) * (u - x);
        }
        sum
    };
    let least = (0..=100_000).map(|at| negative_log(10_f64.powf(-3.0 + 3e-5 * f64::from(at))));
    let least = least.fold(f64::INFINITY, f64::min);
    let of = |noise: &str| {
        let problem = format!(
            "model = \"One\"\nfiles = [\"M.mo\"]\nbands = false\n[parameters]\n\
             k = {{ min = 1e-3, max = 1 }}\n[noise]\nx = {noise}\n[[experiment]]\ndata = \"d.csv\"\n\
             outputs.y = {{ column = \"y\", sigma = 0.001 }}\n\
             inputs.u = {{ column = \"u\", interpolation = \"hold\" }}\n\
             [method]\nname = \"levenberg_marquardt\"\n"
        );
        let (result, text) = solved(&[("M.mo", model), ("d.csv", &data), ("p.toml", &problem)]);
        (result["negative_log_likelihood"].as_f64().unwrap(), text)
    };
    let (log, text) = of("\"estimate\"");
    let words = "without `noise of x`, -log L is larger by ";
    let at = text.find(words).expect(&text) + words.len();
    let rise: f64 = text[at..].split_whitespace().next().unwrap().parse().unwrap();
    assert_near(rise, least - log, 6e-3);
    // The same fit as one of its own.
    let (log, text) = of("0");
    assert_near(log, least, 1e-6);
    assert!(text.contains("Minimum found"), "{text}");
}

/// The record of scripts has a fitness and a weight by default, which say nothing.
#[test]
fn scripts_have_process_noise() {
    let script = "p = GAPILib.Problem(modelName = \"Room\", files = {\"M.mo\"}, parameters = \
        {GAPILib.Free(name = \"C\", min = 1, max = 20), GAPILib.Free(name = \"R\", min = 0.2, max = 20)}, \
        experiments = {GAPILib.Experiment(data = \"d.csv\", outputs = {\"T\"}, sigmas = {0.1}, inputs = \
        {\"u\"})}, noiseStates = {\"w\"}, method = \"levenberg_marquardt\");\nr = identify(p)\n";
    for (sigmas, count) in [("sigmas = {0.1}, ", 3), ("", 4)] {
        let script = script.replace("sigmas = {0.1}, ", sigmas);
        let folder = folder(&[("M.mo", ROOM), ("d.csv", &room_data()), ("p.mos", &script)]);
        let (code, out, error) = gapi(&folder, &["run", "p.mos"]);
        assert_eq!(code, 0, "{out}{error}");
        let names = ["C  ", "R  ", "noise of w", "sigma of T"];
        let found = names.iter().filter(|name| out.contains(**name)).count();
        assert_eq!(found, count, "{out}");
    }
}

#[test]
fn values_that_nobody_gave_are_refused() {
    let of = |noise: &str, sigma: &str| {
        let problem = room_problem(noise, sigma).replace("C = {", "C = { start = 4,");
        let problem = problem.replace("R = {", "R = { start = 2,");
        let folder = folder(&[("M.mo", ROOM), ("d.csv", &room_data()), ("p.toml", &problem)]);
        let (code, out, error) = gapi(&folder, &["estimate", "p.toml", "--output", "s.csv"]);
        let bad = gapi(&folder, &["estimate", "p.toml", "--figure", "s.xyz"]).2;
        (code, format!("{out}{error}"), bad)
    };
    let (code, text, bad) = of("\"estimate\"", ", sigma = \"estimate\"");
    assert!(code == 1 && text.contains("`noise of w`, `sigma of T`"), "{text}");
    assert!(bad.contains("xyz") && !bad.contains("no value"), "{bad}");
    let (code, text, _) = of("0.6", ", sigma = 0.1");
    assert_eq!(code, 0, "{text}");
}

#[test]
fn rows_and_steps_that_cannot_be_are_refused() {
    let of = |problem: &str, data: &str, more: [&str; 2]| {
        let folder = folder(&[("M.mo", HOUSE), ("d.csv", data), ("p.toml", problem)]);
        let (code, _, error) = gapi(&folder, &["estimate", "p.toml", more[0], more[1]]);
        assert_eq!(code, 1, "{error}");
        error
    };
    let data = house_data();
    for (more, expected) in [
        (["--steps", "1"], "write a number from 2 to 6"),
        (["--steps", "7"], "predictions over 7 samples"),
        (["--every", "0"], "write a positive number"),
        (["--every", "1e-9"], "write a positive number"),
    ] {
        let error = of(HOUSE_PROBLEM, &data, more);
        assert!(error.contains(expected), "{error}");
    }
    let room = room_problem("0.6", ", sigma = 0.1");
    let folder = folder(&[("M.mo", ROOM), ("d.csv", &room_data()), ("p.toml", &room)]);
    let arguments = ["estimate", "p.toml", "--until", "100"];
    let (code, _, error) = gapi(&folder, &arguments);
    assert_eq!(code, 1, "{error}");
    let problem = room.replace("max = 20 }", "max = 20, start = 4 }");
    std::fs::write(folder.path().join("p.toml"), problem).unwrap();
    let (code, _, error) = gapi(&folder, &arguments);
    assert_eq!(code, 1, "{error}");
    assert!(error.contains("has the inputs up to 79 s, not up to 100 s"), "{error}");
}

/// A building with three heat capacities: air, envelope and heater (model TiTeTh of Bacher and Madsen,
/// Energy and Buildings 43, 2011), in hours, kW and kWh/K.
const BUILDING: &str = "model TiTeTh
  parameter Real Ci = 1, Ce = 3, Ch = 0.01, Rie = 1, Rea = 5, Rih = 0.5, Aw = 5;
  input Real Ta, Ps, Ph;
  Real Ti(start = 21, fixed = true), Te(start = 15, fixed = true), Th(start = 22, fixed = true);
equation
  3600*Ci*der(Ti) = (Te - Ti)/Rie + (Th - Ti)/Rih + Aw*Ps;
  3600*Ce*der(Te) = (Ti - Te)/Rie + (Ta - Te)/Rea;
  3600*Ch*der(Th) = (Ti - Th)/Rih + Ph;
end TiTeTh;
";

const BUILDING_PROBLEM: &str = r#"model = "TiTeTh"
files = ["M.mo"]
bands = false
[parameters]
Ci = { min = 0.05, max = 20, start = 1 }
Ce = { min = 0.1, max = 50, start = 3 }
Ch = { min = 1e-5, max = 5, start = 0.0015 }
Rie = { min = 0.05, max = 50, start = 1 }
Rea = { min = 0.1, max = 50, start = 5 }
Rih = { fixed = 50 }
Aw = { min = 0.1, max = 200, start = 5 }
Ti = { min = 0, max = 30, start = 21, initial = true }
Te = { min = -20, max = 30, start = 15, initial = true }
[noise]
Ti = { value = "estimate", min = 1e-6, max = 1, start = 2e-3, initial = 0.5 }
Te = { value = "estimate", min = 1e-6, max = 1, start = 2e-3, initial = 0.5 }
Th = { value = "estimate", min = 1e-6, max = 1, start = 2e-3, initial = 0.5 }
[[experiment]]
data = "d.csv"
x = { column = "t", variable = "time", unit = "h" }
outputs.Ti = { column = "yTi", sigma = "estimate" }
inputs.Ta = { column = "Ta", interpolation = "hold" }
inputs.Ps = { column = "Ps", interpolation = "hold" }
inputs.Ph = { column = "Ph", interpolation = "hold" }
[method]
name = "levenberg_marquardt"
"#;

/// The heated building of CTSM-R's example: the file `inputPRBS1.csv`, with columns t (hours), Ta, Ps, Ph
/// and yTi, 1,691 rows, which `GAPILIB_CTSM` names. By a Kalman filter in C with matrix exponentials, its
/// likelihood maximized by SciPy (L-BFGS-B) from several starts to one optimum. The resistance of the heater
/// is fixed, because the data tell of its product with the capacity alone.
#[test]
fn a_heated_building_has_the_likelihood_of_an_independent_filter() {
    let Some(file) = std::env::var_os("GAPILIB_CTSM") else {
        eprintln!("skipped: GAPILIB_CTSM does not name inputPRBS1.csv");
        return;
    };
    let data = std::fs::read_to_string(file).unwrap();
    let expected = [
        ("Ci", 1.0656494),
        ("Ce", 2.8962989),
        ("Ch", 0.0026151056),
        ("Rie", 0.85598842),
        ("Rea", 4.6141216),
        ("Aw", 6.0910356),
        ("Ti", 21.158004),
        ("Te", 18.109485),
        // Of the root of an hour.
        ("noise of Ti", 0.012975789 / 60.0),
        ("noise of Te", 0.31945234 / 60.0),
        ("sigma of Ti", 0.0025572517),
    ];
    // With these values the filter alone; the fit takes 1,800 simulations.
    let all = expected.iter().copied().chain([("noise of Th", 0.00059325314 / 60.0)]);
    let values = all.map(|(name, value)| json!({ "name": name, "value": value }));
    let values = json!({ "parameters": values.collect::<Vec<_>>() }).to_string();
    let files = [
        ("M.mo", BUILDING),
        ("d.csv", &data),
        ("p.toml", BUILDING_PROBLEM),
        ("values.json", &values),
    ];
    let arguments = ["estimate", "p.toml", "--values", "values.json"];
    let (code, out, error) = gapi(&folder(&files), &arguments);
    assert_eq!(code, 0, "{error}");
    assert!(out.contains("1691 samples, -log L = -5431.009"), "{out}");
    if cfg!(debug_assertions) {
        eprintln!("the fit itself is skipped: it is one for release builds");
        return;
    }
    let (result, text) = solved(&files[..3]);
    let log = result["negative_log_likelihood"].as_f64().unwrap();
    assert_near(log, -5431.008938656, 1e-8);
    for (name, value) in expected {
        let [found, _] = parameter(&result, name);
        assert!((found - value).abs() < 1e-4 * value, "{name}: {found} {value}\n{text}");
    }
}

/// The same building without its heater as a state (model TiTe), which these data do not follow: the noise of
/// the air comes to the lower end of its range and that of the envelope to the upper one, where they are held
/// here. By the same filter in C and SciPy from twelve starts.
#[test]
fn noise_at_the_ends_of_its_range_is_that_of_an_independent_filter() {
    let Some(file) = std::env::var_os("GAPILIB_CTSM") else {
        eprintln!("skipped: GAPILIB_CTSM does not name inputPRBS1.csv");
        return;
    };
    let data = std::fs::read_to_string(file).unwrap();
    let model = "model TiTe
  parameter Real Ci = 1, Ce = 3, Rie = 1, Rea = 5, Aw = 5;
  input Real Ta, Ps, Ph;
  Real Ti(start = 21, fixed = true), Te(start = 15, fixed = true);
equation
  3600*Ci*der(Ti) = (Te - Ti)/Rie + Aw*Ps + Ph;
  3600*Ce*der(Te) = (Ti - Te)/Rie + (Ta - Te)/Rea;
end TiTe;
";
    let inputs = BUILDING_PROBLEM.split_once("inputs.Ta").unwrap().1;
    let problem = format!(
        "model = \"TiTe\"\nfiles = [\"M.mo\"]\nbands = false\n[parameters]\n\
         Ci = {{ min = 0.01, max = 20, start = 6 }}\nCe = {{ min = 0.01, max = 20, start = 2 }}\n\
         Rie = {{ min = 0.01, max = 50, start = 0.5 }}\nRea = {{ min = 0.01, max = 50, start = 4 }}\n\
         Aw = {{ min = 0.1, max = 200, start = 30 }}\n\
         Ti = {{ min = 0, max = 25, start = 21, initial = true }}\n\
         Te = {{ min = -20, max = 25, start = 10, initial = true }}\n[noise]\n\
         Ti = 1e-6\n\
         Te = 0.1\n[[experiment]]\n\
         data = \"d.csv\"\nx = {{ column = \"t\", variable = \"time\", unit = \"h\" }}\n\
         outputs.Ti = {{ column = \"yTi\", sigma = 1e-5 }}\ninputs.Ta{inputs}"
    );
    let (result, text) = solved(&[("M.mo", model), ("d.csv", &data), ("p.toml", &problem)]);
    let log = result["negative_log_likelihood"].as_f64().unwrap();
    assert_near(log, -3537.874076578927, 1e-8);
    for (name, value) in [
        ("Ci", 6.2763312),
        ("Ce", 2.035757),
        ("Rie", 0.57543405),
        ("Rea", 3.5226465),
        ("Aw", 29.36584),
        ("Te", 9.0999501),
    ] {
        let [found, _] = parameter(&result, name);
        assert!((found - value).abs() < 1e-4 * value, "{name}: {found} {value}\n{text}");
    }
}

/// Numbers that are as good as random: normal by the sum of twelve even ones.
fn normal(state: &mut u64) -> f64 {
    let mut even = || {
        *state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (*state >> 11) as f64 / (1_u64 << 53) as f64
    };
    (0..12).map(|_| even()).sum::<f64>() - 6.0
}

/// An Ornstein-Uhlenbeck process that is measured with errors, drawn exactly: of 45 intervals of 95 %, 40
/// hold the truth. With the right coverage fewer do in one of 40 such tests; where standard errors are half
/// as large as they should be (coverage 67 %), 40 do in one of 1,400. The numbers are the same in each run.
#[test]
fn intervals_hold_the_truth_as_often_as_they_say() {
    let model = "model M\n  parameter Real tau = 3;\n  Real x(start = 0, fixed = true);\n\
                 equation\n  der(x) = -x/tau;\nend M;\n";
    let problem = "model = \"M\"\nfiles = [\"M.mo\"]\nbands = false\n[parameters]\n\
        tau = { min = 0.1, max = 100, start = 3 }\n[noise]\n\
        x = { min = 0.05, max = 20, start = 1 }\n[[experiment]]\ndata = \"d.csv\"\n\
        outputs.x = { column = \"x\", sigma = \"estimate\" }\n\
        [method]\nname = \"levenberg_marquardt\"\n";
    let (tau, noise, sigma) = (3.0_f64, 1.0_f64, 0.3_f64);
    let kept = (-1.0 / tau).exp();
    let spread = noise * (0.5 * tau * (1.0 - kept * kept)).sqrt();
    let mut state = 49;
    let (mut count, mut all) = (0, 0);
    for _ in 0..15 {
        let mut x = 0.0;
        let mut data = "time [s],x\n".to_owned();
        for k in 1..=120 {
            x = kept * x + spread * normal(&mut state);
            writeln!(data, "{k},{}", x + sigma * normal(&mut state)).unwrap();
        }
        let (result, text) = solved(&[("M.mo", model), ("d.csv", &data), ("p.toml", problem)]);
        let parameters = result["parameters"].as_array().unwrap();
        for (name, truth) in [("tau", tau), ("noise of x", noise), ("sigma of x", sigma)] {
            let own = parameters.iter().find(|own| own["name"] == name).unwrap();
            let ends = own["interval"].as_array().unwrap_or_else(|| panic!("{name}: {text}"));
            let [low, high] = [0, 1].map(|at: usize| ends[at].as_f64().unwrap());
            count += usize::from(low <= truth && truth <= high);
            all += 1;
        }
    }
    assert!(all == 45 && count >= 40, "{count} of {all} intervals hold the truth");
}

/// By NumPy and SciPy: the extended Kalman filter integrated by DOP853 with 1e-12, the smoother of Rauch,
/// Tung and Striebel about it, and three steps of the filter without samples.
#[test]
fn nonlinear_models_are_smoothed_and_predicted_from_their_filtered_states() {
    let tanks = "model Tanks
  parameter Real k1 = 0.3, k2 = 0.2;
  input Real u;
  Real x(start = 1, fixed = true), y(start = 1.5, fixed = true);
equation
  der(x) = u - k1*sqrt(x);
  der(y) = k1*sqrt(x) - k2*sqrt(y);
end Tanks;
";
    let problem = "model=\"Tanks\"
files=[\"M.mo\"]
[noise]
x={value=0.1,initial=0.3}
y={value=0.05,initial=0.1}
[[experiment]]
data=\"d.csv\"
tolerance=1e-11
outputs.y={column=\"y\",sigma=0.05}
inputs.u={column=\"u\",interpolation=\"hold\"}
";
    let levels = "1.5 1.5408 1.5622 1.6763 1.766 1.8881 1.986 2.1702 2.2989 2.3456 2.4297 2.4727 2.5133 2.5345 2.4963 2.5128 2.4172 2.3595 2.3916 2.3819";
    let mut data = "time [s],y,u\n".to_owned();
    for (k, level) in levels.split_whitespace().enumerate() {
        let u = if (k / 8) % 2 == 0 { 0.5 } else { 0.2 };
        writeln!(data, "{k},{level},{u}").unwrap();
    }
    let folder = folder(&[("M.mo", tanks), ("d.csv", &data), ("p.toml", problem)]);
    let (code, out, error) =
        gapi(&folder, &["estimate", "p.toml", "--steps", "3", "--output", "e.csv"]);
    assert_eq!(code, 0, "{out}{error}");
    let table = std::fs::read_to_string(folder.path().join("e.csv")).unwrap();
    for (name, row, expected) in [
        ("smoothed(x)", 0, 0.8828898876619791),
        ("sd(smoothed(x))", 0, 0.2015515612851111),
        ("smoothed(x)", 5, 1.672047600525735),
        ("sd(smoothed(x))", 5, 0.14206276366778867),
        ("smoothed(x)", 12, 1.225028699918929),
        ("sd(smoothed(x))", 12, 0.1338361172792065),
        ("predicted over 3(y)", 3, 1.7476585134762848),
        ("sd(predicted over 3(y))", 3, 0.13558379238211507),
        ("predicted over 3(y)", 19, 2.447351305614281),
        ("sd(predicted over 3(y))", 19, 0.11838283981506073),
    ] {
        assert_near(column(&table, name)[row], expected, 1e-9);
    }
}
