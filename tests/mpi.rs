//! `gapi` as an MPI job: the files of one process for any number of ranks, also where a rank is killed
//! or the scheduler ends the job, and another number of ranks resumes it.
//!
//! Needs `mpirun`, and that ranks may share cores.
#![cfg(target_os = "linux")]
#![allow(clippy::disallowed_methods, reason = "expectations of tests")]

#[allow(dead_code, reason = "the table of the guide uses the rest")]
#[path = "suite/support/cluster.rs"]
mod cluster;

use cluster::Cluster;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};
use tempfile::TempDir;

const MODEL: &str = include_str!("data/models/mpi_model.mo");

const PROBLEM: &str = "model = \"Oscillator\"
files = [\"Oscillator.mo\"]
constraints = [\"d < 2*mu\"]
[parameters]
mu = { min = 0.2, max = 3 }
w = { min = 0.5, max = 2 }
d = { min = 0, max = 1 }
[[experiment]]
data = \"d.csv\"
x = \"time\"
outputs = { x = { column = \"x\", sigma = 0.05 } }
[method]
name = \"genetic\"
population = 24
[stop]
generations = 60
[checkpoint]
seconds = 0.01
[bootstrap]
samples = 100
";

const SCRIPT: &str = "openModel(\"Oscillator.mo\")
Parameters = {\"mu\", \"w\", \"d\"};
Seed = [1, 2, 3, 4, 5, 6];
(Read, Sizes, x, measured) = Exp_Adq_SISO(\"d.csv\", \"time\", \"x\");
for generation in 1:12 loop
  New_Generation = zeros(30, 3);
  for k in 1:30 loop
    (Ram_list, Seed) = Ram_Gen_ARENA(Seed, 3);
    New_Generation[k, :] = {0.3, 0.5, 0} + Ram_list[1, :];
  end for;
  y = Eval(\"\", \"Oscillator\", x, New_Generation, Parameters, \"time\", \"x\");
  fitness = Fit(y, measured);
end for;
";

/// Columns of time and x that no parameters fit exactly.
fn data() -> String {
    let point = |k: i32| {
        let time = 0.5 * f64::from(k);
        let x = 1.9 * (0.93 * time).cos() + 0.04 * f64::from(k % 5 - 2);
        format!("{time},{x:.4}\n")
    };
    (1..20).map(point).fold("time,x\n".to_owned(), |text, row| text + &row)
}

fn here() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let files =
        [("Oscillator.mo", MODEL), ("p.toml", PROBLEM), ("d.csv", &data()), ("job.mos", SCRIPT)];
    for (name, text) in files {
        fs::write(folder.path().join(name), text).unwrap();
    }
    folder
}

/// `gapi` alone, or as so many ranks.
fn command(folder: &Path, ranks: usize, arguments: &[&str]) -> Command {
    let gapi = env!("CARGO_BIN_EXE_gapi");
    let mut command = match ranks {
        0 => Command::new(gapi),
        ranks => {
            let mut command = Command::new("mpirun");
            command.args(["-n", &ranks.to_string(), gapi]);
            command
        }
    };
    command.envs(ALLOWED).args(arguments).current_dir(folder);
    command
}

/// Open MPI asks twice whether the user `root` means it, and whether ranks may share cores.
const ALLOWED: [(&str, &str); 4] = [
    ("OMPI_ALLOW_RUN_AS_ROOT", "1"),
    ("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1"),
    ("OMPI_MCA_rmaps_base_oversubscribe", "1"),
    ("PRTE_MCA_rmaps_default_mapping_policy", ":oversubscribe"),
];

fn ended(command: &mut Command) -> (Option<i32>, String) {
    let Output { status, stdout, stderr } = command.output().expect("`mpirun` is installed");
    (status.code(), String::from_utf8_lossy(&[stdout, stderr].concat()).into_owned())
}

/// The files of a run; not those that say when and by whom it was made.
fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let named = entries.map(|path| {
        (path.file_name().unwrap().to_string_lossy().into_owned(), fs::read(path).unwrap())
    });
    named.filter(|(name, _)| name != "timing.json" && name != "run.lock").collect()
}

fn same_files(a: &Path, b: &Path) {
    let (a, b) = (files(a), files(b));
    assert!(a.contains_key("result.json") || a.contains_key("history.csv"), "{:?}", a.keys());
    assert_eq!(a.keys().collect::<Vec<_>>(), b.keys().collect::<Vec<_>>());
    for (name, bytes) in &a {
        assert!(bytes == &b[name], "`{name}` differs");
    }
}

const IDENTIFY: [&str; 5] = ["identify", "p.toml", "--profile", "--out", "out"];
const RUN: [&str; 6] = ["run", "job.mos", "--checkpoint", "0.01", "--out", "out"];

/// The files that one process alone writes.
fn reference(arguments: &[&str]) -> TempDir {
    let alone = here();
    let (code, text) = ended(&mut command(alone.path(), 0, arguments));
    assert_eq!(code, Some(0), "{text}");
    alone
}

#[test]
fn the_files_are_those_of_one_process() {
    for arguments in [&IDENTIFY[..], &RUN] {
        let alone = reference(arguments);
        for (ranks, threads) in [(1, "2"), (2, "1"), (3, "1"), (2, "2")] {
            let here = here();
            let arguments = [arguments, &["--threads", threads]].concat();
            let (code, text) = ended(&mut command(here.path(), ranks, &arguments));
            assert_eq!(code, Some(0), "{ranks} ranks: {text}");
            same_files(&alone.path().join("out"), &here.path().join("out"));
            // What its messages took is said beside the results.
            if arguments[0] == "identify" {
                let timing = fs::read_to_string(here.path().join("out/timing.json")).unwrap();
                let tells = timing.contains(&format!("\"ranks\": {ranks},"));
                assert_eq!(tells, ranks > 1, "{timing}");
            }
        }
    }
}

/// Starts a job and waits until it has a checkpoint.
fn started(here: &Path, ranks: usize, arguments: &[&str], journal: &str) -> Child {
    begun(here, &mut command(here, ranks, arguments), journal)
}

fn begun(here: &Path, command: &mut Command, journal: &str) -> Child {
    let mut child =
        command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().expect("`mpirun` is installed");
    let begun = Instant::now();
    let journal = here.join("out").join(journal);
    while fs::metadata(&journal).map_or(0, |found| found.len()) < 2000 {
        assert!(child.try_wait().unwrap().is_none(), "it ended by itself");
        assert!(begun.elapsed() < Duration::from_secs(60), "not a checkpoint");
        std::thread::sleep(Duration::from_millis(5));
    }
    child
}

/// The process of a rank.
fn process_of(rank: usize, job: &Child) -> String {
    let id = job.id();
    let children = fs::read_to_string(format!("/proc/{id}/task/{id}/children")).unwrap();
    let wanted = [format!("OMPI_COMM_WORLD_RANK={rank}"), format!("PMI_RANK={rank}")];
    let is_it = |child: &&str| {
        let environment = fs::read(format!("/proc/{child}/environ")).unwrap_or_default();
        let mut variables = environment.split(|byte| *byte == 0);
        variables.any(|own| wanted.iter().any(|wanted| own == wanted.as_bytes()))
    };
    children.split_whitespace().find(is_it).expect("the rank runs").to_owned()
}

fn send(signal: &str, process: &str) {
    assert!(Command::new("kill").args([signal, process]).status().unwrap().success());
}

const RUNS: [(&[&str], &str); 2] = [(&IDENTIFY, "run.journal"), (&RUN, "script.journal")];

#[test]
fn a_job_that_lost_a_rank_is_resumed_by_another_number_of_ranks() {
    for (arguments, journal) in RUNS {
        let alone = reference(arguments);
        for (killed, ranks, then) in [(1, 3, 2), (0, 2, 3), (1, 2, 0)] {
            let here = here();
            let mut job = started(here.path(), ranks, arguments, journal);
            send("-KILL", &process_of(killed, &job));
            assert!(!job.wait().unwrap().success(), "the job ended without an error");
            assert!(here.path().join("out").join(journal).exists());
            let again = [arguments, &["--resume"]].concat();
            let (code, text) = ended(&mut command(here.path(), then, &again));
            assert_eq!(code, Some(0), "{text}");
            assert!(text.contains("resumed"), "{text}");
            same_files(&alone.path().join("out"), &here.path().join("out"));
        }
    }
}

#[test]
fn a_job_that_the_scheduler_ends_is_resumed() {
    for (arguments, journal) in RUNS {
        let alone = reference(arguments);
        let here = here();
        let mut job = started(here.path(), 3, arguments, journal);
        send("-TERM", &job.id().to_string());
        assert!(!job.wait().unwrap().success());
        let again = [arguments, &["--resume"]].concat();
        let (code, text) = ended(&mut command(here.path(), 2, &again));
        assert_eq!(code, Some(0), "{text}");
        same_files(&alone.path().join("out"), &here.path().join("out"));
    }
}

/// The job for Slurm, ended by the scheduler and submitted again as it was.
#[test]
fn a_batch_job_that_is_submitted_again_resumes() {
    let alone = reference(&IDENTIFY);
    let here = here();
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/cluster/mpi.sbatch");
    let job = || {
        let mut job = Command::new("bash");
        job.args([script, "p.toml", "--profile"]).current_dir(here.path());
        job.env("GAPI", env!("CARGO_BIN_EXE_gapi")).env("OUT", "out").envs(ALLOWED);
        job
    };
    let mut first = begun(here.path(), &mut job(), "run.journal");
    send("-TERM", &first.id().to_string());
    assert!(!first.wait().unwrap().success());
    let (code, text) = ended(&mut job());
    assert_eq!(code, Some(0), "{text}");
    same_files(&alone.path().join("out"), &here.path().join("out"));
}

#[test]
fn a_rank_that_is_asked_to_end_ends_the_job_in_order() {
    let here = here();
    let mut job = started(here.path(), 3, &IDENTIFY, "run.journal");
    send("-TERM", &process_of(2, &job));
    assert_eq!(job.wait().unwrap().code(), Some(130));
    assert!(here.path().join("out/run.journal").exists());
}

#[test]
fn what_is_wrong_is_said_once() {
    let here = here();
    let (code, text) = ended(&mut command(here.path(), 3, &["identify", "nothing.toml"]));
    assert_eq!(code, Some(1), "{text}");
    assert_eq!(text.matches("error[").count(), 1, "{text}");
    let (code, text) = ended(&mut command(here.path(), 3, &["identify", "--no-such-option"]));
    assert_eq!(code, Some(2), "{text}");
    assert_eq!(text.matches("unexpected argument").count(), 1, "{text}");
}

/// The launcher of another library: this one finds each process alone, and all would do the same.
#[test]
fn processes_that_do_not_find_each_other_are_refused() {
    for (rank, messages) in [("0", 1), ("2", 0)] {
        let here = here();
        let mut command = command(here.path(), 0, &IDENTIFY);
        command.envs([("SLURM_STEP_NUM_TASKS", "3"), ("SLURM_PROCID", rank)]);
        let (code, text) = ended(&mut command);
        assert_eq!(code, Some(2), "{text}");
        assert_eq!(text.matches("has started 3 processes").count(), messages, "{text}");
        assert!(!here.path().join("out").exists());
        let (code, text) = ended(command.env("GAPI_MPI", "0"));
        assert_eq!(code, Some(0), "{text}");
    }
}

#[test]
fn threads_that_share_a_core_are_told_once() {
    let here = here();
    let arguments = ["identify", "nothing.toml", "--threads", "300"];
    let (_, text) = ended(&mut command(here.path(), 3, &arguments));
    assert_eq!(text.matches("is to have 300 threads").count(), 1, "{text}");
    let (_, text) = ended(&mut command(here.path(), 3, &[&arguments[..], &["--quiet"]].concat()));
    assert!(!text.contains("threads"), "{text}");
}

#[test]
fn a_model_with_functions_in_c_is_simulated_by_rank_0_alone() {
    let here = here();
    let function = "  parameter Real d = 0.1;
  function twice
    input Real x;
    output Real y;
    external \"C\" y = twice(x)
      annotation(Include = \"static double twice(double x) { return 2*x; }\");
  end twice;
";
    let model = MODEL.replace("  parameter Real d = 0.1;\n", function);
    let model = model.replace("mu*(1", "twice(mu)/2*(1");
    fs::write(here.path().join("Oscillator.mo"), model).unwrap();
    let arguments = ["identify", "p.toml", "--allow-external", "--evaluations", "50"];
    let (code, text) = ended(&mut command(here.path(), 2, &arguments));
    assert_eq!(code, Some(0), "{text}");
    assert!(text.contains("take no part") && text.contains("functions in C"), "{text}");
}

/// A functional mock-up unit runs in processes of one machine.
#[test]
fn an_fmu_is_simulated_by_rank_0_alone() {
    let here = here();
    let runtime = std::env::current_exe().unwrap().with_file_name("libgapilib_fmu.so");
    let mut export = Command::new(env!("CARGO_BIN_EXE_gapi"));
    export.current_dir(&here).env("GAPILIB_FMU_RUNTIME", runtime);
    export.args(["export-fmu", "Oscillator.mo", "--model", "Oscillator", "-o", "o.fmu"]);
    let (code, text) = ended(&mut export);
    assert_eq!(code, Some(0), "{text}");
    let model = "model = \"Oscillator\"\nfiles = [\"Oscillator.mo\"]\n";
    let problem = PROBLEM.replace(model, "model = \"o.fmu\"\n");
    fs::write(here.path().join("p.toml"), problem).unwrap();
    let arguments = ["identify", "p.toml", "--allow-external", "--evaluations", "50"];
    let (code, text) = ended(&mut command(here.path(), 2, &arguments));
    assert_eq!(code, Some(0), "{text}");
    assert!(text.contains("take no part") && text.contains("is an FMU"), "{text}");
}

/// Populations of simulations of some milliseconds, without anything after the search.
const POPULATIONS: &str = "model = \"Oscillator\"
files = [\"Oscillator.mo\"]
[parameters]
mu = { min = 0.9, max = 1.1 }
w = { min = 0.9, max = 1.1 }
d = { min = 0, max = 0.1 }
[[experiment]]
data = \"d.csv\"
x = \"time\"
outputs = { x = { column = \"x\", sigma = 0.05 } }
[method]
name = \"genetic\"
population = 200
polish = false
[stop]
generations = 40
stagnation = 100
";

/// What the search took, and one message and its handling, by `timing.json`.
fn timing(folder: &Path) -> [f64; 3] {
    let text = fs::read_to_string(folder.join("timing.json")).unwrap();
    let of = |name: &str| {
        let line = text.lines().find(|line| line.contains(name));
        let value = line.and_then(|line| line.split(':').nth(1));
        value.map_or(0.0, |value| value.trim().trim_end_matches(',').parse().unwrap())
    };
    [of("wall_seconds"), of("message_seconds"), of("handling_seconds")]
}

/// The job on paper takes about as long as 2 to 8 ranks here, on however many cores; it leaves out that
/// each rank translates tapes to machine code by itself. Run it on a machine that does nothing else:
/// `cargo test --release --features mpi --test mpi -- --ignored --nocapture`
#[test]
#[ignore = "measures times"]
#[allow(clippy::print_stdout, reason = "that is what it is for")]
fn the_job_on_paper_takes_as_long_as_here() {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let here = here();
    fs::write(here.path().join("p.toml"), POPULATIONS).unwrap();
    let of = |ranks: usize| {
        let out = format!("r{ranks}");
        let arguments = ["identify", "p.toml", "--threads", "1", "--quiet", "--out", &out];
        let mut command = command(here.path(), ranks, &arguments);
        command.env("OMPI_MCA_hwloc_base_binding_policy", "none");
        let (code, text) = ended(&mut command);
        assert_eq!(code, Some(0), "{text}");
        timing(&here.path().join(&out))
    };
    let (generations, individuals) = (40.0, 200);
    let one = of(1)[0];
    let simulation = one / generations / individuals as f64;
    println!("one rank {one:.2} s, {simulation:.1e} s for each simulation");
    for ranks in [2, 3, 4, 6, 8] {
        let [seconds, message, handling] = of(ranks);
        let used = ranks.min(cores) as f64;
        let paper = Cluster { ranks, cores, individuals, simulation, message, handling };
        let (measured, predicted) =
            (one / seconds / used, one / generations / paper.seconds() / used);
        println!(
            "{ranks} ranks on {cores} cores: {seconds:.2} s, efficiency {measured:.3}, on paper \
             {predicted:.3}, message {message:.1e} s, handling {handling:.1e} s"
        );
        assert!((measured - predicted).abs() < 0.25, "{measured} and {predicted}");
    }
}
