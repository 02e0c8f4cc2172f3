//! Translating and simulating models.

use super::imported_units::{self, ImportedUnit};
use super::inputs;
use super::methods::with_method_of_ours;
use super::{Args, Builtin, Failure, Family};
use crate::diag::{At, Diagnostic, Fault};
use crate::errors::{BAD_ARGUMENT, NO_TRANSLATED_MODEL};
use crate::fault;
use crate::flatten;
use crate::models::simulation;
use crate::models::simulation::{Simulated, SimulationOptions, Translated};
use crate::results::{self, ResultTable};
use crate::value::Value;
use crate::{Dialect, Session};
use std::path::PathBuf;
use std::sync::Arc;

/// Dymola's commands.
pub(super) const FAMILY: Family = Family {
    packages: &["DymolaCommands.SimulatorAPI"],
    dialect: Some(Dialect::Dymola),
    builtins: &[
        Builtin { header: SIMULATE_MODEL, run: simulate_model },
        Builtin { header: SIMULATE, run: simulate },
        Builtin { header: TRANSLATE_MODEL, run: translate_model },
        Builtin { header: CHECK_MODEL, run: check_model },
        Builtin { header: EXPERIMENT, run: experiment },
    ],
};

/// What `experiment` set for the simulations that say nothing else.
#[derive(Default)]
struct Experiment(SimulationOptions);

/// The settings of the last simulation, which `simulate()` repeats.
#[derive(Default)]
struct LastRun(SimulationOptions);

/// The next simulations begin at `start` and, where it is given, end at `stop`; the other settings
/// stay what they are.
pub(super) fn begin_at(session: &mut Session, start: f64, stop: Option<f64>) {
    let set = |options: &mut SimulationOptions| {
        options.start = Some(start);
        options.stop = stop.or(options.stop);
    };
    set(&mut session.extension::<Experiment>().0);
    set(&mut session.extension::<LastRun>().0);
}

/// What `simulateModel` and its relatives are asked for.
pub(super) struct Request {
    /// The model; empty for the one used last.
    pub problem: String,
    /// How it is simulated.
    pub options: SimulationOptions,
    /// The result file.
    pub file: String,
}

impl Request {
    /// The inputs that the headers of all of them begin with.
    pub(super) fn take(session: &mut Session, args: &mut Args) -> Result<Request, Fault> {
        let options = options(session, args)?;
        Ok(Request { options, problem: args.take("problem")?, file: args.take("resultFile")? })
    }

    /// The times of the output grid.
    pub(super) fn grid(&self, of: &Simulable) -> Result<Vec<f64>, Fault> {
        grid(&of.experiment(), &self.options)
    }
}

/// What can be simulated.
pub(super) enum Simulable {
    /// A model; its values are those that scripts set.
    Model(Arc<Translated>),
    /// A functional mock-up unit.
    Unit(ImportedUnit),
}

impl Simulable {
    fn experiment(&self) -> flatten::Experiment {
        match self {
            Simulable::Model(model) => model.program.experiment(),
            Simulable::Unit(unit) => unit.experiment(),
        }
    }

    /// Gives a parameter, or a variable with a start value, a value for the next simulations.
    pub(super) fn set(
        &mut self,
        session: &mut Session,
        name: &str,
        value: f64,
    ) -> Result<(), Fault> {
        match self {
            Simulable::Model(_) => session.set_parameter(name, value),
            Simulable::Unit(unit) => unit.set(name, value),
        }
    }

    /// Simulates and writes the result file.
    pub(super) fn run(
        &self,
        session: &mut Session,
        options: &SimulationOptions,
        file: &str,
    ) -> Result<Simulated, Vec<Diagnostic>> {
        match self {
            Simulable::Model(model) => run_model(session, model, options, file),
            Simulable::Unit(unit) => {
                let one = |error: Diagnostic| vec![error];
                let simulated = unit.simulate(session, options).map_err(|unfinished| {
                    one(unfinished
                        .kept(session, &result_path(file), |_, table| named_as_in_dymola(table)))
                })?;
                let written = write(session, simulated.table.clone(), file);
                written.at(session.call_site()).map_err(one)?;
                Ok(simulated)
            }
        }
    }
}

/// The times of the output grid.
fn grid(experiment: &flatten::Experiment, options: &SimulationOptions) -> Result<Vec<f64>, Fault> {
    let settings = simulation::settings(experiment, options)?;
    let point = |number| settings.output.point(settings.start, settings.stop, number);
    Ok((0..).map_while(point).collect())
}

const SIMULATE_MODEL: &str = inputs::header!(
    "simulateModel",
    "Simulates a model, after translation if necessary. Defaults come from the model's experiment annotation.",
    inputs::simulation!(),
    "  output Boolean ok;\n"
);

fn simulate_model(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let request = Request::take(session, &mut args)?;
    *session.extension::<LastRun>() = LastRun(request.options.clone());
    let done = run(session, &request.problem, &request.options, &request.file);
    Ok(session.or_report_all(done).is_some().into())
}

const SIMULATE: &str = r#"
function simulate "Simulates the model used last, with the settings of the last simulation or of `experiment`."
  output Boolean ok;
end simulate;
"#;

fn simulate(session: &mut Session, _: Args) -> Result<Value, Failure> {
    let options = session.extension::<LastRun>().0.clone();
    let done = run(session, "", &options, "dsres");
    Ok(session.or_report_all(done).is_some().into())
}

const TRANSLATE_MODEL: &str = r#"
function translateModel "Translates a model. Dotted names in the script then refer to its parameters, which have the values of the model."
  input String problem = "" "Class or Class(modification); empty: the model used last";
  output Boolean ok;
end translateModel;
"#;

fn translate_model(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let problem: String = args.take("problem")?;
    let done = problem_in_use(session, &problem)
        .and_then(|problem| simulation::translate_anew(session, &problem));
    let experiment = session.extension::<Experiment>().0.clone();
    *session.extension::<LastRun>() = LastRun(experiment);
    Ok(session.or_report_all(done).is_some().into())
}

const CHECK_MODEL: &str = r#"
function checkModel "Whether a model can be translated."
  input String problem "Class or Class(modification)";
  input Boolean simulate = false "whether to simulate it as well";
  output Boolean ok;
end checkModel;
"#;

fn check_model(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let problem: String = args.take("problem")?;
    let mut done = simulation::translated(session, &problem);
    if args.take("simulate")?
        && let Ok(model) = done
    {
        let simulated = simulation::simulate(session, &model, &SimulationOptions::default());
        done = simulated.map(|_| model).map_err(|unfinished| vec![unfinished.why]);
    }
    Ok(session.or_report_all(done).is_some().into())
}

const EXPERIMENT: &str = r#"
function experiment "Sets the defaults of the next simulations."
  input Real StartTime = 0.0 "s" annotation(optional = true);
  input Real StopTime = 1.0 "s" annotation(optional = true);
  input Integer NumberOfIntervals = 0 annotation(optional = true);
  input Real OutputInterval = 0.0 "s" annotation(optional = true);
  input String Algorithm = "" annotation(optional = true);
  input Real Tolerance = 0.0001 "relative" annotation(optional = true);
  input Real FixedStepSize = 0.0 "s" annotation(optional = true);
  output Boolean ok;
end experiment;
"#;

fn experiment(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let options = SimulationOptions {
        start: args.optional("StartTime")?,
        stop: args.optional("StopTime")?,
        intervals: set(args.optional("NumberOfIntervals")?),
        interval: set(args.optional("OutputInterval")?),
        method: args.optional("Algorithm")?.filter(|method: &String| !method.is_empty()),
        tolerance: args.optional("Tolerance")?,
        fixed_step: args.optional("FixedStepSize")?,
        ..SimulationOptions::default()
    };
    let options = with_method_of_ours(session, options);
    *session.extension::<LastRun>() = LastRun(options.clone());
    *session.extension::<Experiment>() = Experiment(options);
    Ok(true.into())
}

/// The arguments that all simulations share; what they leave open `experiment` may have said.
fn options(session: &mut Session, args: &mut Args) -> Result<SimulationOptions, Fault> {
    let before = session.extension::<Experiment>().0.clone();
    let method: Option<String> = args.optional("method")?;
    // What the call itself says goes before what `experiment` has said.
    let own = set(args.optional("numberOfIntervals")?);
    let interval = set(args.optional("outputInterval")?);
    let intervals = if interval.is_some() { own } else { own.or(before.intervals) };
    let options = SimulationOptions {
        start: args.optional("startTime")?.or(before.start),
        stop: args.optional("stopTime")?.or(before.stop),
        intervals,
        interval: interval.or(before.interval),
        method: method.filter(|method| !method.is_empty()).or(before.method),
        tolerance: args.optional("tolerance")?.or(before.tolerance),
        fixed_step: args.optional("fixedstepsize")?.or(before.fixed_step),
        ..SimulationOptions::default()
    };
    Ok(with_method_of_ours(session, options))
}

/// A number that is given; 0 stands for none.
fn set<T: Default + PartialEq>(number: Option<T>) -> Option<T> {
    number.filter(|number| *number != T::default())
}

/// The problem itself, or where it is empty that of the model used last.
pub(super) fn problem_in_use(session: &Session, problem: &str) -> Result<String, Vec<Diagnostic>> {
    if !problem.trim().is_empty() {
        return Ok(problem.trim().to_owned());
    }
    let last = session.last_model().ok_or_else(|| {
        let fault = Fault::new(NO_TRANSLATED_MODEL, "no model has been translated yet")
            .help("name the model: `simulateModel(\"Package.Model\")`");
        vec![fault.at(session.call_site())]
    });
    last.map(|last| last.problem.clone())
}

/// The model of a problem, translated if need be, or the unit that was imported under its name.
fn simulable(session: &mut Session, problem: &str) -> Result<Simulable, Vec<Diagnostic>> {
    if let Some(unit) = imported_units::unit_of(session, problem)? {
        return Ok(Simulable::Unit(unit));
    }
    let problem = problem_in_use(session, problem)?;
    simulation::translate(session, &problem).map(Simulable::Model)
}

/// What a problem means; `None` if it cannot be translated, which has been reported.
pub(super) fn to_simulate(session: &mut Session, problem: &str) -> Option<Simulable> {
    let done = simulable(session, problem);
    session.or_report_all(done)
}

/// Whether a problem is a model, which is translated now; what is wrong has been reported.
pub(super) fn is_model(session: &mut Session, problem: &str) -> bool {
    match to_simulate(session, problem) {
        Some(Simulable::Model(_)) => true,
        Some(Simulable::Unit(_)) => {
            let fault = fault!(BAD_ARGUMENT, "`{problem}` is an FMU, which is not linearized here";
                help: "linearize the Modelica model that it was made of");
            session.report_fault(fault);
            false
        }
        None => false,
    }
}

fn run(
    session: &mut Session,
    problem: &str,
    options: &SimulationOptions,
    file: &str,
) -> Result<Simulated, Vec<Diagnostic>> {
    simulable(session, problem)?.run(session, options, file)
}

/// Simulates a model and writes the result file.
fn run_model(
    session: &mut Session,
    model: &Translated,
    options: &SimulationOptions,
    file: &str,
) -> Result<Simulated, Vec<Diagnostic>> {
    let (at, one) = (session.call_site(), |error: Diagnostic| vec![error]);
    let done = simulation::simulate(session, model, options);
    let grid = grid(&model.program.experiment(), options).at(at).map_err(one)?;
    match done {
        Ok(simulated) => {
            let table = super::output::stored(session, model, &simulated.table, &grid);
            write(session, table, file).at(at).map_err(one)?;
            super::final_states::write_final(session);
            Ok(simulated)
        }
        Err(unfinished) => {
            Err(one(unfinished.kept(session, &result_path(file), |session, table| {
                let last = table.time.last().copied().unwrap_or(f64::NEG_INFINITY);
                let grid = &grid[..grid.partition_point(|time| *time <= last)];
                named_as_in_dymola(super::output::stored(session, model, &table, grid))
            })))
        }
    }
}

/// The path of a result file; without an ending that names a format, `.mat` is added.
pub(super) fn result_path(file: &str) -> PathBuf {
    match results::format_of_file(file) {
        Ok(_) if file.contains('.') => PathBuf::from(file),
        _ => PathBuf::from(format!("{file}.mat")),
    }
}

/// Results whose time has the name that it has in Dymola's result files.
fn named_as_in_dymola(mut table: ResultTable) -> ResultTable {
    table.time_name = "Time".to_owned();
    table
}

/// Writes a result file.
fn write(session: &mut Session, table: ResultTable, file: &str) -> Result<(), Fault> {
    let path = result_path(file);
    let format = results::format_of_file(&path.to_string_lossy())?;
    session.world.write_results(&path, format.as_ref(), &named_as_in_dymola(table))?;
    super::last_results::note_results(session, &path.to_string_lossy());
    Ok(())
}
