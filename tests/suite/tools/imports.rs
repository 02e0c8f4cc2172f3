//! `gapi import`: models in SBML with exact solutions, problems in PEtab, and what is refused; and the
//! collections of both, where environment variables name them.

#![allow(
    clippy::print_stderr,
    reason = "tests that are skipped, and cases that differ, have to be said"
)]

use crate::support::program::{folder, gapi};
use crate::support::shipped::project;
use std::cmp::Ordering;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// The last row of a simulation of an SBML file of `tests/exchange`.
fn end(file: &str, class: &str, stop: &str) -> BTreeMap<String, f64> {
    let here = folder(&[]);
    let path = project("tests/exchange").join(file);
    let (code, out, errors) = gapi(&here, &["import", path.to_str().unwrap(), "--out", "m"]);
    assert_eq!(code, 0, "{out}{errors}");
    let model = format!("m/{class}.mo");
    let simulate = [
        "simulate",
        &model,
        "--model",
        class,
        "--stop-time",
        stop,
        "--tolerance",
        "1e-10",
        "-o",
        "r.csv",
    ];
    let (code, out, errors) = gapi(&here, &simulate);
    assert_eq!(code, 0, "{out}{errors}");
    let text = fs::read_to_string(here.path().join("r.csv")).unwrap();
    let names =
        text.lines().next().unwrap().split(',').map(|name| name.trim_matches('"').to_owned());
    let values = text.lines().last().unwrap().split(',').map(|value| value.parse().unwrap());
    names.zip(values).collect()
}

fn close(found: &BTreeMap<String, f64>, name: &str, expected: f64) {
    let found = found.get(name).unwrap_or_else(|| panic!("no {name} in {found:?}"));
    assert!(
        (found - expected).abs() < 1e-6 * expected.abs().max(1.0),
        "{name}: {found} {expected}"
    );
}

#[test]
fn amounts_stay_where_compartments_grow() {
    // V = 2 + t, and the amount decays: 6 exp(-t/2).
    let found = end("volume.xml", "Volume", "2");
    let amount = 6.0 * (-1.0_f64).exp();
    close(&found, "S", amount / 4.0);
    close(&found, "total", amount + 4.0);
    let here = folder(&[]);
    let path = project("tests/exchange/volume.xml");
    assert_eq!(gapi(&here, &["import", path.to_str().unwrap(), "--out", "m"]).0, 0);
    let text = fs::read_to_string(here.path().join("m/Volume.mo")).unwrap();
    assert!(text.contains("  parameter Real twice = 2*k;\n"), "{text}");
    assert!(text.contains("  parameter Real 'time' = 4;\n"), "{text}");
}

#[test]
fn events_have_priorities_delays_and_values_of_their_triggers() {
    let found = end("events.xml", "Events", "3");
    // The higher priority first; the value of x when the trigger became true, 1.5, at 2.5.
    close(&found, "order", 21.0);
    close(&found, "late", 1.5);
    close(&found, "y", 3.0 * (-0.5_f64).exp());
    close(&found, "gone", 0.0);
    close(&found, "first", 7.0);
}

#[test]
fn mathematics_has_its_values() {
    let found = end("mathematics.xml", "Mathematics", "1.5");
    let x = (-1.5_f64).exp();
    close(&found, "z", 5.0 - x);
    close(&found, "y", (x + 1.0) * (x + 1.0));
    close(&found, "w", 2.0);
    close(&found, "before", (-0.5_f64).exp());
    close(&found, "rate", -x);
    // Three of four are true: 1; true does not imply false: 0; log2 8, the third root of 27, 0.5.
    close(&found, "odd", 1.0 + 0.0 + 3.0 + 3.0 + 0.5);
}

const YAML: &str = "format_version: 1\nparameter_file: p.tsv\nproblems:\n- sbml_files: [m.xml]\n  \
                    condition_files: [c.tsv]\n  observable_files: [o.tsv]\n  measurement_files: [m.tsv]\n";

/// x decays from the value that a condition sets, after it was at rest at u/k.
fn model() -> String {
    let math =
        |inner: &str| format!("<math xmlns=\"http://www.w3.org/1998/Math/MathML\">{inner}</math>");
    let rate = "<apply><minus/><ci>u</ci><apply><times/><ci>k</ci><ci>x</ci></apply></apply>";
    format!(
        "<sbml xmlns=\"http://www.sbml.org/sbml/level2/version4\" level=\"2\" version=\"4\">\n\
         <model id=\"Decay\">\n<listOfParameters>\n<parameter id=\"k\" value=\"1\"/>\n\
         <parameter id=\"u\" value=\"0\"/>\n<parameter id=\"x\" value=\"1\" constant=\"false\"/>\n\
         </listOfParameters>\n<listOfRules>\n<rateRule variable=\"x\">{}</rateRule>\n</listOfRules>\n\
         </model>\n</sbml>\n",
        math(rate)
    )
}

const PARAMETERS: &str = "parameterId\tparameterScale\tlowerBound\tupperBound\tnominalValue\testimate\n\
                          k\tlog10\t0.01\t100\t1\t1\nscale\tlin\t0.1\t9\t1\t1\nx_high\tlog\t0.1\t50\t1\t1\n\
                          fixed\tlin\t0\t9\t2\t0\n";
const OBSERVABLES: &str = "observableId\tobservableFormula\tobservableTransformation\tnoiseFormula\n\
                           y\tobservableParameter1_y*x\tlin\tnoiseParameter1_y\nlogarithm\tx\tlog10\t0.1\n";

/// A problem with k = 0.5, scale = 3 and x_high = 8.
fn problem() -> TempDir {
    let mut rows =
        "observableId\tpreequilibrationConditionId\tsimulationConditionId\ttime\tmeasurement\t\
                    observableParameters\tnoiseParameters\n"
            .to_owned();
    for k in 0..6 {
        let t = f64::from(k);
        let decay = (-0.5 * t).exp();
        rows += &format!("y\t\tlow\t{t}\t{}\tscale\t0.01\n", 3.0 * 2.0 * decay);
        rows += &format!("y\t\thigh\t{t}\t{}\t1\t0.02\n", 8.0 * decay);
        rows += &format!("y\t\thigh\t{t}\t{}\t1\t0.03\n", 8.0 * decay);
        rows += &format!("logarithm\t\tlow\t{t}\t{}\t\t\n", 2.0 * decay);
        rows += &format!("y\tfed\tstarved\t{t}\t{}\tscale\t0.01\n", 3.0 * 4.0 * decay);
    }
    let conditions = "conditionId\tx\tu\nlow\tfixed\t0\nhigh\tx_high\t0\nfed\t\t2\nstarved\t\t0\n";
    folder(&[
        ("p.yaml", YAML),
        ("m.xml", &model()),
        ("p.tsv", PARAMETERS),
        ("c.tsv", conditions),
        ("o.tsv", OBSERVABLES),
        ("m.tsv", &rows),
    ])
}

#[test]
fn a_problem_in_petab_is_imported_and_solved() {
    let here = problem();
    let (code, out, errors) = gapi(&here, &["identify", "p.yaml", "--out", "fit"]);
    assert_eq!(code, 0, "{out}{errors}");
    let text = fs::read_to_string(here.path().join("fit/result.json")).unwrap();
    let result: serde_json::Value = serde_json::from_str(&text).unwrap();
    let parameters = result["parameters"].as_array().unwrap();
    for (name, expected) in [("k", 0.5), ("scale", 3.0), ("x_high", 8.0)] {
        let own = parameters.iter().find(|own| own["name"] == name).unwrap();
        let value = own["value"].as_f64().unwrap();
        assert!((value - expected).abs() < 1e-4 * expected, "{name}: {value}\n{out}");
    }
    // What is there is kept, and equal to what is imported again.
    let (code, out, errors) = gapi(&here, &["import", "p.yaml", "--out", "p"]);
    assert_eq!(code, 0, "{out}{errors}");
    fs::write(here.path().join("p/p.toml"), "# mine\n").unwrap();
    let (code, _, errors) = gapi(&here, &["import", "p.yaml", "--out", "p"]);
    assert!(code == 1 && errors.contains("is there with another content"), "{errors}");
}

/// A uniform prior on the scale log10 from -1 to 0, within bounds that are wider.
#[test]
fn uniform_priors_narrow_the_range() {
    let here = problem();
    let path = here.path().join("p.tsv");
    let text = PARAMETERS
        .replacen("\testimate\n", "\testimate\tobjectivePriorType\tobjectivePriorParameters\n", 1)
        .replacen("\t100\t1\t1\n", "\t100\t1\t1\tparameterScaleUniform\t-1;0\n", 1);
    fs::write(&path, text).unwrap();
    let (code, out, errors) = gapi(&here, &["import", "p.yaml", "--out", "p"]);
    assert_eq!(code, 0, "{out}{errors}");
    let written = fs::read_to_string(here.path().join("p/p.toml")).unwrap();
    let table: toml::Table = written.parse().unwrap();
    let range = ["min", "max"].map(|end| table["parameters"]["k"][end].as_float());
    let range = range.map(|end| end.unwrap_or(1.0));
    assert!((range[0] - 0.1).abs() < 1e-12 && (range[1] - 1.0).abs() < 1e-12, "{written}");
}

/// Laplace noise and priors, with the constants of PEtab; a measurement without a value is said.
#[test]
fn laplace_noise_and_priors_are_imported() {
    let here = problem();
    let text = PARAMETERS
        .replacen("\testimate\n", "\testimate\tobjectivePriorType\tobjectivePriorParameters\n", 1)
        .replacen("\t100\t1\t1\n", "\t100\t1\t1\tparameterScaleLaplace\t-1;0.5\n", 1)
        .replacen("\t9\t1\t1\n", "\t9\t1\t1\tlaplace\t2;3\n", 1);
    fs::write(here.path().join("p.tsv"), text).unwrap();
    let path = here.path().join("o.tsv");
    let text = fs::read_to_string(&path).unwrap().replacen(
        "noiseFormula",
        "noiseFormula\tnoiseDistribution",
        1,
    );
    let text = text.replacen("\t0.1\n", "\t0.1\tlaplace\n", 1);
    fs::write(&path, text).unwrap();
    let path = here.path().join("m.tsv");
    let text = fs::read_to_string(&path).unwrap() + "y\t\tlow\t6\t\tscale\t0.01\n";
    fs::write(&path, text).unwrap();
    let (code, out, errors) = gapi(&here, &["import", "p.yaml", "--out", "p"]);
    assert_eq!(code, 0, "{out}{errors}");
    assert!(out.contains("the measurement at m.tsv:32 has no value and is left out"), "{out}");
    let written = fs::read_to_string(here.path().join("p/p.toml")).unwrap();
    for expected in [
        "prior = { distribution = \"laplace\", median = 0.1, factor = 3.16",
        "prior = { distribution = \"laplace\", median = 2, scale = 3 }",
        "error = \"loglaplace\"",
        "base = 10 }",
    ] {
        assert!(written.contains(expected), "{expected}\n{written}");
    }
    let (code, out, errors) = gapi(&here, &["identify", "p/p.toml", "--out", "fit"]);
    assert_eq!(code, 0, "{out}{errors}");
    let path = here.path().join("p.tsv");
    let text = fs::read_to_string(&path).unwrap().replacen("laplace\t2;3", "logNormal\t2;3", 1);
    fs::write(&path, text).unwrap();
    let (code, out, errors) = gapi(&here, &["import", "p.yaml", "--out", "q"]);
    assert_eq!(code, 0, "{out}{errors}");
    let written = fs::read_to_string(here.path().join("q/p.toml")).unwrap();
    let expected = "prior = { distribution = \"lognormal\", mean = 2, sd = 3 }";
    assert!(written.contains(expected), "{written}");
}

/// Files of a problem in version 1 with the model, conditions, measurements and one observable y.
fn small(model: &str, conditions: &str, measurements: &str) -> TempDir {
    folder(&[
        ("m.xml", model),
        (
            "p.yaml",
            "format_version: 1\nparameter_file: p.tsv\nproblems:\n- sbml_files: [m.xml]\n  \
                    condition_files: [c.tsv]\n  observable_files: [o.tsv]\n  \
                    measurement_files: [m.tsv]\n",
        ),
        (
            "p.tsv",
            "parameterId\tparameterScale\tlowerBound\tupperBound\tnominalValue\testimate\n\
                   k\tlog10\t.01\t100\t1\t1\n",
        ),
        ("o.tsv", "observableId\tobservableFormula\tnoiseFormula\ny\tA + q\t0.1\n"),
        ("c.tsv", conditions),
        ("m.tsv", measurements),
    ])
}

/// A value of a condition counts in it alone, also where the model computes the initial value from
/// variables; what a rule determines cannot be set.
#[test]
fn conditions_set_what_initial_assignments_compute() {
    let math = |text: &str| {
        format!(
            "<math xmlns=\"http://www.w3.org/1998/Math/MathML\"><apply><times/>{text}</apply></math>"
        )
    };
    let model = format!(
        "<sbml xmlns=\"http://www.sbml.org/sbml/level3/version1/core\" level=\"3\" version=\"1\">\
         <model id=\"m\"><listOfParameters><parameter id=\"k\" value=\"1\" constant=\"true\"/>\
         <parameter id=\"q\" constant=\"true\"/><parameter id=\"A\" value=\"1\" constant=\"false\"/>\
         </listOfParameters><listOfInitialAssignments><initialAssignment symbol=\"q\">{}\
         </initialAssignment></listOfInitialAssignments><listOfRules><rateRule variable=\"A\">{}\
         </rateRule></listOfRules></model></sbml>",
        math("<cn>7</cn><ci>A</ci>"),
        math("<cn>-1</cn><ci>k</ci><ci>A</ci>")
    );
    let rows = [0.0_f64, 1.0, 2.0].map(|t| {
        let own = (-0.5 * t).exp();
        format!("y\tc1\t{t}\t{}\ny\tc2\t{t}\t{}\n", own + 1.5, own + 7.0)
    });
    let measurements =
        "observableId\tsimulationConditionId\ttime\tmeasurement\n".to_owned() + &rows.concat();
    let here = small(&model, "conditionId\tq\nc1\t1.5\nc2\t\n", &measurements);
    let (code, out, errors) = gapi(&here, &["identify", "p.yaml", "--out", "fit"]);
    assert_eq!(code, 0, "{out}{errors}");
    let text = fs::read_to_string(here.path().join("fit/result.json")).unwrap();
    let result: serde_json::Value = serde_json::from_str(&text).unwrap();
    let k = result["parameters"][0]["value"].as_f64().unwrap();
    assert!((k - 0.5).abs() < 1e-6, "{k}");
    let ruled = model.replace("initialAssignment symbol", "assignmentRule variable");
    let ruled = ruled.replace("initialAssignment>", "assignmentRule>");
    let ruled = ruled.replace("</listOfInitialAssignments><listOfRules>", "");
    let ruled = ruled.replace("listOfInitialAssignments", "listOfRules");
    fs::write(here.path().join("m.xml"), ruled).unwrap();
    let (code, _, errors) = gapi(&here, &["import", "p.yaml", "--out", "p"]);
    let said = "a rule of the model determines `q` at all times";
    assert!(code == 1 && errors.contains(said) && errors.contains("c.tsv:2"), "{errors}");
}

/// Columns that another version has, and known ones in other letters, would be read over.
#[test]
fn columns_that_would_not_count_are_refused() {
    let here = problem();
    let table = PARAMETERS.replacen("\testimate\n", "\testimate\tpriorDistribution\n", 1);
    let table = table.replacen("\t9\t1\t1\n", "\t9\t1\t1\tnormal\n", 1);
    for (text, said) in [
        (table, "version 1 of PEtab has no column `priorDistribution`"),
        (
            PARAMETERS.replacen("\testimate\n", "\testimate\tobjectivePriortype\n", 1),
            "write `objectivePriorType`",
        ),
    ] {
        fs::write(here.path().join("p.tsv"), text).unwrap();
        let (code, _, errors) = gapi(&here, &["import", "p.yaml", "--out", "p"]);
        assert!(code == 1 && errors.contains(said) && errors.contains("p.tsv"), "{errors}");
    }
}

/// Noise that depends on the observable is part of the likelihood, also of a model in Modelica.
#[test]
fn a_model_in_modelica_is_extended_by_its_noise() {
    let here = folder(&[
        (
            "M.mo",
            "model M\n  parameter Real k = 1;\n  Real A(start = 2, fixed = true);\nequation\n  \
             der(A) = -k*A;\nend M;\n",
        ),
        (
            "p.yaml",
            "format_version: 2.0.0\nmodel_files:\n  M:\n    location: M.mo\n    \
                    language: modelica\nparameter_files: [p.tsv]\nobservable_files: [o.tsv]\n\
                    measurement_files: [m.tsv]\n",
        ),
        (
            "p.tsv",
            "parameterId\tlowerBound\tupperBound\tnominalValue\testimate\nk\t.1\t10\t1\tTrue\n\
                   s\t0\t1\t.1\tFalse\n",
        ),
        ("o.tsv", "observableId\tobservableFormula\tnoiseFormula\ny\t3*A\t0.1 + s*A\n"),
        (
            "m.tsv",
            "observableId\ttime\tmeasurement\texperimentId\ny\t0\t5.5\t\ny\t1\t4.1\t\ny\t2\t2\t\n",
        ),
    ]);
    let (code, out, errors) = gapi(&here, &["identify", "p.yaml", "--out", "fit"]);
    assert_eq!(code, 0, "{out}{errors}");
    let text = fs::read_to_string(here.path().join("fit/result.json")).unwrap();
    let result: serde_json::Value = serde_json::from_str(&text).unwrap();
    let k = result["parameters"][0]["value"].as_f64().unwrap();
    let negative = |k: f64| -> f64 {
        let points = [(0.0, 5.5), (1.0, 4.1), (2.0, 2.0)];
        let one = |(t, y): (f64, f64)| {
            let a = 2.0 * (-k * t).exp();
            let sigma = 0.1 + 0.1 * a;
            0.5 * ((y - 3.0 * a) / sigma).powi(2) + (sigma * std::f64::consts::TAU.sqrt()).ln()
        };
        points.into_iter().map(one).sum()
    };
    let own = result["negative_log_likelihood"].as_f64().unwrap();
    assert!((own - negative(k)).abs() < 1e-6, "{own} {}", negative(k));
    assert!(negative(k) < negative(1.003 * k).min(negative(0.997 * k)), "{k} is not a minimum");
}

/// The problem in version 2 has the fit that it has in version 1.
#[test]
fn version_2_has_the_same_fit() {
    let fitted = |here: &TempDir, file: &str| {
        let (code, out, errors) = gapi(here, &["identify", file, "--out", "fit"]);
        assert_eq!(code, 0, "{out}{errors}");
        let text = fs::read_to_string(here.path().join("fit/result.json")).unwrap();
        let result: serde_json::Value = serde_json::from_str(&text).unwrap();
        result["negative_log_likelihood"].as_f64().unwrap()
    };
    let here = problem();
    let expected = fitted(&here, "p.yaml");
    let yaml = "format_version: 2.0.0\nmodel_files:\n  m:\n    location: m.xml\n    language: sbml\n\
                parameter_files: [p.tsv]\nobservable_files: [o.tsv]\ncondition_files: [c.tsv]\n\
                experiment_files: [e.tsv]\nmeasurement_files: [m.tsv]\nmapping_files: [a.tsv]\n";
    let parameters = "parameterId\tlowerBound\tupperBound\tnominalValue\testimate\n\
                      k\t0.01\t100\t1\ttrue\nscale\t0.1\t9\t1\ttrue\nx_high\t0.1\t50\t1\ttrue\n\
                      fixed\t\t\t2\tfalse\n";
    let ln10 = std::f64::consts::LN_10;
    let observables = format!(
        "observableId\tobservableFormula\tnoiseFormula\tnoiseDistribution\tobservablePlaceholders\t\
         noisePlaceholders\ny\tfactor*amount\tdeviation\tnormal\tfactor\tdeviation\n\
         logarithm\tamount\t{}\tlog-normal\t\t\n",
        0.1 * ln10
    );
    let conditions = "conditionId\ttargetId\ttargetValue\nlow\tamount\tfixed\nlow\tu\t0\n\
                      high\tamount\tx_high\nhigh\tu\t0\nfed\tu\t2\nstarved\tu\t0\n";
    let experiments = "experimentId\ttime\tconditionId\nlow\t0\tlow\nhigh\t0\thigh\n\
                       starved\t-inf\tfed\nstarved\t0\tstarved\n";
    let measured = fs::read_to_string(here.path().join("m.tsv")).unwrap();
    let rows = measured.lines().skip(1).map(|line| {
        let cells: Vec<&str> = line.split('\t').collect();
        let [o, _, e, t, y, a, b] = cells[..] else { panic!("{line}") };
        format!("{o}\t{e}\t{t}\t{y}\t{a}\t{b}\n")
    });
    let heading =
        "observableId\texperimentId\ttime\tmeasurement\tobservableParameters\tnoiseParameters\n";
    let measurements = heading.to_owned() + &rows.collect::<String>();
    let here = folder(&[
        ("p.yaml", yaml),
        ("m.xml", &model()),
        ("p.tsv", parameters),
        ("o.tsv", &observables),
        ("c.tsv", conditions),
        ("e.tsv", experiments),
        ("m.tsv", &measurements),
        ("a.tsv", "petabEntityId\tmodelEntityId\namount\tx\n"),
    ]);
    let found = fitted(&here, "p.yaml");
    assert!((found - expected).abs() < 1e-6, "{found} {expected}");
    fs::write(here.path().join("e.tsv"), experiments.to_owned() + "low\t2\thigh\n").unwrap();
    let (code, _, errors) = gapi(&here, &["import", "p.yaml", "--out", "q"]);
    assert!(code == 1 && errors.contains("only its begin is supported"), "{errors}");
    assert!(errors.contains("e.tsv:6"), "{errors}");
}

/// A problem of this program in PEtab, read again: the same objective; and what PEtab cannot say.
#[test]
fn an_exported_problem_has_the_same_objective() {
    let model = "model Tank\n  parameter Real k = 1;\n  parameter Real rate[2] = {1, 1};\n  \
                 parameter Real h_0 = 2;\n  Real h(start = h_0, fixed = true);\n  Real q = k*h;\nequation\n  \
                 der(h) = -k*rate[1]*h;\nend Tank;\n";
    let problem = "model = \"Tank\"\nfiles = [\"Tank.mo\"]\nbands = false\n[parameters]\n\
                   k = { min = 0.1, max = 10, prior = { mean = 1, sd = 0.5, min = 0.1, max = 10 } }\n\
                   \"rate[1]\" = { min = 0.1, max = 5, prior = { distribution = \"lognormal\", \
                   mean = 0.1, sd = 0.4, min = 0.1, max = 5 } }\n\
                   h_0 = { min = 1, max = 3, per_experiment = true }\n\
                   [[experiment]]\nname = \"a b\"\ndata = \"a.csv\"\nset = { \"rate[2]\" = 2 }\n\
                   outputs = { h = { column = \"h\", sigma = \"s\" }, \
                   q = { column = \"q\", sigma = 0.1, error = \"lognormal\" } }\n\
                   [[experiment]]\ndata = \"b.csv\"\n\
                   outputs = { h = { column = \"h\", sigma = \"estimate\", error = \"laplace\" } }\n";
    let here = folder(&[
        ("Tank.mo", model),
        ("tank.toml", problem),
        ("a.csv", "time,h,s,q\n0,2.02,0.1,1.4\n1,1.1,0.2,0.8\n2,0.53,0.1,0.42\n"),
        ("b.csv", "time,h\n0.5,1.52\n1.5,0.8\n2.5,0.5\n3.5,0.1\n"),
    ]);
    let negative = |arguments: &[&str]| {
        let (code, out, errors) = gapi(&here, &[&["identify"], arguments].concat());
        assert_eq!(code, 0, "{out}{errors}");
        let folder = here.path().join(arguments.last().unwrap()).join("result.json");
        let result: serde_json::Value =
            serde_json::from_str(&fs::read_to_string(folder).unwrap()).unwrap();
        result["negative_log_likelihood"].as_f64().unwrap()
    };
    let expected = negative(&["tank.toml", "--out", "own"]);
    let (code, out, errors) = gapi(&here, &["export", "tank.toml", "--petab", "petab"]);
    assert_eq!(code, 0, "{out}{errors}");
    let found = negative(&["petab/problem.yaml", "--out", "again"]);
    assert!((found - expected).abs() < 1e-6, "{found} {expected}");
    for (old, new, said) in [
        ("sigma = 0.1,", "sigma = 0.1, delay = 1,", "a delay cannot be written in PEtab"),
        ("name = \"a b\"", "validation = true", "an experiment for validation cannot"),
        ("sigma = \"s\"", "sigma = \"0.1*h\"", "a sigma that is a formula"),
    ] {
        let own = problem.replacen(old, new, 1);
        fs::write(here.path().join("other.toml"), own).unwrap();
        let (code, out, errors) = gapi(&here, &["export", "other.toml", "--petab", "other"]);
        assert!(code == 1 && errors.contains(said), "{out}{errors}");
        assert!(errors.contains("other.toml:"), "{errors}");
    }
}

/// Noise that depends on estimated parameters and on the model, and noise that is a parameter of the
/// model, are variables of the model.
#[test]
fn noise_may_be_a_formula() {
    for (noise, formula) in [("0.05 + 0.1*k*x", "(0.05 + 0.1*k*x)*2.30258"), ("k", "k*2.30258")] {
        let here = problem();
        let path = here.path().join("o.tsv");
        let text = fs::read_to_string(&path).unwrap();
        fs::write(&path, text.replace("\t0.1", &format!("\t{noise}"))).unwrap();
        let (code, out, errors) = gapi(&here, &["import", "p.yaml", "--out", "p"]);
        assert_eq!(code, 0, "{out}{errors}");
        let written = fs::read_to_string(here.path().join("p/p.toml")).unwrap();
        assert!(written.contains("sigma = \"sigma_of_logarithm\""), "{written}");
        let model = fs::read_to_string(here.path().join("p/Decay.mo")).unwrap();
        assert!(model.contains(formula), "{model}");
        let (code, out, errors) = gapi(&here, &["identify", "p/p.toml", "--out", "fit"]);
        assert_eq!(code, 0, "{out}{errors}");
        assert!(out.contains("root mean square, from the model"), "{out}");
        assert!(out.contains("negative log-likelihood"), "{out}");
    }
}

#[test]
fn what_is_not_supported_is_refused_at_its_place() {
    for (file, old, new, said, place) in [
        (
            "o.tsv",
            "\t0.1",
            "\tk*wrong",
            "`wrong` is neither in the model nor a parameter",
            "o.tsv:3",
        ),
        ("m.tsv", "low\t5\t", "low\t-5\t", "missing or negative", "m.tsv:27"),
        ("o.tsv", "log10", "sqrt", "the transformation `sqrt` is not supported", "o.tsv:3"),
        ("o.tsv", "1_y*x", "1_y**", "is not a formula", "o.tsv:2"),
        (
            "p.yaml",
            "version: 1",
            "version: 3.0.0",
            "version 3 of PEtab is not supported",
            "p.yaml:1:",
        ),
        (
            "p.tsv",
            "scale\tlin\t0.1\t9\t1\t1",
            "scale\tlin\t0.1\t9\t1\t2",
            "`2`, neither 0 nor 1",
            "p.tsv:3",
        ),
        ("p.tsv", "scale\tlin\t0.1\t9", "scale\tlin\t9\t0.1", "the bounds of `scale`", "p.tsv:3"),
        ("m.tsv", "scale\t0.01", "scale\t0.01;7", "value for `noiseParameter2_y`", "m.tsv:2"),
        ("p.yaml", "[m.xml]", "[m.xml, n.xml]", "the problem has 2 models", "p.yaml:4:"),
        ("p.yaml", "[o.tsv]", "[q.tsv]", "cannot read `q.tsv`", "p.yaml:6:"),
        ("p.yaml", "[m.xml]", "[n.xml]", "cannot read `n.xml`: it does not exist", "p.yaml:4:"),
        ("p.yaml", "[o.tsv]", "[o.tsv", "the file is not YAML", "p.yaml:7:"),
        ("c.tsv", "low\tfixed\t0", "low\tfixed\t0\t7", "the cell `7` has no column", "c.tsv:2:"),
        ("c.tsv", "\tx\tu\n", "\tx\tx\n", "there are two columns `x`", "c.tsv:1:"),
        ("p.tsv", "scale\tlin", "k\tlin", "a row above has the same parameter", "p.tsv:3"),
        ("o.tsv", "logarithm\tx", "y\tx", "a row above has the same observable", "o.tsv:3"),
        ("c.tsv", "high\tx_high", "low\tx_high", "a row above has the same condition", "c.tsv:3"),
        ("m.xml", "rateRule", "fastRule", "`fastRule` is not supported", "m.xml:9"),
        ("m.xml", "<ci>u</ci>", "<ci>v</ci>", "nothing declares `v`", "m.xml:9"),
        ("m.xml", "<minus/>", "<selector/>", "the function `selector` of MathML", "m.xml:9"),
    ] {
        let here = problem();
        let path = here.path().join(file);
        let text = fs::read_to_string(&path).unwrap();
        assert!(text.contains(old), "{old}");
        fs::write(&path, text.replace(old, new)).unwrap();
        let (code, out, errors) = gapi(&here, &["import", "p.yaml"]);
        assert_eq!(code, 1, "{out}{errors}");
        assert!(errors.contains(said) && errors.contains(place), "{said} {place}\n{errors}");
        let unread = errors.matches("cannot read").count();
        let remedy = "correct the name, or put the file there";
        assert!(
            unread == usize::from(errors.contains(remedy)),
            "said once, with a remedy: {errors}"
        );
    }
}

/// Each entry of the problem file names the row that it comes from.
#[test]
fn entries_name_the_rows_that_they_come_from() {
    let here = problem();
    let (code, out, errors) = gapi(&here, &["import", "p.yaml", "--out", "p"]);
    assert_eq!(code, 0, "{out}{errors}");
    let text = fs::read_to_string(here.path().join("p/p.toml")).unwrap();
    let place = |begin: &str| {
        let line = text.lines().find(|line| line.starts_with(begin)).unwrap();
        line.rsplit_once("# ").map(|(_, place)| place.to_owned()).unwrap()
    };
    let found = ["k = ", "scale = ", "set = { x_0 = ", "logarithm = "].map(place);
    assert_eq!(found, ["p.tsv:2", "p.tsv:3", "c.tsv:2", "o.tsv:3"], "{text}");
}

/// Of one measurement no deviation can be estimated: its parameter is searched within its bounds.
#[test]
fn deviations_of_few_measurements_are_parameters() {
    let here = problem();
    let change = |file: &str, old: &str, new: &str| {
        let path = here.path().join(file);
        let text = fs::read_to_string(&path).unwrap();
        assert!(text.contains(old), "{old}");
        fs::write(path, text.replacen(old, new, 1)).unwrap();
    };
    change("p.tsv", "k\t", "sd\tlog10\t0.01\t10\t1\t1\nk\t");
    change("m.tsv", "\t1\t0.03", "\t1\tsd");
    let (code, out, errors) = gapi(&here, &["identify", "p.yaml", "--out", "fit"]);
    assert_eq!(code, 0, "{out}{errors}");
    let text = fs::read_to_string(here.path().join("fit/result.json")).unwrap();
    let result: serde_json::Value = serde_json::from_str(&text).unwrap();
    let parameters = result["parameters"].as_array().unwrap();
    let sd = parameters.iter().find(|own| own["name"] == "sd").unwrap();
    // The measurement is exact.
    assert!((sd["value"].as_f64().unwrap() - 0.01).abs() < 1e-6, "{sd}");
}

/// Imports a document of `tests/exchange` with a part of it replaced: what is said, or the model.
fn changed(file: &str, old: &str, new: &str) -> Result<String, String> {
    let text = fs::read_to_string(project("tests/exchange").join(file)).unwrap();
    assert!(text.contains(old), "{old}");
    let here = folder(&[("model.xml", &text.replacen(old, new, 1))]);
    let (code, _, errors) = gapi(&here, &["import", "model.xml", "--out", "m"]);
    if code != 0 {
        return Err(errors);
    }
    let model = fs::read_dir(here.path().join("m")).unwrap().next().unwrap().unwrap().path();
    Ok(fs::read_to_string(model).unwrap())
}

#[test]
fn what_a_model_does_not_say_is_refused_at_its_line() {
    let law = "<kineticLaw><math xmlns=\"http://www.w3.org/1998/Math/MathML\"><apply><times/><ci>k</ci>\
               <ci>S</ci><ci>V</ci></apply></math></kineticLaw>";
    for (old, new, said, line) in [
        ("species=\"S\"", "species=\"Q\"", "no species `Q` is declared", 24),
        (" initialConcentration=\"3\"", "", "`S` has no initial value", 8),
        (law, "", "the reaction `decay` has no kinetic law", 24),
        (law, "<kineticLaw/>", "the reaction `decay` has no kinetic law", 24),
        ("compartment=\"V\"", "compartment=\"W\"", "no compartment `W` is declared", 8),
        ("size=\"2\" ", "", "`V` has no initial value", 5),
        ("<ci>k</ci><ci>S</ci>", "<ci>q</ci><ci>S</ci>", "nothing declares `q`", 24),
        (
            "<ci>V</ci></apply><ci>time",
            "<ci>V</ci></apply><ci>total",
            "`total` depends on itself",
            21,
        ),
    ] {
        let errors = changed("volume.xml", old, new).unwrap_err();
        let place = format!("model.xml:{line}:");
        assert!(errors.contains(said) && errors.contains(&place), "{said} {place}\n{errors}");
    }
}

/// f1(x) = x + x, f2(x) = f1(f1(x)), f3(x) = f2(f2(x)) …: each has the square of the terms of the one before.
#[test]
fn function_definitions_that_multiply_are_refused() {
    let math =
        |inner: &str| format!("<math xmlns=\"http://www.w3.org/1998/Math/MathML\">{inner}</math>");
    let mut definitions = "<listOfFunctionDefinitions>".to_owned();
    for k in 1..9 {
        let body = match k {
            1 => "<apply><plus/><ci>x</ci><ci>x</ci></apply>".to_owned(),
            _ => {
                let call = |inner: &str| format!("<apply><ci>f{}</ci>{inner}</apply>", k - 1);
                call(&call("<ci>x</ci>"))
            }
        };
        let lambda = format!("<lambda><bvar><ci>x</ci></bvar>{body}</lambda>");
        definitions +=
            &format!("<functionDefinition id=\"f{k}\">{}</functionDefinition>", math(&lambda));
    }
    let new = format!("{definitions}</listOfFunctionDefinitions><listOfCompartments>");
    let errors = changed("volume.xml", "<listOfCompartments>", &new).unwrap_err();
    assert!(errors.contains("become too many terms"), "{errors}");
}

/// a1 = a0², a2 = a1² …: what is delayed contains a power of two of terms.
#[test]
fn rules_that_multiply_are_refused() {
    let math =
        |inner: &str| format!("<math xmlns=\"http://www.w3.org/1998/Math/MathML\">{inner}</math>");
    let rule = |name: &str, inner: &str| {
        format!("<assignmentRule variable=\"{name}\">{}</assignmentRule>", math(inner))
    };
    let mut declared = String::new();
    let mut rules = rule("a0", "<ci>S</ci>");
    for k in 0..60 {
        declared += &format!("<parameter id=\"a{k}\" constant=\"false\"/>");
        let inner = format!("<apply><times/><ci>a{k}</ci><ci>a{k}</ci></apply>");
        rules += &rule(&format!("a{}", k + 1), &inner);
    }
    declared +=
        "<parameter id=\"a60\" constant=\"false\"/><parameter id=\"d\" constant=\"false\"/>";
    let delay = "<csymbol definitionURL=\"http://www.sbml.org/sbml/symbols/delay\"/>";
    rules += &rule("d", &format!("<apply>{delay}<ci>a60</ci><cn>1</cn></apply>"));
    let old = "<parameter id=\"k\" value=\"0.5\" constant=\"true\"/>";
    let text = fs::read_to_string(project("tests/exchange").join("volume.xml")).unwrap();
    let text = text.replacen(old, &format!("{old}{declared}"), 1);
    let text = text.replacen("<listOfRules>", &format!("<listOfRules>{rules}"), 1);
    let here = folder(&[("model.xml", &text)]);
    let (code, _, errors) = gapi(&here, &["import", "model.xml", "--out", "m"]);
    assert!(code == 1 && errors.contains("become too many terms"), "{errors}");
}

#[test]
fn notes_are_comments_of_what_they_are_about() {
    let model = changed(
        "volume.xml",
        "constant=\"false\"/>\n      <species id=\"time\"",
        "constant=\"false\">\
                        <notes><p>Measured by\nNMR.</p></notes></species>\n      <species id=\"time\"",
    );
    let model = model.unwrap();
    let (_, after) =
        model.split_once("  // Measured by NMR.\n  Real S").unwrap_or_else(|| panic!("{model}"));
    assert!(after.starts_with(['_', ';', '(', ' ']), "{model}");
}

/// The folder that a variable names; says where there is none.
fn collection(variable: &str) -> Option<PathBuf> {
    let found = std::env::var_os(variable).map(PathBuf::from);
    if found.is_none() {
        eprintln!("skipped: {variable} is not set");
    }
    found
}

/// A case of the SBML test suite.
struct Case {
    folder: PathBuf,
    name: String,
    settings: BTreeMap<String, String>,
}

impl Case {
    /// `None` for cases of packages, of fast reactions and of other kinds than time courses.
    fn read(folder: &Path) -> Option<Case> {
        let name = folder.file_name()?.to_str()?.to_owned();
        let about =
            String::from_utf8_lossy(&fs::read(folder.join(format!("{name}-model.m"))).ok()?)
                .into_owned();
        let tags: Vec<&str> = about.lines().filter(|line| line.contains("Tags:")).collect();
        let others = ["comp:", "fbc:", "FastReaction"];
        let is_other = tags.iter().any(|tags| others.iter().any(|tag| tags.contains(tag)));
        let is_course =
            about.lines().any(|line| line.starts_with("testType:") && line.contains("TimeCourse"));
        if is_other || !is_course {
            return None;
        }
        let settings = fs::read_to_string(folder.join(format!("{name}-settings.txt"))).ok()?;
        let settings = settings.lines().filter_map(|line| line.split_once(':'));
        let settings =
            settings.map(|(key, value)| (key.trim().to_owned(), value.trim().to_owned()));
        Some(Case { folder: folder.to_owned(), name, settings: settings.collect() })
    }

    fn number(&self, key: &str) -> f64 {
        self.settings[key].parse().unwrap()
    }

    /// The document of the newest level and version.
    fn document(&self) -> PathBuf {
        let versions = ["l3v2", "l3v1", "l2v5", "l2v4", "l2v3", "l2v2", "l2v1"];
        let paths =
            versions.iter().map(|own| self.folder.join(format!("{}-sbml-{own}.xml", self.name)));
        paths.into_iter().find(|path| path.exists()).unwrap()
    }

    /// What is wrong with the simulation.
    fn fault(&self) -> Option<String> {
        let here = folder(&[]);
        let document = self.document();
        let (code, _, errors) = gapi(&here, &["import", document.to_str()?, "--out", "m"]);
        if code != 0 {
            return Some(errors);
        }
        let model = fs::read_dir(here.path().join("m")).ok()?.next()?.ok()?.path();
        let stop = self.number("start") + self.number("duration");
        let steps = self.number("steps") * stop / self.number("duration");
        let (stop, steps) = (stop.to_string(), steps.round().to_string());
        let model = model.to_str()?;
        let simulate = ["simulate", model, "--stop-time", &stop, "--intervals", &steps];
        let output = ["--tolerance", "1e-9", "--no-cache", "-o", "r.csv"];
        let (code, _, errors) = gapi(&here, &[&simulate[..], &output[..]].concat());
        if code != 0 {
            return Some(errors);
        }
        let found = fs::read_to_string(here.path().join("r.csv")).ok()?;
        let expected =
            fs::read_to_string(self.folder.join(format!("{}-results.csv", self.name))).ok()?;
        self.difference(&rows(&found), &rows(&expected), &fs::read_to_string(document).ok()?)
    }

    /// The first value that is not the expected one.
    fn difference(&self, found: &Table, expected: &Table, document: &str) -> Option<String> {
        let [absolute, relative] = ["absolute", "relative"].map(|key| self.number(key));
        let amounts: Vec<&str> = self.settings["amount"].split(',').map(str::trim).collect();
        for row in &expected.rows {
            let near = |own: &&Vec<f64>| (own[0] - row[0]).abs() <= 1e-6 * row[0].abs().max(1e-3);
            let own = found.rows.iter().rev().find(near);
            let Some(own) = own else { return Some(format!("no row at {}", row[0])) };
            for (name, value) in expected.names.iter().zip(row).skip(1) {
                let Some(mut is) = found.value(own, name) else {
                    return Some(format!("no {name}"));
                };
                if let Some(species) = tag(document, name) {
                    let size =
                        attribute(species, "compartment").and_then(|of| found.value(own, of));
                    let is_amount = attribute(species, "hasOnlySubstanceUnits") == Some("true");
                    match (amounts.contains(&name.as_str()), is_amount) {
                        (true, false) => is *= size.unwrap_or(1.0),
                        (false, true) => is /= size.unwrap_or(1.0),
                        _ => {}
                    }
                }
                let equal = is == *value || is.is_nan() && value.is_nan();
                if !equal
                    && (is - value)
                        .abs()
                        .partial_cmp(&(absolute + relative * value.abs()))
                        .is_none_or(Ordering::is_gt)
                {
                    return Some(format!("{name} is {is} at {}, not {value}", row[0]));
                }
            }
        }
        None
    }
}

/// The start tag of the species with this identifier.
fn tag<'a>(document: &'a str, id: &str) -> Option<&'a str> {
    let tags = document.split("<species ").skip(1).filter_map(|text| text.split('>').next());
    tags.into_iter().find(|tag| attribute(tag, "id") == Some(id))
}

fn attribute<'a>(tag: &'a str, name: &str) -> Option<&'a str> {
    let start = tag.split_once(&format!("{name}=\""))?.1;
    start.split('"').next()
}

/// A table of numbers.
struct Table {
    names: Vec<String>,
    rows: Vec<Vec<f64>>,
}

impl Table {
    fn value(&self, row: &[f64], name: &str) -> Option<f64> {
        let quoted = format!("'{name}'");
        let place = self.names.iter().position(|own| *own == quoted);
        let place = place.or_else(|| self.names.iter().position(|own| own == name));
        Some(row[place?])
    }
}

fn rows(text: &str) -> Table {
    let mut lines = text.lines().filter(|line| !line.trim().is_empty());
    let names = lines.next().unwrap_or_default().split(',');
    let names = names.map(|name| name.trim().trim_matches('"').to_owned()).collect();
    let number = |text: &str| match text.trim() {
        "INF" => f64::INFINITY,
        "-INF" => f64::NEG_INFINITY,
        text => text.parse().unwrap_or(f64::NAN),
    };
    Table { names, rows: lines.map(|line| line.split(',').map(number).collect()).collect() }
}

/// The semantic cases of the SBML test suite, in the folder that `GAPILIB_SBML` names.
#[test]
fn the_semantic_suite_of_sbml_has_its_results() {
    let Some(folder) = collection("GAPILIB_SBML") else { return };
    let mut folders: Vec<PathBuf> =
        fs::read_dir(folder).unwrap().map(|own| own.unwrap().path()).collect();
    folders.sort();
    let cases: Vec<Case> = folders.iter().filter_map(|folder| Case::read(folder)).collect();
    let wrong: Vec<String> = cases
        .iter()
        .filter_map(|case| Some(format!("{}: {}", case.name, case.fault()?.lines().next()?)))
        .collect();
    eprintln!("{} of {} cases\n{}", cases.len() - wrong.len(), cases.len(), wrong.join("\n"));
    assert!(!cases.is_empty(), "`GAPILIB_SBML` names a folder without cases");
    assert!(wrong.len() * 100 <= 3 * cases.len(), "{}", wrong.join("\n"));
}

/// The problems of the benchmark collection, in its folder `Benchmark-Models`, which `GAPILIB_PETAB`
/// names: each is imported, and its model checked, unless the collection lacks a file of it.
#[test]
fn problems_of_the_benchmark_collection_are_imported() {
    let Some(collection) = collection("GAPILIB_PETAB") else { return };
    let mut folders: Vec<PathBuf> =
        fs::read_dir(collection).unwrap().map(|own| own.unwrap().path()).collect();
    folders.sort();
    let (mut wrong, mut imported) = (Vec::new(), 0);
    for path in folders {
        let name = path.file_name().unwrap().to_str().unwrap().to_owned();
        let own = path.join(format!("{name}.yaml"));
        let file = if own.exists() { own } else { path.join("problem.yaml") };
        let here = folder(&[]);
        let (code, _, errors) = gapi(&here, &["import", file.to_str().unwrap(), "--out", "p"]);
        let is_missing = errors.contains("cannot read");
        if code != 0 && is_missing {
            eprintln!("{name}: {}", errors.lines().next().unwrap_or_default());
            continue;
        }
        let (checked, out, more) = gapi(&here, &["check", "p"]);
        eprintln!("{name}: imported");
        imported += 1;
        if code != 0 || checked != 0 {
            wrong.push(format!("{name}: {errors}{out}{more}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(imported > 0, "`GAPILIB_PETAB` names a folder without problems");
}
