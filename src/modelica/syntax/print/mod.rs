//! Syntax tree to Modelica text. Reading the text again gives the same tree, places aside.
//!
//! Parentheses are written where precedence needs them and nowhere else.

mod class;
mod expression;
mod modification;
mod statement;

use super::ast;
use std::fmt::Write as _;

/// A file, ending in a line end.
pub fn stored_definition(definition: &ast::StoredDefinition) -> String {
    printed(|printer| printer.stored_definition(definition))
}

/// A script, one statement a line.
pub fn script(script: &ast::Script) -> String {
    printed(|printer| printer.script(script))
}

/// A class definition without its semicolon.
pub fn class(class: &ast::ClassDefinition) -> String {
    printed(|printer| printer.class(class))
}

/// A class definition without its semicolon, and without blanks around `*`, `/` and `^`.
pub fn dense_class(class: &ast::ClassDefinition) -> String {
    let mut printer = Printer { dense: true, ..Printer::default() };
    printer.class(class);
    printer.out
}

/// An expression.
pub fn expression(expression: &ast::Expression) -> String {
    printed(|printer| printer.expression(expression))
}

/// A component reference.
pub fn reference(reference: &ast::ComponentReference) -> String {
    printed(|printer| printer.reference(reference))
}

/// A statement without its semicolon.
pub fn statement(statement: &ast::Statement) -> String {
    printed(|printer| printer.statement(statement))
}

/// An equation without its semicolon.
pub fn equation(equation: &ast::Equation) -> String {
    printed(|printer| printer.equation(equation))
}

/// A modification, with a blank before `=`.
pub fn modification(modification: &ast::Modification) -> String {
    printed(|printer| printer.modification(modification))
}

/// A string as a literal: in quotes, with escapes (MLS §2.4.6).
pub fn string_literal(text: &str) -> String {
    printed(|printer| printer.string(text))
}

fn printed(print: impl FnOnce(&mut Printer)) -> String {
    let mut printer = Printer::default();
    print(&mut printer);
    printer.out
}

/// The text so far and the depth of its blocks.
#[derive(Default)]
struct Printer {
    out: String,
    indent: usize,
    /// Whether `*`, `/` and `^` have no blanks around them.
    dense: bool,
}

impl Printer {
    fn word(&mut self, text: &str) {
        self.out.push_str(text);
    }

    /// The word and a blank, if the flag is set.
    fn flag(&mut self, flag: bool, word: &str) {
        if flag {
            self.out.push_str(word);
            self.out.push(' ');
        }
    }

    fn show(&mut self, value: impl std::fmt::Display) {
        // Writing to a string cannot fail.
        let _ = write!(self.out, "{value}");
    }

    fn new_line(&mut self) {
        self.out.push('\n');
        for _ in 0..self.indent {
            self.out.push_str("  ");
        }
    }

    /// The items with commas between.
    fn list<T>(&mut self, items: &[T], mut item: impl FnMut(&mut Printer, &T)) {
        for (at, one) in items.iter().enumerate() {
            if at > 0 {
                self.word(", ");
            }
            item(self, one);
        }
    }

    /// What `body` prints, one level further in.
    fn indented(&mut self, body: impl FnOnce(&mut Printer)) {
        self.indent += 1;
        body(self);
        self.indent -= 1;
    }

    fn string(&mut self, text: &str) {
        self.out.push('"');
        for character in text.chars() {
            match character {
                '"' => self.word("\\\""),
                '\\' => self.word("\\\\"),
                '\n' => self.word("\\n"),
                '\r' => self.word("\\r"),
                '\t' => self.word("\\t"),
                '\u{07}' => self.word("\\a"),
                '\u{08}' => self.word("\\b"),
                '\u{0b}' => self.word("\\v"),
                '\u{0c}' => self.word("\\f"),
                other => self.out.push(other),
            }
        }
        self.out.push('"');
    }

    fn description(&mut self, text: Option<&str>) {
        if let Some(text) = text {
            self.word(" ");
            self.string(text);
        }
    }

    fn comment(&mut self, comment: &ast::Comment) {
        self.description(comment.text.as_deref());
        if let Some(annotation) = &comment.annotation {
            self.word(" ");
            self.annotation(annotation);
        }
    }

    fn annotation(&mut self, annotation: &ast::Annotation) {
        self.word("annotation(");
        self.list(&annotation.arguments, Printer::argument);
        self.word(")");
    }
}
