//! The lessons of `gapi lesson`: unsolved, each fails with a message that guides; solved, it passes;
//! a wrong answer fails for the reason that it says.

use crate::support::program::{command, folder, gapi};
use crate::support::shipped::project;
use gapilib::Value;
use gapilib::internals::lessons::{self, Lesson, Verdict};
use gapilib::world::MemoryWorld;
use gapilib::{Reporting, Session};
use serde::Deserialize;
use std::io::{BufRead as _, BufReader};
use std::process::Stdio;
use tempfile::TempDir;

fn lesson(number: usize) -> &'static Lesson {
    &lessons::all()[number - 1]
}

/// What the check says of a text of the learner; nothing where it passes.
fn said(lesson: &Lesson, text: &str, companions: &[(String, String)]) -> String {
    match lessons::check(lesson, text, companions) {
        Verdict::Passed => String::new(),
        Verdict::NotYet(message) => message,
        Verdict::Stopped => panic!("nobody stops it"),
    }
}

#[test]
fn every_unsolved_lesson_fails_with_a_message_that_guides() {
    let mut all = String::new();
    for lesson in lessons::all() {
        let message = said(lesson, &lesson.text, &lesson.companions);
        assert!(!message.is_empty(), "lesson {} passes unsolved", lesson.number);
        all.push_str(&format!("Lesson {}\n{message}\n\n", lesson.number));
    }
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path("../../lessons");
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings.bind(|| insta::assert_snapshot!("unsolved", all));
}

#[test]
fn every_solution_passes() {
    let mut wrong = String::new();
    for lesson in lessons::all() {
        let (text, companions) = lesson.solved();
        let message = said(lesson, &text, &companions);
        if !message.is_empty() {
            wrong.push_str(&format!("lesson {}:\n{message}\n", lesson.number));
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}

/// An answer that a learner may give, and a part of what it is said to be wrong with.
#[derive(Deserialize)]
struct Answer {
    lesson: usize,
    /// What is replaced in the solved lesson, and with what.
    change: Vec<[String; 2]>,
    says: String,
}

#[derive(Deserialize)]
struct Answers {
    answer: Vec<Answer>,
}

#[test]
fn wrong_answers_fail_for_the_reason_that_is_said() {
    let file = std::fs::read_to_string(project("tests/lessons/wrong_answers.toml")).unwrap();
    let answers: Answers = toml::from_str(&file).unwrap();
    let mut wrong = Vec::new();
    for Answer { lesson: number, change, says } in &answers.answer {
        let lesson = lesson(*number);
        let (mut text, mut companions) = lesson.solved();
        for [old, new] in change {
            let files = companions.iter_mut().map(|(_, text)| text).chain([&mut text]);
            let found: Vec<&mut String> = files.filter(|text| text.contains(old)).collect();
            assert_eq!(found.len(), 1, "lesson {number} has no `{old}`");
            found.into_iter().for_each(|text| *text = text.replace(old, new));
        }
        let message = said(lesson, &text, &companions);
        if !message.contains(says) {
            wrong.push(format!("lesson {number}, {change:?}:\n{message}\n"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    for lesson in lessons::all() {
        let of_this = answers.answer.iter().filter(|answer| answer.lesson == lesson.number);
        assert!(of_this.count() >= 2, "lesson {} has too few wrong answers", lesson.number);
    }
}

#[test]
fn an_answer_that_ends_with_an_error_never_passes() {
    for lesson in lessons::all() {
        let (text, companions) = lesson.solved();
        let message = said(lesson, &format!("{text}\nx := 1/{{0}};\n"), &companions);
        assert!(message.contains("The script ends with an error"), "{message}");
        let message = said(lesson, &format!("{text}\nassert(false, \"no\");\n"), &companions);
        assert!(message.contains("The script ends with an error"), "{message}");
    }
}

#[test]
fn line_ends_and_letters_of_windows_do_not_matter() {
    let here = folder(&[]);
    for number in [1, 8, 18] {
        let lesson = lesson(number);
        gapi(&here, &["lesson", &number.to_string()]);
        let (text, companions) = lesson.solved();
        let files = companions.iter().chain([&(lesson.file.clone(), text)]).cloned().collect();
        let files: Vec<(String, String)> = files;
        for (name, text) in files {
            let mut bytes = text.replace('\n', "\r\n").into_bytes();
            if name.ends_with(".mos") {
                // Müller in Latin-1.
                bytes.extend(b"// M\xfcller\r\n");
            }
            std::fs::write(here.path().join("lessons").join(name), bytes).unwrap();
        }
        let (code, out, errors) = gapi(&here, &["lesson", &number.to_string()]);
        assert_eq!(code, 0, "{out}{errors}");
        assert!(out.contains(&format!("\nLesson {number} passed.\n")), "{out}");
    }
}

/// Writes the solution of a lesson into the learner's folder.
fn solve(here: &TempDir, number: usize) {
    let (text, companions) = lesson(number).solved();
    let folder = here.path().join("lessons");
    std::fs::write(folder.join(&lesson(number).file), text).unwrap();
    companions.iter().for_each(|(name, text)| std::fs::write(folder.join(name), text).unwrap());
}

#[test]
fn what_is_passed_is_kept_beside_the_copies() {
    let here = folder(&[]);
    let (code, out, _) = gapi(&here, &["lesson"]);
    let lessons = lessons::all().len();
    assert_eq!((code, out.matches("[ ] Lesson ").count()), (0, lessons), "{out}");
    assert!(!here.path().join("lessons").exists(), "a list writes nothing");
    let (code, out, _) = gapi(&here, &["lesson", "4"]);
    assert_eq!(code, 1);
    assert!(out.contains("copied to lessons/04_selection.mos") && out.contains("not passed yet"));
    solve(&here, 4);
    let (code, out, errors) = gapi(&here, &["lesson", "4"]);
    assert_eq!(code, 0, "{out}{errors}");
    assert!(!out.contains("copied") && out.contains("Lesson 4 passed."), "{out}");
    assert!(out.ends_with("The next lesson: gapi lesson 5\n"), "{out}");
    let (_, out, _) = gapi(&here, &["lesson"]);
    assert!(
        out.contains("[x] Lesson 4: ") && out.contains("\n1 of 18 passed. Next: gapi lesson 1\n")
    );
    let (code, out, _) = gapi(&here, &["lesson", "4", "--reset"]);
    assert!(code == 0 && out.contains("04_selection.mos is kept as lessons/04_selection.mos.old"));
    let (_, out, _) = gapi(&here, &["lesson"]);
    assert!(out.contains("[ ] Lesson 4: "), "{out}");
    let (code, _, errors) = gapi(&here, &["lesson", "19"]);
    assert_eq!((code, errors.trim()), (2, "error: there is no lesson 19, only 1 to 18"));
}

#[test]
fn a_lesson_has_a_number_and_names() {
    let here = folder(&[]);
    for name in ["4", "04", "selection", "Selection", "04_selection", "04_selection.mos"] {
        let (code, out, errors) = gapi(&here, &["lesson", name, "--solution"]);
        assert_eq!(code, 0, "{name}: {errors}");
        assert!(out.starts_with("A solution of lesson 4: selection\n"), "{name}: {out}");
    }
    let (code, out, errors) = gapi(&here, &["lesson", "drei"]);
    assert_eq!((code, out.as_str()), (2, ""));
    let numbered = "error: `drei` is not a lesson\n = help: give the number of one of these:\n    \
        1  find one parameter by hand\n";
    assert!(errors.starts_with(numbered), "{errors}");
    assert!(errors.ends_with("   18  your own model and your own data\n"), "{errors}");
    let (code, _, errors) = gapi(&here, &["lesson", "mutaton"]);
    let near = "error: `mutaton` is not a lesson\n = help: did you mean 6, \"mutation\"?\n";
    assert!(code == 2 && errors.starts_with(near), "{errors}");
    assert!(!here.path().join("lessons").exists(), "a question writes nothing");
}

#[test]
fn damaged_progress_is_an_error_and_not_lost() {
    let here = folder(&[]);
    gapi(&here, &["lesson", "1"]);
    let file = here.path().join("lessons/progress.toml");
    std::fs::write(&file, "passed = yes\n").unwrap();
    let (code, _, errors) = gapi(&here, &["lesson"]);
    assert!(code == 1 && errors.contains("progress.toml") && errors.contains("help"), "{errors}");
    assert_eq!(std::fs::read_to_string(file).unwrap(), "passed = yes\n");
}

#[test]
fn every_hint_is_reached_one_after_another() {
    let here = folder(&[]);
    for lesson in lessons::all() {
        let number = lesson.number.to_string();
        let of = lesson.hints.len();
        for (k, hint) in lesson.hints.iter().enumerate() {
            let (code, out, errors) = gapi(&here, &["lesson", &number, "--hint"]);
            assert_eq!(code, 0, "{errors}");
            assert_eq!(out.matches("Hint ").count(), k + 1, "{out}");
            assert!(out.contains(&format!("Hint {} of {of}: {hint}\n", k + 1)), "{out}");
        }
        let (_, out, _) = gapi(&here, &["lesson", &number, "--hint"]);
        assert!(
            out.ends_with(&format!("The solution: gapi lesson {number} --solution\n")),
            "{out}"
        );
        let (_, out, _) = gapi(&here, &["lesson", &number, "--solution"]);
        let filled = lesson.solution.iter().map(|[_, filled]| filled.trim());
        assert!(filled.clone().all(|filled| out.contains(filled)), "{out}");
    }
}

#[test]
fn a_saved_copy_is_checked_again() {
    let here = folder(&[]);
    let mut watching = command(here.path(), &["lesson", "2", "--watch"]);
    let mut watching = watching.stdout(Stdio::piped()).spawn().unwrap();
    let mut lines = BufReader::new(watching.stdout.take().unwrap()).lines().map_while(Result::ok);
    let waits = |line: &String| line.starts_with("Waiting for the next save");
    assert!(lines.any(|line| line == "Lesson 2 is not passed yet."));
    assert!(lines.any(|line| waits(&line)));
    solve(&here, 2);
    assert!(lines.any(|line| line == "Lesson 2 passed."));
    assert!(lines.any(|line| waits(&line)));
    watching.kill().unwrap();
    watching.wait().unwrap();
}

/// What lesson 3 says about random search, over 20 seeds: ten times as many individuals make the best
/// fitness about ten times smaller.
#[test]
fn ten_times_as_many_random_individuals_gain_a_factor_of_ten() {
    let (text, _) = lesson(3).solved();
    let mean_of_log = |count: usize| {
        let counts = format!("for Count in {{{count}}} loop");
        let text = text.replace("for Count in {1, 10, 100, 1000} loop", &counts);
        let best = |stream| {
            let mut session = Session::new(Box::new(MemoryWorld::new()));
            session.options.reporting = Reporting::Off;
            session.use_stream(stream);
            assert_eq!(session.run_text("lesson 3", &text).code, 0);
            match session.variable("Best") {
                Some(Value::Real(best)) => best.ln(),
                other => panic!("{other:?}"),
            }
        };
        (1..=20).map(best).sum::<f64>() / 20.0
    };
    let factor = (mean_of_log(50) - mean_of_log(500)).exp();
    assert!((4.0..25.0).contains(&factor), "{factor}");
}

/// A learner can watch every lesson, also unsolved, step by step.
#[test]
fn every_lesson_can_be_watched() {
    let here = folder(&[]);
    for lesson in lessons::all() {
        let (text, companions) = lesson.solved();
        std::fs::write(here.path().join(&lesson.file), text).unwrap();
        for (name, text) in companions {
            std::fs::write(here.path().join(name), text).unwrap();
        }
        let (code, out, errors) = gapi(&here, &["teach", &lesson.file]);
        assert_eq!(code, 0, "lesson {}: {errors}", lesson.number);
        assert!(out.contains("step 1 of"), "lesson {}: {out}", lesson.number);
    }
}
