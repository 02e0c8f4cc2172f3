//! What a script may do outside of itself.

/// What the caller of a script allows it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Permissions {
    /// To read files anywhere.
    pub read: bool,
    /// To write and remove files anywhere, those too that the run has not made.
    pub write: bool,
    /// To run programs, and to read all environment variables.
    pub system: bool,
}
