//! Parts of a study that are computed by several processes on their own: shards.
//!
//! A study is made of independent parts: further searches with other seeds, the replicates of a
//! bootstrap, the chains of a posterior, the profiles of the parameters, the samples of a sensitivity
//! analysis. Shard k of n
//! computes every n-th of them. The merge of the shards runs the problem again, replays the search
//! from its journal, and takes the parts that are there; so the report is that of one process.

use super::{Fingerprint, Origins, first_frame, frame};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::sync::{Mutex, MutexGuard, PoisonError};

const MAGIC: &[u8; 8] = b"GAPIPRT1";

/// One of several shards.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Shard {
    /// Its number, from 1.
    pub number: usize,
    /// How many there are.
    pub count: usize,
}

impl Shard {
    fn has(self, part: usize) -> bool {
        part % self.count == self.number - 1
    }
}

/// The results of a kind of parts, by number, as bytes.
type Results = BTreeMap<usize, Vec<u8>>;

/// Which parts are computed, and the results that are known.
#[derive(Debug, Default)]
pub struct Parts {
    shard: Option<Shard>,
    /// By kind and fingerprint of what the parts start from.
    known: Mutex<BTreeMap<(String, u64), Results>>,
}

/// What a shard leaves.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ShardFile {
    /// What its run depended on.
    pub origins: Origins,
    /// Which shard it is.
    pub shard: Shard,
    /// The problem file as it was named.
    pub problem: String,
    /// What was requested beyond the fit, in a form that is the same where that is the same.
    pub requested: Vec<u8>,
    /// The journal of the search.
    pub journal: Vec<u8>,
    known: BTreeMap<(String, u64), Results>,
}

impl ShardFile {
    /// The file of a shard with its parts.
    pub fn new(parts: &Parts, shard: Shard, origins: &Origins, problem: &str) -> ShardFile {
        ShardFile {
            origins: origins.clone(),
            shard,
            problem: problem.to_owned(),
            requested: Vec::new(),
            journal: Vec::new(),
            known: parts.known().clone(),
        }
    }

    /// How many parts of each kind it has.
    pub fn parts(&self) -> impl Iterator<Item = (&str, usize)> {
        self.known.iter().map(|((kind, _), results)| (kind.as_str(), results.len()))
    }

    /// As bytes.
    pub fn to_bytes(&self) -> Vec<u8> {
        // Names and numbers only.
        let payload = postcard::to_allocvec(self).unwrap_or_default();
        [MAGIC.to_vec(), frame(&payload)].concat()
    }

    /// From bytes; `None` where they are damaged or something else.
    pub fn from_bytes(bytes: &[u8]) -> Option<ShardFile> {
        let (payload, rest) = first_frame(bytes.strip_prefix(MAGIC)?)?;
        let file: ShardFile = postcard::from_bytes(payload).ok()?;
        let is_one = (1..=file.shard.count).contains(&file.shard.number);
        (is_one && rest.is_empty()).then_some(file)
    }
}

impl Parts {
    /// The parts of a shard.
    pub fn of(shard: Shard) -> Parts {
        Parts { shard: Some(shard), known: Mutex::default() }
    }

    /// All parts, of which these are known.
    pub fn merged<'a>(files: impl IntoIterator<Item = &'a ShardFile>) -> Parts {
        let mut known: BTreeMap<(String, u64), Results> = BTreeMap::new();
        for (kind, results) in files.into_iter().flat_map(|file| file.known.clone()) {
            known.entry(kind).or_default().extend(results);
        }
        Parts { shard: None, known: Mutex::new(known) }
    }

    /// Whether other processes compute parts.
    pub(crate) fn are_divided(&self) -> bool {
        self.shard.is_some() || !self.known().is_empty()
    }

    /// The shard, if this is one.
    pub fn shard(&self) -> Option<Shard> {
        self.shard
    }

    fn known(&self) -> MutexGuard<'_, BTreeMap<(String, u64), Results>> {
        self.known.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The results of `count` parts that start from `values`. `compute` gets the numbers of those that
    /// are missing here. `None` where others belong to other shards.
    pub(super) fn all<T: Serialize + DeserializeOwned>(
        &self,
        (kind, values): (&str, &[f64]),
        count: usize,
        compute: impl FnOnce(&[usize]) -> Vec<T>,
    ) -> Option<Vec<T>> {
        let missing = self.missing::<T>((kind, values), count);
        let computed = missing.iter().copied().zip(compute(&missing));
        self.complete((kind, values), count, computed.collect())
    }

    /// The numbers of those of `count` parts that have to be computed here.
    pub fn missing<T: DeserializeOwned>(&self, key: (&str, &[f64]), count: usize) -> Vec<usize> {
        let results = self.results::<T>(key);
        let is_own = |part: &usize| self.shard.is_none_or(|shard| shard.has(*part));
        (0..count).filter(is_own).filter(|part| !results.contains_key(part)).collect()
    }

    /// All of `count` parts, of which these were computed here; `None` where others belong to other
    /// shards.
    pub fn complete<T: Serialize + DeserializeOwned>(
        &self,
        key: (&str, &[f64]),
        count: usize,
        computed: Vec<(usize, T)>,
    ) -> Option<Vec<T>> {
        let mut results = self.results::<T>(key);
        if self.shard.is_some() {
            let mut known = self.known();
            let own = known.entry(address(key)).or_default();
            for (part, result) in &computed {
                own.extend(postcard::to_allocvec(result).ok().map(|bytes| (*part, bytes)));
            }
        }
        results.extend(computed);
        (0..count).map(|part| results.remove(&part)).collect()
    }

    /// What is known of a kind of parts.
    fn results<T: DeserializeOwned>(&self, key: (&str, &[f64])) -> BTreeMap<usize, T> {
        let known = self.known();
        let stored = known.get(&address(key)).into_iter().flatten();
        let read = |bytes: &Vec<u8>| postcard::from_bytes::<T>(bytes).ok();
        stored.filter_map(|(part, bytes)| Some((*part, read(bytes)?))).collect()
    }
}

/// A kind of parts, and the fingerprint of the values that they start from.
fn address((kind, values): (&str, &[f64])) -> (String, u64) {
    let mut fingerprint = Fingerprint::default();
    fingerprint.add_numbers(values);
    (kind.to_owned(), fingerprint.number())
}

/// What is said where other shards have a part of it.
pub(super) fn other_shards(what: &str) -> String {
    format!("Other shards compute the rest of the {what}: merge them with `gapi report --merge`.")
}

/// Which of `count` shards these files leave out.
pub fn missing_shards(files: &[ShardFile], count: usize) -> Vec<usize> {
    (1..=count).filter(|number| files.iter().all(|file| file.shard.number != *number)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn squares(parts: &Parts, missing_parts: &mut Vec<usize>) -> Option<Vec<f64>> {
        parts.all(("squares", &[1.0]), 7, |missing| {
            missing_parts.extend(missing);
            missing.iter().map(|part| (part * part) as f64).collect()
        })
    }

    #[test]
    fn shards_together_know_all_parts() {
        let file = |number| {
            let shard = Shard { number, count: 3 };
            let parts = Parts::of(shard);
            assert_eq!(squares(&parts, &mut Vec::new()), None, "a shard has a part alone");
            let file = ShardFile::new(&parts, shard, &Origins::new(), "p.toml");
            ShardFile::from_bytes(&file.to_bytes()).expect("whole")
        };
        let files = [1, 2, 3].map(file);
        let mut computed = Vec::new();
        let all = squares(&Parts::merged(&files), &mut computed);
        assert_eq!(all, Some(vec![0.0, 1.0, 4.0, 9.0, 16.0, 25.0, 36.0]));
        assert!(computed.is_empty(), "{computed:?}");
        // What a shard would have had is computed.
        assert_eq!(squares(&Parts::merged(&files[..2]), &mut computed), all);
        assert_eq!(computed, [2, 5]);
        assert_eq!(missing_shards(&files[..2], 3), [3]);
        // From another starting point nothing is known.
        let other =
            Parts::merged(&files).all(("squares", &[2.0]), 2, |missing| vec![0; missing.len()]);
        assert_eq!(other, Some(vec![0, 0]));
    }

    #[test]
    fn damaged_files_are_refused() {
        let shard = Shard { number: 1, count: 1 };
        let bytes = ShardFile::new(&Parts::of(shard), shard, &Origins::new(), "p.toml").to_bytes();
        assert!(ShardFile::from_bytes(&bytes).is_some());
        for place in 0..bytes.len() {
            let mut damaged = bytes.clone();
            damaged[place] ^= 0x40;
            assert_eq!(ShardFile::from_bytes(&damaged), None, "{place}");
            assert_eq!(ShardFile::from_bytes(&bytes[..place]), None, "{place}");
        }
    }
}
