//! A class of predefined types only, as a flat model: no lookup, no modification.

use gapilib::internals::eval::{Function, FunctionBody, FunctionComponent, ValueType};
use gapilib::internals::flatten::{Attribute, BaseType, FlatModel, Variability, Variable};
use gapilib::internals::name::Name;
use gapilib::internals::source::SourceId;
use gapilib::internals::syntax::ast::*;
use gapilib::internals::syntax::parse_stored_definition;

/// The flat model of the only class of a text.
pub(crate) fn flat(text: &str) -> FlatModel {
    let stored = parse_stored_definition(SourceId(0), text).expect("the text parses");
    let class = stored.classes.first().expect("the text has a class");
    let ClassSpecifier::Long(body) = &class.specifier else { panic!("a long class is needed") };
    let mut model = FlatModel { name: class.name.node.to_string(), ..FlatModel::default() };
    for section in &body.sections {
        match section {
            Section::Elements { elements, .. } => {
                for element in elements {
                    match element {
                        Element::Component(clause) => components(&mut model, clause),
                        Element::Class(class) => function(&mut model, &class.class),
                        _ => panic!("only components and functions"),
                    }
                }
            }
            Section::Equations { initial: false, equations, .. } => {
                model.equations.extend(equations.clone());
            }
            Section::Equations { equations, .. } => {
                model.initial_equations.extend(equations.clone());
            }
            Section::Algorithm { statements, .. } => model.algorithms.push(statements.clone()),
            _ => {}
        }
    }
    model
}

fn components(model: &mut FlatModel, clause: &ComponentClause) {
    let base = match clause.type_specifier.name.to_string().as_str() {
        "Real" => BaseType::Real,
        "Integer" => BaseType::Integer,
        "Boolean" => BaseType::Boolean,
        other => panic!("the type {other} is not predefined"),
    };
    for component in &clause.components {
        let subscripts = clause.subscripts.iter().chain(&component.subscripts);
        let size = |s: &Subscript| match s {
            Subscript::Index(Expression { kind: ExpressionKind::Integer(n), .. }) => *n as usize,
            _ => panic!("sizes are literals"),
        };
        let dims: Vec<usize> = subscripts.map(size).collect();
        let variability = match clause.type_prefixes.variability {
            Some(VariabilityPrefix::Constant) => Variability::Constant,
            Some(VariabilityPrefix::Parameter) => Variability::Parameter,
            Some(VariabilityPrefix::Discrete) => Variability::Discrete,
            None if base == BaseType::Real => Variability::Continuous,
            None => Variability::Discrete,
        };
        let mut variable = Variable {
            name: component.name.node.as_str().into(),
            base: base.clone(),
            dims,
            variability,
            causality: clause.type_prefixes.causality,
            is_input: false,
            is_final: clause.prefixes.is_final,
            protected: false,
            evaluate: false,
            is_relative: false,
            structural: false,
            top_level: true,
            attributes: Default::default(),
            binding: None,
            description: component.comment.text.clone(),
            span: component.span,
        };
        if let Some(modification) = &component.modification {
            if let Some(Binding::Expression(e)) = &modification.binding {
                variable.binding = Some(e.clone());
            }
            for argument in &modification.arguments {
                attribute(&mut variable, argument);
            }
        }
        model.variables.insert(variable.name.clone(), variable);
    }
}

fn attribute(variable: &mut Variable, argument: &Argument) {
    let Argument::Element(element) = argument else { panic!("no redeclarations") };
    let names = ["start", "fixed", "min", "max", "nominal", "unit"];
    let name = element.name.node.to_string();
    let name = names.into_iter().find(|n| *n == name).expect("a known attribute");
    let binding = element.modification.as_ref().and_then(|m| m.binding.clone());
    let Some(Binding::Expression(value)) = binding else { panic!("an attribute has a value") };
    variable.attributes.insert(name, Attribute { value, is_final: false });
}

/// A function of predefined types only.
fn function(model: &mut FlatModel, class: &ClassDefinition) {
    let ClassSpecifier::Long(body) = &class.specifier else { panic!("a long class is needed") };
    let name = Name::from(class.name.node);
    let mut function = Function {
        name: name.clone(),
        inputs: Vec::new(),
        outputs: Vec::new(),
        locals: Vec::new(),
        body: FunctionBody::Algorithm(Vec::new()),
        description: None,
        annotation: Vec::new(),
        impure: false,
        span: class.span,
    };
    for section in &body.sections {
        match section {
            Section::Elements { elements, .. } => {
                for element in elements {
                    let Element::Component(clause) = element else { panic!("only components") };
                    let list = match clause.type_prefixes.causality {
                        Some(CausalityPrefix::Input) => &mut function.inputs,
                        Some(CausalityPrefix::Output) => &mut function.outputs,
                        None => &mut function.locals,
                    };
                    for component in &clause.components {
                        let modification = component.modification.as_ref();
                        let binding = match modification.and_then(|m| m.binding.clone()) {
                            Some(Binding::Expression(e)) => Some(e),
                            _ => None,
                        };
                        list.push(FunctionComponent {
                            name: component.name.node,
                            value_type: match clause.type_specifier.name.to_string().as_str() {
                                "Integer" => ValueType::Integer,
                                "Boolean" => ValueType::Boolean,
                                _ => ValueType::Real,
                            },
                            dims: component.subscripts.clone(),
                            field_dims: Vec::new(),
                            binding,
                            description: None,
                            span: component.span,
                        });
                    }
                }
            }
            Section::Algorithm { statements, .. } => {
                function.body = FunctionBody::Algorithm(statements.clone());
            }
            Section::External(external) => {
                function.body = FunctionBody::External(external.clone());
            }
            Section::Annotation(annotation) => {
                function.annotation.extend(annotation.arguments.clone());
            }
            _ => {}
        }
    }
    model.functions.insert(name, std::sync::Arc::new(function));
}
