//! The time of day, and names that are free at the time.

use super::{Args, Builtin, Failure, Family};
use crate::script::Session;
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
function getTime "The date and the time of day, in UTC; the beginning of 1970 where there is no clock."
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
    let seconds = session.world.unix_seconds() as i64;
    let (days, second) = (seconds.div_euclid(86_400), seconds.rem_euclid(86_400));
    let (year, month, day) = date(days);
    let all = [0, second % 60, second / 60 % 60, second / 3600, day, month, year];
    Ok(Value::Tuple(all.map(Value::Integer).to_vec()))
}

/// Year, month and day, of a number of days after 1970-01-01, in the Gregorian calendar.
fn date(mut days: i64) -> (i64, i64, i64) {
    let mut year = 1970 + days / 146_097 * 400;
    days %= 146_097;
    while days >= length_of_year(year) {
        days -= length_of_year(year);
        year += 1;
    }
    let february = length_of_year(year) - 337;
    let lengths = [31, february, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31];
    let mut month = 0;
    while days >= lengths[month] {
        days -= lengths[month];
        month += 1;
    }
    (year, month as i64 + 1, days + 1)
}

fn length_of_year(year: i64) -> i64 {
    let is_leap = year % 4 == 0 && (year % 100 != 0 || year % 400 == 0);
    365 + i64::from(is_leap)
}

const GET_PID: &str = r#"
function getPid "The number of this process; 0 where there is none."
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

#[cfg(test)]
mod tests {
    use super::date;

    #[test]
    fn days_have_dates() {
        assert_eq!(date(0), (1970, 1, 1));
        assert_eq!(date(59), (1970, 3, 1));
        assert_eq!(date(11_016), (2000, 2, 29));
        assert_eq!(date(11_322), (2000, 12, 31));
        assert_eq!(date(20_778), (2026, 11, 21));
        assert_eq!(date(47_540), (2100, 2, 28));
        assert_eq!(date(47_541), (2100, 3, 1));
        assert_eq!(date(146_097), (2370, 1, 1));
    }
}
