//! The text of classes: asked for, changed and saved.

use super::strings::text;
use super::{Args, Builtin, Failure, Family};
use crate::bail;
use crate::diag::{Diagnostic, Fault};
use crate::errors::BAD_ARGUMENT;
use crate::fault;
use crate::models::modification::{modification_at, no_modification};
use crate::models::simulation;
use crate::name::{Ident, Name};
use crate::source::SourceId;
use crate::syntax::ast::{
    Argument, Binding, CausalityPrefix, ClassDefinition, ClassSpecifier, ComponentClause,
    ComponentDeclaration, ConnectionPrefix, Element, Modification, Section, Subscript,
    VariabilityPrefix, Visibility,
};
use crate::syntax::{self, print};
use crate::value::Value;
use crate::{Dialect, Session};
use std::path::Path;
use std::sync::Arc;

/// The commands of this file.
pub(super) const FAMILY: Family = Family {
    packages: &["OpenModelica.Scripting"],
    dialect: Some(Dialect::OpenModelica),
    builtins: &[
        Builtin { header: LIST, run: list },
        Builtin { header: GET_COMPONENTS, run: get_components },
        Builtin { header: GET_NTH_COMPONENT, run: get_nth_component },
        Builtin { header: GET_COMPONENT_COUNT, run: get_component_count },
        Builtin { header: GET_PARAMETER_VALUE, run: get_parameter_value },
        Builtin { header: SET_PARAMETER_VALUE, run: set_parameter_value },
        Builtin { header: SET_ELEMENT_MODIFIER_VALUE, run: set_element_modifier_value },
        Builtin { header: SET_COMPONENT_MODIFIER_VALUE, run: set_element_modifier_value },
        Builtin { header: GET_SIMULATION_OPTIONS, run: get_simulation_options },
        Builtin { header: SAVE_MODEL, run: save_model },
        Builtin { header: TYPE_OF, run: type_of },
    ],
};

/// The definition of a loaded class, or of one that can be.
fn definition(session: &mut Session, name: &Name) -> Result<Arc<ClassDefinition>, Failure> {
    if !session.find_class(name)? {
        return Err(session.classes.class_to_load(name).into());
    }
    let found = session.library().definition(name);
    found.ok_or_else(|| session.classes.class_to_load(name).into())
}

/// The same as a negative answer: `None` and the reason reported.
pub(super) fn asked(session: &mut Session, name: &Name) -> Option<Arc<ClassDefinition>> {
    match definition(session, name) {
        Ok(class) => Some(class),
        Err(Failure::Here(fault)) => session.or_report(Err(fault)),
        Err(Failure::Elsewhere(errors)) => session.or_report_all(Err(errors)),
    }
}

const LIST: &str = r#"
function list "The source text of a class, or of all classes."
  input TypeName class_ = AllLoadedClasses;
  input Boolean interfaceOnly = false "true is not supported";
  input Boolean shortOnly = false "true is not supported";
  input Any exportKind = 0 "has no effect";
  output String contents;
end list;
"#;

fn list(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let name: Name = args.take("class_")?;
    for part in ["interfaceOnly", "shortOnly"] {
        if args.take::<bool>(part)? {
            bail!(
                BAD_ARGUMENT,
                "`list` returns the complete source text: `{part} = true` is not supported"
            );
        }
    }
    if name.last().is_none_or(|last| last == "AllLoadedClasses") {
        let roots: Vec<Name> = session.library().roots().map(Name::from).collect();
        let library = session.library();
        let all = roots.iter().filter_map(|root| library.definition(root));
        return Ok(text(all.map(|class| print::dense_class(&class) + ";\n").collect::<String>()));
    }
    let class = asked(session, &name);
    Ok(text(class.map_or(String::new(), |class| print::dense_class(&class) + ";")))
}

const GET_COMPONENTS: &str = r#"
function getComponents "Components declared in a class: type, name, description, visibility, final, flow, stream, replaceable, variability, inner or outer, causality, sizes."
  input TypeName className;
  input Boolean useQuotes = false "whether types and names are strings";
  output Any components;
end getComponents;
"#;

fn get_components(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let name: Name = args.take("className")?;
    let quotes: bool = args.take("useQuotes")?;
    let Some(class) = asked(session, &name) else { return Ok(text(String::new())) };
    let all: Vec<String> =
        components(&class).iter().map(|component| component.described(quotes)).collect();
    Ok(Value::VariableName(format!("{{{}}}", all.join(",")).into()))
}

const GET_NTH_COMPONENT: &str = r#"
function getNthComponent "Type, name and description of a component."
  input TypeName className;
  input Integer n "from 1";
  output Any result;
end getNthComponent;
"#;

fn get_nth_component(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let (name, n): (Name, i64) = (args.take("className")?, args.take("n")?);
    let Some(class) = asked(session, &name) else { return Ok(text(String::new())) };
    let all = components(&class);
    let Some(component) = usize::try_from(n - 1).ok().and_then(|at| all.get(at)) else {
        bail!(BAD_ARGUMENT, "`{name}` has {} components; there is no component {n}", all.len())
    };
    let (kind, own) = (&component.clause.type_specifier.name, component.one.name.node);
    let shown = format!("{{{kind},{own},{}}}", component.description());
    Ok(Value::VariableName(shown.into()))
}

const GET_COMPONENT_COUNT: &str = r#"
function getComponentCount "Number of components declared in a class."
  input TypeName class_;
  output Integer count;
end getComponentCount;
"#;

fn get_component_count(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let name: Name = args.take("class_")?;
    let class = asked(session, &name);
    Ok(Value::Integer(class.map_or(0, |class| components(&class).len() as i64)))
}

/// A component with its clause and the section that contains it.
pub(super) struct Component<'c> {
    pub clause: &'c ComponentClause,
    pub one: &'c ComponentDeclaration,
    pub protected: bool,
}

/// The names of the components that a class declares itself.
pub(crate) fn component_names(class: &ClassDefinition) -> Vec<Ident> {
    components(class).into_iter().map(|component| component.one.name.node).collect()
}

/// The names of the public constants that a class declares itself.
pub(super) fn constant_names(class: &ClassDefinition) -> Vec<Ident> {
    let is_constant = |component: &Component<'_>| {
        let variability = component.clause.type_prefixes.variability;
        !component.protected && variability == Some(VariabilityPrefix::Constant)
    };
    let constants = components(class).into_iter().filter(is_constant);
    constants.map(|component| component.one.name.node).collect()
}

pub(super) fn components(class: &ClassDefinition) -> Vec<Component<'_>> {
    let ClassSpecifier::Long(long) = &class.specifier else { return Vec::new() };
    let mut found = Vec::new();
    for section in &long.sections {
        let Section::Elements { visibility, elements } = section else { continue };
        let protected = *visibility == Some(Visibility::Protected);
        for element in elements {
            let Element::Component(clause) = element else { continue };
            let all = clause.components.iter();
            found.extend(all.map(|one| Component { clause, one, protected }));
        }
    }
    found
}

impl Component<'_> {
    fn description(&self) -> String {
        print::string_literal(self.one.comment.text.as_deref().unwrap_or_default())
    }

    fn described(&self, quotes: bool) -> String {
        let quoted = |text: String| if quotes { print::string_literal(&text) } else { text };
        let (prefixes, types) = (&self.clause.prefixes, &self.clause.type_prefixes);
        let visibility = if self.protected { "protected" } else { "public" };
        let variability = match types.variability {
            Some(VariabilityPrefix::Constant) => "constant",
            Some(VariabilityPrefix::Parameter) => "parameter",
            Some(VariabilityPrefix::Discrete) => "discrete",
            None => "unspecified",
        };
        let scope = match (prefixes.inner, prefixes.outer) {
            (true, true) => "innerouter",
            (true, false) => "inner",
            (false, true) => "outer",
            (false, false) => "none",
        };
        let causality = match types.causality {
            Some(CausalityPrefix::Input) => "input",
            Some(CausalityPrefix::Output) => "output",
            None => "unspecified",
        };
        let sizes: Vec<String> =
            self.clause.subscripts.iter().chain(&self.one.subscripts).map(subscript).collect();
        format!(
            "{{{},{},{},\"{visibility}\",{},{},{},{},\"{variability}\",\"{scope}\",\"{causality}\",{{{}}}}}",
            quoted(self.clause.type_specifier.name.to_string()),
            quoted(self.one.name.node.to_string()),
            self.description(),
            prefixes.is_final,
            types.connection == Some(ConnectionPrefix::Flow),
            types.connection == Some(ConnectionPrefix::Stream),
            prefixes.replaceable,
            sizes.join(",")
        )
    }
}

pub(super) fn subscript(subscript: &Subscript) -> String {
    match subscript {
        Subscript::Index(size) => print::expression(size),
        Subscript::All(_) => ":".to_owned(),
    }
}

const GET_PARAMETER_VALUE: &str = r#"
function getParameterValue "The declared value of a parameter, as written."
  input TypeName class_;
  input String parameterName;
  output String parameterValue "empty if it has none";
end getParameterValue;
"#;

fn get_parameter_value(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let name: Name = args.take("class_")?;
    let requested: String = args.take("parameterName")?;
    let Some(class) = asked(session, &name) else { return Ok(text(String::new())) };
    let all = components(&class);
    let Some(component) = all.iter().find(|component| component.one.name.node == *requested) else {
        let known = all.iter().map(|component| component.one.name.node.as_str());
        let hint = crate::diag::suggest::did_you_mean(&requested, known);
        let fault = fault!(BAD_ARGUMENT, "`{name}` does not declare `{requested}`").help_if(hint);
        session.report_fault(fault);
        return Ok(text(String::new()));
    };
    let binding = component.one.modification.as_ref().and_then(|m| m.binding.as_ref());
    Ok(text(match binding {
        Some(Binding::Expression(value)) => print::expression(value),
        _ => String::new(),
    }))
}

const SET_PARAMETER_VALUE: &str = r#"
function setParameterValue "Changes the declared value of a parameter."
  input TypeName className;
  input VariableName variableName;
  input Expression value "not evaluated";
  output Boolean success;
end setParameterValue;
"#;

fn set_parameter_value(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let (class, name): (Name, String) = (args.take("className")?, args.take("variableName")?);
    let value: String = args.take("value")?;
    let done = modified(session, &class, &name, &format!("= {value}"));
    answer(session, done)
}

const SET_ELEMENT_MODIFIER_VALUE: &str = r#"
function setElementModifierValue "Changes the modifier of an element of a class, or of a nested element."
  input TypeName className;
  input VariableName elementName "x, or x.start for a modifier in the parentheses after x";
  input Expression modifier "a value, not evaluated; or $Code(= value), $Code((name = value)), $Code(()) to remove it";
  output Boolean success;
end setElementModifierValue;
"#;

const SET_COMPONENT_MODIFIER_VALUE: &str = r#"
function setComponentModifierValue "Changes the modifier of an element of a class, or of a nested element."
  input TypeName className;
  input VariableName elementName "x, or x.start for a modifier in the parentheses after x";
  input Expression modifier "a value, not evaluated; or $Code(= value), $Code((name = value)), $Code(()) to remove it";
  output Boolean success;
end setComponentModifierValue;
"#;

fn set_element_modifier_value(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let (class, name): (Name, String) = (args.take("className")?, args.take("elementName")?);
    let value: String = args.take("modifier")?;
    let code = value.strip_prefix("$Code(").and_then(|code| code.strip_suffix(')'));
    let modification = match code.map(str::trim) {
        Some(code) if code.starts_with(['=', '(']) => code.to_owned(),
        Some(code) => format!("= {code}"),
        None => format!("= {value}"),
    };
    let done = modified(session, &class, &name, &modification);
    answer(session, done)
}

fn answer(session: &mut Session, done: Result<(), Failure>) -> Result<Value, Failure> {
    match done {
        Ok(()) => Ok(true.into()),
        Err(Failure::Here(fault)) => Ok(session.succeeded(Err(fault))),
        Err(Failure::Elsewhere(errors)) => {
            Ok(session.or_report_all::<()>(Err(errors)).is_some().into())
        }
    }
}

/// Gives an element of a class, or an element of its modification, another modification, as it is
/// written after the element's name. A binding leaves the part in parentheses unchanged; `()`
/// takes the binding away.
fn modified(
    session: &mut Session,
    class: &Name,
    element: &str,
    modification: &str,
) -> Result<(), Failure> {
    let path: Vec<Ident> = Name::parse(element).parts.to_vec();
    let new = parsed_modification(modification)?;
    let shown = class.to_string();
    edited(session, class, |definition| {
        let Some((first, rest)) = path.split_first() else { return false };
        let Some(component) = component_mut(definition, *first) else { return false };
        let whole = component.modification.get_or_insert_with(no_modification);
        let part = match rest {
            [] => Some(whole),
            rest => modification_at(&mut whole.arguments, rest),
        };
        let Some(part) = part else { return false };
        if new.binding.is_some() || new.arguments.is_empty() {
            part.binding = new.binding;
        }
        if !new.arguments.is_empty() {
            part.arguments = new.arguments;
        }
        if let Some(whole) = &mut component.modification {
            prune(&mut whole.arguments);
        }
        true
    })?
    .then_some(())
    .ok_or_else(|| fault!(BAD_ARGUMENT, "`{shown}` does not declare `{element}`").into())
}

/// Takes elements away whose modification says nothing.
fn prune(arguments: &mut Vec<Argument>) {
    arguments.retain_mut(|argument| {
        let Argument::Element(element) = argument else { return true };
        let Some(modification) = &mut element.modification else { return true };
        prune(&mut modification.arguments);
        !modification.arguments.is_empty() || modification.binding.is_some()
    });
}

fn parsed_modification(text: &str) -> Result<Modification, Fault> {
    let wrong = |error: Diagnostic| Fault::new(BAD_ARGUMENT, error.message.clone());
    let whole = format!("class_(element_{text})");
    let (_, mut arguments) =
        syntax::parse_class_with_modification(SourceId::NONE, &whole).map_err(wrong)?;
    match (arguments.pop(), arguments.is_empty()) {
        (Some(Argument::Element(element)), true) => {
            Ok(element.modification.unwrap_or_else(no_modification))
        }
        _ => Err(fault!(BAD_ARGUMENT, "`{text}` is not a modification of one element")),
    }
}

fn component_mut(class: &mut ClassDefinition, name: Ident) -> Option<&mut ComponentDeclaration> {
    let ClassSpecifier::Long(long) = &mut class.specifier else { return None };
    long.sections.iter_mut().find_map(|section| {
        let Section::Elements { elements, .. } = section else { return None };
        elements.iter_mut().find_map(|element| match element {
            Element::Component(clause) => {
                clause.components.iter_mut().find(|one| one.name.node == name)
            }
            _ => None,
        })
    })
}

/// Changes a class at its place in the class at the top level; what `edit` returned.
fn edited<T>(
    session: &mut Session,
    name: &Name,
    edit: impl FnOnce(&mut ClassDefinition) -> T,
) -> Result<T, Failure> {
    definition(session, name)?;
    let mut root = definition(session, &Name::new(name.first()))?;
    let mut current = Arc::make_mut(&mut root);
    for part in &name.parts[1..] {
        let Some(inner) = class_in(current, *part) else {
            bail!(
                BAD_ARGUMENT,
                "`{name}` is stored in a separate file, which cannot be changed here"
            )
        };
        current = inner;
    }
    let result = edit(current);
    session.classes.define(&root)?;
    Ok(result)
}

fn class_in(class: &mut ClassDefinition, name: Ident) -> Option<&mut ClassDefinition> {
    let ClassSpecifier::Long(long) = &mut class.specifier else { return None };
    long.sections.iter_mut().find_map(|section| {
        let Section::Elements { elements, .. } = section else { return None };
        elements.iter_mut().find_map(|element| match element {
            Element::Class(inner) if inner.class.name.node == name => {
                Some(Arc::make_mut(&mut inner.class))
            }
            _ => None,
        })
    })
}

const GET_SIMULATION_OPTIONS: &str = r#"
function getSimulationOptions "The settings of a model's experiment annotation, or the defaults."
  input TypeName name;
  input Real defaultStartTime = 0.0;
  input Real defaultStopTime = 1.0;
  input Real defaultTolerance = 1e-6;
  input Integer defaultNumberOfIntervals = 500;
  input Real defaultInterval = 0.0;
  output Real startTime;
  output Real stopTime;
  output Real tolerance;
  output Integer numberOfIntervals;
  output Real interval;
end getSimulationOptions;
"#;

fn get_simulation_options(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let name: Name = args.take("name")?;
    let experiment =
        simulation::flat_model(session, &name.to_string()).map_err(Failure::Elsewhere)?.experiment;
    let default = |name: &str, args: &mut Args| args.take::<f64>(name);
    let start = experiment.start_time.map_or_else(|| default("defaultStartTime", &mut args), Ok)?;
    let stop = experiment.stop_time.map_or_else(|| default("defaultStopTime", &mut args), Ok)?;
    let tolerance =
        experiment.tolerance.map_or_else(|| default("defaultTolerance", &mut args), Ok)?;
    let intervals: i64 = args.take("defaultNumberOfIntervals")?;
    let length = default("defaultInterval", &mut args)?;
    let interval = experiment.interval.or((length > 0.0).then_some(length));
    let (intervals, interval) = match interval {
        Some(interval) => (((stop - start) / interval).round() as i64, interval),
        None => (intervals, (stop - start) / intervals.max(1) as f64),
    };
    let numbers = [start, stop, tolerance].map(Value::Real);
    Ok(Value::Tuple([&numbers[..], &[intervals.into(), interval.into()]].concat()))
}

const SAVE_MODEL: &str = r#"
function saveModel "Writes the source text of a class to a file."
  input String fileName;
  input TypeName className;
  output Boolean success;
end saveModel;
"#;

fn save_model(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let (file, name): (String, Name) = (args.take("fileName")?, args.take("className")?);
    let Some(class) = asked(session, &name) else { return Ok(false.into()) };
    let within = match name.parts.len() {
        1 => String::new(),
        _ => format!("within {};\n", name.parent()),
    };
    let contents = format!("{within}{};\n", print::class(&class));
    let written = session.world.write_file(Path::new(&file), contents.as_bytes());
    Ok(session.succeeded(written))
}

const TYPE_OF: &str = r#"
function typeOf "The type of a variable of the script."
  input VariableName variableName;
  output String result "empty if there is no such variable";
end typeOf;
"#;

fn type_of(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let name: String = args.take("variableName")?;
    Ok(text(session.variable(&name).map_or(String::new(), Value::type_name)))
}
