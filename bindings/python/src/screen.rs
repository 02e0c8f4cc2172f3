//! What sessions print, on its way to Python.

use gapilib::internals::script::runs::view::Progress;
use gapilib::world::Screen;
use std::sync::mpsc::Sender;

/// What a session tells the thread that waits for it.
pub(crate) enum Event {
    /// Text for standard output.
    Output(String),
    /// Text for standard error.
    Errors(String),
    /// How far it is.
    Progress(Progress),
    /// The work is done.
    Done,
}

/// Sends everything to the waiting call.
pub(crate) struct Channel(pub(crate) Sender<Event>);

impl Screen for Channel {
    fn print(&mut self, text: &str) {
        // No call waits any more: there is no reader.
        let _ = self.0.send(Event::Output(text.to_owned()));
    }

    fn eprint(&mut self, text: &str) {
        let _ = self.0.send(Event::Errors(text.to_owned()));
    }

    fn progress(&mut self, progress: &Progress) {
        let _ = self.0.send(Event::Progress(progress.clone()));
    }
}
