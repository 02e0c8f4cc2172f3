//! What a user sees of a run, and types.

use crate::identify::problem::Status;
use crate::runs::view::{Progress, View};

/// Standard output and standard error, progress, the live view, and a prompt.
pub trait Screen {
    /// Text for standard output; no line end is added.
    fn print(&mut self, text: &str);
    /// The same, that a script prints: shown where only errors are, too.
    fn print_of_script(&mut self, text: &str) {
        self.print(text);
    }
    /// Text for standard error (diagnostics); no line end is added.
    fn eprint(&mut self, text: &str);
    /// Columns of the terminal that shows standard error, if one does.
    fn columns(&self) -> Option<usize> {
        None
    }
    /// Whether standard output and standard error are shown on the same screen, so that what one of
    /// them has said need not be said by the other.
    fn is_one_screen(&self) -> bool {
        false
    }
    /// Shows how far a long piece of work is.
    fn progress(&mut self, progress: &Progress);
    /// Shows in a line what is being done, from any thread; an empty text takes it away. `None`
    /// where it would not be seen.
    fn status(&mut self) -> Option<Status> {
        None
    }
    /// Whether a view of the run would be drawn now: asked often, so that none is made in vain.
    fn is_view_due(&mut self) -> bool {
        false
    }
    /// Draws the run as it is now.
    fn show_view(&mut self, _view: &View) {}
    /// The run has ended: what was drawn goes away.
    fn end_view(&mut self) {}
    /// Whether the user requests a pause of the run; true once for each time.
    fn is_pause_requested(&mut self) -> bool {
        false
    }
    /// A pause begins: what the user can do then.
    fn begin_pause(&mut self, help: &str) {
        self.eprint(help);
    }
    /// A line that the user types during a pause; `None` when nothing more comes.
    fn ask(&mut self, _prompt: &str) -> Option<String> {
        None
    }
    /// Whether the run took the line that the user typed, or why it did not.
    fn changed(&mut self, _line: &str, _outcome: Result<(), &str>) {}
    /// Whether diagnostics may be coloured.
    fn colour(&self) -> bool {
        false
    }
}
