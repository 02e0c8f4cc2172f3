//! Where equations and statements are allowed (MLS §4.5, §8.3, §9.1, §9.4.1, §11.2, §12.2).

use super::scope::{Component, Scope};
use super::variability::is_fixed;
use crate::diag::Diagnostic;
use crate::fault;
use crate::flatten::declared::classes::Type;
use crate::flatten::errors::MISPLACED;
use crate::flatten::lookup::types::Predefined;
use crate::name::Ident;
use crate::source::Span;
use crate::syntax::ast::{
    ComponentReference, Equation, EquationKind, Expression, ExpressionKind, ForIndex, Restriction,
    Section, Statement, StatementKind, Subscript, VariabilityPrefix,
};

/// What stands around an equation or a statement.
#[derive(Clone, Default)]
struct Around {
    /// An initial equation or an initial algorithm.
    initial: bool,
    /// A when-clause.
    when: bool,
    /// A clocked when-clause, where equations of any form are allowed (MLS §16.6).
    clocked: bool,
    /// An if- or a for-equation whose choice or range can change during simulation.
    varying: bool,
    /// A for- or while-loop of an algorithm.
    looped: bool,
    /// A while-loop of an algorithm.
    repeated: bool,
    /// An algorithm.
    algorithm: bool,
    /// The algorithm of a function.
    function: bool,
}

/// MLS §11.2.7.1.
const NESTED_WHEN: (&str, &str) = (
    "a when-statement is not allowed inside another statement",
    "move it to the top of the algorithm",
);

/// Checks the own sections of a class.
pub(crate) fn check(class: Scope<'_>, errors: &mut Vec<Diagnostic>) {
    let is_function = matches!(class.restriction(), Restriction::Function { .. });
    let mut walk = BehaviourCheck { class, loops: Vec::new(), errors };
    if !is_function {
        class.components().for_each(|component| walk.discrete_with_value(&component));
    }
    for section in class.sections() {
        match section {
            Section::Equations { initial, equations, span } => {
                if is_function {
                    walk.wrong(
                        *span,
                        "equations are not allowed in a function",
                        "write an algorithm",
                    );
                }
                walk.equations(equations, &Around { initial: *initial, ..Around::default() });
            }
            Section::Algorithm { initial, statements, span } => {
                if is_function && *initial {
                    let message = "an initial algorithm is not allowed in a function";
                    walk.wrong(*span, message, "write an algorithm");
                }
                let around = Around {
                    initial: *initial,
                    algorithm: true,
                    function: is_function,
                    ..Around::default()
                };
                walk.statements(statements, &around);
            }
            _ => {}
        }
    }
}

struct BehaviourCheck<'a, 'e> {
    class: Scope<'a>,
    /// The loop variables around.
    loops: Vec<Ident>,
    errors: &'e mut Vec<Diagnostic>,
}

impl BehaviourCheck<'_, '_> {
    fn wrong(&mut self, span: Span, message: &str, help: &str) {
        self.errors.push(fault!(MISPLACED, "{message}"; help: "{help}").at(span));
    }

    fn is_fixed(&self, expression: &Expression) -> bool {
        is_fixed(self.class, &self.loops, expression)
    }

    fn equations(&mut self, equations: &[Equation], around: &Around) {
        equations.iter().for_each(|equation| self.equation(equation, around));
    }

    fn equation(&mut self, equation: &Equation, around: &Around) {
        match &equation.kind {
            EquationKind::Equal { left, .. } => self.equality(left, equation.span, around),
            EquationKind::If { branches, otherwise } => {
                let varies = branches.iter().any(|(condition, _)| !self.is_fixed(condition));
                let inside = Around { varying: around.varying || varies, ..around.clone() };
                branches.iter().for_each(|(_, body)| self.equations(body, &inside));
                self.equations(otherwise, &inside);
            }
            EquationKind::For { indices, body } => {
                let varies = ranges(indices).any(|range| !self.is_fixed(range));
                let inside = Around { varying: around.varying || varies, ..around.clone() };
                let outer = self.loops.len();
                self.loops.extend(indices.iter().map(|index| index.name.node));
                self.equations(body, &inside);
                self.loops.truncate(outer);
            }
            EquationKind::When { branches } => {
                self.when(equation.span, around);
                for (condition, body) in branches {
                    let clocked = super::clocks::is_clock(self.class, condition);
                    let inside = Around { when: true, clocked, ..around.clone() };
                    self.equations(body, &inside);
                }
            }
            EquationKind::Connect { left, right } => {
                self.connection("connect", equation.span, around);
                self.subscripts(left);
                self.subscripts(right);
            }
            EquationKind::Call(call) => self.call(call, around),
        }
    }

    /// An equation of a when-clause says what it determines on its left side (MLS §8.3.5.1).
    fn equality(&mut self, left: &Expression, span: Span, around: &Around) {
        let names_result =
            matches!(left.kind, ExpressionKind::Reference(_) | ExpressionKind::Tuple(_));
        if around.when && !around.clocked && !names_result {
            let message = "an equation of a when-clause must have a variable on its left side";
            self.wrong(span, message, "solve the equation for the variable that it determines");
        }
        if let (true, ExpressionKind::Reference(target)) = (around.when, &left.kind) {
            self.discrete_of_component(target);
        }
    }

    /// A discrete variable of a model or block is assigned in the when-clauses of that class
    /// (MLS §4.5).
    fn discrete_of_component(&mut self, target: &ComponentReference) {
        let Some(path) = self.class.path(target) else { return };
        let Some((last, before)) = path.split_last() else { return };
        let is_model = |component: &Component<'_>| {
            component.class().is_some_and(|class| {
                matches!(class.restriction(), Restriction::Model | Restriction::Block)
            })
        };
        if is_discrete(last) && before.iter().any(is_model) {
            let message =
                format!("the discrete variable `{}` is assigned outside its class", last.name());
            self.wrong(target.span, &message, "move the when-clause to the class that declares it");
        }
    }

    /// What is declared `discrete` has its values from when-clauses (MLS §4.5).
    fn discrete_with_value(&mut self, component: &Component<'_>) {
        let modification = component.declaration.modification.as_ref();
        let has_value = modification.is_some_and(|modification| modification.binding.is_some());
        let is_real = component.meaning() == Some(Type::Predefined(Predefined::Real));
        if has_value && is_real && is_discrete(component) {
            let message = format!(
                "`{}` is declared `discrete` and is not assigned in a when-clause",
                component.name()
            );
            let span = component.declaration.name.span;
            self.wrong(span, &message, "remove the prefix, or set the value with `start`");
        }
    }

    fn subscripts(&mut self, connector: &ComponentReference) {
        for subscript in connector.parts.iter().flat_map(|part| &part.subscripts) {
            if let Subscript::Index(index) = subscript
                && !self.is_fixed(index)
            {
                let message = "the subscript of a connector changes during the simulation";
                self.wrong(index.span, message, "use a parameter, a constant or a loop variable");
            }
        }
    }

    /// Parameters and constants are not assigned to, but in initial algorithms.
    fn assigned(&mut self, target: &ComponentReference, around: &Around) {
        let Some(component) = self.class.component_at(target) else { return };
        if around.function || around.initial || !component.is_fixed() {
            return;
        }
        let message = format!("`{}` is not a variable and cannot be assigned to", component.name());
        self.wrong(
            target.span,
            &message,
            "assign to a variable, or remove the prefix of the declaration",
        );
    }

    fn when(&mut self, span: Span, around: &Around) {
        let found = if around.function {
            Some(("a when-statement is not allowed in a function", "write if"))
        } else if around.when {
            Some(("when-clauses cannot be nested", "combine the conditions: `when {a, b} then`"))
        } else if around.initial {
            Some((
                "a when-clause is not allowed in an initial section",
                "write `when initial() then` in an equation section",
            ))
        } else if around.algorithm && (around.repeated || around.varying) {
            Some(NESTED_WHEN)
        } else if around.algorithm && around.looped {
            // Libraries repeat it so (SolarTherm): one when-statement for each value.
            let (message, help) = NESTED_WHEN;
            let error = fault!(MISPLACED, "{message}"; help: "{help}").at(span);
            let is_strict = self.class.library.is_strict();
            self.errors.push(if is_strict { error } else { error.warning() });
            None
        } else {
            None
        };
        if let Some((message, help)) = found {
            self.wrong(span, message, help);
        }
    }

    /// `connect` and the operators of the connection graph stand where the structure is fixed.
    fn connection(&mut self, what: &str, span: Span, around: &Around) {
        let place = match around {
            Around { algorithm: true, .. } => "in an algorithm",
            Around { when: true, .. } => "in a when-clause",
            Around { initial: true, .. } => "in an initial section",
            Around { varying: true, .. } => {
                "under a condition that can change during the simulation"
            }
            _ => return,
        };
        let help = "write it in an equation section, under no condition or under conditions that \
                    contain only parameters";
        self.wrong(span, &format!("`{what}` is not allowed {place}"), help);
    }

    fn call(&mut self, call: &Expression, around: &Around) {
        let ExpressionKind::Call { function, .. } = &call.kind else { return };
        match function.parts.as_slice() {
            [package, operator] if package.name.as_str() == "Connections" => {
                let builds = ["root", "potentialRoot", "branch", "uniqueRoot"];
                if builds.contains(&operator.name.as_str()) {
                    self.connection(&format!("Connections.{}", operator.name), call.span, around);
                }
            }
            [name] if ["transition", "initialState"].contains(&name.name.as_str()) => {
                self.connection(name.name.as_str(), call.span, around);
            }
            [name] if name.name.as_str() == "reinit" && !around.when => {
                self.wrong(
                    call.span,
                    "`reinit` is not allowed outside a when-clause",
                    "move it into one",
                );
            }
            _ => {}
        }
    }

    fn statements(&mut self, statements: &[Statement], around: &Around) {
        statements.iter().for_each(|statement| self.statement(statement, around));
    }

    fn statement(&mut self, statement: &Statement, around: &Around) {
        match &statement.kind {
            StatementKind::Assign { target, .. } => {
                self.assigned(target, around);
                if around.when {
                    self.discrete_of_component(target);
                }
            }
            StatementKind::MultiAssign { targets, .. } => {
                targets.iter().flatten().for_each(|target| self.assigned(target, around));
            }
            StatementKind::Call(call) => self.call(call, around),
            StatementKind::If { branches, otherwise } => {
                let inside = Around { varying: true, ..around.clone() };
                branches.iter().for_each(|(_, body)| self.statements(body, &inside));
                self.statements(otherwise, &inside);
            }
            StatementKind::For { body, .. } => {
                self.statements(body, &Around { looped: true, ..around.clone() });
            }
            StatementKind::While { body, .. } => {
                let inside = Around { looped: true, repeated: true, ..around.clone() };
                self.statements(body, &inside);
            }
            StatementKind::When { branches } => {
                self.when(statement.span, around);
                let inside = Around { when: true, ..around.clone() };
                branches.iter().for_each(|(_, body)| self.statements(body, &inside));
            }
            StatementKind::Break if !around.looped => {
                self.wrong(statement.span, "`break` is not allowed outside a loop", "remove it");
            }
            StatementKind::Return if !around.function => {
                self.wrong(
                    statement.span,
                    "`return` is not allowed outside a function",
                    "remove it",
                );
            }
            StatementKind::Break | StatementKind::Return => {}
        }
    }
}

fn is_discrete(component: &Component<'_>) -> bool {
    component.clause.type_prefixes.variability == Some(VariabilityPrefix::Discrete)
}

fn ranges(indices: &[ForIndex]) -> impl Iterator<Item = &Expression> {
    indices.iter().filter_map(|index| index.range.as_ref())
}
