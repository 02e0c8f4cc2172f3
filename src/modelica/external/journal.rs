//! What a simulation would do to the outside world, in order: it is done when the simulation has
//! ended, if the caller requests it, and only where that is allowed.

use super::Outside;
use crate::diag::Fault;
use std::ops::Range;

/// Bytes that a simulation may write.
const MOST_BYTES: usize = 1 << 28;

/// One request.
#[derive(Debug, Clone, PartialEq)]
enum Deed {
    Write {
        path: String,
        bytes: Vec<u8>,
    },
    Append {
        path: String,
        bytes: Vec<u8>,
    },
    Remove {
        path: String,
    },
    MakeFolder {
        path: String,
    },
    Print {
        text: String,
    },
    /// Taken back.
    Nothing,
}

/// Requests that wait.
#[derive(Debug, Clone, Default)]
pub struct Journal {
    deeds: Vec<Deed>,
    bytes: usize,
}

impl Journal {
    /// Forgets everything.
    pub fn clear(&mut self) {
        *self = Journal::default();
    }

    /// How many requests there are.
    pub(crate) fn len(&self) -> usize {
        self.deeds.len()
    }

    /// Takes requests back: what made them has been done again, with other values.
    pub(crate) fn take_back(&mut self, requests: Range<usize>) {
        self.deeds[requests].fill(Deed::Nothing);
    }

    /// The content of a file as it would be; `before` reads what it is.
    pub fn read(
        &self,
        path: &str,
        before: impl FnOnce() -> Result<Vec<u8>, Fault>,
    ) -> Result<Vec<u8>, Fault> {
        let of_path = |deed: &&Deed| match deed {
            Deed::Write { path: other, .. }
            | Deed::Append { path: other, .. }
            | Deed::Remove { path: other } => other == path,
            Deed::MakeFolder { .. } | Deed::Print { .. } | Deed::Nothing => false,
        };
        let mut deeds = self.deeds.iter().filter(of_path).peekable();
        let mut content = match deeds.peek() {
            Some(Deed::Write { .. } | Deed::Remove { .. }) => Some(Vec::new()),
            _ => Some(before()?),
        };
        for deed in deeds {
            content = match deed {
                Deed::Write { bytes, .. } => Some(bytes.clone()),
                Deed::Append { bytes, .. } => {
                    let mut all = content.unwrap_or_default();
                    all.extend(bytes);
                    Some(all)
                }
                _ => None,
            };
        }
        match content {
            Some(content) => Ok(content),
            None => ().read(path),
        }
    }

    fn add(&mut self, deed: Deed) -> Result<(), Fault> {
        self.bytes += match &deed {
            Deed::Write { bytes, .. } | Deed::Append { bytes, .. } => bytes.len(),
            Deed::Remove { path } | Deed::MakeFolder { path } => path.len(),
            Deed::Print { text } => text.len(),
            Deed::Nothing => 0,
        };
        if self.bytes > MOST_BYTES {
            return Err(crate::fault!(
                super::errors::EXTERNAL_OUTSIDE,
                "a simulation must not write more than {MOST_BYTES} bytes"
            ));
        }
        self.deeds.push(deed);
        Ok(())
    }

    /// Rewrites a file.
    pub fn write(&mut self, path: &str, bytes: &[u8]) -> Result<(), Fault> {
        self.add(Deed::Write { path: path.to_owned(), bytes: bytes.to_vec() })
    }

    /// Appends to a file.
    pub fn append(&mut self, path: &str, bytes: &[u8]) -> Result<(), Fault> {
        self.add(Deed::Append { path: path.to_owned(), bytes: bytes.to_vec() })
    }

    /// Removes a file.
    pub fn remove(&mut self, path: &str) -> Result<(), Fault> {
        self.add(Deed::Remove { path: path.to_owned() })
    }

    /// Makes a folder.
    pub fn make_folder(&mut self, path: &str) -> Result<(), Fault> {
        self.add(Deed::MakeFolder { path: path.to_owned() })
    }

    /// Whether there would be a file (`Some(false)`) or a folder (`Some(true)`) of this name; `before`
    /// says what is there now.
    pub fn is_folder(
        &self,
        path: &str,
        before: impl FnOnce() -> Result<Option<bool>, Fault>,
    ) -> Result<Option<bool>, Fault> {
        let last = self.deeds.iter().rev().find_map(|deed| match deed {
            Deed::Write { path: other, .. } | Deed::Append { path: other, .. } => {
                (other == path).then_some(Some(false))
            }
            Deed::Remove { path: other } => (other == path).then_some(None),
            Deed::MakeFolder { path: other } => (other == path).then_some(Some(true)),
            Deed::Print { .. } | Deed::Nothing => None,
        });
        last.map_or_else(before, Ok)
    }

    /// Takes a line for the user.
    pub fn print(&mut self, text: &str) -> Result<(), Fault> {
        self.add(Deed::Print { text: text.to_owned() })
    }

    /// Does what was asked for, up to the first request that is refused.
    pub fn carry_out(&self, outside: &mut dyn Outside) -> Result<(), Fault> {
        self.deeds.iter().try_for_each(|deed| match deed {
            Deed::Write { path, bytes } => outside.write(path, bytes),
            Deed::Append { path, bytes } => outside.append(path, bytes),
            Deed::Remove { path } => outside.remove(path),
            Deed::MakeFolder { path } => outside.make_folder(path),
            Deed::Print { text } => outside.print(text),
            Deed::Nothing => Ok(()),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_read_as_they_would_be() {
        let mut journal = Journal::default();
        journal.append("a", b"2").expect("little");
        let before = || Ok(b"1".to_vec());
        assert_eq!(journal.read("a", before).expect("it is there"), b"12");
        journal.write("a", b"3").expect("little");
        journal.append("a", b"4").expect("little");
        assert_eq!(journal.read("b", before).expect("as it was"), b"1");
        journal.remove("a").expect("little");
        assert!(journal.read("a", before).is_err());
        let refused = journal.carry_out(&mut ()).expect_err("nothing is granted");
        assert!(refused.message.contains("`a`"), "{}", refused.message);
    }
}
