//! The script language: statements, expressions and calls of a session, scripts that run scripts,
//! and what is shown of them.

pub(in crate::script) mod callees;
pub(in crate::script) mod constants;
pub(in crate::script) mod declarations;
pub(in crate::script) mod echo;
pub mod expectation;
pub(in crate::script) mod follow_up;
pub(in crate::script) mod host;
pub(in crate::script) mod log;
pub(in crate::script) mod messages;
pub mod parsing;
pub(in crate::script) mod scripts;
pub(in crate::script) mod statements;
pub(in crate::script) mod transcript;
pub(in crate::script) mod variables;
