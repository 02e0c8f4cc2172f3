//! Sizes that declarations leave open with `:`: those of what is assigned (MLS §12.4.5).

use super::emitter::Operand;
use super::statements::Body;
use crate::diag::Diagnostic;
use crate::eval::ValueType;
use crate::lower::errors::UNRESOLVED_REFERENCE;
use crate::lower::expressions::{FunctionCalls, Lowered};
use crate::lower::loops::LoopVariable;
use crate::lower::shape::Shape;
use crate::name::Ident;
use crate::syntax::ast::{
    ComponentReference, Expression, ExpressionKind, Statement, StatementKind,
};

/// An assignment to a variable, or to one of its components.
struct Assignment<'s> {
    target: &'s ComponentReference,
    /// Which of the outputs of the call that is assigned.
    output: Option<usize>,
    value: &'s Expression,
    /// Loop variables around it.
    loops: Vec<Ident>,
}

impl Body<'_, '_> {
    /// The shape of what is assigned to the variable or component of this path; `None` without an
    /// assignment to the whole of it.
    pub(super) fn assigned(
        &mut self,
        path: &[Ident],
        statements: &[Statement],
    ) -> Result<Option<Shape>, Diagnostic> {
        let mut assignments = Vec::new();
        collect(statements, &mut Vec::new(), &mut assignments);
        let mut failed = None;
        for assignment in assignments {
            let names: Vec<Ident> = assignment.target.parts.iter().map(|p| p.name).collect();
            let Some(rest) = path.strip_prefix(names.as_slice()) else { continue };
            match self.shape_assigned(&assignment) {
                Ok(shape) => match shape.and_then(|shape| component(shape, rest)) {
                    Some(shape) => return Ok(Some(shape)),
                    None => continue,
                },
                // What it needs may be declared further down.
                Err(error) if error.code == UNRESOLVED_REFERENCE => return Err(error),
                Err(error) => failed = failed.or(Some(error)),
            }
        }
        failed.map_or(Ok(None), Err)
    }

    /// The shape of the right side; its instructions are forgotten.
    fn shape_assigned(&mut self, assignment: &Assignment<'_>) -> Result<Option<Shape>, Diagnostic> {
        let before = self.emitter.checkpoint();
        let (branches, loops) = (self.branches.len(), self.loops.len());
        self.emitter.open();
        for name in &assignment.loops {
            let value = Operand::Register(self.emitter.block(1));
            self.loops.push(LoopVariable { name: *name, value, value_type: ValueType::Integer });
        }
        let value = match (assignment.output, &assignment.value.kind) {
            (Some(output), ExpressionKind::Call { function, arguments }) => {
                match self.function(&function.name()) {
                    Some(user) => self
                        .lowering()
                        .user_call(&user, arguments, assignment.value.span)
                        .map(|outputs| outputs.into_iter().nth(output)),
                    None => Ok(None),
                }
            }
            (Some(_), _) => Ok(None),
            (None, _) => self.lowering().lower(assignment.value).map(Some),
        };
        self.loops.truncate(loops);
        self.branches.truncate(branches);
        self.emitter.rollback(before);
        Ok(value?.as_ref().and_then(Lowered::shape))
    }
}

/// The shape of a component of a record.
fn component(shape: Shape, path: &[Ident]) -> Option<Shape> {
    path.iter().try_fold(shape, |shape, name| match shape {
        Shape::Record(fields) => fields.into_iter().find(|(field, _)| field == name).map(|f| f.1),
        _ => None,
    })
}

/// All assignments to whole variables and components, in order.
fn collect<'s>(list: &'s [Statement], loops: &mut Vec<Ident>, found: &mut Vec<Assignment<'s>>) {
    let is_whole =
        |target: &&ComponentReference| target.parts.iter().all(|part| part.subscripts.is_empty());
    for statement in list {
        match &statement.kind {
            StatementKind::Assign { target, value } => {
                let target = Some(target).filter(is_whole);
                found.extend(target.map(|target| Assignment {
                    target,
                    output: None,
                    value,
                    loops: loops.clone(),
                }));
            }
            StatementKind::MultiAssign { targets, value } => {
                for (output, target) in targets.iter().enumerate() {
                    let target = target.as_ref().filter(is_whole);
                    found.extend(target.map(|target| Assignment {
                        target,
                        output: Some(output),
                        value,
                        loops: loops.clone(),
                    }));
                }
            }
            StatementKind::For { indices, body } => {
                let outside = loops.len();
                loops.extend(indices.iter().map(|index| index.name.node));
                collect(body, loops, found);
                loops.truncate(outside);
            }
            _ => statement.bodies().for_each(|body| collect(body, loops, found)),
        }
    }
}
