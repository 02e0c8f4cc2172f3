//! The thread that knows the classes: answers requests, and examines documents between them.

use super::queue::{Queue, Work};
use crate::lsp::{Document, Documents, Examination, Workspace, answer};
use lsp_server::{ErrorCode, Message, Notification, Request, Response};
use lsp_types::notification::{Notification as _, PublishDiagnostics};
use lsp_types::{Diagnostic, PublishDiagnosticsParams, Uri};
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::mpsc::Sender;

/// Of a document with more models, what is wrong with its text is shown before they are examined.
const MANY: usize = 8;

/// Works until the connection ends.
pub(super) struct Worker<'q> {
    pub workspace: Workspace,
    pub queue: &'q Queue,
    pub client: Sender<Message>,
}

impl Worker<'_> {
    /// Does what is in the queue; the exit code of the process.
    pub(super) fn run(&mut self) -> ExitCode {
        let mut begun: Option<(Arc<Document>, Examination)> = None;
        loop {
            let work = match &begun {
                None => Some(self.queue.next()),
                Some((document, _)) => self.queue.urgent(document),
            };
            match work {
                Some(Work::End(code)) => return code,
                Some(Work::Request(request, documents)) => self.answer(request, &documents),
                Some(Work::Close(document)) => {
                    self.workspace.close(&document);
                    self.publish(&document.uri, None, Vec::new());
                }
                Some(Work::Forget) => {
                    self.workspace.forget();
                    begun = None;
                }
                Some(Work::Examine(document, documents)) => {
                    if let Some((former, _)) =
                        begun.take().filter(|(one, _)| one.uri != document.uri)
                    {
                        self.queue.put_off(&former);
                    }
                    let examination = self.workspace.examine(&document, &documents);
                    if Workspace::models_left(&examination) > MANY {
                        let found = self.workspace.diagnostics(&examination);
                        self.publish(&document.uri, Some(document.version), found);
                    }
                    begun = Some((document, examination));
                }
                None => begun = begun.and_then(|begun| self.examine_on(begun)),
            }
        }
    }

    /// Examines one more model of a document; nothing is left of an examination at its end.
    fn examine_on(
        &mut self,
        (document, mut examination): (Arc<Document>, Examination),
    ) -> Option<(Arc<Document>, Examination)> {
        if self.workspace.examine_next(&mut examination) {
            return Some((document, examination));
        }
        let found = self.workspace.diagnostics(&examination);
        self.publish(&document.uri, Some(document.version), found);
        None
    }

    fn publish(&self, uri: &Uri, version: Option<i32>, diagnostics: Vec<Diagnostic>) {
        let uri = uri.clone();
        let params = PublishDiagnosticsParams { uri, diagnostics, version };
        let method = PublishDiagnostics::METHOD.to_owned();
        self.send(Notification::new(method, params).into());
    }

    fn answer(&mut self, request: Request, documents: &Documents) {
        let Request { id, method, params } = request;
        let response = match answer(&mut self.workspace, documents, &method, params) {
            Ok(value) => Response::new_ok(id, value),
            Err(refused) => Response::new_err(id, refused.code, refused.message),
        };
        self.send(response.into());
    }

    /// A client that is gone gets nothing.
    fn send(&self, message: Message) {
        drop(self.client.send(message));
    }
}

/// The answer to a request that the client has taken back.
pub(super) fn cancelled(id: lsp_server::RequestId) -> Message {
    let code = ErrorCode::RequestCanceled as i32;
    Response::new_err(id, code, "the client has cancelled the request".to_owned()).into()
}
