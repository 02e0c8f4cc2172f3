//! What a script may do outside of itself.

/// What the caller of a script allows it, besides its own folder and what it has made itself.
///
/// ```
/// use gapilib_script::world::MemoryWorld;
/// use gapilib_script::{Options, Permissions, Session};
///
/// let permissions = Permissions { read: true, ..Permissions::default() };
/// let options = Options { permissions, ..Options::default() };
/// let mut session = Session::new(Box::new(MemoryWorld::new())).with_options(options);
/// // To run programs is not allowed by that.
/// assert_eq!(session.run_text("input", "system(\"ls\")").code, 1);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Permissions {
    /// To read files anywhere.
    pub read: bool,
    /// To write and remove files anywhere, those too that the run has not made.
    pub write: bool,
    /// To run programs, and to read all environment variables.
    pub system: bool,
}
