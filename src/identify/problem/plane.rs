//! Pictures of spectra: in the plane of complex numbers (Nyquist plots), and magnitude, phase and residuals
//! over the frequency (Bode plots).

use super::{SolvedSeries, SpectrumBand};
use crate::elementary;
use crate::plot::{Axis, Figure, Mark, Panel, Series, of_points};
use crate::spectrum::{FREQUENCY, PARTS};
use std::f64::consts::PI;

/// The pictures of a measured spectrum.
pub(crate) struct SpectrumFigures<'a> {
    /// The experiment.
    pub name: &'a str,
    /// The imaginary part goes downwards, as is usual for impedances.
    pub plane: Figure,
    pub bode: Figure,
}

/// Frequency, real and imaginary part.
type Point = [f64; 3];
/// What of a point is drawn along each axis.
type Coordinates = (fn(&Point) -> f64, fn(&Point) -> f64);

/// Pictures for each experiment of which real and imaginary parts were measured, with its band if it has one.
pub(crate) fn planes<'s>(
    all: &'s [SolvedSeries],
    bands: &[SpectrumBand],
) -> Vec<SpectrumFigures<'s>> {
    let of = |name: &str| bands.iter().find(|band| band.experiment == name);
    let is_part =
        |series: &SolvedSeries, name: &str| series.x[0] == FREQUENCY && series.y[0] == name;
    let ordered = all.windows(2).filter_map(|pair| match pair {
        [a, b] if is_part(a, PARTS[0]) && is_part(b, PARTS[1]) => Some((a, b)),
        [a, b] if is_part(a, PARTS[1]) && is_part(b, PARTS[0]) => Some((b, a)),
        _ => None,
    });
    let of_one = ordered.filter(|(a, b)| a.experiment == b.experiment);
    let figures = of_one.map(|(real, imaginary)| SpectrumFigures {
        name: real.experiment.as_str(),
        plane: plane(real, imaginary),
        bode: bode(real, imaginary, of(&real.experiment)),
    });
    figures.collect()
}

/// The points of both parts by the frequency: one may lack one of them.
fn joined([re, im]: [Vec<[f64; 2]>; 2]) -> Vec<Point> {
    let mut points: Vec<Point> = Vec::new();
    for [x, re] in re {
        let other = im.iter().find(|[own, _]| *own == x);
        points.extend(other.map(|[_, im]| [x, re, *im]));
    }
    points.sort_by(|a, b| a[0].total_cmp(&b[0]));
    points
}

/// The measured points, the simulated ones and the simulated curve.
fn curves(parts: [&SolvedSeries; 2]) -> [Vec<Point>; 3] {
    let column = |at: usize| {
        joined(parts.map(|own| own.points.iter().map(|point| [point[0], point[at]]).collect()))
    };
    [column(1), column(2), joined(parts.map(|own| own.curve.clone()))]
}

fn series(
    name: &str,
    points: &[Point],
    (x, y): Coordinates,
    (mark, colour): (Mark, usize),
) -> Series {
    Series {
        name: name.to_owned(),
        x: points.iter().map(x).collect(),
        y: points.iter().map(y).collect(),
        mark,
        colour,
    }
}

fn plane(real: &SolvedSeries, imaginary: &SolvedSeries) -> Figure {
    let [measured, _, simulated] = curves([real, imaginary]);
    let [x, y] = [("real part", real), ("\u{2212}imaginary part", imaginary)]
        .map(|(label, own)| Axis::linear(label, &own.y[1]));
    let parts: Coordinates = (|own| own[1], |own| -own[2]);
    let dots = of_points(real.points.len());
    let all = vec![
        series("simulated", &simulated, parts, (Mark::Line, 1)),
        series("measured", &measured, parts, (dots, 0)),
    ];
    Figure::plane(x, y, all)
}

fn magnitude(point: &Point) -> f64 {
    elementary::hypot(point[1], point[2])
}

/// Angles in degrees, without jumps from one frequency to the next.
fn phases(points: &[Point]) -> Vec<f64> {
    let mut all: Vec<f64> = Vec::with_capacity(points.len());
    for [_, re, im] in points {
        let phase = elementary::atan2(*im, *re) * 180.0 / PI;
        let rounds = all.last().map_or(0.0, |last| ((last - phase) / 360.0).round());
        all.push(phase + 360.0 * rounds);
    }
    all
}

/// The areas of a band about magnitude and phase.
fn areas(band: &SpectrumBand) -> [Vec<Series>; 2] {
    let points: Vec<Point> = band.points.iter().map(|[x, re, im, ..]| [*x, *re, *im]).collect();
    let values = points.iter().map(magnitude).zip(phases(&points));
    // The frequency, magnitude and phase, and their half-widths.
    let at = band.points.iter().zip(values);
    let at: Vec<[f64; 5]> = at
        .map(|([x, .., of_size, of_phase], (size, phase))| [*x, size, phase, *of_size, *of_phase])
        .collect();
    let area = |name: &str, edge: fn(&[f64; 5], f64) -> f64| {
        let upper = at.iter().map(|own| (own[0], edge(own, 1.0)));
        let lower = at.iter().rev().map(|own| (own[0], edge(own, -1.0)));
        let (x, y) = upper.chain(lower).unzip();
        vec![Series { name: name.to_owned(), x, y, mark: Mark::Area, colour: 1 }]
    };
    [
        area("95 % confidence band", |own, side| own[1] * elementary::exp(side * own[3])),
        area("", |own, side| side.mul_add(own[4], own[2])),
    ]
}

fn bode(real: &SolvedSeries, imaginary: &SolvedSeries, band: Option<&SpectrumBand>) -> Figure {
    let [measured, at_points, simulated] = curves([real, imaginary]);
    let dots = (of_points(real.points.len()), 0);
    let over = |points: &[Point], y: Vec<f64>, (mark, colour)| Series {
        y,
        ..series("", points, (|own| own[0], |own| own[0]), (mark, colour))
    };
    let of_magnitude: Coordinates = (|own| own[0], magnitude);
    let [mut magnitudes, mut turned] = band.map_or_else(Default::default, areas);
    magnitudes.extend([
        series("simulated", &simulated, of_magnitude, (Mark::Line, 1)),
        series("measured", &measured, of_magnitude, dots),
    ]);
    turned.extend([
        over(&simulated, phases(&simulated), (Mark::Line, 1)),
        over(&measured, phases(&measured), dots),
    ]);
    // In per cent of the magnitude, by the parts.
    let left = |part: usize| {
        let pairs = measured.iter().zip(&at_points);
        pairs
            .map(|(own, simulated)| 100.0 * (own[part] - simulated[part]) / magnitude(own))
            .collect()
    };
    let named = |name: &str, own: Series| Series { name: name.to_owned(), ..own };
    let residuals = vec![
        named("real part", over(&measured, left(1), (Mark::Dots, 0))),
        named("imaginary part", over(&measured, left(2), (Mark::Dots, 2))),
    ];
    let panel = |y, height, zero_line, series| Panel {
        x: Axis::logarithmic("frequency", "Hz"),
        y,
        height,
        zero_line,
        series,
    };
    Figure {
        title: String::new(),
        panels: vec![
            panel(Axis::logarithmic("magnitude", &real.y[1]), 160.0, false, magnitudes),
            panel(Axis::linear("phase", "deg"), 130.0, false, turned),
            panel(Axis::linear("residual", "%"), 100.0, true, residuals),
        ],
    }
}
