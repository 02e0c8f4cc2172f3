//! Functions that print, called in functions being compiled: their texts may have numbers in them
//! that are known when the simulation gets there.

use super::emitter::Operand;
use super::statements::{Body, Loops};
use crate::bytecode::{ExternalCall, Instruction};
use crate::diag::{Diagnostic, Fault};
use crate::eval::ValueType;
use crate::external::{Call, Entry, Kind, Slot};
use crate::fault;
use crate::lower::errors::NOT_SUPPORTED;
use crate::lower::expressions::{Lowered, Target, message_text};
use crate::lower::message::nth;
use crate::lower::shape::UNKNOWN_TEXT;
use crate::source::Span;
use crate::syntax::ast;
use crate::value::Value;
use crate::value::format::{formatted, text};

/// `ModelicaInternal_print` with a text in parts, of which some are numbers: the file, then the parts.
/// A number is its value, whether it is a Real (0), an Integer (1) or a Boolean (2), and how `String`
/// writes it: significant digits, minimum length, left justified; or its value and type, and its
/// format as the next part.
static TELL: Entry = Entry::writing("ModelicaInternal_print", "", tell);

/// As `String` writes numbers (MLS §3.7.1).
const DEFAULTS: [(&str, f64); 3] =
    [("significantDigits", 6.0), ("minimumLength", 0.0), ("leftJustified", 1.0)];

fn tell(call: &mut Call<'_>) -> Result<(), Fault> {
    let mut words = String::new();
    let mut parts = call.arguments[1..].iter();
    while let Some(slot) = parts.next() {
        let first = slot.first as usize;
        let value = |number: f64, which: f64| match which as i64 {
            1 => Value::Integer(number as i64),
            2 => Value::Boolean(number != 0.0),
            _ => Value::Real(number),
        };
        match (slot.kind, &*slot.dims) {
            (Kind::Text, _) => words += &call.strings[first],
            (Kind::Number | Kind::Object, [2]) => {
                let format = parts.next().map_or("", |s| &call.strings[s.first as usize]);
                let row = &call.numbers[first..first + 2];
                words += &formatted(&value(row[0], row[1]), format)?;
            }
            (Kind::Number | Kind::Object, _) => {
                let row = &call.numbers[first..first + 5];
                let value = value(row[0], row[1]);
                words += &text(&value, row[2] as i64, row[3] as i64, row[4] != 0.0)?;
            }
        }
    }
    match &*call.strings[call.arguments[0].first as usize].clone() {
        "" => call.outside.print(words.trim_end_matches('\n')),
        path => call.outside.append(path, format!("{words}\n").as_bytes()),
    }
}

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
        if text.contains(UNKNOWN_TEXT)
            && let Some(arguments) = arguments_of_string(e)
            && self.parts_of_number(arguments, loops, parts)?
        {
            return Ok(());
        }
        parts.push(self.slot(Lowered::Text(text.into()), None, e.span)?);
        Ok(())
    }

    /// `String(x, …)` of a number that is not known yet; false if it is none.
    fn parts_of_number(
        &mut self,
        arguments: &ast::Arguments,
        loops: &Loops,
        parts: &mut Vec<Slot>,
    ) -> Result<bool, Diagnostic> {
        let argument = &arguments.positional[0];
        let which = match self.type_of(argument, loops) {
            ValueType::Real => 0.0,
            ValueType::Integer => 1.0,
            ValueType::Boolean => 2.0,
            _ => return Ok(false),
        };
        let Ok(number) = self.lowering(loops).scalar(argument) else { return Ok(false) };
        let mut row = vec![number, Operand::Constant(which)];
        let format = nth(arguments, 1, "format");
        if format.is_none() {
            for (name, default) in DEFAULTS {
                let named = arguments.named.iter().find(|a| a.name.node == name);
                let given = named.map(|a| self.lowering(loops).scalar(&a.value)).transpose()?;
                row.push(given.unwrap_or(Operand::Constant(default)));
            }
        }
        let first = self.emitter.copies(&row);
        parts.push(Slot { kind: Kind::Number, first, dims: Box::new([row.len() as u32]) });
        if let Some(format) = format {
            let text = message_text(&mut self.lowering(loops), Some(format));
            parts.push(self.slot(Lowered::Text(text.into()), None, format.span)?);
        }
        Ok(true)
    }

    /// The type of a number in a text: that of its variable, Real for other expressions.
    fn type_of(&mut self, e: &ast::Expression, loops: &Loops) -> ValueType {
        let ast::ExpressionKind::Reference(reference) = &e.kind else { return ValueType::Real };
        if reference.as_ident().is_some_and(|name| loops.iter().any(|(own, _)| *own == name)) {
            return ValueType::Integer;
        }
        let mut lowering = self.lowering(loops);
        let path = lowering.path(reference).ok();
        path.and_then(|path| lowering.target.value_type(&path)).unwrap_or(ValueType::Real)
    }
}
