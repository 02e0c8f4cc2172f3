//! Comparison of models that were fitted to the same data: Akaike's and Schwarz' criteria, Akaike
//! weights, and the likelihood ratio where one model is a special case of the other.
//!
//! ln L is that of normal errors; a common standard deviation that is not given is estimated and
//! counts as a parameter. AICc = 2k − 2 ln L + 2k(k+1)/(n−k−1), BIC = k ln n − 2 ln L. Twice the
//! difference of ln L of nested models is distributed as χ² with the difference of k where there are
//! many points. Where all errors have one variance that is estimated, that is n ln(S₀/S), and for linear
//! models (S₀/S − 1) (n − p)/Δp has the distribution F with any number of points.
//!
//! References: [Burnham & Anderson 2002](gapilib_base::bibliography#burnham-anderson-2002);
//! [Bates & Watts 1988](gapilib_base::bibliography#bates-watts-1988), §3.10 (F).

use super::Likelihood;
use crate::diag::Fault;
use crate::problem::distributions::{chi_square_tails, f_upper};
use crate::problem::{EndingKind, Solution};
use crate::registry::BAD_OPTION;
use crate::table::significant;
use crate::{bail, elementary, fault};
use serde::Serialize;
use std::fmt::Write;

/// A model of at least this Akaike weight is called the better one (evidence ratio 19 to 1).
const DECIDED: f64 = 0.95;
/// Measured values that differ by less, relative, are the same: some have been logarithms.
const SAME_DATA: f64 = 1e-12;
/// The larger of two nested models is needed below this probability.
const SIGNIFICANT: f64 = 0.05;
/// A larger model whose ln L is lower by more than this has not reached its minimum.
const NOT_REACHED: f64 = 1e-3;

/// The models side by side.
#[derive(Debug, Clone, Serialize)]
pub struct Comparison {
    /// One row for each, in the order given.
    pub models: Vec<Compared>,
    /// Likelihood ratio tests of nested pairs.
    pub nested: Vec<Nested>,
    /// The judgement.
    pub sentence: String,
}

/// One model.
#[derive(Debug, Clone, Serialize)]
pub struct Compared {
    /// Its name.
    pub name: String,
    /// Its likelihood.
    pub likelihood: Likelihood,
    /// Akaike's criterion, corrected for few points; `None` with too few.
    pub(crate) aicc: Option<f64>,
    /// Schwarz' criterion.
    pub(crate) bic: f64,
    /// Akaike weight; `None` with too few points, or where a model has not ended at a minimum.
    pub weight: Option<f64>,
    /// Why there is no minimum, so that the likelihood is not the largest one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) no_minimum: Option<String>,
}

/// A pair of nested models.
#[derive(Debug, Clone, Serialize)]
pub struct Nested {
    /// Place of the special case.
    pub smaller: usize,
    /// Place of the model that contains it.
    pub larger: usize,
    /// Twice the difference of ln L.
    pub(crate) statistic: f64,
    /// Additional estimated quantities.
    pub freedom: usize,
    /// The distribution that the probability is from.
    pub(crate) distribution: Distribution,
    /// Probability of such a difference if the special case is right; `None` where the larger
    /// model fits worse, so that its minimum was not reached, or one of both is not at a minimum.
    pub probability: Option<f64>,
}

/// How the ratio of two likelihoods is distributed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Distribution {
    /// That of ratios of variances: the variance is estimated.
    F,
    /// χ², with many points.
    ChiSquare,
}

/// Compares solutions by name.
///
/// # Errors
///
/// Solutions of different data or without a likelihood.
pub fn compare(solutions: &[(String, &Solution)]) -> Result<Comparison, Fault> {
    let Some((first_name, first)) = solutions.first() else {
        bail!(BAD_OPTION, "there are no models to compare");
    };
    for (name, solution) in &solutions[1..] {
        if !same_data(first, solution) {
            bail!(
                BAD_OPTION,
                "`{first_name}` and `{name}` are fitted to different data, so their likelihoods \
                 cannot be compared";
                help: "use the same experiments, points and outputs for both"
            );
        }
    }
    let mut models = Vec::new();
    for (name, solution) in solutions {
        let likelihood = solution.inferred.likelihood.ok_or_else(|| {
            fault!(BAD_OPTION, "`{name}` minimizes `{}`, which is not the likelihood of normal errors", solution.subject.fitness_name; help: "minimize `sum_of_squares`")
        })?;
        let ending = &solution.outcome.ending;
        let no_minimum =
            (ending.kind != EndingKind::Minimum).then(|| ending.words.trim_end_matches('.').into());
        models.push(Compared { no_minimum, ..compared(name, likelihood) });
    }
    if models.iter().any(|m| m.likelihood.known_sigma != models[0].likelihood.known_sigma) {
        bail!(
            BAD_OPTION,
            "the standard deviations of the measurements are given for some of the models only";
            help: "give every output the same `sigma` in all problems, or omit it in all"
        );
    }
    if models.iter().all(|model| model.no_minimum.is_none()) {
        weigh(&mut models);
    }
    let pairs = (0..models.len()).flat_map(|a| (0..models.len()).map(move |b| (a, b)));
    let nested: Vec<Nested> = pairs
        .filter(|&(a, b)| a != b && is_special_case(solutions[a].1, solutions[b].1))
        .map(|(a, b)| ratio(&models, a, b))
        .collect();
    let sentence = sentence(&models, &nested);
    Ok(Comparison { models, nested, sentence })
}

fn same_data(a: &Solution, b: &Solution) -> bool {
    let data = |solution: &Solution| -> Vec<(String, String, Vec<[f64; 2]>)> {
        let one = |s: &crate::problem::SolvedSeries| {
            // Log-normal data are shown by their logarithms.
            let name = s.y[0].strip_prefix("ln(").and_then(|name| name.strip_suffix(')'));
            let measured = |y: f64| if name.is_some() { elementary::exp(y) } else { y };
            let points = s.points.iter().map(|p| [p[0], measured(p[1])]).collect();
            (s.x[0].clone(), name.unwrap_or(&s.y[0]).to_owned(), points)
        };
        solution.series.iter().map(one).collect()
    };
    let is_near = |a: &f64, b: &f64| (a - b).abs() <= SAME_DATA * a.abs();
    let are_near = |(a, b): (&[f64; 2], &[f64; 2])| a.iter().zip(b).all(|(a, b)| is_near(a, b));
    let (a, b) = (data(a), data(b));
    a.len() == b.len()
        && a.iter().zip(&b).all(|(a, b)| {
            (&a.0, &a.1, a.2.len()) == (&b.0, &b.1, b.2.len()) && a.2.iter().zip(&b.2).all(are_near)
        })
}

fn compared(name: &str, likelihood: Likelihood) -> Compared {
    let (k, n) = (likelihood.estimated as f64, likelihood.points as f64);
    let enough = n - k - 1.0 > 0.0;
    let aicc = 2.0 * k - 2.0 * likelihood.log + 2.0 * k * (k + 1.0) / (n - k - 1.0);
    Compared {
        name: name.to_owned(),
        likelihood,
        aicc: enough.then_some(aicc),
        bic: k * elementary::ln(n) - 2.0 * likelihood.log,
        weight: None,
        no_minimum: None,
    }
}

/// Akaike weights: exp(−Δ/2) by their sum, where all have the criterion.
fn weigh(models: &mut [Compared]) {
    let all: Option<Vec<f64>> = models.iter().map(|model| model.aicc).collect();
    let Some(all) = all else { return };
    let least = all.iter().copied().fold(f64::INFINITY, f64::min);
    let shares: Vec<f64> = all.iter().map(|aicc| elementary::exp(-0.5 * (aicc - least))).collect();
    let sum: f64 = shares.iter().sum();
    models.iter_mut().zip(shares).for_each(|(model, share)| model.weight = Some(share / sum));
}

/// Whether every setting of the smaller problem is one of the larger, with more parameters
/// estimated there.
fn is_special_case(smaller: &Solution, larger: &Solution) -> bool {
    let read = |solution: &Solution| solution.provenance.problem.parse::<toml::Table>().ok();
    let (Some(small), Some(large)) = (read(smaller), read(larger)) else { return false };
    let same = |key: &str| small.get(key) == large.get(key);
    if !["model", "files", "experiment", "constraints"].into_iter().all(same)
        || smaller.parameters.len() >= larger.parameters.len()
    {
        return false;
    }
    let table = |file: &toml::Table| file.get("parameters").and_then(|p| p.as_table().cloned());
    let (Some(small), Some(large)) = (table(&small), table(&large)) else { return false };
    let is_free = |entry: &toml::Value| entry.get("min").is_some();
    let fits = |(name, entry): (&String, &toml::Value)| match large.get(name) {
        Some(other) if is_free(other) => match entry.get("fixed").and_then(number) {
            // A fixed value must lie in the range of the larger model.
            Some(value) => contains(other, value),
            None => is_free(entry) && entry.get("prior") == other.get("prior"),
        },
        Some(other) => entry == other,
        None => false,
    };
    let known = |(name, entry): (&String, &toml::Value)| is_free(entry) || small.contains_key(name);
    small.iter().all(fits) && large.iter().all(known)
}

fn number(value: &toml::Value) -> Option<f64> {
    value.as_float().or_else(|| value.as_integer().map(|value| value as f64))
}

fn contains(range: &toml::Value, value: f64) -> bool {
    let end = |name| range.get(name).and_then(number);
    end("min").zip(end("max")).is_some_and(|(min, max)| (min..=max).contains(&value))
}

fn ratio(models: &[Compared], smaller: usize, larger: usize) -> Nested {
    let (a, b) = (models[smaller].likelihood, models[larger].likelihood);
    let statistic = 2.0 * (b.log - a.log);
    let freedom = b.estimated - a.estimated;
    let distribution = match b.one_variance {
        true => Distribution::F,
        false => Distribution::ChiSquare,
    };
    let larger_by_chance = match distribution {
        Distribution::F => {
            let points = b.points as f64;
            // The variance is one of the estimated quantities.
            let left = points - (b.estimated as f64 - 1.0);
            let relative = elementary::exp(statistic.max(0.0) / points) - 1.0;
            f_upper(relative * left / freedom as f64, [freedom as f64, left])
        }
        Distribution::ChiSquare => chi_square_tails(statistic.max(0.0), freedom as f64)[1],
    };
    let at_minima = [smaller, larger].iter().all(|k| models[*k].no_minimum.is_none());
    let holds = |p: &f64| !p.is_nan() && statistic > -NOT_REACHED && at_minima;
    let probability = Some(larger_by_chance).filter(holds);
    Nested { smaller, larger, statistic, freedom, distribution, probability }
}

impl Nested {
    /// What to say where the test and the weights speak for different models, or one of them alone for
    /// the larger.
    fn disagreement(&self, models: &[Compared]) -> &'static str {
        let [small, large] = [self.smaller, self.larger].map(|k| models[k].weight);
        let Some(((small, large), p)) = small.zip(large).zip(self.probability) else { return "" };
        let is_favoured = large >= DECIDED * (small + large);
        match (p < SIGNIFICANT) == is_favoured {
            true => "",
            false => {
                " The test and the weights differ: the test asks whether the difference can be chance, \
                 AICc which model predicts new data better, and it counts parameters the more the \
                 fewer the points are. Further points decide."
            }
        }
    }
}

fn sentence(models: &[Compared], nested: &[Nested]) -> String {
    let short = |model: &Compared| {
        let why = model.no_minimum.as_ref()?;
        Some(format!("the fit of {} did not reach a minimum ({why})", model.name))
    };
    let short: Vec<String> = models.iter().filter_map(short).collect();
    if !short.is_empty() {
        return format!("The models cannot be compared: {}.", short.join("; "));
    }
    let mut text = judgement(models);
    for pair in nested {
        let (small, large) = (&models[pair.smaller].name, &models[pair.larger].name);
        let test = match pair.distribution {
            Distribution::F => "F test",
            Distribution::ChiSquare => "likelihood ratio",
        };
        text += &match pair.probability {
            None => format!(
                " {large} contains {small} and yet fits worse: its search has not reached the minimum."
            ),
            Some(p) if p < SIGNIFICANT => format!(
                " {small} is a special case of {large}, and the {test} rejects it (p = {}).",
                significant(p, 2)
            ),
            Some(p) => format!(
                " {small} is a special case of {large}, and the {test} does not support the larger \
                 model (p = {}).",
                significant(p, 2)
            ),
        };
        text += pair.disagreement(models);
    }
    if nested.is_empty() && models.len() > 1 {
        text += " None of these problems is known to be a special case of another (the same model with \
                 fewer parameters estimated), so there is no likelihood-ratio test.";
    }
    text
}

fn judgement(models: &[Compared]) -> String {
    let weight = |model: &&Compared| model.weight.unwrap_or(f64::NAN);
    if models.iter().any(|model| model.weight.is_none()) {
        return "There are too few points to compare the models.".to_owned();
    }
    let mut order: Vec<&Compared> = models.iter().collect();
    order.sort_by(|a, b| weight(b).total_cmp(&weight(a)));
    let best = order[0];
    if weight(&best) >= DECIDED {
        return format!(
            "These data favour {} (Akaike weight {}).",
            best.name,
            significant(weight(&best), 3)
        );
    }
    let named = order.iter().map(|m| format!("{} {}", m.name, significant(weight(m), 2)));
    format!(
        "These data do not discriminate between the models (Akaike weights: {}).",
        named.collect::<Vec<_>>().join(", ")
    )
}

impl Comparison {
    /// The table and the sentence.
    pub fn text(&self) -> String {
        let mut rows = vec![
            ["model", "points", "estimated", "ln L", "AICc", "BIC", "weight"].map(str::to_owned),
        ];
        for model in &self.models {
            let Likelihood { log, points, estimated, .. } = model.likelihood;
            let or = |value: Option<f64>, digits| {
                value.map_or("-".to_owned(), |value| significant(value, digits))
            };
            rows.push([
                model.name.clone(),
                points.to_string(),
                estimated.to_string(),
                significant(log, 6),
                or(model.aicc, 6),
                significant(model.bic, 6),
                or(model.weight, 3),
            ]);
        }
        let width = |k: usize| rows.iter().map(|row| row[k].chars().count()).max().unwrap_or(0);
        let widths: Vec<usize> = (0..7).map(width).collect();
        let mut text = String::from("\n");
        for row in &rows {
            let cells = row.iter().zip(&widths).map(|(cell, width)| format!("{cell:<width$}"));
            // Writing into a String cannot fail.
            _ = writeln!(text, "  {}", cells.collect::<Vec<_>>().join("  ").trim_end());
        }
        _ = writeln!(text, "\n  {}", self.sentence);
        text
    }

    /// `comparison.json`.
    pub fn to_json(&self) -> String {
        serde_json::to_string_pretty(self).unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn model(name: &str, [log, estimated]: [f64; 2], one_variance: bool) -> Compared {
        let estimated = estimated as usize;
        let (points, known_sigma) = (12, !one_variance);
        compared(name, Likelihood { log, points, estimated, known_sigma, one_variance })
    }

    /// Two more parameters: 1 + 2 F/m is the ratio of the sums of squares, and its probability that ratio
    /// to the power of −m/2, with m points beyond the parameters. χ² has the power −n/2.
    #[test]
    fn few_points_are_tested_by_the_ratio_of_variances() {
        for statistic in [0.0, 0.5, 3.0, 9.0] {
            let models = |one_variance: bool| {
                let small = model("small", [10.0, 3.0], one_variance);
                [small, model("large", [10.0 + 0.5 * statistic, 5.0], one_variance)]
            };
            let left = 12.0 - 4.0;
            let expected =
                [(true, (-0.5 * statistic * left / 12.0).exp()), (false, (-0.5 * statistic).exp())];
            for (one_variance, expected) in expected {
                let found = ratio(&models(one_variance), 0, 1).probability.unwrap();
                assert!((found - expected).abs() < 1e-9, "{statistic}: {found} {expected}");
            }
        }
    }

    #[test]
    fn a_test_and_weights_that_differ_are_named() {
        let said = |gain: f64| {
            let small = model("small", [10.0, 2.0], false);
            let mut models = [small, model("large", [10.0 + gain, 3.0], false)];
            weigh(&mut models);
            sentence(&models, &[ratio(&models, 0, 1)])
        };
        // p = 0.03: significant, but with a weight of 0.64 only.
        assert!(said(2.4).contains("The test and the weights differ"), "{}", said(2.4));
        for agreed in [said(0.1), said(8.0)] {
            assert!(!agreed.contains("differ:"), "{agreed}");
        }
        let models = [model("a", [1.0, 2.0], false), model("b", [2.0, 3.0], false)];
        assert!(sentence(&models, &[]).contains("is known to be a special case"));
    }
}
