//! Requests: which are answered, and by what.

use super::workspace::{Documents, Workspace};
use lsp_types::{
    InitializeParams, OneOf, ServerCapabilities, TextDocumentSyncCapability, TextDocumentSyncKind,
    TextDocumentSyncOptions, Uri,
};
use serde::de::DeserializeOwned;
use serde_json::Value;
use std::path::PathBuf;
use std::sync::Arc;

/// Why a request has no answer.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Refusal {
    /// The code of the protocol.
    pub code: i32,
    /// One sentence.
    pub message: String,
}

/// The codes of JSON-RPC and of the protocol.
const METHOD_NOT_FOUND: i32 = -32601;
const INVALID_PARAMS: i32 = -32602;
const REQUEST_FAILED: i32 = -32803;

impl Refusal {
    /// A request that cannot be served, and why.
    pub fn failed(message: impl Into<String>) -> Refusal {
        Refusal { code: REQUEST_FAILED, message: message.into() }
    }
}

/// What the server can do.
pub fn capabilities() -> ServerCapabilities {
    ServerCapabilities {
        text_document_sync: Some(TextDocumentSyncCapability::Options(TextDocumentSyncOptions {
            open_close: Some(true),
            change: Some(TextDocumentSyncKind::INCREMENTAL),
            ..TextDocumentSyncOptions::default()
        })),
        ..ServerCapabilities::default()
    }
}

/// The folders with libraries that the client names, besides those of the command line:
/// `initializationOptions.libraries`.
pub fn libraries(params: &InitializeParams) -> Vec<PathBuf> {
    let folders = params.initialization_options.as_ref().and_then(|all| all.get("libraries"));
    let folders = folders.and_then(Value::as_array).into_iter().flatten();
    folders.filter_map(Value::as_str).map(PathBuf::from).collect()
}

/// Answers a request.
///
/// # Errors
/// It is not known, its parameters are not those of its method, or it cannot be served.
pub fn answer(
    workspace: &mut Workspace,
    documents: &Documents,
    method: &str,
    params: Value,
) -> Result<Value, Refusal> {
    let _ = (workspace, documents, params);
    Err(Refusal { code: METHOD_NOT_FOUND, message: format!("`{method}` is not supported") })
}
