//! `print`, which OpenModelica has without a class that declares it: in models, too.

use crate::eval::{Function, FunctionBody, FunctionComponent, ValueType};
use crate::flatten::instantiate::instantiation::Instantiation;
use crate::name::{Ident, Name};
use crate::source::{Span, Spanned};
use crate::syntax::ast::{ComponentReference, Expression, ExpressionKind, External};
use std::sync::Arc;

/// Its name.
pub(crate) const PRINT: &str = "print";

/// Its input.
const TEXT: &str = "string";

/// The external function that takes a text for the user.
const MESSAGE: &str = "ModelicaMessage";

impl Instantiation<'_> {
    /// The name under which the functions of the model have `print`.
    pub(crate) fn bare_print(&mut self) -> Name {
        let name = Name::parse(PRINT);
        let table = &mut self.functions.table;
        table.entry(name.clone()).or_insert_with(|| Some(Arc::new(declaration())));
        name
    }
}

/// `impure function print input String string; external "C" ModelicaMessage(string); end print;`
fn declaration() -> Function {
    let text = Ident::new(TEXT);
    let reference = ComponentReference::from_name(&Name::from(text), Span::NONE);
    let input = FunctionComponent {
        name: text,
        value_type: ValueType::String,
        dims: Vec::new(),
        field_dims: Vec::new(),
        binding: None,
        description: None,
        span: Span::NONE,
    };
    let clause = External {
        language: Some("C".into()),
        output: None,
        function: Some(Spanned { node: Ident::new(MESSAGE), span: Span::NONE }),
        arguments: vec![Expression::new(ExpressionKind::Reference(reference), Span::NONE)],
        annotation: None,
        span: Span::NONE,
    };
    Function {
        name: Name::parse(PRINT),
        inputs: vec![input],
        outputs: Vec::new(),
        locals: Vec::new(),
        body: FunctionBody::External(clause),
        description: None,
        annotation: Vec::new(),
        impure: true,
        span: Span::NONE,
    }
}
