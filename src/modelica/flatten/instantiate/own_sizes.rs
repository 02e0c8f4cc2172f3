//! A size of an array may be another one of the same array: `Real A[:, size(A, 1)]` (MLS §10.1).

use crate::name::Ident;
use crate::syntax::ast::{Expression, ExpressionKind};
use crate::syntax::visit::{Rewrite, rewrite_expression};
use std::borrow::Cow;

/// A size of the array `name` where the sizes before it are known: `size(name, k)` is replaced.
pub(crate) fn with_own_sizes<'e>(
    size: &'e Expression,
    name: Ident,
    before: &[usize],
) -> Cow<'e, Expression> {
    if before.is_empty() {
        return Cow::Borrowed(size);
    }
    let mut size = size.clone();
    OwnSizes { name, before }.expression(&mut size);
    Cow::Owned(size)
}

struct OwnSizes<'s> {
    name: Ident,
    before: &'s [usize],
}

impl OwnSizes<'_> {
    fn known(&self, e: &Expression) -> Option<usize> {
        let ExpressionKind::Call { function, arguments } = &e.kind else { return None };
        let [array, dimension] = arguments.positional.as_slice() else { return None };
        let (ExpressionKind::Reference(array), ExpressionKind::Integer(dimension)) =
            (&array.kind, &dimension.kind)
        else {
            return None;
        };
        let is_size = function.as_ident().is_some_and(|function| function == "size");
        let is_own = array.as_ident() == Some(self.name);
        let at = usize::try_from(*dimension).ok()?.checked_sub(1)?;
        self.before.get(at).copied().filter(|_| is_size && is_own)
    }
}

impl Rewrite for OwnSizes<'_> {
    fn expression(&mut self, e: &mut Expression) {
        match self.known(e) {
            Some(size) => e.kind = ExpressionKind::Integer(size as i64),
            None => rewrite_expression(self, e),
        }
    }
}
