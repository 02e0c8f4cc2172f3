//! Elements of classes as names with dots see them.

use super::scope::Scope;
use crate::diag::Diagnostic;
use crate::fault;
use crate::flatten::errors::PROTECTED_ACCESS;
use crate::name::Ident;
use crate::source::Span;
use crate::syntax::ast::Visibility;

/// The diagnostic for a protected element of a class.
pub(crate) fn protected(name: Ident, class: Scope<'_>, span: Span) -> Diagnostic {
    fault!(PROTECTED_ACCESS, "`{name}` is protected in `{}`", class.name();
        help: "move the declaration before `protected`")
    .at(span)
}

/// An element of a class, as names with dots see it.
pub(crate) struct Found {
    pub visibility: Visibility,
    pub encapsulated: bool,
}

impl Found {
    /// A class whose file is another one than that of its package.
    pub(crate) fn in_own_file(class: Scope<'_>) -> Found {
        Found { visibility: Visibility::Public, encapsulated: class.definition().encapsulated }
    }
}

/// The element of a class, its own or inherited, among those written in its file.
pub(crate) fn element(class: Scope<'_>, name: Ident) -> Option<Found> {
    let declaring = class.library.declaring(class.class, name, true)?;
    own_element(class.of(declaring), name)
}

fn own_element(class: Scope<'_>, name: Ident) -> Option<Found> {
    if let Some((visibility, nested)) = class.class_element(name) {
        return Some(Found { visibility, encapsulated: nested.class.encapsulated });
    }
    let component = class.own_component(name)?;
    Some(Found { visibility: component.visibility, encapsulated: false })
}
