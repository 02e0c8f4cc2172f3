//! The only door to the outside: files, the environment of the process, the screen.
//!
//! Nothing below `cli/` touches the system in any other way, so a script runs in a [`MemoryWorld`]
//! exactly as it runs on a disk. A function takes the one trait of the three that it needs.

mod environment;
mod files;
mod memory;
mod screen;

pub use environment::{Environment, Store};
pub use files::{Content, FileAccess, FileReader, Files, Stamp, normalized};
#[cfg(test)]
pub(crate) use memory::Shown;
pub use memory::{MemoryWorld, Streams, Views};
pub use screen::Screen;

/// All that a session can do outside of itself and learn from there.
pub trait World: Files + Environment + Screen {}

impl<T: Files + Environment + Screen> World for T {}
