//! Functions that the library IBPSA, and the libraries of buildings that are made from it, bring
//! along in C: here after their documentation, so that no compiler is needed.

mod schedule;
mod sha1;

use super::Entry;
use super::call::Call;
use crate::diag::Fault;
use schedule::Schedule;

pub(crate) const ENTRIES: &[Entry] = &[
    Entry::pure("getTimeSpan", "ftA", time_span).for_source("getTimeSpan"),
    Entry::pure("cryptographicsHash", "t->t", hash).for_source("cryptographicsHash"),
    Entry::pure("weeklyScheduleInit", "ngnt->o", new_schedule).for_source("WeeklySchedule"),
    Entry::pure("weeklyScheduleFree", "o", free_schedule).for_source("WeeklySchedule"),
    Entry::stepwise("getScheduleValue", "onn->n", schedule_value).for_source("WeeklySchedule"),
];

/// `(file, table, span)`: the first time stamp, and the last one plus the average increment.
fn time_span(call: &mut Call<'_>) -> Result<(), Fault> {
    let (path, name) = (call.text(0).to_owned(), call.text(1).to_owned());
    let bytes = call.outside.read(&path)?;
    let table = crate::mat::read(&bytes)?;
    let table = table.matrix(&name)?;
    if table.rows < 2 || table.columns == 0 {
        return Err(call.fault(format!("the table `{name}` of `{path}` needs two time stamps")));
    }
    let (first, last) = (table.get(0, 0), table.get(table.rows - 1, 0));
    let increment = (last - first) / (table.rows - 1) as f64;
    match call.array_mut(2) {
        [start, end] => [*start, *end] = [first, last + increment],
        _ => return Err(call.fault("the time span is written to a vector of two elements")),
    }
    Ok(())
}

fn hash(call: &mut Call<'_>) -> Result<(), Fault> {
    let digest = sha1::digest(call.text(0).as_bytes());
    call.give_text(&digest)
}

/// `(on file, file or instance, offset, data)`
fn new_schedule(call: &mut Call<'_>) -> Result<(), Fault> {
    let text = match call.truth(0) {
        true => {
            let path = call.text(1).to_owned();
            String::from_utf8_lossy(&call.outside.read(&path)?).into_owned()
        }
        false => call.text(3).to_owned(),
    };
    let schedule = Schedule::read(&text, call.number(2)).map_err(|why| call.fault(why))?;
    call.give_object(schedule)
}

fn free_schedule(_: &mut Call<'_>) -> Result<(), Fault> {
    Ok(())
}

/// `(schedule, column, time)`: column 1 is the one after the time.
fn schedule_value(call: &mut Call<'_>) -> Result<(), Fault> {
    let (column, time) = (call.whole(1), call.number(2));
    let value = call.object::<Schedule>(0)?.value(column, time);
    match value {
        Some(value) => call.give(value),
        None => Err(call.fault(format!("the schedule has no column {}", column + 1))),
    }
}
