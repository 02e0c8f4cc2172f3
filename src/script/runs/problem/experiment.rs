//! One experiment of a problem: its data, the class around the model, the compiled model and the
//! settings of its simulation.

use super::data::{self, Notes};
use super::enclosing_class::{Base, EnclosingClass};
use super::file::{self, ColumnEntry, ExperimentEntry, ProblemFile};
use super::inputs::{self, Times, Undecided};
use super::segments::{Rows, Segment, segments};
use super::series::Comparison;
use super::{
    deviation, dynamics, enclosing_class, filtering, frequency_axis, parameters, time_axis,
};
use crate::Session;
use crate::codegen::Program;
use crate::diag::{At as _, Diagnostic, Fault};
use crate::fault;
use crate::flatten::{self, FlatModel, Variability};
use crate::identify::problem::{Experiment, Free, Series};
use crate::identify::{CompiledModel, Model, significant};
use crate::mat::{Column, MatFile};
use crate::models::exported::with_inputs_to_come;
use crate::models::filter::UncertainStates;
use crate::models::imported::CO_SIMULATION;
use crate::models::simulation::{self, SimulationOptions};
use crate::models::static_curve;
use crate::registry::BAD_OPTION;
use crate::sim::{self, Residual, Settings, TimeBudget};
use crate::source::Span;
use crate::syntax::ast::CausalityPrefix;
use std::fmt::Write;
use std::sync::Arc;

/// The solver's tolerance where the problem gives none, and the coarsest that an annotation of the
/// model may ask for: least squares need simulation errors that are small against the residuals, and
/// the fit is repeated with a finer one where they are not (`identify::conclude`). Six of 13 published
/// fits need a finer tolerance than 1e-4. With 1e-9 `Modelica.Fluid.Examples.HeatingSystem` does not
/// end its first simulation within a minute.
const TOLERANCE: f64 = 1e-6;

/// The errors of exact steps: those that the statistics were tried with.
const EXACT: f64 = 1e-9;

/// Steps that a simulation may take for each row of its data, as long as it gets on. `dassl` takes 38
/// for a house with two capacities under inputs of 15 minutes with the tolerance above, rejected ones
/// included: 1.3 million in a year, more than are allowed in any case.
const STEPS_PER_ROW: u64 = 1000;

/// An experiment that was read.
pub(super) struct Built {
    pub experiment: Experiment,
    pub series: Vec<Series>,
    /// The relative error of simulated values that the integrator makes.
    pub(crate) error: f64,
    /// Where it is filtered, its uncertain states.
    pub states: UncertainStates,
    /// Its compiled model; `None` where it is a functional mock-up unit.
    pub program: Option<Arc<Program>>,
    /// Inputs of which it is not known how they continue between samples.
    pub undecided: Vec<Undecided>,
}

impl Built {
    /// One that is not filtered, and whose inputs are decided.
    pub(super) fn plain(
        (experiment, series): (Experiment, Vec<Series>),
        error: f64,
        program: Option<Arc<Program>>,
    ) -> Built {
        let (states, undecided) = (UncertainStates::default(), Vec::new());
        Built { experiment, series, error, states, program, undecided }
    }
}

/// What an experiment is read from.
pub(super) struct Source<'a> {
    pub file: &'a ProblemFile,
    pub entry: &'a ExperimentEntry,
    /// The name of the experiment, of which this may be a part.
    pub label: &'a str,
    pub segment: &'a Segment,
    /// Its place among all parts of all experiments.
    pub number: usize,
    /// The rows of the part.
    pub table: &'a MatFile,
    pub free: &'a [Free],
}

/// The independent variable of an experiment.
pub(super) struct Abscissa {
    entry: ColumnEntry,
    /// The variable.
    pub name: String,
    /// The name of its column.
    own: String,
    column: Column,
    /// Times of inputs that follow the rows; X itself where it is not time.
    pub time: Vec<f64>,
}

/// A model that is compared with data.
pub(super) struct Subject {
    pub model: Arc<dyn Model>,
    /// What it says of its experiment.
    pub annotated: flatten::Experiment,
    /// Where its own simulation ends, if it says so; `None` where times have no meaning.
    pub stop: Option<Option<f64>>,
    /// The free parameters with their names in it.
    pub parameters: Vec<(usize, String)>,
}

/// The model of an experiment in its class.
pub(super) struct Class {
    pub(super) name: String,
    /// The free parameters with their names in the class.
    pub(super) parameters: Vec<(usize, String)>,
    /// The names of the outputs in the class.
    pub(super) observed: Vec<String>,
    /// Whether X is a parameter of the class.
    is_driven: bool,
    undecided: Vec<Undecided>,
}

/// The number of rows of an experiment, and the parts into which they are cut.
///
/// # Errors
///
/// A column of X that there is not, numbers that may be days or seconds, cuts that cannot be made.
pub(super) fn rows(
    (entry, number): (&ExperimentEntry, usize),
    table: &MatFile,
    notes: &mut Notes,
) -> Result<(usize, Vec<Segment>), Diagnostic> {
    let [place, cuts] = [["x"], ["segments"]].map(|way| entry.places.at(&way));
    let (x, name, own) = x_of(entry, table).at(place)?;
    notes.about(table, if table.is_table() { table.warnings.clone() } else { Vec::new() });
    let is_missing = entry.x.is_none() && table.matrix(&own).is_err();
    let column = data::column(table, &x, &name, notes).map_err(|fault| match is_missing {
        true => fault.help(
            "say which one is that of the times: `x = { variable = \"time\", column = \"…\" }`",
        ),
        false => fault,
    });
    let column = column.at(place)?;
    let count = column.values.len();
    if name != "time" {
        if entry.segments.is_some() {
            let fault = fault!(BAD_OPTION, "`segments` cuts over time, but X is `{name}`"; help: "use `time` as X, or remove it");
            return Err(fault.at(cuts));
        }
        return Ok((count, vec![Segment::whole(entry, number, None)]));
    }
    let origin = time_axis::origin(&own, &column, (&x, entry.start_time), (table, notes));
    let origin = origin.at(place)?;
    if entry.segments.is_none() {
        return Ok((count, vec![Segment::whole(entry, number, origin)]));
    }
    let seconds = time_axis::seconds(&column, &x, origin, (table, notes)).at(place)?;
    let rows = Rows { column: &column, seconds: &seconds, origin };
    Ok((count, segments((entry, number), table, &rows, notes).at(cuts)?))
}

/// X: its entry, the variable that it is, and its column. A bare name is both; the column of time is
/// `Time` in the result files of Dymola.
fn x_of(entry: &ExperimentEntry, table: &MatFile) -> Result<(ColumnEntry, String, String), Fault> {
    if entry.spectrum.is_some() {
        return frequency_axis::x_of(entry, table);
    }
    let mut x = entry.x.as_ref().map_or_else(|| ColumnEntry::named(None), file::Column::entry);
    let column = x.column.clone().or_else(|| x.variable.clone());
    let column = column.unwrap_or_else(|| "time".to_owned());
    let name = x.variable.clone().unwrap_or_else(|| column.clone());
    if column == "time" && table.matrix("time").is_err() && table.matrix("Time").is_ok() {
        x.column = Some("Time".to_owned());
    }
    let column = x.column.clone().unwrap_or(column);
    Ok((x, name, column))
}

impl Source<'_> {
    /// Reads a part of the experiment.
    ///
    /// # Errors
    ///
    /// What is wrong with its data, its class or its settings.
    pub(super) fn build(
        &self,
        session: &mut Session,
        notes: &mut Notes,
    ) -> Result<Built, Vec<Diagnostic>> {
        let abscissa = self.abscissa(notes);
        let abscissa = abscissa.map_err(|fault| vec![fault.at(self.entry.places.at(&["x"]))])?;
        let class = self.class(session, &abscissa, notes)?;
        let translated = match simulation::translated(session, &class.name) {
            Ok(translated) => translated,
            Err(errors) => {
                let entry = self.with_starts(session).ok_or(errors)?;
                return Source { entry: &entry, ..*self }.build(session, notes);
            }
        };
        let program = translated.program.clone();
        self.check(session, &abscissa.name, &class, &translated)?;
        parameters::note_computed(&class.parameters, &translated, notes);
        let compiled = match class.is_driven {
            true => static_curve::model(&self.file.model, &translated, &abscissa.name)
                .map_err(|fault| vec![fault.at(self.entry.places.at(&["x"]))])?,
            false => CompiledModel::new(&self.file.model, program.clone()),
        };
        let has_states = !program.sorted().states.is_empty();
        let base = Base::of(&self.file.model, self.file.context.places.text(&["model"]))
            .map_err(|e| vec![e])?;
        let class_stop = session.classes.library.definition(&base.class);
        let class_stop = class_stop.and_then(|class| flatten::experiment(&class).stop_time);
        let subject = Subject {
            model: Arc::new(compiled),
            annotated: program.experiment(),
            stop: has_states.then_some(class_stop),
            parameters: class.parameters,
        };
        let compared = self.compare(session, subject, (&abscissa, &class.observed), notes)?;
        let (experiment, series, program, states) = match self.file.noise.is_empty() {
            true => (compared.0, compared.1, program, UncertainStates::default()),
            false => {
                let (own, class) = ((self.file, self.entry), (&*class.name, &*abscissa.time));
                filtering::filtered(session, own, class, compared, notes)?
            }
        };
        let error = if has_states { error_of(&program, &experiment.settings) } else { 0.0 };
        let undecided = class.undecided;
        Ok(Built { experiment, series, error, program: Some(program), states, undecided })
    }

    /// The comparison of a model with the data.
    ///
    /// # Errors
    ///
    /// Columns and settings that make no sense; nothing to compare.
    pub(super) fn compare(
        &self,
        session: &Session,
        subject: Subject,
        (abscissa, observed): (&Abscissa, &[String]),
        notes: &mut Notes,
    ) -> Result<(Experiment, Vec<Series>), Vec<Diagnostic>> {
        let Subject { model, annotated, stop, parameters } = subject;
        let name = self.segment.name.clone();
        let mut comparison = Comparison {
            experiment: &name,
            label: self.label,
            entry: self.entry,
            table: self.table,
            model: &*model,
            x_name: &abscissa.name,
            x_column: &abscissa.own,
            x: Vec::new(),
            start: 0.0,
        };
        let x = abscissa.in_unit(&comparison, notes).at(self.entry.places.at(&["x"]));
        comparison.x = x.map_err(|error| vec![error])?;
        let begin = self.begin(annotated.start_time, &comparison, notes);
        let settings = self.settings(session, &annotated, begin, &comparison);
        let settings = settings.map_err(|error| vec![error])?;
        comparison.start = settings.start;
        if let Some(stop) = stop {
            note_start(&comparison, notes);
            note_stop(&comparison, abscissa, stop, notes);
            note_unused_stop(&comparison, notes);
        }
        let (observations, series) =
            comparison.outputs(observed, notes).map_err(|error| vec![error])?;
        if observations.is_empty() {
            let fault = fault!(BAD_OPTION, "{name} has no outputs to compare"; help: "name one in `outputs`");
            return Err(vec![fault.at(self.entry.places.at(&["outputs"]))]);
        }
        let experiment = Experiment {
            name,
            model: model.clone(),
            settings,
            second_attempt: true,
            x_name: abscissa.name.clone(),
            deviations: series.iter().filter(|own| !own.is_data()).count(),
            observations,
            parameters,
        };
        Ok((experiment, series))
    }

    /// The experiment with the start values of what it sets that the equations determine; `None` where it
    /// sets nothing of the kind.
    fn with_starts(&self, session: &mut Session) -> Option<ExperimentEntry> {
        let flat = simulation::flattened(session, &self.file.model).ok()?.model;
        let is_computed = |name: &&String| {
            let variable = flat.variables.get(name.as_str());
            variable.is_some_and(|own| {
                own.variability > Variability::Parameter
                    && own.causality != Some(CausalityPrefix::Input)
            })
        };
        let names: Vec<String> =
            self.entry.set.values.keys().filter(is_computed).cloned().collect();
        let mut entry = self.entry.clone();
        for name in names.iter().filter(|name| !self.entry.start.contains_key(*name)) {
            let value = entry.set.values.shift_remove(name)?;
            entry.start.insert(name.clone(), value);
            entry.places.put(&["start", name], &self.entry.places, &["set", name]);
        }
        (entry.set.values.len() < self.entry.set.values.len()).then_some(entry)
    }

    /// Refuses names that the model does not have, and values that it cannot be given.
    fn check(
        &self,
        session: &mut Session,
        x_name: &str,
        class: &Class,
        model: &simulation::Translated,
    ) -> Result<(), Vec<Diagnostic>> {
        let (file, places) = (self.file, &self.entry.places);
        let outputs =
            self.entry.outputs.keys().map(|name| (name.as_str(), places.at(&["outputs", name])));
        let outputs: Vec<(&str, Span)> = outputs.collect();
        parameters::check_variables(&[(x_name, places.at(&["x"]))], model)
            .map_err(|error| vec![self.entry.about_x(error)])?;
        parameters::check_variables(&outputs, model).map_err(|error| vec![error])?;
        parameters::check_free(session, file, &class.parameters, model)?;
        self.segment.check_initial_values(file, self.entry, model).map_err(|error| vec![error])?;
        parameters::check_taken(file, self.entry, model).map_err(|error| vec![error])?;
        parameters::check_initial(session, file, self.entry, model)
    }

    pub(super) fn abscissa(&self, notes: &mut Notes) -> Result<Abscissa, Fault> {
        let table = self.table;
        let (entry, name, own) = x_of(self.entry, table)?;
        let column = data::column(table, &entry, &name, notes)?;
        notes.about(table, column.missing.clone());
        // Spectra are measured from high frequencies to low ones.
        let fall = column.fall(&own).filter(|_| self.entry.spectrum.is_none());
        notes.warn_about(table, fall);
        let time = match name.as_str() {
            "time" => {
                notes.about(table, time_axis::repeated(&own, &column));
                if !self.changes_within_stamps(&own, &column.values) {
                    notes.about(table, time_axis::without_seconds(&own, &column.values));
                }
                if self.segment.origin.is_none() {
                    time_axis::note_unit(&own, &column, &entry, (table, notes));
                }
                time_axis::seconds(&column, &entry, self.segment.origin, (table, notes))?
            }
            _ => {
                notes.about(table, column.repetition(&own));
                column.values.clone()
            }
        };
        Ok(Abscissa { entry, name, own, column, time })
    }

    /// Whether an input changes between rows of one time stamp.
    fn changes_within_stamps(&self, name: &str, times: &[f64]) -> bool {
        self.entry.inputs.iter().any(|(input, column)| {
            let column = self.table.column(column.entry().column.as_deref().unwrap_or(input));
            let changes = |values: &[f64]| time_axis::truncated(name, times, (input, values));
            column.is_ok_and(|own| changes(&own.values).is_some())
        })
    }

    fn setting<'s>(&'s self, of_any_deviation: &'s [String]) -> parameters::Setting<'s> {
        let Source { file, entry, label, segment, free, .. } = *self;
        let of_deviations = &[];
        parameters::Setting { file, entry, label, segment, free, of_deviations, of_any_deviation }
    }

    /// The class around the model, loaded.
    pub(super) fn class(
        &self,
        session: &mut Session,
        x: &Abscissa,
        notes: &mut Notes,
    ) -> Result<Class, Vec<Diagnostic>> {
        let Source { file, entry, segment, .. } = *self;
        let base = Base::of(&file.model, file.context.places.text(&["model"]))
            .map_err(|error| vec![error])?;
        let here = (self.number, entry.places.at(&["data"]));
        let mut enclosing = EnclosingClass::default();
        let of_any_deviation = deviation::parameters_of(file);
        let setting = self.setting(&of_any_deviation);
        let formulas = deviation::formulas(entry, self.table).map_err(|error| vec![error])?;
        let has_formulas = !formulas.is_empty() || !of_any_deviation.is_empty();
        let plain = types_of(session, &file.model, (has_formulas, setting.needs_types()))?;
        let types = plain.as_ref().map(|own| &own.model);
        let of_deviations = deviation::declare(formulas, (file, entry), types, &mut enclosing)
            .map_err(|error| vec![error])?;
        let setting = parameters::Setting { of_deviations: &of_deviations, ..setting };
        let parameters = setting.parameters(types, &mut enclosing).map_err(|error| vec![error])?;
        note_used_twice(entry, notes);
        note_swapped(entry, notes);
        let (mut is_driven, mut undecided) = (false, Vec::new());
        if x.name != "time" || !entry.inputs.is_empty() {
            // What the experiment sets may shape the model: sizes, conditions.
            let class = enclosing.load(session, &base, here)?;
            let flat = simulation::flattened(session, &class)?.model;
            is_driven = drive(entry, &flat, (&x.name, &x.column.values), &mut enclosing);
            let times = Times { name: &x.name, values: &x.time, origin: segment.origin };
            undecided = inputs::inputs(entry, self.table, &times, &flat, &mut enclosing, notes)
                .map_err(|error| vec![error])?;
        }
        notes.about(self.table, dynamics::note_short_delays(file, entry, &x.time));
        let mut observed = Vec::new();
        for (y_name, requested) in entry.all_outputs() {
            let place = observed.len();
            let delayed =
                dynamics::delayed(file, y_name, place, &requested, &x.name, &mut enclosing);
            let delayed = delayed
                .map_err(|fault| vec![fault.at(entry.places.at(&["outputs", y_name, "delay"]))])?;
            observed.push(delayed);
        }
        if entry.steady_state {
            let class = enclosing.load(session, &base, here)?;
            let plain = without_data(session, &class)?;
            setting.avoid_zeros(&parameters, &plain, &mut enclosing);
            let varied = parameters::variables(&parameters, &plain);
            let sums = dynamics::steady(file, entry, (&plain, &varied), &mut enclosing);
            let sums = sums.at(entry.places.at(&["steady_state"])).map_err(|error| vec![error])?;
            notes.about(
                self.table,
                sums.iter().map(|sum| {
                    format!("the steady state keeps the sum that the equations conserve: {sum}")
                }),
            );
        }
        let name = enclosing.load(session, &base, here)?;
        Ok(Class { name, parameters, observed, is_driven, undecided })
    }

    /// When the simulation begins, if not where the model says or at 0: a part begins with its first
    /// row, and so does an experiment that was measured before that.
    pub(super) fn begin(
        &self,
        annotated: Option<f64>,
        comparison: &Comparison<'_>,
        notes: &mut Notes,
    ) -> Option<f64> {
        let first = comparison.x.iter().copied().filter(|x| x.is_finite());
        let first = first.reduce(f64::min).filter(|_| comparison.x_name == "time");
        if self.segment.number > 0 {
            return first;
        }
        if self.entry.start_time.is_some() {
            return self.entry.start_time;
        }
        let first = first.filter(|first| *first < annotated.unwrap_or(0.0))?;
        notes.add(format!(
            "{}: the simulation begins with the first row, at {first} s; the initial values are \
             those of this time",
            comparison.experiment
        ));
        Some(first)
    }

    pub(super) fn settings(
        &self,
        session: &Session,
        annotated: &flatten::Experiment,
        begin: Option<f64>,
        comparison: &Comparison<'_>,
    ) -> Result<Settings, Diagnostic> {
        let entry = self.entry;
        let tolerance = annotated.tolerance.map_or(TOLERANCE, |tolerance| tolerance.min(TOLERANCE));
        let options = SimulationOptions {
            start: begin,
            stop: stop_time(entry, comparison.x_name, &comparison.x, annotated.stop_time),
            tolerance: entry.tolerance.or(Some(tolerance)),
            method: entry.integrator.clone().filter(|name| name != CO_SIMULATION),
            ..SimulationOptions::default()
        };
        // What the entries of the experiment can make wrong, each at its place.
        let has_limits = entry.start_time.or(entry.stop_time).is_some();
        let wrong = [
            ("tolerance", entry.tolerance.is_some_and(|own| !simulation::is_tolerance(own))),
            (
                "integrator",
                options.method.as_deref().is_some_and(|own| sim::find_integrator(own).is_err()),
            ),
            (if entry.stop_time.is_some() { "stop_time" } else { "start_time" }, has_limits),
        ];
        let wrong = wrong.iter().find(|own| own.1).map_or("data", |own| own.0);
        let settings = simulation::settings(annotated, &options);
        let mut settings = settings.at(entry.places.at(&[wrong]))?;
        settings.takes_exact_steps = entry.integrator.is_none();
        let for_rows = STEPS_PER_ROW * comparison.x.len() as u64;
        settings.max_total_steps = settings.max_total_steps.max(for_rows);
        limit(session, entry, &mut settings)?;
        Ok(settings)
    }
}

impl Abscissa {
    /// X in the unit of the model.
    pub(super) fn in_unit(
        &self,
        comparison: &Comparison<'_>,
        notes: &mut Notes,
    ) -> Result<Vec<f64>, Fault> {
        if self.name == "time" {
            return Ok(self.time.clone());
        }
        let (unit, about) = (comparison.unit(&self.name), (comparison.table, notes));
        Ok(data::in_unit(&self.column, &self.name, &unit, &self.entry, about)?.values)
    }
}

/// The model of a problem without what an experiment sets, where formulas need it, or values do: for these a model
/// that cannot be translated without them has no types.
fn types_of(
    session: &mut Session,
    model: &str,
    (for_formulas, for_values): (bool, bool),
) -> Result<Option<flatten::Flattened>, Vec<Diagnostic>> {
    match (for_formulas, for_values) {
        (true, _) => simulation::flattened(session, model).map(Some),
        (false, true) => Ok(simulation::flattened(session, model).ok()),
        (false, false) => Ok(None),
    }
}

/// A model whose inputs will follow data or oscillate: that they have none is not said.
fn without_data(session: &mut Session, class: &str) -> Result<Arc<Program>, Vec<Diagnostic>> {
    let plain = with_inputs_to_come(session, |session| simulation::translated(session, class))?;
    Ok(plain.program.clone())
}

/// The relative error of values that are simulated so. Exact steps have none whatever the tolerance is:
/// they count as if they had that of the default, which is what the statistics were tried with.
fn error_of(program: &Arc<Program>, settings: &Settings) -> f64 {
    let is_exact = settings.takes_exact_steps && program.system().linearity().is_some();
    if is_exact { settings.tolerance.min(EXACT) } else { settings.tolerance }
}

/// Data begin late where this many median steps pass before the first row, and this part of what they last:
/// a first sample one step after 0 is usual, and 20 steps of an hour in milliseconds hardly count.
const LATE_STEPS: f64 = 5.0;
const LATE_PART: f64 = 0.05;

/// Says where the simulation begins, if that is far from the data.
pub(super) fn note_start(comparison: &Comparison<'_>, notes: &mut Notes) {
    let finite = || comparison.x.iter().copied().filter(|x| x.is_finite());
    let first = finite().fold(f64::INFINITY, f64::min);
    let last = finite().fold(f64::NEG_INFINITY, f64::max);
    let start = comparison.start;
    let is_given = comparison.entry.start_time.is_some();
    let (before, lasts) = (first - start, last - first);
    if comparison.x_name != "time" || is_given || last <= first {
        return;
    }
    if before > lasts {
        notes.warn(format!(
            "{}: the data begin at {first} s and last {} s, but the simulation begins at \
             {start} s; if the initial values are those of {first} s, write `start_time = \
             {first}` in the experiment",
            comparison.experiment,
            significant(lasts, 6)
        ));
        return;
    }
    let is_late = time_axis::usual_step(finite()).is_some_and(|step| before > LATE_STEPS * step);
    if is_late && before > LATE_PART * lasts {
        let has_inputs = !comparison.entry.inputs.is_empty();
        let inputs = match has_inputs {
            true => " and inputs from columns are held at their first values until then",
            false => "",
        };
        let sentence = format!(
            "{}: the data begin at {first} s, but the simulation begins at {start} s: the initial values \
             are those of {start} s{inputs}; if they are those of {first} s, write `start_time = {first}` \
             in the experiment",
            comparison.experiment
        );
        match has_inputs {
            true => notes.warn(sentence),
            false => notes.add(sentence),
        }
    }
}

/// Says where the data end, if that is where the experiment of the model ends in another unit.
pub(super) fn note_stop(
    comparison: &Comparison<'_>,
    abscissa: &Abscissa,
    annotated: Option<f64>,
    notes: &mut Notes,
) {
    const UNITS: [(&str, &str, f64); 3] =
        [("min", "minutes", 60.0), ("h", "hours", 3600.0), ("d", "days", 86_400.0)];
    // Rows are seldom logged to the very end of the experiment.
    const NEAR: f64 = 0.02;
    let finite = comparison.x.iter().copied().filter(|x| x.is_finite());
    let last = finite.fold(f64::NEG_INFINITY, f64::max);
    if comparison.x_name != "time" || !last.is_finite() {
        return;
    }
    let has_unit = abscissa.entry.unit.is_some() || abscissa.column.about.unit.is_some();
    let is_near = |seconds: f64| {
        annotated.is_some_and(|stop| (last * seconds - stop).abs() <= NEAR * stop.abs())
    };
    let unit = UNITS.iter().find(|(.., seconds)| !has_unit && is_near(*seconds));
    if let (Some((unit, words, _)), Some(stop)) = (unit, annotated) {
        let name = abscissa.entry.column.as_ref().unwrap_or(&abscissa.name);
        notes.warn(format!(
            "{}: the data end at {last} s, the experiment of the model at {stop} s; if the times \
             are in {words}, write the unit after the name of the column: `{name} [{unit}]`",
            comparison.experiment
        ));
    }
}

/// Says that the simulation continues to the last row where the experiment has it end before.
pub(super) fn note_unused_stop(comparison: &Comparison<'_>, notes: &mut Notes) {
    let finite = comparison.x.iter().copied().filter(|x| x.is_finite());
    let last = finite.fold(f64::NEG_INFINITY, f64::max);
    let stop = comparison.entry.stop_time.filter(|stop| *stop < last);
    if let Some(stop) = stop.filter(|_| comparison.x_name == "time") {
        notes.warn(format!(
            "{}: `stop_time = {stop}` has no effect: the simulation ends with the last row, at {last} s; \
             to compare less, take the rows after {stop} s out of the file",
            comparison.experiment
        ));
    }
}

/// What a simulation may cost.
fn limit(
    session: &Session,
    entry: &ExperimentEntry,
    settings: &mut Settings,
) -> Result<(), Diagnostic> {
    if let Some(steps) = entry.max_steps {
        (settings.max_steps, settings.max_total_steps) = (steps, steps);
    }
    settings.time_budget = time_budget(session, entry)?;
    Ok(())
}

/// What a simulation may take of the clock. Where there is none, nothing is late.
///
/// # Errors
///
/// `max_seconds` that is not positive.
pub(super) fn time_budget(
    session: &Session,
    entry: &ExperimentEntry,
) -> Result<Option<TimeBudget>, Diagnostic> {
    let Some(seconds) = entry.max_seconds else { return Ok(None) };
    if seconds.is_nan() || seconds <= 0.0 {
        let fault = fault!(BAD_OPTION, "`max_seconds` is {seconds}; it must be positive");
        return Err(fault.at(entry.places.at(&["max_seconds"])));
    }
    Ok(session.world.clock().map(|clock| TimeBudget { seconds, clock }))
}

/// Over time, the simulation goes as far as it was measured.
fn stop_time(
    entry: &ExperimentEntry,
    x_name: &str,
    x: &[f64],
    annotated: Option<f64>,
) -> Option<f64> {
    let last = x.iter().copied().filter(|x| x.is_finite()).fold(f64::NEG_INFINITY, f64::max);
    match x_name == "time" && last.is_finite() {
        true => Some(entry.stop_time.or(annotated).unwrap_or(last).max(last)),
        false => entry.stop_time,
    }
}

/// Columns that are both an input and an output: the one follows from the other.
fn note_used_twice(entry: &ExperimentEntry, notes: &mut Notes) {
    for (input, column) in &entry.inputs {
        let column = column.entry().column.unwrap_or_else(|| input.clone());
        let same = |(name, own): &(&String, ColumnEntry)| {
            own.column.as_ref().unwrap_or(name).as_str() == column
        };
        if let Some((output, _)) = entry.all_outputs().find(same) {
            notes.warn(format!(
                "the column `{column}` is both the input `{input}` and the output `{output}`"
            ));
        }
    }
}

/// Two outputs of which each reads the column with the name of the other.
fn note_swapped(entry: &ExperimentEntry, notes: &mut Notes) {
    let column = |name: &str| entry.outputs.get(name)?.entry().column;
    for one in entry.outputs.keys() {
        let Some(other) = column(one).filter(|other| other != one) else { continue };
        if column(&other).as_deref() == Some(one) && *one < other {
            notes.warn(format!(
                "the output `{one}` reads the column `{other}` and `{other}` the column `{one}`: \
                 are they swapped?"
            ));
        }
    }
}

/// Ties X to a parameter of the class where it is an input of the model that nothing else drives.
fn drive(
    entry: &ExperimentEntry,
    flat: &FlatModel,
    (x_name, x): (&str, &[f64]),
    enclosing: &mut EnclosingClass,
) -> bool {
    let is_bound = entry.inputs.contains_key(x_name) || entry.set.values.contains_key(x_name);
    if is_bound || !static_curve::is_open_input(flat, x_name) {
        return false;
    }
    let typical = static_curve::typical(x);
    let driver = static_curve::DRIVER;
    let place = entry.places.at(&["x"]);
    enclosing.bind(x_name, enclosing_class::reference(driver, place), place);
    _ = writeln!(enclosing.declarations, "  parameter Real {driver} = {typical:e};");
    enclosing.elements.push((driver.to_owned(), x_name.to_owned()));
    true
}
