//! What editors ask about open documents, by the Language Server Protocol
//! ([3.17](https://microsoft.github.io/language-server-protocol/)): diagnostics, completion, hover,
//! definitions and references, renaming, outline, symbols of the workspace, signatures, folding, links,
//! lenses, formatting, actions, colours and units.
//!
//! Text goes in and types of the protocol come out. The connection (`cli::connection`) keeps the
//! documents and hands the newest versions to a [`Workspace`], which keeps the classes in a session: an
//! open document stands for its file, saved or not. Text that cannot be read is read without the lines
//! that are wrong (`recovery`), so that everything but diagnostics works while someone types. All
//! answers about names come from one list: what each written name means (`occurrences`).

mod actions;
mod attributes;
mod client;
mod completion;
mod description;
mod diagnostics;
mod document;
mod folding;
mod formatting;
mod hints;
mod lenses;
mod lines;
mod links;
mod navigation;
mod occurrences;
mod outline;
mod parsed;
mod recovery;
mod refusal;
mod rename;
mod requests;
mod signature;
mod tokens;
mod uri;
mod workspace;
mod workspace_symbols;

pub use client::Client;
pub(super) use description::described;
pub use document::Document;
pub use refusal::Refusal;
pub use requests::{answer, capabilities};
pub use workspace::{Documents, Examination, Workspace};
