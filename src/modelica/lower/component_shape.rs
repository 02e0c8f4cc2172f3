//! Shapes and first values of outputs and local variables of functions (MLS §12.4.4, §12.4.5).
//!
//! A size `:` is that of the value in the declaration, or of what is assigned to the variable. A
//! size or a default of a component of a record may use numbers of the same record.

use super::errors::{ARRAY_MISMATCH, NOT_SUPPORTED};
use super::expressions::{Lowered, Lowering, Target};
use super::loops::LoopVariable;
use super::shape::Shape;
use super::shape::UNKNOWN_TEXT;
use super::string_array::StringArray;
use crate::diag::Diagnostic;
use crate::eval::{FunctionBody, FunctionComponent, ValueType};
use crate::fault;
use crate::name::Ident;
use crate::syntax::ast::{Arguments, ComponentReference, Expression, ExpressionKind, Subscript};
use crate::syntax::visit::{Visit, walk_reference};
use indexmap::IndexMap;

/// The shape of what is assigned to a variable or component of this path, if that is known.
pub(super) type Assigned<'a, T> =
    &'a mut dyn FnMut(&mut T, &[Ident]) -> Result<Option<Shape>, Diagnostic>;

/// A variable of a function before its first statement.
pub(super) struct Declared<S> {
    pub(super) shape: Shape,
    /// Its scalars, `None` where they have no value.
    pub(super) scalars: Vec<Option<S>>,
}

/// An output or local variable.
pub(super) fn declared<T: Target>(
    lowering: &mut Lowering<'_, T>,
    component: &FunctionComponent,
    assigned: Assigned<'_, T>,
) -> Result<Declared<T::Scalar>, Diagnostic> {
    let value = match &component.binding {
        Some(binding) => Some(value_of(lowering, binding)?),
        None => None,
    };
    let mut declaration = Declaration { lowering, assigned, path: Vec::new() };
    declaration.component(component, value, &[])
}

/// The value in a declaration; of a record that modifiers give in part, the components given.
fn value_of<T: Target>(
    lowering: &mut Lowering<'_, T>,
    binding: &Expression,
) -> Result<Lowered<T::Scalar>, Diagnostic> {
    if let ExpressionKind::Call { function, arguments } = &binding.kind
        && arguments.positional.is_empty()
        && let Some(user) = lowering.target.function(&function.name())
        && matches!(user.body, FunctionBody::RecordConstructor)
        && user.inputs.iter().any(|input| input.binding.is_none() && !gives(arguments, input.name))
    {
        let mut fields = Vec::with_capacity(arguments.named.len());
        for argument in &arguments.named {
            fields.push((argument.name.node, lowering.lower(&argument.value)?));
        }
        return Ok(Lowered::Record(fields));
    }
    lowering.lower(binding)
}

fn gives(arguments: &Arguments, name: Ident) -> bool {
    arguments.named.iter().any(|argument| argument.name.node == name)
}

/// A declaration being evaluated.
struct Declaration<'a, 'l, T: Target> {
    lowering: &'a mut Lowering<'l, T>,
    assigned: Assigned<'a, T>,
    /// Names of the variable and of its components that led here.
    path: Vec<Ident>,
}

impl<T: Target> Declaration<'_, '_, T> {
    /// A variable, or a component of one; the sizes of the arrays of records around it precede its
    /// own.
    fn component(
        &mut self,
        component: &FunctionComponent,
        value: Option<Lowered<T::Scalar>>,
        around: &[usize],
    ) -> Result<Declared<T::Scalar>, Diagnostic> {
        self.path.push(component.name);
        let dims = self.sizes(component, value.as_ref(), around)?;
        let declared = match &component.value_type {
            ValueType::Record(_, fields) => {
                let fields =
                    component.sized_fields(fields, |size| self.lowering.known_size(size))?;
                self.record(&fields, value, &dims)
            }
            ValueType::String if self.lowering.composes && dims.is_empty() => {
                self.number_of_text(value, component)
            }
            ValueType::String => Ok(text(value, dims)),
            ValueType::Function => Err(fault!(
                NOT_SUPPORTED,
                "`{}` has a type that is not supported in functions used in equations",
                component.name
            )
            .at(component.span)),
            _ => elements(component, value, dims),
        };
        self.path.pop();
        declared
    }

    /// A text that is known at run time.
    fn number_of_text(
        &mut self,
        value: Option<Lowered<T::Scalar>>,
        component: &FunctionComponent,
    ) -> Result<Declared<T::Scalar>, Diagnostic> {
        let number = |text| self.lowering.number_of_text(text, component.span);
        let scalars = vec![value.map(number).transpose()?];
        Ok(Declared { shape: Shape::Numbered, scalars })
    }

    /// All sizes of a component.
    fn sizes(
        &mut self,
        component: &FunctionComponent,
        value: Option<&Lowered<T::Scalar>>,
        around: &[usize],
    ) -> Result<Vec<usize>, Diagnostic> {
        let given = value.and_then(Lowered::shape).as_ref().map(leading_sizes);
        let mut dims = around.to_vec();
        for subscript in &component.dims {
            let given = given.as_ref().and_then(|given| given.get(dims.len()).copied());
            dims.push(match (subscript, given) {
                (Subscript::Index(size), given) => match self.lowering.known_size(size) {
                    Ok(size) => size,
                    Err(error) => given.ok_or(error)?,
                },
                (Subscript::All(_), Some(given)) => given,
                (Subscript::All(_), None) => {
                    let shape = (self.assigned)(self.lowering.target, &self.path)?;
                    let sizes = shape.as_ref().map(leading_sizes);
                    sizes.and_then(|sizes| sizes.get(dims.len()).copied()).ok_or_else(|| {
                        fault!(NOT_SUPPORTED, "the size of `{}` is not declared", component.name)
                            .at(component.span)
                    })?
                }
            });
        }
        Ok(dims)
    }

    /// The components of a record, in which the numbers among them are known by their names.
    fn record(
        &mut self,
        fields: &IndexMap<Ident, FunctionComponent>,
        value: Option<Lowered<T::Scalar>>,
        dims: &[usize],
    ) -> Result<Declared<T::Scalar>, Diagnostic> {
        let mut given = match value {
            Some(Lowered::Record(given)) => given,
            _ => Vec::new(),
        };
        let outside = self.lowering.loops.len();
        let (mut shapes, mut scalars) = (Vec::with_capacity(fields.len()), Vec::new());
        for (name, field) in fields {
            let at = given.iter().position(|(given, _)| given == name);
            let own = at.map(|at| given.swap_remove(at).1);
            let own = own.or_else(|| self.default(field, fields, outside, dims));
            if let (Some(Lowered::Array(array)), true) = (&own, dims.is_empty())
                && let ([number], true) = (array.elements.as_slice(), is_number(field))
            {
                let (name, value, value_type) = (*name, *number, field.value_type.clone());
                self.lowering.loops.push(LoopVariable { name, value, value_type });
            }
            let unknown = self.unknown_name(field, fields, outside);
            let declared = match unknown {
                Some(unknown) if own.is_none() => Err(fault!(
                    NOT_SUPPORTED,
                    "the size of `{name}` depends on `{unknown}`, which has no value at translation"
                )
                .at(field.span)),
                _ => self.component(field, own, dims),
            };
            let declared = match declared {
                Ok(declared) => declared,
                Err(error) => {
                    self.lowering.loops.truncate(outside);
                    return Err(error);
                }
            };
            shapes.push((*name, declared.shape));
            scalars.extend(declared.scalars);
        }
        self.lowering.loops.truncate(outside);
        Ok(Declared { shape: Shape::Record(shapes), scalars })
    }

    /// The default of a component of a single record, if it is known from what is declared so far.
    fn default(
        &mut self,
        field: &FunctionComponent,
        fields: &IndexMap<Ident, FunctionComponent>,
        outside: usize,
        dims: &[usize],
    ) -> Option<Lowered<T::Scalar>> {
        let binding = field.binding.as_ref().filter(|_| dims.is_empty())?;
        let mut names = OwnNames { fields, found: Vec::new() };
        names.expression(binding);
        let is_known = names.found.iter().all(|name| self.is_known(*name, outside));
        is_known.then(|| self.lowering.lower(binding).ok()).flatten()
    }

    /// A component of the same record that the sizes of another one need and that is not known.
    fn unknown_name(
        &self,
        field: &FunctionComponent,
        fields: &IndexMap<Ident, FunctionComponent>,
        outside: usize,
    ) -> Option<Ident> {
        let mut names = OwnNames { fields, found: Vec::new() };
        for subscript in &field.dims {
            if let Subscript::Index(size) = subscript {
                names.expression(size);
            }
        }
        names.found.into_iter().find(|name| !self.is_known(*name, outside))
    }

    fn is_known(&self, name: Ident, outside: usize) -> bool {
        self.lowering.loops[outside..].iter().any(|known| known.name == name)
    }
}

/// Collects the components of a record that expressions of the record name.
struct OwnNames<'a> {
    fields: &'a IndexMap<Ident, FunctionComponent>,
    found: Vec<Ident>,
}

impl Visit for OwnNames<'_> {
    fn reference(&mut self, reference: &ComponentReference) {
        walk_reference(self, reference);
        let first = reference.parts.first().map(|part| part.name);
        self.found.extend(first.filter(|name| self.fields.contains_key(name)));
    }
}

fn is_number(component: &FunctionComponent) -> bool {
    let is_number = matches!(
        component.value_type,
        ValueType::Real | ValueType::Integer | ValueType::Boolean | ValueType::Enumeration(_)
    );
    is_number && component.dims.is_empty()
}

/// Numbers of known sizes.
fn elements<S: Copy>(
    component: &FunctionComponent,
    value: Option<Lowered<S>>,
    dims: Vec<usize>,
) -> Result<Declared<S>, Diagnostic> {
    let shape = Shape::Array(dims);
    let scalars = match value {
        None => vec![None; shape.len()],
        Some(Lowered::Array(array)) if Shape::Array(array.dims.clone()) == shape => {
            array.elements.into_iter().map(Some).collect()
        }
        Some(_) => {
            let span = component.binding.as_ref().map_or(component.span, |binding| binding.span);
            return Err(fault!(
                ARRAY_MISMATCH,
                "the value of `{}` has a different size",
                component.name
            )
            .at(span));
        }
    };
    Ok(Declared { shape, scalars })
}

fn text<S: Copy>(value: Option<Lowered<S>>, dims: Vec<usize>) -> Declared<S> {
    let shape = match value {
        Some(Lowered::Text(text)) if dims.is_empty() => Shape::Text(text),
        Some(Lowered::Strings(strings)) if strings.dims == dims => Shape::Strings(strings),
        _ if dims.is_empty() => Shape::Text(UNKNOWN_TEXT.into()),
        _ => Shape::Strings(StringArray::unknown(dims)),
    };
    Declared { shape, scalars: Vec::new() }
}

/// The sizes of an array; those of an array of records and then some of a component.
fn leading_sizes(shape: &Shape) -> Vec<usize> {
    let mut shape = shape;
    loop {
        match shape {
            Shape::Array(dims) => return dims.clone(),
            Shape::Text(_) | Shape::Numbered => return Vec::new(),
            Shape::Strings(strings) => return strings.dims.clone(),
            Shape::Record(fields) => match fields.first() {
                Some((_, first)) => shape = first,
                None => return Vec::new(),
            },
        }
    }
}
