//! Types of expressions and of the elements of arrays, as far as a class tells by itself: conditions and
//! operands of `and`, `or` and `not` are Boolean, those of arithmetic numbers, and both sides of a relation
//! have one type (MLS §3.4, §3.5, §4.9.5, §8.3.4, §8.3.7), and what is assigned, and each argument, has
//! the type of the variable: only an Integer is converted, to a Real (§6.7, §10.6.13, §12.4.1). Of a
//! model, bindings and equations are left to flattening, which knows all types and sizes.

use super::arguments;
use super::compatibility::lack;
use super::declared_types::{CheckedType, DeclaredTypes, kind_of};
use super::inputs::outputs;
use super::scope::{Component, Scope};
use crate::diag::Diagnostic;
use crate::fault;
use crate::flatten::errors::TYPE_MISMATCH;
use crate::flatten::library::ClassId;
use crate::flatten::types::has_only_literals;
use crate::functions::{self, Builtin, TypeRule};
use crate::inference;
use crate::name::Ident;
use crate::syntax::ast::{
    Argument, Arguments, BinaryOperator, Binding, ClassSpecifier, ComponentReference, Equation,
    EquationKind, Expression, ExpressionKind, Restriction, Section, Statement, StatementKind,
    Subscript, UnaryOperator,
};
use crate::syntax::visit::{
    Visit, walk_equation, walk_expression, walk_modification, walk_reference, walk_statement,
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
    let mut walk = TypeCheck { types, with_values, in_when: false, errors };
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
    /// Whether bindings and equations of a model are checked.
    with_values: bool,
    /// Whether a when-equation is around.
    in_when: bool,
    errors: &'e mut Vec<Diagnostic>,
}

impl TypeCheck<'_, '_> {
    fn mismatch(&mut self, expression: &Expression, expected: &str, found: CheckedType) {
        let message = format!("{expected}, but this is {}", self.name(found));
        self.errors.push(fault!(TYPE_MISMATCH, "{message}").at(expression.span));
    }

    /// Refuses a value of another type than what it is given to, `what`, is declared of.
    fn given(&mut self, what: &str, declared: CheckedType, value: &Expression) {
        let Some(found) = self.types.type_of(value) else { return };
        if self.accepts(declared, found) {
            return;
        }
        let (expected, found_name) = (self.name(declared), self.name(found));
        self.errors.push(
            fault!(TYPE_MISMATCH, "{what} is {expected}, but this is {found_name}")
                .help_if(declared.remedy(found).map(str::to_owned))
                .at(value.span),
        );
    }

    /// Whether a variable of one type can have a value of another one (MLS §6.7, §10.6.13).
    fn accepts(&self, declared: CheckedType, found: CheckedType) -> bool {
        match (declared, found) {
            (CheckedType::Integer, CheckedType::Real) => false,
            (CheckedType::Record(expected), CheckedType::Record(given)) => {
                let class = self.types.class;
                lack(class.of(given), class.of(expected)).is_none()
            }
            _ => self.same(declared, found),
        }
    }

    fn name(&self, kind: CheckedType) -> String {
        kind.described(self.types.class)
    }

    /// Enumerations have only values of their own type, and no other type has them (MLS §4.9.5).
    fn binding(&mut self, component: &Component<'_>) {
        let Some(modification) = component.declaration.modification.as_ref() else { return };
        let Some(declared) = kind_of(component) else { return };
        self.attributes(declared, &modification.arguments);
        let Some(Binding::Expression(value)) = &modification.binding else { return };
        let found = self.types.type_of(value);
        let has_enumeration = [Some(declared), found]
            .iter()
            .any(|kind| matches!(kind, Some(CheckedType::Enumeration(_))));
        let class = self.types.class;
        let is_of_function = matches!(class.restriction(), Restriction::Function { .. });
        if has_enumeration || self.with_values || is_of_function {
            self.given(&format!("`{}`", component.name()), declared, value);
        }
    }

    /// The attributes of a variable (MLS §4.9).
    fn attributes(&mut self, of: CheckedType, arguments: &[Argument]) {
        if matches!(of, CheckedType::Record(_)) {
            return;
        }
        for argument in arguments {
            let Argument::Element(element) = argument else { continue };
            let Some(Binding::Expression(value)) =
                element.modification.as_ref().and_then(|one| one.binding.as_ref())
            else {
                continue;
            };
            let name = element.name.node.to_string();
            let declared = match name.as_str() {
                "start" | "min" | "max" => of,
                "fixed" => CheckedType::Boolean,
                "quantity" | "unit" | "displayUnit" => CheckedType::String,
                _ => continue,
            };
            self.given(&format!("`{name}`"), declared, value);
        }
    }

    /// A value that a statement assigns. Old libraries assign enumerations to numbers.
    fn assigned(&mut self, target: &ComponentReference, value: &Expression) {
        let Some(declared) = self.types.kind_of_reference(target) else { return };
        let is_ordinal = declared.is_number()
            && matches!(self.types.type_of(value), Some(CheckedType::Enumeration(_)));
        if !is_ordinal {
            self.given(&format!("`{}`", target.name()), declared, value);
        }
    }

    /// What the outputs of a function are assigned to.
    fn outputs_assigned(&mut self, targets: &[Option<ComponentReference>], value: &Expression) {
        let ExpressionKind::Call { function, .. } = &value.kind else { return };
        let called = self.types.class.certain_class(&function.name());
        let Some(outputs) = called.and_then(outputs) else { return };
        for (target, output) in targets.iter().zip(&outputs) {
            let Some(target) = target else { continue };
            let kinds = (self.types.kind_of_reference(target), kind_of(output));
            if let (Some(declared), Some(found)) = kinds
                && !self.accepts(declared, found)
            {
                let (name, declared) = (target.name(), self.name(declared));
                let (output, found) = (output.name(), self.name(found));
                self.errors.push(
                    fault!(
                        TYPE_MISMATCH,
                        "`{name}` is {declared}, but the output `{output}` is {found}"
                    )
                    .at(target.span),
                );
            }
        }
    }

    /// The sides of an equation. That of a when-clause gives its left side a value.
    fn equated(&mut self, left: &Expression, right: &Expression) {
        let (Some(a), Some(b)) = (self.types.type_of(left), self.types.type_of(right)) else {
            return;
        };
        if self.in_when
            && let ExpressionKind::Reference(target) = &left.kind
            && (a, b) == (CheckedType::Integer, CheckedType::Real)
        {
            self.given(&format!("`{}`", target.name()), a, right);
        }
        let are_records = matches!((a, b), (CheckedType::Record(_), CheckedType::Record(_)));
        let fits = match are_records {
            true => self.accepts(a, b) && self.accepts(b, a),
            false => self.same(a, b),
        };
        // In the flat model literals of enumerations are numbers.
        let is_number = matches!(a, CheckedType::Enumeration(_)) && has_only_literals(right);
        if (self.with_values || are_records || is_number) && !fits {
            let message = format!("the other side of the equation is {}", self.name(a));
            self.mismatch(right, &message, b);
        }
    }

    /// Values of which an expression has one have one type (MLS §3.6.5, §10.3.4, §10.4): the first
    /// that is known is compared with the others.
    fn alternatives<'e>(&mut self, what: &str, all: impl IntoIterator<Item = &'e Expression>) {
        let mut first = None;
        for one in all {
            let Some(found) = self.types.type_of(one) else { continue };
            let first = *first.get_or_insert(found);
            if !self.same(first, found) {
                self.mismatch(one, &format!("{what} is {}", self.name(first)), found);
                return;
            }
        }
    }

    /// A subscript is an Integer, a Boolean or a literal of an enumeration (MLS §10.5).
    fn subscripts(&mut self, subscripts: &[Subscript]) {
        for subscript in subscripts {
            let Subscript::Index(index) = subscript else { continue };
            let found = self.types.type_of(index);
            if let Some(
                found @ (CheckedType::Real | CheckedType::String | CheckedType::Record(_)),
            ) = found
            {
                self.errors.push(
                    fault!(
                        TYPE_MISMATCH,
                        "a subscript is an Integer, but this is {}",
                        self.name(found)
                    )
                    .help_if(CheckedType::Integer.remedy(found).map(str::to_owned))
                    .at(index.span),
                );
            }
        }
    }

    /// The arguments of a call: each input once, with its type.
    fn call(&mut self, function: &ComponentReference, arguments: &Arguments) {
        let class = self.types.class;
        self.errors.extend(arguments::given_twice(class, function, arguments));
        for one in arguments::expected(class, function, arguments) {
            let what = format!("the input `{}` of `{}`", one.input, function.name());
            self.given(&what, one.declared, one.argument);
        }
    }

    /// Arithmetic is defined for numbers (MLS §10.6), and `+` for two Strings.
    fn operands(&mut self, operator: BinaryOperator, operands: [Typed<'_>; 2]) {
        if !inference::is_arithmetic(operator) {
            return;
        }
        let is_string = |(_, found): &Typed<'_>| *found == Some(CheckedType::String);
        let is_sum = matches!(operator, BinaryOperator::Add | BinaryOperator::ElementwiseAdd);
        match operands.iter().find(|one| is_string(one)) {
            None => operands.into_iter().for_each(|operand| self.term(operand)),
            Some(_) if is_sum => self.joined(operands.into_iter().find(|one| !is_string(one))),
            // What is not known may be a record with operators.
            Some((string, _)) if operands.iter().all(|(_, found)| found.is_some()) => {
                self.mismatch(string, "arithmetic needs numbers", CheckedType::String);
            }
            Some(_) => {}
        }
    }

    /// What a String is joined with.
    fn joined(&mut self, other: Option<Typed<'_>>) {
        let Some((other, Some(found))) = other else { return };
        self.errors.push(
            fault!(TYPE_MISMATCH, "`+` joins Strings, but this is {}", self.name(found))
                .help_if(CheckedType::String.remedy(found).map(str::to_owned))
                .at(other.span),
        );
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
        let is_joined = functions::find(name.name.as_str())
            .is_some_and(|builtin| builtin.value_type == TypeRule::Joined);
        if !is_declared && is_joined && !is_numeric {
            self.alternatives(&format!("the first argument of `{}`", name.name), arguments);
        }
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
        let is_record = |kind: CheckedType| matches!(kind, CheckedType::Record(_));
        if let (Some(a), Some(b)) = (left, found)
            && !is_record(a)
            && !is_record(b)
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
            (CheckedType::Record(a), CheckedType::Record(b)) => {
                let class = self.types.class;
                lack(class.of(a), class.of(b)).is_none()
            }
            _ => a == b || a.is_number() && b.is_number(),
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
            ExpressionKind::If { branches, otherwise } => {
                let values = branches.iter().map(|(_, value)| value).chain([&**otherwise]);
                self.alternatives("the first branch", values);
                for (condition, _) in branches {
                    if let Some(kind) =
                        self.types.type_of(condition).filter(|kind| *kind != CheckedType::Boolean)
                    {
                        self.mismatch(condition, "a condition must be Boolean", kind);
                    }
                }
            }
            ExpressionKind::Array(elements) => self.alternatives("the first element", elements),
            ExpressionKind::Subscripted { subscripts, .. } => self.subscripts(subscripts),
            ExpressionKind::ArrayIteration { indices, .. } => {
                self.types.loops.extend(indices.iter().map(|index| index.name.node));
            }
            ExpressionKind::Call { function, arguments } => {
                self.types.loops.extend(arguments.iterators.iter().map(|index| index.name.node));
                self.numeric_call(function, &arguments.positional);
                self.call(function, arguments);
            }
            _ => {}
        }
        walk_expression(self, expression);
    }

    fn reference(&mut self, reference: &ComponentReference) {
        reference.parts.iter().for_each(|part| self.subscripts(&part.subscripts));
        walk_reference(self, reference);
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
        let is_when = matches!(equation.kind, EquationKind::When { .. });
        let outside = self.in_when;
        self.in_when |= is_when;
        walk_equation(self, equation);
        self.in_when = outside;
    }

    fn statement(&mut self, statement: &Statement) {
        match &statement.kind {
            StatementKind::If { branches, .. } => {
                branches.iter().for_each(|(condition, _)| self.condition(condition));
            }
            StatementKind::While { condition, .. } => self.condition(condition),
            StatementKind::Assign { target, value } => self.assigned(target, value),
            StatementKind::MultiAssign { targets, value } => {
                self.outputs_assigned(targets, value);
            }
            StatementKind::For { indices, .. } => {
                self.types.loops.extend(indices.iter().map(|index| index.name.node));
            }
            StatementKind::Call(call) => self.assertion(call),
            _ => {}
        }
        walk_statement(self, statement);
    }
}
