//! Two runs that are the same up to a generation, side by side.

use super::explain::short;
use super::trace::Trace;
use crate::ga::has_failed;
use crate::plot::{Axis, Figure, Mark, Panel, Series};

/// A run, and the same run with something changed from a generation on.
#[derive(Debug, Clone)]
pub struct Branches<'a> {
    /// The run as the script has it.
    pub original: &'a Trace,
    /// The run with the change.
    pub changed: &'a Trace,
    /// The generation of the change, from 1.
    pub generation: usize,
    /// The change, as it was given.
    pub change: &'a str,
}

impl Branches<'_> {
    /// The fitness of the best individual over the generations, of both.
    pub fn figure(&self) -> Figure {
        let series = |name: String, trace: &Trace, colour| Series {
            name,
            x: (1..=trace.generations.len()).map(|number| number as f64).collect(),
            y: best(trace).iter().map(|best| best.unwrap_or(f64::NAN)).collect(),
            mark: Mark::Line,
            colour,
        };
        Figure {
            title: format!("{} from generation {}", self.change, self.generation),
            panels: vec![Panel {
                x: Axis::linear("generation", ""),
                y: Axis::logarithmic("best fitness (smaller is better)", ""),
                height: 330.0,
                zero_line: false,
                series: vec![
                    series("original script".to_owned(), self.original, 1),
                    series(self.change.to_owned(), self.changed, 2),
                ],
            }],
        }
    }

    /// Generation, from 1, and best fitness, where there is one, of the run and the changed one.
    pub fn curves(&self) -> [Vec<(f64, f64)>; 2] {
        let points = |trace: &Trace| {
            let numbered = best(trace).into_iter().enumerate();
            numbered.filter_map(|(k, fitness)| Some((k as f64 + 1.0, fitness?))).collect()
        };
        [points(self.original), points(self.changed)]
    }

    /// What came of it, in words and numbers.
    pub fn summary(&self) -> String {
        let (original, changed) = (best(self.original), best(self.changed));
        let mut text = format!("What if {} from generation {}?\n", self.change, self.generation);
        text.push_str("  generation   original script   changed\n");
        let last = original.len().max(changed.len());
        for number in shown(self.generation, last) {
            let of = |fitness: &[Option<f64>]| match fitness.get(number - 1) {
                Some(Some(fitness)) => short(*fitness),
                Some(None) => "all failed".to_owned(),
                None => "(ended)".to_owned(),
            };
            text.push_str(&format!(
                "  {number:>10}   {:>20}   {:>7}\n",
                of(&original),
                of(&changed)
            ));
        }
        text.push_str(&self.verdict());
        text
    }

    /// Which of them is better at the end.
    pub fn verdict(&self) -> String {
        verdict(end(&best(self.original)), end(&best(self.changed)))
    }
}

/// The best fitness of each generation, if one of its individuals has one.
fn best(trace: &Trace) -> Vec<Option<f64>> {
    let best = trace.generations.iter().map(|generation| generation.best());
    best.map(|best| best.map(|(_, fitness)| fitness).filter(|fitness| !has_failed(*fitness)))
        .collect()
}

/// The best fitness of the last generation that was rated.
fn end(fitness: &[Option<f64>]) -> Option<f64> {
    fitness.iter().rev().find_map(|fitness| *fitness)
}

/// The generation of the change, some after it in growing distances, and the last.
fn shown(first: usize, last: usize) -> Vec<usize> {
    let distances = [0, 1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000];
    let mut numbers: Vec<usize> = distances.iter().map(|distance| first + distance).collect();
    numbers.retain(|number| *number < last);
    numbers.push(last);
    numbers
}

fn verdict(original: Option<f64>, changed: Option<f64>) -> String {
    match (original, changed) {
        (Some(original), Some(changed)) if changed < original => {
            format!(
                "The changed run ends with a better fitness: {} < {}.",
                short(changed),
                short(original)
            )
        }
        (Some(original), Some(changed)) if changed > original => {
            format!(
                "The changed run ends with a worse fitness: {} > {}.",
                short(changed),
                short(original)
            )
        }
        (Some(_), Some(_)) => "Both runs end with the same best fitness.".to_owned(),
        (None, Some(_)) => "Only the changed run has a result.".to_owned(),
        (Some(_), None) => "Only the original run has a result.".to_owned(),
        (None, None) => "Neither run has a result.".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::teach::sample;

    #[test]
    fn branches_are_compared_where_they_part() {
        let read = |seed| Trace::read(&sample::run(4, seed).bytes).unwrap();
        let (original, changed) = (read(12345.0), read(54321.0));
        let change = "Seed := fill(54321, 6)";
        let branches = Branches { original: &original, changed: &changed, generation: 2, change };
        sample::snapshots().bind(|| insta::assert_snapshot!("branches", branches.summary()));
        let figure = branches.figure();
        let series = &figure.panels[0].series;
        assert_eq!(series.len(), 2);
        assert_eq!(series[0].x, [1.0, 2.0, 3.0, 4.0]);
        assert_ne!(series[0].y, series[1].y);
        let same = Branches { changed: &original, ..branches };
        assert!(same.summary().ends_with("Both runs end with the same best fitness."));
    }

    #[test]
    fn the_generations_shown_begin_at_the_change_and_end_with_the_run() {
        assert_eq!(shown(3, 20), [3, 4, 5, 8, 13, 20]);
        assert_eq!(shown(7, 7), [7]);
    }
}
