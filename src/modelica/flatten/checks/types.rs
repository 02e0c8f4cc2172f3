//! Types of expressions and of the elements of arrays, as far as a class tells by itself: conditions and
//! operands of `and`, `or` and `not` are Boolean, those of arithmetic numbers, and both sides of a relation
//! have one type (MLS §3.4, §3.5, §4.9.5, §8.3.4, §8.3.7). Of a model, bindings and equations
//! are left to flattening, which knows all types and sizes.

use super::declared_types::{CheckedType, DeclaredTypes, kind_of};
use super::scope::{Component, Scope};
use crate::diag::Diagnostic;
use crate::fault;
use crate::flatten::errors::TYPE_MISMATCH;
use crate::flatten::library::ClassId;
use crate::functions::{self, Builtin};
use crate::inference;
use crate::name::Ident;
use crate::syntax::ast::{
    BinaryOperator, Binding, ClassSpecifier, ComponentReference, Equation, EquationKind,
    Expression, ExpressionKind, Section, Statement, StatementKind, UnaryOperator,
};
use crate::syntax::visit::{
    Visit, walk_equation, walk_expression, walk_modification, walk_statement,
};

/// Checks the conditions and relations that a class itself writes.
pub(crate) fn check(class: Scope<'_>, errors: &mut Vec<Diagnostic>) {
    check_as(class, false, errors);
}

/// Checks the values that a class itself gives to its variables as well.
pub(crate) fn check_with_values(class: Scope<'_>, errors: &mut Vec<Diagnostic>) {
    check_as(class, true, errors);
}

fn check_as(class: Scope<'_>, with_values: bool, errors: &mut Vec<Diagnostic>) {
    let types = DeclaredTypes { class, loops: Vec::new() };
    let mut walk = TypeCheck { types, with_values, errors };
    for component in class.components() {
        walk.binding(&component);
        component.declaration.modification.iter().for_each(|one| walk_modification(&mut walk, one));
        component.declaration.condition.iter().for_each(|one| walk.condition(one));
    }
    for section in class.sections() {
        match section {
            Section::Equations { equations, .. } => {
                equations.iter().for_each(|equation| walk.equation(equation));
            }
            Section::Algorithm { statements, .. } => {
                statements.iter().for_each(|statement| walk.statement(statement));
            }
            _ => {}
        }
    }
}

/// An expression and its type, where the class tells.
type Typed<'e> = (&'e Expression, Option<CheckedType>);

struct TypeCheck<'a, 'e> {
    types: DeclaredTypes<'a>,
    /// Whether bindings, equations and assignments are checked.
    with_values: bool,
    errors: &'e mut Vec<Diagnostic>,
}

impl TypeCheck<'_, '_> {
    fn mismatch(&mut self, expression: &Expression, expected: &str, found: CheckedType) {
        let message = format!("{expected}, but this is {}", self.name(found));
        self.errors.push(fault!(TYPE_MISMATCH, "{message}").at(expression.span));
    }

    fn name(&self, kind: CheckedType) -> String {
        match kind {
            CheckedType::Number => "a number".to_owned(),
            CheckedType::Boolean => "a Boolean".to_owned(),
            CheckedType::String => "a String".to_owned(),
            CheckedType::Enumeration(class) => {
                format!("of the enumeration `{}`", self.types.class.of(class).name())
            }
        }
    }

    /// Enumerations have only values of their own type, and no other type has them (MLS §4.9.5).
    fn binding(&mut self, component: &Component<'_>) {
        let modification = component.declaration.modification.as_ref();
        let Some(Binding::Expression(value)) = modification.and_then(|one| one.binding.as_ref())
        else {
            return;
        };
        let (Some(declared), Some(found)) = (kind_of(component), self.types.type_of(value)) else {
            return;
        };
        let has_enumeration =
            [declared, found].iter().any(|kind| matches!(kind, CheckedType::Enumeration(_)));
        if (has_enumeration || self.with_values) && !self.same(declared, found) {
            let name = component.name();
            self.mismatch(value, &format!("`{name}` is {}", self.name(declared)), found);
        }
    }

    /// A value that a statement assigns. Old libraries compute with enumerations.
    fn assigned(&mut self, target: &ComponentReference, value: &Expression) {
        let kinds = (self.types.kind_of_reference(target), self.types.type_of(value));
        if let (Some(declared), Some(found)) = kinds
            && self.with_values
            && ![declared, found].iter().any(|kind| matches!(kind, CheckedType::Enumeration(_)))
            && declared != found
        {
            let message = format!("`{}` is {}", target.name(), self.name(declared));
            self.mismatch(value, &message, found);
        }
    }

    /// The sides of an equation.
    fn equated(&mut self, left: &Expression, right: &Expression) {
        if let (Some(a), Some(b)) = (self.types.type_of(left), self.types.type_of(right))
            && self.with_values
            && !self.same(a, b)
        {
            let message = format!("the other side of the equation is {}", self.name(a));
            self.mismatch(right, &message, b);
        }
    }

    /// Arithmetic is defined for numbers (MLS §10.6), the sum of strings aside.
    fn operands(&mut self, operator: BinaryOperator, operands: [Typed<'_>; 2]) {
        if inference::is_arithmetic(operator) {
            operands.into_iter().for_each(|operand| self.term(operand));
        }
    }

    fn numeric(&mut self, (operand, found): Typed<'_>, needed: &str) {
        if let Some(kind @ (CheckedType::Boolean | CheckedType::Enumeration(_))) = found {
            self.mismatch(operand, needed, kind);
        }
    }

    fn truth(&mut self, (operand, found): Typed<'_>, operator: &str) {
        if let Some(kind) = found.filter(|kind| *kind != CheckedType::Boolean) {
            self.mismatch(operand, &format!("`{operator}` needs Booleans"), kind);
        }
    }

    /// Old libraries compute with enumerations, whose ordinals other programs take.
    fn term(&mut self, operand: Typed<'_>) {
        let before = self.errors.len();
        self.numeric(operand, "arithmetic needs numbers");
        if let Some(CheckedType::Enumeration(_)) = operand.1 {
            for one in self.errors.split_off(before) {
                self.errors.push(one.warning());
            }
        }
    }

    /// The operations of a chain, each with the types of its operands.
    fn operations(&mut self, chain: &Expression) {
        let types = inference::chain_types(&mut &self.types, chain);
        for (one, left) in chain.chain().1.into_iter().zip(types) {
            let operands = [(one.left, left), (one.right, self.types.type_of(one.right))];
            match one.operator {
                BinaryOperator::And => operands.into_iter().for_each(|one| self.truth(one, "and")),
                BinaryOperator::Or => operands.into_iter().for_each(|one| self.truth(one, "or")),
                operator if inference::is_relation(operator) => self.relation(operands),
                operator => self.operands(operator, operands),
            }
        }
    }

    /// The functions of numbers (MLS §3.7.1, §3.7.3).
    fn numeric_call(&mut self, function: &ComponentReference, arguments: &[Expression]) {
        let [name] = function.parts.as_slice() else { return };
        let is_declared = self.types.class.class_named(&name.name.into()).is_some();
        let is_numeric = functions::find(name.name.as_str()).is_some_and(Builtin::is_numeric);
        if !is_declared && is_numeric {
            for argument in arguments {
                let found = self.types.type_of(argument);
                self.numeric((argument, found), &format!("`{}` needs a number", name.name));
            }
        }
    }

    fn condition(&mut self, condition: &Expression) {
        if let Some(kind) =
            self.types.type_of(condition).filter(|kind| *kind != CheckedType::Boolean)
        {
            self.mismatch(condition, "a condition must be Boolean", kind);
        }
        self.expression(condition);
    }

    fn assertion(&mut self, call: &Expression) {
        let ExpressionKind::Call { function, arguments } = &call.kind else { return };
        let is_assert = !function.global
            && function.parts.len() == 1
            && function.parts[0].name.as_str() == "assert";
        if let (true, Some(condition)) = (is_assert, arguments.positional.first())
            && let Some(kind) =
                self.types.type_of(condition).filter(|kind| *kind != CheckedType::Boolean)
        {
            self.mismatch(condition, "the condition of `assert` must be Boolean", kind);
        }
    }

    fn relation(&mut self, [(_, left), (right, found)]: [Typed<'_>; 2]) {
        if let (Some(a), Some(b)) = (left, found)
            && !self.same(a, b)
        {
            let message = format!("the other side of the relation is {}", self.name(a));
            self.mismatch(right, &message, b);
        }
    }

    /// Whether two types are one: enumerations are distinguished by their literals and the order of
    /// these, not by their names (MLS §6.7).
    fn same(&self, a: CheckedType, b: CheckedType) -> bool {
        match (a, b) {
            (CheckedType::Enumeration(a), CheckedType::Enumeration(b)) if a != b => {
                let (a, b) = (self.literals(a), self.literals(b));
                a.is_some() && a == b
            }
            _ => a == b,
        }
    }

    fn literals(&self, enumeration: ClassId) -> Option<Vec<Ident>> {
        match &self.types.class.of(enumeration).definition().specifier {
            ClassSpecifier::Enumeration(known) => {
                Some(known.literals.as_ref()?.iter().map(|one| one.name.node).collect())
            }
            _ => None,
        }
    }
}

impl Visit for TypeCheck<'_, '_> {
    fn expression(&mut self, expression: &Expression) {
        match &expression.kind {
            ExpressionKind::Binary { .. } => self.operations(expression),
            ExpressionKind::Unary { operator: UnaryOperator::Not, operand } => {
                let found = self.types.type_of(operand);
                self.truth((operand, found), "not");
            }
            ExpressionKind::If { branches, .. } => {
                for (condition, _) in branches {
                    if let Some(kind) =
                        self.types.type_of(condition).filter(|kind| *kind != CheckedType::Boolean)
                    {
                        self.mismatch(condition, "a condition must be Boolean", kind);
                    }
                }
            }
            ExpressionKind::ArrayIteration { indices, .. } => {
                self.types.loops.extend(indices.iter().map(|index| index.name.node));
            }
            ExpressionKind::Call { function, arguments } => {
                self.numeric_call(function, &arguments.positional);
                self.types.loops.extend(arguments.iterators.iter().map(|index| index.name.node));
            }
            _ => {}
        }
        walk_expression(self, expression);
    }

    fn equation(&mut self, equation: &Equation) {
        match &equation.kind {
            EquationKind::If { branches, .. } => {
                branches.iter().for_each(|(condition, _)| self.condition(condition));
            }
            EquationKind::For { indices, .. } => {
                self.types.loops.extend(indices.iter().map(|index| index.name.node));
            }
            EquationKind::Equal { left, right } => self.equated(left, right),
            EquationKind::Call(call) => self.assertion(call),
            _ => {}
        }
        walk_equation(self, equation);
    }

    fn statement(&mut self, statement: &Statement) {
        match &statement.kind {
            StatementKind::If { branches, .. } => {
                branches.iter().for_each(|(condition, _)| self.condition(condition));
            }
            StatementKind::While { condition, .. } => self.condition(condition),
            StatementKind::Assign { target, value } => self.assigned(target, value),
            StatementKind::For { indices, .. } => {
                self.types.loops.extend(indices.iter().map(|index| index.name.node));
            }
            StatementKind::Call(call) => self.assertion(call),
            _ => {}
        }
        walk_statement(self, statement);
    }
}
