//! Figures as SVG, PNG and PDF, and as text for terminals: panels with points, lines and bands,
//! linear and logarithmic axes, a legend above the data. The same figure gives the same bytes.
//!
//! Text is laid out without font files: widths are estimates for a sans-serif face, used only to
//! keep labels apart. Colours are the palette of Okabe and Ito, which readers with any kind of
//! colour vision can tell apart; series also differ in weight and marks.

mod bode;
mod chart;
mod coordinate;
mod draw;
pub mod errors;
mod figure;
mod look;
mod matrix;
mod outline;
mod picture;
mod ready;
mod svg;
mod ticks;

pub use bode::{Responding, bode};
pub use draw::{power, prefixed, shown_unit};
pub use figure::{Axis, Figure, Mark, Panel, Scale, Series};
pub use matrix::Matrix;
pub use picture::Picture;
pub use ready::{Comparison, MANY, convergence, fit, of_points, of_residuals, undrowned};
pub use svg::{Anchor, Letters, Svg, Writing};
