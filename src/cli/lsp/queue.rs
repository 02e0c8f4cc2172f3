//! What the client asked for and what is to be examined, between the thread that reads messages and
//! the one that works.

use crate::lsp::{Document, Documents};
use lsp_server::{Request, RequestId};
use std::collections::VecDeque;
use std::process::ExitCode;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};

/// Something to do.
pub(super) enum Work {
    /// A request, with the documents as they were when it was sent.
    Request(Request, Documents),
    /// A document was closed.
    Close(Arc<Document>),
    /// Files were changed on the disk.
    Forget,
    /// The newest version of a document is to be examined.
    Examine(Arc<Document>, Documents),
    /// The connection has ended.
    End(ExitCode),
}

#[derive(Default)]
struct State {
    documents: Documents,
    work: VecDeque<Work>,
    /// Names of documents to be examined when nothing else is to be done, each once.
    to_examine: VecDeque<String>,
}

/// Work in the order in which it is done: what was asked for first, then examinations.
#[derive(Default)]
pub(super) struct Queue {
    state: Mutex<State>,
    changed: Condvar,
}

impl Queue {
    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// A request has come.
    pub(super) fn request(&self, request: Request) {
        let mut state = self.state();
        let documents = state.documents.clone();
        state.work.push_back(Work::Request(request, documents));
        self.changed.notify_one();
    }

    /// Takes back a request that was not begun; whether there was one.
    pub(super) fn cancel(&self, id: &RequestId) -> bool {
        let mut state = self.state();
        let before = state.work.len();
        state.work.retain(|work| !matches!(work, Work::Request(request, _) if request.id == *id));
        state.work.len() < before
    }

    /// There is another version of a document. It is examined, and then the others that may use it.
    pub(super) fn put(&self, document: Document) {
        let mut state = self.state();
        let name = document.uri.as_str().to_owned();
        state.documents.insert(name.clone(), Arc::new(document));
        let others: Vec<String> =
            state.documents.keys().filter(|other| **other != name).cloned().collect();
        state.to_examine.retain(|one| *one != name);
        state.to_examine.push_front(name);
        for other in others {
            if !state.to_examine.contains(&other) {
                state.to_examine.push_back(other);
            }
        }
        self.changed.notify_one();
    }

    /// The newest version of a document.
    pub(super) fn document(&self, name: &str) -> Option<Arc<Document>> {
        self.state().documents.get(name).cloned()
    }

    /// A document was closed; whether it was open.
    pub(super) fn close(&self, name: &str) -> bool {
        let mut state = self.state();
        state.to_examine.retain(|one| one != name);
        let Some(document) = state.documents.remove(name) else { return false };
        state.work.push_back(Work::Close(document));
        self.changed.notify_one();
        true
    }

    /// Files were changed: everything is read and examined again.
    pub(super) fn forget(&self) {
        let mut state = self.state();
        state.work.push_back(Work::Forget);
        state.to_examine = state.documents.keys().cloned().collect();
        self.changed.notify_one();
    }

    /// The connection has ended.
    pub(super) fn end(&self, code: ExitCode) {
        self.state().work.push_back(Work::End(code));
        self.changed.notify_one();
    }

    /// What to do next.
    pub(super) fn next(&self) -> Work {
        let mut state = self.state();
        loop {
            if let Some(work) = state.next() {
                return work;
            }
            state = self.changed.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
    }

    /// The same if something is to be done that goes before the examination of this version of a
    /// document: whatever was asked for, or a newer version.
    pub(super) fn urgent(&self, examined: &Document) -> Option<Work> {
        let mut state = self.state();
        let newest = state.documents.get(examined.uri.as_str());
        let is_newest = newest.is_some_and(|newest| newest.version == examined.version);
        match state.work.is_empty() && is_newest {
            true => None,
            false => state.next(),
        }
    }

    /// The examination of a document was put off for something else.
    pub(super) fn put_off(&self, document: &Document) {
        let name = document.uri.as_str().to_owned();
        let mut state = self.state();
        if state.documents.contains_key(&name) && !state.to_examine.contains(&name) {
            state.to_examine.push_back(name);
        }
    }
}

impl State {
    fn next(&mut self) -> Option<Work> {
        if let Some(work) = self.work.pop_front() {
            return Some(work);
        }
        while let Some(name) = self.to_examine.pop_front() {
            if let Some(document) = self.documents.get(&name) {
                return Some(Work::Examine(document.clone(), self.documents.clone()));
            }
        }
        None
    }
}
