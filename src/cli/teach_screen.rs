//! The screen of `gapi teach` on a terminal: draws, waits for a key, draws again.

use super::hangup::{self, Input};
use super::live::release;
use gapilib_script::teach::Trace;
use gapilib_script::teach::quiz::Score;
use gapilib_script::teach::screen::{self, Key, Screen};
use ratatui::crossterm::event::{self, Event, KeyCode, KeyEvent, KeyEventKind, KeyModifiers};
use std::io;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// How long the end of the screen may take after a signal.
const LOOK: Duration = Duration::from_millis(100);

/// Walks through a trace until the learner ends it, and returns the score of the quiz. `run_again`
/// makes the trace of a run that is changed from a generation on, `simulate` the curve of an
/// individual that the trace does not have; both may say why there is none. The screen also ends when
/// `interrupt` is set, and when its terminal is closed.
///
/// # Errors
///
/// The terminal cannot be drawn on, or gives no keys.
pub(super) fn walk_through(
    mut screen: Screen,
    run_again: impl Fn(usize, &str) -> Result<Trace, String>,
    mut simulate: impl FnMut(&[f64]) -> Result<Vec<f64>, String>,
    interrupt: &AtomicBool,
) -> io::Result<Option<Score>> {
    let mut terminal = ratatui::try_init()?;
    let walked = (|| {
        loop {
            if let Some((generation, change)) = screen.take_change() {
                // The run prints and shows its progress; the screen returns after it.
                leave();
                let branch = run_again(generation, &change);
                release(std::mem::replace(&mut terminal, ratatui::try_init()?));
                screen.branched(generation, change, branch);
            }
            if let Some(genes) = screen.take_unknown() {
                screen.simulated(simulate(&genes));
            }
            terminal.draw(|frame| screen::draw(&screen, frame))?;
            match next_event(interrupt)? {
                None => return Ok(screen.score()),
                Some(Event::Key(key)) if key.kind != KeyEventKind::Release => {
                    let go_on =
                        !is_interrupt(key) && named(key).is_none_or(|key| screen.press(key));
                    if !go_on {
                        return Ok(screen.score());
                    }
                }
                _ => {}
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

/// Waits for what the user does; nothing comes any more after an interrupt or without a terminal.
fn next_event(interrupt: &AtomicBool) -> io::Result<Option<Event>> {
    while !interrupt.load(Ordering::SeqCst) {
        if hangup::wait(LOOK) == Input::Closed {
            break;
        }
        if event::poll(Duration::ZERO)? {
            return event::read().map(Some);
        }
    }
    Ok(None)
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
