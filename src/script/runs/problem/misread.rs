//! Columns read otherwise, where the report says that data may be read wrongly: times in another unit,
//! columns with another sign or a factor of a thousand, each with a short fit.

use super::file::{Column, ColumnEntry, ExperimentEntry, ProblemFile, SegmentsEntry};
use super::inputs::Undecided;
use super::interpolation;
use super::searches::{Again, Change};
use crate::Session;
use crate::diag::Fault;
use crate::identify::problem::{Finding, FindingKind, Reading, Run, Solution, short_fit};

/// Times in minutes, hours and milliseconds that are read as seconds, and a model that counts in minutes
/// or hours.
const TIMES: [(f64, &str); 5] = [
    (60.0, "multiplied by 60, as if they were in minutes"),
    (3600.0, "multiplied by 3600, as if they were in hours"),
    (1e-3, "multiplied by 0.001, as if they were in milliseconds"),
    (1.0 / 60.0, "divided by 60, as if the model counted in minutes"),
    (1.0 / 3600.0, "divided by 3600, as if the model counted in hours"),
];
/// The other sign, kilo and milli.
const COLUMNS: [f64; 3] = [-1.0, 1e3, 1e-3];
/// Evaluations of each fit, at least and at most: 40 starts, of which some descend. Within these, all
/// fits together take as many as the search has taken.
const EVALUATIONS: [u64; 2] = [60, 200];
/// Steps of each simulation, and those for each row: an hour read as 150 days is given up.
const STEPS: u64 = 10_000;
const STEPS_PER_ROW: u64 = 20;

/// What the data of a problem may mean otherwise.
pub(super) struct Doubts {
    /// Inputs of which it is not known how they continue between samples.
    pub undecided: Vec<Undecided>,
    /// Columns that may be read otherwise.
    pub readings: Vec<Changed>,
}

impl Doubts {
    /// Fits the data with other meanings, where these may explain more.
    ///
    /// # Errors
    ///
    /// Those of the problems that are made again, and of their simulators.
    pub(super) fn settle(
        &self,
        session: &mut Session,
        (run, solution): (&mut Run, &mut Solution),
        again: &mut Again<'_>,
    ) -> Result<(), Fault> {
        interpolation::try_others(session, (run, solution), &self.undecided, again)?;
        run.evaluation.show_by(session.world.status());
        let tried = try_readings(session, (run, solution), &self.readings, again);
        run.evaluation.show("");
        run.evaluation.show_by(None);
        tried
    }
}

/// A column that is read otherwise in all experiments.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Changed {
    role: Role,
    /// The variable, and its column in the first experiment that has it.
    variable: String,
    column: String,
    factor: f64,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Role {
    X,
    Input,
    Output,
}

/// What may be read otherwise in these experiments.
pub(super) fn all(experiments: &[ExperimentEntry]) -> Vec<Changed> {
    let mut all: Vec<Changed> = Vec::new();
    let mut add = |role: Role, variable: &str, column: &ColumnEntry, factors: &[f64]| {
        let is_known = |own: &Changed| own.role == role && own.variable == variable;
        if all.iter().any(is_known) {
            return;
        }
        let column = column.column.clone().unwrap_or_else(|| variable.to_owned());
        let variable = variable.to_owned();
        let one = |factor: &f64| Changed {
            role,
            variable: variable.clone(),
            column: column.clone(),
            factor: *factor,
        };
        all.extend(factors.iter().map(one));
    };
    for experiment in experiments {
        let x = experiment.x.as_ref().map_or_else(|| ColumnEntry::named(None), Column::entry);
        match x.variable.as_deref().or(x.column.as_deref()).unwrap_or("time") {
            "time" if has_other_times(experiment) => {}
            "time" => add(Role::X, "time", &x, &TIMES.map(|(factor, _)| factor)),
            name => add(Role::X, name, &x, &COLUMNS),
        }
        for (name, column) in &experiment.inputs {
            add(Role::Input, name, &column.entry(), &COLUMNS);
        }
        for (name, column) in experiment.all_outputs() {
            add(Role::Output, name, &column, &COLUMNS);
        }
    }
    all
}

/// Whether an experiment has times beside those of its X.
fn has_other_times(experiment: &ExperimentEntry) -> bool {
    let has_cuts = matches!(experiment.segments, Some(SegmentsEntry::Times(_)));
    experiment.input_time.is_some() || experiment.start_time.is_some() || has_cuts
}

impl Changed {
    fn apply(&self, file: &mut ProblemFile, most_steps: u64) {
        for experiment in &mut file.experiment {
            experiment.max_steps.get_or_insert(most_steps);
            let column = match self.role {
                Role::X => Some(
                    experiment
                        .x
                        .get_or_insert_with(|| Column::More(Box::new(ColumnEntry::named(None)))),
                ),
                Role::Input => experiment.inputs.get_mut(&self.variable),
                Role::Output => experiment.outputs.get_mut(&self.variable),
            };
            if let Some(column) = column {
                column.change(|entry| entry.tried = Some(self.factor));
            }
        }
    }

    fn words(&self) -> String {
        let Changed { variable, column, factor, .. } = self;
        let what = match self.role {
            Role::X if variable == "time" => {
                let how = TIMES.iter().find(|own| own.0 == *factor).map_or("", |own| own.1);
                return format!("the times `{column}` {how}");
            }
            Role::X => "X",
            Role::Input => "input",
            Role::Output => "output",
        };
        match *factor == -1.0 {
            true => format!("the other sign of the column `{column}` ({what} `{variable}`)"),
            false => format!("the column `{column}` ({what} `{variable}`) multiplied by {factor}"),
        }
    }
}

/// Fits columns that are read otherwise, where they may be read wrongly.
///
/// # Errors
///
/// Those of the simulators' maker.
fn try_readings(
    session: &mut Session,
    (run, solution): (&Run, &mut Solution),
    changes: &[Changed],
    again: &mut Again<'_>,
) -> Result<(), Fault> {
    if !solution.is_doubtful() || session.world.interrupted() {
        return Ok(());
    }
    let [fewest, most] = EVALUATIONS;
    let each = solution.effort.evaluations / changes.len().max(1) as u64;
    let rows = solution.series.iter().map(|series| series.points.len() as u64).max();
    let most_steps = STEPS + STEPS_PER_ROW * rows.unwrap_or(0);
    let estimate: Vec<f64> = solution.parameters.iter().map(|own| own.value).collect();
    let mut readings = Vec::new();
    run.evaluation.show("columns read otherwise");
    for changed in changes {
        let change = |file: &mut ProblemFile| changed.apply(file, most_steps);
        // A column that cannot be read so is no explanation.
        let Ok(other) = again(session, Change::Entries(&change)) else { continue };
        let processors = session.world.processors();
        let flag = session.world.interrupt_flag();
        let about = (each.clamp(fewest, most), &estimate[..]);
        let (r_squared, simulations) = short_fit(other.problem, about, &processors, flag)?;
        solution.effort.simulations_for_statistics += simulations;
        if session.world.interrupted() {
            let sentence =
                "Not all other readings of the columns were tried: the run was stopped before.";
            solution.findings.push(Finding::new(FindingKind::Missing, sentence));
            break;
        }
        readings.push(Reading { words: changed.words(), r_squared });
    }
    solution.add_readings(&readings);
    Ok(())
}
