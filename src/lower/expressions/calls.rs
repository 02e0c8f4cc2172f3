//! Calls: operators with a meaning in time, functions of arrays (MLS §10.3), functions of the
//! table (MLS §3.7), user functions.

use super::{Array, Binary, Lowered, Lowering, Operator, Target, placed};
use crate::diag::{Diagnostic, suggest};
use crate::eval::FunctionBody;
use crate::fault;
use crate::lower::errors::{
    ARRAY_MISMATCH, NO_CONSTANT_VALUE, NOT_SUPPORTED, UNRESOLVED_REFERENCE,
};
use crate::source::Span;
use crate::symbolic::function;
use crate::syntax::ast::{Arguments, ComponentReference, Expression};

impl<T: Target> Lowering<'_, T> {
    pub(super) fn call(
        &mut self,
        callee: &ComponentReference,
        arguments: &Arguments,
        span: Span,
    ) -> Result<Lowered<T::Scalar>, Diagnostic> {
        let name = callee.name();
        if let Some(user) = self.target.function(&name) {
            if let Some((builtin, placed)) = placed::of_builtin(&user, arguments) {
                return self.table_function(builtin, &placed, span);
            }
            let mut outputs = self.user_call(&user, arguments, span)?;
            if outputs.is_empty() {
                return Err(fault!(ARRAY_MISMATCH, "`{name}` has no output").at(span));
            }
            return Ok(outputs.swap_remove(0));
        }
        let text = name.to_string();
        let short = text.strip_prefix('.').unwrap_or(&text);
        if short == "String" {
            return Ok(Lowered::Text(self.string_operator(callee, arguments, span)));
        }
        if short == "homotopy" {
            return self.homotopy(arguments, span);
        }
        let plain = &placed::of_operator(short, arguments);
        if let Some(operator) = self.target.operator(short, plain, span) {
            return self.time_operator(short, operator?, plain, span);
        }
        if let Some(rearranged) = self.rearrangement(short, &arguments.positional, span)? {
            return Ok(rearranged);
        }
        if let Some(array) = self.array_function(short, arguments, span)? {
            return Ok(Lowered::Array(array));
        }
        self.table_function(short, plain, span)
    }

    /// A user function with its arguments in order, all outputs.
    pub(crate) fn user_call(
        &mut self,
        user: &std::sync::Arc<crate::eval::Function>,
        arguments: &Arguments,
        span: Span,
    ) -> Result<Vec<Lowered<T::Scalar>>, Diagnostic> {
        let name = &user.name;
        if !arguments.iterators.is_empty() || arguments.positional.len() > user.inputs.len() {
            return Err(
                fault!(ARRAY_MISMATCH, "`{name}` takes {} arguments", user.inputs.len()).at(span)
            );
        }
        if let Some(unknown) =
            arguments.named.iter().find(|a| user.inputs.iter().all(|i| i.name != a.name.node))
        {
            return Err(fault!(
                UNRESOLVED_REFERENCE,
                "`{name}` has no input `{}`",
                unknown.name.node
            )
            .help_if(suggest::did_you_mean(
                unknown.name.node.as_str(),
                user.inputs.iter().map(|i| i.name.as_str()),
            ))
            .at(unknown.name.span));
        }
        let mut values = Vec::with_capacity(user.inputs.len());
        for (position, input) in user.inputs.iter().enumerate() {
            let named = arguments.named.iter().find(|a| a.name.node == input.name);
            let given = arguments.positional.get(position).or(named.map(|a| &a.value));
            let value = match (given, &input.binding) {
                (Some(given), _) => self.lower(given)?,
                (None, Some(default)) => self.lower(default)?,
                (None, None) => {
                    return Err(fault!(
                        UNRESOLVED_REFERENCE,
                        "the input `{}` of `{name}` has no value",
                        input.name
                    )
                    .at(span));
                }
            };
            values.push(value);
        }
        if matches!(user.body, FunctionBody::RecordConstructor) {
            let fields = user.inputs.iter().map(|i| i.name).zip(values).collect();
            return Ok(vec![Lowered::Record(fields)]);
        }
        if let FunctionBody::External(clause) = &user.body
            && let [output] = user.outputs.as_slice()
            && output.dims.is_empty()
            && let Some(id) = clause.function.as_ref().and_then(|n| function::find(n.node.as_str()))
            && id.get().arity() == values.len()
        {
            // A library declares a function of the language again.
            let mut scalars = Vec::with_capacity(values.len());
            for value in &values {
                value.append_scalars(&mut scalars);
            }
            if scalars.len() == values.len() {
                let value = self.target.apply(id, &scalars, self.live, span)?;
                return Ok(vec![Lowered::scalar(value)]);
            }
        }
        if let Some(outputs) = self.vectorized_call(user, &values, span)? {
            return Ok(outputs);
        }
        if let Some(outputs) = self.text_call(user, &values, span)? {
            return Ok(outputs);
        }
        match self.target.call(user, values.clone(), span) {
            Err(error)
                if [NOT_SUPPORTED, NO_CONSTANT_VALUE].contains(&error.code)
                    && !self.target.gives_up() =>
            {
                self.settled_call(user, &values, span).ok_or(error)
            }
            outputs => outputs,
        }
    }

    fn time_operator(
        &mut self,
        name: &str,
        operator: Operator,
        arguments: &[Expression],
        span: Span,
    ) -> Result<Lowered<T::Scalar>, Diagnostic> {
        let argument = |position: usize| {
            arguments
                .get(position)
                .ok_or_else(|| fault!(ARRAY_MISMATCH, "`{name}` needs a further argument").at(span))
        };
        match operator {
            Operator::Temporal => {
                if let ("pre" | "change", [text]) = (name, arguments)
                    && let Lowered::Numbered(text) = self.lower(text)?
                {
                    let value = vec![Array::scalar(text)];
                    let value = self.target.temporal(name, value, self.live, span)?.elements[0];
                    return Ok(match name {
                        "pre" => Lowered::Numbered(value),
                        _ => Lowered::scalar(value),
                    });
                }
                let values = arguments.iter().map(|a| self.array(a)).collect::<Result<_, _>>()?;
                Ok(Lowered::Array(self.target.temporal(name, values, self.live, span)?))
            }
            Operator::Plain(position) => self.lower(argument(position)?),
            Operator::Live(position) => {
                let before = std::mem::replace(&mut self.live, true);
                let value = self.lower(argument(position)?);
                self.live = before;
                value
            }
            Operator::Derivative => {
                let mut array = self.array(argument(0)?)?;
                for element in &mut array.elements {
                    *element = self.target.derivative(*element, span)?;
                }
                Ok(Lowered::Array(array))
            }
        }
    }

    fn array_function(
        &mut self,
        name: &str,
        arguments: &Arguments,
        span: Span,
    ) -> Result<Option<Array<T::Scalar>>, Diagnostic> {
        let plain = arguments.positional.as_slice();
        let one = |lowering: &mut Self| match plain {
            [a] => lowering.array(a),
            _ => Err(fault!(ARRAY_MISMATCH, "`{name}` takes one argument").at(span)),
        };
        let array = match name {
            "sum" | "product" | "min" | "max"
                if !arguments.iterators.is_empty() || plain.len() == 1 =>
            {
                Array::scalar(self.reduction(name, arguments, span)?)
            }
            "size" => return self.size(plain, span).map(Some),
            "ndims" => {
                let rank = one(self)?.dims.len();
                Array::scalar(self.target.constant(rank as f64))
            }
            "zeros" => self.filled(0.0, plain, span)?,
            "ones" => self.filled(1.0, plain, span)?,
            "identity" => match plain {
                [n] => {
                    let n = self.known_size(n)?;
                    let diagonal = vec![self.target.constant(1.0); n];
                    self.diagonal(&diagonal)
                }
                _ => return Err(fault!(ARRAY_MISMATCH, "`identity` takes one argument").at(span)),
            },
            "diagonal" => {
                let diagonal = one(self)?;
                self.diagonal(&diagonal.elements)
            }
            "linspace" => self.linspace(plain, span)?,
            "scalar" => {
                let a = one(self)?;
                match a.elements.as_slice() {
                    [only] => Array::scalar(*only),
                    _ => {
                        return Err(fault!(
                            ARRAY_MISMATCH,
                            "`scalar` of an array with {} elements",
                            a.elements.len()
                        )
                        .at(span));
                    }
                }
            }
            "vector" => Array::vector(one(self)?.elements),
            "matrix" => {
                let mut a = one(self)?;
                if a.dims.len() > 2 && a.dims[2..].iter().any(|n| *n != 1) {
                    return Err(
                        fault!(ARRAY_MISMATCH, "`matrix` of more than two dimensions").at(span)
                    );
                }
                a.dims.truncate(2);
                a.dims.resize(2, 1);
                a
            }
            "cross" => match plain {
                [a, b] => {
                    let (a, b) = (self.array(a)?, self.array(b)?);
                    self.cross(&a, &b, span)?
                }
                _ => return Err(fault!(ARRAY_MISMATCH, "`cross` takes two vectors").at(span)),
            },
            "outerProduct" => match plain {
                [a, b] => {
                    let (a, b) = (self.array(a)?, self.array(b)?);
                    self.outer_product(&a, &b, span)?
                }
                _ => {
                    return Err(fault!(ARRAY_MISMATCH, "`outerProduct` takes two vectors").at(span));
                }
            },
            "skew" => {
                let a = one(self)?;
                self.skew(&a, span)?
            }
            "symmetric" => symmetric(one(self)?, span)?,
            "Real" | "Integer" | "Boolean" if plain.len() == 1 => one(self)?,
            _ => return Ok(None),
        };
        Ok(Some(array))
    }

    fn reduction(
        &mut self,
        name: &str,
        arguments: &Arguments,
        span: Span,
    ) -> Result<T::Scalar, Diagnostic> {
        let [element] = arguments.positional.as_slice() else {
            return Err(fault!(ARRAY_MISMATCH, "`{name}` takes one array").at(span));
        };
        let elements = match arguments.iterators.is_empty() {
            true => self.array(element)?.elements,
            false => self.reduction_elements(element, &arguments.iterators)?,
        };
        match name {
            "sum" => return Ok(self.fold(Binary::Add, 0.0, &elements)),
            "product" => return Ok(self.fold(Binary::Mul, 1.0, &elements)),
            _ => {}
        }
        let (Some((first, rest)), Some(id)) = (elements.split_first(), function::find(name)) else {
            return Err(fault!(ARRAY_MISMATCH, "`{name}` of an empty array").at(span));
        };
        let mut result = *first;
        for element in rest {
            result = self.target.apply(id, &[result, *element], self.live, span)?;
        }
        Ok(result)
    }

    fn size(
        &mut self,
        arguments: &[Expression],
        span: Span,
    ) -> Result<Array<T::Scalar>, Diagnostic> {
        match arguments {
            [a] => {
                let dims = self.array(a)?.dims;
                let sizes = dims.iter().map(|n| self.target.constant(*n as f64)).collect();
                Ok(Array::vector(sizes))
            }
            [a, dimension] => {
                let dims = self.leading_sizes(a)?;
                let dimension = self.known_size(dimension)?;
                match dims.get(dimension.wrapping_sub(1)) {
                    Some(size) => Ok(Array::scalar(self.target.constant(*size as f64))),
                    None => {
                        Err(fault!(ARRAY_MISMATCH, "there is no dimension {dimension}").at(span))
                    }
                }
            }
            _ => Err(fault!(ARRAY_MISMATCH, "`size` takes an array and a dimension").at(span)),
        }
    }

    /// The sizes of an array; those of an array of records and then some of a component.
    fn leading_sizes(&mut self, e: &Expression) -> Result<Vec<usize>, Diagnostic> {
        let mut value = &self.lower(e)?;
        while let Lowered::Record(fields) = value {
            let Some((_, first)) = fields.first() else { break };
            value = first;
        }
        match value {
            Lowered::Array(array) => Ok(array.dims.clone()),
            _ => self.array(e).map(|array| array.dims),
        }
    }

    fn filled(
        &mut self,
        value: f64,
        sizes: &[Expression],
        span: Span,
    ) -> Result<Array<T::Scalar>, Diagnostic> {
        let value = Array::scalar(self.target.constant(value));
        self.repeated(&value, sizes, span)
    }

    fn diagonal(&mut self, diagonal: &[T::Scalar]) -> Array<T::Scalar> {
        let n = diagonal.len();
        let mut elements = vec![self.target.constant(0.0); n * n];
        for (position, value) in diagonal.iter().enumerate() {
            elements[position * n + position] = *value;
        }
        Array { dims: vec![n, n], elements }
    }

    fn linspace(
        &mut self,
        arguments: &[Expression],
        span: Span,
    ) -> Result<Array<T::Scalar>, Diagnostic> {
        let [first, last, n] = arguments else {
            return Err(fault!(ARRAY_MISMATCH, "`linspace` takes three arguments").at(span));
        };
        let (first, last, n) = (self.scalar(first)?, self.scalar(last)?, self.known_size(n)?);
        if n < 2 {
            return Err(fault!(ARRAY_MISMATCH, "`linspace` needs at least two points").at(span));
        }
        let width = self.target.binary(Binary::Sub, last, first);
        let elements = (0..n)
            .map(|i| {
                let share = self.target.constant(i as f64 / (n - 1) as f64);
                let part = self.target.binary(Binary::Mul, width, share);
                self.target.binary(Binary::Add, first, part)
            })
            .collect();
        Ok(Array::vector(elements))
    }

    fn cross(
        &mut self,
        a: &Array<T::Scalar>,
        b: &Array<T::Scalar>,
        span: Span,
    ) -> Result<Array<T::Scalar>, Diagnostic> {
        if a.dims != [3] || b.dims != [3] {
            return Err(
                fault!(ARRAY_MISMATCH, "`cross` takes two vectors of three elements").at(span)
            );
        }
        let elements = (0..3)
            .map(|i| {
                let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                let plus = self.target.binary(Binary::Mul, a.elements[j], b.elements[k]);
                let minus = self.target.binary(Binary::Mul, a.elements[k], b.elements[j]);
                self.target.binary(Binary::Sub, plus, minus)
            })
            .collect();
        Ok(Array::vector(elements))
    }

    /// The matrix of all products of two vectors (MLS §10.3.5).
    fn outer_product(
        &mut self,
        a: &Array<T::Scalar>,
        b: &Array<T::Scalar>,
        span: Span,
    ) -> Result<Array<T::Scalar>, Diagnostic> {
        let (&[rows], &[columns]) = (a.dims.as_slice(), b.dims.as_slice()) else {
            return Err(fault!(ARRAY_MISMATCH, "`outerProduct` takes two vectors").at(span));
        };
        let product = |this: &mut Self, at: usize| {
            let (i, j) = (at / columns.max(1), at % columns.max(1));
            this.target.binary(Binary::Mul, a.elements[i], b.elements[j])
        };
        let elements = (0..rows * columns).map(|at| product(self, at)).collect();
        Ok(Array { dims: vec![rows, columns], elements })
    }

    /// The matrix whose product with `y` is `cross(a, y)` (MLS §10.3.5).
    fn skew(&mut self, a: &Array<T::Scalar>, span: Span) -> Result<Array<T::Scalar>, Diagnostic> {
        let &[x, y, z] = a.elements.as_slice() else {
            return Err(fault!(ARRAY_MISMATCH, "`skew` takes a vector of three elements").at(span));
        };
        let zero = self.target.constant(0.0);
        let mut minus = |e| self.target.binary(Binary::Sub, zero, e);
        let (nx, ny, nz) = (minus(x), minus(y), minus(z));
        Ok(Array { dims: vec![3, 3], elements: vec![zero, nz, y, z, zero, nx, ny, x, zero] })
    }

    /// A function of the table, element by element (MLS §12.4.6).
    fn table_function(
        &mut self,
        name: &str,
        arguments: &[Expression],
        span: Span,
    ) -> Result<Lowered<T::Scalar>, Diagnostic> {
        let bare = name.strip_prefix("Modelica.Math.").unwrap_or(name);
        let Some(id) = function::find(bare) else {
            let known = function::functions().map(|(_, f)| f.name);
            return Err(fault!(UNRESOLVED_REFERENCE, "there is no function `{name}`")
                .help_if(suggest::did_you_mean(name, known))
                .at(span));
        };
        if arguments.len() != id.get().arity() {
            return Err(fault!(
                ARRAY_MISMATCH,
                "`{name}` takes {} arguments, not {}",
                id.get().arity(),
                arguments.len()
            )
            .at(span));
        }
        let values = arguments.iter().map(|a| self.array(a)).collect::<Result<Vec<_>, _>>()?;
        let dims = values.iter().map(|v| &v.dims).max_by_key(|d| d.len()).cloned();
        let dims = dims.unwrap_or_default();
        if let Some(other) = values.iter().find(|v| !v.dims.is_empty() && v.dims != dims) {
            return Err(super::size_fault(&dims, &other.dims).at(span));
        }
        let mut elements = Vec::new();
        for position in 0..dims.iter().product() {
            let scalars: Vec<T::Scalar> = values
                .iter()
                .map(|v| v.elements[if v.dims.is_empty() { 0 } else { position }])
                .collect();
            elements.push(self.target.apply(id, &scalars, self.live, span)?);
        }
        if elements.len() > super::MAX_SCALARS {
            return Err(fault!(NOT_SUPPORTED, "an array of too many elements").at(span));
        }
        Ok(Lowered::Array(Array { dims, elements }))
    }
}

/// The upper triangle of a matrix, mirrored (MLS §10.3.5).
fn symmetric<S: Copy>(a: Array<S>, span: Span) -> Result<Array<S>, Diagnostic> {
    let &[rows, columns] = a.dims.as_slice() else {
        return Err(fault!(ARRAY_MISMATCH, "`symmetric` takes a square matrix").at(span));
    };
    if rows != columns {
        return Err(fault!(ARRAY_MISMATCH, "`symmetric` takes a square matrix").at(span));
    }
    let mirrored = |at: usize| {
        let (i, j) = (at / columns, at % columns);
        a.elements[i.min(j) * columns + i.max(j)]
    };
    let elements = (0..a.elements.len()).map(mirrored).collect();
    Ok(Array { dims: vec![rows, columns], elements })
}
