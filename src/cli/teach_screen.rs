//! The screen of `gapi teach` on a terminal: draws, waits for a key, draws again.

use crate::teach::Trace;
use crate::teach::quiz::Score;
use crate::teach::screen::{self, Key, Screen};
use ratatui::crossterm::event::{self, Event, KeyCode, KeyEvent, KeyEventKind, KeyModifiers};

/// Walks through a trace until the learner ends it, and returns the score of the quiz. `run_again`
/// makes the trace of a run that is changed from a generation on, `simulate` the curve of an
/// individual that the trace does not have; both may say why there is none.
///
/// # Errors
///
/// The terminal cannot be drawn on, or gives no keys.
pub(super) fn walk_through(
    mut screen: Screen,
    run_again: impl Fn(usize, &str) -> Result<Trace, String>,
    mut simulate: impl FnMut(&[f64]) -> Result<Vec<f64>, String>,
) -> std::io::Result<Option<Score>> {
    let mut terminal = ratatui::try_init()?;
    let walked = (|| {
        loop {
            if let Some((generation, change)) = screen.take_wish() {
                // The run prints and shows its progress; the screen comes back after it.
                ratatui::restore();
                let branch = run_again(generation, &change);
                terminal = ratatui::try_init()?;
                screen.branched(generation, change, branch);
            }
            if let Some(genes) = screen.take_unknown() {
                screen.simulated(simulate(&genes));
            }
            terminal.draw(|frame| screen::draw(&screen, frame))?;
            match event::read()? {
                Event::Key(key) if key.kind != KeyEventKind::Release => {
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
    ratatui::restore();
    walked
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
