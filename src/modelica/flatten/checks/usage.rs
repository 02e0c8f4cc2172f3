//! What expressions may say in which class: `time`, conditional components and the operators that
//! ask for arguments of a kind (MLS §3.6.7, §3.7, §4.4.5, §12.2, §15.2).

use super::declared_types::is_number;
use super::scope::{Component, Scope};
use super::variability::is_fixed;
use crate::diag::Diagnostic;
use crate::fault;
use crate::flatten::declared::classes::Type;
use crate::flatten::errors::{CONDITIONAL_COMPONENT, ILLEGAL_ACCESS, ILLEGAL_ARGUMENT, MISPLACED};
use crate::flatten::lookup::types::Predefined;
use crate::functions::{self, Builtin};
use crate::name::Name;
use crate::source::Span;
use crate::syntax::ast::{
    ClassSpecifier, ComponentReference, ConnectionPrefix, Equation, EquationKind, Expression,
    ExpressionKind, Modification, Restriction, Section, Statement, VariabilityPrefix,
};
use crate::syntax::visit::{
    Visit, walk_equation, walk_expression, walk_modification, walk_reference, walk_statement,
};

/// Checks the expressions that a class itself writes.
pub(crate) fn check(class: Scope<'_>, errors: &mut Vec<Diagnostic>) {
    let is_function = matches!(class.restriction(), Restriction::Function { .. });
    let mut walk = UsageCheck { class, is_function, conditional: false, errors };
    for component in class.components() {
        walk.conditional = component.declaration.condition.is_some();
        component.declaration.modification.iter().for_each(|one| walk.modification(one));
        walk.conditional = false;
        component.declaration.condition.iter().for_each(|one| walk.expression(one));
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

struct UsageCheck<'a, 'e> {
    class: Scope<'a>,
    is_function: bool,
    /// Whether a conditional component may be named: in modifiers of another one.
    conditional: bool,
    errors: &'e mut Vec<Diagnostic>,
}

impl<'a> UsageCheck<'a, '_> {
    fn modification(&mut self, modification: &Modification) {
        walk_modification(self, modification);
    }

    fn call(&mut self, name: &str, arguments: &[Expression], span: Span) {
        let in_time = functions::find(name).is_some_and(Builtin::is_forbidden_in_functions);
        if self.is_function && in_time && !self.is_declared(name) {
            self.errors.push(
                fault!(MISPLACED, "`{name}` has no meaning in a function";
                    help: "compute it in the model and pass it as an argument")
                .at(span),
            );
            return;
        }
        let wrong = match (name, arguments) {
            ("der", [argument]) => self.derived(argument),
            ("reinit", [state, _]) => self.reinitialized(state),
            ("sample", [start, interval]) => self.sampled(start, interval),
            ("delay", [_, time]) => self.fixed("the delay time of `delay`", time),
            ("delay", [_, time, most]) => {
                self.fixed("the longest delay of `delay`", most).or_else(|| longer(time, most))
            }
            ("inStream" | "actualStream", [argument]) => self.stream(name, argument),
            ("cardinality", [argument]) => self.connector(argument),
            _ => None,
        };
        if !self.is_declared(name) {
            self.errors.extend(wrong);
        }
    }

    /// Whether the class means something of its own by the name of an operator.
    fn is_declared(&self, name: &str) -> bool {
        let name = crate::name::Ident::new(name);
        self.class.class_named(&name.into()).is_some()
    }

    /// The derivative exists of continuous-time Real variables.
    fn derived(&self, argument: &Expression) -> Option<Diagnostic> {
        let component = self.component(argument)?;
        let name = component.name();
        let base = component.predefined()?;
        let reason = if base != Predefined::Real {
            "is not Real"
        } else if component.clause.type_prefixes.variability == Some(VariabilityPrefix::Discrete) {
            "is discrete"
        } else {
            return None;
        };
        Some(
            fault!(ILLEGAL_ARGUMENT, "`{name}` {reason}, so it has no derivative";
                help: "differentiate a continuous-time Real variable")
            .at(argument.span),
        )
    }

    fn reinitialized(&self, state: &Expression) -> Option<Diagnostic> {
        let component = self.component(state)?;
        component.is_fixed().then(|| {
            fault!(ILLEGAL_ARGUMENT, "`{}` cannot be reinitialized: it is not a \
                                      variable", component.name();
                help: "use a state")
            .at(state.span)
        })
    }

    fn sampled(&self, start: &Expression, interval: &Expression) -> Option<Diagnostic> {
        // `sample(u, clock)` is another operator (MLS §16.5.1).
        if !is_number(self.class, interval) {
            return None;
        }
        self.fixed("the start of `sample`", start)
            .or_else(|| self.fixed("the interval of `sample`", interval))
    }

    fn fixed(&self, what: &str, argument: &Expression) -> Option<Diagnostic> {
        (!is_fixed(self.class, &[], argument)).then(|| {
            fault!(ILLEGAL_ARGUMENT, "{what} changes during the simulation";
                help: "use an expression of parameters")
            .at(argument.span)
        })
    }

    fn stream(&self, operator: &str, argument: &Expression) -> Option<Diagnostic> {
        let ExpressionKind::Reference(reference) = &argument.kind else { return None };
        let stream = Some(ConnectionPrefix::Stream);
        let path = self.class.path(reference)?;
        let is_stream = path.iter().any(|part| part.clause.type_prefixes.connection == stream);
        (!is_stream).then(|| {
            fault!(ILLEGAL_ARGUMENT, "the argument of `{operator}` is not a stream variable")
                .at(argument.span)
        })
    }

    fn connector(&self, argument: &Expression) -> Option<Diagnostic> {
        let component = self.component(argument)?;
        let is_variable = match component.meaning()? {
            Type::Predefined(_) => true,
            Type::Class(class) => component.owner.of(class).restriction() == Restriction::Type,
        };
        is_variable.then(|| {
            fault!(ILLEGAL_ARGUMENT, "the argument of `cardinality` is not a connector")
                .at(argument.span)
        })
    }

    /// The component that an expression names, as it is declared.
    fn component(&self, expression: &Expression) -> Option<Component<'a>> {
        let ExpressionKind::Reference(reference) = &expression.kind else { return None };
        self.class.component_at(reference)
    }
}

impl Visit for UsageCheck<'_, '_> {
    fn expression(&mut self, expression: &Expression) {
        if let ExpressionKind::Call { function, arguments } = &expression.kind
            && let [name] = function.parts.as_slice()
            && !function.global
        {
            self.call(name.name.as_str(), &arguments.positional, expression.span);
            if name.name.as_str() == "cardinality" {
                return;
            }
        }
        if let ExpressionKind::Call { function, .. } = &expression.kind {
            self.errors.extend(called(self.class, function));
        }
        walk_expression(self, expression);
    }

    fn reference(&mut self, reference: &ComponentReference) {
        walk_reference(self, reference);
        let name = reference.parts[0].name;
        if reference.global {
            return;
        }
        let Some(component) = self.class.component(name) else {
            if name.as_str() == "time" && reference.parts.len() == 1 {
                self.errors.extend(time(self.class, reference.span));
            }
            return;
        };
        // Libraries use inherited ones where they know that the condition holds.
        let is_own = component.owner.class == self.class.class;
        if is_own && component.declaration.condition.is_some() && !self.conditional {
            self.errors.push(
                fault!(CONDITIONAL_COMPONENT, "`{name}` is a conditional component: it can only \
                    be connected or modified";
                    help: "declare an unconditional variable and connect it to `{name}`")
                .at(reference.span)
                // Where its condition is false it does not exist, which is an error there.
                .warning(),
            );
        }
    }

    fn equation(&mut self, equation: &Equation) {
        if let EquationKind::Connect { left, right } = &equation.kind {
            walk_reference(self, left);
            walk_reference(self, right);
        } else {
            walk_equation(self, equation);
        }
    }

    fn statement(&mut self, statement: &Statement) {
        walk_statement(self, statement);
    }
}

/// What is called is a function, and an operator is not called through a component (MLS §5.3.2,
/// §12.4).
fn called(class: Scope<'_>, function: &ComponentReference) -> Option<Diagnostic> {
    let parts: Vec<_> = function.parts.iter().map(|part| part.name).collect();
    if let [first, inner @ ..] = parts.as_slice()
        && let Some(component) = class.component(*first)
    {
        let name = Name::new(inner.iter().copied());
        let is_operator = inner.iter().any(|part| part.as_str().starts_with('\''));
        let found = component.class().filter(|_| is_operator)?.class_named(&name)?;
        return matches!(found.restriction(), Restriction::Function { .. }).then(|| {
            fault!(ILLEGAL_ACCESS, "the operator `{name}` is called through the component `{first}`";
                help: "write the operator between its operands")
            .at(function.span)
        });
    }
    let name = Name { global: function.global, parts };
    let found = class.class_named(&name)?;
    let is_short = matches!(found.definition().specifier, ClassSpecifier::Short(_));
    (is_short && found.restriction() == Restriction::Class).then(|| {
        fault!(ILLEGAL_ARGUMENT, "`{name}` is a class, not a function";
            help: "declare it `function {name} = …`")
        .at(function.span)
    })
}

/// `time` is a variable of models and blocks (MLS §3.6.7).
fn time(class: Scope<'_>, span: Span) -> Option<Diagnostic> {
    let has_none = matches!(
        class.restriction(),
        Restriction::Record
            | Restriction::OperatorRecord
            | Restriction::Connector
            | Restriction::ExpandableConnector
            | Restriction::Package
            | Restriction::Function { .. }
    );
    has_none.then(|| {
        let what = class.restriction().keyword();
        fault!(MISPLACED, "`time` has no meaning in a {what}";
            help: "use it in a model or a block")
        .at(span)
    })
}

/// A delay that is longer than the longest one, both literal.
fn longer(time: &Expression, most: &Expression) -> Option<Diagnostic> {
    let (a, b) = (number(time)?, number(most)?);
    (a > b || a < 0.0).then(|| {
        fault!(ILLEGAL_ARGUMENT, "the delay {a} is not between 0 and the longest delay {b}";
            help: "swap or correct the arguments: `delay(expression, time, longest)`")
        .at(time.span)
    })
}

fn number(expression: &Expression) -> Option<f64> {
    match expression.kind {
        ExpressionKind::Real(value) => Some(value),
        ExpressionKind::Integer(value) => Some(value as f64),
        _ => None,
    }
}
