//! Functions that print, called in functions being compiled: their texts may have numbers in them
//! that are known when the simulation gets there.

use super::statements::{Body, Loops};
use crate::bytecode::{ExternalCall, Instruction};
use crate::diag::{Diagnostic, Fault};
use crate::external::{Call, Entry, Kind, Slot};
use crate::fault;
use crate::lower::errors::NOT_SUPPORTED;
use crate::lower::expressions::Lowered;
use crate::lower::expressions::message_text;
use crate::lower::message::nth;
use crate::lower::shape::UNKNOWN_TEXT;
use crate::source::Span;
use crate::syntax::ast;
use crate::value::Value;
use crate::value::format::text;

/// `ModelicaInternal_print` with a text in parts, of which some are numbers: the file, then the parts.
static TELL: Entry = Entry::writing("ModelicaInternal_print", "", tell);

/// As `String` writes Reals (MLS §3.7.1).
const SIGNIFICANT_DIGITS: i64 = 6;

fn tell(call: &mut Call<'_>) -> Result<(), Fault> {
    let mut words = String::new();
    for slot in &call.arguments[1..] {
        match slot.kind {
            Kind::Text => words += &call.strings[slot.first as usize],
            Kind::Number | Kind::Object => {
                let value = Value::Real(call.numbers[slot.first as usize]);
                words += &text(&value, SIGNIFICANT_DIGITS, 0, true)?;
            }
        }
    }
    match &*call.strings[call.arguments[0].first as usize].clone() {
        "" => call.outside.print(words.trim_end_matches('\n')),
        path => call.outside.append(path, format!("{words}\n").as_bytes()),
    }
}

/// x of `String(x)`.
fn argument_of_string(e: &ast::Expression) -> Option<&ast::Expression> {
    let ast::ExpressionKind::Call { function, arguments } = &e.kind else { return None };
    let is_plain = function.as_ident()? == "String" && arguments.named.is_empty();
    arguments.positional.as_slice().first().filter(|_| is_plain && arguments.positional.len() == 1)
}

impl Body<'_, '_> {
    /// A call of a function that prints: the numbers in its text are those of when it is carried out.
    pub(super) fn printing(
        &mut self,
        arguments: &ast::Arguments,
        span: Span,
        loops: &Loops,
    ) -> Result<(), Diagnostic> {
        self.emitter.place(span);
        self.emitter.open();
        let file = message_text(&mut self.lowering(loops), nth(arguments, 1, "fileName"));
        if file.contains(UNKNOWN_TEXT) {
            return Err(
                fault!(NOT_SUPPORTED, "the name of the file must be known at translation").at(span)
            );
        }
        let mut parts = vec![self.slot(Lowered::Text(file.into()), None, span)?];
        if let Some(text) = nth(arguments, 0, "string") {
            self.parts_of_text(text, loops, &mut parts)?;
        }
        let call = ExternalCall { entry: &TELL, arguments: parts, result: None };
        let external = self.emitter.external(call);
        self.emitter.emit(Instruction::External { external });
        self.emitter.close();
        Ok(())
    }

    fn parts_of_text(
        &mut self,
        e: &ast::Expression,
        loops: &Loops,
        parts: &mut Vec<Slot>,
    ) -> Result<(), Diagnostic> {
        if let ast::ExpressionKind::Binary { operator: ast::BinaryOperator::Add, left, right } =
            &e.kind
        {
            self.parts_of_text(left, loops, parts)?;
            return self.parts_of_text(right, loops, parts);
        }
        let text = message_text(&mut self.lowering(loops), Some(e));
        let number = match (text.contains(UNKNOWN_TEXT), argument_of_string(e)) {
            (true, Some(argument)) => self.lowering(loops).scalar(argument).ok(),
            _ => None,
        };
        parts.push(match number {
            Some(number) => {
                let first = self.emitter.row(&[number]);
                Slot { kind: Kind::Number, first, dims: Box::new([]) }
            }
            None => self.slot(Lowered::Text(text.into()), None, e.span)?,
        });
        Ok(())
    }
}
