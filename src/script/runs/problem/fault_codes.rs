//! Values that a logger or an instrument writes instead of a measurement: codes such as -999, and the
//! end of a range that a signal has left.

use crate::mat::Column;

/// What loggers write where a sensor fails.
const CODES: [f64; 14] = [
    -99.0, -999.0, -9999.0, -99_999.0, 999.0, 9999.0, 99_999.0, 999_999.0, -999.9, -999.99,
    32_767.0, -32_768.0, 65_535.0, 1e30,
];
/// A code lies this many spans of the other values beyond them.
const BEYOND: f64 = 3.0;
/// Rows that are named.
const NAMED: usize = 5;
/// The end of a range occurs this often, and so many times as often as any value within it. Noise that
/// is clipped at 4.095 V in one of ten rows of a record with 12 bits does.
const REPEATED: usize = 6;
const TIMES_AS_OFTEN: usize = 3;
/// So many of these are consecutive,
const CONSECUTIVE: usize = 3;
/// between steps larger than this part of the median one.
const ABRUPT: f64 = 0.5;

/// Sentences about codes that are used as numbers, in the rows of a column.
pub(in crate::runs) fn codes(name: &str, column: &Column) -> Vec<String> {
    let others: Vec<_> = column.known().filter(|(_, v)| !CODES.contains(v)).collect();
    let Some([low, high]) = ends(&others) else { return Vec::new() };
    let sentence = |code: f64| {
        let coded: Vec<_> = column.known().filter(|(_, v)| *v == code).collect();
        format!(
            "{code} in {} of `{name}` is far from the other values, {low} to {high}: if it is \
             the fault code of an instrument, leave the cells empty; it is used as a value",
            places(column, &coded)
        )
    };
    of(column).into_iter().map(sentence).collect()
}

/// The codes among the values of a column: those that are far from all values that are none.
pub(in crate::runs) fn of(column: &Column) -> Vec<f64> {
    // One code must not hide another: 9999 for a short circuit beside -9999 for an open one.
    let (suspects, others): (Vec<_>, Vec<_>) = column.known().partition(|(_, v)| CODES.contains(v));
    let Some([low, high]) = ends(&others).filter(|_| others.len() > 1) else { return Vec::new() };
    let is_far = |code: f64| (code - high).max(low - code) > BEYOND * (high - low);
    let occurs = |code: f64| suspects.iter().any(|(_, value)| *value == code);
    CODES.into_iter().filter(|code| is_far(*code) && occurs(*code)).collect()
}

/// A sentence about each end of the values at which a measured signal may have been cut off.
pub(in crate::runs) fn cut_off(name: &str, column: &Column) -> Vec<String> {
    let known: Vec<(usize, f64)> = column.known().collect();
    let Some(ends) = ends(&known) else { return Vec::new() };
    let mut sorted: Vec<f64> = known.iter().map(|(_, value)| *value).collect();
    sorted.sort_by(f64::total_cmp);
    let within = sorted.chunk_by(|a, b| a == b).filter(|group| !ends.contains(&group[0]));
    let usual = within.map(<[f64]>::len).max().unwrap_or(0);
    let sentence = |(end, what): (f64, &str)| {
        let (cut, _): (Vec<_>, Vec<_>) = known.iter().copied().partition(|(_, v)| *v == end);
        let is_cut = usual > 0
            && end != 0.0
            && cut.len() >= REPEATED.max(TIMES_AS_OFTEN * usual)
            && stops_abruptly(&known, end);
        is_cut.then(|| {
            format!(
                "the {what} value of `{name}`, {end}, occurs {} times, in {}: if the instrument \
                 measures no further, these values are not measurements; they are used as such",
                cut.len(),
                places(column, &cut)
            )
        })
    };
    [(ends[0], "smallest"), (ends[1], "largest")].into_iter().filter_map(sentence).collect()
}

/// Whether consecutive values at an end are reached and left in steps of usual size, not
/// necessarily the same ones: where a wave meets the end of a range, one of its two steps may be short
/// by chance. A signal that approaches a steady state does so in ever smaller ones.
fn stops_abruptly(known: &[(usize, f64)], end: f64) -> bool {
    let step = |pair: &[(usize, f64)]| (pair[1].1 - pair[0].1).abs();
    let mut steps: Vec<f64> = known.windows(2).map(step).filter(|step| *step > 0.0).collect();
    steps.sort_by(f64::total_cmp);
    let Some(usual) = steps.get(steps.len() / 2) else { return false };
    let runs: Vec<&[(usize, f64)]> = known.chunk_by(|a, b| a.1 == b.1).collect();
    let is_far = |value: f64| (value - end).abs() > ABRUPT * usual;
    let is_run = |run: &[(usize, f64)]| run[0].1 == end && run.len() >= CONSECUTIVE;
    let reached = runs.windows(2).any(|pair| is_run(pair[1]) && is_far(pair[0][0].1));
    let left = runs.windows(2).any(|pair| is_run(pair[0]) && is_far(pair[1][0].1));
    reached && left
}

fn ends(known: &[(usize, f64)]) -> Option<[f64; 2]> {
    let values = || known.iter().map(|(_, value)| *value);
    let first = values().next()?;
    Some([values().fold(first, f64::min), values().fold(first, f64::max)])
}

fn places(column: &Column, rows: &[(usize, f64)]) -> String {
    let named: Vec<String> = rows.iter().take(NAMED).map(|(row, _)| column.place(*row)).collect();
    let more = match rows.len().saturating_sub(NAMED) {
        0 => String::new(),
        more => format!(" and {more} more rows"),
    };
    format!("{}{more}", named.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mat::About;

    fn column(values: Vec<f64>) -> Column {
        Column { values, about: About::default(), missing: None }
    }

    fn wave(change: impl Fn(usize, f64) -> f64) -> Column {
        let value = |k: usize| change(k, 20.0 + 3.0 * (0.1 * k as f64).sin());
        column((0..200).map(value).collect())
    }

    #[test]
    fn codes_far_from_the_values_are_named_with_their_rows() {
        let found = codes("T", &wave(|k, v| if k % 90 == 7 { -999.0 } else { v }));
        assert_eq!(found.len(), 1);
        assert!(found[0].starts_with("-999 in row 8, row 98, row 188 of `T`"), "{}", found[0]);
        let several = |k: usize, v: f64| match k % 90 {
            7 => -9999.0,
            8 => 9999.0,
            9 => 1e30,
            _ => v,
        };
        assert_eq!(codes("T", &wave(several)).len(), 3, "each of several codes");
        // A resistance of 999 Ohm among such of 500 to 1500.
        assert!(
            codes("R", &wave(|k, _| if k == 9 { 999.0 } else { 500.0 + 5.0 * k as f64 }))
                .is_empty()
        );
        assert!(codes("T", &column(vec![-999.0; 5])).is_empty(), "nothing to compare with");
    }

    #[test]
    fn the_end_of_a_range_is_named_where_a_signal_stays_there() {
        let found = cut_off("U", &wave(|_, v| v.min(22.0)));
        assert_eq!(found.len(), 1);
        assert!(found[0].starts_with("the largest value of `U`, 22, occurs "), "{}", found[0]);
        for uncut in [
            wave(|_, v| v),
            wave(|_, v| v.round()),
            wave(|k, v| if k % 2 == 0 { 0.0 } else { v }),
            wave(|k, _| if k < 100 { 0.0 } else { 1.0 }),
            // Steady states in three digits, left by a step.
            wave(|k, _| 1.0 - (1000.0 * (-0.1 * (k % 100) as f64).exp()).round() / 1000.0),
        ] {
            assert_eq!(cut_off("U", &uncut), [""; 0]);
        }
    }
}
