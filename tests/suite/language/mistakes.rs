//! Mistakes of a first hour: what is written or called as in other programs, and the remedy that the
//! message names.

use crate::support::program::{folder, gapi};

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
    model("Real x \"level\" = 1;", &["precedes its description", "write `Real x = 1 \"level\"`"]);
    model("parameter Boolean on = True;", &["`True` is not declared", "write `true`"]);
    model("parameter float k = 1;", &["there is no class `float`", "write `Real`"]);
    model("Real x = 2*pi;", &["write `Modelica.Constants.pi`"]);
    model("Real x = 2*t;", &["write `time`"]);
    model("Real x = pow(time, 2);", &["write `x^y`"]);
    model("Real x[2] = {1, 2};\nReal y = x(1);", &["`x` is a variable", "`x[1]`"]);
    model("Real x = time;\nReal y = x(x - 1);", &["`x*(...)`"]);
    model("Real x = inf;", &["write `Modelica.Constants.inf`"]);
    model("Real x[2] = [1, 2];", &["`{...}` a vector"]);
    let here = folder(&[("s.mos", "a := {1, 2, 3};\nb := [a[1:1], a];\n")]);
    let (code, _, errors) = gapi(&here, &["run", "s.mos"]);
    assert!(code != 0 && errors.contains("`cat(1, a, b)` puts one after the other"), "{errors}");
    model(
        "function f\n  input Real u;\n  output Real y;\nalgorithm\n  return 2*u;\nend f;\n\
         Real x = f(time);",
        &["`return` takes no value", "`y := ...;`"],
    );
    let source = "Modelica.Electrical.Analog.Sources.ConstantVoltage v(V = 1);\n\
                  Modelica.Electrical.Analog.Basic.Ground g;\nequation\n  connect(v, g.p);";
    model(source, &["`v` is not a connector", "`v.p`, `v.n`"]);
    model(
        "Real x = time;\nReal q;\nequation\n  if x > 0.5 then\n    q = 1;\n  end if;",
        &["different numbers of equations", "in `else`"],
    );
}

/// What is wrong is shown where the user wrote it, not in a library or a text that was made of it.
#[test]
fn places_are_those_of_the_user() {
    let table = "Modelica.Blocks.Sources.CombiTimeTable t(tableOnFile = true,\n\
                 tableName = \"a\", fileName = \"none.txt\");\nReal x = t.y[1];";
    model(table, &["there is no file `none.txt`", "A.mo:3:29"]);
    model(
        "model B final parameter Real k = 1; end B;\nB b(k = 2);",
        &["is final", "declared final here"],
    );
    let script = "openModel(\"Decay.mo\");\nsimulateModel(\"Decay(k = 0,5)\");\n";
    let here = folder(&[("Decay.mo", DECAY), ("s.mos", script)]);
    let (code, _, errors) = gapi(&here, &["run", "s.mos"]);
    assert!(
        code != 0 && errors.contains("s.mos:2:1") && errors.contains("write `0.5`"),
        "{errors}"
    );
    let script = "openModel(\"C:/models/Decay.mo\");\n";
    let (code, _, errors) = gapi(&folder(&[("s.mos", script)]), &["run", "s.mos"]);
    assert!(code != 0 && (cfg!(windows) || errors.contains("no drive `C:`")), "{errors}");
}

/// A problem file is wrong where it names what is not there, or what it may not estimate.
#[test]
fn problem_files_say_where_files_are_sought_and_what_is_final() {
    let problem = |data: &str, parameter: &str| {
        format!(
            "model = \"M\"\nfiles = [\"M.mo\"]\n[parameters]\n{parameter} = {{ min = 0.1, max = 2 }}\n\
             [[experiment]]\ndata = \"{data}\"\noutputs = {{ x = \"x\" }}\n"
        )
    };
    let source = "model M\n  parameter Real k = 1;\n  final parameter Real c = 2;\n  Real x = c*exp(-k*time);\nend M;\n";
    let here = folder(&[
        ("sub/M.mo", source),
        ("sub/d.csv", "time,x\n0,2\n1,0.8\n2,0.3\n"),
        ("sub/missing.toml", &problem("none.csv", "k")),
        ("sub/final.toml", &problem("d.csv", "c")),
    ]);
    let (code, _, errors) = gapi(&here, &["identify", "sub/missing.toml"]);
    assert!(code != 0 && errors.contains("there is no file `sub/none.csv`"), "{errors}");
    assert!(errors.contains("start from the folder of the problem file, `sub`"), "{errors}");
    assert!(!errors.contains("script"), "{errors}");
    let (code, _, errors) = gapi(&here, &["identify", "sub/final.toml"]);
    assert!(code != 0 && errors.contains("`c` of `M` is declared `final`"), "{errors}");
    assert!(errors.contains("M.mo:3:") && errors.contains("declared final here"), "{errors}");
}

/// A table whose abscissae no longer increase during a fit is named as the cause of failures.
#[test]
fn a_table_that_loses_its_order_says_so() {
    let source = "model M\n  parameter Real b = 2;\n  Modelica.Blocks.Tables.CombiTable1Ds t(table = [0, 0; b, 2; 3, 3]);\n\
                  Real x = t.y[1];\nequation\n  t.u = time;\nend M;\n";
    let problem = "model = \"M\"\nfiles = [\"M.mo\"]\n[parameters]\nb = { min = 0.1, max = 6 }\n\
                   [[experiment]]\ndata = \"d.csv\"\noutputs = { x = \"x\" }\n";
    let table = "time,x\n0,0\n0.5,0.6\n1,1.3\n2,2.1\n2.5,2.6\n3,3\n";
    let here = folder(&[("M.mo", source), ("p.toml", problem), ("d.csv", table)]);
    let (code, out, errors) = gapi(&here, &["identify", "p.toml"]);
    assert_eq!(code, 0, "{errors}");
    let said = out.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(said.contains("must increase strictly, but … follows …"), "{out}");
}

/// A run without a result leaves nothing that the corrected problem stumbles over.
#[test]
fn a_corrected_problem_runs_at_once() {
    let failing =
        DECAY.replace("der(x) = -k*x;", "der(x) = -k*x;\n  assert(k > 5, \"k is small\");");
    let problem = "model = \"Decay\"\nfiles = [\"Decay.mo\"]\n[parameters]\nk = { min = 0.1, max = 2 }\n\
                   [[experiment]]\ndata = \"d.csv\"\noutputs = { x = \"x\" }\n";
    let table = "time,x\n0,1\n1,0.4\n2,0.1\n3,0.05\n";
    let here = folder(&[("Decay.mo", &failing), ("p.toml", problem), ("d.csv", table)]);
    let (code, _, errors) = gapi(&here, &["identify", "p.toml"]);
    assert!(code != 0 && errors.contains("k is small"), "{errors}");
    std::fs::write(here.path().join("Decay.mo"), DECAY).unwrap();
    let (code, _, errors) = gapi(&here, &["identify", "p.toml"]);
    assert_eq!(code, 0, "{errors}");
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
    for word in ["times are in minutes", "in K", "swapped", "checkpoint in", "yet"] {
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

/// An oven with an input: the class of its experiments is built around it.
const HEATED: &str = "model Heated\n  parameter Real G = 2;\n  parameter Real C = 500;\n  \
    parameter Real tau = C/G;\n  input Real P;\n  \
    output Real T(start = 20, fixed = true);\nequation\n  C*der(T) = P - G*(T - 20);\n  \
    annotation(experiment(StopTime = 600));\nend Heated;\n";

/// What is output of an experiment of it with these times and entries.
fn heated(times: &[f64], parameters: &str, entries: &str) -> String {
    let rows = times.iter().map(|t| format!("{t},100,{}\n", 20.0 + t / 10.0));
    let table = format!("time,P,T\n{}", rows.collect::<String>());
    let problem = format!(
        "model = \"Heated\"\nfiles = [\"Heated.mo\"]\n[parameters]\n{parameters}\n[[experiment]]\n\
         data = \"d.csv\"\ninputs = {{ P = \"P\" }}\noutputs = {{ T = \"T\" }}\n{entries}\n"
    );
    let here = folder(&[("Heated.mo", HEATED), ("p.toml", &problem), ("d.csv", &table)]);
    let (code, out, errors) = gapi(&here, &["identify", "p.toml", "--evaluations", "20"]);
    assert_eq!(code, 0, "{errors}");
    (errors + &out).split_whitespace().collect::<Vec<_>>().join(" ")
}

#[test]
fn models_with_inputs_have_the_same_notes() {
    let (minutes, seconds) = ([0.0, 3.0, 6.0, 10.0], [0.0, 200.0, 400.0, 600.0]);
    let one = "G = { min = 0.5, max = 20 }";
    let output = heated(&minutes, one, "");
    assert!(output.contains("if the times are in minutes"), "{output}");
    let output = heated(&seconds, one, "");
    for word in ["times are in minutes", "no effect", "computes"] {
        assert!(!output.contains(word), "`{word}` is in: {output}");
    }
    let output = heated(&seconds, one, "stop_time = 300");
    assert!(output.contains("`stop_time = 300` has no effect"), "{output}");
    let output = heated(&seconds, "tau = { min = 10, max = 3000 }", "");
    assert!(output.contains("computes it from `C`, `G`"), "{output}");
    assert!(output.contains("estimate `C`, `G` instead"), "{output}");
}

#[test]
fn names_that_a_file_or_a_model_does_not_have_are_answered_with_those_it_has() {
    refused(
        &["simulate", "Decay.mo", "--stop-time", "1", "--set", "tau=2"],
        &["no parameter `tau`", "its parameters are `k`"],
    );
    refused(&["flatten", "Decay.mo", "--model", "Dec"], &["`Decay.mo` defines `Decay`"]);
}

/// What is output of a script beside a model of a capacitor and its data.
fn script(text: &str) -> (i32, String) {
    let cap = "model Cap\n  parameter Real V0 = 1;\n  parameter Real tau = 1;\n  output Real v;\n\
               equation\n  v = V0*exp(-time/tau);\n  annotation(experiment(StopTime = 8));\nend Cap;\n";
    let data = "t,u\n0,10\n2,6\n4,3.7\n6,2.2\n8,1.35\n";
    let here = folder(&[("Cap.mo", cap), ("d.csv", data), ("s.mos", text)]);
    let (code, out, errors) = gapi(&here, &["run", "s.mos", "--time-limit", "5"]);
    (code, (errors + &out).split_whitespace().collect::<Vec<_>>().join(" "))
}

const READ: &str = "(S, M, Xexp, Yexp) := Exp_Adq_SISO(\"d.csv\", \"t\", \"u\");\n";
const EVAL: &str = "Eval(\"Cap.mo\", \"Cap\", Xexp, [5, 2], {\"V0\", \"tau\"}, \"time\", \"v\")";

#[test]
fn scripts_that_stop_say_what_is_meant() {
    let swapped = READ.replace("\"t\", \"u\"", "\"u\", \"t\"");
    for (text, words) in [
        ("u = {1, 2};\nP := {1, 2} + {3, 4}*u;\n".to_owned(), ["scalar product", "write `.*`"]),
        ("x = {};\nx[1] := 5;\n".to_owned(), ["do not grow", "cat(1, x, {5})"]),
        ("n := 7/2;\nx := zeros(n);\n".to_owned(), ["got the Real 3.5", "`div(a, b)`"]),
        ("x := rand(3);\n".to_owned(), ["no function `rand`", "Ram_Gen_ARENA(Seed, 3)"]),
        ("print(\"x = %g\", 3);\n".to_owned(), ["has no formats", "String(3)"]),
        ("x = {1, 2};\ny := length(x);\n".to_owned(), ["characters of a String", "`size(x, 1)`"]),
        ("cd(\"C:/models\");\n".to_owned(), ["no drive `C:`", "working directory is still"]),
        (
            format!("{READ}D := {};\n", EVAL.replace("{\"V0\", \"tau\"}", "{V0, tau}")),
            ["`Parameter_Names` expects Strings", "write `{\"V0\", \"tau\"}`"],
        ),
        (
            format!("{READ}D := {};\n", EVAL.replace("\"Cap\"", "\"Capacitor\"")),
            ["no class `Capacitor`", "`Cap.mo` defines `Cap`"],
        ),
        (format!("{swapped}D := {EVAL};\n"), ["`Xexp` falls from 10 to 6", "swap them back"]),
        (
            "N := Mutation([1, 2; 3, 4], 0.25, {0.1, 0.2}, {0}, {5, 6}, 1);\n".to_owned(),
            ["2 individuals of 2 genes need 4", "the length of `Param_Min` is 1"],
        ),
    ] {
        let (code, output) = script(&text);
        assert!(code != 0 && words.iter().all(|word| output.contains(word)), "{text}: {output}");
    }
}

#[test]
fn what_runs_otherwise_than_meant_is_noted_once() {
    let cross = |point: i64| {
        let call = format!("N := Cross(2, 0, [1, 2; 3, 4], {{{point}}});\n");
        script(&call.repeat(2)).1
    };
    for idle in [0, 2] {
        let output = cross(idle);
        assert_eq!(output.matches("copies of their parents").count(), 1, "{output}");
    }
    assert!(!cross(1).contains("copies"));
    // Invented data are compared with what is simulated, or with what the script makes of that.
    let rated = |simulated: &str| {
        let call = format!("{READ}D := {EVAL};\nF := Fit({simulated}, {EVAL});\n");
        let (code, output) = script(&(call.clone() + &call));
        assert_eq!(code, 0, "{output}");
        output.matches("`Yexp` is the result of `Eval`").count()
    };
    assert_eq!(
        [rated("Yexp"), rated("1.1*D"), rated("D"), rated("{D[1,j] for j in 1:size(D, 2)}")],
        [1, 1, 0, 0]
    );
    let (_, output) = script("(Xexp, Yexp) := Exp_Adq_SISO(\"d.csv\", \"t\", \"u\");\n");
    assert!(output.contains("`Xexp` takes the output `State_Exp_Adq`"), "{output}");
    let (code, output) = script(READ);
    assert!(code == 0 && !output.contains("takes the output"), "{output}");
}

#[test]
fn a_loop_that_changes_nothing_of_its_condition_is_named_before_it_runs() {
    let all = "Best := 1;\nwhile Best > 0.1 loop\n  BODY\nend while;\n";
    let (_, output) = script(&all.replace("BODY", "Bset := Best/0;"));
    assert!(
        output.contains("changes `Best`") && output.contains("did you mean `Best`?"),
        "{output}"
    );
    for body in [
        "Best := Best/2;",
        "Bset := Best/2; if Bset < 1 then break; end if;",
        "assert(false, \"ends\");",
    ] {
        let (_, output) = script(&all.replace("BODY", body));
        assert!(!output.contains("it does not end"), "{body}: {output}");
    }
}

#[test]
fn models_that_stop_say_what_to_look_at() {
    let state = "Real x(start = 1, fixed = true);";
    model(
        "Real x[3](each start = 1, each fixed = true);\nequation\n  for i in 0:2 loop\n    \
           der(x[i]) = -x[i];\n  end for;",
        &["subscript 0", "the first subscript is 1"],
    );
    let zero = format!("parameter Real k = 0;\n{state}\nequation\n  der(x) = -x/k;");
    model(&zero, &["the divisor `k` is 0"]);
    let equal = format!("{state}\nBoolean hit;\nequation\n  der(x) = -x;\n  hit = x == 0.5;");
    model(&equal, &["`==` and `<>` of Reals are no events", "write `<=`"]);
    let table = "Modelica.Blocks.Sources.TimeTable t(table = [0, 1; 2, 2; 1, 3]);";
    model(table, &["the times of the table decrease", "1 in row 3 follows 2"]);
    let escape = "Real x(start = 2, fixed = true);\nequation\n  der(x) = x^2;";
    model(escape, &["the step size became too small", "beyond all bounds"]);
}

#[test]
fn a_state_without_start_value_is_named() {
    let simulated = |body: &str| {
        let here = folder(&[("A.mo", format!("model A\n{body}\nend A;\n").as_str())]);
        let (code, _, errors) = gapi(&here, &["simulate", "A.mo", "--stop-time", "1"]);
        assert_eq!(code, 0, "{errors}");
        errors
    };
    let silent = simulated("Real x;\nequation\n  der(x) = 1 - x;");
    assert!(silent.contains("the state `x` without start value: it begins at 0"), "{silent}");
    for said in [
        "Real x(start = 0);\nequation\n  der(x) = 1 - x;",
        "Real x(fixed = true);\nequation\n  der(x) = 1 - x;",
        "Real x;\ninitial equation\n  x = 2;\nequation\n  der(x) = 1 - x;",
        "Real x;\nequation\n  x = 2*time;",
    ] {
        let errors = simulated(said);
        assert!(!errors.contains("without start value"), "{said}: {errors}");
    }
}

/// What other countries and other systems write in a script.
#[test]
fn decimal_commas_and_backslashes_in_scripts_are_named() {
    let problem = |data: &str| {
        format!(
            "identify(GAPILib.Problem(modelName = \"Cap\", files = {{\"Cap.mo\"}}, parameters = \
             {{GAPILib.Free(\"tau\", 1, 9)}}, experiments = {{GAPILib.Experiment(data = \"{data}\", \
             xColumn = \"t\", outputs = {{\"v\"}}, columns = {{\"u\"}})}}));\n"
        )
    };
    for (text, words) in [
        ("p = GAPILib.Free(\"R0\",1e-3,1,5);\n".to_owned(), ["point: `1.5`", "`scale`"]),
        ("p = GAPILib.Free(\"R0\", 0,001, 1);\n".to_owned(), ["point: `0.001`", "`scale`"]),
        ("y = sqrt(1,5);\n".to_owned(), ["point: `1.5`", "sqrt"]),
        ("y = sqrt(-1,05);\n".to_owned(), ["point: `-1.05`", "sqrt"]),
        ("simulateModel(\"Cap\", stopTime = 1,5);\n".to_owned(), ["point: `1.5`", "positional"]),
        (problem("C:\\data\\b.csv"), ["`\\b` in a string is a backspace", "write `/` or `\\\\`"]),
        (
            READ.replace("d.csv", "C:\\data\\new.csv"),
            ["`\\n` in a string is a line break", "write `/` or `\\\\`"],
        ),
    ] {
        let (code, output) = script(&text);
        assert!(code != 0, "{text}: {output}");
        for word in words {
            assert!(output.contains(word), "{text}: `{word}` is not in: {output}");
        }
    }
    // Two arguments that are right.
    let (_, output) = script("y = min(1,5);\nz = max(1, 5);\nw = atan2(1,5, 2);\n");
    assert_eq!(output.matches("point:").count(), 1, "{output}");
}

/// One column that cannot be read: what is missing because of it is said with the cell.
#[test]
fn columns_that_cannot_be_read_are_named_where_something_is_missing() {
    let model =
        "model Cap\n  parameter Real tau = 1;\n  output Real v = exp(-time/tau);\nend Cap;\n";
    let problem = "model = \"Cap\"\nfiles = [\"Cap.mo\"]\n[parameters]\ntau = { min = 1, max = 9 }\n\
                   [[experiment]]\ndata = \"d.csv\"\n";
    let dates = "Datum;v\n03/04/2024 10:00;1\n03/05/2024 10:00;0.5\n03/06/2024 10:00;0.2\n";
    let both = "line 2, column 1: `03/04/2024 10:00` in `Datum` is ambiguous: 2024-04-03 with the \
                day first, 2024-03-04 with the month first";
    let cell = "line 3, column 2: `Err` in `v` is not a number";
    for (data, entries, words) in [
        ("t;v\n0;1\n1;Err\n2;0.5\n", "", ["`outputs` is missing", cell]),
        (dates, "outputs = { v = \"v\" }\n", ["no column `time`", both]),
        (
            dates,
            "x = { variable = \"time\", column = \"Datum\" }\noutputs = { v = \"v\" }\n",
            [both, "2024-03-05"],
        ),
    ] {
        let problem = format!("{problem}{entries}");
        let here = folder(&[("Cap.mo", model), ("d.csv", data), ("p.toml", &problem)]);
        let (code, out, errors) = gapi(&here, &["identify", "p.toml"]);
        let output = (errors + &out).split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(code != 0, "{output}");
        for word in words {
            assert!(output.contains(word), "`{word}` is not in: {output}");
        }
        let (_, out, errors) = gapi(&here, &["new", "d.csv", "--model", "Cap.mo", "-o", "n.toml"]);
        let output = (errors + &out).split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(words.iter().any(|word| output.contains(word)), "{words:?}: {output}");
    }
}
