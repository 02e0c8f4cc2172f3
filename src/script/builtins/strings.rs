//! `Modelica.Utilities.Strings`: positions count characters from 1, as the library defines them.

use super::{Args, Builtin, Failure, Family};
use crate::Session;
use crate::bail;
use crate::diag::Fault;
use crate::errors::{BAD_ARGUMENT, SCRIPT_ERROR};
use crate::name::{Ident, Name};
use crate::value::{
    ArrayValue, Elements, EnumerationDefinition, EnumerationValue, Value, check_length,
};
use std::sync::{Arc, LazyLock};

/// The commands of this file.
pub(super) const FAMILY: Family = Family {
    packages: &["Modelica.Utilities.Strings"],
    dialect: None,
    builtins: &[
        Builtin { header: LENGTH, run: length },
        Builtin { header: SUBSTRING, run: substring },
        Builtin { header: REPEAT, run: repeat },
        Builtin { header: COMPARE, run: compare },
        Builtin { header: IS_EQUAL, run: is_equal },
        Builtin { header: IS_EMPTY, run: is_empty },
        Builtin { header: COUNT, run: count },
        Builtin { header: FIND, run: find },
        Builtin { header: FIND_LAST, run: find_last },
        Builtin { header: REPLACE, run: replace },
        Builtin { header: SORT, run: sort },
        Builtin { header: HASH_STRING, run: hash_string },
        Builtin { header: SYNTAX_ERROR, run: syntax_error },
    ],
};

const LENGTH: &str = r#"
function length "Number of characters of a string."
  input String string;
  output Integer result;
end length;
"#;

fn length(_: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let string: String = args.take("string")?;
    Ok(Value::Integer(string.chars().count() as i64))
}

const SUBSTRING: &str = r#"
function substring "The characters from startIndex to endIndex."
  input String string;
  input Integer startIndex "position of the first character, from 1";
  input Integer endIndex "position of the last character";
  output String result;
end substring;
"#;

fn substring(_: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let string = characters(args.take("string")?);
    let (start, end): (i64, i64) = (args.take("startIndex")?, args.take("endIndex")?);
    let length = string.len() as i64;
    if start < 1 || end > length || end < start - 1 {
        bail!(
            BAD_ARGUMENT,
            "`substring` from {start} to {end} is outside a string of {length} characters"
        );
    }
    Ok(text(string[start as usize - 1..end as usize].iter().collect()))
}

const REPEAT: &str = r#"
function repeat "A string repeated n times."
  input Integer n(min = 0) = 1;
  input String string = " ";
  output String repeatedString;
end repeat;
"#;

fn repeat(_: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let (n, string): (i64, String) = (args.take("n")?, args.take("string")?);
    let size = usize::try_from(n).ok().and_then(|n| n.checked_mul(string.len().max(1)));
    match size {
        Some(size) => {
            check_length(size)?;
            Ok(text(string.repeat(n as usize)))
        }
        None => bail!(BAD_ARGUMENT, "`n` of `repeat` is {n}: negative or too large"),
    }
}

const COMPARE: &str = r#"
function compare "Compares two strings in the order of their characters."
  input String string1;
  input String string2;
  input Boolean caseSensitive = true;
  output Any result "Modelica.Utilities.Types.Compare: Less, Equal or Greater";
end compare;
"#;

/// `Modelica.Utilities.Types.Compare`.
static COMPARE_TYPE: LazyLock<Arc<EnumerationDefinition>> = LazyLock::new(|| {
    Arc::new(EnumerationDefinition {
        name: Name::parse("Modelica.Utilities.Types.Compare"),
        literals: ["Less", "Equal", "Greater"].map(Ident::new).to_vec(),
        descriptions: Vec::new(),
    })
});

/// The literal of `Modelica.Utilities.Types.Compare` of this full name.
pub(super) fn constant(name: &Name) -> Option<Value> {
    let definition = COMPARE_TYPE.clone();
    let literal = name.last().filter(|_| name.parent().parts == definition.name.parts)?;
    let at = definition.literals.iter().position(|known| *known == literal)?;
    Some(Value::Enumeration(EnumerationValue { definition, ordinal: at as i64 + 1 }))
}

fn compare(_: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let (first, second) = two(&mut args)?;
    let ordinal = first.cmp(&second) as i64 + 2;
    Ok(Value::Enumeration(EnumerationValue { definition: COMPARE_TYPE.clone(), ordinal }))
}

const IS_EQUAL: &str = r#"
function isEqual "Whether two strings are the same."
  input String string1;
  input String string2;
  input Boolean caseSensitive = true;
  output Boolean identical;
end isEqual;
"#;

fn is_equal(_: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let (first, second) = two(&mut args)?;
    Ok(Value::Boolean(first == second))
}

fn two(args: &mut Args) -> Result<(String, String), Fault> {
    let (first, second): (String, String) = (args.take("string1")?, args.take("string2")?);
    Ok(match args.take("caseSensitive")? {
        true => (first, second),
        false => (first.to_lowercase(), second.to_lowercase()),
    })
}

const IS_EMPTY: &str = r#"
function isEmpty "Whether a string contains only blanks."
  input String string;
  output Boolean result;
end isEmpty;
"#;

fn is_empty(_: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let string: String = args.take("string")?;
    Ok(Value::Boolean(string.trim().is_empty()))
}

/// The inputs that `count`, `find` and `replace` share.
struct Search {
    string: Vec<char>,
    pattern: Vec<char>,
    start: usize,
    case_sensitive: bool,
}

impl Search {
    fn new(args: &mut Args) -> Result<Search, Fault> {
        let string = characters(args.take("string")?);
        let start: i64 = args.take("startIndex")?;
        Ok(Search {
            start: usize::try_from(start - 1).unwrap_or(0).min(string.len()),
            string,
            pattern: characters(args.take("searchString")?),
            case_sensitive: args.take("caseSensitive")?,
        })
    }

    fn is_at(&self, at: usize) -> bool {
        let Some(part) = self.string.get(at..at + self.pattern.len()) else { return false };
        let same = |a: &char, b: &char| {
            a == b || !self.case_sensitive && a.to_lowercase().eq(b.to_lowercase())
        };
        !self.pattern.is_empty() && part.iter().zip(&self.pattern).all(|(a, b)| same(a, b))
    }

    fn next_from(&self, from: usize) -> Option<usize> {
        (from..self.string.len()).find(|at| self.is_at(*at))
    }
}

const COUNT: &str = r#"
function count "Number of non-overlapping occurrences of one string in another."
  input String string;
  input String searchString;
  input Integer startIndex(min = 1) = 1;
  input Boolean caseSensitive = true;
  output Integer result;
end count;
"#;

fn count(_: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let search = Search::new(&mut args)?;
    let (mut from, mut number) = (search.start, 0);
    while let Some(at) = search.next_from(from) {
        number += 1;
        from = at + search.pattern.len();
    }
    Ok(Value::Integer(number))
}

const FIND: &str = r#"
function find "Position of the first occurrence of one string in another, 0 if there is none."
  input String string;
  input String searchString;
  input Integer startIndex(min = 1) = 1 "first position to search";
  input Boolean caseSensitive = true;
  output Integer index;
end find;
"#;

fn find(_: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let search = Search::new(&mut args)?;
    Ok(Value::Integer(search.next_from(search.start).map_or(0, |at| at as i64 + 1)))
}

const FIND_LAST: &str = r#"
function findLast "Position of the last occurrence of one string in another, 0 if there is none."
  input String string;
  input String searchString;
  input Integer startIndex(min = 0) = 0 "first position to search, backwards; 0 is the end";
  input Boolean caseSensitive = true;
  output Integer index;
end findLast;
"#;

fn find_last(_: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let search = Search::new(&mut args)?;
    let end = if search.start == 0 { search.string.len() } else { search.start + 1 };
    let found = (0..end.min(search.string.len())).rev().find(|at| search.is_at(*at));
    Ok(Value::Integer(found.map_or(0, |at| at as i64 + 1)))
}

const REPLACE: &str = r#"
function replace "Replaces occurrences of one string in another."
  input String string;
  input String searchString;
  input String replaceString;
  input Integer startIndex(min = 1) = 1;
  input Boolean replaceAll = true "false: only the first";
  input Boolean caseSensitive = true;
  output String result;
end replace;
"#;

fn replace(_: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let search = Search::new(&mut args)?;
    let (by, all): (String, bool) = (args.take("replaceString")?, args.take("replaceAll")?);
    let mut result: String = search.string[..search.start].iter().collect();
    let mut from = search.start;
    while let Some(at) = search.next_from(from) {
        result.extend(&search.string[from..at]);
        check_length(result.len().saturating_add(by.len()))?;
        result.push_str(&by);
        from = at + search.pattern.len();
        if !all {
            break;
        }
    }
    result.extend(&search.string[from..]);
    Ok(text(result))
}

const SORT: &str = r#"
function sort "The strings in alphabetic order."
  input String stringVector1[:];
  input Boolean caseSensitive = true;
  output String stringVector2[size(stringVector1, 1)];
end sort;
"#;

fn sort(_: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let mut strings: Vec<String> = args.take("stringVector1")?;
    match args.take("caseSensitive")? {
        true => strings.sort(),
        false => strings.sort_by_key(|string| string.to_lowercase()),
    }
    Ok(string_array(strings))
}

const HASH_STRING: &str = r#"
function hashString "A hash of a string (Partow's AP hash)."
  input String string;
  output Integer hash;
end hashString;
"#;

fn hash_string(_: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let string: String = args.take("string")?;
    Ok(Value::Integer(i64::from(ap_hash(string.as_bytes()))))
}

/// The general-purpose hash function AP of A. Partow, as a signed number.
fn ap_hash(bytes: &[u8]) -> i32 {
    let hash = bytes.iter().enumerate().fold(0xAAAA_AAAA_u32, |hash, (at, byte)| {
        let byte = u32::from(*byte);
        hash ^ match at % 2 {
            0 => (hash << 7) ^ byte.wrapping_mul(hash >> 3),
            _ => !((hash << 11).wrapping_add(byte ^ (hash >> 5))),
        }
    });
    hash as i32
}

const SYNTAX_ERROR: &str = r#"
function syntaxError "Stops with an error that shows a position in a string."
  input String string;
  input Integer index "position of the error, from 1";
  input String message = "";
end syntaxError;
"#;

fn syntax_error(_: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let (string, index, message): (String, i64, String) =
        (args.take("string")?, args.take("index")?, args.take("message")?);
    let colon = if message.is_empty() { "" } else { ": " };
    bail!(SCRIPT_ERROR, "syntax error at character {index} of \"{string}\"{colon}{message}")
}

fn characters(string: String) -> Vec<char> {
    string.chars().collect()
}

/// A string as a value.
pub(super) fn text(string: String) -> Value {
    Value::String(string.into())
}

/// Strings as a vector.
pub(super) fn string_array(strings: impl IntoIterator<Item = String>) -> Value {
    let elements = strings.into_iter().map(Into::into).collect();
    Value::Array(ArrayValue::vector(Elements::String(elements)))
}

#[cfg(test)]
mod tests {
    use super::ap_hash;

    #[test]
    fn ap_hash_gives_the_documented_values() {
        assert_eq!(ap_hash(b"this is a test"), 1_827_717_433);
        assert_eq!(ap_hash(b"Controller.noise1"), -1_025_762_750);
    }
}
