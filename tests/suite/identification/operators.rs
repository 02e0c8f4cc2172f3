//! The operators of the genetic algorithm that users choose: every entry of the tables in a
//! problem, functions in Modelica in the place of any, and both in scripts.

use crate::support::program::{folder, gapi};
use crate::support::shipped::{self, project};
use gapilib::Value;
use gapilib::internals::ga::operators::KINDS;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// The shipped polarization curve with this `[method]` and so many evaluations, and the functions
/// of `tests/operators`.
fn polarization(method: &str, evaluations: u32) -> TempDir {
    let text = fs::read_to_string(project("scripts/problems/polarization.toml")).unwrap();
    let place = |path: &str| project(path).display().to_string().replace('\\', "/");
    let (problem, _) = text.split_once("[method]").expect("the last tables");
    let problem = problem.replace("../data", &place("scripts/data"));
    let problem = format!(
        "files = [\"{}\"]\n{problem}[method]\npolish = false\n{method}\n[stop]\nevaluations = {evaluations}\n",
        place("tests/operators/Own.mo")
    );
    folder(&[("p.toml", &problem)])
}

/// A problem file opens nothing by itself: the functions and the data lie outside of its folder.
const IDENTIFY: [&str; 3] =
    ["identify", "p.toml", concat!("--allow-read=", env!("CARGO_MANIFEST_DIR"))];

/// What a run says.
fn solved(here: &TempDir, arguments: &[&str]) -> String {
    let (code, out, errors) = gapi(here, &[&IDENTIFY[..], arguments].concat());
    assert_eq!(code, 0, "{out}{errors}");
    out + &errors
}

/// All result files but the one with the time.
fn files(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let mut all: Vec<(String, Vec<u8>)> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .map(|path| {
            (path.file_name().unwrap().to_string_lossy().into_owned(), fs::read(&path).unwrap())
        })
        .filter(|(name, _)| name != "timing.json")
        .collect();
    all.sort();
    all
}

fn result(here: &TempDir, out: &str) -> serde_json::Value {
    serde_json::from_str(&fs::read_to_string(here.path().join(out).join("result.json")).unwrap())
        .unwrap()
}

/// What is the same wherever the operators do the same: the course of the run.
fn course(here: &TempDir, out: &str) -> String {
    let read = |name: &str| fs::read_to_string(here.path().join(out).join(name)).unwrap();
    read("history.csv") + &read("individuals.csv")
}

/// Each entry of each table on its own, beside the usual ones: the same bytes on one thread and on
/// two, the operator in the results, and what was found as it was recorded.
#[test]
fn every_operator_runs_with_equal_bytes_on_any_number_of_threads() {
    let mut found = String::new();
    for kind in &KINDS {
        for entry in (kind.entries)() {
            let method = format!("{} = \"{}\"", kind.name, entry.name);
            let here = polarization(&method, 400);
            let text = solved(&here, &["--threads", "1", "--out", "one"]);
            assert!(text.contains(&format!("operators    {} {}", kind.name, entry.name)), "{text}");
            solved(&here, &["--threads", "2", "--out", "two"]);
            let [one, two] = ["one", "two"].map(|out| files(&here.path().join(out)));
            assert_eq!(one.len(), two.len());
            for (one, two) in one.iter().zip(&two) {
                assert!(one == two, "{method}: {} differs", one.0);
            }
            let result = result(&here, "one");
            assert_eq!(result["operators"][kind.name], entry.name);
            // The same bits on every machine, but what least squares end with is known to fewer.
            found += &format!("{method}: {:.5e}", result["fitness"].as_f64().unwrap());
            for parameter in result["parameters"].as_array().unwrap() {
                found += &format!(" {:.4e}", parameter["value"].as_f64().unwrap());
            }
            found += "\n";
        }
    }
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path(project("tests/operators"));
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings.bind(|| insta::assert_snapshot!("runs", found));
}

/// Naming the usual operators changes nothing but the record of them.
#[test]
fn the_usual_operators_by_name_are_those_without_a_name() {
    let usual = "sampling = \"lhs\"\nselection = \"tournament(size = 2)\"\n\
                 crossover = { name = \"sbx\", eta = 15, probability = 0.9 }\n\
                 mutation = \"polynomial(eta = 20)\"\nsurvival = \"elitism\"";
    let paper = "name = \"gapilib2006\"\nsampling = \"uniform\"\nselection = \"truncation(share = 1)\"\n\
                 crossover = \"fixed_points\"\nmutation = \"uniform(rate = 0.25)\"";
    for (plain, named) in [("", usual), ("name = \"gapilib2006\"", paper)] {
        let courses = [plain, named].map(|method| {
            let here = polarization(method, 400);
            solved(&here, &["--out", "out"]);
            (course(&here, "out"), result(&here, "out")["operators"].clone())
        });
        assert_eq!(courses[0].0, courses[1].0, "{named}");
        assert!(courses[0].1.is_null() && courses[1].1.is_object());
    }
}

/// A function in Modelica that does the same takes the same course.
#[test]
fn a_function_of_the_user_takes_the_place_of_any_operator() {
    for (entry, own) in [
        ("sampling = \"uniform\"", "sampling = \"Own.uniformSampling\""),
        ("selection = \"linear_ranking(pressure = 2)\"", "selection = \"Own.ranking\""),
        // Ranks do not depend on the order in which survivors stand.
        (
            "selection = \"ranking\"\nsurvival = \"generational\"",
            "selection = \"ranking\"\nsurvival = \"Own.offspring\"",
        ),
    ] {
        let courses = [entry, own].map(|method| {
            let here = polarization(method, 300);
            solved(&here, &["--out", "out"]);
            course(&here, "out")
        });
        assert!(courses[0] == courses[1], "{own}");
    }
    let all = "crossover = \"Own.mean(probability = 1)\"\nmutation = { name = \"Own.draw\", rate = 0.1 }\n\
               selection = \"Own.ranking\"";
    for name in ["genetic", "gapilib2006"] {
        let here = polarization(&format!("name = \"{name}\"\n{all}"), 600);
        solved(&here, &["--out", "one", "--threads", "1"]);
        solved(&here, &["--out", "two", "--threads", "2"]);
        assert!(files(&here.path().join("one")) == files(&here.path().join("two")));
        let found = result(&here, "one");
        assert_eq!(found["operators"]["crossover"], "Own.mean(probability = 1)");
        assert!(found["fitness"].as_f64().unwrap() < 0.05, "{found}");
    }
}

/// Genes outside the ranges are set to their ends.
#[test]
fn genes_of_own_operators_stay_within_the_ranges() {
    let here = polarization("crossover = \"Own.far(probability = 1)\"\nmutation = 0", 200);
    solved(&here, &["--out", "out"]);
    let individuals = fs::read_to_string(here.path().join("out/individuals.csv")).unwrap();
    let column = |k: usize| {
        individuals
            .lines()
            .skip(1)
            .map(move |line| line.split(',').nth(k).unwrap().parse().unwrap())
    };
    for (k, [min, max]) in [[0.01, 0.1], [1e-5, 0.05], [1e-9, 1e-3]].into_iter().enumerate() {
        let close = |a: f64, b: f64| (a - b).abs() <= 1e-12 * b;
        let values: Vec<f64> = column(k).collect();
        assert!(values.iter().all(|v| (min * (1.0 - 1e-12)..=max * (1.0 + 1e-12)).contains(v)));
        assert!(values.iter().any(|v| close(*v, max)) && values.iter().any(|v| close(*v, min)));
    }
}

#[test]
fn what_is_wrong_with_a_choice_is_said_with_its_place() {
    for (method, said) in [
        (
            "crossover = \"sbxx\"",
            "unknown crossover `sbxx`|did you mean `sbx`?|known: sbx, blend|crossover = \"sbxx\"\n",
        ),
        (
            "crossover = { name = \"sbx\", etta = 5 }",
            "crossover `sbx`: unknown option `etta`|did you mean `eta`?",
        ),
        ("selection = \"tournament(size = 2.5)\"", "`size` is 2.5, which is not a whole number"),
        (
            "mutation = { name = \"gaussian\", sigma = nan }",
            "mutation `gaussian`: `sigma` is NaN, outside",
        ),
        (
            "mutation = \"gaussian(rate = 1.5)\"",
            "mutation `gaussian`: `rate` is 1.5, outside 0 to 1",
        ),
        ("mutation = inf", "`mutation` is inf, outside 0 to 1"),
        ("selection = 3", "`3` is not an operator"),
        ("survival = [1]", "expected an operator, such as"),
        ("sampling = \"sobol(\"", "`sobol(` is not a name with settings"),
        ("survival = \"crowding\"\nelites = 2", "unknown option `elites`"),
        (
            "name = \"cma_es\"\ncrossover = \"sbx\"",
            "`cma_es` has no selectable crossover|genetic, gapilib2006, nsga2",
        ),
        ("name = \"gapilib2006\"\nsurvival = \"plus\"", "`gapilib2006` keeps its elites"),
        (
            "crossover = \"Own.draw\"",
            "`Own.draw` has 6 inputs and 1 output, but a crossover has 5 inputs and 2 outputs|output Real child2[:];",
        ),
        ("mutation = \"Own.lost\"", "mutation `Own.lost`"),
        ("selection = \"Own.refuses\"", "selection `Own.refuses`: |the third is too many"),
    ] {
        let here = polarization(method, 200);
        let (code, out, errors) = gapi(&here, &[&IDENTIFY[..], &["--out", "out"]].concat());
        let text = out + &errors;
        assert_eq!(code, 1, "{method}: {text}");
        said.split('|').for_each(|part| assert!(text.contains(part), "{method}: {text}"));
        assert!(!here.path().join("out/run.journal").exists(), "{method}: nothing to resume");
    }
}

const DATA: &str = "
Low := {0.0, 10.0}; High := {1.0, 30.0};
Seed := [12345, 12345, 12345, 12345, 12345, 12345];
";

/// The entry and the function of the script that does the same: equal bits, seeds included.
#[test]
fn scripts_choose_operators_by_name() {
    let own = fs::read_to_string(project("tests/operators/Own.mo")).unwrap();
    let pairs = [
        ("Op_Sampling(OP, 7, Low, High, Seed)", "uniform", "Own.uniformSampling"),
        (
            "Op_Selection(OP, {3.0, 1.0, 2.0, 5.0}, 9, Seed)",
            "linear_ranking(pressure = 2)",
            "Own.ranking",
        ),
        (
            "Op_Survival(OP, [1; 2], {1.0, 4.0}, [3; 4], {2.0, 3.0}, 3)",
            "mu_plus_lambda",
            "Own.best",
        ),
    ];
    let mut text = format!("{own}{DATA}");
    for (k, (call, entry, function)) in pairs.iter().enumerate() {
        for (prefix, name) in [("a", entry), ("b", function)] {
            let call = call.replace("OP", &format!("\"{name}\""));
            text += &format!("({prefix}{k}, {prefix}s{k}) := {call};\n");
        }
    }
    text += "Pop := [0.1, 11; 0.9, 29; 0.5, 20];
      (c, s) := Op_Crossover(\"arithmetic\", Pop[1:2,:], Low, High, Seed);
      (d, s) := Op_Crossover(\"Own.mean\", Pop[1:2,:], Low, High, Seed);
      (m, s) := Op_Mutation(\"uniform\", [0.5], 0.9, {0.0}, {1.0}, Seed);
      (n, s) := Op_Mutation(\"Own.draw\", [0.5], 0.9, {0.0}, {1.0}, Seed);
      (e, s) := Op_Mutation(\"gaussian\", Pop, 1, Low, High, Seed, 2);
      (Places, s) := Op_Selection(\"shuffle\", {1.0, 2.0, 3.0}, 3, Seed);
      (g, h) := Op_Survival(\"crowding\", Pop, {1.0, 2.0, 3.0}, Pop[Places,:], {0.5, 0.5, 0.5}, 3,
        Places = Places, Param_Min = Low, Param_Max = High);\n";
    let run = shipped::run("operators.mos", &text);
    assert_eq!(run.errors, "");
    let value = |name: &str| run.session.variable(name).cloned().expect("a variable");
    for (k, (call, ..)) in pairs.iter().enumerate() {
        assert_eq!(value(&format!("a{k}")), value(&format!("b{k}")), "{call}");
        assert_eq!(value(&format!("as{k}")), value(&format!("bs{k}")), "{call}");
    }
    let numbers = |name: &str| value(name).as_vector().unwrap_or_else(|_| panic!("{name}"));
    let matrix = |name: &str| match value(name) {
        Value::Array(array) => format!("{:?}", array.elements),
        other => panic!("{other:?}"),
    };
    assert_eq!(matrix("c"), matrix("d"));
    assert_eq!(matrix("m"), matrix("n"));
    assert_ne!(value("as0"), value("Seed"), "the seed goes on");
    assert!(
        matrix("e").starts_with("Real([0.1, 11.0, 0.9, 29.0, "),
        "elites stay: {}",
        matrix("e")
    );
    assert_eq!(numbers("h"), [0.5, 0.5, 0.5]);
}

#[test]
fn scripts_are_told_what_is_wrong_with_an_operator() {
    for (call, said) in [
        ("Op_Sampling(\"halten\", 3, Low, High, Seed)", "unknown sampling `halten`"),
        ("Op_Selection(\"tournament(sice = 3)\", {1.0}, 3, Seed)", "unknown option `sice`"),
        ("Op_Selection(\"tournament\", fill(0.0, 0), 3, Seed)", "`Fit` is empty"),
        ("Op_Crossover(\"sbx\", [0.5], Low, High, Seed)", "`Param_Min` has 2 elements"),
        ("Op_Mutation(\"gaussian\", [0.5, 11], 2, Low, High, Seed)", "F_Mut is 2"),
        ("Op_Survival(\"crowding\", [1], {1}, [1], {1}, 1)", "needs the parents"),
        ("Op_Survival(\"plus\", [1], {1, 2}, [1], {1}, 1)", "`Fit` has 2 elements"),
        ("Op_Sampling(\"uniform\", -1, Low, High, Seed)", "`N_Individuals` is -1"),
    ] {
        let run = shipped::run("operators.mos", &format!("{DATA}x := {call};\n"));
        assert!(run.errors.contains(said), "{call}: {}", run.errors);
    }
}

/// The guide has every operator with its settings and its source.
#[test]
fn the_guide_names_every_operator_with_its_settings_and_its_source() {
    let chapter = fs::read_to_string(project("docs/src/operators.md")).unwrap();
    for kind in &KINDS {
        let title = format!("\n## {}{}\n", kind.name[..1].to_uppercase(), &kind.name[1..]);
        let (_, section) = chapter.split_once(&title).expect("a section of each kind");
        let section = section.split("\n## ").next().unwrap_or_default();
        for entry in (kind.entries)() {
            let begin = format!("| `{}` |", entry.name);
            let row = section.lines().find(|line| line.starts_with(&begin));
            let row = row.unwrap_or_else(|| panic!("{}: no row `{begin}`", kind.name));
            // Keys are names and a year.
            let source = row.rsplit('|').nth(1).unwrap_or_default().to_lowercase();
            let source = source.replace('ä', "a").replace(' ', "-");
            for word in entry.reference.split('-') {
                assert!(source.contains(word), "{row}: {}", entry.reference);
            }
            for setting in entry.settings {
                assert!(row.contains(&format!("`{}`", setting.name)), "{row}: {}", setting.name);
            }
        }
    }
}
