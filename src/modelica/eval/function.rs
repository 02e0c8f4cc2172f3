//! A function ready to be called: inheritance resolved, names absolute. Data only.

use crate::functions::{Builtin, Reduction};
use crate::inference::{DeclaredSizes, ElementType, Elementary};
use crate::name::{Ident, Name};
use crate::source::Span;
use crate::syntax::ast;
use crate::syntax::visit::{Visit, walk_reference};
use crate::value::{EnumerationDefinition, EnumerationValue, Value};
use indexmap::IndexMap;
use std::sync::Arc;

/// A function with every reference resolved: in its expressions a single identifier that names
/// one of its components (or a loop variable) is local; every other name is absolute (no matter
/// whether written with a leading dot) and answered by the [`Host`](super::Host). References to
/// constants of packages are replaced by their values where these are known.
#[derive(Debug, Clone, PartialEq)]
pub struct Function {
    /// Its full name.
    pub name: Name,
    /// Inputs in order.
    pub inputs: Vec<FunctionComponent>,
    /// Outputs in order.
    pub outputs: Vec<FunctionComponent>,
    /// Protected variables in order.
    pub locals: Vec<FunctionComponent>,
    /// What it does.
    pub body: FunctionBody,
    /// The description string after its name.
    pub description: Option<Arc<str>>,
    /// Arguments of its class annotation (`derivative`, `inverse`, `Inline`, …).
    pub annotation: Vec<ast::Argument>,
    /// Whether it is declared `impure` or calls what is.
    pub impure: bool,
    /// Where it is defined.
    pub span: Span,
}

impl Function {
    /// Outputs and protected variables, each after those that its declaration names (MLS §12.4.4):
    /// the default of an output may contain a protected constant. Those that need each other keep
    /// their order.
    pub(crate) fn variables_in_order(&self) -> Vec<&FunctionComponent> {
        let mut waiting: Vec<_> = self.outputs.iter().chain(&self.locals).collect();
        let mut ordered = Vec::with_capacity(waiting.len());
        while !waiting.is_empty() {
            let names: Vec<Ident> = waiting.iter().map(|component| component.name).collect();
            let next = waiting.iter().position(|component| !component.needs_any_of(&names));
            ordered.push(waiting.remove(next.unwrap_or(0)));
        }
        ordered
    }

    /// The input, output or protected variable of this name.
    pub(crate) fn variable(&self, name: Ident) -> Option<&FunctionComponent> {
        let mut all = self.inputs.iter().chain(&self.outputs).chain(&self.locals);
        all.find(|component| component.name == name)
    }

    /// Whether a call may give any arguments, which are not looked at: a built-in
    /// marked `annotation(variadic = true)`.
    pub(super) fn is_variadic(&self) -> bool {
        self.annotation.iter().any(|argument| match argument {
            ast::Argument::Element(element) => {
                element.name.node.last().is_some_and(|name| name == "variadic")
            }
            ast::Argument::Redeclaration(_) => false,
        })
    }
}

impl DeclaredSizes for Function {
    fn input(&self, at: usize) -> Option<(Ident, usize)> {
        self.inputs.get(at).map(|input| (input.name, input.dims.len()))
    }

    fn output(&self) -> Option<&[ast::Subscript]> {
        self.outputs.first().map(|output| output.dims.as_slice())
    }
}

/// What a function does.
#[derive(Debug, Clone, PartialEq)]
pub enum FunctionBody {
    /// Statements of its algorithm section.
    Algorithm(Vec<ast::Statement>),
    /// `external` with language, function and call.
    External(ast::External),
    /// The partial derivatives of the outputs of another function by some of its inputs, one after
    /// the other (MLS §12.7.2).
    PartialDerivative {
        /// The function, by its full name.
        of: Name,
        /// The inputs; one may come several times.
        by: Vec<Ident>,
    },
    /// A record's constructor: the inputs are the fields of the single output (MLS §12.6).
    RecordConstructor,
}

/// An input, output or local variable of a function.
#[derive(Debug, Clone, PartialEq)]
pub struct FunctionComponent {
    /// Its name.
    pub name: Ident,
    /// Its element type.
    pub value_type: ValueType,
    /// Its dimensions; [`ast::Subscript::All`] where any size is accepted.
    pub dims: Vec<ast::Subscript>,
    /// Of a record: sizes of components that the declaration gives with names of its own class, as
    /// in `output R r(redeclare Real A[size(A, 1)])`.
    pub field_dims: Vec<(Ident, Vec<ast::Subscript>)>,
    /// Default of an input, initial value of an output or local.
    pub binding: Option<ast::Expression>,
    /// The description string after it.
    pub description: Option<Arc<str>>,
    /// Where it is declared.
    pub span: Span,
}

impl FunctionComponent {
    /// The sizes that it declares, with those of its own components.
    pub fn sizes(&self) -> impl Iterator<Item = &ast::Expression> {
        let of_fields = self.field_dims.iter().flat_map(|(_, dims)| dims);
        self.dims.iter().chain(of_fields).filter_map(|dim| match dim {
            ast::Subscript::Index(size) => Some(size),
            ast::Subscript::All(_) => None,
        })
    }

    /// The components of a record with the sizes that the declaration gives them, once they are
    /// numbers.
    ///
    /// # Errors
    /// Those of `known`.
    pub(crate) fn sized_fields<E>(
        &self,
        fields: &Arc<IndexMap<Ident, FunctionComponent>>,
        mut known: impl FnMut(&ast::Expression) -> Result<usize, E>,
    ) -> Result<Arc<IndexMap<Ident, FunctionComponent>>, E> {
        let mut fields = fields.clone();
        for (name, dims) in &self.field_dims {
            let mut numbers = Vec::with_capacity(dims.len());
            for dim in dims {
                numbers.push(match dim {
                    ast::Subscript::All(_) => dim.clone(),
                    ast::Subscript::Index(size) => {
                        let number = ast::ExpressionKind::Integer(known(size)? as i64);
                        ast::Subscript::Index(ast::Expression::new(number, size.span))
                    }
                });
            }
            if let Some(field) = Arc::make_mut(&mut fields).get_mut(name) {
                field.dims = numbers;
            }
        }
        Ok(fields)
    }

    /// Whether its size or its value names one of these, itself aside.
    fn needs_any_of(&self, names: &[Ident]) -> bool {
        let mut search = NameSearch { own: self.name, names, found: false };
        self.sizes().for_each(|size| search.expression(size));
        self.binding.iter().for_each(|binding| search.expression(binding));
        search.found
    }
}

/// Looks for names of variables.
struct NameSearch<'a> {
    own: Ident,
    names: &'a [Ident],
    found: bool,
}

impl Visit for NameSearch<'_> {
    fn reference(&mut self, reference: &ast::ComponentReference) {
        walk_reference(self, reference);
        let first = reference.parts.first().map(|part| part.name);
        self.found |= first.is_some_and(|name| name != self.own && self.names.contains(&name));
    }
}

/// The type of a component of a function.
#[derive(Debug, Clone, PartialEq)]
pub enum ValueType {
    /// `Real` and types derived from it.
    Real,
    /// `Integer`
    Integer,
    /// `Boolean`
    Boolean,
    /// `String`
    String,
    /// An enumeration.
    Enumeration(Arc<EnumerationDefinition>),
    /// A record: its full name and its components, each with its dimensions.
    Record(Name, Arc<IndexMap<Ident, FunctionComponent>>),
    /// A class derived from `ExternalObject` (MLS §12.9.7).
    ExternalObject(Name),
    /// A function given as an argument.
    Function,
    /// The name of a class, not evaluated (built-ins only).
    TypeName,
    /// The name of a variable, not evaluated (built-ins only).
    VariableName,
    /// An expression, not evaluated: its text (built-ins only).
    Expression,
    /// Any value (built-ins only).
    Any,
}

impl ValueType {
    /// The type of a component of a record.
    pub(crate) fn component(&self, name: Ident) -> Option<ValueType> {
        match self {
            ValueType::Record(_, components) => Some(components.get(&name)?.value_type.clone()),
            _ => None,
        }
    }

    /// What a reduction makes of no elements of this type (MLS §10.3.4.1): `min` the greatest value of
    /// the type, `max` the least.
    pub(crate) fn of_no_elements(&self, reduction: Reduction) -> Value {
        if let Some(number) = reduction.of_none() {
            return Value::Integer(number);
        }
        let is_min = reduction == Reduction::Min;
        match self {
            ValueType::Integer => Value::Integer(if is_min { i64::MAX } else { i64::MIN }),
            ValueType::Boolean => Value::Boolean(is_min),
            ValueType::Enumeration(definition) => Value::Enumeration(EnumerationValue {
                ordinal: if is_min { definition.literals.len() as i64 } else { 1 },
                definition: definition.clone(),
            }),
            _ => Value::Real(if is_min { f64::MAX } else { f64::MIN }),
        }
    }
}

impl ElementType for ValueType {
    fn elementary(which: Elementary) -> Option<ValueType> {
        match which {
            Elementary::Real => Some(ValueType::Real),
            Elementary::Integer => Some(ValueType::Integer),
            Elementary::Boolean => Some(ValueType::Boolean),
            Elementary::String => Some(ValueType::String),
            Elementary::Clock => None,
        }
    }
}

/// What a called name stands for.
#[derive(Clone)]
pub(super) enum Target {
    Function(Arc<Function>),
    Builtin(Arc<Function>),
    /// A function or an operator of the language.
    Language(&'static Builtin),
    Unknown,
}
