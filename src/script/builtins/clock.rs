//! The time of day, and names that are free at the time.

use super::{Args, Builtin, Failure, Family};
use crate::Session;
use crate::external::date_and_time;
use crate::value::Value;

/// What `Modelica.Utilities.System` tells of the moment and the process.
pub(super) const FAMILY: Family = Family {
    packages: &["Modelica.Utilities.System"],
    dialect: None,
    builtins: &[
        Builtin { header: GET_TIME, run: get_time },
        Builtin { header: GET_PID, run: get_pid },
    ],
};

/// What `Modelica.Utilities.Files` tells of free names.
pub(super) const FILES: Family = Family {
    packages: &["Modelica.Utilities.Files"],
    dialect: None,
    builtins: &[Builtin { header: TEMPORARY_FILE_NAME, run: temporary_file_name }],
};

const GET_TIME: &str = r#"
function getTime "The date and the time of day, in UTC; the start of 1970 if no clock is available."
  output Integer ms "milliseconds, always 0";
  output Integer sec;
  output Integer min;
  output Integer hour;
  output Integer day;
  output Integer mon;
  output Integer year;
end getTime;
"#;

fn get_time(session: &mut Session, _: Args) -> Result<Value, Failure> {
    let all = date_and_time(session.world.unix_seconds());
    Ok(Value::Tuple(all.map(|part| Value::Integer(part as i64)).to_vec()))
}

const GET_PID: &str = r#"
function getPid "The ID of this process; 0 if not available."
  output Integer pid;
end getPid;
"#;

fn get_pid(session: &mut Session, _: Args) -> Result<Value, Failure> {
    Ok(Value::Integer(session.world.process_id().into()))
}

const TEMPORARY_FILE_NAME: &str = r#"
function temporaryFileName "The path of a file in the output folder that does not exist."
  output String fileName;
end temporaryFileName;
"#;

fn temporary_file_name(session: &mut Session, _: Args) -> Result<Value, Failure> {
    let folder = session.world.absolute(&session.world.output_dir());
    let names = (1u64..).map(|number| folder.join(format!("temporary-{number}")));
    let free = names.into_iter().find(|path| !session.world.exists(path));
    Ok(free.map_or(String::new(), |path| path.display().to_string()).into())
}
