//! Which function of the sums of squares a script minimizes, found from the values that it sorts
//! by: a script sums the results of several calls of `Fit` as it likes, and what it gives to
//! `Fit_Order` decides.

use crate::ga::has_failed;
use crate::singular_values::SingularValues;
use nalgebra::DMatrix;

/// Relative difference up to which a sum is the one that the script has formed; its additions in
/// another order differ by rounding only, some 1e-15 for each term.
const SAME: f64 = 1e-9;

/// What a script minimizes.
#[derive(Debug, Clone, PartialEq)]
pub enum Objective {
    /// The sum of the squared residuals of all series, each times its weight.
    SumOfSquares(Vec<f64>),
    /// The square root of such a sum, so that its minimum is the same.
    Root(Vec<f64>),
    /// A function of the script's own.
    Script,
    /// Not known: the script sorts by itself. The sum of squares is taken to compare.
    Assumed,
}

impl Objective {
    /// What the script minimizes by all that was seen: where the generations do not agree, as with
    /// the larger one of two sums, it is none of these.
    pub(super) fn agreeing(self, before: Option<&Objective>) -> Objective {
        let same = |a: &[f64], b: &[f64]| {
            a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() <= 1e-6 * a.max(*b))
        };
        let agrees = match (before, &self) {
            (None, _) => true,
            (Some(Objective::SumOfSquares(a)), Objective::SumOfSquares(b)) => same(a, b),
            (Some(Objective::Root(a)), Objective::Root(b)) => same(a, b),
            (Some(before), now) => before == now,
        };
        if agrees { self } else { Objective::Script }
    }

    /// Whether its values are determined by the sums of squares.
    pub(super) fn is_function_of_sums(&self) -> bool {
        matches!(self, Objective::SumOfSquares(_) | Objective::Root(_))
    }

    /// Whether these values are those of individuals with these sums of squares: of all that did not
    /// fail, if there are any.
    pub(super) fn explains(&self, sums: &[Vec<f64>], fitness: &[f64]) -> bool {
        let good = informative(sums, fitness);
        let (weights, is_root) = match self {
            Objective::SumOfSquares(weights) => (weights, false),
            Objective::Root(weights) => (weights, true),
            Objective::Script | Objective::Assumed => return false,
        };
        let squared = |value: f64| if is_root { value * value } else { value };
        let values: Vec<(&[f64], f64)> =
            good.into_iter().map(|(sums, value)| (sums, squared(value))).collect();
        !values.is_empty() && hold(weights, &values)
    }

    /// That of these series, where the others do not count.
    pub(super) fn of_series(self, series: &[usize]) -> Objective {
        let own = |weights: Vec<f64>| series.iter().map(|&k| weights[k]).collect();
        match self {
            Objective::SumOfSquares(weights) => Objective::SumOfSquares(own(weights)),
            Objective::Root(weights) => Objective::Root(own(weights)),
            other => other,
        }
    }

    /// Its name in reports.
    pub fn name(&self) -> &'static str {
        match self {
            Objective::SumOfSquares(weights) if weights.iter().all(|weight| *weight == 1.0) => {
                "sum of squares"
            }
            Objective::SumOfSquares(_) => "weighted sum of squares",
            Objective::Root(_) => "root of a sum of squares",
            Objective::Script => "function of the script",
            Objective::Assumed => "sum of squares; the script does not use it as its fitness",
        }
    }

    /// The weights of the series where the minimum is that of a sum of squares; `None` where it is
    /// not.
    pub fn weights(&self, series: usize) -> Option<Vec<f64>> {
        match self {
            Objective::SumOfSquares(weights) | Objective::Root(weights) => Some(weights.clone()),
            Objective::Assumed => Some(vec![1.0; series]),
            Objective::Script => None,
        }
    }
}

/// The objective that has the values `fitness` for individuals with these sums of squares:
/// `sums[k]` has one entry for each series.
pub fn recognized(sums: &[Vec<f64>], fitness: &[f64]) -> Objective {
    let good = informative(sums, fitness);
    let Some(series) = good.first().map(|(sums, _)| sums.len()) else { return Objective::Script };
    if let Some(weights) = weights(&good, series) {
        return Objective::SumOfSquares(weights);
    }
    let squares: Vec<(&[f64], f64)> = good.iter().map(|(sums, f)| (*sums, f * f)).collect();
    weights(&squares, series).map_or(Objective::Script, Objective::Root)
}

/// The individuals whose fitness says something of what the script minimizes: those that did not fail.
fn informative<'a>(sums: &'a [Vec<f64>], fitness: &[f64]) -> Vec<(&'a [f64], f64)> {
    let all = sums.iter().zip(fitness);
    let good = all.filter(|(sums, fitness)| {
        !sums.is_empty() && !has_failed(**fitness) && !sums.iter().any(|sum| has_failed(*sum))
    });
    good.map(|(sums, fitness)| (sums.as_slice(), *fitness)).collect()
}

/// Whether any of these values says something of what the script minimizes.
pub(super) fn is_informative(sums: &[Vec<f64>], fitness: &[f64]) -> bool {
    !informative(sums, fitness).is_empty()
}

/// Whether the sums with these weights add up to the values.
fn hold(weights: &[f64], values: &[(&[f64], f64)]) -> bool {
    values.iter().all(|(sums, value)| {
        let total: f64 = sums.iter().zip(weights).map(|(sum, weight)| sum * weight).sum();
        (total - value).abs() <= SAME * value.abs()
    })
}

/// The weights with which the sums add up to the values: all 1, else those of least squares.
fn weights(values: &[(&[f64], f64)], series: usize) -> Option<Vec<f64>> {
    let holds = |weights: &[f64]| hold(weights, values);
    let ones = vec![1.0; series];
    if holds(&ones) {
        return Some(ones);
    }
    let mut different: Vec<f64> = values.iter().map(|(_, value)| *value).collect();
    different.sort_by(f64::total_cmp);
    different.dedup();
    // One series alone: no two values agree with its sums by chance.
    let only =
        |own: usize| (0..series).map(|k| f64::from(u8::from(k == own))).collect::<Vec<f64>>();
    if let Some(own) = (0..series).map(only).find(|own| different.len() > 1 && holds(own)) {
        return Some(own);
    }
    // With fewer values than this any weights would do.
    if different.len() < series + 2 || different[0] <= 0.0 {
        return None;
    }
    let rows = DMatrix::from_fn(values.len(), series, |k, e| values[k].0[e] / values[k].1);
    let solved = SingularValues::of(&rows)?.solve(&DMatrix::repeat(values.len(), 1, 1.0), 1e-12);
    let largest = solved.amax();
    let rounded = |weight: &f64| {
        let weight = if weight.abs() <= SAME * largest { 0.0 } else { *weight };
        if (weight - 1.0).abs() <= SAME { 1.0 } else { weight }
    };
    let weights: Vec<f64> = solved.iter().map(rounded).collect();
    (weights.iter().all(|weight| *weight >= 0.0) && holds(&weights)).then_some(weights)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SUMS: [[f64; 2]; 5] = [[1.0, 10.0], [2.0, 7.0], [0.5, 30.0], [4.0, 4.0], [9.0, 0.25]];

    fn found(of: impl Fn(&[f64; 2]) -> f64) -> Objective {
        let sums: Vec<Vec<f64>> = SUMS.iter().map(|sums| sums.to_vec()).collect();
        recognized(&sums, &SUMS.iter().map(of).collect::<Vec<f64>>())
    }

    #[test]
    fn what_the_script_adds_up_is_recognized() {
        assert_eq!(found(|s| s[0] + s[1]), Objective::SumOfSquares(vec![1.0, 1.0]));
        assert_eq!(found(|s| s[1]), Objective::SumOfSquares(vec![0.0, 1.0]));
        assert_eq!(found(|s| (s[0] + s[1]).sqrt()), Objective::Root(vec![1.0, 1.0]));
        let Objective::SumOfSquares(weights) = found(|s| 3.0 * s[0] + 0.5 * s[1]) else {
            panic!("a weighted sum")
        };
        assert!((weights[0] - 3.0).abs() < 1e-9 && (weights[1] - 0.5).abs() < 1e-9);
    }

    #[test]
    fn another_function_is_not_taken_for_a_sum() {
        assert_eq!(found(|s| s[0].max(s[1])), Objective::Script);
        assert_eq!(found(|s| s[0] * s[1]), Objective::Script);
        assert_eq!(found(|s| s[0] - 0.1 * s[1]), Objective::Script);
        assert_eq!(found(|s| s[0] + s[1] + 1e-6), Objective::Script);
    }

    #[test]
    fn generations_that_do_not_agree_have_no_sum_of_squares() {
        let sum = |weights: &[f64]| Objective::SumOfSquares(weights.to_vec());
        assert_eq!(sum(&[1.0]).agreeing(None), sum(&[1.0]));
        assert_eq!(sum(&[1.0]).agreeing(Some(&sum(&[1.0 + 1e-9]))), sum(&[1.0]));
        assert_eq!(sum(&[0.0, 1.0]).agreeing(Some(&sum(&[1.0, 0.0]))), Objective::Script);
        assert_eq!(sum(&[0.0, 1.0]).agreeing(Some(&Objective::Script)), Objective::Script);
    }

    #[test]
    fn few_individuals_do_not_make_weights() {
        let sums = [vec![1.0, 2.0], vec![2.0, 1.0]];
        assert_eq!(recognized(&sums, &[5.0, 7.0]), Objective::Script);
        assert_eq!(recognized(&sums, &[2.0, 1.0]), Objective::SumOfSquares(vec![0.0, 1.0]));
        assert_eq!(recognized(&sums[..1], &[2.0]), Objective::Script, "one value says nothing");
        assert_eq!(recognized(&[vec![1e60]], &[1e60]), Objective::Script, "all have failed");
    }
}
