//! A host that knows classes given as text: functions, records, enumerations.

use crate::diag::{Code, Diagnostic, Fault};
use crate::eval::{
    Callee, Function, FunctionBody, FunctionComponent, Host, Scope, ScriptHost, ValueType,
    evaluate, evaluate_dimensions,
};
use crate::name::{Ident, Name};
use crate::source::Span;
use crate::syntax::ast::{
    Binding, CausalityPrefix, ClassDefinition, ClassSpecifier, ComponentClause, ComponentReference,
    Element, Restriction, Section, Subscript,
};
use crate::value::{ArrayValue, Elements, EnumerationDefinition, EnumerationValue, Value};
use indexmap::IndexMap;
use std::sync::Arc;

const STOPPED: Code = Code { slug: "stopped", explanation: "For tests." };

#[derive(Default)]
pub(super) struct TestHost {
    pub(super) functions: IndexMap<String, Arc<Function>>,
    builtins: IndexMap<String, Arc<Function>>,
    records: IndexMap<String, Arc<IndexMap<Ident, FunctionComponent>>>,
    enumerations: IndexMap<String, Arc<EnumerationDefinition>>,
    pub(super) iterations: Vec<(usize, Option<usize>)>,
    pub(super) assigned: Vec<(String, Value)>,
    pub(super) builtin_calls: Vec<Vec<Value>>,
    pub(super) warnings: Vec<Diagnostic>,
    patience: Option<usize>,
}

impl TestHost {
    /// Stops evaluation after so many questions whether to stop.
    pub(super) fn patient(patience: usize) -> TestHost {
        TestHost { patience: Some(patience), ..TestHost::default() }
    }

    /// Adds a class; an `external` function is a builtin of this host.
    pub(super) fn define(&mut self, class: &ClassDefinition) {
        let name = class.name.node.to_string();
        match (&class.specifier, class.restriction) {
            (ClassSpecifier::Enumeration(definition), _) => {
                let literals = definition.literals.iter().flatten().map(|l| l.name.node);
                let definition = EnumerationDefinition {
                    name: Name::parse(&name),
                    literals: literals.collect(),
                    descriptions: Vec::new(),
                };
                self.enumerations.insert(name, Arc::new(definition));
            }
            (ClassSpecifier::Long(long), Restriction::Record) => {
                let (_, _, components, _) = self.components(&long.sections);
                let fields: IndexMap<Ident, FunctionComponent> =
                    components.iter().map(|c| (c.name, c.clone())).collect();
                let fields = Arc::new(fields);
                self.records.insert(name.clone(), fields.clone());
                let output = component_of(ValueType::Record(Name::parse(&name), fields));
                let body = FunctionBody::RecordConstructor;
                self.functions
                    .insert(name.clone(), function(&name, components, vec![output], vec![], body));
            }
            (ClassSpecifier::Long(long), _) => {
                let (inputs, outputs, locals, body) = self.components(&long.sections);
                let external = matches!(body, FunctionBody::External(_));
                let function = function(&name, inputs, outputs, locals, body);
                let table = if external { &mut self.builtins } else { &mut self.functions };
                table.insert(name, function);
            }
            other => panic!("not in these tests: {other:?}"),
        }
    }

    pub(super) fn declare(
        &mut self,
        clause: &ComponentClause,
        scope: &mut Scope,
    ) -> Result<(), Diagnostic> {
        for component in self.clause(clause) {
            let dims = evaluate_dimensions(&component.dims, scope, self)?;
            let value = match &component.binding {
                Some(binding) => Some(evaluate(binding, scope, self)?),
                None => None,
            };
            scope
                .declare(component.name, component.value_type, dims, value)
                .map_err(|fault| fault.at(component.span))?;
        }
        Ok(())
    }

    #[allow(clippy::type_complexity)]
    fn components(
        &self,
        sections: &[Section],
    ) -> (Vec<FunctionComponent>, Vec<FunctionComponent>, Vec<FunctionComponent>, FunctionBody)
    {
        let (mut inputs, mut outputs, mut locals) = (Vec::new(), Vec::new(), Vec::new());
        let mut body = FunctionBody::Algorithm(Vec::new());
        for section in sections {
            match section {
                Section::Elements { elements, .. } => {
                    for element in elements {
                        let Element::Component(clause) = element else { continue };
                        let components = self.clause(clause);
                        match clause.type_prefixes.causality {
                            Some(CausalityPrefix::Input) => inputs.extend(components),
                            Some(CausalityPrefix::Output) => outputs.extend(components),
                            None => locals.extend(components),
                        }
                    }
                }
                Section::Algorithm { statements, .. } => {
                    body = FunctionBody::Algorithm(statements.clone());
                }
                Section::External(external) => body = FunctionBody::External(external.clone()),
                _ => {}
            }
        }
        (inputs, outputs, locals, body)
    }

    fn clause(&self, clause: &ComponentClause) -> Vec<FunctionComponent> {
        let type_name = clause.type_specifier.name.to_string();
        let value_type = match type_name.as_str() {
            "Real" => ValueType::Real,
            "Integer" => ValueType::Integer,
            "Boolean" => ValueType::Boolean,
            "String" => ValueType::String,
            "VariableName" => ValueType::VariableName,
            "TypeName" => ValueType::TypeName,
            "FunctionType" => ValueType::Function,
            name => match (self.records.get(name), self.enumerations.get(name)) {
                (Some(fields), _) => ValueType::Record(Name::parse(name), fields.clone()),
                (_, Some(definition)) => ValueType::Enumeration(definition.clone()),
                _ => panic!("unknown type {name}"),
            },
        };
        let component = |declaration: &crate::syntax::ast::ComponentDeclaration| {
            let modification = declaration.modification.as_ref();
            FunctionComponent {
                name: declaration.name.node,
                value_type: value_type.clone(),
                dims: [declaration.subscripts.as_slice(), &clause.subscripts].concat(),
                field_dims: Vec::new(),
                binding: match modification.and_then(|m| m.binding.clone()) {
                    Some(Binding::Expression(expression)) => Some(expression),
                    _ => None,
                },
                description: None,
                span: declaration.span,
            }
        };
        clause.components.iter().map(component).collect()
    }
}

fn component_of(value_type: ValueType) -> FunctionComponent {
    FunctionComponent {
        name: Ident::new("result"),
        value_type,
        dims: Vec::<Subscript>::new(),
        field_dims: Vec::new(),
        binding: None,
        description: None,
        span: Span::NONE,
    }
}

fn function(
    name: &str,
    inputs: Vec<FunctionComponent>,
    outputs: Vec<FunctionComponent>,
    locals: Vec<FunctionComponent>,
    body: FunctionBody,
) -> Arc<Function> {
    Arc::new(Function {
        name: Name::parse(name),
        inputs,
        outputs,
        locals,
        body,
        description: None,
        annotation: Vec::new(),
        impure: false,
        span: Span::NONE,
    })
}

impl Host for TestHost {
    fn callee(&mut self, name: &Name) -> Result<Option<Callee>, Diagnostic> {
        let name = name.to_string();
        let builtin = self.builtins.get(&name).cloned().map(Callee::Builtin);
        Ok(self.functions.get(&name).cloned().map(Callee::Function).or(builtin))
    }

    fn variable(&mut self, reference: &ComponentReference) -> Result<Option<Value>, Diagnostic> {
        let Some(first) = reference.parts.first() else { return Ok(None) };
        let Some(definition) = self.enumerations.get(first.name.as_str()) else { return Ok(None) };
        let literal = |ordinal: usize| EnumerationValue {
            definition: definition.clone(),
            ordinal: ordinal as i64 + 1,
        };
        Ok(match reference.parts.get(1) {
            Some(part) => definition
                .literals
                .iter()
                .position(|name| *name == part.name)
                .map(|at| Value::Enumeration(literal(at))),
            None => {
                let all = (0..definition.literals.len()).map(literal).collect();
                Some(Value::Array(ArrayValue::vector(Elements::Enumeration(all))))
            }
        })
    }

    fn function_names(&mut self) -> Vec<String> {
        self.functions.keys().cloned().collect()
    }

    fn warn(&mut self, warning: Diagnostic) {
        self.warnings.push(warning);
    }

    fn interrupted(&mut self) -> Option<Fault> {
        let patience = self.patience.as_mut()?;
        *patience = patience.saturating_sub(1);
        (*patience == 0).then(|| Fault::new(STOPPED, "stopped"))
    }

    fn script(&mut self) -> Option<&mut dyn ScriptHost> {
        Some(self)
    }
}

impl ScriptHost for TestHost {
    fn call_builtin(
        &mut self,
        header: &Arc<Function>,
        arguments: Vec<Value>,
        _: Span,
        _: &mut Scope,
    ) -> Result<Vec<Value>, Diagnostic> {
        self.builtin_calls.push(arguments);
        Ok(header.outputs.iter().map(|_| Value::Boolean(true)).collect())
    }

    fn assign(
        &mut self,
        target: &ComponentReference,
        value: Value,
        _span: Span,
    ) -> Result<bool, Diagnostic> {
        self.assigned.push((target.name().to_string(), value));
        Ok(target.parts.len() > 1)
    }

    fn loop_iteration(&mut self, iteration: usize, iterations: Option<usize>) {
        self.iterations.push((iteration, iterations));
    }
}
