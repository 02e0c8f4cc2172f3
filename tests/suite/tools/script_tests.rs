//! `gapi test`, `gapi help`, permissions and limits, as a user meets them.

use crate::support::program::{LINE, folder, gapi};
use std::fs;

#[test]
fn accepting_a_script_that_fails_says_so() {
    let here =
        folder(&[("bad.mos", "translateModel(Missing);\nexit(1);\n"), ("good.mos", "a = 1\n")]);
    let (code, out, _) = gapi(&here, &["test", "bad.mos", "--accept"]);
    assert!(code == 0 && out.contains("the script ends with an error"), "{out}");
    let (_, out, _) = gapi(&here, &["test", "good.mos", "--accept"]);
    assert!(!out.contains("ends with an error"), "{out}");
}

#[test]
fn a_transcript_is_accepted_then_agrees_then_differs() {
    let here = folder(&[("a.mos", "x = 1.5\nx + 1\n")]);
    let (code, out, _) = gapi(&here, &["test", "."]);
    assert_eq!(code, 1);
    assert!(out.contains("new") && out.contains("1 do not"), "{out}");
    assert_eq!(gapi(&here, &["test", ".", "--accept"]).0, 0);
    let snap = here.path().join("a.mos.snap");
    let recorded = fs::read_to_string(&snap).expect("a transcript");
    assert_eq!(recorded, ">>> x = 1.5\n>>> x + 1\n = 2.5\n[exit code 0]\n");
    assert_eq!(gapi(&here, &["test", "a.mos"]).0, 0);
    fs::write(&snap, recorded.replace("2.5", "2.500000001")).expect("writable");
    assert_eq!(gapi(&here, &["test"]).0, 0, "numbers are compared with a tolerance");
    fs::write(&snap, recorded.replace("2.5", "2.6")).expect("writable");
    let (code, out, _) = gapi(&here, &["test", "--junit", "report.xml"]);
    assert_eq!(code, 1);
    assert!(out.contains("-  = 2.6\n+  = 2.5"), "{out}");
    let report = fs::read_to_string(here.path().join("report.xml")).expect("a report");
    assert!(report.contains("tests=\"1\" failures=\"1\""), "{report}");
}

#[test]
fn tolerances_are_set_per_script_and_on_the_command_line() {
    let here = folder(&[("a.mos", "x = 1.5\nx + 1\nsize({1, 2}, 1)\n")]);
    let record = |value: &str, size: &str| {
        let transcript =
            format!(">>> x = 1.5\n>>> x + 1\n = {value}\n>>> size({{1, 2}}, 1)\n = {size}\n");
        fs::write(here.path().join("a.mos.snap"), transcript + "[exit code 0]\n").unwrap();
    };
    record("2.501", "2");
    assert_eq!(gapi(&here, &["test"]).0, 1);
    assert_eq!(gapi(&here, &["test", "--tolerance", "1e-3"]).0, 0);
    assert_eq!(gapi(&here, &["test", "--tolerance", "1e-4", "--absolute", "0.0008"]).0, 0);
    assert_eq!(gapi(&here, &["test", "--tolerance", "-1"]).0, 2);
    record("2.500001", "3");
    assert_eq!(gapi(&here, &["test", "--tolerance", "0.9"]).0, 1, "integers are exact");
    record("2.501", "2");
    let set = |line: &str| {
        fs::write(
            here.path().join("a.mos"),
            format!("{line}\nx = 1.5\nx + 1\nsize({{1, 2}}, 1)\n"),
        )
        .unwrap();
    };
    set("// gapi test: tolerance = 1e-3");
    assert_eq!(gapi(&here, &["test"]).0, 0);
    assert_eq!(gapi(&here, &["test", "--tolerance", "1e-6"]).0, 1, "the command line comes first");
    set("// gapi test: tolerance = much");
    let (code, out, _) = gapi(&here, &["test"]);
    assert!(code == 1 && out.contains("`much` is not a tolerance"), "{out}");
    set("// gapi test: skip");
    let (code, out, _) = gapi(&here, &["test"]);
    assert!(code == 1 && out.contains("0 scripts, 0 agree, 0 do not, 1 skipped"), "{out}");
}

#[test]
fn what_has_nothing_to_compare_is_a_failure() {
    let here = folder(&[("a.mos", "x = 1\n"), ("gone.mos.snap", "[exit code 0]\n")]);
    fs::create_dir(here.path().join("empty")).unwrap();
    fs::create_dir_all(here.path().join("results/a")).unwrap();
    // What a run has written is no test, and neither is a table.
    fs::write(here.path().join("results/a/origin.json"), "{}").unwrap();
    fs::write(here.path().join("results/a/calibrated.mos"), "x = 1\n").unwrap();
    fs::write(here.path().join("data.mos"), "#1\ndouble dat(2,2)\n1 2\n3 4\n").unwrap();
    assert_eq!(gapi(&here, &["test", "a.mos", "--accept"]).0, 0);
    let (code, out, _) = gapi(&here, &["test", "."]);
    assert_eq!(code, 1);
    assert!(out.contains("failed   ./gone.mos.snap\n  a transcript without its script"), "{out}");
    assert!(out.contains("2 scripts, 1 agree, 1 do not"), "{out}");
    for (path, why) in [
        ("empty", "there is no script (.mos) in this folder"),
        ("b*.mos", "no file matches this pattern"),
        ("b.mos", "there is no such file or folder"),
    ] {
        let (code, out, _) = gapi(&here, &["test", path]);
        assert!(code == 1 && out.contains(why), "{path}: {out}");
    }
    let (code, out, _) = gapi(&here, &["test", "?.mos"]);
    assert!(code == 0 && out.contains("1 script, 1 agree"), "{out}");
    let (code, out, _) = gapi(&here, &["test", "--list"]);
    assert_eq!(code, 1);
    let expected = "./a.mos  transcript\n./gone.mos.snap  (a transcript without its script \
                    `gone.mos`: remove it)\n";
    assert_eq!(out, expected);
}

#[test]
fn scripts_are_tested_at_the_same_time_and_shown_in_their_order() {
    let names: Vec<String> = (0..6).map(|k| format!("s{k}.mos")).collect();
    let texts: Vec<String> =
        (0..6).map(|k| format!("sum(i for i in 1:{})\n", 40_000 / (k + 1))).collect();
    let files: Vec<(&str, &str)> =
        names.iter().map(String::as_str).zip(texts.iter().map(String::as_str)).collect();
    let here = folder(&files);
    assert_eq!(gapi(&here, &["test", "--accept", "--threads", "3"]).0, 0);
    let (code, out, _) = gapi(&here, &["test", "--threads", "3", "--junit", "report.xml"]);
    let order: String = names.iter().map(|name| format!("ok       ./{name}\n")).collect();
    assert_eq!((code, out), (0, order + "6 scripts, 6 agree, 0 do not\n"));
    let report = fs::read_to_string(here.path().join("report.xml")).expect("a report");
    let times = regex::Regex::new(r#"name="./s\d.mos" time="\d+\.\d{3}"/>"#).unwrap();
    assert_eq!(times.find_iter(&report).count(), 6, "{report}");
}

/// The report of an identification: objective and estimates in a transcript, all of it if asked for.
#[test]
fn sentences_of_a_report_are_compared_if_asked_for() {
    let script = "(S, M, Xexp, Yexp) := Exp_Adq_SISO(\"d.csv\", \"t\", \"y\");\n\
                  P := {{0.5, 1}, {2, 3}};\n\
                  F := Fit(Eval(\"Line.mo\", \"Line\", Xexp, P, {\"a\", \"b\"}, \"x\", \"y\"), Yexp);\n";
    let here = folder(&[
        ("Line.mo", LINE),
        ("d.csv", "t,y\n0,1\n1,3.1\n2,4.9\n3,7\n"),
        ("fit.mos", script),
    ]);
    assert_eq!(gapi(&here, &["test", "--accept"]).0, 0);
    let recorded = fs::read_to_string(here.path().join("fit.mos.snap")).expect("a transcript");
    assert!(recorded.contains("\n  a = 1.03"), "{recorded}");
    for absent in [env!("CARGO_PKG_VERSION"), "minimum", "written", "stopped", "time"] {
        assert!(!recorded.contains(absent), "{absent}: {recorded}");
    }
    assert_eq!(gapi(&here, &["test"]).0, 0);
    let (code, out, _) = gapi(&here, &["test", "--report"]);
    assert!(code == 1 && out.contains("+   version"), "{out}");
    assert_eq!(gapi(&here, &["test", "--report", "--accept"]).0, 0);
    let recorded = fs::read_to_string(here.path().join("fit.mos.snap")).expect("a transcript");
    assert!(recorded.contains("stopped      the script has ended"), "{recorded}");
}

#[test]
fn an_embedded_result_is_compared_as_the_tests_of_openmodelica_are() {
    let good = "x := 1/3;\nx + 1;\nwriteFile(\"left.txt\", \"\");\n// Result:\n// 0.333\n// 1.333\n// true\n// endResult\n";
    let here = folder(&[("good.mos", good), ("bad.mos", &good.replace("1.333", "1.4"))]);
    assert_eq!(gapi(&here, &["test", "good.mos"]).0, 0);
    let (code, out, _) = gapi(&here, &["test", "bad.mos"]);
    assert_eq!(code, 1);
    assert!(out.contains("- 1.4"), "{out}");
    assert!(!here.path().join("left.txt").exists(), "a test writes nothing");
}

#[test]
fn statements_with_an_embedded_result_are_judged_one_by_one() {
    let text = "x := 1;\nnoSuchFunction(x);\ny := 3;\nz := 4;\n// Result:\n// 1\n// 7\n// 2\n// 4\n// endResult\n";
    let here = folder(&[("a.mos", text), ("b.mos", "1 + 1;\n// Result:\n// 2\n// endResult\n")]);
    let (code, out, _) = gapi(&here, &["test", "--junit", "report.xml"]);
    assert_eq!(code, 1);
    assert!(out.contains("  4 statements: 2 agreed, 1 differ, 1 unsupported\n"), "{out}");
    assert!(out.contains("unsupported [unknown-function]: noSuchFunction(x)"), "{out}");
    assert!(out.contains("\n5 statements: 3 agreed, 1 differ, 1 unsupported\n"), "{out}");
    let report = fs::read_to_string(here.path().join("report.xml")).expect("a report");
    assert!(report.contains("tests=\"6\" failures=\"2\" skipped=\"1\""), "{report}");
    assert!(report.contains("name=\"2: noSuchFunction(x)\">\n    <skipped"), "{report}");
}

/// At least 99 % of the scripts below `GAPILIB_SCRIPTS` are read; data is not counted.
#[test]
#[allow(clippy::print_stderr, reason = "a test that is skipped has to say so")]
fn local_scripts_are_read() {
    let Ok(scripts) = std::env::var("GAPILIB_SCRIPTS") else {
        eprintln!("skipped: GAPILIB_SCRIPTS names no folder of scripts");
        return;
    };
    let here = folder(&[]);
    let (_, out, errors) = gapi(&here, &["run", "--parse-only", &scripts]);
    let number = |word: &str| {
        let before = out.split(word).next().expect("a number before the word");
        let last = before.rsplit(|c: char| !c.is_ascii_digit()).find(|part| !part.is_empty());
        last.and_then(|digits| digits.parse::<f64>().ok()).expect("a number")
    };
    let (accepted, rejected) = (number(" accepted"), number(" rejected"));
    eprintln!("{}", out.trim());
    assert!(accepted > 0.0 && rejected <= 0.01 * (accepted + rejected), "{out}{errors}");
}

#[test]
fn scripts_are_read_without_being_run() {
    let here = folder(&[
        ("good.mos", "x = 1\n"),
        ("bad.mos", "x = (1\n"),
        ("data.mos", "#1\ndouble dat(2,2)\n1 2\n3 4\n"),
    ]);
    let (code, out, errors) = gapi(&here, &["run", "--parse-only", "."]);
    assert_eq!((code, out.trim()), (1, "1 accepted, 1 rejected, 1 recognized as data"));
    assert!(errors.contains("unclosed-bracket"), "{errors}");
}

#[test]
fn writing_elsewhere_and_running_programs_need_permission() {
    let elsewhere = folder(&[]);
    let path = elsewhere.path().join("a.txt");
    let text = format!("Modelica.Utilities.Streams.print(\"x\", \"{}\")\n", path.display());
    let here = folder(&[("write.mos", &text), ("run.mos", "system(\"echo hello\")\n")]);
    let (code, _, errors) = gapi(&here, &["run", "write.mos"]);
    assert_eq!(code, 1);
    assert!(errors.contains("--allow-write") && !path.exists(), "{errors}");
    assert_eq!(gapi(&here, &["run", "write.mos", "--allow-write"]).0, 0);
    assert!(path.exists());
    let (code, out, errors) = gapi(&here, &["run", "run.mos"]);
    assert_eq!((code, out.contains("hello")), (1, false));
    assert!(errors.contains("--allow-system"), "{errors}");
    let (code, out, _) = gapi(&here, &["run", "run.mos", "--allow-system"]);
    assert_eq!((code, out.contains("hello")), (0, true));
}

#[test]
fn a_script_is_stopped_at_its_limits() {
    let here = folder(&[
        ("long.mos", "i = 0\nwhile true loop i = i + 1; end while\n"),
        ("large.mos", "v = {fill(1.0, 1000000)}\nwhile true loop v = cat(1, v, v); end while\n"),
    ]);
    let (code, _, errors) = gapi(&here, &["run", "long.mos", "--time-limit", "0.2"]);
    assert_eq!(code, 1);
    assert!(errors.contains("error[limit-reached]"), "{errors}");
    if cfg!(target_os = "linux") {
        let (code, _, errors) = gapi(&here, &["run", "large.mos", "--memory-limit", "200"]);
        assert_eq!(code, 1);
        assert!(errors.contains("memory limit"), "{errors}");
    }
}

/// A message about a name of a megabyte is still one that somebody reads.
#[test]
fn a_very_long_name_is_shortened_in_messages() {
    let text = format!("y = 1 + {}\n", "a".repeat(1_200_000));
    let here = folder(&[("name.mos", &text)]);
    let (code, _, errors) = gapi(&here, &["run", "name.mos"]);
    assert_eq!(code, 1);
    assert!(errors.len() < 2000, "{} bytes", errors.len());
    assert!(errors.contains("there is no variable `aaa") && errors.contains('…'), "{errors}");
    assert!(errors.contains("name.mos:1:9"), "{errors}");
}

#[test]
fn help_prints_declarations_and_the_ledger() {
    let here = folder(&[]);
    let (code, out, _) = gapi(&here, &["help", "simulateModel"]);
    assert_eq!(code, 0);
    assert!(out.contains("function simulateModel") && out.contains("resultFile"), "{out}");
    let (code, _, errors) = gapi(&here, &["help", "simulateModl"]);
    assert_eq!(code, 1);
    assert!(errors.contains("simulateModel"), "{errors}");
    let (code, out, _) = gapi(&here, &["help", "--compat", "openmodelica"]);
    assert_eq!(code, 0);
    assert!(out.contains("OpenModelica\n") && out.contains("getErrorString"), "{out}");
    assert!(!out.contains("Dymola\n"), "{out}");
}

#[test]
fn a_transcript_tells_no_folders() {
    let here = folder(&[("a.mos", "cd()\nx = 1\n")]);
    assert_eq!(gapi(&here, &["run", "a.mos", "--transcript", "t.txt", "--echo"]).0, 0);
    let transcript = fs::read_to_string(here.path().join("t.txt")).expect("a transcript");
    assert!(transcript.contains(">>> cd()\n<start>\n"), "{transcript}");
}
