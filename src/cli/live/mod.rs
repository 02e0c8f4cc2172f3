//! The live view of a run: a screen of its own on the terminal, drawn from time to time during the
//! run, and the keys that are pressed meanwhile.

mod draw;
mod keys;

use crate::script::runs::view::View;
use keys::Keys;
use ratatui::Terminal;
use ratatui::backend::{Backend, CrosstermBackend};
use ratatui::crossterm::execute;
use ratatui::crossterm::terminal::{
    EnterAlternateScreen, LeaveAlternateScreen, disable_raw_mode, enable_raw_mode,
    is_raw_mode_enabled,
};
use std::io::{self, Stderr, Write, stderr};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

/// Runs that are shorter have no view.
const PATIENCE: Duration = Duration::from_secs(1);
/// Between two drawings.
const EVERY: Duration = Duration::from_millis(150);
/// What remains on the terminal of the view.
const BEGINS: &str = "live view of the run (--plain shows a progress bar instead)\n";

/// The view, once there is one.
pub(super) struct Live {
    interrupt: Arc<AtomicBool>,
    /// When the run was first asked for a view, and when it was drawn last.
    asked: Option<Instant>,
    drawn: Option<Instant>,
    screen: Option<Screen>,
    /// It could not be drawn.
    broken: bool,
}

struct Screen {
    terminal: Terminal<CrosstermBackend<Stderr>>,
    keys: Keys,
}

impl Live {
    /// A view whose Ctrl-C sets `interrupt`.
    pub(super) fn new(interrupt: Arc<AtomicBool>) -> Live {
        Live { interrupt, asked: None, drawn: None, screen: None, broken: false }
    }

    /// Whether it is time to draw.
    pub(super) fn is_due(&mut self) -> bool {
        let now = Instant::now();
        let asked = *self.asked.get_or_insert(now);
        let waited = now.duration_since(asked) >= PATIENCE;
        let rested = self.drawn.is_none_or(|drawn| now.duration_since(drawn) >= EVERY);
        !self.broken && waited && rested
    }

    /// Whether it is on the screen.
    pub(super) fn is_shown(&self) -> bool {
        self.screen.is_some()
    }

    /// Draws the run. A terminal that cannot be drawn on is left alone from then on.
    pub(super) fn show(&mut self, view: &View, message: &str) {
        let drawn = self.opened().and_then(|screen| {
            screen.terminal.draw(|frame| draw::draw(view, message, frame)).map(|_| ())
        });
        if drawn.is_err() {
            self.close();
            self.broken = true;
        }
        self.drawn = Some(Instant::now());
    }

    /// Whether `p` was pressed; true once for each time.
    pub(super) fn pause_was_pressed(&mut self) -> bool {
        self.screen.as_ref().is_some_and(|screen| screen.keys.pause_was_pressed())
    }

    /// Gives the terminal back.
    pub(super) fn close(&mut self) {
        self.asked = None;
        if let Some(screen) = self.screen.take() {
            drop(screen.keys);
            restore_terminal();
            release(screen.terminal);
        }
    }

    fn opened(&mut self) -> io::Result<&mut Screen> {
        if self.screen.is_none() {
            stderr().write_all(BEGINS.as_bytes())?;
            enable_raw_mode()?;
            execute!(stderr(), EnterAlternateScreen)?;
            let terminal = Terminal::new(CrosstermBackend::new(stderr()))?;
            let keys = Keys::watch(Arc::clone(&self.interrupt));
            self.screen = Some(Screen { terminal, keys });
        }
        match &mut self.screen {
            Some(screen) => Ok(screen),
            None => Err(io::ErrorKind::Other.into()),
        }
    }
}

impl Drop for Live {
    fn drop(&mut self) {
        self.close();
    }
}

/// Shows the cursor again. A terminal that is gone is left alone: it would say that it has no cursor on
/// standard error, which is gone as well, and a process that cannot say something there panics.
pub(super) fn release<B: Backend>(mut terminal: Terminal<B>) {
    if terminal.show_cursor().is_err() {
        std::mem::forget(terminal);
    }
}

/// Leaves the screen of the live view, if it is shown. A terminal that is gone needs nothing.
pub(super) fn restore_terminal() {
    if is_raw_mode_enabled().unwrap_or(false) {
        let _ = execute!(stderr(), LeaveAlternateScreen);
        let _ = disable_raw_mode();
    }
}
