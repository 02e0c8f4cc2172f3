//! What the parameters of a problem are in one of its experiments: modifications of the model, and
//! the free ones, which the search sets before each simulation.

use super::data::Notes;
use super::deviation::Renamed;
use super::enclosing_class::{self, EnclosingClass, QuotedNames, own_name};
use super::file::{ExperimentEntry, ParameterEntry, ProblemFile, Role, ValueEntry};
use super::flat::{attribute, variable_of};
use super::segments::Segment;
use super::{deviation, dynamics, noise};
use crate::Session;
use crate::codegen::{Access, Program};
use crate::diag::{At as _, Diagnostic, Fault, suggest};
use crate::fault;
use crate::flatten::{BaseType, FlatModel, Variability};
use crate::identify::problem::Free;
use crate::models::simulation::flat_model_of;
use crate::models::translated::Translated;
use crate::registry::BAD_OPTION;
use crate::source::Span;
use crate::symbolic::VarId;
use crate::syntax::ast::{Expression, ExpressionKind};
use crate::syntax::visit::Rewrite;
use std::fmt::Write;

/// Parts of a range at which not both values are zero.
const INSIDE: [f64; 2] = [0.5, 0.75];

/// An experiment whose parameters are set.
pub(super) struct Setting<'a> {
    pub file: &'a ProblemFile,
    pub entry: &'a ExperimentEntry,
    /// The name of the experiment.
    pub label: &'a str,
    /// The part of the experiment.
    pub segment: &'a Segment,
    pub free: &'a [Free],
    /// Parameters that only formulas for deviations and values of this experiment have.
    pub of_deviations: &'a [String],
    /// Parameters that formulas for deviations and values of any experiment have.
    pub of_any_deviation: &'a [String],
}

/// The types of the variables of a model, where it is known.
pub(super) type Types<'a> = Option<&'a FlatModel>;

/// The name of a model and the type of one of its variables.
fn declared<'a>(types: Types<'a>, name: &str) -> (&'a str, Option<&'a BaseType>) {
    let Some(flat) = types else { return ("", None) };
    (&flat.name, variable_of(flat, name).map(|own| &own.base))
}

/// The variables of parameters in the equations.
pub(super) fn variables(names: &[(usize, String)], program: &Program) -> Vec<VarId> {
    let found = names.iter().filter_map(|(_, name)| program.find_parameter(name).ok());
    found.map(|at| program.parameters()[at].variable).collect()
}

impl Setting<'_> {
    /// Whether a value is a String: what it means depends on the type of the variable.
    pub(super) fn needs_types(&self) -> bool {
        let is_string = |value: &ValueEntry| {
            matches!(value, ValueEntry::Text(_))
                && deviation::value_expression(value, self.file).is_none()
        };
        let fixed = self.file.parameters.values().filter_map(|own| own.fixed.as_ref());
        let values = self.entry.set.values.values().chain(self.entry.start.values());
        fixed.chain(values).any(is_string)
    }

    /// Adds modifications to the class around the model; the free parameters with their names in it.
    ///
    /// # Errors
    ///
    /// Entries that contradict each other or are no values.
    pub(super) fn parameters(
        &self,
        types: Types<'_>,
        enclosing: &mut EnclosingClass,
    ) -> Result<Vec<(usize, String)>, Diagnostic> {
        let mut names = Vec::new();
        for (name, parameter) in &self.file.parameters {
            let place = self.file.context.places.parameter(name);
            let role = parameter.role(name).at(place)?;
            if self.of_deviations.contains(name) {
                let free = matches!(role, Role::Free { .. });
                let free = free.then(|| self.free_place(name, parameter).at(place)).transpose()?;
                let known = (self.file, self.of_deviations);
                let own = deviation::declare_parameter((name, &role), known, enclosing)?;
                names.extend(free.map(|free| (free, own)));
                continue;
            }
            let is_elsewhere = self.of_any_deviation.contains(name)
                && types.is_some_and(|flat| !deviation::is_of_model(name, flat));
            if is_elsewhere {
                continue;
            }
            let value = match role {
                Role::Free { .. } => {
                    let free = self.free_place(name, parameter).at(place)?;
                    let Some(own) = self.declare(name, parameter, free, enclosing) else {
                        names.push((free, name.clone()));
                        continue;
                    };
                    names.push((free, own.clone()));
                    enclosing_class::reference(&own, place)
                }
                Role::Fixed(value) => {
                    let declared = declared(types, name);
                    enclosing_class::value(&value, (name, place), declared).at(place)?
                }
                Role::Tied(text) => self.tied(name, &text)?,
            };
            if dynamics::is_delay(self.file, name) {
                continue;
            }
            match parameter.initial {
                true => enclosing.start(name, value, place),
                false => enclosing.bind(name, value, place),
            }
        }
        names.extend(noise::declare((self.file, self.entry), self.free, enclosing)?);
        self.values(types, enclosing)?;
        Ok(names)
    }

    /// Gives the free parameters that are zero in the model a value of their range: where all coefficients
    /// of an equation of the steady state are zero, the compiler takes them as numbers, and the
    /// parameters could not be varied.
    pub(super) fn avoid_zeros(
        &self,
        names: &[(usize, String)],
        program: &Program,
        enclosing: &mut EnclosingClass,
    ) {
        for (free, name) in names {
            let Ok(at) = program.find_parameter(name) else { continue };
            let value = INSIDE.map(|part| self.free[*free].value(part));
            let value = value.into_iter().find(|value| *value != 0.0);
            if let (0.0, Some(value)) = (program.parameters()[at].default, value) {
                let place = self.file.context.places.parameter(name);
                enclosing.bind(name, Expression::new(ExpressionKind::Real(value), place), place);
            }
        }
    }

    /// The place of a free parameter among all of them.
    pub(super) fn free_place(
        &self,
        name: &str,
        parameter: &ParameterEntry,
    ) -> Result<usize, Fault> {
        let full = self.segment.free_name(name, parameter, self.label);
        self.free.iter().position(|free| free.name == full).ok_or_else(|| {
            fault!(
                BAD_OPTION,
                "`{name}` is estimated separately for each experiment, but {} has no value for it",
                self.label;
                help: "fix it there with `set`"
            )
        })
    }

    /// Declares a parameter of the class for a free initial value or delay; its name.
    fn declare(
        &self,
        name: &str,
        parameter: &ParameterEntry,
        free: usize,
        enclosing: &mut EnclosingClass,
    ) -> Option<String> {
        let (own, words) = match dynamics::is_delay(self.file, name) {
            true => (dynamics::delay_name(name), format!("the delay {name}")),
            false if parameter.initial => {
                (own_name("initial value of", name), format!("the initial value of {name}"))
            }
            false => return None,
        };
        let middle = self.free[free].value(0.5);
        _ = writeln!(enclosing.declarations, "  parameter Real {own} = {middle:e};");
        enclosing.elements.push((own.clone(), words));
        Some(own)
    }

    /// The expression of a tied parameter.
    fn tied(&self, name: &str, text: &str) -> Result<Expression, Diagnostic> {
        let places = &self.file.context.places;
        let read = enclosing_class::expression(text, places.text(&["parameters", name, "tied"]));
        let mut read = read.map_err(|error| error.or_at(places.parameter(name)))?;
        QuotedNames.expression(&mut read);
        Ok(read)
    }

    /// The values that the experiment itself sets.
    fn values(&self, types: Types<'_>, enclosing: &mut EnclosingClass) -> Result<(), Diagnostic> {
        let (entry, parameters) = (self.entry, &self.file.parameters);
        for (name, value) in &entry.set.values {
            let place = entry.places.at(&["set", name]);
            if parameters.contains_key(name) {
                let experiment = self.label;
                let fault = fault!(
                    BAD_OPTION,
                    "`{name}` is set both in {experiment} and in `[parameters]`";
                    help: "remove one of the two"
                );
                return Err(fault.at(place));
            }
            let value = self.value(value, (name, place), types)?;
            enclosing.bind(name, value, place);
        }
        for (name, value) in &entry.start {
            let place = entry.places.at(&["start", name]);
            if parameters.get(name).is_some_and(|parameter| parameter.initial) {
                let fault = fault!(
                    BAD_OPTION,
                    "the initial value of `{name}` is given both in {} and in `[parameters]`",
                    self.label;
                    help: "remove one of the two"
                );
                return Err(fault.at(place));
            }
            let value = self.value(value, (name, place), types)?;
            enclosing.start(name, value, place);
        }
        Ok(())
    }

    /// A value of the experiment.
    fn value(
        &self,
        value: &ValueEntry,
        (name, place): (&str, Span),
        types: Types<'_>,
    ) -> Result<Expression, Diagnostic> {
        match deviation::value_expression(value, self.file) {
            Some(mut read) => {
                Renamed(self.of_deviations).expression(&mut read);
                Ok(read)
            }
            None => {
                let declared = declared(types, name);
                if let (ValueEntry::Text(text), Some(BaseType::Real | BaseType::Integer)) =
                    (value, declared.1)
                {
                    return Err(not_an_expression(text, name, self.file).at(place));
                }
                enclosing_class::value(value, (name, place), declared).at(place)
            }
        }
    }
}

/// Why a string is not the value of a number: what it names is not in `[parameters]`.
fn not_an_expression(text: &str, name: &str, file: &ProblemFile) -> Fault {
    let unknown = deviation::unknown_in(text, file);
    let Some(unknown) = unknown else {
        return fault!(BAD_OPTION, "`{name}` is a number, but its value is \"{text}\"")
            .help("write a number, or an expression of entries of `[parameters]`");
    };
    let known = file.parameters.keys().map(String::as_str);
    fault!(BAD_OPTION, "the value of `{name}` names `{unknown}`, which is not in `[parameters]`")
        .help_if(suggest::did_you_mean(&unknown, known))
        .help(format!("give it a range, `{unknown} = {{ min = 0.1, max = 10 }}`, or a number"))
}

/// Refuses, before the first simulation, free parameters that a simulation cannot be given.
///
/// # Errors
///
/// Names that the model does not have, variables, constants, final and structural parameters, and
/// parameters that are not Real.
pub(super) fn check_free(
    session: &mut Session,
    file: &ProblemFile,
    names: &[(usize, String)],
    model: &Translated,
) -> Result<(), Vec<Diagnostic>> {
    for (_, name) in names {
        let settable = model.program.find_parameter(name).ok();
        let base = settable.map(|at| &model.program.parameters()[at].base);
        if matches!(base, Some(BaseType::Real)) {
            continue;
        }
        let error = not_free(name, base, model).at(file.context.places.parameter(name));
        return Err(vec![match final_place(session, name, model)? {
            Some(place) => error.related(place, "declared final here"),
            None => error,
        }]);
    }
    Ok(())
}

/// Where a parameter is final: at its value if it has one, which a modification may give it.
fn final_place(
    session: &mut Session,
    name: &str,
    model: &Translated,
) -> Result<Option<Span>, Vec<Diagnostic>> {
    if !model.declarations.get(name).is_some_and(|declared| declared.is_final) {
        return Ok(None);
    }
    let variable = flat_model_of(session, model)?.variables.get(name);
    Ok(variable.map(|own| own.binding.as_ref().map_or(own.span, |binding| binding.span)))
}

/// Refuses values that the model does not take: a record that has a value as a whole keeps it
/// (MLS §7.2.4), whatever its components are modified by.
///
/// # Errors
///
/// The first such value, at its place.
pub(super) fn check_taken(
    file: &ProblemFile,
    entry: &ExperimentEntry,
    model: &Translated,
) -> Result<(), Diagnostic> {
    let fixed = file.parameters.iter().filter_map(|(name, parameter)| {
        let is_own = model.program.find_parameter(&deviation::parameter(name)).is_ok();
        let is_value = !parameter.initial && !dynamics::is_delay(file, name) && !is_own;
        let value = parameter.fixed.as_ref().filter(|_| is_value)?;
        Some((name, value, file.context.places.parameter(name)))
    });
    let set =
        entry.set.values.iter().map(|(name, value)| (name, value, entry.places.at(&["set", name])));
    for (name, value, place) in fixed.chain(set) {
        if model.program.is_solved_at_start(name) {
            let fault = fault!(
                BAD_OPTION,
                "`{name}` cannot be set: initial equations of the model determine it (`fixed = false`)";
                help: "remove the initial equation for it"
            );
            return Err(fault.at(place));
        }
        let requested = match value {
            ValueEntry::Number(number) => *number,
            ValueEntry::Truth(truth) => f64::from(*truth),
            ValueEntry::Text(_) => continue,
        };
        let Some(taken) = value_of(model, name).filter(|taken| *taken != requested) else {
            continue;
        };
        let fault = fault!(
            BAD_OPTION,
            "`{name}` cannot be set to {requested}: it keeps its value {taken}, which a component of \
             the model has as a whole"
        );
        return Err(fault
            .help("give the record that contains it another value in `model`")
            .at(place));
    }
    Ok(())
}

/// The value that a model gives to a parameter; `None` where that is not known before a simulation.
fn value_of(model: &Translated, name: &str) -> Option<f64> {
    let program = &model.program;
    if let Ok(at) = program.find_parameter(name) {
        return Some(program.parameters()[at].default).filter(|value| !value.is_nan());
    }
    match program.variables().iter().find(|variable| &*variable.name == name)?.access {
        Access::Constant(value) => Some(value),
        _ => None,
    }
}

/// Says which free parameters the model computes from others: they no longer depend on these.
pub(super) fn note_computed(names: &[(usize, String)], model: &Translated, notes: &mut Notes) {
    for (_, name) in names {
        let declared = model.declarations.get(name.as_str());
        let from = declared.map_or(&[][..], |declared| &declared.computed_from);
        if !from.is_empty() {
            let from: Vec<&str> = from.iter().map(String::as_str).collect();
            notes.warn(format!(
                "`{name}` is estimated, although the model computes it from {from}: it no longer \
                 follows them; estimate {from} instead",
                from = suggest::listed(&from)
            ));
        }
    }
}

/// Why a parameter cannot be estimated.
fn not_free(name: &str, base: Option<&BaseType>, model: &Translated) -> Fault {
    let shown = model.program.name();
    let array = || name.strip_suffix(']').and_then(|inner| inner.rsplit_once('['));
    let declared = model.declarations.get(name).or_else(|| model.declarations.get(array()?.0));
    let base = base.or(declared.map(|declared| &declared.base));
    let each = format!(
        "give it one value, `{name} = {{ fixed = … }}`, and compare the fits of several problem \
         files with different values"
    );
    let type_name = match base {
        Some(BaseType::Integer) => Some("Integer"),
        Some(BaseType::Boolean) => Some("Boolean"),
        Some(BaseType::Enumeration(_)) => Some("an enumeration"),
        Some(BaseType::Real) | None => None,
        Some(_) => Some("not a number"),
    };
    let Some(declared) = declared else {
        let is_own = |name: &&str| !name.contains('\'');
        let parameters = model.program.parameters();
        let names: Vec<&str> = parameters.iter().map(|own| &*own.name).filter(is_own).collect();
        return fault!(BAD_OPTION, "`{shown}` has no parameter `{name}`")
            .help_if(suggest::did_you_mean(name, names.iter().copied()))
            .help(match names.is_empty() {
                true => "declare it in the model, or remove it".to_owned(),
                false => format!("its parameters are {}", suggest::listed(&names)),
            });
    };
    if declared.variability > Variability::Parameter {
        return fault!(BAD_OPTION, "`{name}` is a variable of `{shown}`, not a parameter")
            .help("to estimate the initial value of a state, write `initial = true`");
    }
    if let Some(type_name) = type_name {
        return fault!(BAD_OPTION, "`{name}` is {type_name} and cannot be estimated").help(each);
    }
    if !declared.dims.is_empty() && !name.ends_with(']') {
        return fault!(BAD_OPTION, "`{name}` is an array")
            .help(format!("estimate its elements: `\"{name}[1]\"`"));
    }
    let (why, help) = match () {
        () if declared.variability == Variability::Constant => (
            "is a constant",
            "declare it as a parameter in the model, or remove it here".to_owned(),
        ),
        () if declared.is_final => {
            ("is declared `final`", "remove `final` in the model, or remove it here".to_owned())
        }
        () => ("is a structural parameter: its value decides the equations", each),
    };
    fault!(BAD_OPTION, "`{name}` of `{shown}` {why} and cannot be estimated").help(help)
}

/// Refuses initial values of variables that are not states, where all states have theirs: such an
/// initial value would contradict them.
///
/// # Errors
///
/// The variable, with the states.
pub(super) fn check_initial(
    session: &mut Session,
    file: &ProblemFile,
    entry: &ExperimentEntry,
    model: &Translated,
) -> Result<(), Vec<Diagnostic>> {
    let estimated = file.parameters.iter().filter(|(_, parameter)| parameter.initial);
    let estimated = estimated.map(|(name, _)| (name, file.context.places.parameter(name)));
    let set = entry.start.keys().map(|name| (name, entry.places.at(&["start", name])));
    let is_known = |name: &String| {
        let declared = model.declarations.get(name.as_str());
        declared.is_some_and(|own| own.variability < Variability::Discrete)
    };
    if let Some((name, place)) = estimated.clone().chain(set.clone()).find(|own| is_known(own.0)) {
        let fault = fault!(
            BAD_OPTION, "`{name}` is a parameter of `{}`, which has a value, not an initial one", file.model;
            help: "a value for one experiment is written in `set`; one that is estimated needs no `initial`"
        );
        return Err(vec![fault.at(place)]);
    }
    let states: Vec<String> = model.state_names().map(ToString::to_string).collect();
    let is_other = |name: &String| {
        let array = || name.strip_suffix(']').and_then(|inner| inner.rsplit_once('['));
        let own = model.declarations.get(name.as_str());
        let declared = own.or_else(|| model.declarations.get(array()?.0));
        let continuous = declared.is_some_and(|one| one.variability == Variability::Continuous);
        continuous && !states.iter().any(|state| state == name)
    };
    let others: Vec<(&String, Span)> =
        estimated.chain(set).filter(|(name, _)| is_other(name)).collect();
    let Some((name, place)) = others.first() else { return Ok(()) };
    let flat = flat_model_of(session, model)?;
    if !states.iter().all(|state| is_fixed(flat, state)) {
        return Ok(());
    }
    let shown: Vec<&str> = states.iter().map(String::as_str).collect();
    let fault = fault!(BAD_OPTION, "`{name}` is not a state of `{}`", flat.name);
    Err(vec![match states.is_empty() {
        true => fault.help("the model has no states; remove the initial value"),
        false => fault.help(format!(
            "its initial value follows from those of the states: give {} an initial value instead",
            suggest::listed(&shown)
        )),
    }
    .at(*place)])
}

/// Whether a state begins at its start value.
fn is_fixed(flat: &FlatModel, state: &str) -> bool {
    let fixed = attribute(flat, state, "fixed").map(|fixed| &fixed.kind);
    matches!(fixed, Some(ExpressionKind::Boolean(true)))
}

/// Refuses outputs and X that the model does not have.
///
/// # Errors
///
/// The first such name, at its place.
pub(super) fn check_variables(
    names: &[(&str, Span)],
    model: &Translated,
) -> Result<(), Diagnostic> {
    let program = &model.program;
    let missing =
        names.iter().find(|(name, _)| *name != "time" && program.find_variable(name).is_err());
    let Some((name, place)) = missing else { return Ok(()) };
    let is_own = |name: &&str| !name.contains('\'');
    let variables = program.variables().iter().filter(|variable| !variable.is_known());
    let measurable = |name: &&str| is_own(name) && !name.starts_with("der(");
    let known: Vec<&str> = variables.map(|one| &*one.name).filter(measurable).collect();
    let fault = fault!(BAD_OPTION, "`{}` has no variable `{name}`", program.name());
    let element = known
        .iter()
        .find(|known| known.strip_prefix(name).is_some_and(|rest| rest.starts_with('[')));
    let fault = match (element, *name) {
        (Some(element), _) => {
            fault.help(format!("it is an array; write an element: `\"{element}\"`"))
        }
        (None, "t" | "Time" | "TIME") => fault.help("did you mean `time`?"),
        _ => fault.help_if(suggest::did_you_mean(name, known.iter().copied())),
    };
    Err(fault.help(format!("its variables are {}", suggest::listed(&known))).at(*place))
}
