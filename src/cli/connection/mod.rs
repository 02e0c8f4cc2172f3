//! `gapi lsp`: the language server, on standard input and output.
//!
//! One thread reads messages and keeps the documents, one answers requests, one examines models, one
//! writes. So documents are up to date and requests are answered while a model is examined.

mod frames;
mod queue;
mod worker;

use super::embedding::Embedding;
use super::options::Global;
use super::terminal;
use crate::lsp::{Client, Document, Workspace, capabilities};
use crate::script::Session;
use crate::script::runs::view::Progress;
use crate::script::world::Screen;
use clap::Args;
use frames::Frame;
use lsp_server::{ErrorCode, Message, Notification, Request, Response};
use lsp_types::notification::{
    Cancel, DidChangeTextDocument, DidChangeWatchedFiles, DidCloseTextDocument,
    DidOpenTextDocument, Exit, Notification as _,
};
use lsp_types::request::{Initialize, Request as _, Shutdown};
use lsp_types::{InitializeParams, InitializeResult, ServerInfo};
use queue::Queue;
use serde::de::DeserializeOwned;
use std::io::{self, BufRead};
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::mpsc::{self, Receiver, Sender};
use worker::{Worker, cancelled};

/// Arguments of `gapi lsp`.
#[derive(Debug, Args)]
#[command(after_help = "\
Editors start it; `editors/` in the repository has their settings.
Libraries are found in the folders of --library and MODELICAPATH.")]
pub(super) struct LspArgs {
    /// Accepted because some editors pass it: standard input and output are always used
    #[arg(long, hide = true)]
    pub stdio: bool,
}

/// Where the conversation is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Stage {
    Uninitialized,
    Running,
    ShutDown,
}

/// Serves one client until it ends the connection; exit code 1 if it did not announce that.
pub(super) fn lsp(_arguments: &LspArgs, global: &Global) -> ExitCode {
    let queue = Arc::new(Queue::default());
    let (client, messages) = mpsc::channel();
    let (initialized, started) = mpsc::channel();
    let writer = std::thread::spawn(move || write_all(&messages));
    let reader = Reader {
        queue: queue.clone(),
        client: client.clone(),
        initialized,
        stage: Stage::Uninitialized,
    };
    std::thread::spawn(move || reader.run(&mut io::stdin().lock()));
    // A connection that ends before it begins has no client.
    let who = started.recv().unwrap_or_default();
    let mut embedding = Embedding { cache: false, ..Embedding::default() };
    let libraries = global.library.iter().chain(&who.libraries).chain(&who.folders);
    embedding.libraries = libraries.cloned().collect();
    embedding.read = global.allow_read.clone();
    let code = match embedding.session(Box::new(Silent), Arc::default()) {
        Ok(first) => Worker::new(workspace(who, embedding, first), queue, client).run(),
        Err(error) => {
            terminal::eprint(&format!("error: {error}\n"));
            drop(client);
            return ExitCode::FAILURE;
        }
    };
    // All answers are written before the process ends.
    match writer.join() {
        Ok(Ok(())) => code,
        _ => ExitCode::FAILURE,
    }
}

fn workspace(who: Client, embedding: Embedding, first: Session) -> Workspace {
    let first = std::cell::Cell::new(Some(first));
    Workspace::new(who, move || match first.take() {
        Some(session) => session,
        None => match embedding.session(Box::new(Silent), Arc::default()) {
            Ok(session) => session,
            // The working folder was removed meanwhile: nothing relative is found.
            Err(_) => Session::new(Box::new(crate::script::world::MemoryWorld::new())),
        },
    })
}

/// Writes what is sent to the client; ends when the last sender is gone.
fn write_all(messages: &Receiver<Message>) -> io::Result<()> {
    let mut output = io::stdout().lock();
    messages.iter().try_for_each(|message| frames::write(&mut output, &message))
}

/// What models and libraries print is not shown.
struct Silent;

impl Screen for Silent {
    fn print(&mut self, _text: &str) {}
    fn eprint(&mut self, _text: &str) {}
    fn progress(&mut self, _progress: &Progress) {}
}

/// The thread that reads.
struct Reader {
    queue: Arc<Queue>,
    client: Sender<Message>,
    /// Gets what the client says of itself.
    initialized: Sender<Client>,
    stage: Stage,
}

impl Reader {
    fn run(mut self, input: &mut impl BufRead) {
        loop {
            match frames::read(input) {
                Ok(Frame::Message(Message::Request(request))) => self.request(request),
                Ok(Frame::Message(Message::Notification(one))) if one.method == Exit::METHOD => {
                    break;
                }
                Ok(Frame::Message(Message::Notification(notification))) => {
                    if self.stage == Stage::Running {
                        self.notified(notification);
                    }
                }
                // Nothing was asked.
                Ok(Frame::Message(Message::Response(_))) => {}
                Ok(Frame::Malformed(reason)) => {
                    terminal::eprint(&format!("warning: a message is malformed: {reason}\n"));
                }
                Ok(Frame::End) | Err(_) => break,
            }
        }
        let is_announced = self.stage == Stage::ShutDown;
        self.queue.end(if is_announced { ExitCode::SUCCESS } else { ExitCode::FAILURE });
    }

    fn request(&mut self, request: Request) {
        match (self.stage, request.method.as_str()) {
            (Stage::Uninitialized, Initialize::METHOD) => self.initialize(request),
            (Stage::Uninitialized, _) => {
                self.refuse(request, ErrorCode::ServerNotInitialized, "`initialize` comes first");
            }
            (Stage::Running, Shutdown::METHOD) => {
                self.stage = Stage::ShutDown;
                self.send(Response::new_ok(request.id, ()).into());
            }
            (Stage::Running, Initialize::METHOD) => {
                self.refuse(request, ErrorCode::InvalidRequest, "the server is initialized");
            }
            (Stage::Running, _) => self.queue.request(request),
            (Stage::ShutDown, _) => {
                self.refuse(request, ErrorCode::InvalidRequest, "the server is shut down");
            }
        }
    }

    fn initialize(&mut self, request: Request) {
        let params = serde_json::from_value::<InitializeParams>(request.params.clone());
        let params = match params {
            Ok(params) => params,
            Err(error) => {
                return self.refuse(request, ErrorCode::InvalidParams, &error.to_string());
            }
        };
        self.stage = Stage::Running;
        drop(self.initialized.send(Client::of(&params)));
        let name = "gapi".to_owned();
        let version = Some(env!("CARGO_PKG_VERSION").to_owned());
        let server_info = Some(ServerInfo { name, version });
        let result = InitializeResult { capabilities: capabilities(), server_info };
        self.send(Response::new_ok(request.id, result).into());
    }

    fn notified(&mut self, notification: Notification) {
        let Notification { method, params } = notification;
        match method.as_str() {
            DidOpenTextDocument::METHOD => {
                if let Some(opened) = decoded::<DidOpenTextDocument>(params) {
                    self.queue.put(Document::opened(opened.text_document));
                }
            }
            DidChangeTextDocument::METHOD => {
                if let Some(change) = decoded::<DidChangeTextDocument>(params) {
                    let identifier = change.text_document;
                    if let Some(former) = self.queue.document(identifier.uri.as_str()) {
                        let next = former.changed(identifier.version, change.content_changes);
                        self.queue.put(next);
                    }
                }
            }
            DidCloseTextDocument::METHOD => {
                if let Some(closed) = decoded::<DidCloseTextDocument>(params) {
                    self.queue.close(closed.text_document.uri.as_str());
                }
            }
            DidChangeWatchedFiles::METHOD => {
                if let Some(changed) = decoded::<DidChangeWatchedFiles>(params) {
                    let is_open =
                        |uri: &lsp_types::Uri| self.queue.document(uri.as_str()).is_some();
                    // What is open counts as it is in the editor.
                    if !changed.changes.iter().all(|change| is_open(&change.uri)) {
                        self.queue.forget();
                    }
                }
            }
            Cancel::METHOD => {
                if let Some(id) = cancelled_id(&params)
                    && self.queue.cancel(&id)
                {
                    self.send(cancelled(id));
                }
            }
            _ => {}
        }
    }

    fn refuse(&self, request: Request, code: ErrorCode, reason: &str) {
        self.send(Response::new_err(request.id, code as i32, reason.to_owned()).into());
    }

    fn send(&self, message: Message) {
        drop(self.client.send(message));
    }
}

/// The parameters of a notification; one that has others is passed.
fn decoded<N>(params: serde_json::Value) -> Option<N::Params>
where
    N: lsp_types::notification::Notification,
    N::Params: DeserializeOwned,
{
    match serde_json::from_value(params) {
        Ok(params) => Some(params),
        Err(error) => {
            terminal::eprint(&format!("warning: `{}` is malformed: {error}\n", N::METHOD));
            None
        }
    }
}

fn cancelled_id(params: &serde_json::Value) -> Option<lsp_server::RequestId> {
    serde_json::from_value(params.get("id")?.clone()).ok()
}
