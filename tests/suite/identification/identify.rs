//! `gapi identify` as a user starts it: real data, inputs that follow data, and runs that are
//! killed.

use crate::support::program;
use crate::support::shipped::project;
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};
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

/// The shipped problems with the best sums of squares that are known of their data.
const SHIPPED: [(&str, f64); 5] = [
    ("polarization", 2.462e-6),
    ("ballard_mark_v", 0.813_911_703),
    ("bcs_500w", 0.011_697_780_7),
    ("sr12", 1.056_628_35),
    ("nedstack_ps6", 2.065_556_91),
];

/// A problem file opens nothing by itself: these data lie outside of its folder.
const ALLOWED: &str = concat!("--allow-read=", env!("CARGO_MANIFEST_DIR"));

/// Some methods end in local optima of these data; `GAPILIB_SEEDS` sets how many seeds are tried.
#[test]
fn shipped_problems_reach_the_best_known_sums_of_squares() {
    let folder = tempfile::tempdir().unwrap();
    let seeds = std::env::var("GAPILIB_SEEDS").map_or(1, |text| text.parse().unwrap());
    for (name, best) in SHIPPED {
        let problem = project(&format!("scripts/problems/{name}.toml"));
        let text = fs::read_to_string(&problem).unwrap();
        let data = project("scripts/data");
        let text = text.replace("../data", &data.display().to_string().replace('\\', "/"));
        for seed in 1..=seeds {
            let entry = format!("seed = {:?}\n[parameters]", [f64::from(seed); 6]);
            fs::write(folder.path().join("p.toml"), text.replace("[parameters]", &entry)).unwrap();
            let (code, text) = run(folder.path(), &["p.toml", "--out", name, ALLOWED]);
            assert_eq!(code, 0, "{text}");
            let result = result(folder.path(), name);
            let found = result["fitness"].as_f64().unwrap();
            assert!(found < best * 1.0002, "{name}, seed {seed}: {found}\n{text}");
            // The last question may go beyond the limit.
            assert!(result["simulations"].as_u64().unwrap() <= 5000, "{text}");
            assert!(text.contains("non-identifiable"), "{text}");
            let files = ["history.csv", "fit.csv", "individuals.csv", "Calibrated.mo"];
            for file in files.into_iter().chain(["report.html"]) {
                assert!(folder.path().join(name).join(file).is_file(), "{file}");
            }
            assert!(!folder.path().join(name).join("run.journal").exists(), "the run has ended");
        }
    }
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
    for n in 0..=20 {
        let t = f64::from(n) / 4.0;
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
evaluations = 300
";
    fs::write(folder.join("tank.toml"), problem).unwrap();
}

#[test]
fn inputs_follow_the_data_and_initial_states_are_found() {
    let folder = tempfile::tempdir().unwrap();
    filled_tank(folder.path());
    let (code, text) = run(folder.path(), &["tank.toml"]);
    assert_eq!(code, 0, "{text}");
    let result = result(folder.path(), "results/tank");
    for (name, truth) in [("k", 0.8), ("area", 2.0), ("h", 0.3)] {
        let found = value(&result, name);
        assert!((found - truth).abs() < 1e-3 * truth, "{name} = {found}\n{text}");
    }
}

#[test]
fn a_script_puts_a_problem_together() {
    let folder = tempfile::tempdir().unwrap();
    filled_tank(folder.path());
    let script = "
problem = GAPILib.Problem(modelName = \"Tank\", files = {\"tank.mo\"},
  parameters = {GAPILib.Free(\"k\", min = 0.05, max = 5), GAPILib.Free(\"area\", min = 0.1, max = 20),
                GAPILib.Free(\"h\", min = 0.01, max = 3, initialValue = true)},
  experiments = {GAPILib.Experiment(data = \"tank.csv\", xColumn = \"t\", outputs = {\"h\"},
                                    inputs = {\"u\"}, inputColumns = {\"inflow\"}, tolerance = 1e-8)},
  evaluations = 300);
(values, fitness, deviations) = identify(problem);
print(\"k area h: \" + String(integer(1e3*values[1] + 0.5)) + \" \" + String(integer(1e3*values[2] + 0.5)) + \" \" + String(integer(1e3*values[3] + 0.5)))
";
    fs::write(folder.path().join("s.mos"), script).unwrap();
    let output = Command::new(env!("CARGO_BIN_EXE_gapi"))
        .args(["run", "s.mos"])
        .current_dir(folder.path())
        .env_remove("MODELICAPATH")
        .output()
        .unwrap();
    let text = [output.stdout, output.stderr].map(|b| String::from_utf8(b).unwrap()).concat();
    assert!(text.contains("k area h: 800 2000 300"), "{text}");
    assert!(folder.path().join("results/s/report.html").is_file());
}

/// What is known of errors and parameters means in a script what it means in a file.
#[test]
fn scripts_have_errors_and_priors() {
    let folder = tempfile::tempdir().unwrap();
    cooling(folder.path());
    let file = "model = \"Cooling\"
files = [\"cooling.mo\"]
[parameters]
k = { min = 0.05, max = 5, prior = { mean = 0.9, sd = 0.05 } }
low = { min = 0.1, max = 20 }
[[experiment]]
data = \"cooling.csv\"
x = { variable = \"time\", column = \"t\" }
outputs = { h = { column = \"h\", sigma = \"0.3*low\", error = \"student\", degrees_of_freedom = 3 } }
[method]
name = \"levenberg_marquardt\"
";
    let script = "problem = GAPILib.Problem(modelName = \"Cooling\", files = {\"cooling.mo\"},
  parameters = {GAPILib.Free(\"k\", min = 0.05, max = 5, prior = \"normal(mean = 0.9, sd = 0.05)\"),
                GAPILib.Free(\"low\", min = 0.1, max = 20)},
  experiments = {GAPILib.Experiment(data = \"cooling.csv\", xColumn = \"t\", outputs = {\"h\"},
    deviations = {\"0.3*low\"}, errors = {\"student\"}, degreesOfFreedom = {3})},
  method = \"levenberg_marquardt\");
identify(problem);
";
    fs::write(folder.path().join("f.toml"), file).unwrap();
    fs::write(folder.path().join("s.mos"), script).unwrap();
    let (code, text) = run(folder.path(), &["f.toml"]);
    assert_eq!(code, 0, "{text}");
    let gapi = |script: &str| {
        fs::write(folder.path().join("s.mos"), script).unwrap();
        let output = Command::new(env!("CARGO_BIN_EXE_gapi"))
            .args(["run", "s.mos"])
            .current_dir(folder.path())
            .env_remove("MODELICAPATH")
            .output()
            .unwrap();
        [output.stdout, output.stderr].map(|b| String::from_utf8(b).unwrap()).concat()
    };
    let text = gapi(script);
    let [one, other] = ["results/f", "results/s"].map(|own| {
        let result = result(folder.path(), own);
        assert!(result["negative_log_likelihood"].is_number(), "{text}");
        (result["negative_log_likelihood"].as_f64(), value(&result, "k"), value(&result, "low"))
    });
    assert_eq!(one, other, "{text}");
    let both = script.replace("deviations =", "sigmas = {0.1}, deviations =");
    let text = gapi(&both);
    assert!(text.contains("a number in `sigmas` and a string in `deviations`"), "{text}");
    let other = script.replace("sd = 0.05", "sigma = 0.05");
    let text = gapi(&other);
    assert!(text.contains("the prior of `k`") || text.contains("`sigma`"), "{text}");
}

/// The text of such a problem is nobody's: what is wrong is shown at the call.
#[test]
fn what_is_wrong_with_a_problem_of_a_script_is_shown_at_the_call() {
    let folder = tempfile::tempdir().unwrap();
    filled_tank(folder.path());
    for (data, output, message) in [
        ("none.csv", "h", "there is no file `none.csv`"),
        ("tank.csv", "level", "`tank.csv` has no column `level`"),
    ] {
        let script = format!(
            "problem = GAPILib.Problem(modelName = \"Tank\", files = {{\"tank.mo\"}},\n  \
             parameters = {{GAPILib.Free(\"k\", min = 0.05, max = 5)}},\n  experiments = \
             {{GAPILib.Experiment(data = \"{data}\", xColumn = \"t\", outputs = {{\"h\"}}, \
             columns = {{\"{output}\"}})}});\nidentify(problem);\n"
        );
        fs::write(folder.path().join("s.mos"), script).unwrap();
        let output = Command::new(env!("CARGO_BIN_EXE_gapi"))
            .args(["run", "s.mos"])
            .current_dir(folder.path())
            .env_remove("MODELICAPATH")
            .output()
            .unwrap();
        let text = String::from_utf8(output.stderr).unwrap();
        assert!(text.contains(message) && text.contains("s.mos:4:1"), "{text}");
        assert!(!text.contains("problem:"), "{text}");
    }
}

/// A simulation of this one takes a thirtieth of the time of one of the tank.
fn cooling(folder: &Path) {
    let model = "model Cooling
  parameter Real k = 1;
  parameter Real low = 1;
  Real h(start = 1, fixed = true);
equation
  der(h) = k*(low - h);
end Cooling;
";
    let row = |n: i32| {
        let t = f64::from(n) / 4.0;
        format!("{t},{:.4}\n", 0.5 + 1.2 * (-0.8 * t).exp())
    };
    let table: String = (0..=20).map(row).collect();
    let problem = "model = \"Cooling\"
files = [\"cooling.mo\"]
[parameters]
k = { min = 0.05, max = 5 }
low = { min = 0.1, max = 20 }
h = { min = 0.01, max = 3, initial = true }
[[experiment]]
data = \"cooling.csv\"
x = { variable = \"time\", column = \"t\" }
outputs = { h = \"h\" }
[checkpoint]
generations = 1
[stop]
evaluations = 600
";
    fs::write(folder.join("cooling.mo"), model).unwrap();
    fs::write(folder.join("cooling.csv"), format!("t,h\n{table}")).unwrap();
    fs::write(folder.join("cooling.toml"), problem).unwrap();
}

/// Kills in the suite; `GAPILIB_KILLS` sets another number.
const KILLS: u64 = 9;

#[test]
fn killed_runs_resume_to_the_same_end() {
    resumed_after_kills(std::env::var("GAPILIB_KILLS").map_or(KILLS, |text| text.parse().unwrap()));
}

#[test]
#[ignore = "some minutes"]
fn two_hundred_killed_runs_resume_to_the_same_end() {
    resumed_after_kills(200);
}

/// Ends a process by SIGKILL, SIGTERM or SIGHUP in turn.
#[cfg(unix)]
fn end(child: &mut std::process::Child, kills: u64) {
    let signal = ["-KILL", "-TERM", "-HUP"][kills as usize % 3];
    // It may have ended by itself just now.
    let sent = Command::new("kill").args([signal, &child.id().to_string()]).output();
    assert!(sent.is_ok());
    let begun = std::time::Instant::now();
    while child.try_wait().unwrap().is_none() {
        // Started with `nohup` it ignores SIGHUP, as it should.
        if begun.elapsed().as_secs() > 20 {
            child.kill().unwrap();
        }
        std::thread::sleep(std::time::Duration::from_millis(2));
    }
}

#[cfg(not(unix))]
fn end(child: &mut std::process::Child, _: u64) {
    // It may have ended by itself just now.
    let _ = child.kill();
}

/// Runs that are ended again and again at random moments end with the bytes of one that was not, on
/// other numbers of threads, too.
fn resumed_after_kills(wanted: u64) {
    let folder: TempDir = tempfile::tempdir().unwrap();
    cooling(folder.path());
    let started = std::time::Instant::now();
    let (code, text) = run(folder.path(), &["cooling.toml", "--out", "whole", "--threads", "2"]);
    assert_eq!(code, 0, "{text}");
    let length = started.elapsed();
    let mut rng = gapilib::internals::ga::Mrg32k3a::new(&[12345.0; 6]).unwrap();
    let (mut kills, mut rounds, mut resumed) = (0, 0, 0);
    while kills < wanted {
        let out = format!("cut{rounds}");
        rounds += 1;
        loop {
            let threads = ["1", "2", "3"][kills as usize % 3];
            let arguments = ["cooling.toml", "--out", &out, "--resume", "--threads", threads];
            let mut child = command(folder.path(), &arguments)
                .stdout(Stdio::null())
                .stderr(Stdio::null())
                .spawn()
                .unwrap();
            // At any moment of the whole run, the start and the writing of the results included.
            std::thread::sleep(length.mul_f64(rng.uniform()));
            let killed = child.try_wait().unwrap().is_none();
            end(&mut child, kills);
            let status = child.wait().unwrap();
            if status.success() {
                break;
            }
            assert!(killed, "it failed by itself: {status}");
            kills += 1;
            let journal = folder.path().join(&out).join("run.journal");
            resumed += u64::from(fs::metadata(journal).is_ok_and(|file| file.len() > 16));
            if kills >= wanted {
                let (code, text) = run(folder.path(), &["cooling.toml", "--out", &out, "--resume"]);
                assert_eq!(code, 0, "{text}");
                break;
            }
        }
        same_results(folder.path(), &out, &format!("{kills} kills"));
    }
    assert!(resumed > 0, "none of {kills} kills hit a run with a checkpoint");
}

/// The results of a run are those of the one that was not disturbed, byte by byte.
fn same_results(folder: &Path, out: &str, after: &str) {
    for file in ["result.json", "history.csv", "fit.csv", "individuals.csv", "Calibrated.mo"] {
        let read = |out: &str| fs::read(folder.join(out).join(file)).unwrap();
        assert!(read(out) == read("whole"), "{file} differs in {out} after {after}");
    }
}

/// What a run has written down that was killed while it searched.
fn journal_of_a_killed_run(folder: &Path, length: std::time::Duration) -> Vec<u8> {
    for part in [0.7, 0.6, 0.5, 0.4, 0.3, 0.8, 0.9] {
        let mut child = command(folder, &["cooling.toml", "--out", "cut", "--overwrite"])
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        std::thread::sleep(length.mul_f64(part));
        child.kill().unwrap();
        child.wait().unwrap();
        match fs::read(folder.join("cut/run.journal")) {
            Ok(journal) if journal.len() > 1000 => return journal,
            _ => {}
        }
    }
    panic!("no run was killed while it searched");
}

/// Journals that are damaged in the suite; `GAPILIB_DAMAGED` sets another number.
const DAMAGED: u64 = 9;

/// What a damaged journal still holds is used, and nothing of what it does not.
#[test]
fn damaged_journals_resume_to_the_same_end() {
    let wanted = std::env::var("GAPILIB_DAMAGED").map_or(DAMAGED, |text| text.parse().unwrap());
    let folder: TempDir = tempfile::tempdir().unwrap();
    cooling(folder.path());
    let started = std::time::Instant::now();
    let (code, text) = run(folder.path(), &["cooling.toml", "--out", "whole", "--threads", "2"]);
    assert_eq!(code, 0, "{text}");
    let whole = journal_of_a_killed_run(folder.path(), started.elapsed());
    let mut rng = gapilib::internals::ga::Mrg32k3a::new(&[54321.0; 6]).unwrap();
    let (mut shorter, mut refused) = (0, 0);
    for number in 0..wanted {
        let mut journal = whole.clone();
        let at = (rng.uniform() * journal.len() as f64) as usize;
        let n = (1 + (rng.uniform() * 200.0) as usize).min(journal.len() - at);
        match number % 5 {
            0 => journal[at] ^= 1 << (number % 8),
            1 => journal.truncate(at),
            2 => drop(journal.drain(at..at + n)),
            3 => journal[at..at + n].fill(0xff),
            _ => {
                let copy = journal[at..at + n].to_vec();
                journal.splice(at..at, copy);
            }
        }
        let out = format!("damaged{number}");
        fs::create_dir(folder.path().join(&out)).unwrap();
        fs::write(folder.path().join(&out).join("run.journal"), &journal).unwrap();
        let (code, text) = run(folder.path(), &["cooling.toml", "--out", &out, "--resume"]);
        match code {
            0 => same_results(folder.path(), &out, &format!("damage {number}")),
            // Its head is damaged: it may be anybody's file, which is not written over unasked.
            _ => assert!(text.contains("is not a checkpoint"), "{number}: {text}"),
        }
        shorter += u64::from(text.contains("resumed after"));
        refused += u64::from(!text.contains("resumed after"));
        fs::remove_dir_all(folder.path().join(&out)).unwrap();
    }
    assert!(shorter > refused, "{shorter} of {wanted} damaged journals were used");
}

/// A file larger than 4 KiB cannot be written, as on a full disk.
#[cfg(unix)]
#[test]
fn a_full_disk_ends_no_run_and_is_told() {
    let folder = tempfile::tempdir().unwrap();
    cooling(folder.path());
    let script = "trap '' XFSZ; ulimit -f 8; exec \"$0\" identify cooling.toml";
    let output = Command::new("sh")
        .args(["-c", script, env!("CARGO_BIN_EXE_gapi")])
        .current_dir(folder.path())
        .output()
        .unwrap();
    let text = [output.stdout, output.stderr].map(|b| String::from_utf8(b).unwrap()).concat();
    assert_eq!(output.status.code(), Some(1), "{text}");
    assert!(text.contains("the run continues without checkpoints"), "{text}");
    assert!(text.contains("low") && text.contains("95 % interval"), "{text}");
    assert!(text.contains("result.json") && text.contains("could not be written"), "{text}");
    // What is small enough was written, and nothing half.
    assert!(folder.path().join("results/cooling/Calibrated.mo").is_file());
    assert!(!folder.path().join("results/cooling/result.json").exists());
    // With room again the run is completed from what the journal holds.
    let (code, text) = run(folder.path(), &["cooling.toml", "--resume"]);
    assert_eq!(code, 0, "{text}");
    assert!(text.contains("resumed after"), "{text}");
}

#[test]
fn results_are_shown_although_what_they_depend_on_cannot_be_written() {
    let folder = tempfile::tempdir().unwrap();
    cooling(folder.path());
    fs::create_dir_all(folder.path().join("o/inputs.json")).unwrap();
    let (code, text) = run(folder.path(), &["cooling.toml", "--out", "o"]);
    assert!(code == 1 && text.contains("inputs.json"), "{code} {text}");
    assert!(text.contains("low") && text.contains("95 % interval"), "{text}");
}

#[test]
fn a_folder_that_cannot_be_written_is_told_before_the_run() {
    let folder = tempfile::tempdir().unwrap();
    filled_tank(folder.path());
    fs::write(folder.path().join("taken"), "a file").unwrap();
    let (code, text) = run(folder.path(), &["tank.toml", "--out", "taken/results"]);
    assert!(code == 1 && text.contains("taken/results"), "{text}");
    assert!(!text.contains("evaluations"), "{text}");
}

#[test]
fn profiles_and_sensitivities_are_written() {
    let folder = tempfile::tempdir().unwrap();
    cooling(folder.path());
    let (code, text) = run(
        folder.path(),
        &["cooling.toml", "--profile", "--sensitivity", "sobol", "--samples", "32"],
    );
    assert_eq!(code, 0, "{text}");
    assert!(text.contains("first order") && text.contains("95 % by profiles"), "{text}");
    // What rounding leaves is no physics that the model misses.
    assert!(!text.contains("does not describe part"), "{text}");
    for file in ["sensitivity.csv", "profiles.csv"] {
        assert!(folder.path().join("results/cooling").join(file).is_file(), "{file}");
    }
    let (code, text) =
        run(folder.path(), &["cooling.toml", "--sensitivity", "guess", "--out", "o"]);
    assert!(code == 1 && text.contains("morris"), "{text}");
}

#[test]
fn checkpoints_of_other_problems_and_damaged_ones_are_told() {
    let folder = tempfile::tempdir().unwrap();
    filled_tank(folder.path());
    fs::create_dir(folder.path().join("results")).unwrap();
    let journal = folder.path().join("results/run.journal");
    fs::write(&journal, "no journal").unwrap();
    let (code, text) = run(folder.path(), &["tank.toml", "--out", "results"]);
    assert!(code == 1 && text.contains("--resume") && text.contains("--fresh"), "{text}");
    let (code, text) = run(folder.path(), &["tank.toml", "--resume", "--out", "results"]);
    assert!(code == 1 && text.contains("not a checkpoint"), "{text}");
    fs::write(&journal, b"GAPIRUN2\0\0\0\0\0\0\0\0").unwrap();
    let (code, text) = run(folder.path(), &["tank.toml", "--resume", "--out", "results"]);
    assert!(code == 1 && text.contains("not a checkpoint"), "of a former version: {text}");
    assert_eq!(fs::read(&journal).unwrap().len(), 16, "left as it was");
}

#[test]
fn settings_are_watched_and_what_cannot_be_changed_is_told() {
    let folder = tempfile::tempdir().unwrap();
    cooling(folder.path());
    let settings = "evaluations = 200\nmutation = 0.4\n\"min k\" = 0.1\ncolour = 3\n";
    fs::write(folder.path().join("settings.toml"), settings).unwrap();
    let (code, text) = run(folder.path(), &["cooling.toml", "--watch", "settings.toml"]);
    assert_eq!(code, 0, "{text}");
    assert!(text.contains("mutation = 0.4 from generation 1 on"), "{text}");
    assert!(text.contains("`colour`"), "{text}");
    let result = result(folder.path(), "results/cooling");
    let names: Vec<&str> =
        result["changes"].as_array().unwrap().iter().map(|c| c[1].as_str().unwrap()).collect();
    assert_eq!(names, ["evaluations", "mutation", "min k"]);
    assert_eq!(result["parameters"][0]["range"][0], 0.1);
    assert!(result["evaluations"].as_u64().unwrap() < 300, "{text}");
}

/// `gapi new` as a user starts it.
fn draft(folder: &Path, arguments: &[&str]) -> (i32, String) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_gapi"));
    command.arg("new").args(arguments).current_dir(folder).env_remove("MODELICAPATH");
    let Output { status, stdout, stderr } = command.output().unwrap();
    let text = [stdout, stderr].map(|bytes| String::from_utf8(bytes).unwrap()).concat();
    (status.code().expect("ended by itself"), text)
}

#[test]
fn a_drafted_problem_runs_as_it_is() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    // A curve written naturally, measured in millivolts: V = 0.9 - 0.25 i.
    let model = "model Cell input Real i; output Real V(unit = \"V\"); parameter Real V0 = 1; \
                 parameter Real R = 0.1; equation V = V0 - R*i; end Cell;";
    fs::write(folder.join("cell.mo"), model).unwrap();
    let rows: String = (0..12)
        .map(|k| format!("{};{};x\n", 0.1 * f64::from(k), 900.0 - 25.0 * f64::from(k)))
        .collect();
    fs::write(folder.join("curve.csv"), format!("i;V;Bemerkung\n;mV;\n{rows}")).unwrap();
    let (code, text) = draft(folder, &["curve.csv", "--model", "cell.mo"]);
    assert_eq!(code, 0, "{text}");
    let (code, text) = run(folder, &["curve.toml", "--out", "o"]);
    assert_eq!(code, 0, "{text}");
    let found = result(folder, "o");
    for (name, exact) in [("V0", 0.9), ("R", 0.25)] {
        assert!((value(&found, name) - exact).abs() < 1e-9, "{text}");
    }
    assert!(text.contains("derivatives  exact"), "{text}");
    assert!(text.contains("converted from mV to V"), "{text}");
    // What is there is never written over.
    let (code, text) = draft(folder, &["curve.csv", "--model", "cell.mo"]);
    assert_ne!(code, 0, "{text}");
    let (code, text) = draft(folder, &["nothing.csv", "--model", "cell.mo"]);
    assert!(code != 0 && text.contains("nothing.csv"), "{text}");
}

/// A curve over an input: bands by the closed form of the straight line, beyond the points, too, and
/// where to measure next.
#[test]
fn a_static_curve_has_bands_and_a_next_measurement() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let model = "model Cell input Real i; output Real V; parameter Real V0 = 1; \
                 parameter Real R = 0.1; equation V = V0 - R*i; end Cell;";
    fs::write(folder.join("cell.mo"), model).unwrap();
    let measured = [0.91, 0.84, 0.82, 0.76, 0.69];
    let rows: String = (0..5).map(|k| format!("{k},{}\n", measured[k])).collect();
    fs::write(folder.join("d.csv"), format!("i,V\n{rows}")).unwrap();
    let problem = "model = \"Cell\"\nfiles = [\"cell.mo\"]\n[parameters]\n\
                   V0 = { min = 0.1, max = 5 }\nR = { min = 0, max = 1 }\n[[experiment]]\n\
                   data = \"d.csv\"\nx = \"i\"\noutputs = { V = \"V\" }\n";
    fs::write(folder.join("p.toml"), problem).unwrap();
    let (code, text) = run(folder, &["p.toml", "--design", "--out", "o"]);
    assert_eq!(code, 0, "{text}");
    assert!(text.contains("The next measurement"), "{text}");
    assert!(!text.contains("i = -"), "a current that no one can set: {text}");
    let mean = measured.iter().sum::<f64>() / 5.0;
    let slope = measured.iter().zip(0..).map(|(y, x)| y * (f64::from(x) - 2.0)).sum::<f64>() / 10.0;
    let line = |x: f64| mean + slope * (x - 2.0);
    let squares = measured.iter().zip(0..).map(|(y, x)| (y - line(f64::from(x))).powi(2));
    // The 97.5 % quantile of Student's distribution with 3 degrees of freedom.
    let ts = 3.182_446_305_284_263 * (squares.sum::<f64>() / 3.0).sqrt();
    let bands = fs::read_to_string(folder.join("o/bands.csv")).unwrap();
    let mut last = 0.0;
    for row in bands.lines().skip(1) {
        let cells: Vec<f64> = row.split(',').skip(2).map(|cell| cell.parse().unwrap()).collect();
        let half = ts * (0.2 + (cells[0] - 2.0).powi(2) / 10.0).sqrt();
        assert!((cells[1] - line(cells[0])).abs() < 1e-6, "{row}");
        assert!((cells[2] - half).abs() < 1e-4 * half, "{row} {half}");
        last = cells[0];
    }
    assert!(last > 4.3, "{last}");
}

/// Two exponentials from equal starts: by symmetry the descent ends at a saddle, where the rates
/// could not be told apart. The minimum is that of the data, 2 and 0.5, without noise.
#[test]
fn a_saddle_is_no_minimum() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let model = "model Two parameter Real a1 = 1; parameter Real a2 = 1; parameter Real k1 = 1; \
                 parameter Real k2 = 1; output Real y; \
                 equation y = a1*exp(-k1*time) + a2*exp(-k2*time); end Two;";
    fs::write(folder.join("Two.mo"), model).unwrap();
    let row = |k: u32| {
        let t = 0.25 * f64::from(k);
        format!("{t},{:.12}\n", 3.0 * (-2.0 * t).exp() + (-0.5 * t).exp())
    };
    let rows: String = (0..24).map(row).collect();
    fs::write(folder.join("d.csv"), format!("t,y\n{rows}")).unwrap();
    let range = "{ min = 0.1, max = 10 }";
    let problem = format!(
        "model = \"Two\"\nfiles = [\"Two.mo\"]\n[parameters]\na1 = {range}\na2 = {range}\n\
         k1 = {range}\nk2 = {range}\n[[experiment]]\ndata = \"d.csv\"\n\
         x = {{ variable = \"time\", column = \"t\" }}\noutputs = {{ y = \"y\" }}\n\
         [method]\nname = \"levenberg_marquardt\"\n"
    );
    fs::write(folder.join("p.toml"), problem).unwrap();
    let (code, text) = run(folder, &["p.toml", "--out", "o"]);
    assert_eq!(code, 0, "{text}");
    let found = result(folder, "o");
    let mut rates = [value(&found, "k1"), value(&found, "k2")];
    rates.sort_by(f64::total_cmp);
    assert!((rates[0] - 0.5).abs() < 1e-4 && (rates[1] - 2.0).abs() < 1e-4, "{text}");
    assert!(text.contains("saddle"), "{text}");
}

/// Only a + b acts; and where the solver is coarse, its errors must not be told for a lack of a
/// minimum.
#[test]
fn what_is_determined_is_told_with_its_interval_also_where_the_solver_is_coarse() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let model = "model M parameter Real a = 0.3; parameter Real b = 0.3; \
                 Real y(start = 2, fixed = true); equation der(y) = -(a + b)*y; end M;";
    fs::write(folder.join("M.mo"), model).unwrap();
    let noise = |k: u32| 0.01 * f64::from(k * 7919 % 13) / 13.0 - 0.005;
    let row = |k: u32| {
        let t = 0.1 * f64::from(k);
        format!("{t},{}\n", 2.0 * (-0.7 * t).exp() + noise(k))
    };
    let rows: String = (0..40).map(row).collect();
    fs::write(folder.join("d.csv"), format!("t,y\n{rows}")).unwrap();
    let problem = "model = \"M\"\nfiles = [\"M.mo\"]\n[parameters]\na = { min = 0, max = 2 }\n\
                   b = { min = 0, max = 2 }\n[[experiment]]\ndata = \"d.csv\"\ntolerance = 1e-4\n\
                   x = { variable = \"time\", column = \"t\" }\noutputs = { y = \"y\" }\n";
    fs::write(folder.join("p.toml"), problem).unwrap();
    let (code, text) = run(folder, &["p.toml", "--out", "o"]);
    assert_eq!(code, 0, "{text}");
    let found = result(folder, "o");
    assert_eq!(found["ending"]["kind"], "minimum", "{text}");
    assert!((value(&found, "a") + value(&found, "b") - 0.7).abs() < 0.01, "{text}");
    assert!(text.contains("the model depends only on a + b"), "{text}");
    assert!(text.contains("a + b is 0.69") || text.contains("a + b is 0.70"), "{text}");
    assert!(found["parameters"][0]["interval"].is_null(), "{text}");
}

/// Titles and names of experiments come from other people's files: they reach terminals, pages and
/// spreadsheets as text.
#[test]
fn names_of_a_problem_are_text_wherever_they_are_shown() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    cooling(folder);
    let problem = fs::read_to_string(folder.join("cooling.toml")).unwrap();
    let title = "title = \"2J<script>\"\n";
    let name = "[[experiment]]\nname = \"=HYPERLINK(1)\"";
    let problem = title.to_owned() + &problem.replace("[[experiment]]", name);
    let control = problem.replace("HYPERLINK", "\\u009b2J");
    fs::write(folder.join("cooling.toml"), control).unwrap();
    let (code, text) = run(folder, &["cooling.toml", "--out", "o"]);
    assert!(code == 1 && text.contains("the control character U+009B"), "{text}");
    fs::write(folder.join("cooling.toml"), problem).unwrap();
    let (code, text) = run(folder, &["cooling.toml", "--out", "o"]);
    assert_eq!(code, 0, "{text}");
    let mut cells = 0;
    for entry in fs::read_dir(folder.join("o")).unwrap().map(Result::unwrap) {
        let Ok(text) = fs::read_to_string(entry.path()) else { continue };
        let name = entry.file_name().to_string_lossy().into_owned();
        let is_page = name.ends_with(".html") || name.ends_with(".svg");
        assert!(!is_page || !text.contains("2J<script>"), "{name} has a script");
        if name.ends_with(".csv") {
            let lines = text.lines().flat_map(|line| line.split(','));
            let begin = |cell: &&str| cell.trim_matches('"').starts_with("=HYPERLINK");
            assert_eq!(lines.clone().find(begin), None, "{name} has a formula");
            cells += lines.filter(|cell| cell.contains("'=HYPERLINK(1)")).count();
        }
    }
    assert!(cells > 0, "no table names the experiment");
}

/// A variable that no name of the model resembles: the message lists those there are.
#[test]
fn an_unknown_output_is_refused_with_the_names_of_the_model() {
    let model = "model Tank parameter Real k = 0.3; Real level(start = 2, fixed = true); \
        equation der(level) = -k*level; end Tank;";
    let problem = "model = \"Tank\"\nfiles = [\"Tank.mo\"]\n[parameters]\nk = { min = 0.1, max = 1 }\n\
        [[experiment]]\ndata = \"d.csv\"\nx = \"time\"\noutputs = { q = \"q\" }\n";
    let here = crate::support::program::folder(&[
        ("Tank.mo", model),
        ("p.toml", problem),
        ("d.csv", "time,q\n1,2\n2,1\n"),
    ]);
    let (code, _, errors) = crate::support::program::gapi(&here, &["identify", "p.toml"]);
    assert_eq!(code, 1, "{errors}");
    assert!(errors.contains("has no variable `q`"), "{errors}");
    assert!(errors.contains("its variables are `time`, `level`"), "{errors}");
}

const POOL: &str = "model Pool
  parameter Real k = 1;
  parameter Real g = 1;
  parameter Real R[2] = {1, 1};
  Real c(start = 1, fixed = true);
  Real y = g*c;
equation
  der(c) = -k*R[1]*c;
end Pool;
";

/// After the model was translated, the script with the values makes it the calibrated model, whatever the
/// problem estimates besides.
#[test]
fn the_script_with_the_values_calibrates_the_model() {
    let range = "{ min = 0.05, max = 9 }";
    let start = "c = { min = 0.1, max = 9, initial = true }";
    for (parameters, set, output) in [
        (format!("k = {range}\n{start}"), "", "column = \"c\""),
        (format!("\"R[1]\" = {range}\n{start}"), "", "column = \"c\", sigma = \"estimate\""),
        (format!("k = {{ fixed = 0.5 }}\ng = {range}"), "", "column = \"c\", sigma = 0.1"),
        (format!("g = {range}\nk = {{ tied = \"g/4\" }}"), "", "column = \"c\""),
        (format!("k_a = {range}\n{start}"), "set = { k = \"2*k_a\" }", "column = \"c\""),
        (format!("k = {range}\ns = {range}\n{start}"), "", "column = \"c\", sigma = \"s*0.1\""),
        (format!("k = {range}"), "", "column = \"c\", scale = \"estimate\", offset = \"o\""),
        (
            format!("k = {range}\ntau = {{ min = 0.1, max = 2 }}"),
            "",
            "column = \"c\", delay = \"tau\"",
        ),
        (
            format!("k = {{ min = 0.05, max = 9, per_experiment = true }}\n{start}"),
            "",
            "column = \"c\"",
        ),
        (
            format!("k_a = {range}\nk_b = {range}"),
            "set = { k = \"k_a\" }\noutputs = { y = \"c\" }\n[[experiment]]\nname = \"two\"\n\
             data = \"d.csv\"\nset = { k = \"k_b\" }",
            "column = \"c\"",
        ),
    ] {
        let problem = format!(
            "model = \"Pool\"\nfiles = [\"Pool.mo\"]\nbands = false\n[parameters]\n{parameters}\n\
             [[experiment]]\ndata = \"d.csv\"\n{set}\noutputs = {{ y = {{ {output} }} }}\n"
        );
        let row = |k: u32| {
            let t = f64::from(k) / 2.0;
            format!("{t},{:.3}\n", 2.0 * (-0.5 * t).exp() + 0.01 * (3.0 * t).sin())
        };
        let data = "time,c\n".to_owned() + &(0..9).map(row).collect::<String>();
        let script = |class: &str, values: &str| {
            format!(
                "openModel(\"Pool.mo\");\nopenModel(\"fit/Calibrated.mo\");\n\
                 translateModel(\"{class}\");\n{values}simulateModel(\"{class}\", stopTime = 1, \
                 tolerance = 1e-9);\nx = readTrajectory(\"dsres.mat\", {{\"c\", \"y\"}}, \
                 readTrajectorySize(\"dsres.mat\"));\n\
                 print(String(x[1, end], 9) + \" \" + String(x[2, end], 9));\n"
            )
        };
        let here = program::folder(&[
            ("Pool.mo", POOL),
            ("p.toml", &problem),
            ("d.csv", &data),
            ("a.mos", &script("Pool", "RunScript(\"fit/calibrated.mos\");\n")),
            ("b.mos", &script("Calibrated", "")),
        ]);
        let (code, out, errors) = program::gapi(&here, &["identify", "p.toml", "--out", "fit"]);
        assert_eq!(code, 0, "{parameters}\n{out}{errors}");
        let values = ["a.mos", "b.mos"].map(|script| {
            let (code, out, errors) = program::gapi(&here, &["run", script]);
            assert_eq!(code, 0, "{parameters}\n{out}{errors}");
            out.lines().last().unwrap().to_owned()
        });
        let text = fs::read_to_string(here.path().join("fit/calibrated.mos")).unwrap();
        assert_eq!(values[0], values[1], "{parameters}\n{text}");
        let is_of_model = !["k_a", "s =", "tau", "per_"].iter().any(|own| parameters.contains(own));
        assert_eq!(
            is_of_model,
            !text.contains("// not set, because it is "),
            "{parameters}\n{text}"
        );
    }
}
