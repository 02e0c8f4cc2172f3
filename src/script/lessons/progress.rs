//! What a learner has done, as a small file of text beside his copies.

use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};

const HEADING: &str = "# Written by `gapi lesson`: the lessons that are passed, and how many hints of \
                       each were shown.\n";

/// What is passed, and how many hints were shown.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Progress {
    /// Numbers of the lessons that are passed.
    #[serde(default)]
    pub passed: BTreeSet<usize>,
    /// How many hints of each lesson were shown. The numbers are text, as keys in TOML are.
    #[serde(default)]
    hints: BTreeMap<String, usize>,
}

impl Progress {
    /// Reads the text of a file.
    ///
    /// # Errors
    ///
    /// What is wrong with it.
    pub fn read(text: &str) -> Result<Progress, String> {
        toml::from_str(text).map_err(|error| error.message().to_owned())
    }

    /// The text of the file.
    pub fn text(&self) -> String {
        format!("{HEADING}{}", toml::to_string(self).unwrap_or_default())
    }

    /// How many hints of a lesson were shown.
    pub fn hints(&self, lesson: usize) -> usize {
        self.hints.get(&lesson.to_string()).copied().unwrap_or(0)
    }

    /// So many hints of a lesson were shown.
    pub fn set_hints(&mut self, lesson: usize, count: usize) {
        self.hints.insert(lesson.to_string(), count);
    }

    /// Forgets a lesson.
    pub fn forget(&mut self, lesson: usize) {
        self.passed.remove(&lesson);
        self.hints.remove(&lesson.to_string());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_read() {
        let mut progress = Progress::default();
        progress.passed.extend([1, 12]);
        progress.set_hints(4, 2);
        assert_eq!(Progress::read(&progress.text()), Ok(progress.clone()));
        progress.forget(12);
        assert_eq!((progress.passed.len(), progress.hints(4)), (1, 2));
        assert!(Progress::read("passed = \"all\"").is_err());
    }
}
