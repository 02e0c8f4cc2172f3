//! Equations, statements and scripts as text.

use super::Printer;
use crate::syntax::RUN_COMMAND;
use crate::syntax::ast::{
    Equation, EquationKind, Expression, ExpressionKind, InteractiveKind, Script, Statement,
    StatementKind,
};

impl Printer {
    pub(super) fn equation(&mut self, equation: &Equation) {
        match &equation.kind {
            EquationKind::Equal { left, right } => {
                self.left_side(left);
                self.word(" = ");
                self.expression(right);
            }
            EquationKind::If { branches, otherwise } => {
                self.branches(["if ", "elseif "], branches, Printer::equation_line);
                self.otherwise(otherwise, Printer::equation_line);
                self.word("end if");
            }
            EquationKind::For { indices, body } => {
                self.word("for ");
                self.for_indices(indices);
                self.body(" loop", body, Printer::equation_line);
                self.word("end for");
            }
            EquationKind::Connect { left, right } => {
                self.word("connect(");
                self.reference(left);
                self.word(", ");
                self.reference(right);
                self.word(")");
            }
            EquationKind::When { branches } => {
                self.branches(["when ", "elsewhen "], branches, Printer::equation_line);
                self.word("end when");
            }
            EquationKind::Call(call) => self.expression(call),
        }
        self.comment(&equation.comment);
    }

    fn equation_line(&mut self, equation: &Equation) {
        self.equation(equation);
        self.word(";");
    }

    pub(super) fn statement(&mut self, statement: &Statement) {
        match &statement.kind {
            StatementKind::Assign { target, value } => {
                self.reference(target);
                self.word(" := ");
                self.expression(value);
            }
            StatementKind::MultiAssign { targets, value } => {
                self.word("(");
                self.list(targets, |printer, target| {
                    target.iter().for_each(|target| printer.reference(target));
                });
                self.word(") := ");
                self.expression(value);
            }
            StatementKind::Call(call) => self.expression(call),
            StatementKind::If { branches, otherwise } => {
                self.branches(["if ", "elseif "], branches, Printer::statement_line);
                self.otherwise(otherwise, Printer::statement_line);
                self.word("end if");
            }
            StatementKind::For { indices, body } => {
                self.word("for ");
                self.for_indices(indices);
                self.body(" loop", body, Printer::statement_line);
                self.word("end for");
            }
            StatementKind::While { condition, body } => {
                self.word("while ");
                self.expression(condition);
                self.body(" loop", body, Printer::statement_line);
                self.word("end while");
            }
            StatementKind::When { branches } => {
                self.branches(["when ", "elsewhen "], branches, Printer::statement_line);
                self.word("end when");
            }
            StatementKind::Break => self.word("break"),
            StatementKind::Return => self.word("return"),
        }
        self.comment(&statement.comment);
    }

    fn statement_line(&mut self, statement: &Statement) {
        self.statement(statement);
        self.word(";");
    }

    /// Branches with their keywords; the last line end is that before `else` or `end`.
    fn branches<T>(
        &mut self,
        keywords: [&str; 2],
        branches: &[(Expression, Vec<T>)],
        line: fn(&mut Printer, &T),
    ) {
        for (at, (condition, body)) in branches.iter().enumerate() {
            self.word(keywords[at.min(1)]);
            self.expression(condition);
            self.body(" then", body, line);
        }
    }

    fn otherwise<T>(&mut self, body: &[T], line: fn(&mut Printer, &T)) {
        if !body.is_empty() {
            self.body("else", body, line);
        }
    }

    fn body<T>(&mut self, opening: &str, body: &[T], line: fn(&mut Printer, &T)) {
        self.word(opening);
        self.indented(|printer| {
            for one in body {
                printer.new_line();
                line(printer, one);
            }
        });
        self.new_line();
    }

    pub(super) fn script(&mut self, script: &Script) {
        let mut closed = true;
        for one in &script.statements {
            self.interactive(&one.kind, closed);
            self.word(if one.semicolon { ";\n" } else { "\n" });
            closed = one.semicolon;
        }
    }

    /// `closed`: a semicolon precedes it, so that a sign cannot continue the line before.
    fn interactive(&mut self, kind: &InteractiveKind, closed: bool) {
        match kind {
            InteractiveKind::Statement(statement) => self.statement(statement),
            InteractiveKind::Expression(expression) => {
                let text = super::expression(expression);
                let conditional = matches!(expression.kind, ExpressionKind::If { .. });
                let continues = !closed && text.starts_with(['+', '-', '.']);
                match conditional || continues || begins_with_command(&text) {
                    true => self.in_parentheses(expression),
                    false => self.word(&text),
                }
            }
            InteractiveKind::Declaration(clause) => self.component_clause(clause),
            InteractiveKind::Class(class) => self.class(class),
            InteractiveKind::Import(import) => self.import(import),
            InteractiveKind::Command { name, argument } => {
                self.word(&name.node);
                let apart = !argument.node.is_empty() && &*name.node != RUN_COMMAND;
                self.word(if apart { " " } else { "" });
                self.word(&argument.node);
            }
        }
    }
}

/// Whether the text would read as a bare command, which is neither a call nor a dotted name.
fn begins_with_command(text: &str) -> bool {
    ["clearlog", "clear", "exit", "cd"].iter().any(|command| {
        text.strip_prefix(command).is_some_and(|rest| rest.is_empty() || rest.starts_with(' '))
    })
}
