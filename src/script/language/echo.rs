//! What is shown without being asked for, as each dialect shows it.

use super::follow_up::runs_script;
use crate::eval::ValueType;
use crate::name::Ident;
use crate::source::Span;
use crate::syntax::ast::{Expression, ExpressionKind};
use crate::value::Value;
use crate::value::show::{Style, show};
use crate::{Dialect, Echo, Session, builtins};

/// The variable that has the value of the last expression at a prompt.
pub const ANSWER: &str = "ans";

impl Session {
    /// Runs a script whose answers are the value of the statement that runs it, as OpenModelica's
    /// are: what the statements answer, line by line. In Dymola's dialect there are none.
    pub(crate) fn collecting_answers<T>(
        &mut self,
        work: impl FnOnce(&mut Session) -> T,
    ) -> (T, String) {
        if self.dialect() == Dialect::Dymola {
            return (work(self), String::new());
        }
        let depth = self.execution.go_to_top();
        self.output.begin_collecting();
        let done = work(self);
        self.execution.return_to(depth);
        (done, self.output.collected())
    }

    /// Shows a line of an answer, or adds it to those that are collected.
    fn echo(&mut self, line: &str) {
        if !self.output.collect(line) {
            self.print(line);
        }
    }

    fn may_echo(&self) -> bool {
        self.execution.is_at_top() && !self.output.is_muted() && self.options.echo != Echo::Nothing
    }

    /// The statement itself, which Dymola repeats in its log.
    pub(crate) fn echo_input(&mut self, span: Span) {
        let is_echoed = self.options.echo == Echo::Everything && self.dialect() == Dialect::Dymola;
        if is_echoed && self.may_echo() {
            let end = if self.sources.is_followed_by(span, ';') { ";" } else { "" };
            let line = format!("{}{end}\n", self.sources.text(span));
            self.world.print(&line);
        }
    }

    /// The value of an expression that is a statement.
    pub(crate) fn echo_value(&mut self, expression: &Expression, value: &Value) {
        if !self.execution.is_at_top() || self.output.is_muted() {
            return;
        }
        if matches!(value, Value::Tuple(v) if v.is_empty()) {
            return self.echo_nothing();
        }
        if self.options.echo == Echo::Usual && self.is_plain_success(expression, value) {
            return;
        }
        self.echo_finished(expression, value);
        self.keep_answer(value);
        match value {
            Value::Tuple(values) if self.dialect() == Dialect::OpenModelica => {
                self.answer_outputs(expression, values);
            }
            Value::String(answers) if self.passes_on(expression, answers) => {}
            value if self.answers_names(expression) => {
                let line = format!("{}\n", show(value, Style::OpenModelica).replace('"', ""));
                self.echo(&line);
            }
            value => self.answer(value),
        }
    }

    /// At a prompt the value remains as the variable `ans`.
    fn keep_answer(&mut self, value: &Value) {
        if self.options.echo == Echo::Dialogue && !matches!(value, Value::Tuple(_)) {
            // A variable that the user has declared under this name keeps its type and its value.
            let _ = self.workspace.variables.set(Ident::new(ANSWER), value.clone());
        }
    }

    /// Whether the value is a list of names, which OpenModelica shows without quotes.
    fn answers_names(&self, expression: &Expression) -> bool {
        let ExpressionKind::Call { function, .. } = &expression.kind else { return false };
        let command = builtins::find(&function.name(), self.dialect());
        self.dialect() == Dialect::OpenModelica
            && self.options.echo != Echo::Nothing
            && command.is_some_and(|command| {
                let outputs = &command.function().outputs;
                outputs.first().is_some_and(|output| output.value_type == ValueType::TypeName)
            })
    }

    /// The word in Dymola's log between a simulation and its answer.
    fn echo_finished(&mut self, expression: &Expression, value: &Value) {
        let is_echoed = matches!(self.options.echo, Echo::Everything | Echo::Dialogue)
            && self.dialect() == Dialect::Dymola
            && *value == Value::Boolean(true);
        let ExpressionKind::Call { function, .. } = &expression.kind else { return };
        let name = function.name();
        let simulates =
            name.last().is_some_and(|last| matches!(last.as_str(), "simulateModel" | "simulate"));
        if is_echoed && simulates && builtins::find(&name, self.dialect()).is_some() {
            self.print("Finished\n");
        }
    }

    /// Several outputs: OpenModelica shows all of its own commands, the first of other functions.
    fn answer_outputs(&mut self, expression: &Expression, values: &[Value]) {
        let is_command = matches!(&expression.kind, ExpressionKind::Call { function, .. }
            if builtins::find(&function.name(), self.dialect()).is_some());
        match (is_command, values.first()) {
            (false, Some(first)) => self.answer(first),
            _ => {
                let all = values.iter().map(|value| show(value, Style::OpenModelica));
                let line = format!("({})\n", all.collect::<Vec<_>>().join(", "));
                self.echo(&line);
            }
        }
    }

    /// Whether what a script answers is passed on as it is: quoted once more at each level, as OpenModelica
    /// does, long answers would double their backslashes each time.
    fn passes_on(&mut self, expression: &Expression, answers: &str) -> bool {
        const LONG: usize = 1 << 12;
        let is_plain = answers.len() > LONG || self.execution.stop().is_some();
        is_plain && runs_script(expression) && self.output.collect(answers)
    }

    /// A first assignment, which Dymola announces; the value, which OpenModelica shows.
    pub(crate) fn echo_assignment(&mut self, name: Ident, is_new: bool, expression: &Expression) {
        match self.dialect() {
            Dialect::OpenModelica if self.may_echo() => {
                match self.workspace.variables.get(name).cloned() {
                    Some(Value::String(answers)) if self.passes_on(expression, &answers) => {}
                    Some(value) => self.answer(&value),
                    None => {}
                }
            }
            Dialect::Dymola if is_new => self.echo_declaration(name),
            _ => {}
        }
    }

    /// A variable that an assignment made, as Dymola announces it.
    pub(crate) fn echo_declaration(&mut self, name: Ident) {
        let is_echoed = self.dialect() == Dialect::Dymola
            && matches!(self.options.echo, Echo::Everything | Echo::Dialogue)
            && self.may_echo();
        let Some(value) = self.workspace.variables.get(name).filter(|_| is_echoed) else { return };
        let sizes: Vec<String> = value.dims().iter().map(usize::to_string).collect();
        let dims = match sizes.is_empty() {
            true => String::new(),
            false => format!(" [{}]", sizes.join(", ")),
        };
        let type_name = value.type_name();
        let base = type_name.split('[').next().unwrap_or_default();
        let line = format!("Declaring variable: {base} {name}{dims} ;\n");
        self.print(&line);
    }

    /// The empty line that OpenModelica prints for a statement without a value.
    pub(crate) fn echo_nothing(&mut self) {
        if self.dialect() == Dialect::OpenModelica && self.may_echo() {
            self.echo("\n");
        }
    }

    fn answer(&mut self, value: &Value) {
        let (style, lead) = match self.dialect() {
            Dialect::Dymola => (Style::Dymola, " = "),
            Dialect::OpenModelica => (Style::OpenModelica, ""),
        };
        if self.output.collect(&format!("{}\n", show(value, style))) {
            return;
        }
        if self.options.echo != Echo::Nothing {
            let line = format!("{lead}{}\n", show(value, style));
            self.world.print(&line);
        }
        let style = if style == Style::Dymola { Style::Transcript } else { style };
        self.output.record(&format!("{lead}{}\n", show(value, style)));
    }

    /// Whether a command only says that it succeeded: `true` from an output named `ok`.
    fn is_plain_success(&mut self, expression: &Expression, value: &Value) -> bool {
        let ExpressionKind::Call { function, .. } = &expression.kind else { return false };
        self.dialect() == Dialect::Dymola
            && *value == Value::Boolean(true)
            && builtins::find(&function.name(), self.dialect())
                .is_some_and(|id| id.function().outputs.iter().any(|output| output.name == "ok"))
    }
}
