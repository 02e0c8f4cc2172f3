//! Statistics that are stopped after a number of simulations, whichever it is: what was found by then is
//! true, and what is missing is named. Simulations are counted; no clock is asked.

use super::inference::{BootstrapSettings, IntervalKind, PosteriorSettings, Resampling};
use super::tests::{decay, problem};
use super::{Failed, FailureKind, Problem, Run, Simulate, Solution, Verdict, conclude};
use crate::diag::Fault;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicI64, Ordering};

const NOISE: [f64; 12] =
    [0.01, -0.02, 0.015, 0.0, -0.01, 0.02, -0.015, 0.01, 0.0, -0.01, 0.005, -0.005];

/// Simulates until `left` is used up, and then sets the flag, as a user does.
struct Counted {
    own: Box<dyn Simulate>,
    left: Arc<AtomicI64>,
    flag: Arc<AtomicBool>,
}

impl Simulate for Counted {
    fn simulate(&mut self, parameters: &[f64], out: &mut [f64]) -> Result<(), Failed> {
        if self.left.fetch_sub(1, Ordering::Relaxed) == 0 {
            self.flag.store(true, Ordering::Relaxed);
        }
        if self.flag.load(Ordering::Relaxed) {
            let cause = "it was cancelled".to_owned();
            return Err(Failed::new(FailureKind::Points, cause, 0.0));
        }
        self.own.simulate(parameters, out)
    }
}

/// A decay with all statistics, a second rate beside it that is not needed, and the end of its search.
fn searched(left: &Arc<AtomicI64>, flag: &Arc<AtomicBool>) -> Run {
    let two = |p: &[f64], x: f64| decay(p, x) + p[2];
    let mut own: Problem = problem("genetic", two, &[2.0, 0.7, 0.2], &NOISE);
    own.inference.bootstrap = Some(BootstrapSettings {
        samples: 20,
        resampling: Resampling::Residuals,
        interval: IntervalKind::Percentile,
    });
    own.inference.posterior = Some(PosteriorSettings { samples: 400 });
    let make = own.simulator;
    let (left, cancel) = (Arc::clone(left), Arc::clone(flag));
    own.simulator = Box::new(move || {
        let (left, flag) = (Arc::clone(&left), Arc::clone(&cancel));
        Ok(Box::new(Counted { own: make()?, left, flag }))
    });
    let mut run = Run::new(own, 1).unwrap();
    while run.stop().is_none() {
        run.step(0.0);
    }
    run.evaluation.cancel_by(Some(Arc::clone(flag)));
    run
}

/// Simulates so many times; then calls do not return.
struct Hanging {
    own: Box<dyn Simulate>,
    left: Arc<AtomicI64>,
}

impl Simulate for Hanging {
    fn simulate(&mut self, parameters: &[f64], out: &mut [f64]) -> Result<(), Failed> {
        match self.left.fetch_sub(1, Ordering::Relaxed) {
            1.. => self.own.simulate(parameters, out),
            _ => Err(Failed::new(FailureKind::Hopeless, "20 in a row ended so", 0.0)),
        }
    }
}

/// The search ends, and keeps what it has found.
#[test]
fn a_search_ends_where_simulations_do_not_end() {
    let mut own = problem("genetic", decay, &[2.0, 0.7], &NOISE);
    let make = own.simulator;
    let left = Arc::new(AtomicI64::new(60));
    own.simulator =
        Box::new(move || Ok(Box::new(Hanging { own: make()?, left: Arc::clone(&left) })));
    let mut run = Run::new(own, 1).unwrap();
    let reason = loop {
        match run.stop() {
            Some(reason) => break reason,
            None => run.step(0.0),
        };
    };
    assert_eq!(reason, "the simulations do not end: 20 in a row ended so");
    assert!(run.observed.best.as_ref().is_some_and(|best| best.fitness.is_finite()));
    assert!(run.evaluations() < 1000, "{}", run.evaluations());
}

/// The statistics in the order in which a run makes them.
fn statistics(run: &mut Run) -> Result<Solution, Fault> {
    conclude(run);
    let again = |run: &Run| Solution::of(run, "done", Vec::new());
    let mut solution = Solution::settled(run, again)?.with_profiles(run, again)?;
    solution.add_inference(run)?;
    Ok(solution)
}

/// What is wrong with a solution that was stopped, whose statistics are those of `whole` otherwise.
fn wrong(found: &Solution, whole: &Solution) -> Option<String> {
    let text = found.text();
    for (own, other) in found.parameters.iter().zip(&whole.parameters) {
        let is_named = || {
            let mut lines = text.lines().filter(|line| line.contains("not computed"));
            lines.any(|line| line.contains(&own.name))
        };
        if own.verdict.is_none() && !is_named() {
            return Some(format!("{} is not judged", own.name));
        }
        let is_same = |ends: Option<[f64; 2]>, others: Option<[f64; 2]>| {
            let pairs = ends.into_iter().flatten().zip(others.into_iter().flatten());
            pairs.into_iter().all(|(a, b)| (a - b).abs() <= 0.02 * b.abs())
        };
        let is_true = own.verdict == other.verdict && is_same(own.interval, other.interval);
        if own.verdict.is_some_and(|verdict| verdict != Verdict::WithoutEffect) && !is_true {
            return Some(format!("{}: {:?} {:?}", own.name, own.verdict, own.interval));
        }
    }
    let missing = text.lines().find(|line| line.contains("Not computed, because"));
    let made = [
        ("bootstrap", found.inferred.bootstrap.is_some()),
        ("posterior", found.inferred.posterior.is_some()),
    ];
    for (part, is_made) in made {
        if is_made == missing.is_some_and(|line| line.contains(part)) {
            return Some(format!("{part} is made: {is_made}, and {missing:?}"));
        }
    }
    let is_said = text.contains("were not computed");
    (found.profiles.is_none() && !is_said).then(|| "there are no profiles".to_owned())
}

#[test]
fn after_any_number_of_simulations_what_is_missing_is_named() {
    let (left, flag) = (Arc::new(AtomicI64::new(i64::MAX)), Arc::new(AtomicBool::new(false)));
    let mut run = searched(&left, &flag);
    let best = run.observed.best.clone();
    let whole = statistics(&mut run).unwrap();
    let count = i64::MAX - left.load(Ordering::Relaxed);
    let (mut none, mut some) = (0, 0);
    // All of the first ones, where single derivatives are taken, and every so many of the others.
    let searches = i64::try_from(run.simulations).unwrap();
    for stop in (0..40).chain((40..count - searches).step_by(97)) {
        left.store(i64::MAX, Ordering::Relaxed);
        flag.store(false, Ordering::Relaxed);
        let mut run = searched(&left, &flag);
        assert_eq!(run.observed.best, best);
        left.store(stop, Ordering::Relaxed);
        match statistics(&mut run) {
            Err(fault) => {
                none += 1;
                let said = &fault.message;
                assert!(said.contains("stopped") || said.contains("cancelled"), "{stop}: {said}");
            }
            Ok(found) => {
                some += 1;
                let wrong = wrong(&found, &whole);
                assert_eq!(wrong, None, "{stop} of {count}\n{}", found.text());
            }
        }
    }
    assert!(none > 5 && some > 20, "{none} {some}");
}
