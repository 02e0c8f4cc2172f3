//! The scanning functions of `Modelica.Utilities.Strings`: a value read from a place in a string,
//! and the position after it.

use super::strings::text;
use super::{Args, Builtin, Failure, Family};
use crate::Session;
use crate::bail;
use crate::diag::Fault;
use crate::errors::SCRIPT_ERROR;
use crate::value::Value;

/// The commands of this file.
pub(super) const FAMILY: Family = Family {
    packages: &["Modelica.Utilities.Strings"],
    dialect: None,
    builtins: &[
        Builtin { header: SCAN_REAL, run: scan_real },
        Builtin { header: SCAN_INTEGER, run: scan_integer },
        Builtin { header: SCAN_BOOLEAN, run: scan_boolean },
        Builtin { header: SCAN_STRING, run: scan_string },
        Builtin { header: SCAN_IDENTIFIER, run: scan_identifier },
        Builtin { header: SCAN_DELIMITER, run: scan_delimiter },
        Builtin { header: SCAN_NO_TOKEN, run: scan_no_token },
    ],
};

/// A string with a position, which moves past what was read.
struct Scanner {
    characters: Vec<char>,
    at: usize,
    message: String,
}

impl Scanner {
    fn new(args: &mut Args) -> Result<Scanner, Fault> {
        let string: String = args.take("string")?;
        let start: i64 = args.take("startIndex")?;
        let characters: Vec<char> = string.chars().collect();
        let at = usize::try_from(start - 1).unwrap_or(0).min(characters.len());
        let mut scanner = Scanner { characters, at, message: args.take("message")? };
        scanner.skip_space();
        Ok(scanner)
    }

    fn skip_space(&mut self) {
        loop {
            while self.peek().is_some_and(char::is_whitespace) {
                self.at += 1;
            }
            if self.characters[self.at..].starts_with(&['/', '/']) {
                while self.peek().is_some_and(|c| c != '\n') {
                    self.at += 1;
                }
            } else {
                return;
            }
        }
    }

    fn peek(&self) -> Option<char> {
        self.characters.get(self.at).copied()
    }

    fn take_while(&mut self, accept: impl Fn(char) -> bool) -> String {
        let start = self.at;
        while self.peek().is_some_and(&accept) {
            self.at += 1;
        }
        self.characters[start..self.at].iter().collect()
    }

    fn digits(&mut self) -> String {
        self.take_while(|c| c.is_ascii_digit())
    }

    /// The text of a number; with `real`, a fraction and an exponent belong to it.
    fn number(&mut self, unsigned: bool, real: bool) -> String {
        let mut number = String::new();
        if let (Some(sign @ ('+' | '-')), false) = (self.peek(), unsigned) {
            number.push(sign);
            self.at += 1;
        }
        number.push_str(&self.digits());
        if real && self.peek() == Some('.') {
            self.at += 1;
            number.push('.');
            number.push_str(&self.digits());
        }
        let before_exponent = self.at;
        if let (Some('e' | 'E'), true) = (self.peek(), real) {
            self.at += 1;
            let exponent = self.number(false, false);
            match exponent.ends_with(|c: char| c.is_ascii_digit()) {
                true => number = format!("{number}e{exponent}"),
                false => self.at = before_exponent,
            }
        }
        number
    }

    fn identifier(&mut self) -> String {
        match self.peek() {
            Some(first) if first.is_ascii_alphabetic() || first == '_' => {
                self.take_while(|c| c.is_ascii_alphanumeric() || c == '_')
            }
            _ => String::new(),
        }
    }

    fn expected(&self, what: &str) -> Fault {
        let text: String = self.characters.iter().collect();
        let colon = if self.message.is_empty() { "" } else { ": " };
        Fault::new(
            SCRIPT_ERROR,
            format!(
                "expected {what} at character {} of \"{text}\"{colon}{}",
                self.at + 1,
                self.message
            ),
        )
    }

    fn result(self, value: Value) -> Result<Value, Failure> {
        Ok(Value::Tuple(vec![value, Value::Integer(self.at as i64 + 1)]))
    }
}

const SCAN_REAL: &str = r#"
function scanReal "Reads a Real; an error if there is none."
  input String string;
  input Integer startIndex(min = 1) = 1;
  input Boolean unsigned = false "true: no sign is accepted";
  input String message = "" "added to the error";
  output Real number;
  output Integer nextIndex;
end scanReal;
"#;

fn scan_real(_: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let mut scanner = Scanner::new(&mut args)?;
    let start = scanner.at;
    let number = scanner.number(args.take("unsigned")?, true);
    match number.parse() {
        Ok(number) => scanner.result(Value::Real(number)),
        Err(_) => {
            scanner.at = start;
            Err(scanner.expected("a Real").into())
        }
    }
}

const SCAN_INTEGER: &str = r#"
function scanInteger "Reads an Integer; an error if there is none."
  input String string;
  input Integer startIndex(min = 1) = 1;
  input Boolean unsigned = false "true: no sign is accepted";
  input String message = "" "added to the error";
  output Integer number;
  output Integer nextIndex;
end scanInteger;
"#;

fn scan_integer(_: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let mut scanner = Scanner::new(&mut args)?;
    let start = scanner.at;
    let number = scanner.number(args.take("unsigned")?, false);
    match number.parse() {
        Ok(number) if !matches!(scanner.peek(), Some('.' | 'e' | 'E')) => {
            scanner.result(Value::Integer(number))
        }
        _ => {
            scanner.at = start;
            Err(scanner.expected("an Integer").into())
        }
    }
}

const SCAN_BOOLEAN: &str = r#"
function scanBoolean "Reads true or false; an error if there is neither."
  input String string;
  input Integer startIndex(min = 1) = 1;
  input String message = "" "added to the error";
  output Boolean number;
  output Integer nextIndex;
end scanBoolean;
"#;

fn scan_boolean(_: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let mut scanner = Scanner::new(&mut args)?;
    let start = scanner.at;
    match scanner.identifier().parse() {
        Ok(value) => scanner.result(Value::Boolean(value)),
        Err(_) => {
            scanner.at = start;
            Err(scanner.expected("`true` or `false`").into())
        }
    }
}

const SCAN_STRING: &str = r#"
function scanString "Reads a string in double quotes; an error if there is none."
  input String string;
  input Integer startIndex(min = 1) = 1;
  input String message = "" "added to the error";
  output String result;
  output Integer nextIndex;
end scanString;
"#;

fn scan_string(_: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let mut scanner = Scanner::new(&mut args)?;
    let rest = &scanner.characters[scanner.at..];
    let end = match rest.split_first() {
        Some(('"', inner)) => inner.iter().position(|c| *c == '"'),
        _ => None,
    };
    let Some(length) = end else {
        return Err(scanner.expected("a string in double quotes").into());
    };
    let found: String = rest[1..=length].iter().collect();
    scanner.at += length + 2;
    scanner.result(text(found))
}

const SCAN_IDENTIFIER: &str = r#"
function scanIdentifier "Reads an identifier; an error if there is none."
  input String string;
  input Integer startIndex(min = 1) = 1;
  input String message = "" "added to the error";
  output String identifier;
  output Integer nextIndex;
end scanIdentifier;
"#;

fn scan_identifier(_: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let mut scanner = Scanner::new(&mut args)?;
    match scanner.identifier() {
        found if found.is_empty() => Err(scanner.expected("an identifier").into()),
        found => scanner.result(text(found)),
    }
}

const SCAN_DELIMITER: &str = r#"
function scanDelimiter "Reads one of the delimiters; an error if there is none."
  input String string;
  input Integer startIndex(min = 1) = 1;
  input String requiredDelimiters[:] = {","};
  input String message = "" "added to the error";
  output String delimiter;
  output Integer nextIndex;
end scanDelimiter;
"#;

fn scan_delimiter(_: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let mut scanner = Scanner::new(&mut args)?;
    let delimiters: Vec<String> = args.take("requiredDelimiters")?;
    let rest: String = scanner.characters[scanner.at..].iter().collect();
    match delimiters.iter().find(|delimiter| rest.starts_with(delimiter.as_str())) {
        Some(found) => {
            scanner.at += found.chars().count();
            scanner.result(text(found.clone()))
        }
        None => Err(scanner.expected(&format!("one of {}", delimiters.join(" "))).into()),
    }
}

const SCAN_NO_TOKEN: &str = r#"
function scanNoToken "Fails unless the rest of the string is blank."
  input String string;
  input Integer startIndex(min = 1) = 1;
  input String message = "" "added to the error";
end scanNoToken;
"#;

fn scan_no_token(_: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let scanner = Scanner::new(&mut args)?;
    if scanner.peek().is_some() {
        bail!(SCRIPT_ERROR, "{}", scanner.expected("the end").message);
    }
    Ok(Value::nothing())
}
