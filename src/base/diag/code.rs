//! Diagnostic codes: slugs with their explanations.

use crate::name::Ident;

/// What kind of fault a diagnostic reports. Declared with [`codes!`](crate::codes) in the
/// `errors.rs` of the stage that finds it.
#[derive(Debug, Clone, Copy)]
pub struct Code {
    /// The name shown in brackets and accepted by `gapi explain`, such as `unknown-class`.
    pub slug: &'static str,
    /// Markdown under the headings *What it means*, *Example*, *What to do*.
    pub explanation: &'static str,
}

/// In a file a code is its name. One that was read has no explanation, which is looked up by the
/// name.
impl serde::Serialize for Code {
    fn serialize<S: serde::Serializer>(&self, target: S) -> Result<S::Ok, S::Error> {
        self.slug.serialize(target)
    }
}

impl<'de> serde::Deserialize<'de> for Code {
    fn deserialize<D: serde::Deserializer<'de>>(source: D) -> Result<Code, D::Error> {
        let slug = Ident::deserialize(source)?.as_str();
        Ok(Code { slug, explanation: "" })
    }
}

impl PartialEq for Code {
    fn eq(&self, other: &Code) -> bool {
        self.slug == other.slug
    }
}

impl Eq for Code {}

/// Declares the codes of one stage and their table `CODES`.
///
/// ```ignore
/// codes! {
///     /// A name that nothing declares.
///     UNKNOWN_CLASS = "unknown-class": "What it means: …\n\nExample: …\n\nWhat to do: …",
/// }
/// ```
#[macro_export]
macro_rules! codes {
    ($($(#[$doc:meta])* $name:ident = $slug:literal : $explanation:expr,)*) => {
        $($(#[$doc])* pub const $name: $crate::diag::Code =
            $crate::diag::Code { slug: $slug, explanation: $explanation };)*
        /// All codes of this stage.
        pub const CODES: &[$crate::diag::Code] = &[$($name),*];
    };
}
