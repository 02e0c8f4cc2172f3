//! The states of a model from measurements, its parameters given: the filter of a problem with process noise
//! alone, the smoother, and predictions over several samples.

use super::build::{FilteredExperiment, filtered_experiments};
use super::data::Note;
use super::file::{Filtering, MoreTimes, ProblemFile};
use super::{file, noise, refusal};
use crate::Session;
use crate::diag::{Diagnostic, Fault, suggest};
use crate::fault;
use crate::identify::problem::{
    Experiment, Free, ModelSimulator, Observation, PredictedAhead, Series, Simulate, SolvedSeries,
    SolvedState,
};
use crate::models::filter::{Ahead, FIRST_BEGIN, UncertainStates, pairs};
use crate::models::imported::refuse_as_text;
use crate::models::smoother::{Row, Sample, smoothed};
use crate::registry::BAD_OPTION;
use crate::results::{self, ResultTable, Values};
use crate::source::Span;
use nalgebra::{DMatrix, DVector};
use std::path::{Path, PathBuf};

/// What is to be estimated.
#[derive(Debug, Clone, Copy, Default)]
pub struct EstimateOptions<'a> {
    /// A result of `gapi identify` with the values of parameters.
    pub values: Option<&'a Path>,
    /// The experiment, where there are several.
    pub experiment: Option<&'a str>,
    /// Predictions over so many samples.
    pub steps: Option<usize>,
    /// Seconds between rows besides those of the data.
    pub every: Option<f64>,
    /// The last of them, in seconds.
    pub until: Option<f64>,
}

/// States from data.
pub struct Estimated {
    /// The name of the experiment.
    pub experiment: String,
    /// At each row of the data: the states after its samples, their standard deviations, both from all
    /// measurements as well, the measured outputs, their predictions from all earlier samples with their
    /// standard deviations, and simulations that see no measurements.
    pub table: ResultTable,
    /// What was estimated and measured.
    pub shown: Vec<Shown>,
    /// The number of rows with measurements, and the time of the last one.
    pub samples: (usize, f64),
    /// -log L of the measurements.
    pub negative_log_likelihood: f64,
    /// The files that were read: the problem, its data and the values.
    pub read: Vec<PathBuf>,
}

/// A state or an output, by the names of its columns in the table.
#[derive(Debug, Clone, Default)]
pub struct Shown {
    /// The estimate or the prediction, and its standard deviation.
    pub value: [String; 2],
    /// The smoothed estimate of a state.
    pub smoothed: Option<[String; 2]>,
    /// The measurements of an output.
    pub measured: Option<String>,
    /// Predictions over several samples and simulations.
    pub predicted: Vec<String>,
}

/// Estimates the states of an experiment of the problem in the file `path`, that of this name or the only
/// one. Parameters that the problem leaves free have the values of `values`, or where they start.
///
/// # Errors
///
/// Everything that is wrong with the problem; parameters without values, filters that fail.
pub fn estimate(
    session: &mut Session,
    path: &Path,
    options: &EstimateOptions<'_>,
) -> Result<Estimated, Vec<Diagnostic>> {
    let one = |fault: Fault| vec![fault.at(Span::NONE)];
    refuse_as_text(path, "a problem file").map_err(one)?;
    let bytes = session.world.read_bytes(path).map_err(one)?;
    let text = String::from_utf8(bytes)
        .map_err(|_| one(fault!(BAD_OPTION, "`{}` is not valid UTF-8 text", path.display())))?;
    let source = session.sources.add(path.display().to_string(), text.as_str());
    let mut file = file::read(source, &text)
        .map_err(|error| vec![refusal::with_unread_columns(session, path, &text, error)])?;
    // Nothing is fitted: an experiment for validation is one like the others.
    file.experiment.iter_mut().for_each(|own| own.validation = false);
    if file.noise.is_empty() {
        return Err(one(fault!(BAD_OPTION, "`{}` has no process noise", path.display()).help(
            "say on which states noise acts: `[noise]` with `T = 1e-3`; without it, simulate",
        )));
    }
    let more = MoreTimes { every: options.every, until: options.until };
    let mut with = |filtering: Filtering| {
        file.context.filtering = filtering;
        prepared(session, (&mut file, path), options)
    };
    let (chosen, values, notes) = with(Filtering::Smoothed(more))?;
    let found = Estimation::of(&chosen, &values).map_err(one)?;
    let (simulated, ..) = with(Filtering::Simulated(more))?;
    let mut others = vec![("simulated".to_owned(), predictions(&simulated, &values).map_err(one)?)];
    if let Some(steps) = options.steps {
        let ahead = found.ahead(steps).map_err(one)?;
        let name = chosen.experiment.name.clone();
        let (run, ..) = with(Filtering::Ahead([(name, ahead.clone())].into(), more))?;
        let predicted = found.predicted_over(&ahead, &run, &values).map_err(one)?;
        others.push((format!("predicted over {steps}"), predicted));
    }
    notes.iter().for_each(|note| note.say(session));
    let folder = path.parent().unwrap_or(Path::new(""));
    let mut read: Vec<PathBuf> = file.experiment.iter().map(|own| folder.join(&own.data)).collect();
    read.extend(std::iter::once(path).chain(options.values).map(Path::to_owned));
    Ok(Estimated { read, ..found.table(&others) })
}

/// An experiment of a problem, the values of its parameters, and notes on its data.
fn prepared(
    session: &mut Session,
    (file, path): (&mut ProblemFile, &Path),
    options: &EstimateOptions<'_>,
) -> Result<(FilteredExperiment, Vec<f64>, Vec<Note>), Vec<Diagnostic>> {
    let one = |fault: Fault| vec![fault.at(Span::NONE)];
    let (experiments, free, notes) = filtered_experiments(session, file, path)?;
    let known = match options.values {
        Some(values) => found(session, values).map_err(one)?,
        None => Vec::new(),
    };
    let values = given(&free, &known, &noise::invented(file)).map_err(one)?;
    Ok((chosen(experiments, options.experiment).map_err(one)?, values, notes))
}

/// The values in a result of `gapi identify`.
fn found(session: &Session, path: &Path) -> Result<Vec<(String, f64)>, Fault> {
    let bytes = session.world.read_bytes(path)?;
    let result: Result<serde_json::Value, _> = serde_json::from_slice(&bytes);
    let parameters = result.ok().and_then(|own| own["parameters"].as_array().cloned());
    let parameters = parameters.ok_or_else(|| {
        fault!(BAD_OPTION, "`{}` is not a result of `gapi identify`", path.display())
            .help("give the file `result.json` of its folder")
    })?;
    let one =
        |own: &serde_json::Value| Some((own["name"].as_str()?.to_owned(), own["value"].as_f64()?));
    Ok(parameters.iter().filter_map(one).collect())
}

/// The values of the free parameters. `invented`: those that start where the program thinks best.
fn given(free: &[Free], known: &[(String, f64)], invented: &[String]) -> Result<Vec<f64>, Fault> {
    let value = |own: &Free| {
        let known = known.iter().find(|(name, _)| *name == own.name).map(|(_, value)| *value);
        known.or(own.start.filter(|_| !invented.contains(&own.name)))
    };
    let missing: Vec<&str> =
        free.iter().filter(|own| value(own).is_none()).map(|own| own.name.as_str()).collect();
    if !missing.is_empty() {
        let names = suggest::listed(&missing);
        return Err(fault!(BAD_OPTION, "no value is given for {names}").help(
            "write a number in the problem, as `fixed` or `start` of a parameter, or give the \
             `result.json` of a fit: `--values FILE`",
        ));
    }
    Ok(free.iter().filter_map(value).collect())
}

fn chosen(
    mut all: Vec<FilteredExperiment>,
    name: Option<&str>,
) -> Result<FilteredExperiment, Fault> {
    let names: Vec<String> = all.iter().map(|own| own.experiment.name.clone()).collect();
    let names = suggest::listed(&names.iter().map(String::as_str).collect::<Vec<_>>());
    let place = match name {
        Some(name) => all.iter().position(|own| own.experiment.name == name),
        None => (all.len() == 1).then_some(0),
    };
    match (place, name) {
        (Some(place), _) => Ok(all.swap_remove(place)),
        (None, Some(name)) => Err(fault!(BAD_OPTION, "there is no experiment `{name}`")
            .help(format!("the experiments are {names}"))),
        (None, None) => Err(fault!(BAD_OPTION, "the problem has several experiments")
            .help(format!("select one of {names}: `--experiment NAME`"))),
    }
}

/// Simulates an experiment with observations of its own; a column for each.
fn simulated(
    experiment: &Experiment,
    values: &[f64],
    observations: Vec<Observation>,
) -> Result<Vec<Vec<f64>>, Fault> {
    let sizes: Vec<usize> = observations.iter().map(|own| own.x.len()).collect();
    let watched = Experiment { observations, deviations: 0, ..experiment.clone() };
    let mut row = vec![0.0; sizes.iter().sum()];
    let mut simulator = ModelSimulator::new(std::slice::from_ref(&watched))?;
    simulator.simulate(values, &mut row).map_err(|failed| {
        fault!(BAD_OPTION, "the filter fails: {}", failed.cause)
            .help("check the values of the parameters")
    })?;
    let mut all = row.into_iter();
    Ok(sizes.into_iter().map(|size| all.by_ref().take(size).collect()).collect())
}

/// For each output its predictions at all rows, and their standard deviations.
fn predictions(chosen: &FilteredExperiment, values: &[f64]) -> Result<Vec<[Vec<f64>; 2]>, Fault> {
    let experiment = &chosen.experiment;
    let at_rows = |own: &Observation| Observation { x: chosen.states.times.clone(), ..own.clone() };
    let observations = experiment.observations.iter().map(at_rows).collect();
    let mut columns = simulated(experiment, values, observations)?.into_iter();
    let outputs = experiment.observations.len() - experiment.deviations;
    let means: Vec<Vec<f64>> = columns.by_ref().take(outputs).collect();
    Ok(means.into_iter().zip(columns).map(|(mean, sd)| [mean, sd]).collect())
}

/// What a filter has found.
pub(super) struct Estimation<'a> {
    experiment: &'a Experiment,
    /// The measured series.
    series: Vec<&'a Series>,
    states: &'a UncertainStates,
    /// The times of all rows.
    times: Vec<f64>,
    /// The rows, for each output its prediction and the standard deviation of that at all times.
    rows: Vec<Row>,
    predictions: Vec<[Vec<f64>; 2]>,
}

impl<'a> Estimation<'a> {
    /// Runs a filter whose purpose is smoothing.
    pub(super) fn of(
        chosen: &'a FilteredExperiment,
        values: &[f64],
    ) -> Result<Estimation<'a>, Fault> {
        let FilteredExperiment { experiment, series, states } = chosen;
        let times = &states.times;
        let series: Vec<&Series> = series.iter().filter(|own| own.is_data()).collect();
        let at_rows = |name: &String| Observation { y_name: name.clone(), x: times.clone() };
        let smoothing = &states.smoothing;
        let outputs = experiment.observations.iter().map(|own| &own.y_name);
        let gains = smoothing.gains.iter().flatten().map(|own| &own.1);
        let names = outputs.chain(&states.names).chain(&states.covariances);
        let names = names.chain(&smoothing.transitions);
        let names = names.chain(smoothing.products.iter().flatten()).chain(gains);
        let observations = names.map(at_rows).collect();
        let columns = simulated(experiment, values, observations)?;
        let (predicted, columns) = columns.split_at(2 * series.len());
        let (means, deviations) = predicted.split_at(series.len());
        let predictions: Vec<[Vec<f64>; 2]> =
            means.iter().zip(deviations).map(|(mean, sd)| [mean.clone(), sd.clone()]).collect();
        let mut found = Estimation {
            experiment,
            series,
            states,
            times: times.clone(),
            rows: Vec::new(),
            predictions,
        };
        found.rows = (0..times.len()).map(|at| found.row(at, columns)).collect();
        Ok(found)
    }

    /// The name of the experiment.
    pub(super) fn experiment(&self) -> &str {
        &self.experiment.name
    }

    /// The row of this number, from columns in the order in which they are observed.
    fn row(&self, at: usize, columns: &[Vec<f64>]) -> Row {
        let n = self.states.names.len();
        let mut values = columns.iter().map(|column| column[at]);
        let mut next = |count: usize| -> Vec<f64> { values.by_ref().take(count).collect() };
        let state = DVector::from_vec(next(n));
        let mut covariance = DMatrix::zeros(n, n);
        for ([i, j], value) in pairs(n).zip(next(n * (n + 1) / 2)) {
            (covariance[(i, j)], covariance[(j, i)]) = (value, value);
        }
        let transition = DMatrix::from_row_slice(n, n, &next(n * n));
        let products: Vec<Vec<f64>> = self.series.iter().map(|_| next(n)).collect();
        let gains = self.states.smoothing.gains.iter().map(|own| {
            let mut gain = DVector::zeros(n);
            own.iter().zip(next(own.len())).for_each(|((i, _), value)| gain[*i] = value);
            gain
        });
        let gains: Vec<DVector<f64>> = gains.collect();
        let all_gains = gains.clone();
        let outputs =
            self.series.iter().zip(&self.predictions).zip(products.into_iter().zip(gains));
        let samples = outputs.filter_map(|((own, [mean, sd]), (product, gain))| {
            let measured = sample_at(own, self.times[at])?;
            Some(Sample {
                gain,
                product: DVector::from_vec(product),
                variance: sd[at] * sd[at],
                innovation: measured - mean[at],
            })
        });
        let samples = samples.collect();
        Row { state, covariance, transition, gains: all_gains, samples }
    }

    /// The states as a result shows them.
    pub(super) fn states(&self) -> Vec<SolvedState> {
        let smooth = smoothed(&self.rows);
        let sd = |p: &DMatrix<f64>, i: usize| p[(i, i)].max(0.0).sqrt();
        let state = |(i, name): (usize, &String)| {
            let rows = self.times.iter().zip(&self.rows).zip(&smooth);
            let points = rows.map(|((time, row), (x, p))| {
                [*time, row.state[i], sd(&row.covariance, i), x[i], sd(p, i)]
            });
            SolvedState {
                experiment: self.experiment.name.clone(),
                y: [name.clone(), self.experiment.model.unit(name).unwrap_or_default()],
                points: points.collect(),
            }
        };
        self.states.names.iter().enumerate().map(state).collect()
    }

    /// The prediction of an output from earlier rows alone, and its standard deviation: the filter takes
    /// the outputs of a row one after the other, and the ones before it have moved its own.
    fn by_earlier_rows(&self, output: usize, at: usize) -> (f64, f64) {
        let row = &self.rows[at];
        let [mean, sd] = self.predictions[output].each_ref().map(|own| own[at]);
        let gain = &row.gains[output];
        let is_before = |k: &usize| sample_at(self.series[*k], self.times[at]).is_some();
        let before = (0..output).filter(is_before).count();
        let mut moved = 0.0;
        let mut variance = sd * sd;
        for own in &row.samples[..before] {
            let along = gain.dot(&own.product);
            moved += along * own.innovation / own.variance;
            variance += along * along / own.variance;
        }
        (mean - moved, variance.sqrt())
    }

    /// The same at all rows.
    fn all_from_earlier_rows(&self, output: usize) -> (Vec<f64>, Vec<f64>) {
        (0..self.times.len()).map(|at| self.by_earlier_rows(output, at)).unzip()
    }

    /// Puts predictions from earlier rows alone in the place of those that the likelihood compares, which
    /// have seen the outputs before them in their rows. Between rows there are none, so that no curve goes
    /// through them.
    pub(super) fn predict(&self, solved: &mut [SolvedSeries]) {
        for (k, solved) in solved.iter_mut().enumerate() {
            let (means, deviations) = self.all_from_earlier_rows(k);
            let at = |time: &f64| self.times.binary_search_by(|own| own.total_cmp(time)).ok();
            let found: Option<Vec<usize>> = self.series[k].x.iter().map(at).collect();
            if let Some(places) = found {
                let pairs = places.into_iter().map(|at| [means[at], deviations[at]]);
                solved.predict(&pairs.collect::<Vec<_>>());
            }
        }
    }

    /// The rows with samples.
    fn sampled(&self) -> impl Iterator<Item = (f64, &Row)> {
        let rows = self.times.iter().copied().zip(&self.rows);
        rows.filter(|(time, _)| self.series.iter().any(|own| sample_at(own, *time).is_some()))
    }

    /// Notes the predictions over so many samples beside what was measured.
    pub(super) fn predict_over(
        &self,
        ahead: &Ahead,
        (run, values): (&FilteredExperiment, &[f64]),
        solved: &mut [SolvedSeries],
    ) -> Result<(), Fault> {
        let found = self.predicted_over(ahead, run, values)?;
        for ((solved, series), [mean, sd]) in solved.iter_mut().zip(&self.series).zip(&found) {
            let point = |time: &f64| {
                let at = self.times.binary_search_by(|own| own.total_cmp(time)).ok()?;
                mean[at].is_finite().then_some([*time, mean[at], sd[at]])
            };
            let points = series.x.iter().filter_map(point).collect();
            solved.ahead = Some(PredictedAhead { samples: ahead.steps, points });
        }
        Ok(())
    }

    /// The states from which predictions over so many samples begin.
    pub(super) fn ahead(&self, steps: usize) -> Result<Ahead, Fault> {
        let count = self.sampled().count();
        if !(2..count).contains(&steps) {
            return Err(fault!(BAD_OPTION, "predictions over {steps} samples are not possible")
                .help(format!("write a number from 2 to {}", count.saturating_sub(1))));
        }
        let one = |row: &Row| {
            let covariances = pairs(row.state.len()).map(|[i, j]| row.covariance[(i, j)]);
            row.state.iter().copied().chain(covariances).collect()
        };
        let times = self.sampled().map(|own| own.0).collect();
        Ok(Ahead { steps, times, found: self.sampled().map(|(_, row)| one(row)).collect() })
    }

    /// Predictions over so many samples; not a number where there were not so many before.
    fn predicted_over(
        &self,
        ahead: &Ahead,
        run: &FilteredExperiment,
        values: &[f64],
    ) -> Result<Vec<[Vec<f64>; 2]>, Fault> {
        let mut experiment = run.experiment.clone();
        experiment.parameters.push((values.len(), FIRST_BEGIN.to_owned()));
        let run = FilteredExperiment { experiment, ..run.clone() };
        let (steps, start) = (ahead.steps, self.experiment.settings.start);
        let numbers = self.times.iter().map(|time| ahead.number(start, *time));
        let numbers: Vec<usize> = numbers.collect();
        let nothing = || [(); 2].map(|()| vec![f64::NAN; numbers.len()]);
        let mut all: Vec<[Vec<f64>; 2]> = self.series.iter().map(|_| nothing()).collect();
        for begin in 0..steps {
            let found = predictions(&run, &[values, &[begin as f64]].concat())?;
            for (all, found) in all.iter_mut().zip(&found) {
                for (at, number) in numbers.iter().enumerate() {
                    if *number >= steps && number % steps == begin {
                        (all[0][at], all[1][at]) = (found[0][at], found[1][at]);
                    }
                }
            }
        }
        Ok(all)
    }

    /// The table. `others`: further predictions of the outputs at all rows.
    fn table(&self, others: &[(String, Vec<[Vec<f64>; 2]>)]) -> Estimated {
        let times = &self.times;
        let mut made = Table { times, table: ResultTable::new(times.clone()), shown: Vec::new() };
        for SolvedState { y: [state, unit], points, .. } in self.states() {
            let column = |at: usize| -> Vec<f64> { points.iter().map(|own| own[at]).collect() };
            let name = format!("smoothed({state})");
            let value = made.pair(&state, &unit, (times, &column(1), &column(2)));
            let smoothed = Some(made.pair(&name, &unit, (times, &column(3), &column(4))));
            made.shown.push(Shown { value, smoothed, ..Shown::default() });
        }
        let mut log = 0.0;
        for (k, own) in self.series.iter().enumerate() {
            let (name, unit) = (&own.y_name, &own.y_unit);
            let [mean, sd] = &self.predictions[k];
            let (means, deviations) = self.all_from_earlier_rows(k);
            let value =
                made.pair(&format!("predicted({name})"), unit, (times, &means, &deviations));
            let measured = made.column(&format!("measured({name})"), unit, (&own.x, &own.y));
            let mut shown = Shown { value, measured: Some(measured), ..Shown::default() };
            for (what, found) in others {
                let [mean, sd] = &found[k];
                let [title, _] = made.pair(&format!("{what}({name})"), unit, (times, mean, sd));
                shown.predicted.push(title);
            }
            made.shown.push(shown);
            let points = times.iter().zip(mean).zip(sd);
            log += points
                .filter_map(|((time, mean), sd)| Some(density(sample_at(own, *time)?, *mean, *sd)))
                .sum::<f64>();
        }
        let last = self.sampled().last().map_or(f64::NAN, |own| own.0);
        Estimated {
            experiment: self.experiment.name.clone(),
            table: made.table,
            shown: made.shown,
            samples: (self.sampled().count(), last),
            negative_log_likelihood: log,
            read: Vec::new(),
        }
    }
}

/// What was measured at this time.
fn sample_at(series: &Series, time: f64) -> Option<f64> {
    let at = series.x.binary_search_by(|own| own.total_cmp(&time)).ok()?;
    Some(series.y[at])
}

/// -log of the density of a normal measurement.
fn density(y: f64, predicted: f64, sd: f64) -> f64 {
    let own = (y - predicted) / sd;
    0.5 * own * own + crate::elementary::ln(sd) + 0.5 * crate::elementary::ln(std::f64::consts::TAU)
}

/// A table that is being made.
struct Table<'a> {
    times: &'a [f64],
    table: ResultTable,
    shown: Vec<Shown>,
}

impl Table<'_> {
    /// Adds values and their standard deviations.
    fn pair(
        &mut self,
        name: &str,
        unit: &str,
        (x, values, sd): (&[f64], &[f64], &[f64]),
    ) -> [String; 2] {
        let of_sd = format!("sd({name})");
        [self.column(name, unit, (x, values)), self.column(&of_sd, unit, (x, sd))]
    }

    /// Adds a column over some of the times, with NaN elsewhere.
    fn column(&mut self, name: &str, unit: &str, (x, values): (&[f64], &[f64])) -> String {
        let at = |time: &f64| {
            x.binary_search_by(|own| own.total_cmp(time)).ok().map_or(f64::NAN, |at| values[at])
        };
        let values = self.times.iter().map(at).collect();
        let name = self.free_name(name);
        self.table.series.push(results::Series {
            unit: unit.to_owned(),
            ..results::Series::new(name.clone(), Values::Trajectory(values))
        });
        name
    }

    /// Replicate measurements have one variable.
    fn free_name(&self, name: &str) -> String {
        let is_free = |name: &String| self.table.series.iter().all(|own| own.name != *name);
        let more = (2..).map(|number| format!("{name} {number}"));
        std::iter::once(name.to_owned()).chain(more).find(is_free).unwrap_or_default()
    }
}
