//! Arrays of records, as records of arrays: the sizes of the array precede those of each component,
//! so that `v.x` of an array of records `v` is the component `x` itself (MLS §10.6.1).

use super::{Array, Lowered, Lowering, MAX_SCALARS, Target, size_fault};
use crate::diag::Diagnostic;
use crate::fault;
use crate::lower::errors::{ARRAY_MISMATCH, UNRESOLVED_REFERENCE};
use crate::lower::string_array::StringArray;
use crate::source::Span;
use crate::syntax::ast::{ComponentReference, Subscript};

impl<T: Target> Lowering<'_, T> {
    /// What subscripts choose of an array, or of an array of records.
    pub(crate) fn elements_of(
        &mut self,
        value: Lowered<T::Scalar>,
        subscripts: &[Subscript],
        span: Span,
    ) -> Result<Lowered<T::Scalar>, Diagnostic> {
        if subscripts.is_empty() {
            return Ok(value);
        }
        match value {
            Lowered::Array(array) => self.subscripted(array, subscripts, span).map(Lowered::Array),
            // All elements have the same text, or it is not known.
            Lowered::Text(text) => Ok(Lowered::Text(text)),
            Lowered::Strings(strings) => self.string_elements(strings, subscripts, span),
            Lowered::Record(fields) => {
                let mut chosen = Vec::with_capacity(fields.len());
                for (name, value) in fields {
                    chosen.push((name, self.elements_of(value, subscripts, span)?));
                }
                Ok(Lowered::Record(chosen))
            }
            Lowered::Numbered(_) => Err(fault!(ARRAY_MISMATCH, "subscripts of a String").at(span)),
        }
    }

    /// A variable of a function being compiled, or a part of it; `None` elsewhere.
    pub(super) fn part_of_own(
        &mut self,
        reference: &ComponentReference,
    ) -> Result<Option<Lowered<T::Scalar>>, Diagnostic> {
        let Some((first, rest)) = reference.parts.split_first() else { return Ok(None) };
        let Some(mut own) = self.target.own_variable(first.name) else { return Ok(None) };
        for part in rest {
            own = field_of(own, part.name, reference.span)?;
        }
        let own = own.clone();
        let subscripts = self.target.own_subscripts(reference)?;
        self.elements_of(own, &subscripts, reference.span).map(Some)
    }
}

/// Values of one shape as the elements of an array with one more dimension.
pub(crate) fn stacked<S: Copy>(
    values: Vec<Lowered<S>>,
    span: Span,
) -> Result<Lowered<S>, Diagnostic> {
    if let Some(strings) = string_arrays(&values) {
        return match StringArray::stacked(&strings) {
            Some(strings) => Ok(Lowered::Strings(strings)),
            None => Err(fault!(ARRAY_MISMATCH, "the elements have different sizes").at(span)),
        };
    }
    let Some(Lowered::Record(first)) = values.first() else {
        return stack(arrays(values, span)?, span).map(Lowered::Array);
    };
    let names: Vec<_> = first.iter().map(|(name, _)| *name).collect();
    let mut fields = Vec::with_capacity(names.len());
    for name in names {
        let of_one = |value: &Lowered<S>| field(value.clone(), name, span);
        let column = values.iter().map(of_one).collect::<Result<Vec<_>, _>>()?;
        fields.push((name, stacked(column, span)?));
    }
    Ok(Lowered::Record(fields))
}

/// Values that are all Strings or arrays of Strings, one at least; `None` for numbers.
pub(super) fn string_arrays<S: Copy>(values: &[Lowered<S>]) -> Option<Vec<StringArray>> {
    let strings = |value: &Lowered<S>| match value {
        Lowered::Text(text) => Some(StringArray::filled(Vec::new(), text.clone())),
        Lowered::Strings(strings) => Some(strings.clone()),
        _ => None,
    };
    let all: Vec<StringArray> = values.iter().map(strings).collect::<Option<_>>()?;
    (!all.is_empty()).then_some(all)
}

/// An array of Strings as a value: one without dimensions is a String.
pub(super) fn string_value<S>(strings: StringArray) -> Lowered<S> {
    match strings.strings.first() {
        Some(text) if strings.dims.is_empty() => Lowered::Text(text.clone()),
        _ => Lowered::Strings(strings),
    }
}

/// Values that are arrays of numbers.
pub(super) fn arrays<S: Copy>(
    values: Vec<Lowered<S>>,
    span: Span,
) -> Result<Vec<Array<S>>, Diagnostic> {
    let array = |value| match value {
        Lowered::Array(array) => Ok(array),
        Lowered::Record(_) => {
            Err(fault!(ARRAY_MISMATCH, "expected a number, got a record").at(span))
        }
        Lowered::Text(_) | Lowered::Strings(_) | Lowered::Numbered(_) => {
            Err(fault!(ARRAY_MISMATCH, "expected a number, got a String").at(span))
        }
    };
    values.into_iter().map(array).collect()
}

/// A component of a record.
pub(crate) fn field<S: Copy>(
    base: Lowered<S>,
    name: crate::name::Ident,
    span: Span,
) -> Result<Lowered<S>, Diagnostic> {
    field_of(&base, name, span).cloned()
}

/// As [`field`], without copying.
pub(crate) fn field_of<S: Copy>(
    base: &Lowered<S>,
    name: crate::name::Ident,
    span: Span,
) -> Result<&Lowered<S>, Diagnostic> {
    if let Lowered::Record(fields) = base
        && let Some((_, value)) = fields.iter().find(|(field, _)| *field == name)
    {
        return Ok(value);
    }
    let unknown = match base {
        Lowered::Record(fields) => {
            let own: Vec<String> = fields.iter().map(|(own, _)| format!("`{own}`")).collect();
            fault!(
                UNRESOLVED_REFERENCE,
                "this record has no component `{name}`; it has {}",
                own.join(", ")
            )
        }
        _ => fault!(UNRESOLVED_REFERENCE, "this is not a record with a component `{name}`"),
    };
    Err(unknown.at(span))
}

/// Arrays of one size as the elements of an array with one more dimension.
fn stack<S: Copy>(arrays: Vec<Array<S>>, span: Span) -> Result<Array<S>, Diagnostic> {
    let mut dims = vec![arrays.len()];
    let Some(first) = arrays.first() else {
        return Ok(Array { dims, elements: Vec::new() });
    };
    dims.extend(&first.dims);
    let mut elements = Vec::new();
    for array in &arrays {
        if array.dims != first.dims {
            return super::at(Err(size_fault(&first.dims, &array.dims)), span);
        }
        elements.extend(&array.elements);
    }
    if elements.len() > MAX_SCALARS {
        return Err(fault!(ARRAY_MISMATCH, "an array of more than {MAX_SCALARS} elements").at(span));
    }
    Ok(Array { dims, elements })
}
