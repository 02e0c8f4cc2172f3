//! Models as functional mock-up units.
//!
//! The program of a unit is compiled for it. Its continuous inputs at the top level are states whose
//! derivative is zero, which the importer sets: so event indicators and the exact Jacobian see them as
//! they see states. Other inputs are recorded ones with one sample. A fixed start value is a parameter
//! of its own, so that an importer may set it.

use super::simulation::{self, Translated};
use crate::Session;
use crate::causalize;
use crate::codegen::Program;
use crate::diag::{At, Diagnostic, Fault};
use crate::errors::FILE_ERROR;
use crate::fault;
use crate::flatten::{Attribute, BaseType, FlatModel, RecordedInput, Variability, Variable};
use crate::lower::errors::NOT_SUPPORTED;
use crate::source::{SourceId, Span};
use crate::syntax;
use crate::syntax::ast::{
    CausalityPrefix, Comment, Equation, EquationKind, Expression, ExpressionKind,
};
use gapilib_fmi::description::Version;
use gapilib_fmi::export::{Input, Kinds, Model, Unit};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// What becomes of the variables of a model in a unit.
#[derive(Default)]
struct Made {
    inputs: BTreeMap<String, Input>,
    starts: BTreeMap<String, String>,
    hidden: BTreeSet<String>,
    /// Inputs, each with the parameter that is its derivative.
    rates: Vec<(String, String)>,
    quantities: BTreeMap<String, String>,
    description: Option<String>,
}

/// Translates a model whose inputs an importer gives values.
///
/// # Errors
/// What is wrong with the model.
pub fn translate(session: &mut Session, problem: &str) -> Result<(), Vec<Diagnostic>> {
    session.models.inputs_come_later = true;
    let translated = simulation::translate(session, problem);
    session.models.inputs_come_later = false;
    translated.map(|_| ())
}

/// The unit of a model, as scripts have changed it.
///
/// # Errors
/// What is wrong with the model; what it does that units cannot, with the place.
pub fn unit(
    session: &mut Session,
    problem: &str,
    version: Version,
    kinds: Kinds,
) -> Result<Unit, Vec<Diagnostic>> {
    translate(session, problem)?;
    let before = session.current_values();
    let mut made = Made::default();
    let varied =
        session.vary_current(|model, flat| prepared(model, flat.clone(), &mut made).map(Some));
    let unit = varied.and_then(|model| {
        let at = session.call_site();
        of_program(session, problem, &model, &made, version, kinds)
            .map_err(|fault| vec![fault.at(at)])
    });
    session.restore_values(before);
    unit
}

/// The archive of the unit of a model, as scripts have changed it.
///
/// # Errors
/// As those of [`unit()`]; the runtime of units is missing beside the program.
pub fn exported(
    session: &mut Session,
    problem: &str,
    version: Version,
    kinds: Kinds,
) -> Result<Vec<u8>, Vec<Diagnostic>> {
    let unit = unit(session, problem, version, kinds)?;
    let at = session.call_site();
    let runtime = session.world.unit_runtime().map_err(|error| {
        let fault = fault!(
            FILE_ERROR,
            "the runtime of units cannot be read: {error}";
            help: "it lies beside the program, or where the environment variable GAPILIB_FMU_RUNTIME \
                   says: unpack the whole release, or build all packages of the workspace"
        );
        vec![fault.at(at)]
    })?;
    let archive = unit.archive(&runtime).at(at).map_err(|error| vec![error])?;
    archive.to_bytes().map_err(|error| vec![Fault::new(NOT_SUPPORTED, error.to_string()).at(at)])
}

fn of_program(
    session: &mut Session,
    problem: &str,
    model: &Arc<Translated>,
    made: &Made,
    version: Version,
    kinds: Kinds,
) -> Result<Unit, Fault> {
    let program = &model.program;
    if let Some((what, span)) = program.needs_past() {
        let place = session.sources.location(span);
        return Err(fault!(
            NOT_SUPPORTED,
            "`{problem}` cannot be exported: {what} ({place}) needs values of the past, which a unit \
             does not keep";
            help: "replace it, such as by a first-order element"
        ));
    }
    for (input, rate) in &made.rates {
        if program.find_parameter(rate).is_ok_and(|at| program.reads_parameter_twice(at)) {
            return Err(reads_derivative(input));
        }
    }
    let values = session.values_set_by_hand();
    let values = values
        .iter()
        .filter_map(|(name, value)| Some((program.find_parameter(name).ok()?, *value)));
    let exported = Model {
        program,
        name: problem,
        description: made.description.as_deref(),
        inputs: made.inputs.clone(),
        starts: made.starts.clone(),
        hidden: made.hidden.clone(),
        quantities: made.quantities.clone(),
        values: values.collect(),
    };
    Unit::new(&exported, version, kinds)
}

/// The model of a unit.
fn prepared(
    model: &Translated,
    mut flat: FlatModel,
    made: &mut Made,
) -> Result<Translated, Diagnostic> {
    made.description = flat.description.as_deref().map(str::to_owned);
    let all: Vec<Variable> = flat.variables.values().cloned().collect();
    for variable in &all {
        if let Some(quantity) = quantity(variable) {
            for name in element_names(variable) {
                made.quantities.insert(name, quantity.clone());
            }
        }
        let is_input =
            variable.causality == Some(CausalityPrefix::Input) && variable.binding.is_none();
        let is_real = variable.base == BaseType::Real;
        let is_continuous = is_real && variable.variability == Variability::Continuous;
        match (is_input, is_continuous) {
            (true, true) => input_state(&mut flat, variable, made)?,
            (true, false) => recorded(&mut flat, variable, made)?,
            (false, true) => start_parameter(&mut flat, variable, made),
            (false, false) => {}
        }
    }
    let program = Program::compile(causalize::causalize(&flat)?)?;
    Ok(Translated::new(&model.problem, flat, program))
}

/// What a variable measures.
fn quantity(variable: &Variable) -> Option<String> {
    match &variable.attributes.get("quantity")?.value.kind {
        ExpressionKind::String(text) => Some(text.to_string()).filter(|text| !text.is_empty()),
        _ => None,
    }
}

fn literal(kind: ExpressionKind) -> Attribute {
    Attribute { value: Expression::new(kind, Span::NONE), is_final: false }
}

/// A parameter with the start value of a variable, and the expression that refers to it.
fn parameter(
    flat: &mut FlatModel,
    of: &Variable,
    what: &str,
    made: &mut Made,
) -> Option<(String, Expression)> {
    let name = format!("'{what} of {}'", of.name.replace('\'', "\""));
    let reference = syntax::parse_expression(SourceId::NONE, &name).ok()?;
    let shared: Arc<str> = name.as_str().into();
    let mut own = Variable {
        name: shared.clone(),
        causality: None,
        is_input: false,
        variability: Variability::Parameter,
        protected: false,
        description: None,
        binding: None,
        ..of.clone()
    };
    own.attributes.retain(|name, _| *name == "unit");
    made.hidden.insert(name.clone());
    made.hidden.extend(element_names(&own));
    flat.variables.insert(shared, own);
    Some((name, reference))
}

/// An input becomes a state: der(u) = rate, a parameter that is zero.
fn input_state(flat: &mut FlatModel, input: &Variable, made: &mut Made) -> Result<(), Diagnostic> {
    let unreadable = || fault!(NOT_SUPPORTED, "`{}` cannot be an input", input.name).at(input.span);
    let filled = |value: &str| {
        let sizes: String = input.dims.iter().map(|size| format!(", {size}")).collect();
        let text =
            if sizes.is_empty() { value.to_owned() } else { format!("fill({value}{sizes})") };
        syntax::parse_expression(SourceId::NONE, &text).map_err(|_| unreadable())
    };
    if flat.to_string().contains(&format!("der({})", input.name)) {
        return Err(reads_derivative(&input.name).at(input.span));
    }
    let start = match input.attributes.get("start").map(|start| &start.value) {
        None => filled("0.0")?,
        // One number for all elements.
        Some(one) if is_number(one) => filled(&syntax::print::expression(one))?,
        Some(all) => all.clone(),
    };
    let (start_name, start_value) = parameter(flat, input, "start", made).ok_or_else(unreadable)?;
    let (rate_name, rate) = parameter(flat, input, "rate", made).ok_or_else(unreadable)?;
    for (name, value) in [(&start_name, start), (&rate_name, filled("0.0")?)] {
        if let Some(own) = flat.variables.get_mut(name.as_str()) {
            own.binding = Some(value);
        }
    }
    let always = literal(ExpressionKind::Integer(crate::lower::StateSelect::Always as i64 + 1));
    let mut state = Variable { causality: None, is_input: false, ..input.clone() };
    state.attributes.insert("fixed", literal(ExpressionKind::Boolean(true)));
    state.attributes.insert("stateSelect", always);
    state.attributes.insert("start", Attribute { value: start_value, is_final: false });
    flat.variables.insert(input.name.clone(), state);
    let derivative = syntax::parse_expression(SourceId::NONE, &format!("der({})", input.name));
    let left = derivative.map_err(|_| unreadable())?;
    let kind = EquationKind::Equal { left, right: rate };
    flat.equations.push(Equation { kind, comment: Comment::default(), span: input.span });
    for name in element_names(input) {
        let of = |parameter: &str| format!("{parameter}{}", &name[input.name.len()..]);
        made.rates.push((name.clone(), of(&rate_name)));
        made.inputs.insert(name.clone(), Input::State(of(&start_name)));
    }
    Ok(())
}

fn is_number(e: &Expression) -> bool {
    match &e.kind {
        ExpressionKind::Real(_) | ExpressionKind::Integer(_) => true,
        ExpressionKind::Unary { operand, .. } => is_number(operand),
        _ => false,
    }
}

fn reads_derivative(input: &str) -> Fault {
    fault!(
        NOT_SUPPORTED,
        "the model cannot be exported: something depends on the derivative of its input `{input}`";
        help: "make the derivative an input of its own"
    )
}

fn array(input: &Variable) -> Diagnostic {
    fault!(
        NOT_SUPPORTED,
        "the input `{}` is an array, and does not vary continuously", input.name;
        help: "declare an input for each element"
    )
    .at(input.span)
}

/// An input that changes at events alone.
fn recorded(flat: &mut FlatModel, input: &Variable, made: &mut Made) -> Result<(), Diagnostic> {
    if !input.dims.is_empty() {
        return Err(array(input));
    }
    let first = match &input.base {
        BaseType::Enumeration(_) => 1.0,
        BaseType::Real | BaseType::Integer | BaseType::Boolean => 0.0,
        BaseType::String | BaseType::ExternalObject(_) | BaseType::Clock => {
            let name = &input.name;
            let fault = fault!(NOT_SUPPORTED, "the input `{name}` is not a number";
                help: "make it a parameter");
            return Err(fault.at(input.span));
        }
    };
    let start = match input.attributes.get("start").map(|start| &start.value.kind) {
        Some(ExpressionKind::Integer(value)) => *value as f64,
        Some(ExpressionKind::Real(value)) => *value,
        Some(ExpressionKind::Boolean(value)) => f64::from(u8::from(*value)),
        _ => first,
    };
    flat.recorded.push(RecordedInput {
        name: input.name.clone(),
        times: [0.0].into(),
        values: [start].into(),
        is_held: true,
    });
    made.inputs.insert(input.name.to_string(), Input::Recorded(start));
    Ok(())
}

/// A fixed start value that an importer may set.
fn start_parameter(flat: &mut FlatModel, variable: &Variable, made: &mut Made) {
    let is_true =
        |attribute: &Attribute| matches!(attribute.value.kind, ExpressionKind::Boolean(true));
    let is_fixed = variable.attributes.get("fixed").is_some_and(is_true);
    let start = variable.attributes.get("start").filter(|start| !start.is_final);
    let (Some(start), true, []) = (start, is_fixed, &variable.dims[..]) else { return };
    let Some((name, reference)) = parameter(flat, variable, "start", made) else { return };
    if let Some(own) = flat.variables.get_mut(name.as_str()) {
        own.binding = Some(start.value.clone());
    }
    if let Some(own) = flat.variables.get_mut(&variable.name) {
        own.attributes.insert("start", Attribute { value: reference, is_final: false });
    }
    made.starts.insert(variable.name.to_string(), name);
}

/// The scalars of a variable, row-major.
fn element_names(variable: &Variable) -> Vec<String> {
    let mut names = vec![variable.name.to_string()];
    for (at, size) in variable.dims.iter().enumerate() {
        let extended = |before: &String| {
            let begin = if at == 0 { format!("{before}[") } else { before.replace(']', ",") };
            (1..=*size).map(move |i| format!("{begin}{i}]")).collect::<Vec<_>>()
        };
        names = names.iter().flat_map(extended).collect();
    }
    names
}
