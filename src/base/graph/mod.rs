//! The structure of systems of equations, as graphs of integers: which equation determines which
//! unknown, in which order blocks are solved, what has to be iterated.
//!
//! Equations and unknowns are numbered from 0. Nothing here recurses, and results depend on the
//! order of equations and unknowns alone.
//!
//! ```
//! use gapilib_base::graph::{Bipartite, blocks, match_equations};
//! // x0 + x1 = 1;  x0 = 2
//! let graph = Bipartite::new(2, [vec![0, 1], vec![0]]);
//! let matching = match_equations(&graph);
//! assert!(matching.is_perfect());
//! assert_eq!(blocks(&graph, &matching), vec![vec![1], vec![0]]);
//! ```

mod bipartite;
mod dulmage_mendelsohn;
mod matching;
mod pantelides;
mod strongly_connected;
mod tearing;
#[cfg(test)]
mod tests;

pub use bipartite::Bipartite;
pub use dulmage_mendelsohn::{DulmageMendelsohn, dulmage_mendelsohn};
pub use matching::{Matching, match_equations};
pub use pantelides::{Differentiated, differentiate_equations};
pub use strongly_connected::{blocks, strongly_connected};
pub use tearing::{Tearing, tear};
