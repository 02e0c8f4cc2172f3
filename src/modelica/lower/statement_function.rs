//! Statements of algorithm sections that cannot be evaluated symbolically, such as loops whose
//! ends depend on variables: each is a function of what it reads (MLS §11.1.1), and what it assigns
//! are results of a call. Relations in it cause no events.

use super::builder::Builder;
use super::errors::{NO_CONSTANT_VALUE, NOT_SUPPORTED};
use super::execution::{Loops, Written};
use super::expressions::{Array, Lowered, Lowering, VariableReferences};
use super::function::{call_of_any_size, interpreted_call};
use super::loops::LoopVariable;
use crate::diag::Diagnostic;
use crate::eval::{Function, FunctionBody, FunctionComponent, ValueType};
use crate::fault;
use crate::name::{Ident, Name};
use crate::source::Span;
use crate::symbolic::{Expr, VarId};
use crate::syntax::ast::{
    ComponentReference, Expression, ExpressionKind, ForIndex, ReferencePart, Statement,
    StatementKind, Subscript, targets,
};
use crate::syntax::visit::{
    Rewrite, Visit, rewrite_expression, rewrite_reference, walk_expression, walk_statement,
};
use indexmap::IndexMap;
use rustc_hash::FxHashSet;
use std::sync::Arc;

/// Whether an error says that something is not possible on expressions.
pub(super) fn may_be_a_function(error: &Diagnostic) -> bool {
    error.code == NOT_SUPPORTED || error.code == NO_CONSTANT_VALUE
}

impl Builder<'_> {
    /// Carries out a statement as the call of a function of its own.
    pub(super) fn call_of_statement(
        &mut self,
        s: &Statement,
        loops: &Loops,
    ) -> Result<(), Diagnostic> {
        let mut statement = s.clone();
        let mut naming = Naming {
            known: IndexMap::new(),
            own: iterators(s)?,
            builder: self,
            loops,
            failure: None,
        };
        naming.statement(&mut statement);
        let (known, failure) = (naming.known, naming.failure);
        if let Some(failure) = failure {
            return Err(failure);
        }
        let assigned = targets(std::slice::from_ref(&statement));
        let assigned: FxHashSet<_> = assigned.iter().map(|target| target.parts[0].name).collect();
        let (mut inputs, mut outputs, mut arguments) = (Vec::new(), Vec::new(), Vec::new());
        for LoopVariable { name, value, value_type } in loops {
            inputs.push(component(*name, value_type.clone(), &[], None, s.span));
            arguments.push(Lowered::scalar(*value));
        }
        for (Read { path, is_previous }, name) in &known {
            let value_type = self.value_type(path).unwrap_or(ValueType::Real);
            let reference = reference_to(Ident::new(path), s.span);
            let mut value = VariableReferences::reference(self, path, &reference)?;
            if *is_previous {
                value = self.previous_values(path, &reference)?;
            }
            let dims = match &value {
                Lowered::Array(array) => array.dims.clone(),
                Lowered::Text(_) => Vec::new(),
                _ => {
                    let error = fault!(NOT_SUPPORTED, "`{path}` in this kind of statement");
                    return Err(error.at(s.span));
                }
            };
            let input = match assigned.contains(name) {
                true => Ident::new(&format!("{name} before")),
                false => *name,
            };
            inputs.push(component(input, value_type.clone(), &dims, None, s.span));
            if input != *name {
                let before = ExpressionKind::Reference(reference_to(input, s.span));
                let before = Some(Expression::new(before, s.span));
                outputs.push(component(*name, value_type, &dims, before, s.span));
            }
            arguments.push(value);
        }
        let function = self.function_of(statement, inputs, outputs);
        let results = self.called_in_any_way(&function, arguments, s.span)?;
        let paths = known.iter().filter(|(_, name)| assigned.contains(*name));
        for ((read, _), result) in paths.zip(results) {
            self.assign_results(&read.path, &result, written_in(s));
        }
        Ok(())
    }

    /// The results of a call of such a function, by the interpreter where it cannot be compiled.
    fn called_in_any_way(
        &mut self,
        function: &Arc<Function>,
        arguments: Vec<Lowered<Expr>>,
        span: Span,
    ) -> Result<Vec<Lowered<Expr>>, Diagnostic> {
        match call_of_any_size(self, function, arguments.clone(), span) {
            Err(error) if error.code == NO_CONSTANT_VALUE => {
                interpreted_call(self, function, &arguments, span).ok_or(error)
            }
            results => results,
        }
    }

    /// `pre(v)`, element by element.
    fn previous_values(
        &mut self,
        path: &str,
        reference: &ComponentReference,
    ) -> Result<Lowered<Expr>, Diagnostic> {
        self.execution.raw += 1;
        let own = VariableReferences::reference(self, path, reference);
        self.execution.raw -= 1;
        match own? {
            Lowered::Array(Array { dims, elements }) => {
                self.check_discrete("pre", &elements, reference.span)?;
                let before = elements.into_iter().map(|e| self.previous(e, reference.span));
                Ok(Lowered::Array(Array { dims, elements: before.collect::<Result<_, _>>()? }))
            }
            _ => {
                Err(fault!(NOT_SUPPORTED, "`pre({path})` in this kind of statement")
                    .at(reference.span))
            }
        }
    }

    fn function_of(
        &mut self,
        statement: Statement,
        inputs: Vec<FunctionComponent>,
        outputs: Vec<FunctionComponent>,
    ) -> Arc<Function> {
        self.calls.statement_functions += 1;
        let name = Ident::new(&format!("statement {}", self.calls.statement_functions));
        Arc::new(Function {
            name: Name::from(name),
            inputs,
            outputs,
            locals: Vec::new(),
            span: statement.span,
            body: FunctionBody::Algorithm(vec![statement]),
            description: None,
            annotation: Vec::new(),
            impure: false,
        })
    }

    /// Gives the elements of a variable that the algorithm assigns their values.
    fn assign_results(&mut self, path: &str, result: &Lowered<Expr>, written: Written) {
        let mut values = Vec::new();
        result.append_scalars(&mut values);
        let Some(position) = self.flat.variables.get_index_of(path) else { return };
        let first = self.scalars.first[position].0;
        for (variable, value) in (first..).map(VarId).zip(values) {
            if let Some(before) = self.execution.values.get_mut(&variable) {
                *before = value;
                self.execution.assigned_by(variable, written);
                if self.place.in_when {
                    self.execution.in_when.insert(variable);
                }
            }
        }
    }
}

/// Where a statement assigns its results, as messages show it: of a loop its head.
fn written_in(s: &Statement) -> Written {
    match &s.kind {
        StatementKind::While { condition, .. } => Written::Loop(condition.span),
        StatementKind::For { indices, .. } => {
            Written::Loop(indices.first().map_or(s.span, |index| index.name.span))
        }
        _ => Written::Assignment(s.span),
    }
}

/// Gives the variables of the model in a statement names of one part each.
struct Naming<'s, 'b> {
    builder: &'s mut Builder<'b>,
    loops: &'s Loops,
    /// Loop variables of the statement.
    own: FxHashSet<Ident>,
    /// The new names of what is read.
    known: IndexMap<Read, Ident>,
    failure: Option<Diagnostic>,
}

/// A variable of the model that a statement reads or assigns.
#[derive(Debug, PartialEq, Eq, Hash)]
struct Read {
    path: String,
    /// Whether it is read by `pre`.
    is_previous: bool,
}

impl Naming<'_, '_> {
    fn rename(&mut self, reference: &mut ComponentReference, is_previous: bool) {
        rewrite_reference(self, reference);
        let is_loop = |name: Ident| {
            self.own.contains(&name) || self.loops.iter().any(|known| known.name == name)
        };
        if reference.as_ident().is_some_and(is_loop) {
            return;
        }
        let mut lowering = Lowering::new(self.builder);
        lowering.loops = self.loops.clone();
        let path = match lowering.path(reference) {
            Ok(path) => path,
            Err(error) => {
                self.failure.get_or_insert(error);
                return;
            }
        };
        if path != "time" && !self.builder.flat.variables.contains_key(path.as_str()) {
            return;
        }
        let number = self.known.len() + 1;
        let read = Read { path, is_previous };
        let name = *self.known.entry(read).or_insert_with(|| Ident::new(&format!("v {number}")));
        let subscripts = reference.parts.pop().map_or(Vec::new(), |part| part.subscripts);
        reference.parts = vec![ReferencePart { name, subscripts }];
    }
}

impl Rewrite for Naming<'_, '_> {
    fn expression(&mut self, expression: &mut Expression) {
        match read_by_pre(expression) {
            Some(mut reference) => {
                self.rename(&mut reference, true);
                expression.kind = ExpressionKind::Reference(reference);
            }
            None => rewrite_expression(self, expression),
        }
    }

    fn reference(&mut self, reference: &mut ComponentReference) {
        self.rename(reference, false);
    }
}

/// What `pre(v)` reads.
fn read_by_pre(expression: &Expression) -> Option<ComponentReference> {
    let ExpressionKind::Call { function, arguments } = &expression.kind else { return None };
    match (function.as_ident(), arguments.positional.as_slice()) {
        (Some(name), [Expression { kind: ExpressionKind::Reference(reference), .. }])
            if name == "pre" =>
        {
            Some(reference.clone())
        }
        _ => None,
    }
}

/// The names of the loop variables of a statement; an error where a statement in it has no meaning
/// in a function.
fn iterators(statement: &Statement) -> Result<FxHashSet<Ident>, Diagnostic> {
    let mut search = Iterators { names: FxHashSet::default(), alien: None };
    search.statement(statement);
    match search.alien {
        Some(span) => Err(fault!(NOT_SUPPORTED, "this statement in this kind of loop").at(span)),
        None => Ok(search.names),
    }
}

struct Iterators {
    names: FxHashSet<Ident>,
    alien: Option<Span>,
}

impl Iterators {
    fn add(&mut self, indices: &[ForIndex]) {
        self.names.extend(indices.iter().map(|index| index.name.node));
    }
}

impl Visit for Iterators {
    fn statement(&mut self, statement: &Statement) {
        match &statement.kind {
            StatementKind::For { indices, .. } => self.add(indices),
            StatementKind::When { .. } | StatementKind::Return => self.alien = Some(statement.span),
            _ => {}
        }
        walk_statement(self, statement);
    }

    fn expression(&mut self, expression: &Expression) {
        match &expression.kind {
            ExpressionKind::ArrayIteration { indices, .. } => self.add(indices),
            ExpressionKind::Call { arguments, .. } => self.add(&arguments.iterators),
            _ => {}
        }
        walk_expression(self, expression);
    }
}

fn component(
    name: Ident,
    value_type: ValueType,
    dims: &[usize],
    binding: Option<Expression>,
    span: Span,
) -> FunctionComponent {
    let size =
        |n: &usize| Subscript::Index(Expression::new(ExpressionKind::Integer(*n as i64), span));
    let dims = dims.iter().map(size).collect();
    let field_dims = Vec::new();
    FunctionComponent { name, value_type, dims, field_dims, binding, description: None, span }
}

fn reference_to(name: Ident, span: Span) -> ComponentReference {
    ComponentReference::from_name(&Name::from(name), span)
}
