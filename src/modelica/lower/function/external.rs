//! External functions of [`external`](crate::external) in functions being compiled (MLS §12.9).

use super::emitter::Operand;
use super::external_kinds::is_object;
use super::instances::Instances;
use super::statements::Body;
use crate::bytecode::{ExternalCall, Instruction};
use crate::diag::{At, Diagnostic};
use crate::eval::{FunctionComponent, c_function};
use crate::external::{self, Entry, Kind, Slot};
use crate::fault;
use crate::lower::errors::NOT_SUPPORTED;
use crate::lower::expressions::Lowered;
use crate::lower::shape::UNKNOWN_TEXT;
use crate::source::Span;
use crate::syntax::ast;

impl Body<'_, '_> {
    /// The call that is the body of an external function.
    pub(super) fn external(&mut self, clause: &ast::External) -> Result<(), Diagnostic> {
        let function = self.function.clone();
        let entry = match c_function::in_rust(&function, clause) {
            Some(entry) => entry,
            None => {
                let others = self.flat.functions.values();
                let resources = &mut self.flat.resources.clone();
                c_function::in_c(&function, clause, others, resources)?
            }
        };
        let clause = &*c_function::call_of(&function, clause);
        self.emitter.place(clause.span);
        self.emitter.open();
        let mut arguments = Vec::with_capacity(clause.arguments.len());
        for argument in &clause.arguments {
            let value = self.lowering(&Vec::new()).lower(argument)?;
            let component = match &argument.kind {
                ast::ExpressionKind::Reference(reference) => reference.as_ident(),
                _ => None,
            };
            let component = component.and_then(|name| {
                let mut all =
                    function.inputs.iter().chain(&function.outputs).chain(&function.locals);
                all.find(|component| component.name == name)
            });
            arguments.push(self.slot(value, component, argument.span)?);
        }
        let output = clause.output.as_ref().and_then(|output| output.as_ident());
        let result = match function.outputs.iter().find(|c| Some(c.name) == output) {
            Some(output) => {
                let value = self.local(&[output.name]).cloned();
                let value = value.unwrap_or(Lowered::Text("".into()));
                Some(self.slot(value, Some(output), clause.span)?)
            }
            None => None,
        };
        self.refuse_unknown_files(entry, &arguments, clause.span)?;
        entry.check(&arguments, result.as_ref()).at(clause.span)?;
        self.keep_files(entry, &arguments, clause.span)?;
        let external = self.emitter.external(ExternalCall::new(entry, arguments, result));
        self.emitter.emit(Instruction::External { external });
        self.emitter.close();
        Ok(())
    }

    /// The files that a function reads are kept with the model, so that their names must be known.
    fn refuse_unknown_files(
        &self,
        entry: &Entry,
        arguments: &[Slot],
        span: Span,
    ) -> Result<(), Diagnostic> {
        let is_known = |at: usize| arguments.get(at).is_none_or(|slot| slot.kind != Kind::Numbered);
        match entry.files().all(is_known) {
            true => Ok(()),
            false => Err(fault!(
                NOT_SUPPORTED,
                "the name of the file that `{}` reads must be known at translation",
                self.function.name
            )
            .at(span)),
        }
    }

    /// Keeps the files that a function reads.
    fn keep_files(
        &mut self,
        entry: &Entry,
        arguments: &[Slot],
        span: Span,
    ) -> Result<(), Diagnostic> {
        let Instances { functions, .. } = &mut *self.instances;
        for argument in entry.files() {
            let name = self.emitter.text_at(arguments[argument].first);
            if external::names_a_file(&name) {
                functions.files.keep(&name, &self.flat.resources).at(span)?;
            }
        }
        let is_known = |argument: &usize| arguments[*argument].kind == Kind::Text;
        for argument in entry.possible_files().filter(is_known) {
            let name = self.emitter.text_at(arguments[argument].first);
            // Whoever needs the file says that it is not there.
            let _ = functions.files.keep(&name, &self.flat.resources);
        }
        Ok(())
    }

    /// Where an argument stands: the registers of a component itself, which the call may write to.
    pub(super) fn slot(
        &mut self,
        value: Lowered<Operand>,
        component: Option<&FunctionComponent>,
        span: Span,
    ) -> Result<Slot, Diagnostic> {
        match value {
            Lowered::Text(text) => {
                let first = self.emitter.text(text);
                Ok(Slot { kind: Kind::Text, first, dims: Box::new([]) })
            }
            Lowered::Array(array) => {
                let kind = match component.is_some_and(is_object) {
                    true => Kind::Object,
                    false => Kind::Number,
                };
                let first = self.emitter.row(&array.elements);
                let dims = array.dims.iter().map(|size| *size as u32).collect();
                Ok(Slot { kind, first, dims })
            }
            Lowered::Record(_) => {
                Err(fault!(NOT_SUPPORTED, "a record as argument of an external function").at(span))
            }
            Lowered::Texts(texts) => {
                if texts.texts.iter().any(|text| text.contains(UNKNOWN_TEXT)) {
                    return Err(fault!(
                        NOT_SUPPORTED,
                        "Strings that are not known at translation, as argument of an external \
                         function"
                    )
                    .at(span));
                }
                // They stand in a row.
                let positions: Vec<u32> =
                    texts.texts.iter().map(|text| self.emitter.text(text.clone())).collect();
                let first = positions.first().copied().unwrap_or(0);
                let dims = texts.dims.iter().map(|size| *size as u32).collect();
                Ok(Slot { kind: Kind::Text, first, dims })
            }
            Lowered::Numbered(number) => {
                let first = self.emitter.row(&[number]);
                Ok(Slot { kind: Kind::Numbered, first, dims: Box::new([]) })
            }
        }
    }
}
