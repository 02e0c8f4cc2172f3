//! The lessons that are part of the program: `scripts/lessons/NN_name.mos` is what a learner gets,
//! `NN_name.toml` beside it has the hints, the solution and the checks.

use serde::Deserialize;
use std::collections::BTreeMap;
use std::sync::OnceLock;

/// Names, sorted, and bytes of the files in `scripts/lessons`.
static FILES: &[(&str, &[u8])] = include!(concat!(env!("OUT_DIR"), "/lessons.rs"));

/// One exercise.
#[derive(Debug, Clone)]
pub struct Lesson {
    /// Its number, from 1.
    pub number: usize,
    /// Name of the learner's file.
    pub file: String,
    /// The unsolved script.
    pub text: String,
    /// Hints, the vaguest first.
    pub hints: Vec<String>,
    /// What a solution replaces in the script, and with what.
    pub solution: Vec<[String; 2]>,
    /// What the learner has found out, shown when the lesson is passed.
    pub passed: String,
    /// What there is to watch step by step, if there is something.
    pub watch: Option<String>,
    /// Whether the report of the identification is part of the lesson, and what to look at in it.
    pub report: Option<String>,
    /// Further files of the learner: names and contents.
    pub companions: Vec<(String, String)>,
    /// What must hold for the learner's script.
    pub checks: Vec<Check>,
}

/// A run of the learner's script, and what must hold after it.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Check {
    /// Variables of the script that get another value: where the script assigns them first.
    #[serde(default)]
    pub with: BTreeMap<String, String>,
    /// Settings that are taken from the learner's script and put into the shipped one, which is run
    /// instead of his: what it computes then is not of his making.
    #[serde(default)]
    pub settings: Vec<String>,
    /// Files that replace those of the learner.
    #[serde(default)]
    pub files: BTreeMap<String, String>,
    /// Statements executed after the script.
    #[serde(default)]
    pub prepare: String,
    /// What must hold, in this order: the first that does not is what the learner reads.
    pub claims: Vec<Claim>,
}

/// Something that must hold.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Claim {
    /// A Boolean expression among the variables and functions of the script.
    pub holds: String,
    /// What to say where it does not; `{expression}` is replaced with its value.
    pub otherwise: String,
}

/// The file beside the script.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct Description {
    hints: Vec<String>,
    solution: Vec<[String; 2]>,
    passed: String,
    watch: Option<String>,
    report: Option<String>,
    #[serde(default)]
    companions: Vec<String>,
    check: Vec<Check>,
}

/// All lessons, in order.
pub fn all() -> &'static [Lesson] {
    static LESSONS: OnceLock<Vec<Lesson>> = OnceLock::new();
    LESSONS.get_or_init(|| {
        let scripts = FILES.iter().filter(|(name, _)| name.ends_with(".mos"));
        scripts.enumerate().map(|(k, (name, _))| Lesson::shipped(k + 1, name)).collect()
    })
}

/// The text of a shipped file; empty where there is none. A test reads every one of them.
fn text(name: &str) -> String {
    let found = FILES.binary_search_by_key(&name, |(name, _)| name);
    let bytes = found.map_or(&[][..], |at| FILES[at].1);
    String::from_utf8_lossy(bytes).into_owned()
}

impl Lesson {
    fn shipped(number: usize, file: &str) -> Lesson {
        let description = text(&file.replace(".mos", ".toml"));
        // A test reads every one of them.
        let description: Description = toml::from_str(&description).unwrap_or_default();
        let companions = description.companions.into_iter();
        Lesson {
            number,
            file: file.to_owned(),
            text: text(file),
            hints: description.hints,
            solution: description.solution,
            passed: description.passed,
            watch: description.watch,
            report: description.report,
            companions: companions.map(|name| (name.clone(), text(&name))).collect(),
            checks: description.check,
        }
    }

    /// What the lesson is about: the rest of the first line of its script.
    pub fn title(&self) -> &str {
        let first = self.text.lines().next().unwrap_or_default();
        first.split_once(": ").map_or(first, |(_, title)| title)
    }

    /// The comment at the beginning of the script: what it is about and what there is to do.
    pub fn introduction(&self) -> String {
        let lines = self.text.lines().map_while(|line| line.strip_prefix("//"));
        lines.map(|line| format!("{}\n", line.strip_prefix(' ').unwrap_or(line))).collect()
    }

    /// The script with the solution in it, and the companions likewise.
    pub fn solved(&self) -> (String, Vec<(String, String)>) {
        let solve = |text: &str| {
            let replaced = |text: String, [gap, filled]: &[String; 2]| text.replace(gap, filled);
            self.solution.iter().fold(text.to_owned(), replaced)
        };
        let companions = self.companions.iter();
        let companions = companions.map(|(name, text)| (name.clone(), solve(text))).collect();
        (solve(&self.text), companions)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_description_is_read_and_whole() {
        for lesson in all() {
            let name = lesson.file.replace(".mos", ".toml");
            toml::from_str::<Description>(&text(&name)).unwrap_or_else(|e| panic!("{name}: {e}"));
            assert!(lesson.file.starts_with(&format!("{:02}_", lesson.number)), "{name}");
            assert!(lesson.text.starts_with(&format!("// Lesson {}: ", lesson.number)), "{name}");
            assert!(lesson.hints.len() >= 2 && !lesson.passed.is_empty(), "{name}");
            assert!(!lesson.checks.is_empty() && !lesson.solution.is_empty(), "{name}");
            let companions = lesson.companions.iter().map(|(_, text)| text.as_str());
            let all: Vec<&str> = companions.chain([lesson.text.as_str()]).collect();
            for [gap, _] in &lesson.solution {
                let found: usize = all.iter().map(|text| text.matches(gap.as_str()).count()).sum();
                assert_eq!(found, 1, "{name}: `{gap}`");
            }
            assert!(all.iter().all(|text| !text.is_empty()), "{name}: a companion is missing");
        }
    }
}
