//! Values that a logger or an instrument writes instead of a measurement: codes such as -999, spikes far
//! from all other values, the end of a range that a signal has left, and the last value of a sensor that
//! answers no more.

use crate::mat::Column;

/// What loggers write where a sensor fails.
const CODES: [f64; 13] = [
    -99.0, -999.0, -9999.0, -99_999.0, 999.0, 9999.0, 99_999.0, 999_999.0, -999.9, -999.99,
    32_767.0, -32_768.0, 65_535.0,
];
/// Values of this size are no measurements: instruments write 9.9E37 for an overflow and 9.91E37 for what is
/// not a number (SCPI 1999), programs the largest number of their type.
const OVERFLOW: f64 = 1e30;
/// A code lies this many spans of the other values beyond them.
const BEYOND: f64 = 3.0;
/// Spikes lie in at most one row of this many, and in so few consecutive ones: the pulses of an input are
/// longer, or more frequent. 85 °C, with which a digital thermometer starts, may come twice.
const SPIKES: usize = 20;
const TOGETHER: usize = 2;
/// A sensor is frozen where this many consecutive values are equal,
const FROZEN: usize = 20;
/// chance makes such runs less often than this,
const BY_CHANCE: f64 = 1e-6;
/// and the other values are noisy: this part of their steps reverses the one before. In the temperature of a room with
/// 0.05 K of noise it is 0.21; a programme of ramps, which also stands still, hardly reverses.
const REVERSALS: f64 = 0.1;
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

/// Sentences about codes and spikes that are used as numbers, in the rows of a column.
pub(in crate::runs) fn codes(name: &str, column: &Column) -> Vec<String> {
    let found = of(column);
    let others: Vec<_> = column.known().filter(|(_, v)| !found.contains(v)).collect();
    let Some([low, high]) = ends(&others) else { return Vec::new() };
    let sentence = |code: &f64| {
        let coded: Vec<_> = column.known().filter(|(_, v)| v == code).collect();
        let shown = match code.abs() >= OVERFLOW {
            true => format!("{code:E}"),
            false => code.to_string(),
        };
        format!(
            "{shown} in {} of `{name}` is far from the other values, {low} to {high}: if it is \
             the fault code of an instrument or a spike, leave the cells empty; it is used as a \
             value",
            places(column, &coded)
        )
    };
    found.iter().map(sentence).collect()
}

/// The codes and spikes among the values of a column: those that are far from all values that are none.
pub(in crate::runs) fn of(column: &Column) -> Vec<f64> {
    // One code must not hide another: 9999 for a short circuit beside -9999 for an open one.
    let is_code = |code: f64| code.abs() >= OVERFLOW || CODES.contains(&code);
    let (suspects, others): (Vec<_>, Vec<_>) = column.known().partition(|(_, v)| is_code(*v));
    let Some([low, high]) = ends(&others).filter(|_| others.len() > 1) else { return Vec::new() };
    let is_far = |code: f64| (code - high).max(low - code) > BEYOND * (high - low);
    let mut found: Vec<f64> =
        suspects.into_iter().map(|(_, code)| code).filter(|code| is_far(*code)).collect();
    found.sort_by(f64::total_cmp);
    found.dedup();
    found.extend(spikes(&others));
    found
}

/// Values far from all others, in rows whose neighbours are not.
fn spikes(known: &[(usize, f64)]) -> Vec<f64> {
    let mut sorted: Vec<f64> = known.iter().map(|(_, value)| *value).collect();
    sorted.sort_by(f64::total_cmp);
    let most = sorted.len() / SPIKES;
    let Some(last) = sorted.len().checked_sub(most + 1).filter(|_| most > 0) else {
        return Vec::new();
    };
    // Where all others are equal, a single pulse is what the input is meant to be.
    let spread = sorted[last] - sorted[most];
    let [from, to] = [sorted[most] - BEYOND * spread, sorted[last] + BEYOND * spread];
    let is_far = |value: f64| value < from || value > to;
    let together = known.chunk_by(|a, b| is_far(a.1) && is_far(b.1)).map(<[_]>::len).max();
    let alone = together.is_some_and(|count| count <= TOGETHER);
    if spread == 0.0 || !alone {
        return Vec::new();
    }
    let mut found: Vec<f64> = sorted.into_iter().filter(|value| is_far(*value)).collect();
    found.dedup();
    found
}

/// A sentence about the longest run of equal values of a sensor that measures noise elsewhere.
pub(in crate::runs) fn frozen(name: &str, column: &Column) -> Option<String> {
    let known: Vec<(usize, f64)> = column.known().collect();
    let ends = ends(&known)?;
    let runs: Vec<&[(usize, f64)]> = known.chunk_by(|a, b| a.1 == b.1).collect();
    let longest = runs.iter().max_by_key(|run| run.len())?;
    // A signal may rest at the end of its range.
    if longest.len() < FROZEN || ends.contains(&longest[0].1) {
        return None;
    }
    let reversals = runs.windows(3).filter(|three| {
        let [a, b, c] = [three[0][0].1, three[1][0].1, three[2][0].1];
        (b - a) * (c - b) < 0.0
    });
    let is_noisy = reversals.count() as f64 >= REVERSALS * runs.len() as f64
        && stops_abruptly(&known, longest[0].1);
    let others = (known.len() - longest.len()) as f64;
    let equal = (others - runs.len() as f64 + 1.0).max(1.0) / others.max(1.0);
    let chance = others * crate::elementary::powi(equal, longest.len() as i32);
    (is_noisy && chance < BY_CHANCE).then(|| {
        let (first, last) =
            (column.place(longest[0].0), column.place(longest[longest.len() - 1].0));
        format!(
            "`{name}` is {} in {} consecutive rows, {first} to {last}, and noisy elsewhere: if the \
             sensor was frozen, leave the cells empty; they are used as values",
            longest[0].1,
            longest.len()
        )
    })
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

    fn codes_of(name: &str, values: Vec<f64>) -> Vec<String> {
        codes(name, &column(values))
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
        // Codes of overflow do not hide others, in a few rows as well.
        let few: Vec<f64> = (0..10).map(|k| 1.5 + 0.1 * f64::from(k)).collect();
        let coded = |codes: &[f64]| codes_of("U", [&few[..], codes].concat());
        let found = coded(&[-999.0, 9.9e37, f64::MAX]);
        assert_eq!(found.len(), 3, "{found:?}");
        assert!(found[1].starts_with("9.9E37 in row 12 of `U` is far"), "{}", found[1]);
        assert!(coded(&[-9.9e37])[0].starts_with("-9.9E37 in row 11"));
        // A resistance of 999 Ohm among such of 500 to 1500.
        assert!(
            codes("R", &wave(|k, _| if k == 9 { 999.0 } else { 500.0 + 5.0 * k as f64 }))
                .is_empty()
        );
        assert!(codes("T", &column(vec![-999.0; 5])).is_empty(), "nothing to compare with");
    }

    #[test]
    fn spikes_and_frozen_sensors_are_named_and_pulses_are_not() {
        let noise = |k: usize| ((k * k * 7919 + k * 104_729) % 1013) as f64 / 1013.0 - 0.5;
        let found = codes("T", &wave(|k, v| if k % 40 < 2 { 85.0 } else { v }));
        assert_eq!(found.len(), 1, "{found:?}");
        assert!(found[0].starts_with("85 in row 1, row 2, row 41"), "{}", found[0]);
        assert_eq!(codes("P", &wave(|k, v| if k == 9 { 400_000.0 } else { v })).len(), 1);
        for pulses in [
            wave(|k, _| if k == 9 { 1.0 } else { 0.0 }),
            wave(|k, _| if (9..14).contains(&k) { 1.0 } else { 0.01 * noise(k) }),
            wave(|k, _| if k % 10 == 9 { 1.0 } else { 0.01 * noise(k) }),
        ] {
            assert_eq!(codes("P", &pulses), [""; 0]);
        }
        let noisy = |k: usize, v: f64| v + 0.5 * noise(k);
        let at = |k: usize| (80..140).contains(&k);
        let found = frozen("T", &wave(|k, v| if at(k) { 20.07 } else { noisy(k, v) })).unwrap();
        assert!(found.starts_with("`T` is 20.07 in 60 consecutive rows, row 81 to"), "{found}");
        for living in [
            wave(noisy),
            // Noise that is rounded; a stop within a drive cycle; a switch.
            wave(|k, v| noisy(k, v).round()),
            wave(|k, _| if at(k) { 20.07 } else { 20.07 + 0.1 * (k as f64 - 110.0) }),
            wave(|k, _| if at(k) { 1.0 } else { f64::from(k % 60 > 30) }),
        ] {
            assert_eq!(frozen("T", &living), None);
        }
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
