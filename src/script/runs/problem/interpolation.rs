//! Inputs of which neither the file nor the problem says how they continue between samples: after the
//! fit the other way is tried, and both objectives are reported.

use super::file::ProblemFile;
use super::inputs::{Between, Undecided};
use super::searches::{Again, Change};
use crate::Session;
use crate::diag::Fault;
use crate::elementary;
use crate::identify::problem::{
    Best, Elsewhere, EndingKind, ErrorModel, Finding, FindingKind, Run, Severity, Solution,
};
use crate::identify::significant;

/// Twice the logarithm of the ratio of the likelihoods below which these data do not show which of two
/// sums of squares is that of the right model: differences of AIC above 10 leave the worse one without
/// support. A battery at 1 Hz, with currents that are held, comes to 4 in favour of linear ones.
const SUPPORT: f64 = 10.0;
/// Ratios of objectives below this are said in percent: a factor of 1.00 says nothing.
const FEW_PERCENT: f64 = 1.1;
/// Parameters that are named.
const NAMED: usize = 3;

/// Sets how these inputs continue between samples.
fn set(file: &mut ProblemFile, names: &[&str], between: Between) {
    let inputs = file.experiment.iter_mut().flat_map(|experiment| &mut experiment.inputs);
    for (_, column) in inputs.filter(|(name, _)| names.contains(&name.as_str())) {
        column.change(|entry| {
            entry.interpolation.get_or_insert_with(|| between.name().to_owned());
        });
    }
}

/// Fits once more with the other interpolation, and reports which of the two fits better.
///
/// # Errors
///
/// Those of the problem that is made again.
pub(super) fn try_others(
    session: &mut Session,
    (run, solution): (&mut Run, &mut Solution),
    undecided: &[Undecided],
    again: &mut Again<'_>,
) -> Result<(), Fault> {
    if solution.outcome.ending.kind != EndingKind::Minimum || session.world.is_interrupted() {
        return Ok(());
    }
    for assumed in [Between::Constant, Between::Linear] {
        let of_kind = undecided.iter().filter(|own| own.assumed == assumed);
        let names: Vec<&str> = of_kind.map(|own| own.name.as_str()).collect();
        if names.is_empty() {
            continue;
        }
        let change = |file: &mut ProblemFile| set(file, &names, assumed.other());
        let other = again(session, Change::Entries(&change))?;
        let processors = session.world.processors();
        let found = run.best_with(other.problem.simulator, None, &processors)?;
        solution.effort.simulations_for_statistics += found.simulations;
        if session.world.is_interrupted() {
            let sentence = "Other interpolations of the inputs were not tried: the run was stopped \
                            before.";
            solution.findings.push(Finding::new(FindingKind::Missing, sentence));
            return Ok(());
        }
        let compared = Compared::of(solution, found);
        solution.findings.push(finding(&names, assumed, compared));
    }
    Ok(())
}

/// The fit and that with the other interpolation.
struct Compared {
    objectives: [f64; 2],
    /// Whether these are -log L, and not sums of squares.
    is_likelihood: bool,
    points: usize,
    /// Parameters that move out of their intervals, by so many standard errors, the farthest first.
    moved: Vec<(String, f64)>,
    /// Whether the residuals of each have a pattern: if those of the better one do, neither fit is known to
    /// be right.
    patterns: [bool; 2],
}

impl Compared {
    fn of(solution: &Solution, other: Elsewhere) -> Option<Compared> {
        let Best { values, fitness } = other.best?;
        let moved = solution.parameters.iter().zip(&values).filter_map(|(own, value)| {
            let [low, high] = own.interval?;
            let distance = (value - own.value).abs() / own.deviation?;
            let is_within = (low..=high).contains(value);
            (!is_within && distance.is_finite()).then(|| (own.name.clone(), distance))
        });
        let mut moved: Vec<(String, f64)> = moved.collect();
        moved.sort_by(|a, b| b.1.total_cmp(&a.1));
        let objectives = [solution.fitness, fitness];
        let points = solution.series.iter().map(|series| series.points.len()).sum();
        let is_likelihood =
            matches!(solution.likelihood.error_model, ErrorModel::Computed | ErrorModel::Estimated);
        let patterns = [solution.has_pattern(), other.has_pattern];
        Some(Compared { objectives, is_likelihood, points, moved, patterns })
    }

    /// Whether these data do not show which of the two is right.
    fn is_equal(&self) -> bool {
        let [own, other] = self.objectives;
        let ratio = match self.is_likelihood {
            true => 2.0 * (other - own),
            false => self.points as f64 * elementary::ln(other / own),
        };
        own == other || ratio.abs() <= SUPPORT
    }

    /// Whether the other fit is better.
    fn is_other_better(&self) -> bool {
        self.objectives[1] < self.objectives[0]
    }

    /// Whether the residuals of the better fit have a pattern.
    fn has_pattern(&self) -> bool {
        self.patterns[usize::from(self.is_other_better())]
    }

    /// Whether these data speak clearly for the fit that was made.
    fn is_decided(&self) -> bool {
        !self.has_pattern() && !self.is_equal() && !self.is_other_better()
    }

    /// How far the estimates move, and that their intervals do not contain it.
    fn movement(&self) -> String {
        if self.moved.is_empty() || self.is_decided() {
            return String::new();
        }
        let far: Vec<String> = self
            .moved
            .iter()
            .take(NAMED)
            .map(|(name, distance)| format!("{name} by {}", significant(*distance, 2)))
            .collect();
        let more = match self.moved.len().saturating_sub(NAMED) {
            0 => String::new(),
            more => format!(" and {more} more by less"),
        };
        format!(
            " Between the two the estimates move out of their 95 % intervals, {}{more} (standard errors): \
             the intervals do not contain the uncertainty of the interpolation.",
            far.join(", ")
        )
    }
}

fn finding(names: &[&str], assumed: Between, compared: Option<Compared>) -> Finding {
    let inputs = names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
    let Some(compared) = compared else {
        let sentence = format!(
            "With `interpolation = \"{}\"` of {inputs}, the best point could not be simulated.",
            assumed.other().name()
        );
        return Finding::new(FindingKind::Data, sentence).severity(Severity::Information);
    };
    let [own, other] = compared.objectives;
    let is_equal = compared.is_equal();
    let better = if compared.is_other_better() { assumed.other() } else { assumed };
    let verdict = match (is_equal, compared.has_pattern()) {
        (true, _) => "these data do not show which is right".to_owned(),
        (false, true) => format!(
            "\"{}\" fits better{}, but its residuals have a pattern, so neither is shown to be right; \
             write what is known of the inputs, or sample them more often",
            better.name(),
            by(&compared)
        ),
        (false, false) => format!("\"{}\" fits better{}", better.name(), by(&compared)),
    };
    let is_advised = !is_equal && !compared.has_pattern() && better != assumed;
    let write = match is_advised {
        true => format!(
            "; write `interpolation = \"{}\"` in the entry of each in `inputs`",
            better.name()
        ),
        false => String::new(),
    };
    let movement = compared.movement();
    let sentence = format!(
        "The interpolation of {inputs} is not given: with \"{}\" the objective is {}, with \"{}\" \
         {} after another fit: {verdict}{write}.{movement}",
        assumed.name(),
        significant(own, 5),
        assumed.other().name(),
        significant(other, 5)
    );
    let severity = match is_advised || !movement.is_empty() {
        true => Severity::Warning,
        false => Severity::Information,
    };
    Finding::new(FindingKind::Data, sentence).severity(severity)
}

/// By how much the better of two objectives is better.
fn by(compared: &Compared) -> String {
    let [own, other] = compared.objectives;
    if compared.is_likelihood {
        return format!(" by {} of it", significant((own - other).abs(), 3));
    }
    let ratio = own.max(other) / own.min(other);
    match ratio.is_finite() && own.min(other) > 0.0 {
        true if ratio < FEW_PERCENT => format!(" by {} %", significant(100.0 * (ratio - 1.0), 2)),
        true => format!(" by a factor of {}", significant(ratio, 3)),
        false => String::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_differences_are_said_in_percent() {
        let compared = |other| Compared {
            objectives: [0.0025, other],
            is_likelihood: false,
            points: 1000,
            moved: Vec::new(),
            patterns: [false; 2],
        };
        let said = |other| finding(&["I"], Between::Constant, Some(compared(other))).sentence;
        assert!(said(0.00245).contains("\"linear\" fits better by 2 %;"), "{}", said(0.00245));
        assert!(
            said(0.001).contains("\"linear\" fits better by a factor of 2.5;"),
            "{}",
            said(0.001)
        );
        assert!(said(0.00249).contains("do not show which is right"), "{}", said(0.00249));
    }

    /// Likelihoods are compared by their difference, whatever their sign.
    #[test]
    fn likelihoods_are_compared_by_their_difference() {
        let compared = |own, other| Compared {
            objectives: [own, other],
            is_likelihood: true,
            points: 1000,
            moved: Vec::new(),
            patterns: [false; 2],
        };
        let said =
            |own, other| finding(&["I"], Between::Constant, Some(compared(own, other))).sentence;
        for size in [-500.0, 0.5, 500.0] {
            let alike = said(size, size - 4.0);
            assert!(alike.contains("do not show which is right"), "{alike}");
            let better = said(size, size - 6.0);
            assert!(better.contains("\"linear\" fits better by 6 of it;"), "{better}");
        }
    }

    #[test]
    fn equal_objectives_with_other_estimates_are_a_warning() {
        let compared = |patterns, other| Compared {
            objectives: [0.0025, other],
            is_likelihood: false,
            points: 1000,
            moved: vec![("R".to_owned(), 9.0), ("C".to_owned(), 4.25)],
            patterns,
        };
        let found = finding(&["I"], Between::Constant, Some(compared([false; 2], 0.0025001)));
        assert!(
            found.sentence.contains("R by 9, C by 4.2 (standard errors)"),
            "{}",
            found.sentence
        );
        assert_eq!(found.severity, Severity::Warning);
        let decided = finding(&["I"], Between::Constant, Some(compared([false; 2], 0.025)));
        assert!(!decided.sentence.contains("standard errors"), "{}", decided.sentence);
        // The residuals of the better fit decide, not those of the one that was made.
        let said =
            |patterns| finding(&["I"], Between::Constant, Some(compared(patterns, 0.001))).sentence;
        for patterns in [[true; 2], [false, true]] {
            let torn = said(patterns);
            assert!(torn.contains("neither is shown to be right"), "{torn}");
            assert!(!torn.contains("write `interpolation"), "{torn}");
        }
        let clear = said([true, false]);
        assert!(clear.contains("write `interpolation = \"linear\"`"), "{clear}");
        assert!(!clear.contains("pattern"), "{clear}");
    }
}
