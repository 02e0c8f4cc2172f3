//! A number made of data: another number means other data. The same on every machine.

use serde::{Deserialize, Serialize};

/// FNV-1a.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Fingerprint(u64);

impl Default for Fingerprint {
    fn default() -> Fingerprint {
        Fingerprint(0xcbf2_9ce4_8422_2325)
    }
}

impl Fingerprint {
    /// Adds bytes.
    pub fn add(&mut self, bytes: &[u8]) {
        for byte in bytes {
            self.0 = (self.0 ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }

    /// Adds numbers, bit by bit.
    pub fn add_numbers(&mut self, values: &[f64]) {
        values.iter().for_each(|value| self.add(&value.to_bits().to_le_bytes()));
    }

    /// The number.
    pub fn number(self) -> u64 {
        self.0
    }
}

/// What a run depends on, each with its fingerprint: a run is resumed only if all are the same.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Origins(Vec<(String, u64)>);

impl Origins {
    /// The version of this program, alone.
    pub fn new() -> Origins {
        let mut origins = Origins::default();
        origins.add("the version of gapilib", env!("CARGO_PKG_VERSION").as_bytes());
        origins
    }

    /// Adds something by its name and content.
    pub fn add(&mut self, name: impl Into<String>, content: &[u8]) {
        let mut fingerprint = Fingerprint::default();
        fingerprint.add(content);
        let own = (name.into(), fingerprint.number());
        if !self.0.contains(&own) {
            self.0.push(own);
        }
    }

    /// What it consists of, by name.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.0.iter().map(|(name, _)| name.as_str())
    }

    /// What is not the same as in these; a file that is only named otherwise is the same.
    pub fn changed_since(&self, before: &Origins) -> Vec<String> {
        let missing = |these: &Origins, those: &Origins| -> Vec<String> {
            let is_new = |(_, number): &&(String, u64)| !those.0.iter().any(|(_, n)| n == number);
            these.0.iter().filter(is_new).map(|(name, _)| name.clone()).collect()
        };
        let mut changed = missing(self, before);
        changed.extend(missing(before, self));
        changed.sort();
        changed.dedup();
        changed
    }
}

/// Names in a sentence: three, and how many more there are.
pub fn listed(names: &[String]) -> String {
    let shown = names.iter().take(3).cloned().collect::<Vec<_>>().join(", ");
    match names.len().saturating_sub(3) {
        0 => shown,
        more => format!("{shown} and {more} more"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_changed_is_named() {
        let of = |model: &str, file: &str| {
            let mut origins = Origins::new();
            origins.add(file, model.as_bytes());
            origins
        };
        assert!(of("a", "M.mo").changed_since(&of("a", "../M.mo")).is_empty());
        assert_eq!(of("b", "M.mo").changed_since(&of("a", "M.mo")), ["M.mo"]);
        assert_eq!(of("a", "M.mo").changed_since(&Origins::new()), ["M.mo"]);
        let names = ["a", "b", "c", "d"].map(str::to_owned);
        assert_eq!(listed(&names), "a, b, c and 1 more");
    }
}
