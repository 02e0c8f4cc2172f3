//! Walks over trees: [`Visit`] reads, [`Rewrite`] changes in place.
//!
//! A method's default visits the parts through the function `walk_…` or `rewrite_…` of the
//! same name; an implementation that overrides it calls that function to continue.

mod read;
mod rewrite;

pub use read::{
    Visit, walk_equation, walk_expression, walk_modification, walk_reference, walk_statement,
};

pub(crate) use read::walk_arguments;
pub use rewrite::{
    Rewrite, rewrite_class, rewrite_equation, rewrite_expression, rewrite_reference,
    rewrite_script, rewrite_statement, rewrite_stored_definition,
};
pub(crate) use rewrite::{rewrite_arguments, rewrite_modification};

use crate::source::Span;

/// Replaces every place by [`Span::NONE`], so that trees compare by what they say.
#[derive(Debug, Clone, Copy, Default)]
pub struct WithoutSpans;

impl Rewrite for WithoutSpans {
    fn span(&mut self, span: &mut Span) {
        *span = Span::NONE;
    }
}
