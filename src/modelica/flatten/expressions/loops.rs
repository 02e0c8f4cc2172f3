//! Loops: their ranges and iterations (MLS §8.3.3, §11.2.2). A range that is not written is the sizes
//! of the arrays that the loop variable is a subscript of (MLS §11.2.2.1).

use crate::diag::Diagnostic;
use crate::fault;
use crate::flatten::BaseType;
use crate::flatten::errors::{
    NOT_CONSTANT, NOT_SUPPORTED, SIZE_MISMATCH, TOO_LARGE, TYPE_MISMATCH,
};
use crate::flatten::expressions::local::Local;
use crate::flatten::flat_expression::literal;
use crate::flatten::ids::{NodeId, ScopeId};
use crate::flatten::instantiate::instance::{Declaration, MemberState, NodeKind};
use crate::flatten::instantiate::instantiation::Instantiation;
use crate::inference::{SubscriptUse, subscript_uses};
use crate::name::{Ident, Name};
use crate::syntax::ast::{
    Arguments, ComponentReference, Expression, ExpressionKind, ForIndex, Statement, StatementKind,
    Subscript,
};
use crate::syntax::visit::{Visit, walk_statement};
use crate::value::{ArrayValue, Elements, Value};

/// The most equations that loops are unrolled to.
pub(crate) const MAX_EQUATIONS: usize = 5_000_000;

/// What a subscript of one dimension of an array runs over.
#[derive(PartialEq)]
enum Extent {
    /// The numbers from 1 to the size.
    Size(usize),
    /// The values of Boolean.
    Booleans,
}

/// Finds the arrays that are assigned as a whole.
#[derive(Default)]
struct Assigned {
    names: Vec<Ident>,
}

impl Visit for Assigned {
    fn statement(&mut self, statement: &Statement) {
        let targets = match &statement.kind {
            StatementKind::Assign { target, .. } => vec![target],
            StatementKind::MultiAssign { targets, .. } => targets.iter().flatten().collect(),
            _ => Vec::new(),
        };
        self.names.extend(targets.iter().filter_map(|target| target.as_ident()));
        walk_statement(self, statement);
    }
}

impl Instantiation<'_> {
    /// The size that gives a loop in a function its range must stay as it is in the loop
    /// (MLS §11.2.2.1).
    pub(crate) fn check_range_stays(
        &mut self,
        indices: &[ForIndex],
        body: &[Statement],
        context: ScopeId,
    ) -> Result<(), Diagnostic> {
        for index in indices.iter().filter(|index| index.range.is_none()) {
            let mut assigned = Assigned::default();
            let uses = subscript_uses(index.name.node, &|search| {
                body.iter().for_each(|statement| search.statement(statement));
            });
            body.iter().for_each(|statement| assigned.statement(statement));
            for array in uses.iter().filter_map(|one| one.array.as_ident()) {
                let elements = self.classes.elements(context)?;
                let declared = elements.get(array);
                let is_open = |one: &Declaration| {
                    one.dims.iter().any(|(d, _)| matches!(d, Subscript::All(_)))
                };
                if assigned.names.contains(&array) && declared.is_some_and(|one| is_open(one)) {
                    return Err(fault!(SIZE_MISMATCH,
                        "the loop runs over the subscripts of `{array}`, which it assigns: the size \
                         of `{array}` may change";
                        help: "write the range: `for {} in 1:n loop`", index.name.node)
                    .at(index.name.span));
                }
            }
        }
        Ok(())
    }

    /// The loop variables with ranges; those that are not written are found by letting `visit` look
    /// through the body.
    pub(crate) fn with_ranges(
        &mut self,
        indices: &[ForIndex],
        context: ScopeId,
        local: &Local,
        visit: &dyn Fn(&mut dyn Visit),
    ) -> Result<Vec<ForIndex>, Diagnostic> {
        let mut all = Vec::with_capacity(indices.len());
        for index in indices {
            let mut index = index.clone();
            if index.range.is_none() {
                let uses = subscript_uses(index.name.node, visit);
                index.range = Some(self.deduced(&index, &uses, context, local)?);
            }
            all.push(index);
        }
        Ok(all)
    }

    fn deduced(
        &mut self,
        index: &ForIndex,
        uses: &[SubscriptUse],
        context: ScopeId,
        local: &Local,
    ) -> Result<Expression, Diagnostic> {
        let (name, span) = (index.name.node, index.name.span);
        let mut known: Option<Extent> = None;
        let mut of_local = None;
        for one in uses {
            let first = one.array.parts[0].name;
            if local.names.iter().any(|(known, _)| *known == first) {
                of_local = Some(one);
                continue;
            }
            let Some(extent) = self.extent_of_array(one, context)? else { continue };
            if known.as_ref().is_some_and(|known| *known != extent) {
                return Err(fault!(
                    SIZE_MISMATCH,
                    "the deduced range of `{name}` is ambiguous: the arrays have different sizes";
                    help: "write the range: `for {name} in 1:n loop`")
                .at(span));
            }
            known = Some(extent);
        }
        let integer = |n: i64| Expression::new(ExpressionKind::Integer(n), span);
        let stop = match (known, of_local) {
            (Some(Extent::Booleans), _) => return Ok(super::enumerations::all_booleans(span)),
            (Some(Extent::Size(size)), _) => integer(size as i64),
            (None, Some(one)) => {
                let array = ExpressionKind::Reference(one.array.clone());
                let positional =
                    vec![Expression::new(array, span), integer(one.dimension as i64 + 1)];
                let function = ComponentReference::from_name(&Name::parse("size"), span);
                let arguments = Box::new(Arguments { positional, ..Arguments::default() });
                Expression::new(ExpressionKind::Call { function, arguments }, span)
            }
            (None, None) => {
                return Err(fault!(
                    NOT_CONSTANT,
                    "the range of `{name}` is missing and cannot be deduced: `{name}` alone is \
                     not a subscript of any array";
                    help: "write the range: `for {name} in 1:n loop`")
                .at(span));
            }
        };
        let kind =
            ExpressionKind::Range { start: Box::new(integer(1)), step: None, stop: Box::new(stop) };
        Ok(Expression::new(kind, span))
    }

    /// The extent of one dimension of an array of variables or components.
    fn extent_of_array(
        &mut self,
        one: &SubscriptUse,
        context: ScopeId,
    ) -> Result<Option<Extent>, Diagnostic> {
        let mut node = self.classes.node_of(context);
        if !self.classes.has_component(context, one.array.parts[0].name)? {
            return Ok(None);
        }
        let count = one.array.parts.len();
        for (at, part) in one.array.parts.iter().enumerate() {
            let is_last = at + 1 == count;
            let dims = match self.member(node, part.name)?.map(MemberState::seen) {
                Some(MemberState::Single(next)) => match &self.classes.tree.nodes[next.0].kind {
                    NodeKind::Variable(leaf) => {
                        self.classes.tree.variables[leaf.variable].0.dims.clone()
                    }
                    NodeKind::Composite(_) => {
                        node = next;
                        continue;
                    }
                },
                Some(MemberState::Array(dims, _)) if is_last => dims,
                Some(MemberState::Array(_, nodes)) => match nodes.first() {
                    Some(first) => {
                        node = *first;
                        continue;
                    }
                    None => return Ok(None),
                },
                _ => return Ok(None),
            };
            if is_last && self.is_sized_by_boolean(node, part.name, one.dimension)? {
                return Ok(Some(Extent::Booleans));
            }
            let size = dims.get(one.dimension).copied().filter(|_| is_last);
            return Ok(size.map(Extent::Size));
        }
        Ok(None)
    }

    /// Whether the subscripts of one dimension of a component are of type Boolean.
    fn is_sized_by_boolean(
        &mut self,
        node: NodeId,
        name: Ident,
        dimension: usize,
    ) -> Result<bool, Diagnostic> {
        let values = self.classes.subscript_type(node, name, dimension)?;
        Ok(values.is_some_and(|values| self.types().type_of(&values) == Some(BaseType::Boolean)))
    }

    /// What the body of a loop knows in each of its iterations.
    pub(crate) fn iterations(
        &mut self,
        indices: &[ForIndex],
        context: ScopeId,
        local: &Local,
        out: &mut Vec<Local>,
    ) -> Result<(), Diagnostic> {
        let span = indices.first().map(|index| index.name.span);
        self.each_iteration(indices, context, local, &mut |_, iteration| {
            out.push(iteration.clone());
            match span {
                Some(span) if out.len() > MAX_EQUATIONS => {
                    let fault = fault!(TOO_LARGE, "the loop has too many iterations");
                    Err(fault.at(span))
                }
                _ => Ok(()),
            }
        })
    }

    /// Visits a loop's body with what it knows in each of its iterations.
    pub(crate) fn each_iteration(
        &mut self,
        indices: &[ForIndex],
        context: ScopeId,
        local: &Local,
        visit: &mut dyn FnMut(&mut Self, &Local) -> Result<(), Diagnostic>,
    ) -> Result<(), Diagnostic> {
        let Some((index, inner)) = indices.split_first() else { return visit(self, local) };
        let span = index.name.span;
        let range = index.range.as_ref().ok_or_else(|| {
            fault!(NOT_SUPPORTED, "the range of `{}` is unknown", index.name.node;
                help: "write the range of the loop, such as `1:n`")
            .at(span)
        })?;
        let resolved = match self.classes.type_range(range, context, local)? {
            Some(values) => values,
            None => self.resolve(range, context, local)?,
        };
        let mut iteration = local.clone();
        let values = match self.elements_of_records(&resolved, local) {
            Some(records) => records.to_vec(),
            None => self.range_values(&resolved)?.iter().map(|one| literal(one, span)).collect(),
        };
        for value in values {
            iteration.names.push((index.name.node, Some(value)));
            self.each_iteration(inner, context, &iteration, visit)?;
            iteration.names.pop();
        }
        Ok(())
    }

    /// The elements of a range that are records: a loop variable stands for each of them in turn.
    pub(crate) fn elements_of_records<'e>(
        &self,
        range: &'e Expression,
        local: &Local,
    ) -> Option<&'e [Expression]> {
        match &range.kind {
            ExpressionKind::Array(elements) if self.types().record_of(range, local).is_some() => {
                Some(elements)
            }
            _ => None,
        }
    }

    pub(crate) fn range_values(&mut self, range: &Expression) -> Result<Vec<Value>, Diagnostic> {
        match self.flat_value(range)? {
            Value::Array(ArrayValue { dims, elements, .. }) if dims.len() == 1 => {
                Ok((0..Elements::len(&elements)).map(|at| elements.get(at)).collect())
            }
            other => {
                let found = other.type_name();
                Err(fault!(TYPE_MISMATCH, "a loop needs a vector as its range, got {found}")
                    .at(range.span))
            }
        }
    }
}
