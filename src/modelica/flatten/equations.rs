//! Equations of the instances: names resolved, loops unrolled, branches on parameters chosen
//! where they must be (MLS §8.3, §8.6).

use super::errors::{NOT_SUPPORTED, TYPE_MISMATCH};
use super::instantiate::instance::MemberState;
use super::{FlatModel, Part};
use crate::diag::Diagnostic;
use crate::eval::{FunctionBody, ValueType};
use crate::fault;
use crate::flatten::expressions::local::Local;
use crate::flatten::expressions::loops::MAX_EQUATIONS;
use crate::flatten::functions::table::FunctionTable;
use crate::flatten::ids::NodeId;
use crate::flatten::ids::ScopeId;
use crate::flatten::instantiate::instantiation::Instantiation;
use crate::flatten::library::LegacyConstruct;
use crate::flatten::types::Types;
use crate::name::Ident;
use crate::source::Span;
use crate::syntax::ast::{
    Equation, EquationKind, Expression, ExpressionKind, ForIndex, ReferencePart, Section,
};
use crate::syntax::visit::Visit;
use crate::value::Value;
use std::sync::Arc;

impl Instantiation<'_> {
    /// Adds the equations and algorithms of a node and of all below it.
    pub(crate) fn add_equations(
        &mut self,
        node: NodeId,
        model: &mut FlatModel,
        errors: &mut Vec<Diagnostic>,
    ) {
        match self.classes.instances(node) {
            Ok(instances) => {
                for node in instances {
                    if let Err(error) = self.add_part(node, model, errors) {
                        errors.push(error);
                    }
                }
            }
            Err(error) => errors.push(error),
        }
    }

    /// Adds the equations and algorithms that the class of an instance and its bases write.
    fn add_part(
        &mut self,
        node: NodeId,
        model: &mut FlatModel,
        errors: &mut Vec<Diagnostic>,
    ) -> Result<(), Diagnostic> {
        let Some(scope) = self.classes.tree.scope_of(node) else { return Ok(()) };
        let elements = self.classes.elements(scope)?;
        let (equations, algorithms) = (model.equations.len(), model.algorithms.len());
        let initial_equations = model.initial_equations.len();
        for context in elements.lineage() {
            let text = self.classes.text(context).clone();
            for section in text.sections() {
                if let Err(error) = self.add_section(section, context, model, errors) {
                    errors.push(error);
                }
            }
        }
        let outputs = self.outer_outputs(node)?;
        model.parts.push(Part {
            instance: self.classes.tree.nodes[node.0].path.as_str().into(),
            outputs,
            equations: equations..model.equations.len(),
            initial_equations: initial_equations..model.initial_equations.len(),
            algorithms: algorithms..model.algorithms.len(),
        });
        Ok(())
    }

    fn add_section(
        &mut self,
        section: &Section,
        context: ScopeId,
        model: &mut FlatModel,
        errors: &mut Vec<Diagnostic>,
    ) -> Result<(), Diagnostic> {
        let initial = matches!(
            section,
            Section::Equations { initial: true, .. } | Section::Algorithm { initial: true, .. }
        );
        let local = Local { impure: initial, ..Local::default() };
        match section {
            Section::Equations { initial, equations, .. } => {
                for equation in equations {
                    let mut out = Vec::new();
                    let own = std::slice::from_ref(equation);
                    let at_start = self.only_at_start(equation, context).filter(|_| !initial);
                    let initial = *initial || at_start.is_some();
                    let mut all = at_start.unwrap_or(own).iter();
                    match all.try_for_each(|one| self.equation(one, context, &local, &mut out)) {
                        Ok(()) if initial => model.initial_equations.append(&mut out),
                        Ok(()) => model.equations.append(&mut out),
                        Err(error) => errors.push(error),
                    }
                    if model.equations.len() > MAX_EQUATIONS {
                        return Err(fault!(super::errors::TOO_LARGE, "too many equations")
                            .at(equation.span));
                    }
                }
            }
            Section::Algorithm { initial, statements, .. } => {
                let statements = self.statements(statements, context, &local)?;
                if *initial {
                    model.initial_algorithms.push(statements);
                } else {
                    model.algorithms.push(statements);
                }
            }
            Section::External(external) => {
                return Err(fault!(
                    NOT_SUPPORTED,
                    "only functions can have an external implementation"
                )
                .at(external.span));
            }
            Section::Elements { .. } | Section::Annotation(_) => {}
        }
        Ok(())
    }

    /// The equations of `if initial() then … end if`, which old libraries write for initial ones: with
    /// them the model would have more equations at its start than later.
    fn only_at_start<'e>(
        &self,
        equation: &'e Equation,
        context: ScopeId,
    ) -> Option<&'e [Equation]> {
        let EquationKind::If { branches, otherwise } = &equation.kind else { return None };
        let ([(condition, body)], []) = (branches.as_slice(), otherwise.as_slice()) else {
            return None;
        };
        let ExpressionKind::Call { function, .. } = &condition.kind else { return None };
        let is_plain = |one: &Equation| matches!(one.kind, EquationKind::Equal { .. });
        let library = self.classes.library;
        if function.as_ident()? != "initial" || !body.iter().all(is_plain) || library.is_strict() {
            return None;
        }
        let class = &self.classes.text(context).name;
        library.meet(class, LegacyConstruct::InitialBranch, equation.span);
        Some(body)
    }

    fn equation(
        &mut self,
        equation: &Equation,
        context: ScopeId,
        local: &Local,
        out: &mut Vec<Equation>,
    ) -> Result<(), Diagnostic> {
        let kind = match &equation.kind {
            EquationKind::Equal { left, right } => {
                if self.record_equation(left, right, equation, context, local, out)? {
                    return Ok(());
                }
                let left = self.resolve(left, context, local)?;
                let right = self.resolve(right, context, local)?;
                if self.types().equal_fields(&left, &right, equation.span, local, out) {
                    return Ok(());
                }
                self.types().check_sides(&left, &right, equation.span)?;
                EquationKind::Equal { left, right }
            }
            EquationKind::For { indices, body } => {
                return self.unroll(indices, body, context, local, out);
            }
            EquationKind::If { branches, otherwise } => {
                match self.if_equation(branches, otherwise, context, local, out)? {
                    Some(kind) => kind,
                    None => return Ok(()),
                }
            }
            EquationKind::When { branches } => {
                let mut resolved = Vec::with_capacity(branches.len());
                let acting = Local { impure: true, ..local.clone() };
                for (condition, body) in branches {
                    let condition = self.resolve(condition, context, local)?;
                    resolved.push((condition, self.equations(body, context, &acting)?));
                }
                EquationKind::When { branches: resolved }
            }
            // Connections were collected before (see `connections`).
            EquationKind::Connect { .. } => return Ok(()),
            EquationKind::Call(call) if is_graph_statement(call) => return Ok(()),
            EquationKind::Call(call) => {
                let local = Local { is_equation: true, ..local.clone() };
                EquationKind::Call(self.resolve(call, context, &local)?)
            }
        };
        out.push(Equation { kind, comment: Default::default(), span: equation.span });
        Ok(())
    }

    fn equations(
        &mut self,
        equations: &[Equation],
        context: ScopeId,
        local: &Local,
    ) -> Result<Vec<Equation>, Diagnostic> {
        let mut out = Vec::new();
        for equation in equations {
            self.equation(equation, context, local, &mut out)?;
        }
        Ok(out)
    }

    /// An equation between records is one for each of their components (MLS §8.3.1).
    fn record_equation(
        &mut self,
        left: &Expression,
        right: &Expression,
        equation: &Equation,
        context: ScopeId,
        local: &Local,
        out: &mut Vec<Equation>,
    ) -> Result<bool, Diagnostic> {
        let fields = match (self.record_fields(left, context)?, self.record_fields(right, context)?)
        {
            (Some(fields), _) | (None, Some(fields)) => fields,
            (None, None) => return Ok(false),
        };
        for name in fields {
            let part = |e: &Expression| {
                let kind = ExpressionKind::Field { base: Arc::new(e.clone()), name };
                Expression::new(kind, e.span)
            };
            let kind = EquationKind::Equal { left: part(left), right: part(right) };
            let one = Equation { kind, comment: Default::default(), span: equation.span };
            self.equation(&one, context, local, out)?;
        }
        Ok(true)
    }

    /// The components of the record that a reference names; `None` if it names anything else.
    fn record_fields(
        &mut self,
        e: &Expression,
        context: ScopeId,
    ) -> Result<Option<Vec<Ident>>, Diagnostic> {
        let ExpressionKind::Reference(reference) = &e.kind else { return Ok(None) };
        let mut node = self.classes.node_of(context);
        for ReferencePart { name, subscripts } in &reference.parts {
            let next = match self.member(node, *name)?.map(MemberState::seen) {
                Some(MemberState::Single(one)) => one,
                Some(MemberState::Array(_, nodes)) if !subscripts.is_empty() => match nodes.first()
                {
                    Some(first) => *first,
                    None => return Ok(None),
                },
                _ => return Ok(None),
            };
            node = next;
        }
        match self.classes.tree.scope_of(node) {
            Some(scope) if self.classes.is_record(scope) => {
                Ok(Some(self.classes.members(node)?.into_iter().map(|(name, _)| name).collect()))
            }
            _ => Ok(None),
        }
    }

    fn unroll(
        &mut self,
        indices: &[ForIndex],
        body: &[Equation],
        context: ScopeId,
        local: &Local,
        out: &mut Vec<Equation>,
    ) -> Result<(), Diagnostic> {
        let indices = self.loop_ranges(indices, body, context, local)?;
        self.each_iteration(&indices, context, local, &mut |instantiation, iteration| {
            out.extend(instantiation.equations(body, context, iteration)?);
            if out.len() > MAX_EQUATIONS {
                return Err(fault!(super::errors::TOO_LARGE, "the loop has too many equations")
                    .at(indices[0].name.span));
            }
            Ok(())
        })
    }

    /// The loop variables of a loop of equations with their ranges.
    pub(crate) fn loop_ranges(
        &mut self,
        indices: &[ForIndex],
        body: &[Equation],
        context: ScopeId,
        local: &Local,
    ) -> Result<Vec<ForIndex>, Diagnostic> {
        let visit = |uses: &mut dyn Visit| body.iter().for_each(|inner| uses.equation(inner));
        self.with_ranges(indices, context, local, &visit)
    }

    /// Branches of equal size whose conditions are not fixed at translation stay; otherwise the
    /// branch is chosen now (MLS §8.3.4). `None` if the chosen equations were added already.
    fn if_equation(
        &mut self,
        branches: &[(Expression, Vec<Equation>)],
        otherwise: &[Equation],
        context: ScopeId,
        local: &Local,
        out: &mut Vec<Equation>,
    ) -> Result<Option<EquationKind>, Diagnostic> {
        let chosen = self.chosen_branch(branches, context, local)?;
        match chosen {
            Some(Some(at)) => {
                out.extend(self.equations(&branches[at].1, context, local)?);
                return Ok(None);
            }
            Some(None) => {
                out.extend(self.equations(otherwise, context, local)?);
                return Ok(None);
            }
            None => {}
        }
        let mut resolved = Vec::with_capacity(branches.len());
        for (condition, body) in branches {
            let condition = self.resolve(condition, context, local)?;
            resolved.push((condition, self.equations(body, context, local)?));
        }
        let otherwise = self.equations(otherwise, context, local)?;
        Ok(Some(EquationKind::If { branches: resolved, otherwise }))
    }

    /// Which branch the conditions choose, if all of them up to that one are constants or
    /// parameters with values: `Some(None)` means `else`.
    pub(crate) fn chosen_branch(
        &mut self,
        branches: &[(Expression, Vec<Equation>)],
        context: ScopeId,
        local: &Local,
    ) -> Result<Option<Option<usize>>, Diagnostic> {
        for (at, (condition, _)) in branches.iter().enumerate() {
            let resolved = self.resolve(condition, context, local)?;
            if !self.is_fixed(&resolved) {
                return Ok(None);
            }
            match self.flat_value(&resolved)? {
                Value::Boolean(true) => return Ok(Some(Some(at))),
                Value::Boolean(false) => {}
                other => {
                    let found = other.type_name();
                    return Err(fault!(
                        TYPE_MISMATCH,
                        "a condition must be Boolean, but this is {found}"
                    )
                    .at(condition.span));
                }
            }
        }
        Ok(Some(None))
    }
}

impl Types<'_> {
    /// An equation between resolved records, such as results of functions, field by field; `false`
    /// if the sides are not records.
    fn equal_fields(
        &self,
        left: &Expression,
        right: &Expression,
        span: Span,
        local: &Local,
        out: &mut Vec<Equation>,
    ) -> bool {
        if matches!(left.kind, ExpressionKind::Tuple(_)) {
            return false;
        }
        let fields = [left, right].into_iter().find_map(|side| {
            let is_array = matches!(side.kind, ExpressionKind::Array(_));
            let may_be = !is_array && self.may_be_record(side, local);
            match may_be.then(|| self.value_type_of(side, local))? {
                Some(ValueType::Record(_, fields)) => Some(fields),
                _ => None,
            }
        });
        let Some(fields) = fields else { return false };
        for name in fields.keys() {
            let kind = EquationKind::Equal {
                left: self.functions.field(left, *name),
                right: self.functions.field(right, *name),
            };
            out.push(Equation { kind, comment: Default::default(), span });
        }
        true
    }
}

impl FunctionTable {
    /// A component of a resolved record.
    fn field(&self, record: &Expression, name: Ident) -> Expression {
        if let ExpressionKind::Call { function, arguments } = &record.kind
            && let Some(Some(constructor)) = self.table.get(&function.name())
            && constructor.body == FunctionBody::RecordConstructor
            && let Some(given) = arguments.named.iter().find(|given| given.name.node == name)
        {
            return given.value.clone();
        }
        let kind = ExpressionKind::Field { base: Arc::new(record.clone()), name };
        Expression::new(kind, record.span)
    }
}

/// `Connections.branch(…)` and the like, which are not equations.
pub(crate) fn is_graph_statement(call: &Expression) -> bool {
    match &call.kind {
        ExpressionKind::Call { function, .. } => {
            function.parts.len() == 2 && function.parts[0].name == "Connections"
        }
        _ => false,
    }
}
