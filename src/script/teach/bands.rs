//! A run and changed ones, each repeated with many seeds: one run alone says little about a setting,
//! since the scatter between seeds is often larger than the effect.

use super::explain::short;
use super::trace::Trace;
use crate::ga::has_failed;
use crate::plot::{Axis, Figure, Mark, Panel, Series};
use std::fmt::Write as _;

/// The best fitness of each generation of one run; NaN where all individuals failed.
pub type Curve = Vec<f64>;

/// The repetitions of one setting.
#[derive(Debug, Clone)]
pub struct Repeated {
    /// The change, as it was given; or that it is the script as it is.
    pub name: String,
    /// One curve for each seed, in the same order for all settings.
    pub curves: Vec<Curve>,
}

/// The best fitness of each generation of a trace.
pub fn curve(trace: &Trace) -> Curve {
    let best = trace.generations.iter().map(|generation| generation.best());
    let best = best.map(|best| best.map(|(_, fitness)| fitness).filter(|f| !has_failed(*f)));
    best.map(|best| best.unwrap_or(f64::NAN)).collect()
}

/// The quantile `q` of numbers, interpolated; NaN of none.
fn quantile(mut values: Vec<f64>, q: f64) -> f64 {
    values.retain(|value| !value.is_nan());
    values.sort_by(f64::total_cmp);
    let place = q * values.len().saturating_sub(1) as f64;
    let (low, high) = (place.floor() as usize, place.ceil() as usize);
    match (values.get(low), values.get(high)) {
        (Some(a), Some(b)) => a + (b - a) * (place - place.floor()),
        _ => f64::NAN,
    }
}

impl Repeated {
    /// The quantile `q` over the runs, generation by generation.
    fn quantiles(&self, q: f64) -> Vec<f64> {
        let longest = self.curves.iter().map(Vec::len).max().unwrap_or(0);
        let at = |k: usize| self.curves.iter().filter_map(|curve| curve.get(k)).copied().collect();
        (0..longest).map(|k| quantile(at(k), q)).collect()
    }

    /// Quartiles of the last fitness of the runs.
    fn endings(&self) -> [f64; 3] {
        let last = || self.curves.iter().filter_map(|curve| curve.last()).copied().collect();
        [0.25, 0.5, 0.75].map(|q| quantile(last(), q))
    }

    /// In how many of the runs the end is better than that of `other` with the same seed.
    fn better_than(&self, other: &Repeated) -> usize {
        let pairs = self.curves.iter().zip(&other.curves);
        pairs.filter(|(own, other)| own.last() < other.last()).count()
    }

    /// The interquartile range of the runs as an area, and their median as a line.
    fn series(&self, colour: usize) -> [Series; 2] {
        let points = |values: Vec<f64>| {
            let numbered = values.into_iter().enumerate().map(|(k, y)| (k as f64 + 1.0, y));
            numbered.filter(|(_, y)| y.is_finite()).collect::<Vec<_>>()
        };
        let mut edge = points(self.quantiles(0.25));
        edge.extend(points(self.quantiles(0.75)).into_iter().rev());
        let series = |name: String, points: Vec<(f64, f64)>, mark| {
            let (x, y) = points.into_iter().unzip();
            Series { name, x, y, mark, colour }
        };
        let median = points(self.quantiles(0.5));
        [series(String::new(), edge, Mark::Area), series(self.name.clone(), median, Mark::Line)]
    }
}

/// The medians over the generations, with their interquartile range as bands.
pub fn figure(settings: &[Repeated]) -> Figure {
    let runs = settings.first().map_or(0, |first| first.curves.len());
    Figure {
        title: format!("median of {runs} runs, and their interquartile range"),
        panels: vec![Panel {
            x: Axis::linear("generation", ""),
            y: Axis::logarithmic("best fitness (smaller is better)", ""),
            height: 330.0,
            zero_line: false,
            series: settings.iter().enumerate().flat_map(|(k, s)| s.series(k + 1)).collect(),
        }],
    }
}

/// The medians alone, for a figure of characters, where areas cannot be distinguished from lines.
pub fn medians(settings: &[Repeated]) -> Figure {
    let mut figure = figure(settings);
    figure.panels.iter_mut().for_each(|panel| panel.series.retain(|s| s.mark == Mark::Line));
    figure
}

/// How the runs end, in words and numbers.
pub fn summary(settings: &[Repeated]) -> String {
    let Some(original) = settings.first() else { return String::new() };
    let runs = original.curves.len();
    let width = settings.iter().map(|s| s.name.chars().count()).max().unwrap_or(0);
    let mut text = format!(
        "The best fitness at the end of {runs} runs with different seeds\n  {:width$}  {:>9}  {:>22}  \
         {}\n",
        "", "median", "interquartile range", "better than original"
    );
    for setting in settings {
        let [low, median, high] = setting.endings().map(short);
        let better = match std::ptr::eq(setting, original) {
            true => String::new(),
            false => format!("{} of {runs}", setting.better_than(original)),
        };
        let line = format!(
            "  {:width$}  {median:>9}  {:>22}  {better}",
            setting.name,
            format!("{low} to {high}")
        );
        let _ = writeln!(text, "{}", line.trim_end());
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn repeated(name: &str, ends: &[f64]) -> Repeated {
        let curves = ends.iter().map(|&end| vec![10.0, end]).collect();
        Repeated { name: name.to_owned(), curves }
    }

    #[test]
    fn quantiles_are_those_of_the_textbook() {
        let values = vec![4.0, 1.0, 3.0, 2.0, f64::NAN];
        assert_eq!(
            [0.0, 0.25, 0.5, 1.0].map(|q| quantile(values.clone(), q)),
            [1.0, 1.75, 2.5, 4.0]
        );
        assert!(quantile(Vec::new(), 0.5).is_nan());
    }

    #[test]
    fn runs_with_the_same_seed_are_compared() {
        let settings =
            [repeated("original", &[1.0, 2.0, 3.0]), repeated("F_Mut := 1", &[2.0, 1.0, 4.0])];
        let text = summary(&settings);
        assert!(text.contains("original        2.000"), "{text}");
        assert!(text.contains("1.500 to 3.000  1 of 3"), "{text}");
        let series = &figure(&settings).panels[0].series;
        assert_eq!(series.len(), 4);
        assert_eq!(series[0].y, [10.0, 1.5, 2.5, 10.0]);
        assert_eq!(series[3].y, [10.0, 2.0]);
    }
}
