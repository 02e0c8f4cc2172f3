//! Whether models come to rest in the time that a problem gives them before the data.

use super::file::ExperimentEntry;
use crate::identify::problem::{
    Experiment, Finding, FindingKind, ModelSimulator, Run, Severity, Simulate as _,
};
use crate::identify::significant;

/// So many times as long before the data, a model that is at rest has the same outputs.
const LONGER: f64 = 10.0;
/// Larger changes, relative to the largest value of the output, are none of the solver: at the default
/// tolerance the rest states of Boehm_JProteomeRes2014 and Brannmark_JBC2010 move by less than 1e-5.
const MOVED: f64 = 1e-3;

/// The experiment as it is, and with more time before the data; `None` where it need not be at rest.
pub(super) fn both(entry: &ExperimentEntry, experiment: &Experiment) -> Option<[Experiment; 2]> {
    let start = experiment.settings.start;
    if !entry.rest || start >= 0.0 {
        return None;
    }
    let mut longer = experiment.clone();
    longer.settings.start = LONGER * start;
    Some([experiment.clone(), longer])
}

/// A finding for each experiment that is not at rest when its data begin.
pub(super) fn not_reached(run: &Run, experiments: &[[Experiment; 2]]) -> Vec<Finding> {
    let Some(best) = &run.observed.best else { return Vec::new() };
    let rows = |experiment: &Experiment| {
        let mut simulator = ModelSimulator::new(std::slice::from_ref(experiment)).ok()?;
        let points = experiment.observations.iter().map(|own| own.x.len()).sum();
        let mut row = vec![f64::NAN; points];
        simulator.simulate(&best.values, &mut row).ok().map(|()| row)
    };
    let one = |[usual, longer]: &[Experiment; 2]| {
        let (a, b) = (rows(usual)?, rows(longer)?);
        let mut first = 0;
        let mut most = (0.0, "");
        for own in &usual.observations {
            let points = first..first + own.x.len();
            first = points.end;
            let size = a[points.clone()].iter().fold(0.0f64, |most, y| most.max(y.abs()));
            let moved = points.map(|k| (a[k] - b[k]).abs()).fold(0.0, f64::max);
            if moved > most.0 * size {
                most = (moved / size, own.y_name.as_str());
            }
        }
        (most.0 > MOVED).then(|| {
            let sentence = format!(
                "{}: the model is not at rest when the data begin: with {LONGER} times as long before, \
                 `{}` changes by {} %. It is slower than the time before the data, or does not come to \
                 rest at all; the fit does not describe data that begin at rest.",
                usual.name,
                most.1,
                significant(100.0 * most.0, 2)
            );
            Finding {
                value: Some(most.0),
                threshold: Some(MOVED),
                ..Finding::new(FindingKind::NotAtRest, sentence).severity(Severity::Serious)
            }
        })
    };
    experiments.iter().filter_map(one).collect()
}
