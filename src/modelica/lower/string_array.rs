//! Arrays of Strings, whose elements are known when a model is compiled or not at all: libraries
//! choose substances and sensors by name.

use std::sync::Arc;

/// Stands for a text, or a part of one, that is not known when compiling; messages show it.
pub(super) const UNKNOWN_TEXT: &str = "…";

/// An array of Strings; each is `UNKNOWN_TEXT` where it is not known.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct StringArray {
    /// Its sizes.
    pub dims: Vec<usize>,
    /// Row-major.
    pub strings: Arc<[Arc<str>]>,
}

impl StringArray {
    /// An array of these sizes of which nothing else is known.
    pub(super) fn unknown(dims: Vec<usize>) -> StringArray {
        StringArray::filled(dims, UNKNOWN_TEXT.into())
    }

    /// The same text everywhere.
    pub(super) fn filled(dims: Vec<usize>, text: Arc<str>) -> StringArray {
        let strings = vec![text; dims.iter().product()].into();
        StringArray { dims, strings }
    }

    /// Arrays of one size as the elements of an array with one more dimension; `None` if their sizes
    /// differ.
    pub(super) fn stacked(parts: &[StringArray]) -> Option<StringArray> {
        let first = parts.first()?;
        let mut dims = vec![parts.len()];
        dims.extend(&first.dims);
        let same = parts.iter().all(|part| part.dims == first.dims);
        same.then(|| StringArray {
            dims,
            strings: parts.iter().flat_map(|part| part.strings.iter().cloned()).collect(),
        })
    }

    /// The array at a position of the first `rank` dimensions.
    pub(super) fn part(&self, rank: usize, at: usize) -> StringArray {
        let dims = self.dims[rank..].to_vec();
        let n: usize = dims.iter().product();
        StringArray { dims, strings: self.strings[at * n..(at + 1) * n].into() }
    }

    /// Makes all elements unknown.
    pub(super) fn forget(&mut self) {
        *self = StringArray::unknown(std::mem::take(&mut self.dims));
    }

    /// What may be either array: elements that differ are not known. `None` if the sizes differ.
    pub(super) fn joined(&self, other: &StringArray) -> Option<StringArray> {
        let element = |(a, b): (&Arc<str>, &Arc<str>)| match a == b {
            true => a.clone(),
            false => UNKNOWN_TEXT.into(),
        };
        let strings = || self.strings.iter().zip(other.strings.iter()).map(element).collect();
        (self.dims == other.dims)
            .then(|| StringArray { dims: self.dims.clone(), strings: strings() })
    }
}
