//! Results against reference results, signal by signal.

use super::ResultTable;
use super::errors::BAD_REFERENCE;
use super::tube::{Deviation, Tube};
use crate::bail;
use crate::diag::Fault;

/// What comparing one signal gave.
#[derive(Debug, Clone, PartialEq)]
pub struct Compared {
    /// Its name.
    pub signal: String,
    /// Whether, or where, it differs.
    pub agreement: Agreement,
}

/// Whether a signal agrees with its reference.
#[derive(Debug, Clone, PartialEq)]
pub enum Agreement {
    /// Every point is inside the tube.
    Inside,
    /// A point is outside.
    Outside {
        /// The point farthest outside.
        worst: Deviation,
        /// How far it is outside, in half heights of the tube.
        distance: f64,
    },
    /// The result begins later or ends earlier than the reference.
    Incomplete {
        /// The result's first and last time, seconds; `None` if it has no points.
        covered: Option<(f64, f64)>,
    },
    /// The result has no signal of this name.
    Missing,
}

impl Compared {
    /// Whether the signal agrees.
    pub fn agrees(&self) -> bool {
        self.agreement == Agreement::Inside
    }
}

/// Compares signals of a result with the tubes around those of a reference. Names may differ in
/// blanks.
///
/// # Errors
/// A reference without one of the signals, or without points; a tolerance outside ]0, 1[.
pub fn compare(
    result: &ResultTable,
    reference: &ResultTable,
    signals: &[String],
    tolerance: f64,
) -> Result<Vec<Compared>, Fault> {
    check(reference, tolerance)?;
    let judge = |tube: &Tube, values: &[f64], _: &[f64]| {
        let worst = tube.worst_deviation(&result.time, values)?;
        Some((worst, tube.distance(&worst)))
    };
    let judged = signals.iter().map(|signal| judged(result, reference, signal, tolerance, &judge));
    judged.collect()
}

/// Compares signals of a result with a reference that has been sampled at instants of its own
/// (see [`super::read_sampled`]). It need not show what happens between them, so the samples are
/// compared with the result: each must lie in the tube around it, whose sides are those of the tube
/// around the reference; or in that around the points of the result that `is_written` marks. A sample
/// is interpolated between the points that a simulator has written: on a flank it is as far from the
/// trajectory as these are from each other.
///
/// # Errors
/// Those of [`compare`].
pub fn compare_samples(
    result: &ResultTable,
    is_written: &[bool],
    reference: &ResultTable,
    signals: &[String],
    tolerance: f64,
) -> Result<Vec<Compared>, Fault> {
    check(reference, tolerance)?;
    let written = |all: &[f64]| -> Vec<f64> {
        all.iter().zip(is_written).filter(|(_, is)| **is).map(|(value, _)| *value).collect()
    };
    let times = written(&result.time);
    let judge = |tube: &Tube, values: &[f64], samples: &[f64]| {
        let own = written(values);
        let tubes = [tube.around_other(&result.time, values), tube.around_other(&times, &own)];
        Tube::worst_sample(&tubes, &reference.time, samples)
    };
    let judged = signals.iter().map(|signal| judged(result, reference, signal, tolerance, &judge));
    judged.collect()
}

fn check(reference: &ResultTable, tolerance: f64) -> Result<(), Fault> {
    if !(tolerance > 0.0 && tolerance < 1.0) {
        bail!(crate::registry::BAD_OPTION, "the tolerance is {tolerance}, outside ]0, 1[");
    }
    if reference.time.is_empty() {
        bail!(BAD_REFERENCE, "the reference has no time points");
    }
    Ok(())
}

/// The worst deviation and its distance, from the tube around the reference, the values of the
/// result and those of the reference.
type Judge<'a> = &'a dyn Fn(&Tube, &[f64], &[f64]) -> Option<(Deviation, f64)>;

/// The signals of a reference that are to be compared: the lines of a list, without `time`; all of
/// the reference without a list.
pub fn signals_to_compare(reference: &ResultTable, list: Option<&str>) -> Vec<String> {
    let is_time = |name: &str| name.eq_ignore_ascii_case("time");
    let all = || reference.series.iter().map(|series| series.name.clone()).collect();
    list.map_or_else(all, |list| {
        let lines = list.lines().map(str::trim);
        let names = lines.filter(|line| !line.is_empty() && !line.starts_with("//"));
        names.filter(|name| !is_time(name)).map(str::to_owned).collect()
    })
}

fn judged(
    result: &ResultTable,
    reference: &ResultTable,
    signal: &str,
    tolerance: f64,
    judge: Judge,
) -> Result<Compared, Fault> {
    let Some(expected) = reference.column_like(signal) else {
        bail!(BAD_REFERENCE, "the reference has no signal `{signal}`")
    };
    let tube = Tube::around(&reference.time, &expected, tolerance);
    let agreement = match result.column_like(signal) {
        None => Agreement::Missing,
        Some(values) => {
            let judge = || judge(&tube, &values, &expected);
            agreement(&tube, reference, &result.time, judge)
        }
    };
    Ok(Compared { signal: signal.to_owned(), agreement })
}

fn agreement(
    tube: &Tube,
    reference: &ResultTable,
    time: &[f64],
    judge: impl Fn() -> Option<(Deviation, f64)>,
) -> Agreement {
    let covered = time.first().copied().zip(time.last().copied());
    let (start, stop) = (reference.time[0], reference.time[reference.time.len() - 1]);
    let is_covering = covered.is_some_and(|(first, last)| {
        first <= start + tube.half_width() && last >= stop - tube.half_width()
    });
    if !is_covering {
        return Agreement::Incomplete { covered };
    }
    match judge() {
        None => Agreement::Inside,
        Some((worst, distance)) => Agreement::Outside { worst, distance },
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Series, Values};
    use super::*;

    fn table(time: &[f64], columns: &[(&str, &[f64])]) -> ResultTable {
        let mut table = ResultTable::new(time.to_vec());
        let series = |(name, values): &(&str, &[f64])| {
            Series::new(*name, Values::Trajectory(values.to_vec()))
        };
        table.series = columns.iter().map(series).collect();
        table
    }

    #[test]
    fn every_signal_gets_its_verdict() {
        let reference = table(&[0.0, 1.0], &[("a", &[0.0, 1.0]), ("b[1, 2]", &[2.0, 4.0])]);
        let result = table(&[0.0, 1.0], &[("b[1,2]", &[2.0, 4.1]), ("c", &[0.0, 0.0])]);
        let signals = signals_to_compare(&reference, None);
        let found = compare(&result, &reference, &signals, 0.002).unwrap();
        assert_eq!(found[0].agreement, Agreement::Missing);
        let Agreement::Outside { worst, distance } = &found[1].agreement else { panic!() };
        assert_eq!((worst.time, worst.value), (1.0, 4.1));
        assert!((distance - (0.1 - 0.004) / 0.004).abs() < 1e-9, "{distance}");
    }

    #[test]
    fn samples_need_not_show_what_happens_between_them() {
        let reference = table(&[0.0, 50.0, 100.0], &[("a", &[0.0, 1.0, 1.0])]);
        let compare = |time: &[f64], values: &[f64]| {
            let result = table(time, &[("a", values)]);
            let (all, signals) = (vec![true; time.len()], ["a".to_owned()]);
            let found = compare_samples(&result, &all, &reference, &signals, 0.002).unwrap();
            found[0].agreement.clone()
        };
        let peak = compare(&[0.0, 20.0, 20.0, 50.0, 100.0], &[0.0, 0.0, 5.0, 1.0, 1.0]);
        assert_eq!(peak, Agreement::Inside);
        // A jump may come a little later than at the sample, but not much.
        let steps = [0.0, 0.0, 1.0, 1.0];
        assert_eq!(compare(&[0.0, 50.1, 50.1, 100.0], &steps), Agreement::Inside);
        let late = compare(&[0.0, 51.0, 51.0, 100.0], &steps);
        let Agreement::Outside { worst, .. } = late else { panic!("{late:?}") };
        assert_eq!((worst.time, worst.value, worst.lower), (50.0, 0.0, 0.998));
    }

    #[test]
    fn samples_may_lie_between_points_that_were_written() {
        // The trajectory is t², written at 0, 1/2 and 1.
        let time: Vec<f64> = (0..=8).map(|at| f64::from(at) / 8.0).collect();
        let values: Vec<f64> = time.iter().map(|t| t * t).collect();
        let is_written: Vec<bool> = (0..=8).map(|at| at % 4 == 0).collect();
        let result = table(&time, &[("a", &values)]);
        let agrees = |samples: &[f64]| {
            let reference = table(&[0.0, 0.25, 0.5, 0.75, 1.0], &[("a", samples)]);
            let signals = ["a".to_owned()];
            compare_samples(&result, &is_written, &reference, &signals, 0.002).unwrap()[0].agrees()
        };
        assert!(agrees(&[0.0, 0.0625, 0.25, 0.5625, 1.0]));
        assert!(agrees(&[0.0, 0.125, 0.25, 0.625, 1.0]));
        assert!(!agrees(&[0.0, 0.09, 0.25, 0.6, 1.0]));
    }

    #[test]
    fn results_that_end_early_do_not_agree() {
        let reference = table(&[0.0, 1.0], &[("a", &[0.0, 0.0])]);
        let result = table(&[0.0, 0.5], &[("a", &[0.0, 0.0])]);
        let found = compare(&result, &reference, &["a".to_owned()], 0.002).unwrap();
        assert_eq!(found[0].agreement, Agreement::Incomplete { covered: Some((0.0, 0.5)) });
        let empty = compare(&table(&[], &[("a", &[])]), &reference, &["a".to_owned()], 0.002);
        assert_eq!(empty.unwrap()[0].agreement, Agreement::Incomplete { covered: None });
    }

    #[test]
    fn a_list_names_the_signals() {
        let reference = table(&[0.0], &[("a", &[0.0]), ("b", &[0.0])]);
        assert_eq!(signals_to_compare(&reference, Some("time\r\n b \n\n")), ["b"]);
        assert_eq!(signals_to_compare(&reference, None), ["a", "b"]);
        let fault = compare(&reference, &reference, &["x".to_owned()], 0.1).unwrap_err();
        assert_eq!(fault.code.slug, "bad-reference");
        assert!(compare(&reference, &reference, &[], 2.0).is_err());
    }
}
