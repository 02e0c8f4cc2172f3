//! `gapi identify` as a user starts it: real data, inputs that follow data, and runs that are
//! killed.

use crate::shipped::project;
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::time::Duration;
use tempfile::TempDir;

fn command(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_gapi"));
    command.arg("identify").args(arguments).current_dir(folder).env_remove("MODELICAPATH");
    command
}

fn run(folder: &Path, arguments: &[&str]) -> (i32, String) {
    let Output { status, stdout, stderr } = command(folder, arguments).output().unwrap();
    let text = [stdout, stderr].map(|bytes| String::from_utf8(bytes).unwrap()).concat();
    (status.code().expect("ended by itself"), text)
}

fn result(folder: &Path, out: &str) -> Value {
    serde_json::from_str(&fs::read_to_string(folder.join(out).join("result.json")).unwrap())
        .unwrap()
}

fn value(result: &Value, name: &str) -> f64 {
    let all = result["parameters"].as_array().unwrap();
    all.iter().find(|p| p["name"] == name).unwrap()["value"].as_f64().unwrap()
}

#[test]
fn the_shipped_problem_reaches_the_best_known_sum_of_squares() {
    let folder = tempfile::tempdir().unwrap();
    let problem = project("scripts/problems/polarization.toml");
    let (code, text) = run(folder.path(), &[problem.to_str().unwrap(), "--out", "out"]);
    assert_eq!(code, 0, "{text}");
    let result = result(folder.path(), "out");
    // 2.462e-6 is the best that is known of these data; some have ended in a local optimum.
    assert!(result["fitness"].as_f64().unwrap() < 2.4625e-6, "{text}");
    assert!(result["evaluations"].as_u64().unwrap() <= 5100, "{text}");
    assert!(text.contains("cannot be determined from these data"), "{text}");
    for file in ["history.csv", "fit.csv", "individuals.csv", "Calibrated.mo", "report.html"] {
        assert!(folder.path().join("out").join(file).is_file(), "{file}");
    }
    assert!(!folder.path().join("out/run.journal").exists(), "the run has ended");
}

const TANK: &str = "model Tank
  parameter Real k = 1;
  parameter Real area = 1;
  input Real u;
  Real h(start = 1, fixed = true);
equation
  area*der(h) = u - k*h;
end Tank;
";

/// Solved with a constant inflow in each of two halves: exact values of the exponentials.
fn filled_tank(folder: &Path) {
    let (k, area, h0) = (0.8_f64, 2.0, 0.3);
    let mut table = String::from("t,h,inflow\n");
    for n in 0..=40 {
        let t = f64::from(n) / 8.0;
        let (u, tau) = (0.6, area / k);
        let h = u / k + (h0 - u / k) * (-t / tau).exp();
        table += &format!("{t},{h},{u}\n");
    }
    fs::write(folder.join("tank.csv"), table).unwrap();
    fs::write(folder.join("tank.mo"), TANK).unwrap();
    let problem = "
model = \"Tank\"
files = [\"tank.mo\"]
[parameters]
k = { min = 0.05, max = 5 }
area = { min = 0.1, max = 20 }
h = { min = 0.01, max = 3, initial = true }
[[experiment]]
data = \"tank.csv\"
x = { variable = \"time\", column = \"t\" }
outputs = { h = \"h\" }
inputs = { u = \"inflow\" }
tolerance = 1e-8
[checkpoint]
generations = 1
[stop]
evaluations = 600
";
    fs::write(folder.join("tank.toml"), problem).unwrap();
}

#[test]
fn inputs_follow_the_data_and_initial_states_are_found() {
    let folder = tempfile::tempdir().unwrap();
    filled_tank(folder.path());
    let (code, text) = run(folder.path(), &["tank.toml"]);
    assert_eq!(code, 0, "{text}");
    let result = result(folder.path(), "results");
    for (name, truth) in [("k", 0.8), ("area", 2.0), ("h", 0.3)] {
        let found = value(&result, name);
        assert!((found - truth).abs() < 1e-3 * truth, "{name} = {found}\n{text}");
    }
}

/// A run that is killed again and again ends with the bytes of one that was not, on other numbers
/// of threads, too.
#[test]
fn killed_runs_resume_to_the_same_end() {
    let folder: TempDir = tempfile::tempdir().unwrap();
    filled_tank(folder.path());
    let (code, text) = run(folder.path(), &["tank.toml", "--out", "whole", "--threads", "2"]);
    assert_eq!(code, 0, "{text}");
    for kill in 0..5_u64 {
        let threads = ["1", "2", "3"][kill as usize % 3];
        let arguments = ["tank.toml", "--out", "cut", "--resume", "--threads", threads];
        let mut child = command(folder.path(), &arguments)
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        // Killed when some more of the run stands in the journal.
        let journal = folder.path().join("cut/run.journal");
        let length = || fs::metadata(&journal).map_or(0, |metadata| metadata.len());
        let before = length();
        for _ in 0..1000 {
            if length() > before + 100 || child.try_wait().unwrap().is_some() {
                break;
            }
            std::thread::sleep(Duration::from_millis(10));
        }
        std::thread::sleep(Duration::from_millis(7 * kill));
        // It may have ended by itself.
        let _ = child.kill();
        child.wait().unwrap();
    }
    let (code, text) = run(folder.path(), &["tank.toml", "--out", "cut", "--resume"]);
    assert_eq!(code, 0, "{text}");
    for file in ["result.json", "history.csv", "fit.csv", "individuals.csv", "Calibrated.mo"] {
        let read = |out: &str| fs::read(folder.path().join(out).join(file)).unwrap();
        assert!(read("cut") == read("whole"), "{file} differs\n{text}");
    }
}

#[test]
fn checkpoints_of_other_problems_and_damaged_ones_are_told() {
    let folder = tempfile::tempdir().unwrap();
    filled_tank(folder.path());
    fs::create_dir(folder.path().join("results")).unwrap();
    let journal = folder.path().join("results/run.journal");
    fs::write(&journal, "no journal").unwrap();
    let (code, text) = run(folder.path(), &["tank.toml"]);
    assert!(code == 1 && text.contains("--resume") && text.contains("--fresh"), "{text}");
    let (code, text) = run(folder.path(), &["tank.toml", "--resume"]);
    assert!(code == 1 && text.contains("no checkpoint"), "{text}");
    fs::write(&journal, b"GAPIRUN1\0\0\0\0\0\0\0\0").unwrap();
    let (code, text) = run(folder.path(), &["tank.toml", "--resume"]);
    assert!(code == 1 && text.contains("another problem"), "{text}");
    assert_eq!(fs::read(&journal).unwrap().len(), 16, "left as it was");
}
