//! Spectra in the plane of complex numbers (Nyquist plots).

use super::SolvedSeries;
use crate::plot::{Axis, Figure, Mark, Series, of_points};
use crate::spectrum::{FREQUENCY, PARTS};

/// A picture for each experiment of which real and imaginary parts were measured, with its name. The
/// imaginary part goes downwards, as is usual for impedances.
pub(crate) fn planes(all: &[SolvedSeries]) -> Vec<(&str, Figure)> {
    let is_part =
        |series: &SolvedSeries, name: &str| series.x[0] == FREQUENCY && series.y[0] == name;
    let ordered = all.windows(2).filter_map(|pair| match pair {
        [a, b] if is_part(a, PARTS[0]) && is_part(b, PARTS[1]) => Some((a, b)),
        [a, b] if is_part(a, PARTS[1]) && is_part(b, PARTS[0]) => Some((b, a)),
        _ => None,
    });
    let of_one = ordered.filter(|(a, b)| a.experiment == b.experiment);
    of_one.map(|(real, imaginary)| (real.experiment.as_str(), plane(real, imaginary))).collect()
}

fn plane(real: &SolvedSeries, imaginary: &SolvedSeries) -> Figure {
    let series = |name: &str, [re, im]: [Vec<[f64; 2]>; 2], mark, colour| {
        // By the frequency: a point may lack one of its parts.
        let mut points: Vec<(f64, f64, f64)> = Vec::new();
        for [x, re] in &re {
            let other = im.iter().find(|[own, _]| own == x);
            points.extend(other.map(|[_, im]| (*x, *re, -im)));
        }
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        Series {
            name: name.to_owned(),
            x: points.iter().map(|point| point.1).collect(),
            y: points.iter().map(|point| point.2).collect(),
            mark,
            colour,
        }
    };
    let measured =
        [real, imaginary].map(|own| own.points.iter().map(|point| [point[0], point[1]]).collect());
    let simulated = [real, imaginary].map(|own| own.curve.clone());
    let [x, y] = [("real part", real), ("\u{2212}imaginary part", imaginary)]
        .map(|(label, own)| Axis::linear(label, &own.y[1]));
    let all = vec![
        series("simulated", simulated, Mark::Line, 1),
        series("measured", measured, of_points(real.points.len()), 0),
    ];
    Figure::plane(x, y, all)
}
