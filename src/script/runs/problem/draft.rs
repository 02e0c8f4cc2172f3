//! A first problem file from a data file and a model: columns are matched with variables
//! ([`matching`](super::matching)), ranges are guessed from the model and the data.

use super::draft_subject::{DraftOptions, Estimable, Subject};
use super::matching::{self, DataColumn, Meaning};
use super::{build, data, fault_codes, file};
use crate::Session;
use crate::diag::suggest::listed;
use crate::diag::{Diagnostic, Fault};
use crate::fault;
use crate::flatten::FlatModel;
use crate::mat::{self, MatFile, Matrix, MatrixKind};
use crate::registry::BAD_OPTION;
use crate::results;
use crate::source::Span;
use crate::units::written;
use std::fmt::Write;
use std::path::Path;

/// A draft and what is left to do.
#[derive(Debug, Clone)]
pub struct Draft {
    /// The problem file.
    pub text: String,
    /// Why it cannot be run as it is; none where it can.
    pub incomplete: Option<String>,
    /// What only the user can know.
    pub question: Option<Question>,
}

/// Which of several variables a column holds.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Question {
    /// The column.
    pub column: String,
    /// The variables that come into question, the one that was taken first.
    pub candidates: Vec<String>,
}

/// Which columns mean what.
struct Roles<'c> {
    /// The variable and its column; none where no column can be that of the times.
    x: (String, Option<&'c DataColumn>),
    outputs: Vec<Assigned<'c>>,
    inputs: Vec<Assigned<'c>>,
    unused: Vec<&'c DataColumn>,
}

/// A variable, its column, and what is uncertain about the pair.
struct Assigned<'c> {
    variable: String,
    column: &'c DataColumn,
    doubt: Option<String>,
}

/// Writes a problem file.
///
/// # Errors
///
/// Data or a model that cannot be read, a file with several classes of which none is named.
pub fn draft(session: &mut Session, options: &DraftOptions) -> Result<Draft, Vec<Diagnostic>> {
    let one = |fault: Fault| vec![fault.at(Span::NONE)];
    let bytes = session.world.read_bytes(Path::new(&options.data)).map_err(one)?;
    let table = results::read_data(&options.data, &bytes).map_err(one)?;
    let columns = columns(&table).map_err(one)?;
    let subject = Subject::read(session, options)?;
    let (roles, question) = roles(&columns, &subject, options.output.as_deref());
    let mut text = head(options, &subject);
    parameters(&mut text, &subject, &roles);
    experiment(&mut text, options, &subject.flat, &roles);
    for (_, why) in table.unreadable() {
        _ = writeln!(text, "# not used: {}", why.message);
    }
    text.push_str(
        "\n[stop]                       # the first condition met ends the run\n\
         evaluations = 20000          # simulations\n\
         stagnation = 500             # generations without improvement\n",
    );
    let incomplete = check(session, &text);
    if incomplete.is_some() {
        // A column that could not be read may be the one that is missing.
        for (_, why) in table.unreadable() {
            session.note(mat::errors::DATA_NOTE, format!("column not used: {}", why.message));
        }
    }
    Ok(Draft { text, incomplete, question })
}

/// The columns of numbers by their shortest names.
fn columns(table: &MatFile) -> Result<Vec<DataColumn>, Fault> {
    let mut found = Vec::new();
    for (name, matrix) in table.arrays.iter().filter(|(_, matrix)| matrix.kind != MatrixKind::Char)
    {
        for name in parts(name, matrix) {
            let column = table.column(&name)?;
            let name = table.short_name(&name).to_owned();
            let codes = fault_codes::of(&column);
            found.push(DataColumn { name, unit: column.about.unit, values: column.values, codes });
        }
    }
    if found.len() < 2 {
        let fault =
            fault!(BAD_OPTION, "`{}` has fewer than two columns of numbers", table.file_name);
        return Err(fault.help_if(table.unread_columns()));
    }
    Ok(found)
}

/// The names of what a matrix holds: itself, or its columns, or its rows where these are longer.
fn parts(name: &str, matrix: &Matrix) -> Vec<String> {
    /// More columns than this are not signals.
    const MOST: usize = 100;
    match matrix.as_vector() {
        Some([]) => Vec::new(),
        Some(_) => vec![name.to_owned()],
        None if matrix.columns <= matrix.rows.min(MOST) => {
            (1..=matrix.columns).map(|at| format!("{name}[:,{at}]")).collect()
        }
        None if matrix.rows <= MOST => {
            (1..=matrix.rows).map(|at| format!("{name}[{at},:]")).collect()
        }
        None => Vec::new(),
    }
}

/// The columns by what they mean, and what remains to be asked; `output` is what was answered.
fn roles<'c>(
    columns: &'c [DataColumn],
    subject: &Subject,
    output: Option<&str>,
) -> (Roles<'c>, Option<Question>) {
    let flat = &subject.flat;
    let states: Vec<&str> = subject.states.iter().map(String::as_str).collect();
    let meanings = matching::meanings(columns, flat, &states);
    let pairs = || columns.iter().zip(&meanings);
    // Where date and time of day are two columns, that of the time of day counts through the days.
    let is_time = |(column, meaning): &(&DataColumn, &Option<Meaning>)| {
        meaning.is_none() && column.is_time(flat)
    };
    let time = pairs().filter(is_time).find(|(column, _)| column.increases());
    let time = time.or_else(|| pairs().find(is_time));
    let is_driver = |(_, meaning): &(&DataColumn, &Option<Meaning>)| {
        states.is_empty() && meaning.as_ref().is_some_and(|meaning| meaning.is_input)
    };
    let first = || (&columns[0], &meanings[0]);
    let x = match (time, pairs().find(is_driver)) {
        (Some((time, _)), _) => ("time".to_owned(), Some(time)),
        (None, Some((column, Some(driver)))) => (driver.variable.clone(), Some(column)),
        (None, _) => match first() {
            (column, Some(own)) if !(own.is_guess && column.increases()) => {
                (own.variable.clone(), Some(column))
            }
            (column, _) => ("time".to_owned(), Some(column).filter(|own| own.may_be_times())),
        },
    };
    let mut roles = Roles { x, outputs: Vec::new(), inputs: Vec::new(), unused: Vec::new() };
    let is_x = |column: &DataColumn| roles.x.1.is_some_and(|x| x.name == column.name);
    let others: Vec<_> = pairs().filter(|(column, _)| !is_x(column)).collect();
    for (column, meaning) in others {
        let Some(Meaning { variable, is_input, is_guess }) = meaning.clone() else {
            roles.unused.push(column);
            continue;
        };
        let doubt = is_guess.then(|| "a guess by unit and name".to_owned());
        let assigned = Assigned { variable, column, doubt };
        if is_input { &mut roles.inputs } else { &mut roles.outputs }.push(assigned);
    }
    let question = match roles.outputs.is_empty() {
        true => guess_output(&mut roles, flat, &states, output),
        false => None,
    };
    (roles, question)
}

/// Where no column means an output: the output or state that begins nearest to a column, or the one
/// that was chosen; and the question where several come into question.
fn guess_output(
    roles: &mut Roles<'_>,
    flat: &FlatModel,
    states: &[&str],
    chosen: Option<&str>,
) -> Option<Question> {
    let candidates: Vec<&DataColumn> =
        roles.unused.iter().copied().filter(|column| !column.is_time(flat)).collect();
    let (names, at) = matching::output_by_start(&candidates, flat, states)?;
    let column = candidates.get(at).copied()?;
    roles.unused.retain(|unused| unused.name != column.name);
    if let Some(chosen) = names.iter().find(|name| Some(name.as_str()) == chosen) {
        roles.outputs.push(Assigned { variable: chosen.clone(), column, doubt: None });
        return None;
    }
    let mut doubt = "a guess: its start value is the nearest to the first value".to_owned();
    let others: Vec<&str> = names[1..].iter().map(String::as_str).collect();
    if !others.is_empty() {
        _ = write!(doubt, "; it may also be {}", listed(&others));
    }
    roles.outputs.push(Assigned { variable: names[0].clone(), column, doubt: Some(doubt) });
    let question = Question { column: column.name.clone(), candidates: names.clone() };
    (names.len() > 1).then_some(question)
}

fn head(options: &DraftOptions, subject: &Subject) -> String {
    let (class, is_unit) = (&subject.name, subject.is_unit);
    let what = match is_unit {
        true => "the FMU",
        false => "the class, optionally with a modification: \"Class(p = 1)\"",
    };
    let mut text = format!(
        "# A problem for `gapi identify`, drafted by `gapi new`: check every line and correct \
         the guesses.\n\n\
         title = {}\n\
         model = {}          # {what}\n",
        quoted(&format!("{class} from {}", options.data)),
        quoted(class),
    );
    if !options.models.is_empty() && !is_unit {
        _ = writeln!(
            text,
            "files = [{}]          # Modelica files and folders to load",
            quoted(&options.models)
        );
    }
    text
}

fn quoted(text: &str) -> String {
    format!("\"{}\"", text.replace('\\', "\\\\").replace('"', "\\\""))
}

fn key(name: &str) -> String {
    let bare = !name.is_empty() && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
    if bare { name.to_owned() } else { quoted(name) }
}

/// Parameters of components that a draft lists; models of libraries have thousands.
const MOST_INSIDE: usize = 20;

/// The parameters at the top of the model, each with a range. Those of components are comments: one chooses
/// among them.
fn parameters(text: &mut String, subject: &Subject, roles: &Roles<'_>) {
    text.push_str(
        "\n# The parameters to estimate. Fix known values, `NAME = { fixed = 1.5 }`, or delete \
         the line: then the\n\
         # model's value is used. Positive ranges wider than a decade are searched on a \
         logarithmic scale.\n\
         [parameters]\n",
    );
    let mut count = 0;
    let mut whole: Vec<&str> = Vec::new();
    for parameter in &subject.parameters {
        let is_data =
            roles.outputs.iter().chain(&roles.inputs).any(|own| own.variable == parameter.name);
        if is_data {
            continue;
        }
        if let Some((array, elements)) = &parameter.table {
            if !whole.contains(&array.as_str()) {
                whole.push(array);
                _ = writeln!(
                    text,
                    "# {array} keeps its {elements} values; to estimate one, add: {} = {{ min = …, max = … }}",
                    key(&parameter.name)
                );
            }
            continue;
        }
        count += 1;
        let measured = measured_start(&subject.flat, roles, &parameter.name);
        let line = parameter_line(parameter, measured);
        if parameter.is_inside {
            if count == 1 {
                text.push_str("# All parameters are those of components: remove the `#` before those to estimate.\n");
            }
            if count > MOST_INSIDE {
                continue;
            }
            text.push_str(if line.starts_with('#') { "" } else { "# " });
        }
        text.push_str(&line);
    }
    if count > MOST_INSIDE && subject.parameters.iter().all(|own| own.is_inside) {
        _ = writeln!(text, "# and {} more", count - MOST_INSIDE);
    }
    if count == 0 {
        text.push_str("# the model has no parameters that can be estimated\n");
    }
}

/// The line of a parameter, with what is known of it; a comment where there is nothing to estimate.
fn parameter_line(parameter: &Estimable, measured: Option<[f64; 2]>) -> String {
    let mut about = Vec::new();
    if !parameter.unit.is_empty() {
        about.push(parameter.unit.clone());
    }
    if !parameter.description.is_empty() {
        about.push(parameter.description.clone());
    }
    let name = key(&parameter.name);
    let [least, most] = fraction(parameter).unwrap_or([parameter.min, parameter.max]);
    let declared = |[low, high]: [f64; 2]| [low.max(least), high.min(most)];
    let measured = measured.map(declared).filter(|[low, high]| low < high);
    let range = match measured {
        Some(range) => Some((range, "around the first measured value".to_owned())),
        None => range(parameter),
    };
    let (mark, [min, max], why) = match (&parameter.computed, range) {
        (Some(binding), range) => {
            let range = range.map_or([0.1, 10.0], |(range, _)| range);
            ("# ", range, format!("the model computes it: {binding}"))
        }
        (None, Some((range, why))) => ("", range, why),
        (None, None) => {
            let why = "the model has no value: write a range and remove the first `#`".to_owned();
            ("# ", [0.1, 10.0], why)
        }
    };
    about.push(why);
    format!("{mark}{name} = {{ min = {min:?}, max = {max:?} }}          # {}\n", about.join("; "))
}

/// The range of a parameter that is the start value of a measured variable: as far about the first value
/// as the data reach.
fn measured_start(flat: &FlatModel, roles: &Roles<'_>, parameter: &str) -> Option<[f64; 2]> {
    let is_its_start = |own: &&Assigned| {
        let start = matching::parameter_of_start(flat, &own.variable);
        let unit = super::flat::unit_in(flat, &own.variable);
        start.is_some_and(|start| start == parameter)
            && own.column.unit.as_ref().is_none_or(|given| written(given) == written(&unit))
    };
    let (first, range) = roles.outputs.iter().find(is_its_start)?.column.extent()?;
    let rounded = |value: f64| format!("{value:.3e}").parse::<f64>().ok();
    Some([rounded(first - range)?, rounded(first + range)?])
}

/// What a fraction can be: 0 to 1, within the declared limits. A parameter is one if its value lies there
/// and its unit is 1, or if it has none and its name or description says so.
fn fraction(parameter: &Estimable) -> Option<[f64; 2]> {
    const WORDS: [&str; 5] = ["soc", "fraction", "efficiency", "emissivity", "porosity"];
    let about = format!("{} {}", parameter.name, parameter.description).to_lowercase();
    let mut words = about.split(|letter: char| !letter.is_alphanumeric());
    let mut is_said = || match parameter.unit.as_str() {
        "1" => true,
        "" => words.any(|own| WORDS.iter().any(|word| own.starts_with(word))),
        _ => false,
    };
    let range = [parameter.min.max(0.0), parameter.max.min(1.0)];
    ((range[0]..=range[1]).contains(&parameter.default) && range[0] < range[1] && is_said())
        .then_some(range)
}

/// A range and where it comes from: the model's own, that of a fraction, else 20 degrees to both sides of a
/// temperature on a scale with an offset, and a decade to both sides of any other value.
fn range(parameter: &Estimable) -> Option<([f64; 2], String)> {
    /// Degrees to both sides.
    const AROUND: f64 = 20.0;
    let Estimable { min, max, default: value, .. } = *parameter;
    let has_offset = written(&parameter.unit).is_some_and(|unit| unit.offset != 0.0);
    // 1e-60 and 1e60 stand for no limit in some libraries.
    let limited = |limit: f64| limit.is_finite() && limit.abs() < 1e20;
    if limited(min) && limited(max) && min < max {
        return Some(([min, max], "range declared in the model".to_owned()));
    }
    if let Some(fraction) = fraction(parameter).filter(|_| 10.0 * value > 1.0) {
        return Some((
            fraction,
            "a fraction, such as a state of charge or an efficiency".to_owned(),
        ));
    }
    if !value.is_finite() {
        return None;
    }
    let around = match value {
        value if has_offset => [value - AROUND, value + AROUND],
        0.0 => [-1.0, 1.0],
        value if value > 0.0 => [decimal(value / 10.0), decimal(value * 10.0)],
        value => [decimal(value * 10.0), decimal(value / 10.0)],
    };
    let range = [
        if min.is_finite() { around[0].max(min) } else { around[0] },
        if max.is_finite() { around[1].min(max) } else { around[1] },
    ];
    let why = match value {
        value if has_offset => format!("{AROUND} degrees around the model's value {value}"),
        0.0 => "a guess: the value in the model is 0".to_owned(),
        value => format!("one decade around the model's value {value}"),
    };
    (range[0] < range[1]).then_some((range, why))
}

/// A quotient or product with ten as it is written: 0.1 and not 0.09999999999999999.
fn decimal(value: f64) -> f64 {
    format!("{value:.12e}").parse().unwrap_or(value)
}

fn experiment(text: &mut String, options: &DraftOptions, flat: &FlatModel, roles: &Roles<'_>) {
    _ = write!(
        text,
        "\n# One table `[[experiment]]` per measurement.\n[[experiment]]\nname = \"measured\"\ndata = {}\n",
        quoted(&options.data)
    );
    match &roles.x {
        (variable, Some(x)) => {
            let [name, column] = [variable, &x.name].map(|own| quoted(own));
            let about = format!("{}{}", span(x), conversion(x, variable, flat));
            _ = writeln!(text, "x = {{ variable = {name}, column = {column} }}          # {about}");
        }
        (_, None) => text.push_str(
            "# No column of times was found: write which one it is.\n\
             # x = { variable = \"time\", column = \"time\" }\n",
        ),
    }
    if roles.outputs.is_empty() {
        text.push_str("# No column fits a variable: write which column contains which variable.\n# outputs.y = { column = \"y\" }\n");
    } else {
        text.push_str(
            "# Measured outputs. For known measurement errors, add `sigma = 0.01` in the unit of \
             the variable.\n",
        );
    }
    columns_of(text, "outputs", &roles.outputs, flat);
    if !roles.inputs.is_empty() {
        text.push_str(
            "# Inputs read from columns: `hold` keeps each value until the next, \
                       `linear` interpolates.\n",
        );
    }
    columns_of(text, "inputs", &roles.inputs, flat);
    for column in &roles.unused {
        _ = writeln!(text, "# not used: column {}, {}", quoted(&column.name), span(column));
    }
}

fn columns_of(text: &mut String, table: &str, columns: &[Assigned<'_>], flat: &FlatModel) {
    for Assigned { variable, column, doubt } in columns {
        let entry = format!("{table}.{} = {{ column = {} }}", key(variable), quoted(&column.name));
        let doubt = doubt.as_ref().map_or(String::new(), |doubt| format!("{doubt}; "));
        let about = format!("{doubt}{}{}", span(column), conversion(column, variable, flat));
        _ = writeln!(text, "{entry}          # {about}");
    }
}

/// The range of a column with its unit, and how many values are missing.
fn span(column: &DataColumn) -> String {
    let finite = || column.values.iter().copied().filter(|value| value.is_finite());
    let known = || column.known();
    let (low, high) =
        (known().fold(f64::INFINITY, f64::min), known().fold(f64::NEG_INFINITY, f64::max));
    let unit = column.unit.as_deref().map_or(String::new(), |unit| format!(" {unit}"));
    let missing = column.values.len() - finite().count();
    let mut gaps = if missing > 0 { format!(", {missing} missing") } else { String::new() };
    for code in &column.codes {
        _ = write!(gaps, ", {code} like the fault code of an instrument");
    }
    match finite().next() {
        Some(_) => {
            format!("{} values from {low} to {high}{unit}{gaps}", column.values.len() - missing)
        }
        None => "no values".to_owned(),
    }
}

/// What happens to the unit of a column.
fn conversion(column: &DataColumn, name: &str, flat: &FlatModel) -> String {
    let unit = match name {
        "time" => "s".to_owned(),
        name => super::flat::unit_in(flat, name),
    };
    match (&column.unit, unit.as_str()) {
        (Some(given), unit) if !unit.is_empty() && written(given) != written(unit) => {
            format!("; converted to {unit}")
        }
        (None, unit) if !unit.is_empty() => {
            let suggested = data::suggested_unit(&column.name, unit).map(|suggested| {
                format!("; the name suggests {suggested}: write `unit = \"{suggested}\"`")
            });
            format!("; no unit in the file, {unit} assumed{}", suggested.unwrap_or_default())
        }
        _ => String::new(),
    }
}

/// Builds the problem as `gapi identify` would; why that cannot be done.
fn check(session: &mut Session, text: &str) -> Option<String> {
    let source = session.sources.add("the draft", text);
    let built = file::read(source, text).map_err(|error| vec![error]).and_then(|mut file| {
        build::build(session, &mut file, Path::new("")).map(|built| built.notes)
    });
    match built {
        Ok(notes) => {
            notes.iter().for_each(|note| note.say(session));
            None
        }
        Err(errors) => errors.first().map(|error| {
            let help: String = error.helps.iter().map(|help| format!("; {help}")).collect();
            format!("{}{help}", error.message)
        }),
    }
}
