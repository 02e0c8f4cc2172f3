//! Functions that print, called in functions being compiled: their texts may have numbers in them
//! that are known when the simulation gets there.

use super::statements::{Body, Loops};
use crate::bytecode::{ExternalCall, Instruction};
use crate::diag::Diagnostic;
use crate::external::{PRINT, Slot};
use crate::fault;
use crate::lower::errors::NOT_SUPPORTED;
use crate::lower::expressions::{Lowered, TextPart, message_text};
use crate::lower::message::nth;
use crate::lower::shape::UNKNOWN_TEXT;
use crate::source::Span;
use crate::syntax::ast;

/// The arguments of `String(x, …)`.
fn arguments_of_string(e: &ast::Expression) -> Option<&ast::Arguments> {
    let ast::ExpressionKind::Call { function, arguments } = &e.kind else { return None };
    let is_plain = function.as_ident()? == "String" && arguments.positional.len() == 1;
    is_plain.then_some(arguments)
}

impl Body<'_, '_> {
    /// A call of a function that prints: the numbers in its text are those of when it is carried out.
    pub(super) fn printing(
        &mut self,
        arguments: &ast::Arguments,
        span: Span,
        loops: &Loops,
    ) -> Result<(), Diagnostic> {
        if self.instances.silent {
            return Ok(());
        }
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
        let call = ExternalCall::new(&PRINT, parts, None);
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
        if let ast::ExpressionKind::Reference(_) = e.kind
            && let Ok(Lowered::Numbered(text)) = self.of_known_texts(loops).lower(e)
        {
            parts.extend(self.slots(&[TextPart::Numbered(text)]));
            return Ok(());
        }
        let text = message_text(&mut self.of_known_texts(loops), Some(e));
        if text.contains(UNKNOWN_TEXT)
            && let Some(arguments) = arguments_of_string(e)
            && let Some(part) = self.lowering(loops).number_part(arguments)?
        {
            parts.extend(self.slots(&[part]));
            return Ok(());
        }
        parts.push(self.slot(Lowered::Text(text.into()), None, e.span)?);
        Ok(())
    }
}
