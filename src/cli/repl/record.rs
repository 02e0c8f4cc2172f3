//! What was typed in a session, to be saved as a script.

use crate::script::language::echo::ANSWER;
use crate::source::SourceId;
use crate::syntax;

/// The inputs of a session.
#[derive(Debug, Default)]
pub(super) struct Record {
    inputs: Vec<Input>,
}

#[derive(Debug)]
struct Input {
    statements: String,
    has_failed: bool,
}

impl Record {
    /// Adds what was executed.
    pub(super) fn note(&mut self, statements: impl Into<String>, has_failed: bool) {
        self.inputs.push(Input { statements: statements.into(), has_failed });
    }

    /// A script that does the same. What failed is in its comments; an expression whose value was used
    /// later as `ans` is assigned to it.
    pub(super) fn script(&self) -> String {
        let mut script = String::new();
        for (at, input) in self.inputs.iter().enumerate() {
            let text = input.statements.trim();
            let end = if text.ends_with(';') { "" } else { ";" };
            if input.has_failed {
                let lines = text.lines().map(|line| format!("// {line}\n"));
                script.push_str("// failed:\n");
                script.extend(lines);
            } else if is_expression(text) && self.is_answer_used(at) {
                script.push_str(&format!("{ANSWER} := {text}{end}\n"));
            } else {
                script.push_str(&format!("{text}{end}\n"));
            }
        }
        script
    }

    /// Whether the value of this expression is used before the next one has another value.
    fn is_answer_used(&self, at: usize) -> bool {
        for later in self.inputs[at + 1..].iter().filter(|input| !input.has_failed) {
            if words(&later.statements).any(|word| word == ANSWER) {
                return true;
            }
            if is_expression(&later.statements) {
                return false;
            }
        }
        false
    }
}

fn is_expression(text: &str) -> bool {
    let text = text.trim().trim_end_matches(';');
    syntax::parse_expression(SourceId::NONE, text).is_ok()
}

fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c: char| !(c.is_alphanumeric() || c == '_'))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_session_is_saved_as_a_script() {
        let mut record = Record::default();
        for (statements, has_failed) in [
            ("x = 2", false),
            ("y = nowhere\n+ 1", true),
            ("x + 1", false),
            ("z = 3*ans;", false),
            ("z", false),
        ] {
            record.note(statements, has_failed);
        }
        let expected =
            "x = 2;\n// failed:\n// y = nowhere\n// + 1\nans := x + 1;\nz = 3*ans;\nz;\n";
        assert_eq!(record.script(), expected);
    }
}
