//! What is wrong with a functional mock-up unit.

/// What is wrong with a functional mock-up unit, or with its description.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum FmuError {
    /// The description is no XML.
    #[error("`modelDescription.xml` is not well-formed: {0}")]
    Xml(String),
    /// An element or attribute contradicts the standard.
    #[error("`modelDescription.xml`, line {line}: {message}")]
    Description {
        /// The line of the element, from 1.
        line: u32,
        /// What is wrong there.
        message: String,
    },
    /// The archive cannot be read or written.
    #[error("{0}")]
    Archive(String),
    /// A file that every unit has is not in the archive.
    #[error("there is no `{0}` in it")]
    Missing(String),
}
