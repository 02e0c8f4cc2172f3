//! Reference results as BuildingsPy writes them for libraries of the IBPSA: a line `name=[...]` for
//! each signal with its values at instants that divide the simulated time evenly, interpolated
//! between the points that the simulator wrote. Of a signal that is constant only the first and the
//! last value are kept, of `time` always. What else the file says, of sizes and dates, is passed over.

use super::errors::BAD_REFERENCE;
use super::{ResultTable, Series, Values};
use crate::bail;
use crate::diag::Fault;

/// The instants are divided by this number for a result that the samples are compared with.
pub(crate) const REFINEMENT: usize = 10;

/// The results in such a file; `None` if it has none, as those of models that are only exported.
///
/// # Errors
/// A value that is not a number, or signals that have neither two values nor as many as the others.
pub fn read_sampled(text: &str) -> Result<Option<ResultTable>, Fault> {
    let mut signals = Vec::new();
    let mut span = None;
    for line in text.lines() {
        let Some((name, list)) = line.trim_end().split_once("=[") else { continue };
        let Some(list) = list.strip_suffix(']') else { continue };
        let values = list.split(',').map(|value| number(name, value));
        let values = values.collect::<Result<Vec<f64>, Fault>>()?;
        match name {
            "time" => span = Some(values),
            _ => signals.push((name.to_owned(), values)),
        }
    }
    let Some(span) = span else { return Ok(None) };
    let (Some(start), Some(stop)) = (span.first().copied(), span.last().copied()) else {
        bail!(BAD_REFERENCE, "the reference has no time points")
    };
    let instants = signals.iter().map(|(_, values)| values.len()).fold(2, usize::max);
    let mut table = ResultTable::new(evenly(start, stop, instants));
    for (name, values) in signals {
        let values = match values[..] {
            [first, last] if instants > 2 && first == last => Values::Constant(first),
            [first, last] if instants > 2 => Values::Trajectory(evenly(first, last, instants)),
            _ if values.len() == instants => Values::Trajectory(values),
            _ => {
                let n = values.len();
                bail!(BAD_REFERENCE, "`{name}` has {n} values, other signals have {instants}")
            }
        };
        table.series.push(Series::new(name, values));
    }
    table.check()?;
    Ok(Some(table))
}

/// Instants that divide the time between those of samples evenly, the samples' own among them.
pub fn between_samples(samples: &[f64]) -> Vec<f64> {
    let mut instants = Vec::with_capacity(samples.len() * REFINEMENT);
    for pair in samples.windows(2) {
        instants.extend(evenly(pair[0], pair[1], REFINEMENT + 1).into_iter().take(REFINEMENT));
    }
    instants.extend(samples.last());
    instants
}

fn number(name: &str, text: &str) -> Result<f64, Fault> {
    match text.trim().parse() {
        Ok(value) => Ok(value),
        Err(_) => bail!(BAD_REFERENCE, "`{}` of `{name}` is not a number", text.trim()),
    }
}

/// So many numbers from one to another, at least two.
fn evenly(first: f64, last: f64, count: usize) -> Vec<f64> {
    let steps = (count - 1) as f64;
    let at = |step: usize| match step + 1 == count {
        true => last,
        false => first + (last - first) * (step as f64 / steps),
    };
    (0..count).map(at).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn constants_and_trajectories_share_their_instants() {
        let text = "last-generated=2020-01-01\nstatistics-simulation=\n{\n  \"linear\": \" \"\n}\n\
                    p=[1.5e+00, 1.5e+00]\ntime=[0e+00, 4e+00]\nx[1].y=[0, 1, 4, 9, 16]\n\
                    q=[0, 8]\n";
        let table = read_sampled(text).unwrap().unwrap();
        assert_eq!(table.time, [0.0, 1.0, 2.0, 3.0, 4.0]);
        assert_eq!(table.series[0].values, Values::Constant(1.5));
        assert_eq!(table.column("x[1].y").unwrap(), [0.0, 1.0, 4.0, 9.0, 16.0]);
        assert_eq!(table.column("q").unwrap(), [0.0, 2.0, 4.0, 6.0, 8.0]);
        let fine = between_samples(&table.time);
        assert_eq!((fine.len(), fine[10], fine[40]), (41, 1.0, 4.0));
    }

    #[test]
    fn files_without_results_have_none() {
        let dependencies = "statistics-fmu-dependencies=\n{\n  \"a\": [\n    \"b\"\n  ]\n}\n";
        assert_eq!(read_sampled(dependencies).unwrap(), None);
    }

    #[test]
    fn what_does_not_fit_is_refused() {
        for text in ["time=[0, 1]\nx=[1, a]\n", "time=[0, 1]\nx=[1, 2, 3]\ny=[1, 2, 3, 4]\n"] {
            assert_eq!(read_sampled(text).unwrap_err().code.slug, "bad-reference");
        }
    }
}
