//! Expressions as text.

use super::Printer;
use crate::syntax::ast::{
    Arguments, BinaryOperator, ComponentReference, Expression, ExpressionKind, ForIndex,
    NamedArgument, Operation, Subscript, UnaryOperator,
};

/// How tightly a form binds; the order is that of MLS §3.2.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Level {
    /// If-expressions and ranges.
    Any,
    Or,
    And,
    Not,
    Relation,
    /// Signs too: `-a * b` is `-(a * b)`.
    Addition,
    Multiplication,
    Power,
    Primary,
}

impl Level {
    fn tighter(self) -> Level {
        match self {
            Level::Any => Level::Or,
            Level::Or => Level::And,
            Level::And => Level::Not,
            Level::Not => Level::Relation,
            Level::Relation => Level::Addition,
            Level::Addition => Level::Multiplication,
            Level::Multiplication => Level::Power,
            Level::Power | Level::Primary => Level::Primary,
        }
    }
}

fn level(expression: &Expression) -> Level {
    match &expression.kind {
        ExpressionKind::If { .. } | ExpressionKind::Range { .. } => Level::Any,
        ExpressionKind::Binary { operator, .. } => operator_level(*operator),
        ExpressionKind::Unary { operator: UnaryOperator::Not, .. } => Level::Not,
        ExpressionKind::Unary { .. } => Level::Addition,
        ExpressionKind::Real(value) if value.is_sign_negative() => Level::Addition,
        ExpressionKind::Integer(value) if *value < 0 => Level::Addition,
        _ => Level::Primary,
    }
}

fn operator_level(operator: BinaryOperator) -> Level {
    match operator {
        BinaryOperator::Or => Level::Or,
        BinaryOperator::And => Level::And,
        BinaryOperator::Less
        | BinaryOperator::LessEqual
        | BinaryOperator::Greater
        | BinaryOperator::GreaterEqual
        | BinaryOperator::Equal
        | BinaryOperator::NotEqual => Level::Relation,
        BinaryOperator::Add
        | BinaryOperator::Subtract
        | BinaryOperator::ElementwiseAdd
        | BinaryOperator::ElementwiseSubtract => Level::Addition,
        BinaryOperator::Multiply
        | BinaryOperator::Divide
        | BinaryOperator::ElementwiseMultiply
        | BinaryOperator::ElementwiseDivide => Level::Multiplication,
        BinaryOperator::Power | BinaryOperator::ElementwisePower => Level::Power,
    }
}

impl Printer {
    pub(super) fn expression(&mut self, expression: &Expression) {
        match &expression.kind {
            ExpressionKind::Real(value) => self.real(*value),
            ExpressionKind::Integer(value) => self.show(value),
            ExpressionKind::Boolean(value) => self.show(value),
            ExpressionKind::String(text) => self.string(text),
            ExpressionKind::Reference(reference) => self.reference(reference),
            ExpressionKind::Call { function, arguments } => {
                self.reference(function);
                self.arguments(arguments);
            }
            ExpressionKind::Guarded { condition, values, .. } => {
                self.expression(condition);
                self.word(" in ");
                self.expression(values);
            }
            ExpressionKind::PartialApplication { function, named } => {
                self.word("function ");
                self.show(function);
                self.word("(");
                self.list(named, Printer::named_argument);
                self.word(")");
            }
            ExpressionKind::Unary { operator, operand } => self.unary(*operator, operand),
            ExpressionKind::Binary { .. } => self.binary(expression),
            ExpressionKind::If { branches, otherwise } => self.conditional(branches, otherwise),
            ExpressionKind::Range { start, step, stop } => {
                self.at_least(Level::Or, start);
                if let Some(step) = step {
                    self.word(":");
                    self.at_least(Level::Or, step);
                }
                self.word(":");
                self.at_least(Level::Or, stop);
            }
            ExpressionKind::Array(elements) => {
                self.word("{");
                self.list(elements, Printer::expression);
                self.word("}");
            }
            ExpressionKind::ArrayIteration { element, indices } => {
                self.word("{");
                self.expression(element);
                self.iterators(indices);
                self.word("}");
            }
            ExpressionKind::Matrix(rows) => self.matrix(rows),
            ExpressionKind::Tuple(outputs) => {
                self.word("(");
                self.list(outputs, |printer, output| {
                    output.iter().for_each(|output| printer.expression(output));
                });
                self.word(")");
            }
            ExpressionKind::End => self.word("end"),
            ExpressionKind::TypeName(name) => {
                self.word("$TypeName(");
                self.show(name);
                self.word(")");
            }
            ExpressionKind::Code(text) => {
                self.word("$Code(");
                self.show(text);
                self.word(")");
            }
            ExpressionKind::Subscripted { base, subscripts } => {
                self.base(base);
                self.subscripts(subscripts);
            }
            ExpressionKind::Field { base, name } => {
                self.base(base);
                self.word(".");
                self.show(name);
            }
        }
    }

    /// The expression, in parentheses if it binds looser than `least`.
    fn at_least(&mut self, least: Level, expression: &Expression) {
        if level(expression) >= least {
            self.expression(expression);
        } else {
            self.in_parentheses(expression);
        }
    }

    pub(super) fn in_parentheses(&mut self, expression: &Expression) {
        self.word("(");
        self.expression(expression);
        self.word(")");
    }

    /// The left side of an equation: a conditional one would read as an if-equation.
    pub(super) fn left_side(&mut self, expression: &Expression) {
        self.at_least(Level::Or, expression);
    }

    /// What `[...]` or `.name` follows: a parenthesis.
    fn base(&mut self, base: &Expression) {
        match base.kind {
            ExpressionKind::Tuple(_) => self.expression(base),
            _ => self.in_parentheses(base),
        }
    }

    /// Shortest text that reads back to the same number, and as a Real.
    fn real(&mut self, value: f64) {
        if value.is_infinite() {
            self.word(if value > 0.0 { "1e999" } else { "-1e999" });
        } else {
            self.show(format_args!("{value:?}"));
        }
    }

    fn unary(&mut self, operator: UnaryOperator, operand: &Expression) {
        self.word(operator.symbol());
        let least = match operator {
            UnaryOperator::Not => Level::Not,
            _ => Level::Multiplication,
        };
        let sign = matches!(
            operand.kind,
            ExpressionKind::Unary { operator: inner, .. } if inner != UnaryOperator::Not
        );
        if operator == UnaryOperator::Not || sign {
            self.word(" ");
        }
        match sign {
            true => self.expression(operand),
            false => self.at_least(least, operand),
        }
    }

    /// The operations of a chain one after the other; what is left of one that binds tighter is in
    /// parentheses, all of which open before the first operand.
    fn binary(&mut self, expression: &Expression) {
        let (first, operations) = expression.chain();
        let is_closed = |one: &Operation<'_>| {
            let own = operator_level(one.operator);
            let associates = !matches!(own, Level::Relation | Level::Power);
            level(one.left) < if associates { own } else { own.tighter() }
        };
        for _ in operations.iter().filter(|one| is_closed(one)) {
            self.word("(");
        }
        self.expression(first);
        for one in operations {
            if is_closed(&one) {
                self.word(")");
            }
            let is_tight = matches!(
                one.operator,
                BinaryOperator::Multiply | BinaryOperator::Divide | BinaryOperator::Power
            );
            let blank = if self.dense && is_tight { "" } else { " " };
            self.word(blank);
            self.word(one.operator.symbol());
            self.word(blank);
            self.at_least(operator_level(one.operator).tighter(), one.right);
        }
    }

    fn conditional(&mut self, branches: &[(Expression, Expression)], otherwise: &Expression) {
        for (at, (condition, value)) in branches.iter().enumerate() {
            self.word(if at == 0 { "if " } else { " elseif " });
            self.expression(condition);
            self.word(" then ");
            self.expression(value);
        }
        self.word(" else ");
        self.expression(otherwise);
    }

    fn matrix(&mut self, rows: &[Vec<Expression>]) {
        self.word("[");
        for (at, row) in rows.iter().enumerate() {
            if at > 0 {
                self.word("; ");
            }
            self.list(row, Printer::expression);
        }
        self.word("]");
    }

    fn arguments(&mut self, arguments: &Arguments) {
        self.word("(");
        self.list(&arguments.positional, Printer::expression);
        if !arguments.positional.is_empty() && !arguments.named.is_empty() {
            self.word(", ");
        }
        self.list(&arguments.named, Printer::named_argument);
        if !arguments.iterators.is_empty() {
            self.iterators(&arguments.iterators);
        }
        self.word(")");
    }

    fn named_argument(&mut self, argument: &NamedArgument) {
        self.show(argument.name.node);
        self.word(" = ");
        self.expression(&argument.value);
    }

    fn iterators(&mut self, indices: &[ForIndex]) {
        self.word(" for ");
        self.for_indices(indices);
    }

    pub(super) fn for_indices(&mut self, indices: &[ForIndex]) {
        self.list(indices, |printer, index| {
            printer.show(index.name.node);
            if let Some(range) = &index.range {
                let is_guarded = matches!(range.kind, ExpressionKind::Guarded { .. });
                printer.word(if is_guarded { " guard " } else { " in " });
                printer.expression(range);
            }
        });
    }

    pub(super) fn reference(&mut self, reference: &ComponentReference) {
        for (at, part) in reference.parts.iter().enumerate() {
            if at > 0 || reference.global {
                self.word(".");
            }
            self.show(part.name);
            self.subscripts(&part.subscripts);
        }
    }

    /// Subscripts in brackets, nothing for none.
    pub(super) fn subscripts(&mut self, subscripts: &[Subscript]) {
        if subscripts.is_empty() {
            return;
        }
        self.word("[");
        self.list(subscripts, |printer, subscript| match subscript {
            Subscript::All(_) => printer.word(":"),
            Subscript::Index(index) => printer.expression(index),
        });
        self.word("]");
    }
}
