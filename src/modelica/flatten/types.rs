//! Types, numbers of dimensions and variability of resolved expressions, as far as their text
//! shows them, and whether they fit what they are bound to (MLS §3.8, §6.7, §10.1).

use super::balance::path;
use super::errors::{NOT_CONSTANT, SIZE_MISMATCH, TYPE_MISMATCH};
use super::{BaseType, Variability, Variable};
use crate::diag::Diagnostic;
use crate::eval::{Function, FunctionComponent, ValueType};
use crate::fault;
use crate::flatten::functions::table::FunctionTable;
use crate::flatten::instantiate::tree::Tree;
use crate::functions::{self, ArgumentShapes, ShapeRule, TypeRule, VariabilityRule};
use crate::name::Ident;
use crate::source::Span;
use crate::syntax::ast::{
    Arguments, BinaryOperator, ComponentReference, Expression, ExpressionKind, ForIndex, Subscript,
    UnaryOperator,
};
use crate::syntax::visit::{Visit, walk_expression, walk_reference};

/// What the types of resolved expressions follow from: the variables and the functions that they
/// name.
pub struct Types<'t> {
    pub tree: &'t Tree,
    pub functions: &'t FunctionTable,
}

impl Types<'_> {
    /// Refuses a value whose type or dimensions cannot be those of the variable.
    pub fn check_value(
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
                let help = "give an array, such as `fill(value, n)`; in a modifier, `each` repeats \
                            a value";
                let help = (found == 0).then_some(help);
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
        let Some((name, found)) = self.most_variable(e) else { return Ok(()) };
        if found <= variable.variability {
            return Ok(());
        }
        let what = |variability| match variability {
            Variability::Constant => "a constant",
            Variability::Parameter => "a parameter",
            Variability::Discrete | Variability::Continuous => "a variable",
        };
        Err(fault!(
            NOT_CONSTANT,
            "`{}` is {}, but its value depends on `{name}`, which is {}",
            variable.name,
            what(variable.variability),
            what(found)
        )
        .at(e.span))
    }

    /// The variable in an expression that changes most often, with its variability.
    fn most_variable(&self, e: &Expression) -> Option<(String, Variability)> {
        let mut search = MostVariable { types: self, iterators: Vec::new(), most: None };
        search.expression(e);
        search.most
    }

    fn variability_of(&self, reference: &ComponentReference) -> Option<Variability> {
        if reference.as_ident().is_some_and(|name| name == "time") {
            return Some(Variability::Continuous);
        }
        self.named(reference).map(|variable| variable.variability)
    }

    fn named(&self, reference: &ComponentReference) -> Option<&Variable> {
        let at = self.tree.variable_of.get(&*path(reference))?;
        Some(&self.tree.variables[*at].0)
    }

    /// The element type of an expression; `None` where its text does not show it.
    pub fn type_of(&self, e: &Expression) -> Option<BaseType> {
        match &e.kind {
            ExpressionKind::Real(_) => Some(BaseType::Real),
            ExpressionKind::Integer(_) => Some(BaseType::Integer),
            ExpressionKind::Boolean(_) => Some(BaseType::Boolean),
            ExpressionKind::String(_) => Some(BaseType::String),
            ExpressionKind::Reference(reference) => match reference.as_ident() {
                Some(name) if name == "time" => Some(BaseType::Real),
                _ => Some(self.named(reference)?.base.clone()),
            },
            ExpressionKind::Unary { operator: UnaryOperator::Not, .. } => Some(BaseType::Boolean),
            ExpressionKind::Unary { operand, .. } => self.type_of(operand),
            ExpressionKind::Binary { operator, .. } => match type_of_result(*operator) {
                None => self.joined_type(e.operands_of(|one| type_of_result(one).is_none())),
                known => known,
            },
            ExpressionKind::If { branches, otherwise } => {
                self.joined_type(branches.iter().map(|(_, value)| value).chain([&**otherwise]))
            }
            ExpressionKind::Array(elements) => self.joined_type(elements.iter()),
            ExpressionKind::Call { function, arguments } => self.call_type(function, arguments),
            _ => None,
        }
    }

    /// The type that all have together.
    fn joined_type<'e>(&self, all: impl Iterator<Item = &'e Expression>) -> Option<BaseType> {
        let mut types = all.map(|one| self.type_of(one));
        let first = types.next()??;
        types.try_fold(first, |all, one| joined(all, one?))
    }

    fn call_type(&self, function: &ComponentReference, arguments: &Arguments) -> Option<BaseType> {
        if let Some(Some(user)) = self.functions.table.get(&function.name()) {
            return match user.outputs.first()?.value_type {
                ValueType::Real => Some(BaseType::Real),
                ValueType::Integer => Some(BaseType::Integer),
                ValueType::Boolean => Some(BaseType::Boolean),
                ValueType::String => Some(BaseType::String),
                _ => None,
            };
        }
        match functions::find(function.as_ident()?.as_str())?.value_type {
            TypeRule::Real => Some(BaseType::Real),
            TypeRule::Integer => Some(BaseType::Integer),
            TypeRule::Boolean => Some(BaseType::Boolean),
            TypeRule::String => Some(BaseType::String),
            TypeRule::Clock => Some(BaseType::Clock),
            TypeRule::Sampled => match self.is_of_clock(arguments) {
                true => self.type_of(arguments.positional.first()?),
                false => Some(BaseType::Boolean),
            },
            TypeRule::As(at) => self.type_of(arguments.positional.get(at)?),
            TypeRule::Joined => self.joined_type(arguments.positional.iter()),
            TypeRule::Unknown => None,
        }
    }

    /// Whether the arguments of `sample` are an expression and a clock, rather than two times
    /// (MLS §16.5.1).
    fn is_of_clock(&self, arguments: &Arguments) -> bool {
        let named = arguments.named.iter().any(|argument| argument.name.node == "clock");
        match arguments.positional.get(1) {
            Some(second) => self.type_of(second) == Some(BaseType::Clock),
            None => named || arguments.named.is_empty(),
        }
    }

    /// The number of dimensions of an expression; `None` where its text does not show it.
    pub(crate) fn rank_of(&self, e: &Expression) -> Option<usize> {
        match &e.kind {
            ExpressionKind::Real(_)
            | ExpressionKind::Integer(_)
            | ExpressionKind::Boolean(_)
            | ExpressionKind::String(_) => Some(0),
            ExpressionKind::Reference(reference) => self.reference_rank(reference),
            ExpressionKind::Unary { operand, .. } => self.rank_of(operand),
            ExpressionKind::Binary { .. } => {
                let (first, operations) = e.chain();
                operations.into_iter().try_fold(self.rank_of(first)?, |left, one| {
                    rank_of_operation(one.operator, left, self.rank_of(one.right)?)
                })
            }
            ExpressionKind::If { branches, otherwise } => {
                self.rank_of(branches.first().map_or(otherwise, |(_, value)| value))
            }
            ExpressionKind::Range { .. } => Some(1),
            ExpressionKind::Array(elements) => Some(1 + self.rank_of(elements.first()?)?),
            ExpressionKind::Call { function, arguments } => {
                if let Some(Some(user)) = self.functions.table.get(&function.name()) {
                    return self.rank_of_output(user, arguments);
                }
                let entry = functions::find(function.as_ident()?.as_str())?;
                if entry.shape != ShapeRule::Planned || !arguments.iterators.is_empty() {
                    return None;
                }
                entry.shape_of(&mut Ranks { types: self, arguments }).map(|dims| dims.len())
            }
            _ => None,
        }
    }

    /// The number of dimensions of the first output of a function, unless it may be called element by
    /// element.
    fn rank_of_output(&self, user: &Function, arguments: &Arguments) -> Option<usize> {
        let fits = |(argument, input): (&Expression, &FunctionComponent)| {
            self.rank_of(argument) == Some(input.dims.len())
        };
        let all_fit = arguments.named.is_empty()
            && arguments.iterators.is_empty()
            && arguments.positional.iter().zip(&user.inputs).all(fits);
        all_fit.then(|| user.outputs.first().map(|output| output.dims.len()))?
    }

    fn reference_rank(&self, reference: &ComponentReference) -> Option<usize> {
        if reference.as_ident().is_some_and(|name| name == "time") {
            return Some(0);
        }
        let dims = self.named(reference)?.dims.len();
        let mut gone = 0;
        for subscript in &reference.parts.last()?.subscripts {
            if let Subscript::Index(e) = subscript {
                match self.rank_of(e)? {
                    0 => gone += 1,
                    _ => return None,
                }
            }
        }
        dims.checked_sub(gone)
    }
}

/// The number of dimensions of what an operation makes of such operands (MLS §10.6).
/// The type of the result, where it is not that of the operands.
fn type_of_result(operator: BinaryOperator) -> Option<BaseType> {
    use BinaryOperator as Op;
    match operator {
        Op::Less
        | Op::LessEqual
        | Op::Greater
        | Op::GreaterEqual
        | Op::Equal
        | Op::NotEqual
        | Op::And
        | Op::Or => Some(BaseType::Boolean),
        Op::Divide | Op::ElementwiseDivide | Op::Power | Op::ElementwisePower => {
            Some(BaseType::Real)
        }
        _ => None,
    }
}

fn rank_of_operation(operator: BinaryOperator, left: usize, right: usize) -> Option<usize> {
    use BinaryOperator as Op;
    match (operator, left, right) {
        (_, 0, 0) => Some(0),
        (Op::Multiply, 1, 1) => Some(0),
        (Op::Multiply, 2, 1) | (Op::Multiply, 1, 2) => Some(1),
        (Op::Multiply, 2, 2) | (Op::Power, 2, 0) => Some(2),
        (Op::Multiply, rank, 0) | (Op::Multiply, 0, rank) | (Op::Divide, rank, 0) => Some(rank),
        (Op::Add | Op::Subtract, _, _) => (left == right).then_some(left),
        (
            Op::ElementwiseAdd
            | Op::ElementwiseSubtract
            | Op::ElementwiseMultiply
            | Op::ElementwiseDivide
            | Op::ElementwisePower,
            _,
            _,
        ) => (left == right || left == 0 || right == 0).then_some(left.max(right)),
        _ => None,
    }
}

/// The numbers of dimensions of arguments, as sizes of one each.
struct Ranks<'i, 'a> {
    types: &'i Types<'a>,
    arguments: &'i Arguments,
}

impl ArgumentShapes for Ranks<'_, '_> {
    fn count(&self) -> usize {
        self.arguments.positional.len()
    }

    fn dims(&mut self, at: usize) -> Option<Vec<usize>> {
        Some(vec![1; self.types.rank_of(self.arguments.positional.get(at)?)?])
    }

    fn number(&mut self, at: usize) -> Option<i64> {
        match self.arguments.positional.get(at)?.kind {
            ExpressionKind::Integer(value) => Some(value),
            _ => None,
        }
    }

    fn size(&mut self, _: usize) -> Option<i64> {
        Some(2)
    }
}

/// Searches the variable that changes most often.
struct MostVariable<'i, 'a> {
    types: &'i Types<'a>,
    /// Iterators around, which may have the name of a variable.
    iterators: Vec<Ident>,
    most: Option<(String, Variability)>,
}

impl MostVariable<'_, '_> {
    /// Expressions with iterators, in whose ranges those after them are known.
    fn iterated<'e>(
        &mut self,
        indices: &[ForIndex],
        elements: impl IntoIterator<Item = &'e Expression>,
    ) {
        let outside = self.iterators.len();
        indices.iter().filter_map(|index| index.range.as_ref()).for_each(|e| self.expression(e));
        self.iterators.extend(indices.iter().map(|index| index.name.node));
        elements.into_iter().for_each(|element| self.expression(element));
        self.iterators.truncate(outside);
    }
}

impl Visit for MostVariable<'_, '_> {
    fn expression(&mut self, e: &Expression) {
        match &e.kind {
            ExpressionKind::Call { function, .. }
                if function.as_ident().is_some_and(reads_sizes) => {}
            ExpressionKind::Call { arguments, .. } if !arguments.iterators.is_empty() => {
                self.iterated(&arguments.iterators, &arguments.positional);
            }
            ExpressionKind::ArrayIteration { element, indices } => {
                self.iterated(indices, [&**element]);
            }
            _ => walk_expression(self, e),
        }
    }

    fn reference(&mut self, reference: &ComponentReference) {
        let is_iterator = reference.as_ident().is_some_and(|name| self.iterators.contains(&name));
        if !is_iterator
            && let Some(found) = self.types.variability_of(reference)
            && self.most.as_ref().is_none_or(|(_, known)| found > *known)
        {
            self.most = Some((path(reference).into_owned(), found));
        }
        walk_reference(self, reference);
    }
}

/// Whether a function reads sizes of its argument and not its value.
fn reads_sizes(name: Ident) -> bool {
    let entry = functions::find(name.as_str());
    entry.is_some_and(|entry| entry.variability == VariabilityRule::Never)
}

/// The type that values of both types have.
fn joined(one: BaseType, other: BaseType) -> Option<BaseType> {
    match (one, other) {
        (BaseType::Real, BaseType::Integer) | (BaseType::Integer, BaseType::Real) => {
            Some(BaseType::Real)
        }
        (one, other) => (one == other).then_some(one),
    }
}

/// Whether a value of one type can be given to a variable of another; literals of enumerations
/// are Integer literals by now.
fn fits(found: &BaseType, expected: &BaseType, e: &Expression) -> bool {
    match (found, expected) {
        (BaseType::Integer, BaseType::Real) => true,
        (BaseType::Integer, BaseType::Enumeration(_)) => may_be_literal(e),
        // The same literals in the same order are the same type (MLS §6.4).
        (BaseType::Enumeration(one), BaseType::Enumeration(other)) => {
            one.literals == other.literals
        }
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
pub fn type_name(base: &BaseType) -> String {
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
