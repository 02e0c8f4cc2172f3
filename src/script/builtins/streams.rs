//! `Modelica.Utilities.Streams`: text on the terminal and in files, line by line.

use super::strings::{string_array, text};
use super::{Args, Builtin, Failure, Family};
use crate::bail;
use crate::diag::Fault;
use crate::errors::{BAD_ARGUMENT, SCRIPT_ERROR};
use crate::value::Value;
use crate::{Dialect, Session};
use std::path::Path;

/// The commands of this file.
pub(super) const FAMILY: Family = Family {
    packages: &["Modelica.Utilities.Streams"],
    dialect: Some(Dialect::Dymola),
    builtins: &[
        Builtin { header: PRINT, run: print },
        Builtin { header: READ_FILE, run: read_file },
        Builtin { header: READ_LINE, run: read_line },
        Builtin { header: COUNT_LINES, run: count_lines },
        Builtin { header: ERROR, run: error },
        Builtin { header: CLOSE, run: close },
    ],
};

/// What OpenModelica's bare `print` does.
pub(super) const BARE_PRINT: Family = Family {
    packages: &["OpenModelica.Scripting"],
    dialect: Some(Dialect::OpenModelica),
    builtins: &[Builtin { header: PRINT_BARE, run: print_bare }],
};

const PRINT: &str = r#"
function print "Writes a line to the terminal or appends it to a file."
  input String string = "";
  input String fileName = "" "empty: the terminal";
end print;
"#;

fn print(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let (mut line, file): (String, String) = (args.take("string")?, args.take("fileName")?);
    line.push('\n');
    if file.is_empty() {
        session.print_of_script(&line);
    } else {
        session.world.append_file(Path::new(&file), line.as_bytes())?;
    }
    Ok(Value::nothing())
}

const PRINT_BARE: &str = r#"
function print "Writes a string to the terminal, without a line break."
  input String str;
end print;
"#;

fn print_bare(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let string: String = args.take("str")?;
    session.print_of_script(&string);
    Ok(Value::nothing())
}

const READ_FILE: &str = r#"
function readFile "The lines of a file."
  input String fileName;
  output String stringVector[:];
end readFile;
"#;

fn read_file(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    Ok(string_array(lines(session, &mut args)?))
}

const READ_LINE: &str = r#"
function readLine "One line of a file."
  input String fileName;
  input Integer lineNumber(min = 1) "from 1";
  output String string "empty after the last line";
  output Boolean endOfFile "whether the file has fewer lines";
end readLine;
"#;

fn read_line(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let lines = lines(session, &mut args)?;
    let number: i64 = args.take("lineNumber")?;
    if number < 1 {
        bail!(BAD_ARGUMENT, "`lineNumber` of `readLine` is {number}; line numbers start at 1");
    }
    let line = lines.into_iter().nth(number as usize - 1);
    let end_of_file = line.is_none();
    Ok(Value::Tuple(vec![text(line.unwrap_or_default()), Value::Boolean(end_of_file)]))
}

const COUNT_LINES: &str = r#"
function countLines "Number of lines of a file."
  input String fileName;
  output Integer numberOfLines;
end countLines;
"#;

fn count_lines(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    Ok(Value::Integer(lines(session, &mut args)?.len() as i64))
}

fn lines(session: &mut Session, args: &mut Args) -> Result<Vec<String>, Fault> {
    let file: String = args.take("fileName")?;
    Ok(session.world.read_text(Path::new(&file))?.lines().map(str::to_owned).collect())
}

const ERROR: &str = r#"
function error "Stops the execution with an error message."
  input String string;
end error;
"#;

fn error(_: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let string: String = args.take("string")?;
    bail!(SCRIPT_ERROR, "{string}")
}

const CLOSE: &str = r#"
function close "Has no effect: each file is closed after each call."
  input String fileName;
end close;
"#;

fn close(_: &mut Session, _: Args) -> Result<Value, Failure> {
    Ok(Value::nothing())
}
