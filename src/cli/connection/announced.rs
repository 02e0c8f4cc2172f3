//! Progress of the first examination of a document, for which libraries are loaded.

use super::outgoing::Outgoing;
use crate::lsp::Document;
use lsp_server::{Notification, Request, RequestId};
use lsp_types::notification::{Notification as _, Progress};
use lsp_types::request::{Request as _, WorkDoneProgressCreate};
use lsp_types::{
    NumberOrString, ProgressParams, ProgressParamsValue, WorkDoneProgress, WorkDoneProgressBegin,
    WorkDoneProgressCreateParams, WorkDoneProgressEnd,
};
use std::collections::BTreeSet;

/// The documents whose examination was announced and has not ended.
pub(super) struct Announced {
    client: Outgoing,
    /// Whether the client shows progress.
    is_shown: bool,
    begun: BTreeSet<String>,
}

impl Announced {
    pub(super) fn new(client: Outgoing, is_shown: bool) -> Announced {
        Announced { client, is_shown, begun: BTreeSet::new() }
    }

    pub(super) fn begin(&mut self, document: &Document) {
        if !self.is_shown || !self.begun.insert(document.uri.as_str().to_owned()) {
            return;
        }
        let token = token(document);
        let id = RequestId::from(format!("progress of {}", document.uri.as_str()));
        let create = WorkDoneProgressCreateParams { token: token.clone() };
        let method = WorkDoneProgressCreate::METHOD.to_owned();
        self.client.send(Request::new(id, method, create).into());
        let name = document.path.as_ref().and_then(|path| path.file_name());
        let name = name.map_or_else(|| document.name(), |name| name.to_string_lossy().into_owned());
        self.report(
            token,
            WorkDoneProgress::Begin(WorkDoneProgressBegin {
                title: format!("Checking {name}"),
                ..WorkDoneProgressBegin::default()
            }),
        );
    }

    pub(super) fn end(&mut self, document: &Document) {
        if self.begun.remove(document.uri.as_str()) {
            self.report(token(document), WorkDoneProgress::End(WorkDoneProgressEnd::default()));
        }
    }

    fn report(&self, token: NumberOrString, value: WorkDoneProgress) {
        let params = ProgressParams { token, value: ProgressParamsValue::WorkDone(value) };
        self.client.send(Notification::new(Progress::METHOD.to_owned(), params).into());
    }
}

fn token(document: &Document) -> NumberOrString {
    NumberOrString::String(document.uri.as_str().to_owned())
}
