//! Units of our own as a user meets them: written by the program and by scripts, and simulated and fitted as
//! those of others are.

use super::fmus::{column, columns, near, platform, simulated};
use crate::support::program::{command, folder, gapi};
use gapilib::internals::fmi::parameter_set::{Parameter, ParameterValue};
use gapilib::internals::fmi::{Archive, ParameterSet, description};
use std::fs;
use std::path::PathBuf;
use tempfile::TempDir;

/// The runtime of exported units, as the build has left it.
fn runtime() -> PathBuf {
    let here = std::env::current_exe().expect("this program");
    let (prefix, suffix) = (std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX);
    here.with_file_name(format!("{prefix}gapilib_fmu{suffix}"))
}

/// What a run left, with the runtime of exported units.
fn exporting(here: &TempDir, arguments: &[&str]) -> (i32, String, String) {
    let mut child = command(here.path(), arguments);
    let output = child.env("GAPILIB_FMU_RUNTIME", runtime()).output().expect("it ends");
    let text = |bytes| String::from_utf8(bytes).expect("text");
    (output.status.code().unwrap_or(-1), text(output.stdout), text(output.stderr))
}

const DECAY: &str = "package P model Decay parameter Real k(unit = \"1/s\") = 1; \
                     parameter Real level = 3; output Real y = level*x; \
                     Real x(start = 1, fixed = true); equation der(x) = -k*x; \
                     annotation(experiment(StopTime = 1, Tolerance = 1e-9)); end Decay; end P;\n";

/// The library of another version computes other things with the same bytes.
#[test]
fn a_unit_is_not_written_with_the_library_of_another_version() {
    let here = folder(&[("P.mo", DECAY), ("old.so", "of another version")]);
    let mut child =
        command(here.path(), &["export-fmu", "P.mo", "--model", "P.Decay", "-o", "unit.fmu"]);
    let output = child.env("GAPILIB_FMU_RUNTIME", here.path().join("old.so")).output();
    let output = output.expect("it ends");
    let errors = String::from_utf8(output.stderr).expect("text");
    assert!(errors.contains("the runtime of units is not of this program"), "{errors}");
    assert!(!here.path().join("unit.fmu").exists());
}

/// Scripts of both dialects write units with the values that they have set, and simulate them.
#[test]
fn scripts_write_and_simulate_units() {
    if platform(3).is_none() {
        return;
    }
    let dymola = "openModel(\"P.mo\")\ntranslateModel(\"P.Decay\")\nk = 2\n\
                  name = translateModelFMU(\"P.Decay\", fmiVersion=\"3\")\n\
                  importFMU(name + \".fmu\")\n\
                  simulateModel(\"P_Decay_fmu(level = 5)\", stopTime=0.5, resultFile=\"a\")\n\
                  y = readTrajectory(\"a.mat\", {\"y\"}, readTrajectorySize(\"a.mat\"))\n\
                  print(String(y[1, end], significantDigits=9))\n\
                  (ok, z) = simulateExtendedModel(\"P_Decay_fmu\", stopTime=1, \
                  initialNames={\"k\", \"x\"}, initialValues={1, 2}, finalNames={\"y\"})\n\
                  print(String(z[1], significantDigits=9))\n\
                  importFMU(name + \".fmu\", integrate=false, packageName=\"Own\")\n\
                  simulateModel(\"Own.P_Decay_fmu\", stopTime=1, resultFile=\"b\")\n\
                  translateModelFMU(\"P.Decay\", modelName=\"Own\")\n\
                  importFMU(\"Own.fmu\")\n\
                  simulateModel(\"Own_fmu(k = 3)\", stopTime=1, resultFile=\"c\")\n\
                  y = readTrajectory(\"c.mat\", {\"y\"}, readTrajectorySize(\"c.mat\"))\n\
                  print(String(y[1, end], significantDigits=9))\n\
                  linearizeModel(\"P_Decay_fmu\")\n\
                  simulateModel(\"P_Decay_fmu(kk = 1)\")\n";
    let here = folder(&[("P.mo", DECAY), ("s.mos", dymola)]);
    let run = ["run", "s.mos", "--allow-external", "--out", "out"];
    let (_, out, errors) = exporting(&here, &run);
    let text = format!("{out}{errors}");
    near(number_after(&text, 0), 15.0 * (-1.0f64).exp() / 3.0, 1e-6);
    near(number_after(&text, 1), 6.0 * (-1.0f64).exp(), 1e-6);
    near(number_after(&text, 2), 3.0 * (-3.0f64).exp(), 1e-5);
    assert!(text.contains("is an FMU, which is not linearized here"), "{text}");
    assert!(text.contains("has no variable `kk`"), "{text}");

    let openmodelica = "loadFile(\"P.mo\");\nfile := buildModelFMU(P.Decay, version=\"2.0\", \
                        fmuType=\"me_cs\", fileNamePrefix=\"unit\");\n\
                        name := importFMU(\"unit.fmu\");\nprint(name + \"\\n\");\n\
                        loadFile(name);\ngetErrorString();\n\
                        simulate(P_Decay_me_FMU, stopTime=1, simflags=\"-override=k=2,x=4\");\n\
                        print(String(val(y, 1.0)) + \"\\n\");\n";
    fs::write(here.path().join("o.mos"), openmodelica).expect("written");
    let run = ["run", "o.mos", "--allow-external", "--out", "own"];
    let (_, out, errors) = exporting(&here, &run);
    let text = format!("{out}{errors}");
    assert!(text.contains("P_Decay_me_FMU.mo"), "{text}");
    near(number_after(&text, 0), 12.0 * (-2.0f64).exp(), 1e-5);
}

/// Assertions of a model hold in its unit, too: importers announce completed steps where it has any.
#[test]
fn assertions_between_events_hold_in_units() {
    let text = "model Limited Real x(start = 0, fixed = true); equation der(x) = 1; \
                assert(x < 0.5, \"x too large\"); end Limited;";
    let here = folder(&[("Limited.mo", text)]);
    for version in ["2", "3"] {
        let export = ["export-fmu", "Limited.mo", "--model", "Limited", "--fmi", version];
        let (code, out, errors) = exporting(&here, &[&export[..], &["-o", "unit.fmu"]].concat());
        assert_eq!(code, 0, "{out}{errors}");
        for method in ["dassl", "co-simulation"] {
            let unit = ["simulate", "unit.fmu", "--allow-external", "--method", method];
            let (code, _, errors) = gapi(&here, &unit);
            assert!(code == 1 && errors.contains("x too large"), "{method}: {errors}");
        }
    }
}

/// In co-simulation inputs are at their mean during a step, which is said; rows have their own values, and
/// outputs that follow from these.
#[test]
fn inputs_of_co_simulation_have_their_mean() {
    let text = "model Sum input Real u; output Real y = 2*u; Real x(start = 0, fixed = true); \
                equation der(x) = u; end Sum;";
    let here = folder(&[("Sum.mo", text), ("u.csv", "time,u\n0,0\n1,1\n2,0\n")]);
    let (code, out, errors) =
        exporting(&here, &["export-fmu", "Sum.mo", "--model", "Sum", "-o", "unit.fmu"]);
    assert_eq!(code, 0, "{out}{errors}");
    let unit = ["simulate", "unit.fmu", "--allow-external", "--input", "u.csv", "--method"];
    for (method, is_noted) in [("co-simulation", true), ("dassl", false)] {
        let (code, _, errors) =
            gapi(&here, &[&unit[..], &[method, "--output", "o.csv", "--stop-time", "2"]].concat());
        assert_eq!(code, 0, "{errors}");
        let all = columns(&here.path().join("o.csv"));
        for (t, u) in column(&all, "time").iter().zip(column(&all, "u")) {
            near(*u, 1.0 - (t - 1.0).abs(), 1e-9);
        }
        let mut rows = column(&all, "time").windows(2);
        assert_eq!(rows.all(|pair| pair[1] > pair[0]), is_noted, "a bend is no event of steps");
        for (row, t) in column(&all, "time").iter().enumerate() {
            let x = if *t < 1.0 { t * t / 2.0 } else { 1.0 - (2.0 - t).powi(2) / 2.0 };
            near(column(&all, "x")[row], x, 1e-6);
            near(column(&all, "y")[row], 2.0 * column(&all, "u")[row], 1e-9);
        }
        let note = "during a step the inputs `u` are constant, at their mean";
        let errors = errors.split_whitespace().collect::<Vec<_>>().join(" ");
        assert_eq!(errors.contains(note), is_noted, "{errors}");
    }
}

const MODES: &str = "model Heater type Mode = enumeration(off \"no heat\", on); input Mode mode; \
                     parameter Integer n = 2; parameter Real c = 1 annotation(Evaluate = true); \
                     final parameter Integer m = 3; Real x[n](each start = 0, each fixed = true); \
                     Real z[m]; output Boolean hot = mode == Mode.on; equation z = fill(c, m); \
                     der(x) = fill(if mode == Mode.on then 1 else 0, n); \
                     annotation(experiment(Tolerance = 1e-5)); end Heater;";

/// Columns with literals of an enumeration are inputs of models and of units.
#[test]
fn columns_of_literals_are_inputs() {
    let here = folder(&[
        ("Heater.mo", MODES),
        ("m.csv", "time,mode\n0,off\n1,Mode.on\n2,2\n3,Heater.Mode.off\n4,1\n"),
        ("on.csv", "time,mode\n0,off\n1,on\n3,off\n4,off\n"),
        ("w.csv", "time,mode\n0,off\n1,slow\n"),
        ("n.csv", "time,mode\n0,1\n1,3\n"),
    ]);
    let export = ["export-fmu", "Heater.mo", "--model", "Heater", "-o", "unit.fmu"];
    let (code, out, errors) = exporting(&here, &export);
    assert_eq!(code, 0, "{out}{errors}");
    for source in [&["Heater.mo", "--model", "Heater"][..], &["unit.fmu", "--allow-external"]] {
        let simulate = |input: &str| {
            let more = ["--input", input, "--stop-time", "4", "--output", "o.csv"];
            gapi(&here, &[&["simulate"], source, &more].concat())
        };
        for input in ["m.csv", "on.csv"] {
            let (code, out, errors) = simulate(input);
            assert!(code == 0 && !errors.contains("warning"), "{out}{errors}");
            let all = columns(&here.path().join("o.csv"));
            near(*column(&all, "x[1]").last().expect("a row"), 2.0, 1e-6);
        }
        for (input, said) in [
            ("w.csv", "line 3: `slow` in `mode` is not one of its values"),
            ("n.csv", "line 3: the input `mode` cannot be 3"),
        ] {
            let (code, _, errors) = simulate(input);
            assert!(code == 1 && errors.contains(said), "{errors}");
            let names = input == "w.csv" || errors.contains("its values are off (1), on (2)");
            assert!(names, "{errors}");
        }
    }
}

/// What an importer cannot set any more is noted; literals keep their descriptions.
#[test]
fn an_export_says_what_is_constant() {
    let here = folder(&[("Heater.mo", MODES)]);
    for version in ["2", "3"] {
        let export = ["export-fmu", "Heater.mo", "--model", "Heater", "--fmi", version];
        let (code, out, errors) = exporting(&here, &[&export[..], &["-o", "unit.fmu"]].concat());
        let text = errors.split_whitespace().collect::<Vec<_>>().join(" ");
        assert_eq!(code, 0, "{out}{errors}");
        assert!(text.contains("constant in the unit are `n`, `c`: they are structural"), "{text}");
        let unit = fs::File::open(here.path().join("unit.fmu")).expect("a unit");
        let archive = Archive::read(unit).expect("readable");
        let text = archive.file("modelDescription.xml").expect("a description");
        let description = description::read(text).expect("valid");
        assert_eq!(description.experiment.tolerance, Some(1e-5));
        let items = &description.types[0].items;
        assert_eq!(items[0].description.as_deref(), Some("no heat"));
        assert_eq!(items[1].description, None);
    }
}

/// What a unit is not made for is refused as it is for a model.
#[test]
fn values_outside_the_range_of_a_unit_are_refused() {
    let text = "model Tank type Level = enumeration(low, high); \
                parameter Real A(min = 0.01) = 1; parameter Level at = Level.low; \
                Real x(start = 1, fixed = true); Real y; equation der(x) = -A*x; \
                y = if at == Level.low then 1 else 2; end Tank;";
    let here = folder(&[("Tank.mo", text)]);
    let export = ["export-fmu", "Tank.mo", "--model", "Tank", "-o", "unit.fmu"];
    let (code, out, errors) = exporting(&here, &export);
    assert_eq!(code, 0, "{out}{errors}");
    let unit = ["simulate", "unit.fmu", "--allow-external", "--set"];
    for (value, expected) in [
        ("A=-1", "`A` of `unit.fmu` is -1, less than 0.01, outside the range"),
        ("at=7", "`at` of `unit.fmu` cannot be 7"),
    ] {
        let (code, _, errors) = gapi(&here, &[&unit[..], &[value]].concat());
        assert!(code == 1 && errors.contains(expected), "{errors}");
    }
    let model = ["simulate", "Tank.mo", "--model", "Tank", "--set", "at=7"];
    let (code, _, errors) = gapi(&here, &model);
    assert!(code == 1 && errors.contains("`at` cannot be 7"), "{errors}");
    assert!(errors.contains("its values are low (1), high (2)"), "{errors}");
    for value in ["A=0.01", "at=high"] {
        let (code, _, errors) = gapi(&here, &[&unit[..], &[value]].concat());
        assert_eq!(code, 0, "{errors}");
    }
}

/// The number that stands alone in a line, the one of this number.
fn number_after(text: &str, which: usize) -> f64 {
    let mut numbers = text.lines().filter_map(|line| line.trim().parse::<f64>().ok());
    numbers.nth(which).unwrap_or_else(|| panic!("no number in {text}"))
}

/// The estimates of a fit go into a unit and into a second fit by the file that the first has left.
#[test]
fn the_estimates_of_a_fit_are_given_away() {
    if platform(3).is_none() {
        return;
    }
    let row = |t: f64| format!("{t},{}\n", 4.0 * (-2.0 * t).exp() + 1e-3 * (37.0 * t).sin());
    let data: String = (0..=20).map(|n| row(f64::from(n) / 20.0)).collect();
    let problem = "model = \"P.Decay\"\nfiles = [\"P.mo\"]\n[parameters]\n\
                   k = { min = 0.1, max = 10 }\nlevel = { min = 0.1, max = 10 }\n\
                   [[experiment]]\ndata = \"d.csv\"\noutputs = { y = \"y\" }\n";
    let data = format!("time,y\n{data}");
    let here = folder(&[("P.mo", DECAY), ("p.toml", problem), ("d.csv", &data)]);
    let (code, out, errors) = gapi(&here, &["identify", "p.toml", "--out", "o"]);
    assert_eq!(code, 0, "{out}{errors}");
    let set = fs::read_to_string(here.path().join("o/parameters.ssv")).expect("estimates");
    let read = ParameterSet::read(&set).expect("a set");
    let [k, level] = &read.parameters[..] else { panic!("{set}") };
    assert_eq!((k.name.as_str(), k.unit.as_deref()), ("k", Some("1/s")));
    let interval = k.estimate.and_then(|own| own.interval).expect("an interval");
    assert!(interval[0] < 2.0 && 2.0 < interval[1], "{interval:?}");
    let base = ["export-fmu", "P.mo", "--model", "P.Decay", "--set-file", "o/parameters.ssv"];
    let (code, out, errors) = exporting(&here, &[&base[..], &["-o", "unit.fmu"]].concat());
    assert_eq!(code, 0, "{out}{errors}");
    assert_eq!(fs::read_to_string(here.path().join("unit.ssv")).expect("a copy"), set);
    let all = simulated(&here, &["--tolerance", "1e-9"]);
    let number = |own: &Parameter| match own.value {
        ParameterValue::Number(value) => value,
        _ => f64::NAN,
    };
    let (k, level) = (number(k), number(level));
    let last = |all: &[(String, Vec<f64>)]| *column(all, "y").last().expect("a row");
    near(last(&all), level * (-k).exp(), 1e-6);
    let set_file = ["--set-file", "o/parameters.ssv"];
    let model = ["simulate", "P.mo", "--model", "P.Decay", "--output", "m.csv"];
    let (code, out, errors) = gapi(&here, &[&model[..], &set_file].concat());
    assert_eq!(code, 0, "{out}{errors}");
    near(last(&columns(&here.path().join("m.csv"))), level * (-k).exp(), 1e-6);

    // A second fit of another parameter with the values of the first.
    for model in ["P.Decay\"\nfiles = [\"P.mo\"]", "unit.fmu\""] {
        let second = format!(
            "model = \"{model}\n[parameters]\nx = {{ min = 0.1, max = 10, initial = true }}\n\
             [[experiment]]\ndata = \"d.csv\"\nset = \"o/parameters.ssv\"\n\
             outputs = {{ y = \"y\" }}\n"
        );
        fs::write(here.path().join("q.toml"), &second).expect("written");
        let identify = ["identify", "q.toml", "--allow-external", "--out", "q"];
        let (code, out, errors) = gapi(&here, &identify);
        assert_eq!(code, 0, "{out}{errors}");
        let text = fs::read_to_string(here.path().join("q/result.json")).expect("a result");
        let result: serde_json::Value = serde_json::from_str(&text).expect("JSON");
        near(result["parameters"][0]["value"].as_f64().expect("a number"), 1.0, 1e-3);
    }
    // The same values in another unit.
    let per_hour = ParameterSet {
        name: "hours".to_owned(),
        parameters: vec![Parameter {
            name: "k".to_owned(),
            value: ParameterValue::Number(3600.0 * k),
            unit: Some("1/h".to_owned()),
            estimate: None,
        }],
        ..ParameterSet::default()
    };
    fs::write(here.path().join("hours.ssv"), per_hour.to_xml()).expect("written");
    let second = |model: &str| {
        format!(
            "model = \"{model}\"\nfiles = [\"P.mo\"]\n[parameters]\nlevel = {{ min = 0.1, max = 10 }}\n\
             [[experiment]]\ndata = \"d.csv\"\nset = \"hours.ssv\"\noutputs = {{ y = \"y\" }}\n"
        )
    };
    for model in ["P.Decay", "unit.fmu"] {
        fs::write(here.path().join("h.toml"), second(model)).expect("written");
        let identify = ["identify", "h.toml", "--allow-external", "--out", "h"];
        let (code, out, errors) = gapi(&here, &identify);
        assert_eq!(code, 0, "{out}{errors}");
        let sentence =
            "`k` in `hours.ssv` is converted from 1/h to 1/s, times 0.000277777777777778";
        let text = fs::read_to_string(here.path().join("h/result.json")).expect("a result");
        assert!(text.contains(sentence), "{text}");
        let result: serde_json::Value = serde_json::from_str(&text).expect("JSON");
        near(result["parameters"][0]["value"].as_f64().expect("a number"), level, 1e-4);
    }
    for model in [&["simulate", "P.mo", "--model", "P.Decay"][..], &["simulate", "unit.fmu"]] {
        let rest = ["--output", "m.csv", "--allow-external", "--set-file", "hours.ssv"];
        let (code, out, errors) = gapi(&here, &[model, &rest].concat());
        assert_eq!(code, 0, "{out}{errors}");
        assert!(errors.contains("is converted from 1/h to 1/s"), "{out}{errors}");
    }
    let wrong = set.replace("unit=\"1/s\"", "unit=\"K\"");
    fs::write(here.path().join("o/parameters.ssv"), wrong).expect("written");
    let (code, out, errors) =
        gapi(&here, &["identify", "q.toml", "--allow-external", "--out", "r"]);
    let said = "`k` in `o/parameters.ssv` is in K, which cannot be converted to 1/s";
    assert!(code == 1 && errors.contains(said), "{out}{errors}");
    let (code, out, errors) = gapi(&here, &[&model[..], &set_file].concat());
    assert!(code == 1 && errors.contains(said), "{out}{errors}");
}

/// Compares the estimates of two fits, and their standard errors.
fn agree(unit: &serde_json::Value, own: &serde_json::Value) {
    for at in 0..2 {
        for what in ["value", "deviation"] {
            let of = |result: &serde_json::Value| {
                let found = result["parameters"][at][what].as_f64();
                found.unwrap_or_else(|| panic!("{what}: {result}"))
            };
            near(of(unit), of(own), 1e-5 * of(own).abs());
        }
    }
}

/// Derivatives by parameters and initial values are those that a unit of FMI 3.0 offers; they lead to the
/// estimates and standard errors of the model. FMI 2.0 has none, and after an event nobody knows them.
#[test]
fn derivatives_of_a_unit_are_exact_where_it_offers_them() {
    if platform(3).is_none() {
        return;
    }
    let jumping = DECAY.replace("end Decay;", "end Decay; model Jump extends Decay; equation \
                                 when sample(0.5, 10) then reinit(x, 0.5*pre(x)); end when; end Jump; \
                                 model Begun parameter Real x0 = 1; extends Decay(x(start = 2*x0)); \
                                 end Begun;");
    let row = |t: f64| format!("{t},{}\n", 4.0 * (-2.0 * t).exp() + 1e-2 * (37.0 * t).sin());
    let data: String = (0..=20).map(|n| row(f64::from(n) / 20.0)).collect();
    let here = folder(&[("P.mo", &jumping), ("d.csv", &format!("time,y\n{data}"))]);
    let fitting = |model: &str, second: &str| {
        let problem = format!(
            "model = \"{model}\"\nfiles = [\"P.mo\"]\n[parameters]\n\
             k = {{ min = 0.1, max = 10 }}\n{second} }}\n\
             [[experiment]]\ndata = \"d.csv\"\ntolerance = 1e-9\noutputs = {{ y = \"y\" }}\n"
        );
        fs::write(here.path().join("p.toml"), problem).expect("written");
        let identify = ["identify", "p.toml", "--allow-external", "--out", "o", "--overwrite"];
        let (code, out, errors) = gapi(&here, &identify);
        assert_eq!(code, 0, "{out}{errors}");
        let text = fs::read_to_string(here.path().join("o/result.json")).expect("a result");
        serde_json::from_str::<serde_json::Value>(&text).expect("JSON")
    };
    let fitted = |model| fitting(model, "x = { min = 0.1, max = 10, initial = true");
    let begun = |model| fitting(model, "x0 = { min = 0.1, max = 10");
    let export = |model: &str, version: &str| {
        let base = ["export-fmu", "P.mo", "--model", model, "--kind", "me", "-o", "unit.fmu"];
        let (code, out, errors) = exporting(&here, &[&base[..], &["--fmi", version]].concat());
        assert_eq!(code, 0, "{out}{errors}");
    };
    let says = |result: &serde_json::Value, words: &str| result.to_string().contains(words);
    let own = fitted("P.Decay");
    export("P.Decay", "3");
    let unit = fitted("unit.fmu");
    assert!(says(&unit, "exact, by sensitivity equations"), "{unit}");
    agree(&unit, &own);
    // Initial values that follow from a parameter.
    export("P.Begun", "3");
    let unit = begun("unit.fmu");
    assert!(says(&unit, "exact, by sensitivity equations"), "{unit}");
    agree(&unit, &begun("P.Begun"));
    export("P.Decay", "2");
    assert!(says(&fitted("unit.fmu"), "because FMUs of FMI 2.0 have no derivatives by parameters"));
    export("P.Jump", "3");
    assert!(says(&fitted("unit.fmu"), "because the FMU has"));
}

const MIXED: &str = "package P type Level = enumeration(low, mid, high); model Mixed \
                     parameter Real T0 = 3; parameter String label = \"two words\" \"a name\"; \
                     parameter String whole = label + \"!\"; input Level lv(start = Level.high); \
                     input Real u[2](each start = T0); input Integer n(start = 2*3); \
                     input Boolean on(start = not false); discrete Integer k(start = 4, fixed = true); \
                     Real x[2](start = {1, 2}, each fixed = true); output Real y; equation \
                     der(x) = -x; y = if on then u[1] + n else 0; when x[1] < 0.9*x[2] then k = pre(k) + n; end when; \
                     end Mixed; end P;\n";

/// Strings are constants; the start values of inputs, whatever expressions they are, and of arrays and
/// discrete variables are those of the model. Nothing is in the results that the model does not have.
#[test]
fn strings_and_start_values_are_those_of_the_model() {
    let here = folder(&[("P.mo", MIXED)]);
    for version in ["2", "3"] {
        let base = ["export-fmu", "P.mo", "--model", "P.Mixed", "--fmi", version, "-o", "unit.fmu"];
        let (code, out, errors) = exporting(&here, &[&base[..], &["--set", "T0=5"]].concat());
        assert_eq!(code, 0, "{out}{errors}");
        assert!(errors.contains("the unit has no `whole`"), "{errors}");
        let bytes = fs::read(here.path().join("unit.fmu")).expect("a unit");
        let archive = Archive::read(std::io::Cursor::new(bytes)).expect("an archive");
        let text = archive.file("modelDescription.xml").expect("a description");
        let description = description::read(text).expect("a description");
        let start = |name: &str| {
            let own = description.find(name).unwrap_or_else(|| panic!("no `{name}`"));
            own.start.join(" ")
        };
        let names = ["label", "lv", "u[2]", "n", "on", "k", "x[2]"];
        assert_eq!(names.map(start), ["two words", "3", "5.0", "6", "true", "4", "2.0"]);
        let all = simulated(&here, &["--set", "x[1]=5", "--set", "k=1"]);
        let last = |name: &str| *column(&all, name).last().expect("a row");
        near(last("x[1]"), 5.0 * (-1.0f64).exp(), 1e-6);
        near(last("x[2]"), 2.0 * (-1.0f64).exp(), 1e-6);
        assert_eq!((last("y"), last("k")), (11.0, 1.0));
        let inner = all.iter().map(|(name, _)| name.as_str());
        let inner = inner.filter(|name| name.contains("der(u") || name.contains("indicator"));
        assert_eq!(inner.collect::<Vec<_>>(), Vec::<&str>::new());
    }
}

/// What was computed until a simulation failed is shown, written, and named in the message.
#[test]
fn results_until_a_failure_are_kept() {
    let text = "model Limited Real x(start = 0, fixed = true); equation der(x) = 1; \
                assert(x < 0.5, \"x too large\"); end Limited;";
    let script =
        "importFMU(\"unit.fmu\")\nsimulateModel(\"Limited_fmu\", stopTime=1, resultFile=\"a\")\n";
    let here = folder(&[("Limited.mo", text), ("s.mos", script)]);
    let export = ["export-fmu", "Limited.mo", "--model", "Limited", "-o", "unit.fmu"];
    let (code, out, errors) = exporting(&here, &export);
    assert_eq!(code, 0, "{out}{errors}");
    for method in ["dassl", "co-simulation"] {
        let unit = ["simulate", "unit.fmu", "--allow-external", "--output", "r.csv", "--stats"];
        let (code, out, errors) = gapi(&here, &[&unit[..], &["--method", method]].concat());
        assert!(code == 1 && errors.contains("x too large"), "{method}: {out}{errors}");
        assert!(out.contains("unit.fmu: 0 s to 0."), "{method}: {out}");
        let all = columns(&here.path().join("r.csv"));
        let (time, x) = (column(&all, "time"), column(&all, "x"));
        assert!(time.len() > 100 && x.last() > Some(&0.49), "{} rows", time.len());
        time.iter().zip(x).for_each(|(t, x)| near(*x, *t, 1e-6));
    }
    let (_, out, errors) = gapi(&here, &["run", "s.mos", "--allow-external", "--out", "o"]);
    let text = format!("{out}{errors}");
    assert!(text.contains("the results until t = 0.") && text.contains("are in `a.mat`"), "{text}");
}

/// A limit of time ends a simulation of a unit as it ends one of a model: what was computed is kept.
#[test]
fn a_limit_of_time_keeps_what_was_computed() {
    let text = "model Long Real x(start = 1, fixed = true); Real v(start = 0, fixed = true); equation \
                der(x) = v; der(v) = -1e6*x; annotation(experiment(StopTime = 1e5)); end Long;";
    let here = folder(&[("Long.mo", text)]);
    let export = ["export-fmu", "Long.mo", "--model", "Long", "-o", "unit.fmu"];
    let (code, out, errors) = exporting(&here, &export);
    assert_eq!(code, 0, "{out}{errors}");
    let limits = ["--time-limit", "2", "--intervals", "1000000"];
    for method in ["dassl", "co-simulation"] {
        let unit = ["simulate", "unit.fmu", "--allow-external", "--output", "r.csv"];
        let (code, out, errors) =
            gapi(&here, &[&unit[..], &limits, &["--method", method]].concat());
        let said = errors.contains("time limit") && out.contains("trajectories: r.csv");
        assert!(code != 0 && said, "{method}: {code} {out}{errors}");
        let all = columns(&here.path().join("r.csv"));
        let (time, x) = (column(&all, "time"), column(&all, "x"));
        assert_eq!((time[0], x[0], x.len()), (0.0, 1.0, time.len()));
        fs::remove_file(here.path().join("r.csv")).expect("results");
    }
}

/// A problem file is drafted for a unit, and runs.
#[test]
fn fits_of_units_are_drafted() {
    let row = |t: f64| format!("{t},{}\n", 4.0 * (-2.0 * t).exp() + 1e-3 * (37.0 * t).sin());
    let data: String = (0..=20).map(|n| row(f64::from(n) / 20.0)).collect();
    let here = folder(&[("P.mo", DECAY), ("d.csv", &format!("time [s],y\n{data}"))]);
    let base = ["export-fmu", "P.mo", "--model", "P.Decay", "-o", "unit.fmu"];
    let (code, out, errors) = exporting(&here, &base);
    assert_eq!(code, 0, "{out}{errors}");
    let (code, out, errors) = gapi(&here, &["new", "d.csv", "--model", "unit.fmu"]);
    assert_eq!(code, 0, "{out}{errors}");
    let text = fs::read_to_string(here.path().join("d.toml")).expect("a draft");
    for line in [
        "model = \"unit.fmu\"          # the FMU",
        "k = { min = 0.1, max = 10.0 }          # 1/s; one decade around the model's value 1",
        "outputs.y = { column = \"y\" }",
    ] {
        assert!(text.contains(line), "{line}: {text}");
    }
    let identify = ["identify", "d.toml", "--allow-external", "--out", "o"];
    let (code, out, errors) = gapi(&here, &identify);
    assert_eq!(code, 0, "{out}{errors}");
}

/// Where a text is expected a unit is refused with what takes it.
#[test]
fn units_are_not_read_as_texts() {
    let here = folder(&[("x.fmu", "PK"), ("s.mos", "openModel(\"x.fmu\")\n")]);
    for arguments in [
        &["run", "x.fmu"][..],
        &["run", "s.mos"],
        &["flatten", "x.fmu"],
        &["export-fmu", "x.fmu"],
        &["simulate", "x.fmu", "s.mo"],
        &["identify", "x.fmu"],
    ] {
        let (code, out, errors) = gapi(&here, arguments);
        let text = format!("{out}{errors}");
        assert!(text.contains("`x.fmu` is an FMU, not a"), "{arguments:?}: {text}");
        assert!(text.contains("gapi simulate x.fmu") && !text.contains("UTF-8"), "{text}");
        assert!(code == 1 || arguments.contains(&"s.mos"), "{arguments:?}: {code}");
    }
}

/// A description that says other start values than the binary has: the results are those of the binary, and
/// the difference is said.
#[test]
fn parameters_in_results_are_those_that_the_unit_computes_with() {
    let here = folder(&[("P.mo", DECAY)]);
    let base = ["export-fmu", "P.mo", "--model", "P.Decay", "-o", "unit.fmu"];
    let (code, out, errors) = exporting(&here, &base);
    assert_eq!(code, 0, "{out}{errors}");
    let path = here.path().join("unit.fmu");
    let bytes = fs::read(&path).expect("a unit");
    let mut archive = Archive::read(std::io::Cursor::new(bytes)).expect("an archive");
    let text = archive.file("modelDescription.xml").expect("a description").to_vec();
    let text = String::from_utf8(text).expect("text").replace("start=\"3.0\"", "start=\"5.0\"");
    archive.insert("modelDescription.xml", text);
    fs::write(&path, archive.to_bytes().expect("bytes")).expect("written");
    let run = ["simulate", "unit.fmu", "--allow-external", "--output", "r.csv"];
    let note = "computes with other values than its description says: level = 3 in the place of 5";
    for (more, level, is_noted) in [(&[][..], 3.0, true), (&["--set", "level=5"], 5.0, false)] {
        let (code, _, errors) = gapi(&here, &[&run, more].concat());
        assert_eq!(code, 0, "{errors}");
        assert_eq!(errors.contains(note), is_noted, "{errors}");
        let all = columns(&here.path().join("r.csv"));
        let last = |name: &str| *column(&all, name).last().expect("a row");
        assert_eq!(last("level"), level);
        near(last("y"), level * (-1.0f64).exp(), 1e-6);
    }
}

/// What is not continuous keeps the value of a sample until the next one, also between the events of
/// co-simulation.
#[test]
fn discrete_inputs_are_held() {
    let text = "model M discrete input Real w(start = 0); Real x(start = 0, fixed = true); \
                equation der(x) = w; annotation(experiment(StopTime = 2)); end M;";
    let here = folder(&[("M.mo", text), ("w.csv", "time,w\n0,1\n1,2\n2,3\n")]);
    let (code, out, errors) = exporting(&here, &["export-fmu", "M.mo", "-o", "unit.fmu"]);
    assert_eq!(code, 0, "{out}{errors}");
    for method in ["co-simulation", "dassl"] {
        let all = simulated(&here, &["--input", "w.csv", "--method", method, "--intervals", "4"]);
        near(*column(&all, "x").last().expect("a row"), 3.0, 1e-6);
        let between = |t: f64| t.fract() == 0.5;
        for (t, w) in column(&all, "time").iter().zip(column(&all, "w")) {
            assert!(!between(*t) || *w == t.ceil(), "{method}: {w} at {t} s");
        }
    }
}

/// Where inputs jump, rows of co-simulation have the limits from both sides as those of model exchange, at
/// the last time as well.
#[test]
fn rows_of_co_simulation_have_both_limits_at_jumps() {
    let text = "model M parameter Real k = 0.8; input Real u; input Boolean on; input Integer n; \
                Real x(start = 1, fixed = true); output Real y = 2*x + u + (if on then 10 else 0) + n; \
                equation der(x) = u - k*x; annotation(experiment(Tolerance = 1e-9)); end M;";
    let held = "time,u,on,n\n0,0,false,0\n0.75,0,false,0\n0.75,1,true,2\n2,1,true,2\n2,3,false,5\n";
    let here = folder(&[("M.mo", text), ("u.csv", held)]);
    let simulate =
        ["--input", "u.csv", "--stop-time", "2", "--intervals", "4", "--output", "o.csv"];
    for version in ["2", "3"] {
        let export = ["export-fmu", "M.mo", "--model", "M", "--fmi", version, "-o", "unit.fmu"];
        let (code, out, errors) = exporting(&here, &export);
        assert_eq!(code, 0, "{out}{errors}");
        for method in ["dassl", "co-simulation"] {
            let unit = ["simulate", "unit.fmu", "--allow-external", "--method", method];
            let (code, _, errors) = gapi(&here, &[&unit[..], &simulate].concat());
            assert_eq!(code, 0, "{errors}");
            let all = columns(&here.path().join("o.csv"));
            let rows = column(&all, "time").iter().zip(column(&all, "y"));
            let direct: Vec<f64> = rows.map(|(_, y)| *y).collect();
            let x = |row: usize| 2.0 * column(&all, "x")[row];
            let at = |t: f64| column(&all, "time").iter().position(|time| *time == t);
            let jump = at(0.75).expect("a row");
            near(direct[jump], x(jump), 1e-9);
            near(direct[jump + 1], x(jump) + 13.0, 1e-6);
            let end = direct.len() - 1;
            near(direct[end - 1], x(end) + 13.0, 1e-6);
            near(direct[end], x(end) + 8.0, 1e-6);
            assert_eq!(direct.len(), 8, "{version} {method}");
        }
    }
}

/// A unit that is not known is warned of, for models and FMUs alike; a literal is set as Modelica writes it.
#[test]
fn unknown_units_of_data_are_warned_of() {
    let text = "model M type Mode = enumeration(off, on); parameter Mode mode = Mode.off; \
                parameter Real k = 1; input Real u(unit = \"W\"); \
                Real x(start = 0, fixed = true); equation \
                der(x) = k*u + (if mode == Mode.on then 10 else 0); end M;";
    let here = folder(&[("M.mo", text), ("u.csv", "time,u [hp]\n0,1\n1,1\n")]);
    let export = ["export-fmu", "M.mo", "-o", "unit.fmu"];
    let (code, out, errors) = exporting(&here, &export);
    assert_eq!(code, 0, "{out}{errors}");
    let said =
        "`u` is in `hp`, which is not a known unit: its values are used for `u` as they are, in W";
    for source in [&["M.mo", "--model", "M"][..], &["unit.fmu", "--allow-external"]] {
        let more = ["--input", "u.csv", "--stop-time", "1", "--output", "o.csv", "--set"];
        let simulate =
            |set: &str| gapi(&here, &[&["simulate"], source, &more, &[set][..]].concat());
        let (code, _, errors) = simulate("mode=Mode.on");
        let text = errors.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(
            code == 0 && text.contains(&format!("warning[data-note]: u.csv: {said}")),
            "{text}"
        );
        let all = columns(&here.path().join("o.csv"));
        near(*column(&all, "x").last().expect("a row"), 11.0, 1e-5);
        let (code, _, errors) = simulate("mode=Mode.slow");
        assert!(code == 1 && errors.contains("its literals are off, on"), "{errors}");
    }
}

/// The set beside a unit has the values of the unit, whether a file gave them or the command line.
#[test]
fn the_set_beside_a_unit_has_its_values() {
    let parameter = |name: &str| Parameter {
        name: name.to_owned(),
        value: ParameterValue::Number(5.0),
        unit: None,
        estimate: None,
    };
    let set = ParameterSet {
        name: "set".to_owned(),
        parameters: vec![parameter("k"), parameter("level")],
        ..ParameterSet::default()
    };
    let here = folder(&[("P.mo", DECAY), ("s.ssv", &set.to_xml()), ("unit.ssv", "<other/>")]);
    let base =
        ["export-fmu", "P.mo", "--model", "P.Decay", "--set-file", "s.ssv", "-o", "unit.fmu"];
    let (code, out, errors) = exporting(&here, &[&base[..], &["--set", "k=2"]].concat());
    assert_eq!(code, 0, "{out}{errors}");
    assert!(out.contains("in the place of the former file"), "{out}");
    let text = fs::read_to_string(here.path().join("unit.ssv")).expect("a set");
    let written = ParameterSet::read(&text).expect("a set");
    let value = |at: usize| written.parameters[at].value.clone();
    assert_eq!([value(0), value(1)], [2.0, 5.0].map(ParameterValue::Number), "{text}");
}

/// Results of co-simulation end with a row where the model ends, whether a step is to end there or not.
#[test]
fn a_unit_that_ends_within_a_step_has_a_last_row() {
    let text = "model W output Real y = time; equation when time > 1 then terminate(\"done\"); \
                end when; annotation(experiment(StopTime = 3)); end W;";
    let here = folder(&[("W.mo", text)]);
    for version in ["2", "3"] {
        let export = ["export-fmu", "W.mo", "--fmi", version, "-o", "unit.fmu"];
        let (code, out, errors) = exporting(&here, &export);
        assert_eq!(code, 0, "{out}{errors}");
        let all = simulated(&here, &["--method", "co-simulation", "--intervals", "7"]);
        near(*column(&all, "time").last().expect("a row"), 1.0, 1e-6);
        near(*column(&all, "y").last().expect("a row"), 1.0, 1e-6);
    }
}

/// Replaces a part of the description of `unit.fmu`.
fn edit_description(here: &TempDir, from: &str, to: &str) {
    let path = here.path().join("unit.fmu");
    let bytes = fs::read(&path).expect("a unit");
    let mut archive = Archive::read(std::io::Cursor::new(bytes)).expect("an archive");
    let text = archive.file("modelDescription.xml").expect("a description").to_vec();
    let text = String::from_utf8(text).expect("text");
    assert!(text.contains(from), "{from}: {text}");
    archive.insert("modelDescription.xml", text.replace(from, to));
    fs::write(&path, archive.to_bytes().expect("bytes")).expect("written");
}

/// Radians are a base unit in descriptions: rad/s is not Hz.
#[test]
fn radians_are_a_base_unit_of_descriptions() {
    let text = "model M output Real w(unit = \"rad/s\") = 1; output Real n(unit = \"rpm\") = 2; \
                output Real f(unit = \"Hz\") = 3; output Real c(unit = \"N.m/rad\") = 4; end M;";
    let here = folder(&[("M.mo", text)]);
    for version in ["2", "3"] {
        let export = ["export-fmu", "M.mo", "--fmi", version, "-o", "unit.fmu"];
        let (code, out, errors) = exporting(&here, &export);
        assert_eq!(code, 0, "{out}{errors}");
        let bytes = fs::read(here.path().join("unit.fmu")).expect("a unit");
        let archive = Archive::read(std::io::Cursor::new(bytes)).expect("an archive");
        let text = archive.file("modelDescription.xml").expect("a description");
        let description = description::read(text).expect("a description");
        let exponents = |name: &str| {
            let unit = description.units.iter().find(|unit| unit.name == name).expect("a unit");
            let base = unit.base.as_ref().expect("a base unit").exponents;
            [base[0], base[1], base[2], base[7]]
        };
        let all = ["rad/s", "rpm", "Hz", "N.m/rad"].map(exponents);
        assert_eq!(all, [[0, 0, -1, 1], [0, 0, -1, 1], [0, 0, -1, 0], [1, 2, -2, -1]]);
    }
}

/// Where the name of a unit is not known, data and sets are converted as the description and the set define
/// it; a definition that contradicts a known name is warned of.
#[test]
fn units_are_converted_as_files_define_them() {
    let text = "model M parameter Real k(unit = \"hp\") = 1; parameter Real p(unit = \"bar\") = 2; \
                input Real u(unit = \"hp\"); Real x(start = 0, fixed = true); \
                output Real y(unit = \"hp\") = k + u; equation der(x) = u; end M;";
    let set = "<ParameterSet version=\"1.0\" name=\"s\"><Parameters><Parameter name=\"k\">\
               <Real value=\"3\" unit=\"ox\"/></Parameter></Parameters><Units><Unit name=\"ox\">\
               <BaseUnit kg=\"1\" m=\"2\" s=\"-3\" factor=\"500\"/></Unit></Units></ParameterSet>";
    let here = folder(&[
        ("M.mo", text),
        ("s.ssv", set),
        ("p.ssv", &set.replace("\"k\"", "\"p\"").replace("ox", "Pa").replace("500", "1")),
        ("hp.csv", "time,u [hp]\n0,4\n1,4\n"),
        ("W.csv", "time,u [W]\n0,1000\n1,1000\n"),
        ("mW.csv", "time,u [mule]\n0,8\n1,8\n"),
    ]);
    let export = ["export-fmu", "M.mo", "-o", "unit.fmu"];
    let (code, out, errors) = exporting(&here, &export);
    assert_eq!(code, 0, "{out}{errors}");
    let definition = "<Unit name=\"hp\"><BaseUnit kg=\"1\" m=\"2\" s=\"-3\" factor=\"250\"/>\
                      <DisplayUnit name=\"mule\" factor=\"2\"/></Unit>";
    edit_description(&here, "<Unit name=\"hp\"/>", definition);
    let simulate = |more: &[&str]| {
        let base = ["simulate", "unit.fmu", "--allow-external", "--stop-time", "1"];
        let output = ["--output", "o.csv"];
        let (code, out, errors) = gapi(&here, &[&base, more, &output].concat());
        assert_eq!(code, 0, "{out}{errors}");
        let all = columns(&here.path().join("o.csv"));
        (*column(&all, "y").last().expect("a row"), errors.replace("\n", " "))
    };
    for (data, is_noted) in [("hp.csv", false), ("W.csv", true), ("mW.csv", true)] {
        let (y, errors) = simulate(&["--input", data]);
        near(y, 5.0, 1e-9);
        assert_eq!(errors.contains("`u` is converted from"), is_noted, "{errors}");
        assert!(!errors.contains("warning["), "{errors}");
    }
    // 3 ox of the set are 6 hp of the description.
    let (y, errors) = simulate(&["--set-file", "s.ssv", "--input", "hp.csv"]);
    near(y, 10.0, 1e-9);
    assert!(errors.contains("is converted from ox to hp, times 2"), "{errors}");
    let outputs = "model = \"unit.fmu\"\n[parameters]\nk = { min = 0.1, max = 10 }\n\
                   [[experiment]]\ndata = \"y.csv\"\noutputs = { y = \"y\" }\n";
    fs::write(here.path().join("y.csv"), "time,y [W]\n0,750\n0.5,751\n1,749\n").expect("written");
    fs::write(here.path().join("p.toml"), outputs).expect("written");
    let (code, out, errors) =
        gapi(&here, &["identify", "p.toml", "--allow-external", "--out", "o"]);
    assert_eq!(code, 0, "{out}{errors}");
    let text = fs::read_to_string(here.path().join("o/result.json")).expect("a result");
    let result: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    near(result["parameters"][0]["value"].as_f64().expect("a number"), 3.0, 1e-6);
    let bar = "<Unit name=\"bar\">\n      <BaseUnit kg=\"1\" m=\"-1\" s=\"-2\" factor=\"100000\"/>";
    edit_description(&here, bar, &bar.replace("100000", "1000"));
    let (_, errors) = simulate(&["--set-file", "p.ssv"]);
    let text = errors.split_whitespace().collect::<Vec<_>>().join(" ");
    let said = "the FMU defines the unit `bar` as 1000 kg/(m.s2); it is used as 100000 kg/(m.s2)";
    assert!(text.contains("warning[units-differ]") && text.contains(said), "{text}");
}

/// A model with values of the past gives the same results as its unit, whoever integrates.
#[test]
fn units_with_delays_give_what_the_model_gives() {
    let text = "model M input Real u; parameter Real T = 0.3; Real x(start = 1, fixed = true); \
                Real s(start = 0, fixed = true); output Real a = delay(u, T); output Real w; \
                output Integer n = integer(delay(3*u, 0.4)); output Real b = delay(x, 0.2 + 0.1*x, 1); \
                equation der(x) = u - 2*delay(x, T); der(s) = 1 + 0.5*x; \
                (, w) = spatialDistribution(x, 0, s, true, {0, 1}, {1, 0}); \
                annotation(experiment(StopTime = 3, Tolerance = 1e-8)); end M;";
    let data = "time,u\n0,0\n0.5,0\n0.5,1\n1.5,1\n1.5,0.4\n3,0.4\n";
    let here = folder(&[("M.mo", text), ("u.csv", data)]);
    let more = ["--input", "u.csv", "--intervals", "30", "--output", "o.csv"];
    let run = |source: &[&str]| {
        let (code, out, errors) = gapi(&here, &[&["simulate"], source, &more].concat());
        assert_eq!(code, 0, "{out}{errors}");
        columns(&here.path().join("o.csv"))
    };
    let own = run(&["M.mo", "--model", "M"]);
    // Values beside jumps: of a at 0.8 and 1.8 s, of n at 0.9 and 1.9 s.
    let is_clear =
        |t: f64| [0.5, 0.8, 0.9, 1.5, 1.8, 1.9].iter().all(|jump| (t - jump).abs() > 1e-6);
    for version in ["2", "3"] {
        let export = ["export-fmu", "M.mo", "--fmi", version, "-o", "unit.fmu"];
        let (code, out, errors) = exporting(&here, &export);
        assert_eq!(code, 0, "{out}{errors}");
        for method in ["dassl", "co-simulation"] {
            let unit = run(&["unit.fmu", "--allow-external", "--method", method]);
            for name in ["x", "a", "w", "n", "b"] {
                let rows = |all: &[(String, Vec<f64>)]| -> Vec<(f64, f64)> {
                    let rows = column(all, "time").iter().zip(column(all, name));
                    let on_grid = |t: f64| (10.0 * t - (10.0 * t).round()).abs() < 1e-9;
                    let kept =
                        rows.map(|(t, y)| (*t, *y)).filter(|(t, _)| on_grid(*t) && is_clear(*t));
                    kept.collect()
                };
                let (expected, found) = (rows(&own), rows(&unit));
                for (t, y) in &expected {
                    let same = found.iter().find(|(at, _)| (at - t).abs() < 1e-9);
                    let (_, value) = same.unwrap_or_else(|| panic!("no row at {t}"));
                    assert!(
                        (value - y).abs() < 2e-4,
                        "{version} {method} {name} at {t}: {value}, {y}"
                    );
                }
                assert!(expected.len() > 20, "{} rows", expected.len());
            }
        }
    }
}

/// Data that begin before the start time of a unit are compared from their first row on, as with a model.
#[test]
fn fits_begin_with_data_before_the_start_time() {
    let text = "model M parameter Real k = 1; Real x(start = 1, fixed = true); output Real y = x; \
                equation der(x) = -k*x; annotation(experiment(StartTime = 10, StopTime = 12)); end M;";
    let row = |n: u32| {
        let t = 0.1 * f64::from(n);
        format!("{},{}\n", 8.0 + t, (-2.0 * t).exp() + 1e-6 * (37.0 * t).sin())
    };
    let data: String = (0..=20).map(row).collect();
    let here = folder(&[("M.mo", text), ("d.csv", &format!("time,y\n{data}"))]);
    let (code, out, errors) = exporting(&here, &["export-fmu", "M.mo", "-o", "unit.fmu"]);
    assert_eq!(code, 0, "{out}{errors}");
    for (model, folder) in [("M\"\nfiles = [\"M.mo\"]", "o"), ("unit.fmu\"", "u")] {
        let problem = format!(
            "model = \"{model}\n[parameters]\nk = {{ min = 0.1, max = 10 }}\n[[experiment]]\n\
             data = \"d.csv\"\noutputs = {{ y = \"y\" }}\n"
        );
        fs::write(here.path().join("p.toml"), problem).expect("written");
        let identify = ["identify", "p.toml", "--allow-external", "--out", folder];
        let (code, out, errors) = gapi(&here, &identify);
        assert_eq!(code, 0, "{out}{errors}");
        let text = fs::read_to_string(here.path().join(folder).join("result.json"));
        let text = text.expect("a result");
        assert!(text.contains("the simulation begins with the first row, at 8 s"), "{text}");
        let result: serde_json::Value = serde_json::from_str(&text).expect("JSON");
        near(result["parameters"][0]["value"].as_f64().expect("a number"), 2.0, 1e-4);
    }
}

const HALVED: &str = "model M type Mode = enumeration(off, on); parameter Mode mode = Mode.off; \
                     parameter Real k = 1; Real x(start = 1, fixed = true); output Real y = x; equation \
                     der(x) = -k*x*(if mode == Mode.on then 2 else 1); \
                     annotation(experiment(Tolerance = 1e-9)); end M;";

/// Literals of enumerations are values in problem files and modifications of units; commands that set initial
/// values take their numbers.
#[test]
fn literals_are_values_of_units() {
    let row = |n: u32| format!("{},{}\n", 0.05 * f64::from(n), (-0.1 * f64::from(n)).exp());
    let data: String = (0..=20).map(row).collect();
    let script = "importFMU(\"unit.fmu\")\n\
                  simulateModel(\"M_fmu(mode = Mode.on)\", stopTime=1, resultFile=\"a\")\n\
                  y = readTrajectory(\"a.mat\", {\"y\"}, readTrajectorySize(\"a.mat\"))\n\
                  print(String(y[1, end], significantDigits=9))\n\
                  (ok, z) = simulateExtendedModel(\"M_fmu(mode = M.Mode.on)\", stopTime=1, \
                  initialNames={\"k\"}, initialValues={2}, finalNames={\"y\"})\n\
                  print(String(z[1], significantDigits=9))\n\
                  (ok, z) = simulateExtendedModel(\"M_fmu\", stopTime=1, initialNames={\"k\", \"mode\"}, \
                  initialValues={3, 2}, finalNames={\"y\"})\n\
                  print(String(z[1], significantDigits=9))\n\
                  simulateModel(\"M_fmu(mode = Mode.slow)\", stopTime=1)\n";
    let here =
        folder(&[("M.mo", HALVED), ("d.csv", &format!("time,y\n{data}")), ("s.mos", script)]);
    let (code, out, errors) = exporting(&here, &["export-fmu", "M.mo", "-o", "unit.fmu"]);
    assert_eq!(code, 0, "{out}{errors}");
    let (_, out, errors) = gapi(&here, &["run", "s.mos", "--allow-external", "--out", "s"]);
    let text = format!("{out}{errors}");
    for (at, exponent) in [-2.0f64, -4.0, -6.0].iter().enumerate() {
        near(number_after(&text, at), exponent.exp(), 1e-5);
    }
    assert!(text.contains("its literals are off, on"), "{text}");
    let modes = [("on", Some(1.0)), ("Mode.on", Some(1.0)), ("off", Some(2.0)), ("slow", None)];
    let heads = ["model = \"unit.fmu\"", "model = \"M\"\nfiles = [\"M.mo\"]"];
    let cases = heads.iter().flat_map(|head| modes.map(|(mode, k)| (head, mode, k)));
    for (number, (head, mode, k)) in cases.enumerate() {
        let problem = format!(
            "{head}\n[parameters]\nk = {{ min = 0.1, max = 10 }}\n[[experiment]]\n\
             data = \"d.csv\"\noutputs = {{ y = \"y\" }}\nset = {{ mode = \"{mode}\" }}\n"
        );
        fs::write(here.path().join("p.toml"), problem).expect("written");
        let out = number.to_string();
        let identify = ["identify", "p.toml", "--allow-external", "--out", &out];
        let (code, out, errors) = gapi(&here, &identify);
        let Some(k) = k else {
            assert!(code == 1 && errors.contains("its literals are off, on"), "{out}{errors}");
            continue;
        };
        assert_eq!(code, 0, "{out}{errors}");
        let path = here.path().join(number.to_string()).join("result.json");
        let text = fs::read_to_string(path).expect("a result");
        let result: serde_json::Value = serde_json::from_str(&text).expect("JSON");
        near(result["parameters"][0]["value"].as_f64().expect("a number"), k, 1e-4);
    }
}

/// A literal that a problem fixes is one in the calibrated model.
#[test]
fn literals_are_values_of_calibrated_models() {
    let problem = "model = \"M\"\nfiles = [\"M.mo\"]\n[parameters]\nk = { min = 0.1, max = 10 }\n\
                   mode = { fixed = \"on\" }\n[[experiment]]\ndata = \"d.csv\"\noutputs = { y = \"y\" }\n";
    let data = "time,y\n0,1\n0.5,0.36788\n1,0.13534\n1.5,0.04979\n";
    let here = folder(&[("M.mo", HALVED), ("d.csv", data), ("p.toml", problem)]);
    let (code, out, errors) = gapi(&here, &["identify", "p.toml", "--out", "o"]);
    assert_eq!(code, 0, "{out}{errors}");
    let model = fs::read_to_string(here.path().join("o/Calibrated.mo")).expect("a model");
    assert!(model.contains("mode = .M.Mode.on"), "{model}");
}

/// A unit is fitted with the digits of its model: same derivatives, nominal values, steps. Without the nominal value
/// of the state, 3, the values differ by 1e-6.
#[test]
fn a_unit_is_fitted_with_the_digits_of_its_model() {
    let text = "model M parameter Real V = 2; parameter Real K = 0.5; Real s(start = 3, fixed = true); \
                output Real y = s; equation der(s) = -V*s/(K + s); end M;";
    // The solution of s' = -2 s/(0.5 + s), its inverse in closed form: t = (3 - s)/2 + 0.25 ln(3/s).
    let row = |n: u32| {
        let s = 3.0 - 0.07 * f64::from(n);
        let noise = 0.01 * (53.0 * f64::from(n * n)).sin();
        format!("{},{}\n", (3.0 - s) / 2.0 + 0.25 * (3.0 / s).ln(), s + noise)
    };
    let data: String = (0..=40).map(row).collect();
    let here = folder(&[("M.mo", text), ("d.csv", &format!("time,y\n{data}"))]);
    let (code, out, errors) = exporting(&here, &["export-fmu", "M.mo", "-o", "unit.fmu"]);
    assert_eq!(code, 0, "{out}{errors}");
    let fitted = |head: &str| -> Vec<f64> {
        let problem = format!(
            "{head}\n[parameters]\nV = {{ min = 0.4, max = 10 }}\nK = {{ min = 0.1, max = 2.5 }}\n\
             [[experiment]]\ndata = \"d.csv\"\noutputs = {{ y = \"y\" }}\n"
        );
        fs::write(here.path().join("p.toml"), problem).expect("written");
        let identify = ["identify", "p.toml", "--allow-external", "--overwrite", "--out", "o"];
        let (code, out, errors) = gapi(&here, &identify);
        assert_eq!(code, 0, "{out}{errors}");
        let text = fs::read_to_string(here.path().join("o/result.json")).expect("a result");
        let result: serde_json::Value = serde_json::from_str(&text).expect("JSON");
        let values = result["parameters"].as_array().expect("parameters").iter();
        values.map(|own| own["value"].as_f64().expect("a number")).collect()
    };
    let own = fitted("model = \"M\"\nfiles = [\"M.mo\"]");
    let unit = fitted("model = \"unit.fmu\"");
    near(own[0], 2.0, 0.1);
    for (own, unit) in own.iter().zip(&unit) {
        near(unit / own, 1.0, 1e-11);
    }
}

/// Platforms that a script asks for by name are noted, those of every importer are not.
#[test]
fn platforms_of_a_build_are_noted() {
    let script = "loadFile(\"P.mo\");\n\
                  buildModelFMU(P.Decay, platforms={\"static\", \"x86_64-w64-mingw32\"});\n\
                  getErrorString();\n";
    let here = folder(&[("P.mo", DECAY), ("s.mos", script)]);
    let (_, out, errors) = exporting(&here, &["run", "s.mos", "--out", "o"]);
    let text = format!("{out}{errors}").replace('\n', " ");
    let said = "has no effect: the unit is for the platform of this program alone";
    assert!(text.contains(&format!("`x86_64-w64-mingw32` {said}")), "{text}");
    assert!(!text.contains("`static`"), "{text}");
    assert!(here.path().join("P.Decay.fmu").exists() || here.path().join("o/P.Decay.fmu").exists());
}
