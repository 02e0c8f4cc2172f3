//! What measured data mean in time and in units: rows on both sides of an event, gaps, times that count
//! from a date, differences of temperatures. The data are exact solutions.

use crate::support::program::written as gapi;
use serde_json::Value;
use std::fs;
use tempfile::TempDir;

fn folder(files: &[(&str, &str)]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    files.iter().for_each(|(name, text)| fs::write(folder.path().join(name), text).unwrap());
    folder
}

/// What came of a problem: all parameters, and everything that was said, in the output and in the
/// findings of the report.
struct Solved {
    result: Value,
    output: String,
}

impl Solved {
    fn of(folder: &TempDir) -> Solved {
        let (done, output) = gapi(folder.path(), &["identify", "p.toml", "--out", "o", "--plain"]);
        assert!(done, "{output}");
        let text = fs::read_to_string(folder.path().join("o/result.json")).unwrap();
        Solved { result: serde_json::from_str(&text).unwrap(), output }
    }

    #[track_caller]
    fn is(&self, name: &str, expected: f64, relative: f64) {
        let all = self.result["parameters"].as_array().unwrap();
        let found = all.iter().find(|own| own["name"] == name);
        let found =
            found.unwrap_or_else(|| panic!("no {name}: {all:?}"))["value"].as_f64().unwrap();
        let distance = (found - expected).abs();
        assert!(distance <= relative * expected.abs(), "{name} = {found}, not {expected}");
    }

    /// In the output and in the report.
    #[track_caller]
    fn says(&self, words: &str) {
        assert!(self.output.contains(words), "no `{words}` in {}", self.output);
        let findings = self.result["findings"].as_array().unwrap();
        let found = findings.iter().any(|own| own["sentence"].as_str().unwrap().contains(words));
        assert!(found, "no `{words}` in the report: {findings:?}");
    }

    #[track_caller]
    fn does_not_say(&self, words: &str) {
        assert!(!self.output.contains(words), "`{words}` in {}", self.output);
    }
}

#[track_caller]
fn refused(files: &[(&str, &str)]) -> String {
    let (done, output) = gapi(folder(files).path(), &["identify", "p.toml", "--out", "o"]);
    assert!(!done, "{output}");
    output
}

const CELL: &str = "model Cell \"resistance with one RC pair\"
  input Real i(unit = \"A\");
  parameter Real R0(unit = \"Ohm\") = 0.01, R1(unit = \"Ohm\") = 0.01, C1(unit = \"F\") = 100;
  Real v1(start = 0, fixed = true);
  output Real v(unit = \"V\") = 3.7 - R0*i - v1;
equation
  C1*der(v1) = i - v1/R1;
end Cell;
";

const CELL_PROBLEM: &str = "model = \"Cell\"
files = [\"cell.mo\"]
[parameters]
R0 = { min = 0.001, max = 1 }
R1 = { min = 0.001, max = 1 }
C1 = { min = 10, max = 1e5 }
[[experiment]]
data = \"d.csv\"
x = { variable = \"time\", column = \"t\" }
outputs = { v = \"v\" }
inputs = { i = \"i\" }
[method]
name = \"levenberg_marquardt\"
";

/// The cell with R0 0.05, R1 0.03 and C1 600 under steps of the current at 0, 100, 300 …, whose rows
/// are written twice, with the values before and after them.
fn pulses() -> String {
    let steps = [(0.0, 0.0), (100.0, 2.0), (300.0, 0.0), (420.0, -1.0), (600.0, 0.0)];
    let (mut text, mut v1) = ("t,i,v\n".to_owned(), 0.0);
    for (number, (begin, current)) in steps.iter().enumerate() {
        let end = steps.get(number + 1).map_or(800.0, |next| next.0);
        for k in 0..=((end - begin) / 20.0) as usize {
            let t = 20.0 * k as f64;
            let now = current * 0.03 + (v1 - current * 0.03) * (-t / 18.0_f64).exp();
            text += &format!("{},{current},{}\n", begin + t, 3.7 - 0.05 * current - now);
        }
        v1 = current * 0.03 + (v1 - current * 0.03) * (-(end - begin) / 18.0_f64).exp();
    }
    text
}

#[test]
fn two_rows_with_one_time_stamp_are_the_limits_at_a_step() {
    let data = pulses();
    let solved =
        Solved::of(&folder(&[("cell.mo", CELL), ("p.toml", CELL_PROBLEM), ("d.csv", &data)]));
    solved.is("R0", 0.05, 1e-6);
    solved.is("R1", 0.03, 1e-5);
    solved.is("C1", 600.0, 1e-5);
    solved.says(
        "4 time stamps are in several consecutive rows of `t`, such as 100 in line 7 and line 8",
    );
    solved.does_not_say("utlier");
}

#[test]
fn a_missing_value_after_a_step_takes_that_before_it_with_it() {
    let data = pulses();
    let torn: Vec<&str> =
        data.lines().map(|line| if line.starts_with("300,0") { "300,0," } else { line }).collect();
    let solved = Solved::of(&folder(&[
        ("cell.mo", CELL),
        ("p.toml", CELL_PROBLEM),
        ("d.csv", &torn.join("\n")),
    ]));
    solved.is("R0", 0.05, 1e-6);
    solved.says("`v` in line 18 is not compared: it precedes an event at 300 s");
}

/// A step at the start has no simulated value before it.
#[test]
fn the_value_before_a_step_at_the_start_is_not_compared() {
    let data = pulses();
    let rows = data.lines().skip(1).filter_map(|line| {
        let (t, rest) = line.split_once(',')?;
        let t: f64 = t.parse().unwrap();
        (t >= 100.0).then(|| format!("{},{rest}\n", t - 100.0))
    });
    let text = format!("t,i,v\n{}", rows.collect::<String>());
    let solved =
        Solved::of(&folder(&[("cell.mo", CELL), ("p.toml", CELL_PROBLEM), ("d.csv", &text)]));
    solved.is("R0", 0.05, 1e-6);
    solved.says(
        "`v` in line 2 is not compared: it precedes an event at 0 s, where the simulation begins",
    );
}

/// The ball leaves the ground with a part of its velocity, at times that depend on it.
const BALL: &str = include_str!("../../data/models/measured_time_ball.mo");

#[test]
fn a_result_file_with_events_gives_the_parameter_back() {
    let problem = "model = \"Ball\"
files = [\"ball.mo\"]
[parameters]
e = { min = 0.7, max = 0.9 }
[stop]
evaluations = 300
[[experiment]]
data = \"r.mat\"
x = { variable = \"time\", column = \"Time\" }
outputs = { h = \"h\", v = \"v\" }
";
    let script = "openModel(\"ball.mo\");
                  simulateModel(\"Ball(e = 0.8)\", stopTime = 1.5, numberOfIntervals = 30, tolerance = 1e-10, \
                  resultFile = \"r\");\n";
    let at = folder(&[("ball.mo", BALL), ("p.toml", problem), ("s.mos", script)]);
    let (done, output) = gapi(at.path(), &["run", "s.mos"]);
    assert!(done, "{output}");
    let solved = Solved::of(&at);
    solved.is("e", 0.8, 1e-5);
    solved.does_not_say("utlier");
}

#[test]
fn scripts_compare_both_sides_of_a_step() {
    let model = "model Step
  parameter Real R = 1;
  output Real v = R*(if time < 2 then 1 else 3);
  Real x(start = 0, fixed = true);
equation
  der(x) = v;
end Step;
";
    let script = "(ok, sizes, x, y) = GAPILib.Basics.Exp_Adq_SISO(\"d.csv\", \"t\", \"v\");
(data, why) = GAPILib.Basics.Eval(\"step.mo\", \"Step\", x, [5], {\"R\"}, \"time\", \"v\");
GAPILib.Basics.Fit(data, y)
";
    let data = "t,v\n0,5\n1,5\n2,5\n2,15\n3,15\n";
    let at = folder(&[("step.mo", model), ("s.mos", script), ("d.csv", data)]);
    let (_, output) = gapi(at.path(), &["run", "s.mos"]);
    assert!(output.contains("{0.0}") || output.contains("{0}"), "{output}");
}

const HOUSE: &str = "model House
  input Real Ta(unit = \"degC\");
  parameter Real tau(unit = \"s\") = 2000;
  Real T(unit = \"degC\", start = 20, fixed = true);
equation
  tau*der(T) = Ta - T;
end House;
";

const HOUSE_PROBLEM: &str = "model = \"House\"
files = [\"house.mo\"]
[parameters]
tau = { min = 500, max = 50000 }
T = { min = 0, max = 40, initial = true }
[[experiment]]
name = \"winter\"
data = \"d.csv\"
x = { variable = \"time\", column = \"t\" }
outputs = { T = \"T\" }
inputs = { Ta = { column = \"Ta\", interpolation = \"hold\" } }
[method]
name = \"levenberg_marquardt\"
";

/// The house with a time constant of 9000 s: 200 rows in quarters of an hour.
fn winter() -> Vec<[f64; 3]> {
    let mut temperature = 15.0;
    let mut rows = Vec::new();
    for k in 0..200 {
        let t = 900.0 * f64::from(k);
        let outside = 5.0 + 4.0 * (t / 20_000.0).sin() + f64::from(k % 7);
        rows.push([t, outside, temperature]);
        temperature = outside + (temperature - outside) * (-0.1_f64).exp();
    }
    rows
}

fn csv(rows: &[[f64; 3]]) -> String {
    let line = |[t, a, b]: &[f64; 3]| format!("{t},{a},{b}\n");
    format!("t,Ta,T\n{}", rows.iter().map(line).collect::<String>())
}

#[test]
fn gaps_are_named_and_cut_where_that_is_wanted() {
    let mut rows = winter();
    let after = rows[140];
    rows.drain(80..140);
    let data = csv(&rows);
    let files = [("house.mo", HOUSE), ("p.toml", HOUSE_PROBLEM), ("d.csv", data.as_str())];
    let held = Solved::of(&folder(&files));
    held.says(
        "the input `Ta` has a gap of 54900 s (15.25 h) after line 81 (median step 900 s (15 min)), \
         in which it holds its last value",
    );
    let problem = HOUSE_PROBLEM.replacen("name =", "segments = \"auto\"\nname =", 1);
    let files = [("house.mo", HOUSE), ("p.toml", problem.as_str()), ("d.csv", data.as_str())];
    let cut = Solved::of(&folder(&files));
    cut.is("tau", 9000.0, 1e-5);
    cut.is("T", 15.0, 1e-5);
    cut.is("T@winter part 2", after[2], 1e-5);
    cut.says("it is cut into 2 parts with separate initial values: line 2 to line 81, line 82 to line 141");
    cut.does_not_say("a gap of");
    // The same cut by its time.
    let problem = HOUSE_PROBLEM.replacen("name =", "segments = [100000]\nname =", 1);
    let files = [("house.mo", HOUSE), ("p.toml", problem.as_str()), ("d.csv", data.as_str())];
    Solved::of(&folder(&files)).is("tau", 9000.0, 1e-5);
}

#[test]
fn time_that_starts_again_begins_another_part() {
    let rows = winter();
    let first = rows[..60].iter().copied();
    let second = rows[90..].iter().map(|[t, a, b]| [t - 81_000.0, *a, *b]);
    let data = csv(&first.chain(second).collect::<Vec<_>>());
    let files = [("house.mo", HOUSE), ("p.toml", HOUSE_PROBLEM), ("d.csv", data.as_str())];
    assert!(refused(&files).contains("write `segments = \"auto\"`"));
    let problem = HOUSE_PROBLEM.replacen("name =", "segments = \"auto\"\nname =", 1);
    let files = [("house.mo", HOUSE), ("p.toml", problem.as_str()), ("d.csv", data.as_str())];
    let solved = Solved::of(&folder(&files));
    solved.is("tau", 9000.0, 1e-5);
    solved.is("T@winter part 2", rows[90][2], 1e-5);
}

#[test]
fn parts_need_initial_values_that_are_estimated() {
    let data = csv(&winter());
    let problem = HOUSE_PROBLEM.replacen("name =", "segments = [90000]\nname =", 1);
    let none = problem.replace("T = { min = 0, max = 40, initial = true }\n", "");
    let text = refused(&[("house.mo", HOUSE), ("p.toml", &none), ("d.csv", &data)]);
    assert!(text.contains("where the values of `T` are unknown"), "{text}");
    let fixed = problem.replace("min = 0, max = 40", "fixed = 15");
    let text = refused(&[("house.mo", HOUSE), ("p.toml", &fixed), ("d.csv", &data)]);
    assert!(text.contains("the initial value of `T` is not the given one"), "{text}");
    let outside = problem.replace("[90000]", "[1e6]");
    let text = refused(&[("house.mo", HOUSE), ("p.toml", &outside), ("d.csv", &data)]);
    assert!(text.contains("cuts at 1000000 s"), "{text}");
}

#[test]
fn missing_cells_of_an_input_and_codes_of_instruments_are_named() {
    let rows = winter();
    let mut lines: Vec<String> = csv(&rows).lines().map(str::to_owned).collect();
    lines[50] = format!("{},,{}", rows[49][0], rows[49][2]);
    lines[60] = format!("{},{},-999", rows[59][0], rows[59][1]);
    let solved = Solved::of(&folder(&[
        ("house.mo", HOUSE),
        ("p.toml", HOUSE_PROBLEM),
        ("d.csv", &lines.join("\n")),
    ]));
    solved.says("1 of 200 values of `Ta` is missing: row 50; there the input holds its last value");
    solved.says("-999 in line 61 of `T` is far from the other values");
}

#[test]
fn the_interpolation_that_fits_better_is_named() {
    let data = csv(&winter());
    let problem = HOUSE_PROBLEM.replace(", interpolation = \"hold\"", "");
    let files = [("house.mo", HOUSE), ("p.toml", problem.as_str()), ("d.csv", data.as_str())];
    let solved = Solved::of(&folder(&files));
    solved.says("the input `Ta` is interpolated linearly between samples");
    solved.says("The interpolation of `Ta` is not given: with \"linear\" the objective is ");
    solved.says("\"hold\" fits better by a factor of ");
    let given = Solved::of(&folder(&[
        ("house.mo", HOUSE),
        ("p.toml", HOUSE_PROBLEM),
        ("d.csv", data.as_str()),
    ]));
    given.does_not_say("The interpolation of");
}

const DECAY: &str = "model Decay
  parameter Real k(unit = \"1/s\") = 1;
  Real y(start = 1, fixed = true);
equation
  der(y) = -k*y;
end Decay;
";

const DECAY_PROBLEM: &str = "model = \"Decay\"
files = [\"decay.mo\"]
[parameters]
k = { min = 0.001, max = 10 }
[[experiment]]
data = \"d.csv\"
x = { variable = \"time\", column = \"t\" }
outputs = { y = \"y\" }
[method]
name = \"levenberg_marquardt\"
";

/// exp(-0.3 t) at ten seconds, whose times are written by `stamp`.
fn decay(head: &str, stamp: impl Fn(f64) -> String) -> String {
    let line = |k: i32| {
        let t = f64::from(k);
        format!("{},{}\n", stamp(t), (-0.3 * t).exp())
    };
    format!("{head},y\n{}", (0..10).map(line).collect::<String>())
}

#[test]
fn times_that_count_from_a_date_count_from_the_first_row() {
    for (head, begin, per_second, words) in [
        ("t", 1_700_000_000.0, 1.0, "`t` holds Unix times, read as seconds since the first row"),
        ("t", 1_700_000_000_000.0, 1000.0, "`t` holds Unix times in milliseconds, read as"),
        ("t [d]", 45_356.5, 1.0 / 86_400.0, "`t` holds day numbers of Excel, read as"),
        ("t [d]", 739_316.5, 1.0 / 86_400.0, "`t` holds day numbers of MATLAB, read as"),
    ] {
        let data = decay(head, |t| format!("{:.10}", begin + t * per_second));
        let files = [("decay.mo", DECAY), ("p.toml", DECAY_PROBLEM), ("d.csv", data.as_str())];
        let solved = Solved::of(&folder(&files));
        solved.is("k", 0.3, 1e-4);
        solved.says(words);
    }
    let data = decay("t", |t| format!("{:.10}", 45_356.5 + t / 86_400.0));
    let files = [("decay.mo", DECAY), ("p.toml", DECAY_PROBLEM), ("d.csv", data.as_str())];
    let text = refused(&files);
    assert!(
        text.contains("`t` begins at 45356.5: these may be day numbers of Excel or seconds"),
        "{text}"
    );
    let problem = DECAY_PROBLEM.replace("column = \"t\" }", "column = \"t\", unit = \"d\" }");
    let files = [("decay.mo", DECAY), ("p.toml", problem.as_str()), ("d.csv", data.as_str())];
    Solved::of(&folder(&files)).is("k", 0.3, 1e-4);
}

#[test]
fn an_experiment_may_begin_with_its_data() {
    let data = decay("t", |t| (5000.0 + t).to_string());
    let files = [("decay.mo", DECAY), ("p.toml", DECAY_PROBLEM), ("d.csv", data.as_str())];
    Solved::of(&folder(&files))
        .says("the data begin at 5000 s and last 9 s, but the simulation begins at 0 s");
    let problem = DECAY_PROBLEM.replace("[[experiment]]", "[[experiment]]\nstart_time = 5000");
    let files = [("decay.mo", DECAY), ("p.toml", problem.as_str()), ("d.csv", data.as_str())];
    let solved = Solved::of(&folder(&files));
    solved.is("k", 0.3, 1e-6);
    solved.does_not_say("the data begin at");
    // From a later time on, with an initial value that is estimated.
    let problem = problem
        .replace("5000", "5004")
        .replace("[[experiment]]", "y = { min = 0.01, max = 1, initial = true }\n[[experiment]]");
    let files = [("decay.mo", DECAY), ("p.toml", problem.as_str()), ("d.csv", data.as_str())];
    let solved = Solved::of(&folder(&files));
    solved.is("k", 0.3, 1e-5);
    solved.is("y", (-1.2_f64).exp(), 1e-5);
    solved.says("`y` is not compared before the simulation begins at 5004 s (line 2 to line 5)");
}

#[test]
fn an_experiment_that_was_measured_before_zero_begins_with_its_first_row() {
    let data = decay("t", |t| (t - 2.0).to_string());
    let files = [("decay.mo", DECAY), ("p.toml", DECAY_PROBLEM), ("d.csv", data.as_str())];
    let solved = Solved::of(&folder(&files));
    solved.is("k", 0.3, 1e-6);
    solved.says("the simulation begins with the first row, at -2 s");
}

#[test]
fn where_the_model_fails_before_the_data_begin_the_start_time_is_the_remedy() {
    let model = "model Pole\n  parameter Real a = 1;\n  output Real y = 1/(a*time);\n  Real sum(start = 0, fixed = true);\nequation\n  der(sum) = y;\nend Pole;\n";
    let problem =
        DECAY_PROBLEM.replace("Decay", "Pole").replace("decay.mo", "pole.mo").replace("k =", "a =");
    let data = "t,y\n0.5,4\n1,2\n2,1\n";
    let files = [("pole.mo", model), ("p.toml", problem.as_str()), ("d.csv", data)];
    let text = refused(&files);
    assert!(text.contains("write `start_time = 0.5`"), "{text}");
    let problem = problem.replace("[[experiment]]", "[[experiment]]\nstart_time = 0.5");
    let files = [("pole.mo", model), ("p.toml", problem.as_str()), ("d.csv", data)];
    Solved::of(&folder(&files)).is("a", 0.5, 1e-6);
}

#[test]
fn a_difference_of_temperatures_has_no_offset() {
    let model = include_str!("../../data/models/measured_time_difference.mo");
    let rows = (0..20).map(|k| {
        let t = f64::from(k);
        let rise = 12.0 * (1.0 - (-0.2 * t).exp());
        format!("{t},{rise},{},{}\n", 1.8 * rise, rise + 20.0)
    });
    let data = format!("t [s],dT [degC],rise [degF],T [degC]\n{}", rows.collect::<String>());
    let problem = "model = \"P.Heater\"
files = [\"heater.mo\"]
[parameters]
P = { min = 0.1, max = 400 }
k = { min = 0.001, max = 10 }
[[experiment]]
data = \"d.csv\"
x = { variable = \"time\", column = \"t\" }
outputs = { dT = \"dT\", rise = \"rise\", T = \"T\" }
[method]
name = \"levenberg_marquardt\"
";
    let files = [("heater.mo", model), ("p.toml", problem), ("d.csv", data.as_str())];
    let solved = Solved::of(&folder(&files));
    solved.is("P", 12.0, 1e-6);
    solved.is("k", 0.2, 1e-6);
    solved.says("`dT` is converted from degC to K, without an offset, as a temperature difference");
    solved.says("`rise` is converted from degF to K, times 0.555555555555556, without an offset");
    solved.says("`T` is converted from degC to K, plus 273.15");
}

/// A model whose output is a number in this unit, and a problem for its data in `d.csv`.
fn level(unit: &str, entry: &str) -> [(&'static str, String); 2] {
    let model = format!(
        "model Level\n  parameter Real a = 1;\n  output Real y(unit = \"{unit}\") = a*(1 + time/4);\nend Level;\n"
    );
    let problem = format!(
        "model = \"Level\"\nfiles = [\"level.mo\"]\n[parameters]\na = {{ min = -1e6, max = 1e6 }}\n\
         [[experiment]]\ndata = \"d.csv\"\nx = {{ variable = \"time\", column = \"t\" }}\n\
         outputs.y = {{ column = \"y\"{entry} }}\n[method]\nname = \"levenberg_marquardt\"\n"
    );
    [("level.mo", model), ("p.toml", problem)]
}

/// The files of a problem whose first measured value is `first` in the unit `head`.
fn in_units(own: &str, (head, first): (&str, f64), entry: &str) -> Vec<(&'static str, String)> {
    let rows = (0..6).map(|t| format!("{t},{}\n", first * (1.0 + f64::from(t) / 4.0)));
    let data = format!("t [s],y [{head}]\n{}", rows.collect::<String>());
    level(own, entry).into_iter().chain([("d.csv", data)]).collect()
}

fn borrowed<'f>(files: &'f [(&'static str, String)]) -> Vec<(&'f str, &'f str)> {
    files.iter().map(|(name, text)| (*name, text.as_str())).collect()
}

#[test]
fn a_revolution_is_two_pi_radians() {
    for (own, head, first, expected) in [
        ("Hz", "rpm", 3000.0, 50.0),
        ("1/min", "rpm", 3000.0, 3000.0),
        ("1/s", "rev/min", 3000.0, 50.0),
        ("rad/s", "rpm", 3000.0, 100.0 * std::f64::consts::PI),
        ("rev/min", "Hz", 50.0, 3000.0),
    ] {
        let files = in_units(own, (head, first), "");
        Solved::of(&folder(&borrowed(&files))).is("a", expected, 1e-6);
    }
    for (own, head, factors) in [
        ("rad/s", "Hz", ["factor = 6.283185307179", "factor = 1`"]),
        ("Hz", "rad/s", ["factor = 0.1591549430918", "factor = 1`"]),
        ("rad/s", "1/min", ["factor = 0.104719755119", "factor = 0.01666666666666"]),
    ] {
        let text = refused(&borrowed(&in_units(own, (head, 50.0), "")));
        let words = ["`y` is in", "a revolution is 2 pi rad", factors[0], factors[1], "p.toml:"];
        for words in words {
            assert!(text.contains(words), "{own} {head}: no `{words}` in {text}");
        }
    }
    let files = in_units("rad/s", ("Hz", 50.0), ", factor = 6.283185307179586");
    Solved::of(&folder(&borrowed(&files))).is("a", 314.159_265, 1e-6);
}

#[test]
fn parts_per_million_are_parts_of_a_whole() {
    for (own, head, expected) in
        [("1", "ppm", 0.003), ("%", "ppmv", 0.3), ("1", "ppb", 3e-6), ("1", "‰", 3.0)]
    {
        let files = in_units(own, (head, 3000.0), "");
        let solved = Solved::of(&folder(&borrowed(&files)));
        // The range is 12 orders of magnitude wider than the smallest value.
        solved.is("a", expected, 1e-4);
        solved.says(&format!("`y` is converted from {head} to {own}, times "));
    }
    let files = in_units("kg/m3", ("ppm", 3000.0), "");
    let text = refused(&borrowed(&files));
    assert!(text.contains("`y` is in kg/m3, but its column is in ppm"), "{text}");
    let here = folder(&borrowed(&in_units("1", ("ppm", 3000.0), "")));
    let (done, output) = gapi(here.path(), &["new", "d.csv", "--model", "level.mo"]);
    let draft = fs::read_to_string(here.path().join("d.toml")).unwrap();
    assert!(done && draft.contains("6750 ppm; converted to 1"), "{output}{draft}");
}

#[test]
fn what_a_name_suggests_is_said_and_not_converted() {
    let [model, (name, problem)] = level("V", "");
    let problem =
        problem.replace("\"t\"", "\"time_min\"").replace("column = \"y\"", "column = \"U_mV\"");
    let data = "time_min,U_mV\n0,1000\n1,1250\n2,1500\n3,1750\n".to_owned();
    let files = [model, (name, problem), ("d.csv", data)];
    let here = folder(&borrowed(&files));
    let solved = Solved::of(&here);
    solved.is("a", 1000.0, 1e-6);
    solved.says("`U_mV` is read in V; the name suggests mV: write `unit = \"mV\"`");
    solved.says("is read in seconds; the name suggests min: write `x = ");
    let files = in_units("V", ("mV", 1000.0), "");
    Solved::of(&folder(&borrowed(&files))).does_not_say("suggests");
    _ = gapi(here.path(), &["new", "d.csv", "--model", "level.mo"]);
    let draft = fs::read_to_string(here.path().join("d.toml")).unwrap();
    assert!(draft.contains("s assumed; the name suggests min: write `unit = \"min\"`"), "{draft}");
}

/// x = 20 + 5 (1 - exp(-0.01 t)) after `zero`, sampled every 10 s from `first` on.
fn warming(zero: f64, first: f64, entry: &str) -> [(&'static str, String); 3] {
    let model = "model Warming\n  parameter Real k = 0.1;\n  input Real u;\n  Real x(start = 20, fixed = true);\n\
                 equation\n  der(x) = k*(20 + u - x);\nend Warming;\n";
    let problem = format!(
        "model = \"Warming\"\nfiles = [\"warming.mo\"]\n[parameters]\nk = {{ min = 1e-4, max = 1 }}\n\
         [[experiment]]\ndata = \"d.csv\"\nx = {{ variable = \"time\", column = \"t\" }}\n\
         outputs.x = {{ column = \"x\" }}\ninputs.u = {{ column = \"u\", interpolation = \"hold\" }}\n{entry}\n"
    );
    let rows = (0..60).map(|row| {
        let t = first + 10.0 * f64::from(row);
        format!("{t},{},5\n", 20.0 + 5.0 * (1.0 - (-0.01 * (t - zero)).exp()))
    });
    let data = format!("t [s],x,u\n{}", rows.collect::<String>());
    [("warming.mo", model.to_owned()), ("p.toml", problem), ("d.csv", data)]
}

#[test]
fn data_that_begin_well_after_the_simulation_are_named() {
    let words = "the data begin at 300 s, but the simulation begins at 0 s";
    let here = folder(&borrowed(&warming(300.0, 300.0, "")));
    let solved = Solved::of(&here);
    solved.says(words);
    solved.says("inputs from columns are held at their first values until then");
    solved.says("write `start_time = 300`");
    let (_, output) = gapi(here.path(), &["new", "d.csv", "--model", "warming.mo"]);
    assert!(output.contains(words), "{output}");
    for (zero, first, entry) in
        [(300.0, 300.0, "start_time = 300"), (0.0, 10.0, ""), (0.0, 0.0, "")]
    {
        let solved = Solved::of(&folder(&borrowed(&warming(zero, first, entry))));
        solved.is("k", 0.01, 1e-4);
        solved.does_not_say("the simulation begins");
    }
}

#[test]
fn commas_that_may_separate_thousands_are_refused_or_named() {
    let [model, (name, problem)] = level("V", "");
    let problem = problem.replace("d.csv", "d.tsv");
    let files = |rows: &str| {
        let data = format!("t [s]\ty [mV]\n{rows}");
        [model.clone(), (name, problem.clone()), ("d.tsv", data)]
    };
    let text = refused(&borrowed(&files("0\t800\n1\t999\n2\t1,200\n3\t1,400\n")));
    assert!(
        text.contains("line 4, column 2: `1,200` in `y [mV]` is ambiguous: 1.200 or 1200"),
        "{text}"
    );
    assert!(text.contains("beside `800` in line 2"), "{text}");
    let solved = Solved::of(&folder(&borrowed(&files("0\t1,200\n1\t1,500\n2\t1,800\n3\t2,100\n"))));
    solved.is("a", 0.0012, 1e-6);
    solved.says(
        "`1,200` in `y [mV]`, line 2, column 2, is read with a decimal comma; if it means 1200",
    );
}

#[test]
fn durations_of_more_than_a_day_are_no_times_of_day() {
    let [model, problem] = level("V", "");
    let data = "t,y [V]\n25:00:00,2\n25:00:01,2.5\n25:00:02,3\n25:00:03,3.5\n".to_owned();
    let solved = Solved::of(&folder(&borrowed(&[model, problem, ("d.csv", data)])));
    solved.is("a", 2.0, 1e-6);
    solved.says(
        "durations, read as seconds since the first point, which is 90000 s after their zero",
    );
    solved.does_not_say("times of day");
}
