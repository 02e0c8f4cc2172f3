//! The screen of `gapi teach` on a terminal: draws, waits for a key, draws again.

use super::hangup::{self, Input};
use super::live::release;
use gapilib_script::teach::Trace;
use gapilib_script::teach::quiz::Score;
use gapilib_script::teach::screen::{self, Key, Screen};
use ratatui::crossterm::event::{self, Event, KeyCode, KeyEvent, KeyEventKind, KeyModifiers};
use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// How long the end of the screen may take after a signal.
const LOOK: Duration = Duration::from_millis(100);

/// Where the steps come from.
pub(super) trait Source {
    /// The trace of the run with a change from a generation on, from 1, or why there is none.
    fn run_again(&mut self, generation: usize, change: &str) -> Result<Trace, String>;
    /// The curve of an individual that the trace does not have, or why there is none.
    fn curve(&mut self, genes: &[f64]) -> Result<Vec<f64>, String>;
    /// Whether the run has not ended.
    fn continues(&self) -> bool {
        false
    }
    /// The whole trace, once when the run has ended, or why there is none.
    fn ended(&mut self) -> Option<Result<Trace, String>> {
        None
    }
    /// What becomes true when the user asks to stop.
    fn interrupt(&self) -> Arc<AtomicBool> {
        Arc::default()
    }
}

/// Walks through a trace until the learner ends it, and returns the score of the quiz. The screen also
/// ends when `interrupt` is set, and when its terminal is closed.
///
/// # Errors
///
/// The terminal cannot be drawn on, or gives no keys.
pub(super) fn walk_through(
    mut screen: Screen,
    source: &mut dyn Source,
    interrupt: &AtomicBool,
) -> io::Result<Option<Score>> {
    let mut terminal = ratatui::try_init()?;
    let walked = (|| {
        loop {
            if let Some((generation, change)) = screen.take_change() {
                // The run prints and shows its progress; the screen returns after it.
                leave();
                let branch = source.run_again(generation, &change);
                release(std::mem::replace(&mut terminal, ratatui::try_init()?));
                screen.branched(generation, change, branch);
            }
            if let Some(genes) = screen.take_unknown() {
                screen.simulated(source.curve(&genes));
            }
            terminal.draw(|frame| screen::draw(&screen, frame))?;
            match next_event(interrupt, source)? {
                Next::Leave => return Ok(screen.score()),
                Next::Ended(run) => screen.ended(run),
                Next::Event(Event::Key(key)) if key.kind != KeyEventKind::Release => {
                    let go_on =
                        !is_interrupt(key) && named(key).is_none_or(|key| screen.press(key));
                    if !go_on {
                        return Ok(screen.score());
                    }
                }
                Next::Event(_) => {}
            }
        }
    })();
    leave();
    release(terminal);
    walked
}

/// Gives the terminal back. One that is gone needs nothing.
fn leave() {
    let _ = ratatui::try_restore();
}

/// What happens next.
enum Next {
    /// The user does something.
    Event(Event),
    /// The run has ended.
    Ended(Result<Trace, String>),
    /// Nothing comes any more: after an interrupt, or without a terminal.
    Leave,
}

/// Waits for what the user does, and for the end of the run.
fn next_event(interrupt: &AtomicBool, source: &mut dyn Source) -> io::Result<Next> {
    while !interrupt.load(Ordering::SeqCst) {
        if let Some(run) = source.ended() {
            return Ok(Next::Ended(run));
        }
        if hangup::wait(LOOK) == Input::Closed {
            break;
        }
        if event::poll(Duration::ZERO)? {
            return event::read().map(Next::Event);
        }
    }
    Ok(Next::Leave)
}

fn is_interrupt(key: KeyEvent) -> bool {
    key.modifiers.contains(KeyModifiers::CONTROL) && matches!(key.code, KeyCode::Char('c' | 'd'))
}

fn named(key: KeyEvent) -> Option<Key> {
    Some(match key.code {
        KeyCode::Char(c) => Key::Char(c),
        KeyCode::Left => Key::Left,
        KeyCode::Right => Key::Right,
        KeyCode::Up | KeyCode::PageUp => Key::Up,
        KeyCode::Down | KeyCode::PageDown => Key::Down,
        KeyCode::Home => Key::Home,
        KeyCode::End => Key::End,
        KeyCode::Tab => Key::Tab,
        KeyCode::Backspace => Key::Backspace,
        KeyCode::Enter => Key::Enter,
        KeyCode::Esc => Key::Escape,
        _ => return None,
    })
}
