//! A figure as a file: SVG, PNG or PDF, by the ending of its name.
//!
//! PNG is drawn by resvg, PDF by svg2pdf, both from the same SVG with outlined letters, so that
//! neither needs a font of the machine.

use super::Figure;
use super::errors::UNKNOWN_PICTURE;
use crate::diag::Fault;
use crate::fault;
#[cfg(feature = "pictures")]
use resvg::{tiny_skia, usvg};
use std::path::Path;

/// Pixels of a PNG for each pixel of the SVG: 1280 across.
#[cfg(feature = "pictures")]
const ENLARGED: f32 = 2.0;

/// A format of pictures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Picture {
    /// Lines and letters, for pages.
    Svg,
    /// Pixels, 1280 across.
    Png,
    /// Lines, for print and LaTeX.
    Pdf,
}

impl Picture {
    /// The format that the ending of a file's name says.
    ///
    /// # Errors
    ///
    /// Other endings, or none.
    pub fn of(path: &Path) -> Result<Picture, Fault> {
        let ending = path.extension().map(|ending| ending.to_string_lossy().to_ascii_lowercase());
        match ending.as_deref() {
            Some("svg") => Ok(Picture::Svg),
            Some("png") => Ok(Picture::Png),
            Some("pdf") => Ok(Picture::Pdf),
            _ => Err(fault!(
                UNKNOWN_PICTURE,
                "the extension of `{}` is not `.svg`, `.png` or `.pdf`", path.display();
                help: "the file extension selects SVG, PNG or PDF"
            )),
        }
    }
}

impl Figure {
    /// The bytes of the figure's file.
    ///
    /// # Errors
    ///
    /// A picture that is too large to be drawn.
    pub fn picture(&self, format: Picture) -> Result<Vec<u8>, Fault> {
        match format {
            Picture::Svg => Ok(self.svg().into_bytes()),
            Picture::Png | Picture::Pdf => self.drawn(format),
        }
    }

    #[cfg(not(feature = "pictures"))]
    fn drawn(&self, _: Picture) -> Result<Vec<u8>, Fault> {
        Err(fault!(UNKNOWN_PICTURE,
            "this build draws neither PNG nor PDF: it lacks the feature `pictures`";
            help: "write an `.svg`"))
    }

    #[cfg(feature = "pictures")]
    fn drawn(&self, format: Picture) -> Result<Vec<u8>, Fault> {
        let failed = |why: &dyn std::fmt::Display| {
            fault!(UNKNOWN_PICTURE, "the figure cannot be drawn: {why}")
        };
        let tree = usvg::Tree::from_str(&self.outlined(), &usvg::Options::default());
        let tree = tree.map_err(|error| failed(&error))?;
        if format == Picture::Pdf {
            let options = (svg2pdf::ConversionOptions::default(), svg2pdf::PageOptions::default());
            return svg2pdf::to_pdf(&tree, options.0, options.1).map_err(|error| failed(&error));
        }
        let size = tree.size().to_int_size().scale_by(ENLARGED);
        let pixels = size.and_then(|size| tiny_skia::Pixmap::new(size.width(), size.height()));
        let mut pixels = pixels.ok_or_else(|| failed(&"it is too large"))?;
        let transform = tiny_skia::Transform::from_scale(ENLARGED, ENLARGED);
        resvg::render(&tree, transform, &mut pixels.as_mut());
        pixels.encode_png().map_err(|error| failed(&error))
    }
}
