//! A run as it is now: data for drawing it during the run.

use crate::identify::SearchRecord;
use crate::plot::Axis;

/// How far a long piece of work is: data for drawing it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Progress {
    /// What is being done, such as `generation`.
    pub label: String,
    /// Units done.
    pub done: u64,
    /// Units in all; 0 where not known.
    pub total: u64,
    /// The best value so far, smaller is better.
    pub best: Option<f64>,
    /// What failed so far.
    pub failures: u64,
    /// Why most of them failed, and how many for this reason; where it is known.
    pub main_cause: Option<(String, u64)>,
}

/// What there is to see of a run.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct View {
    /// The heading.
    pub title: String,
    /// How far it is.
    pub progress: Progress,
    /// The best fitness after each generation.
    pub best: Vec<f64>,
    /// Where the individuals of the last generation lie, parameter by parameter.
    pub spreads: Vec<Spread>,
    /// Measured series beside the simulation of the best individual.
    pub fitted: Vec<Fitted>,
}

/// Where a generation lies in the search range of one parameter.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Spread {
    /// The parameter.
    pub name: String,
    /// Its unit; empty where there is none.
    pub unit: String,
    /// Its best value so far.
    pub value: f64,
    /// Where that lies, as a fraction of the range.
    pub best: f64,
    /// The smallest, the middle and the largest of the generation, as fractions of the range.
    pub generation: [f64; 3],
}

/// A measured series and its simulation.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Fitted {
    /// What was measured, with its unit, as an axis is called.
    pub y_title: String,
    /// What it is given over, in the same way.
    pub x_title: String,
    /// X of the points.
    pub x: Vec<f64>,
    /// Measured Y.
    pub measured: Vec<f64>,
    /// Simulated Y; empty while nothing was simulated successfully.
    pub simulated: Vec<f64>,
}

/// What of a search is drawn beside its record.
pub(super) struct Drawn {
    pub title: String,
    pub spreads: Vec<Spread>,
    pub fitted: Vec<Fitted>,
}

impl Progress {
    /// That of a search: so many units of what it counts, and of as many.
    pub(super) fn of(record: &SearchRecord, label: &str, [done, total]: [u64; 2]) -> Progress {
        Progress {
            label: label.to_owned(),
            done,
            total,
            best: record.best.as_ref().map(|best| best.fitness),
            failures: record.failures.count,
            main_cause: record
                .failures
                .main_cause()
                .map(|(cause, count)| (cause.to_owned(), count)),
        }
    }
}

impl View {
    /// That of a search.
    pub(super) fn of(progress: Progress, record: &SearchRecord, drawn: Drawn) -> View {
        let Drawn { title, spreads, fitted } = drawn;
        let best = record.history.generations.iter().map(|generation| generation.best).collect();
        View { title, progress, best, spreads, fitted }
    }
}

impl Spread {
    /// A parameter with its best value, where that lies in its range, and where the individuals of the
    /// last generation lie; `None` where there are none.
    pub(super) fn of(
        (name, unit): (&str, &str),
        (value, best): (f64, f64),
        mut fractions: Vec<f64>,
    ) -> Option<Spread> {
        fractions.sort_by(f64::total_cmp);
        let (first, last) = (*fractions.first()?, *fractions.last()?);
        let generation = [first, fractions[fractions.len() / 2], last];
        Some(Spread { name: name.to_owned(), unit: unit.to_owned(), value, best, generation })
    }
}

impl Fitted {
    /// A series of y over x.
    pub(super) fn of([y, x]: [&Axis; 2], [points, measured, simulated]: [&[f64]; 3]) -> Fitted {
        Fitted {
            y_title: y.title(),
            x_title: x.title(),
            x: points.to_vec(),
            measured: measured.to_vec(),
            simulated: simulated.to_vec(),
        }
    }
}
