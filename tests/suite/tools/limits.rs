//! Limits of time and memory end every command, in whatever loop it is.

use crate::support::program::{folder, gapi};
use std::time::{Duration, Instant};

/// A model that takes long to be compiled, and more memory than is allowed here.
const LARGE: &str = "package Large model E Real a = time; end E;
  model M E e[400000]; end M; end Large;";

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

const HUGE_PROBLEM: &str = "model = \"Large.M\"
files = [\"Large.mo\"]
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
        ("Large.mo", LARGE),
        ("Slow.mo", SLOW),
        ("slow.toml", PROBLEM),
        ("large.toml", HUGE_PROBLEM),
        ("large.mos", "openModel(\"Large.mo\");\ntranslateModel(\"Large.M\");\n"),
        ("data.csv", "time,x\n0,0\n1e9,1\n"),
    ]);
    let started = Instant::now();
    let (code, _, errors) = gapi(&here, &[arguments, &limit].concat());
    assert_eq!(code, 1, "{arguments:?}: {errors}");
    assert!(errors.contains("error[limit-reached]") && errors.contains(words), "{errors}");
    assert!(started.elapsed() < Duration::from_secs(20), "{arguments:?}");
}

const COMMANDS: [&[&str]; 5] = [
    &["check", "Large.mo", "--model", "Large.M"],
    &["flatten", "Large.mo", "--model", "Large.M"],
    &["simulate", "Large.mo", "--model", "Large.M"],
    &["identify", "large.toml"],
    &["run", "large.mos"],
];

#[test]
fn what_does_not_listen_ends_with_the_process() {
    for command in COMMANDS {
        ends(command, ["--time-limit", "0.3"], "time limit is reached: 0.3 s");
    }
}

#[test]
#[cfg(target_os = "linux")]
fn what_takes_too_much_memory_ends() {
    for command in COMMANDS {
        ends(command, ["--memory-limit", "120"], "memory limit is reached: 120 MiB");
    }
}

#[test]
fn simulations_end() {
    ends(&["simulate", "Slow.mo"], ["--time-limit", "0.3"], "time limit");
}

/// A million points of a pendulum take minutes; what there is after the limit is in the file.
#[test]
fn a_simulation_that_is_stopped_writes_what_it_has() {
    let text =
        "model Pendulum Real x(start = 1, fixed = true); Real v(start = 0, fixed = true); equation
      der(x) = v; der(v) = -1e6*sin(x); end Pendulum;";
    let here = folder(&[("Pendulum.mo", text)]);
    let arguments =
        ["simulate", "Pendulum.mo", "--stop-time", "1e5", "--intervals", "1000000", "-o", "x.csv"];
    let (code, out, errors) = gapi(&here, &[&arguments[..], &["--time-limit", "3"]].concat());
    assert_eq!(code, 1, "{errors}");
    assert!(errors.contains("error[limit-reached]: the time limit is reached: 3 s"), "{errors}");
    assert!(out.contains("Pendulum: 0 s to ") && out.contains("trajectories: x.csv"), "{out}");
    let written = std::fs::read_to_string(here.path().join("x.csv")).unwrap();
    let times = written.lines().skip(1).map(|line| line.split(',').next().unwrap().parse::<f64>());
    let times = times.collect::<Result<Vec<f64>, _>>().unwrap();
    let last = times.last().unwrap();
    assert!(*last > 0.0 && *last < 1e5, "{last}");
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

/// A check of one class of a file: exit code, and its messages.
fn checked(text: &str, class: &str, more: &[&str]) -> (i32, String) {
    let here = folder(&[("P.mo", text)]);
    let arguments = [&["check", "P.mo", "--model", class], more].concat();
    let (code, output, errors) = gapi(&here, &arguments);
    (code, output + &errors)
}

/// Classes numbered 1 to `count`, as `text` writes them, in a package `P` with what comes before.
fn package(before: &str, count: usize, text: impl Fn(usize) -> String) -> String {
    let classes: String = (1..=count).map(|n| text(n) + "\n").collect();
    format!("package P\n{before}\n{classes}end P;\n")
}

/// Enough memory for what is refused early, and too little for what is built.
const LITTLE: [&str; 2] = ["--memory-limit", "500"];

#[test]
#[cfg(target_os = "linux")]
fn what_grows_exponentially_is_refused_before_it_is_built() {
    let plain = |n: usize| format!("replaceable model M{n} M{0} a; M{0} b; end M{n};", n - 1);
    let redeclared = |n: usize| {
        format!(
            "package P{n} package Q = P{0}; replaceable model M Q.M a; Q.M b; end M; end P{n};",
            n - 1
        )
    };
    let passed_on = |n: usize| {
        format!(
            "model M{n} replaceable model T = M{0}; T a(redeclare model T = M{0}); \
             T b(redeclare model T = M{0}); end M{n};",
            n - 1
        )
    };
    let simple = "model M0 Real x = time; end M0;";
    let packed = "package P0 replaceable model M Real x = time; end M; end P0;";
    let open = "model B Real x = time; end B; model M0 replaceable model T = B; T t; end M0;";
    let cases = [
        (package(simple, 40, plain), "P.M40"),
        (package(packed, 40, redeclared), "P.P40.M"),
        (package(open, 40, passed_on), "P.M40"),
    ];
    for (text, class) in cases {
        let (code, said) = checked(&text, class, &LITTLE);
        assert_eq!(code, 1, "{class}: {said}");
        assert!(said.contains("error["), "{said}");
        assert!(!said.contains("limit-reached"), "{class}: {said}");
        assert!(said.contains("P.mo:"), "it says where: {said}");
    }
}

#[test]
fn what_grows_exponentially_says_what_and_where() {
    let text = package("model M0 Real x = time; end M0;", 40, |n| {
        format!("model M{n} M{0} a, b; end M{n};", n - 1)
    });
    let (_, said) = checked(&text, "P.M40", &[]);
    assert!(
        said.contains("error[too-large]: the model has more than 1000000 components"),
        "{said}"
    );
    assert!(said.contains("`P.M19` alone would contain"), "{said}");
    assert!(said.contains("help: each of its classes contains several components"), "{said}");
}

#[test]
fn exponentially_many_comparisons_are_made_once() {
    let text = package("model M0 Real x = time; end M0; model T R40 r; S40 s; end T;", 40, |n| {
        let m = n - 1;
        let held = if n == 1 { "Real a, b;".to_owned() } else { format!("@{m} a, b;") };
        ["R", "S"]
            .map(|kind| format!("record {kind}{n} {} end {kind}{n};", held.replace('@', kind)))
            .join("\n")
    });
    // One is compared with the other, component by component.
    let text = text.replace(
        "model T R40 r; S40 s; end T;",
        "model U replaceable record T = R40; end U; \
                            model T U u(redeclare record T = S40); end T;",
    );
    let (code, said) = checked(&text, "P.T", &["--time-limit", "60"]);
    assert_eq!(code, 0, "{said}");
}

#[test]
fn the_square_of_long_chains_of_bases_is_not_counted() {
    // With the square of the length, or its cube, this does not end in these limits.
    let text = package("model M0 Real x0 = time; end M0;", 3000, |n| {
        format!("model M{n} extends M{0}; Real x{n} = x{0}; end M{n};", n - 1)
    });
    let (code, said) = checked(&text, "P.M3000", &["--time-limit", "60", "--memory-limit", "600"]);
    assert_eq!(code, 0, "{said}");
    assert!(said.contains("3001"), "{said}");
}

#[test]
fn large_arrays_and_records_are_linear() {
    let array = "model A Real x[30000](each start = 1, each fixed = true); equation
        for i in 1:30000 loop der(x[i]) = -x[i]; end for; end A;";
    let (code, said) = checked(array, "A", &["--time-limit", "60"]);
    assert_eq!(code, 0, "{said}");
    let fields: String = (0..30_000).map(|n| format!("Real f{n} = {n};\n")).collect();
    let record = format!("model R record D {fields} end D; parameter D d; Real y = d.f5; end R;");
    let (code, said) = checked(&record, "R", &["--time-limit", "60"]);
    assert_eq!(code, 0, "{said}");
}

#[test]
fn long_names_are_shortened_in_messages() {
    let name = "a".repeat(200_000);
    for text in [
        format!("model B Real x = {name}; end B;"),
        format!("model B {name} x; end B;"),
        format!("model B Real x = time; equation {name}; end B;"),
        format!("model B Real x = time; Real {name}; end B;"),
        format!("model B Real x = time; end {name};"),
    ] {
        let (code, said) = checked(&text, "B", &[]);
        assert_eq!(code, 1);
        assert!(said.len() < 3000 && said.contains("P.mo:1"), "{} bytes", said.len());
    }
}

/// Calls itself twice: f(60) takes 5·10¹² calls.
const FIBONACCI: &str = "function f input Integer n; output Real y; algorithm
    y := if n < 2 then 1 else f(n - 1) + f(n - 2); end f;";

fn fibonacci(prefix: &str, argument: &str) -> String {
    format!("model Fib {FIBONACCI} {prefix} Real c = f({argument}); Real x = c*time; end Fib;")
}

#[test]
fn functions_of_exponential_cost_end_everywhere() {
    let problem = PROBLEM.replace("Slow", "Fib");
    for (prefix, commands) in [
        ("constant", ["check", "simulate"].as_slice()),
        ("final parameter", &["simulate"]),
        ("parameter", &["simulate"]),
    ] {
        let text = fibonacci(prefix, "60").replace("model Fib", "model Fib parameter Real k = 1;");
        let here = folder(&[
            ("Fib.mo", &text),
            ("fib.toml", &problem),
            ("data.csv", "time,x\n0,0\n1,1\n"),
        ]);
        for command in commands {
            let (code, _, errors) = gapi(&here, &[command, "Fib.mo", "--instruction-limit", "1"]);
            assert_eq!(code, 1, "{errors}");
            assert!(errors.contains("more than 1 million instructions"), "{errors}");
            assert!(errors.contains("--instruction-limit"), "{errors}");
            assert!(!errors.contains("loop does not end"), "{errors}");
        }
        // A search whose individuals all fail goes on until the time is over.
        let limits = ["--instruction-limit", "1", "--time-limit", "5"];
        let (code, _, errors) = gapi(&here, &[&["identify", "fib.toml"][..], &limits].concat());
        assert_eq!(code, 1, "{errors}");
    }
}

#[test]
fn the_limit_of_instructions_can_be_changed() {
    // A call takes millions of instructions.
    let text = fibonacci("", "26 + integer(time)");
    let here = folder(&[("Fib.mo", &text)]);
    let arguments = ["simulate", "Fib.mo", "--stop-time", "0.1", "--intervals", "1"];
    let run =
        |limit: &str| gapi(&here, &[&arguments[..], &["--instruction-limit", limit]].concat());
    let (code, _, errors) = run("1");
    assert_eq!(code, 1);
    assert!(errors.contains("more than 1 million instructions"), "{errors}");
    let (code, _, errors) = run("100");
    assert_eq!(code, 0, "{errors}");
    // Unless it says otherwise, the command allows more than the library does.
    let here = folder(&[("Fib.mo", &fibonacci("", "30 + integer(time)"))]);
    assert!(gapi(&here, &[&arguments[..], &["--instruction-limit", "20"]].concat()).0 == 1);
    let (code, _, errors) = gapi(&here, &arguments);
    assert_eq!(code, 0, "{errors}");
}

#[test]
#[cfg(unix)]
fn pipes_and_devices_do_not_keep_a_command_waiting() {
    let here = folder(&[
        ("Slow.mo", SLOW),
        ("slow.toml", &PROBLEM.replace("data.csv", "pipe")),
        ("pipe.mos", "readFile(\"pipe\");\n"),
        ("device.mos", "readFile(\"/dev/zero\");\n"),
    ]);
    let made = std::process::Command::new("mkfifo").arg(here.path().join("pipe")).status();
    assert!(made.is_ok_and(|status| status.success()));
    let commands: [&[&str]; 7] = [
        &["check", "pipe", "--time-limit", "0.5"],
        &["simulate", "pipe", "--model", "M", "--time-limit", "0.5"],
        &["flatten", "/dev/zero", "--model", "M", "--time-limit", "0.5"],
        &["identify", "slow.toml", "--time-limit", "0.5"],
        &["identify", "pipe", "--time-limit", "0.5"],
        &["run", "pipe.mos", "--time-limit", "0.5"],
        &["run", "device.mos", "--time-limit", "0.5"],
    ];
    for command in commands {
        let (code, _, errors) = gapi(&here, command);
        assert_eq!(code, 1, "{command:?}: {errors}");
    }
}

#[test]
fn a_filter_keeps_what_is_wanted_and_changes_no_byte_of_it() {
    let model =
        "model M Real x(start = 1, fixed = true), y = -x, z = -y, w = 2*x; parameter Real p = 3;
        equation der(x) = -p*x; annotation(experiment(StopTime = 1)); end M;";
    let here = folder(&[("M.mo", model)]);
    let run = |output: &str, filter: &[&str]| {
        let arguments = [&["simulate", "M.mo", "--output", output], filter].concat();
        let (code, _, errors) = gapi(&here, &arguments);
        assert_eq!((code, errors.as_str()), (0, ""));
        std::fs::read_to_string(here.path().join(output)).unwrap()
    };
    let all = run("all.csv", &[]);
    let some = run("some.csv", &["--variable-filter", "y|z|p"]);
    let header: Vec<&str> = all.lines().next().unwrap().split(',').collect();
    let wanted = ["\"time\"", "\"y\"", "\"z\"", "\"p\""];
    let kept: Vec<usize> = (0..header.len()).filter(|at| wanted.contains(&header[*at])).collect();
    let expected: String = all
        .lines()
        .map(|line| {
            let cells: Vec<&str> = line.split(',').collect();
            kept.iter().map(|at| cells[*at]).collect::<Vec<_>>().join(",") + "\n"
        })
        .collect();
    assert_eq!(some, expected);
}

/// Trees of a million statements take more memory than the machine of a student has.
#[test]
#[cfg(target_os = "linux")]
fn long_scripts_are_not_kept_as_trees() {
    let text = "x = 0;\n".to_owned() + &"x = x + 1;\n".repeat(150_000) + "print(String(x))\n";
    let here = folder(&[("long.mos", &text)]);
    // 150 to 160 MiB, somewhat more on a busy machine; with the trees it takes 300.
    let (code, out, errors) = gapi(&here, &["run", "long.mos", "--memory-limit", "220"]);
    assert_eq!((code, out.trim()), (0, "150000"), "{errors}");
}

/// The memory that a script asks for may not be there: that ends the statement and not the process.
#[test]
#[cfg(target_os = "linux")]
fn memory_that_is_not_there_is_an_error() {
    let many = |begin: &str, one: fn(usize) -> String| {
        begin.to_owned() + &(1..=20).map(one).collect::<String>()
    };
    for (asked, slug) in [
        (many("", |k| format!("x{k} = fill(1.0, 4000, 4000);\n")), "array-too-large"),
        (
            many("x0 = zeros(4000, 4000);\n", |k| format!("x{k} = x{} + x0;\n", k - 1)),
            "array-too-large",
        ),
        (
            many("s = \"abcdefgh\";\nfor k in 1:24 loop s := s + s; end for;\n", |k| {
                format!("s{k} = s + String({k});\n")
            }),
            "string-too-long",
        ),
    ] {
        let here = folder(&[("big.mos", &asked)]);
        let gapi = env!("CARGO_BIN_EXE_gapi");
        let script = format!("ulimit -v 1800000; exec {gapi} run big.mos");
        let mut command = std::process::Command::new("sh");
        let output = command.args(["-c", &script]).current_dir(here.path()).output().unwrap();
        let errors = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(1), "{errors}");
        assert!(errors.contains(slug) && errors.contains("there is no memory"), "{errors}");
    }
}

/// What grows by doubling meets the limit of its kind long before there is no memory.
#[test]
#[cfg(target_os = "linux")]
fn what_is_doubled_again_and_again_meets_a_limit() {
    let (code, _, errors) = {
        let text = "x := {1};\nfor i in 1:60 loop x := {x, x}; end for;\n";
        let here = folder(&[("a.mos", text)]);
        gapi(&here, &["run", "a.mos", "--memory-limit", "1500"])
    };
    assert!(code == 1 && errors.contains("array-too-large"), "{errors}");
    let text = "function g output Integer n; protected String s = \"a\"; algorithm \
        for i in 1:100 loop s := s + s; end for; n := Modelica.Utilities.Strings.length(s); end g; \
        model M parameter Integer n = g(); Real x = n; end M;";
    let (code, said) = checked(text, "M", &["--memory-limit", "2500"]);
    assert!(code == 1 && said.contains("string-too-long"), "{said}");
}

/// A name of 100,000 parts took two seconds, and four times as long for twice as many.
#[test]
fn names_of_many_parts_are_looked_up_once() {
    let text = format!("x := a{}\n", ".b".repeat(300_000));
    let here = folder(&[("n.mos", &text)]);
    let (code, _, errors) = gapi(&here, &["run", "n.mos", "--time-limit", "10"]);
    assert!(code == 1 && !errors.contains("limit-reached"), "{}", &errors[..500]);
}

#[test]
fn outputs_have_a_most_number_of_points() {
    let text = "model M Real x; equation der(x) = 1; \
        annotation(experiment(StopTime = 1e300, Interval = 1e-300)); end M;";
    let here = folder(&[("M.mo", text)]);
    let (code, _, errors) = gapi(&here, &["simulate", "M.mo", "--memory-limit", "500"]);
    assert!(code == 1 && errors.contains("intervals"), "{errors}");
}

/// Components of components are no cycle, however deep.
#[test]
fn deep_nesting_is_not_called_a_cycle() {
    let classes = (1..=80).map(|n| format!("model A{n} A{} a; end A{n};\n", n - 1));
    let text = "model A0 Real x = 1; end A0;\n".to_owned() + &classes.collect::<String>();
    let (code, said) = checked(&text, "A80", &[]);
    assert!(code == 0 || said.contains("nested more than"), "{said}");
    assert!(!said.contains("cyclic"), "{said}");
}

#[test]
fn what_a_call_says_goes_before_experiment() {
    let model = "model M Real x; equation der(x) = 1; end M;";
    let text = "experiment(NumberOfIntervals = 10)\n\
        simulateModel(\"M\", stopTime = 3, outputInterval = 0.5, resultFile = \"r\")\n\
        print(String(readTrajectorySize(\"r.mat\")))\n";
    let here = folder(&[("M.mo", model), ("a.mos", &("openModel(\"M.mo\")\n".to_owned() + text))]);
    let (code, out, errors) = gapi(&here, &["run", "a.mos"]);
    assert_eq!((code, out.lines().last()), (0, Some("7")), "{errors}");
}

/// Spreadsheets compute cells that begin as formulas do.
#[test]
fn names_in_written_tables_are_no_formulas() {
    let text = "writeCSVmatrix(\"o.csv\", {\"=cmd|x\", \"+1\", \"-a\", \"@b\", \"plain\"}, \
        {{1.0, 2, 3, 4, 5}});\n";
    let here = folder(&[("a.mos", text)]);
    let (code, _, errors) = gapi(&here, &["run", "a.mos"]);
    assert_eq!(code, 0, "{errors}");
    let written = std::fs::read_to_string(here.path().join("o.csv")).unwrap();
    let first = written.lines().next().unwrap();
    assert_eq!(first, "\"'=cmd|x\";\"'+1\";\"'-a\";\"'@b\";\"plain\"");
}
