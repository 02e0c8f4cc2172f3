//! Questions about loaded classes: what they are, and what their source text says.

use super::classes::{Component, asked, components};
use super::strings::{string_array, text};
use super::{Args, Builtin, Failure, Family};
use crate::bail;
use crate::errors::BAD_ARGUMENT;
use crate::name::Name;
use crate::syntax::ast::{
    Annotation, Argument, Binding, ClassDefinition, ClassSpecifier, Element, Equation,
    EquationKind, ExpressionKind, Extends, Modification, Restriction, Section, VariabilityPrefix,
};
use crate::syntax::print;
use crate::value::Value;
use crate::{Dialect, Session};
use std::sync::Arc;

macro_rules! questions {
    ($($name:literal: $what:literal, $answer:expr);* $(;)?) => {
        [$(Builtin {
            header: concat!(
                "function ", $name, " \"Whether a class is ", $what, "; false if the class is \
                    not loaded.\"\n",
                "  input TypeName cl;\n  output Boolean b;\nend ", $name, ";\n"
            ),
            run: |session, args| question(session, args, $answer),
        }),*]
    };
}

/// What kind of class it is.
static QUESTIONS: [Builtin; 15] = questions![
    "isModel": "a model", |c| c.restriction == Restriction::Model;
    "isPackage": "a package", |c| c.restriction == Restriction::Package;
    "isBlock": "a block", |c| c.restriction == Restriction::Block;
    "isClass": "declared with the keyword class", |c| c.restriction == Restriction::Class;
    "isFunction": "a function", |c| matches!(c.restriction, Restriction::Function { .. });
    "isRecord": "a record", |c| c.restriction == Restriction::Record;
    "isConnector": "a connector",
        |c| matches!(c.restriction, Restriction::Connector | Restriction::ExpandableConnector);
    "isType": "a type", |c| c.restriction == Restriction::Type;
    "isOperator": "an operator", |c| c.restriction == Restriction::Operator;
    "isOperatorFunction": "an operator function",
        |c| matches!(c.restriction, Restriction::Function { operator: true, .. });
    "isOperatorRecord": "an operator record", |c| c.restriction == Restriction::OperatorRecord;
    "isEnumeration": "an enumeration",
        |c| matches!(c.specifier, ClassSpecifier::Enumeration(_));
    "isPartial": "partial", |c| c.partial;
    "isShortDefinition": "defined by another class",
        |c| matches!(c.specifier, ClassSpecifier::Short(_));
    "isExperiment": "a complete model with an experiment annotation",
        |c| !c.partial && annotation(c, "experiment").is_some();
];

/// The commands that ask what kind of class something is.
pub(super) static KINDS: Family = Family {
    packages: &["OpenModelica.Scripting"],
    dialect: Some(Dialect::OpenModelica),
    builtins: &QUESTIONS,
};

/// The other commands of this file.
pub(super) const FAMILY: Family = Family {
    packages: &["OpenModelica.Scripting"],
    dialect: Some(Dialect::OpenModelica),
    builtins: &[
        Builtin { header: GET_CLASS_COMMENT, run: get_class_comment },
        Builtin { header: GET_CLASS_RESTRICTION, run: get_class_restriction },
        Builtin { header: GET_CLASS_INFORMATION, run: get_class_information },
        Builtin { header: GET_PACKAGES, run: get_packages },
        Builtin { header: GET_INHERITANCE_COUNT, run: get_inheritance_count },
        Builtin { header: GET_NTH_INHERITED_CLASS, run: get_nth_inherited_class },
        Builtin { header: GET_INHERITED_CLASSES, run: get_inherited_classes },
        Builtin { header: GET_CONNECTION_COUNT, run: get_connection_count },
        Builtin { header: GET_NTH_CONNECTION, run: get_nth_connection },
        Builtin { header: GET_DOCUMENTATION_ANNOTATION, run: get_documentation_annotation },
        Builtin { header: CLASS_ANNOTATION_EXISTS, run: class_annotation_exists },
        Builtin { header: GET_COMPONENT_MODIFIER_NAMES, run: get_component_modifier_names },
        Builtin { header: GET_COMPONENT_MODIFIER_VALUE, run: get_component_modifier_value },
        Builtin { header: GET_ELEMENT_MODIFIER_NAMES, run: get_component_modifier_names },
        Builtin { header: GET_ELEMENT_MODIFIER_VALUE, run: get_component_modifier_value },
        Builtin { header: GET_EXTENDS_MODIFIER_NAMES, run: get_extends_modifier_names },
        Builtin { header: IS_PARAMETER, run: is_parameter },
        Builtin { header: IS_CONSTANT, run: is_constant },
        Builtin { header: IS_PROTECTED, run: is_protected },
    ],
};

fn question(
    session: &mut Session,
    mut args: Args,
    answer: fn(&ClassDefinition) -> bool,
) -> Result<Value, Failure> {
    let name: Name = args.take("cl")?;
    let found = session.class_exists(&name);
    let class = if found { session.library().definition(&name) } else { None };
    Ok(class.is_some_and(|class| answer(&class)).into())
}

fn class(session: &mut Session, args: &mut Args) -> Result<Option<Arc<ClassDefinition>>, Failure> {
    let name: Name = args.take("cl")?;
    Ok(asked(session, &name))
}

const GET_CLASS_COMMENT: &str = r#"
function getClassComment "The description string of a class."
  input TypeName cl;
  output String comment;
end getClassComment;
"#;

fn get_class_comment(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let class = class(session, &mut args)?;
    Ok(text(class.and_then(|class| comment(&class)).unwrap_or_default()))
}

fn comment(class: &ClassDefinition) -> Option<String> {
    let found = match &class.specifier {
        ClassSpecifier::Long(long) => long.description.as_deref(),
        ClassSpecifier::Short(short) => short.comment.text.as_deref(),
        ClassSpecifier::Enumeration(enumeration) => enumeration.comment.text.as_deref(),
        ClassSpecifier::Derivative(_) => None,
    };
    found.map(str::to_owned)
}

const GET_CLASS_RESTRICTION: &str = r#"
function getClassRestriction "The keyword of a class: model, package, function, …"
  input TypeName cl;
  output String restriction "empty if the class is not loaded";
end getClassRestriction;
"#;

fn get_class_restriction(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let class = class(session, &mut args)?;
    Ok(class.map_or("", |class| restriction(&class)).into())
}

fn restriction(class: &ClassDefinition) -> &'static str {
    match class.restriction {
        Restriction::Function { operator: true, .. } => "operator function",
        other => other.keyword(),
    }
}

const GET_CLASS_INFORMATION: &str = r#"
function getClassInformation "Information from the declaration of a class."
  input TypeName cl;
  output String restriction;
  output String comment;
  output Boolean partialPrefix;
  output Boolean finalPrefix;
  output Boolean encapsulatedPrefix;
  output String fileName "empty if it was not loaded from a file";
  output Boolean fileReadOnly "always false";
  output Integer lineNumberStart;
  output Integer columnNumberStart;
  output Integer lineNumberEnd;
  output Integer columnNumberEnd;
  output String dimensions[:] "dimensions of an array type";
  output Boolean isProtectedClass;
  output Boolean isDocumentationClass;
  output String version;
  output String preferredView;
end getClassInformation;
"#;

fn get_class_information(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let name: Name = args.take("cl")?;
    let Some(class) = asked(session, &name) else { return Ok(Value::nothing()) };
    let file = session.source_file(&name).map_or(String::new(), |f| f.display().to_string());
    let start =
        session.sources.line_column(crate::source::Span { end: class.span.start, ..class.span });
    let end =
        session.sources.line_column(crate::source::Span { start: class.span.end, ..class.span });
    let place = |place: Option<crate::source::LineColumn>| {
        let (line, column) = place.map_or((0, 0), |place| (place.line, place.column));
        [Value::Integer(line as i64), Value::Integer(column as i64)]
    };
    let dims = match &class.specifier {
        ClassSpecifier::Short(short) => {
            short.subscripts.iter().map(super::classes::subscript).collect()
        }
        _ => Vec::new(),
    };
    let said = |name: &str| annotation(&class, name).and_then(string).unwrap_or_default();
    let documentation = annotation(&class, "DocumentationClass").and_then(expression);
    let is_documentation = matches!(documentation, Some(ExpressionKind::Boolean(true)));
    let mut values = vec![
        text(restriction(&class).to_owned()),
        text(comment(&class).unwrap_or_default()),
        class.partial.into(),
        class.is_final.into(),
        class.encapsulated.into(),
        text(file),
        false.into(),
    ];
    values.extend(place(start).into_iter().chain(place(end)));
    values.push(string_array(dims));
    values.push(super::loading::is_protected(session, &name).into());
    values.extend([is_documentation.into(), text(said("version")), text(said("preferredView"))]);
    Ok(Value::Tuple(values))
}

const GET_PACKAGES: &str = r#"
function getPackages "Names of the packages in a class, or at the top level."
  input TypeName class_ = AllLoadedClasses;
  output TypeName classNames[:];
end getPackages;
"#;

fn get_packages(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let class: Name = args.take("class_")?;
    let at_top = class.last().is_some_and(|name| name == "AllLoadedClasses");
    if !at_top && asked(session, &class).is_none() {
        return Ok(Vec::<String>::new().into());
    }
    let library = session.library();
    let names = match at_top {
        true => library.roots().map(Name::from).collect(),
        false => library.children(&class).into_iter().map(|n| class.child(n)).collect::<Vec<_>>(),
    };
    let is_package = |name: &&Name| {
        let class = library.definition(name);
        class.is_some_and(|class| class.restriction == Restriction::Package)
    };
    let found = names.iter().filter(is_package).filter_map(|name| name.last());
    Ok(found.map(|name| name.to_string()).collect::<Vec<_>>().into())
}

const GET_INHERITANCE_COUNT: &str = r#"
function getInheritanceCount "Number of base classes of a class."
  input TypeName cl;
  output Integer count;
end getInheritanceCount;
"#;

fn get_inheritance_count(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let class = class(session, &mut args)?;
    Ok(Value::Integer(class.map_or(0, |class| bases(&class).len() as i64)))
}

const GET_NTH_INHERITED_CLASS: &str = r#"
function getNthInheritedClass "A base class of a class, as written."
  input TypeName cl;
  input Integer n "from 1";
  output TypeName baseClass;
end getNthInheritedClass;
"#;

fn get_nth_inherited_class(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let Some(class) = class(session, &mut args)? else { return Ok("".into()) };
    let (bases, n): (_, i64) = (bases(&class), args.take("n")?);
    match usize::try_from(n - 1).ok().and_then(|at| bases.into_iter().nth(at)) {
        Some(base) => Ok(Value::TypeName(base)),
        None => bail!(BAD_ARGUMENT, "`{}` has no base class {n}", class.name.node),
    }
}

const GET_INHERITED_CLASSES: &str = r#"
function getInheritedClasses "The base classes of a class, as written."
  input TypeName cl;
  output TypeName inheritedClasses[:];
end getInheritedClasses;
"#;

fn get_inherited_classes(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let class = class(session, &mut args)?;
    let bases = class.map_or(Vec::new(), |class| bases(&class));
    Ok(bases.iter().map(Name::to_string).collect::<Vec<_>>().into())
}

/// The classes that a class extends, as written.
fn bases(class: &ClassDefinition) -> Vec<Name> {
    match &class.specifier {
        ClassSpecifier::Short(short) => vec![short.target.name.clone()],
        _ => extends(class).map(|extends| extends.base.name.clone()).collect(),
    }
}

fn extends(class: &ClassDefinition) -> impl Iterator<Item = &Extends> {
    let elements = sections(class).filter_map(|section| match section {
        Section::Elements { elements, .. } => Some(elements),
        _ => None,
    });
    elements.flatten().filter_map(|element| match element {
        Element::Extends(extends) => Some(extends),
        _ => None,
    })
}

fn sections(class: &ClassDefinition) -> impl Iterator<Item = &Section> {
    let long = match &class.specifier {
        ClassSpecifier::Long(long) => Some(long),
        _ => None,
    };
    long.into_iter().flat_map(|long| long.sections.iter())
}

const GET_CONNECTION_COUNT: &str = r#"
function getConnectionCount "Number of connect equations of a class."
  input TypeName cl;
  output Integer count;
end getConnectionCount;
"#;

fn get_connection_count(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let class = class(session, &mut args)?;
    Ok(Value::Integer(class.map_or(0, |class| connections(&class).len() as i64)))
}

const GET_NTH_CONNECTION: &str = r#"
function getNthConnection "The two connectors of a connect equation and its description string."
  input TypeName cl;
  input Integer index "from 1";
  output String result[:];
end getNthConnection;
"#;

fn get_nth_connection(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let Some(class) = class(session, &mut args)? else { return Ok(string_array([])) };
    let (all, n): (_, i64) = (connections(&class), args.take("index")?);
    match usize::try_from(n - 1).ok().and_then(|at| all.into_iter().nth(at)) {
        Some(found) => Ok(string_array(found)),
        None => bail!(BAD_ARGUMENT, "`{}` has no connection {n}", class.name.node),
    }
}

fn connections(class: &ClassDefinition) -> Vec<[String; 3]> {
    let equations = sections(class).filter_map(|section| match section {
        Section::Equations { equations, .. } => Some(equations),
        _ => None,
    });
    equations.flatten().filter_map(connection).collect()
}

fn connection(equation: &Equation) -> Option<[String; 3]> {
    let EquationKind::Connect { left, right } = &equation.kind else { return None };
    let comment = equation.comment.text.as_deref().unwrap_or_default();
    Some([print::reference(left), print::reference(right), comment.to_owned()])
}

const GET_DOCUMENTATION_ANNOTATION: &str = r#"
function getDocumentationAnnotation "The info, revisions and info header of the Documentation annotation of a class."
  input TypeName cl;
  output String out[3];
end getDocumentationAnnotation;
"#;

fn get_documentation_annotation(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let class = class(session, &mut args)?;
    let documentation = class.as_deref().and_then(|class| annotation(class, "Documentation"));
    let said = |name: &str| {
        let all = documentation.iter().flat_map(|whole| &whole.arguments).filter_map(named);
        all.filter(|(known, _)| known == name).find_map(|(_, m)| string(m)).unwrap_or_default()
    };
    Ok(string_array([said("info"), said("revisions"), said("__OpenModelica_infoHeader")]))
}

const CLASS_ANNOTATION_EXISTS: &str = r#"
function classAnnotationExists "Whether a class has an annotation of this name."
  input TypeName cl;
  input TypeName annotationName;
  output Boolean exists;
end classAnnotationExists;
"#;

fn class_annotation_exists(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let name: Name = args.take("annotationName")?;
    let class = class(session, &mut args)?;
    let found = class.as_deref().and_then(|class| annotation(class, &name.to_string()));
    Ok(found.is_some().into())
}

/// An annotation of a class.
fn annotation<'c>(class: &'c ClassDefinition, requested: &str) -> Option<&'c Modification> {
    let own = |section: &'c Section| match section {
        Section::Annotation(annotation) => Some(annotation),
        _ => None,
    };
    let short: Option<&Annotation> = match &class.specifier {
        ClassSpecifier::Short(short) => short.comment.annotation.as_ref(),
        ClassSpecifier::Enumeration(enumeration) => enumeration.comment.annotation.as_ref(),
        _ => None,
    };
    let all = sections(class).filter_map(own).chain(short);
    let mut arguments = all.flat_map(|annotation| &annotation.arguments).filter_map(named);
    arguments.find(|(name, _)| name == requested).map(|(_, modification)| modification)
}

fn named(argument: &Argument) -> Option<(String, &Modification)> {
    match argument {
        Argument::Element(element) => {
            Some((element.name.node.to_string(), element.modification.as_ref()?))
        }
        Argument::Redeclaration(_) => None,
    }
}

fn expression(modification: &Modification) -> Option<&ExpressionKind> {
    match modification.binding.as_ref()? {
        Binding::Expression(value) => Some(&value.kind),
        Binding::Break(_) => None,
    }
}

fn string(modification: &Modification) -> Option<String> {
    match expression(modification)? {
        ExpressionKind::String(text) => Some(text.to_string()),
        _ => None,
    }
}

const GET_COMPONENT_MODIFIER_NAMES: &str = r#"
function getComponentModifierNames "Names of the modifiers of a component; nested names contain dots."
  input TypeName cl;
  input VariableName componentName;
  output String modifiers[:];
end getComponentModifierNames;
"#;

const GET_ELEMENT_MODIFIER_NAMES: &str = r#"
function getElementModifierNames "Names of the modifiers of a component; nested names contain dots."
  input TypeName cl;
  input VariableName componentName;
  output String modifiers[:];
end getElementModifierNames;
"#;

fn get_component_modifier_names(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let requested: String = args.take("componentName")?;
    let class = class(session, &mut args)?;
    let arguments = class.as_deref().and_then(|class| modification_of(class, &requested));
    Ok(string_array(arguments.map_or(Vec::new(), |whole| modified_names("", &whole.arguments))))
}

const GET_COMPONENT_MODIFIER_VALUE: &str = r#"
function getComponentModifierValue "The modifier of a component or of an element in it, as written."
  input TypeName cl;
  input VariableName modifier "component, or component.modified";
  output String value "empty if it is not modified";
end getComponentModifierValue;
"#;

const GET_ELEMENT_MODIFIER_VALUE: &str = r#"
function getElementModifierValue "The modifier of a component or of an element in it, as written."
  input TypeName cl;
  input VariableName modifier "component, or component.modified";
  output String value "empty if it is not modified";
end getElementModifierValue;
"#;

fn get_component_modifier_value(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let requested: String = args.take("modifier")?;
    let Some(class) = class(session, &mut args)? else { return Ok(text(String::new())) };
    let (component, inner) = requested.split_once('.').unwrap_or((&requested, ""));
    let whole = modification_of(&class, component);
    let found = whole.and_then(|whole| match inner {
        "" => Some(whole),
        inner => nested(whole, inner),
    });
    Ok(text(match found.and_then(|found| found.binding.as_ref()) {
        Some(Binding::Expression(value)) => print::expression(value),
        _ => String::new(),
    }))
}

/// The modification of a component that a class declares.
fn modification_of<'c>(class: &'c ClassDefinition, name: &str) -> Option<&'c Modification> {
    let name = name.trim_matches('"');
    let found = components(class).into_iter().find(|c| c.one.name.node == *name)?;
    found.one.modification.as_ref()
}

fn nested<'m>(whole: &'m Modification, path: &str) -> Option<&'m Modification> {
    let all = whole.arguments.iter().filter_map(named);
    let mut found = all.filter_map(|(name, modification)| match path.strip_prefix(&name)? {
        "" => Some(modification),
        rest => nested(modification, rest.strip_prefix('.')?),
    });
    found.next()
}

fn modified_names(prefix: &str, arguments: &[Argument]) -> Vec<String> {
    let mut names = Vec::new();
    for (name, modification) in arguments.iter().filter_map(named) {
        let full = format!("{prefix}{name}");
        if modification.binding.is_some() || modification.arguments.is_empty() {
            names.push(full.clone());
        }
        names.extend(modified_names(&format!("{full}."), &modification.arguments));
    }
    names
}

const GET_EXTENDS_MODIFIER_NAMES: &str = r#"
function getExtendsModifierNames "Names of the modifiers of an extends clause."
  input TypeName cl;
  input TypeName baseClass;
  input Boolean useQuotes = false "has no effect";
  output String modifiers[:];
end getExtendsModifierNames;
"#;

fn get_extends_modifier_names(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let base: Name = args.take("baseClass")?;
    let class = class(session, &mut args)?;
    let of_base = |extends: &&Extends| extends.base.name == base;
    let found = class.as_deref().and_then(|class| extends(class).find(of_base));
    Ok(string_array(found.map_or(Vec::new(), |e| modified_names("", &e.modification))))
}

const IS_PARAMETER: &str = r#"
function isParameter "Whether a component of a class is a parameter."
  input TypeName cl;
  input VariableName componentName;
  output Boolean b;
end isParameter;
"#;

fn is_parameter(session: &mut Session, args: Args) -> Result<Value, Failure> {
    of_component(session, args, |component| {
        component.clause.type_prefixes.variability == Some(VariabilityPrefix::Parameter)
    })
}

const IS_CONSTANT: &str = r#"
function isConstant "Whether a component of a class is a constant."
  input TypeName cl;
  input VariableName componentName;
  output Boolean b;
end isConstant;
"#;

fn is_constant(session: &mut Session, args: Args) -> Result<Value, Failure> {
    of_component(session, args, |component| {
        component.clause.type_prefixes.variability == Some(VariabilityPrefix::Constant)
    })
}

const IS_PROTECTED: &str = r#"
function isProtected "Whether a component of a class is protected."
  input TypeName cl;
  input VariableName componentName;
  output Boolean b;
end isProtected;
"#;

fn is_protected(session: &mut Session, args: Args) -> Result<Value, Failure> {
    of_component(session, args, |component| component.protected)
}

fn of_component(
    session: &mut Session,
    mut args: Args,
    answer: fn(&Component<'_>) -> bool,
) -> Result<Value, Failure> {
    let requested: String = args.take("componentName")?;
    let class = class(session, &mut args)?;
    let found = class.as_deref().is_some_and(|class| {
        let all = components(class).into_iter();
        all.filter(|component| component.one.name.node == *requested).any(|c| answer(&c))
    });
    Ok(found.into())
}
