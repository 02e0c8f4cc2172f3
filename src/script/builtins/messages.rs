//! What went wrong, as scripts can ask for it.

use super::strings::text;
use super::{Args, Builtin, Failure, Family};
use crate::Session;
use crate::value::Value;

/// The commands of this file.
pub(super) const FAMILY: Family = Family {
    packages: &[],
    dialect: None,
    builtins: &[
        Builtin { header: GET_ERROR_STRING, run: get_error_string },
        Builtin { header: GET_MESSAGES_STRING, run: get_messages_string },
        Builtin { header: GET_LAST_ERROR, run: get_last_error },
        Builtin { header: COUNT_MESSAGES, run: count_messages },
        Builtin { header: CLEAR_MESSAGES, run: clear_messages },
        Builtin { header: CLEARLOG, run: clear_messages },
        Builtin { header: MESSAGE_DIALOG, run: message_dialog },
    ],
};

const GET_ERROR_STRING: &str = r#"
function getErrorString "Returns the messages since the last call, one per line, and clears them."
  input Boolean warningsAsErrors = false "whether warnings are reported as errors";
  output String errorString;
end getErrorString;
"#;

const GET_MESSAGES_STRING: &str = r#"
function getMessagesString "Returns the messages since the last call, one per line, and clears them."
  output String messagesString;
end getMessagesString;
"#;

fn get_error_string(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let warnings_as_errors = args.take("warningsAsErrors")?;
    Ok(text(session.output.messages.take_text(&session.sources, warnings_as_errors)))
}

fn get_messages_string(session: &mut Session, _: Args) -> Result<Value, Failure> {
    Ok(text(session.output.messages.take_text(&session.sources, false)))
}

const GET_LAST_ERROR: &str = r#"
function getLastError "The message of the last error since the last call; empty if a later command succeeded (returned true). Clears the messages."
  output String errorMessage;
end getLastError;
"#;

fn get_last_error(session: &mut Session, _: Args) -> Result<Value, Failure> {
    Ok(text(session.output.messages.take_last_error()))
}

const COUNT_MESSAGES: &str = r#"
function countMessages "Numbers of messages that getErrorString would return."
  output Integer numMessages;
  output Integer numErrors;
  output Integer numWarnings;
end countMessages;
"#;

fn count_messages(session: &mut Session, _: Args) -> Result<Value, Failure> {
    let [notes, warnings, errors] = session.output.messages.counts();
    let all = [notes + warnings + errors, errors, warnings];
    Ok(Value::Tuple(all.map(|count| Value::Integer(count as i64)).to_vec()))
}

const CLEAR_MESSAGES: &str = r#"
function clearMessages "Clears the messages."
  output Boolean ok;
end clearMessages;
"#;

const CLEARLOG: &str = r#"
function clearlog "Clears the messages."
  output Boolean ok;
end clearlog;
"#;

fn clear_messages(session: &mut Session, _: Args) -> Result<Value, Failure> {
    session.output.messages.clear();
    Ok(Value::Boolean(true))
}

const MESSAGE_DIALOG: &str = r#"
function messageDialog "Prints a message; there is no window to confirm it in."
  input String message;
  input Real timeOut = 0 "has no effect";
  output Boolean ok;
end messageDialog;
"#;

fn message_dialog(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let message: String = args.take("message")?;
    session.print_of_script(&format!("{message}\n"));
    Ok(Value::Boolean(true))
}
