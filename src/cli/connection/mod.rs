//! `gapi lsp`: the language server, on standard input and output.
//!
//! One thread reads messages and keeps the documents, one answers requests, one examines models, one
//! writes. So documents are up to date and requests are answered while a model is examined. None of
//! them is waited for when the client ends the connection: a large library may take minutes.

mod announced;
mod frames;
mod outgoing;
mod queue;
mod worker;

use super::embedding::Embedding;
use super::options::Global;
use super::terminal;
use crate::STACK;
use crate::lsp::{Client, Document, Workspace, capabilities};
use crate::script::Session;
use crate::script::runs::view::Progress;
use crate::script::with_stack;
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
use outgoing::{Outgoing, write_all};
use queue::Queue;
use serde::de::DeserializeOwned;
use std::io::{self, BufRead};
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::mpsc::{self, Receiver, Sender};
use std::time::Duration;
use worker::{Worker, cancelled};

/// Arguments of `gapi lsp`.
#[derive(Debug, Args)]
#[command(after_help = "\
Example:
  gapi lsp --library ~/libraries

Editors start it; `editors/` in the repository has their settings.
Libraries are found in the folders of --library and MODELICAPATH.

Exit code: 0 if the editor has ended it, 1 if the connection broke off.")]
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

/// Time for the last messages to a client that has ended the connection: it may not read them.
const FAREWELL: Duration = Duration::from_secs(2);

/// Serves one client until it ends the connection; exit code 1 if it did not announce that.
pub(super) fn lsp(_arguments: &LspArgs, global: &Global) -> ExitCode {
    let queue = Arc::new(Queue::default());
    let (client, messages) = Outgoing::new();
    let (initialized, started) = mpsc::channel();
    let (end, ended) = mpsc::channel();
    let (written, all_written) = mpsc::channel();
    let reader = Reader {
        queue: queue.clone(),
        client: client.clone(),
        initialized,
        stage: Stage::Uninitialized,
    };
    let (to_client, global) = (client.clone(), global.clone());
    let begun = begin(&end, "writer", move || {
        let code = write_all(&messages).map_or(ExitCode::FAILURE, |()| ExitCode::SUCCESS);
        _ = written.send(());
        code
    })
    .and_then(|()| begin(&end, "reader", move || reader.run(&mut io::stdin().lock())))
    .and_then(|()| begin(&end, "worker", move || work(&started, &global, queue, to_client)));
    if let Err(error) = begun {
        terminal::eprint(&format!("error: cannot start a thread: {error}\n"));
        return ExitCode::FAILURE;
    }
    let code = ended.recv().unwrap_or(ExitCode::FAILURE);
    client.finish();
    // Without an answer the client does not read, or is gone.
    _ = all_written.recv_timeout(FAREWELL);
    code
}

/// Starts a thread whose end is the end of the connection.
fn begin(
    end: &Sender<ExitCode>,
    name: &str,
    work: impl FnOnce() -> ExitCode + Send + 'static,
) -> io::Result<()> {
    let ending = Ending { end: end.clone(), code: ExitCode::from(101) };
    let thread = std::thread::Builder::new().name(name.to_owned()).stack_size(STACK);
    thread.spawn(move || ending.after(work)).map(drop)
}

/// Tells that a thread has ended, with a panic as well, which has said what happened.
struct Ending {
    end: Sender<ExitCode>,
    code: ExitCode,
}

impl Ending {
    fn after(mut self, work: impl FnOnce() -> ExitCode) {
        self.code = with_stack(STACK - (4 << 20), work);
    }
}

impl Drop for Ending {
    fn drop(&mut self) {
        // Another thread may have ended the connection.
        _ = self.end.send(self.code);
    }
}

/// Answers and examines, for the client that says who it is.
fn work(
    started: &Receiver<Client>,
    global: &Global,
    queue: Arc<Queue>,
    client: Outgoing,
) -> ExitCode {
    // A connection that ends before it begins has no client.
    let who = started.recv().unwrap_or_default();
    let mut embedding = Embedding { cache: false, ..Embedding::default() };
    let libraries = global.library.iter().chain(&who.libraries).chain(&who.folders);
    embedding.libraries = libraries.cloned().collect();
    embedding.read = global.allow_read.clone();
    match embedding.session(Box::new(Silent), Arc::default()) {
        Ok(first) => Worker::new(workspace(who, embedding, first), queue, client).run(),
        Err(error) => {
            terminal::eprint(&format!("error: {error}\n"));
            ExitCode::FAILURE
        }
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
    client: Outgoing,
    /// Gets what the client says of itself.
    initialized: Sender<Client>,
    stage: Stage,
}

impl Reader {
    /// Reads until the client ends the connection; the exit code of the process.
    fn run(mut self, input: &mut impl BufRead) -> ExitCode {
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
        match self.stage {
            Stage::ShutDown => ExitCode::SUCCESS,
            Stage::Uninitialized | Stage::Running => ExitCode::FAILURE,
        }
    }

    fn request(&mut self, request: Request) {
        match (self.stage, request.method.as_str()) {
            (Stage::Uninitialized, Initialize::METHOD) => self.initialize(request),
            (Stage::Uninitialized, _) => {
                self.refuse(request, ErrorCode::ServerNotInitialized, "`initialize` comes first");
            }
            (Stage::Running, Shutdown::METHOD) => {
                self.stage = Stage::ShutDown;
                self.client.send(Response::new_ok(request.id, ()).into());
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
        self.client.send(Response::new_ok(request.id, result).into());
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
                    self.client.send(cancelled(id));
                }
            }
            _ => {}
        }
    }

    fn refuse(&self, request: Request, code: ErrorCode, reason: &str) {
        self.client.send(Response::new_err(request.id, code as i32, reason.to_owned()).into());
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
