//! How a run ended: at a minimum by a test that can fail, or at the end of its steps or its budget.
//! What the data determine is said of a minimum only.
//!
//! The test is that of Bates and Watts at the best point: the part of the residuals in the tangent
//! plane of the model is small against the part across it, so that the parameters lie within a
//! thousandth of their standard errors of the minimum. Genes held by a bound are left out; residuals
//! of the size of rounding are tested by the step of Gauss and Newton.
//!
//! Reference: [Bates & Watts 1981](gapilib_base::bibliography#bates-watts-1981).

use super::minimum_test::tested;
use super::run::Cause;
use super::{Linearization, Problem, Run, curvature, held, limits};
use crate::ga::optimizer::{DescentEnd, DescentReport, MINIMUM, Offset, reached};
use crate::table::significant;
use serde::{Deserialize, Serialize};

/// A minimum with a larger relative offset is one whose residuals are those of rounding.
const OF_ROUNDING: f64 = 0.02;

/// How the sentence about a minimum begins.
const FOUND: &str = "Minimum found";

/// Where a run ended.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum EndingKind {
    /// At a minimum, by the test.
    Minimum,
    /// The steps of the best descent were used up.
    StepLimit,
    /// A stop condition ended the search before a minimum.
    Budget,
    /// The user ended the run before a minimum.
    Stopped,
    /// No step reduces the objective beyond the errors of the simulation.
    NoDescent,
    /// The objective is not a sum of squares, so that the test cannot be made.
    #[default]
    Untested,
}

/// How a run ended.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Ending {
    /// In one word.
    pub kind: EndingKind,
    /// The relative offset at the best point; `None` where it cannot be computed.
    pub relative_offset: Option<f64>,
    /// How many descents reached the best minimum, of how many; `None` without descents.
    pub reached: Option<[usize; 2]>,
    /// In one sentence.
    pub words: String,
    /// How the derivatives at the best point were computed, which the standard errors rest on; `None`
    /// where there are none.
    #[serde(default)]
    pub derivatives: Option<String>,
    /// Simulations of the test.
    pub simulations: u64,
}

/// A descent of least squares, with values of the parameters.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SolvedDescent {
    /// Where it started.
    pub start: Vec<f64>,
    /// Where it ended.
    pub end: Vec<f64>,
    /// The sum of squares there; `None` where the start could not be simulated.
    pub objective: Option<f64>,
    /// How it ended.
    pub ending: DescentEnd,
    /// The relative offset at its end.
    pub relative_offset: Option<f64>,
    /// Steps tried.
    pub steps: u64,
    /// Descents with the same number ended at the same place; 0 is the best.
    pub group: usize,
}

/// A minimum beside the best that the data do not exclude.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct OtherMinimum {
    /// Values of the parameters.
    pub values: Vec<f64>,
    /// The sum of squares there.
    pub objective: f64,
    /// Descents that reached it.
    pub reached: usize,
}

impl Ending {
    /// Where the best point was not tested.
    pub(super) fn unjudged(why: &str) -> Ending {
        Ending {
            kind: EndingKind::Stopped,
            words: format!(
                "Whether this is a minimum was not tested: {why}. There are no standard errors, no \
                 intervals and no statements on identifiability."
            ),
            ..Ending::default()
        }
    }

    /// The same, where a parameter stands at an end of its range: elsewhere may be a better point.
    pub(super) fn within_ranges(mut self) -> Ending {
        if let Some(rest) = self.words.strip_prefix(FOUND) {
            self.words = format!("{FOUND} within the search ranges{rest}");
        }
        self
    }

    /// Tests the best point of a run.
    pub(super) fn of(run: &Run, values: &[f64]) -> Ending {
        let descents = run.descents();
        let count = descents.len();
        let reached = (count > 0).then(|| [reached(&descents), count]);
        let untested = |simulations| Ending {
            kind: EndingKind::Untested,
            relative_offset: None,
            reached,
            words: untested(&run.problem),
            derivatives: None,
            simulations,
        };
        if !run.evaluation.has_residuals() || run.problem.objectives.len() > 1 {
            return untested(0);
        }
        let found = run.evaluation.linearize(&run.problem, &[values.to_vec()]).pop();
        let Some(Ok(found)) = found else { return untested(1) };
        let (offset, is_minimum) = tested(&run.problem, &run.evaluation, values, &found);
        if let Some(ending) = at_limits(run, values, &found, reached) {
            return ending;
        }
        let curved = if is_minimum { None } else { curvature::offset(run, values) };
        if let Some((offset, simulations)) = curved {
            return Ending {
                kind: EndingKind::Minimum,
                relative_offset: None,
                reached,
                words: by_curvature(offset),
                derivatives: Some(derivatives(&found)),
                simulations: found.simulations + simulations,
            };
        }
        if !is_minimum && held::is_minimum(run, values, &found) {
            return Ending {
                kind: EndingKind::Minimum,
                relative_offset: None,
                reached,
                words: by_holding(run),
                derivatives: Some(derivatives(&found)),
                simulations: found.simulations,
            };
        }
        let kind = if is_minimum { EndingKind::Minimum } else { otherwise(run, &descents) };
        let has_effect = found.derivatives.iter().any(|derivative| *derivative != 0.0);
        Ending {
            kind,
            relative_offset: offset.relative.filter(|relative| relative.is_finite()),
            reached,
            words: if has_effect { words(kind, &offset, reached) } else { NO_EFFECT.to_owned() },
            derivatives: Some(derivatives(&found)),
            simulations: found.simulations,
        }
    }
}

/// The words where all derivatives are zero.
const NO_EFFECT: &str = "No parameter changes the simulated values at the measured points: check that the \
                         inputs have data, and that the outputs depend on the parameters. There are no \
                         intervals and no statements on identifiability.";

fn derivatives(found: &Linearization) -> String {
    match (found.exact, &found.refusal) {
        (true, _) => "exact, by sensitivity equations".to_owned(),
        (false, Some(refusal)) => format!("differences, because {refusal}"),
        (false, None) => "differences".to_owned(),
    }
}

fn otherwise(run: &Run, descents: &[DescentReport]) -> EndingKind {
    let best = descents.iter().min_by(|a, b| a.objective.total_cmp(&b.objective));
    match (run.cause(), best.map(|best| best.ending)) {
        (Cause::User, _) => EndingKind::Stopped,
        (Cause::Condition, _) => EndingKind::Budget,
        (Cause::Converged, Some(DescentEnd::StepLimit)) => EndingKind::StepLimit,
        (Cause::Converged, _) => EndingKind::NoDescent,
    }
}

fn untested(problem: &Problem) -> String {
    if problem.objectives.len() > 1 {
        return "Several objectives have a Pareto front, not a minimum: there are no intervals."
            .to_owned();
    }
    format!(
        "Whether this is a minimum cannot be tested: `{}` is not a sum of squares, or the \
         simulation fails near the best point. There are no intervals.",
        problem.objectives[0].0
    )
}

fn words(kind: EndingKind, offset: &Offset, reached: Option<[usize; 2]>) -> String {
    let limit = significant(MINIMUM, 1);
    let measure = match offset.relative.filter(|relative| relative.is_finite()) {
        // Noise-free data are fitted to the last digit, where the offset is one of rounding.
        None if kind == EndingKind::Minimum && offset.relative.is_some() => {
            "the residuals are at rounding level".to_owned()
        }
        Some(relative) if kind == EndingKind::Minimum && relative > OF_ROUNDING => {
            "the residuals are at rounding level".to_owned()
        }
        Some(relative) => format!("relative offset {}", significant(relative, 2)),
        None => format!("Gauss-Newton step {} of the ranges", significant(offset.step, 2)),
    };
    let why = match kind {
        EndingKind::Minimum => {
            // One descent alone says nothing of other starts.
            let by = reached.filter(|[n, of]| *n > 0 && *of > 1);
            let by =
                by.map_or_else(String::new, |[n, of]| format!(", reached by {n} of {of} descents"));
            return format!("{FOUND} ({measure}){by}.");
        }
        EndingKind::StepLimit => "the step limit of the descent was reached",
        EndingKind::Budget => "the budget was exhausted",
        EndingKind::Stopped => "the user stopped the run",
        EndingKind::NoDescent | EndingKind::Untested => {
            "no step reduces the objective beyond the errors of the simulation"
        }
    };
    format!(
        "This is not a minimum: {why} ({measure}; below {limit} at a minimum). There are no \
         intervals and no statements on identifiability."
    )
}

/// Where the best point stands at limits of constraints, and is a minimum along them.
fn at_limits(
    run: &Run,
    values: &[f64],
    found: &Linearization,
    reached: Option<[usize; 2]>,
) -> Option<Ending> {
    let along = limits::along(&run.problem, values)?;
    let tested = limits::test(run, values, &along, found).filter(|tested| tested.is_minimum)?;
    let constraints: Vec<String> = limits::active_constraints(&run.problem, values)
        .iter()
        .map(|text| format!("`{text}`"))
        .collect();
    let relative = tested.offset.and_then(|offset| offset.relative);
    let measure = relative.map_or_else(String::new, |relative| {
        format!(" (relative offset along it {})", significant(relative, 2))
    });
    Some(Ending {
        kind: EndingKind::Minimum,
        relative_offset: relative,
        reached,
        words: format!("{FOUND} at the limit of {}{measure}.", constraints.join(" and ")),
        derivatives: Some(derivatives(found)),
        simulations: found.simulations,
    })
}

fn by_holding(run: &Run) -> String {
    let names: Vec<&str> =
        run.conclusion.held.iter().map(|&k| run.problem.parameters[k].name.as_str()).collect();
    format!(
        "{FOUND}: no other value of {} is better when the others are fitted again. The \
         objective has a kink or is flat there, so that its derivative does not show the minimum.",
        names.join(" and ")
    )
}

fn by_curvature(offset: f64) -> String {
    format!(
        "{FOUND} by second derivatives (a Newton step moves the parameters by {} standard \
         errors): the first derivatives vanish or jump there.",
        significant(offset, 2)
    )
}

/// The descents of a run, in their order.
pub fn descents(run: &Run) -> Vec<SolvedDescent> {
    let one = |report: DescentReport| SolvedDescent {
        start: run.problem.values(&report.start),
        end: run.problem.values(&report.end),
        objective: Some(report.objective).filter(|sum| sum.is_finite()),
        ending: report.ending,
        relative_offset: report.offset.filter(|offset| offset.is_finite()),
        steps: report.steps,
        group: report.group,
    };
    run.descents().into_iter().map(one).collect()
}

/// Minima whose sum of squares is below `limit`, but for the best, best first.
pub fn other_minima(descents: &[SolvedDescent], limit: f64) -> Vec<OtherMinimum> {
    let is_near = |descent: &&SolvedDescent| {
        descent.group > 0
            && descent.ending.is_at_minimum()
            && descent.objective.is_some_and(|sum| sum <= limit)
    };
    let mut others: Vec<(usize, OtherMinimum)> = Vec::new();
    for descent in descents.iter().filter(is_near) {
        match others.iter_mut().find(|(group, _)| *group == descent.group) {
            Some((_, known)) => known.reached += 1,
            None => others.push((
                descent.group,
                OtherMinimum {
                    values: descent.end.clone(),
                    objective: descent.objective.unwrap_or(f64::NAN),
                    reached: 1,
                },
            )),
        }
    }
    others.sort_by(|a, b| a.1.objective.total_cmp(&b.1.objective));
    others.into_iter().map(|(_, other)| other).collect()
}
