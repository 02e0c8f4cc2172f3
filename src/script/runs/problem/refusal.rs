//! What is said of a problem file that is not TOML, or has entries that a problem does not have: the
//! cause in the words of the file, and the remedy for what people write by habit.

use crate::Session;
use crate::access::faults::escape_help;
use crate::diag::{Diagnostic, Fault, suggest};
use crate::fault;
use crate::registry::BAD_OPTION;
use crate::results;
use crate::source::{SourceId, Span};
use std::path::Path;
use toml::{Table, Value};

/// What precedes the names of the entries that a table may have.
pub(super) const ENTRIES: &str = "the entries here are ";

/// Entries that people put a level too high, and where they belong.
const DEEPER: [(&str, &str); 6] = [
    (
        "interpolation",
        "an input: `inputs = { u = { column = \"u\", interpolation = \"linear\" } }`",
    ),
    ("sigma", "an output: `outputs = { T = { column = \"T\", sigma = 0.2 } }`"),
    ("error", "an output: `outputs = { T = { column = \"T\", error = \"lognormal\" } }`"),
    ("delay", "an output: `outputs = { T = { column = \"T\", delay = 5 } }`"),
    ("factor", "a column: `outputs = { U = { column = \"U_mV\", factor = 1e-3 } }`"),
    ("unit", "a column: `outputs = { T = { column = \"T\", unit = \"degC\" } }`"),
];
/// Entries above the first table in brackets.
const TOP: [&str; 9] = [
    "title",
    "model",
    "files",
    "fitness",
    "seed",
    "searches",
    "constraints",
    "bands",
    "prediction_steps",
];
/// Entries of an experiment, of which there may be several.
const OF_EXPERIMENTS: [&str; 6] = ["data", "x", "outputs", "inputs", "start", "stop_time"];

/// The error of the parser in the words of problem files.
pub(super) fn refusal(source: SourceId, text: &str, error: &toml::de::Error) -> Diagnostic {
    let range = error.span().unwrap_or(0..0);
    let span = Span::new(source, range.start, range.end);
    let message = error.message().lines().collect::<Vec<_>>().join("; ");
    let message = message.trim_end_matches('.');
    let place = Place { text, start: range.start.min(text.len()) };
    let fault = place
        .habit(message)
        .or_else(|| place.unknown_entry(message))
        .or_else(|| place.missing_entry(message))
        .unwrap_or_else(|| place.other_type(message));
    fault.at(span)
}

/// Names and titles are parts of reports, tables and pictures: a control character would reach the
/// terminal of the user who prints the file.
///
/// # Errors
/// A text has one that is no line break and no tab.
pub(super) fn printable(table: &Table) -> Result<(), Fault> {
    let is_control = |c: &char| c.is_control() && !matches!(c, '\n' | '\r' | '\t');
    let checked = |text: &str| match text.chars().find(is_control) {
        Some(c) => Err(fault!(
            BAD_OPTION,
            "the text {text:?} contains the control character U+{:04X}",
            u32::from(c)
        )
        .help(escape_help(Path::new(text)).unwrap_or_else(|| "remove it".to_owned()))),
        None => Ok(()),
    };
    let mut open: Vec<&Value> = Vec::new();
    let mut next = Some(table);
    loop {
        for (name, value) in next.take().into_iter().flatten() {
            checked(name)?;
            open.push(value);
        }
        match open.pop() {
            None => return Ok(()),
            Some(Value::String(text)) => checked(text)?,
            Some(Value::Array(values)) => open.extend(values),
            Some(Value::Table(table)) => next = Some(table),
            Some(_) => {}
        }
    }
}

/// The error with the columns of the data that cannot be read, where outputs or their X are missing: a draft
/// leaves such columns out.
pub(super) fn with_unread_columns(
    session: &Session,
    path: &Path,
    text: &str,
    error: Diagnostic,
) -> Diagnostic {
    if !error.message.contains(MISSING_OUTPUTS) {
        return error;
    }
    let file: Table = text.parse().unwrap_or_default();
    let experiments = file.get("experiment").and_then(Value::as_array);
    let without = |own: &&Value| own.get("outputs").is_none();
    let data = experiments.into_iter().flatten().filter(without);
    let mut reasons = data.filter_map(|own| {
        let data = path.parent()?.join(own.get("data")?.as_str()?);
        let bytes = session.world.read_bytes(&data).ok()?;
        results::read_data(&data.to_string_lossy(), &bytes).ok()?.unread_columns()
    });
    match reasons.next() {
        Some(reason) => error.help(reason),
        None => error,
    }
}

/// What is said where an experiment has no outputs.
const MISSING_OUTPUTS: &str = "the entry `outputs` is missing";

/// What the parser says where a text or a key in quotation marks should end.
const EXPECTED_QUOTE: &str = "literal string, expected `'`";

/// Where the parser has stopped.
struct Place<'t> {
    text: &'t str,
    start: usize,
}

impl<'t> Place<'t> {
    /// The line of the place, up to it and from it on.
    fn line(&self) -> (&'t str, &'t str) {
        let (before, after) = self.text.split_at(self.boundary());
        let before = before.rsplit('\n').next().unwrap_or_default();
        (before, after.split('\n').next().unwrap_or_default())
    }

    fn boundary(&self) -> usize {
        (0..=self.start).rev().find(|at| self.text.is_char_boundary(*at)).unwrap_or(0)
    }

    /// What other languages write in another way.
    fn habit(&self, message: &str) -> Option<Fault> {
        let (before, after) = self.line();
        let line = format!("{before}{after}");
        let is_about = |words: &[&str]| words.iter().any(|word| message.contains(word));
        if is_about(&["escape", "unicode", "hexadecimal"]) && line.contains('\\') {
            return Some(
                fault!(BAD_OPTION, "a backslash in double quotes begins an escape sequence")
                    .help("write `/` between folders, or single quotes, in which backslashes are plain: `'C:\\Users\\me\\data.csv'`"),
            );
        }
        if is_about(&["invalid boolean", "invalid float, expected `", "expected `true`"]) {
            return Some(fault!(BAD_OPTION, "this is not a value").help(
                "write a number, `true` or `false` in lower case, or text in double quotes",
            ));
        }
        // After the comma of `max = 1,0 }` the parser expects a key, which may be in quotation marks.
        let is_entry =
            is_about(&["expected `=`", "extra comma", "missing comma", "expected newline"]);
        if let Some(number) =
            decimal_comma(&line).filter(|_| is_entry || is_about(&[EXPECTED_QUOTE]))
        {
            return Some(
                fault!(BAD_OPTION, "a comma separates entries; numbers have a decimal point")
                    .help(format!("write `{number}`")),
            );
        }
        if let Some(fault) = self.punctuation(message) {
            return Some(fault);
        }
        if !is_entry {
            return None;
        }
        let comment =
            ["//", "%", "--", "/*"].into_iter().find(|mark| line.trim_start().starts_with(mark));
        if let Some(mark) = comment {
            return Some(fault!(BAD_OPTION, "`{mark}` does not begin a comment").help("write `#`"));
        }
        if after.starts_with('[') && !before.trim().is_empty() {
            let end = after.find(['=', ' ']).unwrap_or(after.len());
            let name = format!("{}{}", before.trim_start(), &after[..end]);
            return Some(
                fault!(BAD_OPTION, "a name with brackets is written in quotation marks")
                    .help(format!("write `\"{name}\"`")),
            );
        }
        let assignment = [":=", ":"].into_iter().find(|sign| {
            after.trim_start().starts_with(sign) || before.trim_end().ends_with(sign)
        })?;
        Some(fault!(BAD_OPTION, "`{assignment}` does not give an entry a value").help("write `=`"))
    }

    /// Commas, points and quotation marks.
    fn punctuation(&self, message: &str) -> Option<Fault> {
        let (_, after) = self.line();
        let (words, help) = match message {
            _ if message.contains("expected newline") && after.starts_with(',') => {
                ("an entry ends with its line", "remove the comma")
            }
            _ if message.contains("extra assignment") => {
                ("entries in braces are separated by commas", "write `,` between them")
            }
            _ if message.contains("expected digits") => (
                "a number has digits on both sides of the point",
                "write `0.5` for `.5` and `5.0` for `5.`",
            ),
            _ if message.starts_with("duplicate key") => {
                ("this is written twice", "keep one of them")
            }
            _ if message.contains(EXPECTED_QUOTE)
                || message.contains("basic string, expected `\"`") =>
            {
                ("a quotation mark is missing at the end", "close the text on its line")
            }
            _ => return None,
        };
        Some(fault!(BAD_OPTION, "{words}").help(help))
    }

    /// An entry that there is not.
    fn unknown_entry(&self, message: &str) -> Option<Fault> {
        let rest = message.strip_prefix("unknown field `")?;
        let (name, rest) = rest.split_once('`')?;
        let known: Vec<&str> = rest.split('`').skip(1).step_by(2).collect();
        let fault = fault!(BAD_OPTION, "there is no entry `{name}` here");
        let is_experiment = known.contains(&"outputs");
        if let Some((_, owner)) = DEEPER.iter().find(|(own, _)| *own == name && is_experiment) {
            return Some(fault.help(format!("it belongs to {owner}")));
        }
        if TOP.contains(&name) && !known.contains(&name) {
            return Some(fault.help(format!(
                "`{name}` belongs above the first table in brackets: what follows a line such as \
                 `[stop]` is part of that table"
            )));
        }
        if OF_EXPERIMENTS.contains(&name) && known.contains(&"experiment") {
            return Some(fault.help(format!(
                "`{name}` belongs to an experiment: write it below a line `[[experiment]]`"
            )));
        }
        let similar = match name {
            "experiments" => Some("write `[[experiment]]`, once for each measurement".to_owned()),
            "parameter" => Some("write `[parameters]`".to_owned()),
            "sigma" | "deviation" | "std" if known.contains(&"sd") => {
                Some("write `sd` for the standard deviation of a prior".to_owned())
            }
            _ => suggest::did_you_mean(name, known.iter().copied()),
        };
        let all = known.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
        Some(fault.help_if(similar).help(format!("{ENTRIES}{all}")))
    }

    /// An entry that must be there.
    fn missing_entry(&self, message: &str) -> Option<Fault> {
        let name = message.strip_prefix("missing field `")?.strip_suffix('`')?;
        let remedy = match name {
            "outputs" => "add what was measured: `outputs = { T = \"column\" }`",
            "data" => "add the file of the measured data: `data = \"measured.csv\"`",
            "parameters" => {
                "add what is estimated: `[parameters]`, and below it `k = { min = 0.1, max = 10 }`"
            }
            "experiment" => "add a table `[[experiment]]` with `data` and `outputs`",
            _ => "add it",
        };
        Some(fault!(BAD_OPTION, "the entry `{name}` is missing").help(remedy))
    }

    /// A value of another type, or what else the parser says.
    fn other_type(&self, message: &str) -> Fault {
        const WORDS: [(&str, &str); 10] = [
            ("f64", "a number"),
            ("u64", "a whole number"),
            ("usize", "a whole number"),
            ("path string", "the name of a file"),
            ("a map", "a table"),
            ("a sequence", "an array"),
            ("an array of length 6", "six numbers"),
            ("an array of length 2", "two numbers"),
            ("a boolean", "`true` or `false`"),
            ("a string", "a text in quotes"),
        ];
        let negative = message.strip_prefix("invalid value: integer `-");
        if let Some((number, _)) = negative.and_then(|rest| rest.split_once("`, expected u")) {
            return fault!(BAD_OPTION, "expected a whole number from 0, found -{number}");
        }
        let of_type = message.strip_prefix("invalid type: ");
        let worded = match of_type.and_then(|rest| rest.split_once(", expected ")) {
            None => message.to_owned(),
            Some((found, expected)) => {
                let known = WORDS.iter().find(|(own, _)| *own == expected);
                let is_struct = expected.starts_with("struct ");
                let expected = match known {
                    Some((_, words)) => *words,
                    None if is_struct => "a table",
                    None => expected,
                };
                let found = match found {
                    "map" => "a table".to_owned(),
                    "sequence" => "an array".to_owned(),
                    other => other.replace("floating point", "the number"),
                };
                format!("expected {expected}, found {found}")
            }
        };
        let fault = fault!(BAD_OPTION, "{worded}");
        match self.remedy(message) {
            Some(remedy) => fault.help(remedy),
            None => fault,
        }
    }

    fn remedy(&self, message: &str) -> Option<String> {
        let is = |found: &str, expected: &str| {
            message.contains(&format!("invalid type: {found}"))
                && message.contains(&format!("expected {expected}"))
        };
        let (_, after) = self.line();
        let has_number = || {
            let quoted = message.split_once("string \"").map_or("", |(_, quoted)| quoted);
            quoted.starts_with(|c: char| c.is_ascii_digit() || c == '-')
        };
        if is("map", "a sequence") && after.trim_start().starts_with('[') {
            return Some(
                "write the name in two brackets, `[[experiment]]`, also for a single experiment"
                    .to_owned(),
            );
        }
        if is("string", "f64") && has_number() {
            return Some("write the number without quotes".to_owned());
        }
        if is("floating point", "u64") || is("floating point", "usize") {
            return Some("write all digits, without point and exponent: `600`".to_owned());
        }
        if is("sequence", "path string") {
            return Some(
                "write one file for each experiment, and a table `[[experiment]]` for each file"
                    .to_owned(),
            );
        }
        let (before, _) = self.line();
        let key = before.trim_end().trim_end_matches('=').trim_end();
        match key.rsplit([' ', '{', ',']).next().unwrap_or_default() {
            "outputs" => Some(format!(
                "write `outputs = {{ {} }}`",
                same_names(after).unwrap_or_else(|| "T = \"column\"".to_owned())
            )),
            name if message.contains("sequence, expected a range") => {
                let [min, max] = pair(after)?;
                Some(format!("write `{name} = {{ min = {min}, max = {max} }}`"))
            }
            "inputs" => Some("write `inputs = { u = \"column\" }`".to_owned()),
            "start" => Some(
                "`start` of an experiment gives states their initial values: `start = { T = 25 }`"
                    .to_owned(),
            ),
            "set" => Some(
                "`set` gives parameters their values in an experiment: `set = { n = 3 }`"
                    .to_owned(),
            ),
            _ if message.contains("expected a map") => Some(
                "a table begins with its name in brackets, once; below it there are lines \
                 `name = value`"
                    .to_owned(),
            ),
            _ => None,
        }
    }
}

/// Columns in a list of names, each for the variable of its name.
fn same_names(after: &str) -> Option<String> {
    let list = list(after)?;
    let is_name = |own: &&str| own.len() > 2 && own.starts_with('"') && own.ends_with('"');
    let named = |own: &str| format!("{} = {own}", own.trim_matches('"'));
    list.iter()
        .all(is_name)
        .then(|| list.iter().map(|own| named(own)).collect::<Vec<_>>().join(", "))
}

/// The two numbers of a list.
fn pair(after: &str) -> Option<[&str; 2]> {
    let pair: [&str; 2] = list(after)?.try_into().ok()?;
    pair.iter().all(|own| own.parse::<f64>().is_ok()).then_some(pair)
}

/// The entries of a list within one line.
fn list(after: &str) -> Option<Vec<&str>> {
    let (inner, _) = after.trim_start_matches([' ', '=']).strip_prefix('[')?.split_once(']')?;
    Some(inner.split(',').map(str::trim).filter(|own| !own.is_empty()).collect())
}

/// The number of a line that is written with a decimal comma, with a point.
fn decimal_comma(line: &str) -> Option<String> {
    let comma = line.match_indices(',').find(|(at, _)| {
        let before = line[..*at].ends_with(|c: char| c.is_ascii_digit());
        before && line[at + 1..].starts_with(|c: char| c.is_ascii_digit())
    })?;
    let is_part = |c: char| c.is_ascii_digit();
    let whole = line[..comma.0].rsplit(|c| !is_part(c)).next().unwrap_or_default();
    let fraction = line[comma.0 + 1..].split(|c| !is_part(c)).next().unwrap_or_default();
    Some(format!("{whole}.{fraction}"))
}

#[cfg(test)]
mod tests {
    use super::super::file;
    use super::*;

    /// The message and the helps for a problem file in which something is written by habit.
    fn refused(text: &str) -> String {
        let error = file::read(SourceId::NONE, text).expect_err("a refusal");
        format!("{} | {}", error.message, error.helps.join(" | "))
    }

    #[test]
    fn a_decimal_comma_at_the_end_of_a_table_in_braces_is_named() {
        let text = "model = \"M\"\n[parameters]\nR0 = { min = 1e-4, max = 1,0 }\n";
        let found = refused(text);
        assert!(found.contains("numbers have a decimal point | write `1.0`"), "{found}");
    }

    #[test]
    fn habits_are_answered_with_cause_and_remedy() {
        let rest = "[parameters]\nk = { min = 0, max = 1 }\n[[experiment]]\ndata = \"d.csv\"\noutputs = { T = \"T\" }\n";
        let all = [
            ("files = [\"models\\Oven.mo\"]\n", ["backslash", "single quotes"]),
            ("// the oven\n", ["comment", "write `#`"]),
            ("model := \"Oven\"\n", ["`:=`", "write `=`"]),
            ("searches = \"5\"\n", ["whole number", "5"]),
            ("searches = True\n", ["not a value", "`true` or `false`"]),
            ("searches = null\n", ["not a value", "write a number"]),
            ("searches = 5,\n", ["ends with its line", "remove the comma"]),
            ("% comment\n", ["`%` does not begin a comment", "write `#`"]),
            ("searches = 5\nsearches = 6\n", ["written twice", "keep one"]),
            ("sigma = 1\n", ["no entry `sigma`", "`files`"]),
            ("data = \"d.csv\"\n", ["belongs to an experiment", "`[[experiment]]`"]),
        ];
        for (line, words) in all {
            let said = refused(&format!("{line}{rest}"));
            assert!(words.iter().all(|word| said.contains(word)), "{line}: {said}");
        }
    }

    #[test]
    fn parameters_are_answered_without_names_of_types() {
        let all = [
            ("k = [0.001, 1]", ["array", "write `k = { min = 0.001, max = 1 }`"]),
            ("k = 2", ["integer `2`", "fixed = 2"]),
            ("k = { min = 0,1, max = 20 }", ["decimal point", "`0.1`"]),
            ("k = { min : 0.1, max = 20 }", ["`:`", "write `=`"]),
            ("k = { min = 1 max = 2 }", ["separated by commas", "write `,`"]),
            ("k = { min = 1; max = 2 }", ["separated by commas", "write `,`"]),
            ("k = { min = .1, max = 2 }", ["both sides of the point", "`0.5`"]),
            ("c[1].k = { fixed = 2 }", ["quotation marks", "`\"c[1].k\"`"]),
            ("k = { min = \"0.1\", max = 20 }", ["expected a number", "without quotes"]),
            (
                "k = { min = 1, max = 2, prior = { mean = 2, sigma = 1 } }",
                ["`sigma`", "write `sd`"],
            ),
        ];
        for (line, words) in all {
            let said = refused(&format!("[parameters]\n{line}\n"));
            assert!(words.iter().all(|word| said.contains(word)), "{line}: {said}");
            assert!(!said.contains("struct") && !said.contains("variant"), "{said}");
        }
    }

    #[test]
    fn experiments_are_answered_with_where_entries_belong() {
        let all = [
            ("interpolation = \"linear\"", ["belongs to an input", "inputs ="]),
            ("outputs = [\"T\"]", ["array", "outputs = { T = \"T\" }"]),
            ("outputs = { T = \"T\", sigma = 0.2 }", ["`{ column", "0.2"]),
            ("outputs = { T = { column = \"T\", weight = \"w\" } }", ["`weight`", "sigma"]),
            ("start = 100", ["100", "start = { T = 25 }"]),
            ("title = \"late\"", ["no entry `title`", "above the first table"]),
        ];
        let rest = "[parameters]\nk = { min = 0, max = 1 }\n[[experiment]]\ndata = \"d.csv\"\n";
        for (line, words) in all {
            let said = refused(&format!("{rest}{line}\n"));
            assert!(words.iter().all(|word| said.contains(word)), "{line}: {said}");
        }
        let single = refused("[parameters]\nk = { fixed = 1 }\n[experiment]\ndata = \"d.csv\"\n");
        assert!(single.contains("`[[experiment]]`"), "{single}");
        let plural = refused("[parameters]\n[[experiments]]\ndata = \"d.csv\"\n");
        assert!(plural.contains("`[[experiment]]`"), "{plural}");
        assert!(
            refused("[parameters]\n[[experiment]]\ndata = \"d\"\n")
                .contains("`outputs` is missing")
        );
    }
}
