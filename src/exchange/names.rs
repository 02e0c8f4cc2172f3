//! Names of Modelica: legal ones are kept, others become quoted identifiers (MLS §2.3.1).

use std::collections::BTreeSet;

/// Reserved words (MLS §2.3.3), predefined types, and functions that expressions here call.
const TAKEN: &[&str] = &[
    "algorithm",
    "and",
    "annotation",
    "block",
    "break",
    "class",
    "connect",
    "connector",
    "constant",
    "constrainedby",
    "der",
    "discrete",
    "each",
    "else",
    "elseif",
    "elsewhen",
    "encapsulated",
    "end",
    "enumeration",
    "equation",
    "expandable",
    "extends",
    "external",
    "false",
    "final",
    "flow",
    "for",
    "function",
    "if",
    "import",
    "impure",
    "in",
    "initial",
    "inner",
    "input",
    "loop",
    "model",
    "not",
    "operator",
    "or",
    "outer",
    "output",
    "package",
    "parameter",
    "partial",
    "protected",
    "public",
    "pure",
    "record",
    "redeclare",
    "replaceable",
    "return",
    "stream",
    "then",
    "true",
    "type",
    "when",
    "while",
    "within",
    "Real",
    "Integer",
    "Boolean",
    "String",
    "Clock",
    "StateSelect",
    "Modelica",
    "time",
    "abs",
    "sign",
    "sqrt",
    "exp",
    "log",
    "log10",
    "sin",
    "cos",
    "tan",
    "asin",
    "acos",
    "atan",
    "atan2",
    "sinh",
    "cosh",
    "tanh",
    "floor",
    "ceil",
    "integer",
    "div",
    "mod",
    "rem",
    "min",
    "max",
    "delay",
    "edge",
    "pre",
    "reinit",
    "change",
    "sample",
    "terminal",
    "noEvent",
    "smooth",
    "assert",
    "terminate",
    "sum",
    "product",
    "size",
    "ones",
    "zeros",
    "fill",
    "homotopy",
    "semiLinear",
    "cross",
    "skew",
    "identity",
    "diagonal",
    "transpose",
    "scalar",
    "vector",
    "matrix",
    "cat",
    "promote",
    "ndims",
    "cardinality",
    "getInstanceName",
    "spatialDistribution",
    "previous",
    "hold",
    "interval",
    "firstTick",
    "Connections",
    "inStream",
    "actualStream",
];

/// The name as Modelica has it.
pub(crate) fn identifier(name: &str) -> String {
    let starts = name.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_');
    let is_plain = starts && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
    if is_plain && !TAKEN.contains(&name) {
        return name.to_owned();
    }
    let escaped: String = name
        .chars()
        .flat_map(|c| match c {
            '\'' | '\\' => vec!['\\', c],
            // Quoted identifiers have printable ASCII only.
            c if c.is_ascii_graphic() || c == ' ' => vec![c],
            _ => vec!['_'],
        })
        .collect();
    format!("'{escaped}'")
}

/// A string in quotation marks.
pub(crate) fn quoted(text: &str) -> String {
    let words: Vec<&str> = text.split_whitespace().collect();
    format!("\"{}\"", words.join(" ").replace('\\', "\\\\").replace('"', "\\\""))
}

/// Names that are in use.
#[derive(Debug, Clone, Default)]
pub(crate) struct Names(BTreeSet<String>);

impl Names {
    /// Takes the name; another with a number where it is in use.
    pub(crate) fn fresh(&mut self, name: &str) -> String {
        let numbered = (2..).map(|k| format!("{name}_{k}"));
        let free = std::iter::once(name.to_owned()).chain(numbered).find(|n| !self.0.contains(n));
        let free = free.unwrap_or_else(|| unreachable!("the numbers do not end"));
        self.0.insert(free.clone());
        free
    }
}
