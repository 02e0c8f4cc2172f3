//! Sentences that are true within the search ranges only.
//!
//! Where a fit is worse than a constant, the variance of its residuals is that of the misfit. If the
//! range of a parameter ends before its best value, every value in the range then lies within the 95 %
//! limit, which tells of the range and not of the parameter: nothing is said but that the range may be
//! too narrow, and that is said first.

use super::{
    Finding, FindingKind, NOISE_OF, Severity, Solution, SolvedParameter, SolvedSeries, Verdict,
};
use crate::table::significant;

/// A wider range of a parameter whose logarithm is searched, or that is positive, reaches this factor
/// farther.
const WIDER: f64 = 100.0;
/// Begins what to do about a range.
const WIDEN: &str = "Widen the range";

impl Solution {
    /// Where a fit is worse than a constant, says first which ranges may be the cause.
    pub(super) fn put_ranges_first(&mut self) {
        let poor = self.findings.iter().filter(|finding| finding.kind == FindingKind::PoorFit);
        let poor: Vec<&Finding> = poor.collect();
        // What fits a part of the data is not worse than a constant for all of them.
        let is_poor = |own: &SolvedSeries| poor.iter().any(|one| one.series.contains(&own.label()));
        let severity = poor.iter().map(|finding| finding.severity).max();
        let Some(severity) = severity.filter(|_| self.series.iter().all(is_poor)) else { return };
        let may_be_cause: Vec<usize> =
            (0..self.parameters.len()).filter(|k| self.may_end_too_early(*k, severity)).collect();
        for k in may_be_cause {
            self.blame_range(k);
        }
        self.findings.sort_by_key(|finding| finding.kind != FindingKind::AtBound);
        if let [first, ..] = &mut self.findings[..]
            && first.kind == FindingKind::AtBound
        {
            first.sentence += " Ranges of `gapi new` are drawn around the values in the model.";
        }
    }

    /// Whether the best value of a parameter may lie outside its range, so that no statement on it
    /// holds: it stands at an end, or where none does, all of its values fit alike.
    fn may_end_too_early(&self, k: usize, severity: Severity) -> bool {
        let own = &self.parameters[k];
        let is_said = self.findings.iter().any(|finding| {
            finding.kind == FindingKind::AtBound && finding.parameters == [own.name.clone()]
        });
        let fits_alike = own.open == [true; 2] || own.verdict == Some(Verdict::WithoutEffect);
        let is_at_end = self.parameters.iter().any(|other| other.at_bound);
        match own.at_bound {
            true => !is_said && (severity == Severity::Serious || fits_alike),
            false => !is_at_end && fits_alike,
        }
    }

    /// Takes back what was said of a parameter, and says that its range may be too narrow.
    fn blame_range(&mut self, k: usize) {
        let own = &mut self.parameters[k];
        let name = own.name.clone();
        let sentence = too_narrow(own);
        if own.verdict != Some(Verdict::WithoutEffect) {
            own.forget();
        }
        own.deviation = None;
        self.findings.retain(|finding| {
            let is_about = finding.kind.is_about_profile() || finding.kind == FindingKind::NoEffect;
            !(is_about && finding.parameters == [name.clone()])
        });
        let finding = Finding::new(FindingKind::AtBound, sentence).severity(Severity::Serious);
        self.findings.insert(0, finding.parameters([name.as_str()]));
    }
}

fn too_narrow(parameter: &SolvedParameter) -> String {
    let SolvedParameter { name, range, .. } = parameter;
    let [min, max] = range.map(|end| significant(end, 4));
    let remedy = remedy(parameter);
    if !parameter.at_bound {
        return format!(
            "All values of {name} in its search range, {min} to {max}, fit alike, and worse than a \
             constant: its best value may lie outside. {remedy}"
        );
    }
    let (side, end) = if is_upper(parameter) { ("upper", max) } else { ("lower", min) };
    format!(
        "{name} lies at the {side} end {end} of its search range, and within the ranges the fit is \
         worse than a constant: its best value may lie beyond that end, so nothing more is said of \
         it. {remedy}"
    )
}

/// Whether a parameter lies nearer to the upper end of its range.
pub(super) fn is_upper(parameter: &SolvedParameter) -> bool {
    let [min, max] = parameter.range;
    parameter.value - min > max - parameter.value
}

/// Leaves out that a range is to be widened, where the cause may be another.
pub(super) fn leave_out_remedy(finding: &mut Finding) {
    if let Some(at) = finding.sentence.find(WIDEN) {
        finding.sentence.truncate(at);
        finding.sentence.truncate(finding.sentence.trim_end().len());
    }
}

/// What to do about a range that ends before the best value.
pub(super) fn remedy(parameter: &SolvedParameter) -> String {
    if parameter.name.starts_with(NOISE_OF) && parameter.at_bound && !is_upper(parameter) {
        // The range ends at the least noise: it vanishes.
        return "Without this noise the data are explained as well: remove it from `[noise]`."
            .to_owned();
    }
    let [below, above] = wider(parameter);
    let to = |(word, end): (&str, Option<f64>)| Some(format!("{word} to {}", significant(end?, 2)));
    let sides = match (parameter.at_bound, is_upper(parameter)) {
        (true, true) => vec![("up", above)],
        (true, false) => vec![("down", below)],
        (false, _) => vec![("down", below), ("up", above)],
    };
    let examples: Vec<String> = sides.into_iter().filter_map(to).collect();
    let example = match examples.is_empty() {
        true => String::new(),
        false => format!(", for example {}", examples.join(" or ")),
    };
    format!("{WIDEN}{example}, or question the model if the bound is physical.")
}

/// Ends of a wider range: an end of 0 is most often physical, and a positive range stays positive.
fn wider(parameter: &SolvedParameter) -> [Option<f64>; 2] {
    let [min, max] = parameter.range;
    if min > 0.0 {
        let above = if parameter.logarithmic { max * WIDER } else { max + (max - min) };
        return [Some(min / WIDER), Some(above)];
    }
    let width = max - min;
    [(min != 0.0).then_some(min - width), (max != 0.0).then_some(max + width)]
}
