//! Limits of time and memory end every command, in whatever loop it is.

use crate::cli::{folder, gapi};
use std::time::{Duration, Instant};

/// A model of 10¹² components, which nobody can flatten.
fn endless() -> String {
    let levels = (1..=12).map(|n| format!("model M{n} M{} a[10]; end M{n};\n", n - 1));
    format!(
        "package Endless\nmodel M0 Real x = time; end M0;\n{}end Endless;\n",
        levels.collect::<String>()
    )
}

const SLOW: &str = "model Slow parameter Real k = 1; Real x(start = 0, fixed = true);
  equation der(x) = k*sin(1e9*time); annotation(experiment(StopTime = 1e9)); end Slow;
";

const PROBLEM: &str = "model = \"Slow\"
files = [\"Slow.mo\"]
[parameters]
k = { min = 0.5, max = 2 }
[[experiment]]
data = \"data.csv\"
x = \"time\"
outputs = { x = \"x\" }
";

const HUGE_PROBLEM: &str = "model = \"Endless.M12\"
files = [\"Endless.mo\"]
[parameters]
k = { min = 0.5, max = 2 }
[[experiment]]
data = \"data.csv\"
x = \"time\"
outputs = { x = \"x\" }
";

/// A command ends soon with the code of errors, and says which limit it was.
fn ends(arguments: &[&str], limit: [&str; 2], words: &str) {
    let here = folder(&[
        ("Endless.mo", &endless()),
        ("Slow.mo", SLOW),
        ("slow.toml", PROBLEM),
        ("endless.toml", HUGE_PROBLEM),
        ("endless.mos", "openModel(\"Endless.mo\");\ntranslateModel(\"Endless.M12\");\n"),
        ("data.csv", "time,x\n0,0\n1e9,1\n"),
    ]);
    let started = Instant::now();
    let (code, _, errors) = gapi(&here, &[arguments, &limit].concat());
    assert_eq!(code, 1, "{arguments:?}: {errors}");
    assert!(errors.contains("error[limit-reached]") && errors.contains(words), "{errors}");
    assert!(started.elapsed() < Duration::from_secs(20), "{arguments:?}");
}

const COMMANDS: [&[&str]; 5] = [
    &["check", "Endless.mo", "--model", "Endless.M12"],
    &["flatten", "Endless.mo", "--model", "Endless.M12"],
    &["simulate", "Endless.mo", "--model", "Endless.M12"],
    &["identify", "endless.toml"],
    &["run", "endless.mos"],
];

#[test]
fn what_does_not_listen_ends_with_the_process() {
    for command in COMMANDS {
        ends(command, ["--time-limit", "0.3"], "limit of time is reached: 0.3 s");
    }
}

#[test]
#[cfg(target_os = "linux")]
fn what_takes_too_much_memory_ends() {
    for command in COMMANDS {
        ends(command, ["--memory-limit", "120"], "limit of memory is reached: 120 MiB");
    }
}

#[test]
fn simulations_end() {
    ends(&["simulate", "Slow.mo"], ["--time-limit", "0.3"], "limit of time");
}

#[test]
fn what_ends_in_time_does_not_meet_its_limits() {
    let here = folder(&[("M.mo", "model M Real x = time; end M;")]);
    for command in ["check", "flatten", "simulate"] {
        let (code, _, errors) =
            gapi(&here, &[command, "M.mo", "--time-limit", "60", "--memory-limit", "4000"]);
        assert_eq!((code, errors.as_str()), (0, ""));
    }
}
