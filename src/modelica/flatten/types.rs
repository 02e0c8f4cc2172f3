//! Types, numbers of dimensions and variability of resolved expressions, as far as their text
//! shows them, and whether they fit what they are bound to (MLS §3.8, §6.7, §10.1).

use super::balance::path;
use super::errors::{NOT_CONSTANT, SIZE_MISMATCH, TYPE_MISMATCH};
use super::{BaseType, Variability, Variable};
use crate::diag::Diagnostic;
use crate::eval::{Function, ValueType};
use crate::fault;
use crate::flatten::functions::table::FunctionTable;
use crate::flatten::instantiate::tree::Tree;
use crate::inference::{
    self, ElementType, Elementary, Sizes, SizesOfNames, TypesOfNames, VariabilityOfNames,
};
use crate::source::Span;
use crate::syntax::ast::{Arguments, ComponentReference, Expression, ExpressionKind};
use crate::syntax::visit::Visit;
use std::sync::Arc;

/// What the types of resolved expressions follow from: the variables and the functions that they
/// name.
pub(crate) struct Types<'t> {
    pub tree: &'t Tree,
    pub functions: &'t FunctionTable,
}

impl Types<'_> {
    /// Refuses a value whose type or dimensions cannot be those of the variable.
    pub(crate) fn check_value(
        &self,
        e: &Expression,
        variable: &Variable,
        each: bool,
    ) -> Result<(), Diagnostic> {
        let name = &variable.name;
        if let Some(found) = self.type_of(e)
            && !fits(&found, &variable.base, e)
        {
            let (expected, found) = (type_name(&variable.base), type_name(&found));
            return Err(fault!(TYPE_MISMATCH, "`{name}` is {expected}, but its value is {found}")
                .at(e.span));
        }
        let expected = if each { 0 } else { variable.dims.len() };
        match self.rank_of(e) {
            Some(found) if found != expected => {
                let help = match (expected, found) {
                    (_, 0) => Some(
                        "give an array, such as `fill(value, n)`; in a modifier, `each` repeats a \
                         value",
                    ),
                    (1, 2) => Some(
                        "`[...]` makes a matrix, `{...}` a vector; `cat(1, a, b)` puts vectors one \
                         after the other",
                    ),
                    _ => None,
                };
                return Err(fault!(
                    SIZE_MISMATCH,
                    "`{name}` has {expected} dimensions, but its value has {found}"
                )
                .help_if(help.map(str::to_owned))
                .at(e.span));
            }
            _ => {}
        }
        Ok(())
    }

    /// Refuses an equation between values of different types (MLS §8.3.1).
    pub(crate) fn check_sides(
        &self,
        left: &Expression,
        right: &Expression,
        span: Span,
    ) -> Result<(), Diagnostic> {
        let (Some(a), Some(b)) = (self.type_of(left), self.type_of(right)) else { return Ok(()) };
        if fits(&a, &b, left) || fits(&b, &a, right) {
            return Ok(());
        }
        let (a, b) = (type_name(&a), type_name(&b));
        Err(fault!(TYPE_MISMATCH, "the left side is {a}, but the right side is {b}").at(span))
    }

    /// Refuses a value that changes more often than the variable may.
    pub(crate) fn check_variability(
        &self,
        e: &Expression,
        variable: &Variable,
    ) -> Result<(), Diagnostic> {
        if variable.variability > Variability::Parameter {
            return Ok(());
        }
        let what = |variability| match variability {
            Variability::Constant => "a constant",
            Variability::Parameter => "a parameter",
            Variability::Discrete | Variability::Continuous => "a variable",
        };
        let Some(most) = inference::most_variable(&mut &*self, e) else { return Ok(()) };
        if most.variability <= variable.variability {
            return Ok(());
        }
        let found = match most.is_operator {
            true => format!("`{}`, whose value changes at events", most.name.name()),
            false => format!("`{}`, which is {}", path(&most.name), what(most.variability)),
        };
        Err(fault!(
            NOT_CONSTANT,
            "`{}` is {}, but its value depends on {found}",
            variable.name,
            what(variable.variability)
        )
        .at(e.span))
    }

    fn named(&self, reference: &ComponentReference) -> Option<&Variable> {
        let at = self.tree.variable_of.get(&*path(reference))?;
        Some(&self.tree.variables[*at].0)
    }

    /// The element type of an expression; `None` where its text does not show it.
    pub(crate) fn type_of(&self, e: &Expression) -> Option<BaseType> {
        inference::type_of(&mut &*self, e)
    }

    /// The number of dimensions of an expression; `None` where its text does not show it.
    pub(crate) fn rank_of(&self, e: &Expression) -> Option<usize> {
        inference::sizes_of(&mut &*self, e).map(|sizes| sizes.len())
    }
}

impl ElementType for BaseType {
    fn elementary(which: Elementary) -> Option<BaseType> {
        Some(match which {
            Elementary::Real => BaseType::Real,
            Elementary::Integer => BaseType::Integer,
            Elementary::Boolean => BaseType::Boolean,
            Elementary::String => BaseType::String,
            Elementary::Clock => BaseType::Clock,
        })
    }
}

impl TypesOfNames for &Types<'_> {
    type Type = BaseType;

    fn of_reference(&mut self, reference: &ComponentReference) -> Option<BaseType> {
        Some(self.named(reference)?.base.clone())
    }

    fn rank(&mut self, e: &Expression) -> Option<usize> {
        self.rank_of(e)
    }

    fn of_function(
        &mut self,
        function: &ComponentReference,
        _: &Arguments,
    ) -> Option<Option<BaseType>> {
        let user = self.functions.table.get(&function.name())?.as_ref()?;
        Some(user.outputs.first().and_then(|output| match &output.value_type {
            ValueType::Real => Some(BaseType::Real),
            ValueType::Integer => Some(BaseType::Integer),
            ValueType::Boolean => Some(BaseType::Boolean),
            ValueType::String => Some(BaseType::String),
            ValueType::Enumeration(definition) => Some(BaseType::Enumeration(definition.clone())),
            _ => None,
        }))
    }
}

impl VariabilityOfNames for &Types<'_> {
    fn of_reference(&mut self, reference: &ComponentReference) -> Option<Variability> {
        self.named(reference).map(|variable| variable.variability)
    }
}

impl SizesOfNames for &Types<'_> {
    type Function = Function;

    fn of_reference(&mut self, reference: &ComponentReference) -> Option<Sizes> {
        Some(self.named(reference)?.dims.iter().copied().map(Some).collect())
    }

    fn function(&mut self, function: &ComponentReference) -> Option<Option<Arc<Function>>> {
        self.functions.table.get(&function.name()).cloned().flatten().map(Some)
    }
}

/// Whether a value of one type can be given to a variable of another; literals of enumerations
/// are Integer literals by now.
fn fits(found: &BaseType, expected: &BaseType, e: &Expression) -> bool {
    match (found, expected) {
        (BaseType::Integer, BaseType::Real) => true,
        (BaseType::Integer, BaseType::Enumeration(_)) => may_be_literal(e),
        _ => found == expected,
    }
}

/// Whether what gives the value may be a literal of an enumeration, which is an Integer by now.
fn may_be_literal(e: &Expression) -> bool {
    match &e.kind {
        ExpressionKind::Integer(_) => true,
        ExpressionKind::If { branches, otherwise } => {
            branches.iter().all(|(_, value)| may_be_literal(value)) && may_be_literal(otherwise)
        }
        ExpressionKind::Array(elements) => elements.iter().all(may_be_literal),
        ExpressionKind::Matrix(rows) => rows.iter().flatten().all(may_be_literal),
        ExpressionKind::Reference(_) => false,
        _ => true,
    }
}

/// Whether an expression holds no references and calls no functions of a library.
pub(crate) fn has_only_literals(e: &Expression) -> bool {
    struct References(bool);
    impl Visit for References {
        fn reference(&mut self, _: &ComponentReference) {
            self.0 = true;
        }
    }
    if let ExpressionKind::If { branches, otherwise } = &e.kind {
        let mut values = branches.iter().map(|(_, value)| value).chain([&**otherwise]);
        return values.all(has_only_literals);
    }
    let mut references = References(false);
    references.expression(e);
    !references.0
}

/// The name of a type, for messages.
pub(crate) fn type_name(base: &BaseType) -> String {
    match base {
        BaseType::Real => "Real".into(),
        BaseType::Integer => "Integer".into(),
        BaseType::Boolean => "Boolean".into(),
        BaseType::String => "String".into(),
        BaseType::Enumeration(definition) => definition.name.to_string(),
        BaseType::ExternalObject(name) => name.to_string(),
        BaseType::Clock => "Clock".into(),
    }
}
