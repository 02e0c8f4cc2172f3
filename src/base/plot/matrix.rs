//! Pairs of quantities as a triangular matrix: each column has one horizontal axis, each row one
//! vertical axis, and the diagonal shows something of one quantity alone, over its horizontal axis.

use super::draw::{Area, axis_title};
use super::figure::{Axis, Panel, Series};
use super::look::{LEGEND, Look};
use super::svg::{Anchor, Svg, Writing};
use super::ticks::Ticks;

/// Side of the area for data of a cell.
const SIDE: f64 = 140.0;
const BETWEEN: f64 = 10.0;
const LEFT: f64 = 84.0;
const BELOW: f64 = 52.0;
const EDGE: f64 = 8.0;
/// Ticks of an axis.
const TICKS: usize = 3;

/// Quantities and their pairs.
#[derive(Debug, Clone, PartialEq)]
pub struct Matrix {
    /// The axis of each quantity.
    pub axes: Vec<Axis>,
    /// What is drawn of each quantity alone; its vertical axis has no labels.
    pub diagonal: Vec<Vec<Series>>,
    /// What is drawn of a row's quantity over that of a column before it.
    pub pairs: Vec<Vec<Vec<Series>>>,
}

impl Matrix {
    /// The matrix as an SVG element of a page; `label` is what a screen reader says.
    pub fn inline(&self, label: &str) -> String {
        let n = self.axes.len() as f64;
        let extent = n * SIDE + (n - 1.0).max(0.0) * BETWEEN;
        let mut svg = Svg::of_its_size(LEFT + extent + EDGE, EDGE + extent + BELOW, label);
        let ticks: Vec<Ticks> = (0..self.axes.len()).map(|k| self.ticks(k)).collect();
        for row in 0..self.axes.len() {
            for column in 0..row {
                let series = &self.pairs[row][column];
                self.cell((row, column), (&ticks[column], &ticks[row]), series, &mut svg);
            }
            let alone = &self.diagonal[row];
            let heights = alone.iter().flat_map(|series| series.y.iter().copied());
            let heights = Ticks::new(heights, super::Scale::Linear, TICKS).unlabelled();
            self.cell((row, row), (&ticks[row], &heights), alone, &mut svg);
        }
        svg.finish()
    }

    /// The ticks of a quantity, for all that is drawn over or along it.
    fn ticks(&self, k: usize) -> Ticks {
        let along =
            self.diagonal[k].iter().chain(self.pairs.iter().filter_map(|row| row.get(k)).flatten());
        let along = along.flat_map(|series| series.x.iter().copied());
        let up = self.pairs[k].iter().flatten().flat_map(|series| series.y.iter().copied());
        Ticks::new(along.chain(up), self.axes[k].scale, TICKS)
    }

    fn cell(
        &self,
        (row, column): (usize, usize),
        (x, y): (&Ticks, &Ticks),
        series: &[Series],
        svg: &mut Svg,
    ) {
        let look: &'static Look = &LEGEND;
        let place = |k: usize| k as f64 * (SIDE + BETWEEN);
        let (left, top) = (LEFT + place(column), EDGE + place(row));
        let area = Area { left, top, width: SIDE, height: SIDE, x, y, look };
        let axis = |k: usize| self.axes[k].clone();
        let panel = Panel {
            x: axis(column),
            y: axis(row),
            height: SIDE,
            zero_line: false,
            series: series.to_vec(),
        };
        area.draw_data(svg, &panel);
        let (small, large) = (look.writing(11.0), look.writing(13.0));
        if column == 0 && row > 0 {
            area.label_rows(svg, small);
            let upright = Writing { upright: true, ..large };
            let title = axis_title(&axis(row), y.exponent);
            svg.text((18.0, top + 0.5 * SIDE), Anchor::Middle, upright, &title);
        }
        if row + 1 == self.axes.len() {
            area.label_columns(svg, small);
            let title = axis_title(&axis(column), x.exponent);
            svg.text((left + 0.5 * SIDE, top + SIDE + 38.0), Anchor::Middle, large, &title);
        }
    }
}
