//! Where execution continues after a statement.

/// Where execution continues after a statement.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Flow {
    /// With the next statement.
    Next,
    /// After the innermost loop (`break`, MLS §11.2.5).
    Break,
    /// At the end of the function (`return`, MLS §11.2.6).
    Return,
}
