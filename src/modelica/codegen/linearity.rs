//! Whether the right-hand side is affine in states and time between events, found on the expressions:
//! a condition on a state makes it nonlinear although its derivative is constant wherever there is one.

use crate::bytecode::Functions;
use crate::causalize::{Assignment, CausalizedDae};
use crate::lower::VariableKind;
use crate::sim::Linearity;
use crate::symbolic::{Expr, Node, Pool, VarId};
use rustc_hash::FxHashMap;

/// How an expression depends on states and time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Form {
    /// Not at all; whether events change it.
    Constant { at_events: bool },
    /// As a x + b + c t; whether a and c are not zero, and whether events change a.
    Affine { in_states: bool, in_time: bool, at_events: bool },
    /// In another way.
    Nonlinear,
}

const FIXED: Form = Form::Constant { at_events: false };
const HELD: Form = Form::Constant { at_events: true };

impl Form {
    /// Of a sum.
    fn plus(self, other: Form) -> Form {
        match (self, other) {
            (Form::Nonlinear, _) | (_, Form::Nonlinear) => Form::Nonlinear,
            (Form::Constant { at_events: a }, Form::Constant { at_events: b }) => {
                Form::Constant { at_events: a || b }
            }
            (Form::Constant { .. }, affine) | (affine, Form::Constant { .. }) => affine,
            (
                Form::Affine { in_states: x, in_time: t, at_events: a },
                Form::Affine { in_states: y, in_time: u, at_events: b },
            ) => Form::Affine { in_states: x || y, in_time: t || u, at_events: a || b },
        }
    }

    /// Of a product with a factor, or of a choice by a condition.
    fn times(self, factor: Form) -> Form {
        match (self, factor) {
            (Form::Constant { at_events: a }, Form::Constant { at_events: b }) => {
                Form::Constant { at_events: a || b }
            }
            (
                Form::Affine { in_states, in_time, at_events: a },
                Form::Constant { at_events: b },
            )
            | (
                Form::Constant { at_events: b },
                Form::Affine { in_states, in_time, at_events: a },
            ) => Form::Affine { in_states, in_time, at_events: a || (b && in_states) },
            _ => Form::Nonlinear,
        }
    }

    /// The same where it depends on states and time not at all, else nonlinear.
    fn if_constant(self) -> Form {
        if matches!(self, Form::Constant { .. }) { self } else { Form::Nonlinear }
    }
}

/// The forms of variables and expressions.
struct Forms<'a> {
    pool: &'a Pool,
    functions: &'a Functions,
    variables: Vec<Form>,
    known: FxHashMap<Expr, Form>,
}

/// What is known of outputs of a sequence, if they are affine in these states and in time.
pub(super) fn linearity(
    pool: &Pool,
    causalized: &CausalizedDae,
    sequence: &[Assignment],
    outputs: &[Expr],
) -> Option<Linearity> {
    let variables = causalized.dae.variables.iter().map(|variable| match variable.kind {
        VariableKind::Constant(_) | VariableKind::Parameter { .. } | VariableKind::Solved => FIXED,
        VariableKind::Discrete
        | VariableKind::Previous(_)
        | VariableKind::Frozen
        | VariableKind::Signal => HELD,
        VariableKind::Time => Form::Affine { in_states: false, in_time: true, at_events: false },
        _ => Form::Nonlinear,
    });
    let variables = variables.collect();
    let functions = &causalized.dae.functions;
    let mut forms = Forms { pool, functions, variables, known: FxHashMap::default() };
    for state in &causalized.states {
        let own = Form::Affine { in_states: true, in_time: false, at_events: false };
        forms.variables[state.0 as usize] = own;
    }
    for assignment in sequence {
        let form = forms.of(assignment.value);
        forms.set(assignment.variable, form);
    }
    let all = outputs.iter().fold(FIXED, |all, output| all.plus(forms.of(*output)));
    match all {
        Form::Constant { .. } => Some(Linearity::default()),
        Form::Affine { at_events, in_time, .. } => Some(Linearity {
            changes_at_events: at_events,
            varies_in_time: in_time,
            is_watched: false,
        }),
        Form::Nonlinear => None,
    }
}

impl Forms<'_> {
    fn set(&mut self, variable: VarId, form: Form) {
        let at = variable.0 as usize;
        if at >= self.variables.len() {
            self.variables.resize(at + 1, Form::Nonlinear);
        }
        self.variables[at] = form;
    }

    fn of(&mut self, e: Expr) -> Form {
        if let Some(form) = self.known.get(&e) {
            return *form;
        }
        let pool = self.pool;
        let form = match pool.node(e) {
            Node::Constant(_) => FIXED,
            Node::Variable(v) => {
                return self.variables.get(v.0 as usize).copied().unwrap_or(Form::Nonlinear);
            }
            Node::Neg(a) => self.of(*a),
            Node::Add(a, b) | Node::Sub(a, b) => self.of(*a).plus(self.of(*b)),
            Node::Mul(a, b) => self.of(*a).times(self.of(*b)),
            Node::Div(a, b) => {
                let divisor = self.of(*b).if_constant();
                self.of(*a).times(divisor)
            }
            Node::If(condition, a, b) => {
                let condition = self.of(*condition).if_constant();
                self.of(*a).plus(self.of(*b)).times(condition)
            }
            Node::List(elements) => {
                elements.iter().fold(FIXED, |all, element| all.plus(self.of(*element)))
            }
            Node::Solution { matrix, right, .. } => {
                let matrix = self.of(*matrix).if_constant();
                self.of(*right).times(matrix)
            }
            Node::Call { function, arguments, .. }
            | Node::CallDerivative { function, arguments, .. } => {
                let code = &self.functions.codes[*function as usize];
                match code.impure || code.writes {
                    true => Form::Nonlinear,
                    false => self.of(*arguments).if_constant(),
                }
            }
            node => {
                let mut all = FIXED;
                node.for_each_operand(|operand| all = all.plus(self.of(operand)));
                all.if_constant()
            }
        };
        self.known.insert(e, form);
        form
    }
}
