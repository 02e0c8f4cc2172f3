//! What is sent to the client, by the threads that read and work, and written by one thread.

use super::frames;
use lsp_server::Message;
use std::io;
use std::sync::mpsc::{self, Receiver, Sender};

/// The way to the thread that writes.
#[derive(Clone)]
pub(super) struct Outgoing(Sender<Option<Message>>);

impl Outgoing {
    /// With the messages to be written, which end with `None`.
    pub(super) fn new() -> (Outgoing, Receiver<Option<Message>>) {
        let (sender, messages) = mpsc::channel();
        (Outgoing(sender), messages)
    }

    /// Sends a message; a client that is gone gets nothing.
    pub(super) fn send(&self, message: Message) {
        drop(self.0.send(Some(message)));
    }

    /// What was sent until now is written, and nothing after it.
    pub(super) fn finish(&self) {
        drop(self.0.send(None));
    }
}

/// Writes what is sent to the client.
///
/// # Errors
/// The client does not read any more.
pub(super) fn write_all(messages: &Receiver<Option<Message>>) -> io::Result<()> {
    let mut output = io::stdout().lock();
    messages.iter().map_while(|one| one).try_for_each(|one| frames::write(&mut output, &one))
}
