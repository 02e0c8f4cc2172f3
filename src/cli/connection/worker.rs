//! The thread that knows the classes: answers requests, and examines documents between them. Models,
//! which may take seconds, are examined one after the other by another thread.

use super::announced::Announced;
use super::outgoing::Outgoing;
use super::queue::{Queue, Work};
use crate::STACK;
use crate::lsp::{Document, Documents, Examination, Workspace, answer};
use crate::script::models::documents::{CheckedModel, ModelCheck};
use crate::script::with_stack;
use lsp_server::{ErrorCode, Message, Notification, Request, Response};
use lsp_types::notification::{Notification as _, PublishDiagnostics};
use lsp_types::{Diagnostic, PublishDiagnosticsParams, Uri};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// Of a document with more models, what is wrong with its text is always shown before they are examined.
const MANY: usize = 8;

/// Works until the process ends.
pub(super) struct Worker {
    workspace: Workspace,
    queue: Arc<Queue>,
    client: Outgoing,
    /// The examination that has not ended.
    begun: Option<Begun>,
    /// How many examinations were begun: what is found out later for another one is not used.
    count: usize,
    /// Whether a model is being examined.
    is_busy: bool,
    /// Errors in the text of open documents.
    shown: BTreeMap<String, Messages>,
    /// Documents whose first examination is under way.
    announced: Announced,
}

/// What is wrong, wherever: what moves while someone types is nothing new.
type Messages = BTreeSet<String>;

/// An examination of a version of a document.
struct Begun {
    document: Arc<Document>,
    examination: Examination,
}

impl Worker {
    pub(super) fn new(workspace: Workspace, queue: Arc<Queue>, client: Outgoing) -> Worker {
        let announced = Announced::new(client.clone(), workspace.shows_progress());
        Worker {
            workspace,
            queue,
            client,
            begun: None,
            count: 0,
            is_busy: false,
            shown: BTreeMap::new(),
            announced,
        }
    }

    /// Does what is in the queue, without end.
    pub(super) fn run(&mut self) -> ! {
        loop {
            if !self.is_busy {
                self.examine_on();
            }
            match self.queue.next(self.begun.is_some()) {
                Work::Request(request, documents) => self.answer(request, &documents),
                Work::Close(document) => {
                    self.drop_examination(&document);
                    self.workspace.close(&document);
                    self.shown.remove(document.uri.as_str());
                    self.announced.end(&document);
                    self.publish(&document.uri, None, Vec::new());
                }
                Work::Forget => {
                    self.begun = None;
                    self.workspace.forget();
                }
                Work::Examine(document, documents) => self.examine(document, &documents),
                Work::Examined(count, checked) => self.add(count, checked),
            }
        }
    }

    fn drop_examination(&mut self, document: &Document) {
        self.begun.take_if(|begun| begun.document.uri == document.uri);
    }

    /// Begins to examine a document; an interrupted examination continues later.
    fn examine(&mut self, document: Arc<Document>, documents: &Documents) {
        self.drop_examination(&document);
        if let Some(former) = self.begun.take() {
            self.queue.put_off(&former.document);
        }
        if !self.shown.contains_key(document.uri.as_str()) {
            self.announced.begin(&document);
        }
        let examination = self.workspace.examine(&document, documents);
        self.show_first(&document, &examination);
        self.count += 1;
        self.begun = Some(Begun { document, examination });
    }

    /// Shows what is wrong with the text of a document before its models are examined, if that is something
    /// new. It is not all that there is about this version, and does not name it.
    fn show_first(&mut self, document: &Document, examination: &Examination) {
        let found = self.workspace.diagnostics(examination);
        let messages: Messages = found.iter().map(|one| one.message.clone()).collect();
        let shown = self.shown.insert(document.uri.as_str().to_owned(), messages.clone());
        // Nothing was shown of a document that is new, and nothing is nothing new about it.
        let is_new = shown.unwrap_or_default() != messages;
        let left = Workspace::models_left(examination);
        if left > MANY || left > 0 && is_new {
            self.publish(&document.uri, None, found);
        }
    }

    /// Lets the next model be examined, or shows what was found if none is left.
    fn examine_on(&mut self) {
        let Some(begun) = &mut self.begun else { return };
        if let Some(check) = self.workspace.next_model(&mut begun.examination) {
            self.is_busy = true;
            return run_check(self.count, check, self.queue.clone());
        }
        let found = self.workspace.diagnostics(&begun.examination);
        let document = begun.document.clone();
        self.begun = None;
        self.publish(&document.uri, Some(document.version), found);
        self.announced.end(&document);
    }

    fn add(&mut self, count: usize, checked: Option<CheckedModel>) {
        self.is_busy = false;
        if let (Some(begun), Some(checked)) = (&mut self.begun, checked)
            && count == self.count
        {
            self.workspace.add_model(&mut begun.examination, checked);
        }
    }

    fn publish(&self, uri: &Uri, version: Option<i32>, diagnostics: Vec<Diagnostic>) {
        let uri = uri.clone();
        let params = PublishDiagnosticsParams { uri, diagnostics, version };
        let method = PublishDiagnostics::METHOD.to_owned();
        self.client.send(Notification::new(method, params).into());
    }

    fn answer(&mut self, request: Request, documents: &Documents) {
        let Request { id, method, params } = request;
        let response = match answer(&mut self.workspace, documents, &method, params) {
            Ok(value) => Response::new_ok(id, value),
            Err(refused) => Response::new_err(id, refused.code, refused.message),
        };
        self.client.send(response.into());
    }
}

/// Tells the queue that the examination of a model has ended, however it has.
struct Report {
    queue: Arc<Queue>,
    count: usize,
    checked: Option<CheckedModel>,
}

impl Report {
    fn of(mut self, check: ModelCheck) {
        self.checked = Some(check.run());
    }
}

impl Drop for Report {
    fn drop(&mut self) {
        self.queue.examined(self.count, self.checked.take());
    }
}

/// Examines a model on another thread; the result goes into the queue. Without another thread nothing is
/// found out about the model.
fn run_check(count: usize, check: ModelCheck, queue: Arc<Queue>) {
    let report = Report { queue, count, checked: None };
    let work = move || with_stack(STACK - (4 << 20), move || report.of(check));
    drop(std::thread::Builder::new().stack_size(STACK).spawn(work));
}

/// The answer to a request that the client has taken back.
pub(super) fn cancelled(id: lsp_server::RequestId) -> Message {
    let code = ErrorCode::RequestCanceled as i32;
    Response::new_err(id, code, "the client has cancelled the request".to_owned()).into()
}
