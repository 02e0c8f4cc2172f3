//! Where a loop variable without a range is used as a subscript: the sizes of these arrays are its
//! range (MLS §11.2.2.1).

use crate::name::Ident;
use crate::syntax::ast::{
    ComponentReference, Expression, ExpressionKind, ReferencePart, Subscript,
};
use crate::syntax::visit::{Visit, walk_reference};

/// `array[…, i, …]` with `i` as subscript number `dimension`, counted from 0.
pub(crate) struct SubscriptUse {
    /// The array without this and later subscripts.
    pub(crate) array: ComponentReference,
    /// The dimension.
    pub(crate) dimension: usize,
}

/// All subscripts that are exactly the variable `name`, in what `visit` looks through.
pub(crate) fn subscript_uses(name: Ident, visit: &dyn Fn(&mut dyn Visit)) -> Vec<SubscriptUse> {
    let mut search = SubscriptSearch { name, found: Vec::new() };
    visit(&mut search);
    search.found
}

struct SubscriptSearch {
    name: Ident,
    found: Vec<SubscriptUse>,
}

impl Visit for SubscriptSearch {
    fn reference(&mut self, reference: &ComponentReference) {
        for (at, part) in reference.parts.iter().enumerate() {
            for (dimension, subscript) in part.subscripts.iter().enumerate() {
                if self.is_variable(subscript) {
                    self.found.push(SubscriptUse { array: up_to(reference, at), dimension });
                }
            }
        }
        walk_reference(self, reference);
    }
}

impl SubscriptSearch {
    fn is_variable(&self, subscript: &Subscript) -> bool {
        match subscript {
            Subscript::Index(Expression { kind: ExpressionKind::Reference(reference), .. }) => {
                reference.as_ident() == Some(self.name)
            }
            _ => false,
        }
    }
}

/// `a[1].b` of `a[1].b[i].c` for the part `b`.
fn up_to(reference: &ComponentReference, part: usize) -> ComponentReference {
    let mut parts = reference.parts[..=part].to_vec();
    if let Some(last) = parts.last_mut() {
        *last = ReferencePart { name: last.name, subscripts: Vec::new() };
    }
    ComponentReference { global: reference.global, parts, span: reference.span }
}
