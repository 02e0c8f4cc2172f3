//! Mistakes of a first hour: what is written or called as in other programs, and the remedy that the
//! message names.

use crate::cli::{folder, gapi};

const DECAY: &str = "model Decay\n  parameter Real k = 1;\n  Real x(start = 1, fixed = true);\n\
                     equation\n  der(x) = -k*x;\nend Decay;\n";

/// Files of every kind.
const FILES: [(&str, &str); 4] = [
    ("Decay.mo", DECAY),
    ("p.toml", "model = \"Decay\"\n"),
    ("s.mos", "x := 1;\n"),
    ("d.csv", "time,x\n0,1\n1,2\n"),
];

/// Runs the program, which must refuse the command line with these words.
fn refused(arguments: &[&str], words: &[&str]) {
    let here = folder(&FILES);
    let (code, _, errors) = gapi(&here, arguments);
    assert!(code != 0, "{arguments:?} is accepted");
    let output = errors.split_whitespace().collect::<Vec<_>>().join(" ");
    for word in words {
        assert!(output.contains(word), "{arguments:?}: `{word}` is not in: {errors}");
    }
}

#[test]
fn a_file_of_another_kind_is_named_with_its_command() {
    refused(&["run", "p.toml"], &["`p.toml` is a problem file", "`gapi identify p.toml`"]);
    refused(
        &["run", "Decay.mo"],
        &["Modelica", "`gapi simulate Decay.mo`", "`gapi check Decay.mo`"],
    );
    refused(&["run", "d.csv"], &["table of data", "`gapi new d.csv --model MODEL.mo`"]);
    refused(
        &["identify", "Decay.mo"],
        &["not a problem file", "`gapi new DATA.csv --model Decay.mo`"],
    );
    refused(&["identify", "d.csv"], &["table of data", "gapi new d.csv"]);
    refused(&["identify", "s.mos"], &["is a script", "`gapi run s.mos`"]);
    refused(&["teach", "p.toml"], &["is a problem file", "`gapi identify p.toml`"]);
    refused(&["new", "p.toml", "--model", "Decay.mo"], &["is a problem file", "gapi identify"]);
    refused(&["simulate", "p.toml"], &["is a problem file", "gapi identify"]);
    refused(&["report", "p.toml"], &["not a folder of results", "`gapi report results/p`"]);
    refused(&["s.mos"], &["`gapi run s.mos`"]);
}

#[test]
fn files_that_are_not_there_are_called_missing() {
    refused(&["identify", "p"], &["there is no file `p`", "`p.toml`"]);
    refused(&["identify", "."], &["`.` is a folder", "p.toml"]);
    refused(
        &["new", "d.csv", "--model", "none.mo", "-o", "n.toml"],
        &["there is no file `none.mo`"],
    );
    refused(&["simulate", "Decay.mo", "--from", "none.mat"], &["there is no file `none.mat`"]);
    refused(&["fmt", "none.mo"], &["cannot read `none.mo`: it does not exist"]);
}

#[test]
fn options_say_where_they_belong_and_numbers_how_they_are_written() {
    refused(
        &["identify", "p.toml", "--seed", "3"],
        &["`seed = [1, 2, 3, 4, 5, 6]` in the problem file"],
    );
    refused(&["identify", "p.toml", "--method", "lm"], &["`[method]` in the problem file"]);
    refused(&["identify", "p.toml", "--evaluations", "1e4"], &["a whole number: 10000"]);
    refused(&["new", "d.csv", "Decay.mo"], &["write `--model Decay.mo`"]);
    refused(&["simulate", "Decay.mo", "--stop-time", "5s"], &["without a unit: 5"]);
    refused(&["simulate", "Decay.mo", "--stop-time", "1", "--set", "k=1,5"], &["`1.5`"]);
    refused(&["help", "run"], &["it is a command of gapi: `gapi run --help`"]);
    refused(
        &["teach", "s.mos"],
        &["`s.mos`: the trace contains no generation", "a script that calls `Eval`"],
    );
}

#[test]
fn a_filter_that_matches_nothing_is_refused() {
    let base = ["simulate", "Decay.mo", "--stop-time", "1", "--variable-filter"];
    refused(&[&base[..], &["y*z"]].concat(), &["no variable matches `y*z`", "`y.*z`"]);
    let (code, _, errors) = gapi(&folder(&FILES), &[&base[..], &["x|k"]].concat());
    assert_eq!(code, 0, "{errors}");
}

/// The message for a model with this body.
fn model(body: &str, words: &[&str]) {
    let here = folder(&[("A.mo", format!("model A\n{body}\nend A;\n").as_str())]);
    let (code, _, errors) = gapi(&here, &["simulate", "A.mo", "--stop-time", "1"]);
    assert!(code != 0, "{body} is accepted");
    for word in words {
        assert!(errors.contains(word), "{body}: `{word}` is not in: {errors}");
    }
}

#[test]
fn names_of_other_languages_are_answered_with_those_of_modelica() {
    model("parameter Boolean on = True;", &["`True` is not declared", "write `true`"]);
    model("parameter float k = 1;", &["there is no class `float`", "write `Real`"]);
    model("Real x = 2*pi;", &["write `Modelica.Constants.pi`"]);
    model("Real x = 2*t;", &["write `time`"]);
    model("Real x = pow(time, 2);", &["write `x^y`"]);
    model("Real x[2] = {1, 2};\nReal y = x(1);", &["`x` is a variable", "`x[1]`"]);
    let source = "Modelica.Electrical.Analog.Sources.ConstantVoltage v(V = 1);\n\
                  Modelica.Electrical.Analog.Basic.Ground g;\nequation\n  connect(v, g.p);";
    model(source, &["`v` is not a connector", "`v.p`, `v.n`"]);
    model(
        "Real x = time;\nReal q;\nequation\n  if x > 0.5 then\n    q = 1;\n  end if;",
        &["different numbers of equations", "in `else`"],
    );
}

#[test]
fn scripts_are_answered_with_the_call_that_is_meant() {
    for (text, words) in [
        ("x := {1, 2};\ny := x(1);\n", ["`x` is a variable", "`x[1]`"]),
        ("print('hello');\n", ["strings are in double quotes", "\"hello\""]),
        ("print \"b\"\n", ["`print` is a function", "`print(...)`"]),
        ("x := pow(2, 3);\n", ["no function `pow`", "write `x^y`"]),
        ("x := 1;\nprint(x);\n", ["expected a value of type String", "use `String(x)`"]),
        ("x := True;\n", ["no variable `True`", "write `true`"]),
    ] {
        let (code, _, errors) = gapi(&folder(&[("s.mos", text)]), &["run", "s.mos"]);
        assert!(code != 0 && words.iter().all(|word| errors.contains(word)), "{text}: {errors}");
    }
}

/// What is output of an experiment of the oven with these data and entries.
fn noted(table: &str, entries: &str, arguments: &[&str]) -> String {
    let oven = "model Oven\n  parameter Real k = 0.01;\n  Real T(unit = \"degC\", start = 20, fixed = true);\n\
                Real U(unit = \"degC\") = T + 1;\nequation\n  der(T) = -k*(T - 15);\n\
                annotation(experiment(StopTime = 600));\nend Oven;\n";
    let problem = format!(
        "model = \"Oven\"\nfiles = [\"Oven.mo\"]\n[parameters]\nk = {{ min = 0.001, max = 0.1 }}\n\
         [[experiment]]\ndata = \"d.csv\"\n{entries}\n"
    );
    let here = folder(&[("Oven.mo", oven), ("p.toml", &problem), ("d.csv", table)]);
    let all = [&["identify", "p.toml", "--evaluations", "20"], arguments].concat();
    let (code, out, errors) = gapi(&here, &all);
    assert_eq!(code, 0, "{errors}");
    (errors + &out).split_whitespace().collect::<Vec<_>>().join(" ")
}

#[test]
fn data_that_do_not_fit_the_model_are_noted() {
    let right = "time,T\n0,20\n200,17\n400,16\n600,15.1\n";
    let output = noted(right, "outputs = { T = \"T\" }", &[]);
    for word in ["minutes", "in K", "swapped", "checkpoint in", "yet"] {
        assert!(!output.contains(word), "`{word}` is in: {output}");
    }
    let minutes = "time,T\n0,20\n3,17\n6,16\n10,15.1\n";
    let output = noted(minutes, "outputs = { T = \"T\" }", &[]);
    assert!(
        output.contains("if the times are in minutes") && output.contains("`time [min]`"),
        "{output}"
    );
    let kelvin = "time,T\n0,293\n200,290\n400,289\n600,288\n";
    let output = noted(kelvin, "outputs = { T = \"T\" }", &[]);
    assert!(output.contains("if they are in K, write `unit = \"K\"`"), "{output}");
    let with_unit = kelvin.replace("time,T", "time,T [K]");
    let output = noted(&with_unit, "outputs = { T = \"T\" }", &[]);
    assert!(!output.contains("if they are in K"), "{output}");
    let both = "time,T,U\n0,20,21\n200,17,18\n400,16,17\n600,15.1,16.1\n";
    let output = noted(both, "outputs = { T = \"U\", U = \"T\" }", &[]);
    assert!(output.contains("the output `T` reads the column `U`"), "{output}");
}

#[test]
fn a_run_says_what_there_is_not_to_resume_or_to_watch() {
    let right = "time,T\n0,20\n200,17\n400,16\n600,15.1\n";
    let outputs = "outputs = { T = \"T\" }";
    let output = noted(right, outputs, &["--resume"]);
    assert!(output.contains("there is no checkpoint in"), "{output}");
    let output = noted(right, outputs, &["--watch", "none.toml"]);
    assert!(output.contains("there is no file `none.toml` yet"), "{output}");
}
