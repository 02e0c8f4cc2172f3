//! Values as text: the one place where results become readable.

use super::format::general;
use super::{ArrayValue, Elements, RecordValue, Value};
use std::fmt::Write;

/// How values are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Style {
    /// `{a, b}`, matrices `[a, b;\nc, d]`, Reals exactly.
    Dymola,
    /// Nested braces, records over several lines, Reals exactly.
    OpenModelica,
    /// As [`Style::Dymola`] with six significant digits: for transcripts that tests compare.
    Transcript,
}

/// The value as text.
///
/// ```
/// use gapilib_modelica::value::{ArrayValue, Value, show::{Style, show}};
///
/// let matrix = Value::Array(ArrayValue::matrix(2, 2, vec![1.0, 0.1, 1e-7, -2.0]));
/// assert_eq!(show(&matrix, Style::Dymola), "[1.0, 0.1;\n1e-7, -2.0]");
/// assert_eq!(show(&matrix, Style::OpenModelica), "{{1.0, 0.1}, {1e-7, -2.0}}");
/// ```
pub fn show(value: &Value, style: Style) -> String {
    let mut writer = Writer { text: String::new(), style };
    writer.value(value);
    writer.text
}

/// The shortest decimal text that reads back as the same number, always with `.0` or an exponent.
pub fn real(value: f64) -> String {
    if value.is_nan() { "NaN".to_owned() } else { format!("{value:?}") }
}

/// Six significant digits, always with `.0` or an exponent.
pub fn six_digits(value: f64) -> String {
    let text = if value.is_nan() { "NaN".to_owned() } else { general(value, 6, false, false) };
    if value.is_finite() && !text.contains(['.', 'e']) { text + ".0" } else { text }
}

/// The text in quotes, quotes and backslashes escaped; line breaks too if `breaks`.
pub fn quoted(text: &str, breaks: bool) -> String {
    let mut quoted = String::with_capacity(text.len() + 2);
    quoted.push('"');
    for character in text.chars() {
        match character {
            '"' => quoted.push_str("\\\""),
            '\\' => quoted.push_str("\\\\"),
            '\n' if breaks => quoted.push_str("\\n"),
            '\r' if breaks => quoted.push_str("\\r"),
            '\t' if breaks => quoted.push_str("\\t"),
            other => quoted.push(other),
        }
    }
    quoted.push('"');
    quoted
}

struct Writer {
    text: String,
    style: Style,
}

impl Writer {
    fn value(&mut self, value: &Value) {
        match value {
            Value::Real(value) => self.real(*value),
            Value::Integer(value) => self.push(value),
            Value::Boolean(value) => self.push(value),
            Value::String(text) => self.string(text),
            Value::Enumeration(value) => self.push(value),
            Value::Array(array) => self.array(array),
            Value::Record(record) => self.record(record),
            Value::TypeName(name) => self.push(name),
            Value::VariableName(name) => self.push(name),
            Value::Function(function) => self.push(format_args!("function {}", function.name)),
            Value::External(object) => self.push(format_args!("object {}", object.class)),
            Value::Tuple(values) => self.outputs(values),
        }
    }

    fn push(&mut self, shown: impl std::fmt::Display) {
        // Writing to a String cannot fail.
        let _ = write!(self.text, "{shown}");
    }

    fn real(&mut self, value: f64) {
        let text = match self.style {
            Style::Transcript => six_digits(value),
            _ => real(value),
        };
        self.text.push_str(&text);
    }

    fn string(&mut self, text: &str) {
        let quoted = quoted(text, self.style != Style::OpenModelica);
        self.text.push_str(&quoted);
    }

    /// Several outputs; Dymola begins a new line for a matrix.
    fn outputs(&mut self, values: &[Value]) {
        for (at, value) in values.iter().enumerate() {
            if at > 0 {
                let on_new_line = value.rank() == 2 && self.style != Style::OpenModelica;
                self.text.push_str(if on_new_line { ", \n" } else { ", " });
            }
            self.value(value);
        }
    }

    fn separated<T>(
        &mut self,
        items: impl Iterator<Item = T>,
        mut write: impl FnMut(&mut Writer, T),
    ) {
        for (at, item) in items.enumerate() {
            if at > 0 {
                self.text.push_str(", ");
            }
            write(self, item);
        }
    }

    fn array(&mut self, array: &ArrayValue) {
        if self.style != Style::OpenModelica && array.elements.is_empty() && array.rank() > 1 {
            return self.empty(array);
        }
        self.dimension(&array.dims, &array.elements, 0);
    }

    /// Braces would lose the sizes of an array without elements.
    fn empty(&mut self, array: &ArrayValue) {
        let filler = match &array.elements {
            Elements::Real(_) => "0.0",
            Elements::Integer(_) => "0",
            Elements::Boolean(_) => "false",
            _ => "\"\"",
        };
        self.push(format_args!("fill({filler}"));
        for size in &array.dims {
            self.push(format_args!(", {size}"));
        }
        self.text.push(')');
    }

    /// The entries from offset `start` on, of an array with these (remaining) sizes.
    fn dimension(&mut self, dims: &[usize], elements: &Elements, start: usize) {
        match dims {
            [] => self.element(elements, start),
            [rows, columns] if self.style != Style::OpenModelica => {
                self.text.push('[');
                for row in 0..*rows {
                    if row > 0 {
                        self.text.push_str(";\n");
                    }
                    let first = start + row * columns;
                    self.separated(first..first + columns, |writer, at| {
                        writer.element(elements, at);
                    });
                }
                self.text.push(']');
            }
            [size, inner @ ..] => {
                let stride: usize = inner.iter().product();
                self.text.push('{');
                self.separated(0..*size, |writer, at| {
                    writer.dimension(inner, elements, start + at * stride);
                });
                self.text.push('}');
            }
        }
    }

    fn element(&mut self, elements: &Elements, at: usize) {
        match elements {
            Elements::Real(values) => self.real(values[at]),
            Elements::Integer(values) => self.push(values[at]),
            Elements::Boolean(values) => self.push(values[at]),
            Elements::String(values) => self.string(&values[at]),
            Elements::Enumeration(values) => self.push(&values[at]),
            Elements::Record(values) => self.record(&values[at]),
        }
    }

    fn record(&mut self, record: &RecordValue) {
        if self.style == Style::OpenModelica {
            return self.record_over_lines(record);
        }
        self.push(format_args!("{}(", record.type_name));
        self.separated(record.fields.iter(), |writer, (name, value)| {
            writer.push(format_args!("{name} = "));
            writer.value(value);
        });
        self.text.push(')');
    }

    fn record_over_lines(&mut self, record: &RecordValue) {
        self.push(format_args!("record {}\n", record.type_name));
        for (at, (name, value)) in record.fields.iter().enumerate() {
            self.push(format_args!("    {name} = "));
            self.value(value);
            self.text.push_str(if at + 1 < record.fields.len() { ",\n" } else { "\n" });
        }
        self.push(format_args!("end {};", record.type_name));
    }
}
