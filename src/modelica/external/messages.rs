//! `ModelicaError`, `ModelicaInternal_*` and `ModelicaIO_*`: messages and files, through
//! [`Outside`](super::Outside).
//!
//! Not handled, and refused by name: what changes folders and the environment. The time
//! is that of Greenwich: time zones are not known.

use super::Entry;
use super::call::Call;
use crate::diag::Fault;
use crate::mat::Matrix;

pub(crate) const ENTRIES: &[Entry] = &[
    Entry::pure("ModelicaError", "t", error),
    Entry::writing("ModelicaMessage", "t", message),
    Entry::writing("ModelicaWarning", "t", message),
    Entry::writing("ModelicaInternal_print", "tt", print),
    Entry::pure("ModelicaInternal_readLine", "fnN->t", read_line),
    Entry::pure("ModelicaInternal_countLines", "f->n", count_lines),
    Entry::impure("ModelicaInternal_stat", "t->n", stat),
    Entry::impure("ModelicaInternal_fullPathName", "t->t", full_path),
    Entry::writing("ModelicaInternal_removeFile", "t", remove),
    Entry::writing("ModelicaInternal_mkdir", "t", make_folder),
    Entry::impure("ModelicaInternal_getenv", "tnTN", environment_variable),
    Entry::impure("ModelicaInternal_getTime", "NNNNNNN", time),
    Entry::pure("ModelicaStreams_closeFile", "t", nothing),
    Entry::pure("ModelicaIO_readMatrixSizes", "ftA", matrix_sizes),
    Entry::pure("ModelicaIO_readRealMatrix", "ftAnnn", real_matrix),
    Entry::confirming("ModelicaIO_writeRealMatrix", "ttannnt->n", write_matrix),
];

fn error(call: &mut Call<'_>) -> Result<(), Fault> {
    Err(crate::fault!(super::errors::EXTERNAL_FAILED, "{}", call.text(0).trim_end()))
}

fn nothing(_: &mut Call<'_>) -> Result<(), Fault> {
    Ok(())
}

fn message(call: &mut Call<'_>) -> Result<(), Fault> {
    let text = call.strings[call.arguments[0].first as usize].clone();
    call.outside.print(text.trim_end_matches('\n'))
}

fn print(call: &mut Call<'_>) -> Result<(), Fault> {
    if call.text(1).is_empty() {
        return message(call);
    }
    let (line, path) = (format!("{}\n", call.text(0)), call.text(1).to_owned());
    call.outside.append(&path, line.as_bytes())
}

fn remove(call: &mut Call<'_>) -> Result<(), Fault> {
    let path = call.text(0).to_owned();
    call.outside.remove(&path)
}

fn make_folder(call: &mut Call<'_>) -> Result<(), Fault> {
    let path = call.text(0).to_owned();
    call.outside.make_folder(&path)
}

/// The content of the file that an argument names.
fn content(call: &mut Call<'_>, argument: usize) -> Result<String, Fault> {
    let path = call.text(argument).to_owned();
    let bytes = call.outside.read(&path)?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

fn read_line(call: &mut Call<'_>) -> Result<(), Fault> {
    let content = content(call, 0)?;
    let number = usize::try_from(call.whole(1) - 1);
    let line = number.ok().and_then(|number| content.lines().nth(number));
    call.set(2, f64::from(u8::from(line.is_none())));
    call.give_text(line.unwrap_or_default())
}

fn count_lines(call: &mut Call<'_>) -> Result<(), Fault> {
    let lines = content(call, 0)?.lines().count();
    call.give(lines as f64)
}

/// `Modelica.Utilities.Types.FileType`: no file, regular file, directory.
fn stat(call: &mut Call<'_>) -> Result<(), Fault> {
    let path = call.text(0).to_owned();
    let kind = match call.outside.is_folder(&path)? {
        None => 1.0,
        Some(false) => 2.0,
        Some(true) => 3.0,
    };
    call.give(kind)
}

fn full_path(call: &mut Call<'_>) -> Result<(), Fault> {
    let path = call.text(0).to_owned();
    let full = call.outside.full_path(&path)?;
    call.give_text(&full)
}

/// `(name, convertToSlash, content, exist)`
fn environment_variable(call: &mut Call<'_>) -> Result<(), Fault> {
    let name = call.text(0).to_owned();
    let content = call.outside.environment_variable(&name)?;
    call.set(3, f64::from(u8::from(content.is_some())));
    let content = content.unwrap_or_default();
    match call.truth(1) {
        false => call.set_text(2, &content),
        true => call.set_text(2, &content.replace('\\', "/")),
    }
    Ok(())
}

/// `(ms, sec, min, hour, day, mon, year)`
fn time(call: &mut Call<'_>) -> Result<(), Fault> {
    let parts = date_and_time(call.outside.unix_seconds()?);
    for (argument, part) in parts.into_iter().enumerate() {
        call.set(argument, part as f64);
    }
    Ok(())
}

/// Milliseconds (always 0), second, minute, hour, day, month and year in UTC, so many seconds after
/// the beginning of 1970.
pub fn date_and_time(seconds: u64) -> [u64; 7] {
    let (year, month, day) = date(seconds / 86_400);
    [0, seconds % 60, seconds / 60 % 60, seconds / 3600 % 24, day, month, year]
}

/// Year, month and day, `days` days after 1970-01-01.
fn date(days: u64) -> (u64, u64, u64) {
    let is_leap = |year: u64| {
        year.is_multiple_of(4) && (!year.is_multiple_of(100) || year.is_multiple_of(400))
    };
    // Whole periods of 400 years are skipped, so that few years are counted.
    let (mut year, mut days) = (1970 + days / 146_097 * 400, days % 146_097);
    while days >= 365 + u64::from(is_leap(year)) {
        days -= 365 + u64::from(is_leap(year));
        year += 1;
    }
    let february = 28 + u64::from(is_leap(year));
    let mut month = 1;
    for length in [31, february, 31, 30, 31, 30, 31, 31, 30, 31, 30] {
        if days < length {
            break;
        }
        days -= length;
        month += 1;
    }
    (year, month, days + 1)
}

fn matrix(call: &mut Call<'_>) -> Result<crate::mat::Matrix, Fault> {
    let path = call.text(0).to_owned();
    let bytes = call.outside.read(&path)?;
    crate::mat::read(&bytes)?.matrix(call.text(1)).cloned()
}

fn matrix_sizes(call: &mut Call<'_>) -> Result<(), Fault> {
    let matrix = matrix(call)?;
    match call.array_mut(2) {
        [rows, columns] => [*rows, *columns] = [matrix.rows as f64, matrix.columns as f64],
        _ => return Err(call.fault("the sizes are written to a vector of two elements")),
    }
    Ok(())
}

fn real_matrix(call: &mut Call<'_>) -> Result<(), Fault> {
    let matrix = matrix(call)?;
    if *call.dims(2) != [matrix.rows as u32, matrix.columns as u32] {
        return Err(call.fault(format!(
            "the matrix `{}` has {} rows and {} columns",
            call.text(1),
            matrix.rows,
            matrix.columns
        )));
    }
    let columns = matrix.columns;
    for (position, element) in call.array_mut(2).iter_mut().enumerate() {
        *element = matrix.get(position / columns, position % columns);
    }
    Ok(())
}

/// `(file, name, matrix, rows, columns, append, version)`; whether it was written.
fn write_matrix(call: &mut Call<'_>) -> Result<(), Fault> {
    let (path, name) = (call.text(0).to_owned(), call.text(1).to_owned());
    let [rows, columns] = *call.dims(2) else {
        return Err(call.fault("expected a matrix to write"));
    };
    let values = call.array(2).to_vec();
    let columns_first = (0..values.len()).map(|at| {
        let (column, row) = (at / rows as usize, at % rows as usize);
        values[row * columns as usize + column]
    });
    let matrix = Matrix::from_columns(rows as usize, columns as usize, columns_first.collect());
    let mut arrays: Vec<(String, Matrix)> = Vec::new();
    if call.truth(5) {
        let known = call.outside.read(&path)?;
        arrays.extend(
            crate::mat::read(&known)?.arrays.into_iter().filter(|(known, _)| *known != name),
        );
    }
    arrays.push((name, matrix));
    let arrays = arrays.iter().map(|(name, matrix)| (name.as_str(), matrix));
    let bytes = match call.text(6) {
        "4" => crate::mat::write_v4(arrays),
        "6" | "7" => crate::mat::write_v5(arrays),
        other => Err(call.fault(format!("there is no version `{other}` of MAT files"))),
    }?;
    call.outside.write(&path, &bytes)?;
    call.give(1.0)
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
