//! Combinations such as `E + A*log(i0)`: parameters of which a model depends only on a sum of terms,
//! each a power or the logarithm of one parameter times powers of others.
//!
//! The columns of such parameters are multiples of one vector, everywhere. The ratio of two of them
//! is the ratio of the derivatives of the combination; where it is a product of powers of the
//! parameters, the combination is found by integration. Whether it is one is tested at other points,
//! and by finite changes that leave the combination what it is.

use super::sensitivities::Sensitivities;
use super::{Evaluation, Free, Problem};
use crate::elementary;
use crate::table::significant;

/// A parameter is changed by this factor, or by this part of its range where it is not positive.
const FACTOR: f64 = 1.25;
const OF_RANGE: f64 = 0.1;
/// Exponents are multiples of this, within so much.
const STEP: f64 = 0.5;
const ROUNDING: f64 = 0.02;
/// Ratios are predicted this well.
const PREDICTED: f64 = 1e-3;
/// Changes of the logarithm of a parameter, or of these parts of its size, along the combination.
const CHANGES: [f64; 4] = [0.1, -0.1, 0.3, -0.3];
/// A change of a point below this many times the error of the simulation is that error, and one below
/// this part of the largest point that of the factors.
const ERRORS: f64 = 1e3;
const OF_FACTORS: f64 = 1e-5;

/// A term of a combination: `factor` times powers of other parameters times the logarithm of its
/// parameter or that parameter to a power.
#[derive(Debug, Clone, PartialEq)]
pub struct Term {
    /// Its parameter.
    pub parameter: usize,
    /// The power; 0 stands for the logarithm.
    power: f64,
    factor: f64,
    /// Other parameters with their powers.
    others: Vec<(usize, f64)>,
}

/// A sum of terms.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Combination {
    terms: Vec<Term>,
}

impl Term {
    /// The power or the logarithm of its own parameter.
    fn own(&self, values: &[f64]) -> f64 {
        let value = values[self.parameter];
        match self.power == 0.0 {
            true => elementary::ln(value.abs()),
            false => elementary::powf(value, self.power),
        }
    }

    fn coefficient(&self, values: &[f64]) -> f64 {
        let power = |(k, exponent): &(usize, f64)| elementary::powf(values[*k].abs(), *exponent);
        self.factor * self.others.iter().map(power).product::<f64>()
    }

    /// The derivative by its own parameter.
    fn derivative(&self, values: &[f64]) -> f64 {
        let value = values[self.parameter];
        let own = match self.power == 0.0 {
            true => value.recip(),
            false => self.power * elementary::powf(value, self.power - 1.0),
        };
        self.coefficient(values) * own
    }

    fn text<'a>(&self, name: &impl Fn(usize) -> &'a str) -> String {
        let power = |name: &str, exponent: f64| match significant(exponent, 4).as_str() {
            "1" => name.to_owned(),
            exponent => format!("{name}^{exponent}"),
        };
        let size = significant(self.factor.abs(), 4);
        let mut parts: Vec<String> = if size == "1" { Vec::new() } else { vec![size] };
        parts.extend(self.others.iter().map(|(k, exponent)| power(name(*k), *exponent)));
        parts.push(match self.power == 0.0 {
            true => format!("log({})", name(self.parameter)),
            false => power(name(self.parameter), self.power),
        });
        parts.join("*")
    }
}

impl Combination {
    /// The combination by which a group of one degree of freedom acts; `None` where none of this form
    /// is found.
    pub fn of(
        (problem, evaluation): (&Problem, &Evaluation),
        best: &Sensitivities,
        members: &[usize],
        others: &[Sensitivities],
        sensitivities: &mut dyn FnMut(&[f64]) -> Vec<Vec<f64>>,
    ) -> Option<Combination> {
        let here = ratios(best, members)?;
        let n = problem.parameters.len();
        // Exponents of the ratio of each member to the first, by all parameters.
        let mut exponents = vec![vec![0.0; n]; here.len()];
        for k in 0..n {
            let value = best.values[k];
            let mut moved = best.values.clone();
            moved[k] = changed(&problem.parameters[k], value)?;
            let columns = sensitivities(&moved);
            let there = ratios(&Sensitivities { values: moved.clone(), columns }, members)?;
            for ((own, here), there) in exponents.iter_mut().zip(&here).zip(&there) {
                own[k] = exponent(there / here, moved[k] / value)?;
            }
        }
        let found = Combination::integrated(members, &best.values, &here, &exponents)?;
        let holds = others.iter().all(|point| found.predicts(point, members));
        (holds && found.leaves(problem, evaluation, &best.values)).then_some(found)
    }

    /// From ratios of derivatives that are products of powers.
    fn integrated(
        members: &[usize],
        values: &[f64],
        ratios: &[f64],
        exponents: &[Vec<f64>],
    ) -> Option<Combination> {
        let first = members[0];
        let of_first = exponents.first()?[first];
        // ∂φ/∂p₁ is p₁ to this power.
        let mut terms = vec![term(first, -of_first, 1.0, Vec::new())];
        for ((&member, ratio), own) in members[1..].iter().zip(ratios).zip(exponents) {
            let is_separate =
                |other: &usize| *other == first || *other == member || own[*other] == 0.0;
            if own[first] != of_first || !members.iter().all(is_separate) {
                return None;
            }
            let power = |k: usize| elementary::powf(values[k].abs(), own[k]);
            let size: f64 = (0..own.len()).filter(|&k| own[k] != 0.0).map(power).product();
            let others = (0..own.len()).filter(|k| own[*k] != 0.0 && !members.contains(k));
            let others = others.map(|k| (k, own[k])).collect();
            terms.push(term(member, own[member], ratio / size, others));
        }
        let is_finite = |term: &Term| term.factor.is_finite() && term.factor != 0.0;
        terms.iter().all(is_finite).then_some(Combination { terms })
    }

    /// Whether the ratios at another point are those of the combination.
    fn predicts(&self, point: &Sensitivities, members: &[usize]) -> bool {
        let Some(found) = ratios(point, members) else { return false };
        let first = self.terms[0].derivative(&point.values);
        let pairs = self.terms[1..].iter().zip(found);
        pairs
            .map(|(term, ratio)| (term.derivative(&point.values) / first, ratio))
            .all(|(own, ratio)| (own - ratio).abs() <= PREDICTED * ratio.abs())
    }

    /// Whether finite changes that leave the combination what it is change no point.
    fn leaves(&self, problem: &Problem, evaluation: &Evaluation, values: &[f64]) -> bool {
        let places: Vec<Vec<f64>> = self.terms[1..]
            .iter()
            .flat_map(|term| CHANGES.iter().filter_map(|by| self.along(problem, values, term, *by)))
            .collect();
        let mut rows =
            evaluation.simulate_all(&[&[values.to_vec()][..], &places].concat()).into_iter();
        let Some(Ok(here)) = rows.next() else { return false };
        let size = here.iter().fold(0.0, |most: f64, v| most.max(v.abs()));
        let is_same = |row: &Vec<f64>| {
            let pairs = row.iter().zip(&here);
            let most = pairs.fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()));
            most <= (ERRORS * problem.noise).max(OF_FACTORS) * size
        };
        let rows: Vec<_> = rows.flatten().collect();
        !rows.is_empty() && rows.iter().all(is_same)
    }

    /// The values with the parameter of a term changed, and that of the first so that the combination
    /// stays; `None` beyond the ranges.
    fn along(&self, problem: &Problem, values: &[f64], term: &Term, by: f64) -> Option<Vec<f64>> {
        let mut moved = values.to_vec();
        moved[term.parameter] = match term.power == 0.0 {
            true => values[term.parameter] * elementary::exp(by),
            false => values[term.parameter] * (1.0 + by),
        };
        let change = term.coefficient(values) * (term.own(&moved) - term.own(values));
        let first = &self.terms[0];
        let own = first.own(values) - change / first.factor;
        moved[first.parameter] = match first.power == 0.0 {
            true => elementary::exp(own).copysign(values[first.parameter]),
            false => elementary::powf(own, first.power.recip()),
        };
        let is_within = |(free, value): (&Free, &f64)| (free.min..=free.max).contains(value);
        problem.parameters.iter().zip(&moved).all(is_within).then_some(moved)
    }

    /// Its value, and its derivatives by all parameters.
    pub fn at(&self, values: &[f64]) -> (f64, Vec<f64>) {
        let mut gradient = vec![0.0; values.len()];
        let mut sum = 0.0;
        for term in &self.terms {
            let own = term.coefficient(values) * term.own(values);
            sum += own;
            gradient[term.parameter] += term.derivative(values);
            for (k, exponent) in &term.others {
                gradient[*k] += exponent * own / values[*k];
            }
        }
        (sum, gradient)
    }

    /// As it is written.
    pub fn text<'a>(&self, name: &impl Fn(usize) -> &'a str) -> String {
        let mut text = String::new();
        for term in &self.terms {
            text += match (text.is_empty(), term.factor < 0.0) {
                (true, false) => "",
                (true, true) => "-",
                (false, false) => " + ",
                (false, true) => " - ",
            };
            text += &term.text(name);
        }
        text
    }
}

/// The integral of `factor` times the others times the parameter to this power.
fn term(parameter: usize, power: f64, factor: f64, others: Vec<(usize, f64)>) -> Term {
    match power == -1.0 {
        true => Term { parameter, power: 0.0, factor, others },
        false => Term { parameter, power: power + 1.0, factor: factor / (power + 1.0), others },
    }
}

/// The ratios of the columns of the members to that of the first; `None` where they are not multiples
/// of it.
fn ratios(point: &Sensitivities, members: &[usize]) -> Option<Vec<f64>> {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let first = &point.columns[members[0]];
    let square = dot(first, first);
    let ratio = |&k: &usize| {
        let own = &point.columns[k];
        let ratio = dot(own, first) / square;
        let left: f64 =
            own.iter().zip(first).map(|(a, b)| elementary::powi(a - ratio * b, 2)).sum();
        (left <= PREDICTED * PREDICTED * dot(own, own) && ratio != 0.0).then_some(ratio)
    };
    members[1..].iter().map(ratio).collect()
}

/// Another value of a parameter.
fn changed(free: &Free, value: f64) -> Option<f64> {
    let room = OF_RANGE * (free.max - free.min);
    let all = match value == 0.0 {
        true => [room, -room],
        false => [value * FACTOR, value / FACTOR],
    };
    all.into_iter().find(|value| (free.min..=free.max).contains(value))
}

/// The exponent of a power that changes by the first ratio where its base changes by the second.
fn exponent(ratio: f64, base: f64) -> Option<f64> {
    if ratio.is_nan() || ratio <= 0.0 {
        return None;
    }
    let own = match base > 0.0 && base.is_finite() {
        true => elementary::ln(ratio) / elementary::ln(base),
        false if (ratio - 1.0).abs() <= PREDICTED => 0.0,
        false => return None,
    };
    let rounded = (own / STEP).round() * STEP;
    ((own - rounded).abs() <= ROUNDING).then_some(rounded)
}
