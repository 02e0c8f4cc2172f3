//! Keys that are pressed during a run. A thread reads them, so that Ctrl-C works in the
//! midst of a long simulation.

use crate::hangup::{self, Input};
use ratatui::crossterm::event::{self, Event, KeyCode, KeyEvent, KeyEventKind, KeyModifiers};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;
use std::time::Duration;

/// How long the end of the watch may take.
const LOOK: Duration = Duration::from_millis(50);

/// The watch over the keys; it ends when this is dropped.
pub(super) struct Keys {
    pause: Arc<AtomicBool>,
    ended: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl Keys {
    /// Watches from now on.
    pub(super) fn watch(interrupt: Arc<AtomicBool>) -> Keys {
        let (pause, ended) = (Arc::new(AtomicBool::new(false)), Arc::new(AtomicBool::new(false)));
        let (paused, over) = (Arc::clone(&pause), Arc::clone(&ended));
        let watch = move || {
            while !over.load(Ordering::Relaxed) {
                if hangup::wait(LOOK) == Input::Closed {
                    return;
                }
                let Ok(true) = event::poll(Duration::ZERO) else { continue };
                let Ok(Event::Key(key)) = event::read() else { continue };
                if is_interrupt(key) {
                    interrupted(&interrupt);
                } else if key.kind != KeyEventKind::Release && key.code == KeyCode::Char('p') {
                    paused.store(true, Ordering::Relaxed);
                }
            }
        };
        // Without the thread, keys have no effect.
        let thread = std::thread::Builder::new().name("keys".to_owned()).spawn(watch);
        Keys { pause, ended, thread: thread.ok() }
    }

    pub(super) fn pause_was_pressed(&self) -> bool {
        self.pause.swap(false, Ordering::Relaxed)
    }
}

impl Drop for Keys {
    fn drop(&mut self) {
        self.ended.store(true, Ordering::Relaxed);
        if let Some(thread) = self.thread.take() {
            // It has nothing to give.
            let _ = thread.join();
        }
    }
}

fn is_interrupt(key: KeyEvent) -> bool {
    key.modifiers.contains(KeyModifiers::CONTROL) && key.code == KeyCode::Char('c')
}

/// As the handler of Ctrl-C does: the second time ends the process at once.
fn interrupted(flag: &AtomicBool) {
    if flag.swap(true, Ordering::SeqCst) {
        super::restore_terminal();
        #[allow(clippy::exit, reason = "the user asked twice")]
        std::process::exit(130);
    }
}
