//! What the client asked for and what is to be examined, between the thread that reads messages and
//! the one that works.

use crate::lsp::{Document, Documents};
use crate::script::models::documents::CheckedModel;
use lsp_server::{Request, RequestId};
use std::collections::VecDeque;
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
    /// A model of the examination of this number was examined.
    Examined(usize, Option<CheckedModel>),
}

#[derive(Default)]
struct State {
    documents: Documents,
    work: VecDeque<Work>,
    /// Names of documents that were changed, the last first.
    changed: VecDeque<String>,
    /// Names of other documents to be examined, when nothing else is to be done.
    others: VecDeque<String>,
}

/// Work in the order in which it is done: what was asked for first, then examinations.
#[derive(Default)]
pub(super) struct Queue {
    state: Mutex<State>,
    notify: Condvar,
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
        self.notify.notify_one();
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
        state.no_longer(&name);
        state.changed.push_front(name);
        others.into_iter().for_each(|other| state.later(other));
        self.notify.notify_one();
    }

    /// The newest version of a document.
    pub(super) fn document(&self, name: &str) -> Option<Arc<Document>> {
        self.state().documents.get(name).cloned()
    }

    /// A document was closed; whether it was open.
    pub(super) fn close(&self, name: &str) -> bool {
        let mut state = self.state();
        state.no_longer(name);
        let Some(document) = state.documents.remove(name) else { return false };
        state.work.push_back(Work::Close(document));
        self.notify.notify_one();
        true
    }

    /// Files were changed: everything is read and examined again.
    pub(super) fn forget(&self) {
        let mut state = self.state();
        state.work.push_back(Work::Forget);
        state.others = state.documents.keys().cloned().collect();
        self.notify.notify_one();
    }

    /// What was found out about a model.
    pub(super) fn examined(&self, count: usize, checked: Option<CheckedModel>) {
        self.state().work.push_back(Work::Examined(count, checked));
        self.notify.notify_one();
    }

    /// What to do next. While a document is being examined (`is_examining`), only what was asked for and
    /// documents that were changed.
    pub(super) fn next(&self, is_examining: bool) -> Work {
        let mut state = self.state();
        loop {
            if let Some(work) = state.next(is_examining) {
                return work;
            }
            state = self.notify.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
    }

    /// The examination of a document was put off for something else.
    pub(super) fn put_off(&self, document: &Document) {
        let mut state = self.state();
        state.later(document.uri.as_str().to_owned());
    }
}

impl State {
    fn next(&mut self, is_examining: bool) -> Option<Work> {
        if let Some(work) = self.work.pop_front() {
            return Some(work);
        }
        loop {
            let changed = self.changed.pop_front();
            let name = match is_examining {
                true => changed?,
                false => changed.or_else(|| self.others.pop_front())?,
            };
            if let Some(document) = self.documents.get(&name) {
                return Some(Work::Examine(document.clone(), self.documents.clone()));
            }
        }
    }

    /// A document is examined later, once.
    fn later(&mut self, name: String) {
        let is_known = self.changed.contains(&name) || self.others.contains(&name);
        if self.documents.contains_key(&name) && !is_known {
            self.others.push_back(name);
        }
    }

    fn no_longer(&mut self, name: &str) {
        self.changed.retain(|one| one != name);
        self.others.retain(|one| one != name);
    }
}
