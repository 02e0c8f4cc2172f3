//! Figures as text, for terminals: each character holds two by four dots, with braille patterns.

use super::{Axis, Figure, Panel, Scale, Series};
use crate::elementary;

/// Dots of a character, columns of four from the left.
const DOTS: [[u32; 4]; 2] = [[0x01, 0x02, 0x04, 0x40], [0x08, 0x10, 0x20, 0x80]];

/// The first braille pattern, which has no dots.
const BLANK: u32 = 0x2800;

/// Smallest and largest number of characters in a row or column of a chart.
const SIZES: std::ops::RangeInclusive<usize> = 4..=1000;

impl Figure {
    /// The figure as text: panels one below the other, so many characters wide and so many lines
    /// high each, besides the labels. All series are drawn alike; the legend names them.
    pub fn text(&self, width: usize, height: usize) -> String {
        let clamp = |size: usize| size.clamp(*SIZES.start(), *SIZES.end());
        let (width, height) = (clamp(width), clamp(height));
        let mut text = String::new();
        if !self.title.is_empty() {
            text.push_str(&format!("{}\n", self.title));
        }
        for panel in &self.panels {
            text.push_str(&chart(panel, width, height));
        }
        text
    }
}

fn chart(panel: &Panel, width: usize, height: usize) -> String {
    let mut text = format!("{}\n", heading(panel));
    let x = range(panel.series.iter().flat_map(|series| &series.x), panel.x.scale);
    let y = range(panel.series.iter().flat_map(|series| &series.y), panel.y.scale);
    let (Some(x), Some(y)) = (x, y) else {
        text.push_str("nothing to draw\n");
        return text;
    };
    let mut canvas = Canvas { width, height, cells: vec![0; width * height] };
    for series in &panel.series {
        draw(&mut canvas, series, (x, panel.x.scale), (y, panel.y.scale));
    }
    let shown = |value: f64, scale| {
        if scale == Scale::Logarithmic { elementary::exp(value) } else { value }
    };
    let label = |value: f64| format!("{:>11}", format!("{value:.4e}"));
    for row in 0..height {
        let margin = match row {
            0 => label(shown(y.1, panel.y.scale)),
            _ if row + 1 == height => label(shown(y.0, panel.y.scale)),
            _ => " ".repeat(11),
        };
        text.push_str(&format!("{margin} │{}\n", canvas.row(row)));
    }
    let (first, last) = (shown(x.0, panel.x.scale), shown(x.1, panel.x.scale));
    text.push_str(&format!("{} └{}\n", " ".repeat(11), "─".repeat(width)));
    let below = below([&format!("{first}"), &format!("{last}")], &panel.x, width);
    text.push_str(&format!("{}{below}\n", " ".repeat(13)));
    text
}

/// What is drawn: the quantity, and the names of the series unless the only one is called as it is.
fn heading(panel: &Panel) -> String {
    let names: Vec<&str> = panel.series.iter().map(|series| &*series.name).collect();
    match (panel.y.label.as_str(), names.join(", ")) {
        ("", names) => names,
        (label, names) if names.is_empty() || names == label => panel.y.title(),
        (_, names) => format!("{}: {names}", panel.y.title()),
    }
}

/// What stands below the axis: its ends, and between them the quantity; its unit alone where that has no
/// place.
fn below([first, last]: [&str; 2], x: &Axis, width: usize) -> String {
    let (title, count) = (x.title(), |text: &str| text.chars().count());
    let free = width.saturating_sub(count(first) + count(last));
    if free >= count(&title) + 2 {
        return format!("{first}{title:^free$}{last}");
    }
    let last = format!("{last} {}", x.unit);
    let gap = width.saturating_sub(count(first)).max(1);
    format!("{first}{:>gap$}", last.trim_end())
}

/// Least and greatest of what can be drawn; apart, even if all are equal.
fn range<'a>(values: impl Iterator<Item = &'a f64>, scale: Scale) -> Option<(f64, f64)> {
    let finite = values.map(|value| scaled(*value, scale)).filter(|value| value.is_finite());
    let (least, greatest) = finite
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), value| (a.min(value), b.max(value)));
    let half = if least == greatest { 0.5 * least.abs().max(1.0) } else { 0.0 };
    (least <= greatest).then_some((least - half, greatest + half))
}

/// Not a number where the scale has no place for it.
fn scaled(value: f64, scale: Scale) -> f64 {
    match scale {
        Scale::Linear => value,
        Scale::Logarithmic => elementary::ln(value),
    }
}

/// Lines from point to point, in dots.
fn draw(canvas: &mut Canvas, series: &Series, x: ((f64, f64), Scale), y: ((f64, f64), Scale)) {
    let place = |value: f64, ((least, greatest), scale): ((f64, f64), Scale), dots: usize| {
        let share = (scaled(value, scale) - least) / (greatest - least);
        share.is_finite().then(|| (share * (dots - 1) as f64).round() as i64)
    };
    let (columns, rows) = (2 * canvas.width, 4 * canvas.height);
    let mut last = None;
    for (a, b) in series.x.iter().zip(&series.y) {
        let dot = place(*a, x, columns).zip(place(*b, y, rows));
        if let Some(to) = dot {
            canvas.line(last.unwrap_or(to), to);
        }
        last = dot;
    }
}

/// Dots, those of a character together.
struct Canvas {
    width: usize,
    height: usize,
    cells: Vec<u8>,
}

impl Canvas {
    /// Sets the dots between two, which are counted from the lower left.
    fn line(&mut self, from: (i64, i64), to: (i64, i64)) {
        let steps = (to.0 - from.0).abs().max((to.1 - from.1).abs()).max(1);
        for step in 0..=steps {
            let between =
                |a: i64, b: i64| a + ((b - a) as f64 * step as f64 / steps as f64).round() as i64;
            self.dot(between(from.0, to.0), between(from.1, to.1));
        }
    }

    fn dot(&mut self, x: i64, y: i64) {
        let (x, y) = (x as usize, 4 * self.height - 1 - y as usize);
        let cell = (y / 4) * self.width + x / 2;
        self.cells[cell] |= DOTS[x % 2][y % 4] as u8;
    }

    fn row(&self, row: usize) -> String {
        let cells = &self.cells[row * self.width..(row + 1) * self.width];
        let pattern = |cell: &u8| char::from_u32(BLANK + u32::from(*cell)).unwrap_or(' ');
        let line: String = cells.iter().map(pattern).collect();
        line.trim_end_matches('\u{2800}').to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::super::Mark;
    use super::*;

    fn figure(x: &[f64], y: &[f64]) -> Figure {
        let series = Series {
            name: "v".to_owned(),
            x: x.to_vec(),
            y: y.to_vec(),
            mark: Mark::Line,
            colour: 0,
        };
        let panel = Panel {
            x: Axis::linear("time", "s"),
            y: Axis::linear("v", "V"),
            height: 100.0,
            zero_line: false,
            series: vec![series],
        };
        Figure { title: String::new(), panels: vec![panel] }
    }

    #[test]
    fn a_diagonal_goes_from_corner_to_corner() {
        let text = figure(&[0.0, 2.0], &[1.0, 5.0]).text(4, 4);
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines[0], "v (V)");
        assert!(lines[1].starts_with("   5.0000e0 │") && lines[4].starts_with("   1.0000e0 │"));
        // Eight columns and sixteen rows of dots: two dots a column, rising.
        assert_eq!(lines[4].chars().last(), lines[4].chars().nth(13), "{text}");
        assert!(lines[1].ends_with('\u{285c}'), "{text}");
        assert!(lines[6].trim_start().starts_with('0') && lines[6].ends_with("2 s"), "{text}");
    }

    #[test]
    fn axes_are_named_where_there_is_room() {
        let mut drawn = figure(&[0.0, 10.0], &[1.0, 5.0]);
        drawn.panels[0].y = Axis::of_variable("v", "voltage", "V");
        let text = drawn.text(30, 4);
        assert_eq!(text.lines().next(), Some("voltage (V): v"));
        let last = text.lines().last().unwrap_or_default();
        assert_eq!(last, format!("{}0{:^27}10", " ".repeat(13), "time (s)"));
    }

    #[test]
    fn what_cannot_be_drawn_is_left_out() {
        assert!(figure(&[], &[]).text(10, 5).contains("nothing to draw"));
        assert!(figure(&[f64::NAN], &[1.0]).text(10, 5).contains("nothing to draw"));
        let constant = figure(&[0.0, f64::INFINITY, 1.0], &[3.0, 3.0, 3.0]).text(10, 5);
        assert!(constant.contains("1.5000e0") && constant.contains("4.5000e0"), "{constant}");
        assert!(figure(&[0.0, 1.0], &[0.0, 1.0]).text(0, usize::MAX).lines().count() < 1010);
    }
}
