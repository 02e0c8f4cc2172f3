//! Regular expressions and encodings of OpenModelica's scripts.

use super::strings::text;
use super::{Args, Builtin, Failure, Family};
use crate::bail;
use crate::diag::Fault;
use crate::errors::BAD_ARGUMENT;
use crate::fault;
use crate::value::Value;
use crate::{Dialect, Session};
use regex::{Regex, RegexBuilder};

/// The commands of this file.
pub(super) const FAMILY: Family = Family {
    packages: &["OpenModelica.Scripting"],
    dialect: Some(Dialect::OpenModelica),
    builtins: &[
        Builtin { header: REGEX, run: regex },
        Builtin { header: REGEX_BOOL, run: regex_bool },
        Builtin { header: ICONV, run: iconv },
    ],
};

/// Bytes that a compiled expression may take.
const MAX_SIZE: usize = 1 << 20;

const REGEX: &str = r#"
function regex "Searches a string for a regular expression; returns the matched parts."
  input String str;
  input String re;
  input Integer maxMatches = 1 "number of strings returned: the match, then its groups";
  input Boolean extended = true "false is not supported";
  input Boolean caseInsensitive = false;
  output Integer numMatches "number of returned strings that are parts of str";
  output String matchedSubstrings[maxMatches];
end regex;
"#;

const REGEX_BOOL: &str = r#"
function regexBool "Whether a regular expression matches in a string."
  input String str;
  input String re;
  input Boolean extended = true "false is not supported";
  input Boolean caseInsensitive = false;
  output Boolean matches;
end regexBool;
"#;

fn compiled(args: &mut Args) -> Result<Regex, Fault> {
    let expression: String = args.take("re")?;
    if !args.take::<bool>("extended")? {
        bail!(BAD_ARGUMENT, "basic regular expressions are not supported: omit `extended = false`");
    }
    RegexBuilder::new(&expression)
        .case_insensitive(args.take("caseInsensitive")?)
        .size_limit(MAX_SIZE)
        .build()
        .map_err(|error| {
            let reason = error.to_string();
            let last = reason.lines().last().unwrap_or_default().trim_start_matches("error: ");
            fault!(BAD_ARGUMENT, "`{expression}` is not a valid regular expression: {last}")
        })
}

fn regex(_: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let (subject, requested): (String, i64) = (args.take("str")?, args.take("maxMatches")?);
    let requested = usize::try_from(requested).ok().filter(|requested| *requested <= 1000);
    let Some(requested) = requested else {
        bail!(BAD_ARGUMENT, "`maxMatches` must be between 0 and 1000")
    };
    let found = compiled(&mut args)?.captures(&subject).map_or(Vec::new(), |captures| {
        let parts = captures.iter().take(requested);
        parts.map(|part| part.map_or(String::new(), |part| part.as_str().to_owned())).collect()
    });
    let count = found.len() as i64;
    let mut strings = found;
    strings.resize(requested, String::new());
    Ok(Value::Tuple(vec![count.into(), strings.into()]))
}

fn regex_bool(_: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let subject: String = args.take("str")?;
    Ok(compiled(&mut args)?.is_match(&subject).into())
}

const ICONV: &str = r#"
function iconv "Converts the encoding of a string; strings are Unicode here, so it is returned unchanged."
  input String string;
  input String from;
  input String to = "UTF-8";
  output String result;
end iconv;
"#;

fn iconv(_: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let known = |name: &str| {
        ["UTF-8", "UTF8", "ISO-8859-1", "LATIN1", "ASCII", "US-ASCII"]
            .iter()
            .any(|known| known.eq_ignore_ascii_case(name))
    };
    for name in ["from", "to"] {
        let encoding: String = args.take(name)?;
        if !known(&encoding) {
            bail!(BAD_ARGUMENT, "the encoding `{encoding}` is unknown");
        }
    }
    Ok(text(args.take::<String>("string")?))
}
