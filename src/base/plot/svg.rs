//! The few SVG elements that drawings need, with numbers rounded to hundredths of a pixel.

use super::coordinate::number;
use super::outline;
use maud::Render;
use std::fmt::Write;

/// Where text stands relative to its place.
#[derive(Debug, Clone, Copy)]
pub enum Anchor {
    /// Its begin is there.
    Start,
    /// Its middle is there.
    Middle,
    /// Its end is there.
    End,
}

/// What letters are drawn as.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Letters {
    /// Text, in a face of the viewer.
    Text,
    /// Outlines of a face that comes with the program: the same in every viewer.
    Outlines,
}

/// A picture under construction.
pub struct Svg {
    text: String,
    letters: Letters,
}

/// How a piece of text looks.
#[derive(Debug, Clone, Copy)]
pub struct Writing {
    /// Height of the font in pixels.
    pub size: f64,
    /// Whether in bold face.
    pub bold: bool,
    /// From bottom to top instead of from left to right.
    pub upright: bool,
    /// As CSS writes it.
    pub colour: &'static str,
}

const FACES: &str =
    "font-family=\"Helvetica, Arial, 'Liberation Sans', 'DejaVu Sans', sans-serif\"";

impl Svg {
    /// A picture of its own file.
    pub fn new(width: f64, height: f64, title: &str, letters: Letters) -> Svg {
        let (width, height, title) = (number(width), number(height), escape(title));
        Svg {
            text: format!(
                "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
                 viewBox=\"0 0 {width} {height}\" role=\"img\" {FACES}>\n<title>{title}</title>\n\
                 <rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>\n"
            ),
            letters,
        }
    }

    /// A picture within a page, as wide as the page gives it room and in the page's face;
    /// `title` is what is read out.
    pub fn inline(width: f64, height: f64, title: &str) -> Svg {
        let (width, height, title) = (number(width), number(height), escape(title));
        Svg {
            text: format!(
                "<svg viewBox=\"0 0 {width} {height}\" role=\"img\" aria-label=\"{title}\">\n"
            ),
            letters: Letters::Text,
        }
    }

    /// A picture within a page as large as it is drawn.
    pub(crate) fn of_its_size(width: f64, height: f64, title: &str) -> Svg {
        let inline = Svg::inline(width, height, title);
        let size = format!("<svg width=\"{}\" height=\"{}\" ", number(width), number(height));
        Svg { text: inline.text.replacen("<svg ", &size, 1), ..inline }
    }

    /// Its text.
    pub fn finish(mut self) -> String {
        self.text.push_str("</svg>\n");
        self.text
    }

    /// What follows belongs together, until [`Svg::end`]; `attributes` say as what.
    pub(crate) fn begin(&mut self, attributes: &str) {
        self.put(format_args!("<g {attributes}>"));
    }

    /// The end of what began last.
    pub(crate) fn end(&mut self) {
        self.put(format_args!("</g>"));
    }

    /// A line through points; `style` are further attributes.
    pub fn polyline(&mut self, points: &[(f64, f64)], style: &str) {
        let places = places(points);
        self.put(format_args!("<polyline points=\"{places}\" fill=\"none\" {style}/>"));
    }

    /// The area within points; `style` are further attributes.
    pub(crate) fn polygon(&mut self, points: &[(f64, f64)], style: &str) {
        self.put(format_args!("<polygon points=\"{}\" {style}/>", places(points)));
    }

    /// Pen strokes of no length, which round ends make to dots: many of them in few bytes.
    pub fn dots(&mut self, points: &[(f64, f64)], style: &str) {
        let mut path = String::new();
        for (x, y) in points {
            // Writing into a String cannot fail.
            _ = write!(path, "M{x:.1} {y:.1}h0");
        }
        self.put(format_args!("<path d=\"{path}\" stroke-linecap=\"round\" {style}/>"));
    }

    /// A path as SVG writes it.
    pub fn path(&mut self, path: &str, style: &str) {
        self.put(format_args!("<path d=\"{path}\" {style}/>"));
    }

    /// A circle; `style` are attributes of SVG.
    pub fn circle(&mut self, (x, y): (f64, f64), radius: f64, style: &str) {
        let (x, y, r) = (number(x), number(y), number(radius));
        self.put(format_args!("<circle cx=\"{x}\" cy=\"{y}\" r=\"{r}\" {style}/>"));
    }

    /// A rectangle; `style` are attributes of SVG.
    pub fn rectangle(&mut self, [x, y, width, height]: [f64; 4], style: &str) {
        let [x, y, width, height] = [x, y, width, height].map(number);
        self.put(format_args!(
            "<rect x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" {style}/>"
        ));
    }

    /// Text; `^{…}` in it is raised.
    pub fn text(&mut self, at: (f64, f64), anchor: Anchor, writing: Writing, text: &str) {
        match self.letters {
            Letters::Text => self.letters(at, anchor, writing, text),
            Letters::Outlines => self.outlines(at, anchor, writing, text),
        }
    }

    fn letters(&mut self, (x, y): (f64, f64), anchor: Anchor, writing: Writing, text: &str) {
        let anchor = match anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        };
        let (x, y, text) = (number(x), number(y), escape(&raised(text)));
        let Writing { size, bold, upright, colour } = writing;
        let bold = if bold { " font-weight=\"bold\"" } else { "" };
        let turn =
            if upright { format!(" transform=\"rotate(-90 {x} {y})\"") } else { String::new() };
        self.put(format_args!(
            "<text x=\"{x}\" y=\"{y}\" text-anchor=\"{anchor}\" font-size=\"{size}\"{bold} \
             fill=\"{colour}\"{turn}>{text}</text>"
        ));
    }

    fn outlines(&mut self, (x, y): (f64, f64), anchor: Anchor, writing: Writing, text: &str) {
        let (path, width) = outline::of(&raised(text), writing.size, writing.bold);
        let before = match anchor {
            Anchor::Start => 0.0,
            Anchor::Middle => -0.5 * width,
            Anchor::End => -width,
        };
        let (x, y, before) = (number(x), number(y), number(before));
        let turn = if writing.upright { " rotate(-90)" } else { "" };
        self.put(format_args!(
            "<path transform=\"translate({x} {y}){turn} translate({before} 0)\" fill=\"{}\" d=\"{path}\"/>",
            writing.colour
        ));
    }

    fn put(&mut self, element: std::fmt::Arguments) {
        writeln!(self.text, "{element}").expect("writing into a String does not fail");
    }
}

fn places(points: &[(f64, f64)]) -> String {
    let place = |(x, y): &(f64, f64)| format!("{},{}", number(*x), number(*y));
    points.iter().map(place).collect::<Vec<_>>().join(" ")
}

/// A text as the value of an attribute.
pub(crate) fn attribute(text: &str) -> String {
    escape(&raised(text)).replace('"', "&quot;")
}

/// Text as SVG holds it, without what XML does not allow.
fn escape(text: &str) -> String {
    let allowed = text.chars().filter(|c| !c.is_control() && !matches!(c, '\u{fffe}' | '\u{ffff}'));
    allowed.collect::<String>().render().into_string()
}

/// Writes `10^{-3}` with raised digits. They are letters of their own, not shifted parts: viewers
/// disagree about where shifted parts of centred text lie.
pub(crate) fn raised(text: &str) -> String {
    let mut parts = text.split("^{");
    let mut out = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let (exponent, after) = part.split_once('}').unwrap_or((part, ""));
        out.extend(exponent.chars().map(raised_letter));
        out += after;
    }
    out
}

pub(crate) fn raised_letter(letter: char) -> char {
    match letter {
        '0' => '⁰',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        '4'..='9' => char::from_u32('⁴' as u32 + letter as u32 - '4' as u32).unwrap_or(letter),
        '-' | '−' => '⁻',
        '+' => '⁺',
        other => other,
    }
}

/// About how wide text is, in pixels, in the widest of the faces asked for.
pub(crate) fn label_width(text: &str, size: f64) -> f64 {
    let em = |letter: char| match letter {
        'i' | 'j' | 'l' | '.' | ',' | '\'' | '|' | ':' | ';' | ' ' | 'f' | 't' | 'I' => 0.29,
        '(' | ')' | '[' | ']' | '/' | '-' | 'r' => 0.34,
        'm' | 'w' | 'M' | 'W' | '%' => 0.87,
        'A'..='Z' => 0.70,
        '^' | '{' | '}' => 0.0,
        _ => 0.56,
    };
    1.15 * text.chars().map(em).sum::<f64>() * size
}
