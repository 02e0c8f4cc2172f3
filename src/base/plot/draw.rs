//! From a figure to a picture.

use super::figure::{Axis, Figure, Mark, Panel, Scale, Series};
use super::look::{FILE, LEGEND, Look, PAGE, SMALL, SOLID};
use super::svg::{Anchor, Letters, Svg, Writing, attribute, label_width, raised};
use super::ticks::{Ticks, power_of_ten};
use std::collections::HashSet;

const RIGHT: f64 = 24.0;
const GAP: f64 = 22.0;
const BELOW: f64 = 52.0;
/// A cloud of more dots has smaller ones.
const THOUSANDS: usize = 1000;

/// The area for data of one panel.
pub(super) struct Area<'a> {
    pub left: f64,
    pub top: f64,
    pub width: f64,
    pub height: f64,
    pub x: &'a Ticks,
    pub y: &'a Ticks,
    pub look: &'static Look,
}

impl Figure {
    /// The figure as an SVG document, 640 pixels wide.
    pub fn svg(&self) -> String {
        self.document(&FILE, Letters::Text)
    }

    /// The same without any font or transparency: letters are drawn as outlines.
    pub(super) fn outlined(&self) -> String {
        self.document(&SOLID, Letters::Outlines)
    }

    fn document(&self, look: &'static Look, letters: Letters) -> String {
        let layout = Layout::of(self, look);
        let svg = Svg::new(look.width, layout.height, &self.title, letters);
        self.draw(svg, &layout)
    }

    /// The figure as an SVG element of a page: narrower, so that its letters stay readable on a
    /// phone, in colours that the style of the page defines (`--ink`, `--frame`, `--grid`,
    /// `--fine-grid`, `--paper`, `--c0` to `--c7`). `label` is what a screen reader says.
    pub fn inline(&self, label: &str) -> String {
        self.within(&PAGE, label)
    }

    /// The same, for figures that stand side by side.
    pub fn small(&self, label: &str) -> String {
        self.within(&SMALL, label)
    }

    /// The legend alone, for figures that stand side by side and have none.
    pub fn legend(&self) -> String {
        let rows = legend_rows(&self.panels, LEGEND.width);
        let mut svg = Svg::inline(LEGEND.width, 22.0 * rows.len() as f64, "legend");
        for (row, entries) in rows.iter().enumerate() {
            draw_legend(&mut svg, entries, &LEGEND, (0.0, 22.0 * row as f64 + 11.0));
        }
        svg.finish()
    }

    fn within(&self, look: &'static Look, label: &str) -> String {
        let layout = Layout::of(self, look);
        self.draw(Svg::inline(look.width, layout.height, label), &layout)
    }

    fn draw(&self, mut svg: Svg, layout: &Layout) -> String {
        let Layout { look, left, title_height, .. } = *layout;
        let middle = 0.5 * (left + look.width - RIGHT);
        let heading = Writing { bold: true, ..look.writing(15.0) };
        if !self.title.is_empty() {
            svg.text((middle, 26.0), Anchor::Middle, heading, &self.title);
        }
        for (row, entries) in layout.legend.iter().enumerate() {
            draw_legend(&mut svg, entries, look, (left, title_height + 22.0 * row as f64 + 8.0));
        }
        let mut top = layout.top;
        for (place, (panel, y)) in self.panels.iter().zip(&layout.y_ticks).enumerate() {
            let (width, height) = (look.width - RIGHT - left, panel.height);
            let area = Area { left, top, width, height, x: &layout.x_ticks, y, look };
            area.draw(&mut svg, panel, place + 1 == self.panels.len());
            top += panel.height + GAP;
        }
        svg.finish()
    }
}

/// Where the parts of a figure lie.
struct Layout<'a> {
    look: &'static Look,
    y_ticks: Vec<Ticks>,
    x_ticks: Ticks,
    left: f64,
    legend: Vec<Vec<&'a Series>>,
    title_height: f64,
    top: f64,
    height: f64,
}

impl<'a> Layout<'a> {
    fn of(figure: &'a Figure, look: &'static Look) -> Layout<'a> {
        let y_ticks: Vec<Ticks> = figure.panels.iter().map(ticks_of_y).collect();
        let x_scale = figure.panels.first().map_or(Scale::Linear, |panel| panel.x.scale);
        let all = figure.panels.iter().flat_map(|panel| &panel.series);
        let count = (look.width / 80.0) as usize;
        let x_ticks = Ticks::new(all.flat_map(|series| series.x.iter().copied()), x_scale, count);
        let left = left_margin(&y_ticks);
        let legend = match look.legend {
            true => legend_rows(&figure.panels, look.width - RIGHT - left),
            false => Vec::new(),
        };
        let title_height = if figure.title.is_empty() { 12.0 } else { 38.0 };
        let top = title_height + 22.0 * legend.len() as f64 + 4.0;
        let heights: f64 = figure.panels.iter().map(|panel| panel.height).sum();
        let gaps = GAP * figure.panels.len().saturating_sub(1) as f64;
        let height = top + heights + gaps + BELOW;
        Layout { look, y_ticks, x_ticks, left, legend, title_height, top, height }
    }
}

fn ticks_of_y(panel: &Panel) -> Ticks {
    let values = panel.series.iter().flat_map(|series| series.y.iter().copied());
    let zero = panel.zero_line.then_some(0.0);
    Ticks::new(values.chain(zero), panel.y.scale, (panel.height / 42.0) as usize + 1)
}

fn left_margin(y_ticks: &[Ticks]) -> f64 {
    let labels = y_ticks.iter().flat_map(|ticks| &ticks.major);
    44.0 + labels.map(|(_, label)| label_width(label, 12.0)).fold(12.0, f64::max)
}

/// The named series, in rows that fit the width.
fn legend_rows(panels: &[Panel], room: f64) -> Vec<Vec<&Series>> {
    let mut rows: Vec<Vec<&Series>> = Vec::new();
    let mut used = f64::INFINITY;
    let named = panels.iter().flat_map(|panel| &panel.series).filter(|s| !s.name.is_empty());
    for series in named {
        let width = legend_width(series);
        if used + width > room {
            rows.push(Vec::new());
            used = 0.0;
        }
        used += width;
        rows.last_mut().expect("the first entry starts a row").push(series);
    }
    rows
}

fn legend_width(series: &Series) -> f64 {
    34.0 + label_width(&series.name, 12.5) + 22.0
}

fn draw_legend(svg: &mut Svg, entries: &[&Series], look: &'static Look, (mut x, y): (f64, f64)) {
    for series in entries {
        let middle = (x + 13.0, y);
        match series.mark {
            Mark::Line | Mark::Thin | Mark::Dashed => {
                svg.polyline(&[(x, y), (x + 26.0, y)], &stroke(series, look));
            }
            Mark::Area => svg.rectangle([x, y - 6.0, 26.0, 12.0], &area(series, look)),
            Mark::Points => svg.circle(middle, 3.4, &open_circle(series, look)),
            Mark::Stems | Mark::Dots => svg.circle(middle, 2.6, &dot(series, look)),
            Mark::Crosses => svg.path(&cross(middle), &cross_style(series, look)),
        }
        svg.text((x + 34.0, y + 4.2), Anchor::Start, look.writing(12.5), &series.name);
        x += legend_width(series);
    }
}

fn colour(series: &Series, look: &'static Look) -> &'static str {
    look.palette[series.colour % look.palette.len()]
}

fn stroke(series: &Series, look: &'static Look) -> String {
    let plain = || (look.palette[series.colour % look.palette.len()].into(), String::new());
    let ((colour, opacity), pen) = match series.mark {
        Mark::Thin => (look.faint(series.colour, "stroke-opacity", 0.7), "stroke-width=\"0.8\""),
        Mark::Dashed => (plain(), "stroke-width=\"1.5\" stroke-dasharray=\"7 4\""),
        _ => (plain(), "stroke-width=\"1.8\""),
    };
    format!("stroke=\"{colour}\" {pen}{opacity} stroke-linejoin=\"round\"")
}

fn open_circle(series: &Series, look: &'static Look) -> String {
    let paper = look.paper;
    format!("fill=\"{paper}\" stroke=\"{}\" stroke-width=\"1.3\"", colour(series, look))
}

fn dot(series: &Series, look: &'static Look) -> String {
    format!("fill=\"{}\"", colour(series, look))
}

fn area(series: &Series, look: &'static Look) -> String {
    let (colour, opacity) = look.faint(series.colour, "fill-opacity", 0.22);
    format!("fill=\"{colour}\"{opacity}")
}

fn cloud(series: &Series, look: &'static Look) -> String {
    let (colour, opacity) = look.faint(series.colour, "stroke-opacity", 0.55);
    let size = if series.x.len() > THOUSANDS { 2.2 } else { 3.6 };
    format!("fill=\"none\" stroke=\"{colour}\" stroke-width=\"{size}\"{opacity}")
}

fn cross((x, y): (f64, f64)) -> String {
    format!("M{:.1} {:.1}l7 7m0 -7l-7 7", x - 3.5, y - 3.5)
}

fn cross_style(series: &Series, look: &'static Look) -> String {
    format!("fill=\"none\" stroke=\"{}\" stroke-width=\"2\"", colour(series, look))
}

impl Axis {
    /// What stands beside it, as plain text: the quantity, with its unit in brackets.
    pub fn title(&self) -> String {
        raised(&axis_title(self, 0))
    }
}

/// What stands beside an axis: the quantity with its unit.
pub(super) fn axis_title(axis: &Axis, exponent: i32) -> String {
    if let Some(unit) = prefixed(&axis.unit, exponent) {
        return format!("{} ({})", axis.label, marked_unit(&unit));
    }
    let power = if exponent == 0 { String::new() } else { power_of_ten(exponent) };
    match (&*power, &*marked_unit(&axis.unit)) {
        ("", "") => axis.label.clone(),
        (power, "") => format!("{} ({power})", axis.label),
        ("", unit) => format!("{} ({unit})", axis.label),
        (power, unit) => format!("{} ({power}\u{a0}{unit})", axis.label),
    }
}

impl Area<'_> {
    fn draw(&self, svg: &mut Svg, panel: &Panel, is_last: bool) {
        self.draw_data(svg, panel);
        self.draw_labels(svg, panel, is_last);
    }

    /// Grid, frame and series, without labels.
    pub(crate) fn draw_data(&self, svg: &mut Svg, panel: &Panel) {
        self.draw_grid(svg);
        if panel.zero_line {
            self.draw_level(svg, 0.0, self.look.zero);
        }
        let frame = format!("{}{}", self.look.frame, self.described());
        svg.rectangle([self.left, self.top, self.width, self.height], &frame);
        for series in &panel.series {
            match self.look.describes {
                false => self.draw_series(svg, series),
                true => {
                    let (name, of) = (attribute(&series.name), self.id());
                    svg.begin(&format!("data-series=\"{name}\" data-of=\"{of}\""));
                    self.draw_series(svg, series);
                    svg.end();
                }
            }
        }
    }

    fn x_of(&self, value: f64) -> Option<f64> {
        self.x.place(value).map(|place| self.left + place * self.width)
    }

    fn y_of(&self, value: f64) -> Option<f64> {
        self.y.place(value).map(|place| self.top + (1.0 - place) * self.height)
    }

    fn bottom(&self) -> f64 {
        self.top + self.height
    }

    fn draw_level(&self, svg: &mut Svg, value: f64, style: &str) {
        if let Some(y) = self.y_of(value) {
            svg.polyline(&[(self.left, y), (self.left + self.width, y)], style);
        }
    }

    fn draw_upright(&self, svg: &mut Svg, value: f64, style: &str) {
        if let Some(x) = self.x_of(value) {
            svg.polyline(&[(x, self.top), (x, self.bottom())], style);
        }
    }

    fn draw_grid(&self, svg: &mut Svg) {
        let Look { grid, fine_grid, .. } = self.look;
        self.y.minor.iter().for_each(|value| self.draw_level(svg, *value, fine_grid));
        self.x.minor.iter().for_each(|value| self.draw_upright(svg, *value, fine_grid));
        self.y.major.iter().for_each(|(value, _)| self.draw_level(svg, *value, grid));
        self.x.major.iter().for_each(|(value, _)| self.draw_upright(svg, *value, grid));
    }

    fn draw_labels(&self, svg: &mut Svg, panel: &Panel, is_last: bool) {
        let (small, large) = (self.look.writing(12.0), self.look.writing(13.0));
        self.label_rows(svg, small);
        let upright = Writing { upright: true, ..large };
        let middle = (18.0, self.top + 0.5 * self.height);
        svg.text(middle, Anchor::Middle, upright, &axis_title(&panel.y, self.y.exponent));
        if !is_last {
            return;
        }
        self.label_columns(svg, small);
        let place = (self.left + 0.5 * self.width, self.bottom() + 40.0);
        svg.text(place, Anchor::Middle, large, &axis_title(&panel.x, self.x.exponent));
    }

    /// What tells areas of a figure apart.
    fn id(&self) -> String {
        format!("{:.0} {:.0}", self.left, self.top)
    }

    /// Attributes with which a page finds the values at a place.
    fn described(&self) -> String {
        if !self.look.describes {
            return String::new();
        }
        let axis = |ticks: &Ticks| {
            let logarithmic = u8::from(ticks.scale == Scale::Logarithmic);
            format!("{:e} {:e} {logarithmic}", ticks.low, ticks.high)
        };
        let place = [self.left, self.top, self.width, self.height].map(|side| format!("{side:.2}"));
        format!(
            " data-of=\"{}\" data-area=\"{}\" data-x=\"{}\" data-y=\"{}\"",
            self.id(),
            place.join(" "),
            axis(self.x),
            axis(self.y)
        )
    }

    /// The numbers beside the vertical axis.
    pub(crate) fn label_rows(&self, svg: &mut Svg, writing: Writing) {
        for (value, label) in &self.y.major {
            if let Some(y) = self.y_of(*value) {
                svg.text((self.left - 8.0, y + 4.2), Anchor::End, writing, label);
            }
        }
    }

    /// The numbers below the horizontal axis.
    pub(crate) fn label_columns(&self, svg: &mut Svg, writing: Writing) {
        for (value, label) in &self.x.major {
            if let Some(x) = self.x_of(*value) {
                svg.text((x, self.bottom() + 18.0), Anchor::Middle, writing, label);
            }
        }
    }

    fn draw_series(&self, svg: &mut Svg, series: &Series) {
        let look = self.look;
        let places = series.x.iter().zip(&series.y);
        let places: Vec<Option<(f64, f64)>> =
            places.map(|(x, y)| self.x_of(*x).zip(self.y_of(*y))).collect();
        let shown = || places.iter().copied().flatten();
        match series.mark {
            Mark::Line | Mark::Thin | Mark::Dashed => {
                for part in places.split(Option::is_none) {
                    let points: Vec<(f64, f64)> = part.iter().copied().flatten().collect();
                    self.draw_line(svg, &thinned(&points), series);
                }
            }
            Mark::Area => svg.polygon(&shown().collect::<Vec<_>>(), &area(series, look)),
            Mark::Points => shown().for_each(|at| svg.circle(at, 3.4, &open_circle(series, look))),
            Mark::Dots => svg.dots(&distinct(shown()), &cloud(series, look)),
            Mark::Crosses => {
                let path: String = shown().map(cross).collect();
                svg.path(&path, &cross_style(series, look));
            }
            Mark::Stems => self.draw_stems(svg, shown(), series),
        }
    }

    fn draw_stems(&self, svg: &mut Svg, shown: impl Iterator<Item = (f64, f64)>, series: &Series) {
        let zero = self.y_of(0.0).unwrap_or(self.bottom());
        let style = format!("stroke=\"{}\" stroke-width=\"1.2\"", colour(series, self.look));
        for (x, y) in shown {
            svg.polyline(&[(x, zero), (x, y)], &style);
            svg.circle((x, y), 2.6, &dot(series, self.look));
        }
    }

    fn draw_line(&self, svg: &mut Svg, points: &[(f64, f64)], series: &Series) {
        match points {
            [] => {}
            [alone] => svg.circle(*alone, 1.6, &dot(series, self.look)),
            _ => svg.polyline(points, &stroke(series, self.look)),
        }
    }
}

/// One of the points within each half of a pixel.
fn distinct(points: impl Iterator<Item = (f64, f64)>) -> Vec<(f64, f64)> {
    let mut seen = HashSet::new();
    let half = |value: f64| (2.0 * value).round() as i64;
    points.filter(|(x, y)| seen.insert((half(*x), half(*y)))).collect()
}

/// The points that are visibly distinct: of those within half a pixel the first, the lowest, the
/// highest and the last.
fn thinned(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let mut kept = Vec::new();
    for group in points.chunk_by(|a, b| (2.0 * a.0).floor() == (2.0 * b.0).floor()) {
        let places = 0..group.len();
        let low = places.clone().min_by(|i, j| group[*i].1.total_cmp(&group[*j].1));
        let high = places.max_by(|i, j| group[*i].1.total_cmp(&group[*j].1));
        let mut chosen = vec![0, group.len() - 1];
        chosen.extend(low.into_iter().chain(high));
        chosen.sort_unstable();
        chosen.dedup();
        kept.extend(chosen.into_iter().map(|i| group[i]));
    }
    kept
}

/// A power of ten as it is read: `10⁻³` for −3.
pub fn power(exponent: i32) -> String {
    raised(&power_of_ten(exponent))
}

/// A unit of Modelica as it is read: `A/cm²` for `A/cm2`, `Ω` for `Ohm`, nothing for `1`.
pub fn shown_unit(unit: &str) -> String {
    raised(&marked_unit(unit))
}

/// Units that take a prefix of the SI where a power of ten would stand before them. Of seconds only
/// parts are usual.
const WITH_PREFIX: [&str; 15] =
    ["V", "A", "W", "J", "Pa", "N", "Ohm", "F", "H", "Hz", "S", "K", "m", "mol", "s"];
/// Prefixes of the SI by their power of ten.
const PREFIXES: [(i32, &str); 8] =
    [(-12, "p"), (-9, "n"), (-6, "µ"), (-3, "m"), (3, "k"), (6, "M"), (9, "G"), (12, "T")];

/// A unit with the prefix of a power of ten, `mV` for `V` and −3; `None` where none is usual.
pub fn prefixed(unit: &str, exponent: i32) -> Option<String> {
    let end = unit.find(|c: char| !c.is_alphabetic()).unwrap_or(unit.len());
    let (symbol, rest) = unit.split_at(end);
    let (_, prefix) = PREFIXES.into_iter().find(|(power, _)| *power == exponent)?;
    let is_usual = WITH_PREFIX.contains(&symbol)
        && !rest.starts_with(|c: char| c.is_ascii_digit() || c == '-')
        && !(symbol == "s" && exponent > 0);
    is_usual.then(|| format!("{prefix}{unit}"))
}

/// A unit of Modelica (MLS chapter 19), its products as dots and its exponents marked `^{…}`.
fn marked_unit(unit: &str) -> String {
    if unit == "1" {
        return String::new();
    }
    let mut out = String::new();
    let is_exponent = |c: char| c.is_ascii_digit() || c == '-' || c == '+';
    let mut rest = unit;
    while let Some(letter) = rest.chars().next() {
        rest = &rest[letter.len_utf8()..];
        out.push(if letter == '.' { '\u{b7}' } else { letter });
        let end = rest.find(|c| !is_exponent(c)).unwrap_or(rest.len());
        if letter.is_alphabetic() && end > 0 {
            out += &format!("^{{{}}}", rest[..end].replace('-', "\u{2212}"));
            rest = &rest[end..];
        }
    }
    out.replace("Ohm", "Ω").replace("degC", "°C")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_show_exponents_and_products() {
        assert_eq!(marked_unit("A/cm2"), "A/cm^{2}");
        assert_eq!(marked_unit("kg.m.s-2"), "kg·m·s^{−2}");
        assert_eq!(marked_unit("1"), "");
        assert_eq!(marked_unit("mOhm.cm2"), "mΩ·cm^{2}");
        assert_eq!(marked_unit("W/degC"), "W/°C");
    }

    #[test]
    fn powers_of_ten_are_prefixes_where_engineers_write_them() {
        let title = |unit: &str, exponent| axis_title(&Axis::linear("q", unit), exponent);
        assert_eq!(title("V", -6), "q (µV)");
        assert_eq!(title("Ohm.cm2", -3), "q (mΩ·cm^{2})");
        assert_eq!(title("J/K", 6), "q (MJ/K)");
        assert_eq!(title("s", 3), "q (10^{3}\u{a0}s)");
        assert_eq!(title("m2", -3), "q (10^{−3}\u{a0}m^{2})");
        assert_eq!(title("1", -3), "q (10^{−3})");
        assert_eq!(title("V", 0), "q (V)");
    }

    #[test]
    fn thinning_keeps_the_extremes() {
        let points = [(0.1, 1.0), (0.2, 5.0), (0.3, -2.0), (0.4, 3.0), (0.4, 2.0), (0.6, 0.0)];
        let kept = [(0.1, 1.0), (0.2, 5.0), (0.3, -2.0), (0.4, 2.0), (0.6, 0.0)];
        assert_eq!(thinned(&points), kept);
    }
}
