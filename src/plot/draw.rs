//! From a figure to a picture.

use super::figure::{Axis, Figure, Mark, Panel, Scale, Series};
use super::svg::{Anchor, Svg, number, text_width};
use super::ticks::{Ticks, power_of_ten};

/// Okabe and Ito (2008), black first, the two that print darkest next.
const PALETTE: [&str; 8] =
    ["#000000", "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#f0e442"];

const WIDTH: f64 = 640.0;
const RIGHT: f64 = 24.0;
const GAP: f64 = 22.0;
const BELOW: f64 = 52.0;
const INK: &str = "fill=\"#222222\"";
const FRAME: &str = "fill=\"none\" stroke=\"#444444\" stroke-width=\"1\"";
const GRID: &str = "stroke=\"#e2e2e2\" stroke-width=\"0.8\"";
const FINE_GRID: &str = "stroke=\"#f1f1f1\" stroke-width=\"0.8\"";

/// The area for data of one panel.
struct Area<'a> {
    left: f64,
    top: f64,
    width: f64,
    height: f64,
    x: &'a Ticks,
    y: &'a Ticks,
}

impl Figure {
    /// The figure as an SVG document, 640 pixels wide.
    pub fn svg(&self) -> String {
        let y_ticks: Vec<Ticks> = self.panels.iter().map(ticks_of_y).collect();
        let x_scale = self.panels.first().map_or(Scale::Linear, |panel| panel.x.scale);
        let all = self.panels.iter().flat_map(|panel| &panel.series);
        let x_ticks = Ticks::new(all.flat_map(|series| series.x.iter().copied()), x_scale, 8);
        let left = left_margin(&y_ticks);
        let legend = legend_rows(&self.panels, left);
        let title_height = if self.title.is_empty() { 12.0 } else { 38.0 };
        let top = title_height + 22.0 * legend.len() as f64 + 4.0;
        let heights: f64 = self.panels.iter().map(|panel| panel.height).sum();
        let gaps = GAP * self.panels.len().saturating_sub(1) as f64;
        let mut svg = Svg::new(WIDTH, top + heights + gaps + BELOW, &self.title);
        let middle = 0.5 * (left + WIDTH - RIGHT);
        let bold = format!("font-size=\"15\" font-weight=\"bold\" {INK}");
        svg.text((middle, 26.0), Anchor::Middle, &bold, &self.title);
        for (row, entries) in legend.iter().enumerate() {
            draw_legend(&mut svg, entries, left, title_height + 22.0 * row as f64 + 8.0);
        }
        let mut top = top;
        for (place, (panel, y)) in self.panels.iter().zip(&y_ticks).enumerate() {
            let (width, height) = (WIDTH - RIGHT - left, panel.height);
            let area = Area { left, top, width, height, x: &x_ticks, y };
            area.draw(&mut svg, panel, place + 1 == self.panels.len());
            top += panel.height + GAP;
        }
        svg.finish()
    }
}

fn ticks_of_y(panel: &Panel) -> Ticks {
    let values = panel.series.iter().flat_map(|series| series.y.iter().copied());
    let zero = panel.zero_line.then_some(0.0);
    Ticks::new(values.chain(zero), panel.y.scale, (panel.height / 42.0) as usize + 1)
}

fn left_margin(y_ticks: &[Ticks]) -> f64 {
    let labels = y_ticks.iter().flat_map(|ticks| &ticks.major);
    44.0 + labels.map(|(_, label)| text_width(label, 12.0)).fold(12.0, f64::max)
}

/// The named series, in rows that fit the width.
fn legend_rows(panels: &[Panel], left: f64) -> Vec<Vec<&Series>> {
    let mut rows: Vec<Vec<&Series>> = Vec::new();
    let mut used = f64::INFINITY;
    let named = panels.iter().flat_map(|panel| &panel.series).filter(|s| !s.name.is_empty());
    for series in named {
        let width = legend_width(series);
        if used + width > WIDTH - RIGHT - left {
            rows.push(Vec::new());
            used = 0.0;
        }
        used += width;
        rows.last_mut().expect("the first entry starts a row").push(series);
    }
    rows
}

fn legend_width(series: &Series) -> f64 {
    34.0 + text_width(&series.name, 12.5) + 22.0
}

fn draw_legend(svg: &mut Svg, entries: &[&Series], left: f64, y: f64) {
    let mut x = left;
    for series in entries {
        let middle = (x + 13.0, y);
        match series.mark {
            Mark::Line | Mark::Thin => {
                svg.polyline(&[(x, y), (x + 26.0, y)], &stroke(series));
            }
            Mark::Points => svg.circle(middle, 3.4, &open_circle(series)),
            Mark::Stems => svg.circle(middle, 2.6, &dot(series)),
        }
        let style = format!("font-size=\"12.5\" {INK}");
        svg.text((x + 34.0, y + 4.2), Anchor::Start, &style, &series.name);
        x += legend_width(series);
    }
}

fn colour(series: &Series) -> &'static str {
    PALETTE[series.colour % PALETTE.len()]
}

fn stroke(series: &Series) -> String {
    let pen = match series.mark {
        Mark::Thin => "stroke-width=\"0.8\" stroke-opacity=\"0.7\"",
        _ => "stroke-width=\"1.8\"",
    };
    format!("stroke=\"{}\" {pen} stroke-linejoin=\"round\"", colour(series))
}

fn open_circle(series: &Series) -> String {
    format!("fill=\"#ffffff\" stroke=\"{}\" stroke-width=\"1.3\"", colour(series))
}

fn dot(series: &Series) -> String {
    format!("fill=\"{}\"", colour(series))
}

fn axis_title(axis: &Axis, exponent: i32) -> String {
    let power = if exponent == 0 { String::new() } else { power_of_ten(exponent) };
    match (&*power, &*shown_unit(&axis.unit)) {
        ("", "") => axis.label.clone(),
        (power, "") => format!("{} [{power}]", axis.label),
        ("", unit) => format!("{} [{unit}]", axis.label),
        (power, unit) => format!("{} [{power}\u{a0}{unit}]", axis.label),
    }
}

impl Area<'_> {
    fn draw(&self, svg: &mut Svg, panel: &Panel, is_last: bool) {
        self.draw_grid(svg);
        if panel.zero_line {
            self.draw_level(svg, 0.0, "stroke=\"#888888\" stroke-width=\"1\"");
        }
        svg.rectangle([self.left, self.top, self.width, self.height], FRAME);
        for series in &panel.series {
            self.draw_series(svg, series);
        }
        self.draw_labels(svg, panel, is_last);
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
        self.y.minor.iter().for_each(|value| self.draw_level(svg, *value, FINE_GRID));
        self.x.minor.iter().for_each(|value| self.draw_upright(svg, *value, FINE_GRID));
        self.y.major.iter().for_each(|(value, _)| self.draw_level(svg, *value, GRID));
        self.x.major.iter().for_each(|(value, _)| self.draw_upright(svg, *value, GRID));
    }

    fn draw_labels(&self, svg: &mut Svg, panel: &Panel, is_last: bool) {
        let small = format!("font-size=\"12\" {INK}");
        for (value, label) in &self.y.major {
            if let Some(y) = self.y_of(*value) {
                svg.text((self.left - 8.0, y + 4.2), Anchor::End, &small, label);
            }
        }
        let (x, y) = (number(18.0), number(self.top + 0.5 * self.height));
        let turned = format!("font-size=\"13\" {INK} transform=\"rotate(-90 {x} {y})\"");
        let middle = (18.0, self.top + 0.5 * self.height);
        svg.text(middle, Anchor::Middle, &turned, &axis_title(&panel.y, self.y.exponent));
        if !is_last {
            return;
        }
        for (value, label) in &self.x.major {
            if let Some(x) = self.x_of(*value) {
                svg.text((x, self.bottom() + 18.0), Anchor::Middle, &small, label);
            }
        }
        let place = (self.left + 0.5 * self.width, self.bottom() + 40.0);
        let large = format!("font-size=\"13\" {INK}");
        svg.text(place, Anchor::Middle, &large, &axis_title(&panel.x, self.x.exponent));
    }

    fn draw_series(&self, svg: &mut Svg, series: &Series) {
        let places = series.x.iter().zip(&series.y);
        let places: Vec<Option<(f64, f64)>> =
            places.map(|(x, y)| self.x_of(*x).zip(self.y_of(*y))).collect();
        let shown = || places.iter().copied().flatten();
        match series.mark {
            Mark::Line | Mark::Thin => {
                for part in places.split(Option::is_none) {
                    let points: Vec<(f64, f64)> = part.iter().copied().flatten().collect();
                    self.draw_line(svg, &thinned(&points), series);
                }
            }
            Mark::Points => shown().for_each(|at| svg.circle(at, 3.4, &open_circle(series))),
            Mark::Stems => {
                let zero = self.y_of(0.0).unwrap_or(self.bottom());
                let style = format!("stroke=\"{}\" stroke-width=\"1.2\"", colour(series));
                for (x, y) in shown() {
                    svg.polyline(&[(x, zero), (x, y)], &style);
                    svg.circle((x, y), 2.6, &dot(series));
                }
            }
        }
    }

    fn draw_line(&self, svg: &mut Svg, points: &[(f64, f64)], series: &Series) {
        match points {
            [] => {}
            [alone] => svg.circle(*alone, 1.6, &dot(series)),
            _ => svg.polyline(points, &stroke(series)),
        }
    }
}

/// The points that can be told apart: of those within half a pixel the first, the lowest, the
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

/// A unit of Modelica (MLS chapter 19) with its exponents raised and its products as dots.
fn shown_unit(unit: &str) -> String {
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
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_show_exponents_and_products() {
        assert_eq!(shown_unit("A/cm2"), "A/cm^{2}");
        assert_eq!(shown_unit("kg.m.s-2"), "kg·m·s^{−2}");
        assert_eq!(shown_unit("1"), "1");
    }

    #[test]
    fn thinning_keeps_the_extremes() {
        let points = [(0.1, 1.0), (0.2, 5.0), (0.3, -2.0), (0.4, 3.0), (0.4, 2.0), (0.6, 0.0)];
        let kept = [(0.1, 1.0), (0.2, 5.0), (0.3, -2.0), (0.4, 2.0), (0.6, 0.0)];
        assert_eq!(thinned(&points), kept);
    }
}
