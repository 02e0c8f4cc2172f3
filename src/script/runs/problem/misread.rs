//! Columns read otherwise, where the report says that data may be read wrongly: times in another unit,
//! columns with another sign or a factor of a thousand, each with a short fit.

use super::file::{Column, ColumnEntry, ExperimentEntry, ProblemFile, SegmentsEntry};
use super::inputs::Undecided;
use super::interpolation;
use super::noise_test;
use super::rest;
use super::searches::{Again, Change};
use crate::Session;
use crate::diag::Fault;
use crate::identify::problem::{
    Experiment, Finding, FindingKind, Reading, Run, Solution, promises, short_fit,
};

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
/// Evaluations of each fit with two changes.
const OF_A_PAIR: u64 = 20;
/// Points at most at which a change is tried together with those of outputs.
const SAMPLES: usize = 40;
/// With fewer points for each, pairs without an output are not tried: one point says little.
const FEW: u64 = 2;
/// Steps of each simulation, and those for each row: an hour read as 150 days is given up.
const STEPS: u64 = 10_000;
const STEPS_PER_ROW: u64 = 20;

/// What the data of a problem may mean otherwise.
pub(super) struct Doubts {
    /// Inputs of which it is not known how they continue between samples.
    pub undecided: Vec<Undecided>,
    /// Columns that may be read otherwise.
    pub readings: Vec<Changed>,
    /// With process noise what it is compared with.
    pub noise: Option<noise_test::Questions>,
    /// Experiments that are to be at rest when their data begin ([`super::rest`]).
    pub rests: Vec<[Experiment; 2]>,
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
        solution.findings.extend(rest::not_reached(run, &self.rests));
        interpolation::try_others(session, (run, solution), &self.undecided, again)?;
        if let Some(questions) = &self.noise {
            noise_test::compare(session, (run, solution), questions, again)?;
        }
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
        // An estimated scale makes up for any factor.
        for (name, column) in experiment.all_outputs().filter(|own| own.1.scale.is_none()) {
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

    fn is_of_times(&self) -> bool {
        self.role == Role::X && self.variable == "time"
    }

    fn is_of_the_column_of(&self, other: &Changed) -> bool {
        self.role == other.role && self.variable == other.variable
    }

    fn words(&self) -> String {
        let Changed { variable, column, factor, .. } = self;
        let what = match self.role {
            Role::X if self.is_of_times() => {
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

/// Fits columns that are read otherwise, where they may be read wrongly: one at a time, and two at once
/// where none of these explains the data.
///
/// # Errors
///
/// Those of the simulators' maker.
fn try_readings(
    session: &mut Session,
    about: (&Run, &mut Solution),
    changes: &[Changed],
    again: &mut Again<'_>,
) -> Result<(), Fault> {
    if !about.1.is_doubtful() || session.world.is_interrupted() {
        return Ok(());
    }
    let [fewest, most] = EVALUATIONS;
    let effort = &about.1.effort;
    let each = effort.evaluations / changes.len().max(1) as u64;
    let before = effort.evaluations + effort.simulations_for_statistics;
    let mut fits = ShortFits { session, about, again, readings: Vec::new(), simulations: 0 };
    fits.about.0.evaluation.show("columns read otherwise");
    for changed in changes {
        if !fits.fit(&[changed], each.clamp(fewest, most))? {
            return Ok(());
        }
    }
    if !fits.about.1.is_explained_by(&fits.readings) {
        fits.about.0.evaluation.show("two columns read otherwise");
        if !fits.fit_pairs(changes, before)? {
            return Ok(());
        }
    }
    let ShortFits { about: (_, solution), readings, .. } = fits;
    solution.add_readings(&readings);
    Ok(())
}

/// Short fits to columns that are read otherwise.
struct ShortFits<'a, 'm> {
    session: &'a mut Session,
    about: (&'a Run, &'a mut Solution),
    again: &'a mut Again<'m>,
    readings: Vec<Reading>,
    /// What they took.
    simulations: u64,
}

impl ShortFits<'_, '_> {
    /// Fits with these changes at once; `false` where the user stops the run.
    fn fit(&mut self, changes: &[&Changed], evaluations: u64) -> Result<bool, Fault> {
        let most_steps = self.most_steps();
        let (_, solution) = &mut self.about;
        let change =
            |file: &mut ProblemFile| changes.iter().for_each(|own| own.apply(file, most_steps));
        let words = changes.iter().map(|own| own.words()).collect::<Vec<_>>().join(" and ");
        // A column that cannot be read so is no explanation.
        let Ok(other) = (self.again)(self.session, Change::Entries(&change)) else {
            self.readings.push(Reading { words, r_squared: None });
            return Ok(true);
        };
        let estimate: Vec<f64> = solution.parameters.iter().map(|own| own.value).collect();
        let (processors, flag) =
            (self.session.world.processors(), self.session.world.interrupt_flag());
        let (r_squared, simulations) =
            short_fit(other.problem, (evaluations, &estimate), &processors, flag)?;
        self.simulations += simulations;
        solution.effort.simulations_for_statistics += simulations;
        if self.session.world.is_interrupted() {
            let sentence =
                "Not all other readings of the columns were tried: the run was stopped before.";
            solution.findings.push(Finding::new(FindingKind::Missing, sentence));
            return Ok(false);
        }
        self.readings.push(Reading { words, r_squared });
        Ok(true)
    }

    /// Fits with two changes at once, in the order of what they may explain, until these fits have taken as
    /// many simulations as everything before. `false` where the user stops the run.
    fn fit_pairs(&mut self, changes: &[Changed], most: u64) -> Result<bool, Fault> {
        self.readings.clear();
        let budget = self.simulations + most;
        for [one, other] in self.promising(changes, most / 2)? {
            if self.simulations + OF_A_PAIR > budget {
                break;
            }
            if !self.fit(&[&changes[one], &changes[other]], OF_A_PAIR)? {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// The pairs of changes of different columns, in the order of what they explain at points of the ranges,
    /// for `most` simulations. Those with an output need none beside those of the other change; the rest is
    /// left out where there are too few simulations.
    fn promising(&mut self, changes: &[Changed], most: u64) -> Result<Vec<[usize; 2]>, Fault> {
        let is_output = |own: usize| changes[own].role == Role::Output;
        let differ = |one: usize, other: usize| !changes[one].is_of_the_column_of(&changes[other]);
        let with_outputs = |one: usize| {
            let is_pair = move |own: &usize| is_output(*own) && (*own > one || !is_output(one));
            (0..changes.len()).filter(is_pair).filter(move |own| differ(one, *own))
        };
        let alone = (0..changes.len()).filter(|one| with_outputs(*one).next().is_some());
        let mut bases: Vec<Vec<usize>> = alone.map(|one| vec![one]).collect();
        let rest = (0..changes.len()).filter(|own| !is_output(*own)).flat_map(|one| {
            let others = (one + 1..changes.len()).filter(|own| !is_output(*own));
            others.filter(move |own| differ(one, *own)).map(move |own| vec![one, own])
        });
        let rest: Vec<Vec<usize>> = rest.collect();
        if most >= FEW * (bases.len() + rest.len()) as u64 {
            bases.extend(rest);
        }
        let count = (most as usize / bases.len().max(1)).min(SAMPLES);
        let mut found = Vec::new();
        for base in bases.iter().filter(|_| count > 0) {
            let pairs: Vec<[usize; 2]> = match base.as_slice() {
                [one, other] => vec![[*one, *other]],
                [one] => with_outputs(*one).map(|own| [*one, own]).collect(),
                _ => Vec::new(),
            };
            let scale = |pair: &[usize; 2]| match base.len() {
                1 => (changes[pair[1]].variable.as_str(), changes[pair[1]].factor),
                _ => ("", 1.0),
            };
            let scales: Vec<(&str, f64)> = pairs.iter().map(scale).collect();
            let values = self.promises(changes, base, (&scales, count))?;
            found.extend(values.into_iter().zip(pairs));
        }
        found.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        Ok(found.into_iter().map(|(_, pair)| pair).collect())
    }

    /// What the data with these changes, and with one of these scales, may explain; nothing where they
    /// cannot be read so.
    fn promises(
        &mut self,
        changes: &[Changed],
        base: &[usize],
        about: (&[(&str, f64)], usize),
    ) -> Result<Vec<f64>, Fault> {
        let most_steps = self.most_steps();
        let change = |file: &mut ProblemFile| {
            base.iter().for_each(|own| changes[*own].apply(file, most_steps));
        };
        let is_needless = about.0.is_empty() || self.session.world.is_interrupted();
        let other = match is_needless {
            true => None,
            false => (self.again)(self.session, Change::Entries(&change)).ok(),
        };
        let Some(other) = other else { return Ok(Vec::new()) };
        let (processors, flag) =
            (self.session.world.processors(), self.session.world.interrupt_flag());
        let (values, simulations) = promises(other.problem, about, &processors, flag)?;
        self.simulations += simulations;
        self.about.1.effort.simulations_for_statistics += simulations;
        Ok(values)
    }

    /// Steps that each simulation may take.
    fn most_steps(&self) -> u64 {
        let rows = self.about.1.series.iter().map(|series| series.points.len() as u64).max();
        STEPS + STEPS_PER_ROW * rows.unwrap_or(0)
    }
}
