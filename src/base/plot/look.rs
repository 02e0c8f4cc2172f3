//! Colours and measures of figures: of those that are files, and of those within a page.
//!
//! Colours are the palette of Okabe and Ito (2008), black first, the two that print darkest next:
//! readers with any kind of colour vision can tell them apart.

use super::svg::Writing;
use std::borrow::Cow;

/// How figures look.
#[derive(Debug)]
pub(crate) struct Look {
    pub(super) width: f64,
    ink: &'static str,
    pub(super) paper: &'static str,
    /// Attributes of lines.
    pub(super) frame: &'static str,
    pub(super) grid: &'static str,
    pub(super) fine_grid: &'static str,
    pub(super) zero: &'static str,
    pub(super) palette: [&'static str; 8],
    /// Whether faint colours are mixed with white instead of being transparent: svg2pdf 0.13 lists
    /// several transparencies in the order of a hash map, and the same figure must give the same
    /// bytes.
    solid: bool,
    /// Whether the legend is part of the figure.
    pub(super) legend: bool,
    /// Whether areas and series say what they are, for the script of a page.
    pub(super) describes: bool,
}

/// A figure on white paper.
pub(crate) static FILE: Look = Look {
    width: 640.0,
    ink: "#222222",
    paper: "#ffffff",
    frame: "fill=\"none\" stroke=\"#444444\" stroke-width=\"1\"",
    grid: "stroke=\"#e2e2e2\" stroke-width=\"0.8\"",
    fine_grid: "stroke=\"#f1f1f1\" stroke-width=\"0.8\"",
    zero: "stroke=\"#888888\" stroke-width=\"1\"",
    palette: [
        "#000000", "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#f0e442",
    ],
    solid: false,
    legend: true,
    describes: false,
};

/// The same for PNG and PDF.
pub(crate) static SOLID: Look = Look { solid: true, ..FILE };

/// A figure in a page, whose style sheet knows whether it is dark. On a phone of 390 pixels its 12
/// pixel letters are still 9 high.
pub(crate) static PAGE: Look = page(480.0);

/// A figure of which three stand side by side on a screen of 1280 pixels; they have one legend.
pub(crate) static SMALL: Look = Look { legend: false, ..page(380.0) };

/// The legend of figures that stand side by side.
pub(crate) static LEGEND: Look = page(350.0);

const fn page(width: f64) -> Look {
    Look {
        width,
        ink: "var(--ink)",
        paper: "var(--paper)",
        frame: "fill=\"none\" stroke=\"var(--frame)\" stroke-width=\"1\"",
        grid: "stroke=\"var(--grid)\" stroke-width=\"0.8\"",
        fine_grid: "stroke=\"var(--fine-grid)\" stroke-width=\"0.8\"",
        zero: "stroke=\"var(--frame)\" stroke-width=\"1\"",
        palette: [
            "var(--c0)",
            "var(--c1)",
            "var(--c2)",
            "var(--c3)",
            "var(--c4)",
            "var(--c5)",
            "var(--c6)",
            "var(--c7)",
        ],
        solid: false,
        legend: true,
        describes: true,
    }
}

impl Look {
    /// The colour of a series and the attribute `opacity` that makes it faint, if any.
    pub(crate) fn faint(
        &self,
        colour: usize,
        attribute: &str,
        opacity: f64,
    ) -> (Cow<'static, str>, String) {
        let colour = self.palette[colour % self.palette.len()];
        match self.solid {
            true => (mixed(colour, opacity).into(), String::new()),
            false => (colour.into(), format!(" {attribute}=\"{opacity}\"")),
        }
    }

    /// Plain text of this size.
    pub(crate) fn writing(&self, size: f64) -> Writing {
        Writing { size, bold: false, upright: false, colour: self.ink }
    }
}

/// A colour `#rrggbb` on white.
fn mixed(colour: &str, opacity: f64) -> String {
    let part =
        |at: usize| u8::from_str_radix(colour.get(at..at + 2).unwrap_or("00"), 16).unwrap_or(0);
    let on_white = |part: u8| (opacity * f64::from(part) + (1.0 - opacity) * 255.0).round() as u8;
    let [red, green, blue] = [1, 3, 5].map(|at| on_white(part(at)));
    format!("#{red:02x}{green:02x}{blue:02x}")
}

#[cfg(test)]
mod tests {
    #[test]
    fn faint_colours_lie_between_the_colour_and_white() {
        assert_eq!(super::mixed("#0072b2", 1.0), "#0072b2");
        assert_eq!(super::mixed("#0072b2", 0.0), "#ffffff");
        assert_eq!(super::mixed("#000000", 0.2), "#cccccc");
    }
}
