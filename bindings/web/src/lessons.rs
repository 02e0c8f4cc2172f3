//! The lessons and their checks.

use gapilib::internals::lessons::{self, Verdict};
use serde::{Deserialize, Serialize};

/// All lessons are asked for.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Lessons {}

/// A solution that is to be checked.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Check {
    /// The number of the lesson, from 1.
    lesson: usize,
    /// The learner's script.
    text: String,
    /// The learner's further files: names and contents.
    #[serde(default)]
    companions: Vec<(String, String)>,
}

/// A lesson.
#[derive(Serialize)]
pub(crate) struct Lesson {
    number: usize,
    title: &'static str,
    /// What it is about, and what there is to do.
    introduction: String,
    /// Name of the learner's file.
    file: &'static str,
    /// The unsolved script.
    text: &'static str,
    /// Further files: names and contents.
    companions: &'static [(String, String)],
    hints: &'static [String],
    /// What there is to watch step by step, if there is something.
    watch: Option<&'static str>,
    /// What a solution replaces, and with what.
    solution: &'static [[String; 2]],
}

/// What a check has found.
#[derive(Serialize)]
pub(crate) struct Checked {
    passed: bool,
    /// What the learner has found out, or what does not hold yet.
    text: String,
}

/// All lessons, in order.
pub(crate) fn all() -> Vec<Lesson> {
    let lesson = |lesson: &'static lessons::Lesson| Lesson {
        number: lesson.number,
        title: lesson.title(),
        introduction: lesson.introduction(),
        file: &lesson.file,
        text: &lesson.text,
        companions: &lesson.companions,
        hints: &lesson.hints,
        watch: lesson.watch.as_deref(),
        solution: &lesson.solution,
    };
    lessons::all().iter().map(lesson).collect()
}

/// Checks a solution.
pub(crate) fn checked(check: &Check) -> Result<Checked, String> {
    let lesson = check.lesson.checked_sub(1).and_then(|k| lessons::all().get(k));
    let lesson = lesson.ok_or_else(|| format!("there is no lesson {}", check.lesson))?;
    Ok(match lessons::check(lesson, &check.text, &check.companions) {
        Verdict::Passed => Checked { passed: true, text: lesson.passed.clone() },
        Verdict::Stopped => Checked { passed: false, text: "The check was stopped.".to_owned() },
        Verdict::NotYet(why) => {
            let advice = lessons::advice(lesson, &check.text).join(" ");
            Checked { passed: false, text: format!("{why}\n\n{advice}").trim_end().to_owned() }
        }
    })
}
