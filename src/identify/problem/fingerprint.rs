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
        origins.add(VERSION, env!("CARGO_PKG_VERSION").as_bytes());
        origins
    }

    /// What is not the same as in these, this program left out.
    pub fn inputs_changed_since(&self, before: &Origins) -> Vec<String> {
        let mut changed = self.changed_since(before);
        changed.retain(|name| name != VERSION);
        changed
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

    /// Adds the entries of a problem. Its limits (`[stop]`) and how often it is saved
    /// (`[checkpoint]`) may change while a run is resumed.
    pub fn add_problem(&mut self, entries: &toml::Table) {
        let mut table = entries.clone();
        ["stop", "checkpoint"].iter().for_each(|name| drop(table.remove(*name)));
        self.add(PROBLEM, toml::to_string(&table).unwrap_or_default().as_bytes());
    }

    /// Adds a Modelica text, whose comments and white space may change.
    pub fn add_modelica(&mut self, name: impl Into<String>, text: &str) {
        self.add(name, significant(text).as_bytes());
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

/// How this program is called where it has changed.
const VERSION: &str = "the version of gapilib";

/// A Modelica text without comments, and without white space but for that which separates words.
fn significant(text: &str) -> String {
    let is_word = |c: char| c.is_alphanumeric() || matches!(c, '_' | '.');
    let mut out = String::with_capacity(text.len());
    let (mut rest, mut is_apart) = (text, false);
    while let Some(first) = rest.chars().next() {
        let length = match first {
            '"' | '\'' => quoted(rest),
            _ if rest.starts_with("//") => rest.find('\n').unwrap_or(rest.len()),
            _ if rest.starts_with("/*") => rest.find("*/").map_or(rest.len(), |end| end + 2),
            _ => first.len_utf8(),
        };
        let (token, others) = rest.split_at(length);
        rest = others;
        if first.is_whitespace() || token.starts_with("//") || token.starts_with("/*") {
            is_apart = true;
            continue;
        }
        if is_apart && is_word(first) && out.ends_with(is_word) {
            out.push(' ');
        }
        is_apart = false;
        out.push_str(token);
    }
    out
}

/// Bytes of the string or quoted identifier at the beginning of a text.
fn quoted(text: &str) -> usize {
    let (mut is_escaped, quote) = (false, text.as_bytes()[0]);
    for (at, byte) in text.bytes().enumerate().skip(1) {
        match byte {
            _ if is_escaped => is_escaped = false,
            b'\\' => is_escaped = true,
            _ if byte == quote => return at + 1,
            _ => {}
        }
    }
    text.len()
}

/// How the problem is called where it has changed.
const PROBLEM: &str = "the problem";

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
    fn comments_and_white_space_change_nothing() {
        let base = "model M \"a // b\" Real x=1-2; end M;";
        let same = [
            "model M\n  \"a // b\"\n  Real x = 1 - 2; // one\nend M;\n",
            "/* M */ model/**/M \"a // b\" Real x=1-/* 3 */2;end M;// M",
        ];
        let others = [
            "model M \"a  // b\" Real x=1-2; end M;",
            "model M \"a // b\" Realx=1-2; end M;",
            "model M \"a // b\" Real x=1-2; end 'M';",
            "model M \"a \\\" // b\" Real x=1-2; end M;",
        ];
        same.iter().for_each(|text| assert_eq!(significant(text), significant(base), "{text}"));
        others.iter().for_each(|text| assert_ne!(significant(text), significant(base), "{text}"));
        for open in ["\"", "'", "/*", "//", "\"\\", "é\"é"] {
            significant(open);
        }
        let of = |text: &str| {
            let mut origins = Origins::new();
            origins.add_problem(&text.parse().unwrap());
            origins
        };
        let problem = "model = \"M\"\n[parameters]\na = { min = 0 }\nb = { min = 0 }\n";
        let longer = format!("# mine\n{problem}\n[stop]\ngenerations = 9\n");
        assert!(of(problem).changed_since(&of(&longer)).is_empty());
        for other in [problem.replace("min = 0", "min = 1"), problem.replace("a = ", "c = ")] {
            assert_eq!(of(problem).changed_since(&of(&other)), [PROBLEM]);
        }
        // The order of the parameters is that of the genes.
        let swapped = "model = \"M\"\n[parameters]\nb = { min = 0 }\na = { min = 0 }\n";
        assert!(!of(problem).changed_since(&of(swapped)).is_empty());
    }

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
