//! Numbers as strings, as Dymola's scripts write them.

use super::{Args, Builtin, Failure, Family};
use crate::Session;
use crate::value::Value;
use crate::value::format;

/// The commands of this file.
pub(super) const FAMILY: Family = Family {
    packages: &[],
    dialect: None,
    builtins: &[
        Builtin { header: REAL_STRING, run: real_string },
        Builtin { header: INTEGER_STRING, run: integer_string },
        Builtin { header: BOOLEAN_STRING, run: boolean_string },
    ],
};

const REAL_STRING: &str = r#"
function realString "A Real as a string."
  input Real number;
  input Integer minimumWidth = 1;
  input Integer precision = 6 "significant digits";
  output String result;
end realString;
"#;

fn real_string(_: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let (number, width, precision): (f64, i64, i64) =
        (args.take("number")?, args.take("minimumWidth")?, args.take("precision")?);
    Ok(Value::String(format::text(&Value::Real(number), precision, width, false)?))
}

const INTEGER_STRING: &str = r#"
function integerString "An Integer as a string."
  input Integer number;
  input Integer minimumWidth = 1;
  output String result;
end integerString;
"#;

fn integer_string(_: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let (number, width): (i64, i64) = (args.take("number")?, args.take("minimumWidth")?);
    Ok(Value::String(format::text(&Value::Integer(number), 6, width, false)?))
}

const BOOLEAN_STRING: &str = r#"
function booleanString "A Boolean as a string."
  input Boolean value;
  input Integer minimumWidth = 1;
  output String result;
end booleanString;
"#;

fn boolean_string(_: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let (value, width): (bool, i64) = (args.take("value")?, args.take("minimumWidth")?);
    Ok(Value::String(format::text(&Value::Boolean(value), 6, width, false)?))
}
