//! The program as a user starts it: arguments in; output, files and exit code out.

use crate::support::program::{LINE, command, folder, gapi};
use crate::support::shipped::project;
use std::fs;
use std::process::{Child, Command, Stdio};

const DECAY: &str = "\
model Decay
  parameter Real rate = 1;
  Real x(start = 1, fixed = true);
equation
  der(x) = -rate*x;
  annotation(experiment(StopTime = 1));
end Decay;
";

#[test]
fn version_and_help() {
    let here = folder(&[]);
    let (code, out, _) = gapi(&here, &["--version"]);
    assert_eq!((code, out.trim()), (0, concat!("gapi ", env!("CARGO_PKG_VERSION"))));
    for name in [
        "run",
        "test",
        "repl",
        "help",
        "simulate",
        "check",
        "flatten",
        "compare",
        "verify",
        "estimate",
        "explain",
        "completions",
        "man",
    ] {
        let (code, out, _) = gapi(&here, &[name, "--help"]);
        assert_eq!(code, 0);
        assert!(out.contains("Example") && out.contains(&format!("  gapi {name} ")), "{out}");
    }
    assert_eq!(gapi(&here, &["walk"]).0, 2);
}

/// The small standard library is part of the program; one that the user names takes its place.
#[test]
fn a_filter_keeps_the_values_of_aliases() {
    let text = "model M Real x(start = 3); Real a; Real b; Real y; Real z; equation \
                der(x) = 0; a = time; b = 2*time; y = -x; z = y; end M;";
    let here = folder(&[("M.mo", text)]);
    let base = ["simulate", "M.mo", "--model", "M", "--intervals", "1", "--output", "out.csv"];
    for (filter, expected) in [
        ("y", "\"time\",\"y\"\n0.0,-3.0\n1.0,-3.0\n"),
        ("[zb]", "\"time\",\"b\",\"z\"\n0.0,0.0,-3.0\n1.0,2.0,-3.0\n"),
    ] {
        let (code, _, error) = gapi(&here, &[&base[..], &["--variable-filter", filter]].concat());
        assert_eq!(code, 0, "{error}");
        assert_eq!(std::fs::read_to_string(here.path().join("out.csv")).unwrap(), expected);
    }
}

#[test]
fn models_find_their_library_anywhere() {
    let here = folder(&[(
        "Circuit.mo",
        "model Circuit
          Modelica.Electrical.Analog.Sources.ConstantVoltage source(V = 6);
          Modelica.Electrical.Analog.Basic.Resistor resistor(R = 2);
          Modelica.Electrical.Analog.Basic.Ground ground;
        equation
          connect(source.p, resistor.p);
          connect(source.n, resistor.n);
          connect(source.n, ground.p);
        end Circuit;",
    )]);
    let simulate = ["simulate", "Circuit.mo", "--model", "Circuit", "--output", "out.csv"];
    let (code, _, errors) = gapi(&here, &[&simulate[..], &["--stop-time", "1"]].concat());
    assert_eq!((code, errors.as_str()), (0, ""));
    let table = fs::read_to_string(here.path().join("out.csv")).unwrap();
    let column = table.lines().next().unwrap().split(',').position(|n| n == "\"resistor.i\"");
    let last = table.lines().last().unwrap().split(',').nth(column.unwrap()).unwrap();
    assert_eq!(last, "3.0");

    fs::create_dir(here.path().join("mine")).unwrap();
    fs::write(here.path().join("mine/Modelica.mo"), "package Modelica end Modelica;").unwrap();
    let (code, _, errors) = gapi(&here, &[&simulate[..], &["--library", "mine"]].concat());
    assert_ne!(code, 0);
    assert!(errors.contains("Modelica.Electrical"), "{errors}");
}

#[test]
fn exit_codes_follow_the_strictness() {
    let here = folder(&[("good.mos", "print(\"one\")\n"), ("bad.mos", "a = b\nprint(\"on\")\n")]);
    assert_eq!(gapi(&here, &["run", "good.mos"]), (0, "one\n".into(), String::new()));
    let (code, out, errors) = gapi(&here, &["run", "bad.mos"]);
    assert_eq!((code, out.as_str()), (1, "on\n"));
    assert!(
        errors.starts_with("error[unknown-variable]") && errors.contains("bad.mos:1:5"),
        "{errors}"
    );
    let (code, out, _) = gapi(&here, &["run", "bad.mos", "--strict"]);
    assert_eq!((code, out.as_str()), (1, ""), "nothing runs behind the error");
    let (code, _, errors) = gapi(&here, &["run", "bad.mos", "--lenient"]);
    assert!(code == 0 && errors.contains("unknown-variable"), "{errors}");
    assert_eq!(gapi(&here, &["run", "good.mos", "-q"]), (0, "one\n".into(), String::new()));
    assert_eq!(gapi(&here, &["run", "bad.mos", "--strict", "--lenient"]).0, 2);
    assert_eq!(gapi(&here, &["run", "good.mos", "--threads", "0"]).0, 2);
    let (code, _, errors) = gapi(&here, &["run", "godo.mos"]);
    assert!(code == 1 && errors.contains("script-not-found"), "{errors}");
}

#[test]
fn a_transcript_holds_statements_and_answers() {
    let here = folder(&[("a.mos", "x = 2\nprint(\"hi\")\n")]);
    assert_eq!(gapi(&here, &["run", "a.mos", "--transcript", "t.txt"]).0, 0);
    let text = fs::read_to_string(here.path().join("t.txt")).unwrap();
    assert!(text.contains(">>> x = 2") && text.contains("hi"), "{text}");
    let (code, _, errors) = gapi(&here, &["run", "a.mos", "--transcript", "no/t.txt"]);
    assert!(
        code == 1 && errors.contains("cannot write `no/t.txt`: its folder does not exist"),
        "{errors}"
    );
}

#[test]
fn parameters_of_every_type_are_set_by_their_values() {
    let here = folder(&[(
        "M.mo",
        "model D type E = enumeration(one, two); parameter E e = E.one; parameter String f = \"a\"; \
         parameter Boolean b = false; Real x = if e == E.two then 2 else 1; \
         Real y = if f == \"b.txt\" then 3 else 4; Real z = if b then 5 else 6; end D;",
    )]);
    let last = |setting: &str, name: &str| {
        let (code, out, errors) = gapi(&here, &["simulate", "M.mo", "D", "--set", setting]);
        assert_eq!(code, 0, "{setting}: {errors}");
        let line = out.lines().map(str::trim).find(|line| line.starts_with(name));
        line.and_then(|line| line.split_whitespace().last()?.parse().ok()).unwrap_or(f64::NAN)
    };
    for (setting, name, value) in [
        ("e=E.two", "x", 2.0),
        ("e=two", "x", 2.0),
        ("e=2", "x", 2.0),
        ("f=b.txt", "y", 3.0),
        ("b=true", "z", 5.0),
    ] {
        assert_eq!(last(setting, name), value, "{setting}");
    }
    for (wrong, said) in [("e=three", "its literals are one, two"), ("b=maybe", "not a value of")] {
        let (code, _, errors) = gapi(&here, &["simulate", "M.mo", "D", "--set", wrong]);
        assert!(code == 1 && errors.contains(said), "{wrong}: {errors}");
    }
}

#[test]
fn simulations_go_to_files() {
    let here = folder(&[("Decay.mo", DECAY)]);
    let base = ["simulate", "Decay.mo", "--model", "Decay"];
    let run = |more: &[&str]| gapi(&here, &[&base[..], more].concat());
    let (code, _, errors) = run(&["--set", "rate=2", "--stop-time", "0.5", "--output", "a.csv"]);
    assert_eq!((code, errors.as_str()), (0, ""));
    let csv = fs::read_to_string(here.path().join("a.csv")).unwrap();
    let header: Vec<&str> = csv.lines().next().unwrap().split(',').collect();
    let last: Vec<&str> = csv.lines().last().unwrap().split(',').collect();
    let column = |name: &str| header.iter().position(|h| h.trim_matches('"') == name).unwrap();
    assert_eq!(last[column("time")].parse::<f64>().unwrap(), 0.5);
    let x: f64 = last[column("x")].parse().unwrap();
    assert!((x - (-1.0_f64).exp()).abs() < 1e-3, "{x}");
    assert_eq!(run(&["--output", "a.mat"]).0, 0);
    assert!(here.path().join("a.mat").is_file());
}

/// The class around a model whose inputs follow data has the experiment of the model.
#[test]
fn a_simulation_with_inputs_keeps_the_annotation() {
    let text = "model M input Real u; output Real x(start = 1, fixed = true); equation \
                der(x) = u - 3*x*x; \
                annotation(experiment(StopTime = 3, Interval = 0.5, Tolerance = 1e-9)); end M;";
    let here = folder(&[("M.mo", text), ("u.csv", "time,u\n0,1\n1,2\n2,0\n")]);
    let run = |more: &[&str]| {
        let own = ["simulate", "M.mo", "--input", "u.csv", "--output", "r.csv"];
        let (code, out, errors) = gapi(&here, &[&own, more].concat());
        assert_eq!(code, 0, "{out}{errors}");
        fs::read_to_string(here.path().join("r.csv")).expect("results")
    };
    let annotated = run(&[]);
    let last = annotated.lines().last().expect("a row");
    assert!(last.starts_with("3.0,"), "{annotated}");
    assert_eq!(annotated, run(&["--tolerance", "1e-9"]));
    assert_ne!(annotated, run(&["--tolerance", "1e-4"]));
}

/// The simulation sees the samples: it makes a step for each, with a method of one step.
#[test]
fn a_simulation_with_samples_steps_from_one_to_the_next() {
    let text = "model M input Real u; Real x(start = 1, fixed = true); equation \
                der(x) = u - x*x; annotation(experiment(StopTime = 100)); end M;";
    let row = |k: usize| format!("{k},{}\n", 0.5 + (k * k % 7) as f64 / 7.0);
    let data: String = (0..=100).map(row).collect();
    let here = folder(&[("M.mo", text), ("u.csv", &format!("time,u\n{data}"))]);
    let own = ["simulate", "M.mo", "--input", "u.csv", "--interpolation", "hold", "--stats"];
    let (code, out, errors) = gapi(&here, &own);
    assert_eq!(code, 0, "{out}{errors}");
    let row = |name: &str| {
        out.lines().find_map(|line| line.trim().strip_prefix(name)?.trim().parse::<u64>().ok())
    };
    let explicit = row("of these explicit, as not stiff");
    assert!(explicit.is_some() && explicit == row("accepted steps"), "{out}");
}

#[test]
fn inputs_follow_the_columns_of_a_file() {
    let model = "model Tank
  input Real u;
  input Boolean open;
  Real y(start = 0, fixed = true);
equation
  der(y) = (if open then u else 0) - y;
end Tank;";
    let data = "t,u,open,other\n0,2,TRUE,1\n1,2,TRUE,1\n2,2,FALSE,1\n3,2,FALSE,1\n";
    let here = folder(&[("Tank.mo", model), ("d.csv", data), ("e.csv", "t,v\n0,1\n1,1\n")]);
    let run = |file: &str| {
        let arguments = ["simulate", "Tank.mo", "--input", file, "--tolerance", "1e-8"];
        gapi(&here, &[&arguments[..], &["--output", "y.csv"]].concat())
    };
    let (code, out, errors) = run("d.csv");
    assert!(code == 0 && out.starts_with("Tank: 0 s to 3 s"), "{out}{errors}");
    assert!(errors.contains("`TRUE` as 1 and `FALSE` as 0"), "{errors}");
    let csv = fs::read_to_string(here.path().join("y.csv")).unwrap();
    assert_eq!(csv.lines().next(), Some("\"time\",\"u\",\"open\",\"y\",\"der(y)\""));
    let last: Vec<f64> =
        csv.lines().last().unwrap().split(',').map(|cell| cell.parse().unwrap()).collect();
    let exact = 2.0 * (1.0 - (-2f64).exp()) * (-1f64).exp();
    assert!((last[3] - exact).abs() < 1e-6, "{} {exact}", last[3]);
    let (code, _, errors) = run("e.csv");
    let is_named = errors.contains("`e.csv` has no column") && errors.contains("`u`, `open`");
    assert!(code == 1 && is_named, "{errors}");
    fs::write(here.path().join("l.csv"), "t,u\n0,1\n1,2\n2,3\n").unwrap();
    let (_, _, errors) = run("l.csv");
    assert!(errors.contains("write `--interpolation hold`"), "{errors}");
    // The input at 0.5 s.
    let half = |kind: &str| {
        let linear = ["simulate", "Tank.mo", "--input", "l.csv", "--interpolation", kind];
        let (code, _, errors) = gapi(&here, &[&linear[..], &["--output", "y.csv"]].concat());
        assert!(code == 0 && !errors.contains("--interpolation"), "{errors}");
        let csv = fs::read_to_string(here.path().join("y.csv")).unwrap();
        csv.lines().nth(126).unwrap().split(',').nth(1).unwrap().parse::<f64>().unwrap()
    };
    assert_eq!((half("linear"), half("hold")), (1.5, 1.0));
    fs::write(here.path().join("z.csv"), "Zeit,u\n0,1\n1,2\n").unwrap();
    let (code, _, errors) = run("z.csv");
    let remedy = "give the column of the times the name `time`";
    assert!(code == 1 && errors.contains(remedy), "{errors}");
}

/// A variable of a model is not one of the script that has simulated it.
#[test]
fn variables_of_a_model_are_read_from_its_results() {
    let script = "openModel(\"Decay.mo\");\nsimulateModel(\"Decay\");\ny := 2*x;\n";
    let here = folder(&[("Decay.mo", DECAY), ("job.mos", script)]);
    let (code, _, errors) = gapi(&here, &["run", "job.mos"]);
    assert!(code == 1 && errors.contains("`readTrajectory(\"dsres.mat\", {\"x\"}"), "{errors}");
    let problem = "model = \"Decai\"\n[parameters]\nrate = { min = 1, max = 2 }\n\
                   [[experiment]]\ndata = \"d.csv\"\noutputs = { x = \"x\" }\n";
    let here = folder(&[("p.toml", problem), ("d.csv", "time,x\n0,1\n1,0.5\n")]);
    let (_, _, errors) = gapi(&here, &["identify", "p.toml"]);
    assert!(errors.contains("`files = [") && !errors.contains("openModel"), "{errors}");
}

#[test]
fn wrong_names_get_a_suggestion() {
    let here = folder(&[("Decay.mo", DECAY)]);
    let cases: [(&[&str], &str); 4] = [
        (&["simulate", "Decay.mo", "--model", "Decai"], "Decay"),
        (&["simulate", "Decay.mo", "--model", "Decay", "--set", "rat=2"], "rate"),
        (&["simulate", "Decay.mo", "--model", "Decay", "--method", "Dasl"], "dassl"),
        (&["explain", "unknown-clas"], "unknown-class"),
    ];
    for (arguments, meant) in cases {
        let (code, _, errors) = gapi(&here, arguments);
        assert_ne!(code, 0);
        assert!(errors.to_lowercase().contains("did you mean"), "{arguments:?}: {errors}");
        assert!(errors.to_lowercase().contains(&meant.to_lowercase()), "{arguments:?}: {errors}");
    }
}

#[test]
fn check_flatten_explain_completions() {
    let here = folder(&[("Decay.mo", DECAY)]);
    assert_eq!(gapi(&here, &["check", "Decay.mo"]).0, 0);
    assert_eq!(gapi(&here, &["check", "Decay.mo", "--model", "Decay"]).0, 0);
    let (code, out, _) = gapi(&here, &["flatten", "Decay.mo", "--model", "Decay"]);
    assert!(code == 0 && out.contains("der(x) = "), "{out}");
    let (code, out, _) = gapi(&here, &["explain", "bad-seed"]);
    assert!(code == 0 && out.contains("\nWhat to do\n  "), "{out}");
    let (_, out, _) = gapi(&here, &["explain", "unknown-class"]);
    assert!(out.contains("\n    model M\n") && !out.contains("```"), "{out}");
    let (code, _, _) = gapi(&here, &["man", "--out", "pages"]);
    let page = |name| fs::read_to_string(here.path().join("pages").join(name)).unwrap();
    assert_eq!(code, 0);
    assert!(page("gapi.1").contains("simulate"), "{}", page("gapi.1"));
    assert!(page("gapi-simulate.1").contains("Integration method"));
    assert_eq!(gapi(&here, &["man"]).1, page("gapi.1"));
    let (code, out, _) = gapi(&here, &["completions", "bash"]);
    assert!(code == 0 && out.contains("complete "), "{out}");
    assert_eq!(gapi(&here, &["check", "missing.mo"]).0, 1);
}

/// An argument that is no file and reads as a class is the class.
#[test]
fn classes_are_named_without_an_option() {
    let here = folder(&[("Decay.mo", DECAY)]);
    let (code, out, err) = gapi(&here, &["check", "Decay.mo", "Decay"]);
    assert!(code == 0 && out.contains("states 1"), "{out}{err}");
    let (code, out, err) = gapi(&here, &["simulate", "Decay.mo", "Decay"]);
    assert!(code == 0 && out.starts_with("Decay: "), "{out}{err}");
    assert_eq!(gapi(&here, &["flatten", "Decay.mo", "Decay(x(start = 2))"]).0, 0);
    let (code, out, err) = gapi(&here, &["simulate", "Decay.mo"]);
    assert!(code == 0 && out.starts_with("Decay: "), "the one class of a file: {out}{err}");
    fs::write(here.path().join("Two.mo"), "model A end A; model B end B;").unwrap();
    let (code, _, err) = gapi(&here, &["simulate", "Two.mo"]);
    assert!(code == 2 && err.contains("the files define `A`, `B`"), "{err}");
    let (code, _, err) = gapi(&here, &["simulate", "missing.mo"]);
    assert!(code == 1 && err.contains("there is no file `missing.mo`"), "{err}");
    let (code, _, err) = gapi(&here, &["check", "Decai"]);
    assert!(code == 1 && err.contains("there is no class `Decai`"), "{err}");
    let (_, _, err) = gapi(&here, &["check", "Modelica.Blocks.Sourcs.Sine"]);
    assert!(err.contains("did you mean `Modelica.Blocks.Sources`?"), "{err}");
}

/// A resistance of zero is part of the structure; another value makes another structure.
#[test]
fn parameters_that_sorting_took_for_numbers_can_be_set() {
    let text = "model Wire parameter Real R = 0; Real i; Real v;
        equation R*i = sin(time) - v; 3*der(v) = i; end Wire;";
    let here = folder(&[("Wire.mo", text)]);
    let (code, set, err) = gapi(&here, &["simulate", "Wire.mo", "Wire", "--set", "R=5"]);
    assert!(code == 0 && set.contains("R = 5"), "{set}{err}");
    assert!(err.contains("`R` is a structural parameter of `Wire`"), "{err}");
    let (_, modified, _) = gapi(&here, &["simulate", "Wire.mo", "Wire(R = 5)"]);
    let values = |text: &str| text.split_once('\n').map(|(_, values)| values.to_owned());
    assert_eq!(values(&set), values(&modified));
}

/// A component with open connectors is no system by itself; its local balance is told (MLS §4.8).
#[test]
fn a_lone_component_is_balanced() {
    let text = "connector Pin Real v; flow Real i; end Pin;
        connector In = input Real;
        model Resistor
          Pin p, n; In R; Real v;
        equation
          v = p.v - n.v; v = R*p.i; p.i + n.i = 0;
        end Resistor;";
    let here = folder(&[("Resistor.mo", text)]);
    let (code, out, _) = gapi(&here, &["check", "Resistor.mo", "--model", "Resistor"]);
    let balance =
        "balanced: 6 unknowns, 6 equations with 2 flow variables of connectors and 1 input";
    assert!(code == 0 && out.contains(balance), "{out}");
    assert_eq!(gapi(&here, &["check", "Resistor.mo"]).0, 0);
}

/// Names are looked up in functions and partial classes too, and in branches that are not taken; what is
/// wrong with a class is said once, though models are made of it.
#[test]
fn every_class_is_checked() {
    let text = "package P
          function f input Real u; output Real y; algorithm y := k*u; end f;
          partial model A Real x; equation x = missing; end A;
          model B extends A; end B;
          model C parameter Boolean on = false annotation(Evaluate = true);
            Real x = if on then absent else 1; end C;
        end P;";
    let here = folder(&[("P.mo", text), ("Right.mo", "partial model Right end Right;")]);
    let (code, out, err) = gapi(&here, &["check", "P.mo"]);
    for name in ["k", "missing", "absent"] {
        assert_eq!(err.matches(&format!("`{name}` is not declared")).count(), 1, "{err}");
    }
    assert!(code == 1 && out.contains("P.B: has the errors reported above"), "{out}");
    assert!(out.contains("5 classes, 2 models, 4 with errors"), "{out}");
    let (code, _, err) = gapi(&here, &["check", "P.mo", "P.C"]);
    assert!(code == 1 && err.contains("`absent` is not declared"), "{err}");
    let (code, out, _) = gapi(&here, &["check", "Right.mo"]);
    assert!(code == 0 && out.contains("1 class, 0 models, 0 with errors"), "{out}");
    // What the outside completes: an overdetermined connector, a part of a partial type.
    let text = "package Open
          type Angle extends Real; function equalityConstraint input Angle a; input Angle b;
            output Real r[0]; algorithm end equalityConstraint; end Angle;
          connector Pin Real v; flow Real i; Angle angle; end Pin;
          model Part Pin p; Pin n; equation p.i + n.i = 0; p.v - n.v = p.i;
            Connections.branch(p.angle, n.angle); p.angle = n.angle; end Part;
          partial model Load Real x; end Load;
          model User replaceable Load load; equation load.x = 1; end User;
        end Open;";
    fs::write(here.path().join("Open.mo"), text).unwrap();
    let (code, out, err) = gapi(&here, &["check", "Open.mo"]);
    assert!(code == 0 && out.contains("0 with errors"), "{out}{err}");
    // Of a value of a wrong type the class tells before its model does, in other words.
    let text = "model T Real x = \"a\"; Boolean b = 1; end T;";
    fs::write(here.path().join("T.mo"), text).unwrap();
    let (code, out, err) = gapi(&here, &["check", "T.mo"]);
    assert!(code == 1 && err.matches("error[type-mismatch]").count() == 2, "{err}");
    assert!(out.contains("T: has the errors reported above"), "{out}");
}

/// A component whose parameters are given values where it is used is no error by itself.
#[test]
fn parameters_may_be_left_to_the_user_of_a_class() {
    let text = "model Store parameter Real c; Real x(start = 1, fixed = true);
        equation c*der(x) = -x; end Store;";
    let here = folder(&[("Store.mo", text)]);
    let (code, out, _) = gapi(&here, &["check", "Store.mo"]);
    assert!(code == 0 && out.contains("`c` must have a value where it is used"), "{out}");
    assert_eq!(gapi(&here, &["check", "Store.mo", "Store"]).0, 1);
    // A size without value, and what follows from it; a condition that is false stays an error.
    let text = "model Curve parameter Integer m; parameter Real w[m];
        parameter Real h[size(w, 1)] = w; Real y = h[1]*time; end Curve;";
    fs::write(here.path().join("Curve.mo"), text).unwrap();
    let (code, out, err) = gapi(&here, &["check", "Curve.mo"]);
    assert!(code == 0 && out.contains("0 with errors"), "{out}{err}");
    let text = "model Off parameter Real c; Real v if false; Real y = c*v; end Off;";
    fs::write(here.path().join("Off.mo"), text).unwrap();
    let (code, _, err) = gapi(&here, &["check", "Off.mo"]);
    assert!(code == 1 && err.contains("error[conditional-component]"), "{err}");
}

#[test]
fn colours_are_as_asked() {
    let here = folder(&[("bad.mos", "a = b\n")]);
    let (_, _, plain) = gapi(&here, &["run", "bad.mos", "--color", "never"]);
    let (_, _, coloured) = gapi(&here, &["run", "bad.mos", "--color", "always"]);
    assert!(!plain.contains('\u{1b}') && coloured.contains('\u{1b}'), "{coloured}");
}

/// A process whose output nobody reads any more ends without a panic.
#[test]
fn a_broken_pipe_is_no_panic() {
    let here =
        folder(&[("long.mos", "for k in 1:2000 loop\n  print(\"a line of text\")\nend for\n")]);
    let mut child = command(here.path(), &["run", "long.mos"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert_eq!(String::from_utf8(output.stderr).unwrap(), "");
    assert_eq!(output.status.code(), Some(0));
}

/// The main job with one generation.
fn main_job(cycles: &str) -> String {
    let folder = project("scripts");
    let folder = folder.display();
    format!(
        "cd(\"{folder}\")\nRunScript(\"GAPILib_INI.mos\")\nN_Cycle = {cycles}\nprint(\"begun\")\n\
         RunScript(\"GAPILib_CYCLE.mos\")\n"
    )
}

#[test]
fn results_that_cannot_be_written_are_an_error() {
    let here = folder(&[("job.mos", &main_job("1")), ("taken", "a file")]);
    let (code, _, errors) = gapi(&here, &["run", "job.mos", "--allow-read", "--out", "taken"]);
    assert_eq!(code, 1);
    assert!(errors.contains("error[file-error]"), "{errors}");
    assert_eq!(errors.matches("error[").count(), 1, "{errors}");
}

/// Each problem writes into a folder of its own, equal runs write equal bytes, and `gapi report`
/// draws the page of either kind of run again.
#[test]
fn no_problem_replaces_the_results_of_another() {
    let job = main_job("3");
    let other = job.replace("N_Cycle = 3", "N_Cycle = 2");
    let here = folder(&[("job.mos", &job)]);
    fs::create_dir(here.path().join("sub")).unwrap();
    fs::write(here.path().join("sub/job.mos"), &other).unwrap();
    let read = |name: &str| fs::read(here.path().join(name)).unwrap();
    let (code, out, errors) = gapi(&here, &["run", "job.mos", "--allow-read"]);
    assert!(code == 0 && out.contains("results/job\n"), "{out}{errors}");
    let names = ["result.json", "history.csv", "fit.csv", "individuals.csv", "report.html"];
    let all = || names.map(|name| read(&format!("results/job/{name}")));
    let first = all();
    let (code, out, _) = gapi(&here, &["run", "sub/job.mos", "--allow-read"]);
    assert!(code == 0 && out.contains("results/job-2\n"), "{out}");
    assert!(all() == first, "another problem of the same name has replaced them");
    assert_eq!(gapi(&here, &["run", "job.mos", "--allow-read"]).0, 0);
    assert!(all() == first, "equal runs, equal bytes");
    let page = read("results/job/report.html");
    fs::remove_file(here.path().join("results/job/report.html")).unwrap();
    let (code, out, errors) = gapi(&here, &["report", "results"]);
    assert!(code == 0 && out.contains("least squares from there reaches"), "{out}{errors}");
    assert!(read("results/job/report.html") == page, "of the run before, which was the last");
    let refused = gapi(&here, &["run", "sub/job.mos", "--allow-read", "--out", "results/job"]);
    assert!(refused.0 == 2 && refused.2.contains("--overwrite"), "{refused:?}");
    assert!(all() == first);
    let asked =
        gapi(&here, &["run", "sub/job.mos", "--allow-read", "--out", "results/job", "--overwrite"]);
    assert!(asked.0 == 0 && all() != first, "{asked:?}");
}

#[cfg(unix)]
fn interrupt(child: &Child) {
    let id = child.id().to_string();
    assert!(Command::new("kill").args(["-INT", &id]).status().unwrap().success());
}

#[cfg(unix)]
#[test]
fn an_interrupted_identification_writes_what_it_has() {
    use std::io::{BufRead as _, BufReader, Read as _};
    let here = folder(&[("job.mos", &main_job("1000000").replace("\nRunScript(\"GAPILib_CYCLE", "\nDATASim := Eval(SimuPath, SimuCaseStudyName, Xexp, New_Generation, Parameter_Names, X_Name, Y_Name);\nRated := Fit(DATASim, Yexp);\nprint(\"rated\")\nRunScript(\"GAPILib_CYCLE"))]);
    let mut child = command(here.path(), &["run", "job.mos", "--allow-read"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut lines = BufReader::new(child.stdout.take().unwrap());
    let mut line = String::new();
    while line != "rated\n" {
        line.clear();
        assert_ne!(lines.read_line(&mut line).unwrap(), 0, "ended before it was interrupted");
    }
    interrupt(&child);
    let mut shown = String::new();
    lines.read_to_string(&mut shown).unwrap();
    let output = child.wait_with_output().unwrap();
    let errors = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(130), "{errors}");
    assert!(errors.contains("interrupted"), "{errors}");
    for name in ["history.csv", "result.json"] {
        assert!(here.path().join("results/job").join(name).is_file(), "{name}: {shown}\n{errors}");
    }
}

/// A reference of the decay with points at 0, 0.1 … 1, computed from its solution at another rate.
fn reference(rate: f64) -> String {
    let line =
        |i: i32| format!("{},{}\n", f64::from(i) / 10.0, (-rate * f64::from(i) / 10.0).exp());
    format!("\"time\",\"x\"\n{}", (0..=10).map(line).collect::<String>())
}

#[test]
fn results_are_compared_with_references() {
    let (right, wrong) = (reference(1.0), reference(1.1));
    let here = folder(&[
        ("Decay.mo", DECAY),
        ("right.csv", &right),
        ("wrong.csv", &wrong),
        ("signals.txt", "time\nx\n"),
        ("strange.txt", "y\n"),
    ]);
    let simulate =
        |to: &str| gapi(&here, &["simulate", "Decay.mo", "--model", "Decay", "--output", to]);
    for result in ["result.mat", "result.csv"] {
        assert_eq!(simulate(result).0, 0);
        let agrees = gapi(&here, &["compare", result, "right.csv", "--signals", "signals.txt"]);
        assert_eq!((agrees.0, &*agrees.1), (0, "x  agrees\n1 of 1 signals agree\n"));
        let (code, out, _) = gapi(&here, &["compare", result, "wrong.csv"]);
        assert_eq!(code, 1);
        // The solutions are farthest apart, relative to a tube of equal height, near 1.
        assert!(out.starts_with("x  differs at ") && out.contains("0 of 1 signals agree"), "{out}");
        assert_eq!(gapi(&here, &["compare", result, "wrong.csv", "--tolerance", "0.1"]).0, 0);
    }
    let (code, _, said) =
        gapi(&here, &["compare", "result.mat", "right.csv", "--signals", "strange.txt"]);
    assert!(code == 1 && said.contains("[bad-reference]"), "{said}");
    assert_eq!(gapi(&here, &["compare", "result.mat", "nowhere.csv"]).0, 1);
}

#[test]
fn libraries_are_verified_against_collections() {
    let here = folder(&[]);
    let library = "package Lib
      model Right Real x(start = 1, fixed = true); equation der(x) = -x; end Right;
      model Wrong Real x(start = 1, fixed = true); equation der(x) = -1.1*x; end Wrong;
      model Unknown Real x = y; end Unknown;
      model Alone Real x = time; end Alone;
    end Lib;";
    fs::write(here.path().join("Lib.mo"), library).unwrap();
    for model in ["Right", "Wrong", "Unknown"] {
        let folder = here.path().join("references/Lib").join(model);
        fs::create_dir_all(&folder).unwrap();
        fs::write(folder.join(format!("{model}.csv")), reference(1.0)).unwrap();
    }
    let alone = here.path().join("references/Lib/Alone");
    fs::create_dir_all(&alone).unwrap();
    fs::write(alone.join("comparisonSignals.txt"), "x\n").unwrap();
    let arguments = ["verify", "Lib.mo", "--references", "references", "--output", "table.json"];
    let (code, out, said) = gapi(&here, &[&arguments[..], &["--output", "table.csv"]].concat());
    assert_eq!((code, &*said), (1, ""));
    let last = "4 cases: 3 compiled, 3 simulated, 1 agreed, 1 differ, 1 without a reference";
    assert_eq!(out.lines().last(), Some(last), "{out}");
    assert!(out.contains("flatten: unknown-name"), "{out}");
    let json = fs::read_to_string(here.path().join("table.json")).unwrap();
    assert!(json.contains("\"signal\": \"x\""), "{json}");
    let csv = fs::read_to_string(here.path().join("table.csv")).unwrap();
    assert_eq!(csv.lines().count(), 5, "{csv}");
    let good = [&arguments[..4], &["--filter", "Right"]].concat();
    assert_eq!(gapi(&here, &good).0, 0);
    assert_eq!(gapi(&here, &["verify", "Lib.mo", "--references", "nowhere"]).0, 1);
}

#[test]
fn samples_are_compared_with_what_lies_between_points_of_the_experiment() {
    let here = folder(&[]);
    fs::create_dir(here.path().join("references")).unwrap();
    let model = "package P model Wave Real x; equation x = time^2; \
                 annotation(experiment(StopTime = 1, Interval = 0.5)); end Wave; end P;";
    fs::write(here.path().join("P.mo"), model).unwrap();
    // Between 0, 1/4 and 1, linear; the curve itself is 1/16 and 9/16 at the quarters.
    let write = |x: &str| {
        let text = format!("time=[0, 1]\nx=[{x}]\n");
        fs::write(here.path().join("references/P_Wave.txt"), text).unwrap();
    };
    let verify = || gapi(&here, &["verify", "P.mo", "--references", "references"]).0;
    write("0, 0.125, 0.25, 0.625, 1");
    assert_eq!(verify(), 0);
    write("0, 0.0625, 0.25, 0.5625, 1");
    assert_eq!(verify(), 0);
    write("0, 0.09, 0.25, 0.6, 1");
    assert_eq!(verify(), 1);
}

/// The variable that limits the steps, the relation that causes the events and the loop are named.
#[test]
fn simulations_tell_what_made_them_work() {
    let model = "model M Real slow(start = 1, fixed = true); Real fast(start = 1, fixed = true);
      Real h(start = 1, fixed = true); Real v(fixed = true); Real q;
      equation der(slow) = -1e-3*slow; der(fast) = -100*(fast - sin(30*time));
      der(h) = v; der(v) = -9.81; when h < 0 then reinit(v, -0.5*pre(v)); end when;
      q = sin(q)/2 + 1; end M;";
    let here = folder(&[("M.mo", model)]);
    let arguments = ["simulate", "M.mo", "--model", "M", "--stop-time", "0.8", "--stats"];
    let (code, out, said) = gapi(&here, &arguments);
    assert_eq!((code, &*said), (0, ""));
    let below = |title: &str| {
        let mut lines = out.lines().skip_while(|line| !line.contains(title));
        lines.nth(1).unwrap_or_default().to_owned()
    };
    assert!(below("largest part of the error").ends_with("`fast`"), "{out}");
    assert!(below("caused events").ends_with("2 events  `h < 0` (M.mo:4)"), "{out}");
    assert!(below("algebraic loops").ends_with("{q}"), "{out}");
    assert!(!out.contains("`slow`"), "{out}");
}

/// What was computed until a failure is written, counted and drawn: it says the most about it.
#[test]
fn simulations_that_fail_keep_what_they_have() {
    let text = "model M Real x(start = 1, fixed = true); Real y; equation der(x) = -x; \
                y = sqrt(x - 0.5); end M;";
    let here = folder(&[("M.mo", text), ("out.csv", "\"time\",\"x\"\n0.0,7.0\n")]);
    let base = ["simulate", "M.mo", "--model", "M", "--intervals", "10"];
    let shown = ["--stats", "--plot", "x", "--output", "out.csv"];
    let (code, out, errors) = gapi(&here, &[&base[..], &shown[..]].concat());
    assert_eq!(code, 1);
    assert!(out.contains("M: 0 s to 0.6 s, 7 points"), "{out}");
    assert!(out.contains("accepted steps") && out.contains("trajectories: out.csv"), "{out}");
    assert!(errors.contains("`y` has no value at t = 0.7"), "{errors}");
    let written = fs::read_to_string(here.path().join("out.csv")).unwrap();
    assert_eq!(written.lines().count(), 8, "{written}");
    assert!(written.lines().last().unwrap().starts_with("0.6,0.548"), "{written}");
    // One that does not begin leaves what there is.
    let refused = [&base[..], &["--set", "x=0.1", "--output", "out.csv"]].concat();
    let (code, out, errors) = gapi(&here, &refused);
    assert_eq!((code, &*out), (1, ""), "{errors}");
    assert_eq!(fs::read_to_string(here.path().join("out.csv")).unwrap(), written);
}

#[test]
fn simulations_tell_their_cost_and_draw() {
    let here = folder(&[("Decay.mo", DECAY)]);
    let arguments = ["simulate", "Decay.mo", "--model", "Decay", "--stats", "--plot", "x"];
    let (code, out, said) = gapi(&here, &arguments);
    assert_eq!((code, &*said), (0, ""));
    assert!(out.contains("accepted steps") && out.contains("factorizations"), "{out}");
    assert!(out.contains("   1.0000e0 │") && out.contains("1 s"), "{out}");
    let (code, out, _) = gapi(&here, &[&arguments[..], &["--figure", "x.svg"]].concat());
    assert_eq!(code, 0);
    assert!(out.contains("figure: x.svg"), "{out}");
    let svg = fs::read_to_string(here.path().join("x.svg")).unwrap();
    assert!(svg.starts_with("<svg") || svg.contains("<svg"), "{svg}");
    for (name, magic) in [("x.png", &b"\x89PNG\r\n"[..]), ("x.pdf", b"%PDF-")] {
        let (code, _, errors) = gapi(&here, &[&arguments[..], &["--figure", name]].concat());
        assert_eq!(code, 0, "{errors}");
        assert!(fs::read(here.path().join(name)).unwrap().starts_with(magic), "{name}");
    }
    let (code, out, errors) = gapi(&here, &[&arguments[..], &["--figure", "x.jpg"]].concat());
    assert!(code != 0 && errors.contains("`.svg`, `.png` or `.pdf`"), "{errors}");
    assert_eq!(out, "", "refused before anything is simulated");
    assert!(!here.path().join("x.jpg").exists());
    let wrong = ["simulate", "Decay.mo", "--model", "Decay", "--plot", "y"];
    let (code, _, said) = gapi(&here, &wrong);
    assert!(code == 1 && said.contains("[unknown-result-variable]"), "{said}");
}

#[test]
fn a_result_file_that_is_written_again_is_read_again() {
    let sweep = "openModel(\"Decay.mo\", changeDirectory=false)\nfor k in 1:40 loop\n  \
        simulateModel(\"Decay(rate=\" + String(k) + \")\", stopTime=1, numberOfIntervals=2, resultFile=\"decay\");\n  \
        r = readTrajectory(\"decay.mat\", {\"der(x)\"}, 3);\n  \
        print(String(k) + \" \" + String(r[1,1]));\nend for;\n";
    let here = folder(&[("Decay.mo", DECAY), ("sweep.mos", sweep)]);
    let (code, out, errors) = gapi(&here, &["run", "sweep.mos"]);
    assert_eq!(code, 0, "{errors}");
    let expected: String = (1..=40).map(|k| format!("{k} -{k}\n")).collect();
    assert_eq!(out, expected);
}

/// Two problems of the same data: the table, and the same as a file beside their folders.
#[test]
fn a_comparison_of_models_is_written() {
    let problem = "model = \"Decay\"\nfiles = [\"Decay.mo\"]\n[parameters]\nrate = { min = 0.1, max = 5 }\n\
                   [[experiment]]\ndata = \"d.csv\"\noutputs = { x = { column = \"x\", sigma = 0.02 } }\n";
    let data = "time,x\n0,1.01\n0.2,0.83\n0.4,0.66\n0.6,0.56\n0.8,0.44\n1,0.38\n";
    let other = problem.replace("max = 5", "max = 4");
    let files = [("Decay.mo", DECAY), ("d.csv", data), ("a.toml", problem), ("b.toml", &other)];
    let here = folder(&files);
    let (code, out, errors) = gapi(&here, &["identify", "a.toml", "a.toml"]);
    assert_eq!(code, 2, "{out}{errors}");
    let (code, out, errors) = gapi(&here, &["identify", "a.toml", "b.toml", "--out", "o"]);
    assert_eq!(code, 0, "{out}{errors}");
    let written = fs::read(here.path().join("o/comparison-a-b.json")).unwrap();
    let found: serde_json::Value = serde_json::from_slice(&written).unwrap();
    for (k, name) in ["a", "b"].iter().enumerate() {
        assert_eq!(found["models"][k]["name"], *name);
        // The same model twice: neither weighs more.
        assert!((found["models"][k]["weight"].as_f64().unwrap() - 0.5).abs() < 1e-6, "{found}");
    }
    assert!(out.contains("comparison-a-b.json"), "{out}");
    assert_eq!(found["sentence"].as_str().map(|s| out.contains(s)), Some(true), "{out}");
}

#[test]
fn libraries_beside_a_library_are_found() {
    let here = folder(&[]);
    for (name, text) in [
        ("A", "package A model M Real x = B.k; end M; end A;"),
        ("B", "package B constant Real k = 7; end B;"),
    ] {
        fs::create_dir_all(here.path().join("libs").join(name)).unwrap();
        fs::write(here.path().join("libs").join(name).join("package.mo"), text).unwrap();
    }
    let (code, out, errors) = gapi(&here, &["simulate", "libs/A", "--model", "A.M"]);
    assert_eq!((code, errors.as_str()), (0, ""), "{out}");
    assert!(out.contains("x = 7"), "{out}");
    let by_option = ["simulate", "--model", "A.M", "--library", "libs/A"];
    let (code, out, errors) = gapi(&here, &by_option);
    assert!(code == 0 && out.contains("x = 7"), "{out}{errors}");
}

/// The folder of an archive is called otherwise than the package, which does not matter where the
/// folder itself is named.
#[test]
fn a_package_whose_folder_is_named_is_found_whatever_it_is_called() {
    let here = folder(&[]);
    for (name, text) in [
        ("Pumps 1.2.0", "package Pumps model M Real x = 7; end M; end Pumps;"),
        ("valves-main", "package Valves model M extends Pumps.M(x = 8); end M; end Valves;"),
    ] {
        fs::create_dir_all(here.path().join("libs").join(name)).unwrap();
        fs::write(here.path().join("libs").join(name).join("package.mo"), text).unwrap();
    }
    let libraries = ["--library", "libs/Pumps 1.2.0", "--library", "libs/valves-main"];
    for (model, value) in [("Pumps.M", "x = 7"), ("Valves.M", "x = 8")] {
        let arguments = [&["simulate", "--model", model], &libraries[..]].concat();
        let (code, out, errors) = gapi(&here, &arguments);
        assert!(code == 0 && out.contains(value), "{out}{errors}");
    }
}

/// The library that the references are about and the one that it uses, by `MODELICAPATH` alone.
#[test]
fn verify_finds_the_libraries_of_the_references() {
    let here = folder(&[]);
    for (name, text) in [
        (
            "A",
            "package A model M Real x = B.k; end M; annotation(uses(B(version = \"1\"))); end A;",
        ),
        ("B", "package B constant Real k = 7; end B;"),
    ] {
        fs::create_dir_all(here.path().join("libs").join(name)).unwrap();
        fs::write(here.path().join("libs").join(name).join("package.mo"), text).unwrap();
    }
    fs::create_dir_all(here.path().join("references/A/M")).unwrap();
    let good = "time,x\n0,7\n1,7\n";
    fs::write(here.path().join("references/A/M/M.csv"), good).unwrap();
    let verify = || {
        let mut command = command(here.path(), &["verify", "--references", "references"]);
        let output = command.env("MODELICAPATH", here.path().join("libs")).output().unwrap();
        (output.status.code(), String::from_utf8_lossy(&output.stdout).into_owned())
    };
    let (code, out) = verify();
    assert!(code == Some(0) && out.contains("1 agreed"), "{out}");
    fs::write(here.path().join("references/A/M/M.csv"), good.replace('7', "8")).unwrap();
    assert_eq!(verify().0, Some(1));
}

#[test]
fn scripts_are_checked_without_being_run() {
    let here = folder(&[
        ("good.mos", "a := 1;\nprint(\"ran\");\n"),
        ("bad.mos", "a := (1 + ;\n"),
        ("unknown.mos", "simulateModle(\"M\");\n"),
        ("M.mo", "model M\n  Real x = time;\nend M;\n"),
    ]);
    let (code, out, err) = gapi(&here, &["check", "good.mos"]);
    assert_eq!((code, out.as_str(), err.as_str()), (0, "good.mos: 2 statements, no errors\n", ""));
    let (code, _, err) = gapi(&here, &["check", "bad.mos"]);
    assert_eq!(code, 1);
    assert!(err.contains("bad.mos:1:"), "{err}");
    let (code, _, err) = gapi(&here, &["check", "unknown.mos", "M.mo"]);
    assert_eq!(code, 1);
    assert!(err.contains("did you mean `simulateModel`?"), "{err}");
    let (code, out, _) = gapi(&here, &["check", "good.mos", "M.mo"]);
    assert_eq!(code, 0);
    assert!(out.contains("good.mos: 2 statements") && out.contains("1 model"), "{out}");
    let (code, _, err) = gapi(&here, &["check", "missing.mos"]);
    assert_eq!(code, 1);
    assert!(err.contains("missing.mos"), "{err}");
}

/// The report of a script that failed says so first, wherever it is read.
#[test]
fn a_script_that_fails_says_so_first() {
    let script = "(S, M, Xexp, Yexp) := Exp_Adq_SISO(\"d.csv\", \"t\", \"y\");\n\
                  P := {{0.5, 1}, {2, 3}};\n\
                  F := Fit(Eval(\"Line.mo\", \"Line\", Xexp, P, {\"a\", \"b\"}, \"x\", \"y\"), Yexp);\n\
                  RunScript(\"sub.mos\");\n";
    let here = folder(&[
        ("Line.mo", LINE),
        ("d.csv", "t,y\n0,1\n1,3.1\n2,4.9\n3,7\n"),
        ("sub.mos", "y = 1;\nx = zeros(2)[3];\n"),
        ("fit.mos", script),
    ]);
    let (code, out, _) = gapi(&here, &["run", "fit.mos"]);
    assert_eq!(code, 1, "{out}");
    assert!(out.contains("\n  stopped      error in sub.mos, line 2\n  model "), "{out}");
    assert!(out.contains("\n  The script failed with an error in sub.mos, line 2: "), "{out}");
    assert!(!out.contains("the script has ended"), "{out}");
    let read = |name: &str| fs::read_to_string(here.path().join("results/fit").join(name)).unwrap();
    let result: serde_json::Value = serde_json::from_str(&read("result.json")).unwrap();
    assert_eq!(result["stop"], "error in sub.mos, line 2");
    assert_eq!(result["script"]["error"]["line"], 2);
    let first = result["findings"][0]["sentence"].as_str().unwrap();
    assert!(first.starts_with("The script failed with an error in sub.mos, line 2: "), "{first}");
    let page = read("report.html");
    let error = page.find("The script failed with an error in sub.mos, line 2").expect("the error");
    assert!(error < page.find("class=\"facts\"").expect("facts"), "it comes first");
    // An error that the script has read is handled.
    let handled = format!("{script}getLastError();\n");
    fs::write(here.path().join("fit.mos"), handled).unwrap();
    let (code, out, _) = gapi(&here, &["run", "fit.mos"]);
    assert!(code == 0 && out.contains("stopped      the script has ended"), "{out}");
}

/// What a script prints is its own output; what the program says besides is not shown with `--quiet`.
#[test]
fn quiet_runs_show_what_scripts_print() {
    let here = folder(&[("a.mos", "print(\"mine\")\n1 + 1\nx = nowhere\n")]);
    let (code, out, errors) = gapi(&here, &["run", "a.mos", "--quiet"]);
    assert_eq!((code, out.as_str()), (1, "mine\n"));
    assert!(errors.contains("nowhere"), "{errors}");
    assert_eq!(gapi(&here, &["run", "a.mos"]).1, "mine\n = 2\n");
}

#[test]
fn journals_are_described() {
    let problem = "model = \"Line\"\nfiles = [\"Line.mo\"]\n[parameters]\na = { min = 0, max = 5 }\n\
                   b = { min = 0, max = 5 }\n[[experiment]]\ndata = \"d.csv\"\n\
                   x = { variable = \"x\", column = \"t\" }\noutputs = { y = \"y\" }\n\
                   [stop]\nevaluations = 200\n";
    let here = folder(&[
        ("Line.mo", LINE),
        ("d.csv", "t,y\n0,1\n1,3.1\n2,4.9\n3,7\n"),
        ("p.toml", problem),
        ("trace.mos", "Cross(1, 1, {{1, 2}, {3, 4}}, {1})\n"),
    ]);
    let (code, _, errors) =
        gapi(&here, &["identify", "p.toml", "--searches", "2", "--shard", "1/2", "--out", "s"]);
    assert_eq!(code, 0, "{errors}");
    let (code, out, _) = gapi(&here, &["journal", "s/shard.part"]);
    assert_eq!(code, 0, "{out}");
    assert!(out.starts_with("shard 1 of 2 of `p.toml`\ndepends on "), "{out}");
    assert!(out.contains(" generations: ") && out.contains("least objective: "), "{out}");
    assert_eq!(gapi(&here, &["run", "trace.mos", "--trace", "t"]).0, 0);
    let (code, out, _) = gapi(&here, &["journal", "t"]);
    assert!(code == 0 && out.contains("script: trace.mos\n1 generations"), "{out}");
    let whole = fs::read(here.path().join("t")).unwrap();
    fs::write(here.path().join("t"), &whole[..whole.len() - 1]).unwrap();
    let (code, _, errors) = gapi(&here, &["journal", "t"]);
    assert!(code == 1, "{errors}");
    let (code, _, errors) = gapi(&here, &["journal", "d.csv"]);
    assert!(code == 1 && errors.contains("is not a journal"), "{errors}");
}

/// A shell gives the names of files for `*`, and a name may look like an option.
#[test]
fn wrong_arguments_are_shown_as_text() {
    let here = folder(&[]);
    let (code, _, errors) = gapi(&here, &["check", "--\u{1b}]0;title\u{7}\u{202e}"]);
    assert_eq!(code, 2, "{errors}");
    assert!(errors.contains("unexpected argument"), "{errors}");
    assert!(!errors.contains(['\u{1b}', '\u{7}', '\u{202e}']), "{errors:?}");
}
