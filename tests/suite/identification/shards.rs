//! A study in shards: the merged files are those of one process, and what does not belong together is
//! refused.

use crate::support::program::{folder, gapi};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

const MODEL: &str = "model Growth
  parameter Real a = 1;
  parameter Real b = 1;
  Real y = a*exp(b*time);
end Growth;
";

const PROBLEM: &str = "model = \"Growth\"
files = [\"Growth.mo\"]
[parameters]
a = { min = 0.1, max = 9 }
b = { min = 0.1, max = 3 }
[stop]
generations = 15
[[experiment]]
data = \"d.csv\"
x = \"time\"
outputs = { y = \"y\" }
[bootstrap]
samples = 100
[posterior]
samples = 2000
";

const STUDY: [&str; 6] =
    ["identify", "p.toml", "--profile", "--sensitivity", "sobol", "--samples=16"];

fn here() -> TempDir {
    let data = "time,y\n0.1,1.3\n0.5,1.9\n1,3.2\n1.4,4.1\n2,8.9\n2.4,12.7\n3,21\n";
    folder(&[("Growth.mo", MODEL), ("p.toml", PROBLEM), ("d.csv", data)])
}

fn shard(here: &TempDir, shard: &str, more: &[&str]) {
    let out = format!("s{}", shard.replace('/', "of"));
    let arguments = [&STUDY, &["--shard", shard, "--out", &out][..], more].concat();
    let (code, text, errors) = gapi(here, &arguments);
    assert_eq!(code, 0, "{errors}");
    assert!(text.contains("Other shards compute the rest") || shard.ends_with("/1"), "{text}");
}

fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let named = entries.map(|path| {
        (path.file_name().unwrap().to_string_lossy().into_owned(), fs::read(path).unwrap())
    });
    named.filter(|(name, _)| name != "timing.json" && name != "run.lock").collect()
}

#[test]
fn the_merged_files_are_those_of_one_process() {
    let here = here();
    let (code, _, errors) = gapi(&here, &[&STUDY[..], &["--out", "whole"]].concat());
    assert_eq!(code, 0, "{errors}");
    for number in ["1/3", "2/3", "3/3"] {
        shard(&here, number, &[]);
    }
    let merge = ["report", "--merge", "s2of3", "s1of3", "s3of3", "--out", "merged"];
    let (code, _, errors) = gapi(&here, &merge);
    assert_eq!(code, 0, "{errors}");
    let (whole, merged) = (files(&here.path().join("whole")), files(&here.path().join("merged")));
    for name in ["bootstrap.csv", "posterior.csv", "profiles.csv", "sensitivity.csv"] {
        assert!(whole.contains_key(name), "`{name}` is missing: {:?}", whole.keys());
    }
    assert_eq!(whole.keys().collect::<Vec<_>>(), merged.keys().collect::<Vec<_>>());
    for (name, bytes) in &whole {
        assert!(bytes == &merged[name], "`{name}` differs");
    }
}

#[test]
fn shards_that_are_missing_or_of_another_study_are_named() {
    let here = here();
    for number in ["1/4", "3/4", "1/2"] {
        shard(&here, number, &[]);
    }
    let merge = |folders: &[&str]| {
        let arguments = [&["report", "--out", "merged", "--merge"], folders].concat();
        let (code, _, errors) = gapi(&here, &arguments);
        assert_eq!(code, 1, "{errors}");
        errors
    };
    let errors = merge(&["s1of4", "s3of4"]);
    assert!(errors.contains("2 of 4 shards are missing: 2/4, 4/4"), "{errors}");
    let errors = merge(&["s1of4", "s1of2"]);
    assert!(errors.contains("are not shards of one study: 4 shards, and 2"), "{errors}");
    let errors = merge(&["s1of4", "s1of4"]);
    assert!(errors.contains("are both shard 1/4"), "{errors}");
    let errors = merge(&["s1of4", "nowhere"]);
    assert!(errors.contains("`nowhere` contains no shard"), "{errors}");
    // Another model under the same name.
    fs::write(here.path().join("Growth.mo"), MODEL.replace("a*exp", "2*a*exp")).unwrap();
    shard(&here, "2/2", &[]);
    let errors = merge(&["s1of2", "s2of2"]);
    assert!(errors.contains("these differ") && errors.contains("Growth.mo"), "{errors}");
    fs::write(here.path().join("s1of2/shard.part"), "half a file").unwrap();
    let errors = merge(&["s1of2"]);
    assert!(errors.contains("is damaged"), "{errors}");
}

/// The job for Slurm, as the tasks of an array run it; one of them alone a second time.
#[cfg(target_os = "linux")]
#[test]
fn tasks_of_a_slurm_array_are_the_shards_of_one_study() {
    let here = here();
    let job = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/cluster/study.sbatch");
    let task = |number: &str| {
        let mut command = std::process::Command::new("bash");
        command.args([job, "2", "p.toml", "--bootstrap", "--profile"]).current_dir(here.path());
        command.env("GAPI", env!("CARGO_BIN_EXE_gapi")).env("SLURM_ARRAY_TASK_ID", number);
        let output = command.output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    };
    ["1", "2"].into_iter().for_each(task);
    let merge = ["report", "--merge", "shards/1", "shards/2", "--out", "study"];
    assert_eq!(gapi(&here, &merge).0, 0);
    fs::remove_dir_all(here.path().join("shards/2")).unwrap();
    let (code, _, errors) = gapi(&here, &["report", "--merge", "shards/1", "--out", "study"]);
    assert!(code == 1 && errors.contains("missing: 2/2"), "{errors}");
    task("2");
    let (code, _, errors) = gapi(&here, &merge);
    assert_eq!(code, 0, "{errors}");
}

#[test]
fn numbers_of_shards_are_checked() {
    let here = here();
    for wrong in ["0/4", "5/4", "4", "1/0", "a/b", "-1/2"] {
        let (code, _, errors) = gapi(&here, &["identify", "p.toml", &format!("--shard={wrong}")]);
        assert!(code == 2 && errors.contains("such as 3/16"), "{wrong}: {errors}");
    }
}

/// A launcher of MPI jobs starts many equal processes: a program that is built without MPI says so.
#[cfg(not(feature = "mpi"))]
#[test]
fn without_mpi_a_job_is_refused() {
    let here = here();
    let run = |variables: &[(&str, &str)]| {
        let mut command =
            crate::support::program::command(here.path(), &["identify", "p.toml", "--quiet"]);
        let output = command.envs(variables.iter().copied()).output().unwrap();
        (output.status.code(), String::from_utf8(output.stderr).unwrap())
    };
    let (code, errors) = run(&[("OMPI_COMM_WORLD_SIZE", "64"), ("OMPI_COMM_WORLD_RANK", "0")]);
    assert_eq!(code, Some(2));
    assert!(errors.contains("has started 64 processes"), "{errors}");
    assert!(errors.contains("--features mpi") && errors.contains("--shard"), "{errors}");
    // A step of Slurm without any of MPI's ways to start: srun's own default.
    let (code, errors) = run(&[("SLURM_STEP_NUM_TASKS", "8"), ("SLURM_PROCID", "0")]);
    assert!(code == Some(2) && errors.contains("has started 8 processes"), "{errors}");
    // The others are silent.
    assert_eq!(run(&[("PMI_SIZE", "64"), ("PMI_RANK", "5")]), (Some(2), String::new()));
    assert!(!here.path().join("results").exists());
    let alone = [("PMI_SIZE", "2"), ("PMI_RANK", "0"), ("GAPI_MPI", "0")];
    assert_eq!(run(&alone).0, Some(0));
}
