//! Functions that print, and assertions, in functions being compiled: their messages may contain
//! numbers that are known only when they are executed.

use super::emitter::Operand;
use super::statements::Body;
use crate::arithmetic::{Operation, Operator};
use crate::bytecode::{ExternalCall, Instruction};
use crate::diag::Diagnostic;
use crate::external::{FAIL, PRINT};
use crate::fault;
use crate::lower::errors::NOT_SUPPORTED;
use crate::lower::expressions::{Lowered, message_parts, message_text, nth};
use crate::lower::shape::UNKNOWN_TEXT;
use crate::source::Span;
use crate::syntax::ast;

impl Body<'_, '_> {
    /// A call of a function that prints: the numbers in its message are those at its execution.
    pub(super) fn printing(
        &mut self,
        arguments: &ast::Arguments,
        span: Span,
    ) -> Result<(), Diagnostic> {
        if self.instances.silent {
            return Ok(());
        }
        self.emitter.place(span);
        self.emitter.open();
        let file = message_text(&mut self.lowering(), nth(arguments, 1, "fileName"));
        if file.contains(UNKNOWN_TEXT) {
            return Err(
                fault!(NOT_SUPPORTED, "the name of the file must be known at translation").at(span)
            );
        }
        let mut parts = vec![self.slot(Lowered::Text(file.into()), None, span)?];
        let text = message_parts(&mut self.with_known_strings(), nth(arguments, 0, "string"));
        parts.extend(self.slots(&text));
        let call = ExternalCall::new(&PRINT, parts, None);
        let external = self.emitter.external(call);
        self.emitter.emit(Instruction::External { external });
        self.emitter.close();
        Ok(())
    }

    /// Warns with a text unless a condition holds.
    pub(super) fn warn_unless(&mut self, condition: Operand, text: Option<&ast::Expression>) {
        let known = message_text(&mut self.with_known_strings(), text);
        let (a, message) = (self.emitter.register(condition), self.emitter.message(known.into()));
        self.emitter.emit(Instruction::Warn { a, message });
    }

    /// Ends the simulation with a text unless a condition holds; the text is put together only then.
    pub(super) fn fail_unless(
        &mut self,
        condition: Operand,
        text: Option<&ast::Expression>,
        span: Span,
    ) -> Result<(), Diagnostic> {
        let known = message_text(&mut self.with_known_strings(), text);
        let a = self.emitter.register(condition);
        if !known.contains(UNKNOWN_TEXT) {
            let message = self.emitter.message(known.into());
            self.emitter.emit(Instruction::Assert { a, message });
            return Ok(());
        }
        self.emitter.open();
        let fails = self.emitter.block(1);
        self.emitter.emit(Operation::unary(Operator::Not, fails, a).into());
        let holds = self.emitter.jump_unless(Operand::Register(fails));
        let parts = message_parts(&mut self.with_known_strings(), text);
        let mut arguments = vec![self.slot(Lowered::Text(known.into()), None, span)?];
        arguments.extend(self.slots(&parts));
        let external = self.emitter.external(ExternalCall::new(&FAIL, arguments, None));
        self.emitter.emit(Instruction::External { external });
        self.emitter.land(holds);
        self.emitter.close();
        Ok(())
    }
}
