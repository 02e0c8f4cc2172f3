//! What is wrong, as Python's exception with its place and what to do.

use gapilib::internals::diag::render::render;
use gapilib::internals::source::{SourceMap, Span};
use gapilib::{Diagnostic, Fault, Severity};
use pyo3::create_exception;
use pyo3::exceptions::PyException;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

create_exception!(
    gapilib,
    GapilibError,
    PyException,
    "What is wrong with a script, a model, a problem or a simulation.\n\n\
     `str(error)` shows each diagnostic with its place and what to do; `error.diagnostics` is a list \
     of dicts with the keys severity, code, message, file, line, column, helps and text; \
     `error.code` is the code of the first error. Where a simulation has failed, `error.result` has \
     what was computed until then, or None."
);

/// A diagnostic apart from the session that has the text.
#[derive(Debug, Clone)]
pub(crate) struct Reported {
    severity: &'static str,
    code: String,
    message: String,
    /// File, line and column, from 1.
    place: Option<(String, usize, usize)>,
    helps: Vec<String>,
    text: String,
}

impl Reported {
    /// A diagnostic, with the sources that it points into.
    pub(crate) fn new(diagnostic: &Diagnostic, sources: &SourceMap) -> Reported {
        let span = diagnostic.span();
        let place = sources
            .line_column(span)
            .zip(sources.get(span.source))
            .map(|(place, source)| (source.name.to_string(), place.line, place.column));
        Reported {
            severity: match diagnostic.severity {
                Severity::Note => "note",
                Severity::Warning => "warning",
                Severity::Error => "error",
            },
            code: diagnostic.code.slug.to_owned(),
            message: diagnostic.message.clone(),
            place,
            helps: diagnostic.helps.clone(),
            text: render(diagnostic, sources, false),
        }
    }

    /// A fault without a place.
    pub(crate) fn fault(fault: Fault) -> Reported {
        Reported::new(&fault.at(Span::NONE), &SourceMap::default())
    }

    /// What refuses the folder of results.
    pub(crate) fn refusal(error: &std::io::Error) -> Reported {
        let code = gapilib::internals::registry::BAD_OPTION;
        let text = error.to_string();
        let (message, help) = text.split_once("\n = help: ").unwrap_or((&text, ""));
        let fault = Fault::new(code, message.to_owned());
        Reported::fault(if help.is_empty() { fault } else { fault.help(help.to_owned()) })
    }

    /// With the arguments of Python in place of the options of the command line.
    pub(crate) fn in_python(mut self) -> Reported {
        let options = [
            ("`--resume`", "`resume=True`"),
            ("`--fresh`", "`fresh=True`"),
            ("`--overwrite`", "`overwrite=True`"),
            ("`--out`", "`out`"),
        ];
        let helps = self.helps.iter_mut();
        for own in [&mut self.message, &mut self.text].into_iter().chain(helps) {
            for (option, argument) in options {
                *own = own.replace(option, argument);
            }
        }
        self
    }

    pub(crate) fn is_error(&self) -> bool {
        self.severity == "error"
    }

    /// As Python sees it.
    pub(crate) fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let dict = PyDict::new(py);
        dict.set_item("severity", self.severity)?;
        dict.set_item("code", &self.code)?;
        dict.set_item("message", &self.message)?;
        let (file, line, column) = match &self.place {
            Some((file, line, column)) => (Some(file), Some(line), Some(column)),
            None => (None, None, None),
        };
        dict.set_item("file", file)?;
        dict.set_item("line", line)?;
        dict.set_item("column", column)?;
        dict.set_item("helps", &self.helps)?;
        dict.set_item("text", &self.text)?;
        Ok(dict)
    }
}

/// Several diagnostics, of one session.
pub(crate) fn reported(diagnostics: &[Diagnostic], sources: &SourceMap) -> Vec<Reported> {
    diagnostics.iter().map(|diagnostic| Reported::new(diagnostic, sources)).collect()
}

/// The exception for these diagnostics.
pub(crate) fn raised(py: Python<'_>, reported: &[Reported]) -> PyErr {
    let errors = reported.iter().filter(|one| one.is_error());
    let shown: Vec<&str> = errors.map(|one| one.text.trim_end()).collect();
    let error = GapilibError::new_err(shown.join("\n"));
    // Without its details the exception says all the same what is wrong.
    let _ = detailed(py, &error, reported);
    error
}

fn detailed(py: Python<'_>, error: &PyErr, reported: &[Reported]) -> PyResult<()> {
    let list = PyList::empty(py);
    for one in reported {
        list.append(one.to_dict(py)?)?;
    }
    let value = error.value(py);
    value.setattr("diagnostics", list)?;
    let first = reported.iter().find(|one| one.is_error()).or(reported.first());
    value.setattr("code", first.map_or("", |one| &one.code))
}

/// The exception for a fault without a place.
pub(crate) fn raised_fault(py: Python<'_>, fault: Fault) -> PyErr {
    raised(py, &[Reported::fault(fault)])
}
