//! Values of the model translated last: its parameters and start values, as scripts set them.

use super::changes::Changed;
use super::compiled::{Current, End};
use super::translated::Translated;
use crate::bail;
use crate::diag::{At, Diagnostic, Fault, suggest};
use crate::fault;
use crate::flatten::{BaseType, Variability};
use crate::name::Ident;
use crate::script::Session;
use crate::script::errors::{
    BAD_PARAMETER_VALUE, SHARED_NAME, TRANSLATED_AGAIN, UNKNOWN_PARAMETER,
};
use crate::source::Span;
use crate::syntax::ast::{ComponentReference, Expression, ExpressionKind, Subscript};
use crate::value::Value;
use indexmap::IndexMap;
use std::sync::Arc;

impl Session {
    /// The value that a parameter of the model translated last has.
    pub(in crate::script) fn model_value(
        &mut self,
        reference: &ComponentReference,
    ) -> Result<Option<Value>, Diagnostic> {
        let value = flat_name(reference).and_then(|name| self.models.parameter_value(&name));
        Ok(value.map(Value::Real))
    }

    /// Sets a flag, or a parameter of the model translated last.
    pub(in crate::script) fn assign_dotted(
        &mut self,
        target: &ComponentReference,
        value: Value,
        span: Span,
    ) -> Result<bool, Diagnostic> {
        if self.workspace.set_flag(target, &value) {
            return Ok(true);
        }
        if self.models.last().is_none() {
            return Err(self.nothing_translated(target).at(target.span));
        }
        let Some(name) = flat_name(target) else {
            let message = "subscripts of a model component must be Integers";
            return Err(Fault::new(BAD_PARAMETER_VALUE, message).at(target.span));
        };
        let number = match value {
            Value::Boolean(value) => f64::from(value),
            Value::Enumeration(value) => value.ordinal as f64,
            other => match other.as_real() {
                Some(number) => number,
                None => {
                    return Err(fault!(
                        BAD_PARAMETER_VALUE,
                        "`{name}` cannot be set to {}", other.type_name();
                        help: "assign a number, or the elements of an array one by one"
                    )
                    .at(span));
                }
            },
        };
        self.set_parameter(&name, number).at(span)?;
        Ok(true)
    }

    /// Gives a parameter of the model translated last a value, by its full name.
    ///
    /// # Errors
    /// A name that is no parameter, or one that cannot be set without translating again.
    pub fn set_parameter(&mut self, name: &str, value: f64) -> Result<(), Fault> {
        let Some(current) = &mut self.models.current else {
            bail!(
                crate::script::errors::NO_TRANSLATED_MODEL,
                "`{name}` refers to a component of a model, but no model has been translated";
                help: "call `translateModel(\"Package.Model\")` first"
            )
        };
        match current.model.program.find_parameter(name) {
            Ok(index) => {
                check_value(&current.model, index, value)?;
                current.overrides.insert(index, value);
                Ok(())
            }
            Err(_) => match current.changes.set(&current.model, name, value) {
                Some(Changed::Structure) => {
                    let problem = current.model.problem.clone();
                    self.note_structural(name, &problem);
                    Ok(())
                }
                Some(Changed::Start) => Ok(()),
                None => Err(not_tunable(&current.model, name)),
            },
        }
    }

    /// As [`Session::set_parameter`], with the value as text: a number, a Boolean, a literal of an
    /// enumeration by its name, or the content of a String.
    ///
    /// # Errors
    /// Also a text that is no value of the parameter's type.
    pub fn set_parameter_text(&mut self, name: &str, text: &str) -> Result<(), Fault> {
        let Some(current) = &mut self.models.current else {
            return self.set_parameter(name, f64::NAN);
        };
        let model = current.model.clone();
        let whole = name.split_once('[').map_or(name, |(whole, _)| whole);
        let owner = whole.strip_suffix(".start").unwrap_or(whole);
        let base = model.declarations.get(owner).map(|variable| &variable.base);
        if base == Some(&BaseType::String) {
            if !current.changes.set_text(&model, name, unquoted(text)) {
                return Err(not_tunable(&model, name));
            }
            self.note_structural(name, &model.problem);
            return Ok(());
        }
        let value = number_of(name, text.trim(), base)?;
        self.set_parameter(name, value)
    }

    /// The model translated last and the values that it has, to be restored.
    pub(in crate::script) fn current_values(&self) -> Option<Current> {
        self.models.current.clone()
    }

    /// Takes back what was set since.
    pub(in crate::script) fn restore_values(&mut self, before: Option<Current>) {
        self.models.current = before;
    }

    /// Where the last simulation ended.
    pub(in crate::script) fn last_end(&self) -> Option<&End> {
        self.models.end.as_ref()
    }

    /// Gives the states of the model translated last values at the start of its next simulations,
    /// whatever its initial equations say; none to take them back.
    pub(in crate::script) fn import_states(&mut self, states: IndexMap<Arc<str>, f64>) {
        if let Some(current) = &mut self.models.current {
            current.imported = states;
        }
    }

    /// A script variable with the name of a parameter of the model translated last gives the
    /// parameter its value too; said once for each name.
    pub(in crate::script) fn share_with_model(
        &mut self,
        name: Ident,
        value: &Value,
    ) -> Result<(), Fault> {
        let Some(current) = &self.models.current else { return Ok(()) };
        let model = current.model.clone();
        let declared = model.declarations.get(name.as_str());
        let is_parameter =
            declared.is_some_and(|v| v.top_level && v.variability == Variability::Parameter);
        if !is_parameter {
            return Ok(());
        }
        let is_tunable = model.program.find_parameter(name.as_str()).is_ok();
        let number = value.as_real().or(match value {
            Value::Boolean(value) => Some(f64::from(*value)),
            _ => None,
        });
        let set = match number {
            Some(number) if is_tunable => self.set_parameter(name.as_str(), number).map(|()| true),
            Some(number) => Ok(self.set_parameter(name.as_str(), number).is_ok()),
            None => Ok(false),
        };
        let consequence = match set? {
            true => "the parameter is set as well".to_owned(),
            false => {
                format!("the parameter keeps its value: {}", not_tunable(&model, name.as_str()))
            }
        };
        if self.models.is_new_note(name) {
            let problem = &model.problem;
            self.note(
                SHARED_NAME,
                format!("`{name}` is also a parameter of `{problem}`: {consequence}"),
            );
        }
        Ok(())
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

/// A text without the quotes around it.
fn unquoted(text: &str) -> &str {
    let inner = text.trim().strip_prefix('"').and_then(|rest| rest.strip_suffix('"'));
    inner.unwrap_or(text)
}

/// The number that stands for a value: of a literal its ordinal.
fn number_of(name: &str, text: &str, base: Option<&BaseType>) -> Result<f64, Fault> {
    if let Some(BaseType::Enumeration(definition)) = base {
        let literal = text.rsplit('.').next().unwrap_or(text);
        if let Some(at) = definition.literals.iter().position(|known| *known == literal) {
            return Ok(at as f64 + 1.0);
        }
        let literals = definition.literals.iter().map(|known| known.as_str());
        return text.parse().map_err(|_| {
            fault!(
                BAD_PARAMETER_VALUE,
                "`{text}` is not a literal of `{}`, the type of `{name}`",
                definition.name
            )
            .help_if(suggest::did_you_mean(literal, literals.clone()))
            .help(format!("its literals are {}", literals.collect::<Vec<_>>().join(", ")))
        });
    }
    match text {
        "true" => Ok(1.0),
        "false" => Ok(0.0),
        number => number.parse().map_err(|_| {
            fault!(BAD_PARAMETER_VALUE, "`{text}` is not a value of `{name}`";
                help: "write a number, `true` or `false`")
        }),
    }
}

fn check_value(model: &Translated, index: usize, value: f64) -> Result<(), Fault> {
    let parameter = &model.program.parameters()[index];
    let name = &parameter.name;
    if !value.is_finite() {
        bail!(BAD_PARAMETER_VALUE, "`{name}` cannot be {value}"; help: "use a finite number");
    }
    if value.fract() != 0.0 && parameter.base != BaseType::Real {
        bail!(BAD_PARAMETER_VALUE, "`{name}` needs a whole number, but the value is {value}");
    }
    let domain = match (parameter.min.is_finite(), parameter.max.is_finite()) {
        (true, true) => format!("outside {} to {}", parameter.min, parameter.max),
        (true, false) => format!("less than {}", parameter.min),
        _ => format!("more than {}", parameter.max),
    };
    if value < parameter.min || value > parameter.max {
        bail!(
            BAD_PARAMETER_VALUE,
            "`{name}` is {value}, {domain}, outside the range declared in the model";
            help: "choose another value, or change `min` and `max` in the model"
        );
    }
    Ok(())
}

/// A modification of an element at some depth: `a(b(c = …))`.
fn nested_modification(name: &str) -> String {
    let parts: Vec<&str> = name.split('.').collect();
    format!("{} = …{}", parts.join("("), ")".repeat(parts.len() - 1))
}

/// Why a name cannot be assigned in the model.
fn not_tunable(model: &Translated, name: &str) -> Fault {
    let problem = &model.problem;
    match model.declarations.get(name) {
        Some(variable) if variable.variability <= Variability::Parameter => {
            let reason = match () {
                () if variable.variability == Variability::Constant => "it is a constant",
                () if variable.is_final => "it is final",
                () if variable.is_evaluated => {
                    "it is a structural parameter, evaluated at translation"
                }
                () => "it is an array or not a number",
            };
            fault!(BAD_PARAMETER_VALUE, "`{name}` of `{problem}` cannot be set: {reason}";
                help: "set it by a modification, `{problem}({})`", nested_modification(name))
        }
        Some(_) => fault!(UNKNOWN_PARAMETER, "`{name}` of `{problem}` is not a parameter";
            help: "the equations determine its value; set the parameters that it depends on"),
        None => {
            let names = model.program.parameters().iter().map(|parameter| &*parameter.name);
            let own = name.strip_prefix(problem.as_str()).and_then(|rest| rest.strip_prefix('.'));
            let own = own.filter(|own| model.program.find_parameter(own).is_ok());
            fault!(UNKNOWN_PARAMETER, "`{problem}` has no parameter `{name}`")
                .help_if(own.map(|own| format!("write `{own}`, without the name of the model")))
                .help_if(suggest::did_you_mean(name, names))
        }
    }
}

/// A reference as variables of flat models are named: `pack.cell[2].V`; `None` if a subscript is
/// not an Integer.
fn flat_name(reference: &ComponentReference) -> Option<String> {
    let mut name = String::new();
    for part in &reference.parts {
        if !name.is_empty() {
            name.push('.');
        }
        name.push_str(part.name.as_str());
        let subscripts: Option<Vec<String>> = part
            .subscripts
            .iter()
            .map(|subscript| match subscript {
                Subscript::Index(Expression { kind: ExpressionKind::Integer(at), .. }) => {
                    Some(at.to_string())
                }
                _ => None,
            })
            .collect();
        match subscripts?.join(",") {
            none if none.is_empty() => {}
            subscripts => name.push_str(&format!("[{subscripts}]")),
        }
    }
    Some(name)
}
