//! Values of the model translated last: its parameters and start values, as scripts set them.

use super::addressing::{Addressed, addressed, all_indices, flat_name};
use super::changes::{Changed, Given};
use super::ranges::Range;
use super::translated::{Declaration, Translated};
use super::typed::{number_in, number_of, unquoted};
use crate::bail;
use crate::diag::{At, Diagnostic, Fault, suggest};
use crate::errors::{
    BAD_PARAMETER_VALUE, NO_WINDOW, SHARED_NAME, START_IS_GUESS, TRANSLATED_AGAIN,
    UNKNOWN_PARAMETER,
};
use crate::fault;
use crate::flatten::{BaseType, Variability};
use crate::language::workspace::Workspace;
use crate::name::Ident;
use crate::source::Span;
use crate::syntax::ast::{ComponentReference, ReferencePart};
use crate::value::{ArrayValue, Value, sizes};
use crate::{Dialect, Session};

impl Session {
    /// Sets a flag, or a parameter of the model translated last.
    pub(crate) fn assign_dotted(
        &mut self,
        target: &ComponentReference,
        value: &Value,
        span: Span,
    ) -> Result<bool, Diagnostic> {
        if self.workspace.set_flag(target, value) {
            self.note_idle_flag(target);
            return Ok(true);
        }
        if self.models.last().is_none() {
            return Err(no_model(&target.name().to_string()).at(target.span));
        }
        self.set_values(target, value).at(span)?;
        self.models.note_set(target);
        Ok(true)
    }

    /// Says once for each flag that it has no effect.
    fn note_idle_flag(&mut self, flag: &ComponentReference) {
        let name = flag.name().to_string();
        if !Workspace::has_effect(&name) && self.models.is_new_note(Ident::new(&name)) {
            self.note(NO_WINDOW, format!("the flag `{name}` is stored; it has no effect here"));
        }
    }

    /// Gives a parameter of the model translated last, an array of them or a part of one, a value.
    fn set_values(&mut self, target: &ComponentReference, value: &Value) -> Result<(), Fault> {
        let Some(name) = flat_name(target) else {
            bail!(BAD_PARAMETER_VALUE, "subscripts of a model component must be Integers")
        };
        let (target, suffix) = without_start(target);
        let found = self.models.shaped().find_map(|model| addressed(&model, &target));
        let found = match found {
            Some(found) if !found.dims.is_empty() => self.resized(found, &target, value),
            other => other,
        };
        let Some(found) = found else {
            let Some(number) = value.as_real() else {
                return Err(match self.models.last() {
                    Some(model) => not_tunable(model, &name),
                    None => no_model(&name),
                });
            };
            return self.set_parameter(&name, number);
        };
        if let (BaseType::String, Value::String(text)) = (&found.declaration.base, value) {
            return self
                .change_structure(&format!("{}{suffix}", found.names[0]), Given::Text(text));
        }
        let numbers = numbers(&found, &name, value)?;
        let before = self.models.current.clone();
        let done = self.set_elements(&found, suffix, &numbers);
        done.inspect_err(|_| self.models.current = before)
    }

    /// An array of the model translated last as it is with the values that scripts gave to structural
    /// parameters: its size may follow from them. Where these values alone make no model, it may be
    /// this array that they lack: it has the size of what is assigned to all of it.
    fn resized(
        &mut self,
        found: Addressed,
        target: &ComponentReference,
        value: &Value,
    ) -> Option<Addressed> {
        let Some(last) = self.models.last().cloned() else { return Some(found) };
        if let Ok(model) = self.shaped_or_errors(&last) {
            return addressed(&model, target);
        }
        let is_whole = target.parts.iter().all(|part| part.subscripts.is_empty());
        let rank = found.declaration.dims.len();
        if !is_whole || found.dims.len() != rank || value.dims().len() != rank {
            return Some(found);
        }
        let dims = value.dims().to_vec();
        let declaration = Declaration { dims: dims.clone(), ..found.declaration };
        let whole = flat_name(target)?;
        let element = |at: Vec<i64>| {
            let at: Vec<String> = at.iter().map(i64::to_string).collect();
            format!("{whole}[{}]", at.join(","))
        };
        let names = all_indices(&dims).into_iter().map(element).collect();
        Some(Addressed { names, dims, declaration })
    }

    /// Gives scalars values: each by itself, or with the array that it is an element of where that
    /// is a structural parameter.
    fn set_elements(
        &mut self,
        found: &Addressed,
        suffix: &str,
        numbers: &[f64],
    ) -> Result<(), Fault> {
        let has_slot = |name: &String| {
            self.models.shaped().any(|model| model.program.find_parameter(name).is_ok())
        };
        let is_tunable = suffix.is_empty() && found.names.iter().all(has_slot);
        let array = found.array().filter(|_| !is_tunable && suffix.is_empty());
        let Some((array, all)) = array else {
            let pairs = found.names.iter().zip(numbers);
            let mut pairs = pairs.map(|(name, number)| (format!("{name}{suffix}"), number));
            return pairs.try_for_each(|(name, number)| self.set_parameter(&name, *number));
        };
        let mut elements = match all == found.names {
            true => numbers.to_vec(),
            false => self.elements(&all)?,
        };
        for (name, number) in found.names.iter().zip(numbers) {
            if let Some(at) = all.iter().position(|own| own == name) {
                elements[at] = *number;
            }
        }
        if let Some(current) = &mut self.models.current {
            current.overrides.retain(|name, _| !all.iter().any(|own| **own == **name));
        }
        let dims = found.declaration.dims.clone();
        self.change_structure(&array, Given::Array(&dims, &elements))
    }

    /// The values that the elements of an array have.
    fn elements(&mut self, names: &[String]) -> Result<Vec<f64>, Fault> {
        let Some(last) = self.models.last().cloned() else { return Err(no_model(&names[0])) };
        let fault = |error: Diagnostic| Fault::new(error.code, error.message.clone());
        let model = self.shaped_model(&last).map_err(fault)?;
        let numbers = self.numbers_of(&model, names).map_err(fault)?;
        numbers.ok_or_else(|| not_tunable(&model, &names[0]))
    }

    /// Gives a parameter of the model translated last a value, by its full name.
    ///
    /// # Errors
    /// A name that is no parameter, or one that cannot be set without translating again.
    pub fn set_parameter(&mut self, name: &str, value: f64) -> Result<(), Fault> {
        let model = self.models.shaped().find(|model| model.program.find_parameter(name).is_ok());
        let Some(current) = &mut self.models.current else { return Err(no_model(name)) };
        if let Some(model) = model {
            check_value(&model, name, value)?;
            current.overrides.insert(name.into(), value);
            return Ok(());
        }
        match name.strip_suffix(".start") {
            // There is no modification of a single element.
            Some(state) if state.contains('[') && is_state(&current.model, state) => {
                current.imported.insert(state.into(), value);
                Ok(())
            }
            _ => self.change_structure(name, Given::Number(value)),
        }
    }

    /// Gives what has no slot in the program a value.
    fn change_structure(&mut self, name: &str, value: Given<'_>) -> Result<(), Fault> {
        let Some(current) = &mut self.models.current else { return Err(no_model(name)) };
        match current.changes.set(&current.model, name, value) {
            Some(Changed::Structure) => {
                let problem = current.model.problem.clone();
                self.note_structural(name, &problem);
                Ok(())
            }
            Some(Changed::Start) => Ok(()),
            Some(Changed::Guess) => {
                let problem = current.model.problem.clone();
                let name = name.strip_suffix(".start").unwrap_or(name);
                self.note_guess(name, &problem);
                Ok(())
            }
            None => Err(not_tunable(&current.model, name)),
        }
    }

    /// As [`Session::set_parameter`], with the value as text: a number, a Boolean, a literal of an
    /// enumeration by its name, or the content of a String.
    ///
    /// # Errors
    /// Also a text that is no value of the parameter's type.
    pub fn set_parameter_text(&mut self, name: &str, text: &str) -> Result<(), Fault> {
        let Some(model) = self.models.last().cloned() else { return Err(no_model(name)) };
        let whole = name.split_once('[').map_or(name, |(whole, _)| whole);
        let owner = whole.strip_suffix(".start").unwrap_or(whole);
        let base = model.declarations.get(owner).map(|variable| &variable.base);
        if base == Some(&BaseType::String) {
            return self.change_structure(name, Given::Text(unquoted(text)));
        }
        let value = number_in(name, text.trim(), base)?;
        self.set_parameter(name, value)
    }

    /// Whether a name that a script assigns to means a parameter of the model translated last: no script
    /// has had a variable of the name before.
    pub(crate) fn is_of_model(&self, name: Ident) -> bool {
        if self.models.is_own(name) || self.dialect() != Dialect::Dymola {
            return false;
        }
        let declared = self.models.last().and_then(|model| model.declarations.get(name.as_str()));
        declared.is_some_and(|v| v.top_level && v.variability == Variability::Parameter)
    }

    /// Gives the parameter of the model translated last that has this name a value; said once for each
    /// name. `false` if it cannot be set: then it is a variable of the script.
    pub(crate) fn assign_to_model(&mut self, name: Ident, value: &Value) -> Result<bool, Fault> {
        let Some(model) = self.models.last().cloned() else { return Ok(false) };
        if let Some(why) = unlike(&model, name) {
            self.models.note_own(name);
            self.note_shared_name(
                name,
                "parameter",
                &format!("the parameter keeps its value: {why}"),
            );
            return Ok(false);
        }
        let target = ComponentReference::from_name(&name.into(), Span::NONE);
        let set = self.set_values(&target, value);
        set.map_err(|fault| {
            let problem = &model.problem;
            let text = format!(
                "a parameter of `{problem}` has this name: rename the variable of the script"
            );
            fault.help(text)
        })?;
        self.models.note_set(&target);
        self.note_shared_name(name, "parameter", "it is set");
        Ok(true)
    }

    /// An assignment to a parameter of the model translated last fails, or is not reached.
    pub(crate) fn lose_in_model(&mut self, target: &ComponentReference) {
        let name = target.parts[0].name;
        let is_model = match target.parts.as_slice() {
            [_] => self.is_of_model(name),
            _ => self
                .models
                .shaped()
                .any(|model| addressed(&model, &without_start(target).0).is_some()),
        };
        if is_model {
            self.models.note_unset(target);
        }
    }

    /// A variable of scripts has got a value that has the name of a parameter; the parameter keeps
    /// its own.
    pub(crate) fn keep_from_model(&mut self, name: Ident) {
        let declared = self.models.last().and_then(|model| model.declarations.get(name.as_str()));
        let is_parameter =
            declared.is_some_and(|v| v.top_level && v.variability == Variability::Parameter);
        if is_parameter && self.dialect() == Dialect::Dymola {
            self.note_shared_name(
                name,
                "parameter",
                "the parameter keeps its value, because the script had the variable before the \
                 model was translated",
            );
        } else {
            self.models.note_own(name);
        }
    }

    /// A variable that is new in the script has got a number, and the name of a state of the model
    /// translated last.
    pub(crate) fn note_state(&mut self, name: Ident, value: &Value) {
        let Some(model) = self.models.last().cloned() else { return };
        let is_number = matches!(value, Value::Real(_) | Value::Integer(_));
        if self.dialect() == Dialect::Dymola && is_number && is_state(&model, name.as_str()) {
            let consequence =
                format!("it keeps its start value: write `{name}.start = …` to set it");
            self.note_shared_name(name, "state", &consequence);
        }
    }

    fn note_shared_name(&mut self, name: Ident, what: &str, consequence: &str) {
        if self.models.is_new_note(name)
            && let Some(model) = self.models.last()
        {
            let problem = &model.problem;
            let text = format!("`{name}` is a {what} of `{problem}`: {consequence}");
            self.note(SHARED_NAME, text);
        }
    }

    /// Reports once for each name that a state does not begin with its start value.
    fn note_guess(&mut self, name: &str, problem: &str) {
        if self.models.is_new_note(Ident::new(&format!("{problem}.{name}.start"))) {
            let message = format!(
                "the start value of `{name}` is a first guess only: initial equations of \
                 `{problem}`, or start values of other variables, determine where it begins"
            );
            self.note(START_IS_GUESS, message);
        }
    }

    /// Reports once for each name that a parameter shapes the equations.
    fn note_structural(&mut self, name: &str, problem: &str) {
        if self.models.is_new_note(Ident::new(&format!("{problem}.{name}"))) {
            let message = format!(
                "`{name}` is a structural parameter of `{problem}`: the model is translated again"
            );
            self.note(TRANSLATED_AGAIN, message);
        }
    }
}

impl Addressed {
    /// The declared array that all of these are elements of, with the names of its elements; `None` for
    /// scalars, and for arrays in elements of arrays, which no modification can name.
    fn array(&self) -> Option<(String, Vec<String>)> {
        let array = self.names.first()?.strip_suffix(']')?.rsplit_once('[')?.0.to_owned();
        let is_element =
            |name: &String| name.strip_prefix(&array).is_some_and(|rest| rest.starts_with('['));
        let is_one = !array.contains('[') && self.names.iter().all(is_element);
        let names = all_indices(&self.declaration.dims).into_iter().map(|indices| {
            let shown: Vec<String> = indices.iter().map(i64::to_string).collect();
            format!("{array}[{}]", shown.join(","))
        });
        is_one.then(|| (array.clone(), names.collect()))
    }
}

/// The numbers of a value, one for each scalar.
fn numbers(found: &Addressed, name: &str, value: &Value) -> Result<Vec<f64>, Fault> {
    let base = &found.declaration.base;
    let of = |value: &Value| number_of(base, name, value);
    if value.dims() != found.dims {
        let shown = |dims: &[usize]| match dims {
            [] => "is a scalar".to_owned(),
            dims => format!("has the size {}", sizes(dims)),
        };
        bail!(
            BAD_PARAMETER_VALUE,
            "`{name}` {}, but the value {}", shown(&found.dims), shown(value.dims());
            help: "assign a value of the size that the parameter has in the translated model"
        );
    }
    match value {
        Value::Array(ArrayValue { elements, .. }) => {
            (0..elements.len()).map(|at| of(&elements.get(at))).collect()
        }
        scalar => Ok(vec![of(scalar)?]),
    }
}

/// Why an assignment cannot be meant for a parameter, whatever its value: it cannot be set.
fn unlike(model: &Translated, name: Ident) -> Option<String> {
    let declared = model.declarations.get(name.as_str())?;
    let target = ComponentReference::from_name(&name.into(), Span::NONE);
    let has_slot = addressed(model, &target)
        .is_some_and(|found| model.program.find_parameter(&found.names[0]).is_ok());
    let may_change = !declared.is_final && !declared.says_fixed;
    let has_value = !matches!(declared.base, BaseType::ExternalObject(_) | BaseType::Clock);
    let is_settable = has_slot || may_change && has_value;
    (!is_settable).then(|| format!("`{name}` is final or computed by the model"))
}

/// The reference to a variable in one to its start value, and what follows on its name.
fn without_start(target: &ComponentReference) -> (ComponentReference, &'static str) {
    let mut variable = target.clone();
    let is_start =
        |part: &ReferencePart| part.name.as_str() == "start" && part.subscripts.is_empty();
    if variable.parts.len() > 1 && variable.parts.last().is_some_and(is_start) {
        variable.parts.pop();
        return (variable, ".start");
    }
    (variable, "")
}

fn is_state(model: &Translated, name: &str) -> bool {
    model.state_names().any(|state| &**state == name)
}

fn check_value(model: &Translated, name: &str, value: f64) -> Result<(), Fault> {
    let parameter = &model.program.parameters()[model.program.find_parameter(name)?];
    if value.is_finite() && value.fract() != 0.0 && parameter.base != BaseType::Real {
        bail!(BAD_PARAMETER_VALUE, "`{name}` needs a whole number, but the value is {value}");
    }
    let literals = match &parameter.base {
        BaseType::Enumeration(definition) => &definition.literals[..],
        _ => &[],
    };
    let limits = [parameter.min, parameter.max];
    let numbered = (1_u32..).map(f64::from).zip(literals);
    let literals = numbered.map(|(number, literal)| (number, literal.as_str())).collect();
    Range { limits, literals }.check(&format!("`{name}`"), value)
}

fn no_model(name: &str) -> Fault {
    fault!(
        crate::errors::NO_TRANSLATED_MODEL,
        "`{name}` refers to a component of a model, but no model has been translated";
        help: "call `translateModel(\"Package.Model\")` first"
    )
}

/// A modification of an element at some depth: `a(b(c = …))`.
fn nested_modification(name: &str) -> String {
    let parts: Vec<&str> = name.split('.').collect();
    format!("{} = …{}", parts.join("("), ")".repeat(parts.len() - 1))
}

/// Why a name cannot be assigned in the model.
fn not_tunable(model: &Translated, name: &str) -> Fault {
    let problem = &model.problem;
    let array = name.strip_suffix(']').and_then(|name| name.rsplit_once('['));
    let declared = model.declarations.get(name);
    match declared.or_else(|| model.declarations.get(array?.0)) {
        Some(variable) if variable.variability <= Variability::Parameter => {
            let reason = match () {
                () if variable.variability == Variability::Constant => "it is a constant",
                () if variable.is_final => "it is final",
                () if variable.is_evaluated => {
                    "it is a structural parameter, evaluated at translation"
                }
                () if !variable.dims.is_empty() => "it is an array",
                () => "it is not a number, or the model computes it",
            };
            fault!(BAD_PARAMETER_VALUE, "`{name}` of `{problem}` cannot be set: {reason}";
                help: "set it by a modification, `{problem}({})`", nested_modification(name))
        }
        Some(_) => fault!(UNKNOWN_PARAMETER, "`{name}` of `{problem}` is not a parameter";
            help: "the equations determine its value; set the parameters that it depends on"),
        None => {
            let parameters = model.program.parameters().iter();
            let names: Vec<&str> = parameters.map(|parameter| &*parameter.name).collect();
            let own = name.strip_prefix(problem.as_str()).and_then(|rest| rest.strip_prefix('.'));
            let own = own.filter(|own| model.program.find_parameter(own).is_ok());
            fault!(UNKNOWN_PARAMETER, "`{problem}` has no parameter `{name}`")
                .help_if(own.map(|own| format!("write `{own}`, without the name of the model")))
                .help_if(suggest::did_you_mean(name, names.iter().copied()))
                .help_if(
                    (!names.is_empty())
                        .then(|| format!("its parameters are {}", suggest::listed(&names))),
                )
        }
    }
}
