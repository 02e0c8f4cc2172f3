//! Letters as outlines, from the DejaVu Sans that the program carries: pictures then look the same
//! wherever they are drawn, and no library for shaping text is needed. Letters are set one after
//! the other by their advance widths, without kerning; that is enough for labels of axes.

use super::coordinate::number;
use std::fmt::Write;
use ttf_parser::{Face, GlyphId, OutlineBuilder};

/// The outlines of a line of text as the data of an SVG path that begins at the origin, and how
/// wide it is. A letter that the face does not have is drawn as its empty box.
pub(crate) fn of(text: &str, size: f64, bold: bool) -> (String, f64) {
    let font = if bold { dejavu::sans::bold() } else { dejavu::sans::regular() };
    let Ok(face) = Face::parse(font, 0) else { return (String::new(), 0.0) };
    let scale = size / f64::from(face.units_per_em());
    let mut pen = Pen { path: String::new(), x: 0.0, scale };
    for letter in text.chars() {
        let glyph = face.glyph_index(letter).unwrap_or(GlyphId(0));
        face.outline_glyph(glyph, &mut pen);
        pen.x += scale * f64::from(face.glyph_hor_advance(glyph).unwrap_or(0));
    }
    (pen.path, pen.x)
}

/// Writes outlines; y of a font points up.
struct Pen {
    path: String,
    x: f64,
    scale: f64,
}

impl Pen {
    fn put(&mut self, command: char, points: &[(f32, f32)]) {
        self.path.push(command);
        for (x, y) in points {
            let x = self.x + self.scale * f64::from(*x);
            let y = -self.scale * f64::from(*y);
            // Writing into a String cannot fail.
            _ = write!(self.path, "{} {} ", number(x), number(y));
        }
    }
}

impl OutlineBuilder for Pen {
    fn move_to(&mut self, x: f32, y: f32) {
        self.put('M', &[(x, y)]);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.put('L', &[(x, y)]);
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        self.put('Q', &[(x1, y1), (x, y)]);
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        self.put('C', &[(x1, y1), (x2, y2), (x, y)]);
    }

    fn close(&mut self) {
        self.path.push('Z');
    }
}
