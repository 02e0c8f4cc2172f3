//! Runs whose statistics are stopped: whatever was under way, there is a result, and it says what is
//! missing. No clock decides when: the user asks to stop when a certain line is shown.

use super::inference::{EMPTIES, data};
use super::*;
use crate::world::Shown;

/// All statistics there are.
const ALL: &str = "
[design]
points = 2
[bootstrap]
samples = 100
[posterior]
samples = 400
";
/// What the report says of each that it lacks.
const PARTS: [&str; 4] = ["prediction bands", "next measurement", "bootstrap", "posterior"];

/// What a run with all statistics prints that is stopped when `line` is shown, its solution, and the
/// lines; an empty line is never shown.
fn stopped_when(line: &str) -> (String, Solution, Vec<String>) {
    let shown = Shown::default();
    let files = [("p.toml", format!("{EMPTIES}{ALL}")), ("d.csv", data())];
    let world = world(&files).stopped_when(line, &shown);
    let streams = world.streams();
    let mut session = Session::new(Box::new(world));
    let options = RunOptions { profile: true, ..RunOptions::default() };
    let solution = solve(&mut session, Path::new("p.toml"), &options);
    let solution = solution.unwrap_or_else(|errors| panic!("{line}: {}", errors[0].message));
    let result = session.world.output_dir().join("result.json");
    let bytes = session.world.read(&result).unwrap_or_else(|_| panic!("{line}: no result"));
    let read: Solution = serde_json::from_slice(&bytes).unwrap();
    assert_eq!(read.fitness.to_bits(), solution.fitness.to_bits(), "{line}");
    let lines = shown.lock().unwrap().clone();
    (streams.output(), solution, lines)
}

#[test]
fn whatever_statistic_is_stopped_the_report_says_what_it_lacks() {
    let (said, whole, mut lines) = stopped_when("never");
    assert!(!said.contains("stopped before"), "{said}");
    lines.retain(|line| !line.is_empty());
    let stages = |word: &str| lines.iter().filter(|line| line.contains(word)).count();
    for word in ["minimum", "standard errors", "profile of k", "bands", "next", "bootstrap"] {
        assert!(stages(word) > 0, "{word}: {lines:?}");
    }
    assert!(stages("bootstrap: fit") == 100 && stages("posterior: draw") > 0, "{lines:?}");
    lines.dedup();
    let is_between = |line: &String| {
        line.contains("bootstrap: fit")
            && !["fit 1 ", "fit 50 ", "fit 100 "].iter().any(|own| line.contains(own))
    };
    lines.retain(|line| !is_between(line));
    for line in &lines {
        let (said, found, _) = stopped_when(line);
        assert!(said.contains("the user stopped the run before the statistics ended"), "{said}");
        // The search had ended: values are those of the minimum, but for the last digits.
        for (own, other) in found.parameters.iter().zip(&whole.parameters) {
            assert!((own.value / other.value - 1.0).abs() < 1e-5, "{line}: {own:?}");
        }
        let inferred = &found.inferred;
        let made = [
            !inferred.bands.is_empty(),
            inferred.next_measurement.is_some(),
            inferred.bootstrap.is_some(),
            inferred.posterior.is_some(),
        ];
        let missing = said.lines().find(|line| line.contains("Not computed, because"));
        for (part, is_made) in PARTS.into_iter().zip(made) {
            let is_missing = missing.is_some_and(|sentence| sentence.contains(part));
            assert!(is_made != is_missing, "{line}: {part}\n{said}");
        }
        let has_verdicts = found.parameters.iter().all(|own| own.verdict.is_some());
        let is_profiled = found.profiles.is_some();
        assert!(
            !has_verdicts || is_profiled || said.contains("were not computed"),
            "{line}: {said}"
        );
        assert!(has_verdicts || said.contains("no statements"), "{line}: {said}");
    }
}
