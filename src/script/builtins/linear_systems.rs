//! The functions of `Modelica_LinearSystems2` that scripts call, and pictures of responses.

use super::{Args, Builtin, Failure, Family};
use crate::diag::{Diagnostic, Fault};
use crate::models::exported;
use crate::models::linear::{Linear, Number, frequencies, responding};
use crate::models::linearization::linearized;
use crate::models::simulation::SimulationOptions;
use crate::name::{Ident, Name};
use crate::plot::{self, Axis, Figure, Mark, Picture, Series};
use crate::registry::BAD_OPTION;
use crate::value::{RealMatrix, RecordValue, Value};
use crate::{Session, fault};
use indexmap::IndexMap;
use nalgebra::DMatrix;
use std::path::Path;

/// The analysis of models.
pub(super) const FAMILY: Family = Family {
    packages: &["Modelica_LinearSystems2.ModelAnalysis"],
    dialect: None,
    builtins: &[
        Builtin { header: LINEARIZE, run: linearize },
        Builtin { header: POLES, run: poles },
        Builtin { header: TRANSFER_FUNCTIONS, run: transfer_functions },
    ],
};

/// Its settings.
pub(super) const RECORDS: Family = Family {
    packages: &["Modelica_LinearSystems2.Records"],
    dialect: None,
    builtins: &[Builtin { header: SETUP, run: setup }],
};

/// Commands of our own.
pub(super) const PICTURES: Family = Family {
    packages: &["GAPILib"],
    dialect: None,
    builtins: &[
        Builtin { header: BODE, run: bode },
        Builtin { header: PLOT_NYQUIST, run: plot_nyquist },
    ],
};

/// Frequencies of pictures for each decade.
const PER_DECADE: f64 = 40.0;

const SETUP: &str = r#"
function SimulationOptionsForLinearization "Where a model is linearized."
  input Boolean linearizeAtInitial = true "where it starts";
  input Real t_start = 0.0 "s";
  input Real t_linearize = 0.0 "s; where it is linearized otherwise";
  input String method = "Dassl" annotation(optional = true);
  input Real tolerance = 1e-4 "relative" annotation(optional = true);
  input Real fixedStepSize = 0.001 "has no effect";
  output Any simulationSetup;
end SimulationOptionsForLinearization;
"#;

fn setup(_: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let at_start: bool = args.take("linearizeAtInitial")?;
    let (start, at): (f64, f64) = (args.take("t_start")?, args.take("t_linearize")?);
    let fields = [
        ("t_start", start.into()),
        ("t_linearize", (if at_start { start } else { at }).into()),
        ("method", args.optional::<String>("method")?.unwrap_or_default().into()),
        ("tolerance", args.optional::<f64>("tolerance")?.unwrap_or(0.0).into()),
    ];
    Ok(record("SimulationOptionsForLinearization", fields))
}

fn record<const N: usize>(name: &str, fields: [(&'static str, Value); N]) -> Value {
    let fields = fields.into_iter().map(|(name, value)| (Ident::new(name), value));
    Value::Record(RecordValue {
        type_name: Name::parse(name),
        fields: fields.collect::<IndexMap<Ident, Value>>(),
    })
}

/// The model of a call, linearized with the settings of the call.
fn linear_model(
    session: &mut Session,
    model: &str,
    setup: Option<Value>,
    outputs: &[String],
) -> Result<Linear, Failure> {
    let mut options = SimulationOptions { stop: Some(0.0), ..SimulationOptions::default() };
    match setup {
        Some(Value::Record(setup)) => {
            let number = |name: &str| match setup.fields.get(&Ident::new(name)) {
                Some(Value::Real(value)) => Some(*value),
                _ => None,
            };
            options.start = number("t_start");
            options.stop = number("t_linearize");
            options.tolerance = number("tolerance").filter(|own| *own > 0.0);
            if let Some(Value::String(method)) = setup.fields.get(&Ident::new("method")) {
                options.method = Some(method.to_string()).filter(|own| !own.is_empty());
            }
        }
        Some(Value::Real(time)) => options.stop = Some(time),
        _ => {}
    }
    exported::translate(session, model)?;
    Ok(linearized(session, &options, outputs)?)
}

const LINEARIZE: &str = r#"
function Linearize "Linearizes a model; its matrices A, B, C, D and the names of u, y and x."
  input String modelName "Class or Class(modification)";
  input Any simulationSetup "SimulationOptionsForLinearization; default: where it starts" annotation(optional = true);
  output Any ss;
end Linearize;
"#;

fn linearize(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let model: String = args.take("modelName")?;
    let setup = args.optional::<Value>("simulationSetup")?;
    let linear = linear_model(session, &model, setup, &[])?;
    let [x, u, y] = linear.names.clone();
    let [a, b, c, d] = linear.matrices()?.map(matrix);
    let names = [("yNames", y.into()), ("xNames", x.into()), ("uNames", u.into())];
    let [y, x, u] = names;
    Ok(record("StateSpace", [("A", a), ("B", b), ("C", c), ("D", d), y, x, u]))
}

fn matrix(own: &DMatrix<f64>) -> Value {
    let elements = own.transpose().iter().copied().collect();
    Value::from(RealMatrix { rows: own.nrows(), columns: own.ncols(), elements })
}

const POLES: &str = r#"
function Poles "The poles of a linearized model, slowest first."
  input String modelName "Class or Class(modification)";
  input Any simulationSetup "SimulationOptionsForLinearization; default: where it starts" annotation(optional = true);
  output Any eigenvalues "Real[:,2]: real and imaginary parts";
end Poles;
"#;

fn poles(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let model: String = args.take("modelName")?;
    let setup = args.optional::<Value>("simulationSetup")?;
    let linear = linear_model(session, &model, setup, &[])?;
    let poles = poles_of(&linear, &model)?;
    let elements = poles.iter().flat_map(|own| [own.re, own.im]).collect();
    Ok(Value::from(RealMatrix { rows: poles.len(), columns: 2, elements }))
}

fn poles_of(linear: &Linear, model: &str) -> Result<Vec<Number>, Fault> {
    linear.poles().ok_or_else(|| {
        fault!(BAD_OPTION, "the poles of `{model}` cannot be computed: its matrix A is not finite")
    })
}

const TRANSFER_FUNCTIONS: &str = r#"
function TransferFunctions "Draws the Bode plots of a linearized model, from each input to each output."
  input String modelName "Class or Class(modification)";
  input Any simulationSetup "SimulationOptionsForLinearization; default: where it starts" annotation(optional = true);
end TransferFunctions;
"#;

fn transfer_functions(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let model: String = args.take("modelName")?;
    let setup = args.optional::<Value>("simulationSetup")?;
    drawn(session, &Asked { model, setup, output: String::new() }, "bode.svg", bode_plot)?;
    Ok(Value::Tuple(Vec::new()))
}

const BODE: &str = r#"
function bode "Draws magnitude and phase of the responses of a model to its inputs."
  input String problem "Class or Class(modification)";
  input String variable = "" "any variable; empty: the outputs of the model";
  input Real time = 0.0 "s; where it is linearized";
  input String fileName = "bode.svg" ".svg, .png or .pdf, in the output folder";
  output Boolean ok;
end bode;
"#;

fn bode(session: &mut Session, args: Args) -> Result<Value, Failure> {
    own_picture(session, args, bode_plot)
}

const PLOT_NYQUIST: &str = r#"
function plotNyquist "Draws the responses of a model to its inputs in the plane of complex numbers, the imaginary part downwards."
  input String problem "Class or Class(modification)";
  input String variable = "" "any variable; empty: the outputs of the model";
  input Real time = 0.0 "s; where it is linearized";
  input String fileName = "nyquist.svg" ".svg, .png or .pdf, in the output folder";
  output Boolean ok;
end plotNyquist;
"#;

fn plot_nyquist(session: &mut Session, args: Args) -> Result<Value, Failure> {
    own_picture(session, args, nyquist)
}

/// What is drawn.
struct Asked {
    model: String,
    setup: Option<Value>,
    output: String,
}

/// Frequencies, and responses with their names.
type Drawing = fn(&[f64], &[(String, Vec<Number>)]) -> Figure;

fn own_picture(session: &mut Session, mut args: Args, drawing: Drawing) -> Result<Value, Failure> {
    let (model, output) = (args.take("problem")?, args.take("variable")?);
    let time: f64 = args.take("time")?;
    let file: String = args.take("fileName")?;
    let asked = Asked { model, setup: Some(time.into()), output };
    let done = drawn(session, &asked, &file, drawing);
    let done = done.map_err(|failure| match failure {
        Failure::Here(fault) => vec![fault.at(session.call_site())],
        Failure::Elsewhere(errors) => errors,
    });
    let done: Result<(), Vec<Diagnostic>> = done;
    Ok(session.or_report_all(done).is_some().into())
}

/// Writes a picture of all responses.
fn drawn(
    session: &mut Session,
    asked: &Asked,
    file: &str,
    drawing: Drawing,
) -> Result<(), Failure> {
    let picture = Picture::of(Path::new(file))?;
    let outputs: Vec<String> =
        Some(asked.output.clone()).filter(|own| !own.is_empty()).into_iter().collect();
    let linear = linear_model(session, &asked.model, asked.setup.clone(), &outputs)?;
    let poles = poles_of(&linear, &asked.model)?;
    let at = frequencies([None, None], PER_DECADE, &poles)?;
    let responses = linear.responses(&at)?;
    session
        .world
        .write_result_file(Path::new(file), &drawing(&at, &responses).picture(picture)?)?;
    Ok(())
}

fn bode_plot(at: &[f64], responses: &[(String, Vec<Number>)]) -> Figure {
    let all: Vec<plot::Responding> =
        responses.iter().map(|(name, values)| responding(name, values)).collect();
    plot::bode(at, &all)
}

fn nyquist(_: &[f64], responses: &[(String, Vec<Number>)]) -> Figure {
    let one = |(place, (name, values)): (usize, &(String, Vec<Number>))| Series {
        name: name.clone(),
        x: values.iter().map(|own| own.re).collect(),
        y: values.iter().map(|own| -own.im).collect(),
        mark: Mark::Line,
        colour: place + 1,
    };
    let all = responses.iter().enumerate().map(one).collect();
    Figure::plane(Axis::linear("real part", ""), Axis::linear("\u{2212}imaginary part", ""), all)
}
