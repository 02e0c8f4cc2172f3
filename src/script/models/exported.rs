//! Models as functional mock-up units.
//!
//! The program of a unit is compiled for it. Its continuous inputs at the top level are states whose
//! derivative is zero, which the importer sets: so event indicators and the exact Jacobian see them as
//! they see states. Other inputs are recorded ones with one sample. The start value of an input, and a
//! fixed one of another variable, is a parameter of its own, so that an importer may set it. Strings are
//! constants: for another value a model is translated again.

use super::simulation::{self, Translated};
use crate::Session;
use crate::causalize;
use crate::codegen::errors::STRUCTURAL_PARAMETER;
use crate::codegen::{Program, is_reader};
use crate::diag::{At, Diagnostic, Fault, suggest};
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
use gapilib_fmi::export::{Input, Kinds, Model, Text, Unit};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// What a unit is to be.
#[derive(Debug, Clone, Copy)]
pub struct Form<'n> {
    /// The version of the standard.
    pub version: Version,
    /// Who integrates.
    pub kinds: Kinds,
    /// The name of the model in the unit; that of the class if there is none.
    pub name: Option<&'n str>,
}

/// What becomes of the variables of a model in a unit.
#[derive(Default)]
struct Made {
    inputs: BTreeMap<String, MadeInput>,
    starts: BTreeMap<String, String>,
    hidden: BTreeSet<String>,
    /// Inputs, each with the parameter that is its derivative.
    rates: Vec<(String, String)>,
    quantities: BTreeMap<String, String>,
    strings: BTreeMap<String, Text>,
    /// Strings that are not in the unit.
    left_out: Vec<String>,
    /// Structural parameters, and those with `Evaluate = true`, that are neither final nor protected.
    evaluated: Vec<String>,
    description: Option<String>,
}

/// What becomes of an input.
struct MadeInput {
    /// Whether it is a state, or a recorded input.
    is_state: bool,
    /// The parameter that holds its start value; none where it has the default of its type.
    start: Option<String>,
    default: f64,
}

/// Translates a model whose inputs an importer gives values, or deviations.
///
/// # Errors
/// What is wrong with the model.
pub fn translate(session: &mut Session, problem: &str) -> Result<(), Vec<Diagnostic>> {
    with_inputs_to_come(session, |session| simulation::translate(session, problem)).map(|_| ())
}

/// Does something without warnings of inputs that have no data: they are given values later, or
/// deviations.
pub(crate) fn with_inputs_to_come<T>(
    session: &mut Session,
    act: impl FnOnce(&mut Session) -> T,
) -> T {
    let before = std::mem::replace(&mut session.models.inputs_come_later, true);
    let done = act(session);
    session.models.inputs_come_later = before;
    done
}

/// The unit of a model, as scripts have changed it.
///
/// # Errors
/// What is wrong with the model; what it does that units cannot, with the place.
pub fn unit(session: &mut Session, problem: &str, form: Form<'_>) -> Result<Unit, Vec<Diagnostic>> {
    translate(session, problem)?;
    let before = session.models.current.clone();
    let mut made = Made::default();
    let varied =
        session.vary_current(|model, flat| prepared(model, flat.clone(), &mut made).map(Some));
    let unit = varied.and_then(|model| {
        let at = session.call_site();
        of_program(session, (problem, &model), &made, form).at(at).map_err(|error| vec![error])
    });
    session.models.current = before;
    if unit.is_ok() {
        note_losses(session, &made);
    }
    unit
}

/// Notes what a user of the model could set and a user of its unit cannot.
fn note_losses(session: &mut Session, made: &Made) {
    let listed = |names: &[String]| {
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        suggest::listed(&names)
    };
    if !made.left_out.is_empty() {
        let names = listed(&made.left_out);
        let message =
            format!("the unit has no {names}: Strings are in it where they are written as a text");
        session.note(NOT_SUPPORTED, message);
    }
    if !made.evaluated.is_empty() {
        let names = listed(&made.evaluated);
        let message = format!(
            "constant in the unit are {names}: they are structural or have `Evaluate=true`; for other \
             values, modify the model and export it again"
        );
        session.note(STRUCTURAL_PARAMETER, message);
    }
}

/// The archive of the unit of a model, as scripts have changed it.
///
/// # Errors
/// As those of [`unit()`]; the runtime of units is missing beside the program.
pub fn exported(
    session: &mut Session,
    problem: &str,
    form: Form<'_>,
) -> Result<Vec<u8>, Vec<Diagnostic>> {
    let unit = unit(session, problem, form)?;
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
    if !is_reader(&runtime) {
        let fault = fault!(FILE_ERROR, "the runtime of units is not of this program: it would refuse the unit";
            help: "unpack the whole release, or build all packages of the workspace");
        return Err(vec![fault.at(at)]);
    }
    let archive = unit.archive(&runtime).at(at).map_err(|error| vec![error])?;
    archive.to_bytes().map_err(|error| vec![Fault::new(NOT_SUPPORTED, error.to_string()).at(at)])
}

fn of_program(
    session: &mut Session,
    (problem, model): (&str, &Arc<Translated>),
    made: &Made,
    form: Form<'_>,
) -> Result<Unit, Fault> {
    let program = &model.program;
    for (input, rate) in &made.rates {
        if program.find_parameter(rate).is_ok_and(|at| program.reads_parameter_twice(at)) {
            return Err(reads_derivative(input));
        }
    }
    let values = session.models.values_set_by_hand();
    let values = values
        .iter()
        .filter_map(|(name, value)| Some((program.find_parameter(name).ok()?, *value)));
    let exported = Model {
        program,
        name: problem,
        unit_name: form.name.unwrap_or(problem),
        description: made.description.as_deref(),
        inputs: inputs(session, model, made)?,
        starts: made.starts.clone(),
        hidden: made.hidden.clone(),
        quantities: made.quantities.clone(),
        strings: made.strings.clone(),
        values: values.collect(),
    };
    Unit::new(&exported, form.version, form.kinds)
}

/// The inputs with the start values that follow from the parameters as scripts have set them.
fn inputs(
    session: &mut Session,
    model: &Arc<Translated>,
    made: &Made,
) -> Result<BTreeMap<String, Input>, Fault> {
    let mut all = BTreeMap::new();
    for (name, own) in &made.inputs {
        let start = match &own.start {
            None => own.default,
            Some(parameter) => {
                let found = session.numbers_of(model, std::slice::from_ref(parameter));
                let found = found.map_err(|error| Fault::new(error.code, error.message.clone()))?;
                found.and_then(|numbers| numbers.first().copied()).ok_or_else(|| {
                    fault!(NOT_SUPPORTED, "the start value of the input `{name}` cannot be computed";
                        help: "write it as a number")
                })?
            }
        };
        let input = match (own.is_state, &own.start) {
            (true, Some(parameter)) => Input::State { parameter: parameter.clone(), start },
            _ => Input::Recorded(start),
        };
        all.insert(name.clone(), input);
    }
    Ok(all)
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
            (false, _) if variable.base == BaseType::String => text(variable, made),
            (false, _) if variable.variability > Variability::Parameter => {
                start_parameter(&mut flat, variable, made);
            }
            (false, _) if is_evaluated(variable) => made.evaluated.push(variable.name.to_string()),
            (false, _) => {}
        }
    }
    let program = Program::compile(causalize::causalize(&flat)?)?;
    Ok(Translated::new(&model.problem, flat, program))
}

/// Whether a parameter that a user could set is evaluated when the model is compiled.
fn is_evaluated(variable: &Variable) -> bool {
    let is_settable = !variable.is_final && !variable.protected;
    let is_parameter = variable.variability == Variability::Parameter;
    is_parameter && is_settable && (variable.evaluate || variable.structural)
}

/// A String, which is a constant where it is written as a text.
fn text(variable: &Variable, made: &mut Made) {
    let value = variable.binding.as_ref().map(|binding| &binding.kind);
    match (value, &variable.dims[..]) {
        _ if variable.protected => {}
        (Some(ExpressionKind::String(value)), [])
            if variable.variability <= Variability::Parameter =>
        {
            let description = variable.description.as_ref().map(ToString::to_string);
            let text = Text { value: value.to_string(), description };
            made.strings.insert(variable.name.to_string(), text);
        }
        _ => made.left_out.push(variable.name.to_string()),
    }
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
    let filled = |value: &str| filled(value, &input.dims).ok_or_else(unreadable);
    if flat.to_string().contains(&format!("der({})", input.name)) {
        return Err(reads_derivative(&input.name).at(input.span));
    }
    let start = match input.attributes.get("start").map(|start| &start.value) {
        None => filled("0.0")?,
        Some(start) => of_all_elements(start, &input.dims).ok_or_else(unreadable)?,
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
        let start = Some(of(&start_name));
        made.inputs.insert(name.clone(), MadeInput { is_state: true, start, default: 0.0 });
    }
    Ok(())
}

/// An expression for an array of these sizes, all elements of which have one value.
fn filled(value: &str, dims: &[usize]) -> Option<Expression> {
    let sizes: String = dims.iter().map(|size| format!(", {size}")).collect();
    let text = if sizes.is_empty() { value.to_owned() } else { format!("fill({value}{sizes})") };
    syntax::parse_expression(SourceId::NONE, &text).ok()
}

/// The value of an attribute of all elements: one number holds for each.
fn of_all_elements(value: &Expression, dims: &[usize]) -> Option<Expression> {
    match is_number(value) {
        true => filled(&syntax::print::expression(value), dims),
        false => Some(value.clone()),
    }
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
    let default = match &input.base {
        BaseType::Enumeration(_) => 1.0,
        BaseType::Real | BaseType::Integer | BaseType::Boolean => 0.0,
        BaseType::String | BaseType::ExternalObject(_) | BaseType::Clock => {
            let name = &input.name;
            let fault = fault!(NOT_SUPPORTED, "the input `{name}` is not a number";
                help: "make it a parameter");
            return Err(fault.at(input.span));
        }
    };
    let start = input.attributes.get("start").map(|start| start.value.clone());
    let start = start.and_then(|value| {
        let (name, _) = parameter(flat, input, "start", made)?;
        flat.variables.get_mut(name.as_str())?.binding = Some(value);
        Some(name)
    });
    // The unit gives it its start value before anything is computed.
    flat.recorded.push(RecordedInput {
        name: input.name.clone(),
        times: [0.0].into(),
        values: [default].into(),
        is_held: true,
    });
    let own = MadeInput { is_state: false, start, default };
    made.inputs.insert(input.name.to_string(), own);
    Ok(())
}

/// A fixed start value that an importer may set.
fn start_parameter(flat: &mut FlatModel, variable: &Variable, made: &mut Made) {
    let is_true =
        |attribute: &Attribute| matches!(attribute.value.kind, ExpressionKind::Boolean(true));
    let is_fixed = variable.attributes.get("fixed").is_some_and(is_true);
    let start = variable.attributes.get("start").filter(|start| !start.is_final);
    let (Some(start), true) = (start, is_fixed) else { return };
    let Some(value) = of_all_elements(&start.value, &variable.dims) else { return };
    let Some((name, reference)) = parameter(flat, variable, "start", made) else { return };
    if let Some(own) = flat.variables.get_mut(name.as_str()) {
        own.binding = Some(value);
    }
    if let Some(own) = flat.variables.get_mut(&variable.name) {
        own.attributes.insert("start", Attribute { value: reference, is_final: false });
    }
    for element in element_names(variable) {
        let of_element = format!("{name}{}", &element[variable.name.len()..]);
        made.starts.insert(element, of_element);
    }
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
