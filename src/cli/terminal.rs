//! The terminal: the only place that prints.
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "this is where printing happens")]

use super::fitted::fitted;
use super::live::Live;
use super::options::Colour;
use crate::diag::render::render_within;
use crate::diag::{Diagnostic, visible, visible_coloured};
use crate::script::runs::view::Progress;
use crate::script::runs::view::View;
use crate::script::world::Screen;
use crate::source::SourceMap;
use gapilib_identify::problem::Status;
use indicatif::{HumanDuration, ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};
use ratatui::crossterm::terminal::size;
use std::borrow::Cow;
use std::io::{IsTerminal, Write as _};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// Standard output, standard error and the progress bar between them.
pub(super) struct Terminal {
    colour: bool,
    quiet: bool,
    bar: Option<ProgressBar>,
    live: Live,
    interrupt: Arc<AtomicBool>,
    /// Whether runs may be drawn.
    draws: bool,
    /// Whether what scripts print is left out, and progress is shown all the same.
    silent: bool,
    /// Whether another screen is shown during the run: there is no progress then.
    aside: bool,
    /// What is said while a run is drawn: for standard output or not, and the text.
    kept: Vec<(bool, String)>,
}

impl Terminal {
    /// A terminal that follows the user's options about colours.
    pub(super) fn new(colour: Colour, quiet: bool) -> Terminal {
        let is_allowed = std::env::var_os("NO_COLOR").is_none_or(|value| value.is_empty());
        let colour = match colour {
            Colour::Always => true,
            Colour::Never => false,
            Colour::Auto => is_allowed && std::io::stderr().is_terminal(),
        };
        let interrupt = Arc::new(AtomicBool::new(false));
        let live = Live::new(Arc::clone(&interrupt));
        let draws = !quiet && std::io::stderr().is_terminal() && std::io::stdin().is_terminal();
        Terminal {
            colour,
            quiet,
            bar: None,
            live,
            interrupt,
            draws,
            silent: false,
            aside: false,
            kept: Vec::new(),
        }
    }

    /// What becomes true when the user presses Ctrl-C.
    pub(super) fn interrupt(&self) -> Arc<AtomicBool> {
        Arc::clone(&self.interrupt)
    }

    /// Runs are not drawn.
    pub(super) fn forbid_view(&mut self) {
        self.draws = false;
    }

    /// What scripts print is left out; a bar shows the progress of the run.
    pub(super) fn show_progress_only(&mut self) {
        self.draws = false;
        self.silent = true;
    }

    /// Another screen is shown: what is said is kept until the end.
    pub(super) fn stand_aside(&mut self) {
        self.show_progress_only();
        self.aside = true;
    }

    /// Takes the progress bar away.
    pub(super) fn finish_progress(&mut self) {
        if let Some(bar) = self.bar.take() {
            bar.finish_and_clear();
        }
    }

    fn suspended(&self, work: impl FnOnce()) {
        match &self.bar {
            Some(bar) => bar.suspend(work),
            None => work(),
        }
    }
}

impl Screen for Terminal {
    fn status(&mut self) -> Option<Status> {
        if self.quiet || self.aside || !std::io::stderr().is_terminal() {
            return None;
        }
        self.end_view();
        self.finish_progress();
        Some(Arc::new(|text: &str| {
            // The line is written over by the next one, which a second line would not be.
            let text: String = text.chars().take(columns().saturating_sub(1)).collect();
            let line = format!("\r\u{1b}[K{text}");
            let mut err = std::io::stderr().lock();
            let _ = err.write_all(line.as_bytes()).and_then(|()| err.flush());
        }))
    }

    fn is_view_due(&mut self) -> bool {
        self.draws && self.live.is_due()
    }

    fn show_view(&mut self, view: &View) {
        self.finish_progress();
        let said = self.kept.iter().rev().flat_map(|(_, text)| text.lines().rev());
        let last = said.map(str::trim).find(|line| !line.is_empty()).unwrap_or_default();
        self.live.show(view, last);
    }

    fn end_view(&mut self) {
        self.finish_progress();
        self.live.close();
        if self.aside {
            return;
        }
        for (out, text) in std::mem::take(&mut self.kept) {
            if out { self.print_of_script(&text) } else { self.eprint(&text) }
        }
    }

    fn is_pause_requested(&mut self) -> bool {
        let was_pressed = self.live.pause_was_pressed();
        if was_pressed {
            self.end_view();
        }
        was_pressed
    }

    fn ask(&mut self, prompt: &str) -> Option<String> {
        let line = rustyline::DefaultEditor::new().and_then(|mut editor| editor.readline(prompt));
        if matches!(line, Err(rustyline::error::ReadlineError::Interrupted)) {
            self.interrupt.store(true, Ordering::SeqCst);
        }
        line.ok()
    }

    fn colour(&self) -> bool {
        self.colour
    }

    fn print(&mut self, text: &str) {
        if !self.quiet {
            self.print_of_script(&for_stream(&std::io::stdout(), text));
        }
    }

    fn print_of_script(&mut self, text: &str) {
        if self.silent {
            return;
        }
        if self.aside || self.live.is_shown() && std::io::stdout().is_terminal() {
            self.kept.push((true, text.to_owned()));
            return;
        }
        let text = on_terminal(std::io::stdout().is_terminal(), text);
        self.suspended(|| {
            let mut out = std::io::stdout().lock();
            checked(out.write_all(text.as_bytes()).and_then(|()| out.flush()));
        });
    }

    fn eprint(&mut self, text: &str) {
        if self.aside || self.live.is_shown() {
            self.kept.push((false, text.to_owned()));
            return;
        }
        let text = for_stream(&std::io::stderr(), text);
        self.suspended(|| {
            let _ = std::io::stderr().lock().write_all(visible_coloured(&text).as_bytes());
        });
    }

    fn columns(&self) -> Option<usize> {
        columns_of_errors()
    }

    fn is_one_screen(&self) -> bool {
        std::io::stdout().is_terminal() && std::io::stderr().is_terminal()
    }

    fn progress(&mut self, progress: &Progress) {
        let is_hidden = self.quiet || self.aside || self.live.is_shown();
        if is_hidden || !std::io::stderr().is_terminal() {
            return;
        }
        let bar = self.bar.get_or_insert_with(|| new_bar(progress));
        if progress.total > 0 {
            bar.set_length(progress.total);
        }
        bar.set_position(progress.done);
        let best = progress.best.map_or(String::new(), |best| format!("best {best:.4e}"));
        bar.set_message(format!("{best}  failures {}", progress.failures));
        if progress.total > 0 && progress.done >= progress.total {
            self.finish_progress();
        }
    }
}

/// What was said while a run was drawn is said although the run ended otherwise.
impl Drop for Terminal {
    fn drop(&mut self) {
        self.aside = false;
        self.silent = false;
        self.end_view();
    }
}

/// What scripts print is shown as text on a terminal, and kept as it is elsewhere.
fn on_terminal(is_terminal: bool, text: &str) -> Cow<'_, str> {
    if is_terminal { visible(text) } else { Cow::Borrowed(text) }
}

fn new_bar(progress: &Progress) -> ProgressBar {
    let known = progress.total > 0;
    let template = if known {
        "{prefix} {pos}/{len} {wide_bar:.cyan/dim} {msg}  {left} left"
    } else {
        "{prefix} {pos} {spinner} {wide_msg}  {elapsed}"
    };
    let style = ProgressStyle::with_template(template)
        .unwrap_or_else(|_| ProgressStyle::default_bar())
        .with_key("left", |state: &ProgressState, text: &mut dyn std::fmt::Write| {
            let _ = write!(text, "{:#}", HumanDuration(round_up(state.eta())));
        });
    let target = ProgressDrawTarget::stderr_with_hz(10);
    let bar = ProgressBar::with_draw_target(known.then_some(progress.total), target);
    bar.set_style(style);
    bar.set_prefix(progress.label.clone());
    bar
}

fn round_up(duration: Duration) -> Duration {
    Duration::from_secs(duration.as_secs() + u64::from(duration.subsec_nanos() > 0))
}

/// Columns of a terminal that does not say how many it has.
const COLUMNS: usize = 80;

/// Columns of the terminal.
fn columns() -> usize {
    // A terminal of a few columns would have a word on each line.
    let known = size().ok().map(|(columns, _)| usize::from(columns)).filter(|columns| *columns > 0);
    known.unwrap_or(COLUMNS).max(COLUMNS / 2)
}

/// Columns of the terminal that shows standard error, if one does.
fn columns_of_errors() -> Option<usize> {
    std::io::stderr().is_terminal().then(columns)
}

/// A diagnostic where there is no session.
pub(super) fn rendered(diagnostic: &Diagnostic, sources: &SourceMap) -> String {
    render_within(diagnostic, sources, false, columns_of_errors().unwrap_or(usize::MAX))
}

/// What the program says, laid out for the terminal; unchanged elsewhere.
fn for_stream<'t>(stream: &impl IsTerminal, text: &'t str) -> Cow<'t, str> {
    match stream.is_terminal() {
        true => Cow::Owned(fitted(text, columns())),
        false => Cow::Borrowed(text),
    }
}

/// Writes a report to standard output where there is no session: laid out on a terminal, unchanged
/// elsewhere.
pub(super) fn print_report(text: &str) {
    print(&for_stream(&std::io::stdout(), text));
}

/// Writes to standard output where there is no session: as text on a terminal, unchanged elsewhere.
pub(super) fn print(text: &str) {
    write(&on_terminal(std::io::stdout().is_terminal(), text));
}

/// Writes text with colours to standard output. What it quotes from files must be made visible before
/// it is coloured.
pub(super) fn print_coloured(text: &str) {
    write(&visible_coloured(text));
}

fn write(text: &str) {
    let mut out = std::io::stdout().lock();
    checked(out.write_all(text.as_bytes()).and_then(|()| out.flush()));
}

/// Whether something could not be written to standard output.
static OUTPUT_FAILED: AtomicBool = AtomicBool::new(false);

/// Whether all that was printed has reached standard output.
pub(super) fn output_failed() -> bool {
    OUTPUT_FAILED.load(Ordering::SeqCst)
}

/// Says once that standard output cannot be written. A reader that closed the pipe (`| head`) needs
/// no more.
fn checked(written: std::io::Result<()>) {
    let Err(error) = written else { return };
    let is_new = error.kind() != std::io::ErrorKind::BrokenPipe
        && !OUTPUT_FAILED.swap(true, Ordering::SeqCst);
    if is_new {
        eprint(&format!("error: standard output cannot be written: {error}\n"));
    }
}

/// Writes to standard error where there is no session.
pub(super) fn eprint(text: &str) {
    let text = for_stream(&std::io::stderr(), text);
    let _ = std::io::stderr().lock().write_all(visible(&text).as_bytes());
}

/// Says what is wrong with the command line, or the help that was asked for; the exit code. Arguments
/// may be names of files that a shell has found.
pub(super) fn print_usage(error: &clap::Error) -> u8 {
    if error.use_stderr() {
        let is_allowed = std::env::var_os("NO_COLOR").is_none_or(|value| value.is_empty());
        let text = match is_allowed && std::io::stderr().is_terminal() {
            true => error.render().ansi().to_string(),
            false => error.render().to_string(),
        };
        let _ = std::io::stderr().lock().write_all(visible_coloured(&text).as_bytes());
    } else {
        // Without a terminal to print to, the code says it.
        let _ = error.print();
    }
    u8::try_from(error.exit_code()).unwrap_or(2)
}
