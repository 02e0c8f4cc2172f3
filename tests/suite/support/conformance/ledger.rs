//! The cases known to be judged wrong: behind a marker in a file of `compat/`, one table per
//! section, one line `"case" = "stage: code"` per case. A remark behind ` — ` in the value is kept
//! as long as stage and code stay the same.

use super::{filter, is_asked_for, say};
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

const MARKER: &str = "# Written by GAPILIB_UPDATE_LEDGER=1 from here on";
const REMARK: &str = " — ";

/// Cases and what is wrong with them, by section.
type Rows = BTreeMap<String, BTreeMap<String, String>>;

/// A ledger and the cases found wrong in this run.
pub(crate) struct Ledger {
    path: PathBuf,
    /// What stands before the marker.
    head: String,
    known: Rows,
    found: Rows,
}

impl Ledger {
    /// Reads a ledger of `compat/`.
    pub(crate) fn read(file: &str) -> Ledger {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("compat").join(file);
        let text = fs::read_to_string(&path).expect("a readable ledger");
        let (head, tail) = text.split_once(MARKER).unwrap_or((&text, ""));
        Ledger { path, head: head.to_owned(), known: rows(tail), found: Rows::new() }
    }

    /// Notes a case that is judged wrong.
    pub(crate) fn note(&mut self, section: &str, case: &str, reason: String) {
        self.found.entry(section.to_owned()).or_default().insert(case.to_owned(), reason);
    }

    /// Takes over what the ledger says of a case that this run cannot judge, such as `differs: …`
    /// where there are no references.
    pub(crate) fn keep(&mut self, is_kept: impl Fn(&str) -> bool) {
        for (section, cases) in &self.known {
            for (case, reason) in cases.iter().filter(|(_, reason)| is_kept(reason)) {
                let found = self.found.entry(section.clone()).or_default();
                found.entry(case.clone()).or_insert_with(|| reason.clone());
            }
        }
    }

    /// Writes the ledger anew if that is asked for, else compares: improvements are told.
    ///
    /// # Panics
    /// If a case that was right is wrong, or one got worse in the judgement of `is_worse(old, new)`.
    pub(crate) fn settle(&self, is_worse: impl Fn(&str, &str) -> bool) {
        if std::env::var_os("GAPILIB_UPDATE_LEDGER").is_some() {
            assert!(filter().is_none(), "a ledger is not written from a part of the cases");
            fs::write(&self.path, self.text()).expect("a writable ledger");
            return;
        }
        self.tell_improvements();
        let mut worse = Vec::new();
        for (section, cases) in &self.found {
            for (case, reason) in cases {
                match self.known_reason(section, case) {
                    None => worse.push(format!("{case}: {reason}")),
                    Some(old) if is_worse(old, reason) => {
                        worse.push(format!("{case}: {reason}; it was {old}"));
                    }
                    Some(_) => {}
                }
            }
        }
        assert!(
            worse.is_empty(),
            "{} cases are worse than before:\n{}",
            worse.len(),
            worse.join("\n")
        );
    }

    fn tell_improvements(&self) {
        let mut better = Vec::new();
        for (section, cases) in &self.known {
            let found = self.found.get(section);
            let is_right = |case: &str| !found.is_some_and(|found| found.contains_key(case));
            better.extend(cases.keys().filter(|case| is_asked_for(case) && is_right(case)));
        }
        if !better.is_empty() {
            say(&format!("improve the ledger, {} cases are right now:", better.len()));
            better.iter().for_each(|case| say(&format!("  {case}")));
        }
    }

    /// Stage and code that the ledger has for a case.
    fn known_reason(&self, section: &str, case: &str) -> Option<&str> {
        let entry = self.known.get(section)?.get(case)?;
        Some(entry.split_once(REMARK).map_or(entry.as_str(), |(reason, _)| reason))
    }

    fn text(&self) -> String {
        let mut text = format!("{}{MARKER}\n", self.head);
        for (section, cases) in &self.found {
            let _ = writeln!(text, "\n[\"{section}\"]");
            for (case, reason) in cases {
                let kept = match self.known_reason(section, case) {
                    Some(old) if old == reason => &self.known[section][case],
                    _ => reason,
                };
                let _ = writeln!(text, "\"{case}\" = \"{kept}\"");
            }
        }
        text
    }
}

fn rows(text: &str) -> Rows {
    let mut rows = Rows::new();
    let mut section = String::new();
    for line in text.lines().filter(|line| !line.starts_with('#') && !line.trim().is_empty()) {
        if let Some(name) = line.strip_prefix("[\"").and_then(|rest| rest.strip_suffix("\"]")) {
            section = name.to_owned();
        } else {
            let (case, reason) = line.split_once(" = ").expect("\"case\" = \"reason\"");
            let (case, reason) = (case.trim_matches('"'), reason.trim_matches('"'));
            let cases = rows.entry(section.clone()).or_default();
            cases.insert(case.to_owned(), reason.to_owned());
        }
    }
    rows
}
