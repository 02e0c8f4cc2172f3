//! Lists that are read at the first access.

use crate::diag::Diagnostic;
use std::fmt;
use std::ops::{Deref, DerefMut};
use std::sync::{Arc, OnceLock};

/// Text from which something can be read later.
pub(super) trait Unread<T>: Send + Sync {
    /// Reads it.
    ///
    /// # Errors
    /// The first error of the text.
    fn read(&self) -> Result<T, Diagnostic>;
}

/// A list read at the first access; it is empty if it cannot be read, which [`Lazy::error`] tells.
#[derive(Clone)]
pub struct Lazy<T> {
    read: OnceLock<Result<Vec<T>, Arc<Diagnostic>>>,
    unread: Option<Arc<dyn Unread<Vec<T>>>>,
}

impl<T> Default for Lazy<T> {
    fn default() -> Lazy<T> {
        Lazy { read: OnceLock::new(), unread: None }
    }
}

impl<T> Lazy<T> {
    /// A list to be read.
    pub(super) fn unread(unread: Arc<dyn Unread<Vec<T>>>) -> Lazy<T> {
        Lazy { read: OnceLock::new(), unread: Some(unread) }
    }

    /// Why the list could not be read, if it could not.
    pub fn error(&self) -> Option<&Diagnostic> {
        self.read().as_ref().err().map(Arc::as_ref)
    }

    /// Whether it was read already.
    pub fn is_read(&self) -> bool {
        self.read.get().is_some() || self.unread.is_none()
    }

    fn read(&self) -> &Result<Vec<T>, Arc<Diagnostic>> {
        self.read.get_or_init(|| match &self.unread {
            Some(unread) => unread.read().map_err(Arc::new),
            None => Ok(Vec::new()),
        })
    }

    pub(super) fn into_inner(mut self) -> Vec<T> {
        std::mem::take(&mut *self)
    }
}

impl<T> From<Vec<T>> for Lazy<T> {
    fn from(list: Vec<T>) -> Lazy<T> {
        Lazy { read: OnceLock::from(Ok(list)), unread: None }
    }
}

impl<T> Deref for Lazy<T> {
    type Target = Vec<T>;

    fn deref(&self) -> &Vec<T> {
        self.read().as_ref().unwrap_or(const { &Vec::new() })
    }
}

impl<T> DerefMut for Lazy<T> {
    fn deref_mut(&mut self) -> &mut Vec<T> {
        if self.read().is_err() {
            *self = Lazy::from(Vec::new());
        }
        match self.read.get_mut() {
            Some(Ok(list)) => list,
            _ => unreachable!("they were just read"),
        }
    }
}

impl<'a, T> IntoIterator for &'a Lazy<T> {
    type Item = &'a T;
    type IntoIter = std::slice::Iter<'a, T>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

impl<T: PartialEq> PartialEq for Lazy<T> {
    fn eq(&self, other: &Lazy<T>) -> bool {
        **self == **other
    }
}

impl<T: fmt::Debug> fmt::Debug for Lazy<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_list().entries(self.iter()).finish()
    }
}
