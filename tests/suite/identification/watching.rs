//! Runs that somebody watches: views, pauses in which settings change, and scripts that are
//! interrupted and go on.

use gapilib::internals::script::runs::view::View;
use gapilib::world::{MemoryWorld, Views};
use gapilib::{Journaling, Options, Session};
use std::path::PathBuf;
use std::sync::{Arc, Mutex};

/// Each generation comes nearer to 0.8 by the fraction F.
const SCRIPT: &str = include_str!("../../data/models/watching_script.mos");

fn run(world: MemoryWorld, journaling: Journaling) -> (u8, String, Session) {
    let streams = world.streams();
    let options = Options { journaling, ..Options::default() };
    let mut session = Session::new(Box::new(world)).with_options(options);
    let status = session.run_text("line.mos", SCRIPT);
    (status.code, streams.output() + &streams.errors(), session)
}

fn journal(session: &Session) -> PathBuf {
    session.world.output_dir().join("script.journal")
}

fn result(session: &Session) -> String {
    let path = session.world.output_dir().join("result.json");
    String::from_utf8(session.world.read(&path).expect("results")).expect("text")
}

#[test]
fn scripts_that_are_interrupted_resume_to_the_same_end() {
    let (code, text, whole) = run(MemoryWorld::new(), Journaling::Fresh(2.0));
    assert_eq!(code, 0, "{text}");
    assert!(!whole.world.exists(&journal(&whole)), "it ended");
    let mut answered = Vec::new();
    for patience in 3..200 {
        let world = MemoryWorld::new().interrupted_after(patience);
        let (code, text, cut) = run(world, Journaling::Fresh(2.0));
        if code == 0 {
            break;
        }
        assert_eq!(code, 130, "{text}");
        let Ok(bytes) = cut.world.read(&journal(&cut)) else { continue };
        answered.push(bytes.len());
        for damage in [0, 3] {
            let kept = bytes[..bytes.len() - damage].to_vec();
            let world = MemoryWorld::new().with_file(journal(&cut), kept);
            let (code, text, resumed) = run(world, Journaling::Resume(2.0));
            assert_eq!(code, 0, "{text}");
            assert!(text.contains("calls of Eval are replayed"), "{text}");
            assert_eq!(resumed.variable("pop"), whole.variable("pop"));
            assert_eq!(result(&resumed), result(&whole));
            assert!(!resumed.world.exists(&journal(&resumed)));
        }
    }
    answered.dedup();
    assert!(answered.len() > 2, "interrupted at several places: {answered:?}");
}

#[test]
fn what_was_typed_in_a_pause_is_done_again_when_the_run_resumes() {
    let typing = || MemoryWorld::new().paused_after(3, &["F := 0.5", "nonsense(1)", "x = F + 1"]);
    let (_, text, whole) = run(typing(), Journaling::Fresh(2.0));
    assert!(text.contains("Paused") && text.contains("nonsense"), "{text}");
    assert_eq!(whole.variable("x"), Some(&1.5.into()));
    let changed = result(&whole);
    assert!(changed.contains("F := 0.5") && !changed.contains("nonsense"), "{changed}");
    let interrupted = |patience| {
        let (_, _, cut) = run(typing().interrupted_after(patience), Journaling::Fresh(2.0));
        Some((cut.world.read(&journal(&cut)).ok()?, cut))
    };
    let (bytes, cut) = (3..80).rev().find_map(interrupted).expect("interrupted behind an `Eval`");
    let world = MemoryWorld::new().with_file(journal(&cut), bytes);
    let (_, text, resumed) = run(world, Journaling::Resume(2.0));
    assert!(!text.contains("Paused"), "{text}");
    assert_eq!(resumed.variable("pop"), whole.variable("pop"));
    assert_eq!(result(&resumed), changed);
    let (_, _, plain) = run(MemoryWorld::new(), Journaling::Fresh(2.0));
    assert_ne!(plain.variable("pop"), whole.variable("pop"), "the change has changed something");
}

/// What cannot be a change is refused with the reason, and the run ends as if it had not been typed.
#[test]
fn changes_that_cannot_be_are_refused_and_the_run_continues() {
    let (_, _, plain) = run(MemoryWorld::new(), Journaling::Off);
    for (line, says) in [
        ("garbage (", "error"),
        ("f := 0.5", "did you mean `F`?"),
        ("F_Mut := 0.5", "the script has no variable `F_Mut`"),
        ("F := 0,5", "numbers have a decimal point"),
        ("F := \"much\"", "`F` is a Real"),
        ("F := {0.5, 0.5}", "`F` is a"),
        ("F := 0.5; x := \"much\"", "`x` is a Real"),
    ] {
        let (code, text, typed) = run(MemoryWorld::new().paused_after(3, &[line]), Journaling::Off);
        assert_eq!(code, 0, "{line}: {text}");
        assert!(says == "error" || text.contains(says), "{line}: {text}");
        assert!(text.contains("warning["), "{line}: {text}");
        assert_eq!(typed.variable("F"), Some(&0.2.into()), "{line}");
        assert_eq!(typed.variable("pop"), plain.variable("pop"), "{line}");
    }
}

/// The settings of the genetic algorithm are checked as its functions do.
#[test]
fn settings_out_of_range_are_refused() {
    let settings = "F_Mut = 0.25;\nN_Population = 4;\nN_Parents = 2;\nN_Elitism = 1;\n\
                    N_Parameters = 2;\nParam_Min = {0, 0};\nParam_Max = {1, 1};\n\
                    Cross_Point = {1};\nSeed = [1, 2, 3, 4, 5, 6];\n";
    let script = format!("{settings}{SCRIPT}");
    let with = |line: &str| {
        let world = MemoryWorld::new().paused_after(3, &[line]);
        let streams = world.streams();
        let mut session = Session::new(Box::new(world));
        let code = session.run_text("line.mos", &script).code;
        (code, streams.errors())
    };
    for (line, says) in [
        ("F_Mut := 7", "F_Mut is 7"),
        ("Param_Max[1] := Param_Min[1] - 1", "the range of parameter 1"),
        ("Cross_Point[1] := 9", "the crossing point 9"),
        ("F_Mut := -1", "F_Mut is -1"),
        ("N_Parents := 9", "N_Parents + N_Elitism = 9 + 1"),
        ("N_Parents := 1.5", "use a whole number"),
        ("N_Elitism := -1", "at least 0"),
        ("N_Population := 8", "cannot change in a run"),
        ("Seed := {1, 2, 3}", "keep the type and the size"),
        ("Seed := zeros(6)", "seed"),
    ] {
        let (code, errors) = with(line);
        assert!(code == 0 && errors.contains(says), "{line}: {errors}");
    }
    for line in ["F_Mut := 1", "N_Parents := 3; N_Elitism := 1", "Seed := {6, 5, 4, 3, 2, 1}"] {
        let (code, errors) = with(line);
        assert!(code == 0 && !errors.contains("warning"), "{line}: {errors}");
    }
}

#[test]
fn another_script_does_not_go_on_with_the_journal() {
    let cuts =
        (3..200).map(|k| run(MemoryWorld::new().interrupted_after(k), Journaling::Fresh(2.0)).2);
    let journals = |cut: Session| Some((cut.world.read(&journal(&cut)).ok()?, cut));
    let (bytes, cut) = cuts.filter_map(journals).nth(1).expect("interrupted behind an `Eval`");
    let resumed = |file: Vec<u8>, script: &str, journaling| {
        let world = MemoryWorld::new().with_file(journal(&cut), file);
        let streams = world.streams();
        let options = Options { journaling, ..Options::default() };
        let mut session = Session::new(Box::new(world)).with_options(options);
        let code = session.run_text("line.mos", script).code;
        (code, streams.errors(), session)
    };
    let other = SCRIPT.replace("{0.1}", "{0.2}");
    let (code, text, _) = resumed(bytes.clone(), &other, Journaling::Resume(2.0));
    assert!(code == 1 && text.contains("requests other simulations"), "{text}");
    let (code, text, _) = resumed(b"something".to_vec(), SCRIPT, Journaling::Resume(2.0));
    assert!(code == 1 && text.contains("not a checkpoint"), "{text}");
    // Beginning anew, the old one is kept.
    let (code, text, session) = resumed(bytes.clone(), SCRIPT, Journaling::Fresh(2.0));
    let old = journal(&session).with_file_name("script.journal.1");
    assert!(code == 0 && text.contains("is kept in"), "{text}");
    assert_eq!(session.world.read(&old).expect("kept"), bytes);
}

#[test]
fn a_view_shows_generations_genes_and_fit() {
    let views: Views = Arc::new(Mutex::new(Vec::new()));
    let (code, text, _) = run(MemoryWorld::new().watched(&views), Journaling::Off);
    assert_eq!(code, 0, "{text}");
    let views = views.lock().expect("no panic");
    assert_eq!(views.len(), 9, "one for each generation, and one for the whole run");
    assert_eq!((views[7].progress.done, views[7].best.len()), (7, 7), "`Fit` comes after `Eval`");
    let View { progress, best, spreads, fitted, .. } = &views[8];
    assert_eq!((progress.total, progress.done, best.len()), (8, 8, 8));
    assert!(best.is_sorted_by(|a, b| a >= b), "{best:?}");
    assert_eq!((spreads[0].name.as_str(), spreads[0].unit.as_str()), ("a", "m/s"));
    let [low, middle, high] = spreads[0].generation;
    assert!((low, high) == (0.0, 1.0) && (middle - 2.0 / 3.0).abs() < 1e-9, "{middle}");
    assert!((spreads[0].value - 0.8).abs() < 0.1, "{}", spreads[0].value);
    assert_eq!(progress.label, "evaluation", "no operator makes one of the other");
    assert_eq!(fitted[0].measured, [0.0, 0.4, 0.8]);
    assert!((fitted[0].simulated[2] - spreads[0].value).abs() < 1e-6);
}

#[test]
fn a_view_says_what_is_counted_and_why_simulations_fail() {
    let script = include_str!("../../data/models/watching_failing.mos");
    let views: Views = Arc::new(Mutex::new(Vec::new()));
    let mut session = Session::new(Box::new(MemoryWorld::new().watched(&views)));
    assert_eq!(session.run_text("root.mos", script).code, 0);
    let views = views.lock().expect("no panic");
    let last = &views.last().expect("a view").progress;
    assert_eq!((last.label.as_str(), last.done, last.failures), ("generation", 3, 6));
    let (cause, count) = last.main_cause.as_ref().expect("a cause");
    assert!(cause.contains("`sqrt` has no value") && *count == 6, "{cause} {count}");
}

/// Long enough to be killed: a few hundred generations.
const LONG: &str = include_str!("../../data/models/watching_long.mos");

#[test]
fn scripts_that_are_killed_resume_to_the_same_end() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("long.mos"), LONG).expect("written");
    let gapi = |arguments: &[&str]| {
        let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_gapi"));
        let all = ["run", "long.mos", "--checkpoint", "0.02"];
        command.args(all).args(arguments).current_dir(folder.path()).env_remove("MODELICAPATH");
        command.stdout(std::process::Stdio::null()).stderr(std::process::Stdio::null());
        command
    };
    let started = std::time::Instant::now();
    assert!(gapi(&["--out", "whole"]).status().expect("it runs").success());
    let length = started.elapsed();
    let mut resumed = 0;
    for part in [0.2, 0.35, 0.5, 0.65, 0.8] {
        let mut child = gapi(&["--out", "cut", "--resume"]).spawn().expect("it runs");
        std::thread::sleep(length.mul_f64(part));
        // It may have ended by itself just now.
        let _ = child.kill();
        child.wait().expect("it ends");
        resumed += u64::from(folder.path().join("cut/script.journal").exists());
    }
    assert!(gapi(&["--out", "cut", "--resume"]).status().expect("it runs").success());
    assert!(resumed > 0, "none was killed in the midst");
    for file in ["fit.csv", "history.csv"] {
        let read = |out: &str| std::fs::read(folder.path().join(out).join(file)).expect("written");
        assert!(read("cut") == read("whole"), "{file}");
    }
}
