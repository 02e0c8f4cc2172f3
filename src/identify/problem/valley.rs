//! What is determined of parameters that these data do not bound: along the valley of the sum of squares
//! that their profiles follow, a ratio, a product, a sum or a difference of two of them hardly changes.

use super::grounds::Grounds;
use super::{Finding, FindingKind, Severity, Solution, Statistics, Verdict};
use crate::table::ends;

/// A combination is worth a word where its interval is narrower than this part of its value.
const NARROW: f64 = 0.2;

/// A combination of two parameters.
#[derive(Clone, Copy)]
enum Form {
    Ratio,
    Product,
    Difference,
    Sum,
}

impl Form {
    const ALL: [Form; 4] = [Form::Ratio, Form::Product, Form::Difference, Form::Sum];

    /// Its value, and its derivatives by both.
    fn at(self, a: f64, b: f64) -> (f64, [f64; 2]) {
        match self {
            Form::Ratio => (a / b, [b.recip(), -a / (b * b)]),
            Form::Product => (a * b, [b, a]),
            Form::Difference => (a - b, [1.0, -1.0]),
            Form::Sum => (a + b, [1.0, 1.0]),
        }
    }

    fn text(self, a: &str, b: &str) -> String {
        match self {
            Form::Ratio => format!("{a}/{b}"),
            Form::Product => format!("{a}*{b}"),
            Form::Difference => format!("{a} - {b}"),
            Form::Sum => format!("{a} + {b}"),
        }
    }
}

/// A finding for each parameter that the data bound only together with another one: the combination
/// that they know best.
pub fn determined(solution: &Solution, statistics: &Statistics) -> Vec<Finding> {
    let is_open = |k: &usize| {
        let own = &solution.parameters[*k];
        own.verdict == Some(Verdict::PracticallyNonIdentifiable) && own.by_profile
    };
    let open: Vec<usize> = (0..solution.parameters.len()).filter(is_open).collect();
    let mut findings = Vec::new();
    for (place, &k) in open.iter().enumerate() {
        let pairs = open[place + 1..].iter();
        let all = pairs.flat_map(|&l| Form::ALL.map(|form| (form, l)));
        let known = all.filter_map(|(form, l)| {
            let interval = interval(solution, statistics, form, [k, l])?;
            let width = (interval[1] - interval[0]) / interval[0].abs().max(interval[1].abs());
            (width < NARROW).then_some((width, form, l, interval))
        });
        let Some((_, form, l, interval)) = known.min_by(|a, b| a.0.total_cmp(&b.0)) else {
            continue;
        };
        let names = [k, l].map(|k| solution.parameters[k].name.as_str());
        let sentence = format!(
            "Of {} and {}, these data determine {}: its 95 % interval is {}.",
            names[0],
            names[1],
            form.text(names[0], names[1]),
            ends(interval, interval[0])
        );
        let finding = Finding::new(FindingKind::Interval, sentence).severity(Severity::Information);
        findings.push(finding.parameters(names));
    }
    findings
}

/// The values of a combination along the valley, with its linear interval at each place of the valley,
/// where the second parameter is held.
fn interval(
    solution: &Solution,
    statistics: &Statistics,
    form: Form,
    [k, l]: [usize; 2],
) -> Option<[f64; 2]> {
    let value = |k: usize| solution.parameters[k].value;
    let (_, derivatives) = form.at(value(k), value(l));
    let half =
        statistics.spread.quantile * derivatives[0].abs() * statistics.deviation_with(k, l)?;
    let Grounds { profiles, .. } = &solution.grounds;
    let along = profiles.iter().filter(|(own, _)| *own == k || *own == l);
    let values: Vec<f64> = along
        .flat_map(|(_, profile)| &profile.valley)
        .map(|values| form.at(values[k], values[l]).0)
        .collect();
    let low = values.iter().copied().fold(f64::INFINITY, f64::min);
    let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    Some([low - half, high + half]).filter(|ends| ends.iter().all(|end| end.is_finite()))
}
