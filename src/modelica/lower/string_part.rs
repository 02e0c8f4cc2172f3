//! Strings in parts, some of which are known only during the simulation. Data only.

use std::sync::Arc;

/// A part of a text, with scalars of a kind.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub enum StringPart<S> {
    /// A text that is known at translation.
    Text(Arc<str>),
    /// A text by its number; in a call that writes, the call.
    Numbered(S),
    /// A value as `String` writes it: its row without the format, and the format, if there is one
    /// (see [`written`](crate::value::format::written)).
    Written(Vec<S>, Option<Arc<str>>),
}

impl<S> StringPart<S> {
    /// The scalars in it.
    pub fn scalars(&self) -> &[S] {
        match self {
            StringPart::Text(_) => &[],
            StringPart::Numbered(number) => std::slice::from_ref(number),
            StringPart::Written(row, _) => row,
        }
    }

    /// The same, to be changed.
    pub(crate) fn scalars_mut(&mut self) -> &mut [S] {
        match self {
            StringPart::Text(_) => &mut [],
            StringPart::Numbered(number) => std::slice::from_mut(number),
            StringPart::Written(row, _) => row,
        }
    }
}
