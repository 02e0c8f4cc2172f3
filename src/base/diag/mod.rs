//! Diagnostics: what went wrong, where, and what to do about it.
//!
//! An operation that knows no place returns a [`Fault`]; a caller that knows the place makes a
//! [`Diagnostic`] of it with [`At::at`]. Nothing here prints: [`render`] makes text.

mod code;
mod excerpt;
pub mod render;
mod shorten;
pub mod suggest;
mod visible;

pub use code::Code;
pub use shorten::shortened;
pub use visible::{visible, visible_coloured, visible_line};

use crate::source::Span;

/// How bad it is.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, serde::Serialize, serde::Deserialize,
)]
pub enum Severity {
    /// Worth knowing, nothing is wrong.
    Note,
    /// The work continues; the result may not be what was meant.
    Warning,
    /// The work named could not be done.
    Error,
}

/// A place and what is to be said about it.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Label {
    /// The place.
    pub span: Span,
    /// Few words; may be empty.
    pub text: String,
    /// Whether this is where the fault is, rather than something related.
    pub primary: bool,
}

/// One step of the way from the outermost script to the fault.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Frame {
    /// Where the call is written.
    pub span: Span,
    /// What was called, such as ``script `GAPILib_INI.mos` `` or ``function `Fit` ``.
    pub what: String,
}

/// A fault without a place: what an operation returns.
///
/// ```
/// use gapilib_base::diag::Fault;
/// use gapilib_base::registry::BAD_OPTION;
/// use gapilib_base::source::{SourceMap, Span};
///
/// let fault = Fault::new(BAD_OPTION, "`x` is not positive").help("give a larger `x`");
/// let sources = SourceMap::default();
/// let source = sources.add("input.mos", "f(x = -1)");
/// let diagnostic = fault.at(Span::new(source, 6, 8));
/// assert!(diagnostic.is_error());
/// assert_eq!(sources.text(diagnostic.span()), "-1");
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fault {
    /// Its kind.
    pub code: Code,
    /// One sentence, lower case, no final stop, Modelica names in backticks.
    pub message: String,
    /// Actions, each one sentence.
    pub helps: Vec<String>,
}

/// A fault with its place: what a stage returns and what the user sees. Boxed inside, so that
/// `Result<T, Diagnostic>` stays small.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Diagnostic(Box<Report>);

/// The content of a [`Diagnostic`].
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Report {
    /// Its kind.
    pub code: Code,
    /// How bad it is.
    pub severity: Severity,
    /// One sentence that is enough by itself.
    pub message: String,
    /// Places, the primary one first.
    pub labels: Vec<Label>,
    /// Actions, each one sentence.
    pub helps: Vec<String>,
    /// The calls that led here, innermost first.
    pub trace: Vec<Frame>,
}

impl Fault {
    /// A fault with this code and message.
    pub fn new(code: Code, message: impl Into<String>) -> Fault {
        Fault { code, message: message.into(), helps: Vec::new() }
    }

    /// Adds an action.
    #[must_use]
    pub fn help(mut self, help: impl Into<String>) -> Fault {
        self.helps.push(help.into());
        self
    }

    /// Adds an action if there is one.
    #[must_use]
    pub fn help_if(mut self, help: Option<String>) -> Fault {
        self.helps.extend(help);
        self
    }

    /// Gives the fault its place.
    pub fn at(self, span: Span) -> Diagnostic {
        self.labelled(span, "")
    }

    /// Gives the fault its place and says a few words there.
    pub fn labelled(self, span: Span, text: impl Into<String>) -> Diagnostic {
        Diagnostic(Box::new(Report {
            code: self.code,
            severity: Severity::Error,
            message: self.message,
            labels: vec![Label { span, text: text.into(), primary: true }],
            helps: self.helps,
            trace: Vec::new(),
        }))
    }
}

impl std::fmt::Display for Fault {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for Fault {}

impl Diagnostic {
    /// The same as a warning.
    #[must_use]
    pub fn warning(mut self) -> Diagnostic {
        self.0.severity = Severity::Warning;
        self
    }

    /// The same as an error.
    #[must_use]
    pub fn error(mut self) -> Diagnostic {
        self.0.severity = Severity::Error;
        self
    }

    /// The same as a note.
    #[must_use]
    pub fn note(mut self) -> Diagnostic {
        self.0.severity = Severity::Note;
        self
    }

    /// The same at other places.
    #[must_use]
    pub fn with_spans(mut self, change: impl Fn(Span) -> Span) -> Diagnostic {
        self.0.labels.iter_mut().for_each(|label| label.span = change(label.span));
        self
    }

    /// The same in other words: its message, the words at its places, and its actions.
    #[must_use]
    pub fn with_words(mut self, change: impl Fn(&str) -> String) -> Diagnostic {
        let Report { message, labels, helps, .. } = &mut *self.0;
        *message = change(message);
        labels.iter_mut().for_each(|label| label.text = change(&label.text));
        helps.iter_mut().for_each(|help| *help = change(help));
        self
    }

    /// The same with another message.
    #[must_use]
    pub fn reworded(mut self, message: String) -> Diagnostic {
        self.0.message = message;
        self
    }

    /// The same with this place where it has none.
    #[must_use]
    pub fn or_at(self, span: Span) -> Diagnostic {
        self.with_spans(|known| if known.is_known() { known } else { span })
    }

    /// The same at this place alone.
    #[must_use]
    pub fn moved_to(mut self, span: Span) -> Diagnostic {
        self.0.labels = vec![Label { span, text: String::new(), primary: true }];
        self
    }

    /// The same at this place; where it was before is related, in these words unless it has its own.
    #[must_use]
    pub fn seen_from(mut self, span: Span, words: &str) -> Diagnostic {
        for label in &mut self.0.labels {
            label.primary = false;
            if label.text.is_empty() {
                words.clone_into(&mut label.text);
            }
        }
        self.0.labels.insert(0, Label { span, text: String::new(), primary: true });
        self
    }

    /// Adds an action.
    #[must_use]
    pub fn help(mut self, help: impl Into<String>) -> Diagnostic {
        self.0.helps.push(help.into());
        self
    }

    /// The same with this action in place of all others.
    #[must_use]
    pub fn with_only_help(mut self, help: impl Into<String>) -> Diagnostic {
        self.0.helps = vec![help.into()];
        self
    }

    /// Adds a related place.
    #[must_use]
    pub fn related(mut self, span: Span, text: impl Into<String>) -> Diagnostic {
        self.0.labels.push(Label { span, text: text.into(), primary: false });
        self
    }

    /// Adds why another way failed too, unless it failed for the same reason.
    #[must_use]
    pub fn or_else(self, tried: &str, other: &Diagnostic) -> Diagnostic {
        match self.message == other.message {
            true => self,
            false => self.related(other.span(), format!("{tried}: {}", other.message)),
        }
    }

    /// Adds the next outer call.
    #[must_use]
    pub fn called_from(mut self, span: Span, what: impl Into<String>) -> Diagnostic {
        self.0.trace.push(Frame { span, what: what.into() });
        self
    }

    /// Where the fault is; [`Span::NONE`] if nowhere.
    pub fn span(&self) -> Span {
        self.0.labels.first().map_or(Span::NONE, |label| label.span)
    }

    /// Whether it is an error.
    pub fn is_error(&self) -> bool {
        self.0.severity == Severity::Error
    }
}

impl std::ops::Deref for Diagnostic {
    type Target = Report;
    fn deref(&self) -> &Report {
        &self.0
    }
}

impl std::fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for Diagnostic {}

/// Gives the error of a result its place.
pub trait At<T> {
    /// `Err(fault)` becomes `Err(fault.at(span))`.
    fn at(self, span: Span) -> Result<T, Diagnostic>;
}

impl<T> At<T> for Result<T, Fault> {
    fn at(self, span: Span) -> Result<T, Diagnostic> {
        self.map_err(|fault| fault.at(span))
    }
}

/// Makes a [`Fault`]: `fault!(CODE, "cannot add {a} and {b}"; help: "…")`.
#[macro_export]
macro_rules! fault {
    ($code:expr, $($message:expr),+ $(; help: $($help:expr),+)* $(;)?) => {
        $crate::diag::Fault::new($code, format!($($message),+))$(.help(format!($($help),+)))*
    };
}

/// Returns a [`Fault`] as an error: `bail!(CODE, "…"; help: "…")`.
#[macro_export]
macro_rules! bail {
    ($($arguments:tt)*) => {
        return Err($crate::fault!($($arguments)*).into())
    };
}
